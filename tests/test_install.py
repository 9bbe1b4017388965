#!/usr/bin/env python3
"""What is installed works from wherever its prefix is moved to, without the folder of the sources or of the build:

  library     tests/library/onset.c, built with the flags of squeal.pc alone, where PKG_CONFIG_PATH has that one file only:
              it prints the modes that the installed program writes, and its errors are one line
  scripts     every script of scripts/plot and each on top that is not for the sources alone is there as squeal-NAME, answers
              --help, and those for modes make their files from results of the installed program
  manual      every option stands in squeal.1, with its default; man has no warning
  completion  bash is offered the options of the program, the names of a scene, the words of a choice, files
  scenes      of each scene that reads a mesh the line in its head makes the mesh, and the scene runs (not the brake of 50,000
              unknowns, of which test_brake_mesh.py is)
  paths       no text names the folders of sources or build
  sources     nothing that Python compiles beside its sources is installed

Breaks when a header is missing or needs one of src, when a library is not named, when a script is forgotten, or when a folder of
scripts/squeal has its __pycache__ installed.

    test_install.py MESON BUILD MPIRUN"""

import compileall
import csv
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(SOURCE / "scripts"))
from forked import run_command
from small_brake import SCENE as BRAKE
from squeal.options import default_of, options_of

FOR_SOURCES = {"margins", "run", "test", "test_sanitized", "test_debian", "coverage", "lint", "setup.sh", "paper", "manual", "packages.txt",
               "completion.bash", "README.md", "python.md", "correlate.md", "import.md", "site"}
FIRST_LINES = ("#!/usr/bin/python3", "#!/usr/bin/env bash")
SCENE = BRAKE + """modes: {band: "500,9000", contact: all}
"""


class Faults(list):
    """What is wrong, printed as it is found."""

    def check(self, holds, what):
        print("ok  " if holds else "FAIL", what)
        if not holds:
            self.append(what)


def run(*command, **more):
    """Output of a command that must succeed."""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, **more)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done.stdout


def check_library(top, place, mpirun, faults):
    """The example, against the table of the program."""
    pc = next(place.rglob("squeal.pc"))
    env = {key: value for key, value in os.environ.items() if key != "PKG_CONFIG_PATH"}
    fixed = re.search(r"^prefix=(/.*)$", pc.read_text(), re.MULTILINE)
    if fixed:
        print("note: this build was set up before its pkg-config file could be moved; meson configure -Dpkgconfig.relocatable=true")
        pc.write_text(pc.read_text().replace(fixed[0], f"prefix={place}{fixed[1]}"))
    flags = run("pkg-config", "--cflags", "--libs", "squeal", env=env | {"PKG_CONFIG_PATH": str(pc.parent)}).split()
    shutil.copy(SOURCE / "tests/library/onset.c", top)
    run("cc", "-std=c17", "-Wall", "-Wextra", "-Werror", "onset.c", *flags, "-o", "onset", cwd=top)
    shown = run(mpirun, "-n", 1, top / "onset", "-options_file", "scene.yaml", "-mu_values", "0,0.9", cwd=top)
    rows = [line.split(", ") for line in shown.splitlines()]
    with (top / "out/modes.csv").open(newline="") as lines:
        wanted = [(float(row["freq_hz"]), float(row["growth_rad_s"])) for row in csv.DictReader(lines)]
    found = [(float(row[1]), float(row[2])) for row in rows if float(row[0]) > 0]
    same = len(found) == len(wanted) and all(abs(a - b) < 1e-9 * f[0] for f, w in zip(found, wanted) for a, b in zip(f, w))
    grown = max(row[1] for row in wanted)
    faults.check(same and grown > 1, f"library: {len(found)} modes as in modes.csv, one of which grows by {grown:.1f} 1/s")
    still = [abs(float(row[2])) < 1e-6 * float(row[1]) for row in rows if float(row[0]) == 0]
    faults.check(still and all(still), f"library: none of {len(still)} grows without friction")
    for words, said in ((("-options_file", "scene.yaml"), "-mu_values is missing"), (("-options_file", "no.yaml"), "no.yaml")):
        done = subprocess.run([mpirun, "-n", "1", top / "onset", *words], capture_output=True, text=True, cwd=top, check=False)
        faults.check(done.returncode == 1 and said in done.stderr and done.stderr.count("\n") == 1, f"library: one line on {said}")


