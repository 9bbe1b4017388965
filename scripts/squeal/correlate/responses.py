"""Measured responses beside those of -analysis frf. FRAC = |sum H_m^* H_c|^2 / (sum |H_m|^2 sum |H_c|^2) over the frequencies that both
have, 1 where one is a multiple of the other; the level is the mean of 20 log10 |H_c| / |H_m|. The finer of both is interpolated at the
frequencies of the other."""

from typing import NamedTuple

import numpy

from ..provenance import Provenance
from ..response.frf_tables import Responses
from ..tables import BadInput

LEAST = 3  # frequencies
ALONG = 0.98  # cosine between the directions of two forces that are one
SMALL = 0.02  # part of a direction that is left out
AXES = "xyz"


class Compared(NamedTuple):
    """A measured response and its output: frequencies, FRAC, level in dB."""
    response: object
    output: str
    distance: float
    freq: numpy.ndarray
    measured: numpy.ndarray
    computed: numpy.ndarray
    frac: float
    level: float


def vector(text):
    """x,y,z or one of the letters."""
    if text in AXES:
        return numpy.eye(3)[AXES.index(text)]
    try:
        found = numpy.array([float(word) for word in text.split(",")])
    except ValueError:
        found = numpy.zeros(0)
    return found if len(found) == 3 else None


class Outputs:
    """Responses of a folder, with the places of the probes."""

    def __init__(self, folder, tolerance):
        self.table, self.tolerance = Responses(folder), tolerance
        scene = Provenance(folder / "scene.yaml")
        self.places = {}
        for name in scene.names("probes"):
            place = vector(scene.value(f"{name}_at"))
            if place is not None:
                self.places[name] = scene.si("m") * place
        probe, _, along = scene.value("frf_force").partition(",")
        direction = vector(along)
        self.force = None if direction is None or probe not in self.places else (self.places[probe],
                                                                                 direction / numpy.linalg.norm(direction))

    def same_force(self, response):
        """1 or -1 as the measured force acts, None where it is another one; that of a table is that of the run."""
        if not response.force or not self.force:
            return 1.0
        cosine = float(self.force[1] @ response.force.direction)
        near = numpy.linalg.norm(self.force[0] - response.force.place) <= self.tolerance
        return numpy.sign(cosine) if near and abs(cosine) >= ALONG else None

    def output(self, response):
        """Values, name and distance of the output at the channel of a response, by name, else by place; None where there is none."""
        if response.name in self.table.outputs:
            return self.table.outputs[response.name], response.name, 0.0
        channel = response.channel
        if not channel or not self.places:
            return None
        probe = min(self.places, key=lambda name: numpy.linalg.norm(self.places[name] - channel.place))
        apart = float(numpy.linalg.norm(self.places[probe] - channel.place))
        axes = [k for k in range(3) if abs(channel.direction[k]) > SMALL]
        names = [f"{probe}_{AXES[k]}" for k in axes]
        if apart > self.tolerance or any(name not in self.table.outputs for name in names):
            return None
        return sum(channel.direction[k] * self.table.outputs[name] for k, name in zip(axes, names)), "+".join(names), apart

    def compare(self, response):
        """The Compared of a response, or why there is none."""
        sign, found = self.same_force(response), self.output(response)
        if sign is None:
            return "the run has its force at another place or along another direction"
        if found is None:
            return "no output of frf.csv has its name or place and direction"
        freq, measured, computed = together(response.freq, response.values, self.table.freq, sign * found[0])
        if len(freq) < LEAST:
            return (f"has {len(freq)} frequencies among those of frf.csv, {self.table.freq[0]:g} to {self.table.freq[-1]:g} Hz; {LEAST} "
                    f"are needed")
        both = abs(measured) * abs(computed) > 0
        sizes = (abs(measured)**2).sum() * (abs(computed)**2).sum()
        frac = abs(numpy.vdot(measured, computed))**2 / sizes if sizes else numpy.nan
        level = 20 * numpy.log10(abs(computed[both]) / abs(measured[both])).mean() if both.any() else numpy.nan
        return Compared(response, found[1], found[2], freq, measured, computed, float(frac), float(level))


def together(freq_a, a, freq_b, b):
    """Both at the frequencies of the coarser one, as far as the other reaches."""
    low, high = max(freq_a[0], freq_b[0]), min(freq_a[-1], freq_b[-1])
    inside_a, inside_b = (freq_a >= low) & (freq_a <= high), (freq_b >= low) & (freq_b <= high)
    if inside_a.sum() <= inside_b.sum():
        freq = freq_a[inside_a]
        return freq, a[inside_a], numpy.interp(freq, freq_b, b)
    freq = freq_b[inside_b]
    return freq, numpy.interp(freq, freq_a, a), b[inside_b]


def compare_all(responses, folder, tolerance):
    """All that can be compared, and a line for each other one."""
    if not (folder / "frf.csv").is_file():
        raise BadInput(f"{folder}: has no frf.csv beside which {len(responses)} measured responses could stand: run -analysis frf")
    outputs, compared, said = Outputs(folder, tolerance), [], []
    for response in responses:
        found = outputs.compare(response)
        if isinstance(found, str):
            said.append(f"response {response.name}: {found}: left out")
        else:
            compared.append(found)
    if not compared:
        raise BadInput(f"none of {len(responses)} measured responses can be compared; {said[0]}")
    return compared, said
