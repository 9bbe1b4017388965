/*
   Search on a surface: bounding volumes of its facets, a tree halved along the longest side of each box, made once of
   the surface at rest; the boxes are fitted to the places of the nodes from the leaves up. Facets near a point are
   those whose boxes are within a margin of it; the nearest point is found by branch and bound. Making costs n log^2 n
   for n facets, fitting n, a search log n and what it finds.

   The tree and the order of what is found depend on the surface alone, not on the ranks: ties of sorting are between
   facets of one middle coordinate, whose order is that of the surface (surface.c).
*/
#include "contact/contactimpl.h"
#include "kernels/contact/nearest.h"

/* facets of a leaf, at most: a box test costs about as much as the bounds of a few facets */
#define LEAF 4
/* of the tree: halves reach n = 1 after log2(n) levels, fewer than the bits of a PetscInt */
#define MAX_LEVELS 64

/* Longest side of the box of the middles of facets order[0..n) */
static int LongestSide(const ContactSurface *s, PetscInt n, const PetscInt order[])
{
  PetscReal low[3], high[3];
  int       longest = 0;

  for (int d = 0; d < 3; d++) low[d] = high[d] = ContactFacetMiddle(&s->facet[order[0]], d);
  for (PetscInt i = 1; i < n; i++)
    for (int d = 0; d < 3; d++) {
      low[d]  = PetscMin(low[d], ContactFacetMiddle(&s->facet[order[i]], d));
      high[d] = PetscMax(high[d], ContactFacetMiddle(&s->facet[order[i]], d));
    }
  for (int d = 1; d < 3; d++)
    if (high[d] - low[d] > high[longest] - low[longest]) longest = d;
  return longest;
}

/* Boxes of facets order[first .. first + n) and all below it */
static PetscErrorCode BoxBuild(ContactSurface *s, PetscInt first, PetscInt n)
{
  const PetscInt here = s->n_boxes++;
  PetscReal     *key;
  int            side;

  PetscFunctionBeginUser;
  s->box[here] = (ContactBox){.first = first, .n = n};
  if (n <= LEAF) PetscFunctionReturn(0);
  side = LongestSide(s, n, &s->order[first]);
  PetscCall(PetscMalloc1(n, &key));
  for (PetscInt i = 0; i < n; i++) key[i] = ContactFacetMiddle(&s->facet[s->order[first + i]], side);
  PetscCall(PetscSortRealWithArrayInt(n, key, &s->order[first]));
  PetscCall(PetscFree(key));
  PetscCall(BoxBuild(s, first, n / 2));
  s->box[here].right = s->n_boxes;
  PetscCall(BoxBuild(s, first + n / 2, n - n / 2));
  s->box[here].n = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode ContactBoxesBuild(ContactSurface *s)
{
  const ContactShape rest = {.surface = s};

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->n_facets, &s->order));
  PetscCall(PetscMalloc1(2 * s->n_facets, &s->box));
  for (PetscInt f = 0; f < s->n_facets; f++) s->order[f] = f;
  s->n_boxes = 0;
  if (s->n_facets) PetscCall(BoxBuild(s, 0, s->n_facets));
  ContactBoxesFit(&rest, s->box);
  PetscFunctionReturn(0);
}

/* Grows a box to hold another one */
static void BoxGrow(ContactBox *box, const PetscReal low[3], const PetscReal high[3])
{
  for (int d = 0; d < 3; d++) {
    box->low[d]  = PetscMin(box->low[d], low[d]);
    box->high[d] = PetscMax(box->high[d], high[d]);
  }
}

/* A box that holds nothing, then one facet */
static void BoxEmpty(ContactBox *box)
{
  for (int d = 0; d < 3; d++) {
    box->low[d]  = PETSC_MAX_REAL;
    box->high[d] = -PETSC_MAX_REAL;
  }
}

static void BoxGrowFacet(const ContactShape *shape, PetscInt f, ContactBox *box)
{
  PetscReal x[CONTACT_MAX_MASTER][3];

  ContactNodes(shape, f, x);
  FacetBounds(shape->surface->facet[f].n, (const double(*)[3])x, box->low, box->high);
}

/* Boxes around the nodes as they lie, m. Children stand after their parents in box[], so that a loop from the last to
   the first has both of them ready. */
