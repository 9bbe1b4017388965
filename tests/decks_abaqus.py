"""Decks of Abaqus and CalculiX for test_import_keywords.py, in mm, t, s, with the scenes that they mean."""

CUBE = """*NODE
1, 0., 0., 0.
2, 10., 0., 0.
3, 10., 10., 0.
4, 0., 10., 0.
5, 0., 0., 10.
6, 10., 0., 10.
7, 10., 10., 10.
8, 0., 10., 10.
"""


class Assembly:
    """Parts and instances: a pad that slides on a disc, a plate tied to the pad, material from another file."""
    # The plate: 10 x 10 x 10 from the origin, moved by (0, 0, 10), then turned by 90 degrees about the line through
    # (5, 5, 0) along z: (0, 0, z) goes to (10, 0, z + 10)
    PLACE = (10, 0, 20)
    FILES = {"brake.inp": f"""*HEADING
 a brake of three cubes
** a comment
*PART, NAME=Disc
{CUBE}*ELEMENT, TYPE=C3D8, ELSET=All
1, 1, 2, 3, 4, 5, 6, 7, 8
*NSET, NSET=Hub, GENERATE
1, 4, 1
*NSET, NSET=Every, ELSET=All
*ELSET, ELSET=top_
1
*SURFACE, NAME=Face, TYPE=ELEMENT
top_, S2
*SOLID SECTION, ELSET=All, MATERIAL=Iron
*END PART
*PART, NAME=Pad
{CUBE}*ELEMENT, TYPE=C3D8R, ELSET=All
1, 1, 2, 3, 4, 5, 6, 7, 8
*ORIENTATION, NAME=Turned, SYSTEM=CYLINDRICAL
1., 0., 0., 1., 0., 1.
*SOLID SECTION, ELSET=All, MATERIAL=Lining, ORIENTATION=Turned
*NSET, NSET=Rear
5, 6, 7,
8
*END PART
*ASSEMBLY, NAME=A
*INSTANCE, NAME=disc-1, PART=Disc
*END INSTANCE
*INSTANCE, NAME=pad-1, PART=Pad
0., 0., 10.
*END INSTANCE
*INSTANCE, NAME=plate-1, PART=Pad
0., 0., 20.
5., 5., 0., 5., 5., 1., 90.
*END INSTANCE
*ELSET, ELSET=Rub, INSTANCE=pad-1
1,
*SURFACE, NAME=Rubs
Rub, S1
*SURFACE, NAME=Back
pad-1.All, S2
*SURFACE, NAME=Front
plate-1.All, S1
*NSET, NSET=Corner, INSTANCE=plate-1
7
*SURFACE, NAME=Piston
plate-1.All, S2
*TIE, NAME=glue
Front, Back
*END ASSEMBLY
*INCLUDE, INPUT=material.inc
*SURFACE INTERACTION, NAME=Rubbing
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
2.e5
*FRICTION
0.4
*BOUNDARY
disc-1.Hub, ENCASTRE
pad-1.Rear, 1, 2
*CONTACT PAIR, INTERACTION=Rubbing, TYPE=SURFACE TO SURFACE
Rubs, disc-1.Face
*STEP, NAME=Press
*STATIC
*DSLOAD
Piston, P, 2.
*CLOAD
Corner, 3, -5.
Corner, 1, 1.5
*DLOAD
, GRAV, 9810., 0., 0., -1.
*MOTION, ROTATION, TYPE=VELOCITY
disc-1.Every, 12., 1., 2., 0., 1., 2., -5.
*OUTPUT, FIELD
*END STEP
""", "material.inc": """*MATERIAL, NAME=Iron
*DENSITY
7.1e-9,
*ELASTIC
110000., 0.26
*DAMPING, ALPHA=10., BETA=1.e-7
*MATERIAL, NAME=Lining
*DENSITY
2.5e-9,
*ELASTIC, TYPE=ENGINEERING CONSTANTS
8000., 7000., 3000., 0.25, 0.31, 0.17, 3000., 1500.,
1200.
*EXPANSION
1.e-5,
"""}
    SCENE = {"model_gravity": "0,0,-9.81", "parts": "disc_1,pad_1,plate_1",
             "disc_1_young": "110e9", "disc_1_poisson": "0.26", "disc_1_density": "7100",
             "disc_1_alpha": "10", "disc_1_beta": "1e-7",
             **{f"{part}_1_{key}": value for part in ("pad", "plate") for key, value in {
                 "young": "8e9,7e9,3e9", "poisson": "0.25,0.31,0.17", "shear": "3e9,1.5e9,1.2e9", "density": "2500",
                 "cylinder_axis": "0,0,1"}.items()},
             # the axis of the pad through (1, 0, 10), of the plate (1, 0, 20) turned to (10, 1, 20)
             "pad_1_cylinder_centre": "0.001,0,0.01", "plate_1_cylinder_centre": "0.01,0.001,0.02",
             "supports": "disc_1_hub,pad_1_rear", "disc_1_hub_set": "disc_1_hub", "disc_1_hub_fix": "xyz",
             "pad_1_rear_set": "pad_1_rear", "pad_1_rear_fix": "xy",
             "loads": "corner_force,piston_pressure", "corner_force_set": "corner", "corner_force_force": "1.5,0,-5",
             "piston_pressure_set": "piston", "piston_pressure_pressure": "2e6",
             "contacts": "rubbing", "rubbing_surfaces": "rubs,disc_1_face", "rubbing_kn_per_area": "2e14", "rubbing_mu": "0.4",
             "rubbing_rotation": "0,0,-12", "rubbing_centre": "1e-3,2e-3,0",
             "modes_target": "1", "modes_count": "20"}
    FORCES = {"corner_force": (1.5, 0, -5), "piston_pressure": (0, 0, -200)}
    LISTED = ["brake.inp:67: differs: *TIE glue: 4 nodes", "brake.inp:14: differs: C3D8 ", "brake.inp:35: differs: C3D8R ",
              "brake.inp:91: *OUTPUT", "brake.inp:81: *STATIC",
              "material.inc:13: *EXPANSION"]


