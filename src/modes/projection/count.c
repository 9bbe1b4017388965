/*
   Whether modes of materials whose stiffness depends on the eigenvalue (laws.c) are missing among those that were
   found: none is where

      (1 / 2 pi i) int d log (det T(lambda) / prod_i (lambda - nu_i)) = N - N_nu

   about the window, N eigenvalues of T inside it and N_nu of the nu_i: those of T that were found, in place of the
   nearest eigenvalues of the problem with all laws held at the reference (basis/companion.c), and all others of that.
   What the held problem has beyond the window is near what T has there, however strong damping is, so that the
   quotient's phase turns little. (Beside viscous damping of the same loss at the reference, whose overdamped modes
   gather at -1 / beta, it turns by hundreds of rad.) Where damping is hysteretic alone the quotient is a constant: the
   held problem is T, and what LAPACK finds in the window is counted. The laws are analytic in the upper half plane
   (viscoelastic.h).
*/
#include "projection.h"

#define COUNT_LARGEST 0.5  /* rad that the phase may turn in a step of the contour */
#define COUNT_RATE    1    /* rad that it may turn in one at the rates of both ends */
#define COUNT_SPLITS  30   /* of a step of it */
#define COUNT_SIDE    16   /* steps of a side */
#define COUNT_POINTS  2000 /* at which the phase is found, and as many more of each mode: some hundreds do as a rule */
#define COUNT_EACH    50
#define COUNT_WORK    4e11 /* or points times size^3, half a minute: small problems may have more points */
#define COUNT_SMALL   20   /* size below which that is no matter */
#define COUNT_NEAR    0.01 /* of a step: over so much the rate of the phase is looked at */
#define COUNT_FLAT    0.1  /* omega over decay below which nothing is counted: a damping ratio of 0.995 */
#define COUNT_ALIKE   1e-6 /* relative distance from a target of modes that are copies of each other */

/* det T over the product of distances from the nu, on a contour */
typedef struct {
  DensePencil   pencil;
  PetscInt      n;      /* nu */
  PetscComplex *nu, *T; /* [n], [size * size] */
  PetscBLASInt *pivot;
  PetscInt      points; /* that may still be looked at */
  PetscReal     turned; /* rad, until now */
  PetscBool     lost;   /* the phase could not be followed */
} Contour;

/* All eigenvalues of the problem with laws held at the reference, [2 size] at most */
static PetscErrorCode HeldEigenvalues(const Projection *p, Contour *c)
{
  DenseFrozen  held;
  PetscComplex lambda;

  PetscFunctionBeginUser;
  PetscCall(DenseFrozenSolve(p->modes->comm, &c->pencil, PetscSqrtReal(PetscAbsReal(p->si.shift)), PETSC_FALSE, &held));
  for (PetscInt i = 0; i < held.N; i++) {
    if (!DenseFrozenLambda(&held, i, &lambda)) continue;
    c->nu[c->n++] = lambda;
    if (!held.damped) c->nu[c->n++] = -lambda;
  }
  PetscCall(DenseFrozenDestroy(&held));
  PetscFunctionReturn(0);
}

PetscBool ProjectionLawsAreHeld(const Projection *p)
{
  for (PetscInt l = 0; l < p->pencil->n_laws; l++)
    if (p->pencil->law[l].law.kind != VISCOELASTIC_HYSTERETIC) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Puts the modes that were found in the places of the nearest nu, none of them twice */
static PetscErrorCode ContourTake(Contour *c, const ProjectionModes *found)
{
  PetscBool *taken;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(c->n, &taken));
  for (PetscInt i = 0; i < found->n; i++) {
    PetscInt nearest = -1;

    for (PetscInt k = 0; k < c->n; k++)
      if (!taken[k] && (nearest < 0 || cabs(c->nu[k] - found->lambda[i]) < cabs(c->nu[nearest] - found->lambda[i])))
        nearest = k;
    if (nearest < 0) break;
    taken[nearest] = PETSC_TRUE;
    c->nu[nearest] = found->lambda[i];
  }
  PetscCall(PetscFree(taken));
  PetscFunctionReturn(0);
}

/* The phase of the quotient at lambda, rad, but for whole turns */
static PetscErrorCode ContourPhase(Contour *c, PetscComplex lambda, PetscReal *phase)
{
  const PetscInt n = c->pencil.n;
  PetscBool      singular;

  PetscFunctionBeginUser;
  c->points--;
  DensePencilEvaluate(&c->pencil, lambda, 0, n, c->T);
  PetscCall(DenseComplexFactor(n, c->T, c->pivot, &singular));
  *phase = 0;
  for (PetscInt i = 0; i < n; i++) *phase += carg(c->T[i * n + i]) + (c->pivot[i] != i + 1 ? PETSC_PI : 0);
  for (PetscInt i = 0; i < c->n; i++) *phase -= carg(lambda - c->nu[i]);
  PetscFunctionReturn(0);
}

