/*
   Start of the contact forces at given displacements: bodies that interpenetrate are an error, the forces of a sliding
   state are the warm start of the first step.
*/
#include "projectorimpl.h"
#include "base/gather.h"
#include <stdlib.h>

/* margins within which bodies that interpenetrate are found: a slave deeper than ten mean facets is not seen */
#define START_REACH 10

/* What is wrong at the start: the deepest pair, one that nothing can move along its normal, and one across which the
   given sliding velocity has no part in the surface */
enum { FAULT_DEPTH, FAULT_STIFF, FAULT_NO_SLIP, N_FAULTS };

typedef struct {
  PetscReal size, interface, x[3]; /* depth, m, or 1; 0 for none */
} StartFault;

static void FaultSet(StartFault *fault, PetscReal size, const ProjectorPair *pair, const PetscReal x[3])
{
  *fault = (StartFault){size, (PetscReal)pair->interface, {x[0], x[1], x[2]}};
}

/* Finds the facets of all slaves of this rank */
static void PairsFind(ContactProjector p, StartFault fault[N_FAULTS])
{
  fault[FAULT_NO_SLIP].size = 0;
  for (PetscInt k = 0; k < p->n_pairs; k++) {
    ProjectorPair   *pair = &p->pair[k];
    const PetscReal *x;
    PetscReal        d[3], gap, mean_x[3], mean_u[3];

    pair->facet = -1;
    pair->slip  = -1;
    pair->found = pair->ready = PETSC_FALSE;
    p->state[k]               = (ContactState){.status = CONTACT_OPEN, .gap = PETSC_INFINITY};
    if (!PairPlace(p, k, p->nodes.u, p->nodes.u, PETSC_MAX_REAL)) continue;
    x = PairSlave(pair, p->nodes.x, mean_x);
    FrameDisplacement(&p->frame[pair->interface], x, PairSlave(pair, p->nodes.u, mean_u), d);
    gap = p->state[k].gap = PairGap(p, pair, d, p->nodes.u);
    if (-gap > fault[FAULT_DEPTH].size) FaultSet(&fault[FAULT_DEPTH], -gap, pair, x);
    if (pair->no_slip) FaultSet(&fault[FAULT_NO_SLIP], 1, pair, x);
    if (!(PairMass(pair) > 0)) FaultSet(&fault[FAULT_STIFF], 1, pair, x);
  }
}

/* Search in two steps: far, for bodies that interpenetrate, and near, for the candidates */
static PetscErrorCode StartSearch(ContactProjector p, PetscReal t, StartFault fault[N_FAULTS])
{
  PetscFunctionBeginUser;
  if (!p->share.solves) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < p->n_interfaces; i++)
    SlidingFrame(&p->contact->interfaces[i], &p->sliding[i], t, &p->frame[i]);
  PetscCall(ProjectorSearch(p, t, START_REACH, p->nodes.u));
  PetscCall(ProjectorMortarStart(p, t, p->nodes.u));
  PairsFind(p, fault);
  PetscCall(ProjectorSearch(p, t, 1, p->nodes.u));
  PairsFind(p, fault);
  PetscFunctionReturn(0);
}

/* The worst fault of all ranks of each kind: all raise the same error. */
static PetscErrorCode StartCheck(ContactProjector p, PetscReal slack, StartFault fault[N_FAULTS])
{
  const ContactInterface *c[N_FAULTS];
  const StartFault       *deep = &fault[FAULT_DEPTH], *stiff = &fault[FAULT_STIFF], *still = &fault[FAULT_NO_SLIP];

  PetscFunctionBeginUser;
  for (int k = 0; k < N_FAULTS; k++) {
    PetscCall(ShareWorst(&p->share, sizeof(*fault) / sizeof(PetscReal), &fault[k].size));
    c[k] = &p->contact->interfaces[(PetscInt)fault[k].interface];
  }
  PetscCheck(
    deep->size <= slack, p->share.comm, PETSC_ERR_USER_INPUT,
    "bodies interpenetrate at the start: %.6g m at %.6g, %.6g, %.6g m (contact %s: the node of %s is below %s; at most "
    "%.6g m is allowed)",
    (double)deep->size, (double)deep->x[0], (double)deep->x[1], (double)deep->x[2], c[FAULT_DEPTH]->name,
    c[FAULT_DEPTH]->slave, c[FAULT_DEPTH]->master, (double)slack);
  PetscCheck(
    stiff->size == 0, p->share.comm, PETSC_ERR_USER_INPUT,
    "contact %s: at %.6g, %.6g, %.6g m both %s and %s are held along the normal, so that no force can keep them "
    "apart; free one of them, or take it out of the surface",
    c[FAULT_STIFF]->name, (double)stiff->x[0], (double)stiff->x[1], (double)stiff->x[2], c[FAULT_STIFF]->slave,
    c[FAULT_STIFF]->master);
  PetscCheck(
    still->size == 0, p->share.comm, PETSC_ERR_USER_INPUT,
    "contact %s: the sliding velocity vanishes in the surface at %.6g, %.6g, %.6g m; give -%s_slip x,y,z along "
    "the surface",
    c[FAULT_NO_SLIP]->name, (double)still->x[0], (double)still->x[1], (double)still->x[2], c[FAULT_NO_SLIP]->name);
  PetscFunctionReturn(0);
}

