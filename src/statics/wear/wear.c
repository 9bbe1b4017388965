/*
   Bedding-in and wear: gaps that grow while bodies slide in equilibrium, at each pair

      dg0/dt = (k_s + k_m) p^a v,   p = lambda_n / A   (m/s),

   by implicit steps dt from the sliding state without wear. In a step the wear is a compliance of the pair (law.c), so
   that a step is one small problem of the pairs, from the statuses of the step before; bodies, loads, factorisation and
   compliance are those of the state. -wear_depth shortens the last step. For a = 1 the volume worn and the work of
   friction are each other's multiple,

      V = sum A dg0,   E = sum |mu| lambda_n v dt,   V = (k_s + k_m) E / |mu|,

   which wear.csv shows from gaps and areas, and from forces: V is no sum of forces. The error of the steps in the depth
   of a pair is estimated by what the trapezoidal rule adds over the same pressures,

      sum (W / 2) (p_n^a - p_(n+1)^a),

   the first order of the error in dt; wear that gives pressure away makes the true one smaller with time. With
   -stages contacts wear in the last one, and the state is that of all stages once more with the worn gaps. */
#include "statics/staticsimpl.h"
#include "base/text.h"

#define DEPTH_STEPS 100 /* trials of the last step, to end at -wear_depth to DEPTH_RTOL of it */
#define DEPTH_RTOL  1e-10
#define DEPTH_MISS  1e-6 /* of it, beyond which a depth that no length meets, for forces are not exact, is an error */

/* What a step changes */
typedef struct {
  Statics            s;
  const ContactWear *options;
  Active            *active;
  OperatorsWear     *wear;          /* [n_pairs] */
  PetscReal         *w, *force;     /* [n_pairs] W of the step, m / Pa^a; lambda_n before, N */
  PetscReal         *slid, *error;  /* [n_pairs] until now: work of friction, J; error of the depth, m, signed */
  PetscReal          time, deepest; /* s; over all ranks, m */
} Wearing;

/* Depth of a pair (m), after the step that is being tried; 0 outside of it */
static PetscReal WearDepth(const Wearing *g, PetscInt p)
{
  const PairRows *rows = &g->s->rows;

  return g->s->worn[p] +
         (rows->wearing ? PairWorn(rows, p, g->active->compliance->kappa * g->active->l[rows->first[p]]) : 0);
}

static PetscErrorCode WearFindDeepest(const Wearing *g, PetscReal *deepest)
{
  PetscFunctionBeginUser;
  *deepest = 0;
  for (PetscInt p = 0; p < g->s->rows.n_pairs; p++) *deepest = PetscMax(*deepest, WearDepth(g, p));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, deepest, 1, MPIU_REAL, MPI_MAX, g->s->comm));
  PetscFunctionReturn(0);
}

/* Forces at the end of a step of dt seconds, with the tangents of laws that are not linear at those before */
static PetscErrorCode WearTry(Wearing *g, PetscReal dt)
{
  PairRows       *rows  = &g->s->rows;
  const PetscReal kappa = g->active->compliance->kappa;

  PetscFunctionBeginUser;
  rows->wear    = g->w;
  rows->wearing = PETSC_TRUE;
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    g->w[p] = g->wear[p].rate * g->wear[p].speed * dt;
    PairRowsSetClosing(rows, p, kappa, PairClosing(rows, p, g->force[p]));
  }
  PetscCall(EquilibriumFind(g->active));
  PetscFunctionReturn(0);
}

/* Length of a step between low, not deep enough, and high, too deep, {s, m}: by the secant in the Illinois form, which
   halves how far an end that stays is off, so that both ends move; each third one by bisection, for depths that jump */
