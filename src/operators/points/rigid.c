/*
   Points that are joined rigidly: the nodes of a set move as one rigid body, u_i = q_t + q_r x (x_i - c), or u = Phi q
   with Phi [3 n][6]. Of the 3 n displacements of the set six are kept as unknowns, u_p = P u, which QR
   with pivoting of Phi' chooses (P Phi is regular, and well conditioned where the nodes stand on no line), and

      u = Phi (P Phi)^-1 u_p = T u_p

   is exact: all others follow these six (dependents.c).
*/
#include "dependents.h"
#include "base/gather.h"
#include "base/algebra/dense.h"

/* rows as long as another one but for rounding: the first of them is kept, whatever the order of sums */
#define RIGID_TIE 1e-9

/* A node of a set */
typedef struct {
  PetscInt  unknown[3];
  PetscReal x[3];
} RigidNode;

/* Nodes of a point's set on all ranks; none of them may be held */
static PetscErrorCode RigidGather(Operators o, const Joint *point, PetscInt *n, RigidNode *node[])
{
  const Mesh *mesh;
  RigidNode  *own;
  PetscInt    held = 0;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(o->model, &mesh));
  PetscCall(PetscMalloc1(point->mean.n, &own));
  for (PetscInt i = 0; i < point->mean.n; i++)
    for (int d = 0; d < 3; d++) {
      own[i].unknown[d] = mesh->unknown[3 * point->mean.vertex[i] + d];
      own[i].x[d]       = mesh->x[3 * point->mean.vertex[i] + d];
      if (own[i].unknown[d] < 0) held = 1;
    }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &held, 1, MPIU_INT, MPI_MAX, o->comm));
  PetscCheck(!held, o->comm, PETSC_ERR_SUP,
             "point %s: supports or motions hold nodes of -%s_set %s, which -%s_join rigid does not support: hold the "
             "point by -%s_stiffness, or name another set",
             point->name, point->name, point->set[0], point->name, point->name);
  PetscCall(GatherRecords(o->comm, point->mean.n, sizeof(*own), own, n, node));
  PetscCall(PetscFree(own));
  PetscFunctionReturn(0);
}

/* Phi' by columns, [3 n][6], about the middle of the nodes and over their distance from it */
static void RigidMotions(PetscInt n, const RigidNode node[], PetscReal phi[])
{
  PetscReal middle[3] = {0}, size = 0;

  for (PetscInt i = 0; i < 3 * n; i++) middle[i % 3] += node[i / 3].x[i % 3] / (PetscReal)n;
  for (PetscInt i = 0; i < 3 * n; i++) size = PetscMax(size, PetscAbsReal(node[i / 3].x[i % 3] - middle[i % 3]));
  for (PetscInt i = 0; i < n; i++)
    for (int d = 0; d < 3; d++) {
      const int  a = (d + 1) % 3, b = (d + 2) % 3;
      PetscReal *row = &phi[6 * (3 * i + d)];

      for (int k = 0; k < 6; k++) row[k] = k == d;
      row[3 + a] = (node[i].x[b] - middle[b]) / size; /* (w x r)_d = w_a r_b - w_b r_a */
      row[3 + b] = -(node[i].x[a] - middle[a]) / size;
    }
}

/* The kept unknowns, their numbers in the set: six times the longest row, whose direction then leaves all others
   (Gram-Schmidt with pivoting). All ranks have the same nodes in the same order, and choose alike. */
static PetscErrorCode RigidChoose(PetscInt n, const PetscReal phi[], PetscInt kept[6])
{
  PetscReal *row;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(6 * n, &row));
  PetscCall(PetscArraycpy(row, phi, 6 * n));
  for (int k = 0; k < 6; k++) {
    PetscReal longest = -1, e[6];

    for (PetscInt i = 0; i < n; i++) {
      PetscReal square = 0;

      for (int j = 0; j < 6; j++) square += PetscSqr(row[6 * i + j]);
      if (square > (1 + RIGID_TIE) * longest) longest = square, kept[k] = i;
    }
    for (int j = 0; j < 6; j++) e[j] = row[6 * kept[k] + j] / PetscSqrtReal(longest);
    for (PetscInt i = 0; i < n; i++) {
      PetscReal along = 0;

      for (int j = 0; j < 6; j++) along += e[j] * row[6 * i + j];
      for (int j = 0; j < 6; j++) row[6 * i + j] -= along * e[j];
    }
  }
  PetscCall(PetscFree(row));
  PetscFunctionReturn(0);
}

/* T' from (P Phi)' T' = Phi' */
static PetscErrorCode RigidSolve(PetscInt n, const PetscInt kept[6], PetscReal phi[])
{
  PetscReal A[36];

  PetscFunctionBeginUser;
  for (int k = 0; k < 6; k++) PetscCall(PetscArraycpy(&A[6 * k], &phi[6 * kept[k]], 6));
  PetscCall(DenseSolveWith(6, A, n, phi, NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode RigidSetCreate(Operators o, const Joint *point, RigidSet *set)
{
  RigidNode *node;
  PetscInt   n, kept[6];

  PetscFunctionBeginUser;
  PetscCall(RigidGather(o, point, &n, &node));
  set->point = point;
  set->n     = 3 * n;
  PetscCall(PetscMalloc2(set->n, &set->unknown, 6 * set->n, &set->t));
  for (PetscInt i = 0; i < set->n; i++) set->unknown[i] = node[i / 3].unknown[i % 3];
  RigidMotions(n, node, set->t);
  PetscCall(PetscFree(node));
  PetscCall(RigidChoose(set->n, set->t, kept));
  PetscCall(RigidSolve(set->n, kept, set->t));
  for (int k = 0; k < 6; k++) set->kept[k] = set->unknown[kept[k]];
  PetscFunctionReturn(0);
}

/* Whether unknown number i of a set is kept */
static PetscBool RigidIsKept(const RigidSet *set, PetscInt i)
{
  for (int k = 0; k < 6; k++)
    if (set->kept[k] == set->unknown[i]) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode RigidAddRows(const RigidSet *set, PetscInt by, Dependents *d)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < set->n; i++) {
    PetscCall(DependentsClaim(d, set->unknown[i], by));
    if (!RigidIsKept(set, i)) PetscCall(DependentsFollow(d, set->unknown[i], 6, set->kept, &set->t[6 * i]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode RigidSetsCreate(Operators o, PetscInt *n, RigidSet **sets)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(o->model, &scene));
  PetscCall(PetscMalloc1(scene->n_points, sets));
  *n = 0;
  for (PetscInt i = 0; i < scene->n_points; i++)
    if (scene->points[i].rigid) PetscCall(RigidSetCreate(o, &scene->points[i], &(*sets)[(*n)++]));
  PetscFunctionReturn(0);
}

PetscErrorCode RigidSetsDestroy(PetscInt n, RigidSet *sets)
{
  PetscFunctionBeginUser;
  for (PetscInt s = 0; s < n; s++) PetscCall(PetscFree2(sets[s].unknown, sets[s].t));
  PetscCall(PetscFree(sets));
  PetscFunctionReturn(0);
}
