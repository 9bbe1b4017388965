"""scene.yaml of a result folder: options in force, and where the files come from."""

import re

from .tables import BadInput

DEFAULTS = "At their defaults"


class Provenance:
    """Options `given` and at their `defaults`, and `facts`: repeat, command, in, versions, cost, end, files."""

    def __init__(self, path):
        self.given, self.defaults, self.facts = {}, {}, {}
        self.path = path
        try:
            lines = path.read_text().splitlines()
        except FileNotFoundError:
            raise BadInput(f"{path}: no such file; a run writes it at its end") from None
        except (OSError, ValueError) as error:
            raise BadInput(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}") from None
        beyond = False
        for line in lines:
            beyond |= line.startswith(f"# {DEFAULTS}")
            self.add(line, beyond)
        if not self.given:
            raise BadInput(f"{path}: has no options; was the file cut off?")

    def add(self, line, beyond):
        """One line: an option, or a comment with a default or a fact."""
        option = re.fullmatch(r'([\w-]+): "(.*)"', line)
        comment = re.fullmatch(r"# ([\w-]+): (.*)", line)
        if option:
            self.given[option[1]] = re.sub(r"\\(.)", r"\1", option[2])
        elif comment:
            (self.defaults if beyond else self.facts).setdefault(comment[1], comment[2])

    def value(self, name, default=""):
        """An option in force."""
        return self.given.get(name, self.defaults.get(name, default))

    def number(self, name, default=0.0):
        """An option in force that is a number."""
        try:
            return float(self.value(name, default))
        except ValueError:
            return default

    def names(self, name):
        """The words of a list."""
        return [word.strip() for word in self.value(name).split(",") if word.strip()]

    def is_true(self, name):
        """Whether a switch is on."""
        return self.value(name, "false").lower() in ("true", "1", "yes")
