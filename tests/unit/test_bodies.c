/*
   Unit test of Bodies: K x, C x, masses, the advance of a step, and the element bound, on swept and other bodies.

   References: the assembled K, C and lumped M of the same operators, which know nothing of lines, layouts and copies.
   Fields are functions of the place, so that they are the same on any ranks.
*/
#include <petscksp.h>
#include "bodycase.h"
#include "check.h"

#define LUMPED "-operators_mass lumped -contact_kn 1e8 "
#define SMALL_DISC                                                                                                     \
  "-model_source rig -rig_disc_mesh axisymmetric -rig_disc_elements 3,24,2 -rig_pad false -disc_young 210e9 "          \
  "-disc_density 7800 -parts disc "
#define HUB          "-supports hub -hub_set disc_inner "
#define RIG          "-model_source rig -rig_pad_elements 3,4,2 -rig_beam_elements 5 -supports hub -hub_set disc_inner "
#define AXISYMMETRIC "-rig_disc_mesh axisymmetric -rig_disc_elements 4,30,2 "
#define PATCH        "-rig_disc_mesh patch -rig_disc_elements 6,24,2 "
#define VALUES                                                                                                         \
  "-disc_young 210e9 -disc_density 7800 -pad_young 25.1e9 -pad_density 2500 -beam_young 2100e9 -beam_density 78000 "
#define SPRINGS                                                                                                        \
  "-springs rows -rows_set beam_rows -rows_stiffness 1e6,8.422e6,3e6 -dashpots oil -oil_set pad_face "                 \
  "-oil_viscosity 10,20,30 "
#define DAMPING "-disc_beta 3e-7 -disc_alpha 20 -pad_beta 1e-7 -pad_alpha 50 -beam_beta 5e-7 -beam_alpha 70 "
#define UNEVEN                                                                                                         \
  "-springs rim -rim_set disc_face -rim_stiffness 1e6,3e6,2e6 -dashpots oil -oil_set disc_face -oil_viscosity 1,20,3 "

#define CLAMPED   LUMPED SMALL_DISC HUB
#define AXIAL     LUMPED SMALL_DISC HUB "-hub_fix z " UNEVEN DAMPING
#define HELD_IN_X LUMPED SMALL_DISC HUB "-hub_fix x -disc_beta 1e-7"
#define RIG_SWEPT LUMPED RIG AXISYMMETRIC VALUES SPRINGS DAMPING
#define RIG_PATCH LUMPED RIG PATCH VALUES SPRINGS DAMPING
#define UNDAMPED  LUMPED RIG PATCH VALUES

typedef struct {
  const char *name, *scene;
  PetscBool   swept; /* some body is */
  PetscBool   rigid; /* no spring */
} Scene;

/* Breaks when: a block of the stencil, its mirror, an end of a line, a part's beta, a spring, a basis or the sum over
   ranks is wrong */
static PetscErrorCode CheckApply(const Case *c, int *failed)
{
  PetscReal *x, *kx, *cx, error;
  Mat        K, C;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(c->layout->n, &x, c->layout->n, &kx, c->layout->n, &cx));
  PetscCall(FieldSet(c, 0, x));
  PetscCall(BodiesApply(c->bodies, x, kx, cx));
  PetscCall(OperatorsGetBodies(c->operators, NULL, &K, NULL, &C));
  PetscCall(StateCompare(c, K, x, kx, &error));
  *failed += CheckClose("  K x, relative", error, 0, 1e-12);
  PetscCall(StateCompare(c, C, x, cx, &error));
  *failed += CheckClose("  C x, relative", error, 0, 1e-12);
  PetscCall(PetscFree3(x, kx, cx));
  PetscFunctionReturn(0);
}

/* Breaks when: a product takes up what an earlier one left behind, or adds in an order of its own */
static PetscErrorCode CheckRepeat(const Case *c, int *failed)
{
  const PetscInt n = c->layout->n;
  PetscReal     *x, *y[6];
  PetscInt       n_different = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(7 * n, &x));
  for (int i = 0; i < 6; i++) y[i] = x + (i + 1) * n;
  for (int i = 0; i < 3; i++) {
    PetscCall(FieldSet(c, i == 1 ? 7 : 0, x));
    PetscCall(BodiesApply(c->bodies, x, y[2 * i], y[2 * i + 1]));
  }
  for (PetscInt i = 0; i < n; i++) n_different += y[0][i] != y[4][i] || y[1][i] != y[5][i];
  *failed += CheckClose("  K x, C x that differ when repeated", (double)n_different, 0, 0);
  PetscCall(PetscFree(x));
  PetscFunctionReturn(0);
}

