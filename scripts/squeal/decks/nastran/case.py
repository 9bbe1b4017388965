"""Case control of Nastran: which sets of supports, loads and which method act. SUBCASEs inherit what stands above the first."""

import re
from dataclasses import dataclass, field

import numpy

from ..deck import NOT_NEEDED, Place
from .cards import named

LINE = re.compile(r"([A-Za-z][A-Za-z0-9]*)\s*(\([^)]*\))?\s*(?:=|\s|$)\s*(.*)$")
CHOICES = ("SPC", "LOAD", "METHOD", "STATSUB", "MPC", "SDAMPING")
# First four letters of what asks for output, or names
OUTPUT = {word[:4] for word in """TITLE SUBTITLE LABEL ECHO LINE MAXLINES DISPLACEMENT VELOCITY ACCELERATION STRESS STRAIN ELSTRESS FORCE
ELFORCE SPCFORCES MPCFORCES OLOAD ESE EKE EDE SET OUTPUT PAGE VECTOR PRESSURE THERMAL FLUX GPFORCE GPSTRESS GPSTRAIN GPKE SVECTOR
SDISPLACEMENT SVELOCITY SACCELERATION NLSTRESS MODES MEFFMASS BOUTPUT SURFACE VOLUME STRFIELD DATAREC XYPLOT XYPRINT XYPUNCH PLOTID
SKIP RESVEC NOUTPUT GROUNDCHECK WEIGHTCHECK ELSUM POST CSCALE XTITLE YTITLE XGRID YGRID XAXIS YAXIS PLOT FIND
BGRESULTS BCRESULTS""".split()}
LOADS = ("FORCE", "FORCE1", "FORCE2", "MOMENT", "MOMENT1", "MOMENT2", "PLOAD", "PLOAD1", "PLOAD2", "PLOAD4", "PLOADX1", "GRAV", "ACCEL",
         "ACCEL1", "RFORCE", "RFORCE1", "SLOAD", "SPCD", "TEMP", "TEMPD")
SPCS = ("SPC", "SPC1")
KNOWN = {"LOAD", "SPCADD"}


@dataclass
class Case:
    """Number and place of a subcase, and its words -> (number of a set, place)."""
    number: int
    place: Place
    choices: dict = field(default_factory=dict)


@dataclass
class Control:
    """What stands before the bulk data. `alone`: nothing does."""
    alone: bool = True
    above: dict = field(default_factory=dict)
    cases: list = field(default_factory=list)


def read_line(deck, control, place, text):
    """One command."""
    found = LINE.match(text)
    word, value = (found[1].upper(), found[3].strip()) if found else (text.split()[0], "")
    number = int(value) if re.fullmatch(r"\d{1,9}", value) else None
    if word[:4] == "SUBC" and word not in ("SUBCOM", ) and number is not None:
        control.cases.append(Case(number, place))
    elif (word if word in ("SPC", "MPC") else word[:4]) in ("SPC", "LOAD", "METH", "STAT", "MPC", "SDAM") and number is not None:
        name = next(choice for choice in CHOICES if choice.startswith(word[:4]))
        (control.cases[-1].choices if control.cases else control.above)[name] = number, place
    elif word[:4] in OUTPUT or value.upper() == "NONE":
        deck.note(place, f"{word[:30]}: output, {NOT_NEEDED}")
    else:
        deck.note(place, f"{word[:30]}{f' = {value[:30]}' if value else ''}: case control, not understood")


def read_case(deck, pieces):
    """What stands before the bulk data, in pieces (bytes, file, first line): executive control to CEND, then case control."""
    control, goes_on = Control(), False
    text = b"".join(data for data, _, _ in pieces)
    control.alone, executive = not text.strip(), bool(re.search(rb"(?im)^[ \t]*cend\b", text))
    for data, file, first in pieces:
        for number, line in enumerate(data.decode("latin-1").split("\n"), first):
            line, place = line.partition("$")[0].strip().lstrip("\xef\xbb\xbf"), Place(file, number)
            if line and executive:
                deck.note(place, f"{line.split()[0][:30]}: executive control, {NOT_NEEDED}")
                executive = not line.upper().startswith("CEND")
            elif line:
                if not goes_on:
                    read_line(deck, control, place, line)
                goes_on = line.endswith(",")
    return control


def chosen_case(deck, control, wanted):
    """Words of the subcase that is taken: the one that is asked for, else the first with a METHOD, else the first."""
    cases = control.cases
    if wanted is not None and not any(case.number == wanted for case in cases):
        where = cases[0].place if cases else Place(deck.path, 1)
        raise where.wrong(f"there is no SUBCASE {wanted}" + (f"; those of the file are {', '.join(str(case.number) for case in cases)}"
                                                             if cases else " in the file"))
    if not cases:
        return control.above
    with_method = [case for case in cases if "METHOD" in case.choices]
    taken = next((case for case in cases if case.number == wanted), (with_method or cases)[0])
    if len(cases) > 1:
        deck.differ(taken.place, f"SUBCASE {taken.number} of {len(cases)} is taken; --subcase takes another")
    choices = control.above | taken.choices
    before = next((case for case in cases if "STATSUB" in choices and case.number == choices["STATSUB"][0]), None)
    if before is not None and "LOAD" not in taken.choices and "LOAD" in before.choices:
        choices["LOAD"] = before.choices["LOAD"]
    return choices


def numbers_of(tables, names):
    """Sets of cards, in rising order."""
    parts = [table.whole(0, 1)[:, 0] for table in named(tables, *names)]
    return numpy.unique(numpy.concatenate(parts)).tolist() if parts else []


