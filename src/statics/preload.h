/* Private to statics/: stiffness that the forces of the sliding state add, as matrices of all unknowns */
#pragma once

#include <squeal/operators.h>

/*@
   GeometricStiffnessCreate - the stiffness int grad N_i . sigma . grad N_j dV times the 3 x 3 identity (N/m) of the
   stress sigma of a static displacement u (m, all unknowns) and of bolts with their shares (OperatorsAddLoads()) with
   the Young's moduli of the point p, symmetric; tension stiffens. Collective. The caller destroys it.
@*/
PETSC_INTERN PetscErrorCode GeometricStiffnessCreate(Operators operators, const PetscReal p[], Vec u,
                                                     const PetscReal share[], Mat *K);

/*@
   FollowerStiffnessCreate - the stiffness (N/m) of contact forces that turn with the master's surface and move over it
   with the slave, for the states of the local pairs. Unsymmetric; symmetric without friction; NULL without contact.
   Collective. The caller destroys it.
@*/
PETSC_INTERN PetscErrorCode FollowerStiffnessCreate(Operators operators, const ContactState state[], Mat *K);
