/*
   The element of a Gmsh file of which a face has the corners of a neighbour's face in another order: a hexahedron or
   wedge whose corners are turned. Two such faces agree where the corner opposite to their smallest one, across the
   diagonal, is the same.
*/
#include "volumes.h"
#include <stdlib.h>
#include <string.h>

#define MOST_FACES 6

typedef struct {
  PetscInt corner[4]; /* ascending */
  PetscInt opposite;  /* of corner[0] */
  PetscInt element;   /* number in the file */
} Quadrilateral;

/* Faces of a hexahedron and of a wedge, of Gmsh's corners, around */
static const int hexahedron[6][4] = {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                     {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
static const int wedge[3][4]      = {{0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};

/* By corners, then by element */
static int QuadrilateralOrder(const void *a, const void *b)
{
  const Quadrilateral *x = a, *y = b;

  for (int i = 0; i < 4; i++)
    if (x->corner[i] != y->corner[i]) return x->corner[i] < y->corner[i] ? -1 : 1;
  return (x->element > y->element) - (x->element < y->element);
}

static PetscErrorCode QuadrilateralSet(const GmshElement *element, const int at[4], Quadrilateral *face)
{
  PetscInt first = 0;

  PetscFunctionBeginUser;
  for (int i = 0; i < 4; i++) {
    face->corner[i] = element->node[at[i]];
    if (face->corner[i] < face->corner[first]) first = i;
  }
  face->opposite = face->corner[(first + 2) % 4];
  face->element  = element->number;
  PetscCall(PetscSortInt(4, face->corner));
  PetscFunctionReturn(0);
}

PetscErrorCode VolumesFindTwisted(const GmshMesh *mesh, PetscInt element[2])
{
  Quadrilateral *face;
  PetscInt       n = 0;

  PetscFunctionBeginUser;
  element[0] = element[1] = -1;
  PetscCall(PetscMalloc1(MOST_FACES * mesh->n_elements, &face));
  for (PetscInt e = 0; e < mesh->n_elements; e++) {
    const PetscInt n_corners = mesh->elements[e].shape->dim == 3 ? mesh->elements[e].shape->n_corners : 0;
    const PetscInt n_faces   = n_corners == 8 ? 6 : n_corners == 6 ? 3 : 0;

    for (PetscInt i = 0; i < n_faces; i++)
      PetscCall(QuadrilateralSet(&mesh->elements[e], n_faces == 6 ? hexahedron[i] : wedge[i], &face[n++]));
  }
  qsort(face, (size_t)n, sizeof(*face), QuadrilateralOrder);
  for (PetscInt i = 1; i < n && element[0] < 0; i++) {
    if (face[i].opposite == face[i - 1].opposite) continue;
    if (memcmp(face[i].corner, face[i - 1].corner, sizeof(face->corner))) continue;
    element[0] = face[i - 1].element;
    element[1] = face[i].element;
  }
  PetscCall(PetscFree(face));
  PetscFunctionReturn(0);
}
