/*
   Files of earlier runs in the folder. What is removed is only what their scene.yaml says that squeal wrote: a file
   that somebody else put there may have any name.
*/
#include "resultsimpl.h"
#include "base/file.h"
#include <ctype.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Files that squeal writes and may remove, each with the unfinished one without which it may go; # stands for a row of
   digits */
static const struct {
  const char *name, *unfinished;
} known[] = {
  {"modes.csv", NULL},
  {"filters.h5", NULL},
  {"filters.xmf", NULL},
  {"modes.h5", NULL},
  {"modes.xmf", NULL},
  {"check.h5", NULL},
  {"check.xmf", NULL},
  {"static.csv", NULL},
  {"static.h5", NULL},
  {"static.xmf", NULL},
  {"reactions.csv", NULL},
  {"stages.csv", NULL},
  {"gap.csv", NULL},
  {"wear.csv", NULL},
  {"sweep.csv", NULL},
  {"onsets.csv", NULL},
  {"verify.csv", NULL},
  {"sensitivities.csv", NULL},
  {"modes_causes.csv", NULL},
  {"modes_feed_in.csv", NULL},
  {"modes_effects.csv", NULL},
  {"modes_effects.h5", NULL},
  {"modes_effects.xmf", NULL},
  {"modes_components.csv", NULL},
  {"modes_sensitivities.csv", NULL},
  {"modes_changed.csv", NULL},
  {"modes_couplings.csv", NULL},
  {"robustness.csv", NULL},
  {"parameters.csv", NULL},
  {"samples.csv", NULL},
  {"samples_modes.csv", NULL},
  {"samples_verify.csv", NULL},
  {"conditions.csv", NULL},
  {"conditions_bands.csv", NULL},
  {"conditions_verify.csv", NULL},
  {"probability.csv", NULL},
  {"indices.csv", NULL},
  {"superelement.csv", NULL},
  {"superelement_table.csv", NULL},
  {"superelement_k.bin", NULL},
  {"superelement_m.bin", NULL},
  {"superelement_c.bin", NULL},
  {"superelement_term_#.bin", NULL},
  {"superelement_terms.yaml", NULL},
  {"superelement_pieces.yaml", NULL},
  {"superelement_k.mtx", NULL},
  {"superelement_m.mtx", NULL},
  {"superelement_c.mtx", NULL},
  {"superelement.pch", NULL},
  {"superelement.inp", NULL},
  {"superelement_abaqus_k.mtx", NULL},
  {"superelement_abaqus_m.mtx", NULL},
  {"superelement_abaqus_c.mtx", NULL},
  {"quiet.csv", NULL},
  {"quiet_statement.csv", NULL},
  {"quiet_cells.csv", NULL},
  {"reduced_model.bin", NULL},
  {"reduced_shapes.h5", NULL},
  {"reduced_shapes.xmf", NULL},
  {"design.csv", NULL},
  {"design_corners.csv", NULL},
  {"frf.csv", NULL},
  {"peaks.csv", NULL},
  {"cycle.csv", NULL},
  {"cycle_probes.csv", NULL},
  {"map.csv", NULL},
  {"map_modes.csv", NULL},
  {"map_errors.csv", NULL},
  {"map_disturbed.csv", NULL},
  {"map_basins.csv", NULL},
  {"impulse.csv", NULL},
  {"transient.csv", "transient.csv.part"},
  {"transient.xmf", "transient.csv.part"},
  {"amplitudes.csv", "transient.csv.part"},
  {"circles.csv", "transient.csv.part"},
  {"sound_time.csv", "transient.csv.part"},
  {"sound.csv", NULL},
  {"sound_frf.csv", NULL},
  {"sound_cycle.csv", NULL},
  {"circle_nodes.csv", "transient.csv.part"},
  {"impulses.csv", "transient.csv.part"},
  {"contact_pairs.csv", "transient.csv.part"},
  {"snapshot_#.h5", "transient.csv.part"},
  {"snapshot_#.xmf", "transient.csv.part"},
  {"checkpoint.bin", "transient.csv.part"},
};

