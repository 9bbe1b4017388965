"""What is damaged: tiny scenes, their files, and the command that reads them; each with what an undamaged run answers."""

import importlib.util
import shutil
import subprocess
import sys
from pathlib import Path

import damage

TESTS = Path(__file__).resolve().parents[1]
sys.path += [str(TESTS), str(TESTS.parent / "scripts")]
import mesh as meshes  # noqa: E402
import served  # noqa: E402
from squeal.mesh.gmsh import read_mesh # noqa: E402

BODIES = """
parts: base,block
base: {young: 2e9, poisson: 0.3, density: 2000}
block: {young: 1e9, poisson: 0.2, density: 1000}
supports: ground
ground: {set: base_bottom, fix: xyz}
"""
BRAKE = BODIES + """
springs: hold
hold: {set: block_top, stiffness: "1e3,1e3,1e3"}
loads: press
press: {set: block_top, force: "0,0,-100"}
contacts: contact
contact: {surfaces: "block_bottom,base_top", mu: 0.3, law: constraint, slip: "1,0,0", speed: 0.1}
modes: {band: "0,3000", growth: 1000, contact: all}
sweep: {parameter: contact_mu, values: "0:0.6:4"}
"""
MAP = BRAKE.replace("density: 2000}", "density: 2000, alpha: 300, beta: 1e-6}").replace(
    "density: 1000}", "density: 1000, alpha: 300, beta: 1e-6}") + """
model: {mesh: blocks.msh}
analysis: map
dynamics: {model: reduced, cutoff: 3000}
map: {parameter: contact_mu, values: "0.1,0.2", window: 2e-3}
ts: {max_time: 16e-3}
impulses: tap
tap: {at: "0.05,0.05,0.1", part: block, impulse: "0,0,1e-4"}
"""
# A coarse brake that squeals at mu 0.42, and its limit cycle in few steps
CYCLE = """
analysis: cycle
cycle: {steps: 15, verify: false}
model: {mesh: rig.msh}
parts: disc,pad,beam
disc: {young: 210e9, poisson: 0.3, density: 7800, alpha: 300, beta: 2e-7}
pad: {young: 25.1e9, poisson: 0.3, density: 2500, alpha: 300, beta: 3e-7}
beam: {young: 2100e9, poisson: 0.3, density: 78000, alpha: 300, beta: 2e-7}
supports: hub
hub: {set: disc_inner, fix: xyz}
springs: rows
rows: {set: beam_rows, stiffness: "0,8.422e6,0"}
loads: press
press: {set: beam_top, force: "0,0,-100", ramp: 1e-3}
contacts: contact
contact: {surfaces: "pad_face,disc_face", law: constraint, mu: 0.42, slip: "0,1,0", speed: 2}
dynamics: {model: reduced, cutoff: 12e3, compare: false, live: 0}
ts: {max_time: 30e-3}
"""
# A disc of two directions and a third mass, whose matrices depend on a speed w: powers 2 and -1
AFFINE = """
terms: m,k1,kr,kg,dr,dg
m: {kind: mass, file: M.bin, symmetry: symmetric}
k1: {kind: stiffness, file: K.bin, symmetry: symmetric}
kr: {kind: stiffness, file: KR.bin, parameter: mu}
kg: {kind: stiffness, dense: "0.01,0,0, 0,0.01,0, 0,0,0.02", parameter: speed, power: 2}
dr: {kind: damping, dense: "0.25,0,0, 0,0.25,0, 0,0,0.1", parameter: speed, power: -1, scale: 0.5}
dg: {kind: damping, file: DG.bin, parameter: speed, symmetry: skew}
speed: 2
mu: 0.3
modes: {target: 0, count: 3}
"""
BEAM = """
parts: beam
beam: {young: 210e9, poisson: 0.3, density: 7800}
supports: root
root: {set: root}
modes: {target: 0, count: 3}
model: {mesh: beam.msh}
"""
OPTIONS = ("-operators_dense_k", "2,1,0,1,3,1,0,1,4", "-operators_dense_m", "1,0,0,0,1,0,0,0,2", "-operators_dense_h",
           "0,1,0,-1,0,0,0,0,0", "-contact_mu", "0.25", "-modes_target", "0", "-modes_count", "3", "-eps_tol", "1e-11",
           "-modes_growth", "5")


class Base:
    """A kind of input: files that are damaged, the command, and which tables tell the answer."""

    def __init__(self, name, damages, files, words, table="modes.csv"):
        self.name, self.damages, self.files, self.words, self.table = name, damages, files, words, table
        self.sealed = False  # the file has a checksum: a changed one may not succeed with another answer
        self.rtol = 1e-9 if table in ("modes.csv", "sweep.csv", "transient.csv") else 1e-5  # on two ranks; cycles and maps repeat less
        self.complete = ()    # tables that are whole also where the run then fails
        self.folder = None   # where files of an earlier run lie, which are copied for each run


