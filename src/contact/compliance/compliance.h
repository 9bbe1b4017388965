/*
   ContactCompliance - contact and Coulomb friction of pairs on a dense compliance, exactly. Private to the rooms above
   contact/. No MPI and no options.

   Relative displacements of the pairs r [n][3] (slave less master: gap, two tangents; m) and forces on the slaves
   lambda [n][3] (N) obey

      r = q + W lambda,     d = r_T - slip0       (slip of the step, sliding included)
      normal    0 <= lambda_n,  0 <= r_n,  lambda_n r_n = 0
      Coulomb   |lambda_T| <= mu lambda_n,  d = 0 (stick)  or  lambda_T = -mu lambda_n d / |d| (slip)
      mu        mu(|d| / dt) of the pair's law (frictionlaw.h), at the end of the step

   with W (m/N) symmetric and positive semidefinite. With laws in series (spring.c) r_n + C(lambda_n) stands for r_n in
   the normal law, C the closing of a pair's pressure law. A
   solution exists for any mu where W is definite; it need not be the only one: the one near the guess is looked for
   first. Friction that W couples with the normal may have none where W is singular (a wedge that jams).

   Residual: natural map per pair in metres, forces divided by the pair's stiffness kappa = 3 / trace W_pp,
      |l_n - max(0, l_n - r_n)|,  |p - Proj(p + d)| on the disc of radius mu l_n,     l = lambda / kappa,  p = -l_T,
   relative to the largest l; what rounding of q and W lambda leaves is never asked for. It hardly feels the direction
   of a slip that is short beside l: Newton's method goes on until friction is along slip to 100 tolerances, 1e-10 of
   the largest force for 1e-12.

   Methods, each where the one before does not end: Newton on the statuses of the pairs with factors of the steps
   before, bordered by what has changed (chord.c); semismooth Newton (newton.c), on motions where fewer of these than of
   forces are free (dual.c); the same with a line search on the natural map;
   the path of solutions from pairs that do not feel each other to W, followed through its folds (path.c). All have
   limits: a step always ends, and tells whether it converged.

   W may also be a map (ComplianceMap) whose numbers nobody has. Then the linear systems of Newton's method are solved
   by GMRES (krylov.c), with a line search where that does not end; chord.c, dual.c and path.c need the numbers.
*/
#pragma once

#include <petscsys.h>
#include <squeal/contactstatus.h>
#include <squeal/frictionlaw.h>
#include <squeal/pressurelaw.h>

typedef struct _p_ContactCompliance *ContactCompliance;

/* The method that ended */
typedef enum {
  COMPLIANCE_CHORD,
  COMPLIANCE_NEWTON,
  COMPLIANCE_DAMPED,
  COMPLIANCE_PATH,
  COMPLIANCE_N_ROUTES
} ComplianceRoute;

/* One step; or, by ContactComplianceGetTotals(), sums and the worst of all steps */
typedef struct {
  PetscBool       converged;                   /* in all steps */
  ComplianceRoute route;                       /* the last one tried */
  PetscReal       residual;                    /* relative */
  PetscInt        worst;                       /* pair of that residual, -1 for none */
  PetscInt        iterations;                  /* of Newton, on the path too */
  PetscInt        factors;                     /* LU factors */
  PetscInt        steps;                       /* 1 */
  PetscInt        routes[COMPLIANCE_N_ROUTES]; /* steps that ended so */
} ComplianceReport;

/* W as a map of forces [n][3] (N) to motions [n][3] (m) */
typedef struct {
  MPI_Comm         comm; /* of the ranks that share it, with the same numbers */
  void            *ctx;
  const PetscReal *kappa; /* [n] about the stiffness of each pair alone, N/m, positive; copied */
  const PetscReal *tau;   /* [n][3] springs of the directions held, N/m, stiff beside kappa, else 0 */
  /* W times forces to rounding; and nearly, for the directions of Newton's method alone */
  PetscErrorCode (*move)(void *ctx, const PetscReal force[], PetscReal motion[]);
  PetscErrorCode (*nearly)(void *ctx, const PetscReal force[], PetscReal motion[]);
  /* sets springs in the directions held [n][3]; nearly W of pairs that these springs press back, (1 / W + tau)^-1 */
  PetscErrorCode (*hold)(void *ctx, const PetscBool held[]);
  PetscErrorCode (*press)(void *ctx, const PetscReal force[], PetscReal motion[]);
} ComplianceMap;

/*@
   ContactComplianceCreate - for n pairs. Not collective.

   Input Parameters:
+  n - pairs
-  W - compliance, m/N, [3 n][3 n]; borrowed until destroyed

   Errors: PETSC_ERR_ARG_OUTOFRANGE where W is not finite, not symmetric to 1e-10, or has a negative diagonal.
@*/
PETSC_INTERN PetscErrorCode ContactComplianceCreate(PetscInt n, const PetscReal W[], ContactCompliance *compliance);

