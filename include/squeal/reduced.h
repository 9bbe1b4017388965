/*
   Reduced - transients on few coordinates: free modes of the separate, unconnected bodies, and the static compliance of
   what the modes leave out, with exact unilateral contact and Coulomb friction.

   Ports are directions in which forces act on the bodies and displacements are looked at: three for each pair of the
   contact (opening along n, slip of the slave along t and b), one for each load and motion, three for each probe. With
   the modes Phi of K x = omega^2 M x below the cut-off (supports and springs included, contact left out, M lumped as
   in all transients, Phi'M Phi = I), V the ports as vectors of all unknowns, P = V'Phi, forces p at the ports (N),
   lambda those of the pairs:

      eta'' + C eta' + Omega^2 eta + Cm q' = P'p + Phi'J delta(t - T),     y = P eta + W p, but q in place of lambda
      W q + Cx q' + Cm'eta' = W lambda   in W of the pairs: q = lambda without damping
      W = V'X,   X = (1 - Phi Phi'M) (K - s M)^-1 (1 - M Phi Phi') V,   s = -(cut-off / 1e4)^2
      C = Phi'D Phi,  Cm = Phi'D X,  Cx = X'D X,                          D = alpha M + beta K + ...

   y the displacements at the ports (m): what is above the cut-off is massless, and damped as the bodies are (left
   undamped, growth would be wrong by percents). s changes 1e-8 of it at most.

   Maxwell branches of a part of stiffness K_p at unit modulus (viscoelastic.h) add forces to both equations, on the
   coordinates e = (eta, q) of u = Phi eta + X q,

      sum_j E_j S z_j,   S = (Phi, X)'K_p (Phi, X),   z_j' = e' - z_j / tau_j,

   with z_j = 0 at the start, relaxed. With the mean rate of e in a step z_j is exact, and its mean in the step is

      (1 - b / tau) z_j + b de / dt,   b = tau (1 - (tau / dt) (1 - exp(-dt / tau))):

   a known force and a damper E_j b S, which is of second order at any tau, and takes energy always. That of the springs
   is none of the strain energy: work on branches is damping, as on the mesh.

   Where displacements follow others, u = Z q (ties, points that are joined rigidly: OperatorsGetDependents()), K, M, D
   and V are Z'K Z, Z'M Z, Z'D Z and Z'V: bodies that a tie joins are one. Phi and X are kept as Z Phi and Z X, of all
   unknowns. Nodes that follow may have pairs, loads, probes and impulses.

   Prescribed motions d(t) = r(t) d hold their nodes, which are no unknowns of K, M, D, and act as loads -K_fd d r and,
   where something damps, -D_fd d r' (a lumped M has no M_fd). What they move at the ports themselves, Y r, is added
   to y. With u_f of the free nodes and kappa = d'K_dd d the energy of all is that of u_f + r u_f'K_fd d + r^2 kappa /
   2; the same is added to the work of the drives, from which goes what contact does on nodes that they move, and
   likewise with damping. The inertia of the nodes that they hold is left out.

   Step from t_n to t_{n+1} = t_n + dt. Forces act on the modes as means (p_n + p_{n+1}) / 2, and these answer exactly
   (exponential of the coupled first-order system: C need not be diagonal, and modes may be overdamped); q obeys its law
   in the mean. This is of second order in dt, exact in statics, and stable for every dt, since energy

      E = 1/2 |eta'|^2 + 1/2 eta'Omega^2 eta + 1/2 p'W p (q in place of lambda),
      E_{n+1} - E_n = mean(p) . (y_{n+1} - y_n) - int (eta', q')'[C Cm; Cm' Cx] (eta', q') dt     (constant loads),
      exactly.

   lambda_{n+1} obeys at t_{n+1} the laws of projector.h, exactly:
      normal    0 <= lambda_n,  0 <= gap,  lambda_n gap = 0,   gap = g0 + y_n
      Coulomb   |lambda_T| <= mu lambda_n, slip of the step 0 (stick) or lambda_T = mu lambda_n d on the master, d the
                direction of the slip of the step (y_T less that at t_n, plus the prescribed sliding)
   on the compliance dy_{n+1} / dlambda_{n+1}, a dense matrix (stepper.c) or products (sparse/). mu is that of the slip
   speed of the step (contact.h).

   At the start nodal velocities and shapes v become Phi'M v; the modes must hold 90 % of v'M v. Impulses have no end of
   frequencies: only the modes receive them.

   Mean forces on a massless compliance keep what alternates from step to step. Where bodies are damped that is halved
   in each step: the next one begins with other forces than those with which this one ends, and the forces at t_n are
   the mean of both (step/relax.c). Limit: on a stiff light body without damping, at a low cut-off, the
   force is right in the mean of two steps: a block at rest under 9.81 N has 9.758 and 9.862 N in turn (0.5 %), with 6
   modes below 1000 Hz.

   Steps are longer than a period of the cut-off in no run: ReducedIntegrate() refuses them, since contact cannot
   follow.

   What is said of a body that turns: a disc in a fixed frame with prescribed sliding is served, one that moves under
   the pad (-contact_kinematics turning) is refused. Pairs stay what they are in the mesh.
*/
#pragma once

