#!/usr/bin/env python3
"""What the page computes of reduced_model.bin beside squeal's own numbers: growth in the middle of each cell of quiet_cells.csv, or all
modes of sweep.csv or samples_modes.csv, to 1e-9 of the largest frequency, by node; how many contact pairs are closed there, and where
along each parameter the status of the nearest point changes, beside a look at many values; and that the JavaScript of the page has the
same eigenvalues as scipy's QZ at one point. With `page`, where there is a Chromium, the page of the folder is opened: its sliders give
the same modes, it states how many values a second it computes, says where it extrapolates, and of which contact status it is. Without
node it says so.

    reduced_model.py RESULTS [page]
    reduced_model.py RESULTS points    the points of a file of many samples whose contact status it has, beside samples.csv"""

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

sys.path[:0] = [str(Path(__file__).resolve().parents[1]), str(Path(__file__).resolve().parents[2] / "scripts")]
from browser import Browser, find_browser
from squeal.report.model_file import ReducedModel

SOURCE = Path(__file__).resolve().parents[2] / "scripts/squeal/report"
MOST, SAMPLES = 60, 15  # cells, samples that are looked at
MAP = 2000  # points of more that the file has
NODE = """
const fs = require("fs"), read = name => fs.readFileSync(`${process.argv[1]}/${name}.js`), file = fs.readFileSync(process.argv[2]);
const {readModel, modesAt, statusAt, statusesAlong} = new Function("module",
  ["dense", "hessenberg", "follow", "statuses", "reduced"].map(read).join("") + "; return module.exports;")({});
const model = readModel(file.buffer.slice(file.byteOffset, file.byteOffset + file.length));
const closed = [], at = p => { const modes = modesAt(model, p); closed.push(model.status?.closed); return modes; };
const points = JSON.parse(fs.readFileSync(0)), begun = Date.now(), found = points.map(at);
const seconds = (Date.now() - begun) / 1000, far = (a, b) => a.length !== b.length ? 1 : Math.max(0, ...a.map(mode => Math.min(
  ...b.map(other => Math.hypot(mode.growth - other.growth, 2 * Math.PI * (mode.freq - other.freq)) / model.high))));
let [moved, followed, apart] = [0, 0, 0];
for (const goal of points.slice(0, 12)) {  // as a slider moves, from one point to the other in steps
  for (let k = 1, own = points[0]; k <= STEPS; k++, moved++) {
    const p = own.map((value, i) => value + k / STEPS * (goal[i] - value)), modes = modesAt(model, p, {moving: true}), last = model.before;
    if (model.followed) { followed++; apart = Math.max(apart, far(modes, modesAt(model, p))); model.before = last; }
  }
}
let [looks, wrong, changes] = [0, 0, 0];
for (const p of model.contact ? points.slice(0, 5) : []) model.parameters.forEach(({lower, upper}, i) => {
  const along = statusesAlong(model, p, i), wide = upper - lower;
  changes += along.length - 1;
  for (let k = 0; k <= 500; k++, looks++) {
    const q = p.slice(), value = q[i] = lower - 0.25 * wide + k / 500 * 1.5 * wide;
    const near = along.some(([from]) => Math.abs(from - value) < 1e-9 * wide);
    if (!near && statusAt(model, q).number !== along.filter(([from]) => from <= value).pop()[1]) wrong++;
  }
});
console.log(JSON.stringify({found, seconds, moved, followed, apart, closed, looks, wrong, changes}));
""".replace("STEPS", "8")


