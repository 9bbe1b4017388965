#!/usr/bin/env python3
"""What the studies of speed against error share, on made-up points and a matrix with known eigenvalues:

  sentences  name the cheapest setting that reaches an error and the cheapest of other methods, or say that none does; costs within
             5 % are the same
  files      table and picture hold all points
  redraw     makes picture and sentences anew from the table, runs nothing, and says what is missing
  page       scripts/study/all has sentences, picture and what a study printed; of one that failed its status and message
  exact      eigenvalues 4 sin^2(k pi / (2 n + 2)) of a chain of masses, damped by alpha, from guesses of ten digits, to 1e-15; what is
             no eigenvalue is not taken for one; a run with a mode too few or too many errs by 1
  struck     a mass on a spring hit with 1 m/s: in time sin(omega t) / omega, in steps of central differences their recursion

Breaks when a dearer setting is named, when an exact value only repeats its guess, or when a reference is that of another scheme."""

import math
import sys
import tempfile
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import scipy.sparse

SOURCE = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(SOURCE / "scripts"), str(SOURCE / "tests")]
from check import Failure, require
from forked import run_script
from squeal.modes.exact_modes import worst
from squeal.modes.exact import refined
from squeal.mesh.petsc_matrix import write_matrix
from squeal.modes.speed_error import Point, draw, sentence, write_points
from squeal.transient.struck_body import Struck

POINTS = [Point("fast", "a", 1e-3, 1.0, 2.0), Point("fast", "b", 1e-6, 3.0, 6.0), Point("exact", "c", 1e-9, 4.0, 8.0),
          Point("dear", "d", 1e-4, 9.0, 18.0)]
SAID = ((1e-2, "take fast with -x a: 2 units (error 0.001); exact needs 8 with -x c, dear 18."),
        (1e-5, "take fast with -x b: 6 units (error 1e-06); exact needs 8 with -x c."), (1e-8, "take exact with -x c: 8 units"),
        (1e-8, "no other method is so exact"), (1e-12, "reached by none of these; the least is 1e-09, of exact with -x c"),
        ((1e-5, "fast"), "of fast take -x b: 6 units (error 1e-06); no other setting is so exact."),
        ((1e-2, "fast"), "take -x a: 2 units (error 0.001); -x b, the dearest of those that reach it, needs 6."))
# Costs within 5 %: the most exact of them is named, the others by method, neighbours as first to last; methods that do not compete
ALIKE = [*(Point("many", f"{k}", 10.0**-k, 1.0, 2 + 0.01 * (k % 3)) for k in range(1, 7)), Point("one", "e", 1e-4, 1.0, 2.05),
         Point("slow", "f", 1e-9, 1.0, 2.2), Point("slow", "g", 1e-5, 1.0, 2.25), Point("slow", "h", 1e-5, 1.0, 4.4)]
SAID_ALIKE = (
    (1.0, "take many with -x 6: 2 units (error 1e-06); as cheap within 5 %: many with -x 1 to 5, one with -x e; slow needs 2.2 with -x f."),
    (1e-5, "take many with -x 6: 2 units (error 1e-06); as cheap within 5 %: many with -x 5; slow needs 2.2 with -x f."),
    ((1e-4, "many"), "of many take -x 6: 2 units (error 1e-06); all 3 settings that reach it cost the same within 5 %."),
    ((1e-2, "many"), "of many take -x 6: 2 units (error 1e-06); all 5 settings that reach it cost the same within 5 %."),
    ((1e-4, "slow"), "of slow take -x f: 2.2 units (error 1e-09); as cheap within 5 %: -x g; "
     "-x h, the dearest of those that reach it, needs 4.4."),
    ((1e-3, ("one", "slow")), "take one with -x e: 2.05 units (error 0.0001); slow needs 2.2 with -x f."),
    ((1e-3, ("one",)), "take one with -x e: 2.05 units (error 0.0001); no other method is so exact."))


def sentences(_):
    for points, expected in ((POINTS, SAID), (ALIKE, SAID_ALIKE)):
        for level, said in expected:
            text = sentence(points, level, "-x ")
            require(said in text, f"{level}: '{text}' does not say '{said}'")


def files(folder):
    write_points(folder / "study.csv", POINTS)
    lines = (folder / "study.csv").read_text().splitlines()
    require(len(lines) == 5 and lines[3] == "exact,c,1.000000e-09,4.0000,8.0000", f"table: {lines}")
    draw(folder / "study.png", "made up", "error", POINTS)
    require((folder / "study.png").stat().st_size > 5000, "the picture has nothing on it")


