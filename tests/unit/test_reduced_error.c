/*
   Unit test of sweep/estimate and sensitivity on systems of up to 60 unknowns made of reproducible random
   numbers. The model is the leading block, what it leaves out couples to it weakly, so that the model's eigenvalues are
   off by a known amount: the solution with all unknowns is the truth.
*/
#include <petscsys.h>
#include "check.h"
#include "densesystem.h"
#include "petscmain.h"

#define MOST_OVER 300 /* floor over the error of one problem, which chance makes small: 21 to 144 by processor */

#define N_ALL  50
#define N_USED 30
#define DIVERGES 2500 /* of which the real eigenvalue, 50, is the largest of the window */
#define BESIDE 1e-4 /* motion of other vectors in the stiff spring, beside that of those it joins */

static const ReducedWindow wide = {0, 1e3, 1e3, 0};

/* K of kappa = 1, 4, 9, ... with random couplings: strong (1) inside the model, and inside the rest, weak between them,
   symmetric or not; M near the identity; p0 times the unsymmetric part, C = p1 times random. A stiff spring, if any, joins
   the last vector of the model and the last one of the rest, and holds the others a little. Negative stiffness, if any, makes the
first vector of the model diverge */
static PetscErrorCode SystemRandom(PetscReal weak, PetscReal spring, PetscReal negative, unsigned long long seed, System *s)
{
  const PetscInt n = N_ALL;
  PetscReal     *K, *M, *H, *C, b[N_ALL];

  PetscFunctionBeginUser;
  SystemCreate(n, N_USED, 2, s);
  PetscCall(PetscCalloc4(n * n, &K, n * n, &M, n * n, &H, n * n, &C));
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt j = 0; j <= i; j++) {
      const PetscReal size = (i < N_USED) == (j < N_USED) ? 1 : weak;

      K[i * n + j] = K[j * n + i] = (i == j ? (i + 1) * (i + 1) : 0) + size * NextNumber(&seed);
      M[i * n + j] = M[j * n + i] = (i == j ? 1 : 0) + 0.01 * size * NextNumber(&seed);
      C[i * n + j] = C[j * n + i] = (i == j ? 2 : 0) + size * NextNumber(&seed);
      H[i * n + j]                = size * NextNumber(&seed);
      H[j * n + i]                = size * NextNumber(&seed);
    }
  K[0] -= negative;
  for (PetscInt i = 0; i < n; i++) b[i] = i == N_USED - 1 || i == n - 1 ? 1 : BESIDE * NextNumber(&seed);
  for (PetscInt i = 0; i < n && spring > 0; i++)
    for (PetscInt j = 0; j < n; j++) K[i * n + j] += spring * b[i] * b[j];
  SystemAdd(s, OPERATORS_STIFFNESS, PETSC_TRUE, -1, K);
  SystemAdd(s, OPERATORS_MASS, PETSC_TRUE, -1, M);
  SystemAdd(s, OPERATORS_STIFFNESS, PETSC_FALSE, 0, H);
  SystemAdd(s, OPERATORS_DAMPING, PETSC_TRUE, 1, C);
  PetscCall(PetscFree4(K, M, H, C));
  PetscFunctionReturn(0);
}

/* Breaks when: a sign, factor, transposition or block of the estimate is wrong. Reference: the system with all
   unknowns; the estimate is of leading order, so the quotient is one up to terms of the size of the coupling. With a
   stiff spring it breaks when what a stiff vector of the model and the rest do to each other is left out: the first order of
   the rest alone is then up to hundreds of times too small */
