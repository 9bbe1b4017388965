"""What a deck and the scene made of it weigh, and what holds and loads them: mass, centre of mass, inertia, elements, nodes that are
held and loaded, what is joined, force and moment, by part and in all. `of_deck` takes it from the elements, densities, loads of the deck;
written.py reads the scene and its mesh again, from their files. Both give a Model, and `sums` is the same for both."""

from dataclasses import dataclass, field

import numpy

from . import touching
from .mesh.faces import keys_of
from .mesh.integrals import areas, volumes

SAME = 1e-9  # relative difference of sums over straight elements
SHOWN = 6  # parts in the table
MARK = "UNBALANCED"  # the first word where deck and scene differ


@dataclass
class Model:
    """Places are m; values are in SI. Nodes of `held` and `forces` are those of `x`."""
    x: numpy.ndarray
    blocks: list  # (shape, nodes [e][n] in its order)
    parts: list = field(default_factory=list)  # (name, density or None, cells)
    held: numpy.ndarray = None  # [n][3]
    springs: numpy.ndarray = None  # [n][3], N/m
    forces: numpy.ndarray = None  # [n][3], N
    pressed: list = field(default_factory=list)  # (cells [f], nodes [f][k], pressure)
    gravity: numpy.ndarray = None  # m/s^2
    points: list = field(default_factory=list)  # of class Carried
    carried: dict = field(default_factory=dict)  # the same by the node of no element on which loads are
    rigid: list = field(default_factory=list)  # nodes of each rigid set
    links: list = field(default_factory=list)  # stiffness and viscosity [12] of bushings
    equations: int = 0
    touching: dict = None  # of touching.py

    def __post_init__(self):
        n = len(self.x)
        self.held, self.springs, self.forces = numpy.zeros((n, 3), bool), numpy.zeros((n, 3)), numpy.zeros((n, 3))


@dataclass
class Carried:
    """What a set carries at a place: mass, inertia xx, yy, zz, xy, xz, yz about it, force, moment. `node`: one of the set."""
    node: int
    x: numpy.ndarray
    mass: float = 0.0
    inertia: numpy.ndarray = field(default_factory=lambda: numpy.zeros(6))
    force: numpy.ndarray = field(default_factory=lambda: numpy.zeros(3))
    moment: numpy.ndarray = field(default_factory=lambda: numpy.zeros(3))


@dataclass
class Row:
    """Sums of one part."""
    name: str
    volume: float = 0
    mass: float = None  # None: it has no density
    centre: numpy.ndarray = None
    inertia: numpy.ndarray = None  # xx, yy, zz, xy, xz, yz about the centre
    cells: int = 0
    rigid: int = 0  # nodes of rigid sets
    lumped: float = 0  # mass of points
    links: numpy.ndarray = field(default_factory=lambda: numpy.zeros(12))  # sums of stiffness and viscosity of bushings
    equations: int = 0
    held: int = 0
    directions: int = 0  # that are held
    loaded: int = 0
    stiffness: numpy.ndarray = None
    force: numpy.ndarray = None
    moment: numpy.ndarray = None
    gross: float = 0  # sum of the sizes of all forces


