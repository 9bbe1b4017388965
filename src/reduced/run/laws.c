/*
   Friction of a step by a second path (dynamics/run/laws.h): the slip s of each pair from its places before and after,
   by the coordinates of the modes and the forces on the residual, u = P eta + W q (m), not from the step's own account;
   Coulomb's law with the interface's coefficient asks for lambda_T . s = mu lambda_n |s| (J). The laws hold to
   REDUCED_RTOL of what displacements are made of, |P| |eta| + |W| |q|, beside which rounding is small and the slip of a
   pair that sticks is nothing.
*/
#include "reduced/reducedimpl.h"

/* Displacements of the pairs [3 n_pairs], m */
static void LookPlace(const ReducedRun r, PetscReal place[])
{
  for (PetscInt i = 0; i < 3 * r->reduction.model.n_pairs; i++)
    place[i] = ReducedPortDisplacement(&r->reduction.model, r->motion.state.eta, r->motion.shown, i);
}

PetscErrorCode ReducedLookBegin(ReducedRun r)
{
  const PetscReal last = r->run.end - (1 + 1e-9) * r->motion.dt;

  PetscFunctionBeginUser;
  if (!LedgerIsLooked(r->motion.step, r->run.check_interval) &&
      !(r->run.check_interval && r->motion.state.time >= last))
    PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(3 * r->reduction.model.n_pairs + 1, &r->motion.place));
  LookPlace(r, r->motion.place);
  PetscFunctionReturn(0);
}

/* What a displacement is made of, m: the sum of the sizes of its terms */
static PetscReal LookSize(const ReducedRun r, PetscInt port)
{
  const ReducedModel *model = &r->reduction.model;
  PetscReal           size  = 0;

  for (PetscInt k = 0; k < model->m; k++) size += PetscAbsReal(model->P[k + model->m * port] * r->motion.state.eta[k]);
  for (PetscInt i = 0; i < model->n_ports; i++)
    size += PetscAbsReal(model->W[i + model->n_ports * port] * r->motion.shown[i]);
  return size;
}

/* One pair: what its friction did and what the law asks for, J. sum[0] += the difference beyond twice the rounding
   of the slip, sum[1] += mu lambda_n times the slip, or the motion of the pair where that is larger, beside which
   it counts. */
static void LookAdd(const ReducedRun r, PetscInt i, const PetscReal after[], PetscReal sum[3])
{
  const FrictionLaw law =
    FrictionAt(&r->run.interfaces[r->reduction.pair[i].interface].friction, r->reduction.pair[i].speed);
  const ContactState *state  = &r->motion.pairs[i];
  const PetscReal    *before = &r->motion.place[3 * i];
  PetscReal           s[2], motion = 0, noise = 0, length, mu, done;

  for (int d = 0; d < 3; d++) {
    motion = PetscMax(motion, PetscAbsReal(after[3 * i + d] - before[d]));
    noise  = PetscMax(noise, REDUCED_RTOL * LookSize(r, 3 * i + d));
  }
  for (int d = 0; d < 2; d++) s[d] = after[3 * i + 1 + d] - before[1 + d] + (d ? 0 : r->motion.sliding[i]);
  length = hypot(s[0], s[1]);
  mu     = FrictionMu(&law, length / r->motion.dt);
  done   = state->lambda_t[0] * s[0] + state->lambda_t[1] * s[1];
  sum[0] += PetscMax(0, PetscAbsReal(done - mu * state->lambda_n * length) - 2 * mu * state->lambda_n * noise);
  sum[1] += mu * state->lambda_n * PetscMax(PetscMax(length, motion), noise);
}

PetscErrorCode ReducedLookEnd(ReducedRun r)
{
  LedgerLaws *laws = &r->motion.ledger.total.laws;
  PetscReal  *after, sum[3] = {0, 0, 0};

  PetscFunctionBeginUser;
  if (!r->motion.place) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(3 * r->reduction.model.n_pairs + 1, &after));
  LookPlace(r, after);
  for (PetscInt i = 0; i < r->reduction.model.n_pairs; i++)
    if (r->motion.pairs[i].lambda_n > 0) LookAdd(r, i, after, sum);
  if (sum[1] > 0) laws->friction = PetscMax(laws->friction, sum[0] / sum[1]);
  laws->looks++;
  laws->friction_alone = 1;
  PetscCall(PetscFree(after));
  PetscCall(PetscFree(r->motion.place));
  PetscCall(LedgerJudgeLaws(r->comm, laws, r->motion.step, r->motion.state.time));
  PetscFunctionReturn(0);
}
