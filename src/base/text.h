/* Private to src/: text that is put together piece by piece, of which nothing is cut in silence */
#pragma once

#include <petscsys.h>

/* TextAdd - adds `more` to a text of `size` characters that a program reads: a name, a path, a line of a table. Not
   collective. Errors: PETSC_ERR_USER_INPUT where there is no room. */
PETSC_INTERN PetscErrorCode TextAdd(char text[], const char more[], size_t size);

/* WordsAdd - the same of words that a reader sees, which end with ... where there is no room. Not collective. */
PETSC_INTERN PetscErrorCode WordsAdd(char text[], const char more[], size_t size);
