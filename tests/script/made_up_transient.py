#!/usr/bin/env python3
"""Writes transient.csv, and with h5py snapshots, of a made-up vibration: a load comes on, a line grows by a known rate
until it is cut at a level, with harmonics of known levels; the normal force follows it and is cut at zero.

After saturation the normal force is FORCE (1 + depth sin(phase)), cut at zero: it is zero for the share
arccos(1 / depth) / pi of the time if depth > 1. The disc's face vibrates as cos(DIAMETERS angle).

usage: made_up_transient.py FOLDER [depth [growth]]
"""

import math
import sys
from pathlib import Path

import numpy

FORCE, MU, RAMP = 100.0, 0.5, 2e-3  # N, -, s
FREQUENCY, LEVEL = 3430.0, 2000.0  # Hz, m/s^2
HARMONICS = {2: -20.0, 3: -26.0, 4: -30.0}  # dB
DIAMETERS, PAIRS = 4, 121
PROBE = ("x_m", "y_m", "z_m", "vx_m_s", "vy_m_s", "vz_m_s", "ax_m_s2", "ay_m_s2", "az_m_s2")
COLUMNS = ("time_s,normal_force_n,friction_force_n,n_closed,n_stick,kinetic_j,strain_j,external_work_j,friction_work_j,"
           "contact_work_j,damping_work_j,energy_error_j,integrator_work_j,friction_heat_j,n_open,projector_residual,"
           "projector_sweeps").split(",")


class Transient:
    """Times (s), amplitude relative to the level, acceleration in y (m/s^2), forces (N)."""

    def __init__(self, end=0.03, step=5e-6, growth=400.0, saturation=0.018, depth=0.8, noise=0.0, second=0.0):
        self.time = step * numpy.arange(round(end / step) + 1)
        self.growth = growth
        loaded = numpy.where(self.time < RAMP, 0.5 - 0.5 * numpy.cos(numpy.pi * self.time / RAMP), 1.0)
        exponent = growth * (self.time - (saturation if growth > 0 else 0))
        self.amplitude = numpy.exp(numpy.minimum(exponent, 0)) * loaded
        phase = 2 * numpy.pi * FREQUENCY * self.time
        full = self.amplitude**2
        self.acceleration = LEVEL * self.amplitude * (numpy.cos(phase) + full * sum(
            10**(level / 20) * numpy.cos(k * phase) for k, level in HARMONICS.items()))
        self.acceleration += second * LEVEL * numpy.exp(-60 * self.time) * numpy.cos(2 * numpy.pi * 5210 * self.time)
        random = numpy.random.default_rng(7)
        self.acceleration += noise * LEVEL * random.standard_normal(len(self.time))
        self.normal = FORCE * loaded * numpy.maximum(0, 1 + depth * self.amplitude * numpy.sin(phase))

    def detached_share(self, depth):
        """Share of the time without force after saturation."""
        return math.acos(1 / depth) / math.pi if depth > 1 else 0.0

    def table(self, probe="pad_edge"):
        """Columns by name."""
        n_open = numpy.where(self.normal > 0, numpy.rint(20 + 30 * self.amplitude), PAIRS)
        zero = numpy.zeros_like(self.time)
        heat = 0.18 * MU * FORCE * self.time
        values = {"time_s": self.time, "normal_force_n": self.normal, "friction_force_n": MU * self.normal,
                  "n_closed": PAIRS - n_open, "n_stick": numpy.rint(8 * self.amplitude * (self.normal > 0)),
                  "kinetic_j": 1e-3 * self.amplitude**2, "strain_j": 1e-3 * (1 + self.amplitude**2),
                  "external_work_j": heat + 1e-3, "friction_work_j": -heat,
                  "energy_error_j": 1e-15 * numpy.sqrt(1 + self.time / 1e-5), "friction_heat_j": heat, "n_open": n_open}
        columns = {name: values.get(name, zero) for name in COLUMNS}
        if probe:
            columns.update({f"{probe}_{name}": zero for name in PROBE})
            columns[f"{probe}_ay_m_s2"] = self.acceleration
            columns[f"{probe}_vy_m_s"] = self.velocity()
        return columns

    def velocity(self):
        """Whose central differences are the acceleration, m/s."""
        step = self.time[1] - self.time[0]
        velocity = numpy.zeros_like(self.time)
        velocity[1] = step * self.acceleration[0]
        for first in (0, 1):
            jumps = 2 * step * self.acceleration[first + 1:len(velocity) - 1:2]
            velocity[first + 2::2] = velocity[first] + numpy.cumsum(jumps)
        return velocity


