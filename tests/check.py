"""Numeric checks of the tables of a run, as a case of tests/run.py asks for them: values in the order of the rows, by
label, against another run or other ranks, and bounds."""

import cmath
import csv
import math
import re
import shlex

import numpy  # noqa: F401, for scripts in children
from forked import run_script


class Failure(Exception):
    """What the test found wrong, for people."""


class Line(str):
    """What a check found, for people; where it compares numbers also the worst one and what it may be."""

    measured = allowed = None

    @classmethod
    def of(cls, text, measured, allowed):
        line = cls(text)
        line.measured, line.allowed = float(measured), float(allowed)
        return line

    def like(self, line):
        """With the numbers of another line."""
        self.measured, self.allowed = line.measured, line.allowed
        return self

    def used(self):
        """Share of what is allowed that is used up; 0 for nothing of nothing."""
        if self.measured is None:
            return -1
        return self.measured / self.allowed if self.allowed else math.inf if self.measured else 0.0


def worst_of(lines):
    """All lines as one, with the numbers of the one that uses most of what is allowed."""
    worst = max(lines, key=Line.used)
    return Line("; ".join(lines)).like(worst)


def measured_in(text):
    """Numbers that a script says it has measured, as "measured 1e-12, allowed 1e-9", as a line."""
    found = [Line.of(text, *pair) for pair in re.findall(r"measured ([-+.\w]+), allowed ([-+.\w]+)", text)]
    return max(found, key=Line.used, default=Line(text))


def require(condition, message):
    if not condition:
        raise Failure(message)


def number(text):
    """A cell of a table: a number where it is one."""
    try:
        return float(text)
    except ValueError:
        return text


def read_rows(path, where):
    """Rows of a table for which `where` holds, with the complex eigenvalue as one more column where there is one."""
    require(path.is_file(), f"{path.name} was not written")
    with path.open(newline="") as file:
        rows = [{key: number(cell) for key, cell in row.items()} for row in csv.DictReader(file)]
    for row in rows:
        if "growth_rad_s" in row and "freq_hz" in row:
            row["eigenvalue"] = complex(row["growth_rad_s"], 2 * math.pi * row["freq_hz"])
    return [row for row in rows if not where or eval(where, {"__builtins__": {"abs": abs}}, row)]


def column_of(rows, column):
    require(all(column in row for row in rows), f"there is no column {column!r}")
    values = [row[column] for row in rows]
    lost = [i for i, value in enumerate(values, 1) if not isinstance(value, str) and not cmath.isfinite(value)]
    require(not lost, f"{column} is not finite in rows {lost[:5]}")  # nan compares as false with every bound
    return values


def nearest_pairs(values, references):
    """Pairs each reference with the nearest value that is still free."""
    free, pairs = list(values), []
    for reference in references:
        value = min(free, key=lambda other: abs(other - reference))
        free.remove(value)
        pairs.append((value, reference))
    return pairs


def pairs_by_label(rows, references, column):
    """Pairs each (label, reference) with the nearest value of the rows with that label."""
    pairs = []
    for label, reference in references:
        values = [row[column] for row in rows if row["label"] == label]
        require(values, f"no row has the label {label}")
        pairs.append((min(values, key=lambda other: abs(other - reference)), reference))
    return pairs


def pairs_in_order(values, references, column):
    require(len(values) == len(references), f"{len(values)} rows, but {len(references)} were expected")
    if column == "eigenvalue":
        return nearest_pairs(values, references)
    return list(zip(values, references))


def compare(pairs, check):
    """Judges pairs (value, reference); returns the worst error in units of what is allowed, and a line about it."""
    if any(isinstance(reference, str) for _, reference in pairs):
        wrong = [f"{value} for {reference}" for value, reference in pairs if value != reference]
        require(not wrong, "; ".join(wrong))
        return Line(f"{len(pairs)} texts equal")
    rtol, atol = check.get("rtol", 0), check.get("atol", 0)
    atols = atol if isinstance(atol, list) else [atol] * len(pairs)
    errors = [(abs(value - reference), least + rtol * abs(reference), value, reference)
              for (value, reference), least in zip(pairs, atols, strict=True)]
    error, allowed, value, reference = max(errors, key=lambda e: e[0] / e[1] if e[1] else e[0])
    line = f"{len(pairs)} values, worst {value:.12g} for {reference:.12g}, error {error:.2e}, allowed {allowed:.2e}"
    line = Line.of(line, error, allowed)
    require(all(e[0] <= e[1] for e in errors), line)
    return line


class Checker:
    """Makes the checks of a case on the tables of one number of ranks; `first` is the runner of the first."""

    def __init__(self, runner, first):
        self.runner, self.first = runner, first

    def rows(self, runner, name, check):
        return read_rows(runner.output(name) / check.get("table", "modes.csv"), check.get("where"))

    def make(self, check):
        name = check.get("run", next(iter(self.runner.case["run"])))
        if "command" in check:
            command = self.runner.expand(check["command"])
            done = run_script(command[0], command[1:])
            print(done.stdout, done.stderr, sep="", end="", flush=True)
            found = measured_in(done.stdout)
            require(done.returncode == 0, Line(f"failed: {shlex.join(command)}").like(found))
            return Line(f"{check['command']} succeeded").like(found)
        rows = self.rows(self.runner, name, check)
        lines = [*self.references(rows, name, check), *self.bounds(rows, check)]
        require(lines or "across_ranks" in check, "the check has no reference")
        return worst_of(lines) if lines else ""

    def references(self, rows, name, check):
        column = check.get("column", "eigenvalue")
        values = column_of(rows, column)
        if "equals" in check:
            require(rows, "no row is selected")
            yield compare(self.stated_pairs(rows, values, column, check["equals"]), check)
        if check.get("pairs"):
            require(rows and len(rows) % 2 == 0, f"{len(rows)} rows are no pairs")
            yield compare(list(zip(values[1::2], values[::2])), check)
        others = []
        if "equals_run" in check:
            others.append(self.rows(self.runner, check["equals_run"], check))
        if check.get("across_ranks") and self.runner is not self.first:
            others.append(self.rows(self.first, name, check))
        for other in others:
            require(rows, "no row is selected")
            yield compare(pairs_in_order(values, column_of(other, column), column), check)

    @staticmethod
    def stated_pairs(rows, values, column, equals):
        if isinstance(equals, dict):
            return pairs_by_label(rows, list(equals.items()), column)
        if column == "eigenvalue":
            equals = [complex(growth, 2 * math.pi * frequency) for growth, frequency in equals]
        return pairs_in_order(values, equals, column)

    @staticmethod
    def bounds(rows, check):
        if "count" in check:
            require(len(rows) == check["count"],
                    Line.of(f"{len(rows)} rows, but {check['count']} were expected", len(rows), check["count"]))
            yield Line(f"{len(rows)} rows")
        if "min" in check or "max" in check:
            require(rows, "no row is selected")
            values = column_of(rows, check["column"])
            line = Line(f"{check['column']} from {min(values):.6g} to {max(values):.6g}")
            if "max" in check:
                line = Line.of(line, max(values), check["max"])
            require(check.get("min", -math.inf) <= min(values) and max(values) <= check.get("max", math.inf), line)
            yield line
