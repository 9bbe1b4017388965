/*
   Sweeps with planes of symmetry (-symmetry): one for each parity, with a basis, branches and onsets of its own, on the
   same points, then all of them in one table. The proof that the scene is its own mirror image is made before, at points
   that tell it for all: along an axis a difference is a sum of m powers of p > 0, and of others of p < 0, since |p| stands
   among the coefficients. Where it vanishes at m values of one sign it vanishes at all of them (Descartes' rule of signs).
   With terms of factors p and 1 / p, of which one parameter has -1, 0, 1 and 2 for power, m is 4; where a link moves
   several, -1 to the number of factors.
*/
#include "sweepimpl.h"
#include <petsctime.h>
#include <string.h>

#define PARITY_SAME 1e-7 /* relative difference of frequencies that no order rests on */
#define PROOF_VALUES 4                           /* of each sign, of an axis that moves one parameter */
#define PROOF_LINKED (OPERATORS_MAX_FACTORS + 2) /* of one that moves several */

PetscErrorCode SweepNameParities(Sweep sweep, Pencil pencil)
{
  Operators operators;

  PetscFunctionBeginUser;
  PetscCall(PencilGetOperators(pencil, &operators));
  PetscCall(OperatorsNeedMirrors(operators, "sweeps"));
  PetscCall(PencilCountParities(pencil, &sweep->n_parities));
  for (PetscInt c = 0; c < sweep->n_parities; c++)
    PetscCall(PencilNameParity(pencil, c, sizeof(sweep->parity_name[c]), sweep->parity_name[c]));
  PetscFunctionReturn(0);
}

PetscInt SweepFindParity(Sweep sweep, const char name[])
{
  PetscInt c = sweep->n_parities - 1;

  while (c > 0 && strcmp(sweep->parity_name[c], name) != 0) c--;
  return c;
}

/* At which values of an axis the proof is made: so many of each sign, from the first to the last */
static PetscErrorCode ProofPick(const SweepGrid *grid, PetscInt axis, PetscBool **takes)
{
  const PetscInt n = grid->n_moved[axis] > 1 ? PROOF_LINKED : PROOF_VALUES;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(grid->n[axis], takes));
  for (int sign = 0; sign < 2; sign++) {
    PetscInt n_all = 0, at = 0, next = 0;

    for (PetscInt i = 0; i < grid->n[axis]; i++) n_all += (grid->value[axis][i] < 0) == sign;
    for (PetscInt i = 0; i < grid->n[axis]; i++) {
      if ((grid->value[axis][i] < 0) != sign) continue;
      (*takes)[i] = at == next * (n_all - 1) / (n - 1) ? PETSC_TRUE : PETSC_FALSE;
      for (; next < n && next * (n_all - 1) / (n - 1) <= at; next++) continue;
      at++;
    }
  }
  PetscFunctionReturn(0);
}

/* Raises an error where the scene is not its own mirror image at some point of the sweep */
static PetscErrorCode ParitiesProve(Sweep sweep)
{
  const SweepGrid *grid = &sweep->grid;
  PetscBool       *takes[GRID_MAX_AXES] = {NULL}; /* [values] of each axis */
  PetscBool       *seen;                          /* [statuses] of the contact */
  PetscReal       *p;
  PetscInt         n;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(PetscMax(1, sweep->statuses.n), &seen));
  PetscCall(PetscMalloc1(grid->n_parameters, &p));
  for (PetscInt a = 0; a < grid->n_axes; a++) PetscCall(ProofPick(grid, a, &takes[a]));
  for (PetscInt k = 0; k < grid->n_places; k++) {
    const SweepPlace *place = &grid->place[k];
    PetscBool         taken = place->point >= 0 ? takes[0][place->point % grid->n[0]] : PETSC_FALSE;

    if (grid->n_axes == 2 && taken) taken = takes[1][place->point / grid->n[0]];
    if (!taken && seen[place->status]) continue;
    seen[place->status] = PETSC_TRUE;
    GridFill(grid, place, p);
    PetscCall(PencilSetParameters(sweep->pencil, p));
    PetscCall(PencilGetParities(sweep->pencil, &n, NULL));
  }
  if (sweep->uncertain[0]) PetscCall(SweepUncertainProve(sweep));
  for (PetscInt a = 0; a < grid->n_axes; a++) PetscCall(PetscFree(takes[a]));
  PetscCall(PetscFree(seen));
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

