/*
   How much of the loads on rigid motions forces of the pairs can balance: minimise |push - sum_p rate_p' l_p| over
   all forces l_p that pair p can carry, l_n >= 0 with l_t = mu l_n where it slides, |l_t| <= mu l_n else. push_j =
   f'r_j and rate_p = [N r_j, T r_j, B r_j] of the m motions r_j, orthonormal in M. What is left obeys rate_p . left
   in the polar of each cone, and left . push = |left|^2 (J. J. Moreau's decomposition).

   Non-negative least squares (C. L. Lawson, R. J. Hanson, Solving Least Squares Problems, 1974, ch. 23) on edges of
   the cones, each made when it is the one that helps most. m is small, six for each body, so that at most m edges are
   in use and the fits cost next to nothing beside the loop over the pairs.
*/
#include "statics/staticsimpl.h"
#include "base/algebra/dense.h"

#define BALANCE_MOST   1000  /* edges tried */
#define BALANCE_ENOUGH 1e-14 /* what is left on an edge, beside both */
#define BALANCE_RCOND  1e-13 /* of edges that depend on each other */

/* Edges in use, [m + 1][m], their forces and work */
typedef struct {
  PetscInt   m, n;
  PetscReal *edge, *force, *target, *matrix, *rhs;
} EdgeSet;

