#!/usr/bin/env python3
"""The pages in options/reference have every option that the program tells by -help_json, with its default, unit, meaning and choices, as
scripts/manual --reference writes them, and an example of its own for each. Breaks when an option or a default changes and the
pages do not. -help shows the same options with the same sentences. What rows say may vary is what sweeps and maps offer.

    test_options.py SQUEAL"""

import difflib
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(SOURCE / "scripts"))
from squeal.options import ask, options_of

PAGES = SOURCE / "options/reference"
VARIED = ["-options_file", SOURCE / "options/massi2005_reduced.yaml", "-rig_disc_elements", "4,24,1", "-rig_pad_elements", "2,2,1",
          "-rig_beam_elements", "3", "-contact_force", "10", "-contact_friction_damping"]
# What could vary in that scene, were it given
ABSENT = re.compile(r"(^|_)(spin|\w+_(total|per_area)|moment|tension|shortening|pressure|pressure_(c0|p0|k|m)|kn|kt|"
                    r"rotation|thickness|wear_(rate|rate_master|time)|loss_factor|prony_(modulus|time)|zener_(modulus|time|order)|"
                    r"table_temperature|"
                    r"mu_(static|kinetic|decay_speed|viscous|stribeck_speed|factor))$")


def text_of(folder):
    """All pages of a folder."""
    return "\n".join(page.read_text() for page in sorted(folder.glob("*.md")))


def written(squeal, folder):
    """The pages as they would be written now."""
    shutil.copytree(PAGES, folder)
    subprocess.run([sys.executable, SOURCE / "scripts/manual", "--reference", folder, squeal], capture_output=True, text=True,
                   cwd=folder, check=True)
    return text_of(folder)


def faults_of(squeal, folder):
    """What is wrong with the pages, and with -help."""
    options = options_of([squeal], folder=folder)
    now = written(squeal, Path(folder) / "reference")
    yield from difflib.unified_diff(text_of(PAGES).splitlines(), now.splitlines(), "pages", "program", lineterm="", n=0)
    for name, example in re.findall(r"^\| `-(\w+)` \|.*\| `(.*)` \|$", now, re.MULTILINE):
        if not re.match(rf"-{name}( \S|$)", example):
            yield f"-{name}: '{example}' is no example of it"
    told = [option.name for option in options]
    shown = ask([squeal], "-help", folder=folder)
    yield from (f"-{name} is told {told.count(name)} times" for name in set(told) if told.count(name) > 1)
    for option in options:
        line = re.search(rf"^  -{option.name} .*$", shown, re.MULTILINE)
        if not line or option.help.partition(" (")[0].partition(";")[0] not in line[0] or (option.unit or "") not in line[0]:
            yield f"-{option.name} is not in -help as in its row"
    if len(told) < 200 or len(re.findall(r"^  -\w", shown, re.MULTILINE)) != len(told):
        yield f"{len(told)} options told, others shown"


def varied_faults(squeal, folder):
    """What rows say of parameters, beside what a sweep and a map offer."""
    told = [option for option in options_of([squeal], *VARIED, folder=folder) if not ABSENT.search(option.name)]
    for analysis in ("sweep", "map"):
        given = VARIED if analysis == "sweep" else VARIED[:-3]
        done = subprocess.run([squeal, *given, "-analysis", analysis, f"-{analysis}_parameter", "none", f"-{analysis}_values", "0,1"],
                              capture_output=True, text=True, cwd=folder, check=False)
        offered = set(done.stderr.rpartition("valid are ")[2].split(", ")) if "valid are" in done.stderr else set()
        rows = {option.name for option in told if analysis in option.varies}
        if {name.strip() for name in offered} != rows or len(rows) < 15:
            yield f"{analysis}: rows say that {sorted(rows)} vary; {done.stderr}"


def main():
    with tempfile.TemporaryDirectory() as folder:
        squeal = Path(sys.argv[1]).resolve()
        faults = [*faults_of(squeal, folder), *varied_faults(squeal, folder)]
    print("\n".join(faults) or "the pages are those of the program")
    if faults:
        print("to write the tables anew, with empty examples for new options: scripts/manual --reference options/reference PROGRAM")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
