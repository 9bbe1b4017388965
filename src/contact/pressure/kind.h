/* Private to contact/pressure/: what a law consists of. Its functions are pure */
#pragma once

#include <squeal/pressurelaw.h>

/* A law; each file has one, with its parameters and functions. c: closing above the onset, m; p: pressure above 0,
   Pa */
typedef struct {
  const char     *name;                       /* word of -contact_pressure_law */
  PetscInt        n, n_rows;                  /* parameters; rows, those of the parameters first */
  const Quantity *row;                        /* [n_rows] none of the parameters may be 0 */
  PetscReal (*onset)(const PressureLaw *law); /* m */
  PetscReal (*pressure)(const PressureLaw *law, PetscReal c);
  PetscReal (*slope)(const PressureLaw *law, PetscReal c); /* also at the onset */
  PetscReal (*closing)(const PressureLaw *law, PetscReal p);
  PetscReal (*energy)(const PressureLaw *law, PetscReal c); /* int P dc from the onset on, J/m^2 */
} PressureKind;

/* What options say: a law, and the file of its points */
typedef struct {
  PressureLaw law;
  char        file[PETSC_MAX_PATH_LEN];
} PressureOptions;

/* Numbers of a table, which no sweep varies */
typedef enum { TABLE_THICKNESS, TABLE_SAMPLE, TABLE_LINING } TableParameter;

/* points.c - the points of a table, from its option in the law, or from the file, of a lining as closings; errors for
   those that are none */
PETSC_INTERN PetscErrorCode PressurePointsSet(MPI_Comm comm, const char name[], const char file[], PressureLaw *law);

#define PRESSURE_ROOM  2000 /* numbers of a table, at most */
#define PRESSURE_EXACT ", whose contact is exact; a reduced model has the law with -dynamics_contact penalty"

/* Where parameter j lies */
#define PRESSURE_PARAMETER(j)                                                                                          \
  .at = offsetof(PressureLaw, parameter) + (j) * sizeof(PetscReal), .size = sizeof(PetscReal)
/* Who reads it, and who varies it */
#define PRESSURE_TABLE .in = RUN_LINEAR | RUN_STATIC | RUN_SPRINGS, .unread = PRESSURE_EXACT
#define PRESSURE_READ  PRESSURE_TABLE, .varies = VARIES_LINEAR
