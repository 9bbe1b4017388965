/* Private to statics/: the contact problem, its small system, and the record of the solver */
#pragma once

#include <squeal/quantity.h>
#include <squeal/statics.h>
#include "kernels/contact/coulomb.h"
#include "solver/factor/shiftinvert.h"

/* Most rows of -static_dense */
#define STATICS_MOST_DENSE 20000

/* A stage of the loading: what begins in it, by name, and what acts at its end */
typedef struct {
  char      *name; /* NULL of the one in which all acts */
  PetscInt   n_loads, n_motions, n_sliding, n_interferences, n_ends;
  char     **loads, **motions, **sliding, **interferences, **ends;
  PetscReal *load, *motion; /* [scene] 0 or 1 */
  PetscReal *share;         /* [loads] as OperatorsAddLoads() takes it: of a bolt under tension its shortening, m */
  PetscReal *interference;  /* [interfaces] m */
  PetscBool *slides;        /* [interfaces] */
} Stage;

/* Who carries how much at the end of a stage */
typedef struct {
  PetscInt    stage;
  const char *name, *kind;         /* borrowed */
  PetscReal   force[3];            /* N */
  PetscInt    n[CONTACT_N_STATUS]; /* pairs of a contact */
} Reaction;

/* Rows of the contact problem: the normal one of a pair that slides or has no friction, else normal, t and b */
typedef struct {
  MPI_Comm                comm;
  PetscInt                n_pairs, n_pairs_all, n_interfaces; /* of this rank, of all */
  const ContactPair      *pair;
  const ContactInterface *interface;
  CoulombPair            *law;   /* [n_pairs] mu, k, gap and rows of each pair; mu is 0 in the law of a sliding pair */
  PetscReal              *slide; /* [n_pairs] friction coefficient of a sliding pair, else 0 */
  PressureLaw            *pressure;        /* [n_interfaces] at the point */
  const PetscReal        *worn;            /* [n_pairs] by which gaps have grown, m (borrowed); NULL: by nothing */
  PetscReal              *wear;            /* [n_pairs] W of a step of wear, m / Pa^a (wear/law.c) */
  PetscBool               wearing;         /* whether one is made: wear is NULL on ranks without pairs */
  PetscReal              *closing;         /* [n_pairs] at which a law that is not linear has its tangent, m */
  PetscInt                n, n_all, begin; /* rows of this rank, of all, first of this rank */
  PetscInt               *first;           /* [n_pairs + 1] first row of each pair, counted on this rank */
  PetscBool              *slides;          /* [n_interfaces] whether it slides now */
  /* [rows] contact displacements by motions and interference at the end of the stage and at its beginning, m; NULL
     without */
  PetscReal *moved, *moved0;
  Mat        G; /* [rows][unknowns] n, t, b */
  Mat        S; /* t in the rows of sliding pairs, else empty; NULL where nothing slides */
} PairRows;

