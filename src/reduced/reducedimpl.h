/* Private to reduced/: the stepper, the record of a run, and the files that fill it */
#pragma once

#include <squeal/options.h>
#include <squeal/quantity.h>
#include <squeal/reduced.h>
#include "contact/compliance/compliance.h"
#include "dynamics/history/history.h"
#include "dynamics/run/run.h"
#include "base/algebra/dense.h"
#include "base/algebra/gram.h"
#include "solver/factor/shiftinvert.h"

#define REDUCED_RTOL 1e-12 /* of the contact laws */

/* quantities.c - rows of the options */
extern const QuantityTable reduced_quantities;

/* How the forces of a pair were relaxed in the last step (step/relax.c) */
typedef struct {
  ContactStatus status;  /* open: they were not */
  PetscReal     ratio;   /* new normal force over the one before */
  PetscReal     cone[2]; /* friction over the normal force */
} ReducedRelaxed;

/* z(dt) = E z + F g of a mode alone: columns of eta, rate, g; half of its Q, what stands twice in it doubled */
typedef struct {
  PetscReal E[3][2], Q[6];
} ReducedAlone;

/* Modes that damping couples, and those alone (step/coupled.c) */
typedef struct {
  PetscInt      n, n_alone, *mode; /* [m] the coupled ones, then the others, each ascending */
  PetscReal    *E, *F, *Q;         /* [2 n][2 n], [n][2 n]; [3 n][3 n], NULL until works are asked for */
  PetscReal    *Cm, *HC;           /* [3 n_pairs][n], [n][3 n_pairs]; NULL undamped */
  ReducedAlone *own;               /* [n_alone] */
  PetscReal    *x, *y;             /* work: [3 n] */
} ReducedCoupled;

struct _p_ReducedStepper {
  const ReducedModel *model;
  PetscReal           dt, rtol, w; /* s; -; frequency that balances the exponential, rad/s */
  PetscReal          *E, *F;       /* [2 m][2 m], [m][2 m]: z(dt) = E z + F g, by columns */
  ReducedCoupled      coupled;     /* these, and Q, by modes that damping couples and those that it does not */
  PetscReal          *W;           /* [3 n_pairs][3 n_pairs] compliance of the pairs in a step, m/N */
  PetscInt   rank, *chosen; /* [rank] ports on which q is sought, all where W is regular or nothing damps; the others */
  PetscReal *combined;      /* [n - rank][rank]: what a force on one of the others is on the chosen ones */
  PetscReal *HW, *HC; /* [3 n_pairs]^2, [m][3 n_pairs] H W and H Cm' of the residual (step/residual.c); NULL undamped */
  /* [3 n_pairs]^2, NULL undamped; [3 n_pairs][2 m]: q_{n+1} and z(dt) of unit forces of the pairs at t_{n+1}; while W
     is made, G where the model is sparse */
  PetscReal            *R, *G;
  ContactCompliance     laws;                    /* NULL without pairs */
  struct _p_SparseLaws *sparse;                  /* what laws are solved on where W has no numbers, else NULL */
  PetscReal            *x, *next, *product;      /* work: [3 m] z and g; [3 m] z(dt); [3 m] */
  PetscReal            *mean, *free, *slip0, *r; /* work: [n_ports], [3 n_pairs], [2 n_pairs], [3 n_pairs] */
  PetscReal            *q, *dq, *slip, *port;    /* work: [3 n_pairs] q_{n+1}, its change, gaps and slips; [n_ports] */
  ReducedRelaxed       *relaxed;                 /* [n_pairs] */
  ReducedModel  damped; /* the model with damping as steps have it, which `model` is then: coupled.c, branches.c */
  PetscReal    *A;      /* [rank][rank] LU factors of H^-1, kept for forces of branches; else NULL */
  PetscBLASInt *pivot;  /* [rank] */
  PetscReal    *known, *elongation; /* [m + 3 n_pairs] forces of branches that a step knows; work */
};

/* An eigenvalue of the mesh about the sliding state beside that of the reduced model, rad/s */
typedef struct {
  PetscReal mesh[2], reduced[2],
    steps[2]; /* growth and frequency; steps: as the steps of the run see the reduced model */
  PetscBool unstable;
  char      label[32];
} ReducedPair;

