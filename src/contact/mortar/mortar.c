/*
   Mortar contact: pairs from integrals over the surfaces. With phi_p the dual function of slave node p, the sum of
   those of the facets around it (facets.c) and of what nodes without pairs at the border of the master give it
   (border.c), phi_p = sum_k c_pk phi_k, c_pp = 1,

      D_p = int phi_p dA = sum_k c_pk D_k,   w_pl = int phi_p N_l dA / D_p,

   the pair of p joins u_s = sum_k c_pk D_k u~_k / D_p, u~_k being the coefficient of N~_k (kernels/contact/segment.h):
   that of the node itself, at a node between corners of second order with its corners; and u_m = sum_l w_pl u_l. N~ is
   biorthogonal to phi, so that

      n . (u_m - u_s) = int phi_p n . (u^m - u^s) dA / D_p

   with the fields of both surfaces, and the gap likewise with the places of the nodes. A pressure sum_p p_p phi_p has
   the forces p_p D_p of the pairs; a uniform one acts on both sides as int p N dA does. The area D_p is that over the
   master, to rounding of the overlap. Integrals are over the mesh at rest, n is that of the pair (pair.c).

   Every rank takes the facets around the slave nodes that it owns, first those all over the master, then the others,
   each in the order of the surface, so that no sum depends on the ranks.
*/
#include "mortarimpl.h"

/* The pairs of the nodes of the slave surface */
static PetscErrorCode MeansFind(MortarPairs *m)
{
  const ContactSurface *slave = m->mortar.slave;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(slave->n_nodes, &m->of));
  PetscCall(PetscCalloc3(m->n_pairs, &m->node, m->n_pairs, &m->off, m->n_pairs, &m->own));
  for (PetscInt i = 0; i < slave->n_nodes; i++) m->of[i] = -1;
  for (PetscInt p = 0; p < m->n_pairs; p++) {
    PetscInt at;

    if (m->feet)
      at = m->feet[p].place;
    else
      PetscCall(PetscFindInt(m->pair[p].vertex, slave->n_sorted, slave->vertex, &at));
    PetscCheck(at >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a pair's slave node is no node of the slave surface");
    m->of[at]       = p;
    m->node[p]      = at;
    m->pair[p].area = 0;
  }
  PetscFunctionReturn(0);
}

/* Adds c phi_j of the facet, of its node j, to pair p */
static PetscErrorCode NodeTake(MortarPairs *m, const ContactFacet *s, int j, PetscInt p, PetscReal c)
{
  PetscFunctionBeginUser;
  m->pair[p].area += c * m->facet.sums.d[j];
  if (s->node[j] == m->node[p])
    m->own[p] += m->facet.sums.d[j];
  else
    PetscCall(MortarEntryAdd(&m->taken, p, s->node[j], s->unknowns[j], c * m->facet.sums.d[j]));
  for (PetscInt i = 0; i < m->facet.n; i++) {
    const MortarBlock  *block  = &m->facet.block[i];
    const ContactFacet *master = &m->mortar.master->facet[block->facet];

    for (int l = 0; l < master->n; l++) {
      PetscReal sum = 0;

      for (int k = 0; k < s->n; k++) sum += c * m->facet.dual[j][k] * block->cross[k][l];
      PetscCall(MortarMasterAdd(m, p, master, l, sum));
    }
  }
  PetscFunctionReturn(0);
}

/* Whether a face has nodes of this rank */
static PetscBool FaceIsHere(const MortarPairs *m, PetscInt f)
{
  const ContactFacet *s = &m->mortar.slave->facet[f];

  for (int j = 0; j < s->n; j++)
    if (m->of[s->node[j]] >= 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Whether this rank needs the integrals of a face: at its nodes, or at sides that it shares with a face of theirs */
static PetscBool FaceIsNeeded(const MortarPairs *m, PetscInt f)
{
  const ContactFacet *s = &m->mortar.slave->facet[f];

  if (FaceIsHere(m, f)) return PETSC_TRUE;
  for (int i = 0; i < ContactFacetCorners(s) && m->edges; i++)
    if (s->beside[i] >= 0 && FaceIsHere(m, s->beside[i])) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Takes what lies over the master of a facet all over it, and keeps how much others have */
static PetscErrorCode FacetsTake(MortarPairs *m)
{
  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < m->mortar.slave->n_facets; f++) {
    const ContactFacet *s = &m->mortar.slave->facet[f];

    if (!FaceIsNeeded(m, f)) continue;
    PetscCall(MortarIntegrate(&m->mortar, f, &m->facet));
    MortarBorderAdd(&m->border, f, m->mortar.alpha, &m->facet.sums);
    if (m->edges) PetscCall(MortarEdgesKeep(m, f));
    for (int j = 0; j < s->n && m->border.cover[f] == MORTAR_OVER; j++)
      if (m->of[s->node[j]] >= 0) PetscCall(NodeTake(m, s, j, m->of[s->node[j]], 1));
  }
  PetscFunctionReturn(0);
}

/* Keeps a facet of a tie that none takes, where the master under it is free; of the rank of one of its nodes */
static PetscErrorCode FacetLose(MortarPairs *m, PetscInt f)
{
  PetscFunctionBeginUser;
  if (!FaceIsHere(m, f)) PetscFunctionReturn(0);
  PetscCall(MortarIntegrate(&m->mortar, f, &m->facet));
  for (PetscInt i = 0; i < m->facet.n; i++) {
    const ContactFacet *master = &m->mortar.master->facet[m->facet.block[i].facet];

    for (int l = 0; l < master->n; l++)
      if (master->unknowns[l][m->direction] >= 0) m->lost = f;
  }
  PetscFunctionReturn(0);
}

/* Takes what facets partly over the master have for the nodes of this rank that take it */
static PetscErrorCode PartsTake(MortarPairs *m)
{
  PetscReal *share;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(m->mortar.slave->n_nodes, &share));
  for (PetscInt f = 0; f < m->mortar.slave->n_facets; f++) {
    const ContactFacet *s = &m->mortar.slave->facet[f];
    const PetscInt     *node;
    PetscInt            n, here = 0;

    if (m->border.cover[f] != MORTAR_PARTLY) continue;
    PetscCall(MortarBorderTakers(&m->border, f, &n, &node));
    if (!n && m->out) PetscCall(FacetLose(m, f));
    for (PetscInt i = 0; i < n; i++) here += m->of[node[i]] >= 0;
    if (!here) continue;
    PetscCall(MortarIntegrate(&m->mortar, f, &m->facet));
    for (int j = 0; j < s->n; j++) {
      MortarBorderShares(&m->border, s->node[j], n, node, share);
      for (PetscInt i = 0; i < n; i++)
        if (m->of[node[i]] >= 0 && share[i] > 0) PetscCall(NodeTake(m, s, j, m->of[node[i]], share[i]));
    }
  }
  PetscCall(PetscFree(share));
  PetscFunctionReturn(0);
}

PetscErrorCode MortarSumsCheck(MPI_Comm comm, const char what[], const char name[], const char slave[],
                               const char master[], const MortarPairs *m)
{
  PetscInt failed[2] = {m->mortar.n_failed, m->n_bare};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, failed, 2, MPIU_INT, MPI_SUM, comm));
  PetscCheck(!failed[0], comm, PETSC_ERR_USER_INPUT,
             "%s %s: faces of %s or %s are so distorted that no point over them can be found in them; mesh them "
             "anew, or give -%s_discretization node",
             what, name, slave, master, name);
  PetscCheck(!failed[1], comm, PETSC_ERR_SUP,
             "%s %s: functions of %" PetscInt_FMT " nodes of %s have no area over %s; give -%s_discretization "
             "node, or finer faces of %s",
             what, name, failed[1], slave, master, name, slave);
  PetscFunctionReturn(0);
}

