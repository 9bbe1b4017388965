/*
   Provenance: scene.yaml, which tells where the files of a folder come from and can be run again. It names each of them
   before it has its final name, and is written anew at the end: what a run that is stopped, or finds no room, leaves is
   known to be its.
*/
#include "resultsimpl.h"
#include "base/process/interrupt.h"
#include <squeal/options.h>
#include <squeal/sys.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <time.h>

/* Options that say where something goes or how the run began, not what is computed */
static const char *const not_of_scene[] = {"options_file", "output_dir", "squeal_log",
                                           "log_file",     "help",       "dynamics_restart"};

PetscErrorCode ResultsKeepScene(Results results, QuantityShow show, void *ctx)
{
  PetscFunctionBeginUser;
  results->begun = MPI_Wtime();
  PetscCall((*show)(ctx, &(QuantityVisitor){QuantitiesAddTexts, &results->options}));
  PetscFunctionReturn(0);
}

/* Option of squeal of that name, or NULL */
static const QuantityText *OptionFind(const QuantityTexts *list, const char name[])
{
  for (PetscInt i = 0; i < list->n; i++)
    if (!strcasecmp(list->text[i].name, name)) return &list->text[i];
  return NULL;
}

/* Whether the option is one of those that a scene does not hold */
static PetscBool OptionIsOfRun(const char name[])
{
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(not_of_scene); i++)
    if (!strcasecmp(name, not_of_scene[i])) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* A word of a command line, as a shell reads it */
static PetscErrorCode ScenePrintWord(OutFile *file, const char word[])
{
  const PetscBool plain = word[0] && !strpbrk(word, " \t\n'\"\\$*?;&|<>(){}[]#~`!") ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  if (plain) {
    PetscCall(OutFilePrint(file, "%s", word));
    PetscFunctionReturn(0);
  }
  PetscCall(OutFilePrint(file, "'"));
  for (const char *c = word; *c; c++) {
    if (*c == '\'')
      PetscCall(OutFilePrint(file, "'\\''"));
    else
      PetscCall(OutFilePrint(file, "%c", *c));
  }
  PetscCall(OutFilePrint(file, "'"));
  PetscFunctionReturn(0);
}

/* One key of the scene, the value in double quotes */
static PetscErrorCode ScenePrintKey(OutFile *file, const char name[], const char value[])
{
  PetscFunctionBeginUser;
  PetscCall(OutFilePrint(file, "%s: \"", name));
  for (const char *c = value; *c; c++) PetscCall(OutFilePrint(file, *c == '"' || *c == '\\' ? "\\%c" : "%c", *c));
  PetscCall(OutFilePrint(file, "\"\n"));
  PetscFunctionReturn(0);
}

/* One option: as a key, or as a bare word */
static PetscErrorCode ScenePrintOption(Results results, OutFile *file, PetscBool keys, const char name[],
                                       const char value[])
{
  const QuantityText *own = OptionFind(&results->options, name);

  PetscFunctionBeginUser;
  if (keys && (value[0] || own))
    PetscCall(ScenePrintKey(file, name, value[0] ? value : own && own->shows ? "ascii" : "true"));
  if (!keys && !value[0] && !own) PetscCall(OutFilePrint(file, " -%s", name));
  PetscFunctionReturn(0);
}

/* The options that are given: as keys, or on the command line what PETSc knows as bare words */
static PetscErrorCode ScenePrintGiven(Results results, OutFile *file, PetscBool keys)
{
  char       *all, *rest;
  char        name[QUANTITY_SHOWN];
  const char *value;
  PetscBool   more = PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetAll(NULL, &all));
  for (rest = all; more;) {
    PetscCall(OptionsNextGiven(&rest, sizeof(name), name, &value, &more));
    if (!more || OptionIsOfRun(name)) continue;
    PetscCall(ScenePrintOption(results, file, keys, name, value));
  }
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

