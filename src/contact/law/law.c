/*
   Friction laws: the table of them, and what other rooms ask of one (include/squeal/frictionlaw.h). A new law is a
   file like coulombs.h, included here, and its row in the table. mu has no unit; s, the slip speed, is in m/s, and
   mu' = d mu / d s in s/m. A law is linearised about its stated speed: mu(s) near it is mu(speed) + mu'(speed) (s -
   speed).
*/
#include "coulombs.h"
#include "statickinetic.h"
#include "stribeck.h"
#include "tabled.h"
#include "base/text.h"
#include <string.h>

static const FrictionKind *const kinds[] = {&coulombs_law, &static_kinetic_law, &stribeck_law, &tabled_law};

/* of rubber on dry concrete; what is above it is more often a number in per cent */
#define LARGEST_MU 1.5
#define N_KINDS    ((PetscInt)PETSC_STATIC_ARRAY_LENGTH(kinds))

static const FrictionKind *KindOf(const FrictionLaw *law)
{
  return kinds[law->kind];
}

FrictionLaw FrictionAt(const FrictionLaw *law, PetscReal speed)
{
  FrictionLaw at = *law;

  at.speed = speed;
  return at;
}

FrictionLaw FrictionOfPair(const FrictionLaw *law, PetscReal speed, PetscReal area)
{
  FrictionLaw own = FrictionAt(law, speed);

  own.area = area;
  return own;
}

PetscBool FrictionNeedsPressure(const FrictionLaw *law)
{
  return KindOf(law)->rise ? PETSC_TRUE : PETSC_FALSE;
}

FrictionLaw FrictionPressed(const FrictionLaw *law, PetscReal force)
{
  FrictionLaw at = *law;

  at.pressure = force > 0 && law->area > 0 ? force / law->area : 0;
  return at;
}

PetscReal FrictionRise(const FrictionLaw *law, PetscReal s)
{
  return KindOf(law)->rise ? KindOf(law)->rise(law, s) : 0;
}

PetscBool FrictionCovers(const FrictionLaw *law, PetscReal s)
{
  const FrictionTable *t = &law->table;

  return !t->n_speeds || (s <= t->speed[t->n_speeds - 1] && law->pressure <= t->pressure[t->n_pressures - 1])
           ? PETSC_TRUE
           : PETSC_FALSE;
}

PetscErrorCode FrictionComplain(MPI_Comm comm, const char name[], const FrictionLaw *law, PetscReal t, PetscReal s,
                                PetscReal p)
{
  const FrictionTable *table    = &law->table;
  char                 when[64] = "";

  PetscFunctionBeginUser;
  if (t >= 0) PetscCall(PetscSNPrintf(when, sizeof(when), " at %.6g s", (double)t));
  SETERRQ(comm, PETSC_ERR_USER_INPUT,
          "contact%s%s: a pair slides at %.6g m/s under %.6g Pa%s, and the table of friction ends at %.6g m/s and %.6g "
          "Pa; give a larger one",
          name ? " " : "", name ? name : "", (double)s, (double)p, when, (double)table->speed[table->n_speeds - 1],
          (double)table->pressure[table->n_pressures - 1]);
}

PetscReal FrictionMu(const FrictionLaw *law, PetscReal s)
{
  return KindOf(law)->mu(law, s);
}

PetscReal FrictionSlope(const FrictionLaw *law, PetscReal s)
{
  return KindOf(law)->slope(law, s);
}

PetscReal FrictionSteady(const FrictionLaw *law)
{
  return FrictionMu(law, law->speed);
}

PetscReal FrictionSteadySlope(const FrictionLaw *law)
{
  return FrictionSlope(law, law->speed);
}

PetscReal FrictionSteadyTangent(const FrictionLaw *law)
{
  return FrictionSteady(law) + FrictionRise(law, law->speed);
}

void FrictionDerive(const FrictionLaw *law, FrictionDerivative *derivative)
{
  *derivative = (FrictionDerivative){.stated = {0}};
  KindOf(law)->derive(law, law->speed, derivative);
}

