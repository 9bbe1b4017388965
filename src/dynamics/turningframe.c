/*
   Inertial forces of parts that are described in the turning frame of a contact surface (-contact_kinematics turning):
   Coriolis -2 m Omega x v and centrifugal -m Omega x (Omega x (x + u)), each where it is asked for; N (inertia.c).
*/
#include "dynamicsimpl.h"

/* Part that has most cells at a surface: the one that the surface belongs to */
static PetscErrorCode SurfacePart(Dynamics d, const char set[], PetscInt *part)
{
  const PetscInt *cell_part, *vertices;
  PetscInt        n, cStart, cEnd, *count;
  PetscInt        n_parts;
  const Part     *parts;
  IS              is;
  DM              dm;

  PetscFunctionBeginUser;
  PetscCall(ModelGetDM(d->model, &dm));
  PetscCall(ModelGetParts(d->model, &n_parts, &parts));
  PetscCall(ModelGetCellParts(d->model, &cell_part));
  PetscCall(DMPlexGetHeightStratum(dm, 0, &cStart, &cEnd));
  PetscCall(PetscCalloc1(n_parts, &count));
  PetscCall(ModelGetSetVertices(d->model, set, &is));
  PetscCall(ISGetLocalSize(is, &n));
  PetscCall(ISGetIndices(is, &vertices));
  for (PetscInt i = 0; i < n; i++) {
    PetscInt size, *star = NULL;

    PetscCall(DMPlexGetTransitiveClosure(dm, vertices[i], PETSC_FALSE, &size, &star));
    for (PetscInt k = 0; k < 2 * size; k += 2)
      if (star[k] >= cStart && star[k] < cEnd) count[cell_part[star[k] - cStart]]++;
    PetscCall(DMPlexRestoreTransitiveClosure(dm, vertices[i], PETSC_FALSE, &size, &star));
  }
  PetscCall(ISRestoreIndices(is, &vertices));
  PetscCall(ISDestroy(&is));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, (PetscMPIInt)n_parts, MPIU_INT, MPI_SUM, d->comm));
  *part = 0;
  for (PetscInt i = 1; i < n_parts; i++)
    if (count[i] > count[*part]) *part = i;
  PetscCall(PetscFree(count));
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsSetFrames(Dynamics d)
{
  const ContactInterface *interfaces;
  const Part             *parts;
  PetscInt                n, n_parts, n_turning = 0;

  PetscFunctionBeginUser;
  if (!d->coriolis && !d->centrifugal) PetscFunctionReturn(0);
  PetscCall(ModelGetParts(d->model, &n_parts, &parts));
  if (d->contact) PetscCall(ContactGetInterfaces(d->contact, &n, &interfaces));
  for (PetscInt i = 0; i < d->n_interfaces; i++) {
    PetscReal rotation[3];
    PetscInt  part;
    PetscBool turns;

    PetscCall(ContactProjectorGetTurning(d->projector, i, &turns, rotation));
    if (!turns) continue;
    n_turning++;
    PetscCall(SurfacePart(d, interfaces[i].master, &part));
    PetscCall(
      ExternalSetFrame(d->external, parts[part].name, rotation, interfaces[i].center, d->coriolis, d->centrifugal));
  }
  PetscCheck(n_turning, d->comm, PETSC_ERR_USER_INPUT,
             "-dynamics_%s does nothing: no contact has -..._kinematics turning with a -..._rotation",
             d->coriolis ? "coriolis" : "centrifugal");
  PetscFunctionReturn(0);
}
