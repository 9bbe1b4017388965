/*
   Unit tests of kernels/contact/coulomb.h: pure functions, pairs and states drawn at random with a fixed seed. All references
   are the laws themselves, written out here a second time.
*/
#include "kernels/contact/coulomb.h"
#include "check.h"

#include <stdint.h>

#define N_RANDOM 2000

/* In [0, 1); M. O'Neill's multiplier, upper bits */
static double Draw(uint64_t *seed)
{
  *seed = *seed * 6364136223846793005u + 1442695040888963407u;
  return (double)(*seed >> 11) / 9007199254740992.0;
}

static double DrawSigned(uint64_t *seed)
{
  return 2 * Draw(seed) - 1;
}

/* A pair of three rows; k from 1e-6 to 1e6, or infinite for every eighth one */
static CoulombPair DrawPair(uint64_t *seed)
{
  CoulombPair pair = {.d = 3, .mu = Draw(seed), .k = pow(10, 6 * DrawSigned(seed)), .g0 = DrawSigned(seed)};

  if (Draw(seed) < 0.125) pair.k = INFINITY;
  for (int i = 0; i < 2; i++) pair.slip0[i] = DrawSigned(seed);
  return pair;
}

/* Numbers of the law at a parameter z */
static void LawAt(const CoulombLaw *law, int d, const double z[], double l[], double w[])
{
  for (int i = 0; i < d; i++) {
    l[i] = law->p0[i];
    w[i] = law->q0[i];
    for (int k = 0; k < d; k++) {
      l[i] += law->P[i][k] * z[k];
      w[i] += law->Q[i][k] * z[k];
    }
  }
}

/* l_n - k (w_n - g0) beside the larger of its parts, or w_n - g0 */
static double NormalError(const CoulombPair *pair, const double l[], const double w[])
{
  if (isinf(pair->k)) return fabs(w[0] - pair->g0);
  return fabs(l[0] - pair->k * (w[0] - pair->g0)) / fmax(1, fmax(fabs(l[0]), pair->k * (fabs(w[0]) + fabs(pair->g0))));
}

/* Breaks when: a row of open or stick is missing or has an offset of the other, or a stiff pair counts as soft */
static int TestOpenAndStick(void)
{
  uint64_t seed = 1;
  double   open = 0, normal = 0, stick = 0, z[3], l[3], w[3];
  int      failed = 0;

  for (int i = 0; i < N_RANDOM; i++) {
    const CoulombPair pair = DrawPair(&seed);
    CoulombLaw        law;

    for (int k = 0; k < 3; k++) z[k] = DrawSigned(&seed);
    CoulombLinearise(&pair, CONTACT_OPEN, z, z, &law);
    LawAt(&law, 3, z, l, w);
    for (int k = 0; k < 3; k++) open = fmax(open, fabs(l[k]) + fabs(w[k] - z[k]));
    CoulombLinearise(&pair, CONTACT_STICK, z, z, &law);
    LawAt(&law, 3, z, l, w);
    normal = fmax(normal, NormalError(&pair, l, w));
    for (int k = 1; k < 3; k++) stick = fmax(stick, fabs(w[k] - pair.slip0[k - 1]) + fabs(l[k] - z[k]));
  }
  failed += CheckClose("open: no force, any displacement", open, 0, 0);
  failed += CheckClose("closed: l_n = k (w_n - g0), relative", normal, 0, 1e-14);
  failed += CheckClose("stick: any friction, no slip since slip0", stick, 0, 0);
  return failed;
}

/* A pair that sliding pairs and pairs without friction have: the normal row only; the others stay untouched.
   Breaks when: rows that do not exist are written, or the status of friction matters for them. */
