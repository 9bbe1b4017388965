/*
   Unit test of sweep/dense/condense: eigenvalues sought on a core of the vectors, with what the others do taken in.
   Reference: all eigenvalues of the whole problem by LAPACK.
*/
#include <petscsys.h>
#include "check.h"
#include "densesystem.h"
#include "petscmain.h"

#define N    40
#define CORE 14

static const ReducedWindow window = {0.5, 8.5, 2, 0};

/* kappa = 1, 4, 9, ... , the leading CORE vectors coupled to the others in K, M and, damped, in C; friction p0 u v' */
static PetscErrorCode SystemCoupled(PetscBool damped, System *s)
{
  unsigned long long seed = 7;
  PetscReal          u[N], v[N], *K, *M, *C, *H;

  PetscFunctionBeginUser;
  SystemCreate(N, N, 1, s);
  PetscCall(PetscCalloc4(N * N, &K, N * N, &M, N * N, &C, N * N, &H));
  for (PetscInt i = 0; i < N; i++) u[i] = NextNumber(&seed), v[i] = NextNumber(&seed);
  for (PetscInt i = 0; i < N; i++)
    for (PetscInt j = 0; j <= i; j++) {
      const PetscReal small = i == j ? 0 : NextNumber(&seed);

      K[i * N + j] = K[j * N + i] = i == j ? (i + 1) * (i + 1) : 4 * small;
      M[i * N + j] = M[j * N + i] = i == j ? 1 : 0.02 * small;
      C[i * N + j] = C[j * N + i] = i == j ? 0.01 * (i + 1) : 0.01 * small;
    }
  for (PetscInt i = 0; i < N; i++)
    for (PetscInt j = 0; j < N; j++) H[i * N + j] = u[i] * v[j];
  SystemAdd(s, OPERATORS_STIFFNESS, PETSC_TRUE, -1, K);
  SystemAdd(s, OPERATORS_STIFFNESS, PETSC_FALSE, 0, H);
  SystemAdd(s, OPERATORS_MASS, PETSC_TRUE, -1, M);
  if (damped) SystemAdd(s, OPERATORS_DAMPING, PETSC_TRUE, -1, C);
  PetscCall(PetscFree4(K, M, C, H));
  PetscFunctionReturn(0);
}

/* |Q(lambda) x| and |y' Q(lambda)| over |lambda|^2 of mode i: vectors belong to their eigenvalues */
static PetscErrorCode LargestResidual(const System *s, const PetscReal p[], const ReducedModes *m, PetscReal *largest)
{
  DensePencil  pencil;
  PetscComplex Q[N * N];

  PetscFunctionBeginUser;
  PetscCall(ReducedPencil(&s->reduced, p, N, &pencil));
  *largest = 0;
  for (PetscInt a = 0; a < m->n; a++) {
    DensePencilEvaluate(&pencil, m->lambda[a], 0, N, Q);
    for (PetscInt i = 0; i < N; i++) {
      PetscComplex right = 0, left = 0;

      for (PetscInt j = 0; j < N; j++) {
        right += Q[j * N + i] * m->x[a * N + j];
        left += Q[i * N + j] * m->y[a * N + j];
      }
      *largest = PetscMax(*largest, PetscMax(cabs(right), cabs(left)) / PetscSqr(cabs(m->lambda[a])));
    }
  }
  PetscCall(DensePencilDestroy(&pencil));
  PetscFunctionReturn(0);
}

/* Whether the core is good enough at p */
static PetscErrorCode CoreHolds(const Reduced *reduced, const PetscReal p[], const ReducedWindow *w, PetscBool *holds)
{
  DensePencil  pencil;
  ReducedModes modes;

  PetscFunctionBeginUser;
  PetscCall(ReducedPencil(reduced, p, reduced->n_used, &pencil));
  PetscCall(CondensedEigen(&pencil, NULL, &reduced->core, w, &modes, holds));
  if (*holds) PetscCall(ReducedModesDestroy(&modes));
  PetscCall(DensePencilDestroy(&pencil));
  PetscFunctionReturn(0);
}

/* Breaks when: couplings are dropped or have a wrong sign, left and right are confused, or the change
   that a mode is judged by is not its error: of the least tolerance that is kept, halved from 1, the true error of the
   worst mode is 0.2 to 1.2 */
