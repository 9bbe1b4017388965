#!/usr/bin/env python3
"""Checks the disc's shape in the one unstable mode of a run (modes.csv, modes.h5): its nodal diameters, counted on the
disc's rim at the phase of largest displacement, independently of the label, and an antinode at the contact: the part of
the rim's displacement that is even about the pad's radius (angle 0) exceeds the odd part. Exit status: 0, or 1.
"""

import argparse
import csv
import sys
from pathlib import Path

import h5py
import numpy


def unstable_mode(table):
    """Key of the shape and frequency (Hz) of the only unstable mode."""
    with table.open(newline="") as lines:
        unstable = [row for row in csv.DictReader(lines) if row["unstable"] == "1"]
    if len(unstable) != 1:
        raise ValueError(f"{len(unstable)} unstable modes, but one was expected")
    return f"mode_{int(unstable[0]['mode']):03d}", float(unstable[0]["freq_hz"])


def rim(points):
    """Nodes of the outer edge of the disc's face z = 0 in order of their angle, and the angles."""
    radius, angle = numpy.hypot(points[:, 0], points[:, 1]), numpy.arctan2(points[:, 1], points[:, 0])
    face = numpy.abs(points[:, 2]) < 1e-9
    nodes = numpy.flatnonzero(face & (radius > radius[face].max() - 1e-9))
    nodes = nodes[numpy.argsort(angle[nodes])]
    return nodes, angle[nodes]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="folder with modes.csv and modes.h5")
    parser.add_argument("diameters", type=int, help="nodal diameters expected")
    args = parser.parse_args()
    key, frequency = unstable_mode(args.folder / "modes.csv")
    with h5py.File(args.folder / "modes.h5") as file:
        shapes = file["VTKHDF/PointData"]
        nodes, angle = rim(file["VTKHDF/Points"][:])
        w = (shapes[key + "_re"][:] + 1j * shapes[key + "_im"][:])[nodes, 2]
    w = (w * numpy.exp(-1j * numpy.angle(w[numpy.abs(w).argmax()]))).real
    diameters = numpy.count_nonzero(numpy.sign(w) != numpy.sign(numpy.roll(w, 1))) / 2
    mirrored = numpy.interp(-angle, angle, w, period=2 * numpy.pi)
    even = numpy.linalg.norm(w + mirrored) / numpy.linalg.norm(w - mirrored)
    print(f"{frequency:.1f} Hz: {diameters:g} nodal diameters on {len(nodes)} nodes of the rim, "
          f"even over odd part {even:.2f}")
    return 0 if diameters == args.diameters and even > 1 else 1


if __name__ == "__main__":
    sys.exit(main())
