/*
   Materials whose stiffness depends on the eigenvalue: the dense problem

      T(lambda) x = (lambda^2 M + lambda C + K + sum_j h_j(lambda) A_j) x = 0,

   h zero at the reference frequency of the pencil. The eigenvalues of its quadratic part, which LAPACK has all, are
   followed by Newton's method (basis/follow.c), at once or as h grows from nothing. None is missing where

      (1 / 2 pi i) int d log (det T(lambda) / prod_i (lambda - nu_i)) = N - N_nu

   about the window, N eigenvalues of T inside it and N_nu of the nu_i: those of T that were found, in place of the
   eigenvalues of the quadratic part next to them, and all others of that. The quotient's phase is smooth. h is analytic
   in the upper half plane (viscoelastic.h); what does not oscillate is beyond, and not listed but for rigid modes. What
   the projection itself leaves out is the concern of projection/beyond.c.
*/
#include "projection.h"

#define LAWS_STAGES  4   /* of paths: 1, 4 and 16 steps of h, and as many about double eigenvalues */
#define LAWS_DETOUR  0.5 /* of h: how far these go, with both branches of a real problem then apart */
#define LAWS_STEPS   64
#define LAWS_LARGEST 0.5  /* rad that the phase may turn in a step of the contour */
#define LAWS_RATE    1    /* rad that it may turn in one at the rates of both ends */
#define LAWS_SPLITS  30   /* of a step of it */
#define LAWS_SIDE    16   /* steps of a side */
#define LAWS_POINTS  2000 /* at which the phase is found, and as many more of each mode: some hundreds do as a rule */
#define LAWS_EACH    50
#define LAWS_WORK    4e11 /* or points times size^3, half a minute: small problems may have more points */
#define LAWS_SMALL   20   /* size below which that is no matter */
#define LAWS_NEAR    0.01 /* of a step: over so much the rate of the phase is looked at */
#define LAWS_ALIKE   1e-6 /* relative distance from a target of modes that are copies of each other */

/* The pencil with a share of h in place of h, turned by the detour */
typedef struct {
  DensePencil pencil;
  PencilLaw  *law;
  DenseLaw   *dense;
} SharedLaws;

static PetscErrorCode SharedLawsCreate(const DensePencil *whole, PetscReal share, PetscReal detour, SharedLaws *s)
{
  PetscFunctionBeginUser;
  s->pencil = *whole;
  PetscCall(PetscMalloc2(whole->n_laws, &s->law, whole->n_laws, &s->dense));
  for (PetscInt l = 0; l < whole->n_laws; l++) {
    s->law[l] = *whole->law[l].law;
    s->law[l].scale *= share;
    s->law[l].detour = detour * (1 - share);
    s->dense[l]      = (DenseLaw){&s->law[l], whole->law[l].A};
  }
  s->pencil.law = s->dense;
  PetscFunctionReturn(0);
}

/* Whether a mode is rigid, which laws leave as it is */
static PetscBool LambdaIsRigid(const Projection *p, PetscComplex lambda)
{
  return p->window->known.rigid && cabs(lambda) <= p->window->known.scale ? PETSC_TRUE : PETSC_FALSE;
}

/* All modes by as many steps; good = none was lost, none came twice */
static PetscErrorCode LawsFollow(const Projection *p, int steps, PetscReal detour, ProjectionModes *m, PetscBool *good)
{
  const DensePencil whole = SubspacePencil(&p->space);

  PetscFunctionBeginUser;
  *good = PETSC_TRUE;
  for (int step = 1; step <= steps && *good; step++) {
    SharedLaws shared;

    PetscCall(SharedLawsCreate(&whole, (PetscReal)step / steps, detour, &shared));
    for (PetscInt i = 0; i < m->n && *good; i++) {
      if (LambdaIsRigid(p, m->lambda[i])) continue;
      PetscCall(DensePencilFollow(&shared.pencil, &m->lambda[i], &m->vectors[0][i * m->size],
                                  &m->vectors[1][i * m->size], good));
      if (!(cimag(m->lambda[i]) > 0)) *good = PETSC_FALSE;
    }
    PetscCall(PetscFree2(shared.law, shared.dense));
    if (*good && ProjectionHasTwice(m)) *good = PETSC_FALSE;
  }
  PetscCallMPI(MPI_Bcast(good, 1, MPIU_BOOL, 0, p->modes->comm));
  PetscFunctionReturn(0);
}

/* A copy of the modes, into room that is there */
static PetscErrorCode LawsCopy(const ProjectionModes *from, ProjectionModes *to)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(to->lambda, from->lambda, from->n));
  for (int side = 0; side < 2; side++) {
    PetscCall(PetscArraycpy(to->vectors[side], from->vectors[side], from->n * from->size));
    PetscCall(PetscArraycpy(to->backward[side], from->backward[side], from->n));
  }
  PetscFunctionReturn(0);
}

