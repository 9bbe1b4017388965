/* Private to modes/: the record of the solver, and the pieces of a solution */
#pragma once

#include "growth/mechanism.h"
#include "solver/factor/shiftinvert.h"
#include <squeal/modes.h>
#include <squeal/options.h>
#include <squeal/quantity.h>
#include <slepceps.h>
#include <slepcpep.h>

/* Eigenvalues lambda = sigma + i omega (rad/s), omega >= 0, in order of frequency, with vectors x = xr + i xi in the
   unknowns of the pencil; xi is NULL for a real vector */
typedef struct {
  PetscInt   n, capacity;   /* eigenvalues; length of the arrays */
  PetscReal *sigma, *omega; /* [n] growth and angular frequency, rad/s */
  Vec       *xr, *xi;       /* [n] vectors, length: unknowns of the pencil */
  PetscReal
    reach; /* all eigenvalues with |lambda| up to this were converged, rad/s (undamped: those around the shift) */
} Spectrum;

PETSC_INTERN PetscErrorCode SpectrumCreate(PetscInt capacity, Spectrum *spectrum);
/* Distance of kappa = -lambda^2 of entry i from a shift */
PETSC_INTERN PetscReal      SpectrumDistance(const Spectrum *spectrum, PetscInt i, PetscReal shift);
PETSC_INTERN PetscErrorCode SpectrumAdd(Spectrum *spectrum, PetscReal sigma, PetscReal omega, Vec xr, Vec xi);
/* no copies */
PETSC_INTERN PetscErrorCode SpectrumTake(Spectrum *spectrum, PetscReal sigma, PetscReal omega, Vec xr, Vec xi);
PETSC_INTERN PetscErrorCode SpectrumSort(Spectrum *spectrum);
/* In place of its entries copies of n of them, some more than once */
PETSC_INTERN PetscErrorCode SpectrumTakeFrom(Spectrum *spectrum, PetscInt n, const PetscInt from[]);
PETSC_INTERN PetscErrorCode SpectrumKeep(Spectrum *spectrum, PetscInt first, PetscInt n);
PETSC_INTERN PetscErrorCode SpectrumOrder(const Spectrum *spectrum, PetscInt order[]); /* entry order[k] stands at k */
PETSC_INTERN PetscErrorCode SpectrumPermute(Spectrum *spectrum, const PetscInt order[]);
PETSC_INTERN PetscErrorCode SpectrumRemove(Spectrum *spectrum, PetscInt i);
PETSC_INTERN PetscErrorCode SpectrumAppend(Spectrum *from, Spectrum *to); /* moves the entries; `from` is destroyed */
PETSC_INTERN PetscErrorCode SpectrumDestroy(Spectrum *spectrum);

/* By which mechanism a mode grows, and the mode that couples with it, -1 for none */
typedef struct {
  Mechanism kind;
  PetscInt  partner;
  PetscReal real[2]; /* of the two without friction and damping, rad/s, to second order */
} ModeMechanism;

/* Shares of the causes in the growth of a mode */
typedef struct {
  PetscReal *growth;      /* [causes] 1/s */
  PetscReal  rest, error; /* of the growth, what they leave of it; of each share, 1/s */
  PetscReal  energy;      /* of the vector, J (PencilMeasureCauses()) */
  PetscBool  known;       /* the mode has a frequency */
} ModeShares;

/* Routes of a damped solution: by projection where its measure allows, always, never */
typedef enum { DAMPING_AUTO, DAMPING_PROJECT, DAMPING_PEP } DampingRoute;

/* About the sliding state where the scene is loaded, always with all pairs closed, always about the sliding state */
typedef enum { ABOUT_AUTO, ABOUT_ALL, ABOUT_STATIC } ModesAbout;

#define MODES_DAMPING "-modes_damping"

#define MODES_DAMPED_MOST 0.87 /* damping ratio from which on modes are not sought where damping is strong */

/* What a choice saved, in words */
enum { SAVED_FACTORS, SAVED_DAMPING, N_SAVED };
#define SAVED_LENGTH 512

