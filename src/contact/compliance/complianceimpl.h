/* Private to contact/compliance/. All in metres: l = lambda / kappa per pair, v = r less slip0 along the tangents. */
#pragma once

#include "compliance.h"
#include "kernels/contact/coulomb.h"

#include <petscblaslapack.h>

/* Natural map of all pairs at l, v */
typedef struct {
  PetscReal largest; /* of one pair, m */
  PetscReal norm;    /* root of the sum of squares, m */
  PetscReal scale;   /* largest l */
  PetscReal noise;   /* rounding of v at closed pairs */
  PetscInt  worst;   /* pair of `largest` */
} ComplianceMiss;

#define COMPLIANCE_MIXED 12   /* differences of iterates that are combined */
#define COMPLIANCE_WEAK  300. /* slip over friction of a pair that chord.c gives no index across its slip */

/* Whether a pair has mu(0), as it rests, in a step (step.c) */
typedef enum { HOLD_NONE, HOLD_RESTS, HOLD_RELEASED } ComplianceHold;

/* A pair as chord.c holds it */
typedef struct {
  PetscReal e[2], mu, c; /* direction of slip; friction coefficient; slip over friction, 0 sticks */
} ComplianceFrame;

/* Factors of a base set of indices (chord.c), four of each pair */
typedef struct {
  PetscBool        exists;
  PetscInt         m, *index, room;   /* of the base, ascending, [m]; that there is room for */
  ComplianceFrame *frame;             /* [n] */
  PetscReal       *LU;                /* [m][m]; */
  PetscBool        single;            /* or float [m][m] in its place, and work behind them (chord/single.c) */
  PetscReal       *row;               /* [m][3] directions of the rows of the base, */
  PetscInt        *at;                /* [m] and where the displacements of their pairs begin */
  PetscBLASInt    *small;             /* pivots of S */
  PetscInt        *place, *column;    /* of an index: in the base, in V; -1 where it is not there, [4 n] */
  PetscInt         most, n_columns;   /* columns that V may hold, and has */
  PetscReal       *V, *S;             /* [n_columns][m] A0^-1 of columns; Schur complement */
  PetscInt         n_border, *border; /* indices that joined or left; -1: not factored */
  PetscInt        *want, *next;       /* work: [4 n] */
  PetscReal       *b, *s, *z;         /* work: [4 n] */
  PetscInt         n_mixed;           /* differences kept in this step, -1: no iterate before */
  PetscReal       *x, *f;             /* iterate before, and how G changes it, [3 n] */
  PetscReal       *basis, *step;      /* differences of f, orthonormal, and of x + f, [COMPLIANCE_MIXED][3 n] */
} ComplianceChord;

/* W in 16 bits (chord/near.c) */
typedef struct {
  PetscInt   n;            /* of tiles in a row */
  int16_t   *tile;         /* NULL before it is asked for */
  float     *scale;        /* m/N, of each tile */
  PetscBool *moves;        /* work: rows of tiles that change, [n] */
  float     *x, *y;        /* work: change of the forces, what it moves */
  PetscReal  spread;       /* m/N: what an entry is off by in the mean */
  PetscReal  error;        /* m: what v is off by at most, 0 after a whole product */
  PetscBool  stands;       /* there is a whole product: */
  PetscReal *from, *moved; /* forces, N, and what they move, m, [3 n] */
  PetscReal *diagonal;     /* of W then, [3 n] */
} ComplianceNear;

/* Newton's method on motions (dual.c); rows are of the motions that are free */
typedef struct {
  PetscBool  tried;
  PetscReal *V;            /* W^-1, N/m, [3 n][3 n], NULL before it is asked for and where W is nearly singular */
  PetscInt   n_rows, *at;  /* pair of a row, [3 n] */
  PetscReal *along, *test; /* direction of its motion; what of V dv at the pair its equation takes; [3 n][3] */
  PetscReal *own, *x;      /* its motion in its equation; right-hand side, then its motion, m; [3 n] */
  PetscReal *dv, *force;   /* [3 n] m; V dv, N */
} ComplianceDual;

/* Laws in series with the pairs (spring.c) */
typedef struct {
  PairSpring  *law;          /* [n], NULL where contact is exact */
  PetscBool    curved, laid; /* some are not linear; lines are tangents at forces */
  SpringLine  *line;         /* [n] */
  PetscReal   *at;           /* [n] closings at which the lines were tangents, m */
  SpringPoint *point;        /* [n] */
  PetscReal   *W, *diagonal; /* [3 n][3 n] with the lines, m/N; [n] without, normal */
  PetscReal   *q;            /* work: [3 n] */
} ComplianceSprings;

