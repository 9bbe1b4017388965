/*
   What an impulse of 1 N s at rest does, h(t) in m/(N s), by the modes of the window:

      h(t) = sum_k w Re(r_k e^(lambda_k t)),   r_k = (l^T x_k) (y_k^T f) / (2 lambda_k p_k),
      p_k  = y_k^T (M + C / (2 lambda_k)) x_k,

   w = 2 where omega > 0, for the conjugate, else 1. A mode with omega = 0 of a system without damping stands for
   -lambda as well: r (e^(lambda t) - e^(-lambda t)). The rigid modes X, Y, whose left vectors need not match the
   right ones one by one, move on together, X (Y^T M X)^-1 Y^T f t; where dampers to the ground hold them they come
   to rest at X (Y^T C X)^-1 Y^T f, and the eigenvalues that bring them there are modes of their own.
*/
#include "frfimpl.h"
#include "base/algebra/dense.h"

#define MOST_PHASE 4e12 /* omega t, rad: rounding of omega turns a larger one by 1e-3 and more */
/* sigma t: e^-37 is 1e-16, what is left is below rounding. */
#define DECAYED -37
/* Of |C| / |M|: less damping of the rigid modes is what their vectors err by. Also the least pivot by which all of
   them are held. */
#define HELD 1e-8

/* One mode that is not rigid */
typedef struct {
  Vec          xr, xi;
  PetscComplex lambda, input; /* rad/s; y^T f / p, N/kg */
  PetscBool    twofold;       /* -lambda belongs to it too */
} ModeMotion;

/* What the mode does at t in an output where its shape is x, m/(N s). Twofold: Re(x input) sinh(lambda t) / lambda,
   without the difference of nearly equal exponentials. */
static PetscReal ModeMotionAt(const ModeMotion *m, PetscComplex x, PetscReal t)
{
  if (m->twofold) return creal(x * m->input) * PetscSinhReal(creal(m->lambda) * t) / creal(m->lambda);
  return (cimag(m->lambda) > 0 ? 2 : 1) * creal(x * m->input / (2 * m->lambda) * cexp(m->lambda * t));
}

/* Raises an error for a time at which the mode still moves, but rounding alone says where it is */
static PetscErrorCode ModeMotionCheck(Frf frf, const ModeMotion *m)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < frf->n_times; i++)
    PetscCheck(
      cimag(m->lambda) * frf->time[i] <= MOST_PHASE || creal(m->lambda) * frf->time[i] < DECAYED, frf->comm,
      PETSC_ERR_USER_INPUT, "-frf_times: %.6g s is beyond %.6g s, where the phase of the mode at %.6g Hz is rounding",
      (double)frf->time[i], (double)(MOST_PHASE / cimag(m->lambda)), (double)(cimag(m->lambda) / (2 * PETSC_PI)));
  PetscFunctionReturn(0);
}

/* Adds one mode to h */
static PetscErrorCode ModeMotionAdd(Frf frf, const ModeMotion *motion)
{
  PetscFunctionBeginUser;
  PetscCall(ModeMotionCheck(frf, motion));
  for (PetscInt p = 0; p < frf->n_outputs; p++) {
    PetscComplex x;

    PetscCall(FrfDot(frf->l[p], motion->xr, motion->xi, &x));
    for (PetscInt i = 0; i < frf->n_times; i++) {
      PetscReal *h = &frf->impulse[i * frf->n_outputs + p];

      *h += ModeMotionAt(motion, x, frf->time[i]);
      PetscCheck(isfinite(*h), frf->comm, PETSC_ERR_USER_INPUT,
                 "-frf_times: a mode grows by %.6g 1/s, until %.6g s beyond all numbers; end before",
                 (double)creal(motion->lambda), (double)frf->time[i]);
    }
  }
  PetscFunctionReturn(0);
}

/* The rigid modes: vectors of modes of the solver (borrowed) */
typedef struct {
  PetscInt n;
  Vec     *x, *y; /* [n] */
} RigidModes;

static PetscErrorCode RigidModesFind(Frf frf, RigidModes *rigid)
{
  const Mode *mode;
  PetscInt    n;
  Vec         xi, yi;

  PetscFunctionBeginUser;
  PetscCall(ModesGet(frf->modes, &n, &mode));
  rigid->n = 0;
  PetscCall(PetscMalloc2(n, &rigid->x, n, &rigid->y));
  for (PetscInt k = 0; k < n; k++) {
    if (!mode[k].rigid) continue;
    PetscCall(ModesGetVectors(frf->modes, k, &rigid->x[rigid->n], &xi, &rigid->y[rigid->n], &yi));
    rigid->n++;
  }
  PetscFunctionReturn(0);
}

