"""Ansys' archives (CDWRITE) and inputs of Workbench: blocks of nodes, elements and components, and commands with commas."""

import re

import numpy

from ...tables import BadInput
from . import bolts as ansys_bolts, friction as ansys_friction, sections as ansys_sections, joined as ansys_joined
from . import mesh as ansys_mesh, model as ansys_model
from .blocks import BLOCK, DATABASE, Command, read_block
from ..deck import Deck, Place
from ..text import line_starts, read_bytes

# Say nothing of the model, as do all that begin with /
PLAIN = {"*IF", "*ENDIF", "*ELSE", "*ELSEIF", "*MSG", "*GET", "DOF", "NUMOFF", "EXTOPT", "FINISH", "FINI", "SHPP", "TREF", "IRLF", "BFUNIF",
         "ERESX", "_CDRDOFF=", "MPTEMP", "ANTYPE", "SOLVE", "MXPAND", "CSYS", "TYPE", "MAT", "REAL", "ESYS", "SECNUM", "TSHAPE", "ETCON",
         "CMSEL", "NSEL", "ESEL", "ALLSEL", "CMDEL", "NUMCMP", "OUTRES", "OUTPR", "SAVE", "RESCONTROL", "TIME", "KUSE", "NEQIT", "NCNV",
         "CRPLIM", "TOFFST", "LSCLEAR"}
NOTHING = {"OMEGA", "DOMEGA", "CGLOC", "CGOMEGA", "DCGOMG", "ALPHAD", "BETAD", "DMPRAT", "DMPSTR"}  # where all values are 0
REPLACED = {"ET", "KEYOPT", "MP", "MPDATA", "TB", "TBDATA", "TBFIELD", "TBTEMP", "TBDELE"}  # whose words may be parameters
SET = re.compile(r"(?:\*SET\s*,\s*(\w+)\s*,|(\w+)\s*=)\s*([-+.\deE]+)\s*$", re.IGNORECASE)
ROWS = re.compile(r"(?:\*SET\s*,\s*(\w+)\s*\(\s*(\d+)[\s,1]*\)\s*,|(\w+)\s*\(\s*(\d+)[\s,1]*\)\s*=)\s*([-+.\deE,\s]+)$", re.IGNORECASE)
ASSIGNED = re.compile(r"\w+\s*(?:\([^)]*\))?\s*=")


def commands_of(path, text, first, parameters):
    """Commands of lines outside of blocks, and of parts of a line between $; numbers alone on a line belong to the command before.
    `parameters` keeps those that are numbers, and of arrays their rows of one column."""
    found, before = [], ""
    for number, line in enumerate(text.decode("latin-1").lstrip("\xef\xbb\xbf").split("\n"), first):
        line = line.partition("!")[0].strip()
        if not line or line.startswith("/"):
            continue
        value = SET.match(line)
        if value:
            parameters[(value[1] or value[2]).upper()] = value[3]
            continue
        if keep_rows(line, parameters):
            continue
        if ASSIGNED.match(line):
            line = "*SET"
        words = [word.strip() for word in line.split(",")]
        if re.match(r"[-+.\d(]", words[0]):
            if found and found[-1].words[0] in ("RLBLOCK", "SECBLOCK"):
                found[-1].lines.append(line)
                continue
            if found and DATABASE.match(found[-1].words[-1]) and before == found[-1].words[0]:
                found[-1].words[-1:] = words[0].split() if len(words) == 1 else words
            continue
        for part in line.split("$") if not line.startswith("*") else [line]:
            words = [word.strip() for word in part.split(",")]
            before = words[0] = words[0].upper().split(" ")[0]
            if before.startswith("KEYO"):
                words[0] = "KEYOPT"
            if words[0] in REPLACED:
                words[1:] = [parameters.get(word.upper(), word) for word in words[1:]]
            if words[0]:
                found.append(Command(words, Place(str(path), number)))
            if words[0] == "RBE3":
                found[-1].words, found[-1].lines = rows_of(line, parameters)
    return found


