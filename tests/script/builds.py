#!/usr/bin/env python3
"""Tables of two builds beside each other, scripts/study/gallery --before: the same program agrees with itself, one whose friction is
another by 1e-9 does not, and the column is named. Exit status: 0, or 1. The program is the argument."""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from drawing import SCRIPTS, require

OTHER = """#!/bin/sh
exec "{program}" "$@" -contact_mu 0.5000000005
"""


def gallery(program, before, folder):
    """Exit status and what it says of one scene."""
    command = [SCRIPTS / "study/gallery", "--quick", "--program", program, "--before", before, "--output", folder, "massi2005"]
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def main():
    """The two comparisons."""
    program = Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as scratch:
        other = Path(scratch) / "other"
        other.write_text(OTHER.format(program=program), encoding="utf-8")
        os.chmod(other, 0o755)
        status, text = gallery(program, program, Path(scratch) / "same")
        require(status == 0 and "0.0e+00 same" in text, f"one build beside itself: {text}")
        status, text = gallery(program, other, Path(scratch) / "apart")
        require(status == 1 and "DIFFERS (modes" in text, f"another friction coefficient: {text}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