def write_table(folder, columns, name="transient.csv"):
    """The columns as a table."""
    folder.mkdir(parents=True, exist_ok=True)
    rows = numpy.stack(list(columns.values()), axis=1)
    numpy.savetxt(folder / name, rows, fmt="%.15g", delimiter=",", header=",".join(columns), comments="")


def ring_mesh(n_angle=72, radii=(0.05, 0.085, 0.12), thickness=0.01):
    """Nodes [n][3] and hexahedra of a disc, and a block on its face."""
    angle = 2 * numpy.pi * numpy.arange(n_angle) / n_angle
    points = [(r * math.cos(a), r * math.sin(a), z) for z in (-thickness, 0) for r in radii for a in angle]
    rows = len(radii)

    def node(layer, ring, i):
        return (layer * rows + ring) * n_angle + i % n_angle

    cells = [[node(k, r + a, i + b) for k in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
             for r in range(rows - 1) for i in range(n_angle)]
    first = len(points)
    square = ((0.105, -0.005), (0.115, -0.005), (0.115, 0.005), (0.105, 0.005))
    points += [(x, y, z) for z in (0, 0.01) for x, y in square]
    cells.append(list(range(first, first + 8)))
    return numpy.array(points), numpy.array(cells)


def write_snapshot(path, velocity, points, cells):
    """One snapshot in the layout of squeal's fields."""
    import h5py
    with h5py.File(path, "w") as file:
        group = file.create_group("VTKHDF")
        group["Points"], group["Connectivity"] = points, cells.ravel()
        group["Offsets"], group["Types"] = 8 * numpy.arange(len(cells) + 1), numpy.full(len(cells), 12, "u1")
        part = numpy.zeros(len(cells), int)
        part[-1] = 1
        group["CellData/part"] = part
        group["CellData/part"].attrs["names"] = numpy.array([b"disc", b"pad"])
        group["PointData/velocity_m_s"] = velocity
        group["PointData/displacement_m"] = 0 * velocity


def write_snapshots(folder, times, diameters=DIAMETERS):
    """Snapshots and the text with their times: the wanted shape, and a slower one with two diameters of small part."""
    points, cells = ring_mesh()
    angle, radius = numpy.arctan2(points[:, 1], points[:, 0]), numpy.hypot(points[:, 0], points[:, 1])
    lines = []
    for i, time in enumerate(times):
        velocity = numpy.zeros_like(points)
        velocity[:, 2] = (radius / 0.12 - 0.05 / 0.12) * (
            numpy.cos(diameters * angle) * math.sin(2 * math.pi * FREQUENCY * time) + 0.2 * numpy.cos(2 * angle))
        name = f"snapshot_{i:04d}.h5"
        write_snapshot(folder / name, velocity, points, cells)
        lines += [f'<Grid><Time Value="{time:.15g}"/>', f"<DataItem>{name}:/VTKHDF/Points</DataItem></Grid>"]
    (folder / "transient.xmf").write_text("\n".join(lines))


if __name__ == "__main__":
    target = Path(sys.argv[1])
    made = Transient(*([] if len(sys.argv) < 4 else [0.03, 5e-6, float(sys.argv[3])]),
                     depth=float(sys.argv[2]) if len(sys.argv) > 2 else 0.8, noise=2e-4, second=2e-3)
    write_table(target, made.table())
    write_snapshots(target, made.time[5000:5400:20])
