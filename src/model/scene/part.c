/*
   Bodies: names and materials from the options, and the part of each cell from the labels of the mesh.

   A loss factor eta stands for the complex stiffness (1 + i eta) K, at the frequency of each mode (viscoelastic.h).
   With -model_loss_frequency it is C = (eta / omega_ref) K instead, in real arithmetic and in time as well, which is
   exact at omega_ref and grows with the frequency elsewhere.
*/
#include "model/modelimpl.h"
#include "base/process/fault.h"
#include <squeal/options.h>

PetscErrorCode PartCheck(MPI_Comm comm, void *owner, void *record)
{
  Part *part = record;

  PetscFunctionBeginUser;
  (void)owner;
  if (!part->volume[0]) {
    PetscCall(PetscFree(part->volume));
    PetscCall(PetscStrallocpy(part->name, &part->volume));
  }
  PetscCall(PartSetElasticity(comm, part));
  PetscCall(PartCheckSpin(comm, part));
  PetscFunctionReturn(0);
}

PetscErrorCode PartsAddLoss(Model model)
{
  const PetscReal omega = 2 * PETSC_PI * model->scene.loss_frequency;
  PetscBool       any   = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < model->scene.n_parts; i++) {
    Part *p = &model->scene.parts[i];

    if (p->loss > 0 && omega > 0) p->beta += p->loss / omega;
    PetscCall(ViscoelasticSet(model->comm, p->name, &p->viscous, p->young, omega > 0 ? 0 : p->loss, &p->law));
    PetscCheck(
      !(p->loss > 0 && omega > 0 && p->law.kind), model->comm, PETSC_ERR_USER_INPUT,
      "-%s_loss_factor %.6g, with -model_loss_frequency, and the law of -%s (prony, zener or table) exclude each "
      "other: give one damping",
      p->name, (double)p->loss, p->name);
    any = p->loss > 0 || any ? PETSC_TRUE : PETSC_FALSE;
  }
  PetscCheck(omega == 0 || any, model->comm, PETSC_ERR_USER_INPUT,
             "-model_loss_frequency %.6g does nothing: none of the -parts has a -..._loss_factor",
             (double)model->scene.loss_frequency);
  PetscFunctionReturn(0);
}

PetscErrorCode ModelFindPart(Model model, const char name[], const char part[], PetscInt *index)
{
  char names[1024] = "";

  PetscFunctionBeginUser;
  *index = -1;
  if (!part[0]) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < model->scene.n_parts; i++) {
    PetscCall(OptionsTextAppend(names, i ? ", " : "", sizeof(names)));
    PetscCall(OptionsTextAppend(names, model->scene.parts[i].name, sizeof(names)));
    if (!strcmp(model->scene.parts[i].name, part)) *index = i;
  }
  PetscCheck(*index >= 0, model->comm, PETSC_ERR_USER_INPUT, "-%s_part %s is none of the -parts: %s", name, part,
             names);
  PetscFunctionReturn(0);
}

PetscErrorCode PartsCheck(Model model)
{
  PetscFunctionBeginUser;
  PetscCheck(model->scene.n_parts, model->comm, PETSC_ERR_USER_INPUT,
             "-parts is empty: name at least one volume of the mesh");
  for (PetscInt i = 0; i < model->scene.n_parts; i++) {
    const Part *p = &model->scene.parts[i];

    PetscCheck(p->young > 0, model->comm, PETSC_ERR_USER_INPUT, "-%s_young %.6g must be given and positive (Pa)",
               p->name, (double)p->young);
    PetscCheck(p->density > 0, model->comm, PETSC_ERR_USER_INPUT,
               "-%s_density %.6g must be given and positive (kg/m^3)", p->name, (double)p->density);
    PetscCheck(p->anisotropy.n || (p->poisson > -1 && p->poisson < 0.5), model->comm, PETSC_ERR_USER_INPUT,
               "-%s_poisson %.6g must lie between -1 and 0.5, ends excluded", p->name, (double)p->poisson);
  }
  PetscFunctionReturn(0);
}

/* Writes the part into cells of one label; a cell that has one already makes `twice` that cell */
static PetscErrorCode PartMarkCells(Model model, PetscInt part, PetscInt cell_part[], PetscInt *n_marked,
                                    PetscInt *twice)
{
  PetscInt        cStart, cEnd, n = 0;
  const PetscInt *points;
  IS              is;
  DMLabel         label;

  PetscFunctionBeginUser;
  *n_marked = 0;
  PetscCall(DMPlexGetHeightStratum(model->dm, 0, &cStart, &cEnd));
  PetscCall(DMGetLabel(model->dm, model->scene.parts[part].volume, &label));
  if (!label) PetscFunctionReturn(0);
  PetscCall(DMLabelGetStratumIS(label, 1, &is));
  if (!is) PetscFunctionReturn(0);
  PetscCall(ISGetLocalSize(is, &n));
  PetscCall(ISGetIndices(is, &points));
  for (PetscInt i = 0; i < n; i++) {
    if (points[i] < cStart || points[i] >= cEnd) continue;
    if (cell_part[points[i] - cStart] >= 0) *twice = points[i] - cStart;
    cell_part[points[i] - cStart] = part;
    ++*n_marked;
  }
  PetscCall(ISRestoreIndices(is, &points));
  PetscCall(ISDestroy(&is));
  PetscFunctionReturn(0);
}

/* Notes the fault of a cell in none of the parts: the volume that it is of */
static PetscErrorCode CellNoteVolume(Model model, PetscInt cell, Fault *fault)
{
  PetscInt    n, value = -1;
  const char *name;

  PetscFunctionBeginUser;
  PetscCall(DMGetNumLabels(model->dm, &n));
  for (PetscInt i = 0; i < n; i++) {
    PetscBool own;

    PetscCall(DMGetLabelName(model->dm, i, &name));
    PetscCall(ModelLabelIsOwn(name, &own));
    if (own) continue;
    PetscCall(DMGetLabelValue(model->dm, name, cell, &value));
    if (value != 1) continue;
    PetscCall(
      FaultNote(fault, PETSC_ERR_USER_INPUT, "the mesh has a volume %s that is not in -parts: name it there", name));
  }
  PetscCall(FaultNote(fault, PETSC_ERR_USER_INPUT,
                      "the mesh has cells in no named volume, hence in none of the -parts: name all"));
  PetscFunctionReturn(0);
}

PetscErrorCode PartsFindCells(Model model, PetscInt cell_part[])
{
  PetscInt twice = -1, without = -1, n_local, n_cells;
  Fault    fault = {0};

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < model->mesh.n_cells; c++) cell_part[c] = -1;
  for (PetscInt part = 0; part < model->scene.n_parts; part++) {
    PetscCall(PartMarkCells(model, part, cell_part, &n_local, &twice));
    PetscCallMPI(MPI_Allreduce(&n_local, &n_cells, 1, MPIU_INT, MPI_SUM, model->comm));
    if (!n_cells) PetscCall(ModelComplainSet(model, "volume", model->scene.parts[part].volume));
  }
  for (PetscInt c = model->mesh.n_cells; c-- > 0;)
    if (cell_part[c] < 0) without = c;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &twice, 1, MPIU_INT, MPI_MAX, model->comm));
  PetscCheck(twice < 0, model->comm, PETSC_ERR_USER_INPUT,
             "a cell belongs to two of the -parts; volumes must not overlap");
  if (without >= 0) PetscCall(CellNoteVolume(model, without, &fault));
  PetscCall(FaultsRaise(model->comm, &fault));
  PetscFunctionReturn(0);
}
