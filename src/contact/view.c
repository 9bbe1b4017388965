/*
   What the contacts of a model are: who slides on whom, by which laws, and the pairs that were found, with their area
   (m^2) and the gaps of the mesh as it is (m, negative where the meshes overlap).
*/
#include "contactimpl.h"

/* Over the pairs of one interface, on all ranks; least and most are unset where there is none */
typedef struct {
  PetscInt  n;
  PetscReal area, least, most; /* m^2; gaps, m */
} PairsExtent;

static PetscErrorCode PairsMeasure(Contact contact, PetscInt interface, PairsExtent *e)
{
  PetscReal least[2] = {PETSC_MAX_REAL, PETSC_MAX_REAL}; /* of the gap, and of the negative gap */

  PetscFunctionBeginUser;
  *e = (PairsExtent){0};
  for (PetscInt p = 0; p < contact->n_pairs; p++) {
    const ContactPair *pair = &contact->pairs[p];

    if (pair->interface != interface) continue;
    e->n++;
    e->area += pair->area;
    least[0] = PetscMin(least[0], pair->gap);
    least[1] = PetscMin(least[1], -pair->gap);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &e->n, 1, MPIU_INT, MPI_SUM, contact->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &e->area, 1, MPIU_REAL, MPI_SUM, contact->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, least, 2, MPIU_REAL, MPI_MIN, contact->comm));
  e->least = least[0];
  e->most  = -least[1];
  PetscFunctionReturn(0);
}

static PetscErrorCode PairsView(Contact contact, PetscInt interface, PetscViewer viewer)
{
  const ContactInterface *c = &contact->interfaces[interface];
  PairsExtent             e;
  const char             *metre, *area;

  PetscFunctionBeginUser;
  PetscCall(PairsMeasure(contact, interface, &e));
  PetscCall(ModelGetUnit(contact->model, "m", &metre));
  PetscCall(ModelGetUnit(contact->model, "m^2", &area));
  if (e.n)
    PetscCall(PetscViewerASCIIPrintf(
      viewer, "  %" PetscInt_FMT " %spairs over %.4g %s, gaps of the mesh %.3g to %.3g %s%s\n", e.n,
      contact->mortar[interface] ? "mortar " : "", (double)e.area, area, (double)e.least, (double)e.most, metre,
      c->discretization != CONTACT_AUTO ? ""
      : contact->mortar[interface]      ? ", since meshes do not match"
                                        : ", node to node, since meshes match"));
  if (c->interference > 0)
    PetscCall(PetscViewerASCIIPrintf(viewer, "  interference %.6g %s in statics\n", (double)c->interference, metre));
  if (c->n_off)
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "  %" PetscInt_FMT " of %" PetscInt_FMT " nodes of %s have no master under them\n",
                                     c->n_off, c->n_slaves, c->slave));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactView(Contact contact, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    const ContactInterface *c = &contact->interfaces[i];
    const char             *unit;

    PetscCall(PetscViewerASCIIPrintf(viewer, "contact %s: %s %s on %s, ", c->name, c->slave,
                                     c->kt > 0 ? "holds" : "slides", c->master));
    PetscCall(FrictionView(&c->friction, viewer));
    PetscCall(PetscViewerASCIIPrintf(viewer, ", "));
    PetscCall(ModelGetUnit(contact->model, c->kt_per_area ? "N/m^3" : "N/m", &unit));
    if (c->kt > 0)
      PetscCall(PetscViewerASCIIPrintf(viewer, "pairs that stick %.6g %s%s along it, ", (double)c->kt, unit,
                                       c->kt_per_area ? "" : " per pair"));
    PetscCall(ModelGetUnit(contact->model, c->per_area ? "N/m^3" : "N/m", &unit));
    if (c->identify)
      PetscCall(PetscViewerASCIIPrintf(viewer, "penalty, stiffness identified by pressing\n"));
    else if (!PressureIsLinear(&c->pressure)) {
      PetscCall(PetscViewerASCIIPrintf(viewer, "penalty, "));
      PetscCall(PressureView(&c->pressure, viewer));
      PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
    } else if (c->law == CONTACT_PENALTY)
      PetscCall(
        PetscViewerASCIIPrintf(viewer, "penalty %.6g %s%s\n", (double)c->kn, unit, c->per_area ? "" : " per pair"));
    else
      PetscCall(PetscViewerASCIIPrintf(viewer, "exact constraint by elimination\n"));
    PetscCall(PairsView(contact, i, viewer));
  }
  if (contact->n_interfaces > 1)
    PetscCall(PetscViewerASCIIPrintf(viewer, "  %" PetscInt_FMT " pairs of all contacts\n", contact->n_pairs_all));
  PetscCall(ContactTiesView(contact, viewer));
  PetscFunctionReturn(0);
}
