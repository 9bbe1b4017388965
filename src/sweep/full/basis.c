/*
   The vectors of a point of a sweep in full as coordinates in an orthonormal basis that they share with those of the
   point before, and the pencil between the vectors of this basis.
*/
#include "follow.h"
#include "base/algebra/dense.h"
#include "solver/block/orthonormal.h"

/* Directions of the basis that are left out beside the longest vector. Products of modes are compared with
   thresholds of 0.1 and more, and 1e-8 is far below them. */
#define FOLLOW_DROP  1e-8
#define FOLLOW_PARTS 4 /* real and imaginary parts of right and left vectors */
#define FOLLOW_SUMS  5 /* K, friction, M and both C */

/* The columns xr, xi, yr, yi of each mode of the eigensolver, as far as there are any */
typedef struct {
  BV        block;
  PetscInt *column; /* [n][FOLLOW_PARTS] or -1 */
} ModeColumns;

static PetscErrorCode ColumnsCreate(Modes modes, PetscInt n, ModeColumns *columns)
{
  Vec      part[FOLLOW_PARTS];
  PetscInt m = 0;

  PetscFunctionBeginUser;
  PetscCall(ModesGetVectors(modes, 0, &part[0], NULL, NULL, NULL));
  PetscCall(BVCreate(PetscObjectComm((PetscObject)part[0]), &columns->block));
  PetscCall(BVSetType(columns->block, BVMAT));
  PetscCall(BVSetSizesFromVec(columns->block, part[0], FOLLOW_PARTS * n));
  PetscCall(PetscMalloc1(FOLLOW_PARTS * n, &columns->column));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(ModesGetVectors(modes, i, &part[0], &part[1], &part[2], &part[3]));
    for (int k = 0; k < FOLLOW_PARTS; k++) {
      columns->column[FOLLOW_PARTS * i + k] = part[k] ? m : -1;
      if (part[k]) PetscCall(BVInsertVec(columns->block, m++, part[k]));
    }
  }
  PetscCall(BVSetActiveColumns(columns->block, 0, m));
  PetscFunctionReturn(0);
}

/* Coordinates re + i im from the columns of H [.][size] */
static void TakeCoordinates(PetscInt size, const PetscScalar H[], const PetscInt column[2], PetscComplex x[])
{
  for (PetscInt r = 0; r < size; r++)
    x[r] = CMPLX(H[column[0] * size + r], column[1] < 0 ? 0 : H[column[1] * size + r]);
}

/* V = [V0, Q], orthonormal in the plain dot product, of n0 vectors and what the columns hold beyond them, which they
   are replaced by; H [.][size] are their coordinates, size that of V: columns = V H. The columns of H were made with
   room for n0 + m rows and are moved together to size rows, from the first on, each to the left of where it was. */
static PetscErrorCode BasisJoin(BV V0, PetscInt n0, BV block, BV *V, PetscScalar **H, PetscInt *size)
{
  PetscInt     m, n;
  BlockFactors factors = {.drop = FOLLOW_DROP};

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(block, NULL, &m));
  factors.ld   = n0 + m;
  factors.most = m;
  PetscCall(PetscCalloc1(m * factors.ld, &factors.H));
  PetscCall(BlockFactorise(V0, n0, NULL, block, &factors));
  PetscCall(BVGetActiveColumns(block, NULL, &n));
  *size = n0 + n;
  PetscCall(BlockCreate(block, *size, V));
  if (n0) PetscCall(BVSetActiveColumns(V0, 0, n0));
  if (n0) PetscCall(BVSetActiveColumns(*V, 0, n0));
  if (n0) PetscCall(BVCopy(V0, *V));
  PetscCall(BVSetActiveColumns(*V, n0, *size));
  PetscCall(BVCopy(block, *V));
  PetscCall(BVSetActiveColumns(*V, 0, *size));
  for (PetscInt j = 1; j < m; j++) PetscCall(PetscArraymove(factors.H + j * *size, factors.H + j * factors.ld, *size));
  *H = factors.H;
  PetscFunctionReturn(0);
}

/* The modes as the eigensolver has them, with vectors as coordinates in V; those of rank 0 for all, as sums of dot
   products may differ in the last digit. The memory gets room for as many branches as there are modes. */
