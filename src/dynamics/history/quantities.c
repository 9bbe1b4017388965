/* Options of what a run in time writes */
#include "historyimpl.h"

#define HISTORY_AT(member) QUANTITY_AT(struct _p_History, member)

static const Quantity rows[] = {
  {"-dynamics_history_interval", "time between rows of transient.csv", "s", QUANTITY_REAL, HISTORY_AT(rows.interval),
   .initial = 5e-6, QUANTITY_POSITIVE},
  {"-dynamics_pairs_interval", "time between the states in contact_pairs.csv; 0: none", "s", QUANTITY_REAL,
   HISTORY_AT(pairs.interval), QUANTITY_NOT_NEGATIVE},
  {"-dynamics_snapshot_interval", "time between fields; 0: none", "s", QUANTITY_REAL, HISTORY_AT(frames.interval),
   QUANTITY_NOT_NEGATIVE},
  {"-dynamics_live", "time of the clock between live lines; 0: none", "s", QUANTITY_REAL, HISTORY_AT(live.interval),
   .initial = 1, QUANTITY_NOT_NEGATIVE},
};

const QuantityTable history_quantities = {"History", "dynamics.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows,
                                          .in = RUN_HISTORY};
