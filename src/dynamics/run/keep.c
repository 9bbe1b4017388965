/*
   Checkpoints of a run: everything that the next step depends on, so that a run goes on bitwise on the same number of
   ranks.
*/
#include "dynamics/dynamicsimpl.h"
#include "base/events.h"
#include <errno.h>
#include <unistd.h>

/* Scalars of a run */
typedef struct {
  PetscReal     time, dt, dt_old, step;
  LedgerAccount ledger;
} KeptScalars;

/* Vectors first */
typedef enum {
  U,
  V,
  FORCE,
  FORCE_OLD,
  N_VECTORS,
  SCALARS = N_VECTORS,
  KU,
  DAMPING,
  BRANCHES,
  PROJECTOR,
  EXTERNAL,
  HISTORY,
  N_ITEMS
} KeptItem;

/* What a run must share with the one that it goes on with. The end, intervals of what is recorded and tolerances of the
   contact forces may change */
PetscErrorCode DynamicsAddRunChecksum(Dynamics d, Checksum c)
{
  PetscFunctionBeginUser;
  PetscCall(ModelAddChecksum(d->model, PETSC_TRUE, c));
  if (d->contact) PetscCall(ContactAddChecksum(d->contact, c));
  if (d->projector) PetscCall(ContactProjectorAddChecksum(d->projector, c));
  PetscCall(ExternalAddChecksum(d->external, c));
  PetscCall(HistoryAddChecksum(d->history, c));
  if (d->start == START_STATIC) PetscCall(StaticsAddChecksum(d->statics, c));
  PetscCall(ChecksumSetPart(c, "the start"));
  PetscCall(ChecksumAddInts(c, 1, (const PetscInt[]){d->start}));
  PetscCall(ChecksumAddString(c, d->shape));
  if (d->shape[0]) PetscCall(ChecksumAddInts(c, 1, &d->shape_mode));
  if (d->shape[0]) PetscCall(ChecksumAddReals(c, 1, &d->shape_amplitude));
  PetscFunctionReturn(0);
}

/* And what concerns the integrator */
static PetscErrorCode DynamicsAddChecksum(Dynamics d, Checksum c)
{
  PetscFunctionBeginUser;
  PetscCall(DynamicsAddRunChecksum(d, c));
  PetscCall(BodiesAddChecksum(d->bodies, c));
  PetscCall(ChecksumSetPart(c, "-ts_central_b"));
  PetscCall(ChecksumAddReals(c, 1, &d->b));
  PetscCall(ChecksumSetPart(c, "-dynamics_step_fraction"));
  PetscCall(ChecksumAddReals(c, 1, &d->fraction));
  PetscCall(ChecksumSetPart(c, "-dynamics_coriolis, -dynamics_centrifugal"));
  PetscCall(ChecksumAddInts(c, 2, (const PetscInt[]){d->coriolis, d->centrifugal}));
  PetscFunctionReturn(0);
}

/* Makes the checksum of the scene, once */
static PetscErrorCode DynamicsSumScene(Dynamics d)
{
  PetscFunctionBeginUser;
  if (d->scene) PetscFunctionReturn(0);
  PetscCall(ChecksumCreate(d->comm, &d->scene));
  PetscCall(DynamicsAddChecksum(d, d->scene));
  PetscFunctionReturn(0);
}

/* What is kept; contact and history are the caller's. ku is kept, since it is a sum over steps that K u does not
   give bitwise; damping and f_old since the next step needs those of the last. */
static PetscErrorCode DynamicsListItems(Dynamics d, KeptScalars *scalars, PetscScalar *const a[],
                                        JournalItem item[N_ITEMS])
{
  const PetscInt n       = d->layout->n;
  PetscReal     *damping = d->layout->damping, *external, *branches;
  PetscInt       n_external, n_branches;

  PetscFunctionBeginUser;
  PetscCall(ExternalGetMemory(d->external, &n_external, &external));
  PetscCall(BodiesGetMemory(d->bodies, &n_branches, &branches));
  item[SCALARS]   = (JournalItem){"scalars", N_REALS(KeptScalars), (PetscReal *)scalars};
  item[U]         = (JournalItem){"displacements", n, a[U]};
  item[V]         = (JournalItem){"velocities", n, a[V]};
  item[KU]        = (JournalItem){"stiffness forces", n, d->ku};
  item[DAMPING]   = (JournalItem){"damping forces", damping ? n : 0, damping};
  item[BRANCHES]  = (JournalItem){"branches", n_branches, branches};
  item[FORCE]     = (JournalItem){"forces", a[FORCE] ? n : 0, a[FORCE]};
  item[FORCE_OLD] = (JournalItem){"forces before", a[FORCE_OLD] ? n : 0, a[FORCE_OLD]};
  item[PROJECTOR] = (JournalItem){"contact", 0, NULL};
  item[EXTERNAL]  = (JournalItem){"external", n_external, external};
  item[HISTORY]   = (JournalItem){"history", 0, NULL};
  PetscFunctionReturn(0);
}

