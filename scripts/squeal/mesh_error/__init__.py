"""What scripts/richardson does. What each module holds: lattice an element cut into equal ones, subdivide a mesh of Gmsh with
every element cut so, meshes the scene on finer meshes, match which mode of one mesh is which of another, limits what the
frequencies tend to, tables what is written and printed."""