def run(program, folder, *words):
    """An undamaged run that makes files; its exit status is the caller's to judge."""
    return subprocess.run([program, *words], cwd=folder, capture_output=True, text=True, timeout=120, check=False)


def mesh(folder, name, *words):
    subprocess.run([sys.executable, TESTS / "mesh.py", *words, folder / name], check=True, capture_output=True)


def matrices(folder):
    """Two sparse matrices of three rows."""
    spec = importlib.util.spec_from_file_location("oracle", Path(__file__).with_name("oracle.py"))
    oracle = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(oracle)
    oracle.write(folder / "K.bin", [[2, 1, 0], [1, 3, 1], [0, 1, 4]])
    oracle.write(folder / "M.bin", [[1, 0.25, 0], [0.25, 1, 0], [0, 0, 2]])
    oracle.write(folder / "KR.bin", [[0, 1, 0.5], [-1, 0, 0], [0, -0.25, 0]])
    oracle.write(folder / "DG.bin", [[0, 0.1, 0], [-0.1, 0, 0.2], [0, -0.2, 0]])


def rig(program, folder):
    """The mesh of the cycle in a file: of the rig a line that is lost would leave the elements that are its default, many more."""
    (folder / "rig.yaml").write_text(CYCLE.replace("{mesh: rig.msh}", "{source: rig}"))
    made = run(program, folder, "-options_file", "rig.yaml", "-rig_disc_elements", "8,24,1", "-rig_pad_elements", "4,4,2",
               "-rig_beam_elements", "10", "-rig_save", "rig.msh", "-analysis", "modes", "-modes_band", "0,1000", "-output_dir", "rig")
    assert made.returncode == 0, made.stderr


def second_order(folder, kind, version, binary):
    """A bar of two elements at least, of a kind that solids.py makes; binary where each group has one type of element."""
    name = f"{kind}{'b' if binary else 'a'}.msh"
    subprocess.run([sys.executable, TESTS / "solids.py", kind, folder / name, "--elements", "2,1,1", "--format",
                    "2.2" if binary else version], check=True, capture_output=True)
    if binary:
        meshes.TYPES |= {10: (11, 3), 27: (12, 3), 6: (9, 2), 9: (10, 2), 2: (1, 1), 3: (2, 2)}
        x, sets = read_mesh(folder / name)
        groups = {name: nodes for (name, _), nodes in sets.items()}
        numbers = list(range(1, 1 + sum(map(len, groups.values()))))
        meshes.write(folder / name, version, True, x, groups, list(range(1, 1 + len(x))), numbers)
    damages = damage.BYTES + damage.TEXT_OF_BINARY if binary else damage.LINES
    words = ("-options_file", "bar.yaml", "-model_mesh", name)
    return Base(f"mesh {kind} {version}{' binary' if binary else ''}", damages, (name,), words)


def transient(program, folder):
    """A run in time to half of its way, with a checkpoint, and a shape to start from."""
    first = ("-options_file", "brake.yaml", "-model_mesh", "blocks.msh", "-analysis", "transient", "-press_ramp", "1e-4",
             "-dynamics_live", "0", "-dynamics_checkpoint_interval", "20")
    done = run(program, folder, *first, "-ts_max_steps", "60", "-output_dir", "half")
    assert done.returncode == 0 and (folder / "half/checkpoint.bin").exists(), done.stderr
    shape = run(program, folder, "-options_file", "brake.yaml", "-model_mesh", "blocks.msh", "-output_dir", "shape")
    assert shape.returncode == 0, shape.stderr
    return first


def reduced(program, folder, first):
    """The checkpoint of a transient on modes."""
    words = (*first, "-dynamics_model", "reduced", "-dynamics_cutoff", "3000", "-dynamics_compare", "false")
    done = run(program, folder, *words, "-ts_max_steps", "40", "-output_dir", "reduced")
    assert done.returncode == 0 and (folder / "reduced/checkpoint.bin").exists(), done.stderr
    base = Base("reduced", damage.BYTES, ("out/checkpoint.bin",), (*words, "-ts_max_steps", "50", "-dynamics_restart"),
                "transient.csv")
    base.folder, base.sealed = folder / "reduced", True
    return base


def sweep(program, folder):
    """A sweep that was killed, and kept its full solutions; the command that goes on with them."""
    words = ("-options_file", "brake.yaml", "-model_mesh", "finer.msh", "-analysis", "sweep", "-modes_band", "0,2000",
             "-sweep_values", "0,0.6", "-sweep_onsets", "0", "-sweep_rtol", "1e-8")
    command = [served.LAUNCHER, "-n", 1, program, *words, "-output_dir", "stopped"]
    if not served.killed_at(command, "stopped/sweep_restart_002", folder):
        raise SystemExit("the sweep was not killed after its second full solution")
    shutil.copytree(folder / "stopped", folder / "gone on")
    done = run(program, folder, *words, "-output_dir", "gone on")
    assert done.returncode == 0 and "anew" not in done.stderr, done.stderr
    return words


