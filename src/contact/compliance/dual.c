/*
   Step of Newton's method on the motions that the laws leave free, instead of the forces that they ask for. With V =
   W^-1, which is made once, changes obey dlambda = V dv. The laws of linear.c, in the frame of each pair (n, across,
   e), say of them

      closed   dv_n known,     stick  dv_T known,     open  dlambda = 0
      slip     dlambda_e = -mu dlambda_n,     (1 - alpha) dl_across + a alpha dv_across known

   so that the unknowns are dv of open pairs, and across and along the slip of those that slide: 3 and 2 rows, where
   linear.c has 0 and 2, but none instead of 3 of a pair that sticks. What V leaves by rounding is found again in the
   next step.
*/
#include "complianceimpl.h"

/* smallest of Cholesky's pivots, 1 on the diagonal before, that V is made with: rounding of V is then below 1e-8 of
   it, which the steps of Newton's method take out again */
#define DUAL_PIVOT 1e-8
/* rows beside those of linear.c that pay for two products with V: factors of 0.7 of the rows take 0.34 of the time */
#define DUAL_GAIN 0.7

/* V, or none where W is nearly singular; [3 n][3 n], N/m. It inverts D W D with D = sqrt(kappa), without unit and
   with diagonals of order 1, so that the pivots tell how near to singular W is; V = D (D W D)^-1 D. Made once: W does
   not change. */
static PetscErrorCode DualInvert(ContactCompliance c)
{
  const PetscInt     N    = 3 * c->n;
  const PetscBLASInt rows = (PetscBLASInt)N;
  PetscBLASInt       info;
  PetscReal         *V;

  PetscFunctionBeginUser;
  c->dual.tried = PETSC_TRUE;
  PetscCall(PetscMalloc1(N * N, &V));
  for (PetscInt j = 0; j < N; j++)
    for (PetscInt i = 0; i < N; i++) V[j * N + i] = c->W[j * N + i] * PetscSqrtReal(c->kappa[i / 3] * c->kappa[j / 3]);
  PetscCallBLAS("LAPACKpotrf", LAPACKpotrf_("L", &rows, V, &rows, &info));
  for (PetscInt i = 0; i < N && !info; i++) info = !(PetscSqr(V[i * (N + 1)]) > DUAL_PIVOT);
  if (!info) PetscCallBLAS("LAPACKpotri", LAPACKpotri_("L", &rows, V, &rows, &info));
  if (info) {
    PetscCall(PetscFree(V));
    PetscFunctionReturn(0);
  }
  for (PetscInt j = 0; j < N; j++)
    for (PetscInt i = j; i < N; i++)
      V[j * N + i] = V[i * N + j] = V[j * N + i] * PetscSqrtReal(c->kappa[i / 3] * c->kappa[j / 3]);
  c->dual.V = V;
  PetscCall(PetscMalloc7(N, &c->dual.at, 3 * N, &c->dual.along, 3 * N, &c->dual.test, N, &c->dual.own, N, &c->dual.x, N,
                         &c->dual.dv, N, &c->dual.force));
  PetscFunctionReturn(0);
}

/* Not where a friction coefficient falls with the slip speed, whose derivative these rows do not have, nor on the
   way of path.c, where V is not the inverse. */
