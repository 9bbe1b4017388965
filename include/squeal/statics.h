/*
   Statics - the sliding state: static equilibrium of all bodies under the loads with frictional contact.

   Unknown displacements u (m) and contact forces per pair, internal forces on the left,
   loads and the weight of the parts (-model_gravity) on the right:

      K u + N' lambda_n - T' lambda_t - B' lambda_b = f

   K of parts and springs; gap g = g0 - N u. Normal law: 0 <= lambda_n, 0 <= g, lambda_n g = 0 (constraint) or lambda_n
   = k_n max(0, -g) (penalty) or A P(-g), by a pressure law P and the area A of the pair. Friction: where an interface
   slides (-contact_slip or -contact_rotation), lambda_t = mu lambda_n, lambda_b = 0 at every closed pair; else
   Coulomb's law, |(lambda_t, lambda_b)| <= mu lambda_n, with slip of the slave along the friction on the master.

   Friction depends on the order of loading. With -stages the loads, motions, the sliding and the interference of
   contacts act one after the other (statics/stages/stage.c): a stage goes from the equilibrium of the one before it to
   its own, in -static_load_steps equal steps, and slip counts from where the pairs were at the last of them. So a pair
   that sticks keeps its friction, one that closes begins with none, and one that has slipped holds what is left when
   loads cease. What acts stays, unless a later stage ends it; contacts that do not slide yet hold by Coulomb's law.

   Motions (-motions) hold u = d: these displacements are no unknowns, f has -K_fd d more, and gaps and slip count d. In
   modes about the state they are held. Their reactions are rows of reactions.csv.

   Method: one factorisation of K_a = K + kappa G'G (+ pins), G the rows of N (and T, B where Coulomb's law holds), and
   from it the small problem of the pairs, w + W_mu l - kappa W w = G K_a^-1 f for contact displacements w = G u and
   forces l, closed by one of the laws per pair; a primal-dual active set (semismooth Newton: M. Hintermueller, K. Ito,
   K. Kunisch, SIAM J. Optim. 13, 2002; friction: P. Alart, A. Curnier, Comput. Methods Appl. Mech. Eng. 92, 1991).
   kappa is only a device: it drops out of the solution. Beyond -static_dense rows the small problem is solved by GMRES,
   one solution with K_a a step; where that takes longer than a factorisation, the bodies are factored anew with the
   pairs at their status, one pattern and one analysis for all, which leaves GMRES a few steps (refactor.c). Where
   pressures are not linear, Newton's method goes on about that active set, with tangents to the laws (pressure.c).
   Where the iteration does not settle with Coulomb's law,
   continuation lowers a regularisation of it (soften.c); where that does not either, friction is raised in steps. Rigid
   motions that neither supports nor springs nor any pair resists are held at single unknowns,
   whose reactions vanish in equilibrium; u has no part of them.
*/
#pragma once

#include <squeal/quantity.h>
#include <squeal/pencil.h>
#include <squeal/results.h>

typedef struct _p_Statics *Statics;

/* Sums over the pairs of one interface */
typedef struct {
  PetscInt  n[CONTACT_N_STATUS]; /* pairs of each status */
  PetscReal normal;              /* sum of lambda_n, N */
  PetscReal force[3];            /* on the master, normal and friction, N */
  PetscReal friction[3];         /* its part along the surface, N */
  PetscReal rubbing;             /* sum of the lengths of that of each pair, N */
  PetscReal moment;              /* with a -rotation: of friction on the master about that axis, against it, N m */
  PetscReal centre[3];           /* of the normal forces, m */
  PetscReal area, closing;       /* of all pairs, m^2; the largest of a pair, m */
} StaticsResultant;

/* Line F = k d + c fitted to normal force against approach of the second rows of nodes */
typedef struct {
  PetscReal total, per_pair; /* k and k / number of pairs, N/m */
  PetscReal residual;        /* largest distance from the line, relative to the largest force */
  PetscReal range[2];        /* of the force, N */
  PetscInt  n_steps;
} StaticsStiffness;

