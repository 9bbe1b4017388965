/*
   Pressure laws: the table of them, and what other rooms ask of one (include/squeal/pressurelaw.h). A new law is a file
   like exponential.h, included here, and its row in the table. c is the closing in m, P(c) in Pa, P'(c) in N/m^3; below
   the onset both are 0.
*/
#include "exponential.h"
#include "linear.h"
#include "power.h"
#include "table.h"
#include "base/text.h"

static const PressureKind *const pressures[] = {&linear_pressure, &exponential_pressure, &power_pressure,
                                                &table_pressure};

#define N_PRESSURES ((PetscInt)PETSC_STATIC_ARRAY_LENGTH(pressures))

static const PressureKind *PressureKindOf(const PressureLaw *law)
{
  return pressures[law->kind];
}

PressureLaw PressureLinear(PetscReal k)
{
  return (PressureLaw){.kind = 0, .parameter = {k}};
}

PetscBool PressureIsLinear(const PressureLaw *law)
{
  return law->kind == 0 ? PETSC_TRUE : PETSC_FALSE;
}

PetscReal PressureOnset(const PressureLaw *law)
{
  return PressureKindOf(law)->onset(law);
}

PetscReal PressureAt(const PressureLaw *law, PetscReal c)
{
  return c > PressureOnset(law) ? PressureKindOf(law)->pressure(law, c) : 0;
}

PetscReal PressureSlope(const PressureLaw *law, PetscReal c)
{
  return c >= PressureOnset(law) ? PressureKindOf(law)->slope(law, c) : 0;
}

PetscReal PressureClosing(const PressureLaw *law, PetscReal p)
{
  return p > 0 ? PressureKindOf(law)->closing(law, p) : PressureOnset(law);
}

PetscReal PressureEnergy(const PressureLaw *law, PetscReal c)
{
  return c > PressureOnset(law) && !PetscIsInfReal(c) ? PressureKindOf(law)->energy(law, c) : 0;
}

PetscInt PressureGetParameters(const PressureLaw *law, const Quantity **rows)
{
  *rows = PressureKindOf(law)->row;
  return PressureKindOf(law)->n;
}

const char *PressureGetName(const PressureLaw *law)
{
  return PressureKindOf(law)->name;
}

/* Shows all laws, of the chosen kind its parameters, which the visitor may change, as the kind; those of others with
   the reason why nobody reads them */
static PetscErrorCode PressuresVisit(const char name[], PressureOptions *read, const QuantityVisitor *visitor)
{
  const char    *word[N_PRESSURES + 1] = {NULL};
  int            chosen                = (int)read->law.kind;
  const Quantity row                   = {"-pressure_law",
                                          "penalty: how the pressure depends on the closing",
                                          NULL,
                                          QUANTITY_WORD,
                                          .size   = sizeof(chosen),
                                          .words  = word,
                                          .in     = RUN_LINEAR | RUN_STATIC | RUN_SPRINGS,
                                          .unread = PRESSURE_EXACT};
  char           title[160], why[160];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < N_PRESSURES; k++) word[k] = pressures[k]->name;
  PetscCall(QuantitiesVisit(visitor, &(QuantityTable){"Pressure of contact", "pressurelaw.h", 1, &row, .in = 0}, name,
                            &chosen, NULL));
  PetscCall(PetscSNPrintf(why, sizeof(why), "not used with -@pressure_law %s", pressures[chosen]->name));
  for (PetscInt k = 0; k < N_PRESSURES; k++) {
    const QuantityTable table = {title, "pressurelaw.h", pressures[k]->n_rows, pressures[k]->row, .in = 0};
    PressureOptions     other = {.law = {.kind = k}};

    PetscCall(PetscSNPrintf(title, sizeof(title), "Pressure by the law %s of contact", pressures[k]->name));
    PetscCall(QuantitiesInit(&table, &other));
    if (k == chosen && read->law.kind != chosen) *read = other;
    if (pressures[k]->n_rows)
      PetscCall(QuantitiesVisit(visitor, &table, name, k == chosen ? read : &other, k == chosen ? NULL : why));
    if (k != chosen) PetscCall(PressureDestroy(&other.law));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PressureVisit(const PressureLaw *law, const char name[], const QuantityVisitor *visitor)
{
  PressureOptions read = {.law = *law};

  PetscFunctionBeginUser;
  PetscCall(PressuresVisit(name, &read, visitor));
  PetscFunctionReturn(0);
}

/* Takes out what files say of laws that were not chosen, with a warning */
static PetscErrorCode PressuresDrop(MPI_Comm comm, const char name[], const PressureLaw *chosen)
{
  char names[1024] = "";

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < N_PRESSURES; k++)
    for (PetscInt j = 0; j < pressures[k]->n_rows && k != chosen->kind; j++) {
      PetscCall(TextAdd(names, pressures[k]->row[j].name + 1, sizeof(names)));
      PetscCall(TextAdd(names, " ", sizeof(names)));
    }
  PetscCall(OptionsDropBeside(comm, name, names, "pressure_law", PressureKindOf(chosen)->name));
  PetscFunctionReturn(0);
}

PetscErrorCode PressureSetFromOptions(MPI_Comm comm, const char name[], PressureLaw *law)
{
  PressureOptions read = {.law = {.kind = 0}};

  PetscFunctionBeginUser;
  PetscCall(PressuresVisit(name, &read, &(QuantityVisitor){QuantitiesReadVisited, &comm}));
  *law = read.law;
  PetscCall(PressuresDrop(comm, name, law));
  if (PressureKindOf(law) == &table_pressure) PetscCall(PressurePointsSet(comm, name, read.file, law));
  for (PetscInt j = 0; j < PressureKindOf(law)->n; j++) {
    const Quantity *row = &PressureKindOf(law)->row[j];

    PetscCheck(law->parameter[j] > 0, comm, PETSC_ERR_USER_INPUT,
               "-%s_%s %.6g must be given and positive (%s) with -%s_pressure_law %s", name, row->name + 1,
               (double)law->parameter[j], row->unit ? row->unit : "without unit", name, PressureKindOf(law)->name);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PressureView(const PressureLaw *law, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  PetscCall(PetscViewerASCIIPrintf(viewer, "pressure %s", PressureKindOf(law)->name));
  for (PetscInt j = 0; j < PressureKindOf(law)->n; j++)
    PetscCall(PetscViewerASCIIPrintf(viewer, ", %s %.6g", PressureKindOf(law)->row[j].name + sizeof("-pressure_") - 1,
                                     (double)law->parameter[j]));
  if (law->n_points) PetscCall(PetscViewerASCIIPrintf(viewer, " of %" PetscInt_FMT " points", law->n_points));
  if (law->n_points && law->parameter[TABLE_THICKNESS] > 0)
    PetscCall(PetscViewerASCIIPrintf(viewer, " of the strain of a lining %.6g thick", (double)law->parameter[0]));
  PetscFunctionReturn(0);
}

PetscErrorCode PressureAddChecksum(const PressureLaw *law, Checksum checksum)
{
  const PetscInt kind = (PetscInt)law->kind;

  PetscFunctionBeginUser;
  PetscCall(ChecksumAddInts(checksum, 1, &kind));
  PetscCall(ChecksumAddReals(checksum, PressureKindOf(law)->n, law->parameter));
  PetscCall(ChecksumAddReals(checksum, 2 * law->n_points, law->point));
  PetscFunctionReturn(0);
}

PetscErrorCode PressureDestroy(PressureLaw *law)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(law->point));
  PetscFunctionReturn(0);
}