void ContactBoxesFit(const ContactShape *shape, ContactBox box[])
{
  const ContactSurface *s = shape->surface;

  for (PetscInt b = s->n_boxes - 1; b >= 0; b--) {
    BoxEmpty(&box[b]);
    for (PetscInt i = s->box[b].first; i < s->box[b].first + s->box[b].n; i++)
      BoxGrowFacet(shape, s->order[i], &box[b]);
    if (s->box[b].n) continue;
    BoxGrow(&box[b], box[b + 1].low, box[b + 1].high);
    BoxGrow(&box[b], box[s->box[b].right].low, box[s->box[b].right].high);
  }
}

static PetscBool BoxIsNear(const ContactBox *box, const PetscReal x[3], PetscReal margin)
{
  for (int d = 0; d < 3; d++)
    if (x[d] < box->low[d] - margin || x[d] > box->high[d] + margin) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Whether the box of one facet is near */
static PetscBool FacetIsNear(const ContactShape *shape, PetscInt f, const PetscReal x[3], PetscReal margin)
{
  ContactBox box;

  BoxEmpty(&box);
  BoxGrowFacet(shape, f, &box);
  return BoxIsNear(&box, x, margin);
}

static PetscErrorCode ListAppend(ContactFacetList *list, PetscInt facet)
{
  PetscFunctionBeginUser;
  if (list->n == list->room) {
    list->room = 2 * list->room + 64;
    PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)list->room, &list->facet));
  }
  list->facet[list->n++] = facet;
  PetscFunctionReturn(0);
}

PetscErrorCode ContactFacetsNear(const ContactShape *shape, const ContactBox box[], const PetscReal x[3],
                                 PetscReal margin, ContactFacetList *list)
{
  const ContactSurface *s      = shape->surface;
  const PetscInt        before = list->n;
  PetscInt              stack[MAX_LEVELS], depth = 0;

  PetscFunctionBeginUser;
  stack[depth++] = 0;
  while (depth > 0) {
    const PetscInt    b    = stack[--depth];
    const ContactBox *node = &s->box[b];

    if (!BoxIsNear(&box[b], x, margin)) continue;
    if (!node->n) {
      stack[depth++] = node->right;
      stack[depth++] = b + 1;
    }
    for (PetscInt i = node->first; i < node->first + node->n; i++)
      if (FacetIsNear(shape, s->order[i], x, margin)) PetscCall(ListAppend(list, s->order[i]));
  }
  PetscCall(PetscSortInt(list->n - before, &list->facet[before]));
  PetscFunctionReturn(0);
}

/* Squared distance of x to a box */
static PetscReal BoxDistance(const ContactBox *box, const PetscReal x[3])
{
  PetscReal square = 0;

  for (int d = 0; d < 3; d++) square += PetscSqr(PetscMax(0, PetscMax(box->low[d] - x[d], x[d] - box->high[d])));
  return square;
}

/* Depth first, and the nearer child first, so that most boxes are refused by their distance. BoxDistance() is a
   square, m^2. */
void ContactFootNearest(const ContactSurface *s, const PetscReal x[3], ContactFoot *foot)
{
  PetscInt stack[MAX_LEVELS], depth = 0;

  *foot = (ContactFoot){.facet = -1, .distance = PETSC_MAX_REAL};
  if (s->n_facets) stack[depth++] = 0;
  while (depth > 0) {
    const PetscInt    b    = stack[--depth];
    const ContactBox *node = &s->box[b];

    if (BoxDistance(node, x) >= PetscSqr(foot->distance)) continue;
    if (!node->n) {
      const PetscInt near =
        BoxDistance(&s->box[b + 1], x) <= BoxDistance(&s->box[node->right], x) ? b + 1 : node->right;

      stack[depth++] = near == b + 1 ? node->right : b + 1;
      stack[depth++] = near;
    }
    for (PetscInt i = node->first; i < node->first + node->n; i++) {
      PetscReal       natural[2];
      const PetscReal here =
        FacetProject(s->facet[s->order[i]].n, (const double(*)[3])s->facet[s->order[i]].x, x, natural);

      if (here >= foot->distance) continue;
      *foot = (ContactFoot){.facet = s->order[i], .natural = {natural[0], natural[1]}, .distance = here};
    }
  }
}

void ContactNodes(const ContactShape *shape, PetscInt f, PetscReal x[][3])
{
  const ContactFacet *facet = &shape->surface->facet[f];

  for (int i = 0; i < facet->n; i++)
    for (int d = 0; d < 3; d++)
      x[i][d] = facet->x[i][d] + (shape->node ? shape->u[3 * shape->node[facet->node[i]] + d] : 0);
}
