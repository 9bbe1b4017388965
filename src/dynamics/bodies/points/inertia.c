/*
   Mass m (kg) and inertia (kg m^2) of a point as W of its six motions q, and its kinetic energy 1/2 q'W q (J).
*/
#include "dynamics/bodies/bodiesimpl.h"

/* W of a point */
void PointInertia(const Joint *joint, PetscReal W[36])
{
  static const int at[9] = {0, 3, 4, 3, 1, 5, 4, 5, 2};

  for (int i = 0; i < 36; i++) W[i] = 0;
  for (int d = 0; d < 3; d++) W[7 * d] = joint->mass;
  for (int i = 0; i < 9; i++) W[6 * (3 + i / 3) + 3 + i % 3] = joint->inertia[at[i]];
}

PetscReal PointKinetic(const Joint *joint, const PetscReal q[6])
{
  PetscReal W[36], sum = 0;

  PointInertia(joint, W);
  for (int i = 0; i < 36; i++) sum += 0.5 * q[i / 6] * W[i] * q[i % 6];
  return sum;
}
