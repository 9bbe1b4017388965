"""What the tests of the scripts share: running one, what it must say when it fails, and whether a picture is one."""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot  # for scripts that run in children of this process
import numpy
import PIL.Image
from matplotlib.colors import to_rgb

TESTS = Path(__file__).resolve().parents[1]
SCRIPTS = TESTS.parent / "scripts"
sys.path[:0] = [str(SCRIPTS), str(TESTS)]  # for squeal and forked

from forked import run_script


def require(condition, message):
    """Ends the test with a message."""
    if not condition:
        raise SystemExit(f"{Path(sys.argv[0]).stem}: {message}")


def script(name, *arguments):
    """Runs a script of scripts/."""
    return run_script(SCRIPTS / name, arguments)


def fails(name, folder, options, expected):
    """The script must fail with one line that holds the expected text."""
    result = script(name, folder, *options)
    require(result.returncode == 1 and result.stderr.count("\n") == 1 and expected in result.stderr,
            f"expected '{expected}', status {result.returncode}: {result.stderr}")


def points_of(file, title, least=(1200, 600)):
    """The points [n][3] of a PNG, from 0 to 255: at least so many across and down, no colour on more than 98 % of
    them."""
    with PIL.Image.open(file) as image:
        points = numpy.asarray(image.convert("RGB"))
    colours = points.reshape(-1, 3)
    share = numpy.bincount(colours.astype("u4") @ numpy.array([1, 256, 65536], "u4")).max() / len(colours)
    height, width = points.shape[:2]
    print(f"{title}: {width} x {height} points, most frequent colour on {share:.1%}")
    require(width >= least[0] and height >= least[1] and share < 0.98, f"{title} is not a picture")
    return colours


def drawn(name, folder, *options):
    """Points of the picture that a script draws of a folder."""
    result = script(name, folder, "-o", folder / "picture.png", *options)
    require(result.returncode == 0, result.stderr)
    return points_of(folder / "picture.png", f"{folder.name} {' '.join(options)}".rstrip())


def points_like(colours, colour):
    """How many of the points are of a colour, to one level of each channel."""
    wanted = numpy.rint(255 * numpy.array(to_rgb(colour))).astype(int)
    near = [(colours[:, i] >= level - 1) & (colours[:, i] <= level + 1) for i, level in enumerate(wanted)]
    return int(numpy.logical_and.reduce(near).sum())
