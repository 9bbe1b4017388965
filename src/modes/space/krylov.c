/*
   Krylov vectors at the shift g (Z. Bai, Y. Su, SIAM J. Sci. Comput. 26, 2005: second-order Krylov spaces for the
   damped pencil; C. Campos, J. E. Roman, SIAM J. Sci. Comput. 38, 2016: states as coordinates in one space): states
   [p; q] with S [p; q] = [-Q0^-1 (g Q'(g) p + g^2 M q); p] (krylov.h), undamped p with S p = Q0^-1 M p. The modes'
   states are in the chain from the beginning, so that steps do not fall back on the modes near the shift.
*/
#include "krylov.h"
#include "basis/residual.h"
#include "solver/block/orthonormal.h"

#define STATE_DEPENDENT 1e-9 /* a state of length one that is nearer than this to those before is one of them */

PetscErrorCode ModesKrylovCreate(ModesSpace *space, const ShiftInvert *factor, PetscBool transposed, PetscInt capacity,
                                 ModesKrylov *chain)
{
  PetscFunctionBeginUser;
  *chain        = (ModesKrylov){.space = space, .factor = *factor, .transposed = transposed, .capacity = capacity};
  chain->length = (space->pencil.C ? 2 : 1) * space->size;
  PetscCall(PetscCalloc1(capacity * chain->length, &chain->state));
  PetscFunctionReturn(0);
}

static PetscReal StateDot(const ModesKrylov *chain, const PetscReal a[], const PetscReal b[])
{
  PetscReal sum = 0;

  for (PetscInt i = 0; i < chain->length; i++) sum += a[i] * b[i];
  return sum;
}

/* Scales a state to length one and returns the length before */
static PetscReal StateScale(const ModesKrylov *chain, PetscReal a[])
{
  const PetscReal length = PetscSqrtReal(StateDot(chain, a, a));

  for (PetscInt i = 0; i < chain->length && length > 0; i++) a[i] /= length;
  return length;
}

/* Takes in what a state (overwritten) holds beyond those of the chain, by Gram-Schmidt twice. Dependent states end
   their branch of the chain. */
static PetscErrorCode StateAdd(ModesKrylov *chain, PetscReal a[])
{
  PetscReal length;

  PetscFunctionBeginUser;
  (void)StateScale(chain, a);
  for (int twice = 0; twice < 2; twice++)
    for (PetscInt k = 0; k < chain->n; k++) {
      const PetscReal *b = &chain->state[k * chain->length], dot = StateDot(chain, a, b);

      for (PetscInt i = 0; i < chain->length; i++) a[i] -= dot * b[i];
    }
  length = StateScale(chain, a);
  if (length < STATE_DEPENDENT || chain->n == chain->capacity) PetscFunctionReturn(0);
  PetscCall(PetscArraycpy(&chain->state[chain->n * chain->length], a, chain->length));
  chain->n++;
  PetscFunctionReturn(0);
}

/* States of a mode, real and imaginary part: x, or with damping [t x; x], t = g / (lambda - g), since S [t x; x] =
   t [t x; x] where Q(lambda) x = 0. x[0], x[1] are coordinates of the two parts, x[1] NULL for a real vector. */
static PetscErrorCode StateAddMode(ModesKrylov *chain, PetscComplex lambda, const PetscReal *x[2])
{
  const PetscInt     size = chain->space->size, two = chain->length > size;
  const PetscComplex t = chain->factor.shift / (lambda - chain->factor.shift);
  PetscReal         *a;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(chain->length, &a));
  for (int part = 0; part < 2; part++) {
    for (PetscInt i = 0; i < size; i++) {
      const PetscComplex z = CMPLX(x[0][i], x[1] ? x[1][i] : 0), tz = two ? t * z : z;

      a[i] = part ? cimag(tz) : creal(tz);
      if (two) a[size + i] = part ? cimag(z) : creal(z);
    }
    if (part == 0 || x[1] || two) PetscCall(StateAdd(chain, a));
  }
  PetscCall(PetscFree(a));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesCountVectors(Modes modes, PetscInt *n_vectors)
{
  const Mode *mode;
  PetscInt    n;
  Vec         x[4];

  PetscFunctionBeginUser;
  PetscCall(ModesGet(modes, &n, &mode));
  *n_vectors = 0;
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(ModesGetVectors(modes, i, &x[0], &x[1], &x[2], &x[3]));
    for (int k = 0; k < 4; k++) *n_vectors += x[k] ? 1 : 0;
  }
  PetscFunctionReturn(0);
}

