/*
   Wear of interfaces as options say it (Archard with an exponent): the gap of a pair that carries the pressure p (Pa)
   at the sliding speed v (m/s) grows by

      dg0/dt = (k_s + k_m) p^a v    (m/s),

   k_s of the slave, k_m of the master, in 1/Pa for a = 1, else 1/Pa^a. Depths of the two sides are to each other as k_s
   to k_m. The master wears as if it stayed under its slave: of a disc that turns under a pad k_m is that of the pad's
   place, a disc's own k times the part of the circumference that the pad covers.
*/
#include "topography.h"

#define WEAR(member) QUANTITY_AT(struct _p_Contact, wear.member)

static const char *WearIdle(const void *contact, const QuantityRun *run)
{
  const struct _p_Contact *c = contact;

  (void)run;
  for (PetscInt i = 0; i < c->n_interfaces; i++)
    if (ContactWears(&c->interfaces[i])) return NULL;
  return "not used without a -..._wear_rate of a contact";
}

static const char *WearIdleEnd(const void *contact, const QuantityRun *run)
{
  const struct _p_Contact *c = contact;

  if (c->wear.time <= 0 && !(run->does & RUN_WEARS)) return "not used without a positive -wear_time";
  return WearIdle(contact, run);
}

#define WEARS_IN .in = RUN_STATIC | RUN_SLIDING, .restart = PETSC_TRUE
#define WEARS    WEARS_IN, .idle = WearIdleEnd

static const Quantity rows[] = {
  {"-wear_time", "time of sliding that contacts have worn when the sliding state is found", "s", QUANTITY_REAL,
   WEAR(time), QUANTITY_NOT_NEGATIVE, WEARS_IN, .idle = WearIdle, .varies = VARIES_LINEAR},
  {"-wear_steps", "equal steps of that time, each implicit", NULL, QUANTITY_INT, WEAR(steps), .initial = 50,
   QUANTITY_LEAST(1), WEARS},
  {"-wear_depth", "stop where a pair has worn so deep; 0: do not", "m", QUANTITY_REAL, WEAR(depth),
   QUANTITY_NOT_NEGATIVE, WEARS},
  {"-wear_settled", "stop where no pressure changes by more than this part of the largest in a step; 0: do not", NULL,
   QUANTITY_REAL, WEAR(settled), QUANTITY_NOT_NEGATIVE, WEARS},
};

const QuantityTable wear_quantities = {"Wear", "contact.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows, .in = 0};

const Quantity *ContactFindWearRow(const char name[])
{
  return QuantityFind(&wear_quantities, name);
}

PetscErrorCode ContactGetWear(Contact contact, const ContactWear **wear)
{
  PetscFunctionBeginUser;
  *wear = &contact->wear;
  PetscFunctionReturn(0);
}

PetscErrorCode ContactWearCheck(MPI_Comm comm, const ContactInterface *c, PetscBool quadratic)
{
  const char *what = c->wear_rate > 0 ? "wear_rate" : "wear_rate_master";

  PetscFunctionBeginUser;
  if (!ContactWears(c)) PetscFunctionReturn(0);
  PetscCheck(c->slides && (c->speed > 0 || Vec3Dot(c->rotation, c->rotation) > 0), comm, PETSC_ERR_USER_INPUT,
             "-%s_%s needs to know how fast contact %s slides: give -%s_rotation, or -%s_slip and a positive "
             "-%s_speed (m/s)",
             c->name, what, c->name, c->name, c->name, c->name);
  PetscCheck(!quadratic, comm, PETSC_ERR_USER_INPUT,
             "-%s_%s: %s has faces of second order, whose nodal forces are no pressures; choose -%s_discretization "
             "mortar, or mesh with elements of first order there",
             c->name, what, c->slave, c->name);
  PetscFunctionReturn(0);
}
