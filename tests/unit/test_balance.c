/*
   What the pairs can balance of loads on rigid motions, against closed forms in the plane; and the memory of the active set.
*/
#include "check.h"
#include "statics/staticsimpl.h"

/* One pair on motions along its normal and along its surface, pushed by (normal, along): sliding, or Coulomb's law */
static PetscErrorCode TestPair(const char what[], const PetscReal pair[8], const PetscReal push[2],
                               const PetscReal expected[2], int *failed)
{
  const RigidPairs k = {.m = 2, .n_pairs = 1, .width = 8, .pair = (PetscReal *)pair, .push = (PetscReal *)push};
  PetscReal        left[2], worst;

  PetscFunctionBeginUser;
  PetscCall(BalanceLoads(&k, 1, left, &worst));
  for (int i = 0; i < 2; i++) *failed += CheckClose(what, left[i], expected[i], 1e-14);
  *failed += CheckTrue("no force of the pair works along it", worst <= 1e-14, worst);
  PetscFunctionReturn(0);
}

/* Breaks when: forces pull, friction has another sign or size, or what is left is not the nearest. Moreau: the part of
   the push in the polar cone. Sliding mu = 0.75: forces along (1, -0.75) / 1.25; Coulomb: between (1, -0.75) and (1, 0.75). */
static PetscErrorCode TestPairs(int *failed)
{
  const PetscReal slides[8] = {0.75, 0, 1, 0, 0, 1, 0, 0}, coulomb[8] = {0, 0.75, 1, 0, 0, 1, 0, 0};

  PetscFunctionBeginUser;
  PetscCall(TestPair("sliding: a pull is left whole", slides, (PetscReal[]){-1, 0}, (PetscReal[]){-1, 0}, failed));
  PetscCall(
    TestPair("sliding: a press, but for friction", slides, (PetscReal[]){1, 0}, (PetscReal[]){0.36, 0.48}, failed));
  PetscCall(TestPair("sliding: balanced", slides, (PetscReal[]){1, -0.75}, (PetscReal[]){0, 0}, failed));
  PetscCall(TestPair("Coulomb: held by friction", coulomb, (PetscReal[]){1, 0.7}, (PetscReal[]){0, 0}, failed));
  PetscCall(TestPair("Coulomb: by more than friction", coulomb, (PetscReal[]){1, 2}, (PetscReal[]){-0.6, 0.8}, failed));
  PetscCall(TestPair("Coulomb: pulled off", coulomb, (PetscReal[]){-1, 1}, (PetscReal[]){-1, 1}, failed));
  PetscFunctionReturn(0);
}

/* Six pairs without friction at the edge of a table of radius 1, a load at r: left is nothing within the hexagon; at the
   corner's distance 1.5 the table tips about the line that is nearest. Motions: down, and the turns about x and y. Breaks
   when edges are dropped or repeated. */
static PetscErrorCode TestTable(int *failed)
{
  PetscReal  pair[6 * 11] = {0}, push[3] = {1, 0, 0}, left[3], worst;
  RigidPairs k = {.m = 3, .n_pairs = 6, .width = 11, .pair = pair, .push = push};

  PetscFunctionBeginUser;
  for (int i = 0; i < 6; i++) {
    PetscReal *n = &pair[11 * i + 2];

    n[0] = 1;
    n[1] = cos(i * PETSC_PI / 3);
    n[2] = sin(i * PETSC_PI / 3);
  }
  push[1] = 0.8;
  PetscCall(BalanceLoads(&k, 1, left, &worst));
  *failed += CheckClose("a load within the table", PetscAbsReal(left[0]) + PetscAbsReal(left[1]), 0, 1e-14);
  push[1] = 1.5;
  PetscCall(BalanceLoads(&k, 1, left, &worst));
  /* nearest to (1, 1.5) along (1, 1) */
  *failed += CheckClose("a load beyond its edge turns it down", left[0], -0.25, 1e-14);
  *failed += CheckClose("about the corner", left[1], 0.25, 1e-14);
  *failed += CheckTrue("no force works along it", worst <= 1e-14, worst);
  PetscFunctionReturn(0);
}

/* Two pairs without friction: all of the push but a part of 2e-7 is along one of them, and the other must take less than
   the rounding of the first's force so that nothing works along what is left. Breaks when that little force is zero,
   or its share of a step 0 / 0. */
static PetscErrorCode TestLittle(int *failed)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < 40; i++) {
    const PetscReal  turn         = 0.1 + 0.03 * i;
    PetscReal        pair[2 * 11] = {0, 0, 1}, push[3] = {113, 113 * 2e-7, 0}, left[3], worst;
    const RigidPairs k = {.m = 3, .n_pairs = 2, .width = 11, .pair = pair, .push = push};

    pair[11 + 2] = cos(turn);
    pair[11 + 3] = 4e-11;
    pair[11 + 4] = sin(turn);
    PetscCall(BalanceLoads(&k, 1, left, &worst));
    *failed += CheckClose("what one pair leaves", left[1] / push[1], 1, 1e-14);
    *failed += CheckTrue("the other takes its little part", worst <= 1e-14 * push[1], worst);
  }
  PetscFunctionReturn(0);
}

/* Statuses of three pairs with linear laws. Breaks when a circle is not seen, or seen where there is none. */
static PetscErrorCode TestRepeat(int *failed)
{
  static const ContactStatus way[4][3] = {
    {CONTACT_SLIP, CONTACT_SLIP, CONTACT_OPEN},
    {CONTACT_SLIP, CONTACT_OPEN, CONTACT_SLIP},
    {CONTACT_OPEN, CONTACT_SLIP, CONTACT_SLIP},
    {CONTACT_SLIP, CONTACT_OPEN, CONTACT_SLIP}
  };
  PetscInt      first[4] = {0, 1, 2, 3};
  PairRows      rows = {.comm = PETSC_COMM_SELF, .n_pairs = 3, .n_pairs_all = 3, .n = 3, .n_all = 3, .first = first};
  ContactStatus status[3];
  Active        a     = {.rows = &rows, .friction = 1, .status = status};
  Repeat        seen  = {.n = 0};
  PetscBool     repeats;

  PetscFunctionBeginUser;
  for (int i = 0; i < 4; i++) {
    PetscCall(PetscArraycpy(status, way[i], 3));
    PetscCall(RepeatFind(&a, &seen, &repeats));
    *failed += CheckTrue("a status repeats at the fourth only", repeats == (i == 3), i);
  }
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  int failed = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(TestPairs(&failed));
  PetscCall(TestTable(&failed));
  PetscCall(TestLittle(&failed));
  PetscCall(TestRepeat(&failed));
  PetscCall(PetscFinalize());
  printf("%d failed\n", failed);
  return failed ? 1 : 0;
}
