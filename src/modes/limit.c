/*
   The time that a solution may take. Rank 0's clock decides for all ranks, so that all stop at the same restart.
*/
#include "modesimpl.h"
#include <petsctime.h>

PetscErrorCode LimitBegin(Modes modes)
{
  PetscFunctionBeginUser;
  PetscCall(PetscTime(&modes->begun));
  modes->over = PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode LimitAsk(Modes modes, PetscInt n, PetscInt nev)
{
  Progress      *progress = &modes->progress;
  PetscLogDouble now;

  PetscFunctionBeginUser;
  if (n > 0) progress->expected = PetscMax(progress->done + 1, progress->done * nev / n);
  PetscCall(PetscTime(&now));
  modes->over = modes->max_time > 0 && now - modes->begun > modes->max_time ? PETSC_TRUE : PETSC_FALSE;
  PetscCallMPI(MPI_Bcast(&modes->over, 1, MPIU_BOOL, 0, modes->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode LimitCheck(Modes modes, PetscBool damped, const Spectrum *s)
{
  const char *const advice = damped ? ", -modes_growth or the stiffness damping (-<part>_beta: near -1 / beta 1/s are "
                                      "clusters of overdamped modes, which converge slowly)"
                                    : "";

  PetscFunctionBeginUser;
  PetscCheck(!modes->over, modes->comm, PETSC_ERR_NOT_CONVERGED,
             "-modes_max_time %.6g s is over with %" PetscInt_FMT
             " eigenvalues converged, to %.6g Hz; lower the upper end "
             "of -modes_band%s, use more ranks, or raise -modes_max_time",
             (double)modes->max_time, s->n, s->n ? (double)(s->omega[s->n - 1] / (2 * PETSC_PI)) : 0., advice);
  PetscFunctionReturn(0);
}
