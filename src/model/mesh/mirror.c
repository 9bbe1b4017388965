/*
   Mirror images of the nodes in a plane across x, y or z: the image of a node at x is the node at R x, R = I - 2 e e',
   whose cells lie about it as the mirror images of the first one's do,

      R a_v = a_w,   a_v = sum over the cells c around v of (middle of c - x_v),

   so that nodes of two bodies at one place, as in a contact, are told apart. A node and its image stand at one place along an
   oblique direction once space is folded in the plane. Places are cut into an interval for each rank with about as many
   nodes; a rank gets the nodes of its own, and those next to it, finds the images, and tells the nodes' ranks. That takes
   150 bytes a node of its own, and 100 on one rank, where all nodes are there already.
*/
#include "model/modelimpl.h"
#include "base/fault.h"
#include "base/gather.h"
#include "base/vec3.h"
#include <stdlib.h>

#define MIRROR_NEAR    1e-7 /* of the mesh's extent: nodes nearer to an image than this are it */
#define MIRROR_SAMPLES 64   /* places of each rank on average, from which the intervals are made */

typedef struct {
  PetscReal   x[3], around[3], place; /* m, m, m along the oblique direction */
  PetscInt    unknown[3];
  PetscMPIInt rank; /* whose it is */
} MirrorNode;

/* Nodes among which images are looked for */
typedef struct {
  MPI_Comm          comm;
  PetscMPIInt       n_ranks;
  const ModelPlane *plane;
  PetscReal         near; /* m */
  PetscReal        *cut;  /* [n_ranks - 1] ends of the ranks' intervals */
  PetscInt          n;
  MirrorNode       *node; /* [n] sorted by place */
} MirrorNodes;

/* Of a node, the unknowns and those of its image */
typedef struct {
  PetscInt from[3], to[3];
} MirrorPair;

/* Along an oblique direction, which no row of a regular mesh lies across, of space folded in the plane */
static PetscReal MirrorPlace(const ModelPlane *plane, const PetscReal x[3])
{
  PetscReal folded[3] = {x[0], x[1], x[2]};

  folded[plane->axis] = PetscAbsReal(x[plane->axis] - plane->at);
  return Vec3Dot((const PetscReal[]){0.5377, 0.3218, 0.7794}, folded);
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

/* This rank's nodes, without places; to be freed */
static PetscErrorCode MirrorCollect(Model model, PetscInt *n, MirrorNode *node[])
{
  const Mesh      *mesh = &model->mesh;
  const PetscReal *a;
  PetscMPIInt      rank;
  Vec              around;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PetscObjectComm((PetscObject)model->dm), &rank));
  PetscCall(MirrorSumCells(model, &around));
  PetscCall(VecGetArrayRead(around, &a));
  PetscCall(PetscCalloc1(mesh->n_nodes, node));
  *n = 0;
  for (PetscInt v = 0; v < mesh->n_nodes; v++) {
    MirrorNode *own = &(*node)[*n];

    if (!mesh->owned[v]) continue;
    for (int d = 0; d < 3; d++) {
      own->x[d]       = mesh->x[3 * v + d];
      own->around[d]  = a[3 * v + d];
      own->unknown[d] = mesh->unknown[3 * v + d];
    }
    own->rank = rank;
    ++*n;
  }
  PetscCall(VecRestoreArrayRead(around, &a));
  PetscCall(VecDestroy(&around));
  PetscFunctionReturn(0);
}

/* Least and largest coordinate of all nodes along each axis, m */
static PetscErrorCode MirrorExtent(const MirrorNodes *s, PetscReal low[3], PetscReal high[3])
{
  PetscFunctionBeginUser;
  for (int d = 0; d < 3; d++) low[d] = PETSC_MAX_REAL, high[d] = PETSC_MIN_REAL;
  for (PetscInt i = 0; i < 3 * s->n; i++) {
    low[i % 3]  = PetscMin(low[i % 3], s->node[i / 3].x[i % 3]);
    high[i % 3] = PetscMax(high[i % 3], s->node[i / 3].x[i % 3]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, low, 3, MPIU_REAL, MPI_MIN, s->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, high, 3, MPIU_REAL, MPI_MAX, s->comm));
  PetscFunctionReturn(0);
}

