/*
   Unilateral contact with Coulomb friction at one pair, exactly: pure functions.

   With impulses p = (p_n, p_T) on the slave (N s), the velocity of the slave relative to the master along n and in the
   tangent plane is q = q* + W p (m/s), W symmetric and positive semidefinite (1/kg). Wanted is p with
      0 <= p_n,  0 <= q_n,  p_n q_n = 0,      |p_T| <= mu p_n,  q_T = 0  or  p_T = -mu p_n q_T / |q_T|
   Without coupling (W = w I) it is the projection of -q* / w, p_n first. In general, with p_n eliminated by q_n = 0,
      S = W_TT - W_Tn W_nT / W_nn,  c = q*_T - W_Tn q*_n / W_nn,   (S + alpha I) p_T = -c,   q_T = -alpha p_T
   alpha = 0 is stick; else alpha > 0 is the root of |p_T(alpha)| = mu p_n(alpha), which exists: at 0 the left side is
   larger, and for alpha to infinity p_T vanishes and p_n tends to -q*_n / W_nn > 0 (after O. Bonnefon, G. Daviet,
   Quartic formulation of Coulomb 3D frictional contact, INRIA RT-0400, 2011).
   q*_n >= 0 is answered by p = 0, which is always a solution then. A null direction of W that is oblique to the plane
   may leave no solution (a wedge that jams while it is driven): the answer is then that without friction, and not a
   solution.
*/
#pragma once

#include "friction.h"
#include <squeal/contactstatus.h>

#define CONE_HELD 1e-14 /* compliance below this part of the trace of W: direction held on both sides */

/* Tangential problem in the principal axes of S: (s_i + alpha) p_i = -c_i, p_n = pn0 + k . p */
typedef struct {
  double axis[2]; /* cosine and sine of the first axis */
  double s[2], c[2], pn0, k[2], mu;
} ConePlane;

/* Principal axes; compliances that are rounding become 0, and so do velocities along them */
static inline void ConePlaneSet(const double W[3][3], const double q[3], double mu, ConePlane *plane)
{
  const double tiny = CONE_HELD * (W[0][0] + W[1][1] + W[2][2]), speed = fabs(q[0]) + fabs(q[1]) + fabs(q[2]);
  const double S00 = W[1][1] - W[1][0] * W[1][0] / W[0][0], S11 = W[2][2] - W[2][0] * W[2][0] / W[0][0];
  const double S01 = W[1][2] - W[1][0] * W[2][0] / W[0][0], half = 0.5 * (S00 - S11), r = hypot(half, S01);
  const double c[2] = {q[1] - W[1][0] * q[0] / W[0][0], q[2] - W[2][0] * q[0] / W[0][0]};
  const double x = cos(0.5 * atan2(S01, half)), y = sin(0.5 * atan2(S01, half));

  *plane =
    (ConePlane){.axis = {x, y}, .c = {x * c[0] + y * c[1], -y * c[0] + x * c[1]}, .pn0 = -q[0] / W[0][0], .mu = mu};
  plane->s[0] = 0.5 * (S00 + S11) + r;
  plane->s[1] = 0.5 * (S00 + S11) - r;
  plane->k[0] = -(x * W[1][0] + y * W[2][0]) / W[0][0];
  plane->k[1] = -(-y * W[1][0] + x * W[2][0]) / W[0][0];
  for (int i = 0; i < 2; i++) {
    if (plane->s[i] > tiny) continue;
    plane->s[i] = 0;
    if (fabs(plane->c[i]) <= CONE_HELD * speed) plane->c[i] = 0;
  }
}

/* mu p_n / |p_T| - 1 at alpha > 0, with its derivative; p receives p_T in the principal axes */
static inline double ConeMissing(const ConePlane *f, double alpha, double p[2], double *slope)
{
  double dp[2], length, pn, dlength, dpn;

  for (int i = 0; i < 2; i++) {
    p[i]  = f->c[i] == 0 ? 0 : -f->c[i] / (f->s[i] + alpha);
    dp[i] = f->c[i] == 0 ? 0 : f->c[i] / ((f->s[i] + alpha) * (f->s[i] + alpha));
  }
  length  = sqrt(p[0] * p[0] + p[1] * p[1]);
  dlength = (p[0] * dp[0] + p[1] * dp[1]) / length;
  pn      = f->pn0 + f->k[0] * p[0] + f->k[1] * p[1];
  dpn     = f->k[0] * dp[0] + f->k[1] * dp[1];
  *slope  = f->mu * (dpn - pn * dlength / length) / length;
  return f->mu * pn / length - 1;
}

