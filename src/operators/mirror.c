/*
   Mirror images in the unknowns of a pencil: for each plane of symmetry (planes.c) the signed permutation R, R^2 = 1, that
   takes a vector to its image, and the proof that the scene is its own,

      R Q R = Q   for Q = K, M, C,   |(R Q R x - Q x)_i| <= rtol max_j |Q_ij| sum over the row of |x|

   with x at random, of which no row that differs leaves zero. Where constraints leave q of the unknowns u = Zr q with E' u
   = q, R_q = E' R E, which is a signed permutation where the frames of the pairs are mirror images too.
*/
#include "pencilimpl.h"

#define MIRROR_FLOOR   1e-8 /* of the largest entry: rows below are compared with that */
#define MIRROR_VECTORS 2

#define MIRROR_STIFFNESS "the stiffness K of its parts, springs and contacts differs"

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
  const Operators o = pencil->operators;
  PetscInt        first, last, wrong = 0, column;
  Mat             RE, projected;

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
  PetscCheck(!wrong || !o->Z, pencil->comm, PETSC_ERR_SUP,
             "-symmetry %c: what %s leave is not its own mirror image: both surfaces of a tie must be, and -points "
             "that are joined rigidly are not supported with it",
             "xyz"[plane->axis], o->dependent);
  PetscCheck(!wrong, pencil->comm, PETSC_ERR_SUP,
             "-symmetry %c: what constraints leave is not its own mirror image: slip directions of -contact_law "
             "constraint must lie in the plane",
             "xyz"[plane->axis]);
  PetscFunctionReturn(0);
}

/* The node (m) and direction of unknown i, of those that E injects where it is not NULL, on all ranks */
static PetscErrorCode MirrorLocate(Operators o, Mat E, PetscInt i, PetscReal place[4])
{
  const Mesh *mesh;
  PetscReal   largest;
  PetscInt    at = i;
  Vec         q, u;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(o->model, &mesh));
  if (E) {
    PetscCall(MatCreateVecs(E, &q, &u));
    PetscCall(VecSetValue(q, i, 1, ADD_VALUES)); /* on every rank */
    PetscCall(VecAssemblyBegin(q));
    PetscCall(VecAssemblyEnd(q));
    PetscCall(MatMult(E, q, u));
    PetscCall(VecAbs(u));
    PetscCall(VecMax(u, &at, &largest));
    PetscCall(VecDestroy(&q));
    PetscCall(VecDestroy(&u));
  }
  for (int d = 0; d < 4; d++) place[d] = -PETSC_MAX_REAL;
  for (PetscInt k = 0; k < 3 * mesh->n_nodes; k++) {
    if (mesh->unknown[k] != at) continue;
    for (int d = 0; d < 3; d++) place[d] = mesh->x[k - k % 3 + d];
    place[3] = (PetscReal)(k % 3);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, place, 4, MPIU_REAL, MPI_MAX, o->comm));
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
static PetscErrorCode MirrorPoint(Operators o, const PetscReal p[], size_t size, char text[])
{
  const Parameters *scene = &o->parameters;
  char              one[192];

  PetscFunctionBeginUser;
  text[0] = 0;
  for (PetscInt i = 0; i < scene->n; i++) {
    if (p[i] == scene->list[i].value) continue;
    PetscCall(PetscSNPrintf(one, sizeof(one), "%s%s %.6g", text[0] ? " and " : "at ", scene->list[i].name,
                            (double)p[i]));
    PetscCall(PetscStrlcat(text, one, size));
  }
  if (text[0]) PetscCall(PetscStrlcat(text, " ", size));
  PetscFunctionReturn(0);
}

/* What is compared with its mirror image, and how far it is from it at unknown `at`, of what counts there */
typedef struct {
  const char *what; /* its name, what it is made of, and a verb */
  const char *size; /* what it is measured by */
  const char *allowed;
  PetscReal   rtol; /* so much of it is allowed */
  Mat         E;    /* as in MirrorLocate() */
  PetscReal   largest;
  PetscInt    at;
} MirrorFinding;

/* Raises the error for what is not its own mirror image in plane i at p */
static PetscErrorCode MirrorComplain(Operators o, PetscInt i, const PetscReal p[], const MirrorFinding *found)
{
  const ModelPlane *plane = &o->plane[i];
  PetscReal         place[4];
  char              point[256];

  PetscFunctionBeginUser;
  if (found->largest <= found->rtol) PetscFunctionReturn(0);
  PetscCall(MirrorLocate(o, found->E, found->at, place));
  PetscCall(MirrorPoint(o, p, sizeof(point), point));
  SETERRQ(o->comm, PETSC_ERR_USER_INPUT,
          "-symmetry %c: %sthe scene is not its own mirror image in %c = %g m: %s by %.1e of %s (%.0e allowed %s), most at "
          "the node (%g, %g, %g) m along %c",
          "xyz"[plane->axis], point, "xyz"[plane->axis], (double)plane->at, found->what, (double)found->largest,
          found->size, (double)found->rtol, found->allowed, (double)place[0], (double)place[1], (double)place[2],
          "xyz"[(int)place[3]]);
}

