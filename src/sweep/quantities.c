/* Options of sweeps */
#include "sweepimpl.h"

#define SWEEP_AT(member) QUANTITY_AT(struct _p_Sweep, member)

static const char *const methods[] = {[SWEEP_REDUCED] = "reduced", [SWEEP_FULL] = "full", [SWEEP_REAL] = "real", NULL};
static const char *const stiffnesses[] = {
  [SWEEP_SYMMETRISED] = "symmetrised", [SWEEP_FRICTIONLESS] = "frictionless", NULL};

static const char *SweepIdleNotReal(const void *sweep, const QuantityRun *run)
{
  (void)run;
  return ((const struct _p_Sweep *)sweep)->method == SWEEP_REAL ? NULL : "not used without -sweep_method real";
}

static const char *SweepIdleFull(const void *sweep, const QuantityRun *run)
{
  (void)run;
  return ((const struct _p_Sweep *)sweep)->method == SWEEP_FULL ? "not used by -sweep_method full" : NULL;
}

static const char *SweepIdleSolver(const void *sweep, const QuantityRun *run)
{
  const struct _p_Sweep *s = sweep;

  if (!(run->does & RUN_SWEEP) || s->method != SWEEP_REAL || s->n_verify) return NULL;
  return "not used by -sweep_method real without -sweep_verify";
}

static const Quantity rows[] = {
  {"-sweep_parameter", "one or two options of the scene to vary, e.g. pad_young,contact_mu", NULL, QUANTITY_TEXT,
   SWEEP_AT(parameter)},
  {"-sweep_values", "first:last:n, first:last:n:log, or v1,v2,... in the parameter's unit", NULL, QUANTITY_TEXT,
   SWEEP_AT(values[0])},
  {"-sweep_values_2", "those of the second parameter", NULL, QUANTITY_TEXT, SWEEP_AT(values[1])},
  {"-sweep_link", "parameters that take the swept one's value, e.g. inner_mu,outer_mu; several links with ':' between",
   NULL, QUANTITY_TEXT, SWEEP_AT(link), .given = offsetof(struct _p_Sweep, linked)},
  {"-sweep_method", "reduced basis with error estimate, every point in full, or each on real modes of its own", NULL,
   QUANTITY_WORD, SWEEP_AT(method), .initial = SWEEP_REDUCED, .given = offsetof(struct _p_Sweep, method_given),
   .words = methods},
  {"-sweep_rtol", "largest estimated relative error of an eigenvalue (an estimate, no bound)", NULL, QUANTITY_REAL,
   SWEEP_AT(rtol), .initial = 1e-6, .given = offsetof(struct _p_Sweep, rtol_given), QUANTITY_WITHIN(0, 1),
   .open = PETSC_TRUE, .idle = SweepIdleFull},
  {"-sweep_max_samples", "most full solutions; by itself more where contact status changes often", NULL, QUANTITY_INT,
   SWEEP_AT(max_samples), .initial = 20, .given = offsetof(struct _p_Sweep, max_given), QUANTITY_POSITIVE,
   .idle = SweepIdleFull},
  {"-sweep_real_modes", "real modes of each point, with -sweep_method real", NULL, QUANTITY_INT, SWEEP_AT(n_real),
   .initial = 80, QUANTITY_POSITIVE, .idle = SweepIdleNotReal},
  {"-sweep_real_stiffness", "of these modes: K + mu H made symmetric, or K alone", NULL, QUANTITY_WORD,
   SWEEP_AT(real_stiffness), .initial = SWEEP_SYMMETRISED, .words = stiffnesses, .idle = SweepIdleNotReal},
  {"-sweep_verify", "compare with full solutions at this many points between those of the sweep", NULL, QUANTITY_INT,
   SWEEP_AT(n_verify), QUANTITY_NOT_NEGATIVE},
  {"-sweep_onsets", "critical values of the first parameter, confirmed on the full problem", NULL, QUANTITY_BOOL,
   SWEEP_AT(onsets), .initial = PETSC_TRUE, .given = offsetof(struct _p_Sweep, onsets_given)},
  {"-sweep_sensitivities", "derivatives of every eigenvalue by every parameter", NULL, QUANTITY_BOOL,
   SWEEP_AT(sensitivities)},
  {"-sweep_groups", "ranks that share the points (0: all; the full solutions use all ranks)", NULL, QUANTITY_INT,
   SWEEP_AT(n_groups), QUANTITY_NOT_NEGATIVE},
  {"-sweep_restart", "go on where a sweep of the same scene in -output_dir was stopped", NULL, QUANTITY_BOOL,
   SWEEP_AT(restart), .initial = PETSC_TRUE},
  {"-eps_", NULL, NULL, QUANTITY_PREFIX, .in = RUN_LINEAR | RUN_REDUCED, .idle = SweepIdleSolver},
  {"-pep_", NULL, NULL, QUANTITY_PREFIX, .in = RUN_LINEAR | RUN_REDUCED, .idle = SweepIdleSolver},
};

const QuantityTable sweep_quantities = {"Sweep", "sweep.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows, .in = RUN_SWEEP};