/* Y^T A X, column-major [n][n], and its largest entry */
static PetscErrorCode RigidModesForm(const RigidModes *rigid, Mat A, PetscReal form[], PetscReal *largest)
{
  Vec Ax;

  PetscFunctionBeginUser;
  *largest = 0;
  PetscCall(VecDuplicate(rigid->x[0], &Ax));
  for (PetscInt j = 0; j < rigid->n; j++) {
    PetscCall(MatMult(A, rigid->x[j], Ax));
    PetscCall(VecMDot(Ax, rigid->n, rigid->y, &form[j * rigid->n]));
    for (PetscInt i = 0; i < rigid->n; i++) *largest = PetscMax(*largest, PetscAbsReal(form[j * rigid->n + i]));
  }
  PetscCall(VecDestroy(&Ax));
  PetscFunctionReturn(0);
}

/* Whether damping holds the rigid modes: their largest y^T C x over that of M, beside |C| / |M| (Frobenius); form
   becomes Y^T C X (kg/s) if so, else Y^T M X (kg), each times the scale of the vectors squared. */
static PetscErrorCode RigidModesHeld(const RigidModes *rigid, const PencilParts *parts, PetscReal form[],
                                     PetscBool *held)
{
  PetscReal damping, mass, norm[2];

  PetscFunctionBeginUser;
  *held = PETSC_FALSE;
  PetscCall(RigidModesForm(rigid, parts->M, form, &mass));
  if (!parts->C) PetscFunctionReturn(0);
  PetscCall(MatNorm(parts->C, NORM_FROBENIUS, &norm[0]));
  PetscCall(MatNorm(parts->M, NORM_FROBENIUS, &norm[1]));
  PetscCall(RigidModesForm(rigid, parts->C, form, &damping));
  *held = damping * norm[1] > HELD * mass * norm[0] ? PETSC_TRUE : PETSC_FALSE;
  if (!*held) PetscCall(RigidModesForm(rigid, parts->M, form, &mass));
  PetscFunctionReturn(0);
}

/* Solves with the n x n matrix A (overwritten) in place */
static PetscErrorCode RigidModesSolve(MPI_Comm comm, PetscInt n, PetscReal A[], PetscReal b[])
{
  PetscInt rank;

  PetscFunctionBeginUser;
  PetscCall(DenseLeast(n, n, A, b, HELD, &rank));
  PetscCheck(rank == n, comm, PETSC_ERR_USER_INPUT,
             "-frf_times: damping holds some of the %" PetscInt_FMT " rigid modes and others not; hold all, or none",
             n);
  PetscFunctionReturn(0);
}

/* Adds the rigid modes to h */
static PetscErrorCode RigidModesAdd(Frf frf, const PencilParts *parts)
{
  RigidModes rigid;
  PetscReal *form, *q, *x;
  PetscBool  held;

  PetscFunctionBeginUser;
  PetscCall(RigidModesFind(frf, &rigid));
  PetscCall(PetscMalloc3(rigid.n * rigid.n, &form, rigid.n, &q, rigid.n, &x));
  if (rigid.n) {
    PetscCall(RigidModesHeld(&rigid, parts, form, &held));
    PetscCall(VecMDot(frf->f, rigid.n, rigid.y, q));
    PetscCall(RigidModesSolve(frf->comm, rigid.n, form, q));
    for (PetscInt p = 0; p < frf->n_outputs; p++) {
      PetscReal sum = 0;

      PetscCall(VecMDot(frf->l[p], rigid.n, rigid.x, x));
      for (PetscInt k = 0; k < rigid.n; k++) sum += x[k] * q[k];
      for (PetscInt i = 0; i < frf->n_times; i++)
        frf->impulse[i * frf->n_outputs + p] += sum * (held ? 1 : frf->time[i]);
    }
  }
  PetscCall(PetscFree3(form, q, x));
  PetscCall(PetscFree2(rigid.x, rigid.y));
  PetscFunctionReturn(0);
}

/* impulse [n_times][n_outputs], m/(N s). p = y^T D x of the solver for each mode, with the lengths that its vectors
   have. */
PetscErrorCode FrfSolveImpulse(Frf frf)
{
  PencilParts parts;
  const Mode *mode;
  PetscInt    n;

  PetscFunctionBeginUser;
  PetscCall(PencilGetParts(frf->pencil, &parts));
  PetscCall(ModesGet(frf->modes, &n, &mode));
  PetscCall(PetscCalloc1(frf->n_times * frf->n_outputs, &frf->impulse));
  PetscCall(RigidModesAdd(frf, &parts));
  for (PetscInt k = 0; k < n; k++) {
    ModeMotion motion = {.lambda = CMPLX(mode[k].sigma, mode[k].omega), .twofold = !parts.C && mode[k].omega == 0};
    Vec        yr, yi;

    if (mode[k].rigid) continue;
    PetscCall(ModesGetVectors(frf->modes, k, &motion.xr, &motion.xi, &yr, &yi));
    PetscCall(FrfDot(frf->f, yr, yi, &motion.input));
    motion.input /= CMPLX(mode[k].product[0], mode[k].product[1]);
    PetscCall(ModeMotionAdd(frf, &motion));
  }
  PetscFunctionReturn(0);
}