static int TestOneRow(void)
{
  uint64_t seed  = 2;
  double   error = 0, other = 0;
  int      failed = 0;

  for (int i = 0; i < N_RANDOM; i++) {
    CoulombPair  pair = DrawPair(&seed);
    const double z[3] = {DrawSigned(&seed), NAN, NAN};
    double       l[3], w[3];
    CoulombLaw   law;

    pair.d  = 1;
    pair.mu = 0;
    CoulombLinearise(&pair, i % 2 ? CONTACT_SLIP : CONTACT_STICK, z, z, &law);
    LawAt(&law, 1, z, l, w);
    error = fmax(error, NormalError(&pair, l, w));
    for (int k = 1; k < 3; k++)
      other = fmax(other, fabs(law.P[k][k]) + fabs(law.Q[k][k]) + fabs(law.p0[k]) + fabs(law.q0[k]));
    error = fmax(error, CoulombResidual(&pair, z, z));
  }
  failed += CheckClose("one row: l_n = k (w_n - g0), no residual of friction", error, 0, 1e-14);
  failed += CheckClose("one row: nothing in the others", other, 0, 0);
  return failed;
}

/* F = p - Proj_C(p + s) of a state x = (l, w), which the law of slip makes zero to first order */
static void FrictionFunction(const CoulombPair *pair, const double x[6], double F[2])
{
  double       p[2], q[2];
  const double cone = pair->mu * x[0];

  for (int i = 0; i < 2; i++) {
    p[i] = -x[1 + i];
    q[i] = p[i] - (x[4 + i] - pair->slip0[i]);
  }
  for (int i = 0; i < 2; i++) F[i] = p[i] - fmin(1, cone / hypot(q[0], q[1])) * q[i];
}

/* A state beyond the cone: |p + s| from 1.05 mu l_n on */
static void DrawSlipping(const CoulombPair *pair, uint64_t *seed, double x[6])
{
  double q[2];

  do {
    for (int i = 0; i < 6; i++) x[i] = DrawSigned(seed);
    x[0] = 0.1 + fabs(x[0]);
  } while (CoulombTrial(pair, x, &x[3], q) < 1.05 * pair->mu * x[0]);
}

/* Breaks when: the tangent of slip lacks the turn of its direction (E), takes s with the wrong sign, or counts slip
   from another place than slip0. F(x0) + F'(x0) (x - x0) = 0 for every x of the law, F' by central differences over
   2e-5, which leave 1e-10 of F's third derivatives (up to 1/|q|^2, |q| > 0.005) in units of |q|. */
static int TestSlipTangent(void)
{
  const double step  = 1e-5;
  uint64_t     seed  = 3;
  double       worst = 0;

  for (int i = 0; i < N_RANDOM; i++) {
    CoulombPair pair = DrawPair(&seed);
    double      x0[6], x[6], F[2], z[3], q[2], length;
    CoulombLaw  law;

    pair.mu = 0.05 + pair.mu;
    DrawSlipping(&pair, &seed, x0);
    length = CoulombTrial(&pair, x0, &x0[3], q);
    CoulombLinearise(&pair, CONTACT_SLIP, x0, &x0[3], &law);
    for (int k = 0; k < 3; k++) z[k] = DrawSigned(&seed);
    LawAt(&law, 3, z, x, &x[3]);
    FrictionFunction(&pair, x0, F);
    for (int k = 0; k < 6; k++) {
      double up[6], down[6], Fu[2], Fd[2];

      for (int m = 0; m < 6; m++) up[m] = down[m] = x0[m];
      up[k] += step;
      down[k] -= step;
      FrictionFunction(&pair, up, Fu);
      FrictionFunction(&pair, down, Fd);
      for (int m = 0; m < 2; m++) F[m] += (Fu[m] - Fd[m]) / (2 * step) * (x[k] - x0[k]);
    }
    for (int m = 0; m < 2; m++)
      worst = fmax(worst, fabs(F[m]) * length * length / (1 + fabs(x[0]) + fabs(x[1]) + fabs(x[2]) + fabs(x[3])));
  }
  return CheckClose("slip: Newton's equation of the natural map", worst, 0, 1e-8);
}

/* Breaks when: a slipping equilibrium is no fixed point. p = mu l_n s / |s| made by hand obeys the law linearised at
   it */
