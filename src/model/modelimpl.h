/* Private to model/: the model's record and the files that fill it */
#pragma once

#include <squeal/model.h>
#include <squeal/quantity.h>

#define MODEL_MAX_NAMES 64 /* names in one list of the scene */

/* Dimensions (m) and counts of the built-in disc-pad-beam rig. z is the disc's axis; the pad stands on the disc's face
   z = 0 at angle 0 (centre x = pad_radius, y = 0), the beam on the pad; the disc lies in -disc_thickness < z < 0. */
typedef struct {
  PetscReal disc_inner, disc_outer, disc_thickness; /* radii 50, 120 and thickness 10 mm */
  PetscInt  disc_nr, disc_ntheta, disc_nz;          /* 21 x 100 x 3 */
  PetscBool has_disc_elements;                      /* these are given */
  PetscBool patch;                                  /* disc mesh with a Cartesian patch that matches the pad's grid */
  PetscReal disc_spread;                            /* 0..1: how far rings even out away from the patch */
  PetscBool with_pad;                               /* false: the disc alone */
  PetscReal pad_radius;                             /* radius of the pad's centre, 110 mm */
  PetscReal pad_size[3];                            /* 10, 10, 10 mm */
  PetscInt  pad_n[3];                               /* 10, 10, 10 */
  PetscReal beam_height;                            /* 100 mm; its section is the pad's */
  PetscInt  beam_nz;                                /* 20 */
  PetscReal beam_rows[2];             /* heights of the two spring rows above the beam's lower end, 20 and 80 mm */
  char      save[PETSC_MAX_PATH_LEN]; /* file of Gmsh to write, "" for none */
} Rig;

/* What a part takes up */
typedef struct {
  PetscReal size[3], volume; /* bounding box, m; m^3 */
} PartExtent;

struct _p_Model {
  MPI_Comm comm;
  /* set by options */
  PetscBool  given;                         /* the scene names a mesh */
  PetscBool  from_file, has_file, has_loss; /* the mesh comes from a file, not from the rig; what is given */
  char       file[PETSC_MAX_PATH_LEN], formulation[32];
  PetscBool  has_formulation; /* -model_element is given */
  Rig        rig;
  ModelScene scene;
  PetscInt   n_together;
  char      *together[MODEL_MAX_NAMES]; /* sets whose cells stay on one rank */
  PetscBool  hold_motions;              /* the directions of motions are no unknowns */
  PetscInt   n_apart;                   /* unknowns that no node has */
  PetscBool  has_superelements;         /* points may be there for them alone */
  PetscBool  keep_slabs;                /* swept bodies are cut between slabs, and no set is kept together */
  /* built by ModelSetUp() */
  DM          dm;
  Mesh        mesh;
  PetscInt   *node_of, *point_of; /* [points of the DM] node, -1 for none; [nodes] point */
  PartExtent *extent;             /* of each part */
};

/* extent.c - measures the parts; a warning where their units do not fit together. Collective */
PETSC_INTERN PetscErrorCode PartsCheckUnits(Model model);
PETSC_INTERN PetscErrorCode PartView(Model model, PetscInt part, PetscViewer viewer);

/* layer.c - thickness and normal of the layers whose thickness is given, before the mesh is distributed; raises an
   error for a part that is no flat layer of one thickness. Collective */
PETSC_INTERN PetscErrorCode LayersMeasure(Model model);

/* unit.c - what the units of a part probably are where they do not fit together; NULL where they do */
PETSC_INTERN const char *PartDoubt(const Part *part, const PartExtent *extent);

/* rig.c - dimensions and counts of the rig; errors for impossible ones */
PETSC_INTERN PetscErrorCode RigSetFromOptions(MPI_Comm comm, Rig *rig);

/* rigsave.c - writes the rig's mesh and sets to the file of -rig_save, before it is cut. Collective */
PETSC_INTERN PetscErrorCode RigSave(Model model);

/* generate.c - the rig on rank 0 as an interpolated DMPlex with the sets disc, pad, beam (cells), disc_inner,
   disc_face, pad_face, beam_top (faces), beam_rows (nodes); error for a beam with too few node levels for its rows
   */
PETSC_INTERN PetscErrorCode RigGenerate(MPI_Comm comm, const Rig *rig, DM *dm);

/* import.c - a Gmsh file (2.2, 4.1) on rank 0 as an interpolated DMPlex whose physical names are labels with value 1 */
PETSC_INTERN PetscErrorCode ImportGmsh(MPI_Comm comm, const char file[], DM *dm);

/* partition.c - distributes the mesh from rank 0 by METIS on the dual graph; the cells at the contact of the sets in
   `together` end on one rank, or whole slabs of swept bodies do. Replaces model->dm and its tables; with one rank it
   does nothing. */
PETSC_INTERN PetscErrorCode PartitionMesh(Model model);

/* tabulate.c - the tables of the local mesh but for its unknowns, now or after distribution; and frees all of them.
   Collective. */
