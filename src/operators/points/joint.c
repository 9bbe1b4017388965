/*
   Bushings and points: with the six motions q = B u of model.h and W = diag(k), diag(c), or mass and inertia, each is a
   term B' W B of K, C or M of rank six at most, one for each parameter. Its matrix couples all nodes of the sets: n of
   them cost 12 (3 n)^2 bytes a matrix, 0.1 GB at 1000 nodes, and a third of it where only translations count in the
   middle of a set. Each parameter keeps one, and each sum of K, C, M that is formed another: on 1000 nodes a bushing of
   three stiffnesses takes 0.3 GB in modes, a point with six, mass and inertia 0.9 GB. Entries that are zero for every u
   are not stored. Name the nodes of a bolt hole, not of a whole face.
*/
#include "operators/operatorsimpl.h"
#include "base/gather.h"
#include <stdlib.h>

#define JOINT_MOST 15000 /* unknowns of the sets of one bushing or point: 2.7 GB */
#define JOINT_MANY 2000  /* nodes, from which on their dense block, of 6000 unknowns, rules a factorisation */

/* One column of B at a number of the displacements */
typedef struct {
  PetscInt  unknown;
  PetscReal b[6];
} JointColumn;

/* The columns that are unknowns, of all ranks, ascending */
typedef struct {
  PetscInt     n;
  JointColumn *column;
} JointColumns;

/* What of a joint a matrix is made of: its translations or rotations */
typedef struct {
  const Joint *joint;
  int          first; /* 0 translations, 3 rotations */
} JointHalf;

static int JointColumnCompare(const void *a, const void *b)
{
  const PetscInt x = ((const JointColumn *)a)->unknown, y = ((const JointColumn *)b)->unknown;

  return x < y ? -1 : x > y;
}

static PetscErrorCode JointColumnsCreate(Operators o, const Joint *joint, JointColumns *c)
{
  const ModelMean *mean = &joint->mean;
  const Mesh      *mesh;
  JointColumn     *own;
  PetscInt         n = 0;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(o->model, &mesh));
  PetscCall(PetscMalloc1(3 * mean->n, &own));
  for (PetscInt i = 0; i < 3 * mean->n; i++) {
    const PetscInt unknown = mesh->unknown[3 * mean->vertex[i / 3] + i % 3];

    if (unknown < 0) continue;
    own[n].unknown = unknown;
    PetscCall(PetscArraycpy(own[n].b, &mean->b[6 * i], 6));
    n++;
  }
  PetscCall(GatherRecords(o->comm, n, sizeof(*own), own, &c->n, &c->column));
  PetscCall(PetscFree(own));
  if (c->n) qsort(c->column, (size_t)c->n, sizeof(*c->column), JointColumnCompare);
  PetscCheck(
    c->n <= JOINT_MOST, o->comm, PETSC_ERR_SUP,
    "%s %s has %" PetscInt_FMT " unknowns, each of which it couples to all others, %.1f GB a matrix; name sets "
    "of at most %d nodes",
    joint->is_point ? "point" : "bushing", joint->name, c->n, 12e-9 * (double)c->n * (double)c->n, JOINT_MOST / 3);
  PetscFunctionReturn(0);
}

/* Row i of B'WB: columns and values that are not zero; B is [6][unknowns of the sets], W in N/m, N m/rad and the
   like. The same sums for (i, j) and (j, i) but for rounding. */
static PetscInt JointRow(const JointColumns *c, const PetscReal W[36], PetscInt i, PetscInt column[],
                         PetscScalar value[])
{
  PetscReal wb[6];
  PetscInt  n = 0;

  for (int k = 0; k < 6; k++) {
    wb[k] = 0;
    for (int l = 0; l < 6; l++) wb[k] += W[6 * k + l] * c->column[i].b[l];
  }
  for (PetscInt j = 0; j < c->n; j++) {
    PetscScalar sum = 0;

    for (int k = 0; k < 6; k++) sum += wb[k] * c->column[j].b[k];
    if (sum == 0) continue;
    column[n]  = c->column[j].unknown;
    value[n++] = sum;
  }
  return n;
}

/* B'WB, W [6][6] symmetric. Every rank has all columns of the joint and fills its own rows: once to count, once to
   set. */
