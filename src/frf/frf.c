/*
   Frf: life cycle, options, and the flow: places -> modes -> residual term -> response and its error -> peaks.
*/
#include "frfimpl.h"
#include <squeal/options.h>
#include <string.h>

/* End of the band of modes where none is asked for, beside the highest frequency: what lies above changes little
   over the frequencies, and is the residual term's. */
#define BEYOND_HIGHEST 1.5

PetscErrorCode FrfCreate(MPI_Comm comm, Frf *frf)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, frf));
  (*frf)->comm = comm;
  PetscCall(QuantitiesInit(&frf_quantities, *frf));
  PetscFunctionReturn(0);
}

PetscErrorCode FrfSetOperators(Frf frf, Operators operators)
{
  PetscFunctionBeginUser;
  frf->operators = operators;
  PetscFunctionReturn(0);
}

PetscErrorCode FrfSetModes(Frf frf, Modes modes)
{
  PetscFunctionBeginUser;
  frf->modes = modes;
  PetscFunctionReturn(0);
}

PetscErrorCode FrfSetResults(Frf frf, Results results, Statics statics)
{
  PetscFunctionBeginUser;
  frf->journal = (Journal){frf->comm, results, frf->journal.scene, "a response", "response"};
  frf->statics = statics;
  PetscFunctionReturn(0);
}

PetscErrorCode FrfSetSound(Frf frf, Sound sound)
{
  PetscFunctionBeginUser;
  frf->sound = sound;
  PetscFunctionReturn(0);
}

PetscErrorCode FrfSetPencil(Frf frf, Pencil pencil)
{
  PetscFunctionBeginUser;
  frf->pencil = pencil;
  PetscFunctionReturn(0);
}

/* The frequencies that a text stands for */
static PetscErrorCode FrequenciesParse(Frf frf)
{
  PetscBool is_log;

  PetscFunctionBeginUser;
  PetscCall(ValuesParse(frf->comm, "-frf_frequencies", frf->frequencies, &frf->n, &frf->freq, &is_log));
  for (PetscInt i = 0; i < frf->n; i++)
    PetscCheck(frf->freq[i] > 0, frf->comm, PETSC_ERR_USER_INPUT,
               "-frf_frequencies %s holds %.6g: frequencies must be positive (Hz)", frf->frequencies,
               (double)frf->freq[i]);
  PetscFunctionReturn(0);
}

/* The times that a text stands for */
static PetscErrorCode TimesParse(Frf frf)
{
  PetscBool is_log;

  PetscFunctionBeginUser;
  PetscCall(ValuesParse(frf->comm, "-frf_times", frf->times, &frf->n_times, &frf->time, &is_log));
  for (PetscInt i = 0; i < frf->n_times; i++)
    PetscCheck(frf->time[i] >= 0, frf->comm, PETSC_ERR_USER_INPUT,
               "-frf_times %s holds %.6g s: the impulse acts at 0, before which nothing moves", frf->times,
               (double)frf->time[i]);
  PetscCheck(frf->method == FRF_MODAL, frf->comm, PETSC_ERR_USER_INPUT,
             "-frf_times needs the modes: leave out -frf_method direct");
  PetscFunctionReturn(0);
}

/* Raises an error for directions other than some of x, y, z, each once */
static PetscErrorCode DirectionsCheck(Frf frf)
{
  PetscBool good = frf->directions[0] ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  for (const char *c = frf->directions; *c; c++)
    if (!strchr("xyz", *c) || strchr(c + 1, *c)) good = PETSC_FALSE;
  PetscCheck(good, frf->comm, PETSC_ERR_USER_INPUT, "-frf_directions '%s' must be some of x, y, z", frf->directions);
  PetscFunctionReturn(0);
}

PetscErrorCode FrfSetFromOptions(Frf frf)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesRead(frf->comm, &frf_quantities, frf));
  PetscCall(DirectionsCheck(frf));
  if (frf->frequencies[0]) PetscCall(FrequenciesParse(frf));
  if (frf->times[0]) PetscCall(TimesParse(frf));
  PetscFunctionReturn(0);
}

PetscErrorCode FrfVisit(Frf frf, const QuantityVisitor *visitor)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisit(visitor, &frf_quantities, NULL, frf, NULL));
  PetscFunctionReturn(0);
}

