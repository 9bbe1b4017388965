/*
   Spinning part in the fixed frame: an axisymmetric body turns at Omega (rad/s) about the unit vector e through the
   point c, and u(x, t) is the displacement of the material that passes x, in components of the frame. With w = e x (x -
   c) its steady velocity is Omega w, so that D/Dt = d/dt + Omega w . grad, and the acceleration of u is D^2 u / Dt^2:

      int rho v . D^2 u / Dt^2 dV = v' M u'' + v' G u' - v' Q u,

      G_ab = 2 Omega int rho N_a (w . grad N_b) dV        gyroscopic, skew (N s/m)
      Q_ab = Omega^2 int rho (w . grad N_a)(w . grad N_b) dV   centrifugal, symmetric (N/m)

   each times the 3 x 3 identity; by parts, since div w = 0 and w lies in the surface of the body. On a mesh, whose
   surface is not quite round, G is taken as its skew part, Omega int rho (N_a w . grad N_b - N_b w . grad N_a) dV,
   which neither gains nor loses energy. The steady load of the spin is, with r = (I - e e') (x - c),

      f_a = Omega^2 int rho N_a r dV (N),

   whose stress sigma adds K_sigma = int grad N_a . sigma . grad N_b dV (kernels/element/geometric.h), so that

      M u'' + G u' + (K + K_sigma - Q) u = 0.

   A wave exp(i (n theta + omega t)) of the turning frame has the frequency omega - n Omega here: waves that run with
   the body are faster by n Omega, those against it slower. A rigid shift costs nothing: w . grad of it is zero. A rigid
   tilt phi has no stiffness either, phi' K_sigma phi = phi' Q phi, and turns at Omega I_axis / I_across (nutation).

   Damping C = alpha M + beta K is taken in the frame, C u' in place of C (u' + Omega w . grad u). For a wave of the
   frequency omega_0 in the turning body this is off by the factor 1 +- n Omega / omega_0, as the frequency in the frame
   is: waves that run with the body are damped so much too strongly, those against it too weakly.

   Reference: U. Nackenhorst, The ALE-formulation of bodies in rolling contact, Computer Methods in Applied Mechanics
   and Engineering 193 (2004) 4299-4322.
*/
#pragma once

#include "solid.h"

typedef struct {
  double axis[3], centre[3]; /* unit vector; a point of the axis, m */
} SpinFrame;

/* Integrals of one element with n nodes */
typedef struct {
  double gyroscopic[SOLID_MAX_NODES * SOLID_MAX_NODES]; /* [n][n] int N_a w . grad N_b - N_b w . grad N_a dV, m^3 */
  double convective[SOLID_MAX_NODES * SOLID_MAX_NODES]; /* [n][n] int (w . grad N_a)(w . grad N_b) dV, m^3 */
  double load[3 * SOLID_MAX_NODES];                     /* [n][3] int N_a r dV, m^4 */
} SpinIntegrals;

/* w and r at x */
static inline void SpinFlow(const SpinFrame *frame, const double x[3], double w[3], double r[3])
{
  double along;

  for (int d = 0; d < 3; d++) r[d] = x[d] - frame->centre[d];
  along = Vec3Dot(frame->axis, r);
  for (int d = 0; d < 3; d++) r[d] -= along * frame->axis[d];
  Vec3Cross(frame->axis, r, w);
}

/* Adds what a quadrature point of volume dV (m^3) gives, with shape functions N[n], flow[n] = w . grad N (-), and r
   (m) */
static inline void SpinAddPoint(int n, double dV, const double *N, const double *flow, const double r[3],
                                SpinIntegrals *sum)
{
  for (int a = 0; a < n; a++) {
    for (int b = 0; b < n; b++) {
      sum->gyroscopic[a * n + b] += dV * (N[a] * flow[b] - N[b] * flow[a]);
      sum->convective[a * n + b] += dV * flow[a] * flow[b];
    }
    for (int d = 0; d < 3; d++) sum->load[3 * a + d] += dV * N[a] * r[d];
  }
}

/* SpinIntegrate - the integrals of an element with nodes x[n][3]; 1 where the Jacobian is not positive at a quadrature
   point */
static inline int SpinIntegrate(const Solid *solid, const SpinFrame *frame, const double *x, SpinIntegrals *sum)
{
  const int n = solid->n_nodes;
  double    N[SOLID_MAX_NODES], g[SOLID_MAX_DOFS], flow[SOLID_MAX_NODES];

  memset(sum, 0, sizeof(*sum));
  for (int q = 0; q < solid->n_points; q++) {
    const double dV       = SolidPoint(solid, x, q, N, g);
    double       place[3] = {0, 0, 0}, w[3], r[3];

    if (!(dV > 0)) return 1;
    for (int i = 0; i < 3 * n; i++) place[i % 3] += N[i / 3] * x[i];
    SpinFlow(frame, place, w, r);
    for (int a = 0; a < n; a++) flow[a] = Vec3Dot(w, g + 3 * a);
    SpinAddPoint(n, dV, N, flow, r, sum);
  }
  return 0;
}
