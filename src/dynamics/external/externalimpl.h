/*
   Private to the files of External: the record of what the scene prescribes, and the files that fill it.

   Each kind of force reads its options, finds its nodes in SetUp, and in each step adds its forces at t_n, their power
   on v_{n-1/2} to `now`, and that of its forces at t_{n-1} to `old`.
*/
#pragma once

#include "external.h"
#include "forcepattern.h"
#include "quantity/ramp.h"

/* A load of the model: F(t) = r(t) F; of a bolt r(t) d F, with F of a shortening of 1 m */
typedef struct {
  char        *name;
  Ramp         ramp;
  ForcePattern pattern;
  PetscBool    is_bolt;
  PetscReal   *last;  /* r(t_{n-1}) */
  PetscReal   *drawn; /* d, m; NULL of what is no bolt */
} TimedLoad;

/* Displacement of a set, d(t) = r(t) d */
typedef struct {
  const PrescribedMotion *prescribed; /* d, set and directions, of the scene */
  Ramp                    ramp;
  PetscInt                n, n_owned; /* prescribed numbers of a state vector, those of owned nodes first */
  PetscInt               *index;
  PetscReal              *full;           /* d along each, m */
  PetscReal              *before, *after; /* work: v_{n-1/2} and v_{n+1/2}, m/s */
} Drive;

/* Momentum J given to a node at a time */
typedef struct {
  char        *name, *part; /* part is empty for any */
  PetscBool    has_at, has_impulse;
  PetscReal    at[3], x[3]; /* place asked for and that of the node, m */
  PetscReal    impulse[3];  /* J, N s */
  PetscReal    time;        /* s */
  ForcePattern pattern;     /* of J */
  PetscReal   *last;        /* factor of J in the last step, 1/s, and the time t_n > 0 at which it acted */
} Impulse;

/* Inertial forces of a part described in a turning frame */
typedef struct {
  PetscInt   part;
  PetscReal  omega[3];  /* rad/s */
  PetscReal  centre[3]; /* m */
  PetscBool  coriolis, centrifugal;
  PetscInt   n, n_owned;
  PetscInt  *vertex; /* local nodes from 0, owned ones first */
  PetscReal *last;   /* [n][3] forces of the last step, Cartesian, N */
} InertiaFrame;

struct _p_External {
  MPI_Comm  comm;
  Model     model;
  Operators operators;
  /* set by options */
  PetscInt      n_loads, n_motions, n_impulses, n_acting, n_parts, n_frames;
  TimedLoad    *loads;
  Drive        *motions;
  Impulse      *impulses;   /* those that act first */
  PetscReal     gravity[3]; /* of the model, m/s^2 */
  PetscReal    *velocity;   /* [n_parts][3], m/s */
  InertiaFrame *frames;     /* [n_parts] */
  /* built by ExternalSetUp() */
  const Layout *layout;
  PetscReal    *weight;     /* [layout n] m g along each number, N; NULL without gravity */
  PetscReal    *own_weight; /* the same where this rank owns the node, else 0 */
  /* status: what a restart needs, in one array to which all the `last` point */
  PetscInt   n_memory;
  PetscReal *memory;
  PetscReal *begun;  /* 1 when a step has been made */
  PetscReal *drives; /* power of the drives in the step before, on v_{n-1/2} + v_{n+1/2}, W */
};

/* quantities.c - velocity of a part, [3]; impulses, and what their rows do not say of one of an External */
PETSC_INTERN const QuantityTable start_velocity;
PETSC_INTERN const QuantityList  impulses_list;
PETSC_INTERN PetscErrorCode      ImpulseCheck(MPI_Comm comm, void *external, void *impulse);

/* layout.c - makes the memory as long as what is there needs; new numbers are 0 */
PETSC_INTERN PetscErrorCode ExternalLayMemory(External external);

/* layout.c - local nodes (from 0) of a set that have cells, those that this rank owns first; the caller frees them.
   Collective. */
PETSC_INTERN PetscErrorCode ExternalFindVertices(External external, const char set[], PetscInt *n, PetscInt *n_owned,
                                                 PetscInt **vertex);

/* loadforce.c */
PETSC_INTERN PetscErrorCode TimedLoadsSetFromOptions(External external);
PETSC_INTERN PetscErrorCode TimedLoadsSetUp(External external);
PETSC_INTERN PetscErrorCode TimedLoadsDraw(External external); /* bolts of a given length */
PETSC_INTERN PetscErrorCode TimedLoadsAdvance(External external, const ExternalStep *step, ExternalPower *power);
PETSC_INTERN PetscErrorCode TimedLoadsView(External external, PetscViewer viewer);
PETSC_INTERN PetscErrorCode TimedLoadsDestroy(External external);

/* motion.c - SetUp holds the directions; Advance gives them v_{n+1/2}, Finish counts the power of their drives */
PETSC_INTERN PetscErrorCode MotionsSetFromOptions(External external);
PETSC_INTERN PetscErrorCode MotionsSetUp(External external, Bodies bodies);
PETSC_INTERN PetscErrorCode MotionsAdvance(External external, const ExternalStep *step);
PETSC_INTERN PetscErrorCode MotionsFinish(External external, PetscReal dt, const PetscReal f[]);
PETSC_INTERN PetscErrorCode MotionsView(External external, PetscViewer viewer);
PETSC_INTERN PetscErrorCode MotionsDestroy(External external);

/* impulse.c - SetUp after that of the motions, since an impulse on a prescribed node does nothing */
PETSC_INTERN PetscErrorCode ImpulsesSetFromOptions(External external);
PETSC_INTERN PetscErrorCode ImpulsesSetUp(External external);
PETSC_INTERN PetscErrorCode ImpulsesAdvance(External external, const ExternalStep *step, ExternalPower *power);
PETSC_INTERN PetscErrorCode ImpulsesView(External external, PetscViewer viewer);
PETSC_INTERN PetscErrorCode ImpulsesDestroy(External external);

/* inertia.c - gravity and turning frames */
PETSC_INTERN PetscErrorCode InertiaSetUp(External external);
PETSC_INTERN PetscErrorCode InertiaAdvance(External external, const ExternalStep *step, ExternalPower *power);
PETSC_INTERN PetscErrorCode InertiaView(External external, PetscViewer viewer);
PETSC_INTERN PetscErrorCode InertiaDestroy(External external);

/* velocity.c - initial velocities of parts */
PETSC_INTERN PetscErrorCode VelocitySetFromOptions(External external);
PETSC_INTERN PetscErrorCode VelocityView(External external, PetscViewer viewer);
