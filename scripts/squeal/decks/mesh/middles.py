"""Elements of second order some of whose edges have no node in the middle."""

import numpy

from .elements import EDGES


def edge_keys(block, n_nodes):
    """A number for each edge [n][edges] of the elements of a block, by its corners."""
    edges = numpy.array(EDGES[block.shape.family])
    ends = numpy.sort(block.nodes[:, edges], axis=2).astype(numpy.int64)
    return ends[:, :, 0] * n_nodes + ends[:, :, 1]


def fill_middles(deck, blocks):
    """Gives each edge that lacks its middle node (-1) the one that a neighbour has there, else a new one between its corners.
    Other codes keep such an edge straight."""
    second = [block for block in blocks if block.shape.second and (block.nodes < 0).any()]
    if not second:
        return
    n = deck.n_nodes
    of_second = [block for block in blocks if block.shape.second]
    keys = numpy.concatenate([edge_keys(block, n).ravel() for block in of_second])
    nodes = numpy.concatenate([block.nodes[:, block.shape.n_corners:][:, :len(EDGES[block.shape.family])].ravel() for block in of_second])
    known, first = numpy.unique(keys[nodes >= 0], return_index=True)
    wanted = numpy.unique(keys[nodes < 0])
    new = numpy.setdiff1d(wanted, known)
    made = deck.add_nodes((deck.x[new // n] + deck.x[new % n]) / 2)
    known, at = numpy.concatenate([known, new]), numpy.concatenate([nodes[nodes >= 0][first], made])
    order = numpy.argsort(known)
    for block in second:
        n_corners = block.shape.n_corners
        found = at[order][numpy.searchsorted(known[order], edge_keys(block, n))]
        part = block.nodes[:, n_corners:n_corners + found.shape[1]]
        block.nodes[:, n_corners:n_corners + found.shape[1]] = numpy.where(part < 0, found, part)
    straight = [edge_keys(block, n).ravel() for block in blocks if not block.shape.second]
    hanging = int(numpy.isin(new, numpy.concatenate(straight)).sum()) if straight else 0
    deck.differ(second[0].place, f"{second[0].kind} without some of its nodes in the middle of edges: {len(new)} are made "
                "there, so that the edges bend" + (
                    f"; {hanging} are beside elements of first order, which do not follow them" if hanging else ""))
