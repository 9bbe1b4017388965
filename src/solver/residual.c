/*
   Residuals of eigenpairs of the quadratic problem on real matrices; see residual.h.
*/
#include "residual.h"
#include "orthonormal.h"

PetscErrorCode ComplexColumnsCreate(PetscInt capacity, ComplexColumns *c)
{
  PetscFunctionBeginUser;
  c->m = c->n_columns = 0;
  PetscCall(PetscMalloc2(capacity + 1, &c->column, capacity, &c->lambda));
  c->column[0] = 0;
  PetscFunctionReturn(0);
}

void ComplexColumnsAdd(ComplexColumns *c, PetscComplex lambda, PetscBool is_real)
{
  c->n_columns += is_real ? 1 : 2;
  c->lambda[c->m]     = lambda;
  c->column[c->m + 1] = c->n_columns;
  c->m++;
}

PetscErrorCode ComplexColumnsDestroy(ComplexColumns *c)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(c->column, c->lambda));
  PetscFunctionReturn(0);
}

/* R += lambda^power AX, mode by mode */
static PetscErrorCode ResidualScale(const ComplexColumns *c, int power, Mat AX, Mat R)
{
  const PetscScalar *ax;
  PetscScalar       *r;
  PetscInt           n, ldx, ldr;

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(AX, &n, NULL));
  PetscCall(MatDenseGetLDA(AX, &ldx));
  PetscCall(MatDenseGetLDA(R, &ldr));
  PetscCall(MatDenseGetArrayRead(AX, &ax));
  PetscCall(MatDenseGetArray(R, &r));
  for (PetscInt j = 0; j < c->m; j++) {
    const PetscComplex a  = power == 2 ? c->lambda[j] * c->lambda[j] : power == 1 ? c->lambda[j] : 1;
    const PetscReal    re = creal(a), im = cimag(a);
    const PetscInt     at = c->column[j], two = c->column[j + 1] - at == 2;
    const PetscScalar *xr = &ax[at * ldx], *xi = &ax[(at + 1) * ldx];

    for (PetscInt k = 0; k < n; k++) r[at * ldr + k] += re * xr[k] - (two ? im * xi[k] : 0);
    for (PetscInt k = 0; k < n && two; k++) r[(at + 1) * ldr + k] += re * xi[k] + im * xr[k];
  }
  PetscCall(MatDenseRestoreArray(R, &r));
  PetscCall(MatDenseRestoreArrayRead(AX, &ax));
  PetscFunctionReturn(0);
}

/* Whether a matrix is known to be symmetric */
static PetscErrorCode ResidualIsSymmetric(Mat A, PetscBool *symmetric)
{
  PetscBool known;

  PetscFunctionBeginUser;
  PetscCall(MatIsSymmetricKnown(A, &known, symmetric));
  if (!known) *symmetric = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* R += lambda^power A X, or A' X: products with the rows of A are several times faster than with its columns */
static PetscErrorCode ResidualAdd(Mat A, PetscBool transposed, const ComplexColumns *c, int power, Mat X, Mat R)
{
  PetscBool symmetric;
  Mat       AX;

  PetscFunctionBeginUser;
  PetscCall(ResidualIsSymmetric(A, &symmetric));
  if (transposed && !symmetric) {
    PetscCall(MatTransposeMatMult(A, X, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &AX));
  } else {
    PetscCall(MatDuplicate(X, MAT_DO_NOT_COPY_VALUES, &AX));
    PetscCall(BlockMultiply(A, X, AX));
  }
  PetscCall(ResidualScale(c, power, AX, R));
  PetscCall(MatDestroy(&AX));
  PetscFunctionReturn(0);
}

/* R += K' X by K' = K_even + right' left */
static PetscErrorCode ResidualAddFriction(const PencilMatrices *pencil, const ComplexColumns *c, Mat X, Mat R)
{
  Mat LX, RLX;

  PetscFunctionBeginUser;
  PetscCall(ResidualAdd(pencil->K_even, PETSC_FALSE, c, 0, X, R));
  PetscCall(MatMatMult(pencil->left, X, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &LX));
  PetscCall(MatTransposeMatMult(pencil->right, LX, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &RLX));
  PetscCall(ResidualScale(c, 0, RLX, R));
  PetscCall(MatDestroy(&RLX));
  PetscCall(MatDestroy(&LX));
  PetscFunctionReturn(0);
}

PetscErrorCode ResidualMake(const PencilMatrices *pencil, PetscBool transposed, const ComplexColumns *c, Mat X, Mat R)
{
  PetscFunctionBeginUser;
  PetscCall(MatZeroEntries(R));
  if (transposed && pencil->K_even)
    PetscCall(ResidualAddFriction(pencil, c, X, R));
  else
    PetscCall(ResidualAdd(pencil->K, transposed, c, 0, X, R));
  if (pencil->C) PetscCall(ResidualAdd(pencil->C, transposed, c, 1, X, R));
  PetscCall(ResidualAdd(pencil->M, transposed, c, 2, X, R));
  PetscFunctionReturn(0);
}
