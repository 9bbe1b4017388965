#!/usr/bin/env python3
"""Which unstable mode wins: intervals and chances of scripts/squeal/ranking/indices.py against closed forms of the binomial
distribution, widths and meeting times against made-up lines, and scripts/study/ranking with a stand-in for the program
that writes two made-up brakes, in one of which the faster mode wins, in the other the slower one. Exit status: 0, or 1.
"""

import csv
import math
import os
import re
import subprocess
import sys
import tempfile
from fractions import Fraction
from pathlib import Path

from drawing import SCRIPTS, require

from squeal.ranking import indices as ranking
from squeal.ranking.scenes import nearest, width

TESTS = Path(__file__).resolve().parent
# Writes the tables of a brake with two unstable modes; that with damping of all parts is won by the slower one
PROGRAM = """#!{python}
import sys
sys.path.insert(0, "{tests}")
from made_up_brake import write_run
write_run(dict(zip(sys.argv[1:], sys.argv[2:])))
"""


def exact_tail(k, n, p):
    """Probability of k or more of n, in fractions."""
    p = Fraction(p)
    return float(sum(math.comb(n, i) * p**i * (1 - p)**(n - i) for i in range(k, n + 1)))


def test_intervals():
    """n of n: alpha^(1/n) and 1; none of n: 0 and 1 - alpha^(1/n); else each tail is 2.5 %; 3 of 10 as in tables."""
    for n in (1, 2, 12, 34):
        low, high = ranking.interval(n, n)
        require(abs(low - 0.025**(1 / n)) < 1e-12 and high == 1, f"{n} of {n}: {low}, {high}")
        low, high = ranking.interval(0, n)
        require(low == 0 and abs(high - (1 - 0.025**(1 / n))) < 1e-12, f"0 of {n}: {low}, {high}")
        for k in range(1, n):
            low, high = ranking.interval(k, n)
            tails = exact_tail(k, n, low), 1 - exact_tail(k + 1, n, high)
            require(max(abs(t - 0.025) for t in tails) < 1e-12 and low < k / n < high, f"{k} of {n}: {low}, {high}")
            mirrored = ranking.interval(n - k, n)
            require(abs(low + mirrored[1] - 1) < 1e-12, f"{k} of {n} and {n - k} of {n} are no mirror images")
    require([round(end, 4) for end in ranking.interval(3, 10)] == [0.0667, 0.6525], f"{ranking.interval(3, 10)}")


def test_chances():
    """Equal numbers of candidates: the binomial distribution; unequal ones: by hand."""
    law = ranking.by_chance([3] * 8)
    binomial = [math.comb(8, k) * 2**(8 - k) / 3**8 for k in range(9)]
    require(max(abs(a - b) for a, b in zip(law, binomial)) < 1e-15 and len(law) == 9, f"{law}")
    require(max(abs(a - b) for a, b in zip(ranking.by_chance([2, 4]), (3 / 8, 4 / 8, 1 / 8))) < 1e-15, "2 and 4")


def candidate(mode, freq, growth, start=1e-3, **more):
    """With the damping ratio of its eigenvalue."""
    omega = 2 * math.pi * freq
    values = {"elsewhere": {"less": growth, "all": growth}, "width": {"contact_mu": growth, "pad_young": -growth}}
    return ranking.Candidate(mode, f"(0,{mode})", freq, growth, -growth / math.hypot(growth, omega), 1e-8,
                             *(values | more).values(), start, 0.5)


