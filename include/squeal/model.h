/*
   Model - the bodies: one DMPlex of named parts, their materials, essential supports, grounded springs and dashpots.

   The mesh comes from the built-in generator (-model_source rig) or from a Gmsh file (-model_source file). Every named
   set of the scene is a DMLabel of that name with value 1: parts on cells, surfaces on faces, points on vertices.
   The DM's local section holds three displacements (m) per node (mesh.h) in the order x, y, z; displacements fixed by a
   support are constrained, hence absent from global vectors and matrices.
*/
#pragma once

#include <squeal/quantity.h>
#include <petscdmplex.h>
#include <squeal/checksum.h>
#include <squeal/element.h>
#include <squeal/joint.h>
#include <squeal/material.h>
#include <squeal/mesh.h>

typedef struct _p_Model *Model;

/* How a quantity on a set is spread over its nodes: the same at each, in all, or per area */
typedef enum { SPREAD_EACH, SPREAD_TOTAL, SPREAD_AREA } Spread;

/* Grounded spring or dashpot on a set, in each direction: at every node (N/m, N s/m), in all (the same units), or per
   area of a surface (N/m^3, N s/m^3) */
typedef struct {
  char       *name, *set;
  PetscReal   asked[SPREAD_AREA + 1][3]; /* as it is given, by its spread: one of them */
  PetscBool   given[SPREAD_AREA + 1];
  PetscReal   value[3];
  Spread      spread;
  const char *quantity, *unit; /* "stiffness_total", "N/m" and so on */
} Grounded;

/* Total force on a set, N, spread over a surface by its area, over other sets equally by node; or a pressure on a
   surface, Pa, into the body; or a force and a moment on a point; or a bolt that is tightened (scene/loads/bolt.c) */
typedef struct {
  char     *name, *set, *on; /* set is empty for a point, `on` names it */
  char     *part;            /* of a bolt: the one on one side of its cut; axis points out of it through the cut */
  PetscBool is_pressure, on_point, has_force, has_moment;
  PetscInt  point;              /* index of the point */
  PetscReal moment[3];          /* on it, N m */
  PetscReal pressure, force[3]; /* Pa; N, of a pressure its resultant after ModelSetUp() */
  PetscReal size;               /* sum of |force|, or |pressure| times area, N; after ModelSetUp() */
  PetscBool is_bolt, has_tension, has_shortening, has_axis;
  PetscInt  of_part;
  PetscReal axis[3], tension, shortening; /* of unit length; N, m */
  PetscBool swings;                       /* about zero: in time alone, no part of an equilibrium */
} Load;

/* A place of a body that histories record: the nearest node of the part */
typedef struct {
  char     *name, *part; /* part is empty for any */
  PetscBool has_at;
  PetscReal at[3];  /* place asked for, m */
  PetscReal x[3];   /* that of the node, m */
  PetscInt  vertex; /* local node from 0 on the rank that records it, -1 on all others */
} Probe;

/* Nodes of a part at equal angles about an axis, whose motion along it histories and responses record */
typedef struct {
  char     *name, *part;
  PetscReal radius, tolerance; /* m; how far a node may be from its place */
  PetscInt  n;                 /* nodes */
  char      face[8];           /* as it is given, such as z+ */
  int       axis, side;        /* 0, 1, 2 for x, y, z; 1 or -1: the side of the part on which it lies */
  PetscBool has_centre;        /* given, else the middle of the part */
  PetscBool has_tolerance;
  PetscReal centre[3]; /* m */
  Probe    *probe;     /* [n], named `name`_000 and so on; after ModelSetUp() */
} Circle;

/* Cells swept along an angle or an axis: each lies between two consecutive nodes of four lines. All lines have the same
   number of nodes, five at least, equally spaced, and node k of every line has the same angle (or place along the
   axis); the cells of a column between four lines are equal but for the sweep and have the same part. Lines that share
   a cell are near each other in the list. On several ranks these are the local cells. */
typedef struct {
  PetscBool turned;           /* swept about the axis, else along it */
  PetscBool oblique;          /* the axis is none of x, y, z */
  PetscInt  axis;             /* 0, 1, 2 for the rows of `frame` */
  PetscReal frame[9];         /* orthonormal, right-handed rows: x, y, z where it is not oblique */
  PetscReal centre[3];        /* a point of the axis, m */
  PetscReal begin, step;      /* angle (rad, from row axis + 1 towards axis + 2) or place (m) of node 0, and the step */
  PetscInt  n_lines, n_nodes; /* lines, nodes of each */
  PetscBool closed;           /* all around: node n_nodes is node 0 again */
  PetscInt *vertex;           /* [n_lines][n_nodes] local nodes from 0 */
} ModelLines;

