"""Nastran: properties, materials, supports, modes."""

import numpy

from .deck import Axes, Material, Section, Support
from .elastic import engineering
from .nastran_mesh import check_rows, named

KNOWN = {"PSOLID", "MAT1", "MAT9", "MAT11", "SPC", "SPC1", "EIGRL", "PARAM"}


def read_model(deck, tables, mesh):
    read_materials(deck, tables)
    read_properties(deck, tables, mesh)
    read_supports(deck, tables, mesh)
    for table in named(tables, "EIGRL"):
        for row in range(len(table)):
            low, high = table.real(1, 3)[row]
            deck.modes = int(table.whole(3, 4)[row, 0]), low, high, table.place(row)
    for table in named(tables, "PARAM"):
        for row in range(len(table)):
            name, value = (table.words(row) + ["", ""])[:2]
            scale = name == "WTMASS" and value not in ("1.", "1.0", "1")
            if scale:
                raise table.place(row).wrong(f"PARAM WTMASS {value}: write densities in units of mass")
            deck.note(table.place(row), f"PARAM {name}: not understood")


def new_material(deck, table, row):
    number = str(int(table.whole(0, 1)[row, 0]))
    if number in deck.materials:
        raise table.place(row).wrong(f"material {number} stands twice")
    place = table.place(row)
    material = deck.materials[number] = Material(number, place)
    return material


def density_of(material, table, row, value):
    if value < 0:
        raise table.place(row).wrong(f"{table.name}: density {value:g} must not be negative")
    material.density = value or None


def read_materials(deck, tables):
    for table in named(tables, "MAT1"):
        check_rows(table, 2, 16)
        values = table.real(1, 5)
        for row, (young, shear, poisson, density) in enumerate(values.tolist()):
            material = new_material(deck, table, row)
            words = table.words(row)
            if not words[3]:
                if not shear > 0:
                    raise table.place(row).wrong("MAT1 needs nu or G")
                poisson = young / (2 * shear) - 1
            elif words[2] and abs(young / (2 * (1 + poisson)) - shear) > 0.01 * abs(shear):
                deck.note(table.place(row), "MAT1: G is not E / (2 (1 + nu)); E and nu are taken")
            if not young > 0:
                raise table.place(row).wrong(f"MAT1: Young's modulus {young:g} must be positive")
            material.young, material.poisson = (young,), (poisson,)
            density_of(material, table, row, density)
            if len(words) > 7 and words[7]:
                deck.note(table.place(row), f"MAT1: GE {words[7]} is a loss factor, `loss_factor` with `loss_frequency` of the part")
    for table in named(tables, "MAT11"):
        check_rows(table, 10, 16)
        for row, values in enumerate(table.real(1, 11).tolist()):
            material = new_material(deck, table, row)
            material.young, material.poisson, material.shear = tuple(values[:3]), tuple(values[3:6]), tuple(values[6:9])
            if min(values[:3] + values[6:9]) <= 0:
                raise table.place(row).wrong("MAT11: moduli must be positive")
            density_of(material, table, row, values[9])
    for table in named(tables, "MAT9"):
        for row, values in enumerate(table.real(1, 23).tolist()):
            stiffness_of(deck, table, row, values)


def stiffness_of(deck, table, row, values):
    """MAT9: the upper triangle of the stiffness, rows xx yy zz xy yz zx, then the density."""
    material, full, at = new_material(deck, table, row), numpy.zeros((6, 6)), 0
    for i in range(6):
        full[i, i:] = values[at:at + 6 - i]
        at += 6 - i
    outside = full.copy()
    outside[:3, :3] = 0
    if (outside != numpy.diag(numpy.diag(outside))).any():
        raise table.place(row).wrong("MAT9: shear is coupled; squeal has orthotropic materials")
    normal = full[:3, :3] + full[:3, :3].T - numpy.diag(numpy.diag(full[:3, :3]))
    engineering(material, normal, (full[3, 3], full[5, 5], full[4, 4]), table.place(row))  # 12, 13, 23
    density_of(material, table, row, values[21])


