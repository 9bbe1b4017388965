/*
   Unit test of the energy of prescribed forces and motions on the smallest bodies: two nodes joined by springs along x,
   y and z, of which the first is moved in x and y and held in z, the second is free, with a ramped load, gravity, an
   impulse and contact forces from elsewhere; central differences as in dynamics.h, b = 1/2.

   Reference: the balance of energies in external.h, an identity of the discrete equations that holds to rounding.
*/
#include "check.h"
#include "dynamics/external/externalimpl.h"

#define N       6 /* numbers of the state vectors */
#define N_STEPS 1000
#define DT      0.05 /* s; the critical step is 2 / sqrt(k / m) = 0.6 s at the free node */

static const PetscReal stiffness[3] = {20, 12, 7}, lift[2] = {0.3, -0.2}, hit[3] = {0.5, 0, -0.25};

/* Two nodes in their own bases; the first one's is turned by 30 degrees about z */
typedef struct {
  PetscInt  at[2], step[2];
  PetscReal basis[2][3][3], mass[N], minv[N];
  PetscBool owned[2];
  Layout    layout;
} Nodes;

/* State at the end of a step, and the energies */
typedef struct {
  PetscReal u[N], v[N], f[N];
  PetscReal kinetic, strain, external, contact, start, throughput;
} State;

static void NodesCreate(Nodes *nodes)
{
  const PetscReal c = cos(PETSC_PI / 6), s = sin(PETSC_PI / 6);

  *nodes = (Nodes){
    .at    = {0,   5  },
    .step  = {1,   -1 },
    .mass  = {2.5, 2.5, 2.5, 2, 2, 2},
    .minv  = {0,  0,    0, 0.5, 0.5, 0.5},
    .owned = {PETSC_TRUE,   PETSC_TRUE     }
  };
  nodes->basis[0][0][0] = nodes->basis[0][1][1] = c;
  nodes->basis[0][0][1]                         = s;
  nodes->basis[0][1][0]                         = -s;
  nodes->basis[0][2][2]                         = 1;
  for (int d = 0; d < 3; d++) nodes->basis[1][d][d] = 1;
  nodes->layout = (Layout){.n          = N,
                           .n_vertices = 2,
                           .at         = nodes->at,
                           .step       = nodes->step,
                           .basis      = &nodes->basis[0][0][0],
                           .owned      = nodes->owned,
                           .total      = nodes->mass,
                           .minv       = nodes->minv};
}

/* The first node driven along x and y: its first two components */
static PetscErrorCode DriveCreate(const Nodes *nodes, Drive *motion)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(2, &motion->index, 2, &motion->full, 2, &motion->before, 2, &motion->after));
  motion->n = motion->n_owned = 2;
  motion->ramp                = (Ramp){.shape = RAMP_SMOOTH, .delay = 1, .length = 30};
  for (int j = 0; j < 2; j++) {
    motion->index[j] = j;
    motion->full[j]  = nodes->basis[0][j][0] * lift[0] + nodes->basis[0][j][1] * lift[1];
  }
  PetscFunctionReturn(0);
}

/* A load on both nodes, the motion of the first, an impulse on the second at 5.01 s, gravity on both */
static PetscErrorCode SceneCreate(const Nodes *nodes, External *external)
{
  const PetscInt  vertex[2] = {0, 1};
  const PetscReal force[6] = {0.3, 1, -2, 1.5, 0.7, 2}, g[3] = {0.1, 0.3, -0.5};
  External        e;

  PetscFunctionBeginUser;
  PetscCall(ExternalCreate(PETSC_COMM_SELF, NULL, external));
  e          = *external;
  e->layout  = &nodes->layout;
  e->n_loads = e->n_motions = e->n_acting = 1;
  PetscCall(PetscCalloc1(1, &e->loads));
  PetscCall(PetscCalloc1(1, &e->motions));
  PetscCall(PetscCalloc1(1, &e->impulses));
  PetscCall(PetscArraycpy(e->gravity, g, 3));
  e->loads[0].ramp    = (Ramp){.shape = RAMP_LINEAR, .delay = 0.5, .length = 10};
  e->impulses[0].time = 5.01;
  PetscCall(ForcePatternCreate(e->layout, 2, vertex, force, &e->loads[0].pattern));
  PetscCall(ForcePatternCreate(e->layout, 1, &vertex[1], hit, &e->impulses[0].pattern));
  PetscCall(DriveCreate(nodes, &e->motions[0]));
  PetscCall(InertiaSetUp(e));
  PetscCall(ExternalLayMemory(e));
  PetscFunctionReturn(0);
}

