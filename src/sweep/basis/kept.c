/*
   What a killed run goes on from that has a basis: the full solutions behind it, after each of them a file
   <begin>_restart_<k> with its new vectors. The dense model is made again from the same blocks of vectors: on one
   rank bit by bit the same. Files of another run and damaged ones are named, not read.
*/
#include "kept.h"
#include "base/process/interrupt.h"

/* What stands before the ends of blocks and the samples in each file */
typedef struct {
  PetscReal last, fall, reach;
  PetscInt  n_samples, n_passed, n_used, first, n, n_blocks;
} BasisHeader;

/* Ends of blocks and samples, all that there are by now */
static PetscErrorCode BasisRecordsMove(BasisKept *k, const BasisHeader *h, JournalPack *pack)
{
  PetscFunctionBeginUser;
  PetscCall(JournalPackMove(pack, k->basis->block_end, sizeof(PetscInt) * (size_t)h->n_blocks));
  for (PetscInt i = 0; i < h->n_samples && (pack->write || pack->good); i++) {
    GreedySample *sample = &k->greedy->sample[i];

    if (!sample->p) PetscCall(PetscMalloc1(k->basis->reduced.n_parameters, &sample->p));
    PetscCall(JournalPackMove(pack, sample->p, sizeof(PetscReal) * (size_t)k->basis->reduced.n_parameters));
    PetscCall(JournalPackMove(pack, &sample->krylov, sizeof(sample->krylov)));
    PetscCall(JournalPackMove(pack, &sample->factored, sizeof(sample->factored)));
    PetscCall(JournalPackMove(pack, &sample->n_vectors, sizeof(sample->n_vectors)));
    PetscCall(JournalPackMove(pack, &sample->estimate, sizeof(sample->estimate)));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode BasisVectorsMove(BV vectors, PetscInt first, PetscInt n, PetscBool read, PetscReal values[])
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
static BasisHeader HeaderOf(BasisKept *k)
{
  const Basis  *basis  = k->basis;
  const Greedy *greedy = k->greedy;

  return (BasisHeader){.last      = greedy->last,
                       .fall      = greedy->fall,
                       .reach     = greedy->reach,
                       .n_samples = greedy->n_samples,
                       .n_passed  = greedy->n_passed,
                       .n_used    = basis->reduced.n_used,
                       .first     = k->n_kept,
                       .n         = basis->reduced.n,
                       .n_blocks  = basis->n_blocks};
}

/* Collective; called after each full solution. Only the new vectors [first, n) are written, n_local values a vector
   and rank; a file that cannot be written ends the keeping, not the run. */
static PetscErrorCode BasisKeep(void *ctx)
{
  BasisKept  *k     = ctx;
  Basis      *basis = k->basis;
  BasisHeader h     = HeaderOf(k);
  JournalPack pack  = {.write = PETSC_TRUE};
  JournalItem item[2];
  PetscReal  *values;
  char        name[64];
  PetscInt    n_local;
  PetscBool   kept;

  PetscFunctionBeginUser;
  PetscCall(BasisKeptName(k->begin, k->n_files, name));
  PetscCall(JournalPackMove(&pack, &h, sizeof(h)));
  PetscCall(BasisRecordsMove(k, &h, &pack));
  PetscCall(BVGetSizes(basis->space.V, &n_local, NULL, NULL));
  PetscCall(PetscMalloc1((h.n - h.first) * n_local, &values));
  PetscCall(BasisVectorsMove(basis->space.V, h.first, h.n, PETSC_FALSE, values));
  item[0] = (JournalItem){"samples", pack.n, pack.word};
  item[1] = (JournalItem){"vectors", (h.n - h.first) * n_local, values};
  PetscCall(JournalKeep(k->journal, name, 2, item, &kept));
  PetscCall(PetscFree(values));
  PetscCall(JournalPackDestroy(&pack));
  if (!kept) k->greedy->keep = NULL; /* the run itself needs no such file */
  if (!kept) PetscFunctionReturn(0);
  k->n_kept = h.n;
  k->n_files++;
  InterruptSays("%d full solutions are kept, with which the same command goes on", (int)h.n_samples);
  PetscFunctionReturn(0);
}

/* Whether what a header says can be: its vectors follow those that there are, no more samples than may be made,
   blocks within bounds. JournalTake() has told damage and other runs; this tells files of two runs of the same
   scene. One rank's doubt is that of all. */
static PetscErrorCode HeaderFits(BasisKept *k, const BasisHeader *h, PetscInt n_values, PetscBool *fits)
{
  const Basis *basis = k->basis;
  PetscInt     n_local;

  PetscFunctionBeginUser;
  PetscCall(BVGetSizes(basis->space.V, &n_local, NULL, NULL));
  if (h->first != basis->reduced.n || h->n < h->first || h->n_used < 1 || h->n_used > h->n) *fits = PETSC_FALSE;
  if (h->n_samples < 1 || h->n_samples > k->greedy->max_samples) *fits = PETSC_FALSE;
  if (h->n_blocks < basis->n_blocks || h->n_blocks > BASIS_MAX_BLOCKS) *fits = PETSC_FALSE;
  if (n_values != (h->n - h->first) * n_local) *fits = PETSC_FALSE;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, fits, 1, MPIU_BOOL, MPI_LAND, k->basis->comm));
  PetscFunctionReturn(0);
}

