"""Matrices of a MATLAB file: version 5 to 7.2 is read here, since scipy.io.loadmat() ends the process on some damaged files; version
7.3 is HDF5, which h5py reads. Reference: MathWorks, MAT-File Format, 2019.

A file has 128 bytes of head, then elements: type and length in 4 bytes each (both in 4 bytes for up to 4 bytes of data),
data, filled to 8 bytes. A matrix is an element of elements: flags, dimensions, name, and of a sparse one rows, starts of
columns, values."""

import struct
import zlib

import h5py
import numpy

from ..tables import BadInput, regular
from .entries import entries

MATRIX, COMPRESSED = 14, 15
NUMBERS = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8"}
SPARSE = 5  # class of sparse arrays
WHOLE = (1, 2, 3, 4)  # types that whole numbers of any class may be stored in
DENSE = {6: (*WHOLE, 5, 9), 7: (*WHOLE, 7), 8: (1,), 9: (2,), 10: (3,), 11: (4,), 12: (5,), 13: (6,), 14: (12,), 15: (13,)}
COMPLEX = 0x0800
MOST = 2**31


def read(path):
    """All square matrices of more than one row."""
    try:
        if h5py.is_hdf5(regular(path)):
            found = read_hdf5(path)
        else:
            found = read_five(path, path.read_bytes())
    except BadInput:
        raise
    except (OSError, RuntimeError, KeyError, ValueError, TypeError, AttributeError, OverflowError, MemoryError) as error:
        text = " ".join(str(error).split())[:100] or type(error).__name__
        raise BadInput(f"{path}: cannot be read as a MATLAB file: {text}") from None
    if not found:
        raise BadInput(f"{path}: holds no square matrix of numbers")
    return found


class Elements:
    """Elements of some bytes, one after the other."""

    def __init__(self, path, order, data):
        self.path, self.order, self.data, self.at = path, order, data, 0

    def wrong(self, what):
        """The error."""
        return BadInput(f"{self.path}: {what}; was it cut off or damaged?")

    def more(self):
        """Whether there is another one."""
        return self.at < len(self.data)

    def next(self):
        """Type and bytes."""
        if self.at + 8 > len(self.data):
            raise self.wrong(f"ends within an element at byte {self.at}")
        kind, size = struct.unpack_from(self.order + "2I", self.data, self.at)
        if kind >> 16:
            kind, size, first, step = kind & 0xffff, kind >> 16, self.at + 4, 8
            if size > 4:
                raise self.wrong(f"a small element of {size} bytes")
        else:
            first, step = self.at + 8, 8 + size + (0 if kind == COMPRESSED else -size % 8)
        if first + size > len(self.data) or self.at + step > len(self.data):
            raise self.wrong(f"an element of {size} bytes goes beyond the end")
        if kind not in (COMPRESSED, MATRIX) and any(self.data[first + size:self.at + step]):
            raise self.wrong(f"an element at byte {self.at} is not followed by zeros")
        self.at += step
        return kind, self.data[first:first + size]

    def numbers(self, what, kinds):
        """The next element as numbers, of one of some types."""
        kind, data = self.next()
        if kind not in kinds or len(data) % int(NUMBERS[kind][1]):
            raise self.wrong(f"{what} are no numbers")
        return numpy.frombuffer(data, self.order + NUMBERS[kind])


def read_five(path, data):
    """Version 5: matrices, compressed or not."""
    order = {b"IM": "<", b"MI": ">"}.get(data[126:128])
    if len(data) < 128 or not order or struct.unpack_from(order + "H", data, 124)[0] != 0x0100:
        raise BadInput(f"{path}: is no MATLAB file of version 5 to 7.3")
    found, elements = [], Elements(path, order, data[128:])
    while elements.more():
        kind, body = elements.next()
        if kind == COMPRESSED:
            kind, body = inflate(path, order, body)
        if kind != MATRIX:
            raise elements.wrong(f"an element of type {kind} is no array")
        one = read_array(path, Elements(path, order, body))
        found += [one] if one else []
    names = [one.name for one in found]
    if len(set(names)) != len(names):
        raise BadInput(f"{path}: two matrices have one name")
    return found


