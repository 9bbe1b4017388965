#!/usr/bin/env python3
"""Files that a run must not write: absent.py FOLDER NAME..."""

import sys
from pathlib import Path

found = [name for name in sys.argv[2:] if (Path(sys.argv[1]) / name).exists()]
if found:
    sys.exit(f"{', '.join(found)} in {sys.argv[1]}")