/* Essential condition: the flagged directions are fixed at every node of the set */
typedef struct {
  char     *name, *set;
  char      word[16]; /* as they are given, such as xz */
  PetscBool fix[3];
} Support;

/* Prescribed displacement d of a set along the flagged directions, m; in time r(t) d, with a history */
typedef struct {
  char     *name, *set;
  PetscReal displacement[3];
  PetscBool has_word, direction[3];
  char      word[16]; /* these as they are given, such as xz */
  PetscBool swings;   /* about zero: in an equilibrium it holds */
} PrescribedMotion;

/* What the options name */
typedef struct {
  PetscInt          n_parts, n_supports, n_springs, n_dashpots, n_loads, n_motions, n_probes, n_circles;
  PetscInt          n_joints, n_points;
  Part             *parts;
  Support          *supports;
  Grounded         *springs, *dashpots;
  Joint            *joints, *points;
  Load             *loads;
  PrescribedMotion *motions;
  Probe            *probes;
  Circle           *circles;
  PetscReal         loss_frequency;                /* Hz, of the loss factors; 0: not given */
  PetscReal         gravity[3];                    /* m/s^2 */
  char              equations[PETSC_MAX_PATH_LEN]; /* file of -model_equations; empty without */
} ModelScene;

/*@
   ModelCreate - makes an empty model. Collective.
@*/
PetscErrorCode ModelCreate(MPI_Comm comm, Model *model);

/*@
   ModelSetFromOptions - reads the scene: mesh source, parts and materials, supports, springs, dashpots, bushings,
   points, loads, motions, probes, circles. Collective.

   Options are the rows of src/model/quantities.c.

   Errors: PETSC_ERR_USER_INPUT for a missing or invalid value, naming option, value and what is valid.
@*/
PetscErrorCode ModelSetFromOptions(Model model);

/*@ ModelVisit - shows the rows of its options. Collective. @*/
PetscErrorCode ModelVisit(Model model, const QuantityVisitor *visitor);

/*@
   ModelKeepTogether - asks the partition to leave all cells that touch the faces of a set on one rank; call before
   ModelSetUp(). All sets named by any call end on the same rank. Not collective, same call on all ranks.
@*/
PetscErrorCode ModelKeepTogether(Model model, const char set[]);

/*@ ModelKeepSlabs - asks the partition to cut swept bodies across their lines only, so that each rank has whole slabs
    of them; bodies that fit into a rank's share of the cost stay whole. The sets of ModelKeepTogether() are then not
    heeded. Call before ModelSetUp(). Not collective, same call on all ranks. @*/
PetscErrorCode ModelKeepSlabs(Model model);

/*@ ModelHoldMotions - the motions act as supports with their whole displacement: the directions that they prescribe are
    no unknowns. Without it, where motions act in time, they are unknowns as all others. Call before ModelSetUp(). Not
    collective. @*/
PetscErrorCode ModelHoldMotions(Model model);

/*@ ModelAddUnknowns - adds n unknowns that no node has, of superelements: the last ones, all of the last rank. Call
    before ModelSetUp(). Not collective, same call on all ranks. @*/
PetscErrorCode ModelAddUnknowns(Model model, PetscInt n);

/*@ ModelCheckGiven - raises PETSC_ERR_USER_INPUT where the options tell of no mesh. Collective. @*/
PetscErrorCode ModelCheckGiven(Model model);

/*@
   ModelSetUp - generates or reads the mesh, checks its elements, partitions it, and lays out the unknowns. Collective.

   Errors: PETSC_ERR_FILE_OPEN; PETSC_ERR_USER_INPUT for a part or set that the mesh does not name, for an element that
   is inverted at one of its quadrature points, has no volume (number, part and centre are named), or whose shape is
   lost in the rounding of numbers at its distance from the origin, for elements of different order that share an edge
   or face.
@*/
PetscErrorCode ModelSetUp(Model model);

/*@ ModelGetComm - the ranks that share the model. Not collective. @*/
PetscErrorCode ModelGetComm(Model model, MPI_Comm *comm);

/*@ ModelGetDM - the mesh with its layout of the unknowns that nodes have (borrowed). Rooms hand it to PETSc, and take
    what is in it from ModelGetMesh(). Not collective. @*/
PetscErrorCode ModelGetDM(Model model, DM *dm);

