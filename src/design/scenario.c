/* A design at all scenarios of what is uncertain, on the reduced model: which modes are unstable, and their cuts */
#include "designimpl.h"
#include "sample/draw/sequence.h"

#define MOST_CORNERS 64
#define MOST_MODES   4   /* cuts of a scenario */
#define MOST_CUTS    400 /* beyond them the oldest are dropped */

/* The scene's own values, corners, points of a sequence */
PetscErrorCode DesignScenarios(Design d)
{
  const PetscInt n = d->uncertain.n, n_corners = n ? PetscMin(1 << n, MOST_CORNERS) : 0, n_inside = n ? d->n_inside : 0;
  Sequence       sequence = {SEQUENCE_SOBOL, 1, PetscMax(1, n_inside), PetscMax(1, n), NULL};
  PetscInt       room;

  PetscFunctionBeginUser;
  d->n_scenarios = 1 + n_corners + n_inside;
  room           = d->n_scenarios + d->max_designs; /* corners in full that reject a design become scenarios */
  PetscCall(PetscCalloc3(room * PetscMax(1, n), &d->scenario, room, &d->status, room, &d->apart));
  PetscCall(SequenceSetUp(&sequence));
  for (PetscInt k = 0; k < n; k++) d->scenario[k] = d->uncertain.own[k];
  for (PetscInt i = 1; i < d->n_scenarios; i++) {
    PetscReal *t = &d->scenario[i * n];

    if (i > n_corners) SequencePoint(&sequence, i - 1 - n_corners, t);
    for (PetscInt k = 0; k < n; k++)
      t[k] = i > n_corners ? 2 * t[k] - 1 : (i - 1) >> (k % 6) & 1 ? 1 : -1; /* beyond six some move alike */
  }
  PetscCall(SequenceDestroy(&sequence));
  PetscFunctionReturn(0);
}

PetscErrorCode DesignAddScenario(Design d, const PetscReal t[], PetscBool *added)
{
  const PetscInt n = d->uncertain.n;

  PetscFunctionBeginUser;
  *added = PETSC_TRUE;
  for (PetscInt i = 0; i < d->n_scenarios && *added; i++) {
    PetscBool same;

    PetscCall(PetscArraycmp(t, &d->scenario[i * n], n, &same));
    if (same) *added = PETSC_FALSE;
  }
  if (!*added) PetscFunctionReturn(0);
  PetscCall(PetscArraycpy(&d->scenario[d->n_scenarios * n], t, n));
  d->status[d->n_scenarios++] = d->status[d->point[d->best].worst];
  PetscFunctionReturn(0);
}

void DesignParameters(const Design d, const PetscReal z[], const PetscReal t[], PetscReal p[])
{
  CubePoint(&d->cube, z, p);
  CubeMove(&d->uncertain, t, p);
}

PetscErrorCode DesignKnow(Design d, const PetscReal z[], const PetscReal t[], PetscInt status)
{
  const PetscInt n = d->cube.n + d->uncertain.n;

  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)((d->n_known + 1) * n) * sizeof(*d->known), &d->known));
  PetscCall(PetscRealloc((size_t)(d->n_known + 1) * sizeof(*d->known_status), &d->known_status));
  PetscCall(PetscArraycpy(&d->known[d->n_known * n], z, d->cube.n));
  PetscCall(PetscArraycpy(&d->known[d->n_known * n + d->cube.n], t, d->uncertain.n));
  d->known_status[d->n_known++] = status;
  PetscFunctionReturn(0);
}

/* A design whose statuses are asked for */
typedef struct {
  Design           design;
  const PetscReal *z;
} DesignAt;

static PetscErrorCode ScenarioGet(void *ctx, PetscInt i, PetscReal p[])
{
  const DesignAt *at = ctx;
  const Design    d  = at->design;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(p, d->box.nominal, d->box.n_base));
  CubeMove(&d->cube, at->z, p);
  CubeMove(&d->uncertain, &d->scenario[i * d->uncertain.n], p);
  PetscFunctionReturn(0);
}

/* The class of each scenario of this design, which those looked at from now on take until others are found; whether
   one has changed */
