/*
   Prescribed displacements d(t) = r(t) d of sets, in some directions. The directions have no inertia of their own in
   the integrator (minv = 0); the step from t_n gives them
      v_{n+1/2} = (d(t_n + dt) - d(t_n)) / dt
   and the drive exerts what the other forces f_n leave over, R_n = m (v_{n+1/2} - v_{n-1/2}) / dt - f_n, m the lumped
   mass, with the power R_n . (v_{n-1/2} + v_{n+1/2}) / 2: then the kinetic energy of the prescribed nodes is accounted
   for exactly.

   Along a component j of a node's basis q_j the directions D that are prescribed have the share s = sum_{d in D}
   q_jd^2. It must be 0 or 1: a body with radial and circumferential components cannot be prescribed in one direction
   across its axis alone.
*/
#include "externalimpl.h"
#include <petscbt.h>
#include <squeal/options.h>

/* of s, from 0 and 1: rounding of bases */
#define SHARE_TOLERANCE 1e-8
#define MOTION_BEGINS   1e-12 /* part of a displacement that is rounding of 0 */

PetscErrorCode MotionsSetFromOptions(External external)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(external->model, &scene));
  external->n_motions = scene->n_motions;
  PetscCall(PetscCalloc1(external->n_motions, &external->motions));
  for (PetscInt i = 0; i < external->n_motions; i++) {
    Drive *motion = &external->motions[i];

    motion->prescribed = &scene->motions[i];
    PetscCall(RampSetFromOptions(external->comm, "History of motion", motion->prescribed->name, &motion->ramp));
  }
  PetscFunctionReturn(0);
}

/* Raises the error for a jump at the beginning, whose velocity d / dt would depend on the step */
static PetscErrorCode MotionCheckRamp(MPI_Comm comm, const Drive *motion)
{
  const PetscReal *x = motion->prescribed->displacement;

  PetscFunctionBeginUser;
  PetscCheck(
    (x[0] == 0 && x[1] == 0 && x[2] == 0) || PetscAbsReal(RampValue(&motion->ramp, motion->ramp.delay)) < MOTION_BEGINS,
    comm, PETSC_ERR_USER_INPUT,
    "-%s_ramp %.6g must be given and positive (s): a displacement cannot jump; a -%s_history may begin with 0, "
    "a -%s_frequency with -%s_phase 90 or -90",
    motion->prescribed->name, motion->ramp.length, motion->prescribed->name, motion->prescribed->name,
    motion->prescribed->name);
  PetscFunctionReturn(0);
}

PetscErrorCode ExternalCheckMotions(External external, PetscBool moved)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < external->n_motions; i++)
    if (!moved || external->motions[i].prescribed->swings)
      PetscCall(MotionCheckRamp(external->comm, &external->motions[i]));
  PetscFunctionReturn(0);
}

const Ramp *ExternalGetMotion(External external, PetscInt i)
{
  return &external->motions[i].ramp;
}

/* Share of the prescribed directions in component j of a node */
static PetscReal MotionShare(const Drive *motion, const Layout *layout, PetscInt vertex, int j)
{
  const PetscReal *q     = &layout->basis[9 * vertex + 3 * j];
  PetscReal        share = 0;

  for (int d = 0; d < 3; d++) share += motion->prescribed->direction[d] ? q[d] * q[d] : 0;
  return share;
}

/* Appends the free prescribed components of a node and holds them; trouble[0] counts components that the directions
   split, trouble[1] those that another motion prescribes */
static PetscErrorCode MotionAddVertex(External external, Bodies bodies, PetscInt vertex, PetscBT taken, Drive *motion,
                                      PetscInt trouble[2])
{
  const Layout    *layout = external->layout;
  const PetscReal *x      = motion->prescribed->displacement;

  PetscFunctionBeginUser;
  for (int j = 0; j < 3; j++) {
    const PetscInt   index = layout->at[vertex] + j * layout->step[vertex];
    const PetscReal *q     = &layout->basis[9 * vertex + 3 * j];
    const PetscReal  share = MotionShare(motion, layout, vertex, j);

    if (share < SHARE_TOLERANCE) continue;
    trouble[0] += share < 1 - SHARE_TOLERANCE;
    trouble[1] += PetscBTLookup(taken, index) ? 1 : 0;
    if (external->layout->minv[index] == 0) continue;
    motion->index[motion->n]  = index;
    motion->full[motion->n++] = q[0] * x[0] + q[1] * x[1] + q[2] * x[2];
    PetscCall(BodiesHold(bodies, vertex, j));
    PetscCall(PetscBTSet(taken, index));
  }
  PetscFunctionReturn(0);
}

