/*
   Residuals of eigenpairs of the quadratic problem on real matrices; see residual.h.
*/
#include "residual.h"
#include "orthonormal.h"

#define RESIDUAL_WIDTH 16 /* columns of a part, as many as BlockMultiply() takes at once */

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

/* Modes `first` .. `end` - 1 and their columns of the vectors and of the residuals, which stay in a cache while all matrices
   are multiplied with them, with room for a product */
typedef struct {
  const ComplexColumns *c;
  PetscInt              first, end;
  Mat                   X, R, AX;
} ResidualPart;

/* R += lambda^power AX, mode by mode */
static PetscErrorCode ResidualScale(const ResidualPart *p, int power, Mat AX)
{
  const ComplexColumns *c = p->c;
  const PetscScalar    *ax;
  PetscScalar          *r;
  PetscInt              n, ldx, ldr;

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(AX, &n, NULL));
  PetscCall(MatDenseGetLDA(AX, &ldx));
  PetscCall(MatDenseGetLDA(p->R, &ldr));
  PetscCall(MatDenseGetArrayRead(AX, &ax));
  PetscCall(MatDenseGetArray(p->R, &r));
  for (PetscInt j = p->first; j < p->end; j++) {
    const PetscComplex a  = power == 2 ? c->lambda[j] * c->lambda[j] : power == 1 ? c->lambda[j] : 1;
    const PetscReal    re = creal(a), im = cimag(a);
    const PetscInt     at = c->column[j] - c->column[p->first], two = c->column[j + 1] - c->column[j] == 2;
    const PetscScalar *xr = &ax[at * ldx], *xi = &ax[(at + 1) * ldx];

    for (PetscInt k = 0; k < n; k++) r[at * ldr + k] += re * xr[k] - (two ? im * xi[k] : 0);
    for (PetscInt k = 0; k < n && two; k++) r[(at + 1) * ldr + k] += re * xi[k] + im * xr[k];
  }
  PetscCall(MatDenseRestoreArray(p->R, &r));
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

/* Y = A X, or A' X: products with the rows of A are several times faster than with its columns */
static PetscErrorCode ResidualMultiply(Mat A, PetscBool transposed, Mat X, Mat Y)
{
  PetscBool symmetric;
  Mat       AX;

  PetscFunctionBeginUser;
  PetscCall(ResidualIsSymmetric(A, &symmetric));
  if (!transposed || symmetric) {
    PetscCall(BlockMultiply(A, X, Y));
    PetscFunctionReturn(0);
  }
  PetscCall(MatTransposeMatMult(A, X, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &AX));
  PetscCall(MatCopy(AX, Y, SAME_NONZERO_PATTERN));
  PetscCall(MatDestroy(&AX));
  PetscFunctionReturn(0);
}

/* R += lambda^power A X, or A' X */
static PetscErrorCode ResidualAdd(Mat A, PetscBool transposed, int power, const ResidualPart *p)
{
  PetscFunctionBeginUser;
  PetscCall(ResidualMultiply(A, transposed, p->X, p->AX));
  PetscCall(ResidualScale(p, power, p->AX));
  PetscFunctionReturn(0);
}

/* R += right' left X, what friction adds to K_even */
static PetscErrorCode ResidualAddFriction(const PencilMatrices *pencil, const ResidualPart *p)
{
  Mat LX, RLX;

  PetscFunctionBeginUser;
  PetscCall(MatMatMult(pencil->left, p->X, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &LX));
  PetscCall(MatTransposeMatMult(pencil->right, LX, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &RLX));
  PetscCall(ResidualScale(p, 0, RLX));
  PetscCall(MatDestroy(&RLX));
  PetscCall(MatDestroy(&LX));
  PetscFunctionReturn(0);
}

/* The residuals of a part */
static PetscErrorCode ResidualMakePart(const PencilMatrices *pencil, PetscBool transposed, const ResidualPart *p)
{
  const PetscBool pairs = transposed && pencil->K_even ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  if (pairs) {
    PetscCall(BlockMultiply(pencil->K_even, p->X, p->R));
    PetscCall(ResidualAddFriction(pencil, p));
  } else {
    PetscCall(ResidualMultiply(pencil->K, transposed, p->X, p->R));
  }
  if (pencil->C) PetscCall(ResidualAdd(pencil->C, transposed, 1, p));
  PetscCall(ResidualAdd(pencil->M, transposed, 2, p));
  PetscFunctionReturn(0);
}

PetscErrorCode ResidualMake(const PencilMatrices *pencil, PetscBool transposed, const ComplexColumns *c, Mat X, Mat R)
{
  ResidualPart p = {.c = c};

  PetscFunctionBeginUser;
  for (; p.first < c->m; p.first = p.end) {
    const PetscInt from = c->column[p.first];

    for (p.end = p.first + 1; p.end < c->m && c->column[p.end + 1] - from <= RESIDUAL_WIDTH;) p.end++;
    PetscCall(MatDenseGetSubMatrix(X, PETSC_DECIDE, PETSC_DECIDE, from, c->column[p.end], &p.X));
    PetscCall(MatDenseGetSubMatrix(R, PETSC_DECIDE, PETSC_DECIDE, from, c->column[p.end], &p.R));
    PetscCall(MatDuplicate(p.X, MAT_DO_NOT_COPY_VALUES, &p.AX));
    PetscCall(ResidualMakePart(pencil, transposed, &p));
    PetscCall(MatDestroy(&p.AX));
    PetscCall(MatDenseRestoreSubMatrix(R, &p.R));
    PetscCall(MatDenseRestoreSubMatrix(X, &p.X));
  }
  PetscFunctionReturn(0);
}
