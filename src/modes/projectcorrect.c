/*
   Corrections of the modes of a projection: residuals r = Q(lambda) x, s = Q(lambda)' y, and P^-1 r, P^-T s with
   P = K - s M, all modes together. See project.c.
*/
#include "projection.h"
#include "base/events.h"
#include "solver/orthonormal.h"
#include "solver/residual.h"

#define CORRECT_DROP 1e-13 /* M-norm of corrections to vectors of length one: less is rounding */

/* Vectors of the modes of one side as real columns, those with backward error above the limit or all where it is
   negative */
static PetscErrorCode SideCollect(const ProjectionModes *modes, PetscBool left, PetscReal limit, ComplexColumns *c,
                                  PetscReal **coordinates)
{
  const PetscInt size = modes->size;

  PetscFunctionBeginUser;
  PetscCall(ComplexColumnsCreate(modes->n, c));
  PetscCall(PetscMalloc1(2 * modes->n * size, coordinates));
  for (PetscInt i = 0; i < modes->n; i++) {
    const PetscComplex *x       = &modes->vectors[left][i * size];
    const PetscBool     is_real = cimag(modes->lambda[i]) == 0 ? PETSC_TRUE : PETSC_FALSE;

    if (modes->backward[left][i] <= limit) continue;
    for (PetscInt j = 0; j < size; j++) {
      (*coordinates)[c->n_columns * size + j] = creal(x[j]);
      if (!is_real) (*coordinates)[(c->n_columns + 1) * size + j] = cimag(x[j]);
    }
    ComplexColumnsAdd(c, modes->lambda[i], is_real);
  }
  PetscFunctionReturn(0);
}

/* Backward errors from the norms of the columns of residuals and vectors */
static PetscErrorCode SideMeasure(const Projection *p, const ComplexColumns *c, Mat X, Mat R, PetscReal backward[])
{
  PetscReal *x, *r;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(c->n_columns, &x, c->n_columns, &r));
  PetscCall(MatGetColumnNorms(X, NORM_2, x));
  PetscCall(MatGetColumnNorms(R, NORM_2, r));
  for (PetscInt i = 0; i < c->m; i++) {
    const PetscInt  at = c->column[i], two = c->column[i + 1] - at == 2;
    const PetscReal size  = cabs(c->lambda[i]);
    const PetscReal bound = size * size * p->norms[2] + size * p->norms[1] + p->norms[0];

    backward[i] = hypot(r[at], two ? r[at + 1] : 0) / (bound * hypot(x[at], two ? x[at + 1] : 0));
  }
  PetscCall(PetscFree2(x, r));
  PetscFunctionReturn(0);
}

/* Z = P^-1 R, or P^-T R, of the residuals that belong to modes not yet settled; n = their columns */
static PetscErrorCode SideSolve(const Projection *p, PetscBool left, const ComplexColumns *c, const PetscBool wanted[],
                                BV residuals, BV *corrections)
{
  PetscInt n = 0;
  Mat      B, Z;
  BV       chosen;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < c->m; i++) n += wanted[i] ? c->column[i + 1] - c->column[i] : 0;
  *corrections = NULL;
  if (!n) PetscFunctionReturn(0);
  PetscCall(ProjectionCreateBlock(p, n, &chosen));
  PetscCall(ProjectionCreateBlock(p, n, corrections));
  n = 0;
  for (PetscInt i = 0; i < c->m; i++)
    for (PetscInt j = c->column[i]; j < c->column[i + 1] && wanted[i]; j++) {
      Vec r;

      PetscCall(BVGetColumn(residuals, j, &r));
      PetscCall(BVInsertVec(chosen, n++, r));
      PetscCall(BVRestoreColumn(residuals, j, &r));
    }
  PetscCall(BVGetMat(chosen, &B));
  PetscCall(BVGetMat(*corrections, &Z));
  PetscCall(ShiftInvertApplyBlock(&p->si, left, B, Z));
  PetscCall(BVRestoreMat(*corrections, &Z));
  PetscCall(BVRestoreMat(chosen, &B));
  PetscCall(BVDestroy(&chosen));
  PetscFunctionReturn(0);
}

