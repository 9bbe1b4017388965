/*
   Memory of the dense matrices of the pairs, asked for before anything is computed. With n = 3 pairs, each is n^2
   numbers of 8 bytes on every rank. W of the model and of the stepper, factors and borders of the contact laws, and
   what the stepper is made from are 6 at once; with damping X'D X, what it drags and forces of it are 5 more; X'M X of
   the weighed inertia is another, and so is the compliance with laws in series.
*/
#include "reduced/reducedimpl.h"
#include "base/process/memory.h"

#define MEMORY_COPIES   6
#define MEMORY_DAMPED   5
#define MEMORY_BRANCHES 2

/* GB of a machine that all its ranks want for n pairs */
static double MemoryOfPairs(double n_pairs, int copies)
{
  return 8e-9 * copies * PetscSqr(3 * n_pairs) * MemoryRanks();
}

/* What needs no dense matrices */
static const char *MemoryAdvice(ReducedRun r)
{
  if (!r->request.steps) return "take -analysis transient, which needs none beyond -dynamics_dense";
  return r->request.springs ? "take -dynamics_contact exact, which needs none beyond -dynamics_dense"
                            : "lower -dynamics_dense";
}

/* Machines may have other numbers of ranks, and other memory */
PetscErrorCode ReducedCheckMemory(ReducedRun r)
{
  const ContactPair *pair;
  const ModelScene  *scene;
  PetscInt           n_local, n, n_laws = 0;
  PetscBool          given;
  double             fits[2]; /* GB to be had, and with the other sign those wanted */
  int                copies = MEMORY_COPIES;
  Mat                C;

  PetscFunctionBeginUser;
  PetscCall(ReducedIsSparse(r, &given));
  if (given) PetscFunctionReturn(0); /* factors have a check of their own */
  PetscCall(ContactGetPairs(r->run.contact, &n_local, &n, &pair));
  PetscCall(OperatorsGetBodies(r->run.operators, r->request.p, NULL, NULL, &C));
  PetscCall(ModelGetScene(r->run.model, &scene));
  for (PetscInt i = 0; i < scene->n_parts; i++) n_laws += scene->parts[i].law.kind ? 1 : 0;
  if (C || n_laws) copies += MEMORY_DAMPED;
  if (n_laws) copies += (int)n_laws + MEMORY_BRANCHES;
  if (r->request.weighs) copies++;
  if (r->request.springs) copies++;
  fits[0] = 1e-3 * MemoryRoom(&given);
  fits[1] = -MemoryOfPairs((double)n, copies);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, fits, 2, MPI_DOUBLE, MPI_MIN, r->comm));
  PetscCheck(
    -fits[1] <= fits[0] && 9.1 * n * n < PETSC_MAX_INT, r->comm, PETSC_ERR_USER_INPUT,
    "-dynamics_model reduced: dense matrices of %" PetscInt_FMT
    " pairs take %.3g GB on a machine, and %s %.3g GB, room for some %d pairs: %s, make the surface of fewer nodes "
    "the first of -contact_surfaces, mesh it coarser, or run fewer ranks on a machine",
    n, -fits[1], given ? "-squeal_memory allows" : "there are free", fits[0],
    (int)PetscMin(PetscSqrtReal(PETSC_MAX_INT / 9.1), n * PetscSqrtReal(fits[0] / -fits[1])), MemoryAdvice(r));
  PetscFunctionReturn(0);
}
