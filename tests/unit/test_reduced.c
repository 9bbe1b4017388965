/*
   Unit test of sweep/reduced and eigen: systems of two to six unknowns whose eigenvalues are known in closed form,
   where dense eigensolvers are usually wrong: defective and double eigenvalues, zeros, real ones, spectra spread by
   1e14.
*/
#include <petscsys.h>
#include "check.h"
#include "densesystem.h"
#include "petscmain.h"

#define NEAR_EPS 1e-12

static const ReducedWindow all = {0, 10, 10, 0};

/* Breaks when: lambda = sqrt(-kappa) loses a member or digits, or the order of a pair changes. Reference: closed form
   in densesystem.h with a = d = 2, b = 1, c = 4/3, mu_c = 0.75 */
static PetscErrorCode TestFlutter(int *failed)
{
  const PetscReal    half = PetscSqrtReal(1.0 / 3), critical = 0.75, values[] = {0.5, 1};
  const PetscComplex locked = csqrt(-CMPLX(2, half));
  System             s;
  ReducedModes       m;

  PetscFunctionBeginUser;
  SystemTwo(2, 1, 4.0 / 3, 2, NULL, &s);
  PetscCall(ReducedSolve(&s.reduced, &values[0], &all, &m));
  *failed += CheckClose("mu 0.5: modes", (double)m.n, 2, 0);
  *failed += CheckClose("mu 0.5: lower frequency", cimag(m.lambda[0]), sqrt(2 - half), NEAR_EPS);
  *failed += CheckClose("mu 0.5: upper frequency", cimag(m.lambda[1]), sqrt(2 + half), NEAR_EPS);
  *failed += CheckClose("mu 0.5: growth exactly zero", fabs(creal(m.lambda[0])) + fabs(creal(m.lambda[1])), 0, 0);
  PetscCall(ReducedModesDestroy(&m));
  PetscCall(ReducedSolve(&s.reduced, &values[1], &all, &m));
  *failed += CheckClose("mu 1: stable member first", creal(m.lambda[0]), -fabs(creal(locked)), NEAR_EPS);
  *failed += CheckClose("mu 1: growth", creal(m.lambda[1]), 0.202071768768, NEAR_EPS);
  *failed += CheckClose("mu 1: frequency", cimag(m.lambda[1]), fabs(cimag(locked)), NEAR_EPS);
  *failed += CheckClose("mu 1: equal frequencies", cimag(m.lambda[0]), cimag(m.lambda[1]), NEAR_EPS);
  PetscCall(ReducedModesDestroy(&m));
  PetscCall(ReducedSolve(&s.reduced, &critical, &all, &m));
  *failed += CheckClose("mu 0.75, defective: modes", (double)m.n, 2, 0);
  for (PetscInt i = 0; i < m.n; i++) {
    *failed += CheckClose("mu 0.75: lambda = i sqrt(2)", cabs(m.lambda[i] - CMPLX(0, sqrt(2))), 0, NEAR_EPS);
    *failed += CheckClose("mu 0.75: y'Dx", cabs(m.product[i]), 0, 1e-7);
  }
  PetscCall(ReducedModesDestroy(&m));
  PetscFunctionReturn(0);
}

/* Breaks when: the damped problem loses digits, or picks the wrong one of a conjugate pair. Reference: Hurwitz's
   condition a1 a2 a3 = a3^2 + a1^2 a4 for lambda^4 + a1 lambda^3 + ..., and values of PHYSICS.md that it must
   reproduce */
static PetscErrorCode TestUnevenDamping(int *failed)
{
  const PetscReal table[][3] = {
    {0.02, 0.02, 0.78066     },
    {0.02, 0.04, 0.7779466667},
    {0.04, 0.02, 0.7780266667},
    {0.02, 0.2,  0.7660264463},
    {0.2,  0.02, 0.7670082645}
  };
  const PetscReal a = 2, d = 2.4, b = 1, c = 4.0 / 3;

  PetscFunctionBeginUser;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(table); k++) {
    const PetscReal d1 = table[k][0], d2 = table[k][1], a1 = d1 + d2, a2 = a + d + d1 * d2, a3 = a * d2 + d * d1;
    const PetscReal mu      = (a3 * (a1 * a2 - a3) / (a1 * a1) - a * d + b * b) / (b * c);
    PetscReal       largest = -1, product;
    System          s;
    ReducedModes    m;

    SystemTwo(a, b, c, d, (PetscReal[]){d1, d2}, &s);
    PetscCall(ReducedSolve(&s.reduced, &mu, &all, &m));
    for (PetscInt i = 0; i < m.n; i++) largest = PetscMax(largest, creal(m.lambda[i]));
    PetscCall(LargestProduct(&s, &mu, &m, &product));
    *failed += CheckClose("critical mu", mu, table[k][2], 1e-10);
    *failed += CheckClose("modes", (double)m.n, 2, 0);
    *failed += CheckClose("growth at the critical mu", largest, 0, NEAR_EPS);
    *failed += CheckClose("biorthogonality", product, 0, 1e-11);
    PetscCall(ReducedModesDestroy(&m));
  }
  PetscFunctionReturn(0);
}

