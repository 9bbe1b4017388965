/* What stands on the command line and nothing in this analysis has a use for: see base/options/arguments.c */
#include "scope.h"
#include "base/algebra/vec3.h"

/* Whether something asks for an equilibrium */
static PetscErrorCode ScopeNeedsStatics(const Scope *s, PetscBool *needs)
{
  const ContactInterface *interfaces = NULL;
  PetscInt                n          = 0;
  PetscBool               reduced;

  PetscFunctionBeginUser;
  *needs = PETSC_TRUE;
  if (s->modes) PetscCall(ModesGetContact(s->linear, needs));
  if (s->transient) PetscCall(DynamicsNeedsPairs(s->dynamics, needs));
  if (s->transient) PetscCall(ReducedIsAsked(s->reduced, &reduced));
  if (s->transient && reduced) *needs = PETSC_TRUE;
  if (s->contact) PetscCall(ContactGetInterfaces(s->contact, &n, &interfaces));
  for (PetscInt i = 0; i < n; i++)
    if (interfaces[i].identify) *needs = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* What an interface reads of sliding that it does not do: in time of a speed without a direction */
static PetscErrorCode ScopeCheckSliding(MPI_Comm comm, const Scope *s, const ContactInterface *c)
{
  const PetscBool turns = Vec3Dot(c->rotation, c->rotation) > 0 ? PETSC_TRUE : PETSC_FALSE;
  char            still[256];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(still, sizeof(still), "not used where nothing slides as told: give -%s_slip or -%s_rotation",
                          c->name, c->name));
  if (s->transient && !turns && Vec3Dot(c->slip, c->slip) == 0)
    PetscCall(
      OptionsRefuseOf(comm, c->name, c->speed > 0 ? "speed ramp ramp_shape delay" : "ramp ramp_shape delay", still));
  PetscFunctionReturn(0);
}

/* What an interface reads and this analysis has no use for */
static PetscErrorCode ScopeCheckContact(MPI_Comm comm, const Scope *s, const ContactInterface *c)
{
  static const char steady[]   = "not used by -analysis static: the loads tell the forces, and nothing moves";
  const PetscBool   constraint = c->law == CONTACT_CONSTRAINT ? PETSC_TRUE : PETSC_FALSE;
  char              exact[256], stiff[256], lu[256], linear[256];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(exact, sizeof(exact),
                          "not used by -analysis %s, whose contact is exact: no penalty, no linearisation",
                          s->analysis));
  PetscCall(
    PetscSNPrintf(stiff, sizeof(stiff), "not used with -%s_law constraint, which is as stiff as can be", c->name));
  PetscCall(PetscSNPrintf(lu, sizeof(lu), "not used with -%s_law constraint, which needs LU", c->name));
  PetscCall(PetscSNPrintf(linear, sizeof(linear), "not used by modes without -%s_friction_damping", c->name));
  PetscCall(ScopeCheckSliding(comm, s, c));
  if (s->transient) {
    if (!constraint) PetscCall(OptionsRefuseOf(comm, c->name, "law", exact));
    PetscCall(OptionsRefuseOf(comm, c->name, "kn kn_per_area kt kt_per_area friction_damping force", exact));
    PetscFunctionReturn(0);
  }
  if (constraint) PetscCall(OptionsRefuseOf(comm, c->name, c->identify ? "kn_per_area" : "kn kn_per_area", stiff));
  if (!s->modes) {
    PetscCall(OptionsRefuseOf(comm, c->name, "friction_damping force kt kt_per_area", steady));
    if (!FrictionNeedsSpeed(&c->friction)) PetscCall(OptionsRefuseOf(comm, c->name, "speed", steady));
    PetscCall(FrictionRefuseSlopes(comm, c->name, &c->friction, steady));
    PetscFunctionReturn(0);
  }
  if (constraint) PetscCall(OptionsRefuse(comm, "-operators_factors", lu));
  if (!c->damping)
    PetscCall(OptionsRefuseOf(comm, c->name, FrictionVaries(&c->friction) ? "force" : "force speed", linear));
  PetscFunctionReturn(0);
}

