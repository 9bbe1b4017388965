#!/usr/bin/env python3
"""scripts/correlate on a small brake, its own modes and responses standing for measured ones:

  exact    MAC of each mode with itself is 1 to 1e-12 by a table, to 1e-10 by scripts/export unv, which has six digits; FRAC by binary
           functions of both orders of bytes
  axes     places in mm, turned and moved, and directions in cylindrical coordinates come back by --points, --transform, 18 and 2420
  noise    of 400 shapes with noise MAC is distributed as |a + e| along a against across it: by the noncentral F distribution
  masses   cross-orthogonality by SEREP and by Guyan's reduction as dense matrices have them
  pairs    in any order, with other frequencies, and of a pair of close modes whose shapes were turned
  expand   a sum of modes comes back at all nodes; what no mode has is the residual
  pictures trace lines, and frequencies without sensors
  page     scripts/report shows pairs and moving shapes
  bad      a line each, status 1

Breaks when a sign, a direction, a unit or a conjugate is another one. Files themselves: test_universal.py.

    test_correlate.py SQUEAL MPIRUN"""

import csv
import math
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np
import scipy.stats
import universal
from forked import run_command, run_script
from served import sooner
from small_brake import SCENE

SOURCE = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(SOURCE / "scripts"))
from squeal.correlate import picture  # noqa: E402, so that children need not
from squeal.mesh.petsc_matrix import read_matrix  # noqa: E402

FAULTS = []
DRAW = {name: getattr(picture, name) for name in ("draw_summary", "draw_shapes")}
FRF = "-analysis frf -probes a,b -a_at 0.115,0,0 -a_part disc -b_at -0.115,0,0 -b_part disc -frf_force a,z -frf_frequencies 500:6000:111 " \
    "-disc_alpha 50 -pad_alpha 50 -beam_alpha 50".split()


def check(holds, what):
    print("ok  " if holds else "FAIL", what)
    if not holds:
        FAULTS.append(what)


