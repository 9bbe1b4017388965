/*
   The motion of a set in the mean. With the shares s_i of its nodes (spread.c; sum 1), their middle c = sum s_i x_i,
   r_i = x_i - c and A = sum s_i (|r_i|^2 I - r_i r_i'), the rigid motion that fits the displacements best, that is with
   the least sum s_i |u_i - t - w x (x_i - x_0)|^2, is about the place x_0

      w = A^-1 sum s_i r_i x u_i  (rad),     t = sum s_i u_i + w x (x_0 - c)  (m),

   linear in u: q = (t, w) = B u. For nodes that move as one rigid body it is that motion exactly. Forces and moments f
   on q act on the nodes as B'f, whose resultants in x_0 are f exactly.
*/
#include "model/modelimpl.h"
#include "base/algebra/dense.h"
#include "base/algebra/vec3.h"

#define MEAN_FLAT  1e-10 /* of the largest moment of A: below it nothing tells the rotation */
#define MEAN_CLOSE 1e-9  /* of the set's size: x_0 is in the middle */
#define MEAN_SAME  1e-13 /* of the distance from the origin: rounding */

/* A set with its shares */
typedef struct {
  PetscInt         n;
  PetscInt        *vertex; /* [n] that this rank owns */
  const PetscReal *share;  /* [3 nodes] in the first of three places */
  PetscReal        middle[3], size, inverse[9];
  PetscBool        turns; /* inverse is there */
} MeanSet;

/* Sums over the nodes of all ranks: s x, then s r r' about the middle, [6] xx, yy, zz, xy, xz, yz */
static PetscErrorCode MeanMoments(Model model, MeanSet *m, PetscReal second[6])
{
  static const int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};
  const PetscReal *x = model->mesh.x;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->n; i++)
    for (int d = 0; d < 3; d++) m->middle[d] += m->share[3 * m->vertex[i]] * x[3 * m->vertex[i] + d];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, m->middle, 3, MPIU_REAL, MPI_SUM, model->comm));
  for (PetscInt i = 0; i < m->n; i++) {
    const PetscReal *at = &x[3 * m->vertex[i]];

    for (int k = 0; k < 6; k++)
      second[k] +=
        m->share[3 * m->vertex[i]] * (at[row[k]] - m->middle[row[k]]) * (at[column[k]] - m->middle[column[k]]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, second, 6, MPIU_REAL, MPI_SUM, model->comm));
  m->size = PetscSqrtReal(PetscMax(0, second[0] + second[1] + second[2]));
  PetscFunctionReturn(0);
}

/* A^-1, unless the nodes stand on one line or in one place */
static PetscErrorCode MeanInvert(const PetscReal second[6], MeanSet *m)
{
  const PetscReal trace     = second[0] + second[1] + second[2];
  const PetscReal moment[6] = {trace - second[0], trace - second[1], trace - second[2],
                               -second[3],        -second[4],        -second[5]};
  PetscReal       principal[3], axes[9];

  PetscFunctionBeginUser;
  PetscCall(InertiaPrincipal(moment, principal, axes));
  m->turns = principal[0] > MEAN_FLAT * principal[2] ? PETSC_TRUE : PETSC_FALSE;
  for (int i = 0; i < 9 && m->turns; i++)
    for (int k = 0; k < 3; k++) m->inverse[i] += axes[3 * k + i / 3] * axes[3 * k + i % 3] / principal[k];
  PetscFunctionReturn(0);
}

/* The six rows of B for node i: b[d][j] = d q_j / d u_d, times sign */
static void MeanRows(const MeanSet *m, const PetscReal x[3], PetscReal share, const PetscReal at[3], PetscReal sign,
                     PetscReal b[3][6])
{
  PetscReal r[3], away[3];

  for (int d = 0; d < 3; d++) r[d] = x[d] - m->middle[d], away[d] = at[d] - m->middle[d];
  for (int d = 0; d < 3; d++) {
    const PetscReal unit[3] = {d == 0, d == 1, d == 2};
    PetscReal       moment[3], w[3], shift[3];

    Vec3Cross(r, unit, moment);
    for (int i = 0; i < 3; i++) w[i] = share * Vec3Dot(&m->inverse[3 * i], moment);
    Vec3Cross(w, away, shift);
    for (int i = 0; i < 3; i++) {
      b[d][i] += sign * (share * unit[i] + shift[i]);
      b[d][3 + i] += sign * w[i];
    }
  }
}