/* components/ - which free modes of the bodies make up each mode */
typedef struct _p_ModesComponents *ModesComponents;
typedef struct _p_FreeBodies       FreeBodies;

/* Masses of nodes by which shapes are weighed, of what the cells of each part give (label/weigh.c), and the disc */
typedef struct {
  PetscInt        n;         /* parts */
  PetscReal     **mass;      /* [parts][local nodes] kg */
  PetscBool       has_disc;  /* it was looked for */
  PetscInt        disc_part; /* -1 for none */
  struct _p_Disc *disc;      /* label/disc.h; NULL for none */
} ModesWeights;

/* changes/ - masses, springs and dashpots to try on the modes found, and the modes that they make */
typedef struct _p_ModesChange  *ModesChange;
typedef struct _p_ModesChanged *ModesChanged;

struct _p_Modes {
  MPI_Comm comm;
  Pencil   pencil;
  Sound    sound; /* NULL: nobody listens */
  /* set by options */
  PetscReal band[2], target;       /* Hz */
  PetscReal growth;                /* rad/s; 0: a tenth of the highest angular frequency */
  PetscReal free_to;               /* of the highest frequency: free modes of the bodies up to there; 0: none */
  PetscBool free_found;            /* free modes from the modes found, where free_to is 0 */
  PetscReal unstable[2];           /* growth up to this is no instability: damping ratio, %; 1/s */
  PetscInt  most;                  /* modes that a band may hold; 0: any number */
  PetscBool has_most;              /* given */
  PetscBool may_be_none, may_move; /* a band without modes is no error; a reference at a target may move */
  PetscReal max_time;              /* s, of one solution; 0: any */
  PetscBool has_band, has_target, has_count, has_both, has_nearest, has_route, has_disc, left, keep, filters,
    sensitivities, couplings;
  PetscInt     count;
  ModesAbout   about;    /* which pairs are closed */
  PetscBool    loaded;   /* the scene has loads and contacts */
  DampingRoute damping;  /* of a damped solution */
  PetscInt     n_shifts; /* of a band; 0: chosen */
  char         disc[64];
  Progress     progress;
  PetscInt     n_changes;
  ModesChange  change; /* [n_changes] */
  /* results */
  Spectrum        right, left_spectrum; /* in the unknowns of the pencil, later expanded to all unknowns */
  Mode           *mode;
  PetscReal      *residual; /* [n] |Q(lambda) x| in the norm of M^-1, at most, with x of M-norm one, (rad/s)^2 */
  PetscInt        n, n_null_left;
  double         *part_percent;  /* participation [n][parts and superelements], NULL for matrices without a mesh */
  double         *label_percent; /* of the shape what its name explains [n], NULL likewise */
  PetscInt       *label_part;    /* the part that a mode is named after, -1 for none [n], NULL likewise */
  ModesWeights   *weights;       /* NULL: not weighed yet */
  FreeBodies     *bodies;        /* of the pencil; NULL: not asked for, or none */
  ModesComponents components;    /* NULL: not asked for */
  ModesComponents kept;          /* free modes that give names to shapes from elsewhere; NULL likewise */
  Modes           kept_free;     /* their vectors */
  ModesChanged    changed;       /* [n_changes], NULL likewise */
  PetscBool       dense;         /* LAPACK found all eigenvalues */
  PetscInt        shifts;        /* in use */
  char            completeness[4096];
  char            saved[N_SAVED][SAVED_LENGTH];
  char            solver[96];  /* type of the undamped eigensolver, its block and factors */
  ShiftInvert     factor;      /* of the solution where keep is set */
  EPS             left_solver; /* undamped, whose space has grown beside that of the right vectors; NULL: none has */
  ShiftInvert     null;        /* far below all elastic modes, for the null space of K */
  Vec            *null_left;   /* [n_null_left] left null vectors of K that a projection has found, or none */
  ShiftInvert     counter;     /* of the last count by inertia, from which the solution takes its analysis */
  /* [n] or NULL: not asked for yet */
  ModeMechanism *mechanism;
  ModeShares    *shares;
  /* of the solution under way */
  /* vectors in a block of the undamped eigensolver: at least, 0 for what it chooses; in use */
  PetscInt       block[2];
  PetscLogDouble begun;         /* s */
  PetscBool      over;          /* max_time is */
  PetscInt       found, wanted; /* eigenvalues converged at the last restart, and how many are asked for */
};