PETSC_INTERN PetscErrorCode MeshTabulate(Model model);
PETSC_INTERN PetscErrorCode MeshReset(Model model);

/* tabulate.c - which of n nodes are in the closure of a point, as bits */
PETSC_INTERN PetscErrorCode PointGetCorners(DM dm, PetscInt point, PetscInt n, const PetscInt vertex[],
                                            unsigned *corners);

/* The lists of the scene, whose records have files of their own: part.c, support.c, grounded.c, load.c, motion.c,
   probe.c, circle.c, joint.c */
PETSC_INTERN const QuantityTable model_quantities, rig_quantities, spring_quantities, dashpot_quantities;
PETSC_INTERN const QuantityList  parts_list, supports_list, springs_list, dashpots_list, loads_list, motions_list,
  probes_list, circles_list, joints_list, points_list;
#define SET_WANTED "a named set of the mesh"

/* The same files - what the rows of a record do not say; owner is the model */
PETSC_INTERN PetscErrorCode PartCheck(MPI_Comm comm, void *owner, void *part);
PETSC_INTERN PetscErrorCode SupportCheck(MPI_Comm comm, void *owner, void *support);
PETSC_INTERN PetscErrorCode SpringCheck(MPI_Comm comm, void *owner, void *grounded);
PETSC_INTERN PetscErrorCode DashpotCheck(MPI_Comm comm, void *owner, void *grounded);
PETSC_INTERN PetscErrorCode JointCheck(MPI_Comm comm, void *owner, void *joint);
PETSC_INTERN PetscErrorCode PointCheck(MPI_Comm comm, void *owner, void *joint);
PETSC_INTERN PetscErrorCode LoadCheck(MPI_Comm comm, void *owner, void *load);
PETSC_INTERN PetscErrorCode MotionCheck(MPI_Comm comm, void *owner, void *motion);
PETSC_INTERN PetscErrorCode ProbeCheck(MPI_Comm comm, void *owner, void *probe);
PETSC_INTERN PetscErrorCode CircleCheck(MPI_Comm comm, void *owner, void *circle);

/* A set whose mean motion is asked for, where it was asked for, and the sign that it counts with */
typedef struct {
  const char      *owner, *option, *set; /* -owner_option set */
  const char      *turns;                /* what asks for the rotations, such as -tip_inertia; empty for nothing */
  PetscReal        sign;
  const PetscReal *at; /* place, m */
} ModelMeanWish;

/* mean.c - the middle of a set, m, and its rows where b is given; the sum of the mean motions of sets, each about its
   place, with its sign. Collective. Errors: PETSC_ERR_USER_INPUT for a rotation of nodes on one line. */
PETSC_INTERN PetscErrorCode MeanFindMiddle(Model model, const ModelMeanWish *wish, PetscReal middle[3],
                                           PetscReal b[][3][6]);
PETSC_INTERN PetscErrorCode MeanCreate(Model model, PetscInt n_wishes, const ModelMeanWish wish[], ModelMean *mean);
PETSC_INTERN PetscErrorCode MeanDestroy(ModelMean *mean);

/* mean.c - eigenvalues, ascending, and -vectors [3][3] of a symmetric matrix xx, yy, zz, xy, xz, yz */
PETSC_INTERN PetscErrorCode InertiaPrincipal(const PetscReal inertia[6], PetscReal principal[3], PetscReal axes[9]);
/* joint.c - the motions of all bushings and points, frees these; the point that -`load`_point names; a line about
   one */
PETSC_INTERN PetscErrorCode JointsSetUp(Model model);
PETSC_INTERN PetscErrorCode JointsDestroy(PetscInt n, Joint joint[]);
PETSC_INTERN PetscErrorCode JointFindPoint(Model model, const char load[], const char name[], PetscInt *index);
PETSC_INTERN PetscErrorCode JointView(Model model, const Joint *joint, PetscViewer viewer);

/* anisotropic.c - Young's moduli, Poisson's ratios, shear moduli and axes of a part; errors for numbers of values that
   do not belong together, for axes that are none, and for a stiffness that is not positive definite */
PETSC_INTERN PetscErrorCode PartSetElasticity(MPI_Comm comm, Part *part);
PETSC_INTERN PetscErrorCode AnisotropyView(Model model, const Anisotropy *a, PetscViewer viewer);

/* spin.c - steady spin of a part; errors for one without axis, for a part that is no body of revolution, for a material
   that does not turn into itself, and for parts that share nodes but do not spin alike. SpinsCheck() tells which parts
   share nodes; before the mesh is distributed, collective */
PETSC_INTERN PetscErrorCode PartCheckSpin(MPI_Comm comm, Part *part);
PETSC_INTERN PetscErrorCode SpinsCheck(Model model);
PETSC_INTERN PetscErrorCode SpinView(const Spin *spin, PetscViewer viewer);

