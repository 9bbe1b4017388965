"""Parts `demands` and `large` of bench/modes: what an analysis, damping and a sweep cost, in units of one numeric LU of
K + mu H - s M of the default scene on one rank. The unit is taken from a run of the same program that has to factorise so;
what is compared with it on one rank is processor time."""

import statistics

from ..run.program import met, print_demand
from ..sweep.runs import DEFAULT, SweepRun
from ..tables import BadInput, print_table
from ..run.timed_runs import Run, median_run, require_same

UNIT = "-operators_factors lu"
LU = "MatLUFactorNum"
MOST_WHOLE = 7  # units, of one analysis
BEFORE_MB, MOST_MEMORY = 560, 0.6  # peak of one analysis before this was demanded, and the part of it
ALL = "-disc_{0} {1} -pad_{0} {1} -beam_{0} {1}"
DASHPOTS = "-dashpots damper -damper_set beam_top -damper_viscosity_total {0},{0},{0}"
SAME_BOTH = f"{ALL.format('alpha', 100)} {ALL.format('beta', '1e-7')}"
DAMPINGS = (("disc beta 5e-7 s, pad beta 1e-7 s", "-disc_beta 5e-7 -pad_beta 1e-7", 1.4),
            ("alpha 100 1/s, beta 1e-7 s on all parts", SAME_BOTH, 1.1),
            ("beta 1e-5 s on all parts", ALL.format("beta", "1e-5"), 3),  # most times of the undamped run
            ("beta 1e-4 s on all parts", ALL.format("beta", "1e-4"), 5),
            ("beta 1e-5 s on the pad alone", "-pad_beta 1e-5", 5),
            ("beta 1e-4 s on the pad alone", "-pad_beta 1e-4", 5),
            *((f"dashpots of {viscosity} N s/m in all", DASHPOTS.format(viscosity), 5) for viscosity in ("1e2", "1e4", "1e6")),
            ("friction damping at 1e-3 m/s", "-contact_speed 1e-3 -contact_force 100 -contact_friction_damping", 5))
BUSY = 1.2  # wall over processor time of the runs of the unit, from which on the unit is too long to judge by
LONGEST = "-modes_max_time 600"  # s, of a damped run
MOST_SWEEP, SWEEP_ERROR, N_HELD_OUT = 35, 1e-6, 10  # units; true error
LARGE, LARGE_UNKNOWNS = "-modes_band 2500,6000 -output_fields 0", 298011
MOST_LARGE_TIME, MOST_LARGE_GB = 0.5, 4  # of the other program's time


def unit_of(runs):
    """s of one numeric LU: the shortest, since the log has wall time, which other work on the machine can only lengthen."""
    counts = [run.count(LU, stage="Modes") for run in runs]
    if max(counts) != 1:
        raise BadInput(f"options {UNIT}: {max(counts)} LU were made, not one, hence there is no unit")
    return min(run.seconds(LU, stage="Modes") for run in runs)


def demand_sweep(program, n_runs, unit):
    """Figure 5 with confirmed onsets."""
    options = f"-sweep_rtol {SWEEP_ERROR:g}"
    runs = [SweepRun(program, 1, DEFAULT, options) for _ in range(n_runs)]
    print_demand("sweep of 75 values with confirmed onsets, units", statistics.median(run.cpu for run in runs) / unit,
                 MOST_SWEEP, ".1f")
    checks = SweepRun(program, 1, DEFAULT, f"{options} -sweep_onsets 0 -sweep_verify {N_HELD_OUT}").checks
    if len(checks) != N_HELD_OUT:
        raise BadInput(f"options {options}: {len(checks)} checks, not {N_HELD_OUT}")
    print_demand(f"its true error at {N_HELD_OUT} held-out values", max(c["true_error"] for c in checks), SWEEP_ERROR, ".1e")


def part_demands(measure):
    """One line for each demand."""
    args = measure.args
    plain, all_forced = measure(ranks=1, options=""), [Run(args.program, 1, UNIT) for _ in range(args.runs)]
    forced, unit = all_forced[0], unit_of(all_forced)
    print(f"\ndemands, one rank: unit {unit:.3f} s, one numeric LU with {forced.entries / 1e6:.1f} M entries; whole run "
          f"{plain.cpu:.2f} s of processor, with LU {forced.cpu:.2f} s and {forced.peak:.0f} MB; "
          f"{plain.n_solves} solutions in {plain.n_calls} calls, with LU {forced.n_solves} in {forced.n_calls}")
    waits = min(run.wall / run.cpu for run in all_forced)
    if waits > BUSY:
        print(f"  the machine is busy: runs take {waits:.1f} times their processor time, and so does the unit, by which costs in "
              "units seem too small")
    print(f"  frequencies of both ways agree to {require_same(forced, plain):.1e}")
    print_demand("one analysis with left vectors, units", plain.cpu / unit, MOST_WHOLE, ".1f")
    print_demand(f"its memory over {BEFORE_MB} MB", plain.peak / BEFORE_MB, MOST_MEMORY, ".2f")
    for what, options, most in DAMPINGS:
        try:
            cost = measure(ranks=1, options=f"{options} {LONGEST}").cpu / plain.cpu
        except BadInput as error:
            print(f"  {what}: {met(False)}: {error}")
            continue
        print_demand(f"{what}, times undamped", cost, most, ".2f")
    if args.against:
        print(f"  frequencies against {args.against}: {require_same(Run(args.against, 1, ''), plain):.1e}")
    demand_sweep(args.program, args.runs, unit)


def part_large(measure, mesh):
    """Time and memory of a large model on two ranks, beside another program where it is given."""
    args, options = measure.args, f"{mesh} {LARGE}"
    runs = [("squeal", median_run(args.program, 1, 2, options))]
    if runs[0][1].unknowns != LARGE_UNKNOWNS:
        raise BadInput(f"the large model has {runs[0][1].unknowns} unknowns, not {LARGE_UNKNOWNS}")
    if args.against:
        runs.append((str(args.against), median_run(args.against, 1, 2, options)))
        print(f"\nfrequencies of the two agree to {require_same(runs[1][1], runs[0][1]):.1e}")
    print_table(f"{LARGE_UNKNOWNS} unknowns, 2.5 to 6 kHz, two ranks, one run", ("program", "modes", "wall, s", "memory, MB"),
                *((name, str(len(run.modes)), f"{run.wall:.1f}", f"{run.peak:.0f}") for name, run in runs))
    print_demand("memory, GB", runs[0][1].peak / 1000, MOST_LARGE_GB, ".2f")
    if args.against:
        print_demand(f"time over that of {args.against}", runs[0][1].wall / runs[1][1].wall, MOST_LARGE_TIME, ".2f")
    else:
        print("  time against another program: name one by --against")