/* A mode about the sliding state: growth without and with the inertia of what the cut-off leaves out, 1/s; frequency,
   rad/s; what growth is off by, relative */
typedef struct {
  PetscReal growth, whole, omega, off;
} ReducedGrowing;

/* How the normal force of another run differs */
typedef struct {
  PetscReal cutoff, dt;   /* of it, Hz, s */
  PetscReal rms, largest; /* of the difference, over the force's own rms about its mean and its largest value */
  PetscReal level;        /* rms about the mean in the last half of the time, relative difference */
  PetscReal open;         /* share of the last half without force, difference */
  PetscReal level_error, open_error; /* standard errors of the two, from pieces of the time */
  PetscBool loud;                    /* there is a vibration that has a level */
} ReducedDifference;

/* Shares of v'M v that the modes hold; 0 for what is not there */
typedef struct {
  PetscReal velocities, displacements, rates; /* of the parts; of -dynamics_shape */
} ReducedShares;

/* What is asked for: by options, and by who has the bodies reduced */
typedef struct {
  PetscBool  asked, compare, verify;
  PetscReal  cutoff; /* Hz, 0: to be chosen */
  PetscReal  growth_rtol;
  PetscBool  has_rtol; /* somebody says so */
  PetscBool  weighs;   /* Mx too */
  PetscInt   dense;    /* most pairs of a transient for dense matrices */
  PetscBool  steps;    /* nothing but steps is made of the bodies */
  PetscBool  springs;  /* penalty and pressure laws of the contacts are in series with the pairs */
  PetscReal *p;        /* parameters of the operators, NULL: those of the scene */
  ReducedRun like;     /* whose modes those taken resemble, as many; NULL: all below the cut-off are */
} ReducedRequest;

/* Bodies on their modes, with what they are made of */
typedef struct {
  const char   *why;     /* the cut-off is what it is */
  PetscBool     chooses; /* cut-off, and the step where -ts_dt leaves it open */
  Pencil        bodies;  /* every pair open, undamped */
  Modes         body_modes;
  Mat           Phi, MPhi; /* [unknowns][m] modes, and M Phi, dense */
  Mat           G, others; /* ports: [3 pairs][unknowns] of the pairs, sparse; [unknowns][loads, probes] dense */
  ShiftInvert   inverse;   /* of K - s M; kept for snapshots */
  Progress      progress;
  ReducedModel  model;
  PetscReal     orthonormal;    /* largest |Phi'M Phi - I| */
  PetscInt      n_local, begin; /* pairs of this rank, the first of them */
  ContactPair  *pair;           /* [n_pairs] */
  PetscInt     *vertex_port;    /* [nodes] first port of a node that is looked at, -1 for none */
  ReducedShares held;           /* at the start */
  PetscInt      n_hits;
  PetscReal    *hits, *hit_due; /* [n_hits][m] Phi'J, m sqrt(kg)/s; [n_hits] s */
} Reduction;

/* State in time, and where its next step is worked out */
typedef struct {
  PetscReal      dt;
  PetscInt       step;
  ReducedStepper stepper;
  ReducedState   state;
  ReducedReport  report;
  ContactState  *pairs; /* [n_pairs] */
  ContactSums   *sums;  /* [interfaces] */
  LedgerAccount  ledger;
  PetscReal     *loads, *sliding, *kick; /* [n_loads], [n_pairs], [m] */
  PetscReal     *acceleration, *shown;   /* [m] eta'', [n_ports] q and loads */
  PetscReal     *p_rate;                 /* [2][n_ports] N/s of what is shown, at t_n, and its mean in the last step */
  Mat            column;                 /* [unknowns][1] */
} ReducedMotion;

