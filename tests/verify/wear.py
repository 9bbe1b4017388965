#!/usr/bin/env python3
"""Wear of contact against closed forms.

    wear.py stationary FOLDER            pressures of a pad that turns about z without tilting are as 1 / r where they rest
    wear.py book FOLDER RATE MU          volume = k / mu x work of friction at each step; V = sum A (what gap.csv says is worn)
    wear.py decay FOLDER DELTA RATE LAW [NUMBERS] --exponent A --steps N --time T --compliance C
                                         an even pressure under a held displacement: each implicit step by scipy; the
                                         error of the steps beside an integration without one
    wear.py depth FOLDER DEPTH           the run ends where the deepest pair has worn so far
"""

import argparse
import csv
import math
import sys
from pathlib import Path

from scipy.integrate import solve_ivp
from scipy.optimize import brentq

STATIONARY = 1e-3
BOOK = 1e-12
DECAY = 1e-9
LARGE = 20  # times the true error of the steps


def table(folder, name):
    with (Path(folder) / name).open(newline="") as file:
        return list(csv.DictReader(file))


def column(rows, name):
    return [float(row[name]) for row in rows]


def judge(what, value, allowed):
    print(f"{what}: {value:.3g}, allowed {allowed:g}")
    if not value <= allowed:
        sys.exit(f"{what} is too large")


def stationary(folder):
    """Parallel approach: k p omega r is the same everywhere, so that lambda = F (A / r) / sum (A / r)."""
    rows = table(folder, "static.csv")
    radius = [math.hypot(x, y) for x, y in zip(column(rows, "x_m"), column(rows, "y_m"))]
    force, share = column(rows, "lambda_n_n"), [a / r for a, r in zip(column(rows, "area_m2"), radius)]
    expected = [sum(force) * s / sum(share) for s in share]
    judge("pressure beside 1 / r", max(abs(f / e - 1) for f, e in zip(force, expected)), STATIONARY)
    first, last = min(radius), max(radius)
    if last / first < 1.9:
        sys.exit("the pad is too narrow to tell")


def book(folder, rate, mu):
    wear = table(folder, "wear.csv")
    volume, work = column(wear, "volume_m3"), column(wear, "friction_work_j")
    judge("volume beside k work / mu", max(abs(v / (rate * w / mu) - 1) for v, w in zip(volume, work)), BOOK)
    worn = [s + m for s, m in zip(*(column(table(folder, "gap.csv"), f"worn_{side}_m") for side in ("slave", "master")))]
    area = column(table(folder, "static.csv"), "area_m2")
    judge("volume beside gap.csv", abs(sum(a * w for a, w in zip(area, worn)) / volume[-1] - 1), BOOK)
    judge("depth beside gap.csv", abs(max(worn) / float(wear[-1]["depth_m"]) - 1), BOOK)


def closing_of(law, numbers):
    """The closing at a pressure, m."""
    if law == "exact":
        return lambda p: 0
    if law == "linear":
        return lambda p: p / numbers[0]
    c0, p0 = numbers  # x (e^x - 1) = (e - 1) p / p0, x = c / c0 + 1
    return lambda p: c0 * (brentq(lambda x: x * math.expm1(x) - (math.e - 1) * p / p0, 0, 700, xtol=1e-300, rtol=1e-15) - 1)


def decay(arguments):
    """delta - worn = C(p) + c p, worn grows by k v p^a dt: p at the end of each step."""
    closing, a = closing_of(arguments.law, arguments.numbers), arguments.exponent
    wear, worn, worst = table(arguments.folder, "wear.csv"), 0, 0
    if len(wear) != arguments.steps:
        sys.exit(f"{len(wear)} steps")
    k, delta, c = arguments.rate * arguments.time / arguments.steps, arguments.delta, arguments.compliance
    for row in wear:
        p = brentq(lambda p: closing(p) + c * p + k * p**a + worn - delta, 0, 2 * (delta + arguments.most) / c, xtol=1e-300, rtol=1e-15)
        worn += k * p**a
        worst = max(worst, abs(float(row["pressure_pa"]) / p - 1), abs(float(row["depth_m"]) / worn - 1))
    print(f"pressure falls to {p:.6g} Pa")
    judge("steps beside scipy's", worst, DECAY)
    most = 2 * (delta + arguments.most) / c

    def rate(_, worn):
        left = delta - worn[0]
        return [arguments.rate * brentq(lambda p: closing(p) + c * p - left, 0, most, xtol=1e-300, rtol=1e-15) ** a]

    exact = solve_ivp(rate, (0, arguments.time), [0], method="LSODA", rtol=1e-9, atol=1e-9 * delta).y[0, -1]
    error, stated = abs(float(wear[-1]["depth_m"]) - exact), float(wear[-1]["depth_error_m"])
    judge("error of the steps over the stated one", error / stated, 1)
    judge("stated error of the steps over the true one", stated / error, LARGE)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parsers = parser.add_subparsers(dest="what", required=True)
    parsers.add_parser("stationary").add_argument("folder")
    one = parsers.add_parser("book")
    one.add_argument("folder")
    one.add_argument("rate", type=float)
    one.add_argument("mu", type=float)
    one = parsers.add_parser("depth")
    one.add_argument("folder")
    one.add_argument("depth", type=float)
    one = parsers.add_parser("decay")
    one.add_argument("folder")
    one.add_argument("delta", type=float)
    one.add_argument("rate", type=float)
    one.add_argument("law", choices=["exact", "linear", "exponential"])
    one.add_argument("numbers", type=float, nargs="*")
    for name, kind in (("exponent", float), ("steps", int), ("time", float), ("compliance", float)):
        one.add_argument(f"--{name}", type=kind, required=True)
    one.add_argument("--most", type=float, default=0, help="m, by which the law presses before surfaces meet")
    arguments = parser.parse_args()
    if arguments.what == "stationary":
        stationary(arguments.folder)
    elif arguments.what == "book":
        book(arguments.folder, arguments.rate, arguments.mu)
    elif arguments.what == "depth":
        judge("depth", abs(float(table(arguments.folder, "wear.csv")[-1]["depth_m"]) / arguments.depth - 1), 1e-9)
    else:
        decay(arguments)


if __name__ == "__main__":
    main()
