/*
   Contacts on the mesh as it is, for ParaView: check.h5 and check.xmf. At each node

      slave   number of the contact of whose slave surface it is, from 1; negative where it has no pair, 0 elsewhere
      master  the same of master surfaces
      gap_m   n . (x_s - x_m) of its pair, m, positive open; 0 where it has none

   On a node of several contacts the last one counts.
*/
#include "contactimpl.h"
#include <squeal/results.h>

typedef struct {
  PetscReal *slave, *master, *gap; /* [local nodes] */
} CheckedNodes;

static PetscErrorCode CheckedMark(Model model, const char set[], PetscReal number, PetscReal mark[])
{
  PetscInt n, *node;

  PetscFunctionBeginUser;
  PetscCall(ModelGetSetNodes(model, set, &n, &node));
  for (PetscInt i = 0; i < n; i++) mark[node[i]] = number;
  PetscCall(PetscFree(node));
  PetscFunctionReturn(0);
}

/* Pairs live where their slave is owned: only there are signs and gaps right, and only from there are they written */
static PetscErrorCode NodesSetPairs(Contact contact, const Mesh *mesh, CheckedNodes *nodes)
{
  PetscInt *local, first = PETSC_MAX_INT, last = -1; /* of the numbers that this rank owns */

  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < mesh->n_nodes; v++) {
    if (!mesh->owned[v]) continue;
    first = PetscMin(first, mesh->number[v]);
    last  = PetscMax(last, mesh->number[v]);
  }
  PetscCall(PetscMalloc1(last < 0 ? 0 : last - first + 1, &local));
  for (PetscInt v = 0; v < mesh->n_nodes; v++)
    if (mesh->owned[v]) local[mesh->number[v] - first] = v;
  for (PetscInt p = 0; p < contact->n_pairs; p++) {
    const ContactPair *pair = &contact->pairs[p];
    const PetscInt     node = local[pair->vertex - first];

    nodes->slave[node] = 1 + pair->interface;
    nodes->gap[node]   = pair->gap;
  }
  PetscCall(PetscFree(local));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactWrite(Contact contact, Results results)
{
  const Mesh  *mesh;
  CheckedNodes nodes;
  ResultsField field;
  PetscBool    wanted;

  PetscFunctionBeginUser;
  PetscCall(ResultsWantFields(results, &wanted));
  if (!wanted) PetscFunctionReturn(0);
  PetscCall(ModelGetMesh(contact->model, &mesh));
  PetscCall(PetscCalloc3(mesh->n_nodes, &nodes.slave, mesh->n_nodes, &nodes.master, mesh->n_nodes, &nodes.gap));
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    PetscCall(CheckedMark(contact->model, contact->interfaces[i].slave, -(PetscReal)(1 + i), nodes.slave));
    PetscCall(CheckedMark(contact->model, contact->interfaces[i].master, (PetscReal)(1 + i), nodes.master));
  }
  PetscCall(NodesSetPairs(contact, mesh, &nodes));
  PetscCall(ResultsFieldOpen(results, "check", mesh, &field));
  PetscCall(ResultsFieldWriteNodal(
    field, "contacts of the mesh", 3,
    (const ResultsNodal[]){{"slave", 1, nodes.slave}, {"master", 1, nodes.master}, {"gap_m", 1, nodes.gap}}));
  PetscCall(ResultsFieldClose(&field));
  PetscCall(PetscFree3(nodes.slave, nodes.master, nodes.gap));
  PetscFunctionReturn(0);
}