/* f = -K u of the springs; strain = 1/2 u_next' K u */
static PetscReal SpringsPull(const Nodes *nodes, const PetscReal u[], const PetscReal u_next[], PetscReal f[])
{
  PetscReal x[2][3], y[2][3], pull[3], strain = 0;

  for (int i = 0; i < 2; i++) LayoutGet(&nodes->layout, i, u, x[i]);
  for (int i = 0; i < 2; i++) LayoutGet(&nodes->layout, i, u_next, y[i]);
  for (int d = 0; d < 3; d++) {
    pull[d] = stiffness[d] * (x[1][d] - x[0][d]);
    strain += 0.5 * pull[d] * (y[1][d] - y[0][d]);
  }
  LayoutSet(&nodes->layout, 0, pull, f);
  for (int d = 0; d < 3; d++) pull[d] = -pull[d];
  LayoutSet(&nodes->layout, 1, pull, f);
  return strain;
}

/* Forces on both nodes from elsewhere, with their own account */
static void ContactForce(PetscReal t, PetscReal force[N])
{
  for (int i = 0; i < N; i++) force[i] = 3 * sin((4 + 0.3 * i) * t + i);
}

static PetscReal Dot(const PetscReal a[N], const PetscReal b[N])
{
  PetscReal sum = 0;

  for (int i = 0; i < N; i++) sum += a[i] * b[i];
  return sum;
}

/* One step n from t_n = n dt; a step ends with v_{n+1/2}, u_{n+1}. The work of the step before is complete after
   ExternalAdvance(): what it says of the energies after that step goes to `worst` */
static PetscErrorCode Step(const Nodes *nodes, External external, PetscInt n, State *s, PetscReal *worst)
{
  const PetscReal t = DT * (PetscReal)n, kick = n ? DT : DT / 2;
  PetscReal       contact[N], before[N], next[N];
  ExternalPower   power;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(before, s->v, N));
  (void)SpringsPull(nodes, s->u, s->u, s->f);
  PetscCall(ExternalAdvance(external, &(ExternalStep){t, DT, s->u, s->v, s->f}, &power));
  if (n > 1) s->external += DT / 2 * power.old;
  if (n > 1) {
    const PetscReal error = s->kinetic + s->strain - s->start - s->external - s->contact;

    s->throughput = PetscMax(s->throughput, PetscAbsReal(s->external) + PetscAbsReal(s->contact) + s->kinetic);
    *worst        = PetscMax(*worst, PetscAbsReal(error) / s->throughput);
  }
  if (n > 0) s->external += DT / 2 * power.now;
  ContactForce(t, contact);
  for (int i = 0; i < N; i++) s->f[i] += contact[i];
  PetscCall(ExternalFinish(external, DT, s->f));
  for (int i = 0; i < N; i++) s->v[i] += kick * nodes->minv[i] * s->f[i];
  for (int i = 0; i < N; i++) next[i] = s->u[i] + DT * s->v[i];
  if (n > 0) s->contact += DT / 2 * (Dot(contact, before) + Dot(contact, s->v));
  s->kinetic = 0;
  for (int i = 0; i < N; i++) s->kinetic += 0.5 * nodes->mass[i] * s->v[i] * s->v[i];
  s->strain = SpringsPull(nodes, s->u, next, s->f);
  if (n == 0) s->start = s->kinetic + s->strain;
  PetscCall(PetscArraycpy(s->u, next, N));
  PetscFunctionReturn(0);
}

/* Breaks when: the drive's force leaves out inertia, spring, load or contact forces, works are those of another step or
   half step, or prescribed nodes move elsewhere than asked (0.3, -0.2 m) */
