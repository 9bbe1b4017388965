/* Private to modes/: a damped window by projection on undamped vectors; see project.c */
#pragma once

#include "modes/complexvec.h"
#include "basis/subspace.h"

#define PROJECTION_KEEP 1e-3 /* of the residual of a mode: less of it is left to the next round */

/* Undamped vectors of one side as real columns, a complex one as two, with C and M times them; or with C' and M' */
typedef struct {
  PetscInt   n;
  PetscInt  *mode; /* [n] whose column it is in the spectrum */
  BV         x, Cx, Mx;
  PetscReal *tolerance; /* what may remain of the columns of Cx, once they are what damping leaves of residuals */
} ModalBlock;

/* The basis with K, C and M on it, and what decides about it */
typedef struct {
  Modes                 modes;
  const PencilMatrices *pencil;
  const Window         *window;
  ShiftInvert           si;          /* of P = K - s M */
  PetscReal             alpha, beta; /* of the fit C = alpha M + beta K + R on the modes of the window */
  PetscReal             misfit;      /* root mean square of what it leaves of y'Cx / y'Mx, beside that of these */
  PetscBool             exact;       /* R = 0 */
  PetscReal             reach;       /* all undamped kappa with |kappa - s| below this are in V */
  PetscReal             norms[3];    /* of K, C, M, Frobenius */
  PetscReal             limit[2];    /* backward errors of settled right and left vectors */
  struct ComplexShift  *about;       /* factors at a complex shift, which take the place of those of P; or NULL */
  PetscReal             finer;       /* times the drop of corrections: less than 1 once all of them were dropped */
  Subspace              space;
} Projection;

/* Eigenvalues of the dense model that belong to the window, omega >= 0, with right and left vectors x' x = y' y = 1,
   turned so that x^T x is real and positive; and the backward errors of the vectors V x and V y */
typedef struct {
  PetscInt      n, size;
  PetscComplex *lambda;       /* [n] rad/s */
  PetscComplex *vectors[2];   /* [n][size] right and left, in coordinates of V */
  PetscReal    *backward[2];  /* [n], infinite before they are known */
  PetscReal     lambda_reach; /* largest |kappa(lambda) - s| on the edge of what the window claims */
} ProjectionModes;

/* kappa of the undamped problem that C = alpha M + beta K maps to lambda */
static inline PetscComplex ProjectionKappa(const Projection *p, PetscComplex lambda)
{
  return -(lambda * lambda + p->alpha * lambda) / (1 + p->beta * lambda);
}

/* K, C or M, or what is transposed; K without the friction of pairs then, where these are apart */
static inline Mat ProjectionMatrix(const Projection *p, int which, PetscBool transposed)
{
  const Mat matrix[] = {p->pencil->K, p->pencil->C, p->pencil->M};

  return transposed ? p->space.term[which].transposed : matrix[which];
}

/* projection/start.c - blocks of both spectra, without C' x and M' x of left ones as yet; of conjugate pairs of kappa
   one vector is enough */
PETSC_INTERN PetscErrorCode ModalBlocksCreate(const Projection *p, const Spectrum *right, const Spectrum *left,
                                              ModalBlock modal[2]);
PETSC_INTERN PetscErrorCode ModalBlocksDestroy(ModalBlock modal[2]);
/* In place of C x what damping of first order leaves of the residuals of vectors of the window, r of right and s of
   left ones; M x is destroyed */
PETSC_INTERN PetscErrorCode ModalBlocksReduce(const Projection *p, const Spectrum *right, const Spectrum *left,
                                              ModalBlock modal[2]);
/* Adds P^-1 r and P^-T s of them to the basis; they are overwritten */
PETSC_INTERN PetscErrorCode ProjectionStart(Projection *p, ModalBlock modal[2]);

/* projection/fit.c - alpha and beta */
PETSC_INTERN PetscErrorCode ProjectionFit(Projection *p, const Spectrum *right, const ModalBlock modal[2]);
/* projection/beyond.c - the measure of damping: the spectral radius of (K - s M)^-1 lambda R / (1 + beta lambda) on the
   complement of V, lambda in the window, estimated from a random block */
PETSC_INTERN PetscErrorCode ProjectionMeasureBeyond(const Projection *p, PetscReal *rho);
/* Adds to the basis what makes it large; the measure then */
PETSC_INTERN PetscErrorCode ProjectionEnlarge(Projection *p, PetscReal *rho);

/* projection/map.c - whether C = alpha M + beta K; the spectrum of the damped problem then, right or left */
PETSC_INTERN PetscErrorCode ProjectionIsExact(const Projection *p, const Spectrum *right, PetscBool *exact);
/* Whether an undamped mode is rigid: kappa is zero within rounding */
PETSC_INTERN PetscErrorCode ProjectionIsZero(const Projection *p, const Spectrum *s, PetscInt i, PetscBool *zero);
PETSC_INTERN PetscErrorCode ProjectionMap(const Projection *p, const Spectrum *from, Spectrum *to);

/* projection/dense.c - whether an eigenvalue belongs to the window: within its growth, or that of an undamped mode in
   it, or where V holds every mode */
