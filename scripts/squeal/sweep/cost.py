"""Part `cost` of study/sweep: time and error of the reduced sweep, of the projection on real modes, and of every
value in full, in units of one full solve."""

import math
import statistics

from ..run.program import met
from .runs import DEFAULT, PAIRED, SweepRun, compare, require_same_sweep, with_values
from ..tables import print_table
from ..run.timed_runs import Run, require_same

UNIT = "-analysis modes -modes_band 900,20000 -modes_left 0 -output_fields 0"
FACTOR_KRYLOV = ("MatGetOrdering", "MatLUFactorSym", "MatLUFactorNum", "EPSSolve")
REDUCED = {1e-6: 4.5, 1e-9: 7}  # -sweep_rtol, and the most full solves that it may cost
REAL_MODES = (80, 160)  # of each value
REAL_STIFFNESSES = ("frictionless", "symmetrised")
N_HELD_OUT = 10


def cost_runs(args):
    """Rounds of every method, each run after a unit of its own; the first sweep of each is compared with full ones.

    Returns units and sweeps, lists by method.
    """
    methods = {f"reduced, rtol {rtol:g}": f"-sweep_rtol {rtol:g}" for rtol in REDUCED}
    methods |= {f"real modes, {n}, {kind}": f"-sweep_method real -sweep_real_modes {n} -sweep_real_stiffness {kind}"
                for n in REAL_MODES for kind in REAL_STIFFNESSES}
    units, sweeps = {name: [] for name in methods}, {name: [] for name in methods}
    for i in range(args.runs):
        for name, options in methods.items():
            units[name].append(Run(args.program, args.ranks, UNIT))
            require_same(next(iter(units.values()))[0], units[name][-1])
            checks = f" -sweep_verify {N_HELD_OUT}" if i == 0 else ""
            run = SweepRun(args.program, args.ranks, DEFAULT, options + checks)
            if i == 0 and len(run.checks) != N_HELD_OUT:
                raise SystemExit(f"options {options}: {len(run.checks)} checks, not {N_HELD_OUT}")
            require_same_sweep(sweeps[name][0] if i else run, run, 1e-6)
            sweeps[name].append(run)
    return units, sweeps


def brute_run(args, values):
    """Some of the values in full, evenly spaced, and the factor to all of them."""
    n = min(args.brute_points, len(values))
    chosen = [values[round(i * (len(values) - 1) / (n - 1))] for i in range(n)]
    options = "-sweep_method full -modes_left 0 -sweep_onsets 0 " + (with_values(chosen) if n < len(values) else "")
    return SweepRun(args.program, args.ranks, DEFAULT, options), len(values) / n


def held_out(run):
    """Largest true error and estimate, unstable ones missed and invented, modes too many or too few."""
    checks = run.checks
    return (max(c["true_error"] for c in checks), max(c["error_estimate"] for c in checks),
            sum(max(0, c["unstable_full"] - c["unstable_reduced"]) for c in checks),
            sum(max(0, c["unstable_reduced"] - c["unstable_full"]) for c in checks),
            sum(abs(c["modes_full"] - c["modes_reduced"]) for c in checks))


def unit_seconds(unit):
    """Time of the unit of cost, s."""
    return unit.seconds("summary", stage="Modes")


def ratios(units, runs, seconds):
    """Median over the rounds of seconds(run) over those of the unit run before it."""
    return statistics.median(seconds(run) / unit_seconds(unit) for unit, run in zip(units, runs))


def judge_cost(units, runs, most):
    """Met or not by the shortest unit and the longest alike; else other work on the machine decides."""
    times = [unit_seconds(unit) for own in units.values() for unit in own]
    seconds = statistics.median(run.sweep_seconds for run in runs)
    low, high = seconds / max(times), seconds / min(times)
    verdict = met(high <= most) if (high <= most) == (low <= most) else "UNDECIDED, the machine was disturbed"
    return f"{verdict} ({low:.2f} to {high:.2f} with the longest and the shortest unit)"


