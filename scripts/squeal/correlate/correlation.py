"""The whole correlation of measured modes with those of a result folder."""

from dataclasses import dataclass, field

import numpy

from . import criteria
from .masses import Masses
from .place import Surface, best_turn, rotation
from ..mesh.bodies import Scene, opened, sound
from ..provenance import Provenance
from ..tables import BadInput, header, read_table

KINDS = {"mode": int, "freq_hz": float, "damping_ratio": float, "label": str}
TOLERANCE = 0.02  # of the largest extent of the mesh


@dataclass
class Pair:
    """A measured mode and the computed one beside it, by their numbers in the lists; nan where a number is not known."""
    measured: int
    computed: int
    mac: float = numpy.nan
    share: float = numpy.nan
    cross: float = numpy.nan
    residual: float = numpy.nan


@dataclass
class Correlation:
    """Modes as measured, rows of modes.csv, sensors on the mesh, pairs; matrices by name, shapes at the sensors; `said`: lines."""
    measured: object
    rows: list
    found: list = field(default_factory=list)
    pairs: list = field(default_factory=list)
    matrices: dict = field(default_factory=dict)
    computed: numpy.ndarray | None = None
    serep: object = None
    tolerance: float = 0.0
    said: list = field(default_factory=list)


def placed(measured, args):
    """Puts the sensors into the axes of the mesh; returns what is to be said of it."""
    if args.points:
        absent = [name for name in args.points if name not in measured.points]
        if absent:
            raise BadInput(f"--points {absent[0]}: no such point in the measured data; there are {', '.join(list(measured.points)[:8])}")
        test = numpy.array([measured.points[name] for name in args.points])
        turn, shift, left = best_turn(test, numpy.array(list(args.points.values())))
        worst = list(args.points)[int(left.argmax())]
        if left.max() > args.tolerance:
            raise BadInput(f"--points: point {worst} is {1e3 * left.max():.4g} mm off after the best turn and shift, --tolerance is "
                           f"{1e3 * args.tolerance:.4g} mm; are the units right (--units)?")
        said = [f"{len(left)} points fix the axes, {1e3 * numpy.sqrt((left**2).mean()):.3g} mm off on average, at most "
                f"{1e3 * left.max():.3g} mm ({worst})"]
    elif args.transform is not None:
        turn, shift, said = rotation(args.transform[3:]), args.transform[:3], []
    else:
        return []
    measured.moved(turn, shift)
    return said


class Folder:
    """Modes of a result folder: rows, and shapes [nodes][3] by number in their units."""

    def __init__(self, folder, file):
        there = header(folder / "modes.csv")
        kinds = {name: kind for name, kind in KINDS.items() if name in there or name in ("mode", "freq_hz")}
        self.rows = read_table(folder / "modes.csv", kinds)
        if not self.rows:
            raise BadInput(f"{folder / 'modes.csv'}: has no mode")
        self.file, self.scene = file, None
        if file:
            self.scene = Scene(file, Provenance(folder / "scene.yaml").value("modes_disc", "disc"))

    def shape(self, mode):
        """Displacements of a mode, real where it has no imaginary part."""
        data, key = self.file["VTKHDF/PointData"], f"mode_{mode:03d}"
        if f"{key}_re" not in data:
            raise BadInput(f"{self.file.filename}: no shape of mode {mode}; was the file made by another run than modes.csv?")
        re, im = (sound(self.file.filename, f"{key}_{part}", data[f"{key}_{part}"][:]) for part in ("re", "im"))
        return re + 1j * im if im.any() else re


def by_frequency(to, args):
    """Pairs of modes without shapes."""
    freq, other = numbers(to)
    likeness = numpy.ones((len(other), len(freq)))
    to.pairs = [Pair(i, k) for i, k in criteria.assign(likeness, likeness, other, freq, (args.near, 0))]
    to.said.append("no measured shapes: modes are paired by frequency alone, which may pair the wrong ones")


def numbers(to):
    """Frequencies of both."""
    return numpy.array([row["freq_hz"] for row in to.rows]), numpy.array([mode.freq for mode in to.measured.modes])


