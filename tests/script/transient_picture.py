#!/usr/bin/env python3
"""Draws made-up transients with scripts/plot/transient and checks what it prints and shows. Rates, frequencies,
levels, shares and nodal diameters are those put into the signals, see made_up_transient.py. Exit status: 0, or 1.
"""

import csv
import tempfile
from pathlib import Path

import numpy
from drawing import fails, points_of, require, script
from made_up_transient import (DIAMETERS, FREQUENCY, HARMONICS, LEVEL, PAIRS, Transient, write_snapshots,
                               write_table)

from squeal.transient import signal, spectrum # found by drawing
from squeal.transient.history import snapshot_times

PICTURES = ("forces", "acceleration", "psd", "growth")
TIME = 0.003 + 5e-6 * numpy.arange(4000)


def close(found, expected, tolerance, message):
    """Within an absolute tolerance."""
    require(abs(found - expected) <= tolerance, f"{message}: {found:.9g} instead of {expected:.9g} +- {tolerance:.2g}")


def vibration(*modes):
    """Sum of (Hz, 1/s, amplitude) over TIME."""
    t = TIME - TIME[0]
    return sum(a * numpy.exp(s * t) * numpy.cos(2 * numpy.pi * f * t + 0.4 * i) for i, (f, s, a) in enumerate(modes))


def run(folder, *options):
    """Runs the script."""
    return script("plot/transient", folder, *options)


