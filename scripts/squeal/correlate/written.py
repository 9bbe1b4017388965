"""What scripts/correlate writes and prints: correlate.csv, mac.csv, sensors.csv, responses.csv, expanded.h5."""

import math

import numpy

from .correlation import Folder, expanded
from .criteria import collinearity
from ..export.states import State, read_grid
from ..export.vtu import write_vtu
from ..mesh.bodies import opened
from ..response.record import write_rows
from ..tables import print_table, whole

PAIRS = ("measured", "mode", "label", "measured_freq_hz", "freq_hz", "freq_difference_percent", "measured_damping_ratio", "damping_ratio",
         "damping_difference_percent", "mac", "mac_group", "cross_orthogonality", "expansion_residual", "measured_collinearity",
         "collinearity")
SENSORS = ("sensor", "x_m", "y_m", "z_m", "direction_x", "direction_y", "direction_z", "on_x_m", "on_y_m", "on_z_m", "part", "distance_m",
           "angle_deg")
RESPONSES = ("response", "output", "distance_m", "low_hz", "high_hz", "n_frequencies", "frac", "level_db")


def blank(value):
    """A number, or nothing."""
    return float(value) if math.isfinite(value) else ""


def percent(computed, measured):
    """Computed beside measured."""
    return 100 * (computed / measured - 1) if measured else math.nan


def pair_row(to, mode, pair, along):
    """A row of correlate.csv: a measured mode, and what stands beside it."""
    row = to.rows[pair.computed] if pair else None
    if not pair:
        return (mode.name, "", "", mode.freq, "", "", blank(mode.damping), *7 * [""], "")
    damping = row.get("damping_ratio", math.nan)
    return (mode.name, row["mode"], row.get("label", ""), mode.freq, row["freq_hz"], blank(percent(row["freq_hz"], mode.freq)),
            blank(mode.damping), blank(damping), blank(percent(damping, mode.damping)),
            *(blank(x) for x in (pair.mac, pair.share, pair.cross, pair.residual)),
            *(blank(one[k]) if one is not None else "" for one, k in zip(along, (pair.measured, pair.computed))))


def pair_rows(to):
    """Rows of correlate.csv: all measured modes, then modes in their band that have no measured one."""
    along = [collinearity(a) if a is not None else None for a in (to.measured.shapes(), to.computed)]
    pairs = {pair.measured: pair for pair in to.pairs}
    return [pair_row(to, mode, pairs.get(i), along) for i, mode in enumerate(to.measured.modes)] + [
        ("", row["mode"], row.get("label", ""), "", row["freq_hz"], "", "", blank(row.get("damping_ratio", math.nan)), *6 * [""], "")
        for row in alone(to)]


def alone(to):
    """Computed modes between the lowest and the highest measured frequency that have no measured one."""
    paired, freq = {pair.computed for pair in to.pairs}, [mode.freq for mode in to.measured.modes]
    return [row for k, row in enumerate(to.rows) if k not in paired and min(freq) <= row["freq_hz"] <= max(freq)]


def matrix_rows(to):
    """Rows of mac.csv."""
    measured, modes = [mode.name for mode in to.measured.modes], [row["mode"] for row in to.rows]
    of = {"auto_measured": (measured, measured), "auto_computed": (modes, modes)}
    for name, matrix in to.matrices.items():
        rows, columns = of.get(name, (measured, modes))
        yield from ((name, row, column, blank(matrix[i, k])) for i, row in enumerate(rows) for k, column in enumerate(columns))


def write_tables(to, output):
    """The tables of modes; returns their names."""
    output.mkdir(parents=True, exist_ok=True)
    for name in ("correlate.csv", "mac.csv", "sensors.csv", "responses.csv", "expanded.h5", "correlate.png", "shapes.png"):
        (output / name).unlink(missing_ok=True)  # of an earlier comparison
    if not to:
        return
    write_rows(output / "correlate.csv", PAIRS, pair_rows(to))
    if to.found:
        write_rows(output / "mac.csv", ("matrix", "row", "column", "value"), matrix_rows(to))
        write_rows(output / "sensors.csv", SENSORS, [
            (one.channel.name, *map(float, (*one.channel.place, *one.channel.direction, *one.place)), one.part, one.distance,
             blank(one.angle))
            for one in to.found])


