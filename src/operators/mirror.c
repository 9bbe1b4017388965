/*
   Planes of symmetry (-symmetry): for each the signed permutation R of the unknowns of a pencil, R^2 = 1, that takes a
   vector to its mirror image, and the proof that the scene is its own,

      R Q R = Q   for Q = K, M, C,   |(R Q R x - Q x)_i| <= MIRROR_ROUNDING max_j |Q_ij| sum over the row of |x|

   with x at random, of which no row that differs leaves zero. Where constraints leave q of the unknowns u = Zr q with E' u
   = q, R_q = E' R E, which is a signed permutation where the frames of the pairs are mirror images too.
*/
#include "pencilimpl.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MIRROR_ROUNDING 1e-11
#define MIRROR_FLOOR    1e-8 /* of the largest entry: rows below are compared with that */
#define MIRROR_VECTORS  2

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
  PetscCall(PetscOptionsString("-symmetry",
                               "planes of which the scene is its own mirror image, by their normals: x, y, z (in the "
                               "middle of the mesh), x=0.05 (m); each parity is solved by itself",
                               "operators.h", text, text, sizeof(text), &set));
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

/* The entry of a row that is a signed permutation's but for rounding: its column and sign; sign 0 for another row */
PetscErrorCode MirrorGetRow(Mat R, PetscInt row, PetscInt *column, PetscReal *sign)
{
  const PetscInt    *columns;
  const PetscScalar *values;
  PetscInt           n;

  PetscFunctionBeginUser;
  *column = -1;
  *sign   = 0;
  PetscCall(MatGetRow(R, row, &n, &columns, &values));
  for (PetscInt k = 0; k < n; k++)
    if (PetscAbsScalar(values[k]) > 0.5) *column = columns[k], *sign = PetscRealPart(values[k]) > 0 ? 1 : -1;
  for (PetscInt k = 0; k < n; k++)
    if (PetscAbsReal(PetscRealPart(values[k]) - (columns[k] == *column ? *sign : 0)) > 1e-9) *sign = 0;
  PetscCall(MatRestoreRow(R, row, &n, &columns, &values));
  PetscFunctionReturn(0);
}

/* R becomes E' R E, in the unknowns that constraints leave */
static PetscErrorCode MirrorProject(Pencil pencil, const ModelPlane *plane, Mat *R)
{
  PetscInt first, last, wrong = 0, column;
  Mat      RE, projected;

  PetscFunctionBeginUser;
  if (!pencil->E) PetscFunctionReturn(0);
  PetscCall(MatMatMult(*R, pencil->E, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &RE));
  PetscCall(MatTransposeMatMult(pencil->E, RE, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &projected));
  PetscCall(MatProductClear(projected));
  PetscCall(MatDestroy(&RE));
  PetscCall(MatDestroy(R));
  *R = projected;
  PetscCall(MatGetOwnershipRange(*R, &first, &last));
  for (PetscInt i = first; i < last; i++) {
    PetscReal sign;

    PetscCall(MirrorGetRow(*R, i, &column, &sign));
    if (sign == 0) wrong = 1;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &wrong, 1, MPIU_INT, MPI_MAX, pencil->comm));
  PetscCheck(!wrong, pencil->comm, PETSC_ERR_SUP,
             "-symmetry %c: what constraints leave is not its own mirror image: %s", "xyz"[plane->axis],
             pencil->operators->rigid_Z ? "-points that are joined rigidly are not supported with it"
                                        : "slip directions of -contact_law constraint must lie in the plane");
  PetscFunctionReturn(0);
}

/* The node (m) and direction of unknown i of a pencil, on all ranks */
static PetscErrorCode MirrorLocate(Pencil pencil, PetscInt i, PetscReal place[4])
{
  const Mesh *mesh;
  PetscInt    at = i;
  Vec         q, u;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(pencil->operators->model, &mesh));
  if (pencil->E) {
    PetscCall(MatCreateVecs(pencil->E, &q, &u));
    PetscCall(VecSetValue(q, i, 1, ADD_VALUES)); /* on every rank */
    PetscCall(VecAssemblyBegin(q));
    PetscCall(VecAssemblyEnd(q));
    PetscCall(MatMult(pencil->E, q, u));
    PetscCall(VecAbs(u));
    PetscCall(VecMax(u, &at, NULL));
    PetscCall(VecDestroy(&q));
    PetscCall(VecDestroy(&u));
  }
  for (int d = 0; d < 4; d++) place[d] = -PETSC_MAX_REAL;
  for (PetscInt k = 0; k < 3 * mesh->n_nodes; k++) {
    if (mesh->unknown[k] != at) continue;
    for (int d = 0; d < 3; d++) place[d] = mesh->x[k - k % 3 + d];
    place[3] = (PetscReal)(k % 3);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, place, 4, MPIU_REAL, MPI_MAX, pencil->comm));
  PetscFunctionReturn(0);
}

/* Largest |(R Q R x - Q x)_i| beside the largest entry of row i of Q, and where */
static PetscErrorCode MirrorMeasure(Mat Q, Mat R, Vec size, PetscReal *largest, PetscInt *at)
{
  PetscRandom random;
  Vec         x, image, difference;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(Q, &x, &image));
  PetscCall(VecDuplicate(x, &difference));
  PetscCall(PetscRandomCreate(PetscObjectComm((PetscObject)Q), &random));
  PetscCall(PetscRandomSetInterval(random, 0.5, 1));
  *largest = -1;
  for (int k = 0; k < MIRROR_VECTORS; k++) {
    PetscReal value;
    PetscInt  where;

    PetscCall(VecSetRandom(x, random));
    PetscCall(MatMult(R, x, difference));
    PetscCall(MatMult(Q, difference, image));
    PetscCall(MatMult(R, image, difference));
    PetscCall(MatMult(Q, x, image));
    PetscCall(VecAXPY(difference, -1, image));
    PetscCall(VecPointwiseDivide(difference, difference, size));
    PetscCall(VecAbs(difference));
    PetscCall(VecMax(difference, &where, &value));
    if (value > *largest) *largest = value, *at = where;
  }
  PetscCall(PetscRandomDestroy(&random));
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&image));
  PetscCall(VecDestroy(&difference));
  PetscFunctionReturn(0);
}

