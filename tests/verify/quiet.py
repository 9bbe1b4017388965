#!/usr/bin/env python3
"""Tables of -analysis quiet beside closed forms and scipy.

    quiet.py spin RESULTS          three parameters of options/affine.yaml: growth begins at k = w^2 (n^2 / c^2 - g n / c - e)
    quiet.py oscillator RESULTS    three parameters of options/quiet.yaml: two modes lock in at ((a - b) / 2)^2 + 1 - 4/3 mu = 0
    quiet.py ring RESULTS FOLDER   two parameters of tests/affine.py with the matrices in FOLDER: all eigenvalues on a dense grid, by scipy
    quiet.py spike RESULTS         growth where |p - 0.7315| < 1e-3, which no point that is looked at hits
    quiet.py crossing RESULTS      growth where |p - 1| < 2e-4: two modes lock in as they cross

No point of what is said to be quiet may grow, no point of what is said to be dangerous may not. Of the true one at least half must be
shown: the size of the largest box, the volume of the parts."""

import csv
import sys
from pathlib import Path

import numpy
import scipy.linalg

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import affine

N_RANDOM, GRID, HALF = 400000, 24, 0.5
BAND = 1.5 * 2 * numpy.pi  # rad/s, of the ring
NEUTRAL = 1e-3  # of k: growth within a damping ratio of 1e-5, which is no instability, ends there at the latest
FAULTS = []


def check(what, holds, value):
    print(f"{'ok  ' if holds else 'FAIL'} {what}: {value}")
    if not holds:
        FAULTS.append(what)


def read(path):
    with path.open(newline="") as table:
        return list(csv.DictReader(table))


def spin_margin(p):
    """Positive where it is stable."""
    speed, n, k = p
    return k - speed**2 * (n**2 / 0.25**2 - 0.1 * n / 0.25 - 0.01) + NEUTRAL


def oscillator_margin(p):
    mu, a, b = p
    return ((a - b) / 2)**2 + 1 - 4 / 3 * mu


def ring_margins(folder):
    """Growth at many points, of the matrices that the program has."""
    matrices = {name: matrix.toarray() for name, matrix in affine.model(int(folder.name)).items()}

    def margin(p):
        found = []
        for speed, friction in zip(*(numpy.ravel(values) for values in p)):
            stiffness = matrices["K1"] + friction * matrices["KR"] + speed**2 * matrices["KGEO"]
            damping = matrices["D1"] + matrices["DR"] / speed + speed * matrices["DG"]
            lower = -numpy.linalg.solve(matrices["M"].toarray() if hasattr(matrices["M"], "toarray") else matrices["M"],
                                        numpy.hstack([stiffness, damping]))
            n = len(stiffness)
            values = scipy.linalg.eigvals(numpy.vstack([numpy.hstack([numpy.zeros((n, n)), numpy.eye(n)]), lower]))
            band = values[(values.imag >= 0) & (values.imag <= BAND)]
            found.append((1e-5 * abs(band) - band.real).min() if len(band) else numpy.inf)
        return numpy.array(found).reshape(numpy.shape(p[0]))

    return margin


def ends(rows, low, high):
    return numpy.array([float(row[low]) for row in rows]), numpy.array([float(row[high]) for row in rows])


def true_size(margin, own, low, high, points):
    """How far from the scene's own values the nearest point is that grows, to 0.02, beside the box: the least of all points, each on
    its way to them."""
    reach = numpy.max(numpy.where(points < own, (own - points) / (own - low), (points - own) / (high - own)), axis=1)

    def grows(part):
        return (margin((own + (points - own) * (part / reach)[:, None]).T) < 0).any()

    best = next((part for part in numpy.linspace(0.04, 1, 25) if grows(part)), None)
    return 1.0 if best is None else best - 0.02 * grows(best - 0.02)


