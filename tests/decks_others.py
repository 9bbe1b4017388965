"""Small decks of Nastran, Ansys and CalculiX's neighbours for test_import_keywords.py, with the scenes that they mean."""


def fixed(*fields):
    """A card of small fields."""
    return "".join(str(field).ljust(8) for field in fields).rstrip()


def wide(*fields):
    """Two lines of large fields."""
    words = [str(field).ljust(16) for field in fields[1:]] + [" " * 16] * (9 - len(fields))
    return f"{fields[0]:8}{''.join(words[:4])}\n{'*':8}{''.join(words[4:8])}".rstrip()


CORNERS = ((0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0), (0, 0, 10), (10, 0, 10), (10, 10, 10), (0, 10, 10))


class Nastran:
    """Two cubes in contact, the upper one given in a coordinate system that is turned by 90 degrees about z and moved."""
    # System 2 has its origin at (10, 0, 10), z along z, x along y: the place (a, b, c) is (10 - b, a, 10 + c)
    FILES = {"pair.bdf": "\n".join([
        "SOL 103", "CEND", "SPC = 1", "LOAD = 1", "BEGIN BULK",
        *(fixed("GRID", k, "", *(f"{v}." for v in place)) for k, place in enumerate(CORNERS, 1)),
        fixed("CORD2R", 2, 0, "10.", "0.", "10.", "10.", "0.", "20.") + "\n" + fixed("+", "10.", "1.", "10."),
        *(wide("GRID*", 10 + k, 2, *(f"{v}.0" for v in place)) for k, place in enumerate(CORNERS, 1)),
        "GRID,30,,5.,5.,40.",
        fixed("CHEXA", 1, 1, 1, 2, 3, 4, 5, 6) + "\n" + fixed("+", 7, 8),
        "CHEXA,2,2,11,12,13,14,15,16", ",17,18",
        "PSOLID,1,1", fixed("PSOLID", 2, 2, 2), "PSOLID,9,1",
        fixed("MAT1", 1, "2.1+5", "", ".3", "7.8-9", "1.-5", "", "0.01"),
        # 9 constants of MAT9: normal part as of the deck for Abaqus, shear xy 25, yz 21, zx 22, GPa
        "MAT9,2,100.E3,20.E3,30.E3,0.,0.,0.,90.E3", ",10.E3,0.,0.,0.,80.E3,0.,0.,0.", ",25.E3,0.,0.,21.E3,0.,22.E3,7.1-9",
        fixed("SPC1", 1, 123, 1, "THRU", 4), fixed("SPC", 1, 15, 1, "0.", 16, 1, "0.1"),
        fixed("CELAS2", 50, "30.", 17, 2), fixed("CELAS1", 51, 7, 17, 3), fixed("PELAS", 7, "40."), fixed("CELAS2", 52, "5.", 17, 1, 18, 1),
        "CBUSH,53,8,18,,,,,0", "PBUSH,8,K,1.,2.,3.",
        fixed("FORCE", 1, 16, 0, "2.", "0.", "0.", "-1.5"),
        "PLOAD4,1,2,3.,,,,15,17", "PLOAD4,1,2,3.,4.,,,15,17",
        "GRAV,1,,9810.,0.,0.,-1.",
        "BSURFS,1,,,,1,5,6,7", "BSURFS,2,,,,2,11,12,13",
        "BCTABLE,3,,,1,,,,", ",2,1,,0.35,,,,",
        "EIGRL,1,10.,5000.", "TEMPD,1,20.", "ENDDATA"]) + "\n"}
    SCENE = {"model_gravity": "0,0,-9.81", "parts": "part_1,part_2", "part_1_loss_factor": "0.01",
             "part_1_young": "210e9", "part_1_poisson": "0.3",
             "part_1_density": "7800", "part_2_young": f"{609e12 / 7100},{609e12 / 7100},{609e12 / 8600}",
             "part_2_poisson": f"{1300 / 7100},{2500 / 7100},{400 / 7100}", "part_2_shear": "25e9,22e9,21e9",
             "part_2_density": "7100", "part_2_axis_1": "0,1,0", "part_2_axis_2": "-1,0,0",
             "supports": "support,support_3", "support_set": "support", "support_fix": "x",
             "support_3_set": "support_3", "support_3_fix": "xyz", "motions": "support_2_motion",
             "support_2_motion_set": "support_2", "support_2_motion_displacement": "1e-4,0,0", "support_2_motion_directions": "x",
             "springs": "spring,spring_2", "spring_set": "spring", "spring_stiffness": "0,30e3,40e3", "spring_2_set": "spring_2",
             "spring_2_stiffness": "1e3,2e3,3e3", "loads": "force_force,pressed_pressure", "force_force_set": "force",
             "force_force_force": "0,0,-3", "pressed_pressure_set": "pressed", "pressed_pressure_pressure": "3e6",
             "contacts": "contact_3", "contact_3_surfaces": "surface_2,surface_1", "contact_3_law": "constraint",
             "contact_3_mu": "0.35", "modes_band": "10,5000",
             # point 17 has axes 1 along y, 2 along -x: 5 N/mm along y between 17 and 18
             "joints": "celas2", "celas2_a": "node", "celas2_b": "node_2", "celas2_at": "0,0.01,0.02", "celas2_at_b": "0,0,0.02",
             "celas2_stiffness": "5000,0,0"}
    LISTED = ["pair.bdf:33: differs: CHEXA", "pair.bdf:1: SOL", "pair.bdf:2: CEND", "pair.bdf:39: property 9",
              "pair.bdf:54: PLOAD4: a pressure that varies", "pair.bdf:61: TEMPD"]
    FORCES = {"force_force": (0, 0, -3), "pressed_pressure": (0, 0, -300)}


