/*
   Unit test of operators/ordering: the order "metis" as MUMPS receives it from PETSc, on one and on several ranks.

   Matrix: stiffness of a block of 12 x 12 x 6 hexahedra, clamped at x = 0, guided at y = 0 (two unknowns per node),
   nodes numbered at random; optionally with rows that friction makes unsymmetric in values and pattern.
*/
#include <petscksp.h>
#include "check.h"
#include "kernels/element/hex8.h"
#include "solver/factor/ordering.h"

#define NX      13
#define NY      13
#define NZ      7
#define N_NODES (NX * NY * NZ)

/* First unknown of each node, first[N_NODES + 1] in the order of the random numbering rank[N_NODES] of the nodes */
typedef struct {
  PetscInt rank[N_NODES], first[N_NODES + 1];
} Numbering;

/* Unknowns of a node: none for i = 0, x and z for j = 0, else three */
static PetscInt NodeUnknowns(PetscInt node)
{
  const PetscInt i = node % NX, j = node / NX % NY;

  return i == 0 ? 0 : (j == 0 ? 2 : 3);
}

/* Random numbering, the same on all ranks */
static PetscErrorCode NumberNodes(Numbering *numbering)
{
  PetscRandom random;
  PetscReal   value;
  PetscInt    nodes[N_NODES];

  PetscFunctionBeginUser;
  PetscCall(PetscRandomCreate(PETSC_COMM_SELF, &random));
  for (PetscInt k = 0; k < N_NODES; k++) nodes[k] = k;
  for (PetscInt k = N_NODES - 1; k > 0; k--) {
    PetscInt swap, other;

    PetscCall(PetscRandomGetValueReal(random, &value));
    other        = PetscMin((PetscInt)(value * (k + 1)), k);
    swap         = nodes[k];
    nodes[k]     = nodes[other];
    nodes[other] = swap;
  }
  PetscCall(PetscRandomDestroy(&random));
  numbering->first[0] = 0;
  for (PetscInt k = 0; k < N_NODES; k++) {
    numbering->rank[nodes[k]] = k;
    numbering->first[k + 1]   = numbering->first[k] + NodeUnknowns(nodes[k]);
  }
  PetscFunctionReturn(0);
}

/* Number of a displacement, -1 when it is fixed */
static PetscInt Unknown(const Numbering *numbering, PetscInt node, PetscInt direction)
{
  const PetscInt n = NodeUnknowns(node), first = numbering->first[numbering->rank[node]];

  if (n == 0 || (n == 2 && direction == 1)) return -1;
  return first + (n == 2 && direction == 2 ? 1 : direction);
}

/* Adds the unit cube whose lowest node is given */
static PetscErrorCode AddCell(Mat A, const Numbering *numbering, PetscInt node)
{
  const Elasticity e = ElasticityFromEngineering(1, 0.3, 1);
  double           x[HEX8_DOFS], K[HEX8_DOFS * HEX8_DOFS], M[HEX8_DOFS * HEX8_DOFS];
  PetscInt         unknowns[HEX8_DOFS];

  PetscFunctionBeginUser;
  for (int a = 0; a < HEX8_NODES; a++) {
    const PetscInt step[3] = {hex8_sign[a][0] > 0, hex8_sign[a][1] > 0, hex8_sign[a][2] > 0};

    for (int i = 0; i < 3; i++) {
      x[3 * a + i]        = (double)step[i];
      unknowns[3 * a + i] = Unknown(numbering, node + step[0] + NX * (step[1] + NY * step[2]), i);
    }
  }
  PetscCheck(!Hex8IncompatibleMatrices(NULL, x, &e, K, M), PETSC_COMM_SELF, PETSC_ERR_PLIB, "Unit cube refused");
  PetscCall(MatSetValues(A, HEX8_DOFS, unknowns, HEX8_DOFS, unknowns, K, ADD_VALUES));
  PetscFunctionReturn(0);
}

