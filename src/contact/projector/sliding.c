/*
   Kinematics of a sliding interface. With the history r(t) of its speed, its integral R(t), and the given velocity of
   the slave relative to the master, V s (s of -contact_slip, V of -contact_speed) or -w x (x - c) (-contact_rotation,
   -contact_centre):
      prescribed  the part of r V s or -r w x (x - c) in the tangent plane is added to the slip velocity; of V s its
                  direction alone, so that the speed is V
      turning     the master, and the frame in which its nodes are described, is at x -> Q (x - c) + c, Q the rotation
                  by |w| R(t) about w, or at x -> x - V s R(t)
   Lengths in m, angles in rad, times in s.

   The friction coefficient is that of the slip speed at t_n, on the line through those of v_{n-1/2} and v_{n-3/2}. To
   v_{n-1/2} it adds the sliding velocity of the step at hand, at t_{n+1/2} or the mean of t_n to t_{n+1}: the two
   differ by one step where a ramp changes it. The pressure is that on the line through the last two forces.
*/
#include "projectorimpl.h"
#include "base/algebra/vec3.h"

/* Axis and speed from the parameters of the interface */
static void SlidingSetAxis(const ContactInterface *c, ContactSliding *sliding)
{
  const PetscReal  omega  = Vec3Length(c->rotation);
  const PetscReal *vector = omega > 0 ? c->rotation : c->slip, length = Vec3Length(vector);

  sliding->slides  = length > 0 ? PETSC_TRUE : PETSC_FALSE;
  sliding->rotates = omega > 0 ? PETSC_TRUE : PETSC_FALSE;
  sliding->speed   = omega > 0 ? omega : c->speed;
  for (int d = 0; d < 3; d++) sliding->axis[d] = length > 0 ? vector[d] / length : 0;
}

/* Of the options of its friction, such as contact_mu */
static PetscErrorCode SlidingNameFriction(const ContactInterface *c, size_t size, char name[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, size, "%s_mu", c->name));
  PetscFunctionReturn(0);
}

/* Friction by a temperature; raises the error where something else gives it a history, too */
static PetscErrorCode SlidingSetTemperature(MPI_Comm comm, const ContactInterface *c, ContactSliding *sliding)
{
  Ramp *friction = &sliding->friction;

  PetscFunctionBeginUser;
  PetscCheck(
    sliding->factors[0], comm, PETSC_ERR_USER_INPUT,
    "-%s_temperature_history does nothing without -%s_mu_temperature, a file of temperature,factor: friction is "
    "what follows a temperature in time",
    c->name, c->name);
  PetscCheck(!friction->file[0] && !(friction->frequency > 0) && friction->length == 0 && friction->delay == 0, comm,
             PETSC_ERR_USER_INPUT, "-%s_temperature_history and -%s_mu_%s are given; give one of them", c->name,
             c->name,
             friction->file[0]         ? "history"
             : friction->frequency > 0 ? "frequency"
             : friction->length > 0    ? "ramp"
                                       : "delay");
  PetscCall(RampReadTemperature(comm, c->name, sliding->temperature, sliding->factors, friction));
  PetscFunctionReturn(0);
}

PetscErrorCode SlidingSetUp(MPI_Comm comm, const ContactInterface *c, ContactSliding *sliding)
{
  char      name[160];
  PetscReal least = 0;

  PetscFunctionBeginUser;
  PetscCall(SlidingNameFriction(c, sizeof(name), name));
  PetscCall(RampSetUp(comm, c->name, &sliding->ramp));
  if (sliding->temperature[0])
    PetscCall(SlidingSetTemperature(comm, c, sliding));
  else
    PetscCall(RampSetUp(comm, name, &sliding->friction));
  for (PetscInt i = 0; i < sliding->friction.n; i++) least = PetscMin(least, sliding->friction.factor[i]);
  PetscCheck(!(sliding->friction.frequency > 0) && least >= 0, comm, PETSC_ERR_USER_INPUT,
             "-%s_%s: friction would become negative; give factors of time_s,factor that are not, by -%s_history", name,
             least < 0 ? "history" : "frequency", name);
  PetscFunctionReturn(0);
}

