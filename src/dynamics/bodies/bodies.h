/*
   Bodies (private to dynamics/) - where the nodes stand in the state vectors, their lumped masses, and the internal
   forces: f = -K u - C v of parts, springs and dashpots, and those of Maxwell branches (branches.c).

   Layout: a state vector is a local array of n numbers on every rank. Vertex i (from 0, all local ones, copies of other
   ranks' nodes included) has its components at at[i], at[i] + step[i], at[i] + 2 step[i], along the orthonormal
   local basis basis[i] (rows). Bodies swept along an angle have cylindrical components, all others Cartesian ones.
   Numbers that belong to no node are padding: their minv is 0, and they stay 0.
*/
#pragma once

#include <squeal/quantity.h>
#include <squeal/operators.h>

typedef struct _p_Bodies *Bodies;

typedef struct {
  PetscInt         n;              /* length of a state vector on this rank */
  PetscInt         n_vertices;     /* local nodes */
  PetscInt        *at, *step;      /* [n_vertices]; at = -1 for a node without cells */
  PetscReal       *basis;          /* [n_vertices][3][3], row j is the direction of component j */
  const PetscBool *owned;          /* [n_vertices] exactly one rank owns each node */
  PetscReal       *part, *total;   /* [n] masses of this rank's cells alone, and complete ones, kg */
  PetscReal       *minv;           /* [n] 1 / total, 0 in held directions and padding */
  PetscInt         apart, n_apart; /* where unknowns of superelements that no node has stand, on every rank */
  PetscReal       *damping;        /* [n] C v and branches of the last BodiesAdvance(), N; NULL without damping */
} Layout;

/* A call of BodiesAdvance(), with state vectors */
typedef struct {
  PetscReal        dt; /* of the step that led to u, s */
  const PetscReal *u;  /* displacements at t_{n+1}, m */
  const PetscReal *v;  /* velocities v_{n+1/2}, m/s */
  PetscReal       *ku; /* K u of this rank's cells alone, N */
  PetscReal       *f;  /* internal forces, N */
} BodiesStep;

/* Kinetic energy is that of points, too. Sums over this rank (a number shared by ranks is counted once over all of
   them), at the call of BodiesAdvance() with u_{n+1}, v = v_{n+1/2} */
typedef struct {
  PetscReal kinetic;     /* 1/2 v'M v, J */
  PetscReal strain;      /* 1/2 u_{n+1}'K u_n, springs included, J */
  PetscReal damping_old; /* v_{n+1/2}' d_n, W, d_n = C v_{n-1/2} of the call before */
  PetscReal damping;     /* v_{n+1/2}' d_{n+1}, W */
} BodiesSums;

/* Vector of three Cartesian numbers at node i, from and to a state vector; Set, or Add */
static inline void LayoutGet(const Layout *l, PetscInt i, const PetscReal x[], PetscReal cartesian[3])
{
  const PetscReal *q = &l->basis[9 * i];

  for (int d = 0; d < 3; d++) cartesian[d] = 0;
  for (int j = 0; j < 3; j++)
    for (int d = 0; d < 3; d++) cartesian[d] += q[3 * j + d] * x[l->at[i] + j * l->step[i]];
}

static inline void LayoutAdd(const Layout *l, PetscInt i, const PetscReal cartesian[3], PetscReal x[])
{
  const PetscReal *q = &l->basis[9 * i];

  for (int j = 0; j < 3; j++)
    x[l->at[i] + j * l->step[i]] += q[3 * j] * cartesian[0] + q[3 * j + 1] * cartesian[1] + q[3 * j + 2] * cartesian[2];
}

static inline void LayoutSet(const Layout *l, PetscInt i, const PetscReal cartesian[3], PetscReal x[])
{
  for (int j = 0; j < 3; j++) x[l->at[i] + j * l->step[i]] = 0;
  LayoutAdd(l, i, cartesian, x);
}

/*@ BodiesCreate - without bodies. Collective. @*/
PetscErrorCode BodiesCreate(MPI_Comm comm, Bodies *bodies);

/*@
   BodiesSetFromOptions - reads the choice of kernels. Collective.

   Its option is the row of bodies.c.
@*/
PetscErrorCode BodiesSetFromOptions(Bodies bodies);

