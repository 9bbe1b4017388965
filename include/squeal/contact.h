/*
   Contact - frictional interfaces in steady sliding, linearised: pairs of facing nodes with gap and slip operators.

   Pair p belongs to a slave node. It joins a mean of the slave, u_s = sum_k v_k u_k, and one of the master,
   u_m = sum_i w_i u_i, of any number of nodes each, both with weights of sum 1. Every node of a slave face is a slave,
   those between its corners too. n is the master's outward normal, t the direction of the slave's sliding velocity
   relative to the master, b = n x t. For displacements u (m)
      (N u)_p = n . (u_m - u_s)     closing of the gap
      (T u)_p = t . (u_m - u_s)     slip
      (B u)_p = b . (u_m - u_s)     transverse slip
   Node to surface: u_s is that of the node, u_m that of the point of the master surface that it faces, of the nodes of
   one master facet with its own shape functions: one node of weight 1 where the meshes match, up to nine where they do
   not. Where meshes match, a uniform pressure passes exactly: nodes of faces of six nodes then
   carry int N_i dA, nothing at corners, where rounding says whether they are closed (where the pressure varies some
   corners open, by gaps that vanish with the size of the mesh), and faces of eight nodes would have
   to pull there, so that these open with the exact law (a warning says so). Where they do not match, the total is
   exact, and the pressure at single nodes off by tens of percent, of second order more than of first.
   Mortar: the sides are means over both surfaces, from integrals over the exact overlap of their facets with functions
   phi_p of the slave nodes (contact/mortar/mortar.c): area = int phi_p dA over the master, w_i = int phi_p N_i dA /
   area. A uniform pressure passes exactly between any meshes of flat surfaces, and the area is exact at borders, holes
   and slots. lambda_n over the area is the pressure at the node, on faces of second order too, of which it is that of
   a linear pressure at corners, and with nine nodes everywhere (kernels/contact/segment.h). A side between two faces
   of eight nodes has the mean of those at one point within each, with which fields of pressure are linear there too
   (contact/mortar/edges.c).
   Penalty (seed paper, eq. 1): internal forces k_n N'N u - mu k_n T'N u, that is along n on the master k_n (N u),
   along t on the master -mu k_n (N u), and the opposite on the slave: friction drags the master along t.
   where the pressure is no multiple of the closing, p = P(c) (pressurelaw.h), k_n is that of small motions about the
   pressure p of each pair of area A, k_n = A P'(c), P(c) = p.
   Constraint: N u = 0 with force directions N' - mu T'.
   Friction, in every analysis: mu(s), s the length of the slip velocity (m/s), by the law of the interface
   (frictionlaw.h), with the stated sliding speed of the pair, 0 m/s where nothing slides as told; linearised about that
   speed it is mu + mu' (s - speed).
*/
#pragma once

#include <squeal/contactstatus.h>
#include <squeal/frictionlaw.h>
#include <squeal/model.h>
#include <squeal/pressurelaw.h>
#include <squeal/results.h>

typedef struct _p_Contact *Contact;

typedef enum { CONTACT_PENALTY, CONTACT_CONSTRAINT } ContactLaw;

/* Node to surface, integrals over surfaces, or the first where meshes match and the second where not */
typedef enum { CONTACT_NODE, CONTACT_MORTAR, CONTACT_AUTO } ContactDiscretization;

extern const char *const ContactStatusNames[CONTACT_N_STATUS]; /* "open", "stick", "slip" */

#define CONTACT_MAX_MASTER 9 /* nodes of a facet, at most */

/* A node of one side of a pair */
typedef struct {
  PetscInt  number;     /* global */
  PetscInt  unknown[3]; /* global unknowns x, y, z; -1 when fixed by a support */
  PetscReal weight;     /* sum 1 over a side */
} ContactPairNode;

