/*
   Bushings and points: forces B'(k q + c q') of the six motions q = B u (model.h) at all nodes of their sets, one sum
   over ranks in each step. q in m and rad, k in N/m and N m/rad, c in N s/m and N m s/rad, B without unit and in 1/m.
*/
#include "dynamics/bodies/bodiesimpl.h"

/* The rows of one motion at all copies of the nodes, in the layout: B' times a unit force along motion j gives the
   row of B, which ModelAddMeanForce() has only for the nodes it owns */
static PetscErrorCode JointSetRow(Bodies b, const ModelMean *mean, int j, Vec nodal, BodyJoint *joint)
{
  const PetscScalar *value;
  PetscScalar       *own;

  PetscFunctionBeginUser;
  PetscCall(VecSet(nodal, 0));
  PetscCall(VecGetArray(nodal, &own));
  ModelAddMeanForce(mean, (const PetscReal[6]){j == 0, j == 1, j == 2, j == 3, j == 4, j == 5}, own);
  PetscCall(VecRestoreArray(nodal, &own));
  PetscCall(ModelSumShared(b->model, nodal));
  PetscCall(VecGetArrayRead(nodal, &value));
  for (PetscInt i = 0; i < 3 * joint->n; i++) {
    const PetscInt   v = joint->vertex[i / 3];
    const PetscReal *q = &b->layout.basis[9 * v + 3 * (i % 3)];

    for (int d = 0; d < 3; d++) joint->b[6 * i + j] += q[d] * value[3 * v + d];
  }
  PetscCall(VecRestoreArrayRead(nodal, &value));
  PetscFunctionReturn(0);
}

/* The copies of the nodes of a motion on this rank: owners mark theirs with 1, and the sum at shared nodes marks the
   copies */
static PetscErrorCode JointFindNodes(Bodies b, const ModelMean *mean, Vec nodal, BodyJoint *joint)
{
  const PetscInt     n = b->layout.n_vertices;
  const PetscScalar *value;
  PetscScalar       *own;

  PetscFunctionBeginUser;
  PetscCall(VecSet(nodal, 0));
  PetscCall(VecGetArray(nodal, &own));
  for (PetscInt i = 0; i < mean->n; i++) own[3 * mean->vertex[i]] = 1;
  PetscCall(VecRestoreArray(nodal, &own));
  PetscCall(ModelSumShared(b->model, nodal));
  PetscCall(VecGetArrayRead(nodal, &value));
  joint->n = 0;
  for (PetscInt v = 0; v < n; v++) joint->n += value[3 * v] > 0 && b->layout.at[v] >= 0;
  PetscCall(PetscMalloc1(joint->n, &joint->vertex));
  joint->n = 0;
  for (PetscInt v = 0; v < n; v++)
    if (value[3 * v] > 0 && b->layout.at[v] >= 0) joint->vertex[joint->n++] = v;
  PetscCall(VecRestoreArrayRead(nodal, &value));
  PetscCall(PetscCalloc1(18 * joint->n, &joint->b));
  PetscFunctionReturn(0);
}

static PetscErrorCode BodyJointSetUp(Bodies b, const Joint *like, Vec nodal, BodyJoint *joint)
{
  PetscFunctionBeginUser;
  joint->like    = like;
  joint->massive = JointIsMassive(like);
  joint->heavy   = joint->massive && !like->rigid ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(JointFindNodes(b, &like->mean, nodal, joint));
  for (int j = 0; j < 6; j++) PetscCall(JointSetRow(b, &like->mean, j, nodal, joint));
  PetscFunctionReturn(0);
}

PetscErrorCode JointsSetUpRows(Bodies b)
{
  const ModelScene *scene;
  Vec               nodal;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(b->model, &scene));
  b->n_joints = scene->n_joints + scene->n_points;
  if (!b->n_joints) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(b->n_joints, &b->joint));
  PetscCall(PetscCalloc1(6 * b->n_joints, &b->joint_motion));
  PetscCall(ModelCreateNodal(b->model, &nodal));
  for (PetscInt i = 0; i < b->n_joints; i++)
    PetscCall(BodyJointSetUp(b, i < scene->n_joints ? &scene->joints[i] : &scene->points[i - scene->n_joints], nodal,
                             &b->joint[i]));
  PetscCall(VecDestroy(&nodal));
  PetscFunctionReturn(0);
}

