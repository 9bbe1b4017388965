"""Runs of study/ranking: small brakes with two or more unstable modes, what the linear model says of each, and the
transient that shows which of them wins."""

import itertools
from typing import NamedTuple

import numpy

from ..mesh.bodies import opened
from ..run.program import ROOT
from .indices import Candidate, Outcome, overtakes
from ..transient.spectrum import peak_of
from ..tables import BadInput, flag, optional, read_table
from ..transient.amplitudes import Amplitudes
from ..transient.history import Run
from ..transient.study import run

PAPER = ROOT / "options/massi2005.yaml"
BRAKE = ("-rig_disc_elements 8,24,1 -rig_pad_elements 4,4,2 -rig_beam_elements 10 -rows_stiffness 0,18.5284e6,0 "
         "-contact_law constraint -contact_speed 0.5")  # 20 springs have the stiffness of the paper's 44
ABOUT = "-operators_mass lumped -contact_friction_damping -modes_band 500,20000"
STATES = {"static": "-modes_contact static -modes_filters", "less": "-modes_contact static -static_rows -1",
          "all": "-modes_contact all -contact_force 100"}  # about the sliding state, a row less, all pairs closed
ROWS = "0.02,0.08", "0.0235,0.086", "0.018,0.0792"  # m
MODULI = 16, 25.1, 39.8, 63  # GPa
FRICTION = 0.4, 0.5
DAMPING = {"disc": (0, 1e-7, 3e-7, 0), "all": (100, 2e-7, 2e-7, 2e-7)}  # 1/s; s of pad, disc, beam
SWEPT = {"contact_mu": (0.05, 0.8, 16), "pad_young": (6.5e9, 80e9, 16)}  # first, last, number
PROBE = 0.105, 0.005, 0.005  # m, on the pad's side
STARTS = {"blow": ("static", "-impulses tap -tap_at -0.12,0,0 -tap_part disc -tap_impulse 0,0,-5e-5 -tap_time 1e-5"),
          "press": ("rest", "-press_ramp 1e-3")}
SPEED = 0.5  # m/s
LEAST = 150.0  # 1/s, of the fastest mode: it reaches its limit soon
RISE, LOOKED_AT = 8.0, 15e-3  # e-folds of the fastest mode, after which a run goes on; s at its end, looked at
LINEAR = 40  # rows just after the blow
LOWEST, HIGHEST = 400.0, 20e3  # Hz of the main line
MODES = {"mode": int, "freq_hz": float, "growth_rad_s": float, "damping_ratio": float, "error_hz": optional,
         "unstable": flag, "label": str}
SWEEP = {"value": float, "freq_hz": float, "growth_rad_s": float}


class Scene(NamedTuple):
    """A brake with its unstable modes and how two runs end, one from each of STARTS; `meets`: time after the blow from
    which the fastest mode is the largest at the probe, as predicted and as found (s, nan where it is never)."""
    brake: tuple
    candidates: list
    outcome: Outcome
    other: Outcome
    meets: tuple


class Brake(NamedTuple):
    """One scene: heights of the rows (m), modulus of the pad (GPa), friction, damping."""
    rows: str
    young: float
    mu: float
    damping: str

    def name(self, without=""):
        """Of its folders; `without`: a swept parameter."""
        words = {"rows": self.rows.replace(",", "_"), "pad_young": f"{self.young:g}GPa", "contact_mu": f"mu{self.mu:g}",
                 "damping": self.damping}
        return "-".join(word for key, word in words.items() if key != without)

    def options(self):
        """For every analysis."""
        alpha, *beta = DAMPING[self.damping]
        factors = " ".join(f"-{part}_alpha {alpha} -{part}_beta {value}"
                           for part, value in zip(("pad", "disc", "beam"), beta))
        return f"{BRAKE} -rig_beam_rows {self.rows} -pad_young {self.young}e9 -contact_mu {self.mu} {factors}"


def all_brakes():
    """In the order of the table."""
    return [Brake(*values) for values in itertools.product(ROWS, MODULI, FRICTION, DAMPING)]


