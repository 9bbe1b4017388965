/*
   K_s(p) = sum_j c_j(p) T'A_j T and so on: superelement_term_1.bin, ... have the T'A_j T, superelement_terms.yaml is a
   scene of the superelement by itself, as -terms, in which each modulus, density or damping of its parts is a number
   that may be changed and swept; superelement_pieces.yaml has them for another scene, as pieces of one superelement,
   whose scales are the c_j. T is that of the values of the scene.
*/
#include "text.h"

/* "k1: {file: superelement_term_1.bin, kind: stiffness, ...}" of term t */
static PetscErrorCode TermPrint(const Substructure s, const OperatorsParameter parameter[], PetscInt t,
                                const Text *text)
{
  static const char *const kind[] = {
    [OPERATORS_STIFFNESS] = "stiffness", [OPERATORS_DAMPING] = "damping", [OPERATORS_MASS] = "mass"};
  const OperatorsTerm *term = s->body.term[t];

  PetscFunctionBeginUser;
  PetscCall(TextPrint(text,
                      "t%" PetscInt_FMT ": {file: superelement_term_%" PetscInt_FMT
                      ".bin, kind: %s, symmetry: symmetric, scale: %.17g",
                      t + 1, s->body.of_term[t] + 1, kind[term->kind], (double)term->scale));
  for (PetscInt i = 0; i < term->n; i++)
    PetscCall(TextPrint(text, "%s%s%s", i ? "," : ", parameter: \"", parameter[term->factor[i].parameter].name,
                        i + 1 < term->n ? "" : "\""));
  for (PetscInt i = 0; i < term->n; i++)
    PetscCall(TextPrint(text, "%s%" PetscInt_FMT "%s", i ? "," : ", power: \"", term->factor[i].power,
                        i + 1 < term->n ? "" : "\""));
  PetscCall(TextPrint(text, "}\n"));
  PetscFunctionReturn(0);
}

/* Values of the parameters that terms have, each once */
static PetscErrorCode ValuesPrint(const Substructure s, PetscInt n, const OperatorsParameter parameter[],
                                  const Text *text)
{
  PetscBool *used;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &used));
  for (PetscInt t = 0; t < s->body.n_terms; t++)
    for (PetscInt i = 0; i < s->body.term[t]->n; i++) used[s->body.term[t]->factor[i].parameter] = PETSC_TRUE;
  for (PetscInt i = 0; i < n; i++)
    if (used[i]) PetscCall(TextPrint(text, "%s: %.17g\n", parameter[i].name, (double)s->p[i]));
  PetscCall(PetscFree(used));
  PetscFunctionReturn(0);
}

/* Name of the piece of a term: its first factor, such as disc_young, with the number of the term where another one of
   its kind has it */
static PetscErrorCode TermPieceName(const Substructure s, const OperatorsParameter parameter[], PetscInt t, size_t size,
                                    char name[])
{
  const OperatorsTerm *term  = s->body.term[t];
  PetscBool            twice = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < s->body.n_terms && term->n; k++)
    if (k != t && s->body.term[k]->n && s->body.term[k]->factor[0].parameter == term->factor[0].parameter)
      twice = PETSC_TRUE;
  if (term->n)
    PetscCall(
      PetscSNPrintf(name, size, twice ? "%s_t%" PetscInt_FMT : "%s", parameter[term->factor[0].parameter].name, t + 1));
  else
    PetscCall(PetscSNPrintf(name, size, "t%" PetscInt_FMT, t + 1));
  PetscFunctionReturn(0);
}

static PetscErrorCode PiecesWrite(Substructure s, const OperatorsParameter parameter[], Results results)
{
  static const char letter[] = {[OPERATORS_STIFFNESS] = 'k', [OPERATORS_DAMPING] = 'c', [OPERATORS_MASS] = 'm'};
  char              name[160];
  Text              text;

  PetscFunctionBeginUser;
  PetscCall(TextCreate(s->comm, &text));
  PetscCall(TextPrint(&text,
                      "# a superelement of %s for another scene, in pieces; their scales are moduli (Pa), densities\n"
                      "# (kg/m^3) and damping, and products of these, which may be swept one by one\n",
                      s->n_parts == 1 ? s->parts[0] : "several parts"));
  PetscCall(TextPrint(&text, "superelements: \"made"));
  for (PetscInt t = 0; t < s->body.n_terms; t++) {
    PetscCall(TermPieceName(s, parameter, t, sizeof(name), name));
    PetscCall(TextPrint(&text, ",%s", name));
  }
  PetscCall(TextPrint(&text, "\"\nmade: {table: superelement_table.csv}\n"));
  for (PetscInt t = 0; t < s->body.n_terms; t++) {
    const char c = letter[s->body.term[t]->kind];

    PetscCall(TermPieceName(s, parameter, t, sizeof(name), name));
    PetscCall(TextPrint(&text, "%s: {of: made, %c: superelement_term_%" PetscInt_FMT ".bin, %c_scale: %.17g}\n", name,
                        c, s->body.of_term[t] + 1, c, (double)OperatorsTermCoefficient(s->body.term[t], s->p)));
  }
  PetscCall(TextWrite(&text, s, results, "superelement_pieces.yaml"));
  PetscFunctionReturn(0);
}

PetscErrorCode TermsWrite(Substructure s, Results results)
{
  const OperatorsParameter *parameter;
  PetscInt                  n;
  char                      name[64], parts[160];
  Text                      text;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(s->operators, &n, &parameter));
  for (PetscInt j = 0; j < s->body.n_matrices; j++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "superelement_term_%" PetscInt_FMT ".bin", j + 1));
    PetscCall(BinaryWrite(s, results, name, s->A[j]));
  }
  PetscCall(TextParts(s, sizeof(parts), parts));
  PetscCall(TextCreate(s->comm, &text));
  PetscCall(
    TextPrint(&text, "# superelement of %s by itself; superelement_table.csv says what its unknowns are\n", parts));
  PetscCall(TextPrint(&text, "terms: \""));
  for (PetscInt t = 0; t < s->body.n_terms; t++) PetscCall(TextPrint(&text, "%st%" PetscInt_FMT, t ? "," : "", t + 1));
  PetscCall(TextPrint(&text, "\"\n"));
  for (PetscInt t = 0; t < s->body.n_terms; t++) PetscCall(TermPrint(s, parameter, t, &text));
  PetscCall(ValuesPrint(s, n, parameter, &text));
  PetscCall(TextPrint(&text, "modes: {band: \"%.17g,%.17g\"}\n", (double)s->band[0], (double)s->band[1]));
  PetscCall(TextWrite(&text, s, results, "superelement_terms.yaml"));
  PetscCall(PiecesWrite(s, parameter, results));
  PetscFunctionReturn(0);
}
