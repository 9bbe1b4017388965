"""A result folder as the page sees it: which analyses it holds, its scene, the commands that draw it again."""

import shlex
from pathlib import Path
from typing import NamedTuple

from ..run.program import called
from ..provenance import Provenance
from ..tables import BadInput
from .markup import missing

TABLES = {"modes": "modes.csv", "static": "static.csv", "sweep": "sweep.csv", "frf": "frf.csv",
          "transient": "transient.csv", "map": "map.csv", "cycle": "cycle.csv", "sample": "samples.csv",
          "conditions": "conditions.csv", "quiet": "quiet.csv", "design": "design.csv", "model": "reduced_model.bin"}
UNFINISHED = ".part"
SCRIPTS = Path(__file__).resolve().parents[2]


class Options(NamedTuple):
    """Of the command line: modes whose shapes are wanted, probe, component, band (Hz)."""
    modes: list = []
    probe: str | None = None
    component: str = "y"
    band: tuple | None = None


class Folder:
    """`key`: prefix of its elements; `scene`: its Provenance or None, and `why` then; `wrong`: lines for the user."""

    def __init__(self, path, key, options):
        self.path, self.key, self.options = path, key, options
        self.name = str(path)
        if not path.is_dir():
            raise BadInput(f"{path}: no such folder; run squeal first, or name its -output_dir")
        self.analyses = [kind for kind, table in TABLES.items() if (path / table).exists() or
                         (kind == "transient" and (path / (table + UNFINISHED)).exists())]
        self.scene, self.why, self.wrong = None, "", []
        if not self.analyses:
            self.wrong.append(self.emptiness())
        try:
            self.scene = Provenance(path / "scene.yaml")
        except BadInput as error:
            self.why = str(error)
            if self.analyses:
                self.wrong.append(self.why)

    def emptiness(self):
        """What is wrong with a folder that holds no table."""
        parts = sorted(path.name for path in self.path.glob("*" + UNFINISHED))
        if parts:
            return f"{self.path}: half-written, only {', '.join(parts[:3])} is there; the run goes on, or was stopped"
        return (f"{self.path}: holds no result ({', '.join(TABLES.values())}); is it the -output_dir of a run that "
                "ended?")

    def said(self, error):
        """What cannot be read, a line for the user too."""
        self.wrong.append(str(error))
        return str(error)

    def lacks(self, error):
        """A paragraph about it."""
        return missing(f"{self.said(error)}.")

    def tried(self, make, *given):
        """What is made, or what is wrong."""
        try:
            return make(*given)
        except BadInput as error:
            return self.lacks(error)

    def disc(self):
        """Part with the face."""
        return self.scene.value("modes_disc", "disc") if self.scene else "disc"

    def command(self, script, *words):
        """What draws one of its pictures again; the page itself where no script does."""
        script = script if (SCRIPTS / script).exists() else "report"
        return " ".join([called(script), shlex.quote(self.name), *words])
