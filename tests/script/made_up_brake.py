"""Writes what squeal writes of a made-up brake with two unstable modes, for each analysis that study/ranking runs:
modes with shapes, sweeps, and a transient in which both grow and one remains. With damping of all parts (-pad_alpha
100) it is the slower one, 1 % below its frequency, which study/ranking must find."""

import sys
from pathlib import Path

import h5py
import numpy

STEP, TAP = 2e-5, 1e-5  # s
PROBE = 0.105, 0.005, 0.005  # m
MODES = {3: (3500.0, 300.0), 8: (5200.0, 400.0)}  # Hz, 1/s
WINNERS = {3: 3470.0, 8: 5150.0}  # Hz of the one that remains
LEVEL = {True: 1e-5, False: 1e-6}  # m, of the mode that remains and of the other one


def eigenvalue(mode):
    """1/s."""
    return complex(MODES[mode][1], 2 * numpy.pi * MODES[mode][0])


def write_modes(folder):
    """modes.csv and modes.h5: both modes move the probe by 1."""
    head = "mode,freq_hz,growth_rad_s,damping_ratio,backward_error,condition,unstable,label,error_hz"
    rows = [f'{mode},{freq},{growth},{-growth / abs(eigenvalue(mode)):.15g},1e-16,1,1,"(0,{mode}+)",1e-8'
            for mode, (freq, growth) in MODES.items()]
    (folder / "modes.csv").write_text("\n".join([head, *rows, ""]))
    with h5py.File(folder / "modes.h5", "w") as file:
        group = file.create_group("VTKHDF")
        group["Points"] = numpy.array([(0.0, 0.0, 0.0), PROBE])
        for mode in MODES:
            group[f"PointData/mode_{mode:03d}_re"] = numpy.array([(0.0, 0.0, 0.1), (0.0, 1.0, 0.0)])
            group[f"PointData/mode_{mode:03d}_im"] = numpy.zeros((2, 3))


def write_sweep(folder, values):
    """sweep.csv: both modes at all values."""
    rows = [f"{value},{freq},{growth}" for value in values for freq, growth in MODES.values()]
    (folder / "sweep.csv").write_text("\n".join(["value,freq_hz,growth_rad_s", *rows, ""]))


def write_transient(folder, option, slower):
    """amplitudes.csv and transient.csv."""
    time = STEP * numpy.arange(round(float(option["-ts_max_time"]) / STEP) + 1)
    motion, columns = numpy.zeros_like(time), {"time_s": time}
    for mode, (freq, growth) in MODES.items():
        remains = (mode == 3) == slower
        size = numpy.minimum(1e-8 * numpy.exp(growth * (time - TAP)), LEVEL[remains])
        line = WINNERS[mode] if remains else freq
        c = numpy.where(time >= TAP, size, 0) * numpy.exp(2j * numpy.pi * line * time)
        columns |= {f"mode_{mode}_re_m": c.real, f"mode_{mode}_im_m": c.imag}
        motion += (1j * 2 * numpy.pi * line * c).real
    write_table(folder / "amplitudes.csv", columns)
    write_table(folder / "transient.csv", {"time_s": time, "normal_force_n": 100 + 0 * time,
                                           "friction_force_n": 50 + 0 * time, "edge_vy_m_s": motion})


def write_table(path, columns):
    """A table of numbers."""
    numpy.savetxt(path, numpy.stack(list(columns.values()), axis=1), fmt="%.15g", delimiter=",",
                  header=",".join(columns), comments="")


def write_run(option):
    """What the options ask for."""
    folder = Path(option["-output_dir"])
    if option["-analysis"] == "modes":
        write_modes(folder)
    elif option["-analysis"] == "sweep":
        write_sweep(folder, option["-sweep_values"].split(","))
    elif option["-analysis"] == "transient":
        write_transient(folder, option, float(option["-pad_alpha"]) > 0)
    else:
        sys.exit(f"unknown analysis {option['-analysis']}")
