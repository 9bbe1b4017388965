/*
   Operators - what the matrices of a scene are made of: the terms of its bodies, springs and dashpots, or matrices that
   are loaded or given densely, and the numbers of the scene that they depend on. Pencils (pencil.h) are made from them.

   The values of the scene stay in the room that reads their options (young in the parts of the model, mu in the
   interfaces of the contact); here they are listed by name, with unit and limits. The point at which something is
   evaluated is an array p [parameters] in the order of OperatorsGetParameters(), which the caller hands over; NULL
   stands for the values of the scene, and p may go on with the parameters that only a pencil has. Nothing here has a
   present value that somebody else could change.
*/
#pragma once

#include <squeal/contact.h>

typedef struct _p_Operators *Operators;

/* A number that matrices depend on, named like the option of the scene that sets it (pad_young, contact_mu) */
typedef struct {
  char            name[128];
  const Quantity *row; /* of its option, NULL for what has none; said by it: */
  const char     *unit;
  PetscReal       value;        /* of the scene; of an internal one 1 */
  PetscReal       lower, upper; /* lower < value <= upper; -infinity, infinity where the row has no limit */
  PetscBool       closed;       /* lower itself is a value: alpha, beta, stiffness, viscosity, force may be 0 */
  PetscBool       length;       /* it is the size of the row's vector, hence not negative */
  PetscBool       divides;      /* something is divided by it: beyond the row's limits it is not 0 */
  PetscBool       damps;        /* its term is damping, which its unit does not tell */
  PetscBool       law;          /* of a stiffness that depends on the eigenvalue (viscoelastic.h) */
  PetscBool       body;         /* of parts, springs or dashpots, not of a contact */
  PetscBool stressing; /* the stress of a spin depends on it, and was found with its value (OperatorsCheckMoved()) */
  PetscBool state;   /* the sliding state alone depends on it: size of a load, mu of a contact that holds by friction */
  PetscReal fastest; /* of a spin: the largest size that it can have; 0: any */
  PetscBool of_matrices; /* a term of -terms names it, and its option with it */
  PetscBool internal;    /* no option of the scene: how far a group of pairs is closed, see SlidingState */
} OperatorsParameter;

/* Values of a part */
typedef struct {
  PetscReal young, density; /* Pa, kg/m^3 */
  PetscReal alpha, beta;    /* of Rayleigh, C = alpha M + beta K: 1/s, s */
  PetscReal thickness;      /* of a layer whose thickness is given, m; else 0 */
} OperatorsMaterial;

/*@ OperatorsCreate - makes empty operators. Collective. @*/
PetscErrorCode OperatorsCreate(MPI_Comm comm, Operators *operators);

/*@ OperatorsSetModel - takes the matrices from a model and its contact. Collective. @*/
PetscErrorCode OperatorsSetModel(Operators operators, Model model, Contact contact);

/*@
   OperatorsSetFromOptions - reads where the matrices come from and go to. Collective.

   Options are the rows of src/operators/quantities.c.
@*/
PetscErrorCode OperatorsSetFromOptions(Operators operators);

/*@ OperatorsSetMatrices - symmetric K and M, M positive definite, in place of a model; references are kept. Then they
    are set up. Collective. @*/
PetscErrorCode OperatorsSetMatrices(Operators operators, Mat K, Mat M);

/*@ OperatorsVisit - shows the rows of its options. Collective. @*/
PetscErrorCode OperatorsVisit(Operators operators, const QuantityVisitor *visitor);

/*@ OperatorsHaveMatrices - whether matrices are loaded or given densely, so that no model is needed. Not collective.
    @*/
PetscErrorCode OperatorsHaveMatrices(Operators operators, PetscBool *have);

/*@ OperatorsHaveNodes - whether unknowns are those of nodes, of a model or of -operators_nodes. Not collective. @*/
PetscErrorCode OperatorsHaveNodes(Operators operators, PetscBool *have);

/*@ OperatorsHaveTerms - whether -terms or -superelements may hold or join anything. Not collective. @*/
PetscErrorCode OperatorsHaveTerms(Operators operators, PetscBool *have);

