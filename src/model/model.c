/*
   Model: life cycle, options, access. The mesh is made on rank 0 (generate.c, import.c), checked there (check.c),
   distributed (partition.c), and then carries its tables (tabulate.c) and the layout of the unknowns (layout.c).
*/
#include "modelimpl.h"

PetscErrorCode ModelCreate(MPI_Comm comm, Model *model)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, model));
  (*model)->comm = comm;
  PetscCall(QuantitiesInit(&model_quantities, *model));
  PetscFunctionReturn(0);
}

/* Where the mesh comes from, its elements, and what concerns all parts */
static PetscErrorCode ModelReadSource(Model model)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesRead(model->comm, &model_quantities, model));
  PetscCheck(!model->has_loss || model->scene.loss_frequency > 0, model->comm, PETSC_ERR_USER_INPUT,
             "-model_loss_frequency %.6g must be positive and finite (Hz)", (double)model->scene.loss_frequency);
  PetscCheck(!model->given || model->from_file || !model->has_file, model->comm, PETSC_ERR_USER_INPUT,
             "-model_mesh %s does nothing with -model_source rig; choose -model_source file", model->file);
  if (model->has_file) model->from_file = model->given = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode ModelSetFromOptions(Model model)
{
  ModelScene *const scene = &model->scene;
  PetscBool         given;

  PetscFunctionBeginUser;
  PetscCall(ModelReadSource(model));
  if (!model->from_file) PetscCall(RigSetFromOptions(model->comm, &model->rig));
  if (model->from_file)
    PetscCall(OptionsDropOf(model->comm, "rig", "the mesh comes from a file, not from the built-in rig"));
  PetscCall(PetscOptionsHasName(NULL, NULL, parts_list.option, &given));
  if (!given && !model->from_file) PetscCall(PetscOptionsSetValue(NULL, parts_list.option, "disc,pad,beam"));
  PetscCall(QuantitiesReadList(model->comm, &parts_list, model, &scene->n_parts, &scene->parts));
  PetscCall(PartsAddLoss(model));
  PetscCall(QuantitiesReadList(model->comm, &supports_list, model, &scene->n_supports, &scene->supports));
  PetscCall(QuantitiesReadList(model->comm, &springs_list, model, &scene->n_springs, &scene->springs));
  PetscCall(QuantitiesReadList(model->comm, &dashpots_list, model, &scene->n_dashpots, &scene->dashpots));
  PetscCall(QuantitiesReadList(model->comm, &joints_list, model, &scene->n_joints, &scene->joints));
  PetscCall(QuantitiesReadList(model->comm, &points_list, model, &scene->n_points, &scene->points));
  PetscCall(QuantitiesReadList(model->comm, &loads_list, model, &scene->n_loads, &scene->loads));
  PetscCall(QuantitiesReadList(model->comm, &motions_list, model, &scene->n_motions, &scene->motions));
  PetscCall(QuantitiesReadList(model->comm, &probes_list, model, &scene->n_probes, &scene->probes));
  PetscCall(QuantitiesReadList(model->comm, &circles_list, model, &scene->n_circles, &scene->circles));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelVisit(Model model, const QuantityVisitor *visitor)
{
  ModelScene *s = &model->scene;

  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisit(visitor, &model_quantities, NULL, model, NULL));
  if (!model->from_file) PetscCall(QuantitiesVisit(visitor, &rig_quantities, NULL, &model->rig, NULL));
  PetscCall(QuantitiesVisitList(visitor, &parts_list, s->n_parts, s->parts));
  PetscCall(QuantitiesVisitList(visitor, &supports_list, s->n_supports, s->supports));
  PetscCall(QuantitiesVisitList(visitor, &springs_list, s->n_springs, s->springs));
  PetscCall(QuantitiesVisitList(visitor, &dashpots_list, s->n_dashpots, s->dashpots));
  PetscCall(QuantitiesVisitList(visitor, &joints_list, s->n_joints, s->joints));
  PetscCall(QuantitiesVisitList(visitor, &points_list, s->n_points, s->points));
  PetscCall(QuantitiesVisitList(visitor, &loads_list, s->n_loads, s->loads));
  PetscCall(QuantitiesVisitList(visitor, &motions_list, s->n_motions, s->motions));
  PetscCall(QuantitiesVisitList(visitor, &probes_list, s->n_probes, s->probes));
  PetscCall(QuantitiesVisitList(visitor, &circles_list, s->n_circles, s->circles));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelKeepTogether(Model model, const char set[])
{
  PetscFunctionBeginUser;
  PetscCheck(!model->dm, model->comm, PETSC_ERR_ARG_WRONGSTATE, "ModelKeepTogether() must come before ModelSetUp()");
  PetscCheck(model->n_together < MODEL_MAX_NAMES, model->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "more than %d sets to keep together", MODEL_MAX_NAMES);
  PetscCall(PetscStrallocpy(set, &model->together[model->n_together++]));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelKeepSlabs(Model model)
{
  PetscFunctionBeginUser;
  PetscCheck(!model->dm, model->comm, PETSC_ERR_ARG_WRONGSTATE, "ModelKeepSlabs() must come before ModelSetUp()");
  model->keep_slabs = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode ModelAddUnknowns(Model model, PetscInt n)
{
  PetscFunctionBeginUser;
  PetscCheck(!model->dm, model->comm, PETSC_ERR_ARG_WRONGSTATE, "ModelAddUnknowns() must come before ModelSetUp()");
  model->n_apart += n;
  model->has_superelements = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode ModelCheckGiven(Model model)
{
  PetscFunctionBeginUser;
  PetscCheck(
    model->given, model->comm, PETSC_ERR_USER_INPUT,
    "nothing to compute: give -options_file FILE, -model_source rig, -model_mesh FILE or -operators_load_k FILE");
  PetscFunctionReturn(0);
}

PetscErrorCode ModelHoldMotions(Model model)
{
  PetscFunctionBeginUser;
  PetscCheck(!model->dm, model->comm, PETSC_ERR_ARG_WRONGSTATE, "ModelHoldMotions() must come before ModelSetUp()");
  model->hold_motions = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode ModelSetUp(Model model)
{
  PetscFunctionBeginUser;
  PetscCall(ModelCheckGiven(model));
  PetscCall(PartsCheck(model));
  if (!model->from_file)
    PetscCall(RigGenerate(model->comm, &model->rig, &model->dm));
  else
    PetscCall(ImportGmsh(model->comm, model->file, &model->dm));
  PetscCall(MeshTabulate(model));
  PetscCall(MeshCheck(model));
  if (!model->from_file) PetscCall(RigSave(model));
  PetscCall(SpinsCheck(model));
  PetscCall(LayersMeasure(model));
  PetscCall(PartitionMesh(model));
  PetscCall(MeshLayOut(model));
  PetscCall(PartsCheckUnits(model));
  PetscCall(ModelCheckAxes(model));
  PetscCall(GroundedSetUp(model));
  PetscCall(JointsSetUp(model));
  PetscCall(LoadsSetUp(model));
  PetscCall(ProbesLocate(model));
  PetscCall(CirclesLocate(model));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelGetComm(Model model, MPI_Comm *comm)
{
  PetscFunctionBeginUser;
  *comm = model->comm;
  PetscFunctionReturn(0);
}

PetscErrorCode ModelGetDM(Model model, DM *dm)
{
  PetscFunctionBeginUser;
  *dm = model->dm;
  PetscFunctionReturn(0);
}

PetscErrorCode ModelGetScene(Model model, const ModelScene **scene)
{
  PetscFunctionBeginUser;
  *scene = &model->scene;
  PetscFunctionReturn(0);
}

PetscBool ModelHasGravity(Model model)
{
  const PetscReal *g = model->scene.gravity;

  return g[0] != 0 || g[1] != 0 || g[2] != 0 ? PETSC_TRUE : PETSC_FALSE;
}

static PetscErrorCode SupportView(const Support *s, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  PetscCall(PetscViewerASCIIPrintf(viewer, "  support %s holds%s%s%s of %s\n", s->name, s->fix[0] ? " x" : "",
                                   s->fix[1] ? " y" : "", s->fix[2] ? " z" : "", s->set));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelView(Model model, PetscViewer viewer)
{
  PetscInt    n_cells = model->mesh.n_cells;
  PetscMPIInt size;
  const char *unit;
  char        words[256];

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(model->comm, &size));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &n_cells, 1, MPIU_INT, MPI_SUM, model->comm));
  PetscCall(MeshDescribe(model, sizeof(words), words));
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "model: %s, %" PetscInt_FMT " cells, %" PetscInt_FMT " unknowns on %d rank%s; %s\n",
                                   !model->from_file ? "built-in rig" : model->file, n_cells, model->mesh.n_unknowns,
                                   size, size == 1 ? "" : "s", words));
  for (PetscInt i = 0; i < model->scene.n_parts; i++) PetscCall(PartView(model, i, viewer));
  for (PetscInt i = 0; i < model->scene.n_supports; i++) PetscCall(SupportView(&model->scene.supports[i], viewer));
  for (PetscInt i = 0; i < model->scene.n_springs; i++)
    PetscCall(GroundedView(model, &model->scene.springs[i], "spring", viewer));
  for (PetscInt i = 0; i < model->scene.n_dashpots; i++)
    PetscCall(GroundedView(model, &model->scene.dashpots[i], "dashpot", viewer));
  for (PetscInt i = 0; i < model->scene.n_joints; i++) PetscCall(JointView(model, &model->scene.joints[i], viewer));
  for (PetscInt i = 0; i < model->scene.n_points; i++) PetscCall(JointView(model, &model->scene.points[i], viewer));
  for (PetscInt i = 0; i < model->scene.n_loads; i++) PetscCall(LoadView(model, &model->scene.loads[i], viewer));
  for (PetscInt i = 0; i < model->scene.n_motions; i++) {
    PetscCall(ModelDescribeMotion(&model->scene.motions[i], sizeof(words), words));
    PetscCall(PetscViewerASCIIPrintf(viewer, "  %s\n", words));
  }
  PetscCall(ModelGetUnit(model, "m/s^2", &unit));
  if (ModelHasGravity(model))
    PetscCall(PetscViewerASCIIPrintf(viewer, "  gravity: %.6g, %.6g, %.6g %s\n", (double)model->scene.gravity[0],
                                     (double)model->scene.gravity[1], (double)model->scene.gravity[2], unit));
  PetscCall(ProbesView(model, viewer));
  PetscCall(CirclesView(model, viewer));
  PetscFunctionReturn(0);
}

/* Frees the records of a list, each of which begins with n_strings strings of its own */
static PetscErrorCode RecordsDestroy(PetscInt n, size_t size, PetscInt n_strings, void *records)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt k = 0; k < n_strings; k++)
      PetscCall(PetscFree(((char **)(void *)((char *)records + (size_t)i * size))[k]));
  PetscCall(PetscFree(records));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelDestroy(Model *model)
{
  Model       m = *model;
  ModelScene *s;

  PetscFunctionBeginUser;
  if (!m) PetscFunctionReturn(0);
  s = &m->scene;
  for (PetscInt i = 0; i < s->n_parts; i++) PetscCall(ViscoelasticFree(&s->parts[i].law));
  PetscCall(RecordsDestroy(s->n_parts, sizeof(*s->parts), 2, s->parts));
  PetscCall(RecordsDestroy(s->n_supports, sizeof(*s->supports), 2, s->supports));
  PetscCall(RecordsDestroy(s->n_springs, sizeof(*s->springs), 2, s->springs));
  PetscCall(RecordsDestroy(s->n_dashpots, sizeof(*s->dashpots), 2, s->dashpots));
  PetscCall(JointsDestroy(s->n_joints, s->joints));
  PetscCall(RecordsDestroy(s->n_joints, sizeof(*s->joints), 3, s->joints));
  PetscCall(JointsDestroy(s->n_points, s->points));
  PetscCall(RecordsDestroy(s->n_points, sizeof(*s->points), 3, s->points));
  PetscCall(RecordsDestroy(s->n_loads, sizeof(*s->loads), 4, s->loads));
  PetscCall(RecordsDestroy(s->n_motions, sizeof(*s->motions), 2, s->motions));
  PetscCall(RecordsDestroy(s->n_probes, sizeof(*s->probes), 2, s->probes));
  PetscCall(CirclesDestroy(m));
  PetscCall(RecordsDestroy(s->n_circles, sizeof(*s->circles), 2, s->circles));
  for (PetscInt i = 0; i < m->n_together; i++) PetscCall(PetscFree(m->together[i]));
  PetscCall(PetscFree(m->extent));
  PetscCall(MeshReset(m));
  PetscCall(DMDestroy(&m->dm));
  PetscCall(PetscFree(*model));
  PetscFunctionReturn(0);
}
