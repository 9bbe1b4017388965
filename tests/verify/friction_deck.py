#!/usr/bin/env python3
"""Decks and words of the scene of tests/cases/friction_law.toml: verify/friction_deck.py MODES ROUND STRIBECK. The deck of MODES has
mu = 0.3 + 0.2 exp(-2), that at the sliding speed; the base of ROUND turns, each point with a mu of its own, which is refused. The
pages of MODES and STRIBECK say their numbers."""

import math
import subprocess
import sys
from pathlib import Path

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"
sys.path.insert(0, str(SCRIPTS))
from squeal.provenance import Provenance # noqa: E402
from squeal.report.words import contact_words # noqa: E402

WORDS = "friction coefficient 0.5 at rest, 0.3 in fast sliding, decay speed 0.05 m/s"
STRIBECK = "friction coefficient 0.32 at rest, 0.3 beyond the Stribeck speed 0.05 m/s, and 0.05 s/m viscous"


def deck(folder):
    file = Path(folder) / "deck.inp"
    done = subprocess.run([sys.executable, SCRIPTS / "export_ccx", folder, "-o", file], capture_output=True, text=True, check=False)
    return done.stdout + done.stderr, file.read_text(encoding="utf-8").splitlines() if file.exists() else []


def main():
    _, lines = deck(sys.argv[1])
    mu = [float(after.split(",")[0]) for line, after in zip(lines, lines[1:]) if line.upper().startswith("*FRICTION")]
    said, none = deck(sys.argv[2])
    words, stribeck = (contact_words(Provenance(Path(sys.argv[i]) / "scene.yaml"), "contact") for i in (1, 3))
    print(mu, said.strip(), words, stribeck)
    if WORDS not in words or STRIBECK not in stribeck:
        raise SystemExit(1)
    if len(mu) != 1 or not abs(mu[0] - 0.3 - 0.2 * math.exp(-2)) < 1e-9 or none or "a friction coefficient of its own" not in said:
        raise SystemExit(1)


if __name__ == "__main__":
    main()
