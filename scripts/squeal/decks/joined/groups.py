"""Nodes of elements that follow a reference node: rigidly, u = t + w x (x - x_0), or it follows them in the mean, with shares s
that add up to 1, their middle c and r = x - c,

  w = A^-1 sum s r x u,   A = sum s (|r|^2 I - r r'),   t = sum s u + w x (x_0 - c),

which is how Abaqus, CalculiX, Nastran and Ansys spread a force and a moment on it. Everything else that is fastened to such a
node, or to one that follows it, moves with it."""

from dataclasses import dataclass, field

import numpy

from ..deck import Join

FLAT = 1e-10  # of the largest moment of A: below it nothing tells the rotation
SHARED = 3  # nodes not on one line that make one rigid body of two


@dataclass(eq=False)
class Group:
    """Solid nodes, ascending, of a reference node at x; `how` is what becomes of it: point, held, or equations."""
    node: int
    x: numpy.ndarray
    nodes: numpy.ndarray
    rigid: bool
    place: object
    words: str
    name: str
    directions: tuple = (0, 1, 2)
    shares: numpy.ndarray = None  # [nodes], None: equal ones
    how: str = "point"
    knot: bool = False  # fibres of shells alone
    attached: set = field(default_factory=set)  # nodes of no element that move with it, the reference node among them


def turns(r):
    """Rows [3] of w x r by w, for places r [n][3]: [n][3][3]."""
    found = numpy.zeros((len(r), 3, 3))
    for d, (a, b) in enumerate(((1, 2), (2, 0), (0, 1))):
        found[:, d, a], found[:, d, b] = r[:, b], -r[:, a]
    return found


def motions(x, about):
    """Phi [3 n][6] of places x [n][3] that move rigidly about a place."""
    found = numpy.zeros((len(x), 3, 6))
    found[:, :, :3], found[:, :, 3:] = numpy.eye(3), turns(x - about)
    return found.reshape(-1, 6)


def mean(x, about, shares=None):
    """B [6][3 n] of a node at a place that moves as places x do in the mean; rotations are 0 where nothing tells them."""
    n = len(x)
    shares = numpy.full(n, 1 / n) if shares is None else shares / shares.sum()
    centre = shares @ x
    r = x - centre
    moment = (shares[:, None, None] * ((r**2).sum(axis=1)[:, None, None] * numpy.eye(3) - r[:, :, None] * r[:, None, :])).sum(axis=0)
    found = numpy.zeros((6, n, 3))
    found[:3] = numpy.eye(3)[:, None, :] * shares[None, :, None]
    if numpy.linalg.eigvalsh(moment)[0] > FLAT * numpy.linalg.eigvalsh(moment)[2]:
        spin = numpy.einsum("ij,njk->ink", numpy.linalg.inv(moment), shares[:, None, None] * numpy.swapaxes(turns(r), 1, 2))
        found[3:] = spin
        found[:3] += numpy.einsum("ij,jnk->ink", turns((about - centre)[None])[0], spin)
    return found.reshape(6, -1)


def straight(x):
    """Whether places stand on one line, or in one place."""
    sizes = numpy.linalg.svd(x - x.mean(axis=0), compute_uv=False) if len(x) else numpy.zeros(3)
    return len(x) < SHARED or sizes[1] <= 1e-6 * max(sizes[0], 1e-300)


def rigid_by_equations(deck, solid):
    """Joins in the place of equations that say that nodes follow one of no element rigidly: three for each, of these two nodes alone,
    which all six motions obey."""
    pairs = {}
    for number, equation in enumerate(deck.equations):
        nodes = {node for node, _, _ in equation.terms}
        loose = [node for node in nodes if not solid[node]]
        if len(nodes) == 2 and len(loose) == 1 and any(d > 2 and node == loose[0] for node, d, _ in equation.terms):
            pairs.setdefault((loose[0], *(nodes - set(loose))), []).append(number)
    known = {frozenset(pair): pair for pair in pairs}
    for number, equation in enumerate(deck.equations):  # along a direction without an arm there is no rotation
        pair = known.get(frozenset(node for node, _, _ in equation.terms))
        if pair and number not in pairs[pair]:
            pairs[pair].append(number)
    found, used = {}, set()
    for (loose, node), numbers in pairs.items():
        if len(numbers) == 3 and obeyed(deck, loose, node, numbers):
            found.setdefault(loose, []).append(node)
            used.update(numbers)
    for loose, nodes in found.items():
        first = next(deck.equations[number] for number in sorted(used) if any(term[0] == loose for term in deck.equations[number].terms))
        deck.joins.append(Join("region", loose, numpy.array(nodes), True, first.place, f"{first.words} of a rigid region"))
    deck.equations = [equation for number, equation in enumerate(deck.equations) if number not in used]


