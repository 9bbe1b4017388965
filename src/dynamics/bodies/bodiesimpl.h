/* Private to the files of Bodies: the kernels, what ranks share, and springs and dashpots at nodes */
#pragma once

#include "bodies.h"
#include "kernels/element/stencil.h"
#include <petscksp.h>

/* Axis about which a body is swept, or an oblique one along which it is, at least on some rank; the same on all ranks.
   Without either its components are x, y, z */
typedef struct {
  PetscBool turned, oblique;
  PetscInt  axis;   /* row of `row` */
  PetscReal row[9]; /* orthonormal, x, y, z where it is not oblique */
  PetscReal centre[3];
} BodiesFrame;

/* Products and sums: of a node and a line beside it, K v; of a damped node all else, ku, d, f and four energies; of a
   block of 3 x 3 that serves once */
#define STENCIL_FLOPS 34
#define NODE_FLOPS    48
#define BLOCK_FLOPS   18

/* Consecutive nodes k of all lines (from a multiple of STENCIL_WIDTH, to one of its half); `early` ones have nodes
   that ranks share, `first` and `last` ones the ends of open lines */
typedef struct {
  PetscInt  begin, end;
  PetscBool early, first, last;
} SweptRange;

/* One swept body on this rank: row (component) j of line l has node k at begin + (3 l + j) stride + k */
typedef struct {
  PetscInt     body;
  ModelLines  *lines;
  PetscInt     begin, stride;
  PetscInt     along;     /* the component along the sweep; the two others follow it cyclically */
  StencilLine *stiffness; /* [n_lines] */
  StencilLine *damping;   /* [n_lines], n = 0 but for lines of cells with different beta */
  ptrdiff_t   *at;        /* what the lines point to */
  double (*coefficient)[STENCIL_COEFFICIENTS], (*before)[9];
  PetscReal  *beta, *alpha;          /* [n_lines] */
  PetscReal  *mass;                  /* [n_lines][stride] of this rank's cells, kg */
  PetscReal  *inside, *first, *last; /* [stride]: 1 at nodes, at node 0, at the last node, else 0 */
  PetscInt    n_ranges;
  SweptRange *range;
  PetscInt    n_near; /* neighbours of all lines, those of damping of its own too: for the count of flops */
} SweptBody;

/* Rows of 3 x 3 blocks, each block row after row */
typedef struct {
  PetscInt   n;
  PetscBool  upper;  /* a symmetric matrix: the diagonal, which comes first in a row, and what is behind it */
  PetscInt  *start;  /* [n + 1] */
  PetscInt  *column; /* [start[n]] ascending in each row */
  PetscReal *value;  /* [start[n]][9], one more number at the end */
} BlockRows;

/* Some cells, and the rows of their nodes */
typedef struct {
  PetscInt  n, n_nodes, *of_vertex; /* [n_vertices] row, -1 of nodes elsewhere */
  PetscInt *cell;                   /* [n] */
} BodiesRowCells;

/* The Maxwell branches of a part; of its nodes the first n_early are shared with other ranks */
typedef struct {
  PetscInt   part, n_branches, n, n_early;
  PetscReal  stiff[VISCOELASTIC_BRANCHES], time[VISCOELASTIC_BRANCHES];     /* E_j / E; tau_j, s */
  PetscReal  dt, decay[VISCOELASTIC_BRANCHES], gain[VISCOELASTIC_BRANCHES]; /* of the step: e^(-dt / tau_j); s */
  PetscInt  *vertex;                                                        /* [n] local node */
  BlockRows  rows;                                                          /* of the static modulus, all of them */
  PetscReal *motion, *product; /* [n][3] work, one number more at the end of motion */
  PetscReal *force;            /* [n_branches][n][3] q of this rank's cells, N */
} MaxwellPart;

/* All bodies that are not swept, node after node from `begin` on; the first n_early nodes are shared with other ranks
   */
typedef struct {
  PetscInt   n, n_early, begin;
  PetscInt  *vertex;       /* [n] local node */
  PetscReal *mass, *alpha; /* [n] of this rank's cells, kg; alpha (1/s) times mass */
  PetscReal *beta;         /* [n] s, -2 where the cells differ */
  PetscReal *product;      /* [n][4] K v as far as it is summed, 0 between the calls but for the last number, void */
  PetscReal *room;         /* of product, which begins where a vector register's worth does */
  BlockRows  stiffness;
  BlockRows  damping; /* of the nodes whose cells have different beta, else empty rows */
} General;

