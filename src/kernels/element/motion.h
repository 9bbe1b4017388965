/*
   Motion - the rigid motion that takes one face of a hexahedron to the opposite one: a shift along a coordinate axis,
   or a turn about a line parallel to one; MotionDirection() finds the axis of any other.

   With p_i -> q_i, i = 0..3, along the edges between the two faces, in the plane across the axis e: the angle phi of
   the turn is that from p_j - p_0 to q_j - q_0, j the farthest from 0, and its centre
      c = (p_0 + q_0)/2 + e x (q_0 - p_0) / (2 tan(phi/2)),
   rounded to thirteen decimals of the size of the body, so that a centre at the origin is exactly there, and the cells
   of an arc have the same centre whichever of them is asked. Lengths in m, angles in rad.

   An axis of any direction is that of the turn R with R (p_j - p_0) = q_j - q_0: with a = p_1 - p_0, b = p_2 - p_0,
   n = a x b, their images a', b', n', and the dual vectors A = b x n / n.n, B = n x a / n.n, N = n / n.n
      R = a' A' + b' B' + n' N',   A x a' + B x b' + N x n' = 2 sin(phi) e;
   without a turn it is that of q_0 - p_0. In coordinates with e among them Motion then is as above.
*/
#pragma once

#include "base/algebra/vec3.h"

#define MOTION_PAIRS       3    /* pairs of opposite faces */
#define MOTION_LEAST_ANGLE 1e-6 /* a smaller turn is taken for a shift */
#define MOTION_DECIMALS    13   /* of the centre, relative to the size */
#define MOTION_EDGES       4    /* edges between opposite faces */

typedef struct {
  int    turned, axis; /* axis 0, 1, 2 for x, y, z */
  double centre[3];    /* 0 along the axis, and for a shift */
} Motion;

/* Corners that edges join in the three directions of a hexahedron, bottom and top counter-clockwise */
static const int motion_hex8_edge[MOTION_PAIRS][MOTION_EDGES][2] = {
  {{0, 1}, {3, 2}, {4, 5}, {7, 6}}, {{0, 3}, {1, 2}, {4, 7}, {5, 6}}, {{0, 4}, {1, 5}, {2, 6}, {3, 7}}};

/* The point at the end of edge i in this direction */
static inline const double *MotionPoint(const double x[8][3], int pair, int i, int end)
{
  return x[motion_hex8_edge[pair][i][end]];
}

/* Whether all four points go by the same distance along the axis, and nowhere else */
static inline int MotionIsShift(const double x[8][3], int pair, int axis, double tolerance)
{
  const double length = MotionPoint(x, pair, 0, 1)[axis] - MotionPoint(x, pair, 0, 0)[axis];
  int          holds  = fabs(length) > tolerance;

  for (int i = 0; i < MOTION_EDGES; i++) {
    const double *p = MotionPoint(x, pair, i, 0), *q = MotionPoint(x, pair, i, 1);

    for (int d = 0; d < 3; d++) holds = holds && fabs(q[d] - p[d] - (d == axis ? length : 0)) <= tolerance;
  }
  return holds;
}

/* Rounds to MOTION_DECIMALS decimals of the power of ten next above the size; not at all for 0 */
static inline double MotionRound(double x, double size)
{
  const double decimals = size > 0 ? pow(10, MOTION_DECIMALS - ceil(log10(size))) : 0;

  return size > 0 ? round(x * decimals) / decimals : x;
}

