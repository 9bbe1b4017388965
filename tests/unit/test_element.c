/*
   Unit tests of the element table: node order against real DMPlex meshes, shape functions, quadrature, rigid motions,
   uniform strain, and lumped mass. Lengths in m; E = 210 GPa, nu = 0.3, rho = 7800 kg/m^3.

   Every element is tested on a cell that an affine map made of the reference, and, of the second order, on a curved one.
*/
#include <petscdmplex.h>
#include <squeal/element.h>
#include "check.h"
#include "kernels/element/solidshape.h"

/* Natural coordinates of node i: the mean of those of its corners */
static void NodePlace(const Element *e, PetscInt i, double xi[3])
{
  static const double tet[4][3] = {
    {0, 0, 0},
    {1, 0, 0},
    {0, 1, 0},
    {0, 0, 1}
  };
  static const double wedge[6][3] = {
    {0, 0, -1},
    {1, 0, -1},
    {0, 1, -1},
    {0, 0, 1 },
    {1, 0, 1 },
    {0, 1, 1 }
  };
  int n = 0;

  xi[0] = xi[1] = xi[2] = 0;
  for (int c = 0; c < e->n_corners; c++) {
    if (!(e->at[i] & 1u << c)) continue;
    for (int k = 0; k < 3; k++)
      xi[k] += e->n_corners == 4 ? tet[c][k] : e->n_corners == 6 ? wedge[c][k] : (double)hex8_sign[c][k];
    n++;
  }
  for (int k = 0; k < 3; k++) xi[k] /= n;
}

/* Places of the nodes: x = A xi, and with curve (m) bent where the element has nodes on edges */
static void CellPlaces(const Element *e, double curve, double x[])
{
  static const double A[3][3] = {
    {1.1,  0.2, -0.1},
    {0.1,  0.9, 0.3 },
    {-0.2, 0.1, 1.3 }
  };

  for (PetscInt i = 0; i < e->n_nodes; i++) {
    double xi[3];

    NodePlace(e, i, xi);
    for (int d = 0; d < 3; d++) {
      x[3 * i + d] = A[d][0] * xi[0] + A[d][1] * xi[1] + A[d][2] * xi[2];
      if (e->n_nodes > e->n_corners) x[3 * i + d] += curve * xi[(d + 1) % 3] * xi[(d + 1) % 3];
    }
  }
}

/* Breaks when: N are not 1 at their own node and 0 at others, or dN is not the derivative of N */
static int TestShape(const Element *e)
{
  const Solid *s     = e->solid;
  const double xi[3] = {0.21, 0.33, 0.17};
  double       nodal = 0, slope = 0, N[27], dN[81], other[2][27], unused[81];
  int          failed = 0;

  for (PetscInt i = 0; i < e->n_nodes; i++) {
    double at[3];

    NodePlace(e, i, at);
    s->shape(at, N, dN);
    for (PetscInt a = 0; a < e->n_nodes; a++) nodal = fmax(nodal, fabs(N[a] - (a == i)));
  }
  s->shape(xi, N, dN);
  for (int k = 0; k < 3; k++) {
    for (int side = 0; side < 2; side++) {
      double at[3] = {xi[0], xi[1], xi[2]};

      at[k] += side ? 1e-5 : -1e-5;
      s->shape(at, other[side], unused);
    }
    for (PetscInt a = 0; a < e->n_nodes; a++)
      slope = fmax(slope, fabs((other[1][a] - other[0][a]) / 2e-5 - dN[3 * a + k]));
  }
  failed += CheckTrue("N_a at node b is delta_ab", nodal < 1e-14, nodal);
  failed += CheckTrue("dN is the derivative of N", slope < 1e-9, slope);
  return failed;
}

/* Breaks when: the quadrature does not integrate the volume, or u = G x (a rigid rotation too) does not give the forces
   of the uniform stress, f_a = stress int grad N_a dV; total is what they must add up to: nothing */