/* Blocks, records and vectors behind a good header */
static PetscErrorCode BasisTakeUp(BasisKept *k, const BasisHeader *h, JournalPack *pack, PetscReal values[])
{
  Basis *basis = k->basis;

  PetscFunctionBeginUser;
  PetscCall(BasisRecordsMove(k, h, pack));
  PetscCheck(pack->good, k->basis->comm, PETSC_ERR_PLIB, "a kept sample ends too early");
  PetscCall(BVResize(basis->space.V, h->n, PETSC_TRUE));
  PetscCall(BasisVectorsMove(basis->space.V, h->first, h->n, PETSC_TRUE, values));
  PetscCall(BasisRebuild(basis, h->n_blocks));
  PetscCall(BasisUse(basis, h->n_used));
  k->greedy->n_samples = h->n_samples;
  k->greedy->last      = h->last;
  k->greedy->n_passed  = h->n_passed;
  k->greedy->fall      = h->fall;
  k->greedy->reach     = h->reach;
  k->n_kept            = h->n;
  PetscFunctionReturn(0);
}

/* Reads the next file into the basis; taken = whether it is there, whole and of this run */
static PetscErrorCode FileResume(BasisKept *k, PetscBool *taken)
{
  JournalItem item[2] = {{"samples", -1, NULL}, {"vectors", -1, NULL}};
  JournalPack pack    = {.good = PETSC_TRUE};
  BasisHeader h       = {0};
  const char *folder;
  char        name[64], then[64];

  PetscFunctionBeginUser;
  PetscCall(BasisKeptName(k->begin, k->n_files, name));
  PetscCall(PetscSNPrintf(then, sizeof(then), k->n_files ? "the %s goes on without it" : "the %s begins anew",
                          k->journal->run));
  PetscCall(JournalTake(k->journal, name, then, 2, item, taken));
  if (!*taken) PetscFunctionReturn(0);
  pack.word = item[0].values;
  pack.n    = item[0].n;
  PetscCall(JournalPackMove(&pack, &h, sizeof(h)));
  *taken = pack.good;
  PetscCall(HeaderFits(k, &h, item[1].n, taken));
  PetscCall(ResultsGetDirectory(k->journal->results, &folder));
  if (*taken)
    PetscCall(BasisTakeUp(k, &h, &pack, item[1].values));
  else
    PetscCall(PetscFPrintf(k->basis->comm, stderr,
                           "squeal: warning: '%s/%s' does not follow the file before it; the %s goes on without it\n",
                           folder, name, k->journal->run));
  PetscCall(JournalPackDestroy(&pack));
  PetscCall(PetscFree(item[1].values));
  PetscFunctionReturn(0);
}

/* Files are taken in order until one is missing or does not follow; what comes behind it is worth nothing, since
   its vectors are orthogonal to those that are lost. */
PetscErrorCode BasisResume(BasisKept *k)
{
  PetscBool   taken = PETSC_TRUE;
  const char *folder;

  PetscFunctionBeginUser;
  while (taken) {
    PetscCall(FileResume(k, &taken));
    if (taken) k->n_files++;
  }
  PetscCall(ResultsGetDirectory(k->journal->results, &folder));
  if (k->n_files)
    PetscCall(PetscPrintf(k->basis->comm, "going on with %" PetscInt_FMT " full solutions kept in %s\n",
                          k->greedy->n_samples, folder));
  k->greedy->keep     = BasisKeep;
  k->greedy->keep_ctx = k;
  PetscFunctionReturn(0);
}

PetscErrorCode BasisKeptName(const char begin[], PetscInt k, char name[64])
{
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, 64, "%s_restart_%03d", begin, (int)k));
  PetscFunctionReturn(0);
}
