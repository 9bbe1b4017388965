#!/usr/bin/env python3
"""Draws made-up maps with scripts/plot/map, in every direction and over one or two parameters, and looks for their colours. Exit
status: 0, or 1.

Breaks when a direction is not drawn, when a point that failed stops it, when hysteresis is not marked, or when the errors of
-map_verify are not there.
"""

import tempfile
from pathlib import Path

from drawing import drawn, fails, points_like, require
from squeal.picture import BLUE, GREEN, INK, VERMILION

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


def add_errors(folder):
    """Errors at the last value, 20 % by half the step, and at the first one, where nothing vibrates."""
    rows = ["value,value_2,run,regime,freq_error_hz,force_rms_error"]
    for force in FORCES:
        for run, freq, rms in (("map", "nan", "nan"), ("half_step", 12, -0.2), ("higher_cutoff", 5, 0.1)):
            rows.append(f"{FRICTION[-1]},{force},{run},cycle,{freq},{rms}")
            rows.append(f"{FRICTION[0]},{force},{run},stable,nan,nan")
    (folder / "map_errors.csv").write_text("\n".join(rows) + "\n")
    return folder


def count(colours, colour):
    return points_like(colours, colour)


def main():
    with tempfile.TemporaryDirectory() as root:
        for ways in (["up", "down"], ["up"], ["down"], ["apart"]):
            grid = drawn("plot/map", write(Path(root) / f"grid_{'_'.join(ways)}", ways))
            line = drawn("plot/map", write(Path(root) / f"line_{'_'.join(ways)}", ways, FORCES[:1]))
            require((count(grid, GREEN) > 200) == (len(ways) == 2), f"{ways}: circles of hysteresis")
            require((count(line, VERMILION) > 300) == ("down" in ways), f"{ways}: the line downwards")
            require((count(line, BLUE) > 300) == (ways != ["down"]), f"{ways}: the line upwards or of points apart")
        for forces, name in ((FORCES, "grid_up_down"), (FORCES[1:], "told")):
            folder = Path(root) / name if len(forces) > 1 else write(Path(root) / name, ["up"], forces)
            before = count(drawn("plot/map", folder), INK)
            require(count(drawn("plot/map", add_errors(folder)), INK) > before + 50, f"{name}: errors of -map_verify")
        empty = Path(root) / "empty"
        empty.mkdir()
        (empty / "map.csv").write_text(NAMES + "\n")
        fails("plot/map", empty, [], "has no rows")
        print("maps of every direction are drawn")


if __name__ == "__main__":
    main()
