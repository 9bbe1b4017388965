/*
   Residuals r = Q(lambda) x, s = Q(lambda)' y of the modes of a projection, all modes together, and vectors from it.
   See project.c.
*/
#include "projection.h"
#include "base/events.h"
#include "solver/block/orthonormal.h"
#include "basis/residual.h"

#define CORRECT_BELOW 0.5 /* of the limit of backward errors: residuals below it are no concern */

/* Vectors of the modes of one side as real columns, those with backward errors above the limit */
static PetscErrorCode SideCollect(const ProjectionModes *modes, PetscBool left, PetscReal limit, ComplexColumns *c)
{
  PetscFunctionBeginUser;
  PetscCall(ComplexColumnsCreate(modes->n, modes->size, c));
  for (PetscInt i = 0; i < modes->n; i++) {
    const PetscBool is_real = cimag(modes->lambda[i]) == 0 ? PETSC_TRUE : PETSC_FALSE;

    if (modes->backward[left][i] <= limit) continue;
    PetscCall(ComplexColumnsAdd(c, modes->lambda[i], is_real, &modes->vectors[left][i * modes->size]));
  }
  PetscFunctionReturn(0);
}

/* Backward errors of the modes that are among the columns, those above the limit, from the norms of vectors and
   residuals; tolerance[columns] = what may remain of a residual, infinite where nothing needs to be done */
static void SideMeasure(const Projection *p, PetscBool left, const ComplexColumns *c, const PetscReal *const norms[2],
                        ProjectionModes *modes, PetscReal tolerance[])
{
  const PetscReal *x = norms[0], *r = norms[1];
  PetscReal       *backward = modes->backward[left];

  for (PetscInt i = 0, k = 0; i < modes->n; i++) {
    const PetscReal size  = cabs(modes->lambda[i]);
    const PetscReal bound = size * size * p->norms[2] + size * p->norms[1] + p->norms[0];
    PetscReal       length, remains;
    PetscInt        at, two;

    if (backward[i] <= p->limit[left]) continue;
    at          = c->column[k];
    two         = c->column[++k] - at == 2;
    length      = bound * hypot(x[at], two ? x[at + 1] : 0);
    backward[i] = hypot(r[at], two ? r[at + 1] : 0) / length;
    remains     = PetscMax(CORRECT_BELOW * p->limit[left], PROJECTION_KEEP * backward[i]) * length;
    if (backward[i] <= p->limit[left] || (p->window->known.rigid && size <= p->window->known.scale)) remains = INFINITY;
    for (PetscInt j = at; j <= at + two; j++) tolerance[j] = remains;
  }
}

/* The eigenvalues of what SideKeep() leaves */
static PetscErrorCode SideLambdas(const ComplexColumns *c, const PetscReal tolerance[], PetscComplex **lambda)
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(c->m, lambda));
  for (PetscInt i = 0; i < c->m; i++)
    if (isfinite(tolerance[c->column[i]])) (*lambda)[n++] = c->lambda[i];
  PetscFunctionReturn(0);
}

/* Leaves the columns with a finite tolerance */
static PetscErrorCode SideKeep(BV residuals, PetscReal tolerance[])
{
  PetscInt n, kept = 0;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(residuals, NULL, &n));
  for (PetscInt j = 0; j < n; j++) {
    if (!isfinite(tolerance[j])) continue;
    if (kept < j) PetscCall(BVCopyColumn(residuals, j, kept));
    tolerance[kept++] = tolerance[j];
  }
  PetscCall(BVSetActiveColumns(residuals, 0, kept));
  PetscFunctionReturn(0);
}

