#!/usr/bin/env python3
"""Draws made-up maps with scripts/plot/map, in every direction and over one or two parameters, and looks for their colours. Exit
status: 0, or 1.

Breaks when a direction is not drawn, when a point that failed stops it, or when hysteresis is not marked.
"""

import tempfile
from pathlib import Path

import numpy
from drawing import drawn, fails, require
from matplotlib.colors import to_rgb
from squeal.picture import BLUE, GREEN, VERMILION

NAMES = ("parameter,value,parameter_2,value_2,direction,regime,freq_hz,freq_error_hz,force_rms_n,force_mean_n,open_share,"
         "growth_rad_s,error_estimate,status")
FRICTION, FORCES = (0.3, 0.4, 0.5), (50, 100)
STABLE, CYCLE, FAILED = "stable,0,0,0.1,50,0,-20,nan,decays", "cycle,3200,5,40,50,0.2,90,0.01,settled", ",".join(
    ["unknown"] + 5 * ["nan"] + ["90", "nan", "failed"])


def write(folder, ways, forces=FORCES):
    """A map whose middle value squeals downwards alone, and whose last one fails at the first force."""
    folder.mkdir()
    rows = [NAMES]
    for way in ways:
        for force in forces:
            second = f"press_force,{force}" if len(forces) > 1 else ","
            for mu in FRICTION:
                loud = mu > 0.45 or (mu > 0.35 and way == "down")
                state = FAILED if mu > 0.45 and force == forces[0] else CYCLE if loud else STABLE
                rows.append(f"contact_mu,{mu},{second},{way},{state}")
    (folder / "map.csv").write_text("\n".join(rows) + "\n")
    return folder


def count(colours, colour):
    return int((abs(colours - 255 * numpy.array(to_rgb(colour))) < 1.5).all(axis=1).sum())


def main():
    with tempfile.TemporaryDirectory() as root:
        for ways in (["up", "down"], ["up"], ["down"], ["apart"]):
            grid = drawn("plot/map", write(Path(root) / f"grid_{'_'.join(ways)}", ways))
            line = drawn("plot/map", write(Path(root) / f"line_{'_'.join(ways)}", ways, FORCES[:1]))
            require((count(grid, GREEN) > 200) == (len(ways) == 2), f"{ways}: circles of hysteresis")
            require((count(line, VERMILION) > 300) == ("down" in ways), f"{ways}: the line downwards")
            require((count(line, BLUE) > 300) == (ways != ["down"]), f"{ways}: the line upwards or of points apart")
        empty = Path(root) / "empty"
        empty.mkdir()
        (empty / "map.csv").write_text(NAMES + "\n")
        fails("plot/map", empty, [], "has no rows")
        print("maps of every direction are drawn")


if __name__ == "__main__":
    main()
