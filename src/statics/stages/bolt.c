/*
   Bolts that a stage tightens to a tension (model/scene/loads/bolt.c): their shortenings d solve T(d) = F, where T(d)
   is the tension at the end of the stage, found as without them, from where the stage before left the pairs. Without
   friction T is the gradient of a convex energy, and so are its pieces of all statuses: it is flat where gaps below a
   bolt are open or other loads open the joint, and steps across a kink lead anywhere. So d is the minimum of that
   energy less F'd, by the BFGS method (J. Nocedal, S. Wright, Numerical Optimization, 2006, ch. 6) on T alone, in the
   unit x = k d (N), k of the cells at the cut: along each direction p the slope (T - F)'p grows from below 0, and a
   step is taken where it has fallen by half, by secants between steps that were too short and too long. On one piece
   this is the secant method for one bolt. All solutions share one factorisation.
*/
#include "statics/staticsimpl.h"
#include <petscblaslapack.h>

#define BOLT_RTOL  1e-10 /* of the largest tension */
#define BOLT_STEPS 100
#define BOLT_SLOPE 0.5  /* of the slope along a direction is little enough to learn from the step */
#define BOLT_FLAT  0.01 /* of it: a smaller change is none */
#define BOLT_GROWS 5    /* times a step on a flat piece is the next, */
#define BOLT_REACH 100  /* and at most this where it is not flat */

/* The n bolts that stage k tightens, with x = k d and T - F (N), d(T - F)/dx (n x n), and the direction of a step; the
   pairs before the stage; its loads: those before (borrowed), its own, their size before and with it */
typedef struct {
  PetscInt       k;
  Vec            f0, *f;
  PetscReal     *size, before;
  PetscInt       n, n_tried, *load;
  PetscReal     *x, *off, *J, *p, *asked, *stiffness;
  PetscBool      rested;
  ContactStatus *status;
  ContactState  *state;
  Vec            u;
} Bolts;

/* A load under tension that acts in a stage and did not in the one before */
static PetscBool BoltBegins(Statics s, PetscInt k, const ModelScene *scene, PetscInt i)
{
  const Stage *stage = StagesGet(s, k), *before = StagesGet(s, k - 1);

  return scene->loads[i].has_tension && stage->load[i] > 0 && !(before && before->load[i] > 0) ? PETSC_TRUE
                                                                                               : PETSC_FALSE;
}

/* Shares of the loads of a stage but for the bolts that it tightens, which are counted */
static PetscErrorCode BoltsBegin(Statics s, Bolts *b)
{
  const PetscInt    k      = b->k;
  Stage            *stage  = (Stage *)StagesGet(s, k);
  const Stage      *before = StagesGet(s, k - 1);
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(s->model, &scene));
  for (PetscInt i = 0; i < scene->n_loads; i++) {
    stage->share[i] = stage->load[i];
    if (scene->loads[i].has_tension) stage->share[i] = stage->load[i] > 0 && before ? before->share[i] : 0;
    if (BoltBegins(s, k, scene, i)) b->n++;
  }
  if (!b->n) PetscFunctionReturn(0);
  PetscCall(PetscCalloc7(b->n, &b->load, b->n, &b->x, b->n, &b->off, b->n * b->n, &b->J, b->n, &b->p, b->n, &b->asked,
                         b->n, &b->stiffness));
  PetscCall(PetscMalloc2(s->rows.n_pairs, &b->status, s->rows.n_pairs, &b->state));
  PetscCall(PetscArraycpy(b->status, s->status, s->rows.n_pairs));
  PetscCall(PetscArraycpy(b->state, s->state, s->rows.n_pairs));
  PetscCall(VecDuplicate(s->u, &b->u));
  PetscCall(VecCopy(s->u, b->u));
  b->rested = s->rested;
  b->before = *b->size;
  b->n      = 0;
  for (PetscInt i = 0; i < scene->n_loads; i++)
    if (BoltBegins(s, k, scene, i)) b->load[b->n++] = i;
  PetscFunctionReturn(0);
}

static PetscErrorCode BoltsEnd(Bolts *b)
{
  PetscFunctionBeginUser;
  if (!b->n) PetscFunctionReturn(0);
  PetscCall(PetscFree7(b->load, b->x, b->off, b->J, b->p, b->asked, b->stiffness));
  PetscCall(PetscFree2(b->status, b->state));
  PetscCall(VecDestroy(&b->u));
  PetscFunctionReturn(0);
}