def box(folder, margin, n_points, n_faces):
    """The largest box, beside the true one; nothing inside grows; the dangerous point does."""
    rows, statement = read(folder / "quiet.csv"), read(folder / "quiet_statement.csv")[0]
    own = numpy.array([float(row["own"]) for row in rows])
    low, high = ends(rows, "lower", "upper")
    quiet_low, quiet_high = ends(rows, "quiet_lower", "quiet_upper")
    random = numpy.random.default_rng(1)
    inside = random.uniform(quiet_low, quiet_high, (n_points, len(own)))
    check("random points inside that grow", not (margin(inside.T) < 0).any(), f"of {n_points}")
    faces = random.uniform(-1, 1, (n_faces, len(own)))
    faces[numpy.arange(n_faces), random.integers(len(own), size=n_faces)] = random.choice([-1, 1], n_faces)
    corners = numpy.array(numpy.meshgrid(*[[-1, 1]] * len(own))).reshape(len(own), -1).T
    points = numpy.vstack([corners, faces])
    size = true_size(margin, own, low, high, numpy.where(points < 0, own + points * (own - low), own + points * (high - own)))
    stated = float(statement["size"])
    check("size beside the true one", HALF * size <= stated <= size * 1.001, f"{stated:.4g} of {size:.4g} (to 0.02)")
    if statement["danger_distance"]:
        danger = numpy.array([float(row["danger"]) for row in rows])
        check("the dangerous point grows", margin(danger) < 1.001 * NEUTRAL, danger)
        check("a little nearer nothing does", margin(own + 0.98 * (danger - own)) >= 0, statement["danger_distance"])
        check("it is the nearest", float(statement["danger_distance"]) <= 1.03 * size, f"{statement['danger_distance']} and {size:.4g}")
        check("confirmed by a full solution", statement["confirmed"] == "yes", statement["full_growth_rad_s"])
    check("random points of the model", statement["random_unstable"] == "0" and statement["full_unstable"] == "0", statement["random"])


def parts(folder, margin, n_points):
    """Cells: what each says holds at random points of it, and enough of what is quiet is shown."""
    cells, rows = read(folder / "quiet_cells.csv"), read(folder / "quiet.csv")
    names = [row["variable"] for row in rows]
    low, high = ends(rows, "lower", "upper")
    random = numpy.random.default_rng(2)
    volume = dict.fromkeys(("quiet", "dangerous", "open"), 0.0)
    points = {state: [] for state in volume}
    for cell in cells:
        a, b = (numpy.array([float(cell[f"{side}_{name}"]) for name in names]) for side in ("lower", "upper"))
        volume[cell["state"]] += numpy.prod((b - a) / (high - low))
        points[cell["state"]].append(random.uniform(a, b, (max(2, n_points // len(cells)), len(names))))
    check("cells fill the box", abs(sum(volume.values()) - 1) < 1e-9, volume)
    check("no point of a quiet cell grows", not (margin(numpy.vstack(points["quiet"]).T) < 0).any(), len(points["quiet"]))
    if points["dangerous"]:
        check("each point of a dangerous cell does", (margin(numpy.vstack(points["dangerous"]).T) < 0).all(), len(points["dangerous"]))
    share = (margin(random.uniform(low, high, (n_points, len(names))).T) >= 0).mean()
    check("volume beside the true one",
          HALF * share <= volume["quiet"] <= share + 3 / n_points**0.5, f"{volume['quiet']:.4f} of {share:.4f}")


SPIKES = {"spike": (0.7315, 1e-3), "crossing": (1, 2e-4)}  # where growth is, half width


def spike(which, folder):
    """No quiet cell, and no part of the quiet box, reaches into the spike; next to it much is quiet."""
    row, statement = read(folder / "quiet.csv")[0], read(folder / "quiet_statement.csv")[0]
    at, half = SPIKES[which]
    own, low, high = (float(row[name]) for name in ("own", "quiet_lower", "quiet_upper"))
    reaches = [cell for cell in read(folder / "quiet_cells.csv") if cell["state"] == "quiet"
               and float(cell["lower_p"]) < at + 0.99 * half and float(cell["upper_p"]) > at - 0.99 * half]
    check("no quiet cell reaches into the spike", not reaches, reaches[:1])
    check("nor does the box", high < at - 0.99 * half or low > at + 0.99 * half, (low, high))
    check("the box comes near", max(abs(at - own) - (own - low if at < own else high - own) - half, 0) < 0.05 * abs(at - own), (low, high))
    check("found, or declared", statement["confirmed"] == "yes" or float(statement["open_share"]) > 0, statement["confirmed"])
    return 1 if FAULTS else 0


def main(which, folder, matrices=None):
    folder = Path(folder)
    if which in SPIKES:
        return spike(which, folder)
    margin = {"spin": lambda: spin_margin, "oscillator": lambda: oscillator_margin,
              "ring": lambda: ring_margins(Path(matrices))}[which]()
    statement = read(folder / "quiet_statement.csv")[0]
    n_points = GRID**2 if which == "ring" else N_RANDOM
    if statement["goal"] == "box":
        box(folder, margin, *((n_points // 4, 2 * GRID) if which == "ring" else (n_points // 10, n_points // 10)))
    else:
        parts(folder, margin, n_points // 2 if which == "ring" else n_points)
    return 1 if FAULTS else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
