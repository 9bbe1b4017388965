"""Frequencies of straight-sided tetrahedra of 10 nodes, in numpy alone: the stiffness exact, the mass exact or with 4 points.

   K_ab = int (dN_a)^T D dN_b,  M_ab = rho int N_a N_b,  int L_1^a L_2^b L_3^c L_4^d = 6 V a! b! c! d! / (a + b + c + d + 3)!
"""

from math import factorial

import numpy as np

EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))  # that have the nodes 4 to 9
NEAR, FAR = (5 + 3 * 5**0.5) / 20, (5 - 5**0.5) / 20
POINTS = np.full((4, 4), FAR) + (NEAR - FAR) * np.eye(4)  # weight 1/4 each, exact to degree 2
VOIGT = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))


def shape(at):
    """N[10] at barycentric coordinates."""
    return np.array([at[i] * (2 * at[i] - 1) for i in range(4)] + [4 * at[a] * at[b] for a, b in EDGES])


def slopes(at):
    """dN[10]/dL[4]."""
    unit = np.eye(4)
    corners = [(4 * at[i] - 1) * unit[i] for i in range(4)]
    return np.array(corners + [4 * (at[a] * unit[b] + at[b] * unit[a]) for a, b in EDGES])


def exact_mass():
    """int N_a N_b / V; N as polynomials (factor, powers) of L."""
    unit = np.eye(4, dtype=int)
    terms = [[(2, 2 * unit[i]), (-1, unit[i])] for i in range(4)] + [[(4, unit[a] + unit[b])] for a, b in EDGES]

    def integral(one, other):
        total = 0
        for f, p in one:
            for g, q in other:
                total += f * g * 6 * np.prod([factorial(k) for k in p + q]) / factorial(sum(p + q) + 3)
        return total

    return np.array([[integral(one, other) for other in terms] for one in terms])


def rotated(compliance, axes):
    """Stiffness [3, 3, 3, 3] in global axes of a compliance [6, 6], engineering shear, order 11 22 33 12 13 23, in local
    axes, the rows of `axes`."""
    local, stiffness = np.zeros((3, 3, 3, 3)), np.linalg.inv(compliance)
    for m, (i, j) in enumerate(VOIGT):
        for n, (k, l) in enumerate(VOIGT):
            local[i, j, k, l] = local[j, i, k, l] = local[i, j, l, k] = local[j, i, l, k] = stiffness[m, n]
    return np.einsum("ijkl,ia,jb,kc,ld->abcd", local, axes, axes, axes, axes, optimize=True)


def frequencies(nodes, cells, held, stiffness, density, four_points):
    """Hz, ascending: nodes [n, 3], cells [m, 10] and held [] with numbers of nodes, stiffness [3, 3, 3, 3]."""
    sides = nodes[cells[:, 1:4]] - nodes[cells[:, :1]]
    volume = np.abs(np.linalg.det(sides)) / 6
    inner = np.linalg.inv(sides).transpose(0, 2, 1)
    barycentric = np.concatenate([-inner.sum(axis=1, keepdims=True), inner], axis=1)  # dL[4]/dx
    unit_mass = sum(np.outer(shape(at), shape(at)) for at in POINTS) / 4 if four_points else exact_mass()
    n = len(nodes)
    k, m = np.zeros((n, 3, n, 3)), np.zeros((n, n))
    for at in POINTS:
        dn = slopes(at) @ barycentric
        own = np.einsum("eaj,ijkl,ebl,e->eabik", dn, stiffness, dn, volume / 4, optimize=True)
        np.add.at(k.transpose(0, 2, 1, 3), (cells[:, :, None], cells[:, None, :]), own)
    np.add.at(m, (cells[:, :, None], cells[:, None, :]), density * volume[:, None, None] * unit_mass)
    free = np.setdiff1d(np.arange(n), held)
    k = k[free][:, :, free].reshape(3 * len(free), -1)
    half = np.linalg.inv(np.linalg.cholesky(np.kron(m[np.ix_(free, free)], np.eye(3))))
    return np.sqrt(np.linalg.eigvalsh(half @ k @ half.T)) / (2 * np.pi)
