#!/usr/bin/env python3
"""Shapes of a reduced model, reduced_shapes.h5, beside those of modes in full, modes.h5, at the scene's own values: of every mode by the
eigenvectors of scipy; and, where there is a Chromium, the shape that the sliders of the page show of the mode that grows most and of
one that is chosen. Both up to a complex factor, by 1 - |a'b|^2 / (a'a b'b). Of samples also that no probability is left open by errors.

    reduced_shapes.py RESULTS MODES"""

import csv
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy
import scipy.linalg

sys.path[:0] = [str(Path(__file__).resolve().parents[1]), str(Path(__file__).resolve().parents[2] / "scripts")]
from browser import Browser, find_browser
from squeal.mesh.bodies import Scene, Skin
from squeal.report.model_file import ReducedModel
from verify.reduced_model import until

SHOWN = """(() => {
  const stage = stages[document.querySelector('.sliders').dataset.shapes], {re, im, title} = stage.bodies.shapes[0];
  return [title, Array.from(re), Array.from(im)];
})()"""
FAR, SEEN = 1e-5, 2e-3  # of vectors of an error of rtol; of what 1 % of the length leaves out


def far(a, b):
    """How much of a is beside b."""
    a, b = a.ravel(), b.ravel()
    return 1 - abs(numpy.vdot(a, b))**2 / (numpy.vdot(a, a).real * numpy.vdot(b, b).real)


def in_model(folder):
    """Eigenvalues and shapes [nodes][3] of the model at the scene's own values."""
    model = ReducedModel(folder / "reduced_model.bin")
    n, (K, C, M) = model.head["n_used"], model.at([entry["value"] for entry in model.head["parameters"]])
    assert not C.any()
    kappa, vectors = scipy.linalg.eig(K, M)
    values = 1j * numpy.sqrt(kappa)  # of each pair of conjugates of kappa one that grows and one that decays
    with h5py.File(folder / "reduced_shapes.h5") as file:
        V = numpy.stack([file[f"VTKHDF/PointData/vector_{k:03d}"][:] for k in range(1, n + 1)], axis=2)
    return values, V @ vectors


def page_shows(folder, skin, rows, shapes):
    """Largest distance of what the page shows from modes in full: at first, and of a row that is clicked."""
    if not find_browser():
        print("no Chromium: no page is opened")
        return 0
    with tempfile.TemporaryDirectory() as name, Browser(find_browser()) as browser:
        page = Path(name, "page.html")
        subprocess.run([Path(__file__).resolve().parents[2] / "scripts/report", folder, "-o", page], check=True, stdout=subprocess.DEVNULL)
        browser.open(page.as_uri(), 1000)
        worst = 0
        for chosen in (max(range(len(rows)), key=lambda k: float(rows[k]["growth_rad_s"])), 3):
            until(browser, "document.querySelector('.sliders tbody tr.chosen') !== null")
            if worst:
                browser.run(f"document.querySelectorAll('.sliders tbody tr')[{chosen}].click()")
                until(browser, f"document.querySelectorAll('.sliders tbody tr')[{chosen}].classList.contains('chosen')")
            title, re, im = browser.run(SHOWN)
            shown = (numpy.array(re) + 1j * numpy.array(im)).reshape(-1, 3)
            here = far(shown, skin.moved(shapes[chosen]))
            print(f"page: {title}, {rows[chosen]['freq_hz']} Hz in full: {here:.1e} beside it")
            worst = max(worst, here)
        faults = list(browser.faults())
    print("\n".join(faults), end="")
    return 1 if faults else worst


def left_open(folder):
    """Samples, of all branches, of which probability.csv does not know whether they grow."""
    path = folder / "probability.csv"
    if not path.exists():
        return 0
    with path.open(newline="") as table:
        rows = list(csv.DictReader(table))
    print(f"{len(rows)} branches, samples left open: {[row['open'] for row in rows]}")
    return sum(int(row["open"]) for row in rows)


def main(folder, full):
    values, moved = in_model(folder)
    with (full / "modes.csv").open(newline="") as table:
        rows = list(csv.DictReader(table))
    with h5py.File(full / "modes.h5") as file:
        data, skin = file["VTKHDF/PointData"], Skin(Scene(file, "disc"))
        shapes = [data[f"mode_{int(row['mode']):03d}_re"][:] + 1j * data[f"mode_{int(row['mode']):03d}_im"][:] for row in rows]
    worst = 0
    for row, shape in zip(rows, shapes, strict=True):
        value = complex(float(row["growth_rad_s"]), 2 * numpy.pi * float(row["freq_hz"]))
        k = numpy.argmin(abs(values**2 - value**2))  # kappa tells the one that grows from the one that decays
        worst = max(worst, far(moved[..., k], shape))
    shown = page_shows(folder, skin, rows, shapes)
    print(f"{len(rows)} modes: shapes are at most {worst:.1e} beside those in full")
    return 0 if rows and worst < FAR and shown < SEEN and not left_open(folder) else 1


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), Path(sys.argv[2])))
