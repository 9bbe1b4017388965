/*
   How strong damping is beyond the basis. The rest R = C - alpha M - beta K couples the undamped modes, also with those
   beyond the basis. At lambda

      Q(lambda) = (1 + beta lambda) (K - kappa M) + lambda R,   kappa(lambda) = -(lambda^2 + alpha lambda) / (1 + beta
      lambda),

   and beyond the basis K - kappa M is regular. With G = (K - s M)^-1 lambda R / (1 + beta lambda) there and K - kappa M
   about K - s M, I + t G stays regular for t in [0, 1] where the spectral radius of G is below one: as R grows from
   nothing no eigenvalue comes into the window from beyond. With laws of materials alpha = beta = 0 in this measure, and
   G_j(lambda) A_j counts by its size beyond Re G_j at the reference, A_j being semidefinite.

   Where the radius is larger the basis takes in what makes it so, vectors (K - s M)^-1 R u, those of a second-order
   Krylov space about a real shift (Z. Bai, Y. Su, SIAM J. Matrix Anal. Appl. 26, 2005), a block at a time. Dashpots,
   friction at low speeds, contacts beside beta on all parts, and damping of few nodes have R of few eigenvalues that
   are not small: then the rest is soon weak.
*/
#include "projection.h"
#include "base/algebra/dense.h"
#include "solver/block/orthonormal.h"

#define BEYOND_BLOCK     8
#define ENLARGE_BLOCK    24
#define ENLARGE_LARGEST  48  /* vectors of a block */
#define ENLARGE_ENOUGH   0.5 /* radius that is small enough: corrections converge by that much in a step */
#define ENLARGE_LEAST    0.3 /* |eigenvalue| of what it takes in */
#define ENLARGE_STAYS    0.8 /* of the last radius: more blocks help no more */
#define ENLARGE_WEAK     0.8 /* radius that will do then */
#define ENLARGE_MISFIT   0.3 /* of the fit: with more of it alpha and beta are an average that no part has */
#define ENLARGE_HOPELESS 4   /* radius that another beta does not help: sqrt(r^2 / (1 + r^2)) with half of it for r */
#define ENLARGE_ROUNDS   16
#define ENLARGE_MOST     400 /* columns that it adds: the dense problem has twice as many */
#define BEYOND_STEPS     3
#define BEYOND_POINTS    8    /* of the window, where laws of materials are looked at */
#define BEYOND_NEW       1e-6 /* of a vector of length one: what the basis has not */
#define BEYOND_CLEAR                                                                                                   \
  0.1 /* an estimate below this, of two steps or more, is far enough from one: a third adds 2 % to 0.01 */

/* b += sum_j (a_j - c_j) A_j w, c_j what the pencil's C has of a law, a_j the largest |h_j(i omega) + i omega c_j| of
   the window beside its upper end */
static PetscErrorCode BeyondAddLaws(const Projection *p, Mat w, Mat b)
{
  const PetscReal high = PetscMax(p->window->high, p->window->target), low = p->window->low;
  Mat             Aw;

  PetscFunctionBeginUser;
  if (!p->pencil->n_laws) PetscFunctionReturn(0);
  PetscCall(MatDuplicate(b, MAT_DO_NOT_COPY_VALUES, &Aw));
  for (PetscInt l = 0; l < p->pencil->n_laws; l++) {
    const PencilLaw *law = &p->pencil->law[l];
    const PetscReal  c   = law->scale * cimag(law->at) / law->reference;
    PetscReal        a   = 0;

    for (int i = 0; i <= BEYOND_POINTS; i++) {
      const PetscReal omega = low + (high - low) * (i + 0.5) / (BEYOND_POINTS + 1);

      a = PetscMax(a, cabs(PencilLawAt(law, CMPLX(0, omega), NULL) + I * omega * c));
    }
    PetscCall(BlockMultiplyEach(1, &law->A, w, &Aw));
    PetscCall(MatAXPY(b, a / high - c, Aw, SAME_NONZERO_PATTERN));
  }
  PetscCall(MatDestroy(&Aw));
  PetscFunctionReturn(0);
}

