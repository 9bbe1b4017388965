/*
   Maxima of the response over the frequencies of the table.
*/
#include "frfimpl.h"

PetscReal FrfMagnitude(Frf frf, PetscInt i)
{
  PetscReal sum = 0;

  for (PetscInt p = i * frf->n_outputs; p < (i + 1) * frf->n_outputs; p++)
    sum += PetscSqr(frf->re[p]) + PetscSqr(frf->im[p]);
  return PetscSqrtReal(sum);
}

PetscErrorCode FrfFindPeaks(Frf frf, const FrfResidues *residues)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(frf->n, &frf->peak));
  for (PetscInt i = 1; i + 1 < frf->n; i++) {
    FrfPeak *peak = &frf->peak[frf->n_peaks];

    *peak = (FrfPeak){.freq_hz = frf->freq[i], .magnitude = FrfMagnitude(frf, i), .mode = -1};
    if (peak->magnitude <= FrfMagnitude(frf, i - 1) || peak->magnitude < FrfMagnitude(frf, i + 1)) continue;
    if (residues) PetscCall(FrfResiduesLargest(frf, residues, 2 * PETSC_PI * peak->freq_hz, &peak->mode));
    frf->n_peaks++;
  }
  PetscFunctionReturn(0);
}
