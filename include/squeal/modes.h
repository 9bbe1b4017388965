/*
   Modes - eigenvalues lambda = sigma + i omega (rad/s) of (lambda^2 M + lambda C + K) x = 0 with their right and left
   vectors:

      undamped symmetric   K x = kappa M x, kappa = -lambda^2          EPS GHEP,  LDL' of K - s M
      undamped, friction   the same, K unsymmetric                     EPS GNHEP, LU, or LDL' and an update
      weakly damped        its projection on undamped modes            corrections with the factors of K - s M
      damped               the quadratic problem                       PEP TOAR,  LU of K + s C + s^2 M

   Left vectors solve the transposed problem with the transposed factors, from a start vector of their own; what one
   of the two Krylov spaces misses inside the window shows in the other. Eigenvalues outside the window, |sigma| >
   -modes_growth, are listed where they are found, by sweeps too, and are no part of the claim.
*/
#pragma once

#include <squeal/quantity.h>
#include <squeal/pencil.h>
#include <squeal/results.h>
#include <squeal/sound.h>

typedef struct _p_Modes *Modes;
struct ShiftInvert; /* factors, private to the solvers */

/* Growth beyond its error, and beyond the limit of what counts as unstable; neutral: the first alone */
typedef enum { MODE_STABLE, MODE_NEUTRAL, MODE_UNSTABLE } ModeState;

/* Growth up to the larger of ratio |lambda| and growth, 1/s, is no instability; ratio: a damping ratio */
typedef struct {
  PetscReal ratio, growth;
} ModesLimit;

#define MODES_TINY 1e-9 /* of |lambda|: growth below it is rounding */

/*@ ModesLimitGrowth - the limit of an eigenvalue of that size |lambda|, 1/s. Not collective. @*/
PetscReal ModesLimitGrowth(const ModesLimit *limit, PetscReal size);

/*@ ModesLimitIsExceeded - whether growth sigma of sigma + i omega (rad/s) exceeds its error and the limit. Not
    collective. @*/
PetscBool ModesLimitIsExceeded(const ModesLimit *limit, PetscReal sigma, PetscReal omega, PetscReal error);

/*@ ModesLimitInForce - the limit, or where none is given that of what is neutral all the same: a damping ratio of 1e-5.
    Not collective. @*/
ModesLimit ModesLimitInForce(const ModesLimit *limit);

/*@ ModesLimitJudge - the state of an eigenvalue sigma + i omega, rad/s, with that error; without a limit growth within
    a damping ratio of 1e-5 is neutral. Not collective. @*/
ModeState ModesLimitJudge(const ModesLimit *limit, PetscReal sigma, PetscReal omega, PetscReal error);

/*@ ModeStateName - stable, neutral or unstable, as tables have it. Not collective. @*/
const char *ModeStateName(ModeState state);

/* One eigenvalue of the upper half plane (omega >= 0) and its errors */
typedef struct {
  PetscReal sigma, omega;   /* rad/s; sigma > 0 is unstable */
  PetscReal backward_error; /* |Q(lambda) x| / ((|lambda|^2 |M| + |lambda| |C| + |K|) |x|), Frobenius norms */
  PetscReal product[2]; /* real and imaginary part of y'(M + C / (2 lambda)) x of the vectors of ModesGetVectors() */
  PetscReal
    condition; /* 2 |lambda| |x|_M |y|_M / |y'(2 lambda M + C) x|: 1 for real modes, infinite at a defective pair */
  PetscReal
    error; /* first-order error of lambda from left and right vectors, |y'Q(lambda)x| / |y'Q'(lambda)x|, rad/s */
  ModeState state;    /* whether sigma exceeds its error, and the limit */
  PetscBool unstable; /* state is MODE_UNSTABLE */
  PetscBool rigid;    /* zero within its error */
  PetscBool slowing;  /* a rigid motion that damping slows down, a real eigenvalue */
  char      label[32];
} Mode;

