/*
   What a killed map goes on with, in files of the output folder until it is complete: the reduced bodies, since made anew on
   several ranks they differ by rounding and by signs, and of every chain its rows and the state at the end of the last one. A
   point depends on these alone, so that the map is the same bit by bit, on any number of ranks. Each file begins with the
   checksum of the scene and ends with that of itself; it gets its name when it is whole. Rows of a chain are added to a
   file of their own, of which the chain's knows number and checksum.
*/
#include "mapimpl.h"
#include "base/file.h"
#include "base/path.h"
#include <squeal/checksum.h>
#include <stdio.h>
#include <unistd.h>

#define KEEP_VERSION  6
#define KEEP_MAX_ROWS 1000000
#define N_CHAIN       3 /* pieces of a chain besides states */
#define N_STATE       7
#define N_DIMS        8
#define N_BODIES      11
#define N_NUMBERS     8 /* of these, the last ones but for the interfaces */

/* A piece of a file */
typedef struct {
  void  *at;
  size_t size;
} KeptPiece;

PetscErrorCode MapSumScene(Map map)
{
  const ChecksumPart *parts;
  PetscInt            n;
  PetscBool           partition;
  Checksum            c;

  PetscFunctionBeginUser;
  PetscCall(ChecksumCreate(map->comm, &c));
  PetscCall(ReducedAddChecksum(map->reduced, c));
  PetscCall(OperatorsAddChecksum(map->operators, c));
  PetscCall(ChecksumSetPart(c, "the map"));
  PetscCall(ChecksumAddInts(c, 4, (const PetscInt[]){KEEP_VERSION, map->direction, map->n_axes, map->n_twins}));
  PetscCall(ChecksumAddReals(c, 4, (const PetscReal[]){map->dt, map->end, map->window, map->rtol}));
  for (PetscInt k = 0; k < map->n_axes; k++) {
    PetscCall(ChecksumAddReals(c, map->axis[k].n, map->axis[k].value));
    for (PetscInt i = 0; i < map->axis[k].n_moved; i++) PetscCall(ChecksumAddString(c, map->axis[k].moved[i].name));
  }
  PetscCall(ChecksumGetParts(c, &n, &parts));
  map->scene = CHECKSUM_BEGIN;
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(PetscStrcmp(parts[i].name, "its partition", &partition)); /* which the kept bodies know nothing of */
    if (!partition) map->scene = ChecksumBytes(map->scene, &parts[i].sum, sizeof(parts[i].sum));
  }
  PetscCall(ChecksumDestroy(&c));
  PetscFunctionReturn(0);
}

static void KeptName(Map map, const char kind[], PetscInt k, const char ending[], char name[PETSC_MAX_PATH_LEN])
{
  (void)snprintf(name, PETSC_MAX_PATH_LEN, "%s/map_restart_%s_%06d%s", map->folder, kind, (int)k, ending);
}

/* A map that cannot keep its points is one that begins anew */
static PetscErrorCode KeptComplain(Map map, const char name[])
{
  PetscFunctionBeginUser;
  map->restart = PETSC_FALSE;
  PetscCall(
    PetscFPrintf(PETSC_COMM_SELF, stderr, "squeal: warning: cannot write '%s'; a killed map will begin anew\n", name));
  PetscFunctionReturn(0);
}

/* Writes the pieces */
static PetscErrorCode KeptWrite(Map map, const char kind[], PetscInt k, PetscInt n, const KeptPiece piece[])
{
  char     name[PETSC_MAX_PATH_LEN], part[PETSC_MAX_PATH_LEN];
  uint64_t sum  = CHECKSUM_BEGIN;
  FILE    *file = NULL;
  int      good;

  PetscFunctionBeginUser;
  if (!map->restart) PetscFunctionReturn(0);
  KeptName(map, kind, k, "", name);
  KeptName(map, kind, k, ".part", part);
  file = FileCreateStream(part, "wb");
  good = file && fwrite(&map->scene, sizeof(map->scene), 1, file) == 1;
  for (PetscInt i = 0; i < n && good; i++) {
    if (!piece[i].size) continue;
    good = fwrite(piece[i].at, piece[i].size, 1, file) == 1;
    sum  = ChecksumBytes(sum, piece[i].at, piece[i].size);
  }
  good = good && fwrite(&sum, sizeof(sum), 1, file) == 1;
  if (file && fclose(file)) good = 0;
  if (good && rename(part, name)) good = 0;
  if (good) PetscFunctionReturn(0);
  (void)unlink(part);
  PetscCall(KeptComplain(map, name));
  PetscFunctionReturn(0);
}

