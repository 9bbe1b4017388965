/*
   Unit test of sweep/onset: critical values of small systems, alone and hidden among other modes by a random
   congruence.
*/
#include "check.h"
#include "densereduced.h"
#include "petscmain.h"
#include "sweep/track/frame.h"

static const ReducedWindow everything = {0, 100, 100, 0};

/* Events of n equal steps, with their onsets */
static PetscErrorCode FindOnsets(const Dense *dense, const ReducedWindow *window, PetscReal first, PetscReal last,
                                 PetscInt n, BranchEvents *events)
{
  PetscReal        value[101], base[1] = {0};
  ReducedModes     modes[101] = {0};
  PetscInt        *branch[101], n_branches = 0;
  const PetscInt   parameter[1] = {0};
  const BranchLine line         = {1, n, parameter, value, base, window};

  PetscFunctionBeginUser;
  memset(events, 0, sizeof(*events));
  for (PetscInt k = 0; k < n; k++) {
    value[k] = first + (last - first) * k / (n - 1);
    PetscCall(ReducedSolve(&dense->system.reduced, &value[k], window, &modes[k]));
    PetscCall(PetscMalloc1(modes[k].n, &branch[k]));
  }
  PetscCall(TrackLine(&dense->system.reduced, &line, modes, branch, &n_branches, events));
  for (PetscInt e = 0; e < events->n; e++) PetscCall(OnsetFind(&dense->system.reduced, &line, &events->event[e], NULL));
  for (PetscInt k = 0; k < n; k++) {
    PetscCall(ReducedModesDestroy(&modes[k]));
    PetscCall(PetscFree(branch[k]));
  }
  PetscFunctionReturn(0);
}

/* Event e has the critical value, within rtol, and its own error is of the same order at most */
static int CheckOnset(const char name[], const BranchEvents *events, PetscInt e, PetscReal value, PetscReal rtol)
{
  const BranchEvent *event = &events->event[e];

  if (e >= events->n) return CheckTrue(name, 0, (double)events->n);
  return CheckTrue(name, event->found, event->found) +
         CheckClose("  critical value", event->critical, value, rtol * fabs(value)) +
         CheckTrue("  estimated error covers the true one, and is small",
                   fabs(event->critical - value) <= event->error && event->error <= 1000 * rtol * fabs(value),
                   event->error);
}

/* [[a, b - mu c], [b, d]] with C = diag(d1, d2) in unknowns 0 and 1 of n; the others are springs that do not couple,
   two of them with frequencies in between. Damping of the others 0.1 where there is any */
static void Friction(Dense *dense, PetscInt n, PetscReal d, PetscReal d1, PetscReal d2)
{
  PetscReal K[DENSE_MAX * DENSE_MAX] = {0}, H[DENSE_MAX * DENSE_MAX] = {0}, C[DENSE_MAX * DENSE_MAX] = {0};

  for (PetscInt i = 2; i < n; i++) {
    K[i * n + i] = 1.1 + 0.35 * (PetscReal)i;
    C[i * n + i] = 0.1;
  }
  K[0] = 2, K[1] = 1, K[n] = 1, K[n + 1] = d;
  H[1] = -4. / 3;
  C[0] = d1, C[n + 1] = d2;
  DenseBegin(dense, n, n > 2 ? PETSC_TRUE : PETSC_FALSE);
  DenseAddUnitMass(dense);
  DenseAdd(dense, OPERATORS_STIFFNESS, -1, K);
  DenseAdd(dense, OPERATORS_STIFFNESS, 0, H);
  if (d1 > 0) DenseAdd(dense, OPERATORS_DAMPING, -1, C);
}

