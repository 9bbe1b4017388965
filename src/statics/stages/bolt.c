/*
   Bolts that a stage tightens to a tension (model/scene/loads/bolt.c): their shortenings d solve T(d) = F, where T(d)
   is the tension at the end of the stage, found as without them, from where the stage before left the pairs. Status and
   friction make T piecewise smooth: Broyden's method (C. G. Broyden, Math. Comp. 19, 1965) from the slopes T_i / d_i of
   a first solution; on linear pieces it ends after 2 n steps. While gaps below a bolt close it carries nothing, and its
   shortening grows as a geometric series. Where other loads open a joint T is flat, and a slope across the kink leads
   anywhere: the tension of one bolt grows with its shortening, and steps stay between those that were too little and
   too much. All solutions share one factorisation.
*/
#include "statics/staticsimpl.h"
#include <petscblaslapack.h>

#define BOLT_RTOL  1e-10 /* of the largest tension */
#define BOLT_STEPS 60
#define BOLT_REACH 100  /* times the shortening so far is the farthest step of one bolt */
#define BOLT_SLACK 1e-6 /* of the tension asked for: less than that is none */
#define BOLT_GROWS                                                                                                     \
  4 /* times the shortening so far is added to that of a bolt without tension; or half the way to
                           what was too much */

/* The n bolts that stage k tightens, with d (m), T - F (N), dT/dd (N/m, by columns); the pairs before the stage; its
   loads: those before (borrowed), its own, their size */
typedef struct {
  PetscInt       k;
  Vec            f0, *f;
  PetscReal     *size;
  PetscInt       n, *load;
  PetscReal     *d, *off, *J, *step, *asked;
  PetscReal     *last, *had, *high; /* d and T - F when it had tension last, last 0 before; a d of too much, 0 before */
  PetscReal      bracket[2];        /* of one bolt: the largest d of too little, the least of too much */
  PetscReal      width;             /* of it before the last step; infinite at first */
  PetscBool      has_bracket[2];
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
  PetscCall(
    PetscMalloc6(b->n, &b->load, b->n, &b->d, b->n, &b->off, b->n * b->n, &b->J, b->n, &b->step, b->n, &b->asked));
  PetscCall(PetscCalloc3(b->n, &b->last, b->n, &b->had, b->n, &b->high));
  PetscCall(PetscMalloc2(s->rows.n_pairs, &b->status, s->rows.n_pairs, &b->state));
  PetscCall(PetscArraycpy(b->status, s->status, s->rows.n_pairs));
  PetscCall(PetscArraycpy(b->state, s->state, s->rows.n_pairs));
  PetscCall(VecDuplicate(s->u, &b->u));
  PetscCall(VecCopy(s->u, b->u));
  b->rested = s->rested;
  b->n      = 0;
  for (PetscInt i = 0; i < scene->n_loads; i++)
    if (BoltBegins(s, k, scene, i)) b->load[b->n++] = i;
  PetscFunctionReturn(0);
}