PetscErrorCode SlidingVisit(const ContactInterface *c, ContactSliding *sliding, const QuantityVisitor *visitor)
{
  const char *still = Vec3Length(c->rotation) > 0 || Vec3Length(c->slip) > 0 ? NULL : CONTACT_STILL;
  char        name[160];

  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisit(visitor, &sliding_quantities, c->name, sliding, NULL));
  PetscCall(RampVisit(visitor, "History of the speed of contact", c->name, &sliding->ramp, still));
  PetscCall(SlidingNameFriction(c, sizeof(name), name));
  PetscCall(RampVisit(visitor, "History of the friction of contact", name, &sliding->friction, NULL));
  SlidingSetAxis(c, sliding);
  PetscFunctionReturn(0);
}

PetscErrorCode SlidingCheck(MPI_Comm comm, const ContactInterface *c, const ContactSliding *sliding)
{
  PetscFunctionBeginUser;
  PetscCheck(c->interference == 0, comm, PETSC_ERR_SUP,
             "-%s_interference %.6g: in time gaps are those of the mesh; leave it out", c->name,
             (double)c->interference);
  PetscCheck(!sliding->slides || sliding->speed > 0, comm, PETSC_ERR_USER_INPUT,
             "-%s_slip says where to, not how fast: give a positive -%s_speed (m/s), or leave it out where only the "
             "displacements slide",
             c->name, c->name);
  PetscCheck(!sliding->turning || sliding->slides, comm, PETSC_ERR_USER_INPUT,
             "-%s_kinematics turning needs a -%s_rotation (rad/s), or a -%s_slip with a -%s_speed (m/s)", c->name,
             c->name, c->name, c->name);
  PetscFunctionReturn(0);
}

/* D = R' - I for a turn of the master by `angle` (rad): -sin K + (1 - cos) K^2, K a = axis x a (Rodrigues). 1 - cos
   is 2 sin^2 of the half angle, which keeps its figures at small angles; D itself, not R, is stored for the same
   reason. */
static void FrameTurn(const PetscReal axis[3], PetscReal angle, PetscReal D[3][3])
{
  const PetscReal K[3][3] = {{0, -axis[2], axis[1]}, {axis[2], 0, -axis[0]}, {-axis[1], axis[0], 0}};
  const PetscReal s = PetscSinReal(angle), half = PetscSinReal(0.5 * angle), c = 2 * half * half;

  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      D[i][j] = -s * K[i][j] + c * (K[i][0] * K[0][j] + K[i][1] * K[1][j] + K[i][2] * K[2][j]);
}

void SlidingFrame(const ContactInterface *c, const ContactSliding *sliding, PetscReal t, ContactFrame *frame)
{
  const PetscReal way = sliding->speed * RampIntegral(&sliding->ramp, t);

  *frame = (ContactFrame){.shift = {0}};
  for (int d = 0; d < 3; d++) frame->centre[d] = c->centre[d];
  if (!sliding->turning) return;
  if (sliding->rotates)
    FrameTurn(sliding->axis, way, frame->D);
  else
    for (int d = 0; d < 3; d++) frame->shift[d] = -way * sliding->axis[d];
}

PetscErrorCode ContactProjectorGetWay(ContactProjector p, PetscInt interface, const PetscReal t[2], PetscReal *way,
                                      PetscBool *turning)
{
  const ContactSliding *sliding = &p->sliding[interface];

  PetscFunctionBeginUser;
  *way     = RampIntegral(&sliding->ramp, t[1]) - RampIntegral(&sliding->ramp, t[0]);
  *turning = sliding->turning;
  PetscFunctionReturn(0);
}

