/*
   What is recorded at t_n: the ledger (residual part included), rows of the histories, fields that are lifted to the
   mesh,

      u = Phi eta + X p (q in place of lambda),   v = Phi eta' + X p',   at probes a = Phi eta''
      p' = (3 p_n - 4 p_{n-1} + p_{n-2}) / (2 dt)

   with X of reduced.h: two solutions for a snapshot, none for a probe.
*/
#include "reduced/reducedimpl.h"
#include "base/events.h"

/* What acts on the residual, q and the loads, and after a step the rate of that, N/s, by the backward difference of
   second order from this mean rate and the one before; p_rate [2 n_ports] = rate at t_n, mean rate of the last
   step. */
void ReducedSetShown(ReducedRun r, PetscBool start)
{
  const PetscInt N = r->reduction.model.n_ports, n = 3 * r->reduction.model.n_pairs;

  for (PetscInt i = 0; i < N; i++) {
    const PetscReal now  = i < n ? r->motion.state.q[i] : r->motion.state.p[i],
                    mean = (now - r->motion.shown[i]) / r->motion.dt;

    r->motion.shown[i] = now;
    if (start) continue;
    r->motion.p_rate[i]     = 1.5 * mean - 0.5 * r->motion.p_rate[N + i];
    r->motion.p_rate[N + i] = mean;
  }
}

/* Takes the forces of branches off the accelerations of the modes */
static PetscErrorCode RecordBranches(ReducedRun r)
{
  const ReducedModel *model = &r->reduction.model;
  const PetscInt      n     = model->m + 3 * model->n_pairs;
  PetscReal          *force, *work;

  PetscFunctionBeginUser;
  if (!model->n_branches) PetscFunctionReturn(0);
  PetscCall(PetscMalloc2(n, &force, n, &work));
  ReducedBranchForces(model, 0, r->motion.state.z, work, force);
  for (PetscInt k = 0; k < model->m; k++) r->motion.acceleration[k] -= force[k];
  PetscCall(PetscFree2(force, work));
  PetscFunctionReturn(0);
}

/* eta'' = P'p - Omega^2 eta - C eta' - Cm q', m sqrt(kg)/s^2; q' by differences, as in velocities */
static PetscErrorCode RecordAccelerate(ReducedRun r)
{
  const ReducedModel *model = &r->reduction.model;
  const PetscInt      m     = model->m;
  PetscReal          *a     = r->motion.acceleration;

  PetscFunctionBeginUser;
  ReducedTimes(&(DenseBlock){model->P, m, model->n_ports, m},
               &(DenseBlock){r->motion.state.p, model->n_ports, 1, model->n_ports}, a);
  for (PetscInt k = 0; k < m; k++) a[k] -= model->omega2[k] * r->motion.state.eta[k];
  if (model->C) ReducedBlockTimes(&(DenseBlock){model->C, m, m, m}, PETSC_FALSE, -1, r->motion.state.rate, a);
  if (model->Cm)
    ReducedBlockTimes(&(DenseBlock){model->Cm, m, 3 * model->n_pairs, m}, PETSC_FALSE, -1, r->motion.p_rate, a);
  PetscCall(RecordBranches(r));
  PetscFunctionReturn(0);
}

/* Of the motions at a port, m/s^2, with what they do by way of the residual, by the second difference of their factors
   over a step to both sides */
static PetscReal RecordMotionAcceleration(ReducedRun r, PetscInt port)
{
  const ReducedModel *model = &r->reduction.model;
  const PetscReal     t = r->motion.state.time, dt = r->motion.dt;
  PetscReal           a = 0;

  for (PetscInt i = 0; i < model->n_motions; i++) {
    const Ramp     *ramp = ExternalGetMotion(r->run.external, i);
    const PetscReal Y = model->Y[model->n_ports * i + port] + ReducedColumn(model, ReducedFirstMotion(model) + i)[port];

    if (Y != 0) a += Y * (RampValue(ramp, t + dt) - 2 * RampValue(ramp, t) + RampValue(ramp, t - dt)) / (dt * dt);
  }
  return a;
}

