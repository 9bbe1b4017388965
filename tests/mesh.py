#!/usr/bin/env python3
"""Writes the meshes of the verification and invariance tests as Gmsh files.

    mesh.py beam --elements 20,4,2 cantilever.msh
    mesh.py rig --format 2.2 --binary --renumber 7 --move rig.msh

beam  a bar of 100 x 10 x 5 mm along x: volume "beam", end x = 0 "root"
rig   a ring and a block that stands on a sector of its face with nodes of its own: volumes "disc", "block", surfaces
      "disc_inner", "disc_face", "block_face", "block_top"
blocks  a block of 100 x 100 x 100 mm (x, y around 0, z from 0) on a base that reaches two elements farther on each side
      and 20 mm down: volumes "base", "block", surfaces "base_bottom", "base_top", "block_bottom", "block_top",
      "block_left", "block_right" (least and largest y). The nodes of both match; --lift moves the bottom of the block,
      more than its inside, by gap + tilt (y / 100 mm + 1/2) + crown (2 y / 100 mm)^2
bars  two bars of 100 x 10 x 10 mm along x, GAP of --lift apart at x = 0: volumes "left", "right", surfaces "left_start",
      "left_end", "right_start", "right_end" (least and largest x)
ball  a quarter of a ball of 10 mm radius, cut by x = 0 and y = 0, GAP of --lift above a plate: volumes "ball", "plate", surfaces
      "ball_x", "ball_y", "ball_pole" (towards the plate), "plate_top"; --elements N,1,1
cylinders  a shoe on a shaft, both parts of rings about z: volumes "shaft", "shoe", surfaces "shaft_inner", "shaft_face"
      (outward, 80 mm from the axis), "shoe_face", "shoe_top"; --elements along r, around and along z of the shaft. Its
      facets turn by 160 degrees / the second. The nodes of the faces do not match, and lie on the same cylinder.

sector  a pad on a sector of a disc, r 60..120 mm, 40 degrees, 15 mm high from z = 0; the disc 20 mm thick reaches two elements farther
      on each side. Nodes match: volumes "disc", "pad", surfaces "disc_bottom", "disc_face", "pad_face", "pad_top"; --elements of the
      pad along r, around and along z

--renumber draws new numbers of nodes and elements, a new order of both, and a new first node of each element.
--move turns the mesh by MOVE_ROTATION, a quarter turn about (1, 2, 2), and shifts it; the direction y becomes
(-4, 4, 7) / 9. --scale 1000 gives mm. --odd writes what Gmsh may write as well: each group in two parts, of a mesh that is
partitioned, with the entities that were; the second part stands reversed in its physical group, and is in another one, without
name, first; parameters of nodes; ghost elements; sections without meaning here. Lengths in m.
"""

import argparse
import itertools
from pathlib import Path

import numpy as np

from mesh_file import TYPES, write  # noqa: F401 others take TYPES from here

MOVE_ROTATION = np.array([[1, -4, 8], [8, 4, 1], [-4, 7, 4]]) / 9
BLOCK_SIZE, BASE_HEIGHT, BASE_MARGIN = np.array([0.1, 0.1, 0.1]), 0.02, 2
BEAM_SIZE = np.array([0.1, 0.01, 0.005])
BAR_SIZE = np.array([0.1, 0.01, 0.01])
RADIUS, CORE, GRADING = 0.01, 0.4, 4.5  # of the ball, m; half width of its cubic core / radius; see graded()
MOVE_SHIFT = np.array([0.3, -0.2, 0.5])
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])


# --- meshes: nodes [n, 3], and groups, name -> elements [m, nodes of an element] with indices of nodes from 0


