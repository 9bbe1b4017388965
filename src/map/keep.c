/*
   What a killed map goes on with, in files of the output folder until it is complete: the reduced bodies, since made
   anew on several ranks they differ by rounding and by signs, and of every chain its rows and the state at the end of
   the last one. A point depends on these alone, so that the map is the same bit by bit, on any number of ranks: each
   file is one rank's.
*/
#include "mapimpl.h"
#include "base/process/interrupt.h"
#include "base/path.h"

#define N_DIMS    8
#define N_NUMBERS 9

/* The partition of the mesh is taken out of the checksum: a rank goes on with any chain, since the kept bodies are
   whole. */
PetscErrorCode MapJournalOpen(Map map, Results results)
{
  Checksum c;

  PetscFunctionBeginUser;
  PetscCall(ChecksumCreate(map->comm, &c));
  PetscCall(ReducedAddChecksum(map->reduced, c));
  PetscCall(ChecksumDropPart(c, "its partition")); /* which the kept bodies know nothing of */
  PetscCall(OperatorsAddChecksum(map->operators, c));
  PetscCall(ChecksumSetPart(c, "the map"));
  PetscCall(ChecksumAddInts(c, 4, (const PetscInt[]){sizeof(MapPoint), map->direction, map->n_axes, map->n_twins}));
  PetscCall(ChecksumAddReals(c, 4, (const PetscReal[]){map->dt, map->end, map->window, map->rtol}));
  PetscCall(ChecksumAddReals(c, 2, (const PetscReal[]){map->limit.ratio, map->limit.growth}));
  PetscCall(ChecksumAddInts(c, 2, (const PetscInt[]){map->n_disturbances, map->seed}));
  PetscCall(ChecksumAddReals(c, 2, (const PetscReal[]){map->disturbance, map->disturbance_least}));
  for (PetscInt k = 0; k < map->n_axes; k++) {
    PetscCall(ChecksumAddReals(c, map->axis[k].n, map->axis[k].value));
    for (PetscInt i = 0; i < map->axis[k].n_moved; i++) PetscCall(ChecksumAddString(c, map->axis[k].moved[i].name));
  }
  map->journal = (Journal){PETSC_COMM_SELF, results, c, "a map", "map"};
  PetscFunctionReturn(0);
}

/* A state, behind what is there or back */
static PetscErrorCode KeptStateMove(const ReducedModel *model, ReducedState *s, JournalPack *pack)
{
  PetscFunctionBeginUser;
  PetscCall(JournalPackMove(pack, s->eta, sizeof(PetscReal) * (size_t)ReducedStateSize(model)));
  PetscCall(JournalPackMove(pack, s->status, sizeof(*s->status) * (size_t)model->n_pairs));
  PetscFunctionReturn(0);
}

/* Rows of a chain, and its state and twins at the end of the last one */
static PetscErrorCode KeptChainMove(PetscInt *n_rows, MapPoint row[], MapKept *kept, JournalPack *pack)
{
  PetscFunctionBeginUser;
  PetscCall(JournalPackMove(pack, n_rows, sizeof(*n_rows)));
  PetscCall(JournalPackMove(pack, row, sizeof(*row) * (size_t)*n_rows));
  PetscCall(JournalPackMove(pack, kept->n_alive, sizeof(*kept->n_alive)));
  PetscCall(KeptStateMove(kept->model, kept->state, pack));
  for (PetscInt i = 0; i < kept->n_twins; i++) PetscCall(KeptStateMove(kept->model, &kept->twin[i], pack));
  PetscFunctionReturn(0);
}

static PetscErrorCode MapFileName(const char kind[], PetscInt k, char name[64])
{
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, 64, "map_restart_%s_%06d", kind, (int)k));
  PetscFunctionReturn(0);
}

/* Writes the pack, and frees it; a map that cannot keep its points is one that begins anew */
static PetscErrorCode MapKeepPack(Map map, const char kind[], PetscInt k, JournalPack *pack)
{
  char              name[64];
  const JournalItem item = {kind, pack->n, pack->word};

  PetscFunctionBeginUser;
  PetscCall(MapFileName(kind, k, name));
  PetscCall(JournalKeep(&map->journal, name, 1, &item, &map->restart));
  PetscCall(JournalPackDestroy(pack));
  PetscFunctionReturn(0);
}

