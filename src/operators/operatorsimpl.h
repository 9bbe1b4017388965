/* Private to operators/: the record of the operators */
#pragma once

#include "operators/terms/terms.h"
#include <squeal/options.h>
#include <squeal/quantity.h>

#define MATRIX_LARGEST 1e60 /* of entries and parameters, so that products of several stay finite */

/* The four matrices, in the order of their option names */
typedef enum { OPERATOR_K, OPERATOR_M, OPERATOR_C, OPERATOR_H, N_OPERATORS } OperatorKind;

/* Parameters of each part; they come first and in this order */
typedef enum { PART_YOUNG, PART_DENSITY, PART_ALPHA, PART_BETA, N_PART_PARAMETERS } PartParameter;

/* Sums of the terms of the bodies */
typedef enum { BODIES_K, BODIES_M, BODIES_C, N_BODIES_SUMS } BodiesSum;

/* Indices of the parameters of an interface, -1 where there is none */
typedef struct {
  PetscInt  law[FRICTION_PARAMETERS], pressure[PRESSURE_PARAMETERS];
  PetscInt  kn, kt, force, speed, wear[2];
  PetscReal stated;   /* V of the scene: its speed, m/s, or rate of rotation, rad/s */
  PetscReal range[2]; /* least and most sliding speed of its pairs, of V */
  /* sliding speeds at which mu is a factor of terms, 0 where nothing says along what it slides */
  PetscInt           n_nodes;
  OperatorsFriction *node; /* [n_nodes] */
} InterfaceParameters;

/* Indices of the parameters of a bushing or point, -1 where there is none */
typedef struct {
  PetscInt stiffness[6], viscosity[6], mass;
} JointParameters;

/* Indices of the sizes of a load, -1 where there is none: |F| or a pressure, |M| */
typedef struct {
  PetscInt force, moment;
} LoadParameters;

/* -operators_factors */
typedef enum { OPERATORS_AUTO, OPERATORS_LU, OPERATORS_EVEN } OperatorsFactors;

struct _p_Operators {
  MPI_Comm comm;
  Model    model; /* NULL for loaded or dense matrices */
  Contact  contact;
  /* set by options */
  char                    load[N_OPERATORS][PETSC_MAX_PATH_LEN], save[PETSC_MAX_PATH_LEN];
  int                     save_lock; /* descriptor of that folder while this run writes into it; 0 and below: none */
  PetscReal              *dense[N_OPERATORS];   /* [n_dense] entries of -operators_dense_k and the like, by rows */
  PetscInt                n_dense[N_OPERATORS]; /* entries given: the square of the number of unknowns; 0 for none */
  PetscBool               lump, omit;
  OperatorsFactors        factors;
  PetscReal               loaded_mu; /* -contact_mu of loaded or dense matrices */
  PetscInt                n_named;   /* matrices of -terms */
  struct _p_MatrixTerm   *named;
  PetscInt                n_superelements, n_pieces; /* pieces stand behind those of which they are */
  struct _p_Superelement *superelements;
  char                    nodes[PETSC_MAX_PATH_LEN]; /* -operators_nodes */
  struct _p_Cloud        *cloud;                     /* their points, NULL without */
  /* built by OperatorsSetUp() */
  Parameters           parameters;     /* at the values of the scene */
  PetscInt             wear_time;      /* parameter, -1 for none */
  PetscInt             mu;             /* parameter of loaded matrices that is a friction coefficient, -1 for none */
  InterfaceParameters *interface;      /* of each interface */
  LoadParameters      *load_size;      /* of each load */
  JointParameters     *joint;          /* of each bushing, then of each point */
  PetscInt             n_local;        /* the first parameters are those of parts, springs and dashpots */
  PetscInt            *thickness;      /* [parts] parameter of a layer, -1 for others; NULL for loaded matrices */
  PetscInt            *spin_of_part;   /* [parts] parameter, -1 for parts without; NULL for loaded matrices */
  Terms                spin;           /* of spinning parts, for pencils; made when the first one asks */
  PetscInt             n_laws;         /* of materials whose stiffness depends on the eigenvalue */
  OperatorsLaw       **law;            /* [n_laws] */
  Terms                terms;          /* of the bodies, in all unknowns; with loaded matrices friction too */
  PetscBool            mass_singular;  /* loaded: there is no mass along some directions that are no unknowns */
  PetscBool            symmetric;      /* K, M and C are symmetric without friction; always true for a model */
  Mat                  Z, E;           /* u = Z q, q = E'u where some displacements follow others; else NULL */
  PetscBool           *follows;        /* [unknowns of this rank] which ones do */
  char                 dependent[160]; /* the option that makes them follow */
  /* formed when asked for */
  TermsSum sum[N_BODIES_SUMS];
};