/* What inertia and norms tell of the matrices */
typedef struct {
  PetscInt  expected, below; /* frictionless modes in the window and below it, by inertia; negative when not known */
  PetscInt  massless;        /* negative pivots of K - s M at any s, of unknowns without mass: no modes */
  PetscBool singular;        /* there are such unknowns */
  /* frictionless modes below `most`, where there are such unknowns and a count is asked for; or -1 */
  PetscInt finite;
  /* with these, larger ones are no modes but infinite; infinite where that is not known, rad/s */
  PetscReal most;
  PetscInt  rigid;       /* damped: rigid modes, each a double zero; listed once */
  PetscInt  within;      /* damped: modes about as near to the shift as the window's corners; negative: not known */
  PetscReal scale, zero; /* far below any elastic mode yet above rounding; below it is zero by rounding: rad/s */
  PetscReal damping;     /* |C| / |K|, s: with stiffness damping beta the overdamped modes gather at -1 / beta */
} WindowKnown;

/* How its modes were found */
typedef struct {
  PetscBool project;    /* damped: by projection (project.c) */
  PetscBool laws, held; /* there: of a nonlinear problem; hysteretic, held at the reference it is itself */
  PetscBool counted;    /* there: inertia counts the undamped modes */
  PetscInt  n_basis;    /* vectors of a projection */
  PetscReal beyond;     /* measure of damping there, or negative */
  PetscInt  n_enlarged; /* further vectors there, since damping is strong */
  PetscInt  n_about;    /* complex shifts there, since it is stronger than that; or 0 */
  PetscReal pole;       /* or 0: about -pole, 1/s, to half of it, nothing is sought there */
  char      why[128];   /* why not by projection; empty where it was not tried */
  PetscReal middle;     /* or 0: of undamped modes far above a target, a better reference, rad/s */
  PetscBool mapped;     /* damping left the vectors as they were: C = alpha M + beta K */
  PetscReal mapped_alpha, mapped_beta; /* 1/s, s */
  PetscBool proven;                    /* inertia counts what was found */
  PetscReal worst;                     /* largest relative difference of right and left eigenvalues */
} WindowRoute;

/* All eigenvalues with omega in [low, high], |sigma| <= growth, rad/s; what is known of them; how they were found */
typedef struct {
  PetscReal   low, high, growth;
  PetscInt    count;   /* > 0: this many nearest to target instead, low and high unknown */
  PetscReal   target;  /* rad/s */
  PetscReal   edge[2]; /* ends of the band by which modes were counted and are selected, rad/s */
  PetscInt    extra;   /* eigenvalues to compute beyond those expected */
  PetscBool   guard;   /* those are wanted even where all of the window are found without */
  WindowKnown known;
  WindowRoute route;
} Window;

/* growth/state.c - what counts as unstable, in a line where it is given or decides */
PETSC_INTERN PetscErrorCode ModesViewLimit(Modes modes, PetscBool decides, PetscViewer viewer);

/* growth/pair.c - the mechanism of every mode (borrowed); that of an unstable one begins a line. Collective */
PETSC_INTERN PetscErrorCode ModesGetMechanisms(Modes modes, const ModeMechanism **mechanisms);
PETSC_INTERN PetscErrorCode ModesViewMechanism(Modes modes, PetscInt i, const ModeMechanism *m, PetscViewer viewer);

/* growth/causes.c - measures the shares of all modes, once, where there are causes, and makes the growth of each their
   sum; frees them. Collective */
