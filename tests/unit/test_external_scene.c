/*
   Unit test of External on a model: loads, gravity, impulses, motions, initial velocities and turning frames reach the
   right nodes, with the same numbers at every copy of a node, on any ranks.

   References: sums over all nodes (total force, total mass rho V, momentum), closed forms of inertial forces.
*/
#include "check.h"
#include "externalscene.h"
#include "petscmain.h"

/* The same Cartesian vector at all nodes of a state vector */
static void SceneFill(const Scene *s, const PetscReal value[3], PetscReal x[])
{
  for (PetscInt i = 0; i < s->layout->n_vertices; i++)
    if (s->layout->at[i] >= 0) LayoutSet(s->layout, i, value, x);
}

/* Sum of a state vector over all nodes, each once; `spread` is the largest difference between copies of a node */
static PetscErrorCode SceneSum(const Scene *s, const PetscReal x[], PetscReal sum[3], PetscReal *spread)
{
  PetscScalar *owner;
  Vec          local;

  PetscFunctionBeginUser;
  PetscCall(ModelCreateNodal(s->chain.model, &local));
  PetscCall(VecGetArray(local, &owner));
  for (int d = 0; d < 3; d++) sum[d] = 0;
  for (PetscInt i = 0; i < s->layout->n_vertices; i++) {
    if (s->layout->at[i] < 0 || !s->layout->owned[i]) continue;
    LayoutGet(s->layout, i, x, &owner[3 * i]);
    for (int d = 0; d < 3; d++) sum[d] += owner[3 * i + d];
  }
  PetscCall(VecRestoreArray(local, &owner));
  PetscCall(ModelSumShared(s->chain.model, local));
  PetscCall(VecGetArray(local, &owner));
  *spread = 0;
  for (PetscInt i = 0; i < s->layout->n_vertices; i++) {
    PetscReal here[3];

    if (s->layout->at[i] < 0) continue;
    LayoutGet(s->layout, i, x, here);
    for (int d = 0; d < 3; d++) *spread = PetscMax(*spread, PetscAbsReal(here[d] - owner[3 * i + d]));
  }
  PetscCall(VecRestoreArray(local, &owner));
  PetscCall(VecDestroy(&local));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, spread, 1, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
  PetscFunctionReturn(0);
}

/* Checks the sum of the forces, N, and that copies agree bitwise */
static PetscErrorCode CheckSum(const Scene *s, const char name[], const PetscReal expected[3], int *failed)
{
  PetscReal sum[3], spread;

  PetscFunctionBeginUser;
  PetscCall(SceneSum(s, s->f, sum, &spread));
  for (int d = 0; d < 3; d++) *failed += CheckClose(name, sum[d], expected[d], 1e-13);
  *failed += CheckClose("copies of a node differ by", spread, 0, 0);
  PetscFunctionReturn(0);
}

/* Breaks when: a ramp is not the load's own, forces miss a copy of a node or count twice, power is that of the wrong
   time */
static PetscErrorCode TestLoads(int *failed)
{
  const PetscReal one[3] = {1, 2, 3}, at_1[3] = {0.5, -1, 0}, at_3[3] = {1, -2, 5};
  ExternalPower   power;
  Scene           s;

  PetscFunctionBeginUser;
  PetscCall(SceneCreate("-loads pull,push -pull_set head_top -pull_force 1,-2,0 -pull_ramp 2 -pull_ramp_shape linear "
                        "-push_set head_edge -push_force 0,0,5 -push_delay 2 ",
                        &s));
  SceneFill(&s, one, s.v);
  PetscCall(SceneAdvance(&s, 1, 0.1, &power));
  PetscCall(CheckSum(&s, "half of one load, N", at_1, failed));
  *failed += CheckClose("power before the first step", power.old, 0, 0);
  *failed += CheckClose("power at 1 s", power.now, 0.5 - 2, 1e-13);
  PetscCall(SceneAdvance(&s, 3, 0.1, &power));
  PetscCall(CheckSum(&s, "both loads, N", at_3, failed));
  *failed += CheckClose("power of the forces at 1 s", power.old, 0.5 - 2, 1e-13);
  *failed += CheckClose("power at 3 s", power.now, 1 - 4 + 15, 1e-13);
  PetscCall(SceneDestroy(&s));
  PetscFunctionReturn(0);
}

/* Breaks when: the lumped mass of nodes that ranks share is not whole, or an impulse misses copies of its node; the
   place is that of a node that both parts have, and in the middle of the section */
