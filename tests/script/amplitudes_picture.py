#!/usr/bin/env python3
"""Draws made-up amplitudes of modes with scripts/plot/amplitudes: growth that it finds is that of the exponentials, the
times are those of closed forms, names are apart, and what cannot be drawn is one line. Exit status: 0, or 1.
"""

import re
import tempfile
from pathlib import Path

import numpy
from drawing import fails, points_of, require, script

from squeal.picture import spread

TAP, STEP, END = 1e-3, 2e-5, 40e-3  # s
MODES = {3: (3500.0, 300.0, 2e-9), 8: (5200.0, 500.0, 1e-10), 11: (7000.0, -80.0, 5e-9)}  # Hz, 1/s, m after the blow
LEVEL = 1e-5  # m, at which growth ends


def amplitude(time, level, freq, growth, size):
    """c of a mode from the blow on; before it is nothing."""
    grown = numpy.minimum(size * numpy.exp(growth * (time - TAP)), level)
    return numpy.where(time >= TAP, grown, 0) * numpy.exp(2j * numpy.pi * freq * time)


def write(root, under_way=False, level=LEVEL):
    """Both folders; returns that of the transient."""
    time = STEP * numpy.arange(round(END / STEP) + 1)
    columns = {"time_s": time}
    for mode, law in MODES.items():
        value = amplitude(time, level, *law)
        columns |= {f"mode_{mode}_re_m": value.real, f"mode_{mode}_im_m": value.imag}
    for name in ("modes", "run"):
        (root / name).mkdir(exist_ok=True)
    name = "amplitudes.csv.part" if under_way else "amplitudes.csv"
    numpy.savetxt(root / "run" / name, numpy.stack(list(columns.values()), axis=1), fmt="%.15g", delimiter=",",
                  header=",".join(columns), comments="")
    rows = [f'{mode},{freq:.15g},{growth:.15g},"(0,{mode}+)"' for mode, (freq, growth, _) in MODES.items()]
    (root / "modes/modes.csv").write_text("\n".join(["mode,freq_hz,growth_rad_s,label", *rows, ""]))
    (root / "run/scene.yaml").write_text(f"# in: {root}\ndynamics_filters: \"modes\"\nimpulses: \"tap\"\n"
                                         f"tap_time: \"{TAP}\"\ndynamics_start: \"static\"\npress_ramp: \"9\"\n"
                                         "loads: \"press\"\n")
    return root / "run"


def numbers(text):
    """Rows of the table by mode."""
    found = {}
    for line in text.splitlines():
        row = re.match(r"(\d+)(?: \(0,\d+\+\))? +(\S+) +(\S+) +(\S+) +(\S+) +(\S+)$", line)
        if row:
            found[int(row[1])] = row.groups()[1:]
    return found


def test_table(root):
    """Breaks when a mode, the blow or the logarithm is mixed up."""
    folder = write(root)
    result = script("plot/amplitudes", folder)
    require(result.returncode == 0, result.stderr)
    points_of(folder / "amplitudes.png", "three modes")
    found = numbers(result.stdout)
    require(list(found) == list(MODES), result.stdout)
    for mode, (freq, growth, size) in MODES.items():
        row = found[mode]
        require(abs(float(row[0]) - freq) < 0.01 and abs(float(row[1]) - growth) < 1e-3, f"eigenvalue {row}")
        require(abs(float(row[2]) / growth - 1) < 1e-3, f"mode {mode}: growth in time {row[2]}, made with {growth}")
        parts = TAP + (numpy.log(1.1 * LEVEL / size) / growth if growth > 0 else END)
        require(abs(1e-3 * float(row[3]) - min(parts, END)) <= 1.1 * STEP, f"mode {mode} leaves at {parts}: {row}")
    first, second = MODES[3], MODES[8]
    saturated = TAP + numpy.log(LEVEL / first[2]) / first[1]
    meets = TAP + numpy.log(first[2] / second[2]) / (second[1] - first[1])
    require(meets < saturated and found[11][4] == "-", f"the one that decays is never the largest: {found[11]}")


def test_winner(root):
    """The mode that overtakes leads from ln(a1 / a2) / (sigma2 - sigma1) on."""
    result = script("plot/amplitudes", write(root, level=1.0))
    first, second = MODES[3], MODES[8]
    meets = TAP + numpy.log(first[2] / second[2]) / (second[1] - first[1])
    found = numbers(result.stdout)
    require(abs(1e-3 * float(found[8][4]) - meets) <= 1.1 * STEP and found[3][4] == "-",
            f"mode 8 leads from {meets}: {found}")


def test_unknown(root):
    """Without the folder of modes the amplitudes are drawn alone; a run under way, too."""
    folder = write(root, under_way=True)
    (root / "modes/modes.csv").unlink()
    result = script("plot/amplitudes", folder, "-o", folder / "alone.png")
    require(result.returncode == 0 and "under way" in result.stdout and numbers(result.stdout)[3][1] == "-",
            result.stdout + result.stderr)
    points_of(folder / "alone.png", "without eigenvalues")


def test_names():
    """Names are apart, in order and within the panel."""
    places = numpy.array([0.5, 0.51, 0.1, 0.505, 0.99, 1.0])
    moved = spread(places, 0.05)
    require((numpy.diff(moved[numpy.argsort(places)]) > 0.0499).all(), f"apart: {moved}")
    require(moved.min() >= 0 and moved.max() <= 1 and abs(moved[2] - 0.1) < 1e-9, f"moved too far: {moved}")


def test_errors(root):
    """One line each."""
    folder = write(root)
    table = folder / "amplitudes.csv"
    text = table.read_text()
    cases = [(text.replace("mode_8_im_m", "mode_8_phase", 1), "no pair of columns"), ("", "is empty"),
             ("\n".join(text.splitlines()[:5]), "has 4 rows"), (text[:-70], "does not have as many columns"),
             (text.replace("mode_8", "mode_9"), "modes.csv: no mode 9, which")]
    for content, expected in cases:
        table.write_text(content)
        fails("plot/amplitudes", folder, [], expected)
    table.write_text(text)
    fails("plot/amplitudes", folder, ["--modes", root / "none"], "no such file")
    table.unlink()
    fails("plot/amplitudes", folder, [], "run squeal -analysis transient with -dynamics_filters")


def main():
    test_names()
    for test in (test_table, test_winner, test_unknown, test_errors):
        with tempfile.TemporaryDirectory() as folder:
            test(Path(folder))


if __name__ == "__main__":
    main()
