#!/usr/bin/env python3
"""Judges a map of vibration.

    verify/map.py growth MODES MAP MU MOST [VALUE_2]      growth of its fastest mode beside that of modes.csv, off by MOST, 1/s,
                                                          and frequency by 2e-4
    verify/map.py level TRANSIENT MAP MU FORCE PART       rms of the normal force in the last half of a transient beside it
    verify/map.py regimes MAP                             upwards stable where no mode grows and a vibration where one does by
                                                          100 1/s; downwards a vibration at some point without growing
                                                          mode; a frequency where there is one
    verify/map.py regime MAP REGIME                       all rows are of it
    verify/map.py twins MAP ALONE                         beside the map without twins: one that agrees changes nothing, and one
                                                          that differs is said
    verify/map.py chance MAP                              some row is bistable, with eight twins
    verify/map.py errors STEP HALF MAP MU WINDOW          map_errors.csv: rms of the normal force over the last half of the windows
                                                          by two transients, to 1e-6; its main line to 20 Hz; no error
                                                          of a stable run, and of growth for other bodies alone
    verify/map.py told MODES MAP MU PART                  growth_error_rad_s of map_errors.csv: by PART the difference to modes.csv
    verify/map.py linked MAP MU LESS MORE FALL            growth falls by it, 1/s, from one second value to the other, to 0.2
    verify/map.py failed MAP                              all rows have failed, and no number of a vibration is told
"""

import csv
import sys
from pathlib import Path

import numpy


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


def twins(folder, alone):
    table, single = rows(folder, "map.csv"), rows(alone, "map.csv")
    new = {"runs", "runs_vibrating", "regimes", "decided_by", "error_estimate", "freq_error_hz"}
    new |= {f"force_rms_p{share}_n" for share in ("05", "50", "95")}
    calm = [(row, own) for row, own in zip(table, single) if int(row["runs"]) < 4]
    changed = [row for row, own in calm for name in row if name not in new and row[name] != own[name]]
    loose = [row for row, own in calm if float(row["error_estimate"]) < float(own["error_estimate"])]
    chance = [row for row in table if row["regime"] == "bistable"]
    wrong = [row for row in table if (row["regime"] == "bistable") != (0 < int(row["runs_vibrating"]) < int(row["runs"]))
             or (row["decided_by"] == "rounding") != (row["regime"] == "bistable") or "+stable" in row["regimes"]]
    wrong += unlisted(table)
    wrong += [row for row in chance if not row["regimes"].startswith("stable+")
              or not float(row["force_rms_p05_n"]) < float(row["force_rms_p95_n"])]
    chaotic = [(row, own) for row, own in zip(table, single) if row["runs"] == row["runs_vibrating"] == "4"]
    wrong += [row for row, own in chaotic if not float(row["error_estimate"]) > float(own["error_estimate"])
              or not float(row["force_rms_p05_n"]) <= float(row["force_rms_n"]) <= float(row["force_rms_p95_n"])]
    kept = sum(row["runs"] == "2" and row["regime"] in ("cycle", "sticking") for row, _ in calm)
    print(f"{len(calm)} rows without twins or with one that agrees, {kept} of these vibrate, {len(changed)} numbers changed, {len(loose)} "
          f"errors smaller; {len(chaotic)} chaotic, {len(chance)} bistable, {len(wrong)} wrong")
    return bool(changed or loose or wrong) or not (kept and chaotic) or len(table) != len(single)


def unlisted(table):
    """Rows that lack a regime which chance may give them, beside a bistable row, or that have one beside rows of their own regime."""
    found = []
    for i, row in enumerate(table):
        near = [other for other in table[max(0, i - 1):i] + table[i + 1:i + 2]
                if all(other.get(key) == row.get(key) for key in ("direction", "value_2"))]
        two = "stable" in row["regimes"].split("+") and row["regimes"] != "stable"
        must = near and near[0] is table[i - 1] and near[0]["regime"] == "bistable"
        may = any((other["regime"] == "stable") != (row["regime"] == "stable") or other["regime"] == "bistable" for other in near)
        found += [row] * (row["regime"] not in ("bistable", "unknown") and (two and not may or must and not two))
    return found


