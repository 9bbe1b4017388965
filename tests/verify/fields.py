#!/usr/bin/env python3
"""Checks the shapes of a run (modes.h5, modes.xmf) against its table (modes.csv), or the frames of a film (--film
transient: transient.xmf and the snapshots that it lists), as VTK and ParaView see them.

VTK's HDF reader must see the hexahedra, none inverted, every node used, all parts, and for each mode of the table a
finite shape that is not zero. With --kinds it must see cells of these types of VTK in place of hexahedra of first
order, with the nodes between corners in the middle of VTK's edges and faces, of a mesh with straight edges. The XDMF
file must name datasets that exist, with their true sizes, and the same attributes at each step, since ParaView steps
through them. A wrong order of corners, a node lost or doubled between ranks, a shape under the wrong mode and a stale
path all fail here.

The frames of a film must be numbered from 0, have growing times and the mesh, and displacements and velocities that
are finite, and not all zero in the last one. A frame left out or listed twice fails.

Exit status: 0, or 1 with the first difference on stderr.
"""

import argparse
import csv
import re
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

import h5py
import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import VTK_HEXAHEDRON
from vtkmodules.vtkFiltersVerdict import vtkMeshQuality
from vtkmodules.vtkIOHDF import vtkHDFReader


class Difference(Exception):
    """What was expected and what was found."""


def expect(what, found, expected):
    """Raises a Difference unless found is as expected."""
    if found != expected:
        raise Difference(f"{what}: found {found}, expected {expected}")


def mode_keys(table):
    """Keys of the shapes of all modes of modes.csv, with their frequencies (Hz)."""
    with table.open(newline="") as lines:
        return {f"mode_{int(row['mode']):03d}": float(row["freq_hz"]) for row in csv.DictReader(lines)}


def read_grid(path):
    """The unstructured grid of VTK's HDF reader."""
    reader = vtkHDFReader()
    expect(f"{path} can be read by VTK", reader.CanReadFile(str(path)), 1)
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def hexahedron_measure(grid, measure):
    """A quality measure of vtkMeshQuality for every cell."""
    quality = vtkMeshQuality()
    quality.SetInputData(grid)
    getattr(quality, f"SetHexQualityMeasureTo{measure}")()
    quality.Update()
    return vtk_to_numpy(quality.GetOutput().GetCellData().GetArray("Quality"))


def points_of(cell):
    """Coordinates [n][3] of the points of a cell, m."""
    points = cell.GetPoints()
    return numpy.array([points.GetPoint(i) for i in range(points.GetNumberOfPoints())])


def check_middles(grid):
    """Nodes that are no corners stand in the middle of VTK's edges and faces."""
    for k in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(k)
        edges = [points_of(cell.GetEdge(e)) for e in range(cell.GetNumberOfEdges())]
        faces = [points_of(cell.GetFace(f)) for f in range(cell.GetNumberOfFaces())]
        off = [edge[2] - edge[:2].mean(0) for edge in edges if len(edge) == 3]
        off += [face[8] - face[:4].mean(0) for face in faces if len(face) == 9]
        if numpy.abs(off).max(initial=0) > 1e-12 * numpy.ptp(points_of(cell)):
            raise Difference(f"nodes of cell {k} are not in the middle of VTK's edges")


def check_mesh(grid, hexahedra, nodes, volume, kinds):
    """Cells: number, kinds, orientation, volume (m^3); nodes: number, each used."""
    expect("number of cells", grid.GetNumberOfCells(), hexahedra)
    expect("kinds of cells", set(vtk_to_numpy(grid.GetCellTypesArray()).tolist()), kinds)
    if kinds == {VTK_HEXAHEDRON}:
        inverted = numpy.flatnonzero(hexahedron_measure(grid, "Jacobian") <= 0)
        expect("inverted hexahedra", inverted.tolist(), [])
    check_middles(grid)
    used = numpy.unique(vtk_to_numpy(grid.GetCells().GetConnectivityArray()))
    expect("every node used", used.tolist(), list(range(grid.GetNumberOfPoints())))
    if nodes is not None:
        expect("number of nodes", len(used), nodes)
    if volume is None:
        return
    total = hexahedron_measure(grid, "Volume").sum()
    if abs(total - volume) > 1e-10 * volume:
        raise Difference(f"volume: found {total:.15g} m^3, expected {volume:.15g} m^3")


def check_parts(grid, path, parts):
    """Each part has cells, and its name is in the file."""
    present = set(vtk_to_numpy(grid.GetCellData().GetArray("part")).tolist())
    expect("indices of parts", present, set(range(len(parts))))
    with h5py.File(path) as file:
        names = [name.decode() for name in file["VTKHDF/CellData/part"].attrs["names"]]
    expect("names of parts", names, parts)


FEED_IN = "_feed_in_w_m2"  # where friction has a share


def check_shapes(grid, path, keys):
    """Two vector arrays per mode of the table, finite, not zero, with the mode's frequency in the title."""
    data = grid.GetPointData()
    found = {data.GetArrayName(i) for i in range(data.GetNumberOfArrays())}
    suffixes = ("_re", "_im", FEED_IN) if any(name.endswith(FEED_IN) for name in found) else ("_re", "_im")
    expect("shapes", found, {key + suffix for key in keys for suffix in suffixes})
    for key, frequency in keys.items():
        shape = [vtk_to_numpy(data.GetArray(key + suffix)) for suffix in ("_re", "_im")]
        expect(f"size of {key}", [part.shape for part in shape], 2 * [(grid.GetNumberOfPoints(), 3)])
        if not all(numpy.isfinite(part).all() for part in shape) or not any(part.any() for part in shape):
            raise Difference(f"{key} is zero or not finite")
        with h5py.File(path) as file:
            title = file[f"VTKHDF/PointData/{key}_re"].attrs["title"].decode()
        named = re.search(r"([-+.\de]+) Hz", title)
        if not named or abs(float(named[1]) - frequency) > 0.01 + 1e-4 * frequency:
            raise Difference(f"title of {key}: found '{title}', expected {frequency:.2f} Hz in it")


