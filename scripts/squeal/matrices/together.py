"""One order of the unknowns for all matrices, rows that are left out, and the files that are written."""

import re

import numpy
import scipy.sparse

from ..mesh.petsc_matrix import write_matrix
from ..tables import BadInput, printable, whole

HELD = 1e36  # what Abaqus adds to the diagonal of an unknown that is held
KINDS = (("stiffness", r"k|stif"), ("mass", r"m"), ("damping", r"[cbd]"))
DIRECTIONS = "rotation or scalar", "x", "y", "z", "rx", "ry", "rz"


def kind_of(name):
    """What a matrix is by its name, None where that does not tell."""
    for kind, pattern in KINDS:
        if re.match(pattern, name, re.IGNORECASE):
            return kind
    return None


def kind_in(one):
    """What a matrix is: as its file says, else by its name."""
    return kind_of(one.name) if one.kind is None else one.kind or None


def unknown_name(label):
    """Of an unknown, for people."""
    if isinstance(label, int):
        return f"unknown {label}"
    node, direction = label
    word = DIRECTIONS[direction] if isinstance(direction, int) and 1 <= direction <= 6 else direction
    return f"node {node} {word}" + (" (of Abaqus' own, a Lagrange multiplier?)" if node < 0 else "")


def check(found):
    """Raises BadInput for matrices that cannot be of one system."""
    names = [matrix.name.lower() for matrix in found]
    for matrix in found:
        if not re.fullmatch(r"[A-Za-z]\w*", matrix.name, re.ASCII):
            raise BadInput(f"{matrix.path}: '{matrix.name}' is no name of letters, digits and _; give one, NAME={matrix.path}")
        if names.count(matrix.name.lower()) > 1:
            raise BadInput(f"{matrix.path}: another matrix is named {matrix.name} too; give a name, "
                           f"NAME={matrix.path}")
        if matrix.shape[0] != matrix.shape[1]:
            raise BadInput(f"{matrix.path}: {matrix.name} is {matrix.shape[0]} x {matrix.shape[1]}; it must be "
                           f"square")
        if not len(matrix.value):
            raise BadInput(f"{matrix.path}: {matrix.name} has no entries")


def unite(found):
    """The labels of all unknowns, and each matrix in their order."""
    check(found)
    labelled = [matrix for matrix in found if matrix.labels]
    if not labelled or all(matrix.labels == labelled[0].labels for matrix in labelled):
        first = found[0]
        for matrix in found:
            if matrix.shape != first.shape:
                raise BadInput(f"{matrix.path}: {matrix.name} has {matrix.shape[0]} rows, {first.name} has "
                               f"{first.shape[0]}")
        return labelled[0].labels if labelled else list(range(1, first.shape[0] + 1)), [matrix.matrix() for matrix in found]
    for matrix in found:
        if not matrix.labels:
            raise BadInput(f"{matrix.path}: does not tell its nodes and directions, as {labelled[0].path} does")
    labels = sorted({label for matrix in found for label in matrix.labels})
    place = {label: i for i, label in enumerate(labels)}
    return labels, [spread(matrix, place) for matrix in found]


def spread(matrix, place):
    """A matrix in the order of all unknowns."""
    to = numpy.array([place[label] for label in matrix.labels])
    return scipy.sparse.csr_matrix((matrix.value, (to[matrix.row], to[matrix.column])), shape=(len(place),) * 2)


def sizes(matrix):
    """The largest entry of each row and column in absolute value."""
    size = abs(matrix)
    return numpy.maximum(size.max(axis=1).toarray().ravel(), size.max(axis=0).toarray().ravel())


def leave_out(found, labels, matrices):
    """Without unknowns that are held by a huge number or that nothing acts on; also lines of what was done."""
    held = numpy.max([abs(matrix.diagonal() / HELD - 1) < 1e-3 for matrix in matrices], axis=0)
    empty = numpy.max([sizes(matrix) for matrix in matrices], axis=0) == 0
    lines = [f"left out, since {HELD:g} on the diagonal holds it: {unknown_name(labels[i])}" for i in numpy.flatnonzero(held)]
    lines += [f"left out, since its row is zero in all matrices: {unknown_name(labels[i])}" for i in numpy.flatnonzero(empty)]
    keep = numpy.flatnonzero(~(held | empty))
    if not len(keep):
        raise BadInput(f"{found[0].path}: no unknown is left")
    return [labels[i] for i in keep], [matrix[keep][:, keep] for matrix in matrices], lines