def keep_rows(line, parameters):
    """Keeps rows of an array of one column: *DIM,NAME,ARRAY,n and *SET,NAME(i),value,... or NAME(i)=value,..."""
    words, rows = [word.strip().upper() for word in line.split(",")], ROWS.match(line)
    if words[0] == "*DIM" and len(words) > 3 and words[2] in ("", "ARRAY") and set(words[4:]) <= {"", "1"} and words[3].isdigit():
        parameters[f"{words[1]}("] = {row: "0" for row in range(1, int(words[3]) + 1)}
        return True
    array = parameters.get(f"{(rows[1] or rows[3]).upper()}(") if rows else None
    if array is None:
        return False
    array |= {int(rows[2] or rows[4]) + k: word.strip() for k, word in enumerate(rows[5].split(",")) if word.strip()}
    return True


def rows_of(line, parameters):
    """Words of RBE3, master, freedoms, NAME(i), NAME(i), and of both arrays the rows from i on."""
    found = []
    for name, first in re.findall(r"(\w+)\s*\(\s*(\d+)[\s,1]*\)", line):
        rows = parameters.get(f"{name.upper()}(", {})
        found.append([rows[row] for row in sorted(rows) if row >= int(first)])
    return [word.strip() for word in re.sub(r"\([^)]*\)", "", line).upper().split(",")], found


def is_idle(command):
    """Whether a command is no part of the model."""
    if command.words[0] in ("N", "EN"):  # the end of a block
        return "-1" in command.words
    return command.words[0] in PLAIN or command.words[0] in NOTHING and not any(
        re.search(r"[1-9]", word) for word in command.words[1:])


def read_ansys(path):
    """The deck of a file."""
    data = read_bytes(path)
    starts, at, blocks, commands, parameters = line_starts(data), 0, [], [], {}
    while True:
        match = BLOCK.search(data, at)
        end = match.start() if match else len(data)
        commands += commands_of(path, data[at:end], int(numpy.searchsorted(starts, at, side="right")), parameters)
        if not match:
            break
        block, at = read_block(path, data, starts, match)
        blocks.append(block)
        if block.name in ("DBLOCK", "FBLOCK"):
            commands += of_block(block)
    if not any(block.name == "NBLOCK" for block in blocks):
        raise BadInput(f"{path}:1: there is no NBLOCK; is this an archive of Ansys (CDWRITE, blocked)?")
    deck = Deck(path, "Ansys")
    mesh = ansys_mesh.read_mesh(deck, blocks, commands)
    if not deck.n_cells:
        return deck
    taken = ansys_bolts.read_bolts(deck, commands, mesh)
    commands = [command for command in commands if not any(command is other for other in taken)]
    sections, taken = ansys_sections.read_sections(commands)
    commands = [command for command in commands if not any(command is other for other in taken)]
    ansys_sections.set_shells(deck, mesh, sections, ansys_joined.real_constants(commands))
    ansys_sections.read_beams(deck, mesh, sections)
    ansys_joined.read_joined(deck, commands, mesh)
    friction, taken = ansys_friction.read_tables(deck, commands)
    commands = [command for command in commands if not any(command is other for other in taken)]
    ansys_model.read_model(deck, commands, mesh, friction)
    if not any(command.words[0] in ("FINISH", "FINI", "SOLVE") for command in commands):
        deck.note(Place(str(path), len(starts) - 1), "there is no FINISH: is the file whole?")
    for command in commands:
        if not is_idle(command) and command.words[0] not in ansys_mesh.KNOWN | ansys_model.KNOWN | ansys_joined.KNOWN:
            deck.note(command.place, f"{command.words[0][:20]}: not understood")
    return deck


def of_block(block):
    """DBLOCK and FBLOCK: a node, a label and two values a line, as D and F."""
    letters = block.letters()
    return [Command([block.name[0], *block.words(row, letters)], block.place(row)) for row in range(block.n_lines)]