/* quantities.c - rows of the options; of loaded matrices alone */
extern const QuantityTable operators_quantities, operators_loaded, operators_matrices, operators_term;
/* matrixtermoptions.c - the list of terms */
extern const QuantityList operators_terms;

/* The point that NULL stands for */
static inline const PetscReal *OperatorsPoint(Operators operators, const PetscReal p[])
{
  return p ? p : operators->parameters.p;
}

/* superelement.c - whether a parameter is one of a superelement */
PETSC_INTERN PetscBool OperatorsIsOfSuperelement(Operators operators, PetscInt parameter);
/* matrixfile.c - adds a matrix to the present part */
PETSC_INTERN PetscErrorCode MatrixAddChecksum(Mat A, Checksum checksum);

/* equations.c - the longest side of the box of all nodes, m. Collective. */
PETSC_INTERN PetscErrorCode MeshSize(MPI_Comm comm, const Mesh *mesh, PetscReal *size);

/* frictionfactor.c - the friction coefficient of largest absolute value at p, 0 without any */
PETSC_INTERN PetscReal OperatorsLargestMu(Operators operators, const PetscReal p[]);

/* components.c - parameters and terms of the bodies, springs and dashpots */
PETSC_INTERN PetscErrorCode OperatorsAssemble(Operators operators);

/* Values along or about x, y, z of something that has a matrix for each choice of them */
typedef struct {
  OperatorsTermKind kind;
  const char       *cause;        /* kind of it, of PencilCause */
  const char       *owner, *what; /* of the parameter */
  const Quantity   *row;
  const PetscReal  *value; /* [3] */
  PetscErrorCode (*create)(Operators operators, const void *of, const PetscBool mask[3], Mat *A);
  const void *of;
} Components;

/* components.c - parameters and terms of them: one where all that are not zero are equal, else one for each with _x,
   _y, _z appended; index = the parameter of each, or -1 */
PETSC_INTERN PetscErrorCode OperatorsAddComponents(Operators operators, const Components *components,
                                                   PetscInt index[3]);

/* force.c - adds the forces of the local cells of a part, -1 for all, at u [nodes][3] */
PETSC_INTERN PetscErrorCode OperatorsAddCellForces(Operators operators, const PetscReal p[], PetscInt part,
                                                   const PetscScalar u[], PetscScalar f[]);

/* bolt.c - adds the load of a bolt of a shortening (m), and its share of the size of the loads */
PETSC_INTERN PetscErrorCode OperatorsAddBolt(Operators operators, const PetscReal p[], PetscInt load,
                                             PetscReal shortening, Vec local, PetscReal *size);

/* bolt.c - displacements [nodes][3] as the cells of a part see them, which bolts with their shares draw at their cuts;
   NULL where none does: u itself. The caller frees them. */
PETSC_INTERN PetscErrorCode OperatorsGetSeen(Operators operators, const PetscReal p[], PetscInt part,
                                             const PetscReal share[], const PetscReal u[], PetscReal **seen);

/* joint.c - parameters and terms of bushings and points; their forces at displacements [nodes][3] and p, and the
   weight of their masses, added to forces of the same shape, each at the rank that owns the node. Collective. */
PETSC_INTERN PetscErrorCode OperatorsAddJoints(Operators operators);

/* layer.c - thicknesses of layers as parameters; terms of such a part. bodies.c - the lumped mass of an element in
   place of the consistent one */
PETSC_INTERN PetscErrorCode OperatorsAddThicknesses(Operators operators, PetscInt n, const Part parts[]);
PETSC_INTERN PetscErrorCode OperatorsAddLayer(Operators operators, PetscInt part, const Part *p);
PETSC_INTERN void           OperatorsLumpMass(const Element *element, PetscReal mass[]);

