/*
   What holds the bodies. Two bodies hang together by ties, contacts, bushings and points that have nodes of both; a
   body is held by supports, motions, springs, dashpots, and by bushings and points that stand on the ground. Bodies
   that hang together with no other ones and on nothing are said, and nodes in one place that nothing joins (touch.c).
   A scene that is free as a whole is none of these.

   The pieces are the connected components of a graph with a node per body and one more, n, for the ground, kept as a
   forest (parent[]; union of roots). Every rank has the whole graph: what a rank sees of a set is marked in has[],
   the marks are reduced over all ranks, and then each rank joins the same bodies in the same order. Notes are no
   errors: a free body is meant in a scene of impact or of free modes.
*/
#include "bodiesimpl.h"
#include "base/text.h"

/* of a kind: a mesh of a thousand loose pieces is one fault, not a thousand lines */
#define MAX_LINES 4

static PetscInt RootOf(const PetscInt parent[], PetscInt b)
{
  while (parent[b] != b) b = parent[b];
  return b;
}

/* Marks the bodies of a set's nodes in has[] */
static PetscErrorCode SetMark(BodyGraph *b, const char set[])
{
  PetscInt n, *node;

  PetscFunctionBeginUser;
  if (!set || !set[0]) PetscFunctionReturn(0);
  PetscCall(ModelGetSetNodes(b->contact->model, set, &n, &node));
  for (PetscInt i = 0; i < n; i++)
    if (b->body[node[i]] >= 0) b->has[b->body[node[i]]] = 1;
  PetscCall(PetscFree(node));
  PetscFunctionReturn(0);
}

/* The bodies that are marked on any rank hang together (each with the one marked before), or each on the ground;
   clears the marks. Collective. */
static PetscErrorCode MarkedJoin(BodyGraph *b, PetscBool ground)
{
  PetscMPIInt count;
  PetscInt    last = ground ? b->n : -1;

  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(b->n, &count));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, b->has, count, MPIU_INT, MPI_MAX, b->contact->comm));
  for (PetscInt i = 0; i < b->n; i++) {
    if (!b->has[i]) continue;
    if (last >= 0) b->parent[RootOf(b->parent, i)] = RootOf(b->parent, last);
    last = i;
  }
  PetscCall(PetscArrayzero(b->has, b->n));
  PetscFunctionReturn(0);
}

/* What one set, or two, join */
static PetscErrorCode SetsJoin(BodyGraph *b, const char one[], const char other[], PetscBool ground)
{
  PetscFunctionBeginUser;
  PetscCall(SetMark(b, one));
  PetscCall(SetMark(b, other));
  PetscCall(MarkedJoin(b, ground));
  PetscFunctionReturn(0);
}

/* Whether a point has a stiffness or viscosity to the ground */
static PetscBool PointStands(const Joint *point)
{
  for (int d = 0; d < 6; d++)
    if (point->stiffness[d] != 0 || point->viscosity[d] != 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The body of each node of a master surface, [n_nodes], on every rank */
static PetscErrorCode SurfaceBodies(const BodyGraph *b, const ContactSurface *s, PetscInt **of)
{
  PetscMPIInt count;

  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(s->n_nodes, &count));
  PetscCall(PetscMalloc1(s->n_nodes, of));
  for (PetscInt i = 0; i < s->n_nodes; i++) (*of)[i] = -1;
  for (PetscInt v = 0; v < b->mesh->n_nodes; v++) {
    PetscInt at;

    PetscCall(PetscFindInt(b->mesh->number[v], s->n_nodes, s->vertex, &at));
    if (at >= 0) (*of)[at] = b->body[v];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, *of, count, MPIU_INT, MPI_MAX, b->contact->comm));
  PetscFunctionReturn(0);
}

/* Marks the bodies on which the pairs of an interface have a foot, of slaves of one body, and that one;
   slave[n_pairs] has the body of each pair's slave. An interface of several bodies, such as two pads on a disc, joins
   only those that face. */
