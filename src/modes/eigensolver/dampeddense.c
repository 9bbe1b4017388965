/*
   Damped problem of few unknowns: all 2 n eigenvalues by LAPACK, on rank 0, whose answer all ranks take. TOAR would
   converge most of them for those of a window amid overdamped ones, and breaks down in the whole space, where rounding
   decides. Ranks without unknowns: dampedlayout.c.
*/
#include "modes/modesimpl.h"
#include "basis/pencil.h"

#define DENSE_ALWAYS 200  /* unknowns up to which LAPACK takes about as long as TOAR's first eigenvalues */
#define DENSE_DOUBLE 1e-7 /* of its size: an imaginary part that may be rounding */
/* up to which it is taken where many are wanted, or TOAR does not end: a matrix of 800 x 800 */
#define DENSE_MOST  400
#define DENSE_SHARE 4 /* many: one of so many */
/* times the shift: the one of the transposed problem, which symmetric matrices leave the same otherwise */
#define DENSE_OTHER 1.7

/* PEP does where it is asked for, but for few unknowns of which a rank has none */
PetscErrorCode DampedIsDense(Modes modes, Mat K, PetscInt nev, int attempt, PetscBool *dense)
{
  PetscInt  n;
  PetscBool given, empty;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(K, &n, NULL));
  PetscCall(DampedHasEmpty(K, &empty));
  PetscCall(SolverOptionsGiven("pep_", &given));
  given  = given || modes->damping == DAMPING_PEP ? PETSC_TRUE : PETSC_FALSE;
  *dense = n <= DENSE_ALWAYS || (n <= DENSE_MOST && (attempt || DENSE_SHARE * nev > 2 * n)) ? PETSC_TRUE : PETSC_FALSE;
  if (given) *dense = PETSC_FALSE;
  if (empty && n <= DENSE_MOST) *dense = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* All entries of A, column-major [n * n], on rank 0 */
static PetscErrorCode DenseGather(Mat A, PetscBool transposed, PetscInt n, PetscReal dense[])
{
  PetscMPIInt rank;
  IS          all;
  Mat        *whole;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PetscObjectComm((PetscObject)A), &rank));
  PetscCall(ISCreateStride(PETSC_COMM_SELF, rank ? 0 : n, 0, 1, &all));
  PetscCall(MatCreateSubMatrices(A, 1, &all, &all, MAT_INITIAL_MATRIX, &whole));
  for (PetscInt i = 0; i < n && rank == 0; i++) {
    const PetscInt    *column;
    const PetscScalar *value;
    PetscInt           m;

    PetscCall(MatGetRow(whole[0], i, &m, &column, &value));
    for (PetscInt k = 0; k < m; k++) dense[transposed ? column[k] + i * n : i + column[k] * n] = value[k];
    PetscCall(MatRestoreRow(whole[0], i, &m, &column, &value));
  }
  PetscCall(MatDestroySubMatrices(1, &whole));
  PetscCall(ISDestroy(&all));
  PetscFunctionReturn(0);
}

/* Rounding makes of a double real eigenvalue, which critical damping has, a conjugate pair apart by the root of
   rounding: makes two real ones of such a last one, both with the larger part of its vector */
static void DensePart(PetscInt n, PetscInt *m, PetscComplex lambda[], PetscComplex X[])
{
  PetscComplex *x = &X[(*m - 1) * n], *twin = x + n;
  PetscReal     size[2] = {0, 0};

  if (cimag(lambda[*m - 1]) == 0 || PetscAbsReal(cimag(lambda[*m - 1])) > DENSE_DOUBLE * cabs(lambda[*m - 1])) return;
  for (PetscInt i = 0; i < n; i++) size[0] += PetscSqr(creal(x[i])), size[1] += PetscSqr(cimag(x[i]));
  for (PetscInt i = 0; i < n; i++) twin[i] = x[i] = size[1] > size[0] ? cimag(x[i]) : creal(x[i]);
  lambda[*m] = lambda[*m - 1] = creal(lambda[*m - 1]);
  ++*m;
}