/* Breaks when: masses lose a cell, count a shared vertex twice or stand elsewhere than its components */
static PetscErrorCode CheckMass(const Case *c, int *failed)
{
  const PetscReal *total = c->layout->total, *part = c->layout->part;
  PetscReal       *x, *mx, error, sum[2] = {0, 0};
  Mat              M;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(c->layout->n, &x, c->layout->n, &mx));
  PetscCall(FieldSet(c, 1, x));
  for (PetscInt i = 0; i < c->layout->n; i++) mx[i] = total[i] * x[i];
  PetscCall(OperatorsGetBodies(c->operators, NULL, NULL, &M, NULL));
  PetscCall(StateCompare(c, M, x, mx, &error));
  *failed += CheckClose("  M x, relative", error, 0, 1e-13);
  for (PetscInt v = 0; v < c->layout->n_vertices; v++) {
    if (c->layout->at[v] < 0) continue;
    sum[0] += part[c->layout->at[v]];
    if (c->layout->owned[v]) sum[1] += total[c->layout->at[v]];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  *failed += CheckClose("  mass in parts, of the total", sum[0] / sum[1], 1, 1e-13);
  PetscCall(PetscFree2(x, mx));
  PetscFunctionReturn(0);
}

/* x' A y of unknowns */
static PetscErrorCode Product(const Case *c, Mat A, const PetscReal x[], const PetscReal y[], PetscReal *product)
{
  Vec a, b, Ab;

  PetscFunctionBeginUser;
  PetscCall(OperatorsCreateVec(c->operators, &a));
  PetscCall(VecDuplicate(a, &b));
  PetscCall(VecDuplicate(a, &Ab));
  PetscCall(StateRestrict(c, x, a));
  PetscCall(StateRestrict(c, y, b));
  if (A) PetscCall(MatMult(A, b, Ab));
  PetscCall(VecDot(a, Ab, product));
  PetscCall(VecDestroy(&a));
  PetscCall(VecDestroy(&b));
  PetscCall(VecDestroy(&Ab));
  PetscFunctionReturn(0);
}

/* Breaks when: a sum misses a row, counts a copy twice, or takes another velocity */
static PetscErrorCode CheckSums(const Case *c, const PetscReal u[], const PetscReal v[], const PetscReal old[],
                                const BodiesSums *sums, int *failed)
{
  PetscReal s[4] = {sums->kinetic, sums->strain, sums->damping_old, sums->damping}, expected[4];
  Mat       K, M, C;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, s, 4, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  PetscCall(OperatorsGetBodies(c->operators, NULL, &K, &M, &C));
  PetscCall(Product(c, M, v, v, &expected[0]));
  PetscCall(Product(c, K, u, u, &expected[1]));
  PetscCall(Product(c, C, v, old, &expected[2]));
  PetscCall(Product(c, C, v, v, &expected[3]));
  *failed += CheckClose("  kinetic", s[0], 0.5 * expected[0], 1e-12 * expected[0]);
  *failed += CheckClose("  strain", s[1], 0.5 * expected[1], 1e-12 * expected[1]);
  *failed += CheckClose("  damping of the velocity before", s[2], expected[2], 1e-12 * expected[3]);
  *failed += CheckClose("  damping", s[3], expected[3], 1e-12 * expected[3]);
  PetscFunctionReturn(0);
}

/* -f = K (u + dt v) + C v of the assembled matrices, relative */
static PetscErrorCode ForceCompare(const Case *c, PetscReal dt, const PetscReal u[], const PetscReal v[],
                                   const PetscReal f[], PetscReal *error)
{
  Vec       vec, sum, part;
  PetscReal norm;
  Mat       K, C;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetBodies(c->operators, NULL, &K, NULL, &C));
  PetscCall(OperatorsCreateVec(c->operators, &vec));
  PetscCall(VecDuplicate(vec, &sum));
  PetscCall(VecDuplicate(vec, &part));
  PetscCall(StateRestrict(c, u, vec));
  PetscCall(MatMult(K, vec, sum));
  PetscCall(StateRestrict(c, v, vec));
  PetscCall(MatMult(K, vec, part));
  PetscCall(VecAXPY(sum, dt, part));
  if (C) PetscCall(MatMultAdd(C, vec, sum, sum));
  PetscCall(VecNorm(sum, NORM_INFINITY, &norm));
  PetscCall(StateRestrict(c, f, vec));
  PetscCall(VecAXPY(vec, 1, sum));
  PetscCall(VecNorm(vec, NORM_INFINITY, error));
  *error /= norm;
  PetscCall(VecDestroy(&vec));
  PetscCall(VecDestroy(&sum));
  PetscCall(VecDestroy(&part));
  PetscFunctionReturn(0);
}

