/*
   Quiet - in which part of a box of parameters no mode of the band grows.

   A box around the scene's own values p0 is cut into cells. On a cell with the middle pc the reduced model (sweep.h)
   in the eigenvectors of its middle is Lambda + E(p), E(pc) = 0, and no eigenvalue lies in the region R of growth where
   for every lambda in R there are weights v > 0 with

      |lambda - lambda_k - E_kk(p)| v_k > sum_(l != k) |E_kl(p)| v_l,   all k and all p of the cell,

   since the matrix is not singular then (S. Gershgorin; O. Taussky). Cells where that cannot be shown are cut in two.
   The statement holds for the reduced model at every point of the cell, but for rounding in the sums that show it; the
   estimated error of the model is taken off all distances, and is an estimate.

   The contact status is that of the scene's own values: where a point of the box has another sliding state the
   statement is none about the brake. How many of the points that the basis was made for have one is said, and full
   solutions have their own state. -analysis sample takes each point's own.
*/
#pragma once

#include <squeal/quantity.h>
#include <squeal/modes.h>
#include <squeal/statics.h>

typedef struct _p_Quiet *Quiet;

/*@ QuietCreate - makes an empty one. Collective. @*/
PetscErrorCode QuietCreate(MPI_Comm comm, Quiet *quiet);

/*@ QuietSetFromOptions - reads the box, and how far to look. Collective.

   Options are the rows of src/quiet/quantities.c. @*/
PetscErrorCode QuietSetFromOptions(Quiet quiet);

/*@ QuietVisit - shows the rows of its options. Collective. @*/
PetscErrorCode QuietVisit(Quiet quiet, const QuantityVisitor *visitor);

/*@ QuietSetRooms - what it computes with, as SampleSetRooms(). Collective. @*/
PetscErrorCode QuietSetRooms(Quiet quiet, Operators operators, const PetscReal p[], Modes modes, Statics statics);

/*@ QuietGetVaried - which options of the scene are varied (borrowed), as one list with commas. Not collective. @*/
PetscErrorCode QuietGetVaried(Quiet quiet, const char **names);

/*@ QuietSolve - the cells, the nearest dangerous point, the checks. Collective. @*/
PetscErrorCode QuietSolve(Quiet quiet, Results results);

/*@ QuietView - what a person wants to know first. Collective. @*/
PetscErrorCode QuietView(Quiet quiet, PetscViewer viewer);

/*@ QuietWrite - quiet.csv, quiet_cells.csv, quiet_checks.csv. Collective. @*/
PetscErrorCode QuietWrite(Quiet quiet, Results results);

/*@ QuietDestroy - frees it. Collective. @*/
PetscErrorCode QuietDestroy(Quiet *quiet);
