/*
   Designs: life cycle, options, and the flow: boxes -> a basis over both -> designs one after the other, by cuts,
   with a full solution of each that is good -> the corners in full.
*/
#include "designimpl.h"
#include "sample/draw/sequence.h"
#include "base/text.h"
#include <petsctime.h>

#define DESIGN_TRAIN 60 /* points of both boxes together for the basis */

PetscErrorCode DesignCreate(MPI_Comm comm, Design *design)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, design));
  (*design)->comm = comm;
  PetscCall(QuantitiesInit(&design_quantities, *design));
  PetscFunctionReturn(0);
}

PetscErrorCode DesignSetFromOptions(Design d)
{
  char more[CUBE_MAX_TEXT];

  PetscFunctionBeginUser;
  PetscCall(QuantitiesRead(d->comm, &design_quantities, d));
  PetscCall(CubeVaried(&d->options, sizeof(d->varied), d->varied));
  PetscCall(CubeVaried(&d->uncertain_options, sizeof(more), more));
  if (more[0]) PetscCall(TextAdd(d->varied, ",", sizeof(d->varied)));
  PetscCall(TextAdd(d->varied, more, sizeof(d->varied)));
  PetscFunctionReturn(0);
}

PetscErrorCode DesignVisit(Design d, const QuantityVisitor *visitor)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisit(visitor, &design_quantities, NULL, d, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode DesignSetRooms(Design d, Operators operators, const PetscReal p[], Modes modes, Statics statics)
{
  PetscFunctionBeginUser;
  d->operators  = operators;
  d->box.option = "-design_rtol";
  d->box.advice = "raise -design_max_solutions or -design_rtol, or narrow the boxes";
  PetscCall(BoxSetRooms(&d->box, d->comm, operators, p, modes, statics));
  PetscFunctionReturn(0);
}

PetscErrorCode DesignGetVaried(Design d, const char **names)
{
  PetscFunctionBeginUser;
  *names = d->varied;
  PetscFunctionReturn(0);
}

/* Both boxes; what may be changed is not uncertain, too */
static PetscErrorCode DesignRead(Design d)
{
  const CubeOptions *u     = &d->uncertain_options;
  const CubeState    state = d->box.statics ? CUBE_OWN_STATE : CUBE_NO_STATE;

  PetscFunctionBeginUser;
  PetscCheck(u->names[0] || !(u->n_percent + u->n_lower + u->n_upper), d->comm, PETSC_ERR_USER_INPUT,
             "-design_uncertain_percent, -design_uncertain_lower and -design_uncertain_upper do nothing without "
             "-design_uncertain_parameters");
  PetscCheck(u->names[0] || !d->corners_given, d->comm, PETSC_ERR_USER_INPUT,
             "-design_corners %" PetscInt_FMT " are those of -design_uncertain_parameters, which names nothing",
             d->n_corners);
  d->cube.nominal = d->uncertain.nominal = d->box.nominal;
  PetscCall(CubeRead(d->comm, d->operators, state, "design", &d->options, &d->cube));
  if (d->uncertain_options.names[0])
    PetscCall(CubeRead(d->comm, d->operators, state, "design_uncertain", &d->uncertain_options, &d->uncertain));
  for (PetscInt k = 0; k < d->cube.n; k++)
    for (PetscInt l = 0; l < d->uncertain.n; l++)
      for (PetscInt m = 0; m < d->cube.n_moved[k]; m++)
        for (PetscInt i = 0; i < d->uncertain.n_moved[l]; i++)
          PetscCheck(
            d->cube.moved[k][m] != d->uncertain.moved[l][i], d->comm, PETSC_ERR_USER_INPUT,
            "-design_uncertain_parameters and -design_parameters share a parameter, %s and %s: it is one or the "
            "other",
            d->uncertain.name[l], d->cube.name[k]);
  PetscFunctionReturn(0);
}

/* Points for the basis: all scenarios of the scene's own design, then both boxes together */
static PetscErrorCode DesignTrain(Design d)
{
  const PetscInt n        = d->cube.n + d->uncertain.n;
  Sequence       sequence = {SEQUENCE_SOBOL, 2, DESIGN_TRAIN, n, NULL};

  PetscFunctionBeginUser;
  d->n_train = d->n_scenarios + DESIGN_TRAIN;
  PetscCall(SequenceSetUp(&sequence));
  PetscCall(PetscMalloc1(d->n_train * n, &d->train));
  for (PetscInt i = 0; i < d->n_train; i++) {
    PetscReal *t = &d->train[i * n];

    if (i < d->n_scenarios) {
      PetscCall(PetscArraycpy(t, d->cube.own, d->cube.n));
      PetscCall(PetscArraycpy(&t[d->cube.n], &d->scenario[i * d->uncertain.n], d->uncertain.n));
      continue;
    }
    SequencePoint(&sequence, i - d->n_scenarios, t);
    for (PetscInt k = 0; k < n; k++) t[k] = 2 * t[k] - 1;
  }
  PetscCall(SequenceDestroy(&sequence));
  PetscFunctionReturn(0);
}

static PetscErrorCode TrainGet(void *ctx, PetscInt i, PetscReal p[])
{
  const Design     d = ctx;
  const PetscReal *t = &d->train[i * (d->cube.n + d->uncertain.n)];

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(p, d->box.nominal, d->box.n_base));
  CubeMove(&d->cube, t, p);
  CubeMove(&d->uncertain, &t[d->cube.n], p);
  PetscFunctionReturn(0);
}

