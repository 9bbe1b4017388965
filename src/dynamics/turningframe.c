/*
   Inertial forces of parts that are described in the turning frame of a contact surface (-contact_kinematics turning):
   Coriolis -2 m Omega x v and centrifugal -m Omega x (Omega x (x + u)), each where it is asked for; N (inertia.c).
*/
#include "dynamicsimpl.h"

/* Part that has most nodes of cells at a surface, over all ranks: the one that the surface belongs to. Parts that
   share its border have a few. */
static PetscErrorCode DynamicsFindPart(Dynamics d, const char set[], PetscInt *part)
{
  const Mesh *mesh;
  PetscInt    n, *count, *vertices;
  PetscBool  *in_set;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(d->model, &mesh));
  PetscCall(PetscCalloc2(mesh->n_parts, &count, mesh->n_nodes, &in_set));
  PetscCall(ModelGetSetNodes(d->model, set, &n, &vertices));
  for (PetscInt i = 0; i < n; i++) in_set[vertices[i]] = PETSC_TRUE;
  PetscCall(PetscFree(vertices));
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    for (PetscInt i = mesh->cell_first[c]; i < mesh->cell_first[c + 1]; i++)
      count[mesh->cell_part[c]] += in_set[mesh->cell_node[i]];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, (PetscMPIInt)mesh->n_parts, MPIU_INT, MPI_SUM, d->comm));
  *part = 0;
  for (PetscInt i = 1; i < mesh->n_parts; i++)
    if (count[i] > count[*part]) *part = i;
  PetscCall(PetscFree2(count, in_set));
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsSetFrames(Dynamics d)
{
  const ModelScene *scene;
  PetscInt          n_turning = 0;

  PetscFunctionBeginUser;
  if (!d->coriolis && !d->centrifugal) PetscFunctionReturn(0);
  PetscCall(ModelGetScene(d->model, &scene));
  for (PetscInt i = 0; i < d->n_interfaces; i++) {
    PetscReal rotation[3];
    PetscInt  part;
    PetscBool turns;

    PetscCall(ContactProjectorGetTurning(d->projector, i, &turns, rotation));
    if (!turns) continue;
    n_turning++;
    PetscCall(DynamicsFindPart(d, d->interfaces[i].master, &part));
    PetscCall(ExternalSetFrame(d->external, scene->parts[part].name, rotation, d->interfaces[i].centre, d->coriolis,
                               d->centrifugal));
  }
  PetscCheck(n_turning, d->comm, PETSC_ERR_USER_INPUT,
             "-dynamics_%s does nothing: no contact has -..._kinematics turning with a -..._rotation",
             d->coriolis ? "coriolis" : "centrifugal");
  PetscFunctionReturn(0);
}
