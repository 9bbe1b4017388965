#!/usr/bin/env python3
"""What plates and brakes radiate, beside closed forms and other integrals.

    sound.py piston MODES LENGTH WIDTH MASS [BENDS]
        sound.csv of a rigid plate in the x, y plane with its top at z = 0 that moves along z, of such a size (m) and mass (kg), rigid but
        for BENDS: Rayleigh's integral over the top by Gauss's rule, the power of top and bottom, levels by the table of IEC 61672-1
    sound.py tone TIME MODES LENGTH WIDTH MASS SPEED
        sound_time.csv of the same plate, which begins with that speed (m/s): its tone
    sound.py power RUN
        sound.csv of a mesh of hex8 beside the integral of the field in modes.h5 over the outer surface that VTK finds
    sound.py beside ONE OTHER FROM TOLERANCE
        sound_time.csv of two runs from a time (s) on, of the rms
    sound.py forced RUN LENGTH WIDTH MASS STIFFNESS
        sound_frf.csv of the same plate on springs (N/m) that 1 N moves
    sound.py fields MODAL DIRECT
        sound_frf.csv by superposition and as a whole: the difference of pressures within the error that is told
    sound.py cycle CYCLE TRANSIENT DECIBEL
        sound_cycle.csv beside sound_time.csv of the transient that ends in it: levels of all and of each harmonic, in the last 10 ms
    sound.py branch BRANCH CYCLE DECIBEL
        sound_cycle.csv of a branch of which the last cycle, or the first, is that of the other run"""

import csv
import sys
from pathlib import Path

import h5py
import numpy as np

DENSITY, SPEED = 1.204, 343.2  # of the air
PLACES = {"near": (0, 0, 0.05), "far": (0.3, 0.2, 0.4)}
# IEC 61672-1:2013, table 3: nominal frequency, A-weighting, dB, at exact frequencies 1000 * 10^(n / 10)
WEIGHTS = {1000: 0.0, 1250: 0.6, 1600: 1.0, 2000: 1.2, 2500: 1.3, 3150: 1.2, 4000: 1.0, 5000: 0.5, 6300: -0.1, 8000: -1.1, 10000: -2.5,
           12500: -4.3, 16000: -6.6}


def rows_of(path):
    """Rows of a table, numbers all."""
    with Path(path).open(newline="") as file:
        return [{name: float(value) if value else np.nan for name, value in row.items()} for row in csv.DictReader(file)]


def rayleigh(place, omega, length, width):
    """Pressure at a place for a velocity of 1 m/s, by Gauss's rule."""
    t, g = np.polynomial.legendre.leggauss(120)
    x, y = length / 2 * t, width / 2 * t
    distance = np.sqrt((place[0] - x[:, None])**2 + (place[1] - y)**2 + place[2]**2)
    kernel = np.exp(-1j * omega / SPEED * distance) / distance
    return 1j * omega * DENSITY / (2 * np.pi) * length * width / 4 * (g @ kernel @ g)


def check(words):
    """Prints (what, measured, allowed) and exits with 1 where one is too large."""
    for what, measured, allowed in words:
        print(f"{what}: measured {measured:.3g}, allowed {allowed:g}")
    sys.exit(any(not measured <= allowed for _, measured, allowed in words))


def piston(folder, length, width, mass, bends=0):
    """A row a mode, the first one along z; `bends`: how far the plate is from rigid."""
    row = rows_of(Path(folder) / "sound.csv")[0]
    omega = 2 * np.pi * row["freq_hz"]
    speed = np.sqrt(2 * row["energy_j"] / mass)
    words = [("power", abs(row["power_w"] / (DENSITY * SPEED * speed**2 * length * width) - 1), 1e-9 + bends),
             ("power in dB", abs(row["power_db"] - 10 * np.log10(row["power_w"] / 1e-12)), 1e-9)]
    nominal = min(WEIGHTS, key=lambda f: abs(f - row["freq_hz"]))
    for name, place in PLACES.items():
        expected = abs(rayleigh(place, omega, length, width)) * speed
        size = abs(complex(row[f"{name}_re_pa"], row[f"{name}_im_pa"]))
        words += [(f"pressure {name}", abs(size / expected - 1), 1e-3),
                  (f"level {name}", abs(row[f"{name}_db"] - 20 * np.log10(size / np.sqrt(2) / 20e-6)), 1e-9),
                  (f"weight {name}", abs(row[f"{name}_dba"] - row[f"{name}_db"] - WEIGHTS[nominal]), 0.06)]
    return words