static PetscErrorCode TestBalance(int *failed)
{
  Nodes     nodes;
  State     s     = {.kinetic = 0};
  PetscReal worst = 0, x[3];
  External  external;

  PetscFunctionBeginUser;
  NodesCreate(&nodes);
  PetscCall(SceneCreate(&nodes, &external));
  for (PetscInt n = 0; n < N_STEPS; n++) PetscCall(Step(&nodes, external, n, &s, &worst));
  LayoutGet(&nodes.layout, 0, s.u, x);
  *failed += CheckClose("energies against works, largest relative error", worst, 0, 1e-14);
  *failed += CheckTrue("work of loads and drives is done", PetscAbsReal(s.external) > 0.1, s.external);
  *failed += CheckTrue("work of the contact forces is done", PetscAbsReal(s.contact) > 0.1, s.contact);
  for (int d = 0; d < 2; d++) *failed += CheckClose("prescribed displacement, m", x[d], lift[d], 1e-14);
  PetscCall(ExternalDestroy(&external));
  PetscFunctionReturn(0);
}

/* Breaks when: a number that a step needs of the steps before is not in the memory. Cut before the impulse (step 100),
   while the ramps run. */
static PetscErrorCode TestRestart(int *failed)
{
  Nodes      nodes;
  PetscReal *from, *to, worst[2] = {0, 0};
  PetscInt   n_memory, n_to;
  PetscBool  same;

  PetscFunctionBeginUser;
  NodesCreate(&nodes);
  for (PetscInt cut = 99; cut <= 102; cut++) {
    State    a = {.kinetic = 0}, b;
    External first, second;

    PetscCall(SceneCreate(&nodes, &first));
    PetscCall(SceneCreate(&nodes, &second));
    for (PetscInt n = 0; n < cut; n++) PetscCall(Step(&nodes, first, n, &a, &worst[0]));
    PetscCall(ExternalGetMemory(first, &n_memory, &from));
    PetscCall(ExternalGetMemory(second, &n_to, &to));
    PetscCall(PetscArraycpy(to, from, n_memory));
    b = a;
    for (PetscInt n = cut; n < cut + 20; n++) PetscCall(Step(&nodes, first, n, &a, &worst[0]));
    for (PetscInt n = cut; n < cut + 20; n++) PetscCall(Step(&nodes, second, n, &b, &worst[1]));
    PetscCall(PetscMemcmp(&a, &b, sizeof(a), &same));
    *failed += CheckTrue("a copy of the memory goes on bitwise", same && n_memory == n_to, (double)n_memory);
    PetscCall(ExternalDestroy(&first));
    PetscCall(ExternalDestroy(&second));
  }
  PetscFunctionReturn(0);
}

/* Breaks when: an impulse acts in no step, in two, in another than that with t_n <= T < t_n + dt, or in the first one,
   which is half a step */
static PetscErrorCode TestImpulse(int *failed)
{
  static const struct {
    PetscReal time;
    PetscInt  step;
  } expected[] = {
    {0,          1  },
    {0.5 * DT,   1  },
    {1.5 * DT,   1  },
    {2 * DT,     2  },
    {7.99 * DT,  7  },
    {100.5 * DT, 100}
  };
  const PetscReal u[N] = {0};
  Nodes           nodes;

  PetscFunctionBeginUser;
  NodesCreate(&nodes);
  for (int i = 0; i < 6; i++) {
    External  external;
    PetscInt  step   = -1;
    PetscReal sum[3] = {0, 0, 0};

    PetscCall(SceneCreate(&nodes, &external));
    external->n_loads = external->n_motions = 0;
    PetscCall(PetscArrayzero(external->weight, N));
    external->impulses[0].time = expected[i].time;
    for (PetscInt n = 0; n < 110; n++) {
      PetscReal     v[N] = {1, 1, 1, 1, 1, 1}, f[N] = {0}, force[3];
      ExternalPower power;

      PetscCall(ExternalAdvance(external, &(ExternalStep){DT * (PetscReal)n, DT, u, v, f}, &power));
      LayoutGet(&nodes.layout, 1, f, force);
      for (int d = 0; d < 3; d++) sum[d] += DT * force[d];
      if (force[0] != 0) step = n;
    }
    *failed += CheckClose("step in which an impulse acts", (double)step, (double)expected[i].step, 0);
    for (int d = 0; d < 3; d++) *failed += CheckClose("momentum, N s", sum[d], hit[d], 1e-15);
    external->n_loads = external->n_motions = 1;
    PetscCall(ExternalDestroy(&external));
  }
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  int failed = 0;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(TestBalance(&failed));
  PetscCall(TestRestart(&failed));
  PetscCall(TestImpulse(&failed));
  PetscCall(PetscFinalize());
  printf("%d failed\n", failed);
  return failed ? 1 : 0;
}
