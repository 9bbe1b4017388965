/*
   Abaqus: superelement.inp with *NODE of the interface, a node in the origin with direction 1 alone for each modal
   coordinate and what is kept inside, *MATRIX INPUT and *MATRIX ASSEMBLE; superelement_abaqus_k.mtx and so on, row
   node, direction, column node, direction and value of the lower half, all 17 digits.
*/
#include "text.h"

/* A matrix that is being written */
typedef struct {
  Text         text;
  Substructure s;
} AbaqusMatrix;

static PetscErrorCode AbaqusEntry(void *ctx, PetscInt i, PetscInt j, PetscReal value)
{
  AbaqusMatrix *matrix = ctx;
  PetscInt      node[2], direction[2];

  PetscFunctionBeginUser;
  TextPlace(matrix->s, i, &node[0], &direction[0]);
  TextPlace(matrix->s, j, &node[1], &direction[1]);
  PetscCall(TextPrint(&matrix->text, "%" PetscInt_FMT ",%" PetscInt_FMT ",%" PetscInt_FMT ",%" PetscInt_FMT ",%.17g\n",
                      node[0], PetscMax(1, direction[0]), node[1], PetscMax(1, direction[1]), (double)value));
  PetscFunctionReturn(0);
}

static PetscErrorCode AbaqusNodes(const Substructure s, const Text *text)
{
  PetscFunctionBeginUser;
  PetscCall(TextPrint(text, "*NODE, NSET=SUPERELEMENT_INTERFACE\n"));
  for (PetscInt k = 0; k < s->interface.n; k++) {
    const InterfaceRow *row = &s->interface.row[k];

    if (k && row->node == row[-1].node) continue;
    PetscCall(TextPrint(text, "%" PetscInt_FMT ",%.17g,%.17g,%.17g\n", row->node, (double)row->x[0], (double)row->x[1],
                        (double)row->x[2]));
  }
  if (s->n > s->interface.n) PetscCall(TextPrint(text, "*NODE, NSET=SUPERELEMENT_INTERNAL\n"));
  for (PetscInt k = s->interface.n; k < s->n; k++)
    PetscCall(TextPrint(text, "%" PetscInt_FMT ",0,0,0\n", s->interface.n_nodes + 1 + k - s->interface.n));
  PetscFunctionReturn(0);
}

PetscErrorCode AbaqusWrite(Substructure s, Results results)
{
  static const char *const names[] = {"SE_K", "SE_M", "SE_C"};
  TextMatrix               matrix[3];
  const PetscInt           n = TextMatrices(s, matrix);
  char                     parts[160];
  Text                     deck;

  PetscFunctionBeginUser;
  PetscCall(TextParts(s, sizeof(parts), parts));
  PetscCall(TextCreate(s->comm, &deck));
  PetscCall(TextPrint(&deck, "** superelement of %s\n", parts));
  PetscCall(AbaqusNodes(s, &deck));
  for (PetscInt t = 0; t < n; t++) {
    char         name[64];
    AbaqusMatrix one = {.s = s};
    PetscInt     n_entries;

    PetscCall(PetscSNPrintf(name, sizeof(name), "superelement_abaqus_%c.mtx", matrix[t].letter));
    PetscCall(TextPrint(&deck, "*MATRIX INPUT, NAME=%s, INPUT=%s\n", names[t], name));
    PetscCall(TextCreate(s->comm, &one.text));
    PetscCall(TextPrint(&one.text, "** %s\n", matrix[t].unit));
    PetscCall(TextForEach(matrix[t].A, AbaqusEntry, &one, &n_entries));
    PetscCall(TextWrite(&one.text, s, results, name));
  }
  PetscCall(TextPrint(&deck, "*MATRIX ASSEMBLE, STIFFNESS=SE_K, MASS=SE_M%s\n", s->C ? ", VISCOUS DAMPING=SE_C" : ""));
  PetscCall(TextWrite(&deck, s, results, "superelement.inp"));
  PetscFunctionReturn(0);
}
