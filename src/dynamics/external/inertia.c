/*
   Forces on masses: gravity f = m g, and the inertial forces of a part that is described in a frame turning with Omega
   (rad/s) about a centre c,
      f = -m (2 Omega x v + Omega x (Omega x (X + u - c))),
   Coriolis force and centrifugal force, each where asked for, at t_n with v = v_{n-1/2}: the Coriolis force is lagged
   by half a step like damping, so that it does no power on v_{n-1/2} and a little on v_{n+1/2}. m is the whole lumped
   mass of a node; a node of two parts belongs to the frame that was set first.
*/
#include "externalimpl.h"
#include "base/algebra/vec3.h"
#include <squeal/options.h>

/* Weights of points */
static PetscErrorCode InertiaAddPoints(External external)
{
  const Layout     *layout = external->layout;
  const PetscReal  *g      = external->gravity;
  const ModelScene *scene;
  PetscScalar      *force;
  Vec               nodal;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(external->model, &scene));
  if (!scene->n_points) PetscFunctionReturn(0);
  PetscCall(ModelCreateNodal(external->model, &nodal));
  PetscCall(VecGetArray(nodal, &force));
  for (PetscInt i = 0; i < scene->n_points; i++) {
    const PetscReal m = scene->points[i].mass;

    ModelAddMeanForce(&scene->points[i].mean, (const PetscReal[6]){m * g[0], m * g[1], m * g[2]}, force);
  }
  PetscCall(VecRestoreArray(nodal, &force));
  PetscCall(ModelSumShared(external->model, nodal));
  PetscCall(VecGetArray(nodal, &force));
  for (PetscInt v = 0; v < layout->n_vertices; v++) {
    if (layout->at[v] < 0) continue;
    LayoutAdd(layout, v, &force[3 * v], external->weight);
    if (layout->owned[v]) LayoutAdd(layout, v, &force[3 * v], external->own_weight);
  }
  PetscCall(VecRestoreArray(nodal, &force));
  PetscCall(VecDestroy(&nodal));
  PetscFunctionReturn(0);
}

/* weight [layout n] = m g at all copies of a node, with the whole mass; own_weight at owned nodes alone, for the
   power. */
PetscErrorCode InertiaSetUp(External external)
{
  const Layout    *layout = external->layout;
  const PetscReal *g      = external->gravity;

  PetscFunctionBeginUser;
  if (g[0] == 0 && g[1] == 0 && g[2] == 0) PetscFunctionReturn(0);
  PetscCall(PetscCalloc2(layout->n, &external->weight, layout->n, &external->own_weight));
  for (PetscInt i = 0; i < layout->n_vertices; i++) {
    PetscReal force[3];

    if (layout->at[i] < 0) continue;
    for (int d = 0; d < 3; d++) force[d] = external->layout->total[layout->at[i]] * g[d];
    LayoutSet(layout, i, force, external->weight);
    if (layout->owned[i]) LayoutSet(layout, i, force, external->own_weight);
  }
  if (external->model) PetscCall(InertiaAddPoints(external)); /* without a model there are no points */
  PetscFunctionReturn(0);
}

/* f += m g; power m g . v (W) of owned nodes. Constant, hence the same power for `old` and `now`; no `old` before
   the first step. */
static void InertiaGravityAdvance(External external, const ExternalStep *step, ExternalPower *power)
{
  const PetscReal *weight = external->weight, *own = external->own_weight, *v = step->v;
  PetscReal       *f = step->f, sum = 0;

  for (PetscInt i = 0; i < external->layout->n; i++) {
    sum += own[i] * v[i];
    f[i] += weight[i];
  }
  power->now += sum;
  if (*external->begun != 0) power->old += sum;
}

/* Inertial force on mass m at place x (m) with velocity v, N */
static void InertiaFrameForce(const InertiaFrame *frame, PetscReal m, const PetscReal x[3], const PetscReal v[3],
                              PetscReal force[3])
{
  PetscReal arm[3], turn[3], centrifugal[3], coriolis[3];

  for (int d = 0; d < 3; d++) arm[d] = x[d] - frame->centre[d];
  Vec3Cross(frame->omega, arm, turn);
  Vec3Cross(frame->omega, turn, centrifugal);
  Vec3Cross(frame->omega, v, coriolis);
  for (int d = 0; d < 3; d++)
    force[d] = -m * ((frame->coriolis ? 2 * coriolis[d] : 0) + (frame->centrifugal ? centrifugal[d] : 0));
}

/* last [n][3] = the forces of this step, N, kept to complete their power with the next velocity. LayoutGet() and
   LayoutAdd() take care of the components. */
static void InertiaFrameAdvance(External external, InertiaFrame *frame, const PetscReal X[], const ExternalStep *step,
                                ExternalPower *power)
{
  const Layout *layout = external->layout;

  for (PetscInt k = 0; k < frame->n; k++) {
    const PetscInt i    = frame->vertex[k];
    PetscReal     *last = &frame->last[3 * k], x[3], velocity[3];

    LayoutGet(layout, i, step->u, x);
    LayoutGet(layout, i, step->v, velocity);
    for (int d = 0; d < 3; d++) {
      x[d] += X[3 * i + d];
      power->old += k < frame->n_owned ? last[d] * velocity[d] : 0;
    }
    InertiaFrameForce(frame, external->layout->total[layout->at[i]], x, velocity, last);
    for (int d = 0; d < 3 && k < frame->n_owned; d++) power->now += last[d] * velocity[d];
    LayoutAdd(layout, i, last, step->f);
  }
}

