/*
   The reduced model as a file, reduced_model.bin, for who computes with it elsewhere, as the page of scripts/report
   does: a line of JSON, then numbers of 8 bytes of this machine.

      {"n", "n_used", "low", "high", "limit_ratio", "limit_growth", "error",
       "parameters": [{"name", "unit", "value", "lower", "upper"}],
       "terms": [{"kind": "K", "scale", "factors": [[parameter, power, absolute], ...], "symmetric"}],
       "contact": {"pairs", "always", "groups": [pairs], "statuses": ["01", ...], "points"}}

   low and high in rad/s. A parameter is one option, or several that move in step, "a+b", in proportion to the value of
   the first. Terms that no parameter changes are one for each of K, C and M. A term is n x n by columns, a symmetric
   one its lower triangle.

   "contact" is there where pairs are closed at some points and open at others. They are groups that open and close
   together; a status is which of them are closed. A term with "closed": [group of each row] has rows in place of a
   matrix, sum_r closed_r left_r' right_r: the right ones, or "rows": the term before that has the same; then the left
   ones, or, "along", the weight of each right one. Behind all terms stand points whose status is known, [points]
   [parameters], and the status of each: all, or some 2,000, evenly, the scene itself and
   the first of each status.
*/
#include "export.h"

#define EXPORT_MOST   6000000 /* bytes: what a page can hold */
#define EXPORT_POINTS 2000    /* whose status is known */

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

/* The head of a term */
static PetscErrorCode ExportTermHead(const ExportTerm *term, PetscBool first, ExportText *t)
{
  static const char kinds[] = {[OPERATORS_STIFFNESS] = 'K', [OPERATORS_DAMPING] = 'C', [OPERATORS_MASS] = 'M'};

  PetscFunctionBeginUser;
  PetscCall(ExportAdd(t, "%s{\"kind\": \"%c\", \"scale\": %d, \"factors\": [", first ? "" : ", ", kinds[term->kind],
                      term->zero ? 0 : 1));
  for (PetscInt k = 0; k < term->n_factors; k++)
    PetscCall(ExportAdd(t, "%s[%d, %d, %s]", k ? ", " : "", (int)term->factor[k].variable, (int)term->factor[k].power,
                        term->factor[k].absolute ? "true" : "false"));
  PetscCall(ExportAdd(t, "]"));
  if (term->A && term->symmetric) PetscCall(ExportAdd(t, ", \"symmetric\": true"));
  if (!term->A) {
    PetscCall(ExportAdd(t, ", \"along\": %s, \"closed\": [", term->along ? "true" : "false"));
    for (PetscInt r = 0; r < term->n_rows; r++) PetscCall(ExportAdd(t, "%s%d", r ? "," : "", (int)term->group[r]));
    PetscCall(ExportAdd(t, "]"));
    if (term->rows_of >= 0) PetscCall(ExportAdd(t, ", \"rows\": %d", (int)term->rows_of));
  }
  PetscCall(ExportAdd(t, "}"));
  PetscFunctionReturn(0);
}

/* One parameter of the page: all options that move in step */
static PetscErrorCode ExportParameter(const Box *box, const BoxVaried *varied, const ExportVariables *v, PetscInt k,
                                      ExportText *t)
{
  const PetscInt            first = v->first[k];
  const OperatorsParameter *list;
  PetscInt                  n;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(box->operators, &n, &list));
  PetscCall(ExportAdd(t, "%s{\"name\": \"%s", k ? ", " : "", list[varied->parameter[first]].name));
  for (PetscInt i = first + 1; i < varied->n; i++)
    if (v->of[i] == k) PetscCall(ExportAdd(t, "+%s", list[varied->parameter[i]].name));
  PetscCall(ExportAdd(t, "\", \"unit\": \"%s\", \"value\": %.17g, \"lower\": %.17g, \"upper\": %.17g}",
                      list[varied->parameter[first]].unit ? list[varied->parameter[first]].unit : "",
                      (double)box->nominal[varied->parameter[first]], (double)varied->lower[first],
                      (double)varied->upper[first]));
  PetscFunctionReturn(0);
}

static PetscErrorCode ExportHead(const Box *box, const Reduced *reduced, const BoxVaried *varied,
                                 const ExportVariables *v, const ExportTerms *terms, ExportText *t)
{
  const ModesLimit limit = ModesLimitInForce(&box->limit);

  PetscFunctionBeginUser;
  PetscCall(ExportAdd(t,
                      "{\"n\": %d, \"n_used\": %d, \"low\": %.17g, \"high\": %.17g, \"limit_ratio\": %.17g, "
                      "\"limit_growth\": %.17g, \"error\": %.17g, \"parameters\": [",
                      (int)reduced->n, (int)reduced->n_used, (double)box->window.low, (double)box->window.high,
                      (double)limit.ratio, (double)limit.growth, (double)(box->small.n_used ? box->greedy.worst : 0)));
  for (PetscInt k = 0; k < v->n; k++) PetscCall(ExportParameter(box, varied, v, k, t));
  PetscCall(ExportAdd(t, "], \"terms\": ["));
  for (PetscInt k = 0; k < terms->n_terms; k++) PetscCall(ExportTermHead(&terms->term[k], k == 0, t));
  PetscCall(ExportAdd(t, "]"));
  PetscFunctionReturn(0);
}