class NastranCase:
    """Case control that chooses, and the ways of writing cards: tabulators, kinds of fields mixed in a card, repeated cards, a file
    whose name goes over two lines, lines that go on apart from their card."""
    # System 7 by the grid points 1, 2, 4: (a, b, c) is (c, a, b). System 8 is a sphere's, whose axis goes through point 7
    FILES = {"case.bdf": "\n".join([
        "$ a comment", "SOL 103", "CEND", "TITLE = a case", "SPC = 4", "SUBCASE 1", "  LOAD = 9", "SUBCASE 2", "  METHOD = 3",
        "  STATSUB(PRELOAD) = 1", "  MPC = 5", "BEGIN BULK", "include 'more_", "  grids.inc'",
        "cord1r,7,1,2,4", "CORD2S,8,,10.,10.,0.,10.,10.,5.", ",20.,10.,0.",
        fixed("CHEXA", 1, "", 1, 2, 3, 4, 5, 6).ljust(72) + "+H1", fixed("PSOLID", 1, 1).replace(" ", "\t", 1), fixed("+H1", 7, 8),
        "MAT1*,1,," + repr(210e3 / 2.6) + ",.3", "*,3.-6", "PARAM,WTMASS,2.6-3",
        "SPCADD,4,5,6", fixed("SPC1", 5, 123, 1, "THRU", 3, 4), "SPC,6,101,0", "SPC,6,8,1", "SPC1,7,123,5,6",
        "LOAD,9,2.,3.,10,-1.,11,,,,", ",.5,12", fixed("FORCE", 10, 6, 0, "1.", "0.", "0.", "-1.0"), "FORCE,10,7,8,2.,-1.,0.,0.",
        "FORCE1,10,5,1.,1,2", "GRAV,11,,981.,0.,0.,1.", fixed("PLOAD4", 12, 1, "3.", "", "", "", 5, 7), "PLOAD,12,2.,1,5,8,4",
        "FORCE,13,6,0,1.,1.,1.,1.", "MOMENT,10,6,0,1.,1.,0.,0.", "SPOINT,101,THRU,102", "CPYRAM,9,1,1,2,3,4,5", "CQUAD4,10,2,1,2,3,4",
        "EIGRL,3,,,7", "EIGRL,4,,,9", "ENDDATA", "what stands here is nothing"]) + "\n",
        "more_grids.inc": "GRDSET\t\t7\n" + "\n".join(
            ["GRID\t1\t0\t0.\t0.\t0.", "GRID,2,0,10.,0.,0.", "GRID,3,0,10.,10.,0.", " GRID,4,0,0.,10.,0. $ behind a blank",
             "GRID,5,,0.,10.,0.", "=,*(1),=,=,=,*(10.)", "=,*(1),=,*(10.),==", "GRID*,8,,10.,10.", "*,0.,7", "GRID,2,0,10.,0.,0."]) + "\n"}
    SCENE = {"model_gravity": "0,0,-1.962", "parts": "part_1", "part_1_young": "210e9", "part_1_poisson": "0.3", "part_1_density": "7800",
             "supports": "support,support_2", "support_set": "support", "support_fix": "y",
             "support_2_set": "support_2", "support_2_fix": "xyz",
             "loads": "force_force,force_2_force,force_3_force,pressed_pressure,pressed_2_pressure",
             "force_force_set": "force", "force_force_force": "0,0,-6", "force_2_force_set": "force_2", "force_2_force_force": "0,0,-12",
             "force_3_force_set": "force_3", "force_3_force_force": "6,0,0", "pressed_pressure_set": "pressed",
             "pressed_pressure_pressure": "3e6", "pressed_2_pressure_set": "pressed_2", "pressed_2_pressure_pressure": "-2e6",
             "modes_target": "1", "modes_count": "7"}
    LISTED = ["case.bdf:8: differs: SUBCASE 2 of 2", "case.bdf:18: differs: CHEXA", "case.bdf:23: differs: PARAM WTMASS",
              "case.bdf:2: SOL", "case.bdf:3: CEND", "case.bdf:4: TITLE: output", "case.bdf:11: MPC = 5", "case.bdf:28: SPC1 of set 7",
              "case.bdf:37: FORCE of set 13", "case.bdf:38: a moment on a node", "case.bdf:40: 1 CPYRAM",
              "case.bdf:41: 1 CQUAD4 without a PSHELL",
              "case.bdf:43: EIGRL 4"]


