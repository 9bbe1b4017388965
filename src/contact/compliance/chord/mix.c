/*
   Acceleration of l = G(l) (D. G. Anderson, J. ACM 12, 1965, 547): of the differences of x and of f = G(x) - x, the
   combination is taken that would make f least if G were linear. A few motions of all pairs together are what G
   converges slowly in, or not at all; as many differences take them out. Differences of f are kept as an orthonormal
   basis B, with those of G(x) that belong to them, S: f loses B B'f, and G(x) becomes G(x) - S B'f.
*/
#include "contact/compliance/complianceimpl.h"

/* of its length: a difference of which less is new says nothing, rounding of two products apart */
#define MIX_ALIKE 1e-8
/* one that keeps less of its length is made orthogonal once more; twice is enough (W. Kahan, in B. N. Parlett, The
   Symmetric Eigenvalue Problem, 1980) */
#define MIX_AGAIN 0.1

static PetscReal MixDot(PetscInt n, const PetscReal x[], const PetscReal y[])
{
  const PetscBLASInt rows = (PetscBLASInt)n, one = 1;

  return BLASdot_(&rows, x, &one, y, &one);
}

/* y := B'x; x -= A y, of n columns of N */
static void MixAlong(PetscInt N, PetscInt n, const PetscReal B[], const PetscReal x[], PetscReal y[])
{
  const PetscBLASInt rows = (PetscBLASInt)N, columns = (PetscBLASInt)n, inc = 1;
  const PetscReal    one = 1, zero = 0;

  if (n) BLASgemv_("T", &rows, &columns, &one, B, &rows, x, &inc, &zero, y, &inc);
}

static void MixTake(PetscInt N, PetscInt n, const PetscReal A[], const PetscReal y[], PetscReal x[])
{
  const PetscBLASInt rows = (PetscBLASInt)N, columns = (PetscBLASInt)n, inc = 1;
  const PetscReal    minus = -1, one = 1;

  if (n) BLASgemv_("N", &rows, &columns, &minus, A, &rows, y, &inc, &one, x, &inc);
}

/* Adds the difference to the iterate before: b = f - f_before, s = (x + f) - (x_before + f_before) of G(x), both less
   the same combination of the columns kept, and both divided by |b|. Where there is no room the basis begins anew
   with this one difference. A difference that is not new becomes a column of zeros. */
static void MixExtend(ContactCompliance c, const PetscReal x[], const PetscReal f[])
{
  ComplianceChord *h = &c->chord;
  const PetscInt   N = 3 * c->n, n = h->n_mixed == COMPLIANCE_MIXED ? 0 : h->n_mixed;
  PetscReal       *b = &h->basis[N * n], *s = &h->step[N * n], along[COMPLIANCE_MIXED], whole, length, scale;

  for (PetscInt i = 0; i < N; i++) {
    b[i] = f[i] - h->f[i];
    s[i] = x[i] - h->x[i] + b[i];
  }
  whole = length = MixDot(N, b, b);
  for (int k = 0; k < 2 && (k == 0 || length < PetscSqr(MIX_AGAIN) * whole); k++) {
    MixAlong(N, n, h->basis, b, along);
    MixTake(N, n, h->basis, along, b);
    MixTake(N, n, h->step, along, s);
    length = MixDot(N, b, b);
  }
  scale = length > PetscSqr(MIX_ALIKE) * whole ? 1 / PetscSqrtReal(length) : 0;
  for (PetscInt i = 0; i < N; i++) {
    b[i] *= scale;
    s[i] *= scale;
  }
  h->n_mixed = n + 1;
}

/* l = G(x) becomes the combination of the last x, G(x) that would make G(x) - x least if G were linear */
void ComplianceMix(ContactCompliance c, PetscReal x[])
{
  ComplianceChord *h = &c->chord;
  const PetscInt   N = 3 * c->n;
  PetscReal       *f = h->b, along[COMPLIANCE_MIXED];

  for (PetscInt i = 0; i < N; i++) f[i] = c->l[i] - x[i];
  if (h->n_mixed >= 0)
    MixExtend(c, x, f);
  else
    h->n_mixed = 0;
  for (PetscInt i = 0; i < N; i++) {
    h->x[i] = x[i];
    h->f[i] = f[i];
  }
  MixAlong(N, h->n_mixed, h->basis, f, along);
  MixTake(N, h->n_mixed, h->step, along, c->l);
}
