/*
   Unit test of map/mapmodes: what eigenvalues about sliding say of a point of a map, and of map/mapforce: its main line, and
   when a vibration has settled; of map/mapspread: what several transients say together.

   References: two modes of 1 and 2 rad/s and one pair that slides, of which the forces act on the first mode alone, opening and
   slipping by 1 per unit of it, compliance 1: K = diag(1 + 1 - mu, 4), so that with mu = 5 lambda = +- sqrt 3 and +- 2 i, by hand;
   lists of eigenvalues made up; a cosine of known frequency;
   random levels of a known distribution, of which two are compared.
*/
#include "check.h"
#include "map/mapimpl.h"
#include "petscmain.h"

static const ModesLimit limit = {0, 5.5}; /* 1/s */

/* Breaks when: divergence is not growth, or an oscillation beside it hides it */
static PetscErrorCode TestDivergence(int *failed)
{
  PetscReal       omega2[2] = {1, 4}, P[6] = {1, 0, 1, 0, 0, 0}, W[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  PetscReal       gap[1]    = {0}, sigma[4], omega[4];
  FrictionLaw     law       = {.speed = 1, .parameter = {5}};
  const PetscBool closed[1] = {PETSC_TRUE};
  ReducedModel    model     = {
           .m = 2, .n_pairs = 1, .n_ports = 3, .omega2 = omega2, .P = P, .W = W, .gap = gap, .friction = &law};
  MapFastest fastest;
  MapPoint   row = {0};

  PetscFunctionBeginUser;
  PetscCall(ReducedLinearise(&model, closed, NULL, PETSC_FALSE, sigma, omega));
  MapModesJudge(4, sigma, omega, &fastest);
  MapModesTake(4, sigma, omega, &limit, &row);
  *failed += CheckClose("divergence: growth", fastest.growth, sqrt(3), 1e-14);
  *failed += CheckClose("its frequency", fastest.freq, 0, 0);
  *failed += CheckClose("index: growth over |lambda|", fastest.index, 1, 1e-15);
  *failed += CheckTrue("one mode grows", row.n_growing == 1 && row.omega[0] == 0, row.n_growing);
  law.parameter[0] = 1.5;
  PetscCall(ReducedLinearise(&model, closed, NULL, PETSC_FALSE, sigma, omega));
  MapModesJudge(4, sigma, omega, &fastest);
  *failed += CheckClose("without it nothing grows", fastest.growth, 0, 1e-14);
  PetscFunctionReturn(0);
}

/* Breaks when: of more eigenvalues than places one that grows without oscillation is dropped. With mu = 5 and a branch of 4 and 1 s
   on the first mode (s - 1) (s^2 + 2 s + 3) = 0, by hand, beside +- 2 i and what decays at -1 */
static PetscErrorCode TestBranch(int *failed)
{
  PetscReal       omega2[2] = {1, 4}, P[6] = {1, 0, 1, 0, 0, 0}, W[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  PetscReal       S[4] = {1, 0, 0, 0}, Sm[6] = {0}, Sx[9] = {0};
  PetscReal       gap[1]    = {0}, sigma[4], omega[4];
  FrictionLaw     law       = {.speed = 1, .parameter = {5}};
  const PetscBool closed[1] = {PETSC_TRUE};
  ReducedBranch   branch    = {.n = 1, .stiff = {4}, .time = {1}, .S = S, .Sm = Sm, .Sx = Sx};
  ReducedModel    model     = {.m          = 2,
                               .n_pairs    = 1,
                               .n_ports    = 3,
                               .omega2     = omega2,
                               .P          = P,
                               .W          = W,
                               .gap        = gap,
                               .friction   = &law,
                               .n_branches = 1,
                               .branch     = &branch};
  MapFastest      fastest;

  PetscFunctionBeginUser;
  PetscCall(ReducedLinearise(&model, closed, NULL, PETSC_FALSE, sigma, omega));
  MapModesJudge(4, sigma, omega, &fastest);
  *failed += CheckClose("divergence beside a branch", fastest.growth, 1, 1e-13);
  *failed += CheckClose("does not oscillate", fastest.freq, 0, 0);
  PetscFunctionReturn(0);
}

/* Breaks when: a rigid mode in rounding counts as divergence, an overdamped one as the fastest, or modes beyond those that are
   listed displace faster ones */
static int TestLists(void)
{
  const PetscReal sigma[] = {1e-6, -3, -50, -50, 20, 20}, omega[] = {0, 0, 1e5, -1e5, 2e4, -2e4};
  PetscReal       many[2 * (MAP_MAX_MODES + 3)], turns[2 * (MAP_MAX_MODES + 3)];
  const PetscInt  n_most = MAP_MAX_MODES + 3;
  MapFastest      fastest;
  MapPoint        row    = {0};
  int             failed = 0, ordered = 1;

  MapModesJudge(6, sigma, omega, &fastest);
  failed += CheckClose("fastest beside rigid and overdamped modes", fastest.growth, 20, 0);
  MapModesJudge(4, sigma, omega, &fastest);
  failed += CheckClose("stable beside them", fastest.growth, -50, 0);
  for (PetscInt k = 0; k < n_most; k++) {
    many[2 * k] = many[2 * k + 1] = 1 + (PetscReal)((7 * k) % n_most);
    turns[2 * k]                  = 1e4;
    turns[2 * k + 1]              = -1e4;
  }
  MapModesTake(2 * n_most, many, turns, &limit, &row);
  for (PetscInt k = 0; k < MAP_MAX_MODES; k++)
    if (row.sigma[k] != (PetscReal)(n_most - k)) ordered = 0;
  failed += CheckTrue("all are counted", row.n_growing == n_most, row.n_growing);
  failed += CheckTrue("those up to the limit are not unstable", row.n_unstable == n_most - 5, row.n_unstable);
  return failed + CheckTrue("the fastest are listed, in order", ordered, row.sigma[0]);
}

/* Breaks when: the line is off, or there is one where nothing moves. One line between bins: exact but for its mirror image */
static int TestLine(void)
{
  PetscReal f[1000], still[1000];

  for (int i = 0; i < 1000; i++) {
    f[i]     = 3 + cos(2 * M_PI * 81.3 * i / 1000.);
    still[i] = 3;
  }
  return CheckClose("main line between bins", MapForceLine(1, 1000, f, 1e-3), 81.3, 1e-4) +
         CheckTrue("no line where nothing moves", isnan(MapForceLine(1, 1000, still, 1e-3)), 0);
}

/* Breaks when: what still grows is settled or steady, or what scatters about a level is neither. Windows scatter by +-10 %: the
   relative standard error of the mean square of n is about 0.2 / sqrt n, of the rms half of that, 0.035 for 8 */
static int TestEnds(void)
{
  MapSample scatter[16], grow[16];
  PetscReal error = 0;
  int       failed;

  for (int k = 0; k < 16; k++) {
    scatter[k] = (MapSample){.rms = 1 + (k % 2 ? 0.1 : -0.1), .changed = PETSC_TRUE};
    grow[k]    = (MapSample){.rms = exp(0.05 * k), .changed = PETSC_TRUE};
  }
  failed = CheckTrue("scatter is not settled", !MapIsSettled(16, scatter, 0.05, &error), error);
  failed += CheckTrue("but steady", MapIsSteady(16, scatter, 0.05, &error), error);
  failed += CheckClose("its error", error, 0.1 / sqrt(7), 1e-3);
  failed += CheckTrue("not to 3 %", !MapIsSteady(16, scatter, 0.03, &error), error);
  failed += CheckTrue("growth by 5 % a window is not settled", !MapIsSettled(16, grow, 0.05, &error), error);
  failed += CheckTrue("nor steady", !MapIsSteady(16, grow, 0.05, &error), error);
  scatter[12].changed = PETSC_FALSE;
  return failed + CheckTrue("nor is what was linear for a while", !MapIsSteady(16, scatter, 0.05, &error), error);
}

/* Numbers between 0 and 1 that are alike in each run (linear congruence), and with a standard normal distribution */
static PetscReal Uniform(uint32_t *bits)
{
  *bits = 1664525 * *bits + 1013904223;
  return ((PetscReal)(*bits >> 8) + 0.5) / 16777216;
}

static PetscReal Normal(uint32_t *bits)
{
  const PetscReal radius = PetscSqrtReal(-2 * PetscLogReal(Uniform(bits)));

  return radius * PetscCosReal(2 * PETSC_PI * Uniform(bits));
}

/* Four transients of seven windows, whose squared rms is 1 and scatters by `between` from transient to transient and by 0.1 from
   window to window, each window being r times the one before and a new number: root of the mean square and what it may be off */
static PetscReal Level(uint32_t *bits, PetscReal between, PetscReal r, PetscReal *off)
{
  const PetscInt n[4] = {7, 7, 7, 7};
  PetscReal      rms[4][7], square = 0;

  for (int k = 0; k < 4; k++) {
    const PetscReal mean = 1 + between * Normal(bits);
    PetscReal       x    = Normal(bits);

    for (int i = 0; i < 7; i++) {
      rms[k][i] = PetscSqrtReal(mean + 0.1 * x);
      square += PetscSqr(rms[k][i]) / 28;
      x = r * x + PetscSqrtReal(1 - r * r) * Normal(bits);
    }
  }
  *off = MapSpreadOfLevel(4, n, 7, rms[0]) * PetscSqrtReal(square);
  return PetscSqrtReal(square);
}

/* Breaks when: another level of the same distribution is off by more than what is told in more than 5 of 100, or that is much too
   large: independent windows, windows that resemble each other, transients that differ among themselves */
static int TestSpread(void)
{
  static const PetscReal between[3] = {0, 0, 0.1}, r[3] = {0, 0.7, 0.3};
  const PetscReal        two[2] = {1, 3};
  PetscReal              x[21], quantile[MAP_N_QUANTILES];
  uint32_t               bits = 1;
  int                    failed;

  for (int i = 0; i < 21; i++) x[i] = (PetscReal)((8 * i) % 21);
  failed = MapSpreadQuantiles(21, x, quantile) != 0;
  failed += CheckClose("5 % of 0 .. 20", quantile[0], 1, 1e-12) + CheckClose("half", quantile[1], 10, 1e-12);
  failed += CheckClose("95 %", quantile[2], 19, 1e-12);
  failed += CheckClose("of two numbers: t sqrt(2 var / n)", MapSpreadOfMean(2, two), 12.706 * sqrt(2), 1e-12);
  for (int k = 0; k < 3; k++) {
    PetscReal off[2], inside = 0;

    for (int i = 0; i < 4000; i++) {
      const PetscReal one = Level(&bits, between[k], r[k], &off[0]), other = Level(&bits, between[k], r[k], &off[1]);

      inside += (fabs(one - other) <= off[0]) / 4000.0;
    }
    failed += CheckTrue("another level is as near as is told in 95 of 100", inside > 0.945 && inside < 0.998, inside);
  }
  return failed;
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  (void)size;
  PetscCall(TestDivergence(failed));
  PetscCall(TestBranch(failed));
  *failed += TestLists() + TestLine() + TestEnds() + TestSpread();
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
