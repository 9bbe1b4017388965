/*
   Laws (private to dynamics/) - looks at a few steps of a run by second paths. The balance of energy closes with any
   forces, since the works in it are those of the forces that acted: a wrong friction coefficient or stiffness passes.
   Looked at are every -dynamics_check_interval steps and the last one, where it is given: tests ask for it, and who
   doubts a run. The forces inside a step are known to the run alone, so that no table can be asked instead. Errors,
   relative, beyond rounding:

      stiffness   the kernels' K u, which is summed up step by step, beside K_e u_e of all elements; of the largest
      force at a node friction    work lambda_T . s beside mu lambda_n |s|, with the slip s from the places of the nodes
      (slipwork.c), of the
                  latter; |lambda_T| - mu lambda_n, of lambda_n; heat in the ledger beside that of s
      momentum    sum_i M_i (v_{n+1/2} - v_{n-1/2}) = kick (loads + weight + impulses + springs + supports + damping),
      contact and
                  internal forces being equal and opposite; of the sum of the sizes of all forces
      moment      the same about the origin, with arms X of the undeformed bodies, for which K of a small rotation is 0;
      of contact
                  forces with arms X + u where slaves travel, since they act at one place on both bodies then

   Springs, dashpots and bushings act on u and v as told, supports hold what acts on held directions. What acts as it
   acts: moments of loads, damping, inertial forces of points and frames, and contact where a master moves in a frame of
   its own.
*/
#pragma once

#include "dynamics/external/external.h"
#include "dynamics/history/ledger.h"

/* Sums over this rank's nodes: forces (N) and moments about the origin (N m), and the sums of their sizes */
typedef struct {
  PetscReal value[6], size[2];
} LawsSum;

typedef struct {
  PetscInt  interval; /* set by options: steps; 0 for never */
  PetscBool now;      /* the step at hand is looked at */
  LawsSum   internal; /* forces of the bodies */
  LawsSum   miss;     /* what is not accounted for */
  LawsSum   before;   /* momentum at v_{n-1/2} with the impulses of the step, N s, N m s */
  PetscReal kick;     /* s */
} Laws;
