/*
   Full solutions are kept in the output folder until the sweep is complete, so that a killed sweep goes on where it
   stopped. Each rank writes its part of the new vectors after every full solution, sweep_restart_<k>_rank<r>, under a
   temporary name that becomes final only when all ranks have written. The dense model is made again from the same
   blocks of vectors: on one rank bit by bit the same. A fingerprint of matrices, window, points and ranks tells whether
   the files belong to this sweep; files of another one are ignored and in the end replaced.
*/
#include "sweepimpl.h"
#include <stdio.h>
#include <unistd.h>

#define N_PRINTS 10

/* What stands before the vectors in each file */
typedef struct {
  PetscReal print[N_PRINTS], last;
  PetscInt  n_samples, n_passed, n_used, first, n, n_blocks, n_local;
} Header;

/* Numbers that differ between sweeps that must not be mixed */
static PetscErrorCode FingerprintMake(Sweep sweep, PetscReal print[N_PRINTS])
{
  const Reduced *r = &sweep->basis.reduced;
  PetscInt       n_local, n_global;
  PetscMPIInt    size;
  PetscReal     *p;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(print, N_PRINTS));
  PetscCallMPI(MPI_Comm_size(sweep->comm, &size));
  PetscCall(BVGetSizes(sweep->basis.vectors, &n_local, &n_global, NULL));
  print[0] = 1; /* version of the format */
  print[1] = size;
  print[2] = (PetscReal)n_global;
  print[3] = sweep->window.low;
  print[4] = sweep->window.high;
  print[5] = sweep->window.growth;
  print[6] = sweep->rtol;
  for (PetscInt t = 0; t < r->n_terms; t++) {
    PetscReal norm;

    PetscCall(MatNorm(r->term[t].A, NORM_FROBENIUS, &norm));
    print[7] = 0.9 * print[7] + norm;
  }
  PetscCall(PetscMalloc1(r->n_parameters, &p));
  for (PetscInt i = 0; i < sweep->grid.n_places; i++) {
    GridFill(&sweep->grid, &sweep->grid.place[i], p);
    for (PetscInt k = 0; k < r->n_parameters; k++)
      print[8] = 0.99 * print[8] + asinh(p[k]); /* large and small ones count alike */
  }
  PetscCall(PetscFree(p));
  print[9] = (PetscReal)r->n_terms;
  PetscFunctionReturn(0);
}

/* Name of file k of this rank */
static PetscErrorCode FileName(Sweep sweep, PetscInt k, const char ending[], char name[PETSC_MAX_PATH_LEN])
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(sweep->comm, &rank));
  PetscCall(PetscSNPrintf(name, PETSC_MAX_PATH_LEN, "%s/sweep_restart_%03d_rank%d%s", sweep->folder, (int)k, (int)rank,
                          ending));
  PetscFunctionReturn(0);
}

/* Reads or writes n items; accumulates success */
static void Transfer(FILE *file, PetscBool write, void *data, size_t size, PetscInt n, PetscBool *good)
{
  const size_t done = !*good ? 0 : write ? fwrite(data, size, (size_t)n, file) : fread(data, size, (size_t)n, file);

  if (done != (size_t)n) *good = PETSC_FALSE;
}

/* The vectors first .. n - 1 of this rank */
static PetscErrorCode VectorsTransfer(FILE *file, PetscBool write, BV vectors, const Header *h, PetscBool *good)
{
  PetscFunctionBeginUser;
  for (PetscInt j = h->first; j < h->n; j++) {
    PetscScalar *array;
    Vec          v;

    PetscCall(BVGetColumn(vectors, j, &v));
    PetscCall(VecGetArray(v, &array));
    Transfer(file, write, array, sizeof(PetscScalar), h->n_local, good);
    PetscCall(VecRestoreArray(v, &array));
    PetscCall(BVRestoreColumn(vectors, j, &v));
  }
  PetscFunctionReturn(0);
}

/* Samples and ends of blocks, all that there are by now */
static PetscErrorCode RecordsTransfer(Sweep sweep, FILE *file, PetscBool write, const Header *h, PetscBool *good)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < h->n_samples && *good; i++) {
    GreedySample *s = &sweep->greedy.sample[i];

    if (!s->p) PetscCall(PetscMalloc1(sweep->grid.n_parameters, &s->p));
    Transfer(file, write, s->p, sizeof(PetscReal), sweep->grid.n_parameters, good);
    Transfer(file, write, &s->krylov, sizeof(s->krylov), 1, good);
    Transfer(file, write, &s->n_vectors, sizeof(s->n_vectors), 1, good);
    Transfer(file, write, &s->estimate, sizeof(s->estimate), 1, good);
  }
  PetscFunctionReturn(0);
}

