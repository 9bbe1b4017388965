/*
   A step of Newton's method where W is a map. The linear system of linear.c, in z of the closed pairs,

      [Q + a W kappa P] dz = rhs,

   has rows of which the motion is known (Q = 0: normal, and tangents that stick). Directions held by map.hold() have
   springs tau there, so that motions y of forces F are

      y = V (F + tau y),   V = (1 / W + tau)^-1 near 1 / tau in the directions held,

   and tau y is a known force where y is known. What is left is a system of the second kind on V, one product an
   iteration of GMRES:

      known       (tau / kappa) [V kappa P dz] = (tau / kappa) (rhs / a - y0)
      others      [Q + a V kappa P] dz = rhs - a y0,       y0 = V (what is known)
      released    zeta - (tau / kappa) [V (kappa P dz + kappa zeta)] = (tau / kappa) y0,   kappa zeta = tau y

   released directions being those whose springs no pair wants any more. GMRES needs a handful of iterations for
   friction that follows the normal force, and as many more as pairs have changed; where these are many the springs are
   set anew, which costs a factorisation.
*/
#include "base/algebra/copies.h"
#include "complianceimpl.h"

#define KRYLOV_RTOL   1e-6 /* of the residual: Newton's method takes the rest out in its next step */
#define KRYLOV_MAX_IT 120
/* iterations more than with new springs, in all since these were set: as many as new ones cost, a factorisation and a
   solution for each mode */
#define KRYLOV_PAYS 100
/* of the directions held: those that changed, from which on new factors are better at once */
#define KRYLOV_CHANGED 0.1

PetscErrorCode ComplianceKrylovHold(ContactCompliance c, const PetscBool held[])
{
  ComplianceKrylov *k = &c->krylov;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(k->held, held, 3 * c->n));
  PetscCall(k->map.hold(k->map.ctx, k->held));
  k->stands  = PETSC_TRUE;
  k->n_first = k->n_more = 0;
  c->report.factors++;
  PetscFunctionReturn(0);
}

/* Factors for the present statuses where there are none, where they are far from these, or slow */
static PetscErrorCode KrylovPrepare(ContactCompliance c)
{
  ComplianceKrylov *k         = &c->krylov;
  PetscInt          n_changed = 0, n_held = 0;
  PetscBool        *held;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(3 * c->n, &held));
  for (PetscInt i = 0; i < 3 * c->n; i++) {
    const ContactStatus status = c->status[i / 3];

    held[i] = status == CONTACT_STICK || (status == CONTACT_SLIP && i % 3 == 0) ? PETSC_TRUE : PETSC_FALSE;
    n_held += held[i];
    n_changed += held[i] != k->held[i];
  }
  if (!k->stands || (PetscReal)n_changed > KRYLOV_CHANGED * (PetscReal)n_held || (k->n_more > KRYLOV_PAYS && n_changed))
    PetscCall(ComplianceKrylovHold(c, held));
  PetscCall(PetscFree(held));
  PetscFunctionReturn(0);
}

/* Whether the motion of a closed pair along direction i is known: then its row has the number i */
static inline PetscBool KrylovKnows(const ContactCompliance c, PetscInt p, PetscInt i)
{
  return c->status[p] == CONTACT_STICK || (c->status[p] == CONTACT_SLIP && i == 0) ? PETSC_TRUE : PETSC_FALSE;
}

/* Factors of the rows of closed pair k, [3]: of those that are held and known */
static void KrylovScale(const ContactCompliance c, PetscInt k, PetscReal scale[])
{
  const PetscInt p = c->closed[k];

  for (PetscInt i = 0; i < 3; i++)
    scale[i] = KrylovKnows(c, p, i) && c->krylov.held[3 * p + i] ? c->krylov.map.tau[3 * p + i] / c->kappa[p] : 1;
}

/* The directions that are held and of which nothing is known */
static void KrylovRelease(ContactCompliance c)
{
  ComplianceKrylov *k = &c->krylov;

  k->n_released = 0;
  for (PetscInt i = 0; i < 3 * c->n; i++)
    if (k->held[i] && !KrylovKnows(c, i / 3, i % 3)) k->released[k->n_released++] = i;
}