static PetscErrorCode TestCore(PetscBool damped, int *failed)
{
  const PetscReal p[] = {30};
  System          s;
  ReducedModes    m = {0}, truth;
  PetscReal       error = 0, residual, kept = 0;
  PetscBool       holds = PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(SystemCoupled(damped, &s));
  PetscCall(ReducedSolve(&s.reduced, p, &window, &truth));
  for (PetscReal rtol = 1; rtol > 1e-14 && holds; rtol /= 2) {
    s.reduced.core = (ReducedCore){CORE, rtol};
    PetscCall(CoreHolds(&s.reduced, p, &window, &holds));
    if (holds) kept = rtol;
  }
  s.reduced.core.rtol = kept;
  PetscCall(ReducedSolve(&s.reduced, p, &window, &m));
  for (PetscInt i = 0; i < truth.n; i++) error = PetscMax(error, Nearest(&m, truth.lambda[i]) / cabs(truth.lambda[i]));
  PetscCall(LargestResidual(&s, p, &m, &residual));
  printf("     %s, %d modes of %d: tolerance %.1e, error %.1e, residual %.1e\n", damped ? "damped" : "undamped", (int)m.n,
         (int)truth.n, kept, error, residual);
  *failed += CheckTrue("as many modes as the whole problem", m.n == truth.n && truth.n > 5, m.n);
  *failed += CheckTrue("the core does not hold without end", !holds && kept < 1e-2, kept);
  *failed += CheckTrue("true error is what it is judged by", error < 1.2 * kept && error > 0.2 * kept, error);
  *failed += CheckTrue("vectors", residual < 0.3 && residual > 0, residual);
  PetscCall(ReducedModesDestroy(&m));
  PetscCall(ReducedModesDestroy(&truth));
  PetscFunctionReturn(0);
}

/* Breaks when: a mode that the vectors beyond the core have alone, and nothing couples to it, is lost; or one beside a
   mode of the core at 9, with which friction +-0.02 makes a pair that grows. kappa = 1, 4, 9, ... 36 in the core;
   `others`, 400 and 900 beyond it. Far from the window, at 200, the core is to hold. */
static PetscErrorCode TestOthers(PetscReal others, PetscReal friction, PetscReal damping, PetscBool expected,
                                 int *failed)
{
  const PetscReal kappa[9] = {1, 4, 9, 16, 25, 36, others, 400, 900};
  PetscReal       K[81] = {0}, M[81] = {0}, C[81] = {0}, H[81] = {0};
  System          s;
  PetscBool       holds;

  PetscFunctionBeginUser;
  SystemCreate(9, 9, 1, &s);
  for (int i = 0; i < 9; i++) K[10 * i] = kappa[i], M[10 * i] = 1, C[10 * i] = damping;
  H[2 * 9 + 6] = friction, H[6 * 9 + 2] = -friction;
  SystemAdd(&s, OPERATORS_STIFFNESS, PETSC_TRUE, -1, K);
  SystemAdd(&s, OPERATORS_STIFFNESS, PETSC_FALSE, 0, H);
  SystemAdd(&s, OPERATORS_MASS, PETSC_TRUE, -1, M);
  if (damping > 0) SystemAdd(&s, OPERATORS_DAMPING, PETSC_TRUE, -1, C);
  s.reduced.core = (ReducedCore){6, 1e-3};
  PetscCall(CoreHolds(&s.reduced, (PetscReal[]){1}, &window, &holds));
  printf("     %g beyond the core, friction %g, damping %g\n", others, friction, damping);
  *failed += CheckTrue("the core holds, or does not", holds == expected, holds);
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  (void)size;
  for (int damped = 0; damped < 2; damped++) {
    PetscCall(TestOthers(6.25, 0, 0.01 * damped, PETSC_FALSE, failed));
    PetscCall(TestOthers(9.02, 0.02, 0.01 * damped, PETSC_FALSE, failed));
    PetscCall(TestOthers(200, 0.02, 0.01 * damped, PETSC_TRUE, failed));
  }
  PetscCall(TestCore(PETSC_FALSE, failed));
  PetscCall(TestCore(PETSC_TRUE, failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