/* Raises an error for a density that has no weight; a scene that the command line alone tells of must have one */
static PetscErrorCode ScopeCheckDensity(MPI_Comm comm, const ModelScene *scene)
{
  PetscBool in_file;
  char      option[256];

  PetscFunctionBeginUser;
  if (Vec3Dot(scene->gravity, scene->gravity) > 0) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < scene->n_parts; i++) {
    PetscCall(PetscSNPrintf(option, sizeof(option), "-%s_density", scene->parts[i].name));
    PetscCall(OptionsFilesGive(comm, option, &in_file));
    if (in_file) PetscCall(OptionsRefuse(comm, option, "not used by -analysis static without -model_gravity"));
  }
  PetscFunctionReturn(0);
}

/* Whether the eigenvalue problems may have damping, and whether they may have none */
static PetscErrorCode ScopeGetDamping(const Scope *s, PetscBool *damped, PetscBool *undamped)
{
  const ModelScene       *scene;
  const ContactInterface *interfaces = NULL;
  PetscInt                n          = 0;
  PetscBool               sure, varied, real;

  PetscFunctionBeginUser;
  PetscCall(OperatorsHaveDamping(s->operators, &sure));
  if (s->model) PetscCall(ModelGetScene(s->model, &scene));
  for (PetscInt i = 0; s->model && i < scene->n_parts; i++)
    if (scene->parts[i].alpha > 0 || scene->parts[i].beta > 0 || scene->parts[i].spin.rate != 0) sure = PETSC_TRUE;
  for (PetscInt i = 0; s->model && i < scene->n_dashpots; i++)
    if (Vec3Dot(scene->dashpots[i].value, scene->dashpots[i].value) > 0) sure = PETSC_TRUE;
  for (PetscInt i = 0; s->model && i < scene->n_joints + scene->n_points; i++) {
    const Joint *joint = i < scene->n_joints ? &scene->joints[i] : &scene->points[i - scene->n_joints];

    for (int d = 0; d < 6; d++)
      if (joint->viscosity[d] > 0) sure = PETSC_TRUE;
  }
  PetscCall(SweepGetDamping(s->varied, &varied, &real));
  *undamped = !sure || (s->sweep && (varied || real)) ? PETSC_TRUE : PETSC_FALSE;
  *damped   = sure || (s->sweep && varied) ? PETSC_TRUE : PETSC_FALSE;
  if (s->contact) PetscCall(ContactGetInterfaces(s->contact, &n, &interfaces));
  for (PetscInt i = 0; i < n; i++)
    if (interfaces[i].damping) *damped = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Options of the eigensolver that is not needed */
static PetscErrorCode ScopeCheckEigensolver(MPI_Comm comm, const Scope *s)
{
  static const char pep_alone[] = "not used by -modes_damping pep in a band, which -pep_* solves";
  static const char unsolved[]  = "not used by -modes_damping pep in a band, which LU solves";
  PetscBool         damped, undamped, has_band, may_project, may_pep;

  PetscFunctionBeginUser;
  PetscCall(ScopeGetDamping(s, &damped, &undamped));
  PetscCall(ModesHaveBand(s->linear, &has_band)); /* without a band the undamped modes tell how far to look */
  PetscCall(ModesGetRoutes(s->linear, &may_project, &may_pep));
  if (!undamped && has_band && !may_project) {
    PetscCall(OptionsRefusePrefix(comm, "-eps_", pep_alone));
    PetscCall(OptionsRefuse(comm, "-operators_factors", unsolved));
  }
  if (!damped) PetscCall(OptionsRefusePrefix(comm, "-pep_", "not used by modes without damping, which -eps_* solves"));
  if (!undamped && !may_pep)
    PetscCall(OptionsRefusePrefix(comm, "-pep_", "not used by -modes_damping project, which -eps_* solves"));
  PetscFunctionReturn(0);
}

static const char scope_still[] = "not used by -analysis static, where nothing moves and nothing is damped";

/* What a bushing or a point reads and a scene at rest has no use for */
static PetscErrorCode ScopeCheckJoint(MPI_Comm comm, const ModelScene *scene, const Joint *joint)
{
  PetscFunctionBeginUser;
  PetscCall(OptionsRefuseOf(comm, joint->name, "viscosity turn_viscosity", scope_still));
  if (!joint->is_point) PetscFunctionReturn(0);
  PetscCall(OptionsRefuseOf(comm, joint->name, "inertia", scope_still));
  if (Vec3Dot(scene->gravity, scene->gravity) == 0)
    PetscCall(OptionsRefuseOf(comm, joint->name, "mass", "not used by -analysis static without -model_gravity"));
  PetscFunctionReturn(0);
}

/* What the model reads of motion and damping, which a scene at rest has no use for */
static PetscErrorCode ScopeCheckStill(MPI_Comm comm, const ModelScene *scene)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < scene->n_parts; i++)
    PetscCall(OptionsRefuseOf(comm, scene->parts[i].name, "alpha beta loss_factor", scope_still));
  PetscCall(ScopeCheckDensity(comm, scene));
  for (PetscInt i = 0; i < scene->n_dashpots; i++)
    PetscCall(OptionsRefuseOf(comm, scene->dashpots[i].name, scene->dashpots[i].quantity, scope_still));
  for (PetscInt i = 0; i < scene->n_joints; i++) PetscCall(ScopeCheckJoint(comm, scene, &scene->joints[i]));
  for (PetscInt i = 0; i < scene->n_points; i++) PetscCall(ScopeCheckJoint(comm, scene, &scene->points[i]));
  PetscFunctionReturn(0);
}