/* Motions y at rows of a vector, without the part of Q: known and others, then released ones */
static void KrylovRows(const ContactCompliance c, const PetscReal y[], PetscReal rows[])
{
  const ComplianceKrylov *k = &c->krylov;
  PetscReal               v[3], scale[3];

  for (PetscInt j = 0; j < c->n_closed; j++) {
    ComplianceAlongRows(c, j, &y[3 * c->closed[j]], v);
    KrylovScale(c, j, scale);
    for (PetscInt i = 0; i < c->row[j + 1] - c->row[j]; i++) rows[c->row[j] + i] = c->weight * scale[i] * v[i];
  }
  for (PetscInt j = 0; j < k->n_released; j++) {
    const PetscInt  i = k->released[j];
    const PetscReal t = k->map.tau[i] / c->kappa[i / 3];

    rows[c->row[c->n_closed] + j] = -(1 + t) * t * y[i];
  }
}

/* The system times x */
static PetscErrorCode KrylovMult(Mat A, Vec from, Vec to)
{
  ContactCompliance c;
  ComplianceKrylov *k;
  const PetscReal  *x;
  PetscReal        *y, scale[3];

  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(A, &c));
  k = &c->krylov;
  PetscCall(VecGetArrayRead(from, &x));
  PetscCall(VecGetArray(to, &y));
  PetscCall(PetscArrayzero(k->force, 3 * c->n));
  for (PetscInt j = 0; j < c->n_closed; j++) {
    const PetscInt p = c->closed[j];

    for (PetscInt i = 0; i < 3; i++)
      for (PetscInt d = 0; d < c->row[j + 1] - c->row[j]; d++)
        k->force[3 * p + i] += c->kappa[p] * c->law[p].P[i][d] * x[c->row[j] + d];
  }
  for (PetscInt j = 0; j < k->n_released; j++)
    k->force[k->released[j]] += c->kappa[k->released[j] / 3] * x[c->row[c->n_closed] + j];
  PetscCall(k->map.press(k->map.ctx, k->force, k->motion));
  KrylovRows(c, k->motion, y);
  for (PetscInt j = 0; j < c->n_closed; j++) {
    KrylovScale(c, j, scale);
    for (PetscInt i = 0; i < c->row[j + 1] - c->row[j]; i++)
      for (PetscInt d = 0; d < c->row[j + 1] - c->row[j]; d++)
        y[c->row[j] + i] += scale[i] * c->law[c->closed[j]].Q[i][d] * x[c->row[j] + d];
  }
  for (PetscInt j = 0; j < k->n_released; j++) {
    const PetscInt r = c->row[c->n_closed] + j, i = k->released[j];

    y[r] += (1 + k->map.tau[i] / c->kappa[i / 3]) * x[r];
  }
  PetscCall(VecRestoreArray(to, &y));
  PetscCall(VecRestoreArrayRead(from, &x));
  PetscFunctionReturn(0);
}

/* The right-hand side of the present laws from rhs, which has v of the point before; l has the forces of that point on
   the laws */
static PetscErrorCode KrylovBegin(ContactCompliance c, PetscReal b[])
{
  ComplianceKrylov *k    = &c->krylov;
  const PetscInt    rows = c->row[c->n_closed];
  PetscReal         scale[3];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < 3 * c->n; i++) k->force[i] = c->kappa[i / 3] * (c->l[i] - c->l0[i]);
  for (PetscInt j = 0; j < c->n_closed; j++)
    for (PetscInt i = 0; i < c->row[j + 1] - c->row[j]; i++) {
      const PetscInt at = 3 * c->closed[j] + i;

      if (KrylovKnows(c, c->closed[j], i) && k->held[at])
        k->force[at] += k->map.tau[at] * c->rhs[c->row[j] + i] / c->weight;
    }
  PetscCall(k->map.press(k->map.ctx, k->force, k->motion));
  KrylovRows(c, k->motion, b);
  for (PetscInt i = 0; i < rows + k->n_released; i++) b[i] = -b[i];
  for (PetscInt j = 0; j < c->n_closed; j++) {
    KrylovScale(c, j, scale);
    for (PetscInt i = 0; i < c->row[j + 1] - c->row[j]; i++) b[c->row[j] + i] += scale[i] * c->rhs[c->row[j] + i];
  }
  PetscFunctionReturn(0);
}

