/*
   Layout of the unknowns: three displacements per node, of which those that a support fixes, or a motion that is held
   prescribes, are constrained in the section of the DM, hence absent from global vectors and matrices. Unknowns that no
   node has come after all of these, on the last rank.
*/
#include "model/modelimpl.h"

/* Flags fixed[node][3] by supports */
static PetscErrorCode SupportsFlag(Model model, PetscBool fixed[][3])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < model->scene.n_supports; i++) {
    const Support *support = &model->scene.supports[i];
    PetscInt       n, *vertices;

    PetscCall(ModelGetSetNodes(model, support->set, &n, &vertices));
    for (PetscInt j = 0; j < n; j++)
      for (int d = 0; d < 3; d++)
        if (support->fix[d]) fixed[vertices[j]][d] = PETSC_TRUE;
    PetscCall(PetscFree(vertices));
  }
  PetscFunctionReturn(0);
}

/* Directions of a node that are fixed, ascending; returns their number */
static PetscInt FixedDirections(const PetscBool fixed[3], PetscInt directions[3])
{
  PetscInt n = 0;

  for (PetscInt d = 0; d < 3; d++)
    if (fixed[d]) directions[n++] = d;
  return n;
}

/* Section of three displacements per node with the flagged ones constrained */
static PetscErrorCode SectionCreate(Model model, PetscBool fixed[][3], PetscSection *section)
{
  PetscInt pStart, pEnd, directions[3];

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetChart(model->dm, &pStart, &pEnd));
  PetscCall(PetscSectionCreate(model->comm, section));
  PetscCall(PetscSectionSetChart(*section, pStart, pEnd));
  for (PetscInt v = 0; v < model->mesh.n_nodes; v++) {
    PetscCall(PetscSectionSetDof(*section, model->point_of[v], 3));
    PetscCall(PetscSectionSetConstraintDof(*section, model->point_of[v], FixedDirections(fixed[v], directions)));
  }
  PetscCall(PetscSectionSetUp(*section));
  for (PetscInt v = 0; v < model->mesh.n_nodes; v++)
    if (FixedDirections(fixed[v], directions))
      PetscCall(PetscSectionSetConstraintIndices(*section, model->point_of[v], directions));
  PetscFunctionReturn(0);
}

/* Global number of each displacement of each local node, -1 where fixed, and how many this rank has */
static PetscErrorCode UnknownsNumber(Model model, PetscBool fixed[][3])
{
  PetscInt    *unknown;
  PetscSection global;
  PetscMPIInt  rank, size;
  Vec          u;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(model->comm, &rank));
  PetscCallMPI(MPI_Comm_size(model->comm, &size));
  PetscCall(DMGetGlobalSection(model->dm, &global));
  PetscCall(PetscMalloc1(3 * model->mesh.n_nodes, &unknown));
  for (PetscInt v = 0; v < model->mesh.n_nodes; v++) {
    PetscInt offset;

    PetscCall(PetscSectionGetOffset(global, model->point_of[v], &offset));
    if (offset < 0) offset = -(offset + 1);
    for (int d = 0; d < 3; d++) unknown[3 * v + d] = fixed[v][d] ? -1 : offset++;
  }
  model->mesh.unknown = unknown;
  PetscCall(DMGetGlobalVector(model->dm, &u));
  PetscCall(VecGetLocalSize(u, &model->mesh.n_own));
  PetscCall(VecGetSize(u, &model->mesh.n_unknowns));
  PetscCall(VecGetOwnershipRange(u, &model->mesh.first_own, NULL));
  PetscCall(DMRestoreGlobalVector(model->dm, &u));
  model->mesh.n_apart = model->n_apart;
  model->mesh.n_unknowns += model->n_apart;
  if (rank == size - 1) model->mesh.n_own += model->n_apart;
  PetscFunctionReturn(0);
}

PetscErrorCode MeshLayOut(Model model)
{
  PetscBool(*fixed)[3];
  PetscSection section;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(model->mesh.n_nodes, &fixed));
  PetscCall(SupportsFlag(model, fixed));
  if (model->hold_motions && model->scene.n_motions) PetscCall(MotionsFlag(model, fixed));
  PetscCall(SectionCreate(model, fixed, &section));
  PetscCall(DMSetLocalSection(model->dm, section));
  PetscCall(PetscSectionDestroy(&section));
  PetscCall(UnknownsNumber(model, fixed));
  PetscCall(PetscFree(fixed));
  PetscFunctionReturn(0);
}
