/*
   Quiet boxes: life cycle, options, and the flow: the box -> a basis over it -> dangerous points -> cells -> the
   nearest dangerous point in full -> random points inside.
*/
#include "quietimpl.h"
#include "sample/draw/sequence.h"
#include <petsctime.h>

#define TRAIN 60 /* points of the box for the basis, beside its corners and the scene's own values */

PetscErrorCode QuietCreate(MPI_Comm comm, Quiet *quiet)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, quiet));
  (*quiet)->comm = comm;
  PetscCall(QuantitiesInit(&quiet_quantities, *quiet));
  PetscFunctionReturn(0);
}

PetscErrorCode QuietSetFromOptions(Quiet q)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesRead(q->comm, &quiet_quantities, q));
  PetscCall(CubeVaried(&q->options, sizeof(q->varied), q->varied));
  PetscFunctionReturn(0);
}

PetscErrorCode QuietVisit(Quiet q, const QuantityVisitor *visitor)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisit(visitor, &quiet_quantities, NULL, q, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode QuietSetRooms(Quiet q, Operators operators, const PetscReal p[], Modes modes, Statics statics)
{
  PetscFunctionBeginUser;
  q->operators  = operators;
  q->box.option = "-quiet_rtol";
  q->box.advice = "raise -quiet_max_solutions or -quiet_rtol, or narrow the box";
  PetscCall(BoxSetRooms(&q->box, q->comm, operators, p, modes, statics));
  PetscFunctionReturn(0);
}

PetscErrorCode QuietGetVaried(Quiet q, const char **names)
{
  PetscFunctionBeginUser;
  *names = q->varied;
  PetscFunctionReturn(0);
}

/* Points of the box: the scene's own values, corners, a sequence */
typedef struct {
  Quiet     quiet;
  PetscInt  n, n_corners;
  Sequence *sequence;
} QuietPoints;

/* In t; of more than six variables some move alike at the corners */
static void QuietPoint(const QuietPoints *points, PetscInt i, PetscReal t[])
{
  const Cube *cube = &points->quiet->cube;

  if (i > points->n_corners) SequencePoint(points->sequence, i - 1 - points->n_corners, t);
  for (PetscInt k = 0; k < cube->n; k++)
    t[k] = !i ? cube->own[k] : i > points->n_corners ? 2 * t[k] - 1 : (i - 1) >> (k % 6) & 1 ? 1 : -1;
}

static PetscErrorCode QuietGet(void *ctx, PetscInt i, PetscReal p[])
{
  const Quiet q = ((const QuietPoints *)ctx)->quiet;
  PetscReal   t[CUBE_MAX_VARIABLES];

  PetscFunctionBeginUser;
  QuietPoint(ctx, i, t);
  PetscCall(PetscArraycpy(p, q->box.nominal, q->box.n_base));
  if (i) CubeMove(&q->cube, t, p);
  PetscFunctionReturn(0);
}

/* At how many of the points other pairs are closed than at the scene's own values */
static PetscErrorCode QuietFindStatuses(Quiet q, QuietPoints *points)
{
  PetscInt *status, *apart;

  PetscFunctionBeginUser;
  if (!q->box.statics) PetscFunctionReturn(0);
  q->n_status = points->n;
  PetscCall(PetscMalloc2(points->n, &status, points->n, &apart));
  PetscCall(BoxFindClasses(&q->box, points->n, QuietGet, points, status, apart));
  for (PetscInt i = 0; i < points->n; i++) {
    PetscReal t[CUBE_MAX_VARIABLES];

    if (!apart[i]) continue;
    QuietPoint(points, i, t);
    q->other_distance = q->n_other ? PetscMin(q->other_distance, CubeDistance(&q->cube, t)) : CubeDistance(&q->cube, t);
    q->apart          = PetscMax(q->apart, apart[i]);
    q->n_other++;
  }
  PetscCall(PetscFree2(status, apart));
  PetscFunctionReturn(0);
}

/* The basis, good at these points with the status of the scene's own values */
static PetscErrorCode QuietFit(Quiet q)
{
  const PetscInt n_corners = 1 << PetscMin(q->cube.n, 6), n = 1 + n_corners + TRAIN, m = q->box.n_parameters;
  Sequence       sequence = {SEQUENCE_SOBOL, 1, TRAIN, q->cube.n, NULL};
  QuietPoints    points   = {q, n, n_corners, &sequence};
  PetscReal     *p;

  PetscFunctionBeginUser;
  PetscCall(SequenceSetUp(&sequence));
  PetscCall(PetscMalloc1(n * m, &p));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(PetscArraycpy(&p[i * m], q->box.nominal, m));
    PetscCall(QuietGet(&points, i, &p[i * m]));
  }
  PetscCall(QuietFindStatuses(q, &points));
  PetscCall(BoxFit(&q->box, n, p));
  PetscCall(BoxCompress(&q->box, n, p));
  PetscCall(PetscFree(p));
  PetscCall(SequenceDestroy(&sequence));
  PetscFunctionReturn(0);
}