PetscErrorCode ContactProjectorGetFriction(ContactProjector p, PetscInt interface, PetscReal t, PetscReal *factor,
                                           PetscBool *varies)
{
  const ContactSliding *sliding = &p->sliding[interface];

  PetscFunctionBeginUser;
  *factor = RampValue(&sliding->friction, t);
  *varies = SlidingFrictionStays(sliding) ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode ContactProjectorGetFactors(ContactProjector p, PetscInt interface, PetscReal t, PetscReal *speed,
                                          PetscReal *friction, PetscBool *warms)
{
  const ContactSliding *sliding = &p->sliding[interface];

  PetscFunctionBeginUser;
  *speed    = RampValue(&sliding->ramp, t);
  *friction = RampValue(&sliding->friction, t);
  *warms    = sliding->temperature[0] ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode ContactProjectorCheckSteps(ContactProjector p, PetscReal dt)
{
  char name[160];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < p->n_interfaces; i++) {
    const ContactInterface *c = &p->contact->interfaces[i];

    PetscCall(SlidingNameFriction(c, sizeof(name), name));
    if (p->sliding[i].temperature[0]) PetscCall(PetscSNPrintf(name, sizeof(name), "%s_temperature", c->name));
    PetscCall(RampCheckSteps(p->contact->comm, c->name, &p->sliding[i].ramp, dt));
    PetscCall(RampCheckSteps(p->contact->comm, name, &p->sliding[i].friction, dt));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ContactProjectorGetSteady(ContactProjector p, PetscInt interface, PetscBool *steady)
{
  const ContactSliding *sliding = &p->sliding[interface];

  PetscFunctionBeginUser;
  *steady = !RampVaries(&sliding->ramp) && !RampVaries(&sliding->friction) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode ContactProjectorGetDelay(ContactProjector p, PetscInt interface, PetscReal *delay)
{
  PetscFunctionBeginUser;
  *delay = p->sliding[interface].slides ? p->sliding[interface].ramp.delay : 0;
  PetscFunctionReturn(0);
}

PetscErrorCode SlidingView(const ContactInterface *c, const ContactSliding *sliding, PetscViewer viewer)
{
  char words[240];

  PetscFunctionBeginUser;
  if (!sliding->slides || sliding->speed == 0) {
    PetscCall(PetscViewerASCIIPrintf(viewer, "  nothing makes it slide but the displacements\n"));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscViewerASCIIPrintf(
    viewer, sliding->turning ? "  %s moves, described in its own frame: " : "  meshes stay, %s slides as prescribed: ",
    c->master));
  PetscCall(PetscViewerASCIIPrintf(viewer, sliding->rotates ? "%.6g rad/s" : "%.6g m/s", (double)sliding->speed));
  PetscCall(RampDescribe(&sliding->ramp, sizeof(words), words));
  PetscCall(PetscViewerASCIIPrintf(viewer, ", %s\n", words));
  if (!SlidingFrictionStays(sliding)) {
    PetscCall(RampDescribe(&sliding->friction, sizeof(words), words));
    PetscCall(PetscViewerASCIIPrintf(viewer, "  its friction: %s\n", words));
  }
  PetscFunctionReturn(0);
}

/* Pressure of a pair at t_n, on the line through its last two forces, Pa */
static PetscReal PairPressure(const ProjectorPair *pair)
{
  PetscReal force[2] = {0, 0};

  for (int k = 0; k < 2; k++)
    for (int d = 0; d < 3; d++) force[k] += pair->lambda[k][d] * pair->e[0][d];
  return pair->area > 0 ? PetscMax(0, 2 * force[0] - force[1]) / pair->area : 0;
}

/* Friction coefficient at the slip speed and the pressure at t_n: s_n = s_{n-1/2} + (s_{n-1/2} - s_{n-3/2}) / 2 = 1.5
   s_{n-1/2} - 0.5 s_{n-3/2}, not below 0. It is explicit: what the step finds does not enter, so that mu is one number
   in Gauss-Seidel and its cones stay convex. A pair without a slip before has s_n = s_{n-1/2}. */
void PairSetFriction(ContactProjector p, PetscReal t, ProjectorPair *pair)
{
  const ContactInterface *c = &p->contact->interfaces[pair->interface];
  FrictionLaw             law;
  const ContactSliding   *sliding = &p->sliding[pair->interface];
  const PetscReal         factor  = SlidingFrictionStays(sliding) ? 1 : RampValue(&sliding->friction, t);
  PetscReal               q[3], last, s;

  pair->mu = factor * FrictionSteady(&c->friction);
  if (!FrictionVaries(&c->friction)) return;
  PairVelocity(pair, p->nodes.before, q);
  last       = pair->slip;
  pair->slip = hypot(q[1] + pair->drift[1], q[2] + pair->drift[2]);
  if (last < 0) last = pair->slip;
  pair->slip_before = last;
  law               = FrictionAt(&c->friction, pair->speed);
  law.pressure      = FrictionNeedsPressure(&law) ? PairPressure(pair) : 0;
  s                 = PetscMax(0, 1.5 * pair->slip - 0.5 * last);
  pair->mu          = factor * FrictionMu(&law, s);
  if (law.pressure == 0 || FrictionCovers(&law, s)) return;
  p->beyond[0] = (PetscReal)pair->interface;
  p->beyond[1] = s;
  p->beyond[2] = law.pressure;
}
