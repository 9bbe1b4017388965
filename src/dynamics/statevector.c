/*
   State vectors (bodies.h) and vectors of all unknowns: the former hold every direction of every local node in the
   bodies' local components, the latter the free directions in Cartesian ones, each once.
*/
#include "dynamicsimpl.h"

/* Unknowns that no node has, which the last rank has in x, on every rank */
static PetscErrorCode StateApartFrom(const Layout *layout, Vec x, PetscReal state[])
{
  const PetscScalar *value;
  PetscInt           n;
  PetscMPIInt        n_ranks, rank;
  MPI_Comm           comm;

  PetscFunctionBeginUser;
  if (!layout->n_apart) PetscFunctionReturn(0);
  PetscCall(PetscObjectGetComm((PetscObject)x, &comm));
  PetscCallMPI(MPI_Comm_size(comm, &n_ranks));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(VecGetLocalSize(x, &n));
  PetscCall(VecGetArrayRead(x, &value));
  if (rank == n_ranks - 1)
    PetscCall(PetscArraycpy(&state[layout->apart], &value[n - layout->n_apart], layout->n_apart));
  PetscCall(VecRestoreArrayRead(x, &value));
  PetscCallMPI(MPI_Bcast(&state[layout->apart], (PetscMPIInt)layout->n_apart, MPIU_REAL, n_ranks - 1, comm));
  PetscFunctionReturn(0);
}

/* state = Q get(x), rows of Q the basis of each node; what get() leaves at held directions is taken along */
static PetscErrorCode StateVectorFrom(Model model, const Layout                                        *layout,
                                      PetscErrorCode (*get)(Model model, Vec x, PetscReal nodal[]), Vec x,
                                      PetscReal state[])
{
  PetscReal *value;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(3 * layout->n_vertices, &value));
  PetscCall(get(model, x, value));
  PetscCall(PetscArrayzero(state, layout->n));
  for (PetscInt i = 0; i < layout->n_vertices; i++)
    if (layout->at[i] >= 0) LayoutSet(layout, i, &value[3 * i], state);
  PetscCall(StateApartFrom(layout, x, state));
  PetscCall(PetscFree(value));
  PetscFunctionReturn(0);
}

PetscErrorCode StateVectorFromDisplacements(Model model, const Layout *layout, Vec u, PetscReal state[])
{
  PetscFunctionBeginUser;
  PetscCall(StateVectorFrom(model, layout, ModelGetDisplaced, u, state));
  PetscFunctionReturn(0);
}

PetscErrorCode StateVectorFromVec(Model model, const Layout *layout, Vec x, PetscReal state[])
{
  PetscFunctionBeginUser;
  PetscCall(StateVectorFrom(model, layout, ModelGetNodal, x, state));
  PetscFunctionReturn(0);
}

PetscErrorCode StateVectorToVec(Model model, const Layout *layout, const PetscReal state[], Vec x)
{
  const Mesh  *mesh;
  PetscInt     begin, end;
  PetscScalar *value;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(VecGetOwnershipRange(x, &begin, &end));
  PetscCall(VecGetArray(x, &value));
  for (PetscInt i = 0; i < layout->n_vertices; i++) {
    PetscReal here[3];

    if (layout->at[i] < 0) continue;
    LayoutGet(layout, i, state, here);
    for (int d = 0; d < 3; d++) {
      const PetscInt row = mesh->unknown[3 * i + d];

      if (row >= begin && row < end) value[row - begin] = here[d];
    }
  }
  for (PetscInt i = 0; i < layout->n_apart && end == mesh->n_unknowns; i++)
    value[end - begin - layout->n_apart + i] = state[layout->apart + i];
  PetscCall(VecRestoreArray(x, &value));
  PetscFunctionReturn(0);
}
