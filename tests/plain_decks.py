"""A plain reading of the nodes and solid elements of decks, line by line, for test_import_fuzz.py: the places of the nodes of
each element, in the units of the deck. Nothing is checked, since what is read has been accepted."""

import re

import numpy as np

ABAQUS = {"C3D4": 4, "C3D6": 6, "C3D8": 8, "C3D8I": 8, "C3D8R": 8, "C3D10": 10, "C3D10M": 10, "C3D15": 15, "C3D20": 20,
          "C3D20R": 20, "C3D27": 27} | {f"C3D{n}H": n for n in (4, 6, 8, 10, 15, 20)} | {"C3D10MH": 10}


def cards(text):
    """(keyword, options, lines of data) of a deck of Abaqus."""
    found, header = [], None
    for line in re.sub(r"(?m)^[ \t]+(?=\*)", "", text).split("\n"):
        if line.startswith("**"):
            header = None
            continue
        if line.startswith("*") or header is not None:
            header = line if line.startswith("*") else header + line
            if line.startswith("*"):
                found.append([None, None, []])
            words = [word.strip() for word in header.split(",")]
            options = dict(word.partition("=")[::2] for word in words[1:])
            options = {key.strip().upper(): value.strip().upper() for key, value in options.items()}
            found[-1][:2] = " ".join(words[0][1:].split()).upper(), options
            header = header if line.rstrip().endswith(",") else None
        elif found and line.strip():
            found[-1][2].append(line)
    return found


def numbers(lines, width):
    """Rows of so many numbers, which go on over lines."""
    rows = [[float(re.sub("[dD]", "e", word)) for word in line.split(",") if word.strip()] for line in lines]
    if all(len(row) >= width for row in rows):
        rows = [row[:width] for row in rows]
    flat = [number for row in rows for number in row]
    return np.array(flat).reshape(-1, width) if flat else np.empty((0, width))


def node_rows(lines):
    """Number and place of each line; what is left out is 0, and what follows is of no use."""
    rows = [([float(re.sub("[dD]", "e", word)) if word.strip() else 0.0 for word in line.split(",")] + 3 * [0.0])[:4] for line in lines]
    return np.array(rows).reshape(-1, 4)


def moved(rows):
    """Matrix and shift of an instance."""
    values = [[float(re.sub("[dD]", "e", word)) if word.strip() else 0.0 for word in row.rstrip().rstrip(",").split(",")]
              for row in rows if row.strip()]
    shift, turn = np.array(values[0]) if values else np.zeros(3), np.eye(3)
    if len(values) > 1:
        a, b, angle = np.array(values[1][:3]), np.array(values[1][3:6]), np.radians(values[1][6])
        n = (b - a) / np.linalg.norm(b - a)
        turn = np.array([np.cos(angle) * e + (1 - np.cos(angle)) * (n @ e) * n + np.sin(angle) * np.cross(n, e) for e in np.eye(3)]).T
        shift = turn @ (shift - a) + a
    return turn, shift


def read_abaqus(text):
    parts, inside, outside, placed = {}, None, [], []
    for card in cards(text):
        if card[0] in ("PART", "INSTANCE"):
            inside = card, []
        elif inside and card[0] == f"END {inside[0][0]}":
            name = inside[0][1].get("NAME", "").strip('"')
            if inside[0][0] == "PART":
                parts[name] = inside[1]
            else:
                part = inside[0][1].get("PART", "").strip('"').strip()
                placed.append((parts.get(part, []) + inside[1], moved(inside[0][2])))
            inside = None
        elif inside:
            inside[1].append(card)
        else:
            outside.append(card)
    placed.append((outside, (np.eye(3), np.zeros(3))))
    return [nodes for members, motion in placed for nodes in elements_of(members, motion)]


