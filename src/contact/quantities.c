/* Options of interfaces and ties; friction laws have rows of their own */
#include "contactimpl.h"

#define INTERFACE(member) QUANTITY_AT(ContactInterface, member)
#define TIE(member)       QUANTITY_AT(ContactTie, member)

/* Two members, slave and master */
#define SURFACES(type) .at = offsetof(type, slave), .size = 2 * sizeof(char *)

static const char *const laws[]            = {[CONTACT_PENALTY] = "penalty", [CONTACT_CONSTRAINT] = "constraint", NULL};
static const char *const discretizations[] = {
  [CONTACT_NODE] = "node", [CONTACT_MORTAR] = "mortar", [CONTACT_AUTO] = "auto", NULL};
static const char *const fars[] = {[PETSC_FALSE] = "error", [PETSC_TRUE] = "free", NULL};

static const char *ContactIdleCentre(const void *contact, const QuantityRun *run)
{
  (void)run;
  const PetscReal *w = ((const ContactInterface *)contact)->rotation;

  return Vec3Dot(w, w) > 0 ? NULL : "not used without -@rotation";
}

static const char *ContactIdleSlip(const void *contact, const QuantityRun *run)
{
  (void)run;
  const ContactInterface *c = contact;

  return Vec3Dot(c->rotation, c->rotation) > 0 && Vec3Dot(c->slip, c->slip) > 0 ? "not used beside -@rotation; give one"
                                                                                : NULL;
}

#define CONTACT_EXACT  ", whose contact is exact; a reduced model has the law with -dynamics_contact penalty"
#define CONTACT_STEADY "not used by -analysis static: the loads tell the forces, and nothing moves"

static const char *ContactIdleLaw(const void *contact, const QuantityRun *run)
{
  return run->does & RUN_IN_TIME && !(run->does & RUN_SPRINGS) &&
             ((const ContactInterface *)contact)->law != CONTACT_CONSTRAINT
           ? "not used in time without -dynamics_contact penalty: contact is exact"
           : NULL;
}

static const char *ContactIdleArea(const void *contact, const QuantityRun *run)
{
  const ContactInterface *c = contact;

  (void)run;
  if (!PressureIsLinear(&c->pressure)) return "not used with a -@pressure_law, which tells the stiffness of each pair";
  return c->law == CONTACT_CONSTRAINT ? "not used with -@law constraint, which is as stiff as can be" : NULL;
}

static const char *ContactIdleStiffness(const void *contact, const QuantityRun *run)
{
  return ((const ContactInterface *)contact)->identify ? NULL : ContactIdleArea(contact, run);
}

static const char *ContactIdleOverhang(const void *contact, const QuantityRun *run)
{
  (void)run;
  return ((const ContactInterface *)contact)->discretization == CONTACT_MORTAR
           ? "not used with -@discretization mortar, whose areas over the master are exact"
           : NULL;
}

static const char *ContactIdleForce(const void *contact, const QuantityRun *run)
{
  (void)run;
  const ContactInterface *c = contact;

  return c->damping || !PressureIsLinear(&c->pressure)
           ? NULL
           : "not used by modes without -@friction_damping or a -@pressure_law";
}

/* Of a speed without a direction, and where neither friction nor its damping nor wear depends on it */
static const char *ContactIdleSpeed(const void *contact, const QuantityRun *run)
{
  const ContactInterface *c = contact;

  if (run->does & RUN_IN_TIME)
    return Vec3Dot(c->rotation, c->rotation) + Vec3Dot(c->slip, c->slip) > 0 || c->speed <= 0 ? NULL : CONTACT_STILL;
  if (run->does & (RUN_STATIC | RUN_SLIDING) && ContactWears(c)) return NULL;
  if (run->does & RUN_STATIC) return FrictionNeedsSpeed(&c->friction) ? NULL : CONTACT_STEADY;
  return FrictionVaries(&c->friction) ? NULL : ContactIdleForce(contact, run);
}