/* Whether any coefficient is not 0; a speed or a decay without a coefficient is no friction */
PetscBool FrictionExists(const FrictionLaw *law)
{
  for (PetscInt j = 0; j < KindOf(law)->n; j++)
    if (KindOf(law)->parameter[j].coefficient && law->parameter[j] != 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscBool FrictionVaries(const FrictionLaw *law)
{
  return KindOf(law)->varies(law);
}

PetscBool FrictionNeedsSpeed(const FrictionLaw *law)
{
  return !KindOf(law)->about && FrictionVaries(law) ? PETSC_TRUE : PETSC_FALSE;
}

PetscBool FrictionIsValid(const FrictionLaw *law)
{
  for (PetscInt j = 0; j < KindOf(law)->n; j++) {
    const FrictionParameter *q = &KindOf(law)->parameter[j];
    const PetscReal          x = law->parameter[j];

    if (PetscIsInfOrNanReal(x) || (q->coefficient && x < 0) || (!q->coefficient && q->row.bounded && x <= 0))
      return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* mu times a factor at all speeds: coefficients are factors of mu, speeds of the law stay */
void FrictionScale(FrictionLaw *law, PetscReal factor)
{
  for (PetscInt j = 0; j < KindOf(law)->n; j++)
    if (KindOf(law)->parameter[j].coefficient) law->parameter[j] *= factor;
}

PetscInt FrictionGetParameters(const FrictionLaw *law, const FrictionParameter **parameters)
{
  *parameters = KindOf(law)->parameter;
  return KindOf(law)->n;
}

/* Whether a law has a parameter of this name; laws may share names */
static PetscBool KindHas(const FrictionKind *kind, const char name[])
{
  for (PetscInt j = 0; j < kind->n; j++)
    if (!strcmp(kind->parameter[j].row.name, name)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Shows the rows of one law, a law of that kind their owner; of laws that were not chosen those that no other has
   shown, with the reason why nobody reads them */
static PetscErrorCode KindVisit(const char name[], const FrictionKind *chosen, FrictionOptions *read,
                                const QuantityVisitor *visitor)
{
  const FrictionLaw  *law  = &read->law;
  const FrictionKind *kind = KindOf(law);
  Quantity            row[FRICTION_PARAMETERS + 1];
  PetscInt            n_rows = 0;
  char                title[160], why[160];

  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < kind->n; j++) {
    const char *const own   = kind->parameter[j].row.name;
    PetscBool         shown = kind != chosen ? KindHas(chosen, own) : PETSC_FALSE;

    for (PetscInt k = 0; k < law->kind && kind != chosen && !shown; k++) shown = KindHas(kinds[k], own);
    if (!shown) row[n_rows++] = kind->parameter[j].row;
  }
  if (kind->file) row[n_rows++] = *kind->file;
  PetscCall(PetscSNPrintf(title, sizeof(title), "Friction by the law %s of contact", kind->name));
  PetscCall(PetscSNPrintf(why, sizeof(why), "not used with -@friction_law %s", chosen->name));
  PetscCall(QuantitiesVisit(visitor, &(QuantityTable){title, "frictionlaw.h", n_rows, row, .in = 0}, name, read,
                            kind == chosen ? NULL : why));
  PetscFunctionReturn(0);
}

/* A law of a kind with the defaults of its parameters */
static FrictionOptions KindBegin(PetscInt k)
{
  FrictionOptions begun = {.law = {.kind = k}};

  for (PetscInt j = 0; j < kinds[k]->n; j++) begun.law.parameter[j] = kinds[k]->parameter[j].row.initial;
  return begun;
}

/* Shows all laws, of the chosen kind its parameters, which the visitor may change, as the kind */
static PetscErrorCode KindsVisit(const char name[], FrictionOptions *read, const QuantityVisitor *visitor)
{
  const char    *word[N_KINDS + 1] = {NULL};
  int            chosen            = (int)read->law.kind;
  const Quantity row               = {"-friction_law",
                                      "how friction depends on the slip speed",
                                      NULL,
                                      QUANTITY_WORD,
                                      .size    = sizeof(chosen),
                                      .words   = word,
                                      .initial = 0};

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < N_KINDS; k++) word[k] = kinds[k]->name;
  PetscCall(QuantitiesVisit(visitor, &(QuantityTable){"Friction of contact", "frictionlaw.h", 1, &row, .in = 0}, name,
                            &chosen, NULL));
  if (read->law.kind != chosen) *read = KindBegin(chosen);
  for (PetscInt k = 0; k < N_KINDS; k++) {
    FrictionOptions other = KindBegin(k);

    PetscCall(KindVisit(name, kinds[chosen], k == chosen ? read : &other, visitor));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode FrictionVisit(const FrictionLaw *law, const char name[], const QuantityVisitor *visitor)
{
  FrictionOptions copy = {.law = *law};

  PetscFunctionBeginUser;
  PetscCall(KindsVisit(name, &copy, visitor));
  PetscFunctionReturn(0);
}

/* Takes out what files say of laws that were not chosen, with a warning */
static PetscErrorCode KindsDrop(MPI_Comm comm, const char name[], const FrictionLaw *chosen)
{
  char names[1024] = "";

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < N_KINDS; k++)
    for (PetscInt j = 0; j < kinds[k]->n + (kinds[k]->file ? 1 : 0); j++) {
      const char *const own = j < kinds[k]->n ? kinds[k]->parameter[j].row.name : kinds[k]->file->name;

      if (KindHas(KindOf(chosen), own) || kinds[k] == KindOf(chosen)) continue;
      PetscCall(TextAdd(names, own + 1, sizeof(names)));
      PetscCall(TextAdd(names, " ", sizeof(names)));
    }
  PetscCall(OptionsDropBeside(comm, name, names, "friction_law", KindOf(chosen)->name));
  PetscFunctionReturn(0);
}

/* Raises an error for a parameter that must be positive; a warning for what is odd */
static PetscErrorCode LawCheck(MPI_Comm comm, const char name[], const FrictionLaw *law)
{
  const FrictionKind *kind   = KindOf(law);
  const char         *remark = kind->remark ? kind->remark(law) : NULL;

  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < kind->n; j++) {
    const FrictionParameter *q = &kind->parameter[j];

    PetscCheck(q->coefficient || !q->row.bounded || law->parameter[j] > 0, comm, PETSC_ERR_USER_INPUT,
               "-%s_%s %.6g must be given and positive (%s) with -%s_friction_law %s", name, q->row.name + 1,
               (double)law->parameter[j], q->row.unit, name, kind->name);
  }
  if (remark) PetscCall(PetscFPrintf(comm, stderr, "squeal: warning: contact %s: %s\n", name, remark));
  PetscFunctionReturn(0);
}

PetscErrorCode FrictionSetFromOptions(MPI_Comm comm, const char name[], FrictionLaw *law)
{
  FrictionOptions read = KindBegin(0);

  PetscFunctionBeginUser;
  PetscCall(KindsVisit(name, &read, &(QuantityVisitor){QuantitiesReadVisited, &comm}));
  *law = read.law;
  PetscCall(KindsDrop(comm, name, law));
  if (KindOf(law)->file) PetscCall(FrictionReadTable(comm, name, read.file, law));
  PetscCall(LawCheck(comm, name, law));
  PetscFunctionReturn(0);
}

PetscErrorCode FrictionCheckNotNegative(MPI_Comm comm, const char name[], const FrictionLaw *law)
{
  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < KindOf(law)->n; j++) {
    const FrictionParameter *q = &KindOf(law)->parameter[j];

    PetscCheck(!q->coefficient || law->parameter[j] >= 0, comm, PETSC_ERR_USER_INPUT,
               "-%s_%s %.6g must not be negative", name, q->row.name + 1, (double)law->parameter[j]);
  }
  PetscFunctionReturn(0);
}

/* The largest coefficient of a table, 1 without */
static double TableLargest(const FrictionTable *t)
{
  double largest = 0;

  for (PetscInt i = 0; i < t->n_speeds * t->n_pressures; i++) largest = PetscMax(largest, (double)t->mu[i]);
  return t->n_speeds ? largest : 1;
}

PetscErrorCode FrictionWarnLarge(MPI_Comm comm, const char name[], const FrictionLaw *law)
{
  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < KindOf(law)->n; j++) {
    const FrictionParameter *q  = &KindOf(law)->parameter[j];
    const double             mu = (double)law->parameter[j] * TableLargest(&law->table);

    if (q->coefficient && !q->row.unit && PetscAbsReal(mu) > LARGEST_MU)
      PetscCall(PetscFPrintf(comm, stderr, "squeal: warning: -%s_%s %.6g is above %g; in per cent? %.6g %% are %.6g\n",
                             name, q->row.name + 1, mu, LARGEST_MU, mu, mu / 100));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode FrictionView(const FrictionLaw *law, PetscViewer viewer)
{
  const char *comma = "";

  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < KindOf(law)->n; j++) {
    const FrictionParameter *q = &KindOf(law)->parameter[j];

    if (!q->coefficient && law->parameter[j] == 0) continue;
    PetscCall(PetscViewerASCIIPrintf(viewer, "%s%s %.6g%s%s", comma, q->row.name + 1, (double)law->parameter[j],
                                     q->row.unit ? " " : "", q->row.unit ? q->row.unit : ""));
    comma = ", ";
  }
  if (law->table.n_speeds)
    PetscCall(PetscViewerASCIIPrintf(viewer, " of a table of %" PetscInt_FMT " speeds and %" PetscInt_FMT " pressures",
                                     law->table.n_speeds, law->table.n_pressures));
  PetscFunctionReturn(0);
}

PetscErrorCode FrictionAddChecksum(const FrictionLaw *law, Checksum checksum)
{
  const PetscInt kind = (PetscInt)law->kind;

  PetscFunctionBeginUser;
  PetscCall(ChecksumAddInts(checksum, 1, &kind));
  PetscCall(ChecksumAddReals(checksum, KindOf(law)->n, law->parameter));
  PetscCall(ChecksumAddReals(checksum, law->table.n_speeds, law->table.speed));
  PetscCall(ChecksumAddReals(checksum, law->table.n_pressures, law->table.pressure));
  PetscCall(ChecksumAddReals(checksum, law->table.n_speeds * law->table.n_pressures, law->table.mu));
  PetscFunctionReturn(0);
}

PetscErrorCode FrictionDestroy(FrictionLaw *law)
{
  void *block = (void *)law->table.speed;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(block));
  law->table = (FrictionTable){.n_speeds = 0};
  PetscFunctionReturn(0);
}
