/*
   Forces of the pairs follow from means, lambda_{n+1} = 2 mean(lambda) - lambda_n (reduced.h): what an event inside a
   step leaves wrong in lambda alternates from step to step. It is in what damping of the residual has of lambda, e =
   lambda - q, of which a step knows the mean, W mean(e) = Cx dq / dt + Cm'deta / dt. So the next step begins with other
   forces than those with which this one ended: e half-way between 2 mean(e) - e_n and mean(e),

      lambda_begin := lambda_{n+1} - (e_{n+1} - e_begin,n) / 4,     p_{n+1} := (lambda_{n+1} + lambda_begin) / 2,

   by which what alternates is halved in each step. e at the beginning of a step is late by dt / 6, and at its end early
   by as much; p, the mean of both, is what all look at. It is of second order, and its sum over a period is that of the
   mean forces, exactly. Nothing is done where nothing damps, e = 0. Motions feel means alone. The laws go on to hold:
   pairs that slide have their friction scaled to the new normal force, and a pair goes on with the forces that it has
   where the new ones would pull, leave the cone of mu(0), or be more than double, since then friction is rounding.
*/
#include "reduced/reducedimpl.h"

#define RELAX_SHARE 0.25
#define RELAX_MOST  2

/* e_{n+1} - e_begin,n of port i, N */
static PetscReal RelaxChange(ReducedStepper s, const ReducedState *state, PetscInt i)
{
  return state->p[i] - state->last[i] - (s->q[i] - state->q[i]);
}

/* Normal force with a law in series obeys that law, and stays */
static PetscBool RelaxNormal(const ReducedModel *model, PetscInt pair)
{
  const PairSpring *spring = model->spring ? &model->spring[pair] : NULL;

  return !spring || (!SpringIsCurved(spring) && SpringTangent(spring, 0).compliance == 0) ? PETSC_TRUE : PETSC_FALSE;
}

static void RelaxPair(ReducedStepper s, const ReducedState *state, PetscInt pair)
{
  const PetscReal *p = &state->p[3 * pair];
  PetscReal       *l = &state->begin[3 * pair], relaxed[3];
  ReducedRelaxed  *r = &s->relaxed[pair];
  FrictionLaw      law;

  for (PetscInt d = 0; d < 3; d++) relaxed[d] = p[d] - RELAX_SHARE * RelaxChange(s, state, 3 * pair + d);
  if (!RelaxNormal(s->model, pair)) relaxed[0] = p[0];
  if (!(relaxed[0] > 0 && relaxed[0] <= RELAX_MOST * p[0])) return;
  r->ratio = relaxed[0] / p[0];
  for (int d = 1; d < 3 && state->status[pair] == CONTACT_SLIP; d++) relaxed[d] = r->ratio * p[d];
  law = FrictionPressed(&s->model->friction[pair], relaxed[0]);
  if (state->status[pair] == CONTACT_STICK && hypot(relaxed[1], relaxed[2]) > FrictionMu(&law, 0) * relaxed[0]) return;
  r->status = state->status[pair];
  for (int d = 0; d < 3; d++) l[d] = relaxed[d];
  for (int d = 0; d < 2; d++) r->cone[d] = l[1 + d] / l[0];
}

PetscErrorCode ReducedStepperRelax(ReducedStepper s, ReducedState *state)
{
  const PetscInt pairs = s->model->n_pairs;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(state->begin, state->p, 3 * pairs));
  for (PetscInt i = 0; i < pairs && s->model->Cm; i++) {
    s->relaxed[i].status = CONTACT_OPEN;
    if (state->status[i] != CONTACT_OPEN && state->p[3 * i] > 0) RelaxPair(s, state, i);
  }
  for (PetscInt i = 0; i < 3 * pairs; i++) state->p[i] = 0.5 * (state->p[i] + state->begin[i]);
  PetscFunctionReturn(0);
}

/* Derivative of the forces of a pair: old and next [3] before and after the step, of q too */
static void RelaxColumn(const ReducedRelaxed *r, PetscBool normal, const PetscReal old[], const PetscReal q_old[],
                        PetscReal next[], const PetscReal q[])
{
  const PetscReal end = next[0];

  for (int d = normal ? 0 : 1; d < (r->status == CONTACT_SLIP ? 1 : 3); d++)
    next[d] -= RELAX_SHARE * (next[d] - old[d] - q[d] + q_old[d]);
  for (int d = 1; d < 3 && r->status == CONTACT_SLIP; d++)
    next[d] = r->ratio * next[d] + r->cone[d - 1] * (next[0] - r->ratio * end);
}

void ReducedStepperRelaxTangent(ReducedStepper s, PetscInt size, PetscInt columns, const PetscReal X[],
                                PetscReal next[])
{
  const ReducedModel *model = s->model;
  const PetscInt      pairs = 3 * model->n_pairs;

  for (PetscInt j = 0; j < columns && model->Cm; j++)
    for (PetscInt i = 0; i < model->n_pairs; i++) {
      const PetscInt at = size * j + 2 * model->m + 3 * i;

      if (s->relaxed[i].status != CONTACT_OPEN)
        RelaxColumn(&s->relaxed[i], RelaxNormal(model, i), &X[at], &X[at + pairs], &next[at], &next[at + pairs]);
    }
}
