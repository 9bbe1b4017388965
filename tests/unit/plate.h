/* A plate and a block on it that slides over its facets, in steps of DT */
#pragma once

#include "twoboxes.h"

#define DT 1e-3 /* s */

static const PetscReal wide[]    = {-1, -0.7, -0.45, -0.1, 0.05, 0.3, 0.75, 1};
static const PetscReal deep[]    = {-1, -0.8, -0.35, 0, 0.1, 0.6, 1};
static const PetscReal z_lower[] = {-1, -0.5, 0}, z_upper[] = {0, 0.5, 1};
static const PetscReal x_upper[] = {0.31, 0.41, 0.55}, y_upper[] = {-0.19, -0.02, 0.17};
static const Box       plate = {
        .name = "lower", .n = {8,    7,    3      },
             .x = {wide, deep, z_lower}
};
static const Box block = {
  .name = "upper", .n = {3,       3,       3      },
       .x = {x_upper, y_upper, z_upper}
};

#define TURNING "-joint_kinematics turning -joint_rotation 0,0,2 -joint_centre 0.05,-0.1,0 "

/* A slave is a node of the block; both bodies have nodes at z = 0, but none at the same x */
static inline PetscBool IsSlave(const Slider *s, PetscInt i)
{
  for (int k = 0; k < 3; k++)
    if (PetscAbsReal(s->x[3 * i] - x_upper[k]) < 1e-9) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Slaves of 1 kg; the plate is rigid, or has corners of `minv` (1/kg) */
static inline PetscErrorCode SliderBegin(Slider *s, PetscReal minv)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < 3 * s->n; i++) s->minv[i] = IsSlave(s, i / 3) ? 1 : minv;
  PetscCall(ContactProjectorSetMass(s->projector, s->minv));
  PetscCall(ContactProjectorStart(s->projector, 0, s->u, 1e-9, NULL));
  PetscFunctionReturn(0);
}

/* Both bodies, with more options */
static inline PetscErrorCode PlateCreate(const char more[], PetscReal minv, Slider *s)
{
  const Box boxes[] = {plate, block};

  PetscFunctionBeginUser;
  PetscCall(SliderCreate(PETSC_COMM_WORLD, 2, boxes, BODIES, more, s));
  PetscCall(SliderBegin(s, minv));
  PetscFunctionReturn(0);
}

/* Forces of one step at given displacements of the slaves, which are pressed by -1 m/s; others keep their velocities */
static inline PetscErrorCode SliderPress(Slider *s, PetscReal t)
{
  const ContactStep step = {.time = t, .dt = DT, .kick = DT};

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < s->n; i++)
    for (int d = 0; d < 3; d++) s->before[3 * i + d] = s->v[3 * i + d] = IsSlave(s, i) && d == 2 ? -1 : 0;
  PetscCall(PetscArrayzero(s->force, 3 * s->n));
  PetscCall(ContactProject(s->projector, &step, s->u, s->before, s->v, s->force));
  PetscFunctionReturn(0);
}
