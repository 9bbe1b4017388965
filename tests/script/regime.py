#!/usr/bin/env python3
"""What scripts/plot/transient calls a vibration, on made-up signals: one that dies out within 3 ms is not steady, whatever
lines beat in it, and has no harmonics; one of constant amplitude is, and has them; what grows to a bound is a limit cycle
only where it repeats itself; a few periods tell nothing. And that scripts/paper takes only what decays for the stable brake
of the paper, whose vibration decreases. Breaks when a word, the harmonics or the verdict say more than the data allow."""

import sys
from pathlib import Path
from types import SimpleNamespace

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
from squeal.paper.claims import stable_claims
from squeal.transient.cycle import Vibration, vibration_quantities


def vibration(length, envelope):
    time = numpy.arange(0, length, 2e-6)
    carrier = sum(numpy.sin(2 * numpy.pi * freq * time + freq) for freq in (9e3, 10.1e3, 11.3e3, 12.2e3))
    return Vibration(time, envelope(time) * carrier, 0.0)


def bounded(length, envelope):
    """A line with noise about it, whose phase wanders: it is never twice the same."""
    time = numpy.arange(0, length, 2e-6)
    draw = numpy.random.default_rng(1)
    turn = numpy.cumsum(draw.normal(size=len(time))) * 0.02
    return Vibration(time, envelope(time) * numpy.sin(2 * numpy.pi * 1e4 * time + turn), 0.0)


def saturates(time):
    return 1e-3 * numpy.exp(numpy.minimum(1200 * time, 7))


def line(length, envelope):
    time = numpy.arange(0, length, 2e-6)
    wave = numpy.sin(2 * numpy.pi * 1e4 * time) + 0.1 * numpy.sin(4 * numpy.pi * 1e4 * time)
    return Vibration(time, envelope(time) * wave, 0.0)


CASES = {
    "3 ms, four lines that beat and die out": (vibration(3e-3, lambda t: 1 / (1 + (t / 4e-4)**2)), {"decays"}, False),
    "3 ms, one line that dies out by a power": (line(3e-3, lambda t: 1 / (1 + (t / 3e-4)**2)), {"decays"}, False),
    "3 ms, four lines that grow": (vibration(3e-3, lambda t: 1 + (t / 4e-4)**2), {"grows"}, False),
    "3 ms, one line in bursts that die out": (
        line(3e-3, lambda t: (1 - t / 4e-3) * (1.2 + numpy.sin(4e4 * t**0.9))), {"decays"}, False),
    "3 ms, one line that falls in two steps": (
        line(3e-3, lambda t: 0.2 + 0.4 * (t < 1.9e-3) + 0.4 * (t < 8e-4)), {"decays"}, False),
    "20 ms of constant amplitude": (line(2e-2, lambda t: 1.0), {"steady"}, True),
    "20 ms, grows into a line and its harmonic": (line(2e-2, saturates), {"limit cycle"}, True),
    "20 ms, grows into a line that wanders": (bounded(2e-2, saturates), {"bounded vibration"}, True),
    "1 ms": (line(1e-3, lambda t: 1.0), {"too short to tell"}, False),
    "20 ms, exponential decay": (line(2e-2, lambda t: numpy.exp(-200 * t)), {"decays"}, False),
}


def main():
    faults = 0
    for name, (found, words, has_harmonics) in CASES.items():
        harmonics = [q.name for q in vibration_quantities(found, "m/s^2") if q.name.startswith("harmonic_")]
        good = found.regime() in words and bool(harmonics) == has_harmonics
        print("ok  " if good else "FAIL", f"{name}: {found.regime()}, {len(harmonics)} harmonics")
        faults += not good
        record = SimpleNamespace(vibration=found, run=SimpleNamespace(normal=numpy.full(len(found.time), 100.0)))
        verdict = next(stable_claims(record)).kept
        print("ok  " if verdict == (words == {"decays"}) else "FAIL", f"  decreases as in the paper: {verdict}")
        faults += verdict != (words == {"decays"})
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
