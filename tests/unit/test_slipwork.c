/*
   Unit test of the second path of friction (ContactProjectorGetSlipWork): steps that obey the law pass, and each kind of error is
   seen at its size. Two boxes with random masses, velocities and displacements, no stiffness.
*/
#include "twoboxes.h"
#include "contact/contactimpl.h"
#include "check.h"
#include "petscmain.h"

#define MU 0.3
#define DT 1e-3 /* s */

static const PetscReal x_lower[] = {0, 0.3, 0.5, 0.8, 1}, x_upper[] = {0.1, 0.3, 0.45, 0.6, 0.9};
static const PetscReal z_lower[] = {0, 0.5, 1}, z_upper[] = {1 + 1e-6, 1.5, 2};
static const Box       boxes[] = {
        {"lower", {5, 5, 3}, {x_lower, x_lower, z_lower}, .taper = 0.2},
        {"upper", {5, 5, 3}, {x_upper, x_upper, z_upper}, .taper = 0  }
};

/* Random masses, displacements, and velocities that press most of the nodes together */
static PetscErrorCode SliderFill(Slider *s, PetscReal seed)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < 3 * s->n; k++) {
    const PetscReal *x     = &s->x[k / 3 * 3];
    const PetscBool  slave = x[2] > 1 + 5e-7 ? PETSC_TRUE : PETSC_FALSE, normal = k % 3 == 2 ? PETSC_TRUE : PETSC_FALSE;

    s->minv[k]   = 1 / (1 + 0.5 * Noise(x, seed));
    s->u[k]      = 1e-3 * Noise(x, seed + 1 + k % 3) * (normal ? 1e-2 : 1);
    s->before[k] = s->v[k] = Noise(x, seed + 4 + k % 3) - (normal && slave ? 1 : 0);
    if (normal && slave) s->u[k] = PetscAbsReal(s->u[k]) + 2e-4;
  }
  PetscCall(ContactProjectorSetMass(s->projector, s->minv));
  PetscCall(ContactProjectorStart(s->projector, 0, s->u, 1e-6, NULL));
  PetscFunctionReturn(0);
}

/* One step, and its friction with the places after it; back: they have moved back instead; factor: of the coefficient that the law
   has when it is looked at */
static PetscErrorCode SliderLook(Slider *s, PetscReal seed, PetscBool back, PetscReal factor, ContactSlipWork *work)
{
  const ContactStep step = {.time = 0, .dt = DT, .kick = 0.7 * DT};
  PetscReal        *after;

  PetscFunctionBeginUser;
  PetscCall(SliderFill(s, seed));
  PetscCall(PetscArrayzero(s->force, 3 * s->n));
  PetscCall(ContactProject(s->projector, &step, s->u, s->before, s->v, s->force));
  PetscCall(PetscMalloc1(3 * s->n, &after));
  for (PetscInt k = 0; k < 3 * s->n; k++)
    after[k] = s->u[k] + (back ? -1 : 1) * DT * (s->v[k] + step.kick * s->minv[k] * s->force[k]);
  s->contact->interfaces[0].friction.parameter[0] = factor * MU;
  PetscCall(ContactProjectorGetSlipWork(s->projector, after, work));
  s->contact->interfaces[0].friction.parameter[0] = MU;
  PetscCall(PetscFree(after));
  PetscFunctionReturn(0);
}

/* Breaks when: places of other nodes or of another step are taken, or weights, directions or the frame are wrong; when a
   coefficient that is 1e-6 off, or friction that drives, is not seen. Against Coulomb's law with the slips of the places: the
   work is off by 1 - 1 / factor of the law's; that of friction with the other sign by twice the law's. */
static PetscErrorCode TestLook(const char more[], int *failed)
{
  const PetscReal off   = 1e-6;
  PetscReal       worst = 0, other = 0, reversed = 0;
  Slider          s;
  ContactSlipWork work;

  PetscFunctionBeginUser;
  PetscCall(SliderCreate(PETSC_COMM_WORLD, 2, boxes, BODIES "-joint_mu 0.3 ", more, &s));
  for (int k = 0; k < 10; k++) {
    PetscCall(SliderLook(&s, 20 * k, PETSC_FALSE, 1, &work));
    *failed += CheckTrue("friction works", work.law > 0 && work.size >= work.law, work.law);
    worst = PetscMax(worst, PetscMax(work.miss / work.size, work.over / work.normal));
    PetscCall(SliderLook(&s, 20 * k, PETSC_FALSE, 1 / (1 - off), &work));
    other = PetscMax(other, PetscAbsReal(work.miss / (off * work.law) - 1));
    PetscCall(SliderLook(&s, 20 * k, PETSC_TRUE, 1, &work));
    reversed = PetscMax(reversed, PetscAbsReal(work.miss / work.law - 2));
  }
  printf("%s\n", more);
  *failed += CheckClose("work of friction beside mu N on the way", worst, 0, 1e-9);
  *failed += CheckClose("a coefficient that is 1e-6 off, relative to that", other, 0, 1e-3);
  if (!more[0]) *failed += CheckClose("places that went back: twice the work", reversed, 0, 1e-6);
  PetscCall(SliderDestroy(&s));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  (void)size;
  PetscCall(TestLook("", failed));
  PetscCall(TestLook("-joint_slip 1,2,0 -joint_speed 0.7", failed));
  PetscCall(TestLook("-joint_slip 1,2,0 -joint_speed 0.7 -joint_kinematics turning", failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
