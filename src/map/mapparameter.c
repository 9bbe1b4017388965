/*
   The axes of a map: names of parameters, links, values.
*/
#include "mapimpl.h"
#include "sweep/grid.h"
#include <squeal/options.h>
#include <string.h>

PetscBool MapAxisIsBody(const MapAxis *axis)
{
  for (PetscInt i = 0; i < axis->n_moved; i++)
    if (axis->moved[i].kind == REDUCED_BODY) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Adds a parameter to an axis */
static PetscErrorCode MapAxisAdd(Map map, const char option[], const char name[], MapAxis *axis)
{
  PetscBool same;

  PetscFunctionBeginUser;
  PetscCheck(axis->n_moved < (PetscInt)PETSC_STATIC_ARRAY_LENGTH(axis->moved), map->comm, PETSC_ERR_USER_INPUT,
             "%s names more than %d parameters for one axis", option, (int)PETSC_STATIC_ARRAY_LENGTH(axis->moved));
  for (PetscInt k = 0; k <= map->n_axes && k < MAP_MAX_AXES; k++)
    for (PetscInt i = 0; i < map->axis[k].n_moved; i++)
      PetscCheck(strcmp(map->axis[k].moved[i].name, name), map->comm, PETSC_ERR_USER_INPUT, "%s names '%s' twice",
                 option, name);
  PetscCall(
    ReducedParameterFind(map->operators, map->p, option, "that a map can vary", name, &axis->moved[axis->n_moved]));
  PetscCall(PetscStrcmp(axis->moved[0].unit, axis->moved[axis->n_moved].unit, &same));
  PetscCheck(same, map->comm, PETSC_ERR_USER_INPUT,
             "%s names %s, of %s, with %s, of %s: what takes the same values has the same unit", option, name,
             axis->moved[axis->n_moved].unit, axis->moved[0].name, axis->moved[0].unit);
  axis->n_moved++;
  PetscFunctionReturn(0);
}

/* One link: the axis of the named parameter that it holds gets the others */
static PetscErrorCode MapLinkTake(Map map, const char text[])
{
  MapAxis *axis = NULL;
  char   **names;
  int      n;

  PetscFunctionBeginUser;
  PetscCall(ValuesSplit(map->comm, "-map_link", text, ',', &n, &names));
  PetscCheck(n > 1, map->comm, PETSC_ERR_USER_INPUT,
             "-map_link '%s' must name two or more parameters, e.g. inner_mu,outer_mu", text);
  for (PetscInt k = 0; k < map->n_axes; k++)
    for (int i = 0; i < n; i++)
      if (!strcmp(names[i], map->axis[k].moved[0].name)) axis = &map->axis[k];
  PetscCheck(axis, map->comm, PETSC_ERR_USER_INPUT,
             "-map_link '%s' does nothing: it must hold what is varied, -map_parameter %s", text, map->parameter);
  for (int i = 0; i < n; i++)
    if (strcmp(names[i], axis->moved[0].name)) PetscCall(MapAxisAdd(map, "-map_link", names[i], axis));
  PetscCall(PetscStrToArrayDestroy(n, names));
  PetscFunctionReturn(0);
}

static PetscErrorCode MapAxisValues(Map map, PetscInt k)
{
  static const char *const options[] = {"-map_values", "-map_values_2"};
  MapAxis                 *axis      = &map->axis[k];

  PetscFunctionBeginUser;
  PetscCheck(map->values[k][0], map->comm, PETSC_ERR_USER_INPUT, "-map_parameter %s needs %s, e.g. first:last:n",
             axis->moved[0].name, options[k]);
  PetscCall(GridValuesParse(map->comm, options[k], map->values[k], &axis->n, &axis->value, &axis->ratio));
  for (PetscInt i = 0; i < axis->n; i++)
    for (PetscInt j = 0; j < axis->n_moved; j++)
      PetscCall(ReducedParameterCheck(map->operators, options[k], &axis->moved[j], axis->value[i]));
  for (PetscInt i = 1; i < axis->n && k == 0 && map->direction != MAP_APART; i++)
    PetscCheck(
      axis->value[i] > axis->value[i - 1], map->comm, PETSC_ERR_USER_INPUT,
      "-map_values: %s %.6g after %.6g: values of the first parameter must ascend, since points go on from their "
      "neighbours; -map_direction down goes through them backwards",
      axis->moved[0].name, (double)axis->value[i], (double)axis->value[i - 1]);
  PetscFunctionReturn(0);
}

PetscErrorCode MapAxes(Map map)
{
  char **names;
  int    n;

  PetscFunctionBeginUser;
  PetscCheck(map->parameter[0], map->comm, PETSC_ERR_USER_INPUT,
             "-analysis map needs -map_parameter: one or two options of the scene, e.g. contact_mu,press_force");
  PetscCall(ValuesSplit(map->comm, "-map_parameter", map->parameter, ',', &n, &names));
  PetscCheck(n == 1 || n == 2, map->comm, PETSC_ERR_USER_INPUT,
             "-map_parameter '%s' must name one or two options of the scene, e.g. contact_mu,press_force",
             map->parameter);
  PetscCheck((n == 2) == (map->values[1][0] != '\0'), map->comm, PETSC_ERR_USER_INPUT,
             "-map_values_2 belongs to a second -map_parameter: give both or neither");
  for (int k = 0; k < n; k++, map->n_axes++) PetscCall(MapAxisAdd(map, "-map_parameter", names[k], &map->axis[k]));
  PetscCall(PetscStrToArrayDestroy(n, names));
  if (map->linked) {
    PetscCall(ValuesSplit(map->comm, "-map_link", map->link, ':', &n, &names));
    for (int i = 0; i < n; i++) PetscCall(MapLinkTake(map, names[i]));
    PetscCall(PetscStrToArrayDestroy(n, names));
  }
  PetscCheck(!MapAxisIsBody(&map->axis[0]), map->comm, PETSC_ERR_USER_INPUT,
             "-map_parameter %s: %s changes the bodies, whose motion the next point cannot go on with; name it second, "
             "after one that leaves them as they are, such as contact_mu",
             map->parameter, map->axis[0].moved[0].name);
  for (PetscInt k = 0; k < map->n_axes; k++) PetscCall(MapAxisValues(map, k));
  PetscFunctionReturn(0);
}
