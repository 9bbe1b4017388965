"""What scripts/correlate does: universal splits a universal file into datasets, datasets reads them, universal_write writes them; tables
reads CSV; measured makes sensors, modes and responses of either; place finds the sensors on the mesh; criteria has MAC,
cross-orthogonality, pairs and expansion; responses has FRAC; written and pictures show it."""