/* The sweep of one parity: options, points and contact statuses are those of the whole */
static PetscErrorCode PartCreate(Sweep sweep, PetscInt c, Sweep *part)
{
  PencilMatrices matrices;
  Sweep          s;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(1, &s));
  *s        = *sweep;
  s->parity = c;
  s->pencil = NULL;
  s->risk   = NULL;
  s->label  = NULL;
  s->worst  = NULL;
  s->events = (BranchEvents){0};
  s->n_branches = s->n_risks = 0;
  s->worst_risk              = 0;
  s->is_confirmed            = NULL;
  PetscCall(PetscArrayzero(s->part, SWEEP_PARITIES));
  PetscCall(PetscArrayzero(s->seconds, PETSC_STATIC_ARRAY_LENGTH(s->seconds)));
  *part = s;
  PetscCall(PencilCreateParity(sweep->pencil, c, &s->pencil));
  PetscCall(PencilGetFrictionless(s->pencil, &matrices));
  PetscCall(MatGetSize(matrices.K, &s->unknowns, NULL));
  PetscCall(PetscCalloc1(GridSize(&s->grid), &s->point));
  PetscCall(PetscCalloc1(s->n_checks, &s->check));
  for (PetscInt i = 0; i < s->n_checks; i++) s->check[i].at = sweep->check[i].at;
  s->groups.store       = &s->store;
  s->greedy.may_be_none = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Adds the modes of a part to those of each point */
static PetscErrorCode PartTakePoints(Sweep sweep, const Sweep part)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < GridSize(&sweep->grid); i++) {
    SweepPoint       *all = &sweep->point[i];
    const SweepPoint *own = &part->point[i];

    PetscCall(PetscRealloc((size_t)PetscMax(1, all->n + own->n) * sizeof(*all->mode), &all->mode));
    PetscCall(PetscArraycpy(&all->mode[all->n], own->mode, own->n));
    for (PetscInt k = all->n; k < all->n + own->n; k++) {
      if (all->mode[k].branch >= 0) all->mode[k].branch += sweep->n_branches;
      all->mode[k].parity = part->parity;
    }
    all->n += own->n;
  }
  PetscFunctionReturn(0);
}

/* Adds the onsets of a part, and whether they are confirmed */
static PetscErrorCode PartTakeOnsets(Sweep sweep, const Sweep part)
{
  BranchEvents  *all = &sweep->events;
  const PetscInt n   = all->n + part->events.n;

  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)PetscMax(1, n) * sizeof(*all->event), &all->event));
  PetscCall(PetscArraycpy(&all->event[all->n], part->events.event, part->events.n));
  for (PetscInt e = all->n; e < n; e++)
    for (int k = 0; k < 2; k++)
      if (all->event[e].branch[k] >= 0) all->event[e].branch[k] += sweep->n_branches;
  if (part->is_confirmed) {
    PetscCall(PetscRealloc((size_t)PetscMax(1, n) * sizeof(*sweep->is_confirmed), &sweep->is_confirmed));
    PetscCall(PetscArraycpy(&sweep->is_confirmed[all->n], part->is_confirmed, part->events.n));
  }
  all->n = n;
  PetscFunctionReturn(0);
}

/* Adds what full solutions said of a part */
static void PartTakeChecks(Sweep sweep, const Sweep part)
{
  for (PetscInt i = 0; i < sweep->n_checks; i++) {
    SweepCheck       *all = &sweep->check[i];
    const SweepCheck *own = &part->check[i];

    if (own->error >= all->error) all->omega = own->omega;
    all->n_full += own->n_full;
    all->n_reduced += own->n_reduced;
    all->n_unstable_full += own->n_unstable_full;
    all->n_unstable_reduced += own->n_unstable_reduced;
    all->n_beyond += own->n_beyond;
    all->error    = PetscMax(all->error, own->error);
    all->estimate = PetscMax(all->estimate, own->estimate);
    all->full     = PetscMax(all->full, own->full);
    all->ratio    = PetscMax(all->ratio, own->ratio);
  }
}

