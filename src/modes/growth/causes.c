/*
   Why modes grow or decay: modes_causes.csv, and mechanism and largest shares of unstable ones in the view.

   The shares of a right vector u add up to Re lambda of the root of u^H Q(lambda) u = 0. The growth of the eigensolver
   differs from it by what rounding of K does to an eigenvalue, at most about

      eps sum_ij |y_i K_ij x_j| / |y' Q' x|,

   on massi2005 5e-9 of the friction's share. The two differ by 3e-11 of it there, and both by 9e-10 from the eigenvalue
   of the saved matrices in extended precision: neither is the better number. Therefore the growth of a mode is defined
   as the sum of its shares where the two agree within the error of the eigenvalue. Where they do not, or its error is
   not known, it stays that of the eigensolver, and the rest is what the vector leaves.

   Error of a share, an estimate of first order: the vector is off by about d / g, d the error of the eigenvalue and g
   the distance of the next one, so that the share is off by d + 2 s d / g, s the largest share of the mode, and by what
   the balance leaves. Modes of one eigenvalue have no shares of their own, and errors as large as these.
*/
#include "modes/modesimpl.h"
#include "base/events.h"

#define CAUSES_SHOWN 3 /* of a mode */

PetscReal ModeGap(const Modes modes, PetscInt i)
{
  const Mode *a   = &modes->mode[i];
  PetscReal   gap = 2 * a->omega;

  for (int k = 0; k < 2 && modes->has_band; k++)
    gap = PetscMin(gap, PetscAbsReal(a->omega - 2 * PETSC_PI * modes->band[k]));
  for (PetscInt k = 0; k < modes->n; k++) {
    const Mode *b = &modes->mode[k];

    if (k != i) gap = PetscMin(gap, PetscSqrtReal(PetscSqr(a->sigma - b->sigma) + PetscSqr(a->omega - b->omega)));
  }
  return gap;
}

PetscErrorCode ModeViewTwin(const Modes modes, PetscInt i, PetscViewer viewer)
{
  const Mode *a = &modes->mode[i];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < modes->n; k++) {
    const Mode     *b       = &modes->mode[k];
    const PetscReal rounded = a->error + b->error + MODES_TINY * hypot(a->sigma, a->omega);

    if (k == i || !(hypot(a->sigma - b->sigma, a->omega - b->omega) <= rounded)) continue;
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "; mode %" PetscInt_FMT
                                     " has the same eigenvalue: any shape of their plane is a mode, and shares are "
                                     "those of any one",
                                     k + 1));
    break;
  }
  PetscFunctionReturn(0);
}

PetscReal ModeVectorError(const Modes modes, PetscInt i)
{
  const PetscReal gap = ModeGap(modes, i), error = modes->mode[i].error;

  return error >= gap ? 1 : error / gap;
}

/* What the shares leave of the growth, and the largest of them */
static PetscReal SharesRest(PetscReal sigma, PetscInt n, const PetscReal growth[], PetscReal *largest)
{
  PetscReal rest = sigma;

  *largest = 0;
  for (PetscInt k = 0; k < n; k++) {
    rest -= growth[k];
    *largest = PetscMax(*largest, PetscAbsReal(growth[k]));
  }
  return rest;
}

/* Rest and error of the shares of mode i, whose growth becomes their sum */
static PetscErrorCode ModeJudgeShares(Modes modes, PetscInt i, PetscInt n, ModeShares *s)
{
  Mode     *m = &modes->mode[i];
  PetscReal largest;

  PetscFunctionBeginUser;
  s->rest = SharesRest(m->sigma, n, s->growth, &largest);
  if (PetscAbsReal(s->rest) <= m->error) {
    m->sigma -= s->rest;
    s->rest = SharesRest(m->sigma, n, s->growth, &largest);
  }
  s->error = m->error + 2 * largest * ModeVectorError(modes, i) + PetscAbsReal(s->rest);
  PetscFunctionReturn(0);
}

