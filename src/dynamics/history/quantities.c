/* Options of what a run in time writes */
#include "historyimpl.h"

#define HISTORY_AT(member) QUANTITY_AT(struct _p_History, member)

static const char *HistoryIdleFrames(const void *history, const QuantityRun *run)
{
  const PetscBool asked = ((const struct _p_History *)history)->frames.interval > 0 ? PETSC_TRUE : PETSC_FALSE;

  return asked && !(run->does & RUN_FIELDS) ? "not used with -output_fields false" : NULL;
}

static const char *HistoryIdlePairs(const void *history, const QuantityRun *run)
{
  const PetscBool asked = ((const struct _p_History *)history)->pairs.interval > 0 ? PETSC_TRUE : PETSC_FALSE;

  return asked && !(run->does & RUN_CONTACTS) ? "not used without -contacts" : NULL;
}

static const Quantity rows[] = {
  {"-dynamics_history_interval", "time between rows of transient.csv", "s", QUANTITY_REAL, HISTORY_AT(rows.interval),
   .initial = 5e-6, QUANTITY_POSITIVE},
  {"-dynamics_pairs_interval", "time between the states in contact_pairs.csv; 0: none", "s", QUANTITY_REAL,
   HISTORY_AT(pairs.interval), QUANTITY_NOT_NEGATIVE, .idle = HistoryIdlePairs},
  {"-dynamics_snapshot_interval", "time between fields; 0: none", "s", QUANTITY_REAL, HISTORY_AT(frames.interval),
   QUANTITY_NOT_NEGATIVE, .idle = HistoryIdleFrames},
  {"-dynamics_live", "time of the clock between live lines; 0: none", "s", QUANTITY_REAL, HISTORY_AT(live.interval),
   .initial = 1, QUANTITY_NOT_NEGATIVE},
};

const QuantityTable history_quantities = {"History", "dynamics.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows,
                                          .in = RUN_HISTORY};
