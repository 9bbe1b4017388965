/*
   Options of the modes: what is looked for, and by which route.
*/
#include "modesimpl.h"

static PetscErrorCode ModesCheckValues(Modes modes)
{
  PetscFunctionBeginUser;
  PetscCheck(modes->left || !modes->filters, modes->comm, PETSC_ERR_USER_INPUT,
             "-modes_filters needs left vectors: leave out -modes_left false");
  PetscCheck(modes->left || !modes->sensitivities, modes->comm, PETSC_ERR_USER_INPUT,
             "-modes_sensitivities needs left vectors: leave out -modes_left false");
  PetscCheck(modes->left || !modes->n_changes, modes->comm, PETSC_ERR_USER_INPUT,
             "-modes_changes needs left vectors: leave out -modes_left false");
  PetscCheck(!modes->has_band || modes->band[1] > modes->band[0], modes->comm, PETSC_ERR_USER_INPUT,
             "-modes_band %.6g,%.6g must satisfy 0 <= f1 < f2 (Hz)", (double)modes->band[0], (double)modes->band[1]);
  PetscFunctionReturn(0);
}

/* A band or a number of modes nearest to a frequency: what the command line says before what files say, of files the
   number. What is then not used is said, and taken out. */
static PetscErrorCode ModesChooseRange(Modes modes)
{
  PetscBool band, target, count;

  PetscFunctionBeginUser;
  modes->has_nearest = modes->has_target || modes->has_count ? PETSC_TRUE : PETSC_FALSE;
  if (!modes->has_band || !modes->has_nearest) PetscFunctionReturn(0);
  PetscCall(OptionsCommandGives("modes_band", &band));
  PetscCall(OptionsCommandGives("modes_target", &target));
  PetscCall(OptionsCommandGives("modes_count", &count));
  modes->has_both = band && (target || count) ? PETSC_TRUE : PETSC_FALSE; /* the row of the band refuses it */
  if (band)
    PetscCall(OptionsDrop(modes->comm, "-modes_target -modes_count", "the command line gives -modes_band"));
  else
    PetscCall(OptionsDrop(modes->comm, "-modes_band",
                          modes->has_count ? "-modes_count asks for the modes nearest to -modes_target"
                                           : "-modes_target asks for the modes nearest to it"));
  if (!band) modes->band[0] = modes->band[1] = 0; /* no edge of what is counted about a target */
  modes->has_band    = band;
  modes->has_nearest = band ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode ModesSetFromOptions(Modes modes)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesRead(modes->comm, &modes_quantities, modes));
  PetscCall(ChangesSetFromOptions(modes));
  PetscCall(ModesCheckValues(modes));
  PetscCall(ModesChooseRange(modes));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesVisit(Modes modes, const QuantityVisitor *visitor)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisit(visitor, &modes_quantities, NULL, modes, NULL));
  PetscCall(ChangesVisit(modes, visitor));
  PetscFunctionReturn(0);
}
