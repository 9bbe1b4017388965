/*
   Unit test of operators/: which pairs of the contact take part, on one and on several ranks.

   Of a coarse brake (disc, pad, beam) some of the 25 pairs are open, some closed, some in groups, by their position
   alone. The reference is the action of the bodies and of N, T, B of the contact itself, row by row. The bodies are so
   small that three ranks share the pairs.
*/
#include "check.h"
#include "pairs.h"
#include <string.h>

#define VALUES                                                                                                         \
  BODIES_1 BEAM_1 COARSE                                                                                               \
    "-contact_speed 2 -contact_force 50 -contact_mu_slope -0.02 -oil_viscosity 1,1,0 -disc_beta 1e-7 "

/* How far each local pair is closed, when closed_1 and closed_2 have the given values */
static void FactorsMake(PetscInt n, const PetscInt group[], PetscReal closed_1, PetscReal closed_2, PetscReal factor[])
{
  const PetscReal values[] = {0, 1, closed_1, closed_2};

  for (PetscInt p = 0; p < n; p++) factor[p] = group ? values[group[p] + 1] : 1;
}

/* y += scale L' diag(weight) R x, weight of this rank's rows */
static PetscErrorCode AddProduct(PetscReal scale, Mat L, const PetscReal weight[], Mat R, Vec x, Vec y)
{
  PetscScalar *value;
  PetscInt     n;
  Vec          r, z;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(R, NULL, &r));
  PetscCall(MatMult(R, x, r));
  PetscCall(VecGetLocalSize(r, &n));
  PetscCall(VecGetArray(r, &value));
  for (PetscInt i = 0; i < n; i++) value[i] *= scale * weight[i];
  PetscCall(VecRestoreArray(r, &value));
  PetscCall(VecDuplicate(y, &z));
  PetscCall(MatMultTranspose(L, r, z));
  PetscCall(VecAXPY(y, 1, z));
  PetscCall(VecDestroy(&r));
  PetscCall(VecDestroy(&z));
  PetscFunctionReturn(0);
}

/* K x of the penalty law: bodies, and k_n N'N - mu k_n T'N of each interface, its pairs as far as they are closed */
static PetscErrorCode ReferenceStiffness(Chain *chain, const PetscReal factor[], Vec x, Vec y)
{
  const ContactInterface *c;
  PetscInt                n_interfaces, first = 0, n;
  Mat                     bodies, N, T;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetBodies(chain->operators, &bodies));
  PetscCall(MatMult(bodies, x, y));
  PetscCall(ContactGetInterfaces(chain->contact, &n_interfaces, &c));
  for (PetscInt i = 0; i < n_interfaces; i++, first += n) {
    PetscReal mu, kn;

    PetscCall(OperatorsGetInterface(chain->operators, i, &mu, &kn));
    PetscCall(ContactCreateOperators(chain->contact, i, &N, &T, NULL));
    PetscCall(MatGetLocalSize(N, &n, NULL));
    PetscCall(AddProduct(kn, N, &factor[first], N, x, y));
    PetscCall(AddProduct(-mu * kn, T, &factor[first], N, x, y));
    PetscCall(MatDestroy(&N));
    PetscCall(MatDestroy(&T));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ParameterSet(Operators o, const char name[], PetscReal value)
{
  const OperatorsParameter *q;
  PetscReal                 p[64];
  PetscInt                  n, found = -1;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(o, &n, &q));
  for (PetscInt i = 0; i < n; i++) {
    p[i] = q[i].value;
    if (!strcmp(q[i].name, name)) found = i;
  }
  PetscCheck(found >= 0, PETSC_COMM_WORLD, PETSC_ERR_PLIB, "no parameter %s", name);
  p[found] = value;
  PetscCall(OperatorsSetParameters(o, p));
  PetscFunctionReturn(0);
}

static PetscErrorCode ParameterGet(Operators o, const char name[], PetscReal *value)
{
  const OperatorsParameter *q;
  PetscInt                  n;

  PetscFunctionBeginUser;
  *value = NAN;
  PetscCall(OperatorsGetParameters(o, &n, &q));
  for (PetscInt i = 0; i < n; i++)
    if (!strcmp(q[i].name, name)) *value = q[i].value;
  PetscFunctionReturn(0);
}