PetscErrorCode InertiaAdvance(External external, const ExternalStep *step, ExternalPower *power)
{
  const Mesh *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(external->model, &mesh));
  if (external->weight) InertiaGravityAdvance(external, step, power);
  for (PetscInt i = 0; i < external->n_frames; i++)
    InertiaFrameAdvance(external, &external->frames[i], mesh->x, step, power);
  PetscFunctionReturn(0);
}

/* Vertices of the part, owned ones first, without those of the frames before */
static PetscErrorCode InertiaFrameFindVertices(External external, const char part[], InertiaFrame *frame)
{
  PetscInt   n, n_owned;
  PetscBool *taken;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(external->layout->n_vertices, &taken));
  for (const InertiaFrame *before = external->frames; before < frame; before++)
    for (PetscInt k = 0; k < before->n; k++) taken[before->vertex[k]] = PETSC_TRUE;
  PetscCall(ExternalFindVertices(external, part, &n, &n_owned, &frame->vertex));
  for (PetscInt k = 0; k < n; k++) {
    if (taken[frame->vertex[k]]) continue;
    frame->vertex[frame->n++] = frame->vertex[k];
    if (k < n_owned) frame->n_owned = frame->n;
  }
  PetscCall(PetscFree(taken));
  PetscFunctionReturn(0);
}

/* Raises an error for a point with mass on a part that turns: its own inertial forces are not there */
static PetscErrorCode InertiaFrameCheckPoints(External external, const char part[], const InertiaFrame *frame)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(external->model, &scene));
  for (PetscInt i = 0; i < scene->n_points; i++) {
    const Joint *point = &scene->points[i];
    PetscInt     both  = 0;

    for (PetscInt k = 0; k < frame->n && JointIsMassive(point); k++)
      for (PetscInt l = 0; l < point->mean.n; l++) both += frame->vertex[k] == point->mean.vertex[l];
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &both, 1, MPIU_INT, MPI_MAX, external->comm));
    PetscCheck(!both, external->comm, PETSC_ERR_SUP,
               "point %s has a mass on part %s, which turns: not supported by -analysis transient", point->name, part);
  }
  PetscFunctionReturn(0);
}

/* The frame of a part, a new one where it has none; an error for no part */
static PetscErrorCode InertiaFrameFind(External external, const char part[], InertiaFrame **frame)
{
  const ModelScene *scene;
  PetscInt          i;
  PetscBool         same = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(external->model, &scene));
  for (i = 0; i < scene->n_parts; i++) {
    PetscCall(PetscStrcmp(part, scene->parts[i].name, &same));
    if (same) break;
  }
  PetscCheck(same, external->comm, PETSC_ERR_ARG_OUTOFRANGE, "'%s' is none of the -parts: it has no frame", part);
  for (PetscInt k = 0; k < external->n_frames; k++) {
    *frame = &external->frames[k];
    if ((*frame)->part == i) PetscFunctionReturn(0);
  }
  *frame         = &external->frames[external->n_frames];
  (*frame)->part = i;
  PetscCall(InertiaFrameFindVertices(external, part, *frame));
  PetscCall(InertiaFrameCheckPoints(external, part, *frame));
  external->n_frames++;
  PetscCall(ExternalLayMemory(external));
  PetscFunctionReturn(0);
}

PetscErrorCode ExternalSetFrame(External external, const char part[], const PetscReal omega[3],
                                const PetscReal centre[3], PetscBool coriolis, PetscBool centrifugal)
{
  InertiaFrame *frame = NULL;

  PetscFunctionBeginUser;
  PetscCheck(external->layout, external->comm, PETSC_ERR_ARG_WRONGSTATE,
             "ExternalSetUp() must come before the frame of %s", part);
  PetscCall(InertiaFrameFind(external, part, &frame));
  PetscCall(PetscArraycpy(frame->omega, omega, 3));
  PetscCall(PetscArraycpy(frame->centre, centre, 3));
  frame->coriolis    = coriolis;
  frame->centrifugal = centrifugal;
  PetscFunctionReturn(0);
}

PetscErrorCode InertiaView(External external, PetscViewer viewer)
{
  const PetscReal  *g = external->gravity;
  const ModelScene *scene;

  PetscFunctionBeginUser;
  if (g[0] != 0 || g[1] != 0 || g[2] != 0)
    PetscCall(
      PetscViewerASCIIPrintf(viewer, "  gravity: %.6g, %.6g, %.6g m/s^2\n", (double)g[0], (double)g[1], (double)g[2]));
  PetscCall(ModelGetScene(external->model, &scene));
  for (PetscInt i = 0; i < external->n_frames; i++) {
    const InertiaFrame *frame = &external->frames[i];
    const PetscReal    *w     = frame->omega;

    PetscCall(
      PetscViewerASCIIPrintf(viewer, "  part %s turns with %.6g rad/s: Coriolis force %s, centrifugal force %s\n",
                             scene->parts[frame->part].name, (double)Vec3Length(w),
                             frame->coriolis ? "counted" : "left out", frame->centrifugal ? "counted" : "left out"));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode InertiaDestroy(External external)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < external->n_frames; i++) PetscCall(PetscFree(external->frames[i].vertex));
  PetscCall(PetscFree(external->frames));
  PetscCall(PetscFree2(external->weight, external->own_weight));
  PetscFunctionReturn(0);
}