/* One pair; the array of pairs is distributed, each pair lives on the rank that owns its slave node */
typedef struct {
  PetscInt               interface;         /* index of the interface */
  PetscInt               vertex;            /* global number of the slave node that it belongs to */
  PetscInt               n_slave, n_master; /* nodes of its sides */
  const ContactPairNode *slave, *master;    /* borrowed, on the pair's rank alone; slave[0] is that of vertex */
  /* u_s = (1 - sum_k g_k) u~ + sum_k g_k u~_k: u~ a mean of nodes, own[0] that of vertex, u~_k those that belong to
     nodes k without pairs at the border of the master, of which `taken` has the weights g_k (ContactMean) */
  PetscInt               n_own, n_taken;
  const ContactPairNode *own, *taken;
  PetscReal              x[3];             /* position of the slave, m */
  PetscReal              n[3], t[3], b[3]; /* unit vectors */
  PetscReal              area;             /* positive share of the slave node in its surface, m^2 */
  PetscReal              gap;              /* n . (x_s - x_m) of the mesh, or -contact_gap, m, positive open */
  PetscReal              force; /* normal force carried in the sliding state, N, compressive >= 0; 0 when not given */
  PetscBool              mean;  /* lambda_n over area is the pressure, on faces of second order too */
  /* kappa = sum_k v_k (n_k . n_s - 1), n_s the slave's unit normal at x and n_k those at the nodes of its mean, with
     weights v_k: a distance of one along the normals is 1 + kappa in the mean. 0 on flat faces, and of one node */
  PetscReal bend;
  PetscReal speed; /* stated sliding speed, m/s; 0 where nothing slides as told */
} ContactPair;

/* u~ = sum_i v_i u_i of a node without a pair, that pairs take in; node[0] is that node. It lives on the rank that owns
   the node. u~ of a node that is not listed is its u. */
typedef struct {
  PetscInt               interface, n;
  const ContactPairNode *node; /* borrowed */
} ContactMean;

/* State of one pair. Friction is given as the force on the master; in slip it has the direction of the slave's velocity
   relative to the master, lambda_t = mu lambda_n */
typedef struct {
  ContactStatus status;
  PetscReal     gap;         /* m, positive open; with the penalty law minus its closing when closed */
  PetscReal     slip[2];     /* displacement of the slave relative to the master along t and b, in time in a step, m */
  PetscReal     lambda_n;    /* normal force, N, compressive >= 0 */
  PetscReal     lambda_t[2]; /* friction on the master along t and b, N */
} ContactState;

/* How well states obey the laws of contact and friction; each number is relative, to the largest lambda_n or to the
   largest displacement or gap at any pair. With the penalty law the gap and the closing that
   lambda_n has stands for the gap. */
typedef struct {
  PetscReal penetration;     /* max(0, -gap) */
  PetscReal sign;            /* max(0, -lambda_n) */
  PetscReal complementarity; /* min(lambda_n, gap), both relative */
  PetscReal cone;            /* max(0, |lambda_t| - mu lambda_n) */
  PetscReal dissipation;     /* slip: |lambda_t - mu lambda_n s / |s||, relative; stick: |s| of the last step */
} ContactKKT;

/* A line of -contact_gap */
typedef struct {
  PetscReal x[3], gap; /* place of the slave node, and g0 there, m */
} ContactGapLine;

/* How long and how finely contacts wear, -wear_time and the like */
typedef struct {
  PetscReal time, depth, settled; /* s; m and a part of the largest pressure at which it ends, 0: not so */
  PetscInt  steps;
} ContactWear;

/* Parameters of an interface; SI units */
typedef struct {
  char                 *name, *slave, *master; /* surfaces */
  ContactLaw            law;
  ContactDiscretization discretization;
  /* with the stated speed of the interface: as below, or 0 with a rotation, where pairs differ */
  FrictionLaw friction;
  PressureLaw pressure;     /* with the penalty law; where it is linear kn says how stiff it is */
  char        kn_text[128]; /* -contact_kn as it is given */
  PetscBool   has_kn, has_kt;
  PetscReal   kn;       /* stiffness per pair, N/m, or per area, N/m^3 */
  PetscBool   per_area; /* which of the two: that of a pair is then kn times the area of its slave */
  /* stiffness along the surface of a pair that sticks, N/m, or per area, N/m^3; 0: none is given */
  PetscReal kt;
  PetscBool kt_per_area;  /* which of the two */
  PetscBool identify;     /* kn is to be identified by pressing; until then it is 1 */
  PetscReal interference; /* statics: gaps are less by it, m */
  PetscReal tolerance;    /* largest distance of a pair along the normal, m */
  /* along the surface: slaves farther beyond the master's border have no pair, m; 0: 1 % of a facet */
  PetscReal overhang;
  PetscInt  n_slaves;    /* nodes of the slave, over all ranks */
  PetscInt  n_off;       /* those of them that have no pair, since no master lies under them */
  PetscReal off;         /* the farthest of these from the border, m */
  PetscBool damping;     /* friction damping: mu N0 / v across the slip, mu' N0 along it */
  PetscReal force;       /* total normal force in the sliding state, N */
  PetscReal speed;       /* sliding speed, m/s */
  PetscReal slip[3];     /* direction, or 0,0,0 when it comes from the rotation */
  PetscReal rotation[3]; /* angular velocity of the master relative to the slave, rad/s */
  PetscReal centre[3];   /* a point of its axis, m */
  PetscBool slides;      /* every pair has a slip direction; known after ContactSetUp() */
  /* wear of slave and master, 1/Pa^a, and its exponent a (contact/topography/wear.c) */
  PetscReal       wear_rate, wear_rate_master, wear_exponent;
  char            gap_file[PETSC_MAX_PATH_LEN];
  PetscInt        n_gaps;
  ContactGapLine *gaps; /* [n_gaps] of that file */
} ContactInterface;

