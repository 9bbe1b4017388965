/*
   Pairs of all ranks, the same on each: gaps and friction of the model, and after a step their states, the sums over
   each interface and the residuals of the laws.
*/
#include "reduced/reducedimpl.h"
#include "base/gather.h"
#include "base/algebra/vec3.h"
#include "contact/judge.h"

#define SLACK     1e-10 /* penetration that is rounding, of the model's size */
#define PAIR_HELD 1e-10 /* part of a unit normal that is rounding */

/* The largest coordinate of any node, m */
static PetscErrorCode ReducedFindSize(ReducedRun r, PetscReal *size)
{
  const Mesh *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(r->run.model, &mesh));
  *size = 0;
  for (PetscInt i = 0; i < 3 * mesh->n_nodes; i++) *size = PetscMax(*size, PetscAbsReal(mesh->x[i]));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, size, 1, MPIU_REAL, MPI_MAX, r->comm));
  PetscFunctionReturn(0);
}

/* Raises the error for a pair that no force can open: both bodies are held along its normal, and its row of G, of
   unit length at a free node, is zero. */
static PetscErrorCode ReducedCheckHeld(ReducedRun r)
{
  PetscInt                row, held = r->reduction.model.n_pairs;
  const ContactPair      *pair;
  const ContactInterface *c;

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(r->reduction.G, &row, NULL));
  for (PetscInt i = 0; i < r->reduction.n_local; i++) {
    const PetscScalar *value;
    PetscInt           n;
    PetscReal          square = 0;

    PetscCall(MatGetRow(r->reduction.G, row + 3 * i, &n, NULL, &value));
    for (PetscInt k = 0; k < n; k++) square += PetscSqr(value[k]);
    PetscCall(MatRestoreRow(r->reduction.G, row + 3 * i, &n, NULL, &value));
    if (square < PetscSqr(PAIR_HELD)) held = PetscMin(held, r->reduction.begin + i);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &held, 1, MPIU_INT, MPI_MIN, r->comm));
  if (held == r->reduction.model.n_pairs) PetscFunctionReturn(0);
  pair = &r->reduction.pair[held];
  c    = &r->run.interfaces[pair->interface];
  SETERRQ(r->comm, PETSC_ERR_USER_INPUT,
          "contact %s: at %.6g, %.6g, %.6g m both %s and %s are held along the normal, so that no force can keep them "
          "apart; free one of them, or take it out of the surface",
          c->name, (double)pair->x[0], (double)pair->x[1], (double)pair->x[2], c->slave, c->master);
}

/* A penetration that is rounding, SLACK of the largest coordinate, counts as a gap of 0; more is refused, since an
   exact law would throw the bodies apart. */
PetscErrorCode ReducedSetPairs(ReducedRun r)
{
  const PetscInt     n = r->reduction.model.n_pairs;
  const ContactPair *local;
  PetscInt           n_local, n_all;
  PetscReal          size, mu;
  PressureLaw        law;

  PetscFunctionBeginUser;
  PetscCall(ContactGetPairs(r->run.contact, &n_local, &n_all, &local));
  PetscCall(GatherRecords(r->comm, n_local, sizeof(*local), local, NULL, &r->reduction.pair));
  PetscCall(ReducedCheckHeld(r));
  PetscCall(PetscCalloc2(n, &r->reduction.model.gap, n, &r->reduction.model.friction));
  if (r->request.springs) PetscCall(PetscMalloc1(n, &r->reduction.model.spring));
  PetscCall(PetscCalloc2(n, &r->motion.pairs, r->run.n_interfaces, &r->motion.sums));
  PetscCall(ReducedFindSize(r, &size));
  for (PetscInt i = 0; i < n; i++) {
    const ContactPair      *pair = &r->reduction.pair[i];
    const ContactInterface *c    = &r->run.interfaces[pair->interface];

    PetscCall(FrictionCheckNotNegative(r->comm, c->name, &c->friction));
    PetscCheck(pair->gap > -SLACK * size, r->comm, PETSC_ERR_USER_INPUT,
               "contact %s: bodies interpenetrate by %.6g m at %.6g, %.6g, %.6g m at the start", c->name,
               (double)-pair->gap, (double)pair->x[0], (double)pair->x[1], (double)pair->x[2]);
    r->reduction.model.gap[i]      = PetscMax(0, pair->gap);
    r->reduction.model.friction[i] = FrictionOfPair(&c->friction, pair->speed, pair->area);
    r->motion.pairs[i].gap         = r->reduction.model.gap[i];
    if (!r->request.springs) continue;
    PetscCall(OperatorsGetInterface(r->run.operators, r->request.p, pair->interface, &mu, &law));
    r->reduction.model.spring[i] = ContactPairSpring(c, pair, &law);
  }
  PetscFunctionReturn(0);
}

