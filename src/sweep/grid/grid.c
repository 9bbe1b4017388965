/*
   The values of a sweep: ranges and lists from the options, and the grid that one or two of them span. Points are
   numbered with the first parameter running fastest, point = i_0 + n_0 i_1; places are the points and, between
   them, those that a change of contact status needs (place->point = -1), in the order of the line. at [points] =
   place of each point.
*/
#include "grid.h"
#include "sweep/basis/points.h"
#include "base/text.h"
#include <squeal/options.h>
#include <string.h>

/* Ends of one sign that differ by more than RATIO_FROM make an axis of ratios, also where the option did not ask
   for one: distances and middles are then logarithmic. */
PetscErrorCode GridValuesParse(MPI_Comm comm, const char option[], const char text[], PetscInt *n, PetscReal *value[],
                               PetscBool *ratio)
{
  PetscReal a, b;

  PetscFunctionBeginUser;
  PetscCall(ValuesParse(comm, option, text, n, value, ratio));
  a = (*value)[0], b = (*value)[*n - 1];
  if (a * b > 0 && PetscMax(a / b, b / a) > RATIO_FROM) *ratio = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* What to do where the name is one of a law of stiffness, or of a layer, that the scene does not have */
static const char *Hint(const char name[])
{
  static const char *const of_laws[] = {"_loss_factor", "_prony_", "_zener_", "_table_temperature"};

  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(of_laws); k++)
    if (strstr(name, of_laws[k]))
      return "; a law of the stiffness varies where the scene gives it, a loss factor above 0 without "
             "-model_loss_frequency";
  if (strstr(name, "_thickness")) return "; the thickness of a part varies where the scene gives it, -..._thickness";
  return "";
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
    PetscCall(WordsAdd(valid, i ? ", " : "", sizeof(valid)));
    PetscCall(WordsAdd(valid, parameters[i].name, sizeof(valid)));
  }
  PetscCheck(*index >= 0, comm, PETSC_ERR_USER_INPUT, "%s '%s' is no parameter that can be varied; valid are %s%s",
             option, name, valid, Hint(name));
  PetscFunctionReturn(0);
}

PetscInt GridSize(const SweepGrid *grid)
{
  return grid->n_axes == 2 ? grid->n[0] * grid->n[1] : grid->n[0];
}

PetscInt GridLines(const SweepGrid *grid)
{
  return grid->n_axes == 2 ? grid->n[1] : 1;
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

/* Places behind k move up by one, and the points among them are told where they now are. */
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

PetscInt GridAxisOf(const SweepGrid *grid, PetscInt parameter)
{
  for (PetscInt k = 0; k < grid->n_axes; k++)
    for (PetscInt i = 0; i < grid->n_moved[k]; i++)
      if (grid->parameter[k][i] == parameter) return k;
  return -1;
}

/* All parameters of a place, each in its own unit: the scene's, then closed_g = 0 or 1 of the groups for the
   status, then what the axes move; NULL: the scene itself with the first status. */
void GridFill(const SweepGrid *grid, const SweepPlace *place, PetscReal p[])
{
  const PetscInt first = grid->n_parameters - grid->n_groups, status = place ? place->status : 0;

  for (PetscInt i = 0; i < first; i++) p[i] = grid->base[i];
  for (PetscInt g = 0; g < grid->n_groups; g++) p[first + g] = grid->closed[status * grid->n_groups + g];
  for (PetscInt k = 0; k < grid->n_axes && place; k++)
    for (PetscInt i = 0; i < grid->n_moved[k]; i++) p[grid->parameter[k][i]] = place->value[k];
}

void GridPoint(const SweepGrid *grid, PetscInt point, PetscReal p[])
{
  GridFill(grid, &grid->place[grid->at[point]], p);
}

/* Arithmetic middle, or the geometric one, of the sign of both, on an axis of ratios. */
PetscReal GridMiddle(const SweepGrid *grid, PetscInt axis, PetscReal a, PetscReal b)
{
  return grid->ratio[axis] ? (a < 0 ? -1 : 1) * PetscSqrtReal(a * b) : 0.5 * (a + b);
}

PetscErrorCode GridDestroy(SweepGrid *grid)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < GRID_MAX_AXES; k++) {
    PetscCall(PetscFree(grid->value[k]));
    PetscCall(PetscFree(grid->parameter[k]));
  }
  PetscCall(PetscFree(grid->base));
  PetscCall(PetscFree(grid->place));
  PetscCall(PetscFree(grid->at));
  PetscCall(PetscFree(grid->closed));
  PetscFunctionReturn(0);
}
