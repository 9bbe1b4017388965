#!/usr/bin/env python3
"""Too little memory: with any bound of the address space a run ends, well or with one line that says what to reduce; never with the
name of a function of PETSc, and never without an end. Breaks when an allocation fails where nobody explains it, or BLAS asks for its
buffer for ever. And the memory that a run prints is its own, also where the program that started it had more: breaks when it is that
of getrusage(2). Arguments: squeal. Exit status: 0, or 1."""

import os
import re
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parent.parent
WORDS = re.compile(r"squeal: error: (ulimit -v allows \d+ MB of address space, which leave no room|out of memory: a rank has \d+ MB|"
                   r"MUMPS ran out of memory).*(allow \d+ MB or more|take a coarser mesh|use more ranks or a coarser mesh)")
BOUNDS = range(350, 851, 50)  # MB
PATIENCE = 240  # seconds
PARENT = 500_000_000  # bytes of this process when it starts a run that takes a fifth of them


def run(squeal, folder, bound):
    """What is wrong with the end of a run that may have so many MB, and whether it succeeded."""
    size = bound * 1_000_000
    command = [squeal, "-options_file", SOURCE / "options/massi2005.yaml", "-modes_band", "1000,2000", "-output_dir", folder,
               "-output_fields", "0"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, check=False,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (size, size)))
    except subprocess.TimeoutExpired:
        return "no end", False
    if done.returncode == 0:
        return "", True
    lines = done.stderr.splitlines()
    good = done.returncode == 1 and len(lines) == 1 and WORDS.match(lines[0])
    return "" if good else f"exit status {done.returncode}: {done.stderr}", False


def peak_is_own(squeal, folder):
    """Whether a small run prints less than its parent had."""
    held = bytearray(PARENT)
    held[::4096] = b"1" * len(held[::4096])
    done = subprocess.run([squeal, "-options_file", SOURCE / "options/oscillator.yaml", "-output_dir", folder, "-squeal_view"],
                          capture_output=True, text=True, check=False)
    peak = re.search(r"^the most at any time +(\d+)$", done.stdout, re.MULTILINE)
    print(f"memory printed beside a parent of {len(held) / 1e6:.0f} MB: {peak[1] if peak else done.stderr} MB")
    return bool(peak) and 0 < int(peak[1]) < 0.5 * len(held) / 1e6


def main():
    failed, succeeded = 0, []
    with tempfile.TemporaryDirectory() as folder:
        failed += not peak_is_own(Path(sys.argv[1]).resolve(), folder)
        for bound in BOUNDS:
            wrong, success = run(Path(sys.argv[1]).resolve(), folder, bound)
            succeeded.append(success)
            print(f"{bound} MB: {wrong or ('ends well' if success else 'refused')}")
            failed += bool(wrong)
    if all(succeeded) or succeeded[0]:
        print("FAILED: no bound was too small: nothing was tested")
        failed += 1
    return 1 if failed else 0


if __name__ == "__main__":
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    sys.exit(main())
