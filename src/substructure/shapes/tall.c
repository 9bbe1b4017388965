/* T [unknowns of the parts][unknowns of the superelement], dense: those of the interface first, as they are */
#include "substructure/substructureimpl.h"
#include "base/process/memory.h"

#define TALL_COPIES 4 /* of n x n while a matrix is formed and written, beside those that are kept */

/* Raises the error for a basis and matrices that do not fit into the memory of a machine */
static PetscErrorCode TallCheckMemory(Substructure s, PetscInt n)
{
  const double tall = 8e-9 * (double)s->body.n * (double)n, square = 8e-9 * (double)n * (double)n;
  PetscBool    given;
  double       fits[2]; /* GB to be had, and with the other sign those wanted */

  PetscFunctionBeginUser;
  fits[0] = 1e-3 * MemoryRoom(&given);
  fits[1] = -(tall + square * (TALL_COPIES + 1.5 * (s->body.n_matrices + 3)));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, fits, 2, MPI_DOUBLE, MPI_MIN, s->comm));
  PetscCheck(-fits[1] <= fits[0] && (double)n * (double)n < PETSC_MAX_INT, s->comm, PETSC_ERR_USER_INPUT,
             "-superelement_sets: an interface of %" PetscInt_FMT " unknowns and %" PetscInt_FMT
             " modes make dense matrices that take %.3g GB, and %s %.3g GB: take sets of fewer nodes, or a lower "
             "-superelement_cutoff",
             s->interface.n, n - s->interface.n, -fits[1], given ? "-squeal_memory allows" : "there are free", fits[0]);
  PetscFunctionReturn(0);
}

PetscErrorCode TallCreate(Substructure s, PetscInt n_modal)
{
  PetscScalar *t;
  PetscInt     lda;

  PetscFunctionBeginUser;
  s->n_modal = n_modal;
  s->n       = s->interface.n + n_modal;
  PetscCall(TallCheckMemory(s, s->n));
  PetscCall(MatCreateDense(s->comm, s->body.n_own, PETSC_DECIDE, PETSC_DETERMINE, s->n, NULL, &s->T));
  PetscCall(MatZeroEntries(s->T));
  PetscCall(MatDenseGetLDA(s->T, &lda));
  PetscCall(MatDenseGetArray(s->T, &t));
  for (PetscInt k = 0; k < s->interface.n; k++) {
    const PetscInt row = s->interface.row[k].row - s->body.first;

    if (row >= 0 && row < s->body.n_own) t[(size_t)k * lda + row] = 1;
  }
  PetscCall(MatDenseRestoreArray(s->T, &t));
  PetscFunctionReturn(0);
}
