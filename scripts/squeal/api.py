"""squeal from Python: runs of a scene with other values, its tables and fields as NumPy arrays, its pictures.

    from squeal import api

    soft = api.run("options/massi2005.yaml", folder="results/soft", pad_young=16e9, modes_band=(2500, 6000))
    modes = soft.table("modes")                 # structured array, a field for each column
    modes["growth_rad_s"].max()
    soft.shape(modes["mode"][0])                # complex displacement of each node
    soft.picture("modes")                       # path of a PNG

    old = api.read("results")                   # a folder that is there

Numbers are in the units of the scene. Without `program` squeal is compiled as by scripts/run; where it is installed, that of the
same prefix is taken. An empty entry of a table is nan. What fails raises Failed, with squeal's own line."""

import csv
import math
import subprocess
import sys
from pathlib import Path

import numpy

from .run.program import ROOT, chosen_program
from .tables import header, regular


class Failed(Exception):
    """A run, a table or a field that is not there; its text is one line."""


def text_of(value):
    """A value as the command line has it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple, numpy.ndarray)):
        return ",".join(text_of(one) for one in value)
    if isinstance(value, (float, numpy.floating)) and not math.isfinite(value):
        raise Failed(f"{value}: is no number of an option")
    return repr(float(value)) if isinstance(value, (float, numpy.floating)) else str(value)


def words_of(files, folder, options):
    """The words behind the program."""
    words = [word for file in files for word in ("-options_file", str(file))] + ["-output_dir", str(folder)]
    for name, value in options.items():
        words += [f"-{name}", text_of(value)]
    return words


def last_line(text):
    """The line that says what went wrong."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    return next((line for line in lines if line.startswith("squeal:")), lines[-1] if lines else "ended without a word")


def run(*files, folder="results", ranks=1, program=None, **options):
    """Runs squeal on options files, with further options by their names without the minus: contact_mu=0.3,
    modes_band=(2500, 6000). Returns the Results; Failed where the run fails."""
    try:
        program = chosen_program(Path(program) if program else None, "program")
    except SystemExit as error:
        raise Failed(str(error)) from None
    command = [ROOT / "scripts/mpirun", "-n", str(ranks), program, *words_of(files, folder, options)]
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    if done.returncode:
        raise Failed(last_line(done.stderr))
    return Results(folder, done.stdout)


def read(folder="results"):
    """The Results of a folder that is there."""
    if not (Path(folder) / "scene.yaml").is_file():
        raise Failed(f"{folder}: holds no results of squeal: no scene.yaml")
    return Results(folder)


def column_of(entries):
    """Numbers where all entries are some or empty, else texts."""
    try:
        numbers = [float(entry) if entry else math.nan for entry in entries]
    except ValueError:
        return numpy.array(entries, dtype=str)
    whole = bool(numbers) and all(entry.lstrip("-").isdecimal() for entry in entries)
    return numpy.array(numbers, dtype=int if whole else float)


class Results:
    """What a run wrote into its folder. `printed`: its lines, where run() made it."""

    def __init__(self, folder, printed=""):
        self.folder, self.printed = Path(folder), printed

    @property
    def tables(self):
        """Names of the tables."""
        return sorted(path.stem for path in self.folder.glob("*.csv"))

    def table(self, name):
        """A table as a structured array: table("modes")["freq_hz"]. options/results.md lists tables and columns."""
        path = self.folder / f"{name}.csv"
        if not path.is_file():
            raise Failed(f"{path}: no such table; there are {', '.join(self.tables) or 'none'}")
        names = header(path)
        with regular(path).open(newline="") as lines:
            rows = list(csv.reader(lines))[1:]
        if not names or any(len(row) != len(names) for row in rows):
            raise Failed(f"{path}: is no table, or was cut off")
        columns = [column_of([row[i] for row in rows]) for i in range(len(names))]
        table = numpy.empty(len(rows), dtype=[(one, column.dtype) for one, column in zip(names, columns)])
        for one, column in zip(names, columns):
            table[one] = column
        return table

    def frame(self, name):
        """The same as a DataFrame of pandas, which must be installed."""
        import pandas
        return pandas.DataFrame({one: self.table(name)[one] for one in self.table(name).dtype.names})

    @property
    def scene(self):
        """Options in force, by their names: texts, as scene.yaml has them."""
        import yaml
        return yaml.safe_load((self.folder / "scene.yaml").read_text()) or {}

    def fields(self, name="modes"):
        """Names of the fields at the nodes in a file of fields, as modes, static or check."""
        with self.opened(name) as file:
            return sorted(file["VTKHDF/PointData"])

    def field(self, field, name="modes"):
        """A field: a row for each node."""
        with self.opened(name) as file:
            data = file["VTKHDF/PointData"]
            if field not in data:
                raise Failed(f"{name}.h5: no field {field}; there are {', '.join(sorted(data))}")
            return data[field][:]

    def shape(self, mode):
        """Displacement of a mode at each node, complex, x^H M x = 1 kg m^2."""
        return self.field(f"mode_{mode:03d}_re") + 1j * self.field(f"mode_{mode:03d}_im")

    def points(self, name="modes"):
        """Places of the nodes, a row each."""
        with self.opened(name) as file:
            return file["VTKHDF/Points"][:]

    def cells(self, name="modes"):
        """Nodes of each cell, and the name of its part."""
        with self.opened(name) as file:
            group = file["VTKHDF"]
            ends, nodes = group["Offsets"][:], group["Connectivity"][:]
            parts = [one.decode() for one in group["CellData/part"].attrs["names"]]
            return numpy.split(nodes, ends[1:-1]), [parts[i] for i in group["CellData/part"][:]]

    def picture(self, kind, *words):
        """Draws the folder by scripts/plot/KIND, with further words; the path of the picture."""
        script = ROOT / "scripts/plot" / kind
        if not script.is_file():
            kinds = sorted(path.name for path in script.parent.iterdir() if path.is_file())
            raise Failed(f"{kind}: is no kind of picture; there are {', '.join(kinds)}")
        done = subprocess.run([sys.executable, script, self.folder, *map(str, words)], capture_output=True, text=True, check=False)
        if done.returncode:
            raise Failed(last_line(done.stderr))
        return self.folder / Path(done.stdout.split()[-1]).name

    def opened(self, name):
        """A file of fields."""
        import h5py
        path = self.folder / f"{name}.h5"
        if not path.is_file():
            raise Failed(f"{path}: no such file; -output_fields 0 leaves fields out")
        try:
            return h5py.File(path)
        except OSError as error:
            raise Failed(f"{path}: cannot be read: {error}") from None