static PetscErrorCode WearFindLength(Wearing *g, PetscReal low[2], PetscReal high[2], PetscReal *dt)
{
  const PetscReal most   = g->options->depth;
  PetscReal       off[2] = {low[1] - most, high[1] - most}, miss = off[1];
  int             stayed = -1;

  PetscFunctionBeginUser;
  for (int i = 1; i <= DEPTH_STEPS && PetscAbsReal(miss) > DEPTH_RTOL * most; i++) {
    const PetscReal part = i % 3 ? -off[0] / (off[1] - off[0]) : 0.5;
    PetscReal       deepest;
    int             moved;

    *dt = low[0] + part * (high[0] - low[0]);
    if (*dt <= low[0] || *dt >= high[0]) break;
    PetscCall(WearTry(g, *dt));
    PetscCall(WearFindDeepest(g, &deepest));
    miss                    = deepest - most;
    moved                   = miss < 0 ? 0 : 1;
    (moved ? high : low)[0] = *dt;
    (moved ? high : low)[1] = deepest;
    off[moved]              = miss;
    if (stayed == 1 - moved) off[stayed] /= 2;
    stayed = 1 - moved;
  }
  PetscCheck(PetscAbsReal(miss) <= DEPTH_MISS * most, g->s->comm, PETSC_ERR_NOT_CONVERGED,
             "-wear_depth %g: between %.15g and %.15g s of a step the depth goes from %.6g to %.6g m, and no length "
             "between them ends there; give more -wear_steps",
             (double)most, (double)low[0], (double)high[0], (double)low[1], (double)high[1]);
  PetscFunctionReturn(0);
}

/* A step of at most *dt, shorter where it would wear deeper than -wear_depth */
static PetscErrorCode WearStep(Wearing *g, PetscReal *dt, PetscBool *ends)
{
  PetscReal low[2] = {0, g->deepest}, high[2] = {*dt, 0};

  PetscFunctionBeginUser;
  *ends = PETSC_FALSE;
  PetscCall(WearTry(g, *dt));
  PetscCall(WearFindDeepest(g, &high[1]));
  if (g->options->depth == 0 || high[1] < g->options->depth) PetscFunctionReturn(0);
  *ends = PETSC_TRUE;
  PetscCall(WearFindLength(g, low, high, dt));
  PetscFunctionReturn(0);
}

/* Adds a pair to the row of its interface, with its force before the step */
static void WearAddPair(const Wearing *g, PetscInt p, PetscReal before, WearRow *row)
{
  const PairRows *rows  = &g->s->rows;
  const PetscReal area  = rows->pair[p].area;
  const PetscReal force = g->force[p];

  row->depth = PetscMax(row->depth, g->s->worn[p]);
  row->error = PetscMax(row->error, PetscAbsReal(g->error[p]));
  row->volume += area * g->s->worn[p];
  row->work += g->slid[p];
  row->force += force;
  row->pressure = PetscMax(row->pressure, force / area);
  row->change   = PetscMax(row->change, PetscAbsReal(force - before) / area);
  row->n_closed += g->s->status[p] != CONTACT_OPEN;
}

/* Makes a row one of all ranks */
static PetscErrorCode WearShareRow(MPI_Comm comm, WearRow *row)
{
  PetscReal most[4] = {row->depth, row->pressure, row->change, row->error};
  PetscReal sum[3]  = {row->volume, row->work, row->force};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 4, MPIU_REAL, MPI_MAX, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPI_SUM, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &row->n_closed, 1, MPIU_INT, MPI_SUM, comm));
  row->depth    = most[0];
  row->pressure = most[1];
  row->change   = most[1] > 0 ? most[2] / most[1] : 0;
  row->error    = most[3];
  row->volume   = sum[0];
  row->work     = sum[1];
  row->force    = sum[2];
  PetscFunctionReturn(0);
}

/* Takes what a step of dt found: gaps, forces, and a row of each interface that wears; *change: the largest of them */
static PetscErrorCode WearTake(Wearing *g, PetscInt step, PetscReal dt, PetscReal *change)
{
  Statics    s    = g->s;
  PairRows  *rows = &s->rows;
  WearRow   *row  = &s->wear_row[s->n_wear];
  PetscReal *before;

  PetscFunctionBeginUser;
  *change = 0;
  g->time += dt;
  PetscCall(PetscMalloc1(rows->n_pairs, &before));
  PetscCall(PetscArraycpy(before, g->force, rows->n_pairs));
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    const PetscReal force = PetscMax(0, g->active->compliance->kappa * g->active->l[rows->first[p]]);
    const PetscReal grown = PairWorn(rows, p, force);

    g->error[p] += (PairWorn(rows, p, g->force[p]) - grown) / 2;
    s->worn[p] += grown;
    rows->law[p].g0 += grown;
    g->force[p] = force;
    g->slid[p] += PetscAbsReal(rows->slide[p]) * force * g->wear[p].speed * dt;
  }
  rows->wearing = PETSC_FALSE;
  for (PetscInt i = 0; i < rows->n_interfaces; i++) {
    if (!ContactWears(&rows->interface[i])) continue;
    *row = (WearRow){.step = step, .interface = i, .time = g->time};
    for (PetscInt p = 0; p < rows->n_pairs; p++)
      if (rows->pair[p].interface == i) WearAddPair(g, p, before[p], row);
    PetscCall(WearShareRow(s->comm, row));
    *change = PetscMax(*change, row->change);
    row++;
    s->n_wear++;
  }
  PetscCall(PetscFree(before));
  PetscCall(WearFindDeepest(g, &g->deepest));
  PetscFunctionReturn(0);
}

