/*
   Ports as vectors V of all unknowns: of a pair the force on its slave along n, t and b, with the opposite on the
   master, so that V'u is what opens the gap and the slip of the slave; of a load its forces; of a probe 1 N along x, y,
   z. Impulses J act on the modes alone, as Phi'J.
*/
#include "reduced/reducedimpl.h"

/* G [3 pairs of this rank][unknowns], rows -n, -t, -b times (u_m - u_s): +1 at the slave, so that a force lambda at
   a port acts on the slave along the direction; V of the pairs is G'. Pairs are numbered over the ranks in order,
   from `begin` on here. */
static PetscErrorCode PortsCreatePairs(ReducedRun r)
{
  const ContactPair *pair;
  PetscInt           n, n_all, *row;
  PetscReal(*direction)[3];

  PetscFunctionBeginUser;
  PetscCall(ContactGetPairs(r->run.contact, &n, &n_all, &pair));
  PetscCall(PetscMalloc2(3 * n, &row, 3 * n, &direction));
  for (PetscInt i = 0; i < 3 * n; i++) {
    const PetscReal *e = i % 3 == 0 ? pair[i / 3].n : i % 3 == 1 ? pair[i / 3].t : pair[i / 3].b;

    row[i] = i / 3;
    for (int d = 0; d < 3; d++) direction[i][d] = -e[d];
  }
  PetscCall(ContactCreateRows(r->run.contact, 3 * n, row, (const PetscReal(*)[3])direction, &r->reduction.G));
  PetscCall(PetscFree2(row, direction));
  r->reduction.n_local       = n;
  r->reduction.model.n_pairs = n_all;
  PetscCallMPI(MPI_Exscan(&n, &r->reduction.begin, 1, MPIU_INT, MPI_SUM, r->comm));
  PetscFunctionReturn(0);
}

/* The force `value` on the unknown of node `vertex` (-1 on ranks that do not name it), direction d, added to column
   k by the rank that owns it. Held directions have no unknown, and no force. Collective. */
static PetscErrorCode PortSetUnit(ReducedRun r, PetscInt vertex, int d, PetscReal value, PetscInt k, Mat columns)
{
  const Mesh *mesh;
  PetscInt    row = -1;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(r->run.model, &mesh));
  if (vertex >= 0) row = mesh->unknown[3 * vertex + d];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &row, 1, MPIU_INT, MPI_MAX, r->comm));
  if (row >= mesh->first_own && row < mesh->first_own + mesh->n_own) {
    PetscScalar *v;
    PetscInt     stride;

    PetscCall(MatDenseGetLDA(columns, &stride));
    PetscCall(MatDenseGetArray(columns, &v));
    v[k * stride + row - mesh->first_own] += value;
    PetscCall(MatDenseRestoreArray(columns, &v));
  }
  PetscFunctionReturn(0);
}

/* Load i of the scene, N; of a bolt with the shortening that it has, or finds in the sliding state */
static PetscErrorCode PortsAddLoad(ReducedRun r, PetscInt i, Vec nodal)
{
  const ModelScene *scene;
  PetscReal         factor;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(r->run.model, &scene));
  factor = scene->loads[i].has_shortening ? scene->loads[i].shortening : 1;
  if (scene->loads[i].has_tension) PetscCall(StaticsGetShortening(r->run.statics, i, &factor));
  PetscCall(OperatorsAddLoad(r->run.operators, NULL, i, factor, nodal));
  PetscFunctionReturn(0);
}

/* The sliding state, where a bolt's shortening comes from it */
static PetscErrorCode PortsFindBolts(ReducedRun r)
{
  const ModelScene *scene;
  PetscBool         any = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(r->run.model, &scene));
  for (PetscInt i = 0; i < scene->n_loads; i++)
    if (scene->loads[i].has_tension) any = PETSC_TRUE;
  if (any) PetscCall(StaticsSolve(r->run.statics, NULL));
  if (any && r->run.restart) PetscCall(StaticsRelease(r->run.statics));
  PetscFunctionReturn(0);
}

/* Loads, then the weight where there is gravity; N for the factor 1. */
static PetscErrorCode PortsSetLoads(ReducedRun r, PetscInt n)
{
  const ModelScene *scene;
  Vec               nodal;
  PetscReal         total[3];

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(r->run.model, &scene));
  PetscCall(PortsFindBolts(r));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(ModelCreateNodal(r->run.model, &nodal));
    if (i < scene->n_loads)
      PetscCall(PortsAddLoad(r, i, nodal));
    else
      PetscCall(OperatorsAddWeight(r->run.operators, r->request.p, nodal, total));
    PetscCall(ReducedPortSetNodal(r, nodal, i));
    PetscCall(VecDestroy(&nodal));
  }
  PetscFunctionReturn(0);
}

/* A probe at the next port; its node remembers which */
static PetscErrorCode PortsAddProbe(ReducedRun r, const Probe *probe, PetscInt *next)
{
  PetscFunctionBeginUser;
  if (probe->vertex >= 0) r->reduction.vertex_port[probe->vertex] = 3 * r->reduction.model.n_pairs + *next;
  for (int d = 0; d < 3; d++) PetscCall(PortSetUnit(r, probe->vertex, d, 1, (*next)++, r->reduction.others));
  PetscFunctionReturn(0);
}

