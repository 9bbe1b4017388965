"""Decks of other codes as a mesh and a starting scene of squeal, for scripts/import.

  elements.py   shapes: corners, edges, faces, numbers and order of nodes of Gmsh
  deck.py       what is in a deck, whichever code it is of: nodes, blocks of elements, sets, surfaces, materials, holders
  text.py       files as bytes; tables of numbers with commas or in columns, all at once, and line by line where one is wrong
  abaqus.py     Abaqus and CalculiX: keywords, parts and instances; abaqus_words.py how keywords may be written;
                abaqus_mesh.py nodes, elements; abaqus_sets.py sets, surfaces;
                abaqus_material.py materials and sections; abaqus_model.py holders, contact, steps; abaqus_loads.py;
                springs.py
  nastran.py    Nastran: files; nastran_cards.py cards in fields; nastran_case.py case control, sets that act;
                nastran_systems.py coordinate systems; nastran_mesh.py grid points and solids; nastran_model.py properties,
                materials, supports; nastran_springs.py, nastran_loads.py, nastran_contact.py
  ansys.py      Ansys' archive: commands; ansys_blocks.py blocks; ansys_mesh.py nodes, elements, components; ansys_model.py
  meshes.py     .vtk and .vtu by meshio, and Code_Aster's .med; med_file.py the HDF5 of MED
  orientation.py  elements that are mirror images
  elastic.py    engineering constants of a stiffness
  units.py      which units a deck is in, and factors to SI
  assemble.py   a deck to named sets, parts and scene entries; ties merged; holders.py supports, springs, loads, contacts;
                gaps.py how far surfaces of a contact are apart; names.py names that squeal takes
  faces.py      faces of the cells: of sets of nodes, on the boundary, by their corners
  axes.py       supports in axes of a node's own
  middles.py    nodes in the middle of edges that are left out
  gmsh_file.py  the mesh as a file of Gmsh 4.1, binary
  scene_file.py the scene in YAML, with where each line comes from
  convert.py    the way from a file to these two
  balance.py    mass, centre, supports and loads of the deck beside those of the scene; written.py reads the scene and its
                mesh again; integrals.py integrates over elements and faces
"""
