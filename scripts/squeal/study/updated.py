"""Bodies of eight moduli, and a small brake, whose measurements are made with other parameters, for what scripts/update finds of them."""

import csv

import h5py
import numpy as np

from ..run.program import ROOT
from ..tables import BadInput

N = 8
NOISE = 1e-3
YOUNG = 2e11
NAMES = [f"b{k}_young" for k in range(1, N + 1)]
SWEEP = "0.45:0.8:4"  # values of friction about the lowest lock-in, at 0.62 in the scene
BRAKE = """model: {source: rig}
parts: disc,pad,beam
rig: {disc_elements: "6,24,1", pad_elements: "2,2,2", beam_elements: 3}
beam: {young: 2.1e11, poisson: 0.3, density: 7800}
disc: {young: 2.1e11, poisson: 0.3, density: 7800}
pad: {young: 8e9, poisson: 0.3, density: 2500}
supports: hub
hub: {set: disc_inner, fix: xyz}
springs: rows
rows: {set: beam_rows, stiffness: "0,8e6,0"}
loads: press
press: {set: beam_top, force: "0,0,-100"}
contacts: contact
contact: {surfaces: "pad_face,disc_face", kn: 1e8, mu: 0.9, slip: "0,1,0", speed: 1}
"""
DISC = """model: {source: rig}
parts: disc
rig: {pad: false, disc_elements: "6,24,1", pad_elements: "2,2,2"}
disc: {young: 2.1e11, poisson: 0.3, density: 7800}
"""
ALL = "disc_young,disc_density,pad_young,beam_young,contact_kn"
# the stages of practice: name, scene, options, what is sought; each has what the one before found as prior
STAGES = (("free", "disc.yaml", (), "disc_young,disc_density:0.5"),
          ("assembled", "still.yaml", ("-modes_contact", "all"), f"{ALL}:20"),
          ("pressed", "still.yaml", ("-modes_contact", "static"), ALL),
          ("rubbing", "rubbing.yaml", ("-modes_contact", "static"), f"{ALL},contact_mu:30"))
TEST = {"disc_young": 2.13e11, "disc_density": 7830, "pad_young": 8.5e9, "beam_young": 2.08e11, "contact_kn": 1.15e8, "contact_mu": 0.25}


CORNERS = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))


def row():
    """Cells by their lowest corner, with the number of their block: eight blocks of two in a row along x, each thinner than the one before;
    the face of a cell that is clamped, and the place of a corner."""
    cells = {(i, j, k): i // 2 + 1 for i in range(2 * N) for j in range(2) for k in range(2)}
    return cells, lambda i, j, k: (0, 3, 7, 4) if i == 0 else None, \
        lambda i, j, k: (0.02 * i, (0.03 - 0.001 * i) * (j - 1), (0.018 - 0.0005 * i) * (k - 1) + 2e-4 * i * i)


def samples():
    """Eight samples of friction material on a plate of steel, each 8 % longer than the one before: each has two modes of bending of its
    own. The plate is stiff beside them, so that frequencies tell all of a sample's modulus."""
    cells = {(i, j, 0): N + 1 for i in range(3 * N - 1) for j in range(2)}
    cells |= {(3 * n + i, j, 1 + k): n + 1 for n in range(N) for i in range(2) for j in range(2) for k in range(6)}
    return cells, lambda i, j, k: (0, 1, 2, 3) if k == 0 else None, \
        lambda i, j, k: (0.006 * i, 0.0055 * j, 0.006 * k if k < 2 else 0.006 + (k - 1) * 0.06 / 6 * 1.08**(i // 3))


def write_mesh(path, cells, clamped, place):
    """In Gmsh's format 2.2; returns the places of the corners."""
    grid = sorted({tuple(np.add(cell, corner)) for cell in cells for corner in CORNERS})
    label = {corner: n for n, corner in enumerate(grid, 1)}
    last = max(cells.values())
    solids = [(5, tag, [label[tuple(np.add(cell, corner))] for corner in CORNERS]) for cell, tag in cells.items()]
    roots = [(3, last + 1, [label[tuple(np.add(cell, CORNERS[n]))] for n in clamped(*cell)]) for cell in cells if clamped(*cell)]
    names = [f'3 {k} "b{k}"' for k in range(1, last + 1)] + [f'2 {last + 1} "root"']
    path.write_text("\n".join(
        ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names)), *names, "$EndPhysicalNames", "$Nodes",
         str(len(grid)),
         *(f"{label[one]} {' '.join(repr(float(x)) for x in place(*one))}" for one in grid), "$EndNodes", "$Elements",
         str(len(solids) + len(roots)), *(f"{n} {kind} 2 {tag} {tag} {' '.join(map(str, nodes))}"
                                          for n, (kind, tag, nodes) in enumerate(solids + roots, 1)), "$EndElements", ""]))
    return np.array([place(*one) for one in grid]), last


