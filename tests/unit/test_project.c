/*
   Unit test of the contact forces of one step: the laws of contact and friction are evaluated anew from the forces on
   the nodes alone, on two boxes with random masses, velocities and displacements. The weights of the master's corners
   are found here by inverting the bilinear map of every facet in the plane. No reference numbers are needed.
*/
#include "twoboxes.h"
#include "check.h"
#include "petscmain.h"

#define GAP 1e-6 /* m, of the meshes, by which the nodes of the two boxes have places of their own */
#define DT  1e-3 /* s */

static const PetscReal x_lower[] = {0, 0.3, 0.5, 0.8, 1}, y_lower[] = {0, 0.2, 0.55, 1}, z_lower[] = {0, 0.5, 1};
static const PetscReal x_upper[] = {0.1, 0.3, 0.45, 0.6, 0.9}, y_upper[] = {0.1, 0.3, 0.55, 0.9};
static const PetscReal z_upper[] = {1 + GAP, 1.5, 2};
static const Box       boxes[]   = {
          {"lower", {5, 4, 3}, {x_lower, y_lower, z_lower}, .taper = 0.2},
          {"upper", {5, 4, 3}, {x_upper, y_upper, z_upper}, .taper = 0  }
};

static PetscBool IsSlave(const Slider *s, PetscInt i)
{
  return s->x[3 * i + 2] > 1 + 0.5 * GAP ? PETSC_TRUE : PETSC_FALSE;
}

/* Random masses between 0.5 and 1.5 kg, displacements, velocities that press most of the nodes together; with `held`,
   some directions of some nodes held */
static PetscErrorCode SliderFill(Slider *s, PetscReal seed, PetscBool held)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < s->n; i++)
    for (int d = 0; d < 3; d++) {
      const PetscReal *x = &s->x[3 * i];
      const PetscInt   k = 3 * i + d;

      s->minv[k]   = 1 / (1 + 0.5 * Noise(x, seed));
      s->u[k]      = 0.02 * Noise(x, seed + 1 + d) * (d == 2 ? 1e-2 : 1);
      s->before[k] = Noise(x, seed + 4 + d);
      s->v[k]      = Noise(x, seed + 7 + d) - (d == 2 && IsSlave(s, i) ? 1 : 0);
      if (d == 2 && IsSlave(s, i)) s->u[k] = PetscAbsReal(s->u[k]) + 2e-4;
      if (held && Noise(x, seed + 10 + d) > 0.7) s->minv[k] = s->v[k] = 0;
    }
  PetscCall(ContactProjectorSetMass(s->projector, s->minv));
  PetscCall(ContactProjectorStart(s->projector, 0, s->u, GAP, NULL));
  PetscFunctionReturn(0);
}

/* Forces of one step into s->force; other nodes have none */
static PetscErrorCode SliderProject(Slider *s)
{
  const ContactStep step = {.time = 0, .dt = DT, .kick = 0.7 * DT};

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(s->force, 3 * s->n));
  PetscCall(ContactProject(s->projector, &step, s->u, s->before, s->v, s->force));
  PetscFunctionReturn(0);
}

/* Local node at a place of the undeformed mesh */
static PetscInt NodeAt(const Slider *s, PetscReal x, PetscReal y, PetscReal z)
{
  for (PetscInt i = 0; i < s->n; i++)
    if (fabs(s->x[3 * i] - x) + fabs(s->x[3 * i + 1] - y) + fabs(s->x[3 * i + 2] - z) < 1e-9) return i;
  return -1;
}

/* Weights of the corners of a facet at the point p of the plane by Newton's method; false where it is outside, or the
   method does not converge. Corners at displacements u + dt v */
