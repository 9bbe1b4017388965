/*
   Full solutions are kept in the output folder until the sweep is complete, so that a killed sweep goes on where it stopped. Each
   rank writes its part of the new vectors after every full solution, sweep_restart_<k>_rank<r>, under a temporary name that becomes
   final only when all have written. The dense model is made again from the same blocks of vectors: on one rank bit by bit the
   same. The checksum of the scene tells whether the files belong to this sweep, and one of all that stands before it, at the end
   of each file, whether it is whole. Files of another sweep and damaged ones are named, not read, and in the end replaced.
*/
#include "sweepimpl.h"
#include "base/file.h"
#include "base/path.h"
#include <unistd.h>

#define VERSION         6       /* of the format */
#define SWEEP_MAX_PARTS 1000    /* of a scene; more are none */
#define PIECE           1048576 /* bytes read at once */

/* What stands before the parts of the scene and the vectors in each file */
typedef struct {
  PetscReal last, fall, reach;
  PetscInt  version, n_parts, n_parameters, n_samples, n_passed, n_used, first, n, n_blocks, n_local;
} Header;

/* A file; good until something fails */
typedef struct {
  FILE     *file;
  PetscBool write, good;
} Stream;

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
  for (PetscInt k = 0; k < grid->n_axes; k++) {
    PetscCall(ChecksumAddInts(c, 1, &grid->n_moved[k]));
    for (PetscInt i = 0; i < grid->n_moved[k]; i++)
      PetscCall(ChecksumAddString(c, parameters[grid->parameter[k][i]].name));
  }
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

/* Reads or writes n items */
static void Transfer(Stream *s, void *data, size_t size, PetscInt n)
{
  const size_t done = !s->good   ? 0
                      : s->write ? fwrite(data, size, (size_t)n, s->file)
                                 : fread(data, size, (size_t)n, s->file);

  if (done != (size_t)n) s->good = PETSC_FALSE;
}

/* The vectors first .. n - 1 of this rank */
static PetscErrorCode VectorsTransfer(Stream *s, BV vectors, const Header *h)
{
  PetscFunctionBeginUser;
  for (PetscInt j = h->first; j < h->n; j++) {
    PetscScalar *array;
    Vec          v;

    PetscCall(BVGetColumn(vectors, j, &v));
    PetscCall(VecGetArray(v, &array));
    Transfer(s, array, sizeof(PetscScalar), h->n_local);
    PetscCall(VecRestoreArray(v, &array));
    PetscCall(BVRestoreColumn(vectors, j, &v));
  }
  PetscFunctionReturn(0);
}

/* Samples and ends of blocks, all that there are by now */
static PetscErrorCode RecordsTransfer(Sweep sweep, Stream *s, const Header *h)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < h->n_samples && s->good; i++) {
    GreedySample *sample = &sweep->greedy.sample[i];

    if (!sample->p) PetscCall(PetscMalloc1(sweep->grid.n_parameters, &sample->p));
    Transfer(s, sample->p, sizeof(PetscReal), sweep->grid.n_parameters);
    Transfer(s, &sample->krylov, sizeof(sample->krylov), 1);
    Transfer(s, &sample->factored, sizeof(sample->factored), 1);
    Transfer(s, &sample->n_vectors, sizeof(sample->n_vectors), 1);
    Transfer(s, &sample->estimate, sizeof(sample->estimate), 1);
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

/* The checksum of all that stands in a file: appended, or compared with the one at its end */
static PetscErrorCode FileSeal(const char name[], PetscBool append, PetscBool *good)
{
  FILE    *file = *good ? FileStream(name, append ? "r+b" : "rb") : NULL;
  char    *piece;
  uint64_t sum = CHECKSUM_BEGIN, last = 0;
  long     left = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(PIECE, &piece));
  *good = file && !fseek(file, 0, SEEK_END) && (left = ftell(file)) >= 0 ? PETSC_TRUE : PETSC_FALSE;
  left -= append ? 0 : (long)sizeof(last);
  if (file) rewind(file);
  for (*good = *good && left >= 0 ? PETSC_TRUE : PETSC_FALSE; *good && left > 0;) {
    const size_t size = left < PIECE ? (size_t)left : PIECE;

    if (fread(piece, 1, size, file) != size) *good = PETSC_FALSE;
    sum = ChecksumBytes(sum, piece, size);
    left -= (long)size;
  }
  if (*good && append && (fseek(file, 0, SEEK_END) || fwrite(&sum, sizeof(sum), 1, file) != 1)) *good = PETSC_FALSE;
  if (*good && !append && (fread(&last, sizeof(last), 1, file) != 1 || last != sum)) *good = PETSC_FALSE;
  if (file && fclose(file)) *good = PETSC_FALSE;
  PetscCall(PetscFree(piece));
  PetscFunctionReturn(0);
}