/*@ ModesCreate - makes a solver. Collective. @*/
PetscErrorCode ModesCreate(MPI_Comm comm, Modes *modes);

/*@ ModesSetPencil - the system to solve, at the point that it has when ModesSolve() is called; it must stay until the
    modes are written or another pencil is set. Its reference frequency (PencilSetReference()) becomes the middle of the
    band, or the target, where it has none; ModesSolve() takes the middle of modes far above a target. Collective. @*/
PetscErrorCode ModesSetPencil(Modes modes, Pencil pencil);

/*@
   ModesSetFromOptions - reads what to compute. Collective.

   Options are the rows of src/modes/quantities.c.
   The solvers take -eps_*, -pep_*, -st_*.
@*/
PetscErrorCode ModesSetFromOptions(Modes modes);

/*@ ModesVisit - shows the rows of its options. Collective. @*/
PetscErrorCode ModesVisit(Modes modes, const QuantityVisitor *visitor);

/*@ ModesSetLoaded - whether the scene has contacts and something that loads them: -modes_contact auto is about the
    sliding state then; without this call it is not. Not collective. @*/
PetscErrorCode ModesSetLoaded(Modes modes, PetscBool loaded);

/*@ ModesGetContact - whether modes are about the pairs closed in the sliding state. Not collective. @*/
PetscErrorCode ModesGetContact(Modes modes, PetscBool *is_static);

/*@ ModesGetBand - the band of the options, Hz, and the largest growth that it covers, 1/s. Not collective.
    Errors: PETSC_ERR_USER_INPUT without -modes_band. @*/
PetscErrorCode ModesGetBand(Modes modes, PetscReal band[2], PetscReal *growth);

/*@ ModesGetLimit - what counts as unstable. Not collective. @*/
PetscErrorCode ModesGetLimit(Modes modes, ModesLimit *limit);

/*@ ModesHaveBand - whether the modes of a band are asked for, not those nearest to a target. Not collective. @*/
PetscErrorCode ModesHaveBand(Modes modes, PetscBool *has_band);

/*@ ModesGetRoutes - whether damped modes may be found by projection on undamped ones, and whether by PEP, as
    -modes_damping says. Not collective. @*/
PetscErrorCode ModesGetRoutes(Modes modes, PetscBool *may_project, PetscBool *may_pep);

/*@ ModesSetBand - another band, Hz. Not collective. @*/
PetscErrorCode ModesSetBand(Modes modes, const PetscReal band[2]);

/*@ ModesAllowNone - a band may have no mode, which is an error otherwise. Not collective. @*/
PetscErrorCode ModesAllowNone(Modes modes);

/*@ ModesWant - whether the options ask for the modes nearest to a frequency, and for left vectors. Not collective. @*/
PetscErrorCode ModesWant(Modes modes, PetscBool *nearest, PetscBool *left);

/*@ ModesKeepFactor - whether ModesSolve() keeps its factorisation until the next solution. Not collective. @*/
PetscErrorCode ModesKeepFactor(Modes modes, PetscBool keep);

/*@ ModesGetFactor - the factorisation that was kept (borrowed): of K - shift M, shift in (rad/s)^2, also where damped
    modes came from undamped ones; or of K + shift C + shift^2 M, in rad/s, where a damped solver made it. Not
    collective. Errors: PETSC_ERR_ARG_WRONGSTATE where none was kept. @*/
PetscErrorCode ModesGetFactor(Modes modes, const struct ShiftInvert **factor);

/*@ ModesSolve - computes eigenvalues, vectors, errors and labels, and checks that none is missing. Collective. @*/
PetscErrorCode ModesSolve(Modes modes);

/*@ ModesWantTerms - whether the options ask for what needs the terms of the pencil in the solution, as stiffness that
    depends on the frequency does about a target, or after it. Not collective. @*/
PetscErrorCode ModesWantTerms(Modes modes, PetscBool *wanted);

