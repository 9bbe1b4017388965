/*
   TS of type "central" (private to dynamics/) - explicit integration of M u'' = f(t, u, v) with diagonal M:

      v_{n+1/2} = v_{n-1/2} + dt M^-1 ((1/2 - b) f_{n-1} + (1/2 + b) f_n),   u_{n+1} = u_n + dt v_{n+1/2}

   b = 1/2 is the central difference (order 2, energy is kept), b > 1/2 the dissipative explicit generalised Newmark
   scheme. f depends on the velocity of the half step before. The first step begins with v_0: v_{1/2} = v_0 + dt/2 M^-1
   f_0. A constraint may add its forces when f_n is complete, so that they bring about what must hold at t_{n+1}.
   Undamped modes of circular frequency omega are stable for dt^2 omega^2 <= 2 / b.
*/
#pragma once

#include <squeal/quantity.h>
#include <petscts.h>

#define TSCENTRAL "central"

/* The step from t_n: v_{n+1/2} = v_{n-1/2} + M^-1 (kick f_n + kick_old f_{n-1}), s */
typedef struct {
  Vec       u, v;           /* u_n and v_{n-1/2} */
  Vec       f, f_old;       /* f_n and f_{n-1}, N; f_old is NULL for b = 1/2 */
  PetscReal time, dt;       /* t_n and t_{n+1} - t_n */
  PetscReal dt_old;         /* t_n - t_{n-1}, 0 in the first step */
  PetscReal kick, kick_old; /* kick_old = 0 for b = 1/2 and in the first step */
} CentralStep;

/* Fills f. It may give v other values where M^-1 is 0. */
typedef PetscErrorCode (*CentralForce)(TS ts, const CentralStep *step, void *ctx);

/* Registers the type; once */
PETSC_INTERN PetscErrorCode TSCentralRegister(void);

/* The inverse of the diagonal of M (1/kg; referenced), the forces, and the constraint (same form, adds to f; may be
 * NULL) */
PETSC_INTERN PetscErrorCode TSCentralSetForces(TS ts, Vec minv, CentralForce force, CentralForce constraint, void *ctx);

/* Shows its rows. Collective */
PETSC_INTERN PetscErrorCode TSCentralVisit(TS ts, const QuantityVisitor *visitor);
/* b of the scheme: option -ts_central_b */
PETSC_INTERN PetscErrorCode TSCentralGetB(TS ts, PetscReal *b);

/* Forces of the last two steps (f_old NULL for b = 1/2; borrowed) and dt of the last step, 0 before the first */
PETSC_INTERN PetscErrorCode TSCentralGetForces(TS ts, Vec *f, Vec *f_old);
PETSC_INTERN PetscErrorCode TSCentralGetLastStep(TS ts, PetscReal *dt_old);

/* Goes on after a step of dt_old, with forces f_old set by the caller */
PETSC_INTERN PetscErrorCode TSCentralSetLastStep(TS ts, PetscReal dt_old);

/* Forces at the present time, without a step: for what is wanted at the end of a run */
PETSC_INTERN PetscErrorCode TSCentralEvaluate(TS ts);
