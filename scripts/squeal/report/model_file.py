"""reduced_model.bin, a reduced model (src/sweep/box/export.c): its matrices at any values of its parameters, and contact statuses.

Where pairs are closed at some points of the box and open at others, a place has the status of the nearest point whose own is known,
distances in parts of the range of each parameter."""

import json

import numpy

from ..tables import BadInput

LARGEST = 1e100  # number of a matrix
LIMITS = "low", "high", "limit_ratio", "limit_growth", "error"


def number(value, kind=(int, float)):
    """A number that JSON had; ValueError for anything else."""
    if isinstance(value, bool) or not isinstance(value, kind):
        raise ValueError
    return value


def whole(value):
    """The same of a number of things."""
    if number(value, int) < 0:
        raise ValueError
    return value


class Numbers:
    """Numbers behind the first line, taken one array after the other."""

    def __init__(self, data):
        self.left = numpy.frombuffer(data)

    def take(self, *shape):
        """The next ones; ValueError where there are too few."""
        n = int(numpy.prod(shape))
        taken, self.left = self.left[:n].reshape(shape), self.left[n:]
        return taken


class Contact:
    """Statuses, and points [m][parameters] whose own is known."""

    def __init__(self, said, ranges, numbers):
        self.pairs, self.always = whole(said["pairs"]), whole(said["always"])
        self.groups = numpy.array([whole(n) for n in said["groups"]], int)
        self.closed = numpy.array([[int(letter) for letter in text] for text in said["statuses"]], int).reshape(-1, len(self.groups))
        self.points = numbers.take(whole(said["points"]), len(ranges))
        self.status = numbers.take(said["points"]).astype(int)
        self.low, self.wide = numpy.array(ranges)[:, 0], numpy.array([high - low for low, _, high in ranges])
        self.places = (self.points - self.low) / self.wide
        if not (len(self.points) and (self.closed | 1 == 1).all() and 0 <= self.status.min() <= self.status.max() < len(self.closed)):
            raise ValueError

    def at(self, p):
        """The status of a place."""
        return self.status[numpy.argmin((((p - self.low) / self.wide - self.places)**2).sum(1))]

    def n_closed(self, status):
        """Pairs that are closed."""
        return int(self.always + self.groups @ self.closed[status])

    def left_out(self):
        """Of each point, in how many pairs the status of its nearest neighbour is another."""
        far = numpy.array([self.groups @ (self.closed[self.status[self.neighbour(i)]] != self.closed[self.status[i]])
                           for i in range(len(self.points))])
        return far if len(far) > 1 else far[:0]

    def neighbour(self, i):
        """The nearest other point."""
        square = ((self.places[i] - self.places)**2).sum(1)
        square[i] = numpy.inf
        return numpy.argmin(square)


class Term:
    """One term: a matrix, or rows of pairs that are closed or open."""

    def __init__(self, said, n, numbers, earlier):
        self.kind, self.scale, self.factors = said["kind"], said["scale"], said["factors"]
        self.closed = numpy.array([whole(g) for g in said["closed"]], int) if "closed" in said else None
        if self.closed is None:
            self.matrix = self.triangle(n, numbers) if said.get("symmetric") else numbers.take(n, n).T
            self.arrays = [self.matrix]
            return
        rows = len(self.closed)
        self.right = earlier[said["rows"]].right if "rows" in said else numbers.take(rows, n)
        self.left = numbers.take(rows)[:, None] * self.right if said["along"] else numbers.take(rows, n)
        self.arrays = [self.left, self.right]

    @staticmethod
    def triangle(n, numbers):
        """A symmetric matrix of its lower triangle by columns."""
        values = numbers.take(n * (n + 1) // 2)
        matrix, (j, i) = numpy.zeros((n, n)), numpy.triu_indices(n)
        matrix[i, j] = matrix[j, i] = values
        return matrix

    def at(self, p, closed):
        """Its part of K, C or M."""
        c = self.scale * numpy.prod([(abs(p[i]) if absolute else p[i])**power for i, power, absolute in self.factors])
        if self.closed is None:
            return c * self.matrix
        there = closed[self.closed] > 0
        return c * self.left[there].T @ self.right[there]


class ReducedModel:
    """What its first line says is head; data: all bytes."""

    def __init__(self, path):
        self.data = path.read_bytes()
        try:
            end = self.data.index(b"\n")
            self.head, numbers = json.loads(self.data[:end]), Numbers(self.data[end + 1:])
            ranges = check_head(self.head)
            self.terms = []
            for said in self.head["terms"]:
                self.terms.append(Term(said, self.head["n"], numbers, self.terms))
            self.contact = Contact(self.head["contact"], ranges, numbers) if "contact" in self.head else None
            groups = len(self.contact.groups) if self.contact else 0
            if len(numbers.left) or any((term.closed >= groups).any() for term in self.terms if term.closed is not None):
                raise ValueError
        except (ValueError, KeyError, TypeError, IndexError, AttributeError, OverflowError):
            raise BadInput(f"{path}: is no reduced model, or is not whole") from None
        if not all((abs(array) < LARGEST).all() for term in self.terms for array in term.arrays):
            raise BadInput(f"{path}: a matrix has values that are no numbers or above {LARGEST:g}; was the file damaged?")

    def at(self, p, n=None):
        """K, C, M of the first n vectors, those in use."""
        n = n or self.head["n_used"]
        closed = self.contact.closed[self.contact.at(p)] if self.contact else None
        sums = {kind: numpy.zeros((n, n)) for kind in "KCM"}
        for term in self.terms:
            sums[term.kind] += term.at(p, closed)[:n, :n]
        return sums["K"], sums["C"], sums["M"]


def check_head(head):
    """Least value, own value, largest value of each parameter. ValueError, KeyError or TypeError where what is read of it cannot be."""
    ranges = [[number(entry[key]) for key in ("lower", "value", "upper")] for entry in head["parameters"]]
    factors = [factor for term in head["terms"] for factor in term["factors"]]
    numbers = [*(number(power) for _, power, _ in factors), *(number(term["scale"]) for term in head["terms"]),
               *(x for values in ranges for x in values), *(number(head[key]) for key in LIMITS)]
    named = all(entry["name"] + entry["unit"] for entry in head["parameters"]) and {term["kind"] for term in head["terms"]} <= set("KCM")
    if not (named and all(whole(i) < len(ranges) and absolute in (0, 1) for i, _, absolute in factors) and
            0 < whole(head["n_used"]) <= whole(head["n"]) and numpy.isfinite(numbers).all() and all(low < high for low, _, high in ranges)):
        raise ValueError
    return ranges