def correlate(*words, fails=False, drawn=False):
    """What it prints, or the error; pictures, most of its time, where they are asked for."""
    for name, draw in DRAW.items():
        setattr(picture, name, draw if drawn else lambda *_: None)
    done = run_script(SOURCE / "scripts/correlate", words)
    if (done.returncode != 0) != fails or "Traceback" in done.stderr or "not foreseen" in done.stderr:
        raise SystemExit(f"correlate {' '.join(map(str, words))}: status {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stderr if fails else done.stdout


def table(path):
    with path.open(newline="") as lines:
        return list(csv.DictReader(lines))


class Brake:
    """A run: frequencies, shapes [modes][nodes][3], places."""

    def __init__(self, folder, *options, scene=SCENE):
        self.folder = folder
        folder.mkdir()
        (folder / "scene.yaml").write_text(scene)
        done = run_command([sys.argv[2], "-n", 1, sys.argv[1], "-options_file", "scene.yaml", "-output_dir", "out", *options], folder)
        if done.returncode:
            raise SystemExit(done.stderr)
        self.out = folder / "out"
        self.rows = table(self.out / "modes.csv")
        self.freq = np.array([float(row["freq_hz"]) for row in self.rows])
        with h5py.File(self.out / "modes.h5") as file:
            self.places, data = file["VTKHDF/Points"][:], file["VTKHDF/PointData"]
            self.shapes = np.array([data[f"mode_{int(row['mode']):03d}_re"][:] + 1j * data[f"mode_{int(row['mode']):03d}_im"][:]
                                    for row in self.rows])

    def sensors(self, count_of, seed=1):
        """Nodes that move in all directions, drawn at random."""
        _, first, count = np.unique(self.places.round(9), axis=0, return_index=True, return_counts=True)
        moving = (abs(self.shapes) > 0).any(axis=0).all(axis=1)
        alone = [i for i in first[count == 1] if moving[i]]  # bodies that touch have nodes at one place
        return np.random.default_rng(seed).choice(alone, count_of, replace=False)

    def write(self, nodes, values, freq, damping=0.01):
        """Tables of triaxial sensors and of modes: values [modes][nodes][3]."""
        with (self.folder / "sensors.csv").open("w") as out:
            out.write("sensor,x,y,z,direction_x,direction_y,direction_z\n")
            for node in nodes:
                for k, axis in enumerate("xyz"):
                    out.write(f"n{node}:{axis}," + ",".join(f"{x:.17g}" for x in (*self.places[node], *np.eye(3)[k])) + "\n")
        names = [f"n{node}:{axis}_{part}" for node in nodes for axis in "xyz" for part in ("re", "im")]
        flat = np.array(values).reshape(len(values), -1)
        with (self.folder / "modes.csv").open("w") as out:
            out.write(",".join(["freq_hz", "damping_ratio", *names]) + "\n")
            for one, row in zip(freq, np.stack([flat.real, flat.imag], axis=2).reshape(len(flat), -1)):
                out.write(",".join(f"{x:.17g}" for x in (one, damping, *row)) + "\n")
        return self.folder / "sensors.csv", self.folder / "modes.csv"

    def matrix(self, name, n):
        """A matrix of mac.csv."""
        found = [float(row["value"] or "nan") for row in table(self.out / "correlate/mac.csv") if row["matrix"] == name]
        return np.array(found).reshape(n, -1)


def mac(a, b):
    return abs(np.vdot(a, b))**2 / (np.vdot(a, a) * np.vdot(b, b)).real


def check_exact(brake):
    """Own modes."""
    nodes = brake.sensors(25)
    correlate(brake.out, *brake.write(nodes, brake.shapes[:, nodes], brake.freq), drawn=True)
    check(all((brake.out / f"correlate/{name}.png").stat().st_size > 20000 for name in ("correlate", "shapes")), "exact: two pictures")
    error = abs(np.diag(brake.matrix("mac", len(brake.freq))) - 1).max()
    check(error < 1e-12, f"exact: MAC of {len(brake.freq)} own modes by a table is 1 to {error:.1g}")
    whole = np.array([[mac(a, b) for b in brake.shapes[:, nodes]] for a in brake.shapes[:, nodes]])
    check(abs(brake.matrix("mac", len(whole)) - whole).max() < 1e-12, "exact: all of MAC as numpy has it")
    pairs = table(brake.out / "correlate/correlate.csv")
    check([row["mode"] for row in pairs] == [row["mode"] for row in brake.rows]
          and max(abs(float(row["freq_difference_percent"])) for row in pairs)
          < 1e-12, "exact: each mode beside itself, with no difference of frequency")
    ring = Brake(brake.folder / "ring", "-options_file", SOURCE / "options/free_ring.yaml", "-rig_disc_elements", "4,40,1", scene="{}")
    run_script(SOURCE / "scripts/export", ["unv", ring.out])
    said = correlate(ring.out, ring.out / "fields.unv")
    error = abs(np.diag(ring.matrix("mac", len(ring.freq))) - 1).max()
    check(error < 1e-10 and "0 mm from it" in said, f"exact: by scripts/export unv, of six digits, MAC is 1 to {error:.1g}")


def turned_file(brake, nodes, turn, shift, system=0, number=2411):
    """A universal file whose axes and mm are those of a test; system 7: directions along the radius, the angle and z."""
    places = {k + 1: 1e3 * (turn.T @ (brake.places[node] - shift)) for k, node in enumerate(nodes)}
    data = universal.units(1e3) + universal.nodes(places, number, system)
    if system:
        data += universal.cylinder(system, 18 if number == 15 else 2420)
    for k, shape in enumerate(brake.shapes):
        values = {}
        for label, place in places.items():
            x = turn.T @ shape[nodes[label - 1]]
            if system:
                c, s = place[:2] / np.hypot(*place[:2])
                x = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) @ x
            values[label] = x
        data += universal.shape(values, brake.freq[k], 0, k + 1, growth=-1.0)
    path = brake.folder / "turned.unv"
    path.write_bytes(data)
    return path, places


