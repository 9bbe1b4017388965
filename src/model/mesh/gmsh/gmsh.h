/*
   GmshMesh - the content of a Gmsh file as it stands there: nodes, elements of all dimensions, and named physical
   groups. Reading is serial; the first error is kept in words, and later reads do nothing.
*/
#pragma once

#include "reader.h"

#include <petscdmplex.h>

#define GMSH_MAX_PHYSICAL 16 /* physical groups of one entity */
#define GMSH_MAX_NODES    27 /* nodes of one element */

/* A type of element */
typedef struct {
  PetscInt             type; /* Gmsh's number */
  PetscInt             dim, n_corners, n_nodes;
  DMPolytopeType       polytope;
  const unsigned char *at; /* [n_nodes] of volumes: node i stands in the middle of the corners whose bits are set */
} GmshShape;

typedef struct {
  PetscInt dim, tag;
  char     name[128];
} GmshGroup;

/* What shares physical groups: a geometric entity (format 4.1) or one named group itself (2.2) */
typedef struct {
  PetscInt dim, tag;
  PetscInt n_physical, physical[GMSH_MAX_PHYSICAL];
} GmshEntity;

typedef struct {
  const GmshShape *shape;
  PetscInt         number;               /* in the file */
  PetscInt         entity;               /* index, or -1 without physical group */
  PetscInt         node[GMSH_MAX_NODES]; /* tags; ImportGmsh() makes them indices */
} GmshElement;

typedef struct {
  PetscInt     n_groups, n_entities, n_nodes, n_elements;
  GmshGroup   *groups;
  GmshEntity  *entities;
  PetscInt    *node_tags; /* [n_nodes] */
  PetscReal   *x;         /* [n_nodes][3], m */
  GmshElement *elements;
} GmshMesh;

/* Reads a file of format 2.2 or 4.1, text or binary. What is wrong with the file is told in `error` (code 0:
   nothing), for the caller to raise on all ranks. Not collective; free with GmshMeshDestroy() in any case. */
PETSC_INTERN PetscErrorCode GmshMeshRead(const char file[], GmshMesh *mesh, ReaderError *error);
PETSC_INTERN PetscErrorCode GmshMeshDestroy(GmshMesh *mesh);

/* gmsh/groups.c - sections $PhysicalNames, $Entities and $PartitionedEntities; the index of an entity, -1 where it is
   none */
PETSC_INTERN PetscErrorCode GmshReadNames(MeshReader *r, GmshMesh *mesh);
PETSC_INTERN PetscErrorCode GmshReadEntities(MeshReader *r, GmshMesh *mesh);
PETSC_INTERN PetscErrorCode GmshReadPartitionedEntities(MeshReader *r, GmshMesh *mesh);
PETSC_INTERN PetscInt       GmshFindEntity(const GmshMesh *mesh, PetscInt dim, PetscInt tag);
