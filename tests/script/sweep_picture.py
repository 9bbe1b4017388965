#!/usr/bin/env python3
"""Draws made-up sweeps with scripts/plot/sweep and checks what the pictures show. Which modes of these sweeps are
unstable, and where, follows from the closed form in made_up_sweep.py. Exit status: 0, or 1.
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy
from drawing import drawn, fails, points_like, require
from made_up_sweep import FIRST, LAST, PAIRS, POINTS, onsets, write_sweep
from matplotlib.colors import to_hex
from matplotlib.text import Annotation, Text
from squeal.sweep import lines as sweep_lines, map as sweep_map, tables as sweep_tables # found by drawing
from squeal.picture import VERMILION

VALUES = numpy.linspace(FIRST, LAST, POINTS)


def red_points(colours):
    """How many points have the colour of what is unstable."""
    return points_like(colours, VERMILION)


def flutters(pair, mu):
    """Which of VALUES lie between the onsets of a pair."""
    inside = numpy.zeros(POINTS, bool)
    for value, kind in onsets(mu, pair):
        inside ^= VALUES > value
    return inside


def lines(folder, band=None, labels="auto", render=False, at=None):
    """The axes of the picture of one parameter, where asked for after it was rendered."""
    with plt.rc_context(sweep_tables.FONTS):
        figure = sweep_lines.draw_lines(sweep_tables.Study(folder, band, at), ["frequency", "growth"], labels)
        if render:
            figure.canvas.draw()
    return figure.axes


def red_lines(axes):
    """The lines of what is unstable."""
    return [line for line in axes.lines if to_hex(line.get_color()) == VERMILION.lower() and line.get_lw() == 3]


def marked(line):
    """Which points of a red line have a marker."""
    return line.get_markevery() & ~numpy.isnan(line.get_xdata())


def reds(folder, **options):
    """How many points are marked in the panels of frequency and growth."""
    return [sum(marked(line).sum() for line in red_lines(axes)) for axes in lines(folder, **options)]


def test_colours(root):
    """Red is what flutters: breaks when stable modes are marked, when nothing is, or when --band is ignored."""
    write_sweep(root / "flutter", mu=0.5)
    write_sweep(root / "quiet", mu=0)
    for options in ((), ("--band", "2500,6000"), ("--growth-only",), ("--frequency-only", "--labels", "all")):
        require(red_points(drawn("plot/sweep", root / "flutter", *options)) > 500, f"nothing is marked with {options}")
    require(red_points(drawn("plot/sweep", root / "quiet", "--growth-only")) == 0, "a mode is marked although there is no friction")
    quiet = drawn("plot/sweep", root / "flutter", "--band", "6000,13000", "--growth-only")
    require(red_points(quiet) == 0, "a mode is marked outside its band")
    for name, band, some in (("flutter", [2500, 6000], True), ("quiet", None, False), ("flutter", [6000, 13000], False)):
        found = reds(root / name, band=band)
        require(found[0] == found[1] and (found[0] > 0) == some, f"{found} points of {name} are marked in the two panels in band {band}")


def test_marks(root):
    """The marked points of each panel are those between the onsets in closed form, to which their lines reach, `numerical` ones
    excepted, and one branch with errors of 10 Hz has bars: breaks when rows are mixed up, classes ignored, or all or no bars drawn."""
    write_sweep(root / "numerical", mu=0.5, error_hz={5: 60, 1: 10})
    expected = numpy.sort(numpy.concatenate([VALUES[flutters(pair, 0.5)] / 1e9 for pair in PAIRS[:2]]))
    critical = numpy.sort([value / 1e9 for pair in PAIRS[:2] for value, _ in onsets(0.5, pair)])
    for axes in lines(root / "numerical"):
        red = red_lines(axes)
        x = numpy.concatenate([line.get_xdata()[marked(line)] for line in red])
        ends = numpy.concatenate([line.get_xdata()[~line.get_markevery() & ~numpy.isnan(line.get_xdata())] for line in red])
        unsure = numpy.concatenate([line.get_xdata() for line in axes.lines if line.get_mfc() == "white"
                                    and line.get_mec() == VERMILION])
        same = len(x) == len(expected) and numpy.allclose(numpy.sort(x), expected)
        require(same, "other points are red than those that flutter")
        same = len(ends) == len(critical) and numpy.allclose(numpy.sort(ends), critical)
        require(same, f"what is red ends at {ends} instead of the onsets {critical}")
        expected_unsure = VALUES[flutters(PAIRS[2], 0.5)] / 1e9
        same = len(unsure) == len(expected_unsure) and numpy.allclose(unsure, expected_unsure)
        require(same, "other points are hollow than the numerical ones")
    bars = len(lines(root / "numerical", band=[2500, 6000])[0].containers)
    require(bars == 1, f"{bars} branches have error bars instead of one")


def test_texts(root):
    """No two labels overlap, and none leaves the picture: breaks when they are not spread."""
    for labels in ("auto", "all"):
        for axes in lines(root / "flutter", labels=labels, render=True):
            texts = [text for text in axes.texts if isinstance(text, Annotation)]
            require(len(texts) >= 3, f"{len(texts)} labels only")
            boxes = [Text.get_window_extent(text) for text in texts]
            overlaps = sum(a.overlaps(b.padded(-1)) for i, a in enumerate(boxes) for b in boxes[:i])
            require(overlaps == 0, f"{overlaps} labels overlap")
            require(all(axes.figure.bbox.containsx(box.x1) for box in boxes), "a label leaves the picture")


def test_scale(root):
    """Equal ratios give a logarithmic axis, equal steps a linear one."""
    write_sweep(root / "ratios", values=numpy.geomspace(FIRST, LAST, 20))
    scales = [lines(root / name)[0].get_xscale() for name in ("ratios", "flutter")]
    require(scales == ["log", "linear"], f"scales {scales}")


def test_jumps(root):
    """Grey lines stand where the contact status changes, at the onset if there is one, else half way from the point
    before: breaks when the column is ignored, or a jump counts as an onset that was not confirmed."""
    write_sweep(root / "jumps", jumps=[(VALUES[20], [VALUES[20] - 1e8]), (VALUES[50], [])])
    expected = [(VALUES[20] - 1e8) / 1e9, (VALUES[49] + VALUES[50]) / 2e9]
    for axes in lines(root / "jumps"):
        upright = [line.get_xdata()[0] for line in axes.lines if list(line.get_ydata()) == [0, 1]
                   and line.get_linestyle() == "-"]
        require(numpy.allclose(upright, expected), f"lines at {upright} instead of {expected}")
        require(not any("not confirmed" in text.get_text() for text in axes.texts), "a jump is called not confirmed")
    legend = [text.get_text() for text in axes.get_legend().get_texts()]
    require({"contact status changes", "jump of growth"} < set(legend), f"legend {legend}")


def test_full(root):
    """A sweep solved in full follows no branches: its points are marked all the same."""
    write_sweep(root / "full", mu=0.5)
    (root / "full/onsets.csv").unlink()
    table = root / "full/sweep.csv"
    head, *rows = [line.split(",") for line in table.read_text().splitlines()]
    at = head.index("branch")
    table.write_text("\n".join(",".join(row) for row in [head, *([*row[:at], "", *row[at + 1:]] for row in rows)]) + "\n")
    require(red_points(drawn("plot/sweep", root / "full")) > 100, "nothing is marked")


def test_map(root):
    """Two parameters: the map is unstable exactly where the closed form is, and --at draws one line of it."""
    mu = numpy.linspace(0, 1, 6)
    write_sweep(root / "map", second=mu)
    red = [red_points(drawn("plot/sweep", root / "map", "--growth-only", "--at", at)) for at in ("0.61", "0")]
    require(red[0] > 500, "nothing is marked on a line of the map")
    require(red[1] == 0, "a mode is marked although there is no friction")
    for at, some in ((0.61, True), (0, False)):
        found = reds(root / "map", at=at)
        require(found[0] == found[1] and (found[0] > 0) == some, f"{found} points are marked in the two panels at {at}")
    drawn("plot/sweep", root / "map")
    grid = sweep_map.Grid(sweep_tables.Study(root / "map", None, None))
    for pair in PAIRS:
        expected = numpy.array([flutters(pair, value) for value in mu])
        require((grid.families[pair[-1]] == expected).all(), f"the region of {pair[-1]} is another one")
    require(((grid.border() > 0) == (grid.growth > 0)).all() and (grid.border() < 0).any(), "another border")


def test_errors(root):
    """What cannot be drawn ends in one line that names it."""
    sweep = root / "quiet" / "sweep.csv"
    text = sweep.read_text()
    cases = [(text, "--band 90000,91000", "--band 90000,91000"), (text, "--at 0.5", "--at 0.5"),
             (text[:-20], "", "line 3"), ("", "", "is empty"), (text.split("\n")[0] + "\n", "", "no rows"),
             (text.replace("freq_hz", "hertz", 1), "", "no column freq_hz"),
             (text.replace(",stable,", ",stable,x", 1), "", "line 2: error_hz")]
    for content, options, expected in cases:
        sweep.write_text(content)
        fails("plot/sweep", root / "quiet", options.split(), expected)
    sweep.unlink()
    fails("plot/sweep", root / "quiet", [], f"{sweep}: no such file")


def main():
    with tempfile.TemporaryDirectory() as folder:
        for test in (test_colours, test_marks, test_texts, test_scale, test_jumps, test_full, test_map, test_errors):
            test(Path(folder))


if __name__ == "__main__":
    main()
