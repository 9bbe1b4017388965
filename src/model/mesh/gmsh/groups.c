/*
   Physical groups of a Gmsh file, and what elements find theirs by: an entity of the geometry, or of a part of a
   partitioned mesh (format 4.1), or the group itself (2.2).
*/
#include "gmsh.h"

PetscInt GmshFindEntity(const GmshMesh *mesh, PetscInt dim, PetscInt tag)
{
  for (PetscInt e = 0; e < mesh->n_entities; e++) {
    if (mesh->entities[e].dim == dim && mesh->entities[e].tag == tag) return e;
  }
  return -1;
}

/* Dimension, tag and name of each group; in format 2.2 the groups are the entities */
PetscErrorCode GmshReadNames(MeshReader *r, GmshMesh *mesh)
{
  char line[512];

  PetscFunctionBeginUser;
  mesh->n_groups = ReadCountLine(r);
  PetscCall(PetscCalloc1(mesh->n_groups, &mesh->groups));
  for (PetscInt g = 0; g < mesh->n_groups && !r->error->code; g++) {
    GmshGroup *group = &mesh->groups[g];
    int        dim, tag, end = 0;

    if (!fgets(line, sizeof(line), r->file) ||
        sscanf(line, "%d %d \"%127[^\"]\" %n", &dim, &tag, group->name, &end) != 3 || !end || line[end]) {
      ReaderErrorSet(r->error, PETSC_ERR_FILE_READ,
                     "line %" PetscInt_FMT " of $PhysicalNames is not: dimension tag \"name\"", g + 2);
      break;
    }
    group->dim = dim;
    group->tag = tag;
    for (PetscInt k = 0; k < g; k++)
      if (mesh->groups[k].dim == dim && mesh->groups[k].tag == tag)
        ReaderErrorSet(r->error, PETSC_ERR_FILE_READ, "$PhysicalNames calls group %d of dimension %d '%s' and '%s'",
                       tag, dim, mesh->groups[k].name, group->name);
  }
  if (r->version == 41) PetscFunctionReturn(0);
  mesh->n_entities = mesh->n_groups;
  PetscCall(PetscCalloc1(mesh->n_entities, &mesh->entities));
  for (PetscInt g = 0; g < mesh->n_groups; g++) {
    mesh->entities[g] = (GmshEntity){mesh->groups[g].dim, mesh->groups[g].tag, 1, {mesh->groups[g].tag}};
  }
  PetscFunctionReturn(0);
}

/* One entity (4.1): its tag; of a partitioned mesh the entity that it is part of, and its partitions; its box (a point
   for dimension 0), physical groups, bounding entities. The tag of a group is negative where the entity stands reversed
   in it, which is no matter here */
static void ReadEntity(MeshReader *r, PetscInt dim, PetscBool partitioned, GmshEntity *entity)
{
  PetscReal box[6];

  entity->dim = dim;
  entity->tag = ReadTag(r, INT_BYTES);
  for (int skip = 0; partitioned && skip < 2; skip++) (void)ReadTag(r, INT_BYTES);
  for (PetscInt n = partitioned ? ReadCount(r, SIZE_BYTES) : 0; n > 0; n--) (void)ReadTag(r, INT_BYTES);
  ReadReals(r, dim ? 6 : 3, box);
  entity->n_physical = ReadCount(r, SIZE_BYTES);
  if (entity->n_physical > GMSH_MAX_PHYSICAL) {
    ReaderErrorSet(r->error, PETSC_ERR_SUP,
                   "entity %" PetscInt_FMT " is in %" PetscInt_FMT " physical groups; at most %d are supported",
                   entity->tag, entity->n_physical, GMSH_MAX_PHYSICAL);
    return;
  }
  for (PetscInt p = 0; p < entity->n_physical; p++) {
    const PetscInt group = ReadTag(r, INT_BYTES);

    entity->physical[p] = PetscAbsInt(group);
  }
  for (PetscInt n = dim ? ReadCount(r, SIZE_BYTES) : 0; n > 0; n--) (void)ReadTag(r, INT_BYTES);
}

/* Entities of all dimensions, appended to those that are known */
static PetscErrorCode ReadEntityLists(MeshReader *r, PetscBool partitioned, GmshMesh *mesh)
{
  PetscInt    count[4], n = 0, e = mesh->n_entities;
  GmshEntity *entities;

  PetscFunctionBeginUser;
  for (PetscInt dim = 0; dim < 4; dim++) n += count[dim] = ReadCount(r, SIZE_BYTES);
  PetscCall(PetscCalloc1(e + n, &entities));
  PetscCall(PetscArraycpy(entities, mesh->entities, e));
  PetscCall(PetscFree(mesh->entities));
  mesh->entities   = entities;
  mesh->n_entities = e + n;
  for (PetscInt dim = 0; dim < 4; dim++)
    for (PetscInt i = 0; i < count[dim] && !r->error->code; i++) ReadEntity(r, dim, partitioned, &entities[e++]);
  PetscFunctionReturn(0);
}

PetscErrorCode GmshReadEntities(MeshReader *r, GmshMesh *mesh)
{
  PetscFunctionBeginUser;
  PetscCall(ReadEntityLists(r, PETSC_FALSE, mesh));
  PetscFunctionReturn(0);
}

/* The number of partitions, the ghost entities, and the entities of the parts, which have tags of their own */
PetscErrorCode GmshReadPartitionedEntities(MeshReader *r, GmshMesh *mesh)
{
  PetscFunctionBeginUser;
  (void)ReadCount(r, SIZE_BYTES);
  for (PetscInt n = ReadCount(r, SIZE_BYTES); n > 0; n--)
    for (int skip = 0; skip < 2; skip++) (void)ReadTag(r, INT_BYTES);
  PetscCall(ReadEntityLists(r, PETSC_TRUE, mesh));
  PetscFunctionReturn(0);
}
