/*
   Rigid motions that nothing resists. The candidates are the six rigid motions of every body, made orthonormal in
   diag(A); a combination r of them is free when r'A r + |r - Z E'r|^2 vanishes, A = K + kappa G'G: no support, no
   spring and no pair resists it, and what follows others (ties, points that are joined rigidly) does so. The norm is
   that of diag(A).
*/
#include "statics/staticsimpl.h"
#include "base/algebra/dense.h"

#define RIGID_MAX_BODIES 64
/* norm left of a candidate that is one of the others: rotations of a body whose free nodes are on a line */
#define RIGID_DEPENDENT 1e-6
/* energy beside that of the same motion with all its neighbours held, diag(A): rounding of r'A r, which cancels from
   terms of diag(A), is some 1e-16 of it; a spring of 1e-13 of the body's stiffness counts as none */
#define RIGID_FREE 1e-13

/* Where a body is */
typedef struct {
  PetscReal centre[3], length; /* m; half its extent */
} RigidBody;

/* Displacement d of point x in rigid motion k of a body: translations, then rotations about c over length, e_axis x
   (x - c) / length. Entries are of order 1 for both kinds, without unit. */
static PetscReal RigidMotion(int k, int d, const PetscReal x[3], const RigidBody *rigid)
{
  const PetscReal *c    = rigid->centre;
  const int        axis = k - 3, a = (axis + 1) % 3, b = (axis + 2) % 3;

  if (k < 3) return k == d ? 1 : 0;
  return d == a ? -(x[b] - c[b]) / rigid->length : d == b ? (x[a] - c[a]) / rigid->length : 0;
}

/* Centre and half the extent of each body */
static PetscErrorCode RigidMeasure(Model model, PetscInt n_bodies, const PetscInt body[], RigidBody rigid[])
{
  PetscReal *box;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(6 * n_bodies, &box));
  PetscCall(ModelMeasureBodies(model, body, 0, n_bodies, box));
  for (PetscInt i = 0; i < n_bodies; i++) {
    const PetscReal *upper = &box[6 * i], *lower = upper + 3; /* lower ends with the other sign */

    rigid[i].length = 0;
    for (int d = 0; d < 3; d++) {
      rigid[i].centre[d] = (upper[d] - lower[d]) / 2;
      rigid[i].length    = PetscMax(rigid[i].length, (upper[d] + lower[d]) / 2);
    }
  }
  PetscCall(PetscFree(box));
  PetscFunctionReturn(0);
}

/* Rigid motion k of a body at its free unknowns */
static PetscErrorCode RigidSetMotion(Model model, const PetscInt body[], PetscInt b, const RigidBody *rigid, int k,
                                     Vec r)
{
  const Mesh  *mesh;
  PetscInt     begin, end;
  PetscScalar *value;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(VecSet(r, 0));
  PetscCall(VecGetOwnershipRange(r, &begin, &end));
  PetscCall(VecGetArray(r, &value));
  for (PetscInt i = 0; i < 3 * mesh->n_nodes; i++)
    if (body[i / 3] == b && mesh->unknown[i] >= begin && mesh->unknown[i] < end)
      value[mesh->unknown[i] - begin] = RigidMotion(k, (int)(i % 3), &mesh->x[i - i % 3], rigid);
  PetscCall(VecRestoreArray(r, &value));
  PetscFunctionReturn(0);
}

/* Makes r orthonormal to the n vectors before it in the inner product of M, or of a diagonal of weights where M is
   NULL; false when nothing is left. Pass 0 measures the length before, passes 1 and 2 are Gram-Schmidt twice, after
   which orthogonality is that of rounding. */
static PetscErrorCode RigidOrthonormalise(Mat M, Vec weights, PetscInt n, const Vec before[], Vec r, PetscBool *good)
{
  PetscReal   norm[2];
  PetscScalar dot;
  Vec         image;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(r, &image));
  for (int pass = 0; pass < 3; pass++) {
    for (PetscInt i = 0; i < n && pass; i++) {
      if (M)
        PetscCall(MatMult(M, r, image));
      else
        PetscCall(VecPointwiseMult(image, weights, r));
      PetscCall(VecDot(image, before[i], &dot));
      PetscCall(VecAXPY(r, -dot, before[i]));
    }
    if (M)
      PetscCall(MatMult(M, r, image));
    else
      PetscCall(VecPointwiseMult(image, weights, r));
    PetscCall(VecDot(image, r, &dot));
    norm[pass ? 1 : 0] = PetscSqrtReal(PetscMax(0, PetscRealPart(dot)));
  }
  *good = norm[1] > RIGID_DEPENDENT * norm[0] ? PETSC_TRUE : PETSC_FALSE;
  if (*good) PetscCall(VecScale(r, 1 / norm[1]));
  PetscCall(VecDestroy(&image));
  PetscFunctionReturn(0);
}