static PetscErrorCode TestGravityAndImpulse(int *failed)
{
  const PetscReal one[3] = {1, 2, 3}, weight[3] = {MASS, 0, -9 * MASS}, zero[3] = {0, 0, 0}, hit[3] = {20, 0, -10};
  ExternalPower   power;
  Scene           s;

  PetscFunctionBeginUser;
  PetscCall(SceneCreate("-model_gravity 1,0,-9 ", &s));
  SceneFill(&s, one, s.v);
  PetscCall(SceneAdvance(&s, 0, 0.1, &power));
  PetscCall(CheckSum(&s, "weight, N", weight, failed));
  PetscCall(SceneAdvance(&s, 0.1, 0.1, &power));
  *failed += CheckClose("power of gravity", power.now, -26 * MASS, 1e-12);
  *failed += CheckClose("power of gravity, step before", power.old, -26 * MASS, 1e-12);
  PetscCall(SceneDestroy(&s));
  PetscCall(SceneCreate("-impulses hit -hit_at 0.41,0.39,0.42 -hit_impulse 2,0,-1 -hit_time 0.75 ", &s));
  SceneFill(&s, one, s.v);
  for (int n = 0; n < 10; n++) {
    PetscCall(SceneAdvance(&s, 0.1 * n, 0.1, &power));
    PetscCall(CheckSum(&s, "impulse / dt in one step of ten, N", n == 7 ? hit : zero, failed));
    *failed += CheckClose("power of the impulse", power.now, n == 7 ? -10 : 0, 1e-13);
    *failed += CheckClose("power of the impulse, step before", power.old, n == 8 ? -10 : 0, 1e-13);
  }
  PetscCall(SceneDestroy(&s));
  PetscFunctionReturn(0);
}

/* Breaks when: a motion moves other nodes or directions than asked, copies of a node part, or the way is not d */
static PetscErrorCode TestMotion(int *failed)
{
  const Mesh     *mesh;
  const PetscReal lift[3] = {0.5, 0, -0.25};
  PetscReal       wrong   = 0, sum[3], spread;
  ExternalPower   power;
  Scene           s;

  PetscFunctionBeginUser;
  PetscCall(
    SceneCreate("-motions lift -lift_set head_top -lift_displacement 0.5,0,-0.25 -lift_ramp 1 -lift_delay 0.3 ", &s));
  for (int n = 0; n < 20; n++) {
    PetscCall(SceneAdvance(&s, 0.1 * n, 0.1, &power));
    for (PetscInt i = 0; i < s.layout->n; i++) s.u[i] += 0.1 * s.v[i];
  }
  PetscCall(ModelGetMesh(s.chain.model, &mesh));
  for (PetscInt i = 0; i < s.layout->n_vertices; i++) {
    PetscReal here[3];

    LayoutGet(s.layout, i, s.u, here);
    for (int d = 0; d < 3; d++)
      wrong = PetscMax(wrong, PetscAbsReal(here[d] - (PetscAbsReal(mesh->x[3 * i + 2] - 1) < 1e-12 ? lift[d] : 0)));
  }
  *failed += CheckClose("way of the motion, largest error, m", wrong, 0, 1e-14);
  PetscCall(SceneSum(&s, s.u, sum, &spread));
  *failed += CheckClose("sum over the 9 nodes of the set, m", sum[0], 4.5, 1e-13);
  *failed += CheckClose("copies of a node differ by", spread, 0, 0);
  PetscCall(SceneDestroy(&s));
  PetscFunctionReturn(0);
}

/* Breaks when: a prescribed direction keeps its inertia in the integrator, or another one loses it */
static PetscErrorCode TestHeld(int *failed)
{
  const PetscReal *minv;
  PetscInt         n[2] = {0, 0};
  Scene            s;

  PetscFunctionBeginUser;
  PetscCall(SceneCreate("-motions lift,hold -lift_set head_top -lift_displacement 0.5,0,0 -lift_ramp 1 "
                        "-hold_set head_edge -hold_directions zy ",
                        &s));
  minv = s.layout->minv;
  for (PetscInt i = 0; i < s.layout->n_vertices; i++)
    for (int j = 0; j < 3 && s.layout->owned[i]; j++) n[minv[s.layout->at[i] + j * s.layout->step[i]] == 0]++;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, n, 2, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  *failed += CheckClose("held: 9 x 3 by the support, 9 in x, 4 x 2 on the edge", (double)n[1], 27 + 9 + 8, 0);
  *failed += CheckClose("free", (double)n[0], 3 * 9 * 6 - 44, 0);
  PetscCall(SceneDestroy(&s));
  PetscFunctionReturn(0);
}

