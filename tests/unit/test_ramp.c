/*
   Unit test of quantity/ramp.h and of the options of a ramp.

   References: the definitions, their values at places where they are rational, central differences of the integral.
*/
#include "check.h"
#include "quantity/ramp.h"

/* Breaks when: a ramp begins or ends elsewhere, is not 0 before and 1 after, or a shape is another curve */
static int TestValues(void)
{
  const Ramp linear = {.shape = RAMP_LINEAR, .delay = 0.25, .length = 0.5};
  const Ramp smooth = {.shape = RAMP_SMOOTH, .delay = 0.25, .length = 0.5};
  int        failed = 0;

  failed += CheckClose("linear, before the delay", RampValue(&linear, 0.2), 0, 0) +
            CheckClose("smooth, before the delay", RampValue(&smooth, 0.2), 0, 0);
  failed += CheckClose("linear, after the ramp", RampValue(&linear, 0.8), 1, 0) +
            CheckClose("smooth, after the ramp", RampValue(&smooth, 0.8), 1, 0);
  failed += CheckClose("linear, a quarter of the way", RampValue(&linear, 0.375), 0.25, 1e-15);
  failed += CheckClose("smooth, a third of the way: (1 - cos 60) / 2", RampValue(&smooth, 0.25 + 0.5 / 3), 0.25, 1e-15);
  failed += CheckClose("smooth, half way", RampValue(&smooth, 0.5), 0.5, 1e-15);
  failed += CheckClose("way half a linear ramp: length / 8", RampIntegral(&linear, 0.5), 0.0625, 1e-15);
  failed += CheckClose("way half a smooth ramp: length (1/4 - 1 / (2 pi))", RampIntegral(&smooth, 0.5),
                       0.125 - 0.25 / RAMP_PI, 1e-15);
  failed += CheckClose("way after a linear ramp: half of its length is lost", RampIntegral(&linear, 2), 1.5, 1e-15);
  return failed + CheckClose("way after a smooth ramp", RampIntegral(&smooth, 2), 1.5, 1e-15);
}

/* Breaks when: the integral is not that of the value but for a constant, inside the ramp or past its ends. Error of a central difference:
   e^2 / 6 r'' with r'' <= (pi / length)^2 / 2 */
static int TestIntegral(RampShape shape)
{
  const Ramp   ramp = {.shape = shape, .delay = 0.25, .length = 0.5};
  const double h = 1. / 4096, e = 1. / 65536;
  double       worst = 0;

  for (int i = 0; i < 4096; i++) {
    const double t = (i + 0.5) * h, difference = RampIntegral(&ramp, t + e) - RampIntegral(&ramp, t - e);

    worst = fmax(worst, fabs(difference / (2 * e) - RampValue(&ramp, t)));
  }
  return CheckClose("derivative of the integral, largest error", worst, 0,
                    e * e / 6 * pow(RAMP_PI / 0.5, 2) / 2 + 1e-10);
}

/* Largest errors of the integral and the rate of a history by central differences, but for h about its kinks */
static void Differences(const Ramp *ramp, PetscReal kink, double *way, double *rate)
{
  const double h = 1. / 4096, e = 1. / 65536;

  *way = *rate = 0;
  for (int i = 0; i < 4096; i++) {
    const double t = (i + 0.5) * h, area = RampIntegral(ramp, t + e) - RampIntegral(ramp, t - e);

    *way = fmax(*way, fabs(area / (2 * e) - RampValue(ramp, t)));
    if (fabs(remainder(t - ramp->delay, kink)) > 2 * e)
      *rate = fmax(*rate, fabs((RampValue(ramp, t + e) - RampValue(ramp, t - e)) / (2 * e) - RampRate(ramp, t)));
  }
}

/* Breaks when: a swing has another frequency, phase or beginning, or when its integral or rate is another, with a ramp of either shape,
   also one of the swing's own half period, and without. Errors of central differences: e^2 / 6 r''' with |r'''| <= 1.5e3 here */
static int TestSwing(void)
{
  int failed = 0;

  for (int k = 0; k < 6; k++) {
    const Ramp swing = {
      .shape = (RampShape)(k % 2), .delay = 0.25, .length = (k / 2) * 0.25, .frequency = 1, .phase = 30};
    double way, rate;

    Differences(&swing, k < 2 ? 10 : swing.length, &way, &rate);
    failed += CheckClose("way of a swing, largest error", way, 0, 1e-6) + CheckClose("its rate", rate, 0, 1e-6);
    failed += CheckClose("before the delay", RampValue(&swing, 0.2499), 0, 0);
    failed += CheckClose("a sixth of a period after the ramps: cos 90", RampValue(&swing, 1.25 + 1. / 6), 0, 1e-15);
  }
  return failed;
}

/* Breaks when: a table is not straight between its rows, does not stay as it ends, or has another integral or rate.
   0, 1, -1 at 0, 1/4, 1/2: areas 1/8, 0, then -1 over the time */
