/*
   What a killed sweep goes on from, in files of the output folder until it is complete: of a reduced sweep the full
   solutions behind its basis (basis/kept.c). In the end they are deleted. Sweeps that have no basis keep their points
   (keptpoints.c).
*/
#include "sweepimpl.h"
#include "base/path.h"

/* The places, and the values of all parameters there: what was identified and which pairs are closed belong to them */
static PetscErrorCode GridAddChecksum(const SweepGrid *grid, Checksum c)
{
  PetscReal *p;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(grid->n_parameters, &p));
  PetscCall(ChecksumAddInts(c, 3, (const PetscInt[]){grid->n_parameters, grid->n_groups, grid->n_places}));
  PetscCall(ChecksumAddReals(c, grid->n_parameters, grid->base));
  for (PetscInt i = 0; i < grid->n_places; i++) {
    GridFill(grid, &grid->place[i], p);
    PetscCall(ChecksumAddInts(c, 2, (const PetscInt[]){grid->place[i].point, grid->place[i].status}));
    PetscCall(ChecksumAddReals(c, grid->n_parameters, p));
  }
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

/* What a sweep must share with the one that it goes on with. The number of ranks is among it: vectors are kept by
   rank, and other ranges of rows would put them in the wrong places. */
static PetscErrorCode SweepAddChecksum(Sweep sweep, Checksum c)
{
  const SweepGrid          *grid = &sweep->grid;
  const OperatorsParameter *parameters;
  PetscInt                  n;
  PetscMPIInt               size;

  PetscFunctionBeginUser;
  PetscCall(OperatorsAddSceneChecksum(sweep->operators, PETSC_TRUE, c));
  if (sweep->statics) PetscCall(StaticsAddChecksum(sweep->statics, c));
  PetscCall(ModesAddChecksum(sweep->modes, c));
  PetscCall(OperatorsGetParameters(sweep->operators, &n, &parameters));
  PetscCallMPI(MPI_Comm_size(sweep->comm, &size));
  PetscCall(ChecksumSetPart(c, "the sweep"));
  PetscCall(ChecksumAddInts(c, 1, (const PetscInt[]){size}));
  PetscCall(
    ChecksumAddInts(c, 3, (const PetscInt[]){(PetscInt)sweep->method, (PetscInt)sweep->real_stiffness, sweep->n_real}));
  PetscCall(ChecksumAddReals(c, 1, &sweep->rtol));
  for (PetscInt k = 0; k < grid->n_axes; k++) {
    PetscCall(ChecksumAddInts(c, 1, &grid->n_moved[k]));
    for (PetscInt i = 0; i < grid->n_moved[k]; i++)
      PetscCall(ChecksumAddString(c, parameters[grid->parameter[k][i]].name));
  }
  PetscCall(GridAddChecksum(grid, c));
  PetscFunctionReturn(0);
}

PetscErrorCode SweepJournalOpen(Sweep sweep)
{
  PetscFunctionBeginUser;
  PetscCall(ChecksumCreate(sweep->comm, &sweep->journal.scene));
  PetscCall(SweepAddChecksum(sweep, sweep->journal.scene));
  sweep->journal = (Journal){sweep->comm, sweep->results, sweep->journal.scene, "a sweep", "sweep"};
  PetscFunctionReturn(0);
}

PetscErrorCode SweepResume(Sweep sweep)
{
  PetscFunctionBeginUser;
  PetscCall(SweepJournalOpen(sweep));
  sweep->kept =
    (BasisKept){.journal = &sweep->journal, .basis = &sweep->basis, .greedy = &sweep->greedy, .begin = "sweep"};
  PetscCall(BasisResume(&sweep->kept));
  PetscFunctionReturn(0);
}

PetscErrorCode SweepForget(Sweep sweep)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(sweep->comm, &rank));
  if (!rank && sweep->restart && sweep->folder) PathForget(sweep->folder, "sweep_restart_");
  PetscFunctionReturn(0);
}
