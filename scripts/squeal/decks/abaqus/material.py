"""Abaqus: materials, their axes, and sections."""

import numpy

from ...tables import BadInput
from .sets import reader_cells
from .words import choice, label
from ..deck import Axes, Material, Section, give_loss
from ..elastic import engineering
from ..mesh.shells import set_thickness
from ..text import REAL, real

END_MATERIAL = {"SURFACE INTERACTION", "CONNECTOR BEHAVIOR", "GASKET BEHAVIOR", "FLUID BEHAVIOR", "STEP"}  # have cards of their own

SIDES = {"SPOS": 0.5, "SNEG": -0.5, "MIDDLE SURFACE": 0.0}  # of the shell that its nodes are on
STIFFNESSES = ("ISOTROPIC", "ORTHOTROPIC", "ENGINEERING CONSTANTS", "LAMINA", "ANISOTROPIC", "TRACTION", "COUPLED TRACTION",
               "SHEAR", "SHORT FIBER", "BILAMINA")


def numbers(card):
    """Place and numbers of each line; what is blank is 0."""
    return [(place, [real(word or "0", place) for word in fields]) for place, fields in card.rows()]


def first_row(card, least):
    """Numbers of the first line; more lines (other temperatures) are listed."""
    rows = numbers(card)
    if not rows or len(rows[0][1]) < least:
        raise (rows[0][0] if rows else card.place).wrong(f"*{card.keyword} needs {least} number{'s' * (least > 1)} at least")
    return rows[0][1], rows[1:]


def at_temperature(reader, card, n):
    """The n numbers of a table at the temperature of the deck, straight between its lines and constant beyond them; (row, other lines):
    the first line where no temperature is told, or where the lines differ by more than it."""
    rows = numbers(card)
    first, rest = first_row(card, n)
    own = [row for _, row in rows]
    if not rest or reader.temperature is None or any(len(row) != n + 1 for row in own) or (numpy.diff([row[n] for row in own]) <= 0).any():
        return first, rest
    value, place = reader.temperature
    table = numpy.array(own)
    reader.deck.differ(card.place, f"*{card.keyword}: at the temperature {value:g} of {place}")
    return [float(numpy.interp(value, table[:, n], table[:, k])) for k in range(n)], []


def do_temperature(reader, scope, card):
    """*INITIAL CONDITIONS, TYPE=TEMPERATURE, and *TEMPERATURE in steps: the last one, where it is the same for all nodes."""
    if card.keyword == "INITIAL CONDITIONS" and choice(card.options.pop("TYPE", ""), "TEMPERATURE") != "TEMPERATURE":
        reader.deck.note(card.place, "*INITIAL CONDITIONS: only temperatures are read")
        return
    values = {}
    for place, fields in card.rows():
        if len(fields) > 1 and REAL.match(fields[1] or "0"):
            values[real(fields[1] or "0", place)] = place
    if len(values) == 1 and not card.options.get("FILE"):
        reader.temperature = next(iter(values.items()))
        reader.deck.note(card.place, f"*{card.keyword}: {next(iter(values)):g} chooses values of materials, and strains nothing")
    else:
        reader.deck.note(card.place, f"*{card.keyword}: temperatures that differ or come from a file: not taken")


def other_rows(reader, card, rows):
    for place, _ in rows:
        reader.deck.note(place, f"*{card.keyword}: only the first line is taken")


def do_material(reader, scope, card):
    name = card.need("NAME")
    if name in reader.deck.materials and not scope.prefix:
        raise card.place.wrong(f"material {name} stands twice")
    reader.material = reader.deck.materials[name] = Material(name, card.place)


def material_of(reader, card):
    if reader.material is None:
        raise card.place.wrong(f"*{card.keyword} outside of a *MATERIAL")
    reader.material.places[card.keyword] = card.place
    return reader.material


def do_density(reader, _, card):
    row, rest = at_temperature(reader, card, 1)
    material_of(reader, card).density = row[0]
    if not row[0] > 0:
        raise card.place.wrong(f"density {row[0]:g} must be positive")
    other_rows(reader, card, rest)


def do_elastic(reader, _, card):
    material, kind = material_of(reader, card), choice(card.options.get("TYPE", "ISOTROPIC"), *STIFFNESSES)
    rows = numbers(card)
    if kind == "ISOTROPIC":
        row, rest = at_temperature(reader, card, 2)
        material.young, material.poisson = (row[0],), (row[1],)
    elif kind in ("ENGINEERING CONSTANTS", "ORTHOTROPIC"):
        values, used = [], 0
        while used < len(rows) and len(values) < 9:
            values += rows[used][1]
            used += 1
        if len(values) < 9:
            raise card.place.wrong(f"*ELASTIC, TYPE={kind} has {len(values)} numbers, expected 9")
        if kind == "ENGINEERING CONSTANTS":
            material.young, material.poisson, material.shear = tuple(values[:3]), tuple(values[3:6]), tuple(values[6:9])
        else:
            c11, c12, c22, c13, c23, c33 = values[:6]
            engineering(material, [[c11, c12, c13], [c12, c22, c23], [c13, c23, c33]], values[6:9], card.place)
        rest = rows[used:]
    else:
        why = "is for plane stress, not for solids" if kind == "LAMINA" else "is not understood"
        reader.deck.note(card.place, f"*ELASTIC, TYPE={kind}: {why}; give young, poisson, shear of material {material.name}")
        return
    if choice(card.options.pop("MODULI", "LONG TERM"), "LONG TERM", "INSTANTANEOUS") == "INSTANTANEOUS":
        reader.instant.add(material.name)
    if min(material.young) <= 0:
        raise rows[0][0].wrong(f"Young's modulus {min(material.young):g} must be positive")
    other_rows(reader, card, rest)