/* Breaks when: a negative kappa is dropped, listed twice, or listed in a window that does not begin at zero. Reference:
   closed form, a = d = 2, b = 1, c = 4/3, mu = -3: kappa = 2 -+ sqrt(5) */
static PetscErrorCode TestDivergence(int *failed)
{
  const ReducedWindow above = {0.1, 10, 10, 0};
  const PetscReal     mu    = -3;
  System              s;
  ReducedModes        m;

  PetscFunctionBeginUser;
  SystemTwo(2, 1, 4.0 / 3, 2, NULL, &s);
  PetscCall(ReducedSolve(&s.reduced, &mu, &all, &m));
  *failed += CheckClose("divergence: modes", (double)m.n, 2, 0);
  *failed += CheckClose("divergence: growth", creal(m.lambda[0]), sqrt(sqrt(5) - 2), NEAR_EPS);
  *failed += CheckClose("divergence: no frequency", cimag(m.lambda[0]), 0, 0);
  PetscCall(ReducedModesDestroy(&m));
  PetscCall(ReducedSolve(&s.reduced, &mu, &above, &m));
  *failed += CheckClose("divergence: not above zero", (double)m.n, 1, 0);
  PetscCall(ReducedModesDestroy(&m));
  PetscFunctionReturn(0);
}

/* Two pairs of bodies of masses 1 and 2, joined by springs of 3 and 12; friction p0, damping p1 M + p2 K.
   kappa = 0, 0, 4.5, 18; eigenvalues of the damped ones from lambda^2 + (p1 + p2 kappa) lambda + kappa = 0 */
static PetscErrorCode SystemFree(System *s)
{
  const PetscReal K[] = {3, -3, 0, 0, -3, 3, 0, 0, 0, 0, 12, -12, 0, 0, -12, 12};
  const PetscReal M[] = {1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2};
  const PetscReal H[] = {0, 0, 1, -1, 0, 0, -1, 1, 0, 0, 0, 0, 0, 0, 0, 0};

  PetscFunctionBeginUser;
  SystemCreate(4, 4, 3, s);
  SystemAdd(s, OPERATORS_STIFFNESS, PETSC_TRUE, -1, K);
  SystemAdd(s, OPERATORS_MASS, PETSC_TRUE, -1, M);
  SystemAdd(s, OPERATORS_STIFFNESS, PETSC_FALSE, 0, H);
  SystemAdd(s, OPERATORS_DAMPING, PETSC_TRUE, 1, M);
  SystemAdd(s, OPERATORS_DAMPING, PETSC_TRUE, 2, K);
  PetscFunctionReturn(0);
}

/* Breaks when: a zero comes out as a small number, a double zero is listed twice, or -alpha of a rigid body is lost.
   Reference: closed form above; friction leaves kappa as it is, since it acts one way only */
