"""Pictures of the disc's face in a vibration, and how high its antinode at the contact is."""

import base64
import io
import math

import matplotlib.pyplot as plt
import numpy

from ..mesh.bodies import Scene, opened
from ..report.markup import tag
from ..transient.spectrum import circle_content
from ..tables import read_table
from ..transient.history import snapshots
from ..transient.shape import draw_face, face_of, read_shapes

SIZE, DPI = 3.4, 110  # inches, dots per inch


class Shape:
    """A face, the values across it, and the number of its nodal diameters."""

    def __init__(self, face, values, diameters):
        self.face, self.values, self.diameters = face, values, diameters

    def antinode_at_contact(self):
        """Largest value of the outer circle within half a wave of the contact, over the largest elsewhere on it."""
        angle = self.face.angle - numpy.arctan2(*self.face.foot.mean(axis=0)[::-1])
        near = abs(numpy.angle(numpy.exp(1j * angle))) < numpy.pi / (2 * max(self.diameters, 1))
        ring = abs(self.values[self.face.ring])
        return float(ring[near].max() / ring[~near].max())

    def image(self, about):
        """As an element of the page; the paper on which it is drawn is clear."""
        figure = plt.figure(figsize=(SIZE, SIZE), dpi=DPI)
        try:
            draw_face(figure.add_axes([0, 0, 1, 1]), self.face, self.values)
            file = io.BytesIO()
            figure.savefig(file, format="png", transparent=True)
        finally:
            plt.close(figure)
        source = "data:image/png;base64," + base64.b64encode(file.getvalue()).decode()
        return tag("img", src=source, alt=about, width=int(SIZE * DPI), height=int(SIZE * DPI), class_="shape")


def mode_shape(folder, disc, number):
    """Of a mode of modes.h5."""
    with opened(folder / "modes.h5") as file:
        scene = Scene(file, disc)
        face = face_of(scene)
        values = scene.displacement(number)[face.nodes] @ face.axis
    return Shape(face, values, int(circle_content(face.angle, values[face.ring]).argmax()))


def peak_shape(folder, label):
    """Of the peak with a label, of a response in time: frequency (Hz) of its mode, and for each circle its radius (mm),
    angles from the contact (degrees, rising), values across the face; none where no peak has the label."""
    peaks = read_table(folder / "peaks.csv", {"mode": int, "mode_freq_hz": float, "label": str})
    peak = next((row for row in peaks if row["label"] == label), None)
    if not peak:
        return None, []
    value = f"peak_{peak['mode']}_re"
    rows = read_table(folder / "operating_shapes.csv", {"radius_m": float, "angle_rad": float, value: float})
    circles = []
    for radius in sorted({round(row["radius_m"], 6) for row in rows}, reverse=True):
        own = sorted((math.degrees(math.remainder(row["angle_rad"], 2 * math.pi)), row[value]) for row in rows
                     if abs(row["radius_m"] - radius) < 1e-6)
        circles.append((1e3 * radius, *zip(*own)))
    return peak["mode_freq_hz"], circles


def moving_shape(folder, disc, first):
    """Of a transient: the snapshot of the largest velocity from a time (s) on; None where it has no snapshots."""
    files = snapshots(folder)
    if not files:
        return None, 0.0
    shapes = read_shapes(files, disc, first)
    chosen = int((shapes.velocity[:, shapes.face.ring]**2).mean(axis=1).argmax())
    return Shape(shapes.face, shapes.velocity[chosen], shapes.diameters()), shapes.share()
