"""Margins of tests: of each test the check that uses the largest share of what is allowed, from meson's log of a run of all tests.

Lines that are read, as tests/run.py, tests/unit/check.h and the scripts of tests/verify/ print them:

    ok     TITLE, 0.1 s: 6 values, worst 1 for 1, error 1e-12, allowed 1e-09
    ok     TITLE: 3e-16 from the reference, 1e-12 allowed
    ok     TITLE: ... measured 3e-16, allowed 1e-12 ...
    ok     TITLE       1.0, expected 1 +- 1e-12
"""

import json
import math
import re
from types import SimpleNamespace

from .tables import BadInput

NUMBER = r"([-+]?(?:\d[\d.]*(?:e[-+]?\d+)?|inf|nan))"
FORMS = (re.compile(rf"^ok +(?P<title>.*?)(?:, [\d.]+ s)?: .*?error {NUMBER}, allowed {NUMBER}"),
         re.compile(rf"^ok +(?P<title>.*?)(?:, [\d.]+ s)?: {NUMBER} from the reference, {NUMBER} allowed"),
         re.compile(rf"^(?:ok +)?(?P<title>.*?):? *measured {NUMBER}, allowed {NUMBER}"))
EXPECTED = re.compile(rf"^ok +(?P<title>.*?) +{NUMBER}, expected {NUMBER} \+- {NUMBER}$")
ON_RANKS = re.compile(r" on \d+$")


def check_of(line):
    """Title, error and what is allowed of a line that compares numbers; nothing of another one."""
    found = EXPECTED.match(line)
    if found:
        value, expected, allowed = (float(text) for text in found.groups()[1:])
        return SimpleNamespace(title=found["title"], error=abs(value - expected), allowed=allowed)
    for form in FORMS:
        found = form.match(line)
        if found:
            error, allowed = (abs(float(text)) for text in found.groups()[1:])
            return SimpleNamespace(title=ON_RANKS.sub("", found["title"]).strip(), error=error, allowed=allowed)
    return None


def used(check):
    """Share of what is allowed that is used up."""
    return check.error / check.allowed if check.allowed else math.inf if check.error else 0.0


def margins_of(log):
    """Of each test its suite, name, number of checks that compare numbers, and the closest of these; tests without such are left out."""
    try:
        tests = [json.loads(line) for line in log.read_text().splitlines()]
    except (OSError, ValueError) as error:
        raise BadInput(f"{log}: no log of meson test, as build/meson-logs/testlog.json is one: {error}") from None
    for test in tests:
        suite, _, name = test["name"].partition(":")[2].rpartition(" / ")
        if test["result"] == "SKIP":  # a package is missing
            continue
        if test["result"] != "OK":
            raise BadInput(f"{log}: test {name} is {test['result']}; margins are those of a run in which all tests pass")
        checks = [check for check in map(check_of, (test.get("stdout") or "").splitlines()) if check]
        if checks:
            yield SimpleNamespace(suite=suite, name=name, count=len(checks), closest=max(checks, key=used))
