#!/usr/bin/env python3
"""Too little memory: with any bound of the address space a run ends, well or with one line that says what to reduce; never with the
name of a function of PETSc, and never without an end. Breaks when an allocation fails where nobody explains it, or BLAS asks for its
buffer for ever. And the memory that a run prints is its own, also where the program that started it had more: breaks when it is that
of getrusage(2). And all modes of the default scene to 20 kHz take 329 to 334 MB on one rank; breaks when matrices or vectors
are held twice. Arguments: squeal. Exit status: 0, or 1."""

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
BOUNDS = range(350, 851, 125)  # MB
PATIENCE = 240  # seconds
MOST = 340  # MB of the default scene; 336 are asked for by scripts/bench/modes, libraries of other systems may take some more
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


def peak_of(squeal, scene, folder):
    """MB at most, as a run on one rank prints them; 0 where it prints none."""
    done = subprocess.run([squeal, "-options_file", SOURCE / f"options/{scene}.yaml", "-output_dir", folder, "-squeal_view"],
                          capture_output=True, text=True, check=False)
    peak = re.search(r"^the most at any time +(\d+)$", done.stdout, re.MULTILINE)
    print(done.stderr, end="")
    return int(peak[1]) if peak else 0


def modes_are_lean(squeal, folder):
    """Whether the modes of the default scene take no more than they need."""
    peak = peak_of(squeal, "massi2005", folder)
    print(f"modes of the default scene: {peak} MB, at most {MOST}")
    return 0 < peak <= MOST


def peak_is_own(squeal, folder):
    """Whether a small run prints less than its parent had."""
    held = bytearray(PARENT)
    held[::4096] = b"1" * len(held[::4096])
    peak = peak_of(squeal, "oscillator", folder)
    print(f"memory printed beside a parent of {len(held) / 1e6:.0f} MB: {peak} MB")
    return 0 < peak < 0.5 * len(held) / 1e6


def main():
    failed, succeeded = 0, []
    with tempfile.TemporaryDirectory() as folder:
        failed += not peak_is_own(Path(sys.argv[1]).resolve(), folder)
        failed += not modes_are_lean(Path(sys.argv[1]).resolve(), folder)
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
