#!/usr/bin/env python3
"""The checks of tests/check.py on made-up tables: what is not finite passes none. Breaks when bounds are compared with min()
and max() alone, of which a nan is neither. What tests/run.py takes for the program's own words. And that each case with runs of the
night has a test there, which makes them beside those of the day; that of another program or library of faults nothing has passed yet.
Exit status: 0, or 1."""

import re
import sys
import tempfile
import tomllib
from pathlib import Path
from types import SimpleNamespace

from check import Checker, Failure, Line, measured_in, worst_of
from keys import fault_of_keys
from passed import Passed
from ranks import fault_of_ranks, ranks_of_runs
from served import own_words

CHECKS = ({"min": 0}, {"max": 10}, {"min": 0, "max": 10}, {"equals": [1, 2, 3], "rtol": 1}, {"equals_run": "run", "rtol": 1})
EMPTY = (([1, 2], {}, False), ([1], {}, True), ([1, 2], {"ranks": [1]}, True), ([1], {"night": [2]}, False), ([1], {"ranks": [1, 2]}, True))


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


def nights_fail():
    """How many cases with runs of the night have no test there, or lose one of them."""
    tests, wrong = Path(__file__).resolve().parent, []
    named = set(re.findall(r"\['(\w+)', \d+, 'night'\]", (tests / "meson.build").read_text()))
    for path in sorted((tests / "cases").glob("*.toml")):
        case = tomllib.loads(path.read_text())
        chosen, nights = case.get("ranks", [1]), {name: run["night"] for name, run in case["run"].items() if "night" in run}
        fault = fault_of_keys(case) or fault_of_ranks(case)
        made = set(ranks_of_runs(case, chosen, True))
        lost = [name for name, ranks in nights.items() if not set(ranks) <= made & set(case["run"][name]["ranks"])]
        if bool(nights) != (path.stem in named) or fault or lost:
            wrong.append(path.stem)
    for name in wrong:
        print(f"FAILED night of {name}")
    return len(wrong)


def empty_pass():
    """How many comparisons of ranks that nothing makes, by day or by night, are not refused, or are when something does."""
    wrong = [(ranks, run) for ranks, run, fault in EMPTY
             if bool(fault_of_ranks({"ranks": ranks, "run": {"a": run}, "check": [{"across_ranks": True}]})) != fault]
    apart = {"ranks": [1, 3], "run": {"a": {"ranks": [1]}, "b": {"ranks": [3]}}, "check": [{"command": "same {a} {b}"}]}
    wrong += [] if fault_of_ranks(apart) else [([1, 3], "a on 1 beside b on 3")]
    nowhere = {"ranks": [1, 2], "run": {"a": {"ranks": [1]}}, "check": [{"max": 1, "ranks": [2]}]}
    wrong += [] if fault_of_ranks(nowhere) else [([1, 2], "a on 1, checked on 2")]
    for ranks, run in wrong:
        print(f"FAILED ranks {ranks}, run {run}")
    return len(wrong)


def misspelt_pass():
    """How many cases without runs, and names that nothing reads in a case, a run and a check, are not refused."""
    right = {"run": {"a": {"options": ""}}, "check": [{"max": 1}]}
    cases = [{"check": [{"max": 1}]}, {**right, "run": {}},
             {**right, "runs": [{}]}, {**right, "run": {"a": {"option": ""}}}, {**right, "check": [{"maxx": 1}]}]
    wrong = [case for case in cases if not fault_of_keys(case)] + ([right] if fault_of_keys(right) else [])
    for case in wrong:
        print(f"FAILED names of {case}")
    return len(wrong)


def passed_of_others(folder):
    """How many of the files that decide whether a stopped test goes on let it go on when they have changed, or not when none has."""
    path, program, library = (folder / name for name in ("passed", "program", "library"))
    wrong = 0
    for changed in (None, program, library):
        program.write_bytes(b"1")
        library.write_bytes(b"1")
        path.unlink(missing_ok=True)
        Passed(path, program, library).add("a call")
        if changed:
            changed.write_bytes(b"2")
        if ("a call" in Passed(path, program, library)) == bool(changed):
            print(f"FAILED what passed, {changed and changed.name} changed")
            wrong += 1
    return wrong


def main():
    rule = 60 * "-"
    remarks = ("", f"{rule}\nabort\n{rule}\n", f"{rule}\nabort\n{rule}\n\0", f"\0{rule}\nabort\n{rule}\n")
    failed = [own(remark) for remark in remarks].count(False) + margins_fail() + nights_fail() + empty_pass() + misspelt_pass()
    with tempfile.TemporaryDirectory() as name:
        failed += passed_of_others(Path(name))
        for check in CHECKS:
            for cell, expected in (("2", True), ("nan", False), ("inf", False), ("-inf", False)):
                if passes(Path(name), cell, check) != expected:
                    print(f"FAILED {check}: a table with {cell} {'fails' if expected else 'passes'}")
                    failed += 1
    print(f"{failed} of {len(remarks) + 11 + len(EMPTY) + 4 * len(CHECKS)} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