/* GMRES where W is a map (krylov.c) */
typedef struct {
  ComplianceMap map;                   /* move NULL where W is a matrix */
  PetscBool    *held;                  /* [3 n] directions that map.press() was prepared for */
  PetscBool     stands;                /* it was */
  PetscInt      n_first;               /* iterations that were enough then; 0: none yet */
  PetscInt      n_more;                /* that were needed beyond these since then */
  PetscInt      n_released, *released; /* directions held that nobody wants, [3 n] */
  PetscReal    *motion;                /* work: [3 n] m, */
  PetscReal    *force;                 /* and N */
} ComplianceKrylov;

struct _p_ContactCompliance {
  PetscInt          n;
  const PetscReal  *W;        /* NULL where it is a map */
  PetscReal        *kappa;    /* N/m, [n] */
  FrictionLaw      *friction; /* [n] */
  PetscReal        *mu;       /* [n] at the stated speed */
  PetscBool        *varies;   /* [n] with the slip speed */
  PetscBool        *rests;    /* [n] those that vary, at the end of the step before */
  ComplianceHold   *hold;     /* [n] */
  PetscReal         weight;   /* a: statuses are decided by l - a v */
  PetscReal         dt, rtol;
  PetscReal        *free;    /* v without forces, [n][3] */
  PetscReal        *l, *v;   /* now, [n][3] */
  PetscReal        *l0, *v0; /* before a step of Newton's method */
  PetscReal        *slip;    /* gaps and slips of the last step, m, [n][3] */
  PetscReal        *best;    /* l of the least residual, [n][3] */
  PetscReal        *force;   /* work: forces or displacements, [n][3] */
  PetscInt         *carries; /* work: columns of W with a force, [3 n] */
  ContactStatus    *status;  /* [n] */
  CoulombLaw       *law;     /* [n], of closed pairs, in the frame of each (linear.c) */
  PetscReal        *slide;   /* e, [n][2], of pairs that slide */
  PetscInt          n_closed, *closed;
  PetscInt         *row;     /* first row of each closed pair in A, and after the last, [n + 1] */
  PetscReal         blend;   /* t: (1 - t) W kappa + t I stands for W kappa */
  PetscReal        *A, *rhs; /* [rows][rows] of closed pairs and a border, [rows] */
  PetscBLASInt     *pivot;
  PetscBool         exchanged; /* rows of A in its factors */
  PetscInt          n_room;    /* rows that there is room for */
  ComplianceSprings springs;
  ComplianceChord   chord;
  ComplianceNear    near;
  ComplianceDual    dual;
  ComplianceKrylov  krylov;
  ComplianceReport  report, totals;
};

static inline PetscBool ComplianceIsMap(const ContactCompliance c)
{
  return c->krylov.map.move ? PETSC_TRUE : PETSC_FALSE;
}

/* Compliance of a pair alone along its tangents, times kappa: the mean of both */
static inline PetscReal ComplianceTangent(const ContactCompliance c, PetscInt p)
{
  const PetscInt N = 3 * c->n;

  return 0.5 * c->kappa[p] * (c->W[(3 * p + 1) * (N + 1)] + c->W[(3 * p + 2) * (N + 1)]);
}

/* law.c - v at l; y += W times the forces at l; its natural map; the pair with its coefficient of friction at the
   present slip, w = -weight v; statuses that l, v ask for */
PETSC_INTERN PetscErrorCode ComplianceMove(ContactCompliance c);
PETSC_INTERN void           ComplianceAddMotion(ContactCompliance c, PetscReal y[]);
PETSC_INTERN void           ComplianceMeasure(const ContactCompliance c, ComplianceMiss *miss);
PETSC_INTERN PetscBool      ComplianceIsSolved(const ContactCompliance c, const ComplianceMiss *miss);
PETSC_INTERN void           ComplianceChoose(ContactCompliance c);
PETSC_INTERN void           ComplianceTurn(const ContactCompliance c, PetscInt p, PetscReal d[2]);
PETSC_INTERN CoulombPair    ComplianceGetPair(const ContactCompliance c, PetscInt p, PetscReal weight, PetscReal w[3]);

