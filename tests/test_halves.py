#!/usr/bin/env python3
"""A scene with a plane of symmetry by halves: its modes are those of the half that holds the normal displacement of the plane's nodes
(even) and of the half that holds the tangential ones (odd). Reference: the whole scene. A pad that slides on a slab along the
plane, so that growth is among what is compared: modes with damping, modes about all pairs with stiffness by area, of which a
pair in the plane has half. Breaks where supports, contact stiffness or friction of nodes in the plane count other than by area,
or where elements are not their own mirror images.

    test_halves.py SQUEAL"""

import csv
import re
import shutil
import sys
import tempfile
from collections import Counter
from pathlib import Path

try:
    import numpy
except ImportError as error:
    print(f"skipped: no Python module {error.name}")
    sys.exit(77)
from served import outcome_of, starter

WIDTH = 0.02  # half of it, m
BODIES = {"slab": ((-0.05, 0.05), (-0.01, 0.0), (10, 4, 2)), "pad": ((-0.02, 0.02), (0.0, 0.015), (4, 4, 3))}  # x, z, cells of a half
SCENE = """-parts slab,pad -slab_young 210e9 -slab_poisson 0.3 -slab_density 7800 -slab_alpha 20 -pad_young 12e9 -pad_poisson 0.3
    -pad_density 2500 -pad_alpha 20 -contacts rub -rub_surfaces pad_bottom,slab_top
    -rub_mu 0.7 -rub_slip 1,0,0
    -output_fields 0"""
HOLDER = ["-springs", "holder", "-holder_set", "pad_top", "-holder_stiffness_per_area", "2e10,3e10,1e11"]
PENALTY, EXACT, UNDAMPED = "-rub_law penalty -rub_kn_per_area 2e14", "-rub_law constraint", "-slab_alpha 0 -pad_alpha 0"
BAND = "-modes_band 500,60000"
RTOL = 1e-9


def body(first, x, y, z, cells):
    """Nodes of a box, its hexahedra and the quadrilaterals of its sides, with numbers from `first` on."""
    n = numpy.array(cells) + 1
    axes = [numpy.linspace(*range_, n[d]) for d, range_ in enumerate((x, y, z))]
    nodes = numpy.stack(numpy.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)
    number = first + numpy.arange(len(nodes)).reshape(n)
    a, b = slice(None, -1), slice(1, None)
    ring = [(a, a), (b, a), (b, b), (a, b)]
    hexahedra = numpy.stack([number[i, j, k] for k in (a, b) for i, j in ring], -1).reshape(-1, 8)
    side = {name: numpy.stack([face[i, j] for i, j in ring], -1).reshape(-1, 4) for name, face in
            {"bottom": number[:, :, 0], "top": number[:, :, -1], "start": number[0], "end": number[-1], "cut": number[:, 0],
             "far": number[:, -1]}.items()}
    return nodes, hexahedra, side


def write_mesh(path, half, shift=0, digits=17):
    """Both bodies, whole or the half of positive y, shifted along y [m], as a file of Gmsh."""
    y, factor = ((0, WIDTH), 1) if half else ((-WIDTH, WIDTH), 2)
    nodes, groups = [], {}
    for name, (x, z, cells) in BODIES.items():
        added, groups[3, name], side = body(1 + sum(map(len, nodes)), x, y, z, (cells[0], factor * cells[1], cells[2]))
        nodes.append(added)
        for set_, quads in side.items():
            key = (2, set_ if set_ in ("cut", "far") else f"{name}_{set_}")
            groups[key] = numpy.concatenate([groups[key], quads]) if key in groups else quads
    nodes = numpy.concatenate(nodes)
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(groups))]
    lines += [f'{dimension} {i + 1} "{name}"' for i, (dimension, name) in enumerate(groups)]
    lines += ["$EndPhysicalNames", "$Nodes", str(len(nodes))]
    lines += [f"{i + 1} {' '.join(f'{x:.{digits}g}' for x in place)}" for i, place in enumerate(nodes + [0, shift, 0])]
    elements = [(5 if dimension == 3 else 3, i + 1, row) for i, ((dimension, _), rows) in enumerate(groups.items()) for row in rows]
    lines += ["$EndNodes", "$Elements", str(len(elements))]
    lines += [f"{k + 1} {kind} 2 {i} {i} {' '.join(map(str, row))}" for k, (kind, i, row) in enumerate(elements)]
    path.write_text("\n".join([*lines, "$EndElements"]) + "\n")


