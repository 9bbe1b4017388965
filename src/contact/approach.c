/*
   Approach of the second rows of nodes of slave and master, one element below their surfaces:
      d . u = mean over pairs of n . (u_m2 - u_s2)   (m)
   Below a node of the surface lies the other end of its edge with the largest cosine to the inward normal. The master
   side moves with the weights of the pair, u_m2 = sum_i w_i u_i2. A corner of the master held in all three
   directions has no unknown by which it could be found: the node below it counts as held too.
*/
#include "contactimpl.h"
#include "base/gather.h"
#include <stdlib.h>

/* A node of the surface and one end of its edges into the body; alike on all ranks that have the node, but for the
   edges each of them sees, of which BelowReduce() takes the best */
typedef struct {
  PetscInt  vertex;   /* largest unknown of the node of the surface, at least 0 */
  PetscInt  below[3]; /* unknowns of the other end, -1 where held */
  PetscReal cosine;   /* of the edge to the inward normal */
  PetscReal x[3];     /* of the other end, m: decides between edges of equal cosine */
} Below;

/* Those of a surface, on every rank, ordered by node */
typedef struct {
  PetscInt n;
  Below   *below;
} BelowList;

/* The number by which a node is found, -1 when all its directions are held */
static PetscInt VertexKey(const PetscInt unknowns[3])
{
  return PetscMax(unknowns[0], PetscMax(unknowns[1], unknowns[2]));
}

/* Whether a lies more nearly along the normal than b. Cosines that differ by less than 1e-9 are equal but for
   rounding (two edges of a tetrahedron, mirror images): the place decides there, the same on every rank and however
   the mesh is split. */
static PetscBool BelowIsBetter(const Below *a, const Below *b)
{
  if (PetscAbsReal(a->cosine - b->cosine) > 1e-9) return a->cosine > b->cosine ? PETSC_TRUE : PETSC_FALSE;
  for (int d = 0; d < 3; d++)
    if (a->x[d] != b->x[d]) return a->x[d] < b->x[d] ? PETSC_TRUE : PETSC_FALSE;
  return PETSC_FALSE;
}

/* Ascending by node */
static int BelowCompare(const void *a, const void *b)
{
  const Below *x = (const Below *)a, *y = (const Below *)b;

  return (x->vertex > y->vertex) - (x->vertex < y->vertex);
}

/* Best edge of node v among those of this rank, of the largest cosine -e . n / (|e| |n|), e from v to the other end;
   normal is outward, of any length. best->vertex is -1 when the node is held or no edge goes inward. */
static PetscErrorCode BelowFind(Model model, PetscInt v, const PetscReal normal[3], Below *best)
{
  const PetscReal area = PetscSqrtReal(PetscSqr(normal[0]) + PetscSqr(normal[1]) + PetscSqr(normal[2]));
  const Mesh     *mesh;
  PetscInt        n_edges, *ends;

  PetscFunctionBeginUser;
  *best = (Below){.vertex = -1};
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(ModelGetNeighbours(model, v, &n_edges, &ends));
  for (PetscInt e = 0; e < n_edges; e++) {
    Below     b   = {.vertex = VertexKey(&mesh->unknown[3 * v])};
    PetscReal dot = 0, length = 0;
    PetscInt  end = 3 * ends[e];

    for (int d = 0; d < 3; d++) {
      const PetscReal edge = mesh->x[end + d] - mesh->x[3 * v + d];

      dot -= edge * normal[d];
      length += PetscSqr(edge);
      b.x[d]     = mesh->x[end + d];
      b.below[d] = mesh->unknown[end + d];
    }
    b.cosine = area > 0 ? dot / (area * PetscSqrtReal(length)) : 0;
    if (b.cosine > 0 && (best->vertex < 0 || BelowIsBetter(&b, best))) *best = b;
  }
  PetscCall(PetscFree(ends));
  PetscFunctionReturn(0);
}

/* The best local edges of all nodes of a surface on this rank that are not held */
static PetscErrorCode BelowLocal(Model model, const char set[], PetscInt *n_found, Below **found)
{
  PetscReal *normals;
  PetscInt   n, *vertices;

  PetscFunctionBeginUser;
  PetscCall(ModelGetSetNormals(model, set, &normals));
  PetscCall(ModelGetSetNodes(model, set, &n, &vertices));
  PetscCall(PetscMalloc1(n, found));
  *n_found = 0;
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(BelowFind(model, vertices[i], &normals[3 * vertices[i]], &(*found)[*n_found]));
    if ((*found)[*n_found].vertex >= 0) ++*n_found;
  }
  PetscCall(PetscFree(vertices));
  PetscCall(PetscFree(normals));
  PetscFunctionReturn(0);
}

