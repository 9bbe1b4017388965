/*
   Unit test of sweep/basis/store: points that are solved once and asked for again, while vectors are added that tell the
   error, and after the model has taken them in. Reference: solutions without a store.
*/
#include <petscsys.h>
#include "check.h"
#include "densesystem.h"
#include "petscmain.h"
#include "sweep/basis/points.h"

#define N_ALL    40
#define N_USED   20
#define N_POINTS 3

static const ReducedWindow everything = {0, 1e3, 1e3, 0};

/* K of kappa = 1, 4, 9, ... with random couplings, and p0 times an unsymmetric part */
static PetscErrorCode SystemMake(System *s)
{
  const PetscInt     n    = N_ALL;
  unsigned long long seed = 7;
  PetscReal         *K, *M, *H;

  PetscFunctionBeginUser;
  SystemCreate(n, N_USED, 1, s);
  PetscCall(PetscCalloc3(n * n, &K, n * n, &M, n * n, &H));
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt j = 0; j <= i; j++) {
      K[i * n + j] = K[j * n + i] = (i == j ? (i + 1) * (i + 1) : 0) + 0.1 * NextNumber(&seed);
      M[i * n + j]                = i == j ? 1 : 0;
      H[i * n + j]                = 0.1 * NextNumber(&seed);
      H[j * n + i]                = 0.1 * NextNumber(&seed);
    }
  SystemAdd(s, OPERATORS_STIFFNESS, PETSC_TRUE, -1, K);
  SystemAdd(s, OPERATORS_MASS, PETSC_TRUE, -1, M);
  SystemAdd(s, OPERATORS_STIFFNESS, PETSC_FALSE, 0, H);
  PetscCall(PetscFree3(K, M, H));
  PetscFunctionReturn(0);
}

/* Largest difference of eigenvalues and of errors from those without a store, over all points */
static PetscErrorCode Compare(PointStore *store, const Reduced *reduced, PetscReal *values, PetscReal *errors)
{
  PetscFunctionBeginUser;
  *values = *errors = 0;
  for (PetscInt k = 0; k < N_POINTS; k++) {
    const PetscReal p[1] = {0.3 * (PetscReal)k};
    ReducedModes    kept, alone;

    PetscCall(PointStoreSolve(store, reduced, &everything, p, &kept));
    PetscCall(PointStoreSolve(NULL, reduced, &everything, p, &alone));
    for (PetscInt i = 0; i < alone.n; i++) {
      *values = PetscMax(*values, i < kept.n ? cabs(kept.lambda[i] - alone.lambda[i]) : PETSC_MAX_REAL);
      *errors = PetscMax(*errors, i < kept.n ? fabs(kept.error[i] - alone.error[i]) : PETSC_MAX_REAL);
    }
    PetscCall(ReducedModesDestroy(&kept));
    PetscCall(ReducedModesDestroy(&alone));
  }
  PetscFunctionReturn(0);
}

/* The leading n unknowns of a system */
static void SystemLeading(const System *all, PetscInt n, PetscInt n_used, System *s)
{
  *s                = *all;
  s->reduced.n      = n;
  s->reduced.n_used = n_used;
  s->reduced.term   = s->term;
  s->reduced.A      = s->pointer;
  for (PetscInt t = 0; t < s->reduced.n_terms; t++) {
    s->pointer[t] = s->A[t];
    for (PetscInt j = 0; j < n; j++)
      for (PetscInt i = 0; i < n; i++) s->A[t][j * n + i] = all->A[t][j * all->reduced.n + i];
  }
}

/* Breaks when: errors stay those of before when vectors that tell them are added, or solutions when the model grows */
static PetscErrorCode TestStore(int *failed)
{
  static const struct {
    const char *what;
    PetscInt    n, n_used;
  } step[5] = {
    {"first",                     30,    N_USED    },
    {"more vectors beside it",    N_ALL, N_USED    },
    {"again",                     N_ALL, N_USED    },
    {"after the model has grown", N_ALL, N_USED + 5},
    {"with nothing left out",     N_ALL, N_ALL     }
  };
  PointStore   store = {0};
  PetscReal    values, errors, size[5];
  ReducedModes modes;
  System      *all, *s;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&all));
  PetscCall(PetscNew(&s));
  PetscCall(SystemMake(all));
  for (int i = 0; i < 5; i++) {
    printf("     %s\n", step[i].what);
    SystemLeading(all, step[i].n, step[i].n_used, s);
    PetscCall(Compare(&store, &s->reduced, &values, &errors));
    *failed += CheckClose("eigenvalues", values, 0, 0);
    *failed += CheckClose("errors", errors, 0, 0);
    *failed += CheckTrue("points that are kept", store.n == N_POINTS, (double)store.n);
    PetscCall(PointStoreSolve(&store, &s->reduced, &everything, (const PetscReal[]){0.3}, &modes));
    size[i] = modes.error[0];
    PetscCall(ReducedModesDestroy(&modes));
  }
  *failed += CheckTrue("more vectors tell a larger error", size[1] > size[0], size[1] / size[0]);
  *failed += CheckTrue("a larger model has a smaller one", size[3] < size[2], size[3] / size[2]);
  PetscCall(PointStoreDestroy(&store));
  PetscCall(PetscFree(all));
  PetscCall(PetscFree(s));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  (void)size;
  PetscCall(TestStore(failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
