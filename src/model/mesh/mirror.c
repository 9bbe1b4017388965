/*
   Mirror images of the nodes in a plane across x, y or z: the image of a node at x is the node at R x, R = I - 2 e e',
   whose cells lie about it as the mirror images of the first one's do,

      R a_v = a_w,   a_v = sum over the cells c around v of (middle of c - x_v),

   so that nodes of two bodies at one place, as in a contact, are told apart. Every rank sorts the nodes of all ranks by
   their place along an oblique direction, where few of them stand at the same, and looks for the images of its own.
*/
#include "model/modelimpl.h"
#include "base/fault.h"
#include "base/gather.h"
#include "base/vec3.h"
#include <stdlib.h>

#define MIRROR_NEAR 1e-7 /* of the mesh's extent: nodes nearer to an image than this are it */

/* A node of all ranks */
typedef struct {
  PetscReal x[3], around[3], place; /* m, m, m along the oblique direction */
  PetscInt  unknown[3];
} MirrorNode;

/* An oblique direction, which no row of a regular mesh lies across */
static PetscReal MirrorPlace(const PetscReal x[3])
{
  return Vec3Dot((const PetscReal[]){0.5377, 0.3218, 0.7794}, x);
}

static int MirrorCompare(const void *a, const void *b)
{
  const PetscReal x = ((const MirrorNode *)a)->place, y = ((const MirrorNode *)b)->place;

  return (x > y) - (x < y);
}

/* a_v of the local nodes, [nodes][3] in a vector of ModelCreateNodal() */
static PetscErrorCode MirrorSumCells(Model model, Vec *around)
{
  const Mesh *mesh = &model->mesh;
  PetscReal  *a;

  PetscFunctionBeginUser;
  PetscCall(ModelCreateNodal(model, around));
  PetscCall(VecGetArray(*around, &a));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscInt  n = mesh->cell_first[c + 1] - mesh->cell_first[c];
    const PetscInt *v = &mesh->cell_node[mesh->cell_first[c]];

    for (PetscInt i = 0; i < n; i++)
      for (PetscInt j = 0; j < n; j++)
        for (int d = 0; d < 3; d++)
          a[3 * v[i] + d] += (mesh->x[3 * v[j] + d] - mesh->x[3 * v[i] + d]) / (PetscReal)n;
  }
  PetscCall(VecRestoreArray(*around, &a));
  PetscCall(ModelSumShared(model, *around));
  PetscFunctionReturn(0);
}

/* The nodes of all ranks, sorted; to be freed */
static PetscErrorCode MirrorGather(Model model, PetscInt *n, MirrorNode *node[])
{
  const Mesh      *mesh = &model->mesh;
  const PetscReal *a;
  PetscInt         n_own = 0;
  MirrorNode      *own;
  Vec              around;

  PetscFunctionBeginUser;
  PetscCall(MirrorSumCells(model, &around));
  PetscCall(VecGetArrayRead(around, &a));
  PetscCall(PetscCalloc1(mesh->n_nodes, &own));
  for (PetscInt v = 0; v < mesh->n_nodes; v++) {
    if (!mesh->owned[v]) continue;
    for (int d = 0; d < 3; d++) {
      own[n_own].x[d]       = mesh->x[3 * v + d];
      own[n_own].around[d]  = a[3 * v + d];
      own[n_own].unknown[d] = mesh->unknown[3 * v + d];
    }
    own[n_own].place = MirrorPlace(own[n_own].x);
    n_own++;
  }
  PetscCall(VecRestoreArrayRead(around, &a));
  PetscCall(VecDestroy(&around));
  PetscCall(GatherRecords(PetscObjectComm((PetscObject)model->dm), n_own, sizeof(*own), own, n, node));
  PetscCall(PetscFree(own));
  qsort(*node, (size_t)*n, sizeof(**node), MirrorCompare);
  PetscFunctionReturn(0);
}

/* Least and largest coordinate along each axis, m */
static void MirrorExtent(PetscInt n, const MirrorNode node[], PetscReal low[3], PetscReal high[3])
{
  for (int d = 0; d < 3; d++) low[d] = PETSC_MAX_REAL, high[d] = PETSC_MIN_REAL;
  for (PetscInt i = 0; i < 3 * n; i++) {
    low[i % 3]  = PetscMin(low[i % 3], node[i / 3].x[i % 3]);
    high[i % 3] = PetscMax(high[i % 3], node[i / 3].x[i % 3]);
  }
}

/* Squared distance of two triples */
static PetscReal MirrorSquare(const PetscReal a[3], const PetscReal b[3])
{
  return PetscSqr(a[0] - b[0]) + PetscSqr(a[1] - b[1]) + PetscSqr(a[2] - b[2]);
}

