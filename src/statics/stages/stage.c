/*
   Stages of the loading. A stage names what begins to act in it: loads, motions, the sliding of contacts, and their
   interference; what acts stays, unless a later stage ends it. Of all forces f, prescribed displacements d and
   interferences e of the scene a stage ends with

      f_k = sum_i s_ki f_i + weight,   d_k = sum_i s_ki d_i,   e_k = sum_i s_ki e_i,   s_ki = 0 or 1,

   and is reached from the stage before it along a straight line, in -static_load_steps equal steps. Contacts that a
   stage does not let slide hold by Coulomb's law. Without -stages there is one, in which all acts.
*/
#include "statics/staticsimpl.h"
#include "base/algebra/vec3.h"
#include "base/text.h"

#define STAGE(member) QUANTITY_AT(Stage, member)
#define COUNT(member) .count = offsetof(Stage, member)

static const Quantity rows[] = {
  {"-loads", "loads that begin to act, and stay", NULL, QUANTITY_NAMES, STAGE(loads), COUNT(n_loads)},
  {"-motions", "motions that begin, and stay; before, they hold their set where it is", NULL, QUANTITY_NAMES,
   STAGE(motions), COUNT(n_motions)},
  {"-sliding", "contacts that begin to slide as they are told, and stay; before, they hold by Coulomb's law", NULL,
   QUANTITY_NAMES, STAGE(sliding), COUNT(n_sliding)},
  {"-interferences", "contacts whose interference begins to act, and stays", NULL, QUANTITY_NAMES, STAGE(interferences),
   COUNT(n_interferences)},
  {"-ends", "loads and interferences that cease to act", NULL, QUANTITY_NAMES, STAGE(ends), COUNT(n_ends)},
};

static const QuantityTable stages = {"Stage", "statics.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows,
                                     .in = RUN_EQUILIBRIUM};

/* A stage that changes nothing is a slip of the pen */
static PetscErrorCode StageCheck(MPI_Comm comm, void *owner, void *record)
{
  const Stage *s = record;

  PetscFunctionBeginUser;
  (void)owner;
  PetscCheck(s->n_loads + s->n_motions + s->n_sliding + s->n_interferences + s->n_ends, comm, PETSC_ERR_USER_INPUT,
             "-stages %s changes nothing: give -%s_loads, -%s_motions, -%s_sliding, -%s_interferences or -%s_ends",
             s->name, s->name, s->name, s->name, s->name, s->name);
  PetscFunctionReturn(0);
}

const QuantityList stages_list = {"-stages",
                                  "stages of the loading in their order, each the prefix of what begins in it; all at "
                                  "once without",
                                  sizeof(Stage),
                                  &stages,
                                  StageCheck,
                                  .in = RUN_EQUILIBRIUM};

/* A list of the scene, whose records begin with their names, and what of it acts */
typedef struct {
  const char *list, *what; /* "-loads", "loads" */
  PetscInt    n;
  const void *record;
  size_t      size;
  PetscReal  *acts; /* [n] 0 or 1 */
} StageTarget;

static const char *TargetName(const StageTarget *t, PetscInt i)
{
  return *(char *const *)(const void *)((const char *)t->record + (size_t)i * t->size);
}

/* Lets a name of a list act, or cease to */
static PetscErrorCode StageChange(MPI_Comm comm, const Stage *s, const char option[], const char name[], PetscReal acts,
                                  StageTarget *t)
{
  char     valid[512] = "";
  PetscInt at         = -1;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < t->n; i++) {
    if (!strcmp(TargetName(t, i), name)) at = i;
    PetscCall(WordsAdd(valid, i ? ", " : "", sizeof(valid)));
    PetscCall(WordsAdd(valid, TargetName(t, i), sizeof(valid)));
  }
  PetscCheck(at >= 0, comm, PETSC_ERR_USER_INPUT, "-%s_%s '%s' is none of the %s: %s", s->name, option, name, t->list,
             valid[0] ? valid : "there are none");
  PetscCheck(t->acts[at] != acts, comm, PETSC_ERR_USER_INPUT, "-%s_%s '%s' %s", s->name, option, name,
             acts > 0 ? "acts already: what begins to act stays" : "does not act: no stage before has begun it");
  t->acts[at] = acts;
  PetscFunctionReturn(0);
}

