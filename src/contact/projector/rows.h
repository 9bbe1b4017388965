/*
   Private to project.c: a pair whose directions are not coupled, Cartesian, without turning to n, t, b and back. With
   the relative velocity q, offset included, the impulse that solves the pair alone is the projection of z = p - q / w
   on the cone. Parts of each version of its loops.
*/
#pragma once

#include "base/algebra/versions.h"
#include "projectorimpl.h"

/* Velocity of the slave relative to the master, m/s */
INTO_VERSIONS void RowVelocity(const ProjectorRow *row, const PetscReal v[], PetscReal q[3])
{
  const PetscReal *a = &v[3 * row->node[0]], *b = &v[3 * row->node[1]], *c = &v[3 * row->node[2]],
                  *d = &v[3 * row->node[3]], *s = &v[3 * row->node[4]], *w = row->weight, *D = row->D;

  for (int i = 0; i < 3; i++)
    q[i] = (s[i] - ((w[0] * a[i] + w[1] * b[i]) + (w[2] * c[i] + w[3] * d[i]))) + row->offset[i];
  if (!D) return;
  for (int i = 0; i < 3; i++) q[i] += D[3 * i] * s[0] + D[3 * i + 1] * s[1] + D[3 * i + 2] * s[2];
}

/* Velocities of the nodes after an impulse */
INTO_VERSIONS void RowPush(const ProjectorRow *row, const PetscReal p[3], PetscReal v[])
{
  PetscReal *a = &v[3 * row->node[0]], *b = &v[3 * row->node[1]], *c = &v[3 * row->node[2]], *d = &v[3 * row->node[3]];
  PetscReal *s       = &v[3 * row->node[4]];
  const PetscReal *h = row->push, *D = row->D;

  for (int i = 0; i < 3; i++) {
    s[i] += h[4] * p[i];
    a[i] -= h[0] * p[i];
    b[i] -= h[1] * p[i];
    c[i] -= h[2] * p[i];
    d[i] -= h[3] * p[i];
  }
  if (!D) return;
  for (int i = 0; i < 3; i++) s[i] += h[4] * (D[i] * p[0] + D[3 + i] * p[1] + D[6 + i] * p[2]);
}

/* Projects z on the cone |z_T| <= mu z_n: along the tangent plane, not the nearest point. z_n stays, since Coulomb's
   law is not associated; a z that pulls becomes 0 */
INTO_VERSIONS ContactStatus RowProject(const ProjectorRow *row, PetscReal z[3])
{
  const PetscReal normal = row->n[0] * z[0] + row->n[1] * z[1] + row->n[2] * z[2], cone = row->mu * normal;
  PetscReal       square = 0, factor;

  if (!(normal > 0)) {
    z[0] = z[1] = z[2] = 0;
    return CONTACT_OPEN;
  }
  for (int i = 0; i < 3; i++) {
    z[i] -= normal * row->n[i];
    square += z[i] * z[i];
  }
  factor = FrictionShorten(square, cone);
  for (int i = 0; i < 3; i++) z[i] = normal * row->n[i] + factor * z[i];
  return row->mu > 0 && factor == 1 ? CONTACT_STICK : CONTACT_SLIP;
}

/* What the impulse would have to change by, the residual of the natural map, N s; z is the impulse then */
INTO_VERSIONS ContactStatus RowChange(const ProjectorRow *row, const PetscReal q[3], PetscReal z[3],
                                      PetscReal change[3])
{
  ContactStatus status;

  for (int i = 0; i < 3; i++) z[i] = row->p[i] - row->mass * q[i];
  status = RowProject(row, z);
  for (int i = 0; i < 3; i++) change[i] = z[i] - row->p[i];
  return status;
}

/* Returns the square of the change */
INTO_VERSIONS PetscReal RowSolve(ProjectorRow *row, PetscReal v[])
{
  PetscReal q[3], z[3], change[3];

  RowVelocity(row, v, q);
  row->status = RowChange(row, q, z, change);
  for (int i = 0; i < 3; i++) row->p[i] = z[i];
  RowPush(row, change, v);
  return change[0] * change[0] + change[1] * change[1] + change[2] * change[2];
}

/* Sum of the sizes of the terms of a relative velocity, m/s */
INTO_VERSIONS PetscReal RowSize(const ProjectorRow *row, const PetscReal v[])
{
  const PetscReal *a = &v[3 * row->node[0]], *b = &v[3 * row->node[1]], *c = &v[3 * row->node[2]],
                  *d = &v[3 * row->node[3]], *s = &v[3 * row->node[4]], *w = row->weight;
  PetscReal sum = 0;

  for (int i = 0; i < 3; i++)
    sum +=
      (PetscAbsReal(s[i]) + PetscAbsReal(row->offset[i])) + ((PetscAbsReal(w[0] * a[i]) + PetscAbsReal(w[1] * b[i])) +
                                                             (PetscAbsReal(w[2] * c[i]) + PetscAbsReal(w[3] * d[i])));
  return sum;
}
