/*
   Linear system of the closed pairs. With the laws l = P z + p0, w = Q z + q0 and w = -a v,

      [Q + a W kappa P] dz = -[Q z0 + q0 + a free + a W kappa (P z0 + p0)],     l = P (z0 + dz) + p0

   A pair that slides along e with a friction that does not change with the slip has P z = P (1 - e e') z: how far it
   slides makes no force. Its z and rows are turned to (n, across e, e), where Q is diagonal, and the last of both left
   out: two rows instead of three, and what z_e is follows from v.

   z0 is taken from the present l, v, so that what rounding or a shift of the matrix leaves is found again in the next
   step. A border of one row and column is the path's. Singular matrices (pairs that share what they carry) get a shift
   of their diagonal: the force changes least.
*/
#include "complianceimpl.h"

/* of the diagonal, which is of order 1: far above rounding of some hundred rows, far below what a step needs */
#define SINGULAR_SHIFT 1e-10
/* smallest pivot beside the largest, some hundred roundings */
#define SINGULAR_PIVOT 1e-13
/* the same where rows are not exchanged: rounding grows by its inverse, and the next step still gains eight figures */
#define FAST_PIVOT 1e-8

/* Rows of closed pair k */
static inline PetscInt LinearRows(const ContactCompliance c, PetscInt k)
{
  return c->row[k + 1] - c->row[k];
}

/* A law along (n, across e, e): with F = [e_across'; e'] (orthonormal), rows of Q and q0 become F Q F', F q0, columns
   of P become P F'; l stays along (n, t, b). After it Q is diagonal, and column 2 of P is 0 where friction does not
   change with the slip. */
static void LinearTurn(const PetscReal e[2], CoulombLaw *law)
{
  const PetscReal F[2][2] = {{-e[1], e[0]}, {e[0], e[1]}};
  CoulombLaw      old     = *law;

  for (int i = 0; i < 2; i++) {
    law->q0[1 + i] = F[i][0] * old.q0[1] + F[i][1] * old.q0[2];
    for (int j = 0; j < 2; j++) {
      law->P[1 + i][1 + j] = old.P[1 + i][1] * F[j][0] + old.P[1 + i][2] * F[j][1];
      law->Q[1 + i][1 + j] = 0;
      for (int k = 0; k < 2; k++)
        law->Q[1 + i][1 + j] += F[i][k] * (old.Q[1 + k][1] * F[j][0] + old.Q[1 + k][2] * F[j][1]);
    }
  }
}

void ComplianceLinearise(ContactCompliance c)
{
  c->n_closed = 0;
  c->row[0]   = 0;
  for (PetscInt p = 0; p < c->n; p++) {
    PetscReal        *e      = &c->slide[2 * p], w[3], length;
    const CoulombPair pair   = ComplianceGetPair(c, p, c->weight, w);
    const PetscBool   slides = c->status[p] == CONTACT_SLIP && pair.fall == 0 ? PETSC_TRUE : PETSC_FALSE;
    const PetscInt    row    = c->row[c->n_closed];

    if (c->status[p] == CONTACT_OPEN) continue;
    CoulombLinearise(&pair, c->status[p], &c->l[3 * p], w, &c->law[p]);
    length = CoulombTrial(&pair, &c->l[3 * p], w, e);
    for (PetscInt i = 0; i < 2; i++) e[i] = length > 0 ? e[i] / length : 1 - i;
    if (slides) LinearTurn(e, &c->law[p]);
    c->closed[c->n_closed++] = p;
    c->row[c->n_closed]      = row + (slides ? 2 : 3);
  }
}

void ComplianceAlongRows(const ContactCompliance c, PetscInt k, const PetscReal x[], PetscReal y[])
{
  const PetscReal *e = &c->slide[2 * c->closed[k]];

  y[0] = x[0];
  y[1] = LinearRows(c, k) == 2 ? e[0] * x[2] - e[1] * x[1] : x[1];
  if (LinearRows(c, k) == 3) y[2] = x[2];
}

/* z of a closed pair at its present l, v, of its rows: the point where its law was linearised. Normal and stick: z =
   l. Slip: z_T = (mu l_n - |q|) e with q = v_T - l_T and e = q / |q|, so that -e e'z is the slip (coulomb.h). The
   system is linear: any z0 gives the same z0 + dz but for rounding. */