/* Cuts the intervals by even samples of each rank's sorted nodes, as many as its share of all */
static PetscErrorCode MirrorCut(MirrorNodes *s)
{
  PetscInt   n_all, n_own, n_samples;
  PetscReal *own, *sample;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(&s->n, &n_all, 1, MPIU_INT, MPI_SUM, s->comm));
  n_own = PetscMin(s->n, (PetscInt)((PetscReal)s->n / (PetscReal)n_all * MIRROR_SAMPLES * s->n_ranks) + 1);
  PetscCall(PetscMalloc1(n_own, &own));
  for (PetscInt i = 0; i < n_own; i++) own[i] = s->node[(PetscInt)((PetscInt64)i * s->n / n_own)].place;
  PetscCall(GatherRecords(s->comm, n_own, sizeof(*own), own, &n_samples, &sample));
  PetscCall(PetscSortReal(n_samples, sample));
  PetscCall(PetscMalloc1(s->n_ranks, &s->cut));
  for (PetscMPIInt r = 0; r < s->n_ranks - 1; r++) s->cut[r] = sample[(PetscInt64)(r + 1) * n_samples / s->n_ranks];
  PetscCall(PetscFree(own));
  PetscCall(PetscFree(sample));
  PetscFunctionReturn(0);
}

/* The rank in whose interval a place lies */
static PetscMPIInt MirrorRank(const MirrorNodes *s, PetscReal place)
{
  PetscMPIInt rank = 0;

  while (rank < s->n_ranks - 1 && place >= s->cut[rank]) rank++;
  return rank;
}

/* In place of this rank's nodes those of its interval, and of others those within reach of it */
static PetscErrorCode MirrorShare(MirrorNodes *s)
{
  const PetscReal reach  = 2 * s->near;
  PetscInt        n_sent = 0;
  PetscMPIInt    *rank;
  MirrorNode     *sent;

  PetscFunctionBeginUser;
  if (s->n_ranks == 1) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < s->n; i++)
    n_sent += 1 + MirrorRank(s, s->node[i].place + reach) - MirrorRank(s, s->node[i].place - reach);
  PetscCall(PetscMalloc1(n_sent, &sent));
  PetscCall(PetscMalloc1(n_sent, &rank));
  n_sent = 0;
  for (PetscInt i = 0; i < s->n; i++)
    for (PetscMPIInt r = MirrorRank(s, s->node[i].place - reach); r <= MirrorRank(s, s->node[i].place + reach); r++) {
      rank[n_sent]   = r;
      sent[n_sent++] = s->node[i];
    }
  PetscCall(PetscFree(s->node));
  s->n = n_sent;
  PetscCall(ExchangeRecords(s->comm, &s->n, sizeof(*sent), &sent, rank, &s->node));
  PetscCall(PetscFree(rank));
  if (s->n) qsort(s->node, (size_t)s->n, sizeof(*s->node), MirrorCompare);
  PetscFunctionReturn(0);
}

/* Squared distance of two triples */
static PetscReal MirrorSquare(const PetscReal a[3], const PetscReal b[3])
{
  return PetscSqr(a[0] - b[0]) + PetscSqr(a[1] - b[1]) + PetscSqr(a[2] - b[2]);
}

