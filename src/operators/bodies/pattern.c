/*
   Preallocation: couplings of the unknowns of two nodes of a common cell of one part; in a mass matrix those of the
   same direction alone, a third, or where it is lumped the diagonal. Each rank counts, for every
   node that it has, the distinct neighbours through its own cells, apart by whether the neighbour's unknowns live
   with the row's owner; the counts are summed over the ranks that share the node. Neighbours that two ranks see count
   twice: an upper bound, exact in the interior, at a fifth of the time of DMCreateMatrix(), which walks the closure of
   edges and faces too.
*/
#include "operators/operatorsimpl.h"

/* Cells of a part around each local node as lists: those of node v are cell[first[v]] .. cell[first[v + 1] - 1].
   Counts are first put two places on, so that filling the lists leaves first[] where it is read. */
typedef struct {
  PetscInt *first, *cell;
} PatternStar;

/* first [nodes + 2], cell [nodes of all cells]: counting sort by node, of the cells of one part. */
static PetscErrorCode PatternCreateStar(const Mesh *mesh, PetscInt part, PatternStar *s)
{
  const PetscInt n = mesh->cell_first[mesh->n_cells];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(mesh->n_nodes + 2, &s->first, n, &s->cell));
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    for (PetscInt i = mesh->cell_first[c]; i < mesh->cell_first[c + 1] && mesh->cell_part[c] == part; i++)
      s->first[mesh->cell_node[i] + 2]++;
  for (PetscInt v = 0; v < mesh->n_nodes; v++) s->first[v + 2] += s->first[v + 1];
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    for (PetscInt i = mesh->cell_first[c]; i < mesh->cell_first[c + 1] && mesh->cell_part[c] == part; i++)
      s->cell[s->first[mesh->cell_node[i] + 1]++] = c;
  PetscFunctionReturn(0);
}

/* Owner of each local node, by the first of its unknowns; -1 when all are fixed */
static PetscErrorCode PatternFindOwners(MPI_Comm comm, const Mesh *mesh, PetscMPIInt owner[])
{
  PetscLayout layout;

  PetscFunctionBeginUser;
  PetscCall(PetscLayoutCreateFromSizes(comm, mesh->n_own, PETSC_DETERMINE, 1, &layout));
  for (PetscInt v = 0; v < mesh->n_nodes; v++) {
    PetscInt d = 0;

    while (d < 3 && mesh->unknown[3 * v + d] < 0) d++;
    owner[v] = -1;
    if (d < 3) PetscCall(PetscLayoutFindOwner(layout, mesh->unknown[3 * v + d], &owner[v]));
  }
  PetscCall(PetscLayoutDestroy(&layout));
  PetscFunctionReturn(0);
}

/* seen[w] = v marks that w was counted for v: no list to sort, one pass over the star. Nodes without unknowns count
   for nothing. */
static PetscErrorCode PatternCountNeighbours(const Mesh *mesh, const PatternStar *s, const PetscMPIInt owner[],
                                             PetscScalar count[])
{
  PetscInt *seen;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_nodes, &seen));
  for (PetscInt v = 0; v < mesh->n_nodes; v++) seen[v] = -1;
  for (PetscInt v = 0; v < mesh->n_nodes; v++)
    for (PetscInt k = s->first[v]; k < s->first[v + 1]; k++)
      for (PetscInt i = mesh->cell_first[s->cell[k]]; i < mesh->cell_first[s->cell[k] + 1]; i++) {
        const PetscInt w = mesh->cell_node[i];

        if (seen[w] == v || owner[w] < 0) continue;
        seen[w] = v;
        count[3 * v + (owner[w] != owner[v])] += 1;
      }
  PetscCall(PetscFree(seen));
  PetscFunctionReturn(0);
}