static PetscBool WeightsFind(const Slider *s, const PetscInt corner[4], const PetscReal p[2], PetscReal w[4])
{
  static const double sign[4][2] = {
    {-1, -1},
    {1,  -1},
    {1,  1 },
    {-1, 1 }
  };
  double at[2] = {0, 0}, r[2];

  for (int it = 0; it < 20; it++) {
    double J[2][2] = {{0}}, det;

    for (int d = 0; d < 2; d++) r[d] = p[d];
    for (int i = 0; i < 4; i++) {
      const double xi = 1 + sign[i][0] * at[0], eta = 1 + sign[i][1] * at[1];

      w[i] = xi * eta / 4;
      for (int d = 0; d < 2; d++) {
        const PetscInt k = 3 * corner[i] + d;
        const double   x = s->x[k] + s->u[k] + DT * s->v[k];

        r[d] -= w[i] * x;
        J[d][0] += sign[i][0] * eta / 4 * x;
        J[d][1] += sign[i][1] * xi / 4 * x;
      }
    }
    det = J[0][0] * J[1][1] - J[0][1] * J[1][0];
    at[0] += (J[1][1] * r[0] - J[0][1] * r[1]) / det;
    at[1] += (J[0][0] * r[1] - J[1][0] * r[0]) / det;
  }
  return fabs(at[0]) <= 1 && fabs(at[1]) <= 1 && fabs(r[0]) + fabs(r[1]) < 1e-14 ? PETSC_TRUE : PETSC_FALSE;
}

