/* Private to frf/: the response on a small space, at many frequencies */
#pragma once

#include "frfimpl.h"
#include "modes/space/space.h"

#define FRF_BATCH 16 /* frequencies that are solved together: trsyl takes the norm of T anew in each call */

/* With materials whose stiffness depends on the frequency: the pencil, copied, the force and the outputs behind it, and
   room for a frequency */
typedef struct {
  DensePencil   pencil;
  DenseLaw     *law;
  PetscReal    *b; /* [1 + n_outputs][n] */
  PetscComplex *T, *x;
  PetscBLASInt *pivot;
} FrfLaws;

/* S = Q0^-1 M undamped, Q0 = K - shift M, or damped the companion matrix of Q(lambda) about a shift, Q0 = Q(shift)
   (basis/companion.c, states [q; p]), on the n vectors of the space as Z T Z' with T quasi-triangular, and the force
   and outputs there. */
typedef struct {
  PetscInt   n, length, n_outputs;
  PetscBool  damped;
  PetscReal  shift;
  PetscReal *T;    /* [length][length] column-major */
  PetscReal *b;    /* [length] Z' [0; Q0^-1 b] */
  PetscReal *l;    /* [n_outputs][length] Z' [0; l] */
  PetscReal *B;    /* [2 FRF_BATCH][2 FRF_BATCH] work: w of each frequency on the diagonal */
  PetscReal *x;    /* [2 FRF_BATCH][length] work */
  FrfLaws    laws; /* in place of all these where it has some */
} FrfSchur;

/* The force and outputs in coordinates of the space: b[its vectors], l[n_outputs][likewise] */
typedef struct {
  PetscInt   n_outputs;
  PetscReal *b, *l;
} FrfEnds;

/* laws.c - such a pencil, and its response at omega, rad/s: re[n_outputs], im[n_outputs]; singular = at a pole */
PETSC_INTERN PetscErrorCode FrfLawsCreate(const ModesSpace *space, PetscBool rounded, const FrfEnds *ends,
                                          FrfLaws *laws);
PETSC_INTERN PetscErrorCode FrfLawsRespond(const FrfLaws *laws, PetscReal omega, PetscInt n_outputs, PetscReal re[],
                                           PetscReal im[], PetscBool *singular);
PETSC_INTERN PetscErrorCode FrfLawsDestroy(FrfLaws *laws);

/* rounded: with K + E in place of K */
PETSC_INTERN PetscErrorCode FrfSchurCreate(const ModesSpace *space, PetscBool rounded, PetscReal shift,
                                           const FrfEnds *ends, FrfSchur *schur);
/* H at n <= FRF_BATCH frequencies omega (rad/s): re[n][n_outputs], im[n][n_outputs]; *pole is the index of one that is
   a pole to rounding, or -1 */
PETSC_INTERN PetscErrorCode FrfSchurRespond(const FrfSchur *schur, PetscInt n, const PetscReal omega[], PetscReal re[],
                                            PetscReal im[], PetscInt *pole);
PETSC_INTERN PetscErrorCode FrfSchurDestroy(FrfSchur *schur);

/* tables/sound.c - the response of all coordinates on the space, of a force in the unknowns of the pencil; what it
   radiates, field[0] on the space before its last step and field[1] on that of now. Collective. */
PETSC_INTERN PetscErrorCode FrfFieldCreate(const ModesSpace *space, PetscReal shift, Vec force, FrfSchur *field);
PETSC_INTERN PetscErrorCode FrfHearFields(Frf frf, const ModesSpace *space, const FrfSchur field[2]);
