"""Options of a scene, of which each that a deck takes is noted, so that the others can be listed."""

from ..provenance import Provenance
from ..tables import BadInput

SILENT = "output_", "squeal_", "log_", "options_"  # of a run, not of the scene
SHOWN = "_view"
REASONS = {"dashpots": "dashpots to the ground have no counterpart in CalculiX's *FREQUENCY",
           "joints": "bushings between mean motions have no counterpart", "points": "points that move as sets have no counterpart",
           "probes": "a place that squeal records", "circles": "places that squeal records", "impulses": "a blow in time",
           "stages": "loads one after the other, which the deck has in one step"}


class Options:
    """Values by name, without the dash."""

    def __init__(self, given, defaults=None, path="the scene"):
        self.given, self.defaults, self.path, self.used = dict(given), defaults or {}, path, set()

    @classmethod
    def of_words(cls, words):
        """Of a command line in which every option has a value."""
        words = [str(word) for word in words]
        return cls({name.removeprefix("-"): value for name, value in zip(words[::2], words[1::2])})

    @classmethod
    def of_folder(cls, folder):
        """Those in force in a result folder, and the folder in which the run was."""
        scene = Provenance(folder / "scene.yaml")
        return cls(scene.given, scene.defaults, scene.path), scene.facts.get("in", ".")

    def text(self, name, default=""):
        """A value."""
        self.used.add(name)
        return self.given.get(name, self.defaults.get(name, default))

    def has(self, name):
        """Whether it is given."""
        return name in self.given

    def names(self, name):
        """Words of a list."""
        return [word.strip() for word in self.text(name).split(",") if word.strip()]

    def numbers(self, name, default=""):
        """Numbers of a value."""
        try:
            return [float(word) for word in self.text(name, default).split(",") if word.strip()]
        except ValueError:
            raise BadInput(f"{self.path}: {name} {self.text(name)}: must be numbers") from None

    def number(self, name, default=""):
        """The first of them."""
        found = self.numbers(name, default)
        if not found:
            raise BadInput(f"{self.path}: {name} is missing")
        return found[0]

    def left(self):
        """Lines about what nobody has asked for."""
        why = {name: reason for kind, reason in REASONS.items() for name in self.names(kind)}
        for name, value in sorted(self.given.items()):
            if name in self.used or name.startswith(SILENT) or name.endswith(SHOWN):
                continue
            reason = next((reason for prefix, reason in why.items() if name.startswith(f"{prefix}_")), "has no counterpart in the deck")
            yield f"{name} {value}: {reason}"
