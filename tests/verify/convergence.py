"""Frequencies of one scene on meshes whose size is halved from run to run, for the verification scripts."""

import csv
import math
from pathlib import Path


def read_modes(folder):
    """Rows of modes.csv as (frequency in Hz, label)."""
    with (Path(folder) / "modes.csv").open(newline="") as file:
        return [(float(row["freq_hz"]), row["label"]) for row in csv.DictReader(file)]


def nearest(modes, frequency):
    """The computed frequency nearest to a reference."""
    return min((f for f, _ in modes), key=lambda f: abs(f - frequency))


def lowest(modes, label):
    """The lowest frequency with a label; not a number where there is none."""
    return min((f for f, l in modes if l == label), default=math.nan)


def observed_order(coarse, medium, fine):
    """p where the differences between the meshes fall as h^p."""
    ratio = (coarse - medium) / (medium - fine)
    return math.log2(ratio) if ratio > 0 else math.nan


def limit_of_order_2(medium, fine):
    """Richardson's limit for errors that fall as h^2."""
    return fine + (fine - medium) / 3


class Judge:
    """Counts what is out of bounds; not a number is."""

    def __init__(self):
        self.failed = 0

    def within(self, value, low, high):
        good = low <= value <= high
        self.failed += not good
        return "" if good else f"  FAILED: {value:.6g} is not within {low:g} .. {high:g}"
