/*
   Files under a temporary name: NAME.part becomes NAME when it is complete and every rank agrees, else it is removed.
   Text that was flushed for a later run to go on from stays as NAME.part when this one fails.
*/
#include "resultsimpl.h"
#include "base/file.h"
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define TEXT_BLOCK 65536 /* bytes */

/* Names the file `name``extension` of some ranks in the folder of the results; nothing is opened */
PetscErrorCode OutFileSetPath(Results results, MPI_Comm comm, const char name[], const char extension[], OutFile *file)
{
  PetscFunctionBeginUser;
  file->comm    = comm;
  file->results = results;
  file->keep    = PETSC_FALSE;
  file->error   = 0;
  file->stream  = NULL;
  file->h5      = H5I_INVALID_HID;
  file->fd      = -1;
  file->memory  = -1;
  file->n_rows  = 0;
  file->rows    = NULL;
  file->sum     = CHECKSUM_BEGIN;
  file->summed  = 0;
  PetscCall(PetscSNPrintf(file->name, sizeof(file->name), "%s/%s%s", results->dir, name, extension));
  PetscCall(PetscSNPrintf(file->part, sizeof(file->part), "%s/%s%s.part", results->dir, name, extension));
  PetscFunctionReturn(0);
}

/* The same of all ranks, which scene.yaml lists */
PetscErrorCode OutFileSetName(Results results, const char name[], const char extension[], OutFile *file)
{
  PetscFunctionBeginUser;
  PetscCall(OutFileSetPath(results, results->comm, name, extension, file));
  PetscCall(ResultsKeep(results, file->name + strlen(results->dir) + 1));
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
    file->stream = FileCreateStream(file->part, "w+");
    PetscCall(OutFileNote(file, file->stream ? PETSC_FALSE : PETSC_TRUE));
  }
  PetscFunctionReturn(0);
}

/* Checksum of the first bytes of a text, on from those of the call before: block by block, the last one as it is. Notes
   failures. */
static PetscErrorCode TextSum(OutFile *file, int fd, PetscInt64 bytes, uint64_t *sum)
{
  char     *block;
  PetscBool failed = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(TEXT_BLOCK, &block));
  errno = 0;
  for (*sum = file->sum; file->summed <= bytes && !failed;) {
    const size_t size = (size_t)PetscMin(TEXT_BLOCK, bytes - file->summed);

    failed = pread(fd, block, size, (off_t)file->summed) == (ssize_t)size ? PETSC_FALSE : PETSC_TRUE;
    *sum   = ChecksumBytes(file->sum, block, size);
    if (size < TEXT_BLOCK) break;
    file->sum = *sum;
    file->summed += TEXT_BLOCK;
  }
  PetscCall(PetscFree(block));
  PetscCall(OutFileNote(file, failed));
  PetscFunctionReturn(0);
}

/* Why text up to the mark with first line `head` cannot be continued, NULL when it can; then it is cut back to it */
static const char *TextCut(OutFile *file, int fd, const char head[], const ResultsMark *mark)
{
  const PetscInt64 bytes  = mark->bytes;
  const size_t     length = strlen(head) + 1;
  const off_t      end    = lseek(fd, 0, SEEK_END);
  char            *found = malloc(length), last = 0;
  const char      *reason = NULL;
  uint64_t         sum    = 0;

  file->sum    = CHECKSUM_BEGIN;
  file->summed = 0;
  if (end >= bytes) (void)TextSum(file, fd, bytes, &sum);
  if (!found || end < 0)
    reason = strerror(errno);
  else if (end < bytes)
    reason = "it is shorter than when it was kept";
  else if (pread(fd, found, length, 0) != (ssize_t)length || memcmp(found, head, length - 1) ||
           found[length - 1] != '\n')
    reason = "it has other columns";
  else if (bytes < (PetscInt64)length || pread(fd, &last, 1, (off_t)bytes - 1) != 1 || last != '\n')
    reason = "it is not the one that was kept";
  else if (sum != mark->sum)
    reason = "its rows before the checkpoint are not those that were written";
  else if (ftruncate(fd, (off_t)bytes))
    reason = strerror(errno);
  free(found);
  return reason;
}

/* Opens the file at path, the temporary or the complete one, which then is temporary again, to append to its first
   bytes */
static const char *TextReopen(OutFile *file, const char path[], const char head[], const ResultsMark *mark)
{
  const int   fd     = FileOpen(path, O_RDWR);
  const char *reason = fd < 0 ? FileReason(errno) : TextCut(file, fd, head, mark);

  if (!reason && strcmp(path, file->part) && rename(file->name, file->part)) reason = strerror(errno);
  if (!reason && lseek(fd, 0, SEEK_END) < 0) reason = strerror(errno);
  if (!reason && !(file->stream = fdopen(fd, "w"))) reason = strerror(errno);
  if (reason && fd >= 0) (void)close(fd);
  return reason;
}

