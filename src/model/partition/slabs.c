/*
   Slabs of swept bodies: all cells between nodes k and k + 1 of all lines. Ranks share a swept body by rows of whole
   slabs, so that each of them has lines again.

   Bodies that fit into a rank's share of the cost stay whole, the cheapest first, until they make half of all; the
   other half, at least, are slabs and single cells, with which every rank can be filled up to its share. METIS places
   whole bodies and single cells; then the slabs of all chains, one chain after the other, are dealt out in a row: with
   W the cost of all cells, n ranks, and o_r what rank r has already, it gets slabs of cost
      w_r = max(0, W/n - o_r),
   scaled to the cost of all slabs and rounded to whole ones. The first in the row is the rank with the largest o_r, and
   where the first chain is closed, it begins such that the middle of that rank's arc is next to the centre of these
   other cells: what touches the disc shares the rank with the part of the disc that it touches.
*/
#include "model/modelimpl.h"
#include "partition.h"
#include "base/algebra/vec3.h"

/* Cost of a cell relative to half of one turned about an axis, whose kernel takes about 13 ns: lines along an axis are
   shorter, hence vectorise less well, and blocks of a sparse matrix take 50 to 60 ns (bound by memory) */
enum { COST_TURNED = 2, COST_ALONG = 3, COST_GENERAL = 8 };

/* Cost of a pair, about 190 ns, of which a cell at the contact has one or so: the rank that solves them all does that
   while the others go on (contact/projector/projector.c) */
#define COST_CONTACT 28

/* Bodies of the undistributed mesh */
typedef struct {
  PetscInt     n, *of_vertex, *of_cell;
  PetscInt    *cost;  /* [n] of all cells */
  PetscBool   *whole; /* [n] */
  ModelLines **lines; /* [n] NULL when not swept */
} BodyList;

static PetscErrorCode BodyListDestroy(BodyList *bodies)
{
  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < bodies->n; b++) PetscCall(ModelDestroyLines(&bodies->lines[b]));
  PetscCall(PetscFree4(bodies->of_cell, bodies->cost, bodies->whole, bodies->lines));
  PetscFunctionReturn(0);
}

/* Adds the cost of the pairs to the cells at the contact of swept bodies that stay whole, unless all ranks share the
   pairs evenly, wherever the cells are */
static PetscErrorCode ContactAddCost(Model model, PetscInt n_ranks, const BodyList *bodies, Clusters *clusters)
{
  PetscBool *at_contact;
  PetscInt   n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(clusters->n_cells, &at_contact));
  PetscCall(TogetherFlag(model, at_contact));
  for (PetscInt c = 0; c < clusters->n_cells; c++) n += at_contact[c] && bodies->whole[bodies->of_cell[c]] ? 1 : 0;
  for (PetscInt c = 0; c < clusters->n_cells && !ModelSharesPairs(n, n_ranks, clusters->n_cells); c++)
    if (at_contact[c] && bodies->whole[bodies->of_cell[c]]) clusters->cost[c] += COST_CONTACT;
  PetscCall(PetscFree(at_contact));
  PetscFunctionReturn(0);
}

/* Finds which bodies are swept, and the costs of cells and bodies */
static PetscErrorCode BodyListCreate(Model model, Clusters *clusters, BodyList *bodies)
{
  const PetscInt n = bodies->n;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc4(clusters->n_cells, &bodies->of_cell, n, &bodies->cost, n, &bodies->whole, n, &bodies->lines));
  for (PetscInt b = 0; b < n; b++) PetscCall(ModelCreateLines(model, b, bodies->of_vertex, &bodies->lines[b]));
  for (PetscInt c = 0; c < clusters->n_cells; c++) {
    const PetscInt    b     = bodies->of_vertex[model->mesh.cell_node[model->mesh.cell_first[c]]];
    const ModelLines *lines = bodies->lines[b];

    bodies->of_cell[c] = b;
    clusters->cost[c] *= !lines ? COST_GENERAL : lines->turned ? COST_TURNED : COST_ALONG;
    bodies->cost[b] += clusters->cost[c];
  }
  PetscFunctionReturn(0);
}

/* Chooses the swept bodies that stay whole */
static PetscErrorCode BodyListChooseWhole(PetscInt n_ranks, BodyList *bodies)
{
  PetscInt64 all = 0, whole = 0;
  PetscInt  *order, *cost;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(bodies->n, &order, bodies->n, &cost));
  for (PetscInt b = 0; b < bodies->n; b++) {
    order[b] = b;
    cost[b]  = bodies->cost[b];
    all += cost[b];
  }
  PetscCall(PetscSortIntWithArray(bodies->n, cost, order));
  for (PetscInt i = 0; i < bodies->n; i++) {
    if (!bodies->lines[order[i]] || (PetscInt64)cost[i] * n_ranks > all || 2 * (whole + cost[i]) > all) continue;
    bodies->whole[order[i]] = PETSC_TRUE;
    whole += cost[i];
  }
  PetscCall(PetscFree2(order, cost));
  PetscFunctionReturn(0);
}