class Ansys:
    """Two cubes, one of a component with a name, in contact by elements on their faces."""
    UNITS = None
    FILES = {"pair.cdb": "\n".join([
        "/PREP7", "ET,1,185", "ET,2,174", "ET,3,170", "ET,4,21", "NBLOCK,6,SOLID,18,17", "(3i9,6e21.13e3)",
        *(f"{k:9d}{0:9d}{0:9d}" + "".join(f"{v:21.13E}" for v in place) for k, place in enumerate(CORNERS, 1)),
        *(f"{10 + k:9d}{0:9d}{0:9d}" + "".join(f"{v:21.13E}" for v in (x, y, z + 10)) + ("" if k < 8 else f"{45.:21.13E}")
          for k, (x, y, z) in enumerate(CORNERS, 1)), f"{30:9d}{0:9d}{0:9d}", "N,R5.3,LOC,       -1,",
        "EBLOCK,19,SOLID,5,5", "(19i8)",
        *("".join(f"{v:8d}" for v in row) for row in (
            (1, 1, 1, 1, 0, 0, 0, 0, 8, 0, 1, 1, 2, 3, 4, 5, 6, 7, 8), (2, 1, 1, 1, 12, 0, 0, 0, 8, 0, 2, *range(11, 19)),
            (3, 2, 5, 1, 0, 0, 0, 0, 4, 0, 3, 11, 12, 13, 14), (3, 3, 5, 1, 0, 0, 0, 0, 4, 0, 4, 5, 6, 7, 8),
            (1, 4, 6, 1, 0, 0, 0, 0, 1, 0, 5, 30))), "      -1",
        "CMBLOCK,LOWER,ELEM,1  ! a comment", "(8i10)", f"{1:10d}", "CMBLOCK,FOOT,NODE,2", "(8i10)", f"{1:10d}{-4:10d}",
        "CMBLOCK,TOP,NODE,4", "(8i10)", "".join(f"{v:10d}" for v in (15, 16, 17, 18)),
        "MPDATA,R5.0, 1,EX  ,       1, 1,  2.1e5", "MPDATA,R5.0, 1,PRXY,       1, 1, 0.3", "MPDATA,R5.0, 1,DENS,       1, 1, 7.8e-9",
        "MP,EX,2,8000", "MP,EY,2,7000", "MP,EZ,2,3000", "MP,PRXY,2,0.25", "MP,NUXZ,2,0.1", "MP,PRYZ,2,0.17", "MP,GXY,2,3000",
        "MP,GYZ,2,1200", "MP,GXZ,2,1500", "MP,DENS,2,2.5e-9", "MP,ALPD,2,10", "MP,BETD,2,1e-7", "MP,MU,3,0.45", "MP,KXX,1,50",
        "LOCAL,12,1,1.0,2.0,3.0,0,90,0",
        "D,FOOT,ALL,0", "D,15,UX,0.0,0.0", "D,16,UX,0.5", "D,18,UY,0", "F,16,FZ,-4.0", "F,17,FZ,-4.0", "F,17,MX,1",
        "SFE,2,6,PRES,0,R5.0", "  2.0  2.0  2.0  2.0", "SF,TOP,PRES,1.5", "ACEL,0,0,9810", "CMROTATE,LOWER,0,0,3,1,2,0",
        "MODOPT,LANB,12", "BFE,1,TEMP,1,20",
        "FINISH"]) + "\n"}
    # The axis of the cylinder: z turned by 90 degrees about x is -y
    SCENE = {"model_gravity": "0,0,-9.81", "parts": "lower,part_2_12", "lower_young": "210e9", "lower_poisson": "0.3",
             "lower_density": "7800", "part_2_12_young": "8e9,7e9,3e9", "part_2_12_poisson": f"0.25,{0.1 * 8 / 3},0.17",
             "part_2_12_shear": "3e9,1.5e9,1.2e9", "part_2_12_density": "2500", "part_2_12_alpha": "10", "part_2_12_beta": "1e-7",
             "part_2_12_cylinder_axis": "0,-1,0", "part_2_12_cylinder_centre": "1e-3,2e-3,3e-3",
             "supports": "foot,support", "foot_set": "foot", "foot_fix": "xyz", "support_set": "support", "support_fix": "x",
             "motions": "support_2_motion", "support_2_motion_set": "support_2", "support_2_motion_displacement": "5e-4,0,0",
             "support_2_motion_directions": "x", "loads": "force_force,top_face_pressure,pressed_pressure", "force_force_set": "force",
             "force_force_force": "0,0,-8", "pressed_pressure_set": "pressed", "pressed_pressure_pressure": "2e6",
             "top_face_pressure_set": "top_face", "top_face_pressure_pressure": "1.5e6",
             "contacts": "pair_5", "pair_5_surfaces": "contact_5,target_5", "pair_5_law": "constraint", "pair_5_mu": "0.45",
             "pair_5_rotation": "0,0,3", "pair_5_centre": "1e-3,2e-3,0",
             "modes_target": "1", "modes_count": "12"}
    LISTED = ["pair.cdb:28: differs: SOLID185", "pair.cdb:32: MASS21 element", "pair.cdb:59: MP KXX",
              "pair.cdb:67: a moment on a node", "pair.cdb:74: BFE"]
    EQUATIONS = 1  # node 18 along its own y
    WORDS = ["-pair_5_mu", 0]  # the forces are looked at without friction, which nothing would resist
    FORCES = {"force_force": (0, 0, -8), "pressed_pressure": (0, 0, -200), "top_face_pressure": (0, 0, -150)}