def of_deck(deck, blocks, result, units):
    """The model of a deck whose blocks had these nodes [e][n] when it was read, with the node that each became by ties, and groups
    of nodes that move as one."""
    into, joined = result.into, result.joined
    model = Model(deck.x[into] * units.length, [(block.shape, into[nodes]) for block, nodes in zip(deck.blocks, blocks)])
    part_of = numpy.full(deck.n_cells, -1)
    for number, section in enumerate(deck.sections):
        part_of[section.cells] = number
    for number, section in enumerate(deck.sections):
        cells, material = numpy.flatnonzero(part_of == number), deck.materials.get(section.material)
        if len(cells):
            density = None if material is None or material.density is None else material.density * units.density
            model.parts.append((section.name, density, cells))
    solid = numpy.zeros(deck.n_nodes, bool)
    for _, nodes in model.blocks:
        solid[nodes] = True
    for support in deck.supports:
        nodes = numpy.array([node for node in into[support.nodes].tolist() if solid[node] or node not in joined.used], int)
        for d in support.values:
            if d < 3:
                model.held[nodes, d] = True
    for spring in deck.springs:
        numpy.add.at(model.springs, into[spring.nodes], numpy.multiply(spring.stiffness, units.stiffness))
    for load in deck.loads:
        if load.faces is None:
            inside = solid[into[load.nodes]]
            numpy.add.at(model.forces, into[load.nodes[inside]], load.force * units.force)
            carry_load(model, joined, load, load.nodes[~inside], units)
        elif len(load.faces):
            model.pressed += faces_of(model, load.faces, load.pressure * units.stress)
    join_model(model, deck, joined, units)
    model.touching = touching.of_deck(deck, lambda faces: [nodes for _, nodes, _ in faces_of(model, faces, 0)], model.x, units)
    if deck.gravity is not None:
        model.gravity = numpy.multiply(deck.gravity[0], units.length / units.time**2)
    return model


def carry_load(model, joined, load, nodes, units):
    """A force on nodes of no element: on what carries them, else on themselves."""
    moment = numpy.zeros(3) if load.moment is None else load.moment * units.force * units.length
    for node in nodes.tolist():
        group = joined.at(node)
        if group is None or len(group.directions) < 3:
            model.forces[node] += load.force * units.force
        elif group.how != "held":
            point = model.carried.setdefault(node, Carried(int(group.nodes[0]), model.x[node]))
            point.force, point.moment = point.force + load.force * units.force, point.moment + moment


def join_model(model, deck, joined, units):
    """Groups, masses, springs between nodes, equations."""
    for group in joined.groups.groups:
        if group.how == "held":
            model.held[numpy.ix_(group.nodes, list(group.directions))] = True
        elif group.how == "point" and group.rigid:
            model.rigid.append(group.nodes)
    for lump in deck.lumps:
        group, into = joined.carrier(lump.node), joined.groups.into
        if group is None or group.how != "held":
            node = -1 if not lump.written else int(into[lump.node] if group is None else group.nodes[0])
            model.points.append(Carried(node, model.x[lump.node] + lump.offset * units.length, lump.mass * units.mass,
                                        numpy.multiply(lump.inertia, units.mass * units.length**2)))
    for link in deck.links:
        if link.written:
            factor = numpy.repeat([1.0, units.length**2], 3)
            model.links.append(numpy.concatenate([numpy.multiply(link.stiffness, factor * units.stiffness),
                                                  numpy.multiply(link.viscosity, factor * units.mass / units.time)]))
    model.equations = len(joined.follows)


def faces_of(model, faces, pressure):
    """Rows of `pressed` of faces (cell, face)."""
    firsts, found = numpy.cumsum([0, *(len(nodes) for _, nodes in model.blocks)]), []
    of_block = numpy.searchsorted(firsts, faces[:, 0], side="right") - 1
    for block in numpy.unique(of_block).tolist():
        shape, nodes = model.blocks[block]
        for number, local in enumerate(shape.faces()):
            cells = faces[(of_block == block) & (faces[:, 1] == number), 0]
            if len(cells):
                found.append((cells, nodes[cells - firsts[block]][:, local], pressure))
    return found


def cells_of_faces(model, nodes):
    """For faces [f][k] the cell that has each, -1 where none has."""
    keys, cells, first = [], [], 0
    for shape, rows in model.blocks:
        for local in shape.faces():
            corners = local[:3 if len(local) in (3, 6) else 4]
            keys.append(keys_of(rows[:, corners]))
            cells.append(numpy.arange(first, first + len(rows)))
        first += len(rows)
    keys, cells = numpy.concatenate(keys), numpy.concatenate(cells)
    order = numpy.argsort(keys, kind="stable")
    wanted = keys_of(nodes[:, :3 if nodes.shape[1] in (3, 6) else 4])
    at = numpy.minimum(numpy.searchsorted(keys[order], wanted), len(keys) - 1)
    return numpy.where(keys[order[at]] == wanted, cells[order[at]], -1)