/* The name of the mode of the nearest dangerous point */
static PetscErrorCode DangerLabel(Quiet q)
{
  DangerPoint *at = &q->danger;
  ReducedModes modes;
  char(*label)[32];
  PetscReal *p, nearest = PETSC_MAX_REAL;

  PetscFunctionBeginUser;
  if (!at->found) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(q->cube.n_parameters, &p));
  CubePoint(&q->cube, at->t, p);
  PetscCall(BoxSolve(&q->box, PETSC_FALSE, p, &modes));
  PetscCall(ReducedModesBroadcast(q->comm, 0, &modes));
  PetscCall(PetscMalloc1(modes.n, &label));
  PetscCall(BasisKeepFree(&q->box.basis, q->box.modes, p));
  PetscCall(BasisLabelModes(&q->box.basis, q->box.modes, p, &modes, label));
  for (PetscInt i = 0; i < modes.n; i++) {
    const PetscReal distance = cabs(modes.lambda[i] - CMPLX(at->sigma, at->omega));

    if (distance >= nearest) continue;
    nearest = distance;
    PetscCall(PetscStrncpy(at->label, label[i], sizeof(at->label)));
  }
  PetscCall(PetscFree(label));
  PetscCall(ReducedModesDestroy(&modes));
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

/* Takes the time since `begun`, which becomes now */
static PetscErrorCode Took(PetscLogDouble *begun, PetscLogDouble *seconds)
{
  PetscLogDouble now;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&now));
  *seconds += now - *begun;
  *begun = now;
  PetscFunctionReturn(0);
}

/* The box of the options, and whether cells of it can be shown to be quiet */
static PetscErrorCode QuietSetUp(Quiet q)
{
  const OperatorsParameter *parameter;
  const OperatorsTerm      *term;
  PetscInt                  n, n_terms;

  PetscFunctionBeginUser;
  q->cube.nominal = q->box.nominal;
  PetscCall(
    CubeRead(q->comm, q->operators, q->box.statics ? CUBE_HELD_STATE : CUBE_NO_STATE, "quiet", &q->options, &q->cube));
  PetscCheck(q->n_verify <= q->n_random, q->comm, PETSC_ERR_USER_INPUT,
             "-quiet_verify %" PetscInt_FMT " must be at most -quiet_random %" PetscInt_FMT, q->n_verify, q->n_random);
  PetscCall(BoxSetUp(&q->box, 0, NULL, NULL)); /* the status of the scene's own values holds everywhere */
  q->cube.nominal      = q->box.nominal;
  q->cube.n_parameters = q->box.n_parameters;
  PetscCall(PencilGetParameters(q->box.pencil, &n, &parameter, NULL));
  PetscCall(PencilGetTerms(q->box.pencil, &n_terms, &term));
  PetscCall(EnclosureCheck(q->comm, &q->cube, parameter, n_terms, term, &q->exact));
  PetscFunctionReturn(0);
}

PetscErrorCode QuietSolve(Quiet q, Results results)
{
  PetscLogDouble begun;

  PetscFunctionBeginUser;
  (void)results;
  PetscCall(PetscTime(&begun));
  PetscCall(QuietSetUp(q));
  PetscCall(QuietFit(q));
  PetscCall(Took(&begun, &q->seconds[0]));
  PetscCall(QuietProbe(q));
  PetscCall(QuietRefine(q));
  PetscCall(Took(&begun, &q->seconds[2]));
  PetscCall(QuietSearch(q));
  PetscCall(Took(&begun, &q->seconds[1]));
  PetscCall(DangerLabel(q));
  PetscCall(QuietConfirm(q));
  PetscCall(Took(&begun, &q->seconds[2]));
  PetscCall(QuietCheck(q));
  PetscCall(Took(&begun, &q->seconds[3]));
  PetscFunctionReturn(0);
}

PetscErrorCode QuietDestroy(Quiet *quiet)
{
  PetscFunctionBeginUser;
  if (!*quiet) PetscFunctionReturn(0);
  PetscCall(PetscFree((*quiet)->cell));
  PetscCall(CubeDestroy(&(*quiet)->cube));
  PetscCall(BoxDestroy(&(*quiet)->box));
  PetscCall(PetscFree(*quiet));
  PetscFunctionReturn(0);
}
