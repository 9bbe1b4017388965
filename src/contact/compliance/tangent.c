/*
   Derivative of the forces of a solved step with respect to the motions without forces, the statuses staying what they
   are: with l = P z + p0, w = Q z + q0, w = -a v of the closed pairs (linear.c)

      [Q + a W kappa P] dz = -a dv,     dl = P dz,     dlambda = kappa dl,

   dv being the change of q, along the tangents less that of slip0. The solution is piecewise smooth: at a border of two
   statuses this is the derivative on one side.
*/
#include "complianceimpl.h"

/* A, factored, at the solution; v and l, which the assembly uses, are as before. Rows are always exchanged here, and
   nothing is shifted: a derivative that does not exist is an error, where a force may be any of several. */
static PetscErrorCode TangentFactor(ContactCompliance c)
{
  PetscBool singular;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(c->l0, c->l, 3 * c->n));
  PetscCall(PetscArraycpy(c->v0, c->v, 3 * c->n));
  ComplianceLinearise(c);
  ComplianceSetTangents(c, PETSC_TRUE);
  PetscCall(ComplianceAssemble(c, 0));
  ComplianceSetTangents(c, PETSC_FALSE);
  PetscCall(ComplianceFactor(c, c->row[c->n_closed], &singular));
  PetscCall(PetscArraycpy(c->l, c->l0, 3 * c->n));
  PetscCall(PetscArraycpy(c->v, c->v0, 3 * c->n));
  PetscCheck(!singular, PETSC_COMM_SELF, PETSC_ERR_MAT_LU_ZRPVT,
             "the forces of the contact pairs have no derivative: the compliance of the closed pairs is singular");
  PetscFunctionReturn(0);
}

PetscErrorCode ContactComplianceTangent(ContactCompliance c, PetscInt n, const PetscReal dv[], PetscReal dlambda[])
{
  const PetscInt     N       = 3 * c->n;
  const PetscBLASInt columns = (PetscBLASInt)n;
  PetscBLASInt       rows, info = 0;
  PetscReal         *z;

  PetscFunctionBeginUser;
  PetscCall(TangentFactor(c));
  PetscCall(PetscArrayzero(dlambda, n * N));
  if (!c->n_closed || !n) PetscFunctionReturn(0);
  rows = (PetscBLASInt)c->row[c->n_closed];
  PetscCall(PetscMalloc1(rows * n, &z));
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt k = 0; k < c->n_closed; k++)
      ComplianceAlongRows(c, k, &dv[j * N + 3 * c->closed[k]], &z[j * rows + c->row[k]]);
  for (PetscInt k = 0; k < rows * n; k++) z[k] *= -c->weight;
  PetscCallBLAS("LAPACKgetrs", LAPACKgetrs_("N", &rows, &columns, c->A, &rows, c->pivot, z, &rows, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK getrs: info %d", (int)info);
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt k = 0; k < c->n_closed; k++) {
      const PetscInt    p   = c->closed[k];
      const CoulombLaw *law = &c->law[p];

      for (PetscInt i = 0; i < 3; i++)
        for (PetscInt d = 0; d < c->row[k + 1] - c->row[k]; d++)
          dlambda[j * N + 3 * p + i] += c->kappa[p] * law->P[i][d] * z[j * rows + c->row[k] + d];
    }
  PetscCall(PetscFree(z));
  PetscFunctionReturn(0);
}
