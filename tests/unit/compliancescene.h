/*
   Made problems of contact on a dense compliance, and their laws written out: r = q + W lambda, no slip to begin with.
   Lengths and forces are of order 1.
*/
#pragma once

#include "contact/compliance/compliance.h"
#include <math.h>
#include <stdint.h>

#define SCENE_MOST 60 /* pairs */

typedef struct {
  PetscInt   n;
  PetscReal *W, *q, *slip0, *mu; /* [3n][3n], [n][3], [n][2], [n] */
  uint64_t   seed;
} ComplianceScene;

/* In [-1, 1); M. O'Neill's multiplier, upper bits */
static inline PetscReal SceneDraw(ComplianceScene *s)
{
  s->seed = s->seed * 6364136223846793005u + 1442695040888963407u;
  return (PetscReal)(s->seed >> 11) / 4503599627370496.0 - 1;
}

static inline PetscErrorCode SceneCreate(PetscInt n, uint64_t seed, ComplianceScene *s)
{
  PetscFunctionBeginUser;
  *s = (ComplianceScene){.n = n, .seed = seed * 2654435761u + 12345};
  for (int k = 0; k < 8; k++) (void)SceneDraw(s);
  PetscCall(PetscCalloc4(9 * n * n, &s->W, 3 * n, &s->q, 2 * n, &s->slip0, n, &s->mu));
  PetscFunctionReturn(0);
}

/* Coulomb's law of n pairs, with slopes (s/m) about speeds (m/s) or NULL without */
static inline PetscErrorCode SceneSetFriction(ContactCompliance c, PetscInt n, const PetscReal mu[], const PetscReal slope[],
                                              const PetscReal speed[], PetscReal dt)
{
  FrictionLaw *law;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &law));
  for (PetscInt p = 0; p < n; p++) {
    law[p].speed        = speed ? speed[p] : 0;
    law[p].parameter[0] = mu[p];
    law[p].parameter[1] = slope ? slope[p] : 0;
  }
  PetscCall(ContactComplianceSetFriction(c, law, dt));
  PetscCall(PetscFree(law));
  PetscFunctionReturn(0);
}

static inline PetscErrorCode SceneDestroy(ComplianceScene *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree4(s->W, s->q, s->slip0, s->mu));
  PetscFunctionReturn(0);
}

/* W += size * sum of `rank` random vectors' squares, each of `rows` entries from the first on; normals' by `normal` */
static inline void SceneAddRandom(ComplianceScene *s, PetscInt rank, PetscReal size, PetscReal normal)
{
  const PetscInt N = 3 * s->n;
  PetscReal      x[3 * SCENE_MOST];

  for (PetscInt k = 0; k < rank; k++) {
    for (PetscInt i = 0; i < N; i++) x[i] = SceneDraw(s) * (i % 3 ? 1 : normal);
    for (PetscInt i = 0; i < N; i++)
      for (PetscInt j = 0; j < N; j++) s->W[i * N + j] += size * x[i] * x[j] / rank;
  }
}

/* Elastic half-space on a rigid one: Boussinesq's and Cerruti's displacements of n points of a square grid, spacing 1,
   a load being spread over `radius` (r^2 + radius^2 for r^2); nu = 0.3, (1 + nu) / (pi E) = 1 */
static inline void SceneAddHalfSpace(ComplianceScene *s, PetscReal size, PetscReal radius)
{
  const PetscInt  N = 3 * s->n, side = (PetscInt)ceil(sqrt((double)s->n));
  const PetscReal nu = 0.3;

  for (PetscInt a = 0; a < s->n; a++)
    for (PetscInt b = 0; b < s->n; b++) {
      const PetscReal x = (PetscReal)(a % side - b % side), y = (PetscReal)(a / side - b / side);
      const PetscReal r = sqrt(x * x + y * y + radius * radius), skew = (1 - 2 * nu) / 2 / (r * r);
      const PetscReal U[3][3] = {
        {(1 - nu) / r, skew * x,                                skew * y                               },
        {-skew * x,    (1 - nu) / r + nu * x * x / (r * r * r), nu * x * y / (r * r * r)               },
        {-skew * y,    nu * x * y / (r * r * r),                (1 - nu) / r + nu * y * y / (r * r * r)}
      };

      for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) s->W[(3 * b + j) * N + 3 * a + i] += size * U[i][j];
    }
}

/* A holder under all points of that grid that shifts and tilts, its tangential compliance coupled with the normal one:
   six random motions that are rigid, times size */
static inline void SceneAddHolder(ComplianceScene *s, PetscReal size)
{
  const PetscInt N = 3 * s->n, side = (PetscInt)ceil(sqrt((double)s->n));
  PetscReal      u[3 * SCENE_MOST];

  for (int k = 0; k < 6; k++) {
    PetscReal m[6];

    for (int i = 0; i < 6; i++) m[i] = SceneDraw(s);
    for (PetscInt p = 0; p < s->n; p++) {
      const PetscReal x = (PetscReal)(p % side) / side - 0.5, y = (PetscReal)(p / side) / side - 0.5;

      u[3 * p]     = m[0] + m[3] * x + m[4] * y;
      u[3 * p + 1] = m[1] - m[5] * y;
      u[3 * p + 2] = m[2] + m[5] * x;
    }
    for (PetscInt i = 0; i < N; i++)
      for (PetscInt j = 0; j < N; j++) s->W[i * N + j] += size * u[i] * u[j];
  }
}