PetscErrorCode DesignFindStatuses(Design d, const PetscReal z[], PetscBool *changed)
{
  PetscInt *before;

  PetscFunctionBeginUser;
  *changed = PETSC_FALSE;
  if (!d->box.statics) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(d->n_scenarios, &before));
  PetscCall(PetscArraycpy(before, d->status, d->n_scenarios));
  PetscCall(BoxFindClasses(&d->box, d->n_scenarios, ScenarioGet, &(DesignAt){d, z}, d->status, d->apart));
  for (PetscInt i = 0; i < d->n_scenarios; i++) {
    if (before[i] != d->status[i]) *changed = PETSC_TRUE;
    if (!d->apart[i]) PetscCall(DesignKnow(d, z, &d->scenario[i * d->uncertain.n], d->status[i]));
  }
  PetscCall(PetscFree(before));
  PetscFunctionReturn(0);
}

/* How many classes the scenarios have, and how many scenarios none of them */
static void StatusesCount(const Design d, DesignPoint *point)
{
  point->n_classes = point->n_apart = point->apart = 0;
  for (PetscInt i = 0; i < d->n_scenarios; i++) {
    PetscInt first = 0;

    while (d->status[first] != d->status[i]) first++;
    point->n_classes += first == i ? 1 : 0;
    point->n_apart += d->apart[i] ? 1 : 0;
    point->apart = PetscMax(point->apart, d->apart[i]);
  }
}

/* A scenario of a design */
typedef struct {
  PetscReal excess, omega;
  PetscInt  n_unstable, n_cuts, index;
  DesignCut cut[MOST_MODES];
} Scenario;

/* The cut of mode i */
static PetscErrorCode CutOf(const Design d, const PetscReal p[], const ReducedModes *modes, PetscInt i,
                            const PetscReal z[], DesignCut *cut)
{
  const Reduced   *reduced  = modes->size == d->box.small.n_used ? &d->box.small : &d->box.basis.reduced;
  const ModesLimit in_force = ModesLimitInForce(&d->box.limit);
  const PetscReal  sigma = creal(modes->lambda[i]), limit = ModesLimitGrowth(&in_force, cabs(modes->lambda[i]));
  const PetscBool  damped = ReducedIsDamped(reduced, p);
  PetscComplex    *derivative;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(reduced->n_parameters, &derivative));
  PetscCall(ReducedSensitivity(reduced, p, modes, i, derivative));
  cut->a = damped ? sigma - limit : sigma * sigma - limit * limit;
  for (PetscInt k = 0; k < d->cube.n; k++) {
    PetscReal slope = 0;

    for (PetscInt m = 0; m < d->cube.n_moved[k]; m++)
      slope += creal(derivative[d->cube.moved[k][m]]) * 0.5 * (d->cube.upper[k][m] - d->cube.lower[k][m]);
    cut->g[k]  = damped ? slope : 2 * sigma * slope;
    cut->at[k] = z[k];
  }
  PetscCall(PetscFree(derivative));
  PetscFunctionReturn(0);
}

/* Not collective */
static PetscErrorCode ScenarioLook(const Design d, const PetscReal z[], Scenario *s)
{
  const Box       *box      = &d->box;
  const ModesLimit in_force = ModesLimitInForce(&box->limit);
  PetscReal       *p;
  ReducedModes     modes;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(d->cube.n_parameters, &p));
  DesignParameters(d, z, &d->scenario[s->index * d->uncertain.n], p);
  BoxPutClass(box, d->status[s->index], p);
  PetscCall(BoxSolve(box, box->small.n_used ? PETSC_TRUE : PETSC_FALSE, p, &modes));
  s->excess     = PETSC_NINFINITY;
  s->n_unstable = s->n_cuts = 0;
  for (PetscInt i = 0; i < modes.n; i++) {
    const PetscReal sigma = creal(modes.lambda[i]), omega = cimag(modes.lambda[i]);
    const PetscReal excess = sigma - ModesLimitGrowth(&in_force, cabs(modes.lambda[i]));

    if (!BoxHolds(box, modes.lambda[i])) continue;
    if (excess > s->excess) s->excess = excess, s->omega = omega;
    if (ModesLimitJudge(&box->limit, sigma, omega, modes.error[i]) != MODE_UNSTABLE) continue;
    s->n_unstable++;
    if (s->n_cuts < MOST_MODES) PetscCall(CutOf(d, p, &modes, i, z, &s->cut[s->n_cuts++]));
  }
  PetscCall(ReducedModesDestroy(&modes));
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

