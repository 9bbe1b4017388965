/* Memory of the reduced models over a parameter, before they are made */
#include "cycleimpl.h"
#include "base/memory.h"

PetscErrorCode CycleFamilyCheckMemory(const CycleFamily *f, PetscInt most)
{
  const MPI_Comm comm = f->scene->comm;
  double         one  = 0, mb[2]; /* of a model; of all on one machine, less what is to be had */
  PetscBool      given;

  PetscFunctionBeginUser;
  for (int k = 0; k < FAMILY_N_PARTS; k++) one += 1e-6 * (double)sizeof(PetscReal) * (double)f->size[k];
  mb[0] = one * (double)most * MemoryRanks();
  mb[1] = -MemoryRoom(&given);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, mb, 2, MPI_DOUBLE, MPI_MAX, comm));
  if (ShiftInvertShows())
    PetscCall(PetscPrintf(comm,
                          "models over %s: up to %" PetscInt_FMT
                          " of %.3g MB on each rank, %.3g MB on one machine, %.0f MB to be had\n",
                          f->parameter->name, most, one, mb[0], -mb[1]));
  PetscCheck(
    mb[0] <= -mb[1], comm, PETSC_ERR_USER_INPUT,
    "-cycle_parameter %s: up to %" PetscInt_FMT
    " reduced models need %.3g MB on one machine, and %s %.6g MB: take a lower -dynamics_cutoff, fewer ranks on a "
    "machine, or a parameter that leaves the bodies as they are, such as a friction coefficient%s",
    f->parameter->name, most, mb[0], given ? "-squeal_memory allows" : "there are free", -mb[1],
    given ? "" : "; -squeal_memory MB says otherwise");
  PetscFunctionReturn(0);
}
