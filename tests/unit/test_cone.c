/*
   Unit test of kernels/contact/cone.h: the laws of contact and friction are evaluated here anew, on random problems and on
   those that leave the random ones: directions held, no friction, no force, no slip. No reference numbers are needed: a
   solution is what obeys the laws.
*/
#include <stdlib.h>
#include "check.h"
#include "kernels/contact/cone.h"
#include "kernels/contact/friction.h"

/* Uniform in [-1, 1], the same on every machine */
static double Random(void)
{
  static unsigned long long state = 88172645463325252ULL;

  state ^= state << 13;
  state ^= state >> 7;
  state ^= state << 17;
  return (double)(state >> 11) / 4503599627370496.0 - 1;
}

/* Scale of the impulses that matter: the given ones, and what stops the given velocities */
static double Scale(const double W[3][3], const double q[3], const double p[3])
{
  const double speed = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2]),
               force = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);

  return force + speed / (W[0][0] + W[1][1] + W[2][2]);
}

/* Largest violation of the laws by p, impulses and velocities made comparable by the trace of W */
static double Violation(const double W[3][3], const double q[3], double mu, const double p[3], ContactStatus status)
{
  const double trace = W[0][0] + W[1][1] + W[2][2], friction = hypot(p[1], p[2]);
  double       v[3], slip, worst;

  for (int i = 0; i < 3; i++) v[i] = (q[i] + W[i][0] * p[0] + W[i][1] * p[1] + W[i][2] * p[2]) / trace;
  slip  = hypot(v[1], v[2]);
  worst = fmax(-p[0], fmax(-v[0], fabs(fmin(p[0], v[0]))));
  worst = fmax(worst, friction - mu * p[0]);
  if (status == CONTACT_STICK) worst = fmax(worst, slip);
  if (status == CONTACT_SLIP && slip > 0)
    worst = fmax(worst, hypot(p[1] + mu * p[0] * v[1] / slip, p[2] + mu * p[0] * v[2] / slip) *
                          fmin(1, slip / Scale(W, q, p)));
  return worst / Scale(W, q, p);
}

/* W = sum of n_bodies diagonal compliances, turned; held: directions whose compliance is zero on all of them */
static void Compliance(int n_bodies, const int held[3], double W[3][3])
{
  for (int i = 0; i < 9; i++) W[i / 3][i % 3] = 0;
  for (int b = 0; b < n_bodies; b++)
    for (int d = 0; d < 3; d++) {
      const double row[3] = {Random(), Random(), Random()}, size = pow(10, 2 * Random());

      for (int i = 0; i < 9; i++)
        if (!held[i / 3] && !held[i % 3]) W[i / 3][i % 3] += size * row[i / 3] * row[i % 3];
    }
}

/* Worst violation over random problems; count[] of each status */
static double Worst(int n, const int held[3], double largest_mu, int count[3])
{
  double worst = 0;

  for (int k = 0; k < n; k++) {
    double       W[3][3], p[3], q[3];
    const double mu = largest_mu * fabs(Random());
    ContactStatus   status;

    Compliance(2, held, W);
    for (int i = 0; i < 3; i++) q[i] = Random() * pow(10, Random());
    status = ConeSolve((const double(*)[3])W, q, mu, p);
    worst  = fmax(worst, Violation((const double(*)[3])W, q, mu, p, status));
    count[status]++;
  }
  return worst;
}

/* Breaks when: a case is decided wrongly, the root is not the root, or is not found to rounding */
static int TestRandom(void)
{
  static const int none[3]  = {0, 0, 0};
  int              count[3] = {0, 0, 0}, failed;

  failed = CheckClose("laws at 100000 random pairs, mu up to 1", Worst(100000, none, 1, count), 0, 1e-12);
  failed += CheckClose("frictionless", Worst(20000, none, 0, count), 0, 1e-12);
  failed += CheckTrue("all statuses occur", count[0] > 1000 && count[1] > 1000 && count[2] > 1000, count[1]);
  return failed;
}

