"""Nastran: properties, materials, supports, modes."""

import numpy

from ..axes import aligned
from ..deck import Axes, Equation, Material, Section, Support, give_loss
from ..elastic import engineering
from .cards import named
from .damping import read_damping
from .mesh import check_rows
from .shells import read_properties as read_shell_properties

KNOWN = {"PSOLID", "MAT1", "MAT9", "MAT10", "MAT11", "SPC", "SPC1", "EIGRL", "EIGR", "PARAM"}


def read_model(deck, tables, mesh, chosen):
    read_materials(deck, tables)
    read_parameters(deck, tables, mesh)
    read_damping(deck, tables, chosen)
    read_properties(deck, tables, mesh)
    read_supports(deck, tables, mesh, chosen)
    read_method(deck, tables, chosen)


def read_method(deck, tables, chosen):
    """EIGRL: number, lowest, highest (Hz), count; EIGR: number, method, lowest, highest, estimate, count."""
    for table in named(tables, "EIGRL", "EIGR"):
        at = 1 if table.name == "EIGRL" else 2
        for row, number in enumerate(table.whole(0, 1)[:, 0].tolist()):
            if chosen.method not in (None, number):
                deck.note(table.place(row), f"{table.name} {number}: case control does not choose it: not taken")
            elif deck.modes is not None:
                deck.note(table.place(row), f"{table.name} {number}: a second one: not taken")
            else:
                low, high = table.real(at, at + 2)[row]
                deck.modes = int(table.whole(at + 2 + (at > 1), at + 3 + (at > 1))[row, 0]), low, high, table.place(row)


def read_parameters(deck, tables, mesh):
    """PARAM WTMASS is the factor from densities to those of mass, G a loss factor of all parts."""
    every = 0.0, None  # the last G
    for table in named(tables, "PARAM"):
        for row in range(len(table)):
            name, value = table.words(row, 2)[:2]
            if name.upper() == "WTMASS":
                factor = table.one_real(row, 1, value)
                if not factor > 0:
                    raise table.place(row).wrong(f"PARAM WTMASS {value} must be positive")
                for material in deck.materials.values():
                    material.density = material.density and material.density * factor
                mesh.mass_factor = factor
                if factor != 1:
                    deck.differ(table.place(row), f"PARAM WTMASS {value}: densities are those of the materials times this")
            elif name.upper() == "G":
                every = table.one_real(row, 1, value), table.place(row)
            else:
                deck.note(table.place(row), f"PARAM {name}: not understood")
    for material in deck.materials.values() if every[0] else ():
        give_loss(material, *every)
    if every[0]:
        deck.differ(every[1], f"PARAM G {every[0]:g}: a loss factor of all parts; springs and contacts have none")


def loss_of(material, table, row, at):
    """GE, in field `at` of a material."""
    word = table.words(row, at + 1)[at]
    if word:
        give_loss(material, table.one_real(row, at, word), table.place(row))


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


def isotropic(deck, table, row, values):
    """E and nu of MAT1 by two of E, G, nu; E = 2 (1 + nu) G. Without nu and G both are 0."""
    (young, shear, poisson), given, place = values, [bool(word) for word in table.words(row, 4)[1:4]], table.place(row)
    if given[0] and not given[2]:
        if not given[1]:
            deck.note(place, "MAT1: neither nu nor G: nu is 0, as Nastran has it")
        elif not shear > 0:
            raise place.wrong(f"MAT1: G {shear:g} must be positive")
        poisson = young / (2 * shear) - 1 if given[1] else 0.0
    elif not given[0] and given[1] and given[2]:
        young = 2 * (1 + poisson) * shear
    elif all(given) and abs(young / (2 * (1 + poisson)) - shear) > 0.01 * abs(shear):
        deck.note(place, "MAT1: G is not E / (2 (1 + nu)); E and nu are taken")
    if not any(given[:2]) or not young > 0:
        raise place.wrong(f"MAT1 needs two of E, G and nu, and Young's modulus {young:g} must be positive")
    return (young,), (poisson,)


