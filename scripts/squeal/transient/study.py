"""Parts of study/transient in time: every run is kept in a folder of its own and taken from there as long as it
is the same run."""

import subprocess
import sys
from typing import NamedTuple

import numpy

from ..run.kept_runs import KeptRun
from ..run.program import ROOT
from .signal import fit_modes
from ..tables import print_row, read_table
from .cycle import Vibration, detached_share
from .history import Run

SCENE = ROOT / "options/massi2005_transient.yaml"
MODULI = 16, 25.1, 39.8  # GPa
MODES = {"mode": int, "freq_hz": float, "growth_rad_s": float, "label": str}
LITTLE = 1e-13  # m, a disturbance that changes no status
RISE = 4e-3  # s of a run that follows one mode


class Rise(NamedTuple):
    """A mode that a run follows: modulus of the pad (GPa), further options, what its label begins with, band (Hz)."""

    young: float
    options: str
    label: str
    band: tuple


RISES = (Rise(25.1, "", "(0,4+)", (3300, 3700)), Rise(39.8, "", "(0,4+)", (3300, 3700)),
         Rise(25.1, "-contact_mu 0.2", "(0,4+)", (3300, 3700)))


def run(program, ranks, folder, options, scene=SCENE):
    """Folder with the tables of a run, made anew where it is not there or was made otherwise."""
    words = ["-options_file", scene, "-squeal_progress", 0, *options.split()]
    return KeptRun(program, ranks, folder, words).made()


def case_folder(args, young, kind=""):
    """Where a run of 50 ms is kept."""
    return args.runs / f"{kind}{young:g}GPa"


def case_run(args, young, kind="", options="", ranks=None):
    """One of the paper's cases, by default with snapshots of its end."""
    options = f"-pad_young {young}e9 -dynamics_live 0 {options}"
    return run(args.program, ranks or args.ranks, case_folder(args, young, kind), options)


def summary(folder, title):
    """Draws a run and prints what it does."""
    command = [sys.executable, ROOT / "scripts/plot/transient", folder, "--probe", "edge", "--case", title]
    print(subprocess.run([str(word) for word in command], capture_output=True, text=True, check=True).stdout)


def vibration_of(folder):
    """The table of a run, and the vibration of the pad's edge."""
    table = Run(folder)
    return table, Vibration(table.time, table.acceleration("edge", "y"), table.start())


# cases


def part_cases(args):
    """The paper's three cases, 50 ms each."""
    for young in MODULI:
        print(f"\n{young:g} GPa\n")
        summary(case_run(args, young, options="-dynamics_snapshot_interval 0.5e-3"), f"{young:g} GPa")


# growth in time against eigenvalues


def closed_pairs(folder):
    """Numbers of closed pairs that occur in a run."""
    return sorted(set(Run(folder).columns["n_closed"].astype(int)))


def follow(args, rise):
    """Row of one mode: eigenvalue, and what the run does that starts with a little of it."""
    name = f"{rise.young:g}GPa{rise.options.replace(' ', '')}"
    scene = f"-pad_young {rise.young}e9 {rise.options}"
    modes = run(args.program, args.ranks, args.runs / f"modes{name}",
                f"{scene} -analysis modes -modes_contact static -operators_mass lumped -contact_friction_damping "
                f"-modes_band {rise.band[0]},{rise.band[1]}")
    rows = [row for row in read_table(modes / "modes.csv", MODES) if row["label"].startswith(rise.label)]
    mode = max(rows, key=lambda row: row["growth_rad_s"])
    time = run(args.program, args.ranks, args.runs / f"rise{name}",
               f"{scene} -dynamics_start static -dynamics_shape {modes} -dynamics_shape_mode {mode['mode']} "
               f"-dynamics_shape_amplitude {LITTLE} -ts_max_time {RISE} -dynamics_live 0 -press_ramp 0 "
               "-tap_impulse 0,0,0")
    table = Run(time)
    signal = table.probe("edge", "vy")
    found = min(fit_modes(table.time, signal - signal.mean(), rise.band, 2),
                key=lambda other: abs(other.freq - mode["freq_hz"]))
    print_row(f"{rise.young:g} {rise.options}", f"{mode['growth_rad_s']:.4f}", f"{mode['freq_hz']:.4f}",
              f"{found.growth:.4f}", f"{found.freq:.4f}", f"{found.growth / mode['growth_rad_s'] - 1:.1e}",
              f"{found.freq / mode['freq_hz'] - 1:.1e}", ", ".join(map(str, closed_pairs(time))))