class Bar:
    """The scene, and what is measured of it. execute(words, folder) runs a command as subprocess.run() does; of the corners every so
    many-th is a sensor; `own` is the modulus of the eight."""

    def __init__(self, folder, program, execute, shape, every, own=YOUNG):  # pylint: disable=too-many-arguments
        self.folder, self.program, self.execute, self.own = folder, program, execute, own
        folder.mkdir()
        corners, last = write_mesh(folder / "bar.msh", *shape())
        self.sensors = corners[::every]
        text = "model: {mesh: bar.msh}\nparts: \"" + ",".join(f"b{k}" for k in range(1, last + 1)) + "\"\nmodes: {band: \"0,30000\"}\n"
        text += "".join(f"b{k}: {{young: {own if k <= N else YOUNG:g}, poisson: 0.3, density: 7800}}\n" for k in range(1, last + 1))
        (folder / "free.yaml").write_text(text)
        (folder / "bar.yaml").write_text(text + "supports: clamp\nclamp: {set: root, fix: xyz}\n")

    def launch(self, scene, out, values, *also):
        """Runs squeal with these values of parameters."""
        words = [word for name, value in values.items() for word in (f"-{name}", f"{value:.17g}")]
        done = self.execute([ROOT / "scripts/mpirun", "-n", 1, self.program, "-options_file", scene, "-output_dir", out, *words, *also],
                            self.folder)
        if done.returncode:
            raise BadInput(f"{scene}: {done.stderr.strip()}")

    def run(self, scene, out, values, *also):
        """Rows of the modes and their shapes with these values of parameters."""
        self.launch(scene, out, values, *also)
        with (self.folder / out / "modes.csv").open(newline="") as lines:
            rows = list(csv.DictReader(lines))
        with h5py.File(self.folder / out / "modes.h5") as file:
            self.places = file["VTKHDF/Points"][:]
            return rows, [file[f"VTKHDF/PointData/mode_{int(row['mode']):03d}_re"][:] for row in rows]

    def measure(self, measured, rng, count=20, noise=NOISE):
        """Tables of sensors along two edges of the bar and of modes: frequencies, damping, shapes with 1 % noise."""
        rows, shapes = measured
        kept = [k for k, row in enumerate(rows) if float(row["freq_hz"]) > 1][:count]
        at = [np.argmin(((self.places - place)**2).sum(1)) for place in self.sensors]
        names = [f"{node}{axis}" for node in range(len(at)) for axis in "xyz"]
        with (self.folder / "sensors.csv").open("w") as out:
            out.write("sensor,x,y,z,direction_x,direction_y,direction_z\n")
            out.writelines(f"{name}," + ",".join(f"{x:.12g}" for x in (*self.places[at[n // 3]], *np.eye(3)[n % 3])) + "\n"
                           for n, name in enumerate(names))
        with (self.folder / "modes.csv").open("w") as out:
            out.write(",".join(["freq_hz", "damping_ratio", *names]) + "\n")
            for k in kept:
                shape = shapes[k][at].ravel()
                shape = shape + 0.01 * abs(shape).max() * rng.normal(size=shape.shape)
                freq, damping = (float(rows[k][name]) for name in ("freq_hz", "damping_ratio"))
                out.write(",".join(f"{x:.12g}" for x in (freq * (1 + noise * rng.normal()), damping * (1 + noise * rng.normal()), *shape))
                          + "\n")
        return "sensors.csv", "modes.csv"

    def update(self, *words, scene="bar.yaml", out="update", fails=False):
        """Rows of update.csv by parameter, and what was printed; the message where it fails."""
        done = self.execute([ROOT / "scripts/update", scene, "--measured", "sensors.csv", "modes.csv", "--program", self.program, "-o",
                             out, *words], self.folder)
        if (done.returncode != 0) != fails or "Traceback" in done.stderr or "not foreseen" in done.stderr:
            raise BadInput(f"update {words}: {done.returncode}\n{done.stdout}{done.stderr}")
        if fails:
            return done.stderr
        with (self.folder / out / "update.csv").open(newline="") as lines:
            return {row["parameter"]: row for row in csv.DictReader(lines)}, done.stdout


class Brake(Bar):
    """A small brake whose moduli are measured at low friction, for its onsets over friction."""

    def __init__(self, folder, program, execute):  # pylint: disable=super-init-not-called
        self.folder, self.program, self.execute = folder, program, execute
        folder.mkdir()
        (folder / "disc.yaml").write_text(DISC + "modes: {band: \"100,9000\"}\n")
        for name, mu in (("still", 0), ("rubbing", 0.3)):
            (folder / f"{name}.yaml").write_text(BRAKE.replace("mu: 0.9", f"mu: {mu}") + "modes: {band: \"500,9000\"}\n")
        (folder / "brake.yaml").write_text(BRAKE + "modes: {band: \"500,9000\"}\n")
        self.run("brake.yaml", "first", {"contact_mu": 0.2})
        _, first, count = np.unique(self.places.round(9), axis=0, return_index=True, return_counts=True)
        self.sensors = self.places[np.random.default_rng(1).choice(first[count == 1], 20, replace=False)]

    def onsets(self, values, sweep):
        """Friction, frequency of each lock-in."""
        self.launch("brake.yaml", "sweep", values, "-analysis", "sweep", "-sweep_parameter", "contact_mu", "-sweep_values", sweep)
        with (self.folder / "sweep/onsets.csv").open(newline="") as lines:
            return [(float(row["critical_value"]), float(row["freq_hz"])) for row in csv.DictReader(lines) if row["kind"] == "lock_in"]

    def trial(self, values, rng, sweep=SWEEP):
        """Measures the brake with these moduli at low friction, updates, and has each stated onset beside the true one: rows of
        update_onsets.csv, with `off`, how far the truth is, in stated deviations."""
        self.measure(self.run("brake.yaml", "truth", {**values, "contact_mu": 0.2}), rng)
        self.update("--parameters", ",".join(values), "--onset", f"contact_mu={sweep}", "-contact_mu", "0.2", scene="brake.yaml")
        truths, found = self.onsets(values, sweep), []
        with (self.folder / "update/update_onsets.csv").open(newline="") as lines:
            for row in csv.DictReader(lines):
                near = [value for value, freq in truths if abs(freq / float(row["freq_hz"]) - 1) < 0.01]
                if row["kind"] == "lock_in" and row["deviation"] and len(near) == 1:
                    found.append({**row, "off": (float(row["critical_value"]) - near[0]) / float(row["deviation"])})
        return found

    def stages(self, rng):
        """Updates the free disc, the brake assembled, pressed and rubbing, each with the one before as prior; yields the name of the stage,
        rows of update.csv by parameter and what was printed."""
        prior = ()
        for name, scene, options, sought in STAGES:
            has = {key: value for key, value in TEST.items() if key in sought}
            self.measure(self.run(scene, "truth", has, *options), rng)
            yield name, *self.update("--parameters", sought, *prior, *options, scene=scene, out=name)
            prior = ("--prior", f"{name}/update.csv")
