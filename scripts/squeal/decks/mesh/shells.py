"""Shells as solids of their thickness: one layer of hex20 and wedge15, whose middles of edges through the thickness are the corners of
the shells. Elements that join smoothly are one sheet, with one fibre at each node along the mean normal; where sheets meet in a fold
or a branch, and where something holds or turns a node, its fibres are one rigid body with it, as CalculiX' knots are."""

from dataclasses import dataclass

import numpy

from .elements import AROUND_SHELL
from .integrals import monomials, nodes_of_face, powers
from ..deck import Block, Equation, Join, Load, Lump, shape_of

SMOOTH = numpy.cos(numpy.radians(40))  # of the angle between neighbours of one sheet
STEEP = 0.5  # least cosine between a fibre and the normal of an element, by which it is made longer


@dataclass
class Shells:
    """Shells of one shape: number of the first cell, block, nodes [n][3, 4, 6 or 8], thickness and distance of the middle surface along
    the normal [n]; no thickness is 0."""
    first: int
    block: object
    nodes: numpy.ndarray
    thickness: numpy.ndarray
    offset: numpy.ndarray

    @property
    def corners(self):
        return 3 if self.nodes.shape[1] in (3, 6) else 4


def add_shells(deck, kind, ids, nodes, place):
    """Shells as cells whose nodes are made later, by solidify(); returns the numbers of the cells."""
    corners = 3 if nodes.shape[1] in (3, 6) else 4
    shape = shape_of("wedge15" if corners == 3 else "hex20")
    if deck.dummies is None:
        deck.dummies = deck.add_nodes(numpy.zeros((16, 3)))
    made = numpy.empty((len(ids), shape.n_nodes), int)
    made[:, :4 * corners] = deck.dummies[:4 * corners]
    made[:, 4 * corners:] = nodes[:, :corners]
    block = Block(shape, kind, ids, made, place, nodes)
    cells = deck.add_block(block)
    deck.shells.append(Shells(int(cells[0]), block, nodes, numpy.zeros(len(ids)), numpy.zeros(len(ids))))
    return cells


def set_thickness(deck, cells, thickness, offset=0.0):
    """Thickness and offset of those of some cells that are shells."""
    for shells in deck.shells:
        inside = (cells >= shells.first) & (cells < shells.first + len(shells.nodes))
        rows = cells[inside] - shells.first
        shells.thickness[rows] = thickness if numpy.isscalar(thickness) else thickness[inside]
        shells.offset[rows] = offset if numpy.isscalar(offset) else offset[inside]


def normals_at_nodes(x):
    """Normals [e][n][3] times the area of the natural element, at the nodes x [e][n][3] of shells."""
    n = x.shape[1]
    local = nodes_of_face(n)
    rows = powers("triangle" if n in (3, 6) else "quad", n)
    inverse = numpy.linalg.inv(monomials(local, rows)[0])
    slopes = numpy.einsum("pkd,kn->pnd", monomials(local, rows)[1], inverse)
    tangent = numpy.einsum("pnd,eni->epdi", slopes, x)
    return numpy.cross(tangent[:, :, 0], tangent[:, :, 1])


