/* Options of the model, and of what a scene names: each name is the prefix of the rows of its list */
#include "modelimpl.h"
#include <string.h>

/* Modes with all pairs closed need no equilibrium */
#define LOADS .in = RUN_IN_TIME | RUN_EQUILIBRIUM, .unread = " with all pairs closed; give -modes_contact static"
#define MOVING                                                                                                         \
  .in = RUN_MOVES | RUN_SUPERELEMENT, .unread = ", where nothing moves and nothing is damped" /* inertia but for weight, and damping */
#define WEIGHS   .in = RUN_MOVES | RUN_WEIGHT, .unread = " without -model_gravity"
#define RECORDED RUN_TRANSIENT | RUN_CYCLE | RUN_FRF
#define SET      "named surface, curve, point or volume of the mesh"

#define PART(member)     QUANTITY_AT(Part, member)
#define SUPPORT(member)  QUANTITY_AT(Support, member)
#define GROUNDED(member) QUANTITY_AT(Grounded, member)
#define JOINT(member)    QUANTITY_AT(Joint, member)
#define LOAD(member)     QUANTITY_AT(Load, member)
#define MOTION(member)   QUANTITY_AT(PrescribedMotion, member)
#define PROBE(member)    QUANTITY_AT(Probe, member)
#define CIRCLE(member)   QUANTITY_AT(Circle, member)
#define MODEL(member)    QUANTITY_AT(struct _p_Model, member)

/* Three of six values: along x, y, z, or about them */
#define JOINT_THREE(member, first) .at = offsetof(Joint, member[first]), .size = 3 * sizeof(PetscReal)