PETSC_INTERN PetscErrorCode ModesBalance(Modes modes);
PETSC_INTERN PetscErrorCode ModesForgetShares(Modes modes);
/* modes_causes.csv; the largest shares of each unstable mode. Collective */
PETSC_INTERN PetscErrorCode ModesWriteCauses(Modes modes, Results results);
PETSC_INTERN PetscErrorCode ModesViewCauses(Modes modes, PetscViewer viewer);
/* Distance of mode i from the next one, rad/s: of those listed, its own conjugate, or what may lie beyond the band */
PETSC_INTERN PetscReal ModeGap(const Modes modes, PetscInt i);

/* Goes on with a line about shares of mode i: another mode has the same eigenvalue within the errors of both */
PETSC_INTERN PetscErrorCode ModeViewTwin(const Modes modes, PetscInt i, PetscViewer viewer);

/* Relative error of the vector of mode i, an estimate of first order, at most 1; nan without left vectors */
PETSC_INTERN PetscReal ModeVectorError(const Modes modes, PetscInt i);

/* output/sound.c - sound.csv, where there are microphones. Collective */
PETSC_INTERN PetscErrorCode ModesWriteSound(Modes modes, const Mesh *mesh, Results results);

/* growth/feedin.c - modes_feed_in.csv; the power per area, W/m^2, that friction gives to mode i, at the slave nodes of
   the contacts, density [local nodes], NULL where friction has no share; the caller frees it. Collective */
PETSC_INTERN PetscErrorCode ModesWriteFeedIn(Modes modes, Results results);
PETSC_INTERN PetscErrorCode ModesCreateFeedIn(Modes modes, PetscInt i, const Mesh *mesh, PetscReal **density);

/* components/table.c - modes_components.csv; the largest contributions of each unstable mode; nothing where none were
   found. Collective */
PETSC_INTERN PetscErrorCode ComponentsWrite(Modes modes, Results results);
PETSC_INTERN PetscErrorCode ComponentsView(Modes modes, PetscViewer viewer);
/* components/bodies.c */
PETSC_INTERN PetscErrorCode ComponentsDestroy(ModesComponents *components);
PETSC_INTERN PetscErrorCode FreeBodiesDestroy(FreeBodies **bodies);

/* growth/sensitivity.c - modes_sensitivities.csv; the largest effects on each unstable mode; nothing where they are not
   asked for. Collective */
PETSC_INTERN PetscErrorCode ModesWriteSensitivities(Modes modes, Results results);
PETSC_INTERN PetscErrorCode ModesViewSensitivities(Modes modes, PetscViewer viewer);
/* Whether the matrices follow a parameter at once: neither the sliding state nor the stress of a spin alone depends on
   it */
PETSC_INTERN PetscBool ModesParameterIsListed(const OperatorsParameter *parameter);

/* growth/effects.c - modes_effects.csv, and fields, where modes are unstable. Collective */
PETSC_INTERN PetscErrorCode ModesWriteEffects(Modes modes, Operators operators, const Mesh *mesh, Results results);

/* changes/records.c, changes.c - reads the changes; what they make of the modes, a line each, and modes_changed.csv;
   frees them. Collective */
PETSC_INTERN PetscErrorCode ChangesSetFromOptions(Modes modes);
PETSC_INTERN PetscErrorCode ChangesVisit(Modes modes, const QuantityVisitor *visitor);
PETSC_INTERN PetscErrorCode ChangesView(Modes modes, PetscViewer viewer);
PETSC_INTERN PetscBool      ChangeHasParameter(const Modes modes, PetscInt i);
PETSC_INTERN PetscErrorCode ChangesWrite(Modes modes, Results results);
PETSC_INTERN PetscErrorCode ChangesReset(Modes modes);
PETSC_INTERN PetscErrorCode ChangesDestroy(Modes modes);

/* quantities.c - rows of the options */
extern const QuantityTable modes_quantities;

/* solve.c - factors of K - shift M, or with damping of K + shift C + shift^2 M; those of the last count are given up,
   and their analysis serves */
PETSC_INTERN PetscErrorCode ModesFactor(Modes modes, const PencilMatrices *pencil, PetscReal shift, ReleaseKind release,
                                        ShiftInvert *si);

