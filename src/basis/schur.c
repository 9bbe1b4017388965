/*
   Eigenvalues of a general real matrix A, and vectors of those that are asked for: what LAPACK's geev does, without the
   vectors of all others. Balanced and made quasi-triangular,

      D^-1 A D = Z T Z',   T v = theta v,   x = D Z v,        w' T = theta w',   y = D^-1 Z w,

   a vector of T is a substitution of n^2 operations (trevc), and so is its product with Z.
*/
#include "schur.h"
#include <slepcblaslapack.h>

#define LAPACKgebal_ PETSCBLAS(gebal, GEBAL)
#define LAPACKgebak_ PETSCBLAS(gebak, GEBAK)
BLAS_EXTERN void LAPACKgebal_(const char *, const PetscBLASInt *, PetscReal *, const PetscBLASInt *, PetscBLASInt *,
                              PetscBLASInt *, PetscReal *, PetscBLASInt *);
BLAS_EXTERN void LAPACKgebak_(const char *, const char *, const PetscBLASInt *, const PetscBLASInt *,
                              const PetscBLASInt *, const PetscReal *, const PetscBLASInt *, PetscReal *,
                              const PetscBLASInt *, PetscBLASInt *);

PetscErrorCode DenseSchurCreate(PetscInt n, DenseSchur *s)
{
  PetscFunctionBeginUser;
  s->n = n;
  PetscCall(PetscCalloc5(n * n, &s->T, n * n, &s->Z, n, &s->wr, n, &s->wi, n, &s->scale));
  PetscFunctionReturn(0);
}

PetscErrorCode DenseSchurDestroy(DenseSchur *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree5(s->T, s->Z, s->wr, s->wi, s->scale));
  PetscFunctionReturn(0);
}

/* T to Hessenberg form, its orthogonal matrix in Z */
static PetscErrorCode Hessenberg(DenseSchur *s, PetscBLASInt n, PetscBLASInt n_work, PetscReal work[])
{
  PetscReal   *tau;
  PetscBLASInt info;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &tau));
  PetscCallBLAS("LAPACKgehrd", LAPACKgehrd_(&n, &s->ends[0], &s->ends[1], s->T, &n, tau, work, &n_work, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK gehrd: info %d", (int)info);
  PetscCall(PetscArraycpy(s->Z, s->T, n * n));
  PetscCallBLAS("LAPACKorghr", LAPACKorghr_(&n, &s->ends[0], &s->ends[1], s->Z, &n, tau, work, &n_work, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK orghr: info %d", (int)info);
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = j + 2; i < n; i++) s->T[j * n + i] = 0;
  PetscCall(PetscFree(tau));
  PetscFunctionReturn(0);
}

PetscErrorCode DenseSchurForm(DenseSchur *s)
{
  PetscBLASInt n, n_work, info;
  PetscReal   *work;

  PetscFunctionBeginUser;
  if (!s->n) PetscFunctionReturn(0);
  PetscCall(PetscBLASIntCast(s->n, &n));
  PetscCall(PetscBLASIntCast(66 * s->n + 64, &n_work)); /* blocks of 64 columns */
  PetscCall(PetscMalloc1(n_work, &work));
  PetscCallBLAS("LAPACKgebal", LAPACKgebal_("B", &n, s->T, &n, &s->ends[0], &s->ends[1], s->scale, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK gebal: info %d", (int)info);
  PetscCall(Hessenberg(s, n, n_work, work));
  PetscCallBLAS("LAPACKhseqr", LAPACKhseqr_("S", "V", &n, &s->ends[0], &s->ends[1], s->T, &n, s->wr, s->wi, s->Z, &n,
                                            work, &n_work, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_NOT_CONVERGED, "LAPACK hseqr: info %d", (int)info);
  PetscCall(PetscFree(work));
  PetscFunctionReturn(0);
}

/* v [2][n] := D Z v, or D^-1 Z v */
static PetscErrorCode TurnBack(const DenseSchur *s, PetscBool left, PetscBLASInt n, PetscBLASInt columns, PetscReal v[],
                               PetscReal work[])
{
  const PetscReal one = 1, zero = 0;
  PetscBLASInt    info;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(work, v, columns * n));
  PetscCallBLAS("BLASgemm", BLASgemm_("N", "N", &n, &columns, &n, &one, s->Z, &n, work, &n, &zero, v, &n));
  PetscCallBLAS("LAPACKgebak",
                LAPACKgebak_("B", left ? "L" : "R", &n, &s->ends[0], &s->ends[1], s->scale, &columns, v, &n, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK gebak: info %d", (int)info);
  PetscFunctionReturn(0);
}

PetscErrorCode DenseSchurVector(const DenseSchur *s, PetscInt i, PetscBool left, PetscReal v[])
{
  const PetscBLASInt two = 2;
  PetscBLASInt       n, columns, info, *chosen;
  PetscReal         *work;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(s->n, &n));
  PetscCall(PetscArrayzero(v, 2 * s->n));
  PetscCall(PetscCalloc1(s->n, &chosen));
  PetscCall(PetscMalloc1(3 * s->n, &work));
  chosen[i] = 1;
  PetscCallBLAS("LAPACKtrevc",
                LAPACKtrevc_(left ? "L" : "R", "S", chosen, &n, s->T, &n, v, &n, v, &n, &two, &columns, work, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK trevc: info %d", (int)info);
  PetscCall(TurnBack(s, left, n, columns, v, work));
  PetscCall(PetscFree(work));
  PetscCall(PetscFree(chosen));
  PetscFunctionReturn(0);
}