static int TestSlipFixed(void)
{
  uint64_t seed  = 4;
  double   worst = 0, residual = 0;
  int      failed = 0;

  for (int i = 0; i < N_RANDOM; i++) {
    const CoulombPair pair = DrawPair(&seed);
    double            s[2] = {DrawSigned(&seed), DrawSigned(&seed)}, l[3] = {Draw(&seed)}, w[3], l1[3], w1[3];
    const double      size = hypot(s[0], s[1]);
    CoulombLaw        law;

    w[0] = pair.g0 + (isinf(pair.k) ? 0 : l[0] / pair.k);
    for (int k = 0; k < 2; k++) {
      l[1 + k] = -pair.mu * l[0] * s[k] / size;
      w[1 + k] = pair.slip0[k] - s[k];
    }
    CoulombLinearise(&pair, CONTACT_SLIP, l, w, &law);
    LawAt(&law, 3, (const double[3]){pair.k >= 1 ? l[0] : w[0], -s[0], -s[1]}, l1, w1);
    for (int k = 0; k < 3; k++) worst = fmax(worst, fmax(fabs(l1[k] - l[k]), fabs(w1[k] - w[k]) / (1 + fabs(w[0]))));
    residual = fmax(residual, CoulombResidual(&pair, l, w));
  }
  failed += CheckClose("slip: an equilibrium stays", worst, 0, 1e-13);
  failed += CheckClose("slip: residual of an equilibrium", residual, 0, 1e-14);
  return failed;
}

/* Breaks when: friction appears without a coefficient, or 0 / 0 of an empty cone without slip gets into a law */
static int TestFrictionless(void)
{
  const double l[3] = {1, 0.2, 0}, w[3] = {0, 0, 0}, none[3] = {0, 0, 0};
  CoulombPair  pair = {.d = 3, .mu = 0, .k = INFINITY};
  CoulombLaw   law;
  double       l1[3], w1[3];
  int          failed = 0;

  failed += CheckTrue("mu = 0: what does not slip but carries friction slips",
                      CoulombDecide(&pair, CONTACT_STICK, l, w, 1e-13) == CONTACT_SLIP, 0);
  CoulombLinearise(&pair, CONTACT_SLIP, l, none, &law);
  LawAt(&law, 3, (const double[3]){1, -0.3, 0.4}, l1, w1);
  failed += CheckClose("mu = 0: friction in slip", hypot(l1[1], l1[2]), 0, 0);
  failed += CheckClose("mu = 0: slip is free", hypot(w1[1] + 0.3, w1[2] - 0.4), 0, 0);
  CoulombLinearise(&pair, CONTACT_SLIP, none, none, &law);
  LawAt(&law, 3, (const double[3]){1, -0.3, 0.4}, l1, w1);
  failed += CheckClose("mu = 0: friction in slip, from nothing", hypot(l1[1], l1[2]), 0, 0);
  failed += CheckClose("mu = 0: residual without slip", CoulombResidual(&pair, (const double[3]){1, 0, 0}, w), 0, 0);
  pair.mu = 0.5;
  CoulombLinearise(&pair, CONTACT_SLIP, none, none, &law);
  LawAt(&law, 3, (const double[3]){1, -0.3, 0.4}, l1, w1);
  failed += CheckTrue("mu > 0, no force and no slip yet: finite numbers", isfinite(l1[1] + l1[2] + w1[1] + w1[2]), 0);
  failed += CheckClose("mu > 0, no force and no slip yet: |p| = mu l_n", hypot(l1[1], l1[2]), 0.5, 1e-15);
  return failed;
}

