/*
   Rows as JSON: what scripts know of options, completion, the manual page and the reference of options among them.

     {"program": "squeal", "version": "0.1.0", "options": [
     {"name": "sweep_rtol", "owner": null, "group": "Sweep", "room": "sweep", "help": "...", "unit": null, "type":
      "real", "path": null, "default": 1e-06, "required": false, "least": 0, "most": 1, "open": true, "choices": null, "analyses":
      ["sweep"], "where": [], "conditional": true, "restart": false, "varies": []}, ...]}

   one option a line. owner: the name in the scene that stands before the option. analyses, where: it is read by runs
   that are, or do, one of them; conditional: and where other options want it. varies: analyses that may vary it.
*/
#include "row.h"
#include <string.h>

static const char *const kinds[] = {
  [QUANTITY_INT] = "integer",   [QUANTITY_REAL] = "real",     [QUANTITY_REALS] = "reals",  [QUANTITY_LIST] = "reals",
  [QUANTITY_INTS] = "integers", [QUANTITY_MANY] = "reals",    [QUANTITY_BOOL] = "logical", [QUANTITY_WORD] = "word",
  [QUANTITY_TEXT] = "text",     [QUANTITY_NAME] = "text",     [QUANTITY_NAMES] = "texts",  [QUANTITY_PATH] = "path",
  [QUANTITY_VIEWER] = "viewer", [QUANTITY_PREFIX] = "prefix",
};

/* A text in quotes, null for none */
static PetscErrorCode JsonText(MPI_Comm comm, const char text[])
{
  char   quoted[2 * QUANTITY_HELP];
  size_t n = 0;

  PetscFunctionBeginUser;
  for (const char *c = text; c && *c && n < sizeof(quoted) - 3; c++) {
    if (strchr("\"\\", *c)) quoted[n++] = '\\';
    quoted[n++] = *c;
  }
  quoted[n] = '\0';
  if (text)
    PetscCall(PetscPrintf(comm, "\"%s\"", quoted));
  else
    PetscCall(PetscPrintf(comm, "null"));
  PetscFunctionReturn(0);
}

/* Begins a member of an object */
static PetscErrorCode JsonMember(MPI_Comm comm, const char name[], const char text[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscPrintf(comm, ", \"%s\": ", name));
  PetscCall(JsonText(comm, text));
  PetscFunctionReturn(0);
}

static PetscErrorCode JsonLogical(MPI_Comm comm, const char name[], PetscBool value)
{
  PetscFunctionBeginUser;
  PetscCall(PetscPrintf(comm, ", \"%s\": %s", name, value ? "true" : "false"));
  PetscFunctionReturn(0);
}

/* The values of a list: those of its text, zeros of one of a given length */
static PetscErrorCode JsonList(MPI_Comm comm, const Quantity *row)
{
  const size_t   size = row->kind == QUANTITY_INTS ? sizeof(PetscInt) : sizeof(PetscReal);
  const PetscInt n    = row->kind == QUANTITY_MANY || row->count || row->given ? 0 : (PetscInt)(row->size / size);

  PetscFunctionBeginUser;
  if (row->text && row->text[0]) {
    PetscCall(PetscPrintf(comm, "[%s]", row->text));
    PetscFunctionReturn(0);
  }
  for (PetscInt i = 0; i < n; i++) PetscCall(PetscPrintf(comm, i ? ", 0" : "[0"));
  PetscCall(PetscPrintf(comm, n ? "]" : "null"));
  PetscFunctionReturn(0);
}

/* What the option is where it is not given */
static PetscErrorCode JsonDefault(MPI_Comm comm, const Quantity *row)
{
  const PetscBool refused = row->bounded && row->open && !row->none && row->initial == row->least; /* stands for none */
  PetscInt        n_words = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscPrintf(comm, ", \"default\": "));
  if (row->required || (row->kind <= QUANTITY_REAL && refused))
    PetscCall(JsonText(comm, NULL));
  else if (row->kind == QUANTITY_INT || row->kind == QUANTITY_REAL)
    PetscCall(PetscPrintf(comm, "%.15g", (double)row->initial));
  else if (row->kind == QUANTITY_BOOL)
    PetscCall(PetscPrintf(comm, row->initial != 0 ? "true" : "false"));
  else if (row->kind == QUANTITY_WORD) {
    while (row->words[n_words]) n_words++;
    PetscCall(JsonText(comm, row->initial < n_words ? row->words[(PetscInt)row->initial] : NULL));
  } else if (row->kind <= QUANTITY_MANY)
    PetscCall(JsonList(comm, row));
  else
    PetscCall(JsonText(comm, row->text && row->text[0] ? row->text : NULL));
  PetscFunctionReturn(0);
}

