/*
   What a step leaves: forces on the nodes, states of the slaves, sums over each interface, residuals of the laws.

   Works in the step around t_n, with V the velocity of the slave relative to the master that follows from those of the
   nodes, the mean of v_{n-1/2} and v_{n+1/2}, and s = V_T + sliding velocity the slip (J):
      contact   dt lambda_n V_n         friction  -dt lambda_T . V_T        heat  dt lambda_T . s
   so that friction + heat is what the drive of the sliding feeds. lambda_T is the force on the master.
*/
#include "base/algebra/vec3.h"
#include "base/algebra/versions.h"
#include "projectorimpl.h"

/* How far a constant, a line and a parabola through the forces before miss this one, squares added to miss, N^2. With
   equal steps the next value is a, 2 a - b and 3 a - 3 b + c of the last three a, b, c. */
INTO_VERSIONS void GuessesMeasure(const ProjectorPair *pair, const PetscReal lambda[3], PetscReal miss[PROJECTOR_PAST])
{
  for (int d = 0; d < 3; d++) {
    const PetscReal *a = &pair->lambda[0][d], *b = &pair->lambda[1][d], *c = &pair->lambda[2][d];

    miss[0] += PetscSqr(lambda[d] - *a);
    miss[1] += PetscSqr(lambda[d] - 2 * *a + *b);
    miss[2] += PetscSqr(lambda[d] - 3 * (*a - *b) - *c);
  }
}

/* Force of a pair from that along n, t, b; the last ones become older */
INTO_VERSIONS void PairSetForce(ProjectorPair *pair, const PetscReal force[3], PetscReal miss[PROJECTOR_PAST])
{
  PetscReal lambda[3] = {0, 0, 0};

  for (int i = 0; i < 3 && pair->facet >= 0; i++)
    for (int d = 0; d < 3; d++) lambda[d] += pair->e[i][d] * force[i];
  GuessesMeasure(pair, lambda, miss);
  for (int i = PROJECTOR_PAST - 1; i > 0; i--)
    for (int d = 0; d < 3; d++) pair->lambda[i][d] = pair->lambda[i - 1][d];
  for (int d = 0; d < 3; d++) pair->lambda[0][d] = lambda[d];
}

/* Adds the force of a pair (N) to its nodes; on the slave it is along the directions turned to the ground */
INTO_VERSIONS void PairPressNodes(const ProjectorPair *pair, const PetscReal along[3], PetscReal force[])
{
  const PetscReal *lambda = pair->lambda[0];
  PetscReal        slave[3];

  for (int d = 0; d < 3; d++)
    slave[d] = pair->turned[0][d] * along[0] + pair->turned[1][d] * along[1] + pair->turned[2][d] * along[2];
  for (int k = 0; k < pair->n_own; k++)
    for (int d = 0; d < 3; d++) force[3 * pair->own[k] + d] += pair->own_weight[k] * slave[d];
  for (int j = 0; j < 4; j++)
    for (int d = 0; d < 3; d++) force[3 * pair->node[j] + d] -= pair->weight[j] * lambda[d];
  for (int j = 4; j < pair->n; j++)
    for (int d = 0; d < 3; d++) force[3 * pair->node[j] + d] -= pair->weight[j] * lambda[d];
}

/* Order of the guess that would have missed least */
static PetscInt OrderBest(const PetscReal miss[PROJECTOR_PAST])
{
  PetscInt best = 0;

  for (int i = 1; i < PROJECTOR_PAST; i++)
    if (miss[i] < miss[best]) best = i;
  return best;
}

/* State of a pair with a force (N) along n, t, b: gap = q_n dt (m); friction on the master is the opposite of that on
   the slave. One whose impulse is rounding, which bodies leave that touch and move together, is open. A slave that
   faces nothing has an infinite gap. */
INTO_VERSIONS void StateSet(const ProjectorPair *pair, const PetscReal force[3], PetscReal dt, PetscReal noise,
                            ContactState *state)
{
  *state = (ContactState){.status = CONTACT_OPEN, .gap = PETSC_INFINITY};
  if (pair->facet < 0) return;
  state->status   = pair->p[0] > noise ? pair->status : CONTACT_OPEN;
  state->gap      = pair->q[0] * dt;
  state->lambda_n = force[0];
  for (int i = 0; i < 2; i++) {
    state->slip[i]     = pair->q[1 + i] * dt;
    state->lambda_t[i] = -force[1 + i];
  }
}

/* Adds one closed pair to the sums of its interface: V = (v_{n-1/2} + v_{n+1/2}) / 2 without the offset that q has,
   works dt lambda . V (J). */
