/*
   Which mode of the system as it was a mode of the changed one resembles most: of all u the largest

      |u^H M x|^2 / (u^H M u  x^H M x),

   M of the system as it was, also known as MAC. A change may part a mode into two, or mix several: the same u may stand
   for two x then, with overlaps well below one.
*/
#include "changes.h"
#include <complex.h>

#define OVERLAP_TIE                                                                                                    \
  1e-6 /* relative: of overlaps that differ less the first mode is named, for rounding tells no more */

/* u' M z of the real or imaginary part u of mode i, u as coordinates */
static PetscComplex BeforeProduct(const ChangeSpace *s, PetscInt part, const PetscComplex z[])
{
  const PetscReal *u   = &s->before[part * s->n_modes];
  PetscComplex     sum = 0;

  for (PetscInt k = 0; k < s->n_modes; k++) sum += u[k] * z[k];
  return sum;
}

/* z = M x in the space */
static void SpaceMass(const ChangeSpace *s, const PetscComplex x[], PetscComplex z[])
{
  const PetscInt   n = s->space.space.n;
  const PetscReal *M = s->space.space.term[SUBSPACE_M].small;

  for (PetscInt i = 0; i < n; i++) z[i] = 0;
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++) z[i] += M[j * n + i] * x[j];
}

PetscErrorCode ChangeMeasureBefore(const ChangeSpace *s, PetscInt i, PetscReal *length)
{
  const PetscInt   n       = s->n_modes;
  const PetscReal *part[2] = {&s->before[2 * i * n], &s->before[(2 * i + 1) * n]};
  PetscComplex    *u, *z;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(s->space.space.n, &u, s->space.space.n, &z));
  for (PetscInt k = 0; k < s->space.space.n; k++) u[k] = k < n ? CMPLX(part[0][k], part[1][k]) : 0;
  SpaceMass(s, u, z);
  *length = 0;
  for (PetscInt k = 0; k < n; k++) *length += creal(conj(u[k]) * z[k]);
  PetscCall(PetscFree2(u, z));
  PetscFunctionReturn(0);
}

PetscErrorCode ChangeFindBefore(const ChangeSpace *s, const PetscComplex x[], ChangedMode *mode)
{
  const PetscInt n = s->space.space.n;
  PetscComplex  *z, xx = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &z));
  SpaceMass(s, x, z);
  for (PetscInt k = 0; k < n; k++) xx += conj(x[k]) * z[k];
  mode->before  = -1;
  mode->overlap = 0;
  for (PetscInt i = 0; i < s->n_before; i++) {
    const PetscComplex ux  = BeforeProduct(s, 2 * i, z) - PETSC_i * BeforeProduct(s, 2 * i + 1, z);
    const PetscReal    mac = PetscSqr(cabs(ux)) / (s->length[i] * creal(xx));

    if (mode->before >= 0 && !(mac > mode->overlap * (1 + OVERLAP_TIE))) continue;
    mode->before  = i;
    mode->overlap = PetscMin(1, mac);
  }
  PetscCall(PetscFree(z));
  PetscFunctionReturn(0);
}