def check_scripts(top, bin_dir, faults):
    """All are there and begin; pictures and exports of a run."""
    on_top = {path.name for path in (SOURCE / "scripts").iterdir() if path.is_file()} - FOR_SOURCES
    plots = {f"plot-{path.name}" for path in (SOURCE / "scripts/plot").iterdir() if path.is_file()}
    started = set()
    for name in sorted(on_top | plots):
        program = bin_dir / f"squeal-{name.replace('_', '-')}"
        if not program.exists():
            faults.check(False, f"scripts: {program.name} is missing")
            continue
        begins = program.open("rb").readline().decode().strip()
        faults.check(os.access(program, os.X_OK) and begins in FIRST_LINES, f"scripts: {program.name} can be started, by {begins}")
        if name == "mpirun":  # which main() starts, a script of bash
            continue
        done = run_command([program, "--help"], top) if begins in started else \
            subprocess.run([program, "--help"], capture_output=True, text=True, cwd=top, check=False)
        faults.check(not done.returncode and "usage" in done.stdout,
                     f"scripts: {program.name} --help{'' if begins in started else ', by its first line'}")
        started.add(begins)
    faults.check(FIRST_LINES[0] in started, f"scripts: by their first lines {', '.join(sorted(started))}")
    for words in (["squeal-plot-modes", "-o", "modes.png", "out"], ["squeal-report", "out"]):
        file = top / run(bin_dir / words[0], *words[1:], cwd=top).strip()
        faults.check(file.stat().st_size > 10000, f"scripts: {' '.join(words)} writes {file.name}")
    page = (top / "out/report.html").read_text()
    faults.check("squeal-plot-modes out" in page and "scripts/plot" not in page, "scripts: the page names installed ones")
    for program in sorted({"squeal-plot-modes", "squeal-report"}):
        done = subprocess.run([bin_dir / program, "nowhere"], capture_output=True, text=True, cwd=top, check=False)
        faults.check(done.returncode == 1 and done.stderr.count("\n") == 1,
                     f"scripts: {program} has one line for a folder that is not there")


def check_manual(place, squeal, faults):
    """The page beside what the program that is installed tells of its options."""
    page = next(place.rglob("man1/squeal.1"))
    options = options_of(squeal if isinstance(squeal, list) else [squeal], folder=place)
    text = page.read_text().replace("\\-", "-").replace("\\(aq", "'")
    lost = [option.name for option in options if f".B -{option.name}\n" not in text
            or f"[default {default_of(option)}]" not in "[default ]" + text.partition(f".B -{option.name}\n")[2].partition(".TP")[0]]
    faults.check(len(options) > 150 and not lost, f"manual: {len(options)} options with their defaults, missing {lost}")
    if shutil.which("man"):
        done = subprocess.run(["man", "-l", "--warnings", page], capture_output=True, text=True, check=False,
                              env=os.environ | {"LC_ALL": "C", "MANWIDTH": "100"})
        faults.check(not done.returncode and not done.stderr and "-contact_mu" in done.stdout, f"manual: man shows it {done.stderr}")