static PetscErrorCode JointMatrixCreate(Operators o, const Joint *joint, const PetscReal W[36], Mat *A)
{
  const Mesh  *mesh;
  JointColumns c;
  PetscInt    *inside, *outside, *column;
  PetscScalar *value;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(o->model, &mesh));
  PetscCall(JointColumnsCreate(o, joint, &c));
  PetscCall(PetscCalloc4(mesh->n_own, &inside, mesh->n_own, &outside, c.n, &column, c.n, &value));
  for (int fill = 0; fill < 2; fill++) {
    for (PetscInt i = 0; i < c.n; i++) {
      const PetscInt row = c.column[i].unknown, own = row - mesh->first_own;
      PetscInt       n;

      if (own < 0 || own >= mesh->n_own) continue;
      n = JointRow(&c, W, i, column, value);
      if (fill) PetscCall(MatSetValues(*A, 1, &row, n, column, value, INSERT_VALUES));
      for (PetscInt j = 0; j < n && !fill; j++)
        (column[j] >= mesh->first_own && column[j] < mesh->first_own + mesh->n_own ? inside : outside)[own]++;
    }
    if (!fill)
      PetscCall(
        MatCreateAIJ(o->comm, mesh->n_own, mesh->n_own, PETSC_DETERMINE, PETSC_DETERMINE, 0, inside, 0, outside, A));
  }
  PetscCall(MatAssemblyBegin(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(PetscFree4(inside, outside, column, value));
  PetscCall(PetscFree(c.column));
  PetscFunctionReturn(0);
}

/* The matrix of the components of the mask, at the value 1 */
static PetscErrorCode JointHalfCreate(Operators o, const void *of, const PetscBool mask[3], Mat *A)
{
  const JointHalf *half  = of;
  PetscReal        W[36] = {0};

  PetscFunctionBeginUser;
  for (int d = 0; d < 3; d++)
    if (mask[d]) W[7 * (half->first + d)] = 1;
  PetscCall(JointMatrixCreate(o, half->joint, W, A));
  PetscFunctionReturn(0);
}

/* Term of the mass of a point (kg), with a parameter, and of its inertia (kg m^2), without. inertia[] is xx, yy, zz,
   xy, xz, yz; at[] makes the symmetric [3][3] of it. */
static PetscErrorCode PointAddMass(Operators o, const Joint *joint, PetscInt *index)
{
  static const int at[9]  = {0, 3, 4, 3, 1, 5, 4, 5, 2};
  const PetscBool  all[3] = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE};
  const JointHalf  half   = {joint, 0};
  PetscReal        W[36]  = {0};
  PetscBool        turns  = PETSC_FALSE;
  Mat              A;

  PetscFunctionBeginUser;
  if (joint->mass > 0) {
    PetscCall(ParametersAdd(&o->parameters, joint->name, "mass",
                            &(OperatorsParameter){.row = ModelFindRow("-points", "mass"), .value = joint->mass},
                            index));
  }
  if (o->omit) PetscFunctionReturn(0);
  if (joint->mass > 0) {
    PetscCall(JointHalfCreate(o, &half, all, &A));
    PetscCall(TermsAdd(&o->terms, OPERATORS_MASS, A, PETSC_TRUE, 1, index));
    PetscCall(MatDestroy(&A));
  }
  for (int i = 0; i < 9; i++) {
    W[6 * (3 + i / 3) + 3 + i % 3] = joint->inertia[at[i]];
    if (joint->inertia[at[i]] != 0) turns = PETSC_TRUE;
  }
  if (!turns) PetscFunctionReturn(0);
  PetscCall(JointMatrixCreate(o, joint, W, &A));
  PetscCall(TermsAdd(&o->terms, OPERATORS_MASS, A, PETSC_TRUE, 0, NULL));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(0);
}

/* Parameters and terms of one bushing or point */
static PetscErrorCode OperatorsAddJoint(Operators o, const Joint *j, JointParameters *index)
{
  const JointHalf   half[2]       = {{j, 0}, {j, 3}};
  const char *const cause         = j->is_point ? "point" : "bushing";
  const char *const list          = j->is_point ? "-points" : "-joints";
  const Components  components[4] = {{OPERATORS_STIFFNESS, cause, j->name, "stiffness", ModelFindRow(list, "stiffness"),
                                      &j->stiffness[0], JointHalfCreate, &half[0]},
                                     {OPERATORS_STIFFNESS, cause, j->name, "turn_stiffness",
                                      ModelFindRow(list, "turn_stiffness"), &j->stiffness[3], JointHalfCreate, &half[1]},
                                     {OPERATORS_DAMPING, cause, j->name, "viscosity", ModelFindRow(list, "viscosity"),
                                      &j->viscosity[0], JointHalfCreate, &half[0]},
                                     {OPERATORS_DAMPING, cause, j->name, "turn_viscosity",
                                      ModelFindRow(list, "turn_viscosity"), &j->viscosity[3], JointHalfCreate,
                                      &half[1]}};
  PetscInt *const   to[4] = {&index->stiffness[0], &index->stiffness[3], &index->viscosity[0], &index->viscosity[3]};

  PetscFunctionBeginUser;
  index->mass = -1;
  for (int k = 0; k < 4; k++) PetscCall(OperatorsAddComponents(o, &components[k], to[k]));
  PetscCall(PointAddMass(o, j, &index->mass));
  PetscFunctionReturn(0);
}

/* Bushing i, or point i less the number of bushings */
static const Joint *JointGet(const ModelScene *scene, PetscInt i)
{
  return i < scene->n_joints ? &scene->joints[i] : &scene->points[i - scene->n_joints];
}

