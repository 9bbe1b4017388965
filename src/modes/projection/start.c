/*
   The undamped vectors of the window and the corrections that damping of first order adds to them. With X and Y the
   right and left ones, E = Y'MX and F = Y'CX, which is diagonal where damping leaves the vectors as they are,

      lambda (C X - M X E^-1 F)   and   lambda (C'Y - M Y E^-T F')

   are what is left of the residuals when all of them take part in a mode: Y' and X' times them is zero.
*/
#include "projection.h"
#include "base/events.h"
#include "base/algebra/dense.h"
#include "solver/block/orthonormal.h"

#define START_KEEP 1e-4 /* of what damping leaves of a residual, which the basis does not know yet: less of it stays */
#define START_SAME 1e-9 /* relative difference of eigenvalues that come from one kappa */

/* Whether the two eigenvalues of a complex pair of kappa, lambda and -conj(lambda), are there, and this is the one that
   decays: it has the vectors of the other */
static PetscBool IsTwin(const Spectrum *s, PetscInt i)
{
  if (!s->xi[i] || s->sigma[i] >= 0) return PETSC_FALSE;
  for (PetscInt j = 0; j < s->n; j++)
    if (s->xi[j] && cabs(SpectrumLambda(s, i) + conj(SpectrumLambda(s, j))) <= START_SAME * s->omega[i])
      return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The vectors side by side */
static PetscErrorCode ModalFill(const Projection *p, const Spectrum *s, ModalBlock *b)
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  *b = (ModalBlock){.n = 0};
  for (PetscInt i = 0; i < s->n; i++)
    if (!IsTwin(s, i)) b->n += s->xi[i] ? 2 : 1;
  if (!b->n) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(b->n, &b->mode));
  PetscCall(BlockCreate(p->space.V, b->n, &b->x));
  for (PetscInt i = 0; i < s->n; i++)
    for (int part = 0; part < (s->xi[i] ? 2 : 1) && !IsTwin(s, i); part++) {
      PetscCall(BVInsertVec(b->x, n, part ? s->xi[i] : s->xr[i]));
      b->mode[n++] = i;
    }
  PetscFunctionReturn(0);
}

/* C x and M x, or C' x and M' x */
static PetscErrorCode ModalMultiply(const Projection *p, PetscBool left, ModalBlock *b)
{
  const Mat A[2] = {ProjectionMatrix(p, SUBSPACE_C, left), ProjectionMatrix(p, SUBSPACE_M, left)};
  Mat       x, y[2];

  PetscFunctionBeginUser;
  PetscCall(BlockCreate(p->space.V, b->n, &b->Cx));
  PetscCall(BlockCreate(p->space.V, b->n, &b->Mx));
  PetscCall(BVGetMat(b->x, &x));
  PetscCall(BVGetMat(b->Cx, &y[0]));
  PetscCall(BVGetMat(b->Mx, &y[1]));
  PetscCall(BlockMultiplyEach(2, A, x, y));
  PetscCall(BVRestoreMat(b->Mx, &y[1]));
  PetscCall(BVRestoreMat(b->Cx, &y[0]));
  PetscCall(BVRestoreMat(b->x, &x));
  PetscFunctionReturn(0);
}

PetscErrorCode ModalBlocksCreate(const Projection *p, const Spectrum *right, const Spectrum *left, ModalBlock modal[2])
{
  PetscFunctionBeginUser;
  PetscCall(ModalFill(p, right, &modal[0]));
  PetscCall(ModalFill(p, left, &modal[1]));
  if (modal[0].n) PetscCall(ModalMultiply(p, PETSC_FALSE, &modal[0]));
  PetscFunctionReturn(0);
}

PetscErrorCode ModalBlocksDestroy(ModalBlock modal[2])
{
  PetscFunctionBeginUser;
  for (int side = 0; side < 2; side++) {
    modal[side].n = 0;
    PetscCall(PetscFree(modal[side].mode));
    PetscCall(PetscFree(modal[side].tolerance));
    PetscCall(BVDestroy(&modal[side].x));
    PetscCall(BVDestroy(&modal[side].Cx));
    PetscCall(BVDestroy(&modal[side].Mx));
  }
  PetscFunctionReturn(0);
}

