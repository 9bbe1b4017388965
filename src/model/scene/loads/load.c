/*
   Loads on named sets: a total force F (N), f_v = F s_v with the shares s_v of the nodes v (spread.c), or a pressure
   p (Pa) on a surface, which pushes into the body,

      f_v = -p int N_v n dA,   n the normal out of the body,

   N_v being the shape functions of the faces; or a force and a moment on a point, f = B'(F, M) (mean.c). All keep
   their directions while the body moves. Bolts are in bolt.c.
*/
#include "model/modelimpl.h"
#include "base/algebra/vec3.h"
#include "kernels/contact/facet.h"
#include "quantity/ramp.h"
#include <squeal/options.h>

/* The set of a load, or its point with the moment on it */
static PetscErrorCode LoadCheckPlace(MPI_Comm comm, Model model, Load *load)
{
  PetscFunctionBeginUser;
  load->on_point = load->on[0] ? PETSC_TRUE : PETSC_FALSE;
  PetscCheck(!load->set[0] || !load->on_point, comm, PETSC_ERR_USER_INPUT,
             "-%s_set and -%s_point are given; give one of them", load->name, load->name);
  PetscCheck(load->set[0] || load->on_point, comm, PETSC_ERR_USER_INPUT,
             "-%s_set must be given: a named set of the mesh; or -%s_point, one of the -points", load->name,
             load->name);
  PetscCheck(!load->has_moment || load->on_point, comm, PETSC_ERR_USER_INPUT,
             "-%s_moment does nothing without -%s_point, one of the -points", load->name, load->name);
  if (load->on_point) PetscCall(JointFindPoint(model, load->name, load->on, &load->point));
  PetscFunctionReturn(0);
}

PetscErrorCode LoadCheck(MPI_Comm comm, void *owner, void *record)
{
  Load     *load = record;
  PetscReal sum  = 0;

  PetscFunctionBeginUser;
  PetscCall(BoltCheck(comm, owner, load));
  PetscCall(RampSwings(load->name, &load->swings));
  PetscCheck(!load->is_bolt || !load->swings, comm, PETSC_ERR_USER_INPUT,
             "-%s_frequency: a bolt under tension does not swing about zero; leave it out", load->name);
  if (load->is_bolt) PetscFunctionReturn(0);
  PetscCall(LoadCheckPlace(comm, owner, load));
  PetscCheck(!load->has_force || !load->is_pressure, comm, PETSC_ERR_USER_INPUT,
             "-%s_force and -%s_pressure are given; give one of them", load->name, load->name);
  PetscCheck(!load->is_pressure || !load->on_point, comm, PETSC_ERR_USER_INPUT,
             "-%s_pressure acts on a surface, -%s_set, and not on -%s_point", load->name, load->name, load->name);
  PetscCheck(!load->is_pressure || load->pressure != 0, comm, PETSC_ERR_USER_INPUT,
             "-%s_pressure %.6g must be finite and not zero (Pa)", load->name, (double)load->pressure);
  for (int d = 0; d < 3; d++) sum += PetscAbsReal(load->force[d]) + PetscAbsReal(load->moment[d]);
  PetscCheck(sum > 0 || load->is_pressure, comm, PETSC_ERR_USER_INPUT,
             "-%s_force must be given: three values, not all zero (N); or -%s_pressure (Pa)", load->name, load->name);
  PetscFunctionReturn(0);
}

/* Adds -p int N_v n dA of the faces on this rank to f[3 v], and their area (m^2) to *area */
static PetscErrorCode PressureAdd(Model model, const Load *load, PetscScalar f[], PetscReal *area)
{
  ModelFaces faces;

  PetscFunctionBeginUser;
  PetscCall(ModelGetSetFaces(model, load->set, &faces));
  for (PetscInt i = 0; i < faces.n; i++) {
    const PetscInt *node;
    double          x[FACET_NODES][3], share[FACET_NODES][3], whole[3] = {0, 0, 0};
    const int       n = (int)ModelFacesGet(&faces, &model->mesh, i, &node, x);

    FacetAreaNormals(n, (const double(*)[3])x, share);
    for (int k = 0; k < n; k++)
      for (int d = 0; d < 3; d++) {
        f[3 * node[k] + d] -= load->pressure * share[k][d];
        whole[d] += share[k][d];
      }
    *area += Vec3Length(whole);
  }
  PetscCall(ModelFacesDestroy(&faces));
  PetscFunctionReturn(0);
}

/* Raises an error for a face with cells on both sides, where there is no outside */
static PetscErrorCode PressureCheckFaces(Model model, const Load *load)
{
  PetscInt inner;

  PetscFunctionBeginUser;
  PetscCall(ModelCountInnerFaces(model, load->set, &inner));
  PetscCheck(!inner, model->comm, PETSC_ERR_USER_INPUT,
             "-%s_pressure: %" PetscInt_FMT
             " faces of -%s_set %s lie inside of a body, with a cell on both sides; name "
             "a surface of it",
             load->name, inner, load->name, load->set);
  PetscFunctionReturn(0);
}

/* B'(F, M) */
static PetscErrorCode PointCreateForces(Model model, const Load *load, Vec *forces)
{
  PetscReal    wrench[6];
  PetscScalar *f;

  PetscFunctionBeginUser;
  for (int d = 0; d < 3; d++) wrench[d] = load->force[d], wrench[3 + d] = load->moment[d];
  PetscCall(ModelCreateNodal(model, forces));
  PetscCall(VecGetArray(*forces, &f));
  ModelAddMeanForce(&model->scene.points[load->point].mean, wrench, f);
  PetscCall(VecRestoreArray(*forces, &f));
  PetscCall(ModelSumShared(model, *forces));
  PetscFunctionReturn(0);
}

