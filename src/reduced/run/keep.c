/*
   Checkpoints of a reduced run, with the reduced model and the modes in them: made anew on several ranks they differ by
   rounding, and by their signs.
*/
#include "reduced/reducedimpl.h"
#include "base/events.h"

/* Scalars of a run */
typedef struct {
  PetscReal     step, dt, time, n_its;
  ContactKKT    kkt;
  LedgerAccount ledger;
} ReducedScalars;

typedef enum {
  KEPT_OMEGA2, /* the model */
  KEPT_DAMPING,
  KEPT_SHAPES,
  KEPT_COMPLIANCE,
  KEPT_COUPLING,
  KEPT_VISCOUS,
  KEPT_BRANCHES,
  KEPT_KICKS,
  KEPT_MODES,
  KEPT_SCALARS, /* the state */
  KEPT_COORDINATES,
  KEPT_RATES,
  KEPT_FORCES,
  KEPT_LAST,
  KEPT_BEGIN,
  KEPT_RESIDUAL,
  KEPT_DISPLACEMENTS,
  KEPT_ELONGATIONS,
  KEPT_STATUS,
  KEPT_SLIP,
  KEPT_SHOWN,
  KEPT_SUMS,
  KEPT_LAWS,
  KEPT_HISTORY,
  KEPT_N_ITEMS
} ReducedItem;

PetscErrorCode ReducedAddChecksum(ReducedRun r, Checksum checksum)
{
  PetscFunctionBeginUser;
  PetscCall(DynamicsAddRunChecksum(r->dynamics, checksum));
  PetscCall(ChecksumSetPart(checksum, "-dynamics_cutoff"));
  PetscCall(ChecksumAddReals(checksum, 1, &r->request.cutoff));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReducedSumScene(ReducedRun r)
{
  PetscFunctionBeginUser;
  if (r->scene) PetscFunctionReturn(0);
  PetscCall(ChecksumCreate(r->comm, &r->scene));
  PetscCall(ReducedAddChecksum(r, r->scene));
  PetscFunctionReturn(0);
}

/* The model; modes are the local part of Phi [m][own unknowns] */
static void ReducedListModel(ReducedRun r, PetscInt n_own, PetscScalar modes[], JournalItem item[KEPT_N_ITEMS])
{
  ReducedModel  *model = &r->reduction.model;
  const PetscInt m = model->m, n = 3 * model->n_pairs, N = model->n_ports;

  item[KEPT_OMEGA2]     = (JournalItem){"frequencies", m, model->omega2};
  item[KEPT_DAMPING]    = (JournalItem){"damping", model->C ? m * m : 0, model->C};
  item[KEPT_SHAPES]     = (JournalItem){"shapes", m * N, model->P};
  item[KEPT_COMPLIANCE] = (JournalItem){"compliance", N * (model->sparse ? N - n : N), model->W};
  item[KEPT_COUPLING]   = (JournalItem){"coupling", model->Cm ? m * n : 0, model->Cm};
  item[KEPT_VISCOUS]    = (JournalItem){"damping of the residual", model->Cx ? n * n : 0, model->Cx};
  item[KEPT_BRANCHES]   = (JournalItem){"stiffness of branches", model->n_branches * (m * m + n * m + n * n), model->S};
  item[KEPT_KICKS]      = (JournalItem){"kicks", r->reduction.n_hits * m, r->reduction.hits};
  item[KEPT_MODES]      = (JournalItem){"modes", m * n_own, modes};
}

/* The state */
static void ReducedListItems(ReducedRun r, ReducedScalars *scalars, PetscReal status[], JournalItem item[KEPT_N_ITEMS])
{
  const PetscInt m = r->reduction.model.m, n = r->reduction.model.n_pairs, N = r->reduction.model.n_ports;

  item[KEPT_SCALARS]       = (JournalItem){"scalars", N_REALS(ReducedScalars), (PetscReal *)scalars};
  item[KEPT_COORDINATES]   = (JournalItem){"coordinates", m, r->motion.state.eta};
  item[KEPT_RATES]         = (JournalItem){"rates", m, r->motion.state.rate};
  item[KEPT_FORCES]        = (JournalItem){"forces", N, r->motion.state.p};
  item[KEPT_LAST]          = (JournalItem){"forces before", N, r->motion.state.last};
  item[KEPT_BEGIN]         = (JournalItem){"forces to begin with", 3 * n, r->motion.state.begin};
  item[KEPT_RESIDUAL]      = (JournalItem){"residual", 3 * n, r->motion.state.q};
  item[KEPT_DISPLACEMENTS] = (JournalItem){"displacements", 3 * n, r->motion.state.y};
  item[KEPT_ELONGATIONS] =
    (JournalItem){"branches", ReducedBranches(&r->reduction.model) * (m + 3 * n), r->motion.state.z};
  item[KEPT_STATUS]  = (JournalItem){"status", n, status};
  item[KEPT_SLIP]    = (JournalItem){"slip", 2 * n, r->motion.report.slip};
  item[KEPT_SHOWN]   = (JournalItem){"rates of forces", 2 * N, r->motion.p_rate};
  item[KEPT_SUMS]    = (JournalItem){"sums", r->run.n_interfaces * N_REALS(ContactSums), (PetscReal *)r->motion.sums};
  item[KEPT_LAWS]    = (JournalItem){"contact laws", 0, NULL};
  item[KEPT_HISTORY] = (JournalItem){"history", 0, NULL};
}

/* Collective. The model is the same on all ranks, the modes are each rank's rows. Laws and history keep memories of
   their own, as lists of reals. */
PetscErrorCode ReducedKeep(ReducedRun r)
{
  ReducedScalars scalars = {(PetscReal)r->motion.step, r->motion.dt,  r->motion.state.time,
                            r->result.n_its,           r->result.kkt, r->motion.ledger};
  JournalItem    item[KEPT_N_ITEMS];
  PetscReal     *status;
  PetscScalar   *modes;
  PetscInt       n_own;

  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_CHECKPOINT));
  PetscCall(ReducedSumScene(r));
  PetscCall(PetscMalloc1(r->reduction.model.n_pairs, &status));
  for (PetscInt i = 0; i < r->reduction.model.n_pairs; i++) status[i] = (PetscReal)r->motion.state.status[i];
  PetscCall(MatGetLocalSize(r->reduction.Phi, &n_own, NULL));
  PetscCall(MatDenseGetArray(r->reduction.Phi, &modes));
  ReducedListModel(r, n_own, modes, item);
  ReducedListItems(r, &scalars, status, item);
  PetscCall(ContactComplianceGetMemory(r->motion.stepper->laws, &item[KEPT_LAWS].n, &item[KEPT_LAWS].values));
  PetscCall(HistoryGetMemory(r->run.history, &item[KEPT_HISTORY].n, &item[KEPT_HISTORY].values));
  PetscCall(JournalWrite(&CHECKPOINTS(r), CHECKPOINT_FILE, KEPT_N_ITEMS, item));
  PetscCall(MatDenseRestoreArray(r->reduction.Phi, &modes));
  PetscCall(PetscFree(item[KEPT_HISTORY].values));
  PetscCall(PetscFree(item[KEPT_LAWS].values));
  PetscCall(PetscFree(status));
  PetscCall(EventEnd(EVENT_CHECKPOINT));
  PetscFunctionReturn(0);
}

