/*
   Nastran: superelement.pch, bulk data in large fields of 16 columns, hence 10 digits: GRID of the interface, SPOINT of
   modal coordinates and of what is kept inside, DMIG KSE, MSE and BSE, symmetric (form 6) and of double precision. Case
   control takes them by K2GG = KSE, M2GG = MSE, B2GG = BSE.
*/
#include "text.h"
#include <math.h>
#include <stdio.h>

/* The column that is being written */
typedef struct {
  Text         text;
  const char  *name;
  PetscInt     column; /* -1 before the first */
  Substructure s;
} NastranColumn;

/* A number of 16 columns at most, with D as Nastran has it in double precision */
static void NastranNumber(PetscReal value, char letter, char field[32])
{
  (void)snprintf(field, 32, "%.*E", fabs((double)value) < 1e-99 || fabs((double)value) >= 1e100 ? 8 : 9, (double)value);
  for (char *c = field; *c; c++)
    if (*c == 'E') *c = letter;
}

static PetscErrorCode NastranEntry(void *ctx, PetscInt i, PetscInt j, PetscReal value)
{
  NastranColumn *column = ctx;
  PetscInt       node, direction;
  char           field[32];

  PetscFunctionBeginUser;
  if (j != column->column) {
    TextPlace(column->s, j, &node, &direction);
    PetscCall(
      TextPrint(&column->text, "DMIG*   %-16s%16" PetscInt_FMT "%16" PetscInt_FMT "\n", column->name, node, direction));
    column->column = j;
  }
  TextPlace(column->s, i, &node, &direction);
  NastranNumber(value, 'D', field);
  PetscCall(TextPrint(&column->text, "*       %16" PetscInt_FMT "%16" PetscInt_FMT "%16s\n", node, direction, field));
  PetscFunctionReturn(0);
}

/* GRID and SPOINT */
static PetscErrorCode NastranNodes(const Substructure s, const Text *text)
{
  const PetscInt inside = s->n - s->interface.n;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < s->interface.n; k++) {
    const InterfaceRow *row = &s->interface.row[k];
    char                x[3][32];

    if (k && row->node == row[-1].node) continue;
    for (int d = 0; d < 3; d++) NastranNumber(row->x[d], 'E', x[d]);
    PetscCall(
      TextPrint(text, "GRID*   %16" PetscInt_FMT "%16s%16s%16s\n*       %16s\n", row->node, "", x[0], x[1], x[2]));
  }
  if (inside == 1) PetscCall(TextPrint(text, "SPOINT  %8" PetscInt_FMT "\n", s->interface.n_nodes + 1));
  if (inside > 1)
    PetscCall(TextPrint(text, "SPOINT  %8" PetscInt_FMT "%8s%8" PetscInt_FMT "\n", s->interface.n_nodes + 1, "THRU",
                        s->interface.n_nodes + inside));
  PetscFunctionReturn(0);
}

PetscErrorCode NastranWrite(Substructure s, Results results)
{
  TextMatrix     matrix[3];
  const PetscInt n      = TextMatrices(s, matrix);
  NastranColumn  column = {.s = s};
  char           parts[160];
  PetscInt       n_entries;

  PetscFunctionBeginUser;
  PetscCall(TextParts(s, sizeof(parts), parts));
  PetscCall(TextCreate(s->comm, &column.text));
  PetscCall(TextPrint(&column.text, "$ superelement of %s; case control: K2GG = KSE, M2GG = MSE%s\n", parts,
                      s->C ? ", B2GG = BSE" : ""));
  PetscCall(NastranNodes(s, &column.text));
  for (PetscInt t = 0; t < n; t++) {
    static const char *const names[] = {"KSE", "MSE", "BSE"};

    column.name   = names[t];
    column.column = -1;
    PetscCall(TextPrint(&column.text, "$ %s\nDMIG    %-8s%8d%8d%8d%8d\n", matrix[t].unit, names[t], 0, 6, 2, 0));
    PetscCall(TextForEach(matrix[t].A, NastranEntry, &column, &n_entries));
  }
  PetscCall(TextWrite(&column.text, s, results, "superelement.pch"));
  PetscFunctionReturn(0);
}