/* linear.c - the laws of the closed pairs at the present l, v; x [3] along the rows of closed pair k; l as these laws
   have it, and the right-hand side; that and the matrix, row[n_closed] rows and the border; its factors, without
   exchange of rows where these are good and with it */
PETSC_INTERN void ComplianceLinearise(ContactCompliance c);
PETSC_INTERN void ComplianceAlongRows(const ContactCompliance c, PetscInt k, const PetscReal x[], PetscReal y[]);
PETSC_INTERN PetscErrorCode ComplianceBegin(ContactCompliance c, PetscInt border);
PETSC_INTERN PetscErrorCode ComplianceAssemble(ContactCompliance c, PetscInt border);
PETSC_INTERN void           ComplianceFactorFast(ContactCompliance c, PetscInt rows, PetscBool *good);
PETSC_INTERN PetscErrorCode ComplianceFactor(ContactCompliance c, PetscInt rows, PetscBool *singular);
PETSC_INTERN void           ComplianceShift(ContactCompliance c, PetscInt border);
PETSC_INTERN PetscErrorCode ComplianceBackSolve(const ContactCompliance c, PetscInt rows, PetscReal x[]);
PETSC_INTERN void           ComplianceTake(ContactCompliance c);

/* dual.c - whether a step of Newton's method at the present statuses is cheaper on motions; that step where it is, into
   rhs */
PETSC_INTERN PetscErrorCode ComplianceDualServes(ContactCompliance c, PetscBool *serves);
PETSC_INTERN PetscErrorCode ComplianceDualSolve(ContactCompliance c, PetscBool *solved);
PETSC_INTERN PetscErrorCode ComplianceDualDestroy(ContactCompliance c);

/* krylov.c - a step of Newton's method at the laws of the closed pairs into rhs, by GMRES; what memory.c keeps */
PETSC_INTERN PetscErrorCode ComplianceKrylovSolve(ContactCompliance c);
PETSC_INTERN PetscErrorCode ComplianceKrylovHold(ContactCompliance c, const PetscBool held[]);

/* chord/base.c - the base becomes chord.index [m] with chord.frame; those of the present l, v; A0^-1 times the columns
   that indices [n] add, not good where the store has no room; the border for the present statuses; A dz against what
   its rows miss, dz [4 n] */
PETSC_INTERN PetscErrorCode ComplianceChordSetBase(ContactCompliance c);
PETSC_INTERN PetscErrorCode ComplianceChordRenew(ContactCompliance c);
PETSC_INTERN PetscErrorCode ComplianceChordColumns(ContactCompliance c, PetscInt n, const PetscInt index[],
                                                   PetscBool *good);
PETSC_INTERN PetscErrorCode ComplianceChordBorder(ContactCompliance c, PetscBool *good);
PETSC_INTERN PetscErrorCode ComplianceChordSolve(ContactCompliance c, PetscReal dz[]);

/* step.c - stiffness and weight of the pairs by W; one step on W as it is; adds the report of a step to that of all,
   whose route is the last resort that any step took */
PETSC_INTERN PetscErrorCode ComplianceSetScales(ContactCompliance c);
PETSC_INTERN PetscErrorCode ComplianceSolveLines(ContactCompliance c, const PetscReal q[], const PetscReal slip0[],
                                                 PetscReal lambda[]);

PETSC_INTERN void ComplianceReportStep(ContactCompliance c);

/* spring.c - a step with laws in series; the closing of a pair's line at l, m, 0 where contact is exact; tangents on
   the diagonal of W, or the lines again; lines laid at closings [n], m */
PETSC_INTERN PetscErrorCode ComplianceSolveSprings(ContactCompliance c, const PetscReal q[], const PetscReal slip0[],
                                                   PetscReal lambda[]);
PETSC_INTERN PetscReal      ComplianceLineClosing(const ContactCompliance c, PetscInt p);
PETSC_INTERN void           ComplianceSetTangents(ContactCompliance c, PetscBool tangents);
PETSC_INTERN PetscErrorCode ComplianceLayAt(ContactCompliance c, const PetscReal at[]);
PETSC_INTERN PetscErrorCode ComplianceDestroySprings(ContactCompliance c);

/* chord/near.c - whether W is so large that its iterations have v by changes of the forces and few bytes of it; v at l
   and its natural map in that way; a whole product that was kept, of the diagonal that W has */