/* The node within `near` (m) of the place of `image` whose cells lie most as those of `image` do; NULL for none */
static const MirrorNode *MirrorFind(PetscInt n, const MirrorNode node[], const MirrorNode *image, PetscReal near)
{
  const MirrorNode *best = NULL;
  PetscReal         least = PETSC_MAX_REAL;
  PetscInt          first = 0, last = n;

  while (first < last) {
    const PetscInt middle = (first + last) / 2;

    if (node[middle].place < image->place - 2 * near)
      first = middle + 1;
    else
      last = middle;
  }
  for (PetscInt i = first; i < n && node[i].place <= image->place + 2 * near; i++) {
    const PetscReal apart = MirrorSquare(node[i].around, image->around);

    if (MirrorSquare(node[i].x, image->x) > near * near || apart >= least) continue;
    least = apart;
    best  = &node[i];
  }
  return best;
}

/* Notes a direction that is held at one of two images */
static PetscErrorCode MirrorCheckHeld(const ModelPlane *plane, const MirrorNode *a, const MirrorNode *b, Fault *fault)
{
  PetscFunctionBeginUser;
  for (int d = 0; d < 3; d++)
    if ((a->unknown[d] < 0) != (b->unknown[d] < 0))
      PetscCall(FaultNote(fault, PETSC_ERR_USER_INPUT,
                          "-symmetry %c: of the node at (%g, %g, %g) m and its mirror image in the plane %c = %g m a "
                          "support or motion holds %c at one alone",
                          "xyz"[plane->axis], (double)a->x[0], (double)a->x[1], (double)a->x[2], "xyz"[plane->axis],
                          (double)plane->at, "xyz"[d]));
  PetscFunctionReturn(0);
}

/* Fills image of the unknowns of one node where they are of this rank */
static PetscErrorCode MirrorNodeUnknowns(Model model, const ModelPlane *plane, const MirrorNode *from,
                                         const MirrorNode *to, PetscInt image[])
{
  const Mesh *mesh = &model->mesh;

  PetscFunctionBeginUser;
  for (int d = 0; d < 3; d++) {
    const PetscInt own = from->unknown[d] - mesh->first_own;

    if (from->unknown[d] < 0 || own < 0 || own >= mesh->n_own) continue;
    image[own] = d == plane->axis ? -1 - to->unknown[d] : to->unknown[d];
  }
  PetscFunctionReturn(0);
}

/* Images of the nodes of this rank's unknowns */
static PetscErrorCode MirrorMatch(Model model, const ModelPlane *plane, PetscReal near, PetscInt n,
                                  const MirrorNode node[], PetscInt image[])
{
  const Mesh *mesh  = &model->mesh;
  Fault       fault = {0};

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt    any = PetscMax(node[i].unknown[0], PetscMax(node[i].unknown[1], node[i].unknown[2]));
    MirrorNode        mirrored = node[i];
    const MirrorNode *found;

    if (any < mesh->first_own || any >= mesh->first_own + mesh->n_own) continue;
    mirrored.x[plane->axis]      = 2 * plane->at - node[i].x[plane->axis];
    mirrored.around[plane->axis] = -node[i].around[plane->axis];
    mirrored.place               = MirrorPlace(mirrored.x);
    found                        = MirrorFind(n, node, &mirrored, near);
    if (!found)
      PetscCall(FaultNote(&fault, PETSC_ERR_USER_INPUT,
                          "-symmetry %c: the node at (%g, %g, %g) m has no mirror image in the plane %c = %g m; give "
                          "the place of the plane, as %c=0, or a mesh that is its own mirror image",
                          "xyz"[plane->axis], (double)node[i].x[0], (double)node[i].x[1], (double)node[i].x[2],
                          "xyz"[plane->axis], (double)plane->at, "xyz"[plane->axis]));
    if (!found) continue;
    PetscCall(MirrorCheckHeld(plane, &node[i], found, &fault));
    PetscCall(MirrorNodeUnknowns(model, plane, &node[i], found, image));
  }
  PetscCall(FaultsRaise(PetscObjectComm((PetscObject)model->dm), &fault));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelMirror(Model model, ModelPlane *plane, PetscInt image[])
{
  PetscInt    n;
  PetscReal   low[3], high[3], extent = 0;
  MirrorNode *node;

  PetscFunctionBeginUser;
  PetscCall(MirrorGather(model, &n, &node));
  MirrorExtent(n, node, low, high);
  for (int d = 0; d < 3; d++) extent = PetscMax(extent, high[d] - low[d]);
  if (!plane->has_at) plane->at = 0.5 * (low[plane->axis] + high[plane->axis]);
  PetscCall(MirrorMatch(model, plane, MIRROR_NEAR * extent, n, node, image));
  PetscCall(PetscFree(node));
  PetscFunctionReturn(0);
}
