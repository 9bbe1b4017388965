/*
   History - life cycle, what is due, and what a restart needs. Tables are opened when they get their first row, so
   that a restart finds those of the run before.
*/
#include <squeal/options.h>
#include "historyimpl.h"

#define N_TABLES 5 /* rows, pairs, amplitudes, circles, sound */

/* What a restart needs, before the times of the snapshots and what is heard: reals alone */
typedef struct {
  Schedule  rows, pairs, frames;
  Growth    growth;
  PetscReal sweeps, steps;
  PetscReal mark[N_TABLES][3]; /* of the tables: length, halves of the checksum */
  PetscReal n_frames, n_sound; /* times of the snapshots, and numbers of the sound behind them */
} HistoryKept;

#define N_KEPT (PetscInt)(sizeof(HistoryKept) / sizeof(PetscReal))

PetscErrorCode HistoryCreate(MPI_Comm comm, History *history)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(history));
  (*history)->comm = comm;
  PetscCall(QuantitiesInit(&history_quantities, *history));
  PetscFunctionReturn(0);
}

PetscErrorCode HistorySetFromOptions(History h)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesRead(h->comm, &history_quantities, h));
  PetscFunctionReturn(0);
}

PetscErrorCode HistoryVisit(History h, const QuantityVisitor *visitor)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisit(visitor, &history_quantities, NULL, h, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode HistorySetUp(History history, const HistorySource *source, PetscReal end, PetscReal dt)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  history->source   = *source;
  history->live.end = end;
  /* a twentieth of the run, at most 1 ms: several periods of what squeals above 1 kHz */
  history->growth.window = end > 0 ? PetscMin(end / 20, 1e-3) : 1e-3;
  PetscCall(ModelGetScene(source->model, &scene));
  history->n_probes  = scene->n_probes;
  history->probes    = scene->probes;
  history->n_circles = scene->n_circles;
  history->circles   = scene->circles;
  PetscCall(HistoryFit(history, end, dt));
  PetscCheck(history->pairs.interval == 0 || source->interfaces, history->comm, PETSC_ERR_ARG_WRONGSTATE,
             "states of pairs need the names of their interfaces");
  if (history->frames.interval > 0) PetscCall(SnapshotsCreate(history));
  PetscFunctionReturn(0);
}

PetscErrorCode HistorySetFilters(History history, const HistoryFilters *filters)
{
  PetscFunctionBeginUser;
  history->filters = filters;
  PetscFunctionReturn(0);
}

PetscErrorCode HistorySetSound(History history, Sound sound)
{
  PetscFunctionBeginUser;
  history->sound = sound;
  PetscFunctionReturn(0);
}

