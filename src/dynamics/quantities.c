/* Options of runs in time */
#include "dynamicsimpl.h"

#define DYNAMICS_AT(member) QUANTITY_AT(struct _p_Dynamics, member)

static const char *const starts[] = {[START_REST] = "rest", [START_STATIC] = "static", NULL};

static const char *DynamicsIdleShape(const void *dynamics)
{
  return ((const struct _p_Dynamics *)dynamics)->shape[0] ? NULL : "not used without -dynamics_shape";
}

static const char *DynamicsIdleFilters(const void *dynamics)
{
  return ((const struct _p_Dynamics *)dynamics)->filters_dir[0] ? NULL : "not used without -dynamics_filters";
}

static const Quantity rows[] = {
  {"-dynamics_step_fraction", "step, where -ts_dt is not given, of the critical one (-); it has six digits", NULL,
   QUANTITY_REAL, DYNAMICS_AT(fraction), .initial = 0.9, QUANTITY_WITHIN(PETSC_SMALL, 1)},
  {"-dynamics_step_force", "integrate with a -ts_dt above the critical step", NULL, QUANTITY_BOOL,
   DYNAMICS_AT(step_force)},
  {"-ts_time_step", "the same as -ts_dt", "s", QUANTITY_REAL, DYNAMICS_AT(dt_asked)},
  {"-dynamics_start", "at rest, or the sliding state under the loads", NULL, QUANTITY_WORD, DYNAMICS_AT(start),
   .initial = START_REST, .words = starts},
  {"-dynamics_shape", "folder of a run of modes: one of them is added to the start", NULL, QUANTITY_PATH,
   DYNAMICS_AT(shape)},
  {"-dynamics_shape_mode", "its number in modes.csv", NULL, QUANTITY_INT, DYNAMICS_AT(shape_mode), .initial = 1,
   .idle = DynamicsIdleShape},
  {"-dynamics_shape_amplitude", "its largest displacement", "m", QUANTITY_REAL, DYNAMICS_AT(shape_amplitude),
   .initial = 1e-9, .idle = DynamicsIdleShape},
  {"-dynamics_filters", "folder of a run of modes with -modes_filters: their amplitudes in amplitudes.csv", NULL,
   QUANTITY_PATH, DYNAMICS_AT(filters_dir)},
  {"-dynamics_filters_modes", "their numbers in modes.csv, 0 for all unstable ones", NULL, QUANTITY_INTS,
   DYNAMICS_AT(asked), .count = offsetof(struct _p_Dynamics, n_asked), .idle = DynamicsIdleFilters},
  {"-dynamics_coriolis", "Coriolis forces in parts that turn", NULL, QUANTITY_BOOL, DYNAMICS_AT(coriolis)},
  {"-dynamics_centrifugal", "centrifugal forces in parts that turn", NULL, QUANTITY_BOOL, DYNAMICS_AT(centrifugal)},
  {"-contact_view_kkt", "print the residuals of the contact laws at the end", NULL, QUANTITY_BOOL,
   DYNAMICS_AT(view_kkt)},
  {"-dynamics_checkpoint_interval", "steps between checkpoints, 0 for none", NULL, QUANTITY_INT,
   DYNAMICS_AT(checkpoint_interval), QUANTITY_NOT_NEGATIVE, .why = "a number of steps"},
  {"-dynamics_check_interval", "steps between looks at the laws by second paths, 0 for none", NULL, QUANTITY_INT,
   DYNAMICS_AT(laws.interval), .initial = 100000, QUANTITY_NOT_NEGATIVE, .why = "a number of steps"},
  {"-dynamics_restart", "go on from the checkpoint in the output folder", NULL, QUANTITY_BOOL, DYNAMICS_AT(restart)},
};

const QuantityTable dynamics_quantities = {"Dynamics", "dynamics.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows};
