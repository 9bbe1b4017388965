/*
   Spectrum: a list of eigenvalues lambda = sigma + i omega (rad/s, omega >= 0: the conjugates are not listed) with
   their vectors x = xr + i xi, xi NULL where x is real. A list owns its vectors.
*/
#include "modesimpl.h"

/* |kappa - shift|, (rad/s)^2, with kappa = -lambda^2 = omega^2 - sigma^2 - 2 i sigma omega */
PetscReal SpectrumDistance(const Spectrum *s, PetscInt i, PetscReal shift)
{
  const PetscReal re = s->omega[i] * s->omega[i] - s->sigma[i] * s->sigma[i] - shift;

  return hypot(re, 2 * s->sigma[i] * s->omega[i]);
}

PetscErrorCode SpectrumCreate(PetscInt capacity, Spectrum *s)
{
  PetscFunctionBeginUser;
  s->n        = 0;
  s->capacity = capacity;
  s->reach    = 0;
  PetscCall(PetscCalloc4(capacity, &s->sigma, capacity, &s->omega, capacity, &s->xr, capacity, &s->xi));
  PetscFunctionReturn(0);
}

PetscErrorCode SpectrumTake(Spectrum *s, PetscReal sigma, PetscReal omega, Vec xr, Vec xi)
{
  PetscFunctionBeginUser;
  PetscCheck(s->n < s->capacity, PETSC_COMM_SELF, PETSC_ERR_PLIB, "spectrum is full");
  s->sigma[s->n] = sigma;
  s->omega[s->n] = omega;
  s->xr[s->n]    = xr;
  s->xi[s->n]    = xi;
  s->n++;
  PetscFunctionReturn(0);
}

PetscErrorCode SpectrumAdd(Spectrum *s, PetscReal sigma, PetscReal omega, Vec xr, Vec xi)
{
  Vec copy[2] = {NULL, NULL};

  PetscFunctionBeginUser;
  for (int part = 0; part < (xi ? 2 : 1); part++) {
    const Vec x = part ? xi : xr;

    PetscCall(VecDuplicate(x, &copy[part]));
    PetscCall(VecCopy(x, copy[part]));
  }
  PetscCall(SpectrumTake(s, sigma, omega, copy[0], copy[1]));
  PetscFunctionReturn(0);
}

/* Exchanges two entries */
static void SpectrumSwap(Spectrum *s, PetscInt i, PetscInt j)
{
  const PetscReal sigma = s->sigma[i], omega = s->omega[i];
  const Vec       xr = s->xr[i], xi = s->xi[i];

  s->sigma[i] = s->sigma[j], s->omega[i] = s->omega[j], s->xr[i] = s->xr[j], s->xi[i] = s->xi[j];
  s->sigma[j] = sigma, s->omega[j] = omega, s->xr[j] = xr, s->xi[j] = xi;
}

/* Whether entry i stands after entry j: by frequency; members of a lock-in pair (equal within 1e-7) by growth, and real
   eigenvalues by size */
static PetscBool SpectrumIsAfter(const Spectrum *s, PetscInt i, PetscInt j)
{
  const PetscReal close = 1e-7 * PetscMax(s->omega[i], s->omega[j]);

  if (PetscAbsReal(s->omega[i] - s->omega[j]) > close) return s->omega[i] > s->omega[j] ? PETSC_TRUE : PETSC_FALSE;
  if (s->omega[i] == 0) return PetscAbsReal(s->sigma[i]) > PetscAbsReal(s->sigma[j]) ? PETSC_TRUE : PETSC_FALSE;
  return s->sigma[i] > s->sigma[j] ? PETSC_TRUE : PETSC_FALSE;
}

/* By insertion, so that what is equal keeps its order */
PetscErrorCode SpectrumSort(Spectrum *s)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 1; i < s->n; i++)
    for (PetscInt j = i; j > 0 && SpectrumIsAfter(s, j - 1, j); j--) SpectrumSwap(s, j - 1, j);
  PetscFunctionReturn(0);
}