def sums(model):
    """A row for each part, one of all, and one of nodes of no element, None where nothing is there. A node or face of several
    parts counts in the first."""
    volume, moment, second = volumes_of(model)
    middle = moment / numpy.where(volume > 0, volume, 1)[:, None]
    part_of, owner = owners(model, len(volume))
    rows = [mass_of(name, density, (volume[chosen], moment[chosen], second[chosen])) for name, density, chosen in model.parts]
    rows.append(Row("of no element", centre=numpy.zeros(3), inertia=numpy.zeros(6)))
    loaded, force, turn, gross = loads_on(model, middle, part_of, owner, len(rows))
    held, directions, loaded = (numpy.bincount(owner, values, len(rows)).astype(int) for values in (
        model.held.any(axis=1), model.held.sum(axis=1), loaded))
    stiffness = numpy.stack([numpy.bincount(owner, model.springs[:, d], len(rows)) for d in range(3)], axis=1)
    for number, row in enumerate(rows):
        row.held, row.directions, row.loaded = int(held[number]), int(directions[number]), int(loaded[number])
        row.stiffness = stiffness[number]
        row.force, row.moment, row.gross = force[number], turn[number], gross[number]
    add_carried(model, rows, owner)
    for row in rows:
        if model.gravity is not None and row.mass:
            row.force = row.force + row.mass * model.gravity
            row.moment = row.moment + row.mass * numpy.cross(row.centre, model.gravity)
            row.gross += row.mass * numpy.linalg.norm(model.gravity)
    lost = rows.pop()
    return rows, total_of(rows, model), lost if lost.held or lost.loaded or lost.stiffness.any() or lost.lumped else None


def add_carried(model, rows, owner):
    """What points carry, and nodes that are joined rigidly."""
    for point in [*model.points, *model.carried.values()]:
        row = rows[owner[point.node] if point.node >= 0 else -1]
        row.lumped += point.mass
        if row.mass is not None and (point.mass or point.inertia.any()):
            join_mass(row, point.mass, point.x, point.inertia)
        if point.force.any() or point.moment.any():
            row.loaded += 1
            row.force = row.force + point.force
            row.moment = row.moment + numpy.cross(point.x, point.force) + point.moment
            row.gross += numpy.linalg.norm(point.force)
    for nodes in model.rigid:
        for number, count in zip(*numpy.unique(owner[nodes], return_counts=True)):
            rows[number].rigid += int(count)


def steiner(mass, arm):
    """Inertia of a mass at an arm."""
    x, y, z = arm
    return mass * numpy.array([y * y + z * z, x * x + z * z, x * x + y * y, -x * y, -x * z, -y * z])


def join_mass(row, mass, x, inertia):
    """Adds a mass at x to a row."""
    total = row.mass + mass
    centre = (row.mass * row.centre + mass * x) / total if total > 0 else row.centre
    row.inertia = row.inertia + steiner(row.mass, row.centre - centre) + inertia + steiner(mass, x - centre)
    row.mass, row.centre = total, centre


def volumes_of(model):
    """Volume, first and second moments of all cells; elements of one shape at once, since some decks have a block for each element."""
    firsts = numpy.cumsum([0, *(len(nodes) for _, nodes in model.blocks)])
    volume, moment, second = numpy.zeros(firsts[-1]), numpy.zeros((firsts[-1], 3)), numpy.zeros((firsts[-1], 6))
    for shape in {shape.name: shape for shape, _ in model.blocks}.values():
        mine = [number for number, (other, _) in enumerate(model.blocks) if other is shape]
        rows = numpy.concatenate([numpy.arange(firsts[number], firsts[number + 1]) for number in mine])
        volume[rows], moment[rows], second[rows] = volumes(shape, model.x[numpy.concatenate([model.blocks[number][1] for number in mine])])
    return volume, moment, second


