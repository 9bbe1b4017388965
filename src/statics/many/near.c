/*
   The equilibrium at a point by corrections with what is factored at another one: from u of the basis,

      r = f - K u - G'l + S' D l,   K_b du = r,   u := u + du,

   K_b being the bodies as they are factored with the pairs at the laws and statuses of this point (pairs/small.c). What
   differs is the bodies alone: an error falls by |1 - K_b^-1 K| each time, some 0.2 where moduli differ by as much. A
   factorisation and the compliance of all pairs cost as much as some fifty of these.

   By the same system the influence of a pair: what the bodies do under its force, the other pairs at their statuses.
*/
#include "many.h"

#define NEAR_MOST 30   /* corrections */
#define NEAR_RTOL 1e-6 /* the last one, over the largest closing: what is left is a fifth of it */

/* Statuses and forces l [rows] that belong to w [rows]; how many statuses changed, and the largest |w| */
static PetscErrorCode NearLaws(Statics s, const PetscReal w[], PetscReal l[], PetscInt *n_changed, PetscReal *largest)
{
  PetscReal most = 0;
  PetscInt  n    = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < s->rows.n_pairs; i++) {
    const PetscReal     closing = w[i] - s->rows.law[i].g0;
    const ContactStatus now     = closing > 0 ? CONTACT_SLIP : CONTACT_OPEN;

    n += now != s->status[i];
    s->status[i] = now;
    l[i]         = closing > 0 ? s->rows.law[i].k * closing : 0;
    most         = PetscMax(most, PetscAbsReal(w[i]));
  }
  PetscCallMPI(MPI_Allreduce(&n, n_changed, 1, MPIU_INT, MPI_SUM, s->comm));
  PetscCallMPI(MPI_Allreduce(&most, largest, 1, MPIU_REAL, MPI_MAX, s->comm));
  PetscFunctionReturn(0);
}

/* One correction of u and w; change = the largest one of w */
static PetscErrorCode NearCorrect(Active *a, Mat K, Vec r, Vec du, PetscReal work[], PetscReal *change)
{
  const PetscInt   n    = a->rows->n;
  PetscReal *const zero = work, *const l = work + n, *const w = work + 2 * n;
  const Compliance *c    = a->compliance;
  PetscReal         most = 0;

  PetscFunctionBeginUser;
  PetscCall(MatMult(K, a->u, r));
  PetscCall(VecAYPX(r, -1, a->f));
  PetscCall(ComplianceAddForces(c, 1, a->l, NULL, r));
  PetscCall(PetscArrayzero(zero, n));
  PetscCall(PetscArraycpy(l, a->l, n));
  PetscCall(PetscArraycpy(w, a->w, n));
  PetscCall(ActiveCorrect(a, r, zero));
  for (PetscInt i = 0; i < n; i++) l[i] = a->l[i] - l[i], w[i] = a->w[i] - w[i];
  PetscCall(ComplianceSolve(c, 1, r, l, w, du));
  PetscCall(VecAXPY(a->u, 1, du));
  PetscCall(ComplianceGetRows(c, du, w));
  PetscCall(ComplianceGetRows(c, a->u, a->w));
  for (PetscInt i = 0; i < n; i++) most = PetscMax(most, PetscAbsReal(w[i]));
  PetscCallMPI(MPI_Allreduce(&most, change, 1, MPIU_REAL, MPI_MAX, a->rows->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode ManyNear(Statics s, const PetscReal p[], PetscBool *found)
{
  PetscReal change = PETSC_MAX_REAL, largest = 0, *work;
  PetscInt  n_changed = 1;
  Active    a = {.operators = s->operators, .p = s->p, .rows = &s->rows, .compliance = &s->compliance, .friction = 1};
  Mat       K;
  Vec       r, du;

  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  PetscCall(StaticsSetUp(s, p));
  PetscCall(StaticsCreateLoad(s->operators, s->p, StagesGet(s, 0), &a.f, &a.size));
  PetscCall(PairRowsSetLaws(s->operators, s->p, s->compliance.kappa, &s->rows));
  PetscCall(OperatorsGetBodies(s->operators, s->p, &K, NULL, NULL));
  PetscCall(PetscCalloc1(6 * s->rows.n, &work));
  PetscCall(VecDuplicate(s->u, &r));
  PetscCall(VecDuplicate(s->u, &du));
  a.u      = s->u;
  a.status = s->status;
  a.l      = work + 3 * s->rows.n;
  a.w      = work + 4 * s->rows.n;
  a.free   = work + 5 * s->rows.n;
  PetscCall(ComplianceGetRows(&s->compliance, s->u, a.w));
  for (int it = 0; it < NEAR_MOST && !*found; it++) {
    PetscCall(NearLaws(s, a.w, a.l, &n_changed, &largest));
    if (!n_changed && change <= NEAR_RTOL * largest)
      *found = PETSC_TRUE;
    else
      PetscCall(NearCorrect(&a, K, r, du, work, &change));
  }

  PetscCall(VecDestroy(&a.f));
  PetscCall(VecDestroy(&r));
  PetscCall(VecDestroy(&du));
  PetscCall(PetscFree(work));
  PetscFunctionReturn(0);
}

PetscErrorCode ManyInfluence(Statics s, const PetscReal p[], const char closed[], PetscInt pair)
{
  const PetscInt n = s->rows.n, own = pair - s->rows.begin;
  PetscReal     *work, *zero, *l;
  Active a = {.operators = s->operators, .p = s->p, .rows = &s->rows, .compliance = &s->compliance, .friction = 1};
  Vec    r;

  PetscFunctionBeginUser;
  PetscCall(StaticsSetUp(s, p));
  PetscCall(PairRowsSetLaws(s->operators, s->p, s->compliance.kappa, &s->rows));
  for (PetscInt i = 0; i < n; i++) s->status[i] = closed[i] ? CONTACT_SLIP : CONTACT_OPEN;
  PetscCall(PetscCalloc1(5 * n, &work));
  PetscCall(VecDuplicate(s->u, &r));
  PetscCall(VecSet(r, 0));
  zero     = work;
  l        = work + n;
  a.status = s->status;
  a.l      = work + 2 * n;
  a.w      = work + 3 * n;
  a.free   = work + 4 * n;
  for (PetscInt i = 0; i < n; i++) a.w[i] = s->rows.law[i].g0; /* with l = 0 it obeys the laws of all statuses */
  if (own >= 0 && own < n) l[own] = 1;
  PetscCall(ComplianceAddForces(&s->compliance, 1, l, NULL, r));
  PetscCall(ActiveCorrect(&a, r, zero));
  for (PetscInt i = 0; i < n; i++) a.w[i] -= s->rows.law[i].g0;
  PetscCall(ComplianceSolve(&s->compliance, 1, r, a.l, a.w, s->u));
  PetscCall(VecDestroy(&r));
  PetscCall(PetscFree(work));
  PetscFunctionReturn(0);
}