/*@ OperatorsCheckEven - raises the error for a superelement whose stiffness, or with `damping` whose damping, has a
    skew part, which `what` does not have. Collective; after OperatorsSetUp(). @*/
PetscErrorCode OperatorsCheckEven(Operators operators, PetscBool damping, const char what[]);

/*@ OperatorsCountSuperelements - how many there are. Not collective. @*/
PetscInt OperatorsCountSuperelements(Operators operators);

/*@ OperatorsCountParts - how many bodies have a name: the parts of OperatorsGetMesh(), then the superelements, which
    are numbered on. Not collective; after OperatorsSetUp(). @*/
PetscErrorCode OperatorsCountParts(Operators operators, PetscInt *n);

/*@ OperatorsGetPartName - that of one of them (borrowed). Not collective. @*/
PetscErrorCode OperatorsGetPartName(Operators operators, PetscInt part, const char **name);

/*@ OperatorsMultiplySuperelementMass - f = M u with the mass of superelement k at p, from 0, in all unknowns; 0 without
    mass. Collective. @*/
PetscErrorCode OperatorsMultiplySuperelementMass(Operators operators, const PetscReal p[], PetscInt k, Vec u, Vec f);

/*@ OperatorsMarkSuperelement - u = 1 at the unknowns of superelement k, or of those only that are apart from the mesh;
    0 elsewhere. Collective. @*/
PetscErrorCode OperatorsMarkSuperelement(Operators operators, PetscInt k, PetscBool apart, Vec u);

/*@ OperatorsGetSuperelementForce - the sum of the forces (N) with which superelement k acts on the nodes of the mesh at
    unknowns u and displacements [local nodes][3] (m), held ones too. Collective. @*/
PetscErrorCode OperatorsGetSuperelementForce(Operators operators, const PetscReal p[], PetscInt k, Vec u,
                                             const PetscReal displacement[], PetscReal force[3]);

/* A share of a displacement of a node, by its number over all ranks, in an unknown */
typedef struct {
  PetscInt  row, number, direction;
  PetscReal weight;
} OperatorsSuperelementNode;

/* All superelements as one, alike on all ranks; matrices [n][n] by columns, NULL for none */
typedef struct {
  PetscInt                   n, n_apart, n_nodes;
  PetscInt                  *apart;     /* [n] number among the unknowns apart, -1 of a node */
  OperatorsSuperelementNode *node;      /* [n_nodes] */
  PetscReal                 *K, *M, *C; /* N/m, kg, N s/m */
} OperatorsSuperelements;

/*@ OperatorsGetSuperelements - that at p, for what has no terms. Collective; the caller destroys it. @*/
PetscErrorCode OperatorsGetSuperelements(Operators operators, const PetscReal p[], OperatorsSuperelements *all);
PetscErrorCode OperatorsDestroySuperelements(OperatorsSuperelements *all);

/*@ OperatorsViewSuperelements - a line of each. Collective; after OperatorsSetUp(). @*/
PetscErrorCode OperatorsViewSuperelements(Operators operators, PetscViewer viewer);

/*@ OperatorsNameLaw - the option, with its dash, of the first of -terms whose stiffness depends on the frequency, empty
    for none, and whether it is hysteretic. Not collective. @*/
PetscErrorCode OperatorsNameLaw(Operators operators, size_t size, char option[], PetscBool *hysteretic);

/*@ OperatorsHaveDamping - whether there is a damping one among them. Not collective. @*/
PetscErrorCode OperatorsHaveDamping(Operators operators, PetscBool *have);

/*@ OperatorsLump - the mass matrix is lumped whatever the options say, as that of transients. Before
   OperatorsSetUp(). Not collective. @*/
PetscErrorCode OperatorsLump(Operators operators);

/*@ OperatorsOmitMatrices - leaves the matrices of a model out: there are parameters alone, which is all that kernels in
    time ask for. Nothing that forms a matrix may be called then. Before OperatorsSetUp(). Not collective. @*/
PetscErrorCode OperatorsOmitMatrices(Operators operators);

/*@ OperatorsViewOmitted - says so, and about how much memory that saves; nothing where matrices are there. Collective.
   @*/
PetscErrorCode OperatorsViewOmitted(Operators operators, PetscViewer viewer);

