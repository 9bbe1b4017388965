"""Studies over many scenes, runs or decks."""