class Sheets:
    """All shells of a deck by rows; edges, sheets and signs of their orientation."""

    def __init__(self, deck):
        self.deck, self.corners, self.owner = deck, [], []
        for number, shells in enumerate(deck.shells):
            for row in range(len(shells.nodes)):
                self.owner.append((number, row))
            self.corners += shells.nodes[:, :shells.corners].tolist()
        self.normal = numpy.concatenate([normals_at_nodes(deck.x[shells.nodes[:, :shells.corners]]).sum(axis=1) for shells in deck.shells])
        self.unit = self.normal / numpy.maximum(numpy.linalg.norm(self.normal, axis=1), 1e-300)[:, None]
        thickness = numpy.concatenate([shells.thickness for shells in deck.shells])
        self.kind = numpy.stack([thickness, numpy.concatenate([shells.offset for shells in deck.shells])], axis=1)
        self.join()

    def join(self):
        """Sheets by edges that two elements share, and signs: -1 where an element is the other way round."""
        from scipy.sparse import coo_matrix
        from scipy.sparse.csgraph import breadth_first_order, connected_components
        edges = {}
        for number, nodes in enumerate(self.corners):
            for a, b in zip(nodes, nodes[1:] + nodes[:1]):
                edges.setdefault((min(a, b), max(a, b)), []).append((number, a < b))
        links = {}
        for found in edges.values():
            self.pair(found, links)
        n = len(self.corners)
        pairs = numpy.array(list(links), int).reshape(-1, 2)
        graph = coo_matrix((numpy.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), (n, n)).tocsr()
        count, self.sheet = connected_components(graph, directed=False)
        self.sign, graph = numpy.ones(n), graph + graph.T
        first = numpy.zeros(count, int)
        first[self.sheet[::-1]] = numpy.arange(n)[::-1]
        for root in first.tolist():
            order, before = breadth_first_order(graph, root, directed=False)
            for number in order[1:].tolist():
                other = int(before[number])
                self.sign[number] = self.sign[other] * links.get((other, number), links.get((number, other), 1))


    def pair(self, found, links):
        """Elements at an edge go on in each other, the smoothest first, where no more than two are in one plane."""
        able = []
        for k, (one, way) in enumerate(found):
            for other, back in found[k + 1:]:
                sign = 1 if way != back else -1
                cosine = sign * float(self.unit[one] @ self.unit[other])
                if cosine > SMOOTH and (self.kind[one] == self.kind[other]).all():
                    able.append((cosine, one, other, sign))
        taken = set()
        for _, one, other, sign in sorted(able, reverse=True):
            if not {one, other} & taken:
                taken |= {one, other}
                links[one, other] = sign


def special_nodes(deck, middles, solid, several):
    """Nodes that need their fibres to be rigid: of several sheets, shared with solids, turned, or held or joined with rotations."""
    found = set(several) | {node for node in numpy.flatnonzero(solid).tolist()}
    for support in deck.supports:
        found.update(node for node in support.nodes.tolist() if max(support.values) > 2 or node in middles)
    for join in deck.joins:
        found.update([join.node], join.nodes.tolist() if join.rigid else ())
    for equation in deck.equations:
        found.update(node for node, d, _ in equation.terms if d > 2 or node in middles)
    return found


def solidify(deck):
    """Gives the cells of shells their nodes."""
    if not deck.shells:
        return
    drop_without_thickness(deck)
    if not deck.shells:
        return
    sheets = Sheets(deck)
    fibres = Fibres(deck, sheets)
    middles = {node for shells in deck.shells for node in shells.nodes[:, shells.corners:].ravel().tolist()}
    own = {id(shells.block) for shells in deck.shells}
    solid = numpy.zeros(deck.n_nodes, bool)
    for block in deck.blocks:
        if id(block) not in own:
            solid[block.nodes] = True
    solid[[node for node in range(len(solid)) if solid[node] and node not in fibres.sheets_of]] = False
    several = [node for node, found in fibres.sheets_of.items() if len(found) > 1]
    off = middles | {node for (_, node), at in fibres.index.items() if fibres.offset[at]}  # from which no element has a node
    special = special_nodes(deck, off, solid, several) & set(fibres.sheets_of)
    fibres.make(special, middles)
    held = {node for support in deck.supports for node in support.nodes.tolist()}
    fibres.fill(special | held)
    for node in sorted(special):
        sheets_of = fibres.sheets_of[node]
        ends = [fibres.made[sheet, node] if len(sheets_of) == 1 else fibres.ends(sheet, node) for sheet in sheets_of]
        nodes = numpy.array(sorted({other for part in ends for other in part} - {node}), int)
        place = deck.shells[0].block.place
        deck.joins.append(Join("", node, nodes, True, place, "the fibre of a shell", knot=True))
    joined = {int(node) for join in deck.joins if not join.knot for node in (join.node, *join.nodes)}
    put_on_fibres(deck, fibres, joined)
    spread_means(deck, fibres, middles, special)
    forget_dummies(deck)
    say(deck, sheets, special)


