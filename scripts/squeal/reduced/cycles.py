"""Part `cycles` of study/reduced: the reduced model in time beside the mesh, on the paper's brake."""

import csv
from typing import NamedTuple

import numpy

from ..run.program import met
from ..tables import BadInput, print_row
from ..transient.cycle import detached_share
from ..transient.study import SCENE, SETS, case_run, correlation, run, vibration_of

CASES = (("23.5/86", 16), ("23.5/86", 25.1), ("23.5/86", 39.8), ("20/80", 25.1))  # rows of springs, mm; pad, GPa
SNAPSHOTS = "-dynamics_snapshot_interval 0.5e-3"  # so that the runs on the mesh are those of study/transient
PIECE = 3e-3  # s of the growth phase that are correlated at once
SIGNALS = "normal_force_n", "edge_vy_m_s", "face_vz_m_s"
LIMITS = {"frequency": 3e-3, "rms": 0.03, "detached": 0.02, "correlation": 0.99}


class Demand(NamedTuple):
    """A row of the CSV: what both runs have, their difference, and what it may be (None: nothing is asked)."""

    scene: str
    quantity: str
    full: object
    reduced: object
    difference: object
    limit: float | None
    kept: bool


def full_run(args, name, young):
    """Folder of the run on the mesh."""
    kind = "" if name == "23.5/86" else name.replace("/", "-") + "-"
    return case_run(args, young, kind, f"{SNAPSHOTS} {SETS[name]}".strip())


def reduced_run(args, name, young):
    """Folder of the reduced run."""
    folder = args.runs.parent / f"reduced/{name.replace('/', '-')}-{young:g}GPa-{args.cutoff:g}Hz-{args.step:g}s"
    return run(args.program, args.ranks, folder,
               f"-pad_young {young}e9 -dynamics_live 0 {SETS[name]} -dynamics_model reduced -dynamics_cutoff "
               f"{args.cutoff:g} -dynamics_compare false -squeal_view" + (f" -ts_dt {args.step:g}" if args.step else ""))


def growth_phase(vibration):
    """Beginning and end of the window of growth or decay, s."""
    if not vibration.window:
        raise BadInput("the run on the mesh neither grows nor decays")
    return vibration.window


def worst_correlation(full, reduced, window):
    """The least correlation of a signal in a piece of the window, and which signal that is."""
    edges = numpy.arange(window[0], window[1] - PIECE / 2, PIECE)
    worst = 1.0, SIGNALS[0]
    for begin, name in ((edge, name) for edge in edges for name in SIGNALS):
        chosen = (reduced.time >= begin) & (reduced.time < begin + PIECE)
        mesh = numpy.interp(reduced.time[chosen], full.time, full.columns[name])
        worst = min(worst, (correlation(mesh, reduced.columns[name][chosen]), name))
    return worst


def both_late(tables, vibrations):
    """The parts of two runs after both have saturated, or their second halves."""
    begin = max(table.time[vibration.steady][0] for table, vibration in zip(tables, vibrations))
    return [table.normal[table.time >= begin] for table in tables]


def demands_of(scene, folders):
    """All rows of a scene."""
    tables, vibrations = zip(*map(vibration_of, folders))
    regimes = [vibration.regime() for vibration in vibrations]
    yield Demand(scene, "regime", *regimes, "", None, regimes[0] == regimes[1])
    worst, name = worst_correlation(*tables, growth_phase(vibrations[0]))
    yield Demand(scene, f"correlation ({name})", "", "", worst, LIMITS["correlation"], worst > LIMITS["correlation"])
    cycles = any(vibration.saturated() for vibration in vibrations)
    forces = both_late(tables, vibrations)
    for quantity, values, relative in (
            ("frequency", [vibration.line[0] for vibration in vibrations], True),
            ("rms", [force.std() for force in forces], True),
            ("detached", [detached_share(force) for force in forces], False)):
        difference = values[1] - values[0]
        difference /= values[0] if relative else 1
        limit = LIMITS[quantity] if cycles else None
        yield Demand(scene, quantity, *values, difference, limit, not cycles or abs(difference) <= limit)


def text(value):
    """A cell."""
    return value if isinstance(value, str) else f"{value:.6g}"


def part_cycles(args):
    """One full and one reduced run a scene."""
    rows = []
    for name, young in CASES:
        if args.scene and f"{name} {young:g}" not in args.scene:
            continue
        scene = f"{name} {young:g} GPa"
        folders = full_run(args, name, young), reduced_run(args, name, young)
        rows += demands_of(scene, folders)
    step = f"steps of {args.step:g} s" if args.step else "its own step"
    print(f"\n{SCENE.name}, 50 ms: the mesh beside modes below {args.cutoff:g} Hz, {step}\n")
    print_row("rows of springs, pad", "", "mesh", "reduced", "difference", "asked", "")
    print_row("---", "---", "--:", "--:", "--:", "--:", "---")
    for row in rows:
        print_row(row.scene, row.quantity, text(row.full), text(row.reduced), text(row.difference),
                  "" if row.limit is None else f"{row.limit:g}", met(row.kept))
    write_rows(args.csv, rows)
    args.kept = args.kept and all(row.kept for row in rows)


def write_rows(path, rows):
    """The CSV."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(Demand._fields)
            writer.writerows([*map(text, row[:5]), "" if row.limit is None else row.limit, met(row.kept)]
                             for row in rows)
    except OSError as error:
        raise BadInput(f"cannot write {path}: {error.strerror}") from None
    print(f"\n{path}")
