/*
   Fixed interface: what its static shapes T_b leave out is the answer of what lies inside to their inertia,

      F = P' (M T_b)_i,   X = K_ii^-1 F,   E = F'X,   P = 1 - Phi Phi'M_ii,

   as kappa of a mode that moves the interface by u_b is too large by about kappa^2 u_b'E u_b / (1 - kappa /
   kappa_next). Such a mode has the kinetic energy of M_b = T_b'M T_b - (Phi'M T_b)'Phi'M T_b at least, u_b'M_b u_b,
   whatever the modes do, and whatever is joined to the interface. So the vectors of E v = mu M_b v of large mu, X v,
   become coordinates beside the modes, and the largest mu of the others tells the error of a frequency in any
   structure: kappa mu / 2 / (1 - kappa / kappa_next) of it.
*/
#include "substructure/substructureimpl.h"
#include "base/algebra/dense.h"
#include "base/algebra/gram.h"
#include "base/algebra/product.h"
#include <petscblaslapack.h>

#define INERTIA_BLOCK 64 /* columns at once */

/* M_b -= B'B, B [n][modes] */
static PetscErrorCode InertiaTakeOut(PetscInt n, PetscInt n_modes, const PetscReal B[], PetscReal mass[])
{
  const PetscReal one = 1, minus = -1;
  PetscBLASInt    size, inner;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(n, &size));
  PetscCall(PetscBLASIntCast(n_modes, &inner));
  PetscCallBLAS("BLASgemm", BLASgemm_("T", "N", &size, &size, &inner, &minus, B, &inner, B, &inner, &one, mass, &size));
  PetscFunctionReturn(0);
}

/* M T_b inside, without what the modes answer: F [inside][n of the interface]; and M_b [n][n] */
static PetscErrorCode InertiaForces(Substructure s, Mat *F, PetscReal mass[])
{
  const PetscInt N = s->interface.n;
  Mat            Phi, MPhi, statics, modal, M;
  PetscReal     *B;

  PetscFunctionBeginUser;
  PetscCall(MatCreateDense(s->comm, s->interface.n_inside, PETSC_DECIDE, PETSC_DETERMINE, N, NULL, F));
  PetscCall(MatDenseGetSubMatrix(s->T, PETSC_DECIDE, PETSC_DECIDE, 0, N, &statics));
  PetscCall(MatDuplicate(statics, MAT_DO_NOT_COPY_VALUES, &M));
  PetscCall(BlockMultiply(s->body.M, statics, M));
  PetscCall(BlockGram(statics, M, mass));
  PetscCall(MatDenseRestoreSubMatrix(s->T, &statics));
  PetscCall(InterfaceGather(s, M, *F));
  if (!s->n_modal) {
    PetscCall(MatDestroy(&M));
    PetscFunctionReturn(0);
  }
  PetscCall(MatDenseGetSubMatrix(s->T, PETSC_DECIDE, PETSC_DECIDE, N, s->n, &modal));
  PetscCall(PetscMalloc1((size_t)N * s->n_modal, &B));
  PetscCall(BlockGram(modal, M, B));
  PetscCall(InertiaTakeOut(N, s->n_modal, B, mass));
  PetscCall(PetscFree(B));
  PetscCall(MatDestroy(&M));
  PetscCall(MatDuplicate(modal, MAT_DO_NOT_COPY_VALUES, &M));
  PetscCall(BlockMultiply(s->body.M, modal, M));
  PetscCall(MatCreateDense(s->comm, s->interface.n_inside, PETSC_DECIDE, PETSC_DETERMINE, s->n_modal, NULL, &Phi));
  PetscCall(MatDuplicate(Phi, MAT_DO_NOT_COPY_VALUES, &MPhi));
  PetscCall(InterfaceGather(s, modal, Phi));
  PetscCall(InterfaceGather(s, M, MPhi));
  PetscCall(MatDenseRestoreSubMatrix(s->T, &modal));
  PetscCall(BlockTakeOut(MPhi, Phi, *F));
  PetscCall(MatDestroy(&M));
  PetscCall(MatDestroy(&Phi));
  PetscCall(MatDestroy(&MPhi));
  PetscFunctionReturn(0);
}

/* E [n][n], exactly symmetric */
static PetscErrorCode InertiaEnergies(Substructure s, Mat F, PetscReal E[])
{
  const PetscInt N = s->interface.n;

  PetscFunctionBeginUser;
  for (PetscInt first = 0, n; first < N; first += n) {
    Mat B, X;

    n = PetscMin(INERTIA_BLOCK, N - first);
    PetscCall(MatDenseGetSubMatrix(F, PETSC_DECIDE, PETSC_DECIDE, first, first + n, &B));
    PetscCall(MatDuplicate(B, MAT_DO_NOT_COPY_VALUES, &X));
    PetscCall(ShiftInvertApplyBlock(&s->inside, PETSC_FALSE, B, X));
    PetscCall(MatDenseRestoreSubMatrix(F, &B));
    PetscCall(BlockGram(F, X, &E[(size_t)first * N]));
    PetscCall(MatDestroy(&X));
  }
  for (PetscInt j = 0; j < N; j++)
    for (PetscInt i = 0; i < j; i++) E[j * N + i] = E[i * N + j] = 0.5 * (E[j * N + i] + E[i * N + j]);
  PetscFunctionReturn(0);
}

