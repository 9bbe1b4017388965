/*
   Operators: life cycle, parameters, and the matrices of the bodies alone. A mesh makes terms (bodies/assemble.c,
   points/joint.c, bodies/spin.c), matrices from files are terms themselves (files/); K, M and C of any point p are
   sums of them (terms/sum.c). Parameters stand in the order: those of the parts, N_PART_PARAMETERS each, layers,
   springs and dashpots, bushings and points, superelements, spins, contacts, loads; other files count on the first two
   (bodies/force.c).
*/
#include "operators/superelement/superelement.h"
#include "operators/files/matrixterm.h"
#include "operators/files/nodetable.h"
#include "base/events.h"
#include <math.h>
#include <unistd.h>

PetscErrorCode OperatorsCreate(MPI_Comm comm, Operators *operators)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, operators));
  (*operators)->mu        = -1;
  (*operators)->comm      = comm;
  (*operators)->symmetric = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsSetModel(Operators operators, Model model, Contact contact)
{
  PetscFunctionBeginUser;
  operators->model   = model;
  operators->contact = contact;
  PetscCall(SuperelementsAddUnknowns(operators));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsSetFromOptions(Operators operators)
{
  PetscBool have;

  PetscFunctionBeginUser;
  PetscCall(MatrixTermsSetFromOptions(operators));
  PetscCall(OperatorsLoadFromOptions(operators));
  PetscCall(QuantitiesRead(operators->comm, &operators_quantities, operators));
  PetscCall(OperatorsHaveMatrices(operators, &have));
  PetscCheck(have || !operators->nodes[0], operators->comm, PETSC_ERR_USER_INPUT,
             "-operators_nodes %s is of matrices that are loaded; a mesh knows its nodes", operators->nodes);
  if (have) PetscCall(QuantitiesRead(operators->comm, &operators_loaded, operators));
  PetscCall(SuperelementsSetFromOptions(operators));
  PetscCheck(!have || !operators->n_superelements, operators->comm, PETSC_ERR_USER_INPUT,
             "-superelements need a mesh, and are not used beside matrices that are loaded; give -terms for these");
  PetscCall(MatrixTermsAddParameters(operators));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsVisit(Operators operators, const QuantityVisitor *visitor)
{
  PetscBool have;

  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisitList(visitor, &operators_terms, operators->n_named, operators->named));
  PetscCall(MatrixTermsVisitParameters(operators, visitor));
  PetscCall(SuperelementsVisit(operators, visitor));
  PetscCall(QuantitiesVisit(visitor, &operators_matrices, NULL, operators, NULL));
  PetscCall(QuantitiesVisit(visitor, &operators_quantities, NULL, operators, NULL));
  PetscCall(OperatorsHaveMatrices(operators, &have));
  if (have) PetscCall(QuantitiesVisit(visitor, &operators_loaded, NULL, operators, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsLump(Operators operators)
{
  PetscFunctionBeginUser;
  operators->lump = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsOmitMatrices(Operators operators)
{
  PetscFunctionBeginUser;
  operators->omit = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsHaveMatrices(Operators operators, PetscBool *have)
{
  PetscFunctionBeginUser;
  *have = PETSC_FALSE;
  for (int i = 0; i < N_OPERATORS; i++)
    if (operators->load[i][0] || operators->n_dense[i]) *have = PETSC_TRUE;
  for (PetscInt t = 0; t < operators->n_named; t++)
    if (operators->named[t].file[0] || operators->named[t].n_dense) *have = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsHaveNodes(Operators operators, PetscBool *have)
{
  PetscFunctionBeginUser;
  *have = operators->model || operators->nodes[0] ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsHaveTerms(Operators operators, PetscBool *have)
{
  PetscFunctionBeginUser;
  *have = operators->n_named || operators->n_superelements ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsHaveDamping(Operators operators, PetscBool *have)
{
  PetscFunctionBeginUser;
  *have = operators->load[OPERATOR_C][0] || operators->n_dense[OPERATOR_C] ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt t = 0; t < operators->n_named; t++)
    if (operators->named[t].kind == OPERATORS_DAMPING || operators->named[t].law.kind) *have = PETSC_TRUE;
  for (PetscInt i = 0; i < operators->n_superelements + operators->n_pieces; i++)
    if (operators->superelements[i].file[SUPERELEMENT_C][0]) *have = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* The order of parameters is made here, once; `body` marks those that exist without contact. Units are those of the
   model from here on. */
PetscErrorCode OperatorsSetUp(Operators operators)
{
  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_ASSEMBLE));
  if (operators->model) {
    PetscCall(OperatorsAssemble(operators));
    PetscCall(SuperelementsSetUp(operators));
    PetscCall(OperatorsCreateDependents(operators));
    PetscCall(OperatorsAddSpinParameters(operators));
    for (PetscInt i = 0; i < operators->parameters.n; i++) operators->parameters.list[i].body = PETSC_TRUE;
    PetscCall(OperatorsAddContactParameters(operators));
    PetscCall(OperatorsAddLoadParameters(operators));
  } else {
    PetscCall(OperatorsLoad(operators));
    if (operators->nodes[0]) PetscCall(CloudCreate(operators));
  }
  for (PetscInt i = 0; i < operators->parameters.n; i++) {
    OperatorsParameter *q = &operators->parameters.list[i];

    if (operators->model) PetscCall(ModelGetUnit(operators->model, q->unit, &q->unit));
    /* MATRIX_LARGEST: products of a few such numbers must stay finite */
    PetscCheck(PetscIsInfReal(q->value) || PetscAbsReal(q->value) <= MATRIX_LARGEST, operators->comm,
               PETSC_ERR_USER_INPUT, "-%s %.6g must be of at most %g", q->name, (double)q->value, MATRIX_LARGEST);
  }
  PetscCall(EventEnd(EVENT_ASSEMBLE));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetParameters(Operators operators, PetscInt *n, const OperatorsParameter **parameters)
{
  PetscFunctionBeginUser;
  *n          = operators->parameters.n;
  *parameters = operators->parameters.list;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetTerms(Operators operators, PetscInt *n, const OperatorsTerm **terms)
{
  PetscFunctionBeginUser;
  *n     = operators->terms.n;
  *terms = operators->terms.term;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetSave(Operators operators, const char **folder)
{
  PetscFunctionBeginUser;
  *folder = operators->save;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetModel(Operators operators, Model *model, Contact *contact)
{
  PetscFunctionBeginUser;
  if (model) *model = operators->model;
  if (contact) *contact = operators->contact;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsDestroy(Operators *operators)
{
  Operators o = *operators;

  PetscFunctionBeginUser;
  if (!o) PetscFunctionReturn(0);
  if (o->save_lock > 0) (void)close(o->save_lock);
  for (int i = 0; i < N_OPERATORS; i++) PetscCall(PetscFree(o->dense[i]));
  PetscCall(OperatorsReleaseBodies(o));
  PetscCall(TermsDestroy(&o->terms));
  PetscCall(TermsDestroy(&o->spin));
  PetscCall(OperatorsDestroyLaws(o));
  PetscCall(PetscFree(o->spin_of_part));
  PetscCall(PetscFree(o->thickness));
  PetscCall(OperatorsDestroyContactParameters(o));
  PetscCall(PetscFree(o->load_size));
  PetscCall(PetscFree(o->joint));
  PetscCall(MatDestroy(&o->Z));
  PetscCall(MatDestroy(&o->E));
  PetscCall(PetscFree(o->follows));
  PetscCall(ParametersDestroy(&o->parameters));
  PetscCall(MatrixTermsDestroy(o));
  PetscCall(CloudDestroy(o));
  PetscCall(SuperelementsDestroy(o));
  PetscCall(PetscFree(*operators));
  PetscFunctionReturn(0);
}