def check_axes(brake):
    """Units, turned and moved axes, cylindrical directions."""
    nodes, n = brake.sensors(25), len(brake.freq)
    angles = np.radians([20.0, -35.0, 110.0])
    c, s = np.cos(angles), np.sin(angles)
    turn = np.array([[c[2], -s[2], 0], [s[2], c[2], 0], [0, 0, 1]]) @ np.array([[c[1], 0, s[1]], [0, 1, 0], [-s[1], 0, c[1]]]) \
        @ np.array([[1, 0, 0], [0, c[0], -s[0]], [0, s[0], c[0]]])
    shift = np.array([0.3, -0.2, 0.05])
    for system, number in ((0, 2411), (0, 15), (7, 2411), (7, 15)):
        path, _ = turned_file(brake, nodes, turn, shift, system, number)
        named = [f"{k + 1}={','.join(f'{x:.12g}' for x in brake.places[nodes[k]])}" for k in range(4)]
        said = correlate(brake.out, path, "--points", *named)
        far = max(float(row["distance_m"]) for row in table(brake.out / "correlate/sensors.csv"))
        error = abs(np.diag(brake.matrix("mac", n)) - 1).max()
        check(error < 1e-9 and far < 1e-6 and "4 points fix the axes" in said,
              f"axes: dataset {number}, system {system}: found by four points, MAC 1 "
              f"to {error:.1g}, sensors {far:.1g} m off")
    correlate(brake.out, path, "--transform", "0.3,-0.2,0.05,20,-35,110")
    check(abs(np.diag(brake.matrix("mac", n)) - 1).max() < 1e-9, "axes: the same by --transform")
    check("mm from the mesh" in correlate(brake.out, path, fails=True), "axes: without them a sensor is refused, with its distance")
    check("mm off after the best turn" in correlate(brake.out, path, "--points", *named[:3],
                                                    f"4={','.join(map(str, brake.places[nodes[5]]))}", fails=True),
          "axes: a point that was mixed up is refused")
    sensor = brake.folder / "above.csv"
    sensor.write_text("sensor,x,y,z,direction_x,direction_y,direction_z\na,0.05,0.075,0.0012,0,0,-2\nb,-0.09,0.02,0.0003,0,0,1\n")
    modes = brake.folder / "two.csv"
    modes.write_text("freq_hz,a,b\n1000,1,2\n")
    correlate(brake.out, sensor, modes)
    apart = [float(row["distance_m"]) for row in table(brake.out / "correlate/sensors.csv")]
    check(np.allclose(apart, [1.2e-3, 3e-4], rtol=1e-9), f"axes: heights of {apart} m above the disc's face are stated")


def check_noise(brake):
    """MAC of a + e, e normal of deviation s |a| at n sensors: MAC / (1 - MAC) (n - 1) = (1 + g)^2 (n - 1) / chi^2 has the noncentral F
    distribution of 1 and n - 1 degrees and noncentrality 1 / s^2."""
    nodes, mode, trials = brake.sensors(6), 4, 400
    a = brake.shapes[mode, nodes].real.ravel()
    for s in (0.02, 0.1):
        noise = np.random.default_rng(3).normal(size=(trials, len(a))) * s * np.linalg.norm(a)
        correlate(brake.out, *brake.write(nodes, (a + noise).reshape(trials, -1, 3), np.full(trials, brake.freq[mode])), "--least", 0)
        value = brake.matrix("mac", trials)[:, mode]
        test = scipy.stats.kstest(value / (1 - value) * (len(a) - 1), scipy.stats.ncf(1, len(a) - 1, 1 / s**2).cdf)
        check(test.pvalue > 0.01, f"noise: MAC of {trials} shapes with {100 * s:g} % noise, mean {value.mean():.4f}, has the known "
              f"distribution (p = "
              f"{test.pvalue:.2f})")


def matrices(folder, brake):
    """M, K dense, and which of the directions of all nodes are unknowns."""
    found = []
    for name in ("M", "K"):
        rows, columns, row, column, value = read_matrix(folder / f"{name}.bin")
        found.append(np.zeros((rows, columns)))
        found[-1][row, column] = value
    return *found, np.flatnonzero((brake.shapes != 0).any(axis=0).ravel())


