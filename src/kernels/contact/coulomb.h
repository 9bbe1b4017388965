/*
   Laws of one contact pair and their linearisation: pure functions, no MPI. All in metres: forces l are divided by a
   stiffness kappa, and k = k_n / kappa.

   With contact displacements w = (w_n, w_t, w_b) of the master relative to the slave, closing positive, and internal
   forces l = (lambda_n, -lambda_t, -lambda_b), both in the frame (n, t, b):
      normal   open: l_n = 0 <= g0 - w_n;   closed: l_n = k (w_n - g1) >= 0, or w_n = g1 for k infinite; g1 = g0 + shift
      slides   lambda_t = mu lambda_n is in the equilibrium itself; the pair has a normal row only (d = 1)
      Coulomb  p = (lambda_t, lambda_b), slip of the slave s = -(w_T - w_T0):   p = Proj_C(p + s), C = {|p| <= mu l_n}
   (natural map with unit factor; P. Alart, A. Curnier, Comput. Methods Appl. Mech. Eng. 92, 1991, 353). Every status
   makes the law linear in a parameter z of as many numbers as the pair has rows,

      l = P z + p0,   w = Q z + q0.

   Slip, linearised at q = p + s, e = q / |q|, E = I - e e', alpha = mu l_n / |q| < 1:
      p = mu l_n e + alpha E (p + s)   hence   p = mu l_n e - alpha E z,   s = - e e'z - (1 - alpha) E z

   for any z in the plane, from slip without a direction of its own (alpha = 0) to the border of stick (alpha = 1).

   With regularised friction (soft > 0) a pair slips by soft p before it gives way, s - soft p in the normal cone of C
   at p; p does not change when it is written p = Proj_C(q), q = (1 - rho soft) p + rho s, rho = min(1, 1 / soft), which
   is Coulomb's law for soft = 0, a function of s alone for soft >= 1. Stick is s = soft p, and slip has rho E and E -
   alpha (1 - rho soft) E in the place of E and (1 - alpha) E. An open pair may pull: l_n = pull (w_n - g0) < 0.

   With a drag d < 1, a device of iterations, friction grows along the slip from q0 on, at which the law is linearised:
   p has d (e'q - |q0|) e more.

   Where mu falls with the length of slip, fall = d mu / d|s| (1/m), p has fall l_n e (e's - |s|) more, of which |s| is
   that at the present l, w: |q| - mu l_n. Where it changes with the force, rise = l_n d mu / d l_n, friction at other
   forces is (mu + rise) l_n less rise times the present force.
*/
#pragma once

#include "friction.h"
#include <squeal/contactstatus.h>

/* What does not change while a pair is iterated */
typedef struct {
  int    d;        /* rows: 1 (slides, or no friction) or 3 */
  double mu, k;    /* k may be infinite */
  double g0;       /* m */
  double shift;    /* where a tangent to the pressure law begins, beyond g0, m; 0 where that is linear */
  double slip0[2]; /* w_t, w_b from which slip counts, m */
  double fall;     /* d mu / d|s| at the present slip, 1/m */
  double rise;     /* l_n d mu / d l_n at the present force */
  double soft;     /* slip over friction before it gives way, 0 for Coulomb's law itself; none with a fall */
  double pull;     /* force over gap of an open pair, 0 for the laws themselves */
  double drag;     /* slope of friction along the slip from the present slip on, below 1: 0 for the laws themselves */
} CoulombPair;

/* Linear law of one status; only the leading d rows and columns are used */
typedef struct {
  double P[3][3], Q[3][3], p0[3], q0[3];
} CoulombLaw;

/* Closing w_n at which the normal law begins, g1 above, m */
static inline double CoulombOrigin(const CoulombPair *pair)
{
  return pair->g0 + pair->shift;
}

/* rho of s in what the natural map projects */
static inline double CoulombShare(const CoulombPair *pair)
{
  return pair->soft > 1 ? 1 / pair->soft : 1;
}

/* Friction that the natural map projects, q, and its length */
static inline double CoulombTrial(const CoulombPair *pair, const double l[], const double w[], double q[2])
{
  const double rho = CoulombShare(pair), keep = 1 - rho * pair->soft;

  for (int i = 0; i < 2; i++) q[i] = -keep * l[1 + i] - rho * (w[1 + i] - pair->slip0[i]);
  return sqrt(q[0] * q[0] + q[1] * q[1]);
}

