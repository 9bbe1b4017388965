"""Rayleigh's integral of a part beside its boundary elements, for modes of a result folder."""

import numpy

from ..api import Failed, Results
from ..mesh.cells import boundary_faces, read_cells, triangles_of
from ..tables import BadInput
from .boundary import MOST, Surface, radiate
from .levels import decibel


class Part:
    """The closed surface of a part, m, and where the microphones are."""

    def __init__(self, folder, name):
        self.results = Results(folder)
        text = (folder / "scene.yaml").read_text()
        self.metre = 1e-3 if "\n# units: mm," in text else 1.0
        scene = self.results.scene
        self.names = [one.strip() for one in str(scene["sound_microphones"]).split(",")]
        self.places = self.metre * numpy.array([[float(x) for x in str(scene[f"{one}_at"]).split(",")] for one in self.names])
        self.air = float(scene.get("sound_density", 1.204)), float(scene.get("sound_speed", 343.2))
        with self.results.opened("modes") as file:
            group = file["VTKHDF"]
            parts = [one.decode() for one in group["CellData/part"].attrs["names"]]
            if name not in parts:
                raise BadInput(f"--boundary {name}: no such part; there are {', '.join(parts)}")
            of = group["CellData/part"][:]
            cells = {kind: nodes[of[number] == parts.index(name)] for kind, (number, nodes) in read_cells(group).items()}
            points = group["Points"][:]
        self.triangles = triangles_of(boundary_faces(cells))
        if len(self.triangles) > MOST:
            raise BadInput(f"--boundary {name}: {len(self.triangles)} triangles, of {MOST} at most; take a coarser mesh")
        self.surface = Surface(self.metre * points[self.triangles])

    def normal_velocity(self, mode, omega, energy):
        """At the middles, m/s, of a mode with that energy, J: v = i omega x, |x|_M = 1, v^H M v / 2 = E."""
        shape = self.results.shape(mode)[self.triangles].mean(axis=1)
        scale = numpy.sqrt(2 * energy / self.metre) / omega * self.metre
        return 1j * omega * scale * numpy.einsum("nd,nd->n", shape, self.surface.normal)

    def rayleigh(self, velocity, omega):
        """Pressure at the microphones of the triangles that face them."""
        density, speed = self.air
        heard = []
        for place in self.places:
            r = place - self.surface.middle
            R = numpy.linalg.norm(r, axis=1)
            faces = numpy.einsum("nd,nd->n", r, self.surface.normal) > 0
            wave = numpy.exp(-1j * omega / speed * R) / R * self.surface.area * velocity
            heard.append(1j * omega * density / (2 * numpy.pi) * wave[faces].sum())
        return numpy.array(heard)


def part_and_rows(folder, name, modes):
    """A part, and the rows of sound.csv by their mode, which has those that are asked for."""
    try:
        part = Part(folder, name)
        rows = {int(row["mode"]): row for row in part.results.table("sound")}
    except Failed as error:
        raise BadInput(str(error)) from None
    unknown = [mode for mode in modes if mode not in rows]
    if unknown:
        raise BadInput(f"--modes {unknown[0]}: sound.csv has no such mode")
    return part, rows


def compare(folder, name, modes):
    """Prints for each mode and microphone both levels, and the power beside the equivalent one."""
    part, rows = part_and_rows(folder, name, modes)
    print(f"{name} by itself: {len(part.triangles)} triangles; dB by Rayleigh's integral, by boundary elements")
    for mode in modes:
        omega, energy = 2 * numpy.pi * rows[mode]["freq_hz"], rows[mode]["energy_j"]
        velocity = part.normal_velocity(mode, omega, energy)
        heard, power = radiate(part.surface, velocity, omega, part.places, part.air)
        plain = part.rayleigh(velocity, omega)
        equivalent = part.air[0] * part.air[1] / 2 * (abs(velocity)**2 @ part.surface.area)
        longest = numpy.sqrt(part.surface.area.max()) * omega / (2 * numpy.pi * part.air[1])
        levels = "; ".join(f"{one} {decibel(abs(a)**2 / 2):.1f}, {decibel(abs(b)**2 / 2):.1f}"
                           for one, a, b in zip(part.names, plain, heard))
        print(f"  mode {mode:3d}  {rows[mode]['freq_hz']:10.3f} Hz  {levels}; radiates {power / equivalent:.3f} of the equivalent power"
              + (f"; coarse: {longest:.2f} wavelengths a triangle" if longest > 1 / 6 else ""))
