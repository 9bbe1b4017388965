/*
   Private to the projector: what its files share.

   Nodes of all contact surfaces are numbered from 0 by their global node number; every rank knows which of them its
   local nodes are. Few pairs are solved by one rank, the root, which owns most slave nodes; many by all ranks, each
   those of its slaves (surface.c). What a rank needs for its pairs it has of all nodes, but values of active ones
   alone.
   Values of nodes are Cartesian, masters that turn in their own frame (Frame), with which all of a pair is described.
*/
#pragma once

#include <squeal/projector.h>
#include "contact/contactimpl.h"
#include "kernels/contact/cone.h"
#include "quantity/ramp.h"
#include <petscsf.h>

/* Sliding of the master of one interface */
typedef struct {
  PetscBool turning;  /* the master moves; else the velocity is added to the slip */
  PetscBool rotates;  /* by the angular velocity of the interface; else along its slip */
  PetscBool slides;   /* the options say a direction */
  PetscReal axis[3];  /* unit vector of the rotation, or of the slip; 0 where nothing slides */
  PetscReal speed;    /* of the master about it, rad/s, or of the slave along it, m/s */
  Ramp      ramp;     /* of the speed */
  Ramp      friction; /* of the coefficient */
  /* files of a temperature over time, and of the factor of the coefficient over temperature; "" for none */
  char temperature[PETSC_MAX_PATH_LEN], factors[PETSC_MAX_PATH_LEN];
} ContactSliding;

/* Whether the coefficient is the same at all times */
static inline PetscBool SlidingFrictionStays(const ContactSliding *s)
{
  return s->friction.length == 0 && s->friction.delay == 0 && !RampVaries(&s->friction) ? PETSC_TRUE : PETSC_FALSE;
}

/* quantities.c - options of the projector; whether a master moves */
extern const QuantityTable projector_quantities, sliding_quantities;

/* Place of a master that moves: a point x of the ground is at x + d(x) in its frame, d(x) = D (x - centre) - shift, D =
   R' - I. D and shift are exactly 0 at rest, and D e = 0 for the axis e, so that no rounding enters a gap along it. */
typedef struct {
  PetscReal D[3][3], centre[3], shift[3];
} ContactFrame;

/* Master surface of one interface, on the ranks that have pairs */
typedef struct {
  const ContactSurface *surface;
  PetscInt             *node;          /* [n_nodes] numbers of its nodes */
  ContactBox           *box;           /* at the last search */
  PetscBool            *live;          /* the nodes of the facet are active */
  PetscInt              n_seen, *seen; /* nodes of it that are active */
} ProjectorMaster;

/* Mortar pairs of one interface in time, on the root: those of two moments, knots, and between them */
typedef struct {
  ContactMoved      moved; /* on all ranks its surfaces at rest */
  ContactMovedPairs knot[2];
  PetscBool         has[2];
  PetscReal        *x; /* [places and nodes of the master][3] displacements at a knot, m */
  PetscInt          room, *node;
  PetscReal        *weight, *part[2]; /* of the nodes of a pair, slave's first, as they are and at the knots */
  PetscInt         *first;            /* [places][2] where sides of slave and master begin; [places] the end */
} ProjectorMortar;

/* natural map residual, relative to the largest impulse of the step before and of this one; and where pairs are
   so many that all ranks may solve them: sweeps then go in another order on other ranks */
#define PROJECTOR_RTOL      1e-10
#define PROJECTOR_RTOL_FINE 1e-13

typedef enum { PROJECTOR_AUTO, PROJECTOR_ONE, PROJECTOR_ALL } ProjectorRanks;

#define PROJECTOR_PAST 3 /* steps of which forces are kept, for the guess of the next */

