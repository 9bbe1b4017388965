/*
   External (private to dynamics/) - forces and motions that the scene prescribes in time: loads, gravity,
   impulses, prescribed displacements of sets, initial velocities, inertial forces of a turning frame.

   Energy. With the external forces and those of the drives F_n at t_n, the work in the step around t_n is
      W_n = dt/2 F_n . (v_{n-1/2} + v_{n+1/2}) = dt/2 (now_n + old_{n+1}).
   A direction with a prescribed displacement has a force R_n = m (v_{n+1/2} - v_{n-1/2}) / dt - f_n of its drive, f_n
   being the sum of all other forces, contact included; hence m (v_{n+1/2} - v_{n-1/2}) . (v_{n-1/2} + v_{n+1/2}) / 2,
   the change of its kinetic energy, is the work of f_n + R_n exactly, and with the energies of dynamics.h
      kinetic_{n+1/2} + strain_{n+1/2} = kinetic_{n-1/2} + strain_{n-1/2} + W_n + works of contact, friction, damping
   holds to rounding, prescribed nodes counted with their lumped mass.
*/
#pragma once

#include <squeal/quantity.h>
#include <squeal/statics.h>
#include "dynamics/bodies/bodies.h"
#include "quantity/ramp.h"

typedef struct _p_External *External;

/* Power of the external forces and of the drives of prescribed motions, W, sums over this rank (shared nodes counted
   once): `old` of the forces at t_{n-1} on the velocities v_{n-1/2}, `now` of the forces at t_n on v_{n-1/2}; so that
   the work in step n is dt/2 (now_n + old_{n+1}). The drives' share of both is in old_{n+1}, since R_n is known at the
   end of the step only. `old` of the first step is 0. */
typedef struct {
  PetscReal old, now;
} ExternalPower;

/* The step from t_n, s, with state vectors of the layout */
typedef struct {
  PetscReal        time, dt;
  const PetscReal *u; /* u_n, m */
  PetscReal       *v; /* v_{n-1/2}, m/s; in directions of prescribed motions v_{n+1/2} in the end */
  PetscReal       *f; /* internal forces, N, to which all others are added */
} ExternalStep;

PETSC_INTERN PetscErrorCode ExternalCreate(MPI_Comm comm, Model model, External *external);

/*
   ExternalSetFromOptions - reads what the scene prescribes; after ModelSetFromOptions(). Collective.

   Options are the rows of quantities.c, ramp.h and, of motions, of the model.

   Errors: PETSC_ERR_USER_INPUT for a missing or invalid value.
*/
PETSC_INTERN PetscErrorCode ExternalSetFromOptions(External external);

/* ExternalVisit - shows the rows of its options. Collective. */
PETSC_INTERN PetscErrorCode ExternalVisit(External external, const QuantityVisitor *visitor);

/*
   ExternalSetUp - gathers the nodes of the loads, holds the directions of prescribed motions by BodiesHold(), where
   the model does not. Collective; after BodiesSetUp().

   Errors: PETSC_ERR_USER_INPUT for an unknown set; for motions whose directions a swept body cannot express, that
   prescribe the same direction of a node twice or only what supports hold; for an impulse on a node that is held.
*/
PETSC_INTERN PetscErrorCode ExternalSetUp(External external, Operators operators, Bodies bodies);

/* ExternalDrawBolts - bolts under a tension are drawn as in the sliding state. Not collective; after ExternalSetUp()
   and StaticsSolve(). */
PETSC_INTERN PetscErrorCode ExternalDrawBolts(External external, Statics statics);

/* ExternalSetVelocity - adds the initial velocities of the parts to state vector v (the mean of the parts' where they
   share a node); directions that are held or prescribed start with 0. Collective. */
PETSC_INTERN PetscErrorCode ExternalSetVelocity(External external, PetscReal v[]);

/* ExternalSetFrame - turning frame of a part: angular velocity (rad/s) about a centre (m);
   f -= m (2 Omega x v + Omega x (Omega x (x - centre))), each where asked for, x = X + u. Collective; after
   ExternalSetUp(), and again whenever the velocity changes (what its rate adds is left out). */
PETSC_INTERN PetscErrorCode ExternalSetFrame(External external, const char part[], const PetscReal omega[3],
                                             const PetscReal centre[3], PetscBool coriolis, PetscBool centrifugal);

