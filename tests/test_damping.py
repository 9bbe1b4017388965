#!/usr/bin/env python3
"""scripts/response --damping on a small brake whose parts have loss factors: at each clear peak the loss factor of the damped mode itself,
Im lambda^2 / Re lambda^2 by -analysis modes, and the materials' own from shares of energy. Breaks when the circle is fitted with a wrong
sign or weight, when shares are those of another mode, or when a peak of two modes counts. Made-up responses: two modes in one peak, noise,
the wrong convention, zeros; parts that peaks do not tell.

    test_damping.py SQUEAL"""

import csv
import math
import subprocess
import sys
import tempfile
from pathlib import Path
from types import SimpleNamespace

import numpy
from forked import run_script
from served import sooner

SOURCE = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(SOURCE / "scripts"))
from squeal.response.damping import MISFIT, Peak, materials, peaks_of  # noqa: E402
from squeal.tables import BadInput  # noqa: E402

SCENE = """rig: {disc: {elements: "6,20,1"}, pad: {elements: "2,2,2"}, beam: {elements: 6}}
modes: {band: "1000,12000"}
contact: {mu: 0}
probes: tip,edge
tip: {at: "0.11,0,0.11", part: beam}
edge: {at: "-0.12,0,0", part: disc}
"""
LOSS = {"disc": 0.01, "pad": 0.03, "beam": 0.005}
CLOSE = 2e-3  # loss factors of peaks of one mode with a misfit of MISFIT at most
DEVIATIONS = 3  # of parts, stated


def rows_of(path):
    with path.open(newline="") as lines:
        return list(csv.DictReader(lines))


def squeal(program, folder, *words):
    options = ["-options_file", SOURCE / "options/massi2005.yaml", "-options_file", "small.yaml", "-output_fields", "0", *words]
    subprocess.run([program, *map(str, options)], cwd=folder, check=True, stdout=subprocess.DEVNULL)


def response(folder, *words):
    return run_script(SOURCE / "scripts/response", words, folder)


def check(folder):
    """What is wrong."""
    true = {}
    for row in rows_of(folder / "damped/modes.csv"):
        square = complex(float(row["growth_rad_s"]), 2 * math.pi * float(row["freq_hz"]))**2
        true[float(row["freq_hz"])] = square.imag / square.real
    clear = [row for row in rows_of(folder / "frf/damping.csv") if row["misfit"] and float(row["misfit"]) <= MISFIT and row["modes"] == "1"]
    if len(clear) < 5:
        yield f"{len(clear)} clear peaks, not five"
    for row in clear:
        near = true[min(true, key=lambda freq: abs(freq - float(row["freq_hz"])))]
        if abs(float(row["loss_factor"]) / near - 1) > CLOSE:
            yield f"{row['freq_hz']} Hz: loss factor {row['loss_factor']}, not {near:g}"
    found = {row["part"]: row for row in rows_of(folder / "frf/damping_parts.csv")}
    for part, loss in LOSS.items():
        off, deviation = float(found[part]["loss_factor"]) - loss, float(found[part]["standard_deviation"])
        if abs(off) > DEVIATIONS * deviation or deviation > 1e-2 * loss:
            yield f"{part}: loss factor {found[part]['loss_factor']} +- {deviation:g}, not {loss:g}"


def made_up(modes, noise=0.0, seed=0):
    """A receptance of modes of frequency and loss factor, with noise of that share of its largest value."""
    freq = numpy.linspace(800, 1300, 2001)
    values = sum(1 / (f**2 * (1 + 1j * loss) - freq**2) for f, loss in modes)
    rng = numpy.random.default_rng(seed)
    values = values + noise * abs(values).max() * (rng.normal(size=freq.shape) + 1j * rng.normal(size=freq.shape)) / math.sqrt(2)
    return SimpleNamespace(freq=freq, outputs={"one": values})


def refused(work, words):
    try:
        work()
    except BadInput as error:
        return words in str(error)
    return False