class Runs:
    """Modes of the scene in a folder, run by run."""

    def __init__(self, folder, squeal):
        self.folder, self.program, self.printed = folder, starter(squeal), ""

    def run(self, name, mesh, fix="", options="", ranks=1, fails=False):
        """A run that holds the slab's start, directions of the cut, and the pad but where it is free; returns its errors."""
        words = ["-options_file", "scene.txt", *([] if name.startswith("free") else HOLDER), "-model_mesh", mesh,
                 "-output_dir", name, "-supports", "clamp,plane" if fix else "clamp",
                 "-clamp_set", "slab_start", "-clamp_fix", "xyz", *(["-plane_set", "cut", "-plane_fix", fix] if fix else []),
                 *options.split()]
        done = outcome_of(self.program, self.folder, words, ranks)
        if bool(done.status) != fails:
            sys.exit(f"FAILED run {name}, exit status {done.status}: {done.stderr}")
        self.printed = done.stdout
        return done.stderr

    def rows(self, name, mesh, fix="", options=f"{PENALTY} {BAND}", ranks=1, table="modes"):
        """Table of such a run, with lambda [rad/s] of each row."""
        self.run(name, mesh, fix, options, ranks)
        return self.table(name, table, True)

    def table(self, name, table, values=False):
        """Rows of a table of a run, where asked for with lambda [rad/s] of each."""
        with (self.folder / name / f"{table}.csv").open(newline="") as file:
            rows = list(csv.DictReader(file))
        for row in rows if values else []:
            row["lambda"] = float(row["growth_rad_s"]) + 2j * numpy.pi * float(row["freq_hz"])
        return rows

    def told(self, name):
        """How many modes of each parity the provenance tells."""
        said = re.search(r"^.*completeness:(.*)$", (self.folder / name / "scene.yaml").read_text(), re.MULTILINE)
        return Counter({parity: int(n) for parity, n in re.findall(r"((?:even|odd)(?: even| odd)*): (\d+) modes", said[1])})


def apart(found, reference):
    """Largest relative difference of the eigenvalues; infinite where their numbers differ."""
    if len(found) != len(reference) or not len(reference):
        return numpy.inf
    values = numpy.array([row["lambda"] for row in found])
    return max(abs(values - row["lambda"]).min() / abs(row["lambda"]) for row in reference)


def halves(runs, whole):
    """Whole against both halves by supports, and each parity by -symmetry, on one and two ranks, against its half."""
    even, odd = runs.rows("even", "half.msh", "y"), runs.rows("odd", "half.msh", "xz")
    yield f"{len(whole)} modes by halves, {len(even)} even, {len(odd)} odd", apart([*even, *odd], whole)
    for ranks in (1, 2):
        found = runs.rows(f"symmetry{ranks}", "whole.msh", options=f"{PENALTY} {BAND} -symmetry y", ranks=ranks)
        for parity, half in (("even", even), ("odd", odd)):
            yield f"-symmetry y, {parity}, {ranks} ranks", apart([row for row in found if row["symmetry"] == parity], half)
        yield f"shares of the parts, {ranks} ranks", max(
            abs(float(a[name]) - float(b[name])) / 100 for a, b in zip(found, whole) for name in ("part_slab_percent", "part_pad_percent"))
        yield f"labels and what grows, {ranks} ranks", float(any(
            a[name] != b[name] for a, b in zip(found, whole) for name in ("label", "unstable")))


KINDS = (  # name, options, planes
    ("no friction, undamped", f"{PENALTY} {BAND} {UNDAMPED} -rub_mu 0", "y"),
    ("friction, undamped", f"{PENALTY} {BAND} {UNDAMPED}", "y=0"),
    ("friction, LDL' and an update", f"{PENALTY} {BAND} {UNDAMPED} -operators_factors symmetric", "y"),
    ("exact contact", f"{EXACT} {BAND} {UNDAMPED}", "y"),
    ("nearest 17", f"{PENALTY} -modes_target 20000 -modes_count 17 {UNDAMPED}", "y"),
    ("no friction, two planes", f"{PENALTY} {BAND} {UNDAMPED} -rub_mu 0 -supports clamp,far -far_set slab_end -far_fix xyz", "y=0,x"),
    ("quadratic problem", f"{PENALTY} -pad_alpha 400 -modes_damping pep -modes_band 500,20000", "y"))


