"""How far the tables of two runs of one scene are apart. A column is measured in units of its family: x, y and z of a vector, real and
imaginary part, growth and frequency of eigenvalues, by the largest value that any of them has. What only says how well something is
known (errors, residuals, conditions), and what it cost, is not compared."""

import csv
import math
import re
from pathlib import Path
from typing import NamedTuple

IGNORED = re.compile("error|residual|condition|confirmed|projector|sweeps|iterations|worst_ratio|beyond|check|steps_changed|"
                     "pairs_changed|cost|decided_by")
EIGENVALUE = re.compile(r"growth(_freq)?_(rad_s|hz)$|freq_hz$")
DAMPING = "damping_ratio"  # -growth / |eigenvalue|, hence in units of 1
PART = re.compile(r"_[va]?(x|y|z|re|im|n|t|b|\d+)(?=_)")
GAPS, RESOLVED = ("gap_m", "slip_t_m", "slip_b_m"), 1e-6  # of the size of the model: its rounding is 1e-10 of that
PAIRED = 1e-6  # relative difference of frequencies below which two modes are a pair whose shapes are any of a plane
SHAPE = re.compile("label|class|part_.*_percent|partner|^mode$")


class Difference(NamedTuple):
    """The worst of two tables: in units of its family, where, and the first time at which it is beyond a limit (nan: never)."""
    value: float = 0.0
    where: str = ""
    since: float = math.nan


def family(table, name):
    """What a column is measured with."""
    if name == DAMPING:
        return table, DAMPING
    if EIGENVALUE.search(name):
        return table, "eigenvalue"
    if name.endswith("_j"):
        return table, "energy"
    return table, PART.sub("", name)


def size(name, text):
    """A number in the units of its family, or none where it is a word."""
    try:
        value = float(text)
    except ValueError:
        return None
    return value * 2 * math.pi if name.endswith("hz") and EIGENVALUE.search(name) else value


def read(path):
    """Rows of a table."""
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def paired(rows):
    """For each row whether another one has its frequency: of a pair of equal modes any two shapes may be found."""
    found = [float(row.get("freq_hz") or "nan") for row in rows]
    return [any(i != j and abs(a - b) <= PAIRED * abs(a) for j, b in enumerate(found) if abs(i - j) < 3) for i, a in enumerate(found)]


def scales(table, rows):
    """Largest finite size of each family; of a gap not less than what the place of a node resolves."""
    found = {(table, DAMPING): 1.0}
    for row in rows:
        for name, text in row.items():
            value = size(name, text)
            if value is not None and math.isfinite(value):
                key = family(table, name)
                found[key] = max(found.get(key, 0.0), abs(value))
    for name in GAPS:
        found[family(table, name)] = max(found.get(family(table, name), 0.0), RESOLVED * found.get(family(table, "x_m"), 0.0))
    return found


def apart(name, one, other, scale):
    """Of two entries, in units of their scale; words and what is not finite are alike or not."""
    a, b = size(name, one), size(name, other)
    if one == other:
        return 0.0
    if a is None or b is None or not (math.isfinite(a) and math.isfinite(b)):
        return math.inf
    return abs(a - b) / scale


def of_rows(name, one, other, apart_from=frozenset()):
    """For each row of two tables the worst entry, but of columns that are not compared."""
    scale, twins = scales(name, one + other), paired(one)
    for i, (a, b) in enumerate(zip(one, other)):
        worst = Difference()
        for column in a:
            if column not in b or column in apart_from or IGNORED.search(column) or (twins[i] and SHAPE.search(column)):
                continue
            value = apart(column, a[column], b[column], scale.get(family(name, column), 1.0))
            if value > worst.value:
                worst = Difference(value, f"{name} {column} row {i + 1}: {a[column]}, {b[column]}")
        yield worst._replace(since=float(a["time_s"]) if "time_s" in a else math.nan)


def of_table(name, one, other, limit, added=frozenset()):
    """Of two tables, but for `added` columns, which the first one alone may have."""
    if len(one) != len(other):
        return Difference(math.inf, f"{name}: {len(one)} and {len(other)} rows")
    if one and one[0].keys() - other[0].keys() - added:
        return Difference(math.inf, f"{name}: only one has {' '.join(sorted(one[0].keys() - other[0].keys() - added))}")
    found = list(of_rows(name, one, other, added))
    since = next((row.since for row in found if row.value > limit and not math.isnan(row.since)), math.nan)
    return max(found, key=lambda row: row.value, default=Difference())._replace(since=since)


def calm(rows):
    """Which rows of map.csv come before the first loss of contact of their chain upwards; transients after it are chaotic."""
    lost, found = set(), []
    for row in rows:
        chain = row.get("value_2")
        if row["direction"] != "up" or float(row["open_share"]) > 0:
            lost.add(chain)
        found.append(chain not in lost)
    return found


def of_map(one, other, limit):
    """Of the rows of two maps of as many: the worst of those that are calm; how many others are beyond the limit, and in how many of
    these words differ, as the regime."""
    quiet = calm(one)
    first, second = ([row for row, still in zip(rows, quiet) if still] for rows in (one, other))
    rest = [row.value for row, still in zip(of_rows("map.csv", one, other), quiet) if not still]
    found = of_table("map.csv", first, second, limit) if first else Difference(math.inf, "map.csv: no row before a loss of contact")
    return found, (sum(value > limit for value in rest), sum(map(math.isinf, rest)))


def added_columns(one, other):
    """Names of tables that only the first folder has, and of columns that only its tables have."""
    tables = {path.name for path in Path(one).glob("*.csv") if not (other / path.name).exists()}
    rows = [(read(path)[:1], read(other / path.name)[:1]) for path in Path(one).glob("*.csv") if (other / path.name).exists()]
    return frozenset(name for first, second in rows if first and second for name in first[0].keys() - second[0].keys()) | tables


def of_tables(one, other, limit, added=frozenset()):
    """Of each table of two folders the worst, but for the tables and columns `added` to the first one."""
    names = [{path.name for path in Path(folder).glob("*.csv")} - added for folder in (one, other)]
    if names[0] != names[1] or not names[0]:
        return [Difference(math.inf, f"tables {' '.join(sorted(names[0] ^ names[1])) or 'none'}")]
    return [of_table(name, read(one / name), read(other / name), limit, added) for name in sorted(names[0])]


def difference(one, other, limit, added=frozenset()):
    """The worst of all these tables."""
    found = of_tables(one, other, limit, added)
    worst = max(found, key=lambda one: one.value)
    return worst._replace(since=min((one.since for one in found if not math.isnan(one.since)), default=math.nan))
