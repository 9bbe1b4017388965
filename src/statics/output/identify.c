/*
   Contact stiffness by pressing, after section 2.1 of the seed paper: the load is raised in equal steps, contact exact
   and without friction; the normal force F of the interface is drawn against the approach d of the second rows of nodes
   of slave and master, and F = k d + c is fitted by least squares. k is what springs in series between these rows
   amount to: the two element layers, since exact contact itself is rigid. Per pair it is k / number of pairs.
*/
#include "statics/staticsimpl.h"
#include <math.h>

/* Normal force (N) and approach (m) of one step */
typedef struct {
  PetscReal force, approach;
} IdentifyReading;

/* k = sum (d - mean d) (F - mean F) / sum (d - mean d)^2, N/m: differences from the means first, since d carries a
   common offset where there was a gap. The residual is the largest |F - k d - c| over the last force. */
static void IdentifyFit(PetscInt n, const IdentifyReading reading[], StaticsStiffness *k)
{
  PetscReal mean[2] = {0, 0}, product = 0, square = 0, offset;

  for (PetscInt i = 0; i < n; i++) {
    mean[0] += reading[i].approach / (PetscReal)n;
    mean[1] += reading[i].force / (PetscReal)n;
  }
  for (PetscInt i = 0; i < n; i++) {
    product += (reading[i].approach - mean[0]) * (reading[i].force - mean[1]);
    square += PetscSqr(reading[i].approach - mean[0]);
  }
  k->total    = product / square;
  offset      = mean[1] - k->total * mean[0];
  k->residual = 0;
  k->range[0] = reading[0].force;
  k->range[1] = reading[n - 1].force;
  for (PetscInt i = 0; i < n; i++)
    k->residual = PetscMax(k->residual, PetscAbsReal(reading[i].force - k->total * reading[i].approach - offset));
  k->residual /= PetscAbsReal(k->range[1]);
}

/* Exact contact without friction, every pair closed at first */
static void IdentifySetLaws(PairRows *rows, ContactStatus status[])
{
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    rows->law[p].k     = INFINITY;
    rows->law[p].shift = 0;
    rows->law[p].mu    = 0;
    rows->slide[p]     = 0;
    status[p]          = CONTACT_SLIP;
  }
}

/* One step of the ramp: part of the load. Each begins with the statuses of the step before, which `whole` and its
   copy share. */
static PetscErrorCode IdentifyPress(Statics s, const Active *whole, PetscInt interface, Vec d, PetscReal part,
                                    IdentifyReading *reading)
{
  const PairRows *rows = whole->rows;
  Active          step = *whole;
  PetscScalar     approach;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(whole->f, &step.u));
  PetscCall(VecDuplicate(whole->f, &step.f));
  PetscCall(VecCopy(whole->f, step.f));
  PetscCall(VecScale(step.f, part));
  step.size = part * whole->size;
  PetscCall(EquilibriumSolve(s, &step));
  PetscCall(VecDot(d, step.u, &approach));
  reading->approach = PetscRealPart(approach);
  reading->force    = 0;
  for (PetscInt p = 0; p < rows->n_pairs; p++)
    if (rows->pair[p].interface == interface) reading->force += step.compliance->kappa * step.l[rows->first[p]];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &reading->force, 1, MPIU_REAL, MPI_SUM, s->comm));
  PetscCall(VecDestroy(&step.f));
  PetscCall(VecDestroy(&step.u));
  PetscFunctionReturn(0);
}

