/*
   Points that are joined rigidly, in time: the nodes of the set have the accelerations R a of one rigid body, rows of R
   being the motions of the nodes for the six of the point, with D the lumped masses of the nodes and W mass and inertia
   of the point,

      a = X R'f,   X = (R'D R + W)^-1,

   so that forces D R a in the place of f make the integrator, which divides by D, keep the set rigid to rounding. By
   central differences their work is that of f less what the kinetic energy of the point gains. Displacements and
   velocities at the start are replaced by the rigid ones next to them in D.
*/
#include "dynamics/bodies/bodiesimpl.h"
#include "base/algebra/vec3.h"
#include "base/algebra/dense.h"

/* Component i % 3 of node i / 3 for the six motions: e . (q_t + q_r x r) = e . q_t + q_r . (r x e), r (m) from the
   point to the node */
static void RigidRow(Bodies b, const BodyJoint *joint, PetscInt i, PetscReal row[6])
{
  const PetscInt   v = joint->vertex[i / 3];
  const PetscReal *e = &b->layout.basis[9 * v + 3 * (i % 3)];
  PetscReal        r[3];

  for (int d = 0; d < 3; d++) r[d] = b->mesh->x[3 * v + d] - joint->like->at[d];
  for (int d = 0; d < 3; d++) row[d] = e[d];
  Vec3Cross(r, e, &row[3]); /* e . (w x r) = w . (r x e) */
}

/* R'f of the nodes that ranks own, or R'D f, over all ranks */
static PetscErrorCode RigidSum(Bodies b, const BodyJoint *joint, PetscBool weighted, const PetscReal f[],
                               PetscReal sum[6])
{
  PetscFunctionBeginUser;
  for (int j = 0; j < 6; j++) sum[j] = 0;
  for (PetscInt i = 0; i < 3 * joint->n; i++) {
    const PetscInt at = JointAt(&b->layout, joint, i);
    PetscReal      row[6];

    if (!b->layout.owned[joint->vertex[i / 3]]) continue;
    RigidRow(b, joint, i, row);
    for (int j = 0; j < 6; j++) sum[j] += row[j] * f[at] * (weighted ? b->layout.total[at] : 1);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 6, MPIU_REAL, MPI_SUM, b->comm));
  PetscFunctionReturn(0);
}

/* f = R a at all copies, or D R a */
static void RigidPut(Bodies b, const BodyJoint *joint, PetscBool weighted, const PetscReal a[6], PetscReal f[])
{
  for (PetscInt i = 0; i < 3 * joint->n; i++) {
    const PetscInt at = JointAt(&b->layout, joint, i);
    PetscReal      row[6];

    RigidRow(b, joint, i, row);
    f[at] = 0;
    for (int j = 0; j < 6; j++) f[at] += row[j] * a[j] * (weighted ? b->layout.total[at] : 1);
  }
}

/* The inverse of a symmetric matrix [6][6] */
static PetscErrorCode RigidInvert(PetscReal A[36], PetscReal inverse[36])
{
  PetscFunctionBeginUser;
  for (int i = 0; i < 36; i++) inverse[i] = i % 7 == 0;
  PetscCall(DenseSolveWith(6, A, 6, inverse, NULL));
  PetscFunctionReturn(0);
}

/* nearest = (R'D R)^-1 for states, mobility = (R'D R + W)^-1 for forces, [6][6]: kg, kg m and kg m^2 inverted.
   Summed over owned nodes, alike on all ranks. */
PetscErrorCode RigidPointSetUp(Bodies b, BodyJoint *joint)
{
  PetscReal A[36] = {0}, W[36];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < 3 * joint->n; i++) {
    const PetscReal m = b->layout.total[JointAt(&b->layout, joint, i)];
    PetscReal       row[6];

    if (!b->layout.owned[joint->vertex[i / 3]]) continue;
    RigidRow(b, joint, i, row);
    for (int k = 0; k < 36; k++) A[k] += row[k / 6] * m * row[k % 6];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, A, 36, MPIU_REAL, MPI_SUM, b->comm));
  PointInertia(joint->like, W);
  for (int k = 0; k < 36; k++) W[k] += A[k];
  PetscCall(RigidInvert(A, joint->nearest));
  PetscCall(RigidInvert(W, joint->mobility));
  PetscFunctionReturn(0);
}

/* Of all rigid points: forces f become D R W R'f with their mobility W; motions x become R W R'D x, the nearest rigid
   ones */
PetscErrorCode RigidPointsApply(Bodies b, PetscBool forces, PetscReal x[])
{
  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < b->n_joints; m++) {
    const BodyJoint *joint = &b->joint[m];
    const PetscReal *W     = forces ? joint->mobility : joint->nearest;
    PetscReal        sum[6], q[6] = {0};

    if (!joint->like->rigid) continue;
    PetscCall(RigidSum(b, joint, forces ? PETSC_FALSE : PETSC_TRUE, x, sum));
    for (int k = 0; k < 36; k++) q[k / 6] += W[k] * sum[k % 6];
    RigidPut(b, joint, forces, q, x);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode BodiesMakeRigid(Bodies b, PetscReal x[])
{
  PetscFunctionBeginUser;
  PetscCall(RigidPointsApply(b, PETSC_FALSE, x));
  PetscCall(TiedApply(b, PETSC_FALSE, x));
  PetscFunctionReturn(0);
}