/*@ ModesPrepareComponents - finds the bodies of the pencil while its terms are there, as ModesFindComponents() needs
    them; keep_terms = -modes_components asks for a solution of its own, which needs the terms. Collective.
    Errors: PETSC_ERR_USER_INPUT for -modes_components with loaded matrices. @*/
PetscErrorCode ModesPrepareComponents(Modes modes, PetscBool *keep_terms);

/*@ ModesFindComponents - which free modes of the bodies make up each mode of the last solution, for ModesView() and
    ModesWrite(), and names by them; without -modes_components of the unstable modes, by Ritz vectors. Nothing where
    ModesPrepareComponents() found no bodies. Collective. @*/
PetscErrorCode ModesFindComponents(Modes modes);

/*@ ModesPlaceChanges - whether the options give changes to try on the modes; then finds their places, and has
    ModesSolve() keep its factorisation. Collective; after ModesSetPencil().
    Errors: PETSC_ERR_USER_INPUT for a place that is far from any node or held, and a direction that is missing. @*/
PetscErrorCode ModesPlaceChanges(Modes modes, PetscBool *wanted);

/*@ ModesFindChanges - the modes of the system with each change of -modes_changes, by itself or with another one as its
    -with says, for ModesView() and ModesWrite(): a mass, spring, dashpot or absorber is of low rank, and is solved on
    the modes of the last solution and on answers by the factorisation that it kept. The error of each is what the last
    of these answers have changed. Collective. @*/
PetscErrorCode ModesFindChanges(Modes modes);

/*@ ModesGet - the modes in order of frequency (borrowed). Not collective. @*/
PetscErrorCode ModesGet(Modes modes, PetscInt *n, const Mode **mode);

/*@ ModesGetVectors - right (xr + i xi) and left (yr + i yi) vectors of mode i in all unknowns, |x|_M = |y|_M = 1
    (borrowed; xi, yi are NULL for a real vector, yr for a mode without left vector). Not collective. @*/
PetscErrorCode ModesGetVectors(Modes modes, PetscInt i, Vec *xr, Vec *xi, Vec *yr, Vec *yi);

/* Shapes from elsewhere: right (xr + i xi) and left (yr + i yi) vectors */
typedef struct {
  PetscInt         n;
  const PetscBool *rigid;             /* whether the shape is a rigid mode */
  Vec             *xr, *xi, *yr, *yi; /* [n] vectors, length: unknowns of the pencil */
} ModesShapes;

/*@ ModesKeepFree - finds free modes of the bodies among n vectors in all unknowns, at the present point of the pencil,
    whose terms are there: ModesLabelShapes() names by them from now on. Nothing for matrices without a mesh, and with
    -modes_components_found false. Collective. @*/
PetscErrorCode ModesKeepFree(Modes modes, PetscInt n, const Vec vectors[]);

/*@ ModesLabelShapes - names for shapes from elsewhere, as in modes.csv, label[n]. Collective. @*/
PetscErrorCode ModesLabelShapes(Modes modes, const ModesShapes *shapes, char label[][32]);

/*@ ModesAddChecksum - adds which modes are asked for. Not collective. @*/
PetscErrorCode ModesAddChecksum(Modes modes, Checksum checksum);

/*@ ModesView - the table of modes for people. Collective. @*/
PetscErrorCode ModesView(Modes modes, PetscViewer viewer);

/*@ ModesSetSound - what microphones there are (referenced until ModesWrite()). Not collective. @*/
PetscErrorCode ModesSetSound(Modes modes, Sound sound);

/*@ ModesWrite - modes.csv, modes_causes.csv, modes_effects.csv, modes_components.csv, modes_changed.csv and the
    shapes. Collective. @*/
PetscErrorCode ModesWrite(Modes modes, Results results);

/*@ ModesDestroy - frees the solver. Collective. @*/
PetscErrorCode ModesDestroy(Modes *modes);
