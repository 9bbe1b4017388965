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

/* u^H M u */
static PetscReal BeforeLength(const ChangeSpace *s, PetscInt i, PetscComplex u[], PetscComplex z[])
{
  const PetscReal *part[2] = {&s->before[2 * i * s->n_modes], &s->before[(2 * i + 1) * s->n_modes]};
  PetscComplex     sum     = 0;

  for (PetscInt k = 0; k < s->space.space.n; k++) u[k] = k < s->n_modes ? CMPLX(part[0][k], part[1][k]) : 0;
  SpaceMass(s, u, z);
  for (PetscInt k = 0; k < s->n_modes; k++) sum += conj(u[k]) * z[k];
  return creal(sum);
}

PetscErrorCode ChangeFindBefore(const ChangeSpace *s, const PetscComplex x[], ChangedMode *mode)
{
  const PetscInt n = s->space.space.n;
  PetscComplex  *z, *u, *w, xx = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n, &z, n, &u, n, &w));
  SpaceMass(s, x, z);
  for (PetscInt k = 0; k < n; k++) xx += conj(x[k]) * z[k];
  mode->before  = -1;
  mode->overlap = 0;
  for (PetscInt i = 0; i < s->n_before; i++) {
    const PetscComplex ux  = BeforeProduct(s, 2 * i, z) - PETSC_i * BeforeProduct(s, 2 * i + 1, z);
    const PetscReal    mac = PetscSqr(cabs(ux)) / (BeforeLength(s, i, u, w) * creal(xx));

    if (mode->before >= 0 && !(mac > mode->overlap * (1 + OVERLAP_TIE))) continue;
    mode->before  = i;
    mode->overlap = PetscMin(1, mac);
  }
  PetscCall(PetscFree3(z, u, w));
  PetscFunctionReturn(0);
}
