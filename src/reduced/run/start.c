/*
   The state at t = 0: at rest with the velocities of the parts, or the sliding state (statics.h) with its contact
   forces; on top of either the shape of a mode. Nodal values v become coordinates by Phi'M v; of what no mode below the
   cut-off moves, the residual keeps no velocity: a motion is refused whose v'M v the modes do not hold, by Parseval
   |Phi'M v|^2 of it. Where displacements follow others, u = Z q, v is that motion of theirs which is nearest in M, as
   in transients of the mesh: Z (Z'M Z)^-1 Z'M v, which has the same coordinates.
*/
#include "reduced/sparse/sparse.h"
#include "base/gather.h"
#include "solver/factor/masssolve.h"

#define START_SHARE 0.9 /* of v'M v that the modes must hold, at least */

/* v'M v of the nearest motion v to x, (Z'M x)'(Z'M Z)^-1 Z'M x; x'M x where no displacements follow others */
static PetscErrorCode StartWeigh(ReducedRun r, Vec x, PetscReal *square)
{
  PencilMatrices pencil;
  PetscScalar    product;
  Vec            Mx, f, y;
  Mat            M, Z;

  PetscFunctionBeginUser;
  PetscCall(PencilGetMass(r->reduction.bodies, &M));
  PetscCall(PencilGetMatrices(r->reduction.bodies, &pencil));
  PetscCall(OperatorsGetDependents(r->run.operators, &Z, NULL));
  PetscCall(VecDuplicate(x, &Mx));
  PetscCall(MatMult(M, x, Mx));
  PetscCall(MatCreateVecs(pencil.M, &y, &f));
  PetscCall(PencilProjectForce(r->reduction.bodies, PETSC_FALSE, Mx, f));
  if (Z)
    PetscCall(MassSolve(pencil.M, f, y, "the motion of tied bodies nearest to that of the start"));
  else
    PetscCall(VecCopy(x, y));
  PetscCall(VecDot(f, y, &product));
  PetscCall(VecDestroy(&Mx));
  PetscCall(VecDestroy(&f));
  PetscCall(VecDestroy(&y));
  *square = PetscRealPart(product);
  PetscFunctionReturn(0);
}

/* coordinates += Phi'M x of all unknowns; square = |Phi'M x|^2, what the modes hold of x'M x, or NULL. One
   reduction, of m numbers. */
static PetscErrorCode StartProject(ReducedRun r, Vec x, PetscReal coordinates[], PetscReal *square)
{
  const PetscScalar *value;
  PetscInt           n;
  PetscReal         *sum;
  Mat                X;

  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(x, &n));
  PetscCall(VecGetArrayRead(x, &value));
  PetscCall(MatCreateDense(r->comm, n, PETSC_DECIDE, PETSC_DETERMINE, 1, (PetscScalar *)value, &X));
  PetscCall(PetscMalloc1(r->reduction.model.m, &sum));
  PetscCall(BlockGram(r->reduction.MPhi, X, sum));
  if (square) *square = 0;
  for (PetscInt k = 0; k < r->reduction.model.m; k++) {
    coordinates[k] += sum[k];
    if (square) *square += PetscSqr(sum[k]);
  }
  PetscCall(PetscFree(sum));
  PetscCall(MatDestroy(&X));
  PetscCall(VecRestoreArrayRead(x, &value));
  PetscFunctionReturn(0);
}

/* The same of nodal values [nodes][3]; share = what the modes hold of their square, 0 where all are zero. Raises the
   error where that is too little */
