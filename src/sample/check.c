/* Values of all points: what a parameter cannot be is an error that names the point, what is odd gives a line */
#include "sampleimpl.h"

/* Raises the error for a value that a parameter cannot have, with the sample or condition and the variable */
static PetscErrorCode PointCheckValue(Sample s, PetscInt i, const SampleVariable *v, PetscInt k, const PetscReal p[])
{
  const OperatorsParameter *list;
  PetscInt                  n;
  PetscBool                 above, below;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(s->operators, &n, &list));
  above = p[k] > list[k].upper ? PETSC_TRUE : PETSC_FALSE;
  below = p[k] > list[k].lower || (list[k].closed && p[k] == list[k].lower) ? PETSC_FALSE : PETSC_TRUE;
  PetscCheck((!above && !below) || !s->file[0], s->comm, PETSC_ERR_USER_INPUT,
             "-sample_conditions %s, condition %s, column %s: %s %.6g %s must %s %.6g", s->file,
             s->conditions.name[PetscMin(i, s->n - 1)], s->conditions.head[v->column], list[k].name, (double)p[k],
             list[k].unit,
             above            ? "be at most"
             : list[k].closed ? "be at least"
                              : "exceed",
             (double)(above ? list[k].upper : list[k].lower));
  PetscCheck((!above && !below) || s->file[0], s->comm, PETSC_ERR_USER_INPUT,
             "sample %" PetscInt_FMT ", -sample_variables %s: %s %.6g %s must %s %.6g; give -%s_lower, -%s_upper or "
             "another distribution",
             i + 1, v->name, list[k].name, (double)p[k], list[k].unit,
             above            ? "be at most"
             : list[k].closed ? "be at least"
                              : "exceed",
             (double)(above ? list[k].upper : list[k].lower), v->name, v->name);
  PetscCall(OperatorsCheckParameter(s->operators, k, p[k]));
  PetscFunctionReturn(0);
}

/* A line for a parameter that some samples give the other sign than the scene's own value has, as mu may have */
static PetscErrorCode VariableWarnSign(Sample s, const SampleVariable *v, PetscInt n)
{
  const OperatorsParameter *list;
  PetscInt                  n_list;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(s->operators, &n_list, &list));
  if (n && !list[v->moved[0]].of_matrices)
    PetscCall(PetscFPrintf(s->comm, stderr,
                           "squeal: warning: %s has the other sign than in the scene at %" PetscInt_FMT
                           " of %" PetscInt_FMT
                           " points (a negative friction coefficient: the other way of sliding); -%s_lower or "
                           "-%s_upper cuts it\n",
                           v->names[0], n, s->n_points, v->name, v->name));
  PetscFunctionReturn(0);
}

PetscErrorCode SamplesCheckValues(Sample s)
{
  PetscReal *p;
  PetscInt  *turned;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->box.n_base, &p));
  PetscCall(PetscCalloc1(s->n_variables, &turned));
  for (PetscInt i = 0; i < s->n_points; i++) {
    PetscCall(SampleGet(s, i, p));
    for (PetscInt k = 0; k < s->n_variables && !s->file[0]; k++)
      turned[k] += p[s->variable[k].moved[0]] * s->box.nominal[s->variable[k].moved[0]] < 0;
    for (PetscInt k = 0; k < s->n_variables; k++)
      for (PetscInt m = 0; m < s->variable[k].n_names; m++)
        PetscCall(PointCheckValue(s, i, &s->variable[k], s->variable[k].moved[m], p));
    for (PetscInt m = 0; m < s->n_reversed; m++)
      PetscCall(OperatorsCheckParameter(s->operators, s->reversed[m], p[s->reversed[m]]));
  }
  for (PetscInt k = 0; k < s->n_variables; k++) PetscCall(VariableWarnSign(s, &s->variable[k], turned[k]));
  PetscCall(PetscFree(turned));
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}