/* The statuses of these points are the classes that the pencil knows; each point is at its own */
static PetscErrorCode DesignFit(Design d)
{
  const PetscInt n = d->cube.n + d->uncertain.n;
  PetscReal     *points;

  PetscFunctionBeginUser;
  d->box.many = PETSC_TRUE; /* all scenarios of each design */
  PetscCall(BoxSetUp(&d->box, d->n_train, TrainGet, d));
  d->cube.nominal = d->uncertain.nominal = d->box.nominal;
  d->cube.n_parameters = d->uncertain.n_parameters = d->box.n_parameters;
  PetscCall(PetscMalloc1(d->n_train * d->box.n_parameters, &points));
  for (PetscInt i = 0; i < d->n_train; i++) {
    PetscCall(TrainGet(d, i, &points[i * d->box.n_parameters]));
    BoxPutStatus(&d->box, i, &points[i * d->box.n_parameters]);
    if (d->box.statics) PetscCall(DesignKnow(d, &d->train[i * n], &d->train[i * n + d->cube.n], d->box.status[i]));
  }
  /* of the scene's own design */
  if (d->box.statics) PetscCall(PetscArraycpy(d->status, d->box.status, d->n_scenarios));
  PetscCall(BoxFit(&d->box, d->n_train, points));
  PetscCall(BoxCompress(&d->box, d->n_train, points));
  PetscCall(PetscFree(points));
  PetscFunctionReturn(0);
}

/* Designs until one is stable at all corners in full */
static PetscErrorCode DesignSearchConfirmed(Design d)
{
  PetscLogDouble begun, between, ended;
  DesignCorner   unstable = {.n_unstable = 0};

  PetscFunctionBeginUser;
  do {
    PetscCall(PetscTime(&begun));
    PetscCall(DesignSearch(d));
    PetscCall(PetscTime(&between));
    unstable.n_unstable = 0;
    if (d->found) PetscCall(DesignCorners(d, &unstable));
    if (unstable.n_unstable) PetscCall(DesignReject(d, &unstable));
    PetscCall(PetscTime(&ended));
    d->seconds[1] += between - begun;
    d->seconds[2] += ended - between;
  } while (unstable.n_unstable && d->n_points < d->max_designs);
  if (!d->found) DesignChooseBest(d);
  PetscFunctionReturn(0);
}

PetscErrorCode DesignSolve(Design d, Results results)
{
  PetscLogDouble begun, ended;

  PetscFunctionBeginUser;
  (void)results;
  PetscCall(PetscTime(&begun));
  PetscCall(DesignRead(d));
  PetscCall(DesignScenarios(d));
  PetscCall(DesignTrain(d));
  PetscCall(DesignFit(d));
  PetscCall(DesignMass(d));
  PetscCall(PetscTime(&ended));
  d->seconds[0] = ended - begun;
  PetscCall(DesignSearchConfirmed(d));
  PetscFunctionReturn(0);
}

PetscErrorCode DesignDestroy(Design *design)
{
  Design d = *design;

  PetscFunctionBeginUser;
  if (!d) PetscFunctionReturn(0);
  PetscCall(PetscFree3(d->scenario, d->status, d->apart));
  PetscCall(PetscFree(d->train));
  PetscCall(PetscFree(d->known));
  PetscCall(PetscFree(d->known_status));
  PetscCall(PetscFree(d->cut));
  PetscCall(PetscFree(d->point));
  PetscCall(PetscFree(d->corner));
  PetscCall(CubeDestroy(&d->cube));
  PetscCall(CubeDestroy(&d->uncertain));
  PetscCall(BoxDestroy(&d->box));
  PetscCall(PetscFree(*design));
  PetscFunctionReturn(0);
}
