/*
   Scaled multipliers of loaded matrices. With a constraint b'u = 0 whose entries are near one the matrices of another
   program have rows of 1 beside stiffnesses k of 1e9 N/m, and in a vector the multiplier, which is a force, is 1e9
   times the displacements: these are lost in rounding. In

      u = Z q,   Z = diag(d),   d_j = min(k / max_i |K_ij|, sqrt(k / |K_jj|)) for an unknown j without mass, else 1,

   i other than j, both are of one size. k is the geometric mean of the stiffnesses on the diagonal of the unknowns with
   mass. Each d is a power of two, so that Z' A Z is exact. Z is the null space of a pencil without constraints.
*/
#include "operators/pencilimpl.h"

/* a d beyond it, or below its inverse, three figures of sixteen: else nothing is scaled */
#define SCALED_FROM 1024

/* Geometric mean of |K_ii| over the rows where M has entries, on all ranks; zero where there is none. The arithmetic
   one would be that of the stiffest spring. */
static PetscErrorCode MeanStiffness(Mat K, Vec mass, PetscReal *mean)
{
  PetscReal          sum[2] = {0, 0};
  PetscInt           n;
  const PetscScalar *m, *k;
  Vec                diagonal;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(mass, &diagonal));
  PetscCall(MatGetDiagonal(K, diagonal));
  PetscCall(VecGetLocalSize(mass, &n));
  PetscCall(VecGetArrayRead(mass, &m));
  PetscCall(VecGetArrayRead(diagonal, &k));
  for (PetscInt i = 0; i < n; i++)
    if (m[i] > 0 && k[i] != 0) sum[0] += PetscLogReal(PetscAbsScalar(k[i])), sum[1] += 1;
  PetscCall(VecRestoreArrayRead(diagonal, &k));
  PetscCall(VecRestoreArrayRead(mass, &m));
  PetscCall(VecDestroy(&diagonal));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, PetscObjectComm((PetscObject)K)));
  *mean = sum[1] > 0 ? PetscExpReal(sum[0] / sum[1]) : 0;
  PetscFunctionReturn(0);
}

/* d of an unknown without mass, a power of two */
static PetscErrorCode RowScale(Mat K, PetscInt row, PetscReal k, PetscReal *d)
{
  const PetscInt    *column;
  const PetscScalar *value;
  PetscInt           n;
  PetscReal          own = 0, other = 0;

  PetscFunctionBeginUser;
  PetscCall(MatGetRow(K, row, &n, &column, &value));
  for (PetscInt i = 0; i < n; i++) {
    PetscReal *size = column[i] == row ? &own : &other;

    *size = PetscMax(*size, PetscAbsScalar(value[i]));
  }
  PetscCall(MatRestoreRow(K, row, &n, &column, &value));
  *d = other > 0 ? k / other : own > 0 ? PETSC_MAX_REAL : 1;
  if (own > 0) *d = PetscMin(*d, PetscSqrtReal(k / own));
  *d = exp2(round(log2(*d)));
  PetscFunctionReturn(0);
}

/* The diagonal d, and whether it is far from one */
static PetscErrorCode FindScales(Mat K, Vec mass, PetscReal k, Vec scale, PetscBool *far)
{
  const PetscScalar *m;
  PetscScalar       *d;
  PetscInt           first, last;
  PetscReal          limits[2];

  PetscFunctionBeginUser;
  PetscCall(VecGetOwnershipRange(mass, &first, &last));
  PetscCall(VecGetArrayRead(mass, &m));
  PetscCall(VecGetArrayWrite(scale, &d));
  for (PetscInt row = first; row < last; row++) {
    d[row - first] = 1;
    if (m[row - first] == 0) PetscCall(RowScale(K, row, k, &d[row - first]));
  }
  PetscCall(VecRestoreArrayWrite(scale, &d));
  PetscCall(VecRestoreArrayRead(mass, &m));
  PetscCall(VecMin(scale, NULL, &limits[0]));
  PetscCall(VecMax(scale, NULL, &limits[1]));
  *far = limits[0] * SCALED_FROM < 1 || limits[1] > SCALED_FROM ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* diag(d) */
static PetscErrorCode DiagonalCreate(Mat like, Vec d, Mat *Z)
{
  PetscInt n_local;

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(like, &n_local, NULL));
  PetscCall(MatCreateAIJ(PetscObjectComm((PetscObject)like), n_local, n_local, PETSC_DETERMINE, PETSC_DETERMINE, 1,
                         NULL, 0, NULL, Z));
  PetscCall(MatDiagonalSet(*Z, d, INSERT_VALUES));
  PetscFunctionReturn(0);
}

PetscErrorCode PencilScaleMultipliers(Pencil pencil)
{
  PencilMatrices m;
  PetscReal      k;
  PetscBool      far = PETSC_FALSE;
  Vec            mass, d;

  PetscFunctionBeginUser;
  PetscCall(PencilGetMatrices(pencil, &m));
  PetscCall(MatCreateVecs(m.M, NULL, &mass));
  PetscCall(VecDuplicate(mass, &d));
  PetscCall(MatGetRowMaxAbs(m.M, mass, NULL));
  PetscCall(MeanStiffness(m.K, mass, &k));
  if (k > 0) PetscCall(FindScales(m.K, mass, k, d, &far));
  if (far) {
    PetscCall(DiagonalCreate(m.K, d, &pencil->Zr));
    PetscCall(VecReciprocal(d));
    PetscCall(DiagonalCreate(m.K, d, &pencil->E));
    for (int i = 0; i < N_PENCIL_SUMS; i++) PetscCall(TermsSumDestroy(&pencil->sum[i]));
  }
  PetscCall(VecDestroy(&d));
  PetscCall(VecDestroy(&mass));
  PetscFunctionReturn(0);
}