def tone(time, modes, length, width, mass, speed):
    """The tone of a history, fitted in its second half."""
    row = rows_of(Path(modes) / "sound.csv")[0]
    omega = 2 * np.pi * row["freq_hz"]
    rows = [r for r in rows_of(Path(time) / "sound_time.csv")]
    rows = rows[len(rows) // 2:]
    t = np.array([r["time_s"] for r in rows])
    base = np.column_stack([np.cos(omega * t), np.sin(omega * t)])
    words = []
    for name, place in PLACES.items():
        heard = np.array([r[f"{name}_pa"] for r in rows])
        found = np.linalg.lstsq(base, heard, rcond=None)[0]
        expected = abs(rayleigh(place, omega, length, width)) * speed
        words += [(f"tone {name}", abs(np.hypot(*found) / expected - 1), 1e-3),
                  (f"rest {name}", abs(heard - base @ found).max() / expected, 1e-3)]
    return words


def outer(file):
    """Corners of the outer faces of a mesh by VTK, with their points."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkUnstructuredGrid
    from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter

    root = file["VTKHDF"]
    grid, points, cells = vtkUnstructuredGrid(), vtkPoints(), vtkCellArray()
    points.SetData(numpy_to_vtk(root["Points"][:], deep=True))
    cells.SetData(numpy_to_vtkIdTypeArray(root["Offsets"][:].astype(np.int64), deep=True),
                  numpy_to_vtkIdTypeArray(root["Connectivity"][:].astype(np.int64), deep=True))
    grid.SetPoints(points)
    grid.SetCells(root["Types"][:].astype(np.int32).tolist(), cells)
    number = numpy_to_vtk(np.arange(points.GetNumberOfPoints()), deep=True)
    number.SetName("number")
    grid.GetPointData().AddArray(number)
    skin = vtkGeometryFilter()
    skin.SetInputData(grid)
    skin.Update()
    faces = vtk_to_numpy(skin.GetOutput().GetPolys().GetConnectivityArray()).reshape(-1, 4)
    return vtk_to_numpy(skin.GetOutput().GetPointData().GetArray("number"))[faces]


def power(folder):
    """Integrals of |v . n|^2 over bilinear faces, by three points a direction; v scaled by the energy through the ratio of modes."""
    rows, words = rows_of(Path(folder) / "sound.csv"), []
    t, g = np.polynomial.legendre.leggauss(3)
    with h5py.File(Path(folder) / "modes.h5") as file:
        quads, x = outer(file), file["VTKHDF/Points"][:]
        ratios = []
        for row in rows:
            key = f"VTKHDF/PointData/mode_{int(row['mode']):03d}"
            shape = file[f"{key}_re"][:] + 1j * file[f"{key}_im"][:]
            total = 0
            for a, wa in zip(t, g):
                for b, wb in zip(t, g):
                    w = np.array([(1 - a) * (1 - b), (1 + a) * (1 - b), (1 + a) * (1 + b), (1 - a) * (1 + b)]) / 4
                    da = np.array([-(1 - b), 1 - b, 1 + b, -(1 + b)]) / 4
                    db = np.array([-(1 - a), -(1 + a), 1 + a, 1 - a]) / 4
                    normal = np.cross(np.einsum("i,fid->fd", da, x[quads]), np.einsum("i,fid->fd", db, x[quads]))
                    area = np.linalg.norm(normal, axis=1)
                    v = np.einsum("i,fid,fd->f", w, shape[quads], normal) / area
                    total += wa * wb * (abs(v)**2 * area).sum()
            # |x|_M = 1: v^H M v / 2 = E is |lambda|^2 scale^2 / 2 = E
            ratios.append(DENSITY * SPEED * row["energy_j"] * total / row["power_w"])
    words.append((f"power of {len(rows)} modes", max(abs(r - 1) for r in ratios), 1e-10))
    return words


def beside(one, other, begin, tolerance):
    """All microphones of two histories, at the times of the first."""
    a, b = (rows_of(Path(folder) / "sound_time.csv") for folder in (one, other))
    at = np.array([row["time_s"] for row in a])
    names, words = [name for name in a[0] if name != "time_s"], []
    for name in names:
        x, y = (np.array([row[name] for row in rows]) for rows in (a, b))
        y = np.interp(at, [row["time_s"] for row in b], y)
        late = (at >= begin) & (at <= b[-1]["time_s"])
        words.append((name, np.sqrt(((x - y)[late]**2).mean() / (x[late]**2).mean()), tolerance))
    return words


def forced(folder, length, width, mass, stiffness):
    """v = i omega F / (k - m omega^2); its damping, of strain, does not act on a rigid plate."""
    words = []
    for row in rows_of(Path(folder) / "sound_frf.csv"):
        omega = 2 * np.pi * row["freq_hz"]
        speed = 1j * omega / (stiffness - mass * omega**2)
        power_of = DENSITY * SPEED * abs(speed)**2 * length * width
        words.append((f"power at {row['freq_hz']:g} Hz", abs(row["power_w"] / power_of - 1), 1e-5))
        for name, place in PLACES.items():
            expected = rayleigh(place, omega, length, width) * speed
            found = complex(row[f"{name}_re_pa"], row[f"{name}_im_pa"])
            words.append((f"pressure {name} at {row['freq_hz']:g} Hz", abs(found / expected - 1), 1e-3))
        away = 1j * omega * DENSITY * speed * length * width * np.exp(-200j * omega / SPEED) / (2 * np.pi * 200)
        if row["freq_hz"] == 10:
            words.append(("a point source", abs(complex(row["away_re_pa"], row["away_im_pa"]) / away - 1), 1e-6))
    return words


def fields(modal, direct):
    """Power and all pressures; rounding of a whole solution is below 1e-9 here."""
    words = []
    for a, b in zip(*(rows_of(Path(folder) / "sound_frf.csv") for folder in (modal, direct))):
        for name in ("near", "far", "away"):
            p, q = (complex(row[f"{name}_re_pa"], row[f"{name}_im_pa"]) for row in (a, b))
            words.append((f"{name} at {a['freq_hz']:g} Hz", abs(p / q - 1), a["error_relative"] + 1e-9))
        words.append((f"power at {a['freq_hz']:g} Hz", abs(a["power_w"] / b["power_w"] - 1), a["error_relative"] + 1e-9))
    words.append(("largest stated error", max(row["error_relative"] for row in rows_of(Path(modal) / "sound_frf.csv")), 1e-3))
    return words


def cycle(folder, transient, decibel):
    """Amplitudes of the harmonics by least squares over whole periods."""
    rows = [row for row in rows_of(Path(folder) / "sound_cycle.csv") if row["point"] == 1]
    freq, words = rows[1]["freq_hz"], []
    heard = rows_of(Path(transient) / "sound_time.csv")
    t = np.array([row["time_s"] for row in heard])
    late = t > t[-1] - np.floor(10e-3 * freq) / freq
    n = int(20e3 / freq)
    base = np.column_stack([part(2 * np.pi * h * freq * t[late]) for h in range(1, n + 1) for part in (np.cos, np.sin)])
    for name in ("front", "side"):
        p = np.array([row[f"{name}_pa"] for row in heard])[late]
        wave = np.linalg.lstsq(base, p - p.mean(), rcond=None)[0].reshape(n, 2) @ [1, -1j]
        size = abs(wave)
        levels = 20 * np.log10(np.array([np.sqrt((size**2).sum()), *size]) / np.sqrt(2) / 20e-6)
        for h in range(0, 3):
            words.append((f"{name}, harmonic {h}", abs(rows[h][f"{name}_db"] - levels[h]), decibel))
        told = [complex(row[f"{name}_re_pa"], row[f"{name}_im_pa"]) for row in rows[1:3]]
        turned = [np.angle(second / first**2) for first, second in (told, wave[:2])]  # does not depend on where a period begins
        words.append((f"{name}, phase of the second harmonic", abs(np.angle(np.exp(1j * (turned[0] - turned[1])))), 0.1))
    words.append(("all of them", abs(rows[0]["power_w"] / sum(row["power_w"] for row in rows[1:]) - 1), 1e-12))
    return words


def branch(folder, own, decibel):
    """All harmonics of the cycle of the same frequency; the other end of the branch sounds otherwise."""
    rows, alone = (rows_of(Path(run) / "sound_cycle.csv") for run in (folder, own))
    near = min({row["point"] for row in rows}, key=lambda k: abs(next(r for r in rows if r["point"] == k)["freq_hz"] - alone[0]["freq_hz"]))
    same = [row for row in rows if row["point"] == near]
    words = [(f"harmonic {a['harmonic']:g}", abs(a["front_db"] - b["front_db"]), decibel) for a, b in zip(same, alone)]
    other = next(row for row in rows if row["point"] != near)
    return [*words, ("another modulus", 1 / max(abs(other["front_db"] - alone[0]["front_db"]), 1e-9), 1 / (2 * decibel))]


def main():
    what, *words = sys.argv[1:]
    if what == "forced":
        check(forced(words[0], *map(float, words[1:])))
    if what == "fields":
        check(fields(*words))
    if what in ("cycle", "branch"):
        check({"cycle": cycle, "branch": branch}[what](*words[:2], float(words[2])))
    if what == "piston":
        check(piston(words[0], *map(float, words[1:])))
    if what == "tone":
        check(tone(*words[:2], *map(float, words[2:])))
    if what == "power":
        check(power(words[0]))
    if what == "beside":
        check(beside(*words[:2], *map(float, words[2:])))
    sys.exit(f"unknown: {what}")


if __name__ == "__main__":
    main()