/* Every velocity is a number: a spoilt state must not replace a good checkpoint. A sum passes NaN on to all ranks,
   where a maximum may lose it. */
static PetscErrorCode DynamicsCheckNumbers(Dynamics d)
{
  PetscReal norm;

  PetscFunctionBeginUser;
  PetscCall(VecNorm(d->v, NORM_1, &norm));
  PetscCheck(!PetscIsInfOrNanReal(norm), d->comm, PETSC_ERR_FP,
             "velocities are no numbers: the checkpoint before is kept");
  PetscFunctionReturn(0);
}

static PetscErrorCode KeptScalarsGet(Dynamics d, KeptScalars *s)
{
  PetscInt step;

  PetscFunctionBeginUser;
  PetscCall(TSGetTime(d->ts, &s->time));
  PetscCall(TSGetTimeStep(d->ts, &s->dt));
  PetscCall(TSCentralGetLastStep(d->ts, &s->dt_old));
  PetscCall(TSGetStepNumber(d->ts, &step));
  s->step   = (PetscReal)step;
  s->ledger = d->ledger;
  PetscFunctionReturn(0);
}

/* Raises an error for a step or an end that the run of the checkpoint cannot go on with */
static PetscErrorCode KeptScalarsCheck(Dynamics d, const KeptScalars *s)
{
  TSExactFinalTimeOption match;
  PetscReal              end, left;
  PetscInt               most;

  PetscFunctionBeginUser;
  PetscCheck(
    d->dt_asked == 0 || d->dt_asked == s->dt || d->dt_asked == s->dt_old, d->comm, PETSC_ERR_USER_INPUT,
    "-ts_dt %.6g is another step than that of the run that -dynamics_restart goes on with, %.6g s: leave it out",
    (double)d->dt_asked, (double)s->dt);
  PetscCall(TSGetExactFinalTime(d->ts, &match));
  PetscCall(TSGetMaxTime(d->ts, &end));
  PetscCall(TSGetMaxSteps(d->ts, &most));
  PetscCheck(end > s->time - s->dt, d->comm, PETSC_ERR_USER_INPUT,
             "-ts_max_time %.6g s is before the checkpoint that -dynamics_restart goes on with, at %.6g s, whose rows "
             "would be lost: give a later end, or start anew with another -output_dir",
             (double)end, (double)s->time);
  PetscCheck((PetscReal)most >= s->step, d->comm, PETSC_ERR_USER_INPUT,
             "-ts_max_steps %" PetscInt_FMT
             " is before the checkpoint that -dynamics_restart goes on with, at step %.0f, "
             "whose rows would be lost: give more, or start anew with another -output_dir",
             most, (double)s->step);
  left = (end - s->time) / s->dt;
  PetscCheck(
    match != TS_EXACTFINALTIME_MATCHSTEP || PetscAbsReal(left - PetscFloorReal(left + 0.5)) < 1e-6, d->comm,
    PETSC_ERR_USER_INPUT,
    "-ts_max_time %.6g is no whole number of steps %.6g s after the checkpoint: leave out -ts_exact_final_time "
    "matchstep",
    (double)end, (double)s->dt);
  PetscFunctionReturn(0);
}

static PetscErrorCode KeptScalarsSet(Dynamics d, const KeptScalars *s)
{
  PetscFunctionBeginUser;
  PetscCall(KeptScalarsCheck(d, s));
  PetscCall(TSSetTime(d->ts, s->time));
  if (d->dt_asked == 0) PetscCall(TSSetTimeStep(d->ts, s->dt));
  PetscCall(TSCentralSetLastStep(d->ts, s->dt_old));
  PetscCall(TSSetStepNumber(d->ts, (PetscInt)s->step));
  d->ledger = s->ledger;
  PetscFunctionReturn(0);
}

/* Arrays of the state vectors, and for b > 1/2 of the forces of the last two steps, else NULL: the next step needs
   those of the last, the work of the integrator in the last one those before. Gets or restores them */