/* Whether an interface wears */
static inline PetscBool ContactWears(const ContactInterface *c)
{
  return c->wear_rate > 0 || c->wear_rate_master > 0 ? PETSC_TRUE : PETSC_FALSE;
}

/* A tie: nodes of the slave follow points of the master, their feet, or means over it (ContactLink) */
typedef struct {
  char     *name, *slave, *master; /* a set of nodes; a surface */
  PetscReal distance; /* nodes farther from their foot are too far off, m; 0: 5 % of the size of the facet */
  PetscBool has_distance;
  ContactDiscretization discretization;
  PetscBool             mortar;             /* what that comes to */
  PetscBool             free;               /* these stay free, else they are an error */
  PetscInt              n_slaves;           /* nodes of the slave, over all ranks as those below */
  PetscInt              n, n_common, n_far; /* of these, nodes that follow, are nodes of both, are too far off */
  /* of those that follow, nodes beyond the border of the master by more than 5 % of a facet */
  PetscInt  n_beyond;
  PetscInt  n_off;          /* of mortar: nodes that stay free, since no or little master lies under them */
  PetscReal offset, beyond; /* largest distance of a node from its foot, and of these along the surface, m */
} ContactTie;

/* A node that another follows */
typedef struct {
  PetscInt  number, unknown[3]; /* global; -1 where held */
  PetscReal weight;             /* of a foot: w_i, sum 1 */
  PetscReal follow[9];          /* [3][3] by rows; rows of directions that a support holds of the slave are 0 */
} ContactLinkNode;

/* A node that follows others, u = sum_i follow_i u_i: w_i times the identity where the surfaces touch, and more where a
   gap is kept as a rigid arm. It lives on the rank that owns the node */
typedef struct {
  PetscInt               tie, node, vertex; /* local node; global number */
  PetscInt               slave[3];          /* unknowns x, y, z; -1 where held */
  PetscReal              x[3];              /* m */
  PetscInt               n_master;
  const ContactLinkNode *master; /* borrowed */
} ContactLink;

/*@ ContactCreate - makes the interfaces of a model; call before ModelSetUp(). Collective. @*/
PetscErrorCode ContactCreate(Model model, Contact *contact);

/*@
   ContactSetFromOptions - reads the interfaces and asks the model to keep their surfaces on one rank. Collective.

   Options are the rows of src/contact/quantities.c and of the laws, see frictionlaw.h and pressurelaw.h.
@*/
PetscErrorCode ContactSetFromOptions(Contact contact);

/*@ ContactVisit - shows the rows of its options. Collective. @*/
PetscErrorCode ContactVisit(Contact contact, const QuantityVisitor *visitor);

/*@
   ContactSetUp - pairs facing nodes by position, across ranks. Collective; call after ModelSetUp().

   A slave node beyond the border of the master (over a hole or slot, or beyond the rim) has no pair and carries
   nothing; a warning counts such nodes.

   Errors: PETSC_ERR_USER_INPUT when a slave node over the master is farther from it along the normal than the
   tolerance, or when no slave node lies over the master: names the interface, the position of the node and its
   distance; also when a slip that is given vanishes in the
   surface at some pair, and friction needs it; for a node of a tie that is too far off, or that a support holds in a
   direction in which it does not hold what the node follows.
@*/
PetscErrorCode ContactSetUp(Contact contact);