def write_responses(compared, output):
    """responses.csv."""
    write_rows(output / "responses.csv", RESPONSES, [
        (one.response.name, one.output, one.distance, float(one.freq[0]), float(one.freq[-1]), len(one.freq), blank(one.frac),
         blank(one.level))
        for one in compared])


def write_expanded(to, args):
    """Expanded shapes for the page, and for other programs where asked."""
    import h5py
    states = []
    with opened(args.folder / "modes.h5") as file, whole(args.output / "expanded.h5") as part, h5py.File(part, "w") as out:
        folder, grid = Folder(args.folder, file), read_grid(file)
        for pair, shape in expanded(to, folder):
            row, mode = to.rows[pair.computed], to.measured.modes[pair.measured]
            for name, values in (("re", shape.real), ("im", shape.imag)):
                out[f"mode_{row['mode']:03d}_{name}"] = values.astype("f4")
            if args.vtu:
                facts = {"mode": row["mode"], "freq_hz": mode.freq}
                states.append(State(grid, "modes", f"measured_{row['mode']:03d}", row["mode"], f"measured {mode.name}", {
                    "displacement_re": shape.real.copy(), "displacement_im": shape.imag.copy()}, facts))
    if args.vtu:
        write_vtu(states, args.output / "vtu", 1)


def print_sensors(to):
    """Where the sensors are."""
    far = max(to.found, key=lambda one: one.distance)
    apart = numpy.array([one.distance for one in to.found])
    print(f"{len(to.found)} sensors on the mesh: {1e3 * apart.mean():.3g} mm from it on average, at most "
          f"{1e3 * far.distance:.3g} mm ({far.channel.name}, on {far.part}); refused beyond {1e3 * to.tolerance:.3g} mm")
    alike = [one for one in to.found if one.others]
    if alike:
        print(f"sensor {alike[0].channel.name} lies on {alike[0].part} and {', '.join(alike[0].others)} alike, taken on {alike[0].part}"
              + (f", so do {len(alike) - 1} more" if len(alike) > 1 else "") + "; --parts chooses")


def shown(value, form):
    """A number, or a dash."""
    return format(value, form) if value != "" and math.isfinite(value) else "-"


def print_pairs(to):
    """The pairs, and what is left."""
    rows = [(row[0], str(row[1]) or "-", row[2] or "-", f"{row[3]:.2f}", shown(row[4], ".2f"), shown(row[5], "+.2f"),
             *(shown(100 * x if x != "" else x, ".3f") for x in row[6:8]), *(shown(x, ".3f") for x in row[9:13]))
            for row in pair_rows(to) if row[0]]
    print_table("measured beside computed", ("measured", "mode", "label", "Hz", "computed", "%", "damping %", "computed", "MAC",
                                             "of group", "cross",
                                             "residual"), *rows)
    differences = numpy.array([percent(to.rows[pair.computed]["freq_hz"], to.measured.modes[pair.measured].freq) for pair in to.pairs])
    if len(differences):
        print(f"{len(differences)} pairs: frequencies differ by {differences.mean():+.2f} % on average, "
              f"{numpy.sqrt((differences**2).mean()):.2f} % rms, "
              f"{differences[abs(differences).argmax()]:+.2f} % at most")
    left = len(to.measured.modes) - len(to.pairs)
    if left:
        print(f"{left} of {len(to.measured.modes)} measured modes have no computed one")
    if rest := alone(to):
        print(f"{len(rest)} modes of the run in this band were not measured: {', '.join(str(row['mode']) for row in rest)}")
    if to.serep:
        print(f"expansion and cross-orthogonality rest on {len(to.serep.chosen)} of {len(to.rows)} modes at {len(to.found)} sensors, "
              f"condition "
              f"{to.serep.condition:.3g}")


def print_responses(compared):
    """FRAC of each."""
    print_table("responses", ("measured", "output", "Hz from", "to", "frequencies", "FRAC", "level dB"),
                *((one.response.name, one.output, f"{one.freq[0]:.5g}", f"{one.freq[-1]:.5g}", str(len(one.freq)), shown(one.frac, ".4f"),
                   shown(one.level, "+.2f")) for one in compared))
