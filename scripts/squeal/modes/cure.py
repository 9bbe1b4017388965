"""Masses, springs and dashpots that calm all unstable modes of a result folder: candidates from modes_effects.csv, tried by one or two
runs with -modes_changes."""

import itertools
from dataclasses import dataclass

from ..provenance import Provenance
from ..run.program import measured_run
from ..tables import BadInput, flag, optional, quoted, read_table

MODES = {"mode": int, "freq_hz": float, "growth_rad_s": float, "unstable": flag}
EFFECTS = {"mode": int, "change": str, "part": str, **{f"direction_{axis}": float for axis in "xyz"},
           **{f"{axis}_m": float for axis in "xyz"}, "first_order_units_to_zero": float,
           "to_part": str, **{f"to_{axis}_m": optional for axis in "xyz"}}
CHANGED = {"change": str, "mode": int, "freq_hz": float, "growth_rad_s": float, "error_hz": float, "state": str, "before": int}
STIFF, VISCOUS = ("stiffness", "N/m", 1e-3, "N/mm"), ("viscosity", "N s/m", 1.0, "N s/m")
KINDS = {"mass": ("mass", "kg", 1e3, "g"), "spring": STIFF, "dashpot": VISCOUS, "relative_spring": STIFF, "relative_dashpot": VISCOUS}
FACTORS = 1.0, 2.0, 4.0, 0.5  # of the amount that would stop a mode if the first order held, the likeliest first
MOST_CHANGES = 42  # of a run: each has up to eight options, of which PETSc 3.18 takes 512
SEVERAL = 20  # sets of two that are tried, and of three
TWO_PI = 6.283185307179586


@dataclass
class Change:
    """One change: its option `amount` in the units of the scene, `size` in easy ones, and what that costs; to_part is empty for the
    ground."""
    kind: str
    part: str
    place: list
    to_part: str
    to_place: list
    direction: list
    amount: float
    size: float
    cost: float

    def options(self, partner=""):
        """As an entry of an options file."""
        words = [f'at: "{",".join(f"{x:.15g}" for x in self.place)}"', f"part: {quoted(self.part)}",
                 f"{KINDS[self.kind][0]}: {self.amount:.6g}"]
        if self.to_part:
            words += [f'to: "{",".join(f"{x:.15g}" for x in self.to_place)}"', f"to_part: {quoted(self.to_part)}"]
        if any(self.direction):
            words.append(f'direction: "{",".join(f"{x:.9g}" for x in self.direction)}"')
        return "{" + ", ".join(words + ([f"with: {partner}"] if partner else [])) + "}"

    def words(self):
        """For people."""
        along = f" along {', '.join(f'{x + 0:.2f}' for x in self.direction)}" if any(self.direction) else ""
        there = f" to {self.to_part} at {', '.join(f'{x:.5g}' for x in self.to_place)}" if self.to_part else ""
        return (f"{self.kind.replace('_', ' ')} {self.size:.4g} {KINDS[self.kind][3]} on {self.part} at "
                f"{', '.join(f'{x:.5g}' for x in self.place)}{there}{along}")

    @property
    def where(self):
        """What it is and between what, whatever its amount."""
        return self.kind, tuple(self.place), tuple(self.to_place)


