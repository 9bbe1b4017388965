/* Options of modes */
#include "modesimpl.h"

#define MODES_LARGEST       1e30 /* Hz, 1/s: squares stay finite */
#define MODES_AT(member)    QUANTITY_AT(struct _p_Modes, member)
#define MODES_GIVEN(member) .given = offsetof(struct _p_Modes, member)

static const char *const contacts[] = {[ABOUT_AUTO] = "auto", [ABOUT_ALL] = "all", [ABOUT_STATIC] = "static", NULL};
static const char *const routes[]   = {
    [DAMPING_AUTO] = "auto", [DAMPING_PROJECT] = "project", [DAMPING_PEP] = "pep", NULL};

static const char *ModesIdleBand(const void *modes, const QuantityRun *run)
{
  (void)run;
  return ((const struct _p_Modes *)modes)->has_both ? "not used beside -modes_target or -modes_count; give one" : NULL;
}

static const char *ModesIdleContact(const void *modes, const QuantityRun *run)
{
  (void)modes;
  return run->does & RUN_CONTACTS ? NULL : "not used without -contacts";
}

static const char *ModesIdleDisc(const void *modes, const QuantityRun *run)
{
  (void)modes;
  return run->does & RUN_NAMED ? NULL : "not used by matrices without a mesh or -operators_nodes, which have no parts";
}

static const Quantity rows[] = {
  {"-modes_band", "all modes with frequency in f1,f2", "Hz", QUANTITY_REALS, MODES_AT(band), MODES_GIVEN(has_band),
   QUANTITY_WITHIN(0, MODES_LARGEST), .restart = PETSC_TRUE, .idle = ModesIdleBand},
  {"-modes_target", "instead of a band: the modes nearest to this frequency", "Hz", QUANTITY_REAL, MODES_AT(target),
   MODES_GIVEN(has_target), QUANTITY_WITHIN(0, MODES_LARGEST), .in = RUN_LINEAR},
  {"-modes_count", "how many of them", NULL, QUANTITY_INT, MODES_AT(count), .initial = 20, MODES_GIVEN(has_count),
   QUANTITY_POSITIVE, .in = RUN_LINEAR},
  {"-modes_growth",
   "modes of a band with growth and decay up to this must be found (0: a tenth of the angular frequency f2)", "1/s",
   QUANTITY_REAL, MODES_AT(growth), QUANTITY_WITHIN(0, MODES_LARGEST), .restart = PETSC_TRUE,
   .in = RUN_MODES | RUN_SWEEP | RUN_REDUCED},
  {"-modes_unstable_damping", "growth within this damping ratio is no instability", "%", QUANTITY_REAL,
   MODES_AT(unstable[0]), QUANTITY_WITHIN(0, 100)},
  {"-modes_unstable_growth", "growth up to this is no instability", "1/s", QUANTITY_REAL, MODES_AT(unstable[1]),
   QUANTITY_WITHIN(0, MODES_LARGEST)},
  {"-modes_shifts", "shifts that share a band without damping (0: by the count of modes)", NULL, QUANTITY_INT,
   MODES_AT(n_shifts), QUANTITY_NOT_NEGATIVE},
  {"-modes_most", "modes that a band may hold, counted before they are computed; more are an error (0: any number)",
   NULL, QUANTITY_INT, MODES_AT(most), .initial = 3000, MODES_GIVEN(has_most), QUANTITY_NOT_NEGATIVE},
  {"-modes_max_time", "time that a solution may take (0: any); asked after every solve", "s", QUANTITY_REAL,
   MODES_AT(max_time), .initial = 3600, QUANTITY_NOT_NEGATIVE},
  {"-modes_left", "left vectors: condition and error of each eigenvalue", NULL, QUANTITY_BOOL, MODES_AT(left),
   .initial = PETSC_TRUE, .restart = PETSC_TRUE},
  {"-modes_filters", "write modal filters, which find the modes' amplitudes in a transient", NULL, QUANTITY_BOOL,
   MODES_AT(filters), .in = RUN_MODES | RUN_FRF},
  {"-modes_sensitivities", "derivatives of each eigenvalue by each parameter of the scene", NULL, QUANTITY_BOOL,
   MODES_AT(sensitivities), .in = RUN_MODES},
  {"-modes_couplings", "write how each of -modes_changes couples the modes, and solve none of them", NULL,
   QUANTITY_BOOL, MODES_AT(couplings), .in = RUN_MODES},
  {"-modes_components",
   "write which free modes of the bodies make up each mode, of those up to this multiple of the band's highest "
   "frequency (0: none; 1.5 is enough for most)",
   NULL, QUANTITY_REAL, MODES_AT(free_to), QUANTITY_WITHIN(0, 100), .in = RUN_MODES},
  {"-modes_components_found",
   "the same of unstable modes, and names by free modes, without a solution: estimates from the modes found", NULL,
   QUANTITY_BOOL, MODES_AT(free_found), .initial = PETSC_TRUE,
   .in = RUN_MODES | RUN_SWEEP | RUN_FRF | RUN_SAMPLE | RUN_QUIET, .restart = PETSC_TRUE},
  {"-modes_disc", "part whose shapes are named by nodal circles and diameters", NULL, QUANTITY_TEXT, MODES_AT(disc),
   .text = "disc", MODES_GIVEN(has_disc), .restart = PETSC_TRUE, .idle = ModesIdleDisc},
  {"-modes_contact",
   "closed pairs: all, those of the sliding state (static), or as static where there are loads and no "
   "-..._force, else as all (auto)",
   NULL, QUANTITY_WORD, MODES_AT(about), .words = contacts, .restart = PETSC_TRUE, .idle = ModesIdleContact},
  {MODES_DAMPING,
   "route of a damped solution: projection on undamped modes (project), PEP (pep), or PEP only where a projection is "
   "too large (auto)",
   NULL, QUANTITY_WORD, MODES_AT(damping), .initial = DAMPING_AUTO, .words = routes, MODES_GIVEN(has_route),
   .restart = PETSC_TRUE},
};

const QuantityTable modes_quantities = {"Modes", "modes.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows,
                                        .in = RUN_LINEAR | RUN_REDUCED};
