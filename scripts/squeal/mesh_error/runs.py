"""The scene on its own mesh and on finer ones, and the limits of what it has there."""

import math

from ..run.program import measured_run
from ..provenance import Provenance
from ..tables import BadInput, flag, printable, quoted, read_table
from .limits import UNKNOWN, limit_of
from .match import Shapes, match
from .meshes import choose, divided, mesh_of, per_node, run_modes, wider

ONSETS = {"parameter": str, "critical_value": float, "freq_hz": float, "kind": str, "label": str, "confirmed": flag,
          "error_estimate": float}
SAME_ONSET = 0.5  # largest distance of the same onset on two meshes: of the value relative to it, and ten times of the frequency


class Study:
    """Meshes from coarse to fine, sizes of their elements relative to the first, order of the elements, words of each run,
    lines about what was divided."""

    def __init__(self, args):
        self.args, self.lines = args, []
        first = run_modes(args, args.output / "mesh1", 1, ["-options_file", args.scene, *self.own_words()])
        self.options = Provenance(first.folder / "scene.yaml")
        self.mesh = mesh_of(self.options, args.scene)
        self.meshes, self.words = [first], [["-options_file", first.folder / "scene.yaml"]]
        swept = self.options.value("sweep_parameter").split(",")
        bad = [option for option, *_ in per_node(self.options) if option in swept]
        if bad:
            raise BadInput(f"-sweep_parameter {bad[0]} is per node or pair, another thing on another mesh: state it in total or per area")
        for factor in choose(args, self.mesh, first.unknowns)[1:]:
            self.refine(factor)
        shapes = [Shapes(mesh.folder, len(mesh.rows)) for mesh in self.meshes]
        self.sizes = [(shapes[0].cells / shape.cells)**(1 / 3) for shape in shapes]
        lumped = self.options.value("operators_mass") == "lumped" and not shapes[0].lobatto
        self.order = 4 if shapes[0].second and not lumped else 2
        self.partners = self.pairs(shapes)

    def own_words(self):
        """The options of the command line; those of a sweep in a file, since on a command line modes would refuse them."""
        words, swept = [], []
        for word in self.args.options:
            begins = word.startswith("-") and not word[1:2].isdigit()
            into = (swept if word.startswith("-sweep_") else words) if begins else into
            into.append(word)
        if not swept:
            return words
        names = [i for i, word in enumerate(swept) if word.startswith("-sweep_")] + [len(swept)]
        lines = [f"{swept[i][1:]}: {quoted(printable(' '.join(swept[i + 1:k])) or 'true')}" for i, k in zip(names, names[1:])]
        self.args.output.mkdir(parents=True, exist_ok=True)
        path = self.args.output / "sweep.yaml"
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")
        return [*words, "-options_file", path]

    def refine(self, factor):
        """One more mesh."""
        folder = self.args.output / f"mesh{len(self.meshes) + 1}"
        folder.mkdir(parents=True, exist_ok=True)
        words = [*self.words[0], *self.mesh.words(factor, folder), *wider(self.options)]
        more, self.lines = divided(self.options, self.mesh, factor)
        self.words.append([*words, *more])
        self.meshes.append(run_modes(self.args, folder, factor, self.words[-1]))

    def pairs(self, shapes):
        """For each finer mesh: mode -> (partner, share)."""
        nodes = shapes[0].sample()
        here = shapes[0].at(shapes[0], nodes)
        return [match(self.meshes[0].values, mesh.values, here, shape.at(shapes[0], nodes))
                for mesh, shape in zip(self.meshes[1:], shapes[1:])]

    def limit(self, values, noise, zero=False):
        """Of values on the meshes, None where one has none; zero: as limit_of() has it."""
        there = [(size, value) for size, value in zip(self.sizes, values) if value is not None]
        return limit_of(*zip(*there), self.order, noise, zero) if len(there) > 1 else UNKNOWN

    def mode_limits(self):
        """For each mode of the scene (Limit of the frequency, of the growth, least share of the shapes)."""
        found = []
        for i, row in enumerate(self.meshes[0].rows):
            partners = [pairs.get(i) for pairs in self.partners]
            rows = [row, *(mesh.rows[p[0]] if p else None for mesh, p in zip(self.meshes[1:], partners))]
            noise = max(r["error_hz"] for r in rows if r)
            freq = self.limit([r and r["freq_hz"] for r in rows], noise)
            growth = self.limit([r and r["growth_rad_s"] for r in rows], 2 * math.pi * noise, zero=True)
            found.append((freq, growth, min((p[1] for p in partners if p), default=math.nan)))
        return found

    def sweep(self):
        """Onsets on each mesh, a list of rows each."""
        tables = []
        for i, (mesh, words) in enumerate(zip(self.meshes, self.words), 1):
            folder = self.args.output / f"sweep{i}"
            text, seconds, _ = measured_run(self.args.program, self.args.ranks, [
                *words, "-analysis", "sweep", "-sweep_onsets", 1, "-sweep_restart", 0, "-squeal_progress", 0, "-output_dir", folder],
                f"{self.args.scene}, {folder.name}")
            mesh.seconds += seconds
            tables.append(read_table(folder / "onsets.csv", ONSETS))
        return tables

    def onset_limits(self, tables):
        """For each onset of the scene (Limit of the critical value, of its frequency)."""
        rows = [[row] for row in tables[0]]
        for table in tables[1:]:
            partners = onset_partners(tables[0], table)
            for own, partner in zip(rows, partners):
                own.append(partner)
        return [(self.limit([r and r["critical_value"] for r in own], max(r["error_estimate"] for r in own if r)),
                 self.limit([r and r["freq_hz"] for r in own], 1e-6)) for own in rows]


def distance(one, other):
    """Of two onsets; those of another kind or parameter are infinitely far."""
    if (one["kind"], one["parameter"]) != (other["kind"], other["parameter"]):
        return math.inf
    value = abs(other["critical_value"] - one["critical_value"]) / max(abs(one["critical_value"]), 1e-300)
    return value + 10 * abs(other["freq_hz"] - one["freq_hz"]) / max(one["freq_hz"], 1.0) + 0.05 * (one["label"] != other["label"])


def onset_partners(rows, others):
    """The onset of another mesh that each is, or None: the nearest pairs first."""
    offers = sorted((distance(one, other), i, j) for i, one in enumerate(rows) for j, other in enumerate(others))
    partners, taken = [None] * len(rows), set()
    for far, i, j in offers:
        if far <= SAME_ONSET and partners[i] is None and j not in taken:
            partners[i] = others[j]
            taken.add(j)
    return partners