class Chosen:
    """What acts: sets of supports, sets of loads with their factors, number of the method (None: any)."""

    def __init__(self, deck, tables, control, wanted=None):
        sums = {}
        for table in named(tables, "SPCADD"):
            for row in range(len(table)):
                number, *others = [int(value) for value in table.whole(0, table.width)[row] if value]
                sums.setdefault(number, []).extend(others)
        factors = load_factors(tables)
        choices = chosen_case(deck, control, wanted)
        spc, load = (choices.get(name, (None,))[0] for name in ("SPC", "LOAD"))
        if control.alone:
            spc = lowest(deck, tables, (*SPCS, "SPCADD"), {n for others in sums.values() for n in others}, "SPC")
            load = lowest(deck, tables, (*LOADS[:-2], "LOAD"), {n for parts in factors.values() for n in parts}, "LOAD")
        self.spcs = set() if spc is None else {spc, *sums.get(spc, ())}
        self.loads = {} if load is None else {load: 1.0} | factors.get(load, {})
        self.mpcs = mpc_sets(deck, tables, choices, control)
        self.damping = choices.get("SDAMPING", (None, None))
        self.method = choices.get("METHOD", (None,))[0]
        mpc = choices.get("MPC", (None,))[0]
        for name, number, cards in (("MPC", mpc, ("MPC", "MPCADD")), ("SPC", spc, (*SPCS, "SPCADD")), ("LOAD", load, (*LOADS, "LOAD"))):
            if number is not None and number not in numbers_of(tables, cards):
                deck.note(choices[name][1], f"{name} = {number}: there is no such set")
        self.note_others(deck, tables, control)

    def note_others(self, deck, tables, control):
        """Cards of sets that do not act."""
        for names, acting, word in ((SPCS, self.spcs, "SPC"), (LOADS, self.loads, "LOAD")):
            why = "not taken" if control.alone else f"case control has no {word} = {{}}: not taken"
            for table in named(tables, *names):
                for row, number in enumerate(table.whole(0, 1)[:, 0].tolist()):
                    if number not in acting:
                        deck.note(table.place(row), f"{table.name} of set {number}: {why.format(number)}")

    def supports(self, tables, name):
        """Tables of the cards that act, of a name."""
        return self.acting(tables, name, self.spcs)

    def constraints(self, tables):
        """Tables of MPC that act."""
        return self.acting(tables, "MPC", self.mpcs)

    def acting(self, tables, name, numbers):
        found = []
        for table in named(tables, name):
            rows = numpy.flatnonzero(numpy.isin(table.whole(0, 1)[:, 0], list(numbers)))
            if len(rows):
                found.append(table.rows(rows))
        return found

    def loads_of(self, tables, name):
        """(table of one card, factor) of the cards that act, of a name."""
        for table in self.acting(tables, name, self.loads):
            for row, number in enumerate(table.whole(0, 1)[:, 0].tolist()):
                if self.loads[number]:
                    yield table.rows(slice(row, row + 1)), self.loads[number]


def mpc_sets(deck, tables, choices, control):
    """Numbers of the sets of MPC that act; others are listed."""
    sums = {}
    for table in named(tables, "MPCADD"):
        for row in range(len(table)):
            number, *others = [int(value) for value in table.whole(0, table.width)[row] if value]
            sums.setdefault(number, []).extend(others)
    wanted = choices.get("MPC", (None,))[0]
    if control.alone:
        wanted = lowest(deck, tables, ("MPC", "MPCADD"), {n for others in sums.values() for n in others}, "MPC")
    found = set() if wanted is None else {wanted, *sums.get(wanted, ())}
    for table in named(tables, "MPC"):
        for row, number in enumerate(table.whole(0, 1)[:, 0].tolist()):
            if number not in found:
                deck.note(table.place(row), f"MPC of set {number}: case control has no MPC = {number}: not taken")
    return found


def load_factors(tables):
    """Number of a LOAD -> {set: factor}: S times S1, S2 ..."""
    found = {}
    for table in named(tables, "LOAD"):
        numbers, values = table.whole(0, 1)[:, 0], table.real(1, 2)[:, 0]
        for row, (number, overall) in enumerate(zip(numbers.tolist(), values.tolist())):
            words = table.words(row)
            parts = found.setdefault(number, {})
            for at in range(2, len(words) - 1, 2):
                if words[at + 1]:
                    if not words[at + 1].isdigit() or not words[at]:
                        raise table.place(row).wrong(f"LOAD {number}: '{words[at]}', '{words[at + 1]}' are no factor and set")
                    part = int(words[at + 1])
                    parts[part] = parts.get(part, 0.0) + overall * table.one_real(row, at, words[at])
    return found


def lowest(deck, tables, names, parts, word):
    """Of bulk data alone: the set that acts, the lowest of those that are no part of another."""
    numbers = [number for number in numbers_of(tables, names) if number not in parts]
    if not numbers:
        return None
    place = next(table.place(int((table.whole(0, 1)[:, 0] == numbers[0]).argmax())) for table in named(tables, *names)
                 if (table.whole(0, 1)[:, 0] == numbers[0]).any())
    others = f", not {', '.join(map(str, numbers[1:5]))}{' ...' if len(numbers) > 5 else ''}" if numbers[1:] else ""
    deck.differ(place, f"no case control: {word} = {numbers[0]} is taken{others}; write {word} = n and BEGIN BULK before the "
                       "cards to choose")
    return numbers[0]
