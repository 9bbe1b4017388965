"""Random maps of a small brake with different rounding: what `scripts/study/map_rounding` runs, and how it judges rows."""

import csv
import math
import random
from typing import NamedTuple

from ..run.program import ROOT, measured
from ..tables import BadInput

SCENE = ROOT / "options/small_brake_map.yaml"
GALLERY = "gallery"
VIBRATES = {"cycle", "sticking", "growth", "quasi_periodic"}
CHANCE, STABLE = "bistable", "stable"
MOVED = 1e-3  # relative


class Judged(NamedTuple):
    """Pairs of rows of two runs that were compared: how many; of these both vibrate; rounding moves the rms by MOVED; the rms is beyond
    the error of the first; so is the frequency; the regime is none of those of the other; one says bistable and the other neither does
    nor lists two regimes."""
    pairs: int = 0
    loud: int = 0
    moved: int = 0
    beyond: int = 0
    line: int = 0
    regime: int = 0
    chance: int = 0

    def __add__(self, other):
        return Judged(*(a + b for a, b in zip(self, other)))


def words(name):
    """Options of a map: of the gallery, or drawn: three values of friction up and down at one force."""
    if name == GALLERY:
        return []
    draw = random.Random(f"map {name}")
    pad, disc = draw.choice((2, 3, 4)), (draw.choice((7, 8, 9)), draw.choice((20, 24, 28)))
    low = draw.uniform(0.15, 0.35)
    options = {"rig_disc_elements": f"{disc[0]},{disc[1]},1", "rig_pad_elements": f"{pad},{pad},{draw.choice((1, 2))}",
               "rig_beam_rows": draw.choice(("0.0235,0.086", "0.02,0.08", "0.03,0.07", "0.018,0.0792")),
               "pad_young": f"{draw.uniform(1.2e10, 6e10):.5g}", "pad_alpha": f"{draw.uniform(20, 200):.4g}",
               "disc_alpha": f"{draw.uniform(20, 200):.4g}", "contact_speed": draw.choice(("0.2", "0.5", "2")),
               "tap_impulse": f"0,0,{-10 ** draw.uniform(-4.3, -3.3):.4g}", "dynamics_cutoff": draw.choice(("9e3", "12e3", "20e3")),
               "map_values": f"{low:.3f}:{low + draw.uniform(0.2, 0.4):.3f}:3", "map_values_2": f"{draw.uniform(30, 250):.4g}"}
    return [word for key, value in options.items() for word in (f"-{key}", value)]


def rows_of(args, name, ranks, core):
    """Rows of map.csv of a run, and s of processor; kept where the run is there."""
    folder = args.output / f"{name}-{ranks}-{core}"
    seconds = 0.0
    if not (folder / "map.csv").exists():
        command = ["env", f"OPENBLAS_CORETYPE={core}", ROOT / "scripts/mpirun", "-n", ranks, args.program, "-options_file", SCENE,
                   *words(name), "-output_fields", "0", "-output_dir", folder]
        _, seconds, _ = measured(command, f"map {name} on {ranks} ranks, {core}")
    with (folder / "map.csv").open(newline="") as file:
        return list(csv.DictReader(file)), seconds


def lists_both(row):
    """Whether a row says that it may vibrate and may not."""
    regimes = set(row["regimes"].split("+"))
    return STABLE in regimes and bool(VIBRATES & regimes)


def judge(one, other):
    """Of a row and the same of another run."""
    if one["direction"] != other["direction"] or one["value"] != other["value"]:
        raise BadInput("maps of one scene have other rows")
    chance = CHANCE in (one["regime"], other["regime"])
    loud = not chance and one["regime"] in VIBRATES and other["regime"] in VIBRATES
    off = {name: abs(float(one[name]) - float(other[name])) for name in ("force_rms_n", "freq_hz")}
    error = float(one["error_estimate"]) * float(one["force_rms_n"])
    moved = loud and off["force_rms_n"] > MOVED * float(one["force_rms_n"])
    return Judged(1, loud, moved, loud and not off["force_rms_n"] <= error, loud and off["freq_hz"] > float(one["freq_error_hz"]),
                  not chance and other["regime"] not in one["regimes"].split("+"),
                  chance and one["regime"] != other["regime"] and not (lists_both(one) and lists_both(other)))


def judge_map(args, name):
    """All pairs of runs of a map, each row as the first and as the second; the number of rows, of bistable ones, the processor time."""
    runs = [(ranks, core) for ranks in args.ranks for core in args.cores]
    found = [rows_of(args, name, *run) for run in runs]
    tables, seconds = [rows for rows, _ in found], sum(seconds for _, seconds in found)
    total = sum((judge(a, b) for i, one in enumerate(tables) for k, other in enumerate(tables) if i != k
                 for a, b in zip(one, other, strict=True)), Judged())
    rows = [row for table in tables for row in table]
    errors = [float(row["error_estimate"]) for row in rows if row["regime"] in VIBRATES]
    return total, len(rows), sum(row["regime"] == CHANCE for row in rows), errors, seconds


def share(part, whole):
    """In words."""
    return f"{100 * part / whole:.3g} %" if whole else "-"


def study(args):
    """Prints a line a map and the sum; whether what is asked for is met."""
    total, rows, chance, errors = Judged(), 0, 0, []
    names = ([GALLERY] if args.gallery else []) + list(range(args.first, args.first + args.count))
    for name in names:
        found, n, n_chance, stated, seconds = judge_map(args, name)
        total, rows, chance, errors = total + found, rows + n, chance + n_chance, errors + stated
        print(f"map {name}: {n} rows, {n_chance} bistable; {found.pairs} pairs: {found.loud} both vibrate, "
              f"{found.moved} moved, rms beyond its error in {found.beyond}, frequency in {found.line}; another regime {found.regime}; "
              f"bistable in one, one regime in the other {found.chance} "
              f"({seconds:.0f} s)", flush=True)
    missed = total.beyond + total.regime
    errors.sort()
    print(f"{len(names)} maps, {rows} rows, {chance} bistable; of {total.pairs} pairs of runs of a row {total.pairs - missed} "
          f"({share(total.pairs - missed, total.pairs)}) are inside the error of the first, or named bistable in one; of the {total.loud} "
          f"that both vibrate {share(total.loud - total.beyond, total.loud)}, of the {total.moved} of these that rounding moves by "
          f"{MOVED:g} {share(total.moved - total.beyond, total.moved)}; bistable in one, one regime in the other: "
          f"{share(total.chance, total.pairs)}; stated error, median {errors[len(errors) // 2] if errors else math.nan:.2g}")
    return missed + total.chance <= 0.05 * total.pairs and total.beyond <= 0.05 * total.moved
