"""Modes of datasets 55 and 2414 of a universal file: numbers at nodes behind titles and numbers of the mode. Dataset 2414 has the same with
other heads: its natural frequency and damping in the sixth line behind the titles, a complex eigenvalue in the seventh."""

import math
from dataclasses import dataclass

from .universal import FREE, TITLES, integers, reals, shown, words

NORMAL, COMPLEX, COMPLEX_VELOCITY = 2, 3, 7  # analyses that are modes
ANALYSES = {0: "unknown", 1: "static", 4: "transient", 5: "frequency response", 6: "buckling", 9: "static, not linear"}
WIDTHS = {2: 3, 3: 6}  # characteristic of the data -> values of a node
PLACES = {2: "on elements", 3: "at nodes on elements", 5: "at points"}  # of dataset 2414
FACTS = 6  # numbers in each of the two lines of dataset 2414 that have those of the mode


@dataclass
class Shape:
    """A mode: natural frequency (Hz), damping ratio, or nan; values [nodes][3] by label of the node."""
    where: str
    title: str
    freq: float
    damping: float
    values: dict


def shape_55(reader, data):
    """A mode; data of other analyses are left out with a line."""
    lines, first = data.lines, data.line
    head = integers(lines[TITLES], 6) if len(lines) > TITLES + 2 else None
    if head is None:
        raise reader.wrong(first + min(TITLES, len(lines)), "dataset 55 must have five titles, then six whole numbers")
    numbers = integers(lines[TITLES + 1])
    if not numbers or len(numbers) < 2 or numbers[0] != len(numbers) - 2 or not 0 <= numbers[1] <= 48:
        raise reader.wrong(first + TITLES + 1, f"{shown(lines[TITLES + 1])} must be two counts and as many whole numbers as the first says")
    begin = TITLES + 2 + -(-numbers[1] // 6)
    facts = reals(b" ".join(lines[TITLES + 2:begin]))
    if facts is None or len(facts) != numbers[1]:
        raise reader.wrong(first + TITLES + 2, f"must be {numbers[1]} numbers, as the line above states")
    if is_mode(reader, data, head):
        least = 4 if head[1] == NORMAL else 2
        if len(facts) < least:
            raise reader.wrong(first + TITLES + 1, f"a mode of analysis {head[1]} has {least} numbers at least, here are {len(facts)}")
        of = (facts[0], *facts[2:4]) if head[1] == NORMAL else of_eigenvalue(*facts[:2])
        add(reader, data, TITLES, head, begin, of)


def shape_2414(reader, data):
    """The same of dataset 2414."""
    lines, first, behind = data.lines, data.line, FREE[2414]
    place = integers(lines[2], 1) if len(lines) > behind + 4 else None
    if place is None:
        raise reader.wrong(first + min(2, len(lines)), "dataset 2414 must have a label, a name, where its data are, five titles and five "
                           "lines of numbers")
    head = integers(lines[behind], 6)
    if head is None:
        raise reader.wrong(first + behind, f"{shown(lines[behind])} is not six whole numbers")
    for k in (behind + 1, behind + 2):
        if integers(lines[k]) is None:
            raise reader.wrong(first + k, f"{shown(lines[k])} is not whole numbers")
    facts = [reals(lines[k]) for k in (behind + 3, behind + 4)]
    for k, row in enumerate(facts, behind + 3):
        if row is None or len(row) != FACTS:
            raise reader.wrong(first + k, f"{shown(lines[k])} is not six numbers")
    if place[0] != 1:
        reader.leave(f"dataset 2414 {PLACES.get(place[0], f'of location {place[0]}')}, not at nodes", first)
    elif is_mode(reader, data, head):
        (_, freq, _, _, damping, hysteretic), eigenvalue = facts
        is_real = head[1] == NORMAL or not eigenvalue[:2].any()
        add(reader, data, behind, head, behind + 5, (freq, damping, hysteretic) if is_real else of_eigenvalue(*eigenvalue[:2]))


def is_mode(reader, data, head):
    """Whether these are vectors of a mode; other data have a line."""
    _, analysis, kind = head[:3]
    if analysis in (NORMAL, COMPLEX, COMPLEX_VELOCITY) and kind in WIDTHS:
        return True
    what = f"of analysis {analysis} ({ANALYSES.get(analysis, 'unknown')}), no modes" if kind in WIDTHS else \
        f"of characteristic {kind}, not vectors"
    reader.leave(f"dataset {data.number} {what}", data.line)
    return False


def of_eigenvalue(growth, omega):
    """Natural frequency as of the imaginary part, damping ratio; no hysteretic damping."""
    size = math.hypot(growth, omega)
    return abs(omega) / (2 * math.pi), -growth / size if size else math.nan, 0


def add(reader, data, head_at, head, begin, of):  # pylint: disable=too-many-arguments
    """Adds a mode of frequency, damping ratio and hysteretic damping `of`, whose values begin at a line."""
    _, _, kind, _, form, width = head
    freq, damping, hysteretic = of
    if form not in (2, 4, 5, 6) or width != WIDTHS[kind]:
        raise reader.wrong(data.line + head_at, f"data of type {form} with {width} values: must be 2, 4, 5 or 6, with {WIDTHS[kind]}")
    values = values_of(reader, data, begin, width * (2 if form > 4 else 1))
    if form > 4:
        values = {label: row[::2] + 1j * row[1::2] for label, row in values.items()}
    if width == 6 and any(abs(row[3:]).any() for row in values.values()):
        reader.leave(f"rotations of dataset {data.number}", data.line)
    if hysteretic and not damping:
        reader.leave(f"hysteretic damping of dataset {data.number}, taken as half of it viscous,", data.line)
        damping = hysteretic / 2
    if freq < 0 or not (-1 <= damping <= 1 or math.isnan(damping)):
        raise reader.wrong(data.line + head_at + 2, f"a mode of {freq:g} Hz with damping ratio {damping:g} is none")
    name = next((words(line) for line in data.lines[head_at - TITLES:head_at] if words(line).upper() not in ("", "NONE")), "")
    reader.to.shapes.append(Shape(f"{reader.path}:{data.line}", name, freq, damping if damping else math.nan,
                                  {label: row[:3] for label, row in values.items()}))


def values_of(reader, data, begin, count):
    """Values by label of the node."""
    found, step = {}, 1 + -(-count // 6)
    for k in range(begin, len(data.lines), step):
        label, row = integers(data.lines[k], 1), reals(b" ".join(data.lines[k + 1:k + step]))
        if label is None or label[0] < 1:
            raise reader.wrong(data.line + k, f"{shown(data.lines[k])} is no label of a node")
        if row is None or len(row) != count:
            raise reader.wrong(data.line + k + 1, f"node {label[0]} must have {count} numbers")
        if label[0] in found:
            raise reader.wrong(data.line + k, f"node {label[0]} stands twice in one shape")
        found[label[0]] = row
    return found
