/* Random points of what is said to be quiet, on the reduced model, and some of them by full solutions */
#include "quietimpl.h"
#include "sample/draw/sequence.h"

#define TRIES 1000 /* for each point, in the parts of the box that are quiet */

/* Whether t is in a quiet cell */
static PetscBool IsInQuietCell(const Quiet q, const PetscReal t[])
{
  for (PetscInt i = 0; i < q->n_cells; i++) {
    const QuietCell *cell   = &q->cell[i];
    PetscBool        inside = cell->state == CELL_QUIET && !cell->split ? PETSC_TRUE : PETSC_FALSE;

    for (PetscInt k = 0; k < q->cube.n && inside; k++)
      if (t[k] < cell->low[k] || t[k] > cell->high[k]) inside = PETSC_FALSE;
    if (inside) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Point i: of the largest box, or of the parts; false where none was hit. `at` goes on along the sequence */
static PetscBool PointInside(const Quiet q, const Sequence *sequence, PetscInt *at, PetscReal t[])
{
  for (int attempt = 0; attempt < TRIES; attempt++) {
    SequencePoint(sequence, (*at)++, t);
    for (PetscInt k = 0; k < q->cube.n; k++) {
      t[k] = 2 * t[k] - 1;
      if (q->goal == QUIET_BOX) t[k] = q->cube.own[k] + q->size * (t[k] - q->cube.own[k]);
    }
    if (q->goal == QUIET_BOX || IsInQuietCell(q, t)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* The same point in full */
static PetscErrorCode CheckFull(Quiet q, const PetscReal t[])
{
  QuietChecks *c = &q->checks;
  ReducedModes modes;
  FullCheck    check = {0};
  BoxFull      full;
  PetscReal   *p;
  PetscBool    other;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(q->cube.n_parameters, &p));
  CubePoint(&q->cube, t, p);
  PetscCall(BoxSolve(&q->box, q->box.small.n_used ? PETSC_TRUE : PETSC_FALSE, p, &modes));
  PetscCall(BoxSolveFull(&q->box, p, &full));
  other = q->box.statics && full.status != q->box.status[0] ? PETSC_TRUE : PETSC_FALSE;
  FullCompare(&q->box.window, &q->box.limit, full.n, full.mode, &modes, &check);
  for (PetscInt i = 0; i < full.n; i++)
    if (!full.mode[i].rigid) c->full_growth = PetscMax(c->full_growth, full.mode[i].sigma);
  c->n_full++;
  c->n_full_other += other;
  c->n_full_unstable += check.n_unstable_full > 0 ? 1 : 0;
  c->n_beyond += other ? 0 : check.n_beyond;
  c->true_error = PetscMax(c->true_error, other ? 0 : check.error);
  PetscCall(ReducedModesDestroy(&modes));
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

/* Sums of all ranks */
static PetscErrorCode ChecksShare(Quiet q)
{
  QuietChecks *c       = &q->checks;
  PetscReal    most[2] = {c->growth, c->error};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &c->n_unstable, 1, MPIU_INT, MPI_SUM, q->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 2, MPIU_REAL, MPI_MAX, q->comm));
  c->growth = most[0], c->error = most[1];
  PetscFunctionReturn(0);
}

PetscErrorCode QuietCheck(Quiet q)
{
  Sequence     sequence = {SEQUENCE_RANDOM, (uint64_t)q->seed, PETSC_MAX_INT, q->cube.n, NULL};
  QuietChecks *c        = &q->checks;
  PetscReal    t[CUBE_MAX_VARIABLES], worst;
  PetscInt     at = 0;
  PetscMPIInt  rank;

  PetscFunctionBeginUser;
  c->growth = c->full_growth = PETSC_NINFINITY;
  PetscCallMPI(MPI_Comm_rank(q->comm, &rank));
  if (q->goal == QUIET_BOX ? q->size <= 0 : q->share[CELL_QUIET] <= 0) PetscFunctionReturn(0);
  PetscCall(SequenceSetUp(&sequence));
  for (PetscInt i = 0; i < PetscMax(q->n_random, q->n_verify) && PointInside(q, &sequence, &at, t); i++) {
    DangerPoint here;
    PetscBool   unstable;

    if (i < q->n_verify) PetscCall(CheckFull(q, t));
    if (i < q->n_random) c->n++;
    if (i >= q->n_random || PointGroupsOwner(&q->box.groups, i) != rank) continue;
    PetscCall(QuietLook(q, t, &here, &worst, &unstable));
    c->n_unstable += unstable;
    if (!PetscIsNanReal(here.sigma)) c->growth = PetscMax(c->growth, here.sigma);
    c->error = PetscMax(c->error, worst);
  }
  PetscCall(SequenceDestroy(&sequence));
  PetscCall(ChecksShare(q));
  PetscFunctionReturn(0);
}
