/*
   Pencil - the matrices of the system linearised about steady sliding

      M u'' + C u' + (K + mu H) u = 0

   M, K symmetric; C damping, and of parts that spin the skew gyroscopic matrix; H the unsymmetric friction part per
   unit friction coefficient; all are sums of fixed matrices with monomials of the parameters for coefficients. Where an
   interface obeys the exact constraint N u = 0, the pencil is the projection Zl' (.) Zr with N Zr = 0 and (N - mu T) Zl
   = 0; where displacements follow others (OperatorsGetDependents()), their Z is a factor of both. Without either Zl =
   Zr = identity, and nothing is projected.

   Materials whose stiffness depends on the eigenvalue (viscoelastic.h) make it a nonlinear problem,

      T(lambda) = lambda^2 M + lambda C + K + sum_j h_j(lambda) A_j,   h = G(lambda) - Re G(i w) - lambda Im G(i w) / w,

   A_j of such a part or matrix per unit of modulus: K and C have what G is at a reference frequency w (rad/s,
   PencilSetReference()), h_j the rest, zero there. Without a reference K is the static one, C has nothing of them.

   A pencil has a point p of its own, as a PETSc object has its values: matrices that are handed out are formed at p
   when they are asked for, in place where the pattern allows, so that many points cost no new symbolic work. It owns
   the terms of the contact; those of the bodies it shares with the operators. Whoever needs two pencils makes two.
*/
#pragma once

#include <squeal/operators.h>

typedef struct _p_Pencil *Pencil;

#define OPERATORS_MAX_FACTORS 5
#define OPERATORS_MAX_CAUSE   128 /* characters */

typedef enum { OPERATORS_STIFFNESS, OPERATORS_DAMPING, OPERATORS_MASS } OperatorsTermKind;

/* The friction coefficient of an interface at one sliding speed, as a factor of terms: a function of several
   parameters */
typedef struct {
  FrictionLaw law;                            /* of the scene */
  PetscInt    parameter[FRICTION_PARAMETERS]; /* index of each of the law's, -1: it is that of the scene */
  PetscInt    speed;                          /* index of the speed V of the interface, -1: it is that of the scene */
  PetscReal   ratio;                          /* v / V */
} OperatorsFriction;

/* The modulus G(lambda) of a material, a function of several parameters */
typedef struct {
  Viscoelastic law;                                /* of the scene */
  PetscInt     young;                              /* index of E, -1: it is that of the scene */
  PetscInt     parameter[VISCOELASTIC_PARAMETERS]; /* index of each value, -1 likewise */
} OperatorsLaw;

/* A part of the pencil whose coefficient is a monomial of parameters: c(p) A, c = scale * prod_i p_i^power_i, where
   |p_i| stands for p_i if absolute, mu or mu' where it is friction. K, C and M of the pencil are the sums of the terms
   of their kind. */
typedef struct {
  OperatorsTermKind kind;
  Mat               A;          /* in the unknowns of the pencil (borrowed); several terms may share one */
  PetscBool         frictional; /* vanishes without friction or spin; or an unsymmetric one of -terms */
  PetscBool         symmetric;  /* A is; never so for a frictional term */
  Mat       left, right;      /* A = left' right, a row for each pair (borrowed); NULL where A is not such a product */
  PetscInt  interface, group; /* these pairs: those of an interface in one group of the sliding state */
  PetscReal scale;
  PetscInt  n; /* factors */
  struct {
    PetscInt                 parameter; /* index; -1 of friction */
    PetscInt                 power;     /* not 0; of terms of a model 1 or -1 */
    PetscBool                absolute;
    const OperatorsFriction *friction; /* borrowed from the operators, NULL for none */
    PetscBool                slope;    /* mu' of it, else mu */
  } factor[OPERATORS_MAX_FACTORS];
  /* borrowed from the operators, NULL for none: of K and C, one more factor Re G(i reference), Im G(i reference) /
     reference; 0 without a reference; stiffened: |E + G|^2 / Re (E + G) - E in place of Re G */
  const OperatorsLaw *law;
  PetscReal           reference; /* rad/s */
  PetscBool           stiffened;
  PetscInt            constraint; /* of the friction of an exact contact: which of its left null spaces; else -1 */
  const char         *cause_kind; /* what the term is, in words, where it may make modes grow or decay */
  char                cause[OPERATORS_MAX_CAUSE]; /* the contact, option or matrix that it comes from */
  PetscInt            cause_index;                /* among those of PencilGetCauses() */
} OperatorsTerm;

