"""Writes meshes as Gmsh does: formats 2.2 and 4.1, text or binary, whole or partitioned (tests/mesh.py)."""

import struct

PHYSICAL = 40  # what the tag of a physical group exceeds that of its entity by
TYPES = {8: (5, 3), 4: (3, 2)}  # nodes of an element: its type in the file and its dimension


# --- Gmsh reference manual, "MSH file format"; every group is one geometric entity, with a tag, and one physical group


def words(binary, *parts):
    """Numbers of (code of struct, values) in binary, or as a line of text."""
    if binary:
        return b"".join(struct.pack(f"={len(values)}{code}", *values) for code, values in parts)
    return (" ".join(repr(value) for _, values in parts for value in values) + "\n").encode()


def section(name, *content):
    return b"".join([f"${name}\n".encode(), *content, f"$End{name}\n".encode()])


def entities_41(binary, nodes, blocks, odd=False):
    """blocks: (dimension, tag, physical groups, elements); those of a partitioned mesh are parts of 1, 2, ..."""
    yield words(binary, ("Q", [sum(block[0] == d for block in blocks) for d in range(4)]))
    for dimension in (1, 2, 3):
        for at, tag, physical, elements in blocks:
            if at == dimension:
                points = nodes[elements.ravel()]
                box = [*points.min(0).tolist(), *points.max(0).tolist()]
                part = [("i", [dimension, tag % len(blocks)]), ("Q", [1]), ("i", [1])] if odd else []
                yield words(binary, ("i", [tag]), *part, ("d", box), ("Q", [len(physical)]), ("i", physical), ("Q", [1]),
                            ("i", [-tag]))


def blocks_of(groups, odd):
    """(dimension, tag, physical groups, elements) of each entity."""
    for tag, elements in enumerate(groups.values(), 1):
        dimension = TYPES[elements.shape[1]][1]
        if not odd:
            yield dimension, tag, [tag + PHYSICAL], elements
            continue
        half = len(elements) // 3
        yield dimension, 2 * tag + len(groups), [tag + PHYSICAL], elements[:half]
        yield dimension, 2 * tag + len(groups) + 1, [3, -(tag + PHYSICAL)], elements[half:]


def nodes_41(binary, nodes, tags, blocks, odd):
    volume = next(tag for dimension, tag, _, _ in blocks if dimension == 3)
    yield words(binary, ("Q", [1, len(nodes), min(tags), max(tags)]))
    yield words(binary, ("i", [3, volume, int(odd)]), ("Q", [len(nodes)]))
    yield from (words(binary, ("Q", [tag])) for tag in tags)
    yield from (words(binary, ("d", [*point, *([0.1, 0.2, 0.3] if odd else [])])) for point in nodes.tolist())


def elements_41(binary, tags, blocks, numbers):
    yield words(binary, ("Q", [len(blocks), len(numbers), min(numbers), max(numbers)]))
    number = iter(numbers)
    for dimension, tag, _, elements in blocks:
        yield words(binary, ("i", [dimension, tag, TYPES[elements.shape[1]][0]]), ("Q", [len(elements)]))
        yield from (words(binary, ("Q", [next(number), *(tags[n] for n in element)])) for element in elements.tolist())


def nodes_22(binary, nodes, tags):
    yield f"{len(nodes)}\n".encode()
    yield from (words(binary, ("i", [tag]), ("d", point)) for tag, point in zip(tags, nodes.tolist()))


def elements_22(binary, tags, blocks, numbers, odd):
    yield f"{len(numbers)}\n".encode()
    number = iter(numbers)
    for _, tag, physical, elements in blocks:
        kind = TYPES[elements.shape[1]][0]
        tagged = [physical[-1], tag] + ([2, 1, -2] if odd else [])
        if binary:
            yield words(binary, ("i", [kind, len(elements), len(tagged)]))
        for element in elements.tolist():
            head = [next(number), *tagged] if binary else [next(number), kind, len(tagged), *tagged]
            yield words(binary, ("i", [*head, *(tags[n] for n in element)]))


def partitioned_41(binary, nodes, groups, blocks):
    """The entities before the partition, which have no element any more, and the parts; a ghost entity."""
    whole = [(dimension, tag, [9], elements) for dimension, tag, _, elements in blocks_of(groups, False)]
    ghosts = [("Q", [2]), ("Q", [1]), ("i", [len(blocks) + 90, 2])]
    return (section("Entities", *entities_41(binary, nodes, whole)) +
            section("PartitionedEntities", words(binary, *ghosts), *entities_41(binary, nodes, blocks, odd=True)))


def write(path, version, binary, nodes, groups, node_tags, numbers, odd=False):
    names = [f'{TYPES[elements.shape[1]][1]} {tag} "{name}"\n'
             for tag, (name, elements) in enumerate(groups.items(), 1 + PHYSICAL)]
    order, blocks = struct.pack("=i", 1) if binary else b"", list(blocks_of(groups, odd))
    content = section("MeshFormat", f"{version} {int(binary)} 8\n".encode(), order, b"\n" if binary else b"")
    content += section("Comments", b"$ nothing\n") if odd else b""
    content += section("PhysicalNames", f"{len(names)}\n".encode(), "".join(names).encode())
    end = b"\n" if binary else b""
    if version == "4.1":
        content += (partitioned_41(binary, nodes, groups, blocks) if odd
                    else section("Entities", *entities_41(binary, nodes, blocks), end))
        content += section("Nodes", *nodes_41(binary, nodes, node_tags, blocks, odd), end)
        content += section("Periodic", words(binary, ("Q", [0])), end) if odd else b""
        content += section("Elements", *elements_41(binary, node_tags, blocks, numbers), end)
        content += section("GhostElements", words(binary, ("Q", [1]), ("Q", [1]), ("i", [1]), ("Q", [1]), ("i", [2])),
                           end) if odd else b""
    else:
        content += section("Nodes", *nodes_22(binary, nodes, node_tags), end)
        content += section("Elements", *elements_22(binary, node_tags, blocks, numbers, odd), end)
    path.write_bytes(content)
