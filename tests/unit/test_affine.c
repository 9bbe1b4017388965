/*
   Unit test of operators/: matrices that follow the parameters of a scene, on one and on several ranks.

   A coarse brake (disc, pad, beam) is set up with one set of values, then given those of another set; the reference is
   the same brake set up from options with the other set. What the numbers themselves should be is told by the cases
   sliding_block and massi2005_*.
*/
#include "base/algebra/matrixadd.h"
#include "brake.h"
#include "check.h"
#include "petscmain.h"
#include "scratch.h"
#include <string.h>

/* A scene and the two sets of values between which it goes, forth and back */
typedef struct {
  const char *name, *scene, *values[2];
} Scene;

/* clang-format off */
static const Scene scenes[] = {
  {"penalty", BRAKE SLIP,
   {BODIES_1 BEAM_1 "-contact_mu 0.5", BODIES_2 BEAM_2 "-contact_mu -0.3"}},
  {"friction comes", BRAKE SLIP,
   {BODIES_1 BEAM_1, BODIES_1 BEAM_2 "-contact_mu 0.5"}},
  {"damped, speed", BRAKE SLIP DAMPED,
   {BODIES_1 BEAM_1 "-contact_mu 0.5 -contact_speed 2 -contact_force 50 -oil_viscosity 1,1,0",
    BODIES_2 BEAM_2 "-contact_mu -0.4 -contact_speed 3 " ROLLING}},
  {"damped, rotation", BRAKE DAMPED,
   {BODIES_1 BEAM_XYZ "-contact_mu 0.5 -contact_rotation 0,0,4 -contact_force 50 -oil_viscosity 3,3,0",
    BODIES_1 BEAM_XYZ "-contact_mu 0 -contact_rotation 0,0,9 -rows_stiffness 5,6,7 " ROLLING}},
  {"damping comes", BRAKE SLIP,
   {BODIES_1 BEAM_1, BODIES_1 BEAM_1 "-beam_alpha 3"}},
  {"constraint", BRAKE SLIP CONSTRAINED,
   {BODIES_1 BEAM_1 "-contact_mu 0.5", BODIES_2 BEAM_2 "-contact_mu 0.2"}},
  {"constraint, friction comes", BRAKE SLIP CONSTRAINED,
   {BODIES_1 BEAM_1, BODIES_2 BEAM_2 "-contact_mu 0.2"}},
  {"constraint, damped", BRAKE SLIP DAMPED CONSTRAINED,
   {BODIES_1 BEAM_1 "-contact_mu 0.5 -contact_speed 2 -contact_force 50 -oil_viscosity 1,1,0",
    BODIES_2 BEAM_2 "-contact_mu -0.4 -contact_speed 3 " ROLLING}},
  {"two interfaces", BRAKE SLIP TWO_CONTACTS,
   {BODIES_1 BEAM_1 "-contact_mu 0.5 -more_mu -0.1 -more_kn 3e7", BODIES_2 BEAM_2 "-contact_mu 0.2 -more_kn 2e8"}},
  {"two interfaces, one constrained", BRAKE SLIP TWO_CONTACTS CONSTRAINED,
   {BODIES_1 BEAM_1 "-contact_mu 0.5 -more_kn 3e7", BODIES_2 BEAM_2 "-contact_mu 0.2 -more_mu 0.1 -more_kn 2e8"}},
};
/* clang-format on */

/* Everything that a pencil hands out */
typedef struct {
  PencilParts    all;
  PencilMatrices pencil, frictionless;
} Matrices;

static PetscErrorCode MatricesGet(Pencil o, Matrices *m)
{
  PetscFunctionBeginUser;
  PetscCall(PencilGetParts(o, &m->all));
  PetscCall(PencilGetMatrices(o, &m->pencil));
  PetscCall(PencilGetFrictionless(o, &m->frictionless));
  PetscFunctionReturn(0);
}