def by_scipy(model, p):
    """Eigenvalues of the band, by QZ of the companion form."""
    (K, C, M), h = model.at(p), model.head["high"]
    one, none = numpy.eye(len(K)), numpy.zeros(K.shape)
    values = scipy.linalg.eigvals(numpy.block([[none, h * one], [-K / h, -C]]), numpy.block([[one, none], [none, M]]))
    return numpy.array(sorted((v for v in values if model.head["low"] <= v.imag <= h), key=lambda v: v.imag))


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
    """Whether the page has these modes at the scene's own values (None: where statuses differ, it says which) and says what is outside."""
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
            status = modes or until(browser, "(text => text.includes('away') && text)(document.querySelector('.contact-line').textContent)")
            faults = list(browser.faults())
        finally:
            browser.close()
    print(f"page: {own}; {outside}; {rate}; {status if modes is None else ''}; {faults}")
    return bool(own and outside and "extrapolates" in outside and re.search(r"computed at [\d.]+ values a second$", rate) and not faults
                and (re.search(r"^Contact status \d+ of \d+: \d+ of \d+ pairs closed, as at .* of the ranges away\.$", status or "")
                     if modes is None else numpy.allclose(own, [mode["freq"] for mode in modes], atol=6e-4)))


def by_node(node, folder, points):
    """What reduced.js has at some points."""
    done = subprocess.run([node, "-e", NODE, str(SOURCE), str(folder / "reduced_model.bin")], input=json.dumps(points),
                          capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def rows_of(path, key):
    """Eigenvalues of a table by what their column `key` says, and pairs closed there, where it has them."""
    values, closed = {}, {}
    with path.open(newline="") as table:
        for row in csv.DictReader(table):
            values.setdefault(float(row[key]), []).append(complex(float(row["growth_rad_s"]), 2 * numpy.pi * float(row["freq_hz"])))
            if row.get("n_closed"):
                closed[float(row[key])] = row["n_closed"]
    return values, list(closed.values())


def closed_of(path):
    """Pairs closed at each sample."""
    with path.open(newline="") as table:
        return {float(row["sample"]): row["n_closed"] for row in csv.DictReader(table)}


def compared(folder, model, node, points, values):
    """Distance of all modes at points, how many they are; the answer."""
    answer, worst, n_modes = by_node(node, folder, points), 0.0, 0
    for modes, given in zip(answer["found"], values, strict=True):
        own = numpy.array([complex(mode["growth"], 2 * numpy.pi * mode["freq"]) for mode in modes])
        worst = max(worst, max(min(abs(own - value)) for value in given)) if len(own) == len(given) else numpy.inf
        n_modes += len(given)
    print(f"{n_modes} modes at {len(points)} points: they differ by {worst:.1e} rad/s of {model.head['high']:.4g}")
    return worst if n_modes else numpy.inf, answer


def changes(answer, closed, least):
    """Whether pairs closed are those of the table at each point, and the page says right where its statuses change."""
    own = answer["closed"]
    if len(own) != len(closed):
        print(f"pairs closed: {len(closed)} in the table, {len(own)} points")
        return False
    other = sum(str(a) != b for a, b in zip(own, closed))
    print(f"pairs closed: {min(own)} to {max(own)}, {other} of {len(closed)} not those of the table; {answer['changes']} changes along the "
          f"sliders, {answer['wrong']} of {answer['looks']} looks disagree")
    return not other and not answer["wrong"] and answer["changes"] >= least and min(own) < max(own)


def sweep(folder, model, node):
    """All modes of a sweep of one parameter, and of those linked with it."""
    values, closed = rows_of(folder / "sweep.csv", "value")
    worst, answer = compared(folder, model, node, [[value] * len(model.head["parameters"]) for value in values], values.values())
    kept = not model.contact or changes(answer, closed, len(set(closed)) - 1)
    return 0 if kept and worst <= 1e-9 * model.head["high"] and follows(answer, 0.5 if model.contact else 0.8) else 1


def samples(folder, model, node):
    """All modes of samples, which are the points of the map; then the page."""
    values, _ = rows_of(folder / "samples_modes.csv", "sample")
    table = closed_of(folder / "samples.csv")
    first = model.contact.points[[int(sample) - 1 for sample in values]][:SAMPLES]
    worst, answer = compared(folder, model, node, first.tolist(), list(values.values())[:SAMPLES])
    closed = [table[sample] for sample in values][:SAMPLES]
    return 0 if worst <= 1e-9 * model.head["high"] and changes(answer, closed, 1) and page_says(folder, None) else 1


def known(folder, model):
    """Points of the map beside samples.csv, whose variables are all the parameters: of more than MAP samples some MAP, with own statuses,
    and the scene itself."""
    with (folder / "samples.csv").open(newline="") as table:
        rows = list(csv.DictReader(table))
    values, contact = numpy.array([[float(text) for text in list(row.values())[7:]] for row in rows]), model.contact
    own = (contact.points == [entry["value"] for entry in model.head["parameters"]]).all(1)
    points, statuses = contact.points[~own], contact.status[~own]
    nearest = [numpy.argmin(abs((values - point) / contact.wide).max(1)) for point in points]
    apart = max(abs((values[i] - point) / contact.wide).max() for i, point in zip(nearest, points))
    other = sum(str(contact.n_closed(status)) != rows[i]["n_closed"] for i, status in zip(nearest, statuses))
    missing = {row["n_closed"] for row in rows} - {str(contact.n_closed(status)) for status in contact.status}
    halves = numpy.mean(contact.places > 0.5, axis=0)
    print(f"{len(contact.points)} points of {len(rows)} samples: {apart:.1e} of the ranges apart, {other} with other pairs closed; "
          f"no point has {missing or 'none'} closed; above the middle {halves}")
    return 0 if 0.98 * MAP < len(contact.points) < 1.02 * MAP < len(rows) and len(set(nearest)) == len(nearest) and apart < 1e-12 and \
        own.sum() == 1 and not other and not missing and abs(halves - 0.5).max() < 0.05 else 1


def follows(answer, least=0.8):
    """Whether modes followed in small steps are those of the whole problem, nearly always."""
    print(f"{answer['followed']} of {answer['moved']} steps followed, within {answer['apart']:.1e} of the largest frequency")
    return answer["followed"] >= least * answer["moved"] > 0 and answer["apart"] <= 1e-9


def main(folder, page=False, points=False):
    node = shutil.which("node")
    if points:
        return known(folder, ReducedModel(folder / "reduced_model.bin"))
    if not node:
        print("no node: nothing is compared")
        return 0
    model = ReducedModel(folder / "reduced_model.bin")
    head, names = model.head, [entry["name"] for entry in model.head["parameters"]]
    for table, look in (("sweep.csv", sweep), ("samples_modes.csv", samples)):
        if (folder / table).exists():
            return look(folder, model, node)
    with (folder / "quiet_cells.csv").open(newline="") as table:
        cells = [row for row in csv.DictReader(table) if row["growth_rad_s"]][:MOST]
    points = [[entry["value"] for entry in head["parameters"]]]
    points += [[0.5 * (float(cell[f"lower_{name}"]) + float(cell[f"upper_{name}"])) for name in names] for cell in cells]
    answer, worst = by_node(node, folder, points), 0.0
    for cell, modes in zip(cells, answer["found"][1:]):
        values = [complex(mode["growth"], 2 * numpy.pi * mode["freq"]) for mode in modes]
        excess = [value.real - max(head["limit_growth"], head["limit_ratio"] * abs(value)) for value in values]
        worst = max(worst, abs(modes[int(numpy.argmax(excess))]["growth"] - float(cell["growth_rad_s"])))
    values = by_scipy(model, points[0])
    own = numpy.array([mode["growth"] + 2j * numpy.pi * mode["freq"] for mode in answer["found"][0]])
    far = max((min(abs(own - value)) for value in values), default=0)
    print(f"{len(cells)} points of {head['n_used']} vectors: growth differs by {worst:.1e} rad/s of {head['high']:.4g}, from scipy by "
          f"{far:.1e}; {len(cells) / answer['seconds']:.1f} a second")
    return 0 if cells and len(values) == len(own) and follows(answer) and \
        worst <= 1e-9 * head["high"] and far <= 1e-7 * head["high"] and (not page or page_says(folder, answer["found"][0])) else 1


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), "page" in sys.argv[2:], "points" in sys.argv[2:]))
