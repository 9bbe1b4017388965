/*
   Nodes that two bodies have in one place without sharing them, where no tie, contact or bushing joins both: often
   those that a mesher should have made one.

   They are found by their places along a direction askew to all meshes, key = x + 0.618 y + 0.755 z (m), in which
   planes of a regular mesh do not fall on one value: each node within the box of another body goes to the rank of its
   interval there, where those beside each other are compared. One near an end of its interval goes to the next as
   well. Two nodes within tol in each direction differ by less than 2.4 tol in key, hence the 3 tol of the window and
   of the ends. The cost is n log n for n candidates, and no rank has all of them.
*/
#include "bodiesimpl.h"
#include "base/gather.h"
#include <stdlib.h>

/* of the size of the mesh: above what mesh files round places to (six or seven figures), far below an element */
#define SAME_PLACE 1e-6
#define MASK_WORDS 3 /* of 64 joints each: contacts, ties, bushings */

/* A node of a body within the box of another one */
typedef struct {
  PetscReal x[3], key; /* m */
  PetscInt  body;
  PetscBool copy;                /* of one that another rank has */
  uint64_t  side[2][MASK_WORDS]; /* on which sides of which joints it is */
} BodyNode;

/* Ends of the boxes of all bodies (ModelMeasureBodies()), and the size of all, m */
static PetscErrorCode BoxesMeasure(const BodyGraph *b, PetscReal box[], PetscReal *size)
{
  PetscReal all[6];

  PetscFunctionBeginUser;
  PetscCall(ModelMeasureBodies(b->contact->model, b->body, 0, b->n, box));
  for (int d = 0; d < 6; d++) all[d] = -PETSC_MAX_REAL;
  for (PetscInt i = 0; i < 6 * b->n; i++) all[i % 6] = PetscMax(all[i % 6], box[i]);
  for (int d = 0; d < 3; d++) *size = PetscMax(*size, all[d] + all[d + 3]);
  PetscFunctionReturn(0);
}