/* C x: what remains without normal force, and |mu| / v B'(N0) B + mu' T'(N0) T of the pairs; one interface */
static PetscErrorCode ReferenceDamping(Chain *chain, const PetscReal factor[], Vec x, Vec y)
{
  const ContactPair *pair;
  PetscInt           n, n_all;
  PetscReal          force, mu, kn, slope, speed, total = 0, weight[MAX_PAIRS];
  Mat                C, T, B;

  PetscFunctionBeginUser;
  PetscCall(ParameterGet(chain->operators, "contact_force", &force));
  PetscCall(ParameterSet(chain->operators, "contact_force", 0));
  PetscCall(OperatorsGetMatrices(chain->operators, NULL, NULL, &C, NULL, NULL));
  PetscCall(MatMult(C, x, y));
  PetscCall(ParameterSet(chain->operators, "contact_force", force));
  PetscCall(ParameterGet(chain->operators, "contact_mu_slope", &slope));
  PetscCall(ParameterGet(chain->operators, "contact_speed", &speed));
  PetscCall(OperatorsGetInterface(chain->operators, 0, &mu, &kn));
  PetscCall(ContactGetPairs(chain->contact, &n, &n_all, &pair));
  for (PetscInt p = 0; p < n; p++) total += pair[p].force;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &total, 1, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  for (PetscInt p = 0; p < n; p++) weight[p] = factor[p] * force * pair[p].force / total;
  PetscCall(ContactCreateOperators(chain->contact, 0, NULL, &T, &B));
  PetscCall(AddProduct(PetscAbsReal(mu) / speed, B, weight, B, x, y));
  PetscCall(AddProduct(slope, T, weight, T, x, y));
  PetscCall(MatDestroy(&T));
  PetscCall(MatDestroy(&B));
  PetscFunctionReturn(0);
}

/* |A x - y| / |y| */
static PetscErrorCode ActionDistance(Mat A, Vec x, Vec y, PetscReal *distance)
{
  PetscReal norm;
  Vec       z;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(y, &z));
  PetscCall(MatMult(A, x, z));
  PetscCall(VecAXPY(z, -1, y));
  PetscCall(VecNorm(z, NORM_2, distance));
  PetscCall(VecNorm(y, NORM_2, &norm));
  *distance /= norm;
  PetscCall(VecDestroy(&z));
  PetscFunctionReturn(0);
}

/* Breaks when: an open pair leaves something behind, a closed one is lost, a group lacks its factor, or a sum keeps an
   old pattern. Reference: bodies and rows of the contact */
static PetscErrorCode TestPencil(Chain *chain, const char name[], const PetscReal factor[], int *failed)
{
  PetscReal       distance;
  OperatorsPencil pencil;
  Vec             x, y;

  PetscFunctionBeginUser;
  PetscCall(OperatorsCreateVec(chain->operators, &x));
  PetscCall(VecDuplicate(x, &y));
  PetscCall(VecSetRandom(x, NULL));
  PetscCall(ReferenceStiffness(chain, factor, x, y));
  PetscCall(OperatorsGetPencil(chain->operators, &pencil));
  PetscCall(ActionDistance(pencil.K, x, y, &distance));
  printf("     %s\n", name);
  *failed += CheckClose("K x", distance, 0, 1e-14);
  *failed += CheckTrue("damped", pencil.C != NULL, 1);
  if (pencil.C) {
    PetscCall(ReferenceDamping(chain, factor, x, y));
    PetscCall(OperatorsGetPencil(chain->operators, &pencil));
    PetscCall(ActionDistance(pencil.C, x, y, &distance));
    *failed += CheckClose("C x", distance, 0, 1e-14);
  }
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&y));
  PetscFunctionReturn(0);
}

/* Breaks when: parameters of the scene move, lose their values in a sweep, or those of groups can be taken for options.
   Reference: the values set before */
static PetscErrorCode TestParameters(Operators o, PetscInt n_before, int *failed)
{
  const OperatorsParameter *q;
  PetscReal                 mu, force;
  PetscInt                  n;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(o, &n, &q));
  *failed += CheckTrue("two parameters more", n == n_before + 2, (double)(n - n_before));
  for (PetscInt i = 0; i < n; i++) {
    const PetscBool last = i >= n_before ? PETSC_TRUE : PETSC_FALSE;

    if (q[i].internal != last) *failed += CheckTrue(q[i].name, 0, (double)i);
    if (last && (q[i].value != 1 || q[i].lower != 0 || q[i].upper != 1))
      *failed += CheckTrue(q[i].name, 0, (double)q[i].value);
  }
  *failed += CheckTrue("closed_1, closed_2", !strcmp(q[n - 2].name, "closed_1") && !strcmp(q[n - 1].name, "closed_2"),
                       (double)n);
  PetscCall(ParameterGet(o, "contact_mu", &mu));
  PetscCall(ParameterGet(o, "contact_force", &force));
  *failed += CheckClose("mu of the sweep", mu, -0.3, 0);
  *failed += CheckClose("force of the sweep", force, 70, 0);
  PetscFunctionReturn(0);
}

