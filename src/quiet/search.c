/*
   The cells. The box of the options is the first; a cell of which nothing can be shown is cut in two. For the largest
   box those nearest to the scene's own values come first, until all that are nearer than a dangerous point (or than the
   faces of the box) are shown to be quiet, but for the tolerance:

      size = least distance of what is not shown to be quiet <= distance of the nearest dangerous point

   For the parts the largest cells come first, until the volume left open is within the tolerance. Ranks share the cells
   of a batch, which has the same number on any ranks.
*/
#include "quietimpl.h"
#include "base/process/progress.h"
#include <string.h>

#define CELL_BATCH 24
#define SLIVER     0.1 /* a cell is not cut across an edge shorter than this part of the longest */

static PetscReal CellVolume(const Quiet q, const QuietCell *cell)
{
  PetscReal volume = 1;

  for (PetscInt k = 0; k < q->cube.n; k++) volume *= 0.5 * (cell->high[k] - cell->low[k]);
  return volume;
}

/* How near a cell must be to be of use */
static PetscReal SearchReach(const Quiet q)
{
  if (q->goal == QUIET_PARTS) return PETSC_INFINITY;
  return (1 - q->tolerance) * (q->danger.found ? PetscMin(1, q->danger.distance) : 1);
}

/* The longest edge, or the one that was asked for unless that is a sliver's */
static PetscInt CutAxis(const Quiet q, const QuietCell *cell, PetscInt asked)
{
  PetscInt longest = 0;

  for (PetscInt k = 1; k < q->cube.n; k++)
    if (cell->high[k] - cell->low[k] > cell->high[longest] - cell->low[longest]) longest = k;
  if (asked < 0) return longest;
  return cell->high[asked] - cell->low[asked] < SLIVER * (cell->high[longest] - cell->low[longest]) ? longest : asked;
}

/* Tests a cell; a nearer dangerous point goes to `nearest`. Not collective */
static PetscErrorCode CellTest(Quiet q, QuietCell *cell, DangerPoint *nearest)
{
  const Box     *box     = &q->box;
  const Reduced *reduced = box->small.n_used ? &box->small : &box->basis.reduced;
  CellRegion     region  = {box->window.low, box->window.high, 0, ModesLimitInForce(&box->limit)};
  CellFrame      frame;
  DangerPoint    middle;
  PetscReal      t[CUBE_MAX_VARIABLES];
  PetscInt       axis = -1;
  PetscBool      holds;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < q->cube.n; k++) t[k] = 0.5 * (cell->low[k] + cell->high[k]);
  PetscCall(QuietLook(q, t, &middle, &cell->error, &cell->unstable));
  cell->growth = middle.sigma;
  region.error = cell->error;
  if (cell->unstable && middle.distance < nearest->distance) {
    PetscCall(QuietNearer(q, &middle));
    *nearest = middle;
  }
  if (!cell->unstable || q->goal == QUIET_PARTS) {
    PetscCall(CellFrameCreate(reduced, &q->cube, cell->low, cell->high, box->window.high, &frame));
    if (cell->unstable)
      PetscCall(CellFrameIsDangerous(&frame, &region, &holds));
    else
      PetscCall(CellFrameIsQuiet(&frame, &region, &holds, &cell->margin, &axis));
    if (holds) cell->state = cell->unstable ? CELL_DANGEROUS : CELL_QUIET;
    PetscCall(CellFrameDestroy(&frame));
  }
  cell->axis = CutAxis(q, cell, axis);
  PetscFunctionReturn(0);
}

static PetscErrorCode CellAdd(Quiet q, const QuietCell *cell)
{
  PetscFunctionBeginUser;
  if (q->n_cells == q->n_room) {
    q->n_room = 2 * q->n_room + 64;
    PetscCall(PetscRealloc((size_t)q->n_room * sizeof(*q->cell), &q->cell));
  }
  q->cell[q->n_cells]      = *cell;
  q->cell[q->n_cells].near = CubeNear(&q->cube, cell->low, cell->high);
  q->n_cells++;
  PetscFunctionReturn(0);
}

/* Replaces cell i by its halves */
static PetscErrorCode CellCut(Quiet q, PetscInt i)
{
  QuietCell half = q->cell[i];

  PetscFunctionBeginUser;
  q->cell[i].split           = PETSC_TRUE;
  half.axis                  = -1;
  half.high[q->cell[i].axis] = 0.5 * (half.low[q->cell[i].axis] + half.high[q->cell[i].axis]);
  PetscCall(CellAdd(q, &half));
  half.low[q->cell[i].axis]  = half.high[q->cell[i].axis];
  half.high[q->cell[i].axis] = q->cell[i].high[q->cell[i].axis];
  PetscCall(CellAdd(q, &half));
  PetscFunctionReturn(0);
}

