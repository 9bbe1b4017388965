#!/usr/bin/env python3
"""Draws made-up sliding states with scripts/plot/static and checks what the pictures show. Which pairs are closed,
and the pressure of each, follows from the closed form in made_up_static.py. Exit status: 0, or 1.
"""

import tempfile
from pathlib import Path

import numpy
from drawing import drawn, fails, points_like, require
from made_up_static import FORCE, MU, SIDE, State, write_rows
from squeal import provenance
from squeal.static import pairs as static_pairs # found by drawing
from squeal.picture import BLUE, GREEN
from squeal.report import words


def close(found, expected, message, tolerance=1e-12):
    """Equal to within the rounding of %.17g numbers and a few sums."""
    same = numpy.shape(found) == numpy.shape(expected) and numpy.allclose(found, expected, rtol=tolerance, atol=1e-9)
    require(same, f"{message}: {found} instead of {expected}")


def picture(folder):
    """Draws; how many points have each of the two colours."""
    colours = drawn("plot/static", folder)
    return [points_like(colours, c) for c in (BLUE, GREEN)]


def surface_of(folder, rows, columns=None):
    """The only surface of a table."""
    write_rows(folder, rows, columns)
    surfaces = static_pairs.read_surfaces(folder / "static.csv")
    require(len(surfaces) == 1, f"{len(surfaces)} surfaces")
    return surfaces[0]


def test_colours(root):
    """Blue is the arrow (2000 points and more) and the names of the edges, or sticking pairs; green the centre of
    force: breaks when they are drawn without friction or force, or not drawn."""
    cases = [("slides", State(), 2000), ("presses", State(mu=0), 0), ("sticks", State(mu=0, stuck=9), 1000),
             ("free", State(tilt=0), 2000)]
    for name, state, least in cases:
        write_rows(root / name, state.rows())
        blue, green = picture(root / name)
        require(blue >= least and (blue > 150) == (least > 0) and green > 150,
                f"{name}: {blue} blue, {green} green points")
    nothing = [(*row[:5], 0, 0, "open", *row[8:10], 0, *row[11:]) for row in State().rows()]
    write_rows(root / "nothing", nothing)
    require(picture(root / "nothing") == [0, 0], "a force is drawn where there is none")


def test_numbers(root):
    """Sums, cells and rows against the closed form: breaks when places, areas or pairs are mixed up, or open pairs
    coloured. Centre of force of 1 + tilt s when all are closed, by the trapezoidal rule with spacing h: tilt (1/3 +
    h^2/6)."""
    state = State(tilt=0.8)
    surface = surface_of(root / "numbers", state.rows())
    close(surface.lead(), 0.8 * (1 / 3 + 0.2**2 / 6) * 1e3 * SIDE / 2, "centre of force")
    state = State()
    surface = surface_of(root / "numbers", state.rows()[:-11])
    close(surface.middle, numpy.average(state.x[:-11], axis=0, weights=state.area[:-11]), "middle, weighted by area")
    surface = surface_of(root / "numbers", state.rows())
    expected = (f"99 of 121 pairs closed, normal force {FORCE:g} N, sum of the friction forces {MU * FORCE:g} N, "
                f"largest pressure {1e-3 * state.pressure.max():.3g} kPa")
    require(surface.summary().startswith(expected), surface.summary())
    x, y, values = static_pairs.grid_cells(surface)
    close(numpy.outer(numpy.diff(y), numpy.diff(x)).ravel(), 1e6 * state.area, "cells are the areas")
    close(values.filled(0).ravel(), 1e-3 * state.pressure, "pressures of the cells")
    require((values.mask.ravel() == (state.pressure == 0)).all(), "other cells are blank than the open ones")
    borders, mean, closed, pairs = static_pairs.profile(surface)
    close(borders, y, "borders of the rows")
    close(mean, 1e-3 * state.pressure[::11], "mean pressures of the rows")
    require(list(closed) == [0, 0] + 9 * [11] and list(pairs) == 11 * [11], f"closed pairs of the rows: {closed}")


def test_orientation(root):
    """x to the right and y up where z is constant, whatever the order of the pairs; any other plane without distortion,
    and the arrow along the sliding direction."""
    state = State(middle=(0.11, 0.02, -0.3), along=(0, -1, 0))
    surface = surface_of(root / "plane", state.rows()[::-1])
    close(surface.place, 1e3 * state.x[::-1, :2], "places")
    close(surface.direction, [0, -1], "direction")
    require([surface.axis_title(i) for i in (0, 1)] == ["x, mm", "y, mm"], "titles of the axes")
    surface = surface_of(root / "plane", State(across=(0, 1, 0), along=(0, 0, 1)).rows())
    require([surface.axis_title(i) for i in (0, 1)] == ["y, mm", "z, mm"], "titles of the axes where x is constant")
    state = State(across=(1, 0, 0), along=(0, 0, 1))
    close(surface_of(root / "plane", state.rows()).place, 1e3 * state.x[:, [0, 2]], "places where y is constant")
    across, along = numpy.array([0.48, 0.6, -0.64]), numpy.array([0.8, 0, 0.6])
    surface = surface_of(root / "plane", State(across=across, along=along).rows())
    apart = numpy.linalg.norm(surface.place[:, None] - surface.place, axis=2)
    close(apart, 1e3 * numpy.linalg.norm(surface.x[:, None] - surface.x, axis=2), "distances in an oblique plane")
    close(surface.direction @ surface.axes, along, "direction in an oblique plane", 1e-9)
    tail, head = surface.arrow()
    close((head - tail) / numpy.linalg.norm(head - tail), surface.direction, "arrow", 1e-9)
    c, s = numpy.cos(0.3), numpy.sin(0.3)
    surface = surface_of(root / "plane", State(across=(c, s, 0), along=(-s, c, 0)).rows())
    borders, _, _, pairs = static_pairs.profile(surface)
    require(len(borders) == 12 and pairs.sum() == 121 and pairs.min() > 1, f"rows of a turned grid: {pairs}")


