/*
   How a quantity on a named set is spread over its nodes v: the shares s_v, with the area A (m^2) of its faces and
   shares A_v in it,

      each      s_v = 1,
      in all    s_v = A_v / A on a surface, L_v / L on a curve of edges, 1 / n on other sets of n nodes; they add up to
      1, per area  s_v = A_v on a surface.

   L_v (m) is the integral of N_v along the edges, straight between neighbouring nodes: halves of an edge, or by
   Simpson's rule a sixth at its ends and two thirds in its middle. For loads A_v = int N_v dA, with the shape functions
   N_v of the faces. Springs, dashpots and whatever else needs
   shares above 0 has the positive ones of kernels/contact/facet.h; of faces of first order they are the same.
*/
#include "model/modelimpl.h"
#include "base/algebra/vec3.h"
#include "kernels/contact/facet.h"

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
  PetscInt n, *vertices;

  PetscFunctionBeginUser;
  PetscCall(ModelGetOwnedNodes(model, set, &n, &vertices));
  for (PetscInt j = 0; j < n; j++) weight[3 * vertices[j]] += 1;
  PetscCall(PetscFree(vertices));
  PetscFunctionReturn(0);
}

/* Adds the shares in the length (m) of an edge to weight[3 v]; nodes of its ends, and -1 or that of its middle */
static void EdgeAddWeights(const Mesh *mesh, const PetscInt end[2], PetscInt middle, PetscScalar weight[])
{
  const PetscReal *x[3]   = {&mesh->x[3 * end[0]], &mesh->x[3 * end[1]], middle < 0 ? NULL : &mesh->x[3 * middle]};
  PetscReal        length = 0;

  for (int i = 0; i < 2; i++) {
    const PetscReal *to = middle < 0 ? x[1 - i] : x[2];

    length +=
      Vec3Length((const PetscReal[3]){to[0] - x[i][0], to[1] - x[i][1], to[2] - x[i][2]}) / (middle < 0 ? 2 : 1);
  }
  for (int i = 0; i < 2; i++) weight[3 * end[i]] += length / (middle < 0 ? 2 : 6);
  if (middle >= 0) weight[3 * middle] += 4 * length / 6;
}

/* Adds the shares in the length (m) of the edges of a set, each on the rank that owns it, to weight[3 v] */
static PetscErrorCode CurveAddWeights(Model model, const char set[], PetscScalar weight[])
{
  const PetscInt *ends;
  PetscInt        range[2], n, *p;
  PetscBool       elsewhere;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetDepthStratum(model->dm, 1, &range[0], &range[1]));
  PetscCall(SetGetPoints(model, set, range, &n, &p));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(PointIsElsewhere(model, p[i], &elsewhere));
    if (elsewhere) continue;
    PetscCall(DMPlexGetCone(model->dm, p[i], &ends));
    EdgeAddWeights(&model->mesh, (const PetscInt[2]){model->node_of[ends[0]], model->node_of[ends[1]]},
                   model->node_of[p[i]], weight);
  }
  PetscCall(PetscFree(p));
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
  if (faces) PetscCall(SurfaceAddWeights(model, set, consistent, share));
  if (!faces && spread == SPREAD_TOTAL) PetscCall(CurveAddWeights(model, set, share));
  PetscCall(VecRestoreArray(*shares, &share));
  PetscCall(WeightsTotal(model, *shares, &total));
  if (total == 0) { /* neither faces nor edges */
    PetscCall(VecGetArray(*shares, &share));
    PetscCall(NodesAddWeights(model, set, share));
    PetscCall(VecRestoreArray(*shares, &share));
  }
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
