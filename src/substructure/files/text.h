/* Private to substructure/: text that grows in memory, and files of superelements for other programs */
#pragma once

#include "substructure/substructureimpl.h"

/* On rank 0; the others write nothing into theirs */
typedef struct {
  PetscSegBuffer buffer; /* NULL on the other ranks */
} Text;

/* text.c - an empty text; printf() at its end, a line of 255 characters at most; the file `name` of it, after which it
   is gone. The first and the last are collective. */
PETSC_INTERN PetscErrorCode TextCreate(MPI_Comm comm, Text *text);
PETSC_INTERN PetscErrorCode TextPrint(const Text *text, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
PETSC_INTERN PetscErrorCode TextWrite(Text *text, Substructure s, Results results, const char name[]);

/* The matrices that are there, with their letter and what they are; n of them */
typedef struct {
  Mat         A;
  char        letter; /* k, m, c */
  const char *unit;
} TextMatrix;
PETSC_INTERN PetscInt TextMatrices(const Substructure s, TextMatrix matrix[3]);

/* Called for each entry of the lower half that is not 0, row by row or, of the same, column by column; i, j from 0.
   Collective; on rank 0 alone it calls */
typedef PetscErrorCode (*TextEntry)(void *ctx, PetscInt i, PetscInt j, PetscReal value);
PETSC_INTERN PetscErrorCode TextForEach(Mat A, TextEntry entry, void *ctx, PetscInt *n);

/* "disc, hat" */
PETSC_INTERN PetscErrorCode TextParts(const Substructure s, size_t size, char parts[]);
/* Node, direction 1 to 3 of an unknown; of modal coordinates and what is kept inside a node of its own, 0 */
PETSC_INTERN void TextPlace(const Substructure s, PetscInt k, PetscInt *node, PetscInt *direction);

/* binary.c - a matrix in PETSc's binary form; nothing for NULL. Collective. */
PETSC_INTERN PetscErrorCode BinaryWrite(Substructure s, Results results, const char name[], Mat A);

/* terms.c - the matrices that moduli, densities and damping are factors of, and a scene of them. Collective. */
PETSC_INTERN PetscErrorCode TermsWrite(Substructure s, Results results);

/* market.c, nastran.c, abaqus.c - the files of one format. Collective. */
PETSC_INTERN PetscErrorCode MarketWrite(Substructure s, Results results);
PETSC_INTERN PetscErrorCode NastranWrite(Substructure s, Results results);
PETSC_INTERN PetscErrorCode AbaqusWrite(Substructure s, Results results);
