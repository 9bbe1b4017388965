/*
   Friction in the pencil: parameters of the contact, and mu and mu' of an interface at its sliding speed as factors of
   terms.

   Where pairs slide at different speeds v, and the law knows the speed itself, mu differs from pair to pair. It is
   interpolated between n Chebyshev points v_k of the speeds (L_k Lagrange's polynomials),

      mu(v) = sum_k L_k(v) mu(v_k),

   so that K stays a sum of fixed matrices with functions of the parameters for coefficients. n is the least for which
   mu and v mu' are right to FRICTION_RTOL of the largest mu, at the stated speeds and from an eighth to eight times of
   them: what laws are scaled by is a speed. v_k go with the speed V of the interface, v_k = ratio_k V.
*/
#include "operators/pencilimpl.h"
#include "base/algebra/vec3.h"
#include <math.h>

/* of the largest mu: as good as the eigenvalues */
#define FRICTION_RTOL  1e-10
#define FRICTION_MISS  1e-8 /* most at other parameters */
#define FRICTION_NODES 32   /* at most */
/* at which mu is looked at: three for each of the most nodes */
#define FRICTION_PLACES 101
/* from V / 8 to 8 V */
#define FRICTION_OCTAVES 3

/* The law at p */
static FrictionLaw FactorLaw(const OperatorsFriction *f, const PetscReal p[])
{
  FrictionLaw law = f->law;

  for (int j = 0; j < FRICTION_PARAMETERS; j++)
    if (f->parameter[j] >= 0) law.parameter[j] = p[f->parameter[j]];
  if (f->speed >= 0) law.speed = f->ratio * p[f->speed];
  return law;
}

PetscReal FrictionFactorValue(const OperatorsFriction *f, PetscBool slope, const PetscReal p[])
{
  const FrictionLaw law = FactorLaw(f, p);

  return slope ? FrictionSteadySlope(&law) : FrictionSteady(&law);
}

/* By one of the parameters of the law, or by the speed of the interface, d / dV = ratio d / dv; of mu, or with
   slope of mu', s/m. */
PetscReal FrictionFactorDerivative(const OperatorsFriction *f, PetscBool slope, const PetscReal p[], PetscInt parameter)
{
  const FrictionLaw  law = FactorLaw(f, p);
  FrictionDerivative d;
  PetscReal          sum = 0;

  FrictionDerive(&law, &d);
  for (int j = 0; j < FRICTION_PARAMETERS; j++)
    if (f->parameter[j] == parameter) sum += slope ? d.slope[j] : d.mu[j];
  if (f->speed == parameter) sum += f->ratio * d.stated[slope ? 1 : 0];
  return sum;
}

PetscBool FrictionFactorDepends(const OperatorsFriction *f, PetscInt parameter)
{
  if (parameter < 0) return PETSC_FALSE;
  for (int j = 0; j < FRICTION_PARAMETERS; j++)
    if (f->parameter[j] == parameter) return PETSC_TRUE;
  return f->speed == parameter ? PETSC_TRUE : PETSC_FALSE;
}

/* L_k at a ratio of speeds, prod_{i != k} (r - r_i) / (r_k - r_i); of Chebyshev points the sum of |L_k| is of order
   log n, and rounding does not grow */
static PetscReal NodePolynomial(PetscInt n, const OperatorsFriction node[], PetscInt k, PetscReal ratio)
{
  PetscReal L = 1;

  for (PetscInt i = 0; i < n; i++)
    if (i != k) L *= (ratio - node[i].ratio) / (node[k].ratio - node[i].ratio);
  return L;
}

PetscReal FrictionNodeShare(const InterfaceParameters *q, PetscInt k, PetscReal speed)
{
  return q->n_nodes == 1 ? 1 : NodePolynomial(q->n_nodes, q->node, k, speed / q->stated);
}

PetscReal OperatorsLargestMu(Operators o, const PetscReal p[])
{
  PetscReal mu = o->mu >= 0 ? p[o->mu] : 0;
  PetscInt  n  = 0;

  const ContactInterface *c;

  if (o->interface) (void)ContactGetInterfaces(o->contact, &n, &c);
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt k = 0; k < o->interface[i].n_nodes; k++) {
      const PetscReal own = FrictionFactorValue(&o->interface[i].node[k], PETSC_FALSE, p);

      if (PetscAbsReal(own) > PetscAbsReal(mu)) mu = own;
    }
  return mu;
}