/*@ ContactComplianceCreateMap - the same with W as a map, copied. All ranks that share the map take the same steps.
    ContactComplianceTangent(), ContactComplianceSetSprings() and ContactComplianceCheckDefinite() need W itself. @*/
PETSC_INTERN PetscErrorCode ContactComplianceCreateMap(PetscInt n, const ComplianceMap *map,
                                                       ContactCompliance *compliance);

/*@ ContactComplianceCheckDefinite - whether W is positive semidefinite to rounding (1e-10 of its largest diagonal), by
    a Cholesky factor. Not collective. @*/
PETSC_INTERN PetscErrorCode ContactComplianceCheckDefinite(ContactCompliance compliance, PetscBool *definite);

/*@ ContactComplianceSetFriction - laws [n], copied, and the length of a step, s, read where mu changes with the slip
   speed.
    Errors: PETSC_ERR_ARG_OUTOFRANGE where mu is negative or not finite, or dt not positive beside such a law. Not
    collective. @*/
PETSC_INTERN PetscErrorCode ContactComplianceSetFriction(ContactCompliance compliance, const FrictionLaw friction[],
                                                         PetscReal dt);

/*@ ContactComplianceSetResting - statuses [n] at the end of the step before: pairs that stick go on resting while
    mu(0) holds them, however steeply mu falls with the slip speed. Not collective. @*/
PETSC_INTERN PetscErrorCode ContactComplianceSetResting(ContactCompliance compliance, const ContactStatus status[]);

/*@ ContactComplianceSetSprings - laws [n] in series with the pairs, copied; once. W is copied. Not collective. @*/
PETSC_INTERN PetscErrorCode ContactComplianceSetSprings(ContactCompliance compliance, const PairSpring law[]);

/*@ ContactComplianceSetTolerance - relative residual, 1e-12 unless set. Not collective. @*/
PETSC_INTERN PetscErrorCode ContactComplianceSetTolerance(ContactCompliance compliance, PetscReal rtol);

/*@
   ContactComplianceSolve - one step. Not collective.

   Input Parameters:
+  q      - relative displacements without forces of this step, m, [n][3]
-  slip0  - r_T from which slip counts (that of the step before less the sliding of the step), m, [n][2]

   Input/Output Parameter:
.  lambda - guess and solution, N, [n][3]

   Output Parameters:
+  r      - relative displacements, m, [n][3]; or NULL
-  report - of this step; or NULL

   Errors: PETSC_ERR_FP where q, slip0 or the guess is not finite. That it does not converge is no error: see the
   report.
@*/
PETSC_INTERN PetscErrorCode ContactComplianceSolve(ContactCompliance compliance, const PetscReal q[],
                                                   const PetscReal slip0[], PetscReal lambda[], PetscReal r[],
                                                   ComplianceReport *report);

/*@
   ContactComplianceTangent - derivative of the forces of the last step, which must have converged. Not collective.

   Input Parameters:
+  n  - columns
-  dv - changes of q, along the tangents less those of slip0, m, [n][pairs][3]

   Output Parameter:
.  dlambda - changes of lambda, N, [n][pairs][3]

   Errors: PETSC_ERR_MAT_LU_ZRPVT where the compliance of the closed pairs is singular.
@*/
PETSC_INTERN PetscErrorCode ContactComplianceTangent(ContactCompliance compliance, PetscInt n, const PetscReal dv[],
                                                     PetscReal dlambda[]);

/*@ ContactComplianceGetStatus - of the pairs in the last step, [n] (borrowed until the next). Not collective. @*/
PETSC_INTERN PetscErrorCode ContactComplianceGetStatus(ContactCompliance compliance, const ContactStatus **status);

/*@ ContactComplianceGetSlip - gap and slip [n][3] of the pairs in the last step, m, as the laws have them: r less slip0
    without the rounding of r, which may exceed a short slip (borrowed until the next). Not collective. @*/
PETSC_INTERN PetscErrorCode ContactComplianceGetSlip(ContactCompliance compliance, const PetscReal **slip);

/*@ ContactComplianceGetMemory - what must be kept so that the next steps are bitwise the same after a restart: n
    numbers, which the caller frees. Not collective. @*/
PETSC_INTERN PetscErrorCode ContactComplianceGetMemory(ContactCompliance compliance, PetscInt *n, PetscReal **values);

/*@ ContactComplianceSetMemory - takes them back. Errors: PETSC_ERR_FILE_UNEXPECTED where they are of other pairs. Not
    collective. @*/
PETSC_INTERN PetscErrorCode ContactComplianceSetMemory(ContactCompliance compliance, PetscInt n,
                                                       const PetscReal values[]);

/*@ ContactComplianceGetTotals - of all steps since it was created. Not collective. @*/
PETSC_INTERN PetscErrorCode ContactComplianceGetTotals(ContactCompliance compliance, ComplianceReport *report);

/*@ ContactComplianceDestroy - frees all. Not collective. @*/
PETSC_INTERN PetscErrorCode ContactComplianceDestroy(ContactCompliance *compliance);