def part_growth(args):
    """Growth in time against the eigenvalue."""
    print("\ngrowth in 1/s and frequency in Hz, by the eigenvalue and in time; relative differences; closed pairs\n")
    print_row("E, GPa", "eigenvalue", "", "in time", "", "", "", "closed")
    print_row(*["--:"] * 8)
    for rise in RISES:
        follow(args, rise)


# growth of the families in time

SETS = {"23.5/86": "", "20/80": "-rig_beam_rows 0.020,0.080 -contact_speed 2 -disc_alpha 0 -pad_alpha 0 -beam_alpha 0 "
                                "-disc_beta 5e-7 -pad_beta 1e-7 -beam_beta 0"}
FAMILIES = {"A": (3300, 3800), "B": (4600, 5600), "C": (12500, 14300)}  # Hz
RISE_TIME = 12e-3  # s of these runs
WINDOW = (3e-3, 8e-3)  # s, after the ramp and the tap, or less:
LINEAR = 0.1  # the normal force has not yet left its mean by more than this part of it


def linear_part(table):
    """Samples of the window while the vibration is small."""
    chosen = (table.time >= WINDOW[0]) & (table.time <= WINDOW[1])
    mean = table.normal[chosen].mean()
    large = chosen & (abs(table.normal - mean) > LINEAR * mean)
    return chosen & (table.time < table.time[large.argmax()]) if large.any() else chosen


def family_growth(table, chosen, band):
    """Growth of the strongest line of a band, 1/s, at its frequency, Hz."""
    signal = table.acceleration("edge", "y")[chosen]
    found = fit_modes(table.time[chosen], signal - signal.mean(), band, 1)
    return f"{found[0].growth:.0f} +- {found[0].error:.0f} at {found[0].freq:.0f}" if found else "-"


def part_rise(args):
    """Growth of the families in time, both sets and three moduli, while it is small."""
    print(f"\ngrowth in time, 1/s, at Hz, from {1e3 * WINDOW[0]:g} ms; mean number of closed pairs\n")
    print_row("rows, mm", "E, GPa", *FAMILIES, "until, ms", "closed")
    print_row("---", *["--:"] * 6)
    for name, options in SETS.items():
        for young in MODULI:
            folder = run(args.program, args.ranks, args.runs / f"rise-{name.replace('/', '-')}-{young:g}GPa",
                         f"-pad_young {young}e9 -dynamics_live 0 -ts_max_time {RISE_TIME} {options}")
            table = Run(folder)
            chosen = linear_part(table)
            print_row(name, f"{young:g}", *(family_growth(table, chosen, band) for band in FAMILIES.values()),
                      f"{1e3 * table.time[chosen][-1]:.1f}", f"{table.columns['n_closed'][chosen].mean():.1f}")


# agreement of kinematics and of ranks


def correlation(a, b):
    """Of two signals about their means."""
    return numpy.corrcoef(a - a.mean(), b - b.mean())[0, 1]


def part_from(time, wanted, tolerance):
    """First time at which a relative difference exceeds a tolerance, s; the last one where none does."""
    beyond = numpy.flatnonzero(wanted > tolerance)
    return time[beyond[0]] if len(beyond) else time[-1]


def compare(first, second, names):
    """Prints how two runs of one case agree: while they are the same, and by their statistics after."""
    (a, va), (b, vb) = vibration_of(first), vibration_of(second)
    n = min(len(a.time), len(b.time))
    time, scale = a.time[:n], abs(a.normal).max()
    apart = abs(a.normal[:n] - b.normal[:n]) / scale
    print(f"\n{names[0]} against {names[1]}: normal forces differ by more than 1e-9, 1e-6, 1e-3 of the largest after "
          + ", ".join(f"{1e3 * part_from(time, apart, limit):.3g}" for limit in (1e-9, 1e-6, 1e-3)) + " ms")
    for begin in (3e-3, 10e-3, 30e-3):
        window = (time >= begin) & (time < begin + 9e-3)
        if window.sum() > 10:
            print(f"correlation of the normal force from {1e3 * begin:g} to {1e3 * begin + 9:g} ms: "
                  f"{correlation(a.normal[:n][window], b.normal[:n][window]):.4f}")
    print_row("", "growth, 1/s", "main line, Hz", "rms of the force, N", "rms of the acceleration, m/s^2", "detached")
    print_row(*["--:"] * 6)
    for name, table, vibration in ((names[0], a, va), (names[1], b, vb)):
        steady = vibration.steady
        values = vibration.signal[steady]
        growth = f"{vibration.fit.growth:.0f} +- {vibration.fit.error:.0f}" if vibration.fit else "-"
        print_row(name, growth, f"{vibration.line[0]:.1f} +- {vibration.line[1]:.1f}" if vibration.line else "-",
                  f"{table.normal[steady].std():.2f}", f"{values.std():.4g}",
                  f"{detached_share(table.normal[steady]):.3f}")


