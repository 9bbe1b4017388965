"""What the scripts that read squeal's tables share: reading with one-line errors, writing, colours."""

import csv
import math
import sys

# Safe for colour-blind readers (Okabe and Ito)
BLUE, VERMILION, GREEN, SKY, PURPLE, ORANGE = "#0072B2", "#D55E00", "#009E73", "#56B4E9", "#AA4499", "#E69F00"
GREY = "#8A8A8A"

MINUS = "\N{MINUS SIGN}"


class BadInput(Exception):
    """One line for the user."""


def flag(text):
    """Truth of 0, 1, false, true."""
    return {"0": False, "1": True, "false": False, "true": True}[text.lower()]


def optional(text):
    """A number, or nan where there is none."""
    return float(text) if text.strip() else math.nan


def read_table(path, kinds):
    """Rows of a table as dictionaries with the columns of `kinds`, each converted by its function."""
    try:
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
    return values


def save_picture(figure, output):
    """Writes the picture in the format of the name's ending."""
    try:
        figure.savefig(output)
    except (OSError, ValueError) as error:
        raise BadInput(f"cannot write {output}: {getattr(error, 'strerror', None) or error}") from None


def run(name, work):
    """Does the work and prints the file that it returns; returns the exit status."""
    try:
        print(work())
    except BadInput as error:
        print(f"{name}: {error}", file=sys.stderr)
        return 1
    return 0
