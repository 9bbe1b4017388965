/* Options of designs */
#include "designimpl.h"

#define DESIGN_AT(member) QUANTITY_AT(struct _p_Design, member)

static const Quantity rows[] = {
  {"-design_parameters", "options of the scene that may be changed; '+' joins those that move in step", NULL,
   QUANTITY_TEXT, DESIGN_AT(options.names)},
  {"-design_percent", "how far, percent of the scene's own values; one value or one for each", "%", QUANTITY_LIST,
   DESIGN_AT(options.percent), .count = offsetof(struct _p_Design, options.n_percent), QUANTITY_WITHIN(0, 100),
   .open = PETSC_TRUE},
  {"-design_lower", "or the least values, in the unit of each", NULL, QUANTITY_LIST, DESIGN_AT(options.lower),
   .count = offsetof(struct _p_Design, options.n_lower)},
  {"-design_upper", "and the largest", NULL, QUANTITY_LIST, DESIGN_AT(options.upper),
   .count = offsetof(struct _p_Design, options.n_upper)},
  {"-design_uncertain_parameters", "options of the scene that are not known better than to a box", NULL, QUANTITY_TEXT,
   DESIGN_AT(uncertain_options.names)},
  {"-design_uncertain_percent", "half widths of that box, percent of the scene's own values; one value or one for each",
   "%", QUANTITY_LIST, DESIGN_AT(uncertain_options.percent),
   .count = offsetof(struct _p_Design, uncertain_options.n_percent), QUANTITY_WITHIN(0, 100), .open = PETSC_TRUE},
  {"-design_uncertain_lower", "or its lower ends, in the unit of each", NULL, QUANTITY_LIST,
   DESIGN_AT(uncertain_options.lower), .count = offsetof(struct _p_Design, uncertain_options.n_lower)},
  {"-design_uncertain_upper", "its upper ends", NULL, QUANTITY_LIST, DESIGN_AT(uncertain_options.upper),
   .count = offsetof(struct _p_Design, uncertain_options.n_upper)},
  {"-design_inside", "scenarios inside that box, beside its corners", NULL, QUANTITY_INT, DESIGN_AT(n_inside),
   .initial = 20, QUANTITY_NOT_NEGATIVE},
  {"-design_probability", "share of the scenarios that may stay unstable", NULL, QUANTITY_REAL, DESIGN_AT(probability),
   QUANTITY_WITHIN(0, 0.99)},
  {"-design_mass", "weight of the relative change of mass beside half the square of the change", NULL, QUANTITY_REAL,
   DESIGN_AT(mass_weight), QUANTITY_NOT_NEGATIVE},
  {"-design_margin", "how far beyond the limit a design aims, of the half widths", NULL, QUANTITY_REAL,
   DESIGN_AT(margin), .initial = 0.02, QUANTITY_WITHIN(0, 1)},
  {"-design_max", "most designs that are looked at", NULL, QUANTITY_INT, DESIGN_AT(max_designs), .initial = 40,
   QUANTITY_POSITIVE},
  {"-design_starts",
   "where the cuts lead to no good design: designs spread over the box of the parameters, of which the least bad ones "
   "begin anew",
   NULL, QUANTITY_INT, DESIGN_AT(n_starts), .initial = 64, QUANTITY_NOT_NEGATIVE},
  {"-design_corners", "full solutions at corners of the uncertain box of a design that is found, then inside it", NULL,
   QUANTITY_INT, DESIGN_AT(n_corners), .initial = 20, QUANTITY_NOT_NEGATIVE,
   .given = offsetof(struct _p_Design, corners_given)},
  {"-design_rtol", "largest estimated relative error of an eigenvalue (an estimate, no bound)", NULL, QUANTITY_REAL,
   DESIGN_AT(box.rtol), .initial = 1e-5, QUANTITY_WITHIN(0, 1), .open = PETSC_TRUE},
  {"-design_max_solutions", "most full solutions of the basis", NULL, QUANTITY_INT, DESIGN_AT(box.max_solutions),
   .initial = 100, QUANTITY_POSITIVE},
};
const QuantityTable design_quantities = {"Design", "design.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows, .in = RUN_DESIGN};
