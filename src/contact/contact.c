/*
   Contact: interfaces from the options, access to them and their pairs.

   Every number is stored in SI units as the options say it: k_n and k_t per pair (N/m) or per area (N/m^3, has the
   flag per_area beside it; a pair then has k_n a_p with a_p of cover.c, m^2), tolerance and overhang in m, speed in
   m/s, rotation in rad/s, force in N. What follows from a pair's place, such as its direction of slip, is of pair.c.
*/
#include "contactimpl.h"
#include "base/events.h"
#include "contact/topography/topography.h"
#include <stdlib.h>
#include <string.h>

const char *const ContactStatusNames[CONTACT_N_STATUS] = {"open", "stick", "slip"};

PetscErrorCode ContactCreate(Model model, Contact *contact)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, contact));
  (*contact)->model = model;
  PetscCall(QuantitiesInit(&wear_quantities, *contact));
  PetscCall(ModelGetComm(model, &(*contact)->comm));
  PetscFunctionReturn(0);
}

/* The normal stiffness: a number in N/m, or the word `identify`, with which kn is 1 until statics has found it. The
   option is a text because of that word, so that no reader of numbers has checked it: a number with a unit behind it is
   refused here, of which strtod() would take the number and leave the unit out. */
static PetscErrorCode StiffnessParse(MPI_Comm comm, ContactInterface *c)
{
  char unit[256], *end;

  PetscFunctionBeginUser;
  PetscCheck(!c->has_kn || !c->per_area, comm, PETSC_ERR_USER_INPUT,
             "-%s_kn and -%s_kn_per_area are given; give one of them", c->name, c->name);
  if (!c->has_kn) PetscFunctionReturn(0);
  c->identify = !strcmp(c->kn_text, "identify") ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(ValueExplainUnit(c->kn_text, unit, sizeof(unit)));
  PetscCheck(!unit[0], comm, PETSC_ERR_USER_INPUT, "-%s_kn: %s has a unit: %s", c->name, c->kn_text, unit);
  c->kn = c->identify ? 1 : strtod(c->kn_text, &end);
  PetscCheck(c->identify || (end != c->kn_text && !*end), comm, PETSC_ERR_USER_INPUT,
             "-%s_kn '%s' must be a positive number (N/m) or the word identify", c->name, c->kn_text);
  PetscFunctionReturn(0);
}

/* A stiffness that is given beside a law that is not linear: its row refuses it on the command line, of a file it is
   taken out, with a warning */
