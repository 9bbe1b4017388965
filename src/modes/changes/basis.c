/*
   The space on which a changed system is solved: all modes of the system as it was, right and left ones, and how it
   answers to the change. A change adds c(lambda) a a' to Q(lambda), so that the new vectors obey

      Q(lambda) x = -c(lambda) (a'x) a,

   and are answers to forces along a at frequencies of the band: what its modes do not tell of them is spanned by few
   vectors that the modes' own factorisation finds (modes/space/answers.c).
*/
#include "changes.h"
#include <complex.h>

#define SPREAD_FEW   8    /* forces of layers and parameters that are answered in as many steps as those at nodes */
#define SPREAD_ALIKE 1e-6 /* of an amount: answers to terms whose amounts are in one ratio serve smaller ones too */
/* of the answers; what the last two change tells the error (dense.c). Where damping brings directions of its own each
   has about twice as many. */
#define CHANGE_STEPS        4
#define CHANGE_STEPS_DAMPED 3
#define CHANGE_KEEP         0.3 /* of what an answer leaves: smaller directions are left to the next step */
#define SPREAD_REPEATS      3
#define SPREAD_DROP         1e-3 /* of the longest force: how far each may be from what has been answered */
#define SPREAD_LOOSE        0.1  /* the same in repetitions where forces are many */

/* Coordinates of the right or left vectors of all modes, zeros where there are no left ones */
static PetscErrorCode SpaceKeepVectors(Modes modes, ChangeSpace *s, int left, PetscReal **coordinates)
{
  Vec *a, x[4], like;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(s->space.pencil.K, &like, NULL));
  PetscCall(VecDuplicateVecs(like, 2 * modes->n, &a));
  for (PetscInt i = 0; i < modes->n; i++) {
    PetscCall(ModesGetVectors(modes, i, &x[0], &x[1], &x[2], &x[3]));
    for (int part = 0; part < 2; part++)
      if (x[2 * left + part]) PetscCall(PencilRestrict(modes->pencil, x[2 * left + part], a[2 * i + part]));
  }
  PetscCall(ModesSpaceProducts(&s->space, 2 * modes->n, a, coordinates));
  PetscCall(VecDestroyVecs(2 * modes->n, &a));
  PetscCall(VecDestroy(&like));
  PetscFunctionReturn(0);
}