def nearest(rows, freq, within=0.03):
    """The row that continues a mode elsewhere: of those about its frequency the nearest one that grows, else the one
    that decays least; None without any."""
    near = [row for row in rows if abs(row["freq_hz"] / freq - 1) <= within]
    growing = [row for row in near if row["growth_rad_s"] > 0]
    if growing:
        return min(growing, key=lambda row: abs(row["freq_hz"] - freq))
    return max(near, key=lambda row: row["growth_rad_s"], default=None)


def modes_of(args, brake, state):
    """Folder and rows of the modes about a state."""
    folder = run(args.program, 1, args.runs / f"modes-{state}-{brake.name()}",
                 f"-analysis modes {ABOUT} {STATES[state]} {brake.options()}", PAPER)
    return folder, read_table(folder / "modes.csv", MODES)


def followed(points, freq):
    """Values and growth along a sweep, from a frequency at its first point on: at each the fastest mode near the one
    before."""
    for value, rows in points:
        row = nearest(rows, freq)
        if row is None:
            return
        freq = row["freq_hz"]
        yield value, row["growth_rad_s"]


def width(rows, freq, at):
    """Length of the interval of the parameter, about a value of the sweep, over which a mode stays unstable; ends by
    straight lines between the points."""
    values = sorted({row["value"] for row in rows}, key=lambda value: (abs(value - at), value))
    points = [(value, [row for row in rows if row["value"] == value]) for value in sorted(values)]
    centre, ends = sorted(values).index(values[0]), []
    for side in (points[centre::-1], points[centre:]):
        last, before = values[0], 0.0
        for value, growth in followed(side, freq):
            if growth <= 0:
                last += (value - last) * before / (before - growth) if before > 0 else 0.0
                break
            last, before = value, growth
        ends.append(last)
    return ends[1] - ends[0]


def swept(args, brake, parameter):
    """Rows of the sweep over a parameter; brakes that differ in it alone share one."""
    first, last, n = SWEPT[parameter]
    own = {"contact_mu": brake.mu, "pad_young": brake.young * 1e9}[parameter]
    places = {"contact_mu": FRICTION, "pad_young": [1e9 * young for young in MODULI]}[parameter]
    values = ",".join(sorted({f"{value:.11g}" for value in (*numpy.linspace(first, last, n), *places)}, key=float))
    shared = brake._replace(mu=FRICTION[0]) if parameter == "contact_mu" else brake._replace(young=MODULI[0])
    folder = run(args.program, 1, args.runs / f"sweep-{parameter}-{brake.name(parameter)}",
                 f"-analysis sweep -sweep_method full -modes_contact static {ABOUT} -sweep_onsets 0 "
                 f"{shared.options()} -sweep_parameter {parameter} -sweep_values {values}", PAPER)
    return read_table(folder / "sweep.csv", SWEEP), own


def probe_motion(folder, mode):
    """Component of a mode's shape along the sliding at the probe, complex, of 1 at the largest component."""
    with opened(folder / "modes.h5") as file:
        points = file["VTKHDF/Points"][:]
        at = int(numpy.linalg.norm(points - PROBE, axis=1).argmin())
        shape = sum(factor * file[f"VTKHDF/PointData/mode_{mode:03d}_{part}"][:]
                    for factor, part in ((1, "re"), (1j, "im")))
    return shape[at, 1] / abs(shape).max()


def transient_of(args, brake, modes, fastest, start):
    """Folder of a run in time from one of STARTS."""
    end = round(RISE / fastest + args.after, 4)
    place = ",".join(map(str, PROBE))
    name = f"time-{brake.name()}" if start == "blow" else f"{start}-{brake.name()}"
    return run(args.program, 1, args.runs / name,
               f"-analysis transient -dynamics_start {STARTS[start][0]} {brake.options()} {STARTS[start][1]} "
               f"-probes edge -edge_at {place} -edge_part pad -ts_max_time {end} -dynamics_live 0 "
               f"-dynamics_filters {modes}",
               PAPER)


