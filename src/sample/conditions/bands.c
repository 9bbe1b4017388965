/*
   Frequency bands of round width, 1, 2 or 5 times a power of ten, and how many conditions squeal in each, as reports of
   dynamometers count stops.
*/
#include "sample/sampleimpl.h"

#define BANDS_MOST 12 /* where nobody says which */

/* edge [n + 1], Hz, between low and high */
static PetscErrorCode BandEdgesChoose(PetscReal low, PetscReal high, PetscInt *n, PetscReal edge[])
{
  static const PetscReal digit[] = {1, 2, 5, 10};
  const PetscReal        least   = (high - low) / BANDS_MOST;
  const PetscReal        ten     = PetscPowReal(10, PetscFloorReal(log10(least)));
  PetscReal              width   = 0, first;

  PetscFunctionBeginUser;
  for (int k = 3; k >= 0; k--)
    if (digit[k] * ten >= least) width = digit[k] * ten;
  first = PetscFloorReal(low / width + 1e-9);
  *n    = 0;
  for (PetscReal k = first; *n < CONDITIONS_MAX_BANDS - 1; k++) {
    edge[(*n)++] = k * width;
    if (k * width >= high * (1 - 1e-9)) break;
  }
  --*n;
  PetscFunctionReturn(0);
}

/* Adds the modes of condition i */
static void BandCount(Sample s, PetscInt i, ConditionBand *band)
{
  const SamplePoint *point = &s->point[i];
  PetscBool          grows = PETSC_FALSE, open = PETSC_FALSE;

  for (PetscInt k = 0; k < point->n; k++) {
    const SampleMode *m = &point->mode[k];
    const PetscReal   f = m->omega / (2 * PETSC_PI);

    if (f < band->low || f >= band->high) continue;
    if (ModesLimitIsExceeded(&s->box.limit, m->sigma + m->growth_error, m->omega, 0) &&
        !ModesLimitIsExceeded(&s->box.limit, m->sigma, m->omega, m->error))
      open = PETSC_TRUE;
    if (ModesLimitJudge(&s->box.limit, m->sigma, m->omega, m->error) != MODE_UNSTABLE) continue;
    grows = PETSC_TRUE;
    band->n_modes++;
    if (band->worst >= 0 && m->sigma <= band->growth) continue;
    band->worst     = i;
    band->growth    = m->sigma;
    band->frequency = f;
  }
  band->n_conditions += grows;
  band->n_open += open && !grows;
}

/* Behind the bands comes one from the first edge to the last */
PetscErrorCode SampleBands(Sample s)
{
  const ReducedWindow *w = &s->box.window;
  PetscReal            edge[CONDITIONS_MAX_BANDS];
  PetscInt             n = s->n_edges - 1;

  PetscFunctionBeginUser;
  if (s->n_edges)
    PetscCall(PetscArraycpy(edge, s->edge, s->n_edges));
  else
    PetscCall(BandEdgesChoose(w->low / (2 * PETSC_PI), w->high / (2 * PETSC_PI), &n, edge));
  s->n_bands = n + 1;
  PetscCall(PetscMalloc1(s->n_bands, &s->band));
  for (PetscInt b = 0; b <= n; b++) {
    s->band[b] = (ConditionBand){.low = edge[b < n ? b : 0], .high = edge[b < n ? b + 1 : n], .worst = -1};
    for (PetscInt i = 0; i < s->n; i++) BandCount(s, i, &s->band[b]);
  }
  PetscFunctionReturn(0);
}