/*@ StaticsCreate - makes a solver. Collective. @*/
PetscErrorCode StaticsCreate(MPI_Comm comm, Statics *statics);

/*@ StaticsSetOperators - the bodies and their contact (referenced until StaticsDestroy()). Collective. @*/
PetscErrorCode StaticsSetOperators(Statics statics, Operators operators);

/*@
   StaticsSetFromOptions - reads how to solve. Collective.

   Options are the rows of src/statics/quantities.c.
   The factorisation takes -st_pc_*, -st_mat_mumps_*, GMRES -st_pairs_ksp_*.
@*/
PetscErrorCode StaticsSetFromOptions(Statics statics);

/*@ StaticsVisit - shows the rows of its options. Collective. @*/
PetscErrorCode StaticsVisit(Statics s, const QuantityVisitor *visitor);

/*@
   StaticsSolve - the equilibrium at a point p of the operators' parameters, NULL for the values of the scene. Starts
   from the status of the solution before, else with all pairs closed. Collective.

   With stages it is that of the last one, from all pairs closed at the first.

   Errors: PETSC_ERR_USER_INPUT without loads or for a load that nothing resists; PETSC_ERR_NOT_CONVERGED where there is
   no equilibrium ("no equilibrium": proven by a rigid motion, which the message names, along which the loads push and
   against which no force of a pair acts), where what was found is not stable, or where none was found ("no equilibrium
   found": the message says how far friction could be raised, and whether the bodies then jam, the pairs do not settle
   or go round in a circle, or GMRES did not converge).
@*/
PetscErrorCode StaticsSolve(Statics statics, const PetscReal p[]);

/*@ StaticsSetWears - whether contacts wear as their options say before the state that StaticsSolveWorn() and
    StaticsSolveSliding() find. Not collective. @*/
PetscErrorCode StaticsSetWears(Statics statics, PetscBool wears);

/*@ StaticsViewWear - how long and how deep contacts have worn before the last state, a line each; nothing where none
    did. Collective. @*/
PetscErrorCode StaticsViewWear(Statics statics, PetscViewer viewer);

/*@
   StaticsSolveWorn - the same after wear, the gaps of all pairs grown as (contact/topography/wear.c)

      dg0/dt = (k_s + k_m) p^a v

   up to wear_time, or less where -wear_depth or -wear_settled says so. Steps are implicit: p is that at the end of a
   step, so that the wear of a step is one more compliance of the pair, and steps of any length are stable; their error
   is of first order in the step. All steps use one factorisation. The state is the equilibrium at the worn gaps as if
   they had always been so: pairs that stick have no history of the wear. With stages contacts wear in the last one,
   and all stages are solved anew. Collective.
@*/
PetscErrorCode StaticsSolveWorn(Statics statics, const PetscReal p[]);

/*@
   StaticsSolveSliding - the same, and the sliding state as a value: the closed pairs (rows closed or opened at their
   edge where -static_rows asks for it), the normal forces, the optional stiffness of the preload, and p. The caller
   destroys it. Collective.

   Errors: also PETSC_ERR_USER_INPUT for an interface with friction of which nothing says along what it slides, nor how
   stiff it holds (-contact_kt), and for a normal force that is given although the loads tell it.
@*/
PetscErrorCode StaticsSolveSliding(Statics statics, const PetscReal p[], SlidingState *state);

/* A point p of the parameters of the operators, number i of many */
typedef PetscErrorCode (*StaticsPoint)(void *ctx, PetscInt i, PetscReal p[]);

/* How the equilibria at many points were found */
typedef struct {
  PetscInt  n_mesh;    /* points solved on the mesh */
  PetscInt  n_vectors; /* of the basis, 0 where all points were */
  PetscReal ratio;     /* largest true error of a closing beside its estimate, where both were known; 0 for none */
} StaticsMany;

