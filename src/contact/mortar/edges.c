/*
   Linear pressures at the sides of faces of second order. At a side s between faces A and B, N~_s is a multiple of N_s
   on each, so that its centres on them lie within the faces, at x_s + theta (x_A - x_s), x_A the middle of what is
   opposite in A: dual functions that vanish beyond the faces around their nodes cannot have linear pressures (P.
   Oswald, B. Wohlmuth, On polynomial reproduction of dual FE bases, 2002). But

      chi_s = (D_s^B phi_s on A, - D_s^A phi_s on B) / (D_s^A + D_s^B),   int chi_s N~_k dA = 0 for all k,

   and what a linear pressure p lacks of sum_j p(x_j) phi_j is (p_A - p_B) chi_s there, p_A - p_B its difference between
   the two centres. Hence nodes c at the corners of A and B take

      phi_c + b_cs chi_s,   sum_c b_cs p(x_c) = p_A - p_B,

   b = theta / m at the m corners opposite in A and -theta / 2 at both of the side, those of B with the other sign. phi
   stay biorthogonal to N~, and their sum stays 1: D_p and the sides of the slave are those without, and uniform
   pressures pass as before. It is so at sides between two faces that are all over the master, of surfaces with faces of
   eight nodes: on faces of six alone it changes nothing that shows (scripts/study/swap).
*/
#include "mortarimpl.h"

/* int phi_s N_l dA of the sides of a face with one facet of the master, m^2 */
typedef struct {
  PetscInt  facet;
  PetscReal cross[4][FACET_NODES];
} EdgeBlock;

struct MortarSideSums {
  PetscReal  d[4]; /* D_s, m^2 */
  PetscInt   n;
  EdgeBlock *block;
};

PetscErrorCode MortarEdgesCreate(MortarPairs *m)
{
  PetscBool eight = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < m->mortar.slave->n_facets; f++)
    if (m->mortar.slave->facet[f].n == 8) eight = PETSC_TRUE;
  if (eight) PetscCall(PetscCalloc1(m->mortar.slave->n_facets, &m->edges));
  PetscFunctionReturn(0);
}

PetscErrorCode MortarEdgesDestroy(MortarPairs *m)
{
  PetscFunctionBeginUser;
  for (PetscInt f = 0; m->edges && f < m->mortar.slave->n_facets; f++) PetscCall(PetscFree(m->edges[f].block));
  PetscCall(PetscFree(m->edges));
  PetscFunctionReturn(0);
}

PetscErrorCode MortarEdgesKeep(MortarPairs *m, PetscInt f)
{
  const int       n       = m->mortar.slave->facet[f].n;
  const int       corners = ContactFacetCorners(&m->mortar.slave->facet[f]);
  MortarSideSums *sums    = &m->edges[f];

  PetscFunctionBeginUser;
  if (n == corners || m->border.cover[f] != MORTAR_OVER) PetscFunctionReturn(0);
  sums->n = m->facet.n;
  PetscCall(PetscCalloc1(sums->n, &sums->block));
  for (int s = 0; s < corners; s++) sums->d[s] = m->facet.sums.d[corners + s];
  for (PetscInt i = 0; i < sums->n; i++) {
    const MortarBlock *block = &m->facet.block[i];

    sums->block[i].facet = block->facet;
    for (int s = 0; s < corners; s++)
      for (int k = 0; k < n; k++)
        for (int l = 0; l < m->mortar.master->facet[block->facet].n; l++)
          sums->block[i].cross[s][l] += m->facet.dual[corners + s][k] * block->cross[k][l];
  }
  PetscFunctionReturn(0);
}

/* Adds c phi_s of side s of face f to pair p */
static PetscErrorCode EdgeSideTake(MortarPairs *m, PetscInt f, int s, PetscInt p, PetscReal c)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->edges[f].n; i++) {
    const EdgeBlock    *block  = &m->edges[f].block[i];
    const ContactFacet *master = &m->mortar.master->facet[block->facet];

    for (int l = 0; l < master->n; l++) PetscCall(MortarMasterAdd(m, p, master, l, c * block->cross[s][l]));
  }
  PetscFunctionReturn(0);
}

/* b of the corners of a face for its side s, times a sign, at those of the side, then those opposite; their number */
static int CornersTake(const MortarPairs *m, const ContactFacet *f, int s, PetscReal sign, PetscInt node[],
                       PetscReal b[])
{
  const int       corners = ContactFacetCorners(f);
  const PetscReal theta   = sign * SegmentInward(f->n, m->mortar.alpha);

  for (int i = 0; i < corners; i++) {
    node[i] = f->node[(s + i) % corners];
    b[i]    = i < 2 ? -theta / 2 : theta / (corners - 2);
  }
  return corners;
}

/* The side of face g that is side s of face f, -1 for none */
static int SideFind(const ContactFacet *f, int s, const ContactFacet *g)
{
  const int corners = ContactFacetCorners(g);

  for (int i = 0; i < corners && g->n > corners; i++)
    if (g->node[corners + i] == f->node[ContactFacetCorners(f) + s]) return i;
  return -1;
}

/* Gives chi_s of side s of face f, which is side t of face g, to the corners of both */
static PetscErrorCode EdgeTake(MortarPairs *m, PetscInt f, int s, PetscInt g, int t)
{
  const ContactFacet *facet = m->mortar.slave->facet;
  const PetscReal     here = m->edges[f].d[s], there = m->edges[g].d[t];
  PetscInt            node[8];
  PetscReal           b[8];
  int                 n = CornersTake(m, &facet[f], s, 1, node, b);

  PetscFunctionBeginUser;
  n += CornersTake(m, &facet[g], t, -1, &node[n], &b[n]);
  for (int i = 0; i < n; i++) {
    const PetscInt p = m->of[node[i]];

    if (p < 0) continue;
    PetscCall(EdgeSideTake(m, f, s, p, b[i] * there / (here + there)));
    PetscCall(EdgeSideTake(m, g, t, p, -b[i] * here / (here + there)));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode MortarEdgesTake(MortarPairs *m)
{
  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < m->mortar.slave->n_facets; f++) {
    const ContactFacet *facet   = &m->mortar.slave->facet[f];
    const int           corners = ContactFacetCorners(facet);

    for (int s = 0; s < corners && m->edges[f].n; s++) {
      const PetscInt g = facet->beside[s];
      const int      t = g > f && m->edges[g].n ? SideFind(facet, s, &m->mortar.slave->facet[g]) : -1;

      if (t >= 0) PetscCall(EdgeTake(m, f, s, g, t));
    }
  }
  PetscFunctionReturn(0);
}
