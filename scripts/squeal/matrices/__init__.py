"""Matrices of other codes for squeal's -terms: `scripts/import_matrices`.

    entries.py          what a reader returns: entries, their triangle expanded, what each unknown is called
    text.py             files of numbers as text, with one-line errors that name the line
    market.py           Matrix Market
    harwell.py          Harwell-Boeing (Ansys *HBMAT), and its mapping of equations
    abaqus.py           *MATRIX GENERATE / *MATRIX OUTPUT of Abaqus: MATRIX INPUT and COORDINATE
    calculix.py         .sti, .mas and .dof of *FREQUENCY, SOLVER=MATRIXSTORAGE
    dmig.py             DMIG of bulk data of Nastran
    op4.py              OUTPUT4 of Nastran, dense and sparse: as text; op4_bytes.py binary, op4_columns.py what both share
    matlab.py           MATLAB .mat
    places.py           where nodes are: a table, or *NODE of a deck
    together.py         one order of unknowns for all matrices, rows that are left out, and the files that are written
"""
