/*
   Rows of transient.csv. Forces are the sums over all pairs of the step from t_n, energies those of the half step
   before t_n; motions of probes are those at t_n.
*/
#include "dynamics/history/historyimpl.h"
#include "base/text.h"

#define N_PER_FACE  2
#define N_PER_PROBE 9
#define NAME_ROOM   40 /* characters of a column besides the name of its interface or probe */

/* Columns before those of interfaces and probes: members of FirstColumns, and their names in the header */
#define FIRST_COLUMNS(X)                                                                                               \
  X(time, "time_s")                                                                                                    \
  X(normal, "normal_force_n")                                                                                          \
  X(friction, "friction_force_n")                                                                                      \
  X(n_closed, "n_closed")                                                                                              \
  X(n_stick, "n_stick")                                                                                                \
  X(kinetic, "kinetic_j")                                                                                              \
  X(strain, "strain_j")                                                                                                \
  X(external_work, "external_work_j")                                                                                  \
  X(friction_work, "friction_work_j")                                                                                  \
  X(contact_work, "contact_work_j")                                                                                    \
  X(damping_work, "damping_work_j")                                                                                    \
  X(energy_error, "energy_error_j")                                                                                    \
  X(integrator_work, "integrator_work_j")                                                                              \
  X(heat, "friction_heat_j")                                                                                           \
  X(n_open, "n_open")                                                                                                  \
  X(residual, "projector_residual")                                                                                    \
  X(sweeps, "projector_sweeps")

#define COLUMN_NAME(member, name)   "," name
#define COLUMN_MEMBER(member, name) PetscReal member;

static const char comma_first_columns[] = FIRST_COLUMNS(COLUMN_NAME);

typedef struct {
  FIRST_COLUMNS(COLUMN_MEMBER)
} FirstColumns;

#define N_FIRST ((PetscInt)(sizeof(FirstColumns) / sizeof(PetscReal)))

static const char *const face_columns[N_PER_FACE]   = {"normal_force_n", "friction_force_n"};
static const char *const probe_columns[N_PER_PROBE] = {"x_m",    "y_m",     "z_m",     "vx_m_s", "vy_m_s",
                                                       "vz_m_s", "ax_m_s2", "ay_m_s2", "az_m_s2"};

/* Interfaces with columns of their own: where there are several */
static PetscInt HistoryCountFaces(History history)
{
  return history->source.n_interfaces > 1 ? history->source.n_interfaces : 0;
}

/* Adds the columns `name`_`column` to a header that has room for them */
static PetscErrorCode HistoryAddColumns(char header[], size_t room, const char name[], PetscInt n,
                                        const char *const columns[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(TextAdd(header, ",", room));
    PetscCall(TextAdd(header, name, room));
    PetscCall(TextAdd(header, "_", room));
    PetscCall(TextAdd(header, columns[i], room));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode HistoryCreateHeader(History history, char **header)
{
  const PetscInt n_faces = HistoryCountFaces(history);
  size_t         room    = sizeof(comma_first_columns), length;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n_faces; i++) {
    PetscCall(PetscStrlen(history->source.interfaces[i].name, &length));
    room += N_PER_FACE * (length + NAME_ROOM);
  }
  for (PetscInt i = 0; i < history->n_probes; i++) {
    PetscCall(PetscStrlen(history->probes[i].name, &length));
    room += N_PER_PROBE * (length + NAME_ROOM);
  }
  PetscCall(PetscMalloc1(room, header));
  PetscCall(PetscStrncpy(*header, comma_first_columns + 1, room));
  for (PetscInt i = 0; i < n_faces; i++)
    PetscCall(HistoryAddColumns(*header, room, history->source.interfaces[i].name, N_PER_FACE, face_columns));
  for (PetscInt i = 0; i < history->n_probes; i++)
    PetscCall(HistoryAddColumns(*header, room, history->probes[i].name, N_PER_PROBE, probe_columns));
  PetscFunctionReturn(0);
}

/* Sums over the interfaces; mean sweeps per step since the last row */
static void HistoryRowContact(History history, const HistoryState *state, FirstColumns *row)
{
  PetscReal sweeps = 0, steps = 0;

  for (PetscInt i = 0; i < state->n_interfaces; i++) {
    const ContactSums *s = &state->sums[i];

    row->normal += s->normal;
    row->friction += s->friction;
    row->n_closed += s->n[CONTACT_STICK] + s->n[CONTACT_SLIP];
    row->n_stick += s->n[CONTACT_STICK];
    row->n_open += s->n[CONTACT_OPEN];
    row->residual = PetscMax(row->residual, s->residual);
    sweeps += s->sweeps;
    steps += s->steps;
  }
  row->sweeps     = steps > history->steps ? (sweeps - history->sweeps) / (steps - history->steps) : 0;
  history->sweeps = sweeps;
  history->steps  = steps;
}

/* Motions of the probes, [n_probes][9], on rank 0; each is known to one rank */
static PetscErrorCode HistoryRowProbes(History history, const HistoryState *state, PetscReal motions[])
{
  const PetscInt n = N_PER_PROBE * history->n_probes;
  PetscReal     *mine;

  PetscFunctionBeginUser;
  if (!n) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(n, &mine));
  for (PetscInt i = 0; i < history->n_probes; i++) {
    PetscReal *const m = &mine[N_PER_PROBE * i];

    if (history->probes[i].vertex >= 0)
      HistoryMotion(history->source.layout, state, history->probes[i].vertex, m, m + 3, m + 6);
  }
  PetscCallMPI(MPI_Reduce(mine, motions, (PetscMPIInt)n, MPIU_REAL, MPI_SUM, 0, history->comm));
  PetscCall(PetscFree(mine));
  PetscFunctionReturn(0);
}

PetscErrorCode HistoryWriteRow(History history, const HistoryState *state)
{
  const PetscInt n_faces = HistoryCountFaces(history), n_motions = N_PER_PROBE * history->n_probes;
  const PetscInt n     = N_FIRST + N_PER_FACE * n_faces + n_motions;
  const Ledger  *l     = state->ledger;
  FirstColumns   first = {.time            = state->time,
                          .kinetic         = l->kinetic,
                          .strain          = l->strain,
                          .external_work   = l->external,
                          .friction_work   = l->friction,
                          .contact_work    = l->contact,
                          .damping_work    = l->damping,
                          .energy_error    = l->error,
                          .integrator_work = l->integrator,
                          .heat            = l->heat};
  PetscReal     *row;

  PetscFunctionBeginUser;
  PetscCheck(n_faces <= state->n_interfaces, history->comm, PETSC_ERR_ARG_SIZ,
             "sums of %" PetscInt_FMT " interfaces, must be %" PetscInt_FMT, state->n_interfaces, n_faces);
  PetscCall(PetscCalloc1(n, &row));
  HistoryRowContact(history, state, &first);
  PetscCall(PetscArraycpy(row, (const PetscReal *)&first, N_FIRST));
  for (PetscInt i = 0; i < n_faces; i++) {
    row[N_FIRST + N_PER_FACE * i]     = state->sums[i].normal;
    row[N_FIRST + N_PER_FACE * i + 1] = state->sums[i].friction;
  }
  PetscCall(HistoryRowProbes(history, state, &row[n - n_motions]));
  PetscCall(ResultsTableNumbers(history->table, n, row));
  PetscCall(ResultsTableCheck(history->table));
  PetscCall(PetscFree(row));
  PetscFunctionReturn(0);
}