static PetscErrorCode PairsMark(BodyGraph *b, PetscInt interface, const PetscInt slave[], PetscInt body,
                                const ContactSurface *s, const PetscInt of[])
{
  const Contact c = b->contact;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < c->n_pairs; p++) {
    const ContactPair *pair = &c->pairs[p];

    if (pair->interface != interface || slave[p] != body) continue;
    b->has[body] = 1;
    for (PetscInt i = 0; i < pair->n_master; i++) {
      PetscInt at;

      PetscCall(PetscFindInt(pair->master[i].number, s->n_nodes, s->vertex, &at));
      if (at >= 0 && of[at] >= 0) b->has[of[at]] = 1;
    }
  }
  PetscFunctionReturn(0);
}

/* What the pairs of a contact join: the body of a slave and those under it, of slaves that have pairs alone;
   slave[n_pairs] */
static PetscErrorCode PairsJoin(BodyGraph *b, PetscInt interface, const PetscInt slave[])
{
  const ContactSurface *s;
  PetscInt             *of, *rubs;
  PetscMPIInt           count;

  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(b->n, &count));
  PetscCall(ContactGetSurface(b->contact, interface, &s));
  PetscCall(SurfaceBodies(b, s, &of));
  PetscCall(PetscCalloc1(b->n, &rubs));
  for (PetscInt p = 0; p < b->contact->n_pairs; p++)
    if (b->contact->pairs[p].interface == interface) rubs[slave[p]] = 1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, rubs, count, MPIU_INT, MPI_MAX, b->contact->comm));
  for (PetscInt i = 0; i < b->n; i++) {
    if (!rubs[i]) continue;
    PetscCall(PairsMark(b, interface, slave, i, s, of));
    PetscCall(MarkedJoin(b, PETSC_FALSE));
  }
  PetscCall(PetscFree(rubs));
  PetscCall(PetscFree(of));
  PetscFunctionReturn(0);
}

/* What contacts join */
static PetscErrorCode ContactsJoin(BodyGraph *b)
{
  const Contact c = b->contact;
  PetscInt     *slave, *number, *node;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(c->n_pairs, &slave, b->mesh->n_nodes, &number, b->mesh->n_nodes, &node));
  for (PetscInt v = 0; v < b->mesh->n_nodes; v++) {
    number[v] = b->mesh->number[v];
    node[v]   = v;
  }
  PetscCall(PetscSortIntWithArray(b->mesh->n_nodes, number, node));
  for (PetscInt p = 0; p < c->n_pairs; p++) {
    PetscInt at;

    PetscCall(PetscFindInt(c->pairs[p].vertex, b->mesh->n_nodes, number, &at));
    slave[p] = b->body[node[at]];
  }
  for (PetscInt i = 0; i < c->n_interfaces; i++) PetscCall(PairsJoin(b, i, slave));
  PetscCall(PetscFree3(slave, number, node));
  PetscFunctionReturn(0);
}

/* What joins bodies: bushings, points, ties by the nodes that follow, contacts by their pairs. together[] is kept
   before the ground is joined, since two bodies that both stand on the ground do not hang together (touch.c). */
static PetscErrorCode GraphJoin(BodyGraph *b)
{
  const Contact     c = b->contact;
  const ModelScene *s;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(c->model, &s));
  for (PetscInt i = 0; i < s->n_joints; i++)
    PetscCall(SetsJoin(b, s->joints[i].set[0], s->joints[i].set[1], PETSC_FALSE));
  for (PetscInt i = 0; i < s->n_points; i++) PetscCall(SetsJoin(b, s->points[i].set[0], NULL, PETSC_FALSE));
  for (PetscInt t = 0; t < c->n_ties; t++) {
    for (PetscInt i = 0; i < c->n_links; i++)
      if (c->links[i].tie == t) b->has[b->body[c->links[i].node]] = 1;
    PetscCall(SetsJoin(b, c->ties[t].master, NULL, PETSC_FALSE));
  }
  PetscCall(ContactsJoin(b));
  for (PetscInt i = 0; i < b->n; i++) b->together[i] = RootOf(b->parent, i);
  PetscFunctionReturn(0);
}

