"""What tones radiate: limit cycles to listen to (sound_cycle.csv), and forces over frequency (sound_frf.csv)."""

import matplotlib.pyplot as plt
import numpy

from ..picture import save_picture
from ..tables import BadInput, read_table
from .write import RATE, write_wave

SECONDS = 3.0  # of a file to listen to


def names_of(path, ending):
    """Microphones of a table by its columns."""
    with path.open() as file:
        return [column[:-len(ending)] for column in file.readline().strip().split(",") if column.endswith(ending)]


def read_cycles(path):
    """Microphones, and rows of sound_cycle.csv by the number of the cycle; harmonic 0 is all together."""
    names = names_of(path, "_dba")
    columns = {"point": int, "harmonic": int, "freq_hz": float, "power_db": float, "error_db": str, "cutoff_error_db": str}
    columns |= {f"{name}_{what}": float for name in names for what in ("re_pa", "im_pa", "db", "dba")}
    cycles = {}
    for row in read_table(path, columns):
        cycles.setdefault(row["point"], []).append(row)
    return names, cycles


def errors_of(row):
    """Words on the errors of a row's levels that are known."""
    known = [f"{float(row[column]):.2g} dB by the {what}" for column, what in (("error_db", "steps"), ("cutoff_error_db", "cut-off"))
             if row[column]]
    return f"; off by {', '.join(known)}" if known else "; errors not known"


def show_cycles(folder, number, most):
    """Prints a line for each cycle and microphone; writes one of the cycles, to listen to."""
    path = folder / "sound_cycle.csv"
    names, cycles = read_cycles(path)
    if not cycles:
        raise BadInput(f"{path}: holds no cycle")
    if number not in cycles:
        raise BadInput(f"--cycle {number}: {path} has cycles 1 to {max(cycles)}")
    for point, rows in list(cycles.items())[:most]:
        levels = "; ".join(f"{name} {rows[0][f'{name}_dba']:.1f} dB(A)" for name in names)
        print(f"cycle {point}: {rows[0]['freq_hz']:.1f} Hz, {len(rows) - 1} harmonics; {levels}; power {rows[0]['power_db']:.1f} dB"
              f"{errors_of(rows[0])}")
    time = numpy.arange(int(SECONDS * RATE)) / RATE
    heard = [row for row in cycles[number][1:] if row["freq_hz"] < RATE / 2]
    if not heard:
        raise BadInput(f"--cycle {number}: its {cycles[number][0]['freq_hz']:.0f} Hz are too high to be heard")
    for name in names:
        pressure = sum(numpy.real(complex(row[f"{name}_re_pa"], row[f"{name}_im_pa"]) * numpy.exp(2j * numpy.pi * row["freq_hz"] * time))
                       for row in heard)
        full = write_wave(folder / f"cycle_{name}.wav", pressure, 1 / RATE)
        print(f"cycle_{name}.wav: cycle {number}, {SECONDS:g} s, full scale {full:.3g} Pa")
    return path


def show_response(folder, most):
    """Prints the loudest frequencies of a force of 1 N, and draws all."""
    path = folder / "sound_frf.csv"
    names = names_of(path, "_dba")
    rows = read_table(path, {"freq_hz": float, "power_db": float, **{f"{name}_dba": float for name in names}})
    if not rows:
        raise BadInput(f"{path}: holds no frequency")
    frequencies = numpy.array([row["freq_hz"] for row in rows])
    figure, axes = plt.subplots(figsize=(9, 5), layout="constrained")
    for name in names:
        levels = numpy.array([row[f"{name}_dba"] for row in rows])
        axes.plot(frequencies / 1000, levels, label=name)
        print(f"{name}: loudest with 1 N")
        for i in numpy.argsort(-levels, kind="stable")[:most]:
            print(f"  {frequencies[i]:10.3f} Hz  {levels[i]:6.1f} dB(A)  power {rows[i]['power_db']:6.1f} dB")
    axes.set_xlabel("frequency, kHz")
    axes.set_ylabel("level with 1 N, dB(A)")
    axes.legend()
    save_picture(figure, folder / "sound_frf.png", 120)
    return path
