/*
   Unit test of GatherRecords(): rank r gives r records (rank 0 none) of 24 bytes that hold r and their place, so that
   on p ranks p (p - 1) / 2 arrive, ordered by rank and place. Breaks when counts are taken for bytes, displacements are
   shifted, or a rank without records is skipped. ExchangeRecords(): rank r sends r + s records to rank s, mixed up, none to
   itself where r = s; they hold both and their place. Breaks when ranks or places are mixed up, and when the records of a rank
   are not in its order.
*/
#include "check.h"
#include "base/gather.h"

/* Padding after `mark` included: the datatype has to span it */
typedef struct {
  double rank, place;
  char   mark;
} Entry;

/* The record that rank r gives at place i */
static Entry Expected(int rank, int place)
{
  return (Entry){.rank = rank, .place = place, .mark = (char)('a' + 3 * rank + place)};
}

static int CheckEntries(int n_ranks, PetscInt n, const Entry all[])
{
  int wrong = 0, k = 0;

  if (CheckTrue("as many records as all ranks gave", n == n_ranks * (n_ranks - 1) / 2, (double)n)) return 1;
  for (int r = 0; r < n_ranks; r++) {
    for (int i = 0; i < r; i++, k++) {
      const Entry e = Expected(r, i);

      wrong += all[k].rank != e.rank || all[k].place != e.place || all[k].mark != e.mark;
    }
  }
  return CheckTrue("every record at its place, wrong ones", wrong == 0, wrong);
}

/* Records from rank r to rank s that are as expected, in the order of r and of place */
static int CheckExchanged(int n_ranks, int s, PetscInt n, const Entry in[])
{
  PetscInt k = 0;
  int      wrong = 0;

  for (int r = 0; r < n_ranks; r++)
    for (int i = 0; r != s && i < r + s; i++, k++) wrong += k >= n || in[k].rank != r || in[k].place != i || in[k].mark != s;
  return CheckTrue("as many records as were sent here", n == k, (double)n) +
         CheckTrue("every one that was sent here, wrong ones", wrong == 0, wrong);
}

static PetscErrorCode RunExchange(PetscMPIInt rank, PetscMPIInt n_ranks, int *failed)
{
  Entry      *local, *in;
  PetscMPIInt to[64];
  PetscInt    n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(64, &local));
  for (int i = 0; i < rank + n_ranks; i++)
    for (int s = 0; s < n_ranks; s++) {
      if (s == rank || i >= rank + s) continue;
      to[n]      = s;
      local[n++] = (Entry){.rank = rank, .place = i, .mark = (char)s};
    }
  PetscCall(ExchangeRecords(PETSC_COMM_WORLD, &n, sizeof(Entry), &local, to, &in));
  *failed += CheckTrue("what was sent is freed", !local, local != NULL);
  *failed += CheckExchanged(n_ranks, rank, n, in);
  PetscCall(PetscFree(in));
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(int *failed)
{
  Entry       local[64], *all;
  PetscInt    n;
  PetscMPIInt rank, n_ranks;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &n_ranks));
  for (int i = 0; i < rank; i++) local[i] = Expected(rank, i);
  PetscCall(GatherRecords(PETSC_COMM_WORLD, rank, sizeof(Entry), local, &n, &all));
  *failed = CheckEntries(n_ranks, n, all);
  PetscCall(PetscFree(all));
  PetscCall(GatherRecords(PETSC_COMM_WORLD, 0, sizeof(Entry), NULL, &n, &all));
  *failed += CheckTrue("no rank gives records", n == 0, (double)n);
  PetscCall(PetscFree(all));
  PetscCall(RunExchange(rank, n_ranks, failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  int failed = 0;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(Run(&failed));
  PetscCall(PetscFinalize());
  return failed ? 1 : 0;
}
