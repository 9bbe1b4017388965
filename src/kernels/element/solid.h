/*
   Isoparametric solid: stiffness, consistent mass, geometric stiffness, volume and quality of an element that is given
   by its shape functions and its quadrature (solidshape.h, quadrature.h).

   Positions x in m, row-major [n][3]; matrices [3n][3n] row-major, unknowns x, y, z of node 0, then of node 1, and so
   on. With the tangents t_k = dx/dxi_k the Jacobian is j = t_0 . (t_1 x t_2), and its cofactors c_0 = t_1 x t_2,
   c_1 = t_2 x t_0, c_2 = t_0 x t_1 give grad N = sum_k c_k dN/dxi_k / j.

      K_ab = int grad N_a . C . grad N_b dV (N/m, stiffness.h),  M_ab = rho int N_a N_b dV (kg),
      k_ab = int grad N_a . sigma . grad N_b dV times the 3 x 3 identity (N/m), sigma the stress of u
      (kernels/element/geometric.h)

   Affine images of the reference are integrated exactly. Of any shape the volume and int grad N dV, hence the patch
   test, are exact.

   Reference: O. C. Zienkiewicz, R. L. Taylor, J. Z. Zhu, The Finite Element Method: Its Basis and Fundamentals, 6th
   ed., 2005, chapters 4 and 5.
*/
#pragma once

#include "base/algebra/vec3.h"
#include "stiffness.h"
#include <math.h>
#include <string.h>
#include <squeal/elasticity.h>

#define SOLID_MAX_NODES 27
#define SOLID_MAX_DOFS  (3 * SOLID_MAX_NODES)

/* Shape functions N[n] and their derivatives dN[n][3] at natural coordinates xi; quadrature points xi, eta, zeta with
   their weights; natural coordinates of the nodes in units */
struct Solid {
  int n_nodes, n_points;
  void (*shape)(const double xi[3], double N[], double dN[]);
  const double (*point)[4];
  double volume;                /* of the reference element */
  const signed char (*node)[3]; /* in units of `unit` */
  double unit;
};

typedef struct Solid Solid;

/* Jacobian j (m^3 per unit of the reference) and cofactors c[k][i] (m^2) */
static inline double SolidJacobian(int n, const double *x, const double *dN, double c[9])
{
  double t[9] = {0};

  for (int a = 0; a < n; a++)
    for (int k = 0; k < 3; k++)
      for (int i = 0; i < 3; i++) t[3 * k + i] += dN[3 * a + k] * x[3 * a + i];
  Vec3Cross(t + 3, t + 6, c);
  Vec3Cross(t + 6, t, c + 3);
  Vec3Cross(t, t + 3, c + 6);
  return Vec3Dot(t, c);
}

/* Shape functions N[n], their gradients g[n][3] (1/m) and the volume (m^3) of quadrature point q; not positive where
   the element is inverted: then g is not written */
static inline double SolidPoint(const Solid *s, const double *x, int q, double N[], double g[])
{
  double dN[SOLID_MAX_DOFS], c[9], j;

  s->shape(s->point[q], N, dN);
  j = SolidJacobian(s->n_nodes, x, dN, c);
  if (!(j > 0)) return j;
  for (int a = 0; a < s->n_nodes; a++)
    for (int i = 0; i < 3; i++)
      g[3 * a + i] = (c[i] * dN[3 * a] + c[3 + i] * dN[3 * a + 1] + c[6 + i] * dN[3 * a + 2]) / j;
  return j * s->point[q][3];
}

/* Adds w v v' to the upper block triangle of a [n][n] */
static inline void SolidAddProduct(int n, double w, const double v[], double *a)
{
  for (int r = 0; r < n; r++) {
    const double wv = w * v[r];

    for (int s = r - r % 3; s < n; s++) a[r * n + s] += wv * v[s];
  }
}

/* Consistent mass (kg) from the products [n][n] (m^3), of which the upper triangle is filled */
static inline void SolidMass(int n, double density, const double *products, double *mass)
{
  memset(mass, 0, sizeof(double) * 9 * (size_t)n * (size_t)n);
  for (int a = 0; a < n; a++)
    for (int b = 0; b < n; b++)
      for (int i = 0; i < 3; i++)
        mass[3 * n * (3 * a + i) + 3 * b + i] = density * (a < b ? products[a * n + b] : products[b * n + a]);
}

/* Copies the upper block triangle of a [n][n] into the lower one */
static inline void SolidMirror(int n, double *a)
{
  for (int r = 0; r < n; r++)
    for (int s = 0; s < r; s++) a[r * n + s] = a[s * n + r];
}