class AnsysCase:
    """What current versions write, and inputs of Workbench: UNBL, ETBLOCK, types by name, blocks without SOLID, a component twice,
    selections, ranges, blocks of supports and forces, nodes with their own axes, a pyramid, a part without a material."""
    UNITS = "mm-t-s"
    FILES = {"case.cdb": "\n".join([
        "/COM,ANSYS RELEASE 2025 R1", "/PREP7", "/NOLIST", "*SET,TID,3", "cid=4", "ETBLOCK,        2,        2", "(2i9,19a9)",
        f"{1:9d}{185:9d}" + f"{0:9d}" * 19, f"{2:9d}{170:9d}" + f"{0:9d}" * 19, "       -1", "et,tid,SOLID185", "ET,CID,CONTA174",
        "NBLOCK,6,SOLID,        18,         9", "(1i7,2i9,6e21.13e3)",
        *(f"{k:7d}{0:9d}{0:9d}" + "".join(f"{v:21.13E}" for v in place) + (f"{90.:21.13E}" if k == 8 else "")
          for k, place in enumerate(CORNERS, 1)),
        f"{9:7d}{0:9d}{0:9d}" + "".join(f"{v:21.13E}" for v in (5, 5, -5)), "N,UNBL,LOC,       -1,", "nblock,3,,18", "(1i9,3e20.9e3)",
        *(f"{10 + k:9d}" + "".join(f"{v:20.9E}" for v in (x, y, z + 20)) for k, (x, y, z) in enumerate(CORNERS, 1)), "-1",
        "EBLOCK,19,SOLID,         2,         2", "(19i10)",
        *("".join(f"{v:10d}" for v in row) for row in (
            (1, 1, 1, 1, 0, 0, 0, 0, 8, 0, 1, 1, 2, 3, 4, 5, 6, 7, 8), (1, 1, 1, 1, 0, 0, 0, 0, 8, 0, 2, 1, 2, 3, 4, 9, 9, 9, 9))),
        "        -1", "eblock,10,,,1", "(15i9)", "".join(f"{v:9d}" for v in (3, 3, 3, 3, 0, *range(11, 19))), "-1",
        "CMBLOCK,FOOT    ,NODE,       2  ! twice", "(8i10)", f"{5:10d}{-8:10d}", "CMBLOCK,FOOT    ,NODE,       3,,,,,KOPT", "(8i10)",
        f"{1:10d}{-3:10d}{77:10d}", "CMBLOCK,UPPER,NODE,2", "(8i10)", f"{15:10d}{-18:10d}",
        "MPTEMP,UNBL, 1, 1,  0.00000000    ,", "MPDATA,UNBL, 1,EX  ,       1, 1,  210000.000    ,",
        "MPDATA,UNBL, 1,NUXY,       1, 1, 0.3    ,",
        "MPDATA,UNBL, 1,DENS,       1, 1, 7.8E-9    ,", "TYPE, 1  $ MAT, 1  $ REAL, 1",
        "LOCAL,UNBL,LOC,       12,1,  1.0,  2.0,  0.0", "SECBLOCK,1", "  1.0, 2.0", "KEYO,1,2,3",
        "D,11,UX,0,,13,2,UZ", "D,8,UX,0", "D,8,UZ,0.25", "D,FOOT,ALL,0,0", "D,12,UY,%table%",
        "DBLOCK,1", "(i9,a6,2(pg16.9))", f"{14:9d}{'UY':>6}{0.:16.9G}{0.:16.9G}", "       -1", "F,11,FX,1.5,0,14", "F,8,FX,2",
        "CMSEL,S,UPPER", "SF,ALL,PRES,2.5", "NSEL,S,LOC,Z,0", "D,ALL,ALL,0", "ALLSEL,ALL", "OMEGA,0,0,0", "CE,3", "/GO", "FINISH"]) + "\n"}
    # Node 8 is turned by 90 degrees about z: its x is y, its y is -x; UX and UZ hold y and move z
    SCENE = {"parts": "part_1,part_3", "part_1_young": "210e9", "part_1_poisson": "0.3", "part_1_density": "7800",
             "supports": "foot,support,support_2,support_3", "support_set": "support", "support_fix": "xz", "foot_set": "foot",
             "foot_fix": "xyz", "support_2_set": "support_2", "support_2_fix": "y", "support_3_set": "support_3", "support_3_fix": "y",
             "motions": "support_3_motion", "support_3_motion_set": "support_3", "support_3_motion_displacement": "0,0,2.5e-4",
             "support_3_motion_directions": "z", "loads": "force_force,force_2_force,pressed_pressure", "force_force_set": "force",
             "force_force_force": "6,0,0", "force_2_force_set": "force_2", "force_2_force_force": "0,2,0",
             "pressed_pressure_set": "pressed", "pressed_pressure_pressure": "2.5e6", "modes_target": "1", "modes_count": "20"}
    LISTED = ["case.cdb:38: differs: SOLID185", "case.cdb:39: 1 pyramids of SOLID185", "case.cdb:48: CMBLOCK FOOT: 1 of its numbers",
              "case.cdb:43: there is no material 3", "case.cdb:60: SECBLOCK", "case.cdb:62: KEYOPT", "case.cdb:67: D UY: '%table%'",
              "case.cdb:77: D,ALL: of nodes that NSEL", "case.cdb:80: CE"]


