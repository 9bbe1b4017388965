/*
   Map - what the brake does over one or two parameters: regime, amplitude and frequency of its vibration, by a
   transient of the reduced model (reduced.h) at every point. Along the first parameter each point goes on from the end
   of its neighbour, upwards and downwards, so that states that depend on the way are found on both: hysteresis. Each
   line of the map begins with the sliding state of its first point, and the scene's impulses hit it anew at every
   point.

   Parameters. Those of friction laws, sliding speeds and loads leave the reduced bodies as they are. All others
   (moduli, densities, springs, damping) need bodies of their own and hence come second: the bodies are reduced once for
   each value.

   A transient is looked at in windows of -map_window, T. Of the total normal force f in a window: mean, rms about it,
   the largest value, the share of the time without force and the share in which all closed pairs stick; the frequency
   is the main line of the slip speed along t, the mean of all pairs. It ends, after its last impulse,

     decays   where no mode of the sliding state grows (damping of friction included), and the rms falls: in two windows
     in turn
              in which no pair changes its status, so that the motion is linear, or in four of a vibration below 1 % of
              the mean force
     settled  where the rms of three windows in turn agrees within -map_rtol, pairs changing their status;
     error_estimate is
              the largest difference between them
     steady   where a vibration does not repeat itself, but its level does: over the last half of eight windows or more,
     in all of
              which pairs change their status, the standard error of the rms is within -map_rtol, and the two halves of
              these differ by twice that at most; numbers are means over them, error_estimate is that standard error
     time     at -ts_max_time; numbers are means over the last half, error_estimate is the standard error of the rms
     from
              window to window there, which is large for a vibration that does not repeat itself
     failed   where the contact laws have no solution; the next point begins with its own sliding state

   Regime: stable; growth; cycle; sticking, a vibration in which all closed pairs stick together in more than 1 % of the
   time; quasi_periodic, a vibration whose slip speed has two basic lines (base/statistics/lines.h) over the windows
   that its numbers are of; bistable, where rounding decides whether it vibrates.
   Growth, where at the end the rms still grows by half from a quarter of the time to the next; or where a mode grows,
   and over the last half the rms rises from window to window by more than -map_rtol, or no pair changes its status, so
   that the motion is linear: it is not where friction changes with the slip. Growth is that of the fastest mode about
   the sliding state, damping of friction included; of divergence, a real eigenvalue, the frequency is 0.

   Rounding. A motion that loses contact may be chaotic: what the reduced bodies differ by on other numbers of ranks
   then changes the amplitude, and may change the regime. A twin of a point begins 1e-9 apart, the size to which the
   contact laws hold, and goes on through the line from its own ends; a point that is linear but for its impulses has
   none while none is under way. Where the first twin has another regime or end, or another rms by 1e-3, all -map_twins
   are run, there and at the points after it until they agree. Where all vibrate, the numbers are means over them (of
   the largest value the largest, of the main line the middle one), and error_estimate is what these differ by from
   those of as many others in 5 of 100, from the spread between them and that of the windows in them; where some are
   stable, the point is bistable, and the numbers are of those that vibrate. A point whose twin agrees keeps its
   numbers, and the difference is part of error_estimate. A twin costs as much as its transient: a point that is chaotic
   costs 1 + -map_twins times as much, one that does not die out twice.

   The contact laws hold to 1e-9 of the largest force at every step; where they cannot, the point has failed. Friction
   is turned along the slip to 1e-7 of that force. -analysis transient has 1e-12 and 1e-10 there.

   Disturbed runs, -map_disturbances of each point, tell which other motions it has: from its sliding state with random
   velocities (map/basins.c), until their regime is known as above.

   The error of the cut-off and of the step is not in error_estimate: -map_verify tells it at some points, by transients
   from their own sliding states with half the step, with contact laws to 1e-12, and with 2.25 times the cut-off:
   differences of amplitude and frequency where both runs vibrate; what lies above the higher cut-off is not in them. A
   vibration that never repeats itself differs by more than its level does. The error of growth in the last of these
   rows is by the inertia of all that the cut-off leaves out (ReducedLinearise()).
*/
#pragma once

#include <squeal/quantity.h>
#include <squeal/reduced.h>

typedef struct _p_Map *Map;

/*@ MapCreate - makes a map. Collective. @*/
PetscErrorCode MapCreate(MPI_Comm comm, Map *map);

/*@
   MapSetFromOptions - reads what to vary. Collective.

   Options are the rows of src/map/quantities.c.
@*/
PetscErrorCode MapSetFromOptions(Map map);

/*@ MapVisit - shows the rows of its options. Collective. @*/
PetscErrorCode MapVisit(Map map, const QuantityVisitor *visitor);

/*@ MapSetRooms - the reduced model and the operators of the scene, at p (referenced until MapDestroy()). Not
   collective. @*/
PetscErrorCode MapSetRooms(Map map, ReducedRun reduced, Operators operators, const PetscReal p[]);

/*@ MapSetModes - takes from modes what counts as unstable. Not collective. @*/
PetscErrorCode MapSetModes(Map map, Modes modes);

/*@
   MapSolve - all points, and map.csv. Collective; each rank runs lines in one direction, or points apart, as it becomes
   free.

   Errors: PETSC_ERR_USER_INPUT for names, values and scenes that cannot be.
@*/
PetscErrorCode MapSolve(Map map, Results results);

/*@ MapJudge - a warning that counts the transients that failed, with the reason of the first. Errors:
   PETSC_ERR_NOT_CONVERGED where all
    did. Collective. @*/
PetscErrorCode MapJudge(Map map);

/*@ MapView - regimes, hysteresis and cost in words. Collective. @*/
PetscErrorCode MapView(Map map, PetscViewer viewer);

/*@ MapDestroy - frees the map. Collective. @*/
PetscErrorCode MapDestroy(Map *map);