/* Direction of slip: p_T at the root, by Newton steps that are kept within a bracket */
static inline void ConeSlipForce(const ConePlane *f, double p[2])
{
  double low = 0, high = hypot(f->c[0], f->c[1]) / (f->mu * f->pn0), alpha, slope, value;

  while (ConeMissing(f, high, p, &slope) < 0 && high < 1e300) {
    low = high;
    high *= 4;
  }
  alpha = high;
  for (int it = 0; it < 300 && high - low > 1e-16 * high; it++) {
    double next;

    value = ConeMissing(f, alpha, p, &slope);
    if (value < 0)
      low = alpha;
    else
      high = alpha;
    next = alpha - value / slope;
    if (fabs(next - alpha) <= 2e-16 * alpha) break;
    if (!(next > low && next < high)) next = low > 0 && high > 4 * low ? sqrt(low * high) : 0.5 * (low + high);
    alpha = next;
  }
  (void)ConeMissing(f, alpha, p, &slope);
}

/* Stick, where it is possible: p in the pair's axes */
static inline int ConeStick(const ConePlane *f, double p[3])
{
  double a[2] = {0, 0};

  for (int i = 0; i < 2; i++) {
    if (f->s[i] == 0 && f->c[i] != 0) return 0;
    if (f->s[i] > 0) a[i] = -f->c[i] / f->s[i];
  }
  p[0] = f->pn0 + f->k[0] * a[0] + f->k[1] * a[1];
  p[1] = f->axis[0] * a[0] - f->axis[1] * a[1];
  p[2] = f->axis[1] * a[0] + f->axis[0] * a[1];
  return sqrt(a[0] * a[0] + a[1] * a[1]) <= f->mu * p[0];
}

/* Any W, of which W[0][0] = 0 means that nothing moves along n: p = 0 then */
static inline ContactStatus ConeSolve(const double W[3][3], const double q[3], double mu, double p[3])
{
  double    a[2], length;
  ConePlane f;

  p[0] = p[1] = p[2] = 0;
  if (q[0] >= 0 || W[0][0] <= CONE_HELD * (W[1][1] + W[2][2])) return CONTACT_OPEN;
  ConePlaneSet(W, q, mu, &f);
  if (mu > 0 && ConeStick(&f, p)) return CONTACT_STICK;
  p[0] = f.pn0;
  p[1] = p[2] = 0;
  if (mu == 0 || (f.c[0] == 0 && f.c[1] == 0)) return CONTACT_SLIP;
  ConeSlipForce(&f, a);
  length = sqrt(a[0] * a[0] + a[1] * a[1]);
  p[1]   = (f.axis[0] * a[0] - f.axis[1] * a[1]) / length;
  p[2]   = (f.axis[1] * a[0] + f.axis[0] * a[1]) / length;
  p[0]   = -q[0] / (W[0][0] + mu * (W[0][1] * p[1] + W[0][2] * p[2]));
  if (!(p[0] > 0)) p[0] = f.pn0, p[1] = p[2] = 0;
  p[1] *= mu * p[0];
  p[2] *= mu * p[0];
  return CONTACT_SLIP;
}

/* Residual of the natural map, N s: p_n - max(0, p_n - rho q_n) and p_T - Proj(p_T - rho q_T) on the disc of radius
   mu p_n, at q = q* + W p; rho (kg) is the inverse of a compliance of the pair */
static inline double ConeResidual(double rho, const double q[3], double mu, const double p[3])
{
  const double normal = fabs(p[0] - fmax(0, p[0] - rho * q[0]));
  const double z[2]   = {p[1] - rho * q[1], p[2] - rho * q[2]};

  return fmax(normal, FrictionMiss(&p[1], z, mu * fmax(0, p[0])));
}