/*@ ContactDampFriction - interfaces with friction that slide at a stated speed have friction damping in modes, as
   Coulomb's law in time has by itself: as -contact_friction_damping does, with the parameters of the operators that
   belong to it. Before ContactSetUp(). Not collective. @*/
PetscErrorCode ContactDampFriction(Contact contact);

/*@ ContactSetUpTies - the part of ContactSetUp() that makes the links of the ties, for runs in time, whose pairs are
   not those of the mesh. Collective; after ModelSetUp(). @*/
PetscErrorCode ContactSetUpTies(Contact contact);

/*@ ContactCheckBodies - prints a line for each body that hangs together with no other one and is held by nothing,
   where there are others, with the nodes by which it lies on them; and for nodes that two bodies have in one place
   without sharing them, where no tie, contact or bushing has both. With matrix terms, which may hold anything, none.
   Collective; after ContactSetUp() or ContactSetUpTies(). @*/
PetscErrorCode ContactCheckBodies(Contact contact, PetscBool terms);

/*@ ContactFindRow - the row of an option of interfaces, such as kn; NULL for none. Not collective. @*/
const Quantity *ContactFindRow(const char name[]);

/*@ ContactFindWearRow - the row of -wear_time and the like; NULL for none. Not collective. @*/
const Quantity *ContactFindWearRow(const char name[]);

/*@ ContactGetWear - how long contacts wear before modes (borrowed). Not collective. @*/
PetscErrorCode ContactGetWear(Contact contact, const ContactWear **wear);

/*@ ContactGetInterfaces - parameters (borrowed). Not collective. @*/
PetscErrorCode ContactGetInterfaces(Contact contact, PetscInt *n, const ContactInterface **interfaces);

/*@ ContactGetPairs - pairs of this rank, and their number over all ranks (borrowed). Not collective. @*/
PetscErrorCode ContactGetPairs(Contact contact, PetscInt *n_local, PetscInt *n_global, const ContactPair **pairs);

/*@ ContactGetMeans - means of nodes of this rank without pairs (borrowed). Not collective. @*/
PetscErrorCode ContactGetMeans(Contact contact, PetscInt *n, const ContactMean **means);

/*@
   ContactCreatePairOperators - N, T and B of chosen local pairs as sparse matrices of shape [pairs][unknowns]: row i of
   this rank belongs to pair[i], i < n. Collective. The caller destroys them; pass NULL for what is not needed.
@*/
PetscErrorCode ContactCreatePairOperators(Contact contact, PetscInt n, const PetscInt pair[], Mat *N, Mat *T, Mat *B);

/*@
   ContactCreateRows - sparse rows d . (u_m - u_s), shape [n][unknowns]: row i of this rank belongs to the local pair
   pair[i] and the direction direction[i][3]. Collective. The caller destroys the matrix.
@*/
PetscErrorCode ContactCreateRows(Contact contact, PetscInt n, const PetscInt pair[], const PetscReal direction[][3],
                                 Mat *rows);

/*@
   ContactCreateTilt - turning of the master's normal at the pairs, sparse, shape [all pairs][unknowns], rows of the
   local pairs in their order: (tilt_t u)_p = t . delta n, (tilt_b u)_p = b . delta n with delta n the derivative of the
   pair's normal n, which is the mean of the facets around the master's nodes, weighted by area. On a flat surface
   delta n = - sum_i grad_s N_i (n . u_i). NULL without interfaces. Collective. The caller destroys them.
@*/
PetscErrorCode ContactCreateTilt(Contact contact, Mat *tilt_t, Mat *tilt_b);

/*@
   ContactCreateApproach - d such that d . u is the approach (m) of the second rows of nodes of slave and master of an
   interface, the mean over its pairs of n . (u_m2 - u_s2). The second row is what lies one element below the surface:
   of a node the other end of the mesh edge that leaves the surface most nearly along its normal. Collective. The
   caller destroys it.
@*/
PetscErrorCode ContactCreateApproach(Contact contact, PetscInt interface, Vec *d);

/*@ ContactNodalForces - forces of the contact on all nodes, N, from the states of the local pairs, into a local vector
   of three values per node in the layout of the coordinates; held nodes included. Collective. @*/
PetscErrorCode ContactNodalForces(Contact contact, const ContactState state[], Vec local);