static const char *ContactIdleGap(const void *contact, const QuantityRun *run)
{
  (void)contact;
  return run->does & RUN_MESH ? "not used in time on the mesh, whose gaps are those of its nodes as they move" : NULL;
}

static const char *ContactIdleExponent(const void *contact, const QuantityRun *run)
{
  (void)run;
  return ContactWears(contact) ? NULL : "not used without -@wear_rate";
}

static const Quantity interface[] = {
  {"-surfaces", "slave,master: named surfaces", NULL, QUANTITY_NAMES, SURFACES(ContactInterface),
   .required = PETSC_TRUE, .why = "slave,master"},
  {"-law", "k_n per pair, or the exact constraint", NULL, QUANTITY_WORD, INTERFACE(law), .words = laws,
   .idle = ContactIdleLaw},
  {"-discretization",
   "pairs of slave nodes and points of the master; means over both surfaces (mortar); or where not all meshes match "
   "(auto)",
   NULL, QUANTITY_WORD, INTERFACE(discretization), .words = discretizations},
  {"-kn_per_area", "instead: normal stiffness per area of the slave (penalty)", "N/m^3", QUANTITY_REAL, INTERFACE(kn),
   QUANTITY_OR_NONE, .given = offsetof(ContactInterface, per_area), .in = RUN_LINEAR | RUN_STATIC | RUN_SPRINGS,
   .unread = CONTACT_EXACT, .idle = ContactIdleArea, .varies = VARIES_LINEAR},
  {"-kn", "normal stiffness per pair (penalty), or: identify", "N/m", QUANTITY_TEXT, INTERFACE(kn_text), .text = "0",
   QUANTITY_OR_NONE, .given = offsetof(ContactInterface, has_kn), .in = RUN_LINEAR | RUN_STATIC | RUN_SPRINGS,
   .unread = CONTACT_EXACT, .idle = ContactIdleStiffness, .varies = VARIES_LINEAR},
  {"-kt", "modes, holding by friction: stiffness along the surface of a pair that sticks", "N/m", QUANTITY_REAL,
   INTERFACE(kt), QUANTITY_POSITIVE, .given = offsetof(ContactInterface, has_kt), .in = RUN_LINEAR,
   .varies = VARIES_LINEAR},
  {"-kt_per_area", "instead: that per area of the slave", "N/m^3", QUANTITY_REAL, INTERFACE(kt), QUANTITY_POSITIVE,
   .given = offsetof(ContactInterface, kt_per_area), .in = RUN_LINEAR, .varies = VARIES_LINEAR},
  {"-interference", "by how much the surfaces overlap before the bodies yield, off every gap", "m", QUANTITY_REAL,
   INTERFACE(interference), QUANTITY_NOT_NEGATIVE, .why = "surfaces apart are a -..._gap",
   .in = RUN_STATIC | RUN_SLIDING, .unread = ", whose gaps are those of the mesh"},
  {"-tolerance", "largest distance of a slave node from the master along the normal", "m", QUANTITY_REAL,
   INTERFACE(tolerance), .initial = 1e-5, QUANTITY_POSITIVE},
  {"-overhang", "slave nodes farther beyond the master's border have no pair; 0: 1 % of a facet", "m", QUANTITY_REAL,
   INTERFACE(overhang), QUANTITY_NOT_NEGATIVE, .idle = ContactIdleOverhang},
  {"-force", "total normal force in the sliding state", "N", QUANTITY_REAL, INTERFACE(force), QUANTITY_NOT_NEGATIVE,
   .in = RUN_LINEAR, .idle = ContactIdleForce, .varies = VARIES_LINEAR},
  {"-speed", "sliding speed", "m/s", QUANTITY_REAL, INTERFACE(speed), QUANTITY_OR_NONE, .idle = ContactIdleSpeed,
   .varies = VARIES_ALL},
  {"-friction_damping", "damping mu N/v across the slip, mu' N along it", NULL, QUANTITY_BOOL, INTERFACE(damping),
   .in = RUN_LINEAR},
  {"-slip", "direction of the slave's velocity relative to the master", NULL, QUANTITY_REALS, INTERFACE(slip),
   .idle = ContactIdleSlip},
  {"-rotation", "or: angular velocity of the master", "rad/s", QUANTITY_REALS, INTERFACE(rotation),
   .varies = VARIES_LINEAR},
  {"-centre", "a point of its axis", "m", QUANTITY_REALS, INTERFACE(centre), .idle = ContactIdleCentre},
  {"-gap", "table x_m,y_m,z_m,gap_m: gaps of the unloaded surfaces at the slave's nodes, in place of the mesh's", NULL,
   QUANTITY_PATH, INTERFACE(gap_file), .path = "file", .in = RUN_EQUILIBRIUM | RUN_REDUCED, .idle = ContactIdleGap},
  {"-wear_rate", "depth of the slave over pressure and length of sliding; with an exponent a per Pa^a", "1/Pa",
   QUANTITY_REAL, INTERFACE(wear_rate), QUANTITY_NOT_NEGATIVE, .in = RUN_STATIC | RUN_SLIDING, .varies = VARIES_LINEAR},
  {"-wear_rate_master", "that of the master, as if it stayed under its slave", "1/Pa", QUANTITY_REAL,
   INTERFACE(wear_rate_master), QUANTITY_NOT_NEGATIVE, .in = RUN_STATIC | RUN_SLIDING, .varies = VARIES_LINEAR},
  {"-wear_exponent", "exponent of the pressure in wear", NULL, QUANTITY_REAL, INTERFACE(wear_exponent), .initial = 1,
   QUANTITY_POSITIVE, .in = RUN_STATIC | RUN_SLIDING, .idle = ContactIdleExponent},
};