static PetscErrorCode StartProjectNodal(ReducedRun r, const char what[], const PetscReal nodal[],
                                        PetscReal coordinates[], PetscReal *share)
{
  const Mesh  *mesh;
  PetscScalar *value;
  PetscReal    held, whole;
  Vec          x;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(r->run.model, &mesh));
  PetscCall(OperatorsCreateVec(r->run.operators, &x));
  PetscCall(VecGetArray(x, &value));
  for (PetscInt i = 0; i < 3 * mesh->n_nodes; i++) {
    const PetscInt row = mesh->unknown[i] - mesh->first_own;

    if (mesh->unknown[i] >= 0 && row >= 0 && row < mesh->n_own) value[row] = nodal[i];
  }
  PetscCall(VecRestoreArray(x, &value));
  PetscCall(StartWeigh(r, x, &whole));
  PetscCall(StartProject(r, x, coordinates, &held));
  PetscCall(VecDestroy(&x));
  *share = whole > 0 ? held / whole : 0;
  PetscCheck(
    whole == 0 || *share >= START_SHARE, r->comm, PETSC_ERR_USER_INPUT,
    "-dynamics_cutoff %.6g Hz: the modes below it hold %.2g %% of the %s, must be %.0f %% at least; take a higher "
    "one, or -dynamics_model full",
    (double)r->request.cutoff, (double)(100 * *share), what, 100 * START_SHARE);
  PetscFunctionReturn(0);
}

/* Velocities of the parts, the mean where they share a node */
static PetscErrorCode StartVelocities(ReducedRun r)
{
  const PetscReal  *velocity = ExternalGetVelocity(r->run.external);
  const ModelScene *scene;
  const Mesh       *mesh;
  PetscReal        *nodal;
  PetscInt         *count;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(r->run.model, &scene));
  PetscCall(ModelGetMesh(r->run.model, &mesh));
  PetscCall(PetscCalloc2(3 * mesh->n_nodes, &nodal, mesh->n_nodes, &count));
  for (PetscInt i = 0; i < scene->n_parts; i++) {
    PetscInt n, *node;

    PetscCall(ModelGetSetNodes(r->run.model, scene->parts[i].volume, &n, &node));
    for (PetscInt k = 0; k < n; k++) {
      for (int d = 0; d < 3; d++) nodal[3 * node[k] + d] += velocity[3 * i + d];
      count[node[k]]++;
    }
    PetscCall(PetscFree(node));
  }
  for (PetscInt i = 0; i < 3 * mesh->n_nodes; i++) nodal[i] /= PetscMax(1, count[i / 3]);
  PetscCall(StartProjectNodal(r, "kinetic energy of the starting velocities", nodal, r->motion.state.rate,
                              &r->reduction.held.velocities));
  PetscCall(PetscFree2(nodal, count));
  PetscFunctionReturn(0);
}

/* Forces and displacements of the sliding state; signs as in PairSetState(). Of u only what the modes hold is
   taken: the rest is W times the forces, by itself. */
static PetscErrorCode StartSliding(ReducedRun r)
{
  const ContactState *local;
  ContactState       *all;
  Vec                 u;

  PetscFunctionBeginUser;
  PetscCall(StaticsCheckLasting(r->run.statics));
  PetscCall(StaticsSolve(r->run.statics, NULL));
  PetscCall(StaticsGetState(r->run.statics, &local, &u));
  PetscCall(GatherRecords(r->comm, r->reduction.n_local, sizeof(*local), local, NULL, &all));
  for (PetscInt i = 0; i < r->reduction.model.n_pairs; i++) {
    r->motion.state.p[3 * i] = all[i].lambda_n;
    for (int d = 0; d < 2; d++) r->motion.state.p[3 * i + 1 + d] = -all[i].lambda_t[d];
    r->motion.state.status[i] = all[i].status;
  }
  PetscCall(PetscFree(all));
  PetscCall(StartProject(r, u, r->motion.state.eta, NULL));
  PetscCall(StaticsRelease(r->run.statics));
  PetscFunctionReturn(0);
}

/* What -dynamics_shape adds */
static PetscErrorCode StartShape(ReducedRun r)
{
  const Mesh *mesh;
  PetscReal  *u, *v;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(r->run.model, &mesh));
  PetscCall(PetscMalloc2(3 * mesh->n_nodes, &u, 3 * mesh->n_nodes, &v));
  PetscCall(DynamicsGetShape(r->dynamics, u, v));
  PetscCall(
    StartProjectNodal(r, "displacements of -dynamics_shape", u, r->motion.state.eta, &r->reduction.held.displacements));
  PetscCall(StartProjectNodal(r, "velocities of -dynamics_shape", v, r->motion.state.rate, &r->reduction.held.rates));
  PetscCall(PetscFree2(u, v));
  PetscFunctionReturn(0);
}

