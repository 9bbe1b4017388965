#!/usr/bin/env python3
"""scripts/update on bodies of eight moduli, a row of blocks and a comb, whose measurements are made by squeal with other moduli:

  solve     its least squares beside scipy's on a made-up model, its covariance beside that of many random measurements, directions that
            are not told
  eight     eight moduli from 20 frequencies with 0.1 % noise, and shapes with 1 % noise at few sensors: to 0.3 % rms of the
            comb, whose teeth have modes of their own; of the row to what is stated
  held      modulus and density of a free body: only their ratio is told, a prior fixes it
  prior     an earlier update is the prior of the next
  damping   factors of Rayleigh damping from damping ratios
  onset     friction at lock-in, and how sure it is, beside a sweep of the brake that was measured
  bad       a line each

--coverage N makes N synthetic trials: of the 95 % intervals of moduli and of onsets 95 of 100 must hold the truth (binomial, 99 %).

    test_update.py SQUEAL MPIRUN [--coverage N]"""

import csv
import math
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np
import scipy.optimize
import scipy.stats
from forked import run_command, run_script
from small_brake import SCENE

SOURCE = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(SOURCE / "scripts"))
from squeal.update import solve  # noqa: E402

FAULTS = []
N = 8
NOISE = 1e-3
YOUNG = 2e11
SWEEP = "-analysis sweep -sweep_parameter contact_mu -sweep_values 0:1:11".split()
NAMES = [f"b{k}_young" for k in range(1, N + 1)]


def check(holds, what):
    print("ok  " if holds else "FAIL", what)
    if not holds:
        FAULTS.append(what)


CORNERS = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))


def row():
    """Cells by their lowest corner, with the number of their block: eight blocks of two in a row along x, each thinner than the one before;
    the face of a cell that is clamped, and the place of a corner."""
    cells = {(i, j, k): i // 2 + 1 for i in range(2 * N) for j in range(2) for k in range(2)}
    return cells, lambda i, j, k: (0, 3, 7, 4) if i == 0 else None, \
        lambda i, j, k: (0.02 * i, (0.03 - 0.001 * i) * (j - 1), (0.018 - 0.0005 * i) * (k - 1) + 2e-4 * i * i)


def comb():
    """Eight teeth of eight lengths along z on a back that is clamped below."""
    cells = {(i, j, k): N + 1 for i in range(3 * N - 1) for j in range(2) for k in range(2)}
    cells |= {(3 * n + i, j, 2 + k): n + 1 for n in range(N) for i in range(2) for j in range(2) for k in range(5 + n)}
    return cells, lambda i, j, k: (0, 1, 2, 3) if k == 0 else None, lambda i, j, k: (0.01 * i, 0.008 * j, 0.012 * k)


def write_mesh(path, cells, clamped, place):
    """In Gmsh's format 2.2; returns the places of the corners."""
    grid = sorted({tuple(np.add(cell, corner)) for cell in cells for corner in CORNERS})
    label = {corner: n for n, corner in enumerate(grid, 1)}
    last = max(cells.values())
    solids = [(5, tag, [label[tuple(np.add(cell, corner))] for corner in CORNERS]) for cell, tag in cells.items()]
    roots = [(3, last + 1, [label[tuple(np.add(cell, CORNERS[n]))] for n in clamped(*cell)]) for cell in cells if clamped(*cell)]
    names = [f'3 {k} "b{k}"' for k in range(1, last + 1)] + [f'2 {last + 1} "root"']
    path.write_text("\n".join(
        ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names)), *names, "$EndPhysicalNames", "$Nodes",
         str(len(grid)),
         *(f"{label[one]} {' '.join(repr(float(x)) for x in place(*one))}" for one in grid), "$EndNodes", "$Elements",
         str(len(solids) + len(roots)), *(f"{n} {kind} 2 {tag} {tag} {' '.join(map(str, nodes))}"
                                          for n, (kind, tag, nodes) in enumerate(solids + roots, 1)), "$EndElements", ""]))
    return np.array([place(*one) for one in grid]), last