PetscErrorCode MapKeepChain(Map map, PetscInt chain, PetscInt n_rows, MapPoint row[], MapKept *kept)
{
  JournalPack pack = {.write = PETSC_TRUE};

  PetscFunctionBeginUser;
  if (!map->restart) PetscFunctionReturn(0);
  PetscCall(KeptChainMove(&n_rows, row, kept, &pack));
  PetscCall(MapKeepPack(map, "chain", chain, &pack));
  InterruptSays("the points so far are kept, with which the same command goes on");
  PetscFunctionReturn(0);
}

/* Not collective: a chain is one rank's. Rows that were kept are in row[0 ..], and the state is that at the end of
   the last of them. */
PetscErrorCode MapResumeChain(Map map, PetscInt chain, PetscInt *n_rows, MapPoint row[], MapKept *kept)
{
  JournalItem item = {"chain", -1, NULL};
  JournalPack pack = {.good = PETSC_TRUE};
  char        name[64];
  PetscBool   taken = PETSC_FALSE;

  PetscFunctionBeginUser;
  *n_rows = 0;
  PetscCall(MapFileName("chain", chain, name));
  if (map->restart) PetscCall(JournalTake(&map->journal, name, "the line begins anew", 1, &item, &taken));
  if (!taken) PetscFunctionReturn(0);
  pack.word = item.values;
  pack.n    = item.n;
  PetscCall(KeptChainMove(n_rows, row, kept, &pack));
  PetscCheck(pack.good && *n_rows <= map->n_linked, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a kept line ends too early");
  PetscCall(JournalPackDestroy(&pack));
  map->n_resumed += *n_rows;
  PetscFunctionReturn(0);
}

/* A rank that could not write has ended to keep: then all have, since what follows is collective */
static PetscErrorCode MapAgreeToKeep(Map map)
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &map->restart, 1, MPIU_BOOL, MPI_LAND, map->comm));
  PetscFunctionReturn(0);
}

/* Disturbed runs and their number, all on every rank, of which rank 0 writes */
PetscErrorCode MapKeepRuns(Map map, PetscInt first, size_t size, PetscInt n, void *run)
{
  JournalPack pack = {.write = PETSC_TRUE};
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCall(MapAgreeToKeep(map));
  if (!map->restart) PetscFunctionReturn(0);
  InterruptSays("the runs so far are kept, with which the same command goes on");
  PetscCallMPI(MPI_Comm_rank(map->comm, &rank));
  if (rank) PetscFunctionReturn(0);
  PetscCall(JournalPackMove(&pack, &n, sizeof(n)));
  PetscCall(JournalPackMove(&pack, run, size * (size_t)n));
  PetscCall(MapKeepPack(map, "runs", first, &pack));
  PetscFunctionReturn(0);
}

/* They belong to bodies that are kept with them: none are taken where some were made anew. *n: room, then number */
PetscErrorCode MapResumeRuns(Map map, PetscInt first, size_t size, PetscInt *n, void *run)
{
  const PetscInt room = *n;
  JournalItem    item = {"runs", -1, NULL};
  JournalPack    pack = {.good = PETSC_TRUE};
  char           name[64];
  PetscBool      taken;
  Fault          fault;

  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(MapAgreeToKeep(map));
  if (!map->restart || map->anew) PetscFunctionReturn(0);
  PetscCall(MapFileName("runs", first, name));
  PetscCall(JournalRead(&map->journal, name, 1, &item, &fault));
  PetscCall(JournalWarn(&map->journal, map->comm, name, "these runs begin anew", &fault, &taken));
  if (!taken) PetscFunctionReturn(0);
  pack.word = item.values;
  pack.n    = item.n;
  PetscCall(JournalPackMove(&pack, n, sizeof(*n)));
  PetscCheck(*n > 0 && *n <= room, map->comm, PETSC_ERR_PLIB, "%" PetscInt_FMT " kept runs are too many", *n);
  PetscCall(JournalPackMove(&pack, run, size * (size_t)*n));
  PetscCheck(pack.good, map->comm, PETSC_ERR_PLIB, "kept runs end too early");
  PetscCall(JournalPackDestroy(&pack));
  map->n_taken += *n;
  PetscFunctionReturn(0);
}

/* Arrays of the bodies, allocated where they are read; dims: modes, pairs, loads, probes, ports, impulses, damped,
   weighed. The gaps are allocated with the friction, by one call, as ReducedModelDestroy() frees them. */
