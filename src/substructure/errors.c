/*
   Errors of the superelement's own modes in the band, with its interface free and held (substructure.h):

      G = R_i' K_ii^-1 R_i,   R = K X - M X diag(kappa),   X = T q,
      diag(kappa) - D G D,    D = diag(1 - kappa / kappa_next)^-1/2

   has the eigenvalues of the parts as far as the second order of R tells. R is orthogonal to T, so that K_ii^-1 answers
   with what the modes leave out alone.
*/
#include "substructureimpl.h"
#include "base/algebra/dense.h"
#include "base/algebra/gram.h"
#include "base/algebra/product.h"

#define MEASURE_NEAR 0.05 /* least 1 - kappa / kappa_next */

/* The vectors of all modes on every rank, q [modes][n], those of the modal coordinates where held */
static PetscErrorCode MeasureVectors(Substructure s, const MatrixModes *modes, PetscBool held, PetscReal q[])
{
  const PetscInt first = held ? s->interface.n : 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < modes->n; k++) {
    const PetscScalar *value;
    PetscInt           n;
    Vec                x, all;
    VecScatter         scatter;

    PetscCall(ModesGetVectors(modes->modes, k, &x, NULL, NULL, NULL));
    PetscCall(VecGetSize(x, &n));
    PetscCall(VecScatterCreateToAll(x, &scatter, &all));
    PetscCall(VecScatterBegin(scatter, x, all, INSERT_VALUES, SCATTER_FORWARD));
    PetscCall(VecScatterEnd(scatter, x, all, INSERT_VALUES, SCATTER_FORWARD));
    PetscCall(VecGetArrayRead(all, &value));
    PetscCall(PetscArrayzero(&q[(size_t)k * s->n], s->n));
    PetscCall(PetscArraycpy(&q[(size_t)k * s->n + first], value, n));
    PetscCall(VecRestoreArrayRead(all, &value));
    PetscCall(VecScatterDestroy(&scatter));
    PetscCall(VecDestroy(&all));
  }
  PetscFunctionReturn(0);
}

/* R of all modes, of which those inside are taken */
static PetscErrorCode MeasureResiduals(Substructure s, const MatrixModes *modes, const PetscReal q[], Mat *inside)
{
  Mat X, KX, MX;

  PetscFunctionBeginUser;
  PetscCall(MatCreateDense(s->comm, s->body.n_own, PETSC_DECIDE, PETSC_DETERMINE, modes->n, NULL, &X));
  PetscCall(MatZeroEntries(X));
  PetscCall(BlockAddProduct(1, s->T, q, X));
  PetscCall(MatDuplicate(X, MAT_DO_NOT_COPY_VALUES, &KX));
  PetscCall(MatDuplicate(X, MAT_DO_NOT_COPY_VALUES, &MX));
  PetscCall(BlockMultiply(s->body.K, X, KX));
  PetscCall(BlockMultiply(s->body.M, X, MX));
  for (PetscInt k = 0; k < modes->n; k++) {
    Vec to, from;

    PetscCall(MatDenseGetColumnVec(KX, k, &to));
    PetscCall(MatDenseGetColumnVecRead(MX, k, &from));
    PetscCall(VecAXPY(to, -modes->kappa[k], from));
    PetscCall(MatDenseRestoreColumnVecRead(MX, k, &from));
    PetscCall(MatDenseRestoreColumnVec(KX, k, &to));
  }
  PetscCall(MatCreateDense(s->comm, s->interface.n_inside, PETSC_DECIDE, PETSC_DETERMINE, modes->n, NULL, inside));
  PetscCall(InterfaceGather(s, KX, *inside));
  PetscCall(MatDestroy(&X));
  PetscCall(MatDestroy(&KX));
  PetscCall(MatDestroy(&MX));
  PetscFunctionReturn(0);
}

