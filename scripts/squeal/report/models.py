"""Section of a reduced model: sliders for its parameters; eigenvalues, growth and estimated errors are computed in the browser, and the
moving shape of a mode where reduced_shapes.h5 has the vectors of the model.

Shapes of the modes at some points of the box, V X, need fewer directions than the model has vectors V: with the leading left singular
vectors U of these a mode x moves as U (U'V) x."""

import base64
import json
import math
import zlib

import numpy

from ..mesh.bodies import Scene, opened, sound
from ..tables import BadInput, header, optional, read_table
from .boxes import DESIGN
from .markup import Markup, Part, count, figures, missing, section, tag
from .model_file import ReducedModel
from .shapes import FULL, Bodies, Shape, data_script, packed, viewer

BEYOND = 0.25  # of the range, on either side: how far sliders reach
STEPS = 400
POINTS = 6  # of the box beside the scene's own, whose modes' shapes are taken
SHAPE_ERROR = 0.01  # of the length of a shape, that directions left out may be
ABSENT = "No shapes: reduced_shapes.h5 is not there. It is left out above 96 MB, without a mesh, and with -output_fields 0."
HEADS = "frequency, Hz", "growth, 1/s", "error, rad/s", "state"


def slider(entry, contact):
    """One parameter; contact: with a bar of where its status holds."""
    low, high = entry["lower"], entry["upper"]
    reach = BEYOND * (high - low)
    first = low - reach if low <= 0 else max(low - reach, 0.1 * low)
    return tag("label", tag("span", f"{entry['name'].replace('+', ' + ')} {entry['unit']}".strip(), class_="name"),
               tag("input", type="range", min=f"{first:.10g}", max=f"{high + reach:.10g}", step="any", value=f"{entry['value']:.17g}"),
               tag("output", figures(entry["value"], 5)),
               tag("span", f"made for {figures(low, 4)} to {figures(high, 4)}", class_="made"),
               tag("span", class_="holds", aria_hidden="true") if contact else None)


def modes_at(model, p):
    """Vectors [n_used][modes] of the band."""
    K, C, M = model.at(p)
    n, h = len(K), model.head["high"]
    if C.any():
        A = numpy.vstack([numpy.eye(n, 2 * n, n) * h, numpy.linalg.solve(M, numpy.hstack([-K / h, -C]))])
        values, vectors = numpy.linalg.eig(A)
    else:
        kappa, vectors = numpy.linalg.eig(numpy.linalg.solve(M, K))
        values = 1j * numpy.sqrt(kappa.astype(complex))
    inside = (abs(values.imag) >= model.head["low"]) & (abs(values.imag) <= h)
    return vectors[:n, inside]


def snapshots(model):
    """Coordinates of the modes at some points of the box, real and imaginary parts, columns of length 1."""
    low, high, own = (numpy.array([entry[key] for entry in model.head["parameters"]]) for key in ("lower", "upper", "value"))
    points = [own, *(low + (high - low) * numpy.random.default_rng(1).random((POINTS, len(low))))]
    with numpy.errstate(all="ignore"):  # what is not finite is an error of eig
        vectors = numpy.hstack([modes_at(model, p) for p in points])
    columns = numpy.hstack([vectors.real, vectors.imag])
    return columns / numpy.maximum(numpy.linalg.norm(columns, axis=0), 1e-300)


def shape_of(path, name, shapes, scene):
    """Vector of the model on the nodes of the scene, [nodes][3]."""
    wanted, there = (len(scene.points), 3), getattr(shapes.get(name), "shape", "none")
    if there != wanted:
        raise BadInput(f"{path}: array {name} is {there}, must be {wanted}: nodes and directions; was the file damaged?")
    return sound(path, name, shapes[name][:])


def directions_of(path, disc, model, snaps, room):
    """Bodies, directions U [3 nodes][r] on their surface and their weights U'V [r][n_used]; None where they do not fit into the room."""
    with opened(path) as file:
        scene = Scene(file, disc)
        bodies = Bodies(scene)
        V = numpy.stack([bodies.moved(shape_of(path, f"vector_{k:03d}", scene.shapes, scene)).ravel()
                         for k in range(1, model.head["n_used"] + 1)], axis=1)
    moved = V @ snaps
    U, size, _ = numpy.linalg.svd(moved / numpy.maximum(numpy.linalg.norm(moved, axis=0), 1e-300), full_matrices=False)
    left = numpy.sqrt(numpy.cumsum(size[::-1]**2)[::-1] / moved.shape[1])
    r = max(1, int((left > SHAPE_ERROR).sum()))
    return (bodies, U[:, :r], U[:, :r].T @ V) if 8 / 3 * len(U) * r < room else None