/* Whether a place is in the box of another body */
static PetscBool InOtherBox(const BodyGraph *b, const PetscReal box[], PetscReal tol, PetscInt body,
                            const PetscReal x[3])
{
  for (PetscInt i = 0; i < b->n; i++) {
    PetscBool in = i == body ? PETSC_FALSE : PETSC_TRUE;

    for (int d = 0; d < 3 && in; d++)
      in = x[d] <= box[6 * i + d] + tol && -x[d] <= box[6 * i + 3 + d] + tol ? PETSC_TRUE : PETSC_FALSE;
    if (in) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Sets the bit of a joint (joints beyond the room of the mask share the last one: a note may then be missing, but none
   is wrong) at the candidates of a set; at[local nodes] is -1 for no candidate */
static PetscErrorCode SideMark(const BodyGraph *b, const char set[], int side, PetscInt joint, const PetscInt at[],
                               BodyNode node[])
{
  const PetscInt bit = PetscMin(joint, 64 * MASK_WORDS - 1);
  PetscInt       n, *of;

  PetscFunctionBeginUser;
  if (!set || !set[0]) PetscFunctionReturn(0);
  PetscCall(ModelGetSetNodes(b->contact->model, set, &n, &of));
  for (PetscInt i = 0; i < n; i++)
    if (at[of[i]] >= 0) node[at[of[i]]].side[side][bit / 64] |= (uint64_t)1 << (bit % 64);
  PetscCall(PetscFree(of));
  PetscFunctionReturn(0);
}

/* All joints of two sides */
static PetscErrorCode SidesMark(const BodyGraph *b, const PetscInt at[], BodyNode node[])
{
  const Contact     c = b->contact;
  const ModelScene *s;
  PetscInt          k = 0;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(c->model, &s));
  for (PetscInt i = 0; i < c->n_interfaces; i++, k++) {
    PetscCall(SideMark(b, c->interfaces[i].slave, 0, k, at, node));
    PetscCall(SideMark(b, c->interfaces[i].master, 1, k, at, node));
  }
  for (PetscInt i = 0; i < c->n_ties; i++, k++) {
    PetscCall(SideMark(b, c->ties[i].slave, 0, k, at, node));
    PetscCall(SideMark(b, c->ties[i].master, 1, k, at, node));
  }
  for (PetscInt i = 0; i < s->n_joints; i++, k++)
    for (int side = 0; side < 2; side++) PetscCall(SideMark(b, s->joints[i].set[side], side, k, at, node));
  PetscFunctionReturn(0);
}

/* Nodes of this rank that may be where those of another body are; room for three of each, since some go to other ranks
   too */
static PetscErrorCode BodyNodesFind(const BodyGraph *b, const PetscReal box[], PetscReal tol, PetscInt *n,
                                    BodyNode **node)
{
  const Mesh *mesh = b->mesh;
  PetscInt   *at;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_nodes, &at));
  *n = 0;
  for (PetscInt v = 0; v < mesh->n_nodes; v++) {
    at[v] = mesh->owned[v] && b->body[v] >= 0 && InOtherBox(b, box, tol, b->body[v], &mesh->x[3 * v]) ? *n : -1;
    *n += at[v] >= 0;
  }
  PetscCall(PetscCalloc1(3 * *n, node));
  for (PetscInt v = 0; v < mesh->n_nodes; v++) {
    BodyNode *to = at[v] < 0 ? NULL : &(*node)[at[v]];

    if (!to) continue;
    to->body = b->body[v];
    for (int d = 0; d < 3; d++) to->x[d] = mesh->x[3 * v + d];
    /* 1 / golden ratio and 1 / plastic number: no small integers k, l, m make k + 0.618 l + 0.755 m = 0 */
    to->key = to->x[0] + 0.6180339887498949 * to->x[1] + 0.7548776662466927 * to->x[2];
  }
  PetscCall(SidesMark(b, at, *node));
  PetscCall(PetscFree(at));
  PetscFunctionReturn(0);
}

/* Sends the candidates to the ranks of their intervals, which are of equal length, never below 3 tol: a node is near
   one end of its interval alone */
static PetscErrorCode BodyNodesSend(MPI_Comm comm, PetscReal tol, PetscInt *n, BodyNode **node)
{
  PetscReal   end[2] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL};
  PetscMPIInt size, *rank;
  PetscInt    n_all = *n;
  BodyNode   *all   = *node;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  for (PetscInt i = 0; i < *n; i++) {
    end[0] = PetscMax(end[0], all[i].key);
    end[1] = PetscMax(end[1], -all[i].key);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, end, 2, MPIU_REAL, MPI_MAX, comm));
  PetscCall(PetscMalloc1(3 * *n, &rank));
  for (PetscInt i = 0; i < *n; i++) {
    const PetscReal width = (end[0] + end[1]) / size + 3 * tol, place = all[i].key + end[1];

    rank[i] = (PetscMPIInt)PetscMin(size - 1, place / width);
    for (int side = -1; side < 2; side += 2) {
      const PetscReal beside = (place + side * tol) / width;

      if (beside < 0 || beside >= size || (PetscMPIInt)beside == rank[i]) continue;
      all[n_all]      = all[i];
      all[n_all].copy = PETSC_TRUE;
      rank[n_all++]   = (PetscMPIInt)beside;
    }
  }
  PetscCall(ExchangeRecords(comm, &n_all, sizeof(BodyNode), &all, rank, node));
  *n = n_all;
  PetscCall(PetscFree(rank));
  PetscFunctionReturn(0);
}

static int KeyCompare(const void *left, const void *right)
{
  const PetscReal a = ((const BodyNode *)left)->key, b = ((const BodyNode *)right)->key;

  return (a > b) - (a < b);
}

