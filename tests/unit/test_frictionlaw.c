/* Friction laws: mu, mu' and their derivatives */
#include "check.h"
#include "petscmain.h"
#include <squeal/frictionlaw.h>

/* Breaks when: the slope is not taken about the stated speed, or a falling law goes below 0. By hand */
static int TestCoulomb(void)
{
  const FrictionLaw falling = {.speed = 20, .parameter = {0.3, -0.01}}, constant = {.speed = 20, .parameter = {0.3, 0}};
  const FrictionLaw against = {.speed = 20, .parameter = {-0.3, -0.01}};
  int               failed  = CheckClose("mu at the stated speed", FrictionMu(&falling, 20), 0.3, 0);

  failed += CheckClose("faster", FrictionMu(&falling, 30), 0.2, 1e-15);
  failed += CheckClose("at rest", FrictionMu(&falling, 0), 0.5, 1e-15);
  failed += CheckClose("never below 0", FrictionMu(&falling, 60), 0, 0);
  failed += CheckClose("constant", FrictionMu(&constant, 60), 0.3, 0);
  failed += CheckClose("slope", FrictionSlope(&falling, 30), -0.01, 0);
  failed += CheckClose("slope where it ended", FrictionSlope(&falling, 60), 0, 0);
  failed += CheckClose("against t, linearised", FrictionSteady(&against), -0.3, 0);
  failed += CheckTrue("constant friction does not vary", FrictionVaries(&falling) && !FrictionVaries(&constant), 0);
  return failed;
}

/* Breaks when: mu is not mu_k + (mu_s - mu_k) exp(-s / s_0). By hand: exp(-ln 2) = 1/2 */
static int TestStaticKinetic(void)
{
  const FrictionLaw law    = {.kind = 1, .speed = 2, .parameter = {0.5, 0.3, 0.1}};
  int               failed = CheckClose("at rest", FrictionMu(&law, 0), 0.5, 1e-15);

  failed += CheckClose("half way down", FrictionMu(&law, 0.1 * log(2)), 0.4, 1e-15);
  failed += CheckClose("its slope", FrictionSlope(&law, 0.1 * log(2)), -1, 1e-14);
  failed += CheckClose("far beyond", FrictionMu(&law, 10), 0.3, 1e-15);
  failed += CheckTrue("it knows the speed itself", FrictionNeedsSpeed(&law) && FrictionVaries(&law), 0);
  return failed;
}

/* Breaks when: mu is not mu_k + (mu_s - mu_k) exp(-(s / s_0)^2) + b s. By hand: exp(-ln 2) = 1/2, at sqrt(ln 2) s_0 */
static int TestStribeck(void)
{
  const FrictionLaw law    = {.kind = 2, .speed = 2, .parameter = {0.5, 0.3, 0.2, 0.1}};
  const PetscReal   half   = 0.1 * sqrt(log(2));
  int               failed = CheckClose("at rest", FrictionMu(&law, 0), 0.5, 1e-15);

  failed += CheckClose("half way down", FrictionMu(&law, half), 0.4 + 0.2 * half, 1e-15);
  failed += CheckClose("its slope", FrictionSlope(&law, half), -20 * half + 0.2, 1e-14);
  failed += CheckClose("level at rest but for b", FrictionSlope(&law, 0), 0.2, 1e-15);
  failed += CheckClose("far beyond", FrictionMu(&law, 10), 2.3, 1e-15);
  failed += CheckTrue("it knows the speed itself", FrictionNeedsSpeed(&law) && FrictionVaries(&law), 0);
  return failed;
}

/* d f / d x by central differences, f mu or mu' at the stated speed; x a parameter of the law, or that speed (j < 0) */
static PetscReal Difference(const FrictionLaw *law, PetscReal (*f)(const FrictionLaw *), int j)
{
  FrictionLaw     a = *law, b = *law;
  const PetscReal h = 1e-5 * PetscMax(0.1, j < 0 ? law->speed : PetscAbsReal(law->parameter[j]));

  *(j < 0 ? &a.speed : &a.parameter[j]) -= h;
  *(j < 0 ? &b.speed : &b.parameter[j]) += h;
  return (f(&b) - f(&a)) / (2 * h);
}

/* Breaks when: a derivative is not that of the function. Reference: central differences */
static int TestDerivatives(const FrictionLaw *law)
{
  const FrictionParameter *parameter;
  const PetscInt           n = FrictionGetParameters(law, &parameter);
  FrictionDerivative       d;
  const PetscReal          h      = 1e-6 * PetscMax(0.1, law->speed);
  const PetscReal          slope  = (FrictionMu(law, law->speed + h) - FrictionMu(law, law->speed - h)) / (2 * h);
  int                      failed = CheckClose("mu'", FrictionSteadySlope(law), slope, 1e-8);

  FrictionDerive(law, &d);
  for (int j = 0; j < n; j++) {
    printf("     by %s\n", parameter[j].row.name);
    failed += CheckClose("mu", d.mu[j], Difference(law, FrictionSteady, j), 1e-8);
    failed += CheckClose("mu'", d.slope[j], Difference(law, FrictionSteadySlope, j), 1e-7);
  }
  failed += CheckClose("mu by the stated speed", d.stated[0], Difference(law, FrictionSteady, -1), 1e-8);
  failed += CheckClose("mu' by the stated speed", d.stated[1], Difference(law, FrictionSteadySlope, -1), 1e-7);
  return failed;
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  (void)size;
  *failed += TestCoulomb();
  *failed += TestDerivatives(&(FrictionLaw){.speed = 2, .parameter = {0.3, -0.01}});
  *failed += TestStaticKinetic();
  *failed += TestDerivatives(&(FrictionLaw){.kind = 1, .speed = 0.15, .parameter = {0.5, 0.3, 0.1}});
  *failed += TestDerivatives(&(FrictionLaw){.kind = 1, .speed = 3, .parameter = {0.2, 0.6, 1.5}});
  *failed += TestStribeck();
  *failed += TestDerivatives(&(FrictionLaw){.kind = 2, .speed = 0.12, .parameter = {0.5, 0.3, 0.2, 0.1}});
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