#include <squeal/quantity.h>
#include <squeal/dynamics.h>
#include <squeal/modes.h>
#include <squeal/pressurelaw.h>
#include <squeal/viscoelastic.h>

/* The error of the cut-off is told by what else is found on the modes below so many times it, of a transient, a cycle
   and a point of a map. 1.5 times may hold no further mode of a light body, and then tell a hundredth of the error:
   cycles of a small brake at 20 kHz, whose pad has its next modes beyond 30 kHz; see cycle.h */
#define REDUCED_HIGHER 2.25

typedef struct _p_ReducedRun    *ReducedRun;
typedef struct _p_ReducedSparse *ReducedSparse;

/* Maxwell branches of a part: E_j, Pa, tau_j, s, and S / Pa in blocks as C, Cm, Cx are */
typedef struct {
  PetscInt   n;
  PetscReal  stiff[VISCOELASTIC_BRANCHES], time[VISCOELASTIC_BRANCHES];
  PetscReal *S, *Sm, *Sx; /* [m][m], [3 n_pairs][m], [3 n_pairs][3 n_pairs] */
} ReducedBranch;

/* The reduced bodies: dense but for `sparse`, alike on every rank. Matrices are column-major. Ports: normal, t, b of
   pair 0, of pair 1 and so on, then the loads, among them gravity, the motions, and their rates, then x, y, z of each
   probe */
typedef struct {
  PetscInt       m, n_pairs, n_loads, n_probes, n_ports, n_motions;
  PetscReal     *omega2;     /* [m] (rad/s)^2, ascending, 0 for rigid modes */
  PetscReal     *C;          /* [m][m] 1/s, symmetric; NULL without damping */
  PetscReal     *P;          /* [n_ports][m], m numbers for each port, 1/sqrt(kg) */
  PetscReal     *W;          /* [n_ports][n_ports], m/N; where sparse those of loads and probes alone */
  PetscReal     *Cm;         /* [3 n_pairs][m] Phi'C X, s / sqrt(kg); NULL without damping */
  PetscReal     *Cx;         /* [3 n_pairs][3 n_pairs] X'C X, m s/N, symmetric; NULL without damping */
  PetscReal     *Y;          /* [n_motions][n_ports] what each motion moves at pairs and probes by itself, m */
  PetscReal     *kappa;      /* [n_motions][n_motions] d'K_dd d, J */
  PetscReal     *drag;       /* [n_motions][n_motions] what takes their rates, d'D d and with X d, J s */
  PetscBool      dragged;    /* motions have two loads each, the second for their rate */
  PetscReal     *Mx;         /* [3 n_pairs][3 n_pairs] X'M X, kg (m/N)^2, symmetric; NULL where nobody asks for it */
  PetscInt       n_branches; /* parts with branches */
  ReducedBranch *branch;     /* [n_branches] */
  PetscReal     *S;          /* S of all of them, one behind another */
  ReducedSparse  sparse;     /* products with W and Cx in place of these; NULL where they are dense */
  PetscReal     *gap;        /* [n_pairs] g0, m, positive open */
  PairSpring    *spring;     /* [n_pairs] normal laws in series with the pairs; NULL where contact is exact */
  FrictionLaw   *friction;   /* [n_pairs] with the stated speed of each */
} ReducedModel;

