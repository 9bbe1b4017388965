/*
   A point of the path of path.c, its tangent, and Newton's system there, with the border of the path. y = (l, x), l
   in m over `size` = |l| of the accepted point, x = log(t / (1 - t)) without unit, so that both are of order 1; dt/dx
   = t (1 - t).
*/
#include "contact/compliance/complianceimpl.h"

/* t at x */
PetscReal CompliancePathBlend(PetscReal x)
{
  return 1 / (1 + PetscExpReal(-x));
}

PetscReal CompliancePathNorm(const ContactCompliance c, const PetscReal l[])
{
  PetscReal sum = 0;

  for (PetscInt i = 0; i < 3 * c->n; i++) sum += PetscSqr(l[i]);
  return PetscSqrtReal(sum);
}

/* Border of the system at l, v, x, for size dx; returns t . (y - y_p) size */
static PetscReal PathBorder(ContactCompliance c, const CompliancePath *path, PetscReal x)
{
  const PetscInt  m = c->row[c->n_closed], rows = m + 1;
  const PetscReal weight = c->weight * c->blend / path->size;
  PetscReal       ahead  = path->size * path->t_x * (x - path->x_ahead);

  for (PetscInt k = 0; k < c->n_closed; k++) {
    const PetscInt    p   = c->closed[k];
    const CoulombLaw *law = &c->law[p];
    PetscReal         x[3];

    for (PetscInt i = 0; i < 3; i++) x[i] = weight * (c->l[3 * p + i] - c->v[3 * p + i] + c->free[3 * p + i]);
    ComplianceAlongRows(c, k, x, &c->A[m * rows + c->row[k]]);
    for (PetscInt j = c->row[k]; j < c->row[k + 1]; j++) {
      c->A[j * rows + m] = 0;
      for (PetscInt i = 0; i < 3; i++)
        c->A[j * rows + m] += path->tangent[3 * p + i] * law->P[i][j - c->row[k]] / path->size;
    }
  }
  c->A[m * rows + m] = path->t_x;
  for (PetscInt i = 0; i < 3 * c->n; i++) ahead += path->tangent[i] * (c->l[i] - path->ahead[i]) / path->size;
  return ahead;
}

/* Sign of the determinant of the factors, with the border */
static PetscInt PathSign(const ContactCompliance c)
{
  const PetscInt rows = c->row[c->n_closed] + 1;
  PetscInt       sign = 1;

  for (PetscInt i = 0; i < rows; i++)
    if ((c->A[i * (rows + 1)] < 0) != (c->pivot[i] != i + 1)) sign = -sign;
  return sign;
}

/* Linearises and factors at the present l, v */
PetscErrorCode CompliancePathFactor(ContactCompliance c, const CompliancePath *path, PetscReal x, PetscReal *ahead,
                                    PetscBool *singular)
{
  PetscFunctionBeginUser;
  ComplianceChoose(c);
  ComplianceLinearise(c);
  PetscCall(ComplianceAssemble(c, 1));
  *ahead = PathBorder(c, path, x);
  PetscCall(ComplianceFactor(c, c->row[c->n_closed] + 1, singular));
  PetscFunctionReturn(0);
}

/* Point and tangent of one path to another */
PetscErrorCode CompliancePathCopy(ContactCompliance c, const CompliancePath *from, CompliancePath *to)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(to->l, from->l, 3 * c->n));
  PetscCall(PetscArraycpy(to->tangent, from->tangent, 3 * c->n));
  to->x    = from->x;
  to->t_x  = from->t_x;
  to->size = from->size;
  PetscFunctionReturn(0);
}

/* Takes the point l, x, as the laws of its piece have it, and the tangent there: the solution of the bordered system
   for the unit vector of the border, scaled to length 1. Its direction is ahead where the determinant of the system
   has the sign it had at the beginning of the path. */
PetscErrorCode CompliancePathTangent(ContactCompliance c, CompliancePath *path, PetscReal x)
{
  PetscReal ahead, length, size = path->size;
  PetscBool singular;

  PetscFunctionBeginUser;
  PetscCall(CompliancePathFactor(c, path, x, &ahead, &singular));
  PetscCall(PetscArraycpy(path->l, c->l, 3 * c->n));
  path->x = x;
  PetscCall(PetscArrayzero(c->rhs, c->row[c->n_closed]));
  c->rhs[c->row[c->n_closed]] = 1;
  PetscCall(ComplianceBackSolve(c, c->row[c->n_closed] + 1, c->rhs));
  PetscCall(PetscArrayzero(c->l, 3 * c->n));
  ComplianceTake(c);
  PetscCall(PetscArraycpy(path->tangent, c->l, 3 * c->n));
  path->t_x = c->rhs[c->row[c->n_closed]] / size;
  /* forces may vanish on the way; the scale must not */
  path->size = PetscMax(CompliancePathNorm(c, path->l), PETSC_SQRT_MACHINE_EPSILON * size);
  length     = PetscSqrtReal(PetscSqr(path->t_x) + PetscSqr(CompliancePathNorm(c, path->tangent) / path->size));
  if (!path->sign) path->sign = PathSign(c);
  if (PathSign(c) != path->sign) length = -length;
  for (PetscInt i = 0; i < 3 * c->n; i++) path->tangent[i] /= length;
  path->t_x /= length;
  PetscFunctionReturn(0);
}

/* Cosine of the tangents before and now */
PetscReal CompliancePathAlong(const ContactCompliance c, const CompliancePath *path, const CompliancePath *before)
{
  PetscReal along = path->t_x * before->t_x;

  for (PetscInt i = 0; i < 3 * c->n; i++) along += before->tangent[i] * path->tangent[i] / PetscSqr(path->size);
  return along;
}

/* The point at a distance along the tangent */
void CompliancePathPredict(const ContactCompliance c, CompliancePath *path, PetscReal step)
{
  for (PetscInt i = 0; i < 3 * c->n; i++) path->ahead[i] = path->l[i] + step * path->tangent[i];
  path->x_ahead = path->x + step * path->t_x;
}

PetscErrorCode CompliancePathCreate(ContactCompliance c, CompliancePath *path)
{
  PetscFunctionBeginUser;
  *path = (CompliancePath){.x = 0};
  PetscCall(PetscCalloc3(3 * c->n, &path->l, 3 * c->n, &path->ahead, 3 * c->n, &path->tangent));
  PetscFunctionReturn(0);
}

PetscErrorCode CompliancePathDestroy(CompliancePath *path)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(path->l, path->ahead, path->tangent));
  PetscFunctionReturn(0);
}