class Grid:
    """Structured hexahedra; node (i, j, k) has index first + i + ni (j + nj k). The second direction may be closed."""

    def __init__(self, cells, closed=False, first=0):
        self.cells, self.first = np.array(cells), first
        self.nodes = self.cells + [1, 0 if closed else 1, 1]

    def index(self, at):
        i, j, k = np.moveaxis(np.asarray(at), -1, 0)
        return self.first + i + self.nodes[0] * (j % self.nodes[1] + self.nodes[1] * k)

    def places(self, counts):
        """All (i, j, k) below counts, i fastest."""
        return np.stack(np.meshgrid(*map(np.arange, counts), indexing="ij"), -1).transpose(2, 1, 0, 3).reshape(-1, 3)

    def hexahedra(self):
        return self.index(self.places(self.cells)[:, None] + CORNERS)

    def side(self, axis, at):
        """Quadrilaterals between nodes of equal index `at` along an axis."""
        counts = self.cells.copy()
        counts[axis] = 1
        around = np.zeros((4, 3), int)
        around[:, [(axis + 1) % 3, (axis + 2) % 3]] = [[0, 0], [1, 0], [1, 1], [0, 1]]
        corners = self.places(counts)[:, None] + around
        corners[..., axis] = at
        return self.index(corners)


def beam(elements):
    grid = Grid(elements)
    nodes = (grid.places(grid.nodes) / grid.cells - [0, 0.5, 0.5]) * BEAM_SIZE
    return nodes, {"beam": grid.hexahedra(), "root": grid.side(0, 0)}


def polar(places, r, theta, z):
    """Points of the grid by the values of r, theta, z at its indices."""
    r, theta, z = r[places[:, 0]], theta[places[:, 1]], z[places[:, 2]]
    return np.stack([r * np.cos(theta), r * np.sin(theta), z], -1)


def rig():
    """Ring r 50..120 mm, 10 mm thick, 7 x 36 x 2 elements; block on its rings 4, 5 and columns 0, 1, 60 mm high."""
    disc = Grid([7, 36, 2], closed=True)
    block = Grid([2, 2, 6], first=int(np.prod(disc.nodes)))
    r, theta = np.linspace(0.05, 0.12, 8), 2 * np.pi * np.arange(36) / 36
    nodes = [polar(disc.places(disc.nodes), r, theta, np.linspace(-0.01, 0, 3)),
             polar(block.places(block.nodes), r[4:7], theta[0:3], np.linspace(0, 0.06, 7))]
    return np.concatenate(nodes), {
        "disc": disc.hexahedra(), "disc_inner": disc.side(0, 0), "disc_face": disc.side(2, 2),
        "block": block.hexahedra(), "block_face": block.side(2, 0), "block_top": block.side(2, 6)}