/* Adds the rows of the nodes of a set to those of the nodes, b [nodes][3][6] */
static PetscErrorCode MeanAddRows(Model model, MeanSet *m, const ModelMeanWish *wish, const PetscReal at[3],
                                  PetscReal b[][3][6])
{
  const PetscReal close = MEAN_CLOSE * m->size + MEAN_SAME * Vec3Length(m->middle);
  PetscReal       away  = 0;

  PetscFunctionBeginUser;
  for (int d = 0; d < 3; d++) away = PetscMax(away, PetscAbsReal(at[d] - m->middle[d]));
  PetscCheck(
    m->turns || !wish->turns[0], model->comm, PETSC_ERR_USER_INPUT,
    "-%s_%s %s: its nodes stand on one line or in one place, where they have no mean rotation, which %s asks for; name "
    "a surface",
    wish->owner, wish->option, wish->set, wish->turns);
  PetscCheck(
    m->turns || away <= close, model->comm, PETSC_ERR_USER_INPUT,
    "-%s_%s %s: its nodes stand on one line or in one place, where they have no mean rotation; name a surface, or take "
    "-%s_at in the middle of it, %.6g,%.6g,%.6g m",
    wish->owner, wish->option, wish->set, wish->owner, (double)m->middle[0], (double)m->middle[1],
    (double)m->middle[2]);
  if (!wish->turns[0] && away <= close && !model->has_superelements) { /* nothing asks for the rotation */
    PetscCall(PetscArrayzero(m->inverse, 9));
    at = m->middle;
  }
  for (PetscInt i = 0; i < m->n; i++)
    MeanRows(m, &model->mesh.x[3 * m->vertex[i]], m->share[3 * m->vertex[i]], at, wish->sign, b[m->vertex[i]]);
  PetscFunctionReturn(0);
}

/* Shares and moments of a set; then, where b is given, its rows about the place of the wish */
PetscErrorCode MeanFindMiddle(Model model, const ModelMeanWish *wish, PetscReal middle[3], PetscReal b[][3][6])
{
  PetscReal second[6] = {0};
  MeanSet   m         = {0};
  Vec       shares;

  PetscFunctionBeginUser;
  PetscCall(ModelCreateShares(model, wish->owner, wish->set, SPREAD_TOTAL, &shares));
  PetscCall(VecGetArrayRead(shares, &m.share));
  PetscCall(ModelGetOwnedNodes(model, wish->set, &m.n, &m.vertex));
  PetscCall(MeanMoments(model, &m, second));
  PetscCall(MeanInvert(second, &m));
  PetscCall(PetscArraycpy(middle, m.middle, 3));
  if (b) PetscCall(MeanAddRows(model, &m, wish, wish->at, b));
  PetscCall(PetscFree(m.vertex));
  PetscCall(VecRestoreArrayRead(shares, &m.share));
  PetscCall(VecDestroy(&shares));
  PetscFunctionReturn(0);
}

PetscErrorCode MeanCreate(Model model, PetscInt n_wishes, const ModelMeanWish wish[], ModelMean *mean)
{
  const PetscInt n = model->mesh.n_nodes;
  PetscReal(*b)[3][6], middle[3];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &b));
  for (PetscInt k = 0; k < n_wishes; k++) PetscCall(MeanFindMiddle(model, &wish[k], middle, b));
  mean->n = 0;
  for (int fill = 0; fill < 2; fill++) {
    for (PetscInt v = 0, i = 0; v < n; v++) {
      PetscReal size = 0;

      for (int k = 0; k < 18; k++) size += PetscAbsReal((&b[v][0][0])[k]);
      if (size == 0) continue;
      if (fill) PetscCall(PetscArraycpy(&mean->b[18 * i], &b[v][0][0], 18));
      if (fill) mean->vertex[i] = v;
      mean->n += !fill;
      i++;
    }
    if (!fill) PetscCall(PetscMalloc2(mean->n, &mean->vertex, 18 * mean->n, &mean->b));
  }
  PetscCall(PetscFree(b));
  PetscFunctionReturn(0);
}

PetscErrorCode MeanDestroy(ModelMean *mean)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(mean->vertex, mean->b));
  mean->n = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode ModelGetMeanMotion(Model model, const ModelMean *mean, const PetscReal nodal[], PetscReal q[6])
{
  PetscFunctionBeginUser;
  for (int j = 0; j < 6; j++) q[j] = 0;
  for (PetscInt i = 0; i < mean->n; i++)
    for (int d = 0; d < 3; d++)
      for (int j = 0; j < 6; j++) q[j] += mean->b[18 * i + 6 * d + j] * nodal[3 * mean->vertex[i] + d];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, q, 6, MPIU_REAL, MPI_SUM, model->comm));
  PetscFunctionReturn(0);
}

void ModelAddMeanForce(const ModelMean *mean, const PetscReal force[6], PetscReal nodal[])
{
  for (PetscInt i = 0; i < mean->n; i++)
    for (int d = 0; d < 3; d++)
      for (int j = 0; j < 6; j++) nodal[3 * mean->vertex[i] + d] += mean->b[18 * i + 6 * d + j] * force[j];
}

PetscErrorCode InertiaPrincipal(const PetscReal inertia[6], PetscReal principal[3], PetscReal axes[9])
{
  static const int at[9] = {0, 3, 4, 3, 1, 5, 4, 5, 2};

  PetscFunctionBeginUser;
  for (int i = 0; i < 9; i++) axes[i] = inertia[at[i]];
  PetscCall(DenseSymmetricEigen(3, axes, NULL, principal, NULL));
  PetscFunctionReturn(0);
}