/*@
   StaticsSolveMany - which pairs are closed in the sliding state at n points. Collective.

   Where all laws are linear at a status (pairs that slide as they are told or have no friction, penalty contact), most
   points are solved on a basis of equilibria at some of them (statics/many/many.c); points whose status is nearer to a
   change than the estimated error are solved on the mesh. Else all are.

   Input Parameters:
+  n   - points
.  get - tells them, ctx its context
   Output Parameters:
+  closed - [n][local pairs] 1 closed, 0 open
-  how    - what it took

   Errors: those of StaticsSolveSliding().
@*/
PetscErrorCode StaticsSolveMany(Statics statics, PetscInt n, StaticsPoint get, void *ctx, char closed[],
                                StaticsMany *how);

/*@ StaticsRelease - frees the factorisation that StaticsSolve() keeps for the next call, at the same bodies, and the
    matrices of OperatorsGetBodies(). Collective. @*/
PetscErrorCode StaticsRelease(Statics statics);

/*@ StaticsHaveStages - whether the options name some. Not collective. @*/
PetscErrorCode StaticsHaveStages(Statics statics, PetscBool *staged);

/*@ StaticsCheckLasting - raises PETSC_ERR_USER_INPUT for a load that does not act in the last stage: the state is then
    none that a run in time may start from. Not collective. @*/
PetscErrorCode StaticsCheckLasting(Statics statics);

/*@ StaticsGetShortening - of a load that is a bolt under a tension its shortening, m. Not collective; after
    StaticsSolve(). @*/
PetscErrorCode StaticsGetShortening(Statics statics, PetscInt load, PetscReal *shortening);

/*@ StaticsGetState - states of the local pairs, and displacements of all unknowns, m (borrowed). Not collective. @*/
PetscErrorCode StaticsGetState(Statics statics, const ContactState **state, Vec *u);

/*@ StaticsGetKKT - residuals of the laws, and |K u + ... - f| over |f|, or the contact forces where they are larger.
    Not collective. @*/
PetscErrorCode StaticsGetKKT(Statics statics, ContactKKT *kkt, PetscReal *equilibrium);

/*@
   StaticsIsAffine - whether pencils about the sliding state differ from those with all pairs closed by the pairs
   that are open alone, so that they stay affine in the parameters. Pressure laws, friction damping
   (-contact_friction_damping),
   -static_geometric and -static_follower depend on the forces and displacements of the state: with any of them they are
   not. Not collective.
@*/
PetscErrorCode StaticsIsAffine(Statics statics, PetscBool *affine);

/*@
   StaticsIdentify - contact stiffness of an interface by pressing without friction, with exact contact: the load is
   raised in equal steps, and a line is fitted to the normal force against the approach of the second rows of nodes of
   slave and master (mean over the pairs), with the bodies at p. Seed paper, section 2.1. Collective.
@*/
PetscErrorCode StaticsIdentify(Statics statics, const PetscReal p[], PetscInt interface, StaticsStiffness *stiffness);

/*@ StaticsIdentifyAll - puts into p the stiffness per pair of every interface with -contact_kn identify. Collective.
    @*/
PetscErrorCode StaticsIdentifyAll(Statics statics, PetscReal p[], PetscViewer viewer);

/*@ StaticsSaveLoad - writes the loads, the weight and what motions exert at p as F.bin beside the matrices of
    -operators_save, for the equations of the pencil; nothing where there are none. Collective. @*/
PetscErrorCode StaticsSaveLoad(Statics statics, const PetscReal p[], Pencil pencil);

/*@ StaticsAddChecksum - adds the loads and how the sliding state is found. Collective. @*/
PetscErrorCode StaticsAddChecksum(Statics statics, Checksum checksum);

/*@ StaticsView - status, forces, residuals in words. Collective. @*/
PetscErrorCode StaticsView(Statics statics, PetscViewer viewer);

/*@ StaticsViewStages - what begins in each of the -stages, a line each; nothing without. Collective. @*/
PetscErrorCode StaticsViewStages(Statics statics, PetscViewer viewer);

/*@ StaticsWrite - static.csv, reactions.csv, stages.csv where there are some, and the displacements and pressure as
    fields. Collective. @*/
PetscErrorCode StaticsWrite(Statics statics, Results results);

/*@ StaticsDestroy - frees the solver. Collective. @*/
PetscErrorCode StaticsDestroy(Statics *statics);
