/*
   Unit test of operators/: which pairs of the contact take part, on one and on several ranks.

   Of a coarse brake (disc, pad, beam) some of the 25 pairs are open, some closed, some in groups, by their position
   alone. The reference is the action of the bodies and of N, T, B of the contact itself, row by row. The bodies are so
   small that three ranks share the pairs.
*/
#include "check.h"
#include "pairs.h"
#include "petscmain.h"
#include "reference.h"
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

static PetscErrorCode ParameterSet(Pencil o, const char name[], PetscReal value)
{
  const OperatorsParameter *q;
  const PetscReal          *present;
  PetscReal                 p[64];
  PetscInt                  n, found = -1;

  PetscFunctionBeginUser;
  PetscCall(PencilGetParameters(o, &n, &q, &present));
  PetscCall(PetscArraycpy(p, present, n));
  for (PetscInt i = 0; i < n; i++)
    if (!strcmp(q[i].name, name)) found = i;
  PetscCheck(found >= 0, PETSC_COMM_WORLD, PETSC_ERR_PLIB, "no parameter %s", name);
  p[found] = value;
  PetscCall(PencilSetParameters(o, p));
  PetscFunctionReturn(0);
}

/* A state with these pairs closed, at the present point of the pencil */
static PetscErrorCode StateMake(Chain *chain, PetscInt n_groups, const PetscInt group[], SlidingState *state)
{
  const ContactPair        *pair;
  const OperatorsParameter *q;
  const PetscReal          *p;
  PetscInt                  n, n_all;

  PetscFunctionBeginUser;
  PetscCall(ContactGetPairs(chain->contact, &n, &n_all, &pair));
  PetscCall(SlidingStateCreate(n, n_groups, group, state));
  PetscCall(OperatorsGetParameters(chain->operators, &state->n_parameters, &q));
  PetscCall(PencilGetParameters(chain->pencil, NULL, NULL, &p));
  PetscCall(PetscMalloc1(state->n_parameters, &state->p));
  PetscCall(PetscArraycpy(state->p, p, state->n_parameters));
  PetscFunctionReturn(0);
}

/* A pencil about it */
static PetscErrorCode ClosedSet(Chain *chain, PetscInt n_groups, const PetscInt group[])
{
  SlidingState state;

  PetscFunctionBeginUser;
  PetscCall(StateMake(chain, n_groups, group, &state));
  PetscCall(ChainLinearise(chain, &state));
  PetscCall(SlidingStateDestroy(&state));
  PetscFunctionReturn(0);
}

/* Breaks when: an open pair leaves something behind, a closed one is lost, a group lacks its factor, or a sum keeps an
   old pattern. Reference: bodies and rows of the contact */
static PetscErrorCode TestPencil(Chain *chain, const char name[], const PetscReal factor[], const PetscReal lambda_n[],
                                 int *failed)
{
  PetscReal      distance;
  PencilMatrices pencil;
  Vec            x, y;

  PetscFunctionBeginUser;
  PetscCall(OperatorsCreateVec(chain->operators, &x));
  PetscCall(VecDuplicate(x, &y));
  PetscCall(VecSetRandom(x, NULL));
  PetscCall(ReferenceStiffness(chain, factor, x, y));
  PetscCall(PencilGetMatrices(chain->pencil, &pencil));
  PetscCall(ActionDistance(pencil.K, x, y, &distance));
  printf("     %s\n", name);
  *failed += CheckClose("K x", distance, 0, 1e-14);
  *failed += CheckTrue("damped", pencil.C != NULL, 1);
  if (pencil.C) {
    PetscCall(ReferenceDamping(chain, factor, lambda_n, x, y));
    PetscCall(ActionDistance(pencil.C, x, y, &distance));
    *failed += CheckClose("C x", distance, 0, 1e-14);
  }
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&y));
  PetscFunctionReturn(0);
}

/* Breaks when: parameters of the scene move, the point of the state is lost, or those of groups can be taken for options.
   Reference: the values set before */
