/* Options of runs in time */
#include "dynamicsimpl.h"

#define DYNAMICS_AT(member) QUANTITY_AT(struct _p_Dynamics, member)

static const char *const starts[] = {[START_REST] = "rest", [START_STATIC] = "static", NULL};

static const char *DynamicsIdleShape(const void *dynamics, const QuantityRun *run)
{
  (void)run;
  return ((const struct _p_Dynamics *)dynamics)->shape[0] ? NULL : "not used without -dynamics_shape";
}

static const char *DynamicsIdleFilters(const void *dynamics, const QuantityRun *run)
{
  (void)run;
  return ((const struct _p_Dynamics *)dynamics)->filters_dir[0] ? NULL : "not used without -dynamics_filters";
}

/* Of -ts_dt, and what means the same, one is enough */
static const char *DynamicsIdleTwice(const void *dynamics, const QuantityRun *run)
{
  (void)run;
  return ((const struct _p_Dynamics *)dynamics)->dt_given ? "the same as -ts_dt, which is given too; give one" : NULL;
}

static const char *DynamicsIdleFraction(const void *dynamics, const QuantityRun *run)
{
  const struct _p_Dynamics *d = dynamics;

  if (d->dt_asked <= 0) return NULL;
  return DynamicsIdleTwice(d, run) ? "not used beside -ts_dt" : "not used beside -ts_time_step";
}

static const char *DynamicsIdleForce(const void *dynamics, const QuantityRun *run)
{
  (void)run;
  return ((const struct _p_Dynamics *)dynamics)->dt_asked > 0 ? NULL : "not used without a -ts_dt";
}

static const Quantity rows[] = {
  {"-dynamics_step_fraction", "step, where -ts_dt is not given, of the critical one (-); it has six digits", NULL,
   QUANTITY_REAL, DYNAMICS_AT(fraction), .initial = 0.9, QUANTITY_WITHIN(PETSC_SMALL, 1), .in = RUN_MESH,
   .idle = DynamicsIdleFraction},
  {"-dynamics_step_force", "integrate with a -ts_dt above the critical step", NULL, QUANTITY_BOOL,
   DYNAMICS_AT(step_force), .in = RUN_MESH, .idle = DynamicsIdleForce},
  {"-ts_time_step", "the same as -ts_dt", "s", QUANTITY_REAL, DYNAMICS_AT(dt_asked), .idle = DynamicsIdleTwice},
  {"-dynamics_start", "at rest, or the sliding state under the loads", NULL, QUANTITY_WORD, DYNAMICS_AT(start),
   .initial = START_REST, .words = starts, .in = RUN_HISTORY},
  {"-dynamics_shape", "folder of a run of modes: one of them is added to the start", NULL, QUANTITY_PATH,
   DYNAMICS_AT(shape), .in = RUN_HISTORY, .path = "folder"},
  {"-dynamics_shape_mode", "its number in modes.csv", NULL, QUANTITY_INT, DYNAMICS_AT(shape_mode), .initial = 1,
   .idle = DynamicsIdleShape, .in = RUN_HISTORY},
  {"-dynamics_shape_amplitude", "its largest displacement", "m", QUANTITY_REAL, DYNAMICS_AT(shape_amplitude),
   .initial = 1e-9, .idle = DynamicsIdleShape, .in = RUN_HISTORY},
  {"-dynamics_filters", "folder of a run of modes with -modes_filters: their amplitudes in amplitudes.csv", NULL,
   QUANTITY_PATH, DYNAMICS_AT(filters_dir), .path = "folder"},
  {"-dynamics_filters_modes", "their numbers in modes.csv, 0 for all unstable ones", NULL, QUANTITY_INTS,
   DYNAMICS_AT(asked), .count = offsetof(struct _p_Dynamics, n_asked), .text = "0", .idle = DynamicsIdleFilters},
  {"-dynamics_coriolis", "Coriolis forces in parts that turn", NULL, QUANTITY_BOOL, DYNAMICS_AT(coriolis)},
  {"-dynamics_centrifugal", "centrifugal forces in parts that turn", NULL, QUANTITY_BOOL, DYNAMICS_AT(centrifugal)},
  {"-contact_view_kkt", "print the residuals of the contact laws at the end", NULL, QUANTITY_BOOL,
   DYNAMICS_AT(view_kkt), .in = RUN_HISTORY},
  {"-dynamics_checkpoint_interval", "steps between checkpoints, 0 for none", NULL, QUANTITY_INT,
   DYNAMICS_AT(checkpoint_interval), QUANTITY_NOT_NEGATIVE, .why = "a number of steps", .in = RUN_HISTORY},
  {"-dynamics_restart", "go on from the checkpoint in the output folder", NULL, QUANTITY_BOOL, DYNAMICS_AT(restart),
   .in = RUN_HISTORY},
};

const QuantityTable dynamics_quantities = {"Dynamics", "dynamics.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows,
                                           .in = RUN_IN_TIME};