static PetscErrorCode TestRigid(int *failed)
{
  const PetscReal points[][3] = {
    {0,   0,   0    },
    {0.7, 0,   0    },
    {0.7, 0,   0.01 },
    {0.2, 0,   0.1  },
    {0.3, 0,   0.03 },
    {1.1, 0,   0.003},
    {0.7, 0.1, 0    }
  };
  System s;

  PetscFunctionBeginUser;
  PetscCall(SystemFree(&s));
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(points); k++) {
    const PetscReal *p = points[k], c = p[1] + 4.5 * p[2];
    PetscInt         rigid = 0;
    ReducedModes     m;

    PetscCall(ReducedSolve(&s.reduced, p, &all, &m));
    for (PetscInt i = 0; i < m.n; i++) rigid += m.rigid[i] && m.lambda[i] == 0;
    *failed += CheckClose("free bodies: modes", (double)m.n, p[1] > 0 ? 6 : 4, 0);
    *failed += CheckClose("free bodies: rigid ones", (double)rigid, 2, 0);
    *failed += CheckClose("free bodies: first elastic", cimag(m.lambda[m.n - 2]), sqrt(4.5 - c * c / 4), NEAR_EPS);
    *failed += CheckClose("free bodies: its growth", creal(m.lambda[m.n - 2]), -c / 2, NEAR_EPS);
    if (p[1] > 0) *failed += CheckClose("free bodies: -alpha", creal(m.lambda[0]), -p[1], NEAR_EPS);
    if (p[1] + p[2] == 0)
      *failed += CheckTrue("free bodies: condition", cabs(m.product[0] * m.product[1]) > 0.5, cabs(m.product[0]));
    PetscCall(ReducedModesDestroy(&m));
  }
  PetscFunctionReturn(0);
}

/* T A T^-1 with T = I + 2 u v', u'v = 0, so that T^-1 = I - 2 u v'; n <= 6, in place, row by row */
static void Transform(PetscInt n, PetscReal A[])
{
  const PetscReal u[] = {0.5, -0.3, 0.2, 0.4, -0.1, 0.3}, w[] = {0.2, 0.6, -0.4, 0.1, 0.3, 0.5};
  PetscReal       v[6], uw = 0, uu = 0, row[6], column[6], vAu = 0;

  for (PetscInt i = 0; i < n; i++) uw += u[i] * w[i], uu += u[i] * u[i];
  for (PetscInt i = 0; i < n; i++) v[i] = w[i] - u[i] * uw / uu;
  for (PetscInt i = 0; i < n; i++) {
    row[i] = column[i] = 0;
    for (PetscInt k = 0; k < n; k++) row[i] += v[k] * A[k * n + i], column[i] += A[i * n + k] * u[k];
  }
  for (PetscInt i = 0; i < n; i++) vAu += v[i] * column[i];
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt j = 0; j < n; j++) A[i * n + j] += 2 * u[i] * row[j] - 2 * column[i] * v[j] - 4 * u[i] * vAu * v[j];
}

/* An unsymmetric K with M = I */
static PetscErrorCode SystemGeneral(PetscInt n, const PetscReal K[], System *s)
{
  PetscReal M[36] = {0};

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) M[i * (n + 1)] = 1;
  SystemCreate(n, n, 0, s);
  SystemAdd(s, OPERATORS_STIFFNESS, PETSC_FALSE, -1, K);
  SystemAdd(s, OPERATORS_MASS, PETSC_TRUE, -1, M);
  PetscFunctionReturn(0);
}

/* Breaks when: a member of a triple defective eigenvalue gets lost or is not finite. Reference: by construction kappa
   = 4 three times in one Jordan block, computed to the third root of rounding, about 1e-5 */
static PetscErrorCode TestTriple(int *failed)
{
  PetscReal    K[] = {4, 1, 0, 0, 0, 4, 1, 0, 0, 0, 4, 0, 0, 0, 0, 25}, sum = 0;
  System       s;
  ReducedModes m;

  PetscFunctionBeginUser;
  Transform(4, K);
  PetscCall(SystemGeneral(4, K, &s));
  PetscCall(ReducedSolve(&s.reduced, NULL, &all, &m));
  *failed += CheckClose("three modes meet: modes", (double)m.n, 4, 0);
  for (PetscInt i = 0; i < 3; i++)
    *failed += CheckClose("three modes meet: lambda = 2 i", cabs(m.lambda[i] - CMPLX(0, 2)), 0, 1e-4);
  *failed += CheckClose("three modes meet: the other", cabs(m.lambda[3] - CMPLX(0, 5)), 0, NEAR_EPS);
  for (PetscInt i = 0; i < m.n * m.size; i++) sum += cabs(m.x[i]) + cabs(m.y[i]);
  *failed += CheckTrue("three modes meet: finite vectors", isfinite(sum), sum);
  PetscCall(ReducedModesDestroy(&m));
  PetscFunctionReturn(0);
}

/* Breaks when: left vectors in a plane of equal eigenvalues are not biorthogonal, so that conditions are meaningless.
   Reference: by construction kappa = 4, 4, 4, 9, 9, 16, all with independent vectors */
