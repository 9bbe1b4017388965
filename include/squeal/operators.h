/*
   Operators - the matrices of the system linearised about steady sliding

      M u'' + C u' + (K + mu H) u = 0

   M, K symmetric; C damping; H the unsymmetric friction part per unit friction coefficient. They are assembled from a
   model and its contact, or loaded, or given densely. Where an interface obeys the exact constraint N u = 0, the
   pencil is the projection Zl' (.) Zr with N Zr = 0 and (N - mu T) Zl = 0; without constraints Zl = Zr = identity,
   and nothing is projected.
*/
#pragma once

#include <squeal/contact.h>

typedef struct _p_Operators *Operators;

#define OPERATORS_MAX_FACTORS 5

/* A number of the scene that the matrices depend on, named like the option that sets it (pad_young, contact_mu) */
typedef struct {
  char        name[128];
  const char *unit;
  PetscReal   value;
  PetscReal   lower, upper; /* lower < value < upper; -infinity, infinity where there is no limit */
  PetscBool   closed;       /* lower itself is a value: alpha, beta, stiffness, viscosity, force may be 0 */
  PetscBool   body;         /* of parts, springs or dashpots, not of a contact */
  PetscBool   internal;     /* no option of the scene: the status of a group of pairs, see OperatorsSetClosed() */
} OperatorsParameter;

typedef enum { OPERATORS_STIFFNESS, OPERATORS_DAMPING, OPERATORS_MASS } OperatorsTermKind;

/* A part of the pencil whose coefficient is a monomial of parameters: c(p) A, c = scale * prod_i p_i^power_i, where
   |p_i| stands for p_i if absolute. K, C and M of the pencil are the sums of the terms of their kind. */
typedef struct {
  OperatorsTermKind kind;
  Mat               A;          /* in the unknowns of the pencil (borrowed); several terms may share one */
  PetscBool         frictional; /* vanishes without friction */
  PetscBool         symmetric;  /* A is; never so for a frictional term */
  PetscReal         scale;
  PetscInt          n; /* factors */
  struct {
    PetscInt  parameter; /* index */
    PetscInt  power;     /* 1 or -1 */
    PetscBool absolute;
  } factor[OPERATORS_MAX_FACTORS];
} OperatorsTerm;

/* Matrices of (lambda^2 M + lambda C + K) x = 0, friction included in K; borrowed */
typedef struct {
  Mat       K, C, M;   /* C is NULL without damping */
  PetscBool symmetric; /* K, M (and C) symmetric */
} OperatorsPencil;

/*@ OperatorsCreate - makes empty operators. Collective. @*/
PetscErrorCode OperatorsCreate(MPI_Comm comm, Operators *operators);

/*@ OperatorsSetModel - takes the matrices from a model and its contact. Collective. @*/
PetscErrorCode OperatorsSetModel(Operators operators, Model model, Contact contact);

/*@
   OperatorsSetFromOptions - reads where the matrices come from and go to. Collective.

   Options Database Keys:
+  -operators_load_k, _m, _c, _h <file>  - PETSc binary matrices; K and M are required together
.  -operators_dense_k, _m, _c, _h <list> - small dense matrices inline, rows one after another
.  -operators_mass <consistent|lumped>   - mass matrix of a model
.  -contact_mu <mu>                      - friction coefficient of K + mu H for loaded or dense matrices
-  -operators_save <dir>                 - write K.bin, M.bin and, where there are any, C.bin and H.bin; with the
contact
                                          constraint the projected matrices, friction included in K.bin and M.bin
@*/
PetscErrorCode OperatorsSetFromOptions(Operators operators);

/*@ OperatorsHaveMatrices - whether matrices are loaded or given densely, so that no model is needed. Not collective.
    @*/
PetscErrorCode OperatorsHaveMatrices(Operators operators, PetscBool *have);

/*@ OperatorsSetUp - assembles or loads the matrices. Collective. @*/
PetscErrorCode OperatorsSetUp(Operators operators);

/*@ OperatorsGetSave - whether -operators_save is given. Not collective. @*/
PetscErrorCode OperatorsGetSave(Operators operators, PetscBool *save);

/*@ OperatorsSave - writes the matrices at the present values of the parameters where -operators_save asks for it.
    Collective. @*/
PetscErrorCode OperatorsSave(Operators operators);

/*@ OperatorsGetMatrices - K, M, C, H of all unknowns (borrowed; C and H may be NULL) at the present values of the
    parameters, and mu, the largest friction coefficient in absolute value; pass NULL for what is not needed.
    Collective. @*/
PetscErrorCode OperatorsGetMatrices(Operators operators, Mat *K, Mat *M, Mat *C, Mat *H, PetscReal *mu);

/*@ OperatorsGetPencil - the pencil with friction at the present values of the parameters. Collective.
    Errors: PETSC_ERR_USER_INPUT for an interface with friction of which nothing says along what it slides, and for
    friction damping without a normal force; so does OperatorsGetTerms(). @*/
PetscErrorCode OperatorsGetPencil(Operators operators, OperatorsPencil *pencil);

/*@
   OperatorsGetParameters - the numbers that the matrices depend on, in the order of the scene: of each part young (Pa),
   density (kg/m^3), alpha (1/s), beta (s); of each list of springs stiffness (N/m), of dashpots viscosity (N s/m), with
   _x, _y, _z appended where the components that are not zero differ; of each contact mu, kn (N/m, penalty), and with
   friction damping mu_slope (s/m), force (N) and speed (m/s), or rotation (rad/s) where that is what was given;
   contact_mu for loaded or dense matrices with H (borrowed; values are the present ones). An interface of
   which nothing says along what it slides has no mu; internal parameters follow last. Not collective.
@*/
PetscErrorCode OperatorsGetParameters(Operators operators, PetscInt *n, const OperatorsParameter **parameters);

