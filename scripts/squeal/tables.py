"""Tables: those that squeal wrote, read with one-line errors, and those that the scripts print."""

import contextlib
import csv
import math
import os
import sys

from . import STOPPED

MAY_BE_INFINITE = "error", "condition"  # how names of columns begin that hold inf where nothing is known
TRACE = "SQUEAL_TRACE"  # where it is set, an exception that nobody foresaw shows its trace


class BadInput(Exception):
    """One line for the user."""


def flag(text):
    """Truth of 0, 1, false, true."""
    return {"0": False, "1": True, "false": False, "true": True}[text.lower()]


def optional(text):
    """A number, or nan where there is none."""
    return float(text) if text.strip() else math.nan


def regular(path):
    """The path itself, unless it is of a pipe or a device, which might never end."""
    if path.exists() and not path.is_file() and not path.is_dir():
        raise BadInput(f"{path}: is no file but a {'pipe' if path.is_fifo() else 'device or socket'}; give a file")
    return path


def read_table(path, kinds):
    """Rows of a table as dictionaries with the columns of `kinds`, each converted by its function."""
    try:
        regular(path)
        with path.open(newline="") as lines:
            reader = csv.DictReader(lines)
            missing = [name for name in kinds if name not in (reader.fieldnames or [])]
            if missing:
                raise BadInput(f"{path}: no column {missing[0]}" if reader.fieldnames else f"{path}: is empty")
            return [convert(path, reader.line_num, row, kinds) for row in reader]
    except FileNotFoundError:
        raise BadInput(f"{path}: no such file; run squeal first, or name its -output_dir") from None
    except (OSError, ValueError, csv.Error) as error:
        raise BadInput(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}") from None


def quoted(text):
    """A text as YAML has it in double quotes."""
    return '"' + str(text).replace("\\", "\\\\").replace('"', '\\"') + '"'


@contextlib.contextmanager
def whole(path):
    """The file to write in place of one, which bears its name only when all of it is there."""
    part = path.with_name(f"{path.name}.part")
    try:
        yield part
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


def cell_of(value):
    """A value as tables have it: nothing for a number that is not known."""
    if isinstance(value, float):  # those of NumPy too
        return "" if value != value else f"{value:.15g}"
    return value


def write_table(path, columns, rows):
    """A table of CSV under its final name."""
    with whole(path) as part, part.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(columns)
        table.writerows([cell_of(value) for value in row] for row in rows)


def header(path):
    """Names of the columns; none where they cannot be read, which is for read_table() to say."""
    try:
        with regular(path).open(newline="") as lines:
            return next(csv.reader(lines), [])
    except (BadInput, OSError, ValueError, csv.Error):
        return []


def convert(path, line, row, kinds):
    """The wanted columns of one row."""
    if None in row or None in row.values():
        raise BadInput(f"{path}: line {line} does not have as many columns as the header; was the file cut off?")
    values = {}
    for name, kind in kinds.items():
        try:
            values[name] = kind(row[name])
        except (ValueError, KeyError):
            raise BadInput(f"{path}: line {line}: {name} is '{row[name]}'") from None
        if kind is float and math.isinf(values[name]) and not name.startswith(MAY_BE_INFINITE):
            raise BadInput(f"{path}: line {line}: {name} is '{row[name]}', which is not finite")
    return values


def prefixed(value, unit):
    """Factor and name of the unit in which a value is easily read."""
    for factor, prefix in ((1e-9, "G"), (1e-6, "M"), (1e-3, "k")):
        if value * factor >= 1:
            return factor, prefix + unit
    return 1.0, unit


def print_table(title, *rows):
    """Text in the first column, numbers in the others."""
    print(f"\n{title}")
    widths = [max(len(cell) for cell in column) for column in zip(*rows)]
    for first, *others in rows:
        print("  ".join([first.ljust(widths[0]), *(cell.rjust(width) for cell, width in zip(others, widths[1:]))]))


def print_row(*cells):
    """A row of a markdown table, at once, since each costs a run."""
    print(f"| {' | '.join(cells)} |", flush=True)


def printable(text):
    """One line of letters that are seen; what is none, as in a damaged file or a name with a line break, becomes ?."""
    return "".join(letter if letter.isprintable() else "?" for letter in text)


def run(name, work):
    """Does the work and prints the file that it returns; returns the exit status. What goes wrong is one line; where it was not
    foreseen the line has the command line."""
    try:
        print(work(), flush=True)
    except BrokenPipeError:  # who reads has enough, as `head` has; what is left goes nowhere
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except (BadInput, OSError) as error:  # the latter where a folder cannot be made, or a disk is full
        said = f"{error.filename}: {error.strerror}" if getattr(error, "filename", None) else str(error)
        print(f"{name}: {printable(said)}", file=sys.stderr)
        return 1
    except Exception as error:  # pylint: disable=broad-except
        if os.environ.get(TRACE):
            raise
        said = f"{' '.join(sys.argv[1:])[:200]}: {type(error).__name__}: {' '.join(str(error).split())[:200]}"
        print(f"{name}: {printable(said)} (not foreseen; is a file damaged? {TRACE}=1 shows where)", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print(f"{name}: stopped", file=sys.stderr)
        return STOPPED
    return 0
