"""Ansys: friction of contact elements, by TB,FRIC of their material over temperature, slip rate and pressure, or by MU, of which the real
constants FACT and DC make the law MU (1 + (FACT - 1) exp(-DC s))."""

from ..friction import law_of, unlike
from ..text import REAL

FIELDS = {"SLRV": 1, "NPRES": 2, "CPRES": 2, "TEMP": 3}  # of TBFIELD -> column of a line
FACT, DC = 20, 21  # places of real constants


def read_tables(deck, commands):
    """Number of a material -> (mu, lines of decks/friction.py) of TB,FRIC; and the commands that say so."""
    found, taken, at = {}, [], 0
    while at < len(commands):
        if commands[at].words[0] == "TBDELE" and commands[at].word(1).upper()[:4] in ("FRIC", "ALL"):
            forget(deck, commands[at], found)
            taken.append(commands[at])
            at += 1
            continue
        if commands[at].words[0] != "TB" or commands[at].word(1).upper()[:4] != "FRIC":
            at += 1
            continue
        end = at + 1
        while end < len(commands) and commands[end].words[0] != "TBDELE" and commands[end].words[0][:3] in ("TBD", "TBT", "TBF", "TBP"):
            end += 1
        own = commands[at:end]
        taken += own
        read_table(deck, own, found)
        at = end
    return found, taken


def forget(deck, command, found):
    """TBDELE: the table of a material, or of all, is none."""
    word = command.word(2).upper()
    for number in list(found) if word in ("", "ALL") else [command.whole(2)]:
        if found.pop(number, None):
            deck.differ(command.place, f"TBDELE: the table TB,FRIC,{number} before it is not taken")


def read_table(deck, own, found):
    """One table: the fields that stand when a value comes are those of its line."""
    head, lines, state = own[0], [], [0.0] * 4
    kind, number = next((word.upper() for word in head.words[3:] if word[:1].isalpha()), "ISO"), head.whole(2, 1)
    what = f"TB,FRIC,{number}"
    if kind not in ("ISO", "ORTHO", "EORTHO", "FORTHO"):
        deck.note(head.place, f"{what},,,{kind[:10]}: not understood; MU of the material counts, if it has one")
        return
    for command in own[1:]:
        word, key = command.words[0], command.word(1).upper()
        if word.startswith("TBT"):
            state[3] = command.real(1)
        elif word.startswith("TBF") and key in FIELDS:
            state[FIELDS[key]] = command.real(2)
        elif word.startswith("TBF"):
            deck.note(command.place, f"{what}: depends on {key[:10]}, which squeal's friction does not; not taken")
            return
        elif word.startswith("TBD") and command.whole(1, 1) == 1 and REAL.match(command.word(2)):
            if command.word(3) and command.real(3) != command.real(2):
                deck.note(command.place, f"{what}: another mu along the second direction, {command.word(3)}: the first is taken along both")
            lines.append((command.real(2), *state[1:]))
        else:
            deck.note(command.place, f"{what}: {word} {command.word(1)[:10]} is not understood; the table is not taken")
            return
    if not lines:
        deck.note(head.place, f"{what}: has no value (TBDATA,1,mu)")
        return
    if len(lines) == 1 or not unlike(lines):
        lines = lines[-1:]
    if number in found:
        deck.differ(head.place, f"{what}: takes the place of the one before it")
    found[number] = law_of(deck, head.place, what, lines)


def give_friction(deck, contact, number, material, tables, constants, real):
    """mu of a contact, or its law; `real` are its real constants."""
    fact, decay = (real[k] if len(real) > k else 0.0 for k in (FACT, DC))
    if material in tables:
        contact.mu, contact.table = tables[material]
    else:
        contact.mu = constants.get("MU", (0.0, None))[0]
    if not (fact > 0 and fact != 1):
        return
    if contact.table or not contact.mu:
        deck.note(contact.place, f"real constants {number}: FACT {fact:g} without a constant mu: not taken")
    elif not decay > 0:
        deck.note(contact.place, f"real constants {number}: FACT {fact:g}, static over kinetic friction, without a positive DC: the "
                                 f"kinetic mu, {contact.mu:g}, is taken")
    else:
        contact.decay = contact.mu * fact, contact.mu, 1 / decay
        contact.mu = max(contact.decay[:2])
