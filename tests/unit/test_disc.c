/*
   Unit test of the names of a disc's shapes (modes/label/disc.h).

   References: shapes of known harmonics and directions, written at the nodes of a ring that is turned and moved, its
   contact at an angle of 40 degrees; shares of two harmonics of known amplitudes.
*/
#include "check.h"
#include "petscmain.h"
#include "modes/label/disc.h"
#include "base/algebra/vec3.h"

#define COLUMNS 48
#define RINGS   5
#define LAYERS  9
#define NODES   (COLUMNS * RINGS * LAYERS)
#define CONTACT (40 * PETSC_PI / 180)

/* Amplitudes of harmonic n at the radius r (m) and the height z (in half lengths): (w, u_r, u_theta) of the cosine and
   of the sine */
typedef void Amplitudes(PetscReal r, PetscReal z, PetscReal cosine[3], PetscReal sine[3]);

static void Flexure3(PetscReal r, PetscReal z, PetscReal c[3], PetscReal s[3])
{
  (void)z;
  c[1] = 3 * r;
  s[2] = -r;
}

static void Flexure3Odd(PetscReal r, PetscReal z, PetscReal c[3], PetscReal s[3])
{
  (void)z;
  s[1] = 3 * r * r;
  c[2] = r * r;
}

static void Extension2(PetscReal r, PetscReal z, PetscReal c[3], PetscReal s[3])
{
  (void)r, (void)z;
  c[1] = 1;
  s[2] = 2;
}

static void Extension2Turned(PetscReal r, PetscReal z, PetscReal c[3], PetscReal s[3])
{
  (void)r, (void)z;
  s[1] = -1;
  c[2] = 2;
}

static void Breathing(PetscReal r, PetscReal z, PetscReal c[3], PetscReal s[3])
{
  (void)z, (void)s;
  c[1] = r;
}

static void BreathingCircle(PetscReal r, PetscReal z, PetscReal c[3], PetscReal s[3])
{
  (void)z, (void)s;
  c[1] = 0.09 - r;
}

/* Held at its inner edge */
static void TorsionHeld(PetscReal r, PetscReal z, PetscReal c[3], PetscReal s[3])
{
  (void)z, (void)s;
  c[2] = r - 0.06;
}

static void Torsion(PetscReal r, PetscReal z, PetscReal c[3], PetscReal s[3])
{
  (void)z, (void)s;
  c[2] = r - 0.09;
}

static void Translation(PetscReal r, PetscReal z, PetscReal c[3], PetscReal s[3])
{
  (void)r, (void)z;
  c[1] = 1;
  s[2] = -1;
}

static void Stretch1(PetscReal r, PetscReal z, PetscReal c[3], PetscReal s[3])
{
  (void)r, (void)z;
  c[1] = 1;
  s[2] = 1;
}

static void Bending4(PetscReal r, PetscReal z, PetscReal c[3], PetscReal s[3])
{
  (void)z, (void)s;
  c[0] = r;
}

static void Bending5Circle(PetscReal r, PetscReal z, PetscReal c[3], PetscReal s[3])
{
  (void)z, (void)c;
  s[0] = r - 0.09;
}

/* Of a drum, open at one end */
static void Bell3(PetscReal r, PetscReal z, PetscReal c[3], PetscReal s[3])
{
  (void)r;
  c[1] = 3 * (1 + z);
  s[2] = -(1 + z);
}

/* A shape, the part of its amplitude that is another harmonic of the same energy per square, and its name */
typedef struct {
  const char *name;
  Amplitudes *shape;
  int         n, drum;
  PetscReal   other; /* 0.6: 64 % are the harmonic's; it is one of n + 5 */
} Case;

static const Case cases[] = {
  {"IP-R(3+)", Flexure3, 3, 0, 0},    {"IP-R(3)", Flexure3Odd, 3, 0, 0.6},
  {"IP-C(2)", Extension2, 2, 0, 0},   {"IP-C(2+)", Extension2Turned, 2, 0, 0.6},
  {"IP-R(0)", Breathing, 0, 0, 0},    {"IP-C(1,0)", Torsion, 0, 0, 0},
  {"IP-C(0)", TorsionHeld, 0, 0, 0},  {"IP-R(1,0)", BreathingCircle, 0, 0, 0},
  {"IP-R(1+)", Translation, 1, 0, 0}, {"IP-C(1)", Stretch1, 1, 0, 0.6},
  {"(0,4+)", Bending4, 4, 0, 0},      {"(1,5)", Bending5Circle, 5, 0, 0},
  {"IP-R(3+)", Bell3, 3, 1, 0.6},
};

#define N_CASES ((int)PETSC_STATIC_ARRAY_LENGTH(cases))