/* A spring and dashpot at a node, in its local basis */
typedef struct {
  PetscInt  vertex;
  PetscBool early;
  PetscReal stiffness[9], damping[9]; /* N/m, N s/m; symmetric */
} Point;

/* A bushing or point: six rows of B at the nodes of its sets on this rank, copies included, in the local bases */
typedef struct {
  const Joint *like;
  PetscBool    massive;                   /* a point with mass or inertia */
  PetscBool    heavy;                     /* such a one in the mean */
  PetscReal    mobility[36], nearest[36]; /* of a rigid one: X, and (R'D R)^-1 */
  PetscInt     n;
  PetscInt    *vertex; /* [n] */
  PetscReal   *b;      /* [n][3][6] */
} BodyJoint;

/* The nodes of ties, those of all ranks on every rank */
typedef struct {
  PetscInt n, *number, *vertex; /* [n] global numbers, ascending; local nodes, -1 for none here */
  PetscInt n_masters, *column;  /* [n] which master, -1 for a slave */
  Mat      T;                   /* [3 n][3 n_masters] */
  KSP      inverse;             /* (T'D T)^-1 */
  Vec      q[2], x, mass;       /* work; kg, [3 n] */
} Tied;

/* A share of component `at` of the state in an unknown of a superelement */
typedef struct {
  PetscInt  row, vertex, at;
  PetscReal weight;
  PetscBool owned, shared;
} SuperEntry;

/* All superelements as one: points/superelement.c */
typedef struct {
  OperatorsSuperelements all;
  PetscInt               n, n_entries, first, last; /* unknowns; rows that this rank multiplies */
  SuperEntry            *entry;                     /* [n_entries] */
  PetscInt              *slot;                      /* [n] where an unknown apart stands, -1 */
  PetscReal             *X, *Y;                     /* [n][n] */
  PetscReal              bound[2];                  /* of K and C, (rad/s)^2 and rad/s */
  PetscReal             *q, *g, *h, *part;          /* [n] work */
  PetscMPIInt           *count, *start;             /* [ranks] */
} Super;

/* Sums over ranks at shared nodes, in ascending order of the ranks, so that all copies are bitwise equal */
typedef struct {
  MPI_Comm     comm;
  PetscMPIInt  self;
  PetscBool   *shared;         /* [n_vertices] whether other ranks have the node, too */
  PetscInt     n_ranks, *rank; /* that share nodes with this one, and this one at place `own`, ascending */
  PetscInt     own, *start;    /* [n_ranks + 1] */
  PetscInt    *vertex;         /* [start[n_ranks]] local nodes shared with each, in the same order on both */
  PetscReal   *send, *receive; /* [start[n_ranks]][3] */
  MPI_Request *request;        /* [2 (n_ranks - 1)], receiving first */
} Shared;

struct _p_Bodies {
  MPI_Comm     comm;
  Operators    operators;
  Model        model;
  const Mesh  *mesh;
  PetscBool    no_sweep; /* -dynamics_kernel general */
  PetscInt     n_bodies, *body;
  BodiesFrame *frame; /* [n_bodies] */
  Layout       layout;
  PetscInt     n_swept;
  SweptBody   *swept;
  General      general;
  PetscInt     n_points;
  Point       *point;
  PetscInt     n_joints, n_heavy; /* bushings and points, and those with mass */
  BodyJoint   *joint;
  PetscReal   *joint_motion; /* [n_joints][6] of the last call */
  PetscReal   *reaction;     /* X of the points with mass, [6 n_heavy][6 n_heavy] */
  Tied         tied;
  Super        super;
  PetscInt     n_branches, n_branch_forces;
  MaxwellPart *branch;        /* [n_branches] */
  PetscReal   *branch_forces; /* [n_branch_forces] of all of them */
  Shared       share;
  PetscBool    damped;  /* there is damping on some rank */
  PetscReal   *work[2]; /* [layout.n] each, for BodiesApply() and BodiesSetState() */
};

/* One call of the kernels; d NULL without damping */
typedef struct {
  PetscReal        dt;
  const PetscReal *u;
  PetscReal       *v; /* as it was when the call returns */
  PetscReal       *ku, *f, *d;
  BodiesSums       sums;
} BodiesWork;

