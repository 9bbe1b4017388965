#!/usr/bin/env python3
"""scripts/margins on a made-up log of meson test: the check nearest to its limit of each form of line, checks without numbers left out,
and one line for a test that failed, a file that is no log, and a log without numbers. Breaks when a form of line changes."""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
APPLICATION = """ok     run flutter on 1, 0.1 s: as expected
ok     far |x| on 1, 0.0 s: 6 values, worst 1 for 1, error 1e-12, allowed 1e-09; more
ok     near on 2, 0.0 s: 6 values, worst -2 for -2, error 4e-10, allowed 1e-09
ok     texts on 2, 0.0 s: 6 texts equal
ok     scipy: 3.5e-10 from the reference, 1e-08 allowed"""
UNIT = """ok   roots                                            1.5, expected 1.25 +- 1.0e+00
ok   count                                            3, expected 3 +- 0.0e+00
phase: measured 0.02, allowed 0.04
0 failed"""
EXPECTED = {"margins.md": "| `one` | 3 | near | 4.0e-10 | 1.0e-09 |", "margins_unit.md": "| `two-1` | 3 | phase | 2.0e-02 | 4.0e-02 |"}


def margins(folder, *tests):
    """What the script says of a log of tests, given as suite and name, output, result."""
    log = folder / "testlog.json"
    log.write_text("\n".join(json.dumps({"name": f"squeal:{name}", "stdout": text, "result": result}) for name, text, result in tests))
    done = subprocess.run([SOURCE / "scripts/margins", log, "--folder", folder], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def faults(folder):
    """What is not as it should be."""
    status, said = margins(folder, ("application / one", APPLICATION, "OK"), ("unit / two-1", UNIT, "OK"), ("script / no", "ok", "OK"))
    if status or not said.startswith("2 tests, 6 checks; nearest to its limit: two-1, 0.5 of it"):
        yield f"both pages: {said}"
    for name, row in EXPECTED.items():
        rows = [line for line in (folder / name).read_text().splitlines() if line.startswith("| `")]
        if rows != [row]:
            yield f"{name}: {rows}"
    for tests, why in (((("unit / two-1", UNIT, "FAIL"),), "test two-1 is FAIL"), ((("unit / no", "ok", "OK"),), "no test in it compares")):
        status, said = margins(folder, *tests)
        if not status or why not in said or len(said.splitlines()) != 1:
            yield f"{why}: {status}, {said}"
    (folder / "testlog.json").write_text("{")
    done = subprocess.run([SOURCE / "scripts/margins", folder / "testlog.json"], capture_output=True, text=True, check=False)
    if not done.returncode or "no log of meson test" not in done.stderr or len(done.stderr.splitlines()) != 1:
        yield f"no log: {done.stderr}"


def main():
    with tempfile.TemporaryDirectory() as folder:
        found = list(faults(Path(folder)))
    print("\n".join(found) or "margins as the log has them")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
