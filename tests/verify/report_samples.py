#!/usr/bin/env python3
"""The page of scripts/report of samples: its table has the probabilities, the boxes of its histogram hold each sample once, and
bars of what matters are those of growth, or, where growth is the same in all samples, of the frequency.

    report_samples.py RESULTS"""

import csv
import re
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from forked import run_script


def read(path):
    with path.open(newline="") as table:
        return list(csv.DictReader(table))


def main():
    folder = Path(sys.argv[1])
    rows = read(folder / "probability.csv")
    with tempfile.TemporaryDirectory() as name:
        page = Path(name) / "page.html"
        done = run_script(Path(__file__).resolve().parents[2] / "scripts/report", [folder, "-o", page])
        text = page.read_text() if page.exists() else ""
    svg = text[text.find('aria-label="histogram of the growth"'):]
    svg = svg[:svg.find("</svg>")]
    counted = {}
    for label, n in re.findall(r"<title>([^<]+): (\d+) samples from ", svg):
        counted[label] = counted.get(label, 0) + int(n)
    expected = {row["label"]: int(row["samples"]) for row in rows if row["branch"] != "any" and int(row["unstable"])}
    if not expected:  # none grows: one branch is shown
        expected = {row["label"]: int(row["samples"]) for row in rows if row["branch"] != "any" and row["label"] in counted}
    grows = any(row["of"] == "growth_rad_s" and (row["total"] or row["slope"]) for row in read(folder / "indices.csv"))
    bars = set(re.findall(r'aria-label="(?:standardised slope|total index of Sobol) of the ([^"]*)"', text))
    named = bars == {"growth" if grows else "frequency, as growth is the same in all"}
    shown = all(f"{100 * float(row['probability']):.4g}" in text for row in rows)
    print(done.stderr, counted, expected, shown, bars)
    sys.exit(0 if done.returncode == 0 and counted == expected and counted and shown and named else 1)


if __name__ == "__main__":
    main()