/* The sum of |f| over all nodes, N */
static PetscErrorCode ForcesSize(Model model, Vec forces, PetscReal *size)
{
  const PetscScalar *f;

  PetscFunctionBeginUser;
  *size = 0;
  PetscCall(VecGetArrayRead(forces, &f));
  for (PetscInt j = 0; j < 3 * model->mesh.n_nodes; j++)
    if (model->mesh.owned[j / 3]) *size += PetscAbsReal(f[j]);
  PetscCall(VecRestoreArrayRead(forces, &f));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, size, 1, MPIU_REAL, MPI_SUM, model->comm));
  PetscFunctionReturn(0);
}

/* The forces of a load at full size, on every rank that has the node, N; the caller destroys the vector. *area: of a
   surface under pressure, m^2 */
static PetscErrorCode LoadCreateForces(Model model, const Load *load, Vec *forces, PetscReal *area)
{
  PetscScalar *f;
  PetscInt     n;

  PetscFunctionBeginUser;
  *area = 0;
  if (load->on_point) {
    PetscCall(PointCreateForces(model, load, forces));
    PetscFunctionReturn(0);
  }
  if (!load->is_pressure) {
    PetscCall(SharesCreate(model, load->name, load->set, SPREAD_TOTAL, PETSC_TRUE, forces));
    PetscCall(VecGetLocalSize(*forces, &n));
    PetscCall(VecGetArray(*forces, &f));
    for (PetscInt j = n - 1; j >= 0; j--) f[j] = f[j - j % 3] * load->force[j % 3];
    PetscCall(VecRestoreArray(*forces, &f));
    PetscFunctionReturn(0);
  }
  PetscCall(ModelCreateNodal(model, forces));
  PetscCall(VecGetArray(*forces, &f));
  PetscCall(PressureAdd(model, load, f, area));
  PetscCall(VecRestoreArray(*forces, &f));
  PetscCall(ModelSumShared(model, *forces));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, area, 1, MPIU_REAL, MPI_SUM, model->comm));
  PetscFunctionReturn(0);
}

/* The resultant of a pressure, N */
static PetscErrorCode PressureSum(Model model, Load *load, Vec forces)
{
  const PetscScalar *f;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(forces, &f));
  for (PetscInt j = 0; j < 3 * model->mesh.n_nodes; j++)
    if (model->mesh.owned[j / 3]) load->force[j % 3] += f[j];
  PetscCall(VecRestoreArrayRead(forces, &f));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, load->force, 3, MPIU_REAL, MPI_SUM, model->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode LoadsSetUp(Model model)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < model->scene.n_loads; i++) {
    Load     *load = &model->scene.loads[i];
    PetscReal area;
    Vec       forces;

    if (load->is_bolt) PetscCall(BoltSetUp(model, load));
    if (load->is_bolt) continue;
    if (load->is_pressure) PetscCall(PressureCheckFaces(model, load));
    PetscCall(LoadCreateForces(model, load, &forces, &area));
    if (load->is_pressure) PetscCall(PressureSum(model, load, forces));
    load->size = PetscAbsReal(load->pressure) * area;
    for (int d = 0; d < 3 && !load->is_pressure; d++) load->size += PetscAbsReal(load->force[d]);
    if (load->on_point) PetscCall(ForcesSize(model, forces, &load->size));
    PetscCall(VecDestroy(&forces));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LoadView(Model model, const Load *load, PetscViewer viewer)
{
  char        words[64] = "", moment[128] = "";
  const char *pascal, *unit;

  PetscFunctionBeginUser;
  if (load->is_bolt) {
    PetscCall(BoltView(model, load, viewer));
    PetscFunctionReturn(0);
  }
  PetscCall(ModelGetUnit(model, "Pa", &pascal));
  PetscCall(ModelGetUnit(model, "N m", &unit));
  if (load->on_point)
    PetscCall(PetscSNPrintf(moment, sizeof(moment), ", and %.6g, %.6g, %.6g %s", (double)load->moment[0],
                            (double)load->moment[1], (double)load->moment[2], unit));
  if (load->is_pressure) PetscCall(PetscSNPrintf(words, sizeof(words), "%.6g %s, ", (double)load->pressure, pascal));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  load %s on %s: %s%.6g, %.6g, %.6g N in all%s%s\n", load->name,
                                   load->on_point ? "a point" : load->set, words, (double)load->force[0],
                                   (double)load->force[1], (double)load->force[2], moment,
                                   load->swings ? ", swings about zero, in time alone" : ""));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelAddLoad(Model model, PetscInt i, const PetscReal factor[2], Vec local)
{
  Load      load;
  PetscReal area;
  Vec       forces;

  PetscFunctionBeginUser;
  PetscCheck(i >= 0 && i < model->scene.n_loads, model->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "load %" PetscInt_FMT " does not exist: there are %" PetscInt_FMT, i, model->scene.n_loads);
  load = model->scene.loads[i];
  PetscCheck(!load.is_bolt, model->comm, PETSC_ERR_PLIB, "bolt %s is no load of the model alone", load.name);
  if (factor) load.pressure *= factor[0];
  for (int d = 0; d < 3 && factor; d++) load.force[d] *= factor[0], load.moment[d] *= factor[1];
  PetscCall(LoadCreateForces(model, &load, &forces, &area));
  PetscCall(VecAXPY(local, 1, forces));
  PetscCall(VecDestroy(&forces));
  PetscFunctionReturn(0);
}