def test_millimetres(root):
    """A scene in mm, t, s and MPa, as scene.yaml says, gives the same surface: breaks when its mm are taken for m."""
    state = State()
    metres = surface_of(root / "metres", state.rows())
    rows = [(row[0], *(1e3 * x for x in row[1:5]), *row[5:9], 1e6 * row[9], 1e-6 * row[10], *row[11:]) for row in state.rows()]
    (root / "millimetres").mkdir()
    (root / "millimetres" / "scene.yaml").write_text('# units: mm, t, s, N, MPa\nparts: "disc"\n')
    surface = surface_of(root / "millimetres", rows)
    close(surface.place, metres.place, "places")
    close(surface.value, metres.value, "pressures")
    require(surface.summary() == metres.summary(), surface.summary())


SCENE = """parts: "disc"
disc_young: "{young}"
disc_density: "{density}"
springs: "guide"
guide_set: "lugs"
guide_stiffness_per_area: "0,{area},0"
joints: "pin"
pin_a: "lugs"
pin_stiffness: "{spring},0,0"
points: "caliper"
caliper_set: "lugs"
caliper_mass: "{mass}"
loads: "piston"
piston_set: "back"
piston_pressure: "{pressure}"
contacts: "rubbing"
rubbing_surfaces: "pad,disc"
rubbing_law: "penalty"
rubbing_kn_per_area: "{area}"
"""
METRES = {"young": "110e9", "density": "7100", "area": "1e13", "spring": "5e7", "mass": "4", "pressure": "1e6"}
MILLIMETRES = {"young": "110e3", "density": "7.1e-9", "area": "1e4", "spring": "5e4", "mass": "4e-3", "pressure": "1"}


def test_words(root):
    """The scene in words, of either set of units: breaks when a pressure, a stiffness by area, a bushing or a point is
    said to be nothing, or mm are taken for m."""
    (root / "words").mkdir()
    path, said = root / "words" / "scene.yaml", []
    for units, values in (("m, kg, s, N, Pa", METRES), ("mm, t, s, N, MPa", MILLIMETRES)):
        path.write_text(f"# units: {units}\n{SCENE.format(**values)}")
        said.append(str(words.scene_words(provenance.Provenance(path))))
    require(said[0] == said[1], f"{said[0]} and {said[1]}")
    for text in ("110 GPa", "7100 kg/m³", "10⁴ GN/m³ along y by area", "50 MN/m along x", "mass of 4 kg", "1 MPa on back"):
        require(text in said[0], f"{text} is not in {said[0]}")


def test_holding(root):
    """Contacts that hold slip at the limit of friction anywhere in the plane: breaks when one component of friction is taken for
    the direction."""
    state = State()
    state.turn = numpy.radians(46)
    n, t = state.normal_vector, numpy.array(state.along, float)
    surface = surface_of(root / "holding", state.rows())
    turned = numpy.cos(state.turn) * t + numpy.sin(state.turn) * numpy.cross(n, t)
    close(surface.direction, turned @ surface.axes.T, "direction of sliding")
    picture(root / "holding")


def test_old_columns(root):
    """A table that ends with the status: forces instead of pressures, all pairs one surface, no arrow."""
    state = State()
    surface = surface_of(root / "old", state.rows(), 8)
    require(surface.unit == "N" and surface.direction is None and not surface.name, "columns that are not there")
    close(surface.value, state.normal, "forces per pair")
    close(static_pairs.profile(surface)[1], state.normal.reshape(11, 11).sum(axis=1), "forces of the rows")
    picture(root / "old")


def test_several(root):
    """Two interfaces, one of them a line of pairs, and pairs that form no grid."""
    ragged = [row for i, row in enumerate(State(n=15).rows()) if i % 7]
    rows = [*State().rows("front"), *State().rows("rear", 121)[::11], *[(*r[:8], "ragged", *r[9:]) for r in ragged]]
    write_rows(root / "several", rows)
    surfaces = static_pairs.read_surfaces(root / "several" / "static.csv")
    require([surface.name for surface in surfaces] == ["front", "rear", "ragged"], "other interfaces")
    require([static_pairs.grid_cells(surface) is None for surface in surfaces] == [False, False, True], "other grids")
    picture(root / "several")


def test_errors(root):
    """What cannot be drawn ends in one line that names it."""
    write_rows(root / "bad", State().rows())
    table = root / "bad" / "static.csv"
    text = table.read_text()
    cases = [(text[:-20], "line 122"), ("", "is empty"), (text.split("\n")[0] + "\n", "no rows"),
             (text.replace("lambda_n_n", "force", 1), "no column lambda_n_n"),
             (text.replace(",open,", ",ajar,", 1), "line 2: status is 'ajar'"), ("\udcff", "cannot be read")]
    for content, expected in cases:
        table.write_bytes(content.encode("utf-8", "surrogateescape"))
        fails("plot/static", root / "bad", [], expected)
    table.write_text(text)
    fails("plot/static", root / "bad", ["-o", root / "bad" / "none" / "a.png"], "cannot write")
    table.unlink()
    fails("plot/static", root / "bad", [], f"{table}: no such file")


def main():
    with tempfile.TemporaryDirectory() as folder:
        for test in (test_colours, test_numbers, test_orientation, test_millimetres, test_words, test_holding, test_old_columns,
                     test_several, test_errors):
            test(Path(folder))


if __name__ == "__main__":
    main()