class Flat:
    """One deck without parts, as CalculiX has them: springs, turned axes, moved nodes, modes, and what is not understood."""
    FILES = {"flat.inp": f"""{CUBE}9, 10., 10., 60.
10, 0., 0., 60.
*NODE, SYSTEM=C, NSET=AROUND
11, 10., 90., -20.
12, 0., 0., -20.
*ELEMENT, TYPE=C3D8I, ELSET=BODY
1, 1, 2, 3, 4, 5, 6, 7, 8
*ELEMENT, TYPE=C3D4, ELSET=TIP
2, 1, 2, 4, 12
*ELEMENT, TYPE=SPRING1, ELSET=GROUND
20, 7
21, 8
*ELEMENT, TYPE=SPRINGA, ELSET=ROD
30, 7, 9
31, 5, 6
*ELEMENT, TYPE=MASS, ELSET=WEIGHT
40, 5
*ELSET, ELSET=EVERYTHING
BODY, TIP
*NSET, NSET=FOOT
12,
*NSET, NSET=BACK, ELSET=TIP
*SPRING, ELSET=GROUND
2
50.
*SPRING, ELSET=ROD

70.
*MATERIAL, NAME=A
*ELASTIC, TYPE=ORTHO
100., 20., 90., 30., 10., 80., 25.,
22., 21.
*DENSITY
7.8e-6
*MATERIAL, NAME=B
*ELASTIC
210., 0.3
*DENSITY
7.8e-6
*ORIENTATION, NAME=AXES
0., 2., 0., -1., 0., 0.
3, 90.
*SOLID SECTION, ELSET=BODY, MATERIAL=A, ORIENTATION=AXES
*SOLID SECTION, ELSET=TIP, MATERIAL=B
*BOUNDARY
FOOT, 1, 3
9, 3, 3
1, 1, 1
2, 1
5, 3, 3, 0.001
*CLOAD
7, 2, 3.
8, 2, 3.
*DLOAD
BODY, P2, 0.004
*STEP, PERTURBATION
*FREQUENCY
7, 0., 2.
*NODE FILE
U
*END STEP
"""}
    UNITS = "mm-kg-ms"
    # Orthotropic stiffness in GPa: constants from the inverse of [[100, 20, 30], [20, 90, 10], [30, 10, 80]], whose
    # determinant is 609000 and whose cofactors are 7100, 7100, 8600, -1300, -2500, -400 (11, 22, 33, 12, 13, 23)
    SCENE = {"parts": "body,tip", "body_young": f"{609e12 / 7100},{609e12 / 7100},{609e12 / 8600}",
             "body_poisson": f"{1300 / 7100},{2500 / 7100},{400 / 7100}", "body_shear": "25e9,22e9,21e9", "body_density": "7800",
             # axes of the points: 1 along y, 2 along -x; turned by 90 degrees about 3: 1 along -x, 2 along -y
             "body_axis_1": "-1,0,0", "body_axis_2": "0,-1,0",
             "tip_young": "210e9", "tip_poisson": "0.3", "tip_density": "7800",
             "supports": "foot,support", "foot_set": "foot", "foot_fix": "xyz", "support_set": "support", "support_fix": "x",
             "motions": "support_2_motion", "support_2_motion_set": "support_2", "support_2_motion_displacement": "0,0,1e-6",
             "support_2_motion_directions": "z",
             # kg/ms^2 is 1e6 N/m: the rod along z at node 7, held at its other end
             "springs": "spring,spring_2", "spring_set": "spring", "spring_stiffness": "0,50e6,70e6",
             "spring_2_set": "spring_2", "spring_2_stiffness": "0,50e6,0",
             "joints": "springa", "springa_a": "node", "springa_b": "node_2", "springa_at": "0,0,0.01", "springa_at_b": "0.01,0,0.01",
             "springa_stiffness": "70e6,0,0",
             # 1e3 N is one kN, the unit of force: 3 at both nodes
             "loads": "force_force,pressed_pressure", "force_force_set": "force", "force_force_force": "0,6000,0",
             "pressed_pressure_set": "pressed", "pressed_pressure_pressure": "4e6",
             "modes_band": "0,2000"}
    LISTED = ["flat.inp:17: differs: 1 of 1 elements C3D4 have the other", "flat.inp:17: differs: C3D4",
              "flat.inp:68: *NODE FILE", "flat.inp:26: *ELEMENT, TYPE=MASS: element 40 has no *MASS",
              "flat.inp:56: support of nodes that no volume element has", "flat.inp:27: set of elements EVERYTHING"]


