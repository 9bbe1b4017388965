/*
   Loads: total forces on named sets. With F in N the forces at the vertices v are
      f_v = F int N_v dA / A   on a surface, with the bilinear shape functions N_v of its faces and A its area (m^2),
      f_v = F / n              on a set without faces, at its n vertices,
   so that they add up to F. Vertices without a cell (points of a file's geometry) take no part.
*/
#include "model/modelimpl.h"
#include "kernels/facet.h"
#include <squeal/options.h>

/* Set and force of one load */
static PetscErrorCode LoadRead(OptionsItems PetscOptionsObject, void *owner, void *record)
{
  const MPI_Comm comm = PetscOptionsObject->comm;
  Load          *load = record;
  PetscReal      sum  = 0;

  PetscFunctionBeginUser;
  (void)owner;
  PetscCall(OptionsGetSet(PetscOptionsObject, &load->set));
  PetscCall(OptionsGetReals(PetscOptionsObject, "-force", "total force in x,y,z, N (required)", 3, load->force, NULL));
  PetscCall(OptionsCheckFinite(comm, load->name, "force", "N", load->force));
  for (int d = 0; d < 3; d++) sum += PetscAbsReal(load->force[d]);
  PetscCheck(sum > 0, comm, PETSC_ERR_USER_INPUT, "-%s_force must be given: three values, not all zero (N)",
             load->name);
  PetscFunctionReturn(0);
}

const OptionsList loads_list = {"-loads", "forces, each the prefix of its -set and -force", "Load", sizeof(Load),
                                LoadRead};

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
  PetscInt n_faces, *corners;

  PetscFunctionBeginUser;
  PetscCall(ModelGetSetFaces(model, set, &n_faces, &corners));
  for (PetscInt f = 0; f < n_faces; f++) {
    double x[4][3], share[4];

    for (int i = 0; i < 4; i++) PetscCall(PetscArraycpy(x[i], &model->mesh.x[3 * corners[4 * f + i]], 3));
    FacetAreaShares((const double(*)[3])x, share);
    for (int i = 0; i < 4; i++) weight[3 * corners[4 * f + i]] += share[i];
  }
  PetscCall(PetscFree(corners));
  PetscFunctionReturn(0);
}

/* Adds 1 at the vertices of the set that this rank owns and that have cells to weight[3 v] */
static PetscErrorCode VerticesAddWeights(Model model, const char set[], PetscScalar weight[])
{
  const PetscInt *vertices;
  PetscInt        vStart, n, n_edges;
  IS              is;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetDepthStratum(model->dm, 0, &vStart, NULL));
  PetscCall(ModelGetOwnedVertices(model, set, &is));
  PetscCall(ISGetLocalSize(is, &n));
  PetscCall(ISGetIndices(is, &vertices));
  for (PetscInt j = 0; j < n; j++) {
    PetscCall(DMPlexGetSupportSize(model->dm, vStart + vertices[j], &n_edges));
    if (n_edges) weight[3 * vertices[j]] += 1;
  }
  PetscCall(ISRestoreIndices(is, &vertices));
  PetscCall(ISDestroy(&is));
  PetscFunctionReturn(0);
}

/* The part f_v / F of each vertex, in the first of its three places, on every rank that has the vertex. The caller
   destroys the vector. */
static PetscErrorCode LoadCreateWeights(Model model, const Load *load, Vec *weights)
{
  PetscScalar *weight;
  PetscReal    total = 0;
  PetscInt     n;
  PetscBool    faces;

  PetscFunctionBeginUser;
  PetscCall(ModelCreateNodal(model, weights));
  PetscCall(SetHasFaces(model, load->set, &faces));
  PetscCall(VecGetLocalSize(*weights, &n));
  PetscCall(VecGetArray(*weights, &weight));
  PetscCall(faces ? SurfaceAddWeights(model, load->set, weight) : VerticesAddWeights(model, load->set, weight));
  for (PetscInt i = 0; i < n; i++) total += PetscRealPart(weight[i]);
  PetscCall(VecRestoreArray(*weights, &weight));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &total, 1, MPIU_REAL, MPI_SUM, model->comm));
  PetscCheck(total > 0, model->comm, PETSC_ERR_USER_INPUT,
             "-%s_set %s has no node of an element: name a surface, curve or point of a body", load->name, load->set);
  PetscCall(VecScale(*weights, 1 / total));
  PetscCall(ModelSumShared(model, *weights));
  PetscFunctionReturn(0);
}

PetscErrorCode LoadsCheck(Model model)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < model->scene.n_loads; i++) {
    Vec weights;

    PetscCall(LoadCreateWeights(model, &model->scene.loads[i], &weights));
    PetscCall(VecDestroy(&weights));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ModelAddLoad(Model model, PetscInt i, Vec local)
{
  const PetscScalar *weight;
  PetscScalar       *f;
  PetscInt           n;
  Vec                weights;

  PetscFunctionBeginUser;
  PetscCheck(i >= 0 && i < model->scene.n_loads, model->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "load %" PetscInt_FMT " does not exist: there are %" PetscInt_FMT, i, model->scene.n_loads);
  PetscCall(LoadCreateWeights(model, &model->scene.loads[i], &weights));
  PetscCall(VecGetLocalSize(weights, &n));
  PetscCall(VecGetArrayRead(weights, &weight));
  PetscCall(VecGetArray(local, &f));
  for (PetscInt j = 0; j < n; j++) f[j] += weight[j - j % 3] * model->scene.loads[i].force[j % 3];
  PetscCall(VecRestoreArray(local, &f));
  PetscCall(VecRestoreArrayRead(weights, &weight));
  PetscCall(VecDestroy(&weights));
  PetscFunctionReturn(0);
}