/* A slave node and the point of the master that it faces, or means of both sides */
typedef struct {
  PetscInt      interface, slave;
  PetscInt      place;      /* of mortar: in the split surface of the slave (contact/mortar/split.c), else 0 */
  PetscInt      facet;      /* of the interface's surface, -1 where it faces none */
  PetscReal     natural[2]; /* on the facet */
  PetscReal     lambda[PROJECTOR_PAST][3]; /* forces on the slave in the frame of the master, N; [0] of the last step */
  PetscReal     e[3][3], turned[3][3];     /* n, t, b in the frame of the master, and on the ground */
  PetscReal     gap;                       /* of the undeformed bodies, where the facet will not change any more, m */
  PetscBool     found, ready; /* the facet will not change any more; directions and compliance are those of the facet */
  PetscReal     W[3][3], w;   /* 1/kg; w = 0 where W is no multiple of the identity or n > 4, else that */
  PetscReal     offset[3];    /* added to the velocities of the nodes: gap at t_n / dt, and the sliding velocity, m/s */
  PetscReal     drift[3];     /* sliding velocity along n, t, b, m/s */
  PetscReal     speed;        /* stated sliding speed, 0 where nothing slides as told, m/s */
  PetscBool     no_slip;      /* friction needs the sliding velocity, which has no part in the surface here */
  PetscReal     mu, slip;     /* slip speed of v_{n-1/2}, m/s, -1 where it is not known: for mu */
  PetscReal     slip_before;  /* that of v_{n-3/2}, as far as it is known */
  PetscReal     area;         /* of the pair at rest, m^2, which tells the pressure; 0 where nobody asks */
  PetscReal     p[3], q[3];   /* impulse on the slave, N s; relative velocity with the offset, m/s */
  ContactStatus status;
  /* nodes of the facet, or of the mean of the master, four at least: those of a triangle have a fourth of weight 0 */
  int        n;
  PetscInt  *node;
  PetscReal *weight;
  /* of the mean of the slave, 1 for the node itself alone */
  int              n_own;
  const PetscInt  *own;
  const PetscReal *own_weight;
} ProjectorPair;

/* What Gauss-Seidel needs of a pair without coupling of its directions and with four nodes, close together; Cartesian,
   in the frame of the master */
typedef struct {
  int              node[5]; /* of the facet, slave */
  ContactStatus    status;
  PetscReal        weight[4], push[5]; /* of the facet's nodes; velocity of each node per impulse, 1/kg */
  PetscReal        n[3], offset[3], p[3];
  PetscReal        mass, mu; /* 1/w; 0 where the general way is needed */
  const PetscReal *D;        /* of the frame, [3][3]; NULL where it stands still */
} ProjectorRow;

/* Sums over pairs of one step that are vectors: directions of slip, and friction on the master, on the ground, N */
typedef struct {
  PetscReal along[3], friction[3];
} ContactSlips;

#define SHARE_FIELDS 3                                    /* sent at once, at most */
#define SHARE_HEAD   (5 + CONTACT_N_STATUS * CONTACT_MAX) /* numbers of which all ranks get the sums, at most */

/* Who has which node, and the exchange between owners and the ranks that have pairs */
typedef struct {
  MPI_Comm     comm;
  MPI_Datatype record[SHARE_FIELDS]; /* of a node: 1 to SHARE_FIELDS fields of three values */
  PetscMPIInt  rank, size, root;
  PetscBool    solves;              /* this rank has pairs, or is the root */
  PetscInt     n_nodes;             /* of all ranks */
  PetscInt     n, *vertex;          /* of this rank: local nodes from 0, ascending */
  PetscInt     n_active, *active;   /* of these n, those that any rank needs; it is one of */
  PetscInt    *list[2];             /* of which the other is that of the step before */
  PetscInt    *first, *holder;      /* [size + 1] and all ranks' numbers one after the other; ~ number of a copy */
  PetscSFNode *owner;               /* [n_nodes] */
  PetscInt     n_need, *need;       /* nodes that this rank's pairs need, the first n_own */
  PetscInt     n_own, *own;         /* of its own ones, local */
  PetscInt     n_sent, *sent;       /* local nodes whose values others need */
  PetscInt    *copied;              /* local copies that are active */
  PetscSFNode *from, *copy_from;    /* of what is needed and not owned; of the copies */
  PetscSF      values, copies;      /* from local nodes to those needed; and to the copies */
  PetscReal   *buffer[2];           /* of local nodes, and of those needed */
  PetscBool   *any;                 /* [n_nodes] active */
  PetscReal    head[2][SHARE_HEAD]; /* of this rank; sums of all */
  MPI_Request  request;             /* of these */
} ProjectorShare;