def read_materials(deck, tables):
    for table in named(tables, "MAT1"):
        check_rows(table, 1, 16)
        values = table.real(1, 5)
        for row, (*constants, density) in enumerate(values.tolist()):
            material = new_material(deck, table, row)
            material.young, material.poisson = isotropic(deck, table, row, constants)
            density_of(material, table, row, density)
            loss_of(material, table, row, 7)
    for table in named(tables, "MAT11"):
        check_rows(table, 10, 16)
        for row, values in enumerate(table.real(1, 11).tolist()):
            material = new_material(deck, table, row)
            material.young, material.poisson, material.shear = tuple(values[:3]), tuple(values[3:6]), tuple(values[6:9])
            if min(values[:3] + values[6:9]) <= 0:
                raise table.place(row).wrong("MAT11: moduli must be positive")
            density_of(material, table, row, values[9])
            loss_of(material, table, row, 15)
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
    density_of(material, table, row, values[21])
    loss_of(material, table, row, 30)
    if (outside != numpy.diag(numpy.diag(outside))).any():
        deck.note(table.place(row), "MAT9: shear is coupled; squeal has orthotropic materials, give one")
        return
    normal = full[:3, :3] + full[:3, :3].T - numpy.diag(numpy.diag(full[:3, :3]))
    engineering(material, normal, (full[3, 3], full[5, 5], full[4, 4]), table.place(row))  # 12, 13, 23


def read_properties(deck, tables, mesh):
    """PSOLID: number, material, system of the material: parts. Without one, or without its material, a part has none."""
    properties = {}
    for table in named(tables, "PSOLID"):
        check_rows(table, 2, 8)
        for row, (number, material, system) in enumerate(table.whole(0, 3).tolist()):
            place, words = table.place(row), table.words(row, 8)
            if number in properties:
                raise place.wrong(f"property {number} stands twice")
            if number in mesh.fluids:
                continue
            if any(words[3:]):
                deck.note(place, f"PSOLID {number}: integration and output ({', '.join(filter(None, words[3:]))}) are not read")
            properties[number] = known_material(deck, material, number, place), axes_of(deck, mesh, system, place), place
    read_shell_properties(deck, tables, mesh, properties, known_material)
    if not properties:
        bare_parts(deck, mesh)
        return
    groups = {}
    for cells, numbers in mesh.blocks:
        for number in numpy.unique(numbers).tolist():
            groups.setdefault(number, []).append(cells[numbers == number])
    for number, parts in sorted(groups.items()):
        where = mesh.cells.line_of(int(parts[0][0]))
        if number not in properties:
            deck.note(where, f"there is no PSOLID or PSHELL {number}: the part has no material, give it")
        material, axes, place = properties.pop(number, ("", None, where))
        deck.sections.append(Section(f"part_{number}", numpy.concatenate(parts), material, axes, place))
    for number, (*_, place) in properties.items():
        deck.note(place, f"property {number}: no element has it")


def known_material(deck, material, number, place):
    """The name of a material that is read."""
    if str(material) in deck.materials:
        return str(material)
    deck.note(place, f"property {number}: there is no MAT1, MAT9 or MAT11 {material}: the part has no material, give it")
    return ""


def bare_parts(deck, mesh):
    """A mesh without properties: sets of elements by their numbers."""
    groups = {}
    for cells, numbers in mesh.blocks:
        for number in numpy.unique(numbers).tolist():
            groups.setdefault(number, []).append(cells[numbers == number])
    for number, parts in groups.items():
        deck.cell_sets[f"part_{number}"] = numpy.concatenate(parts), mesh.cells.line_of(int(parts[0][0]))


def axes_of(deck, mesh, number, place):
    """Axes of a material; those of an element (-1) or of a sphere are listed."""
    system = mesh.systems.get(number)
    if system is None and number != -1:
        raise place.wrong(f"there is no coordinate system {number}")
    if system is None or system.kind == "S":
        deck.note(place, f"PSOLID: axes of the material by {'the element' if system is None else 'a sphere'}: not taken")
        return None
    if system.kind == "C":
        return Axes(True, system.axes[2], system.origin, place)
    return Axes(False, system.axes[0], system.axes[1], place)


def directions(word, place, what):
    """Motions 0 to 5 of digits 1 to 6."""
    if not word or not set(word) <= set("0123456"):
        raise place.wrong(f"{what}: '{word}' should be digits of 1 to 6")
    return [int(digit) - 1 for digit in word if digit in "123456"]


