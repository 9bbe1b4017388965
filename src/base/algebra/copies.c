/* An end of iterations that is the same on all ranks (copies.h) */
#include "copies.h"

typedef struct {
  MPI_Comm comm;
  void    *common; /* of KSPConvergedDefault() */
} Copies;

static PetscErrorCode CopiesEnd(KSP ksp, PetscInt it, PetscReal left, KSPConvergedReason *reason, void *ctx)
{
  const Copies *copies = ctx;
  int           said;

  PetscFunctionBeginUser;
  PetscCall(KSPConvergedDefault(ksp, it, left, reason, copies->common));
  said = (int)*reason;
  PetscCallMPI(MPI_Bcast(&said, 1, MPI_INT, 0, copies->comm));
  *reason = (KSPConvergedReason)said;
  PetscFunctionReturn(0);
}

static PetscErrorCode CopiesDestroy(void *ctx)
{
  PetscFunctionBeginUser;
  PetscCall(KSPConvergedDefaultDestroy(((Copies *)ctx)->common));
  PetscCall(PetscFree(ctx));
  PetscFunctionReturn(0);
}

PetscErrorCode CopiesEndTogether(MPI_Comm comm, KSP ksp)
{
  Copies *copies;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&copies));
  copies->comm = comm;
  PetscCall(KSPConvergedDefaultCreate(&copies->common));
  PetscCall(KSPSetConvergenceTest(ksp, CopiesEnd, copies, CopiesDestroy));
  PetscFunctionReturn(0);
}
