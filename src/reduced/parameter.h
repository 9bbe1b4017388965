/*
   Parameter - a number of the scene that rooms which run reduced models may vary. Private to them. It is named like the
   option that sets it: friction and the speed of a contact, force or pressure of a load leave the reduced bodies
   as they are; those of parts, springs and dashpots (operators.h) change them.
*/
#pragma once

#include <squeal/reduced.h>

typedef enum { REDUCED_FRICTION, REDUCED_SPEED, REDUCED_LOAD, REDUCED_BODY } ReducedParameterKind;

typedef struct {
  char                 name[128];
  const char          *unit;
  ReducedParameterKind kind;
  PetscInt             index; /* of the interface, the load, or the parameter of the operators */
  PetscReal            value; /* of the scene */
  PetscInt             law;   /* of friction: place in the law of the interface */
  PetscReal            least; /* what values may not be below */
  PetscBool            open;  /* nor equal */
} ReducedParameter;

/* What a parameter moves that leaves the bodies as they are */
typedef struct {
  ReducedModel      *model;     /* friction */
  const PetscInt    *interface; /* [n_pairs] */
  const FrictionLaw *friction;  /* [n_pairs] of the scene */
  PetscReal         *loads;     /* [n_loads] factors, 1 in the scene */
} ReducedMoved;

/* ReducedParameterFind - the parameter of that name, p [parameters] being the values of the operators. Collective.
   Errors: PETSC_ERR_USER_INPUT "<option> '<name>' is no parameter <what>; valid are ...". */
PETSC_INTERN PetscErrorCode ReducedParameterFind(Operators operators, const PetscReal p[], const char option[],
                                                 const char what[], const char name[], ReducedParameter *parameter);

/* ReducedParameterCheck - raises PETSC_ERR_USER_INPUT for a value of `option` that it cannot have. Collective. */
PETSC_INTERN PetscErrorCode ReducedParameterCheck(Operators operators, const char option[],
                                                  const ReducedParameter *parameter, PetscReal value);

/* ReducedParameterMove - gives one that is none of the bodies a value. Not collective. */
PETSC_INTERN void ReducedParameterMove(const ReducedParameter *parameter, PetscReal value, const ReducedMoved *moved);

/* What no frequency of the bodies rises by more than from the scene to a value: the root of a stiffness, or of one over
   a mass */
PETSC_INTERN PetscErrorCode ReducedParameterGetRise(const ReducedParameter *parameter, PetscReal value,
                                                    PetscReal *rise);
