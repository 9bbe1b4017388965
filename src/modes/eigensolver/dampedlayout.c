/*
   Damped problem of which a rank has no unknowns, as one of a body that is held. PEP TOAR keeps the coefficients of its
   basis on every rank, in a BV of type tensor whose local length is that of the vectors: where it is 0 SLEPc leaves the
   coefficients as they are (BVScaleColumn and BVMultInPlace return at once), that rank takes other decisions, and the
   ranks wait for each other. PEP is given the same rows in the same order in even shares.
*/
#include "modes/modesimpl.h"

/* K, C and M in even shares of the rows */
static PetscErrorCode PencilSpread(const PencilMatrices *pencil, PencilMatrices *even)
{
  const Mat      from[3] = {pencil->K, pencil->C, pencil->M};
  Mat           *to[3]   = {&even->K, &even->C, &even->M};
  const MPI_Comm comm    = PetscObjectComm((PetscObject)pencil->K);
  PetscInt       n, local = PETSC_DECIDE, last;
  IS             rows;

  PetscFunctionBeginUser;
  *even = (PencilMatrices){.symmetric = pencil->symmetric, .singular = pencil->singular};
  PetscCall(MatGetSize(pencil->K, &n, NULL));
  PetscCall(PetscSplitOwnership(comm, &local, &n));
  PetscCallMPI(MPI_Scan(&local, &last, 1, MPIU_INT, MPI_SUM, comm));
  PetscCall(ISCreateStride(comm, local, last - local, 1, &rows));
  for (int i = 0; i < 3; i++) {
    PetscBool known, symmetric;

    PetscCall(MatCreateSubMatrix(from[i], rows, rows, MAT_INITIAL_MATRIX, to[i]));
    PetscCall(MatIsSymmetricKnown(from[i], &known, &symmetric));
    if (known) PetscCall(MatSetOption(*to[i], MAT_SYMMETRIC, symmetric));
  }
  PetscCall(ISDestroy(&rows));
  PetscFunctionReturn(0);
}

/* Gives a vector the layout of K */
static PetscErrorCode VectorGather(Mat K, VecScatter back, Vec *x)
{
  Vec own;

  PetscFunctionBeginUser;
  if (!*x) PetscFunctionReturn(0);
  PetscCall(MatCreateVecs(K, &own, NULL));
  PetscCall(VecScatterBegin(back, *x, own, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(back, *x, own, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecDestroy(x));
  *x = own;
  PetscFunctionReturn(0);
}

static PetscErrorCode SpectrumGather(Mat K, Mat even, Spectrum *spectrum)
{
  PetscInt   first, last;
  IS         own;
  Vec        from, to;
  VecScatter back;

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(K, &first, &last));
  PetscCall(ISCreateStride(PetscObjectComm((PetscObject)K), last - first, first, 1, &own));
  PetscCall(MatCreateVecs(even, &from, NULL));
  PetscCall(MatCreateVecs(K, &to, NULL));
  PetscCall(VecScatterCreate(from, own, to, own, &back));
  for (PetscInt i = 0; i < spectrum->n; i++) {
    PetscCall(VectorGather(K, back, &spectrum->xr[i]));
    PetscCall(VectorGather(K, back, &spectrum->xi[i]));
  }
  PetscCall(VecScatterDestroy(&back));
  PetscCall(VecDestroy(&from));
  PetscCall(VecDestroy(&to));
  PetscCall(ISDestroy(&own));
  PetscFunctionReturn(0);
}

PetscErrorCode DampedSolveSpread(Modes modes, const PencilMatrices *pencil, const Window *window, PetscReal shift,
                                 PetscBool transposed, Spectrum *spectrum)
{
  PencilMatrices even;
  ShiftInvert    si;

  PetscFunctionBeginUser;
  PetscCall(PencilSpread(pencil, &even));
  PetscCall(ShiftInvertCreate(&even, shift, PETSC_FALSE, &modes->progress, &si));
  PetscCall(DampedSolvePep(modes, &even, window, &si, transposed, spectrum));
  PetscCall(SpectrumGather(pencil->K, even.K, spectrum));
  PetscCall(ShiftInvertDestroy(&si));
  PetscCall(MatDestroy(&even.K));
  PetscCall(MatDestroy(&even.C));
  PetscCall(MatDestroy(&even.M));
  PetscFunctionReturn(0);
}