/* Breaks when: the forces of the sliding state do not reach the friction damping, or the scene's total stays */
static PetscErrorCode TestForces(Chain *chain, PetscInt n, const PetscInt group[], const PetscReal factor[],
                                 int *failed)
{
  PetscReal lambda_n[MAX_PAIRS], sum = 0, force;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < n; p++) lambda_n[p] = factor[p] * (3 + (PetscReal)(group[p] + 1));
  for (PetscInt p = 0; p < n; p++) sum += lambda_n[p];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  PetscCall(ContactSetForces(chain->contact, lambda_n));
  PetscCall(OperatorsSetClosed(chain->operators, 0, group));
  PetscCall(ParameterGet(chain->operators, "contact_force", &force));
  *failed += CheckClose("force of the sliding state", force, sum, 1e-13 * sum);
  PetscCall(TestPencil(chain, "forces of the sliding state", factor, failed));
  PetscFunctionReturn(0);
}

/* Breaks when: preload comes too early, too late, not at all, or its unsymmetric part makes a symmetric pencil.
   Reference: the matrices given, G and F, beside those of the bodies and the contact, at mu = 0 */
static PetscErrorCode TestPreload(Chain *chain, Mat unsymmetric, int *failed)
{
  PetscReal       distance, all[MAX_PAIRS];
  OperatorsPencil pencil, frictionless;
  Mat             bodies, G, F;
  Vec             x, y;

  PetscFunctionBeginUser;
  FactorsMake(MAX_PAIRS, NULL, 1, 1, all);
  PetscCall(OperatorsGetBodies(chain->operators, &bodies));
  PetscCall(MatDuplicate(bodies, MAT_COPY_VALUES, &G));
  PetscCall(MatScale(G, 1e-3));
  PetscCall(MatDuplicate(unsymmetric, MAT_COPY_VALUES, &F));
  PetscCall(MatScale(F, 1e-4));
  PetscCall(MatCreateVecs(G, &x, &y));
  PetscCall(VecSetRandom(x, NULL));
  PetscCall(ParameterSet(chain->operators, "contact_mu", 0));
  PetscCall(OperatorsSetPreload(chain->operators, G, F));
  PetscCall(OperatorsGetPencil(chain->operators, &pencil));
  *failed += CheckTrue("no preload before the next status", pencil.symmetric, pencil.symmetric);
  PetscCall(OperatorsSetClosed(chain->operators, 0, NULL));
  PetscCall(ReferenceStiffness(chain, all, x, y));
  PetscCall(MatMultAdd(G, x, y, y));
  PetscCall(OperatorsGetFrictionless(chain->operators, &frictionless));
  PetscCall(ActionDistance(frictionless.K, x, y, &distance));
  *failed += CheckClose("geometric stiffness", distance, 0, 1e-14);
  PetscCall(MatMultAdd(F, x, y, y));
  PetscCall(OperatorsGetPencil(chain->operators, &pencil));
  PetscCall(ActionDistance(pencil.K, x, y, &distance));
  *failed += CheckClose("geometric stiffness and follower forces", distance, 0, 1e-14);
  *failed += CheckTrue("unsymmetric with follower forces", !pencil.symmetric, !pencil.symmetric);
  PetscCall(OperatorsSetPreload(chain->operators, NULL, NULL));
  PetscCall(MatDestroy(&G));
  PetscCall(MatDestroy(&F));
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&y));
  PetscFunctionReturn(0);
}

