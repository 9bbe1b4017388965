"""Writers of matrices in the forms of other programs, each from its manual, for the tests of scripts/import_matrices."""

import struct

import h5py
import numpy
import scipy.io
import scipy.sparse

NODES = (7, 3, 12, 5)  # the model's, in the order in which files list them


def model(seed=1):
    """K and M of 12 unknowns, symmetric, with some zeros; and a skew and an unsymmetric matrix."""
    random = numpy.random.default_rng(seed)
    part = random.random((12, 12)) * (random.random((12, 12)) < 0.4)
    K = part + part.T + 10 * numpy.eye(12)
    M = numpy.diag(1 + random.random(12))
    M[0, 5] = M[5, 0] = 0.125
    return {"K": K, "M": M, "G": part - part.T, "U": K + part}


def market(path, A):
    """By scipy, which finds out the symmetry."""
    with path.open("wb") as out:
        scipy.io.mmwrite(out, scipy.sparse.coo_matrix(A), precision=17)


def market_array(path, A):
    """Dense, by scipy."""
    with path.open("wb") as out:
        scipy.io.mmwrite(out, A, precision=17)


def fixed(values, per, form):
    """Lines of numbers of one width."""
    return ["".join(form % value for value in values[i:i + per]) for i in range(0, len(values), per)]


def harwell(path, A, comma=False):
    """Lower triangle of a symmetric matrix (RSA), all of another (RUA), as Ansys writes them."""
    symmetric = (A == A.T).all()
    B = scipy.sparse.csc_matrix(numpy.tril(A) if symmetric else A)
    B.sort_indices()
    pointer, index = fixed((B.indptr + 1).tolist(), 8, "%14d"), fixed((B.indices + 1).tolist(), 8, "%14d")
    value = [line.replace("e", "D") for line in fixed(B.data.tolist(), 3, "%25.16e")]
    cards = [len(pointer), len(index), len(value), 0]
    head = [f"{'a matrix':72s}{'KEY':8s}", "".join(f"{n:14d}" for n in (sum(cards), *cards)),
            f"{'RSA' if symmetric else 'RUA':14s}" + "".join(f"{n:14d}" for n in (*A.shape, B.nnz, 0)),
            f"{'(8I14)':16s}{'(8I14)':16s}{'(1P,3E25.16)':20s}{'':20s}"]
    path.write_text("\n".join(head + pointer + index + value) + "\n")


def unknowns():
    """Node and direction of each row."""
    return [(node, direction) for node in NODES for direction in (1, 2, 3)]


def abaqus(path, A):
    """FORMAT=MATRIX INPUT: one triangle of a symmetric matrix."""
    labels, symmetric = unknowns(), (A == A.T).all()
    with path.open("w") as out:
        out.write("" if symmetric else "*MATRIX INPUT, NAME=U, TYPE=UNSYMMETRIC\n")
        for i, j in zip(*numpy.nonzero(numpy.tril(A) if symmetric else A)):
            out.write("%10d,%2d,%10d,%2d, %24.17e\n" % (*labels[i], *labels[j], A[i, j]))


def calculix(path, A):
    """Upper triangle column by column, every diagonal entry; the .dof beside."""
    path.with_suffix(".dof").write_text("".join(f"{node}.{direction}\n" for node, direction in unknowns()))
    with path.open("w") as out:
        for j in range(len(A)):
            for i in range(j + 1):
                if A[i, j] or i == j:
                    out.write("%d %d %24.17e\n" % (i + 1, j + 1, A[i, j]))


def dmig_cards(name, A, form, kind=2, polar=0, lines=None):
    """Head and columns of bulk data in free fields, or as `lines` makes them of the fields of a card."""
    labels, lines = unknowns(), lines or free_fields
    cards = lines(["DMIG", name, 0, form, kind, 0, polar])
    for j in range(len(A)):
        fields = []
        for i in numpy.flatnonzero(A[:, j]):
            if form != 6 or labels[i] >= labels[j]:
                fields += [*labels[i], *((A[i, j].real, A[i, j].imag) if kind > 2 else (float(A[i, j]), ""))]
        cards += lines(["DMIG", name, *labels[j], "", *fields]) if fields else []
    return cards


def free_fields(card):
    """Eight fields a line."""
    words = [repr(float(word)) if isinstance(word, float) else str(word) for word in card]
    return [",".join([words[0] if at == 1 else "", *words[at:at + 8]]) for at in range(1, len(words), 8)]


