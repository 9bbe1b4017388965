/*
   The sliding state of a reduced model: eta and lambda_n of the closed pairs (N, E, mu as in linear.c, f the factors of
   the loads)

      Omega^2 eta - P'E lambda_n = P_l' f,      N P eta + N W E lambda_n = -g0 - N W_l f,

   with the set of closed pairs that has no tension and no penetration.
*/
#include "reduced/reducedimpl.h"

#define EQUILIBRIUM_MAX_IT 100
/* Of the highest omega^2, on modes that are rigid: a body that nothing holds along some direction would make the
   system singular. */
#define EQUILIBRIUM_HOLD 1e-12

/* Unknowns: coordinates, then normal forces of the closed pairs */
typedef struct {
  const ReducedModel *model;
  const PetscReal    *loads;
  PetscInt            n, *pair; /* closed ones */
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
    const PetscReal *P = &model->P[m * port], mu = FrictionSteady(&model->friction[s->pair[j]]);

    s->x[m + j] = -model->gap[s->pair[j]];
    for (PetscInt l = 0; l < model->n_loads; l++) s->x[m + j] -= model->W[port + N * (first + l)] * s->loads[l];
    for (PetscInt k = 0; k < m; k++) {
      s->A[k + size * (m + j)] = -(P[k] - mu * P[m + k]);
      s->A[m + j + size * k]   = P[k];
    }
    for (PetscInt i = 0; i < s->n; i++) {
      const PetscReal *w = &model->W[3 * s->pair[i] + N * port];

      s->A[m + i + size * (m + j)] = w[0] - mu * w[N];
    }
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
    state->p[3 * s->pair[j] + 1] = -FrictionSteady(&model->friction[s->pair[j]]) * s->x[model->m + j];
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
    const PetscBool is  = was ? state->p[3 * i] > 0 : model->gap[i] + state->y[3 * i] < 0;

    if (is != was) *same = PETSC_FALSE;
    if (is) s->pair[s->n++] = i;
    state->status[i] = is ? CONTACT_SLIP : CONTACT_OPEN;
  }
}

/* From all pairs closed, by sets: pairs in tension open, open ones that penetrate close, until none changes. Not
   found: no pair is left, the system is singular, or sets repeat (EQUILIBRIUM_MAX_IT), as they may with large mu. */
PetscErrorCode ReducedEquilibrium(const ReducedModel *model, const PetscReal loads[], ReducedState *state,
                                  PetscBool *found)
{
  const PetscInt most     = model->m + model->n_pairs;
  SlidingSystem  s        = {.model = model, .loads = loads, .n = model->n_pairs};
  PetscBool      singular = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(model->n_pairs, &s.pair, most * most, &s.A, most, &s.x, most, &s.pivot));
  for (PetscInt i = 0; i < model->n_pairs; i++) {
    s.pair[i]        = i;
    state->status[i] = CONTACT_SLIP;
  }
  *found = PETSC_FALSE;
  for (PetscInt it = 0; it < EQUILIBRIUM_MAX_IT && !*found && s.n && !singular; it++) {
    SlidingSystemFill(&s);
    PetscCall(DenseFactor(model->m + s.n, s.A, s.pivot, &singular));
    if (singular) break;
    PetscCall(DenseSolve(model->m + s.n, s.A, s.pivot, PETSC_FALSE, 1, s.x));
    SlidingSystemTake(&s, state);
    SlidingSystemChoose(&s, state, found);
  }
  for (PetscInt k = 0; k < model->m; k++) state->rate[k] = 0;
  PetscCall(PetscArraycpy(state->last, state->p, model->n_ports));
  PetscCall(PetscArraycpy(state->q, state->p, 3 * model->n_pairs));
  state->time = 0;
  PetscCall(PetscFree4(s.pair, s.A, s.x, s.pivot));
  PetscFunctionReturn(0);
}
