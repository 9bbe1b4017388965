/*
   Contributions of component modes as a table, modes_components.csv, and in words for unstable modes.
*/
#include "components.h"

#define COMPONENT_LEAST  1e-3 /* of share and energy: below both a free mode is one of the others of its body */
#define COMPONENT_SHOWN  0.05 /* of the share: what the view names */
#define COMPONENTS_SHOWN 5

/* Share, energy and error of mode i in a level of body b, or in the whole body */
typedef struct {
  PetscReal share, energy, error;
} Contribution;

/* Twice the largest share of a mode, by which a relative error of its shape changes shares */
static PetscReal ErrorScale(const ModesComponents c, PetscInt i)
{
  const PetscInt n       = (c->n_levels + 1) * c->bodies.n;
  PetscReal      largest = 0;

  for (PetscInt k = 0; k < n; k++) largest = PetscMax(largest, PetscAbsReal(c->share[i * n + k]));
  return 2 * largest;
}

static Contribution ContributionGet(const ModesComponents c, PetscInt i, PetscInt level, PetscInt b, PetscReal scale)
{
  const PetscInt at    = (i * (c->n_levels + 1) + level) * c->bodies.n + b;
  PetscReal      mixed = c->mixed[i];

  if (level < c->n_levels) mixed += c->level[level].mixed;
  return (Contribution){c->share[at], c->energy[at], scale * mixed};
}

/* What is left of a body: of its free modes that have no row, and of what these modes cannot form */
static void ContributionTake(Contribution *from, const Contribution *what)
{
  from->share -= what->share;
  from->energy -= what->energy;
}

/* Rows of body b in mode i: its free modes that take part, the others together, and the rest */
static PetscErrorCode BodyWrite(const Modes modes, PetscInt i, PetscInt b, ResultsTable table)
{
  const ModesComponents c      = modes->components;
  const PetscReal       scale  = ErrorScale(c, i);
  Contribution          others = {0, 0, 0}, rest = ContributionGet(c, i, c->n_levels, b, scale);
  PetscInt              n = 0;
  char                  start[1100];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(start, sizeof(start), "%" PetscInt_FMT ",%s", i + 1, c->bodies.name[b]));
  for (PetscInt l = 0; l < c->n_levels; l++) {
    const FreeMode    *is   = &c->free[l * c->bodies.n + b];
    const Contribution part = ContributionGet(c, i, l, b, scale);

    if (!is->n) continue;
    ContributionTake(&rest, &part);
    if (PetscAbsReal(part.share) < COMPONENT_LEAST && part.energy < COMPONENT_LEAST) {
      others =
        (Contribution){others.share + part.share, others.energy + part.energy, PetscMax(others.error, part.error)};
      n += is->n;
    } else
      PetscCall(ResultsTableRow(table, "%s,%d,\"%s\",%d,%.15g,%.15g,%.15g,%.3g,%.3g", start, (int)is->first + 1,
                                is->name, (int)is->n, (double)(c->level[l].omega / (2 * PETSC_PI)),
                                (double)(100 * part.share), (double)(100 * part.energy), (double)(100 * part.error),
                                (double)(c->level[l].error / (2 * PETSC_PI))));
  }
  PetscCall(ResultsTableRow(table, "%s,,others,%d,,%.15g,%.15g,%.3g,", start, (int)n, (double)(100 * others.share),
                            (double)(100 * others.energy), (double)(100 * others.error)));
  PetscCall(ResultsTableRow(table, "%s,,rest,,,%.15g,%.15g,%.3g,", start, (double)(100 * rest.share),
                            (double)(100 * rest.energy), (double)(100 * rest.error)));
  PetscFunctionReturn(0);
}

PetscErrorCode ComponentsWrite(Modes modes, Results results)
{
  PetscInt     n_rows = 0;
  ResultsTable table;

  PetscFunctionBeginUser;
  if (!modes->components) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < modes->n; i++) n_rows += !modes->components->found || modes->mode[i].unstable;
  if (!n_rows) PetscFunctionReturn(0);
  PetscCall(ResultsTableOpen(results, "modes_components",
                             "mode,body,component,name,modes,freq_hz,share_percent,energy_percent,error_percent,"
                             "freq_error_hz",
                             &table));
  for (PetscInt i = 0; i < modes->n; i++)
    for (PetscInt b = 0; b < modes->components->bodies.n && (!modes->components->found || modes->mode[i].unstable); b++)
      PetscCall(BodyWrite(modes, i, b, table));
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

/* The largest share of mode i that is not shown, as level * bodies + body, or -1 */
static PetscInt ComponentNext(const ModesComponents c, PetscInt i, PetscReal scale, const PetscBool shown[])
{
  const PetscInt n       = c->bodies.n;
  PetscInt       largest = -1;
  PetscReal      most    = COMPONENT_SHOWN;

  for (PetscInt k = 0; k < c->n_levels * n; k++) {
    const Contribution part = ContributionGet(c, i, k / n, k % n, scale);

    if (shown[k] || !(PetscAbsReal(part.share) > most) || PetscAbsReal(part.share) <= part.error) continue;
    largest = k;
    most    = (1 + LABEL_TIE) * PetscAbsReal(part.share);
  }
  return largest;
}

PetscErrorCode ComponentsView(Modes modes, PetscViewer viewer)
{
  const ModesComponents c = modes->components;
  PetscBool            *shown, large = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (!c) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(c->n_levels * c->bodies.n, &shown));
  for (PetscInt i = 0; i < modes->n; i++) {
    const PetscReal scale = ErrorScale(c, i);
    PetscReal       left = 1, most = 0;

    if (!modes->mode[i].unstable) continue;
    PetscCall(PetscArrayzero(shown, c->n_levels * c->bodies.n));
    PetscCall(PetscViewerASCIIPrintf(viewer, "mode %" PetscInt_FMT " is made of", i + 1));
    for (int k = 0; k < COMPONENTS_SHOWN; k++) {
      const PetscInt at = ComponentNext(c, i, scale, shown), b = at % c->bodies.n;
      Contribution   part;

      if (at < 0) break;
      shown[at] = PETSC_TRUE;
      part      = ContributionGet(c, i, at / c->bodies.n, b, scale);
      left -= part.share;
      most = PetscMax(most, PetscAbsReal(part.share));
      PetscCall(PetscViewerASCIIPrintf(viewer, " %.3g %% %s %s,", (double)(100 * part.share), c->bodies.name[b],
                                       c->free[at].name));
    }
    PetscCall(PetscViewerASCIIPrintf(viewer, " %.3g %% others", (double)(100 * left)));
    PetscCall(ModeViewTwin(modes, i, viewer));
    PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
    if (most > 1) large = PETSC_TRUE;
  }
  if (large)
    PetscCall(PetscViewerASCIIPrintf(
      viewer,
      "shares above 100 %%: next to a lock-in left and right vector hardly overlap, y'M x = 0 at it, and shares "
      "of both signs sum to 100 %%; energy_percent of modes_components.csv has none\n"));
  PetscCall(PetscFree(shown));
  PetscFunctionReturn(0);
}