/* Breaks when: nodes of two parts take one part's velocity or the sum, or held nodes move. Sums: 9 nodes in each of six
   layers, of which the first is held, one is free in the foot, one is shared, three are in the head */
static PetscErrorCode TestVelocity(int *failed)
{
  PetscReal sum[3], spread;
  Scene     s;

  PetscFunctionBeginUser;
  PetscCall(SceneCreate("-foot_velocity 1,0,2 -head_velocity 0,0,4 ", &s));
  PetscCall(ExternalSetVelocity(s.external, s.v));
  PetscCall(SceneSum(&s, s.v, sum, &spread));
  *failed += CheckClose("velocities, x", sum[0], 9 * (1 + 0.5), 1e-13);
  *failed += CheckClose("velocities, y", sum[1], 0, 0);
  *failed += CheckClose("velocities, z", sum[2], 9 * (2 + 3 + 3 * 4), 1e-13);
  *failed += CheckClose("copies of a node differ by", spread, 0, 0);
  PetscCall(SceneDestroy(&s));
  PetscFunctionReturn(0);
}

/* Breaks when: an inertial force has another sign, factor or centre, reaches other nodes, or the power is that of the
   wrong step. Omega = 3 rad/s about z through (0.2, 0.1): -2 m Omega x v = 6 m (v_y, -v_x), centrifugal 9 m (x - 0.2, y
   - 0.1). The nodes of the head have 2.1 kg, 0.3 of them of the foot; row sums are exact for linear fields on boxes, so
   that the mean of x and y is 1/2, to which u adds 0.05 in x */
static PetscErrorCode TestFrame(int *failed)
{
  const PetscReal omega[3] = {0, 0, 3}, centre[3] = {0.2, 0.1, 7}, v[3] = {1, 2, 3}, u[3] = {0.05, 0, 0}, m = 2.1;
  const PetscReal coriolis[3] = {6 * m * 2, -6 * m, 0}, centrifugal[3] = {9 * m * 0.35, 9 * m * 0.4, 0};
  const PetscReal both[3] = {coriolis[0] + centrifugal[0], coriolis[1] + centrifugal[1], 0};
  ExternalPower   power;
  Scene           s;

  PetscFunctionBeginUser;
  PetscCall(SceneCreate("", &s));
  SceneFill(&s, v, s.v);
  SceneFill(&s, u, s.u);
  PetscCall(ExternalSetFrame(s.external, "head", omega, centre, PETSC_TRUE, PETSC_FALSE));
  PetscCall(SceneAdvance(&s, 0, 0.1, &power));
  PetscCall(CheckSum(&s, "Coriolis force, N", coriolis, failed));
  PetscCall(ExternalSetFrame(s.external, "head", omega, centre, PETSC_FALSE, PETSC_TRUE));
  PetscCall(SceneAdvance(&s, 0.1, 0.1, &power));
  PetscCall(CheckSum(&s, "centrifugal force, N", centrifugal, failed));
  *failed += CheckClose("power of the Coriolis force", power.old, 0, 1e-13);
  *failed += CheckClose("power of the centrifugal force", power.now, centrifugal[0] + 2 * centrifugal[1], 1e-13);
  PetscCall(ExternalSetFrame(s.external, "head", omega, centre, PETSC_TRUE, PETSC_TRUE));
  PetscCall(SceneAdvance(&s, 0.2, 0.1, &power));
  PetscCall(CheckSum(&s, "both, N", both, failed));
  *failed += CheckClose("power in the step before", power.old, centrifugal[0] + 2 * centrifugal[1], 1e-13);
  PetscCall(SceneDestroy(&s));
  PetscFunctionReturn(0);
}

/* Two frames: nodes that both parts have count once, 2.6 kg in all, and a frame that comes later keeps the memory of
   the first. Breaks when: they count twice, or the memory moves */
