/*
   Planes of symmetry (-symmetry) in the contact problem. Loads that are their own mirror images have a solution that is,
   u = S q with the columns S of what is even (operators.h), so that K_a is factored as S'K_a S alone, half of the unknowns.
   Rows of the pairs stay as they are, with the images of each other's displacements and forces:

      G R = P G,   P the orthogonal matrix that takes rows of a pair to those of its image, by their frames.

   W of the even part alone is singular. What it leaves out, O = 1 - prod_p (1 + P_p) / 2, is given a compliance c: with
   forces and displacements that are even, O l = O w = 0, it drops out of the solution, and keeps the small system regular.
*/
#include "staticsimpl.h"
#include "base/gather.h"
#include "base/vec3.h"

#define MIRROR_COMPLIANCE 0.5  /* c, in the middle of the eigenvalues of W */
#define MIRROR_FRAME      1e-8 /* of the entries of G */
#define MIRROR_ALIKE      1e-9 /* of friction and stiffness; of the place for gaps */
#define IMAGES_NEAR       1e-6 /* of the extent of all pairs and their plane: an image lies no farther away */
#define MIRROR_NORMAL     1e-6 /* squared distance of two unit normals, up to which they are the same */

/* A pair of all ranks */
typedef struct {
  PetscReal x[3], frame[3][3]; /* place, m; n, t, b */
  PetscReal law[3];            /* friction coefficient, stiffness (N/m), gap (m) */
  PetscInt  first, d;          /* rows, counted over all ranks */
} ImagePair;

/* The pairs of all ranks, in the order of their rows; to be freed */
static PetscErrorCode ImagesGather(Operators operators, const PetscReal p_all[], const PairRows *rows, PetscInt *n,
                                   ImagePair *all[])
{
  ImagePair *own;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(rows->n_pairs, &own));
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    const ContactPair *pair = &rows->pair[p];
    PetscReal          mu, kn;

    PetscCall(OperatorsGetInterface(operators, p_all, pair->interface, &mu, &kn));
    kn     = ContactPairStiffness(&rows->interface[pair->interface], pair, kn);
    own[p] = (ImagePair){.first = rows->begin + rows->first[p], .d = rows->law[p].d, .law = {mu, kn, pair->gap}};
    PetscCall(PetscArraycpy(own[p].x, pair->x, 3));
    PetscCall(PetscArraycpy(own[p].frame[0], pair->n, 3));
    PetscCall(PetscArraycpy(own[p].frame[1], pair->t, 3));
    PetscCall(PetscArraycpy(own[p].frame[2], pair->b, 3));
  }
  PetscCall(GatherRecords(rows->comm, rows->n_pairs, sizeof(*own), own, n, all));
  PetscCall(PetscFree(own));
  PetscFunctionReturn(0);
}

/* Squared distance of two triples */
static PetscReal ImagesApart(const PetscReal a[3], const PetscReal b[3])
{
  return PetscSqr(a[0] - b[0]) + PetscSqr(a[1] - b[1]) + PetscSqr(a[2] - b[2]);
}

/* Squared distance up to which a pair stands at the mirror image of another */
static PetscReal ImagesNear(PetscInt n, const ImagePair all[], const ModelPlane *plane)
{
  PetscReal extent = 0;

  for (PetscInt i = 0; i < n; i++) {
    PetscReal from[3] = {all[0].x[0], all[0].x[1], all[0].x[2]};

    from[plane->axis] = plane->at;
    extent            = PetscMax(extent, ImagesApart(all[i].x, from));
  }
  return PetscSqr(IMAGES_NEAR) * extent;
}

/* The pair that stands at the mirror image of one, nearest of those whose normals are images and that are nearer than the
   root of `least`; one in the plane is its own */