/* A state at t_n; its numbers stand one behind another, eta first, z last */
typedef struct {
  PetscReal  time;       /* s */
  PetscReal *eta, *rate; /* [m] coordinates, m sqrt(kg), and rates */
  PetscReal *p,
    *last; /* [n_ports] forces at t_n and t_{n-1}, N: lambda of the pairs (on the slave: normal, t, b), factors
                                of the loads */
  PetscReal     *begin;  /* [3 n_pairs] lambda with which the step from t_n begins, N: p, or relaxed (step/relax.c) */
  PetscReal     *q;      /* [3 n_pairs] forces on the residual, N: lambda, delayed by its damping */
  PetscReal     *y;      /* [3 n_pairs] displacements at the pairs, m */
  PetscReal     *z;      /* [branches of all parts][m + 3 n_pairs] elongations of the springs of branches */
  ContactStatus *status; /* [n_pairs] */
} ReducedState;

/* What acts in a step */
typedef struct {
  const PetscReal *loads;   /* [n_loads] factors at t_{n+1} */
  const PetscReal *sliding; /* [n_pairs] prescribed sliding of the slave along t in the step, m */
  const PetscReal *kick; /* [m] Phi'J of the impulses at t_n, shares of those between two times included, m sqrt(kg)/s;
                               NULL for none */
} ReducedDrive;

/* What a step did: works on the bodies, J; without `works`, which cost a tenth of a step, slip and the works of
   contact, friction and impulses alone */
typedef struct {
  PetscBool  works;
  PetscReal  external, damping;
  PetscReal *contact, *friction, *heat; /* [n_pairs] */
  PetscReal *slip;                      /* [2 n_pairs] of the step, along t and b, m */
  PetscReal  residual;                  /* of the laws, natural map relative to the largest force of a pair */
  PetscInt   its;                       /* of the contact solver */
} ReducedReport;

typedef struct _p_ReducedStepper *ReducedStepper;

/*@ ReducedModelCopy, ReducedModelDestroy - a model of its own like another; frees it. Not collective. @*/
PetscErrorCode ReducedModelCopy(const ReducedModel *from, ReducedModel *to);
PetscErrorCode ReducedModelDestroy(ReducedModel *model);

/*@ ReducedStateCreate, ReducedStateCopy, ReducedStateDestroy - a state of zeros; from one into another; frees it. Not
    collective. ReducedStateSize - how many numbers eta to y are. @*/
PetscInt       ReducedStateSize(const ReducedModel *model);
PetscErrorCode ReducedStateCreate(const ReducedModel *model, ReducedState *state);
PetscErrorCode ReducedStateCopy(const ReducedModel *model, const ReducedState *from, ReducedState *to);
PetscErrorCode ReducedStateDestroy(ReducedState *state);

/*@ ReducedReportCreate, ReducedReportDestroy - room for what a step did, works included. Not collective. @*/
PetscErrorCode ReducedReportCreate(const ReducedModel *model, ReducedReport *report);
PetscErrorCode ReducedReportDestroy(ReducedReport *report);

/*@ ReducedStepperCreate - the matrices of a step of length dt > 0 (s) and tolerance of the contact laws, relative. The
    model is borrowed until ReducedStepperDestroy(). Not collective. Errors: PETSC_ERR_USER_INPUT for a compliance of
    the pairs that is not positive semidefinite to 1e-10 of its largest diagonal. @*/
PetscErrorCode ReducedStepperCreate(const ReducedModel *model, PetscReal dt, PetscReal rtol, ReducedStepper *stepper);
PetscErrorCode ReducedStepperDestroy(ReducedStepper *stepper);

