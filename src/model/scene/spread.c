/*
   How a quantity on a named set is spread over its vertices v: the shares s_v, with the bilinear shape functions N_v of
   the faces and their area A (m^2),

      each      s_v = 1,
      in all    s_v = int N_v dA / A on a surface, 1 / n on a set without faces, at its n vertices; they add up to 1,
      per area  s_v = int N_v dA on a surface.

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

/* Corner shares of the area, integral of w_i dA (m^2), by 2 x 2 Gauss points; exact for plane facets */
static void FacetAreaShares(const double x[4][3], double share[4])
{
  static const double g[2] = {-0.57735026918962576451, 0.57735026918962576451};

  for (int i = 0; i < 4; i++) share[i] = 0;
  for (int q = 0; q < 4; q++) {
    double w[4], n[3];

    FacetWeights(g[q % 2], g[q / 2], w);
    FacetNormal(x, g[q % 2], g[q / 2], n);
    for (int i = 0; i < 4; i++) share[i] += w[i] * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  }
}

/* Adds int N_v dA (m^2) of the faces on this rank to weight[3 v] */
static PetscErrorCode SurfaceAddWeights(Model model, const char set[], PetscScalar weight[])
{
  ModelFaces faces;

  PetscFunctionBeginUser;
  PetscCall(ModelGetSetFaces(model, set, &faces));
  for (PetscInt f = 0; f < faces.n; f++) {
    const PetscInt *node = &faces.node[faces.first[f]];
    double          x[4][3], share[4];

    for (int i = 0; i < 4; i++) PetscCall(PetscArraycpy(x[i], &model->mesh.x[3 * node[i]], 3));
    FacetAreaShares((const double(*)[3])x, share);
    for (int i = 0; i < 4; i++) weight[3 * node[i]] += share[i];
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
  PetscCall(ModelGetOwnedVertices(model, set, &is));
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

PetscErrorCode ModelCreateShares(Model model, const char owner[], const char set[], Spread spread, Vec *shares)
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
  PetscCall(faces ? SurfaceAddWeights(model, set, share) : NodesAddWeights(model, set, share));
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
