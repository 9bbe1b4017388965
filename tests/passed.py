"""What of a long test has passed already, kept in a file while it runs, so that one that was stopped goes on; of another program,
library of faults, or scripts and scenes, nothing has. At the test's end the file goes."""

import hashlib
import threading
from pathlib import Path

HERE = Path(__file__).resolve().parent
SCRIPTS = "*.py", "fault/*.py", "fuzz/*.py", "../options/*.yaml"  # what a test and its scenes are made of


def mark_of(program, library):
    """Another one where a byte of what decides differs."""
    files = [program, library, *sorted(path for pattern in SCRIPTS for path in HERE.glob(pattern))]
    return hashlib.sha256(b"".join(hashlib.sha256(path.read_bytes()).digest() for path in files)).hexdigest()


class Passed:
    """Names of what passed; path None keeps nothing."""

    def __init__(self, path, program, library):
        self.path, self.names, self.lock = path, set(), threading.Lock()
        mark = mark_of(program, library)
        lines = path.read_text().splitlines() if path and path.exists() else []
        if lines[:1] == [mark]:
            self.names = set(lines[1:])
        elif path:
            path.write_text(f"{mark}\n")

    def __contains__(self, name):
        return name in self.names

    def add(self, name):
        with self.lock:
            self.names.add(name)
            if self.path:
                with self.path.open("a") as file:
                    file.write(f"{name}\n")

    def end(self):
        if self.path:
            self.path.unlink()
