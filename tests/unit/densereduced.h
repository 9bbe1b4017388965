/*
   Small reduced models for unit tests: block systems whose structure is hidden by a congruence Q' (.) Q with a random,
   well-conditioned Q, which keeps the eigenvalues. One parameter p; terms are c(p) A with c = 1 or p.
*/
#pragma once

#include <petscsys.h>
#include <string.h>
#include "sweep/track/track.h"

#define DENSE_MAX   12
#define DENSE_TERMS 6

typedef struct {
  Reduced       reduced;
  OperatorsTerm term[DENSE_TERMS];
  PetscReal     A[DENSE_TERMS][DENSE_MAX * DENSE_MAX], Q[DENSE_MAX * DENSE_MAX];
  PetscReal    *pointer[DENSE_TERMS];
  unsigned      seed;
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
  memset(dense, 0, sizeof(*dense));
  dense->seed = 2005;
  for (PetscInt r = 0; r < n * n; r++)
    dense->Q[r] = (r % (n + 1) == 0 ? 1 : 0) + (hidden ? 0.6 * DenseRandom(dense) / n : 0);
  dense->reduced.n            = n;
  dense->reduced.n_used       = n;
  dense->reduced.n_parameters = 1;
  dense->reduced.term         = dense->term;
  dense->reduced.A            = dense->pointer;
}

/* Adds c A, c = p if varies, else 1; A [n * n] row by row */
static inline void DenseAdd(Dense *dense, OperatorsTermKind kind, PetscBool varies, const PetscReal A[])
{
  const PetscInt n = dense->reduced.n, t = dense->reduced.n_terms++;
  PetscReal      AQ[DENSE_MAX * DENSE_MAX];

  dense->term[t].kind  = kind;
  dense->term[t].scale = 1;
  dense->term[t].n     = varies ? 1 : 0;
  if (varies) dense->term[t].factor[0].power = 1;
  dense->pointer[t]        = dense->A[t];
  dense->term[t].symmetric = PETSC_TRUE;
  for (PetscInt i = 0; i < n; i++) {
    for (PetscInt j = 0; j < n; j++) {
      if (A[i * n + j] != A[j * n + i]) dense->term[t].symmetric = PETSC_FALSE;
      AQ[j * n + i] = 0;
      for (PetscInt k = 0; k < n; k++) AQ[j * n + i] += A[i * n + k] * dense->Q[j * n + k];
    }
  }
  for (PetscInt i = 0; i < n; i++) {
    for (PetscInt j = 0; j < n; j++) {
      dense->A[t][j * n + i] = 0;
      for (PetscInt k = 0; k < n; k++) dense->A[t][j * n + i] += dense->Q[i * n + k] * AQ[j * n + k];
    }
  }
}

/* M = I */
static inline void DenseAddUnitMass(Dense *dense)
{
  const PetscInt n                           = dense->reduced.n;
  PetscReal      unit[DENSE_MAX * DENSE_MAX] = {0};

  for (PetscInt i = 0; i < n; i++) unit[i * n + i] = 1;
  DenseAdd(dense, OPERATORS_MASS, PETSC_FALSE, unit);
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
  DenseAdd(dense, OPERATORS_STIFFNESS, PETSC_FALSE, K);
  DenseAdd(dense, OPERATORS_STIFFNESS, PETSC_TRUE, K1);
}
