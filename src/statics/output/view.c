/*
   The sliding state in words.
*/
#include "statics/staticsimpl.h"
#include "base/algebra/vec3.h"

/* One interface: pairs, forces, and where the normal force acts. Friction about an axis may cancel as a vector: then
   its sum over the pairs and its moment say what it does */
static PetscErrorCode InterfaceView(Model model, const ContactInterface *c, const StaticsResultant *r,
                                    PetscViewer viewer)
{
  const PetscInt  open = r->n[CONTACT_OPEN], stick = r->n[CONTACT_STICK], slip = r->n[CONTACT_SLIP];
  const PetscBool rotates  = Vec3Length(c->rotation) > 0 ? PETSC_TRUE : PETSC_FALSE;
  const PetscReal friction = rotates ? r->rubbing : Vec3Length(r->friction);
  const char     *metre, *moment;

  PetscFunctionBeginUser;
  PetscCall(ModelGetUnit(model, "m", &metre));
  PetscCall(ModelGetUnit(model, "N m", &moment));
  PetscCall(PetscViewerASCIIPrintf(viewer, "contact %s: %" PetscInt_FMT " of %" PetscInt_FMT " pairs closed", c->name,
                                   stick + slip, open + stick + slip));
  if (!c->slides && FrictionExists(&c->friction))
    PetscCall(PetscViewerASCIIPrintf(viewer, ", %" PetscInt_FMT " stick and %" PetscInt_FMT " slip", stick, slip));
  PetscCall(
    PetscViewerASCIIPrintf(viewer, "; normal force %.9g N, friction %.6g N", (double)r->normal, (double)friction));
  if (rotates) PetscCall(PetscViewerASCIIPrintf(viewer, ", %.6g %s about the axis", (double)r->moment, moment));
  PetscCall(PetscViewerASCIIPrintf(viewer, "; centre of force %.6g, %.6g, %.6g %s\n", (double)r->centre[0],
                                   (double)r->centre[1], (double)r->centre[2], metre));
  PetscFunctionReturn(0);
}

/* Least and most pressure, closing and stiffness per area of the closed pairs, where the pressure is not linear */
static PetscErrorCode PressureRangeView(Statics s, PetscInt interface, PetscViewer viewer)
{
  static const char *const si[] = {"Pa", "m", "N/m^3"}, *const what[] = {"pressure", "closing", "stiffness"};
  PetscReal   extreme[2][3] = {{-PETSC_MAX_REAL, -PETSC_MAX_REAL, -PETSC_MAX_REAL}};
  const char *unit;

  PetscFunctionBeginUser;
  if (PressureIsLinear(&s->rows.pressure[interface])) PetscFunctionReturn(0);
  PetscCall(PetscArraycpy(extreme[1], extreme[0], 3));
  for (PetscInt p = 0; p < s->rows.n_pairs; p++) {
    const ContactPair *pair     = &s->rows.pair[p];
    const PetscReal    value[3] = {s->state[p].lambda_n / pair->area, -s->state[p].gap,
                                   StaticsPairStiffness(s, p) / pair->area};

    for (int k = 0; k < 3 && pair->interface == interface && s->state[p].status != CONTACT_OPEN; k++) {
      extreme[0][k] = PetscMax(extreme[0][k], -value[k]);
      extreme[1][k] = PetscMax(extreme[1][k], value[k]);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, extreme, 6, MPIU_REAL, MPI_MAX, s->comm));
  for (int k = 0; k < 3 && extreme[1][0] >= 0; k++) {
    PetscCall(ModelGetUnit(s->model, si[k], &unit));
    PetscCall(PetscViewerASCIIPrintf(viewer, "%s%s %.6g to %.6g %s%s", k ? ", " : "  ", what[k], (double)-extreme[0][k],
                                     (double)extreme[1][k], unit, k < 2 ? "" : "\n"));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsView(Statics s, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  PetscCall(StagesViewEnds(s, viewer));
  for (PetscInt i = 0; i < s->rows.n_interfaces; i++) {
    PetscCall(InterfaceView(s->model, &s->rows.interface[i], &s->resultant[i], viewer));
    PetscCall(PressureRangeView(s, i, viewer));
  }
  PetscCall(BoltsView(s, viewer));
  PetscCall(StaticsViewWear(s, viewer));
  if (s->n_free)
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "%" PetscInt_FMT " rigid motion%s that nothing resists or loads %s left out\n",
                                     s->n_free, s->n_free > 1 ? "s" : "", s->n_free > 1 ? "are" : "is"));
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "equilibrium to %.2g of the load after %" PetscInt_FMT
                                   " iteration%s and %" PetscInt_FMT " factorisation%s of the bodies\n",
                                   (double)s->equilibrium, s->n_it, s->n_it == 1 ? "" : "s", s->n_factored,
                                   s->n_factored == 1 ? "" : "s"));
  if (s->view_kkt) PetscCall(ContactViewKKT(&s->kkt, viewer));
  PetscFunctionReturn(0);
}
