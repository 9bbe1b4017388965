/*
   The path of solutions of v = free + [(1 - t) W kappa + t I] l from t = 1, where no pair feels another and the solution is
   the projection of -free on the cones, to t = 0. Solutions obey |l| <= |free| / least eigenvalue, whatever mu, since
   friction only takes: where W is definite the path cannot leave, and it ends at t = 0, after folds perhaps (a homotopy;
   E. L. Allgower, K. Georg, Introduction to Numerical Continuation Methods, 2003, ch. 2). It is followed by arclength in
   (l / |l|, x), t = 1 / (1 + exp(-x)), with Newton's method of newton.c on a system with one border more,

      [A       dv/dx] [dz]   [rhs           ]
      [t_l'P   t_x  ] [dx] = [-t . (y - y_p)]       y = (l, x), tangent (t_l, t_x), predicted y_p

   with dv/dx = t (l - v + free). At a kink, where statuses change, the tangent turns as the sign of this determinant
   says, which stays along a path. From time to time t = 0 is tried from where the path is. It ends after PATH_STEPS
   steps or with a step that is too short.
*/
#include "complianceimpl.h"

#define PATH_LARGE    10  /* times the largest row of W kappa: t / (1 - t) at the beginning */
#define PATH_STEPS    600 /* at most, failed ones too */
#define PATH_BEGIN    0.5 /* of arclength */
#define PATH_LONGEST  2.0
#define PATH_SHORTEST 1e-9
#define PATH_MAX_IT   10    /* of Newton in a step */
#define PATH_EASY     4     /* iterations after which the step grows */
#define PATH_RTOL     1e-9  /* of the natural map on the way */
#define PATH_TRY      0.5   /* t = 0 is tried after t / (1 - t) fell by this factor */
#define PATH_END      1e-14 /* t at which there is no way left */
#define PATH_TRY_IT   20    /* of Newton then */

/* A point and its tangent */
typedef struct {
  PetscReal *l, x;           /* accepted */
  PetscReal *ahead, x_ahead; /* predicted */
  PetscReal *tangent, t_x;   /* unit length */
  PetscReal  size;           /* |l| of the accepted point */
  PetscInt   sign;           /* of the determinant */
} CompliancePath;

/* t at x */
static PetscReal PathBlend(PetscReal x)
{
  return 1 / (1 + PetscExpReal(-x));
}

static PetscReal PathNorm(const ContactCompliance c, const PetscReal l[])
{
  PetscReal sum = 0;

  for (PetscInt i = 0; i < 3 * c->n; i++) sum += PetscSqr(l[i]);
  return PetscSqrtReal(sum);
}

/* Border of the system at l, v, x; returns t . (y - y_p) */
static PetscReal PathBorder(ContactCompliance c, const CompliancePath *path, PetscReal x)
{
  const PetscInt m = 3 * c->n_closed, rows = m + 1;
  PetscReal      ahead = path->t_x * (x - path->x_ahead);

  for (PetscInt k = 0; k < m; k++) {
    const PetscInt    p   = c->closed[k / 3];
    const CoulombLaw *law = &c->law[p];

    c->A[m * rows + k] = c->blend * (c->l[3 * p + k % 3] - c->v[3 * p + k % 3] + c->free[3 * p + k % 3]);
    c->A[k * rows + m] = 0;
    for (PetscInt i = 0; i < 3; i++)
      c->A[k * rows + m] += path->tangent[3 * p + i] * law->P[i][k % 3] / PetscSqr(path->size);
  }
  c->A[m * rows + m] = path->t_x;
  for (PetscInt i = 0; i < 3 * c->n; i++) ahead += path->tangent[i] * (c->l[i] - path->ahead[i]) / PetscSqr(path->size);
  return ahead;
}

/* Sign of the determinant of the factors, with the border */
static PetscInt PathSign(const ContactCompliance c)
{
  const PetscInt rows = 3 * c->n_closed + 1;
  PetscInt       sign = 1;

  for (PetscInt i = 0; i < rows; i++)
    if ((c->A[i * (rows + 1)] < 0) != (c->pivot[i] != i + 1)) sign = -sign;
  return sign;
}

/* Linearises and factors at the present l, v */
static PetscErrorCode PathFactor(ContactCompliance c, const CompliancePath *path, PetscReal x, PetscReal *ahead,
                                 PetscBool *singular)
{
  PetscFunctionBeginUser;
  ComplianceChoose(c);
  ComplianceLinearise(c);
  PetscCall(ComplianceAssemble(c, 1));
  *ahead = PathBorder(c, path, x);
  PetscCall(ComplianceFactor(c, 1, singular));
  PetscFunctionReturn(0);
}

/* Newton on the plane across the tangent from the predicted point; true where it converges not far from there */
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
  c->blend = PathBlend(*x);
  PetscCall(ComplianceMove(c));
  for (*it = 0; *it < PATH_MAX_IT && !good; (*it)++) {
    PetscCall(PathFactor(c, path, *x, &ahead, &singular));
    if (singular) break;
    c->rhs[3 * c->n_closed] = -ahead;
    PetscCall(ComplianceBackSolve(c, 1));
    ComplianceTake(c);
    *x += c->rhs[3 * c->n_closed];
    if (!(PetscAbsReal(*x - path->x) <= 2 * step)) break;
    c->blend = PathBlend(*x);
    PetscCall(ComplianceMove(c));
    ComplianceMeasure(c, &miss);
    c->report.iterations++;
    good = miss.largest <= PATH_RTOL * miss.scale + miss.noise ? PETSC_TRUE : PETSC_FALSE;
  }
  for (PetscInt i = 0; i < N; i++) square += PetscSqr((c->l[i] - path->ahead[i]) / path->size);
  if (!good || !(square + PetscSqr(*x - path->x_ahead) <= PetscSqr(step))) *it = PATH_MAX_IT + 1;
  PetscFunctionReturn(0);
}