/* Leaves the modes that the window claims, of those nearest to a target as many as are asked for */
static PetscErrorCode LawsSelect(const Projection *p, ProjectionModes *m)
{
  PetscInt kept = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->n; i++) {
    if (!LambdaIsRigid(p, m->lambda[i]) && !ProjectionHas(p, m->lambda[i])) continue;
    m->lambda[kept] = m->lambda[i];
    for (int side = 0; side < 2; side++) {
      PetscCall(PetscArraymove(&m->vectors[side][kept * m->size], &m->vectors[side][i * m->size], m->size));
      m->backward[side][kept] = m->backward[side][i];
    }
    kept++;
  }
  m->n = kept;
  PetscFunctionReturn(0);
}

/* Where some are lost on every path: those that Newton's method finds from each by itself; the count says whether that
   is all */
static PetscErrorCode LawsGather(const Projection *p, ProjectionModes *m)
{
  const ProjectionModes all = *m;

  PetscFunctionBeginUser;
  m->n = 0;
  for (PetscInt i = 0; i < all.n; i++) {
    ProjectionModes one = {.n       = 1,
                           .size    = all.size,
                           .lambda  = &all.lambda[i],
                           .vectors = {&all.vectors[0][i * all.size], &all.vectors[1][i * all.size]}};
    PetscBool       good;

    PetscCall(LawsFollow(p, 1, 0, &one, &good));
    if (!good) continue;
    m->lambda[m->n] = all.lambda[i];
    for (int side = 0; side < 2; side++)
      PetscCall(PetscArraymove(&m->vectors[side][m->n * m->size], &m->vectors[side][i * m->size], m->size));
    m->n++;
    if (ProjectionHasTwice(m)) m->n--;
  }
  PetscCallMPI(MPI_Bcast(&m->n, 1, MPIU_INT, 0, p->modes->comm));
  PetscFunctionReturn(0);
}

/* Leaves the modes nearest to the target */
static PetscErrorCode LawsKeepNearest(const Projection *p, ProjectionModes *modes, PetscReal *d)
{
  ProjectionModes from = *modes;
  PetscInt        n    = from.n, *list;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &list));
  for (PetscInt i = 0; i < n; i++) list[i] = i;
  ProjectionKeepNearest(p->window, 0, from.lambda, list, &n, d);
  PetscCall(ProjectionModesCreate(p, n, modes));
  for (PetscInt i = 0; i < n; i++) {
    modes->lambda[i] = from.lambda[list[i]];
    for (int side = 0; side < 2; side++)
      PetscCall(
        PetscArraycpy(&modes->vectors[side][i * from.size], &from.vectors[side][list[i] * from.size], from.size));
  }
  PetscCall(ProjectionModesDestroy(&from));
  PetscCall(PetscFree(list));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionLawsSolve(const Projection *p, ProjectionModes *m)
{
  PetscReal       d    = 0;
  PetscBool       good = PETSC_FALSE;
  ProjectionModes start;

  PetscFunctionBeginUser;
  PetscCall(ProjectionModesCreate(p, m->n, &start));
  PetscCall(LawsCopy(m, &start));
  for (int stage = 0, steps = 1; stage < LAWS_STAGES && !good; stage++, steps = PetscMin(4 * steps, LAWS_STEPS)) {
    PetscCall(LawsCopy(&start, m));
    PetscCall(LawsFollow(p, steps, stage + 1 == LAWS_STAGES ? LAWS_DETOUR : 0, m, &good));
  }
  if (!good) PetscCall(LawsCopy(&start, m));
  if (!good) PetscCall(LawsGather(p, m));
  PetscCall(ProjectionModesDestroy(&start));
  PetscCall(ProjectionModesShare(p->modes->comm, m));
  PetscCall(LawsSelect(p, m));
  if (p->window->count) PetscCall(LawsKeepNearest(p, m, &d));
  m->lambda_reach = ProjectionEdge(p, d);
  PetscFunctionReturn(0);
}

/* det T over the product of distances from the nu, on a contour */
typedef struct {
  DensePencil   pencil;
  PetscInt      n;      /* nu */
  PetscComplex *nu, *T; /* [n], [size * size] */
  PetscBLASInt *pivot;
  PetscInt      points; /* that may still be looked at: strong damping turns the phase by hundreds of rad */
  PetscReal     turned; /* rad, until now */
  PetscBool     lost;   /* the phase could not be followed */
} Contour;

/* All eigenvalues of the quadratic part, [2 size] at most */
static PetscErrorCode QuadraticEigenvalues(const Projection *p, Contour *c)
{
  const PetscInt  size = c->pencil.n, N = 2 * size;
  const PetscReal shift = PetscSqrtReal(PetscAbsReal(p->si.shift));
  PetscReal      *P, *B, *w;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(size * size, &P, N * N, &B, 2 * N, &w));
  PetscCall(DenseCompanion(&c->pencil, (PetscReal[2]){shift, shift * shift}, P, c->pivot, B, NULL));
  PetscCall(DenseEigen(N, B, w, w + N, NULL, NULL));
  for (PetscInt i = 0; i < N; i++)
    if (w[i] != 0 || w[N + i] != 0) c->nu[c->n++] = shift * (1 + 1 / CMPLX(w[i], w[N + i]));
  PetscCall(PetscFree3(P, B, w));
  PetscFunctionReturn(0);
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