/* Adds what the motions move, of their factors or rates in p, to nodal values */
static PetscErrorCode RecordAddMotions(ReducedRun r, const PetscReal p[], PetscReal nodal[])
{
  const ReducedModel *model = &r->reduction.model;
  const Mesh         *mesh;
  PetscReal          *moved;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(r->run.model, &mesh));
  PetscCall(PetscMalloc1(3 * mesh->n_nodes, &moved));
  for (PetscInt i = 0; i < model->n_motions; i++) {
    PetscCall(ModelGetMotion(r->run.model, i, moved));
    for (PetscInt k = 0; k < 3 * mesh->n_nodes; k++) nodal[k] += p[ReducedFirstMotion(model) + i] * moved[k];
  }
  PetscCall(PetscFree(moved));
  PetscFunctionReturn(0);
}

/* Motion of a node that is looked at */
static void RecordNode(void *ctx, PetscInt node, PetscReal u[3], PetscReal v[3], PetscReal a[3])
{
  const ReducedRun    r     = ctx;
  const ReducedModel *model = &r->reduction.model;
  const PetscInt      port  = r->reduction.vertex_port[node];

  for (int d = 0; d < 3; d++) {
    u[d] = ReducedPortDisplacement(model, r->motion.state.eta, r->motion.shown, port + d);
    v[d] = ReducedPortDisplacement(model, r->motion.state.rate, r->motion.p_rate, port + d);
    a[d] = 0;
    for (PetscInt k = 0; k < model->m; k++) a[d] += model->P[k + model->m * (port + d)] * r->motion.acceleration[k];
    a[d] += RecordMotionAcceleration(r, port + d);
  }
}

/* Phi coordinates + R V p at the local nodes, [nodes][3] */
static PetscErrorCode RecordLiftOne(ReducedRun r, const PetscReal coordinates[], const PetscReal p[], PetscReal nodal[])
{
  const PetscInt n_pairs = 3 * r->reduction.model.n_pairs;
  PetscScalar   *value;
  Vec            force, x, ports, others;
  Mat            B, X;

  PetscFunctionBeginUser;
  PetscCall(MatDuplicate(r->motion.column, MAT_DO_NOT_COPY_VALUES, &B));
  PetscCall(MatDuplicate(r->motion.column, MAT_DO_NOT_COPY_VALUES, &X));
  PetscCall(MatCreateVecs(r->reduction.G, &x, &ports));
  PetscCall(VecGetArray(ports, &value));
  PetscCall(PetscArraycpy(value, &p[3 * r->reduction.begin], 3 * r->reduction.n_local));
  PetscCall(VecRestoreArray(ports, &value));
  PetscCall(MatDenseGetColumnVecWrite(B, 0, &force));
  PetscCall(MatMultTranspose(r->reduction.G, ports, force));
  PetscCall(ReducedAddCombination(r->reduction.others, &p[n_pairs], force));
  PetscCall(MatDenseRestoreColumnVecWrite(B, 0, &force));
  PetscCall(ReducedApplyResidual(r, B, X));
  PetscCall(MatDenseGetColumnVecRead(X, 0, &others));
  PetscCall(VecCopy(others, x));
  PetscCall(MatDenseRestoreColumnVecRead(X, 0, &others));
  PetscCall(ReducedAddCombination(r->reduction.Phi, coordinates, x));
  PetscCall(ModelGetNodal(r->run.model, x, nodal));
  PetscCall(RecordAddMotions(r, p, nodal));
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&ports));
  PetscCall(MatDestroy(&B));
  PetscCall(MatDestroy(&X));
  PetscFunctionReturn(0);
}

