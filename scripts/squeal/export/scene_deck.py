"""A deck (decks/deck.py) of the options and the mesh of a scene: what squeal computes with, in CalculiX's terms. What these do not
have is a note."""

import numpy

from ..decks.deck import Axes, Block, Contact, Deck, Load, Material, Place, Section, Spring, Support, Tie
from ..decks.mesh.elements import EDGES, SHAPES
from ..decks.mesh.faces import faces_by_three, nodes_by_kind
from ..friction import law_of
from ..mesh.gmsh import DIMENSION, read_any
from ..provenance import about_sliding
from ..tables import BadInput
from .shares import face_shares, set_shares

KINDS = {"tet4": "C3D4", "tet10": "C3D10", "wedge6": "C3D6", "wedge15": "C3D15", "hex8": "C3D8I", "hex20": "C3D20"}
DIFFERS = {"C3D10": "C3D10 integrates its mass by 4 points alone, which moves frequencies; squeal's tet10 is exact",
           "C3D8I": "C3D8I has incompatible modes of its own, squeal's hex8 those of QM6"}
TIE_SHARE = 0.05  # of the size of a facet: how far a tie reaches by itself (src/contact/tie/tie.c)
AXES = {"x": 0, "y": 1, "z": 2}


class Builder:
    """The deck so far, options, and what the mesh names."""

    def __init__(self, options, mesh):
        self.options, self.deck, self.notes, self.known = options, Deck(mesh, "CalculiX"), [], {}
        x, sets = read_any(mesh)
        self.parts = options.names("parts")
        volumes = {shape.gmsh: shape for shape in SHAPES.values()}
        mine = [(name, kind) for name in self.parts for kind in volumes if (name, kind) in sets]
        absent = [name for name in self.parts if name not in {name for name, _ in mine}]
        if absent or not mine:
            raise BadInput(f"{mesh}: has no volume named {absent[0] if absent else 'as a part'}, of -parts")
        used = numpy.unique(numpy.concatenate([sets[key].ravel() for key in mine]))
        into = numpy.full(len(x), -1)
        into[used] = numpy.arange(len(used))
        self.x = x[used]
        self.deck.add_nodes(self.x)
        self.sets = {key: into[rows] for key, rows in sets.items() if (into[rows] >= 0).all()}
        self.add_blocks([(name, volumes[kind], self.sets[name, kind]) for name, kind in mine])

    def add_blocks(self, blocks):
        """Elements of the parts, numbered from 1."""
        first = 1
        full = self.options.text("model_element", "incompatible") == "full"
        for name, shape, nodes in blocks:
            if shape.name not in KINDS:
                raise BadInput(f"{self.deck.path}: part {name} has {shape.name}, which CalculiX does not have")
            kind = "C3D8" if full and shape.name == "hex8" else KINDS[shape.name]
            if kind in DIFFERS and DIFFERS[kind] not in self.notes:
                self.notes.append(DIFFERS[kind])
            local = nodes[:, numpy.argsort(shape.gmsh_order())]
            ids = numpy.arange(first, first + len(nodes))
            cells = self.deck.add_block(Block(shape, kind, ids, local, Place(name, 0)))
            before = self.deck.cell_sets.get(name, (numpy.empty(0, int), None))[0]
            self.deck.cell_sets[name] = numpy.concatenate([before, cells]), Place(name, 0)
            first += len(nodes)

    def corners_of(self, name, dimension):
        """Two or three corners, which tell them, of the elements of a set; a file may have them without other nodes."""
        rows = [rows for (other, kind), rows in self.sets.items() if other == name and DIMENSION.get(kind, 3) == dimension]
        return [row[:, :2 if dimension == 1 else 3] for row in rows]

    def faces(self, name):
        """Faces (cell, face) of a set, none where it has no surface."""
        if name not in self.known:
            found = [faces_by_three(self.deck, corners) for corners in self.corners_of(name, 2)]
            if any(missing.any() for _, missing in found):
                raise BadInput(f"{self.deck.path}: surface {name} has faces that are none of an element")
            self.known[name] = numpy.concatenate([faces for faces, _ in found] or [numpy.empty((0, 2), int)])
        return self.known[name]

    def face_nodes(self, name):
        """All nodes of the faces of a set, by type, in Gmsh's order."""
        return [nodes for _, nodes in nodes_by_kind(self.deck, self.faces(name))]

    def largest_face(self, name):
        """Square root of the area of the largest face of a set."""
        return max(face_shares(self.x[nodes], False).sum(axis=1).max() for nodes in self.face_nodes(name)) ** 0.5

    def edge_nodes(self, name):
        """The same of its edges: ends, and the middle of second order."""
        wanted = numpy.concatenate(self.corners_of(name, 1) or [numpy.empty((0, 2), int)])
        if not len(wanted):
            return []
        middle = {}
        for block in self.deck.blocks:
            for k, (a, b) in enumerate(EDGES[block.shape.family] if block.shape.second else ()):
                ends = numpy.sort(block.nodes[:, [a, b]], axis=1).tolist()
                middle.update(zip(map(tuple, ends), block.nodes[:, block.shape.n_corners + k].tolist()))
        rows = [(a, b, middle.get((min(a, b), max(a, b)), -1)) for a, b in wanted.tolist()]
        return [numpy.array(some) for some in ([row[:2] for row in rows if row[2] < 0], [row for row in rows if row[2] >= 0]) if some]

    def nodes(self, owner):
        """Name of the set of a thing, and its nodes; the set goes into the deck."""
        name = self.options.text(f"{owner}_set")
        others = [rows for (other, kind), rows in self.sets.items() if other == name and DIMENSION.get(kind, 3) in (0, 3)]
        found = [*others, *self.face_nodes(name), *self.edge_nodes(name)]
        if not found:
            raise BadInput(f"{self.deck.path}: has no set '{name}' of -{owner}_set on the parts")
        nodes = numpy.unique(numpy.concatenate([rows.ravel() for rows in found]))
        self.deck.node_sets[name] = nodes, Place(owner, 0)
        return name, nodes

    def surface(self, name, owner):
        """Faces of a set; they go into the deck."""
        faces = self.faces(name)
        if not len(faces):
            raise BadInput(f"{self.deck.path}: has no surface '{name}' of {owner} on the parts")
        self.deck.surfaces[name] = faces, Place(owner, 0)
        return name

    def shares(self, owner, positive):
        """Nodes and shares of a set in its area or length, or alike; and the sum."""
        name, nodes = self.nodes(owner)
        found = set_shares(self.x, self.face_nodes(name), self.edge_nodes(name), positive)
        nodes, shares = found or (nodes, numpy.ones(len(nodes)))
        return nodes, shares, shares.sum()