static PetscErrorCode TestDouble(int *failed)
{
  PetscReal    K[36] = {0}, product, least = 1;
  System       s;
  ReducedModes m;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < 6; i++) K[7 * i] = i < 3 ? 4 : i < 5 ? 9 : 16;
  Transform(6, K);
  PetscCall(SystemGeneral(6, K, &s));
  PetscCall(ReducedSolve(&s.reduced, NULL, &all, &m));
  *failed += CheckClose("multiple modes: number", (double)m.n, 6, 0);
  for (PetscInt i = 0; i < m.n; i++) {
    *failed += CheckClose("multiple modes: frequency", cimag(m.lambda[i]), i < 3 ? 2 : i < 5 ? 3 : 4, NEAR_EPS);
    least = PetscMin(least, cabs(m.product[i]));
  }
  PetscCall(LargestProduct(&s, NULL, &m, &product));
  *failed += CheckClose("multiple modes: biorthogonality", product, 0, 1e-11);
  *failed += CheckTrue("multiple modes: condition", least > 0.01, least);
  PetscCall(ReducedModesDestroy(&m));
  PetscFunctionReturn(0);
}

/* Eigenvalue kappa of the system of TestSpread() near a start: Newton's method on its determinant, 64-bit mantissa */
static long double SpreadReference(long double kn, long double friction, long double kappa)
{
  for (int k = 0; k < 60; k++) {
    const long double a = 2 - 2 * kappa, d = 3 - kappa, s = 1 - kappa / kn, e = kappa * kappa / kn;
    const long double f  = (a * d - (1 - friction)) * s - e * d;
    const long double df = (-2 * d - a) * s - (a * d - (1 - friction)) / kn - 2 * kappa / kn * d + e;

    kappa -= f / df;
  }
  return kappa;
}

/* Breaks when: eigenvalues that are 1e14 times smaller than the largest lose digits to it: QR iterations on M^-1 K give
   0.954 for the first frequency. A mass on a spring of stiffness k_n, its elongation as third unknown:
   K = [[2, 1 - mu, 0], [1, 3, 0], [0, 0, k_n]], M = [[2, 0, 1], [0, 1, 0], [1, 0, 1]]. Reference: SpreadReference() */
static PetscErrorCode TestSpread(int *failed)
{
  const PetscReal kn = 2e14, mu = 0.6;
  const PetscReal K[] = {2, 1, 0, 1, 3, 0, 0, 0, kn}, H[] = {0, -1, 0, 0, 0, 0, 0, 0, 0};
  const PetscReal M[] = {2, 0, 1, 0, 1, 0, 1, 0, 1}, C[] = {0, 0, 0, 0, 0, 0, 0, 0, 0};
  System          s;

  PetscFunctionBeginUser;
  SystemCreate(3, 3, 1, &s);
  SystemAdd(&s, OPERATORS_STIFFNESS, PETSC_TRUE, -1, K);
  SystemAdd(&s, OPERATORS_MASS, PETSC_TRUE, -1, M);
  for (int k = 0; k < 3; k++) { /* symmetric, undamped, damped (by zero) */
    const PetscReal friction = k ? mu : 0;
    ReducedModes    m;

    if (k == 1) SystemAdd(&s, OPERATORS_STIFFNESS, PETSC_FALSE, 0, H);
    if (k == 2) SystemAdd(&s, OPERATORS_DAMPING, PETSC_TRUE, -1, C);
    PetscCall(ReducedSolve(&s.reduced, &mu, &all, &m));
    *failed += CheckClose("spread 1e14: modes", (double)m.n, 2, 0);
    *failed += CheckClose("spread 1e14: first frequency", cimag(m.lambda[0]),
                          (double)sqrtl(SpreadReference(kn, friction, 0.7L)), NEAR_EPS);
    *failed += CheckClose("spread 1e14: second frequency", cimag(m.lambda[1]),
                          (double)sqrtl(SpreadReference(kn, friction, 3.2L)), NEAR_EPS);
    PetscCall(ReducedModesDestroy(&m));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  (void)size;
  PetscCall(TestFlutter(failed));
  PetscCall(TestUnevenDamping(failed));
  PetscCall(TestDivergence(failed));
  PetscCall(TestRigid(failed));
  PetscCall(TestTriple(failed));
  PetscCall(TestDouble(failed));
  PetscCall(TestSpread(failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
