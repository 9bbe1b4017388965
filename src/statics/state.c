/*
   What a solution says about the contact: states of the pairs, sums over each interface, and residuals, all from the
   displacements as they are, not from the small system.
*/
#include "staticsimpl.h"
#include <squeal/options.h>
#include "base/algebra/vec3.h"

/* of the loads, unbalanced: beyond it forces have no more than six figures, and nothing that follows from them is of
   use */
#define STATICS_LOOSE 1e-6

/* States of all pairs from w = G u (m) and l (m): gap g0 - w_n (m), lambda_n = kappa l_n (N), friction on the master
   mu lambda_n along t where the pair slides as told, else -kappa l_T, and slip of the slave -(w_T - w_T0) (m) */
static void StaticsSetPairs(const PairRows *rows, PetscReal kappa, const ContactStatus status[], const PetscReal l[],
                            const PetscReal w[], ContactState state[])
{
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    const PetscInt first = rows->first[p];
    ContactState  *s     = &state[p];

    *s             = (ContactState){.status = status[p], .gap = rows->law[p].g0 - w[first]};
    s->lambda_n    = kappa * l[first];
    s->lambda_t[0] = rows->slide[p] * s->lambda_n;
    for (PetscInt i = 1; i < rows->law[p].d; i++) {
      s->lambda_t[i - 1] = -kappa * l[first + i];
      s->slip[i - 1]     = -(w[first + i] - rows->law[p].slip0[i - 1]);
    }
  }
}

/* Moment of the friction f on the master at x about the axis of its rotation w through c, against w: -w (x - c) x f /
   |w| */
static PetscReal BrakingMoment(const ContactInterface *c, const PetscReal x[3], const PetscReal f[3])
{
  const PetscReal arm[3] = {x[0] - c->centre[0], x[1] - c->centre[1], x[2] - c->centre[2]}, w = Vec3Length(c->rotation);
  PetscReal       moment[3];

  Vec3Cross(arm, f, moment);
  return w > 0 ? -Vec3Dot(c->rotation, moment) / w : 0;
}

/* Adds one pair to the sums of its interface */
static void StaticsAddResultant(const ContactInterface *c, const ContactPair *pair, const ContactState *state,
                                StaticsResultant *r)
{
  PetscReal f[3];

  for (int d = 0; d < 3; d++) f[d] = state->lambda_t[0] * pair->t[d] + state->lambda_t[1] * pair->b[d];
  r->rubbing += Vec3Length(f);
  r->moment += BrakingMoment(c, pair->x, f);
  r->n[state->status]++;
  r->normal += state->lambda_n;
  r->area += pair->area;
  r->closing = PetscMax(r->closing, -state->gap);
  for (int d = 0; d < 3; d++) {
    r->force[d] += -state->lambda_n * pair->n[d] + f[d];
    r->friction[d] += f[d];
    r->centre[d] += state->lambda_n * pair->x[d];
  }
}

static PetscErrorCode StaticsSetResultants(Statics s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(s->resultant, s->rows.n_interfaces));
  for (PetscInt p = 0; p < s->rows.n_pairs; p++) {
    const PetscInt i = s->rows.pair[p].interface;

    StaticsAddResultant(&s->rows.interface[i], &s->rows.pair[p], &s->state[p], &s->resultant[i]);
  }
  for (PetscInt i = 0; i < s->rows.n_interfaces; i++) {
    StaticsResultant *r = &s->resultant[i];

    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, r->n, CONTACT_N_STATUS, MPIU_INT, MPI_SUM, s->comm));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &r->normal, 1, MPIU_REAL, MPI_SUM, s->comm));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &r->area, 1, MPIU_REAL, MPI_SUM, s->comm));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &r->closing, 1, MPIU_REAL, MPI_MAX, s->comm));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &r->rubbing, 1, MPIU_REAL, MPI_SUM, s->comm));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &r->moment, 1, MPIU_REAL, MPI_SUM, s->comm));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, r->friction, 3, MPIU_REAL, MPI_SUM, s->comm));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, r->force, 3, MPIU_REAL, MPI_SUM, s->comm));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, r->centre, 3, MPIU_REAL, MPI_SUM, s->comm));
    for (int d = 0; d < 3 && r->normal != 0; d++) r->centre[d] /= r->normal;
  }
  PetscFunctionReturn(0);
}

/* They yield by more than a tenth of the contact's size (m), or yield and carry less than rounding of the forces:
   bodies go through each other, by a k_n of another unit or next to none */
PetscErrorCode StaticsWarnClosing(Statics s)
{
  const char *metre;

  PetscFunctionBeginUser;
  PetscCall(ModelGetUnit(s->model, "m", &metre));
  for (PetscInt i = 0; i < s->rows.n_interfaces && !s->deep; i++) {
    const ContactInterface *c    = &s->rows.interface[i];
    const StaticsResultant *r    = &s->resultant[i];
    const PetscReal         size = PetscSqrtReal(r->area);
    const PetscBool         nothing =
      r->closing > 1e-9 * size && r->normal <= PETSC_MACHINE_EPSILON * s->peak ? PETSC_TRUE : PETSC_FALSE;

    if (!(r->area > 0) || c->law != CONTACT_PENALTY || (r->closing <= 0.1 * size && !nothing)) continue;
    s->deep = PETSC_TRUE;
    PetscCall(PetscFPrintf(s->comm, stderr,
                           "squeal: warning: contact %s, of %.3g %s, closes by %.3g %s under %.3g N: its bodies go "
                           "through each other; is -%s_%s right?\n",
                           c->name, (double)size, metre, (double)r->closing, metre, (double)r->normal, c->name,
                           !PressureIsLinear(&c->pressure) ? "pressure_law"
                           : c->per_area                   ? "kn_per_area"
                                                           : "kn"));
  }
  PetscFunctionReturn(0);
}

