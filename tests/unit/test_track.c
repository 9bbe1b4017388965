/*
   Unit test of sweep/track: branches and events of block systems with known eigenvalues kappa_i(p), hidden by a random
   congruence. K = diag(kappa + slope p) with couplings g_12, g_21 between two modes has, for these two,

      kappa = mean +- sqrt(d),   d = (difference of the diagonal)^2 / 4 + g_12 g_21.
*/
#include "densesweep.h"
#include "petscmain.h"

static const ReducedWindow everything = {0, 100, 100, 0};

/* Largest distance of the branches from the straight lines kappa + slope p on which they begin */
static PetscReal RunStraight(const Run *run, PetscInt n, const PetscReal kappa[], const PetscReal slope[])
{
  PetscReal worst = 0;

  for (PetscInt r = 0; r < run->modes[0].n; r++) {
    PetscInt own = 0;

    for (PetscInt i = 1; i < n; i++) {
      const PetscReal begin = RunKappa(run, 0, r);

      if (fabs(kappa[i] + slope[i] * run->value[0] - begin) < fabs(kappa[own] + slope[own] * run->value[0] - begin))
        own = i;
    }
    for (PetscInt k = 0; k < run->line.n; k++) {
      const PetscReal error = fabs(RunKappa(run, k, r) - kappa[own] - slope[own] * run->value[k]);

      if (!(error <= worst)) worst = error;
    }
  }
  return worst;
}

/* Straight lines that cross: of single modes, of doublets, of three at one point, between and at the points of the
   sweep. Breaks when: modes are matched by frequency, or what joins at a point leaves it on another branch. Reference:
   diagonal */
static PetscErrorCode TestCrossings(int *failed)
{
  static const struct {
    const char *name;
    PetscInt    n;
    PetscReal   kappa[6], slope[6];
  } cases[] = {
    {"two modes cross",               2, {1, 2},                       {1, -1}                 },
    {"two doublets cross",            4, {1, 1, 2, 2},                 {1, 1, -1, -1}          },
    {"a doublet crosses two modes",   4, {1, 1, 2, 1.7},               {1, 1, -1, -0.3}        },
    {"three modes meet",              3, {1, 2, 1.5},                  {1, -1, 0}              },
    {"four modes and a doublet meet", 6, {1, 2, 1.25, 1.75, 1.5, 1.5}, {1, -1, 0.5, -0.5, 0, 0}},
  };
  static Run run;
  Dense      dense;

  PetscFunctionBeginUser;
  for (size_t c = 0; c < sizeof(cases) / sizeof(*cases); c++) {
    printf("     %s\n", cases[c].name);
    DenseDiagonal(&dense, cases[c].n, cases[c].kappa, cases[c].slope, 0, NULL);
    for (PetscInt points = 6; points <= 11; points += 5) { /* 11: the middle is a point */
      PetscCall(RunSweep(&dense, &everything, 0, 1, points, &run));
      *failed += CheckClose("distance from the straight lines",
                            RunStraight(&run, cases[c].n, cases[c].kappa, cases[c].slope), 0, 1e-7);
      *failed += CheckTrue("no event", run.events.n == 0, (double)run.events.n);
      *failed += CheckTrue("branches", run.n_branches == cases[c].n, (double)run.n_branches);
      PetscCall(RunDestroy(&run));
    }
  }
  PetscFunctionReturn(0);
}

/* Breaks when: branches cross where symmetric coupling makes them veer, or do not where the coupling is far below the
   step that is resolved. Reference: kappa = 1.5 -+ sqrt((p - 0.5)^2 + g^2) */