def check_masses(brake):
    """Cross-orthogonality beside dense matrices."""
    nodes, n = brake.sensors(25), len(brake.freq)
    rng = np.random.default_rng(5)
    measured = np.einsum("ij,jkl->ikl", np.eye(n) + 0.2 * rng.normal(size=(n, n)), brake.shapes[:, nodes])
    correlate(brake.out, *brake.write(nodes, measured, brake.freq), "--matrices", brake.folder / "m", "--least", 0)
    m, k, free = matrices(brake.folder / "m", brake)
    y, a = brake.shapes[:, nodes].reshape(n, -1).T, measured.reshape(n, -1).T
    x = brake.shapes.reshape(n, -1).T[free]
    gram, q = x.conj().T @ m @ x, np.linalg.lstsq(y, a, rcond=None)[0]
    size = np.sqrt(np.einsum("ij,ik,kj->j", q.conj(), gram, q).real)
    serep = abs(q.conj().T @ gram) / size[:, None] / np.sqrt(np.diag(gram).real)
    error = abs(brake.matrix("cross_serep", n) - serep).max()
    check(error < 1e-6, f"masses: cross-orthogonality by SEREP as dense matrices have it, to {error:.1g}")
    masters = np.searchsorted(free, [3 * node + axis for node in nodes for axis in range(3)])
    slaves = np.setdiff1d(np.arange(len(free)), masters)
    t = np.zeros((len(free), len(masters)))
    t[masters], t[slaves] = np.eye(len(masters)), -np.linalg.solve(k[np.ix_(slaves, slaves)], k[np.ix_(slaves, masters)])
    mass = t.T @ m @ t
    norm = [np.sqrt(np.einsum("ij,ik,kj->j", z.conj(), mass, z).real) for z in (a, y)]
    guyan = abs(a.conj().T @ mass @ y) / np.outer(*norm)
    error = abs(brake.matrix("cross_guyan", n) - guyan).max()
    check(error < 1e-3, f"masses: by Guyan's reduction likewise, to {error:.1g}")


def check_pairs(brake):
    """Order, frequencies, damping, turned shapes."""
    nodes, n = brake.sensors(25), len(brake.freq)
    order = np.random.default_rng(2).permutation(n)
    factor = np.where(np.arange(n) % 2, 1.03, 0.98)
    correlate(brake.out, *brake.write(nodes, brake.shapes[order][:, nodes] * np.exp(1j * np.arange(n))[:, None, None],
                                      (factor * brake.freq)[order], 0.02))
    rows = [row for row in table(brake.out / "correlate/correlate.csv") if row["measured"]]
    right = [row["mode"] == brake.rows[k]["mode"] and math.isclose(float(row["freq_difference_percent"]), 100 * (1 / factor[k] - 1),
                                                                   abs_tol=1e-9)
             for k, row in zip(order, rows)]
    check(all(right), f"pairs: {sum(right)} of {n} modes in another order and with other frequencies are found, errors of frequency are "
          f"right")
    given = [float(brake.rows[k]["damping_ratio"]) for k in order]
    check(all(math.isclose(float(row["damping_difference_percent"]), 100 * (x / 0.02 - 1), rel_tol=1e-6, abs_tol=1e-6) for row,
              x in zip(rows, given)),
          "pairs: errors of damping")
    apart = np.diff(brake.freq) / brake.freq[1:]
    near = int(np.argmin(np.where(apart > 1e-6, apart, 1)))  # not the two of a lock-in
    group = 110 * apart[near]
    two = brake.shapes[near:near + 2, nodes] / np.linalg.norm(brake.shapes[near:near + 2, nodes].reshape(2, -1), axis=1)[:, None, None]
    correlate(brake.out, *brake.write(nodes, [(two[0] + two[1]), (two[0] - two[1])], brake.freq[near:near + 2]), "--group", group)
    rows = [row for row in table(brake.out / "correlate/correlate.csv") if row["measured"]]
    check(all(row["mode"] and float(row["mac_group"]) > 1 - 1e-9 and float(row["mac"]) < 0.95 for row in rows),
          "pairs: of two close modes whose shapes "
          f"were turned, MAC {', '.join(row['mac'][:5] for row in rows)}, with their group 1")


