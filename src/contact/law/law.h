/* Private to contact/law/: what a law consists of. Its functions are pure */
#pragma once

#include <squeal/frictionlaw.h>

/* A law; each file has one, with its parameters and functions. s: slip speed, m/s */
typedef struct {
  const char              *name; /* word of -contact_friction_law */
  PetscInt                 n;
  const FrictionParameter *parameter; /* [n] coefficients first */
  PetscBool                about;     /* given about the stated speed, at which mu is the same whatever that is */
  PetscReal (*mu)(const FrictionLaw *law, PetscReal s);
  PetscReal (*slope)(const FrictionLaw *law, PetscReal s);                         /* mu', s/m */
  void (*derive)(const FrictionLaw *law, PetscReal s, FrictionDerivative *result); /* at s, into a result of zeros */
  PetscBool (*varies)(const FrictionLaw *law);
  PetscReal (*rise)(const FrictionLaw *law, PetscReal s); /* p d mu / dp; NULL where mu knows no pressure */
  const Quantity *file;                                   /* row of the file of a table, at FrictionOptions; or NULL */
  const char *(*remark)(const FrictionLaw *law);          /* what is odd about the parameters, or NULL; NULL for none */
} FrictionKind;

/* What options say: a law, and the file of its table */
typedef struct {
  FrictionLaw law;
  char        file[PETSC_MAX_PATH_LEN];
} FrictionOptions;

/* mufile.c - the table of a file into the law; errors for what is none. Collective */
PETSC_INTERN PetscErrorCode FrictionReadTable(MPI_Comm comm, const char name[], const char file[], FrictionLaw *law);

/* Where parameter j lies */
#define FRICTION_AT(j) .at = offsetof(FrictionLaw, parameter) + (j) * sizeof(PetscReal), .size = sizeof(PetscReal)