def redraw(folder):
    study = [run_script(SOURCE / "scripts/study/integrator", ["--redraw", "--output", folder])]
    write_points(folder / "study.csv", POINTS)
    (folder / "study.txt").write_text("Old\nWhat the reference is.\nAn old sentence.\n")
    study.append(run_script(SOURCE / "scripts/study/integrator", ["--redraw", "--output", folder]))
    require(study[0].returncode == 1 and "study.csv: no such file" in study[0].stderr, f"without a table: {study[0].stderr}")
    title, about, first, *_ = (folder / "study.txt").read_text().splitlines()
    require(study[1].returncode == 0 and title == "Integrator in time: the parameter b and the step" and about == "What the reference is."
            and first.startswith("For an error of 0.01 take fast with -dynamics_step_fraction a:"), f"drawn again: {title} {about} {first}")
    require((folder / "study.png").stat().st_size > 5000, "drawn again: the picture has nothing on it")


def page(folder):
    loader = SourceFileLoader("study_all", str(SOURCE / "scripts/study/all"))
    every = module_from_spec(spec_from_loader("study_all", loader))
    loader.exec_module(every)
    draw(folder / "study.png", "made up", "error", POINTS)
    (folder / "study.txt").write_text("Made up\nThe reference is 1 < 2.\nTake fast.\n")
    (folder / "none").mkdir()
    studies = [every.Study("study/ranks", folder, 0, 3.0, "printed"), every.Study("study/reduced", folder / "none", 1, 3.0, "no <mesh>")]
    text = every.page(studies, SimpleNamespace(quick=True))
    for said in ("<li>Take fast.</li>", "data:image/png;base64,", "1 &lt; 2", "status 1", "no &lt;mesh&gt;", "scripts/study/ranks"):
        require(said in text, f"the page has no {said}")


def exact(folder):
    n, alpha = 60, 0.01
    ones = np.ones(n)
    chain = scipy.sparse.diags([-ones[1:], 2 * ones, -ones[1:]], [-1, 0, 1])
    for name, matrix in (("K", chain), ("M", scipy.sparse.eye(n)), ("C", alpha * scipy.sparse.eye(n))):
        write_matrix(folder / f"{name}.bin", matrix)
    values = [-alpha / 2 + 1j * math.sqrt((2 * math.sin(k * math.pi / (2 * n + 2)))**2 - alpha**2 / 4) for k in (1, 7, 30, 60)]
    found = refined(folder, 0.0, [value * (1 + 3e-11) for value in values])
    far = abs(found / np.array(values) - 1)
    require(far.max() < 1e-15, f"a chain of masses: {far}")
    between = refined(folder, 0.0, [(values[0] + values[1]) / 2])
    require(np.isnan(between).all(), f"{between} is taken for an eigenvalue")
    require(worst(found, found) == 0 and worst(found[1:], found) == worst(found, found[1:]) == 1, "a mode too few or too many is no error")


def struck(folder):
    (folder / "one").mkdir()
    write_matrix(folder / "one/K.bin", scipy.sparse.diags([4.0, 9.0, 25.0]))
    write_matrix(folder / "one/M.bin", scipy.sparse.eye(3))
    body, omega, step = Struck(folder / "one"), 5.0, 0.01
    times = np.arange(400) * step
    require(abs(body.at(times)[:, 2] - np.sin(omega * times) / omega).max() < 1e-14, "a mass on a spring in time")
    u = [0.0, step]
    while len(u) < 400:
        u.append(2 * u[-1] - u[-2] - (omega * step)**2 * u[-1])
    require(abs(body.stepped(np.arange(400), step)[:, 2] - u).max() < 1e-11, "a mass on a spring in steps")
    rows = [{"time_s": t, "tip_z_m": value} for t, value in zip(times, u)]
    body.find(rows)
    require(body.tip == 2 and body.error_of_steps(rows, step) < 1e-11 < body.error(rows) < 1e-2, "errors of a history")


def main():
    with tempfile.TemporaryDirectory() as folder:
        for part in (sentences, files, redraw, page, exact, struck):
            (Path(folder) / part.__name__).mkdir()
            part(Path(folder) / part.__name__)
            print(part.__name__)


if __name__ == "__main__":
    try:
        main()
    except Failure as failure:
        sys.exit(str(failure))
