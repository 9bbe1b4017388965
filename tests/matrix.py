#!/usr/bin/env python3
"""Writes a 2 x 2 matrix in PETSc's binary form, whole or with one fault.

    matrix.py good 2,1,1,2 K.bin

good      as MatView() writes it
complex   as a PETSc of complex numbers writes it, imaginary parts zero
trailing  eight bytes too many
short     four bytes too few
column    an entry in column 2 of 0, 1
negative  an entry in column -1
twice     two entries in one column
rows      one row with more entries than the head says
nan       one entry that is no number
head      another kind of object: a vector
"""

import struct
import sys
from pathlib import Path

MATRIX, VECTOR = 1211216, 1211214


def write(kind, values):
    """Bytes of the file."""
    head, counts, columns = [MATRIX, 2, 2, 4], [2, 2], [0, 1, 0, 1]
    if kind == "column":
        columns[3] = 2
    if kind == "negative":
        columns[2] = -1
    if kind == "twice":
        columns[1] = 0
    if kind == "rows":
        counts[1] = 3
    if kind == "head":
        head[0] = VECTOR
    if kind == "nan":
        values = [*values[:3], float("nan")]
    if kind == "complex":
        values = [part for value in values for part in (value, 0.0)]
    data = struct.pack(f">{6 + len(columns)}i", *head, *counts, *columns)
    data += struct.pack(f">{len(values)}d", *values)
    return data + bytes(8) if kind == "trailing" else data[:-4] if kind == "short" else data


if __name__ == "__main__":
    what, numbers, path = sys.argv[1:]
    Path(path).write_bytes(write(what, [float(value) for value in numbers.split(",")]))