/* window.c - the window, and the count of frictionless modes in it by Sylvester's law of inertia */
PETSC_INTERN PetscErrorCode WindowFind(Modes modes, Window *window);
PETSC_INTERN PetscErrorCode WindowReach(Modes modes, Window *window); /* sets high for the modes nearest to a target */
PETSC_INTERN PetscErrorCode WindowCountRigid(Modes modes, Window *window, const Spectrum *spectrum);
PETSC_INTERN PetscErrorCode WindowSetDamping(Modes modes, const PencilMatrices *pencil, Window *window);
PETSC_INTERN PetscReal      WindowNearest(const Window *window, const Spectrum *spectrum);
PETSC_INTERN PetscErrorCode WindowSelect(const Window *window, Spectrum *spectrum);
/* With unknowns without mass: whether fewer modes are there than were asked for and than are finite */
PETSC_INTERN PetscBool WindowLacks(const Window *window, const Spectrum *spectrum);
PETSC_INTERN PetscInt  WindowFarthest(const Window *window, const Spectrum *spectrum);
/* The part ends[0] to ends[1] (rad/s) of a band, with its own count; frictional: of all modes that its circle may
   hold */
PETSC_INTERN PetscErrorCode WindowNarrow(Modes modes, const PencilMatrices *pencil, const Window *whole,
                                         const PetscReal ends[2], Window *part);
PETSC_INTERN PetscReal      WindowMiddle(const Window *window); /* of a part, in the plane of kappa = omega^2 */
PETSC_INTERN PetscErrorCode WindowProve(Modes modes, Window *window, const Spectrum *spectrum, PetscBool *complete);
/* complete.c - in words, how it was checked that no mode is missing */
PETSC_INTERN PetscErrorCode WindowDescribe(Modes modes, const Window *window);
/* Raises an error where more modes were counted than -modes_most */
PETSC_INTERN PetscErrorCode WindowCheckCount(Modes modes, const Window *window);

/* The error of a window that the eigensolver, eps or pep, did not cover, with its likely cause */
PETSC_INTERN PetscErrorCode WindowComplain(Modes modes, const Window *window, const char solver[]);

/* limit.c - the time that a solution may take: begins it; has the factors ask it after every solve; whether it is over,
   asked at every restart of an eigensolver with n of nev eigenvalues converged, which also tells the progress line how
   far it is; the error with its advice, for a spectrum, or where an eigensolver was left before a restart */
PETSC_INTERN PetscErrorCode LimitBegin(Modes modes);
PETSC_INTERN PetscErrorCode LimitAttach(Modes modes, PetscInt nev, ShiftInvert *si);
PETSC_INTERN PetscErrorCode LimitAsk(Modes modes, PetscInt n, PetscInt nev);
PETSC_INTERN PetscErrorCode LimitCheck(Modes modes, PetscBool damped, const Spectrum *spectrum);
PETSC_INTERN PetscErrorCode LimitCheckLeft(Modes modes);

/* undamped.c, damped.c - all eigenvalues of the pencil in the window, right ones or those of the transposed problem */
PETSC_INTERN PetscErrorCode UndampedSolve(Modes modes, const PencilMatrices *pencil, const Window *window,
                                          ShiftInvert *si, PetscBool transposed, Spectrum *spectrum);
PETSC_INTERN PetscErrorCode DampedSolve(Modes modes, const PencilMatrices *pencil, const Window *window,
                                        ShiftInvert *si, PetscBool transposed, Spectrum *spectrum);
/* The same by SLEPc's PEP; all ranks have unknowns */
PETSC_INTERN PetscErrorCode DampedSolvePep(Modes modes, const PencilMatrices *pencil, const Window *window,
                                           ShiftInvert *si, PetscBool transposed, Spectrum *spectrum);
/* dampedlayout.c - whether a rank has no unknowns; and by PEP where one has none, with factors of its own about the
   shift */
