/* Options of maps */
#include "mapimpl.h"

#define MAP_AT(member) QUANTITY_AT(struct _p_Map, member)

static const char *const directions[] = {
  [MAP_BOTH] = "both", [MAP_UP] = "up", [MAP_DOWN] = "down", [MAP_APART] = "apart", NULL};

static const char *UndisturbedIdle(const void *map, const QuantityRun *run)
{
  (void)run;
  return ((const struct _p_Map *)map)->n_disturbances ? NULL : "not used without -map_disturbances";
}

static const Quantity rows[] = {
  {"-map_parameter", "one or two options of the scene to vary, e.g. contact_mu,press_force", NULL, QUANTITY_TEXT,
   MAP_AT(parameter)},
  {"-map_values", "first:last:n, first:last:n:log, or v1,v2,... in the parameter's unit", NULL, QUANTITY_TEXT,
   MAP_AT(values[0])},
  {"-map_values_2", "those of the second parameter", NULL, QUANTITY_TEXT, MAP_AT(values[1])},
  {"-map_link", "parameters that take the same value, e.g. inner_mu,outer_mu; ':' between", NULL, QUANTITY_TEXT,
   MAP_AT(link), .given = offsetof(struct _p_Map, linked)},
  {"-map_direction",
   "ways through the values of the first parameter, each from the end of its neighbour, or every point from its own "
   "sliding state",
   NULL, QUANTITY_WORD, MAP_AT(direction), .initial = MAP_BOTH, .words = directions},
  {"-map_window", "of which amplitude and frequency are taken", "s", QUANTITY_REAL, MAP_AT(window), .initial = 5e-3,
   QUANTITY_WITHIN(0, 1e6), .open = PETSC_TRUE},
  {"-map_rtol", "change of the rms between windows, or standard error of its mean, below which an amplitude is settled",
   NULL, QUANTITY_REAL, MAP_AT(rtol), .initial = 0.01, QUANTITY_WITHIN(0, 1), .open = PETSC_TRUE},
  {"-map_verify",
   "points, spread over the map, run again with half the step, with the contact laws to 1e-12, and with 2.25 times the "
   "cut-off",
   NULL, QUANTITY_INT, MAP_AT(n_verify), QUANTITY_NOT_NEGATIVE, .why = "a number of points"},
  {"-map_twins",
   "transients beside that of a point whose amplitude or regime rounding could change: one, and all where it does; 0: "
   "rounding is not "
   "in error_estimate",
   NULL, QUANTITY_INT, MAP_AT(n_twins), .initial = 3, QUANTITY_WITHIN(0, MAP_MAX_TWINS)},
  {"-map_disturbances",
   "runs of each point from its sliding state with random velocities, as blows at all contact pairs give them: which "
   "motions there are, and how probable each is",
   NULL, QUANTITY_INT, MAP_AT(n_disturbances), QUANTITY_WITHIN(0, MAP_MAX_DISTURBANCES)},
  {"-map_disturbance", "energy of these velocities", "J", QUANTITY_REAL, MAP_AT(disturbance), .initial = 1e-3,
   QUANTITY_POSITIVE, .idle = UndisturbedIdle},
  {"-map_disturbance_least",
   "least energy of these velocities, whose logarithms are spread evenly up to -map_disturbance; 0: all have that one",
   "J", QUANTITY_REAL, MAP_AT(disturbance_least), QUANTITY_NOT_NEGATIVE, .idle = UndisturbedIdle},
  {"-map_seed", "another one draws other velocities; the same on any number of ranks", NULL, QUANTITY_INT, MAP_AT(seed),
   .initial = 1, QUANTITY_NOT_NEGATIVE, .why = "a number of draws", .idle = UndisturbedIdle},
  {"-map_restart", "go on where a map of the same scene in -output_dir was stopped", NULL, QUANTITY_BOOL,
   MAP_AT(restart), .initial = PETSC_TRUE},
};

const QuantityTable map_quantities = {"Map", "map.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows, .in = RUN_MAP};
