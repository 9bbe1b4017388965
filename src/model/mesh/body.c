/*
   Bodies: the pieces of the mesh that hang together by nodes.

   On each rank a union-find over the nodes of its cells (R. E. Tarjan, J. ACM 22, 1975) joins the local vertices into
   pieces. Each piece takes the least global number of its vertices; shared vertices carry it from rank to rank until
   nothing changes, at most as often as there are ranks in a row along a body.
*/
#include "model/modelimpl.h"
#include <squeal/options.h>
#include "base/gather.h"
#include <petscsf.h>
#include <stdlib.h>

#define NO_BODY PETSC_MAX_INT

/* What orders bodies: their lexicographically first node, then, where two bodies share that place, the negative of the
   last one; m */
typedef struct {
  PetscReal at[6];
  PetscInt  body;
} BodyKey;

/* First vertex of the piece, with the path to it halved */
static PetscInt PieceFind(PetscInt parent[], PetscInt v)
{
  while (parent[v] != v) v = parent[v] = parent[parent[v]];
  return v;
}

/* A vertex of the same piece for each local vertex, one for the whole piece, itself where it has no cells */
static void PiecesFind(const Mesh *mesh, PetscInt piece[])
{
  for (PetscInt v = 0; v < mesh->n_nodes; v++) piece[v] = v;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscInt first = mesh->cell_node[mesh->cell_first[c]];

    for (PetscInt i = mesh->cell_first[c] + 1; i < mesh->cell_first[c + 1]; i++)
      piece[PieceFind(piece, mesh->cell_node[i])] = PieceFind(piece, first);
  }
  for (PetscInt v = 0; v < mesh->n_nodes; v++) piece[v] = PieceFind(piece, v);
}

/* Least label of the vertices of each local piece */
static void LabelsSpread(PetscInt n, const PetscInt piece[], PetscInt label[])
{
  for (PetscInt v = 0; v < n; v++) label[piece[v]] = PetscMin(label[piece[v]], label[v]);
  for (PetscInt v = 0; v < n; v++) label[v] = label[piece[v]];
}

/* Least label [nodes] of each shared node over its ranks; at and work [points of the DM] */
static PetscErrorCode LabelsShare(Model model, PetscInt n_points, PetscInt label[], PetscInt at[], PetscInt work[])
{
  const PetscInt n = model->mesh.n_nodes;
  PetscSF        sf;
  PetscInt       n_roots;

  PetscFunctionBeginUser;
  PetscCall(DMGetPointSF(model->dm, &sf));
  PetscCall(PetscSFGetGraph(sf, &n_roots, NULL, NULL, NULL));
  if (n_roots < 0) PetscFunctionReturn(0); /* a mesh on one rank shares nothing */
  for (PetscInt p = 0; p < n_points; p++) at[p] = NO_BODY;
  for (PetscInt v = 0; v < n; v++) at[model->point_of[v]] = label[v];
  PetscCall(PetscArraycpy(work, at, n_points));
  PetscCall(PetscSFReduceBegin(sf, MPIU_INT, work, at, MPI_MIN));
  PetscCall(PetscSFReduceEnd(sf, MPIU_INT, work, at, MPI_MIN));
  PetscCall(PetscArraycpy(work, at, n_points));
  PetscCall(PetscSFBcastBegin(sf, MPIU_INT, work, at, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(sf, MPIU_INT, work, at, MPI_REPLACE));
  for (PetscInt v = 0; v < n; v++) label[v] = at[model->point_of[v]];
  PetscFunctionReturn(0);
}

/* The least global number of the nodes of its body for each local node */
static PetscErrorCode BodiesLabel(Model model, PetscInt label[])
{
  const PetscInt n = model->mesh.n_nodes;
  PetscInt       n_points, *at, *work, *piece, *before;
  PetscBool      same;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetChart(model->dm, NULL, &n_points));
  PetscCall(PetscMalloc4(n_points, &at, n_points, &work, n, &piece, n, &before));
  PiecesFind(&model->mesh, piece);
  PetscCall(PetscArraycpy(label, model->mesh.number, n));
  do {
    PetscCall(PetscArraycpy(before, label, n));
    LabelsSpread(n, piece, label);
    PetscCall(LabelsShare(model, n_points, label, at, work));
    PetscCall(PetscArraycmp(before, label, n, &same));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &same, 1, MPIU_BOOL, MPI_LAND, model->comm));
  } while (!same);
  PetscCall(PetscFree4(at, work, piece, before));
  PetscFunctionReturn(0);
}

