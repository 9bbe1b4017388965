#!/usr/bin/env python3
"""scripts/sound on tones of known levels, beside the table of IEC 61672-1, and what it refuses."""

import contextlib
import csv
import io
import re
import sys
import tempfile
import wave
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from drawing import script

# IEC 61672-1:2013, table 3: A-weighting, dB, at 1000 * 10^(n / 10) Hz
TABLE = {-16: -44.7, -15: -39.4, -12: -26.2, -9: -16.1, -6: -8.6, -3: -3.2, 0: 0.0, 1: 0.6, 2: 1.0, 3: 1.2, 4: 1.3, 5: 1.2, 6: 1.0, 7: 0.5,
         8: -0.1, 9: -1.1, 10: -2.5, 11: -4.3, 12: -6.6, 13: -9.3}
STEP = 5e-6
FAILED = []


def check(good, what):
    """Prints and keeps what failed."""
    print(f"{'ok    ' if good else 'FAILED'} {what}")
    if not good:
        FAILED.append(what)


def write(folder, columns):
    """sound_time.csv of the columns."""
    folder.mkdir(exist_ok=True)
    with (folder / "sound_time.csv").open("w", newline="") as file:
        table = csv.writer(file)
        table.writerow(columns)
        table.writerows(zip(*[map(repr, map(float, values)) for values in columns.values()]))


def read(path):
    """Rows of a table."""
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def sound(_, *words):
    """scripts/sound with words."""
    return script("sound", *words)


def near(value, expected, allowed, what):
    """A number of a table."""
    check(abs(float(value) - expected) <= allowed, f"{what}: {float(value):.6g} for {expected:.6g}, allowed {allowed:g}")


def tones(root, folder):
    """1 Pa at 4 kHz, from 0.1 s on with 0.5 Pa at 250 Hz; silence before 0.05 s at the other microphone."""
    t = np.arange(0, 0.2, STEP)
    first = np.sin(2 * np.pi * 4000 * t) + 0.5 * np.sin(2 * np.pi * 250 * t) * (t >= 0.1) + 7
    second = np.where(t >= 0.05, np.sin(2 * np.pi * 2000 * t), 0)
    write(folder, {"time_s": t, "front_pa": first, "side_pa": second})
    done = sound(root, folder, "--window", "0.1,0.2")
    check(done.returncode == 0 and not done.stderr, f"it runs: {done.stderr}")
    levels, thirds, noises = (read(folder / f"sound_{name}.csv") for name in ("levels", "thirds", "events"))
    full, quarter = 10 * np.log10(0.5 / 4e-10), 10 * np.log10(0.125 / 4e-10)
    near(levels[0]["level_db"], 10 * np.log10(0.625 / 4e-10), 2e-3, "level of both tones")
    near(levels[0]["level_dba"], 10 * np.log10(10**((full + 0.96) / 10) + 10**((quarter - 8.67) / 10)), 0.03, "A-weighted")
    near(levels[0]["main_hz"], 4000, 0.1, "main line")
    near(levels[0]["main_dba"], full + 0.96, 0.05, "level of the main line")
    near(levels[1]["halves_differ_db"], 0, 1e-6, "halves of a steady tone")
    bands = {round(float(row["middle_hz"])): float(row["level_db"]) for row in thirds if row["microphone"] == "front"}
    near(bands[3981], full, 2e-3, "third octave of 4 kHz")
    near(bands[251], quarter, 2e-3, "third octave of 250 Hz")
    check([row["microphone"] for row in noises] == ["front", "side"], "an event at each microphone")
    near(noises[1]["begin_s"], 0.05, 1e-9, "begin of the event")
    near(noises[1]["freq_hz"], 2000, 1, "its frequency")
    with wave.open(str(folder / "front.wav")) as file:
        heard = np.frombuffer(file.readframes(file.getnframes()), "<i2") / 32767
        check(file.getframerate() == 48000 and abs(len(heard) - 9600) <= 1, "0.2 s at 48 kHz")
    inside = (first - first.mean())[::1]
    near(np.sqrt((heard**2).mean()) * np.abs(inside).max(), np.sqrt((inside**2).mean()), 0.01, "effective value of the file")
    check((folder / "front.png").stat().st_size > 10000, "a picture")


