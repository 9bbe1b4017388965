/* Options of changes */
#include "changes.h"

#define CHANGE(member)  QUANTITY_AT(struct _p_ModesChange, member)
#define CHANGE_HAS(has) .given = offsetof(struct _p_ModesChange, has)

static const Quantity change[] = {
  {"-at", "place x,y,z whose nearest node is changed", "m", QUANTITY_REALS, CHANGE(at), CHANGE_HAS(has_at)},
  {"-part", "body of the node; any without it", NULL, QUANTITY_NAME, CHANGE(part)},
  {"-to", "place x,y,z whose nearest node is the other end; the ground without it", "m", QUANTITY_REALS, CHANGE(to),
   CHANGE_HAS(has_to)},
  {"-to_part", "body of the node of the other end; any without it", NULL, QUANTITY_NAME, CHANGE(to_part)},
  {"-unknown", "of matrices without a mesh, in place of -at: number of the unknown, from 1", NULL, QUANTITY_NAME,
   CHANGE(unknown)},
  {"-to_unknown", "of matrices without a mesh, in place of -to", NULL, QUANTITY_NAME, CHANGE(to_unknown)},
  {"-set", "in place of -at: the set of nodes over which -mass and its like are spread, as shares of area or length",
   NULL, QUANTITY_NAME, CHANGE(set)},
  {"-ring", "in place of -at: two radii of the disc, between whose nodes they are spread as the mass is", "m",
   QUANTITY_REALS, CHANGE(ring), CHANGE_HAS(has_ring)},
  {"-parameter", "in place of -at: the parameter of the scene that changes", NULL, QUANTITY_NAME, CHANGE(parameter)},
  {"-percent", "by which it changes, -100 to 1000", "%", QUANTITY_REAL, CHANGE(percent), CHANGE_HAS(has_percent),
   .least = -100, .most = 1000, .bounded = PETSC_TRUE},
  {"-direction", "x,y,z along which a spring or dashpot acts, of any length", "1", QUANTITY_REALS, CHANGE(direction),
   CHANGE_HAS(has_direction)},
  {"-mass", "mass, of a set or ring in all; at a node with a stiffness or viscosity it hangs on these: an absorber",
   "kg", QUANTITY_REAL, CHANGE(mass), QUANTITY_NOT_NEGATIVE},
  {"-stiffness", "of a spring to the ground, or to -to; of a set or ring in all", "N/m", QUANTITY_REAL,
   CHANGE(stiffness), QUANTITY_NOT_NEGATIVE},
  {"-viscosity", "of a dashpot, likewise", "N s/m", QUANTITY_REAL, CHANGE(viscosity), QUANTITY_NOT_NEGATIVE},
  {"-with", "a change before it in -modes_changes that is made as well", NULL, QUANTITY_NAME, CHANGE(with)},
};

static const QuantityTable changes = {"Change", "modes.h", PETSC_STATIC_ARRAY_LENGTH(change), change, .in = RUN_MODES};

const QuantityList changes_list = {"-modes_changes",
                                   "masses, springs, dashpots, layers and percents of parameters to try on the modes "
                                   "found, each the prefix of its -at and -mass",
                                   sizeof(struct _p_ModesChange),
                                   &changes,
                                   ChangeCheck,
                                   .in = RUN_MODES};