/* What holds bodies on the ground */
static PetscErrorCode GraphHold(BodyGraph *b)
{
  const ModelScene *s;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(b->contact->model, &s));
  for (PetscInt i = 0; i < 3 * b->mesh->n_nodes; i++)
    if (b->mesh->unknown[i] < 0 && b->body[i / 3] >= 0) b->has[b->body[i / 3]] = 1;
  PetscCall(MarkedJoin(b, PETSC_TRUE));
  for (PetscInt i = 0; i < s->n_motions; i++) PetscCall(SetsJoin(b, s->motions[i].set, NULL, PETSC_TRUE));
  for (PetscInt i = 0; i < s->n_springs; i++) PetscCall(SetsJoin(b, s->springs[i].set, NULL, PETSC_TRUE));
  for (PetscInt i = 0; i < s->n_dashpots; i++) PetscCall(SetsJoin(b, s->dashpots[i].set, NULL, PETSC_TRUE));
  for (PetscInt i = 0; i < s->n_joints; i++)
    if (!s->joints[i].set[1] || !s->joints[i].set[1][0]) PetscCall(SetsJoin(b, s->joints[i].set[0], NULL, PETSC_TRUE));
  for (PetscInt i = 0; i < s->n_points; i++)
    if (PointStands(&s->points[i])) PetscCall(SetsJoin(b, s->points[i].set[0], NULL, PETSC_TRUE));
  PetscFunctionReturn(0);
}

/* Names the bodies of the piece that hangs together with body `first`; how many they are */
static PetscErrorCode PieceName(const BodyGraph *b, PetscInt first, size_t size, char text[], PetscInt *n)
{
  PetscFunctionBeginUser;
  *n      = 0;
  text[0] = '\0';
  for (PetscInt i = first; i < b->n; i++) {
    char name[256];

    if (RootOf(b->parent, i) != RootOf(b->parent, first)) continue;
    PetscCall(ModelNameBody(b->contact->model, b->body, i, sizeof(name), name));
    PetscCall(WordsAdd(text, *n ? ", " : "", size));
    PetscCall(WordsAdd(text, name, size));
    ++*n;
  }
  PetscFunctionReturn(0);
}

/* "; 35 of its nodes lie on nodes of part a, which it does not share": where the piece lies on others */
static PetscErrorCode PieceNameTouched(const BodyGraph *b, PetscInt first, PetscInt n_bodies, size_t size, char text[])
{
  const PetscInt root       = RootOf(b->parent, first);
  PetscInt       n          = 0;
  char           names[512] = "";

  PetscFunctionBeginUser;
  text[0] = '\0';
  for (PetscInt i = 0; i < b->n_touches; i++) {
    const BodyTouch *t    = &b->touch[i];
    const PetscBool  in_a = RootOf(b->parent, t->a) == root, in_b = RootOf(b->parent, t->b) == root;
    char             name[256];

    if (in_a == in_b) continue;
    PetscCall(ModelNameBody(b->contact->model, b->body, in_a ? t->b : t->a, sizeof(name), name));
    PetscCall(WordsAdd(names, n ? ", " : "", sizeof(names)));
    PetscCall(WordsAdd(names, name, sizeof(names)));
    n += t->n;
  }
  if (n)
    PetscCall(PetscSNPrintf(text, size,
                            "; %" PetscInt_FMT
                            " of %s nodes lie on nodes of %s and are not shared: merge them in the mesh, or "
                            "join the bodies by -ties",
                            n, n_bodies > 1 ? "their" : "its", names));
  PetscFunctionReturn(0);
}