/* One of the reasons why modes grow or decay */
typedef struct {
  /* "friction", "friction damping", "falling friction", "material damping", "dashpot", "bushing", "point", "spin",
     "follower force", "stiffness matrix", "damping matrix", "mass matrix" */
  const char *kind;
  char        name[OPERATORS_MAX_CAUSE]; /* of the contact, or of the option or matrix, e.g. pad_beta */
} PencilCause;

/* h(lambda) A beyond K and C, at the point of the pencil */
typedef struct {
  Mat          A; /* reference */
  PetscBool    symmetric;
  PetscReal    scale, reference; /* of A; rad/s, 0 for none */
  PetscComplex held; /* 0; share of G that is held at the reference, on the way of an eigenvalue from a problem there */
  Viscoelastic law;
  PetscComplex at; /* what K and i reference C have of G, Pa */
} PencilLaw;

/* Matrices of (lambda^2 M + lambda C + K) x = 0, friction included in K; borrowed. Where only friction makes K
   unsymmetric, and -operators_factors is not lu, K = K_even + left' right, K_even symmetric, left and right with a row
   for each closed pair; NULL else. */
typedef struct {
  Mat              K, C, M;   /* C is NULL without damping */
  PetscBool        symmetric; /* K, M (and C) symmetric */
  PetscBool        singular;  /* M is loaded and has no mass along some directions that are no unknowns */
  Mat              K_even, left, right;
  PetscBool        prefers_even; /* -operators_factors symmetric */
  PetscInt         n_laws;
  const PencilLaw *law; /* [n_laws] */
} PencilMatrices;

/* Matrices of all unknowns, before any projection: K + mu H, M, C; borrowed; C and H may be NULL. With -terms K is
   whole */
typedef struct {
  Mat       K, M, C, H;
  PetscReal mu; /* the largest friction coefficient in absolute value */
} PencilParts;

/* What a pencil is linearised about. Made by statics, by a sweep for groups of pairs, or by hand; a value that nobody
   else refers to. */
typedef struct {
  PetscInt  n_pairs;  /* local pairs */
  PetscInt  n_groups; /* groups that are closed at some points and open at others (penalty law only) */
  PetscInt *group;    /* [n_pairs] -1 open, 0 closed, g = 1 .. n_groups closed as far as the parameter closed_g is 1 */
  /* [n_pairs] of interfaces that hold by friction (-contact_kt): pairs at its limit, and those that -static_rows
     closed; NULL: all of them stick */
  PetscBool *slips;
  PetscBool  has_forces; /* alike on all ranks: lambda_n is known; else -contact_force counts */
  PetscReal *lambda_n;   /* [n_pairs] normal forces, N, for the friction damping */
  Mat        geometric;  /* stiffness of all unknowns that the stress adds, symmetric; NULL for none */
  Mat        follower;   /* that of forces that follow the surface, unsymmetric; NULL for none */
  PetscInt   n_parameters;
  PetscReal *p; /* [n_parameters] the point that it was made for; NULL: the values of the scene */
} SlidingState;

/*@ SlidingStateCreate - a state in which the local pairs have these groups (copied), without forces, preload or point;
    PETSc memory and references are put into the other fields directly. Not collective. @*/
PetscErrorCode SlidingStateCreate(PetscInt n_pairs, PetscInt n_groups, const PetscInt group[], SlidingState *state);

/*@ SlidingStateDestroy - frees what a state holds. Collective. @*/
PetscErrorCode SlidingStateDestroy(SlidingState *state);

/*@
   OperatorsLinearise - makes a pencil about a sliding state, or, where it is NULL, with all pairs closed. Its point is
   that of the state, or the scene, but that the total normal forces are those of the state where it has forces.
   Collective. The state may be destroyed; the operators are referenced until PencilDestroy().

   Errors: PETSC_ERR_USER_INPUT for an interface with friction of which nothing says along what it slides, nor how stiff
   it holds (-contact_kt), and for friction damping without a normal force; PETSC_ERR_SUP for groups with the exact
   constraint, and where it cannot be eliminated.
@*/
PetscErrorCode OperatorsLinearise(Operators operators, const SlidingState *state, Pencil *pencil);