PETSC_INTERN PetscBool ProjectionHas(const Projection *p, PetscComplex lambda);
/* Largest |kappa(lambda) - s| on the edge of the window's claim: |sigma| <= growth, low <= omega <= high; or, d away
   from a target */
PETSC_INTERN PetscReal ProjectionEdge(const Projection *p, PetscReal d);
PETSC_INTERN PetscReal ProjectionPole(const Projection *p);
/* The largest |lambda / (1 + beta lambda)| of the window, 1/s */
PETSC_INTERN PetscReal ProjectionLargestRatio(const Projection *p);
/* Leaves of the chosen eigenvalues, list [n], those asked for, which are nearest to the target, and `more`; *d =
   distance of the farthest left, PETSC_MAX_REAL where there are fewer than asked for */
PETSC_INTERN void ProjectionKeepNearest(const Window *window, PetscInt more, const PetscComplex lambda[],
                                        PetscInt list[], PetscInt *n, PetscReal *d);
/* Eigenvalues of the dense model in the window; with laws those of the problem that holds them that may come into it */
PETSC_INTERN PetscErrorCode ProjectionEigen(const Projection *p, ProjectionModes *modes);
PETSC_INTERN PetscErrorCode ProjectionModesDestroy(ProjectionModes *modes);
/* Room for n modes of the present basis; whether two of the modes are one and the same; those of rank 0 on all */
PETSC_INTERN PetscErrorCode ProjectionModesCreate(const Projection *p, PetscInt n, ProjectionModes *modes);
PETSC_INTERN PetscBool      ProjectionHasTwice(const ProjectionModes *modes);
PETSC_INTERN PetscErrorCode ProjectionModesShare(MPI_Comm comm, ProjectionModes *modes);

/* The modes on the basis that has grown since, each followed from what it was but for settled ones; followed = false
   where one is lost or found twice */
PETSC_INTERN PetscErrorCode ProjectionFollow(const Projection *p, const ProjectionModes *before, ProjectionModes *modes,
                                             PetscBool *followed);

/* projection/extend.c - adds P^-1 r of the right residuals and P^-T s of the left ones to the basis, as few as span
   them within the tolerances of their columns; either block may be NULL, they are overwritten. n_columns = how many,
   may be NULL */
PETSC_INTERN PetscErrorCode ProjectionExtend(Projection *p, BV residuals[2], PetscReal *const tolerance[2],
                                             PetscInt *n_columns);
/* projection/about.c - the same by factors p->about at a complex shift; columns of residuals are real and imaginary
   parts in turn, lambda [pairs] their eigenvalues. n_solves = how many */
PETSC_INTERN PetscErrorCode ProjectionExtendAbout(Projection *p, BV residuals[2], PetscReal *const tolerance[2],
                                                  PetscComplex *const lambda[2], PetscInt *n_solves);
/* Adds to the basis what steps of these factors towards lambda make of random vectors */
PETSC_INTERN PetscErrorCode ProjectionSearchAbout(Projection *p, PetscComplex lambda, unsigned long seed);
/* projection/strong.c - the modes of the window by such factors, in parts, from the undamped vectors in the basis; why
   is set where they do not settle. n_undamped: undamped modes of the window */
PETSC_INTERN PetscErrorCode ProjectionSolveStrong(Projection *p, PetscInt n_undamped, Window *window, const char **why);
/* projection/settle.c - corrects the modes until all have settled; settled = they have, and the window is covered */
PETSC_INTERN PetscErrorCode ProjectionIterate(Projection *p, ProjectionModes *found, PetscBool *settled);
/* The modes of the window in place of the spectra of the solver */
PETSC_INTERN PetscErrorCode ProjectionPut(Projection *p, const ProjectionModes *found);
/* projection/null.c - the left null vectors of K, for decays of rigid motions, where they are found so. The basis
   grows. */
PETSC_INTERN PetscErrorCode ProjectionFindNull(Projection *p);
/* projection/correct.c - backward errors of the modes that had not settled; adds P^-1 r, P^-T s of those above the
   limits to the basis: n_columns of them, 0 where all have settled */
PETSC_INTERN PetscErrorCode ProjectionCorrect(Projection *p, ProjectionModes *modes, PetscInt *n_columns);
/* projection/laws.c - the modes of the window of the nonlinear problem in place of those with its laws held that may
   become them */
PETSC_INTERN PetscErrorCode ProjectionLawsSolve(const Projection *p, ProjectionModes *modes);
/* projection/count.c - whether laws are the same at all lambda above the real axis */
PETSC_INTERN PetscBool ProjectionLawsAreHeld(const Projection *p);
/* How many eigenvalues the window of the dense nonlinear problem holds beside these, by the argument principle; lost =
   one lies on its edge, where that does not tell; endless = its phase takes too many points */
PETSC_INTERN PetscErrorCode ProjectionLawsCount(const Projection *p, const ProjectionModes *found, PetscInt *missing,
                                                PetscBool *lost, PetscBool *endless);
/* The vectors V x, or V y, as a spectrum */
PETSC_INTERN PetscErrorCode ProjectionLift(const Projection *p, const ProjectionModes *modes, PetscBool left,
                                           Spectrum *s);