/*
   ExternalAdvance - adds the forces at t_n to f, complete at every copy of a node, and gives the directions of
   prescribed motions the velocity (d(t_n + dt) - d(t_n)) / dt. An impulse J at time T acts as J / dt in the step with
   t_n <= T < t_n + dt, of the first two steps in the second: the first is half a step and would give half of J. Call at
   every step. Not collective.
*/
PETSC_INTERN PetscErrorCode ExternalAdvance(External external, const ExternalStep *step, ExternalPower *power);

/* ExternalFinish - ends the step that ExternalAdvance() began, when f holds all forces at t_n, contact included: from
   it follows the power of the drives. Not collective. */
PETSC_INTERN PetscErrorCode ExternalFinish(External external, PetscReal dt, const PetscReal f[]);

/* A blow: place of its node, m; momentum, N s; the time t_n of the step in which it acted, s, 0 before
   that and without ExternalSetUp() */
typedef struct {
  const char *name;
  PetscReal   x[3], impulse[3], time;
} ExternalHit;

/* Who is told of what comes when the run is over */
typedef enum {
  LATE_COMMAND, /* the command line, by an error */
  LATE_ALL,     /* files too, by a warning */
  LATE_NEVER    /* both, by an error: no restart goes on. Impulses alone */
} LateJudge;

/* ExternalCheckLate - impulses that are not before the last step of a run of steps dt to `end` (s), in which they act
   as a whole, and loads and motions that do not begin before the end. Collective. */
PETSC_INTERN PetscErrorCode ExternalCheckLate(External external, PetscReal end, PetscReal dt, LateJudge judge);

/* ExternalCheckDelay - the same of something by its delay, s. Collective. */
PETSC_INTERN PetscErrorCode ExternalCheckDelay(External external, const char name[], PetscReal delay, PetscReal end,
                                               LateJudge judge);

/* ExternalCheckSteps - that steps of dt (s) see the histories of loads and motions. Collective. */
PETSC_INTERN PetscErrorCode ExternalCheckSteps(External external, PetscReal dt);

/* ExternalIsHitting - whether an impulse acts in the step that ExternalAdvance() began. Not collective. */
PETSC_INTERN PetscBool ExternalIsHitting(External external);

/* ExternalCountHits, ExternalGetHit - the impulses of the scene; the name is borrowed. Not collective. */
PETSC_INTERN PetscErrorCode ExternalCountHits(External external, PetscInt *n);
PETSC_INTERN PetscErrorCode ExternalGetHit(External external, PetscInt i, ExternalHit *hit);

/* ExternalGetLoad, ExternalGetMotion - the history of load or motion i of the scene (borrowed). Not collective. */
PETSC_INTERN const Ramp *ExternalGetLoad(External external, PetscInt i);
PETSC_INTERN const Ramp *ExternalGetMotion(External external, PetscInt i);

/* ExternalCheckMotions - raises the error for displacements that begin with a jump; moved: from an equilibrium with
   those that do not swing. Collective. */
PETSC_INTERN PetscErrorCode ExternalCheckMotions(External external, PetscBool moved);

/* ExternalFindHit - the impulse i of the scene, due at `time` (s), and its node: local on one rank that has it, -1 on
   all others; no ExternalSetUp() is needed. Collective. Errors: PETSC_ERR_USER_INPUT for a node that is held in its
   direction. */
PETSC_INTERN PetscErrorCode ExternalFindHit(External external, PetscInt i, ExternalHit *hit, PetscInt *vertex);

/* ExternalGetVelocity - of the parts at the start, [parts][3], m/s (borrowed). Not collective. */
PETSC_INTERN const PetscReal *ExternalGetVelocity(External external);

/* ExternalGetMemory - what must be kept between two steps for a bitwise restart: n numbers of this rank (borrowed, and
   written in place; valid until the next ExternalSetFrame() of another part). Not collective. */
PETSC_INTERN PetscErrorCode ExternalGetMemory(External external, PetscInt *n, PetscReal **values);

/* ExternalAddChecksum - adds loads, gravity, motions, impulses, their histories, and velocities at the start.
   Collective; after ExternalSetUp(). */
PETSC_INTERN PetscErrorCode ExternalAddChecksum(External external, Checksum checksum);

/* ExternalView - in words, such as "load press: 100 N, smooth ramp over 0.002 s". Collective. */
PETSC_INTERN PetscErrorCode ExternalView(External external, PetscViewer viewer);
PETSC_INTERN PetscErrorCode ExternalDestroy(External *external);
