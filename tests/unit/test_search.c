/*
   Unit test of the search and of the kinematics: slaves that travel over the facets of the master, by their
   displacements or since the master turns under them, off its edge and back. References are closed forms: the reactions
   on the master have the same resultant and moment as the forces on the slaves, where these are; a rigid plane does not
   know which of its facets it carries with.
*/
#include "check.h"
#include "petscmain.h"
#include "plate.h"

/* Resultant (N) and moments (N m) of the normal forces: on the master at the nodes of the mesh, on the slaves at their
   places seen from a plate that has turned by `angle`; every node once */
static PetscErrorCode Moments(const Slider *s, PetscReal angle, PetscReal master[3], PetscReal slave[3])
{
  PetscReal       sums[6] = {0};
  const PetscReal c = PetscCosReal(angle), r = PetscSinReal(angle);
  const Mesh     *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(s->model, &mesh));
  for (PetscInt i = 0; i < s->n; i++) {
    const PetscReal f = s->force[3 * i + 2], x = s->x[3 * i], y = s->x[3 * i + 1];
    const PetscReal a = x + s->u[3 * i] - 0.05, b = y + s->u[3 * i + 1] + 0.1;

    if (!mesh->owned[s->vertex[i]]) continue;
    if (IsSlave(s, i)) {
      sums[3] += f;
      sums[4] += f * (c * a + r * b + 0.05);
      sums[5] += f * (-r * a + c * b - 0.1);
    } else {
      sums[0] -= f;
      sums[1] -= f * x;
      sums[2] -= f * y;
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, 6, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  for (int k = 0; k < 3; k++) {
    master[k] = sums[k];
    slave[k]  = sums[3 + k];
  }
  PetscFunctionReturn(0);
}

/* Breaks when: a slave loses its facet on a full turn of the plate, is taken to a wrong one, or the plate turns the
   wrong way; the slaves stay, 9 of them pressed by 1 kg m/s / DT each. Friction would move the master's forces in the
   plane alone */
static PetscErrorCode TestTurn(int *failed)
{
  const int n_steps = 3200;
  PetscReal worst = 0, lost = 0;
  Slider    s;

  PetscFunctionBeginUser;
  PetscCall(PlateCreate("-joint_mu 0.2 " TURNING, 0, &s));
  for (int k = 0; k < n_steps; k++) {
    PetscReal master[3], slave[3];

    PetscCall(SliderPress(&s, k * DT));
    PetscCall(Moments(&s, 2 * (k + 1) * DT, master, slave));
    lost = PetscMax(lost, PetscAbsReal(slave[0] - 9 / DT) * DT);
    for (int d = 0; d < 3; d++) worst = PetscMax(worst, PetscAbsReal(master[d] - slave[d]) * DT);
  }
  *failed += CheckClose("slaves without facet on a turn of a plate", lost, 0, 1e-9);
  *failed += CheckClose("resultant and moments of the reactions, relative", worst, 0, 1e-9);
  PetscCall(SliderDestroy(&s));
  PetscFunctionReturn(0);
}

/* Slaves with force, when all are displaced by x and z; the plate may be displaced too */
static PetscErrorCode CountPressed(Slider *s, PetscReal x, PetscReal z, PetscReal both, PetscInt *n)
{
  ContactSums sums;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < s->n; i++) {
    s->u[3 * i]     = (IsSlave(s, i) ? x : 0) + both;
    s->u[3 * i + 2] = IsSlave(s, i) ? z : 0;
  }
  PetscCall(SliderPress(s, 0));
  PetscCall(ContactProjectorGetSums(s->projector, 0, &sums));
  *n = (PetscInt)(sums.n[CONTACT_STICK] + sums.n[CONTACT_SLIP]);
  PetscFunctionReturn(0);
}

/* Moves the slaves from x0 to x1 at height z in steps of 1 mm, and counts those that are pressed at the end */
static PetscErrorCode Travel(Slider *s, PetscReal x0, PetscReal x1, PetscReal z, PetscInt *n)
{
  const int steps = (int)(PetscAbsReal(x1 - x0) / 1e-3 + 0.5);

  PetscFunctionBeginUser;
  for (int k = 1; k <= steps; k++) PetscCall(CountPressed(s, x0 + (x1 - x0) * k / steps, z, 0, n));
  PetscFunctionReturn(0);
}

/* Breaks when: nodes beyond the edge (x = 1 m) keep a force, those within lose it, a node that returns above is not
   taken up again, or one that returns from the side below the surface is thrown out. The rows of slaves are at 0.31,
   0.41, 0.55 m */