static PetscErrorCode StiffnessDrop(MPI_Comm comm, ContactInterface *c)
{
  PetscFunctionBeginUser;
  if (PressureIsLinear(&c->pressure)) PetscFunctionReturn(0);
  PetscCall(OptionsDropBeside(comm, c->name, "kn kn_per_area", "pressure_law", PressureGetName(&c->pressure)));
  c->kn     = 0;
  c->has_kn = c->per_area = c->identify = PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode InterfaceCheckOptions(MPI_Comm comm, void *owner, void *record)
{
  Contact           contact = owner;
  ContactInterface *c       = record;

  PetscFunctionBeginUser;
  PetscCall(StiffnessParse(comm, c));
  PetscCheck(!c->has_kt || !c->kt_per_area, comm, PETSC_ERR_USER_INPUT,
             "-%s_kt and -%s_kt_per_area are given; give one of them", c->name, c->name);
  PetscCall(FrictionSetFromOptions(comm, c->name, &c->friction));
  PetscCall(PressureSetFromOptions(comm, c->name, &c->pressure));
  PetscCall(StiffnessDrop(comm, c));
  PetscCall(ContactGapsRead(comm, c));
  c->friction.speed = c->speed;
  /* a law mu(s) that changes with the slip speed s has no value in modes without one; with neither slip nor rotation
     nothing slides as told, and s = 0 m/s holds */
  PetscCheck(!FrictionNeedsSpeed(&c->friction) || c->speed > 0 || Vec3Length(c->rotation) > 0 ||
               Vec3Length(c->slip) == 0,
             comm, PETSC_ERR_USER_INPUT,
             "contact %s: friction depends on the sliding speed: give a positive -%s_speed (m/s) with -%s_slip",
             c->name, c->name, c->name);
  if (c->slave) PetscCall(ModelKeepTogether(contact->model, c->slave));
  if (c->master) PetscCall(ModelKeepTogether(contact->model, c->master));
  PetscFunctionReturn(0);
}

/* Raises an error for parameters that make no sense or would be ignored. It is called in ContactSetUp(), not where
   the options are read, since runs in time read the same options and have no penalty law. */
static PetscErrorCode InterfaceCheck(MPI_Comm comm, const ContactInterface *c)
{
  const PetscBool linear = PressureIsLinear(&c->pressure);

  PetscFunctionBeginUser;
  PetscCheck(linear || c->law == CONTACT_PENALTY, comm, PETSC_ERR_USER_INPUT,
             "-%s_pressure_law %s does nothing with -%s_law constraint; choose -%s_law penalty, or -%s_pressure_law "
             "linear",
             c->name, PressureGetName(&c->pressure), c->name, c->name, c->name);
  PetscCheck(!linear || c->law == CONTACT_CONSTRAINT || (c->kn > 0 && !PetscIsInfReal(c->kn)), comm,
             PETSC_ERR_USER_INPUT, "-%s_kn%s %.6g must be given and positive (N/m%s), or choose -%s_law constraint",
             c->name, c->per_area ? "_per_area" : "", (double)c->kn, c->per_area ? "^3" : "", c->name);
  PetscCheck(c->law == CONTACT_PENALTY || !c->identify, comm, PETSC_ERR_USER_INPUT,
             "-%s_kn identify does nothing with -%s_law constraint; choose -%s_law penalty", c->name, c->name, c->name);
  PetscCheck(c->kt == 0 || FrictionExists(&c->friction), comm, PETSC_ERR_USER_INPUT,
             "-%s_kt%s %.6g does nothing without friction; give a coefficient of -%s_friction_law, or leave it out",
             c->name, c->kt_per_area ? "_per_area" : "", (double)c->kt, c->name);
  PetscCheck(c->kt == 0 || !c->damping, comm, PETSC_ERR_USER_INPUT,
             "-%s_friction_damping does nothing where the contact holds by friction (-%s_kt%s); leave one out", c->name,
             c->name, c->kt_per_area ? "_per_area" : "");
  PetscCheck(!c->damping || c->speed > 0 || c->rotation[0] != 0 || c->rotation[1] != 0 || c->rotation[2] != 0, comm,
             PETSC_ERR_USER_INPUT, "-%s_friction_damping needs a positive -%s_speed (m/s) or a -%s_rotation", c->name,
             c->name, c->name);
  PetscCall(FrictionWarnLarge(comm, c->name, &c->friction));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactDampFriction(Contact contact)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    ContactInterface *c     = &contact->interfaces[i];
    const PetscBool   turns = Vec3Dot(c->rotation, c->rotation) > 0 ? PETSC_TRUE : PETSC_FALSE;
    const PetscBool   moves = turns || (c->speed > 0 && Vec3Dot(c->slip, c->slip) > 0) ? PETSC_TRUE : PETSC_FALSE;

    if (moves && FrictionExists(&c->friction)) c->damping = PETSC_TRUE;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ContactSetFromOptions(Contact contact)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesReadList(contact->comm, &contacts_list, contact, &contact->n_interfaces, &contact->interfaces));
  PetscCheck(contact->n_interfaces <= CONTACT_MAX, contact->comm, PETSC_ERR_USER_INPUT,
             "-contacts gives %" PetscInt_FMT " names, at most %d are valid: unite surfaces in the mesh",
             contact->n_interfaces, CONTACT_MAX);
  PetscCall(QuantitiesRead(contact->comm, &wear_quantities, contact));
  PetscCall(QuantitiesReadList(contact->comm, &ties_list, contact, &contact->n_ties, &contact->ties));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactVisit(Contact contact, const QuantityVisitor *visitor)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisitList(visitor, &contacts_list, contact->n_interfaces, contact->interfaces));
  for (PetscInt i = 0; i < contact->n_interfaces; i++)
    PetscCall(FrictionVisit(&contact->interfaces[i].friction, contact->interfaces[i].name, visitor));
  for (PetscInt i = 0; i < contact->n_interfaces; i++)
    PetscCall(PressureVisit(&contact->interfaces[i].pressure, contact->interfaces[i].name, visitor));
  PetscCall(QuantitiesVisit(visitor, &wear_quantities, NULL, contact, NULL));
  PetscCall(QuantitiesVisitList(visitor, &ties_list, contact->n_ties, contact->ties));
  PetscFunctionReturn(0);
}