/* Keeps the cuts of a scenario; a mode that nothing changes gives none */
static PetscErrorCode CutsKeep(Design d, const Scenario *s)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < s->n_cuts; i++) {
    PetscReal size = 0;

    for (PetscInt k = 0; k < d->cube.n; k++) size += PetscSqr(s->cut[i].g[k]);
    if (!(size > 0) || PetscIsInfOrNanReal(size)) continue;
    if (d->n_cuts == MOST_CUTS) {
      PetscCall(PetscArraymove(d->cut, d->cut + 1, MOST_CUTS - 1));
      d->n_cuts--;
    }
    if (!d->cut) PetscCall(PetscMalloc1(MOST_CUTS, &d->cut));
    d->cut[d->n_cuts++] = s->cut[i];
  }
  PetscFunctionReturn(0);
}

void DesignForget(Design d, const PetscReal good[])
{
  PetscInt n = 0;

  for (PetscInt i = 0; i < d->n_cuts; i++) {
    PetscReal a = d->cut[i].a;

    for (PetscInt k = 0; k < d->cube.n; k++) a += d->cut[i].g[k] * (good[k] - d->cut[i].at[k]);
    if (a <= 0) d->cut[n++] = d->cut[i];
  }
  d->n_cuts = n;
}

/* Larger excess first */
static int CompareScenarios(const void *a, const void *b)
{
  const Scenario *x = a, *y = b;

  if (x->excess != y->excess) return x->excess < y->excess ? 1 : -1;
  return x->index < y->index ? -1 : x->index > y->index;
}

/* s[i] := scenario index[i] of a design, each looked at by the rank that it falls to. Collective */
static PetscErrorCode ScenariosLook(const Design d, const PetscReal z[], PetscInt n, const PetscInt index[],
                                    Scenario s[])
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(d->comm, &rank));
  for (PetscInt i = 0; i < n; i++) {
    s[i] = (Scenario){.index = index ? index[i] : i};
    if (PointGroupsOwner(&d->box.groups, i) == rank) PetscCall(ScenarioLook(d, z, &s[i]));
  }
  for (PetscInt i = 0; i < n; i++)
    PetscCallMPI(MPI_Bcast(&s[i], (PetscMPIInt)sizeof(*s), MPI_BYTE, PointGroupsOwner(&d->box.groups, i), d->comm));
  PetscFunctionReturn(0);
}

/* With a probability of growth the worst scenarios, that share of them, may stay as they are */
PetscErrorCode DesignLook(Design d, PetscBool keep, DesignPoint *point)
{
  const PetscInt n       = d->n_scenarios;
  const PetscInt allowed = (PetscInt)PetscFloorReal(d->probability * (PetscReal)n + 1e-9);
  Scenario      *s;

  PetscFunctionBeginUser;
  StatusesCount(d, point);
  point->n_unstable = point->n_scenarios = 0;
  PetscCall(PetscMalloc1(n, &s));
  PetscCall(ScenariosLook(d, point->z, n, NULL, s));
  qsort(s, (size_t)n, sizeof(*s), CompareScenarios);
  point->excess = s[allowed].excess;
  point->omega  = s[allowed].omega;
  point->worst  = s[allowed].index;
  for (PetscInt i = 0; i < n; i++) {
    point->n_unstable += s[i].n_unstable;
    point->n_scenarios += s[i].n_unstable ? 1 : 0;
    if (i >= allowed && keep) PetscCall(CutsKeep(d, &s[i]));
  }
  PetscCall(PetscFree(s));
  PetscFunctionReturn(0);
}

PetscErrorCode DesignGlance(Design d, const PetscReal z[], PetscReal bound, PetscInt order[], PetscReal *excess,
                            PetscBool *unstable)
{
  const PetscInt n = d->n_scenarios, step = d->box.groups.n_groups;
  PetscBool      enough = PETSC_FALSE;
  Scenario      *s;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(step, &s));
  *excess = PETSC_NINFINITY;
  if (unstable) *unstable = PETSC_FALSE;
  for (PetscInt first = 0; first < n && !enough; first += step) {
    const PetscInt n_looked = PetscMin(step, n - first);

    PetscCall(ScenariosLook(d, z, n_looked, &order[first], s));
    for (PetscInt k = 0; k < n_looked; k++) {
      *excess = PetscMax(*excess, s[k].excess);
      if (unstable && s[k].n_unstable) *unstable = PETSC_TRUE;
      if (s[k].excess <= bound && !(unstable && s[k].n_unstable)) continue;
      enough = PETSC_TRUE;
      PetscCall(PetscArraymove(&order[1], order, first + k));
      order[0] = s[k].index;
    }
  }
  PetscCall(PetscFree(s));
  PetscFunctionReturn(0);
}
