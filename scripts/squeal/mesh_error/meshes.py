"""The scene on finer meshes: counts of the built-in rig, or every element of a mesh file cut into equal ones. What a scene states
per node is divided, so that it stays the same in all."""

import math
from pathlib import Path

import numpy

from ..mesh.gmsh import read_any
from ..run.program import measured_run
from ..tables import BadInput, read_table
from .subdivide import subdivide, write_mesh

RIG_COUNTS = {"rig_disc_elements": {"patch": "21,100,3", "axisymmetric": "16,160,4"}, "rig_pad_elements": "10,10,10",
              "rig_beam_elements": "20"}
LEAST_COUNT = 0.06  # relative: what rounding may change of a count
MODES = {"mode": int, "freq_hz": float, "growth_rad_s": float, "error_hz": float, "label": str}
ROOM = 0.08  # of the band of a finer mesh, beyond that of the first
# Series of refinements of which the first that is not too large is taken; a mesh file is cut into whole numbers
SERIES = (1, 2, 3), (1, 1.5, 2), (1, 4 / 3, 5 / 3), (1, 2), (1, 1.5), (1, 4 / 3)


def rig_nodes(counts):
    """Nodes of each set of the rig, by its counts."""
    rings, columns, layers, *pad = counts
    sets = {"disc_inner": columns * (layers + 1), "disc_face": (rings + 1) * columns}
    if pad:
        sets |= {"pad_face": (pad[0] + 1) * (pad[1] + 1), "beam_top": (pad[0] + 1) * (pad[1] + 1), "beam_rows": 4 * (pad[1] + 1)}
    return sets


class Rig:
    """The built-in mesh with its counts."""

    def __init__(self, options):
        names = list(RIG_COUNTS) if options.value("rig_pad", "true").lower() in ("true", "1", "yes") else ["rig_disc_elements"]
        self.counts = {}
        for name in names:
            usual = RIG_COUNTS[name]
            usual = usual if isinstance(usual, str) else usual[options.value("rig_disc_mesh", "patch")]
            self.counts[name] = [int(n) for n in options.value(name, usual).split(",")]

    def refined(self, factor):
        return {name: [round(n * factor) for n in counts] for name, counts in self.counts.items()}

    def allows(self, factor):
        """Whether rounding leaves the counts as they should be."""
        return all(abs(new / (factor * n) - 1) <= LEAST_COUNT for name, counts in self.refined(factor).items()
                   for n, new in zip(self.counts[name], counts))

    def nodes(self, factor):
        """Nodes of each set."""
        return rig_nodes([n for counts in self.refined(factor).values() for n in counts])

    def words(self, factor, _):
        return [word for name, counts in self.refined(factor).items() for word in (f"-{name}", ",".join(map(str, counts)))]


class MeshFile:
    """A file of Gmsh."""

    def __init__(self, path):
        self.places, self.sets = read_any(path)
        self.made = {1: self.sets}

    @staticmethod
    def allows(factor):
        return factor == int(factor)

    def nodes(self, factor):
        parts = {}
        for (name, _), nodes in self.made[factor].items():
            parts.setdefault(name, []).append(numpy.unique(nodes))
        return {name: len(numpy.unique(numpy.concatenate(nodes))) for name, nodes in parts.items()}

    def words(self, factor, folder):
        places, self.made[factor] = subdivide(self.places, self.sets, int(factor))
        write_mesh(folder / "mesh.msh", places, self.made[factor])
        return ["-model_mesh", folder / "mesh.msh"]


def mesh_of(options, about):
    """Rig or MeshFile of a scene."""
    if options.value("model_mesh"):
        return MeshFile(Path(options.value("model_mesh")))
    if options.value("model_source") != "rig":
        raise BadInput(f"{about}: matrices have no mesh that could be refined; needed is -model_mesh or -model_source rig")
    return Rig(options)


def per_node(options):
    """(option, set, what) of all that the scene states for each node or pair."""
    for kind, word in (("springs", "stiffness"), ("dashpots", "viscosity")):
        yield from ((f"{name}_{word}", options.value(f"{name}_set"), "node") for name in options.names(kind))
    yield from ((f"{name}_kn", options.value(f"{name}_surfaces").split(",")[0], "pair") for name in options.names("contacts")
                if options.value(f"{name}_kn") != "identify")


def divided(options, mesh, factor):
    """Words that keep stiffnesses as they are in all, and a line for each."""
    words, lines = [], []
    for option, name, what in per_node(options):
        numbers = [float(number) for number in options.given.get(option, "0").split(",")]
        if not any(numbers):
            continue
        before, after = mesh.nodes(1)[name], mesh.nodes(factor)[name]
        words += [f"-{option}", ",".join(f"{number * before / after:.15g}" for number in numbers)]
        lines.append(f"-{option} is per {what}: {before} on the scene's mesh, {after} on this one, so that it is divided by "
                     f"{after / before:.4g}")
    return words, lines


def wider(options):
    """Words of a band, or a count, with room for modes that come from beyond its ends."""
    band = [float(number) for number in options.value("modes_band", "0,0").split(",")]
    if band[1] > 0:
        return ["-modes_band", f"{(1 - ROOM) * band[0]:.15g},{(1 + ROOM) * band[1]:.15g}"]
    return ["-modes_count", str(math.ceil(1.3 * options.number("modes_count", 20)) + 4)]


class Mesh:
    """Results of the scene on one mesh: folder, factor of the counts, rows of modes.csv, s of processor."""

    def __init__(self, folder, factor, text, seconds):
        self.folder, self.factor, self.seconds = folder, factor, seconds
        self.rows = read_table(folder / "modes.csv", MODES)
        self.unknowns = int(text.partition(" unknowns on ")[0].split()[-1])
        self.values = [complex(row["growth_rad_s"], 2 * math.pi * row["freq_hz"]) for row in self.rows]


def run_modes(args, folder, factor, words):
    """The scene's modes on one mesh."""
    folder.mkdir(parents=True, exist_ok=True)
    always = ["-analysis", "modes", "-output_fields", 1, "-squeal_progress", 0, "-squeal_view", "-output_dir", folder]
    text, seconds, _ = measured_run(args.program, args.ranks, [*words, *always], f"{args.scene}, {folder.name}")
    return Mesh(folder, factor, text, seconds)


def choose(args, mesh, unknowns):
    """The factors of the counts."""
    if args.refine:
        wrong = [factor for factor in args.refine if not mesh.allows(factor)]
        if wrong:
            raise BadInput(f"--refine {wrong[0]:g}: " + (
                "counts of the rig would be rounded by more than 6 %; valid are 2 and 3, and fractions that the counts allow"
                if isinstance(mesh, Rig) else "a mesh file is cut into whole numbers; valid are 2 and 3"))
        return [1, *args.refine]
    for series in SERIES:
        if unknowns * series[-1]**3 <= args.most and all(map(mesh.allows, series)):
            return list(series)
    raise BadInput(f"{args.scene}: {unknowns} unknowns; no finer mesh has --most {args.most} of them or less")