/*@
   OperatorsLineariseBodies - makes the pencil of the bodies by themselves at a point p [parameters], NULL for that of
   the scene: every pair open, neither damping nor spin, and where they are to be `apart` no bushing between two sets.
   Materials whose stiffness depends on the frequency have that at the reference (PencilSetReference()), without loss.
   Bodies that share nodes, ties and rigid points stay one; supports and springs to the ground stay. Collective.
@*/
PetscErrorCode OperatorsLineariseBodies(Operators operators, const PetscReal p[], PetscBool apart, Pencil *bodies);

/*@ PencilGetTermsApart - matrices of stiffness and mass of the bodies apart at the present point, in all unknowns
    (borrowed, until PencilReleaseTerms(); the caller frees the list). Not collective. @*/
PetscErrorCode PencilGetTermsApart(Pencil pencil, PetscInt *n, Mat **terms);

/*@ PencilKeepApart - keeps what joins the bodies at the present point, so that PencilGetStiffnessApart() can be called
    after PencilReleaseTerms(). Collective. @*/
PetscErrorCode PencilKeepApart(Pencil pencil);

/*@ PencilGetStiffnessApart - K + less is the stiffness of the bodies apart in all unknowns, as
    OperatorsLineariseBodies() has it, but that nothing follows (borrowed; less is NULL where nothing joins them).
    Collective. Errors: PETSC_ERR_ARG_WRONGSTATE without PencilKeepApart(). @*/
PetscErrorCode PencilGetStiffnessApart(Pencil pencil, Mat *K, Mat *less);

/*@ PencilGetParameters - the parameters of the operators, then closed_1, closed_2, ... of the groups, and the present
    point (borrowed); pass NULL for what is not needed. Not collective. @*/
PetscErrorCode PencilGetParameters(Pencil pencil, PetscInt *n, const OperatorsParameter **parameters,
                                   const PetscReal **p);

/*@ PencilSetParameters - moves the pencil to another point p. Matrices got before are to be got again: the call that
    gets one writes the new values into the same matrix, or makes another one where a coefficient that was zero (mu,
    damping) is no more or has become zero. Collective.
    Errors: PETSC_ERR_USER_INPUT for a value outside the limits of its parameter. @*/
PetscErrorCode PencilSetParameters(Pencil pencil, const PetscReal p[]);

/*@ PencilGetTerms - the terms (borrowed), valid at any point. Collective at the first call. @*/
PetscErrorCode PencilGetTerms(Pencil pencil, PetscInt *n, const OperatorsTerm **terms);

/*@ OperatorsTermCoefficient - c(p) for the values p of all parameters. Not collective. @*/
PetscReal OperatorsTermCoefficient(const OperatorsTerm *term, const PetscReal p[]);

/*@ OperatorsTermDepends - whether c(p) contains a parameter. Not collective. @*/
PetscBool OperatorsTermDepends(const OperatorsTerm *term, PetscInt parameter);

/*@ OperatorsTermDerivative - the derivative of c(p) by one parameter. Not collective. @*/
PetscReal OperatorsTermDerivative(const OperatorsTerm *term, const PetscReal p[], PetscInt parameter);

/*@ OperatorsGetTerms - the terms of bodies, springs and dashpots, joints and superelements, in all unknowns (borrowed,
    until PencilReleaseTerms()). Not collective; after OperatorsSetUp(). @*/
PetscErrorCode OperatorsGetTerms(Operators operators, PetscInt *n, const OperatorsTerm **terms);

/*@ PencilGetCauses - the terms that may have a share in the growth of modes at the present point, those of one name
   as one. Valid after PencilReleaseTerms() too. Collective. @*/
PetscErrorCode PencilGetCauses(Pencil pencil, PetscInt *n, const PencilCause **causes);

/* An eigenvalue sigma + i omega, rad/s, omega > 0, and its right vector xr + i xi, of all unknowns, x^H M x = 1; xi is
   NULL for a real one */
typedef struct {
  PetscReal sigma, omega;
  Vec       xr, xi;
} PencilMode;

/*@
   PencilMeasureCauses - the shares of the causes in the growth of n eigenvalues, from the imaginary part of u^H
   (lambda^2 M + lambda C + K) u = 0. Their sum is sigma, but for what the residual of the eigenvector leaves.
   Collective. The mean energy E = omega D / 4, D = 2 omega u^H M u + Im u^H C u, is that of u = Re(u e^(i omega t)) at
   constant amplitude, twice the kinetic one; a cause of growth s feeds it with the power 2 E s.

   Input Parameter:
.  mode - [n] the eigenvalues
   Output Parameters:
+  growth - [n][causes of PencilGetCauses(), called before] 1/s
-  energy - [n] E, J, of displacements in m
@*/
PetscErrorCode PencilMeasureCauses(Pencil pencil, PetscInt n, const PencilMode mode[], PetscReal growth[],
                                   PetscReal energy[]);