#define TABLE(title, rows, ...)                                                                                        \
  {                                                                                                                    \
    title, "model.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows, __VA_ARGS__                                               \
  }

static const char *const sources[] = {[PETSC_FALSE] = "rig", [PETSC_TRUE] = "file", NULL};
static const char *const joins[]   = {[PETSC_FALSE] = "mean", [PETSC_TRUE] = "rigid", NULL};

#define RIG(member)              QUANTITY_AT(Rig, member)
#define RIG_COUNTS(member, more) .at = offsetof(Rig, member), .size = (more) * sizeof(PetscInt)

static const char *const discs[] = {[PETSC_FALSE] = "axisymmetric", [PETSC_TRUE] = "patch", NULL};

static const Quantity rig[] = {
  {"-rig_disc_inner", "inner radius of the disc", "m", QUANTITY_REAL, RIG(disc_inner), .initial = 0.05,
   QUANTITY_POSITIVE},
  {"-rig_disc_outer", "outer radius of the disc", "m", QUANTITY_REAL, RIG(disc_outer), .initial = 0.12},
  {"-rig_disc_thickness", "thickness of the disc", "m", QUANTITY_REAL, RIG(disc_thickness), .initial = 0.01,
   QUANTITY_POSITIVE},
  {"-rig_disc_mesh", "grid of the disc: axisymmetric, or with a patch that matches the pad", NULL, QUANTITY_WORD,
   RIG(patch), .initial = PETSC_TRUE, .words = discs},
  {"-rig_disc_elements", "elements of the disc: rings, columns, layers (21,100,3, axisymmetric 16,160,4)", NULL,
   QUANTITY_INTS, RIG_COUNTS(disc_nr, 3), QUANTITY_POSITIVE, .text = "21,100,3",
   .given = offsetof(Rig, has_disc_elements)},
  {"-rig_disc_spread", "rings away from the patch: 0 keep their radii, 1 become uniform", NULL, QUANTITY_REAL,
   RIG(disc_spread), QUANTITY_WITHIN(0, 1)},
  {"-rig_pad", "pad and beam as well as the disc", NULL, QUANTITY_BOOL, RIG(with_pad), .initial = PETSC_TRUE},
  {"-rig_pad_radius", "radius of the pad's centre", "m", QUANTITY_REAL, RIG(pad_radius), .initial = 0.11},
  {"-rig_pad_size", "size of the pad in x, y, z", "m", QUANTITY_REALS, RIG(pad_size), QUANTITY_POSITIVE,
   .text = "0.01,0.01,0.01"},
  {"-rig_pad_elements", "elements of the pad in x, y, z", NULL, QUANTITY_INTS, RIG_COUNTS(pad_n, 3), QUANTITY_POSITIVE,
   .text = "10,10,10"},
  {"-rig_beam_height", "height of the beam", "m", QUANTITY_REAL, RIG(beam_height), .initial = 0.1, QUANTITY_POSITIVE},
  {"-rig_beam_elements", "elements of the beam over its height", NULL, QUANTITY_INT, RIG(beam_nz), .initial = 20,
   QUANTITY_POSITIVE},
  {"-rig_beam_rows", "heights of the spring rows above the beam's lower end", "m", QUANTITY_REALS, RIG(beam_rows),
   .text = "0.02,0.08"},
  {"-rig_save", "file of Gmsh to write the mesh and its sets to", NULL, QUANTITY_TEXT, RIG(save), .path = "file"},
};
const QuantityTable rig_quantities = TABLE("Built-in disc, pad and beam", rig, .in = 0);

static const Quantity model[] = {
  {"-model_source", "mesh: the built-in disc-pad-beam rig, or a file", NULL, QUANTITY_WORD, MODEL(from_file),
   .words = sources, .given = offsetof(struct _p_Model, given)},
  {"-model_mesh", "Gmsh file, format 2.2 or 4.1, with physical names", NULL, QUANTITY_PATH, MODEL(file),
   .given = offsetof(struct _p_Model, has_file), .path = "file"},
  {"-model_element", "8-node hexahedra: incompatible (QM6) or full (trilinear)", NULL, QUANTITY_TEXT,
   MODEL(formulation), .text = "incompatible", .given = offsetof(struct _p_Model, has_formulation)},
  {"-model_gravity", "acceleration of gravity in x,y,z", "m/s^2", QUANTITY_REALS, MODEL(scene.gravity), LOADS},
  {"-model_loss_frequency", "where the loss factors of the parts are exact", "Hz", QUANTITY_REAL,
   MODEL(scene.loss_frequency), .given = offsetof(struct _p_Model, has_loss)},
  {"-model_equations",
   "linear equations between displacements of nodes: a table equation,x_m,y_m,z_m,direction,coefficient", NULL,
   QUANTITY_PATH, MODEL(scene.equations), .path = "file"},
};

const QuantityTable model_quantities = TABLE("Model", model, .in = 0);

/* Young's moduli, Poisson's ratios and densities are checked with the mesh: the rig's own parts need no -parts for
   -help */
static const Quantity part[] = {
  {"-volume", "volume of the mesh that it is; default the part's own name", NULL, QUANTITY_NAME, PART(volume)},
  {"-young", "Young's modulus; E_p,E_z transversely isotropic; E_1,E_2,E_3", "Pa", QUANTITY_LIST, PART(asked.young),
   QUANTITY_OR_NONE, .count = offsetof(Part, asked.n_young), .required = PETSC_TRUE, .varies = VARIES_ALL},
  {"-poisson", "Poisson's ratio, in (-1, 0.5); nu_p,nu_pz; nu_12,nu_13,nu_23", NULL, QUANTITY_LIST, PART(asked.poisson),
   .count = offsetof(Part, asked.n_poisson), .text = "0.3"},
  {"-shear", "shear modulus of two or three -young: G_pz or G_12,G_13,G_23", "Pa", QUANTITY_LIST, PART(asked.shear),
   .count = offsetof(Part, asked.n_shear)},
  {"-axis_1", "direction 1 of the material, x,y,z", NULL, QUANTITY_REALS, PART(asked.axis[AXIS_1]),
   .given = offsetof(Part, asked.given[AXIS_1])},
  {"-axis_2", "direction 2, made orthogonal to 1", NULL, QUANTITY_REALS, PART(asked.axis[AXIS_2]),
   .given = offsetof(Part, asked.given[AXIS_2])},
  {"-axis_3", "direction across the isotropic plane of two -young", NULL, QUANTITY_REALS, PART(asked.axis[AXIS_3]),
   .given = offsetof(Part, asked.given[AXIS_3])},
  {"-cylinder_axis", "instead: 1 radial, 2 circumferential, 3 along this axis", NULL, QUANTITY_REALS,
   PART(asked.axis[AXIS_CYLINDER]), .given = offsetof(Part, asked.given[AXIS_CYLINDER])},
  {"-cylinder_centre", "a point of that axis", "m", QUANTITY_REALS, PART(asked.axis[AXIS_CENTRE]),
   .given = offsetof(Part, asked.given[AXIS_CENTRE])},
  {"-density", "density", "kg/m^3", QUANTITY_REAL, PART(density), QUANTITY_OR_NONE, WEIGHS, .always = PETSC_TRUE,
   .required = PETSC_TRUE, .varies = VARIES_ALL},
  {"-alpha", "Rayleigh factor of the mass", "1/s", QUANTITY_REAL, PART(alpha), QUANTITY_NOT_NEGATIVE, MOVING,
   .varies = VARIES_ALL | VARIES_DAMPING},
  {"-beta", "Rayleigh factor of the stiffness", "s", QUANTITY_REAL, PART(beta), QUANTITY_NOT_NEGATIVE, MOVING,
   .varies = VARIES_ALL | VARIES_DAMPING},
  {"-loss_factor", "loss factor of the stiffness at every frequency; with -model_loss_frequency there, adds to beta",
   NULL, QUANTITY_REAL, PART(loss), QUANTITY_NOT_NEGATIVE, MOVING, VISCOELASTIC_VARIES},
  VISCOELASTIC_ROWS(Part, viscous, MOVING),
  {"-thickness", "thickness of a flat layer (default: that of the mesh); what lies on it moves with it", "m",
   QUANTITY_REAL, PART(layer.thickness), QUANTITY_POSITIVE, .given = offsetof(Part, layer.given),
   .varies = VARIES_LINEAR},
  {"-thickness_axis", "x,y,z, direction across the layer where that is not its thin one", NULL, QUANTITY_REALS,
   PART(layer.normal), .given = offsetof(Part, layer.has_axis)},
  {"-spin", "spin about -spin_axis, in modes: gyroscopic and centrifugal terms", "rad/s", QUANTITY_REAL,
   PART(spin.rate), .given = offsetof(Part, spin.given), .in = RUN_LINEAR,
   .unread = "; it belongs to modes, sweep, frf, sample, quiet and design; in time a contact's -..._kinematics turning "
             "turns its master",
   .varies = VARIES_LINEAR | VARIES_DAMPING},
  {"-spin_axis", "x,y,z, about which a positive spin is right-handed", NULL, QUANTITY_REALS, PART(spin.axis),
   .given = offsetof(Part, spin.has_axis)},
  {"-spin_centre", "a point of that axis", "m", QUANTITY_REALS, PART(spin.centre),
   .given = offsetof(Part, spin.has_centre)},
};
static const Quantity support[] = {
  {"-set", SET, NULL, QUANTITY_NAME, SUPPORT(set), .required = PETSC_TRUE, .why = SET_WANTED},
  {"-fix", "directions that are held: some of x, y, z", NULL, QUANTITY_TEXT, SUPPORT(word), .text = "xyz"},
};
static const Quantity spring[] = {
  {"-set", SET, NULL, QUANTITY_NAME, GROUNDED(set), .required = PETSC_TRUE, .why = SET_WANTED},
  {"-stiffness", "stiffness in x,y,z at every node", "N/m", QUANTITY_REALS, GROUNDED(asked[SPREAD_EACH]),
   QUANTITY_NOT_NEGATIVE, .given = offsetof(Grounded, given[SPREAD_EACH]), .varies = VARIES_ALL},
  {"-stiffness_total", "instead: stiffness in x,y,z of the whole set", "N/m", QUANTITY_REALS,
   GROUNDED(asked[SPREAD_TOTAL]), QUANTITY_NOT_NEGATIVE, .given = offsetof(Grounded, given[SPREAD_TOTAL]),
   .varies = VARIES_ALL},
  {"-stiffness_per_area", "instead: stiffness in x,y,z per area", "N/m^3", QUANTITY_REALS, GROUNDED(asked[SPREAD_AREA]),
   QUANTITY_NOT_NEGATIVE, .given = offsetof(Grounded, given[SPREAD_AREA]), .varies = VARIES_ALL},
};
static const Quantity dashpot[] = {
  {"-set", SET, NULL, QUANTITY_NAME, GROUNDED(set), .required = PETSC_TRUE, .why = SET_WANTED},
  {"-viscosity", "viscosity in x,y,z at every node", "N s/m", QUANTITY_REALS, GROUNDED(asked[SPREAD_EACH]),
   QUANTITY_NOT_NEGATIVE, .given = offsetof(Grounded, given[SPREAD_EACH]), MOVING,
   .varies = VARIES_ALL | VARIES_DAMPING},
  {"-viscosity_total", "instead: viscosity in x,y,z of the whole set", "N s/m", QUANTITY_REALS,
   GROUNDED(asked[SPREAD_TOTAL]), QUANTITY_NOT_NEGATIVE, .given = offsetof(Grounded, given[SPREAD_TOTAL]), MOVING,
   .varies = VARIES_ALL | VARIES_DAMPING},
  {"-viscosity_per_area", "instead: viscosity in x,y,z per area", "N s/m^3", QUANTITY_REALS,
   GROUNDED(asked[SPREAD_AREA]), QUANTITY_NOT_NEGATIVE, .given = offsetof(Grounded, given[SPREAD_AREA]), MOVING,
   .varies = VARIES_ALL | VARIES_DAMPING},
};

/* What resists the motions of a bushing or a point, and where they are taken */
#define HOLDERS                                                                                                        \
  {                                                                                                                    \
    "-at",     "place of its motions; default the middle",                                                             \
    "m",       QUANTITY_REALS,                                                                                         \
    JOINT(at), .given = offsetof(Joint, has_at)},                                                                      \
    {"-stiffness",          "stiffness in x,y,z", "N/m", QUANTITY_REALS, JOINT_THREE(stiffness, 0),                    \
     QUANTITY_NOT_NEGATIVE, .varies = VARIES_ALL},                                                                     \
    {"-turn_stiffness",         "stiffness about x,y,z", "N m/rad",           QUANTITY_REALS,                          \
     JOINT_THREE(stiffness, 3), QUANTITY_NOT_NEGATIVE,   .varies = VARIES_ALL},                                        \
    {"-viscosity",                                                                                                     \
     "viscosity in x,y,z",                                                                                             \
     "N s/m",                                                                                                          \
     QUANTITY_REALS,                                                                                                   \
     JOINT_THREE(viscosity, 0),                                                                                        \
     QUANTITY_NOT_NEGATIVE,                                                                                            \
     MOVING,                                                                                                           \
     .varies = VARIES_ALL | VARIES_DAMPING},                                                                           \
  {                                                                                                                    \
    "-turn_viscosity", "viscosity about x,y,z", "N m s/rad", QUANTITY_REALS, JOINT_THREE(viscosity, 3),                \
      QUANTITY_NOT_NEGATIVE, MOVING, .varies = VARIES_ALL | VARIES_DAMPING                                             \
  }

static const Quantity joint[] = {
  {"-a", "named set of one side", NULL, QUANTITY_NAME, JOINT(set[0]), .required = PETSC_TRUE, .why = SET_WANTED},
  {"-b", "named set of the other side; default the ground", NULL, QUANTITY_NAME, JOINT(set[1])},
  {"-at_b", "place of the motions of side b, where it is another one", "m", QUANTITY_REALS, JOINT(at_b),
   .given = offsetof(Joint, has_at_b)},
  {"-axis_1", "direction of its x; default that of space", NULL, QUANTITY_REALS, JOINT(axis[0]),
   .given = offsetof(Joint, has_axis[0])},
  {"-axis_2", "direction of its y, of which what is along x is taken off; default any", NULL, QUANTITY_REALS,
   JOINT(axis[1]), .given = offsetof(Joint, has_axis[1])},
  HOLDERS,
};
static const Quantity point[] = {
  {"-set", SET, NULL, QUANTITY_NAME, JOINT(set[0]), .required = PETSC_TRUE, .why = SET_WANTED},
  {"-join", "the set moves freely, the point with it in the mean; or as one rigid body", NULL, QUANTITY_WORD,
   JOINT(rigid), .words = joins},
  HOLDERS,
  {"-mass", "mass", "kg", QUANTITY_REAL, JOINT(mass), QUANTITY_NOT_NEGATIVE, WEIGHS, .varies = VARIES_ALL},
  {"-inertia", "inertia about its place: xx,yy,zz or xx,yy,zz,xy,xz,yz", "kg m^2", QUANTITY_LIST, JOINT(inertia),
   .count = offsetof(Joint, n_inertia), MOVING},
};
static const Quantity load[] = {
  {"-set", SET ", unless it acts on a point", NULL, QUANTITY_NAME, LOAD(set)},
  {"-point", "instead of a set: one of the -points", NULL, QUANTITY_NAME, LOAD(on)},
  {"-moment", "on a point: moment about x,y,z", "N m", QUANTITY_REALS, LOAD(moment),
   .given = offsetof(Load, has_moment), .varies = VARIES_ALL},
  {"-force", "total force in x,y,z", "N", QUANTITY_REALS, LOAD(force), .given = offsetof(Load, has_force),
   .varies = VARIES_ALL},
  {"-pressure", "instead of a force: pressure on a surface, into the body", "Pa", QUANTITY_REAL, LOAD(pressure),
   .given = offsetof(Load, is_pressure), .varies = VARIES_ALL},
  {"-tension", "instead of a force: of a bolt that is cut at the nodes of the set and tightened", "N", QUANTITY_REAL,
   LOAD(tension), QUANTITY_POSITIVE, .given = offsetof(Load, has_tension), .varies = VARIES_LINEAR},
  {"-shortening", "instead of a tension: by how much the bolt is shortened", "m", QUANTITY_REAL, LOAD(shortening),
   QUANTITY_POSITIVE, .given = offsetof(Load, has_shortening), .varies = VARIES_LINEAR},
  {"-part", "of a bolt: part on one side of the cut; that on the other shares the nodes", NULL, QUANTITY_NAME,
   LOAD(part)},
  {"-axis", "of a bolt: direction x,y,z out of this part through the cut", NULL, QUANTITY_REALS, LOAD(axis),
   .given = offsetof(Load, has_axis)},
};
static const Quantity motion[] = {
  {"-set", SET, NULL, QUANTITY_NAME, MOTION(set), .required = PETSC_TRUE, .why = SET_WANTED},
  {"-displacement", "in x,y,z", "m", QUANTITY_REALS, MOTION(displacement)},
  {"-directions", "that are prescribed: some of x, y, z; by default those of the displacement", NULL, QUANTITY_TEXT,
   MOTION(word), .given = offsetof(PrescribedMotion, has_word)},
};
static const Quantity probe[] = {
  {"-at", "place x,y,z; the nearest node is taken", "m", QUANTITY_REALS, PROBE(at), .given = offsetof(Probe, has_at),
   .required = PETSC_TRUE, .why = "the place x,y,z (m)"},
  {"-part", "part that has the node; default any", NULL, QUANTITY_NAME, PROBE(part)},
};
static const Quantity circle[] = {
  {"-radius", "radius", "m", QUANTITY_REAL, CIRCLE(radius), .required = PETSC_TRUE},
  {"-count", "nodes at equal angles", NULL, QUANTITY_INT, CIRCLE(n), .required = PETSC_TRUE},
  {"-part", "body that has them", NULL, QUANTITY_NAME, CIRCLE(part), .text = "disc"},
  {"-face", "side of the body, across which they move: x+, x-, y+, y-, z+ or z-", NULL, QUANTITY_TEXT, CIRCLE(face),
   .text = "z+"},
  {"-centre", "x,y,z; default the middle of the part", "m", QUANTITY_REALS, CIRCLE(centre),
   .given = offsetof(Circle, has_centre)},
  {"-tolerance", "most distance of a node from its place; default a twentieth of the radius", "m", QUANTITY_REAL,
   CIRCLE(tolerance), .given = offsetof(Circle, has_tolerance)},
};

static const QuantityTable parts = TABLE("Part", part, .in = 0), supports = TABLE("Support", support, .in = 0),
                           joints = TABLE("Bushing", joint, .in = 0), points = TABLE("Point", point, .in = 0),
                           loads = TABLE("Load", load, LOADS), motions = TABLE("Motion", motion, .in = 0),
                           probes      = TABLE("Probe", probe, .in = RECORDED),
                           circles     = TABLE("Circle", circle, .in = RECORDED);
const QuantityTable spring_quantities  = TABLE("Grounded spring", spring, .in = 0),
                    dashpot_quantities = TABLE("Grounded dashpot", dashpot, .in = 0);

const QuantityList parts_list = {
  "-parts", "bodies: volumes of the mesh, each the prefix of its material", sizeof(Part), &parts, PartCheck, .in = 0};
const QuantityList supports_list = {"-supports",     "essential conditions, each the prefix of its -set and -fix",
                                    sizeof(Support), &supports,
                                    SupportCheck,    .in = 0};
const QuantityList springs_list  = {
   "-springs", "each the prefix of its -set and value", sizeof(Grounded), &spring_quantities, SpringCheck, .in = 0};
const QuantityList dashpots_list = {
  "-dashpots", "each the prefix of its -set and value", sizeof(Grounded), &dashpot_quantities, DashpotCheck, .in = 0};
const QuantityList joints_list = {
  "-joints", "bushings, each the prefix of its -a, -b and -stiffness", sizeof(Joint), &joints, JointCheck, .in = 0};
const QuantityList points_list = {"-points",     "points joined to sets, each the prefix of its -set and -mass",
                                  sizeof(Joint), &points,
                                  PointCheck,    .in = 0};
const QuantityList loads_list  = {
   "-loads", "forces, each the prefix of its -set and -force, -pressure, or -tension of a bolt", sizeof(Load), &loads, LoadCheck, .in = 0};
const QuantityList motions_list = {
  "-motions", "prescribed displacements, each the prefix of its -set", sizeof(PrescribedMotion), &motions, MotionCheck,
  .in = 0};
const QuantityList probes_list = {
  "-probes",     "places that histories and responses record, each the prefix of its -at and -part",
  sizeof(Probe), &probes,
  ProbeCheck,    .in = 0};
const QuantityList circles_list = {
  "-circles",
  "circles of nodes that histories and responses record, each the prefix of its -radius and "
  "-count",
  sizeof(Circle),
  &circles,
  CircleCheck,
  .in = 0};

const Quantity *ModelFindRow(const char list[], const char name[])
{
  static const QuantityList *const lists[] = {&parts_list,  &springs_list, &dashpots_list,
                                              &joints_list, &points_list,  &loads_list};

  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(lists); i++)
    if (!strcmp(lists[i]->option, list)) return QuantityFind(lists[i]->table, name);
  return NULL;
}
