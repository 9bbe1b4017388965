/*
   Joint - what joins sets: bushings between them, and points with mass. How a set moves in the mean is told by
   model/scene/mean.c, what acts on these motions by model/scene/joint.c.
*/
#pragma once

#include <petscsys.h>

/* Six motions q = (translation, m; rotation, rad) of the displacements u of sets, linear in them: q_j = sum over the
   nodes i of all ranks and d of b[i][d][j] u_id. A force (N) and moment (N m) f on q act on the nodes as sum_j b_j
   f_j. */
typedef struct {
  PetscInt   n;
  PetscInt  *vertex; /* [n] local nodes that this rank owns */
  PetscReal *b;      /* [n][3][6] */
} ModelMean;

/* A bushing between the mean motions of two sets, of a to b, or of one and the ground; or a point, which moves as its
   set does in the mean, with mass, inertia, and what holds it to the ground. Of six values three are along x, y, z,
   three about them. */
typedef struct {
  char     *name, *set[2]; /* set[1] is empty for the ground */
  PetscBool is_point, has_at, has_at_b, has_axis[2];
  PetscBool rigid;        /* the set moves as one rigid body, and the point with it; else it moves freely */
  PetscReal at[3];        /* place of the motions, m; after ModelSetUp() */
  PetscReal at_b[3];      /* that of set b where it has one of its own, m */
  PetscReal axis[2][3];   /* of a bushing, as they are given: the axes of its motions, else x, y, z */
  PetscReal frame[9];     /* its rows: the axes of the motions q; after ModelSetUp() */
  PetscReal stiffness[6]; /* N/m; N m/rad */
  PetscReal viscosity[6]; /* N s/m; N m s/rad */
  PetscReal mass;         /* kg */
  PetscInt  n_inertia;    /* values given */
  PetscReal inertia[6];   /* xx, yy, zz, xy, xz, yz about the place, where the mass is, kg m^2 */
  ModelMean mean;         /* q of the point, or q_a - q_b; after ModelSetUp() */
} Joint;

/* Whether a point has mass or inertia */
static inline PetscBool JointIsMassive(const Joint *joint)
{
  PetscBool is = joint->mass > 0 ? PETSC_TRUE : PETSC_FALSE;

  for (int k = 0; k < 6; k++)
    if (joint->inertia[k] != 0) is = PETSC_TRUE;
  return is;
}