static PetscErrorCode TestRandom(PetscReal weak, PetscReal spring, PetscReal negative, PetscReal tolerance, int *failed)
{
  const PetscReal points[][2] = {
    {0,   0   },
    {0.8, 0   },
    {0.8, 0.05}
  };

  PetscFunctionBeginUser;
  for (int k = 0; k < 3; k++) {
    PetscReal    low = INFINITY, high = 0, least = INFINITY, most = 0, product;
    PetscInt     n_compared = 0, below = 0;
    System       s;
    ReducedModes m, truth;

    PetscCall(SystemRandom(weak, spring, negative, 20u + (unsigned)k, &s));
    PetscCall(SolveBoth(&s, points[k], &wide, &m, &truth));
    for (PetscInt i = 0; i < m.n; i++) {
      const PetscReal error = Nearest(&truth, m.lambda[i]), ratio = m.sharp[i] / error;

      if (m.error[i] < m.sharp[i]) below++;
      if (error < 1e-9) continue; /* rounding: no error of the model to speak of */
      n_compared++;
      low = PetscMin(low, ratio), high = PetscMax(high, ratio);
      least = PetscMin(least, error), most = PetscMax(most, error);
    }
    PetscCall(LargestProduct(&s, points[k], &m, &product));
    printf("     mu %g, damping %g, errors %.1e .. %.1e\n", points[k][0], points[k][1], least, most);
    *failed += CheckTrue("modes compared", n_compared > 15, (double)n_compared);
    *failed += CheckClose("least estimate / error", low, 1, tolerance);
    *failed += CheckClose("largest estimate / error", high, 1, tolerance);
    *failed += CheckTrue("what is stated is no less", below == 0, below);
    *failed += CheckClose("biorthogonality", product, 0, 1e-10);
    PetscCall(ReducedModesDestroy(&m));
    PetscCall(ReducedModesDestroy(&truth));
  }
  PetscFunctionReturn(0);
}

/* Breaks when: the floor of the estimate is below what rounding in K does, or far above it. Reference: by construction
   kappa = 1e7 ... 1e17, hidden by a reflection, formed with a 64-bit mantissa; one more unknown that nothing couples
   to */
static PetscErrorCode TestFloor(int *failed)
{
  enum { n = 30 };
  unsigned long long  seed                 = 3;
  const ReducedWindow window               = {0, 1e6, 1e6, 0};
  PetscReal           K[(n + 1) * (n + 1)] = {0}, M[(n + 1) * (n + 1)] = {0}, v[n], error = 0, estimate = 0;
  long double         vv = 0, vKv = 0;
  System              s;
  ReducedModes        m;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) v[i] = NextNumber(&seed), vv += v[i] * v[i];
  for (PetscInt i = 0; i < n; i++) vKv += v[i] * v[i] * (long double)pow(10, 7 + i / 3.0);
  for (PetscInt i = 0; i <= n; i++) {
    M[i * (n + 2)] = 1;
    for (PetscInt j = 0; j < n && i < n; j++) {
      const long double a = pow(10, 7 + i / 3.0), b = pow(10, 7 + j / 3.0), c = 2 * v[i] * v[j] / vv;

      K[i * (n + 1) + j] = (PetscReal)((i == j ? a : 0) - c * (a + b) + 2 * c * vKv / vv);
    }
  }
  K[(n + 1) * (n + 1) - 1] = 1e20;
  SystemCreate(n + 1, n, 0, &s);
  SystemAdd(&s, OPERATORS_STIFFNESS, PETSC_FALSE, -1, K);
  SystemAdd(&s, OPERATORS_MASS, PETSC_TRUE, -1, M);
  PetscCall(ReducedSolve(&s.reduced, NULL, &window, &m));
  PetscCall(ReducedEstimate(&s.reduced, NULL, &m));
  for (PetscInt i = 0; i < 6; i++) {
    error    = PetscMax(error, cabs(m.lambda[i] - CMPLX(0, sqrt(pow(10, 7 + i / 3.0)))));
    estimate = PetscMax(estimate, m.error[i]);
  }
  *failed += CheckTrue("floor / rounding error, spread 1e10", estimate > error && estimate < MOST_OVER * error,
                       estimate / error);
  PetscCall(ReducedModesDestroy(&m));
  PetscFunctionReturn(0);
}