static PetscErrorCode TestParameters(Pencil o, PetscInt n_before, int *failed)
{
  const OperatorsParameter *q;
  const PetscReal          *p;
  PetscReal                 mu, force;
  PetscInt                  n;

  PetscFunctionBeginUser;
  PetscCall(PencilGetParameters(o, &n, &q, &p));
  *failed += CheckTrue("two parameters more", n == n_before + 2, (double)(n - n_before));
  for (PetscInt i = 0; i < n; i++) {
    const PetscBool last = i >= n_before ? PETSC_TRUE : PETSC_FALSE;

    if (q[i].internal != last) *failed += CheckTrue(q[i].name, 0, (double)i);
    if (last && (p[i] != 1 || q[i].lower != 0 || q[i].upper != 1)) *failed += CheckTrue(q[i].name, 0, (double)p[i]);
  }
  *failed += CheckTrue("closed_1, closed_2", !strcmp(q[n - 2].name, "closed_1") && !strcmp(q[n - 1].name, "closed_2"),
                       (double)n);
  PetscCall(ParameterGet(o, "contact_mu", &mu));
  PetscCall(ParameterGet(o, "contact_force", &force));
  *failed += CheckClose("mu of the state's point", mu, -0.3, 0);
  *failed += CheckClose("force of the state's point", force, 70, 0);
  PetscFunctionReturn(0);
}

/* Breaks when: the forces of the sliding state do not reach the friction damping, or the scene's total stays */
static PetscErrorCode TestForces(Chain *chain, PetscInt n, const PetscInt group[], const PetscReal factor[],
                                 int *failed)
{
  PetscReal    lambda_n[MAX_PAIRS], sum = 0, force;
  SlidingState state;

  PetscFunctionBeginUser;
  PetscCall(StateMake(chain, 0, group, &state));
  state.has_forces = PETSC_TRUE;
  PetscCall(PetscMalloc1(n, &state.lambda_n));
  for (PetscInt p = 0; p < n; p++) lambda_n[p] = state.lambda_n[p] = factor[p] * (3 + (PetscReal)(p % 4));
  for (PetscInt p = 0; p < n; p++) sum += lambda_n[p];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  PetscCall(ChainLinearise(chain, &state));
  PetscCall(SlidingStateDestroy(&state));
  PetscCall(ParameterGet(chain->pencil, "contact_force", &force));
  *failed += CheckClose("force of the sliding state", force, sum, 1e-13 * sum);
  PetscCall(TestPencil(chain, "forces of the sliding state", factor, lambda_n, failed));
  PetscFunctionReturn(0);
}

/* Breaks when: preload is lost, goes with the state that brought it, or its unsymmetric part makes a symmetric pencil.
   Reference: the matrices given, G and F, beside those of the bodies and the contact, at mu = 0 */