static PetscErrorCode TestVeering(int *failed)
{
  const PetscReal kappa[3] = {1, 2, 4}, slope[3] = {1, -1, 0};
  static Run      run;
  Dense           dense;

  PetscFunctionBeginUser;
  for (int narrow = 0; narrow < 2; narrow++) {
    const PetscReal  g        = narrow ? 1e-7 : 0.02;
    const DenseEntry entry[2] = {
      {0, 1, g},
      {1, 0, g}
    };
    const PetscReal last = 1.5 + (narrow ? 1 : -1) * sqrt(0.25 + g * g);

    DenseDiagonal(&dense, 3, kappa, slope, 2, entry);
    PetscCall(RunSweep(&dense, &everything, 0, 1, 6, &run));
    *failed += CheckClose(narrow ? "a gap of 1e-7 is crossed" : "a gap of 0.02 makes branches veer",
                          RunKappa(&run, 5, run.branch[0][0]), last, 1e-9);
    *failed += CheckTrue("no event", run.events.n == 0, (double)run.events.n);
    PetscCall(RunDestroy(&run));
  }
  PetscFunctionReturn(0);
}

/* Breaks when: an instability between the points is lost, its ends are not bracketed, the pair is not two branches
   inside it, or they do not go on afterwards. Reference: unstable where |p - 0.5| < g, here down to 1e-5 of the range
   in 5 steps */
static PetscErrorCode TestLockIn(int *failed)
{
  const PetscReal  kappa[4] = {1, 2, 4, 1.4}, slope[4] = {1, -1, 0.1, 0}, g[4] = {0.13, 0.01, 1e-3, 1e-5};
  static const int points[2] = {6, 11}; /* 11: p = 0.5 is a point */
  static Run       run;
  Dense            dense;

  PetscFunctionBeginUser;
  for (int c = 0; c < 8; c++) {
    const PetscReal  w        = g[c / 2];
    const DenseEntry entry[2] = {
      {0, 1, w },
      {1, 0, -w}
    };
    PetscInt first;

    printf("     unstable within %.1e of p = 0.5, %d points\n", (double)w, points[c % 2]);
    DenseDiagonal(&dense, 4, kappa, slope, 2, entry);
    PetscCall(RunSweep(&dense, &everything, 0, 1, points[c % 2], &run));
    first = run.branch[0][0];
    *failed += CheckTrue("events", run.events.n == 2, (double)run.events.n);
    *failed += CheckEvent("lock-in", &run, 0, EVENT_LOCK_IN, 0.5 - w);
    *failed += CheckEvent("lock-out", &run, 1, EVENT_LOCK_OUT, 0.5 + w);
    *failed += CheckTrue("branches", run.n_branches == 4, (double)run.n_branches);
    *failed +=
      CheckTrue("lower one is unstable", run.events.n > 0 && run.events.event[0].branch[0] == first, (double)first);
    *failed += CheckTrue("its partner",
                         run.events.n > 0 && run.events.event[0].branch[1] >= 0 &&
                           fabs(RunKappa(&run, 0, run.events.event[0].branch[1]) - 1.5 - sqrt(0.25 - w * w)) < 1e-9,
                         run.events.n > 0 ? (double)run.events.event[0].branch[1] : -1.);
    PetscCall(RunDestroy(&run));
  }
  PetscFunctionReturn(0);
}

/* Breaks when: divergence is taken for flutter, is lost in the pair's plane, or a sweep downwards turns the kinds
   round. Reference: PHYSICS: a = d = 2, b = 1, c = 4/3 flutters above mu = 0.75; kappa = 1 - 0.8 mu, zero at 1.25 */