/* Makes the slabs of a body clusters from clusters->n on, and takes its lines; node [vertices] is overwritten */
static PetscErrorCode ChainAdd(Model model, BodyList *bodies, PetscInt body, PetscInt node[], Clusters *clusters,
                               Slabs *slabs)
{
  const Mesh *const mesh  = &model->mesh;
  ModelLines *const lines = bodies->lines[body];
  SlabChain *const  chain = &slabs->chain[slabs->n++];

  PetscFunctionBeginUser;
  *chain      = (SlabChain){.first = clusters->n, .n_slabs = lines->n_nodes - (lines->closed ? 0 : 1), .lines = lines};
  chain->cost = bodies->cost[body] / chain->n_slabs;
  bodies->lines[body] = NULL;
  for (PetscInt i = 0; i < lines->n_lines * lines->n_nodes; i++) node[lines->vertex[i]] = i % lines->n_nodes;
  for (PetscInt c = 0; c < clusters->n_cells; c++) {
    PetscInt least = lines->n_nodes, most = 0;

    if (bodies->of_cell[c] != body) continue;
    for (PetscInt i = mesh->cell_first[c]; i < mesh->cell_first[c + 1]; i++) {
      const PetscInt k = node[mesh->cell_node[i]];

      least = PetscMin(least, k);
      most  = PetscMax(most, k);
    }
    clusters->of_cell[c] = chain->first + (most == least + 1 ? least : most);
  }
  clusters->n += chain->n_slabs;
  PetscFunctionReturn(0);
}

/* Mean of the corners of each cell of the undistributed mesh, m */
static PetscErrorCode CellsCentres(Model model, PetscInt n_cells, PetscReal centre[])
{
  const Element *element;
  PetscInt       nodes[ELEMENT_MAX_NODES];
  PetscReal      x[ELEMENT_MAX_DOFS];

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < n_cells; c++) {
    PetscCall(ModelGetCell(model, c, &element, nodes, x));
    for (int d = 0; d < 3; d++) centre[3 * c + d] = 0;
    for (PetscInt i = 0; i < 3 * element->n_nodes; i++) centre[3 * c + i % 3] += x[i] / (PetscReal)element->n_nodes;
  }
  PetscFunctionReturn(0);
}

/* Clusters of all bodies, on the rank of the mesh */
static PetscErrorCode BodiesCluster(Model model, PetscInt n_ranks, BodyList *bodies, Clusters *clusters, Slabs *slabs)
{
  PetscInt *node;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(bodies->n, &slabs->chain, 3 * clusters->n_cells, &slabs->centre));
  PetscCall(PetscMalloc1(model->mesh.n_nodes, &node));
  PetscCall(CellsCentres(model, clusters->n_cells, slabs->centre));
  PetscCall(BodyListCreate(model, clusters, bodies));
  PetscCall(BodyListChooseWhole(n_ranks, bodies));
  PetscCall(ContactAddCost(model, n_ranks, bodies, clusters));
  for (PetscInt b = 0; b < bodies->n; b++) {
    if (bodies->lines[b] && !bodies->whole[b]) PetscCall(ChainAdd(model, bodies, b, node, clusters, slabs));
    if (!bodies->whole[b]) continue;
    for (PetscInt c = 0; c < clusters->n_cells; c++)
      if (bodies->of_cell[c] == b) clusters->of_cell[c] = clusters->n;
    clusters->n++;
  }
  PetscCall(BodyListDestroy(bodies));
  PetscCall(PetscFree(node));
  PetscFunctionReturn(0);
}

PetscErrorCode SlabsFind(Model model, PetscInt n_ranks, Clusters *clusters, Slabs *slabs)
{
  BodyList bodies = {0};

  PetscFunctionBeginUser;
  PetscCall(ModelGetBodies(model, &bodies.n, &bodies.of_vertex));
  if (clusters->n_cells) PetscCall(BodiesCluster(model, n_ranks, &bodies, clusters, slabs));
  PetscCall(PetscFree(bodies.of_vertex));
  PetscFunctionReturn(0);
}

PetscErrorCode SlabsDestroy(Slabs *slabs)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < slabs->n; i++) PetscCall(ModelDestroyLines(&slabs->chain[i].lines));
  PetscCall(PetscFree2(slabs->chain, slabs->centre));
  slabs->n = 0;
  PetscFunctionReturn(0);
}

