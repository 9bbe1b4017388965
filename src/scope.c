/* What a run does, as rows ask; what of the scene it does not use */
#include "scope.h"
#include "base/algebra/vec3.h"
#include "base/text.h"

/* What the contacts add: they may have to be pressed for their stiffness, and what is not told where to slide, or
   slides in a later stage, can stick */
static PetscErrorCode ScopeAddContacts(const Scope *s, QuantityRun *run)
{
  const ContactInterface *c;
  PetscInt                n;
  PetscBool               staged;

  PetscFunctionBeginUser;
  PetscCall(ContactGetInterfaces(s->contact, &n, &c));
  PetscCall(StaticsHaveStages(s->statics, &staged));
  if (n) run->does |= RUN_CONTACTS;
  for (PetscInt i = 0; i < n; i++)
    if (c[i].identify) run->does |= RUN_IDENTIFY | RUN_EQUILIBRIUM;
  for (PetscInt i = 0; i < n && run->does & RUN_EQUILIBRIUM; i++)
    if (staged || Vec3Dot(c[i].slip, c[i].slip) + Vec3Dot(c[i].rotation, c[i].rotation) == 0) run->does |= RUN_HOLDS;
  PetscFunctionReturn(0);
}

/* How it runs in time */
static PetscErrorCode ScopeAddTime(const Scope *s, QuantityRun *run)
{
  PetscBool pairs, reduced, springs;

  PetscFunctionBeginUser;
  PetscCall(DynamicsNeedsPairs(s->dynamics, &pairs));
  PetscCall(ReducedIsAsked(s->reduced, &reduced));
  PetscCall(ReducedHasSprings(s->reduced, &springs));
  if (pairs || reduced) run->does |= RUN_EQUILIBRIUM;
  run->does |= reduced ? RUN_REDUCED | RUN_FACTORS : RUN_MESH;
  if (springs) run->does |= RUN_SPRINGS;
  PetscFunctionReturn(0);
}

/* Whether the eigenvalue problems may have damping, and whether they may have none, as far as options tell */
static PetscErrorCode ScopeAddDamping(const Scope *s, QuantityRun *run)
{
  const ModelScene       *scene;
  const ContactInterface *interfaces = NULL;
  PetscInt                n          = 0;
  PetscBool               sure;

  PetscFunctionBeginUser;
  PetscCall(OperatorsHaveDamping(s->operators, &sure));
  if (s->model) PetscCall(ModelGetScene(s->model, &scene));
  for (PetscInt i = 0; s->model && i < scene->n_parts; i++)
    if (scene->parts[i].alpha > 0 || scene->parts[i].beta > 0 || scene->parts[i].spin.rate != 0 ||
        scene->parts[i].law.kind)
      sure = PETSC_TRUE;
  for (PetscInt i = 0; s->model && i < scene->n_dashpots; i++)
    if (Vec3Dot(scene->dashpots[i].value, scene->dashpots[i].value) > 0) sure = PETSC_TRUE;
  for (PetscInt i = 0; s->model && i < scene->n_joints + scene->n_points; i++) {
    const Joint *joint = i < scene->n_joints ? &scene->joints[i] : &scene->points[i - scene->n_joints];

    for (int d = 0; d < 6; d++)
      if (joint->viscosity[d] > 0) sure = PETSC_TRUE;
  }
  run->does |= sure ? RUN_DAMPED : RUN_UNDAMPED;
  if (s->contact) PetscCall(ContactGetInterfaces(s->contact, &n, &interfaces));
  for (PetscInt i = 0; i < n; i++)
    if (interfaces[i].damping) run->does |= RUN_DAMPED;
  PetscFunctionReturn(0);
}

