/*
   Masses of points. Mass and inertia W of points (block diagonal, six rows each) add B'W B to the diagonal masses D, so
   that the mass matrix is no diagonal; but by Woodbury's identity

      (D + B'W B)^-1 f = D^-1 (f - B' X B D^-1 f),   X = W (I + S W)^-1,   S = B D^-1 B',

   the integrator, which divides by D, needs no more than the inertial forces -B' X B D^-1 f of the points beside f.
   Held directions have D^-1 = 0: those of supports do not move, and others are refused. The critical step is found with
   D alone: D + B'W B is larger, hence that step smaller than it might be. The work of the inertial forces is, by
   central differences exactly, what the kinetic energy 1/2 q'W q of the points loses.
*/
#include "dynamics/bodies/bodiesimpl.h"
#include "base/algebra/dense.h"

/* What a node of a point with a mass must not be */
enum { NODE_DRIVEN, NODE_IN_CONTACT, NODE_OF_RIGID, N_NODE_FAULTS };

/* Marks the local nodes [n_nodes] that contact forces act on, contact [n_contact], and those of points */
static PetscErrorCode NodesMark(Bodies b, PetscInt n_contact, const PetscInt contact[], unsigned char **mark)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(b->mesh->n_nodes, mark));
  for (PetscInt i = 0; i < n_contact; i++) (*mark)[contact[i]] |= BODIES_IN_CONTACT;
  for (PetscInt m = 0; m < b->n_joints; m++) {
    const BodyJoint *joint = &b->joint[m];

    for (PetscInt i = 0; i < joint->n; i++)
      (*mark)[joint->vertex[i]] |= joint->like->rigid ? BODIES_AT_RIGID : joint->heavy ? BODIES_AT_HEAVY : 0;
  }
  PetscFunctionReturn(0);
}

/* Whether a motion drives direction i % 3 of node i / 3 of a joint: it has no mass of its own, and no support holds
   it */
static PetscBool NodeIsDriven(Bodies b, const BodyJoint *joint, PetscInt i)
{
  const PetscInt v = joint->vertex[i / 3];

  for (int d = 0; d < 3; d++)
    if (b->mesh->unknown[3 * v + d] < 0 && b->layout.basis[9 * v + 3 * (i % 3) + d] != 0) return PETSC_FALSE;
  return b->layout.minv[JointAt(&b->layout, joint, i)] == 0 ? PETSC_TRUE : PETSC_FALSE;
}

/* Which of the faults the local nodes of a joint have */
static void PointFindFaults(Bodies b, const BodyJoint *joint, const unsigned char mark[], PetscInt fault[N_NODE_FAULTS])
{
  for (PetscInt i = 0; i < 3 * joint->n; i++)
    if (NodeIsDriven(b, joint, i)) fault[NODE_DRIVEN] = 1;
  for (PetscInt i = 0; i < joint->n; i++) {
    if (mark[joint->vertex[i]] & BODIES_IN_CONTACT) fault[NODE_IN_CONTACT] = 1;
    if (joint->heavy && mark[joint->vertex[i]] & BODIES_AT_RIGID) fault[NODE_OF_RIGID] = 1;
  }
}

/* Raises an error for nodes of a point with a mass that a motion drives, or that contact forces act on */
static PetscErrorCode PointCheckNodes(Bodies b, const BodyJoint *joint, const unsigned char mark[])
{
  PetscInt     fault[N_NODE_FAULTS] = {0};
  const Joint *like                 = joint->like;
  const char  *what                 = like->rigid ? "is joined rigidly" : "has a mass";

  PetscFunctionBeginUser;
  PointFindFaults(b, joint, mark, fault);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, fault, N_NODE_FAULTS, MPIU_INT, MPI_MAX, b->comm));
  PetscCheck(
    !fault[NODE_OF_RIGID], b->comm, PETSC_ERR_SUP,
    "point %s has a mass, and -%s_set %s has nodes of a point that is joined rigidly, which -analysis transient "
    "does not support: give that one the mass",
    like->name, like->name, like->set[0]);
  PetscCheck(!fault[NODE_DRIVEN], b->comm, PETSC_ERR_SUP,
             "point %s %s, and a motion drives nodes of -%s_set %s, which -analysis transient does not support: "
             "use another set",
             like->name, what, like->name, like->set[0]);
  PetscCheck(!fault[NODE_IN_CONTACT], b->comm, PETSC_ERR_SUP,
             "point %s %s, and -%s_set %s has nodes of a contact surface, which -analysis transient does not "
             "support: use a set apart from it",
             like->name, what, like->name, like->set[0]);
  PetscFunctionReturn(0);
}

/* S = B D^-1 B' of all points with a mass, 1/kg in its translations, [n][n] with n = 6 n_heavy; two points couple
   where they have nodes in common. row [layout n] is work: the row of each number in a point. */
