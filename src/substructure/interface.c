/*
   The interface: displacements of the nodes of its sets that are on the parts, in an order that does not depend on
   ranks, by place. What supports hold is none. What lies inside is the rest.
*/
#include "substructureimpl.h"
#include <squeal/options.h>
#include "base/gather.h"
#include <stdlib.h>
#include <string.h>

/* A node of the interface, as ranks send it */
typedef struct {
  PetscReal x[3];
  PetscInt  row[3], part; /* -1 for what is no unknown; least index of the parts that have it */
  PetscInt  inside;       /* 1 for a node that is none of the interface */
} InterfaceNode;

/* Those of the interface first; by x, y, z, then by part */
static int InterfaceNodeCompare(const void *a, const void *b)
{
  const InterfaceNode *l = a, *r = b;

  if (l->inside != r->inside) return l->inside - r->inside;
  for (int d = 0; d < 3; d++)
    if (l->x[d] != r->x[d]) return l->x[d] < r->x[d] ? -1 : 1;
  return (l->part > r->part) - (l->part < r->part);
}

/* Adds the nodes of a set that are on the parts; an error where none is */
static PetscErrorCode InterfaceMark(Substructure s, const char set[], PetscBool on[])
{
  PetscInt n, *node, count[2] = {0, 0};

  PetscFunctionBeginUser;
  PetscCall(ModelGetOwnedNodes(s->model, set, &n, &node));
  for (PetscInt k = 0; k < n; k++) {
    count[0]++;
    if (!s->body.has_part[node[k]]) continue;
    count[1]++;
    on[node[k]] = PETSC_TRUE;
  }
  PetscCall(PetscFree(node));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 2, MPIU_INT, MPI_SUM, s->comm));
  PetscCheck(count[0], s->comm, PETSC_ERR_USER_INPUT, "-superelement_sets: set '%s' has no node", set);
  PetscCheck(count[1], s->comm, PETSC_ERR_USER_INPUT,
             "-superelement_sets: none of the %" PetscInt_FMT
             " nodes of set '%s' is on -superelement_parts; name sets of these parts",
             count[0], set);
  PetscFunctionReturn(0);
}

/* Least part of each local node [nodes], of its cells here; it orders nodes at one place, which are of pieces apart */
static PetscErrorCode NodeParts(const Mesh *mesh, PetscInt **part)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_nodes, part));
  for (PetscInt v = 0; v < mesh->n_nodes; v++) (*part)[v] = PETSC_MAX_INT;
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    for (PetscInt i = mesh->cell_first[c]; i < mesh->cell_first[c + 1]; i++)
      (*part)[mesh->cell_node[i]] = PetscMin((*part)[mesh->cell_node[i]], mesh->cell_part[c]);
  PetscFunctionReturn(0);
}

/* What this rank has of the interface, with `all` of what is inside too */
typedef struct {
  PetscBool      all;
  PetscBool     *on;          /* [nodes] of the sets, owned */
  PetscBool     *is_on;       /* [rows of this rank] unknowns of these nodes */
  PetscInt       n, n_follow; /* nodes; directions of these that are unknowns of the mesh, but follow others inside */
  InterfaceNode *node;        /* [n] */
} InterfaceList;

/* Goes through the nodes; row [3 nodes] is the local one of each displacement, -1 for none */
static void InterfaceListNodes(const Substructure s, const Mesh *mesh, const PetscInt row[], const PetscInt part[],
                               InterfaceList *list)
{
  for (PetscInt v = 0; v < mesh->n_nodes; v++) {
    InterfaceNode *node = &list->node[list->n];

    if (!list->on[v] && !(list->all && mesh->owned[v] && s->body.has_part[v])) continue;
    for (int d = 0; d < 3; d++) {
      const PetscInt k = row[3 * v + d];

      node->x[d]   = mesh->x[3 * v + d];
      node->row[d] = k < 0 ? -1 : s->body.first + k;
      if (k >= 0) list->is_on[k] = list->on[v];
      if (k < 0 && list->on[v] && mesh->unknown[3 * v + d] >= 0) list->n_follow++;
    }
    node->part   = part[v];
    node->inside = !list->on[v];
    list->n++;
  }
}