PetscErrorCode FollowRead(Sweep sweep, const FollowPoint *from, const ReducedModes *found, FollowPoint *point)
{
  ModeColumns   columns;
  ReducedModes *modes = &point->modes;
  PetscScalar  *H;
  PetscInt      size;

  PetscFunctionBeginUser;
  PetscCall(ColumnsCreate(sweep->modes, found->n, &columns));
  PetscCall(
    BasisJoin(from ? from->vectors : NULL, from ? from->modes.size : 0, columns.block, &point->vectors, &H, &size));
  PetscCall(ReducedModesCreate(found->n, size, modes));
  for (PetscInt i = 0; i < found->n; i++) {
    modes->lambda[i] = found->lambda[i];
    modes->error[i]  = found->error[i];
    modes->rigid[i]  = found->rigid[i];
    TakeCoordinates(size, H, &columns.column[FOLLOW_PARTS * i], modes->x + i * size);
    TakeCoordinates(size, H, &columns.column[FOLLOW_PARTS * i + 2], modes->y + i * size);
  }
  PetscCall(ReducedModesBroadcast(sweep->comm, 0, modes));
  PetscCall(ReducedModesCreate(found->n, size, &point->memory.modes));
  PetscCall(PetscMalloc1(found->n, &point->memory.branch));
  point->memory.modes.n = 0;
  PetscCall(PetscFree(H));
  PetscCall(PetscFree(columns.column));
  PetscCall(BVDestroy(&columns.block));
  PetscFunctionReturn(0);
}

/* A further V' A V of the model, alike on all ranks, with the parameter for a factor, -1 for none */
static PetscErrorCode ModelAdd(Mat A, OperatorsTermKind kind, PetscReal scale, PetscInt parameter, BV V,
                               Reduced *reduced)
{
  const PetscInt n = reduced->n, t = reduced->n_terms;
  OperatorsTerm *term = (OperatorsTerm *)&reduced->term[t];
  PetscMPIInt    length;
  Mat            H;

  PetscFunctionBeginUser;
  if (!A) PetscFunctionReturn(0);
  *term = (OperatorsTerm){.kind = kind, .scale = scale, .n = parameter < 0 ? 0 : 1, .constraint = -1};
  term->factor[0].parameter = parameter;
  term->factor[0].power     = 1;
  reduced->n_terms++;
  PetscCall(PetscMPIIntCast(n * n, &length));
  PetscCall(PetscMalloc1(n * n, &reduced->A[t]));
  PetscCall(BlockProducts(V, A, V, &H));
  PetscCall(BlockCopy(H, PETSC_FALSE, n, reduced->A[t]));
  PetscCall(MatDestroy(&H));
  PetscCallMPI(MPI_Bcast(reduced->A[t], length, MPIU_REAL, 0, PetscObjectComm((PetscObject)V)));
  PetscFunctionReturn(0);
}

/* The matrices of a pencil in all unknowns: all of K where nothing is eliminated, else K and H */
static PetscErrorCode PencilGetAll(Pencil pencil, PencilParts *parts)
{
  PencilMatrices m;
  PetscInt       all, kept;

  PetscFunctionBeginUser;
  PetscCall(PencilGetMatrices(pencil, &m));
  PetscCall(MatGetSize(m.K, &kept, NULL));
  PetscCall(PencilGetMass(pencil, &parts->M));
  PetscCall(MatGetSize(parts->M, &all, NULL));
  if (kept != all) PetscCall(PencilGetParts(pencil, parts));
  if (kept == all) *parts = (PencilParts){.K = m.K, .M = m.M, .C = m.C};
  PetscFunctionReturn(0);
}

/* The model between the two points, all V' A V [n][n] with V orthonormal: K, mu H and M of this point, C of this
   one with the factor p[0] and C of the one before with p[1]. Frames take (0, 1) for the point before and (1, 0)
   for this one: each has its own damping, both the stiffness and mass of the later one. C is copied, as the pencil
   is gone when the next point is solved. */
PetscErrorCode FollowModel(Pencil pencil, const FollowPoint *from, FollowPoint *point, Reduced *reduced)
{
  const PetscInt n = point->modes.size;
  PencilParts    parts;
  OperatorsTerm *term;

  PetscFunctionBeginUser;
  PetscCall(PencilGetAll(pencil, &parts));
  if (parts.C) PetscCall(MatDuplicate(parts.C, MAT_COPY_VALUES, &point->C));
  PetscCall(PetscCalloc1(FOLLOW_SUMS, &term));
  *reduced = (Reduced){.n = n, .n_used = n, .n_parameters = 2, .term = term};
  PetscCall(PetscCalloc1(FOLLOW_SUMS, &reduced->A));
  if (!from) PetscFunctionReturn(0);
  PetscCall(ModelAdd(parts.K, OPERATORS_STIFFNESS, 1, -1, point->vectors, reduced));
  PetscCall(ModelAdd(parts.H, OPERATORS_STIFFNESS, parts.mu, -1, point->vectors, reduced));
  PetscCall(ModelAdd(parts.M, OPERATORS_MASS, 1, -1, point->vectors, reduced));
  PetscCall(ModelAdd(parts.C, OPERATORS_DAMPING, 1, 0, point->vectors, reduced));
  PetscCall(ModelAdd(from->C, OPERATORS_DAMPING, 1, 1, point->vectors, reduced));
  PetscFunctionReturn(0);
}