/*@ OperatorsSetUp - assembles the bodies or loads the matrices. Collective. @*/
PetscErrorCode OperatorsSetUp(Operators operators);

/*@ OperatorsGetSave - the folder of -operators_save, "" without (borrowed). Not collective. @*/
PetscErrorCode OperatorsGetSave(Operators operators, const char **folder);

/*@
   OperatorsGetParameters - the numbers that the matrices depend on, in the order of the scene: of each part young
   (Pa), density (kg/m^3), alpha (1/s), beta (s); of each layer whose thickness is given thickness (m); of each list
   of springs stiffness (N/m), of dashpots viscosity (N s/m), with _x, _y, _z appended where the components that are
   not zero differ; of each bushing and point stiffness (N/m), turn_stiffness (N m/rad), viscosity (N s/m),
   turn_viscosity (N m s/rad) alike, of a point mass (kg); of each part that spins spin (rad/s), on which pencils
   alone depend; of each contact mu, kn (N/m, penalty) or, where the pressure is not linear, the parameters of its
   law (pressurelaw.h), kt (N/m, holding by friction), and with friction damping force (N) and speed (m/s), or
   rotation (rad/s) where that is what was given, mu standing for the parameters of its friction law (frictionlaw.h),
   of which those that decide mu' alone are there with friction damping; where it wears wear_rate and
   wear_rate_master (1/Pa^a); contact_mu for loaded or dense matrices with H, and what -terms name (borrowed). An
   interface of which nothing says along what it slides has a mu only where it holds by friction. Where a contact
   wears, wear_time (s). Then of each load force (N, the length of the vector) or pressure (Pa), and moment (N m,
   likewise). Not collective.
@*/
PetscErrorCode OperatorsGetParameters(Operators operators, PetscInt *n, const OperatorsParameter **parameters);

/*@ OperatorsUnitIsGyration - whether a parameter is one of damping or spin, which real modes know nothing of: by its
    unit, since names begin with those that the user gave. Not collective. @*/
PetscErrorCode OperatorsUnitIsGyration(const char unit[], PetscBool *is);

/*@ OperatorsCreatePoint - a copy of a point, NULL for the values of the scene, p [parameters], to be changed and freed
    (PetscFree()) by the caller. Not collective. @*/
PetscErrorCode OperatorsCreatePoint(Operators operators, const PetscReal from[], PetscReal **p);

/*@ OperatorsCheckParameter - raises PETSC_ERR_USER_INPUT for a value outside the limits of its parameter, naming both.
    Collective. @*/
PetscErrorCode OperatorsCheckParameter(Operators operators, PetscInt parameter, PetscReal value);

/*@ OperatorsCheckMoved - raises PETSC_ERR_USER_INPUT for n parameters that `option` would give other values than
   those of the scene, the same to all: where the stress of a spin depends on one of them, and where the spin of one
   part would move but not that of a part with which it shares nodes. NULL for all parameters. Collective. @*/
PetscErrorCode OperatorsCheckMoved(Operators operators, const char option[], PetscInt n, const PetscInt parameter[]);

/*@ OperatorsAddChecksum - adds what options choose, and matrices that are loaded. Collective; after OperatorsSetUp().
    @*/
PetscErrorCode OperatorsAddChecksum(Operators operators, Checksum checksum);

/*@ OperatorsAddSceneChecksum - the same behind those of the model, with its partition or without, and of the contact.
    Collective; after OperatorsSetUp(). @*/
PetscErrorCode OperatorsAddSceneChecksum(Operators operators, PetscBool with_partition, Checksum checksum);

/*@ OperatorsGetMaterial - the values of a part at p. Not collective. @*/
PetscErrorCode OperatorsGetMaterial(Operators operators, const PetscReal p[], PetscInt part,
                                    OperatorsMaterial *material);

/*@ OperatorsGetInterface - friction coefficient at the stated speed and pressure law (linear and infinite for the
   constraint) of an interface at p. Not collective. @*/
PetscErrorCode OperatorsGetInterface(Operators operators, const PetscReal p[], PetscInt interface, PetscReal *mu,
                                     PressureLaw *law);

