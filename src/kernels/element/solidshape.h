/*
   Shape functions of tetrahedra, wedges and hexahedra of first and second order, and the table of solids.

   Nodes have VTK's order: corners, then edges, faces, and the middle. Natural coordinates r, s, t of a tetrahedron,
   r, s, z of a wedge and xi, eta, zeta of a hexahedron are those of quadrature.h. N[n], dN[n][3].

      tet4      N = L_a, with L = 1 - r - s - t, r, s, t;    tet10     L_a (2 L_a - 1),  4 L_a L_b
      wedge6    L_a (1 + z z_a) / 2, with L = 1 - r - s, r, s
      wedge15   L_a (2 L_a - 1)(1 + z z_a) / 2 - L_a (1 - z^2) / 2,  2 L_a L_b (1 + z z_ab),  L_a (1 - z^2)
      hex20     prod (1 + xi_k xi_ak) (sum xi_k xi_ak - 2) / 8,  and with the edge along k (1 - xi_k^2) prod (1 + ..) /
      4 hex27     products of -x (1 - x) / 2, 1 - x^2, x (1 + x) / 2

   Reference: O. C. Zienkiewicz, R. L. Taylor, J. Z. Zhu, The Finite Element Method: Its Basis and Fundamentals, 6th
   ed., 2005, chapter 4.
*/
#pragma once

#include "hex8.h"
#include "quadrature.h"
#include "solid.h"

/* Corners at the ends of the edges */
static const unsigned char tet_edge[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};

