/*
   Eigenvalues of the reduced model with Maxwell branches. A part whose damping S is multiplied by E_j / (s + 1 /
   tau_j) moves in some of the modes alone, those of its own body and what contact adds: S = U V', V orthonormal, of
   rank r much below m. Its branches have r unknowns each, z_j = V' times their elongations, in one first-order system,

      eta' = rate,   rate' = -K eta - C rate - sum_j E_j U z_j,   z_j' = V' rate - z_j / tau_j.

   What is left out are m - r decays 1 / tau_j of each branch, which move nothing.
*/
#include "reduced/reducedimpl.h"
#include <petscblaslapack.h>

/* S = U V' of one part */
typedef struct {
  PetscInt   r;
  PetscReal *U, *V; /* [r][m]; V' by columns [m][m], its first r rows */
} BranchFactors;

/* Singular values below the rounding of the largest are none; S is overwritten */
static PetscErrorCode BranchFactorsCreate(PetscInt m, PetscReal S[], BranchFactors *f)
{
  PetscBLASInt n, n_work = -1, info;
  PetscReal   *s, *work, best;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(m, &n));
  PetscCall(PetscMalloc2(m * m, &f->U, m * m, &f->V));
  PetscCall(PetscMalloc1(m, &s));
  PetscCallBLAS("LAPACKgesvd", LAPACKgesvd_("S", "S", &n, &n, S, &n, s, f->U, &n, f->V, &n, &best, &n_work, &info));
  PetscCall(PetscBLASIntCast((PetscInt)best, &n_work));
  PetscCall(PetscMalloc1(n_work, &work));
  PetscCallBLAS("LAPACKgesvd", LAPACKgesvd_("S", "S", &n, &n, S, &n, s, f->U, &n, f->V, &n, work, &n_work, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK gesvd failed with %d", (int)info);
  f->r = 0;
  while (f->r < m && s[f->r] > (PetscReal)m * PETSC_MACHINE_EPSILON * s[0]) f->r++;
  for (PetscInt k = 0; k < f->r; k++)
    for (PetscInt l = 0; l < m; l++) f->U[l + m * k] *= s[k];
  PetscCall(PetscFree(work));
  PetscCall(PetscFree(s));
  PetscFunctionReturn(0);
}

/* Of n eigenvalues the 2 m that are handed out, by falling growth: what oscillates or grows, then real ones that decay,
   most of them as branches do */
static PetscErrorCode BranchesKeep(PetscInt n, const PetscReal w[], PetscInt m, PetscReal sigma[], PetscReal omega[])
{
  PetscInt kept = 0, *order;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &order));
  for (PetscInt k = 0; k < n; k++) order[k] = k;
  PetscCall(PetscSortRealWithPermutation(n, w, order));
  for (int decays = 0; decays < 2; decays++)
    for (PetscInt i = n - 1; i >= 0 && kept < 2 * m; i--) {
      const PetscInt k = order[i];

      if ((w[n + k] == 0 && w[k] <= 0) != decays) continue;
      sigma[kept]   = w[k];
      omega[kept++] = w[n + k];
    }
  PetscCall(PetscFree(order));
  PetscFunctionReturn(0);
}

/* The rows and columns of the branches of a part from `at` on in A [n][n], n columns apart; returns where they end */
static PetscInt BranchesFill(PetscInt m, const ReducedBranch *branch, const BranchFactors *f, PetscInt n, PetscInt at,
                             PetscReal A[])
{
  for (PetscInt j = 0; j < branch->n; j++, at += f->r)
    for (PetscInt k = 0; k < f->r; k++) {
      A[at + k + n * (at + k)] = -1 / branch->time[j];
      for (PetscInt l = 0; l < m; l++) {
        A[at + k + n * (m + l)] = f->V[k + m * l];
        A[m + l + n * (at + k)] = -branch->stiff[j] * f->U[l + m * k];
      }
    }
  return at;
}

PetscErrorCode ReducedBranchesEigen(const ReducedModel *model, PetscReal *const system[], PetscReal sigma[],
                                    PetscReal omega[])
{
  const PetscInt m  = model->m;
  PetscInt       at = 2 * m, n = 2 * m;
  PetscReal     *A, *w;
  BranchFactors *f;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(model->n_branches, &f));
  for (PetscInt i = 0; i < model->n_branches; i++) {
    PetscCall(BranchFactorsCreate(m, system[2 + i], &f[i]));
    n += f[i].r * model->branch[i].n;
  }
  PetscCall(PetscCalloc2(n * n, &A, 2 * n, &w));
  for (PetscInt k = 0; k < m; k++) A[k + n * (m + k)] = 1;
  for (PetscInt k = 0; k < 2 * m; k++)
    for (PetscInt l = 0; l < m; l++) A[m + l + n * k] = -system[k / m][l + m * (k % m)];
  for (PetscInt i = 0; i < model->n_branches; i++) at = BranchesFill(m, &model->branch[i], &f[i], n, at, A);
  PetscCall(DenseEigen(n, A, w, w + n, NULL, NULL));
  PetscCall(BranchesKeep(n, w, m, sigma, omega));
  PetscCall(PetscFree2(A, w));
  for (PetscInt i = 0; i < model->n_branches; i++) PetscCall(PetscFree2(f[i].U, f[i].V));
  PetscCall(PetscFree(f));
  PetscFunctionReturn(0);
}