PetscErrorCode ComplianceDualServes(ContactCompliance c, PetscBool *serves)
{
  PetscInt rows = 0, n_forces = 0;

  PetscFunctionBeginUser;
  *serves = PETSC_FALSE;
  for (PetscInt p = 0; p < c->n; p++) {
    if (c->varies[p]) PetscFunctionReturn(0);
    rows += c->status[p] == CONTACT_OPEN ? 3 : c->status[p] == CONTACT_SLIP ? 2 : 0;
    n_forces += c->status[p] == CONTACT_OPEN ? 0 : c->status[p] == CONTACT_SLIP ? 2 : 3;
  }
  if (c->blend != 0 || !((PetscReal)rows < DUAL_GAIN * (PetscReal)n_forces)) PetscFunctionReturn(0);
  if (!c->dual.tried) PetscCall(DualInvert(c));
  *serves = c->dual.V ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* A motion of pair p along a direction of (n, t, b) is unknown: of the forces that belong to dv, test . (V dv)_p /
   kappa, with own times the motion itself, is value */
static void DualAddRow(ContactCompliance c, PetscInt p, const PetscReal along[3], const PetscReal test[3],
                       PetscReal own, PetscReal value)
{
  const PetscInt r = c->dual.n_rows++;

  for (PetscInt i = 0; i < 3; i++) {
    c->dual.along[3 * r + i] = along[i];
    c->dual.test[3 * r + i]  = test[i] / c->kappa[p];
  }
  c->dual.at[r]  = p;
  c->dual.own[r] = own;
  c->dual.x[r]   = value;
}

/* Rows of all pairs, and the motions that are known, into dv (m). linear.c's rows are Q dz + a dv = rhs; with Q = 0
   along n and, in stick, along the tangents, dv = rhs / a is known. Across the slip its Q[1][1] = 1 - alpha, alpha
   the factor by which the trial force is shortened to the cone. */
static void DualSetRows(ContactCompliance c)
{
  PetscInt k = 0;

  c->dual.n_rows = 0;
  for (PetscInt p = 0; p < c->n; p++) {
    const CoulombLaw *law = &c->law[p];
    const PetscReal  *e = &c->slide[2 * p], *rhs = &c->rhs[c->row[k]], share = law->Q[1][1];
    const PetscReal   alpha = 1 - share, slope = e[0] * law->P[1][0] + e[1] * law->P[2][0];
    PetscReal        *dv = &c->dual.dv[3 * p];

    dv[0] = dv[1] = dv[2] = 0;
    if (c->status[p] == CONTACT_OPEN) {
      for (PetscInt i = 0; i < 3; i++)
        DualAddRow(c, p, (PetscReal[3]){i == 0, i == 1, i == 2}, (PetscReal[3]){i == 0, i == 1, i == 2}, 0, 0);
      continue;
    }
    k++;
    dv[0] = rhs[0] / c->weight;
    for (PetscInt i = 1; i < 3 && c->status[p] == CONTACT_STICK; i++) dv[i] = rhs[i] / c->weight;
    if (c->status[p] == CONTACT_STICK) continue;
    DualAddRow(c, p, (PetscReal[3]){0, -e[1], e[0]}, (PetscReal[3]){0, -share * e[1], share * e[0]}, c->weight * alpha,
               alpha * rhs[1]);
    DualAddRow(c, p, (PetscReal[3]){0, e[0], e[1]}, (PetscReal[3]){-slope, e[0], e[1]}, 0, 0);
  }
}

/* force = V dv, [3 n] */
static void DualForce(ContactCompliance c)
{
  const PetscBLASInt rows = (PetscBLASInt)(3 * c->n), inc = 1;
  const PetscReal    one = 1, zero = 0;

  BLASgemv_("N", &rows, &rows, &one, c->dual.V, &rows, c->dual.dv, &inc, &zero, c->dual.force, &inc);
}

/* A x = b of the free motions: A[r][s] = test_r . (V along_s) at the pair of r, and own_r on the diagonal; b takes
   off what the known motions dv make there */
static void DualAssemble(ContactCompliance c)
{
  ComplianceDual *d = &c->dual;
  const PetscInt  N = 3 * c->n, m = d->n_rows;

  DualForce(c);
  for (PetscInt s = 0; s < m; s++) {
    const PetscReal *V = &d->V[3 * d->at[s] * N], *b = &d->along[3 * s];

    for (PetscInt i = 0; i < N; i++) c->force[i] = V[i] * b[0] + V[N + i] * b[1] + V[2 * N + i] * b[2];
    for (PetscInt r = 0; r < m; r++) {
      const PetscReal *f = &c->force[3 * d->at[r]], *g = &d->test[3 * r];

      c->A[s * m + r] = g[0] * f[0] + g[1] * f[1] + g[2] * f[2];
    }
    c->A[s * (m + 1)] += d->own[s];
  }
  for (PetscInt r = 0; r < m; r++)
    for (PetscInt i = 0; i < 3; i++) d->x[r] -= d->test[3 * r + i] * d->force[3 * d->at[r] + i];
}

/* dz of the closed pairs, as linear.c has it, into rhs: of the across rows from what is the better known, force or
   motion */
static void DualGather(ContactCompliance c)
{
  ComplianceDual *d = &c->dual;

  for (PetscInt r = 0; r < d->n_rows; r++)
    for (PetscInt i = 0; i < 3; i++) d->dv[3 * d->at[r] + i] += d->along[3 * r + i] * d->x[r];
  DualForce(c);
  for (PetscInt k = 0; k < c->n_closed; k++) {
    const PetscInt    p     = c->closed[k];
    const CoulombLaw *law   = &c->law[p];
    const PetscReal   share = law->Q[1][1];
    PetscReal        *dz    = &c->rhs[c->row[k]], dl[3], force[3], motion[3];

    for (PetscInt i = 0; i < 3; i++) dl[i] = d->force[3 * p + i] / c->kappa[p];
    ComplianceAlongRows(c, k, dl, force);
    ComplianceAlongRows(c, k, &d->dv[3 * p], motion);
    dz[0] = force[0];
    if (c->status[p] == CONTACT_STICK) dz[1] = force[1];
    if (c->status[p] == CONTACT_STICK) dz[2] = force[2];
    if (c->status[p] == CONTACT_SLIP)
      dz[1] = share < 0.5 ? force[1] / (1 - share) : (dz[1] - c->weight * motion[1]) / share;
  }
}

PetscErrorCode ComplianceDualSolve(ContactCompliance c, PetscBool *solved)
{
  PetscBool good;

  PetscFunctionBeginUser;
  PetscCall(ComplianceDualServes(c, solved));
  if (!*solved) PetscFunctionReturn(0);
  PetscCall(ComplianceBegin(c, 0));
  DualSetRows(c);
  DualAssemble(c);
  ComplianceFactorFast(c, c->dual.n_rows, &good);
  if (!good) {
    *solved = PETSC_FALSE;
    PetscCall(PetscArraycpy(c->l, c->l0, 3 * c->n));
    PetscCall(PetscArraycpy(c->v, c->v0, 3 * c->n));
    PetscFunctionReturn(0);
  }
  PetscCall(ComplianceBackSolve(c, c->dual.n_rows, c->dual.x));
  DualGather(c);
  PetscFunctionReturn(0);
}

PetscErrorCode ComplianceDualDestroy(ContactCompliance c)
{
  PetscFunctionBeginUser;
  c->dual.tried = PETSC_FALSE;
  PetscCall(PetscFree(c->dual.V));
  PetscCall(PetscFree7(c->dual.at, c->dual.along, c->dual.test, c->dual.own, c->dual.x, c->dual.dv, c->dual.force));
  PetscFunctionReturn(0);
}