def blocks(elements, lift):
    """Block on a base; lift = gap, tilt, crown, m."""
    n = np.array(elements)
    base = Grid([*(n[:2] + 2 * BASE_MARGIN), max(1, n[2] // 4)])
    block = Grid(n, first=int(np.prod(base.nodes)))
    lower = (base.places(base.nodes) - [BASE_MARGIN, BASE_MARGIN, base.cells[2]]) / [*n[:2], base.cells[2]]
    upper = block.places(block.nodes) / n
    lower, upper = lower - [0.5, 0.5, 0], upper - [0.5, 0.5, 0]
    rise = lift[0] + lift[1] * (upper[:, 1] + 0.5) + lift[2] * (2 * upper[:, 1])**2
    nodes = [lower * [*BLOCK_SIZE[:2], BASE_HEIGHT], upper * BLOCK_SIZE]
    nodes[1][:, 2] += rise * (1 - upper[:, 2])
    return np.concatenate(nodes), {
        "base": base.hexahedra(), "base_bottom": base.side(2, 0), "base_top": base.side(2, base.cells[2]),
        "block": block.hexahedra(), "block_bottom": block.side(2, 0), "block_top": block.side(2, n[2]),
        "block_left": block.side(1, 0), "block_right": block.side(1, n[1])}


def bars(elements, gap):
    grids = [Grid(elements), Grid(elements, first=int(np.prod(Grid(elements).nodes)))]
    left, right = [(grid.places(grid.nodes) / grid.cells - [0, 0.5, 0.5]) * BAR_SIZE for grid in grids]
    groups = {}
    for name, grid in zip(("left", "right"), grids):
        groups |= {name: grid.hexahedra(), f"{name}_start": grid.side(0, 0), f"{name}_end": grid.side(0, elements[0])}
    return np.concatenate([left - [BAR_SIZE[0], 0, 0], right + [gap, 0, 0]]), groups


def cylinders(elements):
    """Shaft r 60..80 mm, 160 degrees, 40 mm long; shoe r 80..95 mm, 70 degrees, 24 mm long, of larger elements."""
    shaft = Grid([elements[0], elements[1], elements[2]])
    shoe = Grid([elements[0], elements[1] * 3 // 8, max(1, elements[2] // 2)], first=int(np.prod(shaft.nodes)))
    nodes = []
    for grid, radii, half, length in ((shaft, (0.06, 0.08), 80, 0.04), (shoe, (0.08, 0.095), 35, 0.024)):
        theta = np.pi / 2 + np.radians(np.linspace(-half, half, grid.cells[1] + 1))
        z = np.linspace(-length / 2, length / 2, grid.cells[2] + 1)
        nodes.append(polar(grid.places(grid.nodes), np.linspace(*radii, grid.cells[0] + 1), theta, z))
    return np.concatenate(nodes), {
        "shaft": shaft.hexahedra(), "shaft_inner": shaft.side(0, 0), "shaft_face": shaft.side(0, elements[0]),
        "shoe": shoe.hexahedra(), "shoe_face": shoe.side(0, 0), "shoe_top": shoe.side(0, elements[0])}


def sector(elements):
    n = np.array(elements)
    disc = Grid([*(n[:2] + 2 * BASE_MARGIN), max(1, n[2])])
    pad = Grid(n, first=int(np.prod(disc.nodes)))
    nodes = []
    for grid, margin, z in ((disc, BASE_MARGIN, (-0.02, 0)), (pad, 0, (0, 0.015))):
        steps = [np.arange(-margin, n[d] + margin + 1) / n[d] for d in range(2)]
        nodes.append(polar(grid.places(grid.nodes), 0.06 + 0.06 * steps[0], np.radians(40) * (steps[1] - 0.5),
                           np.linspace(*z, grid.cells[2] + 1)))
    return np.concatenate(nodes), {
        "disc": disc.hexahedra(), "disc_bottom": disc.side(2, 0), "disc_face": disc.side(2, disc.cells[2]),
        "pad": pad.hexahedra(), "pad_face": pad.side(2, 0), "pad_top": pad.side(2, n[2])}


def graded(n):
    """n + 1 numbers from 0 to 1 that grow from steps of about 0.1 / n to steps of GRADING / n of themselves."""
    return np.sinh(GRADING * np.arange(n + 1) / n) / np.sinh(GRADING)


def merged(pieces):
    """Nodes of pieces of one body, each with the elements of its groups, with those at the same place made one."""
    nodes, first = np.concatenate([piece[0] for piece in pieces]), 0
    _, kept, place = np.unique(np.round(nodes / 1e-9), axis=0, return_index=True, return_inverse=True)
    groups = {}
    for points, own in pieces:
        for name, elements in own.items():
            groups.setdefault(name, []).append(place.ravel()[elements + first])
        first += len(points)
    return nodes[kept], {name: np.concatenate(parts) for name, parts in groups.items()}


def shell(axes, x, y, radial):
    """Piece between a face of the core and the sphere: x, y on the face, axes their directions and the face's normal.
    The nodes on the sphere are where tan(pi/4 x), tan(pi/4 y), 1 points."""
    grid = Grid([len(x) - 1, len(y) - 1, len(radial) - 1])
    i, j, k = grid.places(grid.nodes).T
    face = np.stack([x[i], y[j], np.ones(len(i))], -1)
    away = np.tan(np.pi / 4 * face)
    away /= np.linalg.norm(away, axis=1)[:, None]
    part = radial[k][:, None]
    return grid, ((1 - part) * CORE * face + part * away) @ np.array(axes)


def ball(n, gap):
    """Core [0, 1]^2 x [-1, 1] and shells below, above, towards x and y; least first in all directions of a piece."""
    along, up, radial = graded(n), np.linspace(-1, 1, n + 1), 1 - graded(n)[::-1]
    ex, ey, ez = np.eye(3)
    core = Grid([n, n, n])
    i, j, k = core.places(core.nodes).T
    pieces = [(CORE * np.stack([along[i], along[j], up[k]], -1),
               {"ball": core.hexahedra(), "ball_x": core.side(0, 0), "ball_y": core.side(1, 0)})]
    for axes, x, y in (((ey, ex, -ez), along, along), ((ex, ey, ez), along, along), ((ey, ez, ex), along, up),
                       ((ez, ex, ey), up, along)):
        grid, nodes = shell(axes, x, y, radial)
        sides = {"ball": grid.hexahedra()}
        for name, normal in (("ball_x", ex), ("ball_y", ey)):
            sides |= {name: grid.side(d, 0) for d in range(2) if np.array_equal(axes[d], normal)}
        if axes[2][2] < 0:
            sides["ball_pole"] = grid.side(2, n)
        pieces.append((nodes, sides))
    nodes, groups = merged(pieces)
    plate = Grid([1, 1, 1], first=len(nodes))
    corners = plate.places(plate.nodes) * [2 * RADIUS, 2 * RADIUS, 0.002] - [RADIUS, RADIUS, 0.002]
    groups |= {"plate": plate.hexahedra(), "plate_top": plate.side(2, 1)}
    return np.concatenate([nodes * RADIUS + [0, 0, RADIUS + gap], corners]), groups


# --- changes that leave the physics alone


def turned_hexahedra():
    """The 24 orders of a hexahedron's nodes that keep its orientation."""
    orders = []
    for axes in itertools.permutations(range(3)):
        for signs in itertools.product([1, -1], repeat=3):
            rotation = np.zeros((3, 3), int)
            rotation[range(3), axes] = signs
            if np.linalg.det(rotation) > 0:
                places = ((2 * CORNERS - 1) @ rotation.T + 1) // 2
                orders.append([CORNERS.tolist().index(place) for place in places.tolist()])
    return np.array(orders)


def renumber(random, nodes, groups):
    """Another order of nodes, groups and elements, and other first nodes of the elements."""
    place = random.permutation(len(nodes))
    nodes = nodes[np.argsort(place)]
    orders = {8: turned_hexahedra(), 4: np.array([np.roll(range(4), k) for k in range(4)])}
    names = list(groups)
    random.shuffle(names)
    changed = {}
    for name in names:
        elements = place[groups[name][random.permutation(len(groups[name]))]]
        order = orders[elements.shape[1]]
        changed[name] = np.take_along_axis(elements, order[random.integers(len(order), size=len(elements))], 1)
    return nodes, changed


# What the command line offers, of its elements along x, y, z and its lift
SHAPES = {"beam": lambda elements, lift: beam(elements),
          "rig": lambda elements, lift: rig(),
          "blocks": blocks,
          "bars": lambda elements, lift: bars(elements, lift[0]),
          "ball": lambda elements, lift: ball(elements[0], lift[0]),
          "cylinders": lambda elements, lift: cylinders(elements),
          "sector": lambda elements, lift: sector(elements)}


def command_line():
    """The parser of the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("shape", choices=SHAPES)
    parser.add_argument("file", type=Path)
    parser.add_argument("--elements", default="20,4,2", help="of the beam, the block on its base, a bar, along x, y, z")
    parser.add_argument("--lift", default="0,0,0", metavar="GAP,TILT,CROWN",
                        help="of the block's bottom; GAP of others; m")
    parser.add_argument("--format", choices=["2.2", "4.1"], default="4.1")
    parser.add_argument("--binary", action="store_true")
    parser.add_argument("--odd", action="store_true")
    parser.add_argument("--renumber", type=int, metavar="SEED")
    parser.add_argument("--move", action="store_true")
    parser.add_argument("--scale", type=float, default=1)
    return parser


def main():
    arguments = command_line().parse_args()
    elements = [int(n) for n in arguments.elements.split(",")]
    lift = [float(length) for length in arguments.lift.split(",")]
    nodes, groups = SHAPES[arguments.shape](elements, lift)
    node_tags = list(range(1, len(nodes) + 1))
    numbers = list(range(1, sum(map(len, groups.values())) + 1))
    if arguments.renumber is not None:
        random = np.random.default_rng(arguments.renumber)
        nodes, groups = renumber(random, nodes, groups)
        node_tags = random.choice(3 * len(node_tags), len(node_tags), replace=False).tolist()
        node_tags = [tag + 1 for tag in node_tags]
        random.shuffle(numbers)
    if arguments.move:
        nodes = nodes @ MOVE_ROTATION.T + MOVE_SHIFT
    write(arguments.file, arguments.format, arguments.binary, arguments.scale * nodes, groups, node_tags, numbers,
          arguments.odd)


if __name__ == "__main__":
    main()