/* Residuals of one side that are still too large, with what may remain of them; NULL where all have settled */
static PetscErrorCode SideResiduals(const Projection *p, PetscBool left, ProjectionModes *modes, BV *residuals,
                                    PetscReal **tolerance, PetscComplex **lambda)
{
  const PencilMatrices side = {.K      = ProjectionMatrix(p, SUBSPACE_K, left),
                               .C      = ProjectionMatrix(p, SUBSPACE_C, left),
                               .M      = ProjectionMatrix(p, SUBSPACE_M, left),
                               .K_even = p->pencil->K_even,
                               .left   = p->pencil->left,
                               .right  = p->pencil->right,
                               .n_laws = p->pencil->n_laws,
                               .law    = left ? p->space.turned : p->pencil->law};
  ComplexColumns       columns;
  PetscReal           *norms[2];
  BV                   vectors;
  Mat                  X, R;

  PetscFunctionBeginUser;
  *residuals = NULL;
  *tolerance = NULL;
  *lambda    = NULL;
  PetscCall(SideCollect(modes, left, p->limit[left], &columns));
  if (columns.m) {
    PetscCall(BlockCreate(p->space.V, columns.n_columns, residuals));
    PetscCall(ResidualMake(&side, PETSC_FALSE, &columns, p->space.V, &vectors, *residuals));
    PetscCall(BVGetMat(vectors, &X));
    PetscCall(BVGetMat(*residuals, &R));
    PetscCall(PetscMalloc1(columns.n_columns, tolerance));
    PetscCall(PetscMalloc2(columns.n_columns, &norms[0], columns.n_columns, &norms[1]));
    PetscCall(MatGetColumnNorms(X, NORM_2, norms[0]));
    PetscCall(MatGetColumnNorms(R, NORM_2, norms[1]));
    SideMeasure(p, left, &columns, (const PetscReal *[2]){norms[0], norms[1]}, modes, *tolerance);
    PetscCall(PetscFree2(norms[0], norms[1]));
    PetscCall(BVRestoreMat(*residuals, &R));
    PetscCall(BVRestoreMat(vectors, &X));
    PetscCall(BVDestroy(&vectors));
    PetscCall(SideLambdas(&columns, *tolerance, lambda));
    PetscCall(SideKeep(*residuals, *tolerance));
  }
  PetscCall(ComplexColumnsDestroy(&columns));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionCorrect(Projection *p, ProjectionModes *modes, PetscInt *n_columns)
{
  BV            block[2]     = {NULL, NULL};
  PetscReal    *tolerance[2] = {NULL, NULL};
  PetscComplex *lambda[2]    = {NULL, NULL};

  PetscFunctionBeginUser;
  *n_columns = 0;
  if (!modes->n) PetscFunctionReturn(0);
  PetscCall(EventBegin(EVENT_CORRECT));
  PetscCall(SideResiduals(p, PETSC_FALSE, modes, &block[0], &tolerance[0], &lambda[0]));
  if (p->modes->left) PetscCall(SideResiduals(p, PETSC_TRUE, modes, &block[1], &tolerance[1], &lambda[1]));
  if (p->about)
    PetscCall(ProjectionExtendAbout(p, block, tolerance, lambda, n_columns));
  else
    PetscCall(ProjectionExtend(p, block, tolerance, n_columns));
  for (int side = 0; side < 2; side++) {
    PetscCall(BVDestroy(&block[side]));
    PetscCall(PetscFree(tolerance[side]));
    PetscCall(PetscFree(lambda[side]));
  }
  PetscCall(EventEnd(EVENT_CORRECT));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionLift(const Projection *p, const ProjectionModes *modes, PetscBool left, Spectrum *s)
{
  ComplexColumns c;
  BV             vectors;

  PetscFunctionBeginUser;
  PetscCall(SideCollect(modes, left, -1, &c));
  PetscCall(BlockCreate(p->space.V, PetscMax(1, c.n_columns), &vectors)); /* the window may hold no mode */
  if (c.n_columns) PetscCall(BlockLift(p->space.V, c.size, c.n_columns, c.coordinates, vectors));
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
  PetscCall(ComplexColumnsDestroy(&c));
  PetscFunctionReturn(0);
}