def kinds(runs):
    """Other kinds of problems, each against its whole."""
    for name, options, planes in KINDS:
        folder = "".join(letter for letter in name if letter.isalnum())
        whole = runs.rows(f"{folder}_whole", "whole.msh", options=options)
        found = runs.rows(folder, "whole.msh", options=f"{options} -symmetry {planes}")
        yield f"{name}, {len(whole)} modes", apart(found, whole)
        yield f"{name}, modes of each parity as told", float(runs.told(folder) != Counter(row["symmetry"] for row in found))


def points_apart(found, whole):
    """As apart(), point by point of a sweep."""
    return max(apart(*([row for row in rows if row["point"] == point] for rows in (found, whole)))
               for point in {row["point"] for row in whole})


SWEEP = (f"-analysis sweep -sweep_parameter rub_mu -sweep_values 0.55,0.7 {PENALTY} {UNDAMPED} "
         "-modes_band 500,28000")
BASIS = "-sweep_rtol 1e-9"


def sweeps(runs):
    """Sweeps of each parity against that of the whole: every eigenvalue, the onset and which parity it is of."""
    whole = runs.rows("sweep_whole", "whole.msh", options=f"{SWEEP} {BASIS}", table="sweep")
    onsets = runs.table("sweep_whole", "onsets")
    for name, how, ranks in (("sweep", BASIS, 1), ("sweep2", BASIS, 2), ("sweep_full", "-sweep_method full", 1)):
        found = runs.rows(name, "whole.msh", options=f"{SWEEP} {how} -symmetry y", ranks=ranks, table="sweep")
        yield f"{name}, {len(whole)} eigenvalues", points_apart(found, whole)
        yield f"{name}, modes of both parities", float({row["symmetry"] for row in found} != {"even", "odd"})
        if how != BASIS:
            continue
        same = [float(row["critical_value"]) for row in runs.table(name, "onsets")
                if row["confirmed"] == "1" and row["symmetry"] == "even"]
        yield f"{name}, {len(onsets)} onset of an even pair", max(
            (abs(a / float(row["critical_value"]) - 1) for a, row in zip(same, onsets, strict=True)), default=numpy.inf)


KEPT = (f"-analysis sweep -sweep_parameter pad_young,slab_young -sweep_values 6e9,24e9 -sweep_values_2 150e9,210e9 "
        f"-sweep_rtol 1e-9 {PENALTY} {UNDAMPED} -rub_mu 0 -modes_band 500,14000 -supports clamp,far -far_set slab_end -far_fix xyz")


def restarts(runs):
    """A sweep of a scene with two planes, on two axes, that ended after two full solutions of the even part: it goes on in that
    plane, begins anew in the other one, and leaves nothing of it behind, in either or without -symmetry."""
    runs.run("kept", "whole.msh", options=f"{KEPT} -symmetry y -sweep_max_samples 2", fails=True)
    for name in ("kept_whole", "kept_x"):
        shutil.copytree(runs.folder / "kept", runs.folder / name)
    whole = runs.rows("kept_whole", "whole.msh", options=KEPT, table="sweep")
    said = runs.run("kept_x", "whole.msh", options=f"{KEPT} -symmetry x")
    yield "restart, another plane begins anew", float("differs in: -symmetry;" not in said or "going on" in runs.printed)
    yield "restart, another plane", points_apart(runs.table("kept_x", "sweep", True), whole)
    found = runs.rows("kept", "whole.msh", options=f"{KEPT} -symmetry y", table="sweep")
    yield "restart goes on", float("going on with 2 full solutions, even" not in runs.printed)
    yield f"restart, {len(whole)} eigenvalues", points_apart(found, whole)
    for name in ("kept_whole", "kept_x", "kept"):
        yield f"restart files left in {name}", float(len(list((runs.folder / name).glob("sweep_restart*"))))
    real = runs.rows("real", "whole.msh", options=f"{KEPT} -symmetry y -sweep_method real", table="sweep")
    yield "real modes, where they are exact", apart(*([row for row in rows if row["point"] == "3"] for rows in (real, whole)))


MORE = (f"-analysis sweep -sweep_parameter rub_mu -sweep_values 0.6,0.7 -sweep_rtol 1e-9 -sweep_onsets 0 {PENALTY} {UNDAMPED} "
        "-modes_band 25500,27500 -sweep_percent 5 -sweep_uncertain")


def columns(rows, names):
    """Numbers of some columns, a row each, in the order of the first."""
    return numpy.array(sorted([float(row[name]) for name in names] for row in rows))