/* Points whose status is known: values of the variables, then statuses, which are numbered as they come */
typedef struct {
  PetscInt   n, n_statuses;
  PetscInt   room, room_statuses;
  PetscReal *value, *status, *closed; /* [n][variables], [n], [n_statuses][groups] */
} ExportMap;

/* Whether point i of n is one of the EXPORT_POINTS that are taken of more: the fractional parts of i/1.618... are even
   over [0, 1) for any run of i, and in step with no power of two, as sequences of samples are */
static PetscBool ExportTakes(PetscInt i, PetscInt n)
{
  const uint32_t part = (uint32_t)i * 2654435769u; /* of 2^32 */

  return n <= EXPORT_POINTS || part < (uint32_t)(4294967296.0 * EXPORT_POINTS / (double)n) ? PETSC_TRUE : PETSC_FALSE;
}

/* Whether the point is the scene itself, at which sliders begin */
static PetscBool ExportIsOwn(const Box *box, const BoxVaried *varied, const PetscReal p[])
{
  for (PetscInt k = 0; k < varied->n; k++)
    if (p[varied->parameter[k]] != box->nominal[varied->parameter[k]]) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* The number of a status; `new` where it comes for the first time */
static PetscErrorCode ExportMapStatus(ExportMap *map, const PetscReal closed[], PetscInt n_groups, PetscInt *s,
                                      PetscBool *new)
{
  PetscBool same = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (*s = 0; *s < map->n_statuses; (*s)++) {
    PetscCall(PetscArraycmp(closed, &map->closed[*s * n_groups], n_groups, &same));
    if (same) break;
  }
  *new = same ? PETSC_FALSE : PETSC_TRUE;
  if (same) PetscFunctionReturn(0);
  if (map->n_statuses == map->room_statuses) {
    map->room_statuses = 2 * map->room_statuses + 16;
    PetscCall(PetscRealloc((size_t)(map->room_statuses * n_groups) * sizeof(PetscReal), &map->closed));
  }
  PetscCall(PetscArraycpy(&map->closed[map->n_statuses++ * n_groups], closed, n_groups));
  PetscFunctionReturn(0);
}

static PetscErrorCode ExportMapAdd(ExportMap *map, const BoxVaried *varied, const ExportVariables *v,
                                   const PetscReal p[], PetscInt s)
{
  PetscFunctionBeginUser;
  if (map->n == map->room) {
    map->room = 2 * map->room + 64;
    PetscCall(PetscRealloc((size_t)(map->room * v->n) * sizeof(PetscReal), &map->value));
    PetscCall(PetscRealloc((size_t)map->room * sizeof(PetscReal), &map->status));
  }
  for (PetscInt k = 0; k < v->n; k++) map->value[map->n * v->n + k] = p[varied->parameter[v->first[k]]];
  map->status[map->n++] = (PetscReal)s;
  PetscFunctionReturn(0);
}

/* Of many points some, the scene itself, and the first one of each status: what reads the file looks at each pair of
   points */
static PetscErrorCode ExportMapCreate(const Box *box, const BoxVaried *varied, const ExportVariables *v, ExportMap *map)
{
  const PetscInt n_groups = box->groups_of.n_groups, n = n_groups ? varied->n_points : 0;
  PetscReal     *p;

  PetscFunctionBeginUser;
  *map = (ExportMap){.n = 0};
  PetscCall(PetscMalloc1(box->n_parameters, &p));
  for (PetscInt i = 0; i < n; i++) {
    PetscInt s;
    PetscBool new;

    PetscCall(varied->get(varied->ctx, i, p));
    PetscCall(ExportMapStatus(map, &p[box->n_parameters - n_groups], n_groups, &s, &new));
    if (new || ExportTakes(i, n) || ExportIsOwn(box, varied, p)) PetscCall(ExportMapAdd(map, varied, v, p, s));
  }
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

static PetscErrorCode ExportMapDestroy(ExportMap *map)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(map->value));
  PetscCall(PetscFree(map->status));
  PetscCall(PetscFree(map->closed));
  PetscFunctionReturn(0);
}

