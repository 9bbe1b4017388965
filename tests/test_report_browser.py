#!/usr/bin/env python3
"""The page of scripts/report in Chromium, 1280 and 400 points wide, light and dark: breaks when a picture has no size
or is blank, the page is wider than its window, something is asked of the network, an error or a warning is told,
a table does not sort, a shape does not move or is not chosen, a mark tells nothing, or the printed page loses its
pictures.

    test_report_browser.py SQUEAL MPIRUN

Exit status 77, skipped, without a Chromium: 98 MB that nothing else needs, hence not in scripts/packages.txt."""

import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib.image
import numpy
from brake_results import SOURCE, make_results
from browser import Browser, find_browser

SIZES = """[...document.querySelectorAll("svg.chart, canvas, img")].map(e => [e.closest("figure")?.id ?? e.className,
  e.tagName, e.getBoundingClientRect().width, e.getBoundingClientRect().height])"""
WIDER = """[...document.querySelectorAll("body *")].filter(e => !e.closest(".scroll, .gallery, nav, svg, #tip") &&
  e.getBoundingClientRect().right > innerWidth + 1).map(e => `${e.tagName} ${e.id} ${e.className}`)"""
INK = """[...document.querySelectorAll("canvas")].map(e => {
  const copy = new OffscreenCanvas(e.width, e.height).getContext("2d", {willReadFrequently: true});
  copy.drawImage(e, 0, 0);
  const points = copy.getImageData(0, 0, e.width, e.height).data;
  return points.filter((value, i) => i % 4 === 3 && value > 0).length / (e.width * e.height); })"""
SORT = """(() => { const out = []; for (const table of document.querySelectorAll("table.sortable"))
  for (const header of table.querySelectorAll("th")) for (const turn of ["ascending", "descending"]) {
    header.querySelector("button").click();
    const i = [...header.parentElement.children].indexOf(header);
    out.push([table.id, header.textContent, turn, header.getAttribute("aria-sort"),
      [...table.tBodies[0].rows].map(row => row.children[i].dataset.value ?? row.children[i].textContent)]); }
  return out; })()"""


class Test:
    """Keeps what is wrong."""

    def __init__(self, browser):
        self.browser, self.faults = browser, []

    def check(self, holds, what):
        print("ok  " if holds else "FAIL", what)
        if not holds:
            self.faults.append(what)

    def quiet(self, what):
        """No error, no warning, no request."""
        faults = list(self.browser.faults())
        self.check(not faults, f"{what}: nothing is told or asked for {faults[:2]}")


def drawn(browser):
    """Share of each canvas that is drawn on; what is drawn late, as the first page of a slow browser, has a minute."""
    for _ in range(60):
        browser.wait(1)
        ink = browser.run(INK)
        if len(ink) > 5 and min(ink) > 0.02:
            break
    return ink


