/*
   Unit test of contact/: residuals of the laws for states made by hand, and the front between closed and open pairs,
   moved by rows, on one and on several ranks.

   The pad of a coarse brake faces the disc with 5 x 5 nodes; references are counted or written out for that square.
*/
#include "check.h"
#include "pairs.h"

#define KN      1e9 /* N/m */
#define MU      0.5
#define LARGEST 200  /* N, the largest normal force of the states */
#define GAP     1e-6 /* m, the largest gap */

/* A closed pair that obeys all laws; friction along the slip */
static ContactState Closed(PetscReal lambda_n, PetscReal slip_t, PetscReal slip_b)
{
  const PetscReal    slip  = PetscSqrtReal(slip_t * slip_t + slip_b * slip_b);
  const ContactState state = {.status   = CONTACT_SLIP,
                              .gap      = -lambda_n / KN,
                              .slip     = {slip_t, slip_b},
                              .lambda_n = lambda_n,
                              .lambda_t = {MU * lambda_n * slip_t / slip, MU * lambda_n * slip_b / slip}};

  return state;
}

/* A state to stand at the middle of the pad, and the residuals that it makes */
typedef struct {
  const char  *name;
  PetscBool    slides; /* the interface slides along t; else by Coulomb's law */
  PetscReal    kn;
  ContactState state;
  ContactKKT   expected;
} StateCase;

/* All other pairs obey the laws; the largest force and gap are theirs. Breaks when: a residual has a wrong sign or
   scale, or looks at the wrong direction. Reference: the definitions by hand, beside each case */
/* clang-format off */
static const StateCase cases[] = {
  {"all obey", PETSC_TRUE, KN, {CONTACT_SLIP, -100 / KN, {1e-7, 0}, 100, {50, 0}}, {0, 0, 0, 0, 0}},
  {"overlap of 2e-7 m", PETSC_TRUE, KN, {CONTACT_OPEN, -2e-7, {0, 0}, 0, {0, 0}}, {0.2, 0, 0.2, 0, 0}},
  {"pulls with 50 N", PETSC_TRUE, KN, {CONTACT_SLIP, 50 / KN, {0, 0}, -50, {-25, 0}}, {0, 0.25, 0.25, 0.25, 0}},
  {"100 N across 5e-7 m", PETSC_TRUE, KN, {CONTACT_SLIP, 5e-7 - 100 / KN, {0, 0}, 100, {50, 0}}, {0, 0, 0.5, 0, 0}},
  {"10 N beyond the cone", PETSC_TRUE, KN, {CONTACT_SLIP, -100 / KN, {0, 0}, 100, {60, 0}}, {0, 0, 0, 0.05, 0.05}},
  {"friction across", PETSC_TRUE, KN, {CONTACT_SLIP, -100 / KN, {0, 0}, 100, {0, 50}},
   {0, 0, 0, 0, 0.35355339059327376}},
  {"Coulomb, along", PETSC_FALSE, KN, {CONTACT_SLIP, -100 / KN, {3e-7, 4e-7}, 100, {30, 40}}, {0, 0, 0, 0, 0}},
  {"Coulomb, against", PETSC_FALSE, KN, {CONTACT_SLIP, -100 / KN, {3e-7, 4e-7}, 100, {-30, -40}}, {0, 0, 0, 0, 0.5}},
  {"Coulomb, no way", PETSC_FALSE, KN, {CONTACT_SLIP, -100 / KN, {0, 0}, 100, {-30, -40}}, {0, 0, 0, 0, 0}},
  {"sticks", PETSC_FALSE, KN, {CONTACT_STICK, -100 / KN, {0, 0}, 100, {-30, 20}}, {0, 0, 0, 0, 0}},
  {"sticks and moves", PETSC_FALSE, KN, {CONTACT_STICK, -100 / KN, {0, 1e-7}, 100, {-30, 20}}, {0, 0, 0, 0, 0.1}},
  {"constraint", PETSC_TRUE, INFINITY, {CONTACT_SLIP, -1e-7, {0, 0}, 100, {50, 0}}, {0.2, 0, 0.2, 0, 0}},
  {"no number", PETSC_TRUE, KN, {CONTACT_SLIP, NAN, {0, 0}, 100, {50, 0}},
   {INFINITY, INFINITY, INFINITY, INFINITY, INFINITY}},
};
/* clang-format on */

/* Equal, also where both are infinite */
static int CheckSame(const char name[], PetscReal value, PetscReal expected)
{
  if (PetscIsInfReal(expected)) return CheckTrue(name, value == expected, (double)value);
  return CheckClose(name, value, expected, 1e-15);
}