/* |A X - M X S| of a plane X [2][n] with S = (Y' M X)^-1 Y' K X; transposed: of Y, with the roles exchanged */
static PetscReal PlaneResidual(const ModeFrame *f, const PetscReal X[], const PetscReal Y[], PetscBool transposed)
{
  const PetscInt n = f->form.n;
  PetscReal      P[2][2][DENSE_MAX], G[2][2][2], S[2][2], worst = 0; /* K, M times X */

  for (int matrix = 0; matrix < 2; matrix++) {
    for (int j = 0; j < 2; j++) {
      for (PetscInt r = 0; r < n; r++) {
        P[matrix][j][r] = 0;
        for (PetscInt c = 0; c < n; c++)
          P[matrix][j][r] += (matrix ? f->pencil.M : f->pencil.K)[transposed ? r * n + c : c * n + r] * X[j * n + c];
      }
      for (int i = 0; i < 2; i++) {
        G[matrix][i][j] = 0;
        for (PetscInt r = 0; r < n; r++) G[matrix][i][j] += Y[i * n + r] * P[matrix][j][r];
      }
    }
  }
  for (int j = 0; j < 2; j++) {
    const PetscReal det = G[1][0][0] * G[1][1][1] - G[1][0][1] * G[1][1][0];

    S[0][j] = (G[1][1][1] * G[0][0][j] - G[1][0][1] * G[0][1][j]) / det;
    S[1][j] = (G[1][0][0] * G[0][1][j] - G[1][1][0] * G[0][0][j]) / det;
    for (PetscInt r = 0; r < n; r++)
      worst = PetscMax(worst, fabs(P[0][j][r] - P[1][0][r] * S[0][j] - P[1][1][r] * S[1][j]));
  }
  return worst;
}

/* Breaks when: the plane of a defective pair is sought from its vectors alone, which are parallel: here one is given
   twice. Reference: definition of an invariant plane */
static PetscErrorCode TestPlane(int *failed)
{
  const PetscReal  kappa[6] = {1, 2, 4, 1.4, 3, 7}, slope[6] = {1, -1, 0.1, 0, 0.3, 0}, p = 0.4;
  const DenseEntry entry[2]  = {{0, 1, 0.1}, {1, 0, -0.1}};
  const PetscInt   member[2] = {1, 2}; /* kappa 1.4, 1.5, 1.5, ... */
  PetscReal        X[2 * DENSE_MAX], Y[2 * DENSE_MAX];
  ReducedModes     modes = {0};
  ModeFrame       *frame;
  Dense            dense;

  PetscFunctionBeginUser;
  DenseDiagonal(&dense, 6, kappa, slope, 2, entry);
  PetscCall(ReducedSolve(&dense.system.reduced, &p, &everything, &modes));
  *failed += CheckClose("mean of the pair",
                        -creal(modes.lambda[1] * modes.lambda[1] + modes.lambda[2] * modes.lambda[2]) / 2, 1.5, 1e-9);
  PetscCall(PetscArraycpy(modes.x + 2 * 6, modes.x + 6, 6));
  PetscCall(PetscArraycpy(modes.y + 2 * 6, modes.y + 6, 6));
  PetscCall(ModeFrameCreate(&dense.system.reduced, &p, &(StandardForm){.scale = 1}, FRAME_REFINED, &modes, &frame));
  PetscCall(ModePlaneRefine(frame, 2, member, X, Y));
  *failed += CheckClose("right plane is invariant", PlaneResidual(frame, X, Y, PETSC_FALSE), 0, 1e-13);
  *failed += CheckClose("left plane is invariant", PlaneResidual(frame, Y, X, PETSC_TRUE), 0, 1e-13);
  PetscCall(ModeFrameDestroy(&frame));
  PetscCall(ReducedModesDestroy(&modes));
  PetscFunctionReturn(0);
}

/* Both ends and the critical value need all modes; between them the plane is followed, unless an end is the value */
static int CheckPlanes(const BranchEvent *event, int at_end)
{
  return CheckTrue("  all modes are solved for thrice at most", event->n_solved <= 3, event->n_solved) +
         CheckTrue("  the plane is followed", at_end || event->n_followed > 0, event->n_followed);
}

/* Breaks when: the discriminant is taken from two nearly equal eigenvalues (1e-8), or from another pair, or a point of
   the sweep is the critical value itself. Reference: PHYSICS section 3, mu_c = (b + (a - d)^2 / (4 b)) / c = 0.75, 0.78
   */
