/*
   Shooting - periodic solutions of autonomous systems by Newton's method, their stability, branches of them. Private to
   the rooms above solver/. Dense: hundreds of unknowns. No MPI, no options.

   A flow takes a state x [n] through a time T at a value p of a parameter: y = Phi(x, T, p). Cycles obey

      Phi(x, T, p) = x,     c . (x - x0) = 0,     c = S^2 dPhi/dT at the guess x0, S diagonal: the phase.

   Newton's equations, with M = dPhi/dx, f = dPhi/dT, g = dPhi/dp and a third row that fixes p, or the distance along a
   branch with the tangent t = (t_x, t_T, t_p) at y = (x, T, p) predicted (pseudo-arclength; H. B. Keller, Applications
   of Bifurcation Theory, 1977, 359):

      [M - I    f    g  ] [dx]   [x - Phi                 ]
      [c        0    0  ] [dT] = [-c . (x - x0)           ]
      [t_x S^2 ..       ] [dp]   [-<t, y - y_predicted>   ]

   Where the flow is the same after any shift along e (a body that nothing holds along a flat contact), M e = e for
   every motion, and Phi = x is asked for but for a drift d e, a further unknown; S^2 e . dx = 0.

   f and g are central differences of the flow. Eigenvalues of M (Floquet multipliers) tell stability: one is that of
   the phase, and the cycle is stable where all others lie inside the unit circle.

   A flow made of N steps of length T / N breaks the symmetry in time where a force has a kink within a step. Cycles are
   then a curve x(theta), T(theta), theta the shift of the steps against the motion, with (' = d/dtheta)

      (M - I) x' + f T' = 0,     c . x' = c . f:     Newton's matrix gives x' and T',

   and for every left vector l of M with its eigenvalue m, (m - 1) l . x' = -T' l . f. Hence

   * the eigenvalue of M for the phase is 1 - T' (l . f) / (l . x'), 1 - T' nearly. It is 1 only where T is stationary:
   a property of
     M and of where the cycle begins, which no tolerance moves;
   * the other vectors have next to no part in x' (of the order of T' times that in f), by which the phase's is told;
   * the return map whose period goes with the phase, x -> Phi(x, T(theta(x)), p), keeps the whole curve, and its
   multiplier of
     the phase is 1, as that of a flow in continuous time. With theta that of the phase's left vector, theta' = l / (l .
     x'), its derivative is M + f T' l' / (l . x'): it has the vectors and the eigenvalues of M but for that one.
*/
#pragma once

#include <petscsys.h>

#define SHOOTING_DIFFERENCE 1e-6 /* of the period and of the span, for derivatives of the flow */

/* y [n], INFINITY where the flow ends before T (not PETSC_INFINITY, which is finite); M [n][n] by columns, or NULL */
typedef PetscErrorCode (*ShootingFlow)(void *ctx, const PetscReal x[], PetscReal period, PetscReal value, PetscReal y[],
                                       PetscReal M[]);

typedef struct {
  PetscInt     n;
  ShootingFlow flow;
  void        *ctx;
  PetscReal   *size;   /* [n] of what changes in a cycle: residuals are divided by it */
  PetscReal   *weight; /* [n] S: 1 / size where the phase and the arclength count x, else 0 */
  PetscReal    least;  /* of the parameter */
  PetscReal    span;   /* of the parameter, likewise */
  PetscInt     n_free; /* directions in which a shift changes nothing: a cycle may drift along them */
  PetscReal   *free;   /* [n_free][n], orthonormal in S x, the caller's */
  PetscReal    rtol;   /* of |(Phi - x) / size| */
  PetscInt     max_it;
  PetscBool    phase_free; /* a state of rest: T is given, and no phase is asked for */
} Shooting;

/* A cycle, or a guess of it */
typedef struct {
  PetscReal *x; /* [n], the caller's */
  PetscReal *M; /* [n][n] at x, the caller's */
  PetscReal  period, value;
  PetscReal  residual;
  PetscInt   its;
  PetscBool  converged;
} ShootingCycle;

