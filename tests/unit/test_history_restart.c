/*
   Unit test of the history of a run that is killed and goes on: its tables and films are those of the unbroken run,
   byte for byte, wherever the run was killed. Reference: the unbroken run.
*/
#include "madehistory.h"
#include <signal.h>

#define N_STEPS 40
#define OPTIONS "-dynamics_history_interval 3e-6 -dynamics_snapshot_interval 1.6e-5 -dynamics_live 0"

static Scratch errors; /* keeps the last message */

/* Steps [first, end) */
static PetscErrorCode Steps(Made *m, History history, PetscInt first, PetscInt end)
{
  PetscFunctionBeginUser;
  for (PetscInt n = first; n < end; n++) PetscCall(MadeRecord(m, history, n));
  PetscFunctionReturn(0);
}

/* Runs to `killed`, with its memory taken before step `kept`, and leaves everything as it is then; the caller frees the
   memory */
static PetscErrorCode RunBroken(Made *m, PetscInt kept, PetscInt killed, PetscInt *n, PetscReal **memory)
{
  History history;

  PetscFunctionBeginUser;
  PetscCall(MadeHistory(m, OPTIONS, &history));
  PetscCall(Steps(m, history, 0, kept));
  PetscCall(HistoryGetMemory(history, n, memory));
  PetscCall(Steps(m, history, kept, killed));
  PetscCall(HistoryDestroy(&history));
  PetscFunctionReturn(0);
}

/* Goes on from the memory, or begins without one, to the end; the handle is freed in any case */
static PetscErrorCode GoOn(Made *m, PetscInt kept, PetscInt n, const PetscReal memory[])
{
  History        history;
  PetscErrorCode error = 0;

  PetscFunctionBeginUser;
  PetscCall(MadeHistory(m, OPTIONS, &history));
  if (memory) error = HistorySetMemory(history, n, memory);
  if (!error) error = Steps(m, history, kept, N_STEPS);
  if (!error) error = HistoryClose(history);
  PetscCall(HistoryDestroy(&history));
  PetscFunctionReturn(error);
}

/* The files of the present run, on rank 0; both are freed by the next call */
typedef struct {
  char *table, *film;
} Files;

static void FilesRead(const Made *m, Files *files)
{
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  free(files->table);
  free(files->film);
  files->table = MadeRead(m, "transient.csv");
  files->film  = MadeRead(m, "transient.xmf");
}

static int SameText(const char *one, const char *other)
{
  return one && other && !strcmp(one, other);
}

/* Compares the files of a run with those of the unbroken one, and removes the table */
static int CheckSame(const Made *m, const char name[], const Files *unbroken)
{
  Files files  = {0};
  int   failed = 0;

  FilesRead(m, &files);
  if (m->rank == 0) {
    printf("     %s\n", name);
    failed += CheckTrue("the table is that of the unbroken run", SameText(files.table, unbroken->table), 0);
    failed += CheckTrue("the film is that of the unbroken run", SameText(files.film, unbroken->film), 0);
  }
  free(files.table);
  free(files.film);
  return failed;
}

/* Breaks when: rows after the checkpoint are kept, or repeated; a number that the next row needs is not kept (projector
   sweeps, next multiples, times of the snapshots); the complete table of a run that was killed after it was closed is
   not found */
static PetscErrorCode TestKilled(Made *m, const Files *unbroken, int *failed)
{
  static const PetscInt kept[] = {0, 1, 17, 23}, killed[] = {5, 1, 31, 40};
  PetscReal            *memory;
  PetscInt              n;

  PetscFunctionBeginUser;
  for (int i = 0; i < 4; i++) {
    PetscCall(RunBroken(m, kept[i], killed[i], &n, &memory));
    PetscCall(GoOn(m, kept[i], n, memory));
    *failed += CheckSame(m, "killed while it runs", unbroken);
    PetscCall(GoOn(m, kept[i], n, memory));
    *failed += CheckSame(m, "killed at the end", unbroken);
    *failed += CheckTrue("nothing temporary is left", !MadeRemove(m, "transient.csv.part"), 0);
    PetscCall(PetscFree(memory));
  }
  PetscFunctionReturn(0);
}

/* Makes the temporary table on rank 0 */
static PetscErrorCode WritePart(const Made *m, const char text[])
{
  char  path[PETSC_MAX_PATH_LEN + 32];
  FILE *file;

  PetscFunctionBeginUser;
  snprintf(path, sizeof(path), "%s/transient.csv.part", m->dir);
  file = m->rank ? NULL : fopen(path, "w");
  if (file) fputs(text, file);
  if (file) fclose(file);
  PetscCallMPI(MPI_Barrier(PETSC_COMM_WORLD));
  PetscFunctionReturn(0);
}