/* Adds names and risks of a part */
static PetscErrorCode PartTakeNames(Sweep sweep, const Sweep part)
{
  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)PetscMax(1, sweep->n_branches + part->n_branches) * sizeof(*sweep->label),
                         &sweep->label));
  PetscCall(PetscArraycpy(&sweep->label[sweep->n_branches], part->label, part->n_branches));
  for (PetscInt b = 0; b < part->n_branches; b++) sweep->label[sweep->n_branches + b].parity = part->parity;
  PetscCall(PetscRealloc((size_t)PetscMax(1, sweep->n_risks + part->n_risks) * sizeof(*sweep->risk), &sweep->risk));
  PetscCall(PetscArraycpy(&sweep->risk[sweep->n_risks], part->risk, part->n_risks));
  for (PetscInt i = 0; i < part->n_risks; i++) sweep->risk[sweep->n_risks + i].parity = part->parity;
  sweep->n_risks += part->n_risks;
  sweep->n_combinations = part->n_combinations;
  sweep->worst_risk     = PetscMax(sweep->worst_risk, part->worst_risk);
  PetscFunctionReturn(0);
}

/* Adds a part, of which the dense model stays */
static PetscErrorCode PartTake(Sweep sweep, Sweep part)
{
  PetscFunctionBeginUser;
  part->first_branch = sweep->n_branches;
  PetscCall(PartTakePoints(sweep, part));
  PetscCall(PartTakeOnsets(sweep, part));
  PartTakeChecks(sweep, part);
  PetscCall(PartTakeNames(sweep, part));
  sweep->n_branches += part->n_branches;
  sweep->whole_unknowns += part->unknowns;
  sweep->statuses = part->statuses; /* onsets look at the sliding state again */
  sweep->n_static = part->n_static;
  for (int i = 0; i < 4; i++) sweep->seconds[i] += part->seconds[i];
  PetscCall(CorrectionDestroy(&part->greedy.correction));
  PetscCall(BVDestroy(&part->basis.vectors));
  PetscCall(MatDestroy(&part->basis.M));
  PetscCall(PencilReleaseParity(part->pencil));
  PetscFunctionReturn(0);
}

/* By frequency; modes of two parities that only rounding tells apart, by parity */
static PetscBool ModeIsAfter(const SweepMode *a, const SweepMode *b)
{
  const PetscReal close = PARITY_SAME * PetscMax(a->omega, b->omega);

  if (PetscAbsReal(a->omega - b->omega) > close) return a->omega > b->omega ? PETSC_TRUE : PETSC_FALSE;
  return a->parity > b->parity ? PETSC_TRUE : PETSC_FALSE;
}

static void PointSort(PetscInt n, SweepMode mode[])
{
  for (PetscInt i = 1; i < n; i++) {
    const SweepMode own = mode[i];
    PetscInt        k   = i;

    for (; k > 0 && ModeIsAfter(&mode[k - 1], &own); k--) mode[k] = mode[k - 1];
    mode[k] = own;
  }
}

PetscErrorCode SweepParities(Sweep sweep)
{
  PetscLogDouble since;
  PetscInt       n_modes = 0;
  PetscReal      band[2], growth;

  PetscFunctionBeginUser;
  PetscCall(ParitiesProve(sweep));
  for (PetscInt c = 0; c < sweep->n_parities; c++) {
    PetscCall(PartCreate(sweep, c, &sweep->part[c]));
    PetscCall(ModesSetPencil(sweep->modes, sweep->part[c]->pencil));
    PetscCall(PetscTime(&since));
    if (sweep->part[c]->unknowns) PetscCall(SweepReduced(sweep->part[c], &since));
    PetscCall(PartTake(sweep, sweep->part[c]));
  }
  PetscCall(ModesSetPencil(sweep->modes, sweep->pencil));
  if (sweep->is_confirmed) SweepSortOnsets(sweep);
  for (PetscInt i = 0; i < GridSize(&sweep->grid); i++) {
    PointSort(sweep->point[i].n, sweep->point[i].mode);
    n_modes += sweep->point[i].n;
  }
  PetscCall(ModesGetBand(sweep->modes, band, &growth));
  PetscCheck(n_modes, sweep->comm, PETSC_ERR_USER_INPUT, "-modes_band %.6g,%.6g Hz contains no mode at any point; widen it",
             (double)band[0], (double)band[1]);
  PetscFunctionReturn(0);
}
