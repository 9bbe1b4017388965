/*
   What a person wants to know of the onsets of a sweep: where they are, and up to which value it is quiet.
*/
#include "sweep/sweepimpl.h"

static const char *const kinds[]      = {"lock-in", "lock-out", "divergence", "stable again"};
static const char *const by_damping[] = {"negative damping", "damping positive again"}; /* in place of the first two */

/* Digits of a critical value, of which those between the points of a sweep in full have few */
static int OnsetDigits(Sweep sweep)
{
  return sweep->method == SWEEP_FULL ? 6 : 10;
}

/* Whether a point has an unstable mode */
static PetscBool PointIsUnstable(const SweepPoint *point)
{
  for (PetscInt k = 0; k < point->n; k++)
    if (point->mode[k].state == MODE_UNSTABLE) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Up to which value is it quiet? first = the onset nearest to the first value, or NULL. An unstable point before any
   onset means that its onset was not located. */
static PetscErrorCode AnswerView(Sweep sweep, const OperatorsParameter *parameter, const BranchEvent *first,
                                 PetscViewer viewer)
{
  const PetscReal *value = sweep->grid.value[0];
  const char      *unit = parameter->unit, *space = unit[0] ? " " : "";
  char             error[32] = "";
  PetscInt         i         = 0;

  PetscFunctionBeginUser;
  if (sweep->method == SWEEP_FULL && first)
    PetscCall(PetscSNPrintf(error, sizeof(error), " +- %.1e", (double)first->error));
  while (i < sweep->grid.n[0] && !PointIsUnstable(&sweep->point[i])) i++;
  if (i == 0)
    PetscCall(PetscViewerASCIIPrintf(viewer, "unstable already at %s = %.6g%s%s\n", parameter->name, (double)value[0],
                                     space, unit));
  else if (first &&
           (i == sweep->grid.n[0] || PetscAbsReal(first->critical - value[0]) <= PetscAbsReal(value[i] - value[0])))
    PetscCall(PetscViewerASCIIPrintf(viewer, "quiet from %s = %.6g to %.*g%s%s%s%s\n", parameter->name,
                                     (double)value[0], OnsetDigits(sweep), (double)first->critical, space, unit, error,
                                     first->kind == EVENT_JUMP ? ", where the contact status changes" : ""));
  else if (i < sweep->grid.n[0])
    PetscCall(PetscViewerASCIIPrintf(viewer, "unstable at %s = %.6g%s%s; where it becomes so was not located\n",
                                     parameter->name, (double)value[i], space, unit));
  else
    PetscCall(PetscViewerASCIIPrintf(
      viewer, "quiet from %s = %.6g to %.6g%s%s: no onset in the band with growth below %.6g 1/s\n", parameter->name,
      (double)value[0], (double)value[i - 1], space, unit, (double)sweep->window.growth));
  PetscFunctionReturn(0);
}

/* Why it grows, where the kind does not say so */
static const char *EventWhy(const BranchEvent *event)
{
  if (event->mechanism == MECHANISM_DAMPING_INDUCED) return " (damping-induced)";
  return event->mechanism == MECHANISM_GYROSCOPIC ? " (gyroscopic)" : "";
}

static const char *EventKindText(const BranchEvent *event)
{
  const PetscBool of_two = event->kind == EVENT_LOCK_IN || event->kind == EVENT_LOCK_OUT ? PETSC_TRUE : PETSC_FALSE;

  return of_two && event->mechanism == MECHANISM_NEGATIVE_DAMPING ? by_damping[event->kind] : kinds[event->kind];
}

/* One onset */
static PetscErrorCode EventView(Sweep sweep, PetscInt e, const OperatorsParameter *parameter, PetscViewer viewer)
{
  const BranchEvent *event = &sweep->events.event[e];

  PetscFunctionBeginUser;
  if (event->kind == EVENT_JUMP)
    PetscCall(PetscViewerASCIIPrintf(
      viewer, "  jump at %s = %.6g %s +- %.1e: contact status changes, and %s at %.2f Hz is unstable %s it\n",
      parameter->name, (double)event->critical, parameter->unit, (double)event->error,
      sweep->label[event->branch[0]].text, (double)(event->omega / (2 * PETSC_PI)), event->above ? "above" : "below"));
  else
    PetscCall(PetscViewerASCIIPrintf(viewer, "  %s%s at %s = %.*g %s +- %.1e, %.2f Hz, %s%s\n", EventKindText(event),
                                     EventWhy(event), parameter->name, OnsetDigits(sweep), (double)event->critical,
                                     parameter->unit, (double)event->error, (double)(event->omega / (2 * PETSC_PI)),
                                     sweep->label[event->branch[0]].text,
                                     sweep->is_confirmed[e] ? ""
                                     : event->jumps         ? " (modes change places there: give more values between)"
                                     : sweep->method == SWEEP_FULL ? " (between two points)"
                                                                   : " (not confirmed on the full problem)"));
  PetscFunctionReturn(0);
}

PetscErrorCode SweepViewOnsets(Sweep sweep, const OperatorsParameter *parameter, PetscViewer viewer)
{
  const BranchEvent *first = NULL;

  PetscFunctionBeginUser;
  for (PetscInt e = 0; e < sweep->events.n; e++) {
    const BranchEvent *event = &sweep->events.event[e];

    if (!event->found) continue;
    PetscCall(EventView(sweep, e, parameter, viewer));
    if (SweepEventLine(sweep, e) == 0 && (!first || PetscAbsReal(event->critical - sweep->grid.value[0][0]) <
                                                      PetscAbsReal(first->critical - sweep->grid.value[0][0])))
      first = event;
  }
  if (sweep->grid.n_axes == 1) PetscCall(AnswerView(sweep, parameter, first, viewer));
  PetscFunctionReturn(0);
}

PetscErrorCode SweepViewOnsetCost(Sweep sweep, PetscViewer viewer)
{
  PetscInt n[3] = {0}, n_onsets = 0;

  PetscFunctionBeginUser;
  for (PetscInt e = 0; e < sweep->events.n; e++) {
    const BranchEvent *event = &sweep->events.event[e];

    n_onsets += event->kind != EVENT_JUMP;
    n[0] += event->n_solved;
    n[1] += event->n_followed;
    n[2] += event->n_corrected;
  }
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "%" PetscInt_FMT " onsets: %" PetscInt_FMT " reduced eigenproblems, %" PetscInt_FMT
                                   " modes followed, %" PetscInt_FMT " corrections on the full problem\n",
                                   n_onsets, n[0], n[1], n[2]));
  PetscFunctionReturn(0);
}