/* Eigenvalues within a circle, its middle and radius, found about a shift, and their vectors X [m][n]; on rank 0 */
static PetscErrorCode DenseSolveWithin(const DensePencil *pencil, PetscReal shift, const PetscReal circle[2],
                                       PetscInt *m, PetscComplex lambda[], PetscComplex X[])
{
  DenseShifted w;

  PetscFunctionBeginUser;
  *m = 0;
  PetscCall(DenseShiftedSolve(pencil, shift, &w));
  for (PetscInt i = 0; i < w.N; i++) {
    if (!DenseShiftedLambda(&w, i, &lambda[*m]) || cabs(lambda[*m] - circle[0]) > circle[1]) continue;
    PetscCall(DenseShiftedRight(&w, i, &X[*m * pencil->n]));
    ++*m;
    DensePart(pencil->n, m, lambda, X);
  }
  PetscCall(DenseShiftedDestroy(&w));
  PetscFunctionReturn(0);
}

/* Puts the m vectors of rank 0 into a spectrum */
static PetscErrorCode DenseSpread(Mat K, PetscInt m, const PetscComplex lambda[], const PetscComplex X[], Spectrum *s)
{
  PetscInt n, first, last;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(K, &n, NULL));
  PetscCall(MatGetOwnershipRange(K, &first, &last));
  PetscCall(SpectrumCreate(m, s));
  for (PetscInt i = 0; i < m; i++) {
    Vec x[2] = {NULL, NULL};

    PetscCall(MatCreateVecs(K, &x[0], cimag(lambda[i]) != 0 ? &x[1] : NULL));
    for (int part = 0; part < 2 && x[part]; part++) {
      PetscScalar *entry;

      PetscCall(VecGetArrayWrite(x[part], &entry));
      for (PetscInt k = first; k < last; k++) entry[k - first] = part ? cimag(X[i * n + k]) : creal(X[i * n + k]);
      PetscCall(VecRestoreArrayWrite(x[part], &entry));
    }
    PetscCall(SpectrumTake(s, creal(lambda[i]), cimag(lambda[i]), x[0], x[1]));
  }
  s->reach = PETSC_MAX_REAL;
  PetscCall(SpectrumSort(s));
  PetscFunctionReturn(0);
}

PetscErrorCode DampedSolveDense(Modes modes, const PencilMatrices *matrices, const Window *window, PetscReal shift,
                                PetscBool transposed, Spectrum *spectrum)
{
  const PetscReal circle[2] = {shift, window->count ? INFINITY : DampedRadius(window, shift, NULL)};
  const PetscReal at        = transposed ? DENSE_OTHER * shift : shift;
  const MPI_Comm  comm      = PetscObjectComm((PetscObject)matrices->K);
  const Mat       of[3]     = {matrices->K, matrices->C, matrices->M};
  DensePencil     pencil    = {.damped = PETSC_TRUE};
  PetscReal     **dense[3]  = {&pencil.K, &pencil.C, &pencil.M};
  PetscComplex   *lambda, *X;
  PetscInt        n, m = 0;
  PetscMPIInt     rank, count;

  PetscFunctionBeginUser;
  modes->dense = PETSC_TRUE;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(MatGetSize(matrices->K, &n, NULL));
  pencil.n = n;
  for (int i = 0; i < 3; i++) {
    PetscCall(PetscCalloc1(rank ? 0 : n * n, dense[i]));
    PetscCall(DenseGather(of[i], transposed, n, *dense[i]));
  }
  PetscCall(PetscMalloc2(2 * n, &lambda, 2 * n * n, &X));
  if (rank == 0) PetscCall(DenseSolveWithin(&pencil, at, circle, &m, lambda, X));
  PetscCallMPI(MPI_Bcast(&m, 1, MPIU_INT, 0, comm));
  PetscCall(PetscMPIIntCast(2 * m * n, &count));
  PetscCallMPI(MPI_Bcast(lambda, (PetscMPIInt)(2 * m), MPIU_REAL, 0, comm));
  PetscCallMPI(MPI_Bcast(X, count, MPIU_REAL, 0, comm));
  PetscCall(DenseSpread(matrices->K, m, lambda, X, spectrum));
  PetscCall(PetscFree2(lambda, X));
  for (int i = 0; i < 3; i++) PetscCall(PetscFree(*dense[i]));
  PetscFunctionReturn(0);
}

PetscErrorCode DampedHasEmpty(Mat K, PetscBool *empty)
{
  PetscInt least;

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(K, &least, NULL));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPIU_INT, MPI_MIN, PetscObjectComm((PetscObject)K)));
  *empty = least ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(0);
}