/* Says why a run will take long: the sets of a joint have many nodes */
static PetscErrorCode JointWarn(Operators o, const Joint *joint)
{
  PetscBool held = JointIsMassive(joint);
  PetscInt  n;

  PetscFunctionBeginUser;
  for (int d = 0; d < 6; d++)
    if (joint->stiffness[d] > 0 || joint->viscosity[d] > 0) held = PETSC_TRUE;
  n = held && !joint->rigid ? joint->mean.n : 0;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &n, 1, MPIU_INT, MPI_SUM, o->comm));
  if (n < JOINT_MANY) PetscFunctionReturn(0);
  PetscCall(PetscFPrintf(o->comm, stderr,
                         "squeal: warning: %s %s couples the %" PetscInt_FMT
                         " nodes of its sets, each to all others, so that matrices and factors take long; name "
                         "a surface or a smaller set, or a point with -join rigid\n",
                         joint->is_point ? "point" : "bushing", joint->name, n));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsAddJoints(Operators o)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(o->model, &scene));
  o->n_local = o->parameters.n;
  PetscCall(PetscMalloc1(scene->n_joints + scene->n_points, &o->joint));
  for (PetscInt i = 0; i < scene->n_joints + scene->n_points; i++) {
    PetscCall(JointWarn(o, JointGet(scene, i)));
    PetscCall(OperatorsAddJoint(o, JointGet(scene, i), &o->joint[i]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetJoint(Operators o, const PetscReal p[], PetscInt i, PetscReal stiffness[6],
                                 PetscReal viscosity[6], PetscReal *mass)
{
  const JointParameters *index = &o->joint[i];
  const PetscReal       *value = OperatorsPoint(o, p);

  PetscFunctionBeginUser;
  for (int d = 0; d < 6; d++) {
    stiffness[d] = index->stiffness[d] < 0 ? 0 : value[index->stiffness[d]];
    viscosity[d] = index->viscosity[d] < 0 ? 0 : value[index->viscosity[d]];
  }
  *mass = index->mass < 0 ? 0 : value[index->mass];
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsAddJointForces(Operators o, const PetscReal p[], PetscBool viscous,
                                       const PetscReal displacement[], PetscReal force[])
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(o->model, &scene));
  for (PetscInt i = 0; i < scene->n_joints + scene->n_points; i++) {
    const ModelMean *mean = &JointGet(scene, i)->mean;
    PetscReal        q[6], k[6], c[6], m;

    PetscCall(OperatorsGetJoint(o, p, i, k, c, &m));
    PetscCall(ModelGetMeanMotion(o->model, mean, displacement, q));
    for (int d = 0; d < 6; d++) q[d] *= viscous ? c[d] : k[d];
    ModelAddMeanForce(mean, q, force);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsAddJointWeight(Operators o, const PetscReal p[], PetscReal force[], PetscReal total[3])
{
  const ModelScene *scene;
  PetscMPIInt       rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(o->comm, &rank));
  PetscCall(ModelGetScene(o->model, &scene));
  for (PetscInt i = 0; i < scene->n_points; i++) {
    PetscReal weight[6] = {0}, k[6], c[6], m;

    PetscCall(OperatorsGetJoint(o, p, scene->n_joints + i, k, c, &m));
    for (int d = 0; d < 3; d++) weight[d] = m * scene->gravity[d];
    ModelAddMeanForce(&scene->points[i].mean, weight, force);
    for (int d = 0; d < 3 && !rank; d++) total[d] += weight[d];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsMarkPart(const Mesh *mesh, PetscInt part, PetscBool **on)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes, on));
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    for (PetscInt i = mesh->cell_first[c]; i < mesh->cell_first[c + 1] && mesh->cell_part[c] == part; i++)
      (*on)[mesh->cell_node[i]] = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Whether a node of a point belongs to a part, on any rank */
static PetscErrorCode PointIsOnPart(Operators o, const Joint *point, PetscInt part, PetscBool *is)
{
  const Mesh *mesh;
  PetscBool  *on;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(o->model, &mesh));
  PetscCall(OperatorsMarkPart(mesh, part, &on));
  *is = PETSC_FALSE;
  for (PetscInt i = 0; i < point->mean.n; i++)
    if (on[point->mean.vertex[i]]) *is = PETSC_TRUE;
  PetscCall(PetscFree(on));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, is, 1, MPIU_BOOL, MPI_LOR, o->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsCheckSpinningPoints(Operators o, PetscInt part)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(o->model, &scene));
  for (PetscInt i = 0; i < scene->n_points; i++) {
    const Joint *point = &scene->points[i];
    PetscBool    on    = PETSC_FALSE;

    if (point->rigid || JointIsMassive(point)) PetscCall(PointIsOnPart(o, point, part, &on));
    PetscCheck(!on, o->comm, PETSC_ERR_SUP,
               "point %s is %s on part %s, which -%s_spin turns: that is not supported; put it on a part that stands "
               "still",
               point->name, point->rigid ? "joined rigidly" : "a mass", scene->parts[part].name,
               scene->parts[part].name);
  }
  PetscFunctionReturn(0);
}