PETSC_INTERN PetscErrorCode DampedHasEmpty(Mat K, PetscBool *empty);
PETSC_INTERN PetscErrorCode DampedSolveSpread(Modes modes, const PencilMatrices *pencil, const Window *window,
                                              PetscReal shift, PetscBool transposed, Spectrum *spectrum);
/* Distance from the shift that the converged eigenvalues must exceed: the farthest corner sigma + i omega of the
   window; for modes near a target those at most as far from it as the count-th nearest that was found */
PETSC_INTERN PetscReal DampedRadius(const Window *window, PetscReal shift, const Spectrum *found);
/* dampeddense.c - whether LAPACK is to find all eigenvalues where nev of them are asked for, for the attempt-th time;
   it does so, about the shift. Sets modes->dense */
PETSC_INTERN PetscErrorCode DampedIsDense(Modes modes, Mat K, PetscInt nev, int attempt, PetscBool *dense);
PETSC_INTERN PetscErrorCode DampedSolveDense(Modes modes, const PencilMatrices *pencil, const Window *window,
                                             PetscReal shift, PetscBool transposed, Spectrum *spectrum);
/* solve.c - right spectrum by the solver that fits the pencil; a shift that happens to be an eigenvalue is moved */
PETSC_INTERN PetscErrorCode ModesSolveRight(Modes modes, const PencilMatrices *pencil, const Window *window,
                                            ShiftInvert *si);
/* project.c - right and left spectra of a damped pencil in the window by projection on undamped modes; done = false
   where that route is not the one, window->route.why says why */
PETSC_INTERN PetscErrorCode ProjectSolve(Modes modes, const PencilMatrices *pencil, Window *window, PetscBool *done);
/* undamped.c - start vectors of a solver at random, not alike on all ranks: such a vector could miss what is not */
PETSC_INTERN PetscErrorCode SolverSeed(BV bv, unsigned long seed);
/* Radius about the shift that the converged eigenvalues kappa must exceed; found is for the modes nearest to a
   target */
PETSC_INTERN PetscReal UndampedRadius(const Window *window, PetscReal shift, const Spectrum *found);
PETSC_INTERN PetscReal UndampedShift(const Window *window);
PETSC_INTERN PetscReal DampedShift(const Window *window);
PETSC_INTERN PetscInt  DampedFirst(const Window *window);

/* copies.c - whether as many equal eigenvalues of the spectrum were found as a block of the eigensolver has vectors,
   and no count says that these are all; makes the next blocks larger, also where it is known that eigenvalues are
   missing */
PETSC_INTERN PetscBool CopiesDoubtful(const Modes modes, const Window *window, const Spectrum *spectrum);
PETSC_INTERN void      CopiesMakeRoom(Modes modes, const Window *window, const Spectrum *spectrum);

/* solve.c - right and left spectra of a window that agree, with a factorisation about its shift */
PETSC_INTERN PetscErrorCode ModesSolveWindow(Modes modes, const PencilMatrices *pencil, Window *window,
                                             ShiftInvert *si);
/* shifts.c - sets modes->shifts, of a band; the same as above of all of it by so many, si is made here, of the last
   one */
PETSC_INTERN PetscErrorCode ShiftsChoose(Modes modes, const PencilMatrices *pencil, const Window *window);
PETSC_INTERN PetscErrorCode ShiftsSolve(Modes modes, const PencilMatrices *pencil, Window *window, ShiftInvert *si);
/* The lower end of part k of n of a band, rad/s; adds the spectra of the solver, above that seam, to those of the parts
   before */
PETSC_INTERN PetscReal      ShiftsSeam(const Window *window, PetscInt n, PetscInt k);
PETSC_INTERN PetscErrorCode ShiftsAppend(Modes modes, PetscReal seam, Spectrum *right, Spectrum *left);

/* left.c - left partners of the right eigenvalues; complete = the window holds the same ones in both; biorthogonal
   left vectors in clusters, work[3] in the pencil's unknowns */
