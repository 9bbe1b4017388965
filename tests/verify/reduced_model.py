#!/usr/bin/env python3
"""What the page computes of reduced_model.bin beside squeal's own numbers: growth in the middle of each cell of quiet_cells.csv, or all
modes of sweep.csv, to 1e-9 of the largest frequency, by node; and that the JavaScript of the page has the same eigenvalues as scipy's
QZ at one point. With `page`, where there is a Chromium, the page of the folder is opened: its sliders give the same modes, it states how
many values a second it computes, and says where it extrapolates. Without node it says so.

    reduced_model.py RESULTS [page]"""

import csv
import json
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy
import scipy.linalg

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from browser import Browser, find_browser

SOURCE = Path(__file__).resolve().parents[2] / "scripts/squeal/report"
MOST = 60  # cells
NODE = """
const fs = require("fs"), read = name => fs.readFileSync(`${process.argv[1]}/${name}.js`), file = fs.readFileSync(process.argv[2]);
const {readModel, modesAt} = new Function("module",
  ["dense", "hessenberg", "follow", "reduced"].map(read).join("") + "; return module.exports;")({});
const model = readModel(file.buffer.slice(file.byteOffset, file.byteOffset + file.length));
const points = JSON.parse(fs.readFileSync(0)), begun = Date.now(), found = points.map(p => modesAt(model, p));
const seconds = (Date.now() - begun) / 1000, far = (a, b) => a.length !== b.length ? 1 : Math.max(0, ...a.map(mode => Math.min(
  ...b.map(other => Math.hypot(mode.growth - other.growth, 2 * Math.PI * (mode.freq - other.freq)) / model.high))));
let [moved, followed, apart] = [0, 0, 0];
for (const goal of points.slice(0, 12)) {  // as a slider moves, from one point to the other in steps
  for (let k = 1, own = points[0]; k <= STEPS; k++, moved++) {
    const p = own.map((value, i) => value + k / STEPS * (goal[i] - value)), modes = modesAt(model, p, {moving: true}), last = model.before;
    if (model.followed) { followed++; apart = Math.max(apart, far(modes, modesAt(model, p))); model.before = last; }
  }
}
console.log(JSON.stringify({found, seconds, moved, followed, apart}));
""".replace("STEPS", "8")


def read(path):
    """Head, matrices."""
    data = path.read_bytes()
    end = data.index(b"\n")
    model = json.loads(data[:end])
    return model, numpy.frombuffer(data[end + 1:]).reshape(len(model["terms"]), model["n"], model["n"]).transpose(0, 2, 1)


def by_scipy(model, matrices, p):
    """Eigenvalues of the band, by QZ of the companion form."""
    n, sums = model["n_used"], {"K": 0, "C": 0, "M": 0}
    for term, matrix in zip(model["terms"], matrices):
        c = term["scale"] * numpy.prod([(abs(p[i]) if absolute else p[i])**power for i, power, absolute in term["factors"]])
        sums[term["kind"]] = sums[term["kind"]] + c * matrix[:n, :n]
    h, one, none = model["high"], numpy.eye(n), numpy.zeros((n, n))
    A = numpy.block([[none, h * one], [-sums["K"] / h, -sums["C"] * one if numpy.isscalar(sums["C"]) else -sums["C"]]])
    values = scipy.linalg.eigvals(A, numpy.block([[one, none], [none, sums["M"]]]))
    return numpy.array(sorted((v for v in values if model["low"] <= v.imag <= model["high"]), key=lambda v: v.imag))


def until(browser, script):
    """Its value, when that is something."""
    end = time.monotonic() + 60
    while time.monotonic() < end:
        value = browser.run(script)
        if value:
            return value
        browser.wait(0.2)
    return None


