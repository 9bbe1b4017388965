/*
   Checksum: sums of named parts of a scene.
*/
#include <squeal/checksum.h>
#include <stdarg.h>
#include "base/text.h"

struct _p_Checksum {
  MPI_Comm      comm;
  PetscInt      n, present; /* parts, and that to which values are added */
  ChecksumPart *part;
};

static uint64_t ChecksumWord(uint64_t h, uint64_t w)
{
  h = (h ^ w) * UINT64_C(0x9e3779b97f4a7c15); /* odd, bits evenly spread: 2^64 divided by the golden ratio */
  return h ^ (h >> 32);
}

uint64_t ChecksumBytes(uint64_t h, const void *bytes, size_t size)
{
  const char *at   = bytes;
  uint64_t    word = 0;
  size_t      left = size;

  for (; left >= sizeof(word); left -= sizeof(word), at += sizeof(word)) {
    memcpy(&word, at, sizeof(word));
    h = ChecksumWord(h, word);
  }
  word = 0;
  if (left) memcpy(&word, at, left);
  if (left) h = ChecksumWord(h, word);
  return ChecksumWord(h, (uint64_t)size);
}

PetscErrorCode ChecksumCreate(MPI_Comm comm, Checksum *checksum)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(checksum));
  (*checksum)->comm = comm;
  PetscFunctionReturn(0);
}

/* Index of a part of this name among n, -1 without */
static PetscInt ChecksumFindPart(PetscInt n, const ChecksumPart part[], const char name[])
{
  for (PetscInt i = 0; i < n; i++)
    if (!strncmp(part[i].name, name, sizeof(part[i].name))) return i;
  return -1;
}

PetscErrorCode ChecksumSetPart(Checksum c, const char format[], ...)
{
  ChecksumPart part = {.sum = CHECKSUM_BEGIN};
  va_list      args;

  PetscFunctionBeginUser;
  va_start(args, format);
  PetscCall(PetscVSNPrintf(part.name, sizeof(part.name), format, NULL, args));
  va_end(args);
  c->present = ChecksumFindPart(c->n, c->part, part.name);
  if (c->present >= 0) PetscFunctionReturn(0);
  c->present = c->n++;
  PetscCall(PetscRealloc((size_t)c->n * sizeof(part), &c->part));
  c->part[c->present] = part;
  PetscFunctionReturn(0);
}

PetscErrorCode ChecksumDropPart(Checksum c, const char name[])
{
  const PetscInt k = ChecksumFindPart(c->n, c->part, name);

  PetscFunctionBeginUser;
  if (k < 0) PetscFunctionReturn(0);
  c->present = 0;
  PetscCall(PetscArraymove(&c->part[k], &c->part[k + 1], c->n - k - 1));
  c->n--;
  PetscFunctionReturn(0);
}

static PetscErrorCode ChecksumAdd(Checksum c, const void *bytes, size_t size)
{
  PetscFunctionBeginUser;
  PetscCheck(c->n, c->comm, PETSC_ERR_ARG_WRONGSTATE, "ChecksumSetPart() must come first");
  c->part[c->present].sum = ChecksumBytes(c->part[c->present].sum, bytes, size);
  PetscFunctionReturn(0);
}

PetscErrorCode ChecksumAddReals(Checksum c, PetscInt n, const PetscReal values[])
{
  PetscReal *plain;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &plain));
  for (PetscInt i = 0; i < n; i++) plain[i] = values[i] + 0.0; /* -0 becomes 0 */
  PetscCall(ChecksumAdd(c, plain, (size_t)n * sizeof(*plain)));
  PetscCall(PetscFree(plain));
  PetscFunctionReturn(0);
}

PetscErrorCode ChecksumAddInts(Checksum c, PetscInt n, const PetscInt values[])
{
  PetscFunctionBeginUser;
  PetscCall(ChecksumAdd(c, values, (size_t)n * sizeof(*values)));
  PetscFunctionReturn(0);
}

PetscErrorCode ChecksumAddString(Checksum c, const char text[])
{
  PetscFunctionBeginUser;
  PetscCall(ChecksumAdd(c, text ? text : "", text ? strlen(text) : 0));
  PetscFunctionReturn(0);
}

PetscErrorCode ChecksumAddPieces(Checksum c, PetscInt n, const uint64_t piece[])
{
  uint64_t sum[2] = {0, (uint64_t)n};

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) sum[0] += piece[i];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPI_UINT64_T, MPI_SUM, c->comm));
  PetscCall(ChecksumAdd(c, sum, sizeof(sum)));
  PetscFunctionReturn(0);
}

PetscErrorCode ChecksumGetParts(Checksum c, PetscInt *n, const ChecksumPart **parts)
{
  PetscFunctionBeginUser;
  *n     = c->n;
  *parts = c->part;
  PetscFunctionReturn(0);
}

PetscErrorCode ChecksumCompare(Checksum c, PetscInt n, const ChecksumPart kept[], size_t size, char names[])
{
  PetscFunctionBeginUser;
  names[0] = '\0';
  for (PetscInt i = 0; i < c->n + n; i++) { /* those of the checksum, then those that were kept alone */
    const ChecksumPart *part  = i < c->n ? &c->part[i] : &kept[i - c->n];
    const PetscInt      other = i < c->n ? ChecksumFindPart(n, kept, part->name) : -1;

    if (i < c->n ? other >= 0 && kept[other].sum == part->sum : ChecksumFindPart(c->n, c->part, part->name) >= 0)
      continue;
    PetscCall(WordsAdd(names, names[0] ? ", " : "", size));
    PetscCall(WordsAdd(names, part->name, size));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ChecksumDestroy(Checksum *checksum)
{
  PetscFunctionBeginUser;
  if (*checksum) PetscCall(PetscFree((*checksum)->part));
  PetscCall(PetscFree(*checksum));
  PetscFunctionReturn(0);
}
