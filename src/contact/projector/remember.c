/*
   What the contact forces must keep so that a run goes on bitwise: of each slave its facet, place on it and last
   forces, the displacements and time of the last search, which is repeated, and the sums. A rank has its own pairs;
   whether a search is due each one knows.
*/
#include "projectorimpl.h"

#define PER_PAIR (4 + 3 * PROJECTOR_PAST) /* facet, natural coordinates, slip speed, forces */
#define PER_SUMS ((PetscInt)(sizeof(ContactSums) / sizeof(PetscReal)))

static PetscInt MemoryLength(const ContactProjector p)
{
  if (!p->share.solves) return 1 + PER_SUMS * p->n_interfaces;
  return 4 + PER_SUMS * p->n_interfaces + PER_PAIR * p->n_pairs + 3 * p->share.n_nodes + MortarMemoryLength(p);
}

PetscErrorCode ContactProjectorGetMemory(ContactProjector p, PetscInt *n, PetscReal **values)
{
  PetscReal *v;

  PetscFunctionBeginUser;
  PetscCall(ProjectorFinish(p));
  *n = MemoryLength(p);
  PetscCall(PetscMalloc1(*n, values));
  v    = *values;
  *v++ = (PetscReal)p->search_next;
  PetscCall(PetscMemcpy(v, p->sums, sizeof(ContactSums) * (size_t)p->n_interfaces));
  v += PER_SUMS * p->n_interfaces;
  if (!p->share.solves) PetscFunctionReturn(0);
  *v++ = p->t_search;
  *v++ = (PetscReal)p->order;
  *v++ = p->rate;
  for (PetscInt k = 0; k < p->n_pairs; k++) {
    const ProjectorPair *pair = &p->pair[k];

    *v++ = (PetscReal)pair->facet;
    for (int i = 0; i < 2; i++) *v++ = pair->natural[i];
    *v++ = pair->slip;
    for (int i = 0; i < 3 * PROJECTOR_PAST; i++) *v++ = pair->lambda[i / 3][i % 3];
  }
  PetscCall(PetscArraycpy(v, p->u_search, 3 * p->share.n_nodes));
  MortarGetMemory(p, v + 3 * p->share.n_nodes);
  PetscFunctionReturn(0);
}

/* What pairs need; repeats the last search */
static PetscErrorCode PairsSetMemory(ContactProjector p, const PetscReal v[])
{
  const PetscReal t = *v++;

  PetscFunctionBeginUser;
  p->order = (PetscInt)*v++;
  p->rate  = *v++;
  for (PetscInt i = 0; i < p->n_interfaces; i++)
    SlidingFrame(&p->contact->interfaces[i], &p->sliding[i], t, &p->frame[i]);
  for (PetscInt k = 0; k < p->n_pairs; k++) {
    ProjectorPair *pair = &p->pair[k];

    pair->facet = (PetscInt)*v++;
    pair->found = SlidingStays(&p->sliding[pair->interface]);
    for (int i = 0; i < 2; i++) pair->natural[i] = *v++;
    pair->slip = *v++;
    for (int i = 0; i < 3 * PROJECTOR_PAST; i++) pair->lambda[i / 3][i % 3] = *v++;
  }
  PetscCall(ProjectorSearch(p, t, 1, v));
  PetscCall(MortarSetMemory(p, p->u_knot ? v + 3 * p->share.n_nodes : NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactProjectorSetMemory(ContactProjector p, PetscInt n, const PetscReal values[])
{
  PetscInt wrong = n != MemoryLength(p);

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &wrong, 1, MPIU_INT, MPI_MAX, p->share.comm));
  PetscCheck(!wrong, p->share.comm, PETSC_ERR_ARG_SIZ, "memory of the contact forces is of other surfaces or ranks");
  PetscCall(PetscMemcpy(p->sums, &values[1], sizeof(ContactSums) * (size_t)p->n_interfaces));
  if (p->share.solves) PetscCall(PairsSetMemory(p, &values[1 + PER_SUMS * p->n_interfaces]));
  PetscCall(ProjectorActivate(p));
  p->search_next = values[0] != 0 ? PETSC_TRUE : PETSC_FALSE;
  if (p->search_next) PetscCall(ShareSetActive(&p->share, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactProjectorAddChecksum(ContactProjector p, Checksum c)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < p->n_interfaces; i++) {
    const ContactSliding *s = &p->sliding[i];

    PetscCall(ChecksumSetPart(c, "contact %s", p->contact->interfaces[i].name));
    PetscCall(ChecksumAddInts(c, 1, (const PetscInt[]){s->turning}));
    PetscCall(RampAddChecksum(&s->ramp, c));
    PetscCall(RampAddChecksum(&s->friction, c));
  }
  PetscFunctionReturn(0);
}