/* Rigid motions of all bodies, orthonormal in diag(A); motion[6 n_bodies] */
static PetscErrorCode RigidCandidates(Operators operators, Mat A, PetscInt *n, Vec **motion)
{
  Model      model;
  RigidBody *rigid;
  PetscInt   n_bodies, *body;
  PetscBool  good;
  Vec        diagonal;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(operators, &model, NULL));
  PetscCall(ModelGetBodies(model, &n_bodies, &body));
  PetscCheck(n_bodies <= RIGID_MAX_BODIES, PetscObjectComm((PetscObject)A), PETSC_ERR_SUP,
             "the mesh falls into %" PetscInt_FMT " pieces, at most %d can be held in equilibrium", n_bodies,
             RIGID_MAX_BODIES);
  PetscCall(PetscMalloc1(n_bodies, &rigid));
  PetscCall(RigidMeasure(model, n_bodies, body, rigid));
  PetscCall(MatCreateVecs(A, &diagonal, NULL));
  PetscCall(MatGetDiagonal(A, diagonal));
  PetscCall(VecDuplicateVecs(diagonal, 6 * n_bodies, motion));
  *n = 0;
  for (PetscInt i = 0; i < 6 * n_bodies; i++) {
    PetscCall(RigidSetMotion(model, body, i / 6, &rigid[i / 6], (int)(i % 6), (*motion)[*n]));
    PetscCall(RigidOrthonormalise(NULL, diagonal, *n, *motion, (*motion)[*n], &good));
    if (good) (*n)++;
  }
  for (PetscInt i = *n; i < 6 * n_bodies; i++) PetscCall(VecDestroy(&(*motion)[i]));
  PetscCall(VecDestroy(&diagonal));
  PetscCall(PetscFree(rigid));
  PetscCall(PetscFree(body));
  PetscFunctionReturn(0);
}

/* Adds (c_i, c_j) in diag(A) to energies [n * n], c = r - Z E'r: by how much followers do not follow. A tie has no
   stiffness in A; this term makes a motion that parts what it joins cost as much as one against its neighbours. */
static PetscErrorCode RigidAddParted(Operators operators, Mat A, PetscInt n, const Vec motion[], PetscReal energy[])
{
  Mat          Z, E;
  PetscScalar *dot;
  Vec          diagonal, image, q, *apart;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetDependents(operators, &Z, &E));
  if (!Z) PetscFunctionReturn(0);
  PetscCall(MatCreateVecs(A, &diagonal, &image));
  PetscCall(MatCreateVecs(Z, &q, NULL));
  PetscCall(VecDuplicateVecs(image, n, &apart));
  PetscCall(MatGetDiagonal(A, diagonal));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(MatMultTranspose(E, motion[i], q));
    PetscCall(MatMult(Z, q, apart[i]));
    PetscCall(VecAYPX(apart[i], -1, motion[i]));
  }
  PetscCall(PetscMalloc1(n, &dot));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(VecPointwiseMult(image, diagonal, apart[i]));
    PetscCall(VecMDot(image, n, apart, dot));
    for (PetscInt j = 0; j < n; j++) energy[i * n + j] += PetscRealPart(dot[j]);
  }
  PetscCall(PetscFree(dot));
  PetscCall(VecDestroyVecs(n, &apart));
  PetscCall(VecDestroy(&diagonal));
  PetscCall(VecDestroy(&image));
  PetscCall(VecDestroy(&q));
  PetscFunctionReturn(0);
}

/* Eigenvalues ascending and vectors (in place) of the energies r_i'A r_j and of what parts, [n * n], without unit:
   between 0 and about 1 since motions are orthonormal in diag(A) */
static PetscErrorCode RigidEnergies(Operators operators, Mat A, PetscInt n, const Vec motion[], PetscReal energy[],
                                    PetscReal vectors[])
{
  Vec image;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(motion[0], &image));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(MatMult(A, motion[i], image));
    PetscCall(VecMDot(image, n, motion, &vectors[i * n]));
  }
  PetscCall(VecDestroy(&image));
  PetscCall(RigidAddParted(operators, A, n, motion, vectors));
  PetscCall(DenseSymmetricEigen(n, vectors, NULL, energy, NULL));
  PetscFunctionReturn(0);
}

/* The eigenvectors of energies below RIGID_FREE are the free motions, then made orthonormal in M (r in 1 / sqrt(kg)),
   in which hold.c projects */
PetscErrorCode FreeMotionsCreate(Operators operators, const PetscReal p[], Mat A, Hold *hold)
{
  PetscInt   n;
  PetscReal *energy, *vectors;
  PetscBool  good;
  Vec       *motion;
  Mat        M;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetBodies(operators, p, NULL, &M, NULL));
  PetscCall(RigidCandidates(operators, A, &n, &motion));
  PetscCall(PetscMalloc2(n, &energy, n * n, &vectors));
  PetscCall(RigidEnergies(operators, A, n, motion, energy, vectors));
  while (hold->n < n && energy[hold->n] < RIGID_FREE) hold->n++;
  if (hold->n) {
    PetscCall(VecDuplicateVecs(motion[0], hold->n, &hold->r));
    PetscCall(VecDuplicateVecs(motion[0], hold->n, &hold->mr));
  }
  for (PetscInt i = 0; i < hold->n; i++) {
    PetscCall(VecSet(hold->r[i], 0));
    PetscCall(VecMAXPY(hold->r[i], n, &vectors[i * n], motion));
    PetscCall(RigidOrthonormalise(M, NULL, i, hold->r, hold->r[i], &good));
    PetscCall(MatMult(M, hold->r[i], hold->mr[i]));
  }
  for (PetscInt i = 0; i < n; i++) PetscCall(VecDestroy(&motion[i]));
  PetscCall(PetscFree(motion));
  PetscCall(PetscFree2(energy, vectors));
  PetscFunctionReturn(0);
}
