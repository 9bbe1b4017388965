#!/usr/bin/env python3
"""Draws made-up conditions with scripts/plot/conditions and checks what the picture shows and how bad tables fail. Exit status: 0, or 1.
"""

import tempfile
from pathlib import Path

from drawing import drawn, fails, points_like, require
from squeal.picture import SKY

HEAD = "condition,name,branch,label,freq_hz,growth_rad_s,error_rad_s,damping_ratio,class,n_closed,direction,pressure [bar]"


def write(folder, growth):
    """Two tables of ten conditions, half of which squeal where the growth is above 0."""
    folder.mkdir()
    lines = [f'{k + 1},"stop {k}",1,"(0,2)",{1000 + 100 * k},{growth if k % 2 else -1},0,0,'
             f'{"unstable" if growth > 0 and k % 2 else "stable"},,1,{k}' for k in range(10)]
    (folder / "conditions.csv").write_text("\n".join([HEAD, *lines]) + "\n")
    share = 50 if growth > 0 else 0
    (folder / "conditions_bands.csv").write_text(f"freq_from_hz,freq_to_hz,occurrence_percent\n1000,2000,{share}\n1000,2000,{share}\n")
    return folder


def main():
    with tempfile.TemporaryDirectory() as name:
        root = Path(name)
        pictures = [drawn("plot/conditions", write(root / f"made{growth}", growth)) for growth in (50, -50)]
        bars = [points_like(picture, SKY) for picture in pictures]
        require(bars[0] > 5000 and bars[1] == 0, f"a bar where conditions squeal, and none else: {bars} points")
        drawn("plot/conditions", root / "made50", "--over", "pressure [bar]")
        fails("plot/conditions", root / "nothing", [], "no such file")
        fails("plot/conditions", root / "made50", ["--over", "speed"], "has condition, direction, pressure [bar]")
        (root / "made50/conditions.csv").write_text(f"{HEAD}\n")
        fails("plot/conditions", root / "made50", [], "no condition has a mode in the band")


if __name__ == "__main__":
    main()
