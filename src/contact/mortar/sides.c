/* The sides of mortar pairs, of the sums over facets (mortar.c) */
#include "mortarimpl.h"
#include <stdlib.h>

/* a weight that is rounding of integrals */
#define SIDES_ROUNDING 1e-15

PetscErrorCode MortarEntryAdd(MortarEntries *list, PetscInt pair, PetscInt number, const PetscInt unknown[3],
                              PetscReal weight)
{
  PetscFunctionBeginUser;
  if (list->n == list->room) {
    list->room = 2 * list->room + 256;
    PetscCall(PetscRealloc(sizeof(MortarEntry) * (size_t)list->room, &list->entry));
  }
  list->entry[list->n] = (MortarEntry){pair, list->n, {number, {unknown[0], unknown[1], unknown[2]}, weight}};
  list->n++;
  PetscFunctionReturn(0);
}

PetscErrorCode MortarMasterAdd(MortarPairs *m, PetscInt p, const ContactFacet *master, int l, PetscReal weight)
{
  PetscFunctionBeginUser;
  PetscCall(MortarEntryAdd(&m->under, p, m->mortar.master->vertex[master->node[l]], master->unknowns[l], weight));
  for (int d = 0; d < 3; d++) m->off[p][d] += weight * (master->x[l][d] - m->pair[p].x[d]);
  PetscFunctionReturn(0);
}

static int EntryCompare(const void *left, const void *right)
{
  const MortarEntry *a = (const MortarEntry *)left, *b = (const MortarEntry *)right;

  if (a->pair != b->pair) return a->pair < b->pair ? -1 : 1;
  if (a->node.number != b->node.number) return a->node.number < b->node.number ? -1 : 1;
  return (a->order > b->order) - (a->order < b->order);
}

/* Entries of one pair and node become one, in place; first[p] is where those of pair p begin, [n_pairs + 1] */
static void EntriesMerge(MortarEntries *list, PetscInt n_pairs, PetscInt first[])
{
  PetscInt n = 0, p = 0;

  if (list->n) qsort(list->entry, (size_t)list->n, sizeof(MortarEntry), EntryCompare);
  for (PetscInt i = 0; i < list->n; i++) {
    const MortarEntry *e = &list->entry[i];

    if (n && list->entry[n - 1].pair == e->pair && list->entry[n - 1].node.number == e->node.number) {
      list->entry[n - 1].node.weight += e->node.weight;
      continue;
    }
    while (p <= e->pair) first[p++] = n;
    list->entry[n++] = *e;
  }
  while (p <= n_pairs) first[p++] = n;
  list->n = n;
}

/* A facet of the slave around a node, which is its j */
static const ContactFacet *NodeFacet(const MortarPairs *m, PetscInt node, int *j)
{
  const PetscInt at = m->border.around[m->border.first[node]];

  *j = (int)(at % FACET_NODES);
  return &m->mortar.slave->facet[at / FACET_NODES];
}

/* u~ of a node as sum_i v_i u_k(i) over n nodes of a facet, itself first; the facet */
static const ContactFacet *MeanTerms(const MortarPairs *m, PetscInt node, int *n, int k[FACET_NODES],
                                     PetscReal v[FACET_NODES])
{
  int                 j;
  const ContactFacet *s = NodeFacet(m, node, &j);
  PetscReal           all[FACET_NODES];

  SegmentValue(s->n, m->mortar.alpha, j, all);
  *n = 0;
  for (int i = 0; i < s->n; i++) { /* the node itself, then the others */
    const int l = i == 0 ? j : i <= j ? i - 1 : i;

    if (all[l] != 0) k[*n] = l, v[(*n)++] = all[l];
  }
  return s;
}

int MortarMean(const MortarPairs *m, PetscInt node, ContactPairNode mean[FACET_NODES])
{
  int                 n, k[FACET_NODES];
  PetscReal           v[FACET_NODES];
  const ContactFacet *s = MeanTerms(m, node, &n, k, v);

  for (int i = 0; i < n; i++) {
    const PetscInt *u = s->unknowns[k[i]];

    mean[i] = (ContactPairNode){m->mortar.slave->vertex[s->node[k[i]]], {u[0], u[1], u[2]}, v[i]};
  }
  return n;
}

/* Adds c times a mean to the n nodes of a side; their number then */
static PetscInt SideAdd(PetscReal c, int n_mean, const ContactPairNode mean[], PetscInt n, ContactPairNode side[])
{
  for (int i = 0; i < n_mean; i++) {
    PetscInt k = 0;

    while (k < n && side[k].number != mean[i].number) k++;
    if (k == n) {
      side[n]          = mean[i];
      side[n++].weight = 0;
    }
    side[k].weight += c * mean[i].weight;
  }
  return n;
}

/* The slave's side of pair p, of its own mean and of those that it takes, entry[n]; returns its end */
static ContactPairNode *SlaveSet(MortarPairs *m, PetscInt p, PetscInt n, const MortarEntry entry[],
                                 ContactPairNode *side)
{
  ContactPair    *pair  = &m->pair[p];
  PetscReal       whole = m->own[p];
  ContactPairNode mean[FACET_NODES];

  for (PetscInt i = 0; i < n; i++) whole += entry[i].node.weight;
  pair->n_own = MortarMean(m, m->node[p], side);
  pair->own = pair->slave = side;
  side += pair->n_own;
  pair->n_slave = pair->n_own;
  pair->n_taken = n;
  pair->taken   = side;
  if (!n) return side;
  for (PetscInt i = 0; i < n; i++) {
    *side            = entry[i].node;
    side->number     = m->mortar.slave->vertex[entry[i].node.number];
    (side++)->weight = entry[i].node.weight / whole;
  }
  pair->slave   = side;
  pair->n_slave = SideAdd(m->own[p] / whole, (int)pair->n_own, pair->own, 0, side);
  for (PetscInt i = 0; i < n; i++) {
    const int n_mean = MortarMean(m, entry[i].node.number, mean);

    pair->n_slave = SideAdd(pair->taken[i].weight, n_mean, mean, pair->n_slave, side);
  }
  return side + pair->n_slave;
}

