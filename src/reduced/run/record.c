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
  const PetscInt N = r->model.n_ports, n = 3 * r->model.n_pairs;

  for (PetscInt i = 0; i < N; i++) {
    const PetscReal now = i < n ? r->state.q[i] : r->state.p[i], mean = (now - r->shown[i]) / r->dt;

    r->shown[i] = now;
    if (start) continue;
    r->p_rate[i]     = 1.5 * mean - 0.5 * r->p_rate[N + i];
    r->p_rate[N + i] = mean;
  }
}

/* eta'' = P'p - Omega^2 eta - C eta', m sqrt(kg)/s^2, without Cm q', the damping of the residual. */
static PetscErrorCode RecordAccelerate(ReducedRun r)
{
  const ReducedModel *model = &r->model;
  const PetscInt      m     = model->m;

  PetscFunctionBeginUser;
  ReducedTimes(&(DenseBlock){model->P, m, model->n_ports, m},
               &(DenseBlock){r->state.p, model->n_ports, 1, model->n_ports}, r->acceleration);
  for (PetscInt k = 0; k < m; k++) {
    r->acceleration[k] -= model->omega2[k] * r->state.eta[k];
    for (PetscInt j = 0; j < m && model->C; j++) r->acceleration[k] -= model->C[k + m * j] * r->state.rate[j];
  }
  PetscFunctionReturn(0);
}

/* Motion of a node that is looked at */
static void RecordNode(void *ctx, PetscInt node, PetscReal u[3], PetscReal v[3], PetscReal a[3])
{
  const ReducedRun    r     = ctx;
  const ReducedModel *model = &r->model;
  const PetscInt      port  = r->vertex_port[node];

  for (int d = 0; d < 3; d++) {
    u[d] = ReducedPortDisplacement(model, r->state.eta, r->shown, port + d);
    v[d] = ReducedPortDisplacement(model, r->state.rate, r->p_rate, port + d);
    a[d] = 0;
    for (PetscInt k = 0; k < model->m; k++) a[d] += model->P[k + model->m * (port + d)] * r->acceleration[k];
  }
}

/* Phi coordinates + R V p at the local nodes, [nodes][3] */
static PetscErrorCode RecordLiftOne(ReducedRun r, const PetscReal coordinates[], const PetscReal p[], PetscReal nodal[])
{
  const PetscInt n_pairs = 3 * r->model.n_pairs;
  PetscScalar   *value;
  Vec            force, x, ports, others;
  Mat            B, X;

  PetscFunctionBeginUser;
  PetscCall(MatDuplicate(r->column, MAT_DO_NOT_COPY_VALUES, &B));
  PetscCall(MatDuplicate(r->column, MAT_DO_NOT_COPY_VALUES, &X));
  PetscCall(MatCreateVecs(r->G, &x, &ports));
  PetscCall(VecGetArray(ports, &value));
  PetscCall(PetscArraycpy(value, &p[3 * r->begin], 3 * r->n_local));
  PetscCall(VecRestoreArray(ports, &value));
  PetscCall(MatDenseGetColumnVecWrite(B, 0, &force));
  PetscCall(MatMultTranspose(r->G, ports, force));
  PetscCall(ReducedAddCombination(r->others, &p[n_pairs], force));
  PetscCall(MatDenseRestoreColumnVecWrite(B, 0, &force));
  PetscCall(ReducedApplyResidual(r, B, X));
  PetscCall(MatDenseGetColumnVecRead(X, 0, &others));
  PetscCall(VecCopy(others, x));
  PetscCall(MatDenseRestoreColumnVecRead(X, 0, &others));
  PetscCall(ReducedAddCombination(r->Phi, coordinates, x));
  PetscCall(ModelGetNodal(r->run.model, x, nodal));
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
  PetscCall(RecordLiftOne(r, r->state.eta, r->shown, u));
  PetscCall(RecordLiftOne(r, r->state.rate, r->p_rate, v));
  PetscFunctionReturn(0);
}

/* The ledger at t_n; rank 0 has all of it, since every rank holds the same numbers and LedgerClose() sums over the
   ranks. */
static PetscErrorCode RecordBalance(ReducedRun r, PetscBool first)
{
  LedgerPart *part = &r->ledger.part;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(r->comm, &rank));
  ReducedEnergy(&r->model, &r->state, &part->kinetic, &part->strain);
  if (rank) *part = (LedgerPart){0};
  PetscCall(LedgerClose(r->comm, &r->ledger, r->run.n_interfaces, r->sums, first));
  PetscCall(LedgerJudge(r->comm, &r->ledger.total, 0, r->step, r->state.time));
  PetscCall(LedgerJudgeContact(r->comm, &r->ledger.total, r->step, r->state.time));
  PetscFunctionReturn(0);
}

/* This rank's pairs for the histories */
static PetscErrorCode RecordPairs(ReducedRun r, HistoryPairs *pairs, PetscInt **interface, PetscReal **x)
{
  const Mesh *mesh;
  PetscInt   *number;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(r->run.model, &mesh));
  PetscCall(PetscMalloc1(2 * r->n_local, interface));
  PetscCall(PetscMalloc1(3 * r->n_local, x));
  number = *interface + r->n_local;
  for (PetscInt i = 0; i < r->n_local; i++) {
    const ContactPair *pair = &r->pair[r->begin + i];

    (*interface)[i] = pair->interface;
    number[i]       = pair->vertex;
    PetscCall(PetscArraycpy(&(*x)[3 * i], pair->x, 3));
  }
  *pairs = (HistoryPairs){r->n_local, r->pairs + r->begin, *interface, number, *x};
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedRecord(ReducedRun r, PetscBool first)
{
  const HistoryMotions motions = {r, RecordNode, RecordLift};
  PetscInt            *interface;
  PetscReal           *x;
  HistoryPairs         pairs;
  HistoryState         state = {.step         = r->step,
                                .time         = r->state.time,
                                .dt           = r->dt,
                                .ledger       = &r->ledger.total,
                                .n_interfaces = r->run.n_interfaces,
                                .sums         = r->sums,
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