def owners(model, n_cells):
    """The part of each cell, and the first part that has each node, as numbers; of none the number of parts."""
    part_of, owner = numpy.full(n_cells, len(model.parts)), numpy.full(len(model.x), len(model.parts))
    for number in reversed(range(len(model.parts))):
        part_of[model.parts[number][2]] = number
    firsts = numpy.cumsum([0, *(len(nodes) for _, nodes in model.blocks)])
    of_blocks = [part_of[low:high] for low, high in zip(firsts, firsts[1:])]
    for number in reversed(range(len(model.parts))):
        for (_, nodes), of_block in zip(model.blocks, of_blocks):
            owner[nodes[of_block == number]] = number
    return part_of, owner


def mass_of(name, density, moments):
    """The row of a part with its volume, mass, centre, inertia about it."""
    volume, first, second = (part.sum(axis=0) for part in moments)
    centre = first / volume if volume > 0 else numpy.zeros(3)
    row = Row(name, volume, None if density is None else density * volume, centre, cells=len(moments[0]))
    xx, yy, zz, xy, xz, yz = second
    about_origin = numpy.array([yy + zz, xx + zz, xx + yy, -xy, -xz, -yz])
    row.inertia = (1.0 if density is None else density) * (about_origin - steiner(volume, centre))
    return row


def loads_on(model, middle, part_of, owner, n):
    """Which nodes are loaded; by part force [n][3], moment about the origin [n][3], and the sum of the sizes of forces [n]."""
    loaded = model.forces.any(axis=1)
    force, turn, gross = numpy.zeros((n, 3)), numpy.zeros((n, 3)), numpy.zeros(n)
    some = numpy.flatnonzero(loaded)
    numpy.add.at(force, owner[some], model.forces[some])
    numpy.add.at(turn, owner[some], numpy.cross(model.x[some], model.forces[some]))
    numpy.add.at(gross, owner[some], numpy.linalg.norm(model.forces[some], axis=1))
    for cells, nodes, pressure in model.pressed:
        if not pressure:
            continue
        x = model.x[nodes]
        area, arm = areas(x)
        corners = 3 if nodes.shape[1] in (3, 6) else 4
        outward = numpy.einsum("fi,fi->f", area, x[:, :corners].mean(axis=1) - middle[cells])
        inward = numpy.where(outward > 0, -pressure, pressure)[:, None]
        numpy.add.at(force, part_of[cells], inward * area)
        numpy.add.at(turn, part_of[cells], inward * arm)
        numpy.add.at(gross, part_of[cells], abs(pressure) * numpy.linalg.norm(area, axis=1))
        loaded[nodes] = True
    return loaded, force, turn, gross


def total_of(rows, model):
    """The row of all parts."""
    known = all(row.mass is not None for row in rows)
    found = Row("all", sum(row.volume for row in rows), 0.0, numpy.zeros(3), numpy.zeros(6))
    for row in rows:
        join_mass(found, row.mass if known else row.volume, row.centre, row.inertia)
    found.mass = found.mass if known else None
    for name in ("cells", "held", "directions", "loaded", "stiffness", "force", "moment", "gross", "rigid", "lumped"):
        setattr(found, name, sum(getattr(row, name) for row in rows))
    found.links = numpy.array([numpy.ravel(link) for link in model.links]).reshape(-1, 12).sum(axis=0)
    found.equations = model.equations
    return found