/* A cell of this rank with its matrices */
typedef struct {
  PetscInt  part, n_nodes;
  PetscInt  vertex[ELEMENT_MAX_NODES];                      /* local, from 0 */
  PetscReal alpha, beta, branches;                          /* 1/s, s; moduli of Maxwell branches beside Young's */
  PetscReal mass[ELEMENT_MAX_NODES];                        /* lumped, kg */
  PetscReal stiffness[ELEMENT_MAX_DOFS * ELEMENT_MAX_DOFS]; /* N/m, [3 n_nodes][3 n_nodes], Cartesian */
} BodiesCell;

/* bodies/cell.c */
PETSC_INTERN PetscErrorCode BodiesGetCell(Bodies bodies, PetscInt c, BodiesCell *cell);
/* turns the stiffness to the local bases of its nodes */
PETSC_INTERN void BodiesTurnCell(const Layout *layout, BodiesCell *cell);
/* ku += K u cell by cell */
PETSC_INTERN PetscErrorCode BodiesCellsAddForces(Bodies bodies, const PetscReal u[], PetscReal ku[]);

/* layout.c - lines and frames of the bodies, then where the nodes stand */
PETSC_INTERN PetscErrorCode BodiesFindSwept(Bodies bodies);
PETSC_INTERN PetscErrorCode BodiesLayOut(Bodies bodies);

/* sweptcolumn.c - `mirrored` is whether the stencil describes the cells; the caller falls back on rows of blocks where
   not
   */
PETSC_INTERN PetscErrorCode SweptSetUp(Bodies bodies, SweptBody *swept, PetscBool *mirrored);

/* sweptbody.c - ranges once it is known which nodes ranks share, shared [n_vertices] */
PETSC_INTERN PetscErrorCode SweptSetRanges(SweptBody *swept, const PetscBool shared[]);
PETSC_INTERN PetscErrorCode SweptAdvance(const SweptBody *swept, PetscBool early, BodiesWork *work);
PETSC_INTERN PetscErrorCode SweptDestroy(SweptBody *swept);

/* generalbody.c, blockrows.c */
PETSC_INTERN PetscErrorCode GeneralSetUp(Bodies bodies);
PETSC_INTERN PetscErrorCode GeneralDestroy(General *general);
PETSC_INTERN PetscErrorCode GeneralAdvance(const General *general, PetscBool early, BodiesWork *work);

/* Rows of 3 x 3 blocks for the nodes of some cells: with all nodes that share one with each, or `upper` with those that
   are not before it. Adds scale times the stiffness of a cell, N/m. y = rows begin .. end - 1 times x, of whole rows,
   x [n][3] and a number more */
PETSC_INTERN PetscErrorCode BlockRowsCreate(const BodiesRowCells *cells, const Mesh *mesh, PetscBool upper,
                                            BlockRows *rows);
PETSC_INTERN PetscErrorCode BlockRowsAdd(const BodiesRowCells *cells, const BodiesCell *cell, PetscReal scale,
                                         BlockRows *rows);
PETSC_INTERN void           BlockRowsMultiply(const BlockRows *rows, PetscInt begin, PetscInt end, const PetscReal x[],
                                              PetscReal y[]);
PETSC_INTERN PetscErrorCode BlockRowsDestroy(BlockRows *rows);

/* cell.c - sum of E_j / E of the branches of a material */
PETSC_INTERN PetscReal BranchesStiffness(const Part *part);

/* branches.c - forces at the end of a step, after those of the kernels; kx += what the
   branches are to fast motions */
PETSC_INTERN PetscErrorCode BranchesSetUp(Bodies bodies);
PETSC_INTERN void           BranchesAdvance(Bodies bodies, PetscBool early, BodiesWork *work);
PETSC_INTERN void           BranchesAddStiffness(Bodies bodies, const PetscReal x[], PetscReal kx[]);
PETSC_INTERN PetscErrorCode BranchesDestroy(Bodies bodies);

/* points/spring.c */
PETSC_INTERN PetscErrorCode PointsSetUp(Bodies bodies);
PETSC_INTERN void           PointsAdvance(Bodies bodies, PetscBool early, BodiesWork *work);
PETSC_INTERN void           PointsAddForces(Bodies bodies, const PetscReal u[], PetscReal ku[]);

