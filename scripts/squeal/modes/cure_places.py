"""Where layers may be put: sets that springs, dashpots and loads of a scene act on, and rings of its disc."""

from ..tables import regular

RINGS = 3  # of equal width
LISTS = "springs", "dashpots", "loads"
NAMES = "disc", "disk", "rotor", "drum"  # of a part that is one, as squeal takes it


def sets(scene):
    """Names of sets, but surfaces of contacts: nothing can be put on a face that rubs."""
    rubs = {name for contact in scene.names("contacts") for name in scene.value(f"{contact}_surfaces").split(",")}
    found = [scene.value(f"{name}_set") for kind in LISTS for name in scene.names(kind)]
    return [name for name in dict.fromkeys(found) if name and name not in rubs]


def rings(results, scene):
    """Radii of rings as texts, m; none without fields, or a part that is called a disc."""
    import h5py
    import numpy

    parts, path = scene.names("parts"), results / "modes_effects.h5"
    asked = scene.value("modes_disc", "disc")
    named = [asked] if asked in parts else [name for name in parts if any(word in name.lower() for word in NAMES)]
    if len(named) != 1 or not path.exists():
        return []
    with h5py.File(regular(path) and path) as file:
        grid = file["VTKHDF"]
        part = numpy.repeat(grid["CellData/part"][()], numpy.diff(grid["Offsets"][()]))
        places = grid["Points"][()][numpy.unique(grid["Connectivity"][()][part == parts.index(named[0])])]
    places = places - places.mean(axis=0)
    spread, axes = numpy.linalg.eigh(places.T @ places)
    axis = axes[:, 0 if spread[1] - spread[0] > spread[2] - spread[1] else 2]
    radius = numpy.linalg.norm(places - numpy.outer(places @ axis, axis), axis=1)
    edges = numpy.linspace(radius.min(), radius.max(), RINGS + 1)
    return [f"{inner:.6g},{outer:.6g}" for inner, outer in zip(edges, edges[1:])]
