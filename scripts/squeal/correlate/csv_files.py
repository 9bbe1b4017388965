"""Tables of measured data: sensors (sensor, x, y, z, direction_x, direction_y, direction_z), modes (freq_hz, then mode and damping_ratio
where they are known, and for each sensor SENSOR, or SENSOR_re and SENSOR_im), responses (freq_hz, then SENSOR_re_m_n and SENSOR_im_m_n as
frf.csv has them, or _m_s_n, _m_s2_n of velocity and acceleration per force)."""

import math
import re
from dataclasses import dataclass, field

import numpy

from ..tables import BadInput, header, read_table

PLACE, DIRECTION = ("x", "y", "z"), ("direction_x", "direction_y", "direction_z")
ENDS = {"m_n": "displacement", "m_s_n": "velocity", "m_s2_n": "acceleration"}
RESPONSE = re.compile(r"(.+)_(re|im)_(m_n|m_s_n|m_s2_n)")
BESIDE = "error_m_n", "error_relative"  # of frf.csv: no responses


@dataclass
class Table:
    """What one table holds."""
    path: object
    sensors: dict = field(default_factory=dict)
    names: list = field(default_factory=list)
    modes: list = field(default_factory=list)
    freq: numpy.ndarray | None = None
    responses: list = field(default_factory=list)


def finite(text):
    """A number."""
    number = float(text)
    if not math.isfinite(number):
        raise ValueError
    return number


def blank_or_finite(text):
    """A number, or nan where there is none."""
    return finite(text) if text.strip() else math.nan


def read_sensors(path, there):
    """Place and direction of length 1 by name."""
    found = {}
    unknown = [name for name in there if name not in ("sensor", *PLACE, *DIRECTION)]
    if unknown:
        raise BadInput(f"{path}: column {unknown[0]} is unknown; columns are sensor,{','.join(PLACE + DIRECTION)}")
    for k, row in enumerate(read_table(path, {"sensor": str, **dict.fromkeys(PLACE + DIRECTION, finite)}), 2):
        direction = numpy.array([row[name] for name in DIRECTION])
        size = numpy.linalg.norm(direction)
        if not row["sensor"] or row["sensor"] in found or not size > 0:
            raise BadInput(f"{path}: line {k}: sensor '{row['sensor']}' has no name, stands twice, or has no direction")
        found[row["sensor"]] = numpy.array([row[name] for name in PLACE]), direction / size
    return found


def shape_columns(path, there):
    """Sensors of the columns of modes, and whether each is complex."""
    names = {}
    for column in there:
        stem = column.removesuffix("_re").removesuffix("_im")
        both = f"{stem}_re" in there and f"{stem}_im" in there
        if column != stem and not both:
            stem = column
        names[stem] = both
    if len(set(there)) < len(there):
        raise BadInput(f"{path}: a column stands twice")
    return names


def read_modes(path, there):
    """Sensors, and name, frequency, damping ratio and shape of each mode."""
    names = shape_columns(path, [name for name in there if name not in ("mode", "freq_hz", "damping_ratio")])
    kinds = {"freq_hz": finite} | ({"mode": str} if "mode" in there else {}) | \
        ({"damping_ratio": blank_or_finite} if "damping_ratio" in there else {})
    kinds |= {column: finite for name, both in names.items() for column in ((f"{name}_re", f"{name}_im") if both else (name,))}
    modes = []
    for k, row in enumerate(read_table(path, kinds), 2):
        damping = row.get("damping_ratio", math.nan)
        shape = numpy.array([complex(row[f"{name}_re"], row[f"{name}_im"]) if both else row[name] for name, both in names.items()])
        if row["freq_hz"] < 0 or abs(damping) > 1:
            raise BadInput(f"{path}: line {k}: a mode of {row['freq_hz']:g} Hz with damping ratio {damping:g} is none; give the ratio, "
                           f"no per cent")
        if names and not shape.any():
            raise BadInput(f"{path}: line {k}: the shape is 0 at all sensors")
        modes.append((row.get("mode", ""), row["freq_hz"], damping, shape if names else None))
    return list(names), modes


def read_responses(path, there):
    """Frequencies, and name, quantity and values of each response."""
    columns = [name for name in there if name != "freq_hz" and not name.endswith("_coherence") and name not in BESIDE]
    found = {}
    for column in columns:
        match = RESPONSE.fullmatch(column)
        if not match or f"{match[1]}_re_{match[3]}" not in there or f"{match[1]}_im_{match[3]}" not in there:
            raise BadInput(f"{path}: column {column}: responses are SENSOR_re_m_n and SENSOR_im_m_n, or _m_s_n, _m_s2_n, both of each")
        found[match[1]] = match[3]
    rows = read_table(path, dict.fromkeys(["freq_hz", *columns], finite))
    freq = numpy.array([row["freq_hz"] for row in rows])
    if not len(freq) or freq[0] < 0 or not (numpy.diff(freq) > 0).all():
        raise BadInput(f"{path}: freq_hz must rise from 0 or above")
    return freq, [(name, ENDS[end], numpy.array([complex(row[f"{name}_re_{end}"], row[f"{name}_im_{end}"]) for row in rows]))
                  for name, end in found.items()]


def read_csv(path):
    """The Table of a file; its columns say what it is."""
    if not path.exists():
        raise BadInput(f"{path}: no such file")
    there = [name.strip() for name in header(path)]
    table = Table(path)
    if "sensor" in there:
        table.sensors = read_sensors(path, there)
    elif any(RESPONSE.fullmatch(name) for name in there):
        table.freq, table.responses = read_responses(path, there)
    elif "freq_hz" in there:
        table.names, table.modes = read_modes(path, there)
    else:
        read_table(path, {"freq_hz": finite})  # says what is wrong
    if not (table.sensors or table.responses or table.modes):
        raise BadInput(f"{path}: has no row")
    return table
