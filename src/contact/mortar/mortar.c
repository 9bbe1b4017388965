/*
   Mortar contact: pairs from integrals over the surfaces. With phi_p the dual function of slave node p, the sum of
   those of the facets around it (facets.c),

      D_p = int phi_p dA,   w_pl = int phi_p N_l dA / D_p,

   the pair of p joins u_s = u~_p, the coefficient of N~_p (kernels/contact/segment.h): that of the node itself, at a
   node between corners of second order with its corners; and u_m = sum_l w_pl u_l. N~ is biorthogonal to phi, so that

      n . (u_m - u_s) = int phi_p n . (u^m - u^s) dA / D_p

   with the fields of both surfaces, and the gap likewise with the places of the nodes. A pressure sum_p p_p phi_p has
   the forces p_p D_p of the pairs; a uniform one acts on both sides as int p N dA does. The area D_p is that over the
   master, to rounding of the overlap. Integrals are over the mesh at rest, n is that of the pair (pair.c).

   Every rank takes the facets around the slave nodes that it owns, in the order of the surface, so that no sum hangs on
   the ranks.
*/
#include "mortarimpl.h"
#include <stdlib.h>

/* of the area of a node in its surface: a node with less has no pair */
#define MEAN_BARE 1e-6
/* of the faces around a node, over the master: a pair of less holds what lies beyond the border */
#define MEAN_PART 0.5
/* a weight that is rounding of integrals */
#define MEAN_ROUNDING 1e-15

/* What one facet adds to the weight of a node of the master in a pair, m^2 */
typedef struct {
  PetscInt        pair, order;
  ContactPairNode node;
} MortarEntry;

/* The pairs of an interface as they are made */
typedef struct {
  Mortar       mortar;
  MortarFacet  facet;
  ContactPair *pair;         /* [n_pairs] */
  PetscInt     n_pairs, *of; /* [slave nodes] their pairs, -1 for none on this rank */
  PetscInt    *around;       /* [n_pairs] 9 times a facet of the slave around the node, and its place there */
  PetscReal   *whole;        /* [n_pairs] area of the node in its surface, m^2 */
  PetscReal (*part)[2];      /* [n_pairs] faces around the node, as far as they lie over the master, and their number */
  PetscReal (*off)[3];       /* [n_pairs] sum_l int phi_p N_l dA (x_l - x_p), m^3 */
  PetscInt     n, room;
  MortarEntry *entry;
} MortarPairs;

static int EntryCompare(const void *left, const void *right)
{
  const MortarEntry *a = (const MortarEntry *)left, *b = (const MortarEntry *)right;

  if (a->pair != b->pair) return a->pair < b->pair ? -1 : 1;
  if (a->node.number != b->node.number) return a->node.number < b->node.number ? -1 : 1;
  return (a->order > b->order) - (a->order < b->order);
}

/* The pairs of the nodes of the slave surface */
static PetscErrorCode MeansFind(MortarPairs *m)
{
  const ContactSurface *slave = m->mortar.slave;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc5(slave->n_nodes, &m->of, m->n_pairs, &m->around, m->n_pairs, &m->whole, m->n_pairs, &m->off,
                         m->n_pairs, &m->part));
  for (PetscInt i = 0; i < slave->n_nodes; i++) m->of[i] = -1;
  for (PetscInt p = 0; p < m->n_pairs; p++) {
    PetscInt at;

    PetscCall(PetscFindInt(m->pair[p].vertex, slave->n_nodes, slave->vertex, &at));
    PetscCheck(at >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a pair's slave node is no node of the slave surface");
    m->of[at]       = p;
    m->whole[p]     = m->pair[p].area;
    m->pair[p].area = 0;
  }
  PetscFunctionReturn(0);
}

/* Adds what the facet has for its node j, of pair p */
static PetscErrorCode NodeTake(MortarPairs *m, int n, int j, PetscInt p)
{
  PetscFunctionBeginUser;
  m->pair[p].area += m->facet.sums.d[j];
  for (PetscInt i = 0; i < m->facet.n; i++) {
    const MortarBlock  *block  = &m->facet.block[i];
    const ContactFacet *master = &m->mortar.master->facet[block->facet];

    for (int l = 0; l < master->n; l++) {
      const PetscInt *u   = master->unknowns[l];
      PetscReal       sum = 0;

      for (int k = 0; k < n; k++) sum += m->facet.dual[j][k] * block->cross[k][l];
      m->entry[m->n] = (MortarEntry){p, m->n, {m->mortar.master->vertex[master->node[l]], {u[0], u[1], u[2]}, sum}};
      m->n++;
      for (int d = 0; d < 3; d++) m->off[p][d] += sum * (master->x[l][d] - m->pair[p].x[d]);
    }
  }
  PetscFunctionReturn(0);
}

