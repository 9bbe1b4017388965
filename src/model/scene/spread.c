/*
   How a quantity on a named set is spread over its nodes v: the shares s_v, with the area A (m^2) of its faces and
   shares A_v in it,

      each      s_v = 1,
      in all    s_v = A_v / A on a surface, 1 / n on a set without faces, at its n nodes; they add up to 1,
      per area  s_v = A_v on a surface.

   For loads A_v = int N_v dA, with the shape functions N_v of the faces. Springs, dashpots and whatever else needs
   shares above 0 has the positive ones of kernels/facet.h; of faces of first order they are the same.
*/
#include "model/modelimpl.h"
#include "kernels/facet.h"

/* Whether any rank has a face of the set */
static PetscErrorCode SetHasFaces(Model model, const char set[], PetscBool *has)
{
  PetscInt fStart, fEnd;
  DMLabel  label;

  PetscFunctionBeginUser;
  *has = PETSC_FALSE;
  PetscCall(DMPlexGetHeightStratum(model->dm, 1, &fStart, &fEnd));
  PetscCall(DMGetLabel(model->dm, set, &label));
  for (PetscInt f = fStart; label && f < fEnd && !*has; f++) PetscCall(DMLabelStratumHasPoint(label, 1, f, has));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, has, 1, MPIU_BOOL, MPI_LOR, model->comm));
  PetscFunctionReturn(0);
}

/* Adds the shares in the area (m^2) of the faces on this rank to weight[3 v] */
static PetscErrorCode SurfaceAddWeights(Model model, const char set[], PetscBool consistent, PetscScalar weight[])
{
  ModelFaces faces;

  PetscFunctionBeginUser;
  PetscCall(ModelGetSetFaces(model, set, &faces));
  for (PetscInt f = 0; f < faces.n; f++) {
    const PetscInt *node;
    double          x[FACET_NODES][3], share[FACET_NODES];
    const int       n = (int)ModelFacesGet(&faces, &model->mesh, f, &node, x);

    if (consistent)
      FacetAreas(n, (const double(*)[3])x, share);
    else
      FacetPositiveAreas(n, (const double(*)[3])x, share);
    for (int i = 0; i < n; i++) weight[3 * node[i]] += share[i];
  }
  PetscCall(ModelFacesDestroy(&faces));
  PetscFunctionReturn(0);
}

/* Adds 1 at the nodes of the set that this rank owns to weight[3 v] */
static PetscErrorCode NodesAddWeights(Model model, const char set[], PetscScalar weight[])
{
  const PetscInt *vertices;
  PetscInt        n;
  IS              is;

  PetscFunctionBeginUser;
  PetscCall(ModelGetOwnedNodes(model, set, &is));
  PetscCall(ISGetLocalSize(is, &n));
  PetscCall(ISGetIndices(is, &vertices));
  for (PetscInt j = 0; j < n; j++) weight[3 * vertices[j]] += 1;
  PetscCall(ISRestoreIndices(is, &vertices));
  PetscCall(ISDestroy(&is));
  PetscFunctionReturn(0);
}

/* Sums the weights of this rank over all ranks into *total */
static PetscErrorCode WeightsTotal(Model model, Vec weights, PetscReal *total)
{
  PetscFunctionBeginUser;
  PetscCall(VecSum(weights, total));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, total, 1, MPIU_REAL, MPI_SUM, model->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode SharesCreate(Model model, const char owner[], const char set[], Spread spread, PetscBool consistent,
                            Vec *shares)
{
  PetscScalar *share;
  PetscReal    total;
  PetscBool    faces = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (spread != SPREAD_EACH) PetscCall(SetHasFaces(model, set, &faces));
  PetscCheck(spread != SPREAD_AREA || faces, model->comm, PETSC_ERR_USER_INPUT,
             "-%s_set %s has no faces: a value per area needs a surface", owner, set);
  PetscCall(ModelCreateNodal(model, shares));
  PetscCall(VecGetArray(*shares, &share));
  PetscCall(faces ? SurfaceAddWeights(model, set, consistent, share) : NodesAddWeights(model, set, share));
  PetscCall(VecRestoreArray(*shares, &share));
  if (spread == SPREAD_TOTAL) {
    PetscCall(WeightsTotal(model, *shares, &total));
    PetscCheck(total > 0, model->comm, PETSC_ERR_USER_INPUT,
               "-%s_set %s has no node of an element: name a surface, curve or point of a body", owner, set);
    PetscCall(VecScale(*shares, 1 / total));
  }
  PetscCall(ModelSumShared(model, *shares));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelCreateShares(Model model, const char owner[], const char set[], Spread spread, Vec *shares)
{
  PetscFunctionBeginUser;
  PetscCall(SharesCreate(model, owner, set, spread, PETSC_FALSE, shares));
  PetscFunctionReturn(0);
}
