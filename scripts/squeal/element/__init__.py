"""Meshes of one body and its modes by every element."""
