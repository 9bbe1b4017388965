/*
   The reduced model as a file, reduced_model.bin, for who computes with it elsewhere, as the page of scripts/report
   does: a line of JSON, then the matrices of its terms, n x n by columns, as 8-byte numbers of this machine.

      {"n", "n_used", "low", "high", "limit_ratio", "limit_growth", "error",
       "parameters": [{"name", "unit", "value", "lower", "upper"}],
       "terms": [{"kind": "K", "scale", "factors": [[parameter, power, absolute], ...]}]}

   low and high in rad/s. Terms that none of the varied parameters changes are one for each of K, C and M.
*/
#include "box.h"

#define EXPORT_MOST 6000000 /* bytes: what a page can hold */

/* A text that grows */
typedef struct {
  char  *text;
  size_t length, room;
} ExportText;

static PetscErrorCode ExportAdd(ExportText *t, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);

static PetscErrorCode ExportAdd(ExportText *t, const char format[], ...)
{
  va_list arguments;
  int     n;

  PetscFunctionBeginUser;
  if (t->room < t->length + 1024) {
    t->room = 2 * t->room + 4096;
    PetscCall(PetscRealloc(t->room, &t->text));
  }
  va_start(arguments, format);
  n = vsnprintf(t->text + t->length, t->room - t->length, format, arguments);
  va_end(arguments);
  PetscCheck(n >= 0 && (size_t)n < t->room - t->length, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a name is too long");
  t->length += (size_t)n;
  PetscFunctionReturn(0);
}

/* Which of the varied parameters factor k of a term is, -1 for none of them */
static PetscInt FactorVaried(const OperatorsTerm *term, PetscInt k, const BoxVaried *varied)
{
  for (PetscInt i = 0; i < varied->n; i++) {
    if (!term->factor[k].friction && term->factor[k].parameter == varied->parameter[i]) return i;
    for (PetscInt q = 0; q < FRICTION_PARAMETERS && term->factor[k].friction; q++)
      if (term->factor[k].friction->parameter[q] == varied->parameter[i]) return i;
  }
  return -1;
}

/* Whether a varied term is a monomial: friction that changes with the speed is none */
static PetscBool TermIsMonomial(const OperatorsTerm *term, const BoxVaried *varied)
{
  for (PetscInt k = 0; k < term->n; k++)
    if (FactorVaried(term, k, varied) >= 0 && term->factor[k].friction &&
        (FrictionVaries(&term->factor[k].friction->law) || term->factor[k].slope))
      return PETSC_FALSE;
  return PETSC_TRUE;
}

static PetscBool TermIsVaried(const OperatorsTerm *term, const BoxVaried *varied)
{
  for (PetscInt k = 0; k < term->n; k++)
    if (FactorVaried(term, k, varied) >= 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The head of a term; its scale is what is left with the varied parameters at 1 */
static PetscErrorCode ExportTerm(const OperatorsTerm *term, const BoxVaried *varied, const PetscReal ones[],
                                 ExportText *t)
{
  static const char kinds[] = {[OPERATORS_STIFFNESS] = 'K', [OPERATORS_DAMPING] = 'C', [OPERATORS_MASS] = 'M'};
  const char       *comma   = "";

  PetscFunctionBeginUser;
  PetscCall(ExportAdd(t, ", {\"kind\": \"%c\", \"scale\": %.17g, \"factors\": [", kinds[term->kind],
                      (double)OperatorsTermCoefficient(term, ones)));
  for (PetscInt k = 0; k < term->n; k++) {
    const PetscInt i = FactorVaried(term, k, varied);

    if (i < 0) continue;
    PetscCall(ExportAdd(t, "%s[%d, %d, %s]", comma, (int)i, (int)term->factor[k].power,
                        term->factor[k].absolute ? "true" : "false"));
    comma = ", ";
  }
  PetscCall(ExportAdd(t, "]}"));
  PetscFunctionReturn(0);
}

static PetscErrorCode ExportHead(const Box *box, const Reduced *reduced, const BoxVaried *varied, ExportText *t)
{
  const ModesLimit          limit = ModesLimitInForce(&box->limit);
  const OperatorsParameter *list;
  PetscInt                  n;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(box->operators, &n, &list));
  PetscCall(ExportAdd(t,
                      "{\"n\": %d, \"n_used\": %d, \"low\": %.17g, \"high\": %.17g, \"limit_ratio\": %.17g, "
                      "\"limit_growth\": %.17g, \"error\": %.17g, \"parameters\": [",
                      (int)reduced->n, (int)reduced->n_used, (double)box->window.low, (double)box->window.high,
                      (double)limit.ratio, (double)limit.growth, (double)(box->small.n_used ? box->greedy.worst : 0)));
  for (PetscInt i = 0; i < varied->n; i++)
    PetscCall(ExportAdd(
      t, "%s{\"name\": \"%s\", \"unit\": \"%s\", \"value\": %.17g, \"lower\": %.17g, \"upper\": %.17g}", i ? ", " : "",
      list[varied->parameter[i]].name, list[varied->parameter[i]].unit ? list[varied->parameter[i]].unit : "",
      (double)box->nominal[varied->parameter[i]], (double)varied->lower[i], (double)varied->upper[i]));
  PetscCall(ExportAdd(t, "], \"terms\": ["));
  PetscFunctionReturn(0);
}

/* Heads and matrices of all terms: those that do not vary are summed in sum [3][n * n], in front */
static PetscErrorCode ExportTerms(const Box *box, const Reduced *reduced, const BoxVaried *varied, ExportText *t,
                                  PetscReal sum[], ResultsPiece pieces[])
{
  const size_t size     = (size_t)(reduced->n * reduced->n);
  PetscInt     n_pieces = 0;
  PetscReal   *ones;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(box->n_parameters, &ones));
  PetscCall(PetscArraycpy(ones, box->nominal, box->n_parameters));
  for (PetscInt i = 0; i < varied->n; i++) ones[varied->parameter[i]] = 1;
  PetscCall(
    ExportAdd(t,
              "{\"kind\": \"K\", \"scale\": 1, \"factors\": []}, {\"kind\": \"C\", \"scale\": %d, \"factors\": []}, "
              "{\"kind\": \"M\", \"scale\": 1, \"factors\": []}",
              ReducedIsDamped(reduced, box->nominal) ? 1 : 0));
  for (PetscInt k = 0; k < 3; k++)
    pieces[n_pieces++] = (ResultsPiece){&sum[(size_t)k * size], size * sizeof(PetscReal)};
  for (PetscInt i = 0; i < reduced->n_terms; i++) {
    const OperatorsTerm *term = &reduced->term[i];

    if (TermIsVaried(term, varied)) {
      PetscCall(ExportTerm(term, varied, ones, t));
      pieces[n_pieces++] = (ResultsPiece){reduced->A[i], size * sizeof(PetscReal)};
      continue;
    }
    for (size_t k = 0; k < size; k++)
      sum[(size_t)term->kind * size + k] += OperatorsTermCoefficient(term, box->nominal) * reduced->A[i][k];
  }
  PetscCall(ExportAdd(t, "]}\n"));
  PetscCall(PetscFree(ones));
  PetscFunctionReturn(0);
}

PetscErrorCode BoxExport(const Box *box, const BoxVaried *varied, Results results)
{
  const Reduced *reduced = box->small.n_used ? &box->small : &box->basis.reduced;
  PetscInt       n_terms = 3;
  PetscMPIInt    rank;
  ExportText     text = {NULL, 0, 0};
  PetscReal     *sum;
  ResultsPiece  *pieces;

  PetscFunctionBeginUser;
  if (box->groups_of.n_groups) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < reduced->n_terms; i++) {
    if (!TermIsVaried(&reduced->term[i], varied)) continue;
    if (!TermIsMonomial(&reduced->term[i], varied)) PetscFunctionReturn(0);
    n_terms++;
  }
  if (sizeof(PetscReal) * (size_t)n_terms * (size_t)(reduced->n * reduced->n) > EXPORT_MOST) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Comm_rank(box->comm, &rank));
  PetscCall(PetscCalloc1(3 * reduced->n * reduced->n, &sum));
  PetscCall(PetscMalloc1(n_terms + 1, &pieces));
  PetscCall(ExportHead(box, reduced, varied, &text));
  PetscCall(ExportTerms(box, reduced, varied, &text, sum, &pieces[1]));
  pieces[0] = (ResultsPiece){text.text, text.length};
  PetscCall(ResultsBinaryWrite(results, box->comm, "reduced_model.bin", PETSC_TRUE, rank ? 0 : n_terms + 1, pieces));
  PetscCall(BoxExportShapes(box, results));
  PetscCall(PetscFree(pieces));
  PetscCall(PetscFree(sum));
  PetscCall(PetscFree(text.text));
  PetscFunctionReturn(0);
}