/*@ ModelCreateVec - a vector of all unknowns. Collective; after ModelSetUp(). The caller destroys it. @*/
PetscErrorCode ModelCreateVec(Model model, Vec *u);

/*@ ModelGetMesh - what this rank has of the mesh, after ModelSetUp() (borrowed). Not collective. @*/
PetscErrorCode ModelGetMesh(Model model, const Mesh **mesh);

/*@ ModelGetScene - what the options name, after ModelSetFromOptions() (borrowed). Not collective. @*/
PetscErrorCode ModelGetScene(Model model, const ModelScene **scene);

/*@ ModelFindPart - index of the part that -`name`_part gives, -1 for an empty one. Not collective, same call on all
    ranks. Errors: PETSC_ERR_USER_INPUT for none of the parts. @*/
PetscErrorCode ModelFindPart(Model model, const char name[], const char part[], PetscInt *index);

/*@ ModelGetElasticity - elasticity of a local cell in global axes, with the given Young's modulus (Pa) and density
    (kg/m^3). Of a part that is not isotropic young stands for E_1, and all other moduli keep their ratio to it. Not
    collective. @*/
PetscErrorCode ModelGetElasticity(Model model, PetscInt c, PetscReal young, PetscReal density, Elasticity *elasticity);

/*@ ModelMaterialIsSwept - whether the cells of a part are equal along lines of the mesh in their material too:
   isotropic,
    or in axes that the sweep carries along. Not collective. @*/
PetscBool ModelMaterialIsSwept(Model model, PetscInt part, const ModelLines *lines);

/*@ ModelGetCell - local cell c: its element, and in the order of that the nodes [n_nodes] and their places x
   [n_nodes][3]
    (m). Not collective. @*/
PetscErrorCode ModelGetCell(Model model, PetscInt c, const Element **element, PetscInt nodes[], PetscReal x[]);

/*@ ModelGetCellAt - the same where its layer is `thickness` thick (m), stretched about the origin; of other parts, and
    for 0, as in the mesh. Not collective. @*/
PetscErrorCode ModelGetCellAt(Model model, PetscInt c, PetscReal thickness, const Element **element, PetscInt nodes[],
                              PetscReal x[]);

/*@
   ModelAddLoad - adds load i to a vector of ModelCreateNodal(), N, its force or pressure times factor[0], its moment
   times factor[1]; NULL for 1, 1. On a surface f_v = F int N_v dA / A, on a set of other nodes F / n. The sum over all
   nodes, held ones included, is F; a node has its full force on every rank that shares it. Collective.
@*/
PetscErrorCode ModelAddLoad(Model model, PetscInt i, const PetscReal factor[2], Vec local);

/*@
   ModelGetBodies - the pieces of the mesh that hang together by nodes: their number over all ranks, and that of each
   local node, shape [nodes], -1 for none. Numbers follow the least x, then y, then z of a
   body's nodes, so that they do not depend on the ranks. Collective. The caller frees the array.
@*/
PetscErrorCode ModelGetBodies(Model model, PetscInt *n_bodies, PetscInt **body);

/*@ ModelMeasureBodies - boxes of n bodies of ModelGetBodies() from number `first` on, shape [n][6], m: upper ends,
   and lower ones with the other sign; all -PETSC_MAX_REAL where a body has no node. Collective. @*/
PetscErrorCode ModelMeasureBodies(Model model, const PetscInt body[], PetscInt first, PetscInt n, PetscReal box[]);

/*@ ModelNameBody - "part pad", "parts pad, beam"; "a piece of part pad about 0.01, 0.02, 0 m" where other bodies have
   cells of that part too. Collective. @*/
PetscErrorCode ModelNameBody(Model model, const PetscInt body[], PetscInt b, size_t size, char text[]);

/*@ ModelGetSetNodes - local nodes of a named set, node [n], ascending, also those that other ranks own. Collective. The
    caller frees the array (PetscFree()).
    Errors: PETSC_ERR_USER_INPUT when no rank has the set; the message lists the sets of the mesh. @*/
PetscErrorCode ModelGetSetNodes(Model model, const char set[], PetscInt *n, PetscInt **node);

/*@ ModelGetOwnedNodes - as ModelGetSetNodes(), those that this rank owns: each node of the set on exactly one
    rank. Collective. @*/
PetscErrorCode ModelGetOwnedNodes(Model model, const char set[], PetscInt *n, PetscInt **node);