PetscErrorCode SpectrumOrder(const Spectrum *s, PetscInt order[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < s->n; i++) {
    PetscInt k = i;

    for (; k > 0 && SpectrumIsAfter(s, order[k - 1], i); k--) order[k] = order[k - 1];
    order[k] = i;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SpectrumPermute(Spectrum *s, const PetscInt order[])
{
  Spectrum sorted;

  PetscFunctionBeginUser;
  PetscCall(SpectrumCreate(s->n, &sorted));
  for (PetscInt k = 0; k < s->n; k++) {
    sorted.sigma[k] = s->sigma[order[k]], sorted.omega[k] = s->omega[order[k]];
    sorted.xr[k] = s->xr[order[k]], sorted.xi[k] = s->xi[order[k]];
  }
  sorted.n     = s->n;
  sorted.reach = s->reach;
  s->n         = 0; /* its vectors have gone over */
  PetscCall(SpectrumDestroy(s));
  *s = sorted;
  PetscFunctionReturn(0);
}

PetscErrorCode SpectrumTakeFrom(Spectrum *s, PetscInt n, const PetscInt from[])
{
  Spectrum list;

  PetscFunctionBeginUser;
  PetscCall(SpectrumCreate(n, &list));
  for (PetscInt k = 0; k < n; k++)
    PetscCall(SpectrumAdd(&list, s->sigma[from[k]], s->omega[from[k]], s->xr[from[k]], s->xi[from[k]]));
  list.reach = s->reach;
  PetscCall(SpectrumDestroy(s));
  *s = list;
  PetscFunctionReturn(0);
}

PetscErrorCode SpectrumRemove(Spectrum *s, PetscInt i)
{
  PetscFunctionBeginUser;
  PetscCall(VecDestroy(&s->xr[i]));
  PetscCall(VecDestroy(&s->xi[i]));
  for (PetscInt j = i; j + 1 < s->n; j++) SpectrumSwap(s, j, j + 1);
  s->n--;
  PetscFunctionReturn(0);
}

PetscErrorCode SpectrumKeep(Spectrum *s, PetscInt first, PetscInt n)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++)
    if (first) SpectrumSwap(s, i, first + i);
  while (s->n > n) PetscCall(SpectrumRemove(s, s->n - 1));
  PetscFunctionReturn(0);
}

PetscErrorCode SpectrumAppend(Spectrum *from, Spectrum *to)
{
  const PetscInt n = to->n + from->n;
  Spectrum       all;

  PetscFunctionBeginUser;
  PetscCall(SpectrumCreate(n, &all));
  for (PetscInt i = 0; i < n; i++) {
    Spectrum *const source = i < to->n ? to : from;
    const PetscInt  k      = i < to->n ? i : i - to->n;

    all.sigma[i] = source->sigma[k], all.omega[i] = source->omega[k];
    all.xr[i] = source->xr[k], all.xi[i] = source->xi[k];
    source->xr[k] = source->xi[k] = NULL;
  }
  all.n = n;
  PetscCall(SpectrumDestroy(from));
  PetscCall(SpectrumDestroy(to));
  *to = all;
  PetscFunctionReturn(0);
}

PetscErrorCode SpectrumDestroy(Spectrum *s)
{
  PetscFunctionBeginUser;
  PetscCall(SpectrumKeep(s, 0, 0));
  PetscCall(PetscFree4(s->sigma, s->omega, s->xr, s->xi));
  s->capacity = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode ModesGetVectors(Modes modes, PetscInt i, Vec *xr, Vec *xi, Vec *yr, Vec *yi)
{
  PetscFunctionBeginUser;
  PetscCheck(i >= 0 && i < modes->n, modes->comm, PETSC_ERR_ARG_OUTOFRANGE, "mode %" PetscInt_FMT " of %" PetscInt_FMT,
             i, modes->n);
  if (xr) *xr = modes->right.xr[i];
  if (xi) *xi = modes->right.xi[i];
  if (yr) *yr = modes->left_spectrum.n ? modes->left_spectrum.xr[i] : NULL;
  if (yi) *yi = modes->left_spectrum.n ? modes->left_spectrum.xi[i] : NULL;
  PetscFunctionReturn(0);
}

/* A seed of each rank: with one for all, ranks with as many unknowns would begin with equal parts */
PetscErrorCode SolverSeed(BV bv, unsigned long seed)
{
  PetscMPIInt rank;
  PetscRandom random;

  PetscFunctionBeginUser;
  PetscCall(BVGetRandomContext(bv, &random));
  PetscCallMPI(MPI_Comm_rank(PetscObjectComm((PetscObject)bv), &rank));
  PetscCall(PetscRandomSetSeed(random, seed + (unsigned long)rank));
  PetscCall(PetscRandomSeed(random));
  PetscFunctionReturn(0);
}