def by_shape(to, folder, args):
    """MAC, cross-orthogonality, pairs, expansion."""
    measured, (freq, other) = to.measured.shapes(), numbers(to)
    whole = [folder.shape(row["mode"]) for row in to.rows] if args.matrices else None
    to.computed = numpy.array([[sensor.moves(shape) for sensor in to.found] for shape in (folder.shape(row["mode"]) for row in to.rows)]).T
    still = numpy.flatnonzero(abs(to.computed).max(axis=0) == 0)
    if len(still):
        to.said.append(f"modes {', '.join(str(to.rows[k]['mode']) for k in still)} do not move any sensor")
    gram, masses = numpy.eye(len(to.rows)), None
    if args.matrices:
        by_mode = {row["mode"]: shape for row, shape in zip(to.rows, whole)}
        masses = Masses(args.matrices, by_mode.__getitem__, list(by_mode))
        gram = masses.gram
    to.serep = criteria.Serep(to.computed, freq, other, gram)
    groups = criteria.groups_of(freq, args.group)
    shares, residuals, cross = criteria.shares(measured, to.computed, groups), to.serep.residual(measured), to.serep.cross(measured)
    to.matrices = {"mac": criteria.mac(measured, to.computed), "auto_measured": criteria.mac(measured, measured),
                   "auto_computed": criteria.mac(to.computed, to.computed), "cross_serep": numpy.full(shares.shape, numpy.nan)}
    to.matrices["cross_serep"][:, to.serep.chosen] = cross
    if masses:
        lowest = 2 * numpy.pi * min((one for one in freq if one > 1), default=1.0)
        to.matrices["cross_guyan"] = criteria.cross_by_mass(measured, to.computed, masses.guyan(to.found, lowest))
    for i, k in criteria.assign(shares, to.matrices["mac"], other, freq, (args.near, args.least)):
        to.pairs.append(Pair(i, k, to.matrices["mac"][i, k], shares[i, k], to.matrices["cross_serep"][i, k], residuals[i]))
    say_of_shapes(to, measured, args)


def say_of_shapes(to, measured, args):
    """What an engineer should know of the matrices."""
    auto = numpy.triu(to.matrices["auto_computed"], 1)
    alike = [(auto[i, k], i, k) for i, k in zip(*numpy.nonzero(auto > args.alike))]
    for value, i, k in sorted(alike, reverse=True)[:5]:
        to.said.append(f"the sensors hardly tell modes {to.rows[i]['mode']} and {to.rows[k]['mode']} apart: auto-MAC {value:.3f}")
    if len(alike) > 5:
        to.said.append(f"and {len(alike) - 5} more pairs of modes with an auto-MAC above {args.alike:g}")
    if not args.matrices and any(numpy.iscomplexobj(to.computed[:, k]) and abs(to.computed[:, k].imag).any() for k in to.serep.chosen):
        to.said.append("cross-orthogonality takes the modes as orthogonal in M, which complex ones are not quite: --matrices has it exact")
    if numpy.iscomplexobj(measured) and to.pairs:
        turned = criteria.mac(measured.conj(), to.computed)
        gain = numpy.mean([turned[pair.measured, pair.computed] - pair.mac for pair in to.pairs])
        if gain > 0.1:
            to.said.append(f"conjugate shapes agree better (MAC higher by {gain:.2f} on average): does the test write exp(-i omega t)?")


def correlate_modes(measured, args):
    """The Correlation of all measured modes; without shapes by frequency."""
    fields = args.folder / "modes.h5"
    if not fields.is_file():
        if measured.shapes() is not None:
            raise BadInput(f"{fields}: no such file, which holds the shapes; -output_fields 0 leaves them out")
        to = Correlation(measured, Folder(args.folder, None).rows)
        by_frequency(to, args)
        return to
    with opened(fields) as file:
        folder = Folder(args.folder, file)
        surface, to = Surface(folder.scene, args.parts), Correlation(measured, folder.rows)
        args.tolerance = to.tolerance = TOLERANCE * surface.extent if args.tolerance is None else args.tolerance
        to.said += placed(measured, args)
        if measured.shapes() is None:
            by_frequency(to, args)
        else:
            to.found = surface.find_all(measured.channels, to.tolerance)
            by_shape(to, folder, args)
        return to


def expanded(to, folder):
    """Measured shapes of the pairs at all nodes, in phase with the computed ones and as large at the sensors: a pair, [nodes][3]."""
    q = to.serep.coordinates(to.measured.shapes())
    for pair in to.pairs:
        whole = sum(q[i, pair.measured] * folder.shape(to.rows[k]["mode"]) for i, k in enumerate(to.serep.chosen))
        a, b = to.measured.shapes()[:, pair.measured], to.computed[:, pair.computed]
        yield pair, whole * (numpy.vdot(a, b) / max(numpy.vdot(a, a).real, 1e-300))