/* material.c - raises an error for a cylinder's axis through the centre of a cell. Collective */
PETSC_INTERN PetscErrorCode ModelCheckAxes(Model model);

/* part.c - the loss factors as stiffness damping, or laws of the stiffness; an error for the reverse */
PETSC_INTERN PetscErrorCode PartsAddLoss(Model model);

/* part.c - checks the materials, and finds the part of each cell */
PETSC_INTERN PetscErrorCode PartsCheck(Model model);
PETSC_INTERN PetscErrorCode PartsFindCells(Model model, PetscInt cell_part[]);

/* layout.c - the unknowns: displacements that no support fixes. Fills their part of the tables. */
PETSC_INTERN PetscErrorCode MeshLayOut(Model model);

/* load.c - resultants of the loads; raises an error for a set that the mesh does not have, that has no node of an
   element, or that is no surface where a pressure needs one */
PETSC_INTERN PetscErrorCode LoadsSetUp(Model model);
/* scene/loads/bolt.c - whether a load is a bolt, and whether all is given; that its part has a cut there; a line */
PETSC_INTERN PetscErrorCode BoltCheck(MPI_Comm comm, Model model, Load *load);
PETSC_INTERN PetscErrorCode BoltSetUp(Model model, Load *load);
PETSC_INTERN PetscErrorCode BoltView(Model model, const Load *load, PetscViewer viewer);
PETSC_INTERN PetscErrorCode LoadView(Model model, const Load *load, PetscViewer viewer);

/* spread.c - as ModelCreateShares(); consistent: int N_v dA, as loads are spread */
PETSC_INTERN PetscErrorCode SharesCreate(Model model, const char owner[], const char set[], Spread spread,
                                         PetscBool consistent, Vec *shares);

/* grounded.c - errors for sets that a spring or dashpot cannot be spread over; a line about it */
PETSC_INTERN PetscErrorCode GroundedSetUp(Model model);
PETSC_INTERN PetscErrorCode GroundedView(Model model, const Grounded *grounded, const char kind[], PetscViewer viewer);

/* Values of a set's label: at a point that is in it with all nodes on it and around it, or at one whose own node alone
   is in it (in the middle of an edge or face) */
enum { SET_CLOSED = 1, SET_ALONE = 2 };

/* set.c - points of this rank that are in a set with all nodes around them, those of range[0] .. range[1] - 1, NULL for
   all; the caller frees them. An error when no rank has a point of the set. Collective */
PETSC_INTERN PetscErrorCode SetGetPoints(Model model, const char set[], const PetscInt range[2], PetscInt *n,
                                         PetscInt **point);
/* Whether another rank owns a point. Not collective */
PETSC_INTERN PetscErrorCode PointIsElsewhere(Model model, PetscInt point, PetscBool *elsewhere);

/* face.c - faces of a set with cells on both sides, of all ranks; each is counted at least once. Collective */
PETSC_INTERN PetscErrorCode ModelCountInnerFaces(Model model, const char set[], PetscInt *n);

/* face.c - the faces of a part that no two of its cells share, before the mesh is distributed; freed by
   ModelFacesDestroy() */
PETSC_INTERN PetscErrorCode PartGetFaces(Model model, PetscInt part, ModelFaces *faces);

/* motion.c - flags what the motions prescribe and no support fixes in fixed [node][3], and tabulates how far they go;
   errors for an unknown set, and those of ModelCheckMotion(). Collective. */
PETSC_INTERN PetscErrorCode MotionsFlag(Model model, PetscBool fixed[][3]);

/* probe.c - places that histories record: reads them, and finds their nodes */
PETSC_INTERN PetscErrorCode ProbeLocate(Model model, Probe *probe);
PETSC_INTERN PetscErrorCode ProbesLocate(Model model);
PETSC_INTERN PetscErrorCode ProbesView(Model model, PetscViewer viewer);

/* circle.c - circles of such places; Destroy frees the places alone */
PETSC_INTERN PetscErrorCode CirclesLocate(Model model);
PETSC_INTERN PetscErrorCode CirclesView(Model model, PetscViewer viewer);
PETSC_INTERN PetscErrorCode CirclesDestroy(Model model);

/* check.c - raises an error for a bad cell, or for a formulation without effect, and warns of elements that lock;
   before the mesh is distributed */
PETSC_INTERN PetscErrorCode MeshCheck(Model model);

/* check.c - the elements of the mesh in words: "8-node hexahedron", or "100 tet10, 20 hex20". Collective */
PETSC_INTERN PetscErrorCode MeshDescribe(Model model, size_t size, char words[]);

/* set.c - whether a label is of the mesh itself, and no set */
PETSC_INTERN PetscErrorCode ModelLabelIsOwn(const char name[], PetscBool *own);

/* set.c - raises the error for a name that the mesh does not have, with the names that it has; what = "volume" or
   "set" */
PETSC_INTERN PetscErrorCode ModelComplainSet(Model model, const char what[], const char name[]);
