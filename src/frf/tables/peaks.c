/*
   Maxima of the response over the frequencies of the table.
*/
#include "frf/frfimpl.h"

#define PEAK_NEAR 0.03 /* of the frequency, within which a maximum is that of a mode */

/* sqrt(sum_p |H_p|^2), m/N. */
PetscReal FrfMagnitude(Frf frf, PetscInt i)
{
  PetscReal sum = 0;

  for (PetscInt p = i * frf->n_outputs; p < (i + 1) * frf->n_outputs; p++)
    sum += PetscSqr(frf->re[p]) + PetscSqr(frf->im[p]);
  return PetscSqrtReal(sum);
}

/* Whether frequency i is that of the mode: off by its half width, 3 %, or a step of the table at most. A mode further
   away may give most there, and makes no maximum */
static PetscErrorCode PeakIsOf(Frf frf, PetscInt i, PetscInt mode, PetscBool *is)
{
  const PetscReal freq = frf->freq[i], step = PetscMax(freq - frf->freq[i - 1], frf->freq[i + 1] - freq);
  const Mode     *all;
  PetscInt        n;
  PetscReal       most;

  PetscFunctionBeginUser;
  PetscCall(ModesGet(frf->modes, &n, &all));
  most = PetscMax(PetscMax(PEAK_NEAR * freq, step), PetscAbsReal(all[mode].sigma) / (2 * PETSC_PI));
  *is  = PetscAbsReal(all[mode].omega / (2 * PETSC_PI) - freq) <= most ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Inner points of the table that exceed the one before and are no less than the one after, so that a plateau of two
   is one peak; the ends are none. */
PetscErrorCode FrfFindPeaks(Frf frf, const FrfResidues *residues)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(frf->n, &frf->peak));
  for (PetscInt i = 1; i + 1 < frf->n; i++) {
    FrfPeak  *peak = &frf->peak[frf->n_peaks];
    PetscBool is   = PETSC_TRUE;

    *peak = (FrfPeak){.freq_hz = frf->freq[i], .magnitude = FrfMagnitude(frf, i), .mode = -1};
    if (peak->magnitude <= FrfMagnitude(frf, i - 1) || peak->magnitude < FrfMagnitude(frf, i + 1)) continue;
    if (residues) PetscCall(FrfResiduesLargest(frf, residues, 2 * PETSC_PI * peak->freq_hz, &peak->mode));
    if (peak->mode >= 0) PetscCall(PeakIsOf(frf, i, peak->mode, &is));
    if (!is) peak->mode = -1;
    frf->n_peaks++;
  }
  PetscFunctionReturn(0);
}
