/*
   Essential supports, grounded springs and dashpots by named sets, and the layout of the unknowns: three
   displacements per vertex, of which those that a support fixes are constrained in the section.
*/
#include "model/modelimpl.h"
#include <squeal/options.h>

/* Directions of a support from a word such as "xz" */
static PetscErrorCode SupportSetFromOptions(MPI_Comm comm, Support *support)
{
  char prefix[128], title[160], fix[16] = "xyz";

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%s_", support->name));
  PetscCall(PetscSNPrintf(title, sizeof(title), "Support %s", support->name));
  PetscOptionsBegin(comm, prefix, title, NULL);
  PetscCall(OptionsGetSet(PetscOptionsObject, &support->set));
  PetscCall(
    PetscOptionsString("-fix", "directions that are held: some of x, y, z", "model.h", fix, fix, sizeof(fix), NULL));
  PetscOptionsEnd();
  PetscCheck(fix[0] && strspn(fix, "xyz") == strlen(fix), comm, PETSC_ERR_USER_INPUT,
             "-%s_fix '%s' must be some of the letters x, y, z", support->name, fix);
  for (int d = 0; d < 3; d++) support->fix[d] = strchr(fix, "xyz"[d]) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Three values of a grounded spring or dashpot; option is "-stiffness" or "-viscosity" */
static PetscErrorCode GroundedSetFromOptions(MPI_Comm comm, const char kind[], const char option[], const char help[],
                                             Grounded *g)
{
  char prefix[128], title[160];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%s_", g->name));
  PetscCall(PetscSNPrintf(title, sizeof(title), "%s %s", kind, g->name));
  PetscOptionsBegin(comm, prefix, title, NULL);
  PetscCall(OptionsGetSet(PetscOptionsObject, &g->set));
  PetscCall(OptionsGetReals(PetscOptionsObject, option, help, 3, g->value, NULL));
  PetscOptionsEnd();
  PetscCheck(g->value[0] != 0 || g->value[1] != 0 || g->value[2] != 0, comm, PETSC_ERR_USER_INPUT,
             "-%s_%s must be given: three values, not all zero", g->name, option + 1);
  for (int d = 0; d < 3; d++)
    PetscCheck(g->value[d] >= 0, comm, PETSC_ERR_USER_INPUT, "-%s_%s value %.6g must not be negative", g->name,
               option + 1, (double)g->value[d]);
  PetscFunctionReturn(0);
}

/* List of grounded springs or dashpots */
static PetscErrorCode GroundedListFromOptions(MPI_Comm comm, const char list[], const char kind[], const char option[],
                                              const char help[], PetscInt *n, Grounded **grounded)
{
  char *names[MODEL_MAX_NAMES];

  PetscFunctionBeginUser;
  PetscCall(OptionsGetNames(comm, list, "each the prefix of its -set and value", MODEL_MAX_NAMES, n, names));
  PetscCall(PetscCalloc1(*n, grounded));
  for (PetscInt i = 0; i < *n; i++) {
    (*grounded)[i].name = names[i];
    PetscCall(GroundedSetFromOptions(comm, kind, option, help, &(*grounded)[i]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SupportsSetFromOptions(Model model)
{
  char *names[MODEL_MAX_NAMES];

  PetscFunctionBeginUser;
  PetscCall(OptionsGetNames(model->comm, "-supports", "essential conditions, each the prefix of its -set and -fix",
                            MODEL_MAX_NAMES, &model->n_supports, names));
  PetscCall(PetscCalloc1(model->n_supports, &model->supports));
  for (PetscInt i = 0; i < model->n_supports; i++) {
    model->supports[i].name = names[i];
    PetscCall(SupportSetFromOptions(model->comm, &model->supports[i]));
  }
  PetscCall(GroundedListFromOptions(model->comm, "-springs", "Spring", "-stiffness", "stiffness in x,y,z, N/m per node",
                                    &model->n_springs, &model->springs));
  PetscCall(GroundedListFromOptions(model->comm, "-dashpots", "Dashpot", "-viscosity",
                                    "viscosity in x,y,z, N s/m per node", &model->n_dashpots, &model->dashpots));
  PetscFunctionReturn(0);
}

/* Flags fixed[vertex][3]: by supports, and all three at vertices without a cell (points of a file's
   geometry) */
static PetscErrorCode SupportsFlag(Model model, PetscInt vStart, PetscInt vEnd, PetscBool fixed[][3])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < model->n_supports; i++) {
    const Support  *support = &model->supports[i];
    const PetscInt *vertices;
    PetscInt        n;
    IS              is;

    PetscCall(ModelGetSetVertices(model, support->set, &is));
    PetscCall(ISGetLocalSize(is, &n));
    PetscCall(ISGetIndices(is, &vertices));
    for (PetscInt j = 0; j < n; j++)
      for (int d = 0; d < 3; d++)
        if (support->fix[d]) fixed[vertices[j]][d] = PETSC_TRUE;
    PetscCall(ISRestoreIndices(is, &vertices));
    PetscCall(ISDestroy(&is));
  }
  for (PetscInt v = vStart; v < vEnd; v++) {
    PetscInt n_edges;

    PetscCall(DMPlexGetSupportSize(model->dm, v, &n_edges));
    for (int d = 0; d < 3 && !n_edges; d++) fixed[v - vStart][d] = PETSC_TRUE;
  }
  PetscFunctionReturn(0);
}

/* Directions of a vertex that are fixed, ascending; returns their number */
static PetscInt FixedDirections(const PetscBool fixed[3], PetscInt directions[3])
{
  PetscInt n = 0;

  for (PetscInt d = 0; d < 3; d++)
    if (fixed[d]) directions[n++] = d;
  return n;
}

/* Section of three displacements per vertex with the flagged ones constrained */
static PetscErrorCode SectionCreate(DM dm, PetscInt vStart, PetscInt vEnd, PetscBool fixed[][3], PetscSection *section)
{
  PetscInt pStart, pEnd, directions[3];

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetChart(dm, &pStart, &pEnd));
  PetscCall(PetscSectionCreate(PetscObjectComm((PetscObject)dm), section));
  PetscCall(PetscSectionSetChart(*section, pStart, pEnd));
  for (PetscInt v = vStart; v < vEnd; v++) {
    PetscCall(PetscSectionSetDof(*section, v, 3));
    PetscCall(PetscSectionSetConstraintDof(*section, v, FixedDirections(fixed[v - vStart], directions)));
  }
  PetscCall(PetscSectionSetUp(*section));
  for (PetscInt v = vStart; v < vEnd; v++)
    if (FixedDirections(fixed[v - vStart], directions))
      PetscCall(PetscSectionSetConstraintIndices(*section, v, directions));
  PetscFunctionReturn(0);
}

/* Global number of each displacement of each local vertex, -1 where fixed, and how many this rank has */
static PetscErrorCode UnknownsNumber(Model model, PetscInt vStart, PetscInt vEnd, PetscBool fixed[][3])
{
  PetscInt    *unknown;
  PetscSection global;
  Vec          u;

  PetscFunctionBeginUser;
  PetscCall(DMGetGlobalSection(model->dm, &global));
  PetscCall(PetscMalloc1(3 * (vEnd - vStart), &unknown));
  for (PetscInt v = vStart; v < vEnd; v++) {
    PetscInt offset;

    PetscCall(PetscSectionGetOffset(global, v, &offset));
    if (offset < 0) offset = -(offset + 1);
    for (int d = 0; d < 3; d++) unknown[3 * (v - vStart) + d] = fixed[v - vStart][d] ? -1 : offset++;
  }
  model->mesh.unknown = unknown;
  PetscCall(DMGetGlobalVector(model->dm, &u));
  PetscCall(VecGetLocalSize(u, &model->mesh.n_own));
  PetscCall(VecGetSize(u, &model->mesh.n_unknowns));
  PetscCall(VecGetOwnershipRange(u, &model->mesh.first_own, NULL));
  PetscCall(DMRestoreGlobalVector(model->dm, &u));
  PetscFunctionReturn(0);
}

PetscErrorCode SupportsLayOut(Model model)
{
  PetscInt vStart, vEnd;
  PetscBool(*fixed)[3];
  PetscSection section;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetDepthStratum(model->dm, 0, &vStart, &vEnd));
  PetscCall(PetscCalloc1(vEnd - vStart, &fixed));
  PetscCall(SupportsFlag(model, vStart, vEnd, fixed));
  PetscCall(SectionCreate(model->dm, vStart, vEnd, fixed, &section));
  PetscCall(DMSetLocalSection(model->dm, section));
  PetscCall(PetscSectionDestroy(&section));
  PetscCall(UnknownsNumber(model, vStart, vEnd, fixed));
  PetscCall(PetscFree(fixed));
  PetscFunctionReturn(0);
}
