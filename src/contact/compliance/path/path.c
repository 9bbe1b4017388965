/*
   The path of solutions of v = free + [(1 - t) W kappa + t I] l from t = 1, where no pair feels another and the
   solution is the projection of -free on the cones, to t = 0. Solutions obey |l| <= |free| / least eigenvalue, whatever
   mu, since friction only takes: where W is definite the path cannot leave, and it ends at t = 0, after folds perhaps
   (a homotopy; E. L. Allgower, K. Georg, Introduction to Numerical Continuation Methods, 2003, ch. 2). It is followed
   by arclength in (l / |l|, x), t = 1 / (1 + exp(-x)), with Newton's method of newton.c on a system with one border
   more,

      [A       dv/dx] [dz]   [rhs           ]
      [t_l'P   t_x  ] [dx] = [-t . (y - y_p)]       y = (l, x), tangent (t_l, t_x), predicted y_p

   with dv/dx = t (l - v + free). At a kink, where statuses change, the tangent turns as the sign of this determinant
   says, which stays along a path. From time to time t = 0 is tried from where the path is. It ends after PATH_STEPS
   steps, PATH_WORK, or with a step that is too short.

   Runs that need it: `steep` of tests/cases/transient_reduced.toml (mu 2.2, which ends at 3.2e-5 s without), and scenes
   of tests/unit/test_contact_compliance.c.
*/
#include "contact/compliance/complianceimpl.h"

#define PATH_LARGE    10   /* times the largest row of W kappa: t / (1 - t) at the beginning */
#define PATH_STEPS    600  /* at most, failed ones too */
#define PATH_WORK     5e12 /* cubes of unknowns factored: minutes */
#define PATH_BEGIN    0.5  /* of arclength */
#define PATH_LONGEST  2.0
#define PATH_SHORTEST 1e-9
#define PATH_KINK     1e-6  /* steps below it look for a turn */
#define PATH_BEYOND   8.0   /* steps beyond which the next piece is looked at */
#define PATH_SHARP    0.3   /* cosine of tangents that a step may turn by */
#define PATH_STRAIGHT 0.99  /* cosine of tangents that do not turn */
#define PATH_MAX_IT   10    /* of Newton in a step */
#define PATH_EASY     4     /* iterations after which the step grows */
#define PATH_RTOL     1e-9  /* of the natural map on the way */
#define PATH_TRY      0.5   /* t = 0 is tried after t / (1 - t) fell by this factor */
#define PATH_END      1e-14 /* t at which there is no way left */
#define PATH_PROXIMAL 1e-6  /* t of proximal points */
#define PATH_POLISH   20    /* proximal points at most */
#define PATH_TRY_IT   20    /* of Newton then */

/* Newton on the plane across the tangent from the predicted point. *it is the number of iterations, beyond
   PATH_MAX_IT where it does not converge within `step` of that point (in (l / |l|, x)): it may be on another piece of
   the path then. */
static PetscErrorCode PathCorrect(ContactCompliance c, const CompliancePath *path, PetscReal step, PetscReal *x,
                                  PetscInt *it)
{
  const PetscInt N = 3 * c->n;
  ComplianceMiss miss;
  PetscReal      ahead, square  = 0;
  PetscBool      singular, good = PETSC_FALSE;

  PetscFunctionBeginUser;
  *x = path->x_ahead;
  PetscCall(PetscArraycpy(c->l, path->ahead, N));
  c->blend = CompliancePathBlend(*x);
  PetscCall(ComplianceMove(c));
  for (*it = 0; *it < PATH_MAX_IT && !good; (*it)++) {
    PetscCall(CompliancePathFactor(c, path, *x, &ahead, &singular));
    if (singular) break;
    c->rhs[c->row[c->n_closed]] = -ahead;
    PetscCall(ComplianceBackSolve(c, c->row[c->n_closed] + 1, c->rhs));
    ComplianceTake(c);
    *x += c->rhs[c->row[c->n_closed]] / path->size;
    if (!(PetscAbsReal(*x - path->x) <= 2 * step)) break;
    c->blend = CompliancePathBlend(*x);
    PetscCall(ComplianceMove(c));
    ComplianceMeasure(c, &miss);
    c->report.iterations++;
    good = miss.largest <= PATH_RTOL * miss.scale + miss.noise ? PETSC_TRUE : PETSC_FALSE;
  }
  for (PetscInt i = 0; i < N; i++) square += PetscSqr((c->l[i] - path->ahead[i]) / path->size);
  if (!good || !(square + PetscSqr(*x - path->x_ahead) <= PetscSqr(step))) *it = PATH_MAX_IT + 1;
  PetscFunctionReturn(0);
}

