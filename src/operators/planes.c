/*
   Planes of symmetry (-symmetry), and for each the signed permutation R of all unknowns, R^2 = 1, that takes displacements
   to their mirror image.
*/
#include "operatorsimpl.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PLANES_MOST 1e-3

/* One item of the list: x, or x=0.05 */
static PetscErrorCode PlaneParse(MPI_Comm comm, const char text[], const char item[], ModelPlane *plane)
{
  const char *axis  = item[0] ? strchr("xyz", item[0]) : NULL;
  char       *end   = NULL;
  PetscBool   valid = axis && (!item[1] || (item[1] == '=' && item[2])) ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  *plane = (ModelPlane){.axis = axis ? (int)(axis - "xyz") : 0, .has_at = valid && item[1] ? PETSC_TRUE : PETSC_FALSE};
  if (plane->has_at) {
    plane->at = strtod(&item[2], &end);
    valid     = !*end && isfinite(plane->at) ? PETSC_TRUE : PETSC_FALSE;
  }
  PetscCheck(valid, comm, PETSC_ERR_USER_INPUT,
             "-symmetry %s: '%s' is no plane; give x, y or z, its normal, and where it is not in the middle of the mesh "
             "its place in m, as x=0.05",
             text, item);
  PetscFunctionReturn(0);
}

PetscErrorCode MirrorsSetFromOptions(Operators o, OptionsItems PetscOptionsObject)
{
  char      text[128] = "", **items;
  int       n         = 0;
  PetscBool set, twice = PETSC_FALSE;

  PetscFunctionBeginUser;
  o->mirror_rtol = MIRROR_ROUNDING;
  PetscCall(PetscOptionsString("-symmetry",
                               "planes of which the scene is its own mirror image, by their normals: x, y, z (in the "
                               "middle of the mesh), x=0.05 (m); each parity is solved by itself",
                               "operators.h", text, text, sizeof(text), &set));
  PetscCall(
    OptionsGetReal(PetscOptionsObject, "-symmetry_rtol",
                   "by which part of the largest entry of its row a matrix may differ from its mirror image; more "
                   "for modes of a mesh that is mirrored to few digits",
                   o->mirror_rtol, &o->mirror_rtol, NULL));
  PetscCheck(o->mirror_rtol >= MIRROR_ROUNDING && o->mirror_rtol <= PLANES_MOST, o->comm, PETSC_ERR_USER_INPUT,
             "-symmetry_rtol %g must lie between %g, which is rounding, and %g", (double)o->mirror_rtol, MIRROR_ROUNDING,
             PLANES_MOST);
  if (!set) PetscCall(OptionsRefuse(o->comm, "-symmetry_rtol", "not used without -symmetry"));
  if (!set) PetscFunctionReturn(0);
  PetscCall(ValuesSplit(o->comm, "-symmetry", text, ',', &n, &items));
  PetscCheck(n >= 1 && n <= OPERATORS_MAX_PLANES, o->comm, PETSC_ERR_USER_INPUT,
             "-symmetry %s names %d planes; give one to three of x, y, z", text, n);
  for (int i = 0; i < n; i++) {
    PetscCall(PlaneParse(o->comm, text, items[i], &o->plane[i]));
    for (int j = 0; j < i; j++)
      if (o->plane[j].axis == o->plane[i].axis) twice = PETSC_TRUE;
  }
  PetscCheck(!twice, o->comm, PETSC_ERR_USER_INPUT, "-symmetry %s names a normal twice; each can stand once", text);
  PetscCall(PetscStrToArrayDestroy(n, items));
  o->n_planes = n;
  PetscFunctionReturn(0);
}

/* R of all unknowns in one plane */
static PetscErrorCode MirrorCreate(Operators o, ModelPlane *plane, Mat *R)
{
  const Mesh *mesh;
  PetscInt   *image;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(o->model, &mesh));
  PetscCall(PetscMalloc1(mesh->n_own, &image));
  PetscCall(ModelMirror(o->model, plane, image));
  PetscCall(MatCreateAIJ(o->comm, mesh->n_own, mesh->n_own, PETSC_DETERMINE, PETSC_DETERMINE, 1, NULL, 1, NULL, R));
  for (PetscInt i = 0; i < mesh->n_own; i++)
    PetscCall(MatSetValue(*R, mesh->first_own + i, image[i] < 0 ? -1 - image[i] : image[i], image[i] < 0 ? -1 : 1,
                          INSERT_VALUES));
  PetscCall(MatAssemblyBegin(*R, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*R, MAT_FINAL_ASSEMBLY));
  PetscCall(PetscFree(image));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsNeedMirrors(Operators o, const char what[])
{
  PetscFunctionBeginUser;
  PetscCheck(!o->n_planes || o->mirror_rtol <= MIRROR_ROUNDING, o->comm, PETSC_ERR_USER_INPUT,
             "-symmetry_rtol %g: %s do not measure what it leaves out, so that their errors would not hold; leave it out, "
             "or -symmetry with it",
             (double)o->mirror_rtol, what);
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetMirrors(Operators o, PetscInt *n, const ModelPlane **plane, const Mat **R)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < o->n_planes; i++)
    if (!o->mirror[i]) PetscCall(MirrorCreate(o, &o->plane[i], &o->mirror[i]));
  *n = o->n_planes;
  if (plane) *plane = o->plane;
  if (R) *R = o->mirror;
  PetscFunctionReturn(0);
}

PetscErrorCode MirrorsAddChecksum(Operators o, Checksum c)
{
  const ModelPlane *plane;
  PetscInt          n;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetMirrors(o, &n, &plane, NULL)); /* which finds the place of a plane in the middle of the mesh */
  if (!n) PetscFunctionReturn(0);
  PetscCall(ChecksumSetPart(c, "-symmetry"));
  PetscCall(ChecksumAddReals(c, 1, &o->mirror_rtol));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(ChecksumAddInts(c, 1, (const PetscInt[]){plane[i].axis}));
    PetscCall(ChecksumAddReals(c, 1, &plane[i].at));
  }
  PetscFunctionReturn(0);
}