def add_materials(build):
    """Of each part, with its axes."""
    options, deck = build.options, build.deck
    for name in build.parts:
        young, poisson, shear = (options.numbers(f"{name}_{what}", default) for what, default in
                                 (("young", ""), ("poisson", "0.3"), ("shear", "")))
        if not young or len(young) != (3 if len(poisson) == 3 else len(poisson)):
            raise BadInput(f"{options.path}: {name}_young and {name}_poisson must have as many values, 1, 2 or 3")
        if len(young) == 2:
            plane = young[0] / (2 * (1 + poisson[0]))
            young, poisson, shear = [young[0], *young], [poisson[0], poisson[1], poisson[1]], [plane, shear[0], shear[0]]
        if len(young) == 3 and len(shear) != 3:
            raise BadInput(f"{options.path}: {name}_shear is missing")
        deck.materials[name] = Material(name, Place(name, 0), tuple(young), tuple(poisson), tuple(shear),
                                        options.number(f"{name}_density"), options.number(f"{name}_alpha", "0"),
                                        options.number(f"{name}_beta", "0"))
        axes = material_axes(build, name) if len(young) == 3 else None
        deck.sections.append(Section(name, deck.cell_sets[name][0], name, axes, Place(name, 0)))


def material_axes(build, name):
    """Directions 1 and 2, or the axis of a cylinder and a point of it."""
    options = build.options
    if options.has(f"{name}_cylinder_axis"):
        build.notes.append(f"{name}_cylinder_axis: CalculiX takes the directions at each point of an element, squeal at its centre")
        centre = numpy.array(options.numbers(f"{name}_cylinder_centre", "0,0,0"))
        return Axes(True, numpy.array(options.numbers(f"{name}_cylinder_axis")), centre, Place(name, 0))
    if options.has(f"{name}_axis_3"):
        third = numpy.array(options.numbers(f"{name}_axis_3"))
        first = numpy.cross(numpy.eye(3)[numpy.argmin(abs(third))], third)
        return Axes(False, first, numpy.cross(third, first), Place(name, 0))
    first, second = (numpy.array(options.numbers(f"{name}_axis_{k}", default)) for k, default in ((1, "1,0,0"), (2, "0,1,0")))
    return Axes(False, first, second, Place(name, 0))