def obeyed(deck, loose, node, numbers):
    """Whether equations tell all displacements of a node, and every rigid motion obeys them."""
    own, rest = numpy.zeros((3, 3)), numpy.zeros((3, 6))
    phi = motions(deck.x[node][None], deck.x[loose])
    for row, number in enumerate(numbers):
        for at, d, value in deck.equations[number].terms:
            if at == node:
                if d > 2:
                    return False
                own[row, d] += value
            else:
                rest[row, d] += value
    size = abs(own).max() * max(abs(phi).max(), 1e-300)
    return abs(numpy.linalg.det(own)) > 1e-9 * abs(own).max()**3 and abs(own @ phi + rest).max() < 1e-6 * size


class Groups:
    """All groups of a deck, and the one that each node of no element moves with. `into` is the node that each became by ties."""

    def __init__(self, deck, solid, into):
        self.deck, self.solid, self.into = deck, solid, into
        self.groups, self.of_node = [], {}
        rigid_by_equations(deck, solid)
        joins = [join for join in deck.joins if self.known(join)]
        for number in self.clusters(joins):
            self.add([joins[k] for k in number])
        for group in self.groups:
            for node in group.attached:
                self.of_node[node] = group
        self.share()

    def known(self, join):
        """Whether a join has nodes."""
        if not len(join.nodes):
            self.deck.note(join.place, f"{join.words}: no nodes: not in the scene")
        return len(join.nodes) > 0

    def clusters(self, joins):
        """Numbers of joins that are one rigid body, since a node of no element is of both: lists."""
        parent = list(range(len(joins)))

        def root(k):
            while parent[k] != k:
                k = parent[k]
            return k

        seen = {}
        for k, join in enumerate(joins):
            if not join.rigid or len(join.directions) < 3:
                continue
            for node in [join.node, *join.nodes[~self.solid[join.nodes]].tolist()]:
                if not self.solid[node]:
                    parent[root(k)] = root(seen.setdefault(int(node), k))
        found = {}
        for k in range(len(joins)):
            found.setdefault(root(k), []).append(k)
        return list(found.values())

    def add(self, joins):
        """The group of joins that are one body."""
        first = next((join for join in joins if not join.knot), joins[0])
        nodes = numpy.unique(numpy.concatenate([join.nodes for join in joins]))
        attached = {int(node) for node in nodes[~self.solid[nodes]]} | {join.node for join in joins if not self.solid[join.node]}
        ref, inside = first.node, self.into[nodes[self.solid[nodes]]]
        if self.solid[ref] and first.rigid:
            inside = numpy.append(inside, self.into[ref])
        if not len(inside):
            self.deck.note(first.place, f"{first.words}: no node of it is on a volume element: not in the scene")
            return
        shares = first.shares[self.solid[first.nodes]] if first.shares is not None else None
        inside, at = numpy.unique(inside, return_inverse=True)
        if shares is not None:
            shares = numpy.bincount(at.ravel(), shares, len(inside))
        if not first.rigid and len(attached) > (0 if self.solid[ref] else 1):
            self.deck.note(first.place, f"{first.words}: nodes of no volume element among those that it means: they are left out")
            attached = {ref} if not self.solid[ref] else set()
        self.groups.append(Group(ref, self.deck.x[ref], inside, first.rigid, first.place, first.words, first.name, first.directions, shares,
                                 attached=attached, knot=all(join.knot for join in joins)))

    def share(self):
        """Rigid groups with nodes in common: one body where these tell its motion; else the later one loses them, which is said."""
        owner, kept = {}, []
        for group in self.groups:
            if not group.rigid:
                kept.append(group)
                continue
            common = [node for node in group.nodes.tolist() if node in owner]
            other = owner[common[0]] if common else None
            if common and not straight(self.deck.x[common]) and len(group.directions) == len(other.directions) == 3:
                other.nodes = numpy.union1d(other.nodes, group.nodes)
                other.attached |= group.attached
                self.of_node.update(dict.fromkeys(group.attached, other))
                group = other
            elif common:
                self.deck.note(group.place, f"{group.words}: {len(common)} of its nodes follow {other.words} of line "
                                            f"{other.place.line} already, and that one alone")
                group.nodes = numpy.setdiff1d(group.nodes, common)
            if group not in kept and len(group.nodes):
                kept.append(group)
            owner.update(dict.fromkeys(group.nodes.tolist(), group))
        self.groups = kept
