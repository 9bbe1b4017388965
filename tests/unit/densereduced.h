/*
   Small reduced models for unit tests: block systems whose structure is hidden by a congruence Q' (.) Q with a random,
   well-conditioned Q, which keeps the eigenvalues. One parameter p; terms are c(p) A with c = 1 or p.
*/
#pragma once

#include "densesystem.h"
#include "sweep/track/track.h"

#define DENSE_MAX 12 /* unknowns */

typedef struct {
  System    system;
  PetscReal Q[DENSE_MAX * DENSE_MAX];
  unsigned  seed;
} Dense;

/* Uniform numbers in [-1, 1], always the same */
static inline PetscReal DenseRandom(Dense *dense)
{
  dense->seed = 1664525u * dense->seed + 1013904223u;
  return 2 * (PetscReal)(dense->seed >> 8) / (1 << 24) - 1;
}

/* n unknowns; hidden: with Q, else as given */
static inline void DenseBegin(Dense *dense, PetscInt n, PetscBool hidden)
{
  SystemCreate(n, n, 1, &dense->system);
  dense->seed = 2005;
  for (PetscInt r = 0; r < n * n; r++)
    dense->Q[r] = (r % (n + 1) == 0 ? 1 : 0) + (hidden ? 0.6 * DenseRandom(dense) / n : 0);
}

/* B = Q A', [n * n] row by row */
static inline void DenseHide(const Dense *dense, const PetscReal A[], PetscReal B[])
{
  const PetscInt n = dense->system.reduced.n;

  for (PetscInt i = 0; i < n; i++)
    for (PetscInt j = 0; j < n; j++) {
      B[i * n + j] = 0;
      for (PetscInt k = 0; k < n; k++) B[i * n + j] += dense->Q[i * n + k] * A[j * n + k];
    }
}

/* Adds c A, c = p[parameter], -1: c = 1; A [n * n] row by row */
static inline void DenseAdd(Dense *dense, OperatorsTermKind kind, PetscInt parameter, const PetscReal A[])
{
  const PetscInt n         = dense->system.reduced.n;
  PetscBool      symmetric = PETSC_TRUE;
  PetscReal      QA[DENSE_MAX * DENSE_MAX], QAQ[DENSE_MAX * DENSE_MAX];

  for (PetscInt i = 0; i < n; i++)
    for (PetscInt j = 0; j < n; j++)
      if (A[i * n + j] != A[j * n + i]) symmetric = PETSC_FALSE;
  DenseHide(dense, A, QA);
  DenseHide(dense, QA, QAQ); /* Q (Q A')' = Q A Q' */
  SystemAdd(&dense->system, kind, symmetric, parameter, QAQ);
}

/* M = I */
static inline void DenseAddUnitMass(Dense *dense)
{
  const PetscInt n                           = dense->system.reduced.n;
  PetscReal      unit[DENSE_MAX * DENSE_MAX] = {0};

  for (PetscInt i = 0; i < n; i++) unit[i * n + i] = 1;
  DenseAdd(dense, OPERATORS_MASS, -1, unit);
}

/* K = diag(kappa + slope p) + entry[k] at (row, column)[k], M = I */
typedef struct {
  PetscInt  row, column;
  PetscReal value;
} DenseEntry;

static inline void DenseDiagonal(Dense *dense, PetscInt n, const PetscReal kappa[], const PetscReal slope[],
                                 PetscInt n_entries, const DenseEntry entry[])
{
  PetscReal K[DENSE_MAX * DENSE_MAX] = {0}, K1[DENSE_MAX * DENSE_MAX] = {0};

  DenseBegin(dense, n, PETSC_TRUE);
  for (PetscInt i = 0; i < n; i++) K[i * n + i] = kappa[i], K1[i * n + i] = slope[i];
  for (PetscInt e = 0; e < n_entries; e++) K[entry[e].row * n + entry[e].column] += entry[e].value;
  DenseAddUnitMass(dense);
  DenseAdd(dense, OPERATORS_STIFFNESS, -1, K);
  DenseAdd(dense, OPERATORS_STIFFNESS, 0, K1);
}