/* Whether all ranks agree that it is good */
static PetscErrorCode AllGood(MPI_Comm comm, PetscBool *good)
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, good, 1, MPIU_BOOL, MPI_LAND, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode SweepKeep(void *ctx)
{
  Sweep     sweep = (Sweep)ctx;
  Basis    *basis = &sweep->basis;
  char      name[PETSC_MAX_PATH_LEN], part[PETSC_MAX_PATH_LEN];
  PetscBool good = PETSC_TRUE;
  Header    h;
  FILE     *file;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(&h, sizeof(h)));
  PetscCall(PetscArraycpy(h.print, sweep->print, N_PRINTS));
  h.last      = sweep->greedy.last;
  h.n_passed  = sweep->greedy.n_passed;
  h.n_samples = sweep->greedy.n_samples, h.n_used = basis->reduced.n_used;
  h.first = sweep->n_kept, h.n = basis->reduced.n, h.n_blocks = basis->n_blocks;
  PetscCall(BVGetSizes(basis->vectors, &h.n_local, NULL, NULL));
  PetscCall(FileName(sweep, sweep->n_files, "", name));
  PetscCall(FileName(sweep, sweep->n_files, ".part", part));
  file = fopen(part, "wb");
  good = file ? PETSC_TRUE : PETSC_FALSE;
  Transfer(file, PETSC_TRUE, &h, sizeof(h), 1, &good);
  Transfer(file, PETSC_TRUE, basis->block_end, sizeof(PetscInt), h.n_blocks, &good);
  PetscCall(RecordsTransfer(sweep, file, PETSC_TRUE, &h, &good));
  PetscCall(VectorsTransfer(file, PETSC_TRUE, basis->vectors, &h, &good));
  if (file && fclose(file)) good = PETSC_FALSE;
  PetscCall(AllGood(sweep->comm, &good));
  if (good && rename(part, name)) good = PETSC_FALSE;
  if (!good) (void)unlink(part);
  PetscCall(AllGood(sweep->comm, &good));
  if (!good) { /* the sweep itself needs no such file */
    PetscCall(
      PetscFPrintf(sweep->comm, stderr, "squeal: warning: cannot write '%s'; a killed sweep will begin anew\n", name));
    sweep->greedy.keep = NULL;
    PetscFunctionReturn(0);
  }
  sweep->n_kept = basis->reduced.n;
  sweep->n_files++;
  PetscFunctionReturn(0);
}

/* Whether the fingerprints are those of one sweep: norms of matrices may differ in their last digits */
static PetscBool PrintsAgree(const PetscReal a[N_PRINTS], const PetscReal b[N_PRINTS])
{
  for (int i = 0; i < N_PRINTS; i++)
    if (PetscAbsReal(a[i] - b[i]) > 1e-12 * PetscAbsReal(a[i])) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Reads file k into the basis; good = whether it exists, is whole and belongs to this sweep */
static PetscErrorCode FileResume(Sweep sweep, PetscInt k, PetscBool *good)
{
  Basis   *basis = &sweep->basis;
  char     name[PETSC_MAX_PATH_LEN];
  Header   h;
  FILE    *file;
  PetscInt n_local;

  PetscFunctionBeginUser;
  PetscCall(FileName(sweep, k, "", name));
  file  = fopen(name, "rb");
  *good = file ? PETSC_TRUE : PETSC_FALSE;
  Transfer(file, PETSC_FALSE, &h, sizeof(h), 1, good);
  PetscCall(BVGetSizes(basis->vectors, &n_local, NULL, NULL));
  if (*good && (h.n < h.first || h.n_used > h.n || !PrintsAgree(h.print, sweep->print) || h.first != basis->reduced.n ||
                h.n_local != n_local || h.n_samples > sweep->greedy.max_samples || h.n_blocks > BASIS_MAX_BLOCKS))
    *good = PETSC_FALSE;
  PetscCall(AllGood(sweep->comm, good));
  if (*good) {
    Transfer(file, PETSC_FALSE, basis->block_end, sizeof(PetscInt), h.n_blocks, good);
    PetscCall(RecordsTransfer(sweep, file, PETSC_FALSE, &h, good));
    PetscCall(BVResize(basis->vectors, h.n, PETSC_TRUE));
    PetscCall(VectorsTransfer(file, PETSC_FALSE, basis->vectors, &h, good));
    PetscCall(AllGood(sweep->comm, good));
  }
  if (file) (void)fclose(file);
  if (!*good) PetscFunctionReturn(0);
  PetscCall(BasisRebuild(basis, h.n_blocks));
  basis->reduced.n_used   = h.n_used;
  sweep->greedy.n_samples = h.n_samples;
  sweep->greedy.last      = h.last;
  sweep->greedy.n_passed  = h.n_passed;
  sweep->n_kept           = h.n;
  PetscFunctionReturn(0);
}

PetscErrorCode SweepResume(Sweep sweep)
{
  PetscBool good = PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(FingerprintMake(sweep, sweep->print));
  while (good) {
    PetscCall(FileResume(sweep, sweep->n_files, &good));
    if (good) sweep->n_files++;
  }
  if (sweep->n_files)
    PetscCall(PetscPrintf(sweep->comm, "going on with %" PetscInt_FMT " full solutions kept in %s\n",
                          sweep->greedy.n_samples, sweep->folder));
  PetscFunctionReturn(0);
}

PetscErrorCode SweepForget(Sweep sweep)
{
  char name[PETSC_MAX_PATH_LEN], part[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  for (PetscInt k = 0, left = 1; left && sweep->restart; k++) { /* also those of an earlier, longer sweep */
    PetscCall(FileName(sweep, k, "", name));
    PetscCall(FileName(sweep, k, ".part", part));
    (void)unlink(part);
    left = unlink(name) == 0 || k < sweep->n_files;
  }
  PetscFunctionReturn(0);
}