def weights(root):
    """The formula beside the table."""
    sys.path.insert(0, str(root / "scripts"))
    from squeal.sound.levels import weighting

    worst = max(abs(20 * np.log10(weighting(1000 * 10**(n / 10))) - db) for n, db in TABLE.items())
    check(worst <= 0.05, f"A-weighting within {worst:.3f} dB of the table, which has one digit")


def ball(radius, n):
    """Triangles of a ball, n along each edge of an icosahedron, with the area of the sphere."""
    from squeal.sound.boundary import Surface

    golden = (1 + 5**0.5) / 2
    corners = np.array([[x, s * 1.0, t * golden] for x in (0,) for s in (-1, 1) for t in (-1, 1)])
    corners = np.concatenate([np.roll(corners, k, axis=1) for k in range(3)])
    triples = [(a, b, c) for a in range(12) for b in range(a) for c in range(b)
               if max(np.linalg.norm(corners[i] - corners[j]) for i, j in ((a, b), (b, c), (a, c))) < 2.1]
    triangles = []
    for a, b, c in corners[np.array(triples)]:
        b, c = (b, c) if np.linalg.det([a, b, c]) > 0 else (c, b)
        at = {(i, j): a + (b - a) * i / n + (c - a) * j / n for i in range(n + 1) for j in range(n + 1 - i)}
        triangles += [[at[i, j], at[i + 1, j], at[i, j + 1]] for i in range(n) for j in range(n - i)]
        triangles += [[at[i + 1, j], at[i + 1, j + 1], at[i, j + 1]] for i in range(n) for j in range(n - i - 1)]
    triangles = np.array(triangles)
    triangles /= np.linalg.norm(triangles, axis=2)[..., None]
    return radius * triangles / np.sqrt(Surface(triangles).area.sum() / (4 * np.pi))


def sphere(root):
    """A breathing sphere of 720 triangles with the sphere's area, at ka 0.5 and at pi, where the air inside has a mode of its own."""
    sys.path.insert(0, str(root / "scripts"))
    from squeal.sound.boundary import Surface, radiate

    density, speed, radius, n = 1.204, 343.2, 0.05, 6
    surface = Surface(ball(radius, n))
    triangles = surface.area
    for ka in (0.5, np.pi):
        heard, power = radiate(surface, np.ones(len(triangles)), ka * speed / radius, [[0.5, 0, 0]], (density, speed))
        factor = 1j * ka / (1 + 1j * ka)
        near(abs(heard[0]) / abs(density * speed * factor * radius / 0.5), 1, 1e-3, f"breathing sphere, ka {ka:.3g}: pressure")
        near(power / (2 * np.pi * radius**2 * density * speed * abs(factor)**2), 1, 2e-3, f"breathing sphere, ka {ka:.3g}: power")


def rows(folder, table, *lines):
    """A table by its lines."""
    folder.mkdir(exist_ok=True)
    (folder / table).write_text("\n".join(lines) + "\n")


def cycles(root, folder):
    """Two harmonics of 1 and 0.5 Pa, a quarter of a period apart; a response of two frequencies."""
    rows(folder, "sound_cycle.csv",
         "point,harmonic,freq_hz,error_db,cutoff_error_db,power_w,power_db,front_re_pa,front_im_pa,front_db,front_dba",
         "1,0,2000,0.1,,1,120,1.1180339887,0,92,93", "1,1,2000,,,1,120,1,0,91,92", "1,2,4000,,,1,120,0,0.5,85,86",
         "2,0,26000,,,1,120,1,0,91,80", "2,1,26000,,,1,120,1,0,91,80")
    done = sound(root, folder)
    words = "cycle 1: 2000.0 Hz, 2 harmonics; front 93.0 dB(A); power 120.0 dB; off by 0.1 dB by the steps"
    check(done.returncode == 0 and words in done.stdout,
          f"a cycle: {done.stdout}{done.stderr}")
    with wave.open(str(folder / "cycle_front.wav")) as file:
        heard = np.frombuffer(file.readframes(file.getnframes()), "<i2") / 32767
    t = np.arange(len(heard)) / 48000
    expected = np.cos(4000 * np.pi * t) - 0.5 * np.sin(8000 * np.pi * t)
    near(abs(heard - expected / abs(expected).max()).max(), 0, 1e-3, "3 s of it in the file" if len(heard) == 144000 else "LENGTH")
    rows(folder, "sound_frf.csv", "freq_hz,field_error,power_w,power_db,front_re_pa,front_im_pa,front_db,front_dba",
         "1000,0,1,120,1,0,91,91", "2000,0,1,110,2,0,97,98.2")
    done = sound(root, folder, "--most", "1")
    check("2000.000 Hz    98.2 dB(A)" in done.stdout and "1000.000" not in done.stdout,
          f"the loudest frequency: {done.stdout}{done.stderr}")
    check((folder / "sound_frf.png").stat().st_size > 10000, "its picture")
    for words, what in ((["--cycle", "3"], "has cycles 1 to 2"), (["--cycle", "2"], "too high to be heard"),
                        (["--window", "0,1"], "--window does nothing with"),
                        (["--directivity", "disc"], "no such table"),
                        (["--boundary", "disc", "--most", "3"], "take --modes and --distance alone")):
        done = sound(root, folder, *words)
        check(done.returncode and what in done.stderr, f"{words}: {done.stderr.strip().splitlines()[-1]}")


