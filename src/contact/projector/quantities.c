/* Options of contact in time */
#include "projectorimpl.h"

static const char *const ranks[] = {[PROJECTOR_AUTO] = "auto", [PROJECTOR_ONE] = "one", [PROJECTOR_ALL] = "all", NULL};
static const char *const kinematics[] = {[PETSC_FALSE] = "prescribed", [PETSC_TRUE] = "turning", NULL};

static const Quantity forces[] = {
  {"-projector_max_it", "sweeps of Gauss-Seidel", NULL, QUANTITY_INT, QUANTITY_AT(struct _p_ContactProjector, max_it),
   .initial = 1000, QUANTITY_POSITIVE},
  {"-projector_ranks",
   "ranks that solve the contact pairs: one, all, or all only from 1,000 pairs on and where that is faster (auto)",
   NULL, QUANTITY_WORD, QUANTITY_AT(struct _p_ContactProjector, ranks), .words = ranks},
};
static const char *FactorsIdle(const void *sliding, const QuantityRun *run)
{
  (void)run;
  return ((const ContactSliding *)sliding)->temperature[0] ? NULL : "not used without -@temperature_history";
}

static const Quantity sliding[] = {
  {"-kinematics", "add the sliding velocity, or move the master", NULL, QUANTITY_WORD,
   QUANTITY_AT(ContactSliding, turning), .words = kinematics},
  {"-temperature_history",
   "file of time_s,temperature, straight between its rows: friction changes with it by -..._mu_temperature", NULL,
   QUANTITY_PATH, QUANTITY_AT(ContactSliding, temperature), .path = "file", .in = RUN_HISTORY},
  {"-mu_temperature",
   "file of temperature,factor: factor of the friction coefficient over temperature, in the unit of the history; "
   "straight "
   "between its rows",
   NULL, QUANTITY_PATH, QUANTITY_AT(ContactSliding, factors), .path = "file", .in = RUN_HISTORY, .idle = FactorsIdle},
};

const QuantityTable projector_quantities = {"Contact forces in dynamics", "projector.h",
                                            PETSC_STATIC_ARRAY_LENGTH(forces), forces, .in = RUN_MESH};
const QuantityTable sliding_quantities   = {"Sliding in time of contact", "projector.h",
                                            PETSC_STATIC_ARRAY_LENGTH(sliding), sliding, .in = RUN_IN_TIME};
