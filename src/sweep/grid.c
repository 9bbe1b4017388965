/*
   The values of a sweep: ranges and lists from the options, and the grid that one or two of them span.
*/
#include "grid.h"
#include "sweep/basis/points.h"
#include <string.h>

#define MAX_VALUES 100000

/* Reads one number; false where the word is none */
static PetscBool NumberParse(const char word[], PetscReal *value)
{
  char *end;

  *value = strtod(word, &end);
  return end != word && !*end && !PetscIsInfOrNanReal(*value) ? PETSC_TRUE : PETSC_FALSE;
}

/* What names the option in errors */
typedef struct {
  MPI_Comm    comm;
  const char *name, *text;
} ValuesOption;

/* first:last:n[:log] */
static PetscErrorCode RangeParse(const ValuesOption *option, int n_words, char *words[], PetscInt *n,
                                 PetscReal *value[], PetscBool *ratio)
{
  const PetscBool is_log = n_words == 4 && !strcmp(words[3], "log") ? PETSC_TRUE : PETSC_FALSE;
  PetscReal       first, last, count;

  PetscFunctionBeginUser;
  PetscCheck(n_words == 3 || is_log, option->comm, PETSC_ERR_USER_INPUT,
             "%s '%s' is no range: give first:last:n or first:last:n:log", option->name, option->text);
  PetscCheck(NumberParse(words[0], &first) && NumberParse(words[1], &last) && NumberParse(words[2], &count),
             option->comm, PETSC_ERR_USER_INPUT,
             "%s '%s' holds what is no number: give first:last:n or first:last:n:log", option->name, option->text);
  PetscCheck(count == PetscFloorReal(count) && count >= 2 && count <= MAX_VALUES, option->comm, PETSC_ERR_USER_INPUT,
             "%s '%s' asks for %.6g values; n must be an integer from 2 to %d", option->name, option->text,
             (double)count, MAX_VALUES);
  PetscCheck(first != last, option->comm, PETSC_ERR_USER_INPUT, "%s '%s' begins where it ends", option->name,
             option->text);
  PetscCheck(!is_log || first * last > 0, option->comm, PETSC_ERR_USER_INPUT,
             "%s '%s': a logarithmic range needs ends of one sign, not zero", option->name, option->text);
  *n     = (PetscInt)count;
  *ratio = is_log;
  PetscCall(PetscMalloc1(*n, value));
  for (PetscInt i = 0; i < *n; i++) {
    const PetscReal t = (PetscReal)i / (PetscReal)(*n - 1);

    (*value)[i] = is_log ? first * PetscPowReal(last / first, t) : first + t * (last - first);
  }
  (*value)[*n - 1] = last;
  PetscFunctionReturn(0);
}

/* v1,v2,... */
static PetscErrorCode ListParse(const ValuesOption *option, PetscInt *n, PetscReal *value[])
{
  char **words;
  int    n_words;

  PetscFunctionBeginUser;
  PetscCall(PetscStrToArray(option->text, ',', &n_words, &words));
  PetscCheck(n_words > 0, option->comm, PETSC_ERR_USER_INPUT,
             "%s is empty: give first:last:n, first:last:n:log or v1,v2,...", option->name);
  *n = n_words;
  PetscCall(PetscMalloc1(*n, value));
  for (PetscInt i = 0; i < *n; i++) {
    PetscCheck(NumberParse(words[i], &(*value)[i]), option->comm, PETSC_ERR_USER_INPUT, "%s: '%s' is no number",
               option->name, words[i]);
    PetscCheck(i < 2 || ((*value)[i] - (*value)[i - 1]) * ((*value)[1] - (*value)[0]) > 0, option->comm,
               PETSC_ERR_USER_INPUT, "%s: values must ascend or descend, and %.6g follows %.6g", option->name,
               (double)(*value)[i], (double)(*value)[i - 1]);
  }
  PetscCheck(*n < 2 || (*value)[0] != (*value)[1], option->comm, PETSC_ERR_USER_INPUT, "%s: value %.6g stands twice",
             option->name, (double)(*value)[0]);
  PetscCall(PetscStrToArrayDestroy(n_words, words));
  PetscFunctionReturn(0);
}

