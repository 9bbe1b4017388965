/*
   Scenes drawn at random for the statics: a block of 2 x 2 to 4 x 4 nodes across on a base, in SI units. Stiffness,
   law, friction, slip, loads, springs and gaps vary over what users may give, and beyond.
*/
#pragma once

#include "boxes.h"
#include "brake.h"
#include <stdint.h>

#define SCENE_SIZE  0.1  /* m, width of the block */
#define SCENE_FORCE 1000 /* N */

typedef struct {
  uint64_t  seed;
  char      options[4096];
  PetscReal grid[2][3][6]; /* of base and block */
  Box       box[2];
  PetscReal mu, kn, softest; /* kn infinite for the constraint; softest modulus, Pa */
  PetscBool slides, held;    /* held: springs in all directions at the block */
  PetscBool pressed;         /* straight down on the middle of the block, and nothing else */
  PetscReal gap;             /* m, largest of the initial gaps; they are drawn for each pair */
  PetscInt  gaps;            /* 0 none, 1 open, 2 interference, 3 both */
} Scene;

/* In [0, 1); M. O'Neill's multiplier, upper bits */
static inline PetscReal Draw(Scene *s)
{
  s->seed = s->seed * 6364136223846793005u + 1442695040888963407u;
  return (PetscReal)(s->seed >> 11) / 9007199254740992.0;
}

static inline PetscInt DrawInteger(Scene *s, PetscInt n)
{
  return (PetscInt)(Draw(s) * (PetscReal)n);
}

/* Evenly distributed logarithm */
static inline PetscReal DrawBetween(Scene *s, PetscReal least, PetscReal most)
{
  return least * PetscPowReal(most / least, Draw(s));
}

static inline PetscErrorCode SceneAdd(Scene *s, const char format[], ...)
{
  va_list arguments;
  size_t  length;

  PetscFunctionBeginUser;
  PetscCall(PetscStrlen(s->options, &length));
  va_start(arguments, format);
  (void)vsnprintf(&s->options[length], sizeof(s->options) - length, format, arguments);
  va_end(arguments);
  PetscFunctionReturn(0);
}

/* Nodes from `from` to `to`, at random places between */
static inline void GridDraw(Scene *s, PetscInt n, PetscReal from, PetscReal to, PetscReal x[])
{
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal shift = i > 0 && i < n - 1 ? 0.5 * (Draw(s) - 0.5) : 0;

    x[i] = from + (to - from) * ((PetscReal)i + shift) / (PetscReal)(n - 1);
  }
}

/* A base that reaches farther than the block, whose nodes match those of the block or do not */
static inline void SceneDrawBoxes(Scene *s)
{
  const PetscBool match = Draw(s) < 0.5 ? PETSC_TRUE : PETSC_FALSE;

  s->box[0] = (Box){
    .name = "base", .n = {0, 0, 2}
  };
  s->box[1] = (Box){
    .name = "block", .n = {2 + DrawInteger(s, 3), 2 + DrawInteger(s, 3), 2}
  };
  GridDraw(s, 2, -0.3 * SCENE_SIZE, 0, s->grid[0][2]);
  GridDraw(s, 2, 0, SCENE_SIZE * (0.3 + Draw(s)), s->grid[1][2]);
  for (int d = 0; d < 2; d++) {
    const PetscInt n = s->box[1].n[d];

    GridDraw(s, n, -SCENE_SIZE / 2, SCENE_SIZE / 2, s->grid[1][d]);
    s->box[0].n[d] = match ? n + 2 : 3;
    GridDraw(s, s->box[0].n[d], -0.6 * SCENE_SIZE, 0.7 * SCENE_SIZE, s->grid[0][d]);
    for (PetscInt i = 0; i < n && match; i++) s->grid[0][d][1 + i] = s->grid[1][d][i];
  }
  for (int i = 0; i < 2; i++)
    for (int d = 0; d < 3; d++) s->box[i].x[d] = s->grid[i][d];
}

/* Springs at the block: in all directions, or sideways, or none. No softer than what leaves 1e-10 of the load to the
   rounding of displacements. */
static inline PetscErrorCode SceneDrawSprings(Scene *s, PetscReal stiffest)
{
  const PetscReal least = 1e-5 * stiffest * SCENE_SIZE, kind = Draw(s);
  PetscReal       k[3];

  PetscFunctionBeginUser;
  s->held = kind < 0.6 ? PETSC_TRUE : PETSC_FALSE;
  if (kind > 0.9) PetscFunctionReturn(0);
  for (int d = 0; d < 3; d++) k[d] = DrawBetween(s, least, 1e4 * least);
  PetscCall(SceneAdd(s, "-springs holder -holder_set %s -holder_stiffness %.17g,%.17g,%.17g ",
                     Draw(s) < 0.5 ? "block_top" : "block", k[0], k[1], s->held ? k[2] : 0));
  PetscFunctionReturn(0);
}

