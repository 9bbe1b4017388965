#!/usr/bin/env python3
"""Draws a made-up quiet box with scripts/plot/quiet and checks what the picture shows and how bad tables fail: the left half of the box
is quiet, a quarter dangerous, a quarter open. Exit status: 0, or 1.
"""

import tempfile
from pathlib import Path

from drawing import drawn, fails, points_like, require
from squeal.picture import GREEN, VERMILION


def write(folder):
    """The three tables."""
    folder.mkdir()
    (folder / "quiet.csv").write_text("variable,own,lower,upper,quiet_lower,quiet_upper,danger\n"
                                      "a,0.5,0,1,0.4,0.5,0.6\nb,5,0,10,4,6,5\nc,1,0,2,0.5,1.5,1\n")
    (folder / "quiet_statement.csv").write_text("goal,size,quiet_share,danger_freq_hz,danger_growth_rad_s\nbox,0.2,0.5,100,1\n")
    (folder / "quiet_cells.csv").write_text("state,margin_rad_s,growth_rad_s,lower_a,upper_a,lower_b,upper_b,lower_c,upper_c\n"
                                            "quiet,1,-1,0,0.5,0,10,0,2\ndangerous,,1,0.5,1,0,5,0,2\nopen,,,0.5,1,5,10,0,2\n")
    return folder


def main():
    with tempfile.TemporaryDirectory() as name:
        root = Path(name)
        found = drawn("plot/quiet", write(root / "made"))
        count = [points_like(found, colour) for colour in (GREEN, VERMILION)]
        require(count[1] > 1000 and count[0] > count[1], f"more is quiet than dangerous: {count} points")
        fails("plot/quiet", root / "nothing", [], "no such file")
        (root / "made/quiet.csv").write_text("variable,own,lower,upper,quiet_lower,quiet_upper,danger\na,0.5,0,1,0.4,0.5,0.6\n")
        fails("plot/quiet", root / "made", [], "a plane takes two")


if __name__ == "__main__":
    main()