def do_damping(reader, _, card):
    if reader.material is None:
        reader.deck.note(card.place, "*DAMPING: not understood outside of a *MATERIAL")
        return
    material = material_of(reader, card)
    material.alpha = real(card.options.get("ALPHA") or "0", card.place)
    material.beta = real(card.options.get("BETA") or "0", card.place)
    if "STRUCTURAL" in card.options:
        material.loss = 0.0
        give_loss(material, real(card.options.pop("STRUCTURAL") or "0", card.place), card.place)


def do_global_damping(reader, _, card):
    """Kept with the step that it stands in."""
    if choice(card.options.get("FIELD", "ALL"), "ALL", "MECHANICAL", "ACOUSTIC") != "ACOUSTIC":
        values = [real(card.options.get(word) or "0", card.place) for word in ("ALPHA", "BETA", "STRUCTURAL")]
        reader.global_damping.append((reader.steps, values, card.place))


def add_global_damping(reader):
    """What *GLOBAL DAMPING says in the step of the modes, as damping of all parts; what other steps say is listed."""
    of_modes = [row for row in reader.global_damping if row[0] == reader.modes_step][-1:]
    for row in reader.global_damping:
        if row not in of_modes:
            reader.deck.note(row[2], "*GLOBAL DAMPING: of a step without modes, or replaced in its step: not taken")
    for _, (alpha, beta, loss), place in of_modes:
        for material in reader.deck.materials.values():
            material.alpha, material.beta = material.alpha + alpha, material.beta + beta
            material.places.setdefault("DAMPING", place)
            give_loss(material, loss, place)
        reader.deck.differ(place, "*GLOBAL DAMPING: of all parts; springs, points and contacts have none")


def read_axes(_, scope, card):
    """Axes of a material: points a and b, rectangular also c, and a turn about one of the axes."""
    rows = numbers(card)
    if not rows or len(rows[0][1]) not in (6, 9):
        raise card.place.wrong("*ORIENTATION needs two points, six numbers")
    if choice(card.options.get("DEFINITION", "COORDINATES"), "COORDINATES", "NODES", "OFFSET TO NODES") != "COORDINATES":
        raise card.place.wrong("*ORIENTATION: only DEFINITION=COORDINATES is read")
    points = numpy.array(rows[0][1]).reshape(-1, 3)
    system = choice(card.options.get("SYSTEM", "RECTANGULAR"), "RECTANGULAR", "CYLINDRICAL", "SPHERICAL", "Z RECTANGULAR", "USER")
    about, angle = (rows[1][1] + [0, 0])[:2] if len(rows) > 1 else (0, 0)
    if system == "CYLINDRICAL":
        if angle:
            raise rows[1][0].wrong("*ORIENTATION: a cylinder's axes that are turned about one of them are not read")
        place = scope.turn @ points[0] + scope.shift
        return Axes(True, axis_of(scope.turn @ (points[1] - points[0]), card), place, card.place)
    if system != "RECTANGULAR":
        raise card.place.wrong(f"*ORIENTATION, SYSTEM={system}: only RECTANGULAR and CYLINDRICAL are read")
    origin = points[2] if len(points) > 2 else numpy.zeros(3)
    first = axis_of(points[0] - origin, card)
    second = points[1] - origin
    third = axis_of(numpy.cross(first, second), card)
    axes = numpy.array([first, numpy.cross(third, first), third])
    if angle:
        if about not in (1, 2, 3):
            raise rows[1][0].wrong(f"*ORIENTATION: a turn is about axis 1, 2 or 3, not {about:g}")
        from_abaqus = rotation_about(axes[int(about) - 1], numpy.radians(angle))
        axes = axes @ from_abaqus.T
    return Axes(False, scope.turn @ axes[0], scope.turn @ axes[1], card.place)


def rotation_about(axis, angle):
    """Matrix of a rotation about a unit vector."""
    cross = numpy.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return numpy.eye(3) + numpy.sin(angle) * cross + (1 - numpy.cos(angle)) * cross @ cross


def axis_of(vector, card):
    """A unit vector."""
    length = numpy.linalg.norm(vector)
    if not length > 0:
        raise card.place.wrong(f"*{card.keyword}: the points do not tell the axes")
    return vector / length


