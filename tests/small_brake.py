"""A disc, a pad and a beam on few elements, with friction: the scene of several tests, but for what they ask of it."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
from squeal.study.updated import BRAKE as SCENE  # noqa: E402,F401
