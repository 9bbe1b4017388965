/*
   ContactProjector - contact and Coulomb friction in explicit dynamics, exactly, by Lagrange multipliers.

   Forward increment (N. J. Carpenter, R. L. Taylor, M. G. Katona, Int. J. Numer. Methods Eng. 32, 1991; seed paper, eq.
   2): the multipliers at t_n make contact hold at t_{n+1}. With predicted velocities v* of the nodes and v = v* + kick
   M^-1 G'lambda, u_{n+1} = u_n + dt v, each pair of a slave node and the point of the master surface that it faces
   obeys
      normal    0 <= lambda_n,  0 <= gap_{n+1},  lambda_n gap_{n+1} = 0
      Coulomb   |lambda_T| <= mu lambda_n; slip velocity 0 (stick), or lambda_T = mu lambda_n s / |s| on the master, s
                the slave's slip velocity over the step (slip)
   without regularisation. mu is that of the slip speed (frictionlaw.h), extrapolated from the last two half steps.
   Block Gauss-Seidel on W = G M^-1 G', the cone of each pair solved exactly; residual of the natural map; warm start.
   One rank solves few pairs; many are solved by all ranks, in turn where they move the same nodes (-projector_ranks).
   Each node has Cartesian components of its body's frame.

   Kinematics per interface, -contact_kinematics:
      prescribed  meshes stay; the sliding velocity of -contact_slip/-contact_speed or -contact_rotation is added to the
                  slip
      turning     the master moves rigidly with that velocity; its nodes are described in the moving frame, and the
                  slaves travel over its facets (search by bounding volumes); nodes beyond its edge are released, and
                  taken up again
   without either, only the displacements slide. In all cases a slave travels over the facets with its own
   displacements. The normals are those of the undeformed master (small rotations), turned with it.
   With -contact_discretization mortar a pair is a mean of each side (contact.h), by integrals over both surfaces where
   they lie, which follow the bodies (contact/projector/mortar.c).
*/
#pragma once

#include <squeal/contact.h>

typedef struct _p_ContactProjector *ContactProjector;

/* One step from t_n to t_{n+1} */
typedef struct {
  PetscReal time; /* t_n, s */
  PetscReal dt;   /* t_{n+1} - t_n, s */
  PetscReal kick; /* v = v* + kick M^-1 G'lambda, s */
} ContactStep;

/* Sums over all pairs of one interface at t_n, all of them PetscReal; on every rank after ContactProjectorGetSums() */
typedef struct {
  PetscReal n[CONTACT_N_STATUS]; /* pairs of each status */
  PetscReal normal;              /* sum of lambda_n, N */
  PetscReal friction;      /* component of the force on the master along the mean slip direction, or its size, N */
  PetscReal force[3];      /* on the master, N */
  PetscReal contact_work;  /* of the normal forces on the velocities of the nodes since the start, J */
  PetscReal friction_work; /* of friction on the velocities of the nodes, J: what it feeds less what it takes */
  PetscReal heat;          /* dissipated by slip, with the sliding velocity, J, >= 0 */
  PetscReal residual;      /* natural map, relative to the largest impulse, worst step since the start */
  PetscReal sweeps, checks, steps;  /* since the start: of Gauss-Seidel, looks at all pairs, steps */
  PetscReal marked;                 /* value of `steps` at the mark, 0 for never */
  PetscReal mark[CONTACT_N_STATUS]; /* `n` then */
  PetscReal changed, most; /* steps since then with other numbers of pairs in `n`, and the most pairs that differ */
} ContactSums;

/*@ ContactSumsMark, ContactSumsCompare - keeps the numbers of pairs of each status, unless some are kept; tells after
   a step whether they differ from these, and by how many pairs. Not collective. @*/
void ContactSumsMark(ContactSums *sums);
void ContactSumsCompare(ContactSums *sums);

/*@ ContactProjectorCreate - for all interfaces; after ContactSetFromOptions(). Collective. @*/
PetscErrorCode ContactProjectorCreate(Contact contact, ContactProjector *projector);

/*@
   ContactProjectorSetFromOptions - reads how the masters move, and the most sweeps. Collective.

   Options are the rows of src/contact/projector/quantities.c.
@*/
PetscErrorCode ContactProjectorSetFromOptions(ContactProjector projector);

/*@ ContactProjectorVisit - shows the rows of its options. Collective. @*/
PetscErrorCode ContactProjectorVisit(ContactProjector projector, const QuantityVisitor *visitor);

/*@ ContactProjectorSetUp - checks the interfaces and gathers their surfaces; after ModelSetUp(). Collective. @*/
PetscErrorCode ContactProjectorSetUp(ContactProjector projector);

/*@ ContactProjectorGetTurning - whether the master of an interface turns in its own frame, and its angular velocity,
    rad/s. Errors: PETSC_ERR_USER_INPUT where that changes in time. Collective. @*/
PetscErrorCode ContactProjectorGetTurning(ContactProjector projector, PetscInt interface, PetscBool *turns,
                                          PetscReal rotation[3]);

/*@ ContactProjectorGetWay - what the ramp of the sliding velocity of an interface leaves of the time from t0 to t1,
    int r dt (s), and whether its master moves (-contact_kinematics turning); no ContactProjectorSetUp() is needed. Not
    collective. @*/
PetscErrorCode ContactProjectorGetWay(ContactProjector projector, PetscInt interface, const PetscReal t[2],
                                      PetscReal *way, PetscBool *turning);

