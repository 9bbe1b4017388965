"""Masses, springs, dashpots, layers and percents of parameters that calm all unstable modes of a result folder. One run of squeal tells how
each candidate couples the modes (-modes_couplings); sets are ranked by the eigenvalues that these couplings make, to second order and
with pairs that merge or part; a second run tries the cheapest with -modes_changes, with errors."""

import csv
import itertools
from dataclasses import dataclass

import numpy

from ..provenance import Provenance
from ..run.program import measured_run
from ..tables import BadInput, flag, optional, quoted, read_table
from .cure_places import rings, sets

MODES = {"mode": int, "freq_hz": float, "growth_rad_s": float, "unstable": flag}
EFFECTS = {"mode": int, "change": str, "part": str, **{f"direction_{axis}": float for axis in "xyz"},
           **{f"{axis}_m": float for axis in "xyz"}, "first_order_units_to_zero": float,
           "to_part": str, **{f"to_{axis}_m": optional for axis in "xyz"}}
CHANGED = {"change": str, "mode": int, "freq_hz": float, "growth_rad_s": float, "error_hz": float, "state": str, "before": int}
HEAVY, STIFF, VISCOUS = ("mass", "kg", 1e3, "g"), ("stiffness", "N/m", 1e-3, "N/mm"), ("viscosity", "N s/m", 1.0, "N s/m")
KINDS = {"mass": HEAVY, "spring": STIFF, "dashpot": VISCOUS, "relative_spring": STIFF, "relative_dashpot": VISCOUS,
         "layer_mass": HEAVY, "layer_spring": STIFF, "layer_dashpot": VISCOUS, "parameter": ("percent", "", 1.0, "%")}
FACTORS = 0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0  # of the amount that would stop a mode if the first order held
PERCENTS = 0.2, 0.5, 1.0  # of the largest change of a parameter
MOST_LOOKED_AT = 70  # changes of a run: each has up to six options, of which PETSc 3.18 takes 512
SINGLES = 40, 16  # changes of which sets are made, two amounts of each place at most; the same where ENOUGH places do it alone
ENOUGH = 3
BLOCK = 256  # sets whose eigenvalues are found at once
ALIKE = 2  # sets of the same places that are tried
QUIET = 1e-4  # of an eigenvalue: growth that couplings, which are of second order, do not tell from none
ROUNDING = 1e-6  # of an angular frequency: growth that is none
TWO_PI = 6.283185307179586


@dataclass
class Change:
    """One change: its option `amount` in the units of the scene, `size` in easy ones, and what that costs; to_part is empty for the
    ground; `name` is the set, the radii of the ring, or the parameter of one that is at no node."""
    kind: str
    part: str
    place: list
    to_part: str
    to_place: list
    direction: list
    amount: float
    size: float
    cost: float
    name: str = ""

    def options(self, partner=""):
        """As an entry of an options file."""
        words = [f"{KINDS[self.kind][0]}: {self.amount:.6g}"]
        if self.kind == "parameter":
            words.append(f"parameter: {quoted(self.name)}")
        elif self.name:
            words.append(f'{"ring" if "," in self.name else "set"}: {quoted(self.name)}')
        else:
            words += [f'at: "{",".join(f"{x:.15g}" for x in self.place)}"', f"part: {quoted(self.part)}"]
        if self.to_part:
            words += [f'to: "{",".join(f"{x:.15g}" for x in self.to_place)}"', f"to_part: {quoted(self.to_part)}"]
        if any(self.direction):
            words.append(f'direction: "{",".join(f"{x:.9g}" for x in self.direction)}"')
        return "{" + ", ".join(words + ([f"with: {partner}"] if partner else [])) + "}"

    def words(self):
        """For people."""
        size = f"{self.size:.4g} {KINDS[self.kind][3]}"
        along = f" along {', '.join(f'{x + 0:.2f}' for x in self.direction)}" if any(self.direction) else ""
        if self.kind == "parameter":
            return f"{self.name} by {self.size:+.3g} %"
        if self.name:
            over = f"ring {self.name.replace(',', ' to ')}" if "," in self.name else f"set {self.name}"
            return f"{self.kind.replace('_', ' ')} {size} over {over}{along}"
        there = f" to {self.to_part} at {', '.join(f'{x:.5g}' for x in self.to_place)}" if self.to_part else ""
        return f"{self.kind.replace('_', ' ')} {size} on {self.part} at {', '.join(f'{x:.5g}' for x in self.place)}{there}{along}"

    @property
    def where(self):
        """What it is and between what, whatever its amount."""
        return self.kind, self.name, tuple(self.place), tuple(self.to_place), tuple(self.direction)