/* Opens text that an earlier run flushed, to continue it after the mark; raises its failures. Collective */
PetscErrorCode OutFileReopenText(OutFile *file, const char head[], const ResultsMark *mark)
{
  char        reason[128] = "", path[PETSC_MAX_PATH_LEN];
  const char *why;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(file->comm, &rank));
  file->keep = PETSC_TRUE;
  PetscCall(PetscStrncpy(path, access(file->part, F_OK) ? file->name : file->part, sizeof(path)));
  why = rank ? NULL : TextReopen(file, path, head, mark);
  if (why) PetscCall(PetscStrncpy(reason, why, sizeof(reason)));
  PetscCallMPI(MPI_Bcast(reason, sizeof(reason), MPI_CHAR, 0, file->comm));
  PetscCallMPI(MPI_Bcast(path, sizeof(path), MPI_CHAR, 0, file->comm));
  PetscCheck(!reason[0], file->comm, PETSC_ERR_FILE_UNEXPECTED, "cannot go on with %s: %s; start the run anew", path,
             reason);
  PetscFunctionReturn(0);
}

/* Brings the text to the disk, and keeps it from now on; mark is its length and checksum on every rank. Raises
   failures. Collective */
PetscErrorCode OutFileFlushText(OutFile *file, ResultsMark *mark)
{
  PetscFunctionBeginUser;
  *mark = (ResultsMark){.bytes = 0};
  if (file->stream && !file->error) {
    errno = 0;
    PetscCall(OutFileNote(file, fflush(file->stream) || fsync(fileno(file->stream)) ? PETSC_TRUE : PETSC_FALSE));
    mark->bytes = ftello(file->stream);
    PetscCall(OutFileNote(file, mark->bytes < 0 ? PETSC_TRUE : PETSC_FALSE));
    if (!file->error) PetscCall(TextSum(file, fileno(file->stream), mark->bytes, &mark->sum));
  }
  PetscCall(OutFilesCheck(1, &file));
  file->keep = PETSC_TRUE;
  PetscCallMPI(MPI_Bcast(&mark->bytes, 1, MPIU_INT64, 0, file->comm));
  PetscCallMPI(MPI_Bcast(&mark->sum, 1, MPI_UINT64_T, 0, file->comm));
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

/* Writes `size` bytes at `offset`; the system may take them in pieces */
PetscErrorCode OutFileWriteAt(OutFile *file, const char *bytes, size_t size, off_t offset)
{
  PetscFunctionBeginUser;
  while (size > 0 && !file->error) {
    const ssize_t written = pwrite(file->fd, bytes, size, offset);

    if (written < 0 && errno == EINTR) continue;
    PetscCall(OutFileNote(file, written < 0 ? PETSC_TRUE : PETSC_FALSE));
    if (written < 0) break;
    bytes += written;
    offset += written;
    size -= (size_t)written;
  }
  PetscFunctionReturn(0);
}

/* Flushes and closes the text; a full disk often shows only here */
PetscErrorCode OutFileCloseText(OutFile *file)
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
  /* it may never have come to exist */
  if (rank == 0 && !file->keep && file->error != FILE_NO_REGULAR) (void)unlink(file->part);
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
  PetscCheck(error != FILE_NO_REGULAR, files[failed]->comm, PETSC_ERR_FILE_WRITE,
             "cannot write %s: it is no regular file; remove it, or choose another -output_dir", files[failed]->part);
  PetscCheck(error != OUTFILE_NO_MEMORY, files[failed]->comm, PETSC_ERR_FILE_WRITE,
             "cannot write %s: HDF5 needs a file in memory of some kilobytes, which memfd_create() does not give; do "
             "without by -output_fields 0",
             files[failed]->name);
  SETERRQ(files[failed]->comm, PETSC_ERR_FILE_WRITE, "cannot write %s: %s; %schoose another -output_dir",
          files[failed]->name, strerror(error), advice);
}

/*
   Completes the files and gives them their final names, in this order, once scene.yaml names them; an error leaves no
   temporary file. Collective.
*/
PetscErrorCode OutFilesPublish(PetscInt n, OutFile *const files[])
{
  PetscMPIInt    rank;
  PetscErrorCode failure;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(OutFileCloseText(files[i]));
    PetscCall(OutFileH5Close(files[i]));
  }
  PetscCall(OutFilesCheck(n, files));
  failure = files[0]->comm == files[0]->results->comm ? ResultsListFiles(files[0]->results) : 0;
  for (PetscInt i = 0; i < n && failure; i++) PetscCall(OutFileDiscard(files[i]));
  PetscCall(failure);
  PetscCallMPI(MPI_Comm_rank(files[0]->comm, &rank));
  for (PetscInt i = 0; i < n && rank == 0; i++) {
    PetscCall(OutFileNote(files[i], rename(files[i]->part, files[i]->name) ? PETSC_TRUE : PETSC_FALSE));
  }
  PetscCall(OutFilesCheck(n, files));
  PetscFunctionReturn(0);
}
