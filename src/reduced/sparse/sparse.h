/*
   Private to reduced/: the compliance of the pairs without its numbers, for more pairs than a dense matrix serves. Each
   product with W or Cx (reduced.h) is a solution or two with the factors of K - s M, by all ranks together; vectors of
   the pairs are the same on all.
*/
#pragma once

#include "reduced/reducedimpl.h"

struct _p_ReducedSparse {
  ReducedRun run;
  Mat        D;    /* damping of the bodies, NULL without */
  Mat        Z, G; /* of displacements that follow others, NULL; ports of the pairs on the unknowns that are left */
  Mat        base; /* K - s M of these */
  Mat        B, X; /* work: [unknowns][1] */
  PetscReal *h, *known; /* work: [m] */
  PetscReal *kappa;     /* [n_pairs] about the stiffness of a pair alone, N/m */
};

/* Near inverse of the compliance of pairs in the directions held: with springs tau there that are stiff beside the
   pairs, and the modes' answer f,

      (W + P f P' + 1 / tau)^-1 = tau - tau G (K_t + G'tau G)^-1 G' tau,
      K_t = K - s M + M Phi (1 / f - Omega^2 + s) Phi'M

   where the modes are put on the factors of K_h = K - s M + G'tau G by E = 1 / (1 / f - Omega^2 + s) + Phi'M K_h^-1 M
   Phi. */
typedef struct {
  ReducedSparse sparse;
  PetscReal    *f;   /* [m] N^-1 m kg */
  PetscReal    *tau; /* [3 n_pairs] N/m, 0 where not held */
  Mat           K;
  ShiftInvert   inverse;
  PetscReal    *GY; /* [m][3 n_pairs] G K_h^-1 M Phi */
  PetscReal    *E;  /* [m][m], factored */
  PetscBLASInt *pivot;
  PetscReal    *force, *coordinates; /* work: [3 n_pairs], [m] */
} SparseHold;

#define SPARSE_RTOL 1e-11 /* of the contact laws: some tens of roundings of 10^4 pairs */

typedef struct _p_SparseLaws *SparseLaws;

/* The laws of a step on that compliance, or of the start on that of the residual alone. y = D'q + P'F P lambda / 2, A q
   = D lambda / 2 (step/residual.c), A = W / 2 + Cx / dt - Cm'F Cm / dt^2 near share W. */
struct _p_SparseLaws {
  ReducedSparse  sparse;
  ReducedStepper stepper;   /* NULL at the start */
  PetscReal      share;     /* of W in A; 1/2 undamped */
  SparseHold     pairs;     /* directions of the closed pairs */
  PetscReal     *tau;       /* [3 n_pairs] its springs for W / (2 share) */
  SparseHold     all;       /* of all pairs, for A; only where damped */
  PetscReal     *q;         /* [3 n_pairs] of the last forces */
  PetscReal     *a, *b, *c; /* work: [3 n_pairs] */
  PetscReal     *g, *z;     /* work: [2 m] */
};

/* sparse.c - W p, and Cx p, which costs as much again, or NULL. Collective */
PETSC_INTERN PetscErrorCode SparseTimes(ReducedSparse sparse, const PetscReal p[], PetscReal Wp[], PetscReal Cxp[]);
/* Rows of all pairs, [n][3 n_pairs], of a dense block of unknowns: V'X. Collective */
PETSC_INTERN PetscErrorCode SparseRows(ReducedSparse sparse, Mat X, PetscReal rows[]);
/* force (the dense column B) := V p */
PETSC_INTERN PetscErrorCode SparseForces(ReducedSparse sparse, const PetscReal p[], Mat B);

/* hold.c - springs in the directions held, all where NULL; motions of forces with them; forces that make motions */
PETSC_INTERN PetscErrorCode SparseHoldCreate(ReducedSparse sparse, SparseHold *hold);
PETSC_INTERN PetscErrorCode SparseHoldSet(SparseHold *hold, const PetscBool held[]);
PETSC_INTERN PetscErrorCode SparseHoldMove(SparseHold *hold, const PetscReal force[], PetscReal motion[]);
PETSC_INTERN PetscErrorCode SparseHoldPress(SparseHold *hold, const PetscReal motion[], PetscReal force[]);
PETSC_INTERN PetscErrorCode SparseHoldDestroy(SparseHold *hold);

/* laws.c - without a stepper those of the residual alone */
PETSC_INTERN PetscErrorCode SparseLawsCreate(ReducedSparse sparse, ReducedStepper stepper, SparseLaws *laws);
PETSC_INTERN void           SparseLawsGetMap(SparseLaws laws, ComplianceMap *map);
PETSC_INTERN PetscErrorCode SparseLawsDestroy(SparseLaws *laws);
/* Damped: change of q without forces at t_{n+1}, A dq = W r + Cm'g; q of forces lambda there, whose drag joins the
   coordinates next [2 m] */
PETSC_INTERN PetscErrorCode SparseLawsFree(SparseLaws laws, const PetscReal r[], const PetscReal g[], PetscReal dq[]);
PETSC_INTERN PetscErrorCode SparseLawsDrag(SparseLaws laws, const PetscReal lambda[], PetscReal q[], PetscReal next[]);