def check_completion(top, place, squeal, faults):
    """What bash is offered for the last word."""
    file = next(place.rglob("completions/squeal"))
    script = f"""set -u; source '{file}'; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _squeal; printf '%s\\n' "${{COMPREPLY[@]}}" """
    for words, wanted, absent in (
            (["-analy"], {"-analysis"}, {"-contact_mu"}),
            (["-analysis", ""], {"modes", "sweep", "static", "transient", "frf"}, {"-analysis"}),
            (["-options_file", "scene.yaml", "-pad_y"], {"-pad_young"}, {"-part_young"}),
            (["-options_file", "sc"], {"scene.yaml"}, {"scene.txt"}),
            (["-output_dir", "o"], {"out"}, {"onset"}),
            (["-output_fields", "f"], {"false"}, {"true"}),
            (["-options_file", "no.yaml", "-modes_ba"], {"-modes_band"}, set())):
        offered = set(run("bash", "-c", script, "bash", squeal, *words, cwd=top).split())
        faults.check(wanted <= offered and not absent & offered, f"completion: {' '.join(words)} gives {' '.join(sorted(wanted))}")


def install(meson, build, place):
    """Installs below `place` from sources that Python has compiled, whatever PYTHONDONTWRITEBYTECODE says."""
    compileall.compile_dir(SOURCE / "scripts/squeal", quiet=1)
    run(meson, "install", "-C", build, "--no-rebuild", "--quiet", "--destdir", place)
    return place


def check_sources(place, faults):
    """Folders of Python's own, before a script of the prefix has run."""
    compiled = [str(path.relative_to(place)) for path in place.rglob("__pycache__")]
    faults.check(not compiled, f"sources: no folder that Python compiles into, but {compiled}")


def check_scenes(place, squeal, faults):
    """A mesh as the head of its scene says, and a run of that scene, in time no longer than a step or two."""
    share = next(place.rglob("share/squeal"))
    if not shutil.which("gmsh"):
        print("skipped: scenes, no gmsh, of scripts/packages.txt")
        return
    for scene in sorted(share.glob("options/*.yaml")):
        text = scene.read_text()
        mesh = re.search(r"^model: {mesh: ([^,}]+)", text, re.MULTILINE)
        if not mesh or scene.stem in ("brake", "fist_brake"):
            continue
        making = re.search(r"^#   (gmsh .*)$", text, re.MULTILINE)
        faults.check(making, f"scenes: {scene.name} says how {mesh[1]} is made")
        if making:
            run(*making[1].split(), cwd=share)
            words = ("-ts_max_time", 1e-6) if "analysis: transient" in text else ()
            run(*squeal, "-options_file", scene, "-output_dir", place / scene.stem, *words, cwd=share)
            faults.check((place / scene.stem / "scene.yaml").is_file(), f"scenes: {scene.name} with {mesh[1]}")


def check_paths(place, build, faults):
    """Words of the build in files that are text."""
    for path in sorted(place.rglob("*")):
        if path.is_symlink():
            faults.check(not os.path.isabs(os.readlink(path)) and path.exists(), f"paths: {path.name} is a link within the prefix")
        elif path.is_file() and path.suffix not in (".a", ".png") and path.name != "squeal":
            if any(str(folder) in path.read_text(errors="replace") for folder in (build, SOURCE)):
                faults.check(False, f"paths: {path.relative_to(place)} names the folder of sources or build")


def main():
    meson, build, mpirun = sys.argv[1], *(Path(name).resolve() for name in sys.argv[2:])
    faults = Faults()
    with tempfile.TemporaryDirectory() as folder:
        top = Path(folder)
        place = install(meson, build, top / "first").rename(top / "moved")
        check_sources(place, faults)
        bin_dir = next(place.rglob("bin"))
        for name in ("scene.yaml", "scene.txt"):
            (top / name).write_text(SCENE)
        run(bin_dir / "squeal-mpirun", "-n", 1, bin_dir / "squeal", "-options_file", "scene.yaml", "-output_dir", "out", cwd=top)
        squeal = [bin_dir / "squeal-mpirun", "-n", "1", bin_dir / "squeal"]
        check_library(top, place, mpirun, faults)
        check_scripts(top, bin_dir, faults)
        check_manual(place, squeal, faults)
        check_completion(top, place, bin_dir / "squeal", faults)
        check_paths(place, build, faults)
        check_scenes(place, squeal, faults)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
