/*
   Forces of the pairs follow from means, lambda_{n+1} = 2 mean(lambda) - lambda_n (reduced.h): what an event inside a
   step leaves wrong in lambda alternates from step to step. It is in what damping of the residual has of lambda, e =
   lambda - q, of which a step knows the mean, W mean(e) = Cx dq / dt + Cm'deta / dt. So e_{n+1} is taken half-way
   between 2 mean(e) - e_n and mean(e),

      lambda_{n+1} := lambda_{n+1} - (e_{n+1} - e_n) / 4,

   by which what alternates is halved in each step, and e is late by dt / 6. Nothing is done where nothing damps, e = 0.
   Motions feel means alone. The laws go on to hold: pairs that slide have their friction scaled to the new normal
   force, and a pair keeps its forces where the new ones would pull or leave the cone of mu(0).
*/
#include "reduced/reducedimpl.h"

#define RELAX_SHARE 0.25

/* e_{n+1} - e_n of port i, N */
static PetscReal RelaxChange(ReducedStepper s, const ReducedState *state, PetscInt i)
{
  return state->p[i] - state->last[i] - (s->q[i] - state->q[i]);
}

/* Normal force with a law in series obeys that law, and stays */
static void RelaxPair(ReducedStepper s, ReducedState *state, PetscInt pair)
{
  const ReducedModel *model = s->model;
  PetscReal          *p     = &state->p[3 * pair], l[3];
  ReducedRelaxed     *r     = &s->relaxed[pair];
  FrictionLaw         law;

  for (PetscInt d = 0; d < 3; d++) l[d] = p[d] - RELAX_SHARE * RelaxChange(s, state, 3 * pair + d);
  if (model->spring) l[0] = p[0];
  if (!(l[0] > 0)) return;
  r->ratio = l[0] / p[0];
  for (int d = 1; d < 3 && state->status[pair] == CONTACT_SLIP; d++) l[d] = r->ratio * p[d];
  r->status = state->status[pair];
  law       = FrictionPressed(&model->friction[pair], l[0]);
  if (r->status == CONTACT_STICK && hypot(l[1], l[2]) > FrictionMu(&law, 0) * l[0])
    r->status = CONTACT_OPEN;
  for (int d = 0; d < 3 && r->status != CONTACT_OPEN; d++) p[d] = l[d];
  for (int d = 0; d < 2; d++) r->cone[d] = p[1 + d] / p[0];
}

void ReducedStepperRelax(ReducedStepper s, ReducedState *state)
{
  for (PetscInt i = 0; i < s->model->n_pairs && s->model->Cm; i++) {
    s->relaxed[i].status = CONTACT_OPEN;
    if (state->status[i] != CONTACT_OPEN && state->p[3 * i] > 0) RelaxPair(s, state, i);
  }
}

/* Derivative of the forces of a pair: old and next [3] before and after the step, of q too */
static void RelaxColumn(const ReducedRelaxed *r, PetscBool spring, const PetscReal old[], const PetscReal q_old[],
                        PetscReal next[], const PetscReal q[])
{
  const PetscReal normal = next[0];

  for (int d = spring ? 1 : 0; d < (r->status == CONTACT_SLIP ? 1 : 3); d++)
    next[d] -= RELAX_SHARE * (next[d] - old[d] - q[d] + q_old[d]);
  for (int d = 1; d < 3 && r->status == CONTACT_SLIP; d++)
    next[d] = r->ratio * next[d] + r->cone[d - 1] * (next[0] - r->ratio * normal);
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
        RelaxColumn(&s->relaxed[i], model->spring ? PETSC_TRUE : PETSC_FALSE, &X[at], &X[at + pairs], &next[at],
                    &next[at + pairs]);
    }
}