def draw(folder, *options):
    """The summary of a run, values and errors by name, and what was printed."""
    result = run(folder, *options)
    require(result.returncode == 0 and not result.stderr, f"{folder.name}: {result.stderr}")
    with (folder / "transient_summary.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    return {row["quantity"]: (float(row["value"]), float(row["error"] or "nan")) for row in rows}, result.stdout


def require_pictures(folder, names):
    """Each a picture."""
    for name in names:
        points_of(folder / f"transient_{name}.png", f"{folder.name}: {name}")


def test_clean_modes(_):
    """Two exponentials to 0.01 % (the fit is exact but for rounding and leakage): breaks when filter, demodulation or
    pencil change the exponents, or the band is not kept to."""
    wanted = [(3483.0, 214.0, 1.0), (5120.0, 80.0, 0.7)]
    x = vibration(*wanted)
    for band, modes in (((2800, 4200), wanted[:1]), ((4300, 6000), wanted[1:]), ((2000, 7000), wanted)):
        found = signal.fit_modes(TIME, x, band, len(modes))
        require(len(found) == len(modes), f"{len(found)} modes in {band}")
        for mode, (frequency, growth, amplitude) in zip(found, modes):
            close(mode.freq, frequency, 1e-4 * frequency, "frequency")
            close(mode.growth, growth, 1e-4 * growth, "growth")
            close(mode.amplitude, amplitude, 1e-4, "amplitude at the first time")
    near = signal.fit_modes(TIME, vibration((3450, 214, 1), (3520, -150, 1), (13400, 500, 0.1)), (2800, 4200), 2)
    close(near[0].growth, 214, 0.02, "growth of two that are near")
    close(near[1].growth, -150, 0.02, "decay of two that are near")


def test_noisy_modes(_):
    """1 % of noise leaves 1 % of the growth, and the stated error is that of repeated fits: breaks when noise is taken
    for modes, or errors are not standard errors. A ratio of 40 scatters lies within 30 % of its mean in all but 1 % of
    cases; the noise is fixed."""
    random = numpy.random.default_rng(5)
    x = vibration((3483, 214, 1), (5120, 80, 0.7))
    fits = [signal.fit_modes(TIME, x + 0.01 * x.std() * random.standard_normal(len(x)), (2800, 4200))[0]
            for _ in range(40)]
    for mode in fits:
        close(mode.growth, 214, 2.14, "growth with noise")
        close(mode.freq, 3483, 34.83, "frequency with noise")
    ratio = numpy.mean([mode.error for mode in fits]) / numpy.std([mode.growth for mode in fits])
    require(0.6 < ratio < 1.5, f"stated over observed error {ratio:.3g}")


def test_unequal_steps(_):
    """Times that wander are made equal; equal ones are left as they are."""
    t = TIME + 2e-6 * numpy.sin(numpy.arange(len(TIME)))
    even, x = signal.equal_steps(t, 3 * t)
    require(numpy.ptp(numpy.diff(even)) < 1e-12, "steps differ")
    require(numpy.allclose(x, 3 * even, rtol=1e-9), "a straight line is bent")
    kept = signal.equal_steps(TIME, vibration((3000, 0, 1)))[1]
    require((kept == vibration((3000, 0, 1))).all(), "equal steps are interpolated")


def test_spectrum(_):
    """A sine of amplitude 3: 4.5 is the integral of its density; its frequency lies between two bins. Harmonics as put
    in, beside a line that is no multiple: breaks when a near line is taken for a harmonic."""
    t = 5e-6 * numpy.arange(6000)
    x = 3 * numpy.sin(2 * numpy.pi * 3333.3 * t) + 0.3 * numpy.sin(2 * numpy.pi * 6666.6 * t)
    frequency, density = spectrum.power_density(t, x + 7, 400)
    close(density.sum() * frequency[1], 4.5 + 0.045, 1e-3, "integral of the density")
    line = spectrum.main_line(t, x, (200, 20000))
    close(line[0], 3333.3, 0.02, "main line")
    close(line[2], 3, 1e-3, "its amplitude")
    x = x + 0.9 * numpy.sin(2 * numpy.pi * 13600 * t)
    levels = spectrum.harmonic_levels(t, x, line[0])
    close(levels[2], -20, 0.02, "second harmonic, dB")
    require(levels[4] < -45, f"fourth harmonic {levels[4]:.3g} dB where there is none")
    other = spectrum.other_line(t, x, line[0], 200)
    close(other[0], 13600, 5, "other line")
    close(other[1], 20 * numpy.log10(0.3), 0.2, "its level, dB")
    require(spectrum.other_line(t, 3 * numpy.sin(2 * numpy.pi * 3333.3 * t), 3333.3, 200) is None, "skirts of a line")


def test_circle(_):
    """Mean squares by number of waves: 1/2 of cos^2; the mean by itself; unequal angles in any order."""
    angle = 2 * numpy.pi * numpy.arange(100) / 100
    content = spectrum.circle_content(angle[::-1], (2 * numpy.cos(4 * angle + 1) + 0.5 + numpy.sin(7 * angle))[::-1])
    for number, part in ((0, 0.25), (4, 2.0), (7, 0.5), (3, 0.0)):
        close(content[number], part, 1e-12, f"{number} waves")
    angle = angle + 0.02 * numpy.sin(3 * angle)
    content = spectrum.circle_content(angle, numpy.cos(5 * angle))
    require(content.argmax() == 5 and abs(content[5] - 0.5) < 0.01, "unequal angles")


def test_limit_cycle(root):
    """Growth, then a limit cycle that detaches: breaks when window, saturation or share of time are wrong. The level is
    reached at 18 ms, 90 % of it 0.26 ms before."""
    made = Transient(depth=1.4, second=2e-3)
    write_table(root / "cycle", made.table())
    summary, text = draw(root / "cycle", "--case", "39.8 GPa")
    require("acceleration in y: limit cycle" in text, text)
    require_pictures(root / "cycle", PICTURES)
    close(summary["growth"][0], made.growth, 1e-3 * made.growth, "growth")
    close(summary["growth_frequency"][0], FREQUENCY, 0.1, "frequency of the growth")
    require(summary["growth_window_start"][0] > 1e-3 and summary["growth_window_end"][0] < 0.018, "window")
    close(summary["saturation"][0], 0.018 + numpy.log(0.9) / made.growth, 1e-4, "saturation")
    close(summary["main_frequency"][0], FREQUENCY, 0.2, "main line")
    close(summary["main_amplitude"][0], LEVEL, 0.01 * LEVEL, "its amplitude")
    power = 1 + sum(10**(level / 10) for level in HARMONICS.values())
    close(summary["rms"][0], LEVEL * numpy.sqrt(power / 2), 0.01 * LEVEL, "rms")
    for number, level in HARMONICS.items():
        close(summary[f"harmonic_{number}"][0], level, 0.05, f"harmonic {number}")
    close(summary["detached_share"][0], made.detached_share(1.4), 2 * summary["detached_share"][1] + 4e-3, "detached")
    status = sum(summary[f"pairs_{name}_mean"][0] for name in ("open", "stick", "slip"))
    close(status, PAIRS, 1e-9, "pairs")
    require(summary["ledger_error"][0] < 1e-11, "ledger")


def test_decay_and_growth(root):
    """Decay; growth to the end of a run under way, whose last line is cut; window and band of the command line."""
    made = Transient(growth=-150.0, noise=1e-5)
    write_table(root / "decay", made.table("tip"))
    summary, text = draw(root / "decay")
    require("tip: acceleration in y: decays" in text, text)
    close(summary["growth"][0], -150, 0.15, "decay")
    close(summary["detached_share"][0], 0, 0, "detached")
    made = Transient(end=0.02, growth=200.0, saturation=0.05)
    write_table(root / "grows", made.table(), "transient.csv.part")
    with (root / "grows" / "transient.csv.part").open("a") as file:
        file.write("0.0200")
    summary, text = draw(root / "grows")
    require("of a run that is under way" in text and "still grows" in text and "saturation" not in summary, text)
    close(summary["growth"][0], 200, 0.02, "growth of a run under way")
    summary, _ = draw(root / "grows", "--window", "0.006,0.016", "--band", "3000,4000")
    close(summary["growth_window_start"][0], 0.006, 0, "start of the window")
    close(summary["growth"][0], 200, 0.02, "growth in the window")


def test_missing_parts(root):
    """What a table lacks is said, and the rest drawn."""
    columns = Transient(depth=0.5).table(None)
    write_table(root / "forces", columns)
    summary, text = draw(root / "forces")
    require("no acceleration: the run had no -probes" in text, text)
    require_pictures(root / "forces", PICTURES[:1])
    require(not (root / "forces" / "transient_psd.png").exists(), "spectrum of nothing")
    close(summary["growth"][0], 400, 0.4, "growth of the friction force")
    few = ("time_s", "normal_force_n", "friction_force_n")
    write_table(root / "few", {name: columns[name] for name in few})
    summary, _ = draw(root / "few")
    require("ledger_error" not in summary and "pairs_open_mean" not in summary, "quantities without columns")
    free = Transient(depth=0.5)
    free.normal = 0 * free.normal
    write_table(root / "free", free.table())
    summary, text = draw(root / "free")
    require("no contact: the normal force is zero in the whole run" in text, text)
    close(summary["growth"][0], 400, 0.4, "growth without contact")
    write_table(root / "short", Transient(end=0.004).table())
    summary, text = draw(root / "short")
    require("10 periods of the largest line, 34" in text and "and 6." in text and "growth" not in summary, text)
    rest = Transient(end=0.001)
    rest.acceleration = 0 * rest.acceleration
    write_table(root / "rest", rest.table())
    summary, text = draw(root / "rest")
    require("no spectrum and no growth: the signal is constant" in text and "growth" not in summary, text)


def test_snapshots(root):
    """Nodal diameters and times of made-up snapshots; those before saturation do not count. Left out without h5py."""
    try:
        import h5py  # noqa: F401
    except ImportError:
        print("no h5py: snapshots are not tested")
        return
    made = Transient()
    folder = root / "shape"
    write_table(folder, made.table())
    times = made.time[4000:4400:20]
    write_snapshots(folder, times)
    summary, _ = draw(folder)
    require_pictures(folder, ["shape"])
    close(summary["nodal_diameters"][0], DIAMETERS, 0, "nodal diameters")
    main = numpy.mean(numpy.sin(2 * numpy.pi * FREQUENCY * times)**2)
    close(summary["nodal_diameters_share"][0], main / (main + 0.2**2), 1e-6, "their share")
    require(abs(numpy.array(list(snapshot_times(folder).values())) - times).max() < 1e-12, "times of the snapshots")
    (folder / "transient.xmf").write_text("<Grid>")
    (folder / "snapshot_0000.h5").write_bytes(b"no HDF5")
    fails("plot/transient", folder, [], "snapshot_0000.h5: cannot be read")


def test_errors(root):
    """What cannot be drawn ends in one line that names it."""
    write_table(root / "bad", Transient(end=0.01).table())
    table = root / "bad" / "transient.csv"
    text = table.read_text()
    lines = text.splitlines(keepends=True)
    cases = [("".join(lines)[:-30], f"line {len(lines)} does not have as many columns"), ("", "is empty"),
             ("".join(lines[:9]), "has 8 rows"),
             (text.replace("normal_force_n", "force", 1), "no column normal_force_n"), ("\udcff", "cannot be read"),
             (text.replace("pad_edge_vy_m_s", "pad_edge_b", 1), "no column pad_edge_vy_m_s"),
             *(("".join([*lines[:5], word + lines[5][lines[5].index(","):], *lines[6:]]), f"line 6: time_s is '{word}'")
               for word in ("nan", "many")),
             ("".join([*lines[:5], *lines[7:9], *lines[5:]]), "line 8: time_s does not increase")]
    for content, expected in cases:
        table.write_bytes(content.encode("utf-8", "surrogateescape"))
        fails("plot/transient", root / "bad", [], expected)
    table.write_text(text)
    fails("plot/transient", root / "bad", ["--probe", "beam"], "--probe beam: no such probe; the table has pad_edge")
    fails("plot/transient", root / "bad", ["--band", "3e5,4e5"], "the rows of the table resolve up to")
    fails("plot/transient", root / "bad", ["--window", "7,8"], "--window 7,8: 0 rows there")
    fails("plot/transient", root / "bad", ["--out", root / "none"], "no such folder")
    table.unlink()
    fails("plot/transient", root / "bad", [], f"{table}: no such file")
    result = run(root / "bad", "--band", "9,2")
    require(result.returncode == 2 and "smaller one first" in result.stderr, result.stderr)


def main():
    with tempfile.TemporaryDirectory() as folder:
        for test in (test_clean_modes, test_noisy_modes, test_unequal_steps, test_spectrum, test_circle,
                     test_limit_cycle, test_decay_and_growth, test_missing_parts, test_snapshots, test_errors):
            test(Path(folder))


if __name__ == "__main__":
    main()
