/*
   Lines along which the cells of a body are swept by an angle or along an axis: the motions that may have swept it are
   those between opposite faces of its first cell, three at most (kernels/element/motion.h); swept.c tries them on all
   cells. An axis that is none of x, y, z becomes the third one of a frame in which the same is asked.
*/
#include "model/modelimpl.h"
#include "swept.h"
#include "base/algebra/vec3.h"

#define AXIS_ROW 2 /* the axis in a frame that is not x, y, z */

static const PetscReal coordinate_frame[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

static PetscErrorCode PieceDestroy(Piece *piece)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(piece->vertex));
  PetscCall(PetscFree(piece->x));
  PetscCall(PetscFree2(piece->corners, piece->part));
  PetscFunctionReturn(0);
}

/* Coordinates of the nodes of a piece, and its size */
static PetscErrorCode PieceMeasure(Model model, Piece *piece)
{
  PetscReal lower[3], upper[3];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(3 * piece->n_nodes, &piece->x));
  for (PetscInt i = 0; i < piece->n_nodes; i++)
    for (int d = 0; d < 3; d++) {
      const PetscReal x = piece->x[3 * i + d] = model->mesh.x[3 * piece->vertex[i] + d];

      lower[d] = i ? PetscMin(lower[d], x) : x;
      upper[d] = i ? PetscMax(upper[d], x) : x;
    }
  for (int d = 0; d < 3 && piece->n_nodes; d++) piece->size += PetscSqr(upper[d] - lower[d]);
  piece->size = PetscSqrtReal(piece->size);
  PetscFunctionReturn(0);
}

/* Whether all local cells of the body have the nodes of a hexahedron of first order */
static PetscBool BodyIsHexahedra(const Mesh *mesh, PetscInt body, const PetscInt body_of_vertex[])
{
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    if (body_of_vertex[mesh->cell_node[mesh->cell_first[c]]] == body && mesh->element[c]->n_nodes != LINES_CORNERS)
      return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Local cells of the body and their nodes */
static PetscErrorCode PieceCreate(Model model, PetscInt body, const PetscInt body_of_vertex[], Piece *piece)
{
  const Mesh *mesh = &model->mesh;
  PetscInt   *node;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(LINES_CORNERS * mesh->n_cells, &piece->corners, mesh->n_cells, &piece->part));
  PetscCall(PetscMalloc1(mesh->n_nodes, &piece->vertex));
  PetscCall(PetscMalloc1(mesh->n_nodes, &node));
  for (PetscInt v = 0; v < mesh->n_nodes; v++) node[v] = -1;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscInt *corner = &mesh->cell_node[mesh->cell_first[c]];

    if (body_of_vertex[corner[0]] != body) continue;
    for (int i = 0; i < LINES_CORNERS; i++) {
      const PetscInt v = corner[i];

      if (node[v] < 0) {
        node[v]                         = piece->n_nodes;
        piece->vertex[piece->n_nodes++] = v;
      }
      piece->corners[LINES_CORNERS * piece->n_cells + i] = node[v];
    }
    piece->part[piece->n_cells++] = mesh->cell_part[c];
  }
  PetscCall(PetscFree(node));
  PetscCall(PieceMeasure(model, piece));
  PetscFunctionReturn(0);
}

/* Whether a is the better choice: the longer lines, then an angle, then the first axis */
static PetscBool LinesBetter(const ModelLines *a, const ModelLines *b)
{
  if (!a || !b) return a ? PETSC_TRUE : PETSC_FALSE;
  if (a->n_nodes != b->n_nodes) return a->n_nodes > b->n_nodes ? PETSC_TRUE : PETSC_FALSE;
  if (a->turned != b->turned) return a->turned;
  return a->axis < b->axis ? PETSC_TRUE : PETSC_FALSE;
}

/* A right-handed frame whose row AXIS_ROW has this direction, the larger part of it positive */
static void FrameAbout(PetscReal direction[3], PetscReal frame[9])
{
  PetscReal least[3] = {0, 0, 0};
  int       d_least = 0, d_most = 0;

  for (int d = 1; d < 3; d++) {
    if (PetscAbsReal(direction[d]) < PetscAbsReal(direction[d_least])) d_least = d;
    if (PetscAbsReal(direction[d]) > PetscAbsReal(direction[d_most])) d_most = d;
  }
  for (int d = 0; d < 3; d++) frame[3 * AXIS_ROW + d] = direction[d_most] < 0 ? -direction[d] : direction[d];
  least[d_least] = 1;
  Vec3Cross(least, &frame[3 * AXIS_ROW], &frame[0]);
  (void)Vec3Normalise(&frame[0]);
  Vec3Cross(&frame[3 * AXIS_ROW], &frame[0], &frame[3]);
}

