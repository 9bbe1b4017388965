"""Meshes of one body from every element of squeal's table, by gmsh: rings and bars, structured hexahedra and wedges, free
tetrahedra, or tetrahedra of structured layers where sizes are to be halved exactly."""

import math
from dataclasses import dataclass

from ..mesh.gmsh import run_gmsh

# name -> options of squeal, order, whether faces have no middle nodes, shape
ELEMENTS = {
    "tet4": ("", 1, 0, "tet"), "tet10": ("", 2, 0, "tet"),
    "wedge6": ("", 1, 0, "wedge"), "wedge15": ("", 2, 1, "wedge"),
    "hex8 full": ("-model_element full", 1, 0, "hex"), "hex8 QM6": ("", 1, 0, "hex"),
    "hex20": ("", 2, 1, "hex"), "hex27": ("", 2, 0, "hex"),
}


@dataclass(frozen=True)
class Ring:
    """Radii and thickness, m."""
    inner: float
    outer: float
    thickness: float

    def counts(self, size):
        """Elements along r, around, along z: two at least, since the shear of a plate is a parabola over its thickness."""
        around = math.pi * (self.inner + self.outer)
        return [max(1, round((self.outer - self.inner) / size)), 4 * max(2, round(around / size / 4)),
                max(2, round(self.thickness / size))]

    def geometry(self, layers):
        """Of gmsh; layers along r, around, along z, each "" for free ones."""
        lines = [f"Point(1) = {{{self.inner}, 0, 0}};",
                 f"line[] = Extrude {{{self.outer - self.inner}, 0, 0}} {{Point{{1}};{layers[0]}}};", "last = line[1];"]
        for i in range(4):
            lines += [f"out{i}[] = Extrude {{{{0, 0, 1}}, {{0, 0, 0}}, Pi / 2}} {{Line{{last}};{layers[1]}}};",
                      f"last = out{i}[0];",
                      f"body{i}[] = Extrude {{0, 0, {self.thickness}}} {{Surface{{out{i}[1]}};{layers[2]}}};"]
        return [*lines, 'Physical Volume("body") = {body0[1], body1[1], body2[1], body3[1]};']


@dataclass(frozen=True)
class Bar:
    """Sizes along x, y, z, m."""
    sides: tuple

    def counts(self, size):
        """Elements along x, y, z."""
        return [max(1, round(side / size)) for side in self.sides]

    def geometry(self, layers):
        """Of gmsh; the face x = 0 is "root"."""
        x, y, z = self.sides
        return ["Point(1) = {0, 0, 0};", f"line[] = Extrude {{0, {y}, 0}} {{Point{{1}};{layers[1]}}};",
                f"face[] = Extrude {{0, 0, {z}}} {{Line{{line[1]}};{layers[2]}}};",
                f"body[] = Extrude {{{x}, 0, 0}} {{Surface{{face[1]}};{layers[0]}}};",
                'Physical Volume("body") = {body[1]};', 'Physical Surface("root") = {face[1]};']


def layers_of(body, counts, shape):
    """What extrusions along each direction say: hexahedra, wedges, or tetrahedra of structured layers."""
    ring = isinstance(body, Ring)  # made of quarters
    texts = [f" Layers{{{n // 4 if ring and i == 1 else n}}};" for i, n in enumerate(counts)]
    last = 2 if ring else 0
    for i in range(3):
        if shape == "hex" or (shape == "wedge" and i == last):
            texts[i] += " Recombine;"
    return texts


def mesh_body(path, body, element, size, counts=None):
    """Writes the mesh. Tetrahedra are free unless counts are given; others have body.counts(size)."""
    _, order, incomplete, shape = ELEMENTS[element]
    free = shape == "tet" and not counts
    layers = [""] * 3 if free else layers_of(body, counts or body.counts(size), shape)
    source = path.with_suffix(".geo")
    source.write_text("\n".join(body.geometry(layers)) + "\n", encoding="utf-8")
    sizes = ["-clmin", size, "-clmax", size] if free else []
    run_gmsh(source, path, "-order", order, "-setnumber", "Mesh.SecondOrderIncomplete", incomplete, "-bin", *sizes)