/* What stages do not name would never act */
static PetscErrorCode StagesCheckNamed(Statics s, const StageTarget *t, const PetscBool named[],
                                       const PetscBool wanted[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < t->n; i++)
    PetscCheck(named[i] || (wanted && !wanted[i]), s->comm, PETSC_ERR_USER_INPUT,
               "%s %s %s in none of the -stages: name it in -%s_%s, or in that of another stage", t->list,
               TargetName(t, i), !strcmp(t->what, "sliding") ? "slides as told" : "acts", s->stages[0].name, t->what);
  PetscFunctionReturn(0);
}

/* Room for what acts in a stage of a scene */
static PetscErrorCode StageCreate(const ModelScene *scene, PetscInt n_interfaces, Stage *stage)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(scene->n_loads, &stage->load));
  PetscCall(PetscCalloc1(scene->n_loads, &stage->share));
  PetscCall(PetscCalloc1(scene->n_motions, &stage->motion));
  PetscCall(PetscCalloc1(n_interfaces, &stage->slides));
  PetscCall(PetscCalloc1(n_interfaces, &stage->interference));
  PetscFunctionReturn(0);
}

/* Shares of the loads of a stage that is not solved: bolts under a tension have no shortening yet */
static void StageSetShares(const ModelScene *scene, Stage *stage)
{
  for (PetscInt i = 0; i < scene->n_loads; i++) stage->share[i] = scene->loads[i].has_tension ? 0 : stage->load[i];
}

/* The stage in which all acts */
static PetscErrorCode StageSetWhole(Statics s, const ModelScene *scene, PetscInt n, const ContactInterface c[])
{
  PetscFunctionBeginUser;
  PetscCall(StageCreate(scene, n, &s->whole));
  for (PetscInt i = 0; i < scene->n_loads; i++) s->whole.load[i] = 1;
  StageSetShares(scene, &s->whole);
  for (PetscInt i = 0; i < scene->n_motions; i++) s->whole.motion[i] = 1;
  for (PetscInt i = 0; i < n; i++) s->whole.interference[i] = c[i].interference;
  for (PetscInt i = 0; i < n; i++) s->whole.slides[i] = c[i].slides;
  PetscFunctionReturn(0);
}

#define STAGE_LISTS 4

/* The list of what ends: that of the interferences for a contact, else that of the loads */
static PetscInt StageEnding(const StageTarget target[], const char name[])
{
  for (PetscInt j = 0; j < target[3].n; j++)
    if (!strcmp(TargetName(&target[3], j), name)) return 3;
  return 0;
}

/* What acts in stage k, from the one before it: of contacts first 0 or 1 */
static PetscErrorCode StageSet(Statics s, PetscInt k, StageTarget target[], PetscBool *const named[])
{
  const Stage *stage = &s->stages[k];
  /* what ends first, so that nothing ends in the stage in which it begins */
  const struct {
    const char *option;
    PetscInt    n;
    char      **name;
    PetscInt    list;
    PetscReal   acts;
  } change[] = {{"ends", stage->n_ends, stage->ends, 0, 0},
                {"loads", stage->n_loads, stage->loads, 0, 1},
                {"motions", stage->n_motions, stage->motions, 1, 1},
                {"sliding", stage->n_sliding, stage->sliding, 2, 1},
                {"interferences", stage->n_interferences, stage->interferences, 3, 1}};

  PetscFunctionBeginUser;
  for (size_t c = 0; c < PETSC_STATIC_ARRAY_LENGTH(change); c++)
    for (PetscInt i = 0; i < change[c].n; i++) {
      const PetscInt list = c ? change[c].list : StageEnding(target, change[c].name[i]);
      StageTarget   *t    = &target[list];

      PetscCall(StageChange(s->comm, stage, change[c].option, change[c].name[i], change[c].acts, t));
      for (PetscInt j = 0; j < t->n; j++)
        if (!strcmp(TargetName(t, j), change[c].name[i])) named[list][j] = PETSC_TRUE;
    }
  PetscFunctionReturn(0);
}