/* count[k]: faces of a surface with k nodes, over all ranks. A face belongs to the one rank that has its cell, so
   that the sum counts none twice. */
static PetscErrorCode FacesOfSizes(Contact contact, const char set[], PetscInt count[CONTACT_MAX_MASTER + 1])
{
  ModelFaces faces;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(count, CONTACT_MAX_MASTER + 1));
  PetscCall(ModelGetSetFaces(contact->model, set, &faces));
  for (PetscInt f = 0; f < faces.n; f++) count[faces.first[f + 1] - faces.first[f]]++;
  PetscCall(ModelFacesDestroy(&faces));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, CONTACT_MAX_MASTER + 1, MPIU_INT, MPI_SUM, contact->comm));
  PetscFunctionReturn(0);
}

/* A warning for slaves with faces of eight nodes that can open: int N_i dA is negative at their corners, so that a
   uniform pressure asks the corners to pull, which the exact law refuses. An error where second rows of nodes are
   asked for under faces of second order: their sides and middles have no edge into the body (approach.c). */
static PetscErrorCode InterfaceCheckFaces(Contact contact, PetscInt interface)
{
  const ContactInterface *c = &contact->interfaces[interface];
  PetscInt                slave[CONTACT_MAX_MASTER + 1], master[CONTACT_MAX_MASTER + 1], second = 0, quadratic = 0;

  PetscFunctionBeginUser;
  PetscCall(FacesOfSizes(contact, c->slave, slave));
  PetscCall(FacesOfSizes(contact, c->master, master));
  for (int n = 5; n <= CONTACT_MAX_MASTER; n++) {
    second += slave[n] + master[n];
    quadratic += slave[n];
  }
  PetscCall(ContactWearCheck(contact->comm, c, quadratic && !contact->mortar[interface] ? PETSC_TRUE : PETSC_FALSE));
  PetscCheck(!second || !c->identify, contact->comm, PETSC_ERR_USER_INPUT,
             "-%s_kn identify needs elements of first order at %s and %s; give -%s_kn_per_area (N/m^3)", c->name,
             c->slave, c->master, c->name);
  if (c->law == CONTACT_CONSTRAINT && slave[8] && !contact->mortar[interface])
    PetscCall(PetscFPrintf(contact->comm, stderr,
                           "squeal: warning: contact %s: %" PetscInt_FMT
                           " faces of %s have eight nodes (hex20, wedge15), whose corners open under a uniform "
                           "pressure, since it pulls at them; mesh with hex27 or tet10 there\n",
                           c->name, slave[8], c->slave));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactSetUp(Contact contact)
{
  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_PAIR));
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    PetscCall(InterfaceCheck(contact->comm, &contact->interfaces[i]));
    PetscCall(ContactPairInterface(contact, i));
    PetscCall(ContactFoldWarn(contact, i));
    PetscCall(InterfaceCheckFaces(contact, i));
    PetscCall(ContactGapsSet(contact, i));
  }
  PetscCall(ContactLengthsWarn(contact));
  PetscCall(ContactSetUpTies(contact));
  PetscCallMPI(MPI_Allreduce(&contact->n_pairs, &contact->n_pairs_all, 1, MPIU_INT, MPI_SUM, contact->comm));
  PetscCall(EventEnd(EVENT_PAIR));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactGetInterfaces(Contact contact, PetscInt *n, const ContactInterface **interfaces)
{
  PetscFunctionBeginUser;
  *n          = contact->n_interfaces;
  *interfaces = contact->interfaces;
  PetscFunctionReturn(0);
}

PetscErrorCode ContactGetPairs(Contact contact, PetscInt *n_local, PetscInt *n_global, const ContactPair **pairs)
{
  PetscFunctionBeginUser;
  *n_local  = contact->n_pairs;
  *n_global = contact->n_pairs_all;
  *pairs    = contact->pairs;
  PetscFunctionReturn(0);
}

PetscErrorCode ContactGetMeans(Contact contact, PetscInt *n, const ContactMean **means)
{
  PetscFunctionBeginUser;
  *n     = contact->n_means;
  *means = contact->means;
  PetscFunctionReturn(0);
}