/* Coordinates y of x in a frame, both [n][3] */
static void LinesTurnTo(const PetscReal frame[9], PetscInt n, const PetscReal x[], PetscReal y[])
{
  for (PetscInt i = 0; i < n; i++)
    for (int d = 0; d < 3; d++) y[3 * i + d] = Vec3Dot(&frame[3 * d], &x[3 * i]);
}

/* The motion between two opposite faces of the first cell and the frame in which its axis is a coordinate; whether
   there is one */
static PetscBool PieceMotion(const Piece *piece, int pair, Motion *motion, PetscReal frame[9])
{
  const PetscReal tolerance = LINES_TOLERANCE * piece->size;
  double          x[LINES_CORNERS][3], y[LINES_CORNERS][3], direction[3];

  for (int i = 0; i < LINES_CORNERS; i++)
    for (int d = 0; d < 3; d++) x[i][d] = piece->x[3 * piece->corners[i] + d];
  for (int i = 0; i < 9; i++) frame[i] = coordinate_frame[i];
  if (MotionFind((const double(*)[3])x, pair, piece->size, tolerance, motion)) return PETSC_TRUE;
  if (!MotionDirection((const double(*)[3])x, pair, direction)) return PETSC_FALSE;
  FrameAbout(direction, frame);
  LinesTurnTo(frame, LINES_CORNERS, &x[0][0], &y[0][0]);
  return MotionFindAlong((const double(*)[3])y, pair, AXIS_ROW, 0, tolerance, motion) ? PETSC_TRUE : PETSC_FALSE;
}

/* The lines of one motion, NULL where it sweeps not all cells */
static PetscErrorCode LinesCreate(const Piece *piece, const Motion *motion, const PetscReal frame[9],
                                  ModelLines **lines)
{
  Piece     turned  = *piece;
  PetscBool oblique = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (int i = 0; i < 9; i++)
    if (frame[i] != coordinate_frame[i]) oblique = PETSC_TRUE;
  if (oblique) {
    PetscCall(PetscMalloc1(3 * piece->n_nodes, &turned.x));
    LinesTurnTo(frame, piece->n_nodes, piece->x, turned.x);
  }
  PetscCall(SweptCreateLines(&turned, motion, lines));
  if (oblique) PetscCall(PetscFree(turned.x));
  if (!*lines) PetscFunctionReturn(0);
  (*lines)->oblique = oblique;
  PetscCall(PetscArraycpy((*lines)->frame, frame, 9));
  PetscCall(PetscArrayzero((*lines)->centre, 3));
  for (int d = 0; d < 3; d++)
    for (int e = 0; e < 3; e++) (*lines)->centre[e] += motion->centre[d] * frame[3 * d + e];
  PetscFunctionReturn(0);
}

PetscErrorCode ModelCreateLines(Model model, PetscInt body, const PetscInt body_of_vertex[], ModelLines **lines)
{
  Piece       piece = {0};
  Motion      motion;
  PetscReal   frame[9];
  ModelLines *found;

  PetscFunctionBeginUser;
  *lines = NULL;
  if (!BodyIsHexahedra(&model->mesh, body, body_of_vertex)) PetscFunctionReturn(0);
  PetscCall(PieceCreate(model, body, body_of_vertex, &piece));
  for (int pair = 0; pair < MOTION_PAIRS && piece.n_cells; pair++) {
    if (!PieceMotion(&piece, pair, &motion, frame)) continue;
    PetscCall(LinesCreate(&piece, &motion, frame, &found));
    if (!LinesBetter(found, *lines)) {
      PetscCall(ModelDestroyLines(&found));
      continue;
    }
    PetscCall(ModelDestroyLines(lines));
    *lines = found;
  }
  PetscCall(PieceDestroy(&piece));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelDestroyLines(ModelLines **lines)
{
  PetscFunctionBeginUser;
  if (!*lines) PetscFunctionReturn(0);
  PetscCall(PetscFree((*lines)->vertex));
  PetscCall(PetscFree(*lines));
  PetscFunctionReturn(0);
}
