"""A scene and its mesh as scripts/import wrote them, read again from the two files for balance.py."""

import numpy
import yaml

from ..tables import BadInput
from . import touching
from .balance import Carried, Model, cells_of_faces
from .mesh.elements import FACE_GMSH, SHAPES

VOLUMES = {shape.gmsh: shape for shape in SHAPES.values()}
FACES = {number: n for n, number in FACE_GMSH.items()}
NODES = {15: 1} | FACES | {number: shape.n_nodes for number, shape in VOLUMES.items()}


class Reader:
    """Numbers of a binary file, one after the other."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, kind, n):
        found = numpy.frombuffer(self.data, kind, n, self.at)
        self.at += found.nbytes
        return found

    def section(self, name):
        """Goes to the content of a section."""
        mark = b"$" + name + b"\n"
        self.at = self.data.index(mark) + len(mark)


def read_mesh(path):
    """Places [n][3]; elements (dimension, entity, type, nodes [e][k] from 0); names of groups by (dimension, entity)."""
    file = Reader(path.read_bytes())
    file.section(b"PhysicalNames")
    text = file.data[file.at:file.data.index(b"$EndPhysicalNames")].decode().splitlines()
    names = {tuple(map(int, line.split()[:2])): line.split('"')[1] for line in text[1:]}
    file.section(b"Entities")
    groups = {}
    for dimension, count in enumerate(file.take("<u8", 4).tolist()):
        for _ in range(count):
            tag = int(file.take("<i4", 1)[0])
            file.take("<f8", 6 if dimension else 3)
            members = file.take("<i4", int(file.take("<u8", 1)[0])).tolist()
            groups[dimension, tag] = [names[dimension, member] for member in members]
            if dimension:
                file.take("<i4", int(file.take("<u8", 1)[0]))
    file.section(b"Nodes")
    places, tags = [], []
    for _ in range(int(file.take("<u8", 4)[0])):
        file.take("<i4", 3)
        n = int(file.take("<u8", 1)[0])
        tags.append(file.take("<u8", n))
        places.append(file.take("<f8", 3 * n).reshape(-1, 3))
    tags = numpy.concatenate(tags).astype(int)
    index = numpy.zeros(tags.max(initial=0) + 1, int)
    index[tags] = numpy.arange(len(tags))
    file.section(b"Elements")
    elements = []
    for _ in range(int(file.take("<u8", 4)[0])):
        dimension, tag, kind = file.take("<i4", 3).tolist()
        n = int(file.take("<u8", 1)[0])
        rows = file.take("<u8", n * (1 + NODES[kind])).reshape(n, -1)[:, 1:]
        elements.append((dimension, tag, kind, index[rows.astype(int)]))
    return numpy.concatenate(places), elements, groups


def in_order(shape, nodes):
    """Nodes of elements in the order of the shape, not of Gmsh."""
    found = numpy.empty_like(nodes)
    found[:, shape.gmsh_order()] = nodes
    return found


def numbers(value):
    """One or more of an option."""
    return [float(word) for word in str(value).split(",")]


def words(scene, name):
    """A list of the scene."""
    return [word.strip() for word in str(scene.get(name) or "").split(",") if word.strip()]


def of_scene(mesh, path):
    """The model of the two files."""
    x, elements, groups = read_mesh(mesh)
    with path.open(encoding="utf-8") as text:
        scene = yaml.safe_load(text)
    if not isinstance(scene, dict):
        raise BadInput(f"{path}: is no scene")
    volumes = [(VOLUMES[kind], in_order(VOLUMES[kind], nodes)) for dimension, _, kind, nodes in elements if dimension == 3]
    model, cells, first = Model(x, volumes), {}, 0
    for dimension, tag, _, nodes in elements:
        if dimension == 3:
            for name in groups[3, tag]:
                cells.setdefault(name, []).append(numpy.arange(first, first + len(nodes)))
            first += len(nodes)
    for name in words(scene, "parts"):
        density = (scene.get(name) or {}).get("density")
        model.parts.append((name, None if density is None else float(density), numpy.concatenate(cells[name])))
    sets = {}
    for dimension, tag, _, nodes in elements:
        for name in groups[dimension, tag] if dimension < 3 else ():
            sets.setdefault(name, []).append(nodes)
    hold(model, scene, sets)
    points = join(model, scene, sets)
    load(model, scene, sets, points)
    model.touching = touching.of_scene(scene, words, sets, x)
    return model


def hold(model, scene, sets):
    """Supports, motions and springs."""
    for kind, key in (("supports", "fix"), ("motions", "directions")):
        for name in words(scene, kind):
            nodes = numpy.unique(numpy.concatenate([rows.ravel() for rows in sets[scene[name]["set"]]]))
            for letter in str(scene[name][key]):
                model.held[nodes, "xyz".index(letter)] = True
    for name in words(scene, "springs"):
        for nodes in sets[scene[name]["set"]]:
            model.springs[nodes.ravel()] += numbers(scene[name]["stiffness"])


def join(model, scene, sets):
    """Points and bushings, and the number of equations; returns the points by their names."""
    found = {}
    for name in words(scene, "points"):
        values = scene[name]
        nodes = numpy.unique(numpy.concatenate([rows.ravel() for rows in sets[values["set"]]]))
        inertia = numbers(values["inertia"]) if "inertia" in values else [0.0] * 6
        found[name] = Carried(int(nodes[0]), numpy.array(numbers(values["at"])), float(values.get("mass", 0)), numpy.array(inertia))
        model.points.append(found[name])
        if values.get("join") == "rigid":
            model.rigid.append(nodes)
    for name in words(scene, "joints"):
        model.links.append([value for key in ("stiffness", "turn_stiffness", "viscosity", "turn_viscosity")
                            for value in numbers(scene[name].get(key, "0,0,0"))])
    table = (scene.get("model") or {}).get("equations")
    if table:
        with open(table, encoding="utf-8") as lines:
            model.equations = len({line.partition(",")[0] for line in lines if line[0].isdigit()})
    return found


def load(model, scene, sets, points):
    """Forces, spread evenly over a set or on a point, and pressures on the faces of another."""
    for name in words(scene, "loads"):
        values = scene[name]
        if "point" in values:
            points[values["point"]].force = numpy.array(numbers(values.get("force", "0,0,0")))
            points[values["point"]].moment = numpy.array(numbers(values.get("moment", "0,0,0")))
            continue
        members = sets[values["set"]]
        if "force" in values:
            nodes = numpy.concatenate([rows.ravel() for rows in members])
            model.forces[nodes] += numpy.array(numbers(values["force"])) / len(nodes)
        if "pressure" in values:
            for nodes in members:
                cells = cells_of_faces(model, nodes)
                model.pressed.append((cells[cells >= 0], nodes[cells >= 0], numbers(values["pressure"])[0]))
    gravity = (scene.get("model") or {}).get("gravity")
    if gravity is not None:
        model.gravity = numpy.array(numbers(gravity))