/* Keeps the best of each node, ordered by node */
static void BelowReduce(PetscInt *n, Below below[])
{
  PetscInt last = -1;

  if (*n) qsort(below, (size_t)*n, sizeof(*below), BelowCompare);
  for (PetscInt i = 0; i < *n; i++) {
    if (last < 0 || below[i].vertex != below[last].vertex)
      below[++last] = below[i];
    else if (BelowIsBetter(&below[i], &below[last]))
      below[last] = below[i];
  }
  *n = last + 1;
}

/* The edges of all nodes of a surface, on every rank, ordered by node */
static PetscErrorCode BelowGather(Model model, MPI_Comm comm, const char set[], BelowList *list)
{
  PetscInt n_local;
  Below   *local;

  PetscFunctionBeginUser;
  PetscCall(BelowLocal(model, set, &n_local, &local));
  PetscCall(GatherRecords(comm, n_local, sizeof(Below), local, &list->n, &list->below));
  BelowReduce(&list->n, list->below);
  PetscCall(PetscFree(local));
  PetscFunctionReturn(0);
}

/* Adds scale n . u of the node below the one with these unknowns to d; counts it as missing when there is none. A
   node with all three unknowns held cannot be found, and adds nothing: the node below it is taken as held too. */
static PetscErrorCode BelowAdd(const BelowList *list, const PetscInt unknowns[3], PetscReal scale,
                               const PetscReal normal[3], Vec d, PetscInt *missing)
{
  const PetscScalar values[3] = {scale * normal[0], scale * normal[1], scale * normal[2]};
  const Below       wanted    = {.vertex = VertexKey(unknowns)};
  const Below      *found;

  PetscFunctionBeginUser;
  if (wanted.vertex < 0) PetscFunctionReturn(0);
  found = (const Below *)bsearch(&wanted, list->below, (size_t)list->n, sizeof(Below), BelowCompare);
  if (found)
    PetscCall(VecSetValues(d, 3, found->below, values, ADD_VALUES));
  else
    ++*missing;
  PetscFunctionReturn(0);
}

/* Adds the local pairs of an interface, each with the share 1 / (pairs of the interface on all ranks); slave and
   master are the edges of the two surfaces. Of two facets the weights sum to 1, so that d . u of a rigid motion of
   both is 0. */
static PetscErrorCode PairsAdd(Contact contact, PetscInt interface, const BelowList *slave, const BelowList *master,
                               Vec d)
{
  const ContactInterface *c       = &contact->interfaces[interface];
  PetscInt                n_pairs = 0, missing = 0;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < contact->n_pairs; p++) n_pairs += contact->pairs[p].interface == interface;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &n_pairs, 1, MPIU_INT, MPI_SUM, contact->comm));
  for (PetscInt p = 0; p < contact->n_pairs; p++) {
    const ContactPair *pair  = &contact->pairs[p];
    const PetscReal    share = 1 / (PetscReal)n_pairs;

    if (pair->interface != interface) continue;
    for (PetscInt k = 0; k < pair->n_slave; k++)
      PetscCall(BelowAdd(slave, pair->slave[k].unknown, -pair->slave[k].weight * share, pair->n, d, &missing));
    for (PetscInt i = 0; i < pair->n_master; i++)
      PetscCall(BelowAdd(master, pair->master[i].unknown, pair->master[i].weight * share, pair->n, d, &missing));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &missing, 1, MPIU_INT, MPI_SUM, contact->comm));
  PetscCheck(!missing, contact->comm, PETSC_ERR_USER_INPUT,
             "contact %s: %" PetscInt_FMT " nodes of %s or %s have no edge into their body, hence no second row",
             c->name, missing, c->slave, c->master);
  PetscFunctionReturn(0);
}

PetscErrorCode ContactCreateApproach(Contact contact, PetscInt interface, Vec *d)
{
  const ContactInterface *c = &contact->interfaces[interface];
  BelowList               slave, master;

  PetscFunctionBeginUser;
  PetscCall(BelowGather(contact->model, contact->comm, c->slave, &slave));
  PetscCall(BelowGather(contact->model, contact->comm, c->master, &master));
  PetscCall(ModelCreateVec(contact->model, d));
  PetscCall(VecSet(*d, 0));
  PetscCall(VecSetOption(*d, VEC_IGNORE_NEGATIVE_INDICES, PETSC_TRUE)); /* held directions */
  PetscCall(PairsAdd(contact, interface, &slave, &master, *d));
  PetscCall(VecAssemblyBegin(*d));
  PetscCall(VecAssemblyEnd(*d));
  PetscCall(PetscFree(slave.below));
  PetscCall(PetscFree(master.below));
  PetscFunctionReturn(0);
}
