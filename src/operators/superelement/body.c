/*
   A superelement as a body with a name: what others ask of it that ask the same of parts. Its number follows those of
   the parts. Its mass is m B' M_s B, as far as it is there; its force on the mesh is the sum of -k B' K_s B u over the
   nodes, held ones too, which in equilibrium is what its own supports carry.
*/
#include "superelement.h"

PetscInt OperatorsCountSuperelements(Operators o)
{
  return o->n_superelements;
}

PetscErrorCode OperatorsCountParts(Operators o, PetscInt *n)
{
  const Mesh *mesh;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetMesh(o, &mesh));
  *n = (mesh ? mesh->n_parts : 0) + o->n_superelements;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetPartName(Operators o, PetscInt part, const char **name)
{
  const Mesh *mesh;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetMesh(o, &mesh));
  *name = part < mesh->n_parts ? mesh->part[part] : o->superelements[part - mesh->n_parts].name;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsMultiplySuperelementMass(Operators o, const PetscReal p[], PetscInt k, Vec u, Vec f)
{
  Superelement *piece = NULL;
  Vec           part;

  PetscFunctionBeginUser;
  PetscCall(VecSet(f, 0));
  PetscCall(VecDuplicate(f, &part));
  while (SuperelementNext(o, &o->superelements[k], &piece)) {
    if (!piece->mass) continue;
    PetscCall(MatMult(piece->mass, u, part));
    PetscCall(VecAXPY(f, OperatorsPoint(o, p)[piece->index[SUPERELEMENT_M]], part));
  }
  PetscCall(VecDestroy(&part));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsMarkSuperelement(Operators o, PetscInt k, PetscBool apart, Vec u)
{
  const Superelement *s = &o->superelements[k];
  const Mesh         *mesh;
  PetscScalar        *mark;
  PetscInt            first, last;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(o->model, &mesh));
  PetscCall(VecSet(u, 0));
  PetscCall(VecGetOwnershipRange(u, &first, &last));
  PetscCall(VecGetArray(u, &mark));
  for (PetscInt i = 0; i < s->n_shares && !apart; i++) {
    const PetscInt at = mesh->unknown[s->share[i].at];

    if (at >= first && at < last) mark[at - first] = 1;
  }
  for (PetscInt at = PetscMax(first, s->first_apart); at < PetscMin(last, s->first_apart + s->n_apart); at++)
    mark[at - first] = 1;
  PetscCall(VecRestoreArray(u, &mark));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetSuperelementForce(Operators o, const PetscReal p[], PetscInt k, Vec u,
                                             const PetscReal displacement[], PetscReal force[3])
{
  Superelement *piece = NULL;
  const Mesh   *mesh;
  PetscReal    *f;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(o->model, &mesh));
  PetscCall(PetscCalloc1(3 * mesh->n_nodes, &f));
  while (SuperelementNext(o, &o->superelements[k], &piece))
    PetscCall(SuperelementAddForce(o, OperatorsPoint(o, p), piece, u, displacement, f));
  for (int d = 0; d < 3; d++) force[d] = 0;
  for (PetscInt i = 0; i < 3 * mesh->n_nodes; i++) force[i % 3] -= f[i];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, force, 3, MPIU_REAL, MPI_SUM, o->comm));
  PetscCall(PetscFree(f));
  PetscFunctionReturn(0);
}