def read_properties(deck, tables, mesh):
    """PSOLID: number, material, system of the material: parts."""
    properties = {}
    for table in named(tables, "PSOLID"):
        check_rows(table, 2, 8)
        for row, (number, material, system) in enumerate(table.whole(0, 3).tolist()):
            if number in properties:
                raise table.place(row).wrong(f"property {number} stands twice")
            if str(material) not in deck.materials:
                raise table.place(row).wrong(f"PSOLID {number}: there is no material {material}")
            if system not in mesh.systems:
                raise table.place(row).wrong(f"PSOLID {number}: there is no coordinate system {system}")
            if any(table.words(row)[3:]):
                deck.note(table.place(row),
                          f"PSOLID {number}: integration and output ({', '.join(filter(None, table.words(row)[3:]))}) are not read")
            properties[number] = str(material), axes_of(mesh.systems[system], table.place(row)), table.place(row)
    if not properties:
        bare_parts(deck, mesh)
        return
    groups = {}
    for cells, numbers in mesh.blocks:
        for number in numpy.unique(numbers).tolist():
            chosen = cells[numbers == number]
            if number not in properties:
                raise mesh.cells.line_of(int(chosen[0])).wrong(f"there is no PSOLID {number}")
            groups.setdefault(number, []).append(chosen)
    for number, parts in sorted(groups.items()):
        material, axes, place = properties.pop(number)
        deck.sections.append(Section(f"part_{number}", numpy.concatenate(parts), material, axes, place))
    for number, (*_, place) in properties.items():
        deck.note(place, f"PSOLID {number}: no element has it")


def bare_parts(deck, mesh):
    """A mesh without properties: sets of elements by their numbers."""
    groups = {}
    for cells, numbers in mesh.blocks:
        for number in numpy.unique(numbers).tolist():
            groups.setdefault(number, []).append(cells[numbers == number])
    for number, parts in groups.items():
        deck.cell_sets[f"part_{number}"] = numpy.concatenate(parts), mesh.cells.line_of(int(parts[0][0]))


def axes_of(system, place):
    if system.cylinder:
        return Axes(True, system.axes[2], system.origin, place)
    return Axes(False, system.axes[0], system.axes[1], place)


def directions(word, place, what):
    """Directions 0, 1, 2 of digits 1 to 6."""
    if not word or not set(word) <= set("0123456"):
        raise place.wrong(f"{what}: '{word}' should be digits of 1 to 6")
    return [int(digit) - 1 for digit in word if digit in "123"]


def straight(deck, mesh, nodes, place, what):
    """Whether displacements of nodes are in the axes of space; else the card is listed."""
    systems = {mesh.turned.get(int(node), 0) for node in nodes}
    if all(numpy.allclose(mesh.systems[number].axes, numpy.eye(3)) and not mesh.systems[number].cylinder
           for number in systems if number in mesh.systems) and systems <= set(mesh.systems):
        return True
    deck.note(place, f"{what}: in the axes of a coordinate system (CD of GRID), not taken")
    return False


def read_supports(deck, tables, mesh):
    for node, word, place in mesh.held:
        hold(deck, mesh, [node], (word, 0.0), place, "GRID")
    for table in named(tables, "SPC"):
        for row in range(len(table)):
            words, place = table.words(row) + [""] * 7, table.place(row)
            for at in (1, 4):
                if words[at]:
                    nodes = mesh.nodes.need(table.whole(at, at + 1)[row], "grid point", place)
                    value = table.one_real(row, at + 2, words[at + 2]) if words[at + 2] else 0.0
                    hold(deck, mesh, nodes, (words[at + 1], value), place, "SPC")
    for table in named(tables, "SPC1"):
        for row in range(len(table)):
            words, place = table.words(row), table.place(row)
            numbers = listed_numbers(table, row, 2, mesh.nodes, "grid point")
            hold(deck, mesh, mesh.nodes.need(numbers, "grid point", place), (words[1], 0.0), place, "SPC1")


def hold(deck, mesh, nodes, what, place, name):
    held = directions(what[0], place, name)
    if held and straight(deck, mesh, nodes, place, name):
        deck.supports.append(Support(numpy.array(nodes), {d: what[1] for d in held}, "", place))


def listed_numbers(table, row, first, known, what):
    """Numbers from field `first` on, or first THRU last, of which only those that are there."""
    words = [word for word in table.words(row)[first:] if word]
    if not words:
        raise table.place(row).wrong(f"{table.name} names no {what}")
    if len(words) == 3 and words[1].upper() == "THRU":
        low, high = (table_whole(table, row, word) for word in (words[0], words[2]))
        if high < low or high - low > 10**7:
            raise table.place(row).wrong(f"{table.name}: {low} THRU {high} is no range")
        numbers = numpy.arange(low, high + 1)
        numbers = numbers[~known.find(numbers, what)[1]]
        if not len(numbers):
            raise table.place(row).wrong(f"{table.name}: there is no {what} from {low} to {high}")
        return numbers
    return numpy.array([table_whole(table, row, word) for word in words])


def table_whole(table, row, word):
    if not word.isdigit() or len(word) > 12:
        raise table.place(row).wrong(f"{table.name}: '{word}' should be a whole number")
    return int(word)