/* Which of SLEPc's solvers are needed. Without a band the undamped modes tell how far to look. */
static PetscErrorCode ScopeAddSolvers(const Scope *s, QuantityRun *run)
{
  PetscBool has_band, may_project, may_pep;

  PetscFunctionBeginUser;
  PetscCall(ModesHaveBand(s->linear, &has_band));
  PetscCall(ModesGetRoutes(s->linear, &may_project, &may_pep));
  if (run->does & RUN_UNDAMPED || !has_band || may_project) run->does |= RUN_EPS;
  if (run->does & RUN_DAMPED && (may_pep || run->does & RUN_UNDAMPED)) run->does |= RUN_PEP;
  PetscFunctionReturn(0);
}

PetscErrorCode ScopeGetRun(MPI_Comm comm, const Scope *s, QuantityRun *run)
{
  const ModelScene *scene;
  PetscBool         sliding, fields, named;

  PetscFunctionBeginUser;
  *run = (QuantityRun){comm, s->analysis, s->does};
  PetscCall(ModesGetContact(s->linear, &sliding));
  if (s->does & RUN_LINEAR) {
    run->does |= sliding ? RUN_FACTORS | RUN_EQUILIBRIUM | RUN_SLIDING : RUN_FACTORS;
    PetscCall(ScopeAddDamping(s, run));
    PetscCall(ScopeAddSolvers(s, run));
  }
  if (s->does & RUN_IN_TIME) PetscCall(ScopeAddTime(s, run));
  if (s->contact) PetscCall(ScopeAddContacts(s, run));
  if (run->does & RUN_EQUILIBRIUM) run->does |= RUN_FACTORS;
  PetscCall(ResultsWantFields(s->results, &fields));
  if (fields) run->does |= RUN_FIELDS;
  PetscCall(OperatorsHaveNodes(s->operators, &named));
  if (named) run->does |= RUN_NAMED;
  if (!s->model) PetscFunctionReturn(0);
  run->does |= RUN_BODIES;
  PetscCall(ModelGetScene(s->model, &scene));
  if (Vec3Dot(scene->gravity, scene->gravity) > 0) run->does |= RUN_WEIGHT;
  PetscFunctionReturn(0);
}

/* The option of the first part or matrix whose stiffness depends on the frequency, empty for none; but for those of
   parts that are Maxwell branches where `branches` says so */