def check_item(item, folder):
    """A <DataItem> names an existing dataset of its size and precision; returns the name."""
    name, dataset = item.text.split(":")
    with h5py.File(folder / name) as file:
        expect(f"{item.text} exists", dataset in file, True)
        shape = " ".join(str(n) for n in file[dataset].shape)
        expect(f"size of {item.text}", shape, item.get("Dimensions"))
        expect(f"precision of {item.text}", str(file[dataset].dtype.itemsize), item.get("Precision"))
    return dataset


def check_xdmf(path, keys, hexahedra):
    """One grid per mode, Time = its number, the same attributes at each, pointing at the mode's own shape."""
    grids = xml.parse(path).findall("./Domain/Grid/Grid")
    expect("grids of the XDMF file", [grid.get("Name") for grid in grids], list(keys))
    for step, grid in enumerate(grids, 1):
        key = grid.get("Name")
        attributes = grid.findall("Attribute")
        datasets = {item.get("Name"): check_item(item.find("DataItem"), path.parent) for item in attributes}
        expect(f"time of {key}", grid.find("Time").get("Value"), str(step))
        expect(f"hexahedra of {key}", grid.find("Topology").get("NumberOfElements"), str(hexahedra))
        feed_in = {name: f"/VTKHDF/PointData/{key}_{name}" for name in datasets if name == FEED_IN[1:]}
        expect(f"attributes of {key}", datasets, feed_in | {
            "part": "/VTKHDF/CellData/part",
            "displacement_re": f"/VTKHDF/PointData/{key}_re",
            "displacement_im": f"/VTKHDF/PointData/{key}_im",
        })
        for place in ("Topology", "Geometry"):
            check_item(grid.find(f"{place}/DataItem"), path.parent)


def check_frame(grid, folder, hexahedra):
    """A frame of a film names datasets of its own file; returns displacements and velocities of that file."""
    file = folder / f"{grid.get('Name')}.h5"
    items = [item.text for item in grid.iter("DataItem")]
    expect(f"file of {grid.get('Name')}", {item.split(":")[0] for item in items}, {file.name})
    for item in grid.iter("DataItem"):
        check_item(item, folder)
    names = [attribute.get("Name") for attribute in grid.findall("Attribute")]
    expect(f"attributes of {grid.get('Name')}", names, ["part", "displacement_m", "velocity_m_s"])
    expect(f"hexahedra of {grid.get('Name')}", grid.find("Topology").get("NumberOfElements"), str(hexahedra))
    with h5py.File(file) as content:
        return [content[f"VTKHDF/PointData/{name}"][:] for name in names[1:]]


def check_film(path, hexahedra):
    """Frames of a film: numbers, times, files, motions; returns their number."""
    grids = xml.parse(path).findall("./Domain/Grid/Grid")
    numbered = [f"snapshot_{k:06d}" for k in range(len(grids))]
    expect("names of the frames", [grid.get("Name") for grid in grids], numbered)
    times = [float(grid.find("Time").get("Value")) for grid in grids]
    expect("frames at growing times", times, sorted(set(times)))
    motions = [check_frame(grid, path.parent, hexahedra) for grid in grids]
    expect("all motions finite", all(numpy.isfinite(m).all() for frame in motions for m in frame), True)
    expect("the last frame moves", [bool(m.any()) for m in motions[-1]], [True, True])
    return len(grids)


def arguments():
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="folder with modes.csv, modes.h5 and modes.xmf, or with a film")
    parser.add_argument("hexahedra", type=int, help="number of cells of the mesh")
    parser.add_argument("parts", help="names of the parts in order, e.g. disc,pad,beam")
    parser.add_argument("--nodes", type=int, help="number of nodes of the mesh")
    parser.add_argument("--volume", type=float, help="volume of the mesh, m^3, to 1e-10")
    parser.add_argument("--kinds", help="VTK's types of the cells, e.g. 24,25; default hexahedra of 8 nodes")
    parser.add_argument("--film", help="name of a film instead of modes")
    return parser.parse_args()


def main():
    """Runs all checks; returns the exit status."""
    args = arguments()
    fields = args.folder / ("snapshot_000000.h5" if args.film else "modes.h5")
    try:
        grid = read_grid(fields)
        kinds = {int(kind) for kind in args.kinds.split(",")} if args.kinds else {VTK_HEXAHEDRON}
        check_mesh(grid, args.hexahedra, args.nodes, args.volume, kinds)
        check_parts(grid, fields, args.parts.split(","))
        if args.film:
            done = f"{check_film(args.folder / f'{args.film}.xmf', args.hexahedra)} frames"
        else:
            keys = mode_keys(args.folder / "modes.csv")
            check_shapes(grid, fields, keys)
            check_xdmf(args.folder / "modes.xmf", keys, args.hexahedra)
            done = f"{len(keys)} modes"
    except (Difference, OSError, KeyError, xml.ParseError) as error:
        print(f"test_fields: {args.folder}: {error}", file=sys.stderr)
        return 1
    print(f"{args.folder}: {grid.GetNumberOfPoints()} nodes, {args.hexahedra} cells, {done}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
