/*
   Full solutions are kept in the output folder until the sweep is complete, so that a killed sweep goes on where it
   stopped. Each rank writes its part of the new vectors after every full solution, sweep_restart_<k>_rank<r>, under a
   temporary name that becomes final only when all ranks have written. The dense model is made again from the same
   blocks of vectors: on one rank bit by bit the same. The checksum of the scene tells whether the files belong to this
   sweep; files of another one are ignored and in the end replaced.
*/
#include "sweepimpl.h"
#include <stdio.h>
#include <unistd.h>

#define VERSION         3    /* of the format */
#define SWEEP_MAX_PARTS 1000 /* of a scene; more are none */

/* What stands before the parts of the scene and the vectors in each file */
typedef struct {
  PetscReal last;
  PetscInt  version, n_parts, n_parameters, n_samples, n_passed, n_used, first, n, n_blocks, n_local;
} Header;

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

/* What a sweep must share with the one that it goes on with */
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
  PetscCall(ChecksumAddReals(c, 1, &sweep->rtol));
  for (PetscInt k = 0; k < grid->n_axes; k++) PetscCall(ChecksumAddString(c, parameters[grid->parameter[k]].name));
  PetscCall(GridAddChecksum(grid, c));
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
  Sweep               sweep = (Sweep)ctx;
  Basis              *basis = &sweep->basis;
  const ChecksumPart *scene;
  char                name[PETSC_MAX_PATH_LEN], part[PETSC_MAX_PATH_LEN];
  PetscBool           good = PETSC_TRUE;
  Header              h;
  FILE               *file;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(&h, sizeof(h)));
  h.version = VERSION;
  PetscCall(ChecksumGetParts(sweep->scene, &h.n_parts, &scene));
  h.n_parameters = sweep->grid.n_parameters;
  h.last         = sweep->greedy.last;
  h.n_passed     = sweep->greedy.n_passed;
  h.n_samples = sweep->greedy.n_samples, h.n_used = basis->reduced.n_used;
  h.first = sweep->n_kept, h.n = basis->reduced.n, h.n_blocks = basis->n_blocks;
  PetscCall(BVGetSizes(basis->vectors, &h.n_local, NULL, NULL));
  PetscCall(FileName(sweep, sweep->n_files, "", name));
  PetscCall(FileName(sweep, sweep->n_files, ".part", part));
  file = fopen(part, "wb");
  good = file ? PETSC_TRUE : PETSC_FALSE;
  Transfer(file, PETSC_TRUE, &h, sizeof(h), 1, &good);
  Transfer(file, PETSC_TRUE, (void *)scene, sizeof(*scene), h.n_parts, &good);
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

/* Reads the parts of the scene; good = whether they are those of this sweep, names = of those that differ */
static PetscErrorCode SceneCheck(Sweep sweep, FILE *file, const Header *h, PetscBool *good, char names[256])
{
  ChecksumPart *kept;

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(names, *good ? "the format of the files" : "", 256));
  if (!*good) PetscFunctionReturn(0);
  *good = h->version == VERSION && h->n_parts >= 0 && h->n_parts <= SWEEP_MAX_PARTS ? PETSC_TRUE : PETSC_FALSE;
  if (!*good) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(h->n_parts, &kept));
  Transfer(file, PETSC_FALSE, kept, sizeof(*kept), h->n_parts, good);
  if (*good) PetscCall(ChecksumCompare(sweep->scene, h->n_parts, kept, 256, names));
  if (names[0]) *good = PETSC_FALSE;
  PetscCall(PetscFree(kept));
  PetscFunctionReturn(0);
}

/* Reads file k into the basis; good = whether it exists, is whole and belongs to this sweep */
static PetscErrorCode FileResume(Sweep sweep, PetscInt k, PetscBool *good)
{
  Basis   *basis = &sweep->basis;
  char     name[PETSC_MAX_PATH_LEN], names[256];
  Header   h;
  FILE    *file;
  PetscInt n_local;

  PetscFunctionBeginUser;
  PetscCall(FileName(sweep, k, "", name));
  file  = fopen(name, "rb");
  *good = file ? PETSC_TRUE : PETSC_FALSE;
  Transfer(file, PETSC_FALSE, &h, sizeof(h), 1, good);
  PetscCall(SceneCheck(sweep, file, &h, good, names));
  if (!k && names[0])
    PetscCall(PetscFPrintf(sweep->comm, stderr,
                           "squeal: warning: '%s' is of another scene, which differs in: %s; the sweep begins anew\n",
                           name, names));
  PetscCall(BVGetSizes(basis->vectors, &n_local, NULL, NULL));
  if (*good &&
      (h.n_parameters != sweep->grid.n_parameters || h.n < h.first || h.n_used > h.n || h.first != basis->reduced.n ||
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
  PetscCall(ChecksumCreate(sweep->comm, &sweep->scene));
  PetscCall(SweepAddChecksum(sweep, sweep->scene));
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