/* |A - B| / |B|, 0 when both are NULL, 1 when one is */
static PetscErrorCode MatDistance(Mat A, Mat B, PetscReal *distance)
{
  PetscReal norm;
  Mat       D;

  PetscFunctionBeginUser;
  *distance = !A && !B ? 0 : 1;
  if (!A || !B) PetscFunctionReturn(0);
  PetscCall(MatDuplicate(A, MAT_COPY_VALUES, &D));
  PetscCall(MatAXPY(D, -1, B, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MatNorm(D, NORM_FROBENIUS, distance));
  PetscCall(MatNorm(B, NORM_FROBENIUS, &norm));
  *distance /= norm;
  PetscCall(MatDestroy(&D));
  PetscFunctionReturn(0);
}

/* Breaks when: a matrix keeps a part at the old values, a pattern lacks a part that comes, or C, H or the symmetry do
   not come and go with damping and friction. Reference: the same scene from its options */
static PetscErrorCode TestSame(Pencil o, Pencil reference, int *failed)
{
  static const char *const names[] = {"K",
                                      "M",
                                      "C",
                                      "H",
                                      "K of the pencil",
                                      "M of the pencil",
                                      "C of the pencil",
                                      "K without friction",
                                      "M without friction"};
  Matrices                 a, b;

  PetscFunctionBeginUser;
  PetscCall(MatricesGet(o, &a));
  PetscCall(MatricesGet(reference, &b));
  const Mat A[] = {a.all.K,    a.all.M,    a.all.C,          a.all.H,         a.pencil.K,
                   a.pencil.M, a.pencil.C, a.frictionless.K, a.frictionless.M};
  const Mat B[] = {b.all.K,    b.all.M,    b.all.C,          b.all.H,         b.pencil.K,
                   b.pencil.M, b.pencil.C, b.frictionless.K, b.frictionless.M};

  for (size_t i = 0; i < sizeof(A) / sizeof(A[0]); i++) {
    PetscReal distance;

    PetscCall(MatDistance(A[i], B[i], &distance));
    *failed += CheckClose(names[i], distance, 0, 1e-14);
  }
  *failed += CheckClose("mu", a.all.mu, b.all.mu, 0);
  *failed += CheckTrue("symmetric alike", a.pencil.symmetric == b.pencil.symmetric, a.pencil.symmetric);
  *failed += CheckTrue("unsymmetric with mu", a.pencil.symmetric == (a.all.mu == 0), a.all.mu);
  PetscFunctionReturn(0);
}

/* Breaks when: the sums or the projection differ from the definition of the terms. Reference: sum_t c_t A_t by
   MatAXPY */
static PetscErrorCode TestTerms(Pencil o, int *failed)
{
  const OperatorsTerm *term;
  const PetscReal     *p;
  PetscInt             n;
  PetscReal            distance;
  PencilMatrices       pencil;

  PetscFunctionBeginUser;
  PetscCall(PencilGetParameters(o, NULL, NULL, &p));
  PetscCall(PencilGetTerms(o, &n, &term));
  PetscCall(PencilGetMatrices(o, &pencil));
  for (int kind = 0; kind < 3; kind++) {
    const Mat reference = kind == OPERATORS_STIFFNESS ? pencil.K : (kind == OPERATORS_MASS ? pencil.M : pencil.C);
    Mat       sum;

    if (!reference) continue;
    PetscCall(MatDuplicate(pencil.K, MAT_DO_NOT_COPY_VALUES, &sum));
    for (PetscInt t = 0; t < n; t++)
      if ((int)term[t].kind == kind)
        PetscCall(MatAXPY(sum, OperatorsTermCoefficient(&term[t], p), term[t].A, DIFFERENT_NONZERO_PATTERN));
    PetscCall(MatDistance(sum, reference, &distance));
    *failed += CheckClose(kind == OPERATORS_STIFFNESS ? "sum of the terms of K" : "sum of the terms of C or M",
                          distance, 0, 1e-14);
    PetscCall(MatDestroy(&sum));
  }
  PetscFunctionReturn(0);
}

/* Breaks when: a factor, its power or its sign is left out of a derivative. Reference: central differences */
static PetscErrorCode TestDerivatives(Pencil o, int *failed)
{
  const OperatorsTerm *term;
  const PetscReal     *present;
  PetscInt             n_parameters, n, n_tested = 0;
  PetscReal            p[64], worst = 0;

  PetscFunctionBeginUser;
  PetscCall(PencilGetParameters(o, &n_parameters, NULL, &present));
  PetscCall(PencilGetTerms(o, &n, &term));
  PetscCall(PetscArraycpy(p, present, n_parameters));
  for (PetscInt t = 0; t < n; t++)
    for (PetscInt j = 0; j < n_parameters; j++) {
      const PetscReal value = p[j], step = 1e-5 * (value != 0 ? PetscAbsReal(value) : 1);
      const PetscReal d = OperatorsTermDerivative(&term[t], p, j);
      PetscReal       difference;

      p[j]       = value + step;
      difference = OperatorsTermCoefficient(&term[t], p);
      p[j]       = value - step;
      difference = (difference - OperatorsTermCoefficient(&term[t], p)) / (2 * step);
      p[j]       = value;
      n_tested += d != 0;
      worst = PetscMax(worst, PetscAbsReal(difference - d) / PetscMax(PetscAbsReal(d), PETSC_SMALL));
    }
  *failed += CheckClose("derivatives of the coefficients", worst, 0, 1e-8);
  *failed += CheckTrue("derivatives that are not zero", n_tested >= 10, (double)n_tested);
  PetscFunctionReturn(0);
}

/* |(N - mu T) u| / |u| over the interface */
static PetscErrorCode ConstraintResidual(const Chain *chain, PetscReal mu, Vec u, PetscReal *residual)
{
  PetscReal norm;
  Vec       r;

  PetscFunctionBeginUser;
  PetscCall(ChainConstrain(chain, mu, u, &r));
  PetscCall(VecNorm(r, NORM_2, residual));
  PetscCall(VecNorm(u, NORM_2, &norm));
  *residual /= norm;
  PetscCall(VecDestroy(&r));
  PetscFunctionReturn(0);
}

/* y' A x */
static PetscErrorCode Bilinear(Mat A, Vec y, Vec x, PetscReal *product)
{
  Vec z;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(y, &z));
  PetscCall(MatMult(A, x, z));
  PetscCall(VecDot(z, y, product));
  PetscCall(VecDestroy(&z));
  PetscFunctionReturn(0);
}