def of_map(program, folder):
    """A map by its options, and one that was killed after its second chain, with what it kept."""
    words = ("-options_file", "map.yaml")
    command = [served.LAUNCHER, "-n", 1, program, *words, "-output_dir", "mapped"]
    if not served.killed_at(command, "mapped/map_restart_chain_000001", folder):
        raise SystemExit("the map was not killed in its second chain")
    kept = Base("map kept", damage.BYTES, tuple(f"out/{path.name}" for path in sorted((folder / "mapped").glob("map_restart_*"))),
                words, "map.csv")
    kept.sealed, kept.folder = True, folder / "mapped"
    return [Base("map", (*damage.LINES, damage.lines_shuffled), ("map.yaml",), words, "map.csv"), kept]


def bases(program, folder):
    """All kinds of input, made in the folder."""
    (folder / "brake.yaml").write_text(BRAKE)
    (folder / "beam.yaml").write_text(BEAM)
    (folder / "bar.yaml").write_text(BEAM.replace("beam", "bar").replace("set: root", "set: left"))
    (folder / "map.yaml").write_text(MAP)
    (folder / "cycle.yaml").write_text(CYCLE)
    rig(program, folder)
    (folder / "affine.yaml").write_text(AFFINE)
    mesh(folder, "blocks.msh", "blocks", "--elements", "1,1,1")
    mesh(folder, "finer.msh", "blocks", "--elements", "2,2,2")
    matrices(folder)
    found = [Base("options", damage.LINES, (), OPTIONS),
             Base("yaml", (*damage.LINES, damage.lines_shuffled, damage.lines_shuffled), ("brake.yaml",),
                  ("-options_file", "brake.yaml", "-model_mesh", "blocks.msh")),
             Base("matrix", damage.BYTES, ("K.bin", "M.bin"), ("-operators_load_k", "K.bin", "-operators_load_m", "M.bin",
                                                               "-modes_target", "0", "-modes_count", "3"))]
    for version, binary in (("2.2", ()), ("2.2", ("--binary",)), ("4.1", ()), ("4.1", ("--binary",))):
        name = f"beam{version}{'b' if binary else 'a'}.msh"
        mesh(folder, name, "beam", "--elements", "2,1,1", "--format", version, *binary)
        damages = damage.BYTES + damage.TEXT_OF_BINARY if binary else damage.LINES
        found.append(Base(f"mesh {version} {'binary' if binary else 'ascii'}", damages, (name,),
                          ("-options_file", "beam.yaml", "-model_mesh", name)))
    found += [second_order(folder, *of) for of in (("tet10", "2.2", False), ("hex20", "4.1", False), ("wedge15", "4.1", False),
                                                   ("tet10", "4.1", True), ("hex27", "2.2", True))]
    found += [Base("affine files", damage.BYTES, ("K.bin", "KR.bin", "DG.bin", "M.bin"), ("-options_file", "affine.yaml")),
              Base("affine", (*damage.LINES, damage.lines_shuffled), ("affine.yaml",), ("-options_file", "affine.yaml")),
              *of_map(program, folder),
              Base("cycle", (*damage.LINES, damage.lines_shuffled), ("cycle.yaml",), ("-options_file", "cycle.yaml"), "cycle.csv")]
    found[-1].complete = ("transient.csv",)
    first = transient(program, folder)
    restart = Base("checkpoint", damage.BYTES, ("out/checkpoint.bin",), (*first, "-ts_max_steps", "90", "-dynamics_restart"),
                   "transient.csv")
    history = Base("history", damage.LINES, ("out/transient.csv",), restart.words, "transient.csv")
    restart.folder = history.folder = folder / "half"
    restart.sealed = True
    shape = Base("shape", damage.BYTES, ("shape/modes.h5",), (*first, "-ts_max_steps", "20", "-dynamics_shape", "shape",
                                                              "-dynamics_shape_mode", "1", "-dynamics_shape_amplitude", "1e-6"),
                 "transient.csv")
    found += [restart, history, shape]
    found.append(reduced(program, folder, first))
    words = sweep(program, folder)
    files = tuple(f"out/{path.name}" for path in sorted((folder / "stopped").glob("sweep_restart_*")))
    kept = Base("sweep", damage.BYTES, files, words, "sweep.csv")
    kept.sealed, kept.folder = True, folder / "stopped"
    return [*found, kept]


def lay_out(base, folder, work):
    """A fresh folder with everything that the command of a base reads."""
    work.mkdir()
    for path in folder.iterdir():
        if path.is_file():
            (work / path.name).write_bytes(path.read_bytes())
    if base.name == "shape":
        shutil.copytree(folder / "shape", work / "shape")
    if base.folder:
        shutil.copytree(base.folder, work / "out")