static PetscErrorCode SpaceKeepBefore(Modes modes, ChangeSpace *s)
{
  PetscFunctionBeginUser;
  s->n_before = modes->n;
  PetscCall(SpaceKeepVectors(modes, s, 0, &s->before));
  PetscCall(SpaceKeepVectors(modes, s, 1, &s->after));
  PetscCall(PetscMalloc2(modes->n, &s->length, modes->n, &s->lambda));
  for (PetscInt i = 0; i < modes->n; i++) {
    s->lambda[i] = CMPLX(modes->mode[i].sigma, modes->mode[i].omega);
    PetscCall(ChangeMeasureBefore(s, i, &s->length[i]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ChangeSpaceCreate(Modes modes, const ChangeRange *range, ChangeSpace *s)
{
  const ShiftInvert *factor;
  PencilMatrices     pencil;

  PetscFunctionBeginUser;
  *s = (ChangeSpace){.owner = modes->pencil};
  PetscCall(ModesGetFactor(modes, &factor));
  PetscCall(PencilGetMatrices(modes->pencil, &pencil));
  PetscCall(ModesSpaceCreate(&pencil, &s->space));
  s->answers              = (ModesAnswers){.space    = &s->space,
                                           .factor   = *factor,
                                           .edge     = {range->edge[0], range->edge[1]},
                                           .keep     = CHANGE_KEEP,
                                           .n_solves = &s->n_solves};
  s->answers.factor.after = NULL;
  PetscCall(ModesSpaceAddModes(&s->space, modes, modes->pencil, PETSC_FALSE));
  if (!pencil.symmetric) PetscCall(ModesSpaceAddModes(&s->space, modes, modes->pencil, PETSC_TRUE));
  s->n_modes = s->space.space.n;
  PetscCall(SpaceKeepBefore(modes, s));
  PetscFunctionReturn(0);
}

/* Leaves the modes alone */
static PetscErrorCode SpaceForget(ChangeSpace *s)
{
  PetscFunctionBeginUser;
  PetscCall(SubspaceTruncate(&s->space.space, s->n_modes));
  for (int i = 0; i < 2; i++) {
    for (PetscInt t = 0; t < s->n_terms; t++) PetscCall(PetscFree(s->side[i][t]));
    PetscCall(PetscFree(s->side[i]));
  }
  PetscCall(ChangeDestroyTerms(s->n_terms, &s->term));
  s->n_terms = 0;
  PetscFunctionReturn(0);
}

/* Whether two terms are of one kind: those of another amount at the same place; *ratio = of their amounts, which one
   for all that have matrices must have */
static PetscErrorCode TermsAreAlike(const ChangeTerm *a, const ChangeTerm *b, PetscReal *ratio, PetscBool *alike)
{
  const PetscReal from[] = {a->mass, a->viscosity, a->stiffness}, to[] = {b->mass, b->viscosity, b->stiffness};

  PetscFunctionBeginUser;
  *alike = PETSC_FALSE;
  if (!a->force != !b->force) PetscFunctionReturn(0);
  if (a->force) {
    PetscCall(VecEqual(a->force, b->force, alike));
    PetscFunctionReturn(0);
  }
  if (a->layer != b->layer || (a->A != b->A && !a->layer)) PetscFunctionReturn(0);
  if (a->A != b->A) PetscCall(MatEqual(a->A, b->A, alike));
  if (a->A != b->A && !*alike) PetscFunctionReturn(0);
  for (int k = 0; k < 3 && *ratio == 0; k++)
    if (from[k] != 0) *ratio = to[k] / from[k];
  *alike = PetscAbsReal(*ratio) <= 1 + SPREAD_ALIKE ? PETSC_TRUE : PETSC_FALSE; /* what repeats them is of that size */
  for (int k = 0; k < 3; k++)
    if (PetscAbsReal(to[k] - *ratio * from[k]) > SPREAD_ALIKE * PetscAbsReal(to[k])) *alike = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Whether the answers to the terms are there */
static PetscErrorCode SpaceAnswers(const ChangeSpace *s, PetscInt n, const ChangeTerm terms[], PetscBool *answers)
{
  PetscReal ratio = 0;

  PetscFunctionBeginUser;
  *answers = s->n_terms == n ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt j = 0; j < n && *answers; j++) PetscCall(TermsAreAlike(&s->term[j], &terms[j], &ratio, answers));
  PetscFunctionReturn(0);
}

static PetscErrorCode SpaceKeepTerms(ChangeSpace *s, PetscInt n, const ChangeTerm terms[])
{
  PetscFunctionBeginUser;
  s->n_terms = n;
  PetscCall(PetscMalloc1(n, &s->term));
  PetscCall(PetscArraycpy(s->term, terms, n));
  for (PetscInt j = 0; j < n; j++) {
    if (terms[j].force) PetscCall(PetscObjectReference((PetscObject)terms[j].force));
    if (terms[j].A) PetscCall(PetscObjectReference((PetscObject)terms[j].A));
  }
  for (int i = 0; i < 2; i++) PetscCall(PetscCalloc1(n, &s->side[i]));
  PetscFunctionReturn(0);
}

/* So many steps of answers to forces, behind what the space holds; first[] of the last two */
static PetscErrorCode SpaceStep(ChangeSpace *s, int steps, const ChangeForces forces[2])
{
  const PetscInt n[2] = {forces[0].n, s->space.pencil.symmetric ? 0 : forces[1].n};

  PetscFunctionBeginUser;
  if (n[0] + n[1] == 0) PetscFunctionReturn(0);
  s->answers.begun = PETSC_FALSE;
  for (int i = 0; i < 2; i++) {
    s->answers.n[i] = n[i];
    s->answers.b[i] = forces[i].force;
  }
  for (int step = 0; step < steps; step++) {
    s->first[0] = step ? s->first[1] : s->space.space.n;
    s->first[1] = s->space.space.n;
    PetscCall(ModesAnswersStep(&s->answers));
  }
  PetscFunctionReturn(0);
}

/* Forces at nodes in the equations of the pencil, Zl' a, or Zr' a of the left side, in front of others */
static PetscErrorCode SpaceTakeForces(const ChangeSpace *s, PetscBool left, ChangeForces *forces)
{
  Vec     *all, like;
  PetscInt m = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->n_terms + forces->n, &all));
  PetscCall(MatCreateVecs(s->space.pencil.K, &like, NULL));
  for (PetscInt t = 0; t < s->n_terms; t++) {
    if (!s->term[t].force) continue;
    PetscCall(VecDuplicate(like, &all[m]));
    PetscCall(PencilProjectForce(s->owner, left, s->term[t].force, all[m++]));
  }
  for (PetscInt j = 0; j < forces->n; j++) all[m++] = forces->force[j];
  PetscCall(PetscFree(forces->force));
  PetscCall(VecDestroy(&like));
  *forces = (ChangeForces){m, all};
  PetscFunctionReturn(0);
}

static PetscErrorCode ForcesDestroy(ChangeForces forces[2])
{
  PetscFunctionBeginUser;
  for (int i = 0; i < 2; i++) {
    for (PetscInt j = 0; j < forces[i].n; j++) PetscCall(VecDestroy(&forces[i].force[j]));
    PetscCall(PetscFree(forces[i].force));
  }
  PetscFunctionReturn(0);
}

/* Coordinates of the forces at nodes, and V' A V, in place of older ones */
static PetscErrorCode SpaceTakeSides(ChangeSpace *s, const ChangeForces forces[2])
{
  PetscFunctionBeginUser;
  for (PetscInt t = 0, k = 0; t < s->n_terms; t++) {
    if (!s->term[t].force) continue;
    for (int i = 0; i < 2; i++) {
      PetscCall(PetscFree(s->side[i][t]));
      PetscCall(ModesSpaceProducts(&s->space, 1, &forces[i].force[k], &s->side[i][t]));
    }
    k++;
  }
  PetscCall(ChangeSpaceProject(s));
  PetscFunctionReturn(0);
}

/* Those from number `from` on, as far as there are any */
static ChangeForces ForcesFrom(const ChangeForces *all, PetscInt from)
{
  return (ChangeForces){PetscMax(0, all->n - from), all->force + PetscMin(from, all->n)};
}

/* Moves forces to the end of a list */
static PetscErrorCode ForcesAppend(ChangeForces *more, ChangeForces *list)
{
  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)(list->n + more->n + 1) * sizeof(Vec), &list->force));
  for (PetscInt j = 0; j < more->n; j++) list->force[list->n++] = more->force[j];
  PetscCall(PetscFree(more->force));
  PetscFunctionReturn(0);
}