/* A pair of the sliding state, by interface, node and place of its slave */
typedef struct {
  PetscInt     interface, number, place; /* place: ProjectorPair */
  PetscReal    force[3];                 /* on the slave, N */
  PetscReal    area;                     /* m^2 */
  ContactState state;
} Given;

static int GivenCompare(const void *left, const void *right)
{
  const Given *a = (const Given *)left, *b = (const Given *)right;

  if (a->interface != b->interface) return a->interface < b->interface ? -1 : 1;
  if (a->number != b->number) return a->number < b->number ? -1 : 1;
  return (a->place > b->place) - (a->place < b->place);
}

/* Whether friction of any contact asks for the pressure */
static PetscBool StartNeedsPressure(const ContactProjector p)
{
  for (PetscInt i = 0; i < p->n_interfaces; i++)
    if (FrictionNeedsPressure(&p->contact->interfaces[i].friction)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The pairs of all ranks, on all ranks; without forces where there are no states */
static PetscErrorCode GivenGather(ContactProjector p, const ContactState states[], PetscInt *n, Given **all)
{
  const Contact      contact = p->contact;
  const ContactState none    = {.status = CONTACT_OPEN};
  const PetscInt     n_local = states || StartNeedsPressure(p) ? contact->n_pairs : 0;
  Given             *local;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n_local, &local));
  for (PetscInt k = 0; k < n_local; k++) {
    const ContactPair  *pair = &contact->pairs[k];
    const ContactState *s    = states ? &states[k] : &none;

    local[k] = (Given){pair->interface, pair->vertex, .area = pair->area, .state = *s};
    if (p->mortar[pair->interface]) local[k].place = contact->feet[k].place;
    for (int d = 0; d < 3; d++)
      local[k].force[d] = s->lambda_n * pair->n[d] - s->lambda_t[0] * pair->t[d] - s->lambda_t[1] * pair->b[d];
  }
  PetscCall(GatherRecords(p->share.comm, n_local, sizeof(Given), local, n, all));
  if (*n) qsort(*all, (size_t)*n, sizeof(Given), GivenCompare);
  PetscCall(PetscFree(local));
  PetscFunctionReturn(0);
}

/* Raises the error for a slave with a force that faces no facet in time: beyond the border of its master, where pairs
   at rest take the nearest point */
static PetscErrorCode BorderCheck(ContactProjector p, PetscInt lost)
{
  PetscReal x[4] = {-1, 0, 0, 0};

  PetscFunctionBeginUser;
  if (lost >= 0) {
    x[0] = (PetscReal)p->interface[lost];
    for (int d = 0; d < 3; d++) x[1 + d] = p->slave_x[3 * lost + d];
  }
  PetscCall(ShareWorst(&p->share, 4, x));
  if (x[0] >= 0) {
    const ContactInterface *c = &p->contact->interfaces[(PetscInt)x[0]];

    SETERRQ(p->share.comm, PETSC_ERR_USER_INPUT,
            "contact %s: the node of %s at %.6g, %.6g, %.6g m carries a force at the static start, but lies beyond the "
            "border of %s; make %s larger, or -%s_tolerance smaller",
            c->name, c->slave, (double)x[1], (double)x[2], (double)x[3], c->master, c->master, c->name);
  }
  PetscFunctionReturn(0);
}

