"""A disc, clamped at its inner edge, and a pad with a clamped back that slides on it, in hex20 with matching meshes: as
words of squeal and as a deck of CalculiX.

Both have the same contact by penalty, of STIFFNESS, 1e5 times that of the pad, so that it is of no account that squeal
has springs between nodes and CalculiX at the integration points of the faces. All are closed, and friction is mu times
the normal force, along y; export/sliding.py says how CalculiX comes into this state. Eigenvalues then differ by less than 1e-6.
"""

from dataclasses import dataclass
from math import cos, pi, sin

from ..export.options import Options
from ..export.scene_deck import scene_deck
from ..export.sliding import sliding_cards
from .gmsh import run_gmsh

INNER, OUTER, THICK, HEIGHT = 0.05, 0.15, 0.012, 0.02  # m, of the disc, and height of the pad
MATERIALS = {"disc": (210e9, 0.3, 7800), "pad": (25e9, 0.3, 2500)}  # Pa, -, kg/m^3
STIFFNESS = 1e18  # N/m^3


def layers(n):
    """Of hexahedra."""
    return f"Layers{{{n}}}; Recombine;"


@dataclass(frozen=True)
class Mesh:
    """Elements of the disc along r, in a quarter, along z; those under the pad from first to last along r, and half of
    them around; of the pad along z."""
    disc: tuple
    first: int
    last: int
    half: int
    pad: int

    def refined(self, times):
        """The same places, in elements that are as many times smaller."""
        return Mesh(tuple(times * n for n in self.disc), *(times * n for n in (self.first, self.last, self.half, self.pad)))

    def geometry(self):
        """Of gmsh."""
        n, step, wide = self.disc, (OUTER - INNER) / self.disc[0], self.last - self.first
        angle = self.half * pi / 2 / n[1]
        x, y = cos(angle), -sin(angle)
        start, along = INNER + self.first * step, wide * step
        lines = [f"Point(1) = {{{INNER}, 0, 0}};",
                 f"line[] = Extrude {{{OUTER - INNER}, 0, 0}} {{Point{{1}}; Layers{{{n[0]}}};}};", "last = line[1];"]
        for i in range(4):
            lines += [f"out{i}[] = Extrude {{{{0, 0, 1}}, {{0, 0, 0}}, Pi / 2}} {{Line{{last}}; {layers(n[1])}}};",
                      f"last = out{i}[0];",
                      f"body{i}[] = Extrude {{0, 0, {THICK}}} {{Surface{{out{i}[1]}}; {layers(n[2])}}};"]
        return [*lines, f"Point(1000) = {{{start * x!r}, {start * y!r}, {THICK}}};",
                f"edge[] = Extrude {{{along * x!r}, {along * y!r}, 0}} {{Point{{1000}}; Layers{{{wide}}};}};",
                f"face[] = Extrude {{{{0, 0, 1}}, {{0, 0, 0}}, {2 * angle!r}}} {{Line{{edge[1]}}; {layers(2 * self.half)}}};",
                f"pad[] = Extrude {{0, 0, {HEIGHT}}} {{Surface{{face[1]}}; {layers(self.pad)}}};",
                'Physical Volume("disc") = {body0[1], body1[1], body2[1], body3[1]};', 'Physical Volume("pad") = {pad[1]};',
                'Physical Surface("hub") = {body0[5], body1[5], body2[5], body3[5]};',
                'Physical Surface("disc_face") = {body0[0], body1[0], body2[0], body3[0]};',
                'Physical Surface("back") = {pad[0]};', 'Physical Surface("pad_face") = {face[1]};']

    def write(self, path):
        """Has gmsh write the file."""
        source = path.with_suffix(".geo")
        source.write_text("\n".join(self.geometry()) + "\n", encoding="utf-8")
        run_gmsh(source, path, "-order", 2, "-setnumber", "Mesh.SecondOrderIncomplete", 1, form="msh22")


def squeal_words(path, mu, band):
    """Of a run of the modes of a band, Hz."""
    words = ["-model_mesh", path, "-parts", "disc,pad", "-supports", "hub,back", "-hub_set", "hub", "-hub_fix", "xyz",
             "-back_set", "back", "-back_fix", "xyz", "-contacts", "contact", "-contact_surfaces", "pad_face,disc_face",
             "-contact_kn_per_area", STIFFNESS, "-contact_mu", mu, "-contact_slip", "0,1,0", "-modes_band",
             ",".join(map(str, band))]
    for name, values in MATERIALS.items():
        for what, value in zip(("young", "poisson", "density"), values):
            words += [f"-{name}_{what}", value]
    return words


def calculix_cards(path, mu, count):
    """The deck, for so many of the lowest modes."""
    words = [*squeal_words(path, mu, (0, 1)), "-modes_target", 1, "-modes_count", count]
    deck, _ = scene_deck(Options.of_words(words), path, sliding=True)
    return sliding_cards(deck)