/* A step with what the modes of the changed system exert beyond the forces that have been answered, to which they are
   added; those from `nodes` on are orthonormal. The error counts it as the last step; *more = there were any */
static PetscErrorCode SpaceRepeat(ChangeSpace *s, const ChangeRange *range, PetscInt nodes, PetscReal drop,
                                  ChangeForces forces[2], PetscBool *more)
{
  const PetscInt first = s->first[1];
  ChangeVectors  v[2];
  ChangeForces   fresh[2];

  PetscFunctionBeginUser;
  PetscCall(SpaceTakeSides(s, forces));
  PetscCall(ChangeSolveVectors(s, range, v));
  for (int i = 0; i < 2; i++) {
    const ChangeForces known = ForcesFrom(&forces[i], nodes);

    PetscCall(ChangeSpaceForces(s, &v[i], &known, drop, &fresh[i]));
  }
  *more = fresh[0].n + fresh[1].n ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(SpaceStep(s, 1, fresh));
  if (*more) s->first[0] = first;
  for (int i = 0; i < 2; i++) {
    PetscCall(ForcesAppend(&fresh[i], &forces[i]));
    PetscCall(PetscFree(v[i].x));
  }
  PetscCall(PetscFree(v[0].lambda));
  PetscFunctionReturn(0);
}