def cost_row(name, units, runs, brute):
    """One method: size, time, cost, errors at held-out values and at those of the sweep in full."""
    error, estimate, missed, invented, modes = held_out(runs[0])
    at_error, at_missed, at_invented, at_modes = compare(runs[0], brute)
    is_reduced = name.startswith("reduced")
    with_onsets = f"{ratios(units, runs, lambda r: r.sweep_seconds + r.seconds['onsets']):.2f}" if is_reduced else "-"
    return (name, str(runs[0].basis if is_reduced else name.split()[-1]),
            f"{statistics.median(run.sweep_seconds for run in runs):.2f}",
            f"{ratios(units, runs, lambda r: r.sweep_seconds):.2f}", with_onsets, f"{error:.1e}",
            "none" if math.isnan(estimate) else f"{estimate:.1e}", f"{missed} / {invented} / {modes}",
            f"{at_error:.1e}", f"{at_missed} / {at_invented} / {at_modes}")


def reduced_costs(units, sweeps):
    """Cost by name of the reduced sweeps, in units."""
    return {name: ratios(units[name], runs, lambda r: r.sweep_seconds)
            for name, runs in sweeps.items() if name.startswith("reduced")}


def print_demands(units, sweeps, brute):
    """What issue and README promise, one line each."""
    print()
    for (rtol, most), (name, cost) in zip(REDUCED.items(), reduced_costs(units, sweeps).items()):
        runs = sweeps[name]
        error, _, *off = held_out(runs[0])
        _, *off_points = compare(runs[0], brute)
        print(f"  -sweep_rtol {rtol:g}: cost {cost:.2f} right solves, demanded {most:g} at most: "
              f"{judge_cost(units, runs, most)}")
        print(f"  -sweep_rtol {rtol:g}: true error {error:.1e}, demanded {rtol:g} at most: {met(error <= rtol)}")
        print(f"  -sweep_rtol {rtol:g}: unstable ones all found, none invented, no mode too many or too few, at "
              f"{N_HELD_OUT} held-out values and {len(brute.values)} of the sweep: "
              f"{met(not any(off) and not any(off_points))}")


def part_cost(args):
    """Speed against error."""
    units, sweeps = cost_runs(args)
    brute, scale = brute_run(args, next(iter(sweeps.values()))[0].values)
    all_units = [unit for own in units.values() for unit in own]
    unit = statistics.median(map(unit_seconds, all_units))
    own = statistics.median(u.seconds(*FACTOR_KRYLOV, stage="Modes") for u in all_units)
    rows = [cost_row(name, units[name], runs, brute) for name, runs in sweeps.items()]
    n, seconds = len(brute.values), scale * brute.sweep_seconds
    rows.append(("full, right vectors", "-", f"{seconds:.1f}", f"{seconds / unit:.1f}", *"------"))
    print_table(
        f"speed against error: {brute.unknowns} unknowns, {round(n * scale)} values, ranks {args.ranks}",
        ("method", "basis", "time, s", "cost", "with onsets", "true error", "estimate", "off, held out",
         "error in sweep", "off, in sweep"), *rows)
    print("  off: unstable ones missed / unstable ones invented / modes too many or too few; unstable ones pair within "
          f"{PAIRED:.0%}\n  held out: {N_HELD_OUT} values between those of the sweep; in sweep: {n} of its own values")
    if scale > 1:
        print(f"  full: {n} values, its time scaled by {scale:.2f}")
    costs = ", ".join(f"{name} {cost * unit / own:.2f}" for name, cost in reduced_costs(units, sweeps).items())
    shortest, longest = min(map(unit_seconds, all_units)), max(map(unit_seconds, all_units))
    print(f"  unit: {unit:.2f} s, from {shortest:.2f} to {longest:.2f}; of it LU and Krylov {own:.2f} s, the rest "
          f"pencil, inertia, labels\n  in units of LU and Krylov alone: {costs}")
    print_demands(units, sweeps, brute)