/* A press on the top, mostly down, and for every third scene a pull at a corner */
static inline PetscErrorCode SceneDrawLoads(Scene *s)
{
  const PetscReal side = SCENE_FORCE * (Draw(s) < 0.5 ? 0 : Draw(s)), down = SCENE_FORCE * (Draw(s) < 0.1 ? 0.3 : -1);
  const PetscReal angle = 2 * PETSC_PI * Draw(s);

  PetscFunctionBeginUser;
  PetscCall(
    SceneAdd(s, "-press_set block_top -press_force %.17g,%.17g,%.17g ", side * cos(angle), side * sin(angle), down));
  if (Draw(s) < 0.67) {
    s->pressed = side == 0 && down < 0 ? PETSC_TRUE : PETSC_FALSE;
    PetscCall(SceneAdd(s, "-loads press "));
    PetscFunctionReturn(0);
  }
  PetscCall(SceneAdd(s, "-loads press,pull -pull_set block_corner -pull_force %.17g,%.17g,%.17g ",
                     300 * (Draw(s) - 0.5), 300 * (Draw(s) - 0.5), 900 * (Draw(s) - 0.7)));
  PetscFunctionReturn(0);
}

/* Law, friction and slip of the contact; gaps as large as the elastic approach, within a factor of 10 */
static inline PetscErrorCode SceneDrawContact(Scene *s)
{
  const PetscReal angle = 2 * PETSC_PI * Draw(s);

  PetscFunctionBeginUser;
  s->mu     = Draw(s) < 0.15 ? 0 : Draw(s);
  s->kn     = Draw(s) < 0.5 ? PETSC_INFINITY : DrawBetween(s, 1e3, 1e13);
  s->slides = Draw(s) < 0.6 ? PETSC_TRUE : PETSC_FALSE;
  s->gaps   = Draw(s) < 0.4 ? 0 : 1 + DrawInteger(s, 3);
  s->gap    = s->gaps ? SCENE_FORCE / (s->softest * SCENE_SIZE) * DrawBetween(s, 0.1, 10) : 0;
  PetscCall(SceneAdd(s, "-contacts contact -contact_surfaces block_bottom,base_top -contact_mu %.17g ", s->mu));
  if (s->kn < PETSC_INFINITY)
    PetscCall(SceneAdd(s, "-contact_law penalty -contact_kn %.17g ", s->kn));
  else
    PetscCall(SceneAdd(s, "-contact_law constraint "));
  if (s->slides) PetscCall(SceneAdd(s, "-contact_slip %.17g,%.17g,0 ", cos(angle), sin(angle)));
  if (!s->slides && Draw(s) < 0.3) PetscCall(SceneAdd(s, "-static_load_steps %d ", 2 + (int)DrawInteger(s, 3)));
  if (Draw(s) < 0.1) PetscCall(SceneAdd(s, "-static_dense 0 "));
  PetscFunctionReturn(0);
}

static inline PetscErrorCode SceneDraw(PetscInt number, Scene *s)
{
  PetscReal young[2];

  PetscFunctionBeginUser;
  *s = (Scene){.seed = 1000003u * (uint64_t)number + 17};
  for (int i = 0; i < 5; i++) (void)Draw(s);
  SceneDrawBoxes(s);
  for (int i = 0; i < 2; i++) young[i] = DrawBetween(s, 1e8, 1e13);
  s->softest = PetscMin(young[0], young[1]);
  PetscCall(SceneAdd(s, "-parts base,block -base_young %.17g -base_density 7800 -base_poisson %.17g ", young[0],
                     0.45 * Draw(s)));
  PetscCall(SceneAdd(s, "-block_young %.17g -block_density 2500 -block_poisson %.17g ", young[1], 0.45 * Draw(s)));
  PetscCall(SceneAdd(s, "-supports ground -ground_set base_bottom -ground_fix xyz "));
  PetscCall(SceneDrawSprings(s, PetscMax(young[0], young[1])));
  PetscCall(SceneDrawLoads(s));
  PetscCall(SceneDrawContact(s));
  PetscFunctionReturn(0);
}

/* The chain of a scene, its gaps put into the pairs */
static inline PetscErrorCode SceneCreate(Scene *s, Chain *chain)
{
  char               path[PETSC_MAX_PATH_LEN], mesh[PETSC_MAX_PATH_LEN + 16];
  const ContactPair *pairs;
  PetscInt           n, n_all;

  PetscFunctionBeginUser;
  PetscCall(BoxesWrite(PETSC_COMM_WORLD, 2, s->box, path));
  PetscCall(PetscSNPrintf(mesh, sizeof(mesh), "-model_mesh %s", path));
  PetscCall(ChainCreate(s->options, mesh, chain));
  PetscCall(BoxesRemove(PETSC_COMM_WORLD, path));
  PetscCall(ContactGetPairs(chain->contact, &n, &n_all, &pairs));
  for (PetscInt p = 0; p < n; p++) {
    const PetscReal draw = Draw(s);

    ((ContactPair *)pairs)[p].gap = s->gap * (s->gaps == 1 ? draw : s->gaps == 2 ? -draw : 2 * draw - 1);
  }
  PetscFunctionReturn(0);
}