/* All steps, from the state of the last solution */
static PetscErrorCode WearRun(Wearing *g, PetscReal time)
{
  const PetscReal dt     = time / (PetscReal)g->options->steps;
  PetscReal       change = PETSC_MAX_REAL;
  PetscBool       ends   = PETSC_FALSE;
  char            after[96];

  PetscFunctionBeginUser;
  for (PetscInt step = 1; step <= g->options->steps && !ends; step++) {
    PetscReal taken = dt;

    PetscCall(PetscSNPrintf(after, sizeof(after), " in step %" PetscInt_FMT " of the wear, after %.6g s", step,
                            (double)g->time));
    PetscCall(StaticsPlace(g->s, g->active->place, sizeof(g->active->place)));
    PetscCall(WordsAdd(g->active->place, after, sizeof(g->active->place)));
    PetscCall(WearStep(g, &taken, &ends));
    PetscCall(WearTake(g, step, taken, &change));
    if (g->options->settled > 0 && change <= g->options->settled) ends = PETSC_TRUE;
  }
  PetscFunctionReturn(0);
}

/* Room, rates, and the forces of the last solution */
static PetscErrorCode WearBegin(Wearing *g)
{
  Statics   s    = g->s;
  PairRows *rows = &s->rows;

  PetscFunctionBeginUser;
  PetscCall(
    PetscMalloc4(rows->n_pairs, &g->wear, rows->n_pairs, &g->w, rows->n_pairs, &g->force, rows->n_pairs, &g->slid));
  PetscCall(PetscCalloc1(rows->n_pairs, &g->error));
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    PetscCall(OperatorsGetPairWear(s->operators, s->p, &rows->pair[p], &g->wear[p]));
    if (!rows->slides[rows->pair[p].interface]) g->wear[p].rate = 0;
    g->force[p] = PetscMax(0, s->state[p].lambda_n);
    g->slid[p]  = 0;
  }
  PetscCall(PetscFree(s->wear_row));
  PetscCall(PetscMalloc1(g->options->steps * rows->n_interfaces, &s->wear_row));
  PetscCall(EquilibriumBegin(s, g->active));
  PetscCall(EquilibriumFree(g->active));
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsWear(Statics s, PetscBool *worn)
{
  Active    active = {.rows = &s->rows, .compliance = &s->compliance, .status = s->status, .passing = PETSC_TRUE};
  Wearing   g      = {.s = s, .active = &active};
  PetscReal time   = 0;

  PetscFunctionBeginUser;
  if (s->wears) PetscCall(OperatorsGetWearTime(s->operators, s->p, &time));
  *worn = time > 0 ? PETSC_TRUE : PETSC_FALSE;
  if (!*worn) PetscFunctionReturn(0);
  PetscCall(ContactGetWear(s->contact, &g.options));
  PetscCall(StaticsCreateLoad(s->operators, s->p, StagesGet(s, s->stage), &active.f, &active.size));
  PetscCall(VecDuplicate(active.f, &active.u));
  PetscCall(PetscCalloc1(s->rows.n, &active.l));
  PetscCall(WearBegin(&g));
  PetscCall(WearRun(&g, time));
  s->n_it += active.n_it;
  s->n_factored += active.n_factored;
  PetscCall(EquilibriumEnd(&active));
  PetscCall(PetscFree4(g.wear, g.w, g.force, g.slid));
  PetscCall(PetscFree(g.error));
  PetscCall(PetscFree(active.l));
  PetscCall(VecDestroy(&active.u));
  PetscCall(VecDestroy(&active.f));
  PetscFunctionReturn(0);
}