/* How much of a facet lies over the master */
static PetscReal FacetPart(const MortarPairs *m, const ContactFacet *s)
{
  PetscReal area = 0;

  for (int j = 0; j < s->n && m->facet.n; j++) area += m->facet.sums.d[j];
  return PetscMin(1, area / PetscSqr(s->size));
}

/* Adds what the facets of the slave have for the pairs of this rank */
static PetscErrorCode FacetsTake(MortarPairs *m)
{
  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < m->mortar.slave->n_facets; f++) {
    const ContactFacet *s    = &m->mortar.slave->facet[f];
    PetscInt            here = 0;

    for (int j = 0; j < s->n; j++) here += m->of[s->node[j]] >= 0;
    if (!here) continue;
    PetscCall(MortarIntegrate(&m->mortar, f, &m->facet));
    if (m->n + here * m->facet.n * FACET_NODES > m->room) {
      m->room = 2 * m->room + here * m->facet.n * FACET_NODES;
      PetscCall(PetscRealloc(sizeof(MortarEntry) * (size_t)m->room, &m->entry));
    }
    for (int j = 0; j < s->n; j++) {
      const PetscInt p = m->of[s->node[j]];

      if (p < 0) continue;
      m->around[p] = FACET_NODES * f + j;
      m->part[p][0] += FacetPart(m, s);
      m->part[p][1] += 1;
      PetscCall(NodeTake(m, s->n, j, p));
    }
  }
  PetscFunctionReturn(0);
}

/* Entries of one pair and node of the master become one, in place; first[p] is where those of pair p begin */
static void EntriesMerge(MortarPairs *m, PetscInt first[])
{
  PetscInt n = 0, p = 0;

  if (m->n) qsort(m->entry, (size_t)m->n, sizeof(MortarEntry), EntryCompare);
  for (PetscInt i = 0; i < m->n; i++) {
    const MortarEntry *e = &m->entry[i];

    if (n && m->entry[n - 1].pair == e->pair && m->entry[n - 1].node.number == e->node.number) {
      m->entry[n - 1].node.weight += e->node.weight;
      continue;
    }
    while (p <= e->pair) first[p++] = n;
    m->entry[n++] = *e;
  }
  while (p <= m->n_pairs) first[p++] = n;
  m->n = n;
}

/* The slave's side of pair p; returns its end */
static ContactPairNode *SlaveSet(const MortarPairs *m, PetscInt p, ContactPairNode *side)
{
  const ContactFacet *s    = &m->mortar.slave->facet[m->around[p] / FACET_NODES];
  const int           j    = (int)(m->around[p] % FACET_NODES);
  ContactPair        *pair = &m->pair[p];
  PetscReal           v[FACET_NODES];

  SegmentValue(s->n, m->mortar.alpha, j, v);
  pair->slave = side;
  for (int i = 0; i < s->n; i++) { /* the node itself, then the others */
    const int       k = i == 0 ? j : i <= j ? i - 1 : i;
    const PetscInt *u = s->unknowns[k];

    if (v[k] != 0) *side++ = (ContactPairNode){m->mortar.slave->vertex[s->node[k]], {u[0], u[1], u[2]}, v[k]};
  }
  pair->n_slave = (PetscInt)(side - pair->slave);
  return side;
}

/* The sides of pair p, of the entries of its weights */
static ContactPairNode *SidesSet(MortarPairs *m, PetscInt p, PetscInt n, const MortarEntry entry[],
                                 ContactPairNode *side)
{
  ContactPair *pair = &m->pair[p];
  PetscReal    sum  = 0; /* D_p to rounding; weights over it add up to 1, whatever rounding there was */

  for (PetscInt i = 0; i < n; i++) sum += entry[i].node.weight;
  side         = SlaveSet(m, p, side);
  pair->master = side;
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal w = entry[i].node.weight / sum;

    if (PetscAbsReal(w) < MEAN_ROUNDING) continue;
    *side            = entry[i].node;
    (side++)->weight = w;
  }
  pair->n_master = (PetscInt)(side - pair->master);
  return side;
}

/* n . (sum_k v_k x_k - sum_l w_l x_l), m, differences from the slave's node first; what is 1e-9 of the facet's size is
   rounding of the coordinates, and 0 */
static void GapSet(const MortarPairs *m, PetscInt p)
{
  const ContactFacet *s    = &m->mortar.slave->facet[m->around[p] / FACET_NODES];
  const int           j    = (int)(m->around[p] % FACET_NODES);
  ContactPair        *pair = &m->pair[p];
  PetscReal           v[FACET_NODES];

  SegmentValue(s->n, m->mortar.alpha, j, v);
  pair->gap = 0;
  for (int d = 0; d < 3; d++) {
    PetscReal apart = -m->off[p][d] / pair->area;

    for (int k = 0; k < s->n; k++) apart += v[k] * (s->x[k][d] - s->x[j][d]);
    pair->gap += pair->n[d] * apart;
  }
  if (PetscAbsReal(pair->gap) < 1e-9 * s->size) pair->gap = 0;
}

