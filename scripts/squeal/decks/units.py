"""Units of a deck, by what densities, moduli and sizes would be in SI."""

from dataclasses import dataclass

import numpy

from ..tables import BadInput


@dataclass(frozen=True)
class Units:
    """Metres, kilograms and seconds in a unit."""
    name: str
    length: float
    mass: float
    time: float

    @property
    def density(self):
        return self.mass / self.length**3

    @property
    def stress(self):
        return self.mass / (self.length * self.time**2)

    @property
    def force(self):
        return self.mass * self.length / self.time**2

    @property
    def stiffness(self):
        return self.mass / self.time**2

    @property
    def stiffness_per_area(self):
        return self.stress / self.length


INCH, POUND = 0.0254, 0.45359237
SYSTEMS = {units.name: units for units in (
    Units("m-kg-s", 1, 1, 1), Units("mm-t-s", 1e-3, 1e3, 1), Units("mm-kg-ms", 1e-3, 1, 1e-3), Units("mm-kg-s", 1e-3, 1, 1),
    Units("cm-g-s", 1e-2, 1e-3, 1), Units("in-lbf-s", INCH, POUND * 9.80665 / INCH, 1))}
DENSITY, YOUNG, SIZE = (300, 23000), (1e6, 1.3e12), (1e-3, 20)  # kg/m^3, Pa, m: of solids in machines


def named(text):
    """Units of --units: a name, or metres, kilograms, seconds in a unit."""
    if text in SYSTEMS:
        return SYSTEMS[text]
    try:
        values = [float(word) for word in text.split(",")]
    except ValueError:
        values = []
    if len(values) != 3 or not all(0 < value < 1e30 for value in values):
        raise BadInput(f"--units {text}: must be one of {', '.join(SYSTEMS)}, or three positive numbers: metres, kilograms and "
                       "seconds in a unit, e.g. 0.001,1000,1")
    return Units(text, *values)


def fits(units, density, young, size):
    """Whether all is as of solids in machines."""
    pairs = ((numpy.multiply(density, units.density), DENSITY), (numpy.multiply(young, units.stress), YOUNG),
             ([size * units.length], SIZE))
    return all(low <= value <= high for values, (low, high) in pairs for value in values)


def guess(deck, size, used):
    """Units and the words that tell why; in doubt an error that asks for --units."""
    density = [material.density for material in used if material.density is not None]
    young = [modulus for material in used for modulus in material.young]
    known = [units for units in SYSTEMS.values() if fits(units, density, young, size)]
    values = f"size {size:.4g}" + (f", density {density[0]:.4g}" if density else "") + (f", E {young[0]:.4g}" if young else "")
    if density and len(known) == 1:
        units = known[0]
        return units, (f"units {units.name}, guessed: {values}, which would be {size * units.length:.4g} m, "
                       f"{density[0] * units.density:.4g} kg/m^3" + (f", {young[0] * units.stress:.4g} Pa" if young else ""))
    why = (f"could be {' or '.join(units.name for units in known)}" if known else "fit none of them") if density else \
        "there is no density to guess them by"
    raise BadInput(f"{deck.path}:1: units are in doubt ({values}; {why}); give --units, one of {', '.join(SYSTEMS)}, or metres, "
                   "kilograms, seconds in a unit, e.g. --units 0.001,1000,1")
