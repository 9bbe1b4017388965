/*
   Which pairs are closed at many points. Equilibria at the first points, which fill the box evenly, make a basis
   (manybasis.c); all others are solved on it (manydense.c). The status of a point is known where the closing of every
   pair is farther from 0 than MANY_SURE times the error, which is estimated by what the last third of the vectors
   change; where true errors were seen to exceed their estimates at the last MANY_RECENT points solved on the mesh, as
   many times more: a poor basis long ago tells nothing of the present one. Points whose status is not known are
   solved on the mesh, those of the largest error first, and the basis takes them in: each makes the others better
   known. On the mesh the factors of the first point serve all others (near.c). Behind the first points the basis
   takes in the influences of pairs that open and close, since a change of status is a kink that equilibria alone hold
   badly.
*/
#include "many.h"
#include "base/gather.h"
#include "base/process/progress.h"

#define MANY_FIRST      16  /* points on the mesh before the basis is used */
#define MANY_ROUND      16  /* points on the mesh before it is used again */
#define MANY_MOST       400 /* vectors, beyond which all that is left is solved on the mesh */
#define MANY_SURE       2 /* on the estimate, which is the error of the smaller model: that of the larger one is less */
#define MANY_RECENT     16  /* points whose errors beside their estimates count */
#define MANY_INFLUENCES 125 /* vectors with those of pairs that open and close, at most */
#define MANY_BATCH      64  /* points of each rank whose data are made before they are solved */

/* Of all points */
typedef struct {
  Statics      s;
  PetscInt     n;
  StaticsPoint get;
  void        *ctx;
  char        *closed;                     /* [n][local pairs] */
  PetscReal   *error;                      /* [n] m, negative where the status is known */
  PetscReal    ratio, recent[MANY_RECENT]; /* largest true error beside its estimate; those of the last points */
  ManyLoad    *load;                       /* [n] */
  PetscInt     n_mesh;
  char        *begin; /* [pairs of all ranks] statuses to begin with */
  Progress     progress;
} Many;

/* The closed pairs of the state at a point, on the mesh: by the factors that there are, from the displacements that
   there are, where these are `near`, else by its own */
static PetscErrorCode MeshSolve(Many *m, PetscInt i, PetscBool near)
{
  const PetscInt n_pairs = m->s->rows.n_pairs;
  SlidingState   state;
  PetscReal     *p;
  char          *closed = &m->closed[(size_t)i * n_pairs];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(m->s->n_parameters, &p));
  PetscCall(m->get(m->ctx, i, p));
  if (near) PetscCall(ManyNear(m->s, p, &near));
  for (PetscInt k = 0; k < n_pairs && near; k++) closed[k] = m->s->status[k] != CONTACT_OPEN;
  if (!near) {
    PetscCall(StaticsSolveSliding(m->s, p, &state));
    for (PetscInt k = 0; k < n_pairs; k++) closed[k] = state.group[k] >= 0;
    PetscCall(SlidingStateDestroy(&state));
  }
  PetscCall(PetscFree(p));
  m->error[i] = -1;
  m->n_mesh++;
  PetscCall(ProgressStep(&m->progress));
  PetscFunctionReturn(0);
}

/* Whether contacts wear at some point */
static PetscErrorCode ManyWears(const Many *m, PetscBool *wears)
{
  PetscReal *p, time = 0;

  PetscFunctionBeginUser;
  *wears = PETSC_FALSE;
  PetscCall(PetscMalloc1(m->s->n_parameters, &p));
  for (PetscInt i = 0; i < m->n && m->s->wears && !*wears; i++) {
    PetscCall(m->get(m->ctx, i, p));
    PetscCall(OperatorsGetWearTime(m->s->operators, p, &time));
    if (time > 0) *wears = PETSC_TRUE;
  }
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

/* Whether the contact problem is one that the basis has: all laws linear at a status, nothing that has a history, and
   no bolt under a tension, whose shortening only its own solution tells. Motions that nothing resists are no part of
   the equilibria, nor of the basis. Alike on all ranks */
static PetscErrorCode ManyIsOffered(const Many *m, PetscBool *offered)
{
  Statics           s    = m->s;
  const PairRows   *rows = &s->rows;
  const ModelScene *scene;
  PetscBool         wears;

  PetscFunctionBeginUser;
  PetscCall(ManyWears(m, &wears));
  PetscCall(ModelGetScene(s->model, &scene));
  *offered = !s->n_stages && !wears && !s->rows_more && !PairRowsCoulomb(rows) ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt i = 0; i < scene->n_loads; i++)
    if (scene->loads[i].has_tension) *offered = PETSC_FALSE;
  for (PetscInt i = 0; i < rows->n_interfaces; i++)
    if (!PressureIsLinear(&rows->pressure[i]) || PetscIsInfReal(PressureSlope(&rows->pressure[i], 0)))
      *offered = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Room for the data of n points */
static PetscErrorCode ManyPointsCreate(const ManyModel *model, PetscInt n, ManyPoint **points)
{
  const PetscInt size = model->n_terms + model->n + 3 * model->n_pairs;
  PetscReal     *values;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, points));
  PetscCall(PetscCalloc1(n * size, &values));
  for (PetscInt i = 0; i < n; i++) {
    PetscReal *at = values + i * size;

    (*points)[i] =
      (ManyPoint){at, at + model->n_terms, at + model->n_terms + model->n,
                  at + model->n_terms + model->n + model->n_pairs, at + model->n_terms + model->n + 2 * model->n_pairs};
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ManyPointsDestroy(ManyPoint **points)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree((*points)->c));
  PetscCall(PetscFree(*points));
  PetscFunctionReturn(0);
}

