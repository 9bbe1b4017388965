/*
   Named sets: nodes of a set, complete on every rank that has the node, also where the set's own faces live on
   another rank.
*/
#include "modelimpl.h"
#include <petscsf.h>

/* The named sets of the mesh as "disc, pad", for messages; the same text on all ranks */
static PetscErrorCode SetListNames(DM dm, char list[], size_t size)
{
  PetscInt                 n;
  const char              *name;
  static const char *const own[] = {"depth", "celltype", "dim", NULL};

  PetscFunctionBeginUser;
  list[0] = 0;
  PetscCall(DMGetNumLabels(dm, &n));
  for (PetscInt i = 0; i < n; i++) {
    PetscBool skip = PETSC_FALSE;

    PetscCall(DMGetLabelName(dm, i, &name));
    for (const char *const *o = own; *o && !skip; o++) PetscCall(PetscStrcmp(name, *o, &skip));
    if (skip) continue;
    if (list[0]) PetscCall(PetscStrlcat(list, ", ", size));
    PetscCall(PetscStrlcat(list, name, size));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ModelComplainSet(Model model, const char what[], const char name[])
{
  char list[1024];

  PetscFunctionBeginUser;
  PetscCall(SetListNames(model->dm, list, sizeof(list)));
  SETERRQ(model->comm, PETSC_ERR_USER_INPUT, "the mesh has no %s named '%s'; it names: %s", what, name, list);
}

PetscErrorCode SetGetPoints(Model model, const char set[], IS *points)
{
  DMLabel  label;
  PetscInt n = 0, n_all;

  PetscFunctionBeginUser;
  *points = NULL;
  PetscCall(DMGetLabel(model->dm, set, &label));
  if (label) PetscCall(DMLabelGetStratumIS(label, SET_CLOSED, points));
  if (label) PetscCall(DMLabelGetStratumSize(label, SET_ALONE, &n));
  if (*points) PetscCall(ISGetLocalSize(*points, &n_all));
  if (*points) n += n_all;
  PetscCallMPI(MPI_Allreduce(&n, &n_all, 1, MPIU_INT, MPI_SUM, model->comm));
  if (!n_all) PetscCall(ModelComplainSet(model, "set", set));
  PetscFunctionReturn(0);
}

/* Marks (adds 1 to the first component of) every node in the closure of the points */
static PetscErrorCode MarkClosure(Model model, IS points, PetscScalar mark[])
{
  const PetscInt *p;
  PetscInt        n, n_closure, *closure = NULL;

  PetscFunctionBeginUser;
  PetscCall(ISGetLocalSize(points, &n));
  PetscCall(ISGetIndices(points, &p));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(DMPlexGetTransitiveClosure(model->dm, p[i], PETSC_TRUE, &n_closure, &closure));
    for (PetscInt j = 0; j < n_closure; j++) {
      const PetscInt node = model->node_of[closure[2 * j]];

      if (node >= 0) mark[3 * node] += 1;
    }
    PetscCall(DMPlexRestoreTransitiveClosure(model->dm, p[i], PETSC_TRUE, &n_closure, &closure));
  }
  PetscCall(ISRestoreIndices(points, &p));
  PetscFunctionReturn(0);
}

/* The same of the nodes that are in the set without those around */
static PetscErrorCode MarkAlone(Model model, const char set[], PetscScalar mark[])
{
  const PetscInt *p;
  PetscInt        n;
  DMLabel         label;
  IS              points;

  PetscFunctionBeginUser;
  PetscCall(DMGetLabel(model->dm, set, &label));
  PetscCall(DMLabelGetStratumIS(label, SET_ALONE, &points));
  if (!points) PetscFunctionReturn(0);
  PetscCall(ISGetLocalSize(points, &n));
  PetscCall(ISGetIndices(points, &p));
  for (PetscInt i = 0; i < n; i++)
    if (model->node_of[p[i]] >= 0) mark[3 * model->node_of[p[i]]] += 1;
  PetscCall(ISRestoreIndices(points, &p));
  PetscCall(ISDestroy(&points));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelGetSetNodes(Model model, const char set[], PetscInt *n, PetscInt **node)
{
  PetscScalar *mark;
  Vec          marks;
  IS           points;

  PetscFunctionBeginUser;
  PetscCall(SetGetPoints(model, set, &points));
  PetscCall(ModelCreateNodal(model, &marks));
  PetscCall(VecGetArray(marks, &mark));
  if (points) PetscCall(MarkClosure(model, points, mark));
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
  PetscCall(ISDestroy(&points));
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
