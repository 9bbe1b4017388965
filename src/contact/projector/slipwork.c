/*
   Friction by a second path, after a step from t_n to t_{n+1}: the slip s of each closed pair over the step from where
   its nodes have come to, not from the velocities that its multiplier was found with,

      s = P (d_s(t_{n+1}) - d_s(t_n) - sum_i w_i (u_i(t_{n+1}) - u_i(t_n))) + way t       (m)

   P the projection on the tangent plane, d_s the displacement of the slave in the frame of the master, t and `way`
   direction and length of a sliding that is prescribed. Coulomb's law with the coefficient of the interface asks
   for the work mu lambda_n |s| (J); lambda_T . s is what the forces did. Where mu falls with speed, it is that of the
   slip of v_{n-1/2}, from the velocities of the nodes, and of the slip before that, extrapolated to t_n (prepare.c).
*/
#include "projectorimpl.h"
#include "base/algebra/vec3.h"

#define SLIP_NOISE 16 /* roundings of a displacement */

/* What is looked at: displacements of all nodes at t_n and t_{n+1}, m, and the slip that is prescribed per speed, s */
typedef struct {
  const PetscReal *u0, *u1;
  PetscReal        dt, kick, way[CONTACT_MAX];
} SlipStep;

/* One pair: slip (m) along t and b, slip over the step before with the sliding velocity of this one (m), the
   largest motion of one of its nodes, rounding of s */
typedef struct {
  PetscReal s[2], before[2], motion, noise;
} PairSlipped;

static void PairMotion(ContactProjector p, const ProjectorPair *pair, const SlipStep *step, PairSlipped *slip)
{
  const PetscReal *x = &p->nodes.x[3 * pair->slave];
  PetscReal        d0[3], d1[3], along[3], slave = 0, q[3];

  *slip = (PairSlipped){.motion = 0};
  FrameDisplacement(&p->frame_old[pair->interface], x, &step->u0[3 * pair->slave], d0);
  FrameDisplacement(&p->frame[pair->interface], x, &step->u1[3 * pair->slave], d1);
  for (int d = 0; d < 3; d++) {
    PetscReal master = 0;

    for (int i = 0; i < pair->n; i++) {
      const PetscInt at = 3 * pair->node[i] + d;

      master += pair->weight[i] * (step->u1[at] - step->u0[at]);
      slip->noise = PetscMax(slip->noise, PetscAbsReal(step->u1[at]));
    }
    along[d]     = d1[d] - d0[d] - master;
    slip->noise  = PetscMax(slip->noise, PetscAbsReal(d1[d]));
    slip->motion = PetscMax(slip->motion, PetscAbsReal(master));
    slave        = PetscMax(slave, PetscAbsReal(d1[d] - d0[d]));
  }
  slip->motion = PetscMax(slip->motion, slave);
  slip->noise *= SLIP_NOISE * PETSC_MACHINE_EPSILON;
  PairVelocity(pair, p->nodes.before, q);
  for (int i = 0; i < 2; i++) {
    slip->s[i]      = Vec3Dot(pair->e[1 + i], along);
    slip->before[i] = step->dt * (q[1 + i] + pair->drift[1 + i]);
  }
  slip->s[0] += pair->speed * step->way[pair->interface];
}

static void SlipWorkAdd(ContactProjector p, const ProjectorPair *pair, const SlipStep *step, ContactSlipWork *work)
{
  const PetscReal   normal = pair->p[0] / step->kick, T[2] = {-pair->p[1] / step->kick, -pair->p[2] / step->kick};
  const FrictionLaw law = FrictionAt(&p->contact->interfaces[pair->interface].friction, pair->speed);
  PetscReal         mu  = FrictionSteady(&law), length, done, asked, allowed;
  PairSlipped       slip;

  PairMotion(p, pair, step, &slip);
  length = hypot(slip.s[0], slip.s[1]);
  if (FrictionVaries(&law))
    mu =
      FrictionMu(&law, PetscMax(0, 1.5 * hypot(slip.before[0], slip.before[1]) / step->dt - 0.5 * pair->slip_before));
  done    = T[0] * slip.s[0] + T[1] * slip.s[1];
  asked   = mu * normal * length;
  allowed = 2 * mu * normal * slip.noise + p->noise * length;
  work->done += done;
  work->law += asked;
  work->heat += 0.5 * (done + T[0] * slip.before[0] + T[1] * slip.before[1]);
  work->miss += PetscMax(0, PetscAbsReal(done - asked) - allowed);
  work->noise += allowed;
  work->size += mu * normal * PetscMax(PetscMax(length, slip.motion), slip.noise);
  work->over += PetscMax(0, hypot(T[0], T[1]) - mu * normal - p->noise);
  work->normal += normal;
}

/* Way of a prescribed sliding of 1 m/s, s: that at the middle of the step; 0 where the frame of the master moves */
static PetscReal SlidingWay(const ContactSliding *sliding, const ContactStep *step)
{
  return sliding->turning ? 0 : step->dt * RampValue(&sliding->ramp, step->time + 0.5 * step->dt);
}

PetscErrorCode ContactProjectorGetSlipWork(ContactProjector p, const PetscReal u[], ContactSlipWork *work)
{
  const PetscBool root = p->share.rank == p->share.root ? PETSC_TRUE : PETSC_FALSE;
  PetscReal      *u1   = NULL;
  SlipStep        step = {.u0 = p->nodes.u, .dt = p->last.dt, .kick = p->last.kick};

  PetscFunctionBeginUser;
  PetscCall(ProjectorFinish(p));
  *work = (ContactSlipWork){.done = 0};
  if (root) PetscCall(PetscCalloc1(3 * p->share.n_nodes, &u1));
  PetscCall(ShareGather(&p->share, 1, (const PetscReal *const[]){u}, (PetscReal *const[]){u1}));
  step.u1 = u1;
  for (PetscInt i = 0; i < p->n_interfaces; i++) {
    step.way[i] = SlidingWay(&p->sliding[i], &p->last);
  }
  for (PetscInt k = 0; root && k < p->n_pairs; k++)
    if (p->pair[k].facet >= 0 && p->pair[k].p[0] > 0) SlipWorkAdd(p, &p->pair[k], &step, work);
  for (PetscInt i = 0; i < p->n_interfaces; i++) {
    work->dissipated += p->sums[i].heat - p->sums[i].heat_before;
    work->noise += SLIP_NOISE * PETSC_MACHINE_EPSILON * p->sums[i].heat;
  }
  PetscCall(PetscFree(u1));
  PetscCallMPI(MPI_Bcast(work, sizeof(*work), MPI_BYTE, p->share.root, p->share.comm));
  PetscFunctionReturn(0);
}
