"""Tables of a frequency response: frf.csv and peaks.csv."""

import numpy

from ..provenance import Units
from ..tables import BadInput, header, optional, read_table

END = "_re_m_n"
ERRORS = ("error_m_n", "error_relative")
PEAKS = {"freq_hz": float, "magnitude_m_n": float, "mode": int, "mode_freq_hz": optional, "damping_ratio": optional,
         "label": str}


class Responses:
    """`freq` (Hz), complex receptance (m/N) by output, `error` and `relative` of all together (None where the table
    does not have them), `coherence` by output where it was measured, `peaks`: rows."""

    def __init__(self, folder):
        path = folder / "frf.csv"
        there = header(path)
        names = [name.removesuffix(END) for name in there if name.endswith(END)]
        errors = [name for name in ERRORS if name in there]
        measured = [name for name in names if f"{name}_coherence" in there]
        columns = ["freq_hz", *(f"{name}_coherence" for name in measured),
                   *(f"{name}_{part}_m_n" for name in names for part in ("re", "im")), *errors]
        rows = read_table(path, dict.fromkeys(columns, float))
        if not rows or not names:
            raise BadInput(f"{path}: has no {'rows' if names else 'column that ends in ' + END}")
        scale = Units(folder).factor("m_n")
        value = {name: (scale if name.endswith("_m_n") else 1) * numpy.array([row[name] for row in rows]) for name in columns}
        self.freq = value["freq_hz"]
        self.outputs = {name: value[f"{name}_re_m_n"] + 1j * value[f"{name}_im_m_n"] for name in names}
        self.coherence = {name: value[f"{name}_coherence"] for name in measured}
        self.error, self.relative = (value.get(name) for name in ERRORS)
        peaks = folder / "peaks.csv"
        self.peaks = read_table(peaks, PEAKS) if peaks.exists() else []
        for row in self.peaks:
            row["magnitude_m_n"] *= scale

    def strongest(self, n):
        """Names of the n outputs of the largest magnitude, in their order."""
        by_size = sorted(self.outputs, key=lambda name: -abs(self.outputs[name]).max())[:n]
        return [name for name in self.outputs if name in by_size]