/* Defaults, as comments */
static PetscErrorCode ScenePrintDefaults(const QuantityTexts *list, OutFile *file)
{
  PetscBool given;
  char      dashed[QUANTITY_SHOWN + 1];

  PetscFunctionBeginUser;
  PetscCall(OutFilePrint(file, "\n# At their defaults:\n"));
  for (PetscInt i = 0; i < list->n; i++) {
    if (!list->text[i].value[0] || OptionIsOfRun(list->text[i].name)) continue;
    PetscCall(PetscSNPrintf(dashed, sizeof(dashed), "-%s", list->text[i].name));
    PetscCall(PetscOptionsHasName(NULL, NULL, dashed, &given));
    if (!given) PetscCall(OutFilePrint(file, "# %s: %s\n", list->text[i].name, list->text[i].value));
  }
  PetscFunctionReturn(0);
}

/* The command line of this run */
static PetscErrorCode ScenePrintCommand(OutFile *file, PetscMPIInt size)
{
  char **arguments, folder[PETSC_MAX_PATH_LEN];
  int    n;

  PetscFunctionBeginUser;
  PetscCall(PetscGetArgs(&n, &arguments));
  PetscCall(PetscGetWorkingDirectory(folder, sizeof(folder)));
  PetscCall(OutFilePrint(file, "# command: "));
  if (size > 1) PetscCall(OutFilePrint(file, "mpirun -n %d ", size));
  for (int i = 0; i < n; i++) {
    if (i) PetscCall(OutFilePrint(file, " "));
    PetscCall(ScenePrintWord(file, arguments[i]));
  }
  PetscCall(OutFilePrint(file, "\n# in: %s\n", folder));
  PetscFunctionReturn(0);
}

/* Seconds since the start, and the sum of all ranks' largest memory, MB */
static PetscErrorCode SceneGetCost(Results results, double *seconds, double *megabytes)
{
  PetscFunctionBeginUser;
  *seconds = MPI_Wtime() - results->begun;
  PetscCall(SquealGetPeak(results->comm, megabytes));
  PetscFunctionReturn(0);
}

/* What the stages took, and what the rooms said */
static PetscErrorCode ScenePrintNotes(Results results, OutFile *file)
{
  SquealStageCost cost[SQUEAL_N_STAGES];
  PetscInt        n;

  PetscFunctionBeginUser;
  PetscCall(SquealGetStages(results->comm, &n, cost));
  for (PetscInt s = 0; s < n; s++)
    PetscCall(OutFilePrint(file, "%s%s %.2f s %.0f MB", s ? ", " : "# stages: ", cost[s].name, cost[s].seconds,
                           cost[s].megabytes));
  if (n) PetscCall(OutFilePrint(file, "\n"));
  for (PetscInt i = 0; i < results->n_notes; i++) PetscCall(OutFilePrint(file, "%s\n", results->note[i]));
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsNote(Results results, const char key[], const char format[], ...)
{
  char    text[4096], line[4200];
  va_list values;

  PetscFunctionBeginUser;
  va_start(values, format);
  (void)vsnprintf(text, sizeof(text), format, values);
  va_end(values);
  PetscCall(PetscSNPrintf(line, sizeof(line), "# %s: %s", key, text));
  PetscCall(PetscRealloc((size_t)(results->n_notes + 1) * sizeof(char *), &results->note));
  PetscCall(PetscStrallocpy(line, &results->note[results->n_notes++]));
  PetscFunctionReturn(0);
}

/* The command that repeats the run, and the one that was given */
static PetscErrorCode ScenePrintCommands(Results results, OutFile *file)
{
  PetscMPIInt size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(results->comm, &size));
  PetscCall(
    OutFilePrint(file, "# Where the files of this folder come from, and all options in force. To repeat the run:\n"));
  PetscCall(OutFilePrint(file, "# repeat: "));
  if (size > 1) PetscCall(OutFilePrint(file, "mpirun -n %d ", size));
  PetscCall(OutFilePrint(file, "squeal -options_file "));
  PetscCall(ScenePrintWord(file, file->name));
  PetscCall(OutFilePrint(file, " -output_dir "));
  PetscCall(ScenePrintWord(file, results->dir));
  PetscCall(ScenePrintGiven(results, file, PETSC_FALSE));
  PetscCall(OutFilePrint(file, "\n"));
  PetscCall(ScenePrintCommand(file, size));
  PetscFunctionReturn(0);
}

