/* Memory of the reduced models over a parameter, before they are made */
#include "cycleimpl.h"
#include "base/process/memory.h"

/* Of a model, MB */
static double FamilyMegabytes(const CycleFamily *f)
{
  double mb = 0;

  for (int k = 0; k < FAMILY_N_PARTS; k++) mb += 1e-6 * (double)sizeof(PetscReal) * (double)f->size[k];
  return mb;
}

/* Every rank has all models: sums are of the ranks on one machine, and the worst machine counts. Collective. */
PetscErrorCode CycleFamilyCheckMemory(const CycleFamily *f, PetscInt most)
{
  const MPI_Comm comm = f->scene->comm;
  const double   one  = FamilyMegabytes(f);
  double         mb[2]; /* of all on one machine, less what is to be had */
  char           beside[64] = "";
  PetscBool      given;

  PetscFunctionBeginUser;
  mb[0] = one * (double)most * MemoryRanks();
  mb[1] = -MemoryRoom(&given);
  if (given && f->beside) { /* of what is free they are gone already */
    mb[0] += FamilyMegabytes(f->beside) * (double)f->beside->n * MemoryRanks();
    PetscCall(PetscSNPrintf(beside, sizeof(beside), " and the %" PetscInt_FMT " with the lower cut-off", f->beside->n));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, mb, 2, MPI_DOUBLE, MPI_MAX, comm));
  if (ShiftInvertShows())
    PetscCall(PetscPrintf(comm,
                          "models over %s: up to %" PetscInt_FMT
                          " of %.3g MB on each rank, %.3g MB on one machine, %.0f MB to be had\n",
                          f->parameter->name, most, one, mb[0], -mb[1]));
  PetscCheck(
    mb[0] <= -mb[1], comm, PETSC_ERR_USER_INPUT,
    "-cycle_parameter %s: up to %" PetscInt_FMT
    " reduced models%s need %.3g MB on one machine, and %s %.6g MB: take a lower -dynamics_cutoff, fewer ranks on a "
    "machine, or a parameter that leaves the bodies as they are, such as a friction coefficient%s",
    f->parameter->name, most, beside, mb[0], given ? "-squeal_memory allows" : "there are free", -mb[1],
    given ? "" : "; -squeal_memory MB says otherwise");
  PetscFunctionReturn(0);
}