/* Friction-like rows: the force along y of a top node depends on the displacement along z of a bottom one */
static PetscErrorCode AddFriction(Mat A, const Numbering *numbering)
{
  PetscFunctionBeginUser;
  for (PetscInt node = 0; node < NX * NY; node++) {
    const PetscInt    row = Unknown(numbering, node + NX * NY * (NZ - 1), 1), column = Unknown(numbering, node, 2);
    const PetscScalar value = 0.3;

    PetscCall(MatSetValues(A, 1, &row, 1, &column, &value, ADD_VALUES));
  }
  PetscFunctionReturn(0);
}

/* The block's matrix; rank 0 assembles it */
static PetscErrorCode CreateMatrix(const Numbering *numbering, PetscBool friction, Mat *A)
{
  const PetscInt n = numbering->first[N_NODES];
  PetscMPIInt    rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCall(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, n, n, 82, NULL, 82, NULL, A));
  for (PetscInt node = 0; node < N_NODES && rank == 0; node++) {
    if (node % NX < NX - 1 && node / NX % NY < NY - 1 && node / (NX * NY) < NZ - 1) {
      PetscCall(AddCell(*A, numbering, node));
    }
  }
  if (friction && rank == 0) PetscCall(AddFriction(*A, numbering));
  PetscCall(MatAssemblyBegin(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatSetOption(*A, MAT_SYMMETRIC, (PetscBool)!friction));
  PetscFunctionReturn(0);
}

/* Breaks when: a row is left out or listed twice, or the unknowns of a node are not eliminated one after another */
static PetscErrorCode TestPermutation(Mat A, const Numbering *numbering, int *failed)
{
  const PetscInt  n = numbering->first[N_NODES];
  const PetscInt *position;
  PetscInt       *sorted, apart = 0, wrong = 0, n_row;
  IS              row, col;
  PetscBool       same;

  PetscFunctionBeginUser;
  PetscCall(MatGetOrdering(A, ORDERING_METIS, &row, &col));
  PetscCall(ISEqual(row, col, &same));
  PetscCall(ISGetLocalSize(row, &n_row));
  PetscCheck(n_row == n, PETSC_COMM_SELF, PETSC_ERR_PLIB, "Order of %" PetscInt_FMT " rows", n_row);
  PetscCall(ISGetIndices(row, &position));
  PetscCall(PetscMalloc1(n, &sorted));
  PetscCall(PetscArraycpy(sorted, position, n));
  PetscCall(PetscSortInt(n, sorted));
  for (PetscInt i = 0; i < n; i++) wrong += sorted[i] != i;
  for (PetscInt k = 0; k < N_NODES; k++) {
    for (PetscInt i = numbering->first[k] + 1; i < numbering->first[k + 1]; i++) {
      apart += position[i] != position[i - 1] + 1;
    }
  }
  PetscCall(PetscFree(sorted));
  PetscCall(ISRestoreIndices(row, &position));
  *failed += CheckTrue("rows and columns have the same order", same, (double)n);
  *failed += CheckTrue("places of the permutation missing", wrong == 0, (double)wrong);
  *failed += CheckTrue("unknowns of a node apart", apart == 0, (double)apart);
  PetscCall(ISDestroy(&row));
  PetscCall(ISDestroy(&col));
  PetscFunctionReturn(0);
}

/* Entries of the LU factors by MUMPS with the given order */
static PetscErrorCode CountFill(Mat A, IS row, PetscInt *entries)
{
  MatFactorInfo info;
  Mat           F;

  PetscFunctionBeginUser;
  PetscCall(MatFactorInfoInitialize(&info));
  PetscCall(MatGetFactor(A, MATSOLVERMUMPS, MAT_FACTOR_LU, &F));
  PetscCall(MatLUFactorSymbolic(F, A, row, row, &info));
  PetscCall(MatLUFactorNumeric(F, A, &info));
  PetscCall(MatMumpsGetInfog(F, 29, entries));
  PetscCall(MatDestroy(&F));
  PetscFunctionReturn(0);
}

