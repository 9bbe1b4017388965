/* Files of a superelement: the table of its unknowns, its modes with their errors, and its matrices */
#include "files/text.h"
#include <string.h>

/* As -NAME_table of a superelement reads it, each number as it is */
static PetscErrorCode SubstructureWriteTable(Substructure s, Results results)
{
  ResultsTable table;

  PetscFunctionBeginUser;
  PetscCall(ResultsTableOpen(results, "superelement_table", "unknown,node,direction,x,y,z", &table));
  for (PetscInt k = 0; k < s->interface.n; k++) {
    const InterfaceRow *row = &s->interface.row[k];

    PetscCall(ResultsTableRow(table, "%" PetscInt_FMT ",%" PetscInt_FMT ",%c,%.17g,%.17g,%.17g", k + 1, row->node,
                              "xyz"[row->direction], (double)row -> x[0], (double)row -> x[1], (double)row -> x[2]));
  }
  for (PetscInt k = s->interface.n; k < s->n; k++)
    PetscCall(ResultsTableRow(table, "%" PetscInt_FMT ",0,internal,,,", k + 1));
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

static PetscErrorCode SubstructureWriteModes(Substructure s, Results results)
{
  ResultsTable table;
  PetscInt     number = 0;

  PetscFunctionBeginUser;
  PetscCall(ResultsTableOpen(results, "superelement", "interface,mode,freq_hz,error_hz,relative_error", &table));
  for (PetscInt k = 0; k < s->n_modes; k++) {
    const SubstructureMode *mode = &s->mode[k];

    number = k && mode->held == s->mode[k - 1].held ? number + 1 : 1;
    PetscCall(ResultsTableRow(table, "%s,%" PetscInt_FMT ",%.15g,%.15g,%.15g", mode->held ? "held" : "free", number,
                              (double)mode->frequency, (double)mode->error,
                              (double)(mode->frequency > 0 ? mode->error / mode->frequency : 0)));
  }
  if (s->any >= 0)
    PetscCall(ResultsTableRow(table, "any,0,%.15g,%.15g,%.15g", (double)s->band[1], (double)(s->any * s->band[1]),
                              (double)s->any));
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

/* Whether a format is asked for: squeal's own where none is named */
static PetscBool SubstructureHasFormat(const Substructure s, const char format[])
{
  for (PetscInt i = 0; i < s->n_formats; i++)
    if (!strcmp(s->formats[i], format)) return PETSC_TRUE;
  return s->n_formats ? PETSC_FALSE : (PetscBool)!strcmp(format, "squeal");
}

PetscErrorCode SubstructureWrite(Substructure s, Results results)
{
  PetscFunctionBeginUser;
  if (SubstructureHasFormat(s, "squeal")) {
    PetscCall(BinaryWrite(s, results, "superelement_k.bin", s->K));
    PetscCall(BinaryWrite(s, results, "superelement_m.bin", s->M));
    PetscCall(BinaryWrite(s, results, "superelement_c.bin", s->C));
    PetscCall(TermsWrite(s, results));
  }
  if (SubstructureHasFormat(s, "market")) PetscCall(MarketWrite(s, results));
  if (SubstructureHasFormat(s, "nastran")) PetscCall(NastranWrite(s, results));
  if (SubstructureHasFormat(s, "abaqus")) PetscCall(AbaqusWrite(s, results));
  PetscCall(SubstructureWriteTable(s, results));
  PetscCall(SubstructureWriteModes(s, results));
  PetscFunctionReturn(0);
}