/* Takes the present point, and the tangent there */
static PetscErrorCode PathAccept(ContactCompliance c, CompliancePath *path, PetscReal x)
{
  PetscReal ahead, length;
  PetscBool singular;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(path->l, c->l, 3 * c->n));
  path->x = x;
  PetscCall(PathFactor(c, path, x, &ahead, &singular));
  PetscCall(PetscArrayzero(c->rhs, 3 * c->n_closed));
  c->rhs[3 * c->n_closed] = 1;
  PetscCall(ComplianceBackSolve(c, 1));
  PetscCall(PetscArrayzero(c->l, 3 * c->n));
  ComplianceTake(c);
  PetscCall(PetscArraycpy(path->tangent, c->l, 3 * c->n));
  path->t_x  = c->rhs[3 * c->n_closed];
  path->size = PetscMax(PathNorm(c, path->l), PETSC_SQRT_MACHINE_EPSILON * path->size);
  length     = PetscSqrtReal(PetscSqr(path->t_x) + PetscSqr(PathNorm(c, path->tangent) / path->size));
  if (!path->sign) path->sign = PathSign(c);
  if (PathSign(c) != path->sign) length = -length;
  for (PetscInt i = 0; i < 3 * c->n; i++) path->tangent[i] /= length;
  path->t_x /= length;
  PetscFunctionReturn(0);
}

/* The solution at t near 1, and the tangent towards smaller ones */
static PetscErrorCode PathBegin(ContactCompliance c, CompliancePath *path, PetscBool *begun)
{
  const PetscInt N     = 3 * c->n;
  PetscReal      large = 0, x;
  ComplianceMiss miss;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < N; i++) {
    PetscReal row = 0;

    for (PetscInt j = 0; j < N; j++) row += PetscAbsReal(c->W[i * N + j]);
    large = PetscMax(large, row * c->kappa[i / 3]);
  }
  x        = PetscLogReal(PATH_LARGE * PetscMax(1, large));
  c->blend = PathBlend(x);
  for (PetscInt i = 0; i < N; i++) c->l[i] = i % 3 ? 0 : PetscMax(0, -c->free[i]);
  PetscCall(ComplianceIterate(c, PETSC_FALSE, PATH_TRY_IT, &miss));
  *begun     = ComplianceIsSolved(c, &miss);
  path->t_x  = -1;
  path->sign = 0;
  path->size = PathNorm(c, c->l);
  if (path->size == 0) *begun = PETSC_FALSE;
  if (*begun) PetscCall(PathAccept(c, path, x));
  PetscFunctionReturn(0);
}

/* t = 0 from the present point of the path */
static PetscErrorCode PathTry(ContactCompliance c, const CompliancePath *path, ComplianceMiss *miss)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < 3 * c->n; i++) c->l[i] = (1 - PathBlend(path->x)) * path->l[i];
  c->blend = 0;
  PetscCall(ComplianceIterate(c, PETSC_FALSE, PATH_TRY_IT, miss));
  PetscFunctionReturn(0);
}

/* Along the path until t = 0 is reached */
static PetscErrorCode PathWalk(ContactCompliance c, CompliancePath *path, ComplianceMiss *miss)
{
  PetscReal step = PATH_BEGIN, tried = path->x, x;
  PetscInt  it;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < PATH_STEPS && step > PATH_SHORTEST && path->x > PetscLogReal(PATH_END); k++) {
    for (PetscInt i = 0; i < 3 * c->n; i++) path->ahead[i] = path->l[i] + step * path->tangent[i];
    path->x_ahead = path->x + step * path->t_x;
    PetscCall(PathCorrect(c, path, step, &x, &it));
    if (it > PATH_MAX_IT) {
      step /= 2;
      continue;
    }
    PetscCall(PathAccept(c, path, x));
    if (it <= PATH_EASY) step = PetscMin(PATH_LONGEST, 2 * step);
    if (path->x > tried + PetscLogReal(PATH_TRY)) continue;
    tried = path->x;
    PetscCall(PathTry(c, path, miss));
    if (ComplianceIsSolved(c, miss)) break;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ComplianceFollow(ContactCompliance c, ComplianceMiss *miss)
{
  CompliancePath path = {.x = 0};
  PetscReal     *before;
  ComplianceMiss best = *miss;
  PetscBool      begun;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc4(3 * c->n, &path.l, 3 * c->n, &path.ahead, 3 * c->n, &path.tangent, 3 * c->n, &before));
  PetscCall(PetscArraycpy(before, c->l, 3 * c->n));
  PetscCall(PathBegin(c, &path, &begun));
  if (begun) PetscCall(PathWalk(c, &path, miss));
  c->blend = 0;
  if (!begun || !ComplianceIsSolved(c, miss)) {
    PetscCall(PetscArraycpy(c->l, before, 3 * c->n));
    PetscCall(ComplianceMove(c));
    *miss = best;
  }
  PetscCall(PetscFree4(path.l, path.ahead, path.tangent, before));
  PetscFunctionReturn(0);
}
