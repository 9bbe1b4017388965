/*
   The flow loads -> compliance -> pairs -> states of each stage, from where the one before it left the pairs. Each set
   of contacts that slide has rows and a factorisation of its own; all are kept for the next point.
*/
#include "statics/staticsimpl.h"

void StaticsCloseAll(Statics s)
{
  for (PetscInt p = 0; p < s->rows.n_pairs; p++) s->status[p] = s->rows.law[p].d == 3 ? CONTACT_STICK : CONTACT_SLIP;
}

/* Without loads on what can move, f = 0, motions and interferences, g0 < 0 with all motions done, nothing presses: then
   u = 0 and all pairs are without force. An error where all acts at once. Told alike on all ranks. The laws are set
   again in the first load step. */
static PetscErrorCode StageIsPressed(Statics s, const Stage *stage, Vec f, PetscBool *pressed)
{
  const ModelScene *scene;
  PetscReal         least = 0, size;
  PetscBool         moves = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(s->model, &scene));
  for (PetscInt i = 0; i < scene->n_motions; i++)
    if (stage->motion[i] != 0) moves = PETSC_TRUE;
  PetscCall(VecNorm(f, NORM_2, &size));
  PairRowsMove(&s->rows, 1, 0, NULL);
  for (PetscInt p = 0; p < s->rows.n_pairs; p++) least = PetscMin(least, s->rows.law[p].g0);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPIU_REAL, MPI_MIN, s->comm));
  *pressed = size > 0 || least < 0 || s->n_wear || (moves && s->n_stages) ? PETSC_TRUE : PETSC_FALSE;
  PetscCheck(*pressed || s->n_stages, s->comm, PETSC_ERR_USER_INPUT,
             "nothing presses the bodies together: give -loads on what -supports do not hold, e.g. -loads press "
             "-press_set beam_top -press_force 0,0,-100");
  PetscFunctionReturn(0);
}

/* The state in which nothing presses; what follows begins as a first stage does */
static PetscErrorCode StageRest(Statics s, PetscReal l[])
{
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < s->rows.n_pairs; p++) s->status[p] = CONTACT_OPEN;
  PetscCall(PetscArrayzero(l, s->rows.n));
  PetscCall(VecSet(s->u, 0));
  s->rested = PETSC_TRUE;
  PetscCall(PetscPrintf(s->comm, "stage %s: nothing presses; all pairs are open\n", StagesGet(s, s->stage)->name));
  PetscFunctionReturn(0);
}

/* Keeps the factorisation of the call before where no parameter of the bodies has changed since. kappa stays with it;
   the laws of the pairs, whose k is k_n / kappa, are set anew. */
static PetscErrorCode StaticsFactor(Statics s)
{
  const OperatorsParameter *parameters;
  PetscInt                  n;
  PetscBool                 same = s->factored ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(s->operators, &n, &parameters));
  if (!s->factored) PetscCall(PetscMalloc1(s->n_parameters, &s->factored));
  for (PetscInt i = 0; i < s->n_parameters; i++) {
    if (same && parameters[i].body && s->p[i] != s->factored[i]) same = PETSC_FALSE;
    s->factored[i] = s->p[i];
  }
  if (!same) {
    s->n_factored++;
    PetscCall(ComplianceDestroy(&s->compliance));
    PetscCall(ComplianceCreate(s->operators, s->p, &s->rows, s->dense, &s->progress, &s->compliance));
  }
  PetscCall(PairRowsSetLaws(s->operators, s->p, s->compliance.kappa, &s->rows));
  PetscFunctionReturn(0);
}

/* Rows of the contacts that slide in a stage, from those kept, or made. Each has a factorisation of its own. The
   statuses of the pairs stay, as far as the new rows have them. */
static PetscErrorCode StageSetLayout(Statics s, const Stage *stage)
{
  const size_t size  = (size_t)s->rows.n_interfaces * sizeof(PetscBool);
  StageRows    found = {.factored = NULL};
  PetscInt     at    = -1;

  PetscFunctionBeginUser;
  if (!memcmp(stage->slides, s->rows.slides, size)) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < s->n_kept; i++)
    if (!memcmp(stage->slides, s->kept[i].rows.slides, size)) at = i;
  if (at < 0) {
    PetscCall(PairRowsCreate(s->operators, PETSC_FALSE, stage, &found.rows));
    found.rows.worn = s->worn;
    PetscCall(PetscRealloc((size_t)(s->n_kept + 1) * sizeof(*s->kept), &s->kept));
    at = s->n_kept++;
  } else {
    found = s->kept[at];
  }
  s->kept[at]   = (StageRows){s->rows, s->compliance, s->factored};
  s->rows       = found.rows;
  s->compliance = found.compliance;
  s->factored   = found.factored;
  for (PetscInt p = 0; p < s->rows.n_pairs; p++)
    if (s->rows.law[p].d == 1 && s->status[p] == CONTACT_STICK) s->status[p] = CONTACT_SLIP;
  PetscFunctionReturn(0);
}

/* Forces l (m) and displacements w (m) of the rows as the stage before left them */
static PetscErrorCode StageTakeUp(Statics s, PetscReal l[], PetscReal **w)
{
  const PairRows *rows = &s->rows;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(rows->n, w));
  PetscCall(ComplianceGetRows(&s->compliance, s->u, *w));
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    l[rows->first[p]] = s->state[p].lambda_n / s->compliance.kappa;
    for (PetscInt i = 1; i < rows->law[p].d; i++)
      l[rows->first[p] + i] = -s->state[p].lambda_t[i - 1] / s->compliance.kappa;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode StageSolve(Statics s, PetscInt k, Vec f0, PetscReal *size, Vec *f)
{
  const Stage *stage = StagesGet(s, k);
  PetscReal   *l, *w0 = NULL, end;
  PetscBool    pressed;
  char         loads[160] = "the loads";

  PetscFunctionBeginUser;
  s->stage = k;
  if (stage->name) PetscCall(PetscSNPrintf(loads, sizeof(loads), "the loads up to -stages %s", stage->name));
  PetscCall(StageSetLayout(s, stage));
  if ((!k || s->rested) && s->n_stages) StaticsCloseAll(s);
  s->rested = PETSC_FALSE;
  PetscCall(PairRowsSetMoved(s->model, StagesGet(s, k - 1), stage, &s->rows));
  PetscCall(StaticsCreateLoad(s->operators, s->p, stage, f, &end));
  *size = PetscMax(*size, end);
  PetscCall(StageIsPressed(s, stage, *f, &pressed));
  PetscCall(PetscCalloc1(s->rows.n, &l));
  PetscCall(StaticsFactor(s));
  if (k) PetscCall(StageTakeUp(s, l, &w0));
  PetscCall(HoldCheck(s->operators, &s->compliance.hold, loads, *f, *size));
  if (!pressed) PetscCall(StageRest(s, l));
  if (pressed)
    PetscCall(EquilibriumSolve(s, &(Active){.rows       = &s->rows,
                                            .compliance = &s->compliance,
                                            .f          = *f,
                                            .f0         = f0,
                                            .w0         = w0,
                                            .size       = *size,
                                            .load_steps = s->load_steps,
                                            .status     = s->status,
                                            .l          = l,
                                            .u          = s->u}));
  s->n_free = s->compliance.hold.n;
  PetscCall(StaticsSetState(s, *f, l));
  PetscCall(PetscFree(l));
  PetscCall(PetscFree(w0));
  PetscFunctionReturn(0);
}
