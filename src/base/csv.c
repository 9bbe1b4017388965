/* Tables with named columns: the words of a line are cut in place, spaces around them left out */
#include "csv.h"
#include "file.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char mark[] = "\xEF\xBB\xBF"; /* of the order of bytes, before UTF-8 of some spreadsheets */

/* The words of the next line; their number, 0 at the end of the file */
static PetscInt CsvCut(Csv *csv)
{
  PetscInt n = 0;

  if (!fgets(csv->text, CSV_MAX_LINE, csv->stream)) return 0;
  csv->line++;
  csv->text[strcspn(csv->text, "\r\n")] = '\0';
  if (csv->line == 1 && !strncmp(csv->text, mark, strlen(mark)))
    memmove(csv->text, csv->text + strlen(mark), strlen(csv->text + strlen(mark)) + 1);
  for (char *rest = csv->text; rest && n < CSV_MAX_COLUMNS; n++) {
    char **word = &csv->word[n];

    *word = rest;
    rest  = strchr(rest, ',');
    if (rest) *rest++ = '\0';
    while (**word == ' ') (*word)++;
    for (size_t k = strlen(*word); k && (*word)[k - 1] == ' '; k--) (*word)[k - 1] = '\0';
  }
  return n;
}

/* "unknown,node,direction" of the columns that must be there */
static void CsvMissing(Csv *csv, PetscInt missing, PetscInt n_required)
{
  size_t length = (size_t)snprintf(csv->fault, sizeof(csv->fault), "its first line has no column %s: it must have ",
                                   csv->column[missing]);

  for (PetscInt c = 0; c < n_required && length < sizeof(csv->fault); c++)
    length += (size_t)snprintf(csv->fault + length, sizeof(csv->fault) - length, "%s%s", c ? "," : "", csv->column[c]);
}

void CsvOpen(Csv *csv, const char file[], PetscInt n, const char *const column[], PetscInt n_required)
{
  csv->column = column;
  csv->n      = n;
  csv->stream = FileStream(file, "r");
  if (!csv->stream) (void)snprintf(csv->fault, sizeof(csv->fault), "%s", FileReason(errno));
  if (!csv->stream) return;
  csv->n_columns = CsvCut(csv);
  if (csv->n_columns == 1 && strchr(csv->word[0], ';')) {
    (void)snprintf(csv->fault, sizeof(csv->fault),
                   "its columns are separated by ';': they must be by ',', and numbers "
                   "have a point, as 1.5e-6");
    return;
  }
  for (PetscInt c = 0; c < n; c++) {
    csv->at[c] = -1;
    for (PetscInt i = 0; i < csv->n_columns; i++)
      if (!strcmp(csv->word[i], column[c])) csv->at[c] = (int)i;
    if (csv->at[c] < 0 && c < n_required && !csv->fault[0]) CsvMissing(csv, c, n_required);
  }
}

PetscBool CsvNext(Csv *csv)
{
  PetscInt n = 0;

  if (csv->fault[0]) return PETSC_FALSE;
  do n = CsvCut(csv);
  while (n == 1 && !csv->word[0][0]);
  if (n && n != csv->n_columns)
    (void)snprintf(csv->fault, sizeof(csv->fault), "line %d has %d columns, its first line %d", (int)csv->line, (int)n,
                   (int)csv->n_columns);
  return n && !csv->fault[0] ? PETSC_TRUE : PETSC_FALSE;
}

double CsvReal(Csv *csv, PetscInt column, PetscBool whole)
{
  const char  *text = csv->word[csv->at[column]];
  char        *end;
  const double value = strtod(text, &end);

  if (!csv->fault[0] && end != text && !*end && fabs(value) > CSV_LARGEST)
    (void)snprintf(csv->fault, sizeof(csv->fault), "line %d: %s '%.40s' must be from -%.0e to %.0e", (int)csv->line,
                   csv->column[column], text, CSV_LARGEST, CSV_LARGEST);
  if (!csv->fault[0] && (end == text || *end || isnan(value) || (whole && value != rint(value))))
    (void)snprintf(csv->fault, sizeof(csv->fault), "line %d: %s '%.40s' is no %snumber", (int)csv->line,
                   csv->column[column], text, whole ? "whole " : "");
  return value;
}

const char *CsvWord(const Csv *csv, PetscInt column)
{
  return csv->at[column] < 0 ? NULL : csv->word[csv->at[column]];
}

void CsvClose(Csv *csv)
{
  if (csv->stream) (void)fclose(csv->stream);
}
