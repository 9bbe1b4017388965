/*
   MeshReader - numbers from a file in sections that is text or binary. The first error is kept in words; later reads
   give zeros.
*/
#pragma once

#include <petscsys.h>
#include <stdint.h>
#include <stdio.h>

#define INT_BYTES  4 /* the two sizes of integers in binary files */
#define SIZE_BYTES 8

typedef struct {
  PetscErrorCode code; /* 0: none */
  char           text[256];
} ReaderError;

typedef struct {
  FILE        *file;
  PetscBool    binary;
  PetscInt     version;     /* 22 or 41 */
  char         section[32]; /* the one being read */
  long         most;        /* items that a file of this size can hold */
  ReaderError *error;
  unsigned     seen; /* a bit for each section that has been read */
} MeshReader;

/* Records an error unless there is one */
PETSC_INTERN void ReaderErrorSet(ReaderError *error, PetscErrorCode code, const char format[], ...);

PETSC_INTERN int64_t  ReadInteger(MeshReader *r, int bytes); /* any integer */
PETSC_INTERN PetscInt ReadTag(MeshReader *r, int bytes);     /* one that fits into PetscInt */
PETSC_INTERN PetscInt ReadCount(MeshReader *r, int bytes);   /* one that the file can hold as many items as */
PETSC_INTERN PetscInt ReadCountLine(MeshReader *r);          /* a count on a line of text, also in binary files */
PETSC_INTERN void     ReadReals(MeshReader *r, PetscInt n, PetscReal value[]);

/* Reads to the end of the section, which nothing else may come before where the section is known and has been read */
PETSC_INTERN void ReadSectionEnd(MeshReader *r, PetscBool known);