static PetscErrorCode PointsGetCompliance(Bodies b, const PetscInt heavy[], PetscReal S[])
{
  const PetscInt n = 6 * b->n_heavy;
  PetscInt      *row;
  PetscMPIInt    count;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(b->layout.n, &row));
  for (PetscInt p = 0; p < b->n_heavy; p++) {
    const BodyJoint *a = &b->joint[heavy[p]];

    for (PetscInt i = 0; i < b->layout.n; i++) row[i] = -1;
    for (PetscInt i = 0; i < 3 * a->n; i++)
      if (b->layout.owned[a->vertex[i / 3]]) row[JointAt(&b->layout, a, i)] = i;
    for (PetscInt q = 0; q < b->n_heavy; q++) {
      const BodyJoint *c = &b->joint[heavy[q]];

      for (PetscInt k = 0; k < 3 * c->n; k++) {
        const PetscInt at = JointAt(&b->layout, c, k), i = row[at];

        for (int j = 0; j < 36 && i >= 0; j++)
          S[(6 * p + j / 6) * n + 6 * q + j % 6] += a->b[6 * i + j / 6] * b->layout.minv[at] * c->b[6 * k + j % 6];
      }
    }
  }
  PetscCall(PetscFree(row));
  PetscCall(PetscMPIIntCast(n * n, &count));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, S, count, MPIU_REAL, MPI_SUM, b->comm));
  PetscFunctionReturn(0);
}

/* X from (I + W S) X = W, symmetric */
static PetscErrorCode PointsGetReaction(Bodies b, const PetscInt heavy[], const PetscReal S[], PetscReal X[])
{
  const PetscInt n = 6 * b->n_heavy;
  PetscReal     *A;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n * n, &A));
  for (PetscInt p = 0; p < b->n_heavy; p++) {
    PetscReal W[36];

    PointInertia(b->joint[heavy[p]].like, W);
    for (int i = 0; i < 6; i++)
      for (PetscInt k = 0; k < n; k++) {
        PetscReal sum = 6 * p + i == k;

        for (int j = 0; j < 6; j++) sum += W[6 * i + j] * S[(6 * p + j) * n + k];
        A[k * n + 6 * p + i] = sum; /* by columns */
        X[k * n + 6 * p + i] = k / 6 == p ? W[6 * i + k % 6] : 0;
      }
  }
  PetscCall(DenseSolveWith(n, A, n, X, NULL));
  PetscCall(PetscFree(A));
  PetscFunctionReturn(0);
}

PetscErrorCode BodiesSetPoints(Bodies b, PetscInt n_contact, const PetscInt contact[])
{
  PetscInt      *heavy;
  PetscReal     *S;
  unsigned char *mark;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(b->n_joints, &heavy));
  PetscCall(NodesMark(b, n_contact, contact, &mark));
  for (PetscInt m = 0; m < b->n_joints; m++) {
    if (!b->joint[m].heavy && !b->joint[m].like->rigid) continue;
    PetscCall(PointCheckNodes(b, &b->joint[m], mark));
    if (b->joint[m].like->rigid) PetscCall(RigidPointSetUp(b, &b->joint[m]));
    if (b->joint[m].heavy) heavy[b->n_heavy++] = m;
  }
  if (b->n_heavy) {
    PetscCall(PetscCalloc1(36 * b->n_heavy * b->n_heavy, &S));
    PetscCall(PetscMalloc1(36 * b->n_heavy * b->n_heavy, &b->reaction));
    PetscCall(PointsGetCompliance(b, heavy, S));
    PetscCall(PointsGetReaction(b, heavy, S, b->reaction));
    PetscCall(PetscFree(S));
  }
  PetscCall(PetscFree(heavy));
  PetscCall(SuperSetUp(b, mark));
  PetscCall(SuperGetMarks(b, mark));
  PetscCall(TiedSetUp(b, mark));
  PetscCall(PetscFree(mark));
  PetscFunctionReturn(0);
}

/* f becomes f - B'X B D^-1 f (N), X = W (I + S W)^-1: rigid points and ties first, whose nodes no such point has
   (checked in BodiesSetPoints()) */
PetscErrorCode BodiesAddInertia(Bodies b, PetscReal f[])
{
  const PetscInt n = 6 * b->n_heavy;

  PetscFunctionBeginUser;
  PetscCall(RigidPointsApply(b, PETSC_TRUE, f));
  PetscCall(TiedApply(b, PETSC_TRUE, f));
  PetscCall(SuperAddInertia(b, f));
  if (!n) PetscFunctionReturn(0);
  PetscCall(JointsMotion(b, b->layout.minv, f));
  for (PetscInt m = 0, p = 0; m < b->n_joints; m++) {
    const BodyJoint *joint = &b->joint[m];
    PetscReal        force[6];

    if (!joint->heavy) continue;
    for (int j = 0; j < 6; j++) {
      force[j] = 0;
      for (PetscInt l = 0, q = 0; l < b->n_joints; l++) {
        if (!b->joint[l].heavy) continue;
        for (int k = 0; k < 6; k++) force[j] += b->reaction[(6 * q + k) * n + 6 * p + j] * b->joint_motion[6 * l + k];
        q++;
      }
    }
    for (PetscInt i = 0; i < 3 * joint->n; i++)
      for (int j = 0; j < 6; j++) f[JointAt(&b->layout, joint, i)] -= joint->b[6 * i + j] * force[j];
    p++;
  }
  PetscFunctionReturn(0);
}