/* Z = P^-1 R W for the active columns of W and Z */
static PetscErrorCode BeyondApply(const Projection *p, BV W, BV Z)
{
  Mat w, z, Mw, Kw, b;

  PetscFunctionBeginUser;
  PetscCall(BVGetMat(W, &w));
  PetscCall(BVGetMat(Z, &z));
  PetscCall(MatDuplicate(z, MAT_DO_NOT_COPY_VALUES, &b));
  PetscCall(MatDuplicate(z, MAT_DO_NOT_COPY_VALUES, &Mw));
  PetscCall(MatDuplicate(z, MAT_DO_NOT_COPY_VALUES, &Kw));
  PetscCall(BlockMultiplyEach(3, (Mat[]){p->pencil->C, p->pencil->M, p->pencil->K}, w, (Mat[]){b, Mw, Kw}));
  if (!p->pencil->n_laws) {
    PetscCall(MatAXPY(b, -p->alpha, Mw, SAME_NONZERO_PATTERN));
    PetscCall(MatAXPY(b, -p->beta, Kw, SAME_NONZERO_PATTERN));
  }
  PetscCall(BeyondAddLaws(p, w, b));
  PetscCall(ShiftInvertApplyBlock(&p->si, PETSC_FALSE, b, z));
  PetscCall(MatDestroy(&Kw));
  PetscCall(MatDestroy(&Mw));
  PetscCall(MatDestroy(&b));
  PetscCall(BVRestoreMat(Z, &z));
  PetscCall(BVRestoreMat(W, &w));
  PetscFunctionReturn(0);
}

/* A block Krylov space on the complement of V, whose columns stand behind those of V meanwhile */
typedef struct {
  PetscInt   n;
  BV         U, images, block; /* U, orthonormal, n columns; P^-1 R U; what the next step takes in */
  PetscReal *w, *vectors;      /* [2][n], [n * n] eigenvalues of P^-1 R on it, with their vectors; alike on all ranks */
} BeyondSpace;

/* The empty space, with a random block */
static PetscErrorCode BeyondCreate(const Projection *p, PetscInt block, int round, BeyondSpace *s)
{
  PetscInt has;

  PetscFunctionBeginUser;
  *s = (BeyondSpace){.n = 0};
  PetscCall(BlockCreate(p->space.V, block * BEYOND_STEPS, &s->U));
  PetscCall(BlockCreate(p->space.V, block * BEYOND_STEPS, &s->images));
  PetscCall(BVGetSizes(p->space.V, NULL, NULL, &has));
  if (has < p->space.n + block * BEYOND_STEPS)
    PetscCall(BVResize(p->space.V, p->space.n + block * BEYOND_STEPS, PETSC_TRUE));
  PetscCall(BlockCreate(p->space.V, block, &s->block));
  PetscCall(SolverSeed(s->block, 1984 + (unsigned long)round));
  for (PetscInt j = 0; j < block; j++) PetscCall(BVSetRandomColumn(s->block, j));
  PetscFunctionReturn(0);
}

static PetscErrorCode BeyondDestroy(const Projection *p, BeyondSpace *s)
{
  BV *const all[] = {&s->U, &s->images, &s->block};

  PetscFunctionBeginUser;
  PetscCall(BVSetActiveColumns(p->space.V, 0, p->space.n));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(all); i++) PetscCall(BVDestroy(all[i]));
  PetscCall(PetscFree2(s->w, s->vectors));
  PetscFunctionReturn(0);
}

/* Takes in a block; grows = there was something in it */
static PetscErrorCode BeyondStep(const Projection *p, BeyondSpace *s, PetscBool *grows)
{
  PetscInt m;
  BV       image;

  PetscFunctionBeginUser;
  PetscCall(BlockOrthonormalise(p->space.V, p->space.n + s->n, p->pencil->M, 0, s->block));
  PetscCall(BVGetActiveColumns(s->block, NULL, &m));
  *grows = m ? PETSC_TRUE : PETSC_FALSE;
  if (!m) PetscFunctionReturn(0);
  PetscCall(BlockCreate(p->space.V, m, &image));
  PetscCall(BeyondApply(p, s->block, image));
  PetscCall(BVSetActiveColumns(p->space.V, p->space.n + s->n, p->space.n + s->n + m));
  PetscCall(BVCopy(s->block, p->space.V));
  PetscCall(BVSetActiveColumns(s->U, s->n, s->n + m));
  PetscCall(BVCopy(s->block, s->U));
  PetscCall(BVSetActiveColumns(s->images, s->n, s->n + m));
  PetscCall(BVCopy(image, s->images));
  PetscCall(BVDestroy(&s->block));
  s->block = image;
  s->n += m;
  PetscFunctionReturn(0);
}