/*@ OperatorsCheckParameter - raises PETSC_ERR_USER_INPUT for a value outside the limits of its parameter, naming both.
    Collective. @*/
PetscErrorCode OperatorsCheckParameter(Operators operators, PetscInt parameter, PetscReal value);

/*@ OperatorsSetParameters - gives all parameters new values; the matrices and pencils follow. Those got before are to
    be got again: the call that gets one writes the new values into the same matrix, or makes another one where a
    coefficient that was zero (mu, damping) is no more or has become zero. Collective.
    Errors: PETSC_ERR_USER_INPUT for a value outside the limits of its parameter. @*/
PetscErrorCode OperatorsSetParameters(Operators operators, const PetscReal value[]);

/*@ OperatorsGetYoung - the present Young's modulus of a part, Pa. Not collective. @*/
PetscErrorCode OperatorsGetYoung(Operators operators, PetscInt part, PetscReal *young);

/*@ OperatorsGetDensity - the present density of a part, kg/m^3. Not collective. @*/
PetscErrorCode OperatorsGetDensity(Operators operators, PetscInt part, PetscReal *density);

/*@ OperatorsGetDamping - the present Rayleigh factors of a part: C = alpha M (1/s) + beta K (s). Not collective. @*/
PetscErrorCode OperatorsGetDamping(Operators operators, PetscInt part, PetscReal *alpha, PetscReal *beta);

/*@ OperatorsGetTerms - the terms of the pencil (borrowed), valid for any values of the parameters. Collective at the
    first call. @*/
PetscErrorCode OperatorsGetTerms(Operators operators, PetscInt *n, const OperatorsTerm **terms);

/*@ OperatorsTermCoefficient - c(p) for the values p of all parameters. Not collective. @*/
PetscReal OperatorsTermCoefficient(const OperatorsTerm *term, const PetscReal p[]);

/*@ OperatorsTermDerivative - the derivative of c(p) by one parameter. Not collective. @*/
PetscReal OperatorsTermDerivative(const OperatorsTerm *term, const PetscReal p[], PetscInt parameter);

/*@ OperatorsGetFrictionless - the symmetric undamped pencil at mu = 0, of the same size. Collective. @*/
PetscErrorCode OperatorsGetFrictionless(Operators operators, OperatorsPencil *pencil);

/*@ OperatorsGetBodies - the stiffness of parts and springs alone, without contact; symmetric (borrowed). Collective.
 * @*/
PetscErrorCode OperatorsGetBodies(Operators operators, Mat *K);

/*@ OperatorsGetInterface - friction coefficient and stiffness per pair (N/m, infinite for the constraint) of an
    interface at the present values of the parameters. Not collective. @*/
PetscErrorCode OperatorsGetInterface(Operators operators, PetscInt interface, PetscReal *mu, PetscReal *kn);

/*@
   OperatorsSetClosed - which pairs of the contact take part; all of them until this is called. Terms, parameters and
   pencils got before are void; the parameters of the scene keep their places and values. Collective.

   Input Parameters:
+  n_groups - groups of pairs that are closed at some values of the parameters and open at others (penalty law only)
-  group    - of each local pair: -1 open, 0 closed, g = 1 .. n_groups closed as far as the parameter closed_g is 1;
              these parameters come last and are 1 until OperatorsSetParameters(); NULL for all closed
   Errors: PETSC_ERR_SUP for groups with the exact constraint.
@*/
PetscErrorCode OperatorsSetClosed(Operators operators, PetscInt n_groups, const PetscInt group[]);

/*@ OperatorsSetPreload - further stiffness of the sliding state in all unknowns: symmetric geometric stiffness, and the
    unsymmetric one of forces that follow the surface; NULL for none. They stay until the next call, and take effect at
    the next OperatorsSetClosed(). Collective. @*/
PetscErrorCode OperatorsSetPreload(Operators operators, Mat geometric, Mat follower);

/*@ OperatorsInternalForces - K_e u_e of all elements, summed over this rank's cells and then over ranks, N, into a
   local vector of three values per vertex in the layout of the coordinates, held directions included: at a support they
   are its reaction. Springs and contact are no part of it. Collective. @*/
PetscErrorCode OperatorsInternalForces(Operators operators, Vec u, Vec local);

/*@ OperatorsApplyBodies - f = K u of parts and springs, N, element by element: without the rounding of the assembled
    matrix in rigid translations. Collective. @*/
PetscErrorCode OperatorsApplyBodies(Operators operators, Vec u, Vec f);

/*@ OperatorsExpand - unknowns of the pencil to all unknowns, u = Zr q (or Zl q for a left vector). Collective. @*/
PetscErrorCode OperatorsExpand(Operators operators, PetscBool left, Vec q, Vec u);

/*@ OperatorsRestrict - the inverse of OperatorsExpand() for a vector that obeys the constraints. Collective. @*/
PetscErrorCode OperatorsRestrict(Operators operators, Vec u, Vec q);

/*@ OperatorsCreateVec - a vector of all unknowns. Collective. @*/
PetscErrorCode OperatorsCreateVec(Operators operators, Vec *u);

/*@ OperatorsGetModel - the model and contact, NULL for loaded matrices (borrowed). Not collective. @*/
PetscErrorCode OperatorsGetModel(Operators operators, Model *model, Contact *contact);

/*@ OperatorsView - sizes and kinds in words. Collective. @*/
PetscErrorCode OperatorsView(Operators operators, PetscViewer viewer);

/*@ OperatorsDestroy - frees the operators. Collective. @*/
PetscErrorCode OperatorsDestroy(Operators *operators);
