/*
   The time that a solution may take. Rank 0's clock decides for all ranks, so that all stop at the same restart, or,
   where none comes in time, after the same solve. A factorisation is not interrupted.
*/
#include "modes/modesimpl.h"
#include <petsctime.h>

#define LIMIT_PATIENCE 1.1 /* of the limit: as long a restart is waited for, which tells the frequency reached */

PetscErrorCode LimitBegin(Modes modes)
{
  PetscFunctionBeginUser;
  PetscCall(PetscTime(&modes->begun));
  modes->over = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Whether `times` the limit is over */
static PetscErrorCode LimitLook(Modes modes, PetscReal times)
{
  PetscLogDouble now;

  PetscFunctionBeginUser;
  if (modes->max_time <= 0) PetscFunctionReturn(0);
  PetscCall(PetscTime(&now));
  modes->over = now - modes->begun > times * modes->max_time ? PETSC_TRUE : PETSC_FALSE;
  PetscCallMPI(MPI_Bcast(&modes->over, 1, MPIU_BOOL, 0, modes->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode LimitCheckLeft(Modes modes)
{
  PetscFunctionBeginUser;
  PetscCheck(!modes->over, modes->comm, PETSC_ERR_NOT_CONVERGED,
             "-modes_max_time %.6g s is over with %" PetscInt_FMT " of about %" PetscInt_FMT
             " eigenvalues converged; narrow -modes_band, use more ranks, or raise -modes_max_time",
             (double)modes->max_time, modes->found, modes->wanted);
  PetscFunctionReturn(0);
}

static PetscErrorCode LimitAfterSolve(void *ctx)
{
  Modes modes = ctx;

  PetscFunctionBeginUser;
  PetscCall(LimitLook(modes, LIMIT_PATIENCE));
  PetscCall(LimitCheckLeft(modes));
  PetscFunctionReturn(0);
}

PetscErrorCode LimitAttach(Modes modes, PetscInt nev, ShiftInvert *si)
{
  PetscFunctionBeginUser;
  modes->found  = 0;
  modes->wanted = nev;
  si->after     = LimitAfterSolve;
  si->after_ctx = modes;
  PetscFunctionReturn(0);
}

PetscErrorCode LimitAsk(Modes modes, PetscInt n, PetscInt nev)
{
  Progress *progress = &modes->progress;

  PetscFunctionBeginUser;
  if (n > 0) progress->expected = PetscMax(progress->done + 1, progress->done * nev / n);
  modes->found = n;
  PetscCall(LimitLook(modes, 1));
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