/* points/joint.c - the rows; forces as of points; Bound adds what they add to the largest omega^2 at most, 1/s^2 */
PETSC_INTERN PetscErrorCode JointsSetUpRows(Bodies bodies);
PETSC_INTERN PetscErrorCode JointsAdvance(Bodies bodies, PetscBool early, BodiesWork *work);
PETSC_INTERN PetscErrorCode JointsAddForces(Bodies bodies, const PetscReal u[], PetscReal ku[]);
PETSC_INTERN PetscErrorCode JointsAddBound(Bodies bodies, PetscReal s, PetscReal *bound);
PETSC_INTERN PetscErrorCode JointsDestroyRows(Bodies bodies);
/* q = B x of all of them, or B diag(scale) x, into joint_motion */
PETSC_INTERN PetscErrorCode JointsMotion(Bodies bodies, const PetscReal scale[], const PetscReal x[]);

/* Where component i % 3 of node i / 3 of a bushing or point is */
static inline PetscInt JointAt(const Layout *l, const BodyJoint *joint, PetscInt i)
{
  const PetscInt v = joint->vertex[i / 3];

  return l->at[v] + i % 3 * l->step[v];
}

/* points/inertia.c - 1/2 q'W q of the mass and inertia of a point, J */
PETSC_INTERN PetscReal PointKinetic(const Joint *point, const PetscReal q[6]);
/* W, mass and inertia of a point */
PETSC_INTERN void PointInertia(const Joint *point, PetscReal W[36]);

/* points/rigid.c - matrices of a rigid point; of all of them forces in the place of those on their nodes, or motions,
   x [layout n] */
PETSC_INTERN PetscErrorCode RigidPointSetUp(Bodies bodies, BodyJoint *joint);
PETSC_INTERN PetscErrorCode RigidPointsApply(Bodies bodies, PetscBool forces, PetscReal x[]);

/* What moves a local node besides its cells: bits */
enum { BODIES_IN_CONTACT = 1, BODIES_AT_RIGID = 2, BODIES_AT_HEAVY = 4, BODIES_AT_SUPER = 8 };

/* points/tied.c - matrices of ties, after the last BodiesHold(), where none of their nodes, whose bits are in mark
   [n_nodes], moves otherwise; forces in the place of those on their nodes, or motions */
PETSC_INTERN PetscErrorCode TiedSetUp(Bodies bodies, const unsigned char mark[]);
PETSC_INTERN PetscErrorCode TiedApply(Bodies bodies, PetscBool forces, PetscReal x[]);
PETSC_INTERN PetscErrorCode TiedDestroy(Tied *tied);

/* points/superelement.c - numbers of the state; masses of these, after those of the nodes; nodes in mark [n_nodes]; X
   and Y, after the last BodiesHold(), where none of the nodes moves otherwise; superforce.c - forces as of points */
PETSC_INTERN PetscErrorCode SuperLayOut(Bodies bodies);
PETSC_INTERN PetscErrorCode SuperSetMasses(Bodies bodies);
PETSC_INTERN PetscErrorCode SuperGetMarks(Bodies bodies, unsigned char mark[]);
PETSC_INTERN PetscErrorCode SuperSetUp(Bodies bodies, const unsigned char mark[]);
PETSC_INTERN PetscErrorCode SuperAdvance(Bodies bodies, PetscBool early, BodiesWork *work);
PETSC_INTERN PetscErrorCode SuperAddForces(Bodies bodies, const PetscReal u[], PetscReal ku[]);
PETSC_INTERN PetscErrorCode SuperAddInertia(Bodies bodies, PetscReal f[]);
PETSC_INTERN PetscErrorCode SuperDestroy(Bodies bodies);

/* sharedvertices.c - Begin sends what x has at shared nodes, End replaces it by the sums */
PETSC_INTERN PetscErrorCode SharedSetUp(Bodies bodies);
PETSC_INTERN PetscErrorCode SharedBegin(Shared *share, const Layout *layout, const PetscReal x[]);
PETSC_INTERN PetscErrorCode SharedEnd(Shared *share, const Layout *layout, PetscReal x[]);
PETSC_INTERN PetscErrorCode SharedDestroy(Shared *share);