/* Errors of the reduction and of the steps, and what the laws of contact came to */
typedef struct {
  /* eigenvalues beside the mesh's */
  const char     *not_compared; /* why; NULL where it is */
  PetscInt        n_closed, n_compared;
  ReducedPair    *compared;
  PetscBool      *closed;   /* [n_pairs] in the sliding state */
  PetscReal      *lambda_n; /* [n_pairs] of it, N */
  PetscInt        n_growing;
  ReducedGrowing *growing;                /* fastest first */
  PetscReal       miss_model, miss_steps; /* largest error of growth of an unstable mode; what steps add, relative */
  /* other runs beside this one */
  PetscInt          n_force;       /* steps of which the force is kept, for -dynamics_verify */
  PetscReal        *force;         /* [n_force] normal force at t_1, t_2, ..., N */
  ReducedDifference finer, higher; /* with half the step; with a higher cut-off */
  /* statistics */
  PetscReal      n_its;   /* of the contact laws */
  ContactKKT     kkt;     /* the worst of all steps */
  PetscInt       n_steps; /* of this call */
  PetscLogDouble setup_seconds, seconds;
} ReducedResult;

struct _p_ReducedRun {
  MPI_Comm       comm;
  ReducedRequest request;
  Reduction      reduction;
  ReducedMotion  motion;
  ReducedResult  result;
  /* rooms */
  Dynamics    dynamics;
  Modes       mesh_modes;
  Results     results;
  DynamicsRun run;
  Checksum    scene; /* NULL until one is needed */
};

/* product.c - Y = A X and Y = A'X of dense blocks, Y without gaps between its columns */
PETSC_INTERN void ReducedTimes(const DenseBlock *A, const DenseBlock *X, PetscReal Y[]);
PETSC_INTERN void ReducedTimesTransposed(const DenseBlock *A, const DenseBlock *X, PetscReal Y[]);
/* Makes A [N][N] symmetric to the last bit */
PETSC_INTERN void ReducedSymmetrise(PetscInt N, PetscReal A[]);
/* y += A lambda of the pairs that carry, A [3 n_pairs][rows] */
PETSC_INTERN void ReducedAddCarrying(const ReducedModel *model, PetscInt rows, const PetscReal A[],
                                     const PetscReal lambda[], PetscReal y[]);
/* y += X coefficients. Collective */
PETSC_INTERN PetscErrorCode ReducedAddCombination(Mat X, const PetscReal coefficients[], Vec y);

/* bodies/model.c - zeros of so many parts with branches; branches of all parts */
PETSC_INTERN PetscErrorCode ReducedBranchesCreate(PetscInt n_parts, ReducedModel *model);
PETSC_INTERN PetscInt       ReducedBranches(const ReducedModel *model);

/* step/energy.c - displacement at a port, m */
PETSC_INTERN PetscReal ReducedPortDisplacement(const ReducedModel *model, const PetscReal eta[], const PetscReal p[],
                                               PetscInt port);
/* What motions move at a port by themselves, m, by the factors of the loads; with their rates, m/s */
PETSC_INTERN PetscReal ReducedMotionWay(const ReducedModel *model, const PetscReal loads[], PetscInt port);
/* Of all pairs, [3 n_pairs] */
PETSC_INTERN PetscErrorCode ReducedPairDisplacements(const ReducedModel *model, const PetscReal eta[],
                                                     const PetscReal p[], PetscReal y[]);
/* Column of W of a port, not of a pair where the model is sparse */
PETSC_INTERN const PetscReal *ReducedColumn(const ReducedModel *model, PetscInt port);
/* x'A x of a symmetric A [n][n], columns stride apart */
PETSC_INTERN PetscReal ReducedForm(PetscInt n, PetscInt stride, const PetscReal A[], const PetscReal x[]);
/* product.c - y += scale op(A) x */
PETSC_INTERN void ReducedBlockTimes(const DenseBlock *A, PetscBool transposed, PetscReal scale, const PetscReal x[],
                                    PetscReal y[]);

/* z_{n+1}, q_{n+1} and y_{n+1} of a state without loads, lambda_n in `last` and lambda_{n+1} in p: the linear part of a
   step */
PETSC_INTERN PetscErrorCode ReducedStepRespond(ReducedStepper stepper, const ReducedState *state, PetscReal next[],
                                               PetscReal q[], PetscReal y[]);

/* step/relax.c - takes out of the forces with which the next step begins what alternates; derivatives X [columns][size]
   before and next after the last step */
PETSC_INTERN PetscErrorCode ReducedStepperRelax(ReducedStepper stepper, ReducedState *state);
PETSC_INTERN void           ReducedStepperRelaxTangent(ReducedStepper stepper, PetscInt size, PetscInt columns,
                                                       const PetscReal X[], PetscReal next[]);

