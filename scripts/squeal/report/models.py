"""Section of a reduced model: sliders for its parameters; eigenvalues, growth and estimated errors are computed in the browser, and the
moving shape of a mode where reduced_shapes.h5 has the vectors of the model.

Shapes of the modes at some points of the box, V X, need fewer directions than the model has vectors V: with the leading left singular
vectors U of these a mode x moves as U (U'V) x."""

import base64
import json
import zlib

import numpy

from ..mesh.bodies import Scene, opened, sound
from ..tables import BadInput
from .markup import Markup, Part, count, figures, missing, section, tag
from .shapes import FULL, Bodies, Shape, data_script, packed, viewer

BEYOND = 0.25  # of the range, on either side: how far sliders reach
STEPS = 400
POINTS = 6  # of the box beside the scene's own, whose modes' shapes are taken
SHAPE_ERROR = 0.01  # of the length of a shape, that directions left out may be
LARGEST = 1e100  # number of a matrix
LIMITS = "low", "high", "limit_ratio", "limit_growth", "error"
ABSENT = "No shapes: reduced_shapes.h5 is not there. It is left out above 96 MB, without a mesh, and with -output_fields 0."
HEADS = "frequency, Hz", "growth, 1/s", "error, rad/s", "state"


def read_model(path):
    """What its first line says, the matrices [terms][n][n], and all bytes."""
    data = path.read_bytes()
    try:
        model = json.loads(data[:data.index(b"\n")])
        n = model["n"]
        matrices = numpy.frombuffer(data[data.index(b"\n") + 1:]).reshape(len(model["terms"]), n, n).transpose(0, 2, 1)
        check_head(model)
    except (ValueError, KeyError, TypeError, IndexError, OverflowError):
        raise BadInput(f"{path}: is no reduced model, or is not whole") from None
    if not (abs(matrices) < LARGEST).all():
        raise BadInput(f"{path}: a matrix has values that are no numbers or above {LARGEST:g}; was the file damaged?")
    return model, matrices, data


def check_head(model):
    """ValueError, KeyError or TypeError where what is read of it cannot be."""
    ranges = [[float(entry[key]) for key in ("lower", "value", "upper")] for entry in model["parameters"]]
    powers = [float(power) for term in model["terms"] for i, power, absolute in term["factors"] if ranges[i] and absolute in (0, 1)]
    numbers = [*powers, *(float(term["scale"]) for term in model["terms"]), *(x for values in ranges for x in values),
               *(float(model[key]) for key in LIMITS)]
    named = all(entry["name"] + entry["unit"] for entry in model["parameters"]) and {term["kind"] for term in model["terms"]} <= set("KCM")
    if not (named and 0 < model["n_used"] <= model["n"] and numpy.isfinite(numbers).all() and all(low < high for low, _, high in ranges)):
        raise ValueError


def slider(entry):
    """One parameter."""
    low, high = entry["lower"], entry["upper"]
    reach = BEYOND * (high - low)
    first = low - reach if low <= 0 else max(low - reach, 0.1 * low)
    return tag("label", f"{entry['name']} {entry['unit']}".strip(),
               tag("input", type="range", min=f"{first:.10g}", max=f"{high + reach:.10g}", step="any", value=f"{entry['value']:.17g}"),
               tag("output", figures(entry["value"], 5)),
               tag("span", f"made for {figures(low, 4)} to {figures(high, 4)}", class_="made"))


def pencil_at(model, matrices, p):
    """K, C, M on the vectors in use."""
    n = model["n_used"]
    sums = {kind: numpy.zeros((n, n)) for kind in "KCM"}
    for term, matrix in zip(model["terms"], matrices):
        factors = [(abs(p[i]) if absolute else p[i])**power for i, power, absolute in term["factors"]]
        sums[term["kind"]] += term["scale"] * numpy.prod(factors) * matrix[:n, :n]
    return sums["K"], sums["C"], sums["M"]


def modes_at(model, matrices, p):
    """Vectors [n_used][modes] of the band."""
    K, C, M = pencil_at(model, matrices, p)
    n, h = len(K), model["high"]
    if C.any():
        A = numpy.vstack([numpy.eye(n, 2 * n, n) * h, numpy.linalg.solve(M, numpy.hstack([-K / h, -C]))])
        values, vectors = numpy.linalg.eig(A)
    else:
        kappa, vectors = numpy.linalg.eig(numpy.linalg.solve(M, K))
        values = 1j * numpy.sqrt(kappa.astype(complex))
    inside = (abs(values.imag) >= model["low"]) & (abs(values.imag) <= h)
    return vectors[:n, inside]


def snapshots(model, matrices):
    """Coordinates of the modes at some points of the box, real and imaginary parts, columns of length 1."""
    low, high, own = (numpy.array([entry[key] for entry in model["parameters"]]) for key in ("lower", "upper", "value"))
    points = [own, *(low + (high - low) * numpy.random.default_rng(1).random((POINTS, len(low))))]
    with numpy.errstate(all="ignore"):  # what is not finite is an error of eig
        vectors = numpy.hstack([modes_at(model, matrices, p) for p in points])
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
                         for k in range(1, model["n_used"] + 1)], axis=1)
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


def model_part(folder, room):
    """All of it."""
    path = folder.path / "reduced_model.bin"
    model, matrices, data = read_model(path)
    try:
        snaps = snapshots(model, matrices)
    except numpy.linalg.LinAlgError as error:
        raise BadInput(f"{path}: has no modes at some values of its parameters: {error}; was the file damaged?") from None
    text = base64.b64encode(zlib.compress(data, 6)).decode()
    if len(text) > max(room, 3e6):
        raise BadInput(f"{path}: {len(text) / 1e6:.1f} MB are too much for the page")
    name = f"{folder.key}-model"
    table = tag("table", tag("thead", tag("tr", [tag("th", head) for head in HEADS])), tag("tbody"))
    further = model["n"] - model["n_used"]
    estimate = (f"and {count(further, 'further one')} for the estimate of its error (an estimate, no bound)" if further else
                "and none further to estimate errors of single modes by")
    said = f"{count(model['n_used'], 'vector')}, {estimate}. The modes are computed here, in the browser."
    picture, vectors = moving(folder, f"{folder.key}-vectors", model, snaps, room - len(text))
    said += " A click on a row shows how that mode moves." if vectors else ""
    place = tag("div", [slider(entry) for entry in model["parameters"]], tag("button", "The scene's own values", type="button"),
                tag("p", "", class_="beyond-line", role="status"), tag("p", "", class_="said"), tag("div", table, class_="scroll"),
                class_="sliders", data_source=f"{name}-data", data_shapes=vectors and f"{vectors}-viewer")
    content = section(name, "The model", tag("p", said), place, picture,
                      tag("script", Markup(text), type="application/octet-stream", id=f"{name}-data"))
    return Part(content)