/* What friction does at a pair, with the kinds of PencilCause for names */
typedef enum { PENCIL_FRICTION, PENCIL_FRICTION_DAMPING, PENCIL_FALLING_FRICTION, PENCIL_N_POWERS } PencilPower;

extern const char *const PencilPowerNames[PENCIL_N_POWERS];

/*@
   PencilMeasurePairPowers - the mean power that friction gives to the vibration u = Re(u e^(i omega t)) at each local
   pair, W: positive where it feeds the vibration. The sum over the pairs of a contact is 2 E times its share in the
   growth, both of PencilMeasureCauses(). Collective; PencilGetCauses() was called before.

   Input Parameters:
+  sigma, omega - the eigenvalue, 1/s and rad/s, omega > 0
-  ur, ui       - its right vector, of all unknowns, m; ui NULL for a real one
   Output Parameter:
.  power        - [local pairs][PENCIL_N_POWERS] W
@*/
PetscErrorCode PencilMeasurePairPowers(Pencil pencil, PetscReal sigma, PetscReal omega, Vec ur, Vec ui,
                                       PetscReal power[]);

/* Products of one term that may have a share, its coefficient included, with the vectors of a mode and of a second one:
   y_a' A x_b and y_a' A' x_b, without conjugation */
typedef struct {
  OperatorsTermKind kind;
  PetscBool         exact;                       /* friction of an exact contact, A from its left null space */
  PetscBool         friction;                    /* friction of a contact, which the whole term goes with */
  PetscReal         form[2];                     /* real and imaginary part of x_0^H A x_0 */
  PetscComplex      product[2][2], turned[2][2]; /* y_a' A x_b; y_a' A' x_b, of an exact contact as the first */
} PencilForms;

/* Right (xr + i xi) and left (yr + i yi) vectors of up to two modes, of all unknowns; xi, yi NULL for real ones */
typedef struct {
  PetscInt n;
  Vec      xr[2], xi[2], yr[2], yi[2];
} PencilVectors;

/*@ PencilMeasureForms - the products of each term that PencilGetCauses() lists, called before, as many as n says, with
    the loss that materials have at the eigenvalue lambda; the caller frees them. Collective. @*/
PetscErrorCode PencilMeasureForms(Pencil pencil, PetscComplex lambda, const PencilVectors *vectors, PetscInt *n,
                                  PencilForms **forms);

/*@
   PencilMeasureDerivatives - y' (dQ / dp_j) x, Q(lambda; p) = lambda^2 M + lambda C + K, for each parameter p_j, from
   which d lambda / d p_j = -y' (dQ / dp_j) x / (y' Q' x). Collective; not after PencilReleaseTerms().

   Input Parameters:
+  sigma, omega - lambda, 1/s and rad/s
-  vectors      - those of one mode
   Output Parameter:
.  derivative   - [parameters of PencilGetParameters()]
@*/
PetscErrorCode PencilMeasureDerivatives(Pencil pencil, PetscReal sigma, PetscReal omega, const PencilVectors *vectors,
                                        PetscComplex derivative[]);

/*@ PencilReleaseTerms - frees the terms of a model, those of the operators too, once all matrices at the present
   point are formed, but for those that PencilGetCauses() lists: without material damping half of the memory, where no
   other point will be asked for. Afterwards PencilSetParameters() and PencilGetTerms() raise
   PETSC_ERR_ARG_WRONGSTATE. Matrices that were loaded stay. Collective. @*/
PetscErrorCode PencilReleaseTerms(Pencil pencil);

/*@ PencilReleaseSymmetric - frees K_even, which is also K of PencilGetFrictionless(), once it has been factored;
   nothing before PencilReleaseTerms(), or without K_even. What was got before is gone; the next call for either makes
   it again, as K - left' right. Where `half` is given, the upper half of K_even - shift M (MATSEQSBAIJ, shift in
   (rad/s)^2), the pencil keeps a reference to it alone: K is freed as well, and both are made again from it.
   Collective. @*/
PetscErrorCode PencilReleaseSymmetric(Pencil pencil, Mat half, PetscReal shift);

