/*
   Nodes of the slave at the border of the master. Where a face has but a strip over the master, the functions phi of
   its nodes are those of the strip, and pairs at the nodes beyond it hold what the face would be there: a contact that
   ends a face too late. Such a node has no pair. Its phi_k goes to nodes q that keep theirs,

      phi_q + sum_k c_kq phi_k,   sum_q c_kq = 1,   c_kq ~ |x_k - x_q|^-8,

   so that all phi still sum up to 1 over the master: a uniform pressure passes exactly, whatever the overhang. With
   r_k the largest part of int N~_k dA over one face that lies over the master, or over that of one face what D_k has of
   all where that is less, node k keeps its pair where

      r_k >= BORDER_PART min(1, R_k),   R_k the largest r of the nodes of the faces around it.

   Of a strip of the part e of a face of first order, the nodes beyond have r = e^2, and get pairs from e = 0.61 on:
   from there on they agree best with a slave that ends at the border itself, and below they make frequencies too high;
   where all of a surface has less over the master, as faces larger than the master have, the most covered nodes have
   pairs. q are those nodes of the face that keep their pairs; where a face has none, those of the nearest faces. Every
   rank decides for all nodes, from sums that do not depend on the ranks.
*/
#include "mortarimpl.h"

#define BORDER_PART  0.37 /* no simple fraction, such as meshes have: rounding decides nothing */
#define BORDER_BARE  1e-6 /* r of a node whose faces only touch the master */
#define BORDER_RINGS 20   /* of faces around one, in which nodes that keep their pairs are looked for */

PetscErrorCode MortarBorderCreate(const ContactSurface *slave, MortarBorder *border)
{
  PetscInt *place;

  PetscFunctionBeginUser;
  border->slave = slave;
  PetscCall(PetscCalloc2(slave->n_nodes, &border->sum, slave->n_nodes, &border->whole));
  PetscCall(PetscCalloc6(slave->n_nodes, &border->part, slave->n_facets, &border->cover, slave->n_nodes, &border->kept,
                         slave->n_nodes + 1, &border->first, FACET_NODES * slave->n_facets, &border->around,
                         slave->n_nodes, &border->mark));
  for (PetscInt f = 0; f < slave->n_facets; f++)
    for (int j = 0; j < slave->facet[f].n; j++) border->first[slave->facet[f].node[j] + 1]++;
  for (PetscInt v = 0; v < slave->n_nodes; v++) border->first[v + 1] += border->first[v];
  PetscCall(PetscMalloc1(slave->n_nodes + 1, &place));
  PetscCall(PetscArraycpy(place, border->first, slave->n_nodes + 1));
  for (PetscInt f = 0; f < slave->n_facets; f++)
    for (int j = 0; j < slave->facet[f].n; j++) border->around[place[slave->facet[f].node[j]]++] = FACET_NODES * f + j;
  PetscCall(PetscFree(place));
  PetscFunctionReturn(0);
}

PetscErrorCode MortarBorderDestroy(MortarBorder *border)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(border->sum, border->whole));
  PetscCall(PetscFree6(border->part, border->cover, border->kept, border->first, border->around, border->mark));
  PetscCall(PetscFree(border->takes.facet));
  PetscFunctionReturn(0);
}

void MortarBorderAdd(MortarBorder *border, PetscInt f, PetscReal alpha, const SegmentSums *sums)
{
  const ContactFacet *s = &border->slave->facet[f];
  double              whole[FACET_NODES];
  PetscReal           all = 0;

  SegmentWhole(s->n, (const double(*)[3])s->x, alpha, whole);
  for (int j = 0; j < s->n; j++) all += whole[j];
  border->cover[f] = sums->area > MORTAR_COVERED * all ? MORTAR_OVER : sums->area > 0 ? MORTAR_PARTLY : MORTAR_BESIDE;
  for (int j = 0; j < s->n; j++) {
    const PetscInt  v    = s->node[j];
    const PetscReal part = border->cover[f] == MORTAR_OVER ? 1 : PetscMin(1, sums->d[j] / whole[j]);

    border->part[v]  = PetscMax(border->part[v], part);
    border->whole[v] = PetscMax(border->whole[v], whole[j]);
    border->sum[v] += border->cover[f] == MORTAR_OVER ? whole[j] : sums->d[j];
  }
  for (int j = 0; j < s->n && border->out; j++)
    if (border->out[s->node[j]] && border->cover[f] == MORTAR_OVER) border->cover[f] = MORTAR_PARTLY;
}