/* All labels, ascending, on every rank: each is the number of one vertex, listed by the rank that owns it */
static PetscErrorCode LabelsGather(Model model, const PetscInt label[], PetscInt *n_bodies, PetscInt **labels)
{
  const Mesh *mesh = &model->mesh;
  PetscInt    n    = 0, *own;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_nodes, &own));
  for (PetscInt v = 0; v < mesh->n_nodes; v++)
    if (mesh->owned[v] && mesh->number[v] == label[v]) own[n++] = label[v];
  PetscCall(GatherRecords(model->comm, n, sizeof(PetscInt), own, n_bodies, labels));
  PetscCall(PetscSortInt(*n_bodies, *labels));
  PetscCall(PetscFree(own));
  PetscFunctionReturn(0);
}

/* Keys of the bodies, component by component: the least value among the vertices that attain those before. body [local
   vertices], -1 without */
static PetscErrorCode BodyKeysFind(Model model, PetscInt n_vertices, const PetscInt body[], PetscInt n_bodies,
                                   BodyKey key[])
{
  PetscMPIInt count;
  PetscReal  *least;

  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(n_bodies, &count));
  PetscCall(PetscMalloc1(n_bodies, &least));
  for (int k = 0; k < 6; k++) {
    const PetscReal sign = k < 3 ? 1 : -1;

    for (PetscInt b = 0; b < n_bodies; b++) least[b] = PETSC_MAX_REAL;
    for (PetscInt v = 0; v < n_vertices; v++) {
      const PetscReal *x       = &model->mesh.x[3 * v];
      PetscBool        attains = body[v] >= 0 ? PETSC_TRUE : PETSC_FALSE;

      for (int j = k - k % 3; j < k && attains; j++)
        attains = sign * x[j % 3] == key[body[v]].at[j] ? PETSC_TRUE : PETSC_FALSE;
      if (attains) least[body[v]] = PetscMin(least[body[v]], sign * x[k % 3]);
    }
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, least, count, MPIU_REAL, MPI_MIN, model->comm));
    for (PetscInt b = 0; b < n_bodies; b++) key[b].at[k] = least[b];
  }
  PetscCall(PetscFree(least));
  PetscFunctionReturn(0);
}

static int BodyKeyCompare(const void *a, const void *b)
{
  const PetscReal *x = ((const BodyKey *)a)->at, *y = ((const BodyKey *)b)->at;
  int              k = 0;

  while (k < 5 && x[k] == y[k]) k++;
  return (x[k] > y[k]) - (x[k] < y[k]);
}

/* Renumbers bodies in the order of their keys */
static PetscErrorCode BodiesSort(Model model, PetscInt n_vertices, PetscInt n_bodies, PetscInt body[])
{
  PetscInt *place;
  BodyKey  *key;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n_bodies, &place, n_bodies, &key));
  for (PetscInt b = 0; b < n_bodies; b++) key[b].body = b;
  PetscCall(BodyKeysFind(model, n_vertices, body, n_bodies, key));
  if (n_bodies) qsort(key, (size_t)n_bodies, sizeof(*key), BodyKeyCompare);
  for (PetscInt b = 0; b < n_bodies; b++) place[key[b].body] = b;
  for (PetscInt v = 0; v < n_vertices; v++)
    if (body[v] >= 0) body[v] = place[body[v]];
  PetscCall(PetscFree2(place, key));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelGetBodies(Model model, PetscInt *n_bodies, PetscInt **body)
{
  const PetscInt n = model->mesh.n_nodes;
  PetscInt      *labels;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, body));
  PetscCall(BodiesLabel(model, *body));
  PetscCall(LabelsGather(model, *body, n_bodies, &labels));
  for (PetscInt v = 0; v < n; v++) PetscCall(PetscFindInt((*body)[v], *n_bodies, labels, &(*body)[v]));
  PetscCall(PetscFree(labels));
  PetscCall(BodiesSort(model, n, *n_bodies, *body));
  PetscFunctionReturn(0);
}