BODY = f"{CUBE}*ELEMENT, TYPE=C3D8I, ELSET=E\n1, 1,2,3,4,5,6,7,8\n"
STEEL = "*MATERIAL, NAME=M\n*ELASTIC\n210000., 0.3\n*DENSITY\n7.8e-9\n"
REFUSED = [
    (BODY.replace("4, 0., 10., 0.\n", "4, 0., ten, 0.\n"), "wrong.inp:5: 'ten' should be a number"),
    (BODY.replace("4, 0., 10., 0.\n", "4, 0., nan, 0.\n"), "wrong.inp:5: 'nan' should be a number"),
    (BODY.replace("4, 0., 10., 0.\n", "4.5, 0., 1, 0.\n"), "wrong.inp:5: a line of *NODE begins with a whole number"),
    (BODY.replace("4, 0., 10., 0.\n", "3, 0., 10., 0.\n"), "wrong.inp:5: node 3 stands twice"),
    (BODY.replace("6,7,8", "6,7,9"), "wrong.inp:11: node 9 is not in the file"),
    (BODY.replace("6,7,8", "6,7"), "wrong.inp:11: 8 numbers, expected 9"),
    (BODY.replace("6,7,8", "6,7,7"), "wrong.inp:10: element 1 of type C3D8I has a node twice"),
    (BODY + "1, 1,2,3,4,5,6,7,8\n", "wrong.inp:12: element 1 stands twice"),
    (BODY + "*BOUNDARY\nN, 1, 3\n", "wrong.inp:13: 'N' is neither a set of nodes"),
    (BODY + "*CLOAD, OP=NEEW\n1, 1, 1.\n", "wrong.inp:12: *CLOAD, OP=NEEW: it is one of NEW, MOD"),
    (BODY + "*STEP, NLGEOM=YE5\n*END STEP\n", "wrong.inp:12: *STEP, NLGEOM=YE5: it is one of YES, NO"),
    (BODY + "*NSET, NSET=N, GENERATE\n1, 0, 1\n", "wrong.inp:13: GENERATE: from 1 to 0 by 1 is no range"),
    (BODY + "*SURFACE, NAME=S\nE, S7\n", "wrong.inp:13: elements of type C3D8I have no face 7"),
    (BODY + STEEL + "*SOLID SECTION, ELSET=E, MATERIAL=N\n", "wrong.inp:17: there is no *MATERIAL N"),
    (BODY + STEEL + "*SOLID SECTION, ELSET=F, MATERIAL=M\n", "wrong.inp:17: 'F' is neither a set of elements"),
    (BODY + "*ELEMENT, TYPE=C3D8I, ELSET=F\n2, 1,2,3,4,5,6,7,8\n" + STEEL + "*SOLID SECTION, ELSET=E, MATERIAL=M\n",
     "wrong.inp:12: element 2 (1 in all) has no section"),
    (BODY + STEEL.replace("210000.", "-1."), "wrong.inp:14: Young's modulus -1 must be positive"),
    (BODY + STEEL + "*STEP\n*STATIC\n", "wrong.inp:17: *STEP has no *END STEP: is the file cut off?"),
    (BODY + "*INCLUDE, INPUT=gone.inp\n", "wrong.inp:12: *INCLUDE: "),
    (BODY + STEEL.replace("*DENSITY\n7.8e-9\n", "") + "*SOLID SECTION, ELSET=E, MATERIAL=M\n", "units are in doubt"),
    (BODY + "*NGEN\n1, 3, 1\n", "wrong.inp:12: *NGEN is not read"),
    (BODY + "*SURFACE INTERACTION, NAME=I\n*FRICTION, ROUGH\n", "wrong.inp:13: *FRICTION, ROUGH: squeal has no contact"),
    (BODY + "*MATERIAL, NAME=M\n*DENSITY\n", "wrong.inp:13: *DENSITY needs 1 number at least"),
    ("1, 2, 3\n", "there is no *NODE"),
    (BODY + "*ELEMENT, TYPE=C3D5\n2, 1,2,3,4,5\n", "wrong.inp:12: *ELEMENT, TYPE=C3D5: squeal has no such solid"),
    ("", "there is no *NODE"),
]
