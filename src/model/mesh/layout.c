/*
   Layout of the unknowns: three displacements per vertex, of which those that a support fixes, or a motion that is
   held prescribes, are constrained in the section of the DM, hence absent from global vectors and matrices.
*/
#include "model/modelimpl.h"

/* Flags fixed[vertex][3]: by supports, and all three at vertices without a cell (points of a file's
   geometry) */
static PetscErrorCode SupportsFlag(Model model, PetscInt vStart, PetscInt vEnd, PetscBool fixed[][3])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < model->scene.n_supports; i++) {
    const Support  *support = &model->scene.supports[i];
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

PetscErrorCode MeshLayOut(Model model)
{
  PetscInt vStart, vEnd;
  PetscBool(*fixed)[3];
  PetscSection section;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetDepthStratum(model->dm, 0, &vStart, &vEnd));
  PetscCall(PetscCalloc1(vEnd - vStart, &fixed));
  PetscCall(SupportsFlag(model, vStart, vEnd, fixed));
  if (model->hold_motions && model->scene.n_motions) PetscCall(MotionsFlag(model, fixed));
  PetscCall(SectionCreate(model->dm, vStart, vEnd, fixed, &section));
  PetscCall(DMSetLocalSection(model->dm, section));
  PetscCall(PetscSectionDestroy(&section));
  PetscCall(UnknownsNumber(model, vStart, vEnd, fixed));
  PetscCall(PetscFree(fixed));
  PetscFunctionReturn(0);
}
