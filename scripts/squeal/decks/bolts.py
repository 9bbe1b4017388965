"""Bolts that are cut in a plane and tightened: the elements on one side of the cut become a part of their own, which shares its nodes
with the rest, and a load of the scene draws it."""

from dataclasses import dataclass

import numpy

from .deck import Section
from .mesh.faces import cell_middles, nodes_by_kind, surface_nodes


@dataclass
class Bolt:
    """Cells on one side of the cut, its nodes, the axis out of these cells; a tension or a shortening."""
    name: str
    cells: numpy.ndarray
    nodes: numpy.ndarray
    axis: numpy.ndarray
    place: object
    words: str
    tension: float = 0.0
    shortening: float = 0.0


def normal_of(deck, faces):
    """The mean normal of faces, out of their cells."""
    middle, normal = numpy.zeros((len(faces), 3)), numpy.zeros((len(faces), 3))
    for rows, nodes in nodes_by_kind(deck, faces):
        n = 3 if nodes.shape[1] in (3, 6) else 4
        x = deck.x[nodes[:, :n]]
        middle[rows] = x.mean(axis=1)
        normal[rows] = numpy.cross(x[:, 2] - x[:, 0], x[:, 3 if n == 4 else 1] - x[:, 1 if n == 4 else 0])
        normal[rows] *= -1 if n == 3 else 1
    inward = cell_middles(deck, faces[:, 0]) - middle
    normal *= -numpy.sign((normal * inward).sum(axis=1))[:, None]
    total = normal.sum(axis=0)
    return total / max(numpy.linalg.norm(total), 1e-300)


def side_of(deck, faces, axis):
    """Cells on the side of the faces' own cells that have a node of the cut: those whose middle is behind its plane."""
    nodes = surface_nodes(deck, faces)
    on = numpy.zeros(deck.n_nodes, bool)
    on[nodes] = True
    found = [low + numpy.flatnonzero(on[block.nodes].any(axis=1)) for low, block in zip(deck.firsts(), deck.blocks)]
    cells = numpy.concatenate(found)
    behind = (cell_middles(deck, cells) - deck.x[nodes].mean(axis=0)) @ axis < 0
    return numpy.unique(numpy.concatenate([cells[behind], faces[:, 0]])), nodes


def split_sections(deck):
    """Makes a section of each bolt's cells; bolts whose cells have none, or several, are listed, and left out."""
    kept = []
    for bolt in deck.bolts:
        having = [section for section in deck.sections if numpy.isin(bolt.cells, section.cells).any()]
        if len(having) != 1:
            deck.note(bolt.place, f"{bolt.words}: its elements are of {len(having)} sections, one is needed: not tightened")
            continue
        (old,) = having
        rest = numpy.setdiff1d(old.cells, bolt.cells)
        if not len(rest):
            deck.note(bolt.place, f"{bolt.words}: no element of its section is on the other side of the cut: not tightened")
            continue
        old.cells = rest
        deck.sections.append(Section(f"{old.name}_end", bolt.cells, old.material, old.axes, bolt.place))
        kept.append((bolt, deck.sections[-1]))
    deck.bolts = kept


def add_bolts(assembly, parts):
    """Loads of the scene; parts: of a section's number the name of the part."""
    for bolt, section in assembly.deck.bolts:
        number = next(k for k, other in enumerate(assembly.deck.sections) if other is section)
        written = assembly.node_set(bolt.nodes, "", f"{bolt.name}_cut")
        comment = str(bolt.place)
        size = ("tension", ("force", (bolt.tension,))) if bolt.tension else ("shortening", ("length", (bolt.shortening,)))
        assembly.add("loads", bolt.name, [("set", written, comment), ("part", parts[number], comment),
                                          ("axis", ("", tuple(bolt.axis)), f"{comment} out of {parts[number]}"), (*size, comment)])


def add_stages(assembly):
    """First surfaces that overlap are fitted, then bolts tightened, before anything else acts."""
    entries = assembly.result.entries
    bolts = [entry.name for entry in entries if entry.kind == "loads" and any(key == "part" for key, *_ in entry.rows)]
    rest = {kind: [entry.name for entry in entries if entry.kind == kind and entry.name not in bolts] for kind in ("loads", "motions")}
    rest["sliding"] = [entry.name for entry in entries if entry.kind == "contacts" and any(key == "rotation" for key, *_ in entry.rows)]
    rows = [(key, ",".join(names), "all else") for key, names in rest.items() if names]
    fits = [name for name, _ in assembly.result.fits]
    if fits and (bolts or rows):
        assembly.add("stages", "fit", [("interferences", ",".join(fits), str(assembly.result.fits[0][1]))])
    if bolts and (fits or rows):
        assembly.add("stages", "tighten", [("loads", ",".join(bolts), str(assembly.deck.bolts[0][0].place))])
    if rows and (bolts or fits):
        assembly.add("stages", "act", rows)