def check_window(t, url, width, scheme):
    """Sizes at one width."""
    t.browser.open(url, width, 900, prefers_color_scheme=scheme, prefers_reduced_motion="reduce")
    t.browser.run("document.querySelectorAll('.gallery').forEach(e => { e.style.maxHeight = 'none'; })")
    height = t.browser.run("document.documentElement.scrollHeight")
    t.browser.ask("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
    ink = drawn(t.browser)
    name = f"{width} points, {scheme}"
    sizes = t.browser.run(SIZES)
    seen = [size for size in sizes if size[2] > 0]
    hidden = {size[0] for size in sizes} - {size[0] for size in seen}
    small = [size for size in seen if size[2] < 60 or size[3] < 40]
    t.check(len(seen) > 10 and not hidden and not small, f"{name}: {len(seen)} pictures have size {small} {hidden}")
    t.check(len(ink) > 5 and min(ink) > 0.02, f"{name}: no canvas is blank, least ink {min(ink):.3f}")
    wider = t.browser.run(WIDER)
    t.check(t.browser.run("document.documentElement.scrollWidth") == width and not wider,
            f"{name}: nothing is wider than the window {wider[:3]}")
    background = t.browser.run("getComputedStyle(document.body).backgroundColor")
    light = sum(map(int, background.strip("rgb()").split(","))) > 3 * 128
    t.check(light == (scheme == "light"), f"{name}: background {background}")
    t.quiet(name)


def in_order(values, turn):
    """Whether values are sorted: as numbers where all are, those that are missing last."""
    texts = [value for value in values if value.strip() and value != "nan"]
    if values[:len(texts)] != texts:
        return False
    try:
        texts = list(map(float, texts))
        return texts == sorted(texts, reverse=turn == "descending")
    except ValueError:
        return len(texts) < 2 or texts[0].lower()[:1] <= texts[-1].lower()[:1] or turn == "descending"


def check_tables(t):
    """Each heading sorts its column, twice the other way round."""
    sorted_ = t.browser.run(SORT)
    wrong = [s[:3] for s in sorted_ if s[2] != s[3] or not in_order(s[4], s[2])]
    t.check(len(sorted_) > 20 and not wrong, f"{len(sorted_)} sorted columns {wrong[:3]}")


def check_shapes(t):
    """The viewer: other shapes are other pictures, a phase of half a turn too, and a row of the table chooses."""
    shot = "stages['r1-viewer'].canvas.toDataURL()"
    t.browser.run("stages['r1-viewer'].host.scrollIntoView(); stages['r1-viewer'].seek(0)")
    t.browser.wait(0.3)
    pictures = [t.browser.run(shot)]
    for act in ("stages['r1-viewer'].seek(180)", "document.querySelector('#r1-table tr[data-shape=\"13\"]').click()",
                "stages['r1-viewer'].set('scale', 0.3)", "stages['r1-viewer'].set('colour', 'parts')"):
        t.browser.run(act)
        t.browser.wait(0.4)
        pictures.append(t.browser.run(shot))
    t.check(len(set(pictures)) == len(pictures), "phase, choice, exaggeration and colour change the picture")
    t.check("Mode 13," in t.browser.run("document.querySelector('#r1-viewer .note').textContent"),
            "a row chooses its shape")
    t.browser.run("stages['r1-viewer'].set_playing(true)")
    moving = []
    for _ in range(3):
        t.browser.wait(0.3)
        moving.append(t.browser.run(shot))
    t.check(len(set(moving)) > 1, "the shape moves")
    t.browser.run("stages['r1-viewer'].set_playing(false)")


def check_tip(t):
    """A mark tells its numbers."""
    t.browser.run("document.documentElement.style.scrollBehavior = 'auto'")
    x, y = t.browser.run("""(() => { const dot = document.querySelector('#r1-eigenvalues svg.wide circle.vermilion');
      dot.scrollIntoView({block: 'center'}); const box = dot.getBoundingClientRect();
      return [box.x + box.width / 2 + 4, box.y + box.height / 2]; })()""")
    t.browser.wait(0.5)
    t.browser.ask("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)
    told = t.browser.run("(e => e.hidden ? '' : e.textContent)(document.getElementById('tip'))")
    t.check("UNSTABLE" in told, f"a mark tells '{told}'")


def check_painter(t, url):
    """Without WebGL the quads are painted, and the page looks much the same."""
    t.browser.ask("Page.addScriptToEvaluateOnNewDocument", source="""const get = HTMLCanvasElement.prototype.getContext;
      HTMLCanvasElement.prototype.getContext = function(kind, ...rest) {
        return kind.startsWith("webgl") ? null : get.call(this, kind, ...rest); };""")
    t.browser.open(url, 1280, prefers_reduced_motion="reduce")
    t.browser.run("stages['r1-viewer'].host.scrollIntoView()")
    t.browser.wait(1)
    ink = t.browser.run(INK)
    t.check(not t.browser.run("Boolean(glass.gl)") and ink[1] > 0.02, f"without WebGL: ink {ink[1]:.3f}")
    t.quiet("without WebGL")


def check_print(t, url, folder):
    """On paper: several pages with ink on each, nothing dark."""
    t.browser.open(url, 1280, 900, prefers_color_scheme="dark", prefers_reduced_motion="reduce")
    t.browser.wait(1)
    t.browser.pdf(folder / "page.pdf")
    head = (folder / "page.pdf").read_bytes()
    n_pages = head.count(b"/Type /Page\n") or head.count(b"/Type /Page ") or head.count(b"/Type /Page/")
    t.check(head.startswith(b"%PDF") and n_pages > 1 and len(head) > 50000,
            f"printed: {n_pages} pages, {len(head)} bytes")
    t.browser.ask("Emulation.setEmulatedMedia", media="print",
                  features=[{"name": "prefers-color-scheme", "value": "dark"}])
    t.browser.picture(folder / "print.png", full=False)
    points = matplotlib.image.imread(folder / "print.png")[:, :, :3]
    t.check(numpy.median(points) > 0.95, "printed on white")


def main():
    program = find_browser()
    if not program:
        print("skipped: no Chromium; apt-get install chromium-headless-shell")
        return 77
    squeal, mpirun = (Path(word).resolve() for word in sys.argv[1:3])
    with tempfile.TemporaryDirectory(prefix="squeal-") as name, Browser(program) as browser:
        folder, t = Path(name), Test(browser)
        names = ("modes", "static", "sweep", "transient", "frf", "map")
        make_results(squeal, mpirun, folder, ("filters", *names))
        subprocess.run(["/usr/bin/python3", SOURCE / "scripts/report", *names, "-o", "page.html"], cwd=folder,
                       check=True)
        url = (folder / "page.html").as_uri()
        for width, scheme in ((1280, "dark"), (400, "light"), (1280, "light")):
            check_window(t, url, width, scheme)
        t.browser.ask("Emulation.setDeviceMetricsOverride", width=1280, height=900, deviceScaleFactor=1, mobile=False)
        check_tip(t)
        check_shapes(t)
        check_tables(t)
        t.quiet("after all clicks")
        check_print(t, url, folder)
        check_painter(t, url)
    print("\n".join(t.faults) or "all as it should be")
    return 1 if t.faults else 0


if __name__ == "__main__":
    sys.exit(main())