/* The master's side of pair p; returns its end */
static ContactPairNode *MasterSet(MortarPairs *m, PetscInt p, PetscInt n, const MortarEntry entry[],
                                  ContactPairNode *side)
{
  ContactPair *pair = &m->pair[p];
  PetscReal    sum  = 0; /* D_p to rounding; weights over it add up to 1, whatever rounding there was */

  for (PetscInt i = 0; i < n; i++) sum += entry[i].node.weight;
  pair->master = side;
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal w = entry[i].node.weight / sum;

    if (PetscAbsReal(w) < SIDES_ROUNDING) continue;
    *side            = entry[i].node;
    (side++)->weight = w;
  }
  pair->n_master = (PetscInt)(side - pair->master);
  return side;
}

/* Differences from the slave's node first */
PetscErrorCode MortarOffset(const MortarPairs *m, PetscInt p, PetscReal offset[3])
{
  const ContactSurface *slave = m->mortar.slave;
  const ContactPair    *pair  = &m->pair[p];

  PetscFunctionBeginUser;
  for (int d = 0; d < 3; d++) offset[d] = -m->off[p][d] / pair->area;
  for (PetscInt k = 1; k < pair->n_slave; k++) {
    const PetscReal *x;
    PetscInt         at;

    PetscCall(PetscFindInt(pair->slave[k].number, slave->n_sorted, slave->vertex, &at));
    x = MortarBorderPlace(&m->border, at);
    for (int d = 0; d < 3; d++) offset[d] += pair->slave[k].weight * (x[d] - pair->x[d]);
  }
  PetscFunctionReturn(0);
}

/* n . offset, m; what is 1e-9 of the facet's size is rounding of the coordinates, and 0 */
static PetscErrorCode GapSet(const MortarPairs *m, PetscInt p)
{
  ContactPair    *pair = &m->pair[p];
  int             j;
  const PetscReal size = NodeFacet(m, m->node[p], &j)->size;
  PetscReal       offset[3];

  PetscFunctionBeginUser;
  PetscCall(MortarOffset(m, p, offset));
  pair->gap = Vec3Dot(pair->n, offset);
  if (PetscAbsReal(pair->gap) < 1e-9 * size) pair->gap = 0;
  PetscFunctionReturn(0);
}

/* The slave's unit normal at node k of one of its facets */
static void NodeNormal(const ContactFacet *s, int k, PetscReal n[3])
{
  for (int d = 0; d < 3; d++) n[d] = s->across[k][d];
  (void)Vec3Normalise(n);
}

/* sum_k v_k n_k . n_s of the mean of a node */
static PetscReal MeanAlong(const MortarPairs *m, PetscInt node, const PetscReal along[3])
{
  int                 count, k[FACET_NODES];
  PetscReal           v[FACET_NODES], sum = 0, n[3];
  const ContactFacet *s = MeanTerms(m, node, &count, k, v);

  for (int i = 0; i < count; i++) {
    NodeNormal(s, k[i], n);
    sum += v[i] * Vec3Dot(n, along);
  }
  return sum;
}

/* kappa of a pair, of its own mean and of those that it takes, entry[n] */
static void BendSet(const MortarPairs *m, PetscInt p, PetscInt n, const MortarEntry entry[])
{
  int                 j;
  const ContactFacet *s     = NodeFacet(m, m->node[p], &j);
  PetscReal           whole = m->own[p], sum, along[3];

  NodeNormal(s, j, along);
  sum = m->own[p] * (MeanAlong(m, m->node[p], along) - 1);
  for (PetscInt i = 0; i < n; i++) {
    whole += entry[i].node.weight;
    sum += entry[i].node.weight * (MeanAlong(m, entry[i].node.number, along) - 1);
  }
  m->pair[p].bend = sum / whole;
}

/* The others keep an area of 0 and no sides */
PetscErrorCode MortarSetSides(MortarPairs *m)
{
  PetscInt *first, *taken;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(m->n_pairs + 1, &first, m->n_pairs + 1, &taken));
  EntriesMerge(&m->under, m->n_pairs, first);
  EntriesMerge(&m->taken, m->n_pairs, taken);
  PetscCall(
    PetscMalloc1(m->under.n + (1 + FACET_NODES) * m->taken.n + 3 * FACET_NODES * m->n_pairs + FACET_NODES, &m->sides));
  m->end = m->sides;
  for (PetscInt p = 0; p < m->n_pairs; p++) {
    if (!m->border.kept[m->node[p]]) {
      m->pair[p].area = 0;
      continue;
    }
    if (m->pair[p].area <= 0) m->n_bare++;
    m->end = SlaveSet(m, p, taken[p + 1] - taken[p], &m->taken.entry[taken[p]], m->end);
    m->end = MasterSet(m, p, first[p + 1] - first[p], &m->under.entry[first[p]], m->end);
    PetscCall(GapSet(m, p));
    BendSet(m, p, taken[p + 1] - taken[p], &m->taken.entry[taken[p]]);
    m->pair[p].mean = PETSC_TRUE; /* int N~_p p dA over D_p is a pressure; at no D_p = 0 */
  }
  PetscCall(PetscFree2(first, taken));
  PetscFunctionReturn(0);
}