/* Answers to forces at nodes in all steps, to few others in one less; to many in one step of their own, all of
   which the error counts. Then repetitions, while those from `nodes` on, which are no nodes', lack some */
static PetscErrorCode SpaceAnswer(ChangeSpace *s, const ChangeRange *range, PetscInt nodes, ChangeForces forces[2])
{
  const ChangeForces own[2]    = {{nodes, forces[0].force}, {nodes, forces[1].force}},
                     spread[2] = {ForcesFrom(&forces[0], nodes), ForcesFrom(&forces[1], nodes)};
  const PetscInt  n            = PetscMax(spread[0].n, spread[1].n);
  PetscBool       more         = n ? PETSC_TRUE : PETSC_FALSE;
  const int       steps        = s->space.pencil.C ? CHANGE_STEPS_DAMPED : CHANGE_STEPS;
  PetscInt        first[2], last;
  const PetscReal drop = n > SPREAD_FEW ? SPREAD_LOOSE : SPREAD_DROP;

  PetscFunctionBeginUser;
  s->first[0] = s->first[1] = s->space.space.n;
  PetscCall(SpaceStep(s, n ? steps - 1 : steps, n > SPREAD_FEW ? own : forces));
  if (n > SPREAD_FEW) {
    PetscCall(PetscArraycpy(first, s->first, 2));
    PetscCall(SpaceStep(s, 1, spread));
    PetscCall(PetscArraycpy(s->first, first, 2));
  }
  last = s->first[1];
  for (int i = 0; i < SPREAD_REPEATS && more; i++) {
    PetscCall(SpaceRepeat(s, range, nodes, drop, forces, &more));
    s->first[0] = PetscMin(s->first[0], last); /* repetitions answer no force at a node: their last step still counts */
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ChangeSpaceTake(ChangeSpace *s, PetscInt n_terms, const ChangeTerm terms[])
{
  ChangeForces forces[2] = {{0, NULL}, {0, NULL}};

  PetscFunctionBeginUser;
  PetscCall(SpaceForget(s));
  PetscCall(SpaceKeepTerms(s, n_terms, terms));
  for (int i = 0; i < 2; i++) PetscCall(SpaceTakeForces(s, i ? PETSC_TRUE : PETSC_FALSE, &forces[i]));
  PetscCall(SpaceTakeSides(s, forces));
  PetscCall(ForcesDestroy(forces));
  PetscFunctionReturn(0);
}

PetscErrorCode ChangeSpaceRespond(ChangeSpace *s, PetscInt n_terms, const ChangeTerm terms[], const ChangeRange *range)
{
  PetscInt     nodes = 0;
  ChangeForces forces[2];
  PetscBool    answers;

  PetscFunctionBeginUser;
  PetscCall(SpaceAnswers(s, n_terms, terms, &answers));
  if (answers) PetscFunctionReturn(0);
  PetscCall(SpaceForget(s));
  PetscCall(SpaceKeepTerms(s, n_terms, terms));
  for (PetscInt t = 0; t < n_terms; t++) nodes += terms[t].force ? 1 : 0;
  for (int i = 0; i < 2; i++) {
    const PetscBool left = i ? PETSC_TRUE : PETSC_FALSE;

    PetscCall(ChangeSpaceForces(s,
                                &(ChangeVectors){s->n_before, s->n_modes, s->lambda, left ? s->after : s->before, left},
                                NULL, SPREAD_DROP, &forces[i]));
    PetscCall(SpaceTakeForces(s, left, &forces[i]));
  }
  PetscCall(SpaceAnswer(s, range, nodes, forces));
  PetscCall(SpaceTakeSides(s, forces));
  PetscCall(ForcesDestroy(forces));
  PetscFunctionReturn(0);
}

PetscErrorCode ChangeSpaceDestroy(ChangeSpace *s)
{
  PetscFunctionBeginUser;
  PetscCall(SpaceForget(s));
  PetscCall(PetscFree(s->before));
  PetscCall(PetscFree(s->after));
  PetscCall(PetscFree2(s->length, s->lambda));
  PetscCall(ModesSpaceDestroy(&s->space));
  PetscFunctionReturn(0);
}