/* Sides and gaps of the pairs that have an area; the others keep 0 */
static PetscErrorCode MeansSet(MortarPairs *m, ContactPairNode **sides)
{
  PetscInt        *first;
  ContactPairNode *side;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(m->n_pairs + 1, &first));
  EntriesMerge(m, first);
  PetscCall(PetscMalloc1(m->n + FACET_NODES * m->n_pairs, sides));
  side = *sides;
  for (PetscInt p = 0; p < m->n_pairs; p++) {
    if (m->pair[p].area <= MEAN_BARE * m->whole[p]) {
      m->pair[p].area = 0;
      continue;
    }
    side = SidesSet(m, p, first[p + 1] - first[p], &m->entry[first[p]], side);
    GapSet(m, p);
    m->pair[p].mean = PETSC_TRUE; /* N~ is nowhere negative */
  }
  PetscCall(PetscFree(first));
  PetscFunctionReturn(0);
}

/* Says how many pairs stand for faces that lie mostly beyond the border of the master. The mean of such a pair is that
   of a strip of its faces, by functions that are large beyond it: a stiff contact holds the whole faces by it. */
static PetscErrorCode PartsWarn(Contact contact, const ContactInterface *c, const MortarPairs *m)
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->n_pairs; p++)
    if (m->pair[p].area > 0 && m->part[p][0] < MEAN_PART * m->part[p][1]) n++;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &n, 1, MPIU_INT, MPI_SUM, contact->comm));
  if (n)
    PetscCall(PetscFPrintf(contact->comm, stderr,
                           "squeal: warning: contact %s: %" PetscInt_FMT " pairs of mortar contact have less than half "
                           "of their faces over %s: they hold faces that lie beyond its border, and frequencies come "
                           "out too high; give -%s_discretization node, or faces of %s that end there\n",
                           c->name, n, c->master, c->name, c->slave));
  PetscFunctionReturn(0);
}

/* Raises an error where faces of eight and of nine nodes may share a side, on which their N~ differ; all ranks have all
   facets */
static PetscErrorCode SlaveCheck(MPI_Comm comm, const ContactInterface *c, const ContactSurface *slave)
{
  PetscBool has[FACET_NODES + 1] = {PETSC_FALSE};

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < slave->n_facets; f++) has[slave->facet[f].n] = PETSC_TRUE;
  PetscCheck(!has[8] || !has[9], comm, PETSC_ERR_SUP,
             "contact %s: %s has faces of eight and of nine nodes, which mortar contact does not join; give "
             "-%s_discretization node, or the other surface as slave",
             c->name, c->slave, c->name);
  PetscFunctionReturn(0);
}

PetscErrorCode ContactMortarPairs(Contact contact, PetscInt interface, PetscInt first)
{
  const ContactInterface *c     = &contact->interfaces[interface];
  ContactSurface          slave = {0};
  const ContactSurface   *master;
  MortarPairs             m = {.pair = &contact->pairs[first], .n_pairs = contact->n_pairs - first};
  PetscInt                failed;

  PetscFunctionBeginUser;
  PetscCall(ContactGetSurface(contact, interface, &master));
  PetscCall(ContactSurfaceCreate(contact, c->slave, &slave));
  PetscCall(SlaveCheck(contact->comm, c, &slave));
  PetscCall(MortarCreate(&slave, master, c->tolerance, &m.mortar));
  PetscCall(MeansFind(&m));
  PetscCall(FacetsTake(&m));
  PetscCall(MeansSet(&m, &contact->sides[interface]));
  PetscCallMPI(MPI_Allreduce(&m.mortar.n_failed, &failed, 1, MPIU_INT, MPI_SUM, contact->comm));
  PetscCheck(!failed, contact->comm, PETSC_ERR_USER_INPUT,
             "contact %s: faces of %s or %s are so distorted that no point over them can be found in them; mesh them "
             "anew, or give -%s_discretization node",
             c->name, c->slave, c->master, c->name);
  PetscCall(PartsWarn(contact, c, &m));
  PetscCall(PetscFree5(m.of, m.around, m.whole, m.off, m.part));
  PetscCall(PetscFree(m.entry));
  PetscCall(PetscFree(m.facet.block));
  PetscCall(MortarDestroy(&m.mortar));
  PetscCall(ContactSurfaceDestroy(&slave));
  PetscFunctionReturn(0);
}
