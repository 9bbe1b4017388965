/*
   Substructure: life cycle, options, and the flow: parts -> interface -> basis T -> T'A T -> modes and their errors.
*/
#include "substructureimpl.h"
#include <math.h>
#include <string.h>

#define SUBSTRUCTURE_EDGE   1e-6 /* of an end of the band: modes that are nearer count */
#define SUBSTRUCTURE_BEYOND 3    /* times the end of the band: the cut-off where none is given */

PetscErrorCode SubstructureCreate(MPI_Comm comm, Substructure *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, s));
  (*s)->comm = comm;
  (*s)->any  = -1;
  PetscCall(QuantitiesInit(&substructure_quantities, *s));
  PetscFunctionReturn(0);
}

/* Raises an error for a band that is none, and a cut-off within it */
static PetscErrorCode SubstructureCheckBand(Substructure s)
{
  PetscFunctionBeginUser;
  PetscCheck(!s->has_band || s->band[0] < s->band[1], s->comm, PETSC_ERR_USER_INPUT,
             "-superelement_band %.6g,%.6g Hz must begin below its end", (double)s->band[0], (double)s->band[1]);
  PetscCheck(
    !s->has_cutoff || !s->has_band || s->cutoff > s->band[1], s->comm, PETSC_ERR_USER_INPUT,
    "-superelement_cutoff %.6g Hz must be above the end of -superelement_band, %.6g Hz: modes up to it are kept",
    (double)s->cutoff, (double)s->band[1]);
  if (!s->has_cutoff) s->cutoff = SUBSTRUCTURE_BEYOND * s->band[1];
  PetscFunctionReturn(0);
}

PetscErrorCode SubstructureSetFromOptions(Substructure s)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesRead(s->comm, &substructure_quantities, s));
  PetscCall(SubstructureCheckBand(s));
  for (PetscInt i = 0; i < s->n_formats; i++) {
    PetscInt k = 0;

    while (substructure_formats[k] && strcmp(substructure_formats[k], s->formats[i])) k++;
    PetscCheck(substructure_formats[k], s->comm, PETSC_ERR_USER_INPUT,
               "-superelement_formats '%s' is none of squeal, market, nastran, abaqus", s->formats[i]);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SubstructureVisit(Substructure s, const QuantityVisitor *visitor)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisit(visitor, &substructure_quantities, NULL, s, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode SubstructureSetOperators(Substructure s, Operators operators, const PetscReal p[])
{
  PetscFunctionBeginUser;
  s->operators = operators;
  s->p         = p;
  PetscFunctionReturn(0);
}

/* Raises an error where options do not say what to make */
static PetscErrorCode SubstructureCheck(Substructure s)
{
  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(s->operators, &s->model, NULL));
  PetscCheck(s->model, s->comm, PETSC_ERR_SUP,
             "-analysis superelement needs a mesh: matrices that are loaded tell no parts");
  PetscCheck(s->n_parts, s->comm, PETSC_ERR_USER_INPUT,
             "-superelement_parts must be given: the parts that become the superelement");
  PetscCheck(s->has_band, s->comm, PETSC_ERR_USER_INPUT,
             "-superelement_band must be given: f1,f2 in Hz, in which the superelement is to be right");
  PetscCheck(s->n_sets, s->comm, PETSC_ERR_USER_INPUT,
             "-superelement_sets must be given: the sets whose nodes are joined to others, such as bolts and ring");
  PetscFunctionReturn(0);
}

/* Raises the error where the parts by themselves, whose frequencies lie below those of the superelement, have no mode
   in the band: by the negative pivots of K - omega^2 M at its ends, before shapes are sought */
static PetscErrorCode SubstructureCheckModes(Substructure s)
{
  PencilMatrices pencil  = {.K = s->body.K, .M = s->body.M, .symmetric = PETSC_TRUE};
  ShiftInvert    counter = {.comm = s->comm};
  PetscReal      low = 2 * PETSC_PI * s->band[0] * (1 - SUBSTRUCTURE_EDGE), high = 2 * PETSC_PI * s->band[1];
  PetscInt       below, n;

  PetscFunctionBeginUser;
  PetscCall(ShiftInvertCountBelow(&pencil, -SUBSTRUCTURE_EDGE, &counter, &low, &below));
  PetscCall(ShiftInvertCountBelow(&pencil, SUBSTRUCTURE_EDGE, &counter, &high, &n));
  PetscCall(ShiftInvertDestroy(&counter));
  PetscCheck(n > below, s->comm, PETSC_ERR_USER_INPUT, SUBSTRUCTURE_NO_MODE, (double)s->band[0], (double)s->band[1]);
  PetscFunctionReturn(0);
}

PetscErrorCode SubstructureSolve(Substructure s)
{
  PetscInt n_inside;

  PetscFunctionBeginUser;
  PetscCall(SubstructureCheck(s));
  PetscCall(BodyCreate(s));
  PetscCall(SubstructureCheckModes(s));
  PetscCall(InterfaceCreate(s, s->method == SUBSTRUCTURE_NONE ? PETSC_TRUE : PETSC_FALSE));
  s->n = s->interface.n + s->interface.n_kept;
  PetscCallMPI(MPI_Allreduce(&s->interface.n_inside, &n_inside, 1, MPIU_INT, MPI_SUM, s->comm));
  if (n_inside && s->method == SUBSTRUCTURE_FIXED) PetscCall(FixedCreateBasis(s));
  if (n_inside && s->method == SUBSTRUCTURE_FREE) PetscCall(FreeCreateBasis(s));
  PetscCall(SubstructureReduce(s));
  PetscCall(SubstructureMeasure(s));
  PetscFunctionReturn(0);
}

PetscErrorCode SubstructureDestroy(Substructure *substructure)
{
  Substructure s = *substructure;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(0);
  for (PetscInt j = 0; j < s->body.n_matrices && s->A; j++) PetscCall(MatDestroy(&s->A[j]));
  PetscCall(PetscFree(s->A));
  PetscCall(MatDestroy(&s->K));
  PetscCall(MatDestroy(&s->M));
  PetscCall(MatDestroy(&s->C));
  PetscCall(MatDestroy(&s->T));
  PetscCall(ShiftInvertDestroy(&s->inside));
  PetscCall(InterfaceDestroy(&s->interface));
  PetscCall(BodyDestroy(&s->body));
  PetscCall(PetscFree(s->mode));
  for (PetscInt i = 0; i < s->n_parts; i++) PetscCall(PetscFree(s->parts[i]));
  for (PetscInt i = 0; i < s->n_sets; i++) PetscCall(PetscFree(s->sets[i]));
  for (PetscInt i = 0; i < s->n_formats; i++) PetscCall(PetscFree(s->formats[i]));
  PetscCall(PetscFree(s->parts));
  PetscCall(PetscFree(s->sets));
  PetscCall(PetscFree(s->formats));
  PetscCall(PetscFree(*substructure));
  PetscFunctionReturn(0);
}