/* Breaks when: a table that cannot be the one of the run is taken for it, or changed */
static PetscErrorCode TestForeign(Made *m, int *failed)
{
  static const char *const texts[]    = {NULL, "time_s,normal_force_n\n0,0\n", ""};
  static const char *const expected[] = {"/transient.csv: No such file or directory; start the run anew",
                                         "/transient.csv.part: it is shorter than when it was kept; start the run anew",
                                         "/transient.csv.part: it has other columns; start the run anew"};
  char                     longer[20000];
  PetscReal               *memory;
  PetscInt                 n;

  PetscFunctionBeginUser;
  memset(longer, 'a', sizeof(longer));
  longer[sizeof(longer) - 1] = '\0';
  PetscCall(RunBroken(m, 17, 17, &n, &memory));
  for (int i = 0; i < 3; i++) {
    const char *text = i == 2 ? longer : texts[i];
    char       *left;

    (void)MadeRemove(m, "transient.csv.part");
    (void)MadeRemove(m, "transient.csv");
    if (text) PetscCall(WritePart(m, text));
    PetscCall(PetscPushErrorHandler(ScratchKeepError, &errors));
    *failed += CheckTrue("a foreign table is refused", GoOn(m, 17, n, memory) == PETSC_ERR_FILE_UNEXPECTED, i);
    PetscCall(PetscPopErrorHandler());
    *failed += CheckTrue("message", strstr(errors.message, expected[i]) != NULL, i);
    left = MadeRead(m, "transient.csv.part");
    if (m->rank == 0) *failed += CheckTrue("it is as it was", text ? SameText(left, text) : !left, i);
    free(left);
  }
  (void)MadeRemove(m, "transient.csv.part");
  PetscCall(PetscFree(memory));
  PetscFunctionReturn(0);
}

/* Breaks when: a full disk shows only at the end of the run, or the rows that the checkpoint needs are removed. The
   limit of the size of a file plays the disk; rows reach it in blocks of 4 KiB */
static PetscErrorCode TestFull(Made *m, const Files *unbroken, int *failed)
{
  PetscErrorCode error = 0;
  History        history;
  PetscReal     *memory;
  PetscInt       n, step = 17;
  char          *text;

  PetscFunctionBeginUser;
  PetscCall(MadeHistory(m, OPTIONS " -dynamics_snapshot_interval 0", &history));
  PetscCall(Steps(m, history, 0, step));
  PetscCall(HistoryGetMemory(history, &n, &memory));
  LimitFiles(6000);
  PetscCall(PetscPushErrorHandler(ScratchKeepError, &errors));
  for (; step < 3000 && !error; step++) error = MadeRecord(m, history, step);
  PetscCall(PetscPopErrorHandler());
  LimitFiles(-1);
  *failed += CheckTrue("a full disk stops the run at a row", error == PETSC_ERR_FILE_WRITE && step < 300, (double)step);
  *failed +=
    CheckTrue("message", strstr(errors.message, "/transient.csv: File too large; free some space or ") != NULL, 0);
  PetscCall(PetscPushErrorHandler(ScratchKeepError, &errors));
  (void)HistoryDestroy(&history);
  PetscCall(PetscPopErrorHandler());
  PetscCall(GoOn(m, 17, n, memory));
  text = MadeRead(m, "transient.csv");
  if (m->rank == 0) *failed += CheckTrue("the table is that of the unbroken run", SameText(text, unbroken->table), 0);
  free(text);
  PetscCall(PetscFree(memory));
  PetscFunctionReturn(0);
}

/* Removes all files of a run */
static void FilesRemove(const Made *m)
{
  (void)MadeRemove(m, "transient.csv");
  (void)MadeRemove(m, "transient.xmf");
  for (int k = 0; k < 3; k++) {
    char name[64];

    snprintf(name, sizeof(name), "snapshot_%06d.h5", k);
    (void)MadeRemove(m, name);
    snprintf(name, sizeof(name), "snapshot_%06d.xmf", k);
    (void)MadeRemove(m, name);
  }
}

int main(int argc, char **argv)
{
  Made  m        = {0};
  Files unbroken = {0};
  int   failed   = 0;

  (void)signal(SIGXFSZ, SIG_IGN);
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(MadeCreate(&m));
  PetscCall(GoOn(&m, 0, 0, NULL));
  FilesRead(&m, &unbroken);
  PetscCall(TestKilled(&m, &unbroken, &failed));
  PetscCall(TestForeign(&m, &failed));
  PetscCall(TestFull(&m, &unbroken, &failed));
  free(unbroken.table);
  free(unbroken.film);
  FilesRemove(&m);
  PetscCall(MadeDestroy(&m, &failed));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD));
  PetscCall(PetscFinalize());
  return failed ? 1 : 0;
}