/* step/tangent.c - derivative of the last step: x = (eta, rate, lambda, q where the residual is damped) of so many
   numbers; the changes X [columns][size] at t_n, at most as many as numbers, become those at t_{n+1} */
typedef struct _p_ReducedTangent *ReducedTangent;
PETSC_INTERN PetscInt             ReducedTangentSize(const ReducedModel *model);
PETSC_INTERN PetscErrorCode       ReducedTangentCreate(ReducedStepper stepper, ReducedTangent *tangent);
PETSC_INTERN PetscErrorCode       ReducedTangentApply(ReducedTangent tangent, PetscInt columns, PetscReal X[]);
PETSC_INTERN PetscErrorCode       ReducedTangentDestroy(ReducedTangent *tangent);

/* bodies/modes.c - modes of the unconnected bodies below the cut-off: omega2, C and the vectors */
PETSC_INTERN PetscErrorCode ReducedFindModes(ReducedRun reduced);
/* M Phi of the modes that there are */
PETSC_INTERN PetscErrorCode ReducedWeighModes(ReducedRun reduced);

/* ports.c - ports as vectors of all unknowns, impulses, and P */
PETSC_INTERN PetscErrorCode ReducedSetPorts(ReducedRun reduced);

/* bodies/motions.c - nodal forces to a column of the loads and probes */
PETSC_INTERN PetscErrorCode ReducedPortSetNodal(ReducedRun reduced, Vec nodal, PetscInt column);

/* bodies/motions.c - what prescribed motions do, their loads from column `first` on; the port of the first; energy, J,
   that springs between free and moved nodes hold beside that of the free ones, with q of the pairs, p of the others */
PETSC_INTERN PetscErrorCode ReducedSetMotions(ReducedRun reduced, PetscInt first);
PETSC_INTERN PetscReal      ReducedMotionEnergy(const ReducedModel *model, const PetscReal eta[], const PetscReal q[],
                                                const PetscReal p[]);
/* When the residual is there: their damping D with what the residual moves; work that they do beside, J, of the change
   of eta and the mean forces */
PETSC_INTERN PetscErrorCode ReducedSettleDrag(ReducedRun reduced);
PETSC_INTERN void      ReducedMotionDrag(const ReducedModel *model, const PetscReal d_eta[], const PetscReal mean[],
                                         PetscReal dt, PetscReal *work);
static inline PetscInt ReducedFirstMotion(const ReducedModel *model)
{
  return 3 * model->n_pairs + model->n_loads - (model->dragged ? 2 : 1) * model->n_motions;
}

/* linear.c - of the modes about a sliding state that turn in time the one that grows fastest: eigenvalue (rad/s),
   -infinity and 0 for none; real and imaginary part of its motion and forces, without loads, or NULL */
PETSC_INTERN PetscErrorCode ReducedFastestMode(const ReducedModel *model, const ReducedState *sliding,
                                               PetscReal eigenvalue[2], ReducedState mode[2]);

/* memory.c - raises the error for dense matrices of the pairs that a machine does not hold, before anything is
   computed. Collective. */
PETSC_INTERN PetscErrorCode ReducedCheckMemory(ReducedRun reduced);

/* sparse/sparse.c - products with the compliance in place of its numbers, where r->request says so; shift and damping
   as bodies/residual.c has them */
PETSC_INTERN PetscErrorCode ReducedIsSparse(ReducedRun reduced, PetscBool *sparse);
PETSC_INTERN PetscErrorCode ReducedSparseCreate(ReducedRun reduced, PetscReal shift, Mat D);
PETSC_INTERN PetscErrorCode ReducedSparseDestroy(ReducedSparse *sparse);

/* residual.c - W; X := R X of a dense block, R = (K - s M)^-1 on the complement of the modes, MX work of the same
   size */
PETSC_INTERN PetscErrorCode ReducedSetResidual(ReducedRun reduced);
PETSC_INTERN PetscErrorCode ReducedApplyResidual(ReducedRun reduced, Mat B, Mat X);
/* bodies/branches.c - branches of the parts before the residual is there, with their laws; these freed */
PETSC_INTERN PetscErrorCode ReducedBranchesBegin(ReducedRun reduced, PencilLaw **law);
PETSC_INTERN PetscErrorCode ReducedBranchesEnd(ReducedRun reduced, PencilLaw **law);

