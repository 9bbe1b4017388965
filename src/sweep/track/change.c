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
   eigenvalue */
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
  return (BranchEvent){.lambda   = frame->modes.lambda[i],
                       .omega    = cimag(frame->modes.lambda[i]),
                       .lower    = PetscMin(frame->value, other->value),
                       .upper    = PetscMax(frame->value, other->value),
                       .critical = frame->value,
                       .branch   = {frame->branch[i], EventPartner(frame, i)}};
}

/* Whether most of the growth of mode i comes from damping, not from an unsymmetric stiffness through which two modes
   feed each other. With x^H M x = 1 the imaginary part of x^H Q(sigma + i omega) x = 0 is

      2 sigma omega = P - omega c,   P = -Im x^H K x,   c = Re x^H C x,

   so that damping alone makes -c / 2 of sigma, and more than half of it where c < -sigma. */
static PetscBool GrowsByDamping(const ModeFrame *frame, PetscInt i)
{
  const DensePencil  *pencil = &frame->pencil;
  const PetscInt      size   = frame->modes.size;
  const PetscComplex *x      = &frame->modes.x[i * size];
  PetscReal           c      = 0;

  for (PetscInt k = 0; k < size && pencil->damped; k++)
    for (PetscInt j = 0; j < size; j++) c += creal(conj(x[j]) * x[k]) * pencil->C[k * pencil->n + j];
  return c < -creal(frame->modes.lambda[i]) ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode ChangeAdd(const ModeFrame *frame, PetscInt i, const ModeFrame *other, BranchEvents *events)
{
  const PetscBool begins = frame->value > other->value ? PETSC_TRUE : PETSC_FALSE;
  BranchEvent     event  = EventOf(frame, i, other);

  PetscFunctionBeginUser;
  if (cimag(event.lambda) == 0)
    event.kind = begins ? EVENT_DIVERGENCE : EVENT_RESTABILISATION;
  else
    event.kind = begins ? EVENT_LOCK_IN : EVENT_LOCK_OUT;
  event.by_damping = cimag(event.lambda) != 0 ? GrowsByDamping(frame, i) : PETSC_FALSE;
  PetscCall(BranchEventsAdd(events, &event));
  PetscFunctionReturn(0);
}

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
