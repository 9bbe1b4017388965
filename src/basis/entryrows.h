/* Private to basis/ and sweep/: V' A W with a matrix A that has entries in some rows only, as that of a small part
   among large ones */
#pragma once

#include <slepcbv.h>

/* The local rows of a matrix that have an entry which is not zero, or all of them where most have */
typedef struct {
  PetscInt  n, *row;  /* [n] */
  PetscBool all, few; /* all: of the local ones; few: of all rows, on all ranks together */
} EntryRows;

/* Collective */
PetscErrorCode EntryRowsCreate(Mat A, EntryRows *rows);
PetscErrorCode EntryRowsDestroy(EntryRows *rows);
/* H = X' Y for the active columns, other rows left out; diagonal (NULL: ones) = weights of the rows; alike on
   every rank, the caller destroys it. Collective. */
PetscErrorCode EntryRowsProducts(const EntryRows *rows, BV X, Vec diagonal, BV Y, Mat *H);
