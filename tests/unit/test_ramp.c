/*
   Unit test of base/ramp.h and of the options of a ramp.

   References: the definitions, their values at places where they are rational, the trapezoidal rule with its correction
   at the ends for the integral, central differences for the rate.
*/
#include "check.h"
#include "base/ramp.h"

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
  failed += CheckClose("linear rate", RampRate(&linear, 0.3), 2, 1e-15);
  failed +=
    CheckClose("rate before", RampRate(&linear, 0.1), 0, 0) + CheckClose("rate after", RampRate(&linear, 0.9), 0, 0);
  failed += CheckClose("smooth rate begins at", RampRate(&smooth, 0.25), 0, 1e-15);
  failed += CheckClose("smooth rate half way: pi / 2 / length", RampRate(&smooth, 0.5), 3.141592653589793, 1e-14);
  failed += CheckClose("way after a linear ramp: half of its length is lost", RampIntegral(&linear, 2), 1.5, 1e-15);
  return failed + CheckClose("way after a smooth ramp", RampIntegral(&smooth, 2), 1.5, 1e-15);
}

/* Breaks when: the integral is not that of the value, or the rate not its derivative, inside the ramp or past its ends.
   Errors of the two rules: h^2 / 12 (r'(b) - r'(a)) + h^4 terms, and e^2 / 6 r''' with r''' <= (pi / length)^3 / 2 */
static int TestDerivatives(RampShape shape)
{
  const Ramp   ramp = {.shape = shape, .delay = 0.25, .length = 0.5};
  const double h = 1. / 4096, e = 1. / 65536;
  double       sum = 0, worst[2] = {0, 0};

  for (int i = 0; i < 4096; i++) {
    const double t = i * h, middle = t + h / 2;
    const double ends = (RampRate(&ramp, t + h) - RampRate(&ramp, t)) * h * h / 12;
    const int    kink = shape == RAMP_LINEAR && (t + h == 0.25 || t == 0.25 || t + h == 0.75 || t == 0.75);

    sum += h / 2 * (RampValue(&ramp, t) + RampValue(&ramp, t + h)) - (kink ? 0 : ends);
    worst[0] = fmax(worst[0], fabs(sum - RampIntegral(&ramp, t + h)));
    worst[1] = fmax(worst[1], fabs((RampValue(&ramp, middle + e) - RampValue(&ramp, middle - e)) / (2 * e) -
                                   RampRate(&ramp, middle)));
  }
  return CheckClose("integral of the value, largest error", worst[0], 0, 1e-13) +
         CheckClose("derivative of the value, largest error", worst[1], 0,
                    e * e / 6 * pow(RAMP_PI / 0.5, 3) / 2 + 1e-10);
}

/* Breaks when: a ramp without length divides by it, or the instant of the jump itself counts as before */
static int TestJump(void)
{
  int failed = 0;

  for (int shape = 0; shape < RAMP_N_SHAPES; shape++) {
    const Ramp jump = {.shape = (RampShape)shape, .delay = 0.5};

    failed += CheckClose("before a jump", RampValue(&jump, 0.4999), 0, 0);
    failed += CheckClose("at a jump", RampValue(&jump, 0.5), 1, 0);
    failed += CheckClose("rate at a jump", RampRate(&jump, 0.5), 0, 0);
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
  PetscOptionsBegin(PETSC_COMM_WORLD, "press_", "a load", NULL);
  PetscCall(RampSetFromOptions(PetscOptionsObject, ramp));
  PetscOptionsEnd();
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
  failed += TestValues() + TestDerivatives(RAMP_LINEAR) + TestDerivatives(RAMP_SMOOTH) + TestJump();
  PetscCall(TestOptions(&failed));
  PetscCall(TestBad(&failed));
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscFinalize());
  printf("%d failed\n", failed);
  return failed ? 1 : 0;
}
