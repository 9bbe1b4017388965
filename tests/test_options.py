#!/usr/bin/env python3
"""Every option that `squeal -help` lists stands in options/README.md with its default, its meaning and an example of its
own, and the other way round. Breaks when an option or a default changes and the page does not.

    test_options.py SQUEAL"""

import re
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
from squeal.help_text import ask, options_of

PAGE = Path(__file__).resolve().parents[1] / "options/README.md"


def of_help(squeal):
    """Name -> (default, text) as -help prints them."""
    with tempfile.TemporaryDirectory() as folder:
        return {option.name: (option.default, option.text) for option in options_of(ask([squeal], "-help", folder=folder))}


def of_page():
    """The same of the page, with the example."""
    row = re.compile(r"^\| `-(\w+)` \| (?:`([^`]*)`)? *\| (.*) \| `(.*)` \|$")
    found = [row.match(line) for line in PAGE.read_text().splitlines()]
    return [(match[1], match[2] or "", match[3], match[4]) for match in found if match]


def main():
    help_options, rows = of_help(Path(sys.argv[1]).resolve()), of_page()
    faults = [f"-{name} stands twice" for name in {row[0] for row in rows} if [row[0] for row in rows].count(name) > 1]
    faults += [f"-{name} is not in the page" for name in help_options if name not in {row[0] for row in rows}]
    for name, default, meaning, example in rows:
        if name not in help_options:
            faults.append(f"-{name} of the page is no option")
        elif default != help_options[name][0]:
            faults.append(f"-{name}: default {default} in the page, {help_options[name][0]} in squeal")
        elif meaning != help_options[name][1].replace("|", "or"):
            faults.append(f"-{name}: '{meaning}' in the page, '{help_options[name][1]}' in squeal")
        elif not re.match(rf"-{name}( \S|$)", example):
            faults.append(f"-{name}: '{example}' is no example of it")
    print("\n".join(faults) or f"{len(rows)} options")
    return 1 if faults or len(rows) < 100 else 0


if __name__ == "__main__":
    sys.exit(main())