def tables(runs):
    """Risks, sensitivities and checks of a sweep against those of the whole; and parameters of which each alone moves one side,
    behind so many others that not all their corners are looked at."""
    whole, found = (f"more{symmetry}" for symmetry in ("_whole", ""))
    runs.run(whole, "whole.msh", options=f"{MORE} pad_young -sweep_verify 1 -sweep_sensitivities 1")
    runs.run(found, "whole.msh", options=f"{MORE} pad_young -sweep_verify 1 -sweep_sensitivities 1 -symmetry y", ranks=3)
    for table, names in (("robustness", ("freq_hz", "growth_largest_rad_s", "unstable_combinations")),
                         ("verify", ("modes_full", "modes_reduced", "unstable_full", "unstable_reduced")),
                         ("sensitivities", ("freq_hz", "freq_hz_per_percent", "growth_rad_s_per_percent"))):
        a, b = (columns(runs.table(name, table), names) for name in (whole, found))
        yield f"{table}, {len(a)} rows", numpy.max(abs(a - b) / abs(a).max(0).clip(1)) if a.shape == b.shape and len(a) else numpy.inf
    errors = [float(runs.table(name, "verify")[0]["true_error"]) for name in (whole, found)]
    yield "verify, a true error as of the whole, to a factor of 10", float(not errors[0] / 10 <= errors[1] <= 10 * errors[0])
    said = runs.run("refused", "whole.msh", fails=True, options=f"{MORE} slab_young,slab_density,pad_young,pad_density,rub_mu,"
                    "rub_kn_per_area,left_stiffness_per_area,right_stiffness_per_area -symmetry y -springs holder,left,right "
                    "-left_set cut -left_stiffness_per_area 0,0,1e10 -right_set far -right_stiffness_per_area 0,0,1e10")
    yield "refused: the seventh of eight uncertain parameters", float("the scene is not its own mirror image" not in said)


STATIC = ("-analysis static -loads press -press_set pad_top "
          f"{EXACT} -rub_slip 0,0,0 -rub_mu 0.3")
STATICS = (  # name, options, ranks, planes: friction that sticks and slips in all directions, sliding, no springs but rigid motions left
    ("free, friction", "-press_force 100,0,-1000", 2, "y"),
    ("friction, two planes", "-press_force 0,0,-1000 -supports clamp,far -far_set slab_end -far_fix xyz", 1, "y,x"),
    ("friction by GMRES", f"-press_force 300,0,-1000 -static_dense 0 {PENALTY}", 1, "y"),
    ("sliding", "-press_force 0,0,-1000 -rub_slip 1,0,0", 1, "y"),
    ("free, without friction", "-press_force 0,0,-1000 -rub_mu 0", 1, "y"))


def statics(runs):
    """The even half of equilibria against the whole: statuses and forces of all pairs."""
    for name, options, ranks, planes in STATICS:
        folder = "".join(letter for letter in name if letter.isalnum())
        options = f"{STATIC} {options}"
        runs.run(f"{folder}_whole", "whole.msh", options=options)
        runs.run(folder, "whole.msh", options=f"{options} -symmetry {planes}", ranks=ranks)
        whole, found = ({(row["x_m"], row["y_m"]): row for row in runs.table(run, "static")} for run in (f"{folder}_whole", folder))
        yield f"static, {name}, statuses of {len(whole)} pairs", float(any(found[at]["status"] != whole[at]["status"] for at in whole))
        for column in ("lambda_n_n", "lambda_t_n", "lambda_b_n"):
            values = numpy.array([[float(rows[at][column]) for at in whole] for rows in (whole, found)])
            yield f"static, {name}, {column}, {ranks} ranks", abs(values[1] - values[0]).max() / max(abs(values[0]).max(), 1e-9)


REFUSED = (  # name, options, planes, message
    ("loads across the plane", f"{STATIC} -press_force 0,100,-1000", "y", "the -loads, the weight or -motions differ by 2.0e-01 of the"),
    ("a spring at one side, exact contact", f"{EXACT} {BAND} -springs holder,edge -edge_set cut -edge_stiffness_per_area 1e9,1e9,1e9", "y",
     "springs and contacts differs by \\S+ of its row .1e-11 allowed by -symmetry_rtol"),
    ("slip across the plane", f"{STATIC} -press_force 0,0,-1000 -rub_slip 0,1,0", "y", "slip directions differ by 2.0e\\+00"),
    ("a support at one end", f"{STATIC} -press_force 0,0,-1000", "x", "support or motion holds x at one alone"),
    ("a set joined rigidly", f"{PENALTY} {BAND} -points hub -hub_set slab_end -hub_join rigid -hub_mass 0.1", "y",
     "what -points joined rigidly .hub. leave is not its own mirror image: .* -points that are joined rigidly are not supported with it"),
    ("in time", "-analysis transient", "y", "used by -analysis modes, sweep and static alone; leave it out"))