GRIDS = "".join(f"GRID,{k},,{x}.,{y}.,{z}.\n" for k, (x, y, z) in enumerate(CORNERS, 1))
HEXA = "CHEXA,1,1,1,2,3,4,5,6\n,7,8\n"
PROPERTY = "PSOLID,1,1\nMAT1,1,2.1E5,,0.3,7.8E-9\n"
NBLOCK = "ET,1,185\nNBLOCK,6,SOLID,8,8\n(3i9,6e21.13e3)\n" + "".join(
    f"{k:9d}{0:9d}{0:9d}" + "".join(f"{v:21.13E}" for v in place) + "\n" for k, place in enumerate(CORNERS, 1)) + "N,R5.3,LOC,-1,\n"
EBLOCK = "EBLOCK,19,SOLID,1,1\n(19i8)\n" + "".join(f"{v:8d}" for v in (1, 1, 1, 1, 0, 0, 0, 0, 8, 0, 1, 1, 2, 3, 4, 5, 6, 7, 8)) + "\n -1\n"
REFUSED = {"bdf": [
    (GRIDS.replace("GRID,3,", "GRID,2,") + HEXA + PROPERTY, "wrong.bdf:3: grid point 2 stands twice"),
    (GRIDS + HEXA.replace(",8\n", ",9\n") + PROPERTY, "wrong.bdf:9: grid point 9 is not in the file"),
    (GRIDS + HEXA.replace(",7,8\n", ",7\n") + PROPERTY, "wrong.bdf:9: CHEXA: field 11 is blank"),
    (GRIDS + HEXA.replace(",8\n", ",8,9\n") + PROPERTY, "wrong.bdf:9: grid point 9 is not in the file"),
    (GRIDS.replace("10.,10.,0.", "10.,1x.,0.") + HEXA + PROPERTY, "wrong.bdf:3: GRID: field 5 '1x.' should be a number"),
    (GRIDS.replace("10.,10.,0.", "10.,nan,0.") + HEXA + PROPERTY, "wrong.bdf:3: GRID: field 5 'nan' should be a number"),
    (GRIDS + HEXA + "PSOLID,1,1\nMAT1           1          80769.2     .3  7.8-9\n",
     "MAT1: field 5 '2     .3' should be a number; blanks in it: is a number across the end of its columns?"),
    (GRIDS + HEXA, "units are in doubt"),
    (GRIDS + HEXA + PROPERTY + "SPC1,1,123,77\n", "wrong.bdf:13: grid point 77 is not in the file"),
    (GRIDS + HEXA + PROPERTY + "SPC1,1,123\n", "wrong.bdf:13: SPC1 names no grid point"),
    (GRIDS + HEXA + PROPERTY + fixed("SPC1", 1, 123, *range(1, 7)).ljust(72) + "+A1\n+B2     7\n",
     "wrong.bdf:14: this line goes on a line 'B2', and there is none"),
    (GRIDS.replace("GRID,8,", "GRID,8,4") + HEXA + PROPERTY, "wrong.bdf:8: GRID: there is no coordinate system 4"),
    (GRIDS + HEXA + PROPERTY.replace("2.1E5,,0.3", ",,0.3"), "wrong.bdf:12: MAT1 needs two of E, G and nu"),
    ("=,1\n" + GRIDS + HEXA + PROPERTY, "wrong.bdf:1: a card that repeats the one before"),
    ("CEND\nSPC = 1\nBEGIN BULK\n" + GRIDS + HEXA + PROPERTY + "SPC1,1,123,77\nENDDATA\n",
     "wrong.bdf:16: grid point 77 is not in the file"),
    ("CHEXA,1,1\n", "there is no GRID"),
], "cdb": [
    (NBLOCK.replace("SOLID,8,8", "SOLID,8,9") + EBLOCK, "wrong.cdb:2: NBLOCK announces 9 nodes and has 8"),
    (NBLOCK + EBLOCK.replace("SOLID,1,1", "SOLID,1,2"), "wrong.cdb:13: EBLOCK announces 2 elements and has 1"),
    (NBLOCK + EBLOCK.replace(" -1\n", ""), "wrong.cdb:13: EBLOCK has no end"),
    (NBLOCK + EBLOCK.replace("       8\n", "       9\n"), "wrong.cdb:15: node 9 is not in the file"),
    (NBLOCK + EBLOCK.replace("       8\n", "\n"), "wrong.cdb:15: element 1 of type 185 needs 8 nodes"),
    (NBLOCK.replace("ET,1,185\n", "") + EBLOCK, "wrong.cdb:14: EBLOCK: there is no ET 1"),
    (NBLOCK.replace("        3        0", "        2        0") + EBLOCK, "wrong.cdb:6: node 2 stands twice"),
    (NBLOCK.replace("1.0000000000000E+01", "1.0000000000x00E+01", 1) + EBLOCK, "wrong.cdb:5: '1.0000000000x00E+01' should be a number"),
    (NBLOCK + EBLOCK, "units are in doubt"),
    (NBLOCK.replace("ET,1,185", "ET,1,0x10") + EBLOCK, "wrong.cdb:1: ET needs a number and a type"),
    (NBLOCK.replace("3i9,6e21.13e3", "3i9,6z21"), "wrong.cdb:3: format (3i9,6z21) is not read"),
    (NBLOCK + EBLOCK + "CMBLOCK,A,NODE,12\n(8i10)\n         1\n", "wrong.cdb:17: CMBLOCK announces 12 items, and the file ends"),
    ("ET,1,185\n", "there is no NBLOCK"),
    (NBLOCK + EBLOCK + "ETBLOCK,1,1\n(2i9)\n        2      185\n        3      185\n -1\n",
     "wrong.cdb:17: ETBLOCK announces 1 types and has 2"),
]}