def main_line(folder, table, velocity, until):
    """Main line of the velocity over LOOKED_AT before a time, Hz."""
    chosen = (table.time > until - LOOKED_AT) & (table.time <= until)
    line = peak_of(table.time[chosen], velocity[chosen] - velocity[chosen].mean(), (LOWEST, HIGHEST))
    if line is None:
        raise BadInput(f"{folder}: the probe has no line from {LOWEST:g} to {HIGHEST:g} Hz")
    return line[0]


def motions(folder, modes, rows):
    """The Amplitudes of a run, and the velocity that each mode gives the probe along the sliding by its number, m/s."""
    amplitudes = Amplitudes(folder, modes)
    by_mode = {mode.mode: abs(mode.values) for mode in amplitudes.modes}
    return amplitudes, {row["mode"]: by_mode[row["mode"]] * abs(
        probe_motion(modes, row["mode"]) * complex(row["growth_rad_s"], 2 * numpy.pi * row["freq_hz"])) for row in rows}


def outcome_of(folder, amplitudes, moved):
    """What the end of a run is made of."""
    table = Run(folder)
    velocity, end = table.probe("edge", "vy"), table.time[-1]
    last = amplitudes.time > amplitudes.time[-1] - LOOKED_AT
    shares = {mode: float(numpy.sqrt(0.5 * numpy.mean(size[last]**2))) for mode, size in moved.items()}
    return Outcome(main_line(folder, table, velocity, end), main_line(folder, table, velocity, end - LOOKED_AT), shares)


def candidates_of(args, brake, rows, starts):
    """The unstable modes with all that may rank them; `starts`: velocity at the probe just after the blow, m/s."""
    states = {state: modes_of(args, brake, state)[1] for state in ("less", "all")}
    sweeps = {parameter: swept(args, brake, parameter) for parameter in SWEPT}
    for row in rows:
        other = {state: nearest(found, row["freq_hz"]) for state, found in states.items()}
        yield Candidate(row["mode"], row["label"], row["freq_hz"], row["growth_rad_s"], row["damping_ratio"],
                        row["error_hz"], {state: found["growth_rad_s"] if found else -numpy.inf
                                          for state, found in other.items()},
                        {parameter: width(found, row["freq_hz"], own) for parameter, (found, own) in sweeps.items()},
                        starts[row["mode"]], SPEED)


def meeting(candidates, amplitudes, moved):
    """Time after the blow from which the fastest mode is the largest at the probe: predicted, and found, s."""
    fastest = max(candidates, key=lambda c: c.growth)
    others = [c for c in candidates if c is not fastest]
    ahead = moved[fastest.mode] > numpy.max([moved[c.mode] for c in others], axis=0)
    after = ahead & (amplitudes.time > amplitudes.start)
    found = amplitudes.time[after.argmax()] - amplitudes.start if after.any() else numpy.nan
    return max(overtakes(c, fastest) for c in others), float(found)


def scene_of(args, brake):
    """All about a brake; None where fewer than two modes are unstable, or all grow slowly."""
    folder, rows = modes_of(args, brake, "static")
    rows = [row for row in rows if row["unstable"]]
    if len(rows) < 2 or max(row["growth_rad_s"] for row in rows) < LEAST:
        return None
    outcomes = {}
    for start in STARTS:
        time = transient_of(args, brake, folder, max(row["growth_rad_s"] for row in rows), start)
        amplitudes, moved = motions(time, folder, rows)
        outcomes[start] = outcome_of(time, amplitudes, moved)
        if start == "blow":
            first = numpy.flatnonzero(amplitudes.time > amplitudes.start)[:LINEAR]
            candidates = list(candidates_of(args, brake, rows, {mode: float(size[first].mean())
                                                                for mode, size in moved.items()}))
            meets = meeting(candidates, amplitudes, moved)
    return Scene(brake, candidates, outcomes["blow"], outcomes["press"], meets)
