#!/usr/bin/python3
"""Draws made-up modes of a plate and four blocks with long names with scripts/plot/modes: every text must lie within the
picture and off the other panels. Fails when the names of many parts share one label."""

import importlib.machinery
import importlib.util
import tempfile
from pathlib import Path

import h5py
import numpy
from drawing import SCRIPTS, require

PARTS = ["disc", "friction_lining_inside", "backing_plate_inside", "friction_lining_outside", "backing_plate_outside"]
CORNERS = numpy.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
HEIGHTS = [0, 0.02, 0.03, -0.02, -0.03]  # m, of the lower faces


def write_modes(folder, n_modes):
    """modes.csv and modes.h5 of one hexahedron a part."""
    folder.mkdir(parents=True, exist_ok=True)
    rows = [f"{i + 1},{1000 * (i + 1)},{10 * i},1,{PARTS[i]}" for i in range(n_modes)]
    (folder / "modes.csv").write_text("\n".join(["mode,freq_hz,growth_rad_s,unstable,label", *rows]) + "\n")
    sizes = [[0.3, 0.3, 0.02]] + 4 * [[0.06, 0.04, 0.01]]
    points = numpy.concatenate([CORNERS * size + [-0.15 if i == 0 else 0.08, -0.15 if i == 0 else 0, z]
                                for i, (size, z) in enumerate(zip(sizes, HEIGHTS))])
    with h5py.File(folder / "modes.h5", "w") as file:
        group = file.create_group("VTKHDF")
        group["Points"] = points
        group["Connectivity"] = numpy.arange(8 * len(PARTS))
        group["Offsets"], group["Types"] = 8 * numpy.arange(len(PARTS) + 1), numpy.full(len(PARTS), 12, "u1")
        group["CellData/part"] = numpy.arange(len(PARTS))
        group["CellData/part"].attrs["names"] = numpy.array(PARTS, "S")
        for i in range(n_modes):
            group[f"PointData/mode_{i + 1:03d}_re"] = numpy.sin((i + 1) * 9 * points[:, [1, 2, 0]])
            group[f"PointData/mode_{i + 1:03d}_im"] = 0 * points


def load():
    """scripts/plot/modes as a module."""
    loader = importlib.machinery.SourceFileLoader("plot_modes", str(SCRIPTS / "plot" / "modes"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("plot_modes", loader))
    loader.exec_module(module)
    return module


def texts_apart(figure):
    """Labels of the axes and of the legends lie within the picture and off the panels that are not their own."""
    renderer = figure.canvas.get_renderer()
    panels = [axes for part in figure.subfigs for axes in part.axes if axes.axison]
    for axes in (axes for part in figure.subfigs for axes in part.axes):
        legend = axes.get_legend()
        for text in [axes.xaxis.label, axes.yaxis.label, axes.title] + (legend.get_texts() if legend else []):
            box = text.get_window_extent(renderer)
            if not text.get_text():
                continue
            require(box.x0 >= 0 and box.y0 >= 0 and box.x1 <= figure.bbox.x1 and box.y1 <= figure.bbox.y1,
                    f"'{text.get_text()}' leaves the picture: {box}")
            for other in panels:
                require(other is axes or not box.overlaps(other.get_window_extent(renderer)),
                        f"'{text.get_text()}' lies upon another panel")


def main(root):
    """One to four modes."""
    modes = load()
    kept = []
    modes.save_picture = lambda figure, output: kept.append(figure)
    for n_modes in (1, 2, 3, 4):
        folder = root / str(n_modes)
        write_modes(folder, n_modes)
        table = modes.read_modes(folder / "modes.csv")
        with h5py.File(folder / "modes.h5") as file:
            modes.draw(table, modes.Scene(file, "disc"), modes.choose_modes(table, []), None)
        kept[-1].canvas.draw()
        texts_apart(kept[-1])
    print(f"{len(kept)} pictures of {len(PARTS)} parts: all texts apart")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as root_name:
        main(Path(root_name))
