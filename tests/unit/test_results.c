/*
   Unit test of results/: tables and fields are whole under their final names, or absent under any name.

   A full disk is played by the system's limit of the size of a file (RLIMIT_FSIZE), at which a write fails with EFBIG
   as it fails with ENOSPC on a full disk. Limits range from nothing to the size of the file, of which some more is
   needed while it is written, so that the failure strikes at the creation, in the first and in the last values.
*/
#include <squeal/results.h>
#include <signal.h>
#include <sys/stat.h>
#include "boxmesh.h"
#include "check.h"
#include "scratch.h"

#define N_KINDS 6

/* Size of a file of the folder in bytes, -1 when there is none */
static long SizeOf(const Scratch *scratch, const char name[])
{
  char        path[PETSC_MAX_PATH_LEN + 32];
  struct stat status;

  return stat(ScratchPath(scratch, name, path), &status) ? -1 : (long)status.st_size;
}

/* Number of the files of a field or table of this name, temporary ones included; all are removed */
static int RemoveFiles(const Scratch *scratch, const char name[])
{
  static const char *const kinds[N_KINDS] = {".csv", ".csv.part", ".h5", ".h5.part", ".xmf", ".xmf.part"};
  char                     file[32], path[PETSC_MAX_PATH_LEN + 32];
  int                      n = 0;

  MPI_Barrier(PETSC_COMM_WORLD);
  for (int i = 0; i < N_KINDS && scratch->rank == 0; i++) {
    snprintf(file, sizeof(file), "%s%s", name, kinds[i]);
    n += unlink(ScratchPath(scratch, file, path)) ? 0 : 1;
  }
  MPI_Bcast(&n, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  return n;
}

/* Makes a writer into a folder; returns the code of ResultsOpenDirectory() */
static PetscErrorCode OpenResults(const char dir[], Results *results)
{
  PetscFunctionBeginUser;
  PetscCall(PetscOptionsSetValue(NULL, "-output_dir", dir));
  PetscCall(ResultsCreate(PETSC_COMM_WORLD, results));
  PetscCall(ResultsSetFromOptions(*results));
  PetscFunctionReturn(ResultsOpenDirectory(*results));
}

/* Breaks when: parents are not made, or a file in the way is not noticed */
static int TestFolder(Scratch *scratch)
{
  Results results;
  char    path[PETSC_MAX_PATH_LEN + 32];
  int     failed = 0;

  failed += CheckTrue("folder with parents is made", !OpenResults(scratch->dir, &results), 0);
  failed += CheckTrue("folder exists", !access(scratch->dir, W_OK), 0);
  (void)ResultsDestroy(&results);
  if (scratch->rank == 0) fclose(fopen(ScratchPath(scratch, "file", path), "w"));
  MPI_Barrier(PETSC_COMM_WORLD);
  ScratchPath(scratch, "file/below", path);
  failed += CheckTrue("no folder below a file", OpenResults(path, &results) == PETSC_ERR_FILE_OPEN, 0);
  failed += CheckTrue("message names the folder", strstr(scratch->message, path) != NULL, 0);
  (void)ResultsDestroy(&results);
  if (scratch->rank == 0) unlink(ScratchPath(scratch, "file", path));
  return failed;
}

/* Writes a table of n_rows rows; returns the code of ResultsTableClose() */
static PetscErrorCode WriteTable(Results results, int n_rows)
{
  ResultsTable table;

  PetscFunctionBeginUser;
  PetscCall(ResultsTableOpen(results, "table", "mode,freq_hz,label", &table));
  for (int i = 0; i < n_rows; i++) PetscCall(ResultsTableRow(table, "%d,%.15g,\"(0,%d)\"", i + 1, 0.1 * i, i));
  PetscFunctionReturn(ResultsTableClose(&table));
}

/* Breaks when: a row, its order or its end of line is lost, or a row is written by more than one rank */
static int TestTable(Scratch *scratch, Results results)
{
  const char expected[] = "mode,freq_hz,label\n1,0,\"(0,0)\"\n2,0.1,\"(0,1)\"\n";
  char       path[PETSC_MAX_PATH_LEN + 32], text[256] = "";
  int        failed = 0;
  FILE      *file;

  failed += CheckTrue("table is written", !WriteTable(results, 2), 0);
  file = fopen(ScratchPath(scratch, "table.csv", path), "r");
  if (file) text[fread(text, 1, sizeof(text) - 1, file)] = '\0';
  if (file) fclose(file);
  failed += CheckTrue("content of the table", !strcmp(text, expected), 0);
  failed += CheckTrue("the table is the only file", RemoveFiles(scratch, "table") == 1, 0);
  return failed;
}

/* Breaks when: a failed write goes unnoticed (few rows are still in the buffer when the table is closed, many are
   not), some rank does not learn of it, or a file is left */
static int TestTableFull(Scratch *scratch, Results results)
{
  static const int n_rows[] = {20, 2000};
  char             expected[2 * PETSC_MAX_PATH_LEN];
  int              failed = 0;

  snprintf(expected, sizeof(expected),
           "cannot write %s/table.csv: File too large; free some space or choose another -output_dir", scratch->dir);
  for (int i = 0; i < 2; i++) {
    LimitFiles(100);
    failed += CheckTrue("full disk stops the table", WriteTable(results, n_rows[i]) == PETSC_ERR_FILE_WRITE, n_rows[i]);
    LimitFiles(-1);
    failed += CheckTrue("message of the full disk", !strcmp(scratch->message, expected), n_rows[i]);
    failed += CheckTrue("no table is left", RemoveFiles(scratch, "table") == 0, n_rows[i]);
  }
  return failed;
}

/* Writes two shapes and a state of the local vertices; returns the first error */
static PetscErrorCode WriteField(Results results, const Mesh *mesh)
{
  static const char *const keys[] = {"mode_001", "mode_002"};
  PetscErrorCode           error, closing;
  ResultsField             field;
  PetscReal               *values;

  PetscFunctionBeginUser;
  error = ResultsFieldOpen(results, "field", mesh, &field);
  if (error) PetscFunctionReturn(error);
  PetscCall(PetscCalloc1(3 * mesh->n_nodes, &values));
  for (int i = 0; i < 2 && !error; i++) error = ResultsFieldWriteMode(field, keys[i], keys[i], mesh->x, values, NULL);
  const ResultsNodal arrays[] = {{"pressure_pa", 1, values}, {"displacement_m", 3, values}};
  if (!error) error = ResultsFieldWriteNodal(field, "state", 2, arrays);
  PetscCall(PetscFree(values));
  closing = ResultsFieldClose(&field);
  PetscFunctionReturn(error ? error : closing);
}

/* Breaks when: a failure to write goes unnoticed at any place of the file, or leaves one of the two files */
static int TestFieldFull(Scratch *scratch, Results results, const Mesh *mesh)
{
  long limits[6] = {0, 70000}, size;
  int  failed    = 0;

  failed += CheckTrue("field is written", !WriteField(results, mesh), 0);
  size = SizeOf(scratch, "field.h5");
  failed += CheckTrue("field and its description are the only files", RemoveFiles(scratch, "field") == 2, 0);
  for (int i = 2; i < 6; i++) limits[i] = size * (i - 1) / 4;
  for (int i = 0; i < 6; i++) {
    LimitFiles(limits[i]);
    failed += CheckTrue("full disk stops the field", WriteField(results, mesh) == PETSC_ERR_FILE_WRITE, limits[i]);
    LimitFiles(-1);
    failed += CheckTrue("message names the file", strstr(scratch->message, "/field.") != NULL, limits[i]);
    failed += CheckTrue("message gives the reason", strstr(scratch->message, ": File too large; ") != NULL, limits[i]);
    failed += CheckTrue("no field is left", RemoveFiles(scratch, "field") == 0, limits[i]);
  }
  LimitFiles(size + 65536);
  failed += CheckTrue("64 KiB more than the size suffice", !WriteField(results, mesh), size);
  failed += CheckTrue("size does not depend on the limit", SizeOf(scratch, "field.h5") == size, size);
  LimitFiles(-1);
  RemoveFiles(scratch, "field");
  return failed;
}

/* Puts the folder two levels below the scratch folder, top */
static void MoveDown(Scratch *scratch, char top[PETSC_MAX_PATH_LEN])
{
  snprintf(top, PETSC_MAX_PATH_LEN, "%s", scratch->dir);
  snprintf(scratch->dir, sizeof(scratch->dir), "%.1000s/a/b", top);
}

/* Puts it back; the folders between must be empty */
static int MoveUp(Scratch *scratch, const char top[])
{
  char parent[PETSC_MAX_PATH_LEN];
  int  kept;

  snprintf(parent, sizeof(parent), "%.1000s/a", top);
  kept = scratch->rank == 0 && (rmdir(scratch->dir) || rmdir(parent));
  snprintf(scratch->dir, sizeof(scratch->dir), "%s", top);
  return CheckTrue("no other file is left in the folder", !kept, 0);
}

int main(int argc, char **argv)
{
  const PetscInt faces[3] = {12, 10, 10};
  Scratch        scratch;
  Results        results;
  ResultsField   field;
  Mesh           mesh;
  char           top[PETSC_MAX_PATH_LEN];
  int            failed = 0;

  signal(SIGXFSZ, SIG_IGN);
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(ScratchCreate(&scratch));
  MoveDown(&scratch, top);
  PetscCall(BoxMeshTabulate(PETSC_COMM_WORLD, faces, &mesh));
  failed += TestFolder(&scratch);
  PetscCall(OpenResults(scratch.dir, &results));
  failed += TestTable(&scratch, results);
  failed += TestTableFull(&scratch, results);
  failed += TestFieldFull(&scratch, results, &mesh);
  failed +=
    CheckTrue("no field without a mesh", ResultsFieldOpen(results, "field", NULL, &field) == PETSC_ERR_ARG_NULL, 0);
  PetscCall(ResultsDestroy(&results));
  PetscCall(BoxMeshDestroy(&mesh));
  failed += MoveUp(&scratch, top);
  failed += CheckTrue("nor above it", ScratchDestroy(&scratch), 0);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD));
  PetscCall(PetscFinalize());
  return failed ? 1 : 0;
}