static PetscErrorCode TestPreload(Chain *chain, Mat unsymmetric, int *failed)
{
  PetscInt       group[MAX_PAIRS] = {0};
  PetscReal      distance, all[MAX_PAIRS];
  PencilMatrices pencil, frictionless;
  SlidingState   state;
  Mat            bodies, G, F;
  Vec            x, y;

  PetscFunctionBeginUser;
  FactorsMake(MAX_PAIRS, NULL, 1, 1, all);
  PetscCall(OperatorsGetBodies(chain->operators, NULL, &bodies, NULL, NULL));
  PetscCall(MatDuplicate(bodies, MAT_COPY_VALUES, &G));
  PetscCall(MatScale(G, 1e-3));
  PetscCall(MatDuplicate(unsymmetric, MAT_COPY_VALUES, &F));
  PetscCall(MatScale(F, 1e-4));
  PetscCall(MatCreateVecs(G, &x, &y));
  PetscCall(VecSetRandom(x, NULL));
  PetscCall(ParameterSet(chain->pencil, "contact_mu", 0));
  PetscCall(StateMake(chain, 0, group, &state));
  state.geometric = G;
  state.follower  = F;
  PetscCall(PetscObjectReference((PetscObject)G));
  PetscCall(PetscObjectReference((PetscObject)F));
  PetscCall(ChainLinearise(chain, &state));
  PetscCall(SlidingStateDestroy(&state));
  PetscCall(ReferenceStiffness(chain, all, x, y));
  PetscCall(MatMultAdd(G, x, y, y));
  PetscCall(PencilGetFrictionless(chain->pencil, &frictionless));
  PetscCall(ActionDistance(frictionless.K, x, y, &distance));
  *failed += CheckClose("geometric stiffness", distance, 0, 1e-14);
  PetscCall(MatMultAdd(F, x, y, y));
  PetscCall(PencilGetMatrices(chain->pencil, &pencil));
  PetscCall(ActionDistance(pencil.K, x, y, &distance));
  *failed += CheckClose("geometric stiffness and follower forces", distance, 0, 1e-14);
  *failed += CheckTrue("unsymmetric with follower forces", !pencil.symmetric, !pencil.symmetric);
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
  PetscReal                 factor[MAX_PAIRS];
  PencilMatrices            pencil;
  Chain                     chain;
  Mat                       K, C;

  PetscFunctionBeginUser;
  PetscCall(ChainCreate(BRAKE SLIP DAMPED, VALUES, &chain));
  PetscCall(ContactGetPairs(chain.contact, &n, &n_all, &pair));
  PetscCall(OperatorsGetParameters(chain.operators, &n_before, &q));
  PetscCall(ChainLinearise(&chain, NULL));
  PetscCall(PencilGetMatrices(chain.pencil, &pencil));
  PetscCall(MatDuplicate(pencil.K, MAT_COPY_VALUES, &K));
  PetscCall(MatDuplicate(pencil.C, MAT_COPY_VALUES, &C));
  PetscCall(ParameterSet(chain.pencil, "contact_mu", -0.3));
  PetscCall(ParameterSet(chain.pencil, "contact_force", 70));
  PetscCall(GroupsMake(chain.contact, 0, plain));
  PetscCall(GroupsMake(chain.contact, 2, group));
  FactorsMake(n, plain, 0, 0, factor);
  PetscCall(ClosedSet(&chain, 0, plain));
  PetscCall(TestPencil(&chain, "some open", factor, NULL, failed));
  PetscCall(ClosedSet(&chain, 2, group));
  PetscCall(TestParameters(chain.pencil, n_before, failed));
  FactorsMake(n, group, 1, 1, factor);
  PetscCall(TestPencil(&chain, "both groups closed", factor, NULL, failed));
  PetscCall(ParameterSet(chain.pencil, "closed_1", 0));
  FactorsMake(n, group, 0, 1, factor);
  PetscCall(TestPencil(&chain, "group 1 open", factor, NULL, failed));
  PetscCall(ParameterSet(chain.pencil, "closed_2", 0.25));
  FactorsMake(n, group, 0, 0.25, factor);
  PetscCall(TestPencil(&chain, "group 2 closed to a quarter", factor, NULL, failed));
  PetscCall(ChainLinearise(&chain, NULL));
  PetscCall(TestSame(chain.operators, K, C, failed));
  PetscCall(TestPreload(&chain, K, failed));
  PetscCall(ChainLinearise(&chain, NULL));
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
  PencilMatrices     pencil;
  Chain              chain;
  Vec                x, y;

  PetscFunctionBeginUser;
  PetscCall(ChainCreate(BRAKE SLIP TWO_CONTACTS, BODIES_1 BEAM_1 COARSE "-more_mu -0.1 -more_kn 3e7", &chain));
  PetscCall(ContactGetPairs(chain.contact, &n, &n_all, &pair));
  PetscCall(GroupsMake(chain.contact, 2, group));
  for (PetscInt p = 0; p < n; p++)
    if (pair[p].interface == 1) group[p] = group[p] == 2 ? -1 : group[p];
  PetscCall(ChainLinearise(&chain, NULL));
  PetscCall(ClosedSet(&chain, 2, group));
  PetscCall(ParameterSet(chain.pencil, "closed_1", 0.5));
  FactorsMake(n, group, 0.5, 1, factor);
  PetscCall(OperatorsCreateVec(chain.operators, &x));
  PetscCall(VecDuplicate(x, &y));
  PetscCall(VecSetRandom(x, NULL));
  PetscCall(ReferenceStiffness(&chain, factor, x, y));
  PetscCall(PencilGetMatrices(chain.pencil, &pencil));
  PetscCall(ActionDistance(pencil.K, x, y, &distance));
  *failed += CheckClose("two interfaces, K x", distance, 0, 1e-14);
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&y));
  PetscCall(ChainDestroy(&chain));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  (void)size;
  PetscCall(TestPenalty(failed));
  PetscCall(TestTwoInterfaces(failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