static int TestTable(void)
{
  PetscReal  time[] = {0, 0.25, 0.5}, factor[] = {0, 1, -1}, area[] = {0, 0.125, 0.125};
  const Ramp table = {.shape = RAMP_SMOOTH, .delay = 0.125, .n = 3, .time = time, .factor = factor, .area = area};
  double     way, rate;
  int        failed = 0;

  Differences(&table, 0.25, &way, &rate);
  failed += CheckClose("way of a table, largest error", way, 0, 1e-3) + CheckClose("its rate", rate, 0, 1e-9);
  failed += CheckClose("an eighth after the delay", RampValue(&table, 0.25), 0.5, 1e-15) +
            CheckClose("at a row", RampValue(&table, 0.375), 1, 1e-15);
  failed += CheckClose("between two", RampValue(&table, 0.5), 0, 1e-15) +
            CheckClose("after the last", RampValue(&table, 3), -1, 0);
  failed += CheckClose("way to the last", RampIntegral(&table, 0.625), 0.125, 1e-15);
  return failed + CheckClose("way after the last", RampIntegral(&table, 1.625), -0.875, 1e-15);
}

/* Breaks when: a ramp without length divides by it, or the instant of the jump itself counts as before */
static int TestJump(void)
{
  int failed = 0;

  for (int shape = 0; shape < RAMP_N_SHAPES; shape++) {
    const Ramp jump = {.shape = (RampShape)shape, .delay = 0.5};

    failed += CheckClose("before a jump", RampValue(&jump, 0.4999), 0, 0);
    failed += CheckClose("at a jump", RampValue(&jump, 0.5), 1, 0);
    failed += CheckClose("way after a jump", RampIntegral(&jump, 2), 1.5, 1e-15);
    failed += CheckClose("way before a jump", RampIntegral(&jump, 0.25), 0, 0);
  }
  return failed;
}

static PetscErrorCode Read(const char options[], Ramp *ramp, char words[160])
{
  PetscFunctionBeginUser;
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscOptionsInsertString(NULL, options));
  PetscCall(RampSetFromOptions(PETSC_COMM_WORLD, "a load", "press", ramp));
  PetscCall(RampDescribe(ramp, 160, words));
  PetscFunctionReturn(0);
}

/* Breaks when: an option is not read under the prefix, what the ramp held before stays, or the words are others */
static PetscErrorCode TestOptions(int *failed)
{
  Ramp ramp = {.shape = RAMP_LINEAR, .delay = 7, .length = 8};
  char words[160];

  PetscFunctionBeginUser;
  PetscCall(Read("", &ramp, words));
  *failed += CheckTrue("default: at once", !strcmp(words, "at once") && ramp.delay == 0, ramp.length);
  PetscCall(Read("-press_ramp 0.002 -other_ramp 3", &ramp, words));
  *failed += CheckTrue("smooth without a shape", !strcmp(words, "smooth ramp over 0.002 s"), ramp.length);
  PetscCall(Read("-press_ramp 0.002 -press_ramp_shape linear -press_delay 1e-3", &ramp, words));
  *failed += CheckTrue("all of them", !strcmp(words, "linear ramp over 0.002 s from 0.001 s"), ramp.delay);
  PetscCall(Read("-press_frequency 50 -press_phase -90", &ramp, words));
  *failed += CheckTrue("a swing", !strcmp(words, "at once, swings at 50 Hz from -90 degrees on"), ramp.frequency);
  PetscCall(Read("-press_ramp 0.002 -press_ramp_shape linear -press_delay 1e-3", &ramp, words));
  *failed += CheckTrue("values", ramp.shape == RAMP_LINEAR && ramp.length == 0.002 && ramp.delay == 1e-3, ramp.length);
  PetscFunctionReturn(0);
}

/* Breaks when: a length or delay that is no time passes */
static PetscErrorCode TestBad(int *failed)
{
  static const char *const bad[] = {"-press_ramp -1e-3", "-press_delay -1", "-press_ramp nan", "-press_delay inf"};
  Ramp                     ramp;
  char                     words[160];

  PetscFunctionBeginUser;
  for (int i = 0; i < 4; i++) {
    PetscErrorCode error;

    PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
    error = Read(bad[i], &ramp, words);
    PetscCall(PetscPopErrorHandler());
    *failed += CheckTrue(bad[i], error == PETSC_ERR_USER_INPUT, error);
  }
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  int failed = 0;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  failed +=
    TestValues() + TestIntegral(RAMP_LINEAR) + TestIntegral(RAMP_SMOOTH) + TestJump() + TestSwing() + TestTable();
  PetscCall(TestOptions(&failed));
  PetscCall(TestBad(&failed));
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscFinalize());
  printf("%d failed\n", failed);
  return failed ? 1 : 0;
}
