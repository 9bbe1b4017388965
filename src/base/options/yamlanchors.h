/* Private to base/: names (&) of values in a YAML file, and aliases (*) that repeat them */
#pragma once

#include <petscsys.h>
#include <yaml.h>

#define YAML_VALUE -1 /* depth of a value that is no mapping and no list */

/* What has a name */
typedef struct {
  char     *name;
  PetscBool many;        /* a mapping or list */
  PetscInt  depth;       /* levels above it, YAML_VALUE once it has ended */
  size_t    first, size; /* values before it, and in it */
} YamlAnchor;

/* All of a file */
typedef struct {
  PetscInt    n;
  YamlAnchor *anchor;
  size_t      n_values; /* so far, what aliases repeat included */
} YamlAnchors;

/* A value, mapping or list begins, name NULL for none; the mapping or list at a depth ends. Not collective. */
PETSC_INTERN PetscErrorCode YamlAnchorsAdd(YamlAnchors *anchors, const yaml_char_t name[], PetscInt depth);
PETSC_INTERN void           YamlAnchorsEnd(YamlAnchors *anchors, PetscInt depth);

/* Raises PETSC_ERR_USER_INPUT where there are too many values with some more of them. Not collective. */
PETSC_INTERN PetscErrorCode YamlAnchorsCount(YamlAnchors *anchors, const char file[], size_t line, size_t more);

/* An alias, in a list or not: raises PETSC_ERR_USER_INPUT where nothing has that name, where it stands within what it
   repeats, for a mapping or list in a list, and for too many values. Not collective. */
PETSC_INTERN PetscErrorCode YamlAnchorsRepeat(YamlAnchors *anchors, const char file[], size_t line, PetscBool in_list,
                                              const char name[]);
PETSC_INTERN PetscErrorCode YamlAnchorsDestroy(YamlAnchors *anchors);