/* Which parts a body has cells of (bit 1), and which the others (bit 2); bits [n_parts] */
static PetscErrorCode BodyFindParts(Model model, const PetscInt body[], PetscInt b, int bits[])
{
  const Mesh *mesh = &model->mesh;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < mesh->n_cells; i++)
    bits[mesh->cell_part[i]] |= body[mesh->cell_node[mesh->cell_first[i]]] == b ? 1 : 2;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, bits, (PetscMPIInt)mesh->n_parts, MPI_INT, MPI_BOR, model->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelMeasureBodies(Model model, const PetscInt body[], PetscInt first, PetscInt n, PetscReal box[])
{
  const Mesh *mesh = &model->mesh;
  PetscMPIInt count;

  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(6 * n, &count));
  for (PetscInt i = 0; i < 6 * n; i++) box[i] = -PETSC_MAX_REAL;
  for (PetscInt i = 0; i < 3 * mesh->n_nodes; i++) {
    const PetscInt b = body[i / 3] - first;

    if (body[i / 3] < 0 || b < 0 || b >= n) continue;
    box[6 * b + i % 3]     = PetscMax(box[6 * b + i % 3], mesh->x[i]);
    box[6 * b + 3 + i % 3] = PetscMax(box[6 * b + 3 + i % 3], -mesh->x[i]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, box, count, MPIU_REAL, MPI_MAX, model->comm));
  PetscFunctionReturn(0);
}

/* Appends " about x, y, z m": the middle of the body's box */
static PetscErrorCode BodyAppendPlace(Model model, const PetscInt body[], PetscInt b, size_t size, char text[])
{
  PetscReal   box[6], middle[3], size_of = 0;
  const char *unit;
  char        place[128];

  PetscFunctionBeginUser;
  PetscCall(ModelMeasureBodies(model, body, b, 1, box));
  for (int d = 0; d < 3; d++) size_of = PetscMax(size_of, box[d] + box[3 + d]);
  for (int d = 0; d < 3; d++) {
    middle[d] = (box[d] - box[3 + d]) / 2;
    if (PetscAbsReal(middle[d]) < 1e-9 * size_of) middle[d] = 0;
  }
  PetscCall(ModelGetUnit(model, "m", &unit));
  PetscCall(PetscSNPrintf(place, sizeof(place), " about %.4g, %.4g, %.4g %s", (double)middle[0], (double)middle[1],
                          (double)middle[2], unit));
  PetscCall(OptionsTextAppend(text, place, size));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelNameBody(Model model, const PetscInt body[], PetscInt b, size_t size, char text[])
{
  const Mesh *mesh  = &model->mesh;
  PetscBool   piece = PETSC_FALSE;
  PetscInt    n     = 0;
  int        *bits;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_parts, &bits));
  PetscCall(BodyFindParts(model, body, b, bits));
  for (PetscInt i = 0; i < mesh->n_parts; i++) {
    n += bits[i] & 1;
    if (bits[i] == 3) piece = PETSC_TRUE;
  }
  PetscCall(PetscSNPrintf(text, size, "%s%s", piece ? "a piece of " : "", n > 1 ? "parts" : "part"));
  for (PetscInt i = 0, named = 0; i < mesh->n_parts; i++) {
    if (!(bits[i] & 1)) continue;
    PetscCall(OptionsTextAppend(text, named++ ? ", " : " ", size));
    PetscCall(OptionsTextAppend(text, mesh->part[i], size));
  }
  if (piece) PetscCall(BodyAppendPlace(model, body, b, size, text));
  PetscCall(PetscFree(bits));
  PetscFunctionReturn(0);
}
