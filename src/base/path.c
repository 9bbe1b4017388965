/*
   Paths that options name: one in an options file is relative to the folder of that file, one on the command line to
   the working folder.
*/
#include "path.h"
#include <squeal/options.h>
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

/* Whether the options file gives the option this value */
static PetscErrorCode FileGives(MPI_Comm comm, const char file[], const char name[], const char value[],
                                PetscBool *gives)
{
  PetscOptions options;
  char         text[PETSC_MAX_PATH_LEN];
  PetscBool    set;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsCreate(&options));
  PetscCall(PetscOptionsInsertFile(comm, options, file, PETSC_TRUE));
  PetscCall(PetscOptionsGetString(options, NULL, name, text, sizeof(text), &set));
  PetscCall(PetscOptionsDestroy(&options));
  *gives = set && !strcmp(text, value) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Puts the folder of the last options file that gives the value before it, where that names something */
static PetscErrorCode PathResolve(MPI_Comm comm, const char name[], char path[], size_t size)
{
  char      beside[PETSC_MAX_PATH_LEN];
  char    **word;
  int       n;
  PetscBool gives;

  PetscFunctionBeginUser;
  PetscCall(PetscGetArgs(&n, &word));
  for (int i = n - 2; i > 0; i--) {
    const char *slash = strrchr(word[i + 1], '/');

    if (strncasecmp(word[i], "-options_file", 13) || !slash) continue;
    PetscCall(FileGives(comm, word[i + 1], name, path, &gives));
    if (!gives) continue;
    PetscCall(PetscSNPrintf(beside, sizeof(beside), "%.*s/%s", (int)(slash - word[i + 1]), word[i + 1], path));
    if (!access(beside, F_OK)) PetscCall(PetscStrncpy(path, beside, size));
    break;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsGetPath(MPI_Comm comm, const char option[], char path[], PetscBool *set)
{
  PetscBool   given, on_command_line;
  PetscMPIInt rank;
  char       *whole;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetString(NULL, NULL, option, path, PETSC_MAX_PATH_LEN, &given));
  if (set) *set = given;
  if (!given || !path[0]) PetscFunctionReturn(0);
  PetscCall(OptionsCommandGives(option + 1, &on_command_line));
  if (path[0] != '/' && !on_command_line) PetscCall(PathResolve(comm, option, path, PETSC_MAX_PATH_LEN));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Bcast(path, PETSC_MAX_PATH_LEN, MPI_CHAR, 0, comm)); /* one rank decides what is there */
  whole = realpath(path, NULL);
  if (whole) PetscCall(PetscOptionsSetValue(NULL, option, whole)); /* for scene.yaml, which lies elsewhere */
  if (whole) PetscCall(PetscOptionsHasName(NULL, NULL, option, &given));
  free(whole);
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsFilesGive(MPI_Comm comm, const char option[], PetscBool *give)
{
  PetscOptions options;
  char       **word;
  int          n;

  PetscFunctionBeginUser;
  PetscCall(PetscGetArgs(&n, &word));
  PetscCall(PetscOptionsCreate(&options));
  for (int i = 1; i + 1 < n; i++)
    if (!strncasecmp(word[i], "-options_file", 13))
      PetscCall(PetscOptionsInsertFile(comm, options, word[i + 1], PETSC_TRUE));
  PetscCall(PetscOptionsHasName(options, NULL, option, give));
  PetscCall(PetscOptionsDestroy(&options));
  PetscFunctionReturn(0);
}

int PathMakeFolders(const char dir[])
{
  char        path[PETSC_MAX_PATH_LEN];
  struct stat status;

  if (snprintf(path, sizeof(path), "%s", dir) >= (int)sizeof(path)) return ENAMETOOLONG;
  for (char *end = path + 1; *end; end++) {
    if (*end != '/') continue;
    *end = '\0';
    if (mkdir(path, 0777) && errno != EEXIST) return errno;
    *end = '/';
  }
  if (mkdir(path, 0777) && errno != EEXIST) return errno;
  if (stat(path, &status)) return errno;
  if (!S_ISDIR(status.st_mode)) return ENOTDIR;
  return access(path, W_OK | X_OK) ? errno : 0;
}

void PathForget(const char dir[], const char begin[])
{
  DIR *folder = opendir(dir);
  char name[PETSC_MAX_PATH_LEN];

  for (const struct dirent *file; folder && (file = readdir(folder));) {
    if (strncmp(file->d_name, begin, strlen(begin)) != 0) continue;
    (void)snprintf(name, sizeof(name), "%s/%s", dir, file->d_name);
    (void)unlink(name);
  }
  if (folder) (void)closedir(folder);
}