/* Forces of the pairs that obey the laws at the start, on the compliance of the residual, with slip along what is
   prescribed: those that are there are the guess. Without it the first step would be of first order */
static PetscErrorCode StartLaws(ReducedRun r)
{
  const ReducedModel  *model = &r->reduction.model;
  const PetscInt       n     = 3 * model->n_pairs;
  PetscReal           *W, *Wp, *q, *slip0;
  ComplianceReport     solved;
  SparseLaws           sparse = NULL;
  ComplianceMap        map;
  const ContactStatus *status;
  ContactCompliance    laws;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(model->sparse ? 0 : n * n, &W, n, &Wp, n, &q, 2 * model->n_pairs, &slip0));
  PetscCall(ReducedPairDisplacements(model, r->motion.state.eta, r->motion.state.p, q));
  if (model->sparse)
    PetscCall(SparseTimes(model->sparse, r->motion.state.p, Wp, NULL));
  else
    for (PetscInt j = 0; j < n; j++) PetscCall(PetscArraycpy(&W[n * j], &model->W[model->n_ports * j], n));
  for (PetscInt i = 0; i < n; i++) {
    q[i] += i % 3 ? 0 : model->gap[i / 3];
    if (i % 3) slip0[2 * (i / 3) + i % 3 - 1] = q[i];
    if (model->sparse) q[i] -= Wp[i];
    for (PetscInt j = 0; j < n && !model->sparse; j++) q[i] -= W[i + n * j] * r->motion.state.p[j];
  }
  for (PetscInt i = 0; i < model->n_pairs; i++) {
    PetscReal way;

    PetscCall(ReducedGetWay(r, i, &way));
    slip0[2 * i] -= way;
  }
  if (model->sparse) {
    PetscCall(SparseLawsCreate(model->sparse, NULL, &sparse));
    SparseLawsGetMap(sparse, &map);
    PetscCall(ContactComplianceCreateMap(model->n_pairs, &map, &laws));
    PetscCall(ContactComplianceSetTolerance(laws, SPARSE_RTOL));
  } else
    PetscCall(ContactComplianceCreate(model->n_pairs, W, &laws));
  PetscCall(ContactComplianceSetFriction(laws, model->friction, r->motion.dt));
  if (model->spring) PetscCall(ContactComplianceSetSprings(laws, model->spring));
  PetscCall(ContactComplianceSolve(laws, q, slip0, r->motion.state.p, NULL, &solved));
  PetscCheck(solved.converged, r->comm, PETSC_ERR_NOT_CONVERGED,
             "contact forces do not converge at the start: residual %.2e of pair %" PetscInt_FMT,
             (double)solved.residual, solved.worst + 1);
  PetscCall(ContactComplianceGetStatus(laws, &status));
  PetscCall(PetscArraycpy(r->motion.state.status, status, model->n_pairs));
  PetscCall(ContactComplianceDestroy(&laws));
  PetscCall(SparseLawsDestroy(&sparse));
  PetscCall(PetscFree4(W, Wp, q, slip0));
  PetscFunctionReturn(0);
}

/* Velocities, then displacements, then the forces that obey the laws with both; last, begin and q = p as if the state
   had been there for long. */
PetscErrorCode ReducedStart(ReducedRun r)
{
  ReducedState *s = &r->motion.state;
  PetscBool     changed;

  PetscFunctionBeginUser;
  PetscCall(StartVelocities(r));
  if (r->run.from_static) PetscCall(StartSliding(r));
  PetscCall(StartShape(r));
  ReducedSetLoads(r, 0, &s->p[3 * r->reduction.model.n_pairs]);
  PetscCall(ReducedSetFriction(r, 0, &changed));
  PetscCall(StartLaws(r));
  PetscCall(PetscArraycpy(s->last, s->p, r->reduction.model.n_ports));
  PetscCall(PetscArraycpy(s->begin, s->p, 3 * r->reduction.model.n_pairs));
  PetscCall(PetscArraycpy(s->q, s->p, 3 * r->reduction.model.n_pairs));
  PetscCall(ReducedPairDisplacements(&r->reduction.model, s->eta, s->p, s->y));
  PetscFunctionReturn(0);
}