/* State of pair i from those at t_{n+1} and the slip of the step. Forces of the model act on the slave, friction of
   a ContactState on the master: hence the sign of lambda_t. */
static void PairSetState(ReducedRun r, PetscInt i)
{
  const PetscReal *p = &r->motion.state.p[3 * i];

  r->motion.pairs[i] = (ContactState){.status   = r->motion.state.status[i],
                                      .gap      = r->reduction.model.gap[i] + r->motion.state.y[3 * i],
                                      .slip     = {r->motion.report.slip[2 * i], r->motion.report.slip[2 * i + 1]},
                                      .lambda_n = p[0],
                                      .lambda_t = {-p[1], -p[2]}};
}

/* Works, forces and numbers of the pairs of interface k */
static void SumsTake(ReducedRun r, PetscInt k, ContactSums *sums)
{
  PetscReal along[3] = {0, 0, 0}, friction[3] = {0, 0, 0};

  for (int i = 0; i < CONTACT_N_STATUS; i++) sums->n[i] = 0;
  for (int d = 0; d < 3; d++) sums->force[d] = 0;
  sums->normal = 0;
  for (PetscInt i = 0; i < r->reduction.model.n_pairs; i++) {
    const ContactPair  *pair  = &r->reduction.pair[i];
    const ContactState *state = &r->motion.pairs[i];

    if (pair->interface != k) continue;
    sums->n[state->status]++;
    sums->normal += state->lambda_n;
    sums->contact_work += r->motion.report.contact[i];
    sums->friction_work += r->motion.report.friction[i];
    sums->heat += r->motion.report.heat[i];
    for (int d = 0; d < 3; d++) {
      const PetscReal tangential = state->lambda_t[0] * pair->t[d] + state->lambda_t[1] * pair->b[d];

      if (pair->speed > 0) along[d] += pair->t[d];
      friction[d] += tangential;
      sums->force[d] += tangential - state->lambda_n * pair->n[d];
    }
  }
  sums->friction = Vec3Length(along) > 0 ? Vec3Dot(friction, along) / Vec3Length(along) : Vec3Length(friction);
  sums->residual = PetscMax(sums->residual, r->motion.report.residual);
}

/* Of the law in series with a pair, m */
static PetscReal StateClosing(ReducedRun r, PetscInt i)
{
  const PairSpring *spring = r->reduction.model.spring;

  return spring ? SpringClosing(&spring[i], r->motion.pairs[i].lambda_n) : 0;
}

/* Residuals of the laws at t_{n+1}; the worst of the run is kept. On each rank alone, since all have all pairs. */
static PetscErrorCode ReducedJudge(ReducedRun r, PetscReal dt)
{
  const PetscInt n            = r->reduction.model.n_pairs;
  PetscReal      displacement = 0;
  ContactJudged *judged;
  ContactKKT     now;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &judged));
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal  *slip = r->motion.pairs[i].slip, speed = hypot(slip[0], slip[1]) / dt;
    const FrictionLaw law = FrictionPressed(&r->reduction.model.friction[i], r->motion.pairs[i].lambda_n);
    const PetscReal   mu  = FrictionMu(&law, speed);

    judged[i] = (ContactJudged){
      &r->motion.pairs[i], mu, StateClosing(r, i), r->reduction.model.gap[i], PetscSqrtReal(r->reduction.pair[i].area),
      PETSC_FALSE};
    for (int d = 0; d < 3; d++) displacement = PetscMax(displacement, PetscAbsReal(r->motion.state.y[3 * i + d]));
  }
  PetscCall(ContactJudge(PETSC_COMM_SELF, n, judged, displacement, &now));
  PetscCall(PetscFree(judged));
  r->result.kkt.penetration     = PetscMax(r->result.kkt.penetration, now.penetration);
  r->result.kkt.sign            = PetscMax(r->result.kkt.sign, now.sign);
  r->result.kkt.complementarity = PetscMax(r->result.kkt.complementarity, now.complementarity);
  r->result.kkt.cone            = PetscMax(r->result.kkt.cone, now.cone);
  r->result.kkt.dissipation     = PetscMax(r->result.kkt.dissipation, now.dissipation);
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedTakePairs(ReducedRun r, PetscBool stepped)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < r->reduction.model.n_pairs; i++) PairSetState(r, i);
  for (PetscInt k = 0; k < r->run.n_interfaces; k++) {
    SumsTake(r, k, &r->motion.sums[k]);
    if (stepped) ContactSumsCompare(&r->motion.sums[k]);
    r->motion.sums[k].sweeps += stepped ? (PetscReal)r->motion.report.its : 0;
    r->motion.sums[k].steps += stepped ? 1 : 0;
  }
  if (stepped) PetscCall(ReducedJudge(r, r->motion.dt));
  PetscFunctionReturn(0);
}
