/*
   Unit test of operators/: open pairs of an interface that obeys the exact constraint, on one and on several ranks. The
   reference is N u = 0 and (N - mu T) y = 0 of the contact itself.
*/
#include "check.h"
#include "pairs.h"
#include "petscmain.h"

/* Largest and least |(N - mu T) u| over closed and over open pairs, relative to the largest |u| */
static PetscErrorCode RowsCompare(const Chain *chain, PetscReal mu, Vec u, const PetscInt group[], PetscReal *closed,
                                  PetscReal *open)
{
  const PetscScalar *value;
  PetscReal          norm, bounds[2] = {0, PETSC_MIN_REAL};
  PetscInt           n;
  Vec                r;

  PetscFunctionBeginUser;
  PetscCall(ChainConstrain(chain, mu, u, &r));
  PetscCall(VecGetLocalSize(r, &n));
  PetscCall(VecGetArrayRead(r, &value));
  for (PetscInt p = 0; p < n; p++) {
    if (group[p] < 0)
      bounds[1] = PetscMax(bounds[1], -PetscAbsScalar(value[p]));
    else
      bounds[0] = PetscMax(bounds[0], PetscAbsScalar(value[p]));
  }
  PetscCall(VecRestoreArrayRead(r, &value));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, bounds, 2, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
  PetscCall(VecNorm(u, NORM_INFINITY, &norm));
  *closed = bounds[0] / norm;
  *open   = -bounds[1] / norm;
  PetscCall(VecDestroy(&r));
  PetscFunctionReturn(0);
}

/* Breaks when: a null space keeps open pairs or loses closed ones. Reference: N u = 0 and (N - mu T) y = 0 of the
   contact at the closed pairs, anything else at the open ones; as many unknowns less as there are closed pairs */
static PetscErrorCode TestNullSpace(Chain *chain, const PetscInt group[], int *failed)
{
  PetscReal      mu, closed, open;
  PressureLaw    law;
  PetscInt       n, n_all, n_closed = 0, size, reduced;
  PencilMatrices pencil;
  Vec            q, u;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetInterface(chain->operators, NULL, 0, &mu, &law));
  *failed += CheckTrue("k_n of the constraint is infinite", PetscIsInfReal(PressureSlope(&law, 0)),
                       (double)PressureSlope(&law, 0));
  PetscCall(PencilGetMatrices(chain->pencil, &pencil));
  PetscCall(MatCreateVecs(pencil.K, &q, NULL));
  PetscCall(OperatorsCreateVec(chain->operators, &u));
  PetscCall(VecSetRandom(q, NULL));
  for (int left = 0; left < 2; left++) {
    PetscCall(PencilExpand(chain->pencil, (PetscBool)left, q, u));
    PetscCall(RowsCompare(chain, left ? mu : 0, u, group, &closed, &open));
    *failed += CheckClose(left ? "(N - mu T) y = 0 where closed" : "N u = 0 where closed", closed, 0, 1e-15);
    *failed += CheckTrue("not so where open", open > 1e-8, (double)open);
  }
  const ContactPair *pair;

  PetscCall(ContactGetPairs(chain->contact, &n, &n_all, &pair));
  for (PetscInt p = 0; p < n; p++) n_closed += group[p] >= 0;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &n_closed, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  PetscCall(VecGetSize(u, &size));
  PetscCall(VecGetSize(q, &reduced));
  *failed += CheckTrue("an unknown less for each closed pair", size - reduced == n_closed, (double)(size - reduced));
  PetscCall(VecDestroy(&q));
  PetscCall(VecDestroy(&u));
  PetscFunctionReturn(0);
}

/* A pencil with these pairs closed */
static PetscErrorCode ClosedSet(Chain *chain, PetscInt n, PetscInt n_groups, const PetscInt group[])
{
  SlidingState state;

  PetscFunctionBeginUser;
  PetscCall(SlidingStateCreate(n, n_groups, group, &state));
  PetscCall(ChainLinearise(chain, &state));
  PetscCall(SlidingStateDestroy(&state));
  PetscFunctionReturn(0);
}

/* All that the exact constraint can do; groups it cannot */
static PetscErrorCode TestConstraint(int *failed)
{
  const ContactPair *pair;
  PetscInt           n, n_all, size, reduced, group[MAX_PAIRS];
  PetscErrorCode     error;
  PencilMatrices     pencil;
  Chain              chain;
  Mat                K, bodies;

  PetscFunctionBeginUser;
  PetscCall(ChainCreate(BRAKE SLIP CONSTRAINED, BODIES_1 BEAM_1 COARSE, &chain));
  PetscCall(ContactGetPairs(chain.contact, &n, &n_all, &pair));
  PetscCall(ChainLinearise(&chain, NULL));
  PetscCall(PencilGetMatrices(chain.pencil, &pencil));
  PetscCall(MatDuplicate(pencil.K, MAT_COPY_VALUES, &K));
  PetscCall(GroupsMake(chain.contact, 0, group));
  PetscCall(ClosedSet(&chain, n, 0, group));
  PetscCall(TestNullSpace(&chain, group, failed));
  for (PetscInt p = 0; p < n; p++) group[p] = -1;
  PetscCall(ClosedSet(&chain, n, 0, group));
  PetscCall(PencilGetMatrices(chain.pencil, &pencil));
  PetscCall(OperatorsGetBodies(chain.operators, NULL, &bodies, NULL, NULL));
  PetscCall(MatGetSize(bodies, &size, NULL));
  PetscCall(MatGetSize(pencil.K, &reduced, NULL));
  *failed += CheckTrue("all open: nothing is eliminated", size == reduced, (double)reduced);
  *failed += CheckTrue("all open: symmetric", pencil.symmetric, pencil.symmetric);
  PetscCall(TestSame(chain.operators, K, NULL, failed));
  for (PetscInt p = 0; p < n; p++) group[p] = 1;
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  error = ClosedSet(&chain, n, 1, group);
  PetscCall(PetscPopErrorHandler());
  *failed += CheckTrue("groups are refused", error == PETSC_ERR_SUP, error);
  PetscCall(MatDestroy(&K));
  PetscCall(ChainDestroy(&chain));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  (void)size;
  PetscCall(TestConstraint(failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