static PetscErrorCode TestEdge(int *failed)
{
  const PetscReal high = 0.5 * DT;
  PetscInt        n;
  Slider          s;

  PetscFunctionBeginUser;
  PetscCall(PlateCreate("-joint_mu 0.2", 0, &s));
  PetscCall(Travel(&s, 0, 0.4, 0, &n));
  *failed += CheckClose("all three rows on the plate", (double)n, 9, 0);
  PetscCall(Travel(&s, 0.4, 0.5, 0, &n));
  *failed += CheckClose("one row beyond the edge", (double)n, 6, 0);
  PetscCall(Travel(&s, 0.5, 1, 0, &n));
  *failed += CheckClose("all beyond", (double)n, 0, 0);
  PetscCall(Travel(&s, 1, 0.65, high, &n));
  *failed += CheckClose("back above: one row within", (double)n, 3, 0);
  PetscCall(Travel(&s, 0.65, 1, high, &n));
  PetscCall(Travel(&s, 1, 0.65, -0.01, &n));
  *failed += CheckClose("back from the side, below: left alone", (double)n, 0, 0);
  PetscCall(CountPressed(&s, 0.65, 2 * DT, 0, &n));
  PetscCall(CountPressed(&s, 0.65, -1e-4, 0, &n));
  *failed += CheckClose("taken up after it has been above", (double)n, 3, 0);
  PetscCall(SliderDestroy(&s));
  PetscFunctionReturn(0);
}

/* Breaks when: places are not relative to the master where both bodies fly; 3 m at 1 mm a step */
static PetscErrorCode TestFlight(int *failed)
{
  PetscInt n, least = 9;
  Slider   s;

  PetscFunctionBeginUser;
  PetscCall(PlateCreate("-joint_mu 0.2", 1e-3, &s));
  for (int k = 0; k < 3000; k++) {
    PetscCall(CountPressed(&s, 0, 0, 1e-3 * k, &n));
    least = PetscMin(least, n);
  }
  *failed += CheckClose("pairs that touch in flight", (double)least, 9, 0);
  PetscCall(SliderDestroy(&s));
  PetscFunctionReturn(0);
}

/* Springs (64000 N/m) that hold the slaves in the plane, and a press of 5 N each */
static void Pull(const Slider *s, PetscReal a[])
{
  for (PetscInt i = 0; i < 3 * s->n; i++) a[i] = IsSlave(s, i / 3) ? (i % 3 == 2 ? -5 : -64000 * s->u[i]) : 0;
}

/* A step with those forces; the largest displacement since the start goes up */
static PetscErrorCode SliderPull(Slider *s, PetscReal a[], PetscInt step)
{
  PetscFunctionBeginUser;
  Pull(s, a);
  PetscCall(SliderStep(s, (PetscReal)step * DT, DT, a));
  PetscFunctionReturn(0);
}

/* Breaks when: the frame of the turning master, its sliding velocity, or the direction of the prescribed one is wrong:
   on a rigid plane both move the slaves alike, but for the direction being that at the undeformed place, which acts like
   a spring of friction over radius: the difference relative to the way was 1.2, 0.6, 0.3 % with springs of 4, 16 and
   64 kN/m, whatever the step */
static PetscErrorCode TestKinematics(int *failed)
{
  PetscReal  *a, worst = 0, largest = 0;
  ContactSums sums[2];
  Slider      turning, still;

  PetscFunctionBeginUser;
  PetscCall(PlateCreate("-joint_mu 0.2 -joint_ramp 0.3 -joint_ramp_shape smooth " TURNING, 0, &turning));
  PetscCall(PlateCreate(
    "-joint_mu 0.2 -joint_ramp 0.3 -joint_ramp_shape smooth " TURNING "-joint_kinematics prescribed", 0, &still));
  PetscCall(PetscMalloc1(3 * still.n, &a));
  for (PetscInt k = 0; k < 2000; k++) {
    PetscCall(SliderPull(&turning, a, k));
    PetscCall(SliderPull(&still, a, k));
    for (PetscInt i = 0; i < 3 * still.n; i++) {
      worst   = PetscMax(worst, PetscAbsReal(turning.u[i] - still.u[i]));
      largest = PetscMax(largest, PetscAbsReal(still.u[i]));
    }
  }
  PetscCall(ContactProjectorGetSums(turning.projector, 0, &sums[0]));
  PetscCall(ContactProjectorGetSums(still.projector, 0, &sums[1]));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
  *failed += CheckTrue("slaves are dragged by more than 0.02 mm", largest > 2e-5, largest);
  *failed += CheckClose("way by turning and by prescribed velocity, m", worst, 0, 4e-3 * largest);
  *failed += CheckClose("heat, J", sums[0].heat, sums[1].heat, 5e-3 * sums[1].heat);
  *failed += CheckTrue("heat is positive", sums[1].heat > 0, sums[1].heat);
  PetscCall(PetscFree(a));
  PetscCall(SliderDestroy(&turning));
  PetscCall(SliderDestroy(&still));
  PetscFunctionReturn(0);
}