/* kappa [n] corrected together */
static PetscErrorCode MeasureCorrect(Substructure s, const MatrixModes *modes, Mat R, PetscReal corrected[])
{
  const PetscInt  n    = modes->n;
  const PetscReal next = PetscSqr(2 * PETSC_PI * s->cutoff);
  PetscReal      *G, *d;
  Mat             X;

  PetscFunctionBeginUser;
  PetscCall(FixedFactor(s));
  PetscCall(MatDuplicate(R, MAT_DO_NOT_COPY_VALUES, &X));
  PetscCall(ShiftInvertApplyBlock(&s->inside, PETSC_FALSE, R, X));
  PetscCall(PetscMalloc2(n * n, &G, n, &d));
  PetscCall(BlockGram(R, X, G));
  for (PetscInt k = 0; k < n; k++) d[k] = 1 / PetscSqrtReal(PetscMax(1 - modes->kappa[k] / next, MEASURE_NEAR));
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++) G[j * n + i] = (i == j ? modes->kappa[i] : 0) - d[i] * d[j] * G[j * n + i];
  PetscCall(DenseSymmetricEigen(n, G, NULL, corrected, NULL));
  PetscCall(PetscFree2(G, d));
  PetscCall(MatDestroy(&X));
  PetscFunctionReturn(0);
}

static PetscReal MeasureHz(PetscReal kappa)
{
  return PetscSqrtReal(PetscMax(kappa, 0)) / (2 * PETSC_PI);
}

/* Adds the modes in the band of these matrices with their errors, alike on all ranks: those of the first count */
static PetscErrorCode MeasureAdd(Substructure s, PetscBool held, Mat K, Mat M)
{
  MatrixModes modes;
  const Mode *mode;
  PetscReal  *q, *corrected;
  PetscInt    n;
  Mat         R;

  PetscFunctionBeginUser;
  PetscCall(MatrixModesSolve(s->comm, K, M, s->band[1], &modes));
  PetscCall(ModesGet(modes.modes, &n, &mode));
  PetscCall(PetscMalloc2(n, &corrected, (size_t)n * s->n, &q));
  PetscCall(PetscArraycpy(corrected, modes.kappa, n));
  if (s->T && n) {
    PetscCall(MeasureVectors(s, &modes, held, q));
    PetscCall(MeasureResiduals(s, &modes, q, &R));
    PetscCall(MeasureCorrect(s, &modes, R, corrected));
    PetscCall(MatDestroy(&R));
  }
  PetscCall(PetscRealloc((size_t)(s->n_modes + n) * sizeof(*s->mode), &s->mode));
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal f = MeasureHz(modes.kappa[k]), change = PetscAbsReal(f - MeasureHz(corrected[k]));

    if (f < s->band[0] * (1 - 1e-8)) continue;
    s->mode[s->n_modes++] = (SubstructureMode){held, f, PetscMax(change, mode[k].error / (2 * PETSC_PI))};
  }
  PetscCallMPI(MPI_Bcast(&s->n_modes, 1, MPIU_INT, 0, s->comm));
  PetscCallMPI(MPI_Bcast(s->mode, (PetscMPIInt)(sizeof(*s->mode) * (size_t)s->n_modes), MPI_BYTE, 0, s->comm));
  PetscCall(PetscFree2(corrected, q));
  PetscCall(MatrixModesDestroy(&modes));
  PetscFunctionReturn(0);
}

PetscErrorCode SubstructureMeasure(Substructure s)
{
  PetscInt  begin, end;
  PetscBool none;
  IS        modal;
  Mat       K, M;

  PetscFunctionBeginUser;
  PetscCall(MeasureAdd(s, PETSC_FALSE, s->K, s->M));
  none = s->n_modes ? PETSC_FALSE : PETSC_TRUE;
  PetscCheck(!none, s->comm, PETSC_ERR_USER_INPUT, SUBSTRUCTURE_NO_MODE, (double)s->band[0], (double)s->band[1]);
  if (!s->n_modal) PetscFunctionReturn(0);
  PetscCall(MatGetOwnershipRange(s->K, &begin, &end));
  begin = PetscMax(begin, s->interface.n);
  PetscCall(ISCreateStride(s->comm, PetscMax(0, end - begin), begin, 1, &modal));
  PetscCall(MatCreateSubMatrix(s->K, modal, modal, MAT_INITIAL_MATRIX, &K));
  PetscCall(MatCreateSubMatrix(s->M, modal, modal, MAT_INITIAL_MATRIX, &M));
  PetscCall(MeasureAdd(s, PETSC_TRUE, K, M));
  PetscCall(MatDestroy(&K));
  PetscCall(MatDestroy(&M));
  PetscCall(ISDestroy(&modal));
  PetscFunctionReturn(0);
}