/* |f + contact forces - K u| over the larger of |f| and |contact forces| up to this stage, 2-norms of nodal forces, N;
   much of it is left where next to nothing resists the loads, and displacements are so large that forces drown in
   their rounding.
   Forces by which followers are held to what they follow are none of the residual. */
static PetscErrorCode StaticsMeasureEquilibrium(Statics s, Vec f, const PetscReal l[])
{
  PetscReal norm, load, contact;
  Vec       r;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(f, &r));
  PetscCall(VecSet(r, 0));
  PetscCall(ComplianceAddForces(&s->compliance, 1, l, NULL, r));
  PetscCall(VecNorm(r, NORM_2, &contact));
  PetscCall(OperatorsApplyBodies(s->operators, s->p, s->u, r));
  PetscCall(VecAYPX(r, -1, f));
  PetscCall(ComplianceAddForces(&s->compliance, 1, l, NULL, r));
  PetscCall(ComplianceDropConstraint(&s->compliance, r));
  PetscCall(VecNorm(r, NORM_2, &norm));
  PetscCall(VecNorm(f, NORM_2, &load));
  s->peak        = PetscMax(s->peak, PetscMax(load, contact));
  s->equilibrium = norm > 0 ? norm / s->peak : 0;
  PetscCall(VecDestroy(&r));
  PetscCheck(
    s->equilibrium <= STATICS_LOOSE, s->comm, PETSC_ERR_NOT_CONVERGED,
    "no equilibrium found: next to nothing resists the -loads, and %.2g of them is left unbalanced; give other -loads, "
    "-supports or -springs",
    (double)s->equilibrium);
  PetscFunctionReturn(0);
}

/* Largest displacement of a slave of this rank, or of its pair by motions, m */
static PetscErrorCode StaticsFindDisplacement(Statics s, PetscReal *displacement)
{
  const PetscScalar *u;
  PetscInt           begin, end;

  PetscFunctionBeginUser;
  *displacement = 0;
  PetscCall(VecGetOwnershipRange(s->u, &begin, &end));
  PetscCall(VecGetArrayRead(s->u, &u));
  for (PetscInt i = 0; i < 3 * s->rows.n_pairs; i++) {
    const PetscInt row = s->rows.pair[i / 3].slave[0].unknown[i % 3];

    if (row >= begin && row < end) *displacement = PetscMax(*displacement, PetscAbsScalar(u[row - begin]));
  }
  PetscCall(VecRestoreArrayRead(s->u, &u));
  for (PetscInt i = 0; i < s->rows.n && s->rows.moved; i++)
    *displacement = PetscMax(*displacement, PetscAbsReal(s->rows.moved[i]));
  PetscFunctionReturn(0);
}

/* Residuals of the contact laws */
static PetscErrorCode StaticsMeasureKKT(Statics s)
{
  PetscReal *mu, displacement;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->rows.n_pairs, &mu));
  for (PetscInt i = 0; i < s->rows.n_pairs; i++)
    PetscCall(OperatorsGetPairMu(s->operators, s->p, &s->rows.pair[i], PETSC_FALSE, s->state[i].lambda_n, &mu[i]));
  PetscCall(StaticsFindDisplacement(s, &displacement));
  PetscCall(ContactComputeKKT(s->contact, s->state, mu, s->rows.pressure, displacement, &s->kkt));
  PetscCall(PetscFree(mu));
  PetscFunctionReturn(0);
}

PetscReal StaticsPairStiffness(Statics s, PetscInt p)
{
  const ContactPair *pair = &s->rows.pair[p];

  if (s->state[p].status == CONTACT_OPEN) return 0;
  return ContactPairStiffness(&s->rows.interface[pair->interface], pair, &s->rows.pressure[pair->interface],
                              s->state[p].lambda_n);
}

PetscErrorCode StaticsSetState(Statics s, Vec f, const PetscReal l[])
{
  PetscReal *w;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->rows.n, &w));
  PetscCall(ComplianceGetRows(&s->compliance, s->u, w));
  StaticsSetPairs(&s->rows, s->compliance.kappa, s->status, l, w, s->state);
  PetscCall(PetscFree(w));
  PetscCall(StaticsSetResultants(s));
  PetscCall(StaticsMeasureEquilibrium(s, f, l));
  if (s->stage == StagesCount(s) - 1) PetscCall(StaticsMeasureKKT(s)); /* in which all slides that is told to */
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsPlace(Statics s, char text[], size_t size)
{
  const OperatorsParameter *parameters;
  const char               *between = " at ";
  PetscInt                  n;
  char                      one[192];

  PetscFunctionBeginUser;
  text[0] = 0;
  if (StagesGet(s, s->stage)->name)
    PetscCall(PetscSNPrintf(text, size, " in -stages %s", StagesGet(s, s->stage)->name));
  PetscCall(OperatorsGetParameters(s->operators, &n, &parameters));
  for (PetscInt i = 0; i < s->n_parameters; i++) {
    if (s->p[i] == parameters[i].value) continue;
    PetscCall(PetscSNPrintf(one, sizeof(one), "%s%s %.6g", between, parameters[i].name, (double)s->p[i]));
    PetscCall(OptionsTextAppend(text, one, size));
    between = ", ";
  }
  PetscFunctionReturn(0);
}
