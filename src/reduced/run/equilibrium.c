/*
   The sliding state of a reduced model: eta and lambda_n of the closed pairs (N, E, mu as in linear.c, f the factors of
   the loads)

      Omega^2 eta - P'E lambda_n = P_l' f,      N P eta + N W E lambda_n = -g0 - N W_l f,

   with the set of closed pairs that has no tension and no penetration. A law in series with a pair is a line, c = o + s
   lambda_n: o adds to the gap, s to the diagonal; lines of laws that are not linear are laid anew until they are
   tangents. So is mu where it depends on the pressure, until it is that of the forces found. */
#include "reduced/reducedimpl.h"

#define EQUILIBRIUM_MAX_IT  100
#define EQUILIBRIUM_SETTLED 1e-11 /* of the largest force or closing */
/* Of the highest omega^2, on modes that are rigid: a body that nothing holds along some direction would make the
   system singular. */
#define EQUILIBRIUM_HOLD 1e-12

/* Unknowns: coordinates, then normal forces of the closed pairs */
typedef struct {
  const ReducedModel *model;
  const PetscReal    *loads;
  PetscInt            n, *pair; /* closed ones */
  SpringLine         *line;     /* [n_pairs] */
  SpringPoint        *point;    /* [n_pairs] */
  PetscReal          *mu;       /* [n_pairs] */
  PetscReal          *at;       /* [n_pairs] closings at which they are tangents, m */
  PetscReal          *A, *x;    /* [m + n]^2, [m + n] */
  PetscBLASInt       *pivot;
} SlidingSystem;

/* [Omega^2, -P'E; N P, N W E] (eta, lambda_n) = (P_l' f, -g0 - N W_l f), [m + n][m + n] by columns; unsymmetric by
   mu. */
static void SlidingSystemFill(SlidingSystem *s)
{
  const ReducedModel *model = s->model;
  const PetscInt      m = model->m, N = model->n_ports, size = m + s->n, first = 3 * model->n_pairs;
  const PetscReal     hold = EQUILIBRIUM_HOLD * model->omega2[m - 1];

  for (PetscInt i = 0; i < size * size; i++) s->A[i] = 0;
  for (PetscInt k = 0; k < m; k++) {
    s->A[k + size * k] = PetscMax(model->omega2[k], hold);
    s->x[k]            = 0;
    for (PetscInt l = 0; l < model->n_loads; l++) s->x[k] += model->P[k + m * (first + l)] * s->loads[l];
  }
  for (PetscInt j = 0; j < s->n; j++) {
    const PetscInt   port = 3 * s->pair[j];
    const PetscReal *P = &model->P[m * port], mu = s->mu[s->pair[j]];

    s->x[m + j] = -model->gap[s->pair[j]] - s->line[s->pair[j]].closing;
    for (PetscInt l = 0; l < model->n_loads; l++) s->x[m + j] -= model->W[port + N * (first + l)] * s->loads[l];
    s->x[m + j] -= ReducedMotionWay(model, s->loads, port);
    for (PetscInt k = 0; k < m; k++) {
      s->A[k + size * (m + j)] = -(P[k] - mu * P[m + k]);
      s->A[m + j + size * k]   = P[k];
    }
    for (PetscInt i = 0; i < s->n; i++) {
      const PetscReal *w = &model->W[3 * s->pair[i] + N * port];

      s->A[m + i + size * (m + j)] = w[0] - mu * w[N];
    }
    s->A[(size + 1) * (m + j)] += s->line[s->pair[j]].compliance;
  }
}

/* Coordinates and forces of the solution, displacements of the pairs */
static void SlidingSystemTake(const SlidingSystem *s, ReducedState *state)
{
  const ReducedModel *model = s->model;
  const PetscInt      first = 3 * model->n_pairs;

  for (PetscInt k = 0; k < model->m; k++) state->eta[k] = s->x[k];
  for (PetscInt i = 0; i < model->n_ports; i++) state->p[i] = 0;
  for (PetscInt l = 0; l < model->n_loads; l++) state->p[first + l] = s->loads[l];
  for (PetscInt j = 0; j < s->n; j++) {
    state->p[3 * s->pair[j]]     = s->x[model->m + j];
    state->p[3 * s->pair[j] + 1] = -s->mu[s->pair[j]] * s->x[model->m + j];
  }
  for (PetscInt i = 0; i < first; i++) state->y[i] = ReducedPortDisplacement(model, state->eta, state->p, i);
}

/* The pairs that are closed next: those with pressure, and open ones that penetrate; same where none changes */
static void SlidingSystemChoose(SlidingSystem *s, ReducedState *state, PetscBool *same)
{
  const ReducedModel *model = s->model;

  *same = PETSC_TRUE;
  s->n  = 0;
  for (PetscInt i = 0; i < model->n_pairs; i++) {
    const PetscBool was = state->status[i] == CONTACT_SLIP;
    const PetscBool is  = was ? state->p[3 * i] > 0 : model->gap[i] + s->line[i].closing + state->y[3 * i] < 0;

    if (is != was) *same = PETSC_FALSE;
    if (is) s->pair[s->n++] = i;
    state->status[i] = is ? CONTACT_SLIP : CONTACT_OPEN;
  }
}