def axes_or_error(reader, scope, card):
    """Axes, or the error that they are, which counts only where a material needs them."""
    try:
        return read_axes(reader, scope, card)
    except BadInput as error:
        return error


def do_distribution(reader, scope, card):
    """Rows of elements, none for all others, and six numbers of their axes; what else it may distribute is not taken."""
    rows = [(place, fields) for place, fields in card.rows() if len(fields) == 7]
    if len(rows) != len(list(card.rows())):
        reader.deck.note(card.place, "*DISTRIBUTION: only that of axes, by six numbers, is read")
        return
    scope.distributions[card.need("NAME")] = [
        (place, reader_cells(reader, scope, fields[0], place) if fields[0] else None, ",".join(fields[1:])) for place, fields in rows]


def do_orientation(reader, scope, card):
    """Axes, or a list of (cells, axes) where a distribution gives them."""
    name, rows = card.need("NAME"), list(card.rows())
    given = scope.distributions.get(label(rows[0][1][0])) if rows else None
    if given is None:
        scope.axes[name] = axes_or_error(reader, scope, card)
        return
    more = "".join("\n" + ",".join(fields) for _, fields in rows[1:])
    scope.axes[name] = [(cells, axes_or_error(reader, scope, type(card)(card.keyword, card.options, place, [
        ((text + more).encode(), place.line)]))) for place, cells, text in given]


def do_section(reader, scope, card):
    name = card.need("ELSET")
    if name in scope.other_sets and name not in scope.cell_sets:
        reader.deck.note(card.place, f"*SOLID SECTION: the elements of {name} are none of squeal's")
        return
    add_section(reader, scope, card)


def add_section(reader, scope, card):
    """A part of the cells of a set."""
    name, material = card.need("ELSET"), card.need("MATERIAL")
    axes = label(card.options.get("ORIENTATION", ""))
    inner, local = reader.split(axes, scope)
    if axes and local not in inner.axes:
        raise card.place.wrong(f"there is no *ORIENTATION {axes}")
    cells = reader_cells(reader, scope, name, card.place)
    name = scope.prefix if scope.prefix and len(cells) == scope.cells.n else scope.full(name)
    reader.deck.sections.append(Section(name, cells, material, inner.axes[local] if axes else None, card.place))


def do_shell_section(reader, scope, card):
    """A shell of one material and one thickness; OFFSET is SPOS, SNEG or a part of the thickness."""
    name = card.need("ELSET")
    if "COMPOSITE" in card.options or not card.options.get("MATERIAL"):
        card.options.pop("COMPOSITE", None)
        reader.deck.note(card.place, f"*{card.keyword} {name}: layers, or a stiffness without a material: not taken")
        return
    if name in scope.other_sets and name not in scope.cell_sets:
        reader.deck.note(card.place, f"*{card.keyword}: the elements of {name} are none of squeal's")
        return
    row, _ = first_row(card, 1)
    if not row[0] > 0:
        raise card.place.wrong(f"*{card.keyword}: the thickness {row[0]:g} must be positive")
    word = card.options.get("OFFSET", "0").strip().upper()
    if word not in SIDES and not REAL.match(word):
        reader.deck.note(card.place, f"*{card.keyword}, OFFSET={word[:30]}: not understood, 0 is taken")
        word = "0"
    offset = SIDES[word] if word in SIDES else real(word, card.place)
    set_thickness(reader.deck, reader_cells(reader, scope, name, card.place), row[0], -offset * row[0])
    add_section(reader, scope, card)


def finish_sections(deck):
    """Sections have their materials, and axes where these need them; a section for each of several axes."""
    found = []
    for section in deck.sections:
        if section.material not in deck.materials:
            raise section.place.wrong(f"there is no *MATERIAL {section.material}")
        given = section.axes if isinstance(section.axes, list) else [(None, section.axes)]
        if not deck.materials[section.material].shear:
            given = [(None, None)]
        row_of = numpy.full(deck.n_cells, -1)
        for number, (cells, _) in sorted(enumerate(given), key=lambda row: row[1][0] is not None):
            row_of[slice(None) if cells is None else cells] = number
        rows = row_of[section.cells]
        if (rows < 0).any():
            raise section.place.wrong(f"{(rows < 0).sum()} elements of {section.name} have no axes in the *DISTRIBUTION")
        for number in numpy.unique(rows).tolist():
            if isinstance(given[number][1], BadInput):
                raise given[number][1]
            found.append(Section(section.name, section.cells[rows == number], section.material, given[number][1], section.place))
        if not len(rows):
            found.append(Section(section.name, section.cells, section.material, None, section.place))
    deck.sections = found


CARDS = {"GLOBAL DAMPING": do_global_damping, "INITIAL CONDITIONS": do_temperature, "TEMPERATURE": do_temperature,
         "MATERIAL": do_material, "DENSITY": do_density, "ELASTIC": do_elastic, "DAMPING": do_damping,
         "DISTRIBUTION": do_distribution, "ORIENTATION": do_orientation, "SOLID SECTION": do_section, "SHELL SECTION": do_shell_section}
