/*
   Life cycle: start, one-line errors, log stages, end.

   The message of an error is kept until its rank leaves. When all ranks come, it was everybody's error: rank 0 prints
   it, and all leave through MPI_Finalize. When some do not come within two seconds, it was this rank's own error: it
   prints, and aborts the others, which know nothing of it.
*/
#include <squeal/sys.h>
#include <squeal/options.h>
#include "base/algebra/blas.h"
#include "events.h"
#include "base/settings.h"
#include "base/options/help.h"
#include "base/process/interrupt.h"
#include "base/process/print.h"
#include "base/process/memory.h"
#include "base/process/progress.h"
#include "base/process/watch.h"
#include "base/text.h"
#include <slepcsys.h>
#include <hdf5.h>
#include <petsctime.h>
#include <signal.h>
#include <stdlib.h>

#define MAX_MESSAGE 1024

static const char *const stage_names[SQUEAL_N_STAGES] = {"Model", "Contact", "Operators", "Statics", "Modes",
                                                         "Sweep", "Frf",     "Dynamics",  "Results"};
/* First error of this rank, printed by SquealFinalize() */
static char error_message[MAX_MESSAGE];

static PetscLogStage stages[SQUEAL_N_STAGES];

static const struct {
  const char *name;
  SquealStage room;
} events[N_EVENTS] = {
  [EVENT_PAIR]           = {"ContactPair", SQUEAL_CONTACT},
  [EVENT_SEARCH]         = {"ContactSearch", SQUEAL_CONTACT},
  [EVENT_ASSEMBLE]       = {"Assemble", SQUEAL_OPERATORS},
  [EVENT_STATICS]        = {"StaticsSolve", SQUEAL_STATICS},
  [EVENT_FACTOR]         = {"ShiftInvFactor", SQUEAL_MODES},
  [EVENT_SOLVE]          = {"ShiftInvSolve", SQUEAL_MODES},
  [EVENT_COLUMN]         = {"ShiftInvColumn", SQUEAL_MODES},
  [EVENT_LABEL]          = {"ModesLabel", SQUEAL_MODES},
  [EVENT_CAUSES]         = {"ModesCauses", SQUEAL_MODES},
  [EVENT_COMPONENTS]     = {"ModesComponents", SQUEAL_MODES},
  [EVENT_EFFECTS]        = {"ModesEffects", SQUEAL_MODES},
  [EVENT_CORRECT]        = {"BasisCorrect", SQUEAL_SWEEP},
  [EVENT_ORTHOGONALISE]  = {"BasisOrthonorm", SQUEAL_SWEEP},
  [EVENT_REDUCED]        = {"ReducedEigen", SQUEAL_SWEEP},
  [EVENT_FOLLOW]         = {"ReducedFollow", SQUEAL_SWEEP},
  [EVENT_TRACK]          = {"TrackLine", SQUEAL_SWEEP},
  [EVENT_BODIES_ADVANCE] = {"BodiesAdvance", SQUEAL_DYNAMICS},
  [EVENT_EXCHANGE]       = {"BodiesExchange", SQUEAL_DYNAMICS},
  [EVENT_EXTERNAL]       = {"External", SQUEAL_DYNAMICS},
  [EVENT_PROJECT]        = {"ContactProject", SQUEAL_CONTACT},
  [EVENT_MOVE]           = {"KickAndDrift", SQUEAL_DYNAMICS},
  [EVENT_RECORD]         = {"HistoryRecord", SQUEAL_RESULTS},
  [EVENT_CHECKPOINT]     = {"Checkpoint", SQUEAL_RESULTS},
};

PetscLogEvent squeal_events[N_EVENTS];

/* Log handles of the stages: seconds spent and resident memory (bytes) at the end of each, on this rank */
static struct {
  PetscLogDouble begun, seconds, memory;
} ledger[SQUEAL_N_STAGES];

static const char citation[] = "@inproceedings{massi2005,\n  author = {Massi, F. and Baillet, L.},\n  title = "
                               "{Numerical analysis of squeal instability},\n  year = {2005}\n}\n";
static PetscBool  cited      = PETSC_FALSE;
static PetscBool  traced     = PETSC_FALSE; /* -squeal_traceback */

/* Whether no more memory is to be had. MUMPS says so by -13 and -7, which PETSc passes on as an error of a library
   where it solves; 3.18 has another code than PETSC_ERR_MEM for its own */
