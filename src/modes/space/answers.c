/*
   Answers of the pencil to forces b on a space V, by the factors P that found its modes. Galerkin's answer at lambda
   leaves the residual

      r(lambda) = b - Q(lambda) V c,   V' Q(lambda) V c = V' b,

   of the transposed pencil for the left side, and V takes in P^-1 r of all lambda of interest, P = K - s M. It is
   that of few directions: where V holds the right vectors of an undamped pencil alone, Q(lambda) differs from P by a
   multiple of M, all r are multiples of one vector for each b, and the steps are those of Krylov's method with P^-1 M
   that leaves out the modes (A. Ruhe, Linear Algebra Appl. 58, 1984). Left vectors in V bring others, and so does what
   of C is no combination of M and K, as P^-1 C is a second generator then; singular values tell which matter. So the
   factors that found the modes will do with damping, too, which needs none of Q at a complex shift.

   The frequencies at which residuals are looked at lie off the axis, where no mode outweighs all others.
*/
#include "answers.h"
#include "basis/residual.h"
#include "solver/block/orthonormal.h"

#define ANSWER_LOOKS 3
#define OFF_AXIS     0.2 /* of the frequency: growth of a look */

PetscErrorCode ModesSpaceAddModes(ModesSpace *space, Modes modes, Pencil pencil, PetscBool left)
{
  const Mode *mode;
  PetscInt    n, column = 0;
  Vec         x[4], q;
  BV          block;

  PetscFunctionBeginUser;
  PetscCall(ModesGet(modes, &n, &mode));
  PetscCall(BlockCreate(space->space.V, 2 * n, &block));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(ModesGetVectors(modes, i, &x[0], &x[1], &x[2], &x[3]));
    for (int part = left ? 2 : 0; part < (left ? 4 : 2); part++) {
      if (!x[part]) continue;
      PetscCall(BVGetColumn(block, column, &q));
      PetscCall(PencilRestrict(pencil, x[part], q));
      PetscCall(BVRestoreColumn(block, column++, &q));
    }
  }
  PetscCall(BVSetActiveColumns(block, 0, column));
  PetscCall(ModesSpaceAdd(space, block));
  PetscCall(BVDestroy(&block));
  PetscFunctionReturn(0);
}

/* The coordinates of the answers at one lambda as further columns of both sides; nothing where lambda is a pole */
static PetscErrorCode LookAdd(const ModesAnswers *a, PetscComplex lambda, PetscReal *const forces[2],
                              ComplexColumns columns[2])
{
  const DensePencil q = SubspacePencil(&a->space->space);
  PetscComplex     *Q, *c;
  PetscBLASInt     *pivot;
  PetscBool         pole;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(q.n * q.n, &Q, q.n, &pivot, q.n, &c));
  DensePencilEvaluate(&q, lambda, 0, q.n, Q);
  PetscCall(DenseComplexFactor(q.n, Q, pivot, &pole));
  for (int side = 0; side < 2 && !pole; side++)
    for (PetscInt j = 0; j < a->n[side]; j++) {
      for (PetscInt i = 0; i < q.n; i++) c[i] = forces[side][j * q.n + i];
      PetscCall(DenseComplexSolve(q.n, Q, pivot, side ? PETSC_TRUE : PETSC_FALSE, 1, c));
      PetscCall(ComplexColumnsAdd(&columns[side], lambda, PETSC_FALSE, c));
    }
  PetscCall(PetscFree3(Q, pivot, c));
  PetscFunctionReturn(0);
}

/* The matrices of the pencil, or those of the transposed one */
static PencilMatrices SideOf(const ModesSpace *space, PetscBool left)
{
  const SubspaceTerm *term = space->space.term;
  PencilMatrices      side = space->pencil;

  if (!left) return side;
  side.K   = term[SUBSPACE_K].transposed; /* K_even where friction is apart, to which ResidualMake() puts the rest */
  side.C   = term[SUBSPACE_C].transposed;
  side.M   = term[SUBSPACE_M].transposed;
  side.law = space->space.turned;
  return side;
}

/* The directions of what the answers of a side leave of its forces; real and imaginary part count by the length of
   both */
