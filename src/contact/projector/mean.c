/*
   A mortar pair between two knots in time (mortar.c), s from 0 to 1 with t_{n+1}:

      D = (1 - s) D_0 + s D_1,   D w_l = (1 - s) D_0 w_l0 + s D_1 w_l1,   n ~ (1 - s) D_0 n_0 + s D_1 n_1,

   so that the operator G is continuous in time, and so are the gaps. The work of the multipliers is lambda . G v of the
   nodes, with the G of the step: what the change of G does to a gap is made good by velocities, hence is part of that
   work, and energy balances to rounding whatever the knots are.
*/
#include "projectorimpl.h"
#include "base/algebra/vec3.h"

/* Shares of the knots in a place of the slave, of sum 1; false where it has no pair */
static PetscBool KnotShares(const ContactProjector p, PetscInt i, PetscInt v, PetscReal c[2])
{
  const ProjectorMortar *m = p->mortar[i];
  const PetscReal        a = m->has[0] ? m->knot[0].pair[v].area : 0, b = m->has[1] ? m->knot[1].pair[v].area : 0;
  const PetscReal        s = m->has[1] ? p->between : 0;

  c[0] = a > 0 && b > 0 ? (1 - s) * a / ((1 - s) * a + s * b) : a > 0 ? 1 : 0;
  c[1] = b > 0 ? 1 - c[0] : 0;
  return a > 0 || b > 0 ? PETSC_TRUE : PETSC_FALSE;
}

/* Sides and normal of a pair between the knots */
static void SidesSet(ContactProjector p, ProjectorPair *pair, const PetscReal c[2])
{
  ProjectorMortar *m      = p->mortar[pair->interface];
  const PetscInt  *first  = &m->first[2 * pair->place];
  PetscReal        length = 0;

  pair->n_own      = (int)(first[1] - first[0]);
  pair->n          = (int)(first[2] - first[1]);
  pair->own        = &m->node[first[0]];
  pair->own_weight = &m->weight[first[0]];
  pair->node       = &m->node[first[1]];
  pair->weight     = &m->weight[first[1]];
  for (PetscInt j = first[0]; j < first[2]; j++) m->weight[j] = c[0] * m->part[0][j] + c[1] * m->part[1][j];
  if (pair->n_own == 1) m->weight[first[0]] = 1;
  for (int d = 0; d < 3; d++) {
    pair->e[0][d] = 0;
    for (int k = 0; k < 2; k++)
      if (c[k] > 0) pair->e[0][d] += c[k] * m->knot[k].pair[pair->place].n[d];
  }
  length = c[0] > 0 && c[1] > 0 ? Vec3Length(pair->e[0]) : 1;
  for (int d = 0; d < 3; d++) pair->e[0][d] /= length;
}

/* Place of node k of the master's side from the slave node at rest, along a vector, m */
static PetscReal NodeAlong(const ContactProjector p, const ProjectorPair *pair, int k, const PetscReal where[],
                           const PetscReal t[3])
{
  const PetscInt at = 3 * pair->node[k], own = 3 * pair->slave;
  PetscReal      sum = 0;

  for (int d = 0; d < 3; d++) sum += t[d] * (p->nodes.x[at + d] + where[at + d] - p->nodes.x[own + d]);
  return sum;
}

/*
   Weights of the master less what the knots miss of the place where the slave's mean is at displacements `where`: with
   xi_l the places of the nodes in the tangent plane about their middle, and r the tangential distance between the
   means,

      w_l += xi_l . (sum_k xi_k xi_k')^-1 r,     sum_l w_l = 1 as before.

   The forces of a pair then have no arm along the surface, and linear fields no jump, wherever bodies go between knots.
*/
static void SidesAim(const ContactProjector p, ProjectorPair *pair, const PetscReal where[])
{
  const PetscReal *x = &p->nodes.x[3 * pair->slave];
  PetscReal        mean_x[3], mean_u[3], d[3], t[2][3], r[2] = {0, 0}, G[3] = {0, 0, 0}, middle[2] = {0, 0}, det;
  PetscReal        e[3][3], along[3] = {0, 0, 0};

  for (int c = 0; c < 3; c++) e[0][c] = pair->e[0][c];
  (void)ContactTangents(along, e);
  for (int c = 0; c < 6; c++) t[c / 3][c % 3] = e[1 + c / 3][c % 3];
  FrameDisplacement(&p->frame[pair->interface], PairSlave(pair, p->nodes.x, mean_x), PairSlave(pair, where, mean_u), d);
  for (int c = 0; c < 3; c++) d[c] += PairSlave(pair, p->nodes.x, mean_x)[c] - x[c];
  for (int a = 0; a < 2; a++) r[a] = Vec3Dot(t[a], d);
  for (int k = 0; k < 2 * pair->n; k++) middle[k % 2] += NodeAlong(p, pair, k / 2, where, t[k % 2]) / pair->n;
  for (int k = 0; k < pair->n; k++) {
    const PetscReal at[2] = {NodeAlong(p, pair, k, where, t[0]), NodeAlong(p, pair, k, where, t[1])};
    const PetscReal xi[2] = {at[0] - middle[0], at[1] - middle[1]};

    for (int a = 0; a < 2; a++) r[a] -= pair->weight[k] * at[a];
    G[0] += xi[0] * xi[0];
    G[1] += xi[0] * xi[1];
    G[2] += xi[1] * xi[1];
  }
  det = G[0] * G[2] - G[1] * G[1];
  if (det <= 1e-6 * G[0] * G[2]) return;
  for (int k = 0; k < pair->n; k++) {
    const PetscReal xi[2] = {NodeAlong(p, pair, k, where, t[0]) - middle[0],
                             NodeAlong(p, pair, k, where, t[1]) - middle[1]};

    pair->weight[k] += (xi[0] * (G[2] * r[0] - G[1] * r[1]) + xi[1] * (G[0] * r[1] - G[1] * r[0])) / det;
  }
}

void MeanFind(ContactProjector p, PetscInt k, const PetscReal where[])
{
  ProjectorPair         *pair = &p->pair[k];
  const ProjectorMortar *m    = p->mortar[pair->interface];
  PetscReal              c[2];

  if (pair->found && (pair->ready || pair->facet < 0)) return;
  pair->facet = -1;
  if (!KnotShares(p, pair->interface, pair->place, c)) return;
  SidesSet(p, pair, c);
  if (MortarTravels(p, pair->interface)) SidesAim(p, pair, where);
  pair->facet = m->knot[c[0] > 0 ? 0 : 1].feet[pair->place].facet;
}