static PetscErrorCode BoltsEnd(Bolts *b)
{
  PetscFunctionBeginUser;
  if (!b->n) PetscFunctionReturn(0);
  PetscCall(PetscFree6(b->load, b->d, b->off, b->J, b->step, b->asked));
  PetscCall(PetscFree3(b->last, b->had, b->high));
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

/* What a solution tells of one bolt */
static void BracketTake(Bolts *b)
{
  const int side = b->off[0] > 0 ? 1 : 0;

  if (!b->has_bracket[side] || (side ? b->d[0] < b->bracket[1] : b->d[0] > b->bracket[0])) b->bracket[side] = b->d[0];
  b->has_bracket[side] = PETSC_TRUE;
}

/* A shortening d of one bolt; in place of one that is outside the bracket, or where that does not shrink by half, its
   middle; while it is open no more than BOLT_REACH times what there was is added, or BOLT_GROWS times taken off */
static PetscReal BracketKeep(Bolts *b, PetscReal d)
{
  const PetscReal *e = b->bracket, width = e[1] - e[0];

  if (b->has_bracket[0] && b->has_bracket[1]) {
    const PetscBool shrinks = width <= b->width / 2 ? PETSC_TRUE : PETSC_FALSE;

    b->width = width;
    return d > e[0] && d < e[1] && shrinks ? d : (e[0] + e[1]) / 2;
  }
  if (b->has_bracket[0]) {
    const PetscReal size = PetscAbsReal(e[0]);

    return d > e[0] ? PetscMin(d, e[0] + BOLT_REACH * size) : e[0] + BOLT_GROWS * size;
  }
  return PetscMax(d, e[1] - BOLT_GROWS * PetscAbsReal(e[1]));
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
  for (PetscInt j = 0; j < b->n; j++) stage->share[b->load[j]] = b->d[j];
  PetscCall(StageSolve(s, b->k, b->f0, b->size, b->f));
  s->n_tightened++;
  for (PetscInt j = 0; j < b->n; j++) {
    OperatorsBolt bolt;

    PetscCall(BoltGet(s, b->load[j], &bolt));
    PetscCall(BoltAsked(s, b->load[j], &b->asked[j]));
    b->off[j] = bolt.tension - b->asked[j];
    largest   = PetscMax(largest, PetscAbsReal(b->off[j]));
    most      = PetscMax(most, b->asked[j]);
  }
  if (b->n == 1) BracketTake(b);
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

static PetscBool BoltIsSlack(const Bolts *b, PetscInt j)
{
  return b->off[j] + b->asked[j] <= BOLT_SLACK * b->asked[j] ? PETSC_TRUE : PETSC_FALSE;
}

/* What a solution tells: J += (dT - J step) step' / step'step where all bolts had tension before and after the step,
   else the slope of each that has, from where it had tension last, or from none */
static void BoltsLearn(Bolts *b, PetscBool smooth)
{
  PetscReal length = 0;

  for (PetscInt j = 0; j < b->n; j++) length += smooth ? PetscSqr(b->d[j] - b->last[j]) : 0;
  for (PetscInt i = 0; i < b->n; i++) {
    PetscReal rest = b->off[i] - b->had[i];

    if (BoltIsSlack(b, i)) continue;
    for (PetscInt j = 0; j < b->n; j++) rest -= b->J[i + b->n * j] * (b->d[j] - b->last[j]);
    for (PetscInt j = 0; j < b->n && length > 0; j++) b->J[i + b->n * j] += rest * (b->d[j] - b->last[j]) / length;
    if (length == 0 && b->d[i] != b->last[i])
      b->J[i + b->n * i] = (b->off[i] - (b->last[i] > 0 ? b->had[i] : -b->asked[i])) / (b->d[i] - b->last[i]);
  }
  for (PetscInt i = 0; i < b->n; i++) {
    if (BoltIsSlack(b, i)) continue;
    b->last[i] = b->d[i];
    b->had[i]  = b->off[i];
    if (b->off[i] > 0) b->high[i] = b->d[i];
  }
}

/* Shortenings of the cells at the cuts alone, and slopes from the solution with these */
static PetscErrorCode BoltsGuess(Statics s, Bolts *b, PetscBool *good)
{
  PetscReal *stiffness, asked;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(b->n, &stiffness));
  for (PetscInt j = 0; j < b->n; j++) {
    OperatorsBolt bolt;

    PetscCall(OperatorsGetBolt(s->operators, s->p, b->load[j], 0, NULL, &bolt));
    PetscCall(BoltAsked(s, b->load[j], &asked));
    stiffness[j] = bolt.stiffness;
    b->d[j]      = asked / stiffness[j];
  }
  PetscCall(BoltsTry(s, b, good));
  PetscCall(PetscArrayzero(b->J, b->n * b->n));
  for (PetscInt j = 0; j < b->n; j++) b->J[j + b->n * j] = stiffness[j];
  BoltsLearn(b, PETSC_FALSE);
  PetscCall(PetscFree(stiffness));
  PetscFunctionReturn(0);
}

/* d -= J^-1 (T - F), but for bolts without tension, whose d grows */
static PetscErrorCode BoltsStep(Statics s, Bolts *b)
{
  PetscBLASInt n, one = 1, info, *pivot;
  PetscScalar *J;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(b->n, &n));
  PetscCall(PetscMalloc2(b->n * b->n, &J, b->n, &pivot));
  PetscCall(PetscArraycpy(J, b->J, b->n * b->n));
  for (PetscInt j = 0; j < b->n; j++) {
    const PetscBool slack = BoltIsSlack(b, j);

    b->step[j] = !slack ? -b->off[j] : b->high[j] > 0 ? 0.5 * (b->high[j] - b->d[j]) : BOLT_GROWS * b->d[j];
    for (PetscInt i = 0; i < b->n && slack; i++) J[j + b->n * i] = i == j ? 1 : 0;
  }
  PetscCallBLAS("LAPACKgesv", LAPACKgesv_(&n, &one, J, &n, pivot, b->step, &n, &info));
  if (info && b->n == 1 && b->has_bracket[0]) b->step[0] = -b->d[0], info = 0; /* a flat piece, out of the bracket */
  PetscCheck(!info, s->comm, PETSC_ERR_NOT_CONVERGED,
             "bolts of stage %s: their tensions do not depend on their shortenings one by one",
             StagesGet(s, s->stage)->name ? StagesGet(s, s->stage)->name : "1");
  for (PetscInt j = 0; j < b->n; j++) b->d[j] += b->step[j];
  if (b->n == 1) b->d[0] = BracketKeep(b, b->d[0]);
  PetscCall(PetscFree2(J, pivot));
  PetscFunctionReturn(0);
}

PetscErrorCode BoltsSolve(Statics s, PetscInt k, Vec f0, PetscReal *size, Vec *f)
{
  const ModelScene *scene;
  PetscBool         good;
  Bolts             b = {.k = k, .f0 = f0, .f = f, .size = size, .width = INFINITY};

  PetscFunctionBeginUser;
  *f = NULL;
  PetscCall(BoltsBegin(s, &b));
  if (!b.n) {
    PetscCall(StageSolve(s, k, f0, size, f));
    PetscFunctionReturn(0);
  }
  PetscCall(ModelGetScene(s->model, &scene));
  PetscCall(BoltsGuess(s, &b, &good));
  for (PetscInt it = 0; !good; it++) {
    const PetscInt worst = BoltsWorst(&b);

    PetscCheck(it < BOLT_STEPS, s->comm, PETSC_ERR_NOT_CONVERGED,
               "-%s_tension: after %d solutions it is %.6g N, not %.6g N: does something hold the bolt, does it hold "
               "nothing, or do other loads pull more?",
               scene->loads[b.load[worst]].name, BOLT_STEPS, (double)(b.off[worst] + b.asked[worst]),
               (double)b.asked[worst]);
    PetscBool smooth = PETSC_TRUE;

    for (PetscInt j = 0; j < b.n; j++)
      if (BoltIsSlack(&b, j)) smooth = PETSC_FALSE;
    PetscCall(BoltsStep(s, &b));
    PetscCall(BoltsTry(s, &b, &good));
    for (PetscInt j = 0; j < b.n; j++)
      if (BoltIsSlack(&b, j)) smooth = PETSC_FALSE;
    BoltsLearn(&b, smooth);
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