static PetscErrorCode TestUndamped(int *failed)
{
  static const PetscInt sizes[3] = {2, 7, 12}, points[3] = {4, 6, 9}; /* 9: 0.75 is a point */
  BranchEvents          events;
  Dense                 dense;

  PetscFunctionBeginUser;
  for (int c = 0; c < 9; c++) {
    printf("     %d unknowns, %d points\n", (int)sizes[c / 3], (int)points[c % 3]);
    Friction(&dense, sizes[c / 3], 2, 0, 0);
    PetscCall(FindOnsets(&dense, &everything, 0, 1, points[c % 3], &events));
    *failed += CheckTrue("events", events.n == 1, (double)events.n);
    *failed += CheckOnset("lock-in at 0.75", &events, 0, 0.75, 1e-12);
    if (events.n) *failed += CheckClose("  omega^2 = (a + d) / 2", PetscSqr(events.event[0].omega), 2, 1e-10);
    if (events.n) *failed += CheckPlanes(&events.event[0], c % 3 == 2);
    PetscCall(BranchEventsDestroy(&events));
    Friction(&dense, sizes[c / 3], 2.4, 0, 0);
    PetscCall(FindOnsets(&dense, &everything, 0, 1, points[c % 3], &events));
    *failed += CheckOnset("lock-in at 0.78", &events, 0, 0.78, 1e-12);
    PetscCall(BranchEventsDestroy(&events));
  }
  PetscFunctionReturn(0);
}

/* Breaks when: sigma is followed on another branch, the zero is not found to rounding, or every trial value costs a
   whole eigenproblem. Reference: PHYSICS section 3, destabilisation by uneven damping */
static PetscErrorCode TestDamped(int *failed)
{
  static const PetscReal cases[5][3] = {{0.02, 0.02, 0.78066},
                                        {0.02, 0.04, 0.7779466667},
                                        {0.04, 0.02, 0.7780266667},
                                        {0.02, 0.2, 0.7660264463},
                                        {0.2, 0.02, 0.7670082645}};
  static const PetscInt  sizes[2]    = {2, 9};
  BranchEvents           events;
  Dense                  dense;

  PetscFunctionBeginUser;
  for (int c = 0; c < 10; c++) {
    const PetscReal *d = cases[c / 2];

    Friction(&dense, sizes[c % 2], 2.4, d[0], d[1]);
    PetscCall(FindOnsets(&dense, &everything, 0, 1, 6, &events));
    printf("     damping %.6g %.6g, %d unknowns\n", (double)d[0], (double)d[1], (int)sizes[c % 2]);
    *failed += CheckTrue("events", events.n == 1, (double)events.n);
    if (events.n) *failed += CheckTrue("found", events.event[0].found, events.event[0].error);
    if (events.n) *failed += CheckClose("critical value", events.event[0].critical, d[2], 1e-10);
    if (events.n)
      *failed +=
        CheckTrue("all modes are solved for once at most", events.event[0].n_solved <= 1, events.event[0].n_solved);
    PetscCall(BranchEventsDestroy(&events));
  }
  PetscFunctionReturn(0);
}

/* Breaks when: one end of an interval of instability is found twice, or a narrow one is lost in rounding. Reference: d
   = (p - 0.5)^2 - g^2 */
static PetscErrorCode TestBothEnds(int *failed)
{
  const PetscReal  kappa[6] = {1, 2, 4, 1.4, 3, 7}, slope[6] = {1, -1, 0.1, 0, 0.3, 0};
  static const int points[2] = {6, 11};
  BranchEvents     events;
  Dense            dense;

  PetscFunctionBeginUser;
  for (int c = 0; c < 6; c++) {
    const PetscReal  g        = (const PetscReal[]){0.13, 0.01, 1e-4}[c / 2];
    const DenseEntry entry[2] = {{0, 1, 2 * g}, {1, 0, -g / 2}};

    DenseDiagonal(&dense, 6, kappa, slope, 2, entry);
    PetscCall(FindOnsets(&dense, &everything, 0, 1, points[c % 2], &events));
    printf("     unstable within %.1e of 0.5, %d points\n", (double)g, points[c % 2]);
    *failed += CheckTrue("events", events.n == 2, (double)events.n);
    *failed += CheckOnset("lock-in", &events, 0, 0.5 - g, g > 1e-3 ? 1e-12 : 1e-10);
    *failed += CheckOnset("lock-out", &events, 1, 0.5 + g, g > 1e-3 ? 1e-12 : 1e-10);
    PetscCall(BranchEventsDestroy(&events));
  }
  PetscFunctionReturn(0);
}