/* "at pad_young 1e+10, ": parameters whose values are not those of the scene, for messages */
static PetscErrorCode MirrorPoint(Pencil pencil, size_t size, char text[])
{
  const Parameters *scene = &pencil->operators->parameters;
  char              one[192];

  PetscFunctionBeginUser;
  text[0] = 0;
  for (PetscInt i = 0; i < pencil->n_scene; i++) {
    if (pencil->parameters.p[i] == scene->list[i].value) continue;
    PetscCall(PetscSNPrintf(one, sizeof(one), "%s%s %.6g", text[0] ? " and " : "at ", scene->list[i].name,
                            (double)pencil->parameters.p[i]));
    PetscCall(PetscStrlcat(text, one, size));
  }
  if (text[0]) PetscCall(PetscStrlcat(text, " ", size));
  PetscFunctionReturn(0);
}

/* Raises an error where a matrix is not its own mirror image; `what` tells its name and what it is made of */
static PetscErrorCode MirrorCheck(Pencil pencil, PetscInt i, Mat Q, const char what[])
{
  const ModelPlane *plane = &pencil->operators->plane[i];
  PetscReal         largest, most, place[4];
  PetscInt          at;
  Vec               size;
  char              point[256];

  PetscFunctionBeginUser;
  if (!Q) PetscFunctionReturn(0);
  PetscCall(MatCreateVecs(Q, NULL, &size));
  PetscCall(MatGetRowMaxAbs(Q, size, NULL));
  PetscCall(VecMax(size, NULL, &most));
  PetscCall(VecShift(size, MIRROR_FLOOR * most));
  PetscCall(MirrorMeasure(Q, pencil->mirror[i], size, &largest, &at));
  PetscCall(VecDestroy(&size));
  pencil->asymmetry = PetscMax(pencil->asymmetry, largest);
  if (largest <= MIRROR_ROUNDING) PetscFunctionReturn(0);
  PetscCall(MirrorLocate(pencil, at, place));
  PetscCall(MirrorPoint(pencil, sizeof(point), point));
  SETERRQ(pencil->comm, PETSC_ERR_USER_INPUT,
          "-symmetry %c: %sthe scene is not its own mirror image in %c = %g m: %s differs by %.1e of its row (%.0e "
          "allowed), most at the node (%g, %g, %g) m along %c",
          "xyz"[plane->axis], point, "xyz"[plane->axis], (double)plane->at, what, (double)largest, MIRROR_ROUNDING,
          (double)place[0], (double)place[1], (double)place[2], "xyz"[(int)place[3]]);
}

/* All matrices of the pencil in plane i; friction last, so that what it alone spoils is named so */
static PetscErrorCode MirrorCheckAll(Pencil pencil, PetscInt i)
{
  PencilMatrices frictionless, m;

  PetscFunctionBeginUser;
  PetscCall(PencilGetFrictionless(pencil, &frictionless));
  PetscCall(MirrorCheck(pencil, i, frictionless.M, "the mass matrix M of its parts"));
  PetscCall(MirrorCheck(pencil, i, frictionless.K, "the stiffness K of its parts, springs and contacts"));
  PetscCall(PencilGetMatrices(pencil, &m));
  PetscCall(MirrorCheck(pencil, i, m.C, "the damping matrix C"));
  if (m.M != frictionless.M) PetscCall(MirrorCheck(pencil, i, m.M, "friction, by the slip of its pairs,"));
  if (m.K != frictionless.K) PetscCall(MirrorCheck(pencil, i, m.K, "friction, by the slip of its pairs,"));
  PetscFunctionReturn(0);
}

/* Proves at the present point that the scene is its own image, where that is not known yet */
static PetscErrorCode MirrorsProve(Pencil pencil)
{
  const PetscInt n    = pencil->parameters.n;
  PetscBool      same = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (pencil->proven) PetscCall(PetscArraycmp(pencil->parameters.p, pencil->proven, n, &same));
  if (same) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < pencil->operators->n_planes; i++) PetscCall(MirrorCheckAll(pencil, i));
  if (!pencil->proven) PetscCall(PetscMalloc1(n, &pencil->proven));
  PetscCall(PetscArraycpy(pencil->proven, pencil->parameters.p, n));
  PetscFunctionReturn(0);
}

PetscErrorCode PencilCreateMirrors(Pencil pencil)
{
  Operators o = pencil->operators;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < o->n_planes; i++) {
    if (pencil->mirror[i]) continue;
    PetscCall(MirrorCreate(o, &o->plane[i], &pencil->mirror[i]));
    PetscCall(MirrorProject(pencil, &o->plane[i], &pencil->mirror[i]));
  }
  PetscCall(MirrorsProve(pencil));
  PetscFunctionReturn(0);
}

PetscErrorCode PencilDestroyMirrors(Pencil pencil)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < OPERATORS_MAX_PLANES; i++) PetscCall(MatDestroy(&pencil->mirror[i]));
  PetscCall(PetscFree(pencil->proven));
  PetscFunctionReturn(0);
}
