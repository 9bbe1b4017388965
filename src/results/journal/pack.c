/*
   Pack: bytes of different kinds as one array of a file.
*/
#include "journal.h"
#include <string.h>

PetscErrorCode JournalPackMove(JournalPack *pack, void *bytes, size_t size)
{
  const PetscInt n = (PetscInt)((size + sizeof(*pack->word) - 1) / sizeof(*pack->word));

  PetscFunctionBeginUser;
  if (pack->write && pack->n + n > pack->room) {
    pack->room = 2 * pack->n + n;
    PetscCall(PetscRealloc(sizeof(*pack->word) * (size_t)pack->room, &pack->word));
  }
  if (pack->write && n) pack->word[pack->n + n - 1] = 0; /* what lies behind the bytes is written too */
  if (pack->write && n) memcpy(&pack->word[pack->n], bytes, size);
  if (pack->write) pack->n += n;
  if (pack->write) PetscFunctionReturn(0);
  if (pack->at + n > pack->n) pack->good = PETSC_FALSE;
  if (pack->good && n) memcpy(bytes, &pack->word[pack->at], size);
  if (pack->good) pack->at += n;
  PetscFunctionReturn(0);
}

PetscErrorCode JournalPackDestroy(JournalPack *pack)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(pack->word));
  pack->n = pack->room = pack->at = 0;
  PetscFunctionReturn(0);
}