/* Breaks when: something that the next steps need is not remembered. A second object goes on from half way, bitwise */
static PetscErrorCode TestMemory(int *failed)
{
  PetscReal *a, *memory, different = 0;
  PetscInt   n;
  Slider     one, two;

  PetscFunctionBeginUser;
  PetscCall(PlateCreate("-joint_mu 0.2 " TURNING, 1e-2, &one));
  PetscCall(PlateCreate("-joint_mu 0.2 " TURNING, 1e-2, &two));
  PetscCall(PetscMalloc1(3 * one.n, &a));
  for (PetscInt k = 0; k < 600; k++) {
    if (k == 301) {
      PetscCall(PetscArraycpy(two.u, one.u, 3 * one.n));
      PetscCall(PetscArraycpy(two.v, one.v, 3 * one.n));
      PetscCall(ContactProjectorGetMemory(one.projector, &n, &memory));
      PetscCall(ContactProjectorSetMemory(two.projector, n, memory));
      PetscCall(PetscFree(memory));
    }
    PetscCall(SliderPull(&one, a, k));
    if (k >= 301) PetscCall(SliderPull(&two, a, k));
    for (PetscInt i = 0; i < 3 * one.n && k >= 301; i++) different = one.u[i] == two.u[i] ? different : 1;
  }
  *failed += CheckClose("displacements that differ", different, 0, 0);
  PetscCall(PetscFree(a));
  PetscCall(SliderDestroy(&one));
  PetscCall(SliderDestroy(&two));
  PetscFunctionReturn(0);
}

/* Breaks when: the forces of a sliding state get to the wrong slaves, or do not start the first step. Predicted
   velocities are those that the forces bring to rest, so that the first sweep finds nothing to change. Slave nodes
   slide along y at 1 m/s */
static PetscErrorCode TestStates(int *failed)
{
  const ContactPair *pair;
  ContactState      *states;
  ContactSums        sums;
  PetscReal          error = 0;
  PetscInt           n, n_all;
  Slider             s;

  PetscFunctionBeginUser;
  PetscCall(PlateCreate("-joint_mu 0.2 -joint_slip 0,1,0 -joint_speed 1", 0, &s));
  PetscCall(ContactSetUp(s.contact));
  PetscCall(ContactGetPairs(s.contact, &n, &n_all, &pair));
  PetscCall(PetscCalloc1(n, &states));
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal force = 10 + Noise(pair[k].x, 1);

    states[k] = (ContactState){
      .status = CONTACT_SLIP, .lambda_n = force, .lambda_t = {0.2 * force, 0}
    };
  }
  PetscCall(ContactProjectorStart(s.projector, 0, s.u, 1e-9, states));
  for (PetscInt i = 0; i < s.n; i++) {
    const PetscReal force = IsSlave(&s, i) ? 10 + Noise(&s.x[3 * i], 1) : 0;

    s.v[3 * i + 1] = 0.2 * force * DT;
    s.v[3 * i + 2] = -force * DT;
  }
  PetscCall(ContactProject(s.projector, &(ContactStep){.dt = DT, .kick = DT}, s.u, s.before, s.v, s.force));
  for (PetscInt i = 0; i < s.n; i++)
    if (IsSlave(&s, i)) error = PetscMax(error, PetscAbsReal(s.force[3 * i + 2] - 10 - Noise(&s.x[3 * i], 1)));
  PetscCall(ContactProjectorGetSums(s.projector, 0, &sums));
  *failed += CheckClose("forces of the sliding state, N", error, 0, 1e-12);
  *failed += CheckClose("sweeps", (double)sums.sweeps, 1, 0);
  *failed += CheckClose("friction on the master along the slip, N", sums.friction, 0.2 * sums.normal, 1e-12);
  *failed +=
    CheckClose("work and heat are what the drive feeds, J", sums.friction_work + sums.heat, sums.friction * DT, 1e-12);
  PetscCall(PetscFree(states));
  PetscCall(SliderDestroy(&s));
  PetscFunctionReturn(0);
}

/* Breaks when: bodies that overlap (0.3 m, more than a facet), or a pair that cannot move, start nevertheless */
static PetscErrorCode TestStart(int *failed)
{
  PetscErrorCode error[2];
  Slider         s;

  PetscFunctionBeginUser;
  PetscCall(PlateCreate("-joint_mu 0.2", 0, &s));
  for (PetscInt i = 0; i < s.n; i++)
    if (IsSlave(&s, i)) s.u[3 * i + 2] = -0.3;
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  error[0] = ContactProjectorStart(s.projector, 0, s.u, 0.29, NULL);
  error[1] = ContactProjectorStart(s.projector, 0, s.u, 0.31, NULL);
  *failed += CheckTrue("overlap beyond the slack is an error", error[0] == PETSC_ERR_USER_INPUT, error[0]);
  *failed += CheckTrue("overlap within it is none", error[1] == 0, error[1]);
  PetscCall(PetscArrayzero(s.minv, 3 * s.n));
  PetscCall(ContactProjectorSetMass(s.projector, s.minv));
  error[0] = ContactProjectorStart(s.projector, 0, s.u, 0.31, NULL);
  *failed += CheckTrue("a pair that cannot move is an error", error[0] == PETSC_ERR_USER_INPUT, error[0]);
  PetscCall(PetscPopErrorHandler());
  PetscCall(SliderDestroy(&s));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  (void)size;
  PetscCall(TestTurn(failed));
  PetscCall(TestEdge(failed));
  PetscCall(TestFlight(failed));
  PetscCall(TestKinematics(failed));
  PetscCall(TestMemory(failed));
  PetscCall(TestStates(failed));
  PetscCall(TestStart(failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