static PetscErrorCode InterfaceListCreate(Substructure s, const Mesh *mesh, PetscBool all, InterfaceList *list)
{
  PetscInt *row, *part;

  PetscFunctionBeginUser;
  *list = (InterfaceList){.all = all};
  PetscCall(PetscCalloc2(mesh->n_nodes, &list->on, s->body.n_own, &list->is_on));
  PetscCall(PetscMalloc1(mesh->n_nodes, &list->node));
  for (PetscInt i = 0; i < s->n_sets; i++) PetscCall(InterfaceMark(s, s->sets[i], list->on));
  PetscCall(NodeParts(mesh, &part));
  PetscCall(PetscMalloc1(3 * mesh->n_nodes, &row));
  for (PetscInt i = 0; i < 3 * mesh->n_nodes; i++) row[i] = -1;
  for (PetscInt k = 0; k < s->body.n_own; k++) row[s->body.node[k]] = k;
  InterfaceListNodes(s, mesh, row, part, list);
  PetscCall(PetscFree(row));
  PetscCall(PetscFree(part));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &list->n_follow, 1, MPIU_INT, MPI_SUM, s->comm));
  PetscCheck(
    !list->n_follow, s->comm, PETSC_ERR_USER_INPUT,
    "-superelement_sets: %" PetscInt_FMT
    " displacements of their nodes follow others of the parts, by a tie, a rigid point or an equation: name the "
    "sets that they follow",
    list->n_follow);
  PetscFunctionReturn(0);
}

static PetscErrorCode InterfaceListDestroy(InterfaceList *list)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(list->on, list->is_on));
  PetscCall(PetscFree(list->node));
  PetscFunctionReturn(0);
}

/* Rows from sorted nodes; numbers are of nodes that have an unknown */
static PetscErrorCode InterfaceNumber(SubstructureInterface *interface, PetscInt n_nodes, const InterfaceNode node[])
{
  PetscInt n = 0, number = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(3 * n_nodes, &interface->row));
  for (PetscInt k = 0; k < n_nodes; k++) {
    const PetscInt before = n;

    for (int d = 0; d < 3; d++) {
      InterfaceRow *row = &interface->row[n];

      if (node[k].row[d] < 0 && !node[k].inside) interface->n_held++;
      if (node[k].row[d] < 0) continue;
      *row = (InterfaceRow){.node = number + 1, .direction = d, .row = node[k].row[d]};
      PetscCall(PetscArraycpy(row->x, node[k].x, 3));
      n++;
    }
    number += n > before;
    if (node[k].inside) continue;
    interface->n       = n;
    interface->n_nodes = number;
  }
  interface->n_kept = n - interface->n;
  PetscFunctionReturn(0);
}

/* E, with rows as the matrices of the parts have them */
static PetscErrorCode InterfaceCreateE(Substructure s)
{
  SubstructureInterface *interface = &s->interface;
  PetscInt               n         = 0, *i, *j;
  PetscScalar           *value;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(s->body.n_own, &i, s->body.n_own, &j, s->body.n_own, &value));
  for (PetscInt k = 0; k < interface->n + interface->n_kept; k++) {
    if (interface->row[k].row < s->body.first || interface->row[k].row >= s->body.first + s->body.n_own) continue;
    i[n]       = interface->row[k].row;
    j[n]       = k;
    value[n++] = 1;
  }
  PetscCall(MatCreate(s->comm, &interface->E));
  PetscCall(MatSetSizes(interface->E, s->body.n_own, PETSC_DECIDE, PETSC_DETERMINE, interface->n + interface->n_kept));
  PetscCall(MatSetType(interface->E, MATAIJ));
  PetscCall(MatSetPreallocationCOO(interface->E, n, i, j));
  PetscCall(MatSetValuesCOO(interface->E, value, INSERT_VALUES));
  PetscCall(PetscFree3(i, j, value));
  PetscFunctionReturn(0);
}

/* Raises the error for what is left out and acts on rows that are not of the interface */
static PetscErrorCode InterfaceCheckJoined(Substructure s, const PetscBool is_on[])
{
  PetscInt n[2] = {0, 0}, by = 0;
  char     names[512] = "";

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < s->body.n_own; k++) {
    n[0] += s->body.joined[k] && !is_on[k];
    if (!is_on[k]) by |= s->body.by[k];
    n[1] += s->body.pressed[k] && !is_on[k];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, n, 2, MPIU_INT, MPI_SUM, s->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &by, 1, MPIU_INT, MPI_BOR, s->comm));
  for (PetscInt j = 0; j < s->body.n_joints; j++) {
    if (!(by >> j & 1)) continue;
    PetscCall(OptionsTextAppend(names, names[0] ? ", " : "", sizeof(names)));
    PetscCall(OptionsTextAppend(names, s->body.joint[j], sizeof(names)));
  }
  PetscCheck(!n[0], s->comm, PETSC_ERR_USER_INPUT,
             "-superelement_parts: %s joins them to others at %" PetscInt_FMT
             " displacements that are in none of -superelement_sets: name the set of these nodes, or the others as "
             "parts too",
             names, n[0]);
  PetscCheck(!n[1], s->comm, PETSC_ERR_USER_INPUT,
             "-superelement_parts: contacts, which no superelement has, act on them at %" PetscInt_FMT
             " displacements that are in none of -superelement_sets: name their surfaces as sets, or leave out "
             "-contacts",
             n[1]);
  PetscFunctionReturn(0);
}

