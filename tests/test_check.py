#!/usr/bin/env python3
"""The checks of tests/check.py on made-up tables: what is not finite passes none. Breaks when bounds are compared with min()
and max() alone, of which a nan is neither. And what tests/run.py takes for the program's own words. Exit status: 0, or 1."""

import sys
import tempfile
from pathlib import Path
from types import SimpleNamespace

from check import Checker, Failure, Line, measured_in, worst_of
from run import own_words

CHECKS = ({"min": 0}, {"max": 10}, {"min": 0, "max": 10}, {"equals": [1, 2, 3], "rtol": 1}, {"equals_run": "run", "rtol": 1})


def passes(folder, cell, check):
    """Whether a table of three values, of which the second is the cell, passes the check."""
    (folder / "modes.csv").write_text(f"freq_hz\n1\n{cell}\n3\n")
    runner = SimpleNamespace(output=lambda name: folder, case={"run": {"run": {}}})
    try:
        Checker(runner, runner).make({"run": "run", "column": "freq_hz", **check})
    except Failure:
        return False
    return True


def own(remark):
    """Whether of a line after a remark of mpirun, and of that remark's end, only the line is left."""
    return own_words(f"{remark}squeal: error: 1\n").strip("\n") == "squeal: error: 1"


def margins_fail():
    """How many of the numbers that scripts/study/hard lists are not those of the check that uses most of what is allowed."""
    text = "measured 2e-3, allowed 1e-2\nmeasured 3e-5, allowed 1e-4\n"
    lines = [Line("5 rows"), Line.of("a", 0.2, 1), Line.of("b", 3e-5, 1e-4)]
    of = {"used": worst_of(lines).allowed == 1e-4, "said": measured_in(text).measured == 3e-5,
          "none": worst_of(lines[:1]).measured is None, "nothing allowed": worst_of([*lines, Line.of("c", 1e-30, 0)]).allowed == 0}
    for name in (wrong := [name for name, right in of.items() if not right]):
        print(f"FAILED margin: {name}")
    return len(wrong)


def main():
    rule = 60 * "-"
    remarks = ("", f"{rule}\nabort\n{rule}\n", f"{rule}\nabort\n{rule}\n\0", f"\0{rule}\nabort\n{rule}\n")
    failed = [own(remark) for remark in remarks].count(False) + margins_fail()
    with tempfile.TemporaryDirectory() as name:
        for check in CHECKS:
            for cell, expected in (("2", True), ("nan", False), ("inf", False), ("-inf", False)):
                if passes(Path(name), cell, check) != expected:
                    print(f"FAILED {check}: a table with {cell} {'fails' if expected else 'passes'}")
                    failed += 1
    print(f"{failed} of {len(remarks) + 4 + 4 * len(CHECKS)} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
