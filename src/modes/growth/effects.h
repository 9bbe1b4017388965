/* Private to modes/effects/: what a small change at a node does to an eigenvalue */
#pragma once

#include "modes/modesimpl.h"

typedef enum { EFFECT_MASS, EFFECT_SPRING, EFFECT_DASHPOT, N_EFFECTS } EffectKind;

/* One mode at the nodes of a rank: right vector x, left vector y, [local nodes][3] */
typedef struct {
  const Mesh  *mesh;
  PetscReal   *xr, *xi, *yr, *yi;
  PetscComplex factor[N_EFFECTS]; /* d lambda / d change = factor d'y x'd along the direction d; of a mass its trace */
  PetscReal    rounding;          /* effects differ by rounding less than this part of the largest one */
} ModeEffects;

/* The change of a kind that lowers the growth of a mode most on one part */
typedef struct {
  PetscReal    at[3], direction[3]; /* place, m; unit vector, zero for a mass, which has none */
  PetscComplex rate;                /* d lambda / d change, rad/s per kg, N/m or N s/m */
  PetscBool    found;               /* some node lowers it */
} EffectBest;

/* y x^T at a node, its symmetric part times the factor of a kind, row-major */
static inline void EffectAtNode(const ModeEffects *e, EffectKind kind, PetscInt node, PetscComplex form[3][3])
{
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) {
      const PetscInt     i = 3 * node + a, j = 3 * node + b;
      const PetscComplex ab = CMPLX(e->yr[i], e->yi[i]) * CMPLX(e->xr[j], e->xi[j]);
      const PetscComplex ba = CMPLX(e->yr[j], e->yi[j]) * CMPLX(e->xr[i], e->xi[i]);

      form[a][b] = e->factor[kind] * (ab + ba) / 2;
    }
}

/* best.c - among the nodes of each part; best [n_parts]. Collective */
PETSC_INTERN PetscErrorCode EffectsFindBest(MPI_Comm comm, const ModeEffects *e, EffectKind kind, EffectBest best[]);
