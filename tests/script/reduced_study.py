#!/usr/bin/env python3
"""What scripts/study/reduced says of two made-up transients: the differences of frequency, rms and detached share that were
put in, and the correlation of a growth phase in which one line runs away from the other; numbers of a window and of several
runs. Breaks when a difference is taken of other parts of the runs, when the correlation is that of the cycle, or when what
is missed counts as met."""

import math
import sys
import tempfile
from pathlib import Path

import numpy

sys.path[:0] = [str(Path(__file__).resolve().parent), str(Path(__file__).resolve().parents[2] / "scripts")]
import made_up_transient
from squeal.reduced.cycles import demands_of
from squeal.reduced.spread import Window, beside, lost, window_of
from squeal.transient.history import Run

FREQUENCY = made_up_transient.FREQUENCY


def written(folder, name, shift, depth):
    """Folder of a run whose line is off by a part `shift`; its forces after saturation."""
    made_up_transient.FREQUENCY = FREQUENCY * (1 + shift)
    made = made_up_transient.Transient(end=0.04, step=2e-6, depth=depth)
    columns = made.table("edge")
    columns["face_vz_m_s"] = columns["edge_vy_m_s"]
    made_up_transient.write_table(Path(folder) / name, columns)
    return Path(folder) / name, made


def check(name, good, faults):
    print("ok  " if good else "FAIL", name)
    faults.append(not good)


def main():
    faults = []
    with tempfile.TemporaryDirectory() as folder:
        one, _ = written(folder, "one", 0, 1.2)
        other, _ = written(folder, "other", 1e-3, 1.3)
        same = list(demands_of("same", (one, one)))
        apart = {row.quantity.split()[0]: row for row in demands_of("apart", (one, other))}
        late = window_of(Run(one), 0.03, 0.04)
    check("a run beside itself keeps all demands", all(row.kept for row in same) and len(same) == 5, faults)
    check("the same regime", apart["regime"].full == apart["regime"].reduced == "limit cycle", faults)
    check("frequency", abs(apart["frequency"].difference - 1e-3) < 1e-4 and apart["frequency"].kept, faults)
    share = [math.acos(1 / depth) / math.pi for depth in (1.2, 1.3)]
    check("detached share", abs(apart["detached"].difference - (share[1] - share[0])) < 2e-3, faults)
    check("which is missed above two points", apart["detached"].kept == (share[1] - share[0] < 0.02), faults)
    phase = numpy.linspace(0, 2 * numpy.pi, 100001)
    rms = [numpy.maximum(0, 1 + depth * numpy.sin(phase)).std() for depth in (1.2, 1.3)]
    check("rms and share of a window alone", abs(late.rms / apart["rms"].full - 1) < 5e-3 and
          abs(late.detached - share[0]) < 5e-3, faults)
    difference, error = beside([1, 3], [2, 4])
    check("means of several runs, and the standard error of their difference", abs(difference - 0.5) < 1e-12 and
          abs(error - math.sqrt(0.5)) < 1e-12, faults)
    check("what impacts take", abs(lost([Window(0, 0, 3, 1), Window(0, 0, 5, 1)]) - 0.25) < 1e-12, faults)
    check("rms", abs(apart["rms"].difference - (rms[1] / rms[0] - 1)) < 2e-3, faults)
    check("correlation of what runs away is missed", not apart["correlation"].kept and apart["correlation"].difference < 0.97,
          faults)
    return sum(faults)


if __name__ == "__main__":
    sys.exit(main())
