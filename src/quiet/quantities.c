/* Options of quiet boxes */
#include "quietimpl.h"

#define QUIET_AT(member) QUANTITY_AT(struct _p_Quiet, member)

static const char *const goals[] = {[QUIET_BOX] = "box", [QUIET_PARTS] = "parts", NULL};

static const Quantity rows[] = {
  {"-quiet_parameters", "options of the scene that vary; '+' joins those that move in step, e.g. a_young,b_mu+c_mu",
   NULL, QUANTITY_TEXT, QUIET_AT(options.names)},
  {"-quiet_percent", "half widths of the box, percent of the scene's own values; one value or one for each", "%",
   QUANTITY_LIST, QUIET_AT(options.percent), .count = offsetof(struct _p_Quiet, options.n_percent),
   QUANTITY_WITHIN(0, 100), .open = PETSC_TRUE},
  {"-quiet_lower", "or its lower ends, in the unit of each", NULL, QUANTITY_LIST, QUIET_AT(options.lower),
   .count = offsetof(struct _p_Quiet, options.n_lower)},
  {"-quiet_upper", "its upper ends", NULL, QUANTITY_LIST, QUIET_AT(options.upper),
   .count = offsetof(struct _p_Quiet, options.n_upper)},
  {"-quiet_goal", "the largest quiet box around the scene's own values, up to the one given, or all quiet parts of it",
   NULL, QUANTITY_WORD, QUIET_AT(goal), .initial = QUIET_BOX, .words = goals},
  {"-quiet_tolerance", "of the size of the box, or of the volume that may be left open", NULL, QUANTITY_REAL,
   QUIET_AT(tolerance), .initial = 0.02, QUANTITY_WITHIN(0, 1), .open = PETSC_TRUE},
  {"-quiet_max_cells", "most cells that are tested", NULL, QUANTITY_INT, QUIET_AT(max_cells), .initial = 5000,
   QUANTITY_POSITIVE},
  {"-quiet_random", "random points inside at which the reduced model is looked at", NULL, QUANTITY_INT,
   QUIET_AT(n_random), .initial = 1000, QUANTITY_NOT_NEGATIVE},
  {"-quiet_verify", "of these, as many by full solutions", NULL, QUANTITY_INT, QUIET_AT(n_verify),
   QUANTITY_NOT_NEGATIVE},
  {"-quiet_seed", "another one takes other random points", NULL, QUANTITY_INT, QUIET_AT(seed), .initial = 1,
   QUANTITY_NOT_NEGATIVE},
  {"-quiet_rtol", "largest estimated relative error of an eigenvalue (an estimate, no bound)", NULL, QUANTITY_REAL,
   QUIET_AT(box.rtol), .initial = 1e-6, QUANTITY_WITHIN(0, 1), .open = PETSC_TRUE},
  {"-quiet_max_solutions", "most full solutions of the basis", NULL, QUANTITY_INT, QUIET_AT(box.max_solutions),
   .initial = 100, QUANTITY_POSITIVE},
};
const QuantityTable quiet_quantities = {"Quiet boxes", "quiet.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows,
                                        .in = RUN_QUIET};
