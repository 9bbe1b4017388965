/*
   What a killed sweep goes on from, in files of the output folder until it is complete: the full solutions behind the
   basis of a reduced sweep, after each of them a file sweep_restart_<k> with its new vectors. The dense model is made
   again from the same blocks of vectors: on one rank bit by bit the same. Files of another sweep and damaged ones are
   named, not read, and in the end replaced. Sweeps that have no basis keep their points (keptpoints.c).
*/
#include "sweepimpl.h"
#include "base/process/interrupt.h"
#include "base/path.h"

/* What stands before the ends of blocks and the samples in each file */
typedef struct {
  PetscReal last, fall, reach;
  PetscInt  n_samples, n_passed, n_used, first, n, n_blocks;
} BasisHeader;

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
  Model                     model;
  Contact                   contact;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(sweep->operators, &model, &contact));
  if (model) PetscCall(ModelAddChecksum(model, PETSC_TRUE, c));
  if (contact) PetscCall(ContactAddChecksum(contact, c));
  PetscCall(OperatorsAddChecksum(sweep->operators, c));
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

PetscErrorCode SweepFileName(PetscInt k, char name[64])
{
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, 64, "sweep_restart_%03d", (int)k));
  PetscFunctionReturn(0);
}

/* Ends of blocks and samples, all that there are by now */
static PetscErrorCode BasisRecordsMove(Sweep sweep, const BasisHeader *h, JournalPack *pack)
{
  PetscFunctionBeginUser;
  PetscCall(JournalPackMove(pack, sweep->basis.block_end, sizeof(PetscInt) * (size_t)h->n_blocks));
  for (PetscInt i = 0; i < h->n_samples && (pack->write || pack->good); i++) {
    GreedySample *sample = &sweep->greedy.sample[i];

    if (!sample->p) PetscCall(PetscMalloc1(sweep->grid.n_parameters, &sample->p));
    PetscCall(JournalPackMove(pack, sample->p, sizeof(PetscReal) * (size_t)sweep->grid.n_parameters));
    PetscCall(JournalPackMove(pack, &sample->krylov, sizeof(sample->krylov)));
    PetscCall(JournalPackMove(pack, &sample->factored, sizeof(sample->factored)));
    PetscCall(JournalPackMove(pack, &sample->n_vectors, sizeof(sample->n_vectors)));
    PetscCall(JournalPackMove(pack, &sample->estimate, sizeof(sample->estimate)));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SweepVectorsMove(BV vectors, PetscInt first, PetscInt n, PetscBool read, PetscReal values[])
{
  PetscInt n_local;

  PetscFunctionBeginUser;
  PetscCall(BVGetSizes(vectors, &n_local, NULL, NULL));
  for (PetscInt j = first; j < n; j++) {
    PetscScalar *array, *kept = &values[(j - first) * n_local];
    Vec          v;

    PetscCall(BVGetColumn(vectors, j, &v));
    PetscCall(VecGetArray(v, &array));
    PetscCall(PetscArraycpy(read ? array : kept, read ? kept : array, n_local));
    PetscCall(VecRestoreArray(v, &array));
    PetscCall(BVRestoreColumn(vectors, j, &v));
  }
  PetscFunctionReturn(0);
}

/* What the next file holds */
static BasisHeader HeaderOf(Sweep sweep)
{
  const Basis  *basis  = &sweep->basis;
  const Greedy *greedy = &sweep->greedy;

  return (BasisHeader){.last      = greedy->last,
                       .fall      = greedy->fall,
                       .reach     = greedy->reach,
                       .n_samples = greedy->n_samples,
                       .n_passed  = greedy->n_passed,
                       .n_used    = basis->reduced.n_used,
                       .first     = sweep->n_kept,
                       .n         = basis->reduced.n,
                       .n_blocks  = basis->n_blocks};
}

/* Collective; called after each full solution. Only the new vectors [first, n) are written, n_local values a vector
   and rank; a file that cannot be written ends the keeping, not the sweep. */
PetscErrorCode SweepKeep(void *ctx)
{
  Sweep       sweep = (Sweep)ctx;
  Basis      *basis = &sweep->basis;
  BasisHeader h     = HeaderOf(sweep);
  JournalPack pack  = {.write = PETSC_TRUE};
  JournalItem item[2];
  PetscReal  *values;
  char        name[64];
  PetscInt    n_local;
  PetscBool   kept;

  PetscFunctionBeginUser;
  PetscCall(SweepFileName(sweep->n_files, name));
  PetscCall(JournalPackMove(&pack, &h, sizeof(h)));
  PetscCall(BasisRecordsMove(sweep, &h, &pack));
  PetscCall(BVGetSizes(basis->space.V, &n_local, NULL, NULL));
  PetscCall(PetscMalloc1((h.n - h.first) * n_local, &values));
  PetscCall(SweepVectorsMove(basis->space.V, h.first, h.n, PETSC_FALSE, values));
  item[0] = (JournalItem){"samples", pack.n, pack.word};
  item[1] = (JournalItem){"vectors", (h.n - h.first) * n_local, values};
  PetscCall(JournalKeep(&sweep->journal, name, 2, item, &kept));
  PetscCall(PetscFree(values));
  PetscCall(JournalPackDestroy(&pack));
  if (!kept) sweep->greedy.keep = NULL; /* the sweep itself needs no such file */
  if (!kept) PetscFunctionReturn(0);
  sweep->n_kept = h.n;
  sweep->n_files++;
  InterruptSays("%d full solutions are kept, with which the same command goes on", (int)h.n_samples);
  PetscFunctionReturn(0);
}

/* Whether what a header says can be: its vectors follow those that there are, no more samples than may be made,
   blocks within bounds. JournalTake() has told damage and other sweeps; this tells files of two runs of the same
   sweep. One rank's doubt is that of all. */
static PetscErrorCode HeaderFits(Sweep sweep, const BasisHeader *h, PetscInt n_values, PetscBool *fits)
{
  const Basis *basis = &sweep->basis;
  PetscInt     n_local;

  PetscFunctionBeginUser;
  PetscCall(BVGetSizes(basis->space.V, &n_local, NULL, NULL));
  if (h->first != basis->reduced.n || h->n < h->first || h->n_used < 1 || h->n_used > h->n) *fits = PETSC_FALSE;
  if (h->n_samples < 1 || h->n_samples > sweep->greedy.max_samples) *fits = PETSC_FALSE;
  if (h->n_blocks < basis->n_blocks || h->n_blocks > BASIS_MAX_BLOCKS) *fits = PETSC_FALSE;
  if (n_values != (h->n - h->first) * n_local) *fits = PETSC_FALSE;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, fits, 1, MPIU_BOOL, MPI_LAND, sweep->comm));
  PetscFunctionReturn(0);
}