/*@ ReducedStepperTakeFriction - takes the friction of the model again, which has changed, and forgets
    factors of steps before. Not collective. @*/
PetscErrorCode ReducedStepperTakeFriction(ReducedStepper stepper);

/*@ ReducedStep - one step from the state at t_n, which becomes that at t_{n+1}. Not collective.
    Errors: PETSC_ERR_NOT_CONVERGED from the contact laws. @*/
PetscErrorCode ReducedStep(ReducedStepper stepper, const ReducedDrive *drive, ReducedState *state,
                           ReducedReport *report);

/*@ ReducedGetContactWork - adds the works of contact and friction in a step to the sums, J. Not collective. @*/
void ReducedGetContactWork(const ReducedModel *model, const ReducedReport *report, PetscReal *contact,
                           PetscReal *friction);

/*@ ReducedContactFeeds - whether contact gave so much of the energy that the motion is that of the steps: more than a
   tenth of what others gave, J. Not collective. @*/
PetscBool ReducedContactFeeds(PetscReal contact, PetscReal others);

/*@ ReducedEnergy - kinetic energy of the modes, and strain energy of modes and residual, J. Not collective. @*/
void ReducedEnergy(const ReducedModel *model, const ReducedState *state, PetscReal *kinetic, PetscReal *strain);

/*@
   ReducedLinearise - eigenvalues lambda [2 m] (rad/s) of the model about steady sliding; a real one twice in a row is
   two. Not collective.

   Input Parameters:
+  closed   - [n_pairs] the pairs that are closed, which all slide along t
.  lambda_n - [n_pairs] normal forces of the state, N, with which friction damps as -contact_friction_damping does: with
              speed v and slope mu' a pair has mu lambda_n / v (N s/m) along b and mu' lambda_n along t; NULL for none
-  inertia  - with the inertia of what the modes leave out, to first order in Mx, which the model must have
              (ReducedWeigh()): the difference is the error of the cut-off
@*/
PetscErrorCode ReducedLinearise(const ReducedModel *model, const PetscBool closed[], const PetscReal lambda_n[],
                                PetscBool inertia, PetscReal sigma[], PetscReal omega[]);

/*@
   ReducedEquilibrium - the sliding state: 0 = -Omega^2 eta + P'p with every closed pair sliding along t, lambda_T = -mu
   lambda_n on the slave, 0 <= lambda_n, 0 <= gap, lambda_n gap = 0, by an active set. Rigid modes that nothing resists
   are held by 1e-12 of the highest omega^2. Not collective.

   Input Parameter:
.  loads - [n_loads] their factors

   Output Parameters:
+  state - at rest there; time 0
-  found - false where the set does not settle: friction too large for the geometry, or loads that lift off
@*/
PetscErrorCode ReducedEquilibrium(const ReducedModel *model, const PetscReal loads[], ReducedState *state,
                                  PetscBool *found);

/*@ ReducedCreate - makes an integrator. Collective. @*/
PetscErrorCode ReducedCreate(MPI_Comm comm, ReducedRun *reduced);

/*@
   ReducedSetFromOptions - reads whether and how to reduce. Collective.

   Options are the rows of src/reduced/quantities.c.
@*/
PetscErrorCode ReducedSetFromOptions(ReducedRun reduced);

/*@ ReducedVisit - shows the rows of its options. Collective. @*/
PetscErrorCode ReducedVisit(ReducedRun r, const QuantityVisitor *visitor);

/*@ ReducedIsAsked - whether the options ask for it. Not collective. @*/
PetscErrorCode ReducedIsAsked(ReducedRun reduced, PetscBool *asked);

/*@ ReducedHasSprings - whether penalty and pressure laws of the contacts are in series with the pairs. Not
    collective. @*/
PetscErrorCode ReducedHasSprings(ReducedRun reduced, PetscBool *springs);

/*@ ReducedIsCompared - whether a transient compares its eigenvalues with those of the mesh where there is a
   -modes_band. Not
    collective. @*/
