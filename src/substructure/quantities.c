/* Options of superelements that are made */
#include "substructureimpl.h"

#define SUBSTRUCTURE_AT(member) QUANTITY_AT(struct _p_Substructure, member)

const char *const substructure_methods[] = {
  [SUBSTRUCTURE_FIXED] = "fixed", [SUBSTRUCTURE_FREE] = "free", [SUBSTRUCTURE_NONE] = "none", NULL};
const char *const substructure_formats[] = {"squeal", "market", "nastran", "abaqus", NULL};

static const char *SubstructureIdleNone(const void *s, const QuantityRun *run)
{
  (void)run;
  return ((const struct _p_Substructure *)s)->method == SUBSTRUCTURE_NONE
           ? "not used by -superelement_method none, which keeps all unknowns"
           : NULL;
}

static const char *SubstructureIdleRtol(const void *s, const QuantityRun *run)
{
  (void)run;
  return ((const struct _p_Substructure *)s)->method == SUBSTRUCTURE_FIXED
           ? NULL
           : "not used without -superelement_method fixed, whose static shapes have them";
}

static const Quantity rows[] = {
  {"-superelement_parts", "parts that become the superelement", NULL, QUANTITY_NAMES, SUBSTRUCTURE_AT(parts),
   .count = offsetof(struct _p_Substructure, n_parts)},
  {"-superelement_sets", "sets whose nodes are the interface", NULL, QUANTITY_NAMES, SUBSTRUCTURE_AT(sets),
   .count = offsetof(struct _p_Substructure, n_sets)},
  {"-superelement_method", "modes with the interface fixed, or free with residual flexibility, or none: no reduction",
   NULL, QUANTITY_WORD, SUBSTRUCTURE_AT(method), .initial = SUBSTRUCTURE_FIXED, .words = substructure_methods},
  {"-superelement_band", "frequencies in which it is to be right", "Hz", QUANTITY_REALS, SUBSTRUCTURE_AT(band),
   QUANTITY_NOT_NEGATIVE, .given = offsetof(struct _p_Substructure, has_band)},
  {"-superelement_cutoff", "modes up to it are kept; default 3 times the end of the band", "Hz", QUANTITY_REAL,
   SUBSTRUCTURE_AT(cutoff), QUANTITY_POSITIVE, .given = offsetof(struct _p_Substructure, has_cutoff),
   .idle = SubstructureIdleNone},
  {"-superelement_rtol",
   "fixed: relative error in the band, in any structure, that static answers to inertia keep; 0: none are added", NULL,
   QUANTITY_REAL, SUBSTRUCTURE_AT(rtol), .initial = 1e-4, QUANTITY_NOT_NEGATIVE, .idle = SubstructureIdleRtol},
  {"-superelement_formats", "files to write: squeal, market, nastran, abaqus; default squeal", NULL, QUANTITY_NAMES,
   SUBSTRUCTURE_AT(formats), .count = offsetof(struct _p_Substructure, n_formats)},
};

const QuantityTable substructure_quantities = {"Superelement to make", "substructure.h",
                                               PETSC_STATIC_ARRAY_LENGTH(rows), rows, .in = RUN_SUPERELEMENT};