static int TestPatch(const Element *e, double curve)
{
  static const double G[3][3] = {
    {1,   2,  3},
    {-4,  5,  2},
    {0.5, -1, 2}
  };
  const Elasticity material = ElasticityFromEngineering(210e9, 0.3, 7800);
  static double    K[81 * 81], M[81 * 81];
  double           x[81], u[81], w[81] = {0}, energy = 0, exact, rigid = 0, size = 0, volume, quality, trace = 0;
  double           mass = 0, square = 0;
  const int        n      = 3 * (int)e->n_nodes;
  int              failed = 0;

  CellPlaces(e, curve, x);
  e->measure(e->solid, x, &volume, &quality);
  if (e->matrices(e->solid, x, &material, K, M)) return CheckTrue("the cell is accepted", 0, quality);
  for (int i = 0; i < n; i++) {
    const double *at = &x[i - i % 3];

    u[i] = G[i % 3][0] * at[0] + G[i % 3][1] * at[1] + G[i % 3][2] * at[2];
    w[i] = i % 3 == 0 ? 1 - 2 * at[1] : i % 3 == 1 ? 0.5 + 2 * at[0] : 3; /* translation, rotation about z */
  }
  for (int i = 0; i < n; i++) {
    double force = 0;

    for (int j = 0; j < n; j++) {
      energy += u[i] * K[n * i + j] * u[j];
      force += K[n * i + j] * w[j];
      size = fmax(size, fabs(K[n * i + j]));
      if (i % 3 == 0 && j % 3 == 0) mass += M[n * i + j];
    }
    rigid = fmax(rigid, fabs(force));
  }
  for (int i = 0; i < 3; i++) {
    trace += G[i][i];
    for (int j = 0; j < 3; j++) square += (G[i][j] + G[j][i]) * (G[i][j] + G[j][i]) / 4;
  }
  exact = volume * (material.lambda * trace * trace + 2 * material.shear * square);
  failed += CheckTrue("rigid motions give no force", rigid < 1e-13 * size, rigid / size);
  failed += CheckClose("energy of a uniform strain / exact", energy / exact, 1, 1e-13);
  failed += CheckClose("mass / (rho volume)", mass / (7800 * volume), 1, 1e-13);
  return failed;
}

/* Breaks when: a lumped mass is not positive, or they do not add up to the mass */
static int TestLump(const Element *e)
{
  const Elasticity material = ElasticityFromEngineering(210e9, 0.3, 7800);
  static double    K[81 * 81], M[81 * 81];
  double           x[81], lumped[27], least = HUGE_VAL, all = 0, volume, quality;
  int              failed = 0;

  CellPlaces(e, 0.1, x);
  e->measure(e->solid, x, &volume, &quality);
  if (e->matrices(e->solid, x, &material, K, M)) return CheckTrue("the cell is accepted", 0, quality);
  ElementLump(e, M, lumped);
  for (PetscInt a = 0; a < e->n_nodes; a++) {
    least = fmin(least, lumped[a]);
    all += lumped[a];
  }
  failed += CheckTrue("least lumped mass is positive", least > 0, least);
  failed += CheckClose("sum of the lumped masses / mass", all / (7800 * volume), 1, 1e-13);
  return failed;
}

/* Share of node i in the lumped mass of a cell without curves, in closed form: int N_a dV, which Simpson's rule gives of
   hex27, or int N_a^2 dV over its sum */
static double LumpedShare(const Element *e, PetscInt i)
{
  static const struct {
    const char *name;
    double      corner, side, face, inside; /* face: of wedge15 the sides between its triangles */
  } shares[] = {
    {"tet4",    1 / 4.0,   0,         0,          0         },
    {"tet10",   1 / 36.0,  4 / 27.0,  0,          0         },
    {"wedge6",  1 / 6.0,   0,         0,          0         },
    {"wedge15", 1 / 34.0,  4 / 51.0,  2 / 17.0,   0         },
    {"hex8",    1 / 8.0,   0,         0,          0         },
    {"hex20",   7 / 248.0, 2 / 31.0,  0,          0         },
    {"hex27",   1 / 216.0, 4 / 216.0, 16 / 216.0, 64 / 216.0},
  };
  const unsigned at = e->at[i];
  int            n = 0, row = 0;

  for (unsigned c = 0; c < 8; c++) n += at >> c & 1;
  while (strcmp(shares[row].name, e->name) != 0) row++;
  if (e->n_corners == 6 && (at == 9 || at == 18 || at == 36)) n = 4;
  return n == 1 ? shares[row].corner : n == 2 ? shares[row].side : n == 4 ? shares[row].face : shares[row].inside;
}

