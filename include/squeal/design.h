/*
   Design - the least change of some parameters, or the least mass, with which no mode of the band is unstable on a box
   of others, which are uncertain.

      min  1/2 |z|^2 + w m(z) / m(0),   z the change of the chosen parameters, each beside its half width
      for  growth of every mode <= limit  at all scenarios of the uncertain ones: corners of their box and points inside

   About a design that is not good yet every unstable mode i of every scenario is a cut

      a_i + g_i' (z - z_k) <= -margin |g_i|,   g_i = d a_i / d z from left and right vectors,

   a = sigma - limit where the mode is damped, sigma^2 - limit^2 where it is one of a pair without damping: its sigma
   grows as a root beyond lock-in, sigma^2 as a straight line. The cuts of all designs so far are kept (a bundle). The
   next design solves the quadratic problem with them (PETSc's TAO, on its dual), and steps no further than the radius
   of trust. A design without unstable mode at any scenario of the reduced model is accepted when the full solution at
   the scenario that comes nearest to the limit says the same.

   About a sliding state each scenario of each design has its own contact status, out of the classes of the points that
   the basis is made for (sample.h). Those of a design are found once it is good with those of the design before; then
   it must be good with its own. Where a status is none of the classes, the one that differs in the fewest pairs is
   taken and the scenario counted; full solutions have their own state always.
*/
#pragma once

#include <squeal/quantity.h>
#include <squeal/modes.h>
#include <squeal/statics.h>

typedef struct _p_Design *Design;

/*@ DesignCreate - makes an empty one. Collective. @*/
PetscErrorCode DesignCreate(MPI_Comm comm, Design *design);

/*@ DesignSetFromOptions - reads what may change, and what is uncertain. Collective.

   Options are the rows of src/design/quantities.c. @*/
PetscErrorCode DesignSetFromOptions(Design design);

/*@ DesignVisit - shows the rows of its options. Collective. @*/
PetscErrorCode DesignVisit(Design design, const QuantityVisitor *visitor);

/*@ DesignSetRooms - what it computes with, as SampleSetRooms(). Collective. @*/
PetscErrorCode DesignSetRooms(Design design, Operators operators, const PetscReal p[], Modes modes, Statics statics);

/*@ DesignGetVaried - which options of the scene are varied (borrowed), as one list with commas. Not collective. @*/
PetscErrorCode DesignGetVaried(Design design, const char **names);

/*@ DesignSolve - the designs one after the other, and full solutions. Collective. @*/
PetscErrorCode DesignSolve(Design design, Results results);

/*@ DesignView - what a person wants to know first. Collective. @*/
PetscErrorCode DesignView(Design design, PetscViewer viewer);

/*@ DesignWrite - design.csv, design_parameters.csv. Collective. @*/
PetscErrorCode DesignWrite(Design design, Results results);

/*@ DesignDestroy - frees it. Collective. @*/
PetscErrorCode DesignDestroy(Design *design);