/* Cx := Cx - Mx E^-1 F for the vectors y of the other side; left as it is where E is singular */
static PetscErrorCode RestMake(const Projection *p, BV y, ModalBlock *b)
{
  const PetscInt n = b->n;
  PetscScalar   *e, *f;
  PetscBLASInt  *pivot;
  PetscBool      singular;
  Mat            E, F;

  PetscFunctionBeginUser;
  PetscCall(BlockProducts(y, NULL, b->Mx, &E));
  PetscCall(BlockProducts(y, NULL, b->Cx, &F));
  PetscCall(PetscMalloc1(n, &pivot));
  PetscCall(MatDenseGetArray(E, &e));
  PetscCall(MatDenseGetArray(F, &f));
  PetscCall(DenseFactor(n, e, pivot, &singular));
  if (!singular) PetscCall(DenseSolve(n, e, pivot, PETSC_FALSE, n, f));
  PetscCall(MatDenseRestoreArray(F, &f));
  PetscCall(MatDenseRestoreArray(E, &e));
  PetscCallMPI(MPI_Bcast(&singular, 1, MPIU_BOOL, 0, p->modes->comm));
  if (!singular) PetscCall(BVMult(b->Cx, -1, 1, b->Mx, F));
  PetscCall(PetscFree(pivot));
  PetscCall(MatDestroy(&E));
  PetscCall(MatDestroy(&F));
  PetscFunctionReturn(0);
}

/* Whether a mode of the undamped problem is in the window */
static PetscBool StartsWith(const Projection *p, PetscReal omega)
{
  const Window *w = p->window;

  return w->count || (omega >= w->edge[0] && omega <= w->edge[1]) ? PETSC_TRUE : PETSC_FALSE;
}

/* Leaves the residuals of modes in the window, with what may remain of them */
static PetscErrorCode RestChoose(const Projection *p, PetscBool left, const Spectrum *s, ModalBlock *b)
{
  PetscReal *const tolerance = b->tolerance;
  PetscInt         n         = 0;

  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < b->n; j++) {
    const PetscReal omega = s->omega[b->mode[j]];
    PetscReal       size, norm;

    if (!StartsWith(p, omega)) continue;
    if (n < j) PetscCall(BVCopyColumn(b->Cx, j, n));
    PetscCall(BVNormColumn(b->x, j, NORM_2, &norm));
    PetscCall(BVNormColumn(b->Cx, n, NORM_2, &size));
    tolerance[n] = omega > 0 ? p->limit[left] * (omega * p->norms[2] + p->norms[1] + p->norms[0] / omega) * norm : size;
    tolerance[n] = PetscMax(tolerance[n], START_KEEP * size);
    if (tolerance[n] > 0) n++;
  }
  PetscCall(BVSetActiveColumns(b->Cx, 0, n));
  PetscFunctionReturn(0);
}

PetscErrorCode ModalBlocksReduce(const Projection *p, const Spectrum *right, const Spectrum *left, ModalBlock modal[2])
{
  const Spectrum *const spectrum[2] = {right, left};
  const PetscBool       paired      = modal[0].n == modal[1].n ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  for (int side = 0; side < 2 && modal[side].n; side++) {
    const PetscBool is_left = side ? PETSC_TRUE : PETSC_FALSE;

    if (is_left) PetscCall(ModalMultiply(p, is_left, &modal[side]));
    PetscCall(RestMake(p, modal[paired ? 1 - side : side].x, &modal[side]));
    PetscCall(BVDestroy(&modal[side].Mx));
    PetscCall(PetscMalloc1(modal[side].n, &modal[side].tolerance));
    PetscCall(RestChoose(p, is_left, spectrum[side], &modal[side]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionStart(Projection *p, ModalBlock modal[2])
{
  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_CORRECT));
  PetscCall(ProjectionExtend(p, (BV[]){modal[0].Cx, modal[1].Cx},
                             (PetscReal *[]){modal[0].tolerance, modal[1].tolerance}, NULL));
  PetscCall(EventEnd(EVENT_CORRECT));
  PetscFunctionReturn(0);
}