/* Residuals of one side; corrections is NULL where all have settled */
static PetscErrorCode SideCorrect(const Projection *p, PetscBool left, PetscReal limit, ProjectionModes *modes,
                                  BV *corrections)
{
  const PencilMatrices side = {.K         = left ? p->transposed[0] : p->pencil->K,
                               .C         = left ? p->transposed[1] : p->pencil->C,
                               .M         = left ? p->transposed[2] : p->pencil->M,
                               .symmetric = p->pencil->symmetric};
  ComplexColumns       columns;
  PetscReal           *coordinates;
  PetscBool           *wanted;
  BV                   vectors, residuals;
  Mat                  X, R;

  PetscFunctionBeginUser;
  PetscCall(SideCollect(modes, left, -1, &columns, &coordinates));
  PetscCall(ProjectionCreateBlock(p, columns.n_columns, &vectors));
  PetscCall(ProjectionCreateBlock(p, columns.n_columns, &residuals));
  PetscCall(BlockLift(p->V, p->k, columns.n_columns, coordinates, vectors));
  PetscCall(BVGetMat(vectors, &X));
  PetscCall(BVGetMat(residuals, &R));
  PetscCall(ResidualMake(&side, PETSC_FALSE, &columns, X, R));
  PetscCall(SideMeasure(p, &columns, X, R, modes->backward[left]));
  PetscCall(BVRestoreMat(residuals, &R));
  PetscCall(BVRestoreMat(vectors, &X));
  PetscCall(PetscMalloc1(modes->n, &wanted));
  for (PetscInt i = 0; i < modes->n; i++) wanted[i] = modes->backward[left][i] > limit ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(SideSolve(p, left, &columns, wanted, residuals, corrections));
  PetscCall(PetscFree(wanted));
  PetscCall(PetscFree(coordinates));
  PetscCall(ComplexColumnsDestroy(&columns));
  PetscCall(BVDestroy(&vectors));
  PetscCall(BVDestroy(&residuals));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionCorrect(Projection *p, const PetscReal limits[2], ProjectionModes *modes, PetscInt *n_columns)
{
  BV block[2] = {NULL, NULL};

  PetscFunctionBeginUser;
  *n_columns = 0;
  if (!modes->n) PetscFunctionReturn(0);
  PetscCall(EventBegin(EVENT_CORRECT));
  PetscCall(SideCorrect(p, PETSC_FALSE, limits[0], modes, &block[0]));
  if (p->modes->left) PetscCall(SideCorrect(p, PETSC_TRUE, limits[1], modes, &block[1]));
  for (int side = 0; side < 2; side++) {
    PetscInt n;

    if (!block[side]) continue;
    PetscCall(BVGetActiveColumns(block[side], NULL, &n));
    *n_columns += n;
    PetscCall(ProjectionAdd(p, CORRECT_DROP, block[side], NULL));
    PetscCall(BVDestroy(&block[side]));
  }
  PetscCall(EventEnd(EVENT_CORRECT));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionLift(const Projection *p, const ProjectionModes *modes, PetscBool left, Spectrum *s)
{
  ComplexColumns c;
  PetscReal     *coordinates;
  BV             vectors;

  PetscFunctionBeginUser;
  PetscCall(SideCollect(modes, left, -1, &c, &coordinates));
  PetscCall(ProjectionCreateBlock(p, c.n_columns, &vectors));
  PetscCall(BlockLift(p->V, p->k, c.n_columns, coordinates, vectors));
  PetscCall(SpectrumCreate(modes->n, s));
  for (PetscInt i = 0; i < modes->n; i++) {
    const PetscInt at = c.column[i], two = c.column[i + 1] - at == 2;
    Vec            x[2] = {NULL, NULL};

    for (PetscInt j = 0; j <= two; j++) PetscCall(BVGetColumn(vectors, at + j, &x[j]));
    PetscCall(SpectrumAdd(s, creal(modes->lambda[i]), cimag(modes->lambda[i]), x[0], x[1]));
    for (PetscInt j = 0; j <= two; j++) PetscCall(BVRestoreColumn(vectors, at + j, &x[j]));
  }
  PetscCall(SpectrumSort(s));
  PetscCall(BVDestroy(&vectors));
  PetscCall(PetscFree(coordinates));
  PetscCall(ComplexColumnsDestroy(&c));
  PetscFunctionReturn(0);
}
