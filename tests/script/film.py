#!/usr/bin/env python3
"""Films made-up modes and snapshots with scripts/plot/film. Breaks when a frame is missing, nothing moves, half a turn
of the phase looks like none, MP4 is not a film or its absence is not said, or bad input gives more than a line.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy
from drawing import SCRIPTS, fails, require, script
from made_up_transient import Transient, write_snapshots, write_table
from modes_picture import write_modes
from PIL import Image

FRAMES = 30  # of a turn


def frames_of(path):
    """Points [frame][row][column][3] of a GIF."""
    with Image.open(path) as film:
        frames = []
        for i in range(film.n_frames):
            film.seek(i)
            frames.append(numpy.asarray(film.convert("RGB"), int))
    return numpy.array(frames)


def test_mode(root):
    """One turn: all frames, half a turn is another picture, and both formats."""
    folder = root / "modes"
    write_modes(folder, 2)
    done = script("plot/film", folder, "--mode", "2")
    require(done.returncode == 0, done.stderr)
    film = frames_of(folder / "film_mode_002.gif")
    require(film.shape == (FRAMES, 480, 640, 3), f"frames {film.shape}")
    changes = [abs(film[i] - film[i - 1]).mean() for i in range(FRAMES)]
    require(min(changes) > 0.05, f"frames that do not move: {min(changes):.3f}")
    require(abs(film[0] - film[FRAMES // 2]).mean() > 3 * numpy.median(changes), "half a turn looks like none")
    names = done.stdout.split()
    require(names[0].endswith("film_mode_002.gif") and all(Path(name).stat().st_size > 2000 for name in names),
            done.stdout)
    if len(names) == 2:
        require(b"ftyp" in Path(names[1]).read_bytes()[:12], "the MP4 is none")
    print(f"mode: {film.shape[0]} frames, {len(names)} formats")


def test_still(root):
    """A picture of the shape, and from the other side another one; no film."""
    pictures = []
    for yaw in ("30", "210"):
        done = script("plot/film", root / "modes", "--mode", "2", "--still", "--look", yaw, "35", "-o", root / f"still{yaw}")
        require(done.returncode == 0 and not (root / f"still{yaw}.gif").exists(), done.stderr)
        pictures.append(numpy.asarray(Image.open(root / f"still{yaw}.png").convert("RGB")) / 255)
    require(abs(pictures[0] - pictures[1]).mean() > 0.01, "seen from the other side it looks the same")
    require(numpy.ptp(pictures[0][:, :, 0] - pictures[0][:, :, 2]) > 0.5, "no colours")
    print(f"still: {pictures[0].shape[1]} x {pictures[0].shape[0]}")


def test_without_ffmpeg(root):
    """GIF alone, and one line that says so."""
    done = subprocess.run([sys.executable, SCRIPTS / "plot/film", root / "modes", "-o", root / "alone"],
                          capture_output=True, text=True, env={**os.environ, "PATH": str(root)}, check=False)
    require(done.returncode == 0 and done.stderr == "plot/film: no MP4 without ffmpeg; apt-get install ffmpeg\n",
            f"without ffmpeg: {done.stderr}")
    require((root / "alone.gif").exists() and not (root / "alone.mp4").exists(), "without ffmpeg: files")


def test_snapshots(root):
    """As many frames as snapshots in the window."""
    folder = root / "transient"
    write_table(folder, Transient().table())
    times = [0.001 * k for k in range(10, 22)]
    write_snapshots(folder, times)
    done = script("plot/film", folder, "--window", "0.0125,0.0185")
    require(done.returncode == 0, done.stderr)
    n = len(frames_of(folder / "film_transient.gif"))
    require(n == sum(0.0125 <= time <= 0.0185 for time in times), f"{n} frames")
    print(f"snapshots: {n} frames")


def test_bad(root):
    """One line each."""
    fails("plot/film", root / "none", (), "no such file")
    fails("plot/film", root / "modes", ("--mode", "9"), "--mode 9: no such mode")
    fails("plot/film", root / "modes", ("--exaggeration", "0"), "--exaggeration 0")
    fails("plot/film", root / "modes", ("-o", root / "none/film"), "cannot write")
    fails("plot/film", root / "transient", ("--window", "0.1,0.2"), "0 snapshots")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory(prefix="squeal-") as name:
        for test in (test_mode, test_still, test_without_ffmpeg, test_snapshots, test_bad):
            test(Path(name))