@dataclass
class Trial:
    """What one set of changes leaves: modes that are unstable, the largest growth, 1/s, with its error and frequency; the largest growth
    of those that each mode of the run has become."""
    changes: list
    unstable: int
    growth: float
    error: float
    freq: float
    became: dict

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
        self.unstable = [row for row in modes if row["unstable"]]
        effects = args.results / "modes_effects.csv"
        if self.unstable and not effects.exists():
            raise BadInput(f"{effects}: no such file; a run of modes on a mesh with left vectors writes it")
        self.rows = [row for row in read_table(effects, EFFECTS) if self.is_wanted(row)] if self.unstable else []
        if self.unstable and not self.rows:
            raise BadInput(f"{effects}: has no {', '.join(args.changes)}{' on ' + ', '.join(args.parts) if args.parts else ''}")

    def is_wanted(self, row):
        return row["change"] in self.args.changes and (
            not self.args.parts or (row["part"] in self.args.parts and (row["to_part"] or row["part"]) in self.args.parts))

    def change(self, row, factor):
        """A row of modes_effects.csv with so many times the amount that would stop its mode."""
        _, unit, easy, _ = KINDS[row["change"]]
        amount = factor * row["first_order_units_to_zero"]
        size = amount * self.scene.si(unit) * easy
        return Change(row["change"], row["part"], [row[f"{axis}_m"] for axis in "xyz"], row["to_part"],
                      [row[f"to_{axis}_m"] for axis in "xyz"] if row["to_part"] else [], [row[f"direction_{axis}"] for axis in "xyz"],
                      amount, size, size * self.args.price[row["change"]])

    def candidates(self):
        """The likeliest changes: of each mode and kind the cheapest place with the first amount, then with the next amount, or the next
        place with the first one, and so on."""
        places, waiting, found = {}, [], {}
        for row in self.rows:
            places.setdefault((row["mode"], row["change"]), []).append(row)
        for own in places.values():
            own.sort(key=lambda row: row["first_order_units_to_zero"])
            waiting += [(i + j, self.change(row, factor)) for i, row in enumerate(own) for j, factor in enumerate(FACTORS)]
        for _, change in sorted(waiting, key=lambda pair: (pair[0], pair[1].cost)):
            if 0 < change.size <= self.args.most[change.kind]:
                found.setdefault((*change.where, f"{change.amount:.6g}"), change)
        # those of one place follow each other: the program has its answer to a force there by then
        return sorted(list(found.values())[:self.args.tries], key=lambda change: (*change.where, change.cost))

    def likeliest(self, singles, count):
        """Sets of `count` single changes whose shifts of each mode's growth, added up, leave least, then the cheapest."""
        left = {}
        for trials in itertools.combinations(singles, count):
            if len({trial.changes[0].where for trial in trials}) < count:
                continue
            growth = [before + sum(trial.became.get(mode, before) - before for trial in trials) for mode, before in self.growth.items()]
            changes = [trial.changes[0] for trial in trials]
            left[tuple(id(change) for change in changes)] = (sum(value for value in growth if value > 0),
                                                             sum(change.cost for change in changes), changes)
        return [changes for _, _, changes in sorted(left.values(), key=lambda entry: entry[:2])[:SEVERAL]]

    def run(self, sets, name):
        """The trials of sets of changes, by as many runs of squeal as its number of options asks for."""
        most = max(1, MOST_CHANGES // max(map(len, sets)))
        runs = [sets[i:i + most] for i in range(0, len(sets), most)]
        return [trial for i, own in enumerate(runs) for trial in self.run_once(own, f"{name}_{i + 1}" if i else name)]

    def run_once(self, sets, name):
        """The same by one run."""
        folder = self.args.output / name
        folder.mkdir(parents=True, exist_ok=True)
        names, entries, made = {}, {}, {}
        for changes in sets:
            for n in range(1, len(changes) + 1):  # each is made with those before it
                key = tuple(id(change) for change in changes[:n])
                if key not in names:
                    names[key] = f"cure_{len(names) + 1}"
                    entries[names[key]] = changes[n - 1].options(names.get(key[:-1], ""))
            made[names[key]] = changes
        path = folder / "changes.yaml"
        path.write_text(f'modes_changes: "{",".join(entries)}"\n' + "".join(f"{key}: {text}\n" for key, text in entries.items()),
                        encoding="utf-8")
        words = ["-options_file", self.args.results / "scene.yaml", "-options_file", path, "-output_dir", folder, "-output_fields", "0"]
        measured_run(self.args.program, self.args.ranks, [*words, *self.args.options], f"trial of {len(sets)} sets")
        rows = read_table(folder / "modes_changed.csv", CHANGED)
        return [self.judge(changes, [row for row in rows if row["change"] == label]) for label, changes in made.items()]

    @staticmethod
    def judge(changes, rows):
        """A set is a cure where no mode of the band is unstable."""
        worst, became = max(rows, key=lambda row: row["growth_rad_s"]), {}
        for row in rows:
            became[row["before"]] = max(row["growth_rad_s"], became.get(row["before"], row["growth_rad_s"]))
        count = sum(row["state"] in ("unstable", "uncertain") for row in rows)
        return Trial(changes, count, worst["growth_rad_s"], TWO_PI * worst["error_hz"],
                     worst["freq_hz"], became)

    def parameters(self):
        """Of each parameter the percent by which it would have to change for all unstable modes to stop, if the first order held, the
        smallest first; none without modes_sensitivities.csv."""
        path, slopes, modes = self.args.results / "modes_sensitivities.csv", {}, {row["mode"] for row in self.unstable}
        if not path.exists():
            return []
        for row in read_table(path, {"mode": int, "parameter": str, "growth_rad_s_per_percent": float}):
            if row["mode"] in modes:
                slopes.setdefault(row["parameter"], []).append((self.growth[row["mode"]], row["growth_rad_s_per_percent"]))
        found = {name: [-growth / slope for growth, slope in own] for name, own in slopes.items() if all(slope for _, slope in own)}
        return sorted(((max(own, key=abs), name) for name, own in found.items() if min(own) * max(own) > 0),
                      key=lambda entry: abs(entry[0]))

    def trials(self):
        """Single changes, then sets of two where too few of them do, then of three where none does."""
        singles = self.candidates()
        if not singles:
            raise BadInput("no change is small enough to stop a mode: raise --most")
        tried = found = self.run([[change] for change in singles], "single")
        for count, name, enough in ((2, "pairs", self.args.count), (3, "triples", 1)):
            sets = self.likeliest(tried, count) if sum(not trial.unstable for trial in found) < enough else []
            found = found + (self.run(sets, name) if sets else [])
        return sorted(found, key=lambda trial: (trial.unstable, trial.cost if not trial.unstable else trial.growth))
