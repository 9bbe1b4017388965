/*
   Corrections of the modes of a projection: residuals r = Q(lambda) x, s = Q(lambda)' y, and P^-1 r, P^-T s with
   P = K - s M, all modes together. See project.c.
*/
#include "projection.h"
#include "base/events.h"
#include "solver/orthonormal.h"
#include "solver/residual.h"

#define CORRECT_DROP 1e-13 /* M-norm of corrections to vectors of length one: less is rounding */

/* Vectors of the modes of one side as real columns, those with backward errors above the limit */
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

/* Backward errors of the modes that are among the columns, those above the limit, from the norms of vectors and
   residuals; wanted[columns] = those still above it */
static PetscErrorCode SideMeasure(const Projection *p, PetscBool left, const ComplexColumns *c,
                                  const PetscReal *const norms[2], ProjectionModes *modes, PetscBool wanted[])
{
  const PetscReal *x = norms[0], *r = norms[1];
  PetscReal       *backward = modes->backward[left];

  PetscFunctionBeginUser;
  for (PetscInt i = 0, k = 0; i < modes->n; i++) {
    const PetscReal size  = cabs(modes->lambda[i]);
    const PetscReal bound = size * size * p->norms[2] + size * p->norms[1] + p->norms[0];
    PetscInt        at, two;

    if (backward[i] <= p->limit[left]) continue;
    at          = c->column[k];
    two         = c->column[k + 1] - at == 2;
    backward[i] = hypot(r[at], two ? r[at + 1] : 0) / (bound * hypot(x[at], two ? x[at + 1] : 0));
    wanted[k++] =
      backward[i] > p->limit[left] && (!p->window->rigid || size > p->window->scale) ? PETSC_TRUE : PETSC_FALSE;
  }
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
static PetscErrorCode SideCorrect(const Projection *p, PetscBool left, ProjectionModes *modes, BV *corrections)
{
  const PencilMatrices side = {.K         = left ? p->transposed[0] : p->pencil->K,
                               .C         = left ? p->transposed[1] : p->pencil->C,
                               .M         = left ? p->transposed[2] : p->pencil->M,
                               .symmetric = p->pencil->symmetric};
  ComplexColumns       columns;
  PetscReal           *coordinates, *norms[2];
  PetscBool           *wanted;
  BV                   vectors, residuals;
  Mat                  X, R;

  PetscFunctionBeginUser;
  *corrections = NULL;
  PetscCall(SideCollect(modes, left, p->limit[left], &columns, &coordinates));
  if (columns.m) {
    PetscCall(ProjectionCreateBlock(p, columns.n_columns, &vectors));
    PetscCall(ProjectionCreateBlock(p, columns.n_columns, &residuals));
    PetscCall(BlockLift(p->V, p->k, columns.n_columns, coordinates, vectors));
    PetscCall(BVGetMat(vectors, &X));
    PetscCall(BVGetMat(residuals, &R));
    PetscCall(PetscMalloc1(columns.m, &wanted));
    PetscCall(ResidualMake(&side, PETSC_FALSE, &columns, X, R));
    PetscCall(PetscMalloc2(columns.n_columns, &norms[0], columns.n_columns, &norms[1]));
    PetscCall(MatGetColumnNorms(X, NORM_2, norms[0]));
    PetscCall(MatGetColumnNorms(R, NORM_2, norms[1]));
    PetscCall(SideMeasure(p, left, &columns, (const PetscReal *[2]){norms[0], norms[1]}, modes, wanted));
    PetscCall(PetscFree2(norms[0], norms[1]));
    PetscCall(BVRestoreMat(residuals, &R));
    PetscCall(BVRestoreMat(vectors, &X));
    PetscCall(SideSolve(p, left, &columns, wanted, residuals, corrections));
    PetscCall(PetscFree(wanted));
    PetscCall(BVDestroy(&vectors));
    PetscCall(BVDestroy(&residuals));
  }
  PetscCall(PetscFree(coordinates));
  PetscCall(ComplexColumnsDestroy(&columns));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionCorrect(Projection *p, ProjectionModes *modes, PetscInt *n_columns)
{
  BV block[2] = {NULL, NULL};

  PetscFunctionBeginUser;
  *n_columns = 0;
  if (!modes->n) PetscFunctionReturn(0);
  PetscCall(EventBegin(EVENT_CORRECT));
  PetscCall(SideCorrect(p, PETSC_FALSE, modes, &block[0]));
  if (p->modes->left) PetscCall(SideCorrect(p, PETSC_TRUE, modes, &block[1]));
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

/* Whether a mode of the undamped problem is in the window */
static PetscBool StartsWith(const Projection *p, const Spectrum *s, PetscInt i)
{
  const Window *w = p->window;

  return w->count || (s->omega[i] >= w->edge[0] && s->omega[i] <= w->edge[1]) ? PETSC_TRUE : PETSC_FALSE;
}

/* Z = P^-1 C x, or P^-T C' y, scaled to what lambda of the window's upper end makes of it beside |x|_M = 1 */
static PetscErrorCode StartSide(Projection *p, PetscBool left, const Spectrum *s)
{
  const PetscReal top = PetscMax(p->window->high, p->window->target);
  PetscInt        n   = 0;
  BV              rest, corrections;
  Mat             B, Z;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < s->n; i++) n += StartsWith(p, s, i) ? (s->xi[i] ? 2 : 1) : 0;
  if (!n) PetscFunctionReturn(0);
  PetscCall(ProjectionCreateBlock(p, n, &rest));
  PetscCall(ProjectionCreateBlock(p, n, &corrections));
  n = 0;
  for (PetscInt i = 0; i < s->n; i++)
    for (int part = 0; part < 2 && StartsWith(p, s, i); part++) {
      const Vec x = part ? s->xi[i] : s->xr[i];
      Vec       b;
      PetscReal square;

      if (!x) continue;
      PetscCall(BVGetColumn(rest, n, &b));
      PetscCall(MatMult(p->pencil->M, x, b));
      PetscCall(VecDot(b, x, &square));
      PetscCall(MatMult(left ? p->transposed[1] : p->pencil->C, x, b));
      PetscCall(VecScale(b, square > 0 ? top / PetscSqrtReal(square) : 0));
      PetscCall(BVRestoreColumn(rest, n++, &b));
    }
  PetscCall(BVGetMat(rest, &B));
  PetscCall(BVGetMat(corrections, &Z));
  PetscCall(ShiftInvertApplyBlock(&p->si, left, B, Z));
  PetscCall(BVRestoreMat(corrections, &Z));
  PetscCall(BVRestoreMat(rest, &B));
  PetscCall(ProjectionAdd(p, CORRECT_DROP, corrections, NULL));
  PetscCall(BVDestroy(&rest));
  PetscCall(BVDestroy(&corrections));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionStart(Projection *p, const Spectrum *right, const Spectrum *left)
{
  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_CORRECT));
  PetscCall(StartSide(p, PETSC_FALSE, right));
  if (left->n) PetscCall(StartSide(p, PETSC_TRUE, left));
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