/* What of the model a run does not use, though a file may hold it for others */
typedef struct {
  PetscBool loads; /* and gravity: modes with all pairs closed need no equilibrium */
  PetscBool places /* probes and circles: nothing moves, or only modes are asked for */, damping, spin;
} ScopeIdle;

static ScopeIdle ScopeGetIdle(const Scope *s, PetscBool statics)
{
  return (ScopeIdle){
    .loads   = s->modes && !statics ? PETSC_TRUE : PETSC_FALSE,
    .places  = !s->transient && !s->frf ? PETSC_TRUE : PETSC_FALSE,
    .damping = !s->transient && !s->modes ? PETSC_TRUE : PETSC_FALSE,
    .spin    = !s->modes ? PETSC_TRUE : PETSC_FALSE,
  };
}

/* What the model reads for other analyses */
static PetscErrorCode ScopeCheckModel(MPI_Comm comm, const Scope *s, PetscBool statics)
{
  static const char all[]      = "not used by modes with all pairs closed; give -modes_contact static";
  static const char no_probe[] = "not used without -analysis transient or frf";
  static const char unloaded[] = "not used by -analysis static, which is found without the load of the spin";
  const ScopeIdle   idle       = ScopeGetIdle(s, statics);
  const ModelScene *scene;
  char              turning[160];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(turning, sizeof(turning),
                          "not used by -analysis %s; a contact's -..._kinematics turning turns its master",
                          s->analysis));
  PetscCall(ModelGetScene(s->model, &scene));
  if (idle.loads) PetscCall(OptionsRefuse(comm, "-model_gravity", all));
  if (idle.damping) PetscCall(ScopeCheckStill(comm, scene));
  for (PetscInt i = 0; i < scene->n_parts && idle.spin; i++)
    PetscCall(OptionsRefuseOf(comm, scene->parts[i].name, "spin", s->transient ? turning : unloaded));
  for (PetscInt i = 0; i < scene->n_probes && idle.places; i++)
    PetscCall(OptionsRefuseOf(comm, scene->probes[i].name, "at part", no_probe));
  for (PetscInt i = 0; i < scene->n_circles && idle.places; i++)
    PetscCall(OptionsRefuseOf(comm, scene->circles[i].name, "radius count part face centre tolerance", no_probe));
  for (PetscInt i = 0; i < scene->n_loads && idle.loads; i++)
    PetscCall(OptionsRefuseOf(comm, scene->loads[i].name, "force pressure set point moment", all));
  PetscFunctionReturn(0);
}

