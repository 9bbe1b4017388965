"""A transient that squeal computed: its table, also of a run under way, and its snapshots. Used by
plot/transient."""

import re

import numpy

from ..provenance import Units
from .signal import LEAST, equal_steps
from ..tables import BadInput, regular

NEEDED = ("time_s", "normal_force_n", "friction_force_n")
WORKS = ("external_work_j", "friction_work_j", "contact_work_j", "damping_work_j", "integrator_work_j")
COMPONENTS = {f"{kind}{axis}": f"{kind}{axis}_{unit}" for kind, unit in (("", "m"), ("v", "m_s"), ("a", "m_s2"))
              for axis in "xyz"}
FIRST_CHOICE = "pad"  # probes with this in their name are preferred


def open_table(folder, name="transient.csv"):
    """Path of the table and whether the run is still under way: its temporary name says so."""
    path = folder / name
    part = folder / f"{name}.part"
    if path.exists() or not part.exists():
        return path, False
    return part, True


def read_lines(path, under_way):
    """Lines of the table; the last one of a run under way may be cut off."""
    try:
        text = regular(path).read_text()
    except FileNotFoundError:
        raise BadInput(f"{path}: no such file; run squeal -analysis transient first, or name its -output_dir") from None
    except (OSError, ValueError) as error:
        raise BadInput(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}") from None
    lines = text.splitlines()
    if under_way and lines and not text.endswith("\n"):
        lines.pop()
    if not lines:
        raise BadInput(f"{path}: is empty")
    return lines


def find_fault(path, lines, n_columns):
    """Raises the first line that is no row of numbers."""
    for number, line in enumerate(lines[1:], 2):
        cells = line.split(",")
        if len(cells) != n_columns:
            raise BadInput(f"{path}: line {number} does not have as many columns as the header; was the file cut off?")
        for name, cell in zip(lines[0].split(","), cells):
            try:
                good = numpy.isfinite(float(cell))
            except ValueError:
                good = False
            if not good:
                raise BadInput(f"{path}: line {number}: {name} is '{cell}'")


def read_columns(path, under_way, needed=NEEDED):
    """Columns by name."""
    lines = read_lines(path, under_way)
    names = lines[0].split(",")
    missing = [name for name in needed if name not in names]
    if missing:
        raise BadInput(f"{path}: no column {missing[0]}")
    if len(lines) - 1 < LEAST:
        raise BadInput(f"{path}: has {len(lines) - 1} rows, {LEAST} are needed at least; let the run go on, or choose "
                       "a smaller -dynamics_history_interval")
    try:
        values = numpy.loadtxt(lines[1:], delimiter=",", ndmin=2)
    except ValueError:
        values = None
    if values is None or values.shape[1] != len(names) or not numpy.isfinite(values).all():
        find_fault(path, lines, len(names))
        raise BadInput(f"{path}: cannot be read as a table of numbers")
    return dict(zip(names, values.T))


class Run:
    """The table at equal steps: `time` (s), columns by name, names of the probes, whose motion is in SI."""

    def __init__(self, folder):
        self.path, self.under_way = open_table(folder)
        columns = read_columns(self.path, self.under_way)
        back = numpy.flatnonzero(numpy.diff(columns["time_s"]) <= 0)
        if len(back):
            raise BadInput(f"{self.path}: line {back[0] + 3}: time_s does not increase")
        names = [name for name in columns if name != "time_s"]
        self.time, *values = equal_steps(columns["time_s"], *(columns[name] for name in names))
        self.columns = dict(zip(names, values))
        self.units = Units(folder)
        self.probes = list(dict.fromkeys(
            name[:-len(end) - 1] for name in names for end in COMPONENTS.values() if name.endswith(f"_{end}")))
        self.normal, self.friction = self.columns["normal_force_n"], self.columns["friction_force_n"]

    def choose_probe(self, wanted):
        """Name of the probe to draw; None where the run has none."""
        if wanted and wanted not in self.probes:
            there = f"the table has {', '.join(self.probes)}" if self.probes else "the run had no -probes"
            raise BadInput(f"--probe {wanted}: no such probe; {there}")
        preferred = [name for name in self.probes if FIRST_CHOICE in name]
        return wanted or next(iter(preferred + self.probes), None)

    def probe(self, name, quantity):
        """A column of a probe: ay is its acceleration in y."""
        column = f"{name}_{COMPONENTS[quantity]}"
        if column not in self.columns:
            raise BadInput(f"{self.path}: no column {column}")
        return self.units.factor(COMPONENTS[quantity][len(quantity) + 1:]) * self.columns[column]

    def acceleration(self, name, component):
        """Mean acceleration from the row before to the row after, by the velocities: the blow that stops a single node
        lasts one step and would fill the spectrum of the samples."""
        return numpy.gradient(self.probe(name, f"v{component}"), self.time[1] - self.time[0])

    def status(self):
        """Numbers of open, sticking and sliding pairs; None where the table does not have them."""
        if any(name not in self.columns for name in ("n_closed", "n_stick")):
            return None
        closed, stick = self.columns["n_closed"], self.columns["n_stick"]
        is_open = self.columns.get("n_open", closed.max() - closed)
        return is_open, stick, closed - stick

    def ledger_error(self):
        """|energy error| relative to all energy that has been turned over; None where the table does not have it."""
        if "energy_error_j" not in self.columns:
            return None
        stored = [self.columns[name] for name in ("kinetic_j", "strain_j") if name in self.columns]
        turned = sum(abs(self.columns[name]) for name in WORKS if name in self.columns) + sum(map(abs, stored))
        turned = numpy.maximum.accumulate(numpy.broadcast_to(turned, self.time.shape))
        return abs(self.columns["energy_error_j"]) / numpy.maximum(turned, 1e-300)

    def start(self):
        """Time at which the smoothed normal force no longer rises after it has come near its later mean: the ramp is
        over, s."""
        n = max(len(self.time) // 50, 1)
        later = self.normal[len(self.normal) // 2:].mean()
        smooth = numpy.convolve(self.normal, numpy.ones(n) / n, "valid")
        near = (smooth[:-n] >= 0.8 * later) & (smooth[n:] <= 1.003 * smooth[:-n])
        if later <= 0 or near[0] or not near.any():
            return self.time[0]
        return self.time[near.argmax() + n - 1]


def snapshot_times(folder):
    """Times (s) of the snapshots by file, from the XDMF text; it may be unfinished."""
    for name in ("transient.xmf", "transient.xmf.part"):
        try:
            text = regular(folder / name).read_text(errors="replace")
        except OSError:
            continue
        times, now = {}, None
        for time, file in re.findall(r'<Time Value="([^"]*)"|>\s*([^<>:]*\.h5):', text):
            try:
                now = float(time) if time else now
            except ValueError:
                now = None
            if file and now is not None:
                times.setdefault(file, now)
        return times
    return {}


def snapshots(folder):
    """(time or None, path) of the snapshots in their order."""
    times = snapshot_times(folder)
    found = [(times.get(path.name), path) for path in sorted(folder.glob("snapshot_*.h5"))]
    known = [pair for pair in found if pair[0] is not None]
    return sorted(known) if len(known) == len(found) else found