/* All that the penalty law can do */
static PetscErrorCode TestPenalty(int *failed)
{
  const OperatorsParameter *q;
  const ContactPair        *pair;
  PetscInt                  n_before, n, n_all, group[MAX_PAIRS], plain[MAX_PAIRS];
  PetscReal                 factor[MAX_PAIRS], first[64];
  OperatorsPencil           pencil;
  Chain                     chain;
  Mat                       K, C;

  PetscFunctionBeginUser;
  PetscCall(ChainCreate(BRAKE SLIP DAMPED, VALUES, &chain));
  PetscCall(ContactGetPairs(chain.contact, &n, &n_all, &pair));
  PetscCall(OperatorsGetParameters(chain.operators, &n_before, &q));
  for (PetscInt i = 0; i < n_before; i++) first[i] = q[i].value;
  PetscCall(OperatorsGetPencil(chain.operators, &pencil));
  PetscCall(MatDuplicate(pencil.K, MAT_COPY_VALUES, &K));
  PetscCall(MatDuplicate(pencil.C, MAT_COPY_VALUES, &C));
  PetscCall(ParameterSet(chain.operators, "contact_mu", -0.3));
  PetscCall(ParameterSet(chain.operators, "contact_force", 70));
  PetscCall(GroupsMake(chain.contact, 0, plain));
  PetscCall(GroupsMake(chain.contact, 2, group));
  FactorsMake(n, plain, 0, 0, factor);
  PetscCall(OperatorsSetClosed(chain.operators, 0, plain));
  PetscCall(TestPencil(&chain, "some open", factor, failed));
  PetscCall(OperatorsSetClosed(chain.operators, 2, group));
  PetscCall(TestParameters(chain.operators, n_before, failed));
  FactorsMake(n, group, 1, 1, factor);
  PetscCall(TestPencil(&chain, "both groups closed", factor, failed));
  PetscCall(ParameterSet(chain.operators, "closed_1", 0));
  FactorsMake(n, group, 0, 1, factor);
  PetscCall(TestPencil(&chain, "group 1 open", factor, failed));
  PetscCall(ParameterSet(chain.operators, "closed_2", 0.25));
  FactorsMake(n, group, 0, 0.25, factor);
  PetscCall(TestPencil(&chain, "group 2 closed to a quarter", factor, failed));
  PetscCall(OperatorsSetClosed(chain.operators, 0, NULL));
  PetscCall(OperatorsSetParameters(chain.operators, first));
  PetscCall(TestSame(chain.operators, K, C, failed));
  PetscCall(TestPreload(&chain, K, failed));
  PetscCall(OperatorsSetClosed(chain.operators, 0, NULL));
  PetscCall(OperatorsSetParameters(chain.operators, first));
  PetscCall(TestSame(chain.operators, K, C, failed));
  FactorsMake(n, plain, 0, 0, factor);
  PetscCall(TestForces(&chain, n, plain, factor, failed));
  PetscCall(MatDestroy(&K));
  PetscCall(MatDestroy(&C));
  PetscCall(ChainDestroy(&chain));
  PetscFunctionReturn(0);
}

/* Breaks when: the second interface takes the pairs or the stiffness of the first. Reference: as in TestPencil */
static PetscErrorCode TestTwoInterfaces(int *failed)
{
  const ContactPair *pair;
  PetscInt           n, n_all, group[MAX_PAIRS];
  PetscReal          factor[MAX_PAIRS], distance;
  OperatorsPencil    pencil;
  Chain              chain;
  Vec                x, y;

  PetscFunctionBeginUser;
  PetscCall(ChainCreate(BRAKE SLIP TWO_CONTACTS, BODIES_1 BEAM_1 COARSE "-more_mu -0.1 -more_kn 3e7", &chain));
  PetscCall(ContactGetPairs(chain.contact, &n, &n_all, &pair));
  PetscCall(GroupsMake(chain.contact, 2, group));
  for (PetscInt p = 0; p < n; p++)
    if (pair[p].interface == 1) group[p] = group[p] == 2 ? -1 : group[p];
  PetscCall(OperatorsSetClosed(chain.operators, 2, group));
  PetscCall(ParameterSet(chain.operators, "closed_1", 0.5));
  FactorsMake(n, group, 0.5, 1, factor);
  PetscCall(OperatorsCreateVec(chain.operators, &x));
  PetscCall(VecDuplicate(x, &y));
  PetscCall(VecSetRandom(x, NULL));
  PetscCall(ReferenceStiffness(&chain, factor, x, y));
  PetscCall(OperatorsGetPencil(chain.operators, &pencil));
  PetscCall(ActionDistance(pencil.K, x, y, &distance));
  *failed += CheckClose("two interfaces, K x", distance, 0, 1e-14);
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&y));
  PetscCall(ChainDestroy(&chain));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  int failed = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(TestPenalty(&failed));
  PetscCall(TestTwoInterfaces(&failed));
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscFinalize());
  printf("%d failed\n", failed);
  return failed ? 1 : 0;
}
