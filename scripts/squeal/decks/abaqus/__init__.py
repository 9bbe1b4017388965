"""Decks of Abaqus and CalculiX."""