static PetscErrorCode KeptBodiesMove(MapBodies *b, JournalPack *pack)
{
  ReducedModel   *a                = &b->model;
  PetscInt        dims[N_DIMS]     = {a->m,       a->n_pairs, a->n_loads,   a->n_probes,
                                      a->n_ports, b->n_hits,  a->C ? 1 : 0, a->Mx ? 1 : 0};
  PetscReal     **array[N_NUMBERS] = {&a->gap, &a->omega2, &a->C, &a->P, &a->W, &a->Cm, &a->Cx, &a->Mx, &b->hits};
  const PetscBool read             = pack->write ? PETSC_FALSE : PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(JournalPackMove(pack, dims, sizeof(dims)));
  const PetscInt m = dims[0], n = dims[1], N = dims[4], c = dims[6];
  const PetscInt size[N_NUMBERS] = {
    n, m, c * m * m, m * N, N * N, c * 3 * n * m, c * 9 * n * n, dims[7] * 9 * n * n, dims[5] * (m + 1)};

  if (read) {
    a->m = m, a->n_pairs = n, a->n_loads = dims[2], a->n_probes = dims[3], a->n_ports = N, b->n_hits = dims[5];
    PetscCall(PetscMalloc2(n, &a->gap, n, &a->friction)); /* the model frees them so */
    PetscCall(PetscMalloc1(n, &b->friction));
    PetscCall(PetscMalloc1(n, &b->interface));
  }
  for (int i = 0; i < N_NUMBERS; i++) {
    if (read && i > 0 && size[i]) PetscCall(PetscMalloc1(size[i], array[i]));
    PetscCall(JournalPackMove(pack, *array[i], sizeof(PetscReal) * (size_t)size[i]));
  }
  PetscCall(JournalPackMove(pack, a->friction, sizeof(*a->friction) * (size_t)n));
  PetscCall(JournalPackMove(pack, b->friction, sizeof(*b->friction) * (size_t)n));
  PetscCall(JournalPackMove(pack, b->interface, sizeof(*b->interface) * (size_t)n));
  PetscFunctionReturn(0);
}

/* Rank 0 alone writes: all have the same bodies. */
static PetscErrorCode MapKeepBodies(Map map, PetscInt line, MapBodies *b)
{
  JournalPack pack = {.write = PETSC_TRUE};
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  if (!map->restart) PetscFunctionReturn(0);
  PetscCall(ResultsBegin(map->journal.results, PETSC_TRUE));
  PetscCallMPI(MPI_Comm_rank(map->comm, &rank));
  if (rank) PetscFunctionReturn(0);
  PetscCall(KeptBodiesMove(b, &pack));
  PetscCall(MapKeepPack(map, "bodies", line, &pack));
  PetscFunctionReturn(0);
}

static PetscErrorCode MapResumeBodies(Map map, PetscInt line, MapBodies *b, PetscBool *good)
{
  JournalItem item = {"bodies", -1, NULL};
  JournalPack pack = {.good = PETSC_TRUE};
  char        name[64];
  Fault       fault;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(b, sizeof(*b)));
  *good = PETSC_FALSE;
  PetscCall(MapAgreeToKeep(map));
  if (!map->restart) PetscFunctionReturn(0);
  PetscCall(MapFileName("bodies", line, name));
  PetscCall(JournalRead(&map->journal, name, 1, &item, &fault));
  PetscCall(JournalWarn(&map->journal, map->comm, name, "the map begins anew there", &fault, good));
  pack.word = item.values;
  pack.n    = item.n;
  if (*good) PetscCall(KeptBodiesMove(b, &pack));
  PetscCheck(pack.good, map->comm, PETSC_ERR_PLIB, "kept bodies end too early");
  PetscCall(JournalPackDestroy(&pack));
  b->kept = *good;
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

PetscErrorCode MapBodiesGet(Map map, PetscInt line, MapBodies *bodies)
{
  PetscBool good;

  PetscFunctionBeginUser;
  PetscCall(MapResumeBodies(map, line, bodies, &good));
  if (!good) PetscCall(MapBodiesCreate(map, line, 0, bodies));
  if (!good) PetscCall(MapKeepBodies(map, line, bodies));
  if (!good) map->anew = PETSC_TRUE;
  map->m       = bodies->model.m;
  map->n_pairs = bodies->model.n_pairs;
  PetscFunctionReturn(0);
}
