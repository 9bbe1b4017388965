/*
   contact_pairs.csv: the state of each pair of slave node and master surface in time. Pairs are numbered by interface
   and place of the slave at rest, in the order of static.csv, so that a pair keeps its number during the run and on any
   number of ranks.
*/
#include "dynamics/history/historyimpl.h"
#include "base/gather.h"
#include "base/algebra/vec3.h"
#include <stdlib.h>
#include <math.h>

typedef struct {
  PetscInt      interface, number;
  ContactStatus status;
  PetscReal     x[3], gap, lambda_n, lambda_t;
} HistoryPairRecord;

static int HistoryPairCompare(const void *one, const void *other)
{
  const HistoryPairRecord *a = one, *b = other;
  const int                order = Vec3ComparePlaces(a->x, b->x);

  if (a->interface != b->interface) return a->interface < b->interface ? -1 : 1;
  return order ? order : (a->number > b->number) - (a->number < b->number); /* two nodes may be in one place */
}

/* Records of all ranks in order, on every rank; gap m (inf where a slave faces nothing), lambda_n N, lambda_t the
   length of the friction, N */
static PetscErrorCode HistoryGatherPairs(MPI_Comm comm, const HistoryPairs *p, PetscInt *n_all, HistoryPairRecord **all)
{
  HistoryPairRecord *local;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(p->n, &local));
  for (PetscInt i = 0; i < p->n; i++) {
    const ContactState *state = &p->state[i];

    local[i] = (HistoryPairRecord){.interface = p->interface[i],
                                   .number    = p->number[i],
                                   .status    = state->status,
                                   .gap       = state->gap >= PETSC_INFINITY ? INFINITY : state->gap,
                                   .lambda_n  = state->lambda_n,
                                   .lambda_t  = hypot(state->lambda_t[0], state->lambda_t[1])};
    PetscCall(PetscArraycpy(local[i].x, &p->x[3 * i], 3));
  }
  PetscCall(GatherRecords(comm, p->n, sizeof(*local), local, n_all, all));
  if (*n_all) qsort(*all, (size_t)*n_all, sizeof(*local), HistoryPairCompare);
  PetscCall(PetscFree(local));
  PetscFunctionReturn(0);
}

PetscErrorCode HistoryWritePairs(ResultsTable table, MPI_Comm comm, const ContactInterface interfaces[], PetscReal time,
                                 const HistoryPairs *pairs)
{
  PetscInt           n_all;
  HistoryPairRecord *all;

  PetscFunctionBeginUser;
  PetscCall(HistoryGatherPairs(comm, pairs, &n_all, &all));
  for (PetscInt i = 0; i < n_all; i++) {
    const HistoryPairRecord *r = &all[i];

    PetscCall(ResultsTableRow(table, "%.15g,%" PetscInt_FMT ",%s,%.15g,%.15g,%.15g,%.15g,%.15g,%.15g,%s", (double)time,
                              i + 1, interfaces[r->interface].name, (double)r->x[0], (double)r->x[1], (double)r->x[2],
                              (double)r->gap, (double)r->lambda_n, (double)r->lambda_t, ContactStatusNames[r->status]));
  }
  PetscCall(PetscFree(all));
  PetscCall(ResultsTableCheck(table));
  PetscFunctionReturn(0);
}