/* Whether a body is the first of a piece that hangs on nothing, where there is another piece */
static PetscBool PieceIsLoose(const BodyGraph *b, PetscInt first)
{
  const PetscInt root   = RootOf(b->parent, first);
  PetscBool      others = PETSC_FALSE;

  if (root == RootOf(b->parent, b->n)) return PETSC_FALSE;
  for (PetscInt i = 0; i < b->n; i++) {
    if (RootOf(b->parent, i) != root) others = PETSC_TRUE;
    if (RootOf(b->parent, i) == root && i < first) return PETSC_FALSE;
  }
  return others;
}

static PetscErrorCode SayLoose(const BodyGraph *b)
{
  const MPI_Comm comm = b->contact->comm;
  PetscInt       n    = 0, n_bodies;
  char           names[512], touched[768];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < b->n; i++) {
    if (!PieceIsLoose(b, i) || n++ >= MAX_LINES) continue;
    PetscCall(PieceName(b, i, sizeof(names), names, &n_bodies));
    PetscCall(PieceNameTouched(b, i, n_bodies, sizeof(touched), touched));
    PetscCall(PetscPrintf(comm, "note: %s %s: 6 rigid motions%s\n", names,
                          n_bodies > 1 ? "hang together with no other body, and are held by nothing"
                                       : "hangs together with no other body, and is held by nothing",
                          touched));
  }
  if (n > MAX_LINES)
    PetscCall(PetscPrintf(comm, "note: %" PetscInt_FMT " more bodies are held by nothing\n", n - MAX_LINES));
  PetscFunctionReturn(0);
}

/* Nodes in one place of bodies that are held or hang together by something else */
static PetscErrorCode SayTouches(const BodyGraph *b)
{
  PetscInt n = 0, n_nodes = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < b->n_touches; i++) {
    const PetscInt   ground = RootOf(b->parent, b->n);
    const BodyTouch *t      = &b->touch[i];
    char             name[2][256];

    if (RootOf(b->parent, t->a) != RootOf(b->parent, t->b) &&
        (RootOf(b->parent, t->a) != ground || RootOf(b->parent, t->b) != ground))
      continue; /* one of them is loose, which is said */
    if (n++ >= MAX_LINES) {
      n_nodes += t->n;
      continue;
    }
    PetscCall(ModelNameBody(b->contact->model, b->body, t->a, sizeof(name[0]), name[0]));
    PetscCall(ModelNameBody(b->contact->model, b->body, t->b, sizeof(name[1]), name[1]));
    PetscCall(PetscPrintf(b->contact->comm,
                          "note: %" PetscInt_FMT " nodes of %s lie on nodes of %s and are not shared: nothing "
                          "joins the bodies there; merge them in the mesh, or give -ties or -contacts\n",
                          t->n, name[0], name[1]));
  }
  if (n > MAX_LINES)
    PetscCall(PetscPrintf(b->contact->comm,
                          "note: so do %" PetscInt_FMT " more nodes of %" PetscInt_FMT " more pairs of bodies\n",
                          n_nodes, n - MAX_LINES));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactCheckBodies(Contact contact, PetscBool terms)
{
  BodyGraph         b = {.contact = contact};
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(contact->model, &scene));
  if (terms || scene->equations[0]) PetscFunctionReturn(0); /* which may join anything */
  PetscCall(ModelGetMesh(contact->model, &b.mesh));
  PetscCall(ModelGetBodies(contact->model, &b.n, &b.body));
  if (b.n > 1) {
    PetscCall(PetscCalloc3(b.n + 1, &b.parent, b.n, &b.has, b.n, &b.together));
    for (PetscInt i = 0; i <= b.n; i++) b.parent[i] = i;
    PetscCall(GraphJoin(&b));
    PetscCall(GraphHold(&b));
    PetscCall(GraphFindTouches(&b));
    PetscCall(SayLoose(&b));
    PetscCall(SayTouches(&b));
    PetscCall(PetscFree(b.touch));
    PetscCall(PetscFree3(b.parent, b.has, b.together));
  }
  PetscCall(PetscFree(b.body));
  PetscFunctionReturn(0);
}