/* laws.c - adds the values of a law to the parameters, with the rows of their options; its terms of K and C like one
   with its matrix and other factors; frees the laws */
PETSC_INTERN PetscErrorCode OperatorsAddLaw(Operators operators, const char owner[], const Viscoelastic *values,
                                            const Quantity *(*row)(const char option[]), PetscInt young,
                                            OperatorsLaw **law);
PETSC_INTERN PetscErrorCode OperatorsAddLawTerms(Operators operators, const char owner[], OperatorsLaw *law,
                                                 const OperatorsTerm *like);
PETSC_INTERN PetscErrorCode OperatorsDestroyLaws(Operators operators);
PETSC_INTERN PetscErrorCode OperatorsAddJointForces(Operators operators, const PetscReal p[], PetscBool viscous,
                                                    const PetscReal displacement[], PetscReal force[]);
PETSC_INTERN PetscErrorCode OperatorsAddJointWeight(Operators operators, const PetscReal p[], PetscReal force[],
                                                    PetscReal total[3]);

/* spin.c - parameters of the spinning parts; their terms, once */
PETSC_INTERN PetscErrorCode OperatorsAddSpinParameters(Operators operators);
PETSC_INTERN PetscErrorCode OperatorsNeedSpin(Operators operators);

/* joint.c - which local nodes belong to a part; the caller frees them */
PETSC_INTERN PetscErrorCode OperatorsMarkPart(const Mesh *mesh, PetscInt part, PetscBool **on);

/* joint.c, dependents.c, equations.c, place.c - raise an error for a point with mass, or joined rigidly, for a tie,
   for equations, and for a superelement, on a part that spins. Collective. */
PETSC_INTERN PetscErrorCode OperatorsCheckSpinningTies(Operators operators, PetscInt part);
PETSC_INTERN PetscErrorCode OperatorsCheckSpinningEquations(Operators operators, PetscInt part);
PETSC_INTERN PetscErrorCode OperatorsCheckSpinningSuperelements(Operators operators, PetscInt part);
PETSC_INTERN PetscErrorCode OperatorsCheckSpinningPoints(Operators operators, PetscInt part);

/* dependents.c - Z and E of points that are joined rigidly, of ties and of equations, where matrices are made; raises
   an error where two of them claim one node. Collective. */
PETSC_INTERN PetscErrorCode OperatorsCreateDependents(Operators operators);

/* pattern.c - empty matrices of all unknowns, preallocated for the couplings of the cells of one part: K of all
   directions, M (NULL for none) of a mass, lumped or not, which drops zeros that are added to it */
PETSC_INTERN PetscErrorCode PatternCreate(Model model, PetscInt part, PetscBool lumped, Mat *K, Mat *M);

/* load.c - sizes of the loads as parameters */
PETSC_INTERN PetscErrorCode OperatorsAddLoadParameters(Operators operators);

/* frictionfactor.c - parameters of the contact, and the speeds at which mu is a factor of terms; part of pairs that
   slide at `speed` (m/s) in the terms of node k; the end. Collective. */
PETSC_INTERN PetscErrorCode OperatorsAddContactParameters(Operators operators);
/* wear.c - parameters of the wear of an interface, and of its time */
PETSC_INTERN PetscErrorCode OperatorsAddWear(Operators operators, const ContactInterface *c, InterfaceParameters *q);
PETSC_INTERN PetscErrorCode OperatorsAddWearTime(Operators operators);
/* Raises the error for a point at which the speeds of the nodes do not give the friction between them. Same on all
   ranks. */
PETSC_INTERN PetscErrorCode OperatorsCheckFriction(Operators operators, const PetscReal p[]);
PETSC_INTERN PetscReal      FrictionNodeShare(const InterfaceParameters *interface, PetscInt k, PetscReal speed);
PETSC_INTERN PetscErrorCode OperatorsDestroyContactParameters(Operators operators);

/* file.c - matrices from files and options, and to files */
PETSC_INTERN PetscErrorCode OperatorsLoadFromOptions(Operators operators);
PETSC_INTERN PetscErrorCode OperatorsLoad(Operators operators);