@dataclass
class Trial:
    """What one set of changes leaves: modes that are unstable, the largest growth, 1/s, with its error and frequency."""
    changes: list
    unstable: int
    growth: float
    error: float
    freq: float

    @property
    def cost(self):
        return sum(change.cost for change in self.changes)


class Cure:
    """A result folder and the changes that are asked for."""

    def __init__(self, args):
        self.args, self.scene = args, Provenance(args.results / "scene.yaml")
        if self.scene.value("analysis", "modes") != "modes":
            raise BadInput(f"{args.results}: is of -analysis {self.scene.value('analysis')}; needed is a run of modes")
        modes = read_table(args.results / "modes.csv", MODES)
        self.growth = {row["mode"]: row["growth_rad_s"] for row in modes}
        self.value = {row["mode"]: complex(row["growth_rad_s"], TWO_PI * row["freq_hz"]) for row in modes}
        self.unstable = [row for row in modes if row["unstable"]]
        effects = args.results / "modes_effects.csv"
        if self.unstable and not effects.exists():
            raise BadInput(f"{effects}: no such file; a run of modes on a mesh with left vectors writes it")
        self.rows = [row for row in read_table(effects, EFFECTS) if self.is_wanted(row)] if self.unstable else []
        if self.unstable and not self.rows and not self.others():
            raise BadInput(f"{effects}: has no {', '.join(args.changes)}{' on ' + ', '.join(args.parts) if args.parts else ''}")

    def is_wanted(self, row):
        return row["change"] in self.args.changes and (
            not self.args.parts or (row["part"] in self.args.parts and (row["to_part"] or row["part"]) in self.args.parts))

    def change(self, like, amount):
        """One like another with another amount, in the units of the scene."""
        _, unit, easy, _ = KINDS[like.kind]
        size = amount * (self.scene.si(unit) if unit else 1.0) * easy
        return Change(like.kind, like.part, like.place, like.to_part, like.to_place, like.direction, amount, size,
                      abs(size) * self.args.price[like.kind], like.name)

    def of_row(self, row):
        """That of a row of modes_effects.csv."""
        like = Change(row["change"], row["part"], [row[f"{axis}_m"] for axis in "xyz"], row["to_part"],
                      [row[f"to_{axis}_m"] for axis in "xyz"] if row["to_part"] else [],
                      [row[f"direction_{axis}"] for axis in "xyz"], 0, 0, 0)
        return self.change(like, row["first_order_units_to_zero"])

    def others(self):
        """Layers over sets of the scene, of mass alone over rings of its disc, for a disc that turns has no springs to the ground, and
        percents of parameters; none where parts are chosen."""
        if self.args.parts:
            return []
        found = []
        for name in [*sets(self.scene), *rings(self.args.results, self.scene)]:
            for kind, directions in (("layer_mass", [[0, 0, 0]]), ("layer_spring", numpy.eye(3).tolist())):
                if "," in name and kind != "layer_mass":
                    continue
                if kind in self.args.changes or (kind == "layer_spring" and "layer_dashpot" in self.args.changes):
                    found += [self.change(Change(kind, "", [], "", [], direction, 0, 0, 0, name), 1.0) for direction in directions]
        if "parameter" in self.args.changes:
            found += [self.change(Change("parameter", "", [], "", [], [0, 0, 0], 0, 0, 0, name), 1.0) for name in self.strongest()]
        return found

    def candidates(self):
        """At nodes of each mode and kind the cheapest place, then the next, as many as leave room for the others."""
        places, others = {}, self.others()
        for row in self.rows:
            places.setdefault((row["mode"], row["change"]), []).append(self.of_row(row))
        for own in places.values():
            own.sort(key=lambda change: change.cost)
        found = {}
        for change in itertools.chain(*itertools.zip_longest(*places.values())):
            if change:
                found.setdefault(change.where, change)
        room = max(1, self.args.tries - len(others))
        return (list(found.values())[:room] + others)[:MOST_LOOKED_AT]

    def slopes(self):
        """Parameter -> unstable mode -> 1/s per percent; none without modes_sensitivities.csv."""
        path, found, modes = self.args.results / "modes_sensitivities.csv", {}, {row["mode"] for row in self.unstable}
        for row in read_table(path, {"mode": int, "parameter": str, "growth_rad_s_per_percent": float}) if path.exists() else []:
            if row["mode"] in modes:
                found.setdefault(row["parameter"], {})[row["mode"]] = row["growth_rad_s_per_percent"]
        return found

    def strongest(self):
        """Parameters in the order of what a percent does to unstable modes."""
        force = {name: max(abs(slope) / self.growth[mode] for mode, slope in own.items()) for name, own in self.slopes().items()}
        return [name for name in sorted(force, key=lambda name: -force[name]) if force[name] > 0][:self.args.parameters]

    def parameters(self):
        """Of each parameter the percent by which it would have to change for all unstable modes to stop, if the first order held, the
        smallest first."""
        found = {name: [-self.growth[mode] / slope for mode, slope in own.items()] for name, own in self.slopes().items()
                 if all(own.values())}
        return sorted(((max(own, key=abs), name) for name, own in found.items() if min(own) * max(own) > 0),
                      key=lambda entry: abs(entry[0]))

    def couplings(self, candidates):
        """Of each candidate the matrix of modes_couplings.csv, of an amount of one; the modes in its order."""
        made = self.run_squeal([[change] for change in candidates], "couplings", "-modes_couplings")
        with (self.args.output / "couplings/modes_couplings.csv").open(newline="", encoding="utf-8") as file:
            entries = [(row[0], int(row[1]), int(row[2]), complex(float(row[3]), float(row[4])))
                       for row in itertools.islice(csv.reader(file), 1, None)]
        present = sorted({entry[1] for entry in entries} | {entry[2] for entry in entries})
        index, found = {mode: i for i, mode in enumerate(present)}, {}
        for label, to, of, value in entries:
            found.setdefault(label, numpy.zeros((len(present), len(present)), complex))[index[to], index[of]] = value
        empty = numpy.zeros((len(present), len(present)), complex)
        return [found.get(label, empty) / change.amount for label, (change,) in made.items()], numpy.array([self.value[i] for i in present])

    def amounts(self, change, matrix, values):
        """Amounts to try of one candidate, in the units of the scene."""
        _, unit, easy, _ = KINDS[change.kind]
        most = self.args.most[change.kind] / easy / (self.scene.si(unit) if unit else 1.0)
        if change.kind == "parameter":
            return [sign * share * most for share in PERCENTS for sign in (1, -1)]
        grows = numpy.flatnonzero(values.real > self.limit(values))
        needed = [-values[i].real / matrix[i, i].real for i in grows if matrix[i, i].real < 0]
        return sorted({factor * one for one in needed for factor in FACTORS if factor * one <= most})

    def limit(self, values):
        """Growth that is no instability here, 1/s."""
        damping, growth = self.scene.number("modes_unstable_damping"), self.scene.number("modes_unstable_growth")
        return numpy.maximum(numpy.maximum(damping / 100, QUIET) * abs(values), growth)

    def left(self, matrices, values):
        """Growth beyond the limit, summed over the modes, of many matrices of couplings."""
        found = []
        for i in range(0, len(matrices), BLOCK):
            own = numpy.linalg.eigvals(numpy.diag(values) + numpy.array(matrices[i:i + BLOCK]))
            found += numpy.maximum(own.real - self.limit(own), 0).sum(axis=1).tolist()
        return found

    def singles(self):
        """Changes with their couplings, what they leave, and the eigenvalues of the run."""
        candidates, wide = self.candidates(), []
        if not candidates:
            raise BadInput("no change is small enough to stop a mode: raise --most")
        matrices, values = self.couplings(candidates)
        for like, matrix in zip(candidates, matrices):
            kinds = [(like, matrix)] if like.kind in self.args.changes else []
            if like.kind == "layer_spring" and "layer_dashpot" in self.args.changes:  # lambda times what a spring does
                dashpot = Change("layer_dashpot", "", [], "", [], like.direction, 0, 0, 0, like.name)
                kinds.append((dashpot, matrix * values[None, :]))
            for change, own in kinds:
                wide += [(self.change(change, amount), amount * own) for amount in self.amounts(change, own, values)]
        if not wide:
            raise BadInput("no change is small enough to stop a mode: raise --most")
        left = self.left([matrix for _, matrix in wide], values)
        found = [(change, matrix, rest) for (change, matrix), rest in zip(wide, left)]
        return sorted(found, key=lambda entry: (entry[2], entry[0].cost)), values

    def chosen(self, count):
        """The likeliest sets, those first that leave nothing and cost least."""
        singles, values = self.singles()
        found, places, few = [([change], rest) for change, _, rest in singles], {}, []
        for entry in singles:
            if places.setdefault(entry[0].where, 0) < ALIKE:
                few.append(entry)
            places[entry[0].where] += 1
        few = few[:SINGLES[len({change.where for change, _, rest in singles if not rest}) >= ENOUGH]]
        for size in (2, 3):
            if len({changes[0].where for changes, rest in found if not rest}) >= count:
                break
            own = [entries for entries in itertools.combinations(few if size == 2 else few[:len(few) // 3], size)
                   if len({change.where for change, _, _ in entries}) == size]
            left = self.left([sum(matrix for _, matrix, _ in entries) for entries in own], values)
            found += [([change for change, _, _ in entries], rest) for entries, rest in zip(own, left)]
        found.sort(key=lambda entry: (entry[1] > 0, entry[1] if entry[1] > 0 else 0, sum(change.cost for change in entry[0])))
        sets_of, kept, enough = {}, [], []
        for changes, rest in found:
            where = frozenset(change.where for change in changes)
            if sets_of.setdefault(where, 0) < ALIKE and not any(less < where for less in enough):
                kept.append(changes)
            sets_of[where] += 1
            if not rest:  # what is added to it only costs
                enough.append(where)
        return kept

    def run_squeal(self, trials, name, *more):
        """Runs squeal with sets of changes; label -> set."""
        folder = self.args.output / name
        folder.mkdir(parents=True, exist_ok=True)
        names, entries, made = {}, {}, {}
        for changes in trials:
            for n in range(1, len(changes) + 1):  # each is made with those before it
                key = tuple(id(change) for change in changes[:n])
                if key not in names:
                    names[key] = f"cure_{len(names) + 1}"
                    entries[names[key]] = changes[n - 1].options(names.get(key[:-1], ""))
            made[names[key]] = changes
        path = folder / "changes.yaml"
        path.write_text(f'modes_changes: "{",".join(entries)}"\n' + "".join(f"{key}: {text}\n" for key, text in entries.items()),
                        encoding="utf-8")
        words = ["-options_file", self.args.results / "scene.yaml", "-options_file", path, "-output_dir", folder, "-output_fields", "0",
                 "-modes_components_found", "false", "-modes_sensitivities", "false", *more]
        measured_run(self.args.program, self.args.ranks, [*words, *self.args.options], f"trial of {len(trials)} sets")
        return made

    def run(self, trials, name):
        """What sets leave, by a run of squeal."""
        made = self.run_squeal(trials, name)
        rows = read_table(self.args.output / name / "modes_changed.csv", CHANGED)
        return [self.judge(changes, [row for row in rows if row["change"] == label]) for label, changes in made.items()]

    def grows(self, row):
        """Whether a mode grows, or may: growth that its error hides is no calm."""
        omega = TWO_PI * row["freq_hz"]
        allowed = max(self.scene.number("modes_unstable_damping") / 100 * omega, self.scene.number("modes_unstable_growth"),
                      ROUNDING * omega)
        return row["state"] in ("unstable", "uncertain") or row["growth_rad_s"] > allowed

    def judge(self, changes, rows):
        """A set is a cure where no mode of the band is unstable."""
        worst = max(rows, key=lambda row: row["growth_rad_s"])
        count = sum(self.grows(row) for row in rows)
        return Trial(changes, count, worst["growth_rad_s"], TWO_PI * worst["error_hz"], worst["freq_hz"])

    def trials(self):
        """The likeliest sets, tried; the next ones where none of them calms all modes."""
        waiting, found = self.chosen(self.args.count), []
        for i in range(2):
            own = sorted(waiting[i * self.args.count:(i + 1) * self.args.count],
                         key=lambda changes: [(change.where, -abs(change.amount)) for change in changes])
            if own and not any(not trial.unstable for trial in found):
                found += self.run(own, f"tried_{i + 1}")
        return sorted(found, key=lambda trial: (trial.unstable, trial.cost if not trial.unstable else trial.growth))
