/*
   Corrections of reduced eigenpairs on the mesh. At a point p of the parameters the basis gives lambda, x, y with
   residuals

      r = Q(lambda; p) x,   s = Q(lambda; p)' y,     z_r = P^-1 r,   z_s = P^-T s,

   where P = K - s M is factored at p once. What the basis lacks lies above the window, next to it first, hence the
   shift s at its upper end: a shift amid the window would let what is far above outweigh what is near. One solve of all
   right-hand sides together is a step of shift-and-invert subspace iteration from the basis' own vectors (Galerkin on
   [V, z_r, z_s]; compare M. E. Hochstenbach, G. L. G. Sleijpen, Linear Algebra Appl. 358, 2003, for two-sided subspace
   methods). The length of a correction, beside |x|_M = 1, is the error of the vector; the error of the eigenvalue is of
   second order, y'r being zero in Galerkin's method and s' Q^-1 r what remains.
*/
#include "correct.h"
#include "base/events.h"
#include "basis/residual.h"
#include "solver/block/orthonormal.h"

/* Relative move of the end of a band that an eigenvalue lies on, outwards at both ends, where K - s M would be
   singular; the basis is asked for the moved band. */
#define COUNT_AWAY   1e-7
#define ENERGY_LEAST 1e-4 /* modes below a hundredth of the window's end count as if they were there */

/* P = K - s M at p with s = high^2, (rad/s)^2. Damping is left out: P is then real, and symmetric without friction;
   the corrections differ by the factor P^-1 Q alone. Inertia is asked for, as the same factors count the modes
   below s. */
