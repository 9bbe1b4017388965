/* Options of what concerns every room, which base/ is told: it stands below the rows */
#include "base/process/memory.h"
#include "base/process/print.h"
#include "base/process/progress.h"
#include "base/settings.h"
#include <squeal/quantity.h>
#include <squeal/sys.h>

typedef struct {
  PetscBool traceback, progress[2], has_progress[2];
  char      log[2][PETSC_MAX_PATH_LEN];
  PetscReal memory; /* MB */
} Settings;

#define SETTINGS_AT(member) QUANTITY_AT(Settings, member)

static const Quantity rows[] = {
  {"-squeal_traceback", "show PETSc's traceback of an error, for developers", NULL, QUANTITY_BOOL,
   SETTINGS_AT(traceback)},
  {"-squeal_log", "file that all that is printed goes to as well, never in place of a file that is no log", NULL,
   QUANTITY_TEXT, SETTINGS_AT(log[0]), .path = "file"},
  {"-log_file", "the same as -squeal_log", NULL, QUANTITY_TEXT, SETTINGS_AT(log[1]), .path = "file"},
  {"-squeal_progress", "show the time left (default: on in a terminal; otherwise one line every 5 s)", NULL,
   QUANTITY_BOOL, SETTINGS_AT(progress[0]), .given = offsetof(Settings, has_progress[0])},
  {"-progress", "the same as -squeal_progress", NULL, QUANTITY_BOOL, SETTINGS_AT(progress[1]),
   .given = offsetof(Settings, has_progress[1])},
  {"-squeal_memory",
   "memory that factors, or models over -cycle_parameter, may take on one machine, of all ranks there (0: what is "
   "free)",
   "MB", QUANTITY_REAL, SETTINGS_AT(memory), QUANTITY_NOT_NEGATIVE, .in = RUN_FACTORS | RUN_CYCLE,
   .unread = ", where no matrix is factorised"},
};
static const QuantityTable settings = {"squeal", "sys.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows, .in = 0};

static PetscErrorCode SettingsRead(MPI_Comm comm, Settings *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(s, 1));
  PetscCall(QuantitiesInit(&settings, s));
  PetscCall(QuantitiesRead(comm, &settings, s));
  PetscFunctionReturn(0);
}

PetscErrorCode SquealSetFromOptions(MPI_Comm comm)
{
  Settings s;

  PetscFunctionBeginUser;
  PetscCall(OptionsCheckNumbers());
  PetscCall(SquealSayEnvironment(comm));
  PetscCall(SettingsRead(comm, &s));
  SquealTrace(s.traceback);
  if (s.log[0][0] || s.log[1][0]) PetscCall(PrintSetLog(comm, s.log[0][0] ? s.log[0] : s.log[1]));
  PetscCall(ProgressShow(comm, s.has_progress[0] || s.has_progress[1], s.progress[s.has_progress[0] ? 0 : 1]));
  PetscCall(MemoryAllow(comm, s.memory));
  PetscFunctionReturn(0);
}

PetscErrorCode SquealVisit(MPI_Comm comm, const QuantityVisitor *visitor)
{
  Settings s;

  PetscFunctionBeginUser;
  PetscCall(SettingsRead(comm, &s));
  PetscCall(QuantitiesVisit(visitor, &settings, NULL, &s, NULL));
  PetscFunctionReturn(0);
}
