#!/usr/bin/python3
"""Draws a transient that squeal computed and prints what it does.

  transient_forces.png        sums of normal and friction force, status of the pairs (open, stick, slip), error of the
                              ledger of energy relative to the energy turned over
  transient_acceleration.png  acceleration of a probe, mean from the row before to the row after
  transient_psd.png           its power spectral density, with the main line and the levels of its harmonics
  transient_growth.png        amplitude and frequency of the main line over time, with the exponential fitted
  transient_shape.png         velocity of the disc's face at its largest, and the nodal diameters (from snapshots)
  transient_summary.csv       quantity,value,error,unit

The growth is that of the exponential of most energy within the band, fitted in the window (found where none is given);
its error is the standard error of that fit, or the difference to the fit of the first three quarters of the window.
Amplitudes, spectrum, forces and shares of time are those after saturation, or of the second half of the run where there
is no limit cycle.

Reads transient.csv, of a run under way its temporary file, and snapshot_*.h5 with transient.xmf where there are any.
"""

import argparse
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import squeal_tables as tables
from squeal_tables import BadInput
from transient_cycle import Quantity, Vibration, contact_quantities, print_summary, vibration_quantities, write_summary
from transient_lines import draw_acceleration, draw_forces, draw_growth, draw_spectrum
from transient_run import Run, snapshots
from transient_shape import draw_shape, read_shapes

DPI = 150
FONTS = {"font.size": 12, "axes.labelsize": 12.5, "legend.fontsize": 11.5, "figure.dpi": DPI}
UNIT = "m/s^2"


def pair(text):
    """Two rising numbers of the command line."""
    try:
        first, last = map(float, text.split(","))
    except ValueError:
        first, last = 0, 0
    if not 0 <= first < last < float("inf"):
        raise argparse.ArgumentTypeError(f"{text}: must be two numbers, the smaller one first: 0.01,0.02")
    return first, last


def arguments():
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, default=Path("results"),
                        help="folder that squeal wrote, default: results")
    parser.add_argument("-o", "--out", type=Path, help="folder for pictures and summary, default: the same")
    parser.add_argument("--probe", help="its name, default: the first one with `pad` in its name, or the first")
    parser.add_argument("--component", choices="xyz", default="y", help="of its acceleration, default: y")
    parser.add_argument("--window", type=pair, metavar="T1,T2", help="of the growth, s; default: found")
    parser.add_argument("--band", type=pair, metavar="F1,F2",
                        help="of the main line, Hz; default: 20 %% about the largest line")
    parser.add_argument("--case", default="", help='for the titles, e.g. "25.1 GPa"')
    parser.add_argument("--disc", default="disc", help="part with the face, default: disc")
    return parser.parse_args()


def save(figure, path):
    """Writes and forgets a picture."""
    tables.save_picture(figure, path)
    plt.close(figure)


def draw_lines(run, vibration, out, name, case):
    """All pictures over time and frequency; what cannot be drawn is said."""
    save(draw_forces(run, vibration, case), out / "transient_forces.png")
    if not name:
        return
    save(draw_acceleration(vibration, name, case), out / "transient_acceleration.png")
    if not vibration.line:
        print(f"no spectrum and no growth: {vibration.why}")
        return
    save(draw_spectrum(vibration, name, case), out / "transient_psd.png")
    save(draw_growth(vibration, name, case), out / "transient_growth.png")


def shape_quantities(args, out, first, case):
    """Draws the snapshots, if there are any."""
    files = snapshots(args.folder)
    if not files:
        return []
    shapes = read_shapes(files, args.disc, first)
    save(draw_shape(shapes, case), out / "transient_shape.png")
    return [Quantity("nodal_diameters", shapes.diameters(), None, "-"),
            Quantity("nodal_diameters_share", shapes.share(), None, "-")]


def head_lines(run, vibration, args, name):
    """What was read and what it does."""
    yield (f"{run.path}: {len(run.time)} rows, {run.time[0]:.6g} to {run.time[-1]:.6g} s"
           + (", of a run that is under way" if run.under_way else ""))
    if name:
        yield f"{name}: acceleration in {args.component}: {vibration.regime()}"
    else:
        yield "no acceleration: the run had no -probes; the friction force serves for growth and lines"
    if not run.normal.any():
        yield "no contact: the normal force is zero in the whole run"
    if vibration.growth and vibration.growth.slope > 0 and vibration.growth.saturation is None:
        yield "the vibration still grows at the end of the run: amplitudes are those so far"


def draw(args):
    """Reads, draws, prints; returns the summary's name."""
    run = Run(args.folder)
    probe = run.choose_probe(args.probe)
    signal = run.acceleration(probe, args.component) if probe else run.friction
    name = f"of {probe} in {args.component}" if probe else ""
    out, case = args.out or args.folder, f", {args.case}" if args.case else ""
    if not out.is_dir():
        raise BadInput(f"--out {out}: no such folder")
    vibration = Vibration(run.time, signal, run.start(), args.band, args.window)
    quantities = [*vibration_quantities(vibration, UNIT if probe else "N"), *contact_quantities(run, vibration.steady)]
    with plt.rc_context(FONTS):
        draw_lines(run, vibration, out, name, case)
        quantities += shape_quantities(args, out, run.time[vibration.steady][0], case)
    print_summary(head_lines(run, vibration, args, probe), quantities)
    write_summary(out / "transient_summary.csv", quantities)
    return out / "transient_summary.csv"


if __name__ == "__main__":
    sys.exit(tables.run("plot_transient", lambda: draw(arguments())))
