/*
   Boxes of hexahedra with graded nodes as a Gmsh file, for tests that need named sets. A node at (x, y, z) of the grid
   lies at (x (1 + taper y) + shear z, y, z), so that faces z = const are trapezoids of straight edges. Lengths in m.

   Of a box NAME: volume NAME, surfaces NAME_bottom and NAME_top (least and largest z), curve NAME_edge (x and y least,
   all z) and point NAME_corner (x, y, z least).
*/
#pragma once

#include <squeal/model.h>
#include <stdlib.h>
#include <unistd.h>

#define BOX_LENGTH(a) (PetscInt)(sizeof(a) / sizeof((a)[0]))
#define BOX_GROUPS    5

typedef struct {
  const char      *name;
  PetscInt         n[3]; /* nodes in x, y, z */
  const PetscReal *x[3]; /* their coordinates */
  PetscReal        taper, shear;
  int              glued; /* the bottom nodes are the top nodes of the box before */
} Box;

/* Place of a node in the file, from 1 */
static inline PetscInt BoxNode(const Box *b, PetscInt first, PetscInt i, PetscInt j, PetscInt k)
{
  return first + i + b->n[0] * (j + b->n[1] * k) + 1;
}

/* Nodes that the box has before those of the next one */
static inline PetscInt BoxCountNodes(const Box *b, int next_glued)
{
  return b->n[0] * b->n[1] * (b->n[2] - next_glued);
}

/* Lines of the elements in the file, numbered from *n on; group is the first physical number of the box */
static inline void BoxWriteElements(FILE *file, const Box *b, PetscInt first, int group, int *n)
{
  for (PetscInt k = 0; k < b->n[2]; k++)
    for (PetscInt j = 0; j + 1 < b->n[1]; j++)
      for (PetscInt i = 0; i + 1 < b->n[0]; i++) {
        const int lower[4] = {(int)BoxNode(b, first, i, j, k), (int)BoxNode(b, first, i + 1, j, k),
                              (int)BoxNode(b, first, i + 1, j + 1, k), (int)BoxNode(b, first, i, j + 1, k)};
        const int up       = (int)(b->n[0] * b->n[1]);
        const int at_end   = k == 0 ? 1 : 2;

        if (k == 0 || k == b->n[2] - 1)
          fprintf(file, "%d 3 2 %d 1 %d %d %d %d\n", ++*n, group + at_end, lower[0], lower[1], lower[2], lower[3]);
        if (k == b->n[2] - 1) continue;
        fprintf(file, "%d 5 2 %d 1 %d %d %d %d", ++*n, group, lower[0], lower[1], lower[2], lower[3]);
        fprintf(file, " %d %d %d %d\n", lower[0] + up, lower[1] + up, lower[2] + up, lower[3] + up);
      }
  for (PetscInt k = 0; k + 1 < b->n[2]; k++)
    fprintf(file, "%d 1 2 %d 1 %d %d\n", ++*n, group + 3, (int)BoxNode(b, first, 0, 0, k),
            (int)BoxNode(b, first, 0, 0, k + 1));
  fprintf(file, "%d 15 2 %d 1 %d\n", ++*n, group + 4, (int)BoxNode(b, first, 0, 0, 0));
}

static inline PetscInt BoxCountElements(const Box *b)
{
  return (b->n[0] - 1) * (b->n[1] - 1) * (b->n[2] + 1) + b->n[2];
}

/* Lines of the nodes; those of a glued bottom are in the file already */
static inline void BoxWriteNodes(FILE *file, const Box *b, PetscInt first)
{
  for (PetscInt k = b->glued; k < b->n[2]; k++)
    for (PetscInt j = 0; j < b->n[1]; j++)
      for (PetscInt i = 0; i < b->n[0]; i++)
        fprintf(file, "%d %.17g %.17g %.17g\n", (int)BoxNode(b, first, i, j, k),
                (double)(b->x[0][i] * (1 + b->taper * b->x[1][j]) + b->shear * b->x[2][k]), (double)b->x[1][j],
                (double)b->x[2][k]);
}

/* The whole file, on one rank */
static inline void BoxesWriteFile(FILE *file, int n, const Box b[])
{
  static const char *const suffix[BOX_GROUPS]    = {"", "_bottom", "_top", "_edge", "_corner"};
  static const int         dimension[BOX_GROUPS] = {3, 2, 2, 1, 0};
  PetscInt                 first = 0, n_elements = 0;
  int                      element = 0;

  fprintf(file, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%d\n", BOX_GROUPS * n);
  for (int g = 0; g < BOX_GROUPS * n; g++)
    fprintf(file, "%d %d \"%s%s\"\n", dimension[g % BOX_GROUPS], g + 1, b[g / BOX_GROUPS].name, suffix[g % BOX_GROUPS]);
  for (int i = 0; i < n; i++) {
    first += BoxCountNodes(&b[i], i + 1 < n && b[i + 1].glued);
    n_elements += BoxCountElements(&b[i]);
  }
  fprintf(file, "$EndPhysicalNames\n$Nodes\n%d\n", (int)first);
  for (int i = first = 0; i < n; i++) {
    BoxWriteNodes(file, &b[i], first);
    first += BoxCountNodes(&b[i], i + 1 < n && b[i + 1].glued);
  }
  fprintf(file, "$EndNodes\n$Elements\n%d\n", (int)n_elements);
  for (int i = first = 0; i < n; i++) {
    BoxWriteElements(file, &b[i], first, BOX_GROUPS * i + 1, &element);
    first += BoxCountNodes(&b[i], i + 1 < n && b[i + 1].glued);
  }
  fprintf(file, "$EndElements\n");
}

/* Writes the mesh into a temporary file, which stays until BoxesRemove() */
static inline PetscErrorCode BoxesWrite(MPI_Comm comm, int n, const Box boxes[], char path[PETSC_MAX_PATH_LEN])
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscStrncpy(path, "/tmp/squeal_boxes_XXXXXX", PETSC_MAX_PATH_LEN));
  if (rank == 0) {
    const int descriptor = mkstemp(path);
    FILE     *file       = descriptor < 0 ? NULL : fdopen(descriptor, "w");

    PetscCheck(file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "Cannot write %s", path);
    BoxesWriteFile(file, n, boxes);
    PetscCheck(!fclose(file), PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "Cannot write %s", path);
  }
  PetscCallMPI(MPI_Bcast(path, PETSC_MAX_PATH_LEN, MPI_CHAR, 0, comm));
  PetscFunctionReturn(0);
}

static inline PetscErrorCode BoxesRemove(MPI_Comm comm, const char path[])
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCheck(rank || !unlink(path), PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED, "Cannot remove %s", path);
  PetscFunctionReturn(0);
}

/* The model of a scene on boxes, set up */
static inline PetscErrorCode BoxesCreateModel(MPI_Comm comm, int n, const Box boxes[], const char scene[], Model *model)
{
  char path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(BoxesWrite(comm, n, boxes, path));
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscOptionsInsertString(NULL, scene));
  PetscCall(PetscOptionsSetValue(NULL, "-model_mesh", path));
  PetscCall(ModelCreate(comm, model));
  PetscCall(ModelSetFromOptions(*model));
  PetscCall(ModelSetUp(*model));
  PetscCall(BoxesRemove(comm, path));
  PetscFunctionReturn(0);
}