def directions(root, folder):
    """Places on circles; and a picture of a part that breathes, here a sphere: as loud in all directions."""
    sys.path.insert(0, str(root / "scripts"))
    from squeal.sound import directivity
    from squeal.sound.boundary import Surface

    angle, places = directivity.circles(np.array([0.1, 0, 0]), 0.5)
    check(np.allclose(np.linalg.norm(places - [0.1, 0, 0], axis=2), 0.5) and np.allclose(places[1, 18], [0.1, 0, 0.5])
          and np.isclose(angle[18], np.pi / 2), "places on circles")
    part = SimpleNamespace(surface=Surface(ball(0.05, 3)), air=(1.204, 343.2), normal_velocity=lambda *_: 1.0)
    part.normal_velocity = lambda *_: np.ones(len(part.surface.area))
    directivity.part_and_rows = lambda *_: (part, {3: {"freq_hz": 1000.0, "energy_j": 1e-3}})
    told = io.StringIO()
    with contextlib.redirect_stdout(told):
        path = directivity.draw_directivity(folder, "ball", [3], 0.5)
    loudest, least = map(float, re.search(r"loudest ([\d.]+) dB.*least ([\d.]+) dB", told.getvalue()).groups())
    check(loudest - least <= 0.1 and path.stat().st_size > 10000, f"a ball that breathes: {told.getvalue().strip()}")
    try:
        directivity.draw_directivity(folder, "ball", [3], 0.04)
        check(False, "a circle inside the part")
    except directivity.BadInput as error:
        check("--distance 0.04 m" in str(error), f"a circle inside the part: {error}")


def refused(root, folder):
    """One line each."""
    t = np.arange(0, 0.01, STEP)
    write(folder / "uneven", {"time_s": t**1.01, "front_pa": t})
    write(folder / "short", {"time_s": t[:10], "front_pa": t[:10]})
    write(folder / "nan", {"time_s": t, "front_pa": t * np.nan})
    write(folder / "none", {"time_s": t})
    (folder / "cut").mkdir()
    (folder / "cut/sound_time.csv").write_text("time_s,front_pa\n0,0\n1e-6,\n")
    for words in (["nowhere"], ["uneven"], ["short"], ["nan"], ["none"], ["cut"]):
        done = sound(root, folder / words[0])
        check(done.returncode == 1 and done.stderr.count("\n") == 1 and "not foreseen" not in done.stderr,
              f"{words[0]}: {done.stderr.strip()}")
    write(folder / "good", {"time_s": t, "front_pa": t})
    done = sound(root, folder / "good", "--window", "3,4")
    check(done.returncode == 1 and "holds 0 times" in done.stderr, f"window outside: {done.stderr.strip()}")
    check(sound(root, folder / "good", "--frame", "-1").returncode == 2, "a negative frame")


def main():
    root = Path(__file__).resolve().parents[2]
    weights(root)
    sphere(root)
    with tempfile.TemporaryDirectory() as folder:
        directions(root, Path(folder))
        tones(root, Path(folder) / "tones")
        cycles(root, Path(folder) / "cycles")
        refused(root, Path(folder))
    sys.exit(1 if FAILED else 0)


if __name__ == "__main__":
    main()
