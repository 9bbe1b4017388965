/*
   Tables of all rooms, one after another, for a visitor; what the command line gives and a run does not read.
*/
#include "row.h"
#include "base/text.h"
#include <string.h>

/* What a run does within an analysis */
static const struct {
  unsigned    bit;
  const char *words;
} within[] = {
  /* in the order of the bits */
  {RUN_EQUILIBRIUM,
   "-analysis static, modes, sweeps and frequency responses about the sliding state, and transients with "
   "-dynamics_start static"},
  {RUN_SLIDING, "modes, sweeps and frequency responses about the sliding state"},
  {RUN_IDENTIFY, "-..._kn identify"},
  {RUN_HOLDS, "equilibria with pairs that can stick, of contacts that are not told where to slide"},
  {RUN_WEIGHT, "scenes with -model_gravity"},
  {RUN_FACTORS, "analyses that factorise a matrix"},
  {RUN_HISTORY, "transients from their beginning to their end (-analysis transient, and cycle from one)"},
  {RUN_MESH, "transients of the mesh (-analysis transient, -dynamics_model full)"},
  {RUN_REDUCED, "-dynamics_model reduced"},
  {RUN_BODIES, "scenes with a mesh"},
  {RUN_CONTACTS, "scenes with -contacts"},
  {RUN_FIELDS, "-output_fields true"},
  {RUN_DAMPED, "modes with damping"},
  {RUN_UNDAMPED, "modes without damping"},
  {RUN_EPS, "eigenvalue problems that -eps_* solves"},
  {RUN_PEP, "eigenvalue problems that -pep_* solves"},
  {RUN_NAMED, "scenes with a mesh, and matrices with -operators_nodes"},
  {RUN_WEARS, "sweeps over wear_time"},
  {RUN_SPRINGS, "-dynamics_contact penalty"},
};

const char *RunBitWords(unsigned i)
{
  return i < N_ANALYSES + PETSC_STATIC_ARRAY_LENGTH(within) ? within[i - N_ANALYSES].words : NULL;
}

/* Who reads a row, in words: "-analysis modes, sweep and frf, and -dynamics_model reduced" */
static PetscErrorCode ReadersDescribe(unsigned in, size_t size, char text[])
{
  const char *before = "-analysis ";

  PetscFunctionBeginUser;
  text[0] = '\0';
  for (unsigned i = 0, rest = in % (1U << N_ANALYSES); rest; i++) {
    if (!(rest & 1U << i)) continue;
    rest &= ~(1U << i);
    PetscCall(WordsAdd(text, text[0] && !rest ? " and " : before, size));
    PetscCall(WordsAdd(text, AnalysisNames[i], size));
    before = ", ";
  }
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(within); i++) {
    if (!(in & within[i].bit)) continue;
    if (text[0]) PetscCall(WordsAdd(text, ", and ", size));
    PetscCall(WordsAdd(text, within[i].words, size));
  }
  PetscFunctionReturn(0);
}

/* The reason of an idle row, with the name of its owner in place of each @: "-@ramp" becomes "-press_ramp" */
static PetscErrorCode WhyName(const char why[], const char name[], size_t size, char text[])
{
  PetscFunctionBeginUser;
  text[0] = '\0';
  for (const char *at; (at = strchr(why, '@')); why = at + 1) {
    char part[QUANTITY_HELP];

    PetscCall(PetscSNPrintf(part, sizeof(part), "%.*s%s_", (int)(at - why), why, name ? name : ""));
    PetscCall(WordsAdd(text, part, size));
  }
  PetscCall(WordsAdd(text, why, size));
  PetscFunctionReturn(0);
}

/* Why a run does not read a row; empty where it does */
static PetscErrorCode RowExplain(const QuantityRun *run, const QuantityTable *table, const Quantity *row,
                                 const void *owner, size_t size, char why[])
{
  const unsigned    in     = row->in ? row->in : table->in;
  const char *const unread = row->in ? row->unread : table->unread;
  char              readers[QUANTITY_HELP];
  const char       *idle;

  PetscFunctionBeginUser;
  why[0] = '\0';
  if (in && !(in & run->does)) {
    PetscCall(ReadersDescribe(in, sizeof(readers), readers));
    PetscCall(PetscSNPrintf(why, size, "not used by -analysis %s%s%s", AnalysisNames[run->analysis],
                            unread ? unread : "; it belongs to ", unread ? "" : readers));
    PetscFunctionReturn(0);
  }
  idle = row->idle ? row->idle(owner, run) : NULL;
  if (idle) PetscCall(PetscStrncpy(why, idle, size));
  PetscFunctionReturn(0);
}

PetscErrorCode QuantitiesRefuse(const QuantityTable *table, const char name[], void *owner, const char unread[],
                                void *ctx)
{
  const QuantityRun *run = ctx;
  char               why[QUANTITY_HELP], text[QUANTITY_HELP], option[QUANTITY_HELP];
  PetscBool          refused;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < table->n; i++) {
    PetscCall(RowExplain(run, table, &table->row[i], owner, sizeof(why), why));
    if (!why[0] && !unread) continue;
    PetscCall(WhyName(why[0] ? why : unread, name, sizeof(text), text));
    PetscCall(QuantityGetOption(name, &table->row[i], sizeof(option), option));
    refused = PETSC_TRUE;
    if (table->row[i].always) PetscCall(OptionsFilesGive(run->comm, option, &refused));
    if (table->row[i].kind == QUANTITY_PREFIX)
      PetscCall(OptionsRefusePrefix(run->comm, option, text));
    else if (refused)
      PetscCall(OptionsRefuse(run->comm, option, text));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode QuantitiesReadVisited(const QuantityTable *table, const char name[], void *owner, const char why[],
                                     void *comm)
{
  PetscFunctionBeginUser;
  (void)why;
  PetscCall(QuantitiesReadOf(*(MPI_Comm *)comm, name, table, owner));
  PetscFunctionReturn(0);
}

PetscErrorCode QuantitiesSearch(const QuantityTable *table, const char name[], void *owner, const char why[], void *ctx)
{
  QuantitySearch *search = ctx;
  char            option[QUANTITY_HELP];

  PetscFunctionBeginUser;
  (void)owner;
  (void)why;
  for (PetscInt i = 0; i < table->n && !search->found; i++) {
    PetscCall(QuantityGetOption(name, &table->row[i], sizeof(option), option));
    PetscCall(PetscStrcasecmp(option + 1, search->option, &search->found));
    if (search->found) search->row = table->row[i]; /* tables may live as long as their visit */
  }
  PetscFunctionReturn(0);
}

PetscErrorCode QuantitiesVisit(const QuantityVisitor *v, const QuantityTable *table, const char name[], void *owner,
                               const char why[])
{
  PetscFunctionBeginUser;
  PetscCall((*v->table)(table, name, owner, why, v->ctx));
  PetscFunctionReturn(0);
}

PetscErrorCode QuantitiesVisitList(const QuantityVisitor *v, const QuantityList *list, PetscInt n, void *records)
{
  const Quantity      row   = {list->option, list->help, .kind = QUANTITY_NAMES};
  const QuantityTable names = {"Names in the scene", list->table->header, 1, &row, list->in, NULL};

  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisit(v, &names, NULL, NULL, NULL));
  for (PetscInt i = 0; i < n; i++) {
    void *record = (char *)records + (size_t)i * list->size;

    PetscCall(QuantitiesVisit(v, list->table, *(char **)record, record, NULL));
  }
  PetscFunctionReturn(0);
}