/* Breaks when: a pair on the border between two statuses goes back and forth, or one off the border stays */
static int TestBorders(void)
{
  static const double ks[] = {1e-6, 0.5, 1, 2, 1e6, INFINITY};
  const double        tol = 1e-13, off = 1e-9;
  int                 failed = 0, kept = 0, opened = 0, closed = 0;

  for (int i = 0; i < 6; i++) {
    const CoulombPair pair    = {.d = 1, .k = ks[i], .g0 = 0.25};
    const double      far     = isinf(ks[i]) ? 0 : off / ks[i];
    const double      zero[1] = {0}, pull[1] = {-off}, on[1] = {0.25}, over[1] = {0.25 + off}, apart[1] = {0.25 - far};

    kept += CoulombDecide(&pair, CONTACT_OPEN, zero, on, tol) == CONTACT_OPEN;
    kept += CoulombDecide(&pair, CONTACT_SLIP, zero, on, tol) == CONTACT_SLIP;
    closed += CoulombDecide(&pair, CONTACT_OPEN, zero, over, tol) == CONTACT_SLIP;
    opened += CoulombDecide(&pair, CONTACT_SLIP, pull, apart, tol) == CONTACT_OPEN;
  }
  failed += CheckClose("on the border a pair stays open, or closed, for any k", kept, 12, 0);
  failed += CheckClose("what overlaps closes, for any k", closed, 6, 0);
  failed += CheckClose("what pulls opens, for any k", opened, 6, 0);
  return failed;
}

/* Breaks when: a yielding pair is not p = Proj_C(s / soft), its stick or slip has another slope, d p / d s = 1 / soft, or
   mu l_n / |s| across s, or an open pair pulls otherwise than in proportion to its gap. References: those three */
static int TestYielding(void)
{
  uint64_t seed     = 11;
  double   residual = 0, stick = 0, slip = 0, pull = 0;

  for (int i = 0; i < 1000; i++) {
    CoulombPair  pair = DrawPair(&seed);
    const double ln = 1 + Draw(&seed), angle = 3 * DrawSigned(&seed), s = Draw(&seed) + 0.01;
    double       l[3] = {ln}, w[3] = {0}, l1[3], w1[3];
    CoulombLaw   law;

    pair.soft = pow(10, 3 * DrawSigned(&seed));
    pair.pull = Draw(&seed);
    for (int k = 0; k < 2; k++) {
      const double e = k ? sin(angle) : cos(angle);

      l[1 + k] = -fmin(s / pair.soft, pair.mu * ln) * e;
      w[1 + k] = pair.slip0[k] - s * e;
    }
    residual = fmax(residual, CoulombResidual(&pair, l, w));
    CoulombLinearise(&pair, CONTACT_STICK, l, w, &law);
    LawAt(&law, 3, (const double[3]){0, 0.3, -0.7}, l1, w1);
    stick =
      fmax(stick, hypot(w1[1] - pair.slip0[0] - pair.soft * 0.3, w1[2] - pair.slip0[1] + pair.soft * 0.7) / pair.soft);
    CoulombLinearise(&pair, CONTACT_OPEN, l, w, &law);
    LawAt(&law, 3, (const double[3]){0.5, 0, 0}, l1, w1);
    pull = fmax(pull, fabs(l1[0] - pair.pull * (w1[0] - pair.g0)));
    if (s / pair.soft < pair.mu * ln) continue;
    CoulombLinearise(&pair, CONTACT_SLIP, l, w, &law);
    for (int k = 1; k < 3; k++) { /* along z across s: changes of l and w, without the constants */
      const double *P = law.P[k], *Q = law.Q[k], a = -sin(angle), b = cos(angle);

      slip = fmax(slip, fabs((P[1] * a + P[2] * b) * s / (pair.mu * ln) - (Q[1] * a + Q[2] * b)));
    }
  }
  return CheckClose("yielding: residual of p = Proj(s / soft)", residual, 0, 1e-14) +
         CheckClose("yielding: stick", stick, 0, 1e-12) + CheckClose("yielding: slip across s", slip, 0, 1e-12) +
         CheckClose("open: pull in proportion to the gap", pull, 0, 1e-15);
}

/* Breaks when: drag is no slope of friction along the slip from q0 on, or changes what is across it or the normal law:
   p, q of any z against p = mu l_n e + d (e'q - |q0|) e along e, and against the law without drag across it */