/* Unit vector along the axis of the motion between the two faces of a pair; 0 where the faces have no area */
static inline int MotionDirection(const double x[8][3], int pair, double direction[3])
{
  double side[2][3][3], dual[3][3], twice[3] = {0, 0, 0}, area;

  for (int end = 0; end < 2; end++) {
    for (int i = 0; i < 2; i++)
      for (int d = 0; d < 3; d++)
        side[end][i][d] = MotionPoint(x, pair, i + 1, end)[d] - MotionPoint(x, pair, 0, end)[d];
    Vec3Cross(side[end][0], side[end][1], side[end][2]);
  }
  area = Vec3Dot(side[0][2], side[0][2]);
  if (!(area > 0)) return 0;
  Vec3Cross(side[0][1], side[0][2], dual[0]);
  Vec3Cross(side[0][2], side[0][0], dual[1]);
  for (int d = 0; d < 3; d++) dual[2][d] = side[0][2][d];
  for (int i = 0; i < 3; i++) {
    double part[3];

    Vec3Cross(dual[i], side[1][i], part);
    for (int d = 0; d < 3; d++) twice[d] += part[d] / area;
  }
  for (int d = 0; d < 3; d++)
    direction[d] = Vec3Length(twice) > 2 * MOTION_LEAST_ANGLE
                     ? twice[d]
                     : MotionPoint(x, pair, 0, 1)[d] - MotionPoint(x, pair, 0, 0)[d];
  return Vec3Normalise(direction) > 0;
}

/* Point of the edge, of the four, whose begin is farthest from that of edge 0 across the axis */
static inline int MotionFarthest(const double x[8][3], int pair, int a, int b)
{
  const double *first = MotionPoint(x, pair, 0, 0);
  double        most  = 0;
  int           j     = 0;

  for (int i = 1; i < MOTION_EDGES; i++) {
    const double *p        = MotionPoint(x, pair, i, 0);
    const double  distance = hypot(p[a] - first[a], p[b] - first[b]);

    if (distance <= most) continue;
    most = distance;
    j    = i;
  }
  return j;
}

/* Centre of the turn about the axis, rounded for a size that is not 0; whether it takes all four points to their
   partners' distance and height */
static inline int MotionIsTurn(const double x[8][3], int pair, int axis, double size, double tolerance,
                               double centre[3])
{
  const int     a = (axis + 1) % 3, b = (axis + 2) % 3, j = MotionFarthest(x, pair, a, b);
  const double *p = MotionPoint(x, pair, 0, 0), *q = MotionPoint(x, pair, 0, 1);
  const double *pj = MotionPoint(x, pair, j, 0), *qj = MotionPoint(x, pair, j, 1);
  const double  from[2] = {pj[a] - p[a], pj[b] - p[b]}, to[2] = {qj[a] - q[a], qj[b] - q[b]};
  const double  phi = atan2(from[0] * to[1] - from[1] * to[0], from[0] * to[0] + from[1] * to[1]);
  int           holds;

  if (!(fabs(phi) > MOTION_LEAST_ANGLE)) return 0;
  centre[axis] = 0;
  centre[a]    = MotionRound(0.5 * (p[a] + q[a]) - (q[b] - p[b]) / (2 * tan(0.5 * phi)), size);
  centre[b]    = MotionRound(0.5 * (p[b] + q[b]) + (q[a] - p[a]) / (2 * tan(0.5 * phi)), size);
  holds        = 1;
  for (int i = 0; i < MOTION_EDGES; i++) {
    const double *from_i = MotionPoint(x, pair, i, 0), *to_i = MotionPoint(x, pair, i, 1);
    const double  r0 = hypot(from_i[a] - centre[a], from_i[b] - centre[b]);
    const double  r1 = hypot(to_i[a] - centre[a], to_i[b] - centre[b]);

    holds = holds && fabs(to_i[axis] - from_i[axis]) <= tolerance && fabs(r1 - r0) <= tolerance;
  }
  return holds;
}

/*
   MotionFind - the motion between the two faces of one pair of a hexahedron with corners x (m); 0 where there is none.

   size is that of the body, tolerance the largest error of a place, m. MotionFindAlong() asks one axis alone, and does
   not round the centre where size is 0.
*/
static inline int MotionFindAlong(const double x[8][3], int pair, int axis, double size, double tolerance,
                                  Motion *motion)
{
  *motion = (Motion){.turned = 0, .axis = axis};
  if (MotionIsShift(x, pair, axis, tolerance)) return 1;
  motion->turned = 1;
  return MotionIsTurn(x, pair, axis, size, tolerance, motion->centre);
}

static inline int MotionFind(const double x[8][3], int pair, double size, double tolerance, Motion *motion)
{
  for (int axis = 0; axis < 3; axis++)
    if (MotionFindAlong(x, pair, axis, size, tolerance, motion)) return 1;
  return 0;
}
