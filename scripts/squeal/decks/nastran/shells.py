"""Nastran: shells and their properties; they become solids of their thickness."""

from dataclasses import replace

import numpy

from .cards import named
from ..mesh.shells import add_shells, set_thickness

# Name -> corners, nodes; fields of the offset and of the thicknesses at corners
SHELLS = {"CQUAD4": (4, 4, 7, range(10, 14)), "CQUADR": (4, 4, 7, range(10, 14)), "CTRIA3": (3, 3, 6, range(10, 13)),
          "CTRIAR": (3, 3, 6, range(10, 13)), "CQUAD8": (4, 8, 15, range(10, 14)), "CTRIA6": (3, 6, 9, range(10, 13))}
KNOWN = set(SHELLS) | {"PSHELL"}


def read_shells(deck, mesh, tables):
    """Cells of all shells that have a PSHELL; others are listed."""
    known = {int(number) for table in named(tables, "PSHELL") for number in table.whole(0, 1)[:, 0]}
    for table in named(tables, *SHELLS):
        corners, n, _, _ = SHELLS[table.name]
        head, nodes = table.whole(0, 2), table.whole(2, 2 + n)
        head[head[:, 1] == 0, 1] = head[head[:, 1] == 0, 0]
        found = numpy.isin(head[:, 1], list(known))
        if not found.all():
            place = table.place(int((~found).argmax()))
            ids = head[~found, 0]
            deck.note(place, f"{len(ids)} {table.name} without a PSHELL (of layers?): not in the scene; let their program write a "
                             f"superelement of elements {min(ids)} to {max(ids)} with the nodes that they share with the rest, for "
                             "-superelements")
        second = (nodes[:, corners:] > 0).all(axis=1) if n > corners else numpy.zeros(len(nodes), bool)
        part = found & ~second & (nodes[:, corners:] > 0).any(axis=1)
        if part.any():
            deck.note(table.place(int(part.argmax())), f"{part.sum()} {table.name} without some of their middles: none is taken")
        for chosen, count in ((found & second, n), (found & ~second, corners)):
            rows = numpy.flatnonzero(chosen)
            if len(rows):
                at = mesh.nodes.need(nodes[rows][:, :count], "grid point", lambda row, rows=rows, table=table: table.place(int(rows[row])))
                cells = add_shells(deck, table.name, head[rows, 0], at, table.place(int(rows[0])))
                mesh.cells.add(head[rows, 0], cells, table.lines[rows], table.file)
                mesh.blocks.append((cells, head[rows, 1]))
                mesh.shells.append((cells, head[rows, 1], table, rows))


def read_properties(deck, tables, mesh, properties, known_material):
    """PSHELL: number, material, thickness, of which parts are; material of bending, mass per area beside that of the material."""
    for table in named(tables, "PSHELL"):
        for row, number in enumerate(table.whole(0, 1)[:, 0].tolist()):
            place, words = table.place(row), table.words(row, 9)
            if number in properties:
                deck.note(place, f"PSHELL {number}: another property has this number: not taken")
                continue
            material = known_material(deck, int(words[1]) if words[1].isdigit() else 0, number, place)
            thickness = table.one_real(row, 2, words[2]) if words[2] else 0.0
            if words[3] not in ("", words[1]) or any(words[k] not in ("", "1.", "1.0") for k in (4,)) or words[6] not in ("", words[1]):
                deck.note(place, f"PSHELL {number}: materials of bending and shear, or a ratio of inertia, are those of the solid")
            extra = table.one_real(row, 7, words[7]) if words[7] else 0.0
            if extra and material and thickness > 0:
                before = deck.materials[material]
                name = f"{material}_{number}"
                deck.materials[name] = replace(before, name=name, density=(before.density or 0.0) + extra / thickness)
                material = name
            properties[number] = material, None, place
            give_thickness(deck, mesh, number, thickness)


def give_thickness(deck, mesh, number, thickness):
    """Thickness of the property, or the mean of those at the corners; offset of the middle surface."""
    for cells, numbers, table, rows in mesh.shells:
        _, _, at, corners = SHELLS[table.name]
        for cell, row in zip(cells[numbers == number].tolist(), rows[numbers == number].tolist()):
            words = table.words(row, 16)
            given = [table.one_real(row, k, words[k]) for k in corners if words[k]]
            if given and len(set(given)) > 1:
                deck.note(table.place(row), f"{table.name}: a thickness that varies; the mean is taken")
            offset = table.one_real(row, at, words[at]) if words[at] else 0.0
            set_thickness(deck, numpy.array([cell]), sum(given) / len(given) if given else thickness, offset)