/* From the closed pairs there are, by sets: pairs in tension open, open ones that penetrate close, until none
   changes. Not found: no pair is left, the system is singular, or sets repeat (EQUILIBRIUM_MAX_IT), as they may with
   large mu. */
static PetscErrorCode SlidingSystemSolve(SlidingSystem *s, ReducedState *state, PetscBool *found)
{
  const PetscInt m        = s->model->m;
  PetscBool      singular = PETSC_FALSE;

  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  for (PetscInt it = 0; it < EQUILIBRIUM_MAX_IT && !*found && s->n; it++) {
    SlidingSystemFill(s);
    PetscCall(DenseFactor(m + s->n, s->A, s->pivot, &singular));
    if (singular) break;
    PetscCall(DenseSolve(m + s->n, s->A, s->pivot, PETSC_FALSE, 1, s->x));
    SlidingSystemTake(s, state);
    SlidingSystemChoose(s, state, found);
  }
  PetscFunctionReturn(0);
}

/* mu at the forces found; settled where it was */
static void SlidingSystemRub(SlidingSystem *s, const ReducedState *state, PetscBool *settled)
{
  for (PetscInt i = 0; i < s->model->n_pairs; i++) {
    const FrictionLaw law = FrictionPressed(&s->model->friction[i], state->p[3 * i]);
    const PetscReal   mu  = FrictionSteady(&law);

    if (PetscAbsReal(mu - s->mu[i]) > EQUILIBRIUM_SETTLED * PetscAbsReal(mu)) *settled = PETSC_FALSE;
    s->mu[i] = mu;
  }
}

/* Lines laid anew at the forces and closings found; settled where all had them already, to EQUILIBRIUM_SETTLED */
static void SlidingSystemLay(SlidingSystem *s, const ReducedState *state, PetscBool *settled)
{
  const ReducedModel *model = s->model;

  *settled = PETSC_TRUE;
  SlidingSystemRub(s, state, settled);
  if (!model->spring) return;
  for (PetscInt i = 0; i < model->n_pairs; i++)
    s->point[i] = (SpringPoint){PetscMax(0, state->p[3 * i]), -model->gap[i] - state->y[3 * i]};
  if (SpringsMiss(model->n_pairs, model->spring, s->point) > EQUILIBRIUM_SETTLED) *settled = PETSC_FALSE;
  SpringsLay(model->n_pairs, model->spring, s->point, s->at, s->line);
}

/* All pairs closed, lines at the onsets of their laws */
static void SlidingSystemBegin(SlidingSystem *s, ReducedState *state)
{
  const ReducedModel *model = s->model;

  s->n = model->n_pairs;
  for (PetscInt i = 0; i < model->n_pairs; i++) {
    s->pair[i]       = i;
    state->status[i] = CONTACT_SLIP;
    s->at[i]         = model->spring ? SpringOnset(&model->spring[i]) : 0;
    s->mu[i]         = FrictionSteady(&model->friction[i]);
    s->line[i]       = model->spring ? SpringTangent(&model->spring[i], s->at[i]) : (SpringLine){0, 0};
  }
}

PetscErrorCode ReducedEquilibrium(const ReducedModel *model, const PetscReal loads[], ReducedState *state,
                                  PetscBool *found)
{
  const PetscInt n = model->n_pairs, most = model->m + n;
  SlidingSystem  s       = {.model = model, .loads = loads};
  PetscBool      settled = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc7(n, &s.pair, n, &s.line, n, &s.point, n, &s.at, most * most, &s.A, most, &s.x, most, &s.pivot));
  PetscCall(PetscMalloc1(n, &s.mu));
  SlidingSystemBegin(&s, state);
  *found = PETSC_TRUE;
  for (PetscInt it = 0; it < EQUILIBRIUM_MAX_IT && *found && !settled; it++) {
    PetscCall(SlidingSystemSolve(&s, state, found));
    SlidingSystemLay(&s, state, &settled);
  }
  if (!settled) *found = PETSC_FALSE;
  for (PetscInt k = 0; k < model->m; k++) state->rate[k] = 0;
  PetscCall(PetscArraycpy(state->last, state->p, model->n_ports));
  PetscCall(PetscArraycpy(state->begin, state->p, 3 * model->n_pairs));
  PetscCall(PetscArraycpy(state->q, state->p, 3 * model->n_pairs));
  state->time = 0;
  PetscCall(PetscFree(s.mu));
  PetscCall(PetscFree7(s.pair, s.line, s.point, s.at, s.A, s.x, s.pivot));
  PetscFunctionReturn(0);
}