/* Blocks, records and vectors behind a good header */
static PetscErrorCode BasisTakeUp(Sweep sweep, const BasisHeader *h, JournalPack *pack, PetscReal values[])
{
  Basis *basis = &sweep->basis;

  PetscFunctionBeginUser;
  PetscCall(BasisRecordsMove(sweep, h, pack));
  PetscCheck(pack->good, sweep->comm, PETSC_ERR_PLIB, "a kept sample ends too early");
  PetscCall(BVResize(basis->space.V, h->n, PETSC_TRUE));
  PetscCall(SweepVectorsMove(basis->space.V, h->first, h->n, PETSC_TRUE, values));
  PetscCall(BasisRebuild(basis, h->n_blocks));
  PetscCall(BasisUse(basis, h->n_used));
  sweep->greedy.n_samples = h->n_samples;
  sweep->greedy.last      = h->last;
  sweep->greedy.n_passed  = h->n_passed;
  sweep->greedy.fall      = h->fall;
  sweep->greedy.reach     = h->reach;
  sweep->n_kept           = h->n;
  PetscFunctionReturn(0);
}

/* Reads the next file into the basis; taken = whether it is there, whole and of this sweep */
static PetscErrorCode FileResume(Sweep sweep, PetscBool *taken)
{
  JournalItem item[2] = {{"samples", -1, NULL}, {"vectors", -1, NULL}};
  JournalPack pack    = {.good = PETSC_TRUE};
  BasisHeader h;
  char        name[64];

  PetscFunctionBeginUser;
  PetscCall(SweepFileName(sweep->n_files, name));
  PetscCall(JournalTake(&sweep->journal, name,
                        sweep->n_files ? "the sweep goes on without it" : "the sweep begins anew", 2, item, taken));
  if (!*taken) PetscFunctionReturn(0);
  pack.word = item[0].values;
  pack.n    = item[0].n;
  PetscCall(JournalPackMove(&pack, &h, sizeof(h)));
  PetscCall(HeaderFits(sweep, &h, item[1].n, taken));
  if (*taken)
    PetscCall(BasisTakeUp(sweep, &h, &pack, item[1].values));
  else
    PetscCall(
      PetscFPrintf(sweep->comm, stderr,
                   "squeal: warning: '%s/%s' does not follow the file before it; the sweep goes on without it\n",
                   sweep->folder, name));
  PetscCall(JournalPackDestroy(&pack));
  PetscCall(PetscFree(item[1].values));
  PetscFunctionReturn(0);
}

/* Files are taken in order until one is missing or does not follow; what comes behind it is worth nothing, since
   its vectors are orthogonal to those that are lost. */
PetscErrorCode SweepResume(Sweep sweep)
{
  PetscBool taken = PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(SweepJournalOpen(sweep));
  while (taken) {
    PetscCall(FileResume(sweep, &taken));
    if (taken) sweep->n_files++;
  }
  if (sweep->n_files)
    PetscCall(PetscPrintf(sweep->comm, "going on with %" PetscInt_FMT " full solutions kept in %s\n",
                          sweep->greedy.n_samples, sweep->folder));
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