/* Another rank whose pairs may move nodes that this rank's pairs may move too: these, and their velocities as sent */
typedef struct {
  PetscMPIInt rank;
  PetscInt    n, *node;
  PetscReal  *out, *in;
  MPI_Request request; /* of what was sent last */
} ProjectorNeighbour;

#define BORDER_WEIGHT 1e-13 /* of a node in a pair: a smaller one is rounding, and joins no pairs */

/* Neighbours of this rank, in the order in which they sweep (border.c) */
typedef struct {
  PetscInt            n, n_before; /* before this rank */
  ProjectorNeighbour *neighbour;
  PetscBool          *shared; /* [n_nodes] */
  MPI_Comm            comm;   /* of all ranks that hang together; where there are neighbours */
} ProjectorBorder;

#define PROJECTOR_DEEPEST 1e-3 /* sizes of a facet: a slave deeper below is not taken up */

/* Step at hand, on the ranks that have pairs; [n_nodes][3] each */
typedef struct {
  PetscReal *x, *minv, *u, *before, *v, *force;
  PetscReal *predicted; /* displacement at t_{n+1} without contact, m */
  PetscReal *rest;      /* displacement 0 */
  PetscBool *even;      /* minv is equal in all directions */
} ProjectorNodes;

/* How Gauss-Seidel ended */
typedef struct {
  PetscInt  sweeps, checks, worst; /* pair of the largest residual */
  PetscReal residual;              /* natural map, relative to the largest impulse now or before, or rounding */
  PetscReal own;                   /* that of this rank's pairs alone */
  PetscReal change;                /* of the impulses in the last sweep, squared, N^2 s^2 */
  PetscReal noise;                 /* rounding of the impulses that stop and drag the nodes, N s */
  PetscBool converged;
} ProjectorConvergence;

struct _p_ContactProjector {
  Contact        contact;
  PetscInt       n_interfaces;
  PetscInt       max_it;
  ProjectorRanks ranks;  /* that solve */
  PetscBool      spread; /* all do */
  PetscBool      fine;   /* to rounding, whoever does */
  ContactSliding sliding[CONTACT_MAX];
  ProjectorShare share;
  PetscBool      has_mass;
  /* on the ranks that have pairs, of theirs */
  ProjectorBorder  border;
  ProjectorNodes   nodes;
  ProjectorMaster  master[CONTACT_MAX];
  ContactFrame     frame[CONTACT_MAX], frame_old[CONTACT_MAX]; /* at t_{n+1} and t_n */
  PetscInt         n_pairs;
  ProjectorPair   *pair;
  ProjectorRow    *row;                 /* [n_pairs] */
  PetscInt        *node;                /* [n_pairs][CONTACT_MAX_MASTER] of the facets that slaves face, and */
  PetscReal       *weight;              /* of these */
  ProjectorMortar *mortar[CONTACT_MAX]; /* NULL: slave nodes and points of the master */
  PetscReal        knot[2], between;    /* times of the mortar knots, s; how far t_{n+1} is from one to the other */
  PetscReal       *u_knot;              /* [2][n_nodes][3] displacements there, m; NULL where all pairs stay */
  PetscInt        *first_candidate;
  ContactFacetList candidates; /* facets near each slave */
  PetscReal       *place; /* [n_pairs][3] displacement of the slave in the frame of the master at the last search, m */
  PetscReal       *u_search;  /* [n_nodes][3] displacements at the last search, m */
  PetscInt         order;     /* of the polynomial in time that guesses the next forces */
  PetscReal        rate;      /* by which a sweep's change (squared) was less than the one before, last time */
  PetscReal        t_search;  /* and its time, s */
  PetscBool       *is_active; /* [n_nodes] */
  PetscReal        margin[CONTACT_MAX]; /* candidates lie within, m */
  PetscBool       *visited;             /* [n_pairs] by Gauss-Seidel */
  PetscBool       *at_border;           /* [n_pairs] at a shared node */
  PetscInt        *visit;               /* those visited, in order */
  ContactState    *state;
  PetscInt        *interface, *number; /* [n_pairs] of the slaves, and */
  PetscReal       *slave_x;            /* [n_pairs][3] their places */
  ContactSums      sums[CONTACT_MAX];  /* of this rank's pairs; their numbers and those of steps of all ranks */
  ContactSlips     slips[CONTACT_MAX]; /* of the last step */
  PetscReal        worst[4];           /* residual of the last step, and the place of its slave */
  PetscReal        beyond[3];          /* interface, speed, m/s, pressure, Pa, beyond a table of friction; -1: none */
  /* on all ranks */
  PetscReal   sweeps_before; /* the step made */
  ContactStep last;          /* that */
  PetscBool   under_way;     /* its head has not been looked at */
  PetscBool   search_next;   /* all nodes are active, and the next step begins with a search */
};

