/* Private to sweep/: what estimate.c, complement.c and cluster.c share, the pencil on the whole basis [V Z] at one
   point */
#pragma once

#include "eigen.h"

typedef struct {
  const ReducedModes *modes;
  PetscInt            n_v, n_z;
  DensePencil         pencil; /* V first */
  StandardForm        form;   /* on V */
  /* with n_z > 0: */
  PetscReal  *right, *left; /* [n_z][n_v] T and T' of complement.c */
  DensePencil complement;   /* between the vectors Z - V T' and Z - V T, [n_z * n_z] each */
} Estimate;

/* complement.c - makes what lies beyond V, free of couplings to it at the real shift h, rad/s */
PetscErrorCode EstimateComplement(Estimate *e, PetscReal h);

/* estimate.c - r [m][n_z] = (Z - V T')^T Q(lambda) V x (left false) or (Z - V T)^T Q(lambda)^T V x of m vectors x
   [m][n_v], each with its own lambda [m] */
PetscErrorCode EstimateCouple(const Estimate *e, const PetscComplex lambda[], PetscBool left, PetscInt m,
                              const PetscComplex x[], PetscComplex r[]);
/* r := Q(lambda)^-1 r of the complement, [m][n_z]; singular where lambda is an eigenvalue of it */
PetscErrorCode EstimateSolve(const Estimate *e, PetscComplex lambda, PetscInt m, PetscComplex r[], PetscBool *singular);

/* cluster.c - new values s[m] of the modes list[m], whose vectors mean nothing one by one, matched to the old ones */
PetscErrorCode EstimateCluster(const Estimate *e, PetscInt m, const PetscInt list[], PetscComplex s[],
                               PetscBool *singular);