/* q = B (scale x) of all joints over all ranks, each node counted by its owner; into joint_motion [n_joints][6] */
PetscErrorCode JointsMotion(Bodies b, const PetscReal scale[], const PetscReal x[])
{
  PetscReal  *q = b->joint_motion;
  PetscMPIInt n;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(q, 6 * b->n_joints));
  for (PetscInt m = 0; m < b->n_joints; m++, q += 6) {
    const BodyJoint *joint = &b->joint[m];

    for (PetscInt i = 0; i < 3 * joint->n; i++) {
      const PetscInt  at    = JointAt(&b->layout, joint, i);
      const PetscReal value = scale ? scale[at] * x[at] : x[at];

      for (int j = 0; j < 6 && b->layout.owned[joint->vertex[i / 3]]; j++) q[j] += joint->b[6 * i + j] * value;
    }
  }
  PetscCall(PetscMPIIntCast(6 * b->n_joints, &n));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, b->joint_motion, n, MPIU_REAL, MPI_SUM, b->comm));
  PetscFunctionReturn(0);
}

/* ku += dt B'k B v, d += B'c B v, f -= both, at nodes that this rank owns, N; others get them by the sum at shared
   nodes. All of early and late nodes from one sum of motions. */
PetscErrorCode JointsAdvance(Bodies b, PetscBool early, BodiesWork *w)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  if (!b->n_joints) PetscFunctionReturn(0);
  if (early) PetscCall(JointsMotion(b, NULL, w->v));
  PetscCallMPI(MPI_Comm_rank(b->comm, &rank));
  for (PetscInt m = 0; m < b->n_joints; m++) {
    const BodyJoint *joint = &b->joint[m];
    const PetscReal *q = &b->joint_motion[6 * m], *k = joint->like->stiffness, *c = joint->like->viscosity;

    if (early && joint->massive && !rank) w->sums.kinetic += PointKinetic(joint->like, q);
    for (PetscInt i = 0; i < 3 * joint->n; i++) {
      const PetscInt v = joint->vertex[i / 3], at = JointAt(&b->layout, joint, i);
      PetscReal      g = 0, h = 0;

      if (!b->layout.owned[v] || b->share.shared[v] != early) continue;
      for (int j = 0; j < 6; j++) g += joint->b[6 * i + j] * k[j] * q[j], h += joint->b[6 * i + j] * c[j] * q[j];
      w->ku[at] += w->dt * g;
      w->f[at] -= w->dt * g;
      if (!w->d) continue;
      w->d[at] += h;
      w->f[at] -= h;
      w->sums.damping += w->v[at] * h;
    }
  }
  PetscFunctionReturn(0);
}

/* ku += B'k B u, N, at nodes that this rank owns: springs alone, without dashpots */
PetscErrorCode JointsAddForces(Bodies b, const PetscReal u[], PetscReal ku[])
{
  PetscFunctionBeginUser;
  if (!b->n_joints) PetscFunctionReturn(0);
  PetscCall(JointsMotion(b, NULL, u));
  for (PetscInt m = 0; m < b->n_joints; m++) {
    const BodyJoint *joint = &b->joint[m];

    for (PetscInt i = 0; i < 3 * joint->n; i++)
      for (int j = 0; j < 6 && b->layout.owned[joint->vertex[i / 3]]; j++)
        ku[JointAt(&b->layout, joint, i)] +=
          joint->b[6 * i + j] * joint->like->stiffness[j] * b->joint_motion[6 * m + j];
  }
  PetscFunctionReturn(0);
}

/* bound += trace(D^-1 B'(k + s c) B), (rad/s)^2: at least the largest eigenvalue of all joints together, and
   simple. */
PetscErrorCode JointsAddBound(Bodies b, PetscReal s, PetscReal *bound)
{
  PetscReal sum = 0;

  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < b->n_joints; m++) {
    const BodyJoint *joint = &b->joint[m];

    for (PetscInt i = 0; i < 3 * joint->n; i++)
      for (int j = 0; j < 6 && b->layout.owned[joint->vertex[i / 3]]; j++)
        sum += (joint->like->stiffness[j] + s * joint->like->viscosity[j]) * PetscSqr(joint->b[6 * i + j]) /
               b->layout.total[JointAt(&b->layout, joint, i)];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPIU_REAL, MPI_SUM, b->comm));
  *bound += sum;
  PetscFunctionReturn(0);
}

PetscErrorCode JointsDestroyRows(Bodies b)
{
  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < b->n_joints; m++) {
    PetscCall(PetscFree(b->joint[m].vertex));
    PetscCall(PetscFree(b->joint[m].b));
  }
  PetscCall(PetscFree(b->joint));
  PetscCall(PetscFree(b->joint_motion));
  PetscCall(PetscFree(b->reaction));
  PetscFunctionReturn(0);
}