/* sliding.c - the friction coefficient of a pair at t */
PETSC_INTERN void PairSetFriction(ContactProjector projector, PetscReal t, ProjectorPair *pair);

/* sliding.c - options of the sliding of interface i, after its own ones */
PETSC_INTERN PetscErrorCode SlidingSetUp(MPI_Comm comm, const ContactInterface *c, ContactSliding *sliding);
PETSC_INTERN PetscErrorCode SlidingVisit(const ContactInterface *c, ContactSliding *sliding,
                                         const QuantityVisitor *visitor);
/* sliding.c - raises the error for a sliding that is not fully said */
PETSC_INTERN PetscErrorCode SlidingCheck(MPI_Comm comm, const ContactInterface *c, const ContactSliding *sliding);
PETSC_INTERN PetscErrorCode SlidingView(const ContactInterface *c, const ContactSliding *sliding, PetscViewer viewer);
/* sliding.c - frame of the master at time t */
PETSC_INTERN void SlidingFrame(const ContactInterface *c, const ContactSliding *sliding, PetscReal t,
                               ContactFrame *frame);
/* whether places on the master never change: sliding is prescribed, and the meshes stay */
static inline PetscBool SlidingStays(const ContactSliding *sliding)
{
  return sliding->slides && !sliding->turning ? PETSC_TRUE : PETSC_FALSE;
}
/* displacement of a slave in the frame of the master: d(x) + R' u */
static inline void FrameDisplacement(const ContactFrame *f, const PetscReal x[3], const PetscReal u[3], PetscReal d[3])
{
  const PetscReal y[3] = {x[0] + u[0] - f->centre[0], x[1] + u[1] - f->centre[1], x[2] + u[2] - f->centre[2]};

  for (int i = 0; i < 3; i++) d[i] = u[i] + f->D[i][0] * y[0] + f->D[i][1] * y[1] + f->D[i][2] * y[2] - f->shift[i];
}

/* Of values at the nodes that of a pair's slave, or the mean, which is put into mean[] */
static inline const PetscReal *PairSlave(const ProjectorPair *pair, const PetscReal x[], PetscReal mean[3])
{
  if (pair->n_own == 1) return &x[3 * pair->slave];
  for (int d = 0; d < 3; d++) {
    mean[d] = 0;
    for (int k = 0; k < pair->n_own; k++) mean[d] += pair->own_weight[k] * x[3 * pair->own[k] + d];
  }
  return mean;
}

/* Whether this rank has the mortar pairs of interface i */
static inline PetscBool MortarIsHere(const ContactProjector p, PetscInt i)
{
  return p->mortar[i] && p->mortar[i]->x ? PETSC_TRUE : PETSC_FALSE;
}

/* Largest residual of the natural map, relative to the largest impulse */
static inline PetscReal ProjectorTolerance(const ContactProjector p)
{
  return p->fine ? PROJECTOR_RTOL_FINE : PROJECTOR_RTOL;
}