PetscErrorCode CorrectionFactor(Pencil pencil, const PetscReal p[], const ReducedWindow *window, Progress *progress,
                                Correction *c)
{
  const OperatorsParameter *parameters;
  PencilMatrices            undamped;
  PetscInt                  n;

  PetscFunctionBeginUser;
  PetscCall(PencilGetParameters(pencil, &n, &parameters, NULL));
  if (!c->p) PetscCall(PetscMalloc1(n, &c->p));
  PetscCall(PetscArraycpy(c->p, p, n));
  PetscCall(CorrectionMove(pencil, p, c));
  undamped           = c->matrices;
  undamped.C         = NULL;
  c->factor.progress = progress;
  c->factor.inertia  = PETSC_TRUE;
  PetscCall(ShiftInvertMove(&undamped, window->high * window->high, &c->factor));
  c->has_factor = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode CorrectionDestroy(Correction *c)
{
  PetscFunctionBeginUser;
  PetscCall(ShiftInvertDestroy(&c->factor));
  PetscCall(PetscFree(c->p));
  c->has_factor = PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode CorrectionMove(Pencil pencil, const PetscReal p[], Correction *c)
{
  PetscFunctionBeginUser;
  PetscCall(PencilSetParameters(pencil, p));
  PetscCall(PencilGetMatrices(pencil, &c->matrices));
  PetscFunctionReturn(0);
}

/* c of P^-1 Q from the coefficients alone: for sums P = sum_t a_t A_t and Q = sum_t b_t A_t of symmetric positive
   semidefinite A_t the eigenvalues of P^-1 Q lie between the least and the largest b_t / a_t, and c is at most
   their ratio. Friction and -s M are no such terms, for which it is an estimate. Infinite where a term comes, goes
   or changes its sign. */
PetscReal CorrectionSpread(const Correction *c, const Reduced *reduced, const PetscReal p[])
{
  PetscReal least = PETSC_MAX_REAL, largest = 0;

  for (PetscInt t = 0; t < reduced->n_terms; t++) {
    const OperatorsTerm *term = &reduced->term[t];
    const PetscReal      now = OperatorsTermCoefficient(term, p), then = OperatorsTermCoefficient(term, c->p);

    if (term->kind == OPERATORS_DAMPING || (now == 0 && then == 0)) continue;
    if (!(now * then > 0)) return INFINITY;
    least   = PetscMin(least, now / then);
    largest = PetscMax(largest, now / then);
  }
  return largest > 0 ? largest / least : 1;
}

/* Whether mode i needs vectors of its own: of a pair of conjugates of kappa, lambda and -conj(lambda), one is
   enough, as its real and imaginary parts span those of the other. */
static PetscBool ModeCounts(const ReducedModes *modes, PetscInt i, PetscBool damped)
{
  const PetscReal close = 1e-7 * cabs(modes->lambda[i]);

  if (damped || !i || creal(modes->lambda[i]) <= 0) return PETSC_TRUE;
  return cabs(modes->lambda[i] + conj(modes->lambda[i - 1])) > close ? PETSC_TRUE : PETSC_FALSE;
}

/* Frequencies of the modes of new columns, behind those of n columns that there are */
static PetscErrorCode OmegaAppend(const ComplexColumns *c, PetscInt n, PetscReal **omega)
{
  PetscFunctionBeginUser;
  PetscCall(PetscRealloc(sizeof(PetscReal) * (size_t)(n + c->n_columns), omega));
  for (PetscInt i = 0; i < c->m; i++)
    for (PetscInt j = c->column[i]; j < c->column[i + 1]; j++) (*omega)[n + j] = cabs(c->lambda[i]);
  PetscFunctionReturn(0);
}

/* The vectors as real columns */
static PetscErrorCode ColumnsCollect(const ReducedModes *modes, PetscBool damped, const PetscComplex vectors[],
                                     ComplexColumns *c)
{
  PetscFunctionBeginUser;
  PetscCall(ComplexColumnsCreate(modes->n, modes->size, c));
  for (PetscInt i = 0; i < modes->n; i++) {
    const PetscBool is_real = !damped && cimag(modes->lambda[i] * modes->lambda[i]) == 0 ? PETSC_TRUE : PETSC_FALSE;

    if (ModeCounts(modes, i, damped))
      PetscCall(ComplexColumnsAdd(c, modes->lambda[i], is_real, &vectors[i * modes->size]));
  }
  PetscFunctionReturn(0);
}

/* Makes room for m columns behind those that there are, which become the active ones */
static PetscErrorCode BlockAppend(const Basis *basis, PetscInt m, BV *side, PetscInt *n)
{
  PetscFunctionBeginUser;
  if (*side)
    PetscCall(BVResize(*side, *n + m, PETSC_TRUE));
  else
    PetscCall(BlockCreate(basis->space.V, m, side));
  PetscCall(BVSetActiveColumns(*side, *n, *n + m));
  *n += m;
  PetscFunctionReturn(0);
}

/* Residuals of right or left vectors */
static PetscErrorCode CollectSide(const Correction *c, const ReducedModes *modes, PetscBool left, const Basis *basis,
                                  CorrectionBlock *block)
{
  ComplexColumns columns;
  BV             vectors;

  PetscFunctionBeginUser;
  PetscCall(ColumnsCollect(modes, c->matrices.C ? PETSC_TRUE : PETSC_FALSE, left ? modes->y : modes->x, &columns));
  PetscCall(OmegaAppend(&columns, block->n[left], &block->omega[left]));
  PetscCall(BlockAppend(basis, columns.n_columns, &block->side[left], &block->n[left]));
  PetscCall(ResidualMake(&c->matrices, left, &columns, basis->space.V, &vectors, block->side[left]));
  PetscCall(BVDestroy(&vectors));
  PetscCall(ComplexColumnsDestroy(&columns));
  PetscFunctionReturn(0);
}

PetscErrorCode CorrectionCollect(const Correction *c, const ReducedModes *modes, CorrectionSides sides,
                                 const Basis *basis, CorrectionBlock *block)
{
  PetscFunctionBeginUser;
  if (!modes->n) PetscFunctionReturn(0);
  PetscCall(EventBegin(EVENT_CORRECT));
  if (sides != CORRECT_LEFT) PetscCall(CollectSide(c, modes, PETSC_FALSE, basis, block));
  if (sides != CORRECT_RIGHT) PetscCall(CollectSide(c, modes, PETSC_TRUE, basis, block));
  PetscCall(EventEnd(EVENT_CORRECT));
  PetscFunctionReturn(0);
}

/* W = K + h^2 M without friction at the point of the pencil, h the shift of the factors */
static PetscErrorCode EnergyMatrix(const Correction *c, const Basis *basis, Mat *W)
{
  PencilMatrices frictionless;

  PetscFunctionBeginUser;
  PetscCall(PencilGetFrictionless(basis->pencil, &frictionless));
  PetscCall(MatDuplicate(frictionless.K, MAT_COPY_VALUES, W));
  PetscCall(MatAXPY(*W, c->factor.shift, frictionless.M, UNKNOWN_NONZERO_PATTERN));
  PetscFunctionReturn(0);
}

/* Makes few columns of the corrections Z of modes of frequencies omega [columns], rad/s, or zero: the directions beyond
   the basis in the order of their energy, by a singular value decomposition in W */
static PetscErrorCode CorrectionCompress(const Correction *c, PetscReal energy, const Basis *basis,
                                         const PetscReal omega[], BV Z)
{
  PetscReal *tolerance, *sigma;
  PetscInt   n;
  Mat        W;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(Z, NULL, &n));
  PetscCall(PetscMalloc2(n, &tolerance, n, &sigma));
  for (PetscInt j = 0; j < n; j++)
    tolerance[j] = PetscSqrtReal(energy * PetscMax(PetscSqr(omega[j]), ENERGY_LEAST * c->factor.shift));
  PetscCall(BlockProject(basis->space.V, basis->space.n, basis->M, Z));
  PetscCall(EnergyMatrix(c, basis, &W));
  PetscCall(BlockCompress(W, tolerance, Z, sigma));
  PetscCall(MatDestroy(&W));
  PetscCall(PetscFree2(tolerance, sigma));
  PetscFunctionReturn(0);
}

/* Frequencies of all columns of both sides */
static PetscErrorCode OmegaUnite(CorrectionBlock *block, PetscReal omega[])
{
  PetscFunctionBeginUser;
  for (int i = 0; i < 2; i++) {
    if (block->n[i]) PetscCall(PetscArraycpy(omega + (i ? block->n[0] : 0), block->omega[i], block->n[i]));
    PetscCall(PetscFree(block->omega[i]));
  }
  PetscFunctionReturn(0);
}

/* Z = solutions for all columns of both sides, which are freed before the vectors of the basis grow: the largest memory
   of a sweep */
PetscErrorCode CorrectionSolve(const Correction *c, const Basis *basis, CorrectionBlock *block, BV *Z)
{
  PetscFunctionBeginUser;
  PetscCall(BlockCreate(basis->space.V, block->n[0] + block->n[1], Z));
  for (int i = 0; i < 2; i++)
    if (block->side[i]) PetscCall(BVSetActiveColumns(block->side[i], 0, block->n[i]));
  PetscCall(ResidualsSolve(&c->factor, block->side, *Z));
  PetscFunctionReturn(0);
}

PetscErrorCode CorrectionAppend(const Correction *c, CorrectionDrop drop, Basis *basis, CorrectionBlock *block, BV Z,
                                PetscInt *n_added)
{
  PetscReal *omega;
  PetscInt   n_left;

  PetscFunctionBeginUser;
  for (int i = 0; i < 2; i++) PetscCall(BVDestroy(&block->side[i]));
  PetscCall(PetscMalloc1(block->n[0] + block->n[1], &omega));
  PetscCall(OmegaUnite(block, omega));
  block->n[0] = block->n[1] = 0;
  if (drop.energy > 0) PetscCall(CorrectionCompress(c, drop.energy, basis, omega, Z));
  PetscCall(BVGetActiveColumns(Z, NULL, &n_left));
  if (n_left) PetscCall(BasisAdd(basis, Z, drop.energy > 0 ? 0 : drop.length, n_added));
  PetscCall(PetscFree(omega));
  PetscFunctionReturn(0);
}

/* Collective. One solve for all, then one orthogonalisation */
PetscErrorCode CorrectionApply(const Correction *c, CorrectionDrop drop, Basis *basis, CorrectionBlock *block,
                               PetscInt *n_added)
{
  BV Z;

  PetscFunctionBeginUser;
  *n_added = 0;
  if (!(block->n[0] + block->n[1])) PetscFunctionReturn(0);
  PetscCall(EventBegin(EVENT_CORRECT));
  PetscCall(CorrectionSolve(c, basis, block, &Z));
  PetscCall(CorrectionAppend(c, drop, basis, block, Z, n_added));
  PetscCall(BVDestroy(&Z));
  PetscCall(EventEnd(EVENT_CORRECT));
  PetscFunctionReturn(0);
}

/* Relative error of the entry of `before` that is nearest to lambda, without rounding, which no correction lowers;
   infinite where there is none. By distance and not by index, since a better basis may have gained a mode. */
static PetscReal ErrorBefore(const ReducedModes *before, PetscComplex lambda)
{
  PetscReal nearest = PETSC_MAX_REAL, error = PETSC_MAX_REAL;

  for (PetscInt i = 0; i < before->n; i++) {
    const PetscReal distance = cabs(before->lambda[i] - lambda);

    if (distance >= nearest) continue;
    nearest = distance;
    error   = before->rigid[i] ? 0 : (before->error[i] - before->noise[i]) / cabs(before->lambda[i]);
  }
  return error;
}

PetscErrorCode CorrectionDropSettled(const ReducedModes *before, PetscReal tolerance, ReducedModes *modes)
{
  ReducedModes all = *modes;
  PetscInt    *kept, n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(all.n, &kept));
  for (PetscInt i = 0; i < all.n; i++)
    if (ErrorBefore(before, all.lambda[i]) > tolerance) kept[n++] = i;
  PetscCall(ReducedModesSelect(&all, n, kept, modes));
  PetscCall(ReducedModesDestroy(&all));
  PetscCall(PetscFree(kept));
  PetscFunctionReturn(0);
}

