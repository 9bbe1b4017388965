/*
   An oscillator of two modes whose friction couples them (flutter), and which lifts off in each period, so that it ends in a limit
   cycle; without steps that is the one of tests/verify/cycle_oscillator.py, by matrix exponentials between the events.
*/
#pragma once

#include "reduced/cycle/cycleimpl.h"

#define PORTS 4 /* of one pair, and of the load */

/* The oscillator, and where it is in its cycle */
typedef struct {
  ReducedModel     model;
  ReducedParameter friction;
  PetscReal        omega2[2], C[4], P[2 * PORTS], W[PORTS * PORTS], gap;
  FrictionLaw      law;
  CycleFlow        flow;
  Shooting         shooting;
  ShootingCycle    cycle;
  PetscReal        size[7], weight[7];
} Oscillator;

static inline PetscErrorCode OscillatorCreate(PetscReal mu, Oscillator *o)
{
  const PetscReal normal[2] = {0.8, 0.6}, tangent[2] = {-0.6, 0.8};

  PetscFunctionBeginUser;
  *o = (Oscillator){
    .omega2 = {1,  2.2 },
      .C = { 0.04, 0, 0, 0.04},
      .law = {.speed = 10, .parameter = {mu}}
  };
  o->model = (ReducedModel){.m       = 2,
                            .n_pairs = 1,
                            .n_loads = 1,
                            .n_ports = PORTS,
                            .omega2  = o->omega2,
                            .C       = o->C,
                            .P       = o->P,
                            .W       = o->W,
                            .gap     = &o->gap,
                            .friction = &o->law};
  for (int k = 0; k < 2; k++) {
    o->P[k]     = normal[k];
    o->P[2 + k] = tangent[k];
    o->P[6 + k] = -normal[k];
  }
  for (int i = 0; i < 3; i++) o->W[i * (PORTS + 1)] = 1;
  o->flow = (CycleFlow){.model = &o->model, .n = ReducedTangentSize(&o->model), .varied = &o->friction, .value = mu};
  o->friction = (ReducedParameter){.kind = REDUCED_FRICTION, .value = mu};
  PetscCall(
    PetscCalloc5(1, &o->flow.loads, 1, &o->flow.share, 1, &o->flow.way, 1, &o->flow.stated, 1, &o->flow.interface));
  PetscCall(ReducedStateCreate(&o->model, &o->flow.state));
  PetscCall(ReducedReportCreate(&o->model, &o->flow.report));
  o->flow.loads[0] = 1;
  o->flow.share[0] = 1;
  o->flow.stated[0] = o->law;
  for (PetscInt i = 0; i < o->flow.n; i++) {
    o->size[i]   = 1;
    o->weight[i] = i < 4;
  }
  o->shooting = (Shooting){.n      = o->flow.n,
                           .flow   = CycleFlowRun,
                           .ctx    = &o->flow,
                           .size   = o->size,
                           .weight = o->weight,
                           .span   = 1,
                           .rtol   = 1e-11,
                           .max_it = 20};
  PetscCall(PetscCalloc2(o->flow.n, &o->cycle.x, PetscSqr(o->flow.n), &o->cycle.M));
  o->cycle.value = mu;
  PetscFunctionReturn(0);
}

static inline PetscErrorCode OscillatorDestroy(Oscillator *o)
{
  PetscFunctionBeginUser;
  PetscCall(CycleFlowDestroy(&o->flow));
  PetscCall(PetscFree2(o->cycle.x, o->cycle.M));
  PetscFunctionReturn(0);
}

/* In time until it is near its cycle */
static inline PetscErrorCode OscillatorSettle(Oscillator *o, PetscReal period)
{
  PetscReal y[7];

  PetscFunctionBeginUser;
  o->cycle.x[0]   = -0.5;
  o->flow.n_steps = 64;
  for (int i = 0; i < 60; i++) {
    PetscCall(CycleFlowRun(&o->flow, o->cycle.x, period, o->cycle.value, y, NULL));
    PetscCall(PetscArraycpy(o->cycle.x, y, o->flow.n));
  }
  o->cycle.period = period;
  PetscFunctionReturn(0);
}