/* Takes the point l, x, and the tangent there; not where that turns so much that the path may be another one */
static PetscErrorCode PathAccept(ContactCompliance c, CompliancePath *path, PetscReal x, CompliancePath *before,
                                 PetscBool *taken)
{
  PetscFunctionBeginUser;
  PetscCall(CompliancePathCopy(c, path, before));
  PetscCall(CompliancePathTangent(c, path, x));
  *taken = CompliancePathAlong(c, path, before) >= PATH_SHARP ? PETSC_TRUE : PETSC_FALSE;
  if (!*taken) PetscCall(CompliancePathCopy(c, before, path));
  PetscFunctionReturn(0);
}

/* At a kink, less than a few steps ahead, the path may turn back, and no plane across the old tangent meets it: the
   path goes on from there along the piece beyond the kink. True where that does not point ahead any more */
static PetscErrorCode PathTurn(ContactCompliance c, CompliancePath *path, PetscReal step, CompliancePath *before,
                               PetscBool *turned)
{
  PetscFunctionBeginUser;
  PetscCall(CompliancePathCopy(c, path, before));
  CompliancePathPredict(c, path, PATH_BEYOND * step);
  PetscCall(PetscArraycpy(c->l, path->ahead, 3 * c->n));
  c->blend = CompliancePathBlend(path->x_ahead);
  PetscCall(ComplianceMove(c));
  PetscCall(CompliancePathTangent(c, path, path->x_ahead));
  *turned = CompliancePathAlong(c, path, before) < PATH_STRAIGHT ? PETSC_TRUE : PETSC_FALSE;
  if (!*turned) PetscCall(CompliancePathCopy(c, before, path));
  PetscFunctionReturn(0);
}

/* The solution at t near 1, and the tangent towards smaller ones; where no pair carries there, as none penetrates
   without forces, that is a solution at t = 0 as well */
static PetscErrorCode PathBegin(ContactCompliance c, CompliancePath *path, ComplianceMiss *miss, PetscBool *begun)
{
  const PetscInt N     = 3 * c->n;
  PetscReal      large = 0, x;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < N; i++) {
    PetscReal row = 0;

    for (PetscInt j = 0; j < N; j++) row += PetscAbsReal(c->W[i * N + j]);
    large = PetscMax(large, row * c->kappa[i / 3]);
  }
  x        = PetscLogReal(PATH_LARGE * PetscMax(1, large));
  c->blend = CompliancePathBlend(x);
  for (PetscInt i = 0; i < N; i++) c->l[i] = i % 3 ? 0 : PetscMax(0, -c->free[i]);
  PetscCall(ComplianceIterate(c, PETSC_FALSE, PATH_TRY_IT, miss));
  *begun     = ComplianceIsSolved(c, miss);
  path->t_x  = -1;
  path->sign = 0;
  path->size = CompliancePathNorm(c, c->l);
  if (path->size == 0) {
    *begun   = PETSC_FALSE;
    c->blend = 0;
    PetscCall(ComplianceMove(c));
    ComplianceMeasure(c, miss);
  }
  if (!*begun) PetscFunctionReturn(0);
  PetscCall(CompliancePathTangent(c, path, x));
  PetscFunctionReturn(0);
}

/* t = 0 from the present point of the path */
static PetscErrorCode PathTry(ContactCompliance c, const CompliancePath *path, ComplianceMiss *miss)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < 3 * c->n; i++) c->l[i] = (1 - CompliancePathBlend(path->x)) * path->l[i];
  c->blend = 0;
  PetscCall(ComplianceIterate(c, PETSC_FALSE, PATH_TRY_IT, miss));
  PetscFunctionReturn(0);
}

/* Where W is singular, from the end of the path: proximal points, solutions of v = free + W kappa l + t (I - W kappa)(l
   - l before), each of which is as well-posed as the path, until l stays (R. T. Rockafellar, SIAM J. Control Optim. 14,
   1976, 877) */
