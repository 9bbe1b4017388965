/*
   Unit test of sample/draw: digits of Sobol's sequence beside those of scipy 1.10 (scipy.stats.qmc.Sobol, without
   scrambling), elementary intervals of the scrambled one, strata of the Latin hypercube, quantiles and incomplete beta
   functions beside scipy. Breaks where a direction number, a recursion or a fraction is wrong.
*/
#include "sample/draw/distribution.h"
#include "sample/draw/sequence.h"
#include "base/statistics/estimate.h"
#include "check.h"

#define N_POINTS 1024

/* Points 5, 1000 and 123456 in dimensions 1, 2, 3, 8, 21 and 40, as scipy.stats.qmc.Sobol(40, scramble=False) has them */
static int CheckDigits(void)
{
  static const PetscInt  dimension[] = {0, 1, 2, 7, 20, 39}, place[] = {5, 1000, 123456};
  static const PetscReal expected[3][6] = {
    {0.875, 0.875, 0.125, 0.375, 0.625, 0.375},
    {0.2197265625, 0.0966796875, 0.5185546875, 0.8994140625, 0.5224609375, 0.4794921875},
    {0.02649688720703125, 0.18274688720703125, 0.30725860595703125, 0.46405792236328125, 0.11809539794921875,
     0.37097930908203125},
  };
  int  failed = 0;
  char name[64];

  for (int i = 0; i < 3; i++)
    for (int d = 0; d < 6; d++) {
      (void)snprintf(name, sizeof(name), "point %d, dimension %d", (int)place[i], (int)dimension[d] + 1);
      failed += CheckClose(name, (double)SobolDigits(place[i], dimension[d]) / 4294967296.0, expected[i][d], 0);
    }
  return failed;
}

/* Each of the intervals of length 1/N_POINTS holds one of the first N_POINTS points, in each dimension */
static PetscErrorCode CheckStrata(SequenceKind kind, const char name[], int *failed)
{
  Sequence  sequence = {kind, 7, N_POINTS, SOBOL_DIMENSIONS, NULL};
  PetscReal u[SOBOL_DIMENSIONS];
  PetscInt  count[SOBOL_DIMENSIONS][N_POINTS] = {{0}}, wrong = 0;

  PetscFunctionBeginUser;
  PetscCall(SequenceSetUp(&sequence));
  for (PetscInt i = 0; i < N_POINTS; i++) {
    SequencePoint(&sequence, i, u);
    for (PetscInt d = 0; d < SOBOL_DIMENSIONS; d++) count[d][(PetscInt)(u[d] * N_POINTS)]++;
  }
  for (PetscInt d = 0; d < SOBOL_DIMENSIONS; d++)
    for (PetscInt k = 0; k < N_POINTS; k++) wrong += count[d][k] != 1;
  *failed += CheckTrue(name, wrong == 0, (double)wrong);
  PetscCall(SequenceDestroy(&sequence));
  PetscFunctionReturn(0);
}

/* 32 x 32 boxes of dimensions 1 and 2, a (0, 10, 2) net: one point in each, scrambled or not */
static PetscErrorCode CheckNet(int *failed)
{
  Sequence  sequence = {SEQUENCE_SOBOL, 3, N_POINTS, 2, NULL};
  PetscReal u[2];
  PetscInt  count[32][32] = {{0}}, wrong = 0;

  PetscFunctionBeginUser;
  PetscCall(SequenceSetUp(&sequence));
  for (PetscInt i = 0; i < N_POINTS; i++) {
    SequencePoint(&sequence, i, u);
    count[(int)(u[0] * 32)][(int)(u[1] * 32)]++;
  }
  for (int i = 0; i < 32; i++)
    for (int k = 0; k < 32; k++) wrong += count[i][k] != 1;
  *failed += CheckTrue("one scrambled point in each of 32 x 32 boxes", wrong == 0, (double)wrong);
  PetscFunctionReturn(0);
}

/* scipy.stats.norm.ppf, scipy.special.betainc, scipy.stats.beta.ppf */
static int CheckFunctions(void)
{
  PetscReal interval[2];
  int       failed = 0;

  failed += CheckClose("normal quantile of 1e-300", NormalQuantile(1e-300), -37.0470962993612, 1.4818838519744482e-13);
  failed += CheckClose("normal quantile of 1e-12", NormalQuantile(1e-12), -7.034483825301131, 2.8137935301204527e-14);
  failed += CheckClose("normal quantile of 0.001", NormalQuantile(0.001), -3.090232306167813, 1.2360929224671254e-14);
  failed += CheckClose("normal quantile of 0.3", NormalQuantile(0.3), -0.5244005127080409, 2.097602050832164e-15);
  failed += CheckClose("normal quantile of 0.5", NormalQuantile(0.5), 0.0, 1e-15);
  failed += CheckClose("normal quantile of 0.9", NormalQuantile(0.9), 1.2815515655446004, 5.1262062621784015e-15);
  failed +=
    CheckClose("normal quantile of 0.999999", NormalQuantile(0.999999), 4.753424308817087, 1.9013697235268352e-14);
  failed += CheckClose("incomplete beta function", BetaProbability(3, 10000, 0.0005), 0.8754953381816037, 1e-11);
  failed += CheckClose("incomplete beta function", BetaProbability(0.5, 0.5, 0.3), 0.3690101195655454, 1e-11);
  failed += CheckClose("incomplete beta function", BetaProbability(5000, 5001, 0.5), 0.5039893230700742, 1e-11);
  failed += CheckClose("incomplete beta function", BetaProbability(200, 3, 0.97), 0.05673453694079477, 1e-11);
  ClopperPearson(0, 0, 10000, interval);
  failed += CheckClose("lower end, 0 of 10000", interval[0], 0.0, 1e-12);
  failed += CheckClose("upper end, 0 of 10000", interval[1], 0.0003688199146187622, 1e-12);
  ClopperPearson(37, 37, 10000, interval);
  failed += CheckClose("lower end, 37 of 10000", interval[0], 0.0026064390077109633, 1e-12);
  failed += CheckClose("upper end, 37 of 10000", interval[1], 0.005096391253158692, 1e-12);
  ClopperPearson(10000, 10000, 10000, interval);
  failed += CheckClose("lower end, 10000 of 10000", interval[0], 0.9996311800853812, 1e-12);
  failed += CheckClose("upper end, 10000 of 10000", interval[1], 1.0, 1e-12);
  ClopperPearson(3, 3, 7, interval);
  failed += CheckClose("lower end, 3 of 7", interval[0], 0.09898827844250786, 1e-12);
  failed += CheckClose("upper end, 3 of 7", interval[1], 0.8159484323599169, 1e-12);
  return failed;
}

int main(int argc, char **argv)
{
  int failed = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  failed += CheckDigits();
  PetscCall(CheckStrata(SEQUENCE_SOBOL, "one scrambled point in each interval, 40 dimensions", &failed));
  PetscCall(CheckStrata(SEQUENCE_LATIN, "one point of the Latin hypercube in each", &failed));
  PetscCall(CheckNet(&failed));
  failed += CheckFunctions();
  PetscCall(PetscFinalize());
  return failed != 0;
}
