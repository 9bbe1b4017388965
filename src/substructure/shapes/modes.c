/* Modes of two symmetric matrices, K x = kappa M x: all below a frequency, proven complete by modes/ */
#include "substructure/substructureimpl.h"

PetscErrorCode MatrixModesSolve(MPI_Comm comm, Mat K, Mat M, PetscReal cutoff, MatrixModes *m)
{
  const PetscReal band[2] = {0, cutoff};
  const Mode     *mode;

  PetscFunctionBeginUser;
  *m = (MatrixModes){.n = 0};
  PetscCall(OperatorsCreate(comm, &m->operators));
  PetscCall(OperatorsSetMatrices(m->operators, K, M));
  PetscCall(OperatorsLinearise(m->operators, NULL, &m->pencil));
  PetscCall(ModesCreate(comm, &m->modes));
  PetscCall(ModesSetPencil(m->modes, m->pencil));
  PetscCall(ModesSetBand(m->modes, band));
  PetscCall(ModesAllowNone(m->modes));
  PetscCall(ModesSolve(m->modes));
  PetscCall(ModesGet(m->modes, &m->n, &mode));
  PetscCall(PetscMalloc1(m->n, &m->kappa));
  for (PetscInt k = 0; k < m->n; k++) {
    m->kappa[k] = mode[k].rigid ? 0 : PetscSqr(mode[k].omega);
    if (mode[k].rigid) m->rigid = PETSC_TRUE;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode MatrixModesDestroy(MatrixModes *m)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(m->kappa));
  PetscCall(ModesDestroy(&m->modes));
  PetscCall(PencilDestroy(&m->pencil));
  PetscCall(OperatorsDestroy(&m->operators));
  PetscFunctionReturn(0);
}
