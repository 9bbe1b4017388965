/*
   Prescribed motions d of a reduced model (reduced.h): the nodes that they hold are no unknowns, and what they do is
   linear in d: loads -K_fd d and -D_fd d on the free nodes, their own way Y at pairs and probes, and kappa = d'K_dd d.
   The residual answers -K_fd d by X d, and
   damping acts on its rate too: D_fd d + D_ff X d on the modes, alone, as that of the residual by loads is left out.
   A lumped mass does not couple nodes, but that of a point does (src/model/scene/mean.c): such sets are refused.
*/
#include "reduced/reducedimpl.h"
#include "contact/bodies/moved.h"
#include "solver/block/orthonormal.h"
#include "base/algebra/vec3.h"

PetscErrorCode ReducedPortSetNodal(ReducedRun r, Vec nodal, PetscInt k)
{
  Vec column;

  PetscFunctionBeginUser;
  PetscCall(MatDenseGetColumnVecWrite(r->reduction.others, k, &column));
  PetscCall(OperatorsTakeNodal(r->run.operators, nodal, column));
  PetscCall(MatDenseRestoreColumnVecWrite(r->reduction.others, k, &column));
  PetscFunctionReturn(0);
}

/* Raises the error for a mass at a point whose set the displacements move */
static PetscErrorCode MotionCheckPoints(ReducedRun r, const PrescribedMotion *motion, const PetscReal nodal[])
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(r->run.model, &scene));
  for (PetscInt i = 0; i < scene->n_points; i++) {
    PetscReal q[6], k[6], c[6], mass, sum = 0;

    PetscCall(OperatorsGetJoint(r->run.operators, r->request.p, scene->n_joints + i, k, c, &mass));
    PetscCall(ModelGetMeanMotion(r->run.model, &scene->points[i].mean, nodal, q));
    for (int d = 0; d < 6; d++) sum += PetscAbsReal(q[d]);
    PetscCheck(sum == 0 || (mass == 0 && !scene->points[i].n_inertia), r->comm, PETSC_ERR_SUP,
               "motion %s moves the set of the point %s, which has mass: a reduced model does not know its inertia; "
               "-dynamics_model full does",
               motion->name, scene->points[i].name);
  }
  PetscFunctionReturn(0);
}

/* Y of a motion at the pairs of this rank, and at the probes that it has */
static PetscErrorCode MotionSetWay(ReducedRun r, const PetscReal nodal[], PetscReal Y[])
{
  const ContactPair *pair;
  const Mesh        *mesh;
  PetscInt           n, n_all, n_moved;
  MovedVertex       *moved;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(r->run.model, &mesh));
  PetscCall(ContactGetPairs(r->run.contact, &n, &n_all, &pair));
  PetscCall(MovedVerticesGather(r->comm, mesh, nodal, &n_moved, &moved));
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal *e[3] = {pair[i].n, pair[i].t, pair[i].b};
    PetscReal        apart[3];

    MovedApart(n_moved, moved, &pair[i], apart);
    for (int k = 0; k < 3; k++) Y[3 * (r->reduction.begin + i) + k] = -Vec3Dot(e[k], apart);
  }
  PetscCall(PetscFree(moved));
  for (PetscInt v = 0; v < mesh->n_nodes; v++)
    for (int d = 0; d < 3 && r->reduction.vertex_port[v] >= 0; d++)
      Y[r->reduction.vertex_port[v] + d] = nodal[3 * v + d];
  PetscFunctionReturn(0);
}

/* A row of kappa, d_j'K d_i, or of that of D, held directions included */
static PetscErrorCode MotionWeigh(ReducedRun r, const PetscReal *const nodal[], Vec local, PetscReal row[])
{
  const PetscInt     n = r->reduction.model.n_motions;
  const PetscScalar *f;
  const Mesh        *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(r->run.model, &mesh));
  PetscCall(VecGetArrayRead(local, &f));
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt k = 0; k < 3 * mesh->n_nodes; k++)
      if (mesh->owned[k / 3]) row[j] += nodal[j][k] * f[k];
  PetscCall(VecRestoreArrayRead(local, &f));
  PetscFunctionReturn(0);
}

