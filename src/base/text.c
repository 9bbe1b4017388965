/*
   Text that is put together piece by piece. PetscStrlcat() of PETSc 3.18 adds no more than size - strlen(more)
   characters of a piece, also where there is room for all.
*/
#include "base/text.h"

#define REST "..."

PetscErrorCode TextAdd(char text[], const char more[], size_t size)
{
  const size_t length = strlen(text), add = strlen(more);

  PetscFunctionBeginUser;
  PetscCheck(length + add < size, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "no room for '%.60s' behind the %zu characters of '%.60s': give shorter names, or fewer", more, length,
             text);
  PetscCall(PetscArraycpy(text + length, more, add + 1));
  PetscFunctionReturn(0);
}

PetscErrorCode WordsAdd(char text[], const char more[], size_t size)
{
  const size_t length = strlen(text), rest = strlen(REST), add = PetscMin(strlen(more), size - 1 - length);

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(text + length, more, add));
  text[length + add] = '\0';
  if (add < strlen(more) && size > rest) PetscCall(PetscArraycpy(text + size - 1 - rest, REST, rest));
  PetscFunctionReturn(0);
}