/* Limits, the words of a choice */
static PetscErrorCode JsonLimits(MPI_Comm comm, const Quantity *row)
{
  PetscFunctionBeginUser;
  if (row->bounded)
    PetscCall(PetscPrintf(comm, ", \"least\": %.15g, \"most\": ", (double)row->least));
  else
    PetscCall(PetscPrintf(comm, ", \"least\": null, \"most\": "));
  if (row->bounded && row->most != 0)
    PetscCall(PetscPrintf(comm, "%.15g", (double)row->most));
  else
    PetscCall(PetscPrintf(comm, "null"));
  PetscCall(JsonLogical(comm, "open", row->open && !row->none ? PETSC_TRUE : PETSC_FALSE));
  PetscCall(PetscPrintf(comm, ", \"choices\": %s", row->words ? "[" : "null"));
  for (PetscInt i = 0; row->words && row->words[i]; i++) {
    if (i) PetscCall(PetscPrintf(comm, ", "));
    PetscCall(JsonText(comm, row->words[i]));
  }
  if (row->words) PetscCall(PetscPrintf(comm, "]"));
  PetscFunctionReturn(0);
}

/* Which runs read it */
static PetscErrorCode JsonReaders(MPI_Comm comm, unsigned in)
{
  const char *words, *comma = "";

  PetscFunctionBeginUser;
  PetscCall(PetscPrintf(comm, ", \"analyses\": ["));
  for (unsigned i = 0; i < N_ANALYSES; i++)
    if (!in || in & 1U << i) {
      PetscCall(PetscPrintf(comm, "%s", comma));
      PetscCall(JsonText(comm, AnalysisNames[i]));
      comma = ", ";
    }
  PetscCall(PetscPrintf(comm, "], \"where\": ["));
  comma = "";
  for (unsigned i = N_ANALYSES; (words = RunBitWords(i)); i++)
    if (in & 1U << i) {
      PetscCall(PetscPrintf(comm, "%s", comma));
      PetscCall(JsonText(comm, words));
      comma = ", ";
    }
  PetscCall(PetscPrintf(comm, "]"));
  PetscFunctionReturn(0);
}

/* One row; name is that of its owner, list the option that gives it */
static PetscErrorCode JsonRow(QuantityJson *json, const QuantityTable *table, const Quantity *row, const char name[])
{
  const MPI_Comm comm = json->comm;
  char           option[QUANTITY_HELP], room[64];

  PetscFunctionBeginUser;
  PetscCall(QuantityGetOption(name, row, sizeof(option), option));
  PetscCall(PetscSNPrintf(room, sizeof(room), "%.*s", (int)strcspn(table->header, "."), table->header));
  PetscCall(PetscPrintf(comm, "%s\n  {\"name\": \"%s\"", json->n++ ? "," : "", option + 1));
  PetscCall(JsonMember(comm, "owner", name));
  PetscCall(JsonMember(comm, "group", table->title));
  PetscCall(JsonMember(comm, "room", room));
  PetscCall(JsonMember(comm, "help", row->help));
  PetscCall(JsonMember(comm, "unit", row->unit));
  PetscCall(JsonMember(comm, "type", kinds[row->kind]));
  PetscCall(JsonMember(comm, "path", row->path));
  PetscCall(JsonDefault(comm, row));
  PetscCall(JsonLogical(comm, "required", row->required));
  PetscCall(JsonLimits(comm, row));
  PetscCall(JsonReaders(comm, row->in ? row->in : table->in));
  PetscCall(JsonLogical(comm, "conditional", row->idle ? PETSC_TRUE : PETSC_FALSE));
  PetscCall(JsonLogical(comm, "restart", row->restart));
  PetscCall(PetscPrintf(comm, ", \"varies\": [%s%s%s]", row->varies & VARIES_LINEAR ? "\"sweep\"" : "",
                        (row->varies & VARIES_ALL) == VARIES_ALL ? ", " : "",
                        row->varies & VARIES_IN_TIME ? "\"map\", \"cycle\"" : ""));
  PetscCall(PetscPrintf(comm, "}"));
  PetscFunctionReturn(0);
}

PetscErrorCode QuantitiesBeginJson(QuantityJson *json)
{
  PetscFunctionBeginUser;
  json->n = 0;
  PetscCall(PetscPrintf(json->comm, "{\"program\": \"squeal\", \"version\": \"" SQUEAL_VERSION "\", \"options\": ["));
  PetscFunctionReturn(0);
}

PetscErrorCode QuantitiesWriteJson(const QuantityTable *table, const char name[], void *owner, const char why[],
                                   void *json)
{
  PetscFunctionBeginUser;
  (void)owner;
  (void)why;
  for (PetscInt i = 0; i < table->n; i++)
    if (table->row[i].kind != QUANTITY_PREFIX) PetscCall(JsonRow(json, table, &table->row[i], name));
  PetscFunctionReturn(0);
}

PetscErrorCode QuantitiesEndJson(QuantityJson *json)
{
  PetscFunctionBeginUser;
  PetscCall(PetscPrintf(json->comm, "\n]}\n"));
  PetscFunctionReturn(0);
}