/* What runs in time leave out: what TS reads for integrators that are implicit or choose their steps, another mass */
static PetscErrorCode ScopeCheckIntegrator(MPI_Comm comm, const Scope *s)
{
  static const char others[] = "-ts_rtol -ts_atol -ts_adapt_ -ts_max_reject -ts_max_snes_ -ts_error_if_ -ts_fd_color "
                               "-ts_use_splitrhs -ts_time_span -ts_rhs_jacobian_";
  char              why[160];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(why, sizeof(why), "not used, -analysis %s takes explicit steps of one length", s->analysis));
  PetscCall(OptionsRefusePrefix(comm, others, why));
  PetscCall(PetscSNPrintf(why, sizeof(why), "not used by -analysis %s, whose mass is lumped", s->analysis));
  PetscCall(OptionsRefuse(comm, "-operators_mass", why));
  PetscCall(OptionsRefuse(comm, "-modes_target -modes_count",
                          "not used by -dynamics_model reduced, which compares the modes of -modes_band"));
  PetscFunctionReturn(0);
}

/* What statics read and this equilibrium has no use for; slides = every contact is told where to */
static PetscErrorCode ScopeCheckEquilibrium(MPI_Comm comm, const Scope *s, PetscBool identify, PetscBool slides)
{
  PetscFunctionBeginUser;
  if (!identify) PetscCall(OptionsRefuse(comm, "-static_identify_steps", "not used without -..._kn identify"));
  if (slides)
    PetscCall(OptionsRefuse(comm, "-static_load_steps",
                            "not used where every contact slides as told: no pair can stick, and the way of the loads "
                            "makes no difference"));
  if (s->modes || s->transient)
    PetscCall(OptionsRefuse(comm, "-static_view_kkt", "printed by -analysis static alone; leave it out"));
  if (!s->modes)
    PetscCall(OptionsRefuse(comm, "-static_rows -static_geometric -static_follower",
                            "used by modes, sweeps and frequency responses about the sliding state"));
  PetscFunctionReturn(0);
}

/* What every reader reads, and this analysis has no use for */
static PetscErrorCode ScopeCheckRead(MPI_Comm comm, const Scope *s, PetscBool statics)
{
  const ContactInterface *interfaces = NULL;
  PetscInt                n          = 0;
  PetscBool               identify = PETSC_FALSE, slides = PETSC_TRUE; /* all are told where to */

  PetscFunctionBeginUser;
  if (s->model) PetscCall(ScopeCheckModel(comm, s, statics));
  if (s->contact) PetscCall(ContactGetInterfaces(s->contact, &n, &interfaces));
  for (PetscInt i = 0; i < n; i++) {
    const ContactInterface *c = &interfaces[i];

    PetscCall(ScopeCheckContact(comm, s, c));
    if (c->identify) identify = PETSC_TRUE;
    if (Vec3Dot(c->slip, c->slip) + Vec3Dot(c->rotation, c->rotation) == 0) slides = PETSC_FALSE;
  }
  PetscCall(ScopeCheckEquilibrium(comm, s, identify, slides));
  if (s->sweep || s->transient)
    PetscCall(OptionsRefuse(comm, "-modes_filters", "written by -analysis modes and frf alone; leave it out"));
  if (s->sweep || s->transient || s->frf)
    PetscCall(OptionsRefuse(comm, "-modes_components", "written by -analysis modes alone; leave it out"));
  if (s->frf)
    PetscCall(OptionsRefuse(comm, "-modes_growth",
                            "not used by -analysis frf, whose residual term stands for the modes left out"));
  if (s->modes && !s->frf) PetscCall(ScopeCheckEigensolver(comm, s)); /* which takes both */
  if (s->transient) PetscCall(ScopeCheckIntegrator(comm, s));
  if (s->modes) PetscFunctionReturn(0);
  if (!s->transient) PetscCall(OptionsRefuse(comm, "-operators_mass", "not used by -analysis static"));
  PetscCall(OptionsRefuse(comm, "-operators_factors", "used by modes, sweeps and frequency responses"));
  PetscFunctionReturn(0);
}

