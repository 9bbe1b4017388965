/* Private to model/: the volume elements of a Gmsh file as a DMPlex */
#pragma once

#include "gmsh.h"

/* The volume elements of a file; all empty but on rank 0 */
typedef struct {
  const GmshMesh *mesh;
  PetscInt        n_cells, n_vertices;
  PetscInt       *vertex; /* [nodes of the file] vertex of the DM, -1 for a node that is the corner of no cell */
  PetscInt       *point;  /* [nodes of the file] point of the DM that bears the node, -1 without any */
} GmshVolumes;

/* volumes.c - interpolated DMPlex of the cells, whose coordinates stand at the points that bear a node: vertices, and
   edges, faces and cells of elements of second order; fills volumes->point. What is wrong goes to the error of rank
   0, but for cells that do not fit to each other: their error is raised, with the name of the file. Collective. */
PETSC_INTERN PetscErrorCode VolumesCreateMesh(MPI_Comm comm, const char file[], const GmshVolumes *volumes,
                                              ReaderError *error, DM *dm);

/* twisted.c - numbers in the file of two elements whose common face has its corners in different orders; -1 for none.
   Not collective. */
PETSC_INTERN PetscErrorCode VolumesFindTwisted(const GmshMesh *mesh, PetscInt element[2]);
