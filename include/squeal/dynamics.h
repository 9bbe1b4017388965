/*
   Dynamics - explicit integration in time with exact contact and Coulomb friction (seed paper, section 2.2, eq. 2):

      M a_n + C v_{n-1/2} + K u_n = F(t_n) + G'lambda_n,   lambda_n such that contact holds at t_{n+1} (projector.h)
      v_{n+1/2} = v_{n-1/2} + dt ((1/2 - b) a_{n-1} + (1/2 + b) a_n),   u_{n+1} = u_n + dt v_{n+1/2}

   with lumped M and damping lagged by half a step; b = 1/2 is the central difference, b > 1/2 the dissipative member of
   the explicit generalised Newmark family. It is a TS of type "central": all of PETSc's options -ts_* serve. Critical
   step: the largest dt with 4 M - 2 dt C - dt^2 K positive (b = 1/2), by Lanczos iteration on M^-1 (K + 2 C / dt).

   Energy ledger, J, of the half steps: kinetic 1/2 v'Mv, strain 1/2 u_{n+1}'K u_n; their change is the work of external
   forces, contact, friction, damping, and for b > 1/2 of the integrator. What is left over is energy_error_j: rounding.
   It closes with any forces, since the works are those of the forces that acted: that these obey their laws is tested
   from places of nodes and forces of pairs (tests/verify/laws.py).
*/
#pragma once

#include <squeal/quantity.h>
#include <squeal/sound.h>
#include <squeal/statics.h>

typedef struct _p_Dynamics *Dynamics;

/*@ DynamicsCreate - makes an integrator. Collective. @*/
PetscErrorCode DynamicsCreate(MPI_Comm comm, Dynamics *dynamics);

/*@ DynamicsSetModel - the scene, whose loads and parts have options for dynamics; before DynamicsSetFromOptions().
 * Collective. @*/
PetscErrorCode DynamicsSetModel(Dynamics dynamics, Model model, Contact contact);

/*@ DynamicsSetSound - what microphones there are (referenced until DynamicsDestroy()). Not collective. @*/
PetscErrorCode DynamicsSetSound(Dynamics dynamics, Sound sound);

/*@
   DynamicsSetFromOptions - reads how to integrate. Collective.

   Options are the rows of src/dynamics/quantities.c.
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