def part_kinematics(args):
    """A turning disc against prescribed sliding, at 25.1 GPa."""
    speed = 0.18 / 0.11  # rad/s that gives 0.18 m/s at the pad's centre
    spin = f"-contact_slip 0,0,0 -contact_speed 0 -contact_rotation 0,0,{-speed:.15g}"
    fixed = case_run(args, 25.1, "fixed", spin)
    turning = case_run(args, 25.1, "turning", f"{spin} -contact_kinematics turning")
    compare(fixed, turning, ("prescribed sliding", "turning disc"))


def part_ranks(args):
    """One against two ranks, at 25.1 GPa."""
    one = case_run(args, 25.1, ranks=1, options="-dynamics_snapshot_interval 0.5e-3")
    compare(one, case_run(args, 25.1, "ranks2-", ranks=2), ("1 rank", "2 ranks"))


# long runs


def ledger_error(folder):
    """Largest error of the ledger relative to the energy turned over."""
    return float(Run(folder).ledger_error().max())


def part_chatter(args):
    """1e5 steps of an undamped pad that chatters."""
    off = " ".join(f"-{part}_alpha 0 -{part}_beta 0" for part in ("disc", "pad", "beam"))
    folder = run(args.program, args.ranks, args.runs / "chatter",
                 f"{off} -contact_speed 2 -press_ramp 0.5e-3 -ts_max_steps 100000 -dynamics_live 0")
    table = Run(folder)
    closed = table.columns["n_closed"]
    print(f"\n1e5 steps of chatter: {int((numpy.diff(closed) != 0).sum())} of {len(closed)} rows change the number of "
          f"closed pairs ({closed.min():g} to {closed.max():g}); ledger closes to {ledger_error(folder):.1e}")


BLOWS = ("-impulses e,w,n,s -e_at 0.12,0,0 -e_impulse 1e-3,0,3e-3 -w_at -0.12,0,0 -w_impulse -1e-3,0,3e-3 "
         "-n_at 0,0.12,0 -n_impulse 0,1e-3,-3e-3 -s_at 0,-0.12,0 -s_impulse 0,-1e-3,-3e-3")  # N s, in balance
DISCS = {"clamped disc": ("plate", "-impulses hit -hit_at 0.12,0,0 -hit_impulse 1e-3,2e-3,-3e-3"),
         "free disc": ("free_ring", BLOWS),
         "free disc that flies and spins": ("free_ring", "-impulses hit -hit_at 0.12,0,0 -hit_impulse 1e-3,2e-3,-3e-3")}


def drift_run(args, name, impulses):
    """Folder of 1e6 steps of a disc of options/."""
    options = (f"-analysis transient -rig_disc_elements 6,40,1 {impulses} -ts_max_steps 1000000 -dynamics_live 0 "
               "-dynamics_history_interval 1e-4")
    return run(args.program, 1, args.runs / f"drift{len(impulses)}{name}", options, ROOT / f"options/{name}.yaml")


def part_drift(args):
    """1e6 steps of a vibrating disc."""
    print("\n1e6 steps, b = 1/2: largest drift of energy in 1e5 steps, and in all, relative\n")
    print_row("", "in 1e5", "in all")
    print_row("---", "--:", "--:")
    for name, (file, impulses) in DISCS.items():
        table = Run(drift_run(args, file, impulses))
        stored = table.columns["kinetic_j"] + table.columns["strain_j"]
        energy = (stored - table.columns["external_work_j"])[5:]
        pieces = numpy.array_split(energy, 10)
        drift = max(abs(piece[-1] - piece[0]) for piece in pieces) / stored[5:].mean()
        print_row(name, f"{drift:.1e}", f"{abs(energy[-1] - energy[0]) / stored[5:].mean():.1e}")


PARTS = {"cases": part_cases, "growth": part_growth, "rise": part_rise, "kinematics": part_kinematics,
         "ranks": part_ranks, "chatter": part_chatter, "drift": part_drift}