/*@ OperatorsGetPairMu - friction coefficient of a pair at p, at its sliding speed, or where it rests at none, and at
    its normal force (N). Not collective. @*/
PetscErrorCode OperatorsGetPairMu(Operators operators, const PetscReal p[], const ContactPair *pair, PetscBool rests,
                                  PetscReal force, PetscReal *mu);

/* How fast a pair wears: depth W = rate speed time p^exponent, m; share: part of it of the slave */
typedef struct {
  PetscReal rate, share, exponent, speed; /* of both sides, 1/Pa^exponent; m/s */
} OperatorsWear;

/*@ OperatorsGetPairWear - that of a pair at p; its rate is 0 where its interface does not wear. Not collective. @*/
PetscErrorCode OperatorsGetPairWear(Operators operators, const PetscReal p[], const ContactPair *pair,
                                    OperatorsWear *wear);

/*@ OperatorsGetWearTime - how long contacts have worn at p, s; 0 where none wears. Not collective. @*/
PetscErrorCode OperatorsGetWearTime(Operators operators, const PetscReal p[], PetscReal *time);

/*@ OperatorsGetBodies - stiffness, mass and damping of parts, springs and dashpots alone, without contact, at p;
    symmetric (borrowed until the call for another p, which writes into the same matrices; C may be NULL without
    damping). Pass NULL for what is not needed. Collective. @*/
PetscErrorCode OperatorsGetBodies(Operators operators, const PetscReal p[], Mat *K, Mat *M, Mat *C);

/*@ OperatorsReleaseBodies - frees those matrices; the next call for them forms them again. Collective. @*/
PetscErrorCode OperatorsReleaseBodies(Operators operators);

/*@ OperatorsGetJoint - stiffness [6], viscosity [6] (along and about x, y, z: N/m, N m/rad; N s/m, N m s/rad) and mass
    (kg) of bushing i at p, or of point i less the number of bushings. Not collective. @*/
PetscErrorCode OperatorsGetJoint(Operators operators, const PetscReal p[], PetscInt i, PetscReal stiffness[6],
                                 PetscReal viscosity[6], PetscReal *mass);

/*@ OperatorsGetDependents - of points that are joined rigidly and of ties: all displacements u = Z q, and E' u = q,
   which are those of u that follow no others; NULL without such points and ties (borrowed). Forces of the constraint
   are those with Z'f = 0. Not collective. @*/
PetscErrorCode OperatorsGetDependents(Operators operators, Mat *Z, Mat *E);

/*@ OperatorsInternalForces - K_e u_e of all elements at p and the forces of bushings and points, summed over ranks, N,
   into a local vector of three values per node in the layout of the coordinates, held directions included: at a
   support they are its reaction. Springs and contact are no part of it. Collective. @*/
PetscErrorCode OperatorsInternalForces(Operators operators, const PetscReal p[], Vec u, Vec local);

/*@ OperatorsPrescribedForces - internal forces of displacements d that motions prescribe [nodes][3], m, all others
   held, as those of OperatorsInternalForces(): with u = 0 on the unknowns, K_fd d there. Zero for NULL. Collective. @*/
PetscErrorCode OperatorsPrescribedForces(Operators operators, const PetscReal p[], const PetscReal prescribed[],
                                         Vec local);

/*@ OperatorsPrescribedDrag - the same of velocities (m/s) and damping, C_fd v: beta K of the parts, bushings; mass and
   what holds a node to the ground do not couple it with others. Collective. @*/
PetscErrorCode OperatorsPrescribedDrag(Operators operators, const PetscReal p[], const PetscReal velocity[], Vec local);

/*@ OperatorsAddWeight - adds the weight of all parts under -model_gravity, f_i = sum_j m_ij g at the densities of p, to
    a vector of ModelCreateNodal(), N; total is its sum over the bodies. Collective. @*/
PetscErrorCode OperatorsAddWeight(Operators operators, const PetscReal p[], Vec local, PetscReal total[3]);

/*@ OperatorsAddLoads - adds all loads, of the sizes that p gives them, to such a vector, N, of load i a share[i] (NULL:
   all of each; of a bolt under tension its shortening, m); size is a bound of the sum of |force| over the unknowns.
   Collective. @*/