/* Takes an answer over: the statuses of this rank's pairs, and whether they are known */
static void ManyTake(Many *m, PetscInt i, PetscInt begin, const char closed[], const PetscReal answer[2])
{
  const PetscInt n_pairs = m->s->rows.n_pairs;
  PetscReal      sure    = 1;

  for (PetscInt k = 0; k < n_pairs; k++) m->closed[(size_t)i * n_pairs + k] = closed[begin + k];
  for (PetscInt k = 0; k < MANY_RECENT; k++) sure = PetscMax(sure, m->recent[k]);
  m->error[i] = answer[1] > MANY_SURE * sure * answer[0] ? -1 : answer[0];
}

/* Statuses of all pairs [of all ranks] to begin point i with: those found there last, or of the first point */
static PetscErrorCode ManyPointBegin(const Many *m, PetscInt i, char closed[])
{
  const PetscInt n_pairs = m->s->rows.n_pairs;
  char          *all;

  PetscFunctionBeginUser;
  if (m->error[i] <= 0 || m->error[i] == PETSC_MAX_REAL) {
    PetscCall(PetscArraycpy(closed, m->begin, m->s->rows.n_pairs_all));
    PetscFunctionReturn(0);
  }
  PetscCall(GatherRecords(m->s->comm, n_pairs, 1, &m->closed[(size_t)i * n_pairs], NULL, &all));
  PetscCall(PetscArraycpy(closed, all, m->s->rows.n_pairs_all));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

/* Solves the points list[n] on the basis, shared among the ranks: owner r of the k-th is k mod size */
static PetscErrorCode BatchSolve(Many *m, ManyBasis *basis, PetscInt n, const PetscInt list[])
{
  const PetscInt n_pairs = basis->model.n_pairs;
  PetscMPIInt    rank, size, count;
  PetscInt       begin = 0;
  PetscReal     *p, *closing, *q, *answer;
  char          *closed;
  ManyPoint     *points;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(m->s->comm, &rank));
  PetscCallMPI(MPI_Comm_size(m->s->comm, &size));
  PetscCall(ManyPointsCreate(&basis->model, n, &points));
  PetscCall(PetscMalloc3(m->s->n_parameters, &p, n_pairs, &closing, basis->model.n, &q));
  PetscCall(PetscCalloc2(2 * n, &answer, n * n_pairs, &closed));
  for (PetscInt k = 0; k < n; k++) {
    PetscCall(m->get(m->ctx, list[k], p));
    PetscCall(ManyBasisPoint(basis, p, &m->load[list[k]], &points[k]));
    PetscCall(ManyPointBegin(m, list[k], &closed[k * n_pairs]));
    if (k % size != rank) PetscCall(PetscArrayzero(&closed[k * n_pairs], n_pairs));
  }
  for (PetscInt k = rank; k < n; k += size) {
    ManyAnswer one;

    PetscCall(ManySolve(&basis->model, &points[k], &closed[k * n_pairs], closing, q, &one));
    answer[2 * k]     = one.error;
    answer[2 * k + 1] = one.nearest;
  }
  PetscCall(PetscMPIIntCast(n * n_pairs, &count));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, closed, count, MPI_CHAR, MPI_MAX, m->s->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, answer, (PetscMPIInt)(2 * n), MPIU_REAL, MPI_SUM, m->s->comm));
  PetscCallMPI(MPI_Exscan(&m->s->rows.n_pairs, &begin, 1, MPIU_INT, MPI_SUM, m->s->comm));
  for (PetscInt k = 0; k < n; k++) ManyTake(m, list[k], rank ? begin : 0, &closed[k * n_pairs], &answer[2 * k]);
  PetscCall(PetscFree3(p, closing, q));
  PetscCall(PetscFree2(answer, closed));
  PetscCall(ManyPointsDestroy(&points));
  PetscFunctionReturn(0);
}

