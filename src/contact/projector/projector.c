/*
   ContactProjector: life cycle, and the step as all ranks see it: values of the active nodes go to the ranks that have
   pairs, which solve them (project.c), and the forces come back. Whether the next step begins with a search comes with
   them, so that all ranks know it; for that step all nodes are active.

   Few pairs are solved by one rank: Gauss-Seidel is sequential, and messages would cost more. The others go on
   meanwhile: a rank without active nodes needs no forces, and begins the next step. All ranks look at what those that
   solve say in `head` when they ask for the active nodes of the next step, or for sums: errors are raised there, by
   all.
*/
#include "projectorimpl.h"

/* Numbers of which all ranks get the sums with the forces: ranks that need a search, whose forces did not converge, are
   no numbers, whose mortar faces are distorted; then pairs of each status of each interface */
enum { HEAD_SEARCH, HEAD_FAILED, HEAD_NAN, HEAD_DISTORTED, HEAD_BEYOND, HEAD_PAIRS };

PetscErrorCode ContactProjectorCreate(Contact contact, ContactProjector *projector)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, projector));
  (*projector)->contact       = contact;
  (*projector)->share.request = MPI_REQUEST_NULL;
  (*projector)->n_interfaces  = contact->n_interfaces;
  PetscCall(QuantitiesInit(&projector_quantities, *projector));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactProjectorVisit(ContactProjector p, const QuantityVisitor *visitor)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisit(visitor, &projector_quantities, NULL, p, NULL));
  for (PetscInt i = 0; i < p->n_interfaces; i++)
    PetscCall(SlidingVisit(&p->contact->interfaces[i], &p->sliding[i], visitor));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactProjectorSetFromOptions(ContactProjector p)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < p->n_interfaces; i++) p->sliding[i].ramp.shape = p->sliding[i].friction.shape = RAMP_SMOOTH;
  PetscCall(ContactProjectorVisit(p, &(QuantityVisitor){QuantitiesReadVisited, &p->contact->comm}));
  for (PetscInt i = 0; i < p->n_interfaces; i++)
    PetscCall(SlidingSetUp(p->contact->comm, &p->contact->interfaces[i], &p->sliding[i]));
  PetscFunctionReturn(0);
}

