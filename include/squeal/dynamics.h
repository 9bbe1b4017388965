/*
   Dynamics - explicit integration in time with exact contact and Coulomb friction (seed paper, section 2.2, eq. 2):

      M a_n + C v_{n-1/2} + K u_n = F(t_n) + G'lambda_n,   lambda_n such that contact holds at t_{n+1} (projector.h)
      v_{n+1/2} = v_{n-1/2} + dt ((1/2 - b) a_{n-1} + (1/2 + b) a_n),   u_{n+1} = u_n + dt v_{n+1/2}

   with lumped M and damping lagged by half a step; b = 1/2 is the central difference, b > 1/2 the dissipative member of
   the explicit generalised Newmark family. It is a TS of type "central": all of PETSc's options -ts_* serve. Critical
   step: the largest dt with 4 M - 2 dt C - dt^2 K positive (b = 1/2), by Lanczos iteration on M^-1 (K + 2 C / dt).

   Energy ledger, J, of the half steps: kinetic 1/2 v'Mv, strain 1/2 u_{n+1}'K u_n; their change is the work of external
   forces, contact, friction, damping, and for b > 1/2 of the integrator. What is left over is energy_error_j: rounding.
   It closes with any forces, since the works are those of the forces that acted. Where it is asked for, steps are
   looked at by second paths, which are in the view and in transient.csv, the worst so far: K u of the kernels beside
   that of the elements, work of friction beside mu N on the way slid by the nodes' places, change of momentum beside
   the sum of what acts.
*/
#pragma once

#include <squeal/quantity.h>
#include <squeal/statics.h>

typedef struct _p_Dynamics *Dynamics;

/*@ DynamicsCreate - makes an integrator. Collective. @*/
PetscErrorCode DynamicsCreate(MPI_Comm comm, Dynamics *dynamics);

/*@ DynamicsSetModel - the scene, whose loads and parts have options for dynamics; before DynamicsSetFromOptions().
 * Collective. @*/
PetscErrorCode DynamicsSetModel(Dynamics dynamics, Model model, Contact contact);

/*@
   DynamicsSetFromOptions - reads how to integrate. Collective.

   Options Database Keys:
+  -ts_max_time <s>, -ts_max_steps <n> - how long; with them all of TS's own options
.  -ts_dt <s>                    - the step, as long as the run at most; without it, and then cut to the run,
.  -dynamics_step_fraction <0.9> - of the critical one, in six digits, not longer
.  -dynamics_step_force <false>  - integrate with a step above the critical one
.  -ts_central_b <0.5>           - b of the integrator, 0.5 to 1
.  -dynamics_start <rest|static> - from rest, or from the sliding state under the loads
.  -dynamics_shape <dir>         - folder of a run of modes, one of which is added to the start:
.  -dynamics_shape_mode <1>      - its number in modes.csv
.  -dynamics_shape_amplitude <1e-9> - largest component of its displacement x, m, in the phase in which it is positive;
                                       velocity Re(lambda x)
.  -dynamics_filters <dir>       - folder of a run of modes about the sliding state, -modes_filters and lumped mass:
                                   their amplitudes in amplitudes.csv, |c| at the largest component of the shape, m
.  -dynamics_filters_modes <0> - numbers of the modes in modes.csv; 0: all unstable ones
.  -dynamics_coriolis, -dynamics_centrifugal <false> - inertial forces in parts that turn
.  -dynamics_kernel <auto|general> - internal forces; general: one matrix of blocks for every body
.  -dynamics_history_interval <5e-6> - between rows of transient.csv, s; rounded to whole steps, and cut to the run, as
the next two:
                                   longer ones of the command line are refused
.  -dynamics_pairs_interval <0>  - between states of all pairs in contact_pairs.csv, s; 0 for none
.  -dynamics_snapshot_interval <0> - between fields, s; 0 for none
.  -dynamics_live <1>            - between live lines, s of the wall; 0 for none
.  -contact_view_kkt <false>     - print the residuals of the contact laws in the last step
.  -dynamics_check_interval <0>  - between looks at the laws by second paths, steps, and the last one; 0 for none
.  -dynamics_checkpoint_interval <0> - between checkpoints, steps; 0 for none
-  -dynamics_restart <false>     - go on from the checkpoint in the output folder
   and of the scene
+  -press_ramp <0>, -press_ramp_shape <smooth|linear>, -press_delay <0> - ramp of the load `press`, s
                                     which begins before the end of the run
.  -disc_velocity <0,0,0>        - of the part `disc` at the start, m/s
.  -lift_ramp, -lift_ramp_shape, -lift_delay - the same of the motion `lift` (model.h), whose ramp must be given;
                                   from the sliding state motions are there from the start, and have none
-  -impulses <names>             - at nodes: -hit_at x,y,z (m), -hit_part, -hit_impulse x,y,z (N s; zeros for none),
-hit_time (s), before
                                   the last step
   Those of contact surfaces are in projector.h.
@*/
PetscErrorCode DynamicsSetFromOptions(Dynamics dynamics);

/*@ DynamicsVisit - shows the rows of its options. Collective. @*/
PetscErrorCode DynamicsVisit(Dynamics d, const QuantityVisitor *visitor);

/*@ DynamicsNeedsPairs - whether the start is the sliding state, for which surfaces must face each other. Not
 * collective. @*/
PetscErrorCode DynamicsNeedsPairs(Dynamics dynamics, PetscBool *needs);

/*@ DynamicsSetOperators - bodies and contact, and the solver of the sliding state (borrowed). Collective. @*/
PetscErrorCode DynamicsSetOperators(Dynamics dynamics, Operators operators, Statics statics);

/*@
   DynamicsSolve - integrates and writes histories, fields and checkpoints as it goes. Collective.

   Errors: PETSC_ERR_USER_INPUT for a step above the critical one or beyond the end, for impulses and intervals of the
   command line that come after it; for bodies that interpenetrate at the start;
   PETSC_ERR_FP for the first node and step that are no number, and for growth of energy that the ledger cannot explain;
   PETSC_ERR_NOT_CONVERGED from the contact forces.
@*/
PetscErrorCode DynamicsSolve(Dynamics dynamics, Results results);

/*@ DynamicsView - step, ledger, contact residuals in words. Collective. @*/
PetscErrorCode DynamicsView(Dynamics dynamics, PetscViewer viewer);

/*@ DynamicsDestroy - frees the integrator. Collective. @*/
PetscErrorCode DynamicsDestroy(Dynamics *dynamics);
