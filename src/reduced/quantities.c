/* Options of reduced models */
#include "reducedimpl.h"

#define REDUCED_AT(member) QUANTITY_AT(struct _p_ReducedRun, member)

static const char *const models[] = {[PETSC_FALSE] = "full", [PETSC_TRUE] = "reduced", NULL};

static const char *ReducedIdle(const void *reduced, const QuantityRun *run)
{
  (void)run;
  return ((const struct _p_ReducedRun *)reduced)->request.asked ? NULL : "not used without -dynamics_model reduced";
}

static const char *ReducedIdleChosen(const void *reduced, const QuantityRun *run)
{
  const struct _p_ReducedRun *r = reduced;

  return r->request.cutoff > 0 ? "not used where -dynamics_cutoff says the cut-off" : ReducedIdle(r, run);
}

static const char *const contacts[] = {[PETSC_FALSE] = "exact", [PETSC_TRUE] = "penalty", NULL};

static const Quantity rows[] = {
  {"-dynamics_model", "the mesh, or its bodies' modes and the pairs' compliance", NULL, QUANTITY_WORD,
   REDUCED_AT(request.asked), .words = models},
  {"-dynamics_cutoff", "of the modes of a reduced model; 0: 4 times the end of -modes_band, or 20 kHz", "Hz",
   QUANTITY_REAL, REDUCED_AT(request.cutoff), QUANTITY_WITHIN(0, 1e30), .why = "0 has it chosen", .idle = ReducedIdle},
  {"-dynamics_dense",
   "most pairs of a reduced transient for a dense compliance, beyond: a solution with the sparse factors in each "
   "product",
   NULL, QUANTITY_INT, REDUCED_AT(request.dense), .initial = 2500, QUANTITY_WITHIN(0, 1e9), .idle = ReducedIdle,
   .in = RUN_TRANSIENT},
  {"-dynamics_contact",
   "of a reduced model: rigid surfaces, or surfaces that yield as -..._kn or -..._pressure_law of their contact says",
   NULL, QUANTITY_WORD, REDUCED_AT(request.springs), .words = contacts, .idle = ReducedIdle},
  {"-dynamics_growth_rtol",
   "error of growth in -modes_band, or without it of all modes, for which a cut-off and a step are chosen", NULL,
   QUANTITY_REAL, REDUCED_AT(request.growth_rtol), .initial = 5e-3,
   .given = offsetof(struct _p_ReducedRun, request.has_rtol), QUANTITY_WITHIN(0, 1), .open = PETSC_TRUE,
   .idle = ReducedIdleChosen, .in = RUN_TRANSIENT | RUN_CYCLE},
  {"-dynamics_compare", "eigenvalues of a reduced model beside those of the mesh in -modes_band", NULL, QUANTITY_BOOL,
   REDUCED_AT(request.compare), .initial = PETSC_TRUE, .idle = ReducedIdle, .in = RUN_TRANSIENT | RUN_CYCLE},
  {"-dynamics_verify",
   "after a reduced run again with half the step, and with 2.25 times the cut-off; an error where forces differ by "
   "more than 10 %",
   NULL, QUANTITY_BOOL, REDUCED_AT(request.verify), .idle = ReducedIdle, .in = RUN_HISTORY},
};

const QuantityTable reduced_quantities = {"Reduced model", "reduced.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows,
                                          .in = RUN_IN_TIME};
