#!/usr/bin/env python3
"""Draws made-up samples with scripts/plot/sample and checks what the picture shows and how bad tables fail. Growth is x - 0.3 of one
branch and -1 of another. Exit status: 0, or 1.
"""

import tempfile
from pathlib import Path

import numpy
from drawing import drawn, fails, points_like, require
from squeal.picture import BLUE, VERMILION


def write(folder):
    """The four tables of 500 samples."""
    folder.mkdir()
    x = (numpy.arange(500) + 0.5) / 500
    lines = [f"{k + 1},2,{int(a > 0.3)},100,{a - 0.3},0,{a},{1 - a}" for k, a in enumerate(x)]
    (folder / "samples.csv").write_text("\n".join(["sample,modes,unstable,freq_hz,growth_rad_s,error_rad_s,a,b", *lines]) + "\n")
    lines = [f"{k + 1},{branch},100,{growth},0,stable" for k, a in enumerate(x) for branch, growth in ((1, a - 0.3), (2, -1))]
    (folder / "samples_modes.csv").write_text("\n".join(["sample,branch,freq_hz,growth_rad_s,error_rad_s,class", *lines]) + "\n")
    (folder / "probability.csv").write_text(
        "branch,label,samples,freq_mean_hz,growth_99_rad_s,probability,probability_lower,probability_upper\n"
        "1,one,500,100,0.69,0.7,0.66,0.74\n2,two,500,200,-1,0,0,0.007\nany,any mode,500,100,0.69,0.7,0.66,0.74\n")
    (folder / "indices.csv").write_text(
        "branch,of,variable,total,total_error,slope,slope_error\n1,growth_rad_s,a,,,1,0.01\n1,growth_rad_s,b,,,-0.2,0.01\n"
        "2,growth_rad_s,a,,,,\n2,growth_rad_s,b,,,,\n")
    return folder


def main():
    with tempfile.TemporaryDirectory() as name:
        root = Path(name)
        found = drawn("plot/sample", write(root / "made"))
        count = [points_like(found, colour) for colour in (VERMILION, BLUE)]
        require(count[0] > 1000 and count[1] < 100, f"the branch that grows, and no other: {count} points")
        fails("plot/sample", root / "nothing", [], "no such file")
        index = root / "made/indices.csv"
        index.write_text("branch,of,variable,total,total_error,slope,slope_error\n1,growth_rad_s,a,,,,\n1,growth_rad_s,b,,,,\n")
        drawn("plot/sample", root / "made")
        made = (root / "made/probability.csv").read_text().splitlines()
        (root / "made/probability.csv").write_text(f"{made[0]}\n{made[-1]}\n")
        fails("plot/sample", root / "made", [], "no branch has a mode in the band at any sample")
        (root / "made/probability.csv").write_text("\n".join(made) + "\n")
        index.write_text("branch\n")
        fails("plot/sample", root / "made", [], "no column of")


if __name__ == "__main__":
    main()