/* How far a matrix is from its mirror image */
static PetscErrorCode MirrorOfMatrix(Mat Q, Mat R, MirrorFinding *found)
{
  PetscReal most;
  Vec       size;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(Q, NULL, &size));
  PetscCall(MatGetRowMaxAbs(Q, size, NULL));
  PetscCall(VecMax(size, NULL, &most));
  PetscCall(VecShift(size, MIRROR_FLOOR * most));
  PetscCall(MirrorMeasure(Q, R, size, &found->largest, &found->at));
  PetscCall(VecDestroy(&size));
  PetscFunctionReturn(0);
}

/* Raises an error where a matrix is not its own mirror image */
static PetscErrorCode MirrorCheck(Pencil pencil, PetscInt i, Mat Q, const char what[])
{
  MirrorFinding found = {.what    = what,
                         .size    = "its row",
                         .allowed = "by -symmetry_rtol",
                         .rtol    = pencil->operators->mirror_rtol,
                         .E       = pencil->E};

  PetscFunctionBeginUser;
  if (!Q) PetscFunctionReturn(0);
  PetscCall(MirrorOfMatrix(Q, pencil->mirror[i], &found));
  pencil->asymmetry = PetscMax(pencil->asymmetry, found.largest);
  PetscCall(MirrorComplain(pencil->operators, i, pencil->parameters.p, &found));
  PetscFunctionReturn(0);
}

/* How far forces are from their mirror image, of the largest of them */
static PetscErrorCode MirrorOfForce(Vec f, Mat R, MirrorFinding *found)
{
  PetscReal size;
  Vec       image;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(f, &image));
  PetscCall(VecNorm(f, NORM_INFINITY, &size));
  PetscCall(MatMult(R, f, image));
  PetscCall(VecAXPY(image, -1, f));
  PetscCall(VecAbs(image));
  PetscCall(VecMax(image, &found->at, &found->largest));
  if (size > 0) found->largest /= size;
  PetscCall(VecDestroy(&image));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsProveEven(Operators o, const PetscReal p[], Vec f, const char what[])
{
  const char    allowed[] = "in statics, whatever -symmetry_rtol";
  MirrorFinding stiffness = {MIRROR_STIFFNESS, "its row", allowed, MIRROR_ROUNDING, NULL, 0, 0};
  MirrorFinding force     = {what, "the largest force on a node", allowed, MIRROR_ROUNDING, NULL, 0, 0};
  const Mat    *R;
  PetscInt      n;
  Mat           K;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetMirrors(o, &n, NULL, &R));
  if (!n) PetscFunctionReturn(0);
  PetscCall(OperatorsGetBodies(o, p, &K, NULL, NULL));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(MirrorOfMatrix(K, R[i], &stiffness));
    PetscCall(MirrorComplain(o, i, OperatorsPoint(o, p), &stiffness));
    PetscCall(MirrorOfForce(f, R[i], &force));
    PetscCall(MirrorComplain(o, i, OperatorsPoint(o, p), &force));
  }
  PetscFunctionReturn(0);
}

/* All matrices of the pencil in plane i; friction last, so that what it alone spoils is named so */
static PetscErrorCode MirrorCheckAll(Pencil pencil, PetscInt i)
{
  PencilMatrices frictionless, m;

  PetscFunctionBeginUser;
  PetscCall(PencilGetFrictionless(pencil, &frictionless));
  PetscCall(MirrorCheck(pencil, i, frictionless.M, "the mass matrix M of its parts differs"));
  PetscCall(MirrorCheck(pencil, i, frictionless.K, MIRROR_STIFFNESS));
  PetscCall(PencilGetMatrices(pencil, &m));
  PetscCall(MirrorCheck(pencil, i, m.C, "the damping matrix C differs"));
  if (m.M != frictionless.M) PetscCall(MirrorCheck(pencil, i, m.M, "friction, by the slip of its pairs, differs"));
  if (m.K != frictionless.K) PetscCall(MirrorCheck(pencil, i, m.K, "friction, by the slip of its pairs, differs"));
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
  Operators  o = pencil->operators;
  const Mat *R;
  PetscInt   n;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetMirrors(o, &n, NULL, &R));
  for (PetscInt i = 0; i < n; i++) {
    if (pencil->mirror[i]) continue;
    PetscCall(PetscObjectReference((PetscObject)R[i]));
    pencil->mirror[i] = R[i];
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
