/*
   Pressure laws: the table of them, and what other rooms ask of one (include/squeal/pressurelaw.h). A new law is a file
   like exponential.h, included here, and its row in the table. c is the closing in m, P(c) in Pa, P'(c) in N/m^3; below
   the onset both are 0.
*/
#include "exponential.h"
#include "linear.h"
#include "power.h"

static const PressureKind *const kinds[] = {&linear_pressure, &exponential_pressure, &power_pressure};

#define N_KINDS ((PetscInt)PETSC_STATIC_ARRAY_LENGTH(kinds))

static const PressureKind *KindOf(const PressureLaw *law)
{
  return kinds[law->kind];
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
  return KindOf(law)->onset(law);
}

PetscReal PressureAt(const PressureLaw *law, PetscReal c)
{
  return c > PressureOnset(law) ? KindOf(law)->pressure(law, c) : 0;
}

PetscReal PressureSlope(const PressureLaw *law, PetscReal c)
{
  return c >= PressureOnset(law) ? KindOf(law)->slope(law, c) : 0;
}

PetscReal PressureClosing(const PressureLaw *law, PetscReal p)
{
  return p > 0 ? KindOf(law)->closing(law, p) : PressureOnset(law);
}

PetscInt PressureGetParameters(const PressureLaw *law, const Quantity **rows)
{
  *rows = KindOf(law)->row;
  return KindOf(law)->n;
}

const char *PressureGetName(const PressureLaw *law)
{
  return KindOf(law)->name;
}

/* Shows all laws, of the chosen kind its parameters, which the visitor may change, as the kind */
static PetscErrorCode KindsVisit(const char name[], PressureLaw *law, const QuantityVisitor *visitor)
{
  const char    *word[N_KINDS + 1] = {NULL};
  int            chosen            = (int)law->kind;
  const Quantity row               = {"-pressure_law",
                                      "penalty: how the pressure depends on the closing",
                                      NULL,
                                      QUANTITY_WORD,
                                      .size   = sizeof(chosen),
                                      .words  = word,
                                      .in     = RUN_LINEAR | RUN_STATIC,
                                      .unread = ", whose contact is exact: no penalty, no linearisation"};
  char           title[160];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < N_KINDS; k++) word[k] = kinds[k]->name;
  PetscCall(QuantitiesVisit(visitor, &(QuantityTable){"Pressure of contact", "pressurelaw.h", 1, &row, .in = 0}, name,
                            &chosen, NULL));
  for (PetscInt k = 0; k < N_KINDS; k++) {
    const QuantityTable table = {title, "pressurelaw.h", kinds[k]->n, kinds[k]->row, .in = 0};
    PressureLaw         other = {.kind = k};

    if (!kinds[k]->n && k != chosen) continue;
    PetscCall(PetscSNPrintf(title, sizeof(title), "Pressure by the law %s of contact", kinds[k]->name));
    PetscCall(QuantitiesInit(&table, &other));
    if (k == chosen && law->kind != chosen) *law = other;
    if (kinds[k]->n) PetscCall(QuantitiesVisit(visitor, &table, name, k == chosen ? law : &other, NULL));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PressureVisit(const PressureLaw *law, const char name[], const QuantityVisitor *visitor)
{
  PressureLaw copy = *law;

  PetscFunctionBeginUser;
  PetscCall(KindsVisit(name, &copy, visitor));
  PetscFunctionReturn(0);
}

/* Refuses parameters of laws that were not chosen; those of files are taken out, with a warning */
static PetscErrorCode KindsRefuse(MPI_Comm comm, const char name[], const PressureLaw *chosen)
{
  char why[256], instead[256], option[256];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(why, sizeof(why), "not used with -%s_pressure_law %s", name, KindOf(chosen)->name));
  PetscCall(PetscSNPrintf(instead, sizeof(instead), "-%s_pressure_law is %s", name, KindOf(chosen)->name));
  for (PetscInt k = 0; k < N_KINDS; k++)
    for (PetscInt j = 0; j < kinds[k]->n && k != chosen->kind; j++) {
      const char *const own = kinds[k]->row[j].name + 1;

      PetscCall(OptionsRefuseOf(comm, name, own, why));
      PetscCall(PetscSNPrintf(option, sizeof(option), "-%s_%s", name, own));
      PetscCall(OptionsDrop(comm, option, instead));
    }
  PetscFunctionReturn(0);
}

PetscErrorCode PressureSetFromOptions(MPI_Comm comm, const char name[], PressureLaw *law)
{
  PetscFunctionBeginUser;
  *law = (PressureLaw){.kind = 0};
  PetscCall(KindsVisit(name, law, &(QuantityVisitor){QuantitiesReadVisited, &comm}));
  PetscCall(KindsRefuse(comm, name, law));
  for (PetscInt j = 0; j < KindOf(law)->n; j++) {
    const Quantity *row = &KindOf(law)->row[j];

    PetscCheck(law->parameter[j] > 0, comm, PETSC_ERR_USER_INPUT,
               "-%s_%s %.6g must be given and positive (%s) with -%s_pressure_law %s", name, row->name + 1,
               (double)law->parameter[j], row->unit ? row->unit : "without unit", name, KindOf(law)->name);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PressureView(const PressureLaw *law, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  PetscCall(PetscViewerASCIIPrintf(viewer, "pressure %s", KindOf(law)->name));
  for (PetscInt j = 0; j < KindOf(law)->n; j++)
    PetscCall(PetscViewerASCIIPrintf(viewer, ", %s %.6g", KindOf(law)->row[j].name + sizeof("-pressure_") - 1,
                                     (double)law->parameter[j]));
  PetscFunctionReturn(0);
}

PetscErrorCode PressureAddChecksum(const PressureLaw *law, Checksum checksum)
{
  const PetscInt kind = (PetscInt)law->kind;

  PetscFunctionBeginUser;
  PetscCall(ChecksumAddInts(checksum, 1, &kind));
  PetscCall(ChecksumAddReals(checksum, KindOf(law)->n, law->parameter));
  PetscFunctionReturn(0);
}
