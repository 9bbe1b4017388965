/*
   Log events: the hot functions, registered by SquealInitialize() in the class of their room; -log_view attributes time
   to them.
*/
#pragma once

#include <petscsys.h>

typedef enum {
  EVENT_PAIR,
  EVENT_SEARCH,
  EVENT_ASSEMBLE,
  EVENT_STATICS,
  EVENT_FACTOR,
  EVENT_SOLVE,
  EVENT_COLUMN, /* counts the right-hand sides that are solved in blocks; takes no time */
  EVENT_LABEL,
  EVENT_CAUSES, /* balance and mechanism of each mode, power at each pair */
  EVENT_COMPONENTS,
  EVENT_EFFECTS,
  EVENT_CORRECT,
  EVENT_ORTHOGONALISE,
  EVENT_REDUCED,
  EVENT_FOLLOW,
  EVENT_TRACK,
  EVENT_BODIES_ADVANCE,
  EVENT_EXCHANGE,
  EVENT_EXTERNAL,
  EVENT_PROJECT,
  EVENT_MOVE,
  EVENT_RECORD,
  EVENT_CHECKPOINT,
  N_EVENTS
} SquealEvent;

extern PetscLogEvent squeal_events[N_EVENTS]; /* 0 until they are registered */

#define EventBegin(event) PetscLogEventBegin(squeal_events[event], 0, 0, 0, 0)
#define EventEnd(event)   PetscLogEventEnd(squeal_events[event], 0, 0, 0, 0)
