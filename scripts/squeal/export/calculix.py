"""Lines of decks of CalculiX (export/inp.py has the decks), runs of it, and the eigenvalues that it prints."""

import math

import numpy

from ..run.program import measured
from ..tables import BadInput


def lines_of(rows):
    """Lines of numbers, at most 16 in one; all but the last end with a comma."""
    for row in rows:
        for first in range(0, len(row), 16):
            yield ", ".join(map(str, row[first:first + 16])) + ("," if first + 16 < len(row) else "")


def node_cards(places):
    """Nodes, from 1; a field of CalculiX has 20 characters."""
    return ["*NODE", *(", ".join([str(number), *(f"{x:.13e}" for x in place)]) for number, place in enumerate(places, 1))]


def run_calculix(folder, cards):
    """Runs a deck; returns its eigenvalues, s of processor and MB of the process."""
    (folder / "job.inp").write_text("\n".join(cards) + "\n")
    text, seconds, megabytes = measured(["ccx", "job"], "ccx", folder=folder)
    if "Job finished" not in text:
        raise BadInput(f"ccx: {text.strip()[-300:]}")
    return eigenvalues(folder / "job.dat"), seconds, megabytes


def eigenvalues(path):
    """sigma + i omega of what *FREQUENCY printed to seven digits, rad/s, by frequency. From unsymmetric matrices they come
    without the column of the squares, and in pairs of either sign of sigma where they are complex."""
    text = path.read_text().partition("E I G E N V A L U E   O U T P U T")[2].partition("P A R T I C I P A T I O N")[0]
    rows = [line.split() for line in text.splitlines()]
    rows = [list(map(float, row[1:])) for row in rows if len(row) in (4, 5) and row[0].isdigit()]
    found = numpy.array([complex(row[-1], 2 * math.pi * row[-2]) for row in rows])
    return found[numpy.argsort(found.imag, kind="stable")]