def elements_of(members, motion):
    """Places of the nodes of the elements of one part."""
    place, found = {}, []
    for keyword, options, rows in members:
        if keyword == "NODE":
            for number, *x in node_rows(rows):
                if options.get("SYSTEM") == "C":
                    x = [x[0] * np.cos(np.radians(x[1])), x[0] * np.sin(np.radians(x[1])), x[2]]
                place[int(number)] = motion[0] @ np.array(x) + motion[1]
    for keyword, options, rows in members:
        n = ABAQUS.get(options.get("TYPE", "").strip('"')) if keyword == "ELEMENT" else None
        found += [[place[int(k)] for k in row[1:]] for row in numbers(rows, n + 1)] if n else []
    return found


NASTRAN = {"CTETRA": (4, "01 12 20 03 13 23".split()), "CPENTA": (6, "01 12 20 03 14 25 34 45 53".split()),
           "CHEXA": (8, "01 12 23 30 04 15 26 37 45 56 67 74".split())}


def nastran_real(word):
    return float(re.sub(r"(?<=[\d.])[eEdD]?([-+]\d+)$", r"e\1", re.sub("[dD](?=[0-9])", "e", word))) if word else 0.0


def nastran_fields(text):
    """Names and fields of cards."""
    found = []
    begin, end = re.search(r"(?im)^[ \t]*begin[ \t]+bulk.*$", text), re.search(r"(?im)^[ \t]*enddata\b", text)
    for line in text[begin.end() if begin else 0:end.start() if end else None].split("\n"):
        line = line.partition("$")[0].expandtabs(8)
        if not line[:72].strip():
            continue
        if "," in line[:72]:
            head, *words = (word.strip() for word in line.split(","))
            words = (words + [""] * 8)[:4 if head.endswith("*") else 8]
        else:
            wide = 16 if "*" in line[:8] else 8
            head, words = line[:8].strip(), [line[at:at + wide].strip() for at in range(8, 72, wide)]
        if (line[0] in "+*," or not line[:8].partition(",")[0].strip()) and found:
            found[-1][1].extend(words)
        else:
            found.append((head.rstrip("*").strip().upper(), words))
    return found


def read_nastran(text):
    fields = nastran_fields(text)
    systems = {0: (np.eye(3), np.zeros(3), False)}
    waiting = [(name, words) for name, words in fields if name in ("CORD2R", "CORD2C")]
    for _ in range(len(waiting) + 1):
        for name, words in waiting:
            base = int(words[1] or 0)
            if base in systems and int(words[0]) not in systems:
                a, b, c = (placed(systems[base], [nastran_real(word) for word in words[k:k + 3]]) for k in (2, 5, 8))
                z = (b - a) / np.linalg.norm(b - a)
                y = np.cross(z, c - a) / np.linalg.norm(np.cross(z, c - a))
                systems[int(words[0])] = np.array([np.cross(y, z), y, z]), a, name.endswith("C")
    place = {int(words[0]): placed(systems[int(words[1] or 0)], [nastran_real(word) for word in words[2:5]])
             for name, words in fields if name == "GRID"}
    found = []
    for name, words in fields:
        if name in NASTRAN:
            n, edges = NASTRAN[name]
            nodes = [int(word) if word else 0 for word in (words[2:] + [""] * 20)[:n + len(edges)]]
            made = any(nodes[n:])  # of second order, where a node that is left out is in the middle
            found.append([place[node] for node in nodes[:n]] + [
                place[node] if node else (np.array(place[nodes[int(a)]]) + place[nodes[int(b)]]) / 2
                for node, (a, b) in zip(nodes[n:], edges) if made])
    return found


def placed(system, x):
    axes, origin, cylinder = system
    if cylinder:
        x = [x[0] * np.cos(np.radians(x[1])), x[0] * np.sin(np.radians(x[1])), x[2]]
    return np.array(x) @ axes + origin


SOLIDS = {185: 8, 45: 8, 186: 20, 95: 20, 187: 10, 92: 10, 285: 4}


