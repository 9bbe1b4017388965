/* What a run says of the cycles that it found */
#include "cycleimpl.h"

/* What the cut-off makes of a cycle */
static PetscErrorCode CycleViewHigher(LimitCycle c, const CyclePoint *p, PetscViewer viewer)
{
  const CycleMeasure *a = &p->found, *b = &p->higher;

  PetscFunctionBeginUser;
  if (p->has_higher)
    PetscCall(
      PetscViewerASCIIPrintf(viewer,
                             "  with 2.25 times the cut-off: frequency off by %+.1e Hz, rms by %+.1e N, largest "
                             "force by %+.1e N, multiplier by %+.1e\n",
                             (double)(b->freq - a->freq), (double)(b->rms - a->rms), (double)(b->peak - a->peak),
                             CycleMultiplier(&p->higher_stability) - CycleMultiplier(&p->stability)));
  else if (c->verify_cutoff)
    PetscCall(PetscViewerASCIIPrintf(viewer, "  none is found with 2.25 times the cut-off: that error is unknown\n"));
  PetscFunctionReturn(0);
}

/* Class and multipliers */
static PetscErrorCode CycleViewStability(LimitCycle c, const CyclePoint *p, PetscViewer viewer)
{
  const ShootingStability *s = &p->stability;
  const char              *why, *class = CycleClass(p, c->rtol, &why);

  PetscFunctionBeginUser;
  if (why && !c->verify) why = "-cycle_verify false leaves its error unknown";
  PetscCall(PetscViewerASCIIPrintf(viewer, "  %s%s%s%s: largest multiplier %.6g%+.6gi (%.6g), that of the phase ",
                                   class, why ? " (" : "", why ? why : "", why ? ")" : "", (double)s->largest[0],
                                   (double)s->largest[1], (double)CycleMultiplier(s)));
  if (PetscIsNanReal(s->phase[0]))
    PetscCall(PetscViewerASCIIPrintf(viewer, "unknown"));
  else
    PetscCall(PetscViewerASCIIPrintf(viewer, "1%+.1e%+.1ei", (double)(s->phase[0] - 1), (double)s->phase[1]));
  PetscCall(PetscViewerASCIIPrintf(viewer, "; residual %.1e after %" PetscInt_FMT " steps of Newton's method\n",
                                   (double)p->residual, p->its));
  if (!PetscIsNanReal(s->check))
    PetscCall(PetscViewerASCIIPrintf(
      viewer,
      "  dT/dtheta %+.1e, by about which these steps put the multiplier of the phase off where no "
      "other is near 1, as one is at a fold; check of their derivative 1%+.1e\n",
      (double)s->slope, (double)(s->check - 1)));
  PetscFunctionReturn(0);
}

/* One cycle in words */
static PetscErrorCode CycleViewPoint(LimitCycle c, const CyclePoint *p, PetscViewer viewer)
{
  const CycleMeasure *a = &p->found, *b = &p->finer;
  const double        size = CycleMultiplier(&p->stability);

  PetscFunctionBeginUser;
  if (c->parameter[0])
    PetscCall(PetscViewerASCIIPrintf(viewer, "%s%s %.6g", p->fold ? "fold at " : "", c->parameter, (double)p->value));
  if (p->value_error >= 0) PetscCall(PetscViewerASCIIPrintf(viewer, " +- %.1e", (double)p->value_error));
  if (c->parameter[0]) PetscCall(PetscViewerASCIIPrintf(viewer, ": "));
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "cycle of %.9g Hz in %" PetscInt_FMT
                                   " steps: normal force %.6g N, rms %.6g N, %.6g to %.6g N, open %.4g of the time\n",
                                   (double)a->freq, p->n_steps, (double)a->mean, (double)a->rms, (double)a->least,
                                   (double)a->peak, (double)a->open));
  if (p->has_finer)
    PetscCall(PetscViewerASCIIPrintf(
      viewer,
      "  with twice the steps: frequency off by %+.1e Hz, rms by %+.1e N, largest force by %+.1e N, multiplier by "
      "%+.1e\n",
      (double)(b->freq - a->freq), (double)(b->rms - a->rms), (double)(b->peak - a->peak),
      CycleMultiplier(&p->finer_stability) - size));
  if (p->has_finer)
    PetscCall(PetscViewerASCIIPrintf(
      viewer,
      "  with steps that begin elsewhere: frequency off by up to %.1e Hz, rms by %.1e N, "
      "largest force by %.1e N, multiplier by %.1e\n",
      (double)p->spread.freq, (double)p->spread.rms, (double)p->spread.peak, (double)p->multiplier_spread));
  else if (c->verify)
    PetscCall(PetscViewerASCIIPrintf(
      viewer, "  none is found with twice the steps, or with steps that begin elsewhere: its error is unknown\n"));
  PetscCall(CycleViewHigher(c, p, viewer));
  PetscCall(CycleViewStability(c, p, viewer));
  PetscFunctionReturn(0);
}

/* Models over the parameter, and where the branch begins */
static PetscErrorCode CycleViewStart(LimitCycle c, PetscViewer viewer)
{
  const CycleFamily *f = c->family;

  PetscFunctionBeginUser;
  if (f)
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "bodies reduced at %" PetscInt_FMT " values of %s in %.4g s, interpolated between "
                                     "them: to %.1e by the last coefficients\n",
                                     f->n, c->parameter, (double)f->seconds, (double)f->error));
  if (c->from_mode)
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "a mode of %.9g Hz of the sliding state becomes unstable at %s %.9g (growth %.1e "
                                     "1/s there): the branch begins with pairs' forces changed by %.3g of themselves\n",
                                     (double)c->onset[2], c->parameter, (double)c->onset[0], (double)c->onset[1],
                                     (double)c->amplitude));
  PetscFunctionReturn(0);
}

PetscErrorCode CycleView(LimitCycle c, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  PetscCall(ReducedView(c->reduced, viewer));
  if (c->parameter[0])
    PetscCall(PetscViewerASCIIPrintf(viewer, "%" PetscInt_FMT " cycles over %s; the first: %s; the last: %s\n",
                                     c->n_points, c->parameter, c->end[0], c->end[1]));
  PetscCall(CycleViewStart(c, viewer));
  for (PetscInt i = 0; i < c->n_points; i++) PetscCall(CycleViewPoint(c, &c->point[i], viewer));
  PetscFunctionReturn(0);
}