/* Versions of the libraries, ranks, time and memory, the end, where the run has done what was asked */
static PetscErrorCode ScenePrintCost(Results results, PetscBool ended, OutFile *file)
{
  const time_t   now = time(NULL);
  SquealVersions v;
  PetscMPIInt    size;
  double         seconds, megabytes;
  char           date[64] = "not yet; the run goes on, was stopped, or failed";

  PetscFunctionBeginUser;
  SquealGetVersions(&v);
  PetscCallMPI(MPI_Comm_size(results->comm, &size));
  PetscCall(SceneGetCost(results, &seconds, &megabytes));
  if (ended) (void)strftime(date, sizeof(date), "%Y-%m-%dT%H:%M:%SZ", gmtime(&now));
  PetscCall(OutFilePrint(file, "# versions: squeal %s, PETSc %s, SLEPc %s, MUMPS %s, %s, %s\n", v.squeal, v.petsc,
                         v.slepc, v.mumps, v.blas, v.mpi));
  PetscCall(OutFilePrint(file, "# cost: %d rank%s, %.1f s, %.0f MB at most\n# end: %s\n", size, size == 1 ? "" : "s",
                         seconds, megabytes, date));
  PetscFunctionReturn(0);
}

static PetscErrorCode SceneWrite(Results results, PetscBool ended)
{
  OutFile opened, *file = &opened;

  PetscFunctionBeginUser;
  PetscCall(OutFileSetName(results, SCENE, ".yaml", file));
  PetscCall(OutFileOpenText(file));
  PetscCall(ScenePrintCommands(results, file));
  PetscCall(ScenePrintCost(results, ended, file));
  PetscCall(ScenePrintNotes(results, file));
  PetscCall(OutFilePrint(file, SCENE_FILES));
  for (PetscInt i = 0; i < results->n_kept; i++) PetscCall(OutFilePrint(file, " %s", results->kept[i]));
  results->n_listed = results->n_kept;
  PetscCall(OutFilePrint(file, "\n"));
  PetscCall(EarlierPrint(results, ended, file));
  PetscCall(OutFilePrint(file, "\n"));
  PetscCall(ScenePrintGiven(results, file, PETSC_TRUE));
  PetscCall(ScenePrintDefaults(&results->options, file));
  PetscCall(OutFilesPublish(1, &file));
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsListFiles(Results results)
{
  PetscFunctionBeginUser;
  if (!results->options.n) PetscFunctionReturn(0); /* no run without ResultsKeepScene() */
  if (results->n_listed && results->n_listed == results->n_kept)
    PetscFunctionReturn(0); /* also scene.yaml itself, published as others are */
  PetscCall(SceneWrite(results, PETSC_FALSE));
  if (results->n_kept > 1) InterruptSays("files that bear their final name are complete");
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsBegin(Results results, PetscBool replace)
{
  PetscFunctionBeginUser;
  if (results->n_listed || (results->has_earlier && !replace)) PetscFunctionReturn(0);
  PetscCall(ResultsListFiles(results));
  if (results->n_listed) InterruptSays("nothing was finished; scene.yaml repeats the run");
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsFinish(Results results)
{
  PetscFunctionBeginUser;
  PetscCall(SceneWrite(results, PETSC_TRUE));
  PetscCall(EarlierRemove(results));
  PetscCallMPI(MPI_Barrier(results->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsForget(Results results)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < results->n_kept; i++) PetscCall(PetscFree(results->kept[i]));
  PetscCall(PetscFree(results->kept));
  for (PetscInt i = 0; i < results->n_notes; i++) PetscCall(PetscFree(results->note[i]));
  PetscCall(PetscFree(results->note));
  for (PetscInt i = 0; i < results->n_earlier; i++) PetscCall(PetscFree(results->earlier[i]));
  PetscCall(PetscFree(results->earlier));
  PetscCall(PetscFree(results->options.text));
  PetscFunctionReturn(0);
}
