#!/usr/bin/env python3
"""Processor time of each test, which other work on the machine changes less than the time on the clock.

usage: tests/times.py LOG [COUNT]       the longest of a testlog.json of `scripts/test --times`, which Meson writes
       tests/times.py run COMMAND...    runs a command, and ends with a line about the processor time of all its processes

`scripts/test --times` has Meson put the second form before each test and prints the first at the end."""

import json
import re
import resource
import subprocess
import sys
from pathlib import Path

LINE = "processor time {:.2f} s"
LINE_AGAIN = re.compile(r"^processor time ([0-9.]+) s$", re.MULTILINE)
COUNT = 10


def run(command):
    """Exit status of a command whose processor time is printed."""
    status = subprocess.run(command, check=False).returncode
    spent = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(LINE.format(spent.ru_utime + spent.ru_stime), flush=True)
    return status if status >= 0 else 128 - status


def read(log):
    """(processor time, time on the clock, name) of each test of a log, longest first."""
    tests = []
    for line in log.read_text().splitlines():
        test = json.loads(line)
        found = LINE_AGAIN.findall(test.get("stdout", ""))
        tests.append((float(found[-1]) if found else 0.0, test["duration"], test["name"].split(" / ")[-1]))
    return sorted(tests, reverse=True)


def table(log, count):
    """The longest tests, and the sum of all."""
    tests = read(log)
    print(f"{'test':32}{'processor s':>12}{'clock s':>10}")
    for spent, clock, name in tests[:count]:
        print(f"{name:32}{spent:12.1f}{clock:10.1f}")
    print(f"{f'all {len(tests)}':32}{sum(test[0] for test in tests):12.1f}")
    return 0


def main():
    arguments = sys.argv[1:]
    if not arguments:
        sys.exit(__doc__)
    if arguments[0] == "run":
        return run(arguments[1:])
    return table(Path(arguments[0]), int(arguments[1]) if arguments[1:] else COUNT)


if __name__ == "__main__":
    sys.exit(main())
