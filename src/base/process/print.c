/*
   Printing: PETSc hands all text of its printers to PetscVFPrintf, which is replaced here. Text for stdout and stderr
   is copied to the log file. A progress line, which begins with a carriage return, is no part of the log, and is erased
   before other text follows it.
*/
#include "print.h"
#include "base/path.h"
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* By which a log is known */
static const char first_line[] = "# Log of squeal: all that it printed\n";

/* Log handles */
static struct {
  FILE     *log;
  int       log_number; /* its descriptor */
  PetscBool pending;    /* a progress line is on the screen */
  PetscErrorCode (*print)(FILE *, const char[], va_list);
} printing;

/* Where whoever reads a stream has gone, what is left for it goes nowhere: PETSc would take that for an error */
static void PrintFlush(FILE *file)
{
  int nowhere;

  if (!fflush(file) || errno != EPIPE) return;
  nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere < 0) return;
  (void)dup2(nowhere, fileno(file));
  (void)close(nowhere);
  clearerr(file);
}

/* Stands in for PetscVFPrintf */
static PetscErrorCode PrintBoth(FILE *file, const char format[], va_list args)
{
  const PetscBool shown = file == stdout || file == stderr ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool line  = shown && format[0] == '\r' ? PETSC_TRUE : PETSC_FALSE;
  va_list         copy;

  PetscFunctionBeginUser;
  if (shown && printing.pending && !line) (void)fprintf(stderr, "\r%78s\r", "");
  if (shown) printing.pending = line;
  if (shown && !line && printing.log) {
    va_copy(copy, args);
    PetscCall((*printing.print)(printing.log, format, copy));
    va_end(copy);
  }
  PetscCall((*printing.print)(file, format, args));
  if (shown) PrintFlush(file);
  PetscFunctionReturn(0);
}

void PrintInstall(void)
{
  printing.print = PetscVFPrintf;
  PetscVFPrintf  = PrintBoth;
}

/* Whether the log may be written there: nothing is there, or what is no file, an empty one, or an earlier log */
static PetscBool LogMayReplace(const char path[])
{
  char        line[sizeof(first_line)] = "";
  struct stat status;
  FILE       *file;

  if (stat(path, &status) || !S_ISREG(status.st_mode) || status.st_size == 0) return PETSC_TRUE;
  file = fopen(path, "r");
  if (!file) return PETSC_FALSE;
  if (!fgets(line, sizeof(line), file)) line[0] = '\0';
  (void)fclose(file);
  return strcmp(line, first_line) ? PETSC_FALSE : PETSC_TRUE;
}

/* Makes the folder of the log, which may be that of results to come; returns errno */
static int LogMakeFolder(const char path[])
{
  char        folder[PETSC_MAX_PATH_LEN];
  const char *slash = strrchr(path, '/');

  if (!slash || slash == path) return 0;
  (void)snprintf(folder, sizeof(folder), "%.*s", (int)(slash - path), path);
  return access(folder, F_OK) ? PathMakeFolders(folder) : 0;
}

/* Opens the log, which may be a pipe, for which nobody waits */
static FILE *LogOpen(const char path[])
{
  const int   fd     = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_NONBLOCK | O_CLOEXEC, 0666);
  FILE *const stream = fd < 0 || fcntl(fd, F_SETFL, 0) ? NULL : fdopen(fd, "w");

  if (fd >= 0 && !stream) (void)close(fd);
  return stream;
}

PetscErrorCode PrintSetLog(MPI_Comm comm, const char file[])
{
  PetscMPIInt rank, error = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0 && !printing.log && !LogMayReplace(file)) error = EEXIST;
  PetscCallMPI(MPI_Bcast(&error, 1, MPI_INT, 0, comm));
  PetscCheck(!error, comm, PETSC_ERR_FILE_OPEN,
             "-squeal_log %s would replace a file that is no log of squeal; choose another file", file);
  if (rank == 0 && !printing.log) {
    error        = LogMakeFolder(file);
    printing.log = error ? NULL : LogOpen(file);
    if (!error && !printing.log) error = errno;
    if (printing.log) printing.log_number = fileno(printing.log);
    if (printing.log) (void)setvbuf(printing.log, NULL, _IOLBF, BUFSIZ);
    if (printing.log) (void)fputs(first_line, printing.log);
  }
  PetscCallMPI(MPI_Bcast(&error, 1, MPI_INT, 0, comm));
  PetscCheck(!error, comm, PETSC_ERR_FILE_OPEN, "cannot write the log -squeal_log %s: %s; choose another file", file,
             strerror(error));
  PetscFunctionReturn(0);
}

void PrintError(const char message[])
{
  if (printing.pending) (void)fprintf(stderr, "\r%78s\r", "");
  (void)fprintf(stderr, "squeal: error: %s\n", message);
  if (printing.log) (void)fprintf(printing.log, "squeal: error: %s\n", message);
}

void PrintAtOnce(const char line[])
{
  char          erase[] = "\r                                                                              \r";
  const ssize_t n[]     = {
        printing.pending ? write(STDERR_FILENO, erase, sizeof(erase) - 1) : 0,
    write(STDERR_FILENO, line, strlen(line)),
    printing.log ? write(printing.log_number, line, strlen(line)) : 0,
  };

  (void)n; /* where nothing can be written nothing can be said */
}

PetscBool PrintEnd(void)
{
  PetscBool whole = PETSC_TRUE;

  if (printing.log) whole = ferror(printing.log) || fclose(printing.log) ? PETSC_FALSE : PETSC_TRUE;
  printing.log = NULL;
  return whole;
}
