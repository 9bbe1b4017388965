/*
   amplitudes.csv: complex amplitudes of modes in time by their modal filters, c = a^T (u_n - u_0) + b^T v_n, m.
*/
#include "dynamics/history/historyimpl.h"
#include "base/text.h"

#define AMPLITUDE_ROOM 32

PetscErrorCode AmplitudesCreateHeader(const HistoryFilters *filters, char **header)
{
  const size_t room = (size_t)(2 * filters->n + 1) * AMPLITUDE_ROOM;
  char         column[AMPLITUDE_ROOM];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(room, header));
  PetscCall(PetscStrncpy(*header, "time_s", room));
  for (PetscInt i = 0; i < 2 * filters->n; i++) {
    PetscCall(
      PetscSNPrintf(column, sizeof(column), ",mode_%" PetscInt_FMT "_%s_m", filters->mode[i / 2], i % 2 ? "im" : "re"));
    PetscCall(TextAdd(*header, column, room));
  }
  PetscFunctionReturn(0);
}

/* Velocities v_n (m/s) of all entries of the layout: v_{n-1/2} and what of the kick lies before t_n (motion.c) */
static void AmplitudesVelocity(const HistoryState *state, PetscInt n, PetscReal v[])
{
  const PetscReal kick = state->dt * state->b, kick_old = state->dt * (0.5 - state->b);

  for (PetscInt k = 0; k < n; k++)
    v[k] = state->before[k] + state->minv[k] * (kick * state->f[k] + (state->f_old ? kick_old * state->f_old[k] : 0));
}

PetscErrorCode HistoryWriteAmplitudes(History history, const HistoryState *state)
{
  const HistoryFilters *f       = history->filters;
  const PetscInt        n       = history->source.layout->n;
  const PetscMPIInt     n_parts = (PetscMPIInt)(2 * f->n);
  PetscReal            *v, *row;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &v, n_parts + 1, &row));
  AmplitudesVelocity(state, n, v);
  row[0] = state->time;
  for (PetscInt i = 0; i < n_parts; i++) {
    PetscReal sum = 0;

    for (PetscInt k = 0; k < n; k++) sum += f->u[i * n + k] * state->u[k] + f->v[i * n + k] * v[k];
    row[i + 1] = sum;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &row[1], n_parts, MPIU_REAL, MPI_SUM, history->comm));
  for (PetscInt i = 0; i < n_parts; i++) row[i + 1] -= f->rest[i];
  PetscCall(ResultsTableNumbers(history->amplitude_table, n_parts + 1, row));
  PetscCall(ResultsTableCheck(history->amplitude_table));
  PetscCall(PetscFree2(v, row));
  PetscFunctionReturn(0);
}