static PetscBool IsOfMemory(PetscErrorCode code, const char function[], const char message[])
{
  if (strstr(message, "max number of options")) return PETSC_FALSE;
  if (code == PETSC_ERR_MEM) return PETSC_TRUE;
  if (function && (strstr(function, "PetscMalloc") || strstr(function, "PetscRealloc"))) return PETSC_TRUE;
  if (!strstr(message, "MUMPS")) return PETSC_FALSE;
  return strstr(message, "INFOG(1)=-13") || strstr(message, "INFOG(1)=-7") ? PETSC_TRUE : PETSC_FALSE;
}

/* Keeps the first line of the first message; the codes of the callers above add nothing for a user. The traceback is
   that of PETSC_COMM_SELF, since PETSc aborts the higher ranks of another communicator. */
static PetscErrorCode KeepError(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code,
                                PetscErrorType type, const char *message, void *ctx)
{
  char *const kept = ctx;
  const char *text = message;
  char        better[MAX_MESSAGE];

  (void)comm;
  if (traced) (void)PetscTraceBackErrorHandler(PETSC_COMM_SELF, line, function, file, code, type, message, NULL);
  if (type != PETSC_ERROR_INITIAL || kept[0]) return code;
  if (!text || !text[0]) (void)PetscErrorMessage(code, &text, NULL);
  (void)snprintf(kept, MAX_MESSAGE, "%.*s", text ? (int)strcspn(text, "\n") : 13, text ? text : "unknown error");
  if (IsOfMemory(code, function, kept)) MemoryExplain(kept, MAX_MESSAGE);
  if (!OptionsExplainValue(kept, better, sizeof(better)) && better[0]) (void)snprintf(kept, MAX_MESSAGE, "%s", better);
  return code;
}

PetscErrorCode SquealInitialize(int *argc, char ***argv, const char help[])
{
  PetscClassId class[SQUEAL_N_STAGES];

  PetscFunctionBeginUser;
  (void)signal(SIGXFSZ, SIG_IGN); /* a file beyond `ulimit -f` is an error of the write, as a full disk is */
  WatchBegin();
  PetscCallMPI(MPI_Init(argc, argv));
  if (!help && HelpAnswer(*argc, *argv)) exit(MPI_Finalize());
  if (!help) HelpRename(*argc, *argv);
  (void)H5dont_atexit(); /* all files are closed by then, but for one that cannot be written, which would crash it */
  (void)H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  PetscCall(PetscPushErrorHandler(KeepError, error_message));
  PetscErrorHandlingInitialized = PETSC_TRUE; /* as PetscInitialize() begins: errors are kept from now on */
  PetscCall(OptionsCheckArguments(*argc, *argv));
  PetscCall(OptionsMoveFiles(*argc, *argv));
  PetscCall(SlepcInitialize(argc, argv, NULL, help));
  PetscCall(MemoryPrepare(PETSC_COMM_WORLD));
  PrintInstall();
  PetscCall(InterruptInstall(PETSC_COMM_WORLD));
  (void)signal(SIGPIPE, SIG_IGN); /* `squeal ... | head` writes its files all the same: print.c */
  for (PetscInt s = 0; s < SQUEAL_N_STAGES; s++) {
    PetscCall(PetscLogStageRegister(stage_names[s], &stages[s]));
    PetscCall(PetscClassIdRegister(stage_names[s], &class[s]));
  }
  for (PetscInt e = 0; e < N_EVENTS; e++)
    PetscCall(PetscLogEventRegister(events[e].name, class[events[e].room], &squeal_events[e]));
  PetscCall(PetscCitationsRegister(citation, &cited));
  PetscFunctionReturn(0);
}

PetscErrorCode SquealSayEnvironment(MPI_Comm comm)
{
  static const char *const variables[]                 = {"PETSC_OPTIONS", "PETSC_OPTIONS_YAML"};
  char                     file[3][PETSC_MAX_PATH_LEN] = {"", ".petscrc", "petscrc"};
  PetscBool                skip                        = PETSC_FALSE, there;

  PetscFunctionBeginUser;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(variables); i++) {
    const char *const text = getenv(variables[i]);

    if (text && text[0])
      PetscCall(PetscFPrintf(comm, stderr, "squeal: warning: the environment's %s gives options to this run: %s\n",
                             variables[i], text));
  }
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-skip_petscrc", &skip, NULL));
  PetscCall(PetscGetHomeDirectory(file[0], sizeof(file[0]) - 16));
  PetscCall(TextAdd(file[0], "/.petscrc", sizeof(file[0])));
  for (int i = 0; i < 3 && !skip; i++) {
    PetscCall(PetscTestFile(file[i], 'r', &there));
    if (there)
      PetscCall(PetscFPrintf(
        comm, stderr, "squeal: warning: %s gives options to this run; -skip_petscrc true leaves it out\n", file[i]));
  }
  PetscFunctionReturn(0);
}