/* The chosen vectors v at the end of those in E, alike on all ranks */
static PetscErrorCode InertiaChoose(Substructure s, PetscReal E[], PetscReal mass[], PetscInt *n_chosen, PetscReal mu[])
{
  const PetscInt  N     = s->interface.n;
  const PetscReal kappa = PetscSqr(2 * PETSC_PI * s->band[1]), next = PetscSqr(2 * PETSC_PI * s->cutoff);
  const PetscReal error = kappa / 2 / (1 - kappa / next); /* of a frequency at the end of the band, times mu */
  PetscBool       definite;

  PetscFunctionBeginUser;
  PetscCall(DenseSymmetricEigen(N, E, mass, mu, &definite));
  PetscCheck(definite, PETSC_COMM_SELF, PETSC_ERR_PLIB, "the static shapes have no mass");
  PetscCallMPI(MPI_Bcast(E, (PetscMPIInt)(N * N), MPIU_REAL, 0, s->comm));
  PetscCallMPI(MPI_Bcast(mu, (PetscMPIInt)N, MPIU_REAL, 0, s->comm));
  for (*n_chosen = 0; *n_chosen < N && error * mu[N - 1 - *n_chosen] > s->rtol;) ++*n_chosen;
  s->any = *n_chosen < N ? error * PetscMax(mu[N - 1 - *n_chosen], 0) : 0;
  PetscFunctionReturn(0);
}

/* V [n][n of the interface] in a basis that does not depend on rounding */
static PetscErrorCode InertiaTurn(Substructure s, PetscInt n, const PetscReal mu[], const PetscReal mass[],
                                  const PetscReal V[], PetscReal turned[])
{
  const PetscInt N = s->interface.n, widest = CanonWidest(n, mu);
  PetscReal     *P, *Q, size;

  PetscFunctionBeginUser;
  PetscCall(CanonSize(s, &size));
  PetscCall(PetscCalloc2(n * widest, &P, n * n, &Q));
  for (PetscInt j = 0; j < widest; j++)
    for (PetscInt i = 0; i < N; i++) {
      PetscReal weighed = 0;

      for (PetscInt k = 0; k < N; k++)
        weighed += mass[i * N + k] * CanonWave(s->interface.row[k].x, s->interface.row[k].direction, size, j);
      for (PetscInt k = 0; k < n; k++) P[j * n + k] += V[k * N + i] * weighed;
    }
  CanonTurn(n, mu, P, Q);
  PetscCall(PetscArrayzero(turned, n * N));
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt k = 0; k < n; k++)
      for (PetscInt i = 0; i < N && Q[j * n + k] != 0; i++) turned[j * N + i] += V[k * N + i] * Q[j * n + k];
  PetscCall(PetscFree2(P, Q));
  PetscFunctionReturn(0);
}

/* T with n columns more, X v, of about the mass of the modes */
static PetscErrorCode InertiaExtend(Substructure s, Mat F, PetscInt n, const PetscReal mu[], PetscReal V[])
{
  const PetscInt N = s->interface.n, before = s->n;
  Mat            B, X, T = s->T, old;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; k++)
    for (PetscInt i = 0; i < N; i++) V[k * N + i] *= 2 * PETSC_PI * s->cutoff / PetscSqrtReal(mu[k]);
  PetscCall(MatCreateDense(s->comm, s->interface.n_inside, PETSC_DECIDE, PETSC_DETERMINE, n, NULL, &B));
  PetscCall(MatZeroEntries(B));
  PetscCall(BlockAddProduct(1, F, V, B));
  PetscCall(MatDuplicate(B, MAT_DO_NOT_COPY_VALUES, &X));
  PetscCall(ShiftInvertApplyBlock(&s->inside, PETSC_FALSE, B, X));
  PetscCall(TallCreate(s, s->n_modal + n));
  PetscCall(MatDenseGetSubMatrix(s->T, PETSC_DECIDE, PETSC_DECIDE, 0, before, &old));
  PetscCall(MatCopy(T, old, SAME_NONZERO_PATTERN));
  PetscCall(MatDenseRestoreSubMatrix(s->T, &old));
  PetscCall(InterfaceScatter(s, X, before, s->T));
  s->n_inertia = n;
  PetscCall(MatDestroy(&T));
  PetscCall(MatDestroy(&B));
  PetscCall(MatDestroy(&X));
  PetscFunctionReturn(0);
}

PetscErrorCode InertiaAdd(Substructure s)
{
  const PetscInt N = s->interface.n;
  PetscReal     *E, *mass, *copy, *mu, *V;
  PetscInt       n;
  Mat            F;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(N * N, &E, N * N, &mass, N * N, &copy, N, &mu));
  PetscCall(InertiaForces(s, &F, mass));
  PetscCall(InertiaEnergies(s, F, E));
  PetscCall(PetscArraycpy(copy, mass, N * N));
  PetscCall(InertiaChoose(s, E, copy, &n, mu));
  if (n) {
    PetscCall(PetscMalloc1(n * N, &V));
    PetscCall(InertiaTurn(s, n, &mu[N - n], mass, &E[(size_t)(N - n) * N], V));
    PetscCall(InertiaExtend(s, F, n, &mu[N - n], V));
    PetscCall(PetscFree(V));
  }
  PetscCall(MatDestroy(&F));
  PetscCall(PetscFree4(E, mass, copy, mu));
  PetscFunctionReturn(0);
}
