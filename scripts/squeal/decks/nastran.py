"""Decks of Nastran: bulk data in fields of 8 (small) or 16 characters (large), or with commas (free). Cards of one name, width
and length are read together."""

import re

import numpy

from ..tables import BadInput
from . import nastran_loads, nastran_mesh, nastran_model
from .deck import Deck, Place
from .text import columns, line_starts, matrix_of, read_bytes

DEEPEST = 10
WIDTH = 16  # of the fields of a table
# e.g. 1.5-3 for 1.5e-3
REAL = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+))(?:[eEdD]?([+-]\d{1,3})|[eEdD](\d{1,3}))?$")
WHOLE = re.compile(r"[+-]?\d{1,15}$")


class Table:
    """Cards of one name with as many fields: characters [n][fields * 16] behind the name, and the line of each."""

    def __init__(self, name, letters, lines, file):
        self.name, self.letters, self.lines, self.file = name, letters, lines, file
        self.width = letters.shape[1] // WIDTH

    def __len__(self):
        return len(self.lines)

    def place(self, row):
        return Place(self.file, int(self.lines[row]))

    def wrong(self, row, column, word, what):
        """The error for a field, which is the (column + 2)-th with the name."""
        return self.place(row).wrong(f"{self.name}: field {column + 2} '{word}' should be {what}")

    def part(self, first, last):
        """Characters of fields first to last - 1; those beyond the end are blank."""
        letters = self.letters[:, first * WIDTH:last * WIDTH]
        missing = (last - first) * WIDTH - letters.shape[1]
        return numpy.pad(letters, ((0, 0), (0, missing)), constant_values=ord(" ")) if missing else letters

    def whole(self, first, last):
        """Whole numbers [n][last - first]; blank is 0."""
        def one(row, column, word):
            if not WHOLE.match(word):
                raise self.wrong(row, column + first, word, "a whole number")
            return int(word)
        return columns(self.part(first, last), WIDTH, int, one)

    def real(self, first, last):
        """Numbers [n][last - first]; blank is 0."""
        def one(row, column, word):
            return self.one_real(row, column + first, word)
        return columns(self.part(first, last), WIDTH, float, one)

    def one_real(self, row, column, word):
        found = REAL.match(word)
        value = float(f"{found[1]}e{found[2] or found[3] or 0}") if found else numpy.nan
        if not abs(value) < 1e300:
            raise self.wrong(row, column, word, "a number")
        return value

    def words(self, row):
        """Fields of one card as text."""
        text = self.letters[row].tobytes().decode("latin-1")
        return [text[at:at + WIDTH].strip() for at in range(0, len(text), WIDTH)]


def spread(letters, width):
    """Fields of `width` characters in fields of WIDTH."""
    n, k = len(letters), letters.shape[1] // width
    found = numpy.full((n, k, WIDTH), ord(" "), numpy.uint8)
    found[:, :, :width] = letters.reshape(n, k, width)
    return found.reshape(n, k * WIDTH)


def heads_of(matrix):
    """Names of cards [n] in capitals, and which lines go on the card before them."""
    names = numpy.ascontiguousarray(matrix[:, :8])
    names[(names >= ord("a")) & (names <= ord("z"))] -= 32
    return names, numpy.isin(names[:, 0], [ord(letter) for letter in "+*, "])


def tables_of(data, first, file):
    """Tables of bulk data that begins on line `first`."""
    starts = line_starts(data)
    letters = numpy.frombuffer(data, numpy.uint8)
    if b"\t" in data:
        line = first + data.count(b"\n", 0, data.index(b"\t"))
        raise Place(file, line).wrong("a tabulator: write fields of 8 or 16 characters, or commas")
    length = numpy.diff(starts) - 1
    filled = numpy.flatnonzero(length > 0)
    filled = filled[letters[starts[filled]] != ord("$")]
    if not len(filled):
        return []
    matrix = matrix_of(data, starts, filled, 80)
    blank = (matrix[:, :72] == ord(" ")).all(axis=1)
    matrix, filled = matrix[~blank], filled[~blank]
    names, goes_on = heads_of(matrix)
    if goes_on.any() and goes_on[0]:
        raise Place(file, first + int(filled[0])).wrong("a line that goes on a card, and there is none before it")
    free = (matrix[:, :72] == ord(",")).any(axis=1)
    comment = matrix[:, :72] == ord("$")
    for row in numpy.flatnonzero(comment.any(axis=1)):
        matrix[row, int(comment[row].argmax()):] = ord(" ")
    owner = numpy.flatnonzero(~goes_on)
    count = numpy.diff(numpy.append(owner, len(matrix)))
    n_free = numpy.add.reduceat(free.astype(int), owner)
    is_free = n_free > 0
    large = (matrix[:, :8] == ord("*")).any(axis=1)
    mixed = numpy.add.reduceat(large.astype(int), owner)
    lines = first + filled
    bad = numpy.flatnonzero(is_free & (n_free != count))
    if len(bad):
        raise Place(file, int(lines[owner[bad[0]]])).wrong("a card of which some lines have commas and others have not")
    found = free_tables([(matrix[at:at + n], int(lines[at])) for at, n in zip(owner[is_free], count[is_free])], file)
    bad = numpy.flatnonzero(~is_free & (mixed != 0) & (mixed != count))
    if len(bad):
        raise Place(file, int(lines[owner[bad[0]]])).wrong("small and large fields in one card")
    kinds = numpy.stack([numpy.ascontiguousarray(names[owner]).view(numpy.int64)[:, 0], count, mixed > 0], axis=1)
    kinds[is_free] = -1
    unique, inverse = numpy.unique(kinds, axis=0, return_inverse=True)
    for number, (name, n, is_large) in enumerate(unique.tolist()):
        if n < 0:
            continue
        rows = owner[inverse.ravel() == number]
        parts = [matrix[rows + k, 8:72] for k in range(n)]
        text = numpy.array([name]).tobytes().decode("latin-1").strip().rstrip("*").strip()
        found.append(Table(text, spread(numpy.hstack(parts), 16 if is_large else 8), lines[rows], file))
    return sorted(found, key=lambda table: table.lines[0])


