/*
   Linear system of the closed pairs. With the laws l = P z + p0, w = Q z + q0 and w = -a v,

      [Q + a W kappa P] dz = -[Q z0 + q0 + a free + a W kappa (P z0 + p0)],     l = P (z0 + dz) + p0

   z0 is taken from the present l, v, so that what rounding or a shift of the matrix leaves is found again in the next
   step. A border of one row and column is the path's. Singular matrices (pairs that share what they carry) get a shift
   of their diagonal: the force changes least.
*/
#include "complianceimpl.h"

#define SINGULAR_SHIFT 1e-10 /* of the diagonal, which is of order 1 */
#define SINGULAR_PIVOT 1e-13 /* smallest pivot beside the largest */

/* z of a pair at its present l, v: the point where its law was linearised */
static void LinearPoint(const ContactCompliance c, PetscInt p, PetscReal z[3])
{
  const PetscReal  *l = &c->l[3 * p], *v = &c->v[3 * p];
  const CoulombLaw *law    = &c->law[p];
  const PetscReal   q[2]   = {v[1] - l[1], v[2] - l[2]};
  PetscReal         length = hypot(q[0], q[1]);

  for (PetscInt i = 0; i < 3; i++) z[i] = l[i];
  if (c->status[p] != CONTACT_SLIP) return;
  for (PetscInt i = 1; i < 3; i++) {
    const PetscReal e = length > 0 ? q[i - 1] / length : 2 - i;

    z[i] = -law->P[i][0] * l[0] - length * e;
  }
}

/* Room for the matrix of m rows */
static PetscErrorCode LinearReserve(ContactCompliance c, PetscInt m)
{
  PetscFunctionBeginUser;
  if (m <= c->n_room) PetscFunctionReturn(0);
  c->n_room = PetscMin(3 * c->n + 1, m + m / 2);
  PetscCall(PetscFree3(c->A, c->rhs, c->pivot));
  PetscCall(PetscMalloc3(c->n_room * c->n_room, &c->A, c->n_room, &c->rhs, c->n_room, &c->pivot));
  PetscFunctionReturn(0);
}

/* Three columns of the matrix, of closed pair k */
static void LinearColumns(ContactCompliance c, PetscInt k, PetscInt rows)
{
  const PetscInt    p = c->closed[k], N = 3 * c->n;
  const CoulombLaw *law   = &c->law[p];
  const PetscReal   kappa = c->weight * (1 - c->blend) * c->kappa[p];
  const PetscReal  *W[3]  = {&c->W[3 * p * N], &c->W[(3 * p + 1) * N], &c->W[(3 * p + 2) * N]};

  for (PetscInt j = 0; j < 3; j++) {
    PetscReal      *column = &c->A[(3 * k + j) * rows];
    const PetscReal a = kappa * law->P[0][j], b = kappa * law->P[1][j], d = kappa * law->P[2][j];

    for (PetscInt m = 0; m < c->n_closed; m++)
      for (PetscInt i = 0; i < 3; i++) {
        const PetscInt at = 3 * c->closed[m] + i;

        column[3 * m + i] = a * W[0][at] + b * W[1][at] + d * W[2][at];
      }
    for (PetscInt i = 0; i < 3; i++) column[3 * k + i] += law->Q[i][j] + c->weight * c->blend * law->P[i][j];
  }
}

PetscErrorCode ComplianceAssemble(ContactCompliance c, PetscInt border)
{
  const PetscInt rows = 3 * c->n_closed + border;

  PetscFunctionBeginUser;
  PetscCall(LinearReserve(c, rows));
  for (PetscInt k = 0; k < c->n_closed; k++) LinearColumns(c, k, rows);
  for (PetscInt k = 0; k < c->n_closed; k++) { /* l = P z0 + p0, for which v is to be found */
    const PetscInt    p   = c->closed[k];
    const CoulombLaw *law = &c->law[p];
    PetscReal         z[3];

    LinearPoint(c, p, z);
    for (PetscInt i = 0; i < 3; i++) {
      c->l[3 * p + i]   = law->p0[i];
      c->rhs[3 * k + i] = -law->q0[i];
      for (PetscInt j = 0; j < 3; j++) {
        c->l[3 * p + i] += law->P[i][j] * z[j];
        c->rhs[3 * k + i] -= law->Q[i][j] * z[j];
      }
    }
  }
  for (PetscInt p = 0; p < c->n; p++)
    if (c->status[p] == CONTACT_OPEN) c->l[3 * p] = c->l[3 * p + 1] = c->l[3 * p + 2] = 0;
  PetscCall(ComplianceMove(c));
  for (PetscInt k = 0; k < 3 * c->n_closed; k++) c->rhs[k] -= c->weight * c->v[3 * c->closed[k / 3] + k % 3];
  PetscFunctionReturn(0);
}

void ComplianceShift(ContactCompliance c, PetscInt border)
{
  for (PetscInt i = 0; i < 3 * c->n_closed; i++) c->A[i * (3 * c->n_closed + border + 1)] += SINGULAR_SHIFT;
}

PetscErrorCode ComplianceFactor(ContactCompliance c, PetscInt border, PetscBool *singular)
{
  const PetscInt     rows  = 3 * c->n_closed + border;
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
  *singular = rows && !(least > SINGULAR_PIVOT * largest) ? PETSC_TRUE : PETSC_FALSE;
  c->report.factors++;
  PetscFunctionReturn(0);
}

PetscErrorCode ComplianceBackSolve(const ContactCompliance c, PetscInt border)
{
  const PetscBLASInt m = (PetscBLASInt)(3 * c->n_closed + border), one = 1;
  PetscBLASInt       info = 0;

  PetscFunctionBeginUser;
  if (m) PetscCallBLAS("LAPACKgetrs", LAPACKgetrs_("N", &m, &one, c->A, &m, c->pivot, c->rhs, &m, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK getrs: info %d", (int)info);
  PetscFunctionReturn(0);
}

void ComplianceTake(ContactCompliance c)
{
  for (PetscInt k = 0; k < c->n_closed; k++)
    for (PetscInt i = 0; i < 3; i++)
      for (PetscInt j = 0; j < 3; j++) c->l[3 * c->closed[k] + i] += c->law[c->closed[k]].P[i][j] * c->rhs[3 * k + j];
}