def chance(folder):
    found = [row for row in rows(folder, "map.csv") if row["regime"] == "bistable"]
    for row in found:
        print(f"at {row['value']} {row['runs_vibrating']} of {row['runs']} transients vibrate, {row['force_rms_p05_n']} to "
              f"{row['force_rms_p95_n']} N, decided by {row['decided_by']}")
    return not any(row["decided_by"] == "rounding" and row["runs"] == "9" and row["freq_hz"] != "nan"
                   and 0 < int(row["runs_vibrating"]) < 9 for row in found)


def measured(transient, steps, window):
    """rms about the mean of each window, and the main line (Hz), of the normal force in the last half of the windows."""
    table = rows(transient, "transient.csv")[:steps + 1]
    dt = float(table[1]["time_s"])
    n = round(window / dt)
    normal = numpy.array([float(row["normal_force_n"]) for row in table[1:]]).reshape(-1, n)[steps // n // 2:]
    bins = (numpy.abs(numpy.fft.rfft((normal - normal.mean()) * numpy.hanning(n + 1)[:-1]))**2).sum(0)**0.5
    best = 4 + int(bins[4:-1].argmax())
    side = 1 if bins[best + 1] > bins[best - 1] else -1
    ratio = bins[best + side] / bins[best]
    return normal.var(axis=1).mean()**0.5, (best + side * (2 * ratio - 1) / (ratio + 1)) / (n * dt)


def errors(step, half, folder, value, window):
    table = rows(folder, "map_errors.csv")
    found = {row["run"]: row for row in table if float(row["value"]) == float(value)}
    level, line = zip(*(measured(transient, int(found[run]["steps"]), float(window))
                        for transient, run in ((step, "map"), (half, "half_step"))))
    told = {"rms of the map": float(found["map"]["force_rms_n"]) / level[0] - 1,
            "rms error of the step": float(found["half_step"]["force_rms_error"]) - (level[1] / level[0] - 1),
            "frequency, 1e-6 of 20 Hz": (float(found["map"]["freq_hz"]) - line[0]) / 20 * 1e-6,
            "its error": (float(found["half_step"]["freq_error_hz"]) - (line[1] - line[0])) / 20 * 1e-6}
    print(f"rms {level}, main line {line}: {told}")
    idle = [row for row in table for name in ("force_rms_error", "freq_error_hz")
            if (row[name] == "nan") != (row["regime"] == "stable" or row["run"] == "map")]
    idle += [row for row in table if (row["growth_error_rad_s"] == "nan") != (row["run"] != "higher_cutoff")]
    print(f"{len(table)} rows, {len(idle)} with an error of nothing, or none of something")
    return not all(abs(off) < 1e-6 for off in told.values()) or bool(idle) or len(table) != 8


def told(modes, folder, value, part):
    mesh = max(float(row["growth_rad_s"]) for row in rows(modes, "modes.csv"))
    found = {row["run"]: row for row in rows(folder, "map_errors.csv") if float(row["value"]) == float(value)}
    error = float(found["higher_cutoff"]["growth_error_rad_s"])
    true = mesh - float(found["map"]["growth_rad_s"])
    print(f"error of growth {true:.6g} 1/s, {error:.6g} is told")
    return not abs(error / true - 1) < float(part)


def linked(folder, value, less, more, fall):
    growths = [float(at(folder, value, second)[0]["growth_rad_s"]) for second in (less, more)]
    print(f"growth {growths} 1/s, must fall by {fall}")
    return not abs(growths[0] - growths[1] - float(fall)) < 0.2


def failed(folder):
    told = [(row["status"], row[name]) for row in rows(folder, "map.csv")
            for name in ("freq_hz", "force_rms_n", "force_mean_n", "open_share", "error_estimate")]
    told += [(row["status"], row[name]) for row in rows(folder, "map_errors.csv")
             for name in ("freq_hz", "force_rms_n", "freq_error_hz", "force_rms_error")]
    print(f"status and numbers {told}")
    return not told or any(status != "failed" or number != "nan" for status, number in told)


if __name__ == "__main__":
    sys.exit({"growth": growth, "level": level, "regimes": regimes, "regime": regime, "twins": twins, "chance": chance,
              "errors": errors, "told": told, "linked": linked, "failed": failed}[sys.argv[1]](*sys.argv[2:]))