/* The law of an interface at p, with its stated speed */
static PetscErrorCode InterfaceGetLaw(Operators o, const PetscReal p[], PetscInt interface, FrictionLaw *law)
{
  const InterfaceParameters *q     = &o->interface[interface];
  const PetscReal           *value = OperatorsPoint(o, p);
  const ContactInterface    *c;
  PetscInt                   n;

  PetscFunctionBeginUser;
  PetscCall(ContactGetInterfaces(o->contact, &n, &c));
  *law = c[interface].friction;
  for (int j = 0; j < FRICTION_PARAMETERS; j++)
    if (q->law[j] >= 0) law->parameter[j] = value[q->law[j]];
  law->speed = q->speed >= 0 ? value[q->speed] : q->stated;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetInterface(Operators operators, const PetscReal p[], PetscInt interface, PetscReal *mu,
                                     PressureLaw *pressure)
{
  const InterfaceParameters *q     = &operators->interface[interface];
  const PetscReal           *value = OperatorsPoint(operators, p);
  const ContactInterface    *c;
  FrictionLaw                law;
  PetscInt                   n;

  PetscFunctionBeginUser;
  PetscCall(InterfaceGetLaw(operators, p, interface, &law));
  *mu = FrictionSteady(&law);
  PetscCall(ContactGetInterfaces(operators->contact, &n, &c));
  *pressure = c[interface].pressure;
  if (PressureIsLinear(pressure)) *pressure = PressureLinear(q->kn < 0 ? INFINITY : value[q->kn]);
  for (int j = 0; j < PRESSURE_PARAMETERS; j++)
    if (q->pressure[j] >= 0) pressure->parameter[j] = value[q->pressure[j]];
  PetscFunctionReturn(0);
}

/* mu of a pair at p: its speed goes with that of the interface, v = V v_0 / V_0. */
PetscErrorCode OperatorsGetPairMu(Operators operators, const PetscReal p[], const ContactPair *pair, PetscBool rests,
                                  PetscReal force, PetscReal *mu)
{
  const PetscReal stated = operators->interface[pair->interface].stated;
  FrictionLaw     law;

  PetscFunctionBeginUser;
  PetscCall(InterfaceGetLaw(operators, p, pair->interface, &law));
  law = FrictionOfPair(&law, stated > 0 ? law.speed * pair->speed / stated : 0, pair->area);
  law = FrictionPressed(&law, force);
  *mu = rests ? FrictionMu(&law, 0) : FrictionSteady(&law);
  PetscFunctionReturn(0);
}

/* Parameters of the law that modes read: of what slides those that decide mu, or with damping mu' alone; of what holds
   those that decide mu at rest */
static PetscErrorCode LawAddParameters(Operators o, const ContactInterface *c, PetscBool steady, InterfaceParameters *q)
{
  const FrictionParameter *law;
  const PetscInt           n = FrictionGetParameters(&c->friction, &law);

  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < n; j++) {
    const OperatorsParameter like = {
      .row = &law[j].row, .value = c->friction.parameter[j], .state = c->slides ? PETSC_FALSE : steady};

    if (law[j].steady != steady || (!c->slides && steady && !law[j].rest)) continue;
    PetscCall(ParametersAdd(&o->parameters, c->name, law[j].row.name + 1, &like, &q->law[j]));
  }
  PetscFunctionReturn(0);
}

/* Parameters of a pressure law that is not linear: modes know of them through the pressures of the sliding state */
static PetscErrorCode PressureAddParameters(Operators o, const ContactInterface *c, InterfaceParameters *q)
{
  const Quantity *row;
  const PetscInt  n = c->law == CONTACT_PENALTY ? PressureGetParameters(&c->pressure, &row) : 0;

  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < n; j++) {
    const OperatorsParameter like = {.row = &row[j], .value = c->pressure.parameter[j], .state = PETSC_TRUE};

    PetscCall(ParametersAdd(&o->parameters, c->name, row[j].name + 1, &like, &q->pressure[j]));
  }
  PetscFunctionReturn(0);
}

/* Parameters of one interface, in a fixed order: the law's steady ones, those of the pressure, kn, kt, those
   of its slope, force, speed. Other files find them by their indices, sweeps by their names. */