PETSC_INTERN PetscErrorCode LeftMatch(Modes modes, const Window *window, PetscReal *worst, PetscBool *complete);
PETSC_INTERN PetscErrorCode LeftBiorthogonalise(Modes modes, const PencilMatrices *pencil, Vec work[]);

/* quality.c - measures the errors, expands the vectors to all unknowns and normalises them */
PETSC_INTERN PetscErrorCode QualityMeasure(Modes modes, const PencilMatrices *pencil);

/* weigh.c - masses of the nodes of each part, mass[parts][local nodes], kg, borrowed: they are weighed once; frees
   them */
PETSC_INTERN PetscErrorCode LabelsWeigh(Modes modes, const Mesh *mesh, PetscReal *const **mass);
PETSC_INTERN PetscErrorCode LabelsForgetWeights(Modes modes);

/* output/filter.c - filters.h5 and filters.xmf: modal filters of all modes but rigid ones */
PETSC_INTERN PetscErrorCode ModesWriteFilters(Modes modes, Model model, Results results);

/* relative: of what differs less the first one names a mode, for rounding tells which is larger */
#define LABEL_TIE 1e-6

/* superelement.c - y^T M_s x of superelement k, real and imaginary; x[1], y[1] NULL for zero, y[0] NULL for y =
   conj(x). Collective */
PETSC_INTERN PetscErrorCode LabelsShareSuperelement(Modes modes, Operators operators, PetscInt k, const Vec x[2],
                                                    const Vec y[2], PetscReal share[2]);
/* label_percent of what is named after an unknown */
#define LABEL_UNKNOWN -1

/* label/unknown.c - names after the unknowns that move most */
PETSC_INTERN PetscErrorCode ModesLabelUnknowns(Modes modes);

/* twins.c - of the zeros of a damped system at most one for each rigid mode; trims the list to the modes asked for */
PETSC_INTERN PetscErrorCode TwinsDrop(Modes modes, const Window *window);
PETSC_INTERN PetscErrorCode TwinsTrim(Modes modes, const Window *window);

/* saved.c - keep in words what factors and the route of damping saved; and show them */
PETSC_INTERN PetscErrorCode SavedByFactors(Modes modes, const ShiftInvert *si);
PETSC_INTERN PetscErrorCode SavedByDamping(Modes modes, const PencilMatrices *pencil, const Window *window);
PETSC_INTERN PetscErrorCode SavedView(Modes modes, PetscViewer viewer);

/* rigid/vectors.c - lists a rigid mode of a damped system for each vector of the null space, first of all, and finds
   their vectors where those of the eigensolver are bad. Errors:
   PETSC_ERR_NOT_CONVERGED where K has no such vector */
PETSC_INTERN PetscErrorCode NullVectorsRefine(Modes modes, const PencilMatrices *damped, const Window *window);
/* n vectors x of the null space of K, or of K', M-orthonormal, by modes->null, which NullFactor makes where it is not
   there; error [n] is |K x| / (|K| |x|) */
PETSC_INTERN PetscErrorCode NullFactor(Modes modes, const PencilMatrices *pencil, const Window *window);
PETSC_INTERN PetscErrorCode NullIterate(Modes modes, const PencilMatrices *pencil, PetscBool transposed, PetscInt n,
                                        Vec x[], PetscReal error[]);

/* rigid/decays.c - decays of rigid motions without the rounding of K; whether eigenvalues may be some. Collective */
PETSC_INTERN PetscErrorCode NullDecaysCorrect(Modes modes, const PencilMatrices *damped, const Window *window);
PETSC_INTERN PetscBool      NullHasDecays(const Modes modes, const Window *window);
PETSC_INTERN PetscErrorCode NullForget(Modes modes); /* factors and vectors of the null space */

/* label.c - names of the shapes; the disc, NULL for none, and the masses of its nodes [local nodes] on this rank, kg
   (borrowed) */
PETSC_INTERN PetscErrorCode ModesLabel(Modes modes);
PETSC_INTERN PetscErrorCode ModesFindDisc(Modes modes, const struct _p_Disc **disc, const PetscReal **mass);