PetscErrorCode ScopeCheck(MPI_Comm comm, const Scope *s, OptionsClaims claims)
{
  OptionsReader readers[N_READERS] = {
    [READER_ANY]       = {PETSC_TRUE, "every analysis"},
    [READER_STATICS]   = {PETSC_FALSE, "-analysis static, and modes, sweeps and transients about the sliding state"},
    [READER_MODES]     = {s->modes, "-analysis modes, sweep and frf"},
    [READER_FACTOR]    = {s->modes, "analyses that factorise a matrix"},
    [READER_ITERATIVE] = {PETSC_FALSE,
                          "an iterative -st_ksp_type such as gmres, since a factorised matrix needs no iteration"},
    [READER_SWEEP]     = {s->sweep, "-analysis sweep"},
    [READER_FRF]       = {s->frf, "-analysis frf"},
    [READER_DYNAMICS]  = {s->transient, "-analysis transient"},
    [READER_MAP]       = {s->map, "-analysis map"},
    [READER_CYCLE]     = {s->cycle, "-analysis cycle"},
  };
  PetscBool statics, reduced;

  PetscFunctionBeginUser;
  PetscCall(ReducedIsAsked(s->reduced, &reduced));
  if (s->transient && reduced) readers[READER_MODES].in_force = readers[READER_FACTOR].in_force = PETSC_TRUE;
  PetscCall(ScopeNeedsStatics(s, &statics));
  readers[READER_STATICS].in_force = statics;
  if (statics) readers[READER_FACTOR].in_force = PETSC_TRUE;
  if (!readers[READER_FACTOR].in_force) readers[READER_ITERATIVE] = readers[READER_FACTOR];
  if (!readers[READER_FACTOR].in_force && !s->cycle)
    PetscCall(OptionsRefuse(comm, "-squeal_memory", "not used where no matrix is factorised, as by a run in time"));
  PetscCall(OptionsClaimsCheck(comm, claims, readers, s->analysis));
  PetscCall(ScopeCheckRead(comm, s, statics));
  PetscFunctionReturn(0);
}

/* Adds a thing to a list: "load press, probe tip" */
static PetscErrorCode IdleAdd(const char kind[], const char name[], size_t size, char text[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscStrlcat(text, text[0] ? ", " : "", size));
  PetscCall(PetscStrlcat(text, kind, size));
  PetscCall(PetscStrlcat(text, name, size));
  PetscFunctionReturn(0);
}

PetscErrorCode ScopeView(const Scope *s, PetscViewer viewer)
{
  const ModelScene *scene;
  PetscBool         statics;
  ScopeIdle         idle;
  char              text[1024] = "";

  PetscFunctionBeginUser;
  PetscCall(ScopeNeedsStatics(s, &statics));
  PetscCall(ModelGetScene(s->model, &scene));
  idle = ScopeGetIdle(s, statics);
  if (idle.loads && Vec3Dot(scene->gravity, scene->gravity) > 0) PetscCall(IdleAdd("gravity", "", sizeof(text), text));
  for (PetscInt i = 0; i < scene->n_loads && idle.loads; i++)
    PetscCall(IdleAdd("load ", scene->loads[i].name, sizeof(text), text));
  for (PetscInt i = 0; i < scene->n_probes && idle.places; i++)
    PetscCall(IdleAdd("probe ", scene->probes[i].name, sizeof(text), text));
  for (PetscInt i = 0; i < scene->n_circles && idle.places; i++)
    PetscCall(IdleAdd("circle ", scene->circles[i].name, sizeof(text), text));
  for (PetscInt i = 0; i < scene->n_dashpots && idle.damping; i++)
    PetscCall(IdleAdd("dashpot ", scene->dashpots[i].name, sizeof(text), text));
  for (PetscInt i = 0; i < scene->n_parts && idle.damping; i++)
    if (scene->parts[i].alpha > 0 || scene->parts[i].beta > 0)
      PetscCall(IdleAdd("damping of ", scene->parts[i].name, sizeof(text), text));
  for (PetscInt i = 0; i < scene->n_parts && idle.spin; i++)
    if (scene->parts[i].spin.rate != 0) PetscCall(IdleAdd("spin of ", scene->parts[i].name, sizeof(text), text));
  if (text[0]) PetscCall(PetscViewerASCIIPrintf(viewer, "  not used by -analysis %s: %s\n", s->analysis, text));
  PetscFunctionReturn(0);
}
