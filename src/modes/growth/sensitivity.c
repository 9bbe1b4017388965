/*
   What the parameters of the scene do to each mode, modes_sensitivities.csv. From Q(lambda; p) x = 0 and y' Q = 0

      d lambda / d p_j = -y' (dQ / dp_j) x / (y' Q'(lambda) x)       rad/s per unit of p_j,

   for modes about a sliding state with its pairs held as they are: what a parameter does to the pressure, or to which
   pairs touch, is not in it. A percent of p_j is 0.01 p_j. A rigid mode has no derivative, and one of a double
   eigenvalue none of its own.

   Error, an estimate of first order: both vectors are off by about d / g (causes.c), and so the products by 2 d / g of
   the largest |p_j d lambda / d p_j|.
*/
#include "modes/modesimpl.h"
#include <complex.h>

#define SENSITIVITIES_SHOWN 3 /* of a mode */

/* Of one mode */
typedef struct {
  PetscInt      n;     /* parameters */
  PetscComplex *by;    /* [n] rad/s per unit */
  PetscReal     error; /* of p_j d lambda / d p_j, rad/s */
} ModeSensitivity;

PetscErrorCode ModesWantTerms(Modes modes, PetscBool *wanted)
{
  PetscFunctionBeginUser;
  *wanted = modes->sensitivities || modes->may_move ? PETSC_TRUE : PETSC_FALSE; /* which another reference needs */
  for (PetscInt i = 0; i < modes->n_changes; i++)
    if (ChangeHasParameter(modes, i)) *wanted = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscBool ModesParameterIsListed(const OperatorsParameter *q)
{
  return q->state || q->internal || q->stressing ? PETSC_FALSE : PETSC_TRUE;
}

static PetscErrorCode SensitivityMeasure(Modes modes, PetscInt i, const PetscReal p[], ModeSensitivity *s)
{
  const Mode        *m       = &modes->mode[i];
  const PetscReal    gap     = ModeGap(modes, i);
  const PetscComplex slope   = 2 * CMPLX(m->sigma, m->omega) * CMPLX(m->product[0], m->product[1]); /* y' Q' x */
  PetscReal          largest = 0;
  PencilVectors      v       = {.n = 1};

  PetscFunctionBeginUser;
  PetscCall(ModesGetVectors(modes, i, &v.xr[0], &v.xi[0], &v.yr[0], &v.yi[0]));
  PetscCall(PencilMeasureDerivatives(modes->pencil, m->sigma, m->omega, &v, s->by));
  for (PetscInt j = 0; j < s->n; j++) {
    s->by[j] = -s->by[j] / slope;
    largest  = PetscMax(largest, PetscAbsReal(p[j]) * cabs(s->by[j]));
  }
  s->error = 2 * largest * (m->error < gap ? m->error / gap : 1);
  PetscFunctionReturn(0);
}

/* The rows of a mode */
static PetscErrorCode SensitivityWrite(PetscInt i, const OperatorsParameter q[], const PetscReal p[],
                                       const ModeSensitivity *s, ResultsTable table)
{
  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < s->n; j++) {
    const PetscReal hz = cimag(s->by[j]) / (2 * PETSC_PI), growth = creal(s->by[j]), percent = p[j] / 100;

    if (!ModesParameterIsListed(&q[j])) continue;
    PetscCall(ResultsTableRow(table, "%d,%s,%.15g,%s,%.15g,%.15g,%.15g,%.15g,%.3g", (int)i + 1, q[j].name, (double)p[j],
                              q[j].unit, (double)(hz + 0), (double)(growth + 0), (double)(hz * percent + 0),
                              (double)(growth * percent + 0), (double)(s->error / 100)));
  }
  PetscFunctionReturn(0);
}

/* The largest effect of a percent on the growth that is not shown, above its error, or -1 */
static PetscInt SensitivityNext(const OperatorsParameter q[], const PetscReal p[], const ModeSensitivity *s,
                                const PetscBool shown[])
{
  PetscReal most = s->error;
  PetscInt  next = -1;

  for (PetscInt j = 0; j < s->n; j++) {
    const PetscReal size = PetscAbsReal(p[j] * creal(s->by[j]));

    if (shown[j] || !ModesParameterIsListed(&q[j]) || !(size > most)) continue;
    most = size;
    next = j;
  }
  return next;
}

static PetscErrorCode SensitivityView(PetscInt i, const OperatorsParameter q[], const PetscReal p[],
                                      const ModeSensitivity *s, PetscBool shown[], PetscViewer viewer)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(shown, s->n));
  for (int k = 0; k < SENSITIVITIES_SHOWN; k++) {
    const PetscInt j = SensitivityNext(q, p, s, shown);

    if (j < 0 && !k) PetscFunctionReturn(0);
    if (j < 0) break;
    if (!k)
      PetscCall(PetscViewerASCIIPrintf(viewer, "growth of mode %" PetscInt_FMT " with one percent more of", i + 1));
    PetscCall(
      PetscViewerASCIIPrintf(viewer, "%s %s %+.4g", k ? "," : "", q[j].name, (double)(creal(s->by[j]) * p[j] / 100)));
    shown[j] = PETSC_TRUE;
  }
  PetscCall(PetscViewerASCIIPrintf(viewer, " 1/s\n"));
  PetscFunctionReturn(0);
}

/* To the table where there is one, else to the viewer, which has modes that grow alone */
static PetscErrorCode SensitivitiesShow(Modes modes, ResultsTable table, PetscViewer viewer)
{
  const OperatorsParameter *q;
  const PetscReal          *p;
  ModeSensitivity           s;
  PetscBool                *shown;

  PetscFunctionBeginUser;
  PetscCall(PencilGetParameters(modes->pencil, &s.n, &q, &p));
  PetscCall(PetscMalloc2(s.n, &s.by, s.n, &shown));
  for (PetscInt i = 0; i < modes->n; i++) {
    const Mode *m = &modes->mode[i];

    if (m->rigid || (!table && !m->unstable)) continue;
    PetscCall(SensitivityMeasure(modes, i, p, &s));
    if (table)
      PetscCall(SensitivityWrite(i, q, p, &s, table));
    else
      PetscCall(SensitivityView(i, q, p, &s, shown, viewer));
  }
  PetscCall(PetscFree2(s.by, shown));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesWriteSensitivities(Modes modes, Results results)
{
  ResultsTable table;

  PetscFunctionBeginUser;
  if (!modes->sensitivities || !modes->left_spectrum.n) PetscFunctionReturn(0);
  PetscCall(ResultsTableOpen(results, "modes_sensitivities",
                             "mode,parameter,value,unit,freq_hz_per_unit,growth_rad_s_per_unit,freq_hz_per_percent,"
                             "growth_rad_s_per_percent,error_rad_s_per_percent",
                             &table));
  PetscCall(SensitivitiesShow(modes, table, NULL));
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesViewSensitivities(Modes modes, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  if (modes->sensitivities && modes->left_spectrum.n) PetscCall(SensitivitiesShow(modes, NULL, viewer));
  PetscFunctionReturn(0);
}