static PetscErrorCode TestState(Contact contact, const StateCase *c, int *failed)
{
  PetscInt           n, n_all, place[MAX_PAIRS][2];
  const ContactPair *pair;
  ContactState       state[MAX_PAIRS];
  ContactKKT         kkt;
  PetscReal          mu[MAX_PAIRS];

  PetscFunctionBeginUser;
  PetscCall(ContactGetPairs(contact, &n, &n_all, &pair));
  for (PetscInt p = 0; p < n; p++) mu[p] = MU;
  PetscCall(PlacesFind(contact, place));
  for (PetscInt p = 0; p < n; p++) {
    if (place[p][0] == 2 && place[p][1] == 2)
      state[p] = c->state;
    else if (place[p][0] == 0)
      state[p] = (ContactState){.status = CONTACT_OPEN, .gap = GAP};
    else
      state[p] = Closed(LARGEST / (PetscReal)place[p][0], 2e-7, 0);
    if (PetscIsInfReal(c->kn) && place[p][0] == 1) state[p].gap = -2e-7;
    if (PetscIsInfReal(c->kn) && place[p][0] > 1 && place[p][1] != 2) state[p].gap = 0;
  }
  PetscCall(ContactComputeKKT(contact, state, mu, &(PressureLaw){.parameter = {c->kn}}, 0, &kkt));
  printf("     %s\n", c->name);
  *failed += CheckSame("penetration", kkt.penetration, c->expected.penetration);
  *failed += CheckSame("sign", kkt.sign, c->expected.sign);
  *failed += CheckSame("complementarity", kkt.complementarity, c->expected.complementarity);
  *failed += CheckSame("cone", kkt.cone, c->expected.cone);
  *failed += CheckSame("dissipation", kkt.dissipation, c->expected.dissipation);
  PetscFunctionReturn(0);
}

/* Whether a place is closed at first; patterns with corners, edges, holes and islands */
static PetscBool IsClosed(int pattern, PetscInt i, PetscInt k)
{
  switch (pattern) {
  case 0:
    return i == 0 && k == 0 ? PETSC_TRUE : PETSC_FALSE; /* a corner */
  case 1:
    return k == 0 ? PETSC_TRUE : PETSC_FALSE; /* an edge */
  case 2:
    return i + k <= 3 ? PETSC_TRUE : PETSC_FALSE; /* a slanted front */
  case 3:
    return (7 * i + 3 * k) % 11 < 2 ? PETSC_TRUE : PETSC_FALSE; /* islands */
  case 4:
    return i == 4 && k == 4 ? PETSC_FALSE : PETSC_TRUE; /* all but a corner */
  case 5:
    return PETSC_FALSE;
  default:
    return PETSC_TRUE;
  }
}

/* The pattern after some rows, by its definition: closed where any place at most so many steps away, also diagonally,
   is closed (rows > 0), open where any is open (rows < 0) */
static PetscBool IsClosedAfter(int pattern, PetscInt rows, PetscInt i, PetscInt k)
{
  const PetscInt  reach  = PetscAbsInt(rows);
  const PetscBool sought = rows > 0 ? PETSC_TRUE : PETSC_FALSE;

  for (PetscInt a = PetscMax(0, i - reach); a <= PetscMin(SIDE - 1, i + reach); a++)
    for (PetscInt b = PetscMax(0, k - reach); b <= PetscMin(SIDE - 1, k + reach); b++)
      if (IsClosed(pattern, a, b) == sought) return sought;
  return sought ? PETSC_FALSE : PETSC_TRUE;
}

/* Breaks when: a front moves to the wrong side or by other than whole rows, one interface takes the status of the
   other, or the ranks count. Reference: the definition on a square of places */
static PetscErrorCode TestGrow(Contact contact, int *failed)
{
  const ContactPair *pair;
  PetscInt           n, n_all, place[MAX_PAIRS][2];
  PetscBool          closed[MAX_PAIRS];

  PetscFunctionBeginUser;
  PetscCall(ContactGetPairs(contact, &n, &n_all, &pair));
  PetscCall(PlacesFind(contact, place));
  for (int pattern = 0; pattern < 7; pattern++)
    for (PetscInt rows = -2; rows <= 2; rows++) {
      PetscInt count[2] = {0, 0};
      char     name[64];

      for (PetscInt p = 0; p < n; p++)
        closed[p] = IsClosed((pattern + 3 * (int)pair[p].interface) % 7, place[p][0], place[p][1]);
      PetscCall(ContactGrow(contact, rows, closed));
      for (PetscInt p = 0; p < n; p++) {
        const int mine = (pattern + 3 * (int)pair[p].interface) % 7;

        count[0] += closed[p] != (rows ? IsClosedAfter(mine, rows, place[p][0], place[p][1])
                                       : IsClosed(mine, place[p][0], place[p][1]));
        count[1]++;
      }
      PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 2, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
      PetscCall(PetscSNPrintf(name, sizeof(name), "pattern %d, %d rows: wrong pairs", pattern, (int)rows));
      *failed += CheckTrue(name, count[0] == 0 && count[1] == 2 * SIDE * SIDE, (double)count[0]);
    }
  PetscFunctionReturn(0);
}

