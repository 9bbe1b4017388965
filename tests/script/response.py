#!/usr/bin/env python3
"""Made-up records of a disc after a blow, whose modes are known, for scripts/response: what it finds, what it says, and
how bad input fails. The disc does w(t) = rest + ramp(t) + J sum of shape_k exp(-d_k o_k t) sin(o_k' t) / o_k' after the
blow. Exit status: 0, or 1.
"""

import contextlib
import csv
import io
import math
import os
import signal
import subprocess
import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy
from drawing import SCRIPTS, drawn, fails, require, script
from squeal import STOPPED
from squeal.response import identify # found by drawing
from squeal.response.frf_tables import Responses
from squeal.tables import run, whole

STEP, BLOW, MOMENTUM = 1.6e-5, 1.205e-3, -2e-6  # s, s, N s
RADII, COUNT = {"rim": 0.12, "inner": 0.08}, 16
ANGLES = 2 * math.pi * numpy.arange(COUNT) / COUNT
TURNED = 0.7  # rad, angle of the contact
BAND = "500:6000:276"


class Mode(NamedTuple):
    """Hz, damping ratio, label: nodal circles and diameters."""
    freq: float
    damping: float
    circles: int
    diameters: int
    plus: bool

    @property
    def exponent(self):
        """1/s."""
        return 2 * math.pi * self.freq * (1j * math.sqrt(1 - self.damping**2) - self.damping)

    @property
    def label(self):
        """As squeal writes it."""
        return f"({self.circles},{self.diameters}{'+' if self.plus else ''})"

    @property
    def shape(self):
        """At the nodes; angles from the contact."""
        wave = (numpy.cos if self.plus else numpy.sin)(self.diameters * ANGLES + (0.3 if self.diameters == 0 else 0))
        return numpy.concatenate([radial * wave for radial in ((1, -0.6) if self.circles else (1, 0.4))])


# The pair at 3 kHz is 2 Hz apart, a tenth of its half width
MODES = [Mode(800, 0.03, 0, 2, True), Mode(3000, 0.008, 0, 4, True), Mode(3002, 0.009, 0, 4, False),
         Mode(4200, 0.006, 1, 3, True), Mode(5200, 0.007, 0, 5, True)]


def motion(time, modes=MODES):
    """[time][node] per N s after the blow at 0."""
    wave = [numpy.where(time > 0, numpy.exp(mode.exponent * numpy.maximum(time, 0)).imag / mode.exponent.imag, 0)
            for mode in modes]
    return numpy.array(wave).T @ numpy.array([mode.shape for mode in modes])


def receptance(freq):
    """[frequency][node], m/N."""
    s = 2j * math.pi * freq[:, None]
    return sum(mode.shape / ((s - mode.exponent) * (s - mode.exponent.conjugate())) for mode in MODES)


def write_table(path, names, rows):
    """One CSV."""
    with path.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(names)
        writer.writerows(rows)


def write(folder, end=0.052, blow=True, ramp=0.0, opened=0, time=BLOW):
    """A folder as -analysis transient leaves it; `opened` rows after the blow have a pair more open."""
    folder.mkdir(exist_ok=True)
    t = STEP * numpy.arange(int(end / STEP))
    rest = 1e-6 * numpy.linspace(1, 2, 2 * COUNT)
    values = rest + ramp * numpy.exp(-300 * t)[:, None] * numpy.cos(2 * math.pi * 800 * t)[:, None] * MODES[0].shape
    if blow:
        values = values + MOMENTUM * motion(t - time)
    names = [f"{name}_{k:03d}" for name in RADII for k in range(COUNT)]
    write_table(folder / "circles.csv", ["time_s", *(f"{name}_z_m" for name in names)],
                ([f"{x:.15g}" for x in row] for row in numpy.column_stack([t, values])))
    status = (t > time) & (t < time + (opened + 0.5) * STEP) & (opened > 0)
    write_table(folder / "transient.csv", ["time_s", "normal_force_n", "friction_force_n", "n_open", "n_stick"],
                ([f"{x:.15g}" for x in row] for row in zip(t, 100 + 0 * t, 10 + 0 * t, 3 + status, 0 * t)))
    write_table(folder / "circle_nodes.csv",
                ["node", "circle", "x_m", "y_m", "z_m", "axis", "radius_m", "angle_rad", "from_contact"],
                ([names[i * COUNT + k], name, radius * math.cos(angle + TURNED), radius * math.sin(angle + TURNED), 0,
                  "z", radius, angle, 1] for i, (name, radius) in enumerate(RADII.items())
                 for k, angle in enumerate(ANGLES)))
    if blow:
        write_table(folder / "impulses.csv", ["name", "time_s", *(f"{axis}_m" for axis in "xyz"),
                                              *(f"impulse_{axis}_n_s" for axis in "xyz"), "steps_after",
                                              "steps_changed", "pairs_changed"],
                    [["tap", time, 0.11, 0, 0, 0, 0, MOMENTUM, 90000, 100 * opened, int(opened > 0)]])
    return folder


