"""What the seed paper says, and what comes out here: a list of claims for each table and figure."""

import math
import re
from typing import NamedTuple

import numpy

from ..run.kept_runs import LOG
from ..report.markup import figures, fixed, signed
from ..modes.table1 import TABLE, beside, groups, read_modes, read_peaks, rms
from ..tables import BadInput, read_table

FAMILIES = {"3500 Hz": (3000, 4300), "5000 Hz": (4600, 5700)}  # Hz about the paper's two instabilities
ONSETS = {"3500 Hz": 24, "5000 Hz": 20}  # GPa, its Figure 5
SHAPES = {"3500 Hz": "(0,4+)", "5000 Hz": "(0,5+)"}  # its Figure 6
SQUEAL = 3430  # Hz, its Figure 9
PRESSED = 2.5895e8  # N/m, its section 2.1
CLOSE = 0.01  # a frequency, or the rms of several, is the paper's within this,
NEAR = 0.1  # and an onset
QUIET = 0.1  # of the mean: oscillation of the normal force that is not remarkable


class Claim(NamedTuple):
    """`kept`: whether it is as in the paper; None where that is not a question of yes or no."""
    what: str
    paper: str
    here: str
    kept: bool | None = None


def percent(value):
    """With its sign."""
    return f"{signed(100 * value, 2)} %"


def table_claims(columns):
    """Table 1. columns: name -> list of Beside."""
    for name, pairs in columns.items():
        column = "Ansys" if pairs[0].paper == pairs[0].line.ansys else "Plast3"
        for group, own in {"all": pairs, **groups(pairs)}.items():
            n = sum(not math.isnan(pair.ours) for pair in own)
            yield Claim(f"{name}, {group}", f"its {column} column",
                        f"rms difference {fixed(100 * rms(own), 2)} % of {n} of {len(own)} modes" if n else
                        f"none of {len(own)} modes has its label",
                        None if group == "all" else n == len(own) and rms(own) < CLOSE)


def frequency_claim(label, how, freq):
    """Figure 4. freq: Hz, or None."""
    paper = next(line.plast3 for line in TABLE if line.name == label)
    if not freq:
        return Claim(f"{label}, {how}", f"{paper} Hz", "no peak or mode has this label", False)
    error = freq / paper - 1
    return Claim(f"{label}, {how}", f"{paper} Hz", f"{fixed(freq, 0)} Hz, {percent(error)}", abs(error) < CLOSE)


def mesh_claims(pairs):
    """Figure 3. pairs: (Hz of the fine disc, relative difference of the coarse one)."""
    for end, most in ((10e3, 0.02), (20e3, 0.05)):
        worst = max((abs(error) for freq, error in pairs if freq < end), default=math.nan)
        yield Claim(f"largest difference to {figures(end / 1e3)} kHz", f"below {100 * most:g} %",
                    f"{fixed(100 * worst, 2)} %", worst < most)


def unstable_range(study, band):
    """Least and largest value (GPa) at which a mode of the band is unstable: onsets and points; None where none is."""
    values = [row["value"] for row in study.rows if row["unstable"] and band[0] <= row["freq_hz"] <= band[1]]
    if not values:
        return None
    onsets = [row["critical_value"] for row in study.onsets
              if row["kind"] == "lock_in" and band[0] <= row["freq_hz"] <= band[1]]
    return 1e-9 * min([*onsets, *values]), 1e-9 * max(values)


def sweep_claims(study, name, fitted):
    """Figure 5. What was fitted to the paper gets no verdict."""
    def verdict(kept):
        return None if fitted else bool(kept)

    last = 1e-9 * max(row["value"] for row in study.rows)
    for family, band in FAMILIES.items():
        found = unstable_range(study, band)
        if not found:
            yield Claim(f"{name}: unstable near {family}", f"from {ONSETS[family]} to 80 GPa", "stable", verdict(False))
            continue
        yield Claim(f"{name}: unstable near {family}, from", f"{ONSETS[family]} GPa", f"{figures(found[0], 3)} GPa",
                    verdict(abs(found[0] / ONSETS[family] - 1) < NEAR))
        yield Claim(f"{name}: unstable near {family}, to", "80 GPa, the last value",
                    f"{figures(found[1], 3)} GPa", verdict(found[1] > 0.999 * last))