def moving(folder, name, model, snaps, room):
    """The viewer of the chosen mode; what is missing."""
    path = folder.path / "reduced_shapes.h5"
    if not path.exists():
        return missing(ABSENT), None
    try:
        found = directions_of(path, folder.disc(), model, snaps, room)
    except BadInput as error:
        return missing(f"No shapes: {folder.said(error)}."), None
    if not found:
        return missing("No shapes: they are too large for the page."), None
    bodies, U, weights = found
    largest = abs(U).max(axis=0)
    still = Shape(0, "", "", bodies.packed_shape(numpy.zeros((int(bodies.nodes.max()) + 1, 3))))
    script = data_script(name, bodies, [still], weights=packed(weights * largest[:, None] / FULL, "<f8"), rank=len(weights),
                         directions=[packed(numpy.rint(FULL * u / high), "<i2") for u, high in zip(U.T, largest)])
    return [script, viewer(f"{name}-viewer", name, "moving shape of the chosen mode; drag to turn it")], name


def known_places(folder):
    """Values of parameters by their names: of a design that was found, of a dangerous point."""
    design, quiet = folder.path / "design.csv", folder.path / "quiet.csv"
    if design.exists():
        names = header(design)[len(DESIGN):]
        rows = read_table(design, dict.fromkeys(("found", *names), optional))
        yield "The design's values", next(({name: row[name] for name in names} for row in rows if row["found"] == 1), {})
    if quiet.exists():
        rows = read_table(quiet, {"variable": str, "danger": optional})
        yield "The nearest dangerous point", {row["variable"]: row["danger"] for row in rows}


def places(folder, entries):
    """Buttons that set all sliders; what a place does not name is the scene's own. A place has none where it misses a value, or names what
    is no slider, as options that move together but not in proportion, "a+b", have one each: the sliders would stand elsewhere."""
    buttons, names = [("The scene's own values", [entry["value"] for entry in entries])], {entry["name"] for entry in entries}
    for title, there in known_places(folder):
        if there and names.issuperset(there) and all(math.isfinite(value) for value in there.values()):
            buttons.append((title, [there.get(entry["name"], entry["value"]) for entry in entries]))
    return [tag("button", title, type="button", data_values=json.dumps(values)) for title, values in buttons]


def contact_text(contact):
    """By which rule a place has its contact status."""
    if not contact:
        return None
    far = contact.left_out()
    kept, others = int((far == 0).sum()), far[far > 0]
    said = (f" Of these points {kept} have the status of the nearest other one, for {len(others)} it differs by up to "
            f"{count(int(others.max()), 'pair')} (median {figures(numpy.median(others), 3)}).") if len(others) else ""
    return tag("p", f"Which of {contact.pairs} contact pairs are closed differs over the box: {len(contact.closed)} statuses. The sliders "
               f"take the status of the nearest of {len(contact.points)} points where one was found, each distance divided by the range "
               f"of its slider; between them that is a guess.{said} Values jump where the status changes: the bar below a slider is dark "
               "where the present one holds, with the other sliders as they are.")


def model_part(folder, room):
    """All of it."""
    path = folder.path / "reduced_model.bin"
    model = ReducedModel(path)
    try:
        snaps = snapshots(model)
    except numpy.linalg.LinAlgError as error:
        raise BadInput(f"{path}: has no modes at some values of its parameters: {error}; was the file damaged?") from None
    text = base64.b64encode(zlib.compress(model.data, 6)).decode()
    if len(text) > max(room, 3e6):
        raise BadInput(f"{path}: {len(text) / 1e6:.1f} MB are too much for the page")
    name, head = f"{folder.key}-model", model.head
    table = tag("table", tag("thead", tag("tr", [tag("th", title) for title in HEADS])), tag("tbody"))
    further = head["n"] - head["n_used"]
    estimate = (f"and {count(further, 'further one')} for the estimate of its error (an estimate, no bound)" if further else
                "and none further to estimate errors of single modes by")
    said = f"{count(head['n_used'], 'vector')}, {estimate}. The modes are computed here, in the browser."
    picture, vectors = moving(folder, f"{folder.key}-vectors", model, snaps, room - len(text))
    said += " A click on a row shows how that mode moves." if vectors else ""
    place = tag("div", [slider(entry, model.contact) for entry in head["parameters"]],
                tag("div", places(folder, head["parameters"]), class_="places"), tag("p", "", class_="beyond-line", role="status"),
                tag("p", "", class_="contact-line", role="status") if model.contact else None,
                tag("p", "", class_="said"), tag("div", table, class_="scroll"),
                class_="sliders", data_source=f"{name}-data", data_shapes=vectors and f"{vectors}-viewer")
    content = section(name, "The model", tag("p", said), contact_text(model.contact), place, picture,
                      tag("script", Markup(text), type="application/octet-stream", id=f"{name}-data"))
    return Part(content)