/* Node k of the disc or the drum: its radius (m), angle from the contact and height (of half the length) */
static void Place(int drum, int k, PetscReal *r, PetscReal *theta, PetscReal *z)
{
  *r     = 0.06 + (drum ? 0.01 : 0.06) * (k % RINGS) / (RINGS - 1);
  *theta = 2 * PETSC_PI * (k / RINGS % COLUMNS) / COLUMNS;
  *z     = -1 + 2. * (k / (RINGS * COLUMNS)) / (LAYERS - 1);
}

/* A vector (r, theta, z) at an angle from the contact, in the position of the ring: axis (1, 2, 2) / 3 */
static void Turn(PetscReal theta, const PetscReal v[3], PetscReal x[3])
{
  static const PetscReal axis[3] = {1. / 3, 2. / 3, 2. / 3}, e1[3] = {2. / 3, 1. / 3, -2. / 3};
  const PetscReal        c = cos(theta + CONTACT), s = sin(theta + CONTACT);
  PetscReal              e2[3];

  Vec3Cross(axis, e1, e2);
  for (int d = 0; d < 3; d++) x[d] = v[0] * axis[d] + (v[1] * c - v[2] * s) * e1[d] + (v[1] * s + v[2] * c) * e2[d];
}

/* Displacement of node k: a complex multiple (re, im) of the shape, by parts */
static void Displacement(const Case *is, int k, PetscReal u[2][3])
{
  PetscReal r, theta, z, v[3];

  Place(is->drum, k, &r, &theta, &z);
  for (int d = 0; d < 3; d++) u[0][d] = u[1][d] = 0;
  for (int j = 0; j < 2; j++) {
    const int       n    = is->n + 5 * j;
    const PetscReal size = j ? is->other : sqrt(1 - is->other * is->other);
    PetscReal       x[3], c[3] = {0}, s[3] = {0};

    is->shape(r, z, c, s);
    for (int d = 0; d < 3; d++) v[d] = size * (c[d] * cos(n * theta) + s[d] * sin(n * theta));
    Turn(theta, v, x);
    for (int d = 0; d < 3; d++) u[0][d] += 0.3 * x[d], u[1][d] -= 1.7 * x[d];
  }
}

/* Breaks when: a direction or harmonic is taken for another, its share is wrong, the frame is not the part's */
static PetscErrorCode TestNames(int drum, int *failed)
{
  PetscReal   x[NODES * 3], mass[NODES], re[NODES * 3], im[NODES * 3], contact[3], unit[3] = {0, 0.09, 0};
  PetscReal   energy[2 * N_CASES] = {0}, fitted;
  PetscMPIInt rank, size;
  PetscBool   is_disc;
  Disc        disc = {0};
  int         n    = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  for (int k = rank; k < NODES; k += size, n++) {
    PetscReal r, theta, z;

    Place(drum, k, &r, &theta, &z);
    Turn(theta, (PetscReal[3]){z * (drum ? 0.05 : 0.005), r, 0}, &x[3 * n]);
    mass[n] = 2;
    for (int d = 0; d < 3; d++) x[3 * n + d] += 0.5 * d;
  }
  Turn(0, unit, contact);
  for (int d = 0; d < 3; d++) contact[d] += 0.5 * d;
  PetscCall(DiscCreate(PETSC_COMM_WORLD, &(DiscPart){n, x, mass, contact, NULL}, &disc, &is_disc));
  PetscCall(DiscFitBegin(&disc, N_CASES));
  *failed += CheckTrue(drum ? "a drum is a disc" : "a ring is a disc", is_disc && (int)disc.is_drum == drum, disc.size);
  for (int i = 0; i < N_CASES; i++) {
    for (int k = rank, v = 0; k < NODES; k += size, v++) {
      PetscReal u[2][3];

      Displacement(&cases[i], k, u);
      for (int d = 0; d < 3; d++) re[3 * v + d] = u[0][d], im[3 * v + d] = u[1][d];
    }
    PetscCall(DiscProject(&disc, i, (PetscReal *[2]){re, im}, &energy[2 * i]));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, energy, 2 * N_CASES, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  PetscCall(DiscSolve(&disc));
  for (int i = 0; i < N_CASES; i++) {
    const PetscReal share = 1 - cases[i].other * cases[i].other;
    char            name[32];
    PetscBool       same;

    if (cases[i].drum != drum) continue;
    if (cases[i].name[0] == '(')
      PetscCall(DiscName(&disc, i, name, sizeof(name), &fitted));
    else
      PetscCall(DiscNameInPlane(&disc, i, name, sizeof(name), &fitted));
    PetscCall(PetscStrcmp(name, cases[i].name, &same));
    *failed += CheckTrue(cases[i].name, same, i);
    *failed += CheckClose("  share of the harmonic", fitted / energy[2 * i], share, 1e-4);
    *failed += CheckClose("  share out of plane", energy[2 * i + 1] / energy[2 * i], cases[i].name[0] == '(', 1e-12);
  }
  PetscCall(DiscDestroy(&disc));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  (void)size;
  PetscFunctionBeginUser;
  PetscCall(TestNames(0, failed));
  PetscCall(TestNames(1, failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