/* Whether the cluster is a slab */
static PetscBool ClusterIsSlab(const Slabs *slabs, PetscInt cluster)
{
  for (PetscInt i = 0; i < slabs->n; i++)
    if (cluster >= slabs->chain[i].first && cluster < slabs->chain[i].first + slabs->chain[i].n_slabs)
      return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Costs of the cells outside of slabs on each rank, and the centre of those of the rank that has the most; returns
   that rank */
static PetscInt OthersFind(const Slabs *slabs, const Clusters *clusters, PetscInt n_ranks, const PetscInt rank[],
                           PetscReal others[], PetscReal centre[3])
{
  PetscInt most = 0, n = 0;

  for (PetscInt r = 0; r < n_ranks; r++) others[r] = 0;
  for (PetscInt c = 0; c < clusters->n_cells; c++)
    if (!ClusterIsSlab(slabs, clusters->of_cell[c])) others[rank[c]] += (PetscReal)clusters->cost[c];
  for (PetscInt r = 1; r < n_ranks; r++) most = others[r] > others[most] ? r : most;
  for (int d = 0; d < 3; d++) centre[d] = 0;
  for (PetscInt c = 0; c < clusters->n_cells; c++) {
    if (rank[c] != most || ClusterIsSlab(slabs, clusters->of_cell[c])) continue;
    n++;
    for (int d = 0; d < 3; d++) centre[d] += (slabs->centre[3 * c + d] - centre[d]) / (PetscReal)n;
  }
  return most;
}

/* The slab of a closed chain from which the first `share` (cost) lies to both sides of a point */
static PetscInt ChainBegin(const SlabChain *chain, PetscReal share, const PetscReal x[3])
{
  const ModelLines *lines = chain->lines;
  const PetscReal  *a = &lines->frame[3 * ((lines->axis + 1) % 3)], *b = &lines->frame[3 * ((lines->axis + 2) % 3)];
  const PetscReal   off[3] = {x[0] - lines->centre[0], x[1] - lines->centre[1], x[2] - lines->centre[2]};
  const PetscReal   angle  = atan2(Vec3Dot(off, b), Vec3Dot(off, a));
  const PetscInt    n      = chain->n_slabs;
  const PetscReal   half   = PetscMin(share / (PetscReal)chain->cost, (PetscReal)n) / 2;
  const PetscInt    k      = (PetscInt)PetscFloorReal((angle - lines->begin) / lines->step - half + 0.5 + 1e-6);

  return lines->closed ? (k % n + n) % n : 0;
}

/* Rank [clusters] of each slab; want [n_ranks] is what a rank shall get, first the one that begins */
static void ChainsDeal(const Slabs *slabs, PetscInt n_ranks, const PetscReal want[], PetscInt first, PetscInt begin,
                       PetscInt rank[])
{
  PetscReal bound = want[first], dealt = 0;
  PetscInt  turn = 0;

  for (PetscInt i = 0; i < slabs->n; i++) {
    const SlabChain *chain = &slabs->chain[i];

    for (PetscInt k = 0; k < chain->n_slabs; k++) {
      while (turn < n_ranks - 1 && dealt + 0.5 * (PetscReal)chain->cost > bound) {
        turn++;
        bound += want[(first + turn) % n_ranks];
      }
      rank[chain->first + (i ? k : (begin + k) % chain->n_slabs)] = (first + turn) % n_ranks;
      dealt += (PetscReal)chain->cost;
    }
  }
}

PetscErrorCode SlabsDeal(const Slabs *slabs, const Clusters *clusters, PetscInt n_ranks, PetscInt rank[])
{
  PetscInt  first, begin = 0, *of_cluster;
  PetscBool any;
  PetscReal in_slabs = 0, all = 0, wanted = 0, centre[3], *want;

  PetscFunctionBeginUser;
  if (!slabs->n) PetscFunctionReturn(0);
  PetscCall(PetscMalloc2(clusters->n, &of_cluster, n_ranks, &want));
  first = OthersFind(slabs, clusters, n_ranks, rank, want, centre);
  any   = want[first] > 0 ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt i = 0; i < slabs->n; i++) in_slabs += (PetscReal)slabs->chain[i].n_slabs * slabs->chain[i].cost;
  for (PetscInt r = 0; r < n_ranks; r++) all += want[r];
  all += in_slabs;
  for (PetscInt r = 0; r < n_ranks; r++) {
    want[r] = PetscMax(0, all / (PetscReal)n_ranks - want[r]);
    wanted += want[r];
  }
  for (PetscInt r = 0; r < n_ranks; r++) want[r] *= in_slabs / wanted;
  if (any) begin = ChainBegin(&slabs->chain[0], want[first], centre);
  ChainsDeal(slabs, n_ranks, want, first, begin, of_cluster);
  for (PetscInt c = 0; c < clusters->n_cells; c++)
    if (ClusterIsSlab(slabs, clusters->of_cell[c])) rank[c] = of_cluster[clusters->of_cell[c]];
  PetscCall(PetscFree2(of_cluster, want));
  PetscFunctionReturn(0);
}