/* The block of the modes' vectors, real parts and imaginary ones; column[i] is the first of mode i */
static PetscErrorCode ModesBlock(Modes modes, Pencil pencil, const ModesKrylov *chain, PetscInt n, PetscInt column[],
                                 BV *block)
{
  Vec x[4], q;

  PetscFunctionBeginUser;
  PetscCall(BlockCreate(chain->space->space.V, 2 * n, block));
  column[0] = 0;
  for (PetscInt i = 0; i < n; i++) {
    const int first = chain->transposed ? 2 : 0;

    PetscCall(ModesGetVectors(modes, i, &x[0], &x[1], &x[2], &x[3]));
    column[i + 1] = column[i];
    for (int part = 0; part < 2; part++) {
      if (!x[first + part]) continue;
      PetscCall(BVGetColumn(*block, column[i + 1], &q));
      PetscCall(PencilRestrict(pencil, x[first + part], q));
      PetscCall(BVRestoreColumn(*block, column[i + 1]++, &q));
    }
  }
  PetscCall(BVSetActiveColumns(*block, 0, column[n]));
  PetscFunctionReturn(0);
}

/* Vectors into the space first, then states of their coordinates, which are exact in it but for rounding. */
PetscErrorCode ModesKrylovAddModes(Modes modes, Pencil pencil, ModesKrylov *chain)
{
  const PetscInt size = chain->space->size;
  const Mode    *mode;
  PetscInt       n, *column;
  PetscReal     *x;
  BV             block;

  PetscFunctionBeginUser;
  PetscCall(ModesGet(modes, &n, &mode));
  PetscCall(PetscMalloc1(n + 1, &column));
  PetscCall(ModesBlock(modes, pencil, chain, n, column, &block));
  PetscCall(ModesSpaceAdd(chain->space, block));
  PetscCall(ModesSpaceCoordinates(chain->space, block, &x));
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal *part[2] = {&x[column[i] * size],
                                column[i + 1] - column[i] == 2 ? &x[(column[i] + 1) * size] : NULL};

    PetscCall(StateAddMode(chain, CMPLX(mode[i].sigma, mode[i].omega), part));
  }
  chain->last = chain->n;
  PetscCall(BVDestroy(&block));
  PetscCall(PetscFree(x));
  PetscCall(PetscFree(column));
  PetscFunctionReturn(0);
}

/* Y = A X, or A' X, of C or M */
static PetscErrorCode BlockApply(const ModesKrylov *chain, BV X, int which, BV Y)
{
  const SubspaceTerm *term = &chain->space->space.term[which];

  PetscFunctionBeginUser;
  PetscCall(BlockMultiplyVectors(chain->transposed ? term->transposed : term->A, X, Y));
  PetscFunctionReturn(0);
}

/* The states [c; old] of n answers with coordinates c[n][size]; old is the first part of the states that they came
   from, zero in the first step. */
static PetscErrorCode KrylovTake(ModesKrylov *chain, PetscInt n, const PetscReal c[])
{
  const PetscInt size = chain->space->size, from = chain->last;
  PetscReal     *a;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(chain->length, &a));
  chain->last = chain->n;
  for (PetscInt j = 0; j < n; j++) {
    PetscCall(PetscArraycpy(a, &c[j * size], size));
    if (chain->length > size && chain->begun)
      PetscCall(PetscArraycpy(a + size, &chain->state[(from + j) * chain->length], size));
    else if (chain->length > size)
      PetscCall(PetscArrayzero(a + size, size));
    PetscCall(StateAdd(chain, a));
  }
  chain->begun = PETSC_TRUE;
  PetscCall(PetscFree(a));
  PetscFunctionReturn(0);
}

