"""Engineering constants of an orthotropic stiffness."""

import numpy


def engineering(material, normal, shear, place):
    """Sets young, poisson (12, 13, 23) and shear (12, 13, 23) of a material from the stiffness [3][3] of its normal strains
    and its three shear moduli."""
    normal = numpy.array(normal, float)
    if not (numpy.linalg.eigvalsh(normal) > 0).all() or min(shear) <= 0:
        raise place.wrong(f"the stiffness of material {material.name} is not positive definite")
    s = numpy.linalg.inv(normal)
    material.young = tuple(1 / s[i, i] for i in range(3))
    material.poisson = tuple(-s[i, j] / s[i, i] for i, j in ((0, 1), (0, 2), (1, 2)))
    material.shear = tuple(shear)
