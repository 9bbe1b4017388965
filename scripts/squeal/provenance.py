"""scene.yaml of a result folder: options in force, where the files come from, and the units of its tables."""

import re

from .tables import BadInput, regular

DEFAULTS = "At their defaults"
TO_SI = {"mm, t, s, N, MPa": {"m": 1e-3, "m2": 1e-6, "m_s": 1e-3, "m_s2": 1e-3, "m_n": 1e-3, "pa": 1e6}}
NAMES = {"Pa": "MPa", "m": "mm", "kg": "t", "kg/m^3": "t/mm^3", "N/m": "N/mm", "N/m^3": "N/mm^3", "N m/rad": "N mm/rad",
         "m/s": "mm/s", "s/m": "s/mm", "N s/m": "N s/mm", "N s/m^3": "N s/mm^3", "N m s/rad": "N mm s/rad"}

OPTIONS = {"Pa": 1e6, "m": 1e-3, "kg": 1e3, "kg/m^3": 1e12, "N/m": 1e3, "N/m^3": 1e9, "m/s": 1e-3, "s/m": 1e3, "N s/m": 1e3,
           "N s/m^3": 1e9}  # SI units in one of mm, t, s, N, MPa


class Units:
    """Units of the tables and fields of a folder, whatever their columns are called: `factor("m_s")` makes m/s of what
    stands in a column that ends so, `name("m/s")` is what a value of an option is in."""

    def __init__(self, folder):
        try:
            said = Provenance(folder / "scene.yaml").facts.get("units", "")
        except BadInput:  # of a run under way, or of tables of one's own
            said = ""
        self.factors = TO_SI.get(said, {})

    def factor(self, end):
        """SI units in one unit of the folder."""
        return self.factors.get(end, 1.0)

    def name(self, unit):
        """The unit of the folder that stands for one of SI."""
        return NAMES.get(unit, unit) if self.factors else unit


class Provenance:
    """Options `given` and at their `defaults`, and `facts`: repeat, command, in, versions, cost, end, files."""

    def __init__(self, path):
        self.given, self.defaults, self.facts = {}, {}, {}
        self.path = path
        try:
            lines = regular(path).read_text().splitlines()
        except FileNotFoundError:
            raise BadInput(f"{path}: no such file; a run writes it with its first table") from None
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

    def ended(self):
        """The day on which the run ended; empty where it goes on, was stopped, or failed, and in a table of one's own."""
        found = re.match(r"\d{4}-\d\d-\d\d", self.facts.get("end", ""))
        return found[0] if found else ""

    def value(self, name, default=""):
        """An option in force."""
        return self.given.get(name, self.defaults.get(name, default))

    def number(self, name, default=0.0):
        """An option in force that is a number."""
        try:
            return float(self.value(name, default))
        except ValueError:
            return default

    def si(self, unit):
        """SI units in one of the scene's, for values of options."""
        return OPTIONS.get(unit, 1.0) if self.facts.get("units", "") in TO_SI else 1.0

    def names(self, name):
        """The words of a list."""
        return [word.strip() for word in self.value(name).split(",") if word.strip()]

    def is_true(self, name):
        """Whether a switch is on."""
        return self.value(name, "false").lower() in ("true", "1", "yes")


def about_sliding(text, names):
    """Whether modes are about the sliding state, as -modes_contact says; text and names: of an option, its value and its words."""
    word = text("modes_contact", "auto")
    forced = any(float(text(f"{name}_force", "0") or 0) for name in names("contacts"))
    loaded = names("loads") or names("motions") or any(float(g) for g in names("model_gravity"))
    return word == "static" or word == "auto" and bool(names("contacts") and loaded and not forced)
