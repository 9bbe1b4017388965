/* Private to modes/ and sweep/: by which mechanism a mode grows, from numbers alone (mechanism.c) */
#pragma once

#include <squeal/pencil.h>

typedef enum {
  MECHANISM_NONE, /* the mode does not grow */
  MECHANISM_UNKNOWN,
  MECHANISM_COUPLING,
  MECHANISM_NEGATIVE_DAMPING,
  MECHANISM_DIVERGENCE,
  MECHANISM_DAMPING_INDUCED,
  MECHANISM_GYROSCOPIC,
  N_MECHANISMS
} Mechanism;

/* What is taken away: damping of negative sign, of positive sign, gyroscopic terms, or all friction and damping */
typedef enum { WITHOUT_NEGATIVE, WITHOUT_POSITIVE, WITHOUT_GYROSCOPIC, WITHOUT_ALL, N_WITHOUT } MechanismWithout;

/* A mode and, where n = 2, one that shares its motion */
typedef struct {
  PetscInt     n;
  PetscComplex lambda[2], slope[2]; /* rad/s; y'Q'(lambda) x */
  PetscReal    mass;                /* x^H M x of the mode */
  /* sums over the terms, by MechanismAdd() */
  PetscReal    damping[2], twist, skew; /* c- and c+, a of the mode; Im x^H C x */
  PetscBool    has[N_WITHOUT];          /* there are such terms */
  PetscComplex taken[N_WITHOUT][2][2];  /* y_a' X(lambda_b) x_b */
} MechanismPair;

/* Adds a term */
void MechanismAdd(MechanismPair *pair, const PencilForms *forms);
/* lambda[n] of the pair without some terms, to second order in them; the first is what the mode becomes */
void MechanismTake(const MechanismPair *pair, MechanismWithout what, PetscComplex lambda[2]);
/* The mechanism of a mode with lambda[0], or MECHANISM_NONE where that does not grow */
Mechanism MechanismDecide(const MechanismPair *pair);
/* Whether two modes take part */
PetscBool MechanismIsOfTwo(Mechanism mechanism);
/* in tables: "negative_damping"; in words: "negative damping" */
const char *MechanismName(Mechanism mechanism, PetscBool words);