/* All points whose status is not known, on the basis; list [n_open] are those of which it still is not */
static PetscErrorCode OpenSolve(Many *m, ManyBasis *basis, PetscInt *n_open, PetscInt list[])
{
  PetscMPIInt size;
  PetscInt    n = *n_open;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(m->s->comm, &size));
  for (PetscInt first = 0; first < n; first += MANY_BATCH * size)
    PetscCall(BatchSolve(m, basis, PetscMin(n - first, MANY_BATCH * size), &list[first]));
  *n_open = 0;
  for (PetscInt k = 0; k < n; k++)
    if (m->error[list[k]] >= 0) list[(*n_open)++] = list[k];
  PetscFunctionReturn(0);
}

/* True error of the closings that the basis had at the point solved on the mesh last, beside its estimate */
static PetscErrorCode RatioLook(Many *m, const PetscReal closing[], const ManyAnswer *answer)
{
  PetscReal *w, error = 0, *const recent = &m->recent[m->n_mesh % MANY_RECENT];
  PetscMPIInt rank;
  PetscInt    begin = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(m->s->comm, &rank));
  PetscCallMPI(MPI_Exscan(&m->s->rows.n_pairs, &begin, 1, MPIU_INT, MPI_SUM, m->s->comm));
  PetscCall(PetscMalloc1(m->s->rows.n, &w));
  PetscCall(ComplianceGetRows(&m->s->compliance, m->s->u, w));
  for (PetscInt k = 0; k < m->s->rows.n; k++)
    error = PetscMax(error, PetscAbsReal(w[k] - m->s->rows.law[k].g0 - closing[(rank ? begin : 0) + k]));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &error, 1, MPIU_REAL, MPI_MAX, m->s->comm));
  *recent = answer->found && answer->error > 0 && answer->error < PETSC_MAX_REAL ? error / answer->error : 0;
  PetscCallMPI(MPI_Bcast(recent, 1, MPIU_REAL, 0, m->s->comm));
  m->ratio = PetscMax(m->ratio, *recent);
  PetscCall(PetscFree(w));
  PetscFunctionReturn(0);
}

/* Point i on the mesh from what the basis has there, and into it, with a look at how far the basis was off */
static PetscErrorCode ManyPointTake(Many *m, ManyBasis *basis, PetscInt i)
{
  const PetscInt n_pairs = basis->model.n_pairs;
  PetscReal     *p, *closing, *q;
  PetscMPIInt    found;
  char          *closed;
  ManyAnswer     answer;
  ManyPoint     *point;

  PetscFunctionBeginUser;
  PetscCall(ManyPointsCreate(&basis->model, 1, &point));
  PetscCall(PetscCalloc4(m->s->n_parameters, &p, n_pairs, &closing, basis->model.n, &q, n_pairs, &closed));
  PetscCall(m->get(m->ctx, i, p));
  PetscCall(ManyBasisPoint(basis, p, &m->load[i], point));
  PetscCall(PetscArraycpy(closed, m->begin, n_pairs));
  PetscCall(ManySolve(&basis->model, point, closed, closing, q, &answer));
  found = answer.found;
  PetscCallMPI(MPI_Bcast(&found, 1, MPI_INT, 0, m->s->comm));
  PetscCallMPI(MPI_Bcast(q, (PetscMPIInt)basis->model.n, MPIU_REAL, 0, m->s->comm));
  if (found) PetscCall(ManyBasisExpand(basis, q));
  PetscCall(MeshSolve(m, i, PETSC_TRUE));
  PetscCall(RatioLook(m, closing, &answer));
  PetscCall(ManyBasisAdd(basis));
  PetscCall(PetscFree4(p, closing, q, closed));
  PetscCall(ManyPointsDestroy(&point));
  PetscFunctionReturn(0);
}

/* The open points of the largest errors on the mesh, into the basis */
static PetscErrorCode OpenRefine(Many *m, ManyBasis *basis, PetscInt *n_open, PetscInt list[])
{
  PetscReal *error;
  PetscInt   n = PetscMin(*n_open, MANY_ROUND);

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(*n_open, &error));
  for (PetscInt k = 0; k < *n_open; k++) error[k] = m->error[list[k]];
  PetscCall(PetscSortRealWithArrayInt(*n_open, error, list));
  for (PetscInt k = *n_open - n; k < *n_open; k++) PetscCall(ManyPointTake(m, basis, list[k]));
  *n_open -= n;
  PetscCall(PetscFree(error));
  PetscFunctionReturn(0);
}