PetscErrorCode OperatorsAddLoads(Operators operators, const PetscReal p[], const PetscReal share[], Vec local,
                                 PetscReal *size);

/*@ OperatorsAddLoad - adds load i of the scene times a factor to such a vector, N; a bolt shortened by the factor, m.
   Collective. @*/
PetscErrorCode OperatorsAddLoad(Operators operators, const PetscReal p[], PetscInt i, PetscReal factor, Vec local);

/* Of a bolt: by how much it is shortened (m), the tension that passes through its cut (N), and the stiffness that its
   cells at the cut alone have along it (N/m) */
typedef struct {
  PetscReal shortening, tension, stiffness;
} OperatorsBolt;

/*@ OperatorsGetBolt - load i, a bolt, with its share, at displacements [local nodes][3] (m). Collective. @*/
PetscErrorCode OperatorsGetBolt(Operators operators, const PetscReal p[], PetscInt i, PetscReal share,
                                const PetscReal displacement[], OperatorsBolt *bolt);

/*@ OperatorsTakeNodal - moves such a vector, complete at every node, to the unknowns. Collective. @*/
PetscErrorCode OperatorsTakeNodal(Operators operators, Vec local, Vec u);

/*@ OperatorsApplyBodies - f = K u of parts and springs at p, N, element by element: without the rounding of the
    assembled matrix in rigid translations. Collective. @*/
PetscErrorCode OperatorsApplyBodies(Operators operators, const PetscReal p[], Vec u, Vec f);

/*@ OperatorsCreateGeometric - the stiffness int grad N_i . sigma . grad N_j dV times the 3 x 3 identity (N/m) of the
   stress sigma of displacements u (m, [nodes][3], local), and of bolts with their shares of OperatorsAddLoads() (NULL
   for none), with the moduli of the point p, symmetric; tension stiffens. Collective. The caller destroys it. @*/
PetscErrorCode OperatorsCreateGeometric(Operators operators, const PetscReal p[], const PetscReal u[],
                                        const PetscReal share[], Mat *K);

/*@ OperatorsCreateVec - a vector of all unknowns. Collective. @*/
PetscErrorCode OperatorsCreateVec(Operators operators, Vec *u);

/*@ OperatorsGetNodeUnknowns - numbers of the unknowns of a node in x, y, z among all of them, -1 where it is held, on
    every rank. vertex is its local node on one rank at least, -1 on the others. Collective. @*/
PetscErrorCode OperatorsGetNodeUnknowns(Operators operators, PetscInt vertex, PetscInt unknown[3]);

/*@ OperatorsFindUnknown - of matrices without a mesh the unknown, from 0, that an option names by its number from 1.
    Collective. Errors: PETSC_ERR_USER_INPUT for what is no such number, naming the option. @*/
PetscErrorCode OperatorsFindUnknown(Operators operators, const char option[], const char word[], PetscInt *unknown);

/*@ OperatorsAddEntries - adds n values, alike on all ranks, to entries of a vector of all unknowns; entries of -1 are
    left out. Collective. @*/
PetscErrorCode OperatorsAddEntries(Operators operators, Vec u, PetscInt n, const PetscInt entry[],
                                   const PetscReal value[]);

/*@ OperatorsGetMesh - the mesh of the model, or the points of -operators_nodes as a mesh whose cells are points, NULL
   where there is neither (borrowed). Not collective; after OperatorsSetUp(). @*/
PetscErrorCode OperatorsGetMesh(Operators operators, const Mesh **mesh);

/*@ OperatorsGetNodal - displacements of a vector of all unknowns, or of none for NULL, at the nodes of that mesh, shape
    [local nodes][3], zero where there is no unknown. Collective. @*/
PetscErrorCode OperatorsGetNodal(Operators operators, Vec u, PetscReal nodal[]);

/*@ OperatorsGetModel - the model and contact, NULL for loaded matrices (borrowed). Not collective. @*/
PetscErrorCode OperatorsGetModel(Operators operators, Model *model, Contact *contact);

/*@ OperatorsDestroy - frees the operators. Collective. @*/
PetscErrorCode OperatorsDestroy(Operators *operators);