PetscErrorCode MortarBorderDecide(MPI_Comm comm, const PetscInt of[], MortarBorder *border)
{
  const ContactSurface *slave = border->slave;

  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < slave->n_nodes; v++)
    border->part[v] = of[v] >= 0 ? PetscMax(0, PetscMin(border->part[v], border->sum[v] / border->whole[v])) : 0;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, border->part, (PetscMPIInt)slave->n_nodes, MPIU_REAL, MPI_MAX, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, border->cover, (PetscMPIInt)slave->n_facets, MPIU_INT, MPI_MAX, comm));
  for (PetscInt v = 0; v < slave->n_nodes; v++) {
    PetscReal most = 0;

    for (PetscInt i = border->first[v]; i < border->first[v + 1]; i++) {
      const ContactFacet *s = &slave->facet[border->around[i] / FACET_NODES];

      for (int j = 0; j < s->n; j++) most = PetscMax(most, border->part[s->node[j]]);
    }
    border->kept[v] =
      border->part[v] > BORDER_BARE && border->part[v] >= BORDER_PART * PetscMin(1, most) ? PETSC_TRUE : PETSC_FALSE;
    if (border->out && border->out[v]) border->kept[v] = PETSC_FALSE;
  }
  PetscFunctionReturn(0);
}

/* Adds a node to a list, once */
static PetscErrorCode NodeAdd(PetscInt node, PetscInt mark[], ContactFacetList *list)
{
  PetscFunctionBeginUser;
  if (mark[node]) PetscFunctionReturn(0);
  mark[node] = 1;
  if (list->n == list->room) {
    list->room = 2 * list->room + 32;
    PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)list->room, &list->facet));
  }
  list->facet[list->n++] = node;
  PetscFunctionReturn(0);
}

/* Adds the nodes of all faces over the master around those from `begin` on */
static PetscErrorCode RingAdd(MortarBorder *border, PetscInt begin, ContactFacetList *list)
{
  const PetscInt end = list->n;

  PetscFunctionBeginUser;
  for (PetscInt k = begin; k < end; k++) {
    const PetscInt v = list->facet[k];

    for (PetscInt i = border->first[v]; i < border->first[v + 1]; i++) {
      const PetscInt      f = border->around[i] / FACET_NODES;
      const ContactFacet *s = &border->slave->facet[f];

      if (border->cover[f] == MORTAR_BESIDE) continue;
      for (int j = 0; j < s->n; j++) PetscCall(NodeAdd(s->node[j], border->mark, list));
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode MortarBorderTakers(MortarBorder *border, PetscInt f, PetscInt *n, const PetscInt **node)
{
  const ContactFacet *s     = &border->slave->facet[f];
  ContactFacetList   *list  = &border->takes;
  PetscInt            begin = 0;

  PetscFunctionBeginUser;
  list->n = *n = 0;
  for (int j = 0; j < s->n; j++) PetscCall(NodeAdd(s->node[j], border->mark, list));
  for (int ring = 0; ring <= BORDER_RINGS && !*n && begin < list->n; ring++) {
    const PetscInt end = list->n;

    for (PetscInt k = begin; k < end; k++)
      if (border->kept[list->facet[k]]) (*n)++;
    if (*n) break;
    PetscCall(RingAdd(border, begin, list));
    begin = end;
  }
  for (PetscInt k = 0; k < list->n; k++) border->mark[list->facet[k]] = 0;
  *n = 0;
  for (PetscInt k = 0; k < list->n; k++)
    if (border->kept[list->facet[k]]) list->facet[(*n)++] = list->facet[k];
  *node = list->facet;
  PetscFunctionReturn(0);
}

/* Of a tie: all of u~ of a side without a pair goes to a corner of it that has one, so that no two nodes follow each
   other. Whether it is so. */
static PetscBool SideGives(const MortarBorder *border, PetscInt v, PetscInt n, const PetscInt node[], PetscReal share[])
{
  const PetscInt      at = border->around[border->first[v]];
  const ContactFacet *s  = &border->slave->facet[at / FACET_NODES];
  const int           j = (int)(at % FACET_NODES), corners = ContactFacetCorners(s);
  PetscInt            a, b, to;

  if (!border->out || border->kept[v] || j < corners || j >= 2 * corners) return PETSC_FALSE;
  a  = s->node[j - corners];
  b  = s->node[(j + 1) % corners];
  to = border->kept[a] ? a : border->kept[b] ? b : -1;
  for (PetscInt i = 0; i < n; i++) share[i] = node[i] == to ? 1 : 0;
  return to >= 0 ? PETSC_TRUE : PETSC_FALSE;
}

void MortarBorderShares(const MortarBorder *border, PetscInt v, PetscInt n, const PetscInt node[], PetscReal share[])
{
  const PetscReal *x   = MortarBorderPlace(border, v);
  PetscReal        sum = 0, size = PETSC_MAX_REAL;

  if (SideGives(border, v, n, node, share)) return;
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal *y = MortarBorderPlace(border, node[i]), away[3] = {x[0] - y[0], x[1] - y[1], x[2] - y[2]};

    share[i] = Vec3Length(away);
    size     = PetscMin(size, share[i]);
  }
  for (PetscInt i = 0; i < n; i++) {
    /* a node that keeps its pair gives nothing away */
    share[i] = node[i] == v ? 1 : border->kept[v] ? 0 : PetscSqr(PetscSqr(PetscSqr(size / share[i])));
    sum += share[i];
  }
  for (PetscInt i = 0; i < n; i++) share[i] /= sum;
}
