/*
   Points p of the parameters: made from the present one or another, and checked where a caller varies one of them.
*/
#include "operators/files/matrixterm.h"

PetscErrorCode OperatorsCreatePoint(Operators operators, const PetscReal from[], PetscReal **p)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(operators->parameters.n, p));
  PetscCall(PetscArraycpy(*p, OperatorsPoint(operators, from), operators->parameters.n));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsCheckParameter(Operators operators, PetscInt parameter, PetscReal value)
{
  PetscReal *p;

  PetscFunctionBeginUser;
  PetscCall(ParameterCheck(operators->comm, &operators->parameters.list[parameter], value));
  PetscCall(OperatorsCreatePoint(operators, NULL, &p));
  p[parameter] = value;
  PetscCall(OperatorsCheckFriction(operators, p));
  for (PetscInt t = 0; t < operators->terms.n && operators->n_named; t++) {
    const PetscReal c = OperatorsTermCoefficient(&operators->terms.term[t], p);

    PetscCheck(PetscAbsReal(c) <= MATRIX_LARGEST, operators->comm, PETSC_ERR_USER_INPUT,
               "%s %.6g makes a matrix of -terms %g times as large: at most %g",
               operators->parameters.list[parameter].name, (double)value, (double)c, MATRIX_LARGEST);
  }
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}