/* Whether the name is in a list of n */
static PetscBool NameIsIn(PetscInt n, char *const names[], const char name[])
{
  for (PetscInt i = 0; i < n; i++)
    if (!strcmp(names[i], name)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Adds a name to a list of n, which has room for 16 of them and for any larger power of two */
static PetscErrorCode NameAdd(PetscInt *n, char ***names, const char name[])
{
  PetscFunctionBeginUser;
  if (*n == 0) PetscCall(PetscMalloc1(16, names));
  if (*n >= 16 && !(*n & (*n - 1))) PetscCall(PetscRealloc(2 * (size_t)*n * sizeof(**names), names));
  PetscCall(PetscStrallocpy(name, &(*names)[(*n)++]));
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsKeep(Results results, const char name[])
{
  PetscFunctionBeginUser;
  if (NameIsIn(results->n_kept, results->kept, name)) PetscFunctionReturn(0);
  PetscCall(NameAdd(&results->n_kept, &results->kept, name));
  for (PetscInt i = 0; i < results->n_earlier; i++) {
    if (strcmp(results->earlier[i], name)) continue;
    PetscCall(PetscFree(results->earlier[i]));
    results->earlier[i] = results->earlier[--results->n_earlier];
    break;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsKeepFolder(Results results, const char folder[])
{
  char *const mine = realpath(results->dir, NULL), *const other = realpath(folder, NULL);

  PetscFunctionBeginUser;
  if (mine && other && !strcmp(mine, other)) results->keep_all = PETSC_TRUE;
  free(mine);
  free(other);
  PetscFunctionReturn(0);
}

/* Whether a file of that name may go: squeal writes such ones, and no unfinished run goes on from it */
static PetscBool NameMayGo(Results results, const char name[])
{
  char path[PETSC_MAX_PATH_LEN];

  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(known); i++) {
    const size_t before = strcspn(known[i].name, "#");
    const char  *rest   = name + before;

    if (strncmp(name, known[i].name, before)) continue;
    while (known[i].name[before] && isdigit((unsigned char)*rest)) rest++;
    if (strcmp(rest, known[i].name + before + (known[i].name[before] ? 1 : 0))) continue;
    if (!known[i].unfinished) return PETSC_TRUE;
    if (PetscSNPrintf(path, sizeof(path), "%s/%s", results->dir, known[i].unfinished)) return PETSC_FALSE;
    return access(path, F_OK) ? PETSC_TRUE : PETSC_FALSE;
  }
  return PETSC_FALSE;
}

/* Whether the file of an earlier run, which this one neither wrote nor needs, goes when this one ends */
static PetscBool EarlierGoes(Results results, const char name[])
{
  return results->keep_all ? PETSC_FALSE : NameMayGo(results, name);
}

/* Takes the names off one line of an earlier scene.yaml */
static PetscErrorCode LineRead(Results results, char line[])
{
  char *rest;

  PetscFunctionBeginUser;
  for (char *name = strtok_r(line, " \n", &rest); name; name = strtok_r(NULL, " \n", &rest))
    if (!NameIsIn(results->n_earlier, results->earlier, name) && !NameIsIn(results->n_kept, results->kept, name))
      PetscCall(NameAdd(&results->n_earlier, &results->earlier, name));
  PetscFunctionReturn(0);
}

/* Reads the lines of an earlier scene.yaml; returns errno where something is there that cannot be read */
static PetscErrorCode SceneRead(Results results, const char path[], int *error)
{
  FILE  *file = FileStream(path, "r");
  char  *line = NULL;
  size_t room = 0;

  PetscFunctionBeginUser;
  *error = file || errno == ENOENT ? 0 : errno;
  if (!file) PetscFunctionReturn(0); /* nothing there is known to be squeal's */
  while (getline(&line, &room, file) >= 0) {
    if (!strncmp(line, SCENE_FILES, strlen(SCENE_FILES))) PetscCall(LineRead(results, line + strlen(SCENE_FILES)));
    if (!strncmp(line, SCENE_STAY, strlen(SCENE_STAY))) PetscCall(LineRead(results, line + strlen(SCENE_STAY)));
  }
  free(line);
  (void)fclose(file);
  PetscFunctionReturn(0);
}

/* Whether an earlier run left a finished result; what a killed one left is no reason not to go on with it */
static PetscBool EarlierIsFinished(Results results)
{
  char path[PETSC_MAX_PATH_LEN];

  for (PetscInt i = 0; i < results->n_earlier; i++) {
    if (!NameMayGo(results, results->earlier[i])) continue;
    if (PetscSNPrintf(path, sizeof(path), "%s/%s", results->dir, results->earlier[i])) return PETSC_TRUE;
    if (!access(path, F_OK)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Reads which files earlier runs wrote, from the scene.yaml that is there before this run writes its own. On the first
   rank; the others have none. Collective */
PetscErrorCode EarlierRead(Results results)
{
  char        path[PETSC_MAX_PATH_LEN];
  PetscMPIInt rank;
  int         error = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(results->comm, &rank));
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/" SCENE ".yaml", results->dir));
  if (rank == 0) PetscCall(SceneRead(results, path, &error));
  if (rank == 0) results->has_earlier = access(path, F_OK) ? PETSC_FALSE : PETSC_TRUE;
  if (rank == 0) results->has_finished = EarlierIsFinished(results);
  PetscCallMPI(MPI_Bcast(&results->has_earlier, 1, MPIU_BOOL, 0, results->comm));
  PetscCallMPI(MPI_Bcast(&results->has_finished, 1, MPIU_BOOL, 0, results->comm));
  PetscCallMPI(MPI_Bcast(&error, 1, MPI_INT, 0, results->comm));
  PetscCheck(!error, results->comm, PETSC_ERR_FILE_OPEN,
             "cannot read %s, which names the files of earlier runs: %s; remove it, or choose another -output_dir",
             path, FileReason(error));
  PetscFunctionReturn(0);
}

/* The line of the files that stay, so that a later run knows whose they are */
PetscErrorCode EarlierPrint(Results results, PetscBool ended, OutFile *file)
{
  PetscBool begun = PETSC_FALSE;
  char      path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < results->n_earlier; i++) {
    PetscCall(PetscSNPrintf(path, sizeof(path), "%s/%s", results->dir, results->earlier[i]));
    if ((ended && EarlierGoes(results, results->earlier[i])) || access(path, F_OK)) continue;
    PetscCall(OutFilePrint(file, "%s %s", begun ? "" : SCENE_STAY, results->earlier[i]));
    begun = PETSC_TRUE;
  }
  if (begun) PetscCall(OutFilePrint(file, "\n"));
  PetscFunctionReturn(0);
}

/* Removes the files of earlier runs, and what a killed one left of them under their temporary names */
PetscErrorCode EarlierRemove(Results results)
{
  char path[PETSC_MAX_PATH_LEN], part[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < results->n_earlier; i++) {
    if (!EarlierGoes(results, results->earlier[i])) continue;
    PetscCall(PetscSNPrintf(path, sizeof(path), "%s/%s", results->dir, results->earlier[i]));
    PetscCall(PetscSNPrintf(part, sizeof(part), "%s.part", path));
    (void)unlink(path); /* it may be gone */
    (void)unlink(part);
  }
  PetscFunctionReturn(0);
}