PetscErrorCode InterfaceCreate(Substructure s, PetscBool all)
{
  SubstructureInterface *interface = &s->interface;
  const Mesh            *mesh;
  InterfaceList          list;
  InterfaceNode         *node;
  PetscInt               n_nodes;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(s->model, &mesh));
  PetscCall(InterfaceListCreate(s, mesh, all, &list));
  PetscCall(InterfaceCheckJoined(s, list.is_on));
  PetscCall(GatherRecords(s->comm, list.n, sizeof(*node), list.node, &n_nodes, &node));
  if (n_nodes) qsort(node, (size_t)n_nodes, sizeof(*node), InterfaceNodeCompare);
  PetscCall(InterfaceNumber(interface, n_nodes, node));
  PetscCheck(interface->n, s->comm, PETSC_ERR_USER_INPUT,
             "-superelement_sets: supports hold all displacements of their nodes: nothing is left to be joined");
  PetscCall(PetscMalloc1(s->body.n_own, &interface->inside));
  for (PetscInt k = 0; k < s->body.n_own; k++)
    if (!list.is_on[k]) interface->inside[interface->n_inside++] = k;
  PetscCall(InterfaceCreateE(s));
  PetscCall(PetscFree(node));
  PetscCall(InterfaceListDestroy(&list));
  PetscFunctionReturn(0);
}

PetscErrorCode InterfaceTakeInside(Substructure s, Mat A, Mat *inside)
{
  PetscInt *row;
  IS        is;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->interface.n_inside, &row));
  for (PetscInt k = 0; k < s->interface.n_inside; k++) row[k] = s->body.first + s->interface.inside[k];
  PetscCall(ISCreateGeneral(s->comm, s->interface.n_inside, row, PETSC_OWN_POINTER, &is));
  PetscCall(MatCreateSubMatrix(A, is, is, MAT_INITIAL_MATRIX, inside));
  PetscCall(ISDestroy(&is));
  PetscFunctionReturn(0);
}

PetscErrorCode InterfaceScatter(Substructure s, Mat inside, PetscInt first, Mat all)
{
  const PetscScalar *from;
  PetscScalar       *to;
  PetscInt           n, from_lda, to_lda;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(inside, NULL, &n));
  PetscCall(MatDenseGetLDA(inside, &from_lda));
  PetscCall(MatDenseGetLDA(all, &to_lda));
  PetscCall(MatDenseGetArrayRead(inside, &from));
  PetscCall(MatDenseGetArray(all, &to));
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt k = 0; k < s->interface.n_inside; k++)
      to[(size_t)(first + j) * to_lda + s->interface.inside[k]] = from[(size_t)j * from_lda + k];
  PetscCall(MatDenseRestoreArray(all, &to));
  PetscCall(MatDenseRestoreArrayRead(inside, &from));
  PetscFunctionReturn(0);
}

PetscErrorCode InterfaceGather(Substructure s, Mat all, Mat inside)
{
  const PetscScalar *from;
  PetscScalar       *to;
  PetscInt           n, from_lda, to_lda;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(inside, NULL, &n));
  PetscCall(MatDenseGetLDA(all, &from_lda));
  PetscCall(MatDenseGetLDA(inside, &to_lda));
  PetscCall(MatDenseGetArrayRead(all, &from));
  PetscCall(MatDenseGetArray(inside, &to));
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt k = 0; k < s->interface.n_inside; k++)
      to[(size_t)j * to_lda + k] = from[(size_t)j * from_lda + s->interface.inside[k]];
  PetscCall(MatDenseRestoreArray(inside, &to));
  PetscCall(MatDenseRestoreArrayRead(all, &from));
  PetscFunctionReturn(0);
}

PetscErrorCode InterfaceDestroy(SubstructureInterface *interface)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(interface->row));
  PetscCall(PetscFree(interface->inside));
  PetscCall(MatDestroy(&interface->E));
  PetscFunctionReturn(0);
}
