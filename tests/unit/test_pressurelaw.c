/* Pressure laws: P, its slope and its inverse */
#include "check.h"
#include "petscmain.h"
#include <squeal/pressurelaw.h>

#define EXPONENTIAL 1
#define POWER       2
#define TABLE       3

/* Breaks when: the curve is not p0 / (e - 1) x (e^x - 1), x = c / c0 + 1. By hand: P(0) = p0, P(c0) = 2 (e + 1) p0, and at
   0 the slope p0 / c0 (2 e - 1) / (e - 1) */
static int TestExponential(void)
{
  const PressureLaw law    = {.kind = EXPONENTIAL, .parameter = {1e-5, 2e5}};
  const PetscReal   e      = exp(1);
  int               failed = CheckClose("where they meet", PressureAt(&law, 0), 2e5, 1e-10);

  failed += CheckClose("one clearance farther", PressureAt(&law, 1e-5), 2 * (e + 1) * 2e5, 1e-9);
  failed += CheckClose("its slope", PressureSlope(&law, 0), 2e10 * (2 * e - 1) / (e - 1), 1e-4);
  failed += CheckClose("the onset", PressureOnset(&law), -1e-5, 0);
  failed += CheckClose("apart", PressureAt(&law, -2e-5), 0, 0);
  failed += CheckClose("apart, its slope", PressureSlope(&law, -2e-5), 0, 0);
  failed += CheckClose("no pressure", PressureClosing(&law, 0), -1e-5, 0);
  return failed;
}

/* Breaks when: the curve is not k c^m. By hand */
static int TestPower(void)
{
  const PressureLaw law = {.kind = POWER, .parameter = {1e15, 2}}, linear = PressureLinear(1e12);
  int               failed = CheckClose("squared", PressureAt(&law, 3e-6), 9e3, 1e-10);

  failed += CheckClose("its slope", PressureSlope(&law, 3e-6), 6e9, 1e-4);
  failed += CheckClose("its root", PressureClosing(&law, 9e3), 3e-6, 1e-20);
  failed += CheckClose("apart", PressureAt(&law, -3e-6), 0, 0);
  failed += CheckClose("linear", PressureAt(&linear, 3e-6), 3e6, 1e-9);
  failed += CheckClose("linear, back", PressureClosing(&linear, 3e6), 3e-6, 1e-20);
  failed += CheckTrue("which is which", PressureIsLinear(&linear) && !PressureIsLinear(&law), 0);
  return failed;
}

/* Breaks when: a line of the table is missed, or the last does not go on. By hand */
static int TestTable(void)
{
  PetscReal         points[] = {-2, 0, -1, 10, 1, 30, 3, 70};
  const PressureLaw law      = {.kind = TABLE, .n_points = 4, .point = points};
  int               failed   = CheckClose("within the first line", PressureAt(&law, -1.5), 5, 1e-15);

  failed += CheckClose("within the second", PressureAt(&law, 0), 20, 1e-14);
  failed += CheckClose("beyond", PressureAt(&law, 5), 110, 1e-14);
  failed += CheckClose("apart", PressureAt(&law, -3), 0, 0);
  failed += CheckClose("slope at the onset", PressureSlope(&law, -2), 10, 0);
  failed += CheckClose("slope at a point, to its right", PressureSlope(&law, 1), 20, 1e-14);
  failed += CheckClose("closing within", PressureClosing(&law, 20), 0, 1e-15);
  failed += CheckClose("closing beyond", PressureClosing(&law, 110), 5, 1e-15);
  failed += CheckClose("no pressure", PressureClosing(&law, 0), -2, 0);
  return failed;
}

/* Breaks when: the inverse is none at some pressure, 1e-8 to 1e30 of that of the law, or the slope is not P'. References:
   P itself; its central difference */
static int TestInverse(const char name[], PressureLaw law, PetscReal pressure)
{
  PetscReal miss = 0, slope = 0;

  for (int i = -80; i <= 300; i++) {
    const PetscReal p = pressure * pow(10, i / 10.), c = PressureClosing(&law, p), h = 1e-5 * (c - PressureOnset(&law));
    const PetscReal difference = (PressureAt(&law, c + h) - PressureAt(&law, c - h)) / (2 * h);

    miss  = PetscMax(miss, PetscAbsReal(PressureAt(&law, c) / p - 1));
    slope = PetscMax(slope, PetscAbsReal(difference / PressureSlope(&law, c) - 1));
  }
  printf("     %s\n", name);
  return CheckClose("P of its inverse", miss, 0, 1e-9) + CheckClose("its slope", slope, 0, 1e-6);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  (void)size;
  *failed += TestExponential() + TestPower() + TestTable();
  *failed += TestInverse("exponential", (PressureLaw){.kind = EXPONENTIAL, .parameter = {1e-5, 2e5}}, 2e5);
  *failed += TestInverse("power", (PressureLaw){.kind = POWER, .parameter = {1e17, 2.5}}, 1e5);
  *failed += TestInverse("steep power", (PressureLaw){.kind = POWER, .parameter = {1e45, 8}}, 1e5);
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