static void LinearPoint(const ContactCompliance c, PetscInt k, PetscReal z[3])
{
  const PetscInt    p = c->closed[k];
  const PetscReal  *l = &c->l[3 * p], *v = &c->v[3 * p];
  const CoulombLaw *law    = &c->law[p];
  const PetscReal   a      = ComplianceIsMap(c) ? c->weight : 1; /* where GMRES has to find dz, it is 0 on the laws */
  const PetscReal   q[2]   = {a * v[1] - l[1], a * v[2] - l[2]};
  PetscReal         length = hypot(q[0], q[1]), x[3];

  for (PetscInt i = 0; i < 3; i++) x[i] = l[i];
  for (PetscInt i = 1; i < 3 && c->status[p] == CONTACT_SLIP; i++) {
    const PetscReal e = length > 0 ? q[i - 1] / length : 2 - i;

    x[i] = -law->P[i][0] * l[0] - length * e;
  }
  ComplianceAlongRows(c, k, x, z);
}

/* Room for the matrix of m rows, half as many more, and never beyond all pairs and the border; contents are lost,
   since an assembly follows */
static PetscErrorCode LinearReserve(ContactCompliance c, PetscInt m)
{
  PetscFunctionBeginUser;
  if (m <= c->n_room) PetscFunctionReturn(0);
  c->n_room = PetscMin(3 * c->n + 1, m + m / 2);
  PetscCall(PetscFree3(c->A, c->rhs, c->pivot));
  PetscCall(
    PetscMalloc3(ComplianceIsMap(c) ? 0 : c->n_room * c->n_room, &c->A, c->n_room, &c->rhs, c->n_room, &c->pivot));
  PetscFunctionReturn(0);
}

/* The columns of closed pair k of Q + a [(1 - t) W kappa + t I] P, two or three; column j sums three columns of W
   with the weights a (1 - t) kappa_p P[.][j], so that W P is never formed */
static void LinearColumns(ContactCompliance c, PetscInt k, PetscInt rows)
{
  const PetscInt    p = c->closed[k], N = 3 * c->n;
  const CoulombLaw *law   = &c->law[p];
  const PetscReal   kappa = c->weight * (1 - c->blend) * c->kappa[p];
  const PetscReal  *W[3]  = {&c->W[3 * p * N], &c->W[(3 * p + 1) * N], &c->W[(3 * p + 2) * N]};
  PetscReal         blended[3];

  for (PetscInt j = 0; j < LinearRows(c, k); j++) {
    PetscReal      *column = &c->A[(c->row[k] + j) * rows];
    const PetscReal a = kappa * law->P[0][j], b = kappa * law->P[1][j], d = kappa * law->P[2][j];

    for (PetscInt m = 0; m < c->n_closed; m++) {
      const PetscInt at = 3 * c->closed[m];
      PetscReal      x[3];

      for (PetscInt i = 0; i < 3; i++) x[i] = a * W[0][at + i] + b * W[1][at + i] + d * W[2][at + i];
      ComplianceAlongRows(c, m, x, &column[c->row[m]]);
    }
    ComplianceAlongRows(c, k, (PetscReal[3]){law->P[0][j], law->P[1][j], law->P[2][j]}, blended);
    for (PetscInt i = 0; i < LinearRows(c, k); i++)
      column[c->row[k] + i] += law->Q[i][j] + c->weight * c->blend * blended[i];
  }
}

/* The right-hand side -(Q z0 + q0 + a v), with v at l = P z0 + p0. That l is left in c->l, and 0 at open pairs: what
   a step adds to it (ComplianceTake()) is P dz alone. */
