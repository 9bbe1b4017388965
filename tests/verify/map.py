#!/usr/bin/env python3
"""Judges a map of vibration.

    verify/map.py growth MODES MAP MU MOST [VALUE_2]      growth of its fastest mode beside that of modes.csv, off by MOST, 1/s,
                                                          and frequency by 2e-4
    verify/map.py level TRANSIENT MAP MU FORCE PART       rms of the normal force in the last half of a transient beside it
    verify/map.py regimes MAP                             upwards stable where no mode grows and a vibration where one does by
                                                          100 1/s; downwards a vibration at some point without growing
                                                          mode; a frequency where there is one
    verify/map.py regime MAP REGIME                       all rows are of it
    verify/map.py failed MAP                              all rows have failed, and no number of a vibration is told
"""

import csv
import sys
from pathlib import Path


def rows(folder, name):
    with (Path(folder) / name).open(newline="") as file:
        return list(csv.DictReader(file))


def at(folder, value, second=None):
    found = [row for row in rows(folder, "map.csv") if float(row["value"]) == float(value)
             and (second is None or float(row["value_2"]) == float(second))]
    assert found, f"no row at {value}, {second}"
    return found


def growth(modes, folder, value, most, second=None):
    mode = max(rows(modes, "modes.csv"), key=lambda row: float(row["growth_rad_s"]))
    row = at(folder, value, second)[0]
    off = float(row["growth_rad_s"]) - float(mode["growth_rad_s"])
    freq = float(row["growth_freq_hz"]) / float(mode["freq_hz"]) - 1
    print(f"growth {row['growth_rad_s']} 1/s, mesh {mode['growth_rad_s']}: off by {off:.3g} 1/s; frequency by {freq:.1e}")
    return not (abs(off) < float(most) and abs(freq) < 2e-4)


def level(transient, folder, value, force, part):
    normal = [float(row["normal_force_n"]) for row in rows(transient, "transient.csv")]
    half = normal[len(normal) // 2:]
    mean = sum(half) / len(half)
    rms = (sum((f - mean)**2 for f in half) / len(half))**0.5
    found = [float(row["force_rms_n"]) for row in at(folder, value, force)]
    print(f"rms of the force {found} N, full transient {rms:.6g} N")
    return not any(abs(f / rms - 1) < float(part) for f in found)


def regimes(folder):
    table = rows(folder, "map.csv")
    up = [row for row in table if row["direction"] == "up"]
    faults = [row for row in up if (float(row["growth_rad_s"]) < 0) != (row["regime"] == "stable")]
    lingers = [row for row in table if row["direction"] == "down" and float(row["growth_rad_s"]) < 0
               and row["regime"] == "cycle"]
    print(f"{len(faults)} of {len(up)} regimes upwards against the growth; {len(lingers)} points squeal downwards alone")
    heard = [row for row in table if (row["regime"] == "stable") == (row["freq_hz"] != "nan")]
    print(f"{len(heard)} rows have a frequency without a vibration, or none with one")
    return bool(faults) or bool(heard) or not lingers or len(up) * 2 != len(table)


def regime(folder, name):
    found = [row["regime"] for row in rows(folder, "map.csv")]
    print(f"regimes {found}, must be {name}")
    return not found or any(each != name for each in found)


def failed(folder):
    told = [(row["status"], row[name]) for row in rows(folder, "map.csv")
            for name in ("freq_hz", "force_rms_n", "force_mean_n", "open_share", "error_estimate")]
    print(f"status and numbers {told}")
    return not told or any(status != "failed" or number != "nan" for status, number in told)


if __name__ == "__main__":
    sys.exit({"growth": growth, "level": level, "regimes": regimes, "regime": regime, "failed": failed}[sys.argv[1]](*sys.argv[2:]))
