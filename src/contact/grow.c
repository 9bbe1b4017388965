/*
   Growing of the closed part of an interface by rows of nodes. Every rank knows the whole slave surface and the
   status of all its nodes, and moves the front alike, so that the ranks that share a surface do not matter.

   With statuses s_v (closed, open, without pair) and facets f as sets of nodes, one row is
      s_v := closed   where s_v is open and some facet f holds v and a closed node        (rows > 0)
      s_v := open     where s_v is closed and some facet f holds v and an open node       (rows < 0)
   all read before any is written. Nodes without pair neither change nor move the front.
*/
#include "contactimpl.h"

/* Status of a node of the slave surface; without pair where a rank has found none */
typedef enum { NODE_WITHOUT_PAIR, NODE_OPEN, NODE_CLOSED } NodeStatus;

/* One row: nodes with status turn[0] that share a facet with one of turn[1] get that one; before[n_nodes] is work */
static PetscErrorCode FrontMove(const ContactSurface *s, const NodeStatus turn[2], PetscInt before[], PetscInt status[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(before, status, s->n_nodes));
  for (PetscInt f = 0; f < s->n_facets; f++) {
    const PetscInt *node = s->facet[f].node, n = s->facet[f].n;
    PetscBool       touches = PETSC_FALSE;

    for (int i = 0; i < n; i++)
      if (before[node[i]] == (PetscInt)turn[1]) touches = PETSC_TRUE;
    for (int i = 0; i < n && touches; i++)
      if (before[node[i]] == (PetscInt)turn[0]) status[node[i]] = turn[1];
  }
  PetscFunctionReturn(0);
}

/* Moves the front of one interface; pairs of others have no node of its slave surface, -1 */
static PetscErrorCode InterfaceGrow(Contact contact, PetscInt interface, PetscInt rows, PetscBool closed[])
{
  const NodeStatus turn[] = {rows > 0 ? NODE_OPEN : NODE_CLOSED, rows > 0 ? NODE_CLOSED : NODE_OPEN};
  PetscInt        *node, *status, *before;
  ContactSurface   s = {0};

  PetscFunctionBeginUser;
  PetscCall(ContactSurfaceCreate(contact, contact->interfaces[interface].slave, &s));
  PetscCall(PetscCalloc3(contact->n_pairs, &node, s.n_nodes, &status, s.n_nodes, &before));
  for (PetscInt p = 0; p < contact->n_pairs; p++) {
    node[p] = -1;
    if (contact->pairs[p].interface != interface) continue;
    PetscCall(PetscFindInt(contact->pairs[p].vertex, s.n_nodes, s.vertex, &node[p]));
    PetscCheck(node[p] >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a pair's slave node is no node of the slave surface");
    status[node[p]] = closed[p] ? NODE_CLOSED : NODE_OPEN;
  }
  /* one rank alone has the pair of a node, the others have NODE_WITHOUT_PAIR, the least of the three */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, status, (PetscMPIInt)s.n_nodes, MPIU_INT, MPI_MAX, contact->comm));
  for (PetscInt k = 0; k < PetscAbsInt(rows); k++) PetscCall(FrontMove(&s, turn, before, status));
  for (PetscInt p = 0; p < contact->n_pairs; p++)
    if (node[p] >= 0) closed[p] = status[node[p]] == NODE_CLOSED ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(PetscFree3(node, status, before));
  PetscCall(ContactSurfaceDestroy(&s));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactGrow(Contact contact, PetscInt rows, PetscBool closed[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < contact->n_interfaces && rows; i++) PetscCall(InterfaceGrow(contact, i, rows, closed));
  PetscFunctionReturn(0);
}