/* After ports of probes are numbered; loads are columns first .. of the others. Sums over the ranks at the end */
PetscErrorCode ReducedSetMotions(ReducedRun r, PetscInt first)
{
  ReducedModel     *model = &r->reduction.model;
  const PetscInt    n = model->n_motions, N = model->n_ports;
  const ModelScene *scene;
  const Mesh       *mesh;
  PetscReal       **nodal;
  Vec               local;

  PetscFunctionBeginUser;
  if (!n) PetscFunctionReturn(0);
  PetscCall(ModelGetScene(r->run.model, &scene));
  PetscCall(ModelGetMesh(r->run.model, &mesh));
  PetscCall(PetscMalloc1(n, &nodal));
  PetscCall(PetscCalloc1(n * N, &model->Y));
  PetscCall(PetscCalloc1(n * n, &model->kappa));
  PetscCall(PetscCalloc1(n * n, &model->drag));
  PetscCall(ModelCreateNodal(r->run.model, &local));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(PetscMalloc1(3 * mesh->n_nodes, &nodal[i]));
    PetscCall(ModelGetMotion(r->run.model, i, nodal[i]));
  }
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(MotionCheckPoints(r, &scene->motions[i], nodal[i]));
    PetscCall(MotionSetWay(r, nodal[i], &model->Y[N * i]));
    PetscCall(OperatorsPrescribedForces(r->run.operators, r->request.p, nodal[i], local));
    PetscCall(MotionWeigh(r, (const PetscReal *const *)nodal, local, &model->kappa[n * i]));
    PetscCall(VecScale(local, -1));
    PetscCall(ReducedPortSetNodal(r, local, first + i));
    if (!model->dragged) continue;
    PetscCall(OperatorsPrescribedDrag(r->run.operators, r->request.p, nodal[i], local));
    PetscCall(MotionWeigh(r, (const PetscReal *const *)nodal, local, &model->drag[n * i]));
    PetscCall(VecScale(local, -1));
    PetscCall(ReducedPortSetNodal(r, local, first + n + i));
  }
  for (PetscInt i = 0; i < n; i++) PetscCall(PetscFree(nodal[i]));
  PetscCall(PetscFree(nodal));
  PetscCall(VecDestroy(&local));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, model->Y, (PetscMPIInt)(n * N), MPIU_REAL, MPI_SUM, r->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, model->kappa, (PetscMPIInt)(n * n), MPIU_REAL, MPI_SUM, r->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, model->drag, (PetscMPIInt)(n * n), MPIU_REAL, MPI_SUM, r->comm));
  PetscFunctionReturn(0);
}

/* W of the loads of damping, which act on the modes alone */
static void DragOmit(ReducedModel *model)
{
  const PetscInt N = model->n_ports, first = ReducedFirstMotion(model) + model->n_motions;
  const PetscInt n_columns = N - (model->sparse ? 3 * model->n_pairs : 0);
  PetscReal     *W         = model->W;

  for (PetscInt j = 0; j < n_columns; j++)
    for (PetscInt i = 0; i < model->n_motions; i++) W[N * j + first + i] = 0;
  for (PetscInt i = 0; i < N * model->n_motions; i++) W[N * (n_columns - N + first) + i] = 0;
}

PetscErrorCode ReducedSettleDrag(ReducedRun r)
{
  ReducedModel  *model = &r->reduction.model;
  const PetscInt n = model->n_motions, m = model->m, first = ReducedFirstMotion(model) - 3 * model->n_pairs;
  PetscReal     *h, *own, *mixed;
  PetscInt       n_own;
  Mat            D, F, G, X, DX;

  PetscFunctionBeginUser;
  if (!model->dragged) PetscFunctionReturn(0);
  PetscCall(OperatorsGetBodies(r->run.operators, r->request.p, NULL, NULL, &D));
  PetscCall(PetscMalloc3(m * n, &h, n * n, &own, n * n, &mixed));
  PetscCall(MatGetLocalSize(r->reduction.Phi, &n_own, NULL));
  PetscCall(MatDenseGetSubMatrix(r->reduction.others, PETSC_DECIDE, PETSC_DECIDE, first, first + n, &F));
  PetscCall(MatDuplicate(F, MAT_COPY_VALUES, &G));
  PetscCall(MatDenseRestoreSubMatrix(r->reduction.others, &F));
  PetscCall(MatDuplicate(G, MAT_DO_NOT_COPY_VALUES, &X));
  PetscCall(MatDuplicate(G, MAT_DO_NOT_COPY_VALUES, &DX));
  PetscCall(ReducedApplyResidual(r, G, X));
  PetscCall(BlockMultiply(D, X, DX));
  PetscCall(BlockGram(r->reduction.Phi, DX, h));
  PetscCall(BlockGram(X, DX, own));
  PetscCall(MatDenseGetSubMatrix(r->reduction.others, PETSC_DECIDE, PETSC_DECIDE, first + n, first + 2 * n, &F));
  PetscCall(BlockGram(X, F, mixed));
  PetscCall(MatDenseRestoreSubMatrix(r->reduction.others, &F));
  for (PetscInt i = 0; i < m * n; i++) model->P[m * (3 * model->n_pairs + first + n) + i] -= h[i];
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++) model->drag[n * j + i] += own[n * j + i] - mixed[n * j + i] - mixed[n * i + j];
  DragOmit(model);
  PetscCall(PetscFree3(h, own, mixed));
  PetscCall(MatDestroy(&G));
  PetscCall(MatDestroy(&X));
  PetscCall(MatDestroy(&DX));
  PetscFunctionReturn(0);
}