def rounded(runs):
    """A mesh that is mirrored to 7 digits: refused, and with -symmetry_rtol the modes of the mean of scene and image."""
    write_mesh(runs.folder / "rounded.msh", False, shift=0.0123456789, digits=7)
    options = f"{PENALTY} {UNDAMPED} {BAND}"
    said = runs.run("refused", "rounded.msh", options=f"{options} -symmetry y", fails=True)
    yield "a mesh of 7 digits is refused", float("1e-11 allowed by -symmetry_rtol" not in said)
    whole = runs.rows("rounded_whole", "rounded.msh", options=options)
    yield "a mesh of 7 digits", apart(runs.rows("rounded", "rounded.msh", options=f"{options} -symmetry y -symmetry_rtol 1e-5"), whole)


LOOSE = f"{PENALTY} -springs holder,edge -edge_set cut -edge_stiffness_per_area 1e9,1e9,1e9 -symmetry_rtol 1e-3 -symmetry y"
LOOSE_REFUSED = (  # what, options, message
    ("sweeps", "-analysis sweep -sweep_parameter rub_mu -sweep_values 0.55,0.7 -modes_band 500,28000",
     "sweeps do not measure what it leaves out"),
    ("statics", "-analysis static -loads press -press_set pad_top -press_force 0,0,-1000",
     "1e-11 allowed in statics, whatever -symmetry_rtol"))


def loose(runs):
    """A spring at one side alone, which -symmetry_rtol leaves out: the errors of modes cover what that does to them, and their
    backward errors show it; what has no such errors refuses it."""
    exact, words = runs.rows("loose_whole", "whole.msh", options=f"{LOOSE.split(' -symmetry')[0]} {UNDAMPED} {BAND}"), []
    found = runs.rows("loose", "whole.msh", options=f"{LOOSE} {UNDAMPED} {BAND}", ranks=2)
    for row in found:
        nearest = min(exact, key=lambda other: abs(other["lambda"] - row["lambda"]))
        off, rounding = abs(nearest["lambda"] - row["lambda"]) / (2 * numpy.pi), float(nearest["error_hz"])
        words.append((off > 10 * rounding, off > float(row["error_hz"]) + rounding, float(row["backward_error"])))
    moved = sum(word[0] for word in words)
    yield f"{moved} of {len(words)} modes that a spring of one side moves", float(moved < 5)
    yield "modes that it moves by more than their errors", float(sum(word[1] for word in words))
    yield "backward errors without it", float(min(word[2] for word in words) < 1e-14)
    for name, options, message in LOOSE_REFUSED:
        said = runs.run("refused", "whole.msh", options=f"{LOOSE} {options}", fails=True)
        yield f"refused: -symmetry_rtol in {name}", float(message not in said)


def refusals(runs):
    """Scenes that are not their own mirror images, or cannot be halved."""
    for name, options, planes, message in REFUSED:
        said = runs.run("refused", "whole.msh", options=f"{options} -symmetry {planes}", fails=True)
        if not re.fullmatch(f"squeal: error: -symmetry {planes}: .*{message}.*\n", said):
            print(f"{name}: said {said}")
        yield f"refused: {name}", float(not re.fullmatch(f"squeal: error: -symmetry {planes}: .*{message}.*\n", said))


def main(squeal):
    """Prints what differs."""
    with tempfile.TemporaryDirectory() as name:
        runs = Runs(Path(name), squeal)
        (runs.folder / "scene.txt").write_text(re.sub(r"\s(-[a-z])", r"\n\1", SCENE) + "\n")
        write_mesh(runs.folder / "whole.msh", False)
        write_mesh(runs.folder / "half.msh", True)
        whole = runs.rows("whole", "whole.msh")
        found = [("modes that do not grow of " + str(len(whole)), float(all(row["lambda"].real <= 1 for row in whole))),
                 *halves(runs, whole), *kinds(runs), *sweeps(runs), *restarts(runs), *tables(runs), *statics(runs), *rounded(runs),
                 *loose(runs), *refusals(runs)]
        runs.program.end()
    for what, worst in found:
        print(f"{what}: differ by {worst:.1e}, {RTOL:g} allowed")
    sys.exit(0 if all(worst <= RTOL for _, worst in found) else "FAILED")


if __name__ == "__main__":
    main(sys.argv[1])