static PetscErrorCode AnswersLeave(const ModesAnswers *a, int side, const ComplexColumns *columns, BV R)
{
  const PencilMatrices pencil = SideOf(a->space, side ? PETSC_TRUE : PETSC_FALSE);
  PetscReal           *length, *sigma;
  BV                   answers;

  PetscFunctionBeginUser;
  PetscCall(ResidualMake(&pencil, PETSC_FALSE, columns, a->space->space.V, &answers, R));
  PetscCall(BVDestroy(&answers));
  PetscCall(PetscMalloc2(columns->n_columns, &length, columns->n_columns, &sigma));
  for (PetscInt k = 0; k < columns->m; k++) {
    Vec r;

    PetscCall(BVGetColumn(R, 2 * k, &r));
    PetscCall(VecAXPY(r, -1, a->b[side][k % a->n[side]]));
    PetscCall(BVRestoreColumn(R, 2 * k, &r));
    for (int part = 0; part < 2; part++) PetscCall(BVNormColumn(R, 2 * k + part, NORM_2, &length[2 * k + part]));
    length[2 * k] = a->keep * hypot(length[2 * k], length[2 * k + 1]);
    if (!(length[2 * k] > 0)) length[2 * k] = 1; /* nothing is left */
    length[2 * k + 1] = length[2 * k];
  }
  PetscCall(BlockCompress(NULL, length, R, sigma));
  PetscCall(PetscFree2(length, sigma));
  PetscFunctionReturn(0);
}

/* What is to be solved for: directions of what answers on the space leave of the forces */
static PetscErrorCode AnswersRemain(const ModesAnswers *a, BV R[2])
{
  PetscReal     *forces[2] = {NULL, NULL};
  ComplexColumns columns[2];

  PetscFunctionBeginUser;
  for (int side = 0; side < 2; side++) {
    PetscCall(ModesSpaceProducts(a->space, a->n[side], a->b[side], &forces[side]));
    PetscCall(ComplexColumnsCreate(ANSWER_LOOKS * a->n[side], a->space->space.n, &columns[side]));
  }
  for (int k = 0; k < ANSWER_LOOKS; k++)
    PetscCall(LookAdd(a, (OFF_AXIS + PETSC_i) * (a->edge[0] + (k + 0.5) / ANSWER_LOOKS * (a->edge[1] - a->edge[0])),
                      forces, columns));
  for (int side = 0; side < 2; side++) {
    if (columns[side].m) PetscCall(BlockCreate(a->space->space.V, columns[side].n_columns, &R[side]));
    if (columns[side].m) PetscCall(AnswersLeave(a, side, &columns[side], R[side]));
    PetscCall(ComplexColumnsDestroy(&columns[side]));
    PetscCall(PetscFree(forces[side]));
  }
  PetscFunctionReturn(0);
}

/* The forces themselves */
static PetscErrorCode AnswersBegin(const ModesAnswers *a, BV R[2])
{
  PetscFunctionBeginUser;
  for (int side = 0; side < 2; side++) {
    if (a->n[side]) PetscCall(BlockCreate(a->space->space.V, a->n[side], &R[side]));
    for (PetscInt j = 0; j < a->n[side]; j++) PetscCall(BVInsertVec(R[side], j, a->b[side][j]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ModesAnswersStep(ModesAnswers *a)
{
  PetscInt n[2] = {0, 0};
  BV       R[2] = {NULL, NULL}, block;

  PetscFunctionBeginUser;
  if (a->begun)
    PetscCall(AnswersRemain(a, R));
  else
    PetscCall(AnswersBegin(a, R));
  a->begun = PETSC_TRUE;
  for (int side = 0; side < 2; side++)
    if (R[side]) PetscCall(BVGetActiveColumns(R[side], NULL, &n[side]));
  *a->n_solves += n[0] + n[1];
  if (n[0] + n[1]) {
    PetscCall(BlockCreate(a->space->space.V, n[0] + n[1], &block));
    PetscCall(ResidualsSolve(&a->factor, R, block));
    PetscCall(ModesSpaceAdd(a->space, block));
    PetscCall(BVDestroy(&block));
  }
  for (int side = 0; side < 2; side++) PetscCall(BVDestroy(&R[side]));
  PetscFunctionReturn(0);
}