def test_indices():
    """Each index puts the mode first that it should."""
    slow, fast = candidate(1, 3500, 300), candidate(2, 5200, 400, start=1e-5)
    high = candidate(3, 13000, 900, start=1e-7)
    first = {index: ranking.predicted([slow, fast, high], index) for index in ranking.INDICES}
    ratios = {c.mode: c.growth / (2 * math.pi * c.freq) for c in (slow, fast, high)}
    require(first["damping ratio, the most negative"] == max(ratios, key=ratios.get) == 1, f"{ratios}: {first}")
    times = {c.mode: math.log(0.5 / c.start) / c.growth for c in (slow, fast, high)}
    require(first["first to reach the sliding speed"] == min(times, key=times.get) == 3, f"{times}: {first}")
    require((first["growth"], first["lowest frequency"], first["width over mu"],
             first["width over the pad's modulus"]) == (3, 1, 3, 1), f"{first}")
    require(abs(ranking.overtakes(slow, fast) - math.log(100) / 100) < 1e-12, "fast overtakes slow")
    require(ranking.overtakes(fast, slow) == 0 and ranking.overtakes(high, slow) == 0, "ahead from the start")
    require(ranking.overtakes(slow, candidate(4, 9e3, 200, start=1e-4)) == math.inf, "never")
    require(ranking.winner([slow, fast], 3400) == 1 and ranking.winner([slow, fast], 5100) == 2, "nearest line")
    require(ranking.winner([slow, fast], 3170) is None, "a line that is none's")
    rows = ranking.scores([[slow, high], [slow, high], [fast, high]], [1, 3, None])
    right = {row.index: (row.right, row.of) for row in rows}
    require(right["growth"] == (1, 3) and right["lowest frequency"] == (1, 3) and
            rows[0].right >= rows[-1].right, f"{right}")
    require(all(abs(row.chance - {0: 1, 1: 7 / 8, 2: 4 / 8, 3: 1 / 8}[row.right]) < 1e-12 for row in rows), "chances")


def test_width():
    """A mode that is unstable between two values of a parameter, whose frequency drifts past another mode that decays:
    breaks when the ends are taken at the points, or the other mode is followed."""
    values = [0.1 * k for k in range(11)]
    rows = [{"value": v, "freq_hz": 3400 + 200 * v, "growth_rad_s": 100 * min(v - 0.27, 0.83 - v)} for v in values]
    rows += [{"value": v, "freq_hz": 3500, "growth_rad_s": -40.0} for v in values]
    found = width(rows, 3500, 0.5)
    require(abs(found - 0.56) < 1e-9, f"width {found}, made with 0.56")
    require(nearest(rows[:1], 5000) is None and nearest(rows, 3410)["freq_hz"] != 3500, "the nearest one that grows")


def test_study(root):
    """Both brakes end in the table, with the winner and what is right in one of two."""
    program = root / "squeal"
    program.write_text(PROGRAM.format(python=sys.executable, tests=TESTS))
    program.chmod(0o755)
    command = [sys.executable, SCRIPTS / "study/ranking", "--program", program, "--brakes", "2",
               "--runs", root / "runs", "--csv", root / "ranking.csv"]
    result = subprocess.run(command, capture_output=True, text=True, check=False, env=os.environ)
    require(result.returncode == 0, result.stdout + result.stderr)
    with (root / "ranking.csv").open(newline="") as lines:
        rows = list(csv.DictReader(lines))
    require([(row["damping"], row["mode"], row["wins"]) for row in rows] ==
            [("disc", "3", "0"), ("disc", "8", "1"), ("all", "3", "1"), ("all", "8", "0")], f"{rows}")
    for row in rows:
        line = 5150 if row["damping"] == "disc" else 3470
        require(abs(float(row["line_hz"]) / line - 1) < 1e-3, f"main line {row['line_hz']}, made with {line}")
    right = dict(re.findall(r"^\| ([^|]*?) \| (\d) of 2 \|", result.stdout, re.MULTILINE))
    require(right["growth"] == "1" and right["lowest frequency"] == "1" and len(right) == len(ranking.INDICES),
            result.stdout)
    low, high = (f"{100 * end:.0f}" for end in ranking.interval(1, 2))
    require(f"| growth | 1 of 2 | 50% | {low}% to {high}% |" in result.stdout, result.stdout)
    require("the same from the other start: 2 of 2" in result.stdout, result.stdout)
    again = subprocess.run([*command[:-1], root / "none/ranking.csv"], capture_output=True, text=True, check=False)
    require(again.returncode == 0 and (root / "none/ranking.csv").exists(), again.stderr)


def main():
    for test in (test_intervals, test_chances, test_indices, test_width):
        test()
        print(f"{test.__name__}: passed")
    with tempfile.TemporaryDirectory() as folder:
        test_study(Path(folder))


if __name__ == "__main__":
    main()