/* Compliances of scenes: well-posed, ill-conditioned (1e5), singular */
typedef enum { BODY_HALF_SPACE, BODY_RANDOM, BODY_HOLDER, BODY_STIFF, BODY_RIGID, BODY_TWICE, BODY_N } SceneBody;

static const char *const scene_bodies[] = {"half-space",        "random",          "on a holder", "stiff on a holder",
                                           "rigid on a holder", "every pair twice"};

static inline void SceneAddBody(ComplianceScene *s, SceneBody body)
{
  const PetscInt  N       = 3 * s->n;
  const PetscReal sizes[] = {1, 0, 0.3, 1e-3, 0, 1};

  if (body == BODY_RANDOM) SceneAddRandom(s, N, 1, 1);
  if (sizes[body] > 0) SceneAddHalfSpace(s, sizes[body], 0.5);
  if (body >= BODY_HOLDER && body != BODY_TWICE) SceneAddHolder(s, 1);
  if (body != BODY_TWICE) return;
  for (PetscInt j = 0; j < N; j++) /* an odd pair is the one before it */
    for (PetscInt i = 0; i < N; i++) s->W[j * N + i] = s->W[(j / 6 * 6 + j % 3) * N + i / 6 * 6 + i % 3];
}

/* mu, and motions of order 1 about a mean approach and sliding */
static inline void SceneDrawMotion(ComplianceScene *s, PetscReal mu, PetscReal normal, PetscReal sliding)
{
  for (PetscInt p = 0; p < s->n; p++) {
    s->mu[p]            = mu;
    s->q[3 * p]         = normal + SceneDraw(s);
    s->q[3 * p + 1]     = SceneDraw(s);
    s->q[3 * p + 2]     = SceneDraw(s);
    s->slip0[2 * p]     = -sliding;
    s->slip0[2 * p + 1] = 0.1 * SceneDraw(s);
  }
}

/* Motions that the singular W could undo, q = W x: what shares a force moves alike */
static inline PetscErrorCode SceneMakeConsistent(ComplianceScene *s)
{
  const PetscInt N = 3 * s->n;
  PetscReal     *x;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(N, &x));
  for (PetscInt i = 0; i < N; i++) {
    x[i]    = s->q[i] - (i % 3 ? s->slip0[i / 3 * 2 + i % 3 - 1] : 0);
    s->q[i] = 0;
  }
  for (PetscInt i = 0; i < 2 * s->n; i++) s->slip0[i] = 0;
  for (PetscInt i = 0; i < N; i++)
    for (PetscInt j = 0; j < N; j++) s->q[i] += s->W[j * N + i] * x[j];
  PetscCall(PetscFree(x));
  PetscFunctionReturn(0);
}

/* Compliance of a pair at its own place, mean of the three directions */
static inline PetscReal SceneOwn(const ComplianceScene *s, PetscInt p)
{
  const PetscInt N = 3 * s->n;

  return (s->W[3 * p * (N + 1)] + s->W[(3 * p + 1) * (N + 1)] + s->W[(3 * p + 2) * (N + 1)]) / 3;
}

/* W times lambda plus q */
static inline void SceneMove(const ComplianceScene *s, const PetscReal lambda[], PetscReal r[])
{
  const PetscInt N = 3 * s->n;

  for (PetscInt i = 0; i < N; i++) {
    r[i] = s->q[i];
    for (PetscInt j = 0; j < N; j++) r[i] += s->W[j * N + i] * lambda[j];
  }
}

/* Worst violation of the laws, as a displacement relative to the largest that one pair's force makes at its own place:
   penetration, tension, force across a gap, friction beyond mu lambda_n; friction below it, or not opposite to the slip,
   by the slip */
static inline PetscReal SceneViolation(const ComplianceScene *s, const PetscReal lambda[])
{
  const PetscInt N     = 3 * s->n;
  PetscReal      worst = 0, scale = 0, *r;

  if (PetscMalloc1(N, &r)) return NAN;
  SceneMove(s, lambda, r);
  for (PetscInt p = 0; p < s->n; p++) scale = fmax(scale, SceneOwn(s, p) * fabs(lambda[3 * p]));
  for (PetscInt p = 0; p < s->n; p++) {
    const PetscReal *l = &lambda[3 * p], *at = &r[3 * p], d[2] = {at[1] - s->slip0[2 * p], at[2] - s->slip0[2 * p + 1]};
    const PetscReal  w = SceneOwn(s, p), cone = s->mu[p] * l[0], slip = hypot(d[0], d[1]);
    const PetscReal  opposite = slip > 0 ? w * hypot(l[1] + cone * d[0] / slip, l[2] + cone * d[1] / slip) : 0;
    PetscReal        miss     = fmax(fmax(-w * l[0], -at[0]), fmin(fabs(w * l[0]), fabs(at[0])));

    miss = fmax(miss, w * (hypot(l[1], l[2]) - cone));
    if (l[0] > 0) miss = fmax(miss, opposite * fmin(1, slip / scale));
    worst = miss > worst || miss != miss ? miss : worst;
  }
  (void)PetscFree(r);
  return worst == 0 ? 0 : worst / scale;
}
