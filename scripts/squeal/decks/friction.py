"""Friction over slip rate and pressure. A deck has lines (mu, slip rate, pressure, temperature): straight over the slip rate at each
pressure, over the pressure between these, over the temperature between those, and constant beyond the first and the last. On the grid of
all slip rates and pressures squeal's bilinear table is the same."""

import numpy

MOST = 20000  # lines of a table of squeal
BEYOND = 1e3, 1e12  # m/s, Pa: to where mu stays what it is at the end of the deck's table
COLUMNS = "slip rate", "pressure", "temperature"


def unlike(lines):
    """Columns 1 to 3 that have more than one value."""
    return [word for k, word in enumerate(COLUMNS, 1) if len({line[k] for line in lines}) > 1]


def wrong(lines):
    """What is wrong with lines (mu, slip rate, pressure, temperature), or nothing."""
    values = numpy.array(lines)
    if not numpy.isfinite(values).all():
        return "its numbers must be finite"
    if (values[:, :3] < 0).any():
        return f"mu, slip rate and pressure must not be negative, and {values[:, :3].min():g} stands there"
    if len({tuple(line) for line in values[:, 1:].tolist()}) < len(values):
        return "two lines are of the same slip rate, pressure and temperature"
    return ""


def interpolated(at, x, values):
    """Values [n][...] of x [n] at `at`: straight between, constant beyond."""
    order = numpy.argsort(x)
    x, values = numpy.asarray(x)[order], numpy.asarray(values)[order]
    flat = values.reshape(len(x), -1)
    return numpy.array([numpy.interp(at, x, column) for column in flat.T]).T.reshape(numpy.shape(at) + values.shape[1:])


def grid(lines, temperature=None):
    """Slip rates [n], pressures [m] from 0 on, and mu [n][m] at a temperature, of lines that wrong() finds nothing in."""
    values = numpy.array(lines)
    speeds, pressures = (numpy.unique([0.0, *values[:, k]]) for k in (1, 2))
    if temperature is None:
        temperature = values[0, 3]
    warm, found = numpy.unique(values[:, 3]), []
    for state in warm:
        own = values[values[:, 3] == state]
        pressed = numpy.unique(own[:, 2])
        curves = [interpolated(speeds, own[own[:, 2] == p, 1], own[own[:, 2] == p, 0]) for p in pressed]
        found.append(interpolated(pressures, pressed, curves).T)
    return speeds, pressures, interpolated(temperature, warm, found)


def at_temperature(lines, temperature):
    """Lines of the grid at a temperature, all of it 0."""
    speeds, pressures, mu = grid(lines, temperature)
    return [(float(mu[i, j]), s, p, 0.0) for j, p in enumerate(pressures.tolist()) for i, s in enumerate(speeds.tolist())]


def law_of(deck, place, words, lines, temperature=None):
    """What a contact has of lines at one temperature (value, place): (mu, ()) where mu is one number, else (largest mu, lines). What
    is wrong raises; what is chosen is said."""
    bad = wrong(lines)
    if bad:
        raise place.wrong(f"{words}: {bad}")
    warm = [line[3] for line in lines]
    if len(set(warm)) > 1:
        value, said = (temperature[0], f"the temperature {temperature[0]:g} of {temperature[1]}") if temperature else \
            (warm[0], f"{warm[0]:g}, the first temperature, as no other is told")
        (deck.differ if temperature else deck.note)(place, f"{words}: at {said}")
        lines = at_temperature(lines, value)
    if len({line[0] for line in lines}) == 1:
        return lines[0][0], ()
    if len(lines) > MOST or (len(grid(lines)[0]) + 1) * (len(grid(lines)[1]) + 1) >= MOST:
        raise place.wrong(f"{words}: squeal's tables have at most {MOST} lines")
    deck.differ(place, f"{words}: as a table over slip rate and pressure, which beyond its ends stays what it is there, as in the deck")
    return max(line[0] for line in lines), tuple(map(tuple, lines))


def table_text(lines, units):
    """The file of -..._mu_file, in SI."""
    speeds, pressures, mu = grid(lines)
    speeds, pressures = speeds * units.length / units.time, pressures * units.stress
    for axis, (values, last) in enumerate(zip((speeds, pressures), BEYOND)):
        last = max(last, 10 * values[-1])
        mu = numpy.concatenate([mu, mu[-1:] if axis == 0 else mu[:, -1:]], axis)
        speeds, pressures = (numpy.append(values, last), pressures) if axis == 0 else (speeds, numpy.append(values, last))
    rows = [f"{s:.15g},{p:.15g},{mu[i, j]:.15g}" for i, s in enumerate(speeds) for j, p in enumerate(pressures)]
    return "\n".join(["speed,pressure,mu", *rows]) + "\n"
