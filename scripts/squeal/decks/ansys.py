"""Ansys' archives (CDWRITE): blocks of nodes, elements and components in fixed columns, and commands with commas."""

import re
from dataclasses import dataclass

import numpy

from ..tables import BadInput
from . import ansys_mesh, ansys_model
from .deck import Deck, Place
from .text import columns, line_starts, matrix_of, read_bytes, real, whole

BLOCK = re.compile(rb"^[ \t]*(NBLOCK|EBLOCK|CMBLOCK)[ \t]*,[^\n]*$", re.IGNORECASE | re.MULTILINE)
FORMAT = re.compile(r"\(\s*(\d+)\s*i\s*(\d+)\s*(?:,\s*(\d+)\s*e\s*(\d+)\.\d+(?:e\d+)?\s*)?\)$", re.IGNORECASE)
END = {"NBLOCK": re.compile(rb"^[ \t]*(?:N[ \t]*,|-1[ \t]*$)[^\n]*", re.IGNORECASE | re.MULTILINE),
       "EBLOCK": re.compile(rb"^[ \t]*-1[ \t]*$", re.MULTILINE)}
# Say nothing of the model
CONTROL = {"/COM", "/PREP7", "/NOPR", "/GOPR", "/GO", "/TITLE", "/SOLU", "/UNITS", "/BATCH", "/POST1", "*IF", "*ENDIF", "*ELSE",
           "/WB", "/DEBUG", "/CONFIG", "/STATUS", "/FILNAME"}
PLAIN = {"DOF", "NUMOFF", "EXTOPT", "FINISH", "FINI", "SHPP", "TREF", "IRLF", "BFUNIF", "ERESX", "_CDRDOFF=", "MPTEMP",
         "ANTYPE", "SOLVE", "MXPAND", "CSYS"}


@dataclass
class Command:
    """A line with commas."""
    words: list
    place: Place

    def word(self, number):
        return self.words[number] if number < len(self.words) else ""

    def real(self, number, default=0.0):
        return real(self.word(number), self.place) if self.word(number) else default

    def whole(self, number, default=0):
        return whole(self.word(number), self.place) if self.word(number) else default


@dataclass
class Blocked:
    """A block: its header, lines of data as (offsets in `data`, numbers), fields of the format."""
    header: Command
    data: bytes
    starts: numpy.ndarray  # offsets of all lines of the file
    first: int  # line of the first data, from 0
    n_lines: int
    n_whole: int
    width: int
    n_real: int
    real_width: int

    def place(self, row):
        return Place(self.header.place.file, self.first + row + 1)

    def letters(self):
        """Lines as characters; none may be longer than the format."""
        rows = numpy.arange(self.first, self.first + self.n_lines)
        most = self.n_whole * self.width + self.n_real * self.real_width
        length = numpy.diff(self.starts)[rows] - 1
        found = matrix_of(self.data, self.starts, rows, max(int(length.max(initial=0)), most))
        beyond = (found[:, most:] != ord(" ")).any(axis=1)
        if beyond.any():
            raise self.place(int(beyond.argmax())).wrong(f"{self.header.words[0]}: a line is longer than its format")
        return found[:, :most]

    def wholes(self, letters):
        return columns(letters[:, :self.n_whole * self.width], self.width, int,
                       lambda row, _, word: whole(word, self.place(row)))

    def reals(self, letters):
        return columns(letters[:, self.n_whole * self.width:], self.real_width, float,
                       lambda row, _, word: real(word, self.place(row)))


def read_block(path, data, starts, match):
    """The block of a header, and the offset behind it."""
    number = int(numpy.searchsorted(starts, match.start(), side="right")) - 1
    header = Command([word.strip() for word in match[0].decode("latin-1").partition("!")[0].split(",")], Place(str(path), number + 1))
    name = header.words[0] = header.words[0].upper()
    if number + 2 >= len(starts):
        raise header.place.wrong(f"{name} has no data: is the file cut off?")
    text = data[starts[number + 1]:starts[number + 2] - 1].decode("latin-1").strip()
    found = FORMAT.match(text)
    if not found:
        raise Place(str(path), number + 2).wrong(f"{name}: '{text[:40]}' is no format such as (3i9,6e21.13e3)")
    n, width, n_real, real_width = (int(part or 0) for part in found.groups())
    if not (1 <= n <= 30 and 1 <= width <= 30 and n_real <= 12 and real_width <= 40):
        raise Place(str(path), number + 2).wrong(f"{name}: format {text[:40]} is not read")
    first = number + 2
    if name == "CMBLOCK":
        count = header.whole(3, -1)
        if count < 0:
            raise header.place.wrong("CMBLOCK needs the number of its items")
        last = first + -(-count // n)
        if last >= len(starts):
            raise header.place.wrong(f"CMBLOCK announces {count} items, and the file ends before: is it cut off?")
        return Blocked(header, data, starts, first, last - first, n, width, 0, 1), int(starts[last])
    end = END[name].search(data, starts[first] if first < len(starts) else len(data))
    if not end:
        raise header.place.wrong(f"{name} has no end (a line with -1): is the file cut off?")
    last = int(numpy.searchsorted(starts, end.start(), side="right")) - 1
    return Blocked(header, data, starts, first, last - first, n, width, n_real, real_width), end.end()


def commands_of(path, text, first):
    """Commands of lines outside of blocks; numbers alone on a line go on the command before."""
    found = []
    for number, line in enumerate(text.decode("latin-1").split("\n"), first):
        line = line.partition("!")[0].strip()
        words = [word.strip() for word in line.split(",")]
        if not line or words[0].upper().split(" ")[0] in CONTROL:
            continue
        if found and found[-1].words[0] == "RLBLOCK" and re.match(r"[(\-+.\d]", words[0]):
            continue
        if re.match(r"[-+.\d]", words[0]) and found and found[-1].words[-1].upper().startswith("R5"):
            found[-1].words[-1:] = words[0].split() if len(words) == 1 else words
            continue
        words[0] = words[0].upper()
        found.append(Command(words, Place(str(path), number)))
    return found


def read_ansys(path):
    """The deck of a file."""
    data = read_bytes(path)
    starts, at, blocks, commands = line_starts(data), 0, [], []
    while True:
        match = BLOCK.search(data, at)
        end = match.start() if match else len(data)
        commands += commands_of(path, data[at:end], int(numpy.searchsorted(starts, at, side="right")))
        if not match:
            break
        block, at = read_block(path, data, starts, match)
        blocks.append(block)
    if not any(block.header.words[0] == "NBLOCK" for block in blocks):
        raise BadInput(f"{path}:1: there is no NBLOCK; is this an archive of Ansys (CDWRITE, blocked)?")
    deck = Deck(path, "Ansys")
    mesh = ansys_mesh.read_mesh(deck, blocks, commands)
    ansys_model.read_model(deck, commands, mesh)
    if not any(command.words[0] in ("FINISH", "FINI") for command in commands):
        deck.note(Place(str(path), len(starts) - 1), "there is no FINISH: is the file whole?")
    for command in commands:
        if command.words[0] not in PLAIN | ansys_mesh.KNOWN | ansys_model.KNOWN:
            deck.note(command.place, f"{command.words[0][:20]}: not understood")
    return deck