def small_fields(card):
    """Fields of 8 characters, numbers without an E, as 1.5-3."""
    words = [("%.7g" % word if "." in "%.7g" % word else "%d." % word) if isinstance(word, float) else str(word) for word in card]
    return [(words[0] if at == 1 else "+").ljust(8) + "".join(word.rjust(8) for word in words[at:at + 8]) for at in range(1, len(words), 8)]


def large_fields(card):
    """Fields of 16 characters, exponents with a D, as punched; the head in small ones."""
    if card[2] == 0:
        return small_fields(card)
    words = [("%.9E" % word).replace("E", "D") if isinstance(word, float) else str(word) for word in card]
    return [(words[0] + "*" if at == 1 else "*").ljust(8) + "".join(word.rjust(16) for word in words[at:at + 4])
            for at in range(1, len(words), 4)]


def dmig(path, A):
    """One matrix, in free fields."""
    path.write_text("\n".join(dmig_cards(path.stem, A, 6 if (A == A.T).all() else 1)) + "\n")


def runs(column):
    """First row (from 1) and values of each run without zeros."""
    at = numpy.flatnonzero(column)
    for part in numpy.split(at, numpy.flatnonzero(numpy.diff(at) > 1) + 1):
        if len(part):
            yield int(part[0]) + 1, column[part].tolist()


def op4_text(path, A, name, sparse=None):
    """Dense, sparse ('strings') or with BIGMAT ('bigmat')."""
    rows, columns = A.shape
    lines = ["%8d%8d%8d%8d%-8s%s" % (columns, -rows if sparse == "bigmat" else rows, 6 if (A == A.T).all() else 1, 2, name, "1P,3E24.16")]
    for j in range(columns):
        pieces = list(runs(A[:, j]))
        if not pieces:
            continue
        if not sparse:
            first, last = pieces[0][0], pieces[-1][0] + len(pieces[-1][1])
            lines += ["%8d%8d%8d" % (j + 1, first, last - first), *fixed(A[first - 1:last - 1, j].tolist(), 3, "%24.16E")]
            continue
        head = 2 if sparse == "bigmat" else 1
        lines.append("%8d%8d%8d" % (j + 1, 0, sum(head + 2 * len(values) for _, values in pieces)))
        for row, values in pieces:
            words = 2 * len(values)
            lines.append("%8d%8d" % (words + 1, row) if sparse == "bigmat" else "%8d" % (row + 65536 * (words + 1)))
            lines += fixed(values, 3, "%24.16E")
    lines += ["%8d%8d%8d" % (columns + 1, 1, 1), "%24.16E" % 1]
    path.write_text("\n".join(lines) + "\n")


def op4_binary(path, A, name, sparse=None, order="<"):
    """The same in records, words of 4 bytes."""
    def record(data):
        mark = struct.pack(order + "i", len(data))
        return mark + data + mark

    rows, columns = A.shape
    out = record(struct.pack(order + "4i8s", columns, -rows if sparse == "bigmat" else rows, 6 if (A == A.T).all() else 1, 2,
                             name.ljust(8).encode()))
    for j in range(columns):
        pieces, body = list(runs(A[:, j])), b""
        if not pieces:
            continue
        first = 0
        if not sparse:
            first, last = pieces[0][0], pieces[-1][0] + len(pieces[-1][1])
            body = A[first - 1:last - 1, j].astype(order + "f8").tobytes()
        for row, values in pieces if sparse else []:
            words = 2 * len(values)
            head = struct.pack(order + "2i", words + 1, row) if sparse == "bigmat" else struct.pack(order + "i", row + 65536 * (words + 1))
            body += head + numpy.array(values, order + "f8").tobytes()
        out += record(struct.pack(order + "3i", j + 1, first, len(body) // 4) + body)
    path.write_bytes(out + record(struct.pack(order + "3id", columns + 1, 1, 2, 1.0)))


def matlab(path, A, name, compressed=False):
    """Sparse, by scipy."""
    scipy.io.savemat(path, {name: scipy.sparse.csc_matrix(A)}, do_compression=compressed)


def matlab_hdf5(path, A, name):
    """Version 7.3."""
    B = scipy.sparse.csc_matrix(A)
    with h5py.File(path, "w") as file:
        group = file.create_group(name)
        group.attrs["MATLAB_sparse"] = numpy.uint64(len(A))
        group["jc"], group["ir"], group["data"] = B.indptr.astype("u8"), B.indices.astype("u8"), B.data