static PetscErrorCode ScopeNameLaw(const Scope *s, PetscBool branches, size_t size, char text[], PetscBool *hysteretic)
{
  const ModelScene *scene;
  const char       *option;
  char              name[32];

  PetscFunctionBeginUser;
  PetscCall(OperatorsNameLaw(s->operators, size, text, hysteretic));
  if (s->model) PetscCall(ModelGetScene(s->model, &scene));
  for (PetscInt i = 0; s->model && i < scene->n_parts && !text[0]; i++) {
    const Part *p = &scene->parts[i];

    if (!p->law.kind || (branches && ViscoelasticBranches(&p->law))) continue;
    *hysteretic = p->law.kind == VISCOELASTIC_HYSTERETIC ? PETSC_TRUE : PETSC_FALSE;
    PetscCall(ViscoelasticName(&p->law, -1, &option, name));
    PetscCall(PetscSNPrintf(text, size, "-%s_%s", p->name, option));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ScopeCheckLaws(MPI_Comm comm, const Scope *s)
{
  const char *folder;
  char        option[256];
  PetscBool   hysteretic, branches = s->uses & USES_BRANCHES ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(ScopeNameLaw(s, PETSC_FALSE, sizeof(option), option, &hysteretic));
  PetscCall(OperatorsGetSave(s->operators, &folder));
  PetscCheck(!option[0] || !folder[0], comm, PETSC_ERR_USER_INPUT,
             "-operators_save %s: %s makes the stiffness depend on the frequency, which no matrix has; leave one of "
             "them out",
             folder, option);
  if (s->uses & USES_LAWS) PetscFunctionReturn(0);
  PetscCall(ScopeNameLaw(s, branches, sizeof(option), option, &hysteretic));
  PetscCheck(
    !option[0], comm, PETSC_ERR_USER_INPUT,
    "%s makes the stiffness depend on the frequency, which -analysis %s does not know as yet, only modes, frf, "
    "sweep with -sweep_method full, transient with -..._prony_modulus, and static, which has the static "
    "stiffness; %s",
    option, AnalysisNames[s->analysis],
    hysteretic && s->model ? "give -model_loss_frequency, Hz, for damping that is exact there"
    : branches             ? "it has no equation in time: give a Prony series in its place"
                           : "leave it out, or damp with -..._beta or a -..._kind damping matrix");
  PetscFunctionReturn(0);
}

/* Adds a thing to a list: "load press, probe tip" */
static PetscErrorCode IdleAdd(const char kind[], const char name[], size_t size, char text[])
{
  PetscFunctionBeginUser;
  PetscCall(WordsAdd(text, text[0] ? ", " : "", size));
  PetscCall(WordsAdd(text, kind, size));
  PetscCall(WordsAdd(text, name, size));
  PetscFunctionReturn(0);
}

PetscErrorCode ScopeView(const Scope *s, PetscViewer viewer)
{
  const ModelScene *scene;
  QuantityRun       run;
  PetscBool         loads, places, damping, spin; /* which of them are not used */
  char              text[1024] = "";

  PetscFunctionBeginUser;
  PetscCall(ScopeGetRun(PETSC_COMM_SELF, s, &run));
  PetscCall(ModelGetScene(s->model, &scene));
  loads   = s->uses & USES_LOADS || run.does & RUN_EQUILIBRIUM ? PETSC_FALSE : PETSC_TRUE;
  places  = s->uses & USES_PLACES ? PETSC_FALSE : PETSC_TRUE;
  damping = s->uses & USES_DAMPING ? PETSC_FALSE : PETSC_TRUE;
  spin    = s->uses & USES_SPIN ? PETSC_FALSE : PETSC_TRUE;
  if (loads && Vec3Dot(scene->gravity, scene->gravity) > 0) PetscCall(IdleAdd("gravity", "", sizeof(text), text));
  for (PetscInt i = 0; i < scene->n_loads && loads; i++)
    PetscCall(IdleAdd("load ", scene->loads[i].name, sizeof(text), text));
  for (PetscInt i = 0; i < scene->n_probes && places; i++)
    PetscCall(IdleAdd("probe ", scene->probes[i].name, sizeof(text), text));
  for (PetscInt i = 0; i < scene->n_circles && places; i++)
    PetscCall(IdleAdd("circle ", scene->circles[i].name, sizeof(text), text));
  for (PetscInt i = 0; i < scene->n_dashpots && damping; i++)
    PetscCall(IdleAdd("dashpot ", scene->dashpots[i].name, sizeof(text), text));
  for (PetscInt i = 0; i < scene->n_parts && damping; i++)
    if (scene->parts[i].alpha > 0 || scene->parts[i].beta > 0)
      PetscCall(IdleAdd("damping of ", scene->parts[i].name, sizeof(text), text));
  for (PetscInt i = 0; i < scene->n_parts && spin; i++)
    if (scene->parts[i].spin.rate != 0) PetscCall(IdleAdd("spin of ", scene->parts[i].name, sizeof(text), text));
  if (text[0])
    PetscCall(PetscViewerASCIIPrintf(viewer, "  not used by -analysis %s: %s\n", AnalysisNames[s->analysis], text));
  PetscFunctionReturn(0);
}

PetscErrorCode ScopeNeedsAreas(Contact contact, PetscBool *areas)
{
  const ContactInterface *c;
  PetscInt                n = 0;

  PetscFunctionBeginUser;
  *areas = PETSC_FALSE;
  if (contact) PetscCall(ContactGetInterfaces(contact, &n, &c));
  for (PetscInt i = 0; i < n; i++)
    if (FrictionNeedsPressure(&c[i].friction)) *areas = PETSC_TRUE;
  PetscFunctionReturn(0);
}