/* Breaks when: a direction that both nodes are held in is divided by zero, or friction in it is forgotten. Slip cannot
   be stopped there, so that friction has a part mu lambda_n along it */
static int TestHeld(void)
{
  static const int one[3] = {0, 0, 1}, both[3] = {0, 1, 1};
  int              count[3] = {0, 0, 0}, failed;
  const double     W[3][3]  = {
         {2, 0, 0},
         {0, 0, 0},
         {0, 0, 3}
  };
  double p[3] = {9, 9, 9};

  failed = CheckClose("a tangent held", Worst(20000, one, 1, count), 0, 1e-12);
  failed += CheckClose("both tangents held", Worst(20000, both, 1, count), 0, 1e-12);
  failed += CheckTrue("the normal held: no force",
                      ConeSolve(
                        (const double(*)[3])(double[3][3]){
                          {0, 0, 0},
                          {0, 1, 0},
                          {0, 0, 1}
  },
                        (double[3]){-1, 1, 1}, 0.5, p) == CONTACT_OPEN &&
                        p[0] == 0 && p[1] == 0,
                      p[0]);
  failed += CheckTrue("held and at rest: stick", ConeSolve(W, (double[3]){-1, 0, 0.1}, 0.5, p) == CONTACT_STICK, p[0]);
  failed += CheckClose("friction that stops the free tangent", p[2], -0.1 / 3, 1e-15);
  return failed;
}

/* Breaks when: a problem without coupling is not the projection of -q / w on the normal and then on the disc */
static int TestScalar(void)
{
  double worst = 0;

  for (int k = 0; k < 20000; k++) {
    const double w = pow(10, 3 * Random()), mu = fabs(Random()), q[3] = {Random(), Random(), Random()};
    const double W[3][3] = {
      {w, 0, 0},
      {0, w, 0},
      {0, 0, w}
    };
    const double normal = fmax(0, -q[0]), slip = hypot(q[1], q[2]), factor = fmin(1, mu * normal / slip);
    double       p[3];

    (void)ConeSolve(W, q, mu, p);
    worst = fmax(worst, fabs(w * p[0] - normal));
    for (int i = 1; i < 3; i++) worst = fmax(worst, fabs(w * p[i] + factor * q[i]));
  }
  return CheckClose("W = w I by projection and by the root", worst, 0, 1e-13);
}

/* Breaks when: the natural map vanishes elsewhere than at solutions, or not there. Force 2 N s on a pair of w = 1/kg */
static int TestResidual(void)
{
  const double stick[3] = {2, 0.5, 0}, slip[3] = {2, -1, 0}, none[3] = {0, 0, 0};
  int          failed;

  failed = CheckClose("stick", ConeResidual(1, (double[3]){0, 0, 0}, 0.5, stick), 0, 0);
  failed += CheckClose("slip", ConeResidual(1, (double[3]){0, 3, 0}, 0.5, slip), 0, 0);
  failed += CheckClose("open", ConeResidual(1, (double[3]){4, 1, 1}, 0.5, none), 0, 0);
  failed += CheckClose("penetration", ConeResidual(1, (double[3]){-0.25, 0, 0}, 0.5, none), 0.25, 0);
  failed += CheckClose("force across a gap", ConeResidual(1, (double[3]){0.5, 0, 0}, 0.5, stick), 0.5, 0);
  failed += CheckClose("friction along the slip", ConeResidual(1, (double[3]){0, -3, 0}, 0.5, slip), 2, 1e-15);
  failed += CheckClose("slip within the cone", ConeResidual(1, (double[3]){0, 0, 0.25}, 0.5, stick), 0.25, 1e-15);
  return failed;
}

int main(void)
{
  const int failed = TestRandom() + TestHeld() + TestScalar() + TestResidual();

  printf("%d failed\n", failed);
  return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
