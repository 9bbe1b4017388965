/*
   The axes of a sweep: which parameters take which values. -sweep_parameter names the swept one of each axis,
   -sweep_link those that move with it: all of a link take the same value p at every point, so that along the axis

      d lambda / d p = sum_i d lambda / d p_i    over the parameters i of the link.
*/
#include "sweep/sweepimpl.h"
#include "base/options/axes.h"
#include <string.h>

/* Of a grid: more points are a mistake in the values, not a sweep. */
#define MAX_POINTS 1000000

/* Raises an error for the stiffness damping of a part with a loss factor, which is part of it */
static PetscErrorCode ParameterCheckLoss(MPI_Comm comm, Model model, const char option[], const char name[])
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(model, &scene));
  for (PetscInt i = 0; i < scene->n_parts; i++) {
    const Part  *p      = &scene->parts[i];
    const size_t length = strlen(p->name);

    PetscCheck(p->loss == 0 || strncmp(name, p->name, length) || strcmp(name + length, "_beta"), comm,
               PETSC_ERR_USER_INPUT, "%s %s replaces what -%s_loss_factor %.6g gives: leave one of them out", option,
               name, p->name, (double)p->loss);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode GridParameterCheck(MPI_Comm comm, Operators operators, PetscBool sliding, const char option[],
                                  const char name[])
{
  const ContactInterface *interfaces;
  PetscInt                n = 0;
  Model                   model;
  Contact                 contact;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(operators, &model, &contact));
  if (model) PetscCall(ParameterCheckLoss(comm, model, option, name));
  if (contact) PetscCall(ContactGetInterfaces(contact, &n, &interfaces));
  for (PetscInt i = 0; i < n; i++) {
    const size_t      length = strlen(interfaces[i].name);
    const char *const what   = strncmp(name, interfaces[i].name, length) ? "" : name + length;

    PetscCheck(!interfaces[i].identify || strcmp(what, "_kn"), comm, PETSC_ERR_USER_INPUT,
               "-%s identify does nothing where %s %s gives its values", name, option, name);
    PetscCheck(!sliding || strcmp(what, "_force"), comm, PETSC_ERR_USER_INPUT,
               "%s %s does nothing with -modes_contact static, which takes the normal forces from the -loads", option,
               name);
  }
  PetscFunctionReturn(0);
}

/* Raises the error for a load that presses where a stiffness is identified, which is that of the scene's own load */
static PetscErrorCode AxisCheckLoad(Sweep sweep, const char option[], const char name[])
{
  const ContactInterface *interfaces;
  PetscInt                n;
  Contact                 contact;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(sweep->operators, NULL, &contact));
  PetscCall(ContactGetInterfaces(contact, &n, &interfaces));
  for (PetscInt i = 0; i < n; i++)
    PetscCheck(
      !interfaces[i].identify, sweep->comm, PETSC_ERR_USER_INPUT,
      "%s %s: -%s_kn identify presses with the load of the scene, not with that of each point; give the stiffness",
      option, name, interfaces[i].name);
  PetscFunctionReturn(0);
}

/* A parameter of axis k. One that changes modes through the sliding state alone (a load, mu with statics) needs
   -modes_contact static. */
static PetscErrorCode AxisAdd(void *ctx, const char option[], const char name[], PetscInt k, const char **unit)
{
  const Sweep               sweep = ctx;
  SweepGrid                *grid  = &sweep->grid;
  const OperatorsParameter *list;
  PetscInt                  n, index;

  PetscFunctionBeginUser;
  PetscCall(GridParameterFind(sweep->comm, sweep->operators, option, name, &index));
  PetscCall(GridParameterCheck(sweep->comm, sweep->operators, sweep->statics ? PETSC_TRUE : PETSC_FALSE,
                               "-sweep_parameter", name));
  PetscCall(OperatorsGetParameters(sweep->operators, &n, &list));
  PetscCheck(sweep->statics || !list[index].state, sweep->comm, PETSC_ERR_USER_INPUT,
             "%s %s changes modes through the sliding state alone; give -modes_contact static", option, name);
  *unit = list[index].unit;
  if (list[index].state && *unit[0]) PetscCall(AxisCheckLoad(sweep, option, name)); /* mu has no unit */
  PetscCall(PetscRealloc((size_t)(grid->n_moved[k] + 1) * sizeof(PetscInt), &grid->parameter[k]));
  grid->parameter[k][grid->n_moved[k]++] = index;
  grid->n_axes                           = PetscMax(grid->n_axes, k + 1);
  PetscFunctionReturn(0);
}

/* The values of axis k, checked against what each of its parameters may be */
static PetscErrorCode AxisValues(Sweep sweep, PetscInt k)
{
  static const char *const options[] = {"-sweep_values", "-sweep_values_2"};
  SweepGrid               *grid      = &sweep->grid;

  PetscFunctionBeginUser;
  PetscCheck(strlen(sweep->values[k]) < SWEEP_MAX_TEXT - 1, sweep->comm, PETSC_ERR_USER_INPUT,
             "%s is longer than %d characters; give a range first:last:n", options[k], SWEEP_MAX_TEXT);
  PetscCall(GridValuesParse(sweep->comm, options[k], sweep->values[k], &grid->n[k], &grid->value[k], &grid->ratio[k]));
  for (PetscInt i = 0; i < grid->n[k]; i++)
    for (PetscInt j = 0; j < grid->n_moved[k]; j++)
      PetscCall(OperatorsCheckParameter(sweep->operators, grid->parameter[k][j], grid->value[k][i]));
  PetscFunctionReturn(0);
}

PetscErrorCode SweepAxes(Sweep sweep)
{
  SweepGrid      *grid  = &sweep->grid;
  const AxesGiven given = {sweep->comm,
                           "sweep",
                           "swept",
                           sweep->parameter,
                           sweep->linked ? sweep->link : NULL,
                           sweep->values[1][0] ? PETSC_TRUE : PETSC_FALSE};

  PetscFunctionBeginUser;
  PetscCall(AxesRead(&given, AxisAdd, sweep));
  for (PetscInt k = 0; k < grid->n_axes; k++)
    PetscCall(OperatorsCheckMoved(sweep->operators, "-sweep_parameter", grid->n_moved[k], grid->parameter[k]));
  if (sweep->sensitivities) PetscCall(OperatorsCheckMoved(sweep->operators, "-sweep_sensitivities", 0, NULL));
  for (PetscInt k = 0; k < grid->n_axes; k++) PetscCall(AxisValues(sweep, k));
  PetscCheck(grid->n_axes == 1 || grid->n[0] <= MAX_POINTS / grid->n[1], sweep->comm, PETSC_ERR_USER_INPUT,
             "-sweep_values and -sweep_values_2 span more than %d points", MAX_POINTS);
  PetscCheck(!sweep->n_verify || grid->n[0] > 1, sweep->comm, PETSC_ERR_USER_INPUT,
             "-sweep_verify looks between the -sweep_values: give two or more");
  PetscCall(GridCreatePlaces(grid));
  PetscFunctionReturn(0);
}