/* Modes in the window by the inertia of K - s M at both ends, and by the basis, each without friction and damping:
   with them the pencil is not symmetric and Sylvester's law does not hold. -1, -1 where some of either cannot be
   turned off. A window that begins below half of its end is counted from zero. */
PetscErrorCode CorrectionCount(const Basis *basis, const PetscReal p[], const ReducedWindow *window,
                               ShiftInvert *counter, PetscInt *full, PetscInt *by_basis)
{
  const Reduced *reduced = &basis->reduced;
  ReducedWindow  w       = {window->low < 0.5 * window->high ? 0 : window->low, window->high, PETSC_MAX_REAL, 0};
  PencilMatrices frictionless;
  ReducedModes   modes;
  PetscReal     *p0;
  PetscInt       below = 0;

  PetscFunctionBeginUser;
  *full = *by_basis = -1;
  PetscCall(PencilSetParameters(basis->pencil, p));
  PetscCall(PencilGetFrictionless(basis->pencil, &frictionless));
  PetscCall(PetscMalloc1(reduced->n_parameters, &p0));
  PetscCall(PetscArraycpy(p0, p, reduced->n_parameters));
  if (frictionless.symmetric && ReducedFrictionless(reduced, p0)) {
    PetscCall(ShiftInvertCountBelow(&frictionless, -COUNT_AWAY, counter, &w.low, &below));
    PetscCall(ShiftInvertCountBelow(&frictionless, COUNT_AWAY, counter, &w.high, full));
    PetscCall(ReducedSolve(reduced, p0, &w, &modes));
    *full -= below;
    *by_basis = modes.n;
    PetscCall(ReducedModesDestroy(&modes));
  }
  PetscCall(PetscFree(p0));
  PetscFunctionReturn(0);
}
