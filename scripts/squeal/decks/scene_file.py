"""The scene in YAML: what was understood, with the place that each line is from, then all that was not."""

import itertools

import numpy

from ..tables import quoted, whole

MOST_ALIKE = 3
LISTS = ("parts", "supports", "springs", "motions", "joints", "points", "superelements", "loads", "contacts", "ties", "stages")
FACTORS = {"": lambda u: 1, "length": lambda u: u.length, "stress": lambda u: u.stress, "density": lambda u: u.density,
           "force": lambda u: u.force, "stiffness": lambda u: u.stiffness, "time": lambda u: u.time,
           "mass": lambda u: u.mass, "inertia": lambda u: u.mass * u.length**2, "moment": lambda u: u.force * u.length,
           "turn_stiffness": lambda u: u.stiffness * u.length**2, "viscosity": lambda u: u.mass / u.time,
           "turn_viscosity": lambda u: u.mass / u.time * u.length**2,
           "points": lambda u: (u.length, u.stress), "rate": lambda u: 1 / u.time, "speed": lambda u: u.length / u.time,
           "exponential": lambda u: (u.length, u.stress), "stiffness_per_area": lambda u: u.stiffness_per_area}


def shown(value, units):
    """A word, or a quantity (its kind, values) in SI."""
    if isinstance(value, str):
        return f'"{value}"' if "," in value else value
    kind, values = value
    if kind == "file":
        return quoted(values)
    factors = itertools.cycle(numpy.atleast_1d(FACTORS[kind](units)))
    words = [f"{number * factor:.15g}" for number, factor in zip(values, factors)]
    return words[0] if len(words) == 1 else '"' + ",".join(words) + '"'


def entry_lines(entry, units):
    """Lines of one thing."""
    lines = [f"{entry.name}:"] if entry.rows else []
    rows = [(f"  {key}: {shown(value, units)}", comment) for key, value, comment in entry.rows]
    width = max([len(text) for text, _ in rows] or [0])
    lines += [f"{text:{width}}  # {comment}" for text, comment in rows]
    return lines + [f"  # {hint}" for hint in entry.hints]


def mode_lines(deck, units):
    """The modes that are asked for."""
    if deck.modes is None:
        return ["modes: {target: 1, count: 20}  # the lowest 20: the file asks for none"]
    count, lowest, highest, place = deck.modes
    about, said = (", contact: static", f", about the state of {deck.preload}") if deck.preload else ("", "")
    if highest > 0:
        return [f'modes: {{band: "{lowest / units.time:.15g},{highest / units.time:.15g}"{about}}}  # {place} Hz{said}']
    return [f"modes: {{target: 1, count: {max(int(count), 1)}{about}}}  # {place} the lowest{said}"]


def model_lines(deck, units, mesh, equations):
    """The mesh, and what is of the scene as a whole."""
    rows = [f"mesh: {quoted(mesh)}"]
    if equations:
        rows.append(f"equations: {quoted(equations)}")
    if deck.gravity is None and len(rows) == 1:
        return [f"model: {{{rows[0]}}}"]
    if deck.gravity is not None:
        vector, place = deck.gravity
        factor = units.length / units.time**2
        rows.append('gravity: "' + ",".join(f"{g * factor:.15g}" for g in vector) + f'"  # {place}')
    return ["model:", *(f"  {row}" for row in rows)]


def loss_lines(deck, units):
    """What loss factors need in analyses that have viscous damping alone."""
    if not any(deck.materials[section.material].loss for section in deck.sections if section.material):
        return []
    low, high = (value / units.time for value in deck.modes[1:3]) if deck.modes else (0, 0)
    middle = f"{(low * high)**0.5 if low > 0 else high / 2:.6g}   # Hz, the middle of the band" if high > 0 else "?   # Hz"
    return ["# Loss factors hold at the frequency of each mode. Sweeps on a basis, samples, cycles, runs in time have them exact at one:",
            f"#   model_loss_frequency: {middle}"]


def scene_lines(deck, result, units, why, files):
    """All lines; files are the mesh, and the equations where there are some."""
    lines = [f"# From {deck.path} ({deck.form}). Everything here is in SI.", f"# {why}", "", *model_lines(deck, units, *files),
             *loss_lines(deck, units)]
    for kind in LISTS:
        entries = [entry for entry in result.entries if entry.kind == kind]
        if entries:
            lines += ["", f"{kind}: {','.join(entry.name for entry in entries)}"]
            lines += [line for entry in entries for line in entry_lines(entry, units)]
    lines += ["", *mode_lines(deck, units)]
    return lines


def remarks(deck):
    """What differs, and what is not in the scene, a line each; of more than MOST_ALIKE that say the same the first and last."""
    alike = {}
    for place, text in deck.missing() + deck.idle():
        alike.setdefault((getattr(place, "file", ""), text), []).append(place)
    lines = [f"{place}: differs: {text}" for text, place in deck.differs.items()]
    for (_, text), places in alike.items():
        if len(places) > MOST_ALIKE:
            lines.append(f"{places[0]}: {text} (and {len(places) - 1} more, the last on line {places[-1].line})")
        else:
            lines += [f"{place}: {text}" for place in places]
    return lines


def write_scene(path, lines, notes):
    """Writes the file, whole or not at all."""
    if notes:
        lines = [*lines, "", "# What differs or is not in this scene:", *(f"# {note}" for note in notes)]
    with whole(path) as part:
        part.write_text("\n".join(lines) + "\n", encoding="utf-8", errors="replace")
