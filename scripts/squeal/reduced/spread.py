"""Part `spread` of study/reduced: how far a motion that bounces is determined, and what in it is an error of the reduced form."""

import re
from typing import NamedTuple

import numpy

from ..run.program import ROOT, print_demand
from ..tables import BadInput, print_row
from ..transient.cycle import detached_share
from ..transient.history import Run
from ..transient.study import SETS, run

SCENE = ROOT / "options/small_brake_map.yaml"
OPTIONS = f"-analysis transient -ts_max_time 50e-3 -press_ramp 2e-3 -tap_time 1e-3 -dynamics_live 0 {SETS['20/80']}"
FRICTION = 0.499, 0.4995, 0.5, 0.5005, 0.501
BAND = "2500,15000"  # Hz, of the unstable modes
STEP = 2e-6  # s, of the reduced runs
CUTOFFS = 20e3, 60e3  # Hz
WINDOWS = (7.5e-3, 15e-3), (15e-3, 25e-3), (25e-3, 50e-3), (40e-3, 50e-3)  # s
DETERMINED = 2  # of them, in which the motion still is that of its start
LIMIT = 0.03  # of the rms of the force
IMPACT = 0.03  # work lost when pairs close, of that of damping, at most


class Window(NamedTuple):
    """What a motion does between two times: rms of the normal force (N), share without it, power of damping and of contact (W)."""

    rms: float
    detached: float
    damping: float
    contact: float


def window_of(table, begin, end):
    """The numbers of a window."""
    inside = (table.time >= begin) & (table.time < end)
    force, time = table.normal[inside], table.time[inside]
    powers = (float(numpy.ptp(table.columns[name][inside][[0, -1]])) / (time[-1] - time[0])
              for name in ("damping_work_j", "contact_work_j"))
    return Window(float(force.std()), detached_share(force), *powers)


def made(args, friction, cutoff):
    """A kept run: on the mesh, or reduced where there is a cut-off."""
    name = f"spread-{friction:g}" + (f"-{cutoff:g}Hz" if cutoff else "")
    options = f"{OPTIONS} -contact_mu {friction:g}"
    if cutoff:
        options += (f" -dynamics_model reduced -dynamics_cutoff {cutoff:g} -ts_dt {STEP:g} -dynamics_view"
                    f" -modes_band {BAND} -dynamics_compare {'true' if friction == 0.5 else 'false'}")
    else:
        options += " -dynamics_model full"
    return run(args.program, args.ranks, args.runs.parent / f"reduced/{name}", options, SCENE)


def growth_error(folder):
    """What the reduction does to the growth of the unstable modes, as the run says, percent."""
    found = re.search(r"growth of unstable modes: reduced off by (\S+) %", (folder / "log.txt").read_text(encoding="utf-8"))
    if not found:
        raise BadInput(f"{folder}: does not say how far growth is off")
    return float(found.group(1))


def beside(mesh, own):
    """Relative difference of the means of two lists, and its standard error."""
    error = numpy.hypot(*(numpy.std(values, ddof=1) / len(values) ** 0.5 for values in (mesh, own)))
    return float(numpy.mean(own) / numpy.mean(mesh) - 1), float(error / numpy.mean(mesh))


def lost(windows):
    """Work lost when pairs close, of that of damping."""
    return sum(window.contact for window in windows) / sum(window.damping for window in windows)


def print_windows(runs):
    """A row for each window and model; the largest difference of the highest cut-off to the mesh while the motion is determined."""
    worst = 0.0
    print_row("time, ms", "model", "rms of the force, N", "spread of one run, N", "without contact", "lost to impacts, of damping",
              "rms beside the mesh, %")
    print_row("---", "---", "--:", "--:", "--:", "--:", "--:")
    for k, (begin, end) in enumerate(WINDOWS):
        mesh = [windows[k].rms for windows in runs["mesh"]]
        for name, own in runs.items():
            here = [windows[k] for windows in own]
            rms = [window.rms for window in here]
            difference, error = beside(mesh, rms)
            if name == list(runs)[-1] and k < DETERMINED:
                worst = max(worst, abs(difference))
            print_row(f"{1e3 * begin:g} to {1e3 * end:g}", name, f"{numpy.mean(rms):.1f}", f"{numpy.std(rms, ddof=1):.1f}",
                      f"{numpy.mean([window.detached for window in here]):.3f}", f"{lost(here):.4f}",
                      "" if name == "mesh" else f"{100 * difference:+.1f} +- {100 * error:.1f}")
    return worst


def part_spread(args):
    """Runs at several friction coefficients."""
    print(f"\n{SCENE.name} as rows 20/80, friction {FRICTION[0]:g} to {FRICTION[-1]:g}, {len(FRICTION)} runs each\n")
    runs = {}
    for cutoff in (None, *CUTOFFS):
        folders = [made(args, friction, cutoff) for friction in FRICTION]
        name = f"{1e-3 * cutoff:g} kHz" if cutoff else "mesh"
        runs[name] = [[window_of(table, *window) for window in WINDOWS] for table in map(Run, folders)]
        if cutoff:
            print(f"{name}: growth of unstable modes off by {growth_error(folders[FRICTION.index(0.5)]):g} %")
    print()
    worst = print_windows(runs)
    impacts = max(lost([windows[k] for windows in runs["mesh"]]) for k in range(len(WINDOWS)))
    print()
    print_demand(f"rms of {1e-3 * CUTOFFS[-1]:g} kHz beside the mesh to {1e3 * WINDOWS[DETERMINED - 1][1]:g} ms", worst, LIMIT, ".4f")
    print_demand("lost to impacts on the mesh, of damping", impacts, IMPACT, ".4f")
    args.kept = args.kept and worst <= LIMIT and impacts <= IMPACT