def ansys_fields(form, row):
    """Texts of the fields of a line by a format of Fortran."""
    kinds = re.findall(r"(\d*)p?[iaegf](\d+)", re.sub(r"\.\d+(e\d+)?", "", form.lower()))
    widths = [int(width) for count, width in kinds for _ in range(int(count or 1))]
    ends = np.cumsum([0, *widths])
    return [row[a:b].strip() for a, b in zip(ends, ends[1:])]


def ansys_types(rows):
    """Numbers of ET, whose words may be parameters."""
    said, kinds = {}, {}
    for k, row in enumerate(rows):
        row = row.partition("!")[0]
        value = re.match(r"\s*(?:\*SET\s*,\s*(\w+)\s*,|(\w+)\s*=)\s*(\S+)\s*$", row, re.IGNORECASE)
        if value:
            said[(value[1] or value[2]).upper()] = value[3]
        words = [word.strip().upper() for word in row.split(",")]
        if words[0] == "ET":
            number, kind = (said.get(word, word) for word in words[1:3])
            kinds[int(number)] = int(re.sub("^[A-Z]+", "", kind))
        if words[0] == "ETBLOCK":
            for row in rows[k + 2:]:
                if row.strip() == "-1":
                    break
                number, kind = ansys_fields(rows[k + 1], row)[:2]
                kinds[int(number)] = int(kind)
    return kinds


def read_ansys(text):
    rows, place, found, k = text.split("\n"), {}, [], 0
    kinds = ansys_types(rows)
    while k < len(rows):
        head = [word.strip().upper() for word in rows[k].partition("!")[0].split(",")]
        k += 1
        if head[0] not in ("NBLOCK", "EBLOCK"):
            continue
        form, lines = rows[k], []
        k += 1
        while not re.match(r"\s*-1\s*$", rows[k]) and not (head[0] == "NBLOCK" and re.match(r"\s*N\s*,", rows[k], re.IGNORECASE)):
            lines.append(ansys_fields(form, rows[k]))
            k += 1
        if head[0] == "NBLOCK":
            n_whole = sum(int(count or 1) for count in re.findall(r"(\d*)i\d+", form.lower()))
            place |= {int(words[0]): [float(re.sub("[dD]", "e", word or "0")) for word in words[n_whole:n_whole + 3]] for words in lines}
        else:
            lines = [[int(word or 0) for word in words] for words in lines]
            found += [(kinds[head_[1]], nodes) for head_, nodes in (split_solids(lines) if head[2].startswith("SOLID") else
                                                                   ((row, row[5:]) for row in lines))]
    solids = [((nodes + [0] * 20)[:SOLIDS[kind]], place) for kind, nodes in found if kind in SOLIDS]
    return [nodes for nodes in (unfolded(*solid) for solid in solids) if nodes]


def unfolded(numbers, place):
    """Places of the nodes of an element, each once; a middle that is left out is made, where others are there. No pyramids."""
    n = 8 if len(numbers) in (8, 20) else 4
    corners, middles = numbers[:n], numbers[n:]
    if n == 8 and len(set(corners[4:])) == 1 and corners[2] != corners[3]:
        return None
    found = dict.fromkeys(corners)
    nodes = [place[number] for number in found]
    if not any(middles):
        return nodes
    edges = {}
    for number, (a, b) in zip(middles, SECOND[n].split()):
        ends = frozenset((corners[int(a)], corners[int(b)]))
        if len(ends) == 2:
            edges[ends] = edges.get(ends) or number
    return nodes + [place[number] if number else np.mean([place[end] for end in ends], axis=0) for ends, number in edges.items()]


SECOND = {4: "01 12 20 03 13 23", 8: "01 12 23 30 45 56 67 74 04 15 26 37"}


def split_solids(rows):
    """The eleven numbers before the nodes of each element, and its nodes, of one line or two."""
    at = 0
    while at < len(rows):
        long = rows[at][8] > 8
        yield rows[at], rows[at][11:19] + (rows[at + 1] if long else [])
        at += 1 + long


READ = {"inp": read_abaqus, "bdf": read_nastran, "cdb": read_ansys}
