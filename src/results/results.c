/*
   Results - the folder of the results and its tables. See squeal/results.h.
*/
#include "resultsimpl.h"
#include "base/path.h"
#include "base/process/watch.h"
#include <squeal/quantity.h>
#include <string.h>

struct _p_ResultsTable {
  OutFile file;
};

static const Quantity rows[] = {
  {"-output_dir", "folder of all files, made where it is missing", NULL, QUANTITY_TEXT,
   QUANTITY_AT(struct _p_Results, dir), .text = "results", .path = "folder"},
  {"-output_fields", "write shapes for ParaView (*.h5, *.xmf) beside the tables", NULL, QUANTITY_BOOL,
   QUANTITY_AT(struct _p_Results, fields), .initial = PETSC_TRUE},
  {"-output_overwrite",
   "finished results of an earlier run give way to those of this one; else they are an error; a killed run goes on "
   "either way",
   NULL, QUANTITY_BOOL, QUANTITY_AT(struct _p_Results, overwrite), .initial = PETSC_TRUE},
};
static const QuantityTable results_quantities = {"Results", "results.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows,
                                                 .in = 0};

PetscErrorCode ResultsCreate(MPI_Comm comm, Results *results)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(results));
  (*results)->comm = comm;
  (*results)->lock = -1;
  PetscCall(QuantitiesInit(&results_quantities, *results));
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsSetFromOptions(Results results)
{
  const size_t room = sizeof(results->dir) - 256; /* the rest is for the names of the files */

  PetscFunctionBeginUser;
  PetscCall(QuantitiesRead(results->comm, &results_quantities, results));
  PetscCheck(results->dir[0] && strlen(results->dir) < room, results->comm, PETSC_ERR_USER_INPUT,
             "-output_dir must be the name of a folder, of at most %d characters", (int)room);
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsVisit(Results results, const QuantityVisitor *visitor)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisit(visitor, &results_quantities, NULL, results, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsOpenDirectory(Results results)
{
  PetscMPIInt error = 0, rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(results->comm, &rank));
  if (rank == 0) error = PathMakeFolders(results->dir);
  PetscCallMPI(MPI_Bcast(&error, 1, MPI_INT, 0, results->comm));
  PetscCheck(!error, results->comm, PETSC_ERR_FILE_OPEN,
             "cannot write into the folder -output_dir %s: %s; choose another", results->dir, strerror(error));
  PetscCall(ResultsLock(results));
  WatchFolder(results->dir);
  PetscCall(EarlierRead(results));
  PetscCheck(
    results->overwrite || !results->has_finished, results->comm, PETSC_ERR_USER_INPUT,
    "-output_dir %s has finished results of an earlier run, and -output_overwrite is false: choose another folder",
    results->dir);
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsGetDirectory(Results results, const char **dir)
{
  PetscFunctionBeginUser;
  *dir = results->dir;
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsWantFields(Results results, PetscBool *wanted)
{
  PetscFunctionBeginUser;
  *wanted = results->fields;
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsTableOpen(Results results, const char name[], const char header[], ResultsTable *table)
{
  OutFile *file;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(table));
  file = &(*table)->file;
  PetscCall(OutFileSetName(results, name, ".csv", file));
  PetscCall(OutFileOpenText(file));
  PetscCall(OutFilePrint(file, "%s\n", header));
  PetscCall(OutFilesCheck(1, &file));
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsTableRow(ResultsTable table, const char format[], ...)
{
  va_list values;

  PetscFunctionBeginUser;
  va_start(values, format);
  PetscCall(OutFileVPrint(&table->file, format, values));
  va_end(values);
  PetscCall(OutFilePrint(&table->file, "\n"));
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsTableNumbers(ResultsTable table, PetscInt n, const PetscReal values[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++)
    PetscCall(OutFilePrint(&table->file, "%.15g%s", (double)values[i], i + 1 < n ? "," : "\n"));
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsTableCheck(ResultsTable table)
{
  OutFile *file = &table->file;

  PetscFunctionBeginUser;
  PetscCall(OutFilesCheck(1, &file));
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsTableFlush(ResultsTable table, ResultsMark *mark)
{
  PetscFunctionBeginUser;
  PetscCall(OutFileFlushText(&table->file, mark));
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsTableReopen(Results results, const char name[], const char header[], const ResultsMark *mark,
                                  ResultsTable *table)
{
  PetscErrorCode failure;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(table));
  PetscCall(OutFileSetName(results, name, ".csv", &(*table)->file));
  failure = OutFileReopenText(&(*table)->file, header, mark);
  if (failure) PetscCall(PetscFree(*table));
  PetscCall(failure);
  PetscFunctionReturn(0);
}

/* Ends the file of a table, under its final name or the temporary one, and frees the table in any case */
static PetscErrorCode TableEnd(ResultsTable *table, PetscBool publish)
{
  OutFile       *file = *table ? &(*table)->file : NULL;
  PetscErrorCode failure;

  PetscFunctionBeginUser;
  if (!file) PetscFunctionReturn(0);
  if (!publish) {
    file->keep = PETSC_TRUE;
    PetscCall(OutFileCloseText(file));
  }
  failure = publish ? OutFilesPublish(1, &file) : OutFilesCheck(1, &file);
  PetscCall(PetscFree(*table));
  PetscCall(failure);
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsTableSuspend(ResultsTable *table)
{
  return TableEnd(table, PETSC_FALSE);
}

PetscErrorCode ResultsTableClose(ResultsTable *table)
{
  return TableEnd(table, PETSC_TRUE);
}

PetscErrorCode ResultsDestroy(Results *results)
{
  PetscFunctionBeginUser;
  ResultsUnlock(*results);
  if (*results) PetscCall(ResultsForget(*results));
  PetscCall(PetscFree(*results));
  PetscFunctionReturn(0);
}