static const char *TieIdleFar(const void *tie, const QuantityRun *run)
{
  (void)run;
  return ((const ContactTie *)tie)->discretization == CONTACT_MORTAR
           ? "not used with -@discretization mortar, which leaves out nodes beside the master by itself"
           : NULL;
}

static const Quantity tie[] = {
  {"-surfaces", "slave,master: a set whose nodes follow, and a surface", NULL, QUANTITY_NAMES, SURFACES(ContactTie),
   .required = PETSC_TRUE, .why = "two names, slave,master"},
  {"-distance", "largest distance of a node of the slave from its foot; default 5 % of the facet's size", "m",
   QUANTITY_REAL, TIE(distance), QUANTITY_POSITIVE, .given = offsetof(ContactTie, has_distance)},
  {"-discretization",
   "each node of the slave follows its foot; means of both surfaces are one (mortar); or where not all meshes match "
   "(auto)",
   NULL, QUANTITY_WORD, TIE(discretization), .words = discretizations},
  {"-far", "nodes farther off are an error, or stay free; with mortar those beside the master always stay free", NULL,
   QUANTITY_WORD, TIE(free), .words = fars, .idle = TieIdleFar},
};

static const QuantityTable ties          = {"Tie", "contact.h", PETSC_STATIC_ARRAY_LENGTH(tie), tie, .in = 0};
static const QuantityTable contacts      = {"Contact", "contact.h", PETSC_STATIC_ARRAY_LENGTH(interface), interface,
                                            .in = 0};
const QuantityList         contacts_list = {"-contacts",
                                            "frictional interfaces, each the prefix of its options",
                                            sizeof(ContactInterface),
                                            &contacts,
                                            InterfaceCheckOptions,
                                            .in = 0};
const QuantityList         ties_list     = {
              "-ties", "surfaces glued to others, each the prefix of its -surfaces", sizeof(ContactTie), &ties, TieCheckNames,
              .in = 0};

const Quantity *ContactFindRow(const char name[])
{
  return QuantityFind(&contacts, name);
}
