/*
   Named sets: nodes of a set, complete on every rank that has the node, also where the set's own faces live on
   another rank.
*/
#include "modelimpl.h"
#include <squeal/options.h>
#include <petscsf.h>

/* Points of a range, NULL for all, where the label has the value; the caller frees them */
static PetscErrorCode LabelGetPoints(DMLabel label, PetscInt value, const PetscInt range[2], PetscInt *n,
                                     PetscInt **point)
{
  const PetscInt *p;
  PetscInt        n_all;
  IS              is = NULL;

  PetscFunctionBeginUser;
  *n     = 0;
  *point = NULL;
  if (label) PetscCall(DMLabelGetStratumIS(label, value, &is));
  if (!is) PetscFunctionReturn(0);
  PetscCall(ISGetLocalSize(is, &n_all));
  PetscCall(ISGetIndices(is, &p));
  PetscCall(PetscMalloc1(n_all, point));
  for (PetscInt i = 0; i < n_all; i++)
    if (!range || (p[i] >= range[0] && p[i] < range[1])) (*point)[(*n)++] = p[i];
  PetscCall(ISRestoreIndices(is, &p));
  PetscCall(ISDestroy(&is));
  PetscFunctionReturn(0);
}

/* Whether a named set has cells, on any rank */
static PetscErrorCode SetHasCells(Model model, const char set[], PetscBool *has)
{
  DMLabel  label;
  PetscInt cells[2], values[2] = {SET_CLOSED, SET_ALONE};

  PetscFunctionBeginUser;
  *has = PETSC_FALSE;
  PetscCall(DMPlexGetHeightStratum(model->dm, 0, &cells[0], &cells[1]));
  PetscCall(DMGetLabel(model->dm, set, &label));
  for (int i = 0; i < 2; i++) {
    PetscInt n, *point;

    PetscCall(LabelGetPoints(label, values[i], cells, &n, &point));
    if (n) *has = PETSC_TRUE;
    PetscCall(PetscFree(point));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, has, 1, MPIU_BOOL, MPI_LOR, model->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelLabelIsOwn(const char name[], PetscBool *own)
{
  static const char *const names[] = {"depth", "celltype", "dim"};

  PetscFunctionBeginUser;
  *own = PETSC_FALSE;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(names) && !*own; i++) PetscCall(PetscStrcmp(name, names[i], own));
  PetscFunctionReturn(0);
}

/* The named sets of the mesh as "'disc', 'pad'", or those that have cells, for messages; the same text on all ranks */
static PetscErrorCode SetListNames(Model model, PetscBool cells, char list[], size_t size)
{
  PetscInt    n;
  const char *name;

  PetscFunctionBeginUser;
  list[0] = 0;
  PetscCall(DMGetNumLabels(model->dm, &n));
  for (PetscInt i = 0; i < n; i++) {
    PetscBool skip = PETSC_FALSE, has = PETSC_TRUE;

    PetscCall(DMGetLabelName(model->dm, i, &name));
    PetscCall(ModelLabelIsOwn(name, &skip));
    if (skip) continue;
    if (cells) PetscCall(SetHasCells(model, name, &has));
    if (!has) continue;
    if (list[0]) PetscCall(OptionsTextAppend(list, ", ", size));
    PetscCall(OptionsTextAppend(list, "'", size));
    PetscCall(OptionsTextAppend(list, name, size));
    PetscCall(OptionsTextAppend(list, "'", size));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ModelComplainSet(Model model, const char what[], const char name[])
{
  static const char *const of_volumes[] = {"parts", "_volume", NULL};
  static const char *const of_sets[]    = {"_set", "_surfaces", "_a", "_b", NULL};
  char                     list[1024], option[256];
  PetscBool                is_volume;

  PetscFunctionBeginUser;
  PetscCall(PetscStrcmp(what, "volume", &is_volume));
  PetscCall(SetListNames(model, is_volume, list, sizeof(list)));
  PetscCall(OptionsWithValue(name, is_volume ? of_volumes : of_sets, option, sizeof(option)));
  SETERRQ(model->comm, PETSC_ERR_USER_INPUT, "%s%sthe mesh has no %s named '%s'; it names: %s%s", option,
          option[0] ? ": " : "", what, name, list, is_volume ? " (-NAME_volume gives a part another one)" : "");
}

PetscErrorCode SetGetPoints(Model model, const char set[], const PetscInt range[2], PetscInt *n, PetscInt **point)
{
  DMLabel  label;
  PetscInt size[2] = {0, 0};

  PetscFunctionBeginUser;
  PetscCall(DMGetLabel(model->dm, set, &label));
  if (label) PetscCall(DMLabelGetStratumSize(label, SET_CLOSED, &size[0]));
  if (label) PetscCall(DMLabelGetStratumSize(label, SET_ALONE, &size[1]));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, size, 2, MPIU_INT, MPI_SUM, model->comm));
  if (!size[0] && !size[1]) PetscCall(ModelComplainSet(model, "set", set));
  PetscCall(LabelGetPoints(label, SET_CLOSED, range, n, point));
  PetscFunctionReturn(0);
}

PetscErrorCode PointIsElsewhere(Model model, PetscInt point, PetscBool *elsewhere)
{
  const PetscInt *shared; /* points that another rank owns, ascending; n_shared is -1 without a graph */
  PetscInt        n_shared, place = -1;
  PetscSF         sf;

  PetscFunctionBeginUser;
  PetscCall(DMGetPointSF(model->dm, &sf));
  PetscCall(PetscSFGetGraph(sf, NULL, &n_shared, &shared, NULL));
  if (n_shared > 0) PetscCall(PetscFindInt(point, n_shared, shared, &place));
  *elsewhere = place >= 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Marks (adds 1 to the first component of) every node in the closure of n points */
static PetscErrorCode MarkClosure(Model model, PetscInt n, const PetscInt p[], PetscScalar mark[])
{
  PetscInt n_closure, *closure = NULL;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(DMPlexGetTransitiveClosure(model->dm, p[i], PETSC_TRUE, &n_closure, &closure));
    for (PetscInt j = 0; j < n_closure; j++) {
      const PetscInt node = model->node_of[closure[2 * j]];

      if (node >= 0) mark[3 * node] += 1;
    }
    PetscCall(DMPlexRestoreTransitiveClosure(model->dm, p[i], PETSC_TRUE, &n_closure, &closure));
  }
  PetscFunctionReturn(0);
}

/* The same of the nodes that are in the set without those around */
static PetscErrorCode MarkAlone(Model model, const char set[], PetscScalar mark[])
{
  PetscInt n, *p;
  DMLabel  label;

  PetscFunctionBeginUser;
  PetscCall(DMGetLabel(model->dm, set, &label));
  PetscCall(LabelGetPoints(label, SET_ALONE, NULL, &n, &p));
  for (PetscInt i = 0; i < n; i++)
    if (model->node_of[p[i]] >= 0) mark[3 * model->node_of[p[i]]] += 1;
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelGetSetNodes(Model model, const char set[], PetscInt *n, PetscInt **node)
{
  PetscScalar *mark;
  PetscInt     n_points, *point;
  Vec          marks;

  PetscFunctionBeginUser;
  PetscCall(SetGetPoints(model, set, NULL, &n_points, &point));
  PetscCall(ModelCreateNodal(model, &marks));
  PetscCall(VecGetArray(marks, &mark));
  PetscCall(MarkClosure(model, n_points, point, mark));
  PetscCall(MarkAlone(model, set, mark));
  PetscCall(VecRestoreArray(marks, &mark));
  PetscCall(ModelSumShared(model, marks));
  PetscCall(VecGetArray(marks, &mark));
  *n = 0;
  for (PetscInt v = 0; v < model->mesh.n_nodes; v++) *n += mark[3 * v] > 0;
  PetscCall(PetscMalloc1(*n, node));
  for (PetscInt v = 0, i = 0; v < model->mesh.n_nodes; v++)
    if (mark[3 * v] > 0) (*node)[i++] = v;
  PetscCall(VecRestoreArray(marks, &mark));
  PetscCall(VecDestroy(&marks));
  PetscCall(PetscFree(point));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelGetOwnedNodes(Model model, const char set[], PetscInt *n, PetscInt **node)
{
  PetscInt n_all;

  PetscFunctionBeginUser;
  PetscCall(ModelGetSetNodes(model, set, &n_all, node));
  *n = 0;
  for (PetscInt i = 0; i < n_all; i++)
    if (model->mesh.owned[(*node)[i]]) (*node)[(*n)++] = (*node)[i];
  PetscFunctionReturn(0);
}
