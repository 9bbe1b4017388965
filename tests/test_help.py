#!/usr/bin/env python3
"""What squeal says of itself before it computes: -h, --help, -version, --version, -help, no arguments, typing errors.
Breaks when PETSc's own help or version shows instead, when a rank more than the first answers, when a pipe that is
closed early makes a trace, when a typing error prints more than one line, or when slow kernels of the BLAS
are not told.

    test_help.py SQUEAL MPIRUN"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1]
VERSION = re.search(r"version: '([\d.]+)'", (SOURCE / "meson.build").read_text())[1]
SCENE = ["-options_file", SOURCE / "options/oscillator.yaml"]
# What one types wrong: words of the one line that answers
TYPOS = {
    "-contact_muu 1": "-contact_muu; the nearest valid one is -contact_mu",
    "-modez_band 1,2": "-modez_band; the nearest valid one is -modes_band",
    "-output_dri out": "-output_dri; the nearest valid one is -output_dir",
    "-analysis modez": "modez.*modes sweep static transient",
    "-options_file oscilator.yaml": "oscilator.yaml",
}
# An option of each room that -help must show, with its default
SHOWN = {"analysis": "modes", "model_mesh": "", "rig_disc_elements": "21,100,3", "part_young": "", "support_fix": "xyz",
         "spring_stiffness": "", "contact_law": "penalty", "motion_ramp": "0", "modes_band": "0,0", "sweep_rtol": "1e-06",
         "static_rows": "0", "dynamics_start": "rest", "output_dir": "results",
         "squeal_view": "FALSE", "modes_view": "", "probes": "", "ts_central_b": "0.5"}


class Asker:
    """Runs the program in an empty folder, without options from elsewhere, and keeps what is wrong."""

    def __init__(self, squeal, mpirun, folder):
        self.squeal, self.mpirun, self.folder, self.faults = squeal, mpirun, folder, []

    def ask(self, *options, ranks=None, kernels=None):
        launch = [self.mpirun, "-n", str(ranks)] if ranks else []
        environment = dict(os.environ)
        if kernels is not None:
            environment.pop("OPENBLAS_CORETYPE", None)
        if kernels:
            environment["OPENBLAS_CORETYPE"] = kernels
        return subprocess.run([*launch, self.squeal, *options], capture_output=True, text=True, cwd=self.folder, env=environment)

    def check(self, holds, what, done):
        print("ok  " if holds else "FAIL", what)
        if not holds:
            self.faults.append(what)
            print(done.stdout[:500] + done.stderr)


def check_short(a):
    first = f"squeal {VERSION}: "
    for word in ("-h", "--help", "-version", "--version"):
        done = a.ask(word)
        a.check(done.returncode == 0 and not done.stderr and done.stdout.startswith(first), f"{word} begins with {first}", done)
        lines = done.stdout.splitlines()
        a.check(len(lines) == 2 if "version" in word else 12 < len(lines) <= 24, f"{word}: {len(lines)} lines", done)
        a.check(max(map(len, lines)) <= 120, f"{word}: no long line", done)
    done = a.ask("--version", ranks=2)
    a.check(done.stdout.count("PETSc 3.") == 1 and "MUMPS" in done.stdout, "two ranks answer once", done)
    done = a.ask("-h")
    options = re.findall(r"^  -(\w+)", done.stdout, re.MULTILINE)
    a.check(len(options) == 10, f"{len(options)} options most used", done)
    done = a.ask()
    a.check(done.returncode == 1 and done.stdout.startswith(first) and done.stdout.count("\n") < 10, "no arguments: usage", done)
    a.check(done.stderr.count("\n") == 1, "no arguments: one line of error", done)


def check_kernels(a):
    """The kernels of OpenBLAS are those that it is told to take. Where it chooses old ones by itself, -squeal_view and
    scripts/setup.sh, which look at the processor each in its own way, advise the same."""
    done = a.ask("--version", kernels="Nehalem")
    a.check("OpenBLAS" not in done.stdout or re.search(r"OpenBLAS [\d.]+ \(Nehalem\)", done.stdout), "kernels are told", done)
    done = a.ask(*SCENE, "-squeal_view", "-output_dir", "out", kernels="")
    advised = re.search(r"runs old kernels; OPENBLAS_CORETYPE=(\w+)", done.stdout)
    choose = 'source "$0"; unset OPENBLAS_CORETYPE; build=$1; check_blas 2>/dev/null; echo "${OPENBLAS_CORETYPE-}"'
    chosen = subprocess.run(["bash", "-c", choose, SOURCE / "scripts/setup.sh", a.squeal.parent], capture_output=True, text=True)
    a.check(done.returncode == 0 and chosen.stdout.split() == (list(advised.groups()) if advised else []),
            f"advised {advised and advised[1]}, chosen {chosen.stdout.strip()}", done)
    known = subprocess.run(["bash", "-c", 'source "$0"; wide_kernels', SOURCE / "scripts/setup.sh"], capture_output=True, text=True)
    a.check('"Haswell", ' in known.stdout and '"SkylakeX", ' in known.stdout, "scripts/setup.sh reads the program's list", known)
    shutil.rmtree(a.folder / "out")


def check_list(a):
    done = a.ask("-help")
    found = dict(re.findall(r"^  -(\w+) +(?!  )(.*)$", done.stdout, re.MULTILINE))
    a.check(done.returncode == 0 and not done.stderr and "KSP" not in done.stdout, "-help is squeal's", done)
    for name, default in SHOWN.items():
        line = re.search(rf"^  -{name} .*$", done.stdout, re.MULTILINE)
        shows = line and line[0].split()[1] == default if default else line
        a.check(shows, f"-help shows -{name} {default}", done)
    names = re.findall(r"^  -(\w+)", done.stdout, re.MULTILINE)
    a.check(len(names) == len(set(names)) > 100 and found, f"-help shows {len(names)} options once each", done)
    done = a.ask(*SCENE, "-contact_mu", "0.25", "-help")
    a.check(re.search(r"-contact_mu +0.25 .*\[default 0\]", done.stdout), "-help of a scene: its value and the default", done)
    done = a.ask("-help_all")
    a.check("-eps_nev" in done.stdout or "-ts_max_time" in done.stdout, "-help_all shows PETSc's", done)
    names = re.findall(r"^  -(\w+)", done.stdout, re.MULTILINE)
    a.check(len(names) == len(set(names)) > 700, f"-help_all shows {len(names)} options once each", done)
    line = f"set -o pipefail; '{a.squeal}' -help | head -n 1; echo ${{PIPESTATUS[1]}}"
    done = subprocess.run(["bash", "-c", line], capture_output=True, text=True, cwd=a.folder)
    a.check(not done.stderr and done.stdout.endswith("0\n"), "-help | head ends without a trace", done)


def check_typos(a):
    for options, words in TYPOS.items():
        scene = [] if "options_file" in options else SCENE
        done = a.ask(*scene, *options.split())
        lines = done.stderr.splitlines()
        a.check(done.returncode == 1 and len(lines) == 1 and re.search(words, lines[0]) and not done.stdout,
                f"{options}: one line with '{words}'", done)


def check_ranks(a):
    """scripts/mpirun refuses what is no number of ranks, and what would stop the machine, with one line."""
    for ranks in ("0", "x", "99999"):
        done = a.ask("--version", ranks=ranks)
        a.check(done.returncode == 2 and re.fullmatch(rf"mpirun: -n '{ranks}' must be .*\n", done.stderr) and not done.stdout,
                f"-n {ranks}: one line", done)


def main():
    squeal, mpirun = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    with tempfile.TemporaryDirectory(prefix="squeal-") as folder:
        a = Asker(squeal, mpirun, Path(folder))
        check_short(a)
        check_kernels(a)
        check_list(a)
        check_typos(a)
        check_ranks(a)
        left = [path.name for path in a.folder.iterdir()]
        a.check(not left, f"no file is left {left}", a.ask("--version"))
    if a.faults:
        print(f"{len(a.faults)} failed: {'; '.join(a.faults)}")
    return 1 if a.faults else 0


if __name__ == "__main__":
    sys.exit(main())
