#!/usr/bin/env python3
"""Draws made-up frequency responses with scripts/plot/frf and checks what the pictures show and how bad tables fail.
The response is that of one oscillator, 1 / (k (1 - r^2 + 2 i d r)). Exit status: 0, or 1.
"""

import tempfile
from pathlib import Path

import numpy
from drawing import drawn, fails, points_like, require
from squeal.response import frf_tables # found by drawing
from squeal.picture import BLUE, GREEN, GREY, VERMILION


def write(folder, outputs=1, coherence=False, error=1e-9, peaks=True):
    """frf.csv of oscillators at 300, 600, ... Hz, and peaks.csv."""
    folder.mkdir(exist_ok=True)
    names = [f"{probe}_{axis}" for probe in ("tip", "edge", "foot") for axis in "xyz"][:outputs]
    columns = [f"{name}_{part}" for name in names
               for part in ("re_m_n", "im_m_n", *(("coherence",) if coherence else ()))]
    lines = [",".join(["freq_hz", *columns, "error_m_n", "error_relative"])]
    for freq in numpy.linspace(10, 1500, 400):
        row = [freq]
        for k in range(outputs):
            r = freq / (300 * (k + 1))
            value = 1e-8 / (1 - r**2 + 0.04j * r)
            row += [value.real, value.imag, *([1 / (1 + r / 20)] if coherence else [])]
        lines.append(",".join(f"{x:.15g}" for x in [*row, error * abs(value), error]))
    (folder / "frf.csv").write_text("\n".join(lines) + "\n")
    rows = [f'{300 * (k + 1)},2.5e-7,{k + 1},{300 * (k + 1)},0.02,"(0,{k + 2}+)"' for k in range(outputs)]
    head = "freq_hz,magnitude_m_n,mode,mode_freq_hz,damping_ratio,label"
    (folder / "peaks.csv").write_text("\n".join([head, *(rows if peaks else [])]) + "\n")
    return folder


def points(folder, colours, *options):
    """How many points have each of the colours."""
    found = drawn("plot/frf", folder, *options)
    return [points_like(found, c) for c in colours]


def test_lines(root):
    """A colour for each output, grey only for an error that can be seen; breaks when outputs are mixed up or lost."""
    folder = write(root / "three", outputs=3)
    colours = (BLUE, VERMILION, GREEN, GREY)
    every = points(folder, colours)
    require(min(every[:3]) > 300 and every[3] < 100, f"three outputs: {every} points")
    one = points(folder, colours, "--outputs", "tip_y", "--band", "100,900")
    require(one[0] > 300 and max(one[1:]) < 100, f"one output: {one} points")
    many = points(write(root / "many", outputs=8), (GREY,))
    require(many[0] < 100, f"one of eight outputs has the colour of the error: {many} points")
    seen = points(write(root / "wrong", error=0.3), (GREY,))
    require(seen[0] > 100, f"a large error is not drawn: {seen}")


def test_millimetres(root):
    """mm/N of a scene in mm, t, s and MPa become m/N; breaks when scene.yaml is not asked."""
    folder = write(root / "millimetres")
    metres = frf_tables.Responses(folder)
    (folder / "scene.yaml").write_text('# units: mm, t, s, N, MPa\nparts: "disc"\n')
    found = frf_tables.Responses(folder)
    same = [numpy.allclose(1e3 * found.outputs["tip_x"], metres.outputs["tip_x"], rtol=1e-12, atol=0),
            numpy.allclose(1e3 * found.error, metres.error, rtol=1e-12, atol=0), (found.relative == metres.relative).all(),
            abs(1e3 * found.peaks[0]["magnitude_m_n"] / metres.peaks[0]["magnitude_m_n"] - 1) < 1e-12]
    require(all(same), f"outputs, error, relative error, peaks in SI: {same}")


def test_coherence(root):
    """A panel more where it was measured."""
    without = frf_tables.Responses(write(root / "computed"))
    folder = write(root / "measured", coherence=True)
    require(not without.coherence and list(frf_tables.Responses(folder).coherence) == ["tip_x"], "coherence")
    require(points(folder, (BLUE,))[0] > points(write(root / "plain"), (BLUE,))[0], "no panel of coherence")


def test_bad(root):
    """One line says what is wrong."""
    fails("plot/frf", root / "nothing", [], "no such file")
    fails("plot/frf", write(root / "names"), ["--outputs", "tip_q"],
          "--outputs tip_q is not among the outputs; the nearest are tip_x")
    fails("plot/frf", root / "names", ["--band", "2000,3000"], "--band 2000,3000: no frequency of frf.csv is in it")
    cut = write(root / "cut")
    (cut / "frf.csv").write_text((cut / "frf.csv").read_text()[:-20])
    fails("plot/frf", cut, [], "frf.csv")
    (cut / "frf.csv").write_text("freq_hz\n1\n")
    fails("plot/frf", cut, [], "has no column that ends in _re_m_n")


def main():
    with tempfile.TemporaryDirectory() as folder:
        for test in (test_lines, test_millimetres, test_coherence, test_bad):
            test(Path(folder))


if __name__ == "__main__":
    main()