PetscErrorCode HistoryHasFields(History history, PetscBool *fields)
{
  PetscFunctionBeginUser;
  *fields = history->frames.interval > 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscBool HistoryIsDue(History history, PetscReal t, PetscReal dt)
{
  return ScheduleIsDue(&history->rows, t, dt) || ScheduleIsDue(&history->pairs, t, dt) ||
             ScheduleIsDue(&history->frames, t, dt)
           ? PETSC_TRUE
           : PETSC_FALSE;
}

/* A mark as reals, and back: halves of 32 bits, which a real holds exactly */
static void MarkKeep(const ResultsMark *mark, PetscReal kept[3])
{
  kept[0] = (PetscReal)mark->bytes;
  kept[1] = (PetscReal)(mark->sum >> 32);
  kept[2] = (PetscReal)(mark->sum & UINT32_MAX);
}

static ResultsMark MarkTake(const PetscReal kept[3])
{
  return (ResultsMark){(PetscInt64)kept[0], (uint64_t)kept[1] << 32 | (uint64_t)kept[2]};
}

/* Opens a table; bytes > 0 in a mark: goes on with that of the run before */
static PetscErrorCode HistoryBeginTable(Results results, const char name[], const char header[], ResultsMark mark,
                                        ResultsTable *table)
{
  PetscFunctionBeginUser;
  if (*table) PetscFunctionReturn(0);
  if (mark.bytes > 0)
    PetscCall(ResultsTableReopen(results, name, header, &mark, table));
  else
    PetscCall(ResultsTableOpen(results, name, header, table));
  PetscFunctionReturn(0);
}

/* Opens the tables that are wanted, if they are not open */
static PetscErrorCode HistoryBeginTables(History history, const ResultsMark mark[N_TABLES])
{
  const Results results = history->source.results;
  char         *header;

  PetscFunctionBeginUser;
  if (!history->table) {
    PetscCall(HistoryCreateHeader(history, &header));
    PetscCall(HistoryBeginTable(results, "transient", header, mark[0], &history->table));
    PetscCall(PetscFree(header));
  }
  if (history->pairs.interval > 0)
    PetscCall(HistoryBeginTable(results, "contact_pairs", PAIRS_HEADER, mark[1], &history->pair_table));
  if (history->filters && !history->amplitude_table) {
    PetscCall(AmplitudesCreateHeader(history->filters, &header));
    PetscCall(HistoryBeginTable(results, "amplitudes", header, mark[2], &history->amplitude_table));
    PetscCall(PetscFree(header));
  }
  if (history->n_circles && !history->circle_table) {
    PetscCall(CirclesCreateHeader(history, &header));
    PetscCall(HistoryBeginTable(results, "circles", header, mark[3], &history->circle_table));
    PetscCall(PetscFree(header));
  }
  if (HistoryHears(history) && !history->sound_table) {
    PetscCall(HistoryCreateSoundHeader(history, &header));
    PetscCall(HistoryBeginTable(results, "sound_time", header, mark[4], &history->sound_table));
    PetscCall(PetscFree(header));
  }
  PetscFunctionReturn(0);
}

/* States of the pairs in the step from t_n */
static PetscErrorCode HistoryRecordPairs(History history, const HistoryState *state)
{
  HistoryPairs p;

  PetscFunctionBeginUser;
  if (state->pairs)
    p = *state->pairs;
  else
    PetscCall(ContactProjectorGetStates(history->source.projector, &p.n, &p.state, &p.interface, &p.number, &p.x));
  PetscCall(HistoryWritePairs(history->pair_table, history->comm, history->source.interfaces, state->time, &p));
  PetscFunctionReturn(0);
}

/* Collective. state->ledger is known on all ranks, growth on each alike. Snapshots are of the same time as the row. */
PetscErrorCode HistoryRecord(History history, const HistoryState *state)
{
  PetscFunctionBeginUser;
  PetscCall(HistoryBeginTables(history, (ResultsMark[N_TABLES]){{0}}));
  if (ScheduleMeet(&history->rows, state->time, state->dt)) {
    GrowthAdd(&history->growth, state->time, state->ledger->kinetic);
    PetscCall(HistoryWriteRow(history, state));
    if (history->filters) PetscCall(HistoryWriteAmplitudes(history, state));
    if (history->n_circles) PetscCall(HistoryWriteCircles(history, state));
    if (HistoryHears(history)) PetscCall(HistoryWriteSound(history, state));
    PetscCall(LiveShow(history, state));
  }
  if (ScheduleMeet(&history->pairs, state->time, state->dt)) PetscCall(HistoryRecordPairs(history, state));
  if (ScheduleMeet(&history->frames, state->time, state->dt)) PetscCall(SnapshotWrite(history, state));
  PetscFunctionReturn(0);
}

/* Tables are flushed before their lengths are noted: a restart cuts them there, and checks what is before by its
   sum. */
PetscErrorCode HistoryGetMemory(History h, PetscInt *n, PetscReal **values)
{
  ResultsMark      mark[N_TABLES] = {{0}};
  PetscInt         n_frames = 0, n_sound = 0;
  const PetscReal *times = NULL;
  PetscReal       *sound = NULL;

  PetscFunctionBeginUser;
  PetscCall(HistoryBeginTables(h, mark));
  PetscCall(ResultsTableFlush(h->table, &mark[0]));
  if (h->pair_table) PetscCall(ResultsTableFlush(h->pair_table, &mark[1]));
  if (h->amplitude_table) PetscCall(ResultsTableFlush(h->amplitude_table, &mark[2]));
  if (h->circle_table) PetscCall(ResultsTableFlush(h->circle_table, &mark[3]));
  if (h->sound_table) PetscCall(ResultsTableFlush(h->sound_table, &mark[4]));
  if (h->film) PetscCall(ResultsFilmGetTimes(h->film, &n_frames, &times));
  if (h->listener) PetscCall(SoundListenerGetMemory(h->listener, &n_sound, &sound));
  if (!h->listener && h->n_heard) { /* it goes on, and has no row yet */
    n_sound = h->n_heard;
    PetscCall(PetscMalloc1(n_sound, &sound));
    PetscCall(PetscArraycpy(sound, h->heard, n_sound));
  }
  HistoryKept kept = {.rows     = h->rows,
                      .pairs    = h->pairs,
                      .frames   = h->frames,
                      .growth   = h->growth,
                      .sweeps   = h->sweeps,
                      .steps    = h->steps,
                      .n_frames = (PetscReal)n_frames,
                      .n_sound  = (PetscReal)n_sound};

  for (int i = 0; i < N_TABLES; i++) MarkKeep(&mark[i], kept.mark[i]);
  *n = N_KEPT + n_frames + n_sound;
  PetscCall(PetscMalloc1(*n, values));
  PetscCall(PetscMemcpy(*values, &kept, sizeof(kept)));
  PetscCall(PetscArraycpy(*values + N_KEPT, times, n_frames));
  PetscCall(PetscArraycpy(*values + N_KEPT + n_frames, sound, n_sound));
  PetscCall(PetscFree(sound));
  PetscFunctionReturn(0);
}

/* The length of the growth window is that of this run, which may end later than the one before. */
PetscErrorCode HistorySetMemory(History h, PetscInt n, const PetscReal values[])
{
  HistoryKept kept;
  PetscInt    n_frames, n_sound;

  PetscFunctionBeginUser;
  PetscCheck(n >= N_KEPT, h->comm, PETSC_ERR_ARG_SIZ, "memory of %" PetscInt_FMT " numbers, must be %" PetscInt_FMT, n,
             N_KEPT);
  PetscCall(PetscMemcpy(&kept, values, sizeof(kept)));
  n_frames = (PetscInt)kept.n_frames;
  n_sound  = (PetscInt)kept.n_sound;
  PetscCheck(n == N_KEPT + n_frames + n_sound, h->comm, PETSC_ERR_ARG_SIZ,
             "memory of %" PetscInt_FMT " numbers, must be %" PetscInt_FMT, n, N_KEPT + n_frames + n_sound);
  kept.growth.window = h->growth.window;
  h->growth          = kept.growth;
  h->sweeps          = kept.sweeps;
  h->steps           = kept.steps;
  ScheduleRestore(&h->rows, &kept.rows);
  ScheduleRestore(&h->pairs, &kept.pairs);
  ScheduleRestore(&h->frames, &kept.frames);
  if (h->film) PetscCall(ResultsFilmSetTimes(h->film, n_frames, &values[N_KEPT]));
  if (HistoryHears(h) && n_sound) {
    PetscCall(PetscFree(h->heard));
    h->n_heard = n_sound;
    PetscCall(PetscMalloc1(n_sound, &h->heard));
    PetscCall(PetscArraycpy(h->heard, &values[N_KEPT + n_frames], n_sound));
  }
  PetscCall(HistoryBeginTables(h, (ResultsMark[N_TABLES]){MarkTake(kept.mark[0]), MarkTake(kept.mark[1]),
                                                          MarkTake(kept.mark[2]), MarkTake(kept.mark[3]),
                                                          MarkTake(kept.mark[4])}));
  PetscFunctionReturn(0);
}

PetscErrorCode HistoryAddChecksum(History h, Checksum c)
{
  PetscFunctionBeginUser;
  PetscCall(ChecksumSetPart(c, "probes"));
  for (PetscInt i = 0; i < h->n_probes; i++) {
    PetscCall(ChecksumAddString(c, h->probes[i].name));
    PetscCall(ChecksumAddString(c, h->probes[i].part));
    PetscCall(ChecksumAddReals(c, 3, h->probes[i].x));
  }
  PetscCall(ChecksumSetPart(c, "circles"));
  for (PetscInt i = 0; i < h->n_circles; i++) {
    PetscCall(ChecksumAddString(c, h->circles[i].name));
    PetscCall(ChecksumAddInts(c, 2, (const PetscInt[]){h->circles[i].n, h->circles[i].axis}));
    for (PetscInt k = 0; k < h->circles[i].n; k++) PetscCall(ChecksumAddReals(c, 3, h->circles[i].probe[k].x));
  }
  PetscCall(ChecksumSetPart(c, "-dynamics_filters"));
  if (h->filters) PetscCall(ChecksumAddInts(c, h->filters->n, h->filters->mode));
  PetscCall(SoundAddChecksum(h->sound, c));
  if (HistoryHears(h)) PetscCall(ChecksumSetPart(c, "-dynamics_history_interval"));
  if (HistoryHears(h)) PetscCall(ChecksumAddReals(c, 1, &h->rows.interval));
  PetscFunctionReturn(0);
}

PetscErrorCode HistoryClose(History history)
{
  PetscFunctionBeginUser;
  PetscCall(HistoryBeginTables(history, (ResultsMark[N_TABLES]){{0}}));
  PetscCall(ResultsTableClose(&history->table));
  PetscCall(ResultsTableClose(&history->pair_table));
  PetscCall(ResultsTableClose(&history->amplitude_table));
  PetscCall(ResultsTableClose(&history->circle_table));
  PetscCall(ResultsTableClose(&history->sound_table));
  PetscCall(CirclesWriteNodes(history));
  PetscFunctionReturn(0);
}

PetscErrorCode HistoryDestroy(History *history)
{
  PetscFunctionBeginUser;
  if (!*history) PetscFunctionReturn(0);
  PetscCall(ResultsTableSuspend(&(*history)->table));
  PetscCall(ResultsTableSuspend(&(*history)->pair_table));
  PetscCall(ResultsTableSuspend(&(*history)->amplitude_table));
  PetscCall(ResultsTableSuspend(&(*history)->circle_table));
  PetscCall(ResultsTableSuspend(&(*history)->sound_table));
  PetscCall(SoundListenerDestroy(&(*history)->listener));
  PetscCall(PetscFree((*history)->heard));
  PetscCall(ResultsFilmDestroy(&(*history)->film));
  PetscCall(PetscFree(*history));
  PetscFunctionReturn(0);
}