/* Breaks when: a null space does not follow mu, the pencil is not the projection between them, or a vector is not got
    back from its expansion. Reference: N u = 0 and (N - mu T) y = 0 of the contact itself; y' (K + mu H) u of all
   unknowns */
static PetscErrorCode TestProjection(Chain *chain, PetscBool constrained, int *failed)
{
  PetscReal residual, full, reduced, size, friction = 0;
  Matrices  m;
  Vec       q[2], u[2], back;

  PetscFunctionBeginUser;
  PetscCall(MatricesGet(chain->pencil, &m));
  PetscCall(MatCreateVecs(m.pencil.K, &back, NULL));
  for (int left = 0; left < 2; left++) {
    PetscCall(VecDuplicate(back, &q[left]));
    PetscCall(VecSetRandom(q[left], NULL));
    PetscCall(OperatorsCreateVec(chain->operators, &u[left]));
    PetscCall(PencilExpand(chain->pencil, (PetscBool)left, q[left], u[left]));
    PetscCall(PencilRestrict(chain->pencil, u[left], back));
    PetscCall(VecAXPY(back, -1, q[left]));
    PetscCall(VecNorm(back, NORM_INFINITY, &residual));
    *failed += CheckClose("unknowns of the pencil back from their expansion", residual, 0, 1e-14);
    if (!constrained) continue;
    PetscCall(ConstraintResidual(chain, left ? m.all.mu : 0, u[left], &residual));
    *failed += CheckClose(left ? "(N - mu T) y = 0" : "N u = 0", residual, 0, 1e-15);
  }
  PetscCall(Bilinear(m.all.K, u[1], u[0], &full));
  if (m.all.H) PetscCall(Bilinear(m.all.H, u[1], u[0], &friction));
  PetscCall(Bilinear(m.pencil.K, q[1], q[0], &reduced));
  PetscCall(Bilinear(m.all.K, u[0], u[0], &size));
  *failed += CheckClose("y' (K + mu H) u", (reduced - full - m.all.mu * friction) / size, 0, 1e-13);
  for (int left = 0; left < 2; left++) {
    PetscCall(VecDestroy(&q[left]));
    PetscCall(VecDestroy(&u[left]));
  }
  PetscCall(VecDestroy(&back));
  PetscFunctionReturn(0);
}

/* Frees K with friction and without, but for the upper half of what a shift makes of it; on one rank */
static PetscErrorCode ReleaseHalf(Pencil pencil)
{
  PencilMatrices m;
  PetscReal      K, M;
  PetscBool      sequential, added;
  Mat            half;

  PetscFunctionBeginUser;
  PetscCall(PencilGetFrictionless(pencil, &m));
  PetscCall(PetscObjectTypeCompare((PetscObject)m.K, MATSEQAIJ, &sequential));
  if (!sequential) PetscFunctionReturn(0);
  PetscCall(MatNorm(m.K, NORM_FROBENIUS, &K));
  PetscCall(MatNorm(m.M, NORM_FROBENIUS, &M));
  PetscCall(MatConvert(m.K, MATSEQSBAIJ, MAT_INITIAL_MATRIX, &half));
  PetscCall(MatrixAdd(-K / M, m.M, half, &added));
  PetscCheck(added, PETSC_COMM_SELF, PETSC_ERR_PLIB, "M is not in the pattern of K");
  PetscCall(PencilReleaseSymmetric(pencil, half, K / M));
  PetscCall(MatDestroy(&half));
  PetscFunctionReturn(0);
}