/* Raises the error for a slave that has no pair at rest, whose area would tell its pressure */
static PetscErrorCode AreaCheck(ContactProjector p, PetscInt strange)
{
  PetscReal x[4] = {-1, 0, 0, 0};

  PetscFunctionBeginUser;
  if (strange >= 0) {
    x[0] = (PetscReal)p->interface[strange];
    for (int d = 0; d < 3; d++) x[1 + d] = p->slave_x[3 * strange + d];
  }
  PetscCall(ShareWorst(&p->share, 4, x));
  for (PetscInt i = 0; i < p->n_interfaces; i++)
    PetscCheck(!p->sliding[i].turning || !FrictionNeedsPressure(&p->contact->interfaces[i].friction), p->share.comm,
               PETSC_ERR_SUP, "contact %s: friction of a table needs pairs that stay; take -%s_kinematics prescribed",
               p->contact->interfaces[i].name, p->contact->interfaces[i].name);
  if (x[0] < 0) PetscFunctionReturn(0);
  SETERRQ(
    p->share.comm, PETSC_ERR_USER_INPUT,
    "contact %s: the node of %s at %.6g, %.6g, %.6g m has no pair at rest, whose area would tell the pressure for "
    "-%s_friction_law table; raise -%s_tolerance",
    p->contact->interfaces[(PetscInt)x[0]].name, p->contact->interfaces[(PetscInt)x[0]].slave, (double)x[1],
    (double)x[2], (double)x[3], p->contact->interfaces[(PetscInt)x[0]].name,
    p->contact->interfaces[(PetscInt)x[0]].name);
}

/* Forces of the slaves that face a facet. They are given on the ground, and kept in the frame of the master */
static PetscErrorCode StartForces(ContactProjector p, const ContactState states[])
{
  Given   *all;
  PetscInt n, lost = -1, strange = -1;

  PetscFunctionBeginUser;
  PetscCall(GivenGather(p, states, &n, &all));
  for (PetscInt k = 0; k < p->n_pairs; k++) {
    const Given    wanted = {.interface = p->interface[k], .number = p->number[k], .place = p->pair[k].place};
    const Given   *given  = n ? (const Given *)bsearch(&wanted, all, (size_t)n, sizeof(Given), GivenCompare) : NULL;
    ProjectorPair *pair   = &p->pair[k];

    for (int i = 0; i < 3 * PROJECTOR_PAST; i++) pair->lambda[i / 3][i % 3] = 0;
    pair->area = given ? given->area : 0;
    if (!given && pair->facet >= 0 && FrictionNeedsPressure(&p->contact->interfaces[pair->interface].friction))
      strange = k;
    if (given && pair->facet < 0 && given->state.lambda_n > 0) lost = k;
    if (!given || pair->facet < 0 || !states) continue;
    for (int d = 0; d < 3; d++) {
      const PetscReal *D = p->frame[pair->interface].D[d];

      for (int i = 0; i < PROJECTOR_PAST; i++)
        pair->lambda[i][d] = given->force[d] + D[0] * given->force[0] + D[1] * given->force[1] + D[2] * given->force[2];
    }
    p->state[k].status   = given->state.status;
    p->state[k].lambda_n = given->state.lambda_n;
    for (int i = 0; i < 2; i++) p->state[k].lambda_t[i] = given->state.lambda_t[i];
  }
  PetscCall(PetscFree(all));
  PetscCall(BorderCheck(p, lost));
  PetscCall(AreaCheck(p, strange));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactProjectorStart(ContactProjector p, PetscReal t, const PetscReal u[], PetscReal slack,
                                     const ContactState states[])
{
  StartFault fault[N_FAULTS] = {{0}};

  PetscFunctionBeginUser;
  PetscCheck(p->has_mass, p->share.comm, PETSC_ERR_ARG_WRONGSTATE,
             "ContactProjectorSetMass() must be called before ContactProjectorStart()");
  PetscCall(ProjectorGatherAll(p, u, p->nodes.u));
  PetscCall(StartSearch(p, t, fault));
  for (PetscInt i = 0; i < p->n_interfaces; i++)
    if (p->mortar[i]) PetscCall(ContactMovedCheck(p->share.comm, &p->mortar[i]->moved));
  PetscCall(StartCheck(p, slack, fault));
  PetscCall(StartForces(p, states));
  PetscCall(ProjectorActivate(p));
  PetscCall(PetscArrayzero(p->sums, p->n_interfaces));
  p->search_next = PETSC_FALSE;
  p->order       = 0;
  p->rate        = 1;
  PetscFunctionReturn(0);
}