PETSC_INTERN PetscBool      ComplianceNearServes(const ContactCompliance c);
PETSC_INTERN PetscErrorCode ComplianceNearMove(ContactCompliance c, ComplianceMiss *miss);
PETSC_INTERN PetscErrorCode ComplianceNearTake(ContactCompliance c, const PetscReal from[], const PetscReal moved[]);
PETSC_INTERN PetscErrorCode ComplianceNearDestroy(ContactCompliance c);

/* chord.c - Newton's method with factors of the steps before */
PETSC_INTERN PetscErrorCode ComplianceChordIterate(ContactCompliance c, ComplianceMiss *miss);

/* lu.c - LU factors of A [n][n] in its place: smallest pivot over the largest; x := A^-1 x; the same of columns [n],
   bitwise alike; y += the columns of W times x, both [n], columns of N; y += W x */
PETSC_INTERN PetscReal ComplianceLUFactor(PetscInt n, PetscReal A[]);
PETSC_INTERN void      ComplianceLUSolve(PetscInt n, const PetscReal LU[], PetscReal x[]);
PETSC_INTERN void      ComplianceLUSolveColumns(PetscInt n, const PetscReal LU[], PetscInt columns, PetscReal X[]);
PETSC_INTERN void      ComplianceAddColumns(PetscInt N, const PetscReal W[], PetscInt n, const PetscInt column[],
                                            const PetscReal x[], PetscReal y[]);
PETSC_INTERN void      ComplianceAddSymmetric(PetscInt N, const PetscReal W[], const PetscReal x[], PetscReal y[]);

/* chord/single.c - factors in single precision; X := A0^-1 X of columns of the base, at most `most`, in either one */
PETSC_INTERN PetscReal ComplianceSingleFactor(PetscInt n, float A[]);
PETSC_INTERN void      ComplianceChordBaseSolve(const ContactCompliance c, PetscInt columns, PetscReal X[]);

/* mix.c - l = G(x) becomes a combination of it and what the iterations before made of theirs */
PETSC_INTERN void ComplianceMix(ContactCompliance c, PetscReal x[]);

/* newton.c - iterations, at most max_it; damped = with a line search; steps on what is solved, until friction is along
   slip */
PETSC_INTERN PetscErrorCode ComplianceIterate(ContactCompliance c, PetscBool damped, PetscInt max_it,
                                              ComplianceMiss *miss);
PETSC_INTERN PetscErrorCode ComplianceRefine(ContactCompliance c, ComplianceMiss *miss);

/* A point and its tangent */
typedef struct {
  PetscReal *l, x;           /* accepted */
  PetscReal *ahead, x_ahead; /* predicted */
  PetscReal *tangent, t_x;   /* unit length */
  PetscReal  cost;           /* cubes of unknowns factored so far */
  PetscReal  size;           /* |l| of the accepted point */
  PetscInt   sign;           /* of the determinant */
} CompliancePath;

/* pathpoint.c - t at x; |l|; the system at the present l, v, x, factored, and how far ahead of the plane that is; point
   and tangent from one path to another; takes the point, with its tangent; cosine of two tangents; the point at a
   distance */
PETSC_INTERN PetscErrorCode CompliancePathCreate(ContactCompliance c, CompliancePath *path);
PETSC_INTERN PetscErrorCode CompliancePathDestroy(CompliancePath *path);
PETSC_INTERN PetscReal      CompliancePathBlend(PetscReal x);
PETSC_INTERN PetscReal      CompliancePathNorm(const ContactCompliance c, const PetscReal l[]);
PETSC_INTERN PetscErrorCode CompliancePathFactor(ContactCompliance c, const CompliancePath *path, PetscReal x,
                                                 PetscReal *ahead, PetscBool *singular);
PETSC_INTERN PetscErrorCode CompliancePathCopy(ContactCompliance c, const CompliancePath *from, CompliancePath *to);
PETSC_INTERN PetscErrorCode CompliancePathTangent(ContactCompliance c, CompliancePath *path, PetscReal x);
PETSC_INTERN PetscReal      CompliancePathAlong(const ContactCompliance c, const CompliancePath *path,
                                                const CompliancePath *before);
PETSC_INTERN void           CompliancePathPredict(const ContactCompliance c, CompliancePath *path, PetscReal step);

/* path.c - from W kappa = I */
PETSC_INTERN PetscErrorCode ComplianceFollow(ContactCompliance c, ComplianceMiss *miss);
