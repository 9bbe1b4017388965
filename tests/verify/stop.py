#!/usr/bin/env python3
"""One stop: stop.py STOP MODES. STOP is a folder of options/small_brake_stop.yaml with what scripts/sound wrote of it, MODES that of the
modes of the same brake at its static friction, by Coulomb's law.

  quiet    while the speed stays, with the friction of fast sliding: the normal force has less than 1e-3 rms of its mean
  squeal   before the end of sliding: 5 % rms at least, and one noise is counted, whose line is the unstable mode's within 2 %, that begins
           while the speed falls and ends with it
  course   loudness over time: each frame has the mean square of its pressure, the pairs slide, stick in the squeal, and rest at the end
  rest     after the stop every closed pair sticks, the mean force is what presses, and what is left dies out"""

import csv
import sys
from pathlib import Path

import numpy

STOPS, FALLS, FRAME = 0.1, 0.02, 0.01  # s
PRESS = 500.0                                # N


def columns(folder, name):
    with (Path(folder) / name).open(newline="") as file:
        names, *rows = list(csv.reader(file))
    return names, rows


def main(stop, modes):
    names, rows = columns(stop, "transient.csv")
    table = dict(zip(names, numpy.array(rows, float).T))
    t, force = table["time_s"], table["normal_force_n"]
    names, rows = columns(stop, "sound_events.csv")
    events = [dict(zip(names, row)) for row in rows]
    names, rows = columns(modes, "modes.csv")
    unstable = [float(row[names.index("freq_hz")]) for row in rows if float(row[names.index("growth_rad_s")]) > 0]

    names, rows = columns(stop, "sound_course.csv")
    frames = [dict(zip(names, row)) for row in rows]
    names, rows = columns(stop, "sound_time.csv")
    heard = numpy.array(rows, float).T[names.index("front_pa")]

    def level(first, last):
        return force[(t >= first) & (t < last)].std() / PRESS

    quiet, loud, rest = level(0.03, 0.04), level(0.08, 0.09), [level(first, first + 5e-3) for first in (0.105, 0.11, 0.115)]
    after = t >= STOPS + 0.01
    print(f"rms of the force: {quiet:.1e}, {loud:.1e}, then {rest}; {len(events)} noises: {events}; unstable modes at {unstable} Hz")
    print(f"at rest {table['n_stick'][after].min():g} of {table['n_closed'][after].max():g} pairs stick; {force[after].mean():.4f} N")
    good = quiet < 1e-3 and loud > 0.05 and rest[0] > 2 * rest[1] > 4 * rest[2] and rest[2] < 2e-3
    good = good and (table["n_stick"][after] == table["n_closed"][after]).all() and abs(force[after].mean() / PRESS - 1) < 5e-3
    good = good and len(events) == 1 and len(unstable) == 1 and abs(float(events[0]["freq_hz"]) / unstable[0] - 1) < 0.02
    print([(frame["begin_s"], frame["level_db"], frame["contact"]) for frame in frames])
    parts = [(float(f["begin_s"]), float(f["end_s"]), float(f["level_db"])) for f in frames]
    step = t[1] - t[0]
    own = [10 * numpy.log10(heard[round(a / step):round(b / step)].var() / 20e-6**2) for a, b, _ in parts]
    good = good and len(parts) == 12 and max(abs(x - y[2]) for x, y in zip(own, parts)) < 1e-6
    contact = [frame["contact"] for frame in frames]
    good = good and set(contact[:4]) == {"sliding"} and set(contact[7:9]) == {"sticking"} and contact[-1] == "rest"
    return good and FALLS < float(events[0]["begin_s"]) < float(events[0]["end_s"]) <= STOPS + FRAME


if __name__ == "__main__":
    sys.exit(not main(*sys.argv[1:]))
