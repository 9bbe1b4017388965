/*
   Coefficients over a cell. By the mean value theorem

      c(p) - c(pc) = sum_j dc/dt_j (xi) (t_j - tc_j),   |rest| <= sum_j h_j max |dc/dt_j - dc/dt_j (pc)|,

   and a derivative of a monomial is one itself: it grows or falls along each parameter that keeps its sign, so that the
   extremes of it over the cell are at corners. (Of p^2 across zero the largest distance from the middle is at a corner,
   too.) Parameters that one variable moves in step keep that as long as their powers have one sign.
*/
#include "enclosure.h"

/* dc/dt_j at t; p [n_parameters] is work */
static PetscReal SlopeAt(const Cube *cube, const OperatorsTerm *term, const PetscReal t[], PetscInt j, PetscReal p[])
{
  PetscReal slope = 0;

  CubePoint(cube, t, p);
  for (PetscInt m = 0; m < cube->n_moved[j]; m++)
    slope += OperatorsTermDerivative(term, p, cube->moved[j][m]) * 0.5 * (cube->upper[j][m] - cube->lower[j][m]);
  return slope;
}

/* Whether a variable moves what the term depends on */
static PetscBool TermVaries(const Cube *cube, const OperatorsTerm *term, PetscInt j)
{
  for (PetscInt m = 0; m < cube->n_moved[j]; m++)
    if (OperatorsTermDepends(term, cube->moved[j][m])) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode EnclosureFind(const Cube *cube, const OperatorsTerm *term, const PetscReal low[], const PetscReal high[],
                             Enclosure *e)
{
  PetscReal t[CUBE_MAX_VARIABLES], *p;

  PetscFunctionBeginUser;
  *e = (Enclosure){.remainder = 0};
  PetscCall(PetscMalloc1(cube->n_parameters, &p));
  for (PetscInt j = 0; j < cube->n; j++) {
    PetscReal largest = 0;

    if (!TermVaries(cube, term, j)) continue;
    for (PetscInt k = 0; k < cube->n; k++) t[k] = 0.5 * (low[k] + high[k]);
    e->slope[j] = SlopeAt(cube, term, t, j, p);
    for (unsigned corner = 0; corner < 1U << cube->n; corner++) {
      for (PetscInt k = 0; k < cube->n; k++) t[k] = corner >> k & 1 ? high[k] : low[k];
      largest = PetscMax(largest, PetscAbsReal(SlopeAt(cube, term, t, j, p) - e->slope[j]));
    }
    e->remainder += 0.5 * (high[j] - low[j]) * largest;
  }
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

/* Whether it takes both signs in the box */
static PetscBool ChangesSign(const Cube *cube, PetscInt parameter)
{
  for (PetscInt k = 0; k < cube->n; k++)
    for (PetscInt m = 0; m < cube->n_moved[k]; m++)
      if (cube->moved[k][m] == parameter && cube->lower[k][m] < 0 && cube->upper[k][m] > 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Raises the error for a factor of a term that varies */
static PetscErrorCode FactorCheck(MPI_Comm comm, const Cube *cube, const OperatorsParameter parameter[],
                                  const OperatorsTerm *term, PetscInt k)
{
  const OperatorsFriction *friction = term->factor[k].friction;
  const PetscInt           n = friction ? FRICTION_PARAMETERS : 1, power = term->factor[k].power;

  PetscFunctionBeginUser;
  for (PetscInt q = 0; q < n; q++) {
    const PetscInt index = friction ? friction->parameter[q] : term->factor[k].parameter;

    if (index < 0 || !ChangesSign(cube, index)) continue;
    PetscCheck((power == 1 || power == 2) && !term->factor[k].absolute, comm, PETSC_ERR_USER_INPUT,
               "the box must not reach across %s = 0: matrices depend on %s", parameter[index].name,
               term->factor[k].absolute ? "its size" : "a power of it that is not smooth there");
  }
  PetscFunctionReturn(0);
}

/* Whether a variable moves several parameters of a term of which the corners do not tell all: powers of both signs, as
   in a^2 / b, or parameters that are not positive */
static PetscBool StepsAgainst(const Cube *cube, const OperatorsTerm *term, PetscInt j)
{
  PetscInt  n = 0, n_up = 0;
  PetscBool positive = PETSC_TRUE;

  for (PetscInt m = 0; m < cube->n_moved[j]; m++)
    for (PetscInt k = 0; k < term->n; k++) {
      if (term->factor[k].friction || term->factor[k].parameter != cube->moved[j][m]) continue;
      n++;
      n_up += term->factor[k].power > 0 ? 1 : 0;
      if (!(cube->lower[j][m] > 0)) positive = PETSC_FALSE;
    }
  return n > 1 && !(positive && (n_up == 0 || n_up == n)) ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode EnclosureCheck(MPI_Comm comm, const Cube *cube, const OperatorsParameter parameter[], PetscInt n_terms,
                              const OperatorsTerm term[], PetscBool *exact)
{
  PetscFunctionBeginUser;
  *exact = PETSC_TRUE;
  for (PetscInt i = 0; i < n_terms; i++) {
    PetscBool varies = PETSC_FALSE;

    for (PetscInt j = 0; j < cube->n; j++) {
      if (TermVaries(cube, &term[i], j)) varies = PETSC_TRUE;
      if (StepsAgainst(cube, &term[i], j)) *exact = PETSC_FALSE;
    }
    for (PetscInt k = 0; k < term[i].n && varies; k++) {
      const OperatorsFriction *friction = term[i].factor[k].friction;

      PetscCall(FactorCheck(comm, cube, parameter, &term[i], k));
      if (friction && FrictionVaries(&friction->law)) *exact = PETSC_FALSE;
    }
  }
  PetscFunctionReturn(0);
}