def add_holders(build):
    """Supports, motions, springs."""
    options, deck = build.options, build.deck
    for owner in options.names("supports"):
        name, nodes = build.nodes(owner)
        fixed = options.text(f"{owner}_fix", "xyz")
        deck.supports.append(Support(nodes, {AXES[letter]: 0.0 for letter in fixed if letter in AXES}, name, Place(owner, 0)))
    for owner in options.names("motions"):
        name, nodes = build.nodes(owner)
        move = options.numbers(f"{owner}_displacement", "0,0,0")
        chosen = options.text(f"{owner}_directions") or "".join(letter for letter, d in AXES.items() if move[d])
        deck.supports.append(Support(nodes, {AXES[letter]: move[AXES[letter]] for letter in chosen if letter in AXES}, name,
                                     Place(owner, 1)))
    for owner in options.names("springs"):
        for what in ("stiffness", "stiffness_total", "stiffness_per_area"):
            values = numpy.array(options.numbers(f"{owner}_{what}", "0,0,0"))
            if not values.any():
                continue
            name, nodes = build.nodes(owner)
            if what == "stiffness":
                deck.springs.append(Spring(nodes, values, name, Place(owner, 0)))
                continue
            nodes, shares, whole = build.shares(owner, True)
            for share, node in zip(shares / (whole if what.endswith("total") else 1), nodes):
                deck.springs.append(Spring(numpy.array([node]), values * share, "", Place(owner, 0)))


def add_loads(build):
    """Forces, pressures, gravity."""
    options, deck = build.options, build.deck
    gravity = numpy.array(options.numbers("model_gravity", "0,0,0"))
    if gravity.any():
        deck.gravity = gravity, Place("model_gravity", 0)
    for owner in options.names("loads"):
        if not options.has(f"{owner}_set"):
            build.notes.append(f"load {owner}: acts on a point that moves as a set does, which has no counterpart")
            continue
        force, pressure = numpy.array(options.numbers(f"{owner}_force", "0,0,0")), options.number(f"{owner}_pressure", "0")
        if pressure:
            name = build.surface(options.text(f"{owner}_set"), f"-{owner}_set")
            deck.loads.append(Load(name, Place(owner, 0), faces=deck.surfaces[name][0], pressure=pressure))
        if force.any():
            nodes, shares, whole = build.shares(owner, False)
            deck.loads += [Load("", Place(owner, 0), nodes=numpy.array([node]), force=force * share / whole)
                           for node, share in zip(nodes, shares)]


def friction(options, owner):
    """Friction coefficient at the sliding speed."""
    law = law_of(options.text(f"{owner}_friction_law", "coulomb"), options.path)
    if not law.fixed and any(options.numbers(f"{owner}_rotation", "0,0,0")):
        raise BadInput(f"{options.path}: {owner}_friction_law {options.text(f'{owner}_friction_law')} with a rotation: each point has a "
                       "friction coefficient of its own, which a deck cannot say")
    return law.mu({name: options.number(f"{owner}_{name}", "0") for name in law.names},
                  0 if law.fixed else options.number(f"{owner}_speed", "0"))


