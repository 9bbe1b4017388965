/*
   Layout of the state vectors. A body has cylindrical components, on all ranks, where some rank finds its cells swept
   about an axis, no other one about another, and its supports can be said in them: along the axis, and in the plane
   either both directions or none. About or along an axis that is none of x, y, z the components are along it, too,
   where supports and motions hold all directions of a node or none. On each rank a body whose cells are swept there
   stands line after line, padded so that blocks of nodes can be loaded with their neighbours; all other nodes follow
   node after node, those that ranks share first.
*/
#include "bodiesimpl.h"
#include "base/algebra/vec3.h"

/* of centres that ranks find, relative to the mesh: each fits its own cells, to rounding of coordinates */
#define SAME_AXIS  1e-8
#define NODES_LEAF 256  /* nodes, with their sums about 15 kB */
#define TILT       0.02 /* of planes of nodes: few of a regular mesh share one, which quicksort is slow with */

static PetscInt LayoutRoundUp(PetscInt n)
{
  return (n + STENCIL_WIDTH - 1) / STENCIL_WIDTH * STENCIL_WIDTH;
}

/* Whether this rank has each body's cells */
static PetscErrorCode BodiesFlagLocal(Bodies b, PetscBool local[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(local, b->n_bodies));
  for (PetscInt v = 0; v < b->layout.n_vertices; v++)
    if (b->body[v] >= 0) local[b->body[v]] = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Whether a node of the body has some directions prescribed and others free */
static PetscErrorCode BodiesMotionSplits(Bodies b, PetscInt body, PetscBool *splits)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  *splits = PETSC_FALSE;
  PetscCall(ModelGetScene(b->model, &scene));
  for (PetscInt i = 0; i < scene->n_motions; i++) {
    const PetscBool *along = scene->motions[i].direction;
    PetscInt         n, *vertices;

    if (along[0] == along[1] && along[1] == along[2]) continue;
    PetscCall(ModelGetSetNodes(b->model, scene->motions[i].set, &n, &vertices));
    for (PetscInt k = 0; k < n; k++)
      if (b->body[vertices[k]] == body) *splits = PETSC_TRUE;
    PetscCall(PetscFree(vertices));
  }
  PetscFunctionReturn(0);
}

/* From the axis to a place, along the two rows across it, m */
static void FrameAcross(const BodiesFrame *frame, const PetscReal x[3], PetscReal across[2])
{
  const PetscReal off[3] = {x[0] - frame->centre[0], x[1] - frame->centre[1], x[2] - frame->centre[2]};

  for (int i = 0; i < 2; i++) across[i] = Vec3Dot(off, &frame->row[3 * ((frame->axis + 1 + i) % 3)]);
}

/* Whether the directions held at the nodes of a body, and their places, allow components of the frame */
static PetscErrorCode BodiesFrameSuits(Bodies b, PetscInt body, const BodiesFrame *frame, PetscBool *suits)
{
  const PetscInt j = (frame->axis + 1) % 3, k = (frame->axis + 2) % 3;
  const Mesh    *mesh   = b->mesh;
  PetscBool      splits = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (frame->oblique) PetscCall(BodiesMotionSplits(b, body, &splits));
  *suits = splits ? PETSC_FALSE : PETSC_TRUE;
  for (PetscInt v = 0; v < b->layout.n_vertices; v++) {
    const PetscInt *unknown = &mesh->unknown[3 * v];
    PetscReal       across[2];

    if (b->body[v] != body) continue;
    if ((unknown[j] < 0) != (unknown[k] < 0)) *suits = PETSC_FALSE;
    if (frame->oblique && (unknown[frame->axis] < 0) != (unknown[k] < 0)) *suits = PETSC_FALSE;
    FrameAcross(frame, &mesh->x[3 * v], across);
    if (frame->turned && across[0] == 0 && across[1] == 0) *suits = PETSC_FALSE;
  }
  PetscFunctionReturn(0);
}