/* All steps, on rows and a factorisation of their own: without friction nothing holds along the surface */
static PetscErrorCode IdentifyRamp(Statics s, PetscInt interface, Vec d, IdentifyReading reading[])
{
  const ModelScene *scene;
  const Mesh       *mesh;
  PairRows          rows       = {.n = 0};
  Compliance        compliance = {.kappa = 0};
  Active            whole      = {.rows = &rows, .compliance = &compliance, .load_steps = 1};

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(s->model, &mesh));
  PetscCheck(!mesh->prescribed, s->comm, PETSC_ERR_USER_INPUT,
             "-contact_kn identify presses with the -loads alone: leave -motions out, and give the stiffness found");
  PetscCall(ModelGetScene(s->model, &scene));
  for (PetscInt i = 0; i < scene->n_loads; i++)
    PetscCheck(
      !scene->loads[i].has_tension, s->comm, PETSC_ERR_SUP,
      "-contact_kn identify does not know of bolts under a tension, and there is -loads %s: give the stiffness",
      scene->loads[i].name);
  PetscCall(StaticsCreateLoad(s->operators, s->p, StagesGet(s, StagesCount(s) - 1), &whole.f, &whole.size));
  PetscCheck(whole.size > 0, s->comm, PETSC_ERR_USER_INPUT, "-contact_kn identify presses with the -loads: give some");
  PetscCall(PairRowsCreate(s->operators, PETSC_TRUE, NULL, &rows));
  PetscCall(PetscMalloc1(rows.n_pairs, &whole.status));
  PetscCall(PetscCalloc1(rows.n, &whole.l));
  PetscCall(ComplianceCreate(s->operators, s->p, &rows, s->dense, &s->progress, &compliance));
  IdentifySetLaws(&rows, whole.status);
  PetscCall(HoldCheck(s->operators, &compliance.hold, "the loads of -contact_kn identify", whole.f, whole.size));
  for (PetscInt i = 0; i < s->identify_steps; i++)
    PetscCall(IdentifyPress(s, &whole, interface, d, (PetscReal)(i + 1) / (PetscReal)s->identify_steps, &reading[i]));
  PetscCall(ComplianceDestroy(&compliance));
  PetscCall(PairRowsDestroy(&rows));
  PetscCall(PetscFree(whole.l));
  PetscCall(PetscFree(whole.status));
  PetscCall(VecDestroy(&whole.f));
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsIdentify(Statics s, const PetscReal p[], PetscInt interface, StaticsStiffness *stiffness)
{
  PetscInt         n = 0;
  IdentifyReading *reading;
  Vec              d;

  PetscFunctionBeginUser;
  PetscCall(StaticsSetUp(s, p));
  PetscCall(ContactCreateApproach(s->contact, interface, &d));
  PetscCall(PetscMalloc1(s->identify_steps, &reading));
  PetscCall(IdentifyRamp(s, interface, d, reading));
  for (PetscInt i = 0; i < s->rows.n_pairs; i++) n += s->rows.pair[i].interface == interface;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &n, 1, MPIU_INT, MPI_SUM, s->comm));
  IdentifyFit(s->identify_steps, reading, stiffness);
  stiffness->n_steps  = s->identify_steps;
  stiffness->per_pair = stiffness->total / (PetscReal)n;
  PetscCheck(stiffness->total > 0 && !PetscIsInfOrNanReal(stiffness->total), s->comm, PETSC_ERR_NOT_CONVERGED,
             "-%s_kn identify: the -loads do not press this contact", s->rows.interface[interface].name);
  PetscCall(PetscFree(reading));
  PetscCall(VecDestroy(&d));
  PetscFunctionReturn(0);
}

/* Gives the parameter <contact>_kn its value */
static PetscErrorCode IdentifySetParameter(Statics s, const char contact[], PetscReal value, PetscReal p[])
{
  const OperatorsParameter *parameters;
  PetscInt                  n;
  char                      name[160];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s_kn", contact));
  PetscCall(OperatorsGetParameters(s->operators, &n, &parameters));
  for (PetscInt i = 0; i < n; i++)
    if (!strcmp(parameters[i].name, name)) p[i] = value;
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsIdentifyAll(Statics s, PetscReal p[], PetscViewer viewer)
{
  const ContactInterface *interfaces;
  PetscInt                n = 0;

  PetscFunctionBeginUser;
  if (s->contact) PetscCall(ContactGetInterfaces(s->contact, &n, &interfaces));
  for (PetscInt i = 0; i < n; i++) {
    StaticsStiffness k;

    if (!interfaces[i].identify) continue;
    PetscCall(StaticsIdentify(s, p, i, &k));
    PetscCall(IdentifySetParameter(s, interfaces[i].name, k.per_pair, p));
    PetscCall(
      PetscViewerASCIIPrintf(viewer,
                             "contact %s: k_n identified as %.6g N/m per pair, %.6g N/m in total, from %" PetscInt_FMT
                             " steps of %.6g to %.6g N; largest distance from the line %.2g of the force\n",
                             interfaces[i].name, (double)k.per_pair, (double)k.total, k.n_steps, (double)k.range[0],
                             (double)k.range[1], (double)k.residual));
  }
  PetscFunctionReturn(0);
}
