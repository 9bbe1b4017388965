"""A scene with other parameters: its modes beside the measured ones, with exact derivatives by left and right vectors
(modes_sensitivities.csv)."""

import math
from dataclasses import dataclass

import numpy

from .solve import Predicted
from ..correlate.correlation import correlate_modes
from ..provenance import Provenance
from ..run.program import measured_run
from ..tables import BadInput, read_table

SENSITIVITIES = {"mode": int, "parameter": str, "value": float, "unit": str, "freq_hz_per_percent": float,
                 "growth_rad_s_per_percent": float}
MODES = {"mode": int, "freq_hz": float, "growth_rad_s": float, "damping_ratio": float}


@dataclass
class Beside:
    """What a set of parameters gives: the correlation, and measured and computed value, standard deviation of each datum."""
    to: object
    data: list


class Model:
    """args: of scripts/update; parameters by name with their start."""

    def __init__(self, args, measured):
        self.args, self.measured, self.start, self.units, self.own = args, measured, {}, {}, {}
        self.runs, self.seconds, self.chosen = 0, 0.0, None

    def values(self, t):
        """Parameters by name."""
        return {name: start * math.exp(x) for (name, start), x in zip(self.start.items(), t)}

    def texts(self, values):
        """Values as options have them: of a list all numbers are scaled alike."""
        return {name: ",".join(f"{float(word) * (values[name] / own):.15g}" for word in words)
                for name, (own, words) in self.own.items() if name in values}

    def run(self, values, also=("-modes_sensitivities", "true"), name="run"):
        """A run with these parameters; the folder."""
        folder = self.args.output / name
        words = [word for file in self.args.scenes for word in ("-options_file", file)] + list(self.args.options)
        words += [word for name, text in self.texts(values).items() for word in (f"-{name}", text)]
        _, seconds, _ = measured_run(self.args.program, self.args.ranks, [*words, *also, "-output_dir", folder],
                                     ", ".join(f"{name} {value:.6g}" for name, value in values.items()) or "the scene as it is")
        self.runs, self.seconds = self.runs + 1, self.seconds + seconds
        return folder

    def begin(self):
        """Finds the start of each parameter in a run of the scene as it is."""
        folder = self.run({})
        rows = read_table(folder / "modes_sensitivities.csv", SENSITIVITIES)
        self.start, self.units = ({row["parameter"]: row[key] for row in rows} for key in ("value", "unit"))
        for name in self.args.parameters:
            if name not in self.start:
                raise BadInput(f"--parameters {name}: is none of this scene that modes depend on; there are {', '.join(self.start)}")
            if not self.start[name] > 0:
                raise BadInput(f"--parameters {name}: starts at {self.start[name]:g}; parameters must be above 0, give it a start in the "
                               f"scene")
        scene = Provenance(folder / "scene.yaml")
        self.own = {name: (self.start[name], scene.value(name).split(",")) for name in self.args.parameters}
        self.start = {name: self.args.began.get(name, self.start[name]) for name in self.args.parameters}
        return folder

    def predict(self, t):
        """Predicted of the parameters start * exp(t)."""
        try:
            folder = self.run(self.values(t))
        except BadInput as error:
            if self.chosen is None:
                raise
            print(f"note: a step is halved, since squeal refuses its end: {error}")
            return None
        self.args.folder, self.args.matrices = folder, None
        to = correlate_modes(self.measured, self.args)
        self.measured_again()
        slopes = {(row["mode"], row["parameter"]): row for row in read_table(folder / "modes_sensitivities.csv", SENSITIVITIES)}
        modes = {row["mode"]: row for row in read_table(folder / "modes.csv", MODES)}
        pairs = sorted((pair.measured, to.rows[pair.computed]["mode"]) for pair in to.pairs)
        if self.chosen is None:
            self.chosen = [i for i, _ in pairs]
            self.check()
        if not set(self.chosen) <= {i for i, _ in pairs}:
            return None  # another number of data has another chi^2
        data, slope = [], []
        for i, mode in pairs:
            if i in self.chosen:
                self.add(data, slope, self.measured.modes[i], modes[mode], [slopes[mode, name] for name in self.start])
        residual = numpy.array([(one[2] - one[3]) / one[4] for one in data])
        return Predicted(residual, numpy.array(slope) / numpy.array([one[4] for one in data])[:, None], Beside(to, data))

    def measured_again(self):
        """Axes of the test are moved once."""
        self.args.points = self.args.transform = None

    def check(self):
        """Whether there is something to go by."""
        if not self.chosen:
            raise BadInput("no measured mode has a computed one beside it: scripts/correlate shows why; --near and --least allow more")

    def add(self, data, slope, measured, row, rows):
        """The data of one mode: quantity, measured mode, ln of both frequencies or both damping ratios, standard deviation, numbers."""
        data.append(("frequency", measured.name, math.log(measured.freq), math.log(row["freq_hz"]), self.args.noise, row["mode"]))
        slope.append([100 * one["freq_hz_per_percent"] / row["freq_hz"] for one in rows])
        if self.args.damping and math.isfinite(measured.damping):
            size = math.hypot(row["growth_rad_s"], 2 * math.pi * row["freq_hz"])
            cosine, sine = row["growth_rad_s"] / size, 2 * math.pi * row["freq_hz"] / size
            data.append(("damping", measured.name, measured.damping, row["damping_ratio"], self.args.damping * abs(measured.damping),
                         row["mode"]))
            slope.append([-100 * sine / size * (sine * one["growth_rad_s_per_percent"] - cosine * 2 * math.pi * one["freq_hz_per_percent"])
                          for one in rows])
