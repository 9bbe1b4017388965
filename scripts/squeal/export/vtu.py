"""VTU: one file for each state, VTK's XML of unstructured grids with the numbers behind it as they are in memory; PVTU where
the cells are cut into pieces; PVD, the list of a series, for ParaView. Reference: VTK File Formats, XML."""

from xml.sax.saxutils import quoteattr

import numpy

from ..tables import whole

TYPES = {"float64": "Float64", "int64": "Int64", "int32": "Int32", "uint8": "UInt8"}
HEAD = '<?xml version="1.0"?>\n<VTKFile type="{}" version="1.0" byte_order="LittleEndian" header_type="UInt64">\n'


class Appended:
    """The numbers at the end of a file: each array after its length in bytes, 8 bytes."""

    def __init__(self):
        self.arrays, self.offset = [], 0

    def element(self, name, array):
        """The XML that points at an array [n] or [n][width]."""
        array = numpy.ascontiguousarray(array, array.dtype.newbyteorder("<"))
        width = f' NumberOfComponents="{array.shape[1]}"' if array.ndim == 2 else ""
        text = f'<DataArray type="{TYPES[array.dtype.name]}" Name={quoteattr(name)}{width} format="appended" offset="{self.offset}"/>\n'
        self.arrays.append(array)
        self.offset += 8 + array.nbytes
        return text

    def write(self, stream):
        """All of them."""
        for array in self.arrays:
            stream.write(numpy.uint64(array.nbytes).astype("<u8").tobytes())
            stream.write(array.tobytes())


def text_array(name, texts):
    """XML of words: numbers of their bytes, each word ends in 0."""
    codes = " ".join(str(code) for text in texts for code in (*text.encode(), 0))
    return f'<DataArray type="String" Name={quoteattr(name)} NumberOfTuples="{len(texts)}" format="ascii">{codes}</DataArray>\n'


def field_data(state):
    """XML of what belongs to the whole state."""
    facts = {"TimeValue": state.value, **state.facts}
    numbers = "".join(f'<DataArray type="Float64" Name={quoteattr(name)} NumberOfTuples="1" format="ascii">{float(value)!r}</DataArray>\n'
                      for name, value in facts.items())
    return "<FieldData>\n" + numbers + text_array("title", [state.title]) + text_array("part_names", state.grid.names) + "</FieldData>\n"


def flat_cells(grid):
    """Nodes of all cells one after the other, the ends of the cells, and VTK's types, in the order of the cells."""
    n_cells = len(grid.part)
    count, types = numpy.zeros(n_cells, numpy.int64), numpy.zeros(n_cells, numpy.uint8)
    for kind, (number, nodes) in grid.cells.items():
        count[number], types[number] = nodes.shape[1], kind
    ends = numpy.cumsum(count)
    flat = numpy.empty(ends[-1] if n_cells else 0, numpy.int64)
    for number, nodes in grid.cells.values():
        flat[(ends - count)[number][:, None] + numpy.arange(nodes.shape[1])] = nodes
    return flat, ends, types


def pieces(grid, n_pieces):
    """For each piece its nodes, connectivity in these, ends, types, parts; one piece has all nodes, also those of no cell."""
    flat, ends, types = flat_cells(grid)
    bounds = numpy.linspace(0, len(ends), n_pieces + 1).astype(int)
    for first, last in zip(bounds, bounds[1:]):
        begin = ends[first - 1] if first else 0
        mine = flat[begin:ends[last - 1] if last else 0]
        nodes, local = (numpy.arange(len(grid.points)), mine) if n_pieces == 1 else numpy.unique(mine, return_inverse=True)
        yield nodes, local.astype(numpy.int64), ends[first:last] - begin, types[first:last], grid.part[first:last].astype(numpy.int32)


def write_piece(path, state, piece):
    """One VTU."""
    nodes, local, ends, types, part = piece
    appended = Appended()
    xml = [HEAD.format("UnstructuredGrid"), "<UnstructuredGrid>\n", field_data(state),
           f'<Piece NumberOfPoints="{len(nodes)}" NumberOfCells="{len(ends)}">\n<PointData>\n',
           *(appended.element(name, array[nodes]) for name, array in state.arrays.items()),
           "</PointData>\n<CellData>\n", appended.element("part", part), "</CellData>\n<Points>\n",
           appended.element("Points", state.grid.points[nodes]), "</Points>\n<Cells>\n",
           *(appended.element(*pair) for pair in (("connectivity", local), ("offsets", ends), ("types", types))),
           "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_"]
    with whole(path) as temporary, temporary.open("wb") as stream:
        stream.write("".join(xml).encode())
        appended.write(stream)
        stream.write(b"\n</AppendedData>\n</VTKFile>\n")


def parallel_text(state, files):
    """The PVTU of pieces."""
    arrays = "".join(f'<PDataArray type="Float64" Name={quoteattr(name)}' + (' NumberOfComponents="3"' if array.ndim == 2 else "")
                     + "/>\n" for name, array in state.arrays.items())
    sources = "".join(f"<Piece Source={quoteattr(name)}/>\n" for name in files)
    return (HEAD.format("PUnstructuredGrid") + '<PUnstructuredGrid GhostLevel="0">\n' + f"<PPointData>\n{arrays}</PPointData>\n"
            + '<PCellData>\n<PDataArray type="Int32" Name="part"/>\n</PCellData>\n<PPoints>\n'
            + '<PDataArray type="Float64" Name="Points" NumberOfComponents="3"/>\n</PPoints>\n' + sources
            + "</PUnstructuredGrid>\n</VTKFile>\n")


def write_text(path, text):
    """A whole file of text."""
    with whole(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def write_state(folder, state, n_pieces):
    """The files of a state; returns the name of the one to open."""
    if n_pieces == 1:
        write_piece(folder / f"{state.name}.vtu", state, next(pieces(state.grid, 1)))
        return f"{state.name}.vtu"
    files = [f"{state.name}_{k}.vtu" for k in range(n_pieces)]
    for name, piece in zip(files, pieces(state.grid, n_pieces)):
        write_piece(folder / name, state, piece)
    write_text(folder / f"{state.name}.pvtu", parallel_text(state, files))
    return f"{state.name}.pvtu"


def write_series(folder, series, files):
    """The PVD of a series: (value, file) of each state."""
    rows = "".join(f'<DataSet timestep="{float(value)!r}" group="" part="0" file={quoteattr(name)}/>\n' for value, name in files)
    write_text(folder / f"{series}.pvd", f'<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n<Collection>\n{rows}'
                                         "</Collection>\n</VTKFile>\n")


def write_vtu(states, folder, n_pieces=1):
    """All states; returns the files to open: lists of series, or the single file of one that is alone."""
    series = {}
    for state in states:
        folder.mkdir(parents=True, exist_ok=True)
        series.setdefault(state.series, []).append((float(state.value), write_state(folder, state, n_pieces)))
    for name, files in series.items():
        write_series(folder, name, files)
    return [folder / f"{name}.pvd" for name in series]