def respond(folder, *options):
    """Response, and what was said."""
    result = script("response", folder, "--frequencies", BAND, *options)
    require(result.returncode == 0, f"{folder.name} {options}: {result.stderr}")
    return Responses(folder), result.stdout


def check(title, response, freq=1e-6, damping=1e-4, error=1.6e-2):
    """Peaks and response beside what is known."""
    peaks = {row["label"]: row for row in response.peaks}
    require(sorted(peaks) == sorted(mode.label for mode in MODES) and len(response.peaks) == len(MODES),
            f"{title}: peaks {[row['label'] for row in response.peaks]}")
    for mode in MODES:
        row, expected = peaks[mode.label], mode.exponent.imag / 2 / math.pi
        require(abs(row["mode_freq_hz"] / expected - 1) < freq and abs(row["damping_ratio"] / mode.damping - 1) < damping,
                f"{title}: {mode.label} at {row['mode_freq_hz']:.6f} Hz with {row['damping_ratio']:.6g}")
    truth = receptance(response.freq)
    found = numpy.array(list(response.outputs.values())).T
    worst = (numpy.linalg.norm(found - truth, axis=1) / numpy.linalg.norm(truth, axis=1)).max()
    print(f"{title}: response within {worst:.1e}, stated {response.relative.max():.1e}")
    require(worst < error, f"{title}: response off by {worst:.1e}")


def test_windows(root):
    """A record that has decayed, and a third of it: the window's damping is in neither. Breaks when it is left in, when a
    residue is taken at another time than the blow, or the pair at 3 kHz becomes one."""
    long, said = respond(write(root / "long"))
    require("rectangular window" in said, "a record that has decayed has another window")
    require("as many pairs are open and stick in all 90000 steps after the impulse as before it" in said, f"nothing opened: {said}")
    check("rectangular window", long)
    short, said = respond(write(root / "short", 0.02))
    require("exponential window" in said and "taken off" in said, "a short record has another window")
    check("exponential window", short)
    result = script("response", root / "long", "--length", 0.01878, "--window", "exponential", "--frequencies", BAND,
                    "--output", root / "piece")
    piece = Responses(root / "piece")
    require(result.returncode == 0 and (Responses(root / "long").outputs["rim_000_z"] == long.outputs["rim_000_z"]).all(),
            f"--output: {result.stderr}")
    require(abs(piece.outputs["rim_000_z"] / short.outputs["rim_000_z"] - 1).max() < 1e-3, "--length is not the same")


def test_rest(root):
    """The ramp of the load subtracted, and waited for. Breaks when either is not taken off, or is said to be when not."""
    with_ramp, without = write(root / "ramp", 0.02, ramp=1e-9), write(root / "alone", 0.02, ramp=1e-9, blow=False)
    response, said = respond(with_ramp, "--reference", without)
    require("less the run without the impulse" in said, "the reference is not named")
    check("subtracted", response)
    _, said = respond(with_ramp)
    require("TOO MUCH" in said, "a ramp that has not decayed is not told")
    late, said = respond(write(root / "late", 0.07, ramp=1e-9, time=0.05), "--from", 0.049)
    require("TOO MUCH" not in said and "when the ramp has decayed" in said, "a ramp that has decayed is told")
    check("waited for", late)


def test_decay(_):
    """A decay that does not vibrate beside a vibration: breaks when its residue, or that of the vibration, is no number."""
    time, exponents = STEP * numpy.arange(2000), numpy.array([-300, MODES[0].exponent])
    values = (3 * numpy.exp(-300 * time) + 2 * numpy.exp(exponents[1] * time).real)[:, None]
    found = identify.band_residues(time, values, (0, 2000), exponents)[:, 0]
    require(abs(found - [1.5, 1]).max() < 0.01, f"residues {found}, not half of 3 and of 2")