INTO_VERSIONS void InterfaceSumsAdd(const ContactProjector p, const ProjectorPair *pair, const ContactState *state,
                                    PetscReal dt, ContactSums *sums, ContactSlips *slips)
{
  PetscReal old[3], velocity[3];

  PairVelocity(pair, p->nodes.before, old);
  for (int i = 0; i < 3; i++) velocity[i] = 0.5 * (old[i] + pair->q[i] - pair->offset[i]);
  sums->normal += state->lambda_n;
  sums->contact_work += dt * state->lambda_n * velocity[0];
  for (int i = 0; i < 2; i++) {
    sums->friction_work -= dt * state->lambda_t[i] * velocity[1 + i];
    sums->heat += dt * state->lambda_t[i] * (velocity[1 + i] + pair->drift[1 + i]);
  }
  for (int d = 0; d < 3; d++) {
    const PetscReal tangential = state->lambda_t[0] * pair->turned[1][d] + state->lambda_t[1] * pair->turned[2][d];

    slips->friction[d] += tangential;
    sums->force[d] += tangential - state->lambda_n * pair->turned[0][d];
  }
}

/* What belongs to the last step alone begins anew */
static void SumsBegin(ContactSums *sums, const ProjectorConvergence *convergence)
{
  for (int d = 0; d < 3; d++) sums->force[d] = 0;
  sums->normal   = 0;
  sums->residual = PetscMax(sums->residual, convergence->residual);
  sums->sweeps += (PetscReal)convergence->sweeps;
  sums->checks += (PetscReal)convergence->checks;
}

void ContactSumsMark(ContactSums *sums)
{
  if (sums->marked > 0) return;
  sums->marked = PetscMax(sums->steps, PETSC_MACHINE_EPSILON); /* 0 is never */
  for (int i = 0; i < CONTACT_N_STATUS; i++) sums->mark[i] = sums->n[i];
}

/* Pairs that are open or stick now and were not at the mark, or the other way round, by their numbers: at least that
   many pairs have changed, and an exchange of two is not seen */
void ContactSumsCompare(ContactSums *sums)
{
  PetscReal most = 0;

  for (int i = 0; i < CONTACT_N_STATUS && sums->marked > 0; i++)
    most = PetscMax(most, PetscAbsReal(sums->n[i] - sums->mark[i]));
  sums->changed += most > 0 ? 1 : 0;
  sums->most = PetscMax(sums->most, most);
}

PetscReal FrictionAlong(const ContactSlips *slips)
{
  const PetscReal length = Vec3Length(slips->along);

  return length > 0 ? Vec3Dot(slips->friction, slips->along) / length : Vec3Length(slips->friction);
}

/* Forces are added to the nodes in the order of the pairs; counted [interfaces][CONTACT_N_STATUS] are pairs */
VERSIONS void PairsRecord(ContactProjector p, const ContactStep *step, const ProjectorConvergence *convergence,
                          PetscReal counted[])
{
  PetscReal miss[PROJECTOR_PAST] = {0};

  for (PetscInt i = 0; i < p->share.n_need; i++)
    for (int d = 0; d < 3; d++) p->nodes.force[3 * p->share.need[i] + d] = 0;
  for (PetscInt i = 0; i < p->n_interfaces; i++) SumsBegin(&p->sums[i], convergence);
  for (PetscInt i = 0; i < p->n_interfaces; i++) p->slips[i] = (ContactSlips){.along = {0}};
  for (PetscInt k = 0; k < p->n_pairs; k++) {
    ProjectorPair  *pair     = &p->pair[k];
    const PetscInt  i        = pair->interface;
    ContactState   *state    = &p->state[k];
    const PetscReal force[3] = {pair->p[0] / step->kick, pair->p[1] / step->kick, pair->p[2] / step->kick};

    PairSetForce(pair, force, miss);
    StateSet(pair, force, step->dt, convergence->noise, state);
    counted[CONTACT_N_STATUS * i + state->status]++;
    if (pair->facet < 0) continue;
    for (int d = 0; d < 3 && p->sliding[i].slides; d++) p->slips[i].along[d] += pair->turned[1][d];
    if (state->lambda_n == 0) continue;
    PairPressNodes(pair, force, p->nodes.force);
    InterfaceSumsAdd(p, pair, state, step->dt, &p->sums[i], &p->slips[i]);
  }
  p->order = OrderBest(miss);
}

PetscErrorCode ContactProjectorGetKKT(ContactProjector p, ContactKKT *kkt)
{
  ContactJudged *judged;
  PetscReal      displacement = 0;
  PetscInt       n            = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(p->n_pairs, &judged));
  for (PetscInt k = 0; k < p->n_pairs; k++) {
    const ProjectorPair *pair  = &p->pair[k];
    const ContactState  *state = &p->state[k];

    if (pair->facet < 0) continue;
    judged[n++] =
      (ContactJudged){state, pair->mu, 0, state->gap, p->master[pair->interface].surface->size, PETSC_FALSE};
    for (int d = 0; d < 3; d++) displacement = PetscMax(displacement, PetscAbsReal(p->nodes.u[3 * pair->slave + d]));
  }
  PetscCall(ContactJudge(p->share.comm, n, judged, displacement, kkt));
  PetscCall(PetscFree(judged));
  PetscFunctionReturn(0);
}
