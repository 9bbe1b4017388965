/*
   Springs and dashpots at nodes: a 3 x 3 block each in the basis of the node, Q diag(k) Q', on the rank that owns the
   node. Several at one node are added.
*/
#include "dynamics/bodies/bodiesimpl.h"

/* The point of a node, new if need be; of_vertex [n_vertices], -1 without */
static PetscErrorCode PointFind(Bodies b, PetscInt vertex, PetscInt of_vertex[], Point **point)
{
  PetscFunctionBeginUser;
  if (of_vertex[vertex] < 0) {
    PetscCall(PetscRealloc((size_t)(b->n_points + 1) * sizeof(Point), &b->point));
    b->point[b->n_points] = (Point){.vertex = vertex, .early = b->share.shared[vertex]};
    of_vertex[vertex]     = b->n_points++;
  }
  *point = &b->point[of_vertex[vertex]];
  PetscFunctionReturn(0);
}

/* block += Q diag(value) Q', N/m or N s/m; rows of Q are the basis of the node, so that it takes Cartesian
   components to those of the layout */
static void PointAddBlock(const PetscReal q[9], const PetscReal value[3], PetscReal block[9])
{
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      for (int d = 0; d < 3; d++) block[3 * i + j] += q[3 * i + d] * value[d] * q[3 * j + d];
}

/* Adds the springs or the dashpots of a list */
static PetscErrorCode PointsAddGrounded(Bodies b, const Grounded *grounded, PetscBool is_dashpot, PetscInt of_vertex[])
{
  const PetscReal *share;
  PetscInt         n, *vertices;
  Vec              shares;

  PetscFunctionBeginUser;
  PetscCall(ModelCreateShares(b->model, grounded->name, grounded->set, grounded->spread, &shares));
  PetscCall(VecGetArrayRead(shares, &share));
  PetscCall(ModelGetOwnedNodes(b->model, grounded->set, &n, &vertices));
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt v = vertices[i];
    PetscReal      value[3];
    Point         *point;

    if (b->layout.at[v] < 0) continue;
    PetscCall(PointFind(b, v, of_vertex, &point));
    for (int d = 0; d < 3; d++) value[d] = share[3 * v] * grounded->value[d];
    PointAddBlock(&b->layout.basis[9 * v], value, is_dashpot ? point->damping : point->stiffness);
  }
  PetscCall(PetscFree(vertices));
  PetscCall(VecRestoreArrayRead(shares, &share));
  PetscCall(VecDestroy(&shares));
  PetscFunctionReturn(0);
}

PetscErrorCode PointsSetUp(Bodies b)
{
  const ModelScene *scene;
  PetscInt         *of_vertex;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(b->layout.n_vertices, &of_vertex));
  for (PetscInt v = 0; v < b->layout.n_vertices; v++) of_vertex[v] = -1;
  PetscCall(ModelGetScene(b->model, &scene));
  for (PetscInt i = 0; i < scene->n_springs; i++)
    PetscCall(PointsAddGrounded(b, &scene->springs[i], PETSC_FALSE, of_vertex));
  for (PetscInt i = 0; i < scene->n_dashpots; i++)
    PetscCall(PointsAddGrounded(b, &scene->dashpots[i], PETSC_TRUE, of_vertex));
  PetscCall(PetscFree(of_vertex));
  PetscFunctionReturn(0);
}

/* y = A x in the places of a node */
static void PointApply(const PetscReal a[9], const PetscReal x[], PetscInt at, PetscInt step, PetscReal y[3])
{
  for (int i = 0; i < 3; i++) y[i] = a[3 * i] * x[at] + a[3 * i + 1] * x[at + step] + a[3 * i + 2] * x[at + 2 * step];
}

/* As JointsAdvance(), with 3 x 3 blocks of single nodes. */
void PointsAdvance(Bodies b, PetscBool early, BodiesWork *w)
{
  for (PetscInt i = 0; i < b->n_points; i++) {
    const Point   *point = &b->point[i];
    const PetscInt at = b->layout.at[point->vertex], step = b->layout.step[point->vertex];
    PetscReal      g[3], h[3];

    if (point->early != early) continue;
    PointApply(point->stiffness, w->v, at, step, g);
    PointApply(point->damping, w->v, at, step, h);
    for (PetscInt j = 0; j < 3; j++) {
      const PetscInt k = at + j * step;

      w->ku[k] += w->dt * g[j];
      w->f[k] -= w->dt * g[j];
      if (!w->d) continue;
      w->d[k] += h[j];
      w->f[k] -= h[j];
      w->sums.damping += w->v[k] * h[j];
    }
  }
}

void PointsAddForces(Bodies b, const PetscReal u[], PetscReal ku[])
{
  for (PetscInt i = 0; i < b->n_points; i++) {
    const PetscInt at = b->layout.at[b->point[i].vertex], step = b->layout.step[b->point[i].vertex];
    PetscReal      g[3];

    PointApply(b->point[i].stiffness, u, at, step, g);
    for (PetscInt j = 0; j < 3; j++) ku[at + j * step] += g[j];
  }
}
