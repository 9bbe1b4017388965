/*
   The error of the reduction: cycles on bodies that keep the modes below 2.25 times the cut-off. A state eta of the
   modes Phi is near T eta of the others Phi_h, T = Phi_h'M Phi; forces of the pairs are the same. From there Newton's
   method goes on with as many steps. What lies above the higher cut-off is in no difference.
*/
#include "cycleimpl.h"

struct _p_CycleHigher {
  LimitCycle       cycle; /* with a flow of its own */
  ReducedRun       bodies;
  const CycleFlow *below; /* that of the cycles below the cut-off, borrowed */
  PetscInt         m;     /* its modes */
  PetscReal       *T;     /* [modes of the bodies][m] */
  ShootingCycle    at;
  ShootingTangent  along;
};

/* A cycle of which is asked what is asked of the one below */
static PetscErrorCode HigherCopy(LimitCycle c, ReducedRun bodies, LimitCycle *copy)
{
  const PetscInt  m       = c->reduced->reduction.model.m;
  const PetscReal size[3] = {c->shooting.size[0], c->shooting.size[m], c->shooting.size[2 * m]};

  PetscFunctionBeginUser;
  PetscCall(CycleCreate(c->comm, copy));
  PetscCall(CycleSetRooms(*copy, bodies, c->operators, c->p));
  PetscCall(CycleSetSound(*copy, c->sound));
  PetscCall(PetscStrncpy((*copy)->parameter, c->parameter, sizeof((*copy)->parameter)));
  (*copy)->varied   = c->varied;
  (*copy)->range[0] = c->range[0];
  (*copy)->range[1] = c->range[1];
  (*copy)->rtol     = c->rtol;
  (*copy)->max_it   = c->max_it;
  (*copy)->beside   = c->family;
  PetscCall(CycleFlowCreate(bodies, &(*copy)->flow));
  PetscCall(CycleSetParameter(*copy));
  PetscCall(CycleSetSizes(*copy, size));
  PetscCall(CycleSetShooting(*copy, 1));
  PetscFunctionReturn(0);
}

/* T [m][m_h] = Phi_h'M Phi by columns of the modes below; as the modes below the cut-off are among those of the
   higher one, nearly a matrix of zeros and ones, up to signs. */
PetscErrorCode CycleHigherCreate(LimitCycle c, CycleHigher *higher)
{
  CycleHigher h;
  PetscInt    n;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(higher));
  h        = *higher;
  h->m     = c->reduced->reduction.model.m;
  h->below = &c->flow;
  PetscCall(ReducedReduceAt(c->reduced, REDUCED_HIGHER * c->reduced->request.cutoff, c->p, NULL, &h->bodies));
  h->bodies->motion.state.time = c->reduced->motion.state.time; /* loads and sliding are those of then */
  PetscCall(PetscMalloc1(h->bodies->reduction.model.m * h->m, &h->T));
  PetscCall(BlockGram(h->bodies->reduction.MPhi, c->reduced->reduction.Phi, h->T));
  PetscCall(HigherCopy(c, h->bodies, &h->cycle));
  n = h->cycle->flow.n;
  PetscCall(PetscCalloc3(n, &h->at.x, n * n, &h->at.M, n, &h->along.x));
  PetscFunctionReturn(0);
}

/* x of the cycles below as it is near here: T eta, T rate, forces and q unchanged. x below and X above differ in
   their number of modes only. */
static void HigherTake(CycleHigher h, const PetscReal x[], PetscReal X[])
{
  const PetscInt   m = h->m, M = h->bodies->reduction.model.m;
  const DenseBlock T = {h->T, M, m, M}, modes = {x, m, 2, m};

  ReducedTimes(&T, &modes, X);
  for (PetscInt i = 2 * m; i < h->below->n; i++) X[2 * M + i - 2 * m] = x[i];
}

/* As many steps, so that the difference is that of the modes alone. A fold is looked for again along the same
   direction, and its shift in the parameter is part of its error. */
PetscErrorCode CycleHigherLook(CycleHigher h, const ShootingCycle *at, const ShootingTangent *along, CyclePoint *point)
{
  LimitCycle     c    = h->cycle;
  ShootingCycle *here = &h->at;

  PetscFunctionBeginUser;
  HigherTake(h, at->x, here->x);
  here->period    = at->period;
  here->value     = at->value;
  c->flow.n_steps = h->below->n_steps;
  if (along) HigherTake(h, along->x, h->along.x);
  h->along.period = along ? along->period : 0;
  h->along.value  = along ? along->value : 0;
  if (along)
    PetscCall(ShootingAdvance(&c->shooting, 0, &h->along, here));
  else
    PetscCall(ShootingSolve(&c->shooting, here));
  point->has_higher = here->converged;
  if (!here->converged) PetscFunctionReturn(0);
  PetscCall(CycleListen(c));
  PetscCall(CycleFlowMeasure(&c->flow, here, &point->higher, NULL));
  PetscCall(CycleHear(c, here->period, c->reduced->request.cutoff / REDUCED_HIGHER, &point->higher_sound));
  PetscCall(ShootingGetStability(&c->shooting, here, &point->higher_stability));
  if (along) point->value_error += PetscAbsReal(here->value - at->value);
  PetscFunctionReturn(0);
}

PetscErrorCode CycleHigherDestroy(CycleHigher *higher)
{
  CycleHigher h = *higher;

  PetscFunctionBeginUser;
  if (!h) PetscFunctionReturn(0);
  PetscCall(CycleDestroy(&h->cycle));
  PetscCall(ReducedDestroy(&h->bodies));
  PetscCall(PetscFree(h->T));
  PetscCall(PetscFree3(h->at.x, h->at.M, h->along.x));
  PetscCall(PetscFree(*higher));
  PetscFunctionReturn(0);
}
