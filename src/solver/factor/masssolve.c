/*
   Solutions M x = b with a mass matrix, of a face or of bodies, by conjugate gradients with its diagonal: by that
   it is as well conditioned as that of one element, whatever the mesh (A. J. Wathen, IMA J. Numer. Anal. 7, 1987).
   The tolerance is of |b|.
*/
#include "masssolve.h"
#include <petscksp.h>

PetscErrorCode MassSolve(Mat M, Vec b, Vec x, const char what[])
{
  KSPConvergedReason reason;
  KSP                ksp;
  PC                 pc;

  PetscFunctionBeginUser;
  PetscCall(KSPCreate(PetscObjectComm((PetscObject)M), &ksp));
  PetscCall(KSPSetOperators(ksp, M, M));
  PetscCall(KSPSetType(ksp, KSPCG));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCJACOBI));
  PetscCall(KSPSetTolerances(ksp, 1e-13, PETSC_DEFAULT, PETSC_DEFAULT, 1000));
  PetscCall(KSPSolve(ksp, b, x));
  PetscCall(KSPGetConvergedReason(ksp, &reason));
  PetscCheck(reason > 0, PetscObjectComm((PetscObject)M), PETSC_ERR_NOT_CONVERGED,
             "%s is not found: conjugate gradients end with %s", what, KSPConvergedReasons[reason]);
  PetscCall(KSPDestroy(&ksp));
  PetscFunctionReturn(0);
}