/* The band of the modes must have something to do with the frequencies, and left vectors are needed */
static PetscErrorCode FrfCheckModes(Frf frf)
{
  const PetscReal low  = PetscMin(frf->freq[0], frf->freq[frf->n - 1]);
  const PetscReal high = PetscMax(frf->freq[0], frf->freq[frf->n - 1]);
  PetscBool       has_band, has_nearest, left;
  PetscReal       band[2] = {0, BEYOND_HIGHEST * high}, growth;

  PetscFunctionBeginUser;
  PetscCall(ModesHaveBand(frf->modes, &has_band));
  PetscCall(ModesWant(frf->modes, &has_nearest, &left));
  PetscCheck(left, frf->comm, PETSC_ERR_USER_INPUT,
             "-modes_left false: superposition of modes needs left vectors; leave it out, or give -frf_method direct");
  if (has_band) PetscCall(ModesGetBand(frf->modes, band, &growth));
  PetscCheck(low <= band[1] && high >= band[0], frf->comm, PETSC_ERR_USER_INPUT,
             "-frf_frequencies from %.6g to %.6g Hz: no mode of -modes_band %.6g,%.6g Hz is among them; widen the band",
             (double)low, (double)high, (double)band[0], (double)band[1]);
  if (!has_band && !has_nearest) PetscCall(ModesSetBand(frf->modes, band));
  PetscFunctionReturn(0);
}

PetscErrorCode FrfSetUp(Frf frf)
{
  PetscFunctionBeginUser;
  PetscCheck(frf->n, frf->comm, PETSC_ERR_USER_INPUT,
             "-frf_frequencies must be given: low:high:n, low:high:n:log, or f1,f2,... (Hz)");
  if (frf->method == FRF_MODAL) PetscCall(FrfCheckModes(frf));
  PetscCall(FrfFindForce(frf));
  PetscCall(FrfFindOutputs(frf));
  PetscFunctionReturn(0);
}

/* Raises an error for what a material whose stiffness depends on the frequency does not tell */
static PetscErrorCode FrfCheckLaws(Frf frf)
{
  const PetscReal ends[2] = {2 * PETSC_PI * frf->freq[0], 2 * PETSC_PI * frf->freq[frf->n - 1]};

  PetscFunctionBeginUser;
  if (!PencilHasLaws(frf->pencil)) PetscFunctionReturn(0);
  PetscCall(PencilCheckRange(frf->pencil, "-frf_frequencies",
                             (PetscReal[2]){PetscMin(ends[0], ends[1]), PetscMax(ends[0], ends[1])}));
  PetscCheck(!frf->n_times, frf->comm, PETSC_ERR_USER_INPUT,
             "-frf_times: an impulse response does not know stiffness that depends on the frequency as yet; leave it "
             "out");
  PetscFunctionReturn(0);
}

PetscErrorCode FrfSolve(Frf frf)
{
  PetscFunctionBeginUser;
  PetscCall(FrfCheckLaws(frf));
  PetscCall(PetscCalloc3(frf->n * frf->n_outputs, &frf->re, frf->n * frf->n_outputs, &frf->im, frf->n, &frf->error));
  if (FrfHears(frf)) {
    PetscCall(SoundGetRowSize(frf->sound, &frf->n_heard));
    frf->n_heard++;
    PetscCall(PetscCalloc1(frf->n * frf->n_heard, &frf->heard));
  }
  if (frf->method == FRF_DIRECT)
    PetscCall(FrfSolveDirect(frf));
  else
    PetscCall(FrfSolveModal(frf));
  PetscFunctionReturn(0);
}

PetscErrorCode FrfGet(Frf frf, PetscInt *n, const PetscReal **freq_hz, PetscInt *n_outputs, const FrfOutput **output)
{
  PetscFunctionBeginUser;
  *n         = frf->n;
  *freq_hz   = frf->freq;
  *n_outputs = frf->n_outputs;
  *output    = frf->output;
  PetscFunctionReturn(0);
}

PetscErrorCode FrfGetResponse(Frf frf, PetscInt i, const PetscReal **re, const PetscReal **im, PetscReal *error)
{
  PetscFunctionBeginUser;
  *re    = &frf->re[i * frf->n_outputs];
  *im    = &frf->im[i * frf->n_outputs];
  *error = frf->error[i];
  PetscFunctionReturn(0);
}

PetscErrorCode FrfGetPeaks(Frf frf, PetscInt *n, const FrfPeak **peaks)
{
  PetscFunctionBeginUser;
  *n     = frf->n_peaks;
  *peaks = frf->peak;
  PetscFunctionReturn(0);
}

PetscErrorCode FrfDestroy(Frf *frf)
{
  Frf s = *frf;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < s->n_places; i++) PetscCall(PetscFree(s->place[i]));
  PetscCall(PetscFree(s->place));
  PetscCall(PetscFree(s->freq));
  PetscCall(PetscFree(s->time));
  PetscCall(PetscFree(s->impulse));
  PetscCall(VecDestroy(&s->f));
  for (PetscInt p = 0; p < s->n_outputs; p++) PetscCall(VecDestroy(&s->l[p]));
  PetscCall(PetscFree(s->l));
  PetscCall(PetscFree(s->output));
  PetscCall(PetscFree3(s->re, s->im, s->error));
  PetscCall(PetscFree(s->peak));
  PetscCall(PetscFree(s->heard));
  PetscCall(ChecksumDestroy(&s->journal.scene));
  PetscCall(PetscFree(*frf));
  PetscFunctionReturn(0);
}