/* pairs.c - gaps and laws of the pairs of all ranks; their states and sums after a step; residuals of the laws */
PETSC_INTERN PetscErrorCode ReducedSetPairs(ReducedRun reduced);
PETSC_INTERN PetscErrorCode ReducedTakePairs(ReducedRun reduced, PetscBool stepped);

/* drive.c - impulses.csv of what has acted until t_n; friction of the pairs at t, where it has a history; what acts in
   the step from t_n; way (m) that pair i slides in it as prescribed; factors [n_loads] of the loads at t, and of the
   equilibrium about which some swing */
PETSC_INTERN PetscErrorCode ReducedReportHits(ReducedRun reduced);
PETSC_INTERN PetscErrorCode ReducedSetFriction(ReducedRun reduced, PetscReal t, PetscBool *changed);
PETSC_INTERN PetscErrorCode ReducedGetWay(ReducedRun reduced, PetscInt i, PetscReal *way);
PETSC_INTERN PetscErrorCode ReducedDriveCreate(ReducedRun reduced);
PETSC_INTERN PetscErrorCode ReducedDriveSet(ReducedRun reduced, ReducedDrive *drive);
PETSC_INTERN void           ReducedSetLoads(ReducedRun reduced, PetscReal t, PetscReal factor[]);
PETSC_INTERN void           ReducedSetSteadyLoads(ReducedRun reduced, PetscReal t, PetscReal factor[]);

/* start.c - the state at t = 0 */
PETSC_INTERN PetscErrorCode ReducedStart(ReducedRun reduced);

/* compare.c - eigenvalues of the mesh, once; those of the reduced model beside them */
PETSC_INTERN PetscErrorCode ReducedCompareMesh(ReducedRun reduced);
PETSC_INTERN PetscErrorCode ReducedCompare(ReducedRun reduced);
PETSC_INTERN PetscErrorCode ReducedCompareView(ReducedRun reduced, PetscViewer viewer);

/* inertia.c - modes that grow without and with the inertia of what the cut-off leaves out; the most that one is off by,
   relative; a warning where that is much */
PETSC_INTERN PetscErrorCode ReducedWeighGrowth(ReducedRun reduced, PetscReal *off);
PETSC_INTERN PetscErrorCode ReducedWarnGrowth(ReducedRun reduced);
PETSC_INTERN PetscErrorCode ReducedGrowthView(ReducedRun reduced, PetscViewer viewer);

/* branches.c - 2 m eigenvalues with branches of system [2 + parts] = K, C and the dampings of the parts [m][m], which
   are overwritten */
PETSC_INTERN PetscErrorCode ReducedBranchesEigen(const ReducedModel *model, PetscReal *const system[],
                                                 PetscReal sigma[], PetscReal omega[]);

/* warp.c - ReducedLinearise() as steps of length dt (s) see the model */
PETSC_INTERN PetscErrorCode ReducedLineariseSteps(const ReducedModel *model, PetscReal dt, const PetscBool closed[],
                                                  const PetscReal lambda_n[], PetscReal sigma[], PetscReal omega[]);

/* choose.c - the cut-off to begin with; the step where -ts_dt leaves it open; reduces and compares with the mesh, with
   another cut-off and step where the first ones do not do */
PETSC_INTERN PetscErrorCode ReducedChooseCutoff(ReducedRun reduced);
PETSC_INTERN PetscErrorCode ReducedSetStep(ReducedRun reduced, PetscReal dt);
PETSC_INTERN PetscErrorCode ReducedChoose(ReducedRun reduced);

/* bodies/reduce.c - model and room for states and steps, from cut-off, step and run; frees these */
PETSC_INTERN PetscErrorCode ReducedReduce(ReducedRun reduced);
PETSC_INTERN PetscErrorCode ReducedForget(ReducedRun reduced);

/* step/residual.c - HW and HC; q of the step with lambda [n_ports] on the ports on which it is not sought, and as much
   less on the chosen ones: a force that moves the same */