/* How many pairs each group has: rows of what is symmetric among the terms */
static PetscErrorCode ExportGroups(const Box *box, const Reduced *reduced, PetscInt size[])
{
  const PetscInt first = box->n_parameters - box->groups_of.n_groups;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(size, box->groups_of.n_groups));
  for (PetscInt t = 0; t < reduced->n_terms; t++) {
    const OperatorsTerm *term = &reduced->term[t];

    for (PetscInt k = 0; k < term->n && term->symmetric && term->kind == OPERATORS_STIFFNESS; k++)
      if (!term->factor[k].friction && term->factor[k].parameter >= first)
        size[term->factor[k].parameter - first] += reduced->factors[t].rank;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ExportContact(const Box *box, const Reduced *reduced, const ExportMap *map, ExportText *t)
{
  const PetscInt n = box->groups_of.n_groups;
  PetscInt      *size, always = box->statuses.n_closed[0];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &size));
  PetscCall(ExportGroups(box, reduced, size));
  for (PetscInt g = 0; g < n; g++) always -= box->groups_of.closed[g] > 0 ? size[g] : 0;
  PetscCall(ExportAdd(t, ", \"contact\": {\"pairs\": %d, \"always\": %d, \"groups\": [", (int)box->statuses.n_pairs,
                      (int)always));
  for (PetscInt g = 0; g < n; g++) PetscCall(ExportAdd(t, "%s%d", g ? "," : "", (int)size[g]));
  PetscCall(ExportAdd(t, "], \"statuses\": ["));
  for (PetscInt s = 0; s < map->n_statuses; s++) {
    PetscCall(ExportAdd(t, "%s\"", s ? ", " : ""));
    for (PetscInt g = 0; g < n; g++) PetscCall(ExportAdd(t, "%c", map->closed[s * n + g] > 0 ? '1' : '0'));
    PetscCall(ExportAdd(t, "\""));
  }
  PetscCall(ExportAdd(t, "], \"points\": %d}", (int)map->n));
  PetscCall(PetscFree(size));
  PetscFunctionReturn(0);
}

static void PieceAdd(const PetscReal values[], PetscInt n, PetscInt *n_pieces, ResultsPiece pieces[])
{
  pieces[(*n_pieces)++] = (ResultsPiece){values, (size_t)n * sizeof(PetscReal)};
}

/* The numbers of all terms and of the map, in order; room for two pieces of each term and two more */
static void ExportPieces(const ExportTerms *terms, const ExportMap *map, PetscInt n_variables, PetscInt *n_pieces,
                         ResultsPiece pieces[])
{
  const PetscInt n = terms->n;

  for (PetscInt k = 0; k < terms->n_terms; k++) {
    const ExportTerm *term = &terms->term[k];

    if (term->A) PieceAdd(term->A, term->symmetric ? n * (n + 1) / 2 : n * n, n_pieces, pieces);
    if (term->A) continue;
    if (term->rows_of < 0) PieceAdd(term->right, term->n_rows * n, n_pieces, pieces);
    if (term->along)
      PieceAdd(term->weight, term->n_rows, n_pieces, pieces);
    else
      PieceAdd(term->left, term->n_rows * n, n_pieces, pieces);
  }
  if (map->n) PieceAdd(map->value, map->n * n_variables, n_pieces, pieces);
  if (map->n) PieceAdd(map->status, map->n, n_pieces, pieces);
}

/* The file, where it is not too large */
static PetscErrorCode ExportWrite(const Box *box, PetscInt n_pieces, const ResultsPiece pieces[], Results results)
{
  PetscMPIInt rank;
  size_t      size = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n_pieces; k++) size += pieces[k].size;
  if (size > EXPORT_MOST) {
    PetscCall(PetscPrintf(box->comm,
                          "reduced_model.bin is not written: it would have %.1f MB, and at most %.1f MB fit "
                          "into a page; the report has no sliders\n",
                          1e-6 * (double)size, 1e-6 * EXPORT_MOST));
    PetscFunctionReturn(0);
  }
  PetscCallMPI(MPI_Comm_rank(box->comm, &rank));
  PetscCall(ResultsBinaryWrite(results, box->comm, "reduced_model.bin", PETSC_TRUE, rank ? 0 : n_pieces, pieces));
  PetscCall(BoxExportShapes(box, results));
  PetscFunctionReturn(0);
}

PetscErrorCode BoxExport(const Box *box, const BoxVaried *varied, Results results)
{
  const Reduced  *reduced = box->small.n_used ? &box->small : &box->basis.reduced;
  ExportText      text    = {NULL, 0, 0};
  ExportVariables variables;
  ExportTerms     terms;
  ExportMap       map;
  ResultsPiece   *pieces;
  PetscInt        n_pieces = 1;
  PetscBool       made;

  PetscFunctionBeginUser;
  PetscCall(ExportVariablesCreate(box, varied, &variables));
  PetscCall(ExportTermsCreate(box, reduced, varied, &variables, &terms, &made));
  PetscCall(ExportMapCreate(box, varied, &variables, &map));
  if (made) {
    PetscCall(PetscMalloc1(2 * terms.n_terms + 3, &pieces));
    PetscCall(ExportHead(box, reduced, varied, &variables, &terms, &text));
    if (box->groups_of.n_groups) PetscCall(ExportContact(box, reduced, &map, &text));
    PetscCall(ExportAdd(&text, "}\n"));
    ExportPieces(&terms, &map, variables.n, &n_pieces, pieces);
    pieces[0] = (ResultsPiece){text.text, text.length};
    PetscCall(ExportWrite(box, n_pieces, pieces, results));
    PetscCall(PetscFree(pieces));
    PetscCall(PetscFree(text.text));
  }
  PetscCall(ExportMapDestroy(&map));
  PetscCall(ExportTermsDestroy(&terms));
  PetscCall(ExportVariablesDestroy(&variables));
  PetscFunctionReturn(0);
}