def in_space(mesh, node, x, held):
    """The same directions of a point in space, by axes.aligned()."""
    number = mesh.turned.get(int(node), 0)
    return aligned(mesh.systems[number].directions(x), held) if number in mesh.systems else None


def read_supports(deck, tables, mesh, chosen):
    for node, word, place in mesh.held:
        hold(deck, mesh, [node], (word, 0.0), place, "GRID")
    for table in chosen.supports(tables, "SPC"):
        points = table.whole(1, 2)[:, 0], table.whole(4, 5)[:, 0]
        for row in range(len(table)):
            words, place = table.words(row, 7), table.place(row)
            for at, numbers in zip((1, 4), points):
                scalar = set(words[at + 1]) <= {"0"}  # of a point with one freedom
                numbers = mesh.known([numbers[row]]) if words[at] and not scalar else ()
                if len(numbers):
                    value = table.one_real(row, at + 2, words[at + 2]) if words[at + 2] else 0.0
                    hold(deck, mesh, mesh.nodes.need(numbers, "grid point", place), (words[at + 1], value), place, "SPC")
    for table in chosen.supports(tables, "SPC1"):
        for row in range(len(table)):
            place, numbers = table.place(row), mesh.known(listed_numbers(table, row, 2, mesh.nodes, "grid point"))
            if len(numbers):
                hold(deck, mesh, mesh.nodes.need(numbers, "grid point", place), (table.words(row)[1], 0.0), place, "SPC1")


def hold(deck, mesh, nodes, what, place, name):
    """Adds supports: of all nodes in the axes of space, and of each that has its own axes."""
    (word, value), held = what, directions(what[0], place, name)
    if not held:
        return
    own = [int(node) for node in nodes if mesh.turned.get(int(node), 0)]
    plain = numpy.array([node for node in nodes if not mesh.turned.get(int(node), 0)], int)
    if len(plain):
        deck.supports.append(Support(plain, {d: value for d in held}, "", place))
    for node in own:
        for first in (0, 3):
            part = [d - first for d in held if first <= d < first + 3]
            if part:
                hold_own(deck, mesh, node, (part, first, value), place, name)


def hold_own(deck, mesh, node, what, place, name):
    """Holds a point in its own axes: along those of space, or by equations."""
    held, first, value = what
    found = in_space(mesh, node, deck.x[node], held)
    if found is not None and not (value and any(sign == 0 for _, sign in found.values())):
        deck.supports.append(Support(numpy.array([node]), {first + d: sign * value + 0.0 for d, (_, sign) in found.items()}, "", place))
    elif value or mesh.turned.get(int(node), 0) not in mesh.systems:
        deck.note(place, f"{name}: in the axes of a coordinate system (CD of GRID), not taken")
    else:
        axes = mesh.systems[mesh.turned[int(node)]].directions(deck.x[node])
        deck.equations += [Equation([(node, first + e, float(axes[d, e])) for e in range(3) if abs(axes[d, e]) > 1e-12], place, name)
                           for d in held]


def listed_numbers(table, row, first, known, what):
    """Numbers from field `first` on, or first THRU last, of which only those that are there."""
    words = [word for word in table.words(row)[first:] if word]
    if not words:
        raise table.place(row).wrong(f"{table.name} names no {what}")
    parts, at = [], 0
    while at < len(words):
        if at + 2 < len(words) and words[at + 1].upper() == "THRU":
            low, high = (table_whole(table, row, word) for word in (words[at], words[at + 2]))
            if high < low or high - low > 10**7:
                raise table.place(row).wrong(f"{table.name}: {low} THRU {high} is no range")
            numbers = numpy.arange(low, high + 1)
            parts.append(numbers[~known.find(numbers, what)[1]])
            if not len(parts[-1]):
                raise table.place(row).wrong(f"{table.name}: there is no {what} from {low} to {high}")
            at += 3
        else:
            parts.append(numpy.array([table_whole(table, row, words[at])]))
            at += 1
    return numpy.concatenate(parts)


def table_whole(table, row, word):
    if not word.isdigit() or len(word) > 12:
        raise table.place(row).wrong(f"{table.name}: '{word}' should be a whole number")
    return int(word)
