/*
   Eight-node hexahedron: stiffness, consistent mass, volume and quality.

   Nodes 0..3 are the face zeta = -1, counter-clockwise seen from +zeta; nodes 4..7 lie above them. Positions x in m,
   row-major [8][3]; matrices [24][24] row-major, unknowns x, y, z of node 0, then of node 1, and so on.

   Trilinear functions N_a = (1 + xi xi_a)(1 + eta eta_a)(1 + zeta zeta_a) / 8. With the tangents t_k = dx/dxi_k the
   Jacobian is j = t_0 . (t_1 x t_2), and its cofactors c_0 = t_1 x t_2, c_1 = t_2 x t_0, c_2 = t_0 x t_1 give
   grad N = sum_k c_k dN/dxi_k / j.

   Incompatible modes (QM6): displacements gain the bubbles 1 - xi_k^2, three per direction, that belong to one element
   and are condensed statically. Taylor's gradients use the Jacobian of the centre, (j_0/j) J_0^-T, that is
   c_k(0) (-2 xi_k) / j: they integrate to zero over any element, so constant stress does no work on the bubbles and
   the patch test holds. Bubbles carry no mass.

   Quadrature 2 x 2 x 2 Gauss: exact for parallelepipeds; for any shape exact for volume, centre of mass and row sums
   of the mass.

   References: Wilson, Taylor, Doherty, Ghaboussi, Incompatible displacement models, 1973; Taylor, Beresford, Wilson, A
   non-conforming element for stress analysis, IJNME 10, 1976.
*/
#pragma once

#include "solid.h"
#include <math.h>

#define HEX8_NODES   8
#define HEX8_DOFS    24
#define HEX8_BUBBLES 3
#define HEX8_ALL     (HEX8_DOFS + 3 * HEX8_BUBBLES) /* unknowns before condensation, bubbles first */
#define HEX8_GAUSS   0.57735026918962576451         /* 1 / sqrt(3) */

/* Signs of xi, eta, zeta at the nodes */
static const double hex8_sign[HEX8_NODES][3] = {{-1, -1, -1}, {+1, -1, -1}, {+1, +1, -1}, {-1, +1, -1},
                                                {-1, -1, +1}, {+1, -1, +1}, {+1, +1, +1}, {-1, +1, +1}};

/* Integrals over an element; only the upper triangles (of 3 x 3 blocks for the gradients) are filled */
typedef struct {
  double gradients[HEX8_ALL][HEX8_ALL];    /* of the products of the components of all gradients, m */
  double products[HEX8_NODES][HEX8_NODES]; /* of N_a N_b, m^3 */
} Hex8Integrals;

/* Point of the reference cube in the direction of node q, at `scale` times the distance of that node */
static inline void Hex8Point(int q, double scale, double xi[3])
{
  for (int k = 0; k < 3; k++) xi[k] = scale * hex8_sign[q][k];
}

/* Shape functions N[8] and their derivatives dN[8][3] in xi */
static inline void Hex8Shape(const double xi[3], double N[HEX8_NODES], double dN[HEX8_DOFS])
{
  for (int a = 0; a < HEX8_NODES; a++) {
    const double *s = hex8_sign[a];
    const double  f = 1 + s[0] * xi[0], g = 1 + s[1] * xi[1], h = 1 + s[2] * xi[2];

    N[a]          = f * g * h / 8;
    dN[3 * a]     = s[0] * g * h / 8;
    dN[3 * a + 1] = s[1] * f * h / 8;
    dN[3 * a + 2] = s[2] * f * g / 8;
  }
}

/* j times the gradients, g[3 (n_bubbles + 8)]: bubbles with the centre's cofactors c0, then shape functions with c */
static inline void Hex8Gradients(int n_bubbles, const double xi[3], const double dN[HEX8_DOFS], const double c0[9],
                                 const double c[9], double g[HEX8_ALL])
{
  for (int k = 0; k < n_bubbles; k++) {
    for (int i = 0; i < 3; i++) g[3 * k + i] = -2 * xi[k] * c0[3 * k + i];
  }
  for (int a = 0; a < HEX8_NODES; a++) {
    const double *d = dN + 3 * a;

    for (int i = 0; i < 3; i++) g[3 * (n_bubbles + a) + i] = c[i] * d[0] + c[3 + i] * d[1] + c[6 + i] * d[2];
  }
}

/* Adds w v v' to the upper block triangle of a */
static inline void Hex8AddProduct(int n, double w, const double v[], double a[HEX8_ALL][HEX8_ALL])
{
  for (int r = 0; r < n; r++) {
    const double wv = w * v[r];

    for (int s = r - r % 3; s < n; s++) a[r][s] += wv * v[s];
  }
}

/* Integrals of n_bubbles + 8 functions; 1 when the Jacobian is not positive at the centre or a Gauss point */
static inline int Hex8Integrate(const double *x, int n_bubbles, Hex8Integrals *sum)
{
  double xi[3] = {0, 0, 0}, N[HEX8_NODES], dN[HEX8_DOFS], c0[9], c[9], g[HEX8_ALL];

  memset(sum, 0, sizeof(*sum));
  Hex8Shape(xi, N, dN);
  if (!(SolidJacobian(HEX8_NODES, x, dN, c0) > 0)) return 1;
  for (int q = 0; q < 8; q++) {
    double j;

    Hex8Point(q, HEX8_GAUSS, xi);
    Hex8Shape(xi, N, dN);
    j = SolidJacobian(HEX8_NODES, x, dN, c);
    if (!(j > 0)) return 1;
    Hex8Gradients(n_bubbles, xi, dN, c0, c, g);
    Hex8AddProduct(3 * (n_bubbles + HEX8_NODES), 1 / j, g, sum->gradients); /* (g/j) (g/j)' j */
    for (int a = 0; a < HEX8_NODES; a++) {
      for (int b = a; b < HEX8_NODES; b++) sum->products[a][b] += j * N[a] * N[b];
    }
  }
  return 0;
}