class Bar:
    """The scene, and what is measured of it."""

    def __init__(self, folder, shape, every):
        self.folder = folder
        folder.mkdir()
        corners, last = write_mesh(folder / "bar.msh", *shape())
        self.sensors = corners[::every]
        text = "model: {mesh: bar.msh}\nparts: \"" + ",".join(f"b{k}" for k in range(1, last + 1)) + "\"\nmodes: {band: \"0,30000\"}\n"
        text += "".join(f"b{k}: {{young: {YOUNG:g}, poisson: 0.3, density: 7800}}\n" for k in range(1, last + 1))
        (folder / "free.yaml").write_text(text)
        (folder / "bar.yaml").write_text(text + "supports: clamp\nclamp: {set: root, fix: xyz}\n")

    def run(self, scene, out, values):
        """Rows of the modes and their shapes with these values of parameters."""
        words = [word for name, value in values.items() for word in (f"-{name}", f"{value:.17g}")]
        done = run_command([sys.argv[2], "-n", 1, sys.argv[1], "-options_file", scene, "-output_dir", out, *words], self.folder)
        if done.returncode:
            raise SystemExit(done.stderr)
        with (self.folder / out / "modes.csv").open(newline="") as lines:
            rows = list(csv.DictReader(lines))
        with h5py.File(self.folder / out / "modes.h5") as file:
            self.places = file["VTKHDF/Points"][:]
            return rows, [file[f"VTKHDF/PointData/mode_{int(row['mode']):03d}_re"][:] for row in rows]

    def measure(self, measured, rng, count=20, noise=NOISE):
        """Tables of sensors along two edges of the bar and of modes: frequencies, damping, shapes with 1 % noise."""
        rows, shapes = measured
        kept = [k for k, row in enumerate(rows) if float(row["freq_hz"]) > 1][:count]
        at = [np.argmin(((self.places - place)**2).sum(1)) for place in self.sensors]
        names = [f"{node}{axis}" for node in range(len(at)) for axis in "xyz"]
        with (self.folder / "sensors.csv").open("w") as out:
            out.write("sensor,x,y,z,direction_x,direction_y,direction_z\n")
            out.writelines(f"{name}," + ",".join(f"{x:.12g}" for x in (*self.places[at[n // 3]], *np.eye(3)[n % 3])) + "\n"
                           for n, name in enumerate(names))
        with (self.folder / "modes.csv").open("w") as out:
            out.write(",".join(["freq_hz", "damping_ratio", *names]) + "\n")
            for k in kept:
                shape = shapes[k][at].ravel()
                shape = shape + 0.01 * abs(shape).max() * rng.normal(size=shape.shape)
                freq, damping = (float(rows[k][name]) for name in ("freq_hz", "damping_ratio"))
                out.write(",".join(f"{x:.12g}" for x in (freq * (1 + noise * rng.normal()), damping * (1 + noise * rng.normal()), *shape))
                          + "\n")
        return "sensors.csv", "modes.csv"

    def update(self, *words, scene="bar.yaml", fails=False):
        """Rows of update.csv by parameter, and what was printed."""
        done = run_script(SOURCE / "scripts/update", [scene, "--measured", "sensors.csv", "modes.csv", "--program", sys.argv[1], "-o",
                                                      "update", *words],
                          self.folder)
        if (done.returncode != 0) != fails or "Traceback" in done.stderr or "not foreseen" in done.stderr:
            raise SystemExit(f"update {words}: {done.returncode}\n{done.stdout}{done.stderr}")
        if fails:
            return done.stderr
        with (self.folder / "update/update.csv").open(newline="") as lines:
            return {row["parameter"]: row for row in csv.DictReader(lines)}, done.stdout


class Brake(Bar):
    """A small brake whose moduli are measured at low friction, for its onsets over friction."""

    def __init__(self, folder):  # pylint: disable=super-init-not-called
        self.folder = folder
        folder.mkdir()
        (folder / "brake.yaml").write_text(SCENE + "modes: {band: \"500,9000\"}\n")
        self.run("brake.yaml", "first", {"contact_mu": 0.2})
        _, first, count = np.unique(self.places.round(9), axis=0, return_index=True, return_counts=True)
        self.sensors = self.places[np.random.default_rng(1).choice(first[count == 1], 20, replace=False)]

    def onsets(self, values):
        """Friction, frequency of each lock-in."""
        words = [word for name, value in values.items() for word in (f"-{name}", f"{value:.17g}")]
        run_command([sys.argv[2], "-n", 1, sys.argv[1], "-options_file", "brake.yaml", "-output_dir", "sweep", *SWEEP, *words], self.folder)
        with (self.folder / "sweep/onsets.csv").open(newline="") as lines:
            return [(float(row["critical_value"]), float(row["freq_hz"])) for row in csv.DictReader(lines) if row["kind"] == "lock_in"]


def check_solve():
    """Least squares alone: Y_i = ln sum_k a_ik exp(t_k)."""
    rng = np.random.default_rng(1)
    a, truth, s = rng.random((20, 4)), np.array([0.2, -0.1, 0.05, -0.3]), 1e-2

    def model(y):
        def predict(t):
            parts = a * np.exp(t)
            return solve.Predicted((y - np.log(parts.sum(axis=1))) / s, parts / parts.sum(axis=1)[:, None] / s, None)
        return predict

    prior = solve.Prior(np.zeros(4), np.diag([0, 25.0, 0, 0]))
    y = np.log((a * np.exp(truth)).sum(axis=1)) + s * rng.normal(size=20)
    found = solve.fit(model(y), prior, 100)
    other = scipy.optimize.least_squares(lambda t: np.append((y - np.log((a * np.exp(t)).sum(axis=1))) / s, 5 * t[1]), np.zeros(4),
                                         xtol=1e-14,
                                         ftol=1e-14, gtol=1e-14)
    error = abs(found.t - other.x).max() / np.sqrt(np.diag(found.covariance)).min()
    check(found.converged and error < 2e-2, f"solve: as scipy's least squares, to {error:.1g} of a standard deviation")
    flat, trials = solve.Prior(np.zeros(4), np.zeros((4, 4))), []
    for _ in range(400):
        trials.append(solve.fit(model(np.log((a * np.exp(truth)).sum(axis=1)) + s * rng.normal(size=20)), flat, 100).t)
    ratio = np.diag(np.cov(np.array(trials).T)) / np.diag(solve.fit(model(np.log((a * np.exp(truth)).sum(axis=1))), flat, 100).covariance)
    check(abs(ratio - 1).max() < 0.25, f"solve: variances of 400 trials are {', '.join(f'{x:.2f}' for x in ratio)} of the stated ones")
    a[:, 3] = 2 * a[:, 2]  # only a sum of both is told
    found = solve.fit(model(np.log((a * np.exp([0.1, 0.1, 0.1, 0.1])).sum(axis=1))), flat, 0.5)
    direction = found.held[0][1] / abs(found.held[0][1]).max()
    check(len(found.held) == 1 and abs(direction[:2]).max() < 1e-6 and abs(found.t[:2] - 0.1).max() < 1e-3,
          "solve: a direction that is not told is held")


def truth(rng):
    """Moduli 10 % about the scene's."""
    return dict(zip(NAMES, YOUNG * np.exp(rng.uniform(-0.1, 0.1, N))))


def check_eight(bar, name_of, demanded):
    """Eight moduli; how well they are told depends on the body."""
    rng = np.random.default_rng(11)
    values = truth(rng)
    bar.measure(bar.run("bar.yaml", "truth", values), rng)
    rows, said = bar.update("--parameters", ",".join(NAMES), "--noise", "0.1")
    error = np.array([100 * math.log(float(rows[name]["value"]) / values[name]) for name in NAMES])
    stated = np.array([float(rows[name]["deviation_percent"]) for name in NAMES])
    off, stated = np.sqrt((error**2).mean()), np.sqrt((stated**2).mean())
    check(off < demanded and off < 2 * stated, f"eight: moduli of a {name_of} from 20 frequencies with 0.1 % noise are {off:.3f} % rms "
          f"off, at most "
          f"{abs(error).max():.3f} %; stated {stated:.3f} %")
    print("    ", said.strip().splitlines()[-2])
    lines = (bar.folder / "update/update.yaml").read_text().splitlines()[1:]
    check(len(lines) == N, "eight: update.yaml has all of them")
    modes, _ = bar.run("bar.yaml", "again", {line.split(":")[0]: float(line.split(":")[1].strip(' "')) for line in lines})
    with (bar.folder / "update/update_data.csv").open(newline="") as file:
        data = {row["mode"]: row for row in csv.DictReader(file)}
    check(all(math.isclose(float(row["freq_hz"]), float(data[row["mode"]]["value"]), rel_tol=1e-9) for row in modes if row["mode"] in data),
          "eight: a run with update.yaml has the frequencies that are stated")


def check_held(bar):
    """A free bar of one modulus and one density: only their ratio is told."""
    rng = np.random.default_rng(3)
    bar.measure(bar.run("free.yaml", "truth", {"b1_young": 1.05 * YOUNG, "b1_density": 8000}), rng)
    rows, said = bar.update("--parameters", "b1_young,b1_density,b2_nothing", scene="free.yaml", fails=True), ""
    check("b2_nothing" in rows and "there are" in rows, "bad: a parameter that is none, with those that there are")
    both = ",".join(f"b{k}_{name}" for k in range(1, N + 1) for name in ("young", "density"))
    rows, said = bar.update("--parameters", both, scene="free.yaml")
    check("not identified" in said, "held: moduli and densities of all blocks together have directions that are not told, and said so")
    worst = next(line for line in said.splitlines() if "not identified:" in line)
    check(all(f"b{k}_young" in worst and f"b{k}_density" in worst for k in range(1, N + 1)) and worst.count("-") < 3,
          "held: that of all of them up by as much")
    check(all(row["low_95"] == "" for row in rows.values()),
          "held: no parameter with a part in that has an interval")
    check(all(float(row["deviation_percent"]) > 100 for row in rows.values()), "held: their deviations say that nothing is known")


def check_prior(bar):
    """Stages: the free bar, then the clamped one."""
    rng = np.random.default_rng(5)
    values = truth(rng)
    bar.measure(bar.run("free.yaml", "truth", values), rng, 8)
    first, _ = bar.update("--parameters", ",".join(f"{name}:20" for name in NAMES), scene="free.yaml")
    (bar.folder / "update").rename(bar.folder / "stage")
    bar.measure(bar.run("bar.yaml", "truth", values), rng, 6)
    alone, _ = bar.update("--parameters", ",".join(f"{name}:20" for name in NAMES))
    both, _ = bar.update("--parameters", ",".join(NAMES), "--prior", "stage/update.csv")
    sizes = [np.array([float(rows[name]["deviation_percent"]) for name in NAMES]) for rows in (first, alone, both)]
    error = [abs(math.log(float(both[name]["value"]) / values[name])) * 100 for name in NAMES]
    check((sizes[2] < np.minimum(sizes[0], sizes[1]) + 1e-9).all() and all(e < 4 * s for e, s in zip(error, sizes[2])),
          f"prior: {', '.join(f'{x.mean():.2f}' for x in sizes)} % of the free bar, the clamped one, and one after the other")


def check_damping(bar):
    """alpha and beta of the first block from damping ratios."""
    (bar.folder / "damped.yaml").write_text((bar.folder / "bar.yaml").read_text() + "b8_alpha: 30\nb1_beta: 1e-7\n")
    rng = np.random.default_rng(9)
    bar.measure(bar.run("damped.yaml", "truth", {"b8_alpha": 40.0, "b1_beta": 1.4e-7}), rng, noise=1e-2)
    rows, said = bar.update("--parameters", "b8_alpha,b1_beta", "--noise", "1", "--damping", "1", scene="damped.yaml")
    error = [100 * math.log(float(rows[name]["value"]) / x) for name, x in (("b8_alpha", 40), ("b1_beta", 1.4e-7))]
    stated = [float(rows[name]["deviation_percent"]) for name in ("b8_alpha", "b1_beta")]
    check(all(abs(e) < 4 * s and s < 5 for e, s in zip(error, stated)),
          f"damping: alpha and beta {error[0]:+.2f} and {error[1]:+.2f} % off, stated "
          f"{stated[0]:.2f} and {stated[1]:.2f} %")


def check_coverage(bar, count):
    """Intervals of synthetic trials."""
    inside, worst = [], []
    for trial in range(count):
        rng = np.random.default_rng(100 + trial)
        values = truth(rng)
        bar.measure(bar.run("bar.yaml", "truth", values), rng)
        rows, _ = bar.update("--parameters", ",".join(NAMES), "--noise", "0.1")
        inside += [float(rows[name]["low_95"]) <= value <= float(rows[name]["high_95"]) for name, value in values.items()]
        worst.append(np.sqrt(np.mean([math.log(float(rows[name]["value"]) / value)**2 for name, value in values.items()])))
    low, high = scipy.stats.binom.interval(0.99, len(inside), 0.95)
    check(low <= sum(inside) <= high, f"coverage: {sum(inside)} of {len(inside)} intervals of {count} trials hold the truth "
          f"({100 * np.mean(inside):.1f} %); "
          f"moduli {100 * np.sqrt(np.mean(np.square(worst))):.3f} % rms off")


def check_onset(folder, count):
    """Lock-ins over friction: how far the truth is, in stated standard deviations."""
    brake, apart = Brake(folder), []
    for trial in range(count):
        rng = np.random.default_rng(300 + trial)
        values = {"pad_young": 8e9 * math.exp(rng.uniform(-0.05, 0.05)), "disc_young": 2.1e11 * math.exp(rng.uniform(-0.01, 0.01)),
                  "beam_young": 2.1e11 * math.exp(rng.uniform(-0.01, 0.01))}
        brake.measure(brake.run("brake.yaml", "truth", {**values, "contact_mu": 0.2}), rng)
        brake.update("--parameters", ",".join(values), "--onset", "contact_mu=0:1:11", "-contact_mu", "0.2", scene="brake.yaml")
        truths = brake.onsets(values)
        with (brake.folder / "update/update_onsets.csv").open(newline="") as lines:
            for row in csv.DictReader(lines):
                near = [value for value, freq in truths if abs(freq / float(row["freq_hz"]) - 1) < 0.01]
                if row["kind"] == "lock_in" and row["deviation"] and len(near) == 1:
                    apart.append((float(row["critical_value"]) - near[0]) / float(row["deviation"]))
    inside = sum(abs(x) <= 1.96 for x in apart)
    low, _ = scipy.stats.binom.interval(0.99, len(apart), 0.95)
    said = f"{inside} within their 95 % intervals, {max(map(abs, apart), default=99):.1f} deviations off at most"
    check(len(apart) >= count and (inside >= low if count > 1 else max(map(abs, apart)) < 4),
          f"onset: {len(apart)} lock-ins of {count} brakes, {said}")


def main():
    coverage = int(sys.argv[4]) if len(sys.argv) > 4 else 0
    check_solve()
    with tempfile.TemporaryDirectory() as folder:
        bar = Bar(Path(folder) / "row", row, 19)
        if coverage:
            check_coverage(bar, coverage)
            check_onset(Path(folder) / "brake", max(coverage // 8, 1))
        else:
            check_eight(Bar(Path(folder) / "comb", comb, 23), "comb", 0.3)
            check_eight(bar, "row", 2)
            for part in (check_held, check_prior, check_damping):
                part(bar)
            check_onset(Path(folder) / "brake", 1)
    return 1 if FAULTS else 0


if __name__ == "__main__":
    sys.argv[1:3] = [str(Path(word).resolve()) for word in sys.argv[1:3]]
    sys.exit(main())