def test_opened(root):
    """How often the impulse changes the pairs, by steps of the run, and by rows beside a reference."""
    opened = write(root / "opened", 0.02, opened=7)
    _, said = respond(opened)
    require("opens, closes or sticks pairs in 700 of 90000 steps after it, 1 at most" in said, f"steps: {said}")
    _, said = respond(opened, "--reference", write(root / "quiet", 0.02, blow=False))
    require("opens, closes or sticks pairs in 7 of 1174 samples after it, 1 at most" in said, f"rows: {said}")


def test_whole(root):
    """Breaks when a table that could not be finished bears its name, or one of other peaks stays; ^C is one line."""
    folder = root / "short"
    (folder / "peaks_modes.csv").write_text("freq_hz\n1\n")
    respond(folder)
    require(not (folder / "peaks_modes.csv").exists(), "a comparison of other peaks stays")
    require(not list(folder.glob("*.part")), "parts stay")
    path = root / "table.csv"
    path.write_text("old")
    with contextlib.suppress(OSError), whole(path) as part:
        part.write_text("ne")
        raise OSError
    require(path.read_text() == "old" and not list(root.glob("*.part")), "half a table bears its name")

    def stopped():
        raise KeyboardInterrupt

    with contextlib.redirect_stderr(io.StringIO()) as said:
        status = run("response", stopped)
    require(status == STOPPED == 130 and said.getvalue() == "response: stopped\n", f"^C: {status} {said.getvalue()!r}")


def test_early_stop(root):
    """^C while numpy is read, which makes an error of its own of it, ends a script with one line."""
    (root / "early").mkdir()
    (root / "early/numpy.py").write_text("import os, signal\ntry:\n    os.kill(os.getpid(), signal.SIGINT)\n"
                                         "except KeyboardInterrupt:\n    raise ImportError from None\n")
    ended = subprocess.run([SCRIPTS / "response", root], env=os.environ | {"PYTHONPATH": str(root / "early")},
                           preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler), text=True,
                           capture_output=True, check=False)
    require((ended.returncode, ended.stderr) == (STOPPED, "response: stopped\n"), f"early ^C: {ended}")


def test_picture(root):
    """plot/frf draws it: the largest outputs of many."""
    drawn("plot/frf", root / "long")


def test_bad(root):
    """One line each."""
    folder = root / "short"
    fails("response", folder, ["--length", 0.07], "--length 0.07 s is longer than the record, which ends 0.018779")
    fails("response", folder, ["--length", 1e-4], "the record of 9.1e-05 s after the impulse is too short")
    fails("response", folder, ["--length", 0], "--length 0 s must be positive")
    fails("response", folder, ["--frequencies", "6000:9000:301"], "--frequencies 6000 to 9000 Hz: no peak of a mode")
    fails("response", folder, ["--frequencies", "50:9000:301"], "must lie between 213.0")
    fails("response", folder, ["--frequencies", "500:90000:301"], "and 15625 Hz, four rows to a period")
    fails("response", folder, ["--from", 0.01], "--from 0.01 s must be between the begin of the record, 0 s, and the "
          "impulse, 0.001205 s")
    fails("response", folder, ["--window", "rectangular"], "--window rectangular: at the end of the record")
    fails("response", folder, ["--reference", folder], "has an impulse itself")
    fails("response", folder, ["--reference", write(root / "brief", 0.01, blow=False)], "has other times than")
    fails("response", folder, ["--modes", root / "nowhere"], "nowhere/modes.csv: no such file")
    fails("response", root / "alone", [], "alone/impulses.csv: no such file; the run needs -impulses")
    fails("response", root / "nothing", [], "nothing/impulses.csv: no such file")
    text = (folder / "circles.csv").read_text()
    (folder / "circles.csv").write_text(text[:len(text) // 2])
    fails("response", folder, [], "circles.csv: line ")
    (folder / "circles.csv").write_text("")
    fails("response", folder, [], "circles.csv: is empty")
    (folder / "circles.csv").unlink()
    fails("response", folder, [], "records no motion; the run needs -circles or -probes")
    many = (folder / "impulses.csv").read_text()
    (folder / "impulses.csv").write_text(many + many.splitlines()[1] + "\n")
    fails("response", folder, [], "impulses.csv: has 2 impulses that acted; one is needed")


def main():
    """All tests, in folders of one root."""
    with tempfile.TemporaryDirectory() as folder:
        for test in (test_windows, test_rest, test_decay, test_opened, test_whole, test_early_stop, test_picture, test_bad):
            test(Path(folder))
            print(f"ok     {test.__doc__.splitlines()[0]}", flush=True)


if __name__ == "__main__":
    main()