static PetscErrorCode InterfaceAddParameters(Operators o, const ContactInterface *c, InterfaceParameters *q)
{
  const PetscReal turning = Vec3Length(c->rotation); /* rad/s */
  const PetscBool moves   = c->damping || (c->slides && FrictionNeedsSpeed(&c->friction)) ? PETSC_TRUE : PETSC_FALSE;
  struct {
    PetscBool          there;
    const char        *name;
    OperatorsParameter like;
    PetscInt          *index;
  } what[] = {
    {c->law == CONTACT_PENALTY && PressureIsLinear(&c->pressure),
     c->per_area ? "kn_per_area" : "kn",
     {.value = c->kn},
     &q->kn},
    {c->kt > 0, c->kt_per_area ? "kt_per_area" : "kt", {.value = c->kt}, &q->kt},
    {c->damping, "force", {.value = c->force}, &q->force},
    {moves && turning > 0, "rotation", {.value = turning, .length = PETSC_TRUE, .divides = PETSC_TRUE}, &q->speed},
    {moves && turning <= 0, "speed", {.value = c->speed}, &q->speed},
  };

  PetscFunctionBeginUser;
  *q = (InterfaceParameters){.kn = -1, .kt = -1, .force = -1, .speed = -1, .stated = turning > 0 ? turning : c->speed};
  for (int j = 0; j < FRICTION_PARAMETERS; j++) q->law[j] = -1;
  for (int j = 0; j < PRESSURE_PARAMETERS; j++) q->pressure[j] = -1;
  if (c->slides) PetscCall(LawAddParameters(o, c, PETSC_TRUE, q));
  PetscCall(PressureAddParameters(o, c, q));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(what); i++) {
    if (i == 2 && !c->slides && c->kt > 0 && FrictionExists(&c->friction))
      PetscCall(LawAddParameters(o, c, PETSC_TRUE, q));
    if (i == 2 && c->damping) PetscCall(LawAddParameters(o, c, PETSC_FALSE, q));
    if (!what[i].there) continue;
    what[i].like.row = ContactFindRow(what[i].name);
    PetscCall(ParametersAdd(&o->parameters, c->name, what[i].name, &what[i].like, what[i].index));
  }
  PetscCall(OperatorsAddWear(o, c, q));
  PetscFunctionReturn(0);
}

/* n Chebyshev points (of the first kind) of the ratios from a to b, ascending; node[0] has what all share */
static void NodesSet(PetscReal a, PetscReal b, PetscInt n, OperatorsFriction node[])
{
  for (PetscInt k = 0; k < n; k++) {
    node[k]       = node[0];
    node[k].ratio = 0.5 * (a + b) - 0.5 * (b - a) * cos(PETSC_PI * ((PetscReal)k + 0.5) / (PetscReal)n);
  }
}

/* What n nodes miss of mu and v mu' at speeds V, of the largest mu: v mu' has mu's unit, and is what damping along
   the slip is made of */
static PetscReal NodesMiss(const OperatorsFriction node[], PetscInt n, const PetscReal range[2], PetscReal V)
{
  PetscReal miss = 0, size = 0;

  for (int i = 0; i < FRICTION_PLACES; i++) {
    const PetscReal   ratio = range[0] + (range[1] - range[0]) * i / (FRICTION_PLACES - 1.);
    const FrictionLaw law   = FrictionAt(&node[0].law, V * ratio);
    PetscReal         mu = -FrictionSteady(&law), slope = -FrictionSteadySlope(&law);

    size = PetscMax(size, PetscAbsReal(mu));
    for (PetscInt k = 0; k < n; k++) {
      const FrictionLaw own = FrictionAt(&node[0].law, V * node[k].ratio);
      const PetscReal   L   = NodePolynomial(n, node, k, ratio);

      mu += L * FrictionSteady(&own);
      slope += L * FrictionSteadySlope(&own);
    }
    miss = PetscMax(miss, PetscMax(PetscAbsReal(mu), V * ratio * PetscAbsReal(slope)));
  }
  return size > 0 ? miss / size : 0;
}

/* The fewest nodes that serve, for the ratios of all pairs */
static PetscErrorCode NodesChoose(Operators o, const ContactInterface *c, const PetscReal range[2],
                                  InterfaceParameters *q)
{
  PetscReal miss = INFINITY;

  PetscFunctionBeginUser;
  for (PetscInt n = 2; n <= FRICTION_NODES && miss > FRICTION_RTOL; n++) {
    NodesSet(range[0], range[1], n, q->node);
    miss       = 0;
    q->n_nodes = n;
    for (int m = -FRICTION_OCTAVES; m <= FRICTION_OCTAVES; m++)
      miss = PetscMax(miss, NodesMiss(q->node, n, range, ldexp(q->stated, m)));
  }
  PetscCheck(
    miss <= FRICTION_RTOL, o->comm, PETSC_ERR_SUP,
    "contact %s: pairs slide at %.6g to %.6g m/s, over which friction changes too much for modes: to %.1e of it by %d "
    "speeds; take the contact apart by radius",
    c->name, (double)(range[0] * q->stated), (double)(range[1] * q->stated), (double)miss, FRICTION_NODES);
  PetscFunctionReturn(0);
}