def odd_rows(found, labels, matrices):
    """Lines about unknowns without mass; an error for what has mass and no stiffness of its own, where nodes are known."""
    kinds = {kind: [matrix for one, matrix in zip(found, matrices) if kind_in(one) == kind] for kind, _ in KINDS}
    if not kinds["stiffness"] or not kinds["mass"]:
        return []
    own = numpy.max([abs(matrix.diagonal()) for matrix in kinds["stiffness"]], axis=0)
    mass = numpy.max([sizes(matrix) for matrix in kinds["mass"]], axis=0)
    bare = numpy.flatnonzero((own == 0) & (mass > 0))
    if len(bare) and not isinstance(labels[0], int):
        raise BadInput(f"{found[0].path}: {unknown_name(labels[bare[0]])} has mass and no stiffness of its own; "
                       f"was a file cut off?")
    lines = [f"without mass and stiffness of its own, as a Lagrange multiplier is: {unknown_name(labels[i])}"
             for i in numpy.flatnonzero((own == 0) & (mass == 0))]
    light = numpy.flatnonzero((own > 0) & (mass == 0))
    return lines + [f"without mass: {len(light)} unknowns, such as {unknown_name(labels[i])}" for i in light[:1]]


def write_unknowns(folder, labels, places):
    """nodes.csv where places are known, else unknowns.csv; its name, and the unknowns without a place."""
    if isinstance(labels[0], int):
        return "", []
    name = "nodes.csv" if places else "unknowns.csv"
    lost = [label for label in labels if places and label[0] not in places]
    with whole(folder / name) as part:
        with part.open("w") as out:
            out.write("unknown,node,direction" + (",x,y,z\n" if places else "\n"))
            for i, (node, direction) in enumerate(labels, 1):
                place = [f"{x:.17g}" for x in places.get(node, ())] if places else []
                number = direction if isinstance(direction, int) and 1 <= direction <= 6 else 0
                if not places or place:
                    out.write(",".join(map(str, [i, node, number, *place])) + "\n")
    return name, lost


def write_scene(folder, found, table, lines):
    """The options file, whose terms are the matrices of known kind."""
    known = [matrix for matrix in found if kind_in(matrix)]
    with whole(folder / "matrices.yaml") as part:
        with part.open("w") as out:
            out.write("".join(f"# {printable(line)}\n" for line in lines))
            out.write(f'terms: "{",".join(matrix.name.lower() for matrix in known)}"\n')
            for matrix in found:
                kind, scale = kind_in(matrix), f", scale: {matrix.scale:.17g}" if matrix.scale != 1 else ""
                out.write(f"{'' if kind else '# give its kind, and add it to terms: '}{matrix.name.lower()}: "
                          f"{{file: {matrix.name}.bin, kind: {kind or '?'}{scale}}}\n")
            if table == "nodes.csv":
                out.write("operators: {nodes: nodes.csv}\n")


def write(folder, found, places):
    """Writes everything; lines of what was done."""
    labels, matrices = unite(found)
    labels, matrices, lines = leave_out(found, labels, matrices)
    lines += odd_rows(found, labels, matrices)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for one, matrix in zip(found, matrices):
            matrix.eliminate_zeros()
            write_matrix(folder / f"{one.name}.bin", matrix)
            lines.append(f"{one.name}.bin: {matrix.shape[0]} unknowns, {matrix.nnz} entries, from {one.path}"
                         + (f"; {one.how}" if one.how else ""))
        table, lost = write_unknowns(folder, labels, places)
        lines += [f"has no place: {unknown_name(label)}" for label in lost]
        write_scene(folder, found, table, lines)
    except OSError as error:
        raise BadInput(f"{error.filename or folder}: {error.strerror}") from None
    return lines + [f"{table}: nodes and directions of the unknowns"] * bool(table)
