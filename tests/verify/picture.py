#!/usr/bin/env python3
"""Draws a run with scripts/plot/modes, or the script named after its folder, and checks that the picture is one: a PNG
of at least 800 x 600 points, of which no colour fills more than 98 %. Exit status: 0, or 1.

    picture.py FOLDER [plot/SCRIPT]
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "script"))
from drawing import points_of, require, script  # noqa: E402


def main():
    folder = Path(sys.argv[1])
    result = script(sys.argv[2] if len(sys.argv) > 2 else "plot/modes", folder, "-o", folder / "picture.png")
    require(result.returncode == 0, result.stderr)
    points_of(folder / "picture.png", folder.name, least=(800, 600))


if __name__ == "__main__":
    main()
