/*
   ContactProjector: life cycle, start, and the step as all ranks see it: values of the active nodes go to the root,
   which solves all pairs (project.c), and the forces come back. Whether the next step begins with a search comes with
   them, so that all ranks know it; for that step all nodes are active.

   One rank solves since Gauss-Seidel is sequential, and its order of pairs must not hang on the ranks. The others go on
   meanwhile: a rank without active nodes needs no forces, and begins the next step. All ranks look at what the root
   says in `head` when they ask for the active nodes of the next step, or for sums: errors are raised there, by all.
*/
#include "projectorimpl.h"

/* What the root says with the forces */
enum { HEAD_SEARCH, HEAD_FAILED, HEAD_RESIDUAL, HEAD_SWEEPS, HEAD_X, HEAD_DISTORTED = HEAD_X + 3 };

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
  for (PetscInt i = 0; i < p->n_interfaces; i++) p->sliding[i].ramp.shape = RAMP_SMOOTH;
  PetscCall(ContactProjectorVisit(p, &(QuantityVisitor){QuantitiesReadVisited, &p->contact->comm}));
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
  PetscCheck(!*turns || s->ramp.length == 0, p->share.comm, PETSC_ERR_USER_INPUT,
             "-%s_ramp: inertial forces of a frame whose rotation changes are not offered; leave out the ramp, or "
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

PetscErrorCode ProjectorGatherAll(ContactProjector p, const PetscReal local[], PetscReal root[])
{
  PetscFunctionBeginUser;
  PetscCall(ProjectorFinish(p)); /* the answer of the last step lies where messages go */
  PetscCall(ShareSetActive(&p->share, NULL));
  PetscCall(ShareGather(&p->share, 1, (const PetscReal *const[]){local}, (PetscReal *const[]){root}));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectorActivate(ContactProjector p)
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(p->is_active, (PetscMPIInt)p->share.n_nodes, MPIU_BOOL, p->share.root, p->share.comm));
  PetscCall(ShareSetActive(&p->share, p->is_active));
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
  for (PetscInt i = 0; i < p->share.n_nodes && p->share.rank == p->share.root; i++)
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

/* The step on the root, from the values of the nodes to their forces */
static PetscErrorCode RootProject(ContactProjector p, const ContactStep *step, PetscReal head[SHARE_HEAD])
{
  ProjectorConvergence convergence;

  PetscFunctionBeginUser;
  if (p->share.rank != p->share.root) PetscFunctionReturn(0);
  PetscCall(PairsPrepare(p, step));
  PairsSolve(p, &convergence);
  PairsRecord(p, step, &convergence);
  if (ProjectorTravels(p)) {
    NodesPredict(p, step->dt);
    head[HEAD_SEARCH] = ProjectorNeedsSearch(p, p->nodes.predicted) ? 1 : 0;
  }
  p->noise            = convergence.noise / step->kick;
  head[HEAD_RESIDUAL] = convergence.residual;
  head[HEAD_SWEEPS]   = (PetscReal)convergence.sweeps;
  head[HEAD_FAILED]   = convergence.converged ? 0 : 1;
  for (PetscInt i = 0; i < p->n_interfaces; i++)
    if (p->mortar[i] && p->mortar[i]->moved.n_failed) head[HEAD_DISTORTED] = (PetscReal)(i + 1);
  for (int d = 0; d < 3 && convergence.worst >= 0; d++) head[HEAD_X + d] = p->slave_x[3 * convergence.worst + d];
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

PetscErrorCode ProjectorFinish(ContactProjector p)
{
  const double time = (double)p->last.time;
  PetscReal    head[SHARE_HEAD];

  PetscFunctionBeginUser;
  if (!p->under_way) PetscFunctionReturn(0);
  p->under_way = PETSC_FALSE;
  PetscCall(ShareReturnEnd(&p->share, head));
  PetscCheck(!PetscIsNanReal(head[HEAD_RESIDUAL]), p->share.comm, PETSC_ERR_FP,
             "velocities at the contact surfaces are no numbers at %.6g s", time);
  PetscCheck(head[HEAD_FAILED] == 0, p->share.comm, PETSC_ERR_NOT_CONVERGED,
             "contact forces at %.6g s: residual %.6g, must be %g, after %.0f sweeps, worst at the slave node at %.6g, "
             "%.6g, %.6g m; "
             "raise -projector_max_it %" PetscInt_FMT,
             time, (double)head[HEAD_RESIDUAL], (double)PROJECTOR_RTOL, (double)head[HEAD_SWEEPS], (double)head[HEAD_X],
             (double)head[HEAD_X + 1], (double)head[HEAD_X + 2], p->max_it);
  if (head[HEAD_DISTORTED] > 0)
    PetscCall(ContactMovedCheck(p->share.comm, &p->mortar[(PetscInt)head[HEAD_DISTORTED] - 1]->moved));
  PetscCall(ProjectorAdvance(p, head[HEAD_SEARCH] != 0 ? PETSC_TRUE : PETSC_FALSE));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactProject(ContactProjector p, const ContactStep *step, const PetscReal u[],
                              const PetscReal before[], const PetscReal v[], PetscReal force[])
{
  PetscReal head[SHARE_HEAD] = {0};

  PetscFunctionBeginUser;
  PetscCall(ProjectorFinish(p));
  p->last = *step;
  PetscCall(ShareGather(&p->share, 3, (const PetscReal *const[]){u, before, v},
                        (PetscReal *const[]){p->nodes.u, p->nodes.before, p->nodes.v}));
  PetscCall(RootProject(p, step, head));
  PetscCall(ShareReturnBegin(&p->share, p->nodes.force, head));
  p->under_way = PETSC_TRUE;
  PetscCall(ShareGetForces(&p->share, force));
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
  PetscFunctionBeginUser;
  PetscCall(ProjectorFinish(p));
  PetscCheck(interface >= 0 && interface < p->n_interfaces, p->share.comm, PETSC_ERR_ARG_OUTOFRANGE,
             "interface %" PetscInt_FMT " must lie between 0 and %" PetscInt_FMT, interface, p->n_interfaces - 1);
  *sums = p->sums[interface];
  if (p->share.size > 1) PetscCallMPI(MPI_Bcast(sums, sizeof(*sums), MPI_BYTE, p->share.root, p->share.comm));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactProjectorView(ContactProjector p, PetscViewer viewer)
{
  PetscInt    n[CONTACT_MAX] = {0};
  ContactSums sums           = {.steps = 0};

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < p->n_pairs; k++) n[p->pair[k].interface]++;
  PetscCallMPI(MPI_Bcast(n, CONTACT_MAX, MPIU_INT, p->share.root, p->share.comm));
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
  PetscCallMPI(MPI_Wait(&(*projector)->share.request, MPI_STATUS_IGNORE));
  PetscCall(ProjectorDestroySurfaces(*projector));
  PetscCall(PetscFree(*projector));
  PetscFunctionReturn(0);
}
