/* Private to sweep/: the reduced basis on the mesh and its dense model */
#pragma once

#include "sweep/dense/reduced.h"
#include "base/process/progress.h"
#include <squeal/modes.h>
#include "basis/subspace.h"

/* [V Z], orthonormal in the frictionless mass matrix of the pencil's parameters when it was made. The leading
   reduced.n_used vectors are the model (those added become part of it by BasisUse()), the others estimate its error. */
#define BASIS_MAX_BLOCKS 1024

typedef struct {
  MPI_Comm comm;
  Pencil   pencil;
  Mat      M;
  Subspace space;
  Reduced  reduced;                               /* of its terms */
  PetscInt n_blocks, block_end[BASIS_MAX_BLOCKS]; /* vectors after each BasisAdd() */
} Basis;

PetscErrorCode BasisCreate(MPI_Comm comm, Pencil pencil, Basis *basis);
/* fill.c - block of the vectors of the first n modes of the eigensolver: n_parts = 1 the real parts of right ones, 4
   real and imaginary parts of right and left ones, as far as there are any */
PetscErrorCode BasisCreateModes(const Basis *basis, Modes modes, PetscInt n, PetscInt n_parts, BV *block);
/* fill.c - finds free modes of the bodies, at a point, among the first vectors, for names of modes */
PetscErrorCode BasisKeepFree(const Basis *basis, Modes solver, const PetscReal p[]);
/* fill.c - names of all modes of a point from their shapes on the mesh, as the eigensolver has them */
PetscErrorCode BasisLabelModes(const Basis *basis, Modes solver, const PetscReal p[], const ReducedModes *modes,
                               char label[][32]);
/* Appends what the block holds beyond the basis, leaving out directions whose M-norm is below drop; the block is
   overwritten, n_added (may be NULL) = vectors gained. The dense model follows. */
PetscErrorCode BasisAdd(Basis *basis, BV block, PetscReal drop, PetscInt *n_added);
/* Makes the first n vectors the model, which never shrinks */
PetscErrorCode BasisUse(Basis *basis, PetscInt n);
/* Forgets the vectors that are not used by the model */
PetscErrorCode BasisTruncate(Basis *basis);
/* Makes the dense model of vectors read from elsewhere, block by block as BasisAdd() did */
PetscErrorCode BasisRebuild(Basis *basis, PetscInt n_blocks);
/* block = V coordinates, coordinates [m][size] with size <= n, real */
PetscErrorCode BasisLift(const Basis *basis, PetscInt size, PetscInt m, const PetscReal coordinates[], BV block);
PetscErrorCode BasisDestroy(Basis *basis);

/* fill.c - all unit vectors, for a small system; whole = whether the basis now is the whole space, which the mass
   matrix must allow */
PetscErrorCode BasisFillWhole(Basis *basis, PetscBool *whole);
/* The n_modes real modes nearest to the shift, (rad/s)^2, of the undamped system at the pencil's present point, with
   the symmetric part of its friction or without friction. PETSC_ERR_NOT_CONVERGED where fewer are found. */
PetscErrorCode BasisFillReal(Basis *basis, PetscBool friction, PetscInt n_modes, PetscReal shift, Progress *progress);