/* Stiffness of n functions from the integrals of the products of their gradients, upper block triangle */
static inline void Hex8Stiffness(int n, const Elasticity *material, double G[HEX8_ALL][HEX8_ALL],
                                 double K[HEX8_ALL][HEX8_ALL])
{
  StiffnessFromGradients(n, material, &G[0][0], HEX8_ALL, &K[0][0]);
}

/* Eliminates the first n_first unknowns of symmetric positive K, upper triangle: leaves K_22 - K_21 K_11^-1 K_12 */
static inline void Hex8Condense(int n_first, int n, double K[HEX8_ALL][HEX8_ALL])
{
  for (int p = 0; p < n_first; p++) {
    const double pivot = 1 / K[p][p];

    for (int r = p + 1; r < n; r++) {
      const double factor = pivot * K[p][r];

      for (int s = r; s < n; s++) K[r][s] -= factor * K[p][s];
    }
  }
}

/* Consistent mass (kg): density int N_a N_b dV times the 3 x 3 identity */
static inline void Hex8Mass(double density, double products[HEX8_NODES][HEX8_NODES], double *mass)
{
  memset(mass, 0, sizeof(double) * HEX8_DOFS * HEX8_DOFS);
  for (int a = 0; a < HEX8_NODES; a++) {
    for (int b = 0; b < HEX8_NODES; b++) {
      const double m = density * (a < b ? products[a][b] : products[b][a]);

      for (int i = 0; i < 3; i++) mass[HEX8_DOFS * (3 * a + i) + 3 * b + i] = m;
    }
  }
}

/* Stiffness and mass with n_bubbles condensed; returns 1 and writes nothing when the Jacobian is not positive */
static inline int Hex8Matrices(const double *x, const Elasticity *material, int n_bubbles, double *stiffness,
                               double *mass)
{
  const int     first = 3 * n_bubbles, n = first + HEX8_DOFS;
  Hex8Integrals sum;
  double        K[HEX8_ALL][HEX8_ALL];

  if (Hex8Integrate(x, n_bubbles, &sum)) return 1;
  Hex8Stiffness(n_bubbles + HEX8_NODES, material, sum.gradients, K);
  Hex8Condense(first, n, K);
  for (int r = 0; r < HEX8_DOFS; r++) {
    for (int s = r; s < HEX8_DOFS; s++) {
      stiffness[HEX8_DOFS * r + s] = K[first + r][first + s];
      stiffness[HEX8_DOFS * s + r] = K[first + r][first + s];
    }
  }
  Hex8Mass(material->density, sum.products, mass);
  return 0;
}

/*
   Hex8IncompatibleMatrices - stiffness (N/m) and consistent mass (kg) with incompatible modes, QM6

   Input Parameters:
+  solid    - not used
.  x        - positions of the nodes, [8][3], m
-  material - stiffness, Pa, and density, kg/m^3

   Output Parameters:
+  stiffness - [24][24]
-  mass      - [24][24]

   Returns 0, or 1 when the Jacobian is not positive at the centre or a Gauss point; then nothing is written.
*/
static inline int Hex8IncompatibleMatrices(const Solid *solid, const double *x, const Elasticity *material,
                                           double *stiffness, double *mass)
{
  (void)solid;
  return Hex8Matrices(x, material, HEX8_BUBBLES, stiffness, mass);
}

/* Hex8FullMatrices - the same for the fully integrated trilinear element, which is too stiff in bending */
static inline int Hex8FullMatrices(const Solid *solid, const double *x, const Elasticity *material, double *stiffness,
                                   double *mass)
{
  (void)solid;
  return Hex8Matrices(x, material, 0, stiffness, mass);
}

/*
   Hex8Measure - volume (m^3) and the smallest Jacobian over Gauss points and nodes, as eight times j divided by the
   volume of the bounding box: 1 for a box along the axes, not positive for an inverted element, 0 for a flat box
*/
static inline void Hex8Measure(const Solid *solid, const double *x, double *volume, double *min_jacobian)
{
  const double box      = SolidBoxVolume(HEX8_NODES, x);
  double       smallest = HUGE_VAL, xi[3], N[HEX8_NODES], dN[HEX8_DOFS], c[9];

  (void)solid;
  *volume = 0;
  for (int q = 0; q < HEX8_NODES; q++) {
    double at_gauss, at_node;

    Hex8Point(q, HEX8_GAUSS, xi);
    Hex8Shape(xi, N, dN);
    at_gauss = SolidJacobian(HEX8_NODES, x, dN, c);
    Hex8Shape(hex8_sign[q], N, dN);
    at_node  = SolidJacobian(HEX8_NODES, x, dN, c);
    smallest = fmin(smallest, fmin(at_gauss, at_node));
    *volume += at_gauss;
  }
  *min_jacobian = box > 0 ? 8 * smallest / box : 0;
}