static PetscErrorCode RecordLift(void *ctx, PetscReal u[], PetscReal v[])
{
  const ReducedRun r = ctx;

  PetscFunctionBeginUser;
  PetscCall(RecordLiftOne(r, r->motion.state.eta, r->motion.shown, u));
  PetscCall(RecordLiftOne(r, r->motion.state.rate, r->motion.p_rate, v));
  PetscFunctionReturn(0);
}

static PetscErrorCode RecordShape(void *ctx, PetscInt k, PetscReal v[])
{
  const ReducedRun r = ctx;
  Vec              shape;

  PetscFunctionBeginUser;
  PetscCall(MatDenseGetColumnVecRead(r->reduction.Phi, k, &shape));
  PetscCall(ModelGetNodal(r->run.model, shape, v));
  PetscCall(MatDenseRestoreColumnVecRead(r->reduction.Phi, k, &shape));
  PetscFunctionReturn(0);
}

/* The ledger at t_n; rank 0 has all of it, since every rank holds the same numbers and LedgerClose() sums over the
   ranks. */
static PetscErrorCode RecordBalance(ReducedRun r, PetscBool first)
{
  LedgerPart *part = &r->motion.ledger.part;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(r->comm, &rank));
  ReducedEnergy(&r->reduction.model, &r->motion.state, &part->kinetic, &part->strain);
  if (rank) *part = (LedgerPart){0};
  PetscCall(LedgerClose(r->comm, &r->motion.ledger, r->run.n_interfaces, r->motion.sums, first));
  PetscCall(LedgerJudge(r->comm, &r->motion.ledger.total, 0, r->motion.step, r->motion.state.time));
  PetscCall(LedgerJudgeContact(r->comm, &r->motion.ledger.total, r->motion.step, r->motion.state.time));
  PetscFunctionReturn(0);
}

/* This rank's pairs for the histories */
static PetscErrorCode RecordPairs(ReducedRun r, HistoryPairs *pairs, PetscInt **interface, PetscReal **x)
{
  const Mesh *mesh;
  PetscInt   *number;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(r->run.model, &mesh));
  PetscCall(PetscMalloc1(2 * r->reduction.n_local, interface));
  PetscCall(PetscMalloc1(3 * r->reduction.n_local, x));
  number = *interface + r->reduction.n_local;
  for (PetscInt i = 0; i < r->reduction.n_local; i++) {
    const ContactPair *pair = &r->reduction.pair[r->reduction.begin + i];

    (*interface)[i] = pair->interface;
    number[i]       = pair->vertex;
    PetscCall(PetscArraycpy(&(*x)[3 * i], pair->x, 3));
  }
  *pairs = (HistoryPairs){r->reduction.n_local, r->motion.pairs + r->reduction.begin, *interface, number, *x};
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedRecord(ReducedRun r, PetscBool first)
{
  const SoundShapes    shapes  = {r->reduction.model.m, RecordShape, r}; /* the residual is left out */
  const HistoryMotions motions = {r, RecordNode, RecordLift, &shapes, r->motion.state.rate};
  PetscInt            *interface;
  PetscReal           *x;
  HistoryPairs         pairs;
  HistoryState         state = {.step         = r->motion.step,
                                .time         = r->motion.state.time,
                                .dt           = r->motion.dt,
                                .ledger       = &r->motion.ledger.total,
                                .n_interfaces = r->run.n_interfaces,
                                .sums         = r->motion.sums,
                                .motions      = &motions,
                                .pairs        = &pairs};

  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_RECORD));
  PetscCall(RecordBalance(r, first));
  PetscCall(RecordAccelerate(r));
  PetscCall(RecordPairs(r, &pairs, &interface, &x));
  PetscCall(HistoryRecord(r->run.history, &state));
  PetscCall(PetscFree(interface));
  PetscCall(PetscFree(x));
  PetscCall(EventEnd(EVENT_RECORD));
  PetscFunctionReturn(0);
}
