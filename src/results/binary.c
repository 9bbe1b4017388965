/*
   Binary files: every rank of a communicator writes its pieces in place and flushes them to the disk; then the first
   rank renames the file and flushes the folder, without which a crash of the machine may take the new name back.
*/
#include "resultsimpl.h"
#include "base/file.h"
#include <errno.h>
#include <fcntl.h>
#include <unistd.h>

/* Opens the file on all ranks, emptied on the first one. Collective, raises its failures */
static PetscErrorCode OutFileOpenBinary(OutFile *file)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(file->comm, &rank));
  for (int turn = 0; turn < 2; turn++) {
    if ((rank == 0) == (turn == 0)) {
      file->fd = rank ? FileOpen(file->part, O_WRONLY) : FileCreate(file->part, O_WRONLY);
      PetscCall(OutFileNote(file, file->fd < 0 ? PETSC_TRUE : PETSC_FALSE));
    }
    PetscCall(OutFilesCheck(1, &file));
  }
  PetscFunctionReturn(0);
}

/* Flushes a folder, where the system can; failures are noted */
static PetscErrorCode OutFileFlushFolder(OutFile *file, const char dir[])
{
  const int fd = open(dir, O_RDONLY | O_DIRECTORY);

  PetscFunctionBeginUser;
  PetscCall(OutFileNote(file, fd < 0 || (fsync(fd) && errno != EINVAL) ? PETSC_TRUE : PETSC_FALSE));
  if (fd >= 0) (void)close(fd);
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsBinaryWrite(Results results, MPI_Comm comm, const char name[], PetscBool listed, PetscInt n,
                                  const ResultsPiece pieces[])
{
  uint64_t    offset = 0, size = 0;
  PetscMPIInt rank;
  OutFile     opened, *file = &opened;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  for (PetscInt i = 0; i < n; i++) size += pieces[i].size;
  PetscCallMPI(MPI_Exscan(&size, &offset, 1, MPI_UINT64_T, MPI_SUM, comm));
  if (rank == 0) offset = 0; /* MPI leaves it undefined there */
  PetscCall(OutFileSetPath(results, comm, name, "", file));
  if (listed) PetscCall(ResultsKeep(results, name));
  PetscCall(OutFileOpenBinary(file));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(OutFileWriteAt(file, pieces[i].bytes, pieces[i].size, (off_t)offset));
    offset += pieces[i].size;
  }
  if (!file->error) PetscCall(OutFileNote(file, fsync(file->fd) ? PETSC_TRUE : PETSC_FALSE));
  PetscCall(OutFilesPublish(1, &file));
  if (rank == 0) PetscCall(OutFileFlushFolder(file, results->dir));
  PetscCall(OutFilesCheck(1, &file));
  PetscFunctionReturn(0);
}
