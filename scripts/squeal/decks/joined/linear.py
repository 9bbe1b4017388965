"""Linear equations between displacements, sum a u = 0, solved for some that follow the others. An unknown is a pair (node, direction);
an equation a dictionary {unknown: coefficient}."""

import numpy

SMALL = 1e-10  # of the largest coefficient of an equation: rounding
WEAK = 1e-3  # of it: too small to be solved for


class Equations:
    """Equations solved one after the other. `follows`: unknown -> what it is by others, none of which follows."""

    def __init__(self, held, loose):
        self.held, self.loose = held, loose  # whether an unknown is 0, and whether it is of no element
        self.follows, self.used = {}, {}  # unknown -> those that follow it

    def add(self, row):
        """Adds an equation; false where it says that a motion is 0 which no displacement is left for."""
        row = self.reduced(row)
        if not row:
            return True
        most = max(map(abs, row.values()))
        able = [unknown for unknown, value in row.items() if abs(value) >= WEAK * most]
        pivot = next((unknown for unknown in able if self.loose(unknown)), able[0])
        self.follows[pivot] = {unknown: -value / row[pivot] for unknown, value in row.items() if unknown != pivot}
        for unknown in self.follows[pivot]:
            self.used.setdefault(unknown, set()).add(pivot)
        for other in list(self.used.pop(pivot, ())):
            factor = self.follows[other].pop(pivot)
            for unknown, value in self.follows[pivot].items():
                self.follows[other][unknown] = self.follows[other].get(unknown, 0.0) + factor * value
                self.used.setdefault(unknown, set()).add(other)
        return True

    def reduced(self, row):
        """An equation without what follows or is held."""
        found, size = {}, 0.0
        for unknown, value in row.items():
            parts = self.follows[unknown] if unknown in self.follows else {unknown: 1.0}
            for part, share in parts.items():
                if self.held(part):
                    continue
                found[part] = found.get(part, 0.0) + value * share
                size = max(size, abs(value * share))
        return {unknown: value for unknown, value in found.items() if abs(value) > SMALL * size}


def chosen_rows(phi):
    """Rows of phi [m][f] that tell all others, as many as its rank, by pivoting; and T [m][rank], phi = T phi[rows]."""
    left, rows, largest = phi.copy(), [], None
    for _ in range(phi.shape[1]):
        sizes = (left**2).sum(axis=1)
        row = int((sizes * (1 - 1e-9 * numpy.arange(len(sizes)) / len(sizes))).argmax())
        largest = sizes[row] if largest is None else largest
        if sizes[row] <= 1e-16 * largest or sizes[row] == 0:
            break
        rows.append(row)
        unit = left[row] / numpy.sqrt(sizes[row])
        left = left - numpy.outer(left @ unit, unit)
    return rows, phi @ numpy.linalg.pinv(phi[rows]) if rows else numpy.zeros((len(phi), 0))


def kernel(rows):
    """A basis [n][k] of what rows [m][n] take to 0."""
    if not len(rows):
        return numpy.eye(rows.shape[1])
    _, sizes, right = numpy.linalg.svd(rows)
    return right[(sizes > 1e-9 * max(sizes.max(initial=0), 1e-300)).sum():].T