def add_contacts(build, sliding):
    """Pairs of surfaces; a deck of sliding says where to."""
    options, deck = build.options, build.deck
    for owner in options.names("contacts"):
        names = options.names(f"{owner}_surfaces")
        if len(names) != 2:
            raise BadInput(f"{options.path}: {owner}_surfaces must name two: slave,master")
        slave, master = (build.surface(name, f"-{owner}_surfaces") for name in names)
        mu = friction(options, owner)
        contact = Contact(owner, slave, master, Place(owner, 0), mu or None, contact_stiffness(build, owner, slave))
        contact.slip = options.numbers(f"{owner}_slip", "0,0,0") if sliding else ()
        deck.contacts.append(contact)
        if mu and not sliding:
            build.notes.append(f"{owner}: CalculiX finds by itself which points slip and where to; squeal is told by _slip or _rotation")


def add_ties(build):
    """Surfaces that are glued; a slave without faces is listed."""
    options, deck = build.options, build.deck
    for owner in options.names("ties"):
        names = options.names(f"{owner}_surfaces")
        if len(names) != 2:
            raise BadInput(f"{options.path}: {owner}_surfaces must name two: slave,master")
        if not len(build.faces(names[0])):
            build.notes.append(f"tie {owner}: {names[0]} has no faces; not in the deck, the bodies stay apart")
            continue
        slave, master = (build.surface(name, f"-{owner}_surfaces") for name in names)
        distance = options.number(f"{owner}_distance", "0") or TIE_SHARE * build.largest_face(master)
        deck.ties.append(Tie(owner, slave, master, Place(owner, 0), f"tie {owner}", distance))
        options.text(f"{owner}_far")
        build.notes.append(f"tie {owner}: reaches over {distance:.6g}; across a gap CalculiX has no arm that turns with the surface")


def contact_stiffness(build, owner, slave):
    """Per area; None where contact is exact."""
    options = build.options
    if options.text(f"{owner}_law", "penalty") == "constraint":
        return None
    law = options.text(f"{owner}_pressure_law", "linear")
    if law != "linear":
        raise BadInput(f"{options.path}: {owner}_pressure_law {law}: the deck has one stiffness for all pairs; give {owner}_kn_per_area, "
                       "stiffness_n_m over area_m2 of static.csv, and the law linear")
    if options.has(f"{owner}_kn_per_area"):
        return options.number(f"{owner}_kn_per_area")
    if options.text(f"{owner}_kn") == "identify":
        build.notes.append(f"{owner}_kn identify: squeal finds it by pressing; the deck has exact contact")
        return None
    faces = build.face_nodes(slave)
    area = sum(face_shares(build.x[nodes], False).sum() for nodes in faces)
    count = len(numpy.unique(numpy.concatenate([nodes.ravel() for nodes in faces])))
    build.notes.append(f"{owner}_kn {options.text(f'{owner}_kn')}: N/m of each of {count} pairs becomes N/m^3 on {area:.6g} m^2, "
                       "their mean")
    return options.number(f"{owner}_kn") * count / area


def scene_deck(options, mesh, count=0, sliding=False):
    """The deck with its notes; `count` modes where the scene has a band; `sliding` for sliding.py."""
    build = Builder(options, mesh)
    for add in (add_materials, add_holders, add_loads):
        add(build)
    add_contacts(build, sliding)
    add_ties(build)
    low, high = (options.numbers("modes_band", "0,0") + [0.0, 0.0])[:2]
    target = options.numbers("modes_target", "0")[:1] != [0.0]
    wanted = int(options.number("modes_count", "20")) if target else 20
    if target and options.number("modes_target") > 1:
        build.notes.append(f"modes_target {options.text('modes_target')}: CalculiX finds the lowest modes")
    if build.deck.contacts and build.deck.loads and not about_sliding(options.text, options.names):
        build.notes.append("modes_contact all: modes of the deck are about the pairs that its *STATIC closes")
    build.deck.modes = (count or wanted, 0.0 if target else low, 0.0 if target else high, Place("modes", 0))
    options.used |= {"model_mesh", "model_source", "analysis", *(name for name in options.given if name.startswith("rig_"))}
    return build.deck, build.notes + list(options.left())
