"""Elements, faces and mesh files of decks."""
