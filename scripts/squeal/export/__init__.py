"""What scripts/export writes for other programs: states reads the fields of a folder, vtu and unv write them, matrices
those of -operators_save."""