/* What the next file holds */
static PetscErrorCode HeaderSet(Sweep sweep, PetscInt n_parts, Header *h)
{
  const Basis  *basis  = &sweep->basis;
  const Greedy *greedy = &sweep->greedy;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(h, sizeof(*h))); /* what lies between the members is written too */
  h->version      = VERSION;
  h->n_parts      = n_parts;
  h->n_parameters = sweep->grid.n_parameters;
  h->last         = greedy->last;
  h->n_passed     = greedy->n_passed;
  h->fall         = greedy->fall;
  h->reach        = greedy->reach;
  h->n_samples    = greedy->n_samples;
  h->n_used       = basis->reduced.n_used;
  h->first        = sweep->n_kept;
  h->n            = basis->reduced.n;
  h->n_blocks     = basis->n_blocks;
  PetscCall(BVGetSizes(basis->vectors, &h->n_local, NULL, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode SweepKeep(void *ctx)
{
  Sweep               sweep = (Sweep)ctx;
  Basis              *basis = &sweep->basis;
  const ChecksumPart *scene;
  char                name[PETSC_MAX_PATH_LEN], part[PETSC_MAX_PATH_LEN];
  Stream              s    = {.write = PETSC_TRUE};
  PetscBool           good = PETSC_TRUE;
  PetscInt            n_parts;
  Header              h;

  PetscFunctionBeginUser;
  PetscCall(ChecksumGetParts(sweep->scene, &n_parts, &scene));
  PetscCall(HeaderSet(sweep, n_parts, &h));
  PetscCall(FileName(sweep, sweep->n_files, "", name));
  PetscCall(FileName(sweep, sweep->n_files, ".part", part));
  s.file = FileCreateStream(part, "wb");
  s.good = s.file ? PETSC_TRUE : PETSC_FALSE;
  Transfer(&s, &h, sizeof(h), 1);
  Transfer(&s, (void *)scene, sizeof(*scene), h.n_parts);
  Transfer(&s, basis->block_end, sizeof(PetscInt), h.n_blocks);
  PetscCall(RecordsTransfer(sweep, &s, &h));
  PetscCall(VectorsTransfer(&s, basis->vectors, &h));
  if (s.file && fclose(s.file)) s.good = PETSC_FALSE;
  PetscCall(FileSeal(part, PETSC_TRUE, &s.good));
  good = s.good;
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

/* Reads the parts of the scene; s->good = whether they are those of this sweep, names = of those that differ */
static PetscErrorCode SceneCheck(Sweep sweep, Stream *s, const Header *h, char names[256])
{
  ChecksumPart *kept;

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(names, s->good && h->version != VERSION ? "the format of the files" : "", 256));
  if (h->version != VERSION || h->n_parts < 0 || h->n_parts > SWEEP_MAX_PARTS) s->good = PETSC_FALSE;
  if (!s->good) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(h->n_parts, &kept));
  Transfer(s, kept, sizeof(*kept), h->n_parts);
  if (s->good) PetscCall(ChecksumCompare(sweep->scene, h->n_parts, kept, 256, names));
  if (names[0]) s->good = PETSC_FALSE;
  PetscCall(PetscFree(kept));
  PetscFunctionReturn(0);
}

/* Whether what a header says can be: its vectors follow those that there are, and the model has all but corrections */
static PetscErrorCode HeaderCheck(Sweep sweep, const Header *h, PetscBool *good)
{
  const Basis *basis = &sweep->basis;
  PetscInt     n_local;

  PetscFunctionBeginUser;
  PetscCall(BVGetSizes(basis->vectors, &n_local, NULL, NULL));
  if (h->n_parameters != sweep->grid.n_parameters || h->n_local != n_local) *good = PETSC_FALSE;
  if (h->first != basis->reduced.n || h->n < h->first || h->n_used < 1 || h->n_used > h->n) *good = PETSC_FALSE;
  if (h->n_samples < 1 || h->n_samples > sweep->greedy.max_samples) *good = PETSC_FALSE;
  if (h->n_blocks < basis->n_blocks || h->n_blocks > BASIS_MAX_BLOCKS) *good = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Blocks, records and vectors behind a good header */
static PetscErrorCode FileTake(Sweep sweep, Stream *s, const Header *h)
{
  Basis *basis = &sweep->basis;

  PetscFunctionBeginUser;
  Transfer(s, basis->block_end, sizeof(PetscInt), h->n_blocks);
  PetscCall(RecordsTransfer(sweep, s, h));
  PetscCall(BVResize(basis->vectors, h->n, PETSC_TRUE));
  PetscCall(VectorsTransfer(s, basis->vectors, h));
  PetscCall(AllGood(sweep->comm, &s->good));
  if (!s->good) PetscFunctionReturn(0);
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

/* Reads file k into the basis; good = whether it exists, is whole and belongs to this sweep */
static PetscErrorCode FileResume(Sweep sweep, PetscInt k, PetscBool *good)
{
  char      name[PETSC_MAX_PATH_LEN], names[256] = "";
  PetscBool there, whole;
  Header    h = {0};
  Stream    s = {NULL};

  PetscFunctionBeginUser;
  PetscCall(FileName(sweep, k, "", name));
  there = whole = access(name, F_OK) == 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(FileSeal(name, PETSC_FALSE, &whole));
  PetscCall(AllGood(sweep->comm, &whole));
  s.file = whole ? FileStream(name, "rb") : NULL;
  s.good = s.file ? PETSC_TRUE : PETSC_FALSE;
  Transfer(&s, &h, sizeof(h), 1);
  if (s.good) PetscCall(SceneCheck(sweep, &s, &h, names));
  PetscCall(HeaderCheck(sweep, &h, &s.good));
  PetscCall(AllGood(sweep->comm, &s.good));
  if (!s.good && names[0] && !k)
    PetscCall(PetscFPrintf(sweep->comm, stderr,
                           "squeal: warning: '%s' is of another scene, which differs in: %s; the sweep begins anew\n",
                           name, names));
  else if (!s.good && there)
    PetscCall(PetscFPrintf(sweep->comm, stderr,
                           "squeal: warning: '%s' is damaged or of another version; the sweep goes on without it\n",
                           name));
  if (s.good) PetscCall(FileTake(sweep, &s, &h));
  if (s.file) (void)fclose(s.file);
  *good = s.good;
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
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(sweep->comm, &rank));
  if (!rank && sweep->restart && sweep->folder) PathForget(sweep->folder, "sweep_restart_");
  PetscFunctionReturn(0);
}
