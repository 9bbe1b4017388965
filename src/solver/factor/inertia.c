/*
   Counting modes by inertia. The eigenvalues kappa = omega^2 of K x = kappa M x, M positive semidefinite, are real, and
   the negative pivots nu(s) of K - s M grow with s by one at each (Sylvester's law of inertia; B. N. Parlett, The
   Symmetric Eigenvalue Problem, SIAM 1998, sect. 3.3). So nu(s_2) - nu(s_1) of them lie between s_1 and s_2.

   With M positive definite nu(-infinity) = 0. Unknowns without mass change that: each multiplier of a constraint brings
   a negative pivot at every s, since [A B'; B 0] has as many as B has rows beside those of A on B x = 0, and so does an
   unknown without mass and with negative stiffness. They stand for infinite eigenvalues and are no modes. They are
   counted at s = -most^2, below every mode that does not grow faster than `most`.
*/
#include "shiftinvert.h"

#define MASSLESS_AWAY 1e-3 /* relative move of a shift far below zero on which there is an eigenvalue */
#define MOVES         4    /* of a shift */

/* Negative and null pivots of K - kappa M, kappa in (rad/s)^2; factors that are those of this shift already serve. */
static PetscErrorCode CountPivots(const PencilMatrices *pencil, PetscReal kappa, ShiftInvert *si, PetscInt *n_negative,
                                  PetscInt *n_null)
{
  PetscBool stands;
  PC        pc;
  Mat       F;

  PetscFunctionBeginUser;
  si->inertia = PETSC_TRUE;
  PetscCall(ShiftInvertStands(pencil, kappa, si, &stands));
  si->counts = PETSC_TRUE;
  if (!stands) PetscCall(ShiftInvertMove(pencil, kappa, si));
  si->counts = PETSC_FALSE;
  PetscCall(KSPGetPC(si->ksp, &pc));
  PetscCall(PCFactorGetMatrix(pc, &F));
  PetscCall(MatGetInertia(F, n_negative, n_null, NULL));
  PetscFunctionReturn(0);
}

/* Moves grow, 0, 1, 2, 3 times `away` one after the other: a null pivot may be one of several eigenvalues near it. */
PetscErrorCode ShiftInvertCountBelow(const PencilMatrices *pencil, PetscReal away, ShiftInvert *si, PetscReal *omega,
                                     PetscInt *n)
{
  PetscInt n_null = 1;

  PetscFunctionBeginUser;
  *n = 0;
  if (*omega <= 0) PetscFunctionReturn(0);
  for (int attempt = 0; attempt < MOVES && n_null; attempt++) {
    *omega *= 1 + attempt * away;
    PetscCall(CountPivots(pencil, *omega * *omega, si, n, &n_null));
  }
  PetscCall(ShiftInvertRegular(si->comm, n_null ? PETSC_FALSE : PETSC_TRUE, *omega * *omega));
  PetscFunctionReturn(0);
}

/* A row of M whose entries are all zero; singularity that hides in full rows is what pencil->singular knows of. */
PetscErrorCode MassIsSingular(const PencilMatrices *pencil, PetscBool *singular)
{
  PetscReal least;
  Vec       largest;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(pencil->M, NULL, &largest));
  PetscCall(MatGetRowMaxAbs(pencil->M, largest, NULL));
  PetscCall(VecMin(largest, NULL, &least));
  PetscCall(VecDestroy(&largest));
  *singular = pencil->singular || !(least > 0) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode ShiftInvertCountMassless(const PencilMatrices *pencil, PetscReal most, ShiftInvert *si, PetscInt *n)
{
  PetscInt n_null = 1;

  PetscFunctionBeginUser;
  *n = 0;
  for (int attempt = 0; attempt < MOVES && n_null; attempt++) {
    most *= 1 + attempt * MASSLESS_AWAY;
    PetscCall(CountPivots(pencil, -most * most, si, n, &n_null));
  }
  PetscCall(ShiftInvertRegular(si->comm, n_null ? PETSC_FALSE : PETSC_TRUE, -most * most));
  PetscFunctionReturn(0);
}
