"""Part `million` of bench/modes: the default brake on four meshes of up to a million unknowns, on two ranks: factors, solves and
memory as powers of the number of unknowns."""

import numpy

from ..run.program import print_demand
from ..tables import print_table
from ..run.timed_runs import SOLVES

BAND = "-modes_band 1000,6000"
RANKS = 2
MOST_GB = 24
NUMERIC = ("MatCholFctrNum", "MatLUFactorNum")


def quantities(run):
    """What grows, by name."""
    return {"modes": len(run.modes),
            "factor entries, M": run.entries / 1e6,
            "one numeric factorisation, s": run.seconds(*NUMERIC, stage="Modes") / run.count(*NUMERIC, stage="Modes"),
            "numeric factorisations": run.count(*NUMERIC, stage="Modes"),
            "one right-hand side, ms": 1e3 * run.seconds(*SOLVES) / run.n_solves,
            "right-hand sides": run.n_solves,
            "set-up, s": sum(run.seconds("summary", stage=s) for s in ("Model", "Contact", "Operators")),
            "results, s": run.seconds("summary", stage="Results"),
            "whole process, s": run.wall,
            "processors, s": run.cpu,
            "most memory, MB": run.last(r"the most at any time +(\d+)")}


def part_million(measure, meshes):
    """Meshes in words of options, the last of which has a million unknowns."""
    runs = [measure(ranks=RANKS, options=f"{mesh} {BAND}") for mesh in meshes]
    columns = [quantities(run) for run in runs]
    size = numpy.log([run.unknowns for run in runs])
    rows = []
    for name in columns[0]:
        values = [column[name] for column in columns]
        power = f"{numpy.polyfit(size, numpy.log(values), 1)[0]:.2f}" if min(values) > 0 else ""
        rows.append((name, *(f"{v:.2f}" if isinstance(v, float) else str(v) for v in values), power))
    print_table(f"1 to 6 kHz with left vectors, {RANKS} ranks, and as a power of the number of unknowns",
                ("unknowns", *(str(run.unknowns) for run in runs), "power"), *rows)
    print_demand("memory of the largest, GB", columns[-1]["most memory, MB"] / 1000, MOST_GB, ".1f")
