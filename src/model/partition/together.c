/*
   Cells that the partition leaves on one rank because they are at the contact: those with a node on a face of a
   `together` set that lies opposite another such set (of the disc's whole face only the part under the pad), or on any
   of its faces when it is the only set. A contact of more cells than a rank's share is cut like the rest; pairs are
   found across ranks.
*/
#include "model/modelimpl.h"
#include "partition.h"

#define OPPOSITE 0.1 /* largest gap of facing boxes, relative to the diagonal of the face's box */

typedef struct {
  PetscReal lower[3], upper[3]; /* m */
} TogetherBox;

static const TogetherBox BOX_EMPTY = {{PETSC_MAX_REAL, PETSC_MAX_REAL, PETSC_MAX_REAL},
                                      {PETSC_MIN_REAL, PETSC_MIN_REAL, PETSC_MIN_REAL}};

/* Widens a box to the nodes of a point */
static PetscErrorCode BoxAddPoint(DM dm, PetscInt point, TogetherBox *box)
{
  PetscScalar *x = NULL;
  PetscInt     size;
  PetscSection section;
  Vec          coordinates;

  PetscFunctionBeginUser;
  PetscCall(DMGetCoordinateSection(dm, &section));
  PetscCall(DMGetCoordinatesLocal(dm, &coordinates));
  PetscCall(DMPlexVecGetClosure(dm, section, coordinates, point, &size, &x));
  for (PetscInt i = 0; i < size; i++) {
    box->lower[i % 3] = PetscMin(box->lower[i % 3], PetscRealPart(x[i]));
    box->upper[i % 3] = PetscMax(box->upper[i % 3], PetscRealPart(x[i]));
  }
  PetscCall(DMPlexVecRestoreClosure(dm, section, coordinates, point, &size, &x));
  PetscFunctionReturn(0);
}

/* Whether the box of a face, widened by a part of its diagonal, meets another box */
static PetscBool BoxMeets(const TogetherBox *face, const TogetherBox *other)
{
  PetscReal square = 0, gap;

  for (PetscInt d = 0; d < 3; d++) square += PetscSqr(face->upper[d] - face->lower[d]);
  gap = OPPOSITE * PetscSqrtReal(square);
  for (PetscInt d = 0; d < 3; d++) {
    if (face->lower[d] - gap > other->upper[d] || face->upper[d] + gap < other->lower[d]) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Bounding box of a set; empty when the mesh has no such set */
static PetscErrorCode SetBox(DM dm, const char set[], TogetherBox *box)
{
  IS              points;
  const PetscInt *point;
  PetscInt        n;

  PetscFunctionBeginUser;
  *box = BOX_EMPTY;
  PetscCall(DMGetStratumIS(dm, set, 1, &points));
  if (!points) PetscFunctionReturn(0);
  PetscCall(ISGetLocalSize(points, &n));
  PetscCall(ISGetIndices(points, &point));
  for (PetscInt p = 0; p < n; p++) PetscCall(BoxAddPoint(dm, point[p], box));
  PetscCall(ISRestoreIndices(points, &point));
  PetscCall(ISDestroy(&points));
  PetscFunctionReturn(0);
}

/* Flags every cell that has a node in common with a point; at_contact [cells] */
static PetscErrorCode FlagCellsAt(DM dm, PetscInt point, PetscBool at_contact[])
{
  PetscInt *closure = NULL, *star = NULL, n_closure, n_star, vStart, vEnd, cStart, cEnd;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetDepthStratum(dm, 0, &vStart, &vEnd));
  PetscCall(DMPlexGetHeightStratum(dm, 0, &cStart, &cEnd));
  PetscCall(DMPlexGetTransitiveClosure(dm, point, PETSC_TRUE, &n_closure, &closure));
  for (PetscInt p = 0; p < n_closure; p++) {
    const PetscInt v = closure[2 * p];

    if (v < vStart || v >= vEnd) continue;
    PetscCall(DMPlexGetTransitiveClosure(dm, v, PETSC_FALSE, &n_star, &star));
    for (PetscInt s = 0; s < n_star; s++) {
      if (star[2 * s] >= cStart && star[2 * s] < cEnd) at_contact[star[2 * s] - cStart] = PETSC_TRUE;
    }
    PetscCall(DMPlexRestoreTransitiveClosure(dm, v, PETSC_FALSE, &n_star, &star));
  }
  PetscCall(DMPlexRestoreTransitiveClosure(dm, point, PETSC_TRUE, &n_closure, &closure));
  PetscFunctionReturn(0);
}

/* Flags the cells of one set that lie opposite another set, all of them when there is no other */
static PetscErrorCode FlagCellsOfSet(DM dm, PetscInt n_sets, char *const sets[], PetscInt set,
                                     const TogetherBox boxes[], PetscBool at_contact[])
{
  IS              points;
  const PetscInt *point;
  PetscInt        n;

  PetscFunctionBeginUser;
  PetscCall(DMGetStratumIS(dm, sets[set], 1, &points));
  if (!points) PetscFunctionReturn(0);
  PetscCall(ISGetLocalSize(points, &n));
  PetscCall(ISGetIndices(points, &point));
  for (PetscInt p = 0; p < n; p++) {
    TogetherBox box   = BOX_EMPTY;
    PetscBool   faces = n_sets == 1 ? PETSC_TRUE : PETSC_FALSE;

    PetscCall(BoxAddPoint(dm, point[p], &box));
    for (PetscInt other = 0; other < n_sets && !faces; other++) {
      if (other != set) faces = BoxMeets(&box, &boxes[other]);
    }
    if (faces) PetscCall(FlagCellsAt(dm, point[p], at_contact));
  }
  PetscCall(ISRestoreIndices(points, &point));
  PetscCall(ISDestroy(&points));
  PetscFunctionReturn(0);
}

PetscErrorCode TogetherFlag(Model model, PetscBool at_contact[])
{
  TogetherBox    boxes[MODEL_MAX_NAMES];
  const PetscInt n = model->n_together;

  PetscFunctionBeginUser;
  for (PetscInt s = 0; s < n; s++) PetscCall(SetBox(model->dm, model->together[s], &boxes[s]));
  for (PetscInt s = 0; s < n; s++) PetscCall(FlagCellsOfSet(model->dm, n, model->together, s, boxes, at_contact));
  PetscFunctionReturn(0);
}

PetscErrorCode TogetherFind(Model model, PetscInt n_ranks, Clusters *clusters)
{
  PetscInt   n_contact = 0;
  PetscBool *at_contact;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(clusters->n_cells, &at_contact));
  if (clusters->n_cells) PetscCall(TogetherFlag(model, at_contact));
  for (PetscInt c = 0; c < clusters->n_cells; c++) n_contact += at_contact[c] ? 1 : 0;
  if (n_contact && n_contact * n_ranks <= clusters->n_cells) {
    for (PetscInt c = 0; c < clusters->n_cells; c++) clusters->of_cell[c] = at_contact[c] ? 0 : -1;
    clusters->n = 1;
  }
  PetscCall(PetscFree(at_contact));
  PetscFunctionReturn(0);
}