/* At other values the same nodes may serve worse: more than FRICTION_MISS is refused, where the values are set. */
PetscErrorCode OperatorsCheckFriction(Operators o, const PetscReal p[])
{
  const ContactInterface *c;
  PetscInt                n;
  OperatorsFriction       node[FRICTION_NODES];

  PetscFunctionBeginUser;
  if (!o->interface) PetscFunctionReturn(0);
  PetscCall(ContactGetInterfaces(o->contact, &n, &c));
  for (PetscInt i = 0; i < n; i++) {
    const InterfaceParameters *q = &o->interface[i];
    PetscReal                  miss;

    if (q->n_nodes <= 1) continue;
    PetscCall(PetscArraycpy(node, q->node, q->n_nodes));
    node[0].law = FactorLaw(&q->node[0], p);
    miss        = NodesMiss(node, q->n_nodes, q->range, q->speed >= 0 ? p[q->speed] : q->stated);
    PetscCheck(miss <= FRICTION_MISS, o->comm, PETSC_ERR_USER_INPUT,
               "contact %s: friction at these parameters is known to %.1e of it alone, between the speeds that the "
               "scene needs; write "
               "the scene with a speed or decay speed nearer to them",
               c[i].name, (double)miss);
  }
  PetscFunctionReturn(0);
}

/* Speeds at which mu is a factor: one where all pairs of all ranks slide alike to rounding, or the law knows no
   speed */
static PetscErrorCode InterfaceSetNodes(Operators o, PetscInt interface, const ContactInterface *c,
                                        InterfaceParameters *q)
{
  PetscReal         *range = q->range;
  PetscInt           n, n_all;
  const ContactPair *pairs;

  PetscFunctionBeginUser;
  if (!c->slides) PetscFunctionReturn(0);
  range[0] = range[1] = -INFINITY; /* - least, most */
  PetscCall(PetscCalloc1(FRICTION_NODES, &q->node));
  PetscCall(ContactGetPairs(o->contact, &n, &n_all, &pairs));
  for (PetscInt p = 0; p < n; p++) {
    const PetscReal ratio = q->stated > 0 ? pairs[p].speed / q->stated : 1;

    if (pairs[p].interface != interface) continue;
    range[0] = PetscMax(range[0], -ratio);
    range[1] = PetscMax(range[1], ratio);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, range, 2, MPIU_REAL, MPI_MAX, o->comm));
  range[0]   = -range[0];
  q->n_nodes = 1;
  q->node[0] = (OperatorsFriction){
    .law = c->friction, .speed = FrictionNeedsSpeed(&c->friction) ? q->speed : -1, .ratio = range[1]};
  q->node[0].law.speed = q->stated * range[1];
  PetscCall(PetscArraycpy(q->node[0].parameter, q->law, FRICTION_PARAMETERS));
  if (FrictionNeedsPressure(&c->friction)) { /* a factor of what each pair has */
    q->node[0].law   = (FrictionLaw){.kind = 0, .parameter = {c->friction.parameter[0]}};
    q->node[0].speed = -1;
    PetscFunctionReturn(0);
  }
  if (FrictionNeedsSpeed(&c->friction) && range[1] - range[0] > PETSC_SMALL * range[1])
    PetscCall(NodesChoose(o, c, range, q));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsAddContactParameters(Operators o)
{
  const ContactInterface *c;
  PetscInt                n;

  PetscFunctionBeginUser;
  PetscCall(ContactGetInterfaces(o->contact, &n, &c));
  PetscCall(PetscCalloc1(n, &o->interface));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(InterfaceAddParameters(o, &c[i], &o->interface[i]));
    PetscCall(InterfaceSetNodes(o, i, &c[i], &o->interface[i]));
  }
  PetscCall(OperatorsAddWearTime(o));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsDestroyContactParameters(Operators o)
{
  const ContactInterface *c;
  PetscInt                n;

  PetscFunctionBeginUser;
  if (!o->interface) PetscFunctionReturn(0);
  PetscCall(ContactGetInterfaces(o->contact, &n, &c));
  for (PetscInt i = 0; i < n; i++) PetscCall(PetscFree(o->interface[i].node));
  PetscCall(PetscFree(o->interface));
  PetscFunctionReturn(0);
}