/* Breaks when: n_z = 0 is not left alone, or a rigid mode gets an error from nowhere. Reference: two equal masses
   joined by a spring of 1, K x = 0 for (1, 1) exactly */
static PetscErrorCode TestNothingLeftOut(int *failed)
{
  const PetscReal K[] = {1, -1, 0, -1, 1, 0, 0, 0, 50}, M[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  System          s;
  ReducedModes    m, truth;

  PetscFunctionBeginUser;
  SystemCreate(3, 2, 0, &s);
  SystemAdd(&s, OPERATORS_STIFFNESS, PETSC_TRUE, -1, K);
  SystemAdd(&s, OPERATORS_MASS, PETSC_TRUE, -1, M);
  PetscCall(SolveBoth(&s, NULL, &wide, &m, &truth));
  PetscCall(ReducedEstimate(&s.reduced, NULL, &m));
  *failed += CheckTrue("rigid", m.rigid[0], (double)m.n);
  *failed += CheckClose("error of the rigid mode", m.error[0], 0, 1e-7);
  *failed += CheckTrue("floor of the elastic one", m.error[1] > 1e-17 && m.error[1] < 1e-14, m.error[1]);
  s.reduced.n_used = 3;
  PetscCall(ReducedEstimate(&s.reduced, NULL, &truth));
  for (PetscInt i = 0; i < 3; i++)
    *failed += CheckClose("nothing left out: rounding only", truth.error[i] - truth.noise[i], 0, 0);
  PetscCall(ReducedModesDestroy(&m));
  PetscCall(ReducedModesDestroy(&truth));
  PetscFunctionReturn(0);
}

/* Breaks when: a term, its power of lambda or its parameter is missed. Reference: central differences, error step^2 */
static PetscErrorCode TestSensitivity(PetscReal damping, int *failed)
{
  const PetscReal step = 1e-5;
  PetscReal       p[] = {0.8, damping}, worst = 0;
  System          s;
  ReducedModes    m, below, above;

  PetscFunctionBeginUser;
  PetscCall(SystemRandom(1, 0, 0, 31, &s));
  s.term[1].n               = 1; /* M / p0: a reciprocal */
  s.term[1].factor[0].power = -1;
  PetscCall(ReducedSolve(&s.reduced, p, &wide, &m));
  for (PetscInt j = 0; j < (damping > 0 ? 2 : 1); j++) {
    const PetscReal old = p[j];

    p[j] = old - step;
    PetscCall(ReducedSolve(&s.reduced, p, &wide, &below));
    p[j] = old + step;
    PetscCall(ReducedSolve(&s.reduced, p, &wide, &above));
    p[j] = old;
    for (PetscInt i = 0; i < m.n; i++) {
      PetscComplex       derivative[2];
      const PetscComplex difference = (above.lambda[i] - below.lambda[i]) / (2 * step);

      PetscCall(ReducedSensitivity(&s.reduced, p, &m, i, derivative));
      worst = PetscMax(worst, cabs(derivative[j] - difference) / (1 + cabs(difference)));
    }
    PetscCall(ReducedModesDestroy(&below));
    PetscCall(ReducedModesDestroy(&above));
  }
  *failed += CheckTrue("sensitivities: modes", m.n >= N_USED, (double)m.n);
  *failed += CheckClose("sensitivities beside differences", worst, 0, 1e-6);
  PetscCall(ReducedModesDestroy(&m));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  (void)size;
  PetscCall(TestRandom(1e-2, 0, 0, 0.001, failed));
  PetscCall(TestRandom(0, 1e7, 0, 0.01, failed));
  PetscCall(TestRandom(0, 1e7, DIVERGES, 0.01, failed));
  PetscCall(TestFloor(failed));
  PetscCall(TestNothingLeftOut(failed));
  PetscCall(TestSensitivity(0, failed));
  PetscCall(TestSensitivity(0.05, failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
