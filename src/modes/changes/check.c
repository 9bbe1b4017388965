/*
   Whether what is given of a change makes sense: one place, a layer over many nodes or a parameter, and what fits it.
*/
#include "changes.h"

/* Where it acts: one of the five. Alike on all ranks */
static PetscErrorCode CheckPlace(MPI_Comm comm, const struct _p_ModesChange *change)
{
  const struct {
    PetscBool   given;
    const char *option;
  } place[]         = {{change->has_at, "at"},
                       {change->unknown[0] ? PETSC_TRUE : PETSC_FALSE, "unknown"},
                       {change->set[0] ? PETSC_TRUE : PETSC_FALSE, "set"},
                       {change->has_ring, "ring"},
                       {change->parameter[0] ? PETSC_TRUE : PETSC_FALSE, "parameter"}};
  const char *first = NULL;

  PetscFunctionBeginUser;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(place); k++) {
    if (!place[k].given) continue;
    PetscCheck(!first, comm, PETSC_ERR_USER_INPUT, "-%s_%s and -%s_%s are both given: a change has one of them",
               change->name, first, change->name, place[k].option);
    first = place[k].option;
  }
  PetscCheck(
    first, comm, PETSC_ERR_USER_INPUT,
    "-%s_at x,y,z (m) must be given, or -%s_set, -%s_ring, -%s_parameter, or -%s_unknown of matrices without a "
    "mesh",
    change->name, change->name, change->name, change->name, change->name);
  PetscFunctionReturn(0);
}

/* A percent, and nothing else */
static PetscErrorCode CheckParameter(MPI_Comm comm, const struct _p_ModesChange *change)
{
  const PetscBool more = change->mass > 0 || change->stiffness > 0 || change->viscosity > 0 || change->has_direction ||
                             change->has_to || change->to_unknown[0] || change->part[0] || change->to_part[0]
                           ? PETSC_TRUE
                           : PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCheck(change->has_percent && change->percent != 0, comm, PETSC_ERR_USER_INPUT,
             "-%s_percent must be given, not 0: by how much -%s_parameter %s changes", change->name, change->name,
             change->parameter);
  PetscCheck(!more, comm, PETSC_ERR_USER_INPUT,
             "-%s_parameter %s changes by -%s_percent alone: leave out -%s_mass, -%s_direction and their like, or make "
             "them a change of their own, -with it",
             change->name, change->parameter, change->name, change->name, change->name);
  PetscFunctionReturn(0);
}

/* A layer over a set or ring: it adds to each node its share, and has no other end */
static PetscErrorCode CheckLayer(MPI_Comm comm, const struct _p_ModesChange *change, PetscBool spring)
{
  const char *where = change->has_ring ? "ring" : "set";

  PetscFunctionBeginUser;
  PetscCheck(!change->has_to && !change->to_unknown[0] && !change->part[0] && !change->to_part[0], comm,
             PETSC_ERR_USER_INPUT,
             "-%s_%s: -%s_part, -%s_to and their like are of a change -%s_at a node: leave them out", change->name,
             where, change->name, change->name, change->name);
  PetscCheck(!(change->mass > 0 && spring), comm, PETSC_ERR_USER_INPUT,
             "-%s_mass on -%s_%s does not hang on springs, as it does at a node: give each a change of its own, one "
             "-with the other",
             change->name, change->name, where);
  PetscCheck(!change->has_ring || (change->ring[0] >= 0 && change->ring[1] > change->ring[0]), comm,
             PETSC_ERR_USER_INPUT, "-%s_ring %g,%g (m) must be two radii, 0 or more, the larger one last", change->name,
             (double)change->ring[0], (double)change->ring[1]);
  PetscFunctionReturn(0);
}

PetscErrorCode ChangeCheck(MPI_Comm comm, void *owner, void *record)
{
  const ModesChange change = record;
  const PetscBool   spring = change->stiffness > 0 || change->viscosity > 0 ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool   to     = change->has_to || change->to_unknown[0] ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  (void)owner;
  PetscCall(CheckPlace(comm, change));
  if (change->parameter[0]) {
    PetscCall(CheckParameter(comm, change));
    PetscFunctionReturn(0);
  }
  PetscCheck(!change->has_percent, comm, PETSC_ERR_USER_INPUT, "-%s_percent is of a -%s_parameter, which is not given",
             change->name, change->name);
  PetscCheck(change->mass > 0 || spring, comm, PETSC_ERR_USER_INPUT,
             "change %s changes nothing: give -%s_mass, -%s_stiffness or -%s_viscosity, a positive number",
             change->name, change->name, change->name, change->name);
  if (change->set[0] || change->has_ring) PetscCall(CheckLayer(comm, change, spring));
  PetscCheck(!(change->mass > 0 && to), comm, PETSC_ERR_USER_INPUT,
             "-%s_to is the other end of a spring or dashpot: leave out -%s_mass", change->name, change->name);
  PetscCheck(spring || !change->has_direction, comm, PETSC_ERR_USER_INPUT,
             "-%s_direction is of a spring or dashpot: %s acts along all", change->name,
             change->set[0] || change->has_ring ? "a mass" : "a point mass");
  PetscFunctionReturn(0);
}