/* The tension that is asked for at the point */
static PetscErrorCode BoltAsked(Statics s, PetscInt i, PetscReal *tension)
{
  const OperatorsParameter *parameters;
  const ModelScene         *scene;
  PetscInt                  n;
  char                      name[192];

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(s->model, &scene));
  PetscCall(OperatorsGetParameters(s->operators, &n, &parameters));
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s_tension", scene->loads[i].name));
  *tension = scene->loads[i].tension;
  for (PetscInt j = 0; j < n; j++)
    if (!strcmp(parameters[j].name, name)) *tension = s->p[j];
  PetscFunctionReturn(0);
}

/* The stage with the present shortenings: what is off, and whether that is little */
static PetscErrorCode BoltsTry(Statics s, Bolts *b, PetscBool *good)
{
  Stage    *stage = (Stage *)StagesGet(s, b->k);
  PetscReal most = 0, largest = 0;

  PetscFunctionBeginUser;
  PetscCall(VecDestroy(b->f));
  PetscCall(PetscArraycpy(s->status, b->status, s->rows.n_pairs));
  PetscCall(PetscArraycpy(s->state, b->state, s->rows.n_pairs));
  PetscCall(VecCopy(b->u, s->u));
  s->rested = b->rested;
  *b->size  = b->before;
  for (PetscInt j = 0; j < b->n; j++) stage->share[b->load[j]] = b->x[j] / b->stiffness[j];
  PetscCall(StageSolve(s, b->k, b->f0, b->size, b->f));
  s->n_tightened++;
  b->n_tried++;
  for (PetscInt j = 0; j < b->n; j++) {
    OperatorsBolt bolt;

    PetscCall(BoltGet(s, b->load[j], &bolt));
    b->off[j] = bolt.tension - b->asked[j];
    largest   = PetscMax(largest, PetscAbsReal(b->off[j]));
    most      = PetscMax(most, b->asked[j]);
  }
  *good = largest <= BOLT_RTOL * most ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* The bolt whose tension is farthest from what is asked for */
static PetscInt BoltsWorst(const Bolts *b)
{
  PetscInt worst = 0;

  for (PetscInt j = 1; j < b->n; j++)
    if (PetscAbsReal(b->off[j]) > PetscAbsReal(b->off[worst])) worst = j;
  return worst;
}

/* The error of the last solution that there is, where the tensions are not those asked for */
static PetscErrorCode BoltsCheckSteps(Statics s, const Bolts *b)
{
  const PetscInt    worst = BoltsWorst(b);
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(s->model, &scene));
  PetscCheck(b->n_tried < BOLT_STEPS, s->comm, PETSC_ERR_NOT_CONVERGED,
             "-%s_tension: after %d solutions it is %.6g N, not %.6g N: does something hold the bolt, does it hold "
             "nothing, or do other loads pull more?",
             scene->loads[b->load[worst]].name, BOLT_STEPS, (double)(b->off[worst] + b->asked[worst]),
             (double)b->asked[worst]);
  PetscFunctionReturn(0);
}

/* The solution with x = F, and J = T / x of each bolt that carries something */
static PetscErrorCode BoltsGuess(Statics s, Bolts *b, PetscBool *good)
{
  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < b->n; j++) {
    OperatorsBolt bolt;

    PetscCall(OperatorsGetBolt(s->operators, s->p, b->load[j], 0, NULL, &bolt));
    PetscCall(BoltAsked(s, b->load[j], &b->asked[j]));
    b->stiffness[j] = bolt.stiffness;
    b->x[j]         = b->asked[j];
  }
  PetscCall(BoltsTry(s, b, good));
  for (PetscInt j = 0; j < b->n; j++) b->J[j + b->n * j] = PetscMax(BOLT_FLAT, 1 + b->off[j] / b->asked[j]);
  PetscFunctionReturn(0);
}

/* p = -J^-1 (T - F) */
static PetscErrorCode BoltsDirect(Statics s, Bolts *b)
{
  PetscBLASInt n, one = 1, info, *pivot;
  PetscScalar *J;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(b->n, &n));
  PetscCall(PetscMalloc2(b->n * b->n, &J, b->n, &pivot));
  PetscCall(PetscArraycpy(J, b->J, b->n * b->n));
  for (PetscInt j = 0; j < b->n; j++) b->p[j] = -b->off[j];
  PetscCallBLAS("LAPACKgesv", LAPACKgesv_(&n, &one, J, &n, pivot, b->p, &n, &info));
  PetscCheck(!info, s->comm, PETSC_ERR_NOT_CONVERGED,
             "bolts of stage %s: their tensions do not depend on their shortenings one by one",
             StagesGet(s, s->stage)->name ? StagesGet(s, s->stage)->name : "1");
  PetscCall(PetscFree2(J, pivot));
  PetscFunctionReturn(0);
}