/* Normal row of a closed pair: the larger of force and displacement is the parameter */
static inline void CoulombClosedNormal(const CoulombPair *pair, CoulombLaw *law)
{
  const int stiff = pair->k >= 1;

  law->P[0][0] = stiff ? 1 : pair->k;
  law->Q[0][0] = stiff ? 1 / pair->k : 1;
  law->p0[0]   = stiff ? 0 : -pair->k * CoulombOrigin(pair);
  law->q0[0]   = stiff ? CoulombOrigin(pair) : 0;
}

/* Tangential rows in slip, at the present l, w */
static inline void CoulombSlipRows(const CoulombPair *pair, const double l[], const double w[], CoulombLaw *law)
{
  double       q[2], e[2] = {1, 0};
  const double length = CoulombTrial(pair, l, w, q), cone = pair->mu * fmax(0, l[0]);
  const double alpha = cone == 0 ? 0 : length > cone ? cone / length : 1;
  const double fall = pair->fall * fmax(0, l[0]), rho = CoulombShare(pair), keep = 1 - rho * pair->soft;
  const double along = 1 / (1 - pair->drag * keep), slope = pair->mu + pair->rise, normal = fmax(0, l[0]);

  for (int i = 0; i < 2 && length > 0; i++) e[i] = q[i] / length;
  for (int i = 0; i < 2; i++) {
    law->P[1 + i][0] = -slope * e[i] * law->P[0][0] * along;
    law->p0[1 + i]   = -(slope * law->p0[0] - pair->rise * normal - pair->drag * length) * along * e[i] +
                     fall * fmax(0, length - cone) * e[i];
    law->q0[1 + i] = pair->slip0[i];
    for (int j = 0; j < 2; j++) {
      const double ee = e[i] * e[j], turn = alpha * ((i == j) - ee) + pair->drag * ee;

      law->P[1 + i][1 + j] = rho * turn + fall * ee;
      law->Q[1 + i][1 + j] = (i == j) - keep * turn;
    }
  }
}

/* The law of a status at the present l, w */
static inline void CoulombLinearise(const CoulombPair *pair, ContactStatus status, const double l[], const double w[],
                                    CoulombLaw *law)
{
  *law = (CoulombLaw){.p0 = {0}};
  if (status == CONTACT_OPEN) {
    for (int i = 0; i < pair->d; i++) law->Q[i][i] = 1;
    law->P[0][0] = pair->pull;
    law->p0[0]   = -pair->pull * CoulombOrigin(pair);
    return;
  }
  CoulombClosedNormal(pair, law);
  if (pair->d == 1) return;
  if (status == CONTACT_SLIP) {
    CoulombSlipRows(pair, l, w, law);
    return;
  }
  for (int i = 1; i < 3; i++) {
    law->P[i][i] = 1;
    law->Q[i][i] = pair->soft;
    law->q0[i]   = pair->slip0[i - 1];
  }
}

/* How far a pair is from the border between open and closed: positive closed */
static inline double CoulombClosing(const CoulombPair *pair, const double l[], const double w[])
{
  const double beyond = w[0] - CoulombOrigin(pair);

  return isinf(pair->k) ? l[0] + beyond : pair->k < 1 ? beyond : l[0] + beyond - l[0] / pair->k;
}

/* The status that l, w ask for; a pair on a border, within tol (m), stays what it was */
static inline ContactStatus CoulombDecide(const CoulombPair *pair, ContactStatus before, const double l[],
                                          const double w[], double tol)
{
  double q[2], beyond;

  if (CoulombClosing(pair, l, w) <= (before == CONTACT_OPEN ? tol : -tol)) return CONTACT_OPEN;
  if (pair->d == 1) return CONTACT_SLIP;
  beyond = CoulombTrial(pair, l, w, q) - pair->mu * fmax(0, l[0]);
  return beyond > (before == CONTACT_SLIP ? -tol : tol) ? CONTACT_SLIP : CONTACT_STICK;
}

/* Residual of the friction law, |p - Proj_C(q)|, m */
static inline double CoulombResidual(const CoulombPair *pair, const double l[], const double w[])
{
  double q[2];

  if (pair->d == 1) return 0;
  (void)CoulombTrial(pair, l, w, q);
  return FrictionMiss((double[2]){-l[1], -l[2]}, q, pair->mu * fmax(0, l[0]));
}
