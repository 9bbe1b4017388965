/*
   The response for people and for files.
*/
#include "frf/frfimpl.h"
#include "base/text.h"
#include <string.h>

#define COLUMN_ROOM 160 /* characters of a column's name and comma */

/* Frequency (Hz), damping ratio -sigma / |lambda| and label of the mode of a peak; zeros and "" for none. */
static PetscErrorCode PeakMode(Frf frf, const FrfPeak *peak, PetscReal *freq, PetscReal *ratio, const char **label)
{
  const Mode *mode;
  PetscInt    n;

  PetscFunctionBeginUser;
  *freq = *ratio = 0;
  *label         = "";
  if (peak->mode < 0) PetscFunctionReturn(0);
  PetscCall(ModesGet(frf->modes, &n, &mode));
  mode += peak->mode;
  *freq  = mode->omega / (2 * PETSC_PI);
  *ratio = mode->sigma == 0 ? 0 : -mode->sigma / hypot(mode->sigma, mode->omega);
  *label = mode->label;
  PetscFunctionReturn(0);
}

/* How it was computed, and how accurately */
static PetscErrorCode FrfViewMethod(Frf frf, PetscViewer viewer)
{
  PetscReal worst = 0, at = frf->freq[0];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < frf->n; i++) {
    const PetscReal relative = frf->error[i] / FrfMagnitude(frf, i);

    if (relative > worst) at = frf->freq[i];
    worst = PetscMax(worst, relative);
  }
  if (frf->method == FRF_DIRECT)
    PetscCall(PetscViewerASCIIPrintf(viewer, "  the whole system solved at each frequency\n"));
  else
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "  superposition of modes, residual term of %" PetscInt_FMT
                                     " steps with the factors of the modes (%" PetscInt_FMT
                                     " right-hand sides, %" PetscInt_FMT " vectors in all)\n",
                                     frf->n_steps - 1, frf->n_solves, frf->n_vectors));
  PetscCall(
    PetscViewerASCIIPrintf(viewer, "  largest estimated relative error %.1e, at %.6g Hz\n", (double)worst, (double)at));
  PetscFunctionReturn(0);
}

/* Modes among the frequencies that grow: the response to a force that lasts is never reached */
static PetscErrorCode FrfViewUnstable(Frf frf, PetscViewer viewer)
{
  const Mode *mode;
  PetscInt    n, n_unstable = 0;

  PetscFunctionBeginUser;
  if (frf->method == FRF_DIRECT) PetscFunctionReturn(0);
  PetscCall(ModesGet(frf->modes, &n, &mode));
  for (PetscInt i = 0; i < n; i++) n_unstable += mode[i].unstable;
  if (n_unstable)
    PetscCall(PetscViewerASCIIPrintf(
      viewer,
      "  %" PetscInt_FMT " of the modes unstable: this is the response of the equations, which no motion approaches\n",
      n_unstable));
  PetscFunctionReturn(0);
}

PetscErrorCode FrfView(Frf frf, PetscViewer viewer)
{
  const char *unit = "m/N";
  Model       model;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(frf->operators, &model, NULL));
  if (model) PetscCall(ModelGetUnit(model, unit, &unit));
  PetscCall(PetscViewerASCIIPrintf(
    viewer, "response to 1 N on %s: %" PetscInt_FMT " frequencies from %.6g to %.6g Hz, %" PetscInt_FMT " outputs\n",
    frf->input, frf->n, (double)frf->freq[0], (double)frf->freq[frf->n - 1], frf->n_outputs));
  PetscCall(FrfViewMethod(frf, viewer));
  PetscCall(FrfViewUnstable(frf, viewer));
  if (frf->n_peaks)
    PetscCall(PetscViewerASCIIPrintf(viewer, "   peak Hz    %4s   mode    freq Hz  damping %%  label\n", unit));
  for (PetscInt i = 0; i < frf->n_peaks; i++) {
    const FrfPeak *peak = &frf->peak[i];
    PetscReal      freq, ratio;
    const char    *label;

    PetscCall(PeakMode(frf, peak, &freq, &ratio, &label));
    PetscCall(PetscViewerASCIIPrintf(viewer, "%10.3f  %8.2e", (double)peak->freq_hz, (double)peak->magnitude));
    if (peak->mode >= 0)
      PetscCall(PetscViewerASCIIPrintf(viewer, "  %4" PetscInt_FMT " %10.3f %10.5f  %s", peak->mode + 1, (double)freq,
                                       (double)(100 * ratio), label));
    PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
  }
  PetscFunctionReturn(0);
}