static PetscErrorCode PathPolish(ContactCompliance c, PetscReal *free, ComplianceMiss *miss)
{
  const PetscInt N    = 3 * c->n;
  PetscReal      last = PETSC_MAX_REAL;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(free, c->free, N));
  for (PetscInt k = 0; k < PATH_POLISH && !ComplianceIsSolved(c, miss) && miss->largest < last; k++) {
    last = miss->largest;
    for (PetscInt i = 0; i < N; i++) c->free[i] = free[i] + PATH_PROXIMAL * (c->v[i] - free[i] - c->l[i]);
    c->blend = PATH_PROXIMAL;
    PetscCall(ComplianceIterate(c, PETSC_FALSE, PATH_TRY_IT, miss));
    PetscCall(PetscArraycpy(c->free, free, N));
    c->blend = 0;
    PetscCall(ComplianceMove(c));
    ComplianceMeasure(c, miss);
  }
  PetscFunctionReturn(0);
}

/* One step along the path, or less next time, or round a kink. The step doubles after an easy step, up to
   PATH_LONGEST, and halves after one that is not taken. `cost` adds the cube of the rows for each iteration, in
   proportion to the time of its factors. */
static PetscErrorCode PathAdvance(ContactCompliance c, CompliancePath *path, PetscReal *step, CompliancePath *before,
                                  PetscBool *taken)
{
  PetscReal x;
  PetscInt  it;
  PetscBool turned;

  PetscFunctionBeginUser;
  *taken = PETSC_FALSE;
  CompliancePathPredict(c, path, *step);
  PetscCall(PathCorrect(c, path, *step, &x, &it));
  path->cost += (PetscReal)(it + 1) * PetscPowReal((PetscReal)c->row[c->n_closed], 3);
  if (it <= PATH_MAX_IT) PetscCall(PathAccept(c, path, x, before, taken));
  if (*taken) {
    if (it <= PATH_EASY) *step = PetscMin(PATH_LONGEST, 2 * *step);
    PetscFunctionReturn(0);
  }
  *step /= 2;
  if (*step > PATH_KINK) PetscFunctionReturn(0);
  PetscCall(PathTurn(c, path, *step, before, &turned));
  if (turned) *step = 4 * PATH_KINK * PATH_BEYOND;
  PetscFunctionReturn(0);
}

/* Along the path until t = 0 is reached */
static PetscErrorCode PathWalk(ContactCompliance c, CompliancePath *path, CompliancePath *before, ComplianceMiss *miss)
{
  PetscReal step = PATH_BEGIN, tried = path->x;
  PetscBool taken;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < PATH_STEPS && step > PATH_SHORTEST && path->cost < PATH_WORK; k++) {
    PetscCall(PathAdvance(c, path, &step, before, &taken));
    if (!taken || path->x > tried + PetscLogReal(PATH_TRY)) continue;
    tried = path->x;
    PetscCall(PathTry(c, path, miss));
    if (!ComplianceIsSolved(c, miss) && CompliancePathBlend(tried) < PATH_PROXIMAL)
      PetscCall(PathPolish(c, before->l, miss));
    if (ComplianceIsSolved(c, miss) || CompliancePathBlend(tried) < PATH_END) break;
  }
  PetscFunctionReturn(0);
}

/* Where no solution at t = 0 is reached, forces and miss are those from before. */
PetscErrorCode ComplianceFollow(ContactCompliance c, ComplianceMiss *miss)
{
  CompliancePath path, before;
  PetscReal     *l;
  ComplianceMiss best = *miss;
  PetscBool      begun;

  PetscFunctionBeginUser;
  PetscCall(CompliancePathCreate(c, &path));
  PetscCall(CompliancePathCreate(c, &before));
  PetscCall(PetscMalloc1(3 * c->n, &l));
  PetscCall(PetscArraycpy(l, c->l, 3 * c->n));
  PetscCall(PathBegin(c, &path, miss, &begun));
  if (begun) PetscCall(PathWalk(c, &path, &before, miss));
  c->blend = 0;
  if (!ComplianceIsSolved(c, miss) || (!begun && path.size > 0)) {
    PetscCall(PetscArraycpy(c->l, l, 3 * c->n));
    PetscCall(ComplianceMove(c));
    *miss = best;
  }
  PetscCall(PetscFree(l));
  PetscCall(CompliancePathDestroy(&before));
  PetscCall(CompliancePathDestroy(&path));
  PetscFunctionReturn(0);
}