def inflate(path, order, data):
    """The element that is compressed."""
    stream = zlib.decompressobj()
    try:
        body = stream.decompress(data, MOST)
    except zlib.error:
        raise BadInput(f"{path}: compressed data are damaged") from None
    if not stream.eof or stream.unused_data:
        raise BadInput(f"{path}: compressed data do not end where they should")
    elements = Elements(path, order, body)
    kind, inner = elements.next()
    if elements.more():
        raise elements.wrong("compressed data hold more than one element")
    return kind, inner


def read_array(path, elements):
    """A square matrix of numbers; None for another array."""
    flags, shape = elements.numbers("flags", (6,)), elements.numbers("dimensions", (5,))
    kind, name = elements.next()
    name = bytes(name).decode("ascii", "replace")
    if len(flags) != 2 or kind != 1 or len(shape) < 2 or (shape < 0).any():
        raise elements.wrong("an array has no head")
    of = int(flags[0]) & 0xff
    if of not in (SPARSE, *DENSE) and 1 <= of <= 18:
        return None
    if of != SPARSE and of not in DENSE:
        raise elements.wrong(f"{name} is of class {of}")
    if len(shape) != 2 or shape[0] != shape[1] or shape[0] < 2:
        return None
    if int(flags[0]) & COMPLEX:
        raise BadInput(f"{path}: {name} is complex; real matrices can be imported")
    n = int(shape[0])
    if of == SPARSE:
        row, start = elements.numbers("rows", (5, 6)), elements.numbers("columns", (5, 6))
        one = sparse(path, name, n, row, start, elements.numbers("values", DENSE[6]))
    else:
        one = dense(path, name, n, elements.numbers("values", DENSE[of]))
    if elements.more():
        raise elements.wrong(f"{name} has more than its values")
    return one


def sparse(path, name, n, row, start, value):
    """Columns one after another."""
    start = numpy.asarray(start, numpy.int64)
    if len(start) != n + 1 or start[0] != 0 or (numpy.diff(start) < 0).any() or start[-1] > min(len(row), len(value)):
        raise BadInput(f"{path}: {name}: starts of its columns do not ascend from 0 to {len(value)}")
    count = int(start[-1])  # what is behind is room
    if (len(row) != count or len(value) != count) and (numpy.any(row[count:]) or numpy.any(value[count:])):
        raise BadInput(f"{path}: {name}: {len(value)} values, its columns have {count}")
    return entries(name, path, (n, n), row[:count], numpy.repeat(numpy.arange(n), numpy.diff(start)), value[:count])


def dense(path, name, n, value):
    """All values, column by column."""
    if len(value) != n * n:
        raise BadInput(f"{path}: {name}: {len(value)} values in {n} x {n}")
    column, row = numpy.divmod(numpy.flatnonzero(value), n)
    return entries(name, path, (n, n), row, column, value[value != 0])


def values(path, item, kind):
    """All values of a data set, which is of the type that MATLAB gives it."""
    if not item.id.get_type().equal(kind):
        raise BadInput(f"{path}: {item.name} is of another type than MATLAB writes")
    return item[()]


def read_hdf5(path):
    """Version 7.3: arrays of double precision are transposed, sparse matrices are groups."""
    found, real, whole = [], h5py.h5t.IEEE_F64LE, h5py.h5t.STD_U64LE
    with h5py.File(path) as file:
        for name, item in file.items():
            if isinstance(item, h5py.Dataset) and item.ndim == 2 and item.shape[0] == item.shape[1] > 1 and item.dtype.kind in "fiu":
                found.append(dense(path, name, item.shape[0], values(path, item, real).ravel()))
            elif isinstance(item, h5py.Group) and "jc" in item and "ir" in item:
                start = values(path, item["jc"], whole)
                if int(item.attrs["MATLAB_sparse"]) == len(start) - 1:
                    found.append(sparse(path, name, len(start) - 1, values(path, item["ir"], whole), start,
                                        values(path, item["data"], real)))
    return found