/* Breaks when: ku is not carried along, the lagged damping is missing, the padding is touched, or copies differ */
static PetscErrorCode CheckAdvance(const Case *c, int *failed)
{
  const PetscReal dt = 1e-7, *minv = c->layout->minv;
  const PetscInt  n = c->layout->n;
  PetscReal      *u, *v, *ku, *f, *old, *fresh, error, largest = 0, padding = 0;
  PetscBool      *is_padding;
  PetscInt        n_different;
  BodiesSums      sums;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc7(n, &u, n, &v, n, &ku, n, &f, n, &old, n, &fresh, n, &is_padding));
  PetscCall(FieldSet(c, 2, u));
  for (PetscInt i = 0; i < n; i++) u[i] *= 1e-6;
  PetscCall(FieldSet(c, 3, v));
  PetscCall(BodiesSetState(c->bodies, u, v, ku));
  for (PetscInt step = 0; step < 5; step++) {
    PetscCall(PetscArraycpy(old, v, n));
    PetscCall(FieldSet(c, 4 + step, v));
    PetscCall(BodiesAdvance(c->bodies, &(BodiesStep){dt, u, v, ku, f}, &sums));
    PetscCall(ForceCompare(c, dt, u, v, f, &error));
    if (step == 4) PetscCall(CheckSums(c, u, v, old, &sums, failed));
    for (PetscInt i = 0; i < n; i++) u[i] += dt * v[i];
  }
  *failed += CheckClose("  forces of the fifth step, relative", error, 0, 1e-12);
  PetscCall(BodiesSetState(c->bodies, u, v, fresh));
  for (PetscInt i = 0; i < n; i++) is_padding[i] = PETSC_TRUE;
  for (PetscInt i = 0; i < 3 * c->layout->n_vertices; i++)
    if (c->layout->at[i / 3] >= 0) is_padding[c->layout->at[i / 3] + i % 3 * c->layout->step[i / 3]] = PETSC_FALSE;
  error = 0;
  for (PetscInt i = 0; i < n; i++) {
    error   = PetscMax(error, PetscAbsReal(ku[i] - fresh[i]));
    largest = PetscMax(largest, PetscAbsReal(fresh[i]));
    if (is_padding[i])
      padding = PetscMax(padding, PetscAbsReal(u[i]) + PetscAbsReal(v[i]) + PetscAbsReal(ku[i]) + PetscAbsReal(f[i]) +
                                    PetscAbsReal(minv[i]));
  }
  *failed += CheckClose("  ku carried along against ku anew, relative", error / largest, 0, 1e-13);
  *failed += CheckClose("  padding", padding, 0, 0);
  PetscCall(CopiesCompare(c, f, &n_different));
  *failed += CheckClose("  components that differ from rank to rank", (double)n_different, 0, 0);
  PetscCall(PetscFree7(u, v, ku, f, old, fresh, is_padding));
  PetscFunctionReturn(0);
}

/* Breaks when: the bound of single elements is below a quotient of the assembled matrices (200 power iterations) or
   out of all proportion */
static PetscErrorCode CheckBound(const Case *c, PetscReal s, int *failed)
{
  const PetscReal *minv = c->layout->minv;
  PetscReal       *x, *kx, *cx, bound, quotient = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(c->layout->n, &x, c->layout->n, &kx, c->layout->n, &cx));
  PetscCall(FieldSet(c, 5, x));
  for (int i = 0; i < 200; i++) {
    PetscReal norm = 0;

    PetscCall(BodiesApply(c->bodies, x, kx, cx));
    for (PetscInt k = 0; k < c->layout->n; k++) {
      x[k] = minv[k] * (kx[k] + s * cx[k]);
      norm = PetscMax(norm, PetscAbsReal(x[k]));
    }
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &norm, 1, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
    quotient = norm;
    for (PetscInt k = 0; k < c->layout->n; k++) x[k] /= norm;
  }
  PetscCall(BodiesGetElementBound(c->bodies, s, &bound));
  *failed +=
    CheckTrue("  bound of the elements over omega^2", bound >= quotient && bound < 4 * quotient, bound / quotient);
  PetscCall(PetscFree3(x, kx, cx));
  PetscFunctionReturn(0);
}

/* Breaks when: displacements are not taken relative to a node before they meet the stiffness (Cartesian components
   only: cylindrical ones round the translation itself); springs alone resist it */