PetscErrorCode ContactGetCentre(Contact contact, PetscReal centre[3], PetscBool *found)
{
  PetscFunctionBeginUser;
  for (int d = 0; d < 3; d++) centre[d] = 0;
  *found = contact->n_pairs_all ? PETSC_TRUE : PETSC_FALSE;
  if (!*found) PetscFunctionReturn(0);
  /* a mean over pairs, not weighted by area: it tells where the contact is, no integral is taken about it */
  for (PetscInt p = 0; p < contact->n_pairs; p++)
    for (int d = 0; d < 3; d++) centre[d] += contact->pairs[p].x[d] / (PetscReal)contact->n_pairs_all;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, centre, 3, MPIU_REAL, MPI_SUM, contact->comm));
  PetscFunctionReturn(0);
}

/* What options say. A stiffness that is found by pressing depends on the loads, and counts where it is used, as a
   value of the sweep; here it is 0. The sign of kn and kt tells a stiffness per area from one per pair: both are
   positive where given, and the same number of the two kinds is another model. */
PetscErrorCode ContactAddChecksum(Contact contact, Checksum c)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    const ContactInterface *f         = &contact->interfaces[i];
    const PetscInt          flags[]   = {i, f->law, f->identify, f->damping, f->discretization};
    const PetscReal         kn        = f->identify ? 0 : f->per_area ? -f->kn : f->kn;
    const PetscReal         kt        = f->kt_per_area ? -f->kt : f->kt;
    const PetscReal         numbers[] = {f->tolerance, f->overhang, f->speed, kn, kt, f->force};
    const PetscReal         wear[]    = {f->wear_rate, f->wear_rate_master, f->wear_exponent};

    PetscCall(ChecksumSetPart(c, "contact %s", f->name));
    PetscCall(ModelAddSetChecksum(contact->model, f->slave, PETSC_TRUE, c));
    PetscCall(ModelAddSetChecksum(contact->model, f->master, PETSC_TRUE, c));
    PetscCall(ChecksumAddInts(c, PETSC_STATIC_ARRAY_LENGTH(flags), flags));
    PetscCall(ChecksumAddReals(c, PETSC_STATIC_ARRAY_LENGTH(numbers), numbers));
    PetscCall(ChecksumAddReals(c, PETSC_STATIC_ARRAY_LENGTH(wear), wear));
    for (PetscInt k = 0; k < f->n_gaps; k++) PetscCall(ChecksumAddReals(c, 1, &f->gaps[k].gap));
    PetscCall(FrictionAddChecksum(&f->friction, c));
    PetscCall(PressureAddChecksum(&f->pressure, c));
    if (f->interference > 0) PetscCall(ChecksumAddReals(c, 1, &f->interference));
    PetscCall(ChecksumAddReals(c, 3, f->slip));
    PetscCall(ChecksumAddReals(c, 3, f->rotation));
    PetscCall(ChecksumAddReals(c, 3, f->centre));
  }
  PetscCall(ChecksumSetPart(c, "wear"));
  PetscCall(QuantitiesAddChecksum(&wear_quantities, contact, c));
  PetscCall(ContactTiesAddChecksum(contact, c));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactDestroy(Contact *contact)
{
  PetscFunctionBeginUser;
  if (!*contact) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < (*contact)->n_interfaces; i++) {
    PetscCall(PetscFree((*contact)->interfaces[i].name));
    PetscCall(PetscFree((*contact)->interfaces[i].slave));
    PetscCall(PetscFree((*contact)->interfaces[i].master));
    PetscCall(PressureDestroy(&(*contact)->interfaces[i].pressure));
    PetscCall(FrictionDestroy(&(*contact)->interfaces[i].friction));
    PetscCall(PetscFree((*contact)->interfaces[i].gaps));
    PetscCall(ContactSurfaceDestroy(&(*contact)->surface[i]));
    PetscCall(PetscFree((*contact)->sides[i]));
  }
  PetscCall(PetscFree((*contact)->interfaces));
  PetscCall(PetscFree((*contact)->pairs));
  PetscCall(PetscFree((*contact)->feet));
  PetscCall(PetscFree((*contact)->means));
  PetscCall(ContactTiesDestroy(*contact));
  PetscCall(PetscFree(*contact));
  PetscFunctionReturn(0);
}