/* Whether the pressure of some interface is not linear, in a step of wear its wear; alike on all ranks */
static inline PetscBool PairRowsCurved(const PairRows *rows)
{
  for (PetscInt i = 0; i < rows->n_interfaces; i++) {
    const ContactInterface *c = &rows->interface[i];

    if (!PressureIsLinear(&rows->pressure[i])) return PETSC_TRUE;
    if (rows->wearing && ContactWears(c) && c->wear_exponent != 1) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Whether some pair follows Coulomb's law */
static inline PetscBool PairRowsCoulomb(const PairRows *rows)
{
  return rows->n_all > rows->n_pairs_all ? PETSC_TRUE : PETSC_FALSE;
}

/* Rigid motions that nothing resists, r_i' M r_j = delta_ij, and the unknowns at which they are held */
typedef struct {
  PetscInt  n;
  Vec      *r, *mr;    /* [n] motions and their products with M; length: all unknowns */
  PetscInt *pin;       /* [n] global numbers of the unknowns held */
  PetscReal stiffness; /* of a pin, N/m */
} Hold;

/* Factors of the bodies with the pairs at a status (pairs/refactor.c) */
typedef struct _StatusFactor *StatusFactor;

/* The factorisation of K_a = K + kappa G'G + pins, and W = kappa G K_a^-1 G', V = kappa G K_a^-1 S', by columns, on
   every rank; NULL where they would be too large. Then factors of a status take the place of those of K_a. */
typedef struct {
  const PairRows *rows;
  PetscReal       kappa; /* N/m */
  Hold            hold;
  ShiftInvert     inverse;    /* of K_a, or of Z'K_a Z where there is Z; none while the status stands for it */
  Mat             Ka;         /* which stays; NULL where there are W and V */
  Mat             Z, E;       /* OperatorsGetDependents() */
  Vec             reduced[2]; /* work where there is Z */
  PetscReal      *W, *V;      /* [rows][rows] by columns, of all ranks */
  StatusFactor    status;
  Vec             u, b; /* work: all unknowns */
  Vec             row;  /* work: rows */
} Compliance;

/* Rows and factorisation of a set of contacts that slide, and the point of the latter */
typedef struct {
  PairRows   rows;
  Compliance compliance; /* of these rows where both stand in struct _p_Statics */
  PetscReal *factored;   /* [n_parameters], or NULL */
} StageRows;

/* What the free motions r_1 .. r_m of the bodies alone do to each pair of all ranks: mu where it slides else 0, mu of
   Coulomb's law, then N r_j, T r_j, B r_j, [3][m] */
typedef struct {
  PetscInt   m, n_pairs, width; /* width = 2 + 3 m */
  PetscReal *pair;              /* [n_pairs][width] */
  PetscReal *push;              /* [m] f'r_j */
} RigidPairs;

/* A proof that the loads have no equilibrium */
typedef struct {
  PetscBool proven, frictionless; /* also without friction */
  PetscReal friction;             /* part of the friction that could be balanced, where it is not frictionless */
  Vec       motion;               /* the bodies' acceleration, of all unknowns; NULL where nothing is proven */
} Certificate;

typedef enum { SMALL_GOOD, SMALL_SINGULAR, SMALL_UNSOLVED } SmallOutcome;

/* How the iteration ended; UNSOLVED by a GMRES that did not converge */
typedef enum {
  ACTIVE_CONVERGED,
  ACTIVE_SINGULAR,
  ACTIVE_REPEATS,
  ACTIVE_SLOW,
  ACTIVE_JAMMED,
  ACTIVE_UNSOLVED,
  ACTIVE_UNSETTLED /* of pressure laws */
} ActiveOutcome;

/* The contact problem at one load, and its iterate; forces divided by kappa, m */
typedef struct {
  Operators         operators;
  const PetscReal  *p; /* the point */
  PairRows         *rows;
  const Compliance *compliance;
  Vec               f, u; /* forces on the bodies, N, and displacements of all unknowns */
  Vec               f0;   /* forces from which f is reached, N; NULL for none */
  const PetscReal  *w0;   /* [rows] w there, m; NULL for none */
  PetscReal         size; /* of all forces, N */
  PetscInt          load_steps, max_it, n_it, n_factored;
  char              place[256]; /* the point in words, for messages */
  PetscReal         friction;   /* factor of all friction coefficients, 0 .. 1 */
  PetscReal         rtol;       /* of GMRES on the small system */
  PetscReal         scale;      /* m, of the contact displacements; what is below `rounding` of it decides nothing */
  PetscReal         rounding;
  ContactStatus    *status;    /* [n_pairs] to begin with, then as found */
  PetscReal        *free;      /* [rows] w without contact forces, kappa-held: G K_a^-1 f; where there is W */
  PetscReal        *l, *w;     /* [rows] contact forces over kappa, m; displacements of the rows, m */
  PetscBool         hasty;     /* the iteration gives up soon, since other ways follow */
  ActiveOutcome     first;     /* of the iteration with the whole friction */
  PetscBool         pressed;   /* an equilibrium without friction was found */
  PetscBool         passing;   /* the state is one on the way: whether bodies jam is asked at the end of it */
  PetscBool         tentative; /* laws are tangents of others: whether bodies jam is asked at the last ones alone */
  PetscBool         far;       /* GMRES on K_a alone takes too long */
  PetscBool         reversed;  /* the system of the last iteration has a determinant of the wrong sign */
} Active;

/* Whether the laws of all pairs are linear at each status */
static inline PetscBool ActiveIsLinear(const Active *active)
{
  return !PairRowsCoulomb(active->rows) || active->friction == 0 ? PETSC_TRUE : PETSC_FALSE;
}

#define REPEAT_LONGEST 64

/* Numbers that tell iterates apart: of all statuses, and of forces and displacements, m */
typedef struct {
  PetscInt  n;
  PetscReal status[REPEAT_LONGEST], iterate[REPEAT_LONGEST];
} Repeat;

/* An interface after a step of wear; all from the beginning of the wear on but the last three */
typedef struct {
  PetscInt  step, interface;
  PetscReal time, depth, volume, work; /* s; largest of a pair, m; sum of A dg0, m^3; of friction, J */
  PetscReal error;                     /* of the steps, in the depth of a pair, m */
  PetscReal force, pressure, change;   /* N; largest, Pa; largest change in the step, as a part of it */
  PetscInt  n_closed;
} WearRow;

struct _p_Statics {
  MPI_Comm  comm;
  Operators operators;
  Model     model; /* of the operators, as the contact; NULL for loaded matrices */
  Contact   contact;
  Progress  progress;
  /* set by options */
  PetscInt  max_it, load_steps, dense, rows_more, identify_steps;
  PetscBool geometric, follower, view_kkt;
  Stage    *stages; /* [n_stages], or 0 and all at once: */
  Stage     whole;
  PetscInt  n_stages;
  /* the contact problem and the factorisation */
  PairRows   rows;
  Compliance compliance;
  StageRows *kept; /* [n_kept] of stages in which others slide */
  PetscInt   n_kept;
  PetscReal *p, *factored; /* [n_parameters] the point of the solution, and that of the factorisation or NULL */
  /* the solution */
  PetscBool         solved, rested;                 /* rested: nothing pressed in the stage before */
  PetscInt          n_parameters, n_it, n_factored; /* iterations; sparse factorisations of the last solution */
  ContactStatus    *status;                         /* [n_pairs] open, stick or slip */
  ContactState     *state;                          /* [n_pairs] gap, forces, status */
  Vec               u;                              /* displacements, m; length: all unknowns */
  ContactKKT        kkt;
  PetscInt          stage;       /* of the state */
  PetscInt          n_tightened; /* solutions until bolts had their tension */
  Reaction         *reaction;    /* [n_reactions] of all stages; without -stages when they are written */
  PetscInt          n_reactions;
  PetscReal         peak;        /* 2-norm of the largest forces up to it, N */
  PetscReal         equilibrium; /* relative residual */
  PetscInt          n_free;      /* rigid motions held by pins */
  StaticsResultant *resultant;   /* [interfaces] */
  PetscBool         deep;        /* surfaces that yield too far have been warned of */
  /* wear (wear/wear.c) */
  PetscBool  wears;  /* asked for */
  PetscReal *worn;   /* [n_pairs] by which gaps have grown, m */
  PetscInt   n_wear; /* rows of the last solution */
  WearRow   *wear_row;
};

/* quantities.c - what options set in struct _p_Statics */
extern const QuantityTable statics_quantities;
/* statics.c - pairs, rows and room for results, once; the point of what follows, NULL for the values of the scene */
PETSC_INTERN PetscErrorCode StaticsSetUp(Statics statics, const PetscReal p[]);
/* state.c - " at contact_mu 0.7, pad_young 1e+10": parameters that differ from those of the scene, for messages */
PETSC_INTERN PetscErrorCode StaticsPlace(Statics statics, char text[], size_t size);
/* stage.c - -stages of the options; checked, and what acts in each; how many there are, 1 without the option; the k-th,
   NULL before the first; displacements that its motions prescribe [nodes][3], m, NULL without motions, the caller frees
   them (stage NULL: all of them) */
extern const QuantityList   stages_list;
PETSC_INTERN PetscErrorCode StagesSetUp(Statics statics);
PETSC_INTERN PetscInt       StagesCount(Statics statics);
PETSC_INTERN const Stage   *StagesGet(Statics statics, PetscInt k);
PETSC_INTERN PetscErrorCode StageGetMotions(Model model, const Stage *stage, PetscReal **nodal);
PETSC_INTERN PetscErrorCode StagesDestroy(Statics statics);
/* solve.c - stage k from the loads f0 of the one before it (NULL at first) to its own, f; size is that of the largest
   loads until now, N */
PETSC_INTERN PetscErrorCode StageSolve(Statics statics, PetscInt k, Vec f0, PetscReal *size, Vec *f);
/* bolt.c - the same, with shortenings of the bolts that the stage tightens so that they have their tension; lines;
   what a bolt has in the state (reaction.c) */
PETSC_INTERN PetscErrorCode BoltsSolve(Statics statics, PetscInt k, Vec f0, PetscReal *size, Vec *f);
PETSC_INTERN PetscErrorCode BoltGet(Statics statics, PetscInt load, OperatorsBolt *bolt);
PETSC_INTERN PetscErrorCode BoltsView(Statics statics, PetscViewer viewer);
/* run.c - all stages at the point that is set, with the gaps as they are worn */
PETSC_INTERN PetscErrorCode StagesSolve(Statics statics);
/* solve.c - all pairs closed, those of Coulomb's law without slip */
PETSC_INTERN void StaticsCloseAll(Statics statics);
/* rows.c - pairs and rows, normal ones only for pressing without friction, with the interfaces that slide in a stage
   (NULL: as they are told); friction coefficients and stiffnesses of the interfaces at p; of a pair at its force */
PETSC_INTERN PetscErrorCode PairRowsCreate(Operators operators, PetscBool pressing, const Stage *stage, PairRows *rows);
PETSC_INTERN PetscErrorCode PairRowsSetLaws(Operators operators, const PetscReal p[], PetscReal kappa, PairRows *rows);
PETSC_INTERN PetscErrorCode PairRowsSetFriction(Operators operators, const PetscReal p[], PetscInt pair,
                                                PetscReal force, PairRows *rows);
PETSC_INTERN void           PairRowsSetClosing(PairRows *rows, PetscInt pair, PetscReal kappa, PetscReal closing);
/* wear/law.c - whether a pair's law is not linear; its closing (m) at a force (N), of which worn in the step, the slope
   (N/m) where closing and force belong together, and the force at a closing, wear of a step included */
PETSC_INTERN PetscBool PairIsCurved(const PairRows *rows, PetscInt pair);
PETSC_INTERN PetscReal PairWorn(const PairRows *rows, PetscInt pair, PetscReal force);
PETSC_INTERN PetscReal PairClosing(const PairRows *rows, PetscInt pair, PetscReal force);
PETSC_INTERN PetscReal PairSlope(const PairRows *rows, PetscInt pair, PetscReal closing, PetscReal force);
PETSC_INTERN PetscReal PairForce(const PairRows *rows, PetscInt pair, PetscReal closing);
/* moved.c - contact displacements by motions and interference at the end of a stage and of the one before it, NULL for
   none; gaps at a part of the way, and slip that counts from w [rows] and the part before, NULL and 0 at the first load
   step */
PETSC_INTERN PetscErrorCode PairRowsSetMoved(Model model, const Stage *before, const Stage *stage, PairRows *rows);
PETSC_INTERN void           PairRowsMove(PairRows *rows, PetscReal part, PetscReal before, const PetscReal w[]);
PETSC_INTERN PetscErrorCode PairRowsDestroy(PairRows *rows);

/* rigid.c - the motions without energy in A (K + kappa G'G), r and mr only */
PETSC_INTERN PetscErrorCode FreeMotionsCreate(Operators operators, const PetscReal p[], Mat A, Hold *hold);

/* hold.c - the free motions of A, held by pins that are added to A; errors for a load (or
   any force on the bodies) along one of them; u without them */
PETSC_INTERN PetscErrorCode HoldCreate(Operators operators, const PetscReal p[], Mat A, Hold *hold);
PETSC_INTERN PetscErrorCode HoldIsPushed(const Hold *hold, Vec f, PetscReal size, PetscBool *pushed);
PETSC_INTERN PetscErrorCode HoldCheck(Operators operators, const Hold *hold, const char force[], Vec f, PetscReal size);
/* The part that moves most freely where A, of the closed pairs only, has more free motions, else NULL */
PETSC_INTERN PetscErrorCode HoldFindLoose(Operators operators, const PetscReal p[], const Hold *hold, Mat A,
                                          const char **part);
PETSC_INTERN PetscErrorCode HoldProject(const Hold *hold, Vec u);
/* Takes from forces f what pushes along the free motions, spread as inertia would: f - M r (r'f) */
PETSC_INTERN PetscErrorCode HoldRelieve(const Hold *hold, Vec f);
PETSC_INTERN PetscErrorCode HoldDestroy(Hold *hold);

/* compliance.c - factors, and forms W and V for up to max_rows rows; y = w - G u; u of the forces f - kappa (G'l -
   S' (slide l)) on the bodies, f may be NULL, held at w by the pairs of K_a or of the status that stands for it (X = 1
   and no slide in K_a): u = K_s^-1 b, b = f + kappa (G'(X w - l) + S' slide (l - X w)); b less f is added; l and w may
   be NULL without friction, w with it; w = G u */
PETSC_INTERN PetscErrorCode ComplianceCreate(Operators operators, const PetscReal p[], const PairRows *rows,
                                             PetscInt max_rows, Progress *progress, Compliance *c);
PETSC_INTERN PetscErrorCode ComplianceApply(const Compliance *c, PetscReal friction, const PetscReal l[],
                                            const PetscReal w[], PetscReal y[]);
PETSC_INTERN PetscErrorCode ComplianceSolve(const Compliance *c, PetscReal friction, Vec f, const PetscReal l[],
                                            const PetscReal w[], Vec u);
/* r = f - (K + pins) u - kappa (G'l - S' (slide l)), N, where Ka stayed */
PETSC_INTERN PetscErrorCode ComplianceResidual(const Compliance *c, PetscReal friction, Vec f, const PetscReal l[],
                                               Vec u, Vec r);
/* Takes forces that hold rigid sets together out of a residual, N: E Z'r */
PETSC_INTERN PetscErrorCode ComplianceDropConstraint(const Compliance *c, Vec r);
PETSC_INTERN PetscErrorCode ComplianceAddForces(const Compliance *c, PetscReal friction, const PetscReal l[],
                                                const PetscReal w[], Vec b);
PETSC_INTERN PetscErrorCode ComplianceGetRows(const Compliance *c, Vec u, PetscReal w[]);
/* K + kappa G'G of all rows, or of those of pairs closed at the status [pairs]. Where Coulomb's pairs
   slip in different directions they resist too; what slips in one direction makes the small system singular. */
PETSC_INTERN PetscErrorCode ComplianceAugment(Mat K, const PairRows *rows, PetscReal kappa, PetscBool closed_only,
                                              const ContactStatus status[], Mat *A);
PETSC_INTERN PetscErrorCode ComplianceDestroy(Compliance *c);

/* pivot.c - statuses of sliding pairs, or of all without friction, by complementary pivoting on the dense small
   system; found is false where there is no solution or none is found */
PETSC_INTERN PetscErrorCode PivotSolve(const Compliance *c, PetscReal friction, const PetscReal rhs[],
                                       ContactStatus status[], PetscBool *found);

/* repeat.c - whether the iterate was there before, among the last ones seen; remembers it */
PETSC_INTERN PetscErrorCode RepeatFind(const Active *active, Repeat *seen, PetscBool *repeats);

/* activeset.c - l and w of one small system at the present status; the largest contact displacement, force or gap, m */
PETSC_INTERN PetscErrorCode ActiveLinear(Active *active, PetscReal l[], PetscReal w[], SmallOutcome *outcome);
PETSC_INTERN PetscErrorCode ActiveFindScale(Active *active);
/* Iterates from the present status at the present friction; sure changes fewer pairs at a time */
PETSC_INTERN PetscErrorCode ActiveIterate(Active *active, PetscBool sure, ActiveOutcome *outcome);
/* Whether the small system at the present status and a factor of friction has a determinant of the wrong sign */
PETSC_INTERN PetscErrorCode ActiveIsReversed(Active *active, PetscReal friction, PetscBool *reversed);
/* One correction of l and w at the status reached, for what is left of the forces, r (N), and e = w - G u [rows] (m) */
PETSC_INTERN PetscErrorCode ActiveCorrect(Active *active, Vec r, const PetscReal e[]);

/* activeset.c - whether many iterations are worth their time */
PETSC_INTERN PetscBool ActiveIsFew(const Active *active);

/* soften.c - the same by continuation in a regularisation of friction, from the present l and w */
PETSC_INTERN PetscErrorCode ActiveSoften(Active *active, ActiveOutcome *outcome);

/* continuation.c - status, l and w that obey all laws, from the status given; friction is raised in steps if need be.
   outcome and active->friction tell where it ended. */
PETSC_INTERN PetscErrorCode ActiveSolve(Active *active, ActiveOutcome *outcome);

/* pressure.c - the same with pressure laws, at which Newton's method aims by tangents */
PETSC_INTERN PetscErrorCode PressuresSolve(Active *active, ActiveOutcome *outcome);
/* rubbing.c - the same with friction coefficients that depend on the pressure */
PETSC_INTERN PetscErrorCode RubbingSolve(Active *active, ActiveOutcome *outcome);
/* equilibrium.c - room and what messages need; displacements of the forces alone, and of the rows; pairs that obey all
   laws, or the error that says why there are none; the end */
PETSC_INTERN PetscErrorCode EquilibriumBegin(Statics statics, Active *active);
PETSC_INTERN PetscErrorCode EquilibriumFree(Active *active);
PETSC_INTERN PetscErrorCode EquilibriumFind(Active *active);
PETSC_INTERN PetscErrorCode EquilibriumEnd(Active *active);
/* equilibrium.c - the whole solution, from rows, compliance, f, u, size, load_steps, status and l (zeros) */
PETSC_INTERN PetscErrorCode EquilibriumSolve(Statics statics, Active *active);

/* wear/wear.c - lets the gaps of the last solution grow, rows.worn, with its pairs beginning from the forces l [rows]
   over kappa; none without wear. Collective. */
PETSC_INTERN PetscErrorCode StaticsWear(Statics statics, PetscBool *worn);
/* output/wear.c - wear.csv, where something wore */
PETSC_INTERN PetscErrorCode StaticsWriteWear(Statics statics, Results results);

/* balance.c - what the pairs, with their friction times a factor, cannot balance of the loads, left [m]; worst is the
   largest work of a force of a pair along it, beside |left| and the largest force */
PETSC_INTERN PetscErrorCode BalanceLoads(const RigidPairs *k, PetscReal friction, PetscReal left[], PetscReal *worst);

/* certificate.c - tries to prove that the forces f have no equilibrium with all friction coefficients times a factor;
   the caller destroys the motion. Check raises the error where it is proven. */
PETSC_INTERN PetscErrorCode CertificateFind(const Active *active, PetscReal friction, Certificate *certificate);
PETSC_INTERN PetscErrorCode CertificateCheck(const Active *active);

/* describe.c - a motion that is rigid in each body, in words: the body that goes farthest, and where to */
PETSC_INTERN PetscErrorCode RigidDescribe(Operators operators, Vec r, size_t size, char text[]);

/* state.c - states, resultants and residuals of a solution */
PETSC_INTERN PetscErrorCode StaticsSetState(Statics statics, Vec f, const PetscReal l[]);
/* Warns, once, of surfaces of the last solution that bodies go through. Collective. */
PETSC_INTERN PetscErrorCode StaticsWarnClosing(Statics statics);

/* state.c - dP/dc times the area of a local pair, N/m: infinite of exact contact, 0 where it is open */
PETSC_INTERN PetscReal StaticsPairStiffness(Statics statics, PetscInt pair);

/* loadvector.c - f of a stage's loads and of the weight at p, unknowns only, and its size by all of them, N */
PETSC_INTERN PetscErrorCode StaticsCreateLoad(Operators operators, const PetscReal p[], const Stage *stage, Vec *f,
                                              PetscReal *size);

/* table.c - stages.csv, with -stages; lines of what the stages before the last end with */
PETSC_INTERN PetscErrorCode StagesWrite(Statics statics, Results results);
PETSC_INTERN PetscErrorCode StagesViewEnds(Statics statics, PetscViewer viewer);

/* reaction.c - adds those of the state; reactions.csv; u at all local nodes, zero where held */
PETSC_INTERN PetscErrorCode StaticsFindReactions(Statics statics);
PETSC_INTERN PetscErrorCode StaticsWriteReactions(Statics statics, Results results);
PETSC_INTERN PetscErrorCode StaticsCreateDisplacements(Statics statics, Vec *local);

/* pressure.c - a vector of one force per node, in the order of their global numbers; and the pressures (Pa) in its
   place that have forces of a set, pressing on it, where any of its faces is of second order. Collective */
PETSC_INTERN PetscErrorCode PressureCreateForces(Model model, Vec *forces);
PETSC_INTERN PetscErrorCode PressureRecover(Model model, const char set[], Vec forces, PetscBool *recovered);

/* field.c - static.h5 and static.xmf */
PETSC_INTERN PetscErrorCode StaticsWriteFields(Statics statics, Results results);