/* Whether lines ask for components of their own */
static PetscBool LinesNeedFrame(const ModelLines *lines)
{
  return lines && (lines->turned || lines->oblique) ? PETSC_TRUE : PETSC_FALSE;
}

/* Whether two frames are the same but for rounding; scale (m): axes parallel within SAME_AXIS, and of turned ones
   on one line. Directions across the axis may differ: those of the first frame are used. */
static PetscBool BodiesFrameAgrees(const BodiesFrame *a, const ModelLines *lines, PetscReal scale)
{
  const PetscReal *along = &lines->frame[3 * lines->axis];
  PetscReal        across[2];

  if (a->turned != lines->turned || a->oblique != lines->oblique) return PETSC_FALSE;
  FrameAcross(a, lines->centre, across);
  for (int i = 0; i < 2; i++) {
    if (PetscAbsReal(Vec3Dot(along, &a->row[3 * ((a->axis + 1 + i) % 3)])) > SAME_AXIS) return PETSC_FALSE;
    if (a->turned && PetscAbsReal(across[i]) > SAME_AXIS * scale) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Largest coordinate of the mesh, m */
static PetscErrorCode BodiesFindScale(Bodies b, PetscReal *scale)
{
  PetscFunctionBeginUser;
  *scale = 0;
  for (PetscInt i = 0; i < 3 * b->layout.n_vertices; i++) *scale = PetscMax(*scale, PetscAbsReal(b->mesh->x[i]));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, scale, 1, MPIU_REAL, MPI_MAX, b->comm));
  PetscFunctionReturn(0);
}

/* Frames that the lowest rank with lines that need one finds for each body, sent byte by byte: all ranks have the
   same digits. A broadcast a body, few. */
static PetscErrorCode BodiesProposeFrames(Bodies b, ModelLines *const lines[])
{
  PetscMPIInt rank, size, *first;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(b->comm, &rank));
  PetscCallMPI(MPI_Comm_size(b->comm, &size));
  PetscCall(PetscMalloc1(b->n_bodies, &first));
  for (PetscInt i = 0; i < b->n_bodies; i++) first[i] = LinesNeedFrame(lines[i]) ? rank : size;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, first, (PetscMPIInt)b->n_bodies, MPI_INT, MPI_MIN, b->comm));
  for (PetscInt i = 0; i < b->n_bodies; i++) {
    BodiesFrame *frame = &b->frame[i];

    if (first[i] == size) continue;
    if (first[i] == rank) {
      *frame = (BodiesFrame){.turned = lines[i]->turned, .oblique = lines[i]->oblique, .axis = lines[i]->axis};
      PetscCall(PetscArraycpy(frame->row, lines[i]->frame, 9));
      PetscCall(PetscArraycpy(frame->centre, lines[i]->centre, 3));
    }
    PetscCallMPI(MPI_Bcast(frame, sizeof(*frame), MPI_BYTE, first[i], b->comm));
  }
  PetscCall(PetscFree(first));
  PetscFunctionReturn(0);
}

/* Frames of all bodies, the same on every rank: proposed by one, kept where all ranks agree and the supports can be
   said in them. A copy of a shared node must have one basis everywhere, since forces are summed by components. */
static PetscErrorCode BodiesFindFrames(Bodies b, ModelLines *const lines[])
{
  PetscReal  scale;
  PetscBool *agreed;

  PetscFunctionBeginUser;
  PetscCall(BodiesFindScale(b, &scale));
  PetscCall(PetscMalloc1(b->n_bodies, &agreed));
  PetscCall(BodiesProposeFrames(b, lines));
  for (PetscInt i = 0; i < b->n_bodies; i++) {
    const BodiesFrame *frame = &b->frame[i];

    agreed[i] = frame->turned || frame->oblique ? PETSC_TRUE : PETSC_FALSE;
    if (!agreed[i]) continue;
    PetscCall(BodiesFrameSuits(b, i, frame, &agreed[i]));
    if (LinesNeedFrame(lines[i]) && !BodiesFrameAgrees(frame, lines[i], scale)) agreed[i] = PETSC_FALSE;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, agreed, (PetscMPIInt)b->n_bodies, MPIU_BOOL, MPI_LAND, b->comm));
  for (PetscInt i = 0; i < b->n_bodies; i++)
    if (!agreed[i]) b->frame[i].turned = b->frame[i].oblique = PETSC_FALSE;
  PetscCall(PetscFree(agreed));
  PetscFunctionReturn(0);
}

