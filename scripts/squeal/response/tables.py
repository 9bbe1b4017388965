"""What scripts/response writes and prints: frf.csv, peaks.csv, operating_shapes.csv, response.txt, peaks_modes.csv."""

import numpy

from ..mesh.bodies import Scene, opened
from .record import write_rows
from ..transient.signal import interval
from ..tables import BadInput, print_table, read_table, whole

PEAKS = ("freq_hz", "magnitude_m_n", "mode", "mode_freq_hz", "damping_ratio", "label")
MODES = {"mode": int, "freq_hz": float, "growth_rad_s": float, "damping_ratio": float, "label": str}
COMPARED = ("freq_hz", "damping_ratio", "label", "mode", "mode_freq_hz", "mode_damping_ratio", "mode_label", "mac")
NEAR = 0.02  # relative difference of frequency at which a mode may be that of a peak
SAME = 1e-6  # m, or of the largest coordinate: places of one node


def describe(response):
    """How it was done, in lines."""
    record, freq = response.record, response.freq
    blow, step, length = record.blow, interval(record.time), record.time[-1]
    along = ", ".join(f"{x:.6g}" for x in blow.direction)
    place = ", ".join(f"{x:.6g}" for x in blow.place)
    return [f"response to 1 N on the node at {place} m along {along}, from the impulse {blow.name} of "
            f"{blow.momentum:.6g} N s at {blow.time:.6g} s; {len(record.names)} outputs",
            *record.words,
            f"{len(record.time)} rows, each {step:.6g} s; {response.window.words}",
            f"{len(freq)} frequencies from {freq[0]:.6g} to {freq[-1]:.6g} Hz, each {freq[1] - freq[0]:.6g} Hz: "
            f"the record, which alone tells {1 / length:.6g} Hz apart, is continued by zeros",
            "largest estimated relative error at a peak "
            f"{max(numpy.interp(p.freq, freq, response.error / response.magnitude) for p in response.peaks):.1e}"]


def write_all(response, folder, words):
    """The tables of one response."""
    names, values = response.record.names, response.values
    header = ["freq_hz", *(f"{name}_{part}_m_n" for name in names for part in ("re", "im")), "error_m_n",
              "error_relative"]
    numbers = numpy.column_stack([response.freq, values.view(float).reshape(len(values), -1), response.error,
                                  response.error / response.magnitude])
    with whole(folder / "frf.csv") as part:
        numpy.savetxt(part, numbers, fmt="%.15g", delimiter=",", header=",".join(header), comments="")
    write_rows(folder / "peaks.csv", PEAKS, [
        (float(p.freq), float(p.magnitude), k + 1, float(p.mode.freq), float(p.mode.damping), p.label)
        for k, p in enumerate(response.peaks)])
    write_shapes(response, folder / "operating_shapes.csv")
    (folder / "peaks_modes.csv").unlink(missing_ok=True)  # of other peaks
    with whole(folder / "response.txt") as part:
        part.write_text("\n".join(words) + "\n", encoding="utf-8")


def write_shapes(response, path):
    """Residues of the peaks at the nodes of the circles, relative to the largest, which is real."""
    chosen = [k for k, name in enumerate(response.record.names) if name in response.record.nodes]
    shapes = []
    for peak in response.peaks if chosen else []:
        shape = peak.mode.residue[chosen]
        shapes.append(shape / shape[abs(shape).argmax()])
    rows = []
    for i, k in enumerate(chosen):
        node = response.record.nodes[response.record.names[k]]
        parts = [float(part) for shape in shapes for part in (shape[i].real, shape[i].imag)]
        rows.append((node["node"], *(node[name] for name in ("x_m", "y_m", "z_m", "radius_m", "angle_rad")), *parts))
    write_rows(path, ["node", "x_m", "y_m", "z_m", "radius_m", "angle_rad",
                      *(f"peak_{k + 1}_{part}" for k in range(len(shapes)) for part in ("re", "im"))], rows)


def print_peaks(response):
    """Peaks for people."""
    print_table("peaks", ("label", "peak Hz", "m/N", "mode Hz", "damping %"),
                *((p.label or "-", f"{p.freq:.1f}", f"{p.magnitude:.2e}", f"{p.mode.freq:.3f}",
                   f"{100 * p.mode.damping:.5f}") for p in response.peaks))


def mode_shapes(response, folder, rows):
    """Shapes of modes at the nodes of the circles, along their axis, by mode."""
    nodes = [(k, response.record.nodes[name]) for k, name in enumerate(response.record.names)
             if name in response.record.nodes]
    if not nodes:
        raise BadInput(f"--modes {folder}: shapes cannot be compared, the transient has no -circles")
    place = numpy.array([[node[f"{axis}_m"] for axis in "xyz"] for _, node in nodes])
    with opened(folder / "modes.h5") as file:
        scene = Scene(file, "disc")
        at = numpy.array([((scene.points - x)**2).sum(axis=1).argmin() for x in place])
        apart = abs(scene.points[at] - place).max()
        if apart > SAME * max(1, abs(place).max()):
            raise BadInput(f"--modes {folder}: its mesh has no node at one of the circles', {apart:.3g} m away; both "
                           "runs need the same mesh")
        axes = ["xyz".index(node["axis"]) for _, node in nodes]
        return [k for k, _ in nodes], {row["mode"]: scene.shape(row["mode"])[at, axes] for row in rows}


def mac(a, b):
    """Modal assurance criterion |a'b|^2 / (a'a b'b)."""
    return float(abs(numpy.vdot(a, b))**2 / max((numpy.vdot(a, a) * numpy.vdot(b, b)).real, 1e-300))


def compare_modes(response, folder, output):
    """Each peak beside the mode that is nearest by shape among those near in frequency; prints and writes."""
    low, high = response.freq[0], response.freq[-1]
    rows = [row for row in read_table(folder / "modes.csv", MODES) if low / 2 <= row["freq_hz"] <= 2 * high]
    chosen, shapes = mode_shapes(response, folder, rows)
    table = []
    for peak in response.peaks:
        near = [(mac(peak.mode.residue[chosen], shapes[row["mode"]]), row) for row in rows
                if abs(row["freq_hz"] / peak.mode.freq - 1) < NEAR]
        if near:
            value, row = max(near, key=lambda pair: pair[0])
            table.append((float(peak.mode.freq), float(peak.mode.damping), peak.label, row["mode"], row["freq_hz"],
                          row["damping_ratio"], row["label"], value))
    write_rows(output / "peaks_modes.csv", COMPARED, table)
    print_table(f"beside the modes of {folder}",
                ("label", "Hz", "mode Hz", "%", "damping %", "mode %", "MAC", "mode's"),
                *((row[2], f"{row[0]:.2f}", f"{row[4]:.2f}", f"{100 * (row[0] / row[4] - 1):+.4f}",
                   f"{100 * row[1]:.4f}", f"{100 * row[5]:.4f}", f"{row[7]:.5f}", row[6]) for row in table))
