/*
   The axes of a sweep: which parameters take which values. -sweep_parameter names the swept one of each axis,
   -sweep_link those that move with it: all of a link take the same value p at every point, so that along the axis

      d lambda / d p = sum_i d lambda / d p_i    over the parameters i of the link.
*/
#include "sweepimpl.h"
#include <squeal/options.h>
#include <string.h>

#define MAX_POINTS 1000000 /* of a grid */

/* Raises an error for the stiffness damping of a part with a loss factor, which is part of it */
static PetscErrorCode AxisCheckLoss(Sweep sweep, Model model, const char name[])
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(model, &scene));
  for (PetscInt i = 0; i < scene->n_parts; i++) {
    const Part  *p      = &scene->parts[i];
    const size_t length = strlen(p->name);

    PetscCheck(p->loss == 0 || strncmp(name, p->name, length) || strcmp(name + length, "_beta"), sweep->comm,
               PETSC_ERR_USER_INPUT,
               "-sweep_parameter %s replaces what -%s_loss_factor %.6g gives: leave one of them out", name, p->name,
               (double)p->loss);
  }
  PetscFunctionReturn(0);
}

/* Raises the error for a parameter that would be overwritten at every point */
static PetscErrorCode AxisCheck(Sweep sweep, const char name[])
{
  const ContactInterface *interfaces;
  PetscInt                n = 0;
  Model                   model;
  Contact                 contact;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(sweep->operators, &model, &contact));
  if (model) PetscCall(AxisCheckLoss(sweep, model, name));
  if (contact) PetscCall(ContactGetInterfaces(contact, &n, &interfaces));
  for (PetscInt i = 0; i < n; i++) {
    const size_t      length = strlen(interfaces[i].name);
    const char *const what   = strncmp(name, interfaces[i].name, length) ? "" : name + length;

    PetscCheck(!interfaces[i].identify || strcmp(what, "_kn"), sweep->comm, PETSC_ERR_USER_INPUT,
               "-%s identify does nothing where -sweep_parameter %s gives its values", name, name);
    PetscCheck(!sweep->statics || strcmp(what, "_force"), sweep->comm, PETSC_ERR_USER_INPUT,
               "-sweep_parameter %s does nothing with -modes_contact static, which takes the normal forces from the "
               "-loads",
               name);
  }
  PetscFunctionReturn(0);
}

/* Adds a parameter of a link to the axis of the swept one */
static PetscErrorCode LinkAdd(Sweep sweep, PetscInt axis, PetscInt index)
{
  SweepGrid                *grid = &sweep->grid;
  const OperatorsParameter *list, *swept, *added;
  PetscInt                  n;
  PetscBool                 same;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(sweep->operators, &n, &list));
  swept = &list[grid->parameter[axis][0]];
  added = &list[index];
  PetscCall(PetscStrcmp(swept->unit, added->unit, &same));
  PetscCheck(same, sweep->comm, PETSC_ERR_USER_INPUT,
             "-sweep_link names %s, of %s, with %s, of %s: what takes the same values has the same unit", added->name,
             added->unit[0] ? added->unit : "no unit", swept->name, swept->unit[0] ? swept->unit : "no unit");
  PetscCheck(GridAxisOf(grid, index) < 0, sweep->comm, PETSC_ERR_USER_INPUT, "-sweep_link '%s' names '%s' twice",
             sweep->link, added->name);
  PetscCall(AxisCheck(sweep, added->name));
  PetscCall(PetscRealloc((size_t)(grid->n_moved[axis] + 1) * sizeof(PetscInt), &grid->parameter[axis]));
  grid->parameter[axis][grid->n_moved[axis]++] = index;
  PetscFunctionReturn(0);
}

