/*
   Points of matrices without a mesh (nodetable.c) as a mesh whose cells are points, so that shapes are written and
   named as those of a mesh are. Ranks share the nodes, whichever unknowns they have.
*/
#include "nodetable.h"

/* Counts the nodes of the table, and gives each its rows: first [nodes + 1], to be freed */
static PetscErrorCode CloudCount(const NodeTable *table, PetscInt *n_nodes, PetscInt **first)
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(table->n + 1, first));
  for (PetscInt i = 0; i < table->n; i++)
    if (i == 0 || table->row[i].node != table->row[i - 1].node) (*first)[n++] = i;
  (*first)[n] = table->n;
  *n_nodes    = n;
  PetscFunctionReturn(0);
}

/* Nodes begin .. begin + n - 1 of the table as a mesh: x (m), unknowns by direction, -1 where a node has none along
   it; each is a cell of its own. */
static PetscErrorCode CloudTabulate(struct _p_Cloud *c, const NodeTable *table, PetscInt begin, PetscInt n,
                                    const PetscInt first[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc5(3 * n, &c->x, n, &c->number, 3 * n, &c->unknown, n + 1, &c->cell_first, n, &c->cell_node));
  PetscCall(PetscMalloc3(n, &c->cell_part, n, &c->owned, n, &c->element));
  for (PetscInt v = 0; v < n; v++) {
    const PetscInt row = first[begin + v];

    for (int d = 0; d < 3; d++) c->x[3 * v + d] = table->row[row].x[d];
    for (int d = 0; d < 3; d++) c->unknown[3 * v + d] = -1;
    for (PetscInt i = row; i < first[begin + v + 1]; i++)
      if (table->row[i].direction) c->unknown[3 * v + table->row[i].direction - 1] = table->row[i].unknown;
    c->number[v]     = begin + v;
    c->cell_first[v] = c->cell_node[v] = v;
    c->cell_part[v]                    = table->row[row].part;
    c->owned[v]                        = PETSC_TRUE;
    c->element[v]                      = ElementPoint();
  }
  c->cell_first[n] = n;
  PetscCall(PetscMalloc1(table->n_parts, &c->part));
  for (PetscInt i = 0; i < table->n_parts; i++) PetscCall(PetscStrallocpy(table->part[i], &c->part[i]));
  PetscFunctionReturn(0);
}

/* What brings the values of the unknowns, which live with the rows of the matrices, to the nodes, which do not */
static PetscErrorCode CloudConnect(Operators o, struct _p_Cloud *c, PetscInt n)
{
  PetscInt m = 0, *unknown;
  IS       is;
  Vec      u;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(3 * n, &c->at));
  PetscCall(PetscMalloc1(3 * n, &unknown));
  for (PetscInt i = 0; i < 3 * n; i++) {
    if (c->unknown[i] < 0) continue;
    c->at[m]     = i;
    unknown[m++] = c->unknown[i];
  }
  PetscCall(OperatorsCreateVec(o, &u));
  PetscCall(ISCreateGeneral(PETSC_COMM_SELF, m, unknown, PETSC_OWN_POINTER, &is));
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, m, &c->values));
  PetscCall(VecScatterCreate(u, is, c->values, NULL, &c->scatter));
  PetscCall(ISDestroy(&is));
  PetscCall(VecDestroy(&u));
  PetscFunctionReturn(0);
}

/* Collective. Nodes are split evenly over the ranks, in the order of the table, which need not be that of the
   unknowns. */
PetscErrorCode CloudCreate(Operators o)
{
  NodeTable        table;
  PetscInt         n_unknowns, n_nodes, n = PETSC_DECIDE, end, *first;
  struct _p_Cloud *c;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(o->terms.term[0].A, &n_unknowns, NULL));
  PetscCall(NodeTableRead(o->comm, o->nodes, n_unknowns, &table));
  PetscCall(CloudCount(&table, &n_nodes, &first));
  PetscCall(PetscSplitOwnership(o->comm, &n, &n_nodes));
  PetscCallMPI(MPI_Scan(&n, &end, 1, MPIU_INT, MPI_SUM, o->comm));
  PetscCall(PetscCalloc1(1, &c));
  PetscCall(CloudTabulate(c, &table, end - n, n, first));
  PetscCall(CloudConnect(o, c, n));
  c->mesh = (Mesh){.n_nodes    = n,
                   .n_cells    = n,
                   .n_parts    = table.n_parts,
                   .x          = c->x,
                   .number     = c->number,
                   .owned      = c->owned,
                   .unknown    = c->unknown,
                   .element    = c->element,
                   .cell_first = c->cell_first,
                   .cell_node  = c->cell_node,
                   .cell_part  = c->cell_part,
                   .part       = (const char *const *)c->part,
                   .n_unknowns = n_unknowns};
  PetscCall(MatGetOwnershipRange(o->terms.term[0].A, &c->mesh.first_own, &c->mesh.n_own));
  c->mesh.n_own -= c->mesh.first_own;
  o->cloud = c;
  PetscCall(PetscFree(first));
  PetscCall(PetscFree(table.row));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetMesh(Operators o, const Mesh **mesh)
{
  PetscFunctionBeginUser;
  *mesh = o->cloud ? &o->cloud->mesh : NULL;
  if (o->model) PetscCall(ModelGetMesh(o->model, mesh));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetNodal(Operators o, Vec u, PetscReal nodal[])
{
  struct _p_Cloud   *c = o->cloud;
  const PetscScalar *value;
  PetscInt           n;

  PetscFunctionBeginUser;
  if (o->model) {
    PetscCall(ModelGetNodal(o->model, u, nodal));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscArrayzero(nodal, 3 * c->mesh.n_nodes));
  if (!u) PetscFunctionReturn(0);
  PetscCall(VecScatterBegin(c->scatter, u, c->values, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(c->scatter, u, c->values, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecGetLocalSize(c->values, &n));
  PetscCall(VecGetArrayRead(c->values, &value));
  for (PetscInt i = 0; i < n; i++) nodal[c->at[i]] = PetscRealPart(value[i]);
  PetscCall(VecRestoreArrayRead(c->values, &value));
  PetscFunctionReturn(0);
}

PetscErrorCode CloudDestroy(Operators o)
{
  struct _p_Cloud *c = o->cloud;

  PetscFunctionBeginUser;
  if (!c) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < c->mesh.n_parts; i++) PetscCall(PetscFree(c->part[i]));
  PetscCall(PetscFree(c->part));
  PetscCall(PetscFree5(c->x, c->number, c->unknown, c->cell_first, c->cell_node));
  PetscCall(PetscFree3(c->cell_part, c->owned, c->element));
  PetscCall(PetscFree(c->at));
  PetscCall(VecDestroy(&c->values));
  PetscCall(VecScatterDestroy(&c->scatter));
  PetscCall(PetscFree(o->cloud));
  PetscFunctionReturn(0);
}