/* The spectral radius of P^-1 R on the space */
static PetscErrorCode BeyondRadius(const Projection *p, BeyondSpace *s, PetscReal *radius)
{
  const PetscInt n = s->n;
  PetscReal     *H, *left;
  PetscMPIInt    count;
  Mat            product;

  PetscFunctionBeginUser;
  PetscCall(BVSetActiveColumns(s->U, 0, n));
  PetscCall(BVSetActiveColumns(s->images, 0, n));
  PetscCall(BlockProducts(s->U, p->pencil->M, s->images, &product));
  PetscCall(PetscFree2(s->w, s->vectors));
  PetscCall(PetscMalloc2(2 * n, &s->w, n * n, &s->vectors));
  PetscCall(PetscMalloc2(n * n, &H, n * n, &left));
  PetscCall(BlockCopy(product, PETSC_FALSE, n, H));
  PetscCall(DenseEigen(n, H, s->w, s->w + n, left, s->vectors));
  PetscCall(PetscFree2(H, left));
  PetscCall(MatDestroy(&product));
  PetscCall(PetscMPIIntCast(n * n, &count));
  PetscCallMPI(MPI_Bcast(s->w, (PetscMPIInt)(2 * n), MPIU_REAL, 0, p->modes->comm));
  PetscCallMPI(MPI_Bcast(s->vectors, count, MPIU_REAL, 0, p->modes->comm));
  *radius = 0;
  for (PetscInt i = 0; i < n; i++) *radius = PetscMax(*radius, hypot(s->w[i], s->w[n + i]));
  PetscFunctionReturn(0);
}

