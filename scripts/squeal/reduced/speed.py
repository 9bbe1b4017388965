"""Part `speed` of study/reduced: errors of growth and of the limit cycle over cut-offs and steps, beside their time."""

import re
from typing import NamedTuple

from ..run.program import ROOT
from .cycles import both_late
from .picture import draw_speed
from ..transient.signal import fit_modes
from ..tables import BadInput, print_row, read_table
from ..transient.history import Run
from ..transient.study import MODES, RISE, run, vibration_of

SCENE = ROOT / "options/massi2005_reduced.yaml"
BAND = 3300, 3700  # Hz, of the mode that grows
TIME = 50e-3  # s
SMALL = 1e-11  # m, a disturbance that changes no status; of 1e-13 m what the contact solver leaves over would be 0.6 % of the growth
STEP = 8e-6  # s, at 20 kHz
MESH_STEP = 2.1e-8  # s, a little below what is stable on the mesh
POINTS = (10e3, 2), (20e3, 4), (20e3, 2), (20e3, 1), (20e3, 0.5), (40e3, 1), (40e3, 0.5)  # Hz, of STEP
CYCLES = (20e3, 4), (20e3, 2), (20e3, 1), (40e3, 0.5)  # the last one is the finest


class Point(NamedTuple):
    """Errors, relative, of a cut-off (Hz) and a step (s); seconds of 50 ms."""

    cutoff: float
    step: float
    seconds: float
    growth: float
    frequency: float


def made(args, name, options):
    """A kept run of the scene: its folder and what it printed."""
    folder = run(args.program, args.ranks, args.runs.parent / f"reduced/{name}", options, SCENE)
    return folder, (folder / "log.txt").read_text(encoding="utf-8")


def printed(text, pattern, about):
    """A number that a run printed."""
    found = re.search(pattern, text)
    if not found:
        raise BadInput(f"{about}: does not print {pattern}")
    return float(found.group(1))


def seconds_of(text, about, step):
    """Of 50 ms, by the time of a step."""
    return 1e-6 * printed(text, r"s: (\S+) us per step", about) * TIME / step


def mesh_seconds(args, kernel):
    """Those of the mesh, from a short run."""
    _, text = made(args, f"mesh-{kernel}", f"-dynamics_model full -dynamics_kernel {kernel} -ts_dt {MESH_STEP:g} "
                   "-ts_max_steps 1000 -dynamics_live 0 -dynamics_view")
    return seconds_of(text, kernel, printed(text, r"step (\S+) s, ", kernel))


def options_of(cutoff, part):
    """Of a reduced run."""
    return f"-dynamics_cutoff {cutoff:g} -ts_dt {part * STEP:g} -dynamics_compare false -dynamics_live 0 -dynamics_view"


def growth_point(args, modes, mode, cutoff, part):
    """A little of the mode on the sliding state, for 4 ms."""
    name = f"rise-{cutoff:g}-{part:g}"
    folder, text = made(args, name, f"{options_of(cutoff, part)} -dynamics_start static -dynamics_shape {modes} "
                        f"-dynamics_shape_mode {mode['mode']} -dynamics_shape_amplitude {SMALL} -ts_max_time {RISE} "
                        "-press_ramp 0 -tap_impulse 0,0,0")
    table = Run(folder)
    signal = table.probe("edge", "vy")
    found = min(fit_modes(table.time, signal - signal.mean(), BAND, 2), key=lambda fit: abs(fit.freq - mode["freq_hz"]))
    return Point(cutoff, part * STEP, seconds_of(text, name, part * STEP),
                 abs(found.growth / mode["growth_rad_s"] - 1), abs(found.freq / mode["freq_hz"] - 1))


def cycle_points(args):
    """The limit cycle of all runs beside that of the last one: force's rms in place of growth."""
    runs = []
    for cutoff, part in CYCLES:
        name = f"cycle-{cutoff:g}-{part:g}"
        folder, text = made(args, name, options_of(cutoff, part))
        runs.append((cutoff, part * STEP, seconds_of(text, name, part * STEP), vibration_of(folder)))
    finest = runs[-1][-1]
    for cutoff, step, seconds, own in runs[:-1]:
        forces = both_late((own[0], finest[0]), (own[1], finest[1]))
        yield Point(cutoff, step, seconds, abs(forces[0].std() / forces[1].std() - 1),
                    abs(own[1].line[0] / finest[1].line[0] - 1))


def print_points(title, names, points, unit):
    """A table."""
    print(f"\n{title}\n")
    print_row("cut-off, kHz", "step, us", *names, "s of 50 ms", "of the mesh's")
    print_row(*["--:"] * 6)
    for point in points:
        print_row(f"{1e-3 * point.cutoff:g}", f"{1e6 * point.step:g}", f"{point.growth:.1e}", f"{point.frequency:.1e}",
                  f"{point.seconds:.3g}", f"{point.seconds / unit:.1e}")


def part_speed(args):
    """Tables, and the picture."""
    units = {kernel: mesh_seconds(args, kernel) for kernel in ("general", "auto")}
    print("\n50 ms on the mesh: " + ", ".join(f"{seconds:.4g} s by -dynamics_kernel {kernel}"
                                              for kernel, seconds in units.items()))
    modes, _ = made(args, "modes", "-analysis modes -modes_contact static -operators_mass lumped "
                    f"-contact_friction_damping -modes_band {BAND[0]},{BAND[1]}")
    mode = max(read_table(modes / "modes.csv", MODES), key=lambda row: row["growth_rad_s"])
    growth = [growth_point(args, modes, mode, *point) for point in POINTS]
    print_points(f"growth in time against the eigenvalue of the mesh, {mode['freq_hz']:.2f} Hz and "
                 f"{mode['growth_rad_s']:.2f} 1/s", ("growth", "frequency"), growth, units["general"])
    cycles = list(cycle_points(args))
    print_points(f"limit cycle against that of {1e-3 * CYCLES[-1][0]:g} kHz and {1e6 * CYCLES[-1][1] * STEP:g} us",
                 ("rms of the force", "frequency"), cycles, units["general"])
    if args.picture:
        draw_speed(args.picture, growth, cycles, units["general"])