PetscErrorCode GridValuesParse(MPI_Comm comm, const char option[], const char text[], PetscInt *n, PetscReal *value[],
                               PetscBool *ratio)
{
  const ValuesOption given = {comm, option, text};
  char             **words;
  int                n_words;
  PetscReal          a, b;

  PetscFunctionBeginUser;
  *ratio = PETSC_FALSE;
  if (strchr(text, ':')) {
    PetscCall(PetscStrToArray(text, ':', &n_words, &words));
    PetscCall(RangeParse(&given, n_words, words, n, value, ratio));
    PetscCall(PetscStrToArrayDestroy(n_words, words));
  } else {
    PetscCall(ListParse(&given, n, value));
  }
  a = (*value)[0], b = (*value)[*n - 1];
  if (a * b > 0 && PetscMax(a / b, b / a) > RATIO_FROM) *ratio = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode GridParameterFind(MPI_Comm comm, Operators operators, const char option[], const char name[],
                                 PetscInt *index)
{
  const OperatorsParameter *parameters;
  PetscInt                  n;
  char                      valid[2048] = "";

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(operators, &n, &parameters));
  *index = -1;
  for (PetscInt i = 0; i < n; i++) {
    if (!strcmp(parameters[i].name, name)) *index = i;
    PetscCall(PetscStrlcat(valid, i ? ", " : "", sizeof(valid)));
    PetscCall(PetscStrlcat(valid, parameters[i].name, sizeof(valid)));
  }
  PetscCheck(*index >= 0, comm, PETSC_ERR_USER_INPUT, "%s '%s' is no parameter that can be varied; valid are %s",
             option, name, valid);
  PetscFunctionReturn(0);
}

PetscInt GridSize(const SweepGrid *grid)
{
  return grid->n_axes == 2 ? grid->n[0] * grid->n[1] : grid->n[0];
}

PetscErrorCode GridCreatePlaces(SweepGrid *grid)
{
  PetscFunctionBeginUser;
  grid->n_places = GridSize(grid);
  PetscCall(PetscCalloc1(grid->n_places, &grid->place));
  PetscCall(PetscMalloc1(grid->n_places, &grid->at));
  for (PetscInt i = 0; i < grid->n_places; i++) {
    SweepPlace *place = &grid->place[i];

    place->point    = i;
    place->line     = i / grid->n[0];
    place->value[0] = grid->value[0][i % grid->n[0]];
    if (grid->n_axes == 2) place->value[1] = grid->value[1][place->line];
    grid->at[i] = i;
  }
  PetscFunctionReturn(0);
}

/* Tells the points from place k on where they are */
static void GridNumber(SweepGrid *grid, PetscInt k)
{
  for (; k < grid->n_places; k++)
    if (grid->place[k].point >= 0) grid->at[grid->place[k].point] = k;
}

PetscErrorCode GridInsert(SweepGrid *grid, PetscInt k, const SweepPlace *place)
{
  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)(grid->n_places + 1) * sizeof(*grid->place), &grid->place));
  PetscCall(PetscArraymove(grid->place + k + 1, grid->place + k, grid->n_places - k));
  grid->place[k] = *place;
  grid->n_places++;
  GridNumber(grid, k);
  PetscFunctionReturn(0);
}

void GridRemove(SweepGrid *grid, PetscInt k)
{
  grid->n_places--;
  for (PetscInt i = k; i < grid->n_places; i++) grid->place[i] = grid->place[i + 1];
  GridNumber(grid, k);
}

void GridFill(const SweepGrid *grid, const SweepPlace *place, PetscReal p[])
{
  const PetscInt first = grid->n_parameters - grid->n_groups;

  for (PetscInt i = 0; i < first; i++) p[i] = grid->base[i];
  for (PetscInt g = 0; g < grid->n_groups; g++) p[first + g] = grid->closed[place->status * grid->n_groups + g];
  for (PetscInt k = 0; k < grid->n_axes; k++) p[grid->parameter[k]] = place->value[k];
}

void GridPoint(const SweepGrid *grid, PetscInt point, PetscReal p[])
{
  GridFill(grid, &grid->place[grid->at[point]], p);
}

PetscReal GridMiddle(const SweepGrid *grid, PetscInt axis, PetscReal a, PetscReal b)
{
  return grid->ratio[axis] ? (a < 0 ? -1 : 1) * PetscSqrtReal(a * b) : 0.5 * (a + b);
}

PetscErrorCode GridDestroy(SweepGrid *grid)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < GRID_MAX_AXES; k++) PetscCall(PetscFree(grid->value[k]));
  PetscCall(PetscFree(grid->base));
  PetscCall(PetscFree(grid->place));
  PetscCall(PetscFree(grid->at));
  PetscCall(PetscFree(grid->closed));
  PetscFunctionReturn(0);
}