/* Takes over what acts after stage k */
static PetscErrorCode StageTake(Statics s, PetscInt k, const StageTarget target[], const ContactInterface c[])
{
  Stage *stage = &s->stages[k];

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(stage->load, target[0].acts, target[0].n));
  PetscCall(PetscArraycpy(stage->motion, target[1].acts, target[1].n));
  for (PetscInt i = 0; i < target[2].n; i++) {
    stage->slides[i]       = (PetscBool)(target[2].acts[i] > 0 && c[i].slides);
    stage->interference[i] = target[3].acts[i] * c[i].interference;
  }
  PetscFunctionReturn(0);
}

/* Whether the first stage names the interference of a contact: that of the meshes acts from the beginning, and it alone
   in a stage of that name */
static PetscBool StageFits(const Stage *first, const char name[])
{
  for (PetscInt i = 0; i < first->n_interferences; i++)
    if (!strcmp(first->interferences[i], name)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* What the options must say of contacts that stages name: along what they slide, and by how much they overlap */
static PetscErrorCode StagesCheckContacts(Statics s, PetscInt n, const ContactInterface c[], PetscBool *const named[],
                                          PetscBool told[], PetscBool overlaps[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    told[i]     = Vec3Dot(c[i].slip, c[i].slip) + Vec3Dot(c[i].rotation, c[i].rotation) > 0 ? PETSC_TRUE : PETSC_FALSE;
    overlaps[i] = c[i].interference != 0 ? PETSC_TRUE : PETSC_FALSE;
    PetscCheck(!named[2][i] || told[i], s->comm, PETSC_ERR_USER_INPUT,
               "a stage lets contact %s slide, and nothing says along what: give -%s_slip x,y,z or -%s_rotation",
               c[i].name, c[i].name, c[i].name);
    PetscCheck(
      !named[3][i] || overlaps[i] || StageFits(s->stages, c[i].name), s->comm, PETSC_ERR_USER_INPUT,
      "a stage lets the interference of contact %s act, which has none: give -%s_interference (m), or name it in "
      "the first stage, in which meshes that overlap are pressed apart",
      c[i].name, c[i].name);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode StagesSetUp(Statics s)
{
  const ModelScene       *scene;
  const ContactInterface *c = NULL;
  PetscInt                n = 0;
  PetscBool              *named[STAGE_LISTS], *told, *overlaps;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(s->model, &scene));
  if (s->contact) PetscCall(ContactGetInterfaces(s->contact, &n, &c));
  PetscCall(StageSetWhole(s, scene, n, c));
  if (!s->n_stages) PetscFunctionReturn(0);
  {
    StageTarget target[STAGE_LISTS] = {
      {"-loads", "loads", scene->n_loads, scene->loads, sizeof(Load), NULL},
      {"-motions", "motions", scene->n_motions, scene->motions, sizeof(PrescribedMotion), NULL},
      {"-contacts", "sliding", n, c, sizeof(ContactInterface), NULL},
      {"-contacts", "interferences", n, c, sizeof(ContactInterface), NULL}};

    for (int i = 0; i < STAGE_LISTS; i++) PetscCall(PetscCalloc1(target[i].n, &target[i].acts));
    for (int i = 0; i < STAGE_LISTS; i++) PetscCall(PetscCalloc1(target[i].n, &named[i]));
    PetscCall(PetscCalloc2(n, &told, n, &overlaps));
    for (PetscInt k = 0; k < s->n_stages; k++) {
      PetscCall(StageCreate(scene, n, &s->stages[k]));
      PetscCall(StageSet(s, k, target, named));
      PetscCall(StageTake(s, k, target, c));
      StageSetShares(scene, &s->stages[k]);
    }
    PetscCall(StagesCheckContacts(s, n, c, named, told, overlaps));
    for (int i = 0; i < STAGE_LISTS; i++)
      PetscCall(StagesCheckNamed(s, &target[i], named[i], i == 2 ? told : i == 3 ? overlaps : NULL));
    for (int i = 0; i < STAGE_LISTS; i++) PetscCall(PetscFree(target[i].acts));
    for (int i = 0; i < STAGE_LISTS; i++) PetscCall(PetscFree(named[i]));
    PetscCall(PetscFree2(told, overlaps));
  }
  PetscFunctionReturn(0);
}

PetscInt StagesCount(Statics s)
{
  return PetscMax(1, s->n_stages);
}

const Stage *StagesGet(Statics s, PetscInt k)
{
  return k < 0 ? NULL : s->n_stages ? &s->stages[k] : &s->whole;
}

PetscErrorCode StageGetMotions(Model model, const Stage *stage, PetscReal **nodal)
{
  const Mesh *mesh;

  PetscFunctionBeginUser;
  *nodal = NULL;
  PetscCall(ModelGetMesh(model, &mesh));
  if (!mesh->prescribed) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(3 * mesh->n_nodes, nodal));
  PetscCall(ModelGetMotions(model, stage ? stage->motion : NULL, *nodal));
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsHaveStages(Statics statics, PetscBool *staged)
{
  PetscFunctionBeginUser;
  *staged = statics->n_stages ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsGetShortening(Statics s, PetscInt load, PetscReal *shortening)
{
  PetscFunctionBeginUser;
  PetscCheck(s->solved, s->comm, PETSC_ERR_ARG_WRONGSTATE, "StaticsSolve() must come first");
  *shortening = StagesGet(s, StagesCount(s) - 1)->share[load];
  PetscFunctionReturn(0);
}

/* In time all loads act from the start on */
PetscErrorCode StaticsCheckLasting(Statics s)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(s->model, &scene));
  for (PetscInt i = 0; i < scene->n_loads; i++)
    PetscCheck(
      StagesGet(s, StagesCount(s) - 1)->load[i] > 0, s->comm, PETSC_ERR_USER_INPUT,
      "-loads %s has ended before the last of the -stages, and acts in time, which would begin out of balance: "
      "leave -stages out, or let it act",
      scene->loads[i].name);
  PetscFunctionReturn(0);
}

static PetscErrorCode NamesFree(PetscInt n, char ***names)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) PetscCall(PetscFree((*names)[i]));
  PetscCall(PetscFree(*names));
  PetscFunctionReturn(0);
}

static PetscErrorCode StageFree(Stage *stage)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(stage->name));
  PetscCall(NamesFree(stage->n_loads, &stage->loads));
  PetscCall(NamesFree(stage->n_motions, &stage->motions));
  PetscCall(NamesFree(stage->n_sliding, &stage->sliding));
  PetscCall(NamesFree(stage->n_interferences, &stage->interferences));
  PetscCall(NamesFree(stage->n_ends, &stage->ends));
  PetscCall(PetscFree(stage->load));
  PetscCall(PetscFree(stage->share));
  PetscCall(PetscFree(stage->motion));
  PetscCall(PetscFree(stage->slides));
  PetscCall(PetscFree(stage->interference));
  PetscFunctionReturn(0);
}

PetscErrorCode StagesDestroy(Statics s)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < s->n_stages; k++) PetscCall(StageFree(&s->stages[k]));
  PetscCall(PetscFree(s->stages));
  PetscCall(StageFree(&s->whole));
  PetscFunctionReturn(0);
}
