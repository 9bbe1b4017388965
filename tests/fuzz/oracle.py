"""PETSc's binary form of a sparse matrix, read by another reader than PETSc's, and the frequencies that the files say."""

import struct

import numpy as np

HEAD = 1211216


def write(path, rows):
    entries = [[(j, value) for j, value in enumerate(row) if value] for row in rows]
    flat = [entry for row in entries for entry in row]
    integers = [HEAD, len(rows), len(rows), len(flat), *map(len, entries), *(j for j, _ in flat)]
    path.write_bytes(struct.pack(f">{len(integers)}i", *integers) + struct.pack(f">{len(flat)}d", *(v for _, v in flat)))


def read(path):
    """The matrix, dense; None where the file is not exactly one."""
    data = path.read_bytes()
    if len(data) < 16:
        return None
    head, m, n, nz = struct.unpack_from(">4i", data)
    if head != HEAD or not 0 < m < 100 or m != n or nz < 0 or len(data) != 16 + 4 * m + 12 * nz:
        return None
    counts = struct.unpack_from(f">{m}i", data, 16)
    columns = struct.unpack_from(f">{nz}i", data, 16 + 4 * m)
    values = struct.unpack_from(f">{nz}d", data, 16 + 4 * m + 4 * nz)
    A, k = np.zeros((m, n)), 0
    if min(counts) < 0 or sum(counts) != nz:
        return None
    for i, count in enumerate(counts):
        own = columns[k:k + count]
        if list(own) != sorted(set(own)) or (own and not 0 <= own[0] <= own[-1] < n):
            return None
        A[i, list(own)] = values[k:k + count]
        k += count
    return A if np.isfinite(A).all() else None


def eigenvalues(K, M):
    """The finite kappa of K x = kappa M x; with M singular by inversion about a shift that is none of them."""
    if np.linalg.matrix_rank(M) == len(M):
        return np.sort_complex(np.linalg.eigvals(np.linalg.solve(M, K)))
    shift = -0.123 * abs(K).max() / abs(M).max()
    inverse = np.linalg.eigvals(np.linalg.solve(K - shift * M, M))
    return np.sort_complex(shift + 1 / inverse[abs(inverse) > 1e-12 * abs(inverse).max()])