static PetscErrorCode PortsSetProbes(ReducedRun r)
{
  const ModelScene *scene;
  const Mesh       *mesh;
  PetscInt          next = r->reduction.model.n_loads;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(r->run.model, &scene));
  PetscCall(ModelGetMesh(r->run.model, &mesh));
  PetscCall(PetscMalloc1(mesh->n_nodes, &r->reduction.vertex_port));
  for (PetscInt i = 0; i < mesh->n_nodes; i++) r->reduction.vertex_port[i] = -1;
  for (PetscInt i = 0; i < scene->n_probes; i++) PetscCall(PortsAddProbe(r, &scene->probes[i], &next));
  for (PetscInt i = 0; i < scene->n_circles; i++)
    for (PetscInt k = 0; k < scene->circles[i].n; k++) PetscCall(PortsAddProbe(r, &scene->circles[i].probe[k], &next));
  PetscFunctionReturn(0);
}

/* Phi'J of each impulse, m sqrt(kg)/s: what the rates of the coordinates jump by; and when each is due, s. */
static PetscErrorCode PortsSetHits(ReducedRun r)
{
  PetscInt n_own;
  Mat      J;

  PetscFunctionBeginUser;
  PetscCall(ExternalCountHits(r->run.external, &r->reduction.n_hits));
  if (!r->reduction.n_hits) PetscFunctionReturn(0);
  PetscCall(MatGetLocalSize(r->reduction.Phi, &n_own, NULL));
  PetscCall(MatCreateDense(r->comm, n_own, PETSC_DECIDE, PETSC_DETERMINE, r->reduction.n_hits, NULL, &J));
  PetscCall(MatZeroEntries(J));
  PetscCall(PetscMalloc2(r->reduction.n_hits * r->reduction.model.m, &r->reduction.hits, r->reduction.n_hits,
                         &r->reduction.hit_due));
  for (PetscInt i = 0; i < r->reduction.n_hits; i++) {
    ExternalHit hit;
    PetscInt    vertex;

    PetscCall(ExternalFindHit(r->run.external, i, &hit, &vertex));
    r->reduction.hit_due[i] = hit.time;
    for (int d = 0; d < 3; d++) PetscCall(PortSetUnit(r, vertex, d, hit.impulse[d], i, J));
  }
  PetscCall(BlockGram(r->reduction.Phi, J, r->reduction.hits));
  PetscCall(MatDestroy(&J));
  PetscFunctionReturn(0);
}

/* P of the pairs: row i of G Phi on the rank that has it */
static PetscErrorCode PortsSetShapes(ReducedRun r)
{
  const PetscInt     m = r->reduction.model.m, n = 3 * r->reduction.model.n_pairs;
  const PetscScalar *value;
  PetscInt           stride;
  Mat                GPhi;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(m * r->reduction.model.n_ports, &r->reduction.model.P));
  PetscCall(MatMatMult(r->reduction.G, r->reduction.Phi, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &GPhi));
  PetscCall(MatDenseGetLDA(GPhi, &stride));
  PetscCall(MatDenseGetArrayRead(GPhi, &value));
  for (PetscInt i = 0; i < 3 * r->reduction.n_local; i++)
    for (PetscInt k = 0; k < m; k++) r->reduction.model.P[m * (3 * r->reduction.begin + i) + k] = value[k * stride + i];
  PetscCall(MatDenseRestoreArrayRead(GPhi, &value));
  PetscCall(MatDestroy(&GPhi));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, r->reduction.model.P, (PetscMPIInt)(m * n), MPIU_REAL, MPI_SUM, r->comm));
  PetscCall(BlockGram(r->reduction.Phi, r->reduction.others, &r->reduction.model.P[m * n]));
  PetscFunctionReturn(0);
}

/* n_ports = 3 pairs + loads + 3 probes, nodes of circles counted as probes. Pairs are rows of the sparse G, all
   others columns of the dense `others` [unknowns][loads + 3 probes]. */
PetscErrorCode ReducedSetPorts(ReducedRun r)
{
  const ModelScene *scene;
  PetscInt          n_own, n_forces;
  Mat               C;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(r->run.model, &scene));
  PetscCall(OperatorsGetBodies(r->run.operators, r->request.p, NULL, NULL, &C));
  PetscCall(PortsCreatePairs(r));
  n_forces                     = scene->n_loads + (ModelHasGravity(r->run.model) ? 1 : 0);
  r->reduction.model.n_motions = scene->n_motions;
  r->reduction.model.dragged   = C && scene->n_motions ? PETSC_TRUE : PETSC_FALSE;
  r->reduction.model.n_loads   = n_forces + (r->reduction.model.dragged ? 2 : 1) * scene->n_motions;
  r->reduction.model.n_probes  = scene->n_probes;
  for (PetscInt i = 0; i < scene->n_circles; i++) r->reduction.model.n_probes += scene->circles[i].n;
  r->reduction.model.n_ports =
    3 * r->reduction.model.n_pairs + r->reduction.model.n_loads + 3 * r->reduction.model.n_probes;
  PetscCall(MatGetLocalSize(r->reduction.Phi, &n_own, NULL));
  PetscCall(MatCreateDense(r->comm, n_own, PETSC_DECIDE, PETSC_DETERMINE,
                           r->reduction.model.n_loads + 3 * r->reduction.model.n_probes, NULL, &r->reduction.others));
  PetscCall(MatZeroEntries(r->reduction.others));
  PetscCall(PortsSetLoads(r, n_forces));
  PetscCall(PortsSetProbes(r));
  PetscCall(ReducedSetMotions(r, n_forces));
  PetscCall(PortsSetHits(r));
  PetscCall(PortsSetShapes(r));
  PetscFunctionReturn(0);
}