def page_says(folder, modes):
    """Whether the page has these modes at the scene's own values, and says what is outside."""
    if not find_browser():
        print("no Chromium: no page is opened")
        return True
    with tempfile.TemporaryDirectory() as name:
        page = Path(name, "page.html")
        subprocess.run([SOURCE.parents[1] / "report", folder, "-o", page], check=True, stdout=subprocess.DEVNULL)
        browser = Browser(find_browser())
        try:
            browser.open(page.as_uri(), 1000)
            own = until(browser, "[...document.querySelectorAll('.sliders tbody tr')].map(row => Number(row.cells[0].textContent))")
            browser.run("(s => {s.value = s.max; s.dispatchEvent(new Event('input'))})(document.querySelector('.sliders input'))")
            outside = until(browser, "document.querySelector('.sliders .beyond-line')?.textContent")
            rate = browser.run("document.querySelector('.sliders .said').textContent")
            faults = list(browser.faults())
        finally:
            browser.close()
    print(f"page: {own}; {outside}; {rate}; {faults}")
    return bool(own and outside and "extrapolates" in outside and re.search(r"computed at [\d.]+ values a second$", rate) and not faults
                and numpy.allclose(own, [mode["freq"] for mode in modes], atol=6e-4))


def by_node(node, folder, points):
    """What reduced.js has at some points."""
    done = subprocess.run([node, "-e", NODE, str(SOURCE), str(folder / "reduced_model.bin")], input=json.dumps(points),
                          capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def sweep(folder, model, node):
    """All modes of a sweep of one parameter, and of those linked with it."""
    rows = {}
    with (folder / "sweep.csv").open(newline="") as table:
        for row in csv.DictReader(table):
            rows.setdefault(float(row["value"]), []).append(complex(float(row["growth_rad_s"]), 2 * numpy.pi * float(row["freq_hz"])))
    worst, n_modes = 0.0, 0
    answer = by_node(node, folder, [[value] * len(model["parameters"]) for value in rows])
    for modes, given in zip(answer["found"], rows.values(), strict=True):
        values = numpy.array([complex(mode["growth"], 2 * numpy.pi * mode["freq"]) for mode in modes])
        if len(values) != len(given):
            print(f"{len(values)} modes for {len(given)}")
            return 1
        worst, n_modes = max(worst, max(min(abs(values - value)) for value in given)), n_modes + len(given)
    print(f"{n_modes} modes at {len(rows)} values: they differ by {worst:.1e} rad/s of {model['high']:.4g}")
    return 0 if n_modes and worst <= 1e-9 * model["high"] and follows(answer) else 1


def follows(answer):
    """Whether modes followed in small steps are those of the whole problem, nearly always."""
    print(f"{answer['followed']} of {answer['moved']} steps followed, within {answer['apart']:.1e} of the largest frequency")
    return answer["followed"] >= 0.8 * answer["moved"] > 0 and answer["apart"] <= 1e-9


def main(folder, page=False):
    node = shutil.which("node")
    if not node:
        print("no node: nothing is compared")
        return 0
    model, matrices = read(folder / "reduced_model.bin")
    names = [entry["name"] for entry in model["parameters"]]
    if (folder / "sweep.csv").exists():
        return sweep(folder, model, node)
    with (folder / "quiet_cells.csv").open(newline="") as table:
        cells = [row for row in csv.DictReader(table) if row["growth_rad_s"]][:MOST]
    points = [[entry["value"] for entry in model["parameters"]]]
    points += [[0.5 * (float(cell[f"lower_{name}"]) + float(cell[f"upper_{name}"])) for name in names] for cell in cells]
    answer, worst = by_node(node, folder, points), 0.0
    for cell, modes in zip(cells, answer["found"][1:]):
        values = [complex(mode["growth"], 2 * numpy.pi * mode["freq"]) for mode in modes]
        excess = [value.real - max(model["limit_growth"], model["limit_ratio"] * abs(value)) for value in values]
        worst = max(worst, abs(modes[int(numpy.argmax(excess))]["growth"] - float(cell["growth_rad_s"])))
    values = by_scipy(model, matrices, points[0])
    own = numpy.array([mode["growth"] + 2j * numpy.pi * mode["freq"] for mode in answer["found"][0]])
    far = max((min(abs(own - value)) for value in values), default=0)
    print(f"{len(cells)} points of {model['n_used']} vectors: growth differs by {worst:.1e} rad/s of {model['high']:.4g}, from scipy by "
          f"{far:.1e}; {len(cells) / answer['seconds']:.1f} a second")
    return 0 if cells and len(values) == len(own) and follows(answer) and \
        worst <= 1e-9 * model["high"] and far <= 1e-7 * model["high"] and (not page or page_says(folder, answer["found"][0])) else 1


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), "page" in sys.argv[2:]))
