#!/usr/bin/env python3
"""A brake in space whose disc, pad and beam have no coordinate axis: the same kernels serve it in time, with the same
motion. The reference is its own unmoved mesh, which is that of the built-in brake; springs have no direction, and what
the table says of a probe is turned back. Loads are so large that the rounding of places, which gaps and the contact
forces of single steps see, is small beside the motion; accelerations and the friction force of a single step still hold
it and are not compared. Breaks where an axis is not found, or bases, supports, springs or masses go by x, y, z. With
one direction of the disc held alone it must fall back on rows of blocks, and say the same as with those.

    test_oblique.py SQUEAL LAUNCHER"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import numpy
except ImportError as error:
    print(f"skipped: no Python module {error.name}")
    sys.exit(77)

from served import sooner

SOURCE = Path(__file__).resolve().parents[1]
SCENE = SOURCE / "options/massi2005_transient.yaml"
OPTIONS = ["-rows_stiffness", "8e6,8e6,8e6", "-press_ramp", "2e-5", "-contact_speed", "20",
           "-tap_time", "1e-4", "-ts_dt", "5e-8", "-ts_max_steps", "4000"]
AXIS, TURN, SHIFT = numpy.array([2.0, -1.0, 1.5]), 0.7, numpy.array([0.0123, -0.21, 0.0457])
RTOL = 1e-9
COMPARED = ["normal_force_n", *(f"{name}_j" for name in "kinetic strain external_work friction_work damping_work friction_heat".split())]
failed = []


def check(name, good, text=""):
    """Prints, and keeps what failed."""
    print(f"{'ok    ' if good else 'FAILED'} {name}{': ' if text else ''}{text}")
    if not good:
        failed.append(name)


def rotation():
    """By TURN about AXIS, from the exponential of its cross product."""
    x, y, z = AXIS / numpy.linalg.norm(AXIS)
    cross = numpy.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return numpy.eye(3) + numpy.sin(TURN) * cross + (1 - numpy.cos(TURN)) * cross @ cross


def move(path, moved, turn):
    """Turns and shifts the nodes of a Gmsh file of format 2.2 in text."""
    lines = path.read_text().splitlines()
    first = lines.index("$Nodes") + 2
    for i in range(first, lines.index("$EndNodes")):
        words = lines[i].split()
        place = turn @ numpy.array(list(map(float, words[1:]))) + SHIFT
        lines[i] = " ".join([words[0], *(repr(float(x)) for x in place)])
    moved.write_text("\n".join(lines) + "\n")


def vector(values):
    """As an option has it."""
    return ",".join(repr(float(x)) for x in values)


class Runs:
    """Runs of squeal in one folder."""

    def __init__(self, folder, squeal, launcher):
        self.folder, self.squeal, self.launcher = folder, str(Path(squeal).resolve()), str(Path(launcher).resolve())

    def run(self, name, ranks, *options):
        """What it says, and its table."""
        words = [self.launcher, "-n", str(ranks), self.squeal, *options, *OPTIONS, "-squeal_view", "-output_dir", name]
        done = subprocess.run(list(map(str, words)), cwd=self.folder, capture_output=True, text=True)
        if done.returncode:
            print(done.stderr)
            sys.exit(f"FAILED run {name}")
        return done.stdout, numpy.genfromtxt(self.folder / name / "transient.csv", delimiter=",", names=True)


def scene(mesh, turn, shift):
    """Options of the brake on a mesh that is turned and shifted."""
    places = {"-edge_at": [0.105, 0.005, 0], "-face_at": [-0.12, 0, 0], "-tap_at": [-0.12, 0, 0]}
    directions = {"-contact_slip": [0, 1, 0], "-press_force": [0, 0, -1e8], "-tap_impulse": [0, 0, -1e4]}
    words = ["-options_file", "scene.yaml", "-model_mesh", mesh]
    for key, x in places.items():
        words += [key, vector(turn @ numpy.array(x) + shift)]
    for key, x in directions.items():
        words += [key, vector(turn @ numpy.array(x))]
    return words


def turned_back(table, turn):
    """Its columns, those of probes in the directions of the unmoved brake; [quantities] of [rows] or [rows][3]."""
    names, columns = table.dtype.names, {}
    for name in names:
        found = re.match(r"((?:edge|face)_v?)x(_.*)", name)
        if found:
            columns[name] = numpy.stack([table[f"{found[1]}{d}{found[2]}"] for d in "xyz"], -1) @ turn
        elif name in COMPARED:
            columns[name] = table[name]
    return columns


def kernels(text):
    """Elements of each body by each kernel."""
    return re.findall(r"body (\d): (\d+) elements, swept (about|along).*?, (\d+) by a stencil along lines\n", text)


def compare(name, one, two, rtol):
    """Largest difference beside the largest value of each quantity."""
    worst = max((abs(one[key] - two[key]).max() / abs(one[key]).max(), key) for key in one if abs(one[key]).max() > 0)
    check(name, worst[0] <= rtol, f"{worst[0]:.1e} ({worst[1]}), at most {rtol:g}")


def main(squeal, launcher):
    """Unmoved and moved, on one and two ranks; then a scene that must fall back."""
    turn = rotation()
    with tempfile.TemporaryDirectory() as folder:
        runs = Runs(Path(folder), squeal, launcher)
        (Path(folder) / "scene.yaml").write_text(re.sub(r"^(model:.*|rig:)\n(  .*\n)*", "", SCENE.read_text(), flags=re.M))
        small = ["-rig_disc_elements", "6,60,2", "-rig_pad_elements", "4,4,4"]
        text, _ = runs.run("rig", 1, "-options_file", SCENE, *small, "-rig_save", "rig.msh")
        move(Path(folder) / "rig.msh", Path(folder) / "moved.msh", turn)
        still, first = runs.run("still", 1, *scene("rig.msh", numpy.eye(3), 0 * SHIFT))
        check("the brake's bodies are swept", len(kernels(still)) == 2 and kernels(still) == kernels(text), str(kernels(still)))
        closed = first["n_closed"]
        check("contact events among what is compared", len(set(closed)) > 3 and first["n_stick"].max() > 0,
              f"{closed.min():g} to {closed.max():g} closed")
        reference = turned_back(first, numpy.eye(3))
        for ranks in 1, 2:
            said, table = runs.run("moved", ranks, *scene("moved.msh", turn, SHIFT))
            if ranks == 1:
                check("the same kernels", kernels(said) == kernels(still), str(kernels(said)))
            compare(f"turned, on {ranks} ranks", reference, turned_back(table, turn), RTOL)
        held = ["-supports", "hub", "-hub_fix", "xy"]
        said, table = runs.run("held", 1, *scene("moved.msh", turn, SHIFT), *held)
        check("held in x and y alone: rows of blocks", "by a stencil" not in said.split("body 2")[0].split("body 1")[1], "")
        _, general = runs.run("general", 1, *scene("moved.msh", turn, SHIFT), *held, "-dynamics_kernel", "general")
        compare("the same as rows of blocks", turned_back(general, turn), turned_back(table, turn), RTOL)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    with sooner(sys.argv[1]) as quick:
        main(quick, sys.argv[2])
