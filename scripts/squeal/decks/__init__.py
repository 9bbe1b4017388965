"""Decks of other codes as a mesh and a starting scene of squeal, for scripts/import.

  deck.py       what is in a deck, whichever code it is of: nodes, blocks of elements, sets, surfaces, materials, holders
  text.py       files as bytes; tables of numbers with commas or in columns, all at once, and line by line where one is wrong
  abaqus/       Abaqus and CalculiX: read.py keywords, parts and instances; words.py how keywords may be written; mesh.py nodes,
                elements; sets.py sets, surfaces; material.py materials and sections; model.py holders, contact, steps; loads.py;
                joined.py couplings, masses, equations; bolts.py pre-tension sections
  nastran/      Nastran: read.py files; cards.py cards in fields; case.py case control, sets that act; systems.py coordinate
                systems; mesh.py grid points and solids; model.py properties, materials, supports; springs.py, loads.py,
                contact.py, joined.py, shells.py
  ansys/        Ansys' archive: read.py commands; blocks.py blocks; mesh.py nodes, elements, components; model.py;
                joined.py; bolts.py pretension sections; sections.py shells and beams
  mesh/         elements.py shapes: corners, edges, faces, numbers and order of nodes of Gmsh; faces.py faces of the cells: of
                sets of nodes, on the boundary, by their corners; middles.py nodes in the middle of edges that are left out;
                orientation.py elements that are mirror images; shells.py shells as solids;
                integrals.py integrals over elements and faces; meshes.py .vtk and
                .vtu by meshio, and Code_Aster's .med; med_file.py the HDF5 of MED; gmsh_file.py a file of Gmsh 4.1, binary
  elastic.py    engineering constants of a stiffness
  units.py      which units a deck is in, and factors to SI
  joined/       what joins nodes: couplings, rigid bodies, masses, springs between nodes, equations
  assemble.py   a deck to named sets, parts and scene entries; ties merged; holders.py supports, springs, loads, contacts;
                gaps.py how far surfaces of a contact are apart; names.py names that squeal takes
  bolts.py      bolts that are cut and tightened
  axes.py       supports in axes of a node's own
  scene_file.py the scene in YAML, with where each line comes from
  convert.py    the way from a file to these two
  balance.py    mass, centre, supports and loads of the deck beside those of the scene; written.py reads the scene and its
                mesh again
"""