def free_tables(cards, file):
    """Tables of cards with commas: (lines as characters, number of the first line)."""
    groups = {}
    for matrix, line in cards:
        fields = []
        for k, row in enumerate(matrix):
            words = row.tobytes().decode("latin-1").rstrip().split(",")
            head, words = words[0].strip(), [word.strip() for word in words[1:]]
            if k == 0:
                name, most = head.upper().rstrip("*"), 4 if head.endswith("*") else 8
            if len(words) > most + 1:
                raise Place(file, line + k).wrong(f"{name}: {len(words)} fields behind the name, at most {most}")
            words = words[:most]
            if any(len(word) > WIDTH for word in words):
                raise Place(file, line + k).wrong(f"{name}: a field of more than {WIDTH} characters")
            fields += words + [""] * (most - len(words))
        groups.setdefault((name, len(fields)), []).append((fields, line))
    found = []
    for (name, _), rows in groups.items():
        text = "".join(word.ljust(WIDTH) for fields, _ in rows for word in fields).encode("latin-1")
        letters = numpy.frombuffer(text, numpy.uint8).reshape(len(rows), -1)
        found.append(Table(name, letters, numpy.array([line for _, line in rows]), file))
    return found


INCLUDE = re.compile(rb"^[ \t]*include[ \t]+['\"]?([^'\"\n]+)['\"]?[ \t]*$", re.IGNORECASE | re.MULTILINE)
BEGIN = re.compile(rb"^[ \t]*begin[ \t]+bulk[^\n]*\n?", re.IGNORECASE | re.MULTILINE)
END = re.compile(rb"^[ \t]*enddata\b[^\n]*", re.IGNORECASE | re.MULTILINE)


def read_tables(deck, path, depth=0):
    """Tables of the bulk data of a file, and of those that it includes."""
    data = read_bytes(path)
    begin, end = BEGIN.search(data), END.search(data)
    if begin and not end:
        raise Place(str(path), data.count(b"\n") + 1).wrong("BEGIN BULK has no ENDDATA: is the file cut off?")
    first, last = begin.end() if begin else 0, end.start() if end else len(data)
    if last < first:
        raise Place(str(path), data.count(b"\n", 0, last) + 1).wrong("ENDDATA before BEGIN BULK")
    if not end and not depth:
        deck.note(Place(str(path), data.count(b"\n") + 1), "there is no ENDDATA: is the file whole?")
    if begin:
        list_case(deck, path, data[:begin.start()])
    bulk = data[first:last]
    found = []
    for name in INCLUDE.finditer(bulk):
        place = Place(str(path), data.count(b"\n", 0, first + name.start()) + 1)
        if depth == DEEPEST:
            raise place.wrong("files include each other too deeply")
        try:
            found += read_tables(deck, path.parent / name[1].decode("latin-1").strip(), depth + 1)
        except BadInput as error:
            raise (place.wrong(f"INCLUDE: {error}") if ":" not in str(error).split(" ")[0].rstrip(":") else error) from None
    bulk = INCLUDE.sub(lambda match: b"$", bulk)
    return found + tables_of(bulk, data.count(b"\n", 0, first) + 1, str(path))


def list_case(deck, path, text):
    """What stands before the bulk data says which supports and loads act, and what is computed: it is listed."""
    for number, line in enumerate(text.decode("latin-1").split("\n"), 1):
        word = line.strip()
        if word and not word.startswith("$"):
            deck.note(Place(str(path), number), f"{word.split()[0][:30]}: control, not read; all supports and loads are taken")


def read_nastran(path):
    """The deck of a file."""
    deck = Deck(path, "Nastran")
    tables = read_tables(deck, path)
    if not any(table.name == "GRID" for table in tables):
        raise BadInput(f"{path}:1: there is no GRID; is this a deck of Nastran?")
    mesh = nastran_mesh.read_mesh(deck, tables)
    nastran_model.read_model(deck, tables, mesh)
    nastran_loads.read_acting(deck, tables, mesh)
    for table in tables:
        if table.name not in nastran_mesh.KNOWN | nastran_model.KNOWN | nastran_loads.KNOWN:
            for row in range(len(table)):
                deck.note(table.place(row), f"{table.name}: not understood")
    return deck