PetscErrorCode MortarPairsMake(MPI_Comm comm, const ContactSurface *slave, const ContactSurface *master,
                               PetscReal tolerance, MortarPairs *m)
{
  PetscFunctionBeginUser;
  m->lost = -1;
  PetscCall(MortarCreate(slave, master, tolerance, &m->mortar));
  PetscCall(MortarBorderCreate(slave, &m->border));
  m->border.out = m->out;
  if (m->folds) m->mortar.facing = MORTAR_FOLD;
  PetscCall(MeansFind(m));
  PetscCall(MortarEdgesCreate(m));
  PetscCall(FacetsTake(m));
  if (m->edges) PetscCall(MortarEdgesTake(m));
  PetscCall(MortarBorderDecide(comm, m->of, &m->border));
  PetscCall(PartsTake(m));
  PetscCall(MortarSetSides(m));
  PetscFunctionReturn(0);
}

PetscErrorCode MortarPairsDestroy(MortarPairs *m)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(m->of));
  PetscCall(PetscFree3(m->node, m->off, m->own));
  PetscCall(PetscFree(m->under.entry));
  PetscCall(PetscFree(m->taken.entry));
  PetscCall(PetscFree(m->facet.block));
  PetscCall(MortarEdgesDestroy(m));
  PetscCall(MortarBorderDestroy(&m->border));
  PetscCall(MortarDestroy(&m->mortar));
  PetscFunctionReturn(0);
}

/* Whether faces around a node are over the master, and others take its phi */
static PetscBool NodeGives(const MortarBorder *border, PetscInt node)
{
  if (border->kept[node]) return PETSC_FALSE;
  for (PetscInt i = border->first[node]; i < border->first[node + 1]; i++)
    if (border->cover[border->around[i] / FACET_NODES] != MORTAR_BESIDE) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Means of the nodes of this rank whose phi others take, where they are of several nodes */
static PetscErrorCode MeansAlone(Contact contact, PetscInt interface, MortarPairs *m)
{
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->n_pairs; p++) {
    const PetscInt node = m->node[p];
    const int      n    = MortarMean(m, node, m->end);

    if (n == 1 || !NodeGives(&m->border, node)) continue;
    PetscCall(PetscRealloc(sizeof(ContactMean) * (size_t)(contact->n_means + 1), &contact->means));
    contact->means[contact->n_means++] = (ContactMean){interface, n, m->end};
    m->end += n;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ContactMortarPairs(Contact contact, PetscInt interface, PetscInt first)
{
  const ContactInterface *c     = &contact->interfaces[interface];
  ContactSurface          slave = {0};
  const ContactSurface   *master;
  MortarPairs m = {.pair = &contact->pairs[first], .n_pairs = contact->n_pairs - first, .feet = &contact->feet[first]};

  PetscFunctionBeginUser;
  PetscCall(ContactGetSurface(contact, interface, &master));
  PetscCall(ContactSurfaceCreate(contact, c->slave, &slave));
  PetscCall(MortarSplitSlave(&slave));
  m.folds = master->folds || slave.n_nodes > slave.n_sorted ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(MortarPairsMake(contact->comm, &slave, master, c->tolerance, &m));
  contact->sides[interface] = m.sides;
  PetscCall(MeansAlone(contact, interface, &m));
  PetscCall(MortarSumsCheck(contact->comm, "contact", c->name, c->slave, c->master, &m));
  PetscCall(MortarPairsDestroy(&m));
  PetscCall(ContactSurfaceDestroy(&slave));
  PetscFunctionReturn(0);
}
