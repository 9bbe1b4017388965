#!/usr/bin/env python3
"""Factorisations that two runs did, as -log_view counts them: as many in one as in the other, and not none.

    factorisations.py LOG LOG"""

import sys
from pathlib import Path

EVENTS = ("MatLUFactorNum", "MatCholFctrNum")


def count(log):
    """Numeric factorisations of a run."""
    rows = [line.split() for line in log.read_text().splitlines()]
    return sum(int(words[1]) for words in rows if words and words[0] in EVENTS)


if __name__ == "__main__":
    counts = [count(Path(name)) for name in sys.argv[1:]]
    print(f"{' and '.join(map(str, counts))} factorisations")
    sys.exit(0 if len(counts) == 2 and counts[0] == counts[1] > 0 else 1)