/* Whether a step is no longer than its middle is away from any nu: a pair of these would turn the phase by as much as
   two turns unseen */
static PetscBool StepIsShort(const Contour *c, const PetscComplex lambda[2])
{
  const PetscComplex middle = (lambda[0] + lambda[1]) / 2;

  for (PetscInt i = 0; i < c->n; i++)
    if (cabs(lambda[1] - lambda[0]) > cabs(c->nu[i] - middle)) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Whether the rates of the phase at both ends of a step turn it by no more: an eigenvalue of T next to the edge, or a
   pair, turns it by whole turns between points that are far from it. Groups of real eigenvalues just beside the edge
   would stay unseen: ContourFloor() keeps the edge away from them */
static PetscErrorCode StepIsSlow(Contour *c, const PetscComplex lambda[2], const PetscReal phase[2], PetscBool *slow)
{
  PetscReal near;

  PetscFunctionBeginUser;
  *slow = PETSC_TRUE;
  for (int i = 0; i < 2 && *slow; i++) {
    PetscCall(ContourPhase(c, lambda[i] + COUNT_NEAR * (lambda[1 - i] - lambda[i]), &near));
    if (PetscAbsReal(remainder(near - phase[i], 2 * PETSC_PI)) > COUNT_NEAR * COUNT_RATE) *slow = PETSC_FALSE;
  }
  PetscFunctionReturn(0);
}

/* Least omega of what is counted beside sigma: real eigenvalues gather where a law relaxes, and friction and rounding
   make pairs of them, which hardly oscillate */
static PetscReal ContourFloor(const Projection *p, PetscReal sigma)
{
  return PetscMax(PetscMax(p->window->count ? 0 : p->window->edge[0], p->window->known.scale), -COUNT_FLAT * sigma);
}

/* Point i of 4 COUNT_SIDE, or between two, of the edge of the window, above its floor: of a rectangle, or of a circle
   about the target with radius d */
static PetscComplex ContourPoint(const Projection *p, PetscReal d, PetscReal i)
{
  const Window   *w = p->window;
  const PetscReal t = fmod(i, COUNT_SIDE) / COUNT_SIDE, g = w->growth, high = w->edge[1];
  const PetscReal angle = 2 * PETSC_PI * i / (4 * COUNT_SIDE), sigma = (2 * t - 1) * g;
  const PetscReal low[] = {PetscMin(high, ContourFloor(p, -g)), PetscMin(high, ContourFloor(p, g))};

  if (w->count) return CMPLX(d * cos(angle), PetscMax(ContourFloor(p, d * cos(angle)), w->target + d * sin(angle)));
  switch ((int)(i / COUNT_SIDE) % 4) {
  case 0:
    return CMPLX(sigma, PetscMin(high, ContourFloor(p, sigma)));
  case 1:
    return CMPLX(g, low[1] + t * (high - low[1]));
  case 2:
    return CMPLX(-sigma, high);
  default:
    return CMPLX(-g, high - t * (high - low[0]));
  }
}

/* Adds what the phase turns by between points i[0] and i[1], at which it is known. Steps are split on the edge itself:
   chords of a circle leave out a thousandth of it */
static PetscErrorCode ContourStep(const Projection *p, PetscReal d, Contour *c, const PetscReal i[2],
                                  const PetscReal phase[2], int splits)
{
  const PetscReal    turn = remainder(phase[1] - phase[0], 2 * PETSC_PI), middle = (i[0] + i[1]) / 2;
  const PetscComplex lambda[2] = {ContourPoint(p, d, i[0]), ContourPoint(p, d, i[1])};
  PetscReal          between;
  PetscBool          good = PetscAbsReal(turn) <= COUNT_LARGEST && StepIsShort(c, lambda) ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  if (c->points <= 0) PetscFunctionReturn(0);
  if (good && splits) PetscCall(StepIsSlow(c, lambda, phase, &good));
  if (good || !splits) {
    c->turned += turn;
    if (!splits) c->lost = PETSC_TRUE;
    PetscFunctionReturn(0);
  }
  PetscCall(ContourPhase(c, ContourPoint(p, d, middle), &between));
  PetscCall(ContourStep(p, d, c, (PetscReal[2]){i[0], middle}, (PetscReal[2]){phase[0], between}, splits - 1));
  PetscCall(ContourStep(p, d, c, (PetscReal[2]){middle, i[1]}, (PetscReal[2]){between, phase[1]}, splits - 1));
  PetscFunctionReturn(0);
}

/* Whether the contour is about lambda */
static PetscBool ContourHolds(const Projection *p, PetscReal d, PetscComplex lambda)
{
  const Window *w = p->window;

  if (cimag(lambda) <= ContourFloor(p, creal(lambda))) return PETSC_FALSE;
  if (w->count) return cabs(lambda - CMPLX(0, w->target)) < d ? PETSC_TRUE : PETSC_FALSE;
  return cimag(lambda) < w->edge[1] && PetscAbsReal(creal(lambda)) < w->growth ? PETSC_TRUE : PETSC_FALSE;
}

/* The radius of a circle just within the farthest of the modes nearest to a target and its copies: halfway to the next
   nearer one, but at most COUNT_ALIKE short of the nearest copy */
static PetscReal ContourRadius(const Projection *p, const ProjectionModes *found)
{
  PetscReal d = 0, copy, nearer = 0;

  for (PetscInt i = 0; i < found->n; i++) d = PetscMax(d, cabs(found->lambda[i] - CMPLX(0, p->window->target)));
  copy = d;
  for (PetscInt i = 0; i < found->n; i++) {
    const PetscReal own = cabs(found->lambda[i] - CMPLX(0, p->window->target));

    if (own < d * (1 - COUNT_ALIKE))
      nearer = PetscMax(nearer, own);
    else
      copy = PetscMin(copy, own);
  }
  return PetscMax(copy * (1 - COUNT_ALIKE), (copy + nearer) / 2);
}

/* What the phase turns by about the window */
static PetscErrorCode ContourFollow(const Projection *p, PetscReal d, Contour *c)
{
  PetscReal phase[2];

  PetscFunctionBeginUser;
  PetscCall(ContourPhase(c, ContourPoint(p, d, 0), &phase[0]));
  for (int i = 0; i < 4 * COUNT_SIDE && c->points > 0; i++, phase[0] = phase[1]) {
    PetscCall(ContourPhase(c, ContourPoint(p, d, i + 1), &phase[1]));
    PetscCall(ContourStep(p, d, c, (PetscReal[2]){i, i + 1}, phase, COUNT_SPLITS));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionLawsCount(const Projection *p, const ProjectionModes *found, PetscInt *missing,
                                   PetscBool *lost, PetscBool *endless)
{
  const PetscReal d      = ContourRadius(p, found);
  Contour         c      = {.pencil = SubspacePencil(&p->space)};
  const PetscInt  n      = c.pencil.n;
  PetscInt        inside = 0;

  PetscFunctionBeginUser;
  c.points =
    COUNT_EACH * found->n + (PetscInt)PetscMax(COUNT_POINTS, COUNT_WORK / PetscPowReal(PetscMax(n, COUNT_SMALL), 3));
  PetscCall(PetscMalloc3(2 * n, &c.nu, n * n, &c.T, n, &c.pivot));
  PetscCall(HeldEigenvalues(p, &c));
  PetscCall(ContourTake(&c, found));
  if (!ProjectionLawsAreHeld(p)) PetscCall(ContourFollow(p, d, &c));
  for (PetscInt i = 0; i < c.n; i++) inside += ContourHolds(p, d, c.nu[i]);
  for (PetscInt i = 0; i < found->n; i++) inside -= ContourHolds(p, d, found->lambda[i]);
  *endless = c.points > 0 ? PETSC_FALSE : PETSC_TRUE;
  *missing = (PetscInt)round(c.turned / (2 * PETSC_PI)) + inside;
  PetscCall(PetscFree3(c.nu, c.T, c.pivot));
  *lost = c.lost;
  PetscCallMPI(MPI_Bcast(missing, 1, MPIU_INT, 0, p->modes->comm));
  PetscCallMPI(MPI_Bcast(lost, 1, MPIU_BOOL, 0, p->modes->comm));
  PetscCallMPI(MPI_Bcast(endless, 1, MPIU_BOOL, 0, p->modes->comm));
  PetscCall(PetscInfo(p->space.V,
                      "%" PetscInt_FMT " modes beside those found, turns %.6f, %" PetscInt_FMT " points left\n",
                      *missing, (double)(c.turned / (2 * PETSC_PI)), c.points));
  PetscFunctionReturn(0);
}
