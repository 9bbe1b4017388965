"""Cards of Nastran's bulk data in fields of 8 (small) or 16 characters (large), or with commas (free), one line another way than
the next where a deck has it so. Cards of one name and length are read together."""

import re

import numpy

from ..deck import Place
from ..text import columns, line_starts, matrix_of

WIDTH = 16  # least characters of a field of a table
LINE = 80  # columns of a line in fixed fields; the last 8 name the line that goes on
# e.g. 1.5-3 for 1.5e-3
REAL = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+))(?:[eEdD]?([+-]\d{1,3})|[eEdD](\d{1,3}))?$")
WHOLE = re.compile(r"[+-]?\d{1,15}$")
REPEAT = re.compile(r"=\(?(\d{1,7})\)?$")
STEP = re.compile(r"\*\(?([^()]+)\)?$")
SMALL, LARGE, FREE = 0, 1, 2


class Table:
    """Cards of one name with as many fields: characters [n][fields * each] behind the name, and the line of each."""

    def __init__(self, name, letters, lines, file, each=WIDTH):
        self.name, self.letters, self.lines, self.file, self.each = name, letters, lines, file, each
        self.width = letters.shape[1] // each

    def __len__(self):
        return len(self.lines)

    def rows(self, chosen):
        """The same of some of the cards."""
        return Table(self.name, self.letters[chosen], self.lines[chosen], self.file, self.each)

    def place(self, row):
        return Place(self.file, int(self.lines[row]))

    def wrong(self, row, column, word, what):
        """The error for a field, which is the (column + 2)-th with the name."""
        apart = "; blanks in it: is a number across the end of its columns?" if " " in word.strip() else ""
        return self.place(row).wrong(f"{self.name}: field {column + 2} '{word}' should be {what}{apart}")

    def part(self, first, last):
        """Characters of fields first to last - 1; those beyond the end are blank."""
        letters = self.letters[:, first * self.each:last * self.each]
        missing = (last - first) * self.each - letters.shape[1]
        return numpy.pad(letters, ((0, 0), (0, missing)), constant_values=ord(" ")) if missing else letters

    def blank(self, first, last):
        """Which fields [n][last - first] are blank."""
        return (self.part(first, last).reshape(len(self), last - first, self.each) == ord(" ")).all(axis=2)

    def whole(self, first, last):
        """Whole numbers [n][last - first]; blank is 0."""
        def one(row, column, word):
            if not WHOLE.match(word):
                raise self.wrong(row, column + first, word, "a whole number")
            return int(word)
        return columns(self.part(first, last), self.each, int, one)

    def real(self, first, last):
        """Numbers [n][last - first]; blank is 0."""
        def one(row, column, word):
            return self.one_real(row, column + first, word)
        return columns(self.part(first, last), self.each, float, one)

    def one_real(self, row, column, word):
        found = REAL.match(word)
        value = float(f"{found[1]}e{found[2] or found[3] or 0}") if found else numpy.nan
        if not abs(value) < 1e300:
            raise self.wrong(row, column, word, "a number")
        return value

    def words(self, row, least=0):
        """Fields of one card as text, `least` or more."""
        text = self.letters[row].tobytes().decode("latin-1")
        words = [text[at:at + self.each].strip() for at in range(0, len(text), self.each)]
        return words + [""] * (least - len(words))


def named(tables, *names):
    return [table for table in tables if table.name in names]


def spread(letters, width):
    """Fields of `width` characters in fields of WIDTH."""
    n, k = len(letters), letters.shape[1] // width
    found = numpy.full((n, k, WIDTH), ord(" "), numpy.uint8)
    found[:, :, :width] = letters.reshape(n, k, width)
    return found.reshape(n, k * WIDTH)


def heads_of(matrix):
    """Names of cards [n] in capitals, and which lines go on the card before them: those that begin with +, * or a comma, or
    whose first field is blank. A name may stand behind blanks."""
    filled = matrix[:, :8] != ord(" ")
    begin = numpy.where(filled.any(axis=1), filled.argmax(axis=1), 0)
    first = matrix[numpy.arange(len(matrix)), begin]
    goes_on = numpy.isin(first, [ord(letter) for letter in "+*, "])
    names = numpy.ascontiguousarray(matrix[:, :8])
    for row in numpy.flatnonzero(~goes_on & (begin > 0)):
        names[row] = numpy.roll(names[row], -begin[row])
    names[(names >= ord("a")) & (names <= ord("z"))] -= 32
    return names, goes_on


