/* Options of the statics. Rows that modes read about a sliding state alone change no equilibrium */
#include "staticsimpl.h"

#define STATICS_AT(member) QUANTITY_AT(struct _p_Statics, member)

static const Quantity rows[] = {
  {"-static_max_it", "most iterations of the active set at one load", NULL, QUANTITY_INT, STATICS_AT(max_it),
   .initial = 50, QUANTITY_LEAST(1)},
  {"-static_load_steps", "equal steps of the loads (matter for sticking pairs)", NULL, QUANTITY_INT,
   STATICS_AT(load_steps), .initial = 1, QUANTITY_LEAST(1), .restart = PETSC_TRUE, .in = RUN_HOLDS},
  {"-static_dense", "most rows of the contact problem for a dense one, beyond: GMRES", NULL, QUANTITY_INT,
   STATICS_AT(dense), .initial = 2000, QUANTITY_WITHIN(0, STATICS_MOST_DENSE),
   .why = "more rows do not fit a dense matrix", .restart = PETSC_TRUE},
  {"-static_rows", "for modes: rows of pairs closed at the edge of the contact (> 0), or opened there (< 0)", NULL,
   QUANTITY_INT, STATICS_AT(rows_more), .restart = PETSC_TRUE, .in = RUN_SLIDING},
  {"-static_geometric", "for modes: geometric stiffness of the preload", NULL, QUANTITY_BOOL, STATICS_AT(geometric),
   .restart = PETSC_TRUE, .in = RUN_SLIDING},
  {"-static_follower", "for modes: contact forces turn with the master surface", NULL, QUANTITY_BOOL,
   STATICS_AT(follower), .restart = PETSC_TRUE, .in = RUN_SLIDING},
  {"-static_identify_steps", "steps of the force ramp of -contact_kn identify", NULL, QUANTITY_INT,
   STATICS_AT(identify_steps), .initial = 10, QUANTITY_LEAST(2), .restart = PETSC_TRUE, .in = RUN_IDENTIFY},
  {"-static_view_kkt", "print the residuals of the contact laws", NULL, QUANTITY_BOOL, STATICS_AT(view_kkt),
   .in = RUN_STATIC},
};

const QuantityTable statics_quantities = {"Statics", "statics.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows,
                                          .in = RUN_EQUILIBRIUM};
