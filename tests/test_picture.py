#!/usr/bin/env python3
"""Draws a run with scripts/plot_modes.py, or the script named after its folder, and checks that the picture is one: a PNG of at
least 800 x 600 points, of which no colour fills more than 98 %. Exit status: 0, or 1.
"""

import subprocess
import sys
from pathlib import Path

import matplotlib.image
import numpy

SCRIPTS = Path(__file__).resolve().parent.parent / "scripts"


def main():
    folder = Path(sys.argv[1])
    picture = folder / "picture.png"
    script = SCRIPTS / (sys.argv[2] if len(sys.argv) > 2 else "plot_modes.py")
    subprocess.run([sys.executable, script, folder, "-o", picture], check=True)
    points = (255 * matplotlib.image.imread(picture)[:, :, :3]).astype(int)
    colours = points.reshape(-1, 3) @ [1, 256, 65536]
    _, counts = numpy.unique(colours, return_counts=True)
    height, width, share = *points.shape[:2], counts.max() / colours.size
    print(f"{width} x {height} points, {len(counts)} colours, the most frequent one on {share:.1%}")
    return 0 if width >= 800 and height >= 600 and share < 0.98 else 1


if __name__ == "__main__":
    sys.exit(main())
