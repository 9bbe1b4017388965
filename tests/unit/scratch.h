/* Scratch folder of a unit test, the last error message, and a limit of the size of files that plays a full disk */
#pragma once

#include <petscsys.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h>

typedef struct {
  char           dir[PETSC_MAX_PATH_LEN], message[2 * PETSC_MAX_PATH_LEN];
  PetscErrorCode code; /* of the last error */
  PetscMPIInt    rank;
} Scratch;

/* Error handler that keeps the message */
static inline PetscErrorCode ScratchKeepError(MPI_Comm comm, int line, const char *function, const char *file,
                                              PetscErrorCode code, PetscErrorType type, const char *message, void *ctx)
{
  Scratch *s = ctx;

  (void)comm, (void)line, (void)function, (void)file;
  if (type != PETSC_ERROR_INITIAL) return code;
  s->code = code;
  snprintf(s->message, sizeof(s->message), "%s", message ? message : "");
  return code;
}

/* Makes a folder for one test, its name the same on all ranks */
static inline PetscErrorCode ScratchMakeFolder(char dir[PETSC_MAX_PATH_LEN])
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCall(PetscGetTmp(PETSC_COMM_WORLD, dir, PETSC_MAX_PATH_LEN - 32));
  PetscCall(PetscStrlcat(dir, "/squealXXXXXX", PETSC_MAX_PATH_LEN));
  if (rank == 0 && !mkdtemp(dir)) dir[0] = '\0';
  PetscCallMPI(MPI_Bcast(dir, PETSC_MAX_PATH_LEN, MPI_CHAR, 0, PETSC_COMM_WORLD));
  PetscCheck(dir[0], PETSC_COMM_WORLD, PETSC_ERR_FILE_OPEN, "no scratch folder could be made");
  PetscFunctionReturn(0);
}

/* Makes the folder and begins to keep errors */
static inline PetscErrorCode ScratchCreate(Scratch *s)
{
  PetscFunctionBeginUser;
  *s = (Scratch){.code = 0};
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &s->rank));
  PetscCall(ScratchMakeFolder(s->dir));
  PetscCall(PetscPushErrorHandler(ScratchKeepError, s));
  PetscFunctionReturn(0);
}

/* Path of a file of the folder */
static inline const char *ScratchPath(const Scratch *s, const char name[], char path[PETSC_MAX_PATH_LEN + 32])
{
  snprintf(path, PETSC_MAX_PATH_LEN + 32, "%s/%.30s", s->dir, name);
  return path;
}

/* Removes a file; whether it was there, on all ranks */
static inline int ScratchRemove(const Scratch *s, const char name[])
{
  char path[PETSC_MAX_PATH_LEN + 32];
  int  there;

  MPI_Barrier(PETSC_COMM_WORLD);
  there = s->rank == 0 && !unlink(ScratchPath(s, name, path));
  MPI_Bcast(&there, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  return there;
}

/* Removes the folder; whether it was empty, on all ranks */
static inline int ScratchDestroy(Scratch *s)
{
  int empty;

  (void)PetscPopErrorHandler();
  empty = s->rank || !rmdir(s->dir);
  MPI_Bcast(&empty, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  return empty;
}

/* Limits the size of files that this process writes, bytes; negative = no limit */
static inline void LimitFiles(long bytes)
{
  struct rlimit limit;

  getrlimit(RLIMIT_FSIZE, &limit);
  limit.rlim_cur = bytes < 0 ? limit.rlim_max : (rlim_t)bytes;
  setrlimit(RLIMIT_FSIZE, &limit);
}