/* Reads the pieces; `whole`: they are all that the file holds, and its checksum is right */
static PetscBool KeptRead(Map map, const char kind[], PetscInt k, PetscInt n, const KeptPiece piece[], PetscBool whole)
{
  char     name[PETSC_MAX_PATH_LEN];
  uint64_t sum = CHECKSUM_BEGIN, scene = 0, last = 0;
  FILE    *file;
  int      good;

  if (!map->restart) return PETSC_FALSE;
  KeptName(map, kind, k, "", name);
  file = FileStream(name, "rb");
  good = file && fread(&scene, sizeof(scene), 1, file) == 1 && scene == map->scene;
  for (PetscInt i = 0; i < n && good; i++) {
    if (!piece[i].size) continue;
    good = fread(piece[i].at, piece[i].size, 1, file) == 1;
    if (good) sum = ChecksumBytes(sum, piece[i].at, piece[i].size);
  }
  if (whole) good = good && fread(&last, sizeof(last), 1, file) == 1 && last == sum && fgetc(file) == EOF;
  if (file) (void)fclose(file);
  return good ? PETSC_TRUE : PETSC_FALSE;
}

/* Numbers of the state */
static PetscInt KeptState(const ReducedModel *model, ReducedState *s, KeptPiece piece[])
{
  const size_t m = (size_t)model->m * sizeof(PetscReal), N = (size_t)model->n_ports * sizeof(PetscReal);
  const size_t n = (size_t)model->n_pairs * sizeof(PetscReal);
  PetscInt     k = 0;

  piece[k++] = (KeptPiece){s->eta, m};
  piece[k++] = (KeptPiece){s->rate, m};
  piece[k++] = (KeptPiece){s->p, N};
  piece[k++] = (KeptPiece){s->last, N};
  piece[k++] = (KeptPiece){s->q, 3 * n};
  piece[k++] = (KeptPiece){s->y, 3 * n};
  piece[k++] = (KeptPiece){s->status, (size_t)model->n_pairs * sizeof(*s->status)};
  return k;
}

/* What is kept of a chain besides its rows; the number of pieces */
static PetscInt KeptChain(PetscInt *n_rows, MapKept *kept, KeptPiece piece[N_CHAIN + N_STATE * (1 + MAP_MAX_TWINS)])
{
  PetscInt k = 0;

  piece[k++] = (KeptPiece){n_rows, sizeof(*n_rows)};
  piece[k++] = (KeptPiece){&kept->sum, sizeof(kept->sum)};
  piece[k++] = (KeptPiece){kept->n_alive, sizeof(*kept->n_alive)};
  k += KeptState(kept->model, kept->state, &piece[k]);
  for (PetscInt i = 0; i < kept->n_twins; i++) k += KeptState(kept->model, &kept->twin[i], &piece[k]);
  return k;
}

/* Puts row k of a chain where it belongs, after those before it */
static PetscErrorCode KeptAddRow(Map map, PetscInt chain, PetscInt k, const MapPoint *row)
{
  char  name[PETSC_MAX_PATH_LEN];
  FILE *file;
  int   good;

  PetscFunctionBeginUser;
  if (!map->restart) PetscFunctionReturn(0);
  KeptName(map, "rows", chain, "", name);
  file = k ? FileStream(name, "r+b") : FileCreateStream(name, "wb");
  good =
    file && fseek(file, (long)((size_t)k * sizeof(*row)), SEEK_SET) == 0 && fwrite(row, sizeof(*row), 1, file) == 1;
  if (file && fclose(file)) good = 0;
  if (!good) PetscCall(KeptComplain(map, name));
  PetscFunctionReturn(0);
}

