"""Maps of study/ranking_many: brakes as those of ranking_scenes.py, many of them, each in time on the modes of its bodies."""

import itertools
from typing import NamedTuple

from .indices import SAME
from .scenes import BRAKE, DAMPING, PAPER
from ..tables import optional, read_table
from ..transient.study import run

ROWS = "0.02,0.08", "0.0235,0.086", "0.018,0.0792", "0.03,0.07", "0.025,0.075"  # m
MODULI = 16e9, 20e9, 25.1e9, 31.6e9, 39.8e9, 50.1e9, 63e9  # Pa
FRICTION = 0.4, 0.45, 0.5, 0.55, 0.6
LEAST = 200.0  # 1/s, of the fastest mode: with e^8 in 40 ms, 30 ms are left
TIME = "-dynamics_model reduced -dynamics_cutoff 25e3 -ts_max_time 70e-3 -map_window 5e-3 -map_rtol 1e-9 -map_direction apart -map_twins 0"
BLOW = "-impulses tap -tap_at -0.12,0,0 -tap_part disc -tap_impulse 0,0,-5e-5"
POINT = {"point": int, "value": float, "value_2": float, "regime": str, "freq_hz": float, "freq_error_hz": optional,
         "growth_rad_s": optional, "force_rms_n": float, "status": str}
DISTURBED = {"point": int, "regime": str, "freq_hz": float, "status": str}
ENERGY = "-map_disturbance 1e-3 -map_disturbance_least 1e-6"  # J, of the random velocities
MODE = {"point": int, "freq_hz": float, "growth_rad_s": float, "damping_ratio": float}
INDEX = {"growth": lambda mode: mode["growth_rad_s"],
         "damping ratio, the most negative": lambda mode: -mode["damping_ratio"],
         "lowest frequency": lambda mode: -mode["freq_hz"],
         "highest frequency": lambda mode: mode["freq_hz"]}


class Many(NamedTuple):
    """A brake: rows, damping, modulus (Pa), friction, its unstable modes, the row of map.csv, the mode that wins or None, and those that
    win from random velocities."""
    rows: str
    damping: str
    young: float
    mu: float
    modes: list
    point: dict
    winner: int
    winners: list = []


def all_maps():
    """Rows of springs and damping of each map."""
    return list(itertools.product(ROWS, DAMPING))


def map_of(args, rows, damping):
    """Folder of a map over friction and the modulus of the pad."""
    alpha, *beta = DAMPING[damping]
    factors = " ".join(f"-{part}_alpha {alpha} -{part}_beta {value}"
                       for part, value in zip(("pad", "disc", "beam"), beta))
    values = ",".join(map(str, FRICTION)), ",".join(f"{young:.6g}" for young in MODULI)
    disturbed = f"-map_disturbances {args.disturbed} {ENERGY}" if args.disturbed else ""
    name = f"{rows.replace(',', '_')}-{damping}" + (f"-{args.disturbed}" if args.disturbed else "")
    return run(args.program, 1, args.runs / name,
               f"-analysis map {BRAKE} -rig_beam_rows {rows} {factors} {TIME} {BLOW} {disturbed} "
               f"-map_parameter contact_mu,pad_young -map_values {values[0]} -map_values_2 {values[1]}", PAPER)


def winner_of(modes, freq):
    """Number of the unstable mode nearest to a main line, None where none is within SAME of it."""
    if not freq > 0:
        return None
    best = min(range(len(modes)), key=lambda i: abs(freq / modes[i]["freq_hz"] - 1))
    return best if abs(freq / modes[best]["freq_hz"] - 1) <= SAME else None


def scenes_of(args, rows, damping):
    """The brakes of a map with two or more unstable modes that vibrate, the fastest of which grows by LEAST."""
    folder = map_of(args, rows, damping)
    modes = read_table(folder / "map_modes.csv", MODE)
    runs = read_table(folder / "map_disturbed.csv", DISTURBED) if args.disturbed else []
    for point in read_table(folder / "map.csv", POINT):
        own = [mode for mode in modes if mode["point"] == point["point"] and mode["freq_hz"] > 0]
        if len(own) > 1 and max(mode["growth_rad_s"] for mode in own) >= LEAST and point["status"] != "failed":
            ends = [winner_of(own, end["freq_hz"]) for end in runs if end["point"] == point["point"] and end["status"] != "failed"]
            yield Many(rows, damping, point["value_2"], point["value"], own, point, winner_of(own, point["freq_hz"]), ends)


def predicted(scene, index):
    """Number of the mode that an index puts first."""
    return max(range(len(scene.modes)), key=lambda i: INDEX[index](scene.modes[i]))