/* Breaks when: a pencil whose terms are gone lacks a matrix at its point, K that was freed and is made again too, or moves
   all the same. Reference: the other chain, moved to that point */
static PetscErrorCode TestReleased(Chain chain[2], const PetscReal away[], int *failed)
{
  const OperatorsTerm *term;
  const PetscReal     *p;
  PetscInt             n;
  Scratch              keep = {.code = 0};
  PetscErrorCode       moved, terms;

  PetscFunctionBeginUser;
  PetscCall(PencilGetParameters(chain[0].pencil, NULL, NULL, &p));
  PetscCall(PencilSetParameters(chain[1].pencil, p));
  PetscCall(PencilReleaseTerms(chain[0].pencil));
  PetscCall(TestSame(chain[0].pencil, chain[1].pencil, failed));
  PetscCall(PencilReleaseSymmetric(chain[0].pencil, NULL, 0));
  PetscCall(TestSame(chain[0].pencil, chain[1].pencil, failed));
  PetscCall(ReleaseHalf(chain[0].pencil));
  PetscCall(TestSame(chain[0].pencil, chain[1].pencil, failed));
  PetscCall(PetscPushErrorHandler(ScratchKeepError, &keep));
  moved = PencilSetParameters(chain[0].pencil, away);
  terms = PencilGetTerms(chain[0].pencil, &n, &term);
  PetscCall(PetscPopErrorHandler());
  *failed += CheckTrue("released: it stays", moved == PETSC_ERR_ARG_WRONGSTATE, (double)moved);
  *failed += CheckTrue("released: no terms", terms == PETSC_ERR_ARG_WRONGSTATE, (double)terms);
  PetscFunctionReturn(0);
}

/* Gives the first chain the values of the second one and back */
static PetscErrorCode TestScene(const Scene *scene, int *failed)
{
  const OperatorsParameter *q[2];
  PetscInt                  n[2];
  Chain                     chain[2];
  Matrices                  before;
  PetscReal                 values[64];

  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++) {
    PetscCall(ChainCreate(scene->scene, scene->values[k], &chain[k]));
    PetscCall(ChainLinearise(&chain[k], NULL));
    PetscCall(MatricesGet(chain[k].pencil, &before));
    PetscCall(OperatorsGetParameters(chain[k].operators, &n[k], &q[k]));
  }
  *failed += CheckTrue("parameters alike, at most 64", n[0] == n[1] && n[0] <= 64, (double)n[0]);
  for (int k = 0; k < 2; k++) {
    const int other = 1 - k;
    PetscReal first[64], second[64];

    printf("     %s, %s\n", scene->name, k ? "back" : "forth");
    for (PetscInt i = 0; i < n[0]; i++) first[i] = q[k][i].value;
    for (PetscInt i = 0; i < n[0]; i++) second[i] = q[other][i].value;
    for (PetscInt i = 0; i < n[0]; i++)
      if (strcmp(q[0][i].name, q[1][i].name)) *failed += CheckTrue(q[0][i].name, 0, (double)i);
    PetscCall(PencilSetParameters(chain[k].pencil, second));
    PetscCall(TestSame(chain[k].pencil, chain[other].pencil, failed));
    PetscCall(TestTerms(chain[k].pencil, failed));
    PetscCall(TestDerivatives(chain[k].pencil, failed));
    PetscCall(TestProjection(&chain[k], strstr(scene->scene, "constraint") ? PETSC_TRUE : PETSC_FALSE, failed));
    PetscCall(PencilSetParameters(chain[k].pencil, first));
    if (k) PetscCall(PetscArraycpy(values, first, n[0]));
  }
  PetscCall(TestReleased(chain, values, failed));
  for (int k = 0; k < 2; k++) PetscCall(ChainDestroy(&chain[k]));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  const int n = (int)PETSC_STATIC_ARRAY_LENGTH(scenes);
  PetscBool all; /* on several ranks else both contact laws with damping, and together */

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsHasName(NULL, NULL, "-all", &all));
  for (int i = 0; i < n; i++)
    if (size == 1 || all || i % 5 == 2 || i == n - 1) PetscCall(TestScene(&scenes[i], failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