def check_peaks():
    """What is wrong with peaks of made-up responses."""
    for apart in (2, 4, 6, 8, 10, 15):
        for peak in peaks_of(made_up([(1000 - apart / 2, 0.02), (1000 + apart / 2, 0.02)])):
            if peak.modes == 1 and abs(peak.loss / 0.02 - 1) > CLOSE:
                yield f"two modes {apart} Hz apart count as one of loss factor {peak.loss:g}"
    for seed in range(20):
        noisy = peaks_of(made_up([(1000, 0.02), (1200, 0.016)], 0.02, seed))
        near = [abs(peak.freq / freq - 1) < 2e-3 and abs(peak.half_power / loss - 1) < 0.2
                for peak, (freq, loss) in zip(noisy, [(1000, 0.02), (1200, 0.016)])]
        if len(noisy) != 2 or not all(near):
            yield f"noise of 2 %, {seed}: {noisy}"
    conjugate = made_up([(1000, -0.02)])
    nothing = made_up([(1000, 0.02)])
    nothing.outputs["one"] *= 0
    if not refused(lambda: peaks_of(conjugate), "conjugate") or not refused(lambda: peaks_of(nothing), "not all 0"):
        yield "a response of the wrong convention or of zeros passes"


def check_told():
    """What is wrong with parts that peaks do not tell: two of the same shares, more parts than peaks."""
    peaks = [Peak(100 * k, loss, loss, 9, 1e-5, 1) for k, loss in enumerate((0.011, 0.0121, 0.0129, 0.0141), 1)]
    share = {k: {"one": 1 - 0.1 * k, "two": 0.05 * k, "three": 0.05 * k} for k in range(1, 5)}
    found = {part: (loss, deviation) for part, loss, deviation in materials(peaks, range(1, 5), share)[0]}
    if not abs(found["one"][0] - 0.01) < 3 * found["one"][1] or not numpy.isnan([*found["two"], *found["three"]]).all():
        yield f"two parts of the same shares: {found}"
    few = materials(peaks[:1], [1], share)[0]
    if not all(numpy.isnan(loss) and numpy.isnan(deviation) for _, loss, deviation in few):
        yield f"one peak tells {few}"
    if not refused(lambda: materials([peaks[0]._replace(misfit=0.02)], [1], share), "no peak of one mode"):
        yield "a peak of a misfit of 0.02 says something of materials"


def main():
    losses = [word for part, loss in LOSS.items() for word in (f"-{part}_loss_factor", loss)]
    with tempfile.TemporaryDirectory() as name, sooner(sys.argv[1]) as program:
        folder = Path(name)
        (folder / "small.yaml").write_text(SCENE)
        squeal(program, folder, *losses, "-analysis", "frf", "-frf_force", "tip,0,0,1", "-frf_frequencies", "1600:10000:4201",
               "-output_dir", "frf")
        squeal(program, folder, *losses, "-output_dir", "damped")
        squeal(program, folder, "-modes_sensitivities", "-output_dir", "undamped")
        done = response(folder, "frf", "--damping", "--modes", "undamped")
        print(done.stdout, done.stderr, sep="", end="")
        faults = [f"exit status {done.returncode}"] if done.returncode else list(check(folder))
        bad = response(folder, "frf", "--damping", "--modes", "damped")
        faults += [*check_peaks(), *check_told()]
        for words, said in ((("--damping", "--length", "1"), "--length does nothing with --damping"),
                            (("--within", "0.1"), "--within is that of --damping")):
            wrong = response(folder, "frf", *words)
            if wrong.returncode == 0 or said not in wrong.stderr:
                faults.append(f"{words}: {wrong.stderr}")
        if bad.returncode == 0 or "is missing: shares of energy need a run with -modes_sensitivities" not in bad.stderr:
            faults.append(f"without shares: {bad.stderr}")
    print(*faults, sep="\n")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