def kinds_of(matrix):
    """How each line is written."""
    free = (matrix[:, :72] == ord(",")).any(axis=1)
    large = (matrix[:, :8] == ord("*")).any(axis=1)
    return numpy.where(free, FREE, numpy.where(large, LARGE, SMALL))


def marks_of(matrix, first, last):
    """Names of lines [n] in capitals in some columns, "" where there is none."""
    letters = numpy.ascontiguousarray(matrix[:, first:last]).view(f"S{last - first}")[:, 0]
    return numpy.char.upper(numpy.char.strip(letters))


def in_order(matrix, kinds, goes_on, where):
    """Order of the lines in which each that goes on, by the name in front of it, is behind the one with this name at its end; in
    most decks that is where they are. A line without a name is behind the one before it."""
    order = numpy.arange(len(matrix))
    fixed = goes_on & (kinds != FREE) & (matrix[:, 1:8] != ord(" ")).any(axis=1)
    if not fixed.any():
        return order
    ends = numpy.where((kinds != FREE) & numpy.isin(matrix[:, 72], (ord("+"), ord("*"))), marks_of(matrix, 73, 80), b"")
    marks = marks_of(matrix, 1, 8)
    apart = numpy.flatnonzero(fixed[1:] & (marks[1:] != ends[:-1])) + 1
    if not len(apart):
        return order
    named_ends, moved = {mark: row for row, mark in enumerate(ends.tolist()) if mark}, {}
    for row in apart.tolist():
        parent = named_ends.get(marks[row])
        if parent is not None and parent != row:
            moved[row] = parent
        elif ends[row - 1]:
            raise where(row).wrong(f"this line goes on a line '{marks[row].decode('latin-1')}', and there is none")
    for row in sorted(moved):
        while row + 1 < len(matrix) and goes_on[row + 1] and row + 1 not in moved:
            row += 1
            moved[row] = row - 1
    children, found = {}, []
    for row, parent in moved.items():
        children.setdefault(parent, []).append(row)
    waiting = [row for row in range(len(matrix) - 1, -1, -1) if row not in moved]
    while waiting:
        row = waiting.pop()
        found.append(row)
        waiting += reversed(children.get(row, ()))
    if len(found) < len(matrix):
        raise where(min(moved)).wrong("lines that go on each other in a ring")
    return numpy.array(found)


def tables_of(data, first, file, known):
    """Tables of bulk data that begins on line `first`; tabulators go to the next multiple of 8. Cards that are not `known` may
    have more fields than go on a line."""
    data = data.expandtabs(8)
    starts = line_starts(data)
    letters = numpy.frombuffer(data, numpy.uint8)
    length = numpy.diff(starts) - 1
    filled = numpy.flatnonzero(length > 0)
    filled = filled[letters[starts[filled]] != ord("$")]
    if not len(filled):
        return []
    matrix = matrix_of(data, starts, filled, LINE)
    comment = matrix == ord("$")
    for row in numpy.flatnonzero(comment.any(axis=1)):
        matrix[row, int(comment[row].argmax()):] = ord(" ")
    blank = (matrix[:, :72] == ord(" ")).all(axis=1)
    matrix, filled = matrix[~blank], filled[~blank]
    if not len(filled):
        return []
    names, goes_on = heads_of(matrix)
    lines = first + filled
    if goes_on[0]:
        raise Place(file, int(lines[0])).wrong("a line that goes on a card, and there is none before it")
    kinds = kinds_of(matrix)
    order = in_order(matrix, kinds, goes_on, lambda row: Place(file, int(lines[row])))
    matrix, filled, names, goes_on, kinds, lines = (part[order] for part in (matrix, filled, names, goes_on, kinds, lines))
    owner = numpy.flatnonzero(~goes_on)
    count = numpy.diff(numpy.append(owner, len(matrix)))
    low, high = numpy.minimum.reduceat(kinds, owner), numpy.maximum.reduceat(kinds, owner)
    repeats = names[owner, 0] == ord("=")
    follows = numpy.append(repeats[1:], False)
    slow = (low != high) | (high == FREE) | repeats | follows

    def texts(card):
        at = range(owner[card], owner[card] + count[card])
        return [(kinds[k], data[starts[filled[k]]:starts[filled[k] + 1] - 1].decode("latin-1").partition("$")[0]
                 if kinds[k] == FREE else matrix[k, :72].tobytes().decode("latin-1")) for k in at], int(lines[owner[card]])

    found = slow_tables([texts(card) for card in numpy.flatnonzero(slow)], file, known)
    kept = ~slow
    signs = numpy.stack([numpy.ascontiguousarray(names[owner]).view(numpy.int64)[:, 0], count, high], axis=1)[kept]
    owner = owner[kept]
    unique, inverse = numpy.unique(signs, axis=0, return_inverse=True)
    for number, (name, n, is_large) in enumerate(unique.tolist()):
        rows = owner[inverse.ravel() == number]
        parts = [matrix[rows + k, 8:72] for k in range(n)]
        text = numpy.array([name]).tobytes().decode("latin-1").strip().rstrip("*").strip()
        found.append(Table(text, spread(numpy.hstack(parts), 16 if is_large else 8), lines[rows], file))
    return sorted(found, key=lambda table: table.lines[0])


