/*
   C = I + R A^-1 L' [p][p] of an update (lowrank.h) from entries of A^-1 at the unknowns of the pairs alone,

      C_ji = (i = j) + sum_kl R_jk (A^-1)_lk L_il,   k of the unknowns of R, l of those of L, A symmetric,

   where the vectors A^-1 R' are not kept: a third to a fifth of the time of the solves that make these.
*/
#include "lowrank.h"
#include "base/gather.h"

/* Entries of A^-1 that are asked for at once: 32 MB on the first rank. */
#define CAPACITANCE_ROOM 4000000
#define CAPACITANCE_MOST 4 /* unknowns of R for each pair; above it solves are as cheap */

/* An entry of L or R */
typedef struct {
  PetscInt    pair, column;
  PetscScalar value;
} PairEntry;

/* All entries of L or R, and the unknowns that these are of, ascending, on every rank */
typedef struct {
  PetscInt   n, n_unknowns;
  PairEntry *entry;   /* [n]; `column` is the place in `unknown` once they are placed */
  PetscInt  *unknown; /* [n_unknowns] */
} PairEntries;

static PetscErrorCode EntriesGather(Mat S, PairEntries *e)
{
  PetscInt   first, last, n = 0;
  MatInfo    info;
  PairEntry *local;

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(S, &first, &last));
  PetscCall(MatGetInfo(S, MAT_LOCAL, &info));
  PetscCall(PetscMalloc1((size_t)info.nz_used, &local));
  for (PetscInt i = first; i < last; i++) {
    const PetscInt    *column;
    const PetscScalar *value;
    PetscInt           m;

    PetscCall(MatGetRow(S, i, &m, &column, &value));
    for (PetscInt k = 0; k < m; k++)
      if (value[k] != 0) local[n++] = (PairEntry){i, column[k], value[k]};
    PetscCall(MatRestoreRow(S, i, &m, &column, &value));
  }
  PetscCall(GatherRecords(PetscObjectComm((PetscObject)S), n, sizeof(*local), local, &e->n, &e->entry));
  PetscCall(PetscFree(local));
  PetscFunctionReturn(0);
}

/* Lists the unknowns and turns columns into places among them */
static PetscErrorCode EntriesPlace(PairEntries *e)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(e->n, &e->unknown));
  for (PetscInt i = 0; i < e->n; i++) e->unknown[i] = e->entry[i].column;
  e->n_unknowns = e->n;
  PetscCall(PetscSortRemoveDupsInt(&e->n_unknowns, e->unknown));
  for (PetscInt i = 0; i < e->n; i++)
    PetscCall(PetscFindInt(e->entry[i].column, e->n_unknowns, e->unknown, &e->entry[i].column));
  PetscFunctionReturn(0);
}

static PetscErrorCode EntriesDestroy(PairEntries *e)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(e->entry));
  PetscCall(PetscFree(e->unknown));
  PetscFunctionReturn(0);
}

/* c[m][p] = L a for m columns of A^-1 at the unknowns of L, a [m][unknowns of L] */
static void PairsTimes(const PairEntries *L, PetscInt p, PetscInt m, const PetscScalar a[], PetscScalar c[])
{
  for (PetscInt j = 0; j < m; j++) {
    for (PetscInt i = 0; i < p; i++) c[j * p + i] = 0;
    for (PetscInt k = 0; k < L->n; k++)
      c[j * p + L->entry[k].pair] += L->entry[k].value * a[j * L->n_unknowns + L->entry[k].column];
  }
}

/* Adds to C what the unknowns first .. first + m - 1 of R contribute, on rank 0, which has the entries; C is sent
   to all at the end. */
static PetscErrorCode CapacitanceAdd(LowRank *u, const PairEntries *L, const PairEntries *R, PetscInt first, PetscInt m)
{
  const PetscInt p = u->p;
  PetscScalar   *a, *c;
  PetscMPIInt    rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(u->comm, &rank));
  PetscCall(PetscMalloc2(rank ? 0 : m * L->n_unknowns, &a, rank ? 0 : m * p, &c));
  PetscCall((*u->inverse)(u->ctx, &(InverseBlock){L->n_unknowns, m, L->unknown, &R->unknown[first], a}));
  if (!rank) PairsTimes(L, p, m, a, c);
  for (PetscInt k = 0; k < R->n && !rank; k++) {
    const PetscInt at = R->entry[k].column - first, j = R->entry[k].pair;

    for (PetscInt i = 0; i < p && at >= 0 && at < m; i++) u->C[i * p + j] += R->entry[k].value * c[at * p + i];
  }
  PetscCall(PetscFree2(a, c));
  PetscFunctionReturn(0);
}

/* *made = PETSC_FALSE where entries cannot be had, or R has so many unknowns that solves are as cheap; C is then
   not touched. */
PetscErrorCode LowRankCapacitance(LowRank *u, PetscBool *made)
{
  PairEntries L, R;
  PetscInt    most;

  PetscFunctionBeginUser;
  *made = PETSC_FALSE;
  if (!u->inverse) PetscFunctionReturn(0);
  PetscCall(EntriesGather(u->L, &L));
  PetscCall(EntriesGather(u->R, &R));
  PetscCall(EntriesPlace(&L));
  PetscCall(EntriesPlace(&R));
  *made = R.n_unknowns <= CAPACITANCE_MOST * u->p ? PETSC_TRUE : PETSC_FALSE;
  most  = PetscMax(1, CAPACITANCE_ROOM / PetscMax(1, L.n_unknowns));
  if (*made) {
    PetscCall(PetscArrayzero(u->C, u->p * u->p));
    for (PetscInt i = 0; i < u->p; i++) u->C[i * u->p + i] = 1;
  }
  for (PetscInt first = 0; first < R.n_unknowns && *made; first += most)
    PetscCall(CapacitanceAdd(u, &L, &R, first, PetscMin(most, R.n_unknowns - first)));
  if (*made) PetscCallMPI(MPI_Bcast(u->C, (PetscMPIInt)(u->p * u->p), MPIU_SCALAR, 0, u->comm));
  PetscCall(EntriesDestroy(&L));
  PetscCall(EntriesDestroy(&R));
  PetscFunctionReturn(0);
}
