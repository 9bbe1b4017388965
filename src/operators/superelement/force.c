/*
   Forces of superelements, f = k B' K_s B u, with what nodes do, held ones too, and the unknowns apart.
*/
#include "superelement.h"

/* q = B u [n], on all ranks: shares of the nodes of this rank, and the unknowns apart of the last one */
static PetscErrorCode SuperelementMotion(Operators o, const Superelement *s, Vec u, const PetscReal displacement[],
                                         PetscReal q[])
{
  const PetscScalar *value;
  PetscInt           first, last;
  PetscMPIInt        n;

  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(s->n, &n));
  PetscCall(PetscArrayzero(q, s->n));
  for (PetscInt k = 0; k < s->n_shares; k++) q[s->share[k].row] += s->share[k].weight * displacement[s->share[k].at];
  PetscCall(VecGetOwnershipRange(u, &first, &last));
  PetscCall(VecGetArrayRead(u, &value));
  for (PetscInt k = 0, apart = s->first_apart; k < s->n; k++) {
    if (s->row[k].direction != SUPERELEMENT_APART) continue;
    if (apart >= first && apart < last) q[k] = PetscRealPart(value[apart - first]);
    apart++;
  }
  PetscCall(VecRestoreArrayRead(u, &value));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, q, n, MPIU_REAL, MPI_SUM, o->comm));
  PetscFunctionReturn(0);
}

/* q = A q [n] on all ranks */
static PetscErrorCode SuperelementMultiply(Operators o, Mat A, PetscInt n, PetscReal q[])
{
  PetscScalar *value;
  PetscInt     first, last;
  Vec          x, y;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(A, &x, &y));
  PetscCall(VecGetOwnershipRange(x, &first, &last));
  PetscCall(VecGetArrayWrite(x, &value));
  for (PetscInt k = first; k < last; k++) value[k - first] = q[k];
  PetscCall(VecRestoreArrayWrite(x, &value));
  PetscCall(MatMult(A, x, y));
  PetscCall(PetscArrayzero(q, n));
  PetscCall(VecGetArray(y, &value));
  for (PetscInt k = first; k < last; k++) q[k] = PetscRealPart(value[k - first]);
  PetscCall(VecRestoreArray(y, &value));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, q, (PetscMPIInt)n, MPIU_REAL, MPI_SUM, o->comm));
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&y));
  PetscFunctionReturn(0);
}

PetscErrorCode SuperelementAddForce(Operators o, const PetscReal p[], const Superelement *s, Vec u,
                                    const PetscReal displacement[], PetscReal force[])
{
  PetscReal *q;

  PetscFunctionBeginUser;
  if (!s->A[SUPERELEMENT_K]) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(s->n, &q));
  PetscCall(SuperelementMotion(o, s, u, displacement, q));
  PetscCall(SuperelementMultiply(o, s->A[SUPERELEMENT_K], s->n, q));
  for (PetscInt k = 0; k < s->n_shares; k++)
    force[s->share[k].at] += p[s->index[SUPERELEMENT_K]] * s->share[k].weight * q[s->share[k].row];
  PetscCall(PetscFree(q));
  PetscFunctionReturn(0);
}

PetscErrorCode SuperelementsAddForces(Operators o, const PetscReal p[], Vec u, const PetscReal displacement[],
                                      PetscReal force[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < o->n_superelements + o->n_pieces; i++)
    PetscCall(SuperelementAddForce(o, p, &o->superelements[i], u, displacement, force));
  PetscFunctionReturn(0);
}

PetscErrorCode SuperelementsAddForcesApart(Operators o, const PetscReal p[], Vec u, Vec f)
{
  const Mesh        *mesh;
  const PetscScalar *from;
  PetscScalar       *to;
  Vec                part;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(o->model, &mesh));
  if (!mesh->n_apart) PetscFunctionReturn(0);
  PetscCall(VecDuplicate(f, &part));
  for (PetscInt t = 0; t < o->terms.n; t++) {
    const OperatorsTerm *term = &o->terms.term[t];

    if (term->kind != OPERATORS_STIFFNESS || term->n != 1 || !OperatorsIsOfSuperelement(o, term->factor[0].parameter))
      continue;
    PetscCall(MatMult(term->A, u, part));
    PetscCall(VecGetArrayRead(part, &from));
    PetscCall(VecGetArray(f, &to));
    for (PetscInt k = mesh->n_own - MeshCountApart(mesh); k < mesh->n_own; k++)
      to[k] += OperatorsTermCoefficient(term, p) * from[k];
    PetscCall(VecRestoreArray(f, &to));
    PetscCall(VecRestoreArrayRead(part, &from));
  }
  PetscCall(VecDestroy(&part));
  PetscFunctionReturn(0);
}