static int TestDrag(void)
{
  uint64_t seed = 12;
  double   along = 0, other = 0, x[6], y[6], z[3], q[2], e[2], length, size;

  for (int i = 0; i < 1000; i++) {
    CoulombPair pair = DrawPair(&seed);
    CoulombLaw  law, plain;

    pair.soft = i % 2 ? pow(10, 3 * DrawSigned(&seed)) : 0;
    for (int k = 0; k < 6; k++) x[k] = k ? DrawSigned(&seed) : Draw(&seed);
    for (int k = 0; k < 3; k++) z[k] = DrawSigned(&seed);
    length = CoulombTrial(&pair, x, &x[3], e);
    CoulombLinearise(&pair, CONTACT_SLIP, x, &x[3], &plain);
    pair.drag = 0.9 * Draw(&seed);
    CoulombLinearise(&pair, CONTACT_SLIP, x, &x[3], &law);
    LawAt(&law, 3, z, x, &x[3]);
    LawAt(&plain, 3, z, y, &y[3]);
    size = CoulombTrial(&pair, x, &x[3], q) + fabs(x[1]) + fabs(x[2]) + length;
    along = fmax(along, fabs(-(x[1] * e[0] + x[2] * e[1]) / length - pair.mu * x[0] -
                             pair.drag * ((q[0] * e[0] + q[1] * e[1]) / length - length)) / size);
    for (int k = 0; k < 4; k += 3)
      other = fmax(other, fabs(x[k] - y[k]) +
                            fabs((x[k + 1] - y[k + 1]) * e[1] - (x[k + 2] - y[k + 2]) * e[0]) / length / size);
  }
  return CheckClose("drag: p along the slip", along, 0, 1e-13) + CheckClose("drag: nothing else", other, 0, 1e-13);
}

/* Breaks when: stick and slip are not parted by |p + s| = mu l_n. l_n = 2, mu = 0.5: the cone is 1 */
static int TestStickBorder(void)
{
  const CoulombPair pair = {
    .d = 3, .mu = 0.5, .k = INFINITY, .slip0 = {0.5, -0.5}
  };
  const double w[3] = {0, 0.5, -0.5}, on[3] = {2, -0.6, 0.8}, in[3] = {2, -0.6, 0.79}, out[3] = {2, -0.6, 0.81};
  const double back[3] = {0, 0.5 + 0.06, -0.5 - 0.08}; /* slipped against the friction by 0.1 */
  int          failed  = 0;

  failed += CheckTrue("on the cone stick stays", CoulombDecide(&pair, CONTACT_STICK, on, w, 1e-13) == CONTACT_STICK, 0);
  failed += CheckTrue("on the cone slip stays", CoulombDecide(&pair, CONTACT_SLIP, on, w, 1e-13) == CONTACT_SLIP, 0);
  failed += CheckTrue("within, it sticks", CoulombDecide(&pair, CONTACT_SLIP, in, w, 1e-13) == CONTACT_STICK, 0);
  failed += CheckTrue("beyond, it slips", CoulombDecide(&pair, CONTACT_STICK, out, w, 1e-13) == CONTACT_SLIP, 0);
  failed +=
    CheckTrue("slip against friction sticks", CoulombDecide(&pair, CONTACT_SLIP, on, back, 1e-13) == CONTACT_STICK, 0);
  failed += CheckTrue("open first, then stick", CoulombDecide(&pair, CONTACT_OPEN, on, w, 1e-13) == CONTACT_STICK, 0);
  failed += CheckClose("residual of slip against friction, its length", CoulombResidual(&pair, on, back), 0.1, 1e-15);
  failed += CheckClose("residual beyond the cone", CoulombResidual(&pair, out, w), hypot(0.6, 0.81) - 1, 1e-15);
  failed += CheckClose("residual of stick", CoulombResidual(&pair, in, w), 0, 0);
  return failed;
}

int main(void)
{
  const int failed = TestOpenAndStick() + TestOneRow() + TestSlipTangent() + TestSlipFixed() + TestFrictionless() +
                     TestBorders() + TestYielding() + TestDrag() + TestStickBorder();

  printf("%d failed\n", failed);
  return failed ? 1 : 0;
}
