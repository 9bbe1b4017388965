#!/usr/bin/env python3
"""options/README.md has every option that the program tells by -help_json, with its default, unit, meaning and choices, as
scripts/manual --reference writes them, and an example of its own for each. Breaks when an option or a default changes and the
page does not. -help shows the same options with the same sentences.

    test_options.py SQUEAL"""

import difflib
import re
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(SOURCE / "scripts"))
from squeal.options import ask, options_of

PAGE = SOURCE / "options/README.md"


def faults_of(squeal, folder):
    """What is wrong with the page, and with -help."""
    options = options_of([squeal], folder=folder)
    text = PAGE.read_text()
    now = subprocess.run([sys.executable, SOURCE / "scripts/manual", "--reference", PAGE, squeal], capture_output=True, text=True,
                         cwd=folder, check=True).stdout
    yield from (line for line in difflib.unified_diff(text.splitlines(), now.splitlines(), "page", "program", lineterm="", n=0))
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


def main():
    with tempfile.TemporaryDirectory() as folder:
        faults = list(faults_of(Path(sys.argv[1]).resolve(), folder))
    print("\n".join(faults) or "the page is that of the program")
    if faults:
        print("to write the tables anew, with empty examples for new options: scripts/manual --reference options/README.md PROGRAM")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
