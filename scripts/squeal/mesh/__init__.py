"""Meshes, surfaces of bodies, matrices of PETSc."""
