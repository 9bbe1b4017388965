/* Private to contact/pressure/: what a law consists of. Its functions are pure */
#pragma once

#include <squeal/pressurelaw.h>

/* A law; each file has one, with its parameters and functions. c: closing above the onset, m; p: pressure above 0,
   Pa */
typedef struct {
  const char     *name; /* word of -contact_pressure_law */
  PetscInt        n;
  const Quantity *row;                        /* [n] parameters, none of them may be 0 */
  PetscReal (*onset)(const PressureLaw *law); /* m */
  PetscReal (*pressure)(const PressureLaw *law, PetscReal c);
  PetscReal (*slope)(const PressureLaw *law, PetscReal c); /* also at the onset */
  PetscReal (*closing)(const PressureLaw *law, PetscReal p);
} PressureKind;

/* Where parameter j lies */
#define PRESSURE_PARAMETER(j)                                                                                          \
  .at = offsetof(PressureLaw, parameter) + (j) * sizeof(PetscReal), .size = sizeof(PetscReal)
/* Who reads it, and who varies it */
#define PRESSURE_READ                                                                                                  \
  .in = RUN_LINEAR | RUN_STATIC, .unread = ", whose contact is exact: no penalty, no linearisation",                   \
  .varies = VARIES_LINEAR
