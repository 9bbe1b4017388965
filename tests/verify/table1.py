#!/usr/bin/env python3
"""Compares modes.csv with table 1 of the seed paper (linear column, pad of 25.1 GPa, mu = 0) and prints both.

Each of the 22 modes must exist under its label, each mode of ours serves once, the root mean square of the relative
errors is at most 1.0 % and none exceeds 2.5 %. The paper's numbers and our labels stand in scripts/squeal/modes/table1.py.
Exit status: 0, or 1.
"""

import argparse
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
from squeal.modes.table1 import beside, read_modes, rms

RMS, WORST = 0.010, 0.025


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="that has modes.csv")
    found = beside(read_modes(parser.parse_args().folder), "ansys")
    print("paper     paper Hz  squeal Hz  error %  label")
    for pair in found:
        if math.isnan(pair.ours):
            print(f"no mode has the label {pair.label}, which the paper has at {pair.paper} Hz", file=sys.stderr)
            return 1
        print(f"{pair.line.name:8} {pair.paper:9} {pair.ours:10.1f} {100 * pair.error:8.2f}  {pair.label}")
    worst = max(abs(pair.error) for pair in found)
    print(f"{len(found)} modes, rms error {rms(found):.2%} (allowed {RMS:.1%}), worst {worst:.2%} (allowed {WORST:.1%})")
    return 0 if len(found) == 22 and rms(found) <= RMS and worst <= WORST else 1


if __name__ == "__main__":
    sys.exit(main())