class Fibres:
    """Fibres of sheets at nodes: normal, thickness, offset, by (sheet, node)."""

    def __init__(self, deck, sheets):
        self.deck, self.sheets, self.index, self.sheets_of, self.made = deck, sheets, {}, {}, {}
        sums, at = [], 0
        for shells in deck.shells:
            normals = normals_at_nodes(deck.x[shells.nodes])
            for row, nodes in enumerate(shells.nodes.tolist()):
                sheet, sign = int(sheets.sheet[at]), sheets.sign[at]
                for k, node in enumerate(nodes):
                    number = self.index.setdefault((sheet, node), len(self.index))
                    if number == len(sums):
                        sums.append([numpy.zeros(3), 0.0, 0.0, 0, []])
                        self.sheets_of.setdefault(node, []).append(sheet)
                    entry = sums[number]
                    entry[0] = entry[0] + sign * normals[row, k]
                    entry[1] += shells.thickness[row]
                    entry[2] += sign * shells.offset[row]
                    entry[3] += 1
                    entry[4].append(sign * sheets.unit[at])
                at += 1
        normal = numpy.array([entry[0] / max(numpy.linalg.norm(entry[0]), 1e-300) for entry in sums])
        cosine = numpy.array([max(float(numpy.mean(numpy.array(entry[4]) @ n)), STEEP) for entry, n in zip(sums, normal)])
        self.normal = normal / cosine[:, None]
        self.half = numpy.array([entry[1] / entry[3] / 2 for entry in sums])
        self.offset = numpy.array([entry[2] / entry[3] for entry in sums])

    def make(self, special, middles):
        """Nodes of each fibre: lower, middle or -1, upper; the middle one is the node of the deck where nothing is special about it."""
        keys = list(self.index)
        nodes = numpy.array([node for _, node in keys])
        centre = self.deck.x[nodes] + self.offset[:, None] * self.normal
        low = self.deck.add_nodes(centre - self.half[:, None] * self.normal)
        high = self.deck.add_nodes(centre + self.half[:, None] * self.normal)
        fresh = [k for k, (_, node) in enumerate(keys) if (node in special or self.offset[k]) and node not in middles]
        middle = numpy.where([node in middles for node in nodes], -1, nodes)
        middle[fresh] = self.deck.add_nodes(centre[fresh])
        for k, key in enumerate(keys):
            self.made[key] = [int(v) for v in (low[k], middle[k], high[k]) if v >= 0]
        self.low, self.middle, self.high = low, middle, high

    def ends(self, sheet, node):
        """Lower and upper node of a fibre."""
        made = self.made[sheet, node]
        return [made[0], made[-1]]

    def fill(self, bound):
        """Nodes of the cells; middles of edges of shells of first order are made. Edges between nodes that are bound stay straight."""
        at, edges, straight = 0, {}, set()
        for shells in self.deck.shells:
            corners, block = shells.corners, shells.block
            for row, nodes in enumerate(shells.nodes.tolist()):
                sheet, turned = int(self.sheets.sheet[at]), self.sheets.sign[at] < 0
                found = [self.index[sheet, node] for node in nodes]
                layers = (self.high, self.low) if turned else (self.low, self.high)
                for layer, nodes_of in enumerate(layers):
                    block.nodes[row, layer * corners:(layer + 1) * corners] = nodes_of[found[:corners]]
                    first = (2 + layer) * corners
                    if len(nodes) > corners:
                        block.nodes[row, first:first + corners] = nodes_of[found[corners:]]
                        continue
                    for k, (a, b) in enumerate(AROUND_SHELL[corners]):
                        ends = int(nodes_of[found[a]]), int(nodes_of[found[b]])
                        block.nodes[row, first + k] = edges.setdefault((min(ends), max(ends)), len(edges))
                        if nodes[a] in bound and nodes[b] in bound:
                            straight.add((min(ends), max(ends)))
                block.nodes[row, 4 * corners:] = self.middle[found[:corners]]
                at += 1
        if edges:
            ends = numpy.array(list(edges), int)
            made = self.deck.add_nodes((self.deck.x[ends[:, 0]] + self.deck.x[ends[:, 1]]) / 2)
            self.place_edges(made)
            place = self.deck.shells[0].block.place
            for pair in sorted(straight):
                middle = int(made[edges[pair]])
                self.deck.equations += [Equation([(middle, d, 1.0), (pair[0], d, -0.5), (pair[1], d, -0.5)], place, "an edge of a shell")
                                        for d in range(3)]

    def place_edges(self, made):
        """Numbers of edges become those of the nodes in their middle."""
        for shells in self.deck.shells:
            if shells.nodes.shape[1] == shells.corners:
                columns = slice(2 * shells.corners, 4 * shells.corners)
                shells.block.nodes[:, columns] = made[shells.block.nodes[:, columns]]


