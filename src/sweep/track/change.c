/*
   Changes of stability between two points as events.
*/
#include "change.h"

/* Appends to events; a list begins as {0} */
static PetscErrorCode BranchEventsAdd(BranchEvents *events, const BranchEvent *event)
{
  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((events->n + 1) * sizeof(*event), &events->event));
  events->event[events->n++] = *event;
  PetscFunctionReturn(0);
}

/* The branch with which mode i of an unstable point interacts: its partner of the pair, with damping the nearest
   eigenvalue within a tenth of |lambda|; -1 for none. */
static PetscInt EventPartner(const ModeFrame *frame, PetscInt i)
{
  const PetscComplex lambda  = frame->modes.lambda[i];
  PetscInt           partner = ModeFramePartner(frame, i);
  PetscReal          nearest = 0.1 * cabs(lambda);

  for (PetscInt k = 0; k < frame->modes.n && frame->form.damped; k++) {
    const PetscReal distance = cabs(frame->modes.lambda[k] - lambda);

    if (k != i && distance <= nearest) partner = k, nearest = distance;
  }
  return partner < 0 ? -1 : frame->branch[partner];
}

/* Event between two points of mode i, which is unstable at this one */
static BranchEvent EventOf(const ModeFrame *frame, PetscInt i, const ModeFrame *other)
{
  return (BranchEvent){.lambda    = frame->modes.lambda[i],
                       .omega     = cimag(frame->modes.lambda[i]),
                       .lower     = PetscMin(frame->value, other->value),
                       .upper     = PetscMax(frame->value, other->value),
                       .critical  = frame->value,
                       .mechanism = ModeFrameMechanism(frame, i),
                       .branch    = {frame->branch[i], EventPartner(frame, i)}};
}

/* frame is the point where the mode is unstable. begins: with growing values of the parameter the mode becomes
   unstable, whichever way the line runs. A real eigenvalue is a divergence. */
PetscErrorCode ChangeAdd(const ModeFrame *frame, PetscInt i, const ModeFrame *other, BranchEvents *events)
{
  const PetscBool begins = frame->value > other->value ? PETSC_TRUE : PETSC_FALSE;
  BranchEvent     event  = EventOf(frame, i, other);

  PetscFunctionBeginUser;
  if (cimag(event.lambda) == 0)
    event.kind = begins ? EVENT_DIVERGENCE : EVENT_RESTABILISATION;
  else
    event.kind = begins ? EVENT_LOCK_IN : EVENT_LOCK_OUT;
  PetscCall(BranchEventsAdd(events, &event));
  PetscFunctionReturn(0);
}

/* Across a change of status there is no value to find: the middle of the step, its half width as the error. */
PetscErrorCode ChangeAddJump(const ModeFrame *frame, PetscInt i, const ModeFrame *other, BranchEvents *events)
{
  BranchEvent event = EventOf(frame, i, other);

  PetscFunctionBeginUser;
  event.kind     = EVENT_JUMP;
  event.found    = PETSC_TRUE;
  event.critical = 0.5 * (event.lower + event.upper);
  event.error    = 0.5 * (event.upper - event.lower);
  event.above    = frame->value > other->value ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(BranchEventsAdd(events, &event));
  PetscFunctionReturn(0);
}

PetscErrorCode BranchEventsDestroy(BranchEvents *events)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(events->event));
  events->n = 0;
  PetscFunctionReturn(0);
}