/* Rows along the axis, radial, tangential at a place off the axis (BodiesFrameSuits()): right-handed */
static void FrameTurnedBasis(const BodiesFrame *frame, const PetscReal x[3], PetscReal q[9])
{
  const PetscReal *along = &frame->row[3 * frame->axis];
  const PetscReal *j = &frame->row[3 * ((frame->axis + 1) % 3)], *k = &frame->row[3 * ((frame->axis + 2) % 3)];
  PetscReal        r[2], length;

  FrameAcross(frame, x, r);
  length = PetscSqrtReal(r[0] * r[0] + r[1] * r[1]);
  for (int d = 0; d < 3; d++) {
    q[d]     = along[d];
    q[3 + d] = r[0] / length * j[d] + r[1] / length * k[d];
    q[6 + d] = -r[1] / length * j[d] + r[0] / length * k[d];
  }
}

/* basis [n_vertices][3][3], rows of each node: along the axis, radial, tangential; the rows of an oblique frame; or
   x, y, z. Orthonormal, so that f' = Q f and u' = Q u. */
static PetscErrorCode LayoutFindBases(Bodies b)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(9 * b->layout.n_vertices, &b->layout.basis));
  for (PetscInt v = 0; v < b->layout.n_vertices; v++) {
    PetscReal         *q     = &b->layout.basis[9 * v];
    const BodiesFrame *frame = b->body[v] < 0 ? NULL : &b->frame[b->body[v]];

    q[0] = q[4] = q[8] = 1;
    if (!frame) continue;
    if (frame->turned)
      FrameTurnedBasis(frame, &b->mesh->x[3 * v], q);
    else if (frame->oblique)
      PetscCall(PetscArraycpy(q, frame->row, 9));
  }
  PetscFunctionReturn(0);
}

/* Keeps the lines of a body as swept ones where the stencil serves them */
static PetscErrorCode BodiesKeepSwept(Bodies b, PetscInt body, ModelLines **lines)
{
  SweptBody *swept    = &b->swept[b->n_swept];
  PetscBool  mirrored = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (!*lines) PetscFunctionReturn(0);
  if ((*lines)->turned == b->frame[body].turned && (*lines)->oblique == b->frame[body].oblique) {
    *swept        = (SweptBody){.body = body, .lines = *lines, .along = (*lines)->turned ? 2 : (*lines)->axis};
    *lines        = NULL;
    swept->stride = LayoutRoundUp(swept->lines->n_nodes + 2);
    PetscCall(SweptSetUp(b, swept, &mirrored));
    if (mirrored)
      b->n_swept++;
    else
      PetscCall(SweptDestroy(swept));
  }
  PetscCall(ModelDestroyLines(lines));
  PetscFunctionReturn(0);
}

PetscErrorCode BodiesFindSwept(Bodies b)
{
  ModelLines **lines;
  PetscBool   *local;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(b->n_bodies, &lines, b->n_bodies, &local));
  PetscCall(PetscCalloc1(b->n_bodies, &b->frame));
  PetscCall(PetscCalloc1(b->n_bodies, &b->swept));
  PetscCall(BodiesFlagLocal(b, local));
  for (PetscInt i = 0; i < b->n_bodies && !b->no_sweep; i++)
    if (local[i]) PetscCall(ModelCreateLines(b->model, i, b->body, &lines[i]));
  PetscCall(BodiesFindFrames(b, lines));
  PetscCall(LayoutFindBases(b));
  for (PetscInt i = 0; i < b->n_bodies; i++) PetscCall(BodiesKeepSwept(b, i, &lines[i]));
  PetscCall(PetscFree2(lines, local));
  PetscFunctionReturn(0);
}

