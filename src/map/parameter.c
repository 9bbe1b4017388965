/*
   The axes of a map: names of parameters, links, values.
*/
#include "mapimpl.h"
#include "base/options/axes.h"
#include <squeal/options.h>
#include <string.h>

PetscBool MapAxisIsBody(const MapAxis *axis)
{
  for (PetscInt i = 0; i < axis->n_moved; i++)
    if (axis->moved[i].kind == REDUCED_BODY) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* A parameter of axis k */
static PetscErrorCode MapAxisAdd(void *ctx, const char option[], const char name[], PetscInt k, const char **unit)
{
  const Map map  = ctx;
  MapAxis  *axis = &map->axis[k];

  PetscFunctionBeginUser;
  PetscCheck(axis->n_moved < (PetscInt)PETSC_STATIC_ARRAY_LENGTH(axis->moved), map->comm, PETSC_ERR_USER_INPUT,
             "%s names more than %d parameters for one axis", option, (int)PETSC_STATIC_ARRAY_LENGTH(axis->moved));
  PetscCall(
    ReducedParameterFind(map->operators, map->p, option, "that a map can vary", name, &axis->moved[axis->n_moved]));
  *unit       = axis->moved[axis->n_moved++].unit;
  map->n_axes = PetscMax(map->n_axes, k + 1);
  PetscFunctionReturn(0);
}

/* Values of the first axis ascend, as each point goes on from its neighbour; each is checked against what its
   parameters may be. */
static PetscErrorCode MapAxisValues(Map map, PetscInt k)
{
  static const char *const options[] = {"-map_values", "-map_values_2"};
  MapAxis                 *axis      = &map->axis[k];
  PetscBool                is_log;

  PetscFunctionBeginUser;
  PetscCheck(map->values[k][0], map->comm, PETSC_ERR_USER_INPUT, "-map_parameter %s needs %s, e.g. first:last:n",
             axis->moved[0].name, options[k]);
  PetscCheck(strlen(map->values[k]) < MAP_MAX_TEXT - 1, map->comm, PETSC_ERR_USER_INPUT,
             "%s is longer than %d characters; give a range first:last:n", options[k], MAP_MAX_TEXT);
  PetscCall(ValuesParse(map->comm, options[k], map->values[k], &axis->n, &axis->value, &is_log));
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
  const AxesGiven given = {map->comm,
                           "map",
                           "varied",
                           map->parameter,
                           map->linked ? map->link : NULL,
                           map->values[1][0] ? PETSC_TRUE : PETSC_FALSE};

  PetscFunctionBeginUser;
  PetscCheck(map->parameter[0], map->comm, PETSC_ERR_USER_INPUT,
             "-analysis map needs -map_parameter: one or two options of the scene, e.g. contact_mu,press_force");
  PetscCall(AxesRead(&given, MapAxisAdd, map));
  PetscCheck(!MapAxisIsBody(&map->axis[0]), map->comm, PETSC_ERR_USER_INPUT,
             "-map_parameter %s: %s changes the bodies, whose motion the next point cannot go on with; name it second, "
             "after one that leaves them as they are, such as contact_mu",
             map->parameter, map->axis[0].moved[0].name);
  for (PetscInt k = 0; k < map->n_axes; k++) PetscCall(MapAxisValues(map, k));
  PetscCheck(map->n_axes == 1 || map->axis[0].n <= MAP_MAX_POINTS / map->axis[1].n, map->comm, PETSC_ERR_USER_INPUT,
             "-map_values and -map_values_2 span more than %d points", MAP_MAX_POINTS);
  PetscFunctionReturn(0);
}
