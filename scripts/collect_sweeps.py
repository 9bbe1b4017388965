#!/usr/bin/python3
"""Gathers the sweeps of a study into one table.

A study is a folder with one folder for each run of squeal. The rows of all their sweep.csv are written one below the
other, after columns for the name of the run and for every parameter that was not swept but differs between the runs
(from parameters.csv); those of onsets.csv go to a second table, NAME_onsets.csv. Numbers are copied as they stand. Runs
without a sweep are named on stderr and left out; the exit status is then 1.
"""

import argparse
import csv
import os
import sys
from pathlib import Path

from squeal_tables import BadInput, read_table, run


def fixed_parameters(folder):
    """Values, as text, of the parameters that the run did not sweep."""
    rows = read_table(folder / "parameters.csv", {"parameter": str, "value": str, "swept": int})
    return {row["parameter"]: row["value"] for row in rows if row["swept"] == 0}


def columns_of(path):
    """Names of the columns."""
    with path.open(newline="") as lines:
        return next(csv.reader(lines), [])


def study_parameters(runs, wanted):
    """The parameters that differ between the runs, or the wanted ones; runs = {folder: {parameter: value}}."""
    names = list(dict.fromkeys(name for values in runs.values() for name in values))
    for name in wanted:
        if name not in names:
            raise BadInput(f"--parameter {name}: no such parameter; there are {', '.join(names)}")
    return wanted or [name for name in names if len({values.get(name) for values in runs.values()}) > 1]


def order(values, parameters):
    """Key that sorts runs by the values of the study's parameters."""
    return [float(values.get(name, "nan")) for name in parameters]


def write_rows(path, header, rows):
    """The table, complete or not at all."""
    part = path.with_name(path.name + ".part")
    try:
        with part.open("w", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(header)
            writer.writerows(rows)
        os.replace(part, path)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise BadInput(f"cannot write {path}: {error.strerror}") from None


def gather(runs, parameters, name, output):
    """Rows of the tables `name` of all runs that have one."""
    paths = {folder: folder / name for folder in runs if (folder / name).exists()}
    header, rows = None, []
    for folder, path in paths.items():
        columns = columns_of(path)
        if header and columns != header:
            raise BadInput(f"{path}: other columns than in {next(iter(paths.values()))}")
        header = columns
        own = [folder.name, *(runs[folder].get(parameter, "") for parameter in parameters)]
        rows += [own + list(row.values()) for row in read_table(path, dict.fromkeys(columns, str))]
    if header:
        write_rows(output, ["run", *parameters, *header], rows)


def collect(args):
    """Both tables; returns the name of the first one."""
    if not args.study.is_dir():
        raise BadInput(f"{args.study}: no such folder; it must hold one folder for each run")
    folders = sorted(path for path in args.study.iterdir() if path.is_dir())
    whole = [folder for folder in folders if (folder / "sweep.csv").exists()]
    if not whole:
        raise BadInput(f"{args.study}: none of its {len(folders)} folders has a sweep.csv")
    runs = {folder: fixed_parameters(folder) for folder in whole}
    parameters = study_parameters(runs, args.parameter)
    runs = dict(sorted(runs.items(), key=lambda item: order(item[1], parameters)))
    output = args.output or args.study / "study.csv"
    gather(runs, parameters, "sweep.csv", output)
    gather(runs, parameters, "onsets.csv", output.with_name(f"{output.stem}_onsets{output.suffix}"))
    if len(whole) < len(folders):
        missing = ", ".join(folder.name for folder in folders if folder not in runs)
        raise BadInput(f"{output} was written without {missing}: no sweep.csv there")
    return output


def arguments():
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("study", type=Path, help="folder with the folders of the runs")
    parser.add_argument("-o", "--output", type=Path, help="table to write, default: study.csv in that folder")
    parser.add_argument("--parameter", action="append", default=[], metavar="NAME",
                        help="parameter that gets a column, e.g. contact_mu; may be repeated; default: all that differ")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(run("collect_sweeps", lambda: collect(arguments())))