def drop_without_thickness(deck):
    """Shells without a thickness are no cells."""
    gone, kept = numpy.zeros(deck.n_cells, bool), numpy.zeros(deck.n_nodes, bool)
    for shells in deck.shells:
        gone[shells.first:shells.first + len(shells.thickness)] = ~(shells.thickness > 0)
    for first, block in zip(deck.firsts(), deck.blocks):
        kept[block.own_nodes()[~gone[first:first + len(block.ids)]]] = True
    for shells in deck.shells:
        without = ~(shells.thickness > 0)
        if without.any():
            ids, shared = shells.block.ids[without], numpy.unique(shells.nodes[without])
            deck.note(shells.block.place, f"{without.sum()} shells {shells.block.kind} without a thickness that is read: not in the scene; "
                                          f"let their program write a superelement of elements {min(ids)} to {max(ids)} with the "
                                          f"{kept[shared].sum()} nodes that they share with the rest, for -superelements")
    if gone.any():
        drop_cells(deck, gone)


def drop_cells(deck, gone):
    """Takes cells out of a deck."""
    number = numpy.cumsum(~gone) - 1
    firsts, blocks = deck.firsts(), []
    for first, block in zip(firsts, deck.blocks):
        kept = ~gone[first:first + len(block.ids)]
        block.ids, block.nodes = block.ids[kept], block.nodes[kept]
        block.plain = None if block.plain is None else block.plain[kept]
        blocks += [block] if kept.any() else []
    shells = []
    for part in deck.shells:
        kept = ~gone[part.first:part.first + len(part.nodes)]
        if kept.any():
            first = int(number[part.first + int(kept.argmax())])
            shells.append(Shells(first, part.block, part.nodes[kept], part.thickness[kept], part.offset[kept]))
    deck.blocks, deck.shells, deck.n_cells = blocks, shells, int((~gone).sum())
    for section in deck.sections:
        section.cells = number[section.cells[~gone[section.cells]]]
    for name, (cells, place) in deck.cell_sets.items():
        deck.cell_sets[name] = number[cells[~gone[cells]]], place
    for name, (faces, place) in deck.surfaces.items():
        deck.surfaces[name] = kept_faces(faces, gone, number), place
    for load in deck.loads:
        if load.faces is not None:
            load.faces = kept_faces(load.faces, gone, number)
    deck.outer = None


def kept_faces(faces, gone, number):
    faces = faces[~gone[faces[:, 0]]]
    return numpy.stack([number[faces[:, 0]], faces[:, 1]], axis=1)