/*@ ContactGetTies - ties, none for NULL (borrowed). Not collective; after ContactSetFromOptions(). @*/
PetscErrorCode ContactGetTies(Contact contact, PetscInt *n, const ContactTie **ties);

/*@ ContactGetLinks - the nodes of this rank that ties make follow others, ordered by tie, none for NULL (borrowed). Not
    collective; after ContactSetUp(). @*/
PetscErrorCode ContactGetLinks(Contact contact, PetscInt *n, const ContactLink **links);

/* A place that is no node of the mesh, and the nodes that it follows on a surface */
typedef struct {
  PetscReal       x[3];     /* m */
  PetscInt        n_master; /* 0 where its arm is too long */
  ContactLinkNode master[CONTACT_MAX_MASTER];
  PetscReal       off; /* length of the arm, m */
} ContactFollower;

/*@ ContactFollow - what n places, the same on all ranks, follow on a surface, as the slaves of ties do; the longest arm
    is distance (m), or 5 % of the size of a facet for 0. Collective. @*/
PetscErrorCode ContactFollow(Contact contact, const char set[], PetscReal distance, PetscInt n,
                             ContactFollower place[]);

/*@ ContactPassForces - of forces on all nodes, N, as in ContactNodalForces(), complete at every copy, moves those on
   nodes that follow others to these, f_i += follow_i' f, but in directions that a support holds. Collective. @*/
PetscErrorCode ContactPassForces(Contact contact, Vec local);

/*@
   ContactGrow - moves the front between closed and open pairs by whole rows. Two pairs are neighbours when their slave
   nodes are corners of one facet of the slave surface. Collective.

   Input Parameters:
+  rows   - how many: > 0 closes the open neighbours of closed pairs, < 0 opens the closed neighbours of open pairs
-  closed - of the local pairs, changed in place
@*/
PetscErrorCode ContactGrow(Contact contact, PetscInt rows, PetscBool closed[]);

/*@ ContactPairStiffness - the stiffness of a pair, N/m, that carries lambda_n (N), by a law of its interface, whose k
   is per pair or per area as ContactInterface has it. Not collective. @*/
PetscReal ContactPairStiffness(const ContactInterface *interface, const ContactPair *pair, const PressureLaw *law,
                               PetscReal lambda_n);

/*@ ContactPairSpring - the law of that pair as a force over the closing. Not collective. @*/
PairSpring ContactPairSpring(const ContactInterface *interface, const ContactPair *pair, const PressureLaw *law);

/*@ ContactPairClosing - the closing of that pair, m: 0 for exact contact, the law's onset where it carries nothing. Not
    collective. @*/
PetscReal ContactPairClosing(const ContactInterface *interface, const ContactPair *pair, const PressureLaw *law,
                             PetscReal lambda_n);

/*@ ContactComputeKKT - residuals of the states of the local pairs, with mu of each and the law of each interface;
   displacement is the largest of the local pairs, m. Collective. @*/
PetscErrorCode ContactComputeKKT(Contact contact, const ContactState state[], const PetscReal mu[],
                                 const PressureLaw law[], PetscReal displacement, ContactKKT *kkt);

/*@ ContactViewKKT - the residuals in one line each. Collective. @*/
PetscErrorCode ContactViewKKT(const ContactKKT *kkt, PetscViewer viewer);

/*@ ContactPrintKKT - the residuals as text: "penetration 9.0e-13, sign 0.0e+00, ...", text [size]. Not collective. @*/
PetscErrorCode ContactPrintKKT(const ContactKKT *kkt, size_t size, char text[]);

/*@ ContactGetCentre - mean position of all pairs, m; found is false without contact. Collective. @*/
PetscErrorCode ContactGetCentre(Contact contact, PetscReal centre[3], PetscBool *found);

/*@ ContactAddChecksum - adds surfaces and parameters of each interface. Collective; after ModelSetUp(). @*/
PetscErrorCode ContactAddChecksum(Contact contact, Checksum checksum);

/*@ ContactWrite - check.h5 and check.xmf: surfaces of the contacts and gaps of the mesh as it is. Collective; after
    ContactSetUp(). @*/
PetscErrorCode ContactWrite(Contact contact, Results results);

/*@ ContactView - interfaces in words. Collective. @*/
PetscErrorCode ContactView(Contact contact, PetscViewer viewer);

/*@ ContactDestroy - frees the interfaces. Collective. @*/
PetscErrorCode ContactDestroy(Contact *contact);