/* Direction of a branch, of unit length in (S x, T / period, p / span) */
typedef struct {
  PetscReal *x; /* [n], the caller's */
  PetscReal  period, value;
} ShootingTangent;

/* A cycle of a branch, and the branch's direction there */
typedef struct {
  ShootingCycle   cycle;
  ShootingTangent tangent;
} ShootingPlace;

/* How a cycle changes with the place of its steps in the motion */
typedef struct {
  PetscReal *x;     /* [n] dx/dtheta, the caller's */
  PetscReal  slope; /* dT/dtheta */
  /* part along x' of the flow's own M x' + f T', by differences: 1 where M and f are those of the flow, cycle or not */
  PetscReal check;
  PetscBool known; /* false where the flow fails next to the cycle, or Newton's matrix is singular */
} ShootingPhase;

typedef struct {
  PetscReal phase[2];     /* the eigenvalue of M whose vector is the motion along the cycle; NaN where none is told */
  PetscReal slope, check; /* dT/dtheta, and the check of the derivative (ShootingPhase); NaN where unknown */
  PetscReal largest[2];   /* of the others */
  PetscReal worst; /* modulus of the largest, if the phase's is another one that has as large a part in that motion */
} ShootingStability;

/* What a branch does at a cycle: it goes on along a tangent; it splits, Newton's matrix is singular; the flow fails
   next to the cycle, at another period or parameter, and has no derivative there */
typedef enum { SHOOTING_ALONG, SHOOTING_SPLITS, SHOOTING_NO_DERIVATIVE } ShootingDirection;

/*@ ShootingSolve - the cycle near a guess, at its value of the parameter. Not collective. That it does not converge is
    told by `converged`; then x is where the iteration stopped, which may be further off than the guess. @*/
PETSC_INTERN PetscErrorCode ShootingSolve(const Shooting *s, ShootingCycle *cycle);

/*@ ShootingGetPhase - how a cycle that has converged changes with the place of its steps, by Newton's matrix, and
   what the flow says of that matrix. Not collective. @*/
PETSC_INTERN PetscErrorCode ShootingGetPhase(const Shooting *s, const ShootingCycle *cycle, ShootingPhase *phase);

/*@ ShootingGetStability - multipliers of a cycle that has converged. Not collective. @*/
PETSC_INTERN PetscErrorCode ShootingGetStability(const Shooting *s, const ShootingCycle *cycle,
                                                 ShootingStability *stability);

/*@ ShootingGetTangent - direction of the branch at a cycle, along which the tangent before (of length 0 for none,
   then p grows) goes on; where there is none the tangent stays. Not collective. @*/
PETSC_INTERN PetscErrorCode ShootingGetTangent(const Shooting *s, const ShootingCycle *cycle, ShootingTangent *tangent,
                                               ShootingDirection *direction);

/*@ ShootingAdvance - the cycle at a distance along a branch, in place of `cycle`, which stays what it was where there
   is none (converged is then false). Folds are passed. Not collective. @*/
PETSC_INTERN PetscErrorCode ShootingAdvance(const Shooting *s, PetscReal step, const ShootingTangent *tangent,
                                            ShootingCycle *cycle);

/*@ ShootingCopy - a cycle into the arrays of another. Not collective. @*/
PETSC_INTERN PetscErrorCode ShootingCopy(PetscInt n, const ShootingCycle *from, ShootingCycle *to);

/*@
   ShootingFindFold - where the parameter turns back between a place of a branch and the one `step` further, dp/ds = 0,
   by regula falsi on that slope. Not collective.

   Input Parameters:
+  start  - a place
.  step   - how far to go at most
-  beyond - dp/ds there, of the other sign than at the start

   Output Parameters:
+  fold  - its arrays the caller's
-  error - how far its parameter may be from that of the fold of this flow; -1 where it was not found
@*/
PETSC_INTERN PetscErrorCode ShootingFindFold(const Shooting *s, const ShootingPlace *start, PetscReal step,
                                             PetscReal beyond, ShootingPlace *fold, PetscReal *error);
