/* Options of limit cycles */
#include "cycleimpl.h"

#define CYCLE_MOST_STEPS 1000001 /* in a period: more than any needs, and still counted twice over */
#define CYCLE_AT(member) QUANTITY_AT(struct _p_LimitCycle, member)

static const char *const starts[] = {[PETSC_FALSE] = "transient", [PETSC_TRUE] = "mode", NULL};

static const char *CycleIdleAlone(const void *cycle, const QuantityRun *run)
{
  (void)run;
  return ((const struct _p_LimitCycle *)cycle)->parameter[0] ? NULL : "not used without -cycle_parameter";
}

static const char *CycleIdleTransient(const void *cycle, const QuantityRun *run)
{
  (void)run;
  return ((const struct _p_LimitCycle *)cycle)->from_mode ? NULL : "not used without -cycle_start mode";
}

static const Quantity rows[] = {
  {"-cycle_steps", "steps in a period, odd, 7 at least; 0: as long as those of the transient", NULL, QUANTITY_INT,
   CYCLE_AT(steps), QUANTITY_WITHIN(0, CYCLE_MOST_STEPS), .why = "0 takes as many as the transient has in one"},
  {"-cycle_rtol", "how far a period may end from where it began, over the vibration's size", NULL, QUANTITY_REAL,
   CYCLE_AT(rtol), .initial = 1e-9, QUANTITY_WITHIN(1e-13, 1e-3), .why = "rounding allows no less"},
  {"-cycle_max_it", "iterations of Newton's method", NULL, QUANTITY_INT, CYCLE_AT(max_it), .initial = 30,
   QUANTITY_POSITIVE},
  {"-cycle_verify", "errors, by the cycles of twice the steps and of steps that begin elsewhere", NULL, QUANTITY_BOOL,
   CYCLE_AT(verify), .initial = PETSC_TRUE},
  {"-cycle_verify_cutoff", "errors of the reduction too, by cycles with 2.25 times -dynamics_cutoff", NULL,
   QUANTITY_BOOL, CYCLE_AT(verify_cutoff)},
  {"-cycle_parameter", "option of the scene over which cycles are followed, e.g. contact_mu, pad_young", NULL,
   QUANTITY_TEXT, CYCLE_AT(parameter)},
  {"-cycle_range", "where it ends, least and largest value", NULL, QUANTITY_REALS, CYCLE_AT(range),
   .given = offsetof(struct _p_LimitCycle, has_range), .idle = CycleIdleAlone},
  {"-cycle_points", "cycles on the branch, at most; half of them the first way", NULL, QUANTITY_INT,
   CYCLE_AT(max_points), .initial = 60, QUANTITY_LEAST(2), .idle = CycleIdleAlone},
  {"-cycle_start",
   "the first cycle: at the end of a transient, or near the value at which a mode of the sliding state becomes "
   "unstable",
   NULL, QUANTITY_WORD, CYCLE_AT(from_mode), .words = starts},
  {"-cycle_amplitude", "change of the pairs' normal forces in the first cycle of -cycle_start mode, of those at rest",
   NULL, QUANTITY_REAL, CYCLE_AT(amplitude), .initial = 0.3, QUANTITY_WITHIN(0, 10), .open = PETSC_TRUE,
   .idle = CycleIdleTransient},
};

const QuantityTable cycle_quantities = {"Limit cycles", "cycle.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows,
                                        .in = RUN_CYCLE};
