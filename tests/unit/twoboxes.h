/*
   What the tests of the contact forces share: two boxes, `lower` (master, its top) and `upper` (slave, its bottom), as
   nodes with masses; and what is known of the contact surfaces. No stiffness is needed.
*/
#pragma once

#include <squeal/projector.h>
#include "boxes.h"

#define BODIES                                                                                                         \
  "-parts lower,upper -lower_young 1 -lower_poisson 0 -lower_density 1 -upper_young 1 -upper_poisson 0 "               \
  "-upper_density 1 -contacts joint -joint_surfaces upper_bottom,lower_top -joint_law constraint "

typedef struct {
  Model            model;
  Contact          contact;
  ContactProjector projector;
  PetscInt         n;                             /* nodes of contact surfaces on this rank */
  const PetscInt  *vertex;                        /* their local vertices */
  PetscReal       *x;                             /* [n][3] their places */
  PetscReal       *minv, *u, *before, *v, *force; /* [n][3] */
} Slider;

/* A number in [-1, 1] that depends on a place and a seed alone, so that all ranks find it alike */
static inline PetscReal Noise(const PetscReal x[3], PetscReal seed)
{
  const double s = 1e4 * sin(12.9898 * x[0] + 78.233 * x[1] + 37.719 * x[2] + 4.1414 * seed);

  return 2 * (s - floor(s)) - 1;
}

/* The contact forces of a scene on boxes, without masses */
static inline PetscErrorCode SliderCreate(MPI_Comm comm, int n_boxes, const Box boxes[], const char scene[],
                                          const char more[], Slider *s)
{
  const Mesh *mesh;
  char        path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(BoxesWrite(comm, n_boxes, boxes, path));
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscOptionsInsertString(NULL, scene));
  PetscCall(PetscOptionsInsertString(NULL, more));
  PetscCall(PetscOptionsSetValue(NULL, "-model_mesh", path));
  PetscCall(ModelCreate(comm, &s->model));
  PetscCall(ModelSetFromOptions(s->model));
  PetscCall(ContactCreate(s->model, &s->contact));
  PetscCall(ContactSetFromOptions(s->contact));
  PetscCall(ModelSetUp(s->model));
  PetscCall(BoxesRemove(comm, path));
  PetscCall(ContactProjectorCreate(s->contact, &s->projector));
  PetscCall(ContactProjectorSetFromOptions(s->projector));
  PetscCall(ContactProjectorSetUp(s->projector));
  PetscCall(ContactProjectorGetNodes(s->projector, &s->n, &s->vertex));
  PetscCall(PetscCalloc6(3 * s->n, &s->x, 3 * s->n, &s->minv, 3 * s->n, &s->u, 3 * s->n, &s->before, 3 * s->n, &s->v,
                         3 * s->n, &s->force));
  PetscCall(ModelGetMesh(s->model, &mesh));
  for (PetscInt i = 0; i < 3 * s->n; i++) s->x[i] = mesh->x[3 * s->vertex[i / 3] + i % 3];
  PetscFunctionReturn(0);
}

static inline PetscErrorCode SliderDestroy(Slider *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree6(s->x, s->minv, s->u, s->before, s->v, s->force));
  PetscCall(ContactProjectorDestroy(&s->projector));
  PetscCall(ContactDestroy(&s->contact));
  PetscCall(ModelDestroy(&s->model));
  PetscFunctionReturn(0);
}

/* One step of free nodes under accelerations a [n][3] (m/s^2); kick = dt, and v becomes the velocity after it */
static inline PetscErrorCode SliderStep(Slider *s, PetscReal t, PetscReal dt, const PetscReal a[])
{
  const ContactStep step = {.time = t, .dt = dt, .kick = dt};
  const PetscInt   *active;
  PetscInt          n;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < 3 * s->n; i++) {
    s->before[i] = s->v[i];
    s->v[i] += s->minv[i] > 0 ? dt * a[i] : 0;
  }
  PetscCall(ContactProjectorGetActive(s->projector, &n, &active));
  PetscCall(ContactProject(s->projector, &step, s->u, s->before, s->v, s->force));
  for (PetscInt k = 0; k < n; k++)
    for (int d = 0; d < 3; d++) {
      const PetscInt i = 3 * active[k] + d;

      s->v[i] += dt * s->minv[i] * s->force[i];
    }
  for (PetscInt i = 0; i < 3 * s->n; i++) s->u[i] += dt * s->v[i];
  PetscFunctionReturn(0);
}