def shape_claims(family, row, shape):
    """Figure 6, one mode."""
    yield Claim(f"unstable mode near {family}", f"the disc in its {SHAPES[family]}",
                f"{fixed(row['freq_hz'], 0)} Hz, growth {signed(row['growth_rad_s'], 3)} 1/s, the disc with "
                f"{shape.diameters} nodal diameters; its name is {row['label']}",
                shape.diameters == int(SHAPES[family][3]))
    antinode = shape.antinode_at_contact()
    yield Claim(f"near {family}: antinode at the contact over the largest of the others", "lower",
                fixed(antinode, 2), antinode < 1)


def growth_words(vibration):
    """Regime, growth, frequency."""
    fit = vibration.fit
    return vibration.regime() + (f", {signed(fit.growth, 3)} 1/s at {fixed(fit.freq, 0)} Hz" if fit else "")


def stable_claims(record):
    """Figure 7."""
    vibration, normal = record.vibration, record.run.normal[record.vibration.steady]
    yield Claim("acceleration of the pad's edge", "decreases: stable", growth_words(vibration),
                vibration.regime() == "decays")
    yield Claim("oscillation of the contact forces", "not remarkable",
                f"normal force {figures(normal.min(), 4)} to {figures(normal.max(), 4)} N",
                bool(numpy.ptp(normal) < QUIET * normal.mean()))


def growth_claims(record):
    """Figure 8."""
    normal = record.run.normal[record.vibration.steady]
    share = float((normal <= 0).mean())
    yield Claim("acceleration of the pad's edge", "grows exponentially to a maximum", growth_words(record.vibration),
                record.vibration.saturated())
    yield Claim("normal force in the steady state", "strong oscillation; the pad is not said to detach",
                f"{figures(normal.min(), 3)} to {figures(normal.max(), 3)} N, zero for {fixed(100 * share, 1)} % of "
                "the time", share == 0)


def line_claims(record):
    """Main line of Figure 9."""
    vibration = record.vibration
    if not vibration.line:
        yield Claim("squeal frequency", f"{SQUEAL} Hz", f"no line: {vibration.why}", False)
        return
    error = vibration.line[0] / SQUEAL - 1
    yield Claim("squeal frequency", f"{SQUEAL} Hz", f"{fixed(vibration.line[0], 0)} Hz, {percent(error)}",
                abs(error) < CLOSE)
    levels = ", ".join(f"{number}×: {signed(level, 2)} dB" for number, level in vibration.harmonics.items())
    yield Claim("its harmonics", "there", levels or "none", bool(levels))


def diameter_claims(shape, share, paper):
    """Shape of Figures 9 and 11."""
    yield Claim("shape of the disc", paper, f"{shape.diameters} nodal diameters, with {100 * share:.0f} % of the mean "
                "square", shape.diameters == 4)
    antinode = shape.antinode_at_contact()
    yield Claim("antinode at the contact over the largest of the others", "lower", fixed(antinode, 2), antinode < 1)


def detached_claims(record):
    """Figure 10."""
    normal = record.run.normal[record.vibration.steady]
    share = float((normal <= 0).mean())
    yield Claim("acceleration of the pad's edge", "grows", growth_words(record.vibration),
                bool(record.vibration.growth and record.vibration.growth.slope > 0))
    yield Claim("contact forces", "become zero: the pad detaches",
                f"zero for {fixed(100 * share, 1)} % of the time, at most {figures(normal.max(), 3)} N", share > 0)


def pressing_claims(folder):
    """k_n by pressing."""
    found = re.search(r"k_n identified as (\S+) N/m per pair, (\S+) N/m in total",
                      (folder / LOG).read_text(encoding="utf-8"))
    if not found:
        raise BadInput(f"{folder / LOG}: tells no k_n")
    for name, value in zip(("for each pair", "in total"), map(float, found.groups())):
        yield Claim(f"k_n at 16 GPa, {name}", f"{figures(PRESSED, 5)} N/m, of what is not said",
                    f"{figures(value, 5)} N/m: the printed one is {figures(PRESSED / value, 3)} times as much")


def mesh_pairs(fine, coarse):
    """(Hz, relative difference) of the modes of two discs, doublets in their order."""
    own = [read_table(folder / "modes.csv", {"freq_hz": float, "label": str}) for folder in (fine, coarse)]
    return [(a["freq_hz"], b["freq_hz"] / a["freq_hz"] - 1) for a, b in zip(*own)]


def table_columns(consistent, lumped, response):
    """Ours of Table 1, of the folders that there are."""
    ours = {"consistent mass": (consistent, read_modes, "ansys"), "lumped mass": (lumped, read_modes, "plast3"),
            "in time": (response, read_peaks, "plast3")}
    return {name: beside(read(folder), column) for name, (folder, read, column) in ours.items() if folder}