def put_on_fibres(deck, fibres, joined):
    """Loads, masses and springs at nodes of shells that nothing else joins act on the middle of a fibre, or half on each end."""
    def ends(node):
        sheets_of = fibres.sheets_of[node]
        made = fibres.made[sheets_of[0], node]
        return made[1:2] if len(made) == 3 and len(sheets_of) == 1 else fibres.ends(sheets_of[0], node)

    def own(node):
        return node in fibres.sheets_of and node not in joined

    loads = []
    for load in deck.loads:
        found = [] if load.faces is not None else [node for node in load.nodes.tolist() if own(node)]
        plain = all(ends(node) == [node] for node in found) and (load.moment is None or not load.moment.any())
        if not found or plain:
            loads.append(load)
            continue
        rest = numpy.array([node for node in load.nodes.tolist() if not own(node)], int)
        if len(rest):
            loads.append(Load("", load.place, nodes=rest, force=load.force, moment=load.moment))
        for node in found:
            loads += [Load("", load.place, nodes=numpy.array([end]), force=load.force / len(ends(node))) for end in ends(node)]
            loads += couple(deck, fibres.ends(fibres.sheets_of[node][0], node), load, node)
    deck.loads = loads
    lumps = []
    for lump in deck.lumps:
        halves = ends(lump.node) if own(lump.node) else [lump.node]
        lumps += [Lump(end, lump.place, lump.words, lump.mass / len(halves), lump.inertia, lump.offset) for end in halves]
    deck.lumps = lumps
    for link in deck.links:
        link.nodes = tuple(ends(node)[0] if node >= 0 and own(node) else node for node in link.nodes)
    for spring in deck.springs:
        spring.nodes = numpy.array([ends(node)[0] if own(node) else node for node in spring.nodes.tolist()], int)


def couple(deck, made, load, node):
    """A moment on a fibre, and that of a force off its middle, as two forces at its ends; that about it is listed."""
    moment = numpy.cross(deck.x[node] - deck.x[made].mean(axis=0), load.force) + (0 if load.moment is None else load.moment)
    if not moment.any():
        return []
    line = deck.x[made[-1]] - deck.x[made[0]]
    length = numpy.linalg.norm(line)
    about = abs(moment @ line) / length
    if about > 1e-6 * numpy.linalg.norm(moment):
        deck.note(load.place, f"a moment of {about:.3g} about the normal of a shell: not in the scene")
    force = numpy.cross(moment, line) / length**2
    return [Load("", load.place, nodes=numpy.array([node]), force=sign * force) for node, sign in ((made[-1], 1), (made[0], -1))
            if force.any()]


def spread_means(deck, fibres, middles, special):
    """Nodes that a mean is of: those in the middle of edges are both ends of their fibres, others that are special the middles."""
    for join in deck.joins:
        if join.rigid:
            continue
        nodes, shares = [], []
        for node, share in zip(join.nodes.tolist(), numpy.ones(len(join.nodes)) if join.shares is None else join.shares):
            ends = [node]
            if node in fibres.sheets_of and (node in middles or node in special):
                made = fibres.made[fibres.sheets_of[node][0], node]
                ends = made if node in middles else made[1:2]
            nodes += ends
            shares += [share / len(ends)] * len(ends)
        join.nodes = numpy.array(nodes, int)
        join.shares = None if len(set(shares)) == 1 else numpy.array(shares)


def forget_dummies(deck):
    """Nodes that stood for those which are made are in no set."""
    for name, (nodes, place) in deck.node_sets.items():
        deck.node_sets[name] = numpy.setdiff1d(nodes, deck.dummies), place


def say(deck, sheets, special):
    """What became of the shells: mass by area and thickness beside that of the solids is in the balance."""
    area = numpy.linalg.norm(sheets.normal, axis=1)
    for shells in deck.shells:
        wide = float(numpy.min(numpy.sqrt(area)) / max(float(sheets.kind[:, 0].max()), 1e-300))
        deck.differ(shells.block.place, f"{shells.block.kind} becomes {shells.block.shape.name}, one layer of its thickness, with 27 or "
                                        "18 points" + ("; some are no wider than thick" if wide < 1 else ""))
    if special:
        deck.differ(deck.shells[0].block.place, f"{len(special)} nodes of shells are held, joined, turned, shared with solids or of "
                                                "several sheets: their fibres are rigid")
