/* Private to quantity/: one row */
#pragma once

#include <squeal/quantity.h>

#define QUANTITY_HELP 512 /* help as -help shows it: "largest growth, 1/s" */

/* Reads the option of a row into its owner, between PetscOptionsBegin() and PetscOptionsEnd(). Collective */
PETSC_INTERN PetscErrorCode QuantityRead(OptionsItems PetscOptionsObject, const char header[], const Quantity *row,
                                         void *owner);
/* What runs do that have a RunBit 1 << i above those of the analyses, in words; NULL beyond the last */
PETSC_INTERN const char *RunBitWords(unsigned i);
/* The option of a row, with the name of its owner: -pad_mu */
PETSC_INTERN PetscErrorCode QuantityGetOption(const char name[], const Quantity *row, size_t size, char option[]);
