/* Options of interfaces and ties; friction laws have rows of their own */
#include "contactimpl.h"

#define INTERFACE(member) QUANTITY_AT(ContactInterface, member)
#define TIE(member)       QUANTITY_AT(ContactTie, member)

/* Two members, slave and master */
#define SURFACES(type) .at = offsetof(type, slave), .size = 2 * sizeof(char *)

static const char *const laws[] = {[CONTACT_PENALTY] = "penalty", [CONTACT_CONSTRAINT] = "constraint", NULL};
static const char *const fars[] = {[PETSC_FALSE] = "error", [PETSC_TRUE] = "free", NULL};

static const char *ContactIdleCentre(const void *contact)
{
  const PetscReal *w = ((const ContactInterface *)contact)->rotation;

  return Vec3Dot(w, w) > 0 ? NULL : "not used without -@rotation";
}

static const char *ContactIdleSlip(const void *contact)
{
  const ContactInterface *c = contact;

  return Vec3Dot(c->rotation, c->rotation) > 0 && Vec3Dot(c->slip, c->slip) > 0 ? "not used beside -@rotation; give one"
                                                                                : NULL;
}

static const Quantity interface[] = {
  {"-surfaces", "slave,master: named surfaces (required)", NULL, QUANTITY_NAMES, SURFACES(ContactInterface),
   .why = "slave,master"},
  {"-law", "k_n per pair, or the exact constraint", NULL, QUANTITY_WORD, INTERFACE(law), .words = laws},
  {"-kn_per_area", "instead: normal stiffness per area of the slave, N/m^3 (penalty)", NULL, QUANTITY_REAL,
   INTERFACE(kn), .given = offsetof(ContactInterface, per_area)},
  {"-kn", "normal stiffness per pair, N/m (penalty), or: identify", NULL, QUANTITY_TEXT, INTERFACE(kn_text),
   .text = "0", .given = offsetof(ContactInterface, has_kn)},
  {"-kt", "modes, holding by friction: stiffness along the surface of a pair that sticks", "N/m", QUANTITY_REAL,
   INTERFACE(kt), QUANTITY_POSITIVE, .given = offsetof(ContactInterface, has_kt)},
  {"-kt_per_area", "instead: that per area of the slave", "N/m^3", QUANTITY_REAL, INTERFACE(kt), QUANTITY_POSITIVE,
   .given = offsetof(ContactInterface, kt_per_area)},
  {"-tolerance", "largest distance of a slave node from the master along the normal", "m", QUANTITY_REAL,
   INTERFACE(tolerance), .initial = 1e-5, QUANTITY_POSITIVE},
  {"-overhang", "slave nodes farther beyond the master's border have no pair; 0: 1 % of a facet", "m", QUANTITY_REAL,
   INTERFACE(overhang), QUANTITY_NOT_NEGATIVE},
  {"-force", "total normal force in the sliding state", "N", QUANTITY_REAL, INTERFACE(force), QUANTITY_NOT_NEGATIVE},
  {"-speed", "sliding speed", "m/s", QUANTITY_REAL, INTERFACE(speed), QUANTITY_NOT_NEGATIVE},
  {"-friction_damping", "damping mu N/v across the slip, mu' N along it", NULL, QUANTITY_BOOL, INTERFACE(damping)},
  {"-slip", "direction of the slave's velocity relative to the master", NULL, QUANTITY_REALS, INTERFACE(slip),
   .idle = ContactIdleSlip},
  {"-rotation", "or: angular velocity of the master", "rad/s", QUANTITY_REALS, INTERFACE(rotation)},
  {"-centre", "a point of its axis", "m", QUANTITY_REALS, INTERFACE(centre), .idle = ContactIdleCentre},
};
static const Quantity tie[] = {
  {"-surfaces", "slave,master: a set whose nodes follow, and a surface (required)", NULL, QUANTITY_NAMES,
   SURFACES(ContactTie), .required = PETSC_TRUE, .why = "two names, slave,master"},
  {"-distance", "largest distance of a node of the slave from its foot; default 5 % of the facet's size", "m",
   QUANTITY_REAL, TIE(distance), QUANTITY_POSITIVE, .given = offsetof(ContactTie, has_distance)},
  {"-far", "nodes farther off are an error, or stay free", NULL, QUANTITY_WORD, TIE(free), .words = fars},
};

static const QuantityTable ties        = {"Tie", "contact.h", PETSC_STATIC_ARRAY_LENGTH(tie), tie};
const QuantityTable contact_quantities = {"Contact", "contact.h", PETSC_STATIC_ARRAY_LENGTH(interface), interface};
const QuantityList  ties_list          = {"-ties", "surfaces glued to others, each the prefix of its -surfaces",
                                          sizeof(ContactTie), &ties, TieCheckNames};
