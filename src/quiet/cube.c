/*
   The box of the parameters: what options say of it, and its points.
*/
#include "cube.h"
#include "sweep/grid/grid.h"
#include <squeal/options.h>

PetscErrorCode CubeVaried(const CubeOptions *options, size_t size, char varied[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(varied, options->names, size));
  for (char *c = varied; *c; c++)
    if (*c == '+') *c = ',';
  PetscFunctionReturn(0);
}

void CubeMove(const Cube *cube, const PetscReal t[], PetscReal p[])
{
  for (PetscInt k = 0; k < cube->n; k++)
    for (PetscInt m = 0; m < cube->n_moved[k]; m++)
      p[cube->moved[k][m]] = cube->lower[k][m] + 0.5 * (t[k] + 1) * (cube->upper[k][m] - cube->lower[k][m]);
}

void CubePoint(const Cube *cube, const PetscReal t[], PetscReal p[])
{
  for (PetscInt i = 0; i < cube->n_parameters; i++) p[i] = cube->nominal[i];
  CubeMove(cube, t, p);
}

PetscReal CubeValue(const Cube *cube, PetscInt k, PetscReal t)
{
  return cube->lower[k][0] + 0.5 * (t + 1) * (cube->upper[k][0] - cube->lower[k][0]);
}

/* Of one variable, beside the width on its side of the scene's own value; beyond an end that is that value: outside */
static PetscReal DistanceAlong(const Cube *cube, PetscInt k, PetscReal t)
{
  const PetscReal own = cube->own[k], width = t < own ? own + 1 : 1 - own;

  if (t == own) return 0;
  return width > 0 ? PetscAbsReal(t - own) / width : PETSC_MAX_REAL;
}

PetscReal CubeDistance(const Cube *cube, const PetscReal t[])
{
  PetscReal distance = 0;

  for (PetscInt k = 0; k < cube->n; k++) distance = PetscMax(distance, DistanceAlong(cube, k, t[k]));
  return distance;
}

PetscReal CubeNear(const Cube *cube, const PetscReal low[], const PetscReal high[])
{
  PetscReal distance = 0;

  for (PetscInt k = 0; k < cube->n; k++)
    distance = PetscMax(distance, DistanceAlong(cube, k, PetscMin(PetscMax(cube->own[k], low[k]), high[k])));
  return distance;
}

/* The parameters of a variable, "inner_mu+outer_mu" */
static PetscErrorCode VariableNames(MPI_Comm comm, Operators operators, CubeState state, const char option[],
                                    Cube *cube, PetscInt k)
{
  const OperatorsParameter *list;
  PetscInt                  n;
  char                    **word;
  int                       n_words;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(operators, &n, &list));
  PetscCall(ValuesSplit(comm, option, cube->name[k], '+', &n_words, &word));
  cube->n_moved[k] = n_words;
  PetscCall(PetscMalloc3(n_words, &cube->moved[k], n_words, &cube->lower[k], n_words, &cube->upper[k]));
  for (int m = 0; m < n_words; m++) {
    PetscCall(GridParameterFind(comm, operators, option, word[m], &cube->moved[k][m]));
    PetscCall(GridParameterCheck(comm, operators, state != CUBE_NO_STATE ? PETSC_TRUE : PETSC_FALSE, option, word[m]));
    PetscCheck(!list[cube->moved[k][m]].state || state == CUBE_OWN_STATE, comm, PETSC_ERR_USER_INPUT,
               "%s %s changes modes through the sliding state alone, %s; leave it out", option, word[m],
               state == CUBE_NO_STATE ? "about which they are not" : "which is that of the scene everywhere");
    for (PetscInt l = 0; l <= k; l++)
      for (PetscInt i = 0; i < (l == k ? m : cube->n_moved[l]); i++)
        PetscCheck(cube->moved[l][i] != cube->moved[k][m], comm, PETSC_ERR_USER_INPUT, "%s names '%s' twice", option,
                   word[m]);
  }
  PetscCall(OperatorsCheckMoved(operators, option, cube->n_moved[k], cube->moved[k]));
  PetscCall(PetscStrToArrayDestroy(n_words, word));
  PetscFunctionReturn(0);
}