/*@ PencilGetMatrices - the matrices with friction. Collective. @*/
PetscErrorCode PencilGetMatrices(Pencil pencil, PencilMatrices *matrices);

/*@ PencilGetFrictionless - the symmetric undamped matrices at mu = 0, of the same size. Collective. @*/
PetscErrorCode PencilGetFrictionless(Pencil pencil, PencilMatrices *matrices);

/*@ PencilGetParts - the matrices of all unknowns, friction apart. Collective. @*/
PetscErrorCode PencilGetParts(Pencil pencil, PencilParts *parts);

/*@ PencilLawAt - h(lambda) of a law, in the unit of its A, and its derivative; lambda in rad/s, Im lambda >= 0. Not
    collective. @*/
PetscComplex PencilLawAt(const PencilLaw *law, PetscComplex lambda, PetscComplex *slope);

/*@ OperatorsHaveLaws - the same of their parts and matrices. Not collective. @*/
PetscBool OperatorsHaveLaws(Operators operators);

/*@ OperatorsGetLaws - the laws of the bodies at p, NULL for the values of the scene: G(lambda) scale A beside the
    static stiffness. A is a reference; the caller frees each and the list. Collective. @*/
PetscErrorCode OperatorsGetLaws(Operators operators, const PetscReal p[], PetscInt *n, PencilLaw **law);

/*@ PencilHasLaws - whether stiffness depends on the eigenvalue. Not collective. @*/
PetscBool PencilHasLaws(Pencil pencil);

/*@ PencilGetReference - the frequency that PencilSetReference() set. Not collective. @*/
PetscReal PencilGetReference(Pencil pencil);

/*@ PencilCheckRange - raises PETSC_ERR_USER_INPUT where a law tells nothing for some of the frequencies range[0] to
    range[1], rad/s, which `option` asks for. Collective. @*/
PetscErrorCode PencilCheckRange(Pencil pencil, const char option[], const PetscReal range[2]);

/*@ PencilSetReference - the frequency, rad/s, at which K and C have all of such a stiffness; 0 for none. Matrices that
    were got before are to be got again. Collective; nothing without laws.
    Errors: PETSC_ERR_ARG_WRONGSTATE for another one after PencilReleaseTerms(). @*/
PetscErrorCode PencilSetReference(Pencil pencil, PetscReal omega);

/*@ PencilGetMass - the mass matrix of all unknowns (borrowed). Collective. @*/
PetscErrorCode PencilGetMass(Pencil pencil, Mat *M);

/* Closed pairs over all ranks, those of groups included; of these, in interfaces that hold by friction (-contact_kt),
   those that stick, and those at the limit of friction */
typedef struct {
  PetscInt n, n_stick, n_limit;
} PencilClosed;

/*@ PencilGetClosed - the closed pairs, and whether a sliding state told so. Collective. @*/
PetscErrorCode PencilGetClosed(Pencil pencil, PencilClosed *closed, PetscBool *from_state);

/*@ PencilExpand - unknowns of the pencil to all unknowns, u = Zr q (or Zl q for a left vector). Collective. @*/
PetscErrorCode PencilExpand(Pencil pencil, PetscBool left, Vec q, Vec u);

/*@ PencilProjectForce - a force f on all unknowns, N, to the equations of the pencil, g = Zl' f; or to those of the
    transposed problem, g = Zr' f. Collective. @*/
PetscErrorCode PencilProjectForce(Pencil pencil, PetscBool transposed, Vec f, Vec g);

/*@ PencilRestrict - the inverse of PencilExpand() for a vector that obeys the constraints. Collective. @*/
PetscErrorCode PencilRestrict(Pencil pencil, Vec u, Vec q);

/*@ PencilGetOperators - what it was made from (borrowed). Not collective. @*/
PetscErrorCode PencilGetOperators(Pencil pencil, Operators *operators);

/*@ PencilSave - writes the matrices into the folder of -operators_save. Collective. @*/
PetscErrorCode PencilSave(Pencil pencil);

/*@ PencilSaveLoad - writes a force f on all unknowns, N, as F.bin beside the matrices, Zl' f where these are of the
    unknowns that constraints leave. Collective. @*/
PetscErrorCode PencilSaveLoad(Pencil pencil, Vec f);

/*@ PencilView - sizes and kinds in words. Collective. @*/
PetscErrorCode PencilView(Pencil pencil, PetscViewer viewer);

/*@ PencilDestroy - frees the pencil. Collective. @*/
PetscErrorCode PencilDestroy(Pencil *pencil);