static const ImagePair *ImagesFind(PetscInt n, const ImagePair all[], const ImagePair *of, const ModelPlane *plane,
                                   PetscReal least)
{
  const ImagePair *best = NULL;
  PetscReal        x[3], normal[3];

  for (int d = 0; d < 3; d++) {
    x[d]      = d == plane->axis ? 2 * plane->at - of->x[d] : of->x[d];
    normal[d] = d == plane->axis ? -of->frame[0][d] : of->frame[0][d];
  }
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal apart = ImagesApart(all[i].x, x);

    if (apart > least || ImagesApart(all[i].frame[0], normal) > MIRROR_NORMAL) continue;
    least = apart;
    best  = &all[i];
  }
  return best && best->d == of->d ? best : NULL;
}

/* Whether two pairs have the same friction, stiffness and gap */
static PetscBool ImagesObeyAlike(const ImagePair *a, const ImagePair *b)
{
  const PetscReal size = PetscAbsReal(a->x[0]) + PetscAbsReal(a->x[1]) + PetscAbsReal(a->x[2]);

  for (int i = 0; i < 3; i++) {
    const PetscReal scale = i < 2 ? PetscAbsReal(a->law[i]) : size;

    if (a->law[i] != b->law[i] && PetscAbsReal(a->law[i] - b->law[i]) > MIRROR_ALIKE * scale) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* P of the rows of this rank; *alone = the least of n and the pairs of it without image */
static PetscErrorCode ImagesFill(const PairRows *rows, const ModelPlane *plane, PetscInt n, const ImagePair all[],
                                 Mat P, PetscInt *alone)
{
  const PetscReal near = ImagesNear(n, all, plane);

  PetscFunctionBeginUser;
  *alone = n;
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    PetscInt         a = 0;
    const ImagePair *of, *to;

    while (all[a].first != rows->begin + rows->first[p]) a++;
    of = &all[a];
    to = ImagesFind(n, all, of, plane, near);
    if (to && !ImagesObeyAlike(of, to)) to = NULL;
    if (!to) *alone = PetscMin(*alone, a);
    for (PetscInt i = 0; i < of->d; i++) /* room on the diagonal for 1 + P */
      PetscCall(MatSetValue(P, of->first + i, of->first + i, 0, INSERT_VALUES));
    for (PetscInt i = 0; to && i < of->d; i++)
      for (PetscInt j = 0; j < to->d; j++) {
        PetscReal image[3];

        for (int d = 0; d < 3; d++) image[d] = d == plane->axis ? -to->frame[j][d] : to->frame[j][d];
        PetscCall(MatSetValue(P, of->first + i, to->first + j, Vec3Dot(of->frame[i], image), INSERT_VALUES));
      }
  }
  PetscCall(MatAssemblyBegin(P, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(P, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* |G R x - P G x| over |G x|, largest entries, x at random */
static PetscErrorCode ImagesMeasure(Mat G, Mat R, Mat P, PetscReal *apart)
{
  PetscReal   size;
  PetscRandom random;
  Vec         x, Rx, y, Py;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(G, &x, &y));
  PetscCall(VecDuplicate(x, &Rx));
  PetscCall(VecDuplicate(y, &Py));
  PetscCall(PetscRandomCreate(PetscObjectComm((PetscObject)G), &random));
  PetscCall(VecSetRandom(x, random));
  PetscCall(PetscRandomDestroy(&random));
  PetscCall(MatMult(G, x, y));
  PetscCall(VecNorm(y, NORM_INFINITY, &size));
  PetscCall(MatMult(P, y, Py));
  PetscCall(MatMult(R, x, Rx));
  PetscCall(MatMult(G, Rx, y));
  PetscCall(VecAXPY(y, -1, Py));
  PetscCall(VecNorm(y, NORM_INFINITY, apart));
  if (size > 0) *apart /= size;
  for (Vec *v[] = {&x, &Rx, &y, &Py, NULL}, **w = v; *w; w++) PetscCall(VecDestroy(*w));
  PetscFunctionReturn(0);
}

/* Raises the error for pairs that are not their own mirror image */
static PetscErrorCode ImagesCheck(const PairRows *rows, const ModelPlane *plane, Mat R, Mat P)
{
  PetscReal apart[2] = {0, 0};

  PetscFunctionBeginUser;
  PetscCall(ImagesMeasure(rows->G, R, P, &apart[0]));
  if (rows->S) PetscCall(ImagesMeasure(rows->S, R, P, &apart[1]));
  PetscCheck(apart[0] <= MIRROR_FRAME && apart[1] <= MIRROR_FRAME, rows->comm, PETSC_ERR_USER_INPUT,
             "-symmetry %c: the pairs of the contact are not their own mirror image in %c = %g m: %s differ by %.1e",
             "xyz"[plane->axis], "xyz"[plane->axis], (double)plane->at,
             apart[0] > MIRROR_FRAME ? "normals, or what slaves are projected on," : "slip directions",
             (double)PetscMax(apart[0], apart[1]));
  PetscFunctionReturn(0);
}

/* P of one plane */
static PetscErrorCode ImagesCreate(const PairRows *rows, const ModelPlane *plane, Mat R, PetscInt n,
                                   const ImagePair all[], Mat *P)
{
  PetscInt         alone; /* the same pair on any number of ranks */
  const ImagePair *pair;

  PetscFunctionBeginUser;
  PetscCall(MatCreateAIJ(rows->comm, rows->n, rows->n, PETSC_DETERMINE, PETSC_DETERMINE, 4, NULL, 3, NULL, P));
  PetscCall(ImagesFill(rows, plane, n, all, *P, &alone));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &alone, 1, MPIU_INT, MPI_MIN, rows->comm));
  pair = &all[alone < n ? alone : 0];
  PetscCheck(alone == n, rows->comm, PETSC_ERR_USER_INPUT,
             "-symmetry %c: the pair at (%g, %g, %g) m has no mirror image of the same friction, stiffness and gap in the "
             "plane %c = %g m",
             "xyz"[plane->axis], (double)pair->x[0], (double)pair->x[1], (double)pair->x[2], "xyz"[plane->axis],
             (double)plane->at);
  PetscCall(ImagesCheck(rows, plane, R, *P));
  PetscFunctionReturn(0);
}

/* even (1 + P) / 2 in the place of even, where NULL is the identity */
static PetscErrorCode EvenTimes(Mat P, Mat *even)
{
  Mat half, product;

  PetscFunctionBeginUser;
  PetscCall(MatDuplicate(P, MAT_COPY_VALUES, &half));
  PetscCall(MatScale(half, 0.5));
  PetscCall(MatShift(half, 0.5));
  if (*even) {
    PetscCall(MatMatMult(*even, half, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &product));
    PetscCall(MatProductClear(product));
    PetscCall(MatDestroy(&half));
    PetscCall(MatDestroy(even));
    half = product;
  }
  *even = half;
  PetscFunctionReturn(0);
}

PetscErrorCode PairRowsCreateOdd(Operators operators, const PetscReal p[], const PairRows *rows, Mat *odd)
{
  const ModelPlane *plane;
  const Mat        *R;
  PetscInt          n_planes, n;
  ImagePair       *all;

  PetscFunctionBeginUser;
  *odd = NULL;
  PetscCall(OperatorsGetMirrors(operators, &n_planes, &plane, &R));
  if (!n_planes) PetscFunctionReturn(0);
  PetscCall(ImagesGather(operators, p, rows, &n, &all));
  for (PetscInt i = 0; i < n_planes; i++) {
    Mat P;

    PetscCall(ImagesCreate(rows, &plane[i], R[i], n, all, &P));
    PetscCall(EvenTimes(P, odd));
    PetscCall(MatDestroy(&P));
  }
  PetscCall(PetscFree(all));
  PetscCall(MatScale(*odd, -MIRROR_COMPLIANCE));
  PetscCall(MatShift(*odd, MIRROR_COMPLIANCE));
  PetscFunctionReturn(0);
}