/* J += y y' / y't p - J p p' J / p'J p of a step t p, by which T grew by y; J p = -(T - F) before the step */
static void BoltsLearn(Bolts *b, PetscReal t, const PetscReal before[])
{
  PetscReal yp = 0, pjp = 0;

  for (PetscInt i = 0; i < b->n; i++) yp += (b->off[i] - before[i]) * b->p[i];
  for (PetscInt i = 0; i < b->n; i++) pjp -= before[i] * b->p[i];
  for (PetscInt i = 0; i < b->n; i++)
    for (PetscInt j = 0; j < b->n; j++)
      b->J[i + b->n * j] += (b->off[i] - before[i]) * (b->off[j] - before[j]) / (t * yp) - before[i] * before[j] / pjp;
}

/* Steps t along p with slopes (T - F)'p that are below and above 0: too short and too long; without the latter end 0 */
typedef struct {
  PetscReal end[2], slope[2], width;
} Bracket;

/* The next step: by the secant, and where that does not halve the bracket its middle; from a piece on which T is flat
   BOLT_GROWS times farther */
static PetscReal BracketNext(Bracket *t, PetscReal first)
{
  const PetscReal width = t->end[1] - t->end[0], before = t->width, fall = t->slope[0] - first;
  PetscReal       next;

  if (t->end[1] <= 0)
    return fall < -BOLT_FLAT * first ? BOLT_GROWS * t->end[0]
                                     : PetscMin(-t->end[0] * first / fall, BOLT_REACH * t->end[0]);
  t->width = width;
  next     = t->end[0] - t->slope[0] * width / (t->slope[1] - t->slope[0]);
  return width <= before / 2 && next > t->end[0] && next < t->end[1] ? next : t->end[0] + width / 2;
}

/* A step along p, until the slope along it is BOLT_SLOPE of what it was, and what it tells */
static PetscErrorCode BoltsStep(Statics s, Bolts *b, PetscBool *good)
{
  PetscReal *before, *x, first = 0, t = 1;
  Bracket    found = {.width = INFINITY};

  PetscFunctionBeginUser;
  PetscCall(BoltsDirect(s, b));
  PetscCall(PetscMalloc2(b->n, &x, b->n, &before));
  PetscCall(PetscArraycpy(x, b->x, b->n));
  PetscCall(PetscArraycpy(before, b->off, b->n));
  for (PetscInt j = 0; j < b->n; j++) first += before[j] * b->p[j];
  for (found.slope[0] = first;; t = BracketNext(&found, first)) {
    PetscReal slope = 0;

    for (PetscInt j = 0; j < b->n; j++) b->x[j] = x[j] + t * b->p[j];
    PetscCall(BoltsTry(s, b, good));
    for (PetscInt j = 0; j < b->n; j++) slope += b->off[j] * b->p[j];
    if (*good || PetscAbsReal(slope) <= -BOLT_SLOPE * first) break;
    PetscCall(BoltsCheckSteps(s, b));
    found.end[slope > 0]   = t;
    found.slope[slope > 0] = slope;
  }
  if (!*good) BoltsLearn(b, t, before);
  PetscCall(PetscFree2(x, before));
  PetscFunctionReturn(0);
}

PetscErrorCode BoltsSolve(Statics s, PetscInt k, Vec f0, PetscReal *size, Vec *f)
{
  PetscBool good;
  Bolts     b = {.k = k, .f0 = f0, .f = f, .size = size};

  PetscFunctionBeginUser;
  *f = NULL;
  PetscCall(BoltsBegin(s, &b));
  if (!b.n) {
    PetscCall(StageSolve(s, k, f0, size, f));
    PetscFunctionReturn(0);
  }
  PetscCall(BoltsGuess(s, &b, &good));
  while (!good) {
    PetscCall(BoltsCheckSteps(s, &b));
    PetscCall(BoltsStep(s, &b, &good));
  }
  PetscCall(BoltsEnd(&b));
  PetscFunctionReturn(0);
}

PetscErrorCode BoltsView(Statics s, PetscViewer viewer)
{
  const ModelScene *scene;
  const char       *metre;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(s->model, &scene));
  PetscCall(ModelGetUnit(s->model, "m", &metre));
  for (PetscInt i = 0; i < scene->n_loads; i++) {
    OperatorsBolt bolt;

    if (!scene->loads[i].is_bolt) continue;
    PetscCall(BoltGet(s, i, &bolt));
    PetscCall(PetscViewerASCIIPrintf(viewer, "bolt %s: tension %.9g N, shortened by %.9g %s\n", scene->loads[i].name,
                                     (double)bolt.tension, (double)bolt.shortening, metre));
  }
  if (s->n_tightened)
    PetscCall(PetscViewerASCIIPrintf(viewer, "bolts tightened in %" PetscInt_FMT " solutions\n", s->n_tightened));
  PetscFunctionReturn(0);
}
