/* Private to the connectivity of bodies */
#pragma once

#include "contact/contactimpl.h"

/* Two bodies, a < b, and how many nodes they have in one place */
typedef struct {
  PetscInt a, b, n;
} BodyTouch;

/* The bodies of a scene, and what hangs together: parent[n + 1], the last for the ground; has[n] is work; together[n]
   tells those that joints hold together, without the ground */
typedef struct {
  Contact     contact;
  const Mesh *mesh;
  PetscInt    n, *body, *parent, *has, *together, n_touches;
  BodyTouch  *touch; /* ordered, one for each two bodies */
} BodyGraph;

/* touch.c - nodes that two bodies have in one place, of which no joint, tie or contact has one on each side.
   Collective. */
PETSC_INTERN PetscErrorCode GraphFindTouches(BodyGraph *bodies);