/* Whether n rows of a chain are there, with that checksum */
static PetscBool KeptReadRows(Map map, PetscInt chain, PetscInt n, MapPoint row[], uint64_t sum)
{
  char     name[PETSC_MAX_PATH_LEN];
  uint64_t found = CHECKSUM_BEGIN;
  FILE    *file;
  int      good;

  KeptName(map, "rows", chain, "", name);
  file = FileStream(name, "rb");
  good = file && fread(row, sizeof(*row), (size_t)n, file) == (size_t)n;
  if (file) (void)fclose(file);
  for (PetscInt k = 0; k < n && good; k++) found = ChecksumBytes(found, &row[k], sizeof(*row));
  return good && found == sum ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode MapKeepChain(Map map, PetscInt chain, PetscInt n_rows, MapPoint row[], MapKept *kept)
{
  KeptPiece piece[N_CHAIN + N_STATE * (1 + MAP_MAX_TWINS)];

  PetscFunctionBeginUser;
  PetscCall(KeptAddRow(map, chain, n_rows - 1, &row[n_rows - 1]));
  kept->sum = ChecksumBytes(n_rows > 1 ? kept->sum : CHECKSUM_BEGIN, &row[n_rows - 1], sizeof(*row));
  PetscCall(KeptWrite(map, "chain", chain, KeptChain(&n_rows, kept, piece), piece));
  PetscFunctionReturn(0);
}

PetscErrorCode MapResumeChain(Map map, PetscInt chain, PetscInt *n_rows, MapPoint row[], MapKept *kept)
{
  KeptPiece piece[N_CHAIN + N_STATE * (1 + MAP_MAX_TWINS)];
  PetscBool good;

  PetscFunctionBeginUser;
  good = KeptRead(map, "chain", chain, KeptChain(n_rows, kept, piece), piece, PETSC_TRUE);
  if (good && (*n_rows < 1 || *n_rows > map->n_linked || *kept->n_alive < 0 || *kept->n_alive > kept->n_twins))
    good = PETSC_FALSE;
  if (good) good = KeptReadRows(map, chain, *n_rows, row, kept->sum);
  if (!good) *n_rows = 0, *kept->n_alive = 0;
  map->n_resumed += *n_rows;
  PetscFunctionReturn(0);
}

/* Arrays of the bodies, allocated where they are to be read; dims: modes, pairs, loads, probes, ports, impulses, damped */
static PetscErrorCode KeptBodies(MapBodies *b, const PetscInt dims[N_DIMS], PetscBool allocate,
                                 KeptPiece piece[N_BODIES])
{
  ReducedModel  *a = &b->model;
  const PetscInt m = dims[0], n = dims[1], N = dims[4], c = dims[6];
  PetscReal    **array[N_NUMBERS] = {&a->gap, &a->omega2, &a->C, &a->P, &a->W, &a->Cm, &a->Cx, &b->hits};
  const PetscInt size[N_NUMBERS]  = {n, m, c * m * m, m * N, N * N, c * 3 * n * m, c * 9 * n * n, dims[5] * (m + 1)};

  PetscFunctionBeginUser;
  if (allocate) PetscCall(PetscMalloc2(n, &a->gap, n, &a->friction)); /* the model frees them so */
  if (allocate) PetscCall(PetscMalloc1(n, &b->friction));
  piece[0] = (KeptPiece){a->friction, (size_t)n * sizeof(*a->friction)};
  piece[1] = (KeptPiece){b->friction, (size_t)n * sizeof(*b->friction)};
  for (int i = 0; i < N_NUMBERS; i++) {
    if (allocate && i > 0 && size[i]) PetscCall(PetscMalloc1(size[i], array[i]));
    piece[2 + i] = (KeptPiece){*array[i], (size_t)size[i] * sizeof(PetscReal)};
  }
  if (allocate) PetscCall(PetscMalloc1(n, &b->interface));
  piece[N_BODIES - 1] = (KeptPiece){b->interface, (size_t)n * sizeof(PetscInt)};
  PetscFunctionReturn(0);
}

PetscErrorCode MapKeepBodies(Map map, PetscInt line, MapBodies *b)
{
  const ReducedModel *a         = &b->model;
  PetscInt  dims[N_DIMS]        = {a->m, a->n_pairs, a->n_loads, a->n_probes, a->n_ports, b->n_hits, a->C ? 1 : 0, 0};
  KeptPiece piece[N_BODIES + 1] = {
    {dims, sizeof(dims)}
  };
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(map->comm, &rank));
  if (rank) PetscFunctionReturn(0);
  PetscCall(KeptBodies(b, dims, PETSC_FALSE, &piece[1]));
  PetscCall(KeptWrite(map, "bodies", line, N_BODIES + 1, piece));
  PetscFunctionReturn(0);
}

PetscErrorCode MapResumeBodies(Map map, PetscInt line, MapBodies *b, PetscBool *good)
{
  PetscInt  dims[N_DIMS]        = {0};
  KeptPiece piece[N_BODIES + 1] = {
    {dims, sizeof(dims)}
  };
  char name[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(b, sizeof(*b)));
  *good = KeptRead(map, "bodies", line, 1, piece, PETSC_FALSE);
  for (int i = 0; i < N_DIMS && *good; i++)
    if (dims[i] < 0 || dims[i] > KEEP_MAX_ROWS) *good = PETSC_FALSE;
  if (*good) {
    PetscCall(KeptBodies(b, dims, PETSC_TRUE, &piece[1]));
    *good = KeptRead(map, "bodies", line, N_BODIES + 1, piece, PETSC_TRUE);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, good, 1, MPIU_BOOL, MPI_LAND, map->comm));
  b->model.m = dims[0], b->model.n_pairs = dims[1], b->model.n_loads = dims[2];
  b->model.n_probes = dims[3], b->model.n_ports = dims[4], b->n_hits = dims[5];
  if (!*good) PetscCall(MapBodiesDestroy(b));
  KeptName(map, "bodies", line, "", name);
  if (!*good && map->restart && access(name, F_OK) == 0)
    PetscCall(PetscFPrintf(map->comm, stderr,
                           "squeal: warning: '%s' is of another scene or damaged; the map begins anew there\n", name));
  PetscFunctionReturn(0);
}

/* Takes away what this map and killed ones before it have kept in the folder */
PetscErrorCode MapForget(Map map)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Barrier(map->comm));
  PetscCallMPI(MPI_Comm_rank(map->comm, &rank));
  if (!rank) PathForget(map->folder, "map_restart_");
  PetscFunctionReturn(0);
}
