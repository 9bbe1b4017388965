"""What scripts/export and scripts/export_ccx write for other programs. Of a folder: states reads the fields, vtu and unv write
them, matrices those of -operators_save. Of a scene: options notes which of them a deck takes, scene_deck makes a deck of them and
of the mesh (decks/deck.py, as scripts/import reads it), shares spreads springs and forces over a set as squeal does, inp has the
cards, sliding those that bring CalculiX into full sliding."""
