/*
   The values of a sweep: ranges and lists from the options, and the grid that one or two of them span.
*/
#include "values.h"
#include <string.h>

#define MAX_VALUES 100000
#define WIDE       5 /* a range whose ends differ by this factor is measured in ratios */

/* Reads one number; false where the word is none */
static PetscBool NumberParse(const char word[], PetscReal *value)
{
  char *end;

  *value = strtod(word, &end);
  return end != word && !*end && !PetscIsInfOrNanReal(*value) ? PETSC_TRUE : PETSC_FALSE;
}

/* first:last:n[:log] */
static PetscErrorCode RangeParse(MPI_Comm comm, const char option[], const char text[], int n_words, char *words[],
                                 PetscInt *n, PetscReal *value[], PetscBool *ratio)
{
  const PetscBool is_log = n_words == 4 && !strcmp(words[3], "log") ? PETSC_TRUE : PETSC_FALSE;
  PetscReal       first, last, count;

  PetscFunctionBeginUser;
  PetscCheck(n_words == 3 || is_log, comm, PETSC_ERR_USER_INPUT,
             "%s '%s' is no range: give first:last:n or first:last:n:log", option, text);
  PetscCheck(NumberParse(words[0], &first) && NumberParse(words[1], &last) && NumberParse(words[2], &count), comm,
             PETSC_ERR_USER_INPUT, "%s '%s' holds what is no number: give first:last:n or first:last:n:log", option,
             text);
  PetscCheck(count == PetscFloorReal(count) && count >= 2 && count <= MAX_VALUES, comm, PETSC_ERR_USER_INPUT,
             "%s '%s' asks for %.6g values; n must be an integer from 2 to %d", option, text, (double)count,
             MAX_VALUES);
  PetscCheck(first != last, comm, PETSC_ERR_USER_INPUT, "%s '%s' begins where it ends", option, text);
  PetscCheck(!is_log || first * last > 0, comm, PETSC_ERR_USER_INPUT,
             "%s '%s': a logarithmic range needs ends of one sign, not zero", option, text);
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
static PetscErrorCode ListParse(MPI_Comm comm, const char option[], const char text[], PetscInt *n, PetscReal *value[])
{
  char **words;
  int    n_words;

  PetscFunctionBeginUser;
  PetscCall(PetscStrToArray(text, ',', &n_words, &words));
  PetscCheck(n_words > 0, comm, PETSC_ERR_USER_INPUT, "%s is empty: give first:last:n, first:last:n:log or v1,v2,...",
             option);
  *n = n_words;
  PetscCall(PetscMalloc1(*n, value));
  for (PetscInt i = 0; i < *n; i++) {
    PetscCheck(NumberParse(words[i], &(*value)[i]), comm, PETSC_ERR_USER_INPUT, "%s: '%s' is no number", option,
               words[i]);
    PetscCheck(i < 2 || ((*value)[i] - (*value)[i - 1]) * ((*value)[1] - (*value)[0]) > 0, comm, PETSC_ERR_USER_INPUT,
               "%s: values must ascend or descend, and %.6g follows %.6g", option, (double)(*value)[i],
               (double)(*value)[i - 1]);
  }
  PetscCheck(*n < 2 || (*value)[0] != (*value)[1], comm, PETSC_ERR_USER_INPUT, "%s: value %.6g stands twice", option,
             (double)(*value)[0]);
  PetscCall(PetscStrToArrayDestroy(n_words, words));
  PetscFunctionReturn(0);
}

PetscErrorCode ValuesParse(MPI_Comm comm, const char option[], const char text[], PetscInt *n, PetscReal *value[],
                           PetscBool *ratio)
{
  char    **words;
  int       n_words;
  PetscReal a, b;

  PetscFunctionBeginUser;
  *ratio = PETSC_FALSE;
  if (strchr(text, ':')) {
    PetscCall(PetscStrToArray(text, ':', &n_words, &words));
    PetscCall(RangeParse(comm, option, text, n_words, words, n, value, ratio));
    PetscCall(PetscStrToArrayDestroy(n_words, words));
  } else {
    PetscCall(ListParse(comm, option, text, n, value));
  }
  a = (*value)[0], b = (*value)[*n - 1];
  if (a * b > 0 && PetscMax(a / b, b / a) > WIDE) *ratio = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode ParameterFind(MPI_Comm comm, const char option[], const char name[], PetscInt n,
                             const OperatorsParameter parameters[], PetscInt *index)
{
  char valid[2048] = "";

  PetscFunctionBeginUser;
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

PetscInt GridSize(const Grid *grid)
{
  return grid->n_axes == 2 ? grid->n[0] * grid->n[1] : grid->n[0];
}

void GridPoint(const Grid *grid, PetscInt point, PetscReal p[])
{
  for (PetscInt i = 0; i < grid->n_parameters; i++) p[i] = grid->base[i];
  p[grid->parameter[0]] = grid->value[0][point % grid->n[0]];
  if (grid->n_axes == 2) p[grid->parameter[1]] = grid->value[1][point / grid->n[0]];
}

PetscReal GridMiddle(const Grid *grid, PetscInt axis, PetscReal a, PetscReal b)
{
  return grid->ratio[axis] ? (a < 0 ? -1 : 1) * PetscSqrtReal(a * b) : 0.5 * (a + b);
}

PetscErrorCode GridDestroy(Grid *grid)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < GRID_MAX_AXES; k++) PetscCall(PetscFree(grid->value[k]));
  PetscCall(PetscFree(grid->base));
  PetscFunctionReturn(0);
}