/*@ ModelCreateShares - the shares s_v of the nodes of a set in a quantity that is spread over it, in the first of three
    places of each local node, complete on every rank that has it: 1; adding up to 1; or area, m^2. Collective. The
    caller destroys the vector. Shares in an area are positive, for springs and the like: of faces of first order
    int N_v dA, of second A int N_v^2 dA / sum_w int N_w^2 dA (kernels/contact/facet.h).
    Errors: PETSC_ERR_USER_INPUT for a set without a node of an element, and per area for one without faces; `owner` is
    the prefix of the option -owner_set that the message names. @*/
PetscErrorCode ModelCreateShares(Model model, const char owner[], const char set[], Spread spread, Vec *shares);

/*@ ModelGetMeanMotion - the six motions of displacements [nodes][3], m. Collective. @*/
PetscErrorCode ModelGetMeanMotion(Model model, const ModelMean *mean, const PetscReal nodal[], PetscReal q[6]);

/*@ ModelAddMeanForce - adds what force and moment on the motions are at the nodes to nodal [nodes][3], N, each at the
    rank that owns the node. Not collective. @*/
void ModelAddMeanForce(const ModelMean *mean, const PetscReal force[6], PetscReal nodal[]);

/*@ ModelGetSetFaces - the faces of a surface set on this rank; each face is on exactly one rank. Collective. The caller
    frees them with ModelFacesDestroy(). Errors: PETSC_ERR_USER_INPUT for a set without faces. @*/
PetscErrorCode ModelGetSetFaces(Model model, const char set[], ModelFaces *faces);

/*@ ModelGetOuterFaces - the faces of a part on this rank that have a cell on one side alone and are in none of n sets;
    each face is on exactly one rank. Collective. The caller frees them with ModelFacesDestroy(). @*/
PetscErrorCode ModelGetOuterFaces(Model model, PetscInt part, PetscInt n, const char *const set[], ModelFaces *faces);
PetscErrorCode ModelFacesDestroy(ModelFaces *faces);

/*@ ModelGetSetNormals - for each local node, shape [nodes][3], the outward normal of a surface set times the node's
    share of its area (m^2), complete on every rank that has the node. Its direction is that of the sum of the area
    vectors of the faces around the node (kernels/contact/facet.h): of first order int N_v n dA, whose length is the
    share too; of second order the faces' own normals there with positive weights, and the length that of
    ModelCreateShares(). Collective. The caller frees it. @*/
PetscErrorCode ModelGetSetNormals(Model model, const char set[], PetscReal **area_normals);

/*@ ModelFindNode - the node of a part (empty for any) nearest to a place (m): its local node from 0 on one rank that
    has it, -1 on all others. Collective; after ModelSetUp(). Errors: PETSC_ERR_USER_INPUT, which names the option
    -name_at, for a place farther off it than half the diagonal of the part, or of the largest one where it is any. @*/
PetscErrorCode ModelFindNode(Model model, const char name[], const char part[], const PetscReal at[3],
                             PetscInt *vertex);

/*@ ModelCreateLines - the lines along which the local cells of a body (of ModelGetBodies()) are swept; NULL where they
    are not, or are none. Of several ways it is the one with the longest lines, rather about an axis than along it. Not
    collective; the caller frees them with ModelDestroyLines(). @*/
PetscErrorCode ModelCreateLines(Model model, PetscInt body, const PetscInt body_of_vertex[], ModelLines **lines);
PetscErrorCode ModelDestroyLines(ModelLines **lines);

/*@ ModelGetNeighbours - the n nodes beside local node v along edges that this rank has: in the middle of the edge where
    it has a node there, else at its other end. Not collective. The caller frees them. @*/
PetscErrorCode ModelGetNeighbours(Model model, PetscInt v, PetscInt *n, PetscInt **neighbours);

/*@ ModelCreateNodal - a vector of three zeros for each local node. Not collective. The caller destroys it. @*/
PetscErrorCode ModelCreateNodal(Model model, Vec *nodal);

/*@ ModelGetNodal - the displacements of a vector of the unknowns (NULL: zeros) at the local nodes, shape
    [nodes][3]; zero where a support fixes them. Collective. @*/
PetscErrorCode ModelGetNodal(Model model, Vec u, PetscReal nodal[]);

/*@ ModelGetDisplaced - the same, with the displacements that motions prescribe where they are held. Collective. @*/
PetscErrorCode ModelGetDisplaced(Model model, Vec u, PetscReal nodal[]);

/*@ ModelGetMotion - the displacement of held motion i alone at the local nodes, shape [nodes][3], m, also where it
    swings. Collective. @*/
