#!/usr/bin/env python3
"""Tables of two builds beside each other, scripts/study/gallery --before: the same program agrees with itself, one whose friction is
another by 1e-9 does not, and the column is named. Their times, scripts/bench/before, on programs that only write a table: one that takes
three times as long is slower, one with another eigenvalue differs. Exit status: 0, or 1. The program is the argument."""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from drawing import SCRIPTS, require

OTHER = """#!/bin/sh
exec "{program}" "$@" -contact_mu 0.5000000005
"""

# Takes 0.15 s of processor times {times}
MADE_UP = """#!{python}
import pathlib, sys, time
folder = pathlib.Path(sys.argv[sys.argv.index("-output_dir") + 1])
folder.mkdir(exist_ok=True)
(folder / "modes.csv").write_text("mode,freq_hz,growth_rad_s\\n1,{freq},0\\n")
while time.process_time() < 0.15 * {times}:
    pass
"""


def gallery(program, before, folder):
    """Exit status and what it says of one scene."""
    command = [SCRIPTS / "study/gallery", "--quick", "--program", program, "--before", before, "--output", folder, "massi2005"]
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def made_up(path, times=1, freq=1000.0):
    """A program that takes so many units of time, and has one mode."""
    path.write_text(MADE_UP.format(python=sys.executable, times=times, freq=freq), encoding="utf-8")
    os.chmod(path, 0o755)
    return path


def check_times(folder):
    """Both verdicts, and none where there is nothing to say."""
    one = made_up(folder / "one")
    for name, other, word in (("even", made_up(folder / "even"), "|  |"), ("fast", made_up(folder / "fast", times=0.3), "| SLOWER |"),
                              ("other", made_up(folder / "other_mode", freq=1000.00001), "| DIFFERS: modes.csv freq_hz row 1")):
        command = [SCRIPTS / "bench/before", other, "--program", one, "--times", "3", "--most", "1.5", "--part", "modes"]
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)
        require(done.returncode == (name != "even") and word in done.stdout, f"times beside {name}: {done.stdout}{done.stderr}")


def main():
    """The comparisons of tables, and of times."""
    program = Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as scratch:
        other = Path(scratch) / "other"
        other.write_text(OTHER.format(program=program), encoding="utf-8")
        os.chmod(other, 0o755)
        check_times(Path(scratch))
        status, text = gallery(program, program, Path(scratch) / "same")
        require(status == 0 and "0.0e+00 same" in text, f"one build beside itself: {text}")
        status, text = gallery(program, other, Path(scratch) / "apart")
        require(status == 1 and "DIFFERS (" in text and " modes.csv " in text, f"another friction coefficient: {text}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