/* Shares of all modes with a frequency, n causes */
static PetscErrorCode ModesMeasureShares(Modes modes, PetscInt n)
{
  PencilMode *some;
  PetscReal  *energy;
  PetscInt    n_some = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(modes->n, &some, modes->n, &energy));
  for (PetscInt i = 0; i < modes->n; i++) {
    const Mode *m = &modes->mode[i];

    modes->shares[i].known = m->omega > 0 && !m->rigid ? PETSC_TRUE : PETSC_FALSE;
    if (!modes->shares[i].known) continue;
    modes->shares[i].growth = &modes->shares[0].growth[n_some * n];
    some[n_some++]          = (PencilMode){m->sigma, m->omega, modes->right.xr[i], modes->right.xi[i]};
  }
  PetscCall(PencilMeasureCauses(modes->pencil, n_some, some, modes->shares[0].growth, energy));
  for (PetscInt i = 0, k = 0; i < modes->n; i++) {
    if (!modes->shares[i].known) continue;
    modes->shares[i].energy = energy[k++];
    PetscCall(ModeJudgeShares(modes, i, n, &modes->shares[i]));
  }
  PetscCall(PetscFree2(some, energy));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesBalance(Modes modes)
{
  const PencilCause *cause;
  PetscInt           n;

  PetscFunctionBeginUser;
  if (modes->shares) PetscFunctionReturn(0);
  PetscCall(PencilGetCauses(modes->pencil, &n, &cause));
  if (!n) PetscFunctionReturn(0);
  PetscCall(EventBegin(EVENT_CAUSES));
  PetscCall(PetscCalloc1(modes->n, &modes->shares));
  PetscCall(PetscMalloc1(modes->n * n, &modes->shares[0].growth));
  PetscCall(ModesMeasureShares(modes, n));
  PetscCall(EventEnd(EVENT_CAUSES));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesForgetShares(Modes modes)
{
  PetscFunctionBeginUser;
  if (modes->shares) PetscCall(PetscFree(modes->shares[0].growth));
  PetscCall(PetscFree(modes->shares));
  PetscFunctionReturn(0);
}

/* A row of mode i: a share of its growth, and the mean power that it feeds the vibration with at the amplitude of
   modes.h5, P = 2 E s */
static PetscErrorCode ShareWrite(PetscInt i, const PencilCause *cause, PetscReal growth, const ModeShares *s,
                                 ResultsTable table)
{
  PetscFunctionBeginUser;
  PetscCall(ResultsTableRow(table, "%d,%s,%s,%.15g,%.3g,%.15g,%.3g", (int)i + 1, cause->name, cause->kind,
                            (double)growth, (double)s->error, (double)(2 * s->energy * growth),
                            (double)(2 * s->energy * s->error)));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesWriteCauses(Modes modes, Results results)
{
  const PencilCause *cause, rest = {.kind = "rest"};
  PetscInt           n;
  ResultsTable       table;

  PetscFunctionBeginUser;
  PetscCall(ModesBalance(modes));
  if (!modes->shares) PetscFunctionReturn(0);
  PetscCall(PencilGetCauses(modes->pencil, &n, &cause));
  PetscCall(ResultsTableOpen(results, "modes_causes", "mode,cause,kind,growth_rad_s,error_rad_s,power_w,power_error_w",
                             &table));
  for (PetscInt i = 0; i < modes->n; i++) {
    const ModeShares *s = &modes->shares[i];

    for (PetscInt k = 0; k < n && s->known; k++) PetscCall(ShareWrite(i, &cause[k], s->growth[k] + 0, s, table));
    if (s->known) PetscCall(ShareWrite(i, &rest, s->rest, s, table));
  }
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

/* The largest share above its error that is not shown, or -1 */
static PetscInt CauseNext(PetscInt n, const ModeShares *s, const PetscBool shown[])
{
  PetscInt largest = -1;

  for (PetscInt k = 0; k < n; k++)
    if (!shown[k] && !(PetscAbsReal(s->growth[k]) <= s->error) &&
        (largest < 0 || PetscAbsReal(s->growth[k]) > PetscAbsReal(s->growth[largest])))
      largest = k;
  return largest;
}

/* The largest shares, none for a mode without a frequency; shown has room for all causes */
static PetscErrorCode SharesView(const PencilCause cause[], PetscInt n, const ModeShares *s, PetscBool shown[],
                                 PetscViewer viewer)
{
  PetscFunctionBeginUser;
  if (!s->known) PetscFunctionReturn(0);
  PetscCall(PetscArrayzero(shown, n));
  for (PetscInt k = 0; k < CAUSES_SHOWN; k++) {
    const PetscInt at = CauseNext(n, s, shown);

    if (at < 0) break;
    shown[at] = PETSC_TRUE;
    PetscCall(PetscViewerASCIIPrintf(viewer, "%s %s %s %+.5g", k ? "," : ":", cause[at].kind, cause[at].name,
                                     (double)s->growth[at]));
  }
  if (CauseNext(n, s, shown) >= 0) PetscCall(PetscViewerASCIIPrintf(viewer, ", others in modes_causes.csv"));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesViewCauses(Modes modes, PetscViewer viewer)
{
  const ModeMechanism *mechanism;
  const PencilCause   *cause;
  PetscInt             n;
  PetscBool           *shown;

  PetscFunctionBeginUser;
  PetscCall(ModesBalance(modes));
  PetscCall(ModesGetMechanisms(modes, &mechanism)); /* which forms the causes anew */
  PetscCall(PencilGetCauses(modes->pencil, &n, &cause));
  PetscCall(PetscMalloc1(n, &shown));
  for (PetscInt i = 0; i < modes->n; i++) {
    if (!modes->mode[i].unstable) continue;
    PetscCall(ModesViewMechanism(modes, i, &mechanism[i], viewer));
    if (modes->shares) PetscCall(SharesView(cause, n, &modes->shares[i], shown, viewer));
    PetscCall(ModeViewTwin(modes, i, viewer));
    PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
  }
  PetscCall(PetscFree(shown));
  PetscFunctionReturn(0);
}
