"""Masses, springs and dashpots that calm all unstable modes of a result folder: candidates from modes_effects.csv, tried by one or two
runs with -modes_changes."""

import itertools
from dataclasses import dataclass

from ..provenance import Provenance
from ..run.program import measured_run
from ..tables import BadInput, flag, quoted, read_table

MODES = {"mode": int, "freq_hz": float, "growth_rad_s": float, "unstable": flag}
EFFECTS = {"mode": int, "change": str, "part": str, **{f"direction_{axis}": float for axis in "xyz"},
           **{f"{axis}_m": float for axis in "xyz"}, "first_order_units_to_zero": float}
CHANGED = {"change": str, "mode": int, "freq_hz": float, "growth_rad_s": float, "error_hz": float, "state": str}
KINDS = {"mass": ("mass", "kg", 1e3, "g"), "spring": ("stiffness", "N/m", 1e-3, "N/mm"), "dashpot": ("viscosity", "N s/m", 1.0, "N s/m")}
FACTORS = 0.5, 1.0, 2.0, 4.0  # of the amount that would stop a mode if the first order held
PAIRED = 7  # single changes that are tried two by two: those that leave least
TWO_PI = 6.283185307179586


@dataclass
class Change:
    """One change: its option `amount` in the units of the scene, `size` in easy ones, and what that costs."""
    kind: str
    part: str
    place: list
    direction: list
    amount: float
    size: float
    cost: float

    def options(self, partner=""):
        """As an entry of an options file."""
        words = [f'at: "{",".join(f"{x:.15g}" for x in self.place)}"', f"part: {quoted(self.part)}",
                 f"{KINDS[self.kind][0]}: {self.amount:.6g}"]
        if any(self.direction):
            words.append(f'direction: "{",".join(f"{x:.9g}" for x in self.direction)}"')
        return "{" + ", ".join(words + ([f"with: {partner}"] if partner else [])) + "}"

    def words(self):
        """For people."""
        along = f" along {', '.join(f'{x + 0:.2f}' for x in self.direction)}" if any(self.direction) else ""
        return f"{self.kind} {self.size:.4g} {KINDS[self.kind][3]} on {self.part} at {', '.join(f'{x:.5g}' for x in self.place)}{along}"


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
        self.unstable = [row for row in read_table(args.results / "modes.csv", MODES) if row["unstable"]]
        effects = args.results / "modes_effects.csv"
        if self.unstable and not effects.exists():
            raise BadInput(f"{effects}: no such file; a run of modes on a mesh with left vectors writes it")
        self.rows = [row for row in read_table(effects, EFFECTS) if self.is_wanted(row)] if self.unstable else []
        if self.unstable and not self.rows:
            raise BadInput(f"{effects}: has no {', '.join(args.changes)}{' on ' + ', '.join(args.parts) if args.parts else ''}")

    def is_wanted(self, row):
        return row["change"] in self.args.changes and (not self.args.parts or row["part"] in self.args.parts)

    def candidates(self):
        """The cheapest changes, several amounts at each place."""
        found = {}
        for row, factor in itertools.product(self.rows, FACTORS):
            _, unit, easy, _ = KINDS[row["change"]]
            amount = factor * row["first_order_units_to_zero"]
            size = amount * self.scene.si(unit) * easy
            if not 0 < size <= self.args.most[row["change"]]:
                continue
            change = Change(row["change"], row["part"], [row[f"{axis}_m"] for axis in "xyz"],
                            [row[f"direction_{axis}"] for axis in "xyz"], amount, size, size * self.args.price[row["change"]])
            found.setdefault((change.kind, tuple(change.place), f"{amount:.6g}"), change)
        return sorted(found.values(), key=lambda change: change.cost)[:self.args.tries]

    def run(self, sets, name):
        """The trials of sets of one change or two, by one run of squeal."""
        folder = self.args.output / name
        folder.mkdir(parents=True, exist_ok=True)
        singles = list({id(change): change for changes in sets for change in changes}.values())
        names = {id(change): f"cure_{i + 1}" for i, change in enumerate(singles)}
        entries = {names[id(change)]: change.options() for change in singles}
        made = {}
        for i, changes in enumerate(sets):
            if len(changes) == 1:
                made[names[id(changes[0])]] = changes
            else:
                label = f"cure_pair_{i + 1}"
                entries[label] = changes[1].options(names[id(changes[0])])
                made[label] = changes
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
        worst = max(rows, key=lambda row: row["growth_rad_s"])
        return Trial(changes, sum(row["state"] == "unstable" for row in rows), worst["growth_rad_s"], TWO_PI * worst["error_hz"],
                     worst["freq_hz"])

    def trials(self):
        """Single changes, then pairs of those that leave least where too few of them do."""
        singles = self.candidates()
        if not singles:
            raise BadInput("no change is small enough to stop a mode: raise --most")
        found = self.run([[change] for change in singles], "single")
        if len(singles) > 1 and sum(not trial.unstable for trial in found) < self.args.count:
            best = {}
            for trial in sorted((trial for trial in found if trial.unstable), key=lambda trial: (trial.unstable, trial.growth)):
                best.setdefault((trial.changes[0].kind, tuple(trial.changes[0].place)), trial.changes[0])
            pairs = [list(pair) for pair in itertools.combinations(list(best.values())[:PAIRED], 2)]
            found += self.run(pairs, "pairs") if pairs else []
        return sorted(found, key=lambda trial: (trial.unstable, trial.cost if not trial.unstable else trial.growth))
