/*
   Acceleration of l = G(l) (D. G. Anderson, J. ACM 12, 1965, 547): of the last differences of x and of f = G(x) - x, the
   combination is taken that would make f least if G were linear. A few motions of all pairs together are what G converges
   slowly in, or not at all; as many differences take them out.
*/
#include "complianceimpl.h"

#define MIX_ALIKE 1e-8 /* a difference that is new by less says nothing */

static PetscReal MixDot(PetscInt n, const PetscReal x[], const PetscReal y[])
{
  const PetscBLASInt rows = (PetscBLASInt)n, one = 1;

  return BLASdot_(&rows, x, &one, y, &one);
}

/* y += a x */
static void MixAdd(PetscInt n, PetscReal a, const PetscReal x[], PetscReal y[])
{
  const PetscBLASInt rows = (PetscBLASInt)n, one = 1;

  BLASaxpy_(&rows, &a, x, &one, y, &one);
}

/* Projects f out of the differences kept, from the newest, each made orthogonal to those before it in `basis`; l loses
   what they promise */
static void MixProject(ContactCompliance c, PetscReal f[])
{
  ComplianceChord *h = &c->chord;
  const PetscInt   N = 3 * c->n, n = PetscMin(h->n_mixed, COMPLIANCE_MIXED);

  for (PetscInt k = 0; k < n; k++) {
    const PetscInt at    = (h->n_mixed - 1 - k) % COMPLIANCE_MIXED;
    PetscReal     *basis = h->basis[k], *step = h->step[k], length, whole, part;

    for (PetscInt i = 0; i < N; i++) {
      basis[i] = h->fall[at][i];
      step[i]  = h->change[at][i] + h->fall[at][i];
    }
    whole = MixDot(N, basis, basis);
    for (PetscInt j = 0; j < k; j++) {
      const PetscReal along = MixDot(N, h->basis[j], basis);

      MixAdd(N, -along, h->basis[j], basis);
      MixAdd(N, -along, h->step[j], step);
    }
    length = MixDot(N, basis, basis);
    length = length > PetscSqr(MIX_ALIKE) * whole ? 1 / PetscSqrtReal(length) : 0;
    for (PetscInt i = 0; i < N; i++) {
      basis[i] *= length;
      step[i] *= length;
    }
    part = MixDot(N, basis, f);
    MixAdd(N, -part, basis, f);
    MixAdd(N, -part, step, c->l);
  }
}

/* l = G(x) becomes the combination of the last x, G(x) that would make G(x) - x least if G were linear */
void ComplianceMix(ContactCompliance c, PetscReal x[])
{
  ComplianceChord *h = &c->chord;
  const PetscInt   N = 3 * c->n, last = h->n_mixed % COMPLIANCE_MIXED;
  PetscReal       *f = h->b;

  for (PetscInt i = 0; i < N; i++) f[i] = c->l[i] - x[i];
  for (PetscInt i = 0; i < N && h->n_mixed >= 0; i++) {
    h->change[last][i] = x[i] - h->x[i];
    h->fall[last][i]   = f[i] - h->f[i];
  }
  for (PetscInt i = 0; i < N; i++) {
    h->x[i] = x[i];
    h->f[i] = f[i];
  }
  h->n_mixed++;
  MixProject(c, f);
}