/* Number of the node at place i of holder[] */
static inline PetscInt ShareNode(const ProjectorShare *share, PetscInt i)
{
  return PetscMax(share->holder[i], ~share->holder[i]);
}

/* surface.c - surfaces of all interfaces, the nodes and who has them; pairs without partner */
PETSC_INTERN PetscErrorCode ProjectorSetUpSurfaces(ContactProjector projector);
PETSC_INTERN PetscErrorCode ProjectorDestroySurfaces(ContactProjector projector);

/* projector.c - how the step under way ended: raises its errors, and lists the active nodes of the next
   one. Collective. */
PETSC_INTERN PetscErrorCode ProjectorFinish(ContactProjector projector);

/* share.c - the exchange between owners of nodes and ranks that have pairs; before it is used, the number of all nodes;
   needed [n_nodes] are those that this rank's pairs need, NULL on all ranks for all. Collective. */
PETSC_INTERN PetscErrorCode ShareSetUp(MPI_Comm comm, PetscInt n, const PetscInt number[], ProjectorShare *share);
PETSC_INTERN PetscErrorCode ShareSetNodes(ProjectorShare *share, PetscInt n_nodes);
PETSC_INTERN PetscErrorCode ShareSetActive(ProjectorShare *share, const PetscBool needed[]);
/* share.c - n <= SHARE_FIELDS fields of three values per local node to the ranks that need them */
PETSC_INTERN PetscErrorCode ShareGather(ProjectorShare *share, PetscInt n, const PetscReal *const local[],
                                        PetscReal *const all[]);
/* share.c - forces [n_nodes][3] of this rank's pairs; those of all pairs at the active local nodes. A rank without such
   nodes does not wait */
PETSC_INTERN PetscErrorCode ShareReturn(ProjectorShare *share, const PetscReal all[], PetscReal local[]);
/* share.c - n numbers set out to all ranks; their sums, the same on all: what is decided by them is decided alike */
PETSC_INTERN PetscErrorCode ShareHeadBegin(ProjectorShare *share, PetscInt n, const PetscReal head[]);
PETSC_INTERN PetscErrorCode ShareHeadEnd(ProjectorShare *share, const PetscReal **head);
/* share.c - of the records of all ranks that whose first number is the largest. Collective. */
PETSC_INTERN PetscErrorCode ShareWorst(const ProjectorShare *share, PetscInt n, PetscReal record[]);
PETSC_INTERN PetscErrorCode ShareDestroy(ProjectorShare *share);

/* border.c - after a search: neighbours of this rank and the nodes shared with them; touched [n_nodes] its pairs may
   move. Collective. */
PETSC_INTERN PetscErrorCode BorderFind(ContactProjector projector, const PetscBool touched[]);
PETSC_INTERN PetscErrorCode BorderDestroy(ProjectorBorder *border);
/* border.c - of a sweep, in this order: takes what neighbours before this rank have changed; sends what it has; takes
   what those after it have. The largest values of all ranks that hang together, infinity for what is no number. */
PETSC_INTERN PetscErrorCode BorderBegin(ContactProjector projector);
PETSC_INTERN PetscErrorCode BorderSend(ContactProjector projector);
PETSC_INTERN PetscErrorCode BorderEnd(ContactProjector projector);
PETSC_INTERN PetscErrorCode BorderLargest(const ContactProjector projector, PetscInt n, PetscReal values[]);

/* candidates.c - candidates of all slaves within `reach` margins, at displacements u of all nodes and the present
   frames, of time t */
PETSC_INTERN PetscErrorCode ProjectorSearch(ContactProjector projector, PetscReal t, PetscReal reach,
                                            const PetscReal u[]);
/* candidates.c - whether a slave has gone so far since the search that its candidates may soon not do any more */
PETSC_INTERN PetscBool ProjectorNeedsSearch(ContactProjector projector, const PetscReal u[]);

/* prepare.c - everything of the pairs at the beginning of a step: facets, frames, compliances, gaps, friction
   coefficients, and the impulses of the step before */
