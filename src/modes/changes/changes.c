/*
   Changes of a system whose modes are known: tried one by one, shown and written.
*/
#include "changes.h"

#define CHANGE_ZERO 1e-5 /* of the highest frequency: where there are rigid modes what is lower is one of them */

#define CHANGE_UNSURE 0.01 /* of an eigenvalue: a larger error tells little of its growth */

/* Modes are listed in the band, or from the lowest to the highest that was found; where some are rigid, from above
   them */
static ChangeRange RangeOf(const Modes modes)
{
  ChangeRange range = {.edge = {2 * PETSC_PI * modes->band[0], 2 * PETSC_PI * modes->band[1]}};

  if (!modes->has_band) {
    range.edge[0] = modes->mode[0].omega;
    range.edge[1] = modes->mode[modes->n - 1].omega;
  }
  for (PetscInt i = 0; i < modes->n; i++) {
    const Mode *m = &modes->mode[i];

    if (m->rigid)
      range.edge[0] = PetscMax(range.edge[0], CHANGE_ZERO * range.edge[1]);
    else if (isfinite(m->condition))
      range.noise = PetscMax(range.noise, m->error / m->condition);
  }
  range.growth = modes->growth > 0 ? modes->growth : 0.1 * range.edge[1];
  return range;
}

/* The modes with change i */
static PetscErrorCode ChangeTry(Modes modes, ChangeSpace *space, const ChangeRange *range, PetscInt i)
{
  ModesChanged changed = &modes->changed[i];
  PetscInt     n;
  ChangeTerm  *terms;
  ModesLimit   limit;

  PetscFunctionBeginUser;
  PetscCall(ModesGetLimit(modes, &limit));
  PetscCall(ChangeCreateTerms(modes, i, &n, &terms));
  PetscCall(ChangeSpaceRespond(space, n, terms, range));
  PetscCall(ChangeSolve(space, n, terms, range, changed));
  for (PetscInt k = 0; k < changed->n; k++) {
    ChangedMode *m = &changed->mode[k];

    m->state     = ModesLimitJudge(&limit, creal(m->lambda), cimag(m->lambda), m->error);
    m->uncertain = m->state != MODE_UNSTABLE && m->error > CHANGE_UNSURE * cabs(m->lambda) &&
                       ModesLimitJudge(&limit, creal(m->lambda) + m->error, cimag(m->lambda), 0) == MODE_UNSTABLE
                     ? PETSC_TRUE
                     : PETSC_FALSE;
  }
  PetscCall(ChangeDestroyTerms(n, &terms));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesPlaceChanges(Modes modes, PetscBool *wanted)
{
  PetscFunctionBeginUser;
  *wanted = modes->n_changes ? PETSC_TRUE : PETSC_FALSE;
  PetscCheck(
    !modes->n_changes || !PencilHasLaws(modes->pencil), modes->comm, PETSC_ERR_USER_INPUT,
    "-modes_changes do not know a part whose stiffness depends on the frequency as yet; leave them out, or give "
    "its -..._loss_factor with -model_loss_frequency");
  for (PetscInt i = 0; i < modes->n_changes; i++) {
    PetscInt    n;
    ChangeTerm *terms;

    PetscCall(ChangeCreateTerms(modes, i, &n, &terms));
    PetscCall(ChangeDestroyTerms(n, &terms));
  }
  if (*wanted) PetscCall(ModesKeepFactor(modes, PETSC_TRUE));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesFindChanges(Modes modes)
{
  const ChangeRange range = RangeOf(modes);
  ChangeSpace       space;

  PetscFunctionBeginUser;
  if (modes->couplings) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(modes->n_changes, &modes->changed));
  PetscCall(ChangeSpaceCreate(modes, &range, &space));
  for (PetscInt i = 0; i < modes->n_changes; i++) PetscCall(ChangeTry(modes, &space, &range, i));
  PetscCall(ChangeSpaceDestroy(&space));
  PetscFunctionReturn(0);
}

/* Index of the mode that grows most, -1 where there is none, and how many are unstable, and how many uncertain */
static PetscInt ChangedWorst(const struct _p_ModesChanged *changed, PetscInt *n_unstable, PetscInt *n_uncertain)
{
  PetscInt worst = -1;

  *n_unstable = *n_uncertain = 0;
  for (PetscInt k = 0; k < changed->n; k++) {
    *n_unstable += changed->mode[k].state == MODE_UNSTABLE;
    *n_uncertain += changed->mode[k].uncertain;
    if (worst < 0 || creal(changed->mode[k].lambda) > creal(changed->mode[worst].lambda)) worst = k;
  }
  return worst;
}

/* What was found of where it acts */
static PetscErrorCode ChangeViewPlace(const struct _p_ModesChange *change, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  if (change->has_at)
    PetscCall(PetscViewerASCIIPrintf(viewer, " (node at %.6g, %.6g, %.6g m)", (double)change->x[0][0],
                                     (double)change->x[0][1], (double)change->x[0][2]));
  if (change->set[0] || change->has_ring)
    PetscCall(PetscViewerASCIIPrintf(viewer, " (%" PetscInt_FMT " nodes of %s%s)", change->n_nodes,
                                     change->set[0] ? "set " : "the disc", change->set));
  if (change->parameter[0])
    PetscCall(PetscViewerASCIIPrintf(viewer, " (%s %.6g)", change->parameter, (double)change->value));
  PetscFunctionReturn(0);
}

PetscErrorCode ChangesView(Modes modes, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < modes->n_changes && modes->changed; i++) {
    const struct _p_ModesChanged *changed = &modes->changed[i];
    const ModesChange             change  = &modes->change[i];
    PetscInt                      n_unstable, n_uncertain;
    const PetscInt                worst = ChangedWorst(changed, &n_unstable, &n_uncertain);

    PetscCall(
      PetscViewerASCIIPrintf(viewer, "with %s%s%s", change->name, change->with[0] ? " and " : "", change->with));
    PetscCall(ChangeViewPlace(change, viewer));
    PetscCall(
      PetscViewerASCIIPrintf(viewer, ": %" PetscInt_FMT " modes, %" PetscInt_FMT " unstable", changed->n, n_unstable));
    if (worst >= 0)
      PetscCall(PetscViewerASCIIPrintf(viewer, "; largest growth %.5g 1/s, error %.1e, at %.6g Hz",
                                       (double)creal(changed->mode[worst].lambda), (double)changed->mode[worst].error,
                                       (double)(cimag(changed->mode[worst].lambda) / (2 * PETSC_PI))));
    if (n_uncertain)
      PetscCall(
        PetscViewerASCIIPrintf(viewer, "; %" PetscInt_FMT " uncertain, unstable within their errors", n_uncertain));
    if (changed->n_left_out)
      PetscCall(
        PetscViewerASCIIPrintf(viewer, "; %" PetscInt_FMT " left out, with errors of their size", changed->n_left_out));
    PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ChangesWrite(Modes modes, Results results)
{
  ResultsTable table;
  ChangeRange  range;

  PetscFunctionBeginUser;
  if (modes->couplings && modes->n_changes) {
    range = RangeOf(modes);
    PetscCall(ChangesWriteCouplings(modes, &range, results));
  }
  if (!modes->changed) PetscFunctionReturn(0);
  PetscCall(ResultsTableOpen(results, "modes_changed",
                             "change,mode,freq_hz,growth_rad_s,damping_ratio,error_hz,state,before,overlap", &table));
  for (PetscInt i = 0; i < modes->n_changes; i++)
    for (PetscInt k = 0; k < modes->changed[i].n; k++) {
      const ChangedMode *m = &modes->changed[i].mode[k];

      PetscCall(ResultsTableRow(table, "%s,%d,%.15g,%.15g,%.15g,%.3g,%s,%d,%.4g", modes->change[i].name, (int)k + 1,
                                (double)(cimag(m->lambda) / (2 * PETSC_PI)), (double)creal(m->lambda),
                                (double)(-creal(m->lambda) / cabs(m->lambda) + 0), (double)(m->error / (2 * PETSC_PI)),
                                m->uncertain ? "uncertain" : ModeStateName(m->state), (int)m->before + 1,
                                (double)m->overlap));
    }
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}