def apart(deck, scene, size):
    """What differs between two rows: pairs (what, of the deck, of the scene)."""
    found = []
    for name, what in (("cells", "elements"), ("held", "held nodes"), ("directions", "held directions"), ("loaded", "loaded nodes"),
                       ("rigid", "nodes that are joined rigidly"), ("equations", "equations")):
        if getattr(deck, name) != getattr(scene, name):
            found.append((what, str(getattr(deck, name)), str(getattr(scene, name))))
    gross = max(deck.gross, scene.gross)
    stiffness = abs(deck.stiffness).sum()
    weight = deck.volume if deck.mass is None else deck.mass
    for name, unit, scale in (("volume", "m^3", deck.volume), ("mass", "kg", deck.mass), ("lumped", "kg", deck.lumped),
                              ("centre", "m", size), ("inertia", "kg m^2", weight * size**2), ("force", "N", gross),
                              ("moment", "N m", gross * size), ("stiffness", "N/m", stiffness),
                              ("links", "N/m, N m/rad, N s/m, N m s/rad", abs(deck.links).max())):
        one, other = getattr(deck, name), getattr(scene, name)
        if (one is None) != (other is None) or (one is not None and not numpy.all(abs(one - other) <= SAME * (scale or 0))):
            found.append((name, f"{shown(one)} {unit}", f"{shown(other)} {unit}"))
    return found


def shown(value):
    """A number or three, of which rounding beside the largest is 0; none as a dash."""
    if value is None:
        return "-"
    values = numpy.atleast_1d(value)
    return ", ".join(f"{number + 0:.6g}" for number in numpy.where(abs(values) > 1e-12 * abs(values).max(), values, 0))


def compared(deck, scene):
    """Lines to print, and the first difference or None."""
    (rows, total, lost), (others, other_total, _) = sums(deck), sums(scene)
    size = max(float(abs(deck.x).max(initial=0)), float(numpy.linalg.norm(numpy.ptp(deck.x, axis=0))))
    if len(rows) != len(others):
        differs = [f"{MARK}: parts: {len(rows)} in the deck, {len(others)} in the scene"]
    else:
        differs = [f"{MARK}: {what} of {other.name}: {one} in the deck, {two} in the scene"
                   for row, other in zip([*rows, total], [*others, other_total]) for what, one, two in apart(row, other, size)]
    differs += [f"{MARK}: {what}: {one} in the deck, {two} in the scene"
                for what, one, two in touching.apart(deck.touching, scene.touching, SAME)]
    lines = differs[:1] or ["balance: the scene has the mass, centre, inertia, elements, held and loaded nodes, contacts, ties, bolts, "
                            "force and moment of the deck"]
    if lost:
        mass = f", {lost.lumped:.6g} kg" if lost.lumped else ""
        lines.append(f"balance: nodes of no volume element: {lost.held} held, {lost.loaded} loaded with {shown(lost.force)} N{mass}; not "
                     "in the scene")
    return lines + table(others, other_total) + touching.lines(scene.touching), differs[0] if differs else None


def table(rows, total):
    """Lines of the table; of many parts the first."""
    cells = [("part", "kg", "centre, m", "elements", "held", "loaded", "force, N")]
    more = [(f"and {len(rows) - SHOWN} more parts", *[""] * 6)] if len(rows) > SHOWN + 1 else []
    chosen = rows[:SHOWN] if more else rows
    cells += [line_of(row) for row in chosen] + more + ([line_of(total)] if len(rows) > 1 else [])
    widths = [max(len(row[k]) for row in cells) for k in range(7)]
    lines = ["  ".join([row[0].ljust(widths[0]), *(cell.rjust(width) for cell, width in zip(row[1:], widths[1:]))]) for row in cells]
    if total.mass:
        lines.append(f"inertia about the centre, xx, yy, zz, xy, xz, yz: {shown(total.inertia)} kg m^2")
    if total.rigid or total.lumped or total.links.any() or total.equations:
        lines.append(f"joined: {total.rigid} nodes rigidly, {total.lumped:.6g} kg on points, {total.equations} equations, bushings of "
                     f"{shown(total.links[:3])} N/m in all")
    return lines + [f"moment about the origin: {shown(total.moment)} N m"] * bool(total.gross or numpy.any(total.moment))


def line_of(row):
    return (row.name, shown(row.mass), shown(row.centre), str(row.cells), str(row.held), str(row.loaded), shown(row.force))
