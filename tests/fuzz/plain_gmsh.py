"""A plain reading of files of Gmsh, 2.2 and 4.1, text and binary, of damaged ones too, and the same mesh written anew: an undamaged
file of format 2.2 in text, in which each element stands once for each of its physical names; a minus of a name's number, by which Gmsh
says that an element stands reversed, does not count. Little is checked: what is read has been
accepted."""

import re
import struct

NODES = {15: 1, 1: 2, 8: 3, 2: 3, 9: 6, 3: 4, 16: 8, 10: 9, 4: 4, 11: 10, 6: 6, 18: 15, 5: 8, 17: 20, 12: 27}  # of each type
DIMENSION = {15: 0} | dict.fromkeys((1, 8), 1) | dict.fromkeys((2, 9, 3, 16, 10), 2)  # of others 3
SECTION = re.compile(rb"^[ \t]*\$(\w+)[ \t\r]*\n", re.MULTILINE)


class Words:
    """Numbers one after the other, of text or of bytes."""

    def __init__(self, data, binary):
        self.data, self.binary, self.at = data, binary, 0
        self.words = None if binary else data.split()

    def take(self, form):
        """Numbers of a form of struct, or, in text, as many words: integers, and reals for d."""
        if self.binary:
            found = struct.unpack_from("<" + form, self.data, self.at)
            self.at += struct.calcsize("<" + form)
            return list(found)
        kinds = re.sub(r"(\d+)(\w)", lambda match: int(match[1]) * match[2], form)
        found = [(float if kind == "d" else int)(word) for kind, word in zip(kinds, self.words[self.at:self.at + len(kinds)])]
        if len(found) < len(kinds):
            raise ValueError("the file ends early")
        self.at += len(kinds)
        return found


def sections(data):
    """Bytes of each section, the first of a name."""
    found, at = {}, 0
    while match := SECTION.search(data, at):
        end = re.compile(rb"^[ \t]*\$End" + match[1] + rb"\b", re.MULTILINE).search(data, match.end())
        if not end:
            raise ValueError(f"{match[1]} has no end")
        found.setdefault(match[1].decode(), data[match.end():end.start()])
        at = end.end()
    return found


def names_of(part):
    """(dimension, number) -> name."""
    rows = [line.split(None, 2) for line in part["PhysicalNames"].decode("latin-1").splitlines()[1:] if line.strip()]
    return {(int(d), int(tag)): re.match(r'"(.*)"', name.strip())[1] for d, tag, name in rows}


def read_22(part, binary):
    """Places by number, and (type, group, nodes) of each element."""
    def body(name):
        count, _, rest = part[name].partition(b"\n")
        return int(count), Words(rest, binary)

    n, words = body("Nodes")
    nodes = {number: place for number, *place in (words.take("i3d") for _ in range(n))}
    n, words = body("Elements")
    elements = []
    while len(elements) < n:
        kind, count, n_tags = words.take("3i") if binary else (0, 1, 0)
        for _ in range(count):
            if binary:
                row = words.take(f"{1 + n_tags + NODES[kind]}i")
                elements.append((kind, abs(row[1]) if n_tags else 0, row[1 + n_tags:]))
            else:
                _, kind, n_tags = words.take("3i")
                tags = words.take(f"{n_tags}i")
                elements.append((kind, abs(tags[0]) if tags else 0, words.take(f"{NODES[kind]}i")))
    return nodes, elements


def entities_41(words):
    """Groups of each (dimension, entity)."""
    groups = {}
    for d, n in enumerate(words.take("4Q")):
        for _ in range(n):
            tag, = words.take("i")
            words.take("3d" if d == 0 else "6d")
            groups[d, tag] = words.take(f"{words.take('Q')[0]}i")
            if d:
                words.take(f"{words.take('Q')[0]}i")
    return groups


def read_41(part, binary):
    """The same; an element stands once for each of the groups of its entity."""
    groups = entities_41(Words(part["Entities"], binary))
    words, nodes, elements = Words(part["Nodes"], binary), {}, []
    for _ in range(words.take("4Q")[0]):
        words.take("3i")
        tags = words.take(f"{words.take('Q')[0]}Q")
        nodes |= {tag: words.take("3d") for tag in tags}
    words = Words(part["Elements"], binary)
    for _ in range(words.take("4Q")[0]):
        d, entity, kind = words.take("3i")
        for _ in range(words.take("Q")[0]):
            row = words.take(f"{1 + NODES[kind]}Q")
            elements += [(kind, group, row[1:]) for group in groups.get((d, entity), ())]
    return nodes, elements


def rewrite(data):
    """The mesh of a file, as an undamaged one has it."""
    part = sections(data)
    version, kind, _ = part["MeshFormat"].split(b"\n")[0].split()
    nodes, elements = (read_22 if float(version) == 2.2 else read_41)(part, kind == b"1")
    names = names_of(part)
    used = [(kind, group, row) for kind, group, row in elements if (DIMENSION.get(kind, 3), group) in names]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", len(names)]
    lines += [f'{d} {tag} "{name}"' for (d, tag), name in names.items()]
    lines += ["$EndPhysicalNames", "$Nodes", len(nodes)]
    number = {tag: k for k, tag in enumerate(nodes, 1)}
    lines += [f"{number[tag]} " + " ".join(map(repr, place)) for tag, place in nodes.items()]
    lines += ["$EndNodes", "$Elements", len(used)]
    for k, (kind, group, row) in enumerate(used, 1):
        lines.append(f"{k} {kind} 2 {group} {group} " + " ".join(str(number[tag]) for tag in row))
    return "\n".join(map(str, [*lines, "$EndElements"])) + "\n"
