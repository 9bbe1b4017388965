/*
   A point from which the branches of a sweep in full go on, as arrays of a file and back: its modes and those it
   remembers in coordinates of its vectors, its damping row by row, and the vectors.
*/
#include "follow.h"

typedef struct {
  PetscInt  n, n_memory, size, n_local, place, n_damping; /* n_damping: entries of this rank, -1 without damping */
  PetscReal value;
} FollowHeader;

static PetscErrorCode FollowModesMove(JournalPack *pack, ReducedModes *modes)
{
  const size_t n = (size_t)modes->n, n_all = n * (size_t)modes->size;

  PetscFunctionBeginUser;
  PetscCall(JournalPackMove(pack, modes->lambda, sizeof(*modes->lambda) * n));
  PetscCall(JournalPackMove(pack, modes->error, sizeof(*modes->error) * n));
  PetscCall(JournalPackMove(pack, modes->rigid, sizeof(*modes->rigid) * n));
  PetscCall(JournalPackMove(pack, modes->x, sizeof(*modes->x) * n_all));
  PetscCall(JournalPackMove(pack, modes->y, sizeof(*modes->y) * n_all));
  PetscFunctionReturn(0);
}

/* Rows of this rank in the order of the matrix: where they begin, [rows + 1], columns and values; NULL for what is
   not wanted. */
static PetscErrorCode RowsGet(Mat C, PetscInt begin[], PetscInt column[], PetscScalar value[])
{
  PetscInt first, last;

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(C, &first, &last));
  begin[0] = 0;
  for (PetscInt r = first; r < last; r++) {
    const PetscInt    *columns, at = begin[r - first];
    const PetscScalar *values;
    PetscInt           n;

    PetscCall(MatGetRow(C, r, &n, &columns, &values));
    if (column) PetscCall(PetscArraycpy(&column[at], columns, n));
    if (value) PetscCall(PetscArraycpy(&value[at], values, n));
    begin[r - first + 1] = at + n;
    PetscCall(MatRestoreRow(C, r, &n, &columns, &values));
  }
  PetscFunctionReturn(0);
}

/* Collective on reading: the matrix is made of the same rows on the same ranks. Only the preallocation of the type
   that C has takes effect. */
static PetscErrorCode DampingMove(MPI_Comm comm, const FollowHeader *h, JournalPack *pack, Mat *C)
{
  PetscInt    *begin, *column;
  PetscScalar *value;

  PetscFunctionBeginUser;
  if (h->n_damping < 0) PetscFunctionReturn(0);
  PetscCall(PetscMalloc3(h->n_local + 1, &begin, h->n_damping, &column, h->n_damping, &value));
  if (pack->write) PetscCall(RowsGet(*C, begin, column, value));
  PetscCall(JournalPackMove(pack, begin, sizeof(*begin) * (size_t)(h->n_local + 1)));
  PetscCall(JournalPackMove(pack, column, sizeof(*column) * (size_t)h->n_damping));
  PetscCall(JournalPackMove(pack, value, sizeof(*value) * (size_t)h->n_damping));
  if (!pack->write && pack->good) {
    PetscCall(MatCreate(comm, C));
    PetscCall(MatSetSizes(*C, h->n_local, h->n_local, PETSC_DETERMINE, PETSC_DETERMINE));
    PetscCall(MatSetType(*C, MATAIJ));
    PetscCall(MatSeqAIJSetPreallocationCSR(*C, begin, column, value));
    PetscCall(MatMPIAIJSetPreallocationCSR(*C, begin, column, value));
  }
  PetscCall(PetscFree3(begin, column, value));
  PetscFunctionReturn(0);
}

static PetscErrorCode HeaderRead(const FollowPoint *point, FollowHeader *h)
{
  PetscInt *begin;

  PetscFunctionBeginUser;
  *h = (FollowHeader){.n        = point->modes.n,
                      .n_memory = point->memory.modes.n,
                      .size     = point->modes.size,
                      .place    = point->place,
                      .value    = point->value};
  PetscCall(BVGetSizes(point->vectors, &h->n_local, NULL, NULL));
  h->n_damping = -1;
  if (!point->C) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(h->n_local + 1, &begin));
  PetscCall(RowsGet(point->C, begin, NULL, NULL));
  h->n_damping = begin[h->n_local];
  PetscCall(PetscFree(begin));
  PetscFunctionReturn(0);
}

/* A point with room for what the header says */
static PetscErrorCode HeaderMake(MPI_Comm comm, const FollowHeader *h, FollowPoint *point)
{
  Vec like;

  PetscFunctionBeginUser;
  point->place = h->place;
  point->value = h->value;
  PetscCall(ReducedModesCreate(h->n, h->size, &point->modes));
  PetscCall(ReducedModesCreate(h->n_memory, h->size, &point->memory.modes));
  PetscCall(PetscMalloc1(h->n, &point->branch));
  PetscCall(PetscMalloc1(h->n_memory, &point->memory.branch));
  PetscCall(VecCreate(comm, &like));
  PetscCall(VecSetSizes(like, h->n_local, PETSC_DETERMINE));
  PetscCall(VecSetType(like, VECSTANDARD));
  PetscCall(BVCreate(comm, &point->vectors));
  PetscCall(BVSetType(point->vectors, BVMAT));
  PetscCall(BVSetSizesFromVec(point->vectors, like, h->size));
  PetscCall(BVSetActiveColumns(point->vectors, 0, h->size));
  PetscCall(VecDestroy(&like));
  PetscFunctionReturn(0);
}

/* One function for both directions, so that what is read is in the order in which it was written; the vectors are
   an item of their own, [size][n_local]. */
PetscErrorCode FollowPointMove(MPI_Comm comm, JournalPack *pack, FollowPoint *point, JournalItem *vectors)
{
  FollowHeader h;
  PetscInt     n;

  PetscFunctionBeginUser;
  if (pack->write) PetscCall(HeaderRead(point, &h));
  PetscCall(JournalPackMove(pack, &h, sizeof(h)));
  if (!pack->write) PetscCall(HeaderMake(comm, &h, point));
  PetscCall(FollowModesMove(pack, &point->modes));
  PetscCall(FollowModesMove(pack, &point->memory.modes));
  PetscCall(JournalPackMove(pack, point->branch, sizeof(PetscInt) * (size_t)h.n));
  PetscCall(JournalPackMove(pack, point->memory.branch, sizeof(PetscInt) * (size_t)h.n_memory));
  PetscCall(DampingMove(comm, &h, pack, &point->C));
  n = h.size * h.n_local;
  if (pack->write) PetscCall(PetscMalloc1(n, &vectors->values));
  if (pack->write) vectors->n = n;
  PetscCheck(pack->write || (pack->good && vectors->n == n), PETSC_COMM_SELF, PETSC_ERR_PLIB,
             "a kept point lacks vectors");
  PetscCall(BasisVectorsMove(point->vectors, 0, h.size, pack->write ? PETSC_FALSE : PETSC_TRUE, vectors->values));
  PetscFunctionReturn(0);
}
