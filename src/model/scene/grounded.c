/*
   Grounded springs and dashpots: a stiffness (N/m) or a viscosity (N s/m) in x, y, z at every node of a named set.
*/
#include "model/modelimpl.h"
#include <squeal/options.h>

/* What springs and dashpots differ in */
typedef struct {
  const char *list, *name, *option, *help, *unit;
} GroundedKind;

static const GroundedKind spring  = {"-springs", "spring", "-stiffness", "stiffness in x,y,z, N/m per node", "N/m"};
static const GroundedKind dashpot = {"-dashpots", "dashpot", "-viscosity", "viscosity in x,y,z, N s/m per node",
                                     "N s/m"};

/* Set and values of one, whose name is set */
static PetscErrorCode GroundedSetFromOptions(MPI_Comm comm, const GroundedKind *kind, Grounded *g)
{
  const char *option = kind->option + 1;
  char        prefix[128], title[160];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%s_", g->name));
  PetscCall(PetscSNPrintf(title, sizeof(title), "Grounded %s %s", kind->name, g->name));
  PetscOptionsBegin(comm, prefix, title, NULL);
  PetscCall(OptionsGetSet(PetscOptionsObject, &g->set));
  PetscCall(OptionsGetReals(PetscOptionsObject, kind->option, kind->help, 3, g->value, NULL));
  PetscOptionsEnd();
  PetscCheck(g->value[0] != 0 || g->value[1] != 0 || g->value[2] != 0, comm, PETSC_ERR_USER_INPUT,
             "-%s_%s must be given: three values, not all zero", g->name, option);
  for (int d = 0; d < 3; d++)
    PetscCheck(g->value[d] >= 0, comm, PETSC_ERR_USER_INPUT, "-%s_%s value %.6g must not be negative", g->name, option,
               (double)g->value[d]);
  PetscFunctionReturn(0);
}

/* The list of one kind */
static PetscErrorCode GroundedListFromOptions(MPI_Comm comm, const GroundedKind *kind, PetscInt *n, Grounded **grounded)
{
  char *names[MODEL_MAX_NAMES];

  PetscFunctionBeginUser;
  PetscCall(OptionsGetNames(comm, kind->list, "each the prefix of its -set and value", MODEL_MAX_NAMES, n, names));
  PetscCall(PetscCalloc1(*n, grounded));
  for (PetscInt i = 0; i < *n; i++) {
    (*grounded)[i].name = names[i];
    PetscCall(GroundedSetFromOptions(comm, kind, &(*grounded)[i]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode GroundedsSetFromOptions(Model model)
{
  PetscFunctionBeginUser;
  PetscCall(GroundedListFromOptions(model->comm, &spring, &model->scene.n_springs, &model->scene.springs));
  PetscCall(GroundedListFromOptions(model->comm, &dashpot, &model->scene.n_dashpots, &model->scene.dashpots));
  PetscFunctionReturn(0);
}

static PetscErrorCode GroundedListView(const GroundedKind *kind, PetscInt n, const Grounded g[], PetscViewer viewer)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++)
    PetscCall(PetscViewerASCIIPrintf(viewer, "  %s %s on %s: %.6g, %.6g, %.6g %s per node\n", kind->name, g[i].name,
                                     g[i].set, (double)g[i].value[0], (double)g[i].value[1], (double)g[i].value[2],
                                     kind->unit));
  PetscFunctionReturn(0);
}

PetscErrorCode GroundedsView(Model model, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  PetscCall(GroundedListView(&spring, model->scene.n_springs, model->scene.springs, viewer));
  PetscCall(GroundedListView(&dashpot, model->scene.n_dashpots, model->scene.dashpots, viewer));
  PetscFunctionReturn(0);
}

static PetscErrorCode GroundedListDestroy(PetscInt n, Grounded **g)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(PetscFree((*g)[i].name));
    PetscCall(PetscFree((*g)[i].set));
  }
  PetscCall(PetscFree(*g));
  PetscFunctionReturn(0);
}

PetscErrorCode GroundedsDestroy(Model model)
{
  PetscFunctionBeginUser;
  PetscCall(GroundedListDestroy(model->scene.n_springs, &model->scene.springs));
  PetscCall(GroundedListDestroy(model->scene.n_dashpots, &model->scene.dashpots));
  PetscFunctionReturn(0);
}