PetscErrorCode ReducedIsCompared(ReducedRun run, PetscBool *compared);

/*@ ReducedSetRooms - the run in time, of which loads, motions, histories and options are those of `dynamics`
   (referenced
    until ReducedDestroy()), and the solver of the mesh's modes. Not collective. @*/
PetscErrorCode ReducedSetRooms(ReducedRun reduced, Dynamics dynamics, Modes modes);

/*@ ReducedPrepare - cut-off, step and times of the run, without reducing; raises the errors of ReducedIntegrate() for
   what cannot be. For rooms that run reduced models by themselves. Collective. @*/
PetscErrorCode ReducedPrepare(ReducedRun reduced, Results results);

/*@ ReducedReduceAt - the bodies reduced below a cut-off (Hz, 0: that of `reduced`) with parameters p of the
   operators, NULL for the values of the scene; after ReducedPrepare(). With `like`, which was reduced with others, in
   as many modes, which resemble its own; else NULL. The caller destroys it. Collective. @*/
PetscErrorCode ReducedReduceAt(ReducedRun reduced, PetscReal cutoff, const PetscReal p[], ReducedRun like,
                               ReducedRun *at);

/*@ ReducedWeigh - bodies that are reduced from now on have Mx too, the inertia of what the modes leave out, which
   costs another block of solutions each. Not collective, alike on all ranks. @*/
PetscErrorCode ReducedWeigh(ReducedRun reduced, PetscBool weighs);

/*@ ReducedGetModel - the dense model (borrowed), alike on all ranks; friction may be changed. Not collective. @*/
PetscErrorCode ReducedGetModel(ReducedRun reduced, ReducedModel **model);

/*@ ReducedGetRun - cut-off (Hz), step and end (s); NULL for what is not needed. Not collective. @*/
PetscErrorCode ReducedGetRun(ReducedRun reduced, PetscReal *cutoff, PetscReal *dt, PetscReal *end);

/*@ ReducedGetHits - the impulses, after ReducedPrepare(): their number, and of bodies that are reduced Phi'J [n][m],
   m sqrt(kg)/s, and when they are due, s (borrowed; NULL for what is not needed). Not collective. @*/
PetscErrorCode ReducedGetHits(ReducedRun reduced, PetscInt *n, const PetscReal **hits, const PetscReal **due);

/*@ ReducedAddChecksum - adds what runs must share that go on with each other, but for step and end. Collective. @*/
PetscErrorCode ReducedAddChecksum(ReducedRun reduced, Checksum checksum);

/*@ ReducedGetInterface - the interface of a pair. Not collective. @*/
PetscErrorCode ReducedGetInterface(ReducedRun reduced, PetscInt pair, PetscInt *interface);

/*@
   ReducedIntegrate - reduces the bodies, compares with the mesh where -modes_band says a band, integrates, and writes
   what DynamicsSolve() writes but for amplitudes.csv, which -dynamics_filters asks for in vain. Collective.

   Errors: PETSC_ERR_USER_INPUT for a cut-off without modes below it, below an unstable mode of the mesh, or with modes
   that hold less than 90 % of the starting velocities or shape; PETSC_ERR_SUP
   naming what a reduced model cannot do.
@*/
PetscErrorCode ReducedIntegrate(ReducedRun reduced, Results results);

/*@ ReducedJudgeVerified - raises PETSC_ERR_NOT_CONVERGED where -dynamics_verify has found that the level of the
   vibration or the time
    without contact is another one by more than 10 % beyond twice its standard error. After ReducedView(). Collective.
    @*/
PetscErrorCode ReducedJudgeVerified(ReducedRun reduced);

/*@ ReducedView - modes, cut-off, step, cost, errors, ledger in words. Collective. @*/
PetscErrorCode ReducedView(ReducedRun reduced, PetscViewer viewer);

/*@ ReducedDestroy - frees the integrator. Collective. @*/
PetscErrorCode ReducedDestroy(ReducedRun *reduced);
