/* Private to modes/growth/: what a small change at a node, or between two, does to an eigenvalue */
#pragma once

#include "modes/modesimpl.h"

typedef enum { EFFECT_MASS, EFFECT_SPRING, EFFECT_DASHPOT, N_EFFECTS } EffectKind;

/* One mode at the nodes of a rank: right vector x, left vector y, [local nodes][3] */
typedef struct {
  const Mesh  *mesh;
  PetscInt     mode;      /* its index */
  PetscReal    sigma;     /* its growth, 1/s */
  PetscReal    uncertain; /* of a rate, as a part of the largest one of its kind */
  PetscReal   *xr, *xi, *yr, *yi;
  PetscReal    end[4][3];         /* the same at the other end of a spring or dashpot, zero: the ground */
  PetscComplex factor[N_EFFECTS]; /* d lambda / d change = factor d'y x'd along the direction d; of a mass its trace */
  PetscReal    strength[N_EFFECTS]; /* |factor| */
  PetscInt    *first, *node; /* [parts + 1], where the nodes of each part begin; those that cells of this rank have */
  PetscReal    rounding;     /* effects differ by rounding less than this part of the largest one */
} ModeEffects;

/* The change of a kind that lowers the growth of a mode most on one part */
typedef struct {
  PetscReal    at[3], direction[3]; /* place, m; unit vector, zero for a mass, which has none */
  PetscComplex rate;                /* d lambda / d change, rad/s per kg, N/m or N s/m */
  PetscReal    vector[4][3];        /* xr, xi, yr, yi there */
  PetscBool    found;               /* some node lowers it */
} EffectBest;

/* A spring or dashpot between nodes of two parts, or of one */
typedef struct {
  EffectBest end[2];  /* the rate and the direction stand at end[1] */
  PetscInt   part[2]; /* -1 of part[0]: end[0] is the ground */
} EffectPair;

/* y x^T of the motion at a node less that of the other end, its symmetric part times the factor of a kind, row-major */
static inline void EffectAtNode(const ModeEffects *e, EffectKind kind, PetscInt node, PetscComplex form[3][3])
{
  PetscComplex x[3], y[3];

  for (int a = 0; a < 3; a++) {
    x[a] = CMPLX(e->xr[3 * node + a] - e->end[0][a], e->xi[3 * node + a] - e->end[1][a]);
    y[a] = CMPLX(e->yr[3 * node + a] - e->end[2][a], e->yi[3 * node + a] - e->end[3][a]);
  }
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) form[a][b] = e->factor[kind] * (y[a] * x[b] + y[b] * x[a]) / 2;
}

/* One part, or all others */
typedef struct {
  PetscInt  part;
  PetscBool within;
} EffectParts;

/* best.c - first and node as above, which the caller frees; best [n_parts], among the nodes of each part or, where
   `of` is given, of those that it asks for. Collective */
PETSC_INTERN PetscErrorCode EffectsListNodes(const Mesh *mesh, PetscInt **first, PetscInt **nodes);
PETSC_INTERN PetscErrorCode EffectsFindBest(MPI_Comm comm, const ModeEffects *e, EffectKind kind, const EffectParts *of,
                                            EffectBest best[]);
/* The same between two nodes: from the best one of `part` to the ground, each end in turn moves to its best node, on
   `part` and on it too (`within`) or on others, until both stay. e->end is zero again. Collective */
PETSC_INTERN PetscErrorCode EffectsFindPair(MPI_Comm comm, ModeEffects *e, EffectKind kind, PetscInt part,
                                            PetscBool within, EffectPair *pair);
