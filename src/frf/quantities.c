/* Options of frequency responses */
#include "frfimpl.h"

#define FRF_AT(member) QUANTITY_AT(struct _p_Frf, member)

static const char *const methods[] = {[FRF_MODAL] = "modal", [FRF_DIRECT] = "direct", NULL};

static const char *FrfIdleDirect(const void *frf, const QuantityRun *run)
{
  (void)run;
  return ((const struct _p_Frf *)frf)->method == FRF_DIRECT ? "not used by -frf_method direct" : NULL;
}

static const char *FrfIdleModal(const void *frf, const QuantityRun *run)
{
  (void)run;
  return ((const struct _p_Frf *)frf)->method == FRF_MODAL ? "not used without -frf_method direct" : NULL;
}

static const Quantity rows[] = {
  {"-frf_force", "where a force of 1 N acts: a probe and x, y, z or three numbers", NULL, QUANTITY_TEXT, FRF_AT(force)},
  {"-frf_directions", "in which the response is recorded: some of x, y, z", NULL, QUANTITY_TEXT, FRF_AT(directions),
   .text = "xyz", .given = offsetof(struct _p_Frf, has_directions)},
  {"-frf_frequencies", "low:high:n, low:high:n:log, or f1,f2,...", "Hz", QUANTITY_TEXT, FRF_AT(frequencies)},
  {"-frf_times", "of the answer to an impulse of 1 N s: low:high:n, or t1,t2,...", "s", QUANTITY_TEXT, FRF_AT(times)},
  {"-frf_method", "superposition of modes, or the whole system at each frequency", NULL, QUANTITY_WORD, FRF_AT(method),
   .initial = FRF_MODAL, .words = methods},
  {"-frf_rtol", "largest estimated relative error of superposition (an estimate, no bound)", NULL, QUANTITY_REAL,
   FRF_AT(rtol), .initial = 1e-8, QUANTITY_POSITIVE, .idle = FrfIdleDirect},
  {"-frf_max_steps", "most steps of the residual term", NULL, QUANTITY_INT, FRF_AT(max_steps), .initial = 30,
   QUANTITY_POSITIVE, .idle = FrfIdleDirect},
  {"-frf_restart", "go on where a direct response of the same scene in -output_dir was stopped", NULL, QUANTITY_BOOL,
   FRF_AT(restart), .initial = PETSC_TRUE, .idle = FrfIdleModal},
  {"-frf_probes", "where the response is recorded: probes, circles; default all probes", NULL, QUANTITY_NAMES,
   FRF_AT(place), .count = offsetof(struct _p_Frf, n_places)},
};

const QuantityTable frf_quantities = {"Frequency response", "frf.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows,
                                      .in = RUN_FRF};