static PetscErrorCode CheckTranslation(const Case *c, int *failed)
{
  static const PetscReal shift[3] = {0.3, -0.7, 1.1}; /* m */
  PetscReal             *u, *v, *ku, largest = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(c->layout->n, &u, c->layout->n, &v, c->layout->n, &ku));
  for (PetscInt i = 0; i < c->layout->n_vertices; i++)
    if (c->layout->at[i] >= 0) LayoutSet(c->layout, i, shift, u);
  PetscCall(BodiesSetState(c->bodies, u, v, ku));
  for (PetscInt i = 0; i < c->layout->n; i++) largest = PetscMax(largest, PetscAbsReal(ku[i]));
  *failed += CheckClose("  forces of a translation, N", largest, 0, 0);
  PetscCall(PetscFree3(u, v, ku));
  PetscFunctionReturn(0);
}

/* Breaks when: a held direction keeps its inverse mass, or another one loses it */
static PetscErrorCode CheckHold(const Case *c, int *failed)
{
  const PetscReal *minv = c->layout->minv, *total = c->layout->total;
  PetscInt         n_before = 0, n_after = 0, vertex = -1;

  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < c->layout->n_vertices && vertex < 0; v++)
    if (c->layout->at[v] >= 0 && minv[c->layout->at[v] + c->layout->step[v]] > 0) vertex = v;
  if (vertex < 0) PetscFunctionReturn(0); /* a rank whose vertices are all held */
  for (PetscInt i = 0; i < c->layout->n; i++) n_before += minv[i] > 0 && PetscAbsReal(minv[i] * total[i] - 1) < 1e-15;
  PetscCall(BodiesHold(c->bodies, vertex, 1));
  for (PetscInt i = 0; i < c->layout->n; i++) n_after += minv[i] > 0 && PetscAbsReal(minv[i] * total[i] - 1) < 1e-15;
  *failed += CheckTrue("  held direction", minv[c->layout->at[vertex] + c->layout->step[vertex]] == 0,
                       minv[c->layout->at[vertex] + c->layout->step[vertex]]);
  *failed += CheckClose("  directions that move", (double)n_after, (double)(n_before - 1), 0);
  PetscFunctionReturn(0);
}

/* Whether some body has rows of nodes on some rank */
static PetscErrorCode CaseIsSwept(const Case *c, PetscBool *swept)
{
  PetscFunctionBeginUser;
  *swept = PETSC_FALSE;
  for (PetscInt v = 0; v < c->layout->n_vertices; v++)
    if (c->layout->at[v] >= 0 && c->layout->step[v] != 1) *swept = PETSC_TRUE;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, swept, 1, MPIU_BOOL, MPI_LOR, PETSC_COMM_WORLD));
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckScene(const Scene *scene, const char options[], PetscBool swept, int *failed)
{
  Case      c = {0};
  PetscBool is_swept;

  PetscFunctionBeginUser;
  printf("%s %s\n", scene->name, options);
  PetscCall(CaseCreate(scene->scene, options, &c));
  PetscCall(CaseIsSwept(&c, &is_swept));
  *failed += CheckClose("  swept", is_swept, swept, 0);
  PetscCall(CheckApply(&c, failed));
  PetscCall(CheckRepeat(&c, failed));
  PetscCall(CheckMass(&c, failed));
  PetscCall(CheckAdvance(&c, failed));
  PetscCall(CheckBound(&c, 3e-7, failed));
  if (scene->rigid && options[0]) PetscCall(CheckTranslation(&c, failed));
  PetscCall(CheckHold(&c, failed));
  PetscCall(CaseDestroy(&c));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  static const Scene scene[] = {
    {"disc, clamped",             CLAMPED,   PETSC_TRUE,  PETSC_TRUE },
    {"disc, held along its axis", AXIAL,     PETSC_TRUE,  PETSC_FALSE},
    {"disc, held in x",           HELD_IN_X, PETSC_FALSE, PETSC_TRUE },
    {"axisymmetric rig",          RIG_SWEPT, PETSC_TRUE,  PETSC_FALSE},
    {"patch rig",                 RIG_PATCH, PETSC_TRUE,  PETSC_FALSE},
    {"patch rig without damping", UNDAMPED,  PETSC_TRUE,  PETSC_TRUE },
  };
  int failed = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(scene); i++) {
    PetscCall(CheckScene(&scene[i], "", scene[i].swept, &failed));
    PetscCall(CheckScene(&scene[i], "-dynamics_kernel general", PETSC_FALSE, &failed));
  }
  PetscCall(PetscFinalize());
  return failed ? 1 : 0;
}