/* What comes first: the nearest, or the largest */
static PetscReal CellKey(const Quiet q, const QuietCell *cell)
{
  return q->goal == QUIET_BOX ? cell->near : -CellVolume(q, cell);
}

/* The next cells: their indices, and how many */
static PetscErrorCode BatchChoose(const Quiet q, PetscInt list[], PetscInt *n)
{
  const PetscReal reach = SearchReach(q);
  PetscReal       key[CELL_BATCH];

  PetscFunctionBeginUser;
  *n = 0;
  for (PetscInt i = 0; i < q->n_cells; i++) {
    const QuietCell *cell = &q->cell[i];
    const PetscReal  mine = CellKey(q, cell);
    PetscInt         k;

    if (cell->split || cell->state != CELL_OPEN || cell->axis >= 0 || cell->near >= reach) continue;
    if (*n == CELL_BATCH && mine >= key[CELL_BATCH - 1]) continue;
    if (*n < CELL_BATCH) ++*n;
    for (k = *n - 1; k > 0 && key[k - 1] > mine; k--) key[k] = key[k - 1], list[k] = list[k - 1];
    key[k] = mine, list[k] = i;
  }
  *n = PetscMin(*n, q->max_cells - q->n_tested);
  PetscFunctionReturn(0);
}

static PetscErrorCode BatchRun(Quiet q, PetscInt n, const PetscInt list[])
{
  DangerPoint nearest = q->danger;
  PetscMPIInt rank;
  PetscBool   nearer;

  PetscFunctionBeginUser;
  if (!nearest.found) nearest.distance = PETSC_MAX_REAL;
  PetscCallMPI(MPI_Comm_rank(q->comm, &rank));
  for (PetscInt k = 0; k < n; k++)
    if (PointGroupsOwner(&q->box.groups, k) == rank) PetscCall(CellTest(q, &q->cell[list[k]], &nearest));
  for (PetscInt k = 0; k < n; k++)
    PetscCallMPI(MPI_Bcast(&q->cell[list[k]], (PetscMPIInt)sizeof(QuietCell), MPI_BYTE,
                           PointGroupsOwner(&q->box.groups, k), q->comm));
  PetscCall(QuietShareNearest(q, &nearest, &nearer));
  if (nearer) PetscCall(QuietRefine(q));
  for (PetscInt k = 0; k < n; k++) {
    q->error = PetscMax(q->error, q->cell[list[k]].error);
    if (q->cell[list[k]].state == CELL_OPEN) PetscCall(CellCut(q, list[k]));
  }
  q->n_tested += n;
  PetscFunctionReturn(0);
}

/* Size, margin and volumes */
static void SearchSum(Quiet q)
{
  q->size   = q->danger.found ? PetscMin(1, q->danger.distance) : 1;
  q->margin = PETSC_MAX_REAL;
  memset(q->share, 0, sizeof(q->share));
  for (PetscInt i = 0; i < q->n_cells; i++) {
    const QuietCell *cell = &q->cell[i];

    if (cell->split) continue;
    q->share[cell->state] += CellVolume(q, cell);
    if (cell->state != CELL_QUIET) q->size = PetscMin(q->size, cell->near);
  }
  for (PetscInt i = 0; i < q->n_cells; i++)
    if (q->cell[i].state == CELL_QUIET && (q->goal == QUIET_PARTS || q->cell[i].near < q->size))
      q->margin = PetscMin(q->margin, q->cell[i].margin);
}

PetscErrorCode QuietSearch(Quiet q)
{
  QuietCell whole = {.state = CELL_OPEN, .axis = -1};
  PetscInt  list[CELL_BATCH], n;
  Progress  progress;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < q->cube.n; k++) whole.low[k] = -1, whole.high[k] = 1;
  PetscCall(CellAdd(q, &whole));
  PetscCall(ProgressBegin(&progress, "cells", q->max_cells));
  while (1) {
    SearchSum(q);
    if (q->goal == QUIET_PARTS && q->share[CELL_OPEN] <= q->tolerance) break;
    PetscCall(BatchChoose(q, list, &n));
    if (!n) break;
    PetscCall(BatchRun(q, n, list));
    for (PetscInt k = 0; k < n; k++) PetscCall(ProgressStep(&progress));
  }
  PetscCall(ProgressEnd(&progress));
  PetscFunctionReturn(0);
}
