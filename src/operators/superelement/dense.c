/*
   All superelements of a scene as one, with dense matrices that every rank has: what an integration in time asks for,
   which has no terms. Blocks of K, M and C stand in the order of the superelements, times their scales.
*/
#include "superelement.h"

/* Shares of all ranks, by global numbers of nodes, in the order of the ranks; rows from `first` on */
static PetscErrorCode SharesGather(Operators o, const Superelement *s, PetscInt first, OperatorsSuperelements *all)
{
  const Mesh                *mesh;
  OperatorsSuperelementNode *mine;
  PetscMPIInt                n_ranks, bytes, *count, *start, total = 0;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(o->model, &mesh));
  PetscCallMPI(MPI_Comm_size(o->comm, &n_ranks));
  PetscCall(PetscCalloc3(s->n_shares, &mine, n_ranks, &count, n_ranks, &start));
  for (PetscInt k = 0; k < s->n_shares; k++) {
    const SuperelementShare *share = &s->share[k];

    mine[k] =
      (OperatorsSuperelementNode){first + share->row, mesh->number[share->at / 3], share->at % 3, share->weight};
  }
  PetscCall(PetscMPIIntCast((PetscInt)((size_t)s->n_shares * sizeof(*mine)), &bytes));
  PetscCallMPI(MPI_Allgather(&bytes, 1, MPI_INT, count, 1, MPI_INT, o->comm));
  for (PetscMPIInt r = 0; r < n_ranks; r++) start[r] = total, total += count[r];
  PetscCall(PetscRealloc((size_t)all->n_nodes * sizeof(*mine) + (size_t)total, &all->node));
  PetscCallMPI(MPI_Allgatherv(mine, bytes, MPI_BYTE, all->node + all->n_nodes, count, start, MPI_BYTE, o->comm));
  all->n_nodes += total / (PetscInt)sizeof(*mine);
  PetscCall(PetscFree3(mine, count, start));
  PetscFunctionReturn(0);
}

/* Adds a times a matrix as the block from `first` on, by columns: the rows of each rank, summed over the ranks */
static PetscErrorCode DenseAdd(Mat A, PetscReal a, PetscInt first, PetscInt n, PetscReal dense[])
{
  PetscInt begin, end;

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(A, &begin, &end));
  for (PetscInt i = begin; i < end; i++) {
    const PetscInt    *j;
    const PetscScalar *value;
    PetscInt           count;

    PetscCall(MatGetRow(A, i, &count, &j, &value));
    for (PetscInt k = 0; k < count; k++) dense[first + i + n * (first + j[k])] += a * PetscRealPart(value[k]);
    PetscCall(MatRestoreRow(A, i, &count, &j, &value));
  }
  PetscFunctionReturn(0);
}

/* Sums a dense matrix over the ranks, some columns at a time */
static PetscErrorCode DenseSum(MPI_Comm comm, PetscInt n, PetscReal dense[])
{
  PetscMPIInt count;

  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(n, &count));
  for (PetscInt j = 0; j < n; j++)
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &dense[n * j], count, MPIU_REAL, MPI_SUM, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetSuperelements(Operators o, const PetscReal p[], OperatorsSuperelements *all)
{
  PetscReal **block[N_SUPERELEMENT] = {&all->K, &all->M, &all->C};
  PetscInt    first                 = 0;

  PetscFunctionBeginUser;
  *all = (OperatorsSuperelements){.n = 0};
  for (PetscInt k = 0; k < o->n_superelements; k++) all->n += o->superelements[k].n;
  if (!all->n) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(all->n, &all->apart));
  for (PetscInt k = 0; k < o->n_superelements; first += o->superelements[k++].n) {
    const Superelement *s = &o->superelements[k];

    for (PetscInt i = 0; i < s->n; i++)
      all->apart[first + i] = s->row[i].direction == SUPERELEMENT_APART ? all->n_apart++ : -1;
    PetscCall(SharesGather(o, s, first, all));
    for (Superelement *piece = NULL; SuperelementNext(o, s, &piece);)
      for (int i = 0; i < N_SUPERELEMENT; i++) {
        if (!piece->A[i]) continue;
        if (!*block[i]) PetscCall(PetscCalloc1(all->n * all->n, block[i]));
        PetscCall(DenseAdd(piece->A[i], OperatorsPoint(o, p)[piece->index[i]], first, all->n, *block[i]));
      }
  }
  for (int i = 0; i < N_SUPERELEMENT; i++)
    if (*block[i]) PetscCall(DenseSum(o->comm, all->n, *block[i]));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsDestroySuperelements(OperatorsSuperelements *all)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(all->apart));
  PetscCall(PetscFree(all->node));
  PetscCall(PetscFree(all->K));
  PetscCall(PetscFree(all->M));
  PetscCall(PetscFree(all->C));
  PetscFunctionReturn(0);
}