PETSC_INTERN PetscErrorCode ReducedStepperSetResidual(ReducedStepper stepper);
PETSC_INTERN void           ReducedStepperSettle(ReducedStepper stepper, const PetscReal lambda[]);

/* X [columns][3 n_pairs] := H X, where there are branches */
PETSC_INTERN PetscErrorCode ReducedStepperApplyH(ReducedStepper stepper, PetscInt columns, PetscReal X[]);

/* step/branches.c - the model of a step with the dampers of branches */
PETSC_INTERN PetscErrorCode ReducedStepperSetBranches(ReducedStepper stepper);
/* Forces [m + 3 n_pairs] of elongations, in the mean of a step of dt, or with dt 0 at once */
PETSC_INTERN void ReducedBranchForces(const ReducedModel *model, PetscReal dt, const PetscReal z[], PetscReal work[],
                                      PetscReal force[]);
/* What a step knows of them; dq -= H k of those on the residual */
PETSC_INTERN void           ReducedStepperKnowBranches(ReducedStepper stepper, const ReducedState *state);
PETSC_INTERN PetscErrorCode ReducedStepperDragBranches(ReducedStepper stepper);
/* Elongations at the end of the step, and the work, J, that was done on the forces that it knew */
PETSC_INTERN PetscReal ReducedStepperAdvanceBranches(ReducedStepper stepper, ReducedState *state);

/* step/coupled.c - the model with damping of the stepper's own; what is coupled in it, before E and F are made; the
   blocks of these, HC and Cm; of Q [3 m][3 m]. Errors of none but memory. */
PETSC_INTERN PetscErrorCode ReducedStepperOwnDamping(ReducedStepper stepper);
PETSC_INTERN PetscErrorCode ReducedStepperFindCoupled(ReducedStepper stepper);
PETSC_INTERN PetscErrorCode ReducedStepperSetCoupled(ReducedStepper stepper);
PETSC_INTERN PetscErrorCode ReducedStepperSetCoupledDamping(ReducedStepper stepper, const PetscReal Q[]);
PETSC_INTERN PetscErrorCode ReducedStepperDestroyCoupled(ReducedStepper stepper);
/* next = E z + F g, x = (z, g); next += F g; dq -= H Cm'(change of eta) / dt; g += scale Cm dq; x'Q x, J */
PETSC_INTERN void      ReducedStepperMove(ReducedStepper stepper, const PetscReal x[], PetscReal next[]);
PETSC_INTERN void      ReducedStepperPush(ReducedStepper stepper, const PetscReal g[], PetscReal next[]);
PETSC_INTERN void      ReducedStepperDelay(ReducedStepper stepper, const PetscReal change[], PetscReal dq[]);
PETSC_INTERN void      ReducedStepperDrag(ReducedStepper stepper, PetscReal scale, const PetscReal dq[], PetscReal g[]);
PETSC_INTERN PetscReal ReducedStepperDampingForm(ReducedStepper stepper, const PetscReal x[]);

/* stepper.c - Q of the work of damping, where it is not there yet: only who asks for works needs it */
PETSC_INTERN PetscErrorCode ReducedStepperSetDamping(ReducedStepper stepper);

/* verify.c - keeps the normal force of a step; runs again, and says how the force differs */
PETSC_INTERN PetscErrorCode ReducedKeepForce(ReducedRun reduced);
PETSC_INTERN PetscErrorCode ReducedVerify(ReducedRun reduced);
PETSC_INTERN PetscErrorCode ReducedVerifyView(ReducedRun reduced, PetscViewer viewer);

/* record.c - ledger, rows, fields of t_n */
PETSC_INTERN PetscErrorCode ReducedRecord(ReducedRun reduced, PetscBool first);
PETSC_INTERN void           ReducedSetShown(ReducedRun reduced, PetscBool start);

/* keep.c - checkpoints; the stepper is made from the model that is read back */
PETSC_INTERN PetscErrorCode ReducedKeep(ReducedRun reduced);
PETSC_INTERN PetscErrorCode ReducedGoOn(ReducedRun reduced);

/* refuse.c - raises the error for what a reduced model cannot do */
PETSC_INTERN PetscErrorCode ReducedRefuse(ReducedRun reduced);