/* The node near the place of `image` whose cells lie most as those of `image` do; NULL for none */
static const MirrorNode *MirrorFind(const MirrorNodes *s, const MirrorNode *image)
{
  const MirrorNode *best = NULL;
  PetscReal         least = PETSC_MAX_REAL;
  PetscInt          first = 0, last = s->n;

  while (first < last) {
    const PetscInt middle = (first + last) / 2;

    if (s->node[middle].place < image->place - 2 * s->near)
      first = middle + 1;
    else
      last = middle;
  }
  for (PetscInt i = first; i < s->n && s->node[i].place <= image->place + 2 * s->near; i++) {
    const PetscReal apart = MirrorSquare(s->node[i].around, image->around);

    if (MirrorSquare(s->node[i].x, image->x) > s->near * s->near || apart >= least) continue;
    least = apart;
    best  = &s->node[i];
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

/* The image of one of the nodes */
static PetscErrorCode MirrorMatch(const MirrorNodes *s, const MirrorNode *one, MirrorPair *pair, Fault *fault)
{
  const ModelPlane *plane    = s->plane;
  MirrorNode        mirrored = *one;
  const MirrorNode *found;

  PetscFunctionBeginUser;
  mirrored.x[plane->axis]      = 2 * plane->at - one->x[plane->axis];
  mirrored.around[plane->axis] = -one->around[plane->axis];
  found                        = MirrorFind(s, &mirrored);
  if (!found)
    PetscCall(FaultNote(fault, PETSC_ERR_USER_INPUT,
                        "-symmetry %c: the node at (%g, %g, %g) m has no mirror image in the plane %c = %g m; give "
                        "the place of the plane, as %c=0, or a mesh that is its own mirror image",
                        "xyz"[plane->axis], (double)one->x[0], (double)one->x[1], (double)one->x[2],
                        "xyz"[plane->axis], (double)plane->at, "xyz"[plane->axis]));
  if (found) PetscCall(MirrorCheckHeld(plane, one, found, fault));
  for (int d = 0; d < 3; d++) {
    pair->from[d] = one->unknown[d];
    pair->to[d]   = found ? found->unknown[d] : -1;
  }
  PetscFunctionReturn(0);
}

/* Pairs of the nodes of this rank's interval that have unknowns, each told to the node's rank; to be freed. The nodes are
   gone then */
static PetscErrorCode MirrorMatchAll(MirrorNodes *s, PetscInt *n, MirrorPair *pairs[])
{
  PetscMPIInt here, *rank;
  MirrorPair *pair;
  Fault       fault = {0};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(s->comm, &here));
  PetscCall(PetscMalloc1(s->n, &pair));
  PetscCall(PetscMalloc1(s->n, &rank));
  *n = 0;
  for (PetscInt i = 0; i < s->n; i++) {
    const MirrorNode *one = &s->node[i];
    const PetscInt    any = PetscMax(one->unknown[0], PetscMax(one->unknown[1], one->unknown[2]));

    if (any < 0 || MirrorRank(s, one->place) != here) continue;
    rank[*n] = one->rank;
    PetscCall(MirrorMatch(s, one, &pair[(*n)++], &fault));
  }
  PetscCall(FaultsRaise(s->comm, &fault));
  PetscCall(PetscFree(s->node));
  PetscCall(ExchangeRecords(s->comm, n, sizeof(*pair), &pair, rank, pairs));
  PetscCall(PetscFree(rank));
  PetscFunctionReturn(0);
}

/* Pairs of this rank's nodes; finds the place of the plane where it is not given */
static PetscErrorCode MirrorFindPairs(Model model, ModelPlane *plane, PetscInt *n_pairs, MirrorPair *pairs[])
{
  PetscReal   low[3], high[3], extent = 0;
  MirrorNodes s = {.comm = PetscObjectComm((PetscObject)model->dm), .plane = plane};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(s.comm, &s.n_ranks));
  PetscCall(MirrorCollect(model, &s.n, &s.node));
  PetscCall(MirrorExtent(&s, low, high));
  for (int d = 0; d < 3; d++) extent = PetscMax(extent, high[d] - low[d]);
  if (!plane->has_at) plane->at = 0.5 * (low[plane->axis] + high[plane->axis]);
  s.near = MIRROR_NEAR * extent;
  for (PetscInt i = 0; i < s.n; i++) s.node[i].place = MirrorPlace(plane, s.node[i].x);
  if (s.n) qsort(s.node, (size_t)s.n, sizeof(*s.node), MirrorCompare);
  PetscCall(MirrorCut(&s));
  PetscCall(MirrorShare(&s));
  PetscCall(MirrorMatchAll(&s, n_pairs, pairs));
  PetscCall(PetscFree(s.cut));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelMirror(Model model, ModelPlane *plane, PetscInt image[])
{
  const PetscInt first = model->mesh.first_own;
  PetscInt       n;
  MirrorPair    *pair;

  PetscFunctionBeginUser;
  PetscCall(MirrorFindPairs(model, plane, &n, &pair));
  for (PetscInt i = 0; i < n; i++)
    for (int d = 0; d < 3; d++)
      if (pair[i].from[d] >= 0) image[pair[i].from[d] - first] = d == plane->axis ? -1 - pair[i].to[d] : pair[i].to[d];
  PetscCall(PetscFree(pair));
  PetscFunctionReturn(0);
}