def card_words(lines, place, known):
    """Name and fields of a card of lines (kind, text)."""
    fields, odd, name = [], False, None
    for number, (kind, text) in enumerate(lines):
        if kind == FREE:
            head, *words = (word.strip() for word in text.split(","))
        else:
            wide = 16 if kind == LARGE else 8
            head, words = text[:8].strip(), [text[at:at + wide].strip() for at in range(8, 72, wide)]
        wide = "*" in head if kind == FREE else kind == LARGE
        most = 4 if wide else 8
        if name is None:
            name = head.upper().rstrip("*").strip()
        if name in known and any(words[most + 1:]):
            raise Place(place.file, place.line + number).wrong(f"{name[:8]}: {len(words)} fields behind the name, at most {most}")
        if odd and not wide:
            fields += [""] * 4  # the second half of a line of large fields is left out
        fields += (words + [""] * most)[:most]
        odd = wide and not odd
    return name, fields


def repeated(name, fields, before, place):
    """The cards of one that begins with =: fields = are those of the card before, *(x) these and x more, == the rest; =(n) is n
    times the same step."""
    old_name, old, step = before
    times = REPEAT.match(name)
    if times:
        return [(old_name, [shifted(word, step.get(at), k, place) for at, word in enumerate(old)], step)
                for k in range(1, int(times[1]) + 1)]
    new, step = [], {}
    for at, word in enumerate(fields):
        last = old[at] if at < len(old) else ""
        if word == "==":
            new += old[at:]
            break
        found = STEP.match(word)
        if found:
            step[at] = found[1]
        new.append(shifted(last, found[1], 1, place) if found else last if word == "=" else word)
    return [(old_name if name == "=" else name, new, step)]


def shifted(word, step, times, place):
    """A number and `times` the step more."""
    if step is None:
        return word
    if WHOLE.match(word) and WHOLE.match(step):
        return str(int(word) + times * int(step))
    values = [REAL.match(text) for text in (word, step)]
    if not all(values):
        raise place.wrong(f"'{word}' and a step '{step}' are no numbers")
    one, other = (float(f"{found[1]}e{found[2] or found[3] or 0}") for found in values)
    return repr(one + times * other)


def slow_tables(cards, file, known):
    """Tables of cards (lines with their kinds, number of the first line), a card at a time."""
    groups, before = {}, None
    for lines, number in cards:
        place = Place(file, number)
        if lines[0][0] == FREE and lines[0][1].lstrip()[:6].upper() == "DEQATN":  # a formula
            made = [("DEQATN", [], {})]
        else:
            name, fields = card_words(lines, place, known)
            if name.startswith("=") and before is None:
                raise place.wrong("a card that repeats the one before, and there is none")
            made = repeated(name, fields, before, place) if name.startswith("=") else [(name, fields, {})]
        for name, fields, _ in made:
            groups.setdefault((name, len(fields)), []).append((fields, number))
        before = made[-1] if made else before
    found = []
    for (name, n), rows in groups.items():
        each = max([WIDTH, *(len(word) for fields, _ in rows for word in fields)])
        text = "".join(word.ljust(each) for fields, _ in rows for word in fields).encode("latin-1")
        letters = numpy.frombuffer(text, numpy.uint8).reshape(len(rows), n * each)
        found.append(Table(name, letters, numpy.array([line for _, line in rows]), file, each))
    return found