/* R = M P, or with damping -g Q'(shift) P - g^2 M Q = -g^2 M (2 P + Q) - g C P */
static PetscErrorCode KrylovResidual(const ModesKrylov *chain, PetscInt n, const PetscReal states[], BV R)
{
  const PencilMatrices *m    = &chain->space->pencil;
  const PetscReal       g    = chain->factor.shift;
  const PetscInt        size = chain->space->size;
  PetscReal            *both;
  BV                    P, T;

  PetscFunctionBeginUser;
  PetscCall(BlockCreate(chain->space->space.V, n, &P));
  PetscCall(ModesSpaceLift(chain->space, n, chain->length, states, P));
  if (m->C) {
    PetscCall(BlockCreate(chain->space->space.V, n, &T));
    PetscCall(BlockApply(chain, P, SUBSPACE_C, T));
    PetscCall(PetscMalloc1(n * size, &both));
    for (PetscInt j = 0; j < n; j++)
      for (PetscInt i = 0; i < size; i++)
        both[j * size + i] = 2 * states[j * chain->length + i] + states[j * chain->length + size + i];
    PetscCall(ModesSpaceLift(chain->space, n, size, both, P));
    PetscCall(PetscFree(both));
  }
  PetscCall(BlockApply(chain, P, SUBSPACE_M, R));
  if (m->C) {
    PetscCall(BVScale(R, -g * g));
    PetscCall(BVMult(R, -g, 1, T, NULL));
    PetscCall(BVDestroy(&T));
  }
  PetscCall(BVDestroy(&P));
  PetscFunctionReturn(0);
}

/* Right-hand sides of the next step: the n vectors b that the chain begins with, or those of the last states */
static PetscErrorCode KrylovCreateSides(const ModesKrylov *chain, PetscInt n, BV *R)
{
  PetscFunctionBeginUser;
  PetscCall(BlockCreate(chain->space->space.V, n, R));
  for (PetscInt j = 0; j < n && !chain->begun; j++) PetscCall(BVInsertVec(*R, j, chain->b[j]));
  if (chain->begun) PetscCall(KrylovResidual(chain, n, &chain->state[chain->last * chain->length], *R));
  PetscFunctionReturn(0);
}

/* Both chains are solved for at once. Afterwards the new states of each are those from `last` on; dependent ones
   are not among them. */
PetscErrorCode ModesKrylovStep(ModesSpace *space, ModesKrylov *chain[2])
{
  PetscInt   n[2];
  PetscReal *c;
  BV         block, R[2] = {NULL, NULL};

  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++) n[k] = chain[k]->begun ? chain[k]->n - chain[k]->last : chain[k]->n_b;
  if (n[0] + n[1] == 0) PetscFunctionReturn(0);
  PetscCall(BlockCreate(space->space.V, n[0] + n[1], &block));
  for (int k = 0; k < 2; k++)
    if (n[k]) PetscCall(KrylovCreateSides(chain[k], n[k], &R[k]));
  PetscCall(ResidualsSolve(&chain[0]->factor, R, block));
  *chain[0]->n_solves += n[0] + n[1];
  for (int k = 0; k < 2; k++) PetscCall(BVDestroy(&R[k]));
  PetscCall(ModesSpaceAdd(space, block));
  PetscCall(ModesSpaceCoordinates(space, block, &c));
  for (int k = 0; k < 2; k++) PetscCall(KrylovTake(chain[k], n[k], c + k * n[0] * space->size));
  PetscCall(PetscFree(c));
  PetscCall(BVDestroy(&block));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesKrylovRestart(ModesKrylov *chain, PetscInt n, PetscInt n_b, const Vec b[])
{
  PetscFunctionBeginUser;
  chain->n = chain->last = n;
  chain->n_b             = n_b;
  chain->b               = b;
  chain->begun           = PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode ModesKrylovDestroy(ModesKrylov *chain)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(chain->state));
  PetscFunctionReturn(0);
}