/* Takes one link; seen [n_axes] = whether the swept parameter was already in a link */
static PetscErrorCode LinkTake(Sweep sweep, const char text[], PetscBool seen[])
{
  SweepGrid *grid = &sweep->grid;
  PetscInt  *index, axis = -1;
  char     **names;
  int        n;

  PetscFunctionBeginUser;
  PetscCall(ValuesSplit(sweep->comm, "-sweep_link", text, ',', &n, &names));
  PetscCheck(n > 1, sweep->comm, PETSC_ERR_USER_INPUT,
             "-sweep_link '%s' must name two or more parameters, e.g. inner_mu,outer_mu", text);
  PetscCall(PetscMalloc1(n, &index));
  for (int i = 0; i < n; i++) {
    PetscCall(GridParameterFind(sweep->comm, sweep->operators, "-sweep_link", names[i], &index[i]));
    for (PetscInt k = 0; k < grid->n_axes; k++) {
      if (index[i] != grid->parameter[k][0]) continue;
      PetscCheck(axis < 0 || axis == k, sweep->comm, PETSC_ERR_USER_INPUT,
                 "-sweep_link '%s' holds both parameters that are swept; it must hold one of them", text);
      PetscCheck(!seen[k], sweep->comm, PETSC_ERR_USER_INPUT, "-sweep_link '%s' names '%s' twice", sweep->link,
                 names[i]);
      axis    = k;
      seen[k] = PETSC_TRUE;
    }
  }
  PetscCheck(axis >= 0, sweep->comm, PETSC_ERR_USER_INPUT,
             "-sweep_link '%s' does nothing: it must hold what is swept, -sweep_parameter %s", text, sweep->parameter);
  for (int i = 0; i < n; i++)
    if (index[i] != grid->parameter[axis][0]) PetscCall(LinkAdd(sweep, axis, index[i]));
  PetscCall(PetscFree(index));
  PetscCall(PetscStrToArrayDestroy(n, names));
  PetscFunctionReturn(0);
}

/* The parameters that move with the swept ones */
static PetscErrorCode LinksTake(Sweep sweep)
{
  PetscBool seen[GRID_MAX_AXES] = {PETSC_FALSE};
  char    **links;
  int       n;

  PetscFunctionBeginUser;
  if (!sweep->linked) PetscFunctionReturn(0);
  PetscCall(ValuesSplit(sweep->comm, "-sweep_link", sweep->link, ':', &n, &links));
  PetscCheck(n > 0, sweep->comm, PETSC_ERR_USER_INPUT,
             "-sweep_link '%s' must name two or more parameters, e.g. inner_mu,outer_mu", sweep->link);
  for (int i = 0; i < n; i++) PetscCall(LinkTake(sweep, links[i], seen));
  PetscCall(PetscStrToArrayDestroy(n, links));
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
  SweepGrid *grid = &sweep->grid;
  char     **names;
  int        n_names;

  PetscFunctionBeginUser;
  PetscCall(ValuesSplit(sweep->comm, "-sweep_parameter", sweep->parameter, ',', &n_names, &names));
  PetscCheck(n_names == 1 || n_names == 2, sweep->comm, PETSC_ERR_USER_INPUT,
             "-sweep_parameter '%s' must name one or two options of the scene, e.g. pad_young", sweep->parameter);
  PetscCheck((n_names == 2) == (sweep->values[1][0] != '\0'), sweep->comm, PETSC_ERR_USER_INPUT,
             "-sweep_values_2 belongs to a second -sweep_parameter: give both or neither");
  for (; grid->n_axes < n_names; grid->n_axes++) {
    const PetscInt k = grid->n_axes;

    PetscCall(PetscMalloc1(1, &grid->parameter[k]));
    PetscCall(GridParameterFind(sweep->comm, sweep->operators, "-sweep_parameter", names[k], grid->parameter[k]));
    PetscCall(AxisCheck(sweep, names[k]));
    PetscCheck(GridAxisOf(grid, grid->parameter[k][0]) < 0, sweep->comm, PETSC_ERR_USER_INPUT,
               "-sweep_parameter names '%s' twice", names[k]);
    grid->n_moved[k] = 1;
  }
  PetscCall(PetscStrToArrayDestroy(n_names, names));
  PetscCall(LinksTake(sweep));
  for (PetscInt k = 0; k < grid->n_axes; k++)
    PetscCall(OperatorsCheckMoved(sweep->operators, "-sweep_parameter", grid->n_moved[k], grid->parameter[k]));
  if (sweep->sensitivities) PetscCall(OperatorsCheckMoved(sweep->operators, "-sweep_sensitivities", 0, NULL));
  for (PetscInt k = 0; k < grid->n_axes; k++) PetscCall(AxisValues(sweep, k));
  PetscCheck(n_names == 1 || grid->n[0] <= MAX_POINTS / grid->n[1], sweep->comm, PETSC_ERR_USER_INPUT,
             "-sweep_values and -sweep_values_2 span more than %d points", MAX_POINTS);
  PetscCheck(!sweep->n_verify || grid->n[0] > 1, sweep->comm, PETSC_ERR_USER_INPUT,
             "-sweep_verify looks between the -sweep_values: give two or more");
  PetscCall(GridCreatePlaces(grid));
  PetscFunctionReturn(0);
}