/* frf.csv */
static PetscErrorCode FrfWriteResponse(Frf frf, Results results)
{
  const PetscInt n = frf->n_outputs, width = 2 * n + 3;
  char          *header, column[COLUMN_ROOM];
  PetscReal     *row;
  ResultsTable   table;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1((size_t)width * 2 * COLUMN_ROOM, &header));
  PetscCall(PetscMalloc1(width, &row));
  PetscCall(TextAdd(header, "freq_hz", (size_t)width * 2 * COLUMN_ROOM));
  for (PetscInt p = 0; p < n; p++) {
    PetscCall(PetscSNPrintf(column, sizeof(column), ",%s_re_m_n", frf->output[p].name));
    PetscCall(TextAdd(header, column, (size_t)width * 2 * COLUMN_ROOM));
    PetscCall(PetscSNPrintf(column, sizeof(column), ",%s_im_m_n", frf->output[p].name));
    PetscCall(TextAdd(header, column, (size_t)width * 2 * COLUMN_ROOM));
  }
  PetscCall(TextAdd(header, ",error_m_n,error_relative", (size_t)width * 2 * COLUMN_ROOM));
  PetscCall(ResultsTableOpen(results, "frf", header, &table));
  for (PetscInt i = 0; i < frf->n; i++) {
    row[0] = frf->freq[i];
    for (PetscInt p = 0; p < n; p++) row[2 * p + 1] = frf->re[i * n + p], row[2 * p + 2] = frf->im[i * n + p];
    row[2 * n + 1] = frf->error[i];
    row[2 * n + 2] = frf->error[i] > 0 ? frf->error[i] / FrfMagnitude(frf, i) : 0;
    PetscCall(ResultsTableNumbers(table, width, row));
  }
  PetscCall(ResultsTableClose(&table));
  PetscCall(PetscFree(header));
  PetscCall(PetscFree(row));
  PetscFunctionReturn(0);
}

/* impulse.csv */
static PetscErrorCode FrfWriteImpulse(Frf frf, Results results)
{
  const PetscInt n      = frf->n_outputs;
  const size_t   length = (size_t)(n + 1) * COLUMN_ROOM;
  char          *header, column[COLUMN_ROOM];
  PetscReal     *row;
  ResultsTable   table;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(length, &header));
  PetscCall(PetscMalloc1(n + 1, &row));
  PetscCall(TextAdd(header, "time_s", length));
  for (PetscInt p = 0; p < n; p++) {
    PetscCall(PetscSNPrintf(column, sizeof(column), ",%s_m_ns", frf->output[p].name));
    PetscCall(TextAdd(header, column, length));
  }
  PetscCall(ResultsTableOpen(results, "impulse", header, &table));
  for (PetscInt i = 0; i < frf->n_times; i++) {
    row[0] = frf->time[i];
    PetscCall(PetscArraycpy(row + 1, &frf->impulse[i * n], n));
    PetscCall(ResultsTableNumbers(table, n + 1, row));
  }
  PetscCall(ResultsTableClose(&table));
  PetscCall(PetscFree(header));
  PetscCall(PetscFree(row));
  PetscFunctionReturn(0);
}

/* peaks.csv */
static PetscErrorCode FrfWritePeaks(Frf frf, Results results)
{
  ResultsTable table;

  PetscFunctionBeginUser;
  PetscCall(ResultsTableOpen(results, "peaks", "freq_hz,magnitude_m_n,mode,mode_freq_hz,damping_ratio,label", &table));
  for (PetscInt i = 0; i < frf->n_peaks; i++) {
    const FrfPeak *peak = &frf->peak[i];
    PetscReal      freq, ratio;
    const char    *label;

    PetscCall(PeakMode(frf, peak, &freq, &ratio, &label));
    PetscCall(ResultsTableRow(table, "%.15g,%.15g,%d,%.15g,%.15g,\"%s\"", (double)peak->freq_hz,
                              (double)peak->magnitude, (int)peak->mode + 1, (double)freq, (double)ratio, label));
  }
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

PetscErrorCode FrfWrite(Frf frf, Results results)
{
  PetscFunctionBeginUser;
  PetscCall(FrfWriteResponse(frf, results));
  PetscCall(FrfWritePeaks(frf, results));
  if (frf->n_times) PetscCall(FrfWriteImpulse(frf, results));
  if (FrfHears(frf)) PetscCall(FrfWriteSound(frf, results));
  PetscCall(FrfForget(frf));
  PetscFunctionReturn(0);
}