PetscErrorCode ModelGetMotion(Model model, PetscInt i, PetscReal nodal[]);

/*@ ModelGetMotions - the displacements that held motions prescribe in an equilibrium at the local nodes, shape
    [nodes][3], m, of motion i a share[i] (NULL: all of each); the mesh has some (Mesh.prescribed is not NULL).
    Collective. @*/
PetscErrorCode ModelGetMotions(Model model, const PetscReal share[], PetscReal nodal[]);

/*@ ModelSumShared - sums a vector of ModelCreateNodal() over all ranks that share a node; every one of them gets the
    sum. Collective. @*/
PetscErrorCode ModelSumShared(Model model, Vec local);

/*@ ModelDescribeDoubt - for a message that something does not come to an end: the part that a wave takes longest to
   cross, and what its units probably are; empty where none takes more than 50 periods of hz (Hz). Not collective;
   after ModelSetUp(). @*/
PetscErrorCode ModelDescribeDoubt(Model model, PetscReal hz, size_t size, char text[]);

/*@ ModelAddChecksum - adds mesh, materials, supports, motions, springs and dashpots; with_partition: also which rank
   has which cells. Collective; after ModelSetUp(). @*/
PetscErrorCode ModelAddChecksum(Model model, PetscBool with_partition, Checksum checksum);

/*@ ModelHasGravity - whether the acceleration of gravity is not zero. Not collective. @*/
PetscBool ModelHasGravity(Model model);

/*@ ModelAddLoadsChecksum - adds the loads, and gravity. Collective. @*/
PetscErrorCode ModelAddLoadsChecksum(Model model, Checksum checksum);

/*@ ModelCheckMotion - raises PETSC_ERR_USER_INPUT for a motion that prescribes no direction of a node (n_held = 0),
   or one that another prescribes (n_twice > 0); counts of this rank. Collective. @*/
PetscErrorCode ModelCheckMotion(Model model, const PrescribedMotion *motion, PetscInt n_held, PetscInt n_twice);

/*@ ModelDescribeMotion - such as "motion lift: head_top moved by 0, 0, 1e-06 m (z prescribed)". Not collective. @*/
PetscErrorCode ModelDescribeMotion(const PrescribedMotion *motion, size_t size, char words[]);

/*@ ModelAddSetChecksum - adds name and nodes of a set to the present part, and its faces where it is a surface.
    Collective. @*/
PetscErrorCode ModelAddSetChecksum(Model model, const char set[], PetscBool is_surface, Checksum checksum);

/*@
   ModelUnits - the set of units of the scene, by density and modulus of its parts

   Not collective; after ModelSetUp()

   Output Parameter:
.  units - "mm, t, s, N, MPa" where both are of that set in every part, "m, kg, s, N, Pa" where they are in none; NULL
           where parts differ or are in doubt
@*/
PetscErrorCode ModelUnits(Model model, const char **units);

/*@ ModelFindRow - the row of an option of the names of a list, such as young of -parts; NULL for none. Not
   collective. @*/
const Quantity *ModelFindRow(const char list[], const char name[]);

/*@ ModelGetUnit - what the scene's set of units has for a unit of m, kg, s, N, Pa: mm for m and so on with mm, t, s, N,
    MPa, else the same. For m, m^2, m^3, m/s, s/m, kg, kg/m^3, Pa, m/N, N/m, N/m^3, N s/m, N s/m^3, N m, N m/rad, N m
    s/rad. Not collective; after ModelSetUp(). @*/
PetscErrorCode ModelGetUnit(Model model, const char si[], const char **unit);

#define MODEL_MANY_PAIRS 1000 /* of contact: their messages cost less than they do */

/* Whether in time all ranks solve n_pairs of contact: there are many, and they would take one rank longer than its
   share of the cells, some 160 ns for a pair and 40 ns for a cell */
static inline PetscBool ModelSharesPairs(PetscInt n_pairs, PetscInt n_ranks, PetscInt n_cells)
{
  return n_pairs >= MODEL_MANY_PAIRS && 4 * (PetscInt64)n_pairs * n_ranks > n_cells ? PETSC_TRUE : PETSC_FALSE;
}

/*@ ModelView - prints in words what the scene needs: counts, parts, supports, springs. Collective. @*/
PetscErrorCode ModelView(Model model, PetscViewer viewer);

/*@ ModelDestroy - frees the model. Collective. @*/
PetscErrorCode ModelDestroy(Model *model);
