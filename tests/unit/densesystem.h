/* Small dense systems for the unit tests of sweep/: matrices with coefficients, as reduced models without a mesh */
#pragma once

#include "sweep/dense/eigen.h"
#include <string.h>

#define SYSTEM_TERMS 6
#define SYSTEM_SIZE  52 /* unknowns */

typedef struct {
  Reduced       reduced;
  OperatorsTerm term[SYSTEM_TERMS];
  PetscReal     A[SYSTEM_TERMS][SYSTEM_SIZE * SYSTEM_SIZE], *pointer[SYSTEM_TERMS];
} System;

/* n unknowns, of which n_used make the model */
static inline void SystemCreate(PetscInt n, PetscInt n_used, PetscInt n_parameters, System *s)
{
  memset(s, 0, sizeof(*s));
  s->reduced = (Reduced){.n = n, .n_used = n_used, .n_parameters = n_parameters, .term = s->term, .A = s->pointer};
}

/* Adds p[parameter] A, A [n * n] row by row; parameter -1: A */
static inline void SystemAdd(System *s, OperatorsTermKind kind, PetscBool symmetric, PetscInt parameter,
                             const PetscReal A[])
{
  const PetscInt n = s->reduced.n, t = s->reduced.n_terms++;

  s->term[t] =
    (OperatorsTerm){.kind = kind, .symmetric = symmetric, .scale = 1, .n = parameter < 0 ? 0 : 1, .constraint = -1};
  s->term[t].factor[0].parameter = PetscMax(parameter, 0);
  s->term[t].factor[0].power     = 1;
  s->pointer[t]                  = s->A[t];
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt j = 0; j < n; j++) s->A[t][j * n + i] = A[i * n + j];
}

/* K = [[a, b - p0 c], [b, d]], M = I, C = diag(d1, d2) where not zero: two modes that friction p0 couples.
   kappa = (a + d) / 2 +- sqrt((a - d)^2 / 4 + b (b - p0 c)) */
static inline void SystemTwo(PetscReal a, PetscReal b, PetscReal c, PetscReal d, const PetscReal damping[2], System *s)
{
  SystemCreate(2, 2, 1, s);
  SystemAdd(s, OPERATORS_STIFFNESS, PETSC_TRUE, -1, (PetscReal[]){a, b, b, d});
  SystemAdd(s, OPERATORS_STIFFNESS, PETSC_FALSE, 0, (PetscReal[]){0, -c, 0, 0});
  SystemAdd(s, OPERATORS_MASS, PETSC_TRUE, -1, (PetscReal[]){1, 0, 0, 1});
  if (damping) SystemAdd(s, OPERATORS_DAMPING, PETSC_TRUE, -1, (PetscReal[]){damping[0], 0, 0, damping[1]});
}

/* Reproducible numbers in (-1, 1) */
static inline PetscReal NextNumber(unsigned long long *state)
{
  *state = *state * 6364136223846793005ULL + 1442695040888963407ULL;
  return (PetscReal)(*state >> 11) / 4503599627370496.0 - 1;
}

/* Largest |y_i^T B z_j| of different modes in the standard form, relative to the size of its parts:
   (lambda_i + lambda_j) y_i^T M x_j + y_i^T C x_j */
static inline PetscErrorCode LargestProduct(const System *s, const PetscReal p[], const ReducedModes *m,
                                            PetscReal *largest)
{
  const PetscInt n = m->size;
  DensePencil    pencil;

  PetscFunctionBeginUser;
  *largest = 0;
  PetscCall(ReducedPencil(&s->reduced, p, n, &pencil));
  for (PetscInt i = 0; i < m->n; i++)
    for (PetscInt j = 0; j < m->n; j++) {
      const PetscComplex sum   = m->lambda[i] + m->lambda[j];
      PetscComplex       value = 0;

      for (PetscInt r = 0; r < n; r++)
        for (PetscInt c = 0; c < n; c++)
          value += m->y[i * n + r] * (sum * pencil.M[c * n + r] + pencil.C[c * n + r]) * m->x[j * n + c];
      if (i != j) *largest = PetscMax(*largest, cabs(value) / cabs(sum));
    }
  PetscCall(DensePencilDestroy(&pencil));
  PetscFunctionReturn(0);
}

/* Distance of lambda from the nearest eigenvalue */
static inline PetscReal Nearest(const ReducedModes *m, PetscComplex lambda)
{
  PetscReal nearest = INFINITY;

  for (PetscInt i = 0; i < m->n; i++) nearest = PetscMin(nearest, cabs(m->lambda[i] - lambda));
  return nearest;
}

/* Modes and estimates of the model, and modes of all unknowns */
static inline PetscErrorCode SolveBoth(System *s, const PetscReal p[], const ReducedWindow *window, ReducedModes *m,
                                       ReducedModes *truth)
{
  const PetscInt used = s->reduced.n_used;

  PetscFunctionBeginUser;
  PetscCall(ReducedSolve(&s->reduced, p, window, m));
  PetscCall(ReducedEstimate(&s->reduced, p, m));
  s->reduced.n_used = s->reduced.n;
  PetscCall(ReducedSolve(&s->reduced, p, window, truth));
  s->reduced.n_used = used;
  PetscFunctionReturn(0);
}
