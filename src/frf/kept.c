/*
   What a killed direct response goes on from: the file frf_restart, the responses of all frequencies so far, written
   anew after each and taken away when all are there.
*/
#include "frfimpl.h"
#include "base/process/interrupt.h"
#include "base/path.h"

#define FRF_KEPT  "frf_restart"
#define FRF_ITEMS 4

/* A force or an output, by its entries of all unknowns */
static PetscErrorCode FrfSumVector(Vec v, Checksum c)
{
  const PetscScalar *array;
  PetscInt           n;
  uint64_t           sum;

  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(v, &n));
  PetscCall(VecGetArrayRead(v, &array));
  sum = ChecksumBytes(CHECKSUM_BEGIN, array, sizeof(*array) * (size_t)n);
  PetscCall(VecRestoreArrayRead(v, &array));
  PetscCall(ChecksumAddPieces(c, 1, &sum));
  PetscFunctionReturn(0);
}

/* What the response depends on: scene, statics, parameters, frequencies, force and outputs, and the number of
   ranks, on which the last digits do. */
static PetscErrorCode FrfSumScene(Frf frf, Checksum c)
{
  const OperatorsParameter *parameters;
  PetscReal                *p;
  PetscInt                  n;
  PetscMPIInt               size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(frf->comm, &size));
  PetscCall(OperatorsAddSceneChecksum(frf->operators, PETSC_FALSE, c));
  if (frf->statics) PetscCall(StaticsAddChecksum(frf->statics, c));
  PetscCall(OperatorsGetParameters(frf->operators, &n, &parameters));
  PetscCall(OperatorsCreatePoint(frf->operators, NULL, &p));
  PetscCall(ChecksumSetPart(c, "the response"));
  PetscCall(ChecksumAddInts(c, 2, (const PetscInt[]){size, frf->n_outputs}));
  PetscCall(ChecksumAddReals(c, n, p));
  PetscCall(ChecksumAddReals(c, frf->n, frf->freq));
  PetscCall(FrfSumVector(frf->f, c));
  for (PetscInt k = 0; k < frf->n_outputs; k++) PetscCall(FrfSumVector(frf->l[k], c));
  PetscCall(SoundAddChecksum(frf->sound, c));
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

/* The responses of n frequencies; n < 0: any */
static void FrfListItems(Frf frf, PetscInt n, JournalItem item[FRF_ITEMS])
{
  const PetscInt m = n < 0 ? 1 : frf->n_outputs;

  item[0] = (JournalItem){"real parts", n * m, n < 0 ? NULL : frf->re};
  item[1] = (JournalItem){"imaginary parts", n * m, n < 0 ? NULL : frf->im};
  item[2] = (JournalItem){"errors", n, n < 0 ? NULL : frf->error};
  item[3] = (JournalItem){"sound", n < 0 ? n : n * frf->n_heard, n < 0 ? NULL : frf->heard};
}

PetscErrorCode FrfResume(Frf frf, PetscInt *n)
{
  PetscReal  *to[FRF_ITEMS] = {frf->re, frf->im, frf->error, frf->heard};
  JournalItem item[FRF_ITEMS];
  PetscBool   taken;

  PetscFunctionBeginUser;
  *n = 0;
  if (!frf->restart || !frf->journal.results) PetscFunctionReturn(0);
  PetscCall(ChecksumCreate(frf->comm, &frf->journal.scene));
  PetscCall(FrfSumScene(frf, frf->journal.scene));
  FrfListItems(frf, -1, item);
  PetscCall(JournalTake(&frf->journal, FRF_KEPT, "the response begins anew", FRF_ITEMS, item, &taken));
  if (taken) *n = item[2].n;
  for (int k = 0; k < FRF_ITEMS; k++) {
    if (taken) PetscCall(PetscArraycpy(to[k], item[k].values, item[k].n));
    PetscCall(PetscFree(item[k].values));
  }
  if (taken)
    PetscCall(
      PetscPrintf(frf->comm, "going on with %" PetscInt_FMT " of %" PetscInt_FMT " frequencies kept\n", *n, frf->n));
  PetscFunctionReturn(0);
}

/* The first n frequencies; written when it is due. A file that cannot be written ends the keeping, not the
   response. */
PetscErrorCode FrfKeep(Frf frf, PetscInt n)
{
  JournalItem item[FRF_ITEMS];

  PetscFunctionBeginUser;
  if (!frf->restart || !frf->journal.results || !JournalIsDue(n)) PetscFunctionReturn(0);
  FrfListItems(frf, n, item);
  PetscCall(JournalKeep(&frf->journal, FRF_KEPT, FRF_ITEMS, item, &frf->restart));
  if (frf->restart)
    InterruptSays("%d of %d frequencies are kept, with which the same command goes on", (int)n, (int)frf->n);
  PetscFunctionReturn(0);
}

PetscErrorCode FrfForget(Frf frf)
{
  const char *folder;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  if (frf->method != FRF_DIRECT || !frf->restart || !frf->journal.results) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Comm_rank(frf->comm, &rank));
  PetscCall(ResultsGetDirectory(frf->journal.results, &folder));
  if (!rank) PathForget(folder, FRF_KEPT);
  PetscFunctionReturn(0);
}
