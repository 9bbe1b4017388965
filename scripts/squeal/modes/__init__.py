"""Modes: exact eigenvalues, names of shapes, speed against error."""