PetscErrorCode ComplianceBegin(ContactCompliance c, PetscInt border)
{
  PetscFunctionBeginUser;
  PetscCall(LinearReserve(c, c->row[c->n_closed] + border));
  for (PetscInt k = 0; k < c->n_closed; k++) { /* l = P z0 + p0, for which v is to be found */
    const PetscInt    p   = c->closed[k];
    const CoulombLaw *law = &c->law[p];
    PetscReal         z[3];

    LinearPoint(c, k, z);
    for (PetscInt i = 0; i < 3; i++) {
      c->l[3 * p + i] = law->p0[i];
      for (PetscInt j = 0; j < LinearRows(c, k); j++) c->l[3 * p + i] += law->P[i][j] * z[j];
    }
    for (PetscInt i = 0; i < LinearRows(c, k); i++) {
      c->rhs[c->row[k] + i] = -law->q0[i];
      for (PetscInt j = 0; j < LinearRows(c, k); j++) c->rhs[c->row[k] + i] -= law->Q[i][j] * z[j];
    }
  }
  for (PetscInt p = 0; p < c->n; p++)
    if (c->status[p] == CONTACT_OPEN) c->l[3 * p] = c->l[3 * p + 1] = c->l[3 * p + 2] = 0;
  if (ComplianceIsMap(c))
    PetscCall(PetscArraycpy(c->v, c->v0, 3 * c->n)); /* krylov.c moves from there */
  else
    PetscCall(ComplianceMove(c));
  for (PetscInt k = 0; k < c->n_closed; k++) {
    PetscReal v[3];

    ComplianceAlongRows(c, k, &c->v[3 * c->closed[k]], v);
    for (PetscInt i = 0; i < LinearRows(c, k); i++) c->rhs[c->row[k] + i] -= c->weight * v[i];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ComplianceAssemble(ContactCompliance c, PetscInt border)
{
  PetscFunctionBeginUser;
  PetscCall(ComplianceBegin(c, border));
  for (PetscInt k = 0; k < c->n_closed; k++) LinearColumns(c, k, c->row[c->n_closed] + border);
  PetscFunctionReturn(0);
}

void ComplianceShift(ContactCompliance c, PetscInt border)
{
  const PetscInt rows = c->row[c->n_closed];

  for (PetscInt i = 0; i < rows; i++) c->A[i * (rows + border + 1)] += SINGULAR_SHIFT;
}

/* Factors in the place of A, which is lost: where they are not good it is assembled again */
void ComplianceFactorFast(ContactCompliance c, PetscInt rows, PetscBool *good)
{
  *good        = ComplianceLUFactor(rows, c->A) > FAST_PIVOT ? PETSC_TRUE : PETSC_FALSE;
  c->exchanged = PETSC_FALSE;
  c->report.factors++;
}

PetscErrorCode ComplianceFactor(ContactCompliance c, PetscInt rows, PetscBool *singular)
{
  const PetscBLASInt m     = (PetscBLASInt)rows;
  PetscBLASInt       info  = 0;
  PetscReal          least = PETSC_MAX_REAL, largest = 0;

  PetscFunctionBeginUser;
  if (rows) PetscCallBLAS("LAPACKgetrf", LAPACKgetrf_(&m, &m, c->A, &m, c->pivot, &info));
  PetscCheck(info >= 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK getrf: info %d", (int)info);
  for (PetscInt i = 0; i < rows; i++) {
    least   = PetscMin(least, PetscAbsReal(c->A[i * rows + i]));
    largest = PetscMax(largest, PetscAbsReal(c->A[i * rows + i]));
  }
  c->exchanged = PETSC_TRUE;
  *singular    = rows && !(least > SINGULAR_PIVOT * largest) ? PETSC_TRUE : PETSC_FALSE;
  c->report.factors++;
  PetscFunctionReturn(0);
}

PetscErrorCode ComplianceBackSolve(const ContactCompliance c, PetscInt rows, PetscReal x[])
{
  const PetscBLASInt m = (PetscBLASInt)rows, one = 1;
  PetscBLASInt       info = 0;

  PetscFunctionBeginUser;
  if (!c->exchanged) ComplianceLUSolve(rows, c->A, x);
  if (!c->exchanged) PetscFunctionReturn(0);
  if (m) PetscCallBLAS("LAPACKgetrs", LAPACKgetrs_("N", &m, &one, c->A, &m, c->pivot, x, &m, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK getrs: info %d", (int)info);
  PetscFunctionReturn(0);
}

void ComplianceTake(ContactCompliance c)
{
  for (PetscInt k = 0; k < c->n_closed; k++)
    for (PetscInt i = 0; i < 3; i++)
      for (PetscInt j = 0; j < LinearRows(c, k); j++)
        c->l[3 * c->closed[k] + i] += c->law[c->closed[k]].P[i][j] * c->rhs[c->row[k] + j];
}