/*
   SolidMatrices - stiffness (N/m) and consistent mass (kg)

   Input Parameters:
+  solid    - shape functions and quadrature
.  x        - positions of the nodes, [n][3], m
-  material - elasticity, Pa, and density, kg/m^3

   Output Parameters:
+  stiffness - [3n][3n]
-  mass      - [3n][3n]

   Returns 0, or 1 when the Jacobian is not positive at a quadrature point; then nothing is written.
*/
static inline int SolidMatrices(const Solid *solid, const double *x, const Elasticity *material, double *stiffness,
                                double *mass)
{
  const int n = solid->n_nodes;
  double    gradients[SOLID_MAX_DOFS * SOLID_MAX_DOFS];  /* int of the products of the components of gradients */
  double    products[SOLID_MAX_NODES * SOLID_MAX_NODES]; /* int N_a N_b dV, m^3 */
  double    N[SOLID_MAX_NODES], g[SOLID_MAX_DOFS];

  memset(gradients, 0, sizeof(double) * 9 * (size_t)n * (size_t)n);
  memset(products, 0, sizeof(double) * (size_t)n * (size_t)n);
  for (int q = 0; q < solid->n_points; q++) {
    const double dV = SolidPoint(solid, x, q, N, g);

    if (!(dV > 0)) return 1;
    SolidAddProduct(3 * n, dV, g, gradients);
    for (int a = 0; a < n; a++)
      for (int b = a; b < n; b++) products[a * n + b] += dV * N[a] * N[b];
  }
  StiffnessFromGradients(n, material, gradients, 3 * n, stiffness);
  SolidMirror(3 * n, stiffness);
  SolidMass(n, material->density, products, mass);
  return 0;
}

/* Geometric stiffness [3n][3n] of the stress of displacements u[n][3] (m); returns as SolidMatrices() */
static inline int SolidGeometric(const Solid *solid, const double *x, const Elasticity *material, const double *u,
                                 double *stiffness)
{
  const int n                                    = solid->n_nodes;
  double    k[SOLID_MAX_NODES * SOLID_MAX_NODES] = {0}, N[SOLID_MAX_NODES], g[SOLID_MAX_DOFS];

  for (int q = 0; q < solid->n_points; q++) {
    const double dV      = SolidPoint(solid, x, q, N, g);
    double       H[3][3] = {{0}}, stress[3][3];

    if (!(dV > 0)) return 1;
    for (int a = 0; a < n; a++)
      for (int i = 0; i < 3; i++)
        for (int l = 0; l < 3; l++) H[i][l] += u[3 * a + i] * g[3 * a + l];
    StressFromGradient(material, H, stress);
    for (int a = 0; a < n; a++) {
      double traction[3] = {0, 0, 0};

      for (int i = 0; i < 3; i++)
        for (int l = 0; l < 3; l++) traction[l] += dV * g[3 * a + i] * stress[i][l];
      for (int b = 0; b < n; b++) k[a * n + b] += Vec3Dot(traction, &g[3 * b]);
    }
  }
  memset(stiffness, 0, sizeof(double) * 9 * (size_t)n * (size_t)n);
  for (int r = 0; r < 3 * n; r++)
    for (int b = 0; b < n; b++) stiffness[3 * n * r + 3 * b + r % 3] = k[r / 3 * n + b];
  return 0;
}

/* Volume of the axis-parallel box around the nodes, m^3 */
static inline double SolidBoxVolume(int n, const double *x)
{
  double volume = 1;

  for (int i = 0; i < 3; i++) {
    double low = x[i], high = x[i];

    for (int a = 1; a < n; a++) {
      low  = fmin(low, x[3 * a + i]);
      high = fmax(high, x[3 * a + i]);
    }
    volume *= high - low;
  }
  return volume;
}

/*
   SolidMeasure - volume (m^3) and the smallest Jacobian over quadrature points and nodes, times the volume of the
   reference and divided by that of the bounding box: 1 for a box along the axes, not positive for an inverted element,
   0 for a flat one
*/
static inline void SolidMeasure(const Solid *solid, const double *x, double *volume, double *min_jacobian)
{
  const double box      = SolidBoxVolume(solid->n_nodes, x);
  double       smallest = HUGE_VAL, N[SOLID_MAX_NODES], dN[SOLID_MAX_DOFS], c[9];

  *volume = 0;
  for (int q = 0; q < solid->n_points; q++) {
    double j;

    solid->shape(solid->point[q], N, dN);
    j        = SolidJacobian(solid->n_nodes, x, dN, c);
    smallest = fmin(smallest, j);
    *volume += j * solid->point[q][3];
  }
  for (int a = 0; a < solid->n_nodes; a++) {
    double xi[3];

    for (int k = 0; k < 3; k++) xi[k] = solid->unit * solid->node[a][k];
    solid->shape(xi, N, dN);
    smallest = fmin(smallest, SolidJacobian(solid->n_nodes, x, dN, c));
  }
  *min_jacobian = box > 0 ? solid->volume * smallest / box : 0;
}
