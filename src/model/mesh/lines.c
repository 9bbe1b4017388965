/*
   Lines along which the cells of a body are swept by an angle or along an axis: the motions that may have swept it are
   those between opposite faces of its first cell, three at most (kernels/motion.h); swept.c tries them on all cells.
*/
#include "model/modelimpl.h"
#include "swept.h"

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

/* The motion between two opposite faces of the first cell; whether there is one */
static PetscBool PieceMotion(const Piece *piece, int pair, Motion *motion)
{
  double x[LINES_CORNERS][3];

  for (int i = 0; i < LINES_CORNERS; i++)
    for (int d = 0; d < 3; d++) x[i][d] = piece->x[3 * piece->corners[i] + d];
  return MotionFind((const double(*)[3])x, pair, piece->size, LINES_TOLERANCE * piece->size, motion) ? PETSC_TRUE
                                                                                                     : PETSC_FALSE;
}

PetscErrorCode ModelCreateLines(Model model, PetscInt body, const PetscInt body_of_vertex[], ModelLines **lines)
{
  Piece       piece = {0};
  Motion      motion;
  ModelLines *found;

  PetscFunctionBeginUser;
  *lines = NULL;
  if (!BodyIsHexahedra(&model->mesh, body, body_of_vertex)) PetscFunctionReturn(0);
  PetscCall(PieceCreate(model, body, body_of_vertex, &piece));
  for (int pair = 0; pair < MOTION_PAIRS && piece.n_cells; pair++) {
    if (!PieceMotion(&piece, pair, &motion)) continue;
    PetscCall(SweptCreateLines(&piece, &motion, &found));
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