/* Raises an error for parameters that make no sense in dynamics */
static PetscErrorCode InterfaceCheckInTime(MPI_Comm comm, const ContactInterface *c)
{
  PetscBool same;

  PetscFunctionBeginUser;
  PetscCall(PetscStrcmp(c->slave, c->master, &same));
  PetscCheck(!same, comm, PETSC_ERR_USER_INPUT, "-%s_surfaces %s,%s: a surface does not slide on itself; give two",
             c->name, c->slave, c->master);
  PetscCall(FrictionCheckNotNegative(comm, c->name, &c->friction));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactProjectorSetUp(ContactProjector p)
{
  const ContactInterface *interface = p->contact->interfaces;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < p->n_interfaces; i++) PetscCall(InterfaceCheckInTime(p->contact->comm, &interface[i]));
  for (PetscInt i = 0; i < p->n_interfaces; i++)
    PetscCall(SlidingCheck(p->contact->comm, &interface[i], &p->sliding[i]));
  PetscCall(ProjectorSetUpSurfaces(p));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactProjectorGetTurning(ContactProjector p, PetscInt i, PetscBool *turns, PetscReal rotation[3])
{
  const ContactSliding *s = &p->sliding[i];

  PetscFunctionBeginUser;
  *turns = s->turning && s->rotates ? PETSC_TRUE : PETSC_FALSE;
  for (int d = 0; d < 3; d++) rotation[d] = *turns ? s->speed * s->axis[d] : 0;
  PetscCheck(!*turns || (s->ramp.length == 0 && !RampVaries(&s->ramp)), p->share.comm, PETSC_ERR_USER_INPUT,
             "-%s_ramp, _frequency and _history: inertial forces of a frame whose rotation changes are not offered; "
             "leave them out, or "
             "-dynamics_coriolis and -dynamics_centrifugal",
             p->contact->interfaces[i].name);
  PetscFunctionReturn(0);
}

PetscErrorCode ContactProjectorGetNodes(ContactProjector p, PetscInt *n, const PetscInt **vertex)
{
  PetscFunctionBeginUser;
  *n      = p->share.n;
  *vertex = p->share.vertex;
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectorGatherAll(ContactProjector p, const PetscReal local[], PetscReal all[])
{
  PetscFunctionBeginUser;
  PetscCall(ProjectorFinish(p)); /* the answer of the last step lies where messages go */
  PetscCall(ShareSetActive(&p->share, NULL));
  PetscCall(ShareGather(&p->share, 1, (const PetscReal *const[]){local}, (PetscReal *const[]){all}));
  PetscFunctionReturn(0);
}

/* Nodes that this rank's pairs may move until the next search: those of a pair whose place is fixed, or of all facets
   that its slaves may come to */
static void NodesTouched(ContactProjector p, PetscBool touched[])
{
  for (PetscInt k = 0; k < p->n_pairs; k++) {
    ProjectorPair *pair = &p->pair[k];

    touched[pair->slave] = PETSC_TRUE;
    if (!SlidingStays(&p->sliding[pair->interface])) continue;
    if (!PairPlace(p, k, p->nodes.rest, p->nodes.rest, PETSC_MAX_REAL)) continue;
    for (int i = 0; i < pair->n; i++)
      if (PetscAbsReal(pair->weight[i]) > BORDER_WEIGHT) touched[pair->node[i]] = PETSC_TRUE;
    for (int i = 0; i < pair->n_own; i++) touched[pair->own[i]] = PETSC_TRUE;
  }
  for (PetscInt i = 0; i < p->n_interfaces && p->share.solves; i++) {
    const ContactSurface *s = p->master[i].surface;

    if (SlidingStays(&p->sliding[i])) continue;
    for (PetscInt f = 0; f < s->n_facets; f++)
      for (int j = 0; j < s->facet[f].n && p->master[i].live[f]; j++)
        touched[p->master[i].node[s->facet[f].node[j]]] = PETSC_TRUE;
  }
}

PetscErrorCode ProjectorActivate(ContactProjector p)
{
  PetscBool *touched;

  PetscFunctionBeginUser;
  PetscCall(ShareSetActive(&p->share, p->is_active));
  if (!p->spread || p->share.size == 1) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(p->share.n_nodes, &touched));
  NodesTouched(p, touched);
  PetscCall(BorderFind(p, touched));
  PetscCall(PetscFree(touched));
  PetscFunctionReturn(0);
}

/* Whether a node has one mass in all directions; differences below 1e-12 of it are rounding of turned components, and
   go. m is 1/mass, 1/kg. */
static PetscBool MassIsEven(PetscReal m[3])
{
  const PetscReal largest = PetscMax(m[0], PetscMax(m[1], m[2])), least = PetscMin(m[0], PetscMin(m[1], m[2]));

  if (largest - least > 1e-12 * largest) return PETSC_FALSE;
  m[1] = m[2] = m[0];
  return PETSC_TRUE;
}

PetscErrorCode ContactProjectorSetMass(ContactProjector p, const PetscReal minv[])
{
  PetscFunctionBeginUser;
  PetscCall(ProjectorGatherAll(p, minv, p->nodes.minv));
  for (PetscInt i = 0; i < p->share.n_nodes && p->share.solves; i++)
    p->nodes.even[i] = MassIsEven(&p->nodes.minv[3 * i]);
  p->has_mass = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Whether any slave may come to another place on its master */
static PetscBool ProjectorTravels(const ContactProjector p)
{
  for (PetscInt i = 0; i < p->n_interfaces; i++)
    if (!SlidingStays(&p->sliding[i])) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The step of this rank's pairs, from the values of the nodes to their forces */
static PetscErrorCode PairsProject(ContactProjector p, const ContactStep *step, PetscReal head[])
{
  ProjectorConvergence convergence;

  PetscFunctionBeginUser;
  if (!p->share.solves) PetscFunctionReturn(0);
  PetscCall(PairsPrepare(p, step));
  head[HEAD_BEYOND] = p->beyond[0] >= 0 ? 1 : 0;
  PetscCall(PairsSolve(p, &convergence));
  PairsRecord(p, step, &convergence, &head[HEAD_PAIRS]);
  if (ProjectorTravels(p)) {
    NodesPredict(p, step->dt);
    head[HEAD_SEARCH] = ProjectorNeedsSearch(p, p->nodes.predicted) ? 1 : 0;
  }
  head[HEAD_FAILED] = convergence.converged ? 0 : 1;
  head[HEAD_NAN]    = PetscIsInfOrNanReal(convergence.residual) ? 1 : 0;
  for (PetscInt i = 0; i < p->n_interfaces; i++)
    if (p->mortar[i] && p->mortar[i]->moved.n_failed) head[HEAD_DISTORTED] = 1;
  if (convergence.converged) PetscFunctionReturn(0);
  p->worst[0] = convergence.own;
  for (int d = 0; d < 3 && convergence.worst >= 0; d++) p->worst[1 + d] = p->slave_x[3 * convergence.worst + d];
  PetscFunctionReturn(0);
}

/* Active nodes of the next step; those of this one stay as they are, for the caller to add the forces */
static PetscErrorCode ProjectorAdvance(ContactProjector p, PetscBool search_next)
{
  const PetscBool searched = p->search_next;

  PetscFunctionBeginUser;
  p->search_next = search_next;
  if (search_next && !searched) PetscCall(ShareSetActive(&p->share, NULL));
  if (searched && !search_next) PetscCall(ProjectorActivate(p));
  PetscFunctionReturn(0);
}

/* Raises the error for a table of friction that ends before the motion. Collective. */
static PetscErrorCode ProjectorCheckTables(ContactProjector p, const PetscReal head[])
{
  PetscReal at[3] = {-1, 0, 0};

  PetscFunctionBeginUser;
  if (head[HEAD_BEYOND] == 0) PetscFunctionReturn(0);
  if (p->share.solves) PetscCall(PetscArraycpy(at, p->beyond, 3));
  PetscCall(ShareWorst(&p->share, 3, at));
  PetscCall(FrictionComplain(p->share.comm, p->contact->interfaces[(PetscInt)at[0]].name,
                             &p->contact->interfaces[(PetscInt)at[0]].friction, p->last.time, at[1], at[2]));
  PetscFunctionReturn(0);
}

/* Raises the error for forces that did not converge, or are no numbers; of the ranks that say so. Collective. */
static PetscErrorCode ProjectorComplain(ContactProjector p, const PetscReal head[])
{
  const double time     = (double)p->last.time;
  PetscReal    sweeps[] = {p->n_interfaces ? p->sums[0].sweeps - p->sweeps_before : 0};

  PetscFunctionBeginUser;
  PetscCheck(head[HEAD_NAN] == 0, p->share.comm, PETSC_ERR_FP,
             "velocities at the contact surfaces are no numbers at %.6g s", time);
  PetscCall(ProjectorCheckTables(p, head));
  if (head[HEAD_FAILED] == 0) PetscFunctionReturn(0);
  PetscCall(ShareWorst(&p->share, 4, p->worst));
  PetscCall(ShareWorst(&p->share, 1, sweeps));
  SETERRQ(p->share.comm, PETSC_ERR_NOT_CONVERGED,
          "contact forces at %.6g s: residual %.6g, must be %g, after %.0f sweeps, worst at the slave node at %.6g, "
          "%.6g, %.6g m; "
          "raise -projector_max_it %" PetscInt_FMT,
          time, (double)p->worst[0], (double)ProjectorTolerance(p), (double)sweeps[0], (double)p->worst[1],
          (double)p->worst[2], (double)p->worst[3], p->max_it);
}

PetscErrorCode ProjectorFinish(ContactProjector p)
{
  const PetscReal *head;

  PetscFunctionBeginUser;
  if (!p->under_way) PetscFunctionReturn(0);
  p->under_way = PETSC_FALSE;
  PetscCall(ShareHeadEnd(&p->share, &head));
  PetscCall(ProjectorComplain(p, head));
  for (PetscInt i = 0; i < p->n_interfaces; i++) {
    if (p->mortar[i] && head[HEAD_DISTORTED] > 0) PetscCall(ContactMovedCheck(p->share.comm, &p->mortar[i]->moved));
    for (int k = 0; k < CONTACT_N_STATUS; k++) p->sums[i].n[k] = head[HEAD_PAIRS + CONTACT_N_STATUS * i + k];
    p->sums[i].steps++;
    ContactSumsCompare(&p->sums[i]);
  }
  PetscCall(ProjectorAdvance(p, head[HEAD_SEARCH] > 0 ? PETSC_TRUE : PETSC_FALSE));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactProject(ContactProjector p, const ContactStep *step, const PetscReal u[],
                              const PetscReal before[], const PetscReal v[], PetscReal force[])
{
  PetscReal head[SHARE_HEAD] = {0};

  PetscFunctionBeginUser;
  PetscCall(ProjectorFinish(p));
  p->last          = *step;
  p->sweeps_before = p->n_interfaces ? p->sums[0].sweeps : 0;
  PetscCall(ShareGather(&p->share, 3, (const PetscReal *const[]){u, before, v},
                        (PetscReal *const[]){p->nodes.u, p->nodes.before, p->nodes.v}));
  PetscCall(PairsProject(p, step, head));
  PetscCall(ShareHeadBegin(&p->share, HEAD_PAIRS + CONTACT_N_STATUS * p->n_interfaces, head));
  p->under_way = PETSC_TRUE;
  PetscCall(ShareReturn(&p->share, p->nodes.force, force));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactProjectorGetActive(ContactProjector p, PetscInt *n, const PetscInt **active)
{
  PetscFunctionBeginUser;
  PetscCall(ProjectorFinish(p));
  *n      = p->share.n_active;
  *active = p->share.active;
  PetscFunctionReturn(0);
}

PetscErrorCode ContactProjectorGetStates(ContactProjector p, PetscInt *n, const ContactState **state,
                                         const PetscInt **interface, const PetscInt **number, const PetscReal **x)
{
  PetscFunctionBeginUser;
  *n = p->n_pairs;
  if (state) *state = p->state;
  if (interface) *interface = p->interface;
  if (number) *number = p->number;
  if (x) *x = p->slave_x;
  PetscFunctionReturn(0);
}

PetscErrorCode ContactProjectorMark(ContactProjector p)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < p->n_interfaces; i++)
    if (p->sums[i].steps > 0) ContactSumsMark(&p->sums[i]);
  PetscFunctionReturn(0);
}

PetscErrorCode ContactProjectorGetSums(ContactProjector p, PetscInt interface, ContactSums *sums)
{
  const ContactSums *s = &p->sums[interface];
  ContactSlips       slips;
  PetscReal          added[13], most[3];

  PetscFunctionBeginUser;
  PetscCall(ProjectorFinish(p));
  PetscCheck(interface >= 0 && interface < p->n_interfaces, p->share.comm, PETSC_ERR_ARG_OUTOFRANGE,
             "interface %" PetscInt_FMT " must lie between 0 and %" PetscInt_FMT, interface, p->n_interfaces - 1);
  *sums = *s;
  slips = p->slips[interface];
  if (p->share.size > 1) {
    const PetscReal parts[13] = {s->normal,         s->contact_work,   s->friction_work, s->heat,        s->force[0],
                                 s->force[1],       s->force[2],       slips.along[0],   slips.along[1], slips.along[2],
                                 slips.friction[0], slips.friction[1], slips.friction[2]};
    const PetscReal mine[3]   = {s->residual, s->sweeps, s->checks};

    PetscCallMPI(MPI_Allreduce(parts, added, 13, MPIU_REAL, MPIU_SUM, p->share.comm));
    PetscCallMPI(MPI_Allreduce(mine, most, 3, MPIU_REAL, MPIU_MAX, p->share.comm));
    sums->normal        = added[0];
    sums->contact_work  = added[1];
    sums->friction_work = added[2];
    sums->heat          = added[3];
    for (int d = 0; d < 3; d++) {
      sums->force[d]    = added[4 + d];
      slips.along[d]    = added[7 + d];
      slips.friction[d] = added[10 + d];
    }
    sums->residual = most[0];
    sums->sweeps   = most[1];
    sums->checks   = most[2];
  }
  sums->friction = FrictionAlong(&slips);
  PetscFunctionReturn(0);
}

PetscErrorCode ContactProjectorView(ContactProjector p, PetscViewer viewer)
{
  PetscInt    n[CONTACT_MAX] = {0}, most = p->n_pairs, joined;
  ContactSums sums = {.steps = 0};

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < p->n_pairs; k++) n[p->pair[k].interface]++;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, n, CONTACT_MAX, MPIU_INT, MPI_SUM, p->share.comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPIU_INT, MPI_MAX, p->share.comm));
  for (PetscInt i = 0; i < p->n_interfaces; i++) {
    const ContactInterface *c = &p->contact->interfaces[i];

    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "contact %s: %" PetscInt_FMT " nodes of %s on %" PetscInt_FMT " facets of %s, ",
                                     c->name, n[i], c->slave, p->master[i].surface->n_facets, c->master));
    PetscCall(FrictionView(&c->friction, viewer));
    PetscCall(PetscViewerASCIIPrintf(viewer, ", multipliers%s%s\n", p->mortar[i] ? " of mortar pairs" : "",
                                     c->discretization != CONTACT_AUTO ? ""
                                     : p->mortar[i]                    ? ", since meshes do not match"
                                                                       : ", node to node, since meshes match"));
    PetscCall(SlidingView(c, &p->sliding[i], viewer));
  }
  PetscCallMPI(MPI_Allreduce(&p->border.n, &joined, 1, MPIU_INT, MPI_MAX, p->share.comm));
  if (p->spread && p->share.size > 1)
    PetscCall(
      PetscViewerASCIIPrintf(viewer, "  each rank solves its pairs, %" PetscInt_FMT " at most, %s\n", most,
                             joined ? "in turn where they move the same nodes" : "which move nodes of their own"));
  if (p->n_interfaces) PetscCall(ContactProjectorGetSums(p, 0, &sums));
  if (sums.steps > 0)
    PetscCall(PetscViewerASCIIPrintf(viewer, "  %.4g sweeps and %.4g looks at all pairs per step\n",
                                     (double)(sums.sweeps / sums.steps), (double)(sums.checks / sums.steps)));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactProjectorDestroy(ContactProjector *projector)
{
  PetscFunctionBeginUser;
  if (!*projector) PetscFunctionReturn(0);
  PetscCall(BorderDestroy(&(*projector)->border));
  PetscCall(ProjectorDestroySurfaces(*projector));
  for (PetscInt i = 0; i < CONTACT_MAX; i++) {
    PetscCall(RampDestroy(&(*projector)->sliding[i].ramp));
    PetscCall(RampDestroy(&(*projector)->sliding[i].friction));
  }
  PetscCall(PetscFree(*projector));
  PetscFunctionReturn(0);
}