/* z of the tangents of a pair that slides, [rows - 1]: (Q + a P) z = b of the pair alone */
static void KrylovTurn(const ContactCompliance c, PetscInt k, const PetscReal b[], PetscReal z[])
{
  const CoulombLaw *law = &c->law[c->closed[k]];
  PetscReal         B[2][2], determinant;

  if (c->row[k + 1] - c->row[k] == 2) {
    z[0] = b[0] / (law->Q[1][1] + c->weight * hypot(law->P[1][1], law->P[2][1]));
    return;
  }
  for (PetscInt i = 0; i < 2; i++)
    for (PetscInt j = 0; j < 2; j++) B[i][j] = law->Q[1 + i][1 + j] + c->weight * law->P[1 + i][1 + j];
  determinant = B[0][0] * B[1][1] - B[0][1] * B[1][0];
  z[0]        = determinant != 0 ? (B[1][1] * b[0] - B[0][1] * b[1]) / determinant : b[0];
  z[1]        = determinant != 0 ? (B[0][0] * b[1] - B[1][0] * b[0]) / determinant : b[1];
}

/* The system without what other pairs do */
static PetscErrorCode KrylovPress(PC pc, Vec from, Vec to)
{
  ContactCompliance c;
  const PetscReal  *b;
  PetscReal        *z;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &c));
  PetscCall(VecGetArrayRead(from, &b));
  PetscCall(VecGetArray(to, &z));
  for (PetscInt k = 0; k < c->n_closed; k++) {
    const PetscInt p = c->closed[k], known = c->status[p] == CONTACT_STICK ? 3 : 1;

    for (PetscInt i = 0; i < known; i++) z[c->row[k] + i] = b[c->row[k] + i] / c->weight;
    if (c->status[p] == CONTACT_SLIP) KrylovTurn(c, k, &b[c->row[k] + 1], &z[c->row[k] + 1]);
  }
  for (PetscInt j = c->row[c->n_closed]; j < c->row[c->n_closed] + c->krylov.n_released; j++) z[j] = b[j];
  PetscCall(VecRestoreArray(to, &z));
  PetscCall(VecRestoreArrayRead(from, &b));
  PetscFunctionReturn(0);
}

/* GMRES on each rank's copy of the vectors, which are the same numbers; products are made by all together */
static PetscErrorCode KrylovCreate(ContactCompliance c, PetscInt rows, KSP *ksp)
{
  Mat A;
  PC  pc;

  PetscFunctionBeginUser;
  PetscCall(MatCreateShell(PETSC_COMM_SELF, rows, rows, rows, rows, c, &A));
  PetscCall(MatShellSetOperation(A, MATOP_MULT, (void (*)(void))KrylovMult));
  PetscCall(KSPCreate(PETSC_COMM_SELF, ksp));
  PetscCall(KSPSetOperators(*ksp, A, A));
  PetscCall(KSPSetType(*ksp, KSPGMRES));
  PetscCall(KSPGMRESSetRestart(*ksp, KRYLOV_MAX_IT));
  PetscCall(KSPSetPCSide(*ksp, PC_RIGHT));
  PetscCall(KSPSetTolerances(*ksp, KRYLOV_RTOL, 0, PETSC_DEFAULT, KRYLOV_MAX_IT));
  PetscCall(CopiesEndTogether(c->krylov.map.comm, *ksp));
  PetscCall(KSPGetPC(*ksp, &pc));
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetContext(pc, c));
  PetscCall(PCShellSetApply(pc, KrylovPress));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(0);
}

/* rhs of the present laws, then dz in its place. A solution that is not good enough is a shorter step. */
PetscErrorCode ComplianceKrylovSolve(ContactCompliance c)
{
  const PetscInt rows = c->row[c->n_closed];
  PetscReal     *right, *solution;
  PetscInt       its, n;
  KSP            ksp;
  Vec            b, x;

  PetscFunctionBeginUser;
  PetscCall(ComplianceBegin(c, 0));
  if (!rows) PetscFunctionReturn(0);
  PetscCall(KrylovPrepare(c));
  KrylovRelease(c);
  n = rows + c->krylov.n_released;
  PetscCall(PetscCalloc2(n, &right, n, &solution));
  PetscCall(KrylovBegin(c, right));
  PetscCall(KrylovCreate(c, n, &ksp));
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, right, &b));
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, solution, &x));
  PetscCall(KSPSolve(ksp, b, x));
  PetscCall(KSPGetIterationNumber(ksp, &its));
  PetscCallMPI(MPI_Bcast(solution, (PetscMPIInt)rows, MPIU_REAL, 0, c->krylov.map.comm));
  PetscCall(PetscArraycpy(c->rhs, solution, rows));
  if (!c->krylov.n_first) c->krylov.n_first = PetscMax(1, its);
  c->krylov.n_more += PetscMax(0, its - c->krylov.n_first);
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&b));
  PetscCall(KSPDestroy(&ksp));
  PetscCall(PetscFree2(right, solution));
  PetscFunctionReturn(0);
}