void SquealTrace(PetscBool trace)
{
  traced = trace;
}

PetscErrorCode SquealStageBegin(SquealStage stage)
{
  PetscFunctionBeginUser;
  PetscCall(PetscLogStagePush(stages[stage]));
  PetscCall(PetscTime(&ledger[stage].begun));
  PetscCall(ProgressStage(stage_names[stage]));
  PetscFunctionReturn(0);
}

PetscErrorCode SquealStageEnd(SquealStage stage)
{
  PetscLogDouble now;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&now));
  ledger[stage].seconds += now - ledger[stage].begun;
  PetscCall(PetscMemoryGetCurrentUsage(&ledger[stage].memory));
  PetscCall(PetscLogStagePop());
  PetscFunctionReturn(0);
}

PetscErrorCode SquealGetStages(MPI_Comm comm, PetscInt *n, SquealStageCost cost[])
{
  PetscFunctionBeginUser;
  *n = 0;
  for (PetscInt s = 0; s < SQUEAL_N_STAGES; s++) {
    SquealStageCost *c = &cost[*n];

    if (ledger[s].begun == 0) continue; /* never entered */
    c->name = stage_names[s];
    PetscCallMPI(MPI_Allreduce(&ledger[s].seconds, &c->seconds, 1, MPI_DOUBLE, MPI_MAX, comm));
    PetscCallMPI(MPI_Allreduce(&ledger[s].memory, &c->megabytes, 1, MPI_DOUBLE, MPI_SUM, comm));
    c->megabytes *= 1e-6;
    ++*n;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SquealGetPeak(MPI_Comm comm, double *megabytes)
{
  PetscFunctionBeginUser;
  *megabytes = 1e-6 * MemoryPeak();
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, megabytes, 1, MPI_DOUBLE, MPI_SUM, comm));
  PetscFunctionReturn(0);
}

/* Where the BLAS is slow by choice of its own */
static PetscErrorCode ViewKernels(PetscViewer viewer)
{
  const char *better = BlasBetterKernels();
  char        name[64];

  PetscFunctionBeginUser;
  if (!better) PetscFunctionReturn(0);
  BlasGetName(sizeof(name), name);
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "%s does not know this processor and runs old kernels; OPENBLAS_CORETYPE=%s in the "
                                   "environment makes factorisations two to three times as fast\n",
                                   name, better));
  PetscFunctionReturn(0);
}

PetscErrorCode SquealViewStages(MPI_Comm comm, PetscViewer viewer)
{
  SquealStageCost cost[SQUEAL_N_STAGES];
  PetscInt        n;
  double          peak;

  PetscFunctionBeginUser;
  PetscCall(SquealGetStages(comm, &n, cost));
  PetscCall(PetscViewerASCIIPrintf(viewer, "stage       time s   memory MB\n"));
  for (PetscInt s = 0; s < n; s++)
    PetscCall(
      PetscViewerASCIIPrintf(viewer, "%-10s %7.2f   %9.0f\n", cost[s].name, cost[s].seconds, cost[s].megabytes));
  PetscCall(SquealGetPeak(comm, &peak));
  PetscCall(PetscViewerASCIIPrintf(viewer, "the most at any time %10.0f\n", peak));
  PetscCall(ViewKernels(viewer));
  PetscFunctionReturn(0);
}

/* Waits up to two seconds for all ranks; false when some do not come */
static PetscBool AllRanksArrive(void)
{
  MPI_Request request;
  int         done = 0;

  if (MPI_Ibarrier(MPI_COMM_WORLD, &request)) return PETSC_FALSE;
  for (int i = 0; i < 200 && !done; i++) {
    (void)MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (!done) (void)PetscSleep(0.01);
  }
  return done ? PETSC_TRUE : PETSC_FALSE;
}

int SquealFinalize(PetscErrorCode error)
{
  if (error) {
    const PetscBool together = AllRanksArrive();
    int             rank;

    (void)MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    InterruptRemove();
    if (!together || rank == 0) PrintError(error_message);
    if (!together) (void)MPI_Abort(MPI_COMM_WORLD, 1);
    (void)PrintEnd();
    (void)PetscInfoAllow(PETSC_FALSE); /* MPI frees PETSc's communicators, which would tell -info so through them */
    (void)MPI_Finalize();
    return 1;
  }
  if (SlepcFinalize()) (void)MPI_Abort(MPI_COMM_WORLD, 1);
  if (!PrintEnd()) fprintf(stderr, "squeal: warning: the log -squeal_log is not complete, the disk may be full\n");
  (void)MPI_Finalize();
  return 0;
}