static PetscErrorCode KeptArraysAccess(Dynamics d, PetscBool get, PetscScalar *a[N_VECTORS])
{
  Vec x[N_VECTORS] = {d->u, d->v};

  PetscFunctionBeginUser;
  PetscCall(TSCentralGetForces(d->ts, &x[FORCE], &x[FORCE_OLD]));
  for (int i = 0; i < N_VECTORS; i++) {
    if (get) a[i] = NULL;
    if (i >= FORCE && !x[FORCE_OLD]) continue;
    if (get)
      PetscCall(VecGetArray(x[i], &a[i]));
    else
      PetscCall(VecRestoreArray(x[i], &a[i]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsKeep(Dynamics d)
{
  JournalItem  item[N_ITEMS];
  PetscScalar *arrays[N_VECTORS];
  KeptScalars  scalars;

  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_CHECKPOINT));
  PetscCall(DynamicsCheckNumbers(d));
  PetscCall(DynamicsSumScene(d));
  PetscCall(KeptScalarsGet(d, &scalars));
  PetscCall(KeptArraysAccess(d, PETSC_TRUE, arrays));
  PetscCall(DynamicsListItems(d, &scalars, arrays, item));
  if (d->projector) PetscCall(ContactProjectorGetMemory(d->projector, &item[PROJECTOR].n, &item[PROJECTOR].values));
  PetscCall(HistoryGetMemory(d->history, &item[HISTORY].n, &item[HISTORY].values));
  PetscCall(JournalWrite(&CHECKPOINTS(d), CHECKPOINT_FILE, N_ITEMS, item));
  PetscCall(PetscFree(item[HISTORY].values));
  PetscCall(PetscFree(item[PROJECTOR].values));
  PetscCall(KeptArraysAccess(d, PETSC_FALSE, arrays));
  PetscCall(EventEnd(EVENT_CHECKPOINT));
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsGoOn(Dynamics d)
{
  JournalItem  item[N_ITEMS];
  PetscScalar *arrays[N_VECTORS];
  KeptScalars  scalars;
  Fault        fault;

  PetscFunctionBeginUser;
  PetscCall(DynamicsSumScene(d));
  PetscCall(KeptArraysAccess(d, PETSC_TRUE, arrays));
  PetscCall(DynamicsListItems(d, &scalars, arrays, item));
  item[PROJECTOR].n = item[HISTORY].n = -1;
  PetscCall(JournalRead(&CHECKPOINTS(d), CHECKPOINT_FILE, N_ITEMS, item, &fault));
  PetscCall(FaultsRaise(d->comm, &fault));
  PetscCall(KeptScalarsSet(d, &scalars));
  if (d->projector) PetscCall(ContactProjectorSetMemory(d->projector, item[PROJECTOR].n, item[PROJECTOR].values));
  PetscCall(HistorySetMemory(d->history, item[HISTORY].n, item[HISTORY].values));
  PetscCall(PetscFree(item[HISTORY].values));
  PetscCall(PetscFree(item[PROJECTOR].values));
  PetscCall(KeptArraysAccess(d, PETSC_FALSE, arrays));
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsCheckEarlier(Dynamics d)
{
  char        part[PETSC_MAX_PATH_LEN];
  const char *dir;
  PetscMPIInt rank;
  PetscBool   unfinished = PETSC_FALSE;
  JournalKind kind;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(d->comm, &rank));
  PetscCall(ResultsGetDirectory(d->results, &dir));
  PetscCall(JournalFind(d->comm, d->results, CHECKPOINT_FILE, &kind));
  PetscCheck(kind != JOURNAL_FOREIGN || !d->checkpoint_interval, d->comm, PETSC_ERR_FILE_UNEXPECTED,
             "%s/%s is no checkpoint of squeal, and -dynamics_checkpoint_interval would replace it; choose another "
             "-output_dir",
             dir, CHECKPOINT_FILE);
  PetscCall(PetscSNPrintf(part, sizeof(part), "%s/transient.csv.part", dir));
  if (rank == 0 && !access(part, F_OK)) unfinished = PETSC_TRUE;
  PetscCallMPI(MPI_Bcast(&unfinished, 1, MPIU_BOOL, 0, d->comm));
  PetscCheck(
    kind != JOURNAL_OURS || !unfinished, d->comm, PETSC_ERR_USER_INPUT,
    "%s/%s of an unfinished run would be lost: go on with it by -dynamics_restart, choose another -output_dir, "
    "or delete it",
    dir, CHECKPOINT_FILE);
  PetscCall(ResultsBegin(d->results, PETSC_FALSE));
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsForget(Dynamics d)
{
  char        path[PETSC_MAX_PATH_LEN];
  const char *dir;
  PetscMPIInt rank, error = 0;
  JournalKind kind;

  PetscFunctionBeginUser;
  PetscCall(JournalFind(d->comm, d->results, CHECKPOINT_FILE, &kind));
  if (kind != JOURNAL_OURS) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Comm_rank(d->comm, &rank));
  PetscCall(ResultsGetDirectory(d->results, &dir));
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/%s", dir, CHECKPOINT_FILE));
  if (rank == 0 && unlink(path) && errno != ENOENT) error = errno;
  PetscCallMPI(MPI_Bcast(&error, 1, MPI_INT, 0, d->comm));
  PetscCheck(!error, d->comm, PETSC_ERR_FILE_WRITE,
             "cannot remove %s of the run before: %s; choose another -output_dir", path, strerror(error));
  PetscFunctionReturn(0);
}
