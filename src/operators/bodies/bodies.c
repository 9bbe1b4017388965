/*
   The bodies at a point p of the parameters, without contact: a vector of their unknowns, the material of a part, and K
   (N/m), M (kg), C (N s/m) as sums of terms.
*/
#include "operators/operatorsimpl.h"

PetscErrorCode OperatorsCreateVec(Operators operators, Vec *u)
{
  PetscFunctionBeginUser;
  if (operators->model)
    PetscCall(ModelCreateVec(operators->model, u));
  else
    PetscCall(MatCreateVecs(operators->terms.term[0].A, u, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetMaterial(Operators operators, const PetscReal p[], PetscInt part,
                                    OperatorsMaterial *material)
{
  /* parameters of the parts come first, N_PART_PARAMETERS of each (operators.c) */
  const PetscReal *value     = &OperatorsPoint(operators, p)[N_PART_PARAMETERS * part];
  const PetscInt   thickness = operators->thickness[part];

  PetscFunctionBeginUser;
  material->young     = value[PART_YOUNG];
  material->density   = value[PART_DENSITY];
  material->alpha     = value[PART_ALPHA];
  material->beta      = value[PART_BETA];
  material->thickness = thickness < 0 ? 0 : OperatorsPoint(operators, p)[thickness];
  PetscFunctionReturn(0);
}

/* Replaces the consistent mass of an element by the lumped one */
void OperatorsLumpMass(const Element *element, PetscReal mass[])
{
  const PetscInt n = 3 * element->n_nodes;
  PetscReal      lumped[ELEMENT_MAX_NODES];

  ElementLump(element, mass, lumped);
  for (PetscInt i = 0; i < n * n; i++) mass[i] = i % n == i / n ? lumped[i / n / 3] : 0;
}

/* Borrowed until the next call with another p, or OperatorsReleaseBodies(). *C is NULL without damping at p. */
PetscErrorCode OperatorsGetBodies(Operators operators, const PetscReal p[], Mat *K, Mat *M, Mat *C)
{
  static const TermsSumKind kinds[N_BODIES_SUMS] = {
    [BODIES_K] = {OPERATORS_STIFFNESS, TERMS_SYMMETRIC, 1},
    [BODIES_M] = {OPERATORS_MASS, TERMS_SYMMETRIC, 1},
    [BODIES_C] = {OPERATORS_DAMPING, TERMS_SYMMETRIC, 1},
  };
  Mat *const wanted[N_BODIES_SUMS] = {K, M, C};

  PetscFunctionBeginUser;
  for (int i = 0; i < N_BODIES_SUMS; i++) {
    if (!wanted[i]) continue;
    PetscCall(TermsSumForm(&operators->terms, &kinds[i], OperatorsPoint(operators, p), &operators->sum[i]));
    *wanted[i] = operators->sum[i].A;
    if (*wanted[i]) PetscCall(MatSetOption(*wanted[i], MAT_SYMMETRIC, operators->symmetric));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsReleaseBodies(Operators operators)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < N_BODIES_SUMS; i++) PetscCall(TermsSumDestroy(&operators->sum[i]));
  PetscFunctionReturn(0);
}
