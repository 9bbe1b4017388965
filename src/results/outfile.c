/*
   Files under a temporary name: NAME.part becomes NAME when it is complete and every rank agrees, else it is removed.
*/
#include "resultsimpl.h"
#include <errno.h>
#include <string.h>
#include <unistd.h>

/* Names the file `name``extension` in the folder of the results; nothing is opened */
PetscErrorCode OutFileSetName(Results results, const char name[], const char extension[], OutFile *file)
{
  PetscFunctionBeginUser;
  file->comm   = results->comm;
  file->error  = 0;
  file->stream = NULL;
  file->h5     = H5I_INVALID_HID;
  file->fd     = -1;
  PetscCall(PetscSNPrintf(file->name, sizeof(file->name), "%s/%s%s", results->dir, name, extension));
  PetscCall(PetscSNPrintf(file->part, sizeof(file->part), "%s/%s%s.part", results->dir, name, extension));
  PetscFunctionReturn(0);
}

/* Keeps the reason of the first failure; libraries may fail without setting errno */
PetscErrorCode OutFileNote(OutFile *file, PetscBool failed)
{
  PetscFunctionBeginUser;
  if (failed && !file->error) file->error = errno ? errno : EIO;
  PetscFunctionReturn(0);
}

/* Opens the file for text on the first rank */
PetscErrorCode OutFileOpenText(OutFile *file)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(file->comm, &rank));
  if (rank == 0) {
    file->stream = fopen(file->part, "w");
    PetscCall(OutFileNote(file, file->stream ? PETSC_FALSE : PETSC_TRUE));
  }
  PetscFunctionReturn(0);
}

/* vprintf() on the first rank */
PetscErrorCode OutFileVPrint(OutFile *file, const char format[], va_list values)
{
  PetscFunctionBeginUser;
  if (file->stream && !file->error)
    PetscCall(OutFileNote(file, vfprintf(file->stream, format, values) < 0 ? PETSC_TRUE : PETSC_FALSE));
  PetscFunctionReturn(0);
}

/* printf() on the first rank */
PetscErrorCode OutFilePrint(OutFile *file, const char format[], ...)
{
  va_list values;

  PetscFunctionBeginUser;
  va_start(values, format);
  PetscCall(OutFileVPrint(file, format, values));
  va_end(values);
  PetscFunctionReturn(0);
}

/* Flushes and closes the text; a full disk often shows only here */
static PetscErrorCode OutFileCloseText(OutFile *file)
{
  PetscFunctionBeginUser;
  if (!file->stream) PetscFunctionReturn(0);
  PetscCall(OutFileNote(file, fflush(file->stream) ? PETSC_TRUE : PETSC_FALSE));
  PetscCall(OutFileNote(file, fclose(file->stream) ? PETSC_TRUE : PETSC_FALSE));
  file->stream = NULL;
  PetscFunctionReturn(0);
}

/* Closes what is open and removes the temporary file */
static PetscErrorCode OutFileDiscard(OutFile *file)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(file->comm, &rank));
  PetscCall(OutFileCloseText(file));
  PetscCall(OutFileH5Close(file));
  if (rank == 0) (void)unlink(file->part); /* it may never have come to exist */
  PetscFunctionReturn(0);
}

/*
   Raises the first failure among the files on all ranks; all temporary files are then removed. Collective.
*/
PetscErrorCode OutFilesCheck(PetscInt n, OutFile *const files[])
{
  PetscInt    failed = n;
  PetscMPIInt error  = 0;
  const char *advice;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n && failed == n; i++) {
    PetscCallMPI(MPI_Allreduce(&files[i]->error, &error, 1, MPI_INT, MPI_MAX, files[i]->comm));
    if (error) failed = i;
  }
  if (failed == n) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < n; i++) PetscCall(OutFileDiscard(files[i]));
  PetscCallMPI(MPI_Barrier(files[0]->comm)); /* no rank ends the run before the files are gone */
  advice = error == ENOSPC || error == EDQUOT || error == EFBIG ? "free some space or " : "";
  SETERRQ(files[failed]->comm, PETSC_ERR_FILE_WRITE, "cannot write %s: %s; %schoose another -output_dir",
          files[failed]->name, strerror(error), advice);
}

/*
   Completes the files and gives them their final names, in this order; an error leaves no temporary file. Collective.
*/
PetscErrorCode OutFilesPublish(PetscInt n, OutFile *const files[])
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(OutFileCloseText(files[i]));
    PetscCall(OutFileH5Close(files[i]));
  }
  PetscCall(OutFilesCheck(n, files));
  PetscCallMPI(MPI_Comm_rank(files[0]->comm, &rank));
  for (PetscInt i = 0; i < n && rank == 0; i++) {
    PetscCall(OutFileNote(files[i], rename(files[i]->part, files[i]->name) ? PETSC_TRUE : PETSC_FALSE));
  }
  PetscCall(OutFilesCheck(n, files));
  PetscFunctionReturn(0);
}
