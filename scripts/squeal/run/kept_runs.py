"""Runs of squeal that are kept, each in a folder of its own, and taken from there as long as program, command,
options files and meshes are the same. A run that was stopped is no kept run: its folder has no log.txt."""

import functools
import hashlib
from pathlib import Path

from .program import ROOT, launch
from ..tables import BadInput

LOG = "log.txt"


@functools.cache
def digest(path):
    """Of a file's content."""
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()


class KeptRun:
    """A folder and the words of its run, without the folder."""

    def __init__(self, program, ranks, folder, words):
        self.program, self.ranks, self.folder = program, ranks, folder
        self.words = [str(word) for word in words]

    @functools.cached_property
    def key(self):
        """What a kept run must agree in: program, command, and the options files and meshes that it names."""
        files = [word for before, word in zip(self.words, self.words[1:]) if before in ("-options_file", "-model_mesh")]
        parts = [digest(self.program), str(self.ranks), *self.words, *map(digest, files)]
        return hashlib.sha256("\0".join(parts).encode()).hexdigest()

    @property
    def log(self):
        return self.folder / LOG

    def is_complete(self):
        """Whether the folder has the results of this very run."""
        return self.log.exists() and self.log.read_text(encoding="utf-8").startswith(self.key)

    def begin(self):
        """Makes the folder, which is incomplete from now on; returns the words of the command."""
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            self.log.unlink(missing_ok=True)
        except OSError as error:
            raise BadInput(f"{self.folder}: no folder for a run can be made there: {error.strerror}") from None
        command = [ROOT / "scripts/mpirun", "-n", self.ranks, self.program, *self.words, "-output_dir", self.folder]
        return [str(word) for word in command]

    def end(self, text):
        """The run has ended well with this output."""
        part = self.log.with_suffix(".part")
        part.write_text(f"{self.key}\n{text}", encoding="utf-8")
        part.replace(self.log)

    def text(self):
        """What the complete run printed."""
        return self.log.read_text(encoding="utf-8").partition("\n")[2]

    def made(self):
        """The folder, with the results: made now where they are not there. A run that fails ends the script."""
        if not self.is_complete():
            self.begin()
            words = [*self.words, "-output_dir", self.folder]
            self.end(launch(self.program, self.ranks, words, f"{self.folder}, options {' '.join(self.words)}"))
        return self.folder