static int TouchCompare(const void *left, const void *right)
{
  const BodyTouch *x = (const BodyTouch *)left, *y = (const BodyTouch *)right;

  return x->a != y->a ? (x->a > y->a) - (x->a < y->a) : (x->b > y->b) - (x->b < y->b);
}

/* Adds those of the same two bodies */
static void TouchesSum(PetscInt *n, BodyTouch touch[])
{
  PetscInt last = -1;

  if (*n) qsort(touch, (size_t)*n, sizeof(BodyTouch), TouchCompare);
  for (PetscInt i = 0; i < *n; i++) {
    if (last >= 0 && !TouchCompare(&touch[last], &touch[i]))
      touch[last].n += touch[i].n;
    else
      touch[++last] = touch[i];
  }
  *n = last + 1;
}

/* Whether a node is on a side of any joint */
static PetscBool NodeIsJoined(const BodyNode *p)
{
  for (int k = 0; k < MASK_WORDS; k++)
    if (p->side[0][k] || p->side[1][k]) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Whether two nodes are in one place, of two bodies, and nothing joins them: no joint has one on each side, nor do
   joints of both nodes hold the bodies together by way of others */
static PetscBool NodesTouch(const BodyGraph *b, const BodyNode *p, const BodyNode *q, PetscReal tol)
{
  if (p->body == q->body) return PETSC_FALSE;
  for (int d = 0; d < 3; d++)
    if (PetscAbsReal(p->x[d] - q->x[d]) > tol) return PETSC_FALSE;
  for (int k = 0; k < MASK_WORDS; k++)
    if ((p->side[0][k] & q->side[1][k]) || (p->side[1][k] & q->side[0][k])) return PETSC_FALSE;
  return b->together[p->body] == b->together[q->body] && NodeIsJoined(p) && NodeIsJoined(q) ? PETSC_FALSE : PETSC_TRUE;
}

/* Compares those of this rank that are beside each other. Of each two the one of the larger key is no copy: a pair
   that two ranks see is counted by the rank whose interval holds the larger key. */
static PetscErrorCode TouchesCount(const BodyGraph *b, PetscReal tol, PetscInt n, BodyNode node[], PetscInt *n_touches,
                                   BodyTouch **touch)
{
  PetscInt room = 0;

  PetscFunctionBeginUser;
  *n_touches = 0;
  *touch     = NULL;
  if (n) qsort(node, (size_t)n, sizeof(BodyNode), KeyCompare);
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = j - 1; i >= 0 && node[j].key - node[i].key <= 3 * tol && !node[j].copy; i--) {
      if (!NodesTouch(b, &node[i], &node[j], tol)) continue;
      if (*n_touches == room) {
        room = 2 * room + 64;
        PetscCall(PetscRealloc(sizeof(BodyTouch) * (size_t)room, touch));
      }
      (*touch)[(*n_touches)++] =
        (BodyTouch){PetscMin(node[i].body, node[j].body), PetscMax(node[i].body, node[j].body), 1};
    }
  TouchesSum(n_touches, *touch);
  PetscFunctionReturn(0);
}

PetscErrorCode GraphFindTouches(BodyGraph *b)
{
  const MPI_Comm comm = b->contact->comm;
  PetscReal     *box, tol = 0;
  BodyNode      *node;
  BodyTouch     *local;
  PetscInt       n, n_local;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(6 * b->n, &box));
  PetscCall(BoxesMeasure(b, box, &tol));
  tol *= SAME_PLACE;
  PetscCall(BodyNodesFind(b, box, tol, &n, &node));
  PetscCall(BodyNodesSend(comm, 3 * tol, &n, &node));
  PetscCall(TouchesCount(b, tol, n, node, &n_local, &local));
  PetscCall(GatherRecords(comm, n_local, sizeof(BodyTouch), local, &b->n_touches, &b->touch));
  TouchesSum(&b->n_touches, b->touch);
  PetscCall(PetscFree(local));
  PetscCall(PetscFree(node));
  PetscCall(PetscFree(box));
  PetscFunctionReturn(0);
}