/* Statuses of all ranks at the first point, which others begin with */
static PetscErrorCode BeginTake(Many *m, PetscInt i)
{
  const PetscInt n_pairs = m->s->rows.n_pairs;
  char          *all;

  PetscFunctionBeginUser;
  PetscCall(GatherRecords(m->s->comm, n_pairs, 1, &m->closed[(size_t)i * n_pairs], NULL, &all));
  m->begin = all;
  PetscFunctionReturn(0);
}

/* The influences of pairs that are closed at some points and open at others, as far as the basis knows, into it: a
   change of status is then no kink of what it must hold */
static PetscErrorCode InfluencesTake(Many *m, ManyBasis *basis)
{
  const PetscInt n_pairs = m->s->rows.n_pairs;
  PetscReal     *p;
  char          *changes, *all, *own = &m->closed[(size_t)(m->n - 1) * n_pairs];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(m->s->n_parameters, &p));
  PetscCall(PetscCalloc1(n_pairs, &changes));
  PetscCall(m->get(m->ctx, m->n - 1, p));
  for (PetscInt i = 0; i < m->n; i++)
    for (PetscInt k = 0; k < n_pairs; k++)
      if (m->closed[(size_t)i * n_pairs + k] != own[k]) changes[k] = 1;
  PetscCall(GatherRecords(m->s->comm, n_pairs, 1, changes, NULL, &all));
  for (PetscInt k = 0; k < basis->model.n_pairs && basis->model.n < MANY_INFLUENCES; k++) {
    if (!all[k]) continue;
    PetscCall(ManyInfluence(m->s, p, own, k));
    PetscCall(ManyBasisAdd(basis));
  }
  basis->n_influences = basis->model.n;
  PetscCall(PetscFree(all));
  PetscCall(PetscFree(changes));
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

/* Those whose status the basis does not tell */
static PetscErrorCode RestRun(Many *m, PetscInt n_open, const PetscInt list[])
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n_open; k++) PetscCall(MeshSolve(m, list[k], PETSC_TRUE));
  PetscFunctionReturn(0);
}

/* The last point first, which is the scene's own */
static PetscErrorCode ManyRun(Many *m, PetscInt list[], ManyBasis *basis)
{
  PetscInt  n_open = 0;
  PetscBool good;

  PetscFunctionBeginUser;
  PetscCall(MeshSolve(m, m->n - 1, PETSC_FALSE));
  PetscCall(BeginTake(m, m->n - 1));
  PetscCall(ManyIsOffered(m, &good));
  if (good && m->n > MANY_FIRST) PetscCall(ManyBasisCreate(m->s, basis, &good));
  if (!good || m->n <= MANY_FIRST) {
    for (PetscInt i = 0; i < m->n - 1; i++) PetscCall(MeshSolve(m, i, PETSC_FALSE));
    PetscFunctionReturn(0);
  }
  PetscCall(ManyBasisAdd(basis));
  for (PetscInt i = 0; i < m->n - 1; i++) {
    if (i < MANY_FIRST) PetscCall(ManyPointTake(m, basis, i));
    if (m->error[i] >= 0) list[n_open++] = i;
  }
  PetscCall(OpenSolve(m, basis, &n_open, list));
  if (n_open) PetscCall(InfluencesTake(m, basis));
  if (n_open) PetscCall(OpenRefine(m, basis, &n_open, list));
  while (n_open && basis->model.n < MANY_MOST) {
    PetscCall(OpenSolve(m, basis, &n_open, list));
    if (n_open) PetscCall(OpenRefine(m, basis, &n_open, list));
  }
  PetscCall(RestRun(m, n_open, list));
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsSolveMany(Statics s, PetscInt n, StaticsPoint get, void *ctx, char closed[], StaticsMany *how)
{
  Many      m     = {.s = s, .n = n, .get = get, .ctx = ctx, .closed = closed};
  ManyBasis basis = {.statics = s};
  PetscInt *list;

  PetscFunctionBeginUser;
  PetscCall(StaticsSetUp(s, NULL));
  PetscCall(PetscMalloc1(n, &list));
  PetscCall(PetscCalloc1(n, &m.error));
  PetscCall(PetscMalloc1(n, &m.load));
  for (PetscInt i = 0; i < n; i++) m.load[i].n = -1;
  PetscCall(ProgressBegin(&m.progress, "equilibria on the mesh", n));
  PetscCall(ManyRun(&m, list, &basis));
  PetscCall(ProgressEnd(&m.progress));
  *how = (StaticsMany){m.n_mesh, basis.model.n, m.ratio};
  PetscCall(ManyBasisDestroy(&basis));
  PetscCall(PetscFree(m.begin));
  PetscCall(PetscFree(m.error));
  PetscCall(PetscFree(m.load));
  PetscCall(PetscFree(list));
  PetscFunctionReturn(0);
}
