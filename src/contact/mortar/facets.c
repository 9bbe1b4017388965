/*
   Integrals of mortar contact over one facet of the slave, and its dual functions phi_j = sum_k A_jk N~_k with

      int phi_j N~_k dA = delta_jk D_j,   A = D M^-1,   D_j = int N~_j dA,   M_jk = int N~_j N~_k dA,

   all integrals over the part of the facet that lies over the master. sum_j phi_j = 1 since M 1 = D. Where that part is
   a sliver M may be singular. With R = S M S, S_j = M_jj^-1/2, = Q L Q', whose eigenvalues sum up to the nodes' number,

      A = D S Q F Q' S,   F = L^3 / (L^4 + c^4),   c = 1e-7,

   which is M^-1 to c^4 / L^4 (whole facets have L >= 0.001) and goes to 0 with L, smoothly. What sum_j phi_j then lacks
   of 1 is added to the phi_j of the largest D_j.
*/
#include "mortarimpl.h"
#include "base/algebra/dense.h"
#include <petscdt.h>

#define FILTER 1e-7 /* c */

/* Points along a side for maps that are not affine, whose integrands are no polynomials in the plane */
#define MORTAR_CURVED MORTAR_RULES

PetscErrorCode MortarCreate(const ContactSurface *slave, const ContactSurface *master, PetscReal tolerance,
                            Mortar *mortar)
{
  PetscBool has[FACET_NODES + 1] = {PETSC_FALSE};

  PetscFunctionBeginUser;
  *mortar = (Mortar){.slave = slave, .master = master, .tolerance = tolerance};
  for (PetscInt f = 0; f < slave->n_facets; f++) has[slave->facet[f].n] = PETSC_TRUE;
  mortar->alpha = SegmentAlpha(has[6], has[8]);
  for (int n = 2; n <= MORTAR_RULES; n++) {
    PetscQuadrature  q;
    const PetscReal *x, *w;
    PetscInt         n_points;

    PetscCall(PetscDTStroudConicalQuadrature(2, 1, n, -1, 1, &q));
    PetscCall(PetscQuadratureGetData(q, NULL, NULL, &n_points, &x, &w));
    PetscCall(PetscMalloc1(n_points, &mortar->point[n]));
    for (PetscInt i = 0; i < n_points; i++) {
      for (int d = 0; d < 2; d++) mortar->point[n][i][d] = (1 + x[2 * i + d]) / 2;
      mortar->point[n][i][2] = w[i] / 4;
    }
    mortar->rule[n] = (SegmentRule){(int)n_points, (const double(*)[3])mortar->point[n]};
    PetscCall(PetscQuadratureDestroy(&q));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode MortarDestroy(Mortar *mortar)
{
  PetscFunctionBeginUser;
  for (int n = 2; n <= MORTAR_RULES; n++) PetscCall(PetscFree(mortar->point[n]));
  PetscCall(PetscFree(mortar->near.facet));
  PetscFunctionReturn(0);
}

/* Adds to the row of A of the largest D_j what its columns lack of a sum of 1 */
static void DualComplete(int n, MortarFacet *facet)
{
  int most = 0;

  for (int j = 1; j < n; j++)
    if (facet->sums.d[j] > facet->sums.d[most] * (1 + 1e-6)) most = j;
  for (int k = 0; k < n; k++) {
    PetscReal sum = 1;

    for (int j = 0; j < n; j++) sum -= facet->dual[j][k];
    facet->dual[most][k] += sum;
  }
}

/* A, from D and M */
static PetscErrorCode DualMake(int n, MortarFacet *facet)
{
  PetscReal R[FACET_NODES * FACET_NODES], eigenvalue[FACET_NODES], scale[FACET_NODES], most = 0;

  PetscFunctionBeginUser;
  for (int j = 0; j < n; j++) most = PetscMax(most, facet->sums.mass[j][j]);
  /* a node whose function is rounding there takes no part */
  for (int j = 0; j < n; j++)
    scale[j] = facet->sums.mass[j][j] > 1e-30 * most ? 1 / PetscSqrtReal(facet->sums.mass[j][j]) : 0;
  for (int k = 0; k < n * n; k++) {
    R[k] = facet->sums.mass[k / n][k % n] * scale[k / n] * scale[k % n];
    if (R[k] == 0) R[k] = k / n == k % n;
    facet->dual[k / n][k % n] = 0;
  }
  PetscCall(DenseSymmetricEigen(n, R, NULL, eigenvalue, NULL));
  for (int i = 0; i < n; i++) {
    const PetscReal L = PetscMax(0, eigenvalue[i]), F = L * L * L / (PetscSqr(L * L) + PetscSqr(FILTER * FILTER));

    for (int j = 0; j < n; j++)
      for (int k = 0; k < n; k++)
        facet->dual[j][k] += facet->sums.d[j] * scale[j] * R[i * n + j] * F * R[i * n + k] * scale[k];
  }
  DualComplete(n, facet);
  PetscFunctionReturn(0);
}

/* Adds the segments with one facet of the master, if there are any */
static PetscErrorCode BlockAdd(Mortar *mortar, const SegmentFacet *s, const double normal[3], PetscInt f,
                               const SegmentFacet *m, MortarFacet *facet)
{
  const int        degree = SegmentDegree(s->nodes) + PetscMax(SegmentDegree(s->nodes), SegmentDegree(m->nodes));
  const int        points = SegmentIsAffine(s) && SegmentIsAffine(m) ? degree / 2 + 1 : MORTAR_CURVED;
  const PetscReal  before = facet->sums.area;
  MortarBlock     *block;
  const SegmentCut cut = {s, m, normal, mortar->alpha, &mortar->rule[points]};

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(&facet->sums.cross[0][0], FACET_NODES * FACET_NODES));
  for (int i = 0; i < s->n; i++)
    for (int j = 0; j < m->n; j++)
      if (!SegmentAddPieces(&cut, i, j, &facet->sums)) mortar->n_failed++;
  if (facet->sums.area == before) PetscFunctionReturn(0);
  if (facet->n == facet->room) {
    facet->room = 2 * facet->room + 16;
    PetscCall(PetscRealloc(sizeof(MortarBlock) * (size_t)facet->room, &facet->block));
  }
  block        = &facet->block[facet->n++];
  block->facet = f;
  PetscCall(PetscArraycpy(&block->cross[0][0], &facet->sums.cross[0][0], FACET_NODES * FACET_NODES));
  PetscFunctionReturn(0);
}

PetscErrorCode MortarIntegrate(Mortar *mortar, PetscInt f, MortarFacet *facet)
{
  const ContactShape  rest  = {.surface = mortar->master};
  const ContactFacet *slave = &mortar->slave->facet[f];
  PetscReal           size  = 0;
  double              e[3][3], origin[3];
  SegmentFacet        s, m;

  PetscFunctionBeginUser;
  facet->n = 0;
  PetscCall(PetscMemzero(&facet->sums, sizeof(facet->sums)));
  FanAxes(slave->n, (const double(*)[3])slave->x, e, origin);
  SegmentFacetMake(slave->n, (const double(*)[3])slave->x, (const double(*)[3])e, origin, &s);
  for (int i = 0; i < slave->n; i++) {
    const PetscReal away[3] = {slave->x[i][0] - origin[0], slave->x[i][1] - origin[1], slave->x[i][2] - origin[2]};

    size = PetscMax(size, Vec3Length(away));
  }
  mortar->near.n = 0;
  PetscCall(ContactFacetsNear(&rest, mortar->master->box, origin, size + mortar->tolerance, &mortar->near));
  for (PetscInt i = 0; i < mortar->near.n; i++) {
    const ContactFacet *master = &mortar->master->facet[mortar->near.facet[i]];

    if (!ContactFacetFaces(master, (const double(*)[3])e, origin, 2 * size, mortar->tolerance)) continue;
    if (-Vec3Dot(master->normal, e[2]) < mortar->facing) continue;
    SegmentFacetMake(master->n, (const double(*)[3])master->x, (const double(*)[3])e, origin, &m);
    PetscCall(BlockAdd(mortar, &s, e[2], mortar->near.facet[i], &m, facet));
  }
  if (facet->n) PetscCall(DualMake(slave->n, facet));
  PetscFunctionReturn(0);
}