/* Facet and weights under slave node i, by trying all */
static PetscBool MasterFind(const Slider *s, PetscInt i, PetscInt corner[4], PetscReal w[4])
{
  PetscReal p[2];

  for (int d = 0; d < 2; d++) p[d] = s->x[3 * i + d] + s->u[3 * i + d] + DT * s->v[3 * i + d];
  for (int f = 0; f < 12; f++) {
    const int a = f % 4, b = f / 4;

    for (int k = 0; k < 4; k++) {
      const PetscReal y = y_lower[b + k / 2];

      corner[k] = NodeAt(s, x_lower[a + (k == 1 || k == 2)] * (1 + 0.2 * y), y, 1);
    }
    if (WeightsFind(s, corner, p, w)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Violations of the laws, forces relative to the largest and velocities to the fastest; and what was met */
typedef struct {
  PetscReal balance, penetration, sign, complementarity, cone, slip;
  int       n[CONTACT_N_STATUS];
} Violation;

/* Adds one slave; rest [n][3] loses the reactions of its force on the master */
static void ViolationAdd(const Slider *s, PetscInt i, PetscReal mu, PetscReal largest, PetscReal rest[], Violation *c)
{
  const PetscReal *f = &s->force[3 * i], friction = hypot(f[0], f[1]);
  PetscInt         corner[4];
  PetscReal        w[4], q[3], gap, slip;

  if (!MasterFind(s, i, corner, w)) {
    c->balance = PetscMax(c->balance, (fabs(f[0]) + fabs(f[1]) + fabs(f[2])) / largest);
    return;
  }
  gap = s->x[3 * i + 2] + s->u[3 * i + 2] - 1;
  for (int d = 0; d < 3; d++) {
    q[d] = s->v[3 * i + d] + 0.7 * DT * s->minv[3 * i + d] * f[d];
    for (int k = 0; k < 4; k++) {
      const PetscInt m = 3 * corner[k] + d;

      q[d] -= w[k] * (s->v[m] + 0.7 * DT * s->minv[m] * s->force[m]);
      rest[m] += w[k] * f[d];
      if (d == 2) gap -= w[k] * s->u[m];
    }
  }
  gap += DT * q[2];
  slip               = hypot(q[0], q[1]);
  c->penetration     = PetscMax(c->penetration, -gap / DT);
  c->sign            = PetscMax(c->sign, -f[2] / largest);
  c->complementarity = PetscMax(c->complementarity, PetscMin(f[2] / largest, gap / DT));
  c->cone            = PetscMax(c->cone, (friction - mu * f[2]) / largest);
  if (f[2] == 0) {
    c->n[CONTACT_OPEN]++;
  } else if (friction < (mu - 1e-6) * f[2]) {
    c->n[CONTACT_STICK]++;
    c->slip = PetscMax(c->slip, slip);
  } else {
    c->n[CONTACT_SLIP]++;
    c->slip = PetscMax(c->slip, hypot(f[0] * slip + mu * f[2] * q[0], f[1] * slip + mu * f[2] * q[1]) / largest);
  }
}

/* All slaves, and that nothing is left of the forces on the master */
static PetscErrorCode ViolationFind(const Slider *s, PetscReal mu, Violation *c)
{
  PetscReal *rest, largest = 0;

  PetscFunctionBeginUser;
  *c = (Violation){.n = {0}};
  PetscCall(PetscMalloc1(3 * s->n, &rest));
  PetscCall(PetscArraycpy(rest, s->force, 3 * s->n));
  for (PetscInt i = 0; i < s->n; i++)
    if (IsSlave(s, i)) largest = PetscMax(largest, s->force[3 * i + 2]);
  for (PetscInt i = 0; i < s->n; i++)
    if (IsSlave(s, i)) ViolationAdd(s, i, mu, largest, rest, c);
  for (PetscInt k = 0; k < 3 * s->n; k++)
    if (!IsSlave(s, k / 3)) c->balance = PetscMax(c->balance, PetscAbsReal(rest[k]) / largest);
  PetscCall(PetscFree(rest));
  PetscFunctionReturn(0);
}

/* Breaks when: a weight, normal or compliance is wrong, the gap is not that at t_{n+1}, `kick` is taken for dt, or
   Gauss-Seidel stops early; 40 problems on one rank */
static PetscErrorCode TestLaws(PetscBool held, PetscReal mu, int *failed)
{
  Violation worst = {.n = {0}};
  char      option[64];
  Slider    s;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(option, sizeof(option), "-joint_mu %.3f", (double)mu));
  PetscCall(SliderCreate(PETSC_COMM_SELF, 2, boxes, BODIES, option, &s));
  for (int k = 0; k < 20; k++) {
    Violation c;

    PetscCall(SliderFill(&s, 20 * k, held));
    PetscCall(SliderProject(&s));
    PetscCall(ViolationFind(&s, mu, &c));
    worst.balance         = PetscMax(worst.balance, c.balance);
    worst.penetration     = PetscMax(worst.penetration, c.penetration);
    worst.sign            = PetscMax(worst.sign, c.sign);
    worst.complementarity = PetscMax(worst.complementarity, c.complementarity);
    worst.cone            = PetscMax(worst.cone, c.cone);
    worst.slip            = PetscMax(worst.slip, c.slip);
    for (int i = 0; i < CONTACT_N_STATUS; i++) worst.n[i] += c.n[i];
  }
  printf("mu %g, directions held: %d\n", (double)mu, held);
  *failed += CheckClose("forces on the master are the reactions", worst.balance, 0, 1e-12);
  *failed += CheckClose("penetration / dt, m/s", worst.penetration, 0, 1e-9);
  *failed += CheckClose("pull", worst.sign, 0, 0);
  *failed += CheckClose("force across a gap", worst.complementarity, 0, 1e-9);
  *failed += CheckClose("friction beyond the cone", worst.cone, 0, 1e-12);
  *failed += CheckClose("slip where it holds, friction off the slip", worst.slip, 0, 1e-8);
  *failed += CheckTrue("open, stick and slip occur", worst.n[0] > 10 && worst.n[1] > 10 && worst.n[2] > 10, worst.n[1]);
  PetscCall(SliderDestroy(&s));
  PetscFunctionReturn(0);
}

/* Largest difference of the velocities after the step, at nodes of the same place */
static PetscErrorCode VelocitiesCompare(const Slider *a, const Slider *b, PetscReal *difference, PetscReal *force)
{
  PetscReal largest = 0;

  PetscFunctionBeginUser;
  *difference = *force = 0;
  for (PetscInt i = 0; i < 3 * b->n; i++) largest = PetscMax(largest, PetscAbsReal(b->force[i]));
  for (PetscInt i = 0; i < 3 * a->n; i++) {
    const PetscReal *x = &a->x[3 * (i / 3)];
    const PetscInt   k = 3 * NodeAt(b, x[0], x[1], x[2]) + i % 3;

    *force      = PetscMax(*force, PetscAbsReal(a->force[i] - b->force[k]) / largest);
    *difference = PetscMax(*difference, 0.7 * DT * PetscAbsReal(a->minv[i] * a->force[i] - b->minv[k] * b->force[k]));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, difference, 1, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, force, 1, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
  PetscFunctionReturn(0);
}

/* Breaks when: a rank's nodes are missed or taken twice, copies differ, or the order of the pairs follows the ranks.
   Reference: the same problem on one rank */
static PetscErrorCode TestRanks(int *failed)
{
  PetscReal difference, force, worst = 0;
  Slider    one, all;

  PetscFunctionBeginUser;
  PetscCall(SliderCreate(PETSC_COMM_SELF, 2, boxes, BODIES, "-joint_mu 0.4", &one));
  PetscCall(SliderCreate(PETSC_COMM_WORLD, 2, boxes, BODIES, "-joint_mu 0.4", &all));
  for (int k = 0; k < 5; k++) {
    PetscCall(SliderFill(&one, 20 * k, PETSC_FALSE));
    PetscCall(SliderFill(&all, 20 * k, PETSC_FALSE));
    PetscCall(SliderProject(&one));
    PetscCall(SliderProject(&all));
    PetscCall(VelocitiesCompare(&all, &one, &difference, &force));
    worst = PetscMax(worst, force);
  }
  *failed += CheckClose("forces as on one rank, relative", worst, 0, 1e-12);
  PetscCall(SliderDestroy(&one));
  PetscCall(SliderDestroy(&all));
  PetscFunctionReturn(0);
}

/* Breaks when: constraints that repeat each other are not solved. Every slave is in two interfaces that are the same;
   the forces are not unique, their sum and the velocities are those of one interface */
static PetscErrorCode TestTwice(int *failed)
{
  PetscReal difference, force;
  Slider    one, two;

  PetscFunctionBeginUser;
  PetscCall(SliderCreate(PETSC_COMM_SELF, 2, boxes, BODIES, "-joint_mu 0.4", &one));
  PetscCall(SliderCreate(PETSC_COMM_SELF, 2, boxes, BODIES,
                         "-joint_mu 0.4 -contacts joint,again -again_surfaces upper_bottom,lower_top "
                         "-again_law constraint -again_mu 0.4",
                         &two));
  PetscCall(SliderFill(&one, 3, PETSC_FALSE));
  PetscCall(SliderFill(&two, 3, PETSC_FALSE));
  PetscCall(SliderProject(&one));
  PetscCall(SliderProject(&two));
  PetscCall(VelocitiesCompare(&two, &one, &difference, &force));
  *failed += CheckClose("the same interface twice: forces of both", force, 0, 1e-8);
  PetscCall(SliderDestroy(&one));
  PetscCall(SliderDestroy(&two));
  PetscFunctionReturn(0);
}

/* Breaks when: Gauss-Seidel does not converge on a singular W. A quad of free corners is pressed by 16 nodes that
   nothing can move: 48 constraints on 12 directions; the corners stop, by forces that are not unique */
static PetscErrorCode TestRedundant(int *failed)
{
  static const PetscReal side[] = {0, 1}, many[] = {0.1, 0.3, 0.6, 0.8};
  const Box              one[] = {
                 {.name = "lower", .n = {2, 2, 3}, .x = {side, side, z_lower}},
                 {.name = "upper", .n = {4, 4, 3}, .x = {many, many, z_upper}}
  };
  PetscReal   fastest = 0;
  ContactSums sums;
  Slider      s;

  PetscFunctionBeginUser;
  PetscCall(SliderCreate(PETSC_COMM_SELF, 2, one, BODIES, "-joint_mu 10", &s));
  for (PetscInt i = 0; i < s.n; i++)
    for (int d = 0; d < 3; d++) {
      const PetscBool slave = IsSlave(&s, i);

      s.minv[3 * i + d] = slave ? 0 : 1 / (1 + 0.5 * Noise(&s.x[3 * i], 1));
      s.v[3 * i + d]    = slave ? 0 : d == 2 ? 1 : 0.1 * Noise(&s.x[3 * i], 2 + d);
      s.u[3 * i + d]    = slave && d == 2 ? -GAP : 0;
    }
  PetscCall(ContactProjectorSetMass(s.projector, s.minv));
  PetscCall(ContactProjectorStart(s.projector, 0, s.u, GAP, NULL));
  PetscCall(SliderProject(&s));
  for (PetscInt i = 0; i < 3 * s.n; i++)
    if (s.minv[i] > 0) fastest = PetscMax(fastest, PetscAbsReal(s.v[i] + 0.7 * DT * s.minv[i] * s.force[i]));
  PetscCall(ContactProjectorGetSums(s.projector, 0, &sums));
  printf("%d sweeps\n", (int)sums.sweeps);
  *failed += CheckClose("corners that 16 fixed nodes stop, m/s", fastest, 0, 1e-7);
  PetscCall(SliderDestroy(&s));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  PetscCall(TestRanks(failed));
  if (size == 1) {
    PetscCall(TestLaws(PETSC_FALSE, 0.4, failed));
    PetscCall(TestLaws(PETSC_TRUE, 0.3, failed));
    PetscCall(TestTwice(failed));
    PetscCall(TestRedundant(failed));
  }
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
