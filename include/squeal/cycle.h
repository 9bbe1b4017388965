/*
   Cycle - limit cycles of the reduced model (reduced.h) directly: a periodic motion under constant loads and sliding,
   by shooting with Newton's method, its stability by Floquet multipliers, and the branch of such cycles over a
   parameter through folds: a parameter of the friction law or the speed of a contact, a load, or a parameter of the
   bodies such as a modulus.

   The state x = (eta, rate, lambda, q) at t_n is all that a step knows of the past. N steps of length T / N are the map
   Phi(x, T, p), p the parameter; its derivative M = dPhi/dx is the product of the derivatives of the steps, exact where
   no status of a pair changes at once: the laws are solved for the statuses that each step ended with. Then
   (solver/shooting/shooting.h)

      Phi(x, T, p) = x,     phase,     and along a branch the distance in (eta, rate, T, p): pseudo-arclength.

   A parameter of the bodies changes their modes: they are reduced at Chebyshev points of its range, brought to common
   coordinates, and the matrices interpolated (src/reduced/cycle/family.c), to a stated error. Derivatives in T and p
   are central differences of the flow.

   A cycle is stable where all eigenvalues of M but that of the phase lie inside the unit circle. In continuous time the
   phase's is 1. No steps of one length h = T / N keep that where a force has a kink in a step, as where pairs open and
   close: let the cycle, its steps shifted by theta against the motion, be x(theta), T(theta), and f = dPhi/dT. From
   Phi(x, T) = x follows (M - I) x' = -T' f, and for the left vector l of the phase and its eigenvalue m, (m - 1) l . x'
   = -T' l . f: m = 1 where T' = dT/dtheta = 0 and nowhere else. Forces count by their means: a kink at the part a of a
   step makes c_i h^2 a (1 - a) of T, and theta moves a: T' is h sum c_i (1 - 2 a), of first order. To place the kinks
   better raises that order, and makes T' zero for no steps but the exact flow, the only ones that go on where a shift
   cuts them. So m is 1 - T' nearly: 1.4e-2 and -2.2e-3 off in 25 and 401 steps of a small brake, T' -1.6e-2 and 2.1e-3;
   in 103 steps, which mix it with the next one to a conjugate pair, 4.3e-2 and 2.4e-2. To ask for 1e-6 is to ask for
   the exact flow.

   T' and x' are known exactly, by Newton's matrix (shooting.h): `period_slope` is T', `phase_multiplier` the eigenvalue
   m of M. `derivative_check` is the part along x' of M x' + f T', M and f by differences of the flow from the cycles
   next to this one. By x' and T' it is 1 where M and f are those of the flow, where no status changes in between to
   1e-9, in 16384 steps to 2e-7 (0.1 % off in the derivative of each step makes 6e-4 of it). It is no multiplier, and
   tells nothing of how near x is to a cycle: that is the residual.

   In M the phase is told by its vector, which makes most of x'. Where others have about as much part in that (at a
   fold, or where steps mix them) and it depends on which is taken, or where the largest modulus is nearer to 1 than its
   own error or the root of -cycle_rtol, the class is `numerical`: stability cannot be told. Where that error is not
   known, as without -cycle_verify, it is `unverified`: the multipliers are those of these steps, and nobody knows how
   far off.

   A branch begins at the end of a transient, or where a mode of the sliding state becomes unstable
   (src/reduced/cycle/onset.c). Where its parameter turns back the fold is found, dp/ds = 0; the error of its parameter
   is that of finding it and the difference to the fold of twice the steps.

   Directions in which nothing holds the bodies, so that a shift changes no force, are taken out: without that M - I is
   singular.

   N is odd: forces of pairs that stay closed may alternate from step to step (reduced.h), which after an odd number is
   a multiplier of
   -1, but after an even one would be 1, and M - I singular.

   The error of a cycle is an estimate by that of 2 N + 1 steps and by two of N steps that begin a third and two thirds
   of a step later: 4/3 of the difference to the former where the error is of second order in the step (frequency,
   force, probes, the parameter of a fold), and the largest to the latter; for multipliers, which pairs that open and
   close leave of first order, the larger of twice the former and the latter. It is that of the steps only. The error of
   the reduction is told on request, -cycle_verify_cutoff, in columns of its own: the difference to the cycle of as many
   steps on the modes below 2.25 times the cut-off. What lies above these is not in it: on a small brake it is what
   three times the cut-off make, to 1 %, while those below 1.5 times, none of which is more of the pad, told a hundredth
   of it and less. It counts for the class, and for the parameter of a fold: where no such cycle is found the class is
   `unverified`, and no error of a fold is told. The error of the interpolation is in neither.
*/
#pragma once

#include <squeal/quantity.h>
#include <squeal/reduced.h>
#include <squeal/sound.h>

typedef struct _p_LimitCycle *LimitCycle;

/*@ CycleCreate - makes a solver of cycles. Collective. @*/
PetscErrorCode CycleCreate(MPI_Comm comm, LimitCycle *cycle);

/*@
   CycleSetFromOptions - reads what is looked for. Collective.

   Options are the rows of src/reduced/cycle/quantities.c.
@*/
PetscErrorCode CycleSetFromOptions(LimitCycle cycle);

/*@ CycleFollowsTransient - whether the first cycle is that at the end of a transient. Not collective. @*/
PetscErrorCode CycleFollowsTransient(LimitCycle cycle, PetscBool *follows);

/*@ CycleVisit - shows the rows of its options. Collective. @*/
PetscErrorCode CycleVisit(LimitCycle c, const QuantityVisitor *visitor);

/*@ CycleSetSound - microphones that hear the cycles (borrowed); NULL has none. Not collective. @*/
PetscErrorCode CycleSetSound(LimitCycle cycle, Sound sound);

/*@ CycleSetRooms - the reduced run, at whose end a cycle is looked for, and the operators (borrowed), with the values p
    [parameters] of their parameters, NULL for those of the scene. Collective. @*/
PetscErrorCode CycleSetRooms(LimitCycle cycle, ReducedRun reduced, Operators operators, const PetscReal p[]);

/*@
   CycleSolve - runs the transient, finds the cycle at its end and the branch through it, or that from an onset, and
   writes cycle.csv and cycle_probes.csv, whole with each cycle. Collective.

   Errors: those of ReducedIntegrate(); PETSC_ERR_USER_INPUT for a parameter that cannot be varied or a range in which
   it cannot be, where loads or sliding still change, for a transient that ends at rest, or with a motion that does not
   return, and where no mode becomes unstable; PETSC_ERR_NOT_CONVERGED where shooting finds no first cycle.
@*/
PetscErrorCode CycleSolve(LimitCycle cycle, Results results);

/*@ CycleView - cycles, stability and errors in words. Collective. @*/
PetscErrorCode CycleView(LimitCycle cycle, PetscViewer viewer);

/*@ CycleDestroy - frees it. Collective. @*/
PetscErrorCode CycleDestroy(LimitCycle *cycle);