/* Breaks when: the order does not reduce fill, or holds perm where MUMPS wants iperm, the inverse */
static PetscErrorCode TestFill(Mat A, int *failed)
{
  PetscInt metis, natural, inverted;
  IS       row, col, inverse;

  PetscFunctionBeginUser;
  PetscCall(MatGetOrdering(A, ORDERING_METIS, &row, &col));
  PetscCall(ISInvertPermutation(row, PETSC_DECIDE, &inverse));
  PetscCall(CountFill(A, row, &metis));
  PetscCall(CountFill(A, inverse, &inverted));
  PetscCall(ISDestroy(&row));
  PetscCall(ISDestroy(&col));
  PetscCall(ISDestroy(&inverse));
  PetscCall(MatGetOrdering(A, MATORDERINGNATURAL, &row, &col));
  PetscCall(CountFill(A, row, &natural));
  PetscCall(ISDestroy(&row));
  PetscCall(ISDestroy(&col));
  *failed += CheckTrue("fill relative to the given numbering", metis < 0.5 * natural, (double)metis / natural);
  *failed += CheckTrue("fill relative to the inverse order", metis < 0.5 * inverted, (double)metis / inverted);
  PetscFunctionReturn(0);
}

/* Breaks when: MUMPS factors another matrix than A, or (LU on one rank) does not take the order.
   Relative residual of A x = b, and of A' x = b, solved by a PC that asks for the order */
static PetscErrorCode TestSolve(Mat A, PCType type, PetscBool transposed, int *failed)
{
  PetscInt    used;
  PetscReal   residual, norm;
  PetscMPIInt size;
  Vec         x, b, r;
  KSP         ksp;
  PC          pc;
  Mat         F;
  PetscBool   is_lu;

  PetscFunctionBeginUser;
  PetscCall(KSPCreate(PETSC_COMM_WORLD, &ksp));
  PetscCall(KSPSetOperators(ksp, A, A));
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, type));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscCall(PCFactorSetMatOrderingType(pc, ORDERING_METIS));
  PetscCall(MatCreateVecs(A, &x, &b));
  PetscCall(VecDuplicate(b, &r));
  PetscCall(VecSetRandom(b, NULL));
  if (transposed) {
    PetscCall(KSPSolveTranspose(ksp, b, x));
    PetscCall(MatMultTranspose(A, x, r));
  } else {
    PetscCall(KSPSolve(ksp, b, x));
    PetscCall(MatMult(A, x, r));
  }
  PetscCall(VecAXPY(r, -1, b));
  PetscCall(VecNorm(r, NORM_2, &residual));
  PetscCall(VecNorm(b, NORM_2, &norm));
  printf("     %s%s\n", type, transposed ? ", transposed" : "");
  *failed += CheckClose("relative residual", residual / norm, 0, 1e-10);
  PetscCall(PCFactorGetMatrix(pc, &F));
  PetscCall(MatMumpsGetInfog(F, 7, &used));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  PetscCall(PetscStrcmp(type, PCLU, &is_lu));
  if (is_lu && size == 1) *failed += CheckClose("order used by MUMPS, 1 = given", (double)used, 1, 0);
  PetscCall(KSPDestroy(&ksp));
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&b));
  PetscCall(VecDestroy(&r));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  Numbering   numbering;
  Mat         symmetric, friction;
  PetscMPIInt size;
  int         failed = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  PetscCall(OrderingRegister());
  PetscCall(NumberNodes(&numbering));
  PetscCall(CreateMatrix(&numbering, PETSC_FALSE, &symmetric));
  PetscCall(CreateMatrix(&numbering, PETSC_TRUE, &friction));
  if (size == 1) {
    PetscCall(TestPermutation(symmetric, &numbering, &failed));
    PetscCall(TestFill(symmetric, &failed));
    PetscCall(TestFill(friction, &failed));
  }
  PetscCall(TestSolve(symmetric, PCCHOLESKY, PETSC_FALSE, &failed));
  PetscCall(TestSolve(friction, PCLU, PETSC_FALSE, &failed));
  PetscCall(TestSolve(friction, PCLU, PETSC_TRUE, &failed));
  PetscCall(MatDestroy(&symmetric));
  PetscCall(MatDestroy(&friction));
  PetscCall(PetscFinalize());
  printf("%d failed\n", failed);
  return failed ? 1 : 0;
}