def check_expansion(brake):
    """A sum of modes, and what no mode has."""
    nodes, n = brake.sensors(25), len(brake.freq)
    y = brake.shapes[:, nodes].reshape(n, -1).T
    outside = np.random.default_rng(4).normal(size=len(y)) + 0j
    outside -= y @ np.linalg.lstsq(y, outside, rcond=None)[0]
    base = y[:, 3] + 0.1 * y[:, 5]
    outside *= 0.3 * np.linalg.norm(base) / np.linalg.norm(outside)
    correlate(brake.out, *brake.write(nodes, [(base + outside).reshape(-1, 3)], brake.freq[3:4]), "--vtu")
    row = table(brake.out / "correlate/correlate.csv")[0]
    check(math.isclose(float(row["expansion_residual"]), 0.3 / math.hypot(1, 0.3), rel_tol=1e-9),
          "expand: what no mode has is the residual")
    with h5py.File(brake.out / "correlate/expanded.h5") as file:
        key = f"mode_{int(row['mode']):03d}"
        shape = file[f"{key}_re"][:].astype(float) + 1j * file[f"{key}_im"][:]
    error = 1 - mac(shape, brake.shapes[3] + 0.1 * brake.shapes[5])
    check(error < 1e-10 and (brake.out / "correlate/vtu/modes.pvd").is_file(),
          f"expand: the rest comes back at all nodes, MAC 1 to {error:.1g}")


def responses_file(brake, values, freq, binary, numerator):
    """Responses along -z at the places of both probes, force along -z at the first."""
    omega = 2j * np.pi * freq
    data = universal.nodes({4: (0.115, 0, 0), 9: (-0.115, 0, 0)})
    for label, column in zip((4, 9), values):
        data += universal.function(freq, -column * omega**{8: 0, 11: 1, 12: 2}[numerator], (label, -3), (4, 3), binary=binary,
                                   numerator=numerator,
                                   even=not binary)
    path = brake.folder / "frf.unv"
    path.write_bytes(data)
    return path


def check_responses(brake):
    """Own responses as displacement, velocity and acceleration, and others."""
    rows = table(brake.out / "frf.csv")
    freq = np.array([float(row["freq_hz"]) for row in rows])
    own = [np.array([complex(float(row[f"{probe}_z_re_m_n"]), float(row[f"{probe}_z_im_m_n"])) for row in rows]) for probe in "ab"]
    for binary, numerator in (("<", 8), (">", 12), ("", 11)):
        correlate(brake.out, responses_file(brake, own, freq, binary, numerator))
        found = table(brake.out / "correlate/responses.csv")
        error, level = (max(abs(float(row[name]) - x) for row in found) for name, x in (("frac", 1), ("level_db", 0)))
        check(len(found) == 2 and error < (1e-12 if binary else 1e-9) and level < 1e-6,
              f"exact: FRAC of own responses by {'binary ' + binary if binary else 'text'}, quantity {numerator}, is 1 to {error:.1g}")
    other = [2 * column + np.roll(column, 7) for column in own]
    correlate(brake.out, responses_file(brake, other, freq, "<", 8))
    found = table(brake.out / "correlate/responses.csv")
    right = [math.isclose(float(row["frac"]), mac(a, b), rel_tol=1e-9) and
             math.isclose(float(row["level_db"]), np.mean(20 * np.log10(abs(b) / abs(a))), rel_tol=1e-6) for row, a, b in zip(found,
                                                                                                                              other, own)]
    check(all(right), f"exact: FRAC {found[0]['frac'][:6]} and level {found[0]['level_db'][:6]} dB of other responses as numpy has them")
    correlate(brake.out, brake.out / "frf.csv")
    check(all(float(row["frac"]) > 1 - 1e-12 for row in table(brake.out / "correlate/responses.csv")), "exact: frf.csv beside itself")


