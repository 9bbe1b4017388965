/* Private to sweep/: what estimate.c and cluster.c share, the pencil on the whole basis [V Z] at one point */
#pragma once

#include "eigen.h"

typedef struct {
  const ReducedModes *modes;
  PetscInt            n_v, n_z;
  DensePencil         pencil; /* V first */
  StandardForm        form;   /* on V */
} Estimate;

/* estimate.c - r [m][n_z] = Q_zv(lambda) x (left false) or Q_vz(lambda)^T x of m vectors x [m][n_v] */
PetscErrorCode EstimateCouple(const Estimate *e, PetscComplex lambda, PetscBool left, PetscInt m,
                              const PetscComplex x[], PetscComplex r[]);
/* r := Q_zz(lambda)^-1 r, [m][n_z]; singular where lambda is an eigenvalue of Z */
PetscErrorCode EstimateSolve(const Estimate *e, PetscComplex lambda, PetscInt m, PetscComplex r[], PetscBool *singular);

/* cluster.c - new values s[m] of the modes list[m], whose vectors mean nothing one by one, matched to the old ones */
PetscErrorCode EstimateCluster(const Estimate *e, PetscInt m, const PetscInt list[], PetscComplex s[],
                               PetscBool *singular);