static PetscErrorCode TestFriction(int *failed)
{
  const PetscReal K[9] = {2, 1, 0, 1, 2, 0, 0, 0, 1}, H[9] = {0, -4. / 3, 0, 0, 0, 0, 0, 0, -0.8};
  static Run      run;
  Dense           dense;

  PetscFunctionBeginUser;
  DenseBegin(&dense, 3, PETSC_TRUE);
  DenseAddUnitMass(&dense);
  DenseAdd(&dense, OPERATORS_STIFFNESS, -1, K);
  DenseAdd(&dense, OPERATORS_STIFFNESS, 0, H);
  for (int down = 0; down < 2; down++) {
    PetscCall(RunSweep(&dense, &everything, down ? 2 : 0, down ? 0 : 2, 14, &run));
    *failed += CheckTrue("events", run.events.n == 2, (double)run.events.n);
    *failed += CheckEvent("flutter", &run, down, EVENT_LOCK_IN, 0.75);
    *failed += CheckEvent("divergence", &run, 1 - down, EVENT_DIVERGENCE, 1.25);
    *failed += CheckTrue("branches", run.n_branches == 3, (double)run.n_branches);
    PetscCall(RunDestroy(&run));
  }
  PetscFunctionReturn(0);
}

/* Breaks when: a mode that leaves the band takes over another branch, or one that enters continues one. Reference:
   kappa = 1 + 3 p leaves the window omega <= 1.5 at p = 0.4167, 4 - 3 p enters it at 0.5833, 1.7 stays */
static PetscErrorCode TestWindow(int *failed)
{
  const PetscReal     kappa[3] = {1, 4, 1.7}, slope[3] = {3, -3, 0};
  const ReducedWindow window = {0.5, 1.5, 10, 0};
  static Run          run;
  Dense               dense;

  PetscFunctionBeginUser;
  DenseDiagonal(&dense, 3, kappa, slope, 0, NULL);
  PetscCall(RunSweep(&dense, &window, 0, 1, 11, &run));
  *failed += CheckTrue("branches", run.n_branches == 3, (double)run.n_branches);
  *failed += CheckTrue("no event", run.events.n == 0, (double)run.events.n);
  *failed += CheckClose("leaves after", RunKappa(&run, 4, run.branch[0][0]), 2.2, 1e-9);
  *failed += CheckTrue("is gone", RunMode(&run, 5, run.branch[0][0]) < 0, 0);
  *failed += CheckClose("stays", RunKappa(&run, 10, run.branch[0][1]), 1.7, 1e-9);
  *failed += CheckClose("enters", RunKappa(&run, 6, 2), 2.2, 1e-9);
  *failed += CheckClose("goes on", RunKappa(&run, 10, 2), 1, 1e-9);
  PetscCall(RunDestroy(&run));
  PetscFunctionReturn(0);
}

/* Breaks when: points that are not neighbours on a line are matched by their order. Reference: diagonal */
static PetscErrorCode TestPoints(int *failed)
{
  const PetscReal kappa[4] = {1, 1, 2, 1.7}, slope[4] = {1, 1, -1, -0.3}, p[2] = {0.1, 0.9};
  ReducedModes    modes[2];
  Dense           dense;
  PetscInt        match[4], wrong = 0;
  PetscBool       certain;

  PetscFunctionBeginUser;
  DenseDiagonal(&dense, 4, kappa, slope, 0, NULL);
  for (int k = 0; k < 2; k++) PetscCall(ReducedSolve(&dense.system.reduced, &p[k], &everything, &modes[k]));
  PetscCall(TrackMatch(&dense.system.reduced, &p[0], &modes[0], &modes[1], match, &certain));
  /* order at 0.1: doublet, 1.67, 1.9; at 0.9: 1.1, 1.43, doublet */
  wrong = (match[0] != 3) + (match[1] != 2) + !((match[2] == 0 && match[3] == 1) || (match[2] == 1 && match[3] == 0));
  *failed += CheckTrue("modes of two points matched wrongly", wrong == 0, (double)wrong);
  *failed += CheckTrue("match is certain", certain, 0);
  for (int k = 0; k < 2; k++) PetscCall(ReducedModesDestroy(&modes[k]));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  (void)size;
  PetscCall(TestCrossings(failed));
  PetscCall(TestVeering(failed));
  PetscCall(TestLockIn(failed));
  PetscCall(TestFriction(failed));
  PetscCall(TestWindow(failed));
  PetscCall(TestPoints(failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