/* Breaks when: the four eigenvalues of two equal pairs are mixed up. Reference: as above with g = 0.1 */
static PetscErrorCode TestDoublets(int *failed)
{
  const PetscReal  kappa[5] = {1, 1, 2, 2, 1.3}, slope[5] = {1, 1, -1, -1, 0};
  const DenseEntry entry[4] = {{0, 2, 0.1}, {1, 3, 0.1}, {2, 0, -0.1}, {3, 1, -0.1}};
  BranchEvents     events;
  Dense            dense;

  PetscFunctionBeginUser;
  DenseDiagonal(&dense, 5, kappa, slope, 4, entry);
  PetscCall(FindOnsets(&dense, &everything, 0, 1, 8, &events));
  for (PetscInt e = 0; e < 4; e++)
    *failed += CheckOnset("doublet locks with a doublet", &events, e, e < 2 ? 0.4 : 0.6, 1e-12);
  PetscCall(BranchEventsDestroy(&events));
  PetscFunctionReturn(0);
}

/* Breaks when: a stiffness that vanishes is rounded to a rigid mode before its zero is found, or the sign of lambda is
   lost. Reference: 0.5 p - 0.6 = 0 at p = 1.2; det [[1 - p / 2, 0.3], [0.3, 2]] = 0 at p = 1.91; damped or not */
static PetscErrorCode TestDivergence(int *failed)
{
  BranchEvents events;
  Dense        dense;

  PetscFunctionBeginUser;
  for (int damped = 0; damped < 2; damped++) {
    const PetscReal K[16]  = {1, 0.3, 0, 0, 0.3, 2, 0, 0, 0, 0, 1.3, 0, 0, 0, 0, -0.6};
    const PetscReal K1[16] = {-0.5, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.5};
    const PetscReal C[16]  = {0.2, 0, 0, 0, 0, 0.1, 0, 0, 0, 0, 0.1, 0, 0, 0, 0, 0.3};

    DenseBegin(&dense, 4, PETSC_TRUE);
    DenseAddUnitMass(&dense);
    DenseAdd(&dense, OPERATORS_STIFFNESS, -1, K);
    DenseAdd(&dense, OPERATORS_STIFFNESS, 0, K1);
    if (damped) DenseAdd(&dense, OPERATORS_DAMPING, -1, C);
    PetscCall(FindOnsets(&dense, &everything, 0, 3, 8, &events));
    printf("     %s\n", damped ? "damped" : "undamped");
    *failed += CheckTrue("events", events.n == 2, (double)events.n);
    if (events.n == 2) {
      *failed += CheckTrue("restabilisation", events.event[0].kind == EVENT_RESTABILISATION, events.event[0].kind);
      *failed += CheckTrue("divergence", events.event[1].kind == EVENT_DIVERGENCE, events.event[1].kind);
      *failed += CheckClose("omega", events.event[1].omega, 0, 0);
    }
    *failed += CheckOnset("0.5 p - 0.6 = 0", &events, 0, 1.2, 1e-12);
    *failed += CheckOnset("det K = 0", &events, 1, 1.91, 1e-12);
    PetscCall(BranchEventsDestroy(&events));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  (void)size;
  PetscCall(TestPlane(failed));
  PetscCall(TestUndamped(failed));
  PetscCall(TestDamped(failed));
  PetscCall(TestBothEnds(failed));
  PetscCall(TestDoublets(failed));
  PetscCall(TestDivergence(failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