/* Places of the nodes of a swept body */
static void SweptLayOut(const SweptBody *swept, Layout *layout)
{
  const ModelLines *lines = swept->lines;

  for (PetscInt l = 0; l < lines->n_lines; l++)
    for (PetscInt k = 0; k < lines->n_nodes; k++) {
      const PetscInt v = lines->vertex[lines->n_nodes * l + k];

      layout->at[v]   = swept->begin + 3 * l * swept->stride + k;
      layout->step[v] = swept->stride;
    }
}

/* Sorts nodes along the longest side of their box, and those of each half of it again, down to NODES_LEAF: what rows of
   neighbours read and add to stays in the nearest cache, and neighbouring rows are of like lengths */
static PetscErrorCode VerticesSort(const Mesh *mesh, PetscInt n, PetscInt vertex[], PetscReal key[])
{
  PetscReal low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
  int       longest = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < 3 * n; i++) {
    const PetscReal x = mesh->x[3 * vertex[i / 3] + i % 3];

    low[i % 3]  = i < 3 ? x : PetscMin(low[i % 3], x);
    high[i % 3] = i < 3 ? x : PetscMax(high[i % 3], x);
  }
  for (int d = 1; d < 3; d++)
    if (high[d] - low[d] > high[longest] - low[longest]) longest = d;
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal *x = &mesh->x[3 * vertex[i]];

    key[i] = x[longest] + TILT * (x[(longest + 1) % 3] + TILT * x[(longest + 2) % 3]);
  }
  PetscCall(PetscSortRealWithArrayInt(n, key, vertex));
  if (n <= NODES_LEAF) PetscFunctionReturn(0);
  PetscCall(VerticesSort(mesh, n / 2, vertex, key));
  PetscCall(VerticesSort(mesh, n - n / 2, vertex + n / 2, key));
  PetscFunctionReturn(0);
}

/* Places of all other nodes with cells: those that ranks share, then the rest */
static PetscErrorCode GeneralLayOut(Bodies b)
{
  General   *g = &b->general;
  Layout    *l = &b->layout;
  PetscReal *key;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(l->n_vertices, &g->vertex));
  PetscCall(PetscMalloc1(l->n_vertices, &key));
  for (int pass = 0; pass < 2; pass++) {
    for (PetscInt v = 0; v < l->n_vertices; v++) {
      if (b->body[v] < 0 || l->at[v] >= 0 || b->share.shared[v] == (PetscBool)pass) continue;
      g->vertex[g->n++] = v;
    }
    PetscCall(VerticesSort(b->mesh, g->n - g->n_early, &g->vertex[g->n_early], key));
    if (pass == 0) g->n_early = g->n;
    for (PetscInt i = pass ? g->n_early : 0; i < g->n; i++) {
      l->at[g->vertex[i]]   = g->begin + 3 * i;
      l->step[g->vertex[i]] = 1;
    }
  }
  PetscCall(PetscFree(key));
  PetscFunctionReturn(0);
}

PetscErrorCode BodiesLayOut(Bodies b)
{
  Layout *l = &b->layout;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(l->n_vertices, &l->at, l->n_vertices, &l->step));
  for (PetscInt v = 0; v < l->n_vertices; v++) {
    l->at[v]   = -1;
    l->step[v] = 0;
  }
  l->n = STENCIL_WIDTH;
  for (PetscInt i = 0; i < b->n_swept; i++) {
    b->swept[i].begin = l->n;
    SweptLayOut(&b->swept[i], l);
    l->n += 3 * b->swept[i].lines->n_lines * b->swept[i].stride;
  }
  l->n += STENCIL_WIDTH;
  b->general.begin = l->n;
  PetscCall(GeneralLayOut(b));
  l->n += LayoutRoundUp(3 * b->general.n + 1);
  for (PetscInt i = 0; i < b->n_swept; i++) PetscCall(SweptSetRanges(&b->swept[i], b->share.shared));
  PetscFunctionReturn(0);
}
