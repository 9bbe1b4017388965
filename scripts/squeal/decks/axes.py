"""Directions that are held in axes of a node's own, as directions of space."""

import numpy

ALONG = 1e-9  # sine of the angle between two axes below which they are one


def aligned(axes, held):
    """Direction of space -> (own direction, sign) of those that are held among `axes` (rows); own is -1 where several own ones
    together hold several of space. None where what they hold is not along the axes of space."""
    across = [d for d in range(3) if numpy.linalg.norm(axes[held][:, d]) > ALONG]
    if len(across) != len(held):
        return None
    single = {d: [(own, float(numpy.sign(axes[own, d]))) for own in held if abs(abs(axes[own, d]) - 1) < ALONG] for d in across}
    return {d: (single[d] or [(-1, 0.0)])[0] for d in across}