/* Prescribed numbers of the set's nodes, those of owned nodes first */
static PetscErrorCode MotionFindNumbers(External external, Bodies bodies, PetscBT taken, Drive *motion,
                                        PetscInt trouble[2])
{
  PetscInt n, n_owned, *vertex;

  PetscFunctionBeginUser;
  PetscCall(ExternalFindVertices(external, motion->prescribed->set, &n, &n_owned, &vertex));
  PetscCall(PetscMalloc4(3 * n, &motion->index, 3 * n, &motion->full, 3 * n, &motion->before, 3 * n, &motion->after));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(MotionAddVertex(external, bodies, vertex[i], taken, motion, trouble));
    if (i < n_owned) motion->n_owned = motion->n;
  }
  PetscCall(PetscFree(vertex));
  PetscFunctionReturn(0);
}

/* Raises the error for directions that split the components of a swept body */
static PetscErrorCode MotionCheckSplit(MPI_Comm comm, const PrescribedMotion *motion, PetscInt n_split)
{
  char words[256];

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &n_split, 1, MPIU_INT, MPI_SUM, comm));
  PetscCall(ModelDescribeMotion(motion, sizeof(words), words));
  PetscCheck(!n_split, comm, PETSC_ERR_USER_INPUT,
             "%s: splits the radial and circumferential components of a swept body: prescribe by -%s_directions both "
             "directions across its axis, or neither",
             words, motion->name);
  PetscFunctionReturn(0);
}

PetscErrorCode MotionsSetUp(External external, Bodies bodies)
{
  const Mesh *mesh;
  PetscBT     taken;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(external->model, &mesh));
  if (mesh->prescribed) PetscFunctionReturn(0); /* held by the model from the start: nothing moves */
  PetscCall(PetscBTCreate(external->layout->n, &taken));
  for (PetscInt i = 0; i < external->n_motions; i++) {
    Drive   *motion     = &external->motions[i];
    PetscInt trouble[2] = {0, 0};

    PetscCall(MotionCheckRamp(external->comm, motion));
    PetscCall(MotionFindNumbers(external, bodies, taken, motion, trouble));
    PetscCall(MotionCheckSplit(external->comm, motion->prescribed, trouble[0]));
    PetscCall(ModelCheckMotion(external->model, motion->prescribed, motion->n, trouble[1]));
  }
  PetscCall(PetscBTDestroy(&taken));
  PetscFunctionReturn(0);
}

PetscErrorCode MotionsAdvance(External external, const ExternalStep *step)
{
  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < external->n_motions; m++) {
    Drive          *motion = &external->motions[m];
    const PetscReal begin  = RampValue(&motion->ramp, step->time);
    const PetscReal rate   = (RampValue(&motion->ramp, step->time + step->dt) - begin) / step->dt;

    for (PetscInt i = 0; i < motion->n; i++) {
      motion->before[i] = step->v[motion->index[i]];
      motion->after[i] = step->v[motion->index[i]] = rate * motion->full[i];
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode MotionsFinish(External external, PetscReal dt, const PetscReal f[])
{
  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < external->n_motions; m++) {
    const Drive *motion = &external->motions[m];

    for (PetscInt i = 0; i < motion->n_owned; i++) {
      const PetscReal before = motion->before[i], after = motion->after[i];
      const PetscReal drive = external->layout->total[motion->index[i]] * (after - before) / dt - f[motion->index[i]];

      *external->drives += drive * (before + after);
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode MotionsView(External external, PetscViewer viewer)
{
  char words[256], ramp[160];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < external->n_motions; i++) {
    const Drive     *motion = &external->motions[i];
    const PetscReal *x      = motion->prescribed->displacement;

    PetscCall(ModelDescribeMotion(motion->prescribed, sizeof(words), words));
    PetscCall(RampDescribe(&motion->ramp, sizeof(ramp), ramp));
    if (x[0] != 0 || x[1] != 0 || x[2] != 0)
      PetscCall(PetscViewerASCIIPrintf(viewer, "  %s, %s\n", words, ramp));
    else
      PetscCall(PetscViewerASCIIPrintf(viewer, "  %s\n", words));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode MotionsDestroy(External external)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < external->n_motions; i++) {
    Drive *motion = &external->motions[i];

    PetscCall(RampDestroy(&motion->ramp));
    PetscCall(PetscFree4(motion->index, motion->full, motion->before, motion->after));
  }
  PetscCall(PetscFree(external->motions));
  PetscFunctionReturn(0);
}
