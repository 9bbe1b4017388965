/*
   Pressure of a surface from forces f_i (N) of its nodes that press on it. On faces of first order it is lumped, p_i =
   f_i / A_i with the node's share of the area. Forces that balance a uniform pressure on faces of second order are zero
   or pull at corners, so that there p = sum_j N_j p_j has the nodal forces that were found,

      sum_j M_ij p_j = f_i,   M_ij = int N_i N_j dA,

   which makes a uniform pressure uniform. Where contact ends p over- and undershoots, as any such projection of a jump:
   nodes without force may have some. A set with faces of both orders has int N_i dA on the diagonal for those of first.
*/
#include "statics/staticsimpl.h"
#include "kernels/contact/facet.h"
#include "solver/factor/masssolve.h"

/* Entries of M, rows and columns being global numbers of nodes */
typedef struct {
  PetscInt     n, *row, *column;
  PetscScalar *value;
} MassEntries;

static void MassAdd(MassEntries *e, PetscInt row, PetscInt column, PetscReal value)
{
  e->row[e->n]     = row;
  e->column[e->n]  = column;
  e->value[e->n++] = value;
}

static void MassAddFace(MassEntries *e, int n, const PetscInt number[], const PetscReal x[][3])
{
  const PetscBool second = FacetShapeOf(n)->n_corners < n ? PETSC_TRUE : PETSC_FALSE;
  double          mass[FACET_NODES * FACET_NODES], share[FACET_NODES];

  FacetMass(n, x, mass);
  FacetAreas(n, x, share);
  for (int k = 0; k < n * n; k++)
    if (second || k % (n + 1) == 0) MassAdd(e, number[k / n], number[k % n], second ? mass[k] : share[k / n]);
}

/* Faces around each node, in the places of a vector of the nodes: 0 tells nodes that are not on the surface, on any
   rank */
static PetscErrorCode FacesCount(const Mesh *mesh, const ModelFaces *faces, Vec count)
{
  PetscFunctionBeginUser;
  PetscCall(VecSet(count, 0));
  for (PetscInt i = 0; i < faces->first[faces->n]; i++)
    PetscCall(VecSetValue(count, mesh->number[faces->node[i]], 1, ADD_VALUES));
  PetscCall(VecAssemblyBegin(count));
  PetscCall(VecAssemblyEnd(count));
  PetscFunctionReturn(0);
}

/* M of a surface, 1 on the diagonal of all other nodes */
static PetscErrorCode MassCreate(const Mesh *mesh, const ModelFaces *faces, Vec count, Mat *M)
{
  const PetscScalar *c;
  PetscInt           n, first, room;
  MassEntries        e = {.n = 0};

  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(count, &n));
  PetscCall(VecGetOwnershipRange(count, &first, NULL));
  room = FACET_NODES * FACET_NODES * faces->n + n;
  PetscCall(PetscMalloc3(room, &e.row, room, &e.column, room, &e.value));
  for (PetscInt f = 0; f < faces->n; f++) {
    const PetscInt *node;
    PetscInt        number[FACET_NODES];
    PetscReal       x[FACET_NODES][3];
    const int       m = (int)ModelFacesGet(faces, mesh, f, &node, x);

    for (int i = 0; i < m; i++) number[i] = mesh->number[node[i]];
    MassAddFace(&e, m, number, (const PetscReal(*)[3])x);
  }
  PetscCall(VecGetArrayRead(count, &c));
  for (PetscInt i = 0; i < n; i++)
    if (PetscRealPart(c[i]) == 0) MassAdd(&e, first + i, first + i, 1);
  PetscCall(VecRestoreArrayRead(count, &c));
  PetscCall(MatCreate(PetscObjectComm((PetscObject)count), M));
  PetscCall(MatSetSizes(*M, n, n, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetType(*M, MATAIJ));
  PetscCall(MatSetPreallocationCOO(*M, e.n, e.row, e.column));
  PetscCall(MatSetValuesCOO(*M, e.value, ADD_VALUES));
  PetscCall(PetscFree3(e.row, e.column, e.value));
  PetscFunctionReturn(0);
}

/* Whether any face of a surface, on any rank, is of second order. Collective */
static PetscErrorCode FacesHaveSecond(MPI_Comm comm, const ModelFaces *faces, PetscBool *have)
{
  PetscFunctionBeginUser;
  *have = PETSC_FALSE;
  for (PetscInt f = 0; f < faces->n; f++)
    if (faces->first[f + 1] - faces->first[f] > 4) *have = PETSC_TRUE;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, have, 1, MPIU_BOOL, MPI_LOR, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode PressureCreateForces(Model model, Vec *forces)
{
  const Mesh *mesh;
  MPI_Comm    comm;
  PetscInt    n = 0;

  PetscFunctionBeginUser;
  PetscCall(ModelGetComm(model, &comm));
  PetscCall(ModelGetMesh(model, &mesh));
  for (PetscInt v = 0; v < mesh->n_nodes; v++) n += mesh->owned[v];
  PetscCall(VecCreateMPI(comm, n, PETSC_DETERMINE, forces));
  PetscFunctionReturn(0);
}

PetscErrorCode PressureRecover(Model model, const char set[], Vec forces, PetscBool *recovered)
{
  const Mesh *mesh;
  ModelFaces  faces;
  Vec         count, pressure;
  Mat         M;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(ModelGetSetFaces(model, set, &faces));
  PetscCall(FacesHaveSecond(PetscObjectComm((PetscObject)forces), &faces, recovered));
  if (*recovered) {
    PetscCall(VecDuplicate(forces, &count));
    PetscCall(VecDuplicate(forces, &pressure));
    PetscCall(FacesCount(mesh, &faces, count));
    PetscCall(MassCreate(mesh, &faces, count, &M));
    PetscCall(MassSolve(M, forces, pressure, "the pressure of a surface"));
    PetscCall(VecCopy(pressure, forces));
    PetscCall(MatDestroy(&M));
    PetscCall(VecDestroy(&count));
    PetscCall(VecDestroy(&pressure));
  }
  PetscCall(ModelFacesDestroy(&faces));
  PetscFunctionReturn(0);
}
