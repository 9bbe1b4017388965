/*
   Scenes for unit tests of prescribed forces and motions: a model, its bodies and state vectors.

   The bar is 0 <= z <= 1 m long with a square section of 1 m^2, of density 2 below z = 0.4 m and 3 above: 2.6 kg; it
   has six layers of nine nodes, two in the foot, one shared, three in the head.
*/
#pragma once

#include "boxes.h"
#include "brake.h"
#include "dynamics/external/external.h"

#define BAR                                                                                                            \
  "-parts foot,head -foot_young 3 -foot_density 2 -head_young 5 -head_density 3 -supports clamp "                      \
  "-clamp_set foot_bottom -clamp_fix xyz "
#define MASS 2.6

typedef struct {
  Chain         chain;
  Bodies        bodies;
  External      external;
  const Layout *layout;
  PetscReal    *u, *v, *f; /* [layout n] */
} Scene;

/* A bar of two glued parts with the options of a scene, up to ExternalSetFromOptions() */
static inline PetscErrorCode SceneBegin(const char options[], Scene *s)
{
  static const PetscReal x[] = {0, 0.4, 1}, z_foot[] = {0, 0.1, 0.4}, z_head[] = {0.4, 0.7, 0.8, 1};
  const Box              box[] = {
                 {.name = "foot",  .n = {3, 3, 3},      .x = {x, x, z_foot}},
                 { .name = "head", .n = {3, 3, 4}, .x = {x, x, z_head},          .glued = 1}
  };
  char path[PETSC_MAX_PATH_LEN], values[PETSC_MAX_PATH_LEN + 1024];

  PetscFunctionBeginUser;
  PetscCall(BoxesWrite(PETSC_COMM_WORLD, 2, box, path));
  PetscCall(PetscSNPrintf(values, sizeof(values), "-model_mesh %s %s", path, options));
  PetscCall(ChainCreate(BAR, values, &s->chain));
  PetscCall(BoxesRemove(PETSC_COMM_WORLD, path));
  PetscCall(ExternalCreate(PETSC_COMM_WORLD, s->chain.model, &s->external));
  PetscFunctionReturn(0);
}

/* Bodies, and state vectors of zeros */
static inline PetscErrorCode SceneEnd(Scene *s)
{
  PetscFunctionBeginUser;
  PetscCall(BodiesCreate(PETSC_COMM_WORLD, &s->bodies));
  PetscCall(BodiesSetFromOptions(s->bodies));
  PetscCall(BodiesSetUp(s->bodies, s->chain.operators));
  PetscCall(BodiesGetLayout(s->bodies, &s->layout));
  PetscCall(PetscCalloc3(s->layout->n, &s->u, s->layout->n, &s->v, s->layout->n, &s->f));
  PetscFunctionReturn(0);
}

static inline PetscErrorCode SceneCreate(const char options[], Scene *s)
{
  PetscFunctionBeginUser;
  PetscCall(SceneBegin(options, s));
  PetscCall(ExternalSetFromOptions(s->external));
  PetscCall(SceneEnd(s));
  PetscCall(ExternalSetUp(s->external, s->chain.operators, s->bodies));
  PetscFunctionReturn(0);
}

static inline PetscErrorCode SceneDestroy(Scene *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(s->u, s->v, s->f));
  PetscCall(BodiesDestroy(&s->bodies));
  PetscCall(ExternalDestroy(&s->external));
  PetscCall(ChainDestroy(&s->chain));
  PetscFunctionReturn(0);
}

/* A step from t with the forces alone in f; powers of all ranks */
static inline PetscErrorCode SceneAdvance(Scene *s, PetscReal t, PetscReal dt, ExternalPower *power)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(s->f, s->layout->n));
  PetscCall(ExternalAdvance(s->external, &(ExternalStep){t, dt, s->u, s->v, s->f}, power));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, power, 2, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(0);
}