/* Neighbours of each owned row's node inside and outside the diagonal block */
static PetscErrorCode PatternCountRows(MPI_Comm comm, Model model, PetscInt part, PetscInt inside[], PetscInt outside[])
{
  const Mesh  *mesh;
  PetscMPIInt *owner;
  PetscScalar *count;
  Vec          counts;
  PatternStar  star;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(PatternCreateStar(mesh, part, &star));
  PetscCall(PetscMalloc1(mesh->n_nodes, &owner));
  PetscCall(PatternFindOwners(comm, mesh, owner));
  PetscCall(ModelCreateNodal(model, &counts));
  PetscCall(VecGetArray(counts, &count));
  PetscCall(PatternCountNeighbours(mesh, &star, owner, count));
  PetscCall(VecRestoreArray(counts, &count));
  PetscCall(ModelSumShared(model, counts));
  PetscCall(VecGetArray(counts, &count));
  for (PetscInt i = 0; i < 3 * mesh->n_nodes; i++) {
    const PetscInt row = mesh->unknown[i] - mesh->first_own, v = i / 3;

    if (mesh->unknown[i] < mesh->first_own || row >= mesh->n_own) continue;
    inside[row]  = (PetscInt)count[3 * v];
    outside[row] = (PetscInt)count[3 * v + 1];
  }
  PetscCall(VecRestoreArray(counts, &count));
  PetscCall(VecDestroy(&counts));
  PetscCall(PetscFree2(star.first, star.cell));
  PetscCall(PetscFree(owner));
  PetscFunctionReturn(0);
}

/* Empty matrix for `directions` entries per neighbour */
static PetscErrorCode PatternAllocate(Model model, const PetscInt inside[], const PetscInt outside[],
                                      PetscInt directions, Mat *A)
{
  const Mesh *mesh;
  PetscInt    n_own, n_all, *own, *other;
  MPI_Comm    comm;

  PetscFunctionBeginUser;
  PetscCall(ModelGetComm(model, &comm));
  PetscCall(ModelGetMesh(model, &mesh));
  n_own = mesh->n_own;
  n_all = mesh->n_unknowns;
  PetscCall(PetscMalloc2(n_own, &own, n_own, &other));
  for (PetscInt i = 0; i < n_own; i++) {
    /* shared neighbours count once for each rank that sees them: never more than there are columns */
    own[i]   = PetscMin(n_own, directions * inside[i]);
    other[i] = PetscMin(n_all - n_own, directions * outside[i]);
  }
  PetscCall(MatCreateAIJ(comm, n_own, n_own, n_all, n_all, 0, own, 0, other, A));
  PetscCall(PetscFree2(own, other));
  PetscFunctionReturn(0);
}

/* M NULL: not wanted. MAT_IGNORE_ZERO_ENTRIES keeps the zeros of a mass between different directions out of its
   pattern. */
PetscErrorCode PatternCreate(Model model, PetscInt part, PetscBool lumped, Mat *K, Mat *M)
{
  const Mesh *mesh;
  PetscInt   *inside, *outside;
  MPI_Comm    comm;

  PetscFunctionBeginUser;
  PetscCall(ModelGetComm(model, &comm));
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(PetscCalloc2(mesh->n_own, &inside, mesh->n_own, &outside));
  PetscCall(PatternCountRows(comm, model, part, inside, outside));
  PetscCall(PatternAllocate(model, inside, outside, 3, K));
  for (PetscInt i = 0; i < mesh->n_own && lumped; i++) {
    inside[i]  = 1;
    outside[i] = 0;
  }
  if (M) PetscCall(PatternAllocate(model, inside, outside, 1, M));
  if (M) PetscCall(MatSetOption(*M, MAT_IGNORE_ZERO_ENTRIES, PETSC_TRUE));
  PetscCall(PetscFree2(inside, outside));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsViewOmitted(Operators o, PetscViewer viewer)
{
  const ModelScene *scene;
  const Mesh       *mesh;
  PetscInt         *inside, *outside;
  PetscReal         neighbours = 0;

  PetscFunctionBeginUser;
  if (!o->omit) PetscFunctionReturn(0);
  PetscCall(ModelGetScene(o->model, &scene));
  PetscCall(ModelGetMesh(o->model, &mesh));
  for (PetscInt part = 0; part < scene->n_parts; part++) {
    PetscCall(PetscCalloc2(mesh->n_own, &inside, mesh->n_own, &outside));
    PetscCall(PatternCountRows(o->comm, o->model, part, inside, outside));
    for (PetscInt i = 0; i < mesh->n_own; i++) neighbours += (PetscReal)(inside[i] + outside[i]);
    PetscCall(PetscFree2(inside, outside));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &neighbours, 1, MPIU_REAL, MPI_SUM, o->comm));
  PetscCall(PetscViewerASCIIPrintf(
    viewer, "saved: no matrices, since no kernel reads K and M: the time to assemble them and about %.3g MB\n",
    4e-6 * (double)neighbours * (sizeof(PetscScalar) + sizeof(PetscInt)))); /* three directions in K, one in M */
  PetscFunctionReturn(0);
}