/* Breaks when: these tests see one rank only */
static PetscErrorCode TestShared(Contact contact, int *failed)
{
  const ContactPair *pair;
  PetscInt           n, n_all;
  PetscMPIInt        size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  PetscCall(ContactGetPairs(contact, &n, &n_all, &pair));
  *failed += CheckTrue("three ranks share the pairs", size < 3 || n < n_all, (double)n);
  PetscFunctionReturn(0);
}

/* Lifts the pad's face off the disc, shifts it along so that no nodes meet, and turns everything by 0.7 about x and by
   0.3 about y, in place */
static PetscErrorCode MeshMove(Model model, PetscReal lift)
{
  const Mesh *mesh;
  PetscReal  *x;
  PetscInt    n, *vertex;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  x = (PetscReal *)mesh->x;
  PetscCall(ModelGetSetNodes(model, "pad_face", &n, &vertex));
  for (PetscInt i = 0; i < n; i++) {
    x[3 * vertex[i]] += 1e-3;
    x[3 * vertex[i] + 1] += 7e-4;
    x[3 * vertex[i] + 2] += lift;
  }
  PetscCall(PetscFree(vertex));
  for (PetscInt v = 0; v < mesh->n_nodes; v++) {
    const PetscReal y = x[3 * v + 1], z = x[3 * v + 2], x0 = x[3 * v], z1 = sin(0.7) * y + cos(0.7) * z;

    x[3 * v]     = cos(0.3) * x0 + sin(0.3) * z1;
    x[3 * v + 1] = cos(0.7) * y - sin(0.7) * z;
    x[3 * v + 2] = cos(0.3) * z1 - sin(0.3) * x0;
  }
  PetscFunctionReturn(0);
}

/* Breaks when: rounding of the coordinates of touching meshes makes gaps, or a gap has the wrong sign or size.
   Reference: the height by which the face was lifted */
static PetscErrorCode TestGap(PetscReal lift, PetscReal tolerance, int *failed)
{
  const ContactPair *pair;
  PetscInt           n, n_all;
  PetscReal          worst = 0;
  Model              model;
  Contact            contact;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscOptionsInsertString(NULL, BRAKE SLIP BODIES_1 BEAM_1 COARSE));
  PetscCall(ModelCreate(PETSC_COMM_WORLD, &model));
  PetscCall(ModelSetFromOptions(model));
  PetscCall(ContactCreate(model, &contact));
  PetscCall(ContactSetFromOptions(contact));
  PetscCall(ModelSetUp(model));
  PetscCall(MeshMove(model, lift));
  PetscCall(ContactSetUp(contact));
  PetscCall(ContactGetPairs(contact, &n, &n_all, &pair));
  for (PetscInt p = 0; p < n; p++) worst = PetscMax(worst, PetscAbsReal(pair[p].gap - lift));
  *failed += CheckClose(lift > 0 ? "gap of a lifted pad" : "gap of touching meshes", worst, 0, tolerance);
  PetscCall(ContactDestroy(&contact));
  PetscCall(ModelDestroy(&model));
  PetscFunctionReturn(0);
}

/* Breaks when: modes are computed about a sliding state that nothing describes. Reference: the error, and what needs no
   direction of slip */
static PetscErrorCode TestWithoutSlip(Chain *chain, int *failed)
{
  PetscErrorCode error;
  PetscReal      mu;
  PressureLaw    law;
  Mat            K;

  PetscFunctionBeginUser;
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  error = ChainLinearise(chain, NULL);
  PetscCall(PetscPopErrorHandler());
  *failed += CheckTrue("no pencil without a slip", error == PETSC_ERR_USER_INPUT, error);
  PetscCall(OperatorsGetBodies(chain->operators, NULL, &K, NULL, NULL));
  PetscCall(OperatorsGetInterface(chain->operators, NULL, 0, &mu, &law));
  *failed += CheckTrue("bodies", K != NULL, 1);
  *failed += CheckClose("mu of the scene", mu, MU, 0);
  *failed += CheckClose("k_n of the scene", PressureSlope(&law, 0), 2.5895e8, 0);
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  Chain slides, holds, two;
  int   failed = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(ChainCreate(BRAKE SLIP, BODIES_1 BEAM_1 COARSE, &slides));
  PetscCall(ChainCreate(BRAKE, BODIES_1 BEAM_1 COARSE, &holds));
  PetscCall(ChainCreate(BRAKE SLIP TWO_CONTACTS, BODIES_1 BEAM_1 COARSE "-more_kn 3e7", &two));
  for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++)
    PetscCall(TestState(cases[i].slides ? slides.contact : holds.contact, &cases[i], &failed));
  PetscCall(TestGrow(two.contact, &failed));
  PetscCall(TestShared(two.contact, &failed));
  PetscCall(TestWithoutSlip(&holds, &failed));
  PetscCall(ChainDestroy(&slides));
  PetscCall(ChainDestroy(&holds));
  PetscCall(ChainDestroy(&two));
  PetscCall(TestGap(0, 0, &failed));
  PetscCall(TestGap(1e-6, 1e-15, &failed));
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscFinalize());
  printf("%d failed\n", failed);
  return failed ? 1 : 0;
}
