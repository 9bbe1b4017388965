/*
   Axes - one or two parameters that an analysis varies over values, each with those that take the same values, in the
   words of
   -<owner>_parameter and -<owner>_link. Private to the rooms above base/, which know what the names stand for.
*/
#pragma once

#include <petscsys.h>

#define AXES_MOST 2

/* What the options say; link is NULL where it is not given */
typedef struct {
  MPI_Comm    comm;
  const char *owner, *varied; /* "sweep", "swept": in options and errors */
  const char *parameter, *link;
  PetscBool   has_second; /* values of a second parameter are given */
} AxesGiven;

/* Adds a parameter to axis k, the varied one first; unit (borrowed) = its unit, "" or "-" for none. Raises the error
   for what is no parameter, which `option` names */
typedef PetscErrorCode (*AxesAdd)(void *ctx, const char option[], const char name[], PetscInt k, const char **unit);

/* AxesRead - adds the varied parameters, then those of the links. Not collective, same call on all ranks.
   Errors: PETSC_ERR_USER_INPUT for other numbers of names, names given twice, links without a varied parameter or with
   both, units that differ on one axis. */
PETSC_INTERN PetscErrorCode AxesRead(const AxesGiven *given, AxesAdd add, void *ctx);
