/*
   Unit test of operators/parameter: limits of the values, and the parameter of loaded matrices, on one and on several
   ranks. And of base/matrixadd, by which sums of terms are formed.
*/
#include "base/algebra/matrixadd.h"
#include "brake.h"
#include "check.h"
#include "scratch.h"
#include "petscmain.h"
#include <string.h>

/* Breaks when: a sum in place meets another column than its own, also of another rank, or changes a matrix that has no place
   for it. Reference: MatAXPY() */
static PetscErrorCode TestSum(int *failed)
{
  PetscReal apart;
  PetscBool added, refused;
  Mat       K, wide, sum;

  PetscFunctionBeginUser;
  PetscCall(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, 40, 40, 4, NULL, 4, NULL, &K));
  for (PetscInt i = 0; i < 40; i++)
    for (PetscInt j = 0; j < 40; j += 13)
      PetscCall(MatSetValue(K, i, (i + j) % 40, 1 + 0.1 * i - 0.3 * j, INSERT_VALUES));
  PetscCall(MatAssemblyBegin(K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatMatMult(K, K, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &wide));
  PetscCall(MatDuplicate(wide, MAT_COPY_VALUES, &sum));
  PetscCall(MatrixAdd(0.3, wide, K, &refused));
  PetscCall(MatrixAdd(0.3, K, sum, &added));
  *failed += CheckTrue("a sum in a wider pattern, none in a narrower one", added && !refused, added + 2 * refused);
  PetscCall(MatAXPY(wide, 0.3, K, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MatAXPY(sum, -1, wide, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MatNorm(sum, NORM_FROBENIUS, &apart));
  *failed += CheckClose("beside MatAXPY()", apart, 0, 1e-13);
  for (int i = 0; i < 3; i++) PetscCall(MatDestroy((Mat *[]){&K, &wide, &sum}[i]));
  PetscFunctionReturn(0);
}

/* Breaks when: a bad value passes, or its message does not name parameter, value, limits and unit */
static PetscErrorCode TestBad(Pencil o, const char name[], PetscReal bad, const char expected[], int *failed)
{
  const OperatorsParameter *q;
  const PetscReal          *present;
  PetscInt                  n;
  PetscReal                 p[64];
  PetscErrorCode            error;
  Scratch                   keep = {.code = 0};

  PetscFunctionBeginUser;
  PetscCall(PencilGetParameters(o, &n, &q, &present));
  for (PetscInt i = 0; i < n; i++) p[i] = strcmp(q[i].name, name) ? q[i].value : bad;
  PetscCall(PetscPushErrorHandler(ScratchKeepError, &keep));
  error = PencilSetParameters(o, p);
  PetscCall(PetscPopErrorHandler());
  *failed += CheckTrue(keep.message, error == PETSC_ERR_USER_INPUT && !strcmp(keep.message, expected), (double)error);
  for (PetscInt i = 0; i < n; i++)
    if (!strcmp(q[i].name, name)) *failed += CheckTrue("the value stays", present[i] == q[i].value, present[i]);
  PetscFunctionReturn(0);
}

/* Limits that are excluded, limits that are not, and no number */
static PetscErrorCode TestLimits(int *failed)
{
  Chain chain;

  PetscFunctionBeginUser;
  PetscCall(ChainCreate(BRAKE SLIP DAMPED, BODIES_1 BEAM_1 "-contact_mu 0.5 -contact_speed 2 " ROLLING, &chain));
  PetscCall(ChainLinearise(&chain, NULL));
  PetscCall(TestBad(chain.pencil, "pad_young", 0, "pad_young 0 Pa must exceed 0", failed));
  PetscCall(TestBad(chain.pencil, "pad_alpha", -1, "pad_alpha -1 1/s must be at least 0", failed));
  PetscCall(TestBad(chain.pencil, "contact_mu", INFINITY, "contact_mu inf must be a finite number", failed));
  PetscCall(ChainDestroy(&chain));
  PetscFunctionReturn(0);
}

/* Breaks when: new values make a new matrix although nothing comes or goes, which costs a new symbolic factorisation.
   Loaded matrices: K + mu H = [2, -mu; mu, 3] by hand */
static PetscErrorCode TestDense(int *failed)
{
  const PetscReal mu[] = {0.25, -4, 0};
  PencilMatrices  first, again;
  PetscReal       norm;
  Operators       o;
  Pencil          pencil;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscOptionsInsertString(
    NULL, "-operators_dense_k 2,0,0,3 -operators_dense_m 1,0,0,1 -operators_dense_h 0,-1,1,0 -contact_mu 1"));
  PetscCall(OperatorsCreate(PETSC_COMM_WORLD, &o));
  PetscCall(OperatorsSetFromOptions(o));
  PetscCall(OperatorsSetUp(o));
  PetscCall(OperatorsLinearise(o, NULL, &pencil));
  PetscCall(PencilGetMatrices(pencil, &first));
  for (int i = 0; i < 3; i++) {
    PetscCall(PencilSetParameters(pencil, &mu[i]));
    PetscCall(PencilGetMatrices(pencil, &again));
    PetscCall(MatNorm(again.K, NORM_FROBENIUS, &norm));
    *failed += CheckClose("|K + mu H|", norm, sqrt(13 + 2 * mu[i] * mu[i]), 1e-15 * 10);
    *failed += CheckTrue("the matrix is kept while mu is not zero", (again.K == first.K) == (mu[i] != 0), mu[i]);
    *failed += CheckTrue("symmetric without friction", again.symmetric == (mu[i] == 0), mu[i]);
  }
  PetscCall(PencilDestroy(&pencil));
  PetscCall(OperatorsDestroy(&o));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  (void)size;
  PetscCall(TestLimits(failed));
  PetscCall(TestDense(failed));
  PetscCall(TestSum(failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