PETSC_INTERN PetscErrorCode PairsPrepare(ContactProjector projector, const ContactStep *step);
/* project.c - impulses, and velocities of the nodes with them */
PETSC_INTERN PetscErrorCode PairsSolve(ContactProjector projector, ProjectorConvergence *convergence);
/* prepare.c - facet, frame and compliance of one pair at the predicted displacements; false where the slave faces no
   facet. One that has faced none is taken up where it is at displacements u not deeper below the master than `deepest`
   sizes of the facet. */
PETSC_INTERN PetscBool PairPlace(ContactProjector projector, PetscInt pair, const PetscReal u[],
                                 const PetscReal predicted[], PetscReal deepest);
/* prepare.c - n . (x_s - x_m), the slave at displacement d in the frame of the master and the nodes at u, m */
PETSC_INTERN PetscReal PairGap(ContactProjector projector, const ProjectorPair *pair, const PetscReal d[3],
                               const PetscReal u[]);
/* project.c - inverse of a compliance for the natural map, kg; 0 where nothing moves along n */
PETSC_INTERN PetscReal PairMass(const ProjectorPair *pair);
/* mortar.c - surfaces of the interfaces whose pairs are means; their nodes, among the n of unique[]. Collective. */
PETSC_INTERN PetscErrorCode ProjectorMortarCreate(ContactProjector projector);
PETSC_INTERN PetscErrorCode ProjectorMortarNumber(ContactProjector projector, PetscInt n, const PetscInt unique[]);
PETSC_INTERN PetscErrorCode ProjectorMortarDestroy(ContactProjector projector);
/* mortar.c - the knot at the start, time t, the nodes at u; before a step, another one where it is due; on the root */
PETSC_INTERN PetscErrorCode ProjectorMortarStart(ContactProjector projector, PetscReal t, const PetscReal u[]);
PETSC_INTERN PetscErrorCode ProjectorMortarStep(ContactProjector projector, const ContactStep *step);
/* mortar.c - whether the sides of an interface change in time */
PETSC_INTERN PetscBool MortarTravels(const ContactProjector projector, PetscInt interface);
/* mean.c - sides and n of a pair at displacements `where`, facet -1 where it has none */
PETSC_INTERN void MeanFind(ContactProjector projector, PetscInt pair, const PetscReal where[]);
/* mortar.c - marks the facets of the master within `reach` (m) of those of the slave at displacements u */
PETSC_INTERN PetscErrorCode MortarActivate(ContactProjector projector, PetscInt interface, PetscReal reach,
                                           const PetscReal u[]);
/* mortar.c - numbers of the memory, with which knots are made anew */
PETSC_INTERN PetscInt       MortarMemoryLength(const ContactProjector projector);
PETSC_INTERN void           MortarGetMemory(const ContactProjector projector, PetscReal values[]);
PETSC_INTERN PetscErrorCode MortarSetMemory(ContactProjector projector, const PetscReal values[]);
/* prepare.c - predicted displacements of the active nodes, u + dt v */
PETSC_INTERN void NodesPredict(ContactProjector projector, PetscReal dt);
/* project.c - velocity of the slave relative to the master along n, t, b, m/s, of velocities v of the nodes */
PETSC_INTERN void PairVelocity(const ProjectorPair *pair, const PetscReal v[], PetscReal q[3]);

/* record.c - component of friction along the mean direction of slip, or its size where nothing says one, N */
PETSC_INTERN PetscReal FrictionAlong(const ContactSlips *slips);
/* record.c - forces on the nodes, states and sums of a step */
PETSC_INTERN void PairsRecord(ContactProjector projector, const ContactStep *step,
                              const ProjectorConvergence *convergence, PetscReal counted[]);

/* projector.c - one field of all nodes to the ranks that have pairs; all nodes are active after it */
PETSC_INTERN PetscErrorCode ProjectorGatherAll(ContactProjector projector, const PetscReal local[], PetscReal root[]);
/* projector.c - the nodes that the last search has found are active on all ranks; the borders between them */
PETSC_INTERN PetscErrorCode ProjectorActivate(ContactProjector projector);