/* Whether the rates of the phase at both ends of a step turn it by no more: eigenvalues of T next to the edge, a pair
   or a cluster, turn it by whole turns between points that are far from them */
static PetscErrorCode StepIsSlow(Contour *c, const PetscComplex lambda[2], const PetscReal phase[2], PetscBool *slow)
{
  PetscReal near;

  PetscFunctionBeginUser;
  *slow = PETSC_TRUE;
  for (int i = 0; i < 2 && *slow; i++) {
    PetscCall(ContourPhase(c, lambda[i] + LAWS_NEAR * (lambda[1 - i] - lambda[i]), &near));
    if (PetscAbsReal(remainder(near - phase[i], 2 * PETSC_PI)) > LAWS_NEAR * LAWS_RATE) *slow = PETSC_FALSE;
  }
  PetscFunctionReturn(0);
}

/* Point i of 4 LAWS_SIDE, or between two, of the edge of the window, above the real axis: of a rectangle, or of a
   circle about the target with radius d */
static PetscComplex ContourPoint(const Projection *p, PetscReal d, PetscReal i)
{
  const Window   *w = p->window;
  const PetscReal t = fmod(i, LAWS_SIDE) / LAWS_SIDE, low = PetscMax(w->edge[0], w->known.scale), g = w->growth;
  const PetscReal angle = 2 * PETSC_PI * i / (4 * LAWS_SIDE);

  if (w->count) return CMPLX(d * cos(angle), PetscMax(low, w->target + d * sin(angle)));
  switch ((int)(i / LAWS_SIDE) % 4) {
  case 0:
    return CMPLX(-g + 2 * g * t, low);
  case 1:
    return CMPLX(g, low + t * (w->edge[1] - low));
  case 2:
    return CMPLX(g - 2 * g * t, w->edge[1]);
  default:
    return CMPLX(-g, w->edge[1] - t * (w->edge[1] - low));
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
  PetscBool          good = PetscAbsReal(turn) <= LAWS_LARGEST && StepIsShort(c, lambda) ? PETSC_TRUE : PETSC_FALSE;

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
  const Window   *w   = p->window;
  const PetscReal low = PetscMax(w->edge[0], w->known.scale);

  if (cimag(lambda) <= (w->count ? w->known.scale : low)) return PETSC_FALSE;
  if (w->count) return cabs(lambda - CMPLX(0, w->target)) < d ? PETSC_TRUE : PETSC_FALSE;
  return cimag(lambda) < w->edge[1] && PetscAbsReal(creal(lambda)) < w->growth ? PETSC_TRUE : PETSC_FALSE;
}

/* The radius of a circle just within the farthest of the modes nearest to a target and its copies: halfway to the next
   nearer one, but at most LAWS_ALIKE short of the nearest copy */
static PetscReal ContourRadius(const Projection *p, const ProjectionModes *found)
{
  PetscReal d = 0, copy, nearer = 0;

  for (PetscInt i = 0; i < found->n; i++) d = PetscMax(d, cabs(found->lambda[i] - CMPLX(0, p->window->target)));
  copy = d;
  for (PetscInt i = 0; i < found->n; i++) {
    const PetscReal own = cabs(found->lambda[i] - CMPLX(0, p->window->target));

    if (own < d * (1 - LAWS_ALIKE))
      nearer = PetscMax(nearer, own);
    else
      copy = PetscMin(copy, own);
  }
  return PetscMax(copy * (1 - LAWS_ALIKE), (copy + nearer) / 2);
}

PetscErrorCode ProjectionLawsCount(const Projection *p, const ProjectionModes *found, PetscInt *missing,
                                   PetscBool *lost, PetscBool *endless)
{
  const PetscReal d = ContourRadius(p, found);
  Contour         c = {.pencil = SubspacePencil(&p->space)};
  const PetscInt  n = c.pencil.n;
  PetscReal       phase[2];
  PetscInt        inside = 0;

  PetscFunctionBeginUser;
  c.points =
    LAWS_EACH * found->n + (PetscInt)PetscMax(LAWS_POINTS, LAWS_WORK / PetscPowReal(PetscMax(n, LAWS_SMALL), 3));
  PetscCall(PetscMalloc3(2 * n, &c.nu, n * n, &c.T, n, &c.pivot));
  PetscCall(QuadraticEigenvalues(p, &c));
  PetscCall(ContourTake(&c, found));
  PetscCall(ContourPhase(&c, ContourPoint(p, d, 0), &phase[0]));
  for (int i = 0; i < 4 * LAWS_SIDE && c.points > 0; i++, phase[0] = phase[1]) {
    PetscCall(ContourPhase(&c, ContourPoint(p, d, i + 1), &phase[1]));
    PetscCall(ContourStep(p, d, &c, (PetscReal[2]){i, i + 1}, phase, LAWS_SPLITS));
  }
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
