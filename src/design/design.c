/*
   Designs: life cycle, options, and the flow: boxes -> a basis over both -> designs one after the other, by cuts,
   with a full solution of each that is good -> the corners in full.
*/
#include "designimpl.h"
#include "sample/draw/sequence.h"
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
  if (more[0]) PetscCall(PetscStrlcat(d->varied, ",", sizeof(d->varied)));
  PetscCall(PetscStrlcat(d->varied, more, sizeof(d->varied)));
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
  d->operators     = operators;
  d->box.comm      = d->comm;
  d->box.operators = operators;
  d->box.modes     = modes;
  d->box.statics   = statics;
  d->box.option    = "-design_rtol";
  d->box.advice    = "raise -design_max_solutions or -design_rtol, or narrow the boxes";
  PetscCall(PetscFree(d->box.nominal));
  PetscCall(OperatorsCreatePoint(operators, p, &d->box.nominal));
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
  const CubeOptions *u    = &d->uncertain_options;
  const PetscBool    held = d->box.statics ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCheck(u->names[0] || !(u->n_percent + u->n_lower + u->n_upper), d->comm, PETSC_ERR_USER_INPUT,
             "-design_uncertain_percent, -design_uncertain_lower and -design_uncertain_upper do nothing without "
             "-design_uncertain_parameters");
  d->cube.nominal = d->uncertain.nominal = d->box.nominal;
  PetscCall(CubeRead(d->comm, d->operators, held, "design", &d->options, &d->cube));
  if (d->uncertain_options.names[0])
    PetscCall(CubeRead(d->comm, d->operators, held, "design_uncertain", &d->uncertain_options, &d->uncertain));
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
static PetscErrorCode DesignFit(Design d)
{
  const PetscInt n = d->cube.n + d->uncertain.n, m = d->box.n_parameters, n_points = d->n_scenarios + DESIGN_TRAIN;
  Sequence       sequence = {SEQUENCE_SOBOL, 2, DESIGN_TRAIN, n, NULL};
  PetscReal     *points, t[2 * CUBE_MAX_VARIABLES];

  PetscFunctionBeginUser;
  PetscCall(SequenceSetUp(&sequence));
  PetscCall(PetscMalloc1(n_points * m, &points));
  for (PetscInt i = 0; i < n_points; i++) {
    PetscReal *p = &points[i * m];

    PetscCall(PetscArraycpy(p, d->box.nominal, m));
    if (i < d->n_scenarios) {
      DesignParameters(d, d->cube.own, &d->scenario[i * d->uncertain.n], p);
      continue;
    }
    SequencePoint(&sequence, i - d->n_scenarios, t);
    for (PetscInt k = 0; k < n; k++) t[k] = 2 * t[k] - 1;
    DesignParameters(d, t, &t[d->cube.n], p);
  }
  PetscCall(BoxFit(&d->box, n_points, points));
  PetscCall(BoxCompress(&d->box, n_points, points));
  PetscCall(PetscFree(points));
  PetscCall(SequenceDestroy(&sequence));
  PetscFunctionReturn(0);
}

PetscErrorCode DesignSolve(Design d, Results results)
{
  PetscLogDouble begun, ended;

  PetscFunctionBeginUser;
  (void)results;
  PetscCall(PetscTime(&begun));
  PetscCall(DesignRead(d));
  PetscCall(BoxSetUp(&d->box, 0, NULL, NULL)); /* the status of the scene's own values holds everywhere */
  d->cube.nominal = d->uncertain.nominal = d->box.nominal;
  d->cube.n_parameters = d->uncertain.n_parameters = d->box.n_parameters;
  PetscCall(DesignScenarios(d));
  PetscCall(DesignMass(d));
  PetscCall(DesignFit(d));
  PetscCall(PetscTime(&ended));
  d->seconds[0] = ended - begun;
  PetscCall(DesignSearch(d));
  PetscCall(PetscTime(&begun));
  d->seconds[1] = begun - ended;
  if (d->found) PetscCall(DesignCorners(d));
  PetscCall(PetscTime(&ended));
  d->seconds[2] = ended - begun;
  PetscFunctionReturn(0);
}

PetscErrorCode DesignDestroy(Design *design)
{
  Design d = *design;

  PetscFunctionBeginUser;
  if (!d) PetscFunctionReturn(0);
  PetscCall(PetscFree(d->scenario));
  PetscCall(PetscFree(d->cut));
  PetscCall(PetscFree(d->point));
  PetscCall(PetscFree(d->corner));
  PetscCall(CubeDestroy(&d->cube));
  PetscCall(CubeDestroy(&d->uncertain));
  PetscCall(BoxDestroy(&d->box));
  PetscCall(PetscFree(*design));
  PetscFunctionReturn(0);
}