def check_pictures(brake):
    """Trace lines are drawn; of frequencies alone, without sensors, one panel."""
    nodes = brake.sensors(8)
    path, _ = turned_file(brake, nodes, np.eye(3), np.zeros(3))
    pictures = []
    for more in (b"", universal.trace(range(1, 9))):
        path.write_bytes(path.read_bytes() + more)
        correlate(brake.out, path, drawn=True)
        pictures.append(picture.plt.imread(brake.out / "correlate/shapes.png"))
    check((pictures[0] != pictures[1]).any(axis=2).sum() > 1000, "pictures: trace lines of eight points are drawn")
    modes = brake.folder / "alone.csv"
    modes.write_text("freq_hz\n" + "".join(f"{1.02 * freq:.17g}\n" for freq in brake.freq))
    correlate(brake.out, modes, drawn=True)
    high, wide, _ = picture.plt.imread(brake.out / "correlate/correlate.png").shape
    check(wide < 1.3 * high, f"pictures: frequencies without sensors are one panel of {wide} by {high}")


def check_page(brake):
    """The report."""
    nodes = brake.sensors(25)
    correlate(brake.out, *brake.write(nodes, brake.shapes[:, nodes], brake.freq))
    page = brake.folder / "page.html"
    run_script(SOURCE / "scripts/report", [brake.out, "-o", page])
    text = page.read_text()
    check(all(f'id="r1-correlate{end}"' in text for end in ("-table", "-mac", "-shapes", "-data", "-viewer")),
          "page: table, matrix and moving shapes")


def check_bad(brake):
    """One line each."""
    nodes, folder = brake.sensors(3), brake.folder
    sensors, modes = brake.write(nodes, brake.shapes[:1, nodes], brake.freq[:1])
    bad = {}
    for name, text in (("empty.csv", ""), ("empty.unv", ""), ("text.unv", "hello\n"), ("nan.csv", "freq_hz,damping_ratio\nnan,0.1\n"),
                       ("percent.csv", "freq_hz,damping_ratio\n100,2.5\n"), ("word.csv", "freq_hz\nabc\n"), ("who.csv",
                                                                                                             "freq_hz,who\n100,1\n"),
                       ("axis.csv", "sensor,x,y,z,direction_x,direction_y,direction_z\na,0,0,0,0,0,0\n"), ("rows.csv", "freq_hz\n")):
        bad[name] = folder / name
        bad[name].write_text(text)
    for words, line in (((brake.out, folder / "none.unv"), "none.unv"), ((folder / "nowhere", modes), "no such folder"),
                        ((folder, sensors, modes), "modes.h5"), ((brake.out, modes), "no sensor of that name"), ((brake.out, sensors),
                                                                                                                 "no mode and no"),
                        ((brake.out, sensors, modes, modes), "two files"), ((brake.out, sensors, modes, "--parts", "dic"), "no such part"),
                        ((brake.out, sensors, modes, "--matrices", folder), "M.bin"),
                        ((brake.out, sensors, modes, "--points", "q=0,0,0"),
                         "no such point"), ((brake.out, sensors, modes, "--transform", "1,2"), "6 numbers"),
                        ((brake.out, sensors, modes, "--tolerance", "-1"), "above 0"), ((brake.out, sensors, modes, "--least", "nan"),
                                                                                        "must be"),
                        *(((brake.out, path), name) for name, path in bad.items())):
        said = run_script(SOURCE / "scripts/correlate", words)
        lines = said.stderr.strip().splitlines()
        check(said.returncode and line in lines[-1] and "Traceback" not in said.stderr and "not foreseen" not in said.stderr
              and (len(lines) == 1 or "usage" in lines[0]), f"bad: {lines[-1][:150] if lines else words}")


def main():
    with tempfile.TemporaryDirectory() as folder:
        brake = Brake(Path(folder) / "brake", "-modes_band", "500,9000", "-operators_save", "m")
        for part in (check_exact, check_axes, check_noise, check_masses, check_pairs, check_expansion, check_pictures, check_page,
                     check_bad):
            part(brake)
        check_responses(Brake(Path(folder) / "frf", *FRF))
    return 1 if FAULTS else 0


if __name__ == "__main__":
    with sooner(sys.argv[1]) as quick:
        sys.argv[1:] = [str(quick), str(Path(sys.argv[2]).resolve())]
        sys.exit(main())
