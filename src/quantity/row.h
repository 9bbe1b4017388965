/* Private to quantity/: one row */
#pragma once

#include <squeal/quantity.h>

#define QUANTITY_HELP 512 /* help as -help shows it: "largest growth, 1/s" */

/* Reads the option of a row into its owner, whose name stands before it. Collective */
PETSC_INTERN PetscErrorCode QuantityRead(MPI_Comm comm, const char name[], const Quantity *row, void *owner);
/* What runs do that have a RunBit 1 << i above those of the analyses, in words; NULL beyond the last */
PETSC_INTERN const char *RunBitWords(unsigned i);
/* The option of a row, with the name of its owner: -pad_mu */
PETSC_INTERN PetscErrorCode QuantityGetOption(const char name[], const Quantity *row, size_t size, char option[]);
/* How many values a row has; without an owner, 0 of those that are counted */
PETSC_INTERN PetscInt QuantityCount(const Quantity *row, const void *owner);

/* text.c - what is given for an option, or else the default; the default; the sentence, with unit and words: "largest
   growth, 1/s (0: any)" */
PETSC_INTERN PetscErrorCode QuantityGetText(const char option[], const Quantity *row, size_t size, char text[]);
PETSC_INTERN PetscErrorCode QuantityGetInitial(const Quantity *row, size_t size, char text[]);
PETSC_INTERN PetscErrorCode QuantityGetHelp(const Quantity *row, size_t size, char help[]);
