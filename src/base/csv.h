/* For rooms that read tables with named columns, separated by commas, on one rank: columns stand in any order, further
   ones are left unread, empty lines too. The first fault stands in a text that is to be sent to all ranks */
#pragma once

#include <petscsys.h>
#include <stdio.h>

#define CSV_MAX_LINE    4096
#define CSV_MAX_COLUMNS 32

/* m and the like: numbers beyond are none, and their squares overflow no sum */
#define CSV_LARGEST 1e30

/* A file, its present line cut into words, and what is wrong with it */
typedef struct {
  FILE              *stream;
  PetscInt           line, n_columns, n;  /* n: columns that are asked for */
  const char *const *column;              /* [n] their names */
  int                at[CSV_MAX_COLUMNS]; /* [n] place of each, -1 for none */
  char               text[CSV_MAX_LINE], *word[CSV_MAX_COLUMNS];
  char               fault[256]; /* "" without */
} Csv;

/* Opens it, and finds the columns in the first line: the first n_required must be there, or there is a fault */
PETSC_INTERN void CsvOpen(Csv *csv, const char file[], PetscInt n, const char *const column[], PetscInt n_required);

/* The next line that is not empty; false at the end of the file, and after a fault */
PETSC_INTERN PetscBool CsvNext(Csv *csv);

/* A number of the present line, finite; a fault where it is none */
PETSC_INTERN double CsvReal(Csv *csv, PetscInt column, PetscBool whole);

/* A word of the present line; NULL where the file has no such column */
PETSC_INTERN const char *CsvWord(const Csv *csv, PetscInt column);

PETSC_INTERN void CsvClose(Csv *csv);
