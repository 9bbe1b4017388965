/*
   Damping that leaves the undamped vectors as they are: with C = alpha M + beta K, friction included in K,

      lambda^2 + (alpha + beta kappa) lambda + kappa = 0

   for every undamped kappa. One pair of conjugates, or where damping keeps a mode from oscillating two real
   eigenvalues; a rigid mode, kappa = 0, becomes 0 and -alpha, or with alpha = 0 a double zero that is listed once.
*/
#include "projection.h"

#define MAP_EXACT     1e-10 /* of |C z|: less is rounding */
#define MAP_ROUNDINGS 100   /* kappa below this many times what rounding in K does is zero */

/* Whether C z = alpha M z + beta K z */
static PetscErrorCode HoldsFor(const Projection *p, Vec z, PetscBool *holds)
{
  PetscReal left, rest;
  Vec       Cz, work;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(z, &Cz));
  PetscCall(VecDuplicate(z, &work));
  PetscCall(MatMult(p->pencil->C, z, Cz));
  PetscCall(VecNorm(Cz, NORM_2, &left));
  PetscCall(MatMult(p->pencil->M, z, work));
  PetscCall(VecAXPY(Cz, -p->alpha, work));
  PetscCall(MatMult(p->pencil->K, z, work));
  PetscCall(VecAXPY(Cz, -p->beta, work));
  PetscCall(VecNorm(Cz, NORM_2, &rest));
  *holds = rest <= MAP_EXACT * left ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(VecDestroy(&Cz));
  PetscCall(VecDestroy(&work));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionIsExact(const Projection *p, const Spectrum *right, PetscBool *exact)
{
  PetscRandom random;
  Vec         z;

  PetscFunctionBeginUser;
  *exact = PETSC_FALSE;
  if (p->pencil->n_laws) PetscFunctionReturn(0);
  PetscCall(MatCreateVecs(p->pencil->K, &z, NULL));
  PetscCall(PetscRandomCreate(p->modes->comm, &random));
  PetscCall(VecSetRandom(z, random));
  PetscCall(PetscRandomDestroy(&random));
  PetscCall(HoldsFor(p, z, exact));
  PetscCall(VecSet(z, 0)); /* K outweighs M in a rough vector, not in modes */
  for (PetscInt i = 0; i < right->n && *exact; i++) PetscCall(VecAXPY(z, 1, right->xr[i]));
  if (*exact) PetscCall(HoldsFor(p, z, exact));
  PetscCall(VecDestroy(&z));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionIsZero(const Projection *p, const Spectrum *s, PetscInt i, PetscBool *zero)
{
  const PetscReal size = cabs(SpectrumLambda(s, i));
  PetscReal       energy, mass;
  Vec             diagonal, work;

  PetscFunctionBeginUser;
  *zero = PETSC_FALSE;
  if (size > p->window->known.scale) PetscFunctionReturn(0);
  PetscCall(VecDuplicate(s->xr[i], &diagonal));
  PetscCall(VecDuplicate(s->xr[i], &work));
  PetscCall(MatMult(p->pencil->M, s->xr[i], work));
  PetscCall(VecDot(work, s->xr[i], &mass));
  PetscCall(MatGetDiagonal(p->pencil->K, diagonal));
  PetscCall(VecPointwiseMult(work, diagonal, s->xr[i]));
  PetscCall(VecDot(work, s->xr[i], &energy));
  *zero = size * size * mass <= MAP_ROUNDINGS * PETSC_MACHINE_EPSILON * energy ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(VecDestroy(&diagonal));
  PetscCall(VecDestroy(&work));
  PetscFunctionReturn(0);
}

/* The eigenvalues with omega >= 0 that become of kappa; returns how many */
static PetscInt MapValue(const Projection *p, PetscComplex kappa, PetscComplex lambda[2])
{
  const PetscComplex b = 0.5 * (p->alpha + p->beta * kappa), root = csqrt(b * b - kappa);
  const PetscComplex away = creal(conj(b) * root) < 0 ? b - root : b + root; /* no cancellation */

  lambda[0] = -away;
  lambda[1] = away != 0 ? -kappa / away : 0;
  if (cimag(kappa) != 0 || creal(b * b) < creal(kappa)) {
    if (cimag(lambda[0]) < cimag(lambda[1])) lambda[0] = lambda[1];
    return 1;
  }
  lambda[0] = creal(lambda[0]);
  lambda[1] = creal(lambda[1]);
  return away != 0 ? 2 : 1;
}

PetscErrorCode ProjectionMap(const Projection *p, const Spectrum *from, Spectrum *to)
{
  PetscFunctionBeginUser;
  PetscCall(SpectrumCreate(2 * from->n, to));
  for (PetscInt i = 0; i < from->n; i++) {
    const PetscComplex was = SpectrumLambda(from, i);
    PetscComplex       lambda[2];
    PetscBool          zero;
    PetscInt           n;

    PetscCall(ProjectionIsZero(p, from, i, &zero));
    n = MapValue(p, zero ? 0 : -was * was, lambda);
    for (PetscInt j = 0; j < n; j++)
      if (ProjectionHas(p, lambda[j]))
        PetscCall(SpectrumAdd(to, creal(lambda[j]), cimag(lambda[j]), from->xr[i], from->xi[i]));
  }
  PetscCall(SpectrumSort(to));
  PetscFunctionReturn(0);
}