/* BodiesVisit - shows the rows of its options. Collective. */
PETSC_INTERN PetscErrorCode BodiesVisit(Bodies b, const QuantityVisitor *visitor);

/*@ BodiesSetUp - finds bodies swept along an angle or an axis, lays out the nodes, and makes the masses and kernels
   from the present values of the parameters of the operators. Collective. @*/
PetscErrorCode BodiesSetUp(Bodies bodies, Operators operators);

/*@ BodiesGetLayout - where the nodes stand, and their masses (borrowed). Not collective. @*/
PetscErrorCode BodiesGetLayout(Bodies bodies, const Layout **layout);

/*@ BodiesHold - makes a direction of a node held: minv = 0, so that only its prescribed velocity moves it. j is the
    component in the local basis. Same call on all ranks that have the node. @*/
PetscErrorCode BodiesHold(Bodies bodies, PetscInt vertex, PetscInt j);

/*@ BodiesSetPoints - what the masses of points and ties need, after the last BodiesHold(); contact [n_contact] are
   the nodes that contact forces may act on. Collective. Errors: PETSC_ERR_SUP for a point with mass that has one of
   them, or a node that a motion drives; for a tie that has one of these, or one that a support holds. @*/
PetscErrorCode BodiesSetPoints(Bodies bodies, PetscInt n_contact, const PetscInt contact[]);

/*@ BodiesMakeRigid - replaces what a state vector has at sets that are joined rigidly, and at nodes of ties, by the
   motion next to it that these allow, after BodiesSetPoints(). Collective. @*/
PetscErrorCode BodiesMakeRigid(Bodies bodies, PetscReal x[]);

/*@ BodiesAddInertia - adds the inertial forces of points, and those that hold rigid sets and ties together, to f, N,
   which holds
    all others but those of contact, complete at every copy: then minv f is the acceleration. Collective. @*/
PetscErrorCode BodiesAddInertia(Bodies bodies, PetscReal f[]);

/*@ BodiesApplyRoot - x = (I + G'Y G) x, with which scale = D^-1/2 times it is the symmetric root of M^-1, superelements
    included; x itself without. Complete at every copy. Collective. @*/
PetscErrorCode BodiesApplyRoot(Bodies bodies, const PetscReal scale[], PetscReal x[]);

/*@ BodiesApply - kx = K x, with Maxwell branches as springs, and cx = C x (NULL where not needed), complete at shared
    nodes. Collective. @*/
PetscErrorCode BodiesApply(Bodies bodies, const PetscReal x[], PetscReal kx[], PetscReal cx[]);

/*@ BodiesSetState - ku = K u of this rank's cells alone, N, element by element relative to the first node of each,
    springs, bushings and points included, and the damping forces of v for the sums of the next BodiesAdvance().
    Collective. @*/
PetscErrorCode BodiesSetState(Bodies bodies, const PetscReal u[], const PetscReal v[], PetscReal ku[]);

/*@ BodiesGetMemory - the forces of Maxwell branches of this rank's cells [n], N (borrowed), which the next step needs.
    Not collective. @*/
PetscErrorCode BodiesGetMemory(Bodies bodies, PetscInt *n, PetscReal **forces);

/*@ BodiesAdvance - ku += dt K v, then f = -ku - C v, complete at shared nodes; the sums use ku before. dt = 0 leaves
    ku as it is (first step). The exchange of shared nodes overlaps with the work on the others. Collective. @*/
PetscErrorCode BodiesAdvance(Bodies bodies, const BodiesStep *step, BodiesSums *sums);

/*@ BodiesGetElementBound - largest omega^2 (1/s^2) of any single element with its own lumped mass, with stiffness
    K_e + s C_e (and of springs and dashpots with their nodes), an upper bound of the assembled one. Collective. @*/
PetscErrorCode BodiesGetElementBound(Bodies bodies, PetscReal s, PetscReal *bound);

/*@ BodiesAddChecksum - adds the choice of kernels. Not collective. @*/
PetscErrorCode BodiesAddChecksum(Bodies bodies, Checksum checksum);

/*@ BodiesView - which kernel serves which body, in words. Collective. @*/
PetscErrorCode BodiesView(Bodies bodies, PetscViewer viewer);

/*@ BodiesDestroy - frees all. Collective. @*/
PetscErrorCode BodiesDestroy(Bodies *bodies);