/* The space of some steps, as many as tell the radius */
static PetscErrorCode BeyondGrow(const Projection *p, BeyondSpace *space, PetscReal *rho)
{
  const PetscReal factor = ProjectionLargestRatio(p);
  PetscBool       grows  = PETSC_TRUE;

  PetscFunctionBeginUser;
  *rho = 0;
  for (int step = 1; step <= BEYOND_STEPS && grows; step++) {
    PetscCall(BeyondStep(p, space, &grows));
    if (!space->n || (step == 1 && grows)) continue;
    PetscCall(BeyondRadius(p, space, rho));
    *rho *= factor;
    if (*rho < BEYOND_CLEAR) break;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionMeasureBeyond(const Projection *p, PetscReal *rho)
{
  BeyondSpace space;

  PetscFunctionBeginUser;
  PetscCall(BeyondCreate(p, BEYOND_BLOCK, 0, &space));
  PetscCall(BeyondGrow(p, &space, rho));
  PetscCall(BeyondDestroy(p, &space));
  PetscFunctionReturn(0);
}

/* Puts the vectors P^-1 R u of large eigenvalues into the basis */
static PetscErrorCode BeyondTake(Projection *p, const BeyondSpace *s, PetscInt *added)
{
  const PetscInt  n     = s->n;
  const PetscReal least = ENLARGE_LEAST / ProjectionLargestRatio(p);
  PetscInt        m     = 0;
  PetscReal      *chosen;
  BV              block;

  PetscFunctionBeginUser;
  PetscCall(BVSetActiveColumns(p->space.V, 0, p->space.n));
  PetscCall(PetscMalloc1(n * n, &chosen));
  for (PetscInt i = 0; i < n; i++)
    if (hypot(s->w[i], s->w[n + i]) >= least)
      PetscCall(PetscArraycpy(&chosen[n * m++], &s->vectors[n * i], n)); /* real and imaginary parts */
  PetscCall(BlockCreate(p->space.V, m, &block));
  PetscCall(BlockLift(s->images, n, m, chosen, block));
  PetscCall(SubspaceAdd(&p->space, BEYOND_NEW, block, added));
  PetscCall(BVDestroy(&block));
  PetscCall(PetscFree(chosen));
  PetscFunctionReturn(0);
}

/* Another beta. Where R is b K on many unknowns, as of a strongly damped part, no block takes that out, but half of it
   in beta leaves as much of the one sign there as of the other elsewhere, r / root(1 + r^2) with r = b omega / 2 at the
   upper end of the window: below one. Back to what it was where that does not help. */
static PetscErrorCode BeyondBalance(Projection *p, PetscReal *rho)
{
  const PetscReal beta = p->beta;
  PetscReal       balanced;

  PetscFunctionBeginUser;
  p->beta += 0.5 * *rho / ProjectionLargestRatio(p);
  PetscCall(ProjectionMeasureBeyond(p, &balanced));
  PetscCall(PetscInfo(p->space.V, "measure %.3g, %.3g with beta %.4g in place of %.4g s\n", (double)*rho,
                      (double)balanced, (double)p->beta, (double)beta));
  if (balanced > ENLARGE_STAYS * *rho)
    p->beta = beta;
  else
    *rho = balanced;
  PetscFunctionReturn(0);
}

/* Whether what the first block took in left the radius as large as it was, seen by a few vectors: then it is not of few
   eigenvalues, and a larger block would cost as much as a factorisation to no end. rho is the radius then. */
static PetscErrorCode EnlargeIsHopeless(const Projection *p, int round, PetscReal before, PetscReal *rho,
                                        PetscBool *hopeless)
{
  BeyondSpace space;

  PetscFunctionBeginUser;
  *hopeless = PETSC_FALSE;
  if (round != 2 || before <= ENLARGE_HOPELESS) PetscFunctionReturn(0);
  PetscCall(BeyondCreate(p, BEYOND_BLOCK, round, &space));
  PetscCall(BeyondGrow(p, &space, rho));
  PetscCall(BeyondDestroy(p, &space));
  *hopeless = *rho > PetscMax(ENLARGE_STAYS * before, ENLARGE_HOPELESS) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionEnlarge(Projection *p, PetscReal *rho)
{
  const PetscInt first = p->space.n;
  PetscInt       added = 1, block = ENLARGE_BLOCK;
  PetscReal      before = PETSC_MAX_REAL;
  PetscBool      tried  = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscInfo(p->space.V, "alpha %.4g 1/s, beta %.4g s, misfit %.3g\n", (double)p->alpha, (double)p->beta,
                      (double)p->misfit));
  if (p->misfit > ENLARGE_MISFIT) p->alpha = p->beta = 0;
  for (int round = 1; round <= ENLARGE_ROUNDS && added && p->space.n < first + ENLARGE_MOST; round++) {
    PetscBool   stays, hopeless;
    BeyondSpace space;

    PetscCall(EnlargeIsHopeless(p, round, before, rho, &hopeless));
    if (hopeless) break;
    PetscCall(BeyondCreate(p, block, round, &space));
    PetscCall(BeyondGrow(p, &space, rho));
    stays = *rho > ENLARGE_STAYS * before ? PETSC_TRUE : PETSC_FALSE;
    added = 0;
    if (*rho > ENLARGE_ENOUGH && (*rho > ENLARGE_WEAK || !stays)) PetscCall(BeyondTake(p, &space, &added));
    PetscCall(BeyondDestroy(p, &space));
    PetscCall(PetscInfo(p->space.V, "%" PetscInt_FMT " vectors, %" PetscInt_FMT " of them new: measure was %.3g\n",
                        p->space.n, added, (double)*rho));
    if (stays && *rho > ENLARGE_HOPELESS) break;
    if (stays && added && !tried) {
      PetscCall(BeyondBalance(p, rho));
      tried = PETSC_TRUE;
    }
    before = *rho;
    block  = PetscMin(2 * block, ENLARGE_LARGEST);
  }
  PetscFunctionReturn(0);
}