/* Breaks when: lumped masses are shared in another way, which keeps their sum, and with it weight and rigid motions */
static int TestShares(const Element *e)
{
  const Elasticity material = ElasticityFromEngineering(210e9, 0.3, 7800);
  static double    K[81 * 81], M[81 * 81];
  double           x[81], lumped[27], worst = 0, volume, quality;

  CellPlaces(e, 0, x);
  e->measure(e->solid, x, &volume, &quality);
  if (e->matrices(e->solid, x, &material, K, M)) return CheckTrue("the cell is accepted", 0, quality);
  ElementLump(e, M, lumped);
  for (PetscInt a = 0; a < e->n_nodes; a++)
    worst = fmax(worst, fabs(lumped[a] / (7800 * volume) / LumpedShare(e, a) - 1));
  return CheckTrue("lumped masses in closed form", worst < 1e-13, worst);
}

/* A mesh of one cell, whose corners are points 1 to n */
static PetscErrorCode CreateCell(const Element *e, DM *dm)
{
  PetscInt cell[8];
  DM       corners;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < e->n_corners; i++) cell[i] = i + 1;
  PetscCall(DMPlexInvertCell(e->shape, cell));
  PetscCall(DMPlexCreate(PETSC_COMM_SELF, &corners));
  PetscCall(DMSetDimension(corners, 3));
  PetscCall(DMCreateLabel(corners, "celltype"));
  PetscCall(DMPlexSetChart(corners, 0, e->n_corners + 1));
  PetscCall(DMPlexSetConeSize(corners, 0, e->n_corners));
  PetscCall(DMPlexSetCellType(corners, 0, e->shape));
  for (PetscInt i = 1; i <= e->n_corners; i++) PetscCall(DMPlexSetCellType(corners, i, DM_POLYTOPE_POINT));
  PetscCall(DMSetUp(corners));
  PetscCall(DMPlexSetCone(corners, 0, cell));
  PetscCall(DMPlexSymmetrize(corners));
  PetscCall(DMPlexStratify(corners));
  PetscCall(DMPlexInterpolate(corners, dm));
  PetscCall(DMDestroy(&corners));
  PetscFunctionReturn(0);
}

/* Breaks when: closure_order does not match DMPlex, so that cells are mirrored or twisted */
static PetscErrorCode TestClosure(const Element *e, int *failed)
{
  PetscInt *closure = NULL, n_points, vertex[8], n = 0;
  double    wrong = 0;
  DM        dm;

  PetscFunctionBeginUser;
  PetscCall(CreateCell(e, &dm));
  PetscCall(DMPlexGetTransitiveClosure(dm, 0, PETSC_TRUE, &n_points, &closure));
  for (PetscInt k = n_points - e->n_corners; k < n_points; k++) vertex[n++] = closure[2 * k] - 1;
  PetscCall(DMPlexRestoreTransitiveClosure(dm, 0, PETSC_TRUE, &n_points, &closure));
  for (PetscInt i = 0; i < e->n_corners; i++) wrong += vertex[e->closure_order[i]] != i;
  *failed += CheckTrue("corners in the order of the closure", wrong == 0, wrong);
  PetscCall(DMDestroy(&dm));
  PetscFunctionReturn(0);
}

/* Breaks when: a formulation is missing from the list for messages, or an unknown element is found */
static PetscErrorCode TestNames(int *failed)
{
  PetscInt n, i;
  char   **names;

  PetscFunctionBeginUser;
  PetscCall(PetscStrToArray(ElementFormulations(), ',', &n, &names));
  *failed += CheckClose("formulations listed", (double)n, 2, 0);
  for (i = 0; i < n; i++) {
    const char *name = names[i] + (names[i][0] == ' ');

    *failed += CheckTrue("a listed formulation is found", ElementFind(DM_POLYTOPE_HEXAHEDRON, 8, name) != NULL, 0);
  }
  PetscCall(PetscStrToArrayDestroy((int)n, names));
  *failed += CheckTrue("an unknown formulation is not", ElementFind(DM_POLYTOPE_HEXAHEDRON, 8, "none") == NULL, 0);
  *failed += CheckTrue("an unknown number of nodes is not", !ElementFind(DM_POLYTOPE_TETRAHEDRON, 5, "full"), 0);
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  int failed = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(TestNames(&failed));
  for (PetscInt i = 0; ElementGet(i); i++) {
    const Element *e = ElementGet(i);

    printf("--- %s\n", e->description);
    failed += TestShape(e);
    failed += TestPatch(e, 0);
    failed += TestPatch(e, 0.1);
    failed += TestLump(e);
    failed += TestShares(e);
    PetscCall(TestClosure(e, &failed));
  }
  PetscCall(PetscFinalize());
  printf("%d failed\n", failed);
  return failed ? 1 : 0;
}