PetscErrorCode FollowModelDestroy(Reduced *reduced)
{
  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < reduced->n_terms; t++) PetscCall(PetscFree(reduced->A[t]));
  PetscCall(PetscFree(reduced->A));
  PetscCall(PetscFree(reduced->term));
  PetscFunctionReturn(0);
}

/* The modes in another basis: coordinates filled up with zeros where that has more vectors (U = NULL), or U' x with
   U [size][old] orthonormal rows. Products and noise are not taken along; frames do not read them. */
PetscErrorCode FollowMove(const ReducedModes *modes, PetscInt size, const PetscReal U[], ReducedModes *to)
{
  const PetscInt   n = modes->n, old = modes->size;
  const DenseBlock block = {U, size, old, old};

  PetscFunctionBeginUser;
  PetscCall(ReducedModesCreate(n, size, to));
  for (PetscInt i = 0; i < n; i++) {
    to->lambda[i] = modes->lambda[i];
    to->error[i]  = modes->error[i];
    to->rigid[i]  = modes->rigid[i];
    if (U) continue;
    PetscCall(PetscArraycpy(to->x + i * size, modes->x + i * old, old));
    PetscCall(PetscArraycpy(to->y + i * size, modes->y + i * old, old));
  }
  if (U) PetscCall(DenseTimes(&block, PETSC_TRUE, n, modes->x, to->x));
  if (U) PetscCall(DenseTimes(&block, PETSC_TRUE, n, modes->y, to->y));
  PetscFunctionReturn(0);
}

/* The same in place */
static PetscErrorCode ModesTurn(PetscInt size, const PetscReal U[], ReducedModes *modes)
{
  ReducedModes old = *modes;

  PetscFunctionBeginUser;
  PetscCall(FollowMove(&old, size, U, modes));
  PetscCall(ReducedModesDestroy(&old));
  PetscFunctionReturn(0);
}

/* V keeps what the modes and the remembered branches span, at most 4 real vectors each, by an orthonormal basis U
   of their coordinates; else it would grow from point to point. Rank 0's U is that of all. */
PetscErrorCode FollowShrink(FollowPoint *point)
{
  const PetscInt      size = point->modes.size, n = point->modes.n, n_all = n + point->memory.modes.n;
  const PetscComplex *from[4] = {point->modes.x, point->modes.y, point->memory.modes.x, point->memory.modes.y};
  PetscComplex       *Z, *to;
  const MPI_Comm      comm = PetscObjectComm((PetscObject)point->vectors);
  PetscReal          *U;
  PetscInt            kept;
  BV                  shrunk;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(4 * n_all * size, &Z));
  to = Z;
  for (int k = 0; k < 4; k++)
    for (PetscInt i = 0; i < (k < 2 ? n : n_all - n) * size; i++, to++) {
      to[0]                = creal(from[k][i]);
      to[2 * n_all * size] = cimag(from[k][i]);
    }
  PetscCall(DenseOrthonormalise(size, 4 * n_all, FOLLOW_DROP, Z, &kept));
  PetscCallMPI(MPI_Bcast(&kept, 1, MPIU_INT, 0, comm)); /* collective calls depend on it */
  PetscCall(PetscMalloc1(kept * size, &U));
  for (PetscInt i = 0; i < kept * size; i++) U[i] = creal(Z[i]);
  PetscCallMPI(MPI_Bcast(U, (PetscMPIInt)(kept * size), MPIU_REAL, 0, comm));
  PetscCall(BlockCreate(point->vectors, kept, &shrunk));
  PetscCall(BlockLift(point->vectors, size, kept, U, shrunk));
  PetscCall(BVDestroy(&point->vectors));
  point->vectors = shrunk;
  PetscCall(ModesTurn(kept, U, &point->modes));
  PetscCall(ModesTurn(kept, U, &point->memory.modes));
  PetscCall(ReducedModesBroadcast(comm, 0, &point->modes));
  PetscCall(ReducedModesBroadcast(comm, 0, &point->memory.modes));
  PetscCall(PetscFree(U));
  PetscCall(PetscFree(Z));
  PetscFunctionReturn(0);
}
