"""In which directions a part radiates: levels on circles about it, by boundary elements, for modes of a result folder."""

import matplotlib.pyplot as plt
import numpy

from ..picture import save_picture
from ..tables import BadInput
from .boundary import radiate
from .check import part_and_rows
from .levels import decibel

PLACES = 72  # on a circle
PLANES = (("x", "y"), ("y", "z"), ("z", "x"))


def circles(middle, distance):
    """Angles, and places [planes][angles][3] about a middle, m."""
    angle = 2 * numpy.pi * numpy.arange(PLACES) / PLACES
    places = numpy.zeros((3, PLACES, 3))
    for i, plane in enumerate(PLANES):
        for axis, value in zip(plane, (numpy.cos(angle), numpy.sin(angle))):
            places[i, :, "xyz".index(axis)] = distance * value
    return angle, middle + places


def draw_directivity(folder, name, modes, distance):
    """A picture a mode: dB on circles in three planes. Prints the loudest direction of each."""
    part, rows = part_and_rows(folder, name, modes)
    middle = (part.surface.area @ part.surface.middle) / part.surface.area.sum()
    reach = numpy.linalg.norm(part.surface.corners - middle, axis=2).max()
    if not reach < distance < float("inf"):
        raise BadInput(f"--distance {distance:g} m: {name} reaches {reach:.3g} m from its middle; take more")
    angle, places = circles(middle, distance)
    for mode in modes:
        omega, energy = 2 * numpy.pi * rows[mode]["freq_hz"], rows[mode]["energy_j"]
        heard, _ = radiate(part.surface, part.normal_velocity(mode, omega, energy), omega, places.reshape(-1, 3), part.air)
        levels = decibel(abs(heard.reshape(3, PLACES))**2 / 2)
        figure, axes = plt.subplots(1, 3, figsize=(12, 4.4), subplot_kw={"projection": "polar"}, layout="constrained")
        for plane, line, axis in zip(PLANES, levels, axes):
            axis.plot(numpy.append(angle, 2 * numpy.pi), numpy.append(line, line[0]))
            axis.set_title(f"{plane[0]} to {plane[1]}")
            axis.set_ylim(levels.max() - 40, levels.max() + 2)
        figure.suptitle(f"{name}, mode {mode}, {rows[mode]['freq_hz']:.0f} Hz: dB at {distance:g} m with {energy:g} J")
        save_picture(figure, folder / f"directivity_{mode}.png", 120)
        plane, i = numpy.unravel_index(levels.argmax(), levels.shape)
        print(f"mode {mode}: {rows[mode]['freq_hz']:.1f} Hz, loudest {levels.max():.1f} dB at {numpy.degrees(angle[i]):.0f} degrees from "
              f"{PLANES[plane][0]} to {PLANES[plane][1]}, least {levels.min():.1f} dB")
    return folder / f"directivity_{modes[-1]}.png"