/*@ ContactProjectorGetFriction - the factor of the friction coefficient of an interface at time t (s), and whether it
   ever is another. Not collective. @*/
PetscErrorCode ContactProjectorGetFriction(ContactProjector projector, PetscInt interface, PetscReal t,
                                           PetscReal *factor, PetscBool *varies);

/*@ ContactProjectorGetFactors - those of its sliding speed and its friction at time t (s), and whether friction has its
   own from a temperature. Not collective. @*/
PetscErrorCode ContactProjectorGetFactors(ContactProjector projector, PetscInt interface, PetscReal t, PetscReal *speed,
                                          PetscReal *friction, PetscBool *warms);

/*@ ContactProjectorCheckSteps - that steps of dt (s) see the histories of sliding and friction: an error for swings of
   fewer than two steps a cycle, warnings. Collective. @*/
PetscErrorCode ContactProjectorCheckSteps(ContactProjector projector, PetscReal dt);

/*@ ContactProjectorGetSteady - whether sliding and friction of an interface stay as they are once ramps are over. Not
   collective. @*/
PetscErrorCode ContactProjectorGetSteady(ContactProjector projector, PetscInt interface, PetscBool *steady);

/*@ ContactProjectorGetDelay - when the sliding of an interface begins, s; 0 where nothing slides as told. Not
   collective. @*/
PetscErrorCode ContactProjectorGetDelay(ContactProjector projector, PetscInt interface, PetscReal *delay);

/*@ ContactProjectorGetNodes - local nodes (from 0) of contact surfaces on this rank, copies included, [n]
    (borrowed). Not collective. @*/
PetscErrorCode ContactProjectorGetNodes(ContactProjector projector, PetscInt *n, const PetscInt **vertex);

/*@ ContactProjectorSetMass - 1/mass of every node and direction, [n][3], 0 where held. Collective. @*/
PetscErrorCode ContactProjectorSetMass(ContactProjector projector, const PetscReal minv[]);

/*@
   ContactProjectorStart - finds pairs at displacements u [n][3] and time t; with states (local pairs of
   ContactGetPairs(), NULL for none) their forces are the warm start. Collective.

   Errors: PETSC_ERR_USER_INPUT where bodies interpenetrate by more than `slack` (m): depth, place and interface; where
   a pair has no node that may move.
@*/
PetscErrorCode ContactProjectorStart(ContactProjector projector, PetscReal t, const PetscReal u[], PetscReal slack,
                                     const ContactState states[]);

/*@ ContactProjectorGetActive - nodes that may come into contact at this step: indices into the nodes, [n] (borrowed
    until the next ContactProject()). Errors: those of the step before. Collective. @*/
PetscErrorCode ContactProjectorGetActive(ContactProjector projector, PetscInt *n, const PetscInt **active);

/*@
   ContactProject - the contact forces of a step. Arrays are [nodes][3] of which only the active ones are read or
   written. Collective.

   Input Parameters:
+  step   - times
.  u      - displacements at t_n, m
.  before - velocities v_{n-1/2}, m/s, for the works
-  v      - predicted velocities v*, m/s

   Output Parameter:
.  force  - contact forces on the active nodes, N, complete on every rank that has the node

   Errors: PETSC_ERR_NOT_CONVERGED.
@*/
PetscErrorCode ContactProject(ContactProjector projector, const ContactStep *step, const PetscReal u[],
                              const PetscReal before[], const PetscReal v[], PetscReal force[]);

/*@ ContactProjectorGetStates - states of the last step of the slaves (borrowed): n on this rank, their interface,
    global node number and place (m, [n][3]); NULL for what is not needed. gap is that at t_{n+1}, slip that
    of the step. Not collective. @*/
PetscErrorCode ContactProjectorGetStates(ContactProjector projector, PetscInt *n, const ContactState **state,
                                         const PetscInt **interface, const PetscInt **number, const PetscReal **x);

/*@ ContactProjectorMark - from the next step on counts in the sums how often the numbers of open and sticking pairs
    differ from those of the last step; only the first call does. Not collective. @*/
PetscErrorCode ContactProjectorMark(ContactProjector projector);

/*@ ContactProjectorGetSums - sums of interface i, over all ranks. Collective. @*/
PetscErrorCode ContactProjectorGetSums(ContactProjector projector, PetscInt interface, ContactSums *sums);

/*@ ContactProjectorGetKKT - residuals of the laws in the last step. Collective. @*/
PetscErrorCode ContactProjectorGetKKT(ContactProjector projector, ContactKKT *kkt);

/*@ ContactProjectorGetMemory - what must be kept so that a run continues bitwise: n numbers on this rank. Not
    collective. The caller frees them. @*/
PetscErrorCode ContactProjectorGetMemory(ContactProjector projector, PetscInt *n, PetscReal **values);

/*@ ContactProjectorSetMemory - takes them back, on the same ranks, and repeats the last search. Collective. @*/
PetscErrorCode ContactProjectorSetMemory(ContactProjector projector, PetscInt n, const PetscReal values[]);

/*@ ContactProjectorAddChecksum - adds kinematics and ramps to the parts of the interfaces. Not collective. @*/
PetscErrorCode ContactProjectorAddChecksum(ContactProjector projector, Checksum checksum);

/*@ ContactProjectorView - surfaces and kinematics in words. Collective. @*/
PetscErrorCode ContactProjectorView(ContactProjector projector, PetscViewer viewer);

/*@ ContactProjectorDestroy - frees all. Collective. @*/
PetscErrorCode ContactProjectorDestroy(ContactProjector *projector);