static PetscReal EdgeDot(PetscInt n, const PetscReal a[], const PetscReal b[])
{
  PetscReal sum = 0;

  for (PetscInt i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

static PetscReal EdgeNorm(PetscInt n, const PetscReal a[])
{
  return PetscSqrtReal(EdgeDot(n, a, a));
}

/* The edge of pair p's cone that works most along c: n + s t + r b, with (s, r) = (-mu, 0) where it slides and mu
   times the direction of (t . c, b . c) under Coulomb's law */
static void BalanceEdge(const RigidPairs *k, PetscReal friction, PetscInt p, const PetscReal c[], PetscReal edge[])
{
  const PetscReal *head = &k->pair[p * k->width], *n = head + 2, *t = n + k->m, *b = t + k->m;
  PetscReal        s = -friction * head[0], r = 0;

  if (head[0] == 0) {
    const PetscReal along = EdgeDot(k->m, t, c), aside = EdgeDot(k->m, b, c), length = hypot(along, aside);

    s = length > 0 ? friction * head[1] * along / length : 0;
    r = length > 0 ? friction * head[1] * aside / length : 0;
  }
  for (PetscInt i = 0; i < k->m; i++) edge[i] = n[i] + s * t[i] + r * b[i];
}

/* The edge of length 1 that works most along c, and how much; worst beside the longest of all edges */
static PetscReal BalanceBest(const RigidPairs *k, PetscReal friction, const PetscReal c[], PetscReal best[],
                             PetscReal *worst)
{
  PetscReal most = -PETSC_MAX_REAL, longest = 0, *edge = &best[k->m];

  *worst = -PETSC_MAX_REAL;
  for (PetscInt p = 0; p < k->n_pairs; p++) {
    PetscReal length, work;

    BalanceEdge(k, friction, p, c, edge);
    length = EdgeNorm(k->m, edge);
    work   = EdgeDot(k->m, edge, c);
    *worst = PetscMax(*worst, work);
    if (length == 0) continue;
    longest = PetscMax(longest, length);
    if (work / length <= most) continue;
    most = work / length;
    for (PetscInt i = 0; i < k->m; i++) best[i] = edge[i] / length;
  }
  *worst = longest > 0 ? *worst / longest : 0;
  return most;
}

/* target = what forces of any sign, least |push - sum|, are on the edges in use */
static PetscErrorCode EdgeSetFit(EdgeSet *e, const PetscReal push[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(e->matrix, e->edge, e->m * e->n));
  PetscCall(PetscArraycpy(e->rhs, push, e->m));
  PetscCall(DenseLeast(e->m, e->n, e->matrix, e->rhs, BALANCE_RCOND, NULL));
  PetscCall(PetscArraycpy(e->target, e->rhs, e->n));
  PetscFunctionReturn(0);
}

/* Forces on the way to the target, as far as none is negative; what is zero there leaves. Whether the target is
   reached. */
static PetscBool EdgeSetMove(EdgeSet *e)
{
  PetscReal part = 1;
  PetscInt  n = 0, last = -1;

  for (PetscInt i = 0; i < e->n; i++) {
    const PetscReal way = e->force[i] > 0 ? e->force[i] / (e->force[i] - e->target[i]) : 0;

    if (e->target[i] > 0 || way >= part) continue;
    part = way;
    last = i;
  }
  for (PetscInt i = 0; i < e->n; i++) {
    const PetscReal force = e->force[i] + part * (e->target[i] - e->force[i]);

    if (i == last || force <= 0) continue;
    e->force[n] = force;
    for (PetscInt k = 0; k < e->m && n != i; k++) e->edge[n * e->m + k] = e->edge[i * e->m + k];
    n++;
  }
  e->n = n;
  return last < 0 ? PETSC_TRUE : PETSC_FALSE;
}

static void EdgeSetLeave(const EdgeSet *e, const PetscReal push[], PetscReal left[])
{
  for (PetscInt i = 0; i < e->m; i++) left[i] = push[i];
  for (PetscInt j = 0; j < e->n; j++)
    for (PetscInt i = 0; i < e->m; i++) left[i] -= e->force[j] * e->edge[j * e->m + i];
}

/* Makes what is left orthogonal to the edges in use to its own last digits, however little it is of the whole */
static PetscErrorCode EdgeSetRefine(EdgeSet *e, PetscReal left[])
{
  PetscFunctionBeginUser;
  for (int pass = 0; pass < 2 && e->n; pass++) {
    PetscCall(EdgeSetFit(e, left));
    for (PetscInt j = 0; j < e->n; j++)
      for (PetscInt i = 0; i < e->m; i++) left[i] -= e->target[j] * e->edge[j * e->m + i];
  }
  PetscFunctionReturn(0);
}

/* Adds an edge and finds the forces of all again, from what is left, so that a force far below the others has digits */
static PetscErrorCode EdgeSetAdd(EdgeSet *e, const PetscReal edge[], const PetscReal push[], PetscReal left[])
{
  PetscBool reached = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(&e->edge[e->n * e->m], edge, e->m));
  e->force[e->n++] = 0;
  while (e->n && !reached) {
    PetscCall(EdgeSetFit(e, left));
    for (PetscInt i = 0; i < e->n; i++) e->target[i] += e->force[i];
    reached = EdgeSetMove(e);
    EdgeSetLeave(e, push, left);
  }
  PetscCall(EdgeSetRefine(e, left));
  PetscFunctionReturn(0);
}

/* left [m]: what remains of push; where it is not 0 it is the motion of the proof (certificate.c). */
PetscErrorCode BalanceLoads(const RigidPairs *k, PetscReal friction, PetscReal left[], PetscReal *worst)
{
  const PetscInt m = k->m;
  EdgeSet        e = {.m = m};
  PetscReal      best, before, *edge;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc6((m + 1) * m, &e.edge, m + 1, &e.force, m + 1, &e.target, (m + 1) * m, &e.matrix, m + 1, &e.rhs,
                         2 * m, &edge));
  EdgeSetLeave(&e, k->push, left);
  for (int it = 0; it < BALANCE_MOST; it++) {
    before = EdgeNorm(m, left);
    best   = BalanceBest(k, friction, left, edge, worst);
    if (before == 0 || best <= BALANCE_ENOUGH * before || e.n > m) break;
    PetscCall(EdgeSetAdd(&e, edge, k->push, left));
    if (EdgeNorm(m, left) >= before) break; /* rounding */
  }
  (void)BalanceBest(k, friction, left, edge, worst);
  PetscCall(PetscFree6(e.edge, e.force, e.target, e.matrix, e.rhs, edge));
  PetscFunctionReturn(0);
}