/* Ends by percent of each parameter's own value, or by values, which are those of each */
static PetscErrorCode VariableEnds(MPI_Comm comm, Operators operators, const char prefix[], const CubeOptions *o,
                                   Cube *cube, PetscInt k)
{
  const OperatorsParameter *list;
  PetscInt                  n;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(operators, &n, &list));
  for (PetscInt m = 0; m < cube->n_moved[k]; m++) {
    const PetscInt  i   = cube->moved[k][m];
    const PetscReal own = cube->nominal[i], part = o->percent[o->n_percent > 1 ? k : 0] / 100;
    PetscReal      *lower = &cube->lower[k][m], *upper = &cube->upper[k][m];

    PetscCheck(!o->n_percent || own != 0, comm, PETSC_ERR_USER_INPUT,
               "-%s_percent: %s is 0 in this scene, and so is any part of it; give -%s_lower and -%s_upper", prefix,
               list[i].name, prefix, prefix);
    *lower = o->n_percent ? own - part * PetscAbsReal(own) : o->lower[k];
    *upper = o->n_percent ? own + part * PetscAbsReal(own) : o->upper[k];
    PetscCheck(*lower < *upper, comm, PETSC_ERR_USER_INPUT, "-%s_lower %.6g of %s must be below -%s_upper %.6g", prefix,
               (double)*lower, list[i].name, prefix, (double)*upper);
    PetscCheck(own >= *lower && own <= *upper, comm, PETSC_ERR_USER_INPUT,
               "-%s_lower %.6g and -%s_upper %.6g of %s must hold the value of the scene, %.6g, between them", prefix,
               (double)*lower, prefix, (double)*upper, list[i].name, (double)own);
    PetscCall(OperatorsCheckParameter(operators, i, *lower));
    PetscCall(OperatorsCheckParameter(operators, i, *upper));
    cube->own[k] = 2 * (own - *lower) / (*upper - *lower) - 1;
    PetscCheck(o->n_percent || own == cube->nominal[cube->moved[k][0]], comm, PETSC_ERR_USER_INPUT,
               "-%s_lower: %s moves parameters whose values in the scene differ; give -%s_percent", prefix,
               cube->name[k], prefix);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode CubeRead(MPI_Comm comm, Operators operators, CubeState state, const char prefix[], const CubeOptions *o,
                        Cube *cube)
{
  const OperatorsParameter *list;
  char                      option[64];
  char                    **word;
  int                       n;
  PetscInt                  n_moved = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(option, sizeof(option), "-%s_parameters", prefix));
  PetscCheck(o->names[0], comm, PETSC_ERR_USER_INPUT, "%s names nothing: what is to vary, e.g. pad_young,contact_mu",
             option);
  PetscCall(ValuesSplit(comm, option, o->names, ',', &n, &word));
  PetscCheck(n <= CUBE_MAX_VARIABLES, comm, PETSC_ERR_USER_INPUT, "%s names %d; %d at most, '+' joins some to one",
             option, n, CUBE_MAX_VARIABLES);
  PetscCheck((o->n_percent > 0) != (o->n_lower + o->n_upper > 0), comm, PETSC_ERR_USER_INPUT,
             "-%s_percent, or else -%s_lower and -%s_upper, must say how large the box is", prefix, prefix, prefix);
  PetscCheck(o->n_percent <= 1 || o->n_percent == n, comm, PETSC_ERR_USER_INPUT,
             "-%s_percent has %" PetscInt_FMT " values for %d variables; give one, or one for each", prefix,
             o->n_percent, n);
  PetscCheck(o->n_percent || (o->n_lower == n && o->n_upper == n), comm, PETSC_ERR_USER_INPUT,
             "-%s_lower and -%s_upper have %" PetscInt_FMT " and %" PetscInt_FMT " values for %d variables", prefix,
             prefix, o->n_lower, o->n_upper, n);
  PetscCall(OperatorsGetParameters(operators, &cube->n_parameters, &list));
  for (int k = 0; k < n; k++) {
    PetscCall(PetscStrallocpy(word[k], &cube->name[k]));
    cube->n = k + 1;
    PetscCall(VariableNames(comm, operators, state, option, cube, k));
    PetscCall(VariableEnds(comm, operators, prefix, o, cube, k));
    n_moved += cube->n_moved[k];
  }
  PetscCheck(n_moved <= CUBE_MAX_MOVED, comm, PETSC_ERR_USER_INPUT, "%s names %" PetscInt_FMT " options; %d at most",
             option, n_moved, CUBE_MAX_MOVED);
  PetscCall(PetscStrToArrayDestroy(n, word));
  PetscFunctionReturn(0);
}

PetscInt CubeMoved(const Cube *cube, PetscInt parameter[], PetscInt variable[], PetscReal lower[], PetscReal upper[])
{
  PetscInt n = 0;

  for (PetscInt k = 0; k < cube->n; k++)
    for (PetscInt m = 0; m < cube->n_moved[k]; m++) {
      parameter[n] = cube->moved[k][m];
      variable[n]  = k;
      lower[n]     = cube->lower[k][m];
      upper[n]     = cube->upper[k][m];
      n++;
    }
  return n;
}

PetscErrorCode CubeDestroy(Cube *cube)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < cube->n; k++) {
    PetscCall(PetscFree(cube->name[k]));
    PetscCall(PetscFree3(cube->moved[k], cube->lower[k], cube->upper[k]));
  }
  cube->n = 0;
  PetscFunctionReturn(0);
}