static PetscErrorCode TestTwoFrames(int *failed)
{
  const PetscReal omega[3] = {2, 0, 0}, centre[3] = {0, 0, 0}, v[3] = {0, 1, 0}, expected[3] = {0, 0, -4 * MASS};
  ExternalPower   power, next;
  Scene           s;

  PetscFunctionBeginUser;
  PetscCall(SceneCreate("", &s));
  SceneFill(&s, v, s.v);
  PetscCall(ExternalSetFrame(s.external, "head", omega, centre, PETSC_TRUE, PETSC_TRUE));
  PetscCall(SceneAdvance(&s, 0, 0.1, &power));
  PetscCall(ExternalSetFrame(s.external, "foot", omega, centre, PETSC_TRUE, PETSC_TRUE));
  PetscCall(SceneAdvance(&s, 0, 0.1, &next));
  *failed += CheckTrue("power of the first frame alone", next.old == power.now && power.now > 0, next.old - power.now);
  PetscCall(ExternalSetFrame(s.external, "head", omega, centre, PETSC_TRUE, PETSC_FALSE));
  PetscCall(ExternalSetFrame(s.external, "foot", omega, centre, PETSC_TRUE, PETSC_FALSE));
  PetscCall(SceneAdvance(&s, 0.1, 0.1, &power));
  PetscCall(CheckSum(&s, "Coriolis force of all nodes, N", expected, failed));
  PetscCall(SceneDestroy(&s));
  PetscFunctionReturn(0);
}

#define EVERYTHING                                                                                                     \
  "-loads pull -pull_set head -pull_force 1,-2,0.5 -pull_ramp 2 -model_gravity 0,0.1,-0.2 -impulses hit -hit_at "      \
  "0.4,0.4,0.4 "                                                                                                       \
  "-hit_impulse 0.1,0.1,0 -hit_time 1.01 -motions lift -lift_set head_edge -lift_displacement 0.05,0,-0.1 "            \
  "-lift_ramp 3 -foot_velocity 0.1,0,0 "

/* Energies and works of all ranks after a step: external.h */
static PetscErrorCode Balance(const BodiesSums *sums, PetscReal work, PetscReal *start, PetscReal *throughput,
                              PetscReal *worst)
{
  PetscReal now[3] = {sums->kinetic, sums->strain, work};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, now, 3, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  if (*start < 0) *start = now[0] + now[1];
  *throughput = PetscMax(*throughput, now[0] + PetscAbsReal(now[1]) + PetscAbsReal(now[2]));
  *worst      = PetscMax(*worst, PetscAbsReal(now[0] + now[1] - *start - now[2]));
  PetscFunctionReturn(0);
}

/* Breaks when: works of loads, drives or inertial forces miss nodes, count them on two ranks, or are those of another
   time. Reference: the balance of external.h over 500 steps of 0.02 s, the critical one being about 0.06 s */
static PetscErrorCode TestBalance(int *failed)
{
  const PetscReal *minv, omega[3] = {0.3, 0, 0.5}, centre[3] = {0, 0, 0}, dt = 0.02;
  PetscReal       *ku, work = 0, start = -1, throughput = 0, worst = 0;
  Scene            s;

  PetscFunctionBeginUser;
  PetscCall(SceneCreate(EVERYTHING, &s));
  minv = s.layout->minv;
  PetscCall(PetscCalloc1(s.layout->n, &ku));
  PetscCall(ExternalSetFrame(s.external, "head", omega, centre, PETSC_TRUE, PETSC_TRUE));
  PetscCall(ExternalSetVelocity(s.external, s.v));
  PetscCall(BodiesSetState(s.bodies, s.u, s.v, ku));
  for (int n = 0; n < 500; n++) {
    BodiesSums    sums;
    ExternalPower power;

    PetscCall(BodiesAdvance(s.bodies, &(BodiesStep){n ? dt : 0, s.u, s.v, ku, s.f}, &sums));
    PetscCall(ExternalAdvance(s.external, &(ExternalStep){dt * n, dt, s.u, s.v, s.f}, &power));
    if (n > 1) work += dt / 2 * power.old;
    if (n > 0) PetscCall(Balance(&sums, work, &start, &throughput, &worst));
    if (n > 0) work += dt / 2 * power.now;
    PetscCall(ExternalFinish(s.external, dt, s.f));
    for (PetscInt i = 0; i < s.layout->n; i++) s.v[i] += (n ? dt : dt / 2) * minv[i] * s.f[i];
    for (PetscInt i = 0; i < s.layout->n; i++) s.u[i] += dt * s.v[i];
  }
  *failed += CheckTrue("energy goes through, J", throughput > 0.1, throughput);
  *failed += CheckClose("energies against works, largest relative error", worst / throughput, 0, 1e-13);
  PetscCall(PetscFree(ku));
  PetscCall(SceneDestroy(&s));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  (void)size;
  PetscCall(TestLoads(failed));
  PetscCall(TestGravityAndImpulse(failed));
  PetscCall(TestMotion(failed));
  PetscCall(TestHeld(failed));
  PetscCall(TestVelocity(failed));
  PetscCall(TestFrame(failed));
  PetscCall(TestTwoFrames(failed));
  PetscCall(TestBalance(failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