/* L_a of a tetrahedron and dL_a / d(r, s, t) */
static const double tet_slope[4][3] = {{-1, -1, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

static inline void Tet4Shape(const double xi[3], double N[], double dN[])
{
  N[0] = 1 - xi[0] - xi[1] - xi[2];
  for (int a = 0; a < 3; a++) N[a + 1] = xi[a];
  memcpy(dN, tet_slope, sizeof(tet_slope));
}

static inline void Tet10Shape(const double xi[3], double N[], double dN[])
{
  double L[4], dL[12];

  Tet4Shape(xi, L, dL);
  for (int a = 0; a < 4; a++) {
    N[a] = L[a] * (2 * L[a] - 1);
    for (int k = 0; k < 3; k++) dN[3 * a + k] = (4 * L[a] - 1) * dL[3 * a + k];
  }
  for (int e = 0; e < 6; e++) {
    const int a = tet_edge[e][0], b = tet_edge[e][1];

    N[4 + e] = 4 * L[a] * L[b];
    for (int k = 0; k < 3; k++) dN[3 * (4 + e) + k] = 4 * (dL[3 * a + k] * L[b] + L[a] * dL[3 * b + k]);
  }
}

/* Function f h of a wedge: f and its slopes df in the triangle, h[2] with dh/dz along the axis; N and dN[3] of it */
static inline void WedgeProduct(double f, const double df[2], const double h[2], double *N, double dN[3])
{
  *N    = f * h[0];
  dN[0] = df[0] * h[0];
  dN[1] = df[1] * h[0];
  dN[2] = f * h[1];
}

/* Slopes of L = 1 - r - s, r, s */
static const double triangle_slope[3][2] = {{-1, -1}, {1, 0}, {0, 1}};

static inline void Wedge6Shape(const double xi[3], double N[], double dN[])
{
  const double L[3] = {1 - xi[0] - xi[1], xi[0], xi[1]};

  for (int a = 0; a < 6; a++) {
    const double z = a < 3 ? -1 : 1, h[2] = {(1 + z * xi[2]) / 2, z / 2};

    WedgeProduct(L[a % 3], triangle_slope[a % 3], h, &N[a], &dN[3 * a]);
  }
}

static inline void Wedge15Shape(const double xi[3], double N[], double dN[])
{
  const double L[3] = {1 - xi[0] - xi[1], xi[0], xi[1]}, z = xi[2];

  for (int a = 0; a < 6; a++) { /* L (2 L - 1)(1 + z z_a) / 2 - L (1 - z^2) / 2 */
    const int    c = a % 3;
    const double s = a < 3 ? -1 : 1, l = L[c], h = (1 + s * z) / 2, full = l * (2 * l - 1), slope = 4 * l - 1;
    double       df[2];

    for (int k = 0; k < 2; k++) df[k] = triangle_slope[c][k] * (slope * h - (1 - z * z) / 2);
    N[a] = full * h - l * (1 - z * z) / 2;
    memcpy(&dN[3 * a], df, sizeof(df));
    dN[3 * a + 2] = full * s / 2 + l * z;
  }
  for (int e = 0; e < 9; e++) {
    const int    a = e % 3, b = (e + 1) % 3;
    const double s = e < 3 ? -1 : 1, ends[2] = {(1 + s * z) / 2, s / 2}, middle[2] = {1 - z * z, -2 * z};
    double       df[2];

    for (int k = 0; k < 2; k++) df[k] = 4 * (triangle_slope[a][k] * L[b] + L[a] * triangle_slope[b][k]);
    if (e < 6)
      WedgeProduct(4 * L[a] * L[b], df, ends, &N[6 + e], &dN[18 + 3 * e]);
    else
      WedgeProduct(L[a], triangle_slope[a], middle, &N[6 + e], &dN[18 + 3 * e]);
  }
}

/* Natural coordinates of the nodes of hexahedra */
static const signed char hex_node[27][3] = {
  {-1, -1, -1}, {1, -1, -1}, {1, 1, -1},  {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1},  {-1, 1, 1},  {0, -1, -1},
  {1, 0, -1},   {0, 1, -1},  {-1, 0, -1}, {0, -1, 1},  {1, 0, 1},   {0, 1, 1},  {-1, 0, 1}, {-1, -1, 0}, {1, -1, 0},
  {1, 1, 0},    {-1, 1, 0},  {-1, 0, 0},  {1, 0, 0},   {0, -1, 0},  {0, 1, 0},  {0, 0, -1}, {0, 0, 1},   {0, 0, 0}};

/* Product of three factors f, and its slopes with their derivatives d */
static inline void HexProduct(const double f[3], const double d[3], double *N, double dN[3])
{
  *N    = f[0] * f[1] * f[2];
  dN[0] = d[0] * f[1] * f[2];
  dN[1] = f[0] * d[1] * f[2];
  dN[2] = f[0] * f[1] * d[2];
}

static inline void Hex20Shape(const double xi[3], double N[], double dN[])
{
  for (int a = 0; a < 20; a++) {
    const signed char *at  = hex_node[a];
    double             sum = -2, f[3], d[3];

    for (int k = 0; k < 3; k++) {
      f[k] = at[k] ? (1 + at[k] * xi[k]) / 2 : 1 - xi[k] * xi[k];
      d[k] = at[k] ? at[k] / 2.0 : -2 * xi[k];
      sum += at[k] * xi[k];
    }
    HexProduct(f, d, &N[a], &dN[3 * a]);
    for (int k = 0; k < 3 && a < 8; k++) dN[3 * a + k] = dN[3 * a + k] * sum + N[a] * at[k];
    if (a < 8) N[a] *= sum;
  }
}

static inline void Hex27Shape(const double xi[3], double N[], double dN[])
{
  for (int a = 0; a < 27; a++) {
    const signed char *at = hex_node[a];
    double             f[3], d[3];

    for (int k = 0; k < 3; k++) {
      const double x = xi[k];

      f[k] = at[k] ? x * (x + at[k]) / 2 : 1 - x * x;
      d[k] = at[k] ? x + at[k] / 2.0 : -2 * x;
    }
    HexProduct(f, d, &N[a], &dN[3 * a]);
  }
}

/* Twice the natural coordinates of the nodes of tetrahedra and wedges */
static const signed char tet_node[10][3]   = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {1, 0, 0},
                                              {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
static const signed char wedge_node[15][3] = {{0, 0, -2}, {2, 0, -2}, {0, 2, -2}, {0, 0, 2},  {2, 0, 2},
                                              {0, 2, 2},  {1, 0, -2}, {1, 1, -2}, {0, 1, -2}, {1, 0, 2},
                                              {1, 1, 2},  {0, 1, 2},  {0, 0, 0},  {2, 0, 0},  {0, 2, 0}};

static const Solid solid_tet4    = {4, 4, Tet4Shape, quadrature_tet4, 1.0 / 6, tet_node, 0.5};
static const Solid solid_tet10   = {10, 15, Tet10Shape, quadrature_tet15, 1.0 / 6, tet_node, 0.5};
static const Solid solid_wedge6  = {6, 6, Wedge6Shape, quadrature_wedge6, 1, wedge_node, 0.5};
static const Solid solid_wedge15 = {15, 21, Wedge15Shape, quadrature_wedge21, 1, wedge_node, 0.5};
static const Solid solid_hex8    = {8, 8, Hex8Shape, quadrature_hex8, 8, hex_node, 1};
static const Solid solid_hex20   = {20, 27, Hex20Shape, quadrature_hex27, 8, hex_node, 1};
static const Solid solid_hex27   = {27, 27, Hex27Shape, quadrature_hex27, 8, hex_node, 1};
