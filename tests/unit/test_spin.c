/*
   Unit tests of kernels/element/spin.h on single elements: fields that the shape functions hold exactly, against integrals over a
   box by a rule of order 9. The box stands beside the axis, so that nothing vanishes.
*/
#include "kernels/element/solidshape.h"
#include "kernels/element/spin.h"
#include "check.h"

static const SpinFrame frame = {
  {1.0 / 3, 2.0 / 3, 2.0 / 3},
  {0.2,     -0.1,    0.3    }
};
static const double low[3] = {1, 0.5, -0.3}, size[3] = {0.3, 0.2, 0.5};

/* Gauss' rule of five points on [0, 1] */
static const double points[5]  = {0.046910077030668, 0.230765344947158, 0.5, 0.769234655052842, 0.953089922969332};
static const double weights[5] = {0.118463442528095, 0.239314335249683, 0.284444444444444, 0.239314335249683,
                                  0.118463442528095};

/* Scalar fields u = p . x + p_3 x_0 x_1, which a trilinear function holds in a box along the axes */
static double Field(const double p[4], const double x[3])
{
  return Vec3Dot(p, x) + p[3] * x[0] * x[1];
}

/* w . grad u, and r in the direction d */
static double Flow(const double p[4], const double x[3], double r[3])
{
  const double grad[3] = {p[0] + p[3] * x[1], p[1] + p[3] * x[0], p[2]};
  double       w[3], d[3], along = 0;

  for (int k = 0; k < 3; k++) d[k] = x[k] - frame.centre[k];
  for (int k = 0; k < 3; k++) along += frame.axis[k] * d[k];
  for (int k = 0; k < 3; k++) r[k] = d[k] - along * frame.axis[k];
  w[0] = frame.axis[1] * d[2] - frame.axis[2] * d[1];
  w[1] = frame.axis[2] * d[0] - frame.axis[0] * d[2];
  w[2] = frame.axis[0] * d[1] - frame.axis[1] * d[0];
  return Vec3Dot(w, grad);
}

/* int v w . grad u - u w . grad v, int (w . grad v)(w . grad u), int v r over the box */
static void Exact(const double p[4], const double q[4], double exact[5])
{
  for (int k = 0; k < 5; k++) exact[k] = 0;
  for (int i = 0; i < 125; i++) {
    const int at[3] = {i / 25, i / 5 % 5, i % 5};
    double    x[3], r[3], dV = 1, v, u, dv, du;

    for (int d = 0; d < 3; d++) {
      x[d] = low[d] + size[d] * points[at[d]];
      dV *= size[d] * weights[at[d]];
    }
    u  = Field(p, x);
    v  = Field(q, x);
    du = Flow(p, x, r);
    dv = Flow(q, x, r);
    exact[0] += dV * (v * du - u * dv);
    exact[1] += dV * du * dv;
    for (int d = 0; d < 3; d++) exact[2 + d] += dV * v * r[d];
  }
}

/* mixed: of the products in the fields. Breaks when: e x (x - c) has the other sign, the axis is not taken off r, or a
   factor of two is lost */
static int TestBox(const char name[], const Solid *solid, const double *x, double mixed)
{
  const double         p[4] = {0.3, -1.2, 0.7, mixed}, q[4] = {0.8, 0.5, 2, -mixed};
  double               exact[5], sum[5] = {0}, error = 0, scale = 0, skew = 0;
  static SpinIntegrals integrals;
  const int            n      = solid->n_nodes;
  int                  failed = SpinIntegrate(solid, &frame, x, &integrals);

  Exact(p, q, exact);
  for (int a = 0; a < n; a++) {
    for (int b = 0; b < n; b++) {
      const double vu = Field(q, x + 3 * a) * Field(p, x + 3 * b);

      sum[0] += vu * integrals.gyroscopic[a * n + b];
      sum[1] += vu * integrals.convective[a * n + b];
      skew = fmax(skew, fabs(integrals.gyroscopic[a * n + b] + integrals.gyroscopic[b * n + a]));
      skew = fmax(skew, fabs(integrals.convective[a * n + b] - integrals.convective[b * n + a]));
    }
    for (int d = 0; d < 3; d++) sum[2 + d] += Field(q, x + 3 * a) * integrals.load[3 * a + d];
  }
  for (int k = 0; k < 5; k++) scale = fmax(scale, fabs(exact[k]));
  for (int k = 0; k < 5; k++) error = fmax(error, fabs(sum[k] - exact[k]) / scale);
  printf("%s\n", name);
  failed += CheckClose("forms of two fields, load, relative", error, 0, 1e-13);
  return failed + CheckClose("skew and symmetric, m^3", skew, 0, 1e-15);
}

int main(void)
{
  double           x[SOLID_MAX_DOFS];
  static const int mid[12][2] = {
    {0, 1},
    {1, 2},
    {2, 3},
    {3, 0},
    {4, 5},
    {5, 6},
    {6, 7},
    {7, 4},
    {0, 4},
    {1, 5},
    {2, 6},
    {3, 7}
  };
  int failed = 0;

  for (int i = 0; i < 24; i++) x[i] = low[i % 3] + size[i % 3] * (hex8_sign[i / 3][i % 3] + 1) / 2;
  for (int i = 0; i < 36; i++) x[24 + i] = (x[3 * mid[i / 3][0] + i % 3] + x[3 * mid[i / 3][1] + i % 3]) / 2;
  failed += TestBox("hex8, whose rule holds linear fields", &solid_hex8, x, 0);
  failed += TestBox("hex20", &solid_hex20, x, 1);
  return failed != 0;
}