/* Raises the error for a step or an end that does not fit the checkpoint */
static PetscErrorCode ReducedCheckScalars(ReducedRun r, const ReducedScalars *s)
{
  PetscFunctionBeginUser;
  PetscCheck(r->motion.dt == s->dt, r->comm, PETSC_ERR_USER_INPUT,
             "-ts_dt %.6g is another step than that of the run that -dynamics_restart goes on with, %.6g s",
             (double)r->motion.dt, (double)s->dt);
  PetscCheck(r->run.end > s->time - s->dt, r->comm, PETSC_ERR_USER_INPUT,
             "-ts_max_time %.6g s is before the checkpoint that -dynamics_restart goes on with, at %.6g s, whose rows "
             "would be lost: give a later end, or start anew with another -output_dir",
             (double)r->run.end, (double)s->time);
  PetscFunctionReturn(0);
}

/* The run was set up before, so that all items have the sizes that they were written with; MPhi follows from Phi.
   Faults of any rank are raised on all. */
PetscErrorCode ReducedGoOn(ReducedRun r)
{
  ReducedScalars scalars;
  Fault          fault;
  JournalItem    item[KEPT_N_ITEMS];
  PetscReal     *status;
  PetscScalar   *modes;
  PetscInt       n_own;

  PetscFunctionBeginUser;
  PetscCall(ReducedSumScene(r));
  PetscCall(PetscMalloc1(r->reduction.model.n_pairs, &status));
  PetscCall(MatGetLocalSize(r->reduction.Phi, &n_own, NULL));
  PetscCall(MatDenseGetArray(r->reduction.Phi, &modes));
  ReducedListModel(r, n_own, modes, item);
  ReducedListItems(r, &scalars, status, item);
  item[KEPT_LAWS].n = item[KEPT_HISTORY].n = -1;
  PetscCall(JournalRead(&CHECKPOINTS(r), CHECKPOINT_FILE, KEPT_N_ITEMS, item, &fault));
  PetscCall(FaultsRaise(r->comm, &fault));
  PetscCall(MatDenseRestoreArray(r->reduction.Phi, &modes));
  PetscCall(ReducedWeighModes(r));
  PetscCall(ReducedCheckScalars(r, &scalars));
  for (PetscInt i = 0; i < r->reduction.model.n_pairs; i++) r->motion.state.status[i] = (ContactStatus)status[i];
  PetscCall(PetscFree(status));
  r->motion.step       = (PetscInt)scalars.step;
  r->motion.state.time = scalars.time;
  r->result.n_its      = scalars.n_its;
  r->result.kkt        = scalars.kkt;
  r->motion.ledger     = scalars.ledger;
  PetscCall(ReducedStepperCreate(&r->reduction.model, r->motion.dt, REDUCED_RTOL, &r->motion.stepper));
  PetscCall(ContactComplianceSetMemory(r->motion.stepper->laws, item[KEPT_LAWS].n, item[KEPT_LAWS].values));
  PetscCall(HistorySetMemory(r->run.history, item[KEPT_HISTORY].n, item[KEPT_HISTORY].values));
  PetscCall(PetscFree(item[KEPT_HISTORY].values));
  PetscCall(PetscFree(item[KEPT_LAWS].values));
  PetscFunctionReturn(0);
}
